/* The deck of a command. */
#include "cli/arguments.h"
#include "deck/deck.h"

int command_read_deck(struct command *command)
{
    int status =
        deck_read(&command->pool, command->deck, command->noverride, command->override, &command->messages, &command->job);
    if (status)
        return command_fail(command, status);
    int refused = arguments_refuse_read(command, command->job.nfile, command->job.file);
    if (refused >= 0)
        return refused;
    command_print_messages(command);
    for (size_t i = 0; i < command->messages.count; i++)
        if (command->messages.item[i].severity == SEVERITY_WARNING)
            return EXIT_DONE; /* kept: they belong to the result as well */
    message_open(&command->messages, &command->pool);
    command->printed = 0;
    return EXIT_DONE;
}
