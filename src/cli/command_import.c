/* A rotor that another program has saved, as a deck. */
#include <stdio.h>
#include <string.h>

#include "cli/command.h"
#include "deck/deck.h"
#include "deck/deck_write.h"
#include "export/ross_saved.h"

/* The deck has to be one: what a card refuses is said of the file. */
static int check_deck(struct command *command, const char *text)
{
    const struct deck_memory memory = {command->deck, strlen(text), text, NULL};
    struct message_list found;
    struct states states;
    message_open(&found, &command->pool);
    int status = deck_read_states(&command->pool, command->deck, &memory, 0, NULL, &found, &states);
    for (size_t i = 0; i < found.count; i++)
        if (found.item[i].severity == SEVERITY_ERROR)
            message_add(&command->messages, SEVERITY_ERROR, NULL, 0, 0, "as a deck: %s", found.item[i].text);
    return status;
}

static const char *heading_of(struct command *command, const char *version)
{
    const char *slash = strrchr(command->deck, '/');
    return pool_format(&command->pool, "Rotor of ROSS %s, bending in its plane x, from %s", version,
                       slash ? slash + 1 : command->deck);
}

int command_import(struct command *command)
{
    struct ross_saved saved;
    const char *heading = NULL;
    struct job job = {.deck = command->deck};
    char *text;
    rotid_fit_defaults(sizeof job.options.fit, &job.options.fit);
    int status = ross_saved_read(&command->pool, command->deck, &command->messages, &saved);
    if (!status)
        status = ross_saved_rotor(&command->pool, command->deck, &saved, &command->messages, &job.rotor);
    if (!status && !(heading = heading_of(command, saved.version)))
        status = ROTID_ERROR_MEMORY;
    job.heading = &heading;
    job.nheading = 1;
    if (!status)
        status = deck_write(&command->pool, &job, NULL, &text);
    if (!status)
        status = check_deck(command, text);
    if (status)
        return command_fail(command, status);
    command_print_messages(command);
    int code = command_write_file(command, command->output, text, EXIT_DONE);
    if (!code && command_wants_table(command))
        (void)fprintf(terminal_out(), "%s: %d sections in %d groups, %d disks, %d springs, %.6g m, %.6g kg\n", command->output,
                      job.rotor.nsegment, job.rotor.ngroup, job.rotor.ndisk, job.rotor.nspring, rotor_length(&job.rotor),
                      rotor_mass(&job.rotor));
    return code;
}
