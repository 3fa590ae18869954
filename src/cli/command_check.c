#include "cli/command.h"
#include "report/table.h"
#include "run/client.h"

int command_check(struct command *command)
{
    struct job *job = &command->job;
    struct spectrum spectrum;
    struct mass_properties mass;
    struct beam beam;
    int failed, status = beam_build(&command->pool, &job->rotor, 0, NULL, 1, &beam, &failed);
    if (!status)
        status = spectrum_compute(&command->pool, &job->rotor, 0, NULL, NULL, ROTID_GUYAN, 1, &spectrum);
    if (status)
        return command_fail(command, status);
    beam_mass_properties(&beam, &mass);
    if (command_wants_table(command)) {
        table_check(terminal_out(), job, &mass, &spectrum);
        table_notes(terminal_out(), &command->messages);
    }
    char *text = command->json ? json_check(&command->provenance, job, &mass, &spectrum, &command->messages) : NULL;
    return command_write_json(command, text, EXIT_DONE);
}
