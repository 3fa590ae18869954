/* The deck of a command, and the fit of its model. */
#include "api/api.h"
#include "cli/cli.h"

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

int command_each_state(struct command *command, struct result *result, command_of_state *work, int *count)
{
    const rotid_deck *read = command->read;
    int code = EXIT_DONE, several = result->nstates = read->nstate;
    *count = POOL_LIST(&command->pool, result->states, several ? several : 1);
    for (int s = 0; s < *count && !code; s++) {
        result->states[s].name = several ? read->state_name[s] : NULL;
        code = work(command, several ? read->state[s] : read, &result->states[s]);
    }
    if (!*count)
        return command_fail(command, ROTID_ERROR_MEMORY);
    result->check = result->states->check;
    result->modes = result->states->modes;
    result->sensitivity = result->states->sensitivity;
    return code;
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
    command->head.length_unit = command->job->units.length;
    command->head.frequency_unit = command->job->units.frequency;
    human_units_of(&command->head);
    const struct states *states = deck_states_of(command->read);
    const struct job *last = &states->state[states->nstate - 1].job; /* the files of a state go on where the one before ends */
    int refused = arguments_refuse_read(command, last->nfile, last->file);
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

/* Which states are to be worked on: the index of that of --state, -1 for all, -2 after an error. */
static int chosen_state(struct command *command)
{
    if (!command->state)
        return -1;
    for (int s = 0; s < command->read->nstate; s++)
        if (same_text(command->read->state_name[s], command->state))
            return s;
    const char *list = "";
    for (int s = 0; s < command->read->nstate && list; s++)
        list = pool_format(&command->pool, "%s%s%s", list, s ? ", " : "", command->read->state_name[s]);
    message_add(&command->messages, SEVERITY_ERROR, "--state", 1, 1,
                *(list ? list : "") ? "state %s is not defined, expected one of %s" : "state %s: the deck has no states%s",
                command->state, list ? list : "");
    return -2;
}

static int fit_all(struct command *command, const struct states *states, struct identification *found, struct command_fit *fit)
{
    const rotid_environment environment = command_environment(command);
    int status = runup_identify(&command->pool, states, &environment, &command->messages, found, &fit->fit);
    for (int s = 0; s < states->nstate && !status && states->nstate > 1; s++)
        status = identify_own_unknowns(&command->pool, &states->state[s], &found[s]);
    return status;
}

int command_choose_states(struct command *command, const char *what, struct command_fit *fit)
{
    const struct states *states = deck_states_of(command->read);
    int chosen = chosen_state(command);
    *fit = (struct command_fit){.first = chosen < 0 ? 0 : chosen,
                                .count = chosen < 0 ? states->nstate : 1,
                                .state = POOL_ARRAY(&command->pool, struct fitted_state, states->nstate)};
    if (!fit->state)
        return command_fail(command, ROTID_ERROR_MEMORY);
    if (chosen == -2)
        return command_fail(command, ROTID_ERROR_ARGUMENT);
    for (int i = 0; i < fit->count; i++) {
        struct state *state = &states->state[fit->first + i];
        const struct states one = {.nstate = 1, .state = state};
        if (what && states_refuse_types(&one, what, &command->messages))
            return command_fail(command, ROTID_ERROR_ARGUMENT);
        fit->state[i] = (struct fitted_state){.name = state->name, .job = &state->job};
    }
    return EXIT_DONE;
}

int command_fit_deck(struct command *command, int wanted, struct command_fit *fit)
{
    const struct states *states = deck_states_of(command->read);
    struct identification *found = POOL_ARRAY(&command->pool, struct identification, states->nstate);
    int status = found ? ROTID_OK : ROTID_ERROR_MEMORY;
    if (!status && wanted && states_modes(states, states->nstate))
        status = fit_all(command, states, found, fit);
    else if (!status && wanted && states->nparameter)
        message_warn(&command->messages,
                     "no mode was measured: the model is taken as the deck states it, not at identified parameters");
    if (status)
        return command_fail(command, status);
    for (int i = 0; i < fit->count; i++)
        fit->state[i].identified = found[fit->first + i];
    return EXIT_DONE;
}

int command_judge_fit(struct command *command, const struct command_fit *fit, const char *done)
{
    if (!fit->fit)
        return EXIT_DONE;
    int doubtful = fit->fit->n && (!fit->fit->converged || fit->fit->any_at_bound || fit->fit->any_undetermined);
    if (doubtful)
        message_warn(&command->messages,
                     "the identification is not reliable (not converged, at a bound or undetermined): see rotid identify");
    for (int i = 0; i < fit->count; i++)
        identify_warn_of_reduction(fit->state[i].job, &fit->state[i].identified, done, &command->messages);
    return doubtful ? EXIT_DOUBTFUL : EXIT_DONE;
}
