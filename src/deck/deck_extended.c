/* The deck of a diagnosis, and where it is put. */
#include "deck/deck.h"

#include <sys/stat.h>

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

int deck_write_extended(struct pool *pool, const struct diagnosis *d, struct message_list *notes, char **text)
{
    int lines = 1, from = (int)rotor_elements(&d->given.state->job.rotor), to;
    const char **extra = POOL_ARRAY(pool, const char *, 3 + d->nalternative);
    struct deck_write_options options = {.extra = extra};
    struct states states;
    *text = NULL;
    int status = extra ? extended_states(pool, d, &states, &options.x) : ROTID_ERROR_MEMORY;
    if (status)
        return status;
    extra[0] = pool_format(pool, DECK_EXTENDED_FROM "%s, verdict %s", d->given.state->job.deck,
                           rotid_verdict_name(d->result.verdict.kind));
    to = (int)rotor_elements(&states.state->job.rotor);
    if (to > from)
        extra[lines++] = pool_format(pool, DECK_MESH_REFINED "%d elements in place of %d, as the noise asks for", to, from);
    extra[lines++] = d->result.verdict.sentence;
    for (int i = 0; i < d->nalternative; i++) {
        const struct candidate *other = &d->alternative[i];
        const char *word = i && other->set && other->set == other[-1].set ? "together with" : "cannot be told apart:";
        extra[lines++] = pool_format(pool, "%s %s%s%s", word, other->cause->id, other->target && *other->target ? " " : "",
                                     other->target ? other->target : "");
    }
    for (int i = 0; i < lines; i++)
        if (!extra[i])
            return ROTID_ERROR_MEMORY;
    options.nextra = lines;
    return deck_write(pool, &d->given, &states, &options, notes, text);
}

/* ------------------------------------------------------------------------------------------------ its place */

/* The folder of a file, and by its numbers whether two are the same one. */
struct folder {
    const char *path; /* absolute */
    struct stat about;
};

static int find_folder(struct pool *pool, const char *file, struct folder *folder)
{
    const char *whole = deck_absolute(pool, file);
    folder->path = whole ? pool_format(pool, "%.*s", (int)(strrchr(whole, '/') - whole), whole) : NULL;
    if (!folder->path)
        return pool->out_of_memory ? ROTID_ERROR_MEMORY : ROTID_ERROR_IO;
    return stat(*folder->path ? folder->path : "/", &folder->about) != 0 ? ROTID_ERROR_IO : ROTID_OK;
}

/* Paths in this folder become relative to it. */
static void shorten(struct deck_edit *e, const char *folder)
{
    size_t count = strlen(folder);
    for (int i = 0; i < e->npart; i++) {
        const char *path = deck_edit_option(&e->part[i], "FILE");
        if (path && !strncmp(path, folder, count) && path[count] == '/' && path[count + 1])
            deck_edit_set(e, i, "FILE", path + count + 1);
    }
}

int deck_place(struct pool *pool, const char *from, const char *text, const char *to, struct message_list *notes, char **placed)
{
    struct folder old, new;
    struct states as_written, as_placed;
    struct deck_edit e;
    struct deck_writer out = {.pool = pool};
    const char *card = "STATE";
    unsigned bits = 0;
    *placed = (char *)text;
    int status = find_folder(pool, to, &new);
    if (status || find_folder(pool, from, &old) || old.about.st_dev != new.about.st_dev || old.about.st_ino != new.about.st_ino)
        return status;
    *placed = NULL;
    const struct deck_file file = {to, text};
    const struct deck_origin origin = {.path = to, .nfile = 1, .file = &file};
    status = deck_edit_open(&e, pool, &origin);
    if (status)
        return status;
    shorten(&e, old.path);
    for (int i = 0; i < e.npart; i++)
        deck_put(&out, "%.*s", (int)e.part[i].length, e.part[i].text);
    status = pool->out_of_memory ? ROTID_ERROR_MEMORY : ROTID_OK;
    if (!status)
        status = deck_read_back(pool, to, text, ".", notes, &as_written);
    if (!status)
        status = deck_read_back(pool, to, out.text, *old.path ? old.path : "/", notes, &as_placed);
    for (int s = 0; !status && s < as_written.nstate && !bits; s++)
        bits = s < as_placed.nstate ? deck_compare(pool, &as_written.state[s].job, &as_placed.state[s].job, &card) : 1;
    if (!status && bits)
        status = message_refuse(notes, ROTID_ERROR_ARGUMENT, to, 1, 1,
                                "no deck is written: *%s would be read as something else there", card);
    if (!status)
        *placed = out.text;
    return status;
}
