#include "cli/command.h"
#include "report/table.h"

#define MODES_SHOWN 6

int command_modes(struct command *command)
{
    struct job *job = &command->job;
    struct spectrum spectrum;
    struct comparison compared;
    int count = comparison_candidates(job), reduction = job->fit.reduction == ROTID_IRS ? ROTID_IRS : ROTID_GUYAN;
    count = count > MODES_SHOWN ? count : MODES_SHOWN;
    int status = spectrum_compute(&command->pool, job->models, &job->rotor, 0, NULL, NULL, reduction, count, &spectrum);
    if (!status)
        status = comparison_make(&command->pool, job, &spectrum, &command->messages, &compared);
    if (status)
        return command_fail(command, status);
    if (command_wants_table(command)) {
        table_modes(terminal_out(), job, &spectrum, &compared, command->verbose);
        table_notes(terminal_out(), &command->messages);
    }
    char *text = command->json ? json_modes(&command->provenance, job, &spectrum, &compared, &command->messages) : NULL;
    return command_write_json(command, text, EXIT_DONE);
}
