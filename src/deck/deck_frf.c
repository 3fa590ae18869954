/* FRF: which transfer functions are to be synthesised, beside which measured ones. */
#include <errno.h>
#include <math.h>
#include <string.h>
#include <unistd.h>

#include "base/base.h"
#include "deck/deck.h"
#include "deck/deck_row.h"
#include "diagnose/causes/causes.h"

/* Absolute, since an extended deck may be written elsewhere; that it is there is known before anything is computed. */
static const char *measured_file(struct deck_reader *reader, const struct card *card, const struct card_option *option)
{
    char folder[4096], why[HOST_ERROR_TEXT];
    if (!*option->value) {
        deck_error(reader, option->place, "*FRF has an empty FILE, expected FILE=path of a universal file");
        return NULL;
    }
    const char *path = deck_path(reader, card, option);
    if (!path)
        return NULL;
    if (access(path, R_OK)) {
        deck_error(reader, option->value_place, "%s: %s, expected a universal file", path, host_error_text(errno, why));
        return NULL;
    }
    if (*path != '/' && getcwd(folder, sizeof folder))
        path = pool_format(reader->pool, "%s/%s", folder, path);
    reader->out_of_memory |= !path;
    return path;
}

static int is_of_nodes(const char *option)
{
    return same_text(option, "AXIS") || same_text(option, "FLIP") || same_text(option, "ORIGIN");
}

/* What no row says of the lines, and of where the nodes of the file are. */
static void check_options(struct deck_reader *reader, const struct card *card)
{
    const struct frf_request *frf = &reader->job->options.frf;
    const struct card_option *low = card_option(card, "LOW"), *high = card_option(card, "HIGH"),
                             *step = card_option(card, "STEP"), *lines = card_option(card, "LINES"),
                             *damping = card_option(card, "DAMPING");
    if (low && high && frf->high_hz <= frf->low_hz)
        deck_error(reader, high->value_place, "HIGH is %s and LOW %s, expected HIGH above LOW", high->value, low->value);
    else if (step && lines)
        deck_error(reader, lines->value_place, "STEP and LINES are both given, expected one of them");
    else if ((step || lines) && frf->file)
        deck_error(
            reader, (step ? step : lines)->place,
            "%s with FILE: measured functions are not interpolated, expected the lines of the file (LOW and HIGH limit them)",
            step ? "STEP" : "LINES");
    else if (step && high && frf->high_hz / frf->step_hz > FRF_MOST_LINES)
        deck_error(reader, step->value_place, "STEP is %s, expected at most %d lines up to HIGH", step->value, FRF_MOST_LINES);
    if (damping && frf->damping >= 1)
        deck_error(reader, damping->value_place, "DAMPING is %s, expected a ratio below 1: a fraction of critical damping",
                   damping->value);
    for (int i = 0; i < card->noption && !card_option(card, "FILE"); i++)
        if (is_of_nodes(card->option[i].name)) {
            deck_error(reader, card->option[i].place, "%s places the nodes of a file, expected FILE beside it",
                       card->option[i].name);
            return;
        }
}

/* Ids that are no sensors may be nodes of the file, which is read when the functions are. */
static void read_pairs(struct deck_reader *reader, const struct card *card)
{
    const char *layout = reader->layout;
    struct frf_request *frf = &reader->job->options.frf;
    for (int i = 0, count = deck_lines(reader, card, 0, DECK_MOST_LINES, layout); i < count; i++) {
        const struct data_line *line = &card->line[i];
        struct frf_pair pair;
        int bad = deck_count(reader, line, 2, layout);
        bad |= deck_integer(reader, line, 0, "response sensor id", 1, 1000000000, &pair.response);
        bad |= deck_integer(reader, line, 1, "reference sensor id", 1, 1000000000, &pair.reference);
        for (int f = 0; f < 2 && !bad && !card_option(card, "FILE"); f++)
            if (sensor_find(reader->job, f ? pair.reference : pair.response) < 0) {
                deck_error(reader, line->field[f].place, "sensor %d is not among *SENSORS, expected one that is",
                           f ? pair.reference : pair.response);
                bad = 1;
            }
        if (bad)
            continue;
        (void)DECK_ADD(reader, frf->pair, frf->npair, &pair);
    }
}

void deck_frf(struct deck_reader *reader, const struct card *card)
{
    struct frf_request *frf = &reader->job->options.frf;
    const struct card_option *file = card_option(card, "FILE");
    *frf = (struct frf_request){.given = 1, .has_quantity = card_option(card, "QUANTITY") != NULL};
    if (file)
        frf->file = measured_file(reader, card, file);
    if (!deck_read_options(reader, card, deck_frf_rows, frf))
        check_options(reader, card);
    if (frf->flip && !card_option(card, "ORIGIN"))
        frf->origin = reader->length;
    read_pairs(reader, card);
}
