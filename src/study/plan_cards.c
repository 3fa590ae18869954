/* STUDY, DECKS, and the axes that are lists: VARIANT, MODES, SENSORS, NOISE; DATA, TRUTH, STARTS. */
#include "study/study.h"

#include <math.h>
#include <string.h>

#define MOST_REPLICATES 10000000
#define MOST_GRID       1000

static int whole_option(struct plan_reader *reader, const struct card *card, const char *name, double least, double most,
                        double *value)
{
    const struct card_option *option = card_option(card, name);
    double number;
    if (!option || deck_option_number(&reader->fields, option, "", ANY, &number))
        return 0;
    if (number != floor(number) || number < least || number > most) {
        deck_error(&reader->fields, option->value_place, "%s is %s, expected a whole number from %.0f to %.0f", name,
                   option->value, least, most);
        return 0;
    }
    *value = number;
    return 1;
}

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

void plan_study(struct plan_reader *reader, const struct card *card)
{
    static const char *const commands[] = {"IDENTIFY", "DIAGNOSE", "SPEEDS", NULL};
    struct plan *plan = reader->plan;
    const struct card_option *command = card_option(card, "COMMAND"), *baseline = card_option(card, "BASELINE");
    double number;
    int word;
    reader->study_card = card;
    no_data(reader, card);
    if (command && (word = deck_option_word(&reader->fields, command, commands)) >= 0)
        plan->command = (enum plan_command)word;
    if (baseline && (word = deck_option_word(&reader->fields, baseline, deck_answers)) >= 0)
        plan->baseline = word;
    if (whole_option(reader, card, "SEED", 0, 4294967295.0, &number))
        plan->seed = (unsigned long)number;
    if (whole_option(reader, card, "REPLICATES", 1, MOST_REPLICATES, &number))
        plan->replicates = (int)number;
    if (whole_option(reader, card, "BOOTSTRAP", 100, 1000000, &number))
        plan->bootstrap = (int)number;
    if (whole_option(reader, card, "DRAWS", 0, 1000000, &number))
        plan->draws = (int)number;
    if (plan->baseline)
        of_command(reader, baseline, PLAN_IDENTIFY, commands);
    of_command(reader, card_option(card, "BOOTSTRAP"), PLAN_DIAGNOSE, commands);
    of_command(reader, card_option(card, "DRAWS"), PLAN_SPEEDS, commands);
}

/* As seen from where the program runs: a relative one is relative to the file that names it. */
static const char *beside(struct plan_reader *reader, struct place place, const char *path)
{
    const char *slash = strrchr(place.file, '/');
    if (*path == '/' || !slash)
        return path;
    const char *full = pool_format(reader->fields.pool, "%.*s/%s", (int)(slash - place.file), place.file, path);
    reader->fields.out_of_memory |= !full;
    return full;
}

void plan_decks(struct plan_reader *reader, const struct card *card)
{
    struct plan *plan = reader->plan;
    for (int i = 0, count = deck_lines(&reader->fields, card, 1, DECK_MOST_LINES, "a path a line"); i < count; i++) {
        const struct data_line *line = &card->line[i];
        for (int d = 0; d < plan->ndeck; d++)
            if (!strcmp(plan->deck[d].name, line->text))
                deck_error(&reader->fields, line->place, "deck %s is given twice, expected once", line->text);
        struct plan_deck *deck = DECK_APPEND(&reader->fields, plan->deck, plan->ndeck, reader->deck_room);
        if (!deck)
            return;
        *deck = (struct plan_deck){line->text, beside(reader, line->place, line->text), line->place};
        plan->ndeck++;
    }
}

/* A file that a variant names is relative to the plan, not to where the user stands as with --set. */
static void place_file(struct plan_reader *reader, struct place place, struct override *override)
{
    if (same_text(override->option, "FILE"))
        override->value = beside(reader, place, override->value);
}

void plan_variant(struct plan_reader *reader, const struct card *card)
{
    struct plan *plan = reader->plan;
    struct pool *pool = reader->fields.pool;
    const char *name = deck_option(&reader->fields, card, "NAME", "a name for the table");
    for (int v = 0; v < plan->nvariant && name; v++)
        if (same_text(plan->variant[v].name, name))
            deck_error(&reader->fields, card_option(card, "NAME")->value_place, "variant %s is given twice, expected a new name",
                       name);
    struct plan_variant *variant = DECK_APPEND(&reader->fields, plan->variant, plan->nvariant, reader->variant_room);
    if (!variant)
        return;
    *variant = (struct plan_variant){.name = name ? name : "",
                                     .override = POOL_ARRAY(pool, struct override, card->nline),
                                     .place = POOL_ARRAY(pool, struct place, card->nline)};
    plan->nvariant++;
    if (!variant->override || !variant->place) {
        reader->fields.out_of_memory = 1;
        return;
    }
    for (int i = 0; i < card->nline; i++) {
        const struct data_line *line = &card->line[i];
        struct override *override = &variant->override[variant->noverride];
        if (override_parse(pool, line->text, override)) {
            if (override->value) /* it has the form */
                reader->fields.out_of_memory = 1;
            else
                deck_error(&reader->fields, line->place, "'%s' is no option of a deck, expected CARD.OPTION=VALUE", line->text);
            continue;
        }
        place_file(reader, line->place, override);
        /* what is wrong with it is found when the deck is read, and reported by this name: it is put in its place there */
        override->text = pool_format(pool, "variant %s, %s", variant->name, line->text);
        reader->fields.out_of_memory |= !override->text;
        variant->place[variant->noverride++] = line->place;
    }
}

void plan_modes(struct plan_reader *reader, const struct card *card)
{
    struct plan *plan = reader->plan;
    for (int i = 0, count = deck_lines(&reader->fields, card, 1, DECK_MOST_LINES, "modes such as 1-4,6"); i < count; i++) {
        const struct data_line *line = &card->line[i];
        for (int m = 0; m < plan->nmodes; m++)
            if (!strcmp(plan->modes[m].text, line->text))
                deck_error(&reader->fields, line->place, "modes %s are given twice, expected once", line->text);
        struct plan_modes *modes = DECK_APPEND(&reader->fields, plan->modes, plan->nmodes, reader->modes_room);
        if (!modes)
            return;
        *modes = (struct plan_modes){line->text, line->place};
        plan->nmodes++;
    }
}

void plan_sensors(struct plan_reader *reader, const struct card *card)
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
        reader->fields.out_of_memory |= !sensors.text;
        for (int s = 0; s < plan->nsensors && !bad && sensors.text; s++)
            if (!strcmp(plan->sensors[s].text, sensors.text))
                deck_error(&reader->fields, line->place, "%s is given twice, expected once", line->text);
        struct plan_sensors *added = DECK_APPEND(&reader->fields, plan->sensors, plan->nsensors, reader->sensors_room);
        if (!added || !sensors.text)
            return;
        *added = sensors;
        plan->nsensors++;
    }
}

void plan_data(struct plan_reader *reader, const struct card *card)
{
    static const char *const sources[] = {"MEASURED", "MODEL", NULL};
    const struct card_option *source = card_option(card, "SOURCE"), *shapes = card_option(card, "SHAPES");
    int word;
    reader->data_card = card;
    no_data(reader, card);
    if (source && (word = deck_option_word(&reader->fields, source, sources)) >= 0)
        reader->plan->from_model = word;
    if (shapes && (word = deck_option_word(&reader->fields, shapes, deck_answers)) >= 0)
        reader->plan->no_shapes = !word;
}

void plan_truth(struct plan_reader *reader, const struct card *card)
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
        struct plan_truth *added = DECK_APPEND(&reader->fields, plan->truth, plan->ntruth, reader->truth_room);
        if (!added)
            return;
        *added = truth;
        plan->ntruth++;
    }
}

void plan_noise(struct plan_reader *reader, const struct card *card)
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
        struct plan_noise *added = DECK_APPEND(&reader->fields, plan->noise, plan->nnoise, reader->noise_room);
        if (!added)
            return;
        *added = noise;
        plan->nnoise++;
    }
}

void plan_starts(struct plan_reader *reader, const struct card *card)
{
    struct plan *plan = reader->plan;
    const struct card_option *spread = card_option(card, "SPREAD"), *count = card_option(card, "COUNT");
    double number;
    reader->starts_card = card;
    no_data(reader, card);
    if (!deck_option(&reader->fields, card, "SPREAD", "part of the start, such as 0.7"))
        return;
    if (!deck_option_number(&reader->fields, spread, "", POSITIVE, &plan->spread) && plan->spread > 1e3)
        deck_error(&reader->fields, spread->value_place, "SPREAD is %s, expected a part of the start such as 0.7", spread->value);
    if (whole_option(reader, card, "COUNT", 1, MOST_REPLICATES, &number))
        plan->count = (int)number;
    if (whole_option(reader, card, "GRID", 2, MOST_GRID, &number))
        plan->grid = (int)number;
    if (count && card_option(card, "GRID"))
        deck_error(&reader->fields, count->place, "COUNT and GRID are both given, expected one of them");
}
