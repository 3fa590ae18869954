#include "cli/command.h"
#include "report/table.h"

static int show(struct command *command, rotid_check *check)
{
    struct result result = {.head = command->head, .check = check};
    if (command_wants_table(command)) {
        table_check(terminal_out(), &result, command->job);
        table_notes(terminal_out(), &command->messages);
    }
    return command_write_result(command, &result, EXIT_DONE);
}

int command_check(struct command *command)
{
    char failure[ROTID_FAILURE_LENGTH];
    rotid_check *check;
    int status = rotid_deck_check(command->read, NULL, failure, &check);
    if (status)
        return command_fail_with(command, status, failure);
    int code = show(command, check);
    rotid_check_free(check);
    return code;
}
