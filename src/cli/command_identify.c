#include "cli/command.h"
#include "io/table.h"

int command_identify(struct command *command)
{
    struct job *job = &command->job;
    const rotid_environment environment = {.cancelled = command_cancelled};
    struct identification result;
    int status = identify_run(&command->pool, job, command->baseline, &environment, &command->messages, &result);
    if (status)
        return command_fail(command, status);
    const rotid_fit_result *fit = result.fit;
    int code = fit->converged && !fit->any_at_bound && !fit->any_undetermined ? EXIT_DONE : EXIT_DOUBTFUL;
    if (command_wants_table(command)) {
        table_identify(stdout, job, &result, command->verbose);
        table_notes(stdout, &command->messages);
    }
    if (fit->status == ROTID_STOP_CANCELLED)
        (void)fprintf(stderr, "rotid: interrupted after %d iterations; the result is the best point so far\n", fit->iterations);
    char *text = command->json ? json_identify(&command->provenance, job, &result, &command->messages) : NULL;
    code = command_write_json(command, text, code);
    rotid_fit_free(result.fit);
    return code;
}
