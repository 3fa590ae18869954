/* The deck of a command, and the fit of its model. */
#include <string.h>

#include "api/deck_handle.h"
#include "cli/arguments.h"

/* The place of a message as the user knows it: the library calls an override by its text alone. */
static const char *place_of(const struct command *command, const char *file)
{
    for (int i = 0; i < command->noverride && file; i++)
        if (!strcmp(command->override[i].given, file))
            return command->override[i].text;
    return file;
}

void command_take_messages(struct command *command, const char *state, int count, const rotid_message *message)
{
    for (int i = 0; i < count; i++)
        message_add(&command->messages, (enum severity)message[i].severity, place_of(command, message[i].file), message[i].line,
                    message[i].column, state ? "%s (state %s)" : "%s", message[i].text, state);
}

int command_state_count(const struct command *command)
{
    return command->read->nstate ? command->read->nstate : 1;
}

const rotid_deck *command_state(const struct command *command, int i, const char **name)
{
    *name = command->read->nstate ? command->read->state_name[i] : NULL;
    return command->read->nstate ? command->read->state[i] : command->read;
}

int command_begin_states(struct command *command, struct result *result)
{
    result->nstates = command->read->nstate;
    result->states = POOL_ARRAY(&command->pool, struct result_state, result->nstates);
    for (int i = 0; i < result->nstates && result->states; i++)
        result->states[i].name = command->read->state_name[i];
    return result->states ? EXIT_DONE : command_fail(command, ROTID_ERROR_MEMORY);
}

int command_read_deck(struct command *command)
{
    char failure[ROTID_FAILURE_LENGTH];
    const char **override = POOL_ARRAY(&command->pool, const char *, command->noverride);
    if (!override)
        return command_fail(command, ROTID_ERROR_MEMORY);
    for (int i = 0; i < command->noverride; i++)
        override[i] = command->override[i].given;
    int status = rotid_deck_read(command->deck, command->noverride, override, NULL, failure, &command->read);
    if (command->read) {
        command_take_messages(command, NULL, command->read->nmessage, command->read->message);
        command->messages.errors = command->read->nerror;
    }
    if (!command->read || (status && !command->read->nerror)) /* no message says why */
        return command_fail_with(command, status, failure);
    if (status)
        return command_fail(command, status);
    command->job = deck_job_of(command->read);
    command->head.deck = command->read->path;
    command->head.nheading = command->read->nheading;
    command->head.heading = command->read->heading;
    command->head.nreferences = command->read->nreferences;
    command->head.references = command->read->references;
    int refused = arguments_refuse_read(command, command->job->nfile, command->job->file);
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

int command_judge_fit(struct command *command, const struct identification *identified, const char *done)
{
    const rotid_fit_result *fit = identified ? identified->fit : NULL;
    if (!fit)
        return EXIT_DONE;
    int doubtful = fit->n && (!fit->converged || fit->any_at_bound || fit->any_undetermined);
    if (doubtful)
        message_add(&command->messages, SEVERITY_WARNING, NULL, 0, 0,
                    "the identification did not end well (not converged, at a bound or undetermined): see rotid identify");
    identify_warn_of_reduction(command->job, identified, done, &command->messages);
    return doubtful ? EXIT_DOUBTFUL : EXIT_DONE;
}
