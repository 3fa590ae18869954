#include <unistd.h>

#include "base/clock.h"
#include "cli/command.h"
#include "report/table.h"

/* A line on the terminal that is written over, five times a second. */
static void show_progress(void *context, const char *stage, int step)
{
    double *last = context, seconds = clock_seconds();
    if (*last == 0)
        *last = seconds; /* a run shorter than that shows nothing */
    if (seconds - *last < 0.2)
        return;
    *last = seconds;
    (void)fprintf(stderr, "\rrotid: %s %d \033[K", stage, step);
}

int command_identify(struct command *command)
{
    struct job *job = &command->job;
    double last = 0;
    int terminal = isatty(STDERR_FILENO) && !command->quiet;
    const rotid_environment environment = {
        .cancelled = command_cancelled, .progress = terminal ? show_progress : NULL, .context = &last};
    struct identification result;
    int status = identify_run(&command->pool, job, command->baseline, &environment, &command->messages, &result);
    if (terminal)
        (void)fputs("\r\033[K", stderr);
    if (status)
        return command_fail(command, status);
    const rotid_fit_result *fit = result.fit;
    int code = fit->converged && !fit->any_at_bound && !fit->any_undetermined ? EXIT_DONE : EXIT_DOUBTFUL;
    if (command_wants_table(command)) {
        table_identify(stdout, job, &result, command->verbose);
        table_notes(stdout, &command->messages);
    }
    if (fit->status == ROTID_STOP_CANCELLED) {
        (void)fprintf(stderr, "rotid: interrupted after %d iterations; the result is the best point so far\n", fit->iterations);
    } else if (command_cancelled(NULL)) {
        (void)fprintf(stderr, "rotid: interrupted; the fit was complete, what comes after it is not\n");
        code = EXIT_DOUBTFUL;
    }
    char *text = command->json ? json_identify(&command->provenance, job, &result, &command->messages) : NULL;
    code = command_write_json(command, text, code);
    rotid_fit_free(result.fit);
    return code;
}
