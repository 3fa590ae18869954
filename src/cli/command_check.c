#include "api/api.h"
#include "cli/cli.h"

static int check(struct command *command, const rotid_deck *deck, struct result_state *state)
{
    char failure[ROTID_FAILURE_LENGTH];
    int status = rotid_deck_check(deck, NULL, failure, &state->check);
    state->job = deck_job_of(deck);
    return status ? command_fail_with(command, status, failure) : EXIT_DONE;
}

int command_check(struct command *command)
{
    struct result result = {.head = command->head, .job = command->job};
    int count, code = command_each_state(command, &result, check, &count);
    if (!code)
        command_show(command, &result, screen_check);
    if (!code)
        code = command_write_result(command, &result, EXIT_DONE);
    for (int s = 0; s < count; s++)
        rotid_check_free(result.states[s].check);
    return code;
}
