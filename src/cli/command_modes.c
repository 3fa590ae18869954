#include "cli/cli.h"

static const char *const tables[] = {"modes", "shapes", NULL};

static void free_all(const struct result *result)
{
    for (int s = 0; s < result->nstates; s++)
        rotid_spectrum_free(result->states[s].modes);
    if (!result->nstates)
        rotid_spectrum_free(result->modes);
}

/* Of each state, or of the deck that is one. An exit code, EXIT_DONE to go on. */
static int compute(struct command *command, struct result *result)
{
    for (int s = 0; s < command_state_count(command); s++) {
        char failure[ROTID_FAILURE_LENGTH];
        const char *name;
        const rotid_deck *deck = command_state(command, s, &name);
        rotid_spectrum **spectrum = name ? &result->states[s].modes : &result->modes;
        int type = command->mode_type - 1; /* behind the word "stated" */
        int status = command->compare ? rotid_spectrum_beside(deck, deck->stated, 0, NULL, failure, spectrum)
                     : type < 0       ? rotid_spectrum_compute(deck, deck->stated, 0, NULL, failure, spectrum)
                                      : rotid_spectrum_of_type(deck, type, deck->stated, 0, NULL, failure, spectrum);
        if (status)
            return command_fail_with(command, status, failure);
        command_take_messages(command, name, (*spectrum)->nmessage, (*spectrum)->message);
        if (command->messages.errors) /* no pairing */
            return command_fail(command, ROTID_ERROR_UNPAIRED);
        if (!s)
            result->modes = *spectrum;
    }
    return EXIT_DONE;
}

int command_modes(struct command *command)
{
    struct result result = {.head = command->head};
    int code = command_refuse_csv(command, tables);
    if (!code && command->compare && command->mode_type > 1 + ROTID_BENDING)
        return arguments_wrong("--compare is of bending, expected it without --type=%s",
                               command->mode_type == 1 + ROTID_TORSION ? "torsion" : "axial");
    if (!code)
        code = command_begin_states(command, &result);
    if (!code)
        code = compute(command, &result);
    if (!code)
        command_show(command, &result, screen_modes);
    if (!code && command->csv) {
        struct table *table[] = {table_of_model_modes(&command->pool, result.modes),
                                 table_of_shapes(&command->pool, &command->job->rotor, result.modes)};
        code = command_write_csv(command, tables, table, EXIT_DONE);
    }
    if (!code)
        code = command_write_result(command, &result, EXIT_DONE);
    free_all(&result);
    return code;
}
