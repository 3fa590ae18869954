#include "deck/deck_extended.h"

#include "deck/deck_keep.h"

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
