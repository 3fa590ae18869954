#include "api/api.h"
#include "cli/cli.h"

static void free_all(const struct result *result)
{
    for (int s = 0; s < result->nstates; s++)
        rotid_check_free(result->states[s].check);
    if (!result->nstates)
        rotid_check_free(result->check);
}

/* Of each state, or of the deck that is one. */
static int look(struct command *command, struct result *result)
{
    for (int s = 0; s < command_state_count(command); s++) {
        char failure[ROTID_FAILURE_LENGTH];
        const char *name;
        const rotid_deck *deck = command_state(command, s, &name);
        rotid_check **check = name ? &result->states[s].check : &result->check;
        int status = rotid_deck_check(deck, NULL, failure, check);
        if (status)
            return command_fail_with(command, status, failure);
        if (name)
            result->states[s].job = deck_job_of(deck);
        if (!s)
            result->check = *check;
    }
    return EXIT_DONE;
}

int command_check(struct command *command)
{
    struct result result = {.head = command->head, .job = command->job};
    int code = command_begin_states(command, &result);
    if (!code)
        code = look(command, &result);
    if (!code)
        command_show(command, &result, screen_check);
    if (!code)
        code = command_write_result(command, &result, EXIT_DONE);
    free_all(&result);
    return code;
}
