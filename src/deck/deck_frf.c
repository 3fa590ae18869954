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

static void read_lines(struct deck_reader *reader, const struct card *card)
{
    struct frf_request *frf = &reader->job->options.frf;
    const struct card_option *low = card_option(card, "LOW"), *high = card_option(card, "HIGH"),
                             *step = card_option(card, "STEP"), *lines = card_option(card, "LINES");
    if (deck_read_options(reader, card, deck_frf_rows, frf))
        return;
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
}

static void read_nodes_of_file(struct deck_reader *reader, const struct card *card)
{
    static const char *const axes[] = {"X", "Y", "Z", NULL};
    struct frf_request *frf = &reader->job->options.frf;
    const struct card_option *axis = card_option(card, "AXIS"), *flip = card_option(card, "FLIP"),
                             *origin = card_option(card, "ORIGIN"),
                             *any = axis   ? axis
                                    : flip ? flip
                                           : origin;
    frf->axis = axis ? deck_option_word(reader, axis, axes) : 2;
    frf->flip = flip ? deck_option_word(reader, flip, deck_answers) : 0;
    frf->origin = frf->flip > 0 ? reader->length : 0;
    if (origin)
        (void)deck_option_number(reader, origin, "m", ANY, &frf->origin);
    if (any && !card_option(card, "FILE"))
        deck_error(reader, any->place, "%s places the nodes of a file, expected FILE beside it", any->name);
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
        struct frf_pair *added = DECK_APPEND(reader, frf->pair, frf->npair, reader->pair_room);
        if (!added)
            return;
        *added = pair;
        frf->npair++;
    }
}

void deck_frf(struct deck_reader *reader, const struct card *card)
{
    static const char *const quantities[] = {"DISPLACEMENT", "VELOCITY", "ACCELERATION", NULL};
    struct frf_request *frf = &reader->job->options.frf;
    const struct card_option *option;
    int word;
    *frf = (struct frf_request){.given = 1, .quantity = FRF_ACCELERATION};
    if ((option = card_option(card, "FILE")))
        frf->file = measured_file(reader, card, option);
    if ((option = card_option(card, "QUANTITY")) && (word = deck_option_word(reader, option, quantities)) >= 0) {
        frf->quantity = (enum frf_quantity)word;
        frf->has_quantity = 1;
    }
    if ((option = card_option(card, "DAMPING")) && !deck_option_number(reader, option, "", POSITIVE, &frf->damping) &&
        frf->damping >= 1)
        deck_error(reader, option->value_place, "DAMPING is %s, expected a ratio below 1: a fraction of critical damping",
                   option->value);
    read_lines(reader, card);
    read_nodes_of_file(reader, card);
    read_pairs(reader, card);
}
