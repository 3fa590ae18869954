#include "cli/cli.h"

static const char *const tables[] = {"parameters", "modes", NULL};

static int show(struct command *command, rotid_identification *found)
{
    struct result result = {.head = command->head, .identify = found};
    const rotid_fit_result *fit = found->fit;
    int doubtful = !fit->converged || fit->any_at_bound || fit->any_undetermined || fit_is_inadequate(found);
    int code = doubtful ? EXIT_DOUBTFUL : EXIT_DONE;
    command_take_messages(command, NULL, found->nmessage, found->message);
    const char *steps = doubt_steps(&command->pool, command->job);
    if (steps)
        message_warn(&command->messages, "%s", steps);
    if (command_wants_table(command)) {
        const struct screen to = command_screen(command);
        screen_identify(&to, &result, !command->no_baseline);
        screen_notes(&to, &command->messages);
    }
    if (fit->status == ROTID_STOP_CANCELLED) {
        terminal_say("rotid: interrupted after %d iterations; the result is the best point so far\n", fit->iterations);
    } else if (command_cancelled(NULL)) {
        code = terminal_end(EXIT_DOUBTFUL, "rotid: interrupted; the fit is complete, the rest is not\n");
    }
    static const struct result_head none;
    struct table *table[] = {table_of_parameters(&command->pool, found),
                             table_of_compared_modes(&command->pool, &none, found, "")};
    int written = command_write_csv(command, tables, table, code);
    return written == EXIT_INTERNAL ? written : command_write_result(command, &result, code);
}

int command_identify(struct command *command)
{
    char failure[ROTID_FAILURE_LENGTH];
    const rotid_environment environment = command_environment(command);
    rotid_identification *found;
    if (!command->read->nparameter)
        return command_fail(command, message_refuse(&command->messages, ROTID_ERROR_ARGUMENT, command->deck, 1, 1,
                                                    "the deck has no *IDENTIFY, expected the parameters to identify"));
    int refused = command_refuse_csv(command, tables);
    if (refused)
        return refused;
    int status = rotid_identify(command->read, !command->no_baseline, &environment, failure, &found);
    if (status)
        return command_fail_with(command, status, failure);
    int code = show(command, found);
    rotid_identification_free(found);
    return code;
}
