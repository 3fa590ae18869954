#include "cli/command.h"
#include "report/table.h"

static int show(struct command *command, rotid_spectrum *spectrum)
{
    struct result result = {.head = command->head, .modes = spectrum};
    command_take_messages(command, spectrum->nmessage, spectrum->message);
    if (command->messages.errors) /* no pairing */
        return command_fail(command, ROTID_ERROR_UNPAIRED);
    if (command_wants_table(command)) {
        table_modes(terminal_out(), &result, command->verbose);
        table_notes(terminal_out(), &command->messages);
    }
    const struct csv_spectrum tables = {spectrum, command->job};
    int code = command_write_csv(command, csv_spectrum_parts, &tables, EXIT_DONE);
    return code ? code : command_write_result(command, &result, EXIT_DONE);
}

int command_modes(struct command *command)
{
    char failure[ROTID_FAILURE_LENGTH];
    rotid_spectrum *spectrum;
    const double *x = command->read->stated;
    int refused = command_refuse_csv(command, csv_spectrum_parts);
    if (refused)
        return refused;
    int status = command->compare ? rotid_spectrum_beside(command->read, x, 0, NULL, failure, &spectrum)
                                  : rotid_spectrum_compute(command->read, x, 0, NULL, failure, &spectrum);
    if (status)
        return command_fail_with(command, status, failure);
    int code = show(command, spectrum);
    rotid_spectrum_free(spectrum);
    return code;
}
