/* CAUSE: what the diagnosis found, or what a user suspects. */
#include "deck/deck_row.h"

#define SAME_PLACE 1e-9 /* of the length */

struct cause_card {
    struct deck_reader *reader;
    const struct card *card;
    const char *name;
    const struct cause_kind *kind;
    int suspect;
    struct effect effect;
    struct correction correction;
};

/* ------------------------------------------------------------------------------------------------ what it acts on */

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

const char **deck_name_of(const struct rotor *rotor, enum cause_target kind, int i)
{
    return kind == TARGET_GROUP && i < rotor->ngroup     ? &rotor->group[i].name
           : kind == TARGET_SPRING && i < rotor->nspring ? &rotor->spring[i].name
           : kind == TARGET_DISK && i < rotor->ndisk     ? &rotor->disk[i].name
           : kind == TARGET_TIEROD && i < rotor->ntierod ? &rotor->tierod[i].name
                                                         : NULL;
}

/* BETWEEN=left,core: two groups by name. */
static int read_between(struct cause_card *c, const struct card_option *option)
{
    const struct rotor *rotor = &c->reader->job->rotor;
    const char *comma = strchr(option->value, ','), *second = comma ? comma + 1 + strspn(comma + 1, " \t") : NULL;
    struct place place = option->value_place;
    if (!comma)
        return deck_error(c->reader, place, "BETWEEN=%s names one group, expected %s", option->value,
                          target_of[TARGET_INTERFACE].expected);
    const char *first = pool_format(c->reader->pool, "%.*s", (int)(comma - option->value), option->value);
    int left = first ? deck_named_group(c->reader, first, place) : -1;
    if (!option->overridden) {
        place = option->end;
        place.column -= (int)strlen(second);
    }
    int right = deck_named_group(c->reader, second, place), last = rotor_axis_groups(rotor) - 1;
    if (left < 0 || right < 0)
        return 1;
    if ((right != left + 1 && left != right + 1) || left > last || right > last)
        return deck_error(c->reader, option->value_place, "groups %s and %s do not meet, expected %s", rotor->group[left].name,
                          rotor->group[right].name, target_of[TARGET_INTERFACE].expected);
    c->effect.target = left < right ? left : right;
    return 0;
}

static int read_interface(struct cause_card *c)
{
    const struct rotor *rotor = &c->reader->job->rotor;
    const struct card_option *between = card_option(c->card, "BETWEEN"), *at = card_option(c->card, "AT");
    double z, from, to;
    if (between && at)
        return deck_error(c->reader, at->place, "BETWEEN and AT are both given, expected one of them");
    if (!at)
        return !deck_option(c->reader, c->card, "BETWEEN", target_of[TARGET_INTERFACE].expected) || !between ||
               read_between(c, between);
    if (deck_position(c->reader, &(struct field){at->value, at->value_place, 0}, "AT", &z))
        return 1;
    for (int g = 0; g + 1 < rotor_axis_groups(rotor); g++) {
        rotor_group_span(rotor, g, &from, &to);
        if (fabs(z - to) <= 1e-5 * c->reader->length) {
            c->effect.target = g;
            return 0;
        }
    }
    return deck_error(c->reader, at->value_place, "no two groups meet at AT=%s (%.6g m), expected a position where they do",
                      at->value, z);
}

/* A spring, disk or tie rod by name. */
static int read_named(struct cause_card *c)
{
    const char *expected = target_of[c->kind->target].expected, *name = deck_option(c->reader, c->card, "AT", expected), **own;
    for (int i = 0; name && (own = deck_name_of(&c->reader->job->rotor, c->kind->target, i)); i++)
        if (*own && same_text(*own, name)) {
            c->effect.target = i;
            return 0;
        }
    if (name)
        deck_error(c->reader, card_option(c->card, "AT")->value_place, "AT=%s is not defined, expected the %s", name, expected);
    return 1;
}

/* SENSOR=7 or SENSOR=7,6 */
static int read_sensors(struct cause_card *c)
{
    const char *expected = target_of[c->kind->target].expected, *text = deck_option(c->reader, c->card, "SENSOR", expected);
    int wanted = c->kind->target == TARGET_SENSORS ? 2 : 1;
    long id[2];
    char comma = ',', rest;
    if (!text)
        return 1;
    struct place place = card_option(c->card, "SENSOR")->value_place;
    if (sscanf(text, "%18ld %c%18ld %c", &id[0], &comma, &id[1], &rest) != 2 * wanted - 1 || comma != ',')
        return deck_error(c->reader, place, "SENSOR=%s is not what TYPE=%s takes, expected %s", text, c->kind->id, expected);
    for (int i = 0; i < wanted; i++) {
        c->effect.target = id[i] > 0 && id[i] <= 1000000000 ? sensor_find(c->reader->job, (int)id[i]) : -1;
        if (c->effect.target < 0)
            return deck_error(c->reader, place, "sensor %ld is not among the sensors, expected one that is", id[i]);
        c->correction.sensor[c->correction.nsensor++] = (int)id[i];
    }
    if (wanted == 2 && id[0] == id[1])
        return deck_error(c->reader, place, "SENSOR names sensor %ld twice, expected two sensors", id[0]);
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

/* Reads the target into effect.target or the sensors and the block of the correction; the variant is known. 0, or 1 after an
 * error. */
static int read_target(struct cause_card *c)
{
    c->effect.target = -1;
    if (is_moving(c))
        return refuse_sensor(c);
    const enum cause_target target = c->kind->target;
    if (target == TARGET_GROUP)
        return (c->effect.target = deck_option_group(c->reader, c->card, "GROUP")) < 0;
    return target == TARGET_NONE || target == TARGET_MODES       ? 0
           : target == TARGET_INTERFACE                          ? read_interface(c)
           : target == TARGET_SENSOR || target == TARGET_SENSORS ? read_sensors(c)
           : target == TARGET_BLOCK                              ? read_block(c)
                                                                 : read_named(c);
}

/* ------------------------------------------------------------------------------------------------ the card */

/* Why a finding of the diagnosis has no card. */
static const char *without_card(const struct cause_kind *kind)
{
    return kind->target == TARGET_MODES  ? "modes are paired by their numbers, expected others in *MODES or the universal file"
           : kind->solid                 ? "it is removed by *FIT, MODEL=SOLID, expected that"
           : same_text(kind->id, "mesh") ? "it is removed by more elements on *SHAFT, expected those"
           : same_text(kind->id, "guyan_reduction") ? "it is removed by *FIT, REDUCTION=NONE, expected that"
                                                    : "the diagnosis alone finds it, expected another TYPE";
}

static int has_card(const struct cause_kind *kind)
{
    return (kind->class == CAUSE_PHYSICAL && !kind->solid) || kind->correct;
}

static const struct cause_kind *find_kind(struct deck_reader *reader, const struct card *card)
{
    const char *id = deck_option(reader, card, "TYPE", "id of a cause");
    const struct cause_kind *kind = id ? catalogue_find(id) : NULL;
    if (!id)
        return NULL;
    struct place place = card_option(card, "TYPE")->value_place;
    if (!kind) {
        char list[768] = "";
        for (int i = 0, length = 0; i < catalogue_count(); i++)
            if (has_card(catalogue_item(i)) && length < (int)sizeof list)
                length +=
                    snprintf(list + length, sizeof list - (size_t)length, "%s%s", length ? ", " : "", catalogue_item(i)->id);
        deck_error(reader, place, "TYPE=%s is no cause, expected one of %s", id, list);
    } else if (!has_card(kind)) {
        deck_error(reader, place, "TYPE=%s has no card: %s", kind->id, without_card(kind));
        kind = NULL;
    }
    return kind;
}

/* Options that another type of cause has. 0, or 1 after an error. */
static int check_options(const struct cause_card *c)
{
    static const char *const options[] = {"GROUP", "BETWEEN", "AT", "SENSOR", "SHAPE", "MOUNT"};
    int bad = 0;
    for (int i = 0; i < 6; i++) {
        int is_variant = i > 3, is_place = c->kind->target == TARGET_INTERFACE && i == 2;
        const struct card_option *option = card_option(c->card, options[i]);
        const char *own = is_variant ? c->kind->variant_option : target_of[c->kind->target].option,
                   *expected = !is_variant ? target_of[c->kind->target].expected
                               : own       ? ""
                                           : "a card without it";
        if (option && !(own && same_text(own, options[i])) && !is_place)
            bad = deck_error(c->reader, option->place, "%s has no meaning for a cause of TYPE=%s, expected %s%s%s", option->name,
                             c->kind->id, own ? own : "", own && !is_variant ? "=" : "", expected);
    }
    return bad;
}

static int check_value(const struct cause_card *c, int p, const struct effect_parameter_name *known, const struct field *field,
                       double *value)
{
    double lower, upper, si = deck_in_si(c->reader, known->unit);
    cause_reach(c->kind, &c->reader->job->rotor, &c->effect, p, &lower, &upper);
    double neutral = c->kind->parameter[p].neutral;
    int has_neutral = c->kind->class == CAUSE_DATA ||
                      (p != c->kind->place && p != c->kind->width); /* of a place or width none is without effect */
    if ((has_neutral && *value == neutral) || deck_clip(lower, upper, value))
        return 0;
    if (has_neutral && (neutral < lower || neutral > upper))
        deck_error(c->reader, field->place, "%s is %s, expected a value from %.6g to %.6g, or %.6g: no effect", known->name,
                   field->text, lower / si, upper / si, neutral / si);
    else
        deck_error(c->reader, field->place, "%s is %s, expected a value from %.6g to %.6g", known->name, field->text, lower / si,
                   upper / si);
    return 1;
}

/* Index of a parameter of the kind, -1 after an error that lists those there are. */
static int find_value(const struct cause_card *c, const struct field *field, int count, const struct effect_parameter_name *known)
{
    char list[256] = "";
    for (int p = 0; p < count; p++) {
        if (same_text(field->text, known[p].name))
            return p;
        (void)snprintf(list + strlen(list), sizeof list - strlen(list), "%s%s [%s]", p ? ", " : "", known[p].name, known[p].unit);
    }
    return -deck_error(c->reader, field->place, "%s is no parameter of TYPE=%s, expected %s", field->text, c->kind->id,
                       count ? list : "no data line");
}

/* "mass, 0, 5": where a suspect's size is looked for. */
static int read_bounds(struct cause_card *c, const struct data_line *line, int p, const struct effect_parameter_name *known)
{
    double lower, upper, *bound = c->effect.bound, si = deck_in_si(c->reader, known[p].unit);
    const struct field *field = line->field;
    int bad = deck_number(c->reader, line, 1, known[p].name, ANY, &bound[0]) |
              deck_number(c->reader, line, 2, known[p].name, ANY, &bound[1]);
    if (bad)
        return bad;
    bound[0] *= si;
    bound[1] *= si;
    if (c->kind->class != CAUSE_PHYSICAL || p != c->kind->size)
        return deck_error(c->reader, field[1].place, "%s has bounds, expected them for the size of TYPE=%s alone", known[p].name,
                          c->kind->id);
    cause_reach(c->kind, &c->reader->job->rotor, &c->effect, p, &lower, &upper);
    if (bound[0] < bound[1] && deck_clip(lower, upper, &bound[0]) && deck_clip(lower, upper, &bound[1]))
        return 0;
    return deck_error(c->reader, field[1].place,
                      "the bounds of %s are %s and %s, expected the lower one first and both from %.6g to %.6g", known[p].name,
                      field[1].text, field[2].text, lower / si, upper / si);
}

/* The data lines: values [count] of the parameters `known` [count], given [count] says which were there. */
static int read_values(struct cause_card *c, int count, const struct effect_parameter_name *known, double *value, int *given)
{
    const struct field *field[EFFECT_MOST_PARAMETERS] = {NULL};
    int bad = 0;
    for (int i = 0; i < c->card->nline; i++) {
        const struct data_line *line = &c->card->line[i];
        int bounds = c->suspect && deck_has(line, 2),
            p = deck_count(c->reader, line, bounds ? 3 : 2) ? -1 : find_value(c, &line->field[0], count, known);
        if (p >= 0 && given[p])
            deck_error(c->reader, line->field[0].place, "%s is given twice, expected once", known[p].name);
        if (p < 0 || given[p]) {
            bad = 1;
        } else if (bounds) {
            bad |= read_bounds(c, line, p, known);
        } else {
            int is_place = c->kind->class == CAUSE_PHYSICAL && p == c->kind->place && deck_has(line, 1);
            bad |= is_place ? deck_position(c->reader, &line->field[1], known[p].name, &value[p])
                            : deck_number(c->reader, line, 1, known[p].name, ANY, &value[p]);
            value[p] *= is_place ? 1 : deck_in_si(c->reader, known[p].unit);
            given[p] = 1;
            field[p] = &line->field[1];
        }
    }
    for (int p = 0, read = !bad; p < count && read; p++) /* now: bounds of one parameter may follow another one */
        bad |= given[p] && check_value(c, p, &known[p], field[p], &value[p]);
    for (int p = 0; p < count && !c->suspect && !bad; p++)
        if (!given[p])
            bad = deck_error(c->reader, c->card->place, "*CAUSE has no value of %s [%s], expected a line '%s, value'",
                             known[p].name, known[p].unit, known[p].name);
    return bad;
}

static int read_variant(struct cause_card *c)
{
    const struct card_option *option = c->kind->variant_option ? card_option(c->card, c->kind->variant_option) : NULL;
    int word = option ? deck_option_word(c->reader, option, c->kind->variant) : 0;
    c->effect.variant = word < 0 ? 0 : word;
    return word < 0;
}

/* Such as tie rods that are RODS already. */
static void note_if_idle(struct cause_card *c)
{
    const struct rotor *rotor = &c->reader->job->rotor;
    int *identified = POOL_ARRAY(c->reader->pool, int, rotor->ngroup); /* none: what is identified does not matter here */
    if (identified && c->kind->applies && !c->kind->applies(rotor, c->effect.target, identified))
        deck_note(c->reader, c->card->place, "cause %s of TYPE=%s changes nothing here", c->name, c->kind->id);
}

/* An effect: part of the model, or a suspect. */
static void read_physical(struct cause_card *c)
{
    struct job *job = c->reader->job;
    int given[EFFECT_MOST_PARAMETERS] = {0};
    c->effect.name = c->name;
    c->effect.kind = c->kind->effect;
    for (int p = 0; p < c->kind->effect->nparameter; p++) /* what a suspect leaves open: no effect, of a usual width */
        c->effect.value[p] = p == c->kind->width ? c->kind->parameter[p].typical : c->kind->parameter[p].neutral;
    note_if_idle(c);
    if (read_values(c, effect_parameters(&c->effect), c->kind->effect->parameter, c->effect.value, given))
        return;
    if (!c->suspect) {
        (void)POOL_ADD(c->reader->pool, job->rotor.effect, job->rotor.neffect, &c->effect);
        return;
    }
    struct suspect suspect = {.effect = c->effect};
    memcpy(suspect.fixed, given, sizeof given);
    (void)POOL_ADD(c->reader->pool, job->unknowns.suspect, job->unknowns.nsuspect, &suspect);
}

/* A fault of the measurement chain: applied when everything has been read. */
static void read_correction(struct cause_card *c)
{
    struct job *job = c->reader->job;
    int given[3] = {0}, count = 0;
    struct effect_parameter_name known[3];
    double value[3] = {0};
    for (const struct effect_parameter_name *name; (name = correction_parameter(c->kind, count)); count++)
        known[count] = *name;
    c->correction.name = c->name;
    c->correction.id = c->kind->id;
    c->correction.value = 1;
    if (c->suspect) {
        deck_error(c->reader, card_option(c->card, "SUSPECT")->place,
                   "SUSPECT has no meaning for TYPE=%s, expected a cause in the rotor: the measured data are always examined",
                   c->kind->id);
        return;
    }
    if (read_values(c, count, known, value, given))
        return;
    for (int p = 0; p < count; p++)
        *correction_value(&c->correction, p) = value[p];
    if (!job->measurement.shape && c->kind->target != TARGET_BLOCK) {
        deck_error(c->reader, c->card->place, "TYPE=%s corrects measured shapes and there are none, expected *SHAPE or *MEASURED",
                   c->kind->id);
        return;
    }
    deck_add_place(c->reader, CORRECTION_PLACES, c->card->place);
    (void)POOL_ADD(c->reader->pool, job->measurement.correction, job->measurement.ncorrection, &c->correction);
}

void deck_causes_of_solid(struct deck_reader *reader)
{
    for (int c = 0; c < reader->text.ncard; c++) {
        const struct card *card = &reader->text.card[c];
        const struct card_option *type = same_text(card->name, "CAUSE") ? card_option(card, "TYPE") : NULL;
        const struct cause_kind *kind = type ? catalogue_find(type->value) : NULL;
        if (kind && has_card(kind) && cause_of_beam(kind))
            deck_error(
                reader, type->value_place,
                "TYPE=%s corrects what a beam gets wrong, and a solid has no such error, expected no such cause with *FIT, "
                "MODEL=SOLID",
                kind->id);
    }
}

/* Whether a place lies inside a section, neither at an end of one nor beyond the rotor. */
static int is_in_a_section(const struct rotor *rotor, double z)
{
    double apart = z, border = 0, length = rotor_length(rotor);
    for (int s = 0; s < rotor->nsegment; s++) {
        border += rotor->segment[s].length;
        apart = fmin(apart, fabs(z - border));
    }
    return z < length && apart > SAME_PLACE * length;
}

void deck_note_boxes(struct deck_reader *reader)
{
    const struct cause_kind *zone = catalogue_find("stiffness_local");
    const struct rotor *rotor = &reader->job->rotor;
    for (int c = 0; c < reader->text.ncard; c++) {
        const struct card *card = &reader->text.card[c];
        const struct card_option *name = same_text(card->name, "CAUSE") ? card_option(card, "NAME") : NULL;
        for (int i = 0; i < rotor->neffect && name; i++) {
            const struct effect *e = &rotor->effect[i];
            double z = e->value[zone->place], half = e->value[zone->width] / 2;
            if (e->kind == zone->effect && same_text(e->name, name->value) && !strncmp(zone->variant[e->variant], "BOX", 3) &&
                (is_in_a_section(rotor, z - half) || is_in_a_section(rotor, z + half)))
                deck_note(
                    reader, card->place,
                    "this zone ends inside a section, and a solid takes the mean of E and G in an element that its end cuts, "
                    "which the column mesh does not see: up to 1 %% of what the zone changes; expected sections that end there, "
                    "or SHAPE=GAUSSIAN");
        }
    }
}

void deck_cause(struct deck_reader *reader, const struct card *card)
{
    struct cause_card c = {.reader = reader, .card = card, .name = deck_option(reader, card, "NAME", "name")};
    const struct card_option *suspect = card_option(card, "SUSPECT");
    c.kind = find_kind(reader, card);
    if (suspect)
        c.suspect = !*suspect->value ? 1 : deck_option_word(reader, suspect, deck_answers);
    if (!c.kind || c.suspect < 0 || check_options(&c) || read_variant(&c) || read_target(&c) || !c.name)
        return;
    if (c.kind->class == CAUSE_PHYSICAL)
        read_physical(&c);
    else
        read_correction(&c);
}

/* ------------------------------------------------------------------------------------------------ faults of the data */

/* The places of the sensors in the deck, where a correction has changed their order. */
static void follow_sensors(struct deck_reader *reader, const struct job_raw *raw)
{
    struct place *place = POOL_ARRAY(reader->pool, struct place, raw->nsensor);
    if (!place)
        return;
    for (int s = 0; s < raw->nsensor; s++)
        place[sensor_find(reader->job, raw->sensor[s].id)] = reader->place[SENSOR_PLACES][s];
    reader->place[SENSOR_PLACES] = place;
}

int deck_knows_any(ptrdiff_t count, const double *std)
{
    for (ptrdiff_t i = 0; i < count; i++)
        if (isfinite(std[i]))
            return 1;
    return 0;
}

void deck_apply_corrections(struct deck_reader *reader)
{
    struct job *job = reader->job;
    if (!job->measurement.ncorrection)
        return;
    if (corrections_keep_raw(reader->pool, job))
        return;
    for (int i = 0; i < job->measurement.ncorrection; i++) {
        const struct correction *correction = &job->measurement.correction[i];
        int shape = correction->block && same_text(correction->block, "SHAPE");
        if (correction->block &&
            !(shape ? job->measurement.shape &&
                          deck_knows_any((ptrdiff_t)job->rotor.nsensor * job->measurement.nmode, job->measurement.shape_std)
                    : deck_knows_any(job->measurement.nmode, job->measurement.frequency_std))) {
            deck_error(reader, reader->place[CORRECTION_PLACES][i], "the noise of AT=%s is not stated, expected *NOISE, %s=value",
                       correction->block, correction->block);
            continue;
        }
        int status = correction_apply(reader->pool, job, correction);
        if (status == ROTID_ERROR_MEMORY)
            reader->pool->out_of_memory = 1;
        else if (status && !correction->nsensor)
            deck_error(reader, reader->place[CORRECTION_PLACES][i],
                       "%s puts sensors beyond the rotor, expected a shift and a scale that leave all of them on it",
                       correction->id);
        else if (status)
            deck_error(reader, reader->place[CORRECTION_PLACES][i],
                       "%s leaves sensor %d no place of its own among the others, expected another shift", correction->id,
                       correction->sensor[0]);
        if (status)
            return;
    }
    follow_sensors(reader, job->measurement.raw);
}

int deck_cause_explains(struct deck_reader *reader, const char *parameter, struct place place)
{
    const struct job *job = reader->job;
    const char *dot = strrchr(parameter, '.');
    char *name = dot ? pool_format(reader->pool, "%.*s", (int)(dot - parameter), parameter) : NULL;
    for (int i = 0; i < job->unknowns.nsuspect && name; i++)
        if (same_text(job->unknowns.suspect[i].effect.name, name))
            return deck_error(reader, place, "%s is of a suspect, expected a *CAUSE that is part of the model, without SUSPECT",
                              parameter);
    for (int i = 0; i < job->measurement.ncorrection && name; i++)
        if (same_text(job->measurement.correction[i].name, name))
            return deck_error(
                reader, place,
                "%s is of a fault of the measured data, which is stated and not identified, expected a cause in the rotor",
                parameter);
    for (int c = 0; c < reader->text.ncard && name; c++) {
        const struct card_option *option = card_option(&reader->text.card[c], "NAME");
        if (!strcmp(reader->text.card[c].name, "CAUSE") && option && same_text(option->value, name))
            return 1;
    }
    return 0;
}

/* ------------------------------------------------------------------------------------------------ written */

static void put_target(struct deck_writer *w, const struct cause_kind *kind, int target)
{
    const struct rotor *rotor = &w->job->rotor;
    const char **name = deck_name_of(rotor, kind->target, target);
    double from, to;
    if (name) {
        deck_put_option(w, target_of[kind->target].option, *name);
    } else if (kind->target == TARGET_SENSOR) {
        deck_put_option(w, "SENSOR", pool_format(w->pool, "%d", rotor->sensor[target].id));
    } else if (kind->target == TARGET_INTERFACE && !strchr(rotor->group[target + 1].name, '=')) {
        deck_put_option(w, "BETWEEN", rotor->group[target].name);
        deck_put(w, ",%s", rotor->group[target + 1].name);
    } else if (kind->target == TARGET_INTERFACE) {
        rotor_group_span(rotor, target, &from, &to);
        deck_put_option_number(w, "AT", to, "m");
    }
}

static void put_value(struct deck_writer *w, const struct effect_parameter_name *parameter, double value)
{
    deck_put(w, "%s", parameter->name);
    deck_put_number(w, ", ", value, parameter->unit);
    deck_put(w, "\n");
}

static void put_head(struct deck_writer *w, const char *name, const struct cause_kind *kind)
{
    deck_put_card(w, "CAUSE");
    deck_put_option(w, "NAME", name);
    deck_put_option(w, "TYPE", kind ? kind->id : NULL); /* none: refused */
}

void deck_put_cause(struct deck_writer *w, const struct effect *effect)
{
    const struct cause_kind *kind = catalogue_of(effect);
    put_head(w, effect->name, kind);
    if (kind && effect->target >= 0)
        put_target(w, kind, effect->target);
    if (kind && kind->variant_option)
        deck_put_option(w, kind->variant_option, kind->variant[effect->variant]);
    deck_put(w, "\n");
    for (int p = 0; p < effect_parameters(effect) && kind; p++)
        put_value(w, &effect->kind->parameter[p], effect->value[p]);
}

void deck_put_corrections(struct deck_writer *w, int first)
{
    for (int i = first; i < w->job->measurement.ncorrection; i++) {
        struct correction c = w->job->measurement.correction[i];
        const struct cause_kind *kind = catalogue_find(c.id);
        const struct effect_parameter_name *parameter;
        put_head(w, c.name, kind);
        if (kind && kind->target == TARGET_BLOCK)
            deck_put_option(w, "AT", c.block);
        else if (kind && kind->target != TARGET_NONE)
            deck_put(w, ", SENSOR=%d", c.sensor[0]);
        if (kind && kind->target == TARGET_SENSORS)
            deck_put(w, ",%d", c.sensor[1]);
        deck_put(w, "\n");
        for (int p = 0; kind && (parameter = correction_parameter(kind, p)); p++)
            put_value(w, parameter, *correction_value(&c, p));
    }
}
