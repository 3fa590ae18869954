/* A plan: its cards, each read by a routine of its own, and what only the whole plan tells.
 *   STUDY                                     the command, seed, replicates
 *   DECKS, VARIANT, MODES, SENSORS, NOISE, HIDE  axes, a list each, whose entries have names that differ
 *   DATA, TRUTH, STARTS                       where the data and the starts come from */
#include "deck/deck_row.h"
#include "study/study.h"

#include <math.h>
#include <string.h>

#define DRAWS           200 /* of a run: the mean of many runs wants no more of each */
#define MOST_REPLICATES 10000000
#define MOST_GRID       1000
#define SEED_MOST       4294967295.0

const char *const plan_commands[] = {"identify", "diagnose", "speeds", NULL};

struct plan_reader {
    struct deck_reader fields; /* pool, messages and end of memory, for the readers of single fields */
    struct plan *plan;
    const struct card *starts_card, *truth_card, *hide_card;
};

static void no_data(struct plan_reader *reader, const struct card *card)
{
    if (card->nline)
        deck_error(&reader->fields, card->line[0].place, "*%s has no data lines, expected options on the card", card->name);
}

static void of_command(struct plan_reader *reader, const struct card_option *option, enum plan_command of,
                       const char *const *commands)
{
    if (option && reader->plan->command != of)
        deck_error(&reader->fields, option->place, "%s has no meaning for COMMAND=%s, expected COMMAND=%s", option->name,
                   commands[reader->plan->command], commands[of]);
}

static void read_study(struct plan_reader *reader, const struct card *card)
{
    static const char *const commands[] = {"IDENTIFY", "DIAGNOSE", "SPEEDS", NULL};
    static const struct deck_row rows[] = {
        {.option = "COMMAND", WORD(struct plan, command, commands)},
        {.option = "BASELINE", WORD(struct plan, baseline, deck_answers)},
        {.option = "REPLICATES", WHOLE(struct plan, replicates, ""), FROM_TO(1, MOST_REPLICATES), OPTIONAL},
        {.option = "BOOTSTRAP", WHOLE(struct plan, bootstrap, ""), FROM_TO(100, 1000000), OPTIONAL},
        {.option = "DRAWS", WHOLE(struct plan, draws, ""), FROM_TO(0, 1000000), OPTIONAL},
        LAST};
    struct plan *plan = reader->plan;
    const struct card_option *seed = card_option(card, "SEED");
    double number = 0;
    no_data(reader, card);
    (void)deck_read_options(&reader->fields, card, rows, plan);
    if (seed && !deck_option_number(&reader->fields, seed, "", ANY, &number) &&
        (number != floor(number) || number < 0 || number > SEED_MOST))
        deck_error(&reader->fields, seed->value_place, "SEED is %s, expected a whole number from 0 to %.0f", seed->value,
                   SEED_MOST);
    else if (seed)
        plan->seed = (unsigned long)number;
    if (plan->baseline)
        of_command(reader, card_option(card, "BASELINE"), PLAN_IDENTIFY, commands);
    of_command(reader, card_option(card, "BOOTSTRAP"), PLAN_DIAGNOSE, commands);
    of_command(reader, card_option(card, "DRAWS"), PLAN_SPEEDS, commands);
}

/* As seen from where the program runs: a relative one is relative to the file that names it. */
static const char *beside(struct plan_reader *reader, struct place place, const char *path)
{
    const char *slash = strrchr(place.file, '/');
    if (*path == '/' || !slash)
        return path;
    return pool_format(reader->fields.pool, "%.*s/%s", (int)(slash - place.file), place.file, path);
}

static void read_decks(struct plan_reader *reader, const struct card *card)
{
    struct plan *plan = reader->plan;
    for (int i = 0, count = deck_lines(&reader->fields, card, 1, DECK_MOST_LINES, "a path a line"); i < count; i++) {
        const struct data_line *line = &card->line[i];
        for (int d = 0; d < plan->ndeck; d++)
            if (!strcmp(plan->deck[d].name, line->text))
                deck_error(&reader->fields, line->place, "deck %s is given twice, expected once", line->text);
        const struct plan_deck deck = {line->text, beside(reader, line->place, line->text), line->place};
        (void)POOL_ADD(reader->fields.pool, plan->deck, plan->ndeck, &deck);
    }
}

/* A file that a variant names is relative to the plan, not to where the user stands as with --set. */
static void place_file(struct plan_reader *reader, struct place place, struct override *override)
{
    if (same_text(override->option, "FILE"))
        override->value = beside(reader, place, override->value);
}

static void read_variant(struct plan_reader *reader, const struct card *card)
{
    struct plan *plan = reader->plan;
    struct pool *pool = reader->fields.pool;
    const char *name = deck_option(&reader->fields, card, "NAME", "a name for the table");
    for (int v = 0; v < plan->nvariant && name; v++)
        if (same_text(plan->variant[v].name, name))
            deck_error(&reader->fields, card_option(card, "NAME")->value_place, "variant %s is given twice, expected a new name",
                       name);
    struct plan_variant variant = {.name = name ? name : "",
                                   .override = POOL_ARRAY(pool, struct override, card->nline),
                                   .place = POOL_ARRAY(pool, struct place, card->nline)};
    if (!variant.override || !variant.place)
        return;
    for (int i = 0; i < card->nline; i++) {
        const struct data_line *line = &card->line[i];
        struct override *override = &variant.override[variant.noverride];
        if (override_parse(pool, line->text, override)) {
            if (!override->value) /* else it has the form */
                deck_error(&reader->fields, line->place, "'%s' is no option of a deck, expected CARD.OPTION=VALUE", line->text);
            continue;
        }
        place_file(reader, line->place, override);
        /* what is wrong with it is found when the deck is read, and reported by this name: it is put in its place there */
        override->text = pool_format(pool, "variant %s, %s", variant.name, line->text);
        variant.place[variant.noverride++] = line->place;
    }
    (void)POOL_ADD(reader->fields.pool, plan->variant, plan->nvariant, &variant);
}

static void read_modes(struct plan_reader *reader, const struct card *card)
{
    struct plan *plan = reader->plan;
    for (int i = 0, count = deck_lines(&reader->fields, card, 1, DECK_MOST_LINES, "modes such as 1-4,6"); i < count; i++) {
        const struct data_line *line = &card->line[i];
        for (int m = 0; m < plan->nmodes; m++)
            if (!strcmp(plan->modes[m].text, line->text))
                deck_error(&reader->fields, line->place, "modes %s are given twice, expected once", line->text);
        const struct plan_modes modes = {line->text, line->place};
        (void)POOL_ADD(reader->fields.pool, plan->modes, plan->nmodes, &modes);
    }
}

static void read_sensors(struct plan_reader *reader, const struct card *card)
{
    static const char layout[] = "a number of sensors, EVERY and a number, or ALL";
    struct plan *plan = reader->plan;
    for (int i = 0, count = deck_lines(&reader->fields, card, 1, DECK_MOST_LINES, layout); i < count; i++) {
        const struct data_line *line = &card->line[i];
        struct plan_sensors sensors = {.place = line->place};
        int every = same_text(line->field[0].text, "EVERY"), all = same_text(line->field[0].text, "ALL");
        int bad = deck_count(&reader->fields, line, every ? 2 : 1, layout);
        if (every)
            bad |= deck_integer(&reader->fields, line, 1, "each one so far on", 1, DECK_MOST_LINES, &sensors.every);
        else if (!all)
            bad |= deck_integer(&reader->fields, line, 0, "number of sensors", 1, DECK_MOST_LINES, &sensors.keep);
        sensors.text = all     ? "all"
                       : every ? pool_format(reader->fields.pool, "every %d", sensors.every)
                               : pool_format(reader->fields.pool, "%d", sensors.keep);
        for (int s = 0; s < plan->nsensors && !bad && sensors.text; s++)
            if (!strcmp(plan->sensors[s].text, sensors.text))
                deck_error(&reader->fields, line->place, "%s is given twice, expected once", line->text);
        if (sensors.text)
            (void)POOL_ADD(reader->fields.pool, plan->sensors, plan->nsensors, &sensors);
    }
}

static void read_data(struct plan_reader *reader, const struct card *card)
{
    static const char *const sources[] = {"MEASURED", "MODEL", NULL};
    const struct card_option *source = card_option(card, "SOURCE"), *shapes = card_option(card, "SHAPES");
    int word;
    no_data(reader, card);
    if (source && (word = deck_option_word(&reader->fields, source, sources)) >= 0)
        reader->plan->from_model = word;
    if (shapes && (word = deck_option_word(&reader->fields, shapes, deck_answers)) >= 0)
        reader->plan->no_shapes = !word;
}

static void read_truth(struct plan_reader *reader, const struct card *card)
{
    static const char layout[] = "parameter, value [, upper value]";
    struct plan *plan = reader->plan;
    reader->truth_card = card;
    for (int i = 0, count = deck_lines(&reader->fields, card, 1, DECK_MOST_LINES, layout); i < count; i++) {
        const struct data_line *line = &card->line[i];
        struct plan_truth truth = {.name = line->field[0].text, .place = line->place};
        int bad = deck_count(&reader->fields, line, 3, layout);
        bad |= deck_number(&reader->fields, line, 1, "value", ANY, &truth.lower);
        truth.upper = truth.lower;
        if (deck_has(line, 2))
            bad |= deck_number(&reader->fields, line, 2, "upper value", ANY, &truth.upper);
        if (!bad && truth.upper < truth.lower)
            deck_error(&reader->fields, line->field[1].place, "%s lies between %s and %s, expected the lower one first",
                       truth.name, line->field[1].text, line->field[2].text);
        for (int t = 0; t < plan->ntruth; t++)
            if (same_text(plan->truth[t].name, truth.name))
                deck_error(&reader->fields, line->place, "%s is given twice, expected once", truth.name);
        (void)POOL_ADD(reader->fields.pool, plan->truth, plan->ntruth, &truth);
    }
}

static void read_noise(struct plan_reader *reader, const struct card *card)
{
    static const char layout[] = "relative standard deviation of the frequencies [, of the shapes]";
    struct plan *plan = reader->plan;
    for (int i = 0, count = deck_lines(&reader->fields, card, 1, DECK_MOST_LINES, layout); i < count; i++) {
        const struct data_line *line = &card->line[i];
        struct plan_noise noise = {.shape = NAN};
        int bad = deck_count(&reader->fields, line, 2, layout);
        bad |= deck_number(&reader->fields, line, 0, "noise of the frequencies", NOT_NEGATIVE, &noise.frequency);
        if (deck_has(line, 1))
            bad |= deck_number(&reader->fields, line, 1, "noise of the shapes", NOT_NEGATIVE, &noise.shape);
        if (!bad && (noise.frequency > 0.5 || noise.shape > 0.5))
            deck_error(&reader->fields, line->place, "noise of %s is more than a half, expected values such as 0.001, 0.015",
                       line->text);
        for (int n = 0; n < plan->nnoise && !bad; n++)
            if (plan->noise[n].frequency == noise.frequency &&
                (plan->noise[n].shape == noise.shape || (isnan(plan->noise[n].shape) && isnan(noise.shape))))
                deck_error(&reader->fields, line->place, "noise of %s is given twice, expected once", line->text);
        (void)POOL_ADD(reader->fields.pool, plan->noise, plan->nnoise, &noise);
    }
}

static void read_starts(struct plan_reader *reader, const struct card *card)
{
    struct plan *plan = reader->plan;
    const struct card_option *spread = card_option(card, "SPREAD"), *count = card_option(card, "COUNT");
    static const struct deck_row rows[] = {
        {.option = "COUNT", WHOLE(struct plan, count, ""), FROM_TO(1, MOST_REPLICATES), OPTIONAL},
        {.option = "GRID", WHOLE(struct plan, grid, ""), FROM_TO(2, MOST_GRID), OPTIONAL},
        LAST};
    reader->starts_card = card;
    no_data(reader, card);
    if (!deck_option(&reader->fields, card, "SPREAD", "part of the start, such as 0.7"))
        return;
    if (!deck_option_number(&reader->fields, spread, "", POSITIVE, &plan->spread) && plan->spread > 1e3)
        deck_error(&reader->fields, spread->value_place, "SPREAD is %s, expected a part of the start such as 0.7", spread->value);
    (void)deck_read_options(&reader->fields, card, rows, plan);
    if (count && card_option(card, "GRID"))
        deck_error(&reader->fields, count->place, "COUNT and GRID are both given, expected one of them");
}

/* HIDE: an effect in the data that the fitted model does not have. It is stated as on a CAUSE card and read as one, at either end
 * of the ranges of its values, when the deck is known. */

/* What the table calls it: its type and what it acts on. */
static const char *label_of(struct plan_reader *reader, const struct card *card)
{
    static const char *const parts[] = {"TYPE", "GROUP", "BETWEEN", "AT", "SENSOR", "SHAPE", "MOUNT"};
    const char *label = "";
    for (size_t p = 0; p < sizeof parts / sizeof *parts && label; p++) {
        const struct card_option *option = card_option(card, parts[p]);
        if (option)
            label = pool_format(reader->fields.pool, "%s%s%s", label, *label ? " " : "", option->value);
        for (int i = 0; i < card->noption && option && label; i++)
            if (!strcmp(parts[p], "BETWEEN") && deck_cause_list_item(card, &card->option[i]))
                label = pool_format(reader->fields.pool, "%s,%s", label, card->option[i].name);
    }
    return label;
}

/* The card as *CAUSE, whose values are those of field 1 (end 0) or, where there is one, of field 2 (end 1). */
static const struct card *cause_card(struct plan_reader *reader, const struct card *card, int end)
{
    struct pool *pool = reader->fields.pool;
    struct card *cause = POOL_NEW(pool, struct card);
    int named = card_option(card, "NAME") != NULL;
    if (!cause)
        return NULL;
    *cause = (struct card){.name = "CAUSE", .place = card->place, .noption = card->noption + !named, .nline = card->nline};
    cause->option = POOL_ARRAY(pool, struct card_option, cause->noption);
    cause->line = POOL_ARRAY(pool, struct data_line, card->nline);
    if (!cause->option || !cause->line)
        return NULL;
    /* in front: behind BETWEEN=left, the name of the second group may stand last */
    if (!named)
        cause->option[0] =
            (struct card_option){.name = "NAME", .value = "hidden", .place = card->place, .value_place = card->place};
    memcpy(cause->option + !named, card->option, (size_t)card->noption * sizeof *card->option);
    for (int i = 0; i < card->nline; i++) {
        struct data_line *line = &cause->line[i];
        *line = card->line[i];
        line->field = POOL_COPY(pool, card->line[i].field, line->count, 0);
        if (!line->field)
            return NULL;
        if (line->count > 2 && end)
            line->field[1] = line->field[2];
        line->count = line->count > 2 ? 2 : line->count;
    }
    return cause;
}

static void read_hide(struct plan_reader *reader, const struct card *card)
{
    struct plan *plan = reader->plan;
    const char *type = deck_option(&reader->fields, card, "TYPE", "id of a cause, or NONE");
    const struct card_option *name = card_option(card, "NAME");
    struct plan_hide hide = {.place = card->place};
    reader->hide_card = card;
    if (!type)
        return;
    int none = same_text(type, "NONE");
    hide.name = name && *name->value ? name->value : none ? "none" : label_of(reader, card);
    for (int i = 0; i < card->nline; i++) {
        if (none)
            deck_error(&reader->fields, card->line[i].place, "TYPE=NONE hides nothing, expected a card without data lines");
        else
            (void)deck_count(&reader->fields, &card->line[i], 3, "parameter, value [, upper value]");
    }
    if (!none) {
        hide.lower = cause_card(reader, card, 0);
        hide.upper = cause_card(reader, card, 1);
    }
    for (int h = 0; h < plan->nhide && hide.name; h++)
        if (same_text(plan->hide[h].name, hide.name))
            deck_error(&reader->fields, card->place, "two *HIDE are called %s, expected another NAME on one of them", hide.name);
    (void)POOL_ADD(reader->fields.pool, plan->hide, plan->nhide, &hide);
}

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
    {"STUDY", read_study, 1, {"COMMAND", "SEED", "REPLICATES", "BASELINE", "BOOTSTRAP", "DRAWS", NULL}},
    {"DECKS", read_decks, 0, {NULL}},
    {"VARIANT", read_variant, 0, {"NAME", NULL}},
    {"MODES", read_modes, 0, {NULL}},
    {"SENSORS", read_sensors, 0, {NULL}},
    {"DATA", read_data, 1, {"SOURCE", "SHAPES", NULL}},
    {"TRUTH", read_truth, 0, {NULL}},
    {"NOISE", read_noise, 0, {NULL}},
    {"STARTS", read_starts, 1, {"SPREAD", "COUNT", "GRID", NULL}},
    {"HIDE", read_hide, 0, {"TYPE", "NAME", "GROUP", "AT", "SENSOR", "BETWEEN", "SHAPE", "MOUNT", NULL}},
};

#define CARDS (sizeof table / sizeof *table)

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
    for (int c = 0; c < plan->text.ncard && !pool->out_of_memory; c++)
        read_card(&reader, c);
    check_plan(&reader);
    if (pool->out_of_memory || messages->pool->out_of_memory || fill_axes(pool, plan))
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
    if (deck_text_read(&pool, path, &unheard, &text) == ROTID_ERROR_MEMORY)
        found = ROTID_ERROR_MEMORY;
    else
        for (int c = 0; c < text.ncard; c++)
            found |= !strcmp(text.card[c].name, "STUDY");
    pool_close(&pool);
    return found;
}
