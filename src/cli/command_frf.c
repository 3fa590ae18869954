#include "cli/cli.h"

/* The measured functions of *FRF, FILE. */
static int read_measured(struct command *command, const struct job *job, struct measurement *measurement,
                         struct frf_measured *measured)
{
    const struct frf_request *request = &job->options.frf;
    const struct measurement_options options = {
        .low_hz = request->low_hz, .high_hz = request->high_hz, .threads = command->threads};
    int status = measurement_read(&command->pool, request->file, &options, &command->messages, measurement);
    if (status)
        return status;
    struct frf_node *node = POOL_ARRAY(&command->pool, struct frf_node, measurement->node_count);
    if (!node)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < measurement->node_count; i++) {
        node[i].id = measurement->node[i].id;
        memcpy(node[i].x, measurement->node[i].x, sizeof node[i].x);
    }
    *measured = (struct frf_measured){&measurement->set, request->file, measurement->node_count, node};
    return ROTID_OK;
}

static int write_output(struct command *command, const struct frf_view *view, int code)
{
    struct output output;
    if (!command->output)
        return code;
    int status = output_open(&output, command->output);
    if (!status)
        status = output_close(&output, frf_write_file(output.stream, command->head.rotid, view));
    if (!status)
        return code;
    return terminal_end(EXIT_INTERNAL, "rotid: cannot write %s: %s\n", command->output,
                        status == ROTID_ERROR_IO ? output_error() : rotid_status_text(status));
}

/* count: of the views, one for each state */
static int report(struct command *command, int count, const struct frf_view *view, struct result *result, int code)
{
    const struct screen to = command_screen(command);
    int told = 0, shown = command_wants_table(command);
    for (int i = 0; i < count && command->json; i++) {
        const struct frf_result *r = view[i].result;
        if ((double)r->nline * r->ndone > JSON_FRF_MOST_LINES && !told++)
            message_warn(
                &command->messages,
                "the JSON has no curves: %d functions of %d lines are more than %d values, expected --output for so many",
                r->ndone, r->nline, JSON_FRF_MOST_LINES);
    }
    if (shown)
        screen_heading(&to, &command->head);
    for (int i = 0; i < count && (shown || command->json); i++) {
        const struct transfer_result *made = frf_result_of(&view[i]);
        if (!made)
            return command_fail(command, ROTID_ERROR_MEMORY);
        if (shown && view[i].state)
            screen_state(&to, i, view[i].state);
        if (shown)
            screen_frf(&to, &view[i], made);
        result->frf = i ? result->frf : made;
        if (result->nstates) {
            result->states[i].name = view[i].state;
            result->states[i].frf = made;
        }
    }
    if (shown)
        screen_notes(&to, &command->messages);
    int written = command_write_result(command, result, code);
    code = write_output(command, view, written);
    return code > written ? code : written;
}

/* The functions of a state. */
static int synthesise(struct command *command, const struct fitted_state *state, const rotid_environment *environment,
                      struct frf_view *view)
{
    struct measurement *measurement = POOL_NEW(&command->pool, struct measurement);
    struct frf_measured measured;
    struct frf_result *result = POOL_NEW(&command->pool, struct frf_result);
    const struct identification *identified = state->identified.fit ? &state->identified : NULL;
    int with_file = state->job->options.frf.file != NULL, status = measurement && result ? ROTID_OK : ROTID_ERROR_MEMORY;
    if (!status && with_file)
        status = read_measured(command, state->job, measurement, &measured);
    if (!status)
        status = frf_run(&command->pool, state->job, identified, with_file ? &measured : NULL, environment, &command->messages,
                         result);
    *view = (struct frf_view){.pool = &command->pool,
                              .state = state->name,
                              .job = state->job,
                              .identified = identified,
                              .set = with_file && !status ? &measurement->set : NULL,
                              .result = result};
    return status;
}

static int synthesise_all(struct command *command, const struct command_fit *fit, struct result *result)
{
    const rotid_environment environment = command_environment(command);
    struct frf_view *view = POOL_ARRAY(&command->pool, struct frf_view, fit->count);
    int status = view ? ROTID_OK : ROTID_ERROR_MEMORY, code, done = 0, all = 0;
    for (int i = 0; i < fit->count && !status; i++) {
        status = synthesise(command, &fit->state[i], &environment, &view[i]);
        done += status ? 0 : view[i].result->ndone;
        all += status ? 0 : view[i].result->nrow;
    }
    if (status)
        return command_fail(command, status);
    code = command_judge_fit(command, fit, "synthesised");
    if (done < all || command_cancelled(NULL))
        code = terminal_end(EXIT_DOUBTFUL, "rotid: interrupted; %d of %d transfer functions were finished\n", done, all);
    return report(command, fit->count, view, result, code);
}

int command_frf(struct command *command)
{
    struct result result = {.head = command->head, .nstates = command->read->nstate};
    struct command_fit fit = {0};
    if (command->output && command->read->nstate && !command->state)
        return command_fail(
            command,
            message_refuse(&command->messages, ROTID_ERROR_ARGUMENT, "--output", 1, 1,
                           "a universal file has no states and the deck has %d, expected --state %s or another one beside it",
                           command->read->nstate, command->read->state_name[0]));
    result.states = POOL_ARRAY(&command->pool, struct result_state, result.nstates);
    int code = result.states ? command_choose_states(command, "a lateral transfer function", &fit)
                             : command_fail(command, ROTID_ERROR_MEMORY);
    for (int i = 0; i < fit.count && !code; i++)
        if (frf_refuse_undamped(fit.state[i].job, &command->messages))
            code = command_fail(command, ROTID_ERROR_ARGUMENT);
    if (!code)
        code = command_fit_deck(command, 1, &fit);
    result.nstates = result.nstates ? fit.count : 0;
    if (!code)
        code = synthesise_all(command, &fit, &result);
    rotid_fit_free(fit.fit);
    return code;
}
