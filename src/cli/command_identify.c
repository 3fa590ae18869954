#include "cli/command.h"
#include "report/table.h"

int command_identify(struct command *command)
{
    struct job *job = &command->job;
    double last = 0;
    const rotid_environment environment = command_environment(command, &last);
    struct identification result;
    if (!job->nparameter) {
        message_add(&command->messages, SEVERITY_ERROR, job->deck, 1, 1,
                    "the deck names nothing to identify, expected a card *IDENTIFY");
        return command_fail(command, ROTID_ERROR_ARGUMENT);
    }
    int status = identify_run(&command->pool, job, !command->no_baseline, &environment, &command->messages, &result);
    if (environment.progress)
        terminal_progress_end();
    if (status)
        return command_fail(command, status);
    identify_warn_of_mesh(job, &result, &command->messages);
    const rotid_fit_result *fit = result.fit;
    int code = fit->converged && !fit->any_at_bound && !fit->any_undetermined ? EXIT_DONE : EXIT_DOUBTFUL;
    if (command_wants_table(command)) {
        table_identify(terminal_out(), job, &result, !command->no_baseline, command->verbose);
        table_notes(terminal_out(), &command->messages);
    }
    if (fit->status == ROTID_STOP_CANCELLED) {
        terminal_say("rotid: interrupted after %d iterations; the result is the best point so far\n", fit->iterations);
    } else if (command_cancelled(NULL)) {
        terminal_say("rotid: interrupted; the fit was complete, what comes after it is not\n");
        code = EXIT_DOUBTFUL;
    }
    char *text = command->json ? json_identify(&command->provenance, job, &result, &command->messages) : NULL;
    code = command_write_json(command, text, code);
    rotid_fit_free(result.fit);
    return code;
}
