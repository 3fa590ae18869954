/* A plan: its cards by one table, and what only the whole plan tells.
 *   STUDY                                     the command, seed, replicates
 *   DECKS, VARIANT, MODES, SENSORS, NOISE, HIDE  axes, a list each, whose entries have names that differ
 *   DATA, TRUTH, STARTS                       where the data and the starts come from */
#include "deck/deck_row.h"
#include "study/study.h"

#define DRAWS           200 /* of a run: the mean of many runs wants no more of each */
#define MOST_REPLICATES 10000000
#define MOST_GRID       1000
#define SEED_MOST       4294967295.0

const char *const plan_commands[] = {"identify", "diagnose", "speeds", NULL};

struct plan_reader {
    struct deck_reader fields; /* pool, messages and end of memory, for the readers of single fields */
    struct plan *plan;
};

static void add_item(struct plan_reader *reader, enum plan_axis axis, const struct plan_item *item)
{
    (void)POOL_ADD(reader->fields.pool, reader->plan->axis[axis].item, reader->plan->axis[axis].count, item);
}

/* The entry of that name, NULL where there is none. */
static const struct plan_item *find_item(const struct plan *plan, enum plan_axis axis, const char *name)
{
    for (int i = 0; i < plan->axis[axis].count; i++)
        if (same_text(plan->axis[axis].item[i].name, name))
            return &plan->axis[axis].item[i];
    return NULL;
}

static const char *const commands[] = {"IDENTIFY", "DIAGNOSE", "SPEEDS", NULL};

static void of_command(struct plan_reader *reader, const struct card_option *option, enum plan_command of)
{
    if (option && reader->plan->command != of)
        deck_error(&reader->fields, option->place, "%s has no meaning for COMMAND=%s, expected COMMAND=%s", option->name,
                   commands[reader->plan->command], commands[of]);
}

static void read_study(struct plan_reader *reader, const struct card *card)
{
    struct plan *plan = reader->plan;
    const struct card_option *seed = card_option(card, "SEED");
    double number = 0;
    if (seed && !deck_option_number(&reader->fields, seed, "", ANY, &number) &&
        (number != floor(number) || number < 0 || number > SEED_MOST))
        deck_error(&reader->fields, seed->value_place, "SEED is %s, expected a whole number from 0 to %.0f", seed->value,
                   SEED_MOST);
    else if (seed)
        plan->seed = (unsigned long)number;
    if (plan->baseline)
        of_command(reader, card_option(card, "BASELINE"), PLAN_IDENTIFY);
    of_command(reader, card_option(card, "DRAWS"), PLAN_SPEEDS);
}

static int read_deck(struct plan_reader *reader, const struct data_line *line, struct plan_item *item)
{
    item->path = deck_path_from(reader->fields.pool, line->text, line->place.file, NULL);
    return 0;
}

static void read_variant(struct plan_reader *reader, const struct card *card)
{
    struct pool *pool = reader->fields.pool;
    const char *name = deck_option(&reader->fields, card, "NAME", "a name for the table");
    if (name && find_item(reader->plan, AXIS_VARIANT, name))
        deck_error(&reader->fields, card_option(card, "NAME")->value_place, "variant %s is given twice, expected a new name",
                   name);
    struct plan_item variant = {.name = name ? name : "",
                                .override = POOL_ARRAY(pool, struct override, card->nline),
                                .override_place = POOL_ARRAY(pool, struct place, card->nline)};
    if (!variant.override || !variant.override_place)
        return;
    for (int i = 0; i < card->nline; i++) {
        const struct data_line *line = &card->line[i];
        struct override *override = &variant.override[variant.noverride];
        if (override_parse(pool, line->text, override)) {
            if (!override->value) /* else it has the form */
                deck_error(&reader->fields, line->place, "'%s' is no option of a deck, expected CARD.OPTION=VALUE", line->text);
            continue;
        }
        if (same_text(override->option, "FILE")) /* relative to the plan, not to where the user stands as with --set */
            override->value = deck_path_from(pool, override->value, line->place.file, NULL);
        /* what is wrong with it is found when the deck is read, and reported by this name: it is put in its place there */
        override->text = pool_format(pool, "variant %s, %s", variant.name, line->text);
        variant.override_place[variant.noverride++] = line->place;
    }
    add_item(reader, AXIS_VARIANT, &variant);
}

static int read_sensors(struct plan_reader *reader, const struct data_line *line, struct plan_item *item)
{
    struct deck_reader *fields = &reader->fields;
    int every = same_text(line->field[0].text, "EVERY"), all = same_text(line->field[0].text, "ALL");
    int bad = deck_count(fields, line, every ? 2 : 1);
    if (every)
        bad |= deck_integer(fields, line, 1, "each one so far on", 1, DECK_MOST_LINES, &item->every);
    else if (!all)
        bad |= deck_integer(fields, line, 0, "number of sensors", 1, DECK_MOST_LINES, &item->keep);
    item->name = all     ? "all"
                 : every ? pool_format(fields->pool, "every %d", item->every)
                         : pool_format(fields->pool, "%d", item->keep);
    return bad;
}

static int read_noise(struct plan_reader *reader, const struct data_line *line, struct plan_item *item)
{
    struct deck_reader *fields = &reader->fields;
    int bad = deck_count(fields, line, 2);
    bad |= deck_number(fields, line, 0, "noise of the frequencies", NOT_NEGATIVE, &item->frequency);
    item->shape = NAN;
    if (deck_has(line, 1))
        bad |= deck_number(fields, line, 1, "noise of the shapes", NOT_NEGATIVE, &item->shape);
    if (!bad && (item->frequency > 0.5 || item->shape > 0.5))
        deck_error(fields, line->place, "noise of %s is more than a half, expected values such as 0.001, 0.015", line->text);
    item->name = pool_format(fields->pool, "%.17g, %.17g", item->frequency, item->shape);
    return bad;
}

static void read_truth(struct plan_reader *reader, const struct card *card)
{
    struct plan *plan = reader->plan;
    for (int i = 0, count = deck_lines(&reader->fields, card, 1, DECK_MOST_LINES); i < count; i++) {
        const struct data_line *line = &card->line[i];
        struct plan_truth truth = {.name = line->field[0].text, .place = line->place};
        int bad = deck_count(&reader->fields, line, 3);
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

static void read_starts(struct plan_reader *reader, const struct card *card)
{
    const struct card_option *spread = card_option(card, "SPREAD"), *count = card_option(card, "COUNT");
    if (reader->plan->spread > 1e3)
        deck_error(&reader->fields, spread->value_place, "SPREAD is %s, expected a part of the start such as 0.7", spread->value);
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
    }
    return label;
}

/* The card as *CAUSE, whose values are those of field 1 (end 0) or, where there is one, of field 2 (end 1). */
static const struct card *cause_card(struct plan_reader *reader, const struct card *card, int end)
{
    struct pool *pool = reader->fields.pool;
    struct card *cause = POOL_NEW(pool, struct card);
    if (!cause)
        return NULL;
    *cause = *card;
    cause->name = "CAUSE";
    cause->kind = deck_card_find("CAUSE");
    cause->line = POOL_COPY(pool, card->line, card->nline, 0);
    const struct card_option hidden = {.name = "NAME", .value = "hidden", .place = card->place, .value_place = card->place};
    if (!cause->line || (!card_option(card, "NAME") && deck_text_add_option(pool, cause, hidden)))
        return NULL;
    for (int i = 0; i < card->nline; i++) {
        struct data_line *line = &cause->line[i];
        if (line->count <= 2)
            continue;
        line->field = POOL_COPY(pool, line->field, line->count, 0);
        if (!line->field)
            return NULL;
        line->field[1] = line->field[end ? 2 : 1];
        line->count = 2;
    }
    return cause;
}

static void read_hide(struct plan_reader *reader, const struct card *card)
{
    const char *type = deck_option(&reader->fields, card, "TYPE", "id of a cause, or NONE");
    const struct card_option *name = card_option(card, "NAME");
    struct plan_item hide = {.place = card->place};
    if (!type)
        return;
    int none = same_text(type, "NONE");
    hide.name = name && *name->value ? name->value : none ? "none" : label_of(reader, card);
    for (int i = 0; i < card->nline; i++) {
        if (none)
            deck_error(&reader->fields, card->line[i].place, "TYPE=NONE hides nothing, expected a card without data lines");
        else
            (void)deck_count(&reader->fields, &card->line[i], 3);
    }
    for (int end = 0; end < 2 && !none; end++)
        hide.end[end] = cause_card(reader, card, end);
    if (hide.name && find_item(reader->plan, AXIS_HIDE, hide.name))
        deck_error(&reader->fields, card->place, "two *HIDE are called %s, expected another NAME on one of them", hide.name);
    add_item(reader, AXIS_HIDE, &hide);
}

static const char *const sources[] = {"MEASURED", "MODEL", NULL};
static const struct deck_row no_rows[] = {LAST};
static const struct deck_row study_rows[] = {
    {.option = "COMMAND", WORD(struct plan, command, commands)},
    OTHER("SEED", ),
    {.option = "REPLICATES", WHOLE(struct plan, replicates, ""), FROM_TO(1, MOST_REPLICATES), OPTIONAL},
    {.option = "BASELINE", WORD(struct plan, baseline, deck_answers)},
    {.option = "DRAWS", WHOLE(struct plan, draws, ""), FROM_TO(0, 1000000), OPTIONAL},
    LAST};
static const struct deck_row data_rows[] = {{.option = "SOURCE", WORD(struct plan, from_model, sources)},
                                            {.option = "SHAPES", WORD(struct plan, shapes, deck_answers), .standard = 1},
                                            LAST};
static const struct deck_row starts_rows[] = {
    {.option = "SPREAD", ABOVE_0(struct plan, spread, "part of the start, such as 0.7")},
    {.option = "COUNT", WHOLE(struct plan, count, ""), FROM_TO(1, MOST_REPLICATES), OPTIONAL},
    {.option = "GRID", WHOLE(struct plan, grid, ""), FROM_TO(2, MOST_GRID), OPTIONAL},
    LAST};
static const struct deck_row variant_rows[] = {OTHER("NAME", ), LAST};
static const struct deck_row hide_rows[] = {OTHER("TYPE", ),  OTHER("NAME", ),   OTHER("GROUP", ),
                                            OTHER("AT", ),    OTHER("SENSOR", ), OTHER("BETWEEN", ),
                                            OTHER("SHAPE", ), OTHER("MOUNT", ),  LAST};

/* The cards there are. One with an axis has an entry of it in each data line, else code of its own behind its options. */
static const struct plan_card {
    const char *name;
    const struct deck_row *row; /* options, into struct plan */
    const char *lines;          /* what a data line holds, "": something else than values; NULL: there is none */
    void (*read)(struct plan_reader *reader, const struct card *card);
    enum plan_axis axis;
    const char *what; /* of entries that are given twice */
    /* the entry beside its name and place; nonzero after an error */
    int (*read_line)(struct plan_reader *reader, const struct data_line *line, struct plan_item *item);
} table[] = {
    {"HEADING", no_rows, "", NULL, 0, NULL, NULL},
    {"STUDY", study_rows, NULL, read_study, 0, NULL, NULL},
    {"DECKS", no_rows, "a path a line", NULL, AXIS_DECK, "deck ", read_deck},
    {"VARIANT", variant_rows, "", read_variant, 0, NULL, NULL},
    {"MODES", no_rows, "modes such as 1-4,6", NULL, AXIS_MODES, "modes ", NULL},
    {"SENSORS", no_rows, "a number of sensors, EVERY and a number, or ALL", NULL, AXIS_SENSORS, "", read_sensors},
    {"DATA", data_rows, NULL, NULL, 0, NULL, NULL},
    {"TRUTH", no_rows, "parameter, value [, upper value]", read_truth, 0, NULL, NULL},
    {"NOISE", no_rows, "relative standard deviation of the frequencies [, of the shapes]", NULL, AXIS_NOISE, "noise of ",
     read_noise},
    {"STARTS", starts_rows, NULL, read_starts, 0, NULL, NULL},
    {"HIDE", hide_rows, "parameter, value [, upper value]", read_hide, 0, NULL, NULL},
};

#define CARDS (sizeof table / sizeof *table)

/* An entry of an axis a line. */
static void read_items(struct plan_reader *reader, const struct card *card, const struct plan_card *kind)
{
    for (int i = 0, count = deck_lines(&reader->fields, card, 1, DECK_MOST_LINES); i < count; i++) {
        const struct data_line *line = &card->line[i];
        struct plan_item item = {.name = line->text, .place = line->place};
        int bad = kind->read_line && kind->read_line(reader, line, &item);
        for (int other = 0; other < reader->plan->axis[kind->axis].count && !bad && item.name; other++)
            if (!strcmp(reader->plan->axis[kind->axis].item[other].name, item.name))
                deck_error(&reader->fields, line->place, "%s%s %s given twice, expected once", kind->what, line->text,
                           kind->axis == AXIS_MODES ? "are" : "is");
        if (item.name)
            add_item(reader, kind->axis, &item);
    }
}

static void read_card(struct plan_reader *reader, int c)
{
    const struct card *card = &reader->plan->text.card[c];
    const struct plan_card *kind = table;
    while (kind < table + CARDS && strcmp(card->name, kind->name) != 0)
        kind++;
    if (kind == table + CARDS) {
        deck_error(&reader->fields, card->place, "card *%s is not known in a plan, expected one of docs/study.md such as *DECKS",
                   card->name);
        return;
    }
    deck_check_options(&reader->fields, card, kind->row);
    for (int d = 0; d < c && !kind->lines; d++) /* what has options alone stands once */
        if (!strcmp(reader->plan->text.card[d].name, card->name)) {
            deck_error(&reader->fields, card->place, "*%s is given twice, expected once", card->name);
            return;
        }
    if (card->nline && !kind->lines)
        deck_error(&reader->fields, card->line[0].place, "*%s has no data lines, expected options on the card", card->name);
    reader->fields.layout = kind->lines;
    reader->fields.row = kind->row;
    (void)deck_read_options(&reader->fields, card, reader->plan);
    if (kind->read)
        kind->read(reader, card);
    else if (kind->what)
        read_items(reader, card, kind);
}

/* The last card of that name. */
static const struct card *find_card(const struct plan *plan, const char *name)
{
    for (int c = plan->text.ncard; c-- > 0;)
        if (!strcmp(plan->text.card[c].name, name))
            return &plan->text.card[c];
    return NULL;
}

/* What only the whole plan tells. */
static void check_plan(struct plan_reader *reader)
{
    const struct plan *plan = reader->plan;
    struct deck_reader *fields = &reader->fields;
    const struct card *truth = find_card(plan, "TRUTH"), *hide = find_card(plan, "HIDE"), *starts = find_card(plan, "STARTS");
    if (!plan->axis[AXIS_DECK].count && !fields->messages->errors)
        deck_error(fields, plan->text.end, "the plan names no deck, expected *DECKS with one path a line");
    if (truth && !plan->from_model)
        deck_error(fields, truth->place, "*TRUTH is that of data a model makes, expected *DATA, SOURCE=MODEL with it");
    if (hide && !plan->from_model)
        deck_error(fields, hide->place, "*HIDE acts in data a model makes, expected *DATA, SOURCE=MODEL with it");
    if (starts && plan->command == PLAN_DIAGNOSE)
        deck_error(fields, starts->place, "*STARTS has no meaning for COMMAND=DIAGNOSE, expected COMMAND=IDENTIFY");
}

static const struct plan_item none = {.shape = NAN};

/* One entry without a name for each axis that the plan does not have. */
static int fill_axes(struct pool *pool, struct plan *plan)
{
    int failed = 0;
    for (int a = 0; a < PLAN_AXES; a++)
        failed |= !plan->axis[a].count && POOL_ADD(pool, plan->axis[a].item, plan->axis[a].count, &none);
    return failed ? ROTID_ERROR_MEMORY : ROTID_OK;
}

static struct plan empty(const char *path)
{
    return (struct plan){.path = path, .seed = 1, .replicates = 1, .count = 1, .draws = DRAWS, .shapes = 1};
}

const struct plan_item *plan_at(const struct plan *plan, const struct study_cell *cell, enum plan_axis axis)
{
    return cell->at[axis] < 0 ? &none : &plan->axis[axis].item[cell->at[axis]];
}

int plan_read(struct pool *pool, const char *path, struct message_list *messages, struct plan *plan)
{
    struct plan_reader reader = {.fields = {.pool = pool, .messages = messages}, .plan = plan};
    *plan = empty(pool_copy_text(pool, path));
    int status = deck_text_read(pool, path, NULL, messages, &plan->text);
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
    for (int i = 0; i < count; i++) {
        const struct plan_item deck = {.name = path[i], .path = path[i], .place = {path[i], 1, 1}};
        if (POOL_ADD(pool, plan->axis[AXIS_DECK].item, plan->axis[AXIS_DECK].count, &deck))
            return ROTID_ERROR_MEMORY;
    }
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
    if (deck_text_read(&pool, path, NULL, &unheard, &text) == ROTID_ERROR_MEMORY)
        found = ROTID_ERROR_MEMORY;
    else
        for (int c = 0; c < text.ncard; c++)
            found |= !strcmp(text.card[c].name, "STUDY");
    pool_close(&pool);
    return found;
}
