/* What a CAUSE card acts on: GROUP, BETWEEN, AT, SENSOR. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "deck/deck.h"
#include "diagnose/causes/causes.h"

/* What a target is called by on the card. */
static const struct {
    const char *option, *expected;
} target_of[] = {[TARGET_NONE] = {NULL, "a card without it"},
                 [TARGET_GROUP] = {"GROUP", "name of a *SHAFT, *BEAM or *LAYER"},
                 [TARGET_INTERFACE] = {"BETWEEN", "two groups that follow each other, or AT=the position where they meet"},
                 [TARGET_SPRING] = {"AT", "name of a *SPRING"},
                 [TARGET_DISK] = {"AT", "name of a *DISK"},
                 [TARGET_TIEROD] = {"AT", "name of a *TIEROD"},
                 [TARGET_SENSOR] = {"SENSOR", "id of a sensor"},
                 [TARGET_SENSORS] = {"SENSOR", "ids of two sensors"},
                 [TARGET_BLOCK] = {"AT", "SHAPE or FREQUENCY"},
                 [TARGET_MODES] = {NULL, "a card without it"}};

const char *cause_target_option(enum cause_target target)
{
    return target_of[target].option;
}

const char *cause_target_expected(enum cause_target target)
{
    return target_of[target].expected;
}

/* BETWEEN=left,core: the text behind the comma stands as an option without a value. Where --set has replaced the first group by
 * both, it is still there. */
static const struct card_option *second_group(const struct card *card)
{
    for (int i = 0; i + 1 < card->noption; i++) {
        const struct card_option *option = &card->option[i], *next = option + 1;
        if (!same_text(option->name, "BETWEEN") || *next->value)
            continue;
        return !strchr(option->value, ',') || (option->overridden && !same_text(next->name, "SUSPECT")) ? next : NULL;
    }
    return NULL;
}

int deck_cause_list_item(const struct card *card, const struct card_option *option)
{
    return option == second_group(card);
}

static int find_group(const struct cause_card *c, const char *name, struct place place, int *group)
{
    *group = deck_find_group(c->reader, c->reader->job->rotor.ngroup, name, strlen(name));
    if (*group < 0)
        deck_error(c->reader, place, "group %s is not defined, expected the name of a *SHAFT, *BEAM or *LAYER", name);
    return *group < 0;
}

/* Groups by name; --set gives both of them as one text. */
static int read_between(struct cause_card *c, const struct card_option *option)
{
    const struct card_option *item = second_group(c->card);
    const char *comma = strchr(option->value, ',');
    int left, right;
    struct place place = option->value_place, second = item && !comma ? item->place : place;
    if (comma && !option->overridden)
        second.column += (int)(comma - option->value) + 1;
    char *first = comma ? pool_format(c->reader->pool, "%.*s", (int)(comma - option->value), option->value) : NULL;
    if (comma && !first) {
        c->reader->out_of_memory = 1;
        return 1;
    }
    const char *behind = comma ? comma + 1 + strspn(comma + 1, " \t") : item ? item->name : NULL;
    if (!behind) {
        deck_error(c->reader, place, "BETWEEN=%s names one group, expected %s", option->value,
                   target_of[TARGET_INTERFACE].expected);
        return 1;
    }
    if (find_group(c, first ? first : option->value, place, &left) | find_group(c, behind, second, &right))
        return 1;
    int last = rotor_axis_groups(&c->reader->job->rotor) - 1;
    if ((right != left + 1 && left != right + 1) || left > last || right > last) {
        deck_error(c->reader, place, "groups %s and %s do not meet, expected %s", c->reader->job->rotor.group[left].name,
                   c->reader->job->rotor.group[right].name, target_of[TARGET_INTERFACE].expected);
        return 1;
    }
    c->effect.target = left < right ? left : right;
    return 0;
}

static int read_interface(struct cause_card *c)
{
    const struct rotor *rotor = &c->reader->job->rotor;
    const struct card_option *between = card_option(c->card, "BETWEEN"), *at = card_option(c->card, "AT");
    double z, from, to;
    if (between && at) {
        deck_error(c->reader, at->place, "BETWEEN and AT are both given, expected one of them");
        return 1;
    }
    if (!at)
        return !deck_option(c->reader, c->card, "BETWEEN", target_of[TARGET_INTERFACE].expected) || !between ||
               read_between(c, between);
    if (deck_option_position(c->reader, at, "AT", &z))
        return 1;
    for (int g = 0; g + 1 < rotor_axis_groups(rotor); g++) {
        rotor_group_span(rotor, g, &from, &to);
        if (fabs(z - to) <= 1e-5 * c->reader->length) {
            c->effect.target = g;
            return 0;
        }
    }
    deck_error(c->reader, at->value_place, "no two groups meet at AT=%s (%.6g m), expected a position where they do", at->value,
               z);
    return 1;
}

/* A spring, disk or tie rod by name. */
static int read_named(struct cause_card *c)
{
    const struct rotor *rotor = &c->reader->job->rotor;
    enum cause_target target = c->kind->target;
    int count = target == TARGET_SPRING ? rotor->nspring : target == TARGET_DISK ? rotor->ndisk : rotor->ntierod;
    const char *name = deck_option(c->reader, c->card, "AT", target_of[c->kind->target].expected);
    for (int i = 0; i < count && name; i++) {
        const char *candidate = target == TARGET_SPRING ? rotor->spring[i].name
                                : target == TARGET_DISK ? rotor->disk[i].name
                                                        : rotor->tierod[i].name;
        if (candidate && same_text(candidate, name)) {
            c->effect.target = i;
            return 0;
        }
    }
    if (name)
        deck_error(c->reader, card_option(c->card, "AT")->value_place, "AT=%s is not defined, expected the %s", name,
                   target_of[c->kind->target].expected);
    return 1;
}

/* SENSOR=7 or SENSOR=7,6 */
static int read_sensors(struct cause_card *c)
{
    int wanted = c->kind->target == TARGET_SENSORS ? 2 : 1;
    const char *text = deck_option(c->reader, c->card, "SENSOR", target_of[c->kind->target].expected);
    if (!text)
        return 1;
    struct place place = card_option(c->card, "SENSOR")->value_place;
    for (;;) {
        char *end;
        long id = strtol(text, &end, 10);
        int bad = end == text || id < 1 || id > 1000000000 || c->correction.nsensor == wanted;
        end += strspn(end, " \t");
        bad |= (*end && *end != ',') || (!*end && c->correction.nsensor + 1 < wanted);
        if (bad) {
            deck_error(c->reader, place, "SENSOR=%s is not what TYPE=%s takes, expected %s",
                       card_option(c->card, "SENSOR")->value, c->kind->id, target_of[c->kind->target].expected);
            return 1;
        }
        c->effect.target = sensor_find(c->reader->job, (int)id);
        if (c->effect.target < 0) {
            deck_error(c->reader, place, "sensor %ld is not among the sensors, expected one that is", id);
            return 1;
        }
        c->correction.sensor[c->correction.nsensor++] = (int)id;
        if (!*end)
            break;
        text = end + 1;
    }
    if (wanted == 2 && c->correction.sensor[0] == c->correction.sensor[1]) {
        deck_error(c->reader, place, "SENSOR names sensor %d twice, expected two sensors", c->correction.sensor[0]);
        return 1;
    }
    return 0;
}

/* AT=SHAPE or FREQUENCY; its noise is checked once *NOISE has been applied */
static int read_block(struct cause_card *c)
{
    static const char *const blocks[] = {"SHAPE", "FREQUENCY", NULL};
    if (!deck_option(c->reader, c->card, "AT", target_of[TARGET_BLOCK].expected))
        return 1;
    int word = deck_option_word(c->reader, card_option(c->card, "AT"), blocks);
    if (word >= 0)
        c->correction.block = blocks[word];
    return word < 0;
}

/* MOVING goes from sensor to sensor, FIXED stays at one */
static int is_moving(const struct cause_card *c)
{
    return c->kind->class == CAUSE_PHYSICAL && c->kind->target == TARGET_SENSOR && c->kind->variant_option &&
           same_text(c->kind->variant[c->effect.variant], "MOVING");
}

static int refuse_sensor(const struct cause_card *c)
{
    const struct card_option *sensor = card_option(c->card, "SENSOR");
    if (sensor)
        deck_error(c->reader, sensor->place, "SENSOR has no meaning with MOUNT=MOVING (default), expected MOUNT=FIXED");
    else if (!c->reader->job->rotor.nsensor)
        deck_error(c->reader, c->card->place, "MOUNT=MOVING goes from sensor to sensor, expected sensors");
    return sensor || !c->reader->job->rotor.nsensor;
}

int cause_read_target(struct cause_card *c)
{
    c->effect.target = -1;
    if (is_moving(c))
        return refuse_sensor(c);
    switch (c->kind->target) {
    case TARGET_GROUP:
        return (c->effect.target = deck_option_group(c->reader, c->card, "GROUP")) < 0;
    case TARGET_INTERFACE:
        return read_interface(c);
    case TARGET_SPRING:
    case TARGET_DISK:
    case TARGET_TIEROD:
        return read_named(c);
    case TARGET_SENSOR:
    case TARGET_SENSORS:
        return read_sensors(c);
    case TARGET_BLOCK:
        return read_block(c);
    default:
        return 0;
    }
}
