#include "deck/deck.h"

#include <string.h>

#include "diagnose/causes/causes.h"
#include "diagnose/diagnose.h"
#include "rotid.h"

/* A line of text that a deck takes for text. */
static void put_text(struct deck_writer *w, const char *text)
{
    char line[DECK_LINE_LENGTH + 1];
    size_t length = 0, taken;
    text += strspn(text, "* \t\r\n");
    for (; *text; text += taken) {
        size_t bytes = text_visible(text);
        taken = bytes ? bytes : text_utf8(text) ? text_utf8(text) : 1;
        const char *shown = (*text == '*' && text[1] == '*') || (unsigned char)*text < ' ' ? " "
                            : bytes                                                        ? text
                                                                                           : TEXT_REPLACEMENT;
        size_t count = shown == text ? bytes : strlen(shown);
        if (length + count > DECK_LINE_LENGTH)
            break;
        memcpy(line + length, shown, count);
        length += count;
    }
    line[length] = 0;
    if (length)
        deck_put(w, "%s\n", line);
}

void deck_write_heading(struct deck_writer *w, const struct deck_write_options *options)
{
    const struct job *job = w->job;
    int extra = options ? options->nextra : 0;
    if (job->nheading + job->nreference + extra == 0)
        return;
    deck_put(w, "*HEADING\n");
    for (int i = 0; i < job->nheading; i++)
        put_text(w, job->heading[i]);
    for (int i = 0; i < extra; i++)
        put_text(w, options->extra[i]);
    for (int i = 0; i < job->nreference; i++) {
        size_t begin = w->length;
        deck_put(w, "paper %s", job->reference[i].quantity);
        for (int j = 0; j < job->reference[i].nvalues; j++)
            deck_put_number(w, j ? ", " : " = ", job->reference[i].values[j]);
        if (w->length - begin > DECK_LINE_LENGTH) /* numbers may have become longer: only printed beside results */
            w->length = begin;
        else
            deck_put(w, "\n");
    }
}

static void *copy(struct deck_writer *w, const void *source, int count, size_t size)
{
    void *target = pool_get(w->pool, (size_t)count, size);
    if (target && count)
        memcpy(target, source, (size_t)count * size);
    w->status = target ? w->status : ROTID_ERROR_MEMORY;
    return target;
}

/* A copy of what a parameter can be of, at x. */
static void set_parameters(struct deck_writer *w)
{
    struct rotor *rotor = &w->rotor;
    rotor->tierod = copy(w, rotor->tierod, rotor->ntierod, sizeof *rotor->tierod);
    rotor->effect = copy(w, rotor->effect, rotor->neffect, sizeof *rotor->effect);
    if (!w->status)
        parameters_set(rotor, w->job->unknowns.nparameter, w->job->unknowns.parameter, w->x);
}

/* A cause is said to act on a spring or a disk by its name: those without one get one. */
static void name_targets(struct deck_writer *w, int count, const struct effect *effect)
{
    for (int i = 0; i < count; i++) {
        const struct cause_kind *kind = catalogue_of(&effect[i]);
        const char **name = !kind || effect[i].target < 0   ? NULL
                            : kind->target == TARGET_SPRING ? &w->rotor.spring[effect[i].target].name
                            : kind->target == TARGET_DISK   ? &w->rotor.disk[effect[i].target].name
                                                            : NULL;
        if (!name || *name)
            continue;
        *name = scan_free_name(w->pool, &w->rotor, kind->target == TARGET_SPRING ? "spring" : "disk");
        w->status = *name ? w->status : ROTID_ERROR_MEMORY;
    }
}

int deck_writer_open(struct deck_writer *w, struct pool *pool, const struct job *job, const double *x)
{
    *w = (struct deck_writer){.pool = pool, .job = job, .rotor = job->rotor, .x = x};
    w->rotor.disk = copy(w, w->rotor.disk, w->rotor.ndisk, sizeof *w->rotor.disk);
    w->rotor.spring = copy(w, w->rotor.spring, w->rotor.nspring, sizeof *w->rotor.spring);
    w->rotor.group = copy(w, w->rotor.group, w->rotor.ngroup, sizeof *w->rotor.group);
    if (w->x && !w->status)
        set_parameters(w);
    if (!w->status)
        name_targets(w, w->rotor.neffect, w->rotor.effect);
    for (int i = 0; i < job->unknowns.nsuspect && !w->status; i++)
        name_targets(w, 1, &job->unknowns.suspect[i].effect);
    return w->status;
}

/* Lines and cards within the limits of a reader. */
static int is_readable(const char *text, size_t length)
{
    int cards = 0;
    const char *line = text;
    while (*line) {
        size_t count = strcspn(line, "\n");
        cards += *line == '*';
        if (count > DECK_LINE_LENGTH)
            return 0;
        line += count + (line[count] == '\n');
    }
    return cards <= DECK_MOST_CARDS && (long)length <= DECK_MOST_BYTES;
}

int deck_writer_end(struct deck_writer *w, char **text)
{
    *text = NULL;
    if (w->status)
        return w->status;
    if (!is_readable(w->text, w->length))
        return ROTID_ERROR_ARGUMENT;
    *text = w->text;
    return ROTID_OK;
}

int deck_write(struct pool *pool, const struct job *job, const struct deck_write_options *options, char **text)
{
    struct deck_writer w;
    *text = NULL;
    if (deck_writer_open(&w, pool, job, options ? options->x : NULL))
        return w.status;
    deck_write_heading(&w, options);
    deck_write_model(&w);
    deck_write_measured(&w);
    deck_write_corrections(&w);
    deck_write_causes(&w);
    if (job->unknowns.nparameter)
        deck_put(&w, "*IDENTIFY\n");
    for (int p = 0; p < job->unknowns.nparameter; p++)
        deck_write_unknown(&w, p, job->unknowns.bounds[p].name);
    deck_write_fit(&w, 1);
    deck_write_frf(&w);
    return deck_writer_end(&w, text);
}
