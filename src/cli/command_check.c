#include "cli/command.h"
#include "report/table.h"
#include "run/spectrum.h"

int command_check(struct command *command)
{
    struct job *job = &command->job;
    struct spectrum spectrum;
    struct mass_properties mass;
    int status = spectrum_compute(&command->pool, job->models, &job->rotor, 0, NULL, NULL, ROTID_GUYAN, 1, &spectrum);
    if (status)
        return command_fail(command, status);
    model_mass_properties(spectrum.model, &mass);
    if (command_wants_table(command)) {
        table_check(terminal_out(), job, &mass, &spectrum);
        table_notes(terminal_out(), &command->messages);
    }
    char *text = command->json ? json_check(&command->provenance, job, &mass, &spectrum, &command->messages) : NULL;
    return command_write_json(command, text, EXIT_DONE);
}
