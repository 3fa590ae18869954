#include "api/api.h"
#include "cli/cli.h"

/* FROM:TO[:N] or a list of speeds, in rpm */
static int parse_speeds(struct command *command, struct speeds_options *options)
{
    const char *at = command->speeds.range;
    char *end = NULL;
    int is_list = at && strchr(at, ','), count = 0, good = 1;
    double *value = POOL_ARRAY(&command->pool, double, at ? strlen(at) / 2 + 4 : 1);
    if (!value)
        return command_fail(command, ROTID_ERROR_MEMORY);
    if (!at)
        return EXIT_DONE;
    for (int more = 1; more && good; at = end + 1) {
        value[count] = strtod(at, &end);
        good = end != at && value[count] >= 0 && value[count] < 1e7 && (is_list || count < 3);
        good = good && (!*end || *end == (is_list ? ',' : ':')) && (!count || !is_list || value[count] > value[count - 1]);
        more = *end != 0;
        count++;
    }
    if (!is_list && count == 2)
        value[count++] = SPEEDS_COUNT;
    if (!good || count < 2 || count > 10000 ||
        (!is_list && (!(value[1] > value[0]) || !(value[2] >= 2) || value[2] > 10000 || value[2] != floor(value[2]))))
        return arguments_wrong(
            "--speeds=%s is no range, expected FROM:TO, FROM:TO:N or two speeds and more with commas between them, "
            "in rpm, upwards, with N from 2 to 10000",
            command->speeds.range);
    options->from = value[0] * RPM;
    options->to = value[is_list ? count - 1 : 1] * RPM;
    options->count = is_list ? count : (int)value[2];
    for (int i = 0; i < count && is_list; i++)
        value[i] *= RPM;
    options->speed = is_list ? value : NULL;
    return EXIT_DONE;
}

/* table: NULL where memory is out */
static int write_csv(struct command *command, const char *path, const struct table *table, int code)
{
    struct output output;
    if (!path)
        return code;
    int status = table && !command->pool.out_of_memory ? output_open(&output, path) : ROTID_ERROR_MEMORY;
    if (!status) {
        table_write_csv(output.stream, table);
        status = output_close(&output, ROTID_OK);
    }
    if (status == ROTID_ERROR_IO)
        return terminal_end(EXIT_INTERNAL, "rotid: cannot write %s: %s\n", path, output_error());
    return status ? command_fail(command, status) : code;
}

static int run(struct command *command, const struct states *states, const rotid_fit_result *fit,
               const struct speeds_options *options, int code)
{
    const struct machine *machine = states->machine;
    const struct job *job = &states->state[0].job;
    rotid_speeds *speeds = POOL_NEW(&command->pool, rotid_speeds);
    rotid_fit_result own;
    const rotid_environment environment = command_environment(command);
    int status = speeds ? machine_fit(&command->pool, states, fit, &own) : ROTID_ERROR_MEMORY;
    if (!status)
        status =
            speeds_run(&command->pool, machine, job, own.x, fit ? &own : NULL, options, &environment, &command->messages, speeds);
    if (status < 0)
        return command_fail(command, status);
    if (status > 0) {
        message_warn(&command->messages, "interrupted: the critical speeds have no bands");
        code = EXIT_DOUBTFUL;
    }
    struct result result = {.head = command->head, .speeds = speeds};
    command_show(command, &result, screen_speeds);
    code = write_csv(command, command->speeds.campbell,
                     command->speeds.campbell ? table_of_campbell(&command->pool, speeds) : NULL, code);
    code = write_csv(command, command->speeds.response,
                     command->speeds.response ? table_of_response(&command->pool, speeds) : NULL, code);
    return command_write_result(command, &result, code);
}

int command_speeds(struct command *command)
{
    const struct states *states = deck_states_of(command->read);
    struct command_fit fit = {0};
    struct speeds_options options = {.count = SPEEDS_COUNT,
                                     .harmonic = command->speeds.harmonic,
                                     .draws = command->speeds.draws,
                                     .seed = command->seed,
                                     .threads = command->threads};
    int code = machine_refuse(states, &command->messages) ? command_fail(command, ROTID_ERROR_ARGUMENT)
                                                          : parse_speeds(command, &options);
    if (!code)
        code = command_choose_states(command, NULL, &fit);
    if (!code)
        code = command_fit_deck(command, states->nparameter || states->machine->nunknown, &fit);
    if (!code && command_cancelled(NULL)) {
        code = terminal_end(EXIT_DOUBTFUL, "rotid: interrupted, nothing was computed\n");
    } else if (!code) {
        code = run(command, states, fit.fit, &options, command_judge_fit(command, &fit, "used"));
    }
    rotid_fit_free(fit.fit);
    return code;
}
