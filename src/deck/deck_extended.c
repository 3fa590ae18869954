#include "deck/deck.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "base/base.h"
#include "deck/card_table.h"
#include "file/file.h"

#define MOST_BYTES (4l << 20) /* a deck with its shapes in it takes some 100 kB */

struct keeping {
    struct pool *pool;
    const struct diagnosis *d;
    const struct job *job; /* that is written */
    const struct deck_write_options *options;
    const char *deck;  /* the user's */
    int own_data;      /* the measured data stay as the deck states them */
    const char *noise; /* *NOISE in place of its own, up to noise_end; NULL: its own stays */
    const char *noise_end;
};

/* ------------------------------------------------------------------------------------------------ lines of a deck */

static size_t line_length(const char *line)
{
    size_t length = strcspn(line, "\n");
    return length + (line[length] == '\n');
}

static int is_comment(const char *line)
{
    return line[0] == '*' && line[1] == '*';
}

static int begins_card(const char *line)
{
    return line[0] == '*' && line[1] != '*';
}

/* Whether the card of this line is the one of that name: SHAFT does not stand for SHAFTS. */
static int is_card(const char *line, const char *name)
{
    size_t i = 1 + strspn(line + 1, " \t"), n = strlen(name);
    for (size_t k = 0; k < n; k++)
        if (toupper((unsigned char)line[i + k]) != name[k])
            return 0;
    return !isalnum((unsigned char)line[i + n]) && line[i + n] != '_';
}

static int is_measured(const char *line)
{
    static const char *const names[] = {"SENSORS", "MODES", "SHAPE", "FREQUENCIES", "MEASURED", "NOISE", NULL};
    for (int i = 0; names[i]; i++)
        if (is_card(line, names[i]))
            return 1;
    return 0;
}

/* The option FILE of a card, in any case. */
static int names_file(const char *line)
{
    size_t length = strcspn(line, "\n");
    for (size_t i = 0; i + 4 < length; i++)
        if (line[i] == ',' || line[i] == ' ') {
            size_t k = i + 1 + strspn(line + i + 1, " \t");
            if (k + 4 < length && toupper((unsigned char)line[k]) == 'F' && toupper((unsigned char)line[k + 1]) == 'I' &&
                toupper((unsigned char)line[k + 2]) == 'L' && toupper((unsigned char)line[k + 3]) == 'E' &&
                strchr(" \t=", line[k + 4]))
                return 1;
        }
    return 0;
}

/* The number of characters before field `number` (from 0) of a data line, -1 where it has fewer; *length without the blanks
 * behind it. The line ends before a comment. */
static int find_field(const char *line, int number, int *length)
{
    int end = 0, begin = 0;
    while (line[end] && line[end] != '\n' && !(line[end] == '*' && line[end + 1] == '*'))
        end++;
    for (int field = 0; field < number; field++) {
        const char *comma = memchr(line + begin, ',', (size_t)(end - begin));
        if (!comma)
            return -1;
        begin = (int)(comma - line) + 1;
    }
    const char *comma = memchr(line + begin, ',', (size_t)(end - begin));
    int stop = comma ? (int)(comma - line) : end;
    while (begin < stop && isspace((unsigned char)line[begin]))
        begin++;
    while (stop > begin && isspace((unsigned char)line[stop - 1]))
        stop--;
    *length = stop - begin;
    return begin;
}

/* The line with field `number` replaced, or added behind the one before it. */
static void put_with_field(struct deck_writer *w, const char *line, int number, const char *value)
{
    int length, at = find_field(line, number, &length), all = (int)line_length(line);
    if (at >= 0) {
        deck_put(w, "%.*s%s%.*s", at, line, value, all - at - length, line + at + length);
    } else if ((at = find_field(line, number - 1, &length)) >= 0) {
        deck_put(w, "%.*s, %s%.*s", at + length, line, value, all - at - length, line + at + length);
    } else {
        deck_put(w, "%.*s", all, line);
    }
}

/* ------------------------------------------------------------------------------------------------ what changes */

static void put_start(const struct keeping *k, struct deck_writer *w, const char *line)
{
    const struct job_unknowns *unknowns = &k->job->unknowns;
    char number[DECK_NUMBER_LENGTH];
    int length, at = find_field(line, 0, &length);
    for (int p = 0; p < unknowns->nparameter && k->options->x; p++) {
        const char *name = unknowns->bounds[p].name;
        if ((int)strlen(name) == length && !strncmp(name, line + at, (size_t)length)) {
            put_with_field(w, line, 3, deck_number_text(k->options->x[p], number));
            return;
        }
    }
    deck_put(w, "%.*s", (int)line_length(line), line);
}

/* A data line of *SHAFT or *BEAM, segment number `segment`. */
static void put_segment(const struct keeping *k, struct deck_writer *w, const char *line, int segment)
{
    const struct rotor *given = &k->d->given.state->job.rotor, *rotor = &k->job->rotor;
    char number[16];
    if (segment < rotor->nsegment && segment < given->nsegment &&
        rotor->segment[segment].elements != given->segment[segment].elements) {
        (void)snprintf(number, sizeof number, "%d", rotor->segment[segment].elements);
        put_with_field(w, line, 3, number);
    } else {
        deck_put(w, "%.*s", (int)line_length(line), line);
    }
}

/* Cards that a writer makes of the job alone. */
static void put_cards(const struct keeping *k, struct deck_writer *w, void write(struct deck_writer *))
{
    struct deck_writer own;
    int status = deck_writer_open(&own, k->pool, k->job, k->options->x);
    if (!status) {
        write(&own);
        status = own.status;
    }
    w->status = w->status ? w->status : status;
    if (!status && own.length)
        deck_put(w, "%s", own.text);
}

static void put_fit(struct deck_writer *w)
{
    deck_write_fit(w, 1);
}

/* Lines of the heading that the options add. */
static void put_extra(const struct keeping *k, struct deck_writer *w)
{
    struct deck_writer own = {.pool = k->pool};
    struct job none = {.nheading = 0};
    own.job = &none;
    deck_write_heading(&own, k->options);
    w->status = w->status ? w->status : own.status;
    if (own.text)
        deck_put(w, "%s", own.text + line_length(own.text));
}

/* What the states have beyond the deck: faults of the data, causes, their unknowns. */
static void put_added(struct keeping *k, struct deck_writer *w)
{
    const struct job *given = &k->d->given.state->job, *whole = k->job;
    struct job added = *whole;
    int effects = given->rotor.neffect, corrections = k->own_data ? given->measurement.ncorrection : 0, first = 1;
    if (effects > whole->rotor.neffect || corrections > whole->measurement.ncorrection) {
        w->status = w->status ? w->status : ROTID_ERROR_ARGUMENT;
        return;
    }
    added.measurement.correction += corrections;
    added.measurement.ncorrection -= corrections;
    k->job = &added;
    put_cards(k, w, deck_write_corrections);
    struct deck_writer own;
    int status = deck_writer_open(&own, k->pool, whole, k->options->x);
    if (!status) {
        own.rotor.effect += effects;
        own.rotor.neffect -= effects;
        added.unknowns.nsuspect = 0;
        own.job = &added;
        deck_write_causes(&own);
        if (own.length)
            deck_put(w, "%s", own.text);
        own = (struct deck_writer){.pool = k->pool, .job = whole, .rotor = whole->rotor, .x = k->options->x};
        for (int p = given->unknowns.nparameter; p < whole->unknowns.nparameter; p++) {
            if (first)
                deck_put(&own, "*IDENTIFY\n");
            first = 0;
            deck_write_unknown(&own, p, whole->unknowns.bounds[p].name);
        }
        if (own.length)
            deck_put(w, "%s", own.text);
        status = own.status;
    }
    k->job = whole;
    w->status = w->status ? w->status : status;
}

/* A part of the deck: a card with its lines, comments among them. */
static const char *next_card(const char *line)
{
    do
        line += line_length(line);
    while (*line && !begins_card(line));
    return line;
}

/* The comments of a card whose lines are replaced. */
static void put_comments(struct deck_writer *w, const char *line, const char *end)
{
    for (; line < end; line += line_length(line))
        if (is_comment(line))
            deck_put(w, "%.*s", (int)line_length(line), line);
}

/* A suspect that was named: it stands among the causes of the model, which come last. */
static int is_named_suspect(const struct keeping *k, const char *card, const char *end)
{
    const struct job_unknowns *given = &k->d->given.state->job.unknowns;
    for (int i = 0; i < given->nsuspect; i++) {
        const char *name = given->suspect[i].effect.name, *at = NULL;
        int open = 0;
        for (int n = 0; n < k->job->unknowns.nsuspect; n++)
            open |= !strcmp(k->job->unknowns.suspect[n].effect.name, name);
        if (open)
            continue;
        for (const char *c = card; c < end && !(c > card && c[-1] == '\n' && !isspace((unsigned char)*c)); c++) {
            size_t skip = 4 + strspn(c + (c + 4 < end ? 4 : 0), " \t=");
            if (!strncmp(c, "NAME", 4) && c + skip < end && !strncmp(c + skip, name, strlen(name)))
                at = c + skip + strlen(name);
        }
        if (at && strchr(", \t\r\n", *at))
            return 1;
    }
    return 0;
}

static void put_card(struct keeping *k, struct deck_writer *w, const char *card, const char *end, int *segment, int *data,
                     int *fit)
{
    int identify = is_card(card, "IDENTIFY"), shaft = is_card(card, "SHAFT") || is_card(card, "BEAM"),
        heading = is_card(card, "HEADING"), continues = 1;
    const char *last = card; /* line of a heading */
    if (is_card(card, "FIT")) {
        if (!(*fit)++)
            put_cards(k, w, put_fit);
        put_comments(w, card, end);
        return;
    }
    if (is_card(card, "NOISE") && k->noise) {
        put_comments(w, card, end);
        return;
    }
    if (is_card(card, "CAUSE") && is_named_suspect(k, card, end)) {
        put_comments(w, card, end);
        return;
    }
    if (is_measured(card) && !k->own_data) {
        if (!(*data)++)
            put_cards(k, w, deck_write_measured);
        put_comments(w, card, end);
        return;
    }
    for (const char *line = card; heading && line < end; line += line_length(line))
        last = is_comment(line) ? last : line;
    for (const char *line = card; line < end; line += line_length(line)) {
        size_t length = line_length(line);
        int blank = !line[strspn(line, " \t\r\n")] || strspn(line, " \t\r") == length - 1,
            is_data = !continues && !is_comment(line) && !blank;
        if (identify && is_data)
            put_start(k, w, line);
        else if (shaft && is_data)
            put_segment(k, w, line, (*segment)++);
        else
            deck_put(w, "%.*s%s", (int)length, line, line[length - 1] == '\n' ? "" : "\n");
        if (heading && line == last)
            put_extra(k, w);
        if (continues) { /* options go on in the next line */
            size_t end_of = length;
            while (end_of && isspace((unsigned char)line[end_of - 1]))
                end_of--;
            continues = end_of && line[end_of - 1] == ',';
        }
    }
}

static int compose(struct keeping *k, char **text)
{
    struct deck_writer w = {.pool = k->pool};
    int segment = 0, data = 0, fit = 0;
    const char *line = k->deck;
    *text = NULL;
    while (*line && !begins_card(line)) { /* comments in front */
        deck_put(&w, "%.*s", (int)line_length(line), line);
        line += line_length(line);
    }
    if (!is_card(line, "HEADING")) {
        deck_put(&w, "*HEADING\n");
        put_extra(k, &w);
    }
    for (const char *end; *line; line = end) {
        end = next_card(line);
        if (is_card(line, "INCLUDE") || is_card(line, "STATE") || is_card(line, "UNITS") ||
            (names_file(line) && !(is_measured(line) && !k->own_data)))
            return ROTID_ERROR_ARGUMENT;
        put_card(k, &w, line, end, &segment, &data, &fit);
    }
    if (k->noise)
        deck_put(&w, "%.*s", (int)(k->noise_end - k->noise), k->noise);
    put_added(k, &w);
    if (!fit)
        put_cards(k, &w, put_fit);
    *text = w.text;
    return w.status;
}

/* ------------------------------------------------------------------------------------------------ what came of it */

/* Behind the heading, which deck_write puts first. */
static const char *behind_heading(const char *text)
{
    return is_card(text, "HEADING") ? next_card(text) : text;
}

/* Whether the text reads as the states of the deck `wanted`. */
static int reads_as(struct pool *pool, const char *text, const char *wanted, int *same)
{
    struct message_list messages;
    struct states states;
    char *again;
    message_open(&messages, pool);
    const struct deck_memory memory = {.name = "extended", .length = strlen(text), .text = text};
    int status = deck_read_states(pool, "extended", &memory, 0, NULL, &messages, &states);
    *same = 0;
    if (status)
        return status == ROTID_ERROR_MEMORY ? status : ROTID_OK;
    double *x = POOL_ARRAY(pool, double, states.nparameter);
    for (int p = 0; p < states.nparameter && x; p++)
        x[p] = states.bounds[p].start;
    const struct deck_write_options options = {.x = x};
    status = x ? deck_write_states(pool, &states, &options, &again) : ROTID_ERROR_MEMORY;
    if (!status)
        *same = !strcmp(behind_heading(again), behind_heading(wanted));
    return status == ROTID_ERROR_MEMORY ? status : ROTID_OK;
}

/* Nothing in it but characters that are shown, line feeds and tabs? What else a deck holds is not handed on. */
static int is_plain(const char *text)
{
    while (*text) {
        size_t bytes = text_visible(text);
        if (!bytes && *text != '\n' && *text != '\t')
            return 0;
        text += bytes ? bytes : 1;
    }
    return 1;
}

/* The deck as text; NULL where it is no file, is no plain text, or is not that of the diagnosis. */
static char *read_deck(struct pool *pool, const char *path)
{
    struct stat about;
    FILE *stream = path ? file_open_regular(path, &about) : NULL;
    char *text = NULL;
    if (!stream)
        return NULL;
    size_t size = about.st_size > 0 && about.st_size <= MOST_BYTES ? (size_t)about.st_size : 0;
    if (size)
        text = pool_get(pool, size + 1, 1);
    if (text && (fread(text, 1, size, stream) != size || strlen(text) != size || !is_plain(text)))
        text = NULL;
    (void)fclose(stream);
    return text;
}

/* *text, in: the deck that deck_write_states makes of the states with the options; out: the deck `from` of the diagnosis with
 * what has to change in it, where that reads as the same states: its comments, names of materials, tables and mesh stay. Changed
 * are the heading (lines of the options behind its own), starts of *IDENTIFY, *FIT, elements where the mesh of the states is
 * another one; measured data stand in it as in *text where they are those of a file, or were corrected; causes, faults of the
 * data and their unknowns come last. *text stays where the deck has several states, names files for anything else, cannot be read
 * again, or where what came of it is read as something else. ROTID_OK, ROTID_ERROR_MEMORY or, where *text itself does not read as
 * the states, ROTID_ERROR_ARGUMENT with *text NULL. */
static int deck_keep(struct pool *pool, const struct diagnosis *d, const struct states *states,
                     const struct deck_write_options *options, const char *from, char **text)
{
    int same = 0, status = reads_as(pool, *text, *text, &same);
    if (status || !same) {
        *text = NULL;
        return status ? status : ROTID_ERROR_ARGUMENT;
    }
    struct keeping k = {.pool = pool, .d = d, .job = &states->state->job, .options = options};
    if (states->nstate != 1 || d->given.nstate != 1 || states->state->name || !(k.deck = read_deck(pool, from)))
        return pool->out_of_memory ? ROTID_ERROR_MEMORY : ROTID_OK;
    const char *noise = *text;
    while (*noise && !(begins_card(noise) && is_card(noise, "NOISE")))
        noise += line_length(noise);
    for (int attempt = 0; attempt < 3; attempt++) { /* as little as possible */
        char *kept;
        k.own_data = attempt < 2;
        k.noise = attempt == 1 && *noise ? noise : NULL;
        k.noise_end = k.noise ? next_card(noise) : NULL;
        status = compose(&k, &kept);
        same = 0;
        if (!status)
            status = reads_as(pool, kept, *text, &same);
        if (status == ROTID_ERROR_MEMORY)
            return status;
        if (same) {
            *text = kept;
            return ROTID_OK;
        }
    }
    return ROTID_OK;
}

/* The states to write and the values of their unknowns: the base model where nothing was named, with the mesh of the deck where
 * that suffices, and of a solid, whose mesh follows from its outline. */
static int extended_states(struct pool *pool, const struct diagnosis *d, struct states *states, const double **x)
{
    int status = states_copy(pool, d->extended_states.nstate ? &d->extended_states : &d->judged, states);
    const rotid_fit_result *fit = d->extended.fit ? d->extended.fit : d->base.fit;
    for (int s = 0; s < states->nstate && s < d->given.nstate && !status; s++)
        if ((d->mesh_suffices || states->state[s].job.options.solid) &&
            d->given.state[s].job.rotor.nsegment == states->state[s].job.rotor.nsegment)
            states->state[s].job.rotor.segment = d->given.state[s].job.rotor.segment;
    *x = fit && fit->n == states->nparameter ? fit->x : NULL;
    return status;
}

int deck_write_extended(struct pool *pool, const struct diagnosis *d, const char *from, char **text)
{
    int lines = 2 + d->nalternative;
    const char **extra = POOL_ARRAY(pool, const char *, lines);
    *text = NULL;
    if (!extra)
        return ROTID_ERROR_MEMORY;
    extra[0] = pool_format(pool, "rotid %s from %s, verdict %s", ROTID_VERSION, from, rotid_verdict_name(d->result.verdict.kind));
    extra[1] = d->result.verdict.sentence;
    for (int i = 0; i < d->nalternative; i++) {
        const struct candidate *other = &d->alternative[i];
        const char *word = i && other->set && other->set == other[-1].set ? "together with" : "cannot be told apart:";
        extra[2 + i] = pool_format(pool, "%s %s%s%s", word, other->cause->id, other->target && *other->target ? " " : "",
                                   other->target ? other->target : "");
    }
    for (int i = 0; i < lines; i++)
        if (!extra[i])
            return ROTID_ERROR_MEMORY;
    struct deck_write_options options = {.nextra = lines, .extra = extra};
    struct states states;
    int status = extended_states(pool, d, &states, &options.x);
    if (!status)
        status = deck_write_states(pool, &states, &options, text);
    return status ? status : deck_keep(pool, d, &states, &options, from, text);
}
