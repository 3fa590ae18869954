#include "deck/deck_extended.h"

#include <string.h>

#include "deck/deck_keep.h"

/* Whether the error of the mesh of a state was found to count. */
static int mesh_was_refined(const struct diagnosis *d, const char *state)
{
    for (int i = 0; i < d->result.nnumerical_findings; i++) {
        const rotid_numerical_finding *finding = &d->result.numerical_findings[i];
        if (!strcmp(finding->id, "mesh") && (!finding->state || !state || !strcmp(finding->state, state)))
            return 1;
    }
    return 0;
}

/* The states to write and the values of their unknowns: the base model where nothing was named. The mesh is that of the deck, or
 * where its error counts the one that was judged. */
static int extended_states(struct pool *pool, const struct diagnosis *d, struct states *states, const double **x)
{
    int status = states_copy(pool, d->extended_states.nstate ? &d->extended_states : &d->judged, states);
    const rotid_fit_result *fit = d->extended.fit ? d->extended.fit : d->base.fit;
    for (int s = 0; s < states->nstate && !status; s++) {
        struct rotor *rotor = &states->state[s].job.rotor;
        const struct rotor *given = s < d->given.nstate ? &d->given.state[s].job.rotor : NULL;
        if (mesh_was_refined(d, states->state[s].name))
            rotor->segment = d->mesh ? d->mesh[s] : rotor->segment;
        else if (given && given->nsegment == rotor->nsegment)
            rotor->segment = given->segment;
    }
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
