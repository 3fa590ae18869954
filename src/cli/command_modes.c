#include "cli/cli.h"

static const char *const tables[] = {"modes", "shapes", NULL};

static int compute(struct command *command, const rotid_deck *deck, struct result_state *state)
{
    char failure[ROTID_FAILURE_LENGTH];
    rotid_spectrum **spectrum = &state->modes;
    int type = command->mode_type - 1; /* behind the word "stated" */
    int status = command->compare ? rotid_spectrum_beside(deck, deck->stated, 0, NULL, failure, spectrum)
                 : type < 0       ? rotid_spectrum_compute(deck, deck->stated, 0, NULL, failure, spectrum)
                                  : rotid_spectrum_of_type(deck, type, deck->stated, 0, NULL, failure, spectrum);
    if (status)
        return command_fail_with(command, status, failure);
    command_take_messages(command, state->name, (*spectrum)->nmessage, (*spectrum)->message);
    return command->messages.errors ? command_fail(command, ROTID_ERROR_UNPAIRED) /* no pairing */ : EXIT_DONE;
}

int command_modes(struct command *command)
{
    struct result result = {.head = command->head};
    int count = 0, code = command_refuse_csv(command, tables);
    if (!code && command->compare && command->mode_type > 1 + ROTID_BENDING)
        return arguments_wrong("--compare is of bending, expected it without --type=%s",
                               command->mode_type == 1 + ROTID_TORSION ? "torsion" : "axial");
    if (!code)
        code = command_each_state(command, &result, compute, &count);
    if (!code)
        command_show(command, &result, screen_modes);
    if (!code && command->csv) {
        struct table *table[] = {table_of_model_modes(&command->pool, result.modes),
                                 table_of_shapes(&command->pool, &command->job->rotor, result.modes)};
        code = command_write_csv(command, tables, table, EXIT_DONE);
    }
    if (!code)
        code = command_write_result(command, &result, EXIT_DONE);
    for (int s = 0; s < count; s++)
        rotid_spectrum_free(result.states[s].modes);
    return code;
}
