#include "run/run.h"

#include <stdio.h>
#include <string.h>

struct states states_of(const struct job *job, struct state *state)
{
    *state = (struct state){.job = *job};
    return (struct states){.nstate = 1, .state = state, .nparameter = job->unknowns.nparameter, .bounds = job->unknowns.bounds};
}

int state_unknown(const struct state *state, int q)
{
    return state->unknown ? state->unknown[q] : q;
}

double *state_values(struct pool *pool, const struct state *state, const double *x)
{
    int n = state->job.unknowns.nparameter;
    double *own = POOL_ARRAY(pool, double, n);
    for (int q = 0; q < n && own; q++)
        own[q] = x[state_unknown(state, q)];
    return own;
}

int states_modes(const struct states *states, int count)
{
    int modes = 0;
    for (int s = 0; s < count; s++)
        modes += states->state[s].job.measurement.nmode;
    return modes;
}

int states_copy(struct pool *pool, const struct states *from, struct states *to)
{
    const struct states copy = *from;
    *to = copy;
    to->state = POOL_ARRAY(pool, struct state, copy.nstate);
    if (!to->state)
        return ROTID_ERROR_MEMORY;
    memcpy(to->state, copy.state, (size_t)copy.nstate * sizeof *copy.state);
    return ROTID_OK;
}

void states_refuse(const struct states *states, const char *deck, struct message_list *notes)
{
    char list[256] = "";
    for (int s = 0; s < states->nstate && strlen(list) + 3 < sizeof list; s++)
        (void)snprintf(list + strlen(list), sizeof list - strlen(list), "%s%s", s ? ", " : "", states->state[s].name);
    message_add(notes, SEVERITY_ERROR, deck, 1, 1,
                "the deck has %d states and this works on one, expected one of %s as FIT.STATE: --set FIT.STATE=%s",
                states->nstate, list, states->state[0].name);
}

int states_refuse_types(const struct states *states, const char *what, struct message_list *notes)
{
    for (int s = 0; s < states->nstate; s++) {
        const struct job *job = &states->state[s].job;
        if (job->options.type == MODE_BENDING)
            continue;
        message_add(notes, SEVERITY_ERROR, job->measured.file, job->measured.line, job->measured.column,
                    "%s is of bending, expected no *MODES, TYPE=%s, or another state by --set FIT.STATE=NAME", what,
                    mode_type_words[job->options.type]);
        return ROTID_ERROR_ARGUMENT;
    }
    return ROTID_OK;
}
