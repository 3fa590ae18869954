#include "one_state.h"

int deck_read(struct pool *pool, const char *path, int noverride, const struct override *override, struct message_list *messages,
              struct job *job)
{
    struct states states;
    int status = deck_read_states(pool, path, NULL, noverride, override, messages, &states);
    *job = states.nstate ? states.state[0].job : (struct job){.deck = path};
    if (!status && states.nstate > 1) {
        states_refuse(&states, path, messages);
        status = ROTID_ERROR_SYNTAX;
    }
    return status;
}

int diagnose_run(struct pool *pool, const struct job *job, const struct diagnose_options *options,
                 const rotid_environment *environment, struct message_list *notes, struct diagnosis *out)
{
    struct state state;
    const struct states states = states_of(job, &state);
    return diagnose_states(pool, &states, options, environment, notes, out);
}

int suggest_run(struct pool *pool, const struct job *job, const rotid_suggest_options *options,
                const rotid_environment *environment, struct message_list *notes, struct suggestion *out)
{
    struct state state;
    const struct states states = states_of(job, &state);
    return suggest_states(pool, &states, options, environment, notes, out);
}
