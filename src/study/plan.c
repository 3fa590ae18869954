#include "study/study.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "deck/deck.h"

static void heading(struct plan_reader *reader, const struct card *card)
{
    (void)reader, (void)card;
}

static const struct {
    const char *name;
    void (*read)(struct plan_reader *reader, const struct card *card);
    int once; /* the plan may have one of it */
    const char *options[9];
} table[] = {
    {"HEADING", heading, 0, {NULL}},
    {"STUDY", plan_study, 1, {"COMMAND", "SEED", "REPLICATES", "BASELINE", "BOOTSTRAP", "DRAWS", NULL}},
    {"DECKS", plan_decks, 0, {NULL}},
    {"VARIANT", plan_variant, 0, {"NAME", NULL}},
    {"MODES", plan_modes, 0, {NULL}},
    {"SENSORS", plan_sensors, 0, {NULL}},
    {"DATA", plan_data, 1, {"SOURCE", "SHAPES", NULL}},
    {"TRUTH", plan_truth, 0, {NULL}},
    {"NOISE", plan_noise, 0, {NULL}},
    {"STARTS", plan_starts, 1, {"SPREAD", "COUNT", "GRID", NULL}},
    {"HIDE", plan_hide, 0, {"TYPE", "NAME", "GROUP", "AT", "SENSOR", "BETWEEN", "SHAPE", "MOUNT", NULL}},
};

#define DRAWS 200 /* of a run: the mean of many runs wants no more of each */
#define CARDS (sizeof table / sizeof *table)

const char *const plan_commands[] = {"identify", "diagnose", "speeds", NULL};

static void check_options(struct plan_reader *reader, const struct card *card, const char *const *options)
{
    char list[256] = "none";
    for (int o = 0, length = 0; options[o]; o++)
        length += snprintf(list + length, sizeof list - (size_t)length, "%s%s", o ? ", " : "", options[o]);
    for (int i = 0; i < card->noption; i++) {
        int known = !strcmp(card->name, "HIDE") && deck_cause_list_item(card, &card->option[i]);
        for (const char *const *name = options; *name; name++)
            known |= same_text(*name, card->option[i].name);
        if (!known)
            deck_error(&reader->fields, card->option[i].place, "option %s of *%s is not known, expected %s", card->option[i].name,
                       card->name, list);
    }
}

static void read_card(struct plan_reader *reader, int c)
{
    const struct card *card = &reader->plan->text.card[c];
    size_t t = 0;
    while (t < CARDS && strcmp(card->name, table[t].name))
        t++;
    if (t == CARDS) {
        deck_error(&reader->fields, card->place, "card *%s is not known in a plan, expected one of docs/study.md such as *DECKS",
                   card->name);
        return;
    }
    check_options(reader, card, table[t].options);
    for (int d = 0; d < c && table[t].once; d++)
        if (!strcmp(reader->plan->text.card[d].name, card->name)) {
            deck_error(&reader->fields, card->place, "*%s is given twice, expected once", card->name);
            return;
        }
    table[t].read(reader, card);
}

/* What only the whole plan tells. */
static void check_plan(struct plan_reader *reader)
{
    const struct plan *plan = reader->plan;
    struct deck_reader *fields = &reader->fields;
    if (!plan->ndeck && !fields->messages->errors)
        deck_error(fields, plan->text.end, "the plan names no deck, expected *DECKS with one path a line");
    if (reader->truth_card && !plan->from_model)
        deck_error(fields, reader->truth_card->place,
                   "*TRUTH is that of data a model makes, expected *DATA, SOURCE=MODEL with it");
    if (reader->hide_card && !plan->from_model)
        deck_error(fields, reader->hide_card->place, "*HIDE acts in data a model makes, expected *DATA, SOURCE=MODEL with it");
    if (reader->starts_card && plan->command == PLAN_DIAGNOSE)
        deck_error(fields, reader->starts_card->place, "*STARTS has no meaning for COMMAND=DIAGNOSE, expected COMMAND=IDENTIFY");
}

/* One entry for each axis that the plan does not have. */
static int fill_axes(struct pool *pool, struct plan *plan)
{
    if (!plan->nvariant && (plan->variant = POOL_NEW(pool, struct plan_variant)))
        plan->nvariant = 1;
    if (!plan->nmodes && (plan->modes = POOL_NEW(pool, struct plan_modes)))
        plan->nmodes = 1;
    if (!plan->nsensors && (plan->sensors = POOL_NEW(pool, struct plan_sensors)))
        plan->nsensors = 1;
    plan->has_noise = plan->nnoise > 0;
    if (!plan->nnoise && (plan->noise = POOL_NEW(pool, struct plan_noise))) {
        plan->nnoise = 1;
        plan->noise->shape = NAN;
    }
    if (!plan->nhide && (plan->hide = POOL_NEW(pool, struct plan_hide)))
        plan->nhide = 1;
    return plan->nvariant && plan->nmodes && plan->nsensors && plan->nnoise && plan->nhide ? ROTID_OK : ROTID_ERROR_MEMORY;
}

static struct plan empty(const char *path)
{
    return (struct plan){.path = path, .seed = 1, .replicates = 1, .count = 1, .draws = DRAWS};
}

int plan_read(struct pool *pool, const char *path, struct message_list *messages, struct plan *plan)
{
    struct plan_reader reader = {.fields = {.pool = pool, .messages = messages}, .plan = plan};
    *plan = empty(pool_copy_text(pool, path));
    int status = deck_text_read(pool, path, messages, &plan->text);
    if (status == ROTID_ERROR_IO || status == ROTID_ERROR_MEMORY || !plan->path)
        return plan->path ? status : ROTID_ERROR_MEMORY;
    for (int c = 0; c < plan->text.ncard && !reader.fields.out_of_memory; c++)
        read_card(&reader, c);
    check_plan(&reader);
    if (reader.fields.out_of_memory || messages->out_of_memory || fill_axes(pool, plan))
        return ROTID_ERROR_MEMORY;
    return messages->errors ? ROTID_ERROR_SYNTAX : ROTID_OK;
}

int plan_of_decks(struct pool *pool, int count, char *const *path, struct plan *plan)
{
    *plan = empty(NULL);
    plan->ndeck = count;
    plan->deck = POOL_ARRAY(pool, struct plan_deck, count);
    if (!plan->deck)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < count; i++)
        plan->deck[i] = (struct plan_deck){path[i], path[i], {path[i], 1, 1}};
    return fill_axes(pool, plan);
}

int plan_is(const char *path)
{
    struct pool pool;
    struct message_list unheard;
    struct deck_text text;
    int found = 0;
    pool_open(&pool, NULL);
    message_open(&unheard, &pool);
    if (deck_text_read(&pool, path, &unheard, &text) != ROTID_ERROR_MEMORY)
        for (int c = 0; c < text.ncard; c++)
            found |= !strcmp(text.card[c].name, "STUDY");
    pool_close(&pool);
    return found;
}
