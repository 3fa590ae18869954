#include <stdio.h>
#include <string.h>

#include "cli/command.h"
#include "import/measurement.h"
#include "report/output.h"
#include "report/report_frf.h"
#include "report/table.h"

/* The measured functions of *FRF, FILE. */
static int read_measured(struct command *command, struct measurement *measurement, struct frf_measured *measured)
{
    const struct frf_request *request = &command->job->options.frf;
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
    terminal_say("rotid: cannot write %s: %s\n", command->output,
                 status == ROTID_ERROR_IO ? output_error() : rotid_status_text(status));
    return EXIT_INTERNAL;
}

static int report(struct command *command, const struct frf_view *view, int code)
{
    int status = ROTID_OK;
    if (command->json && (double)view->result->nline * view->result->ndone > JSON_FRF_MOST_LINES)
        message_add(&command->messages, SEVERITY_WARNING, NULL, 0, 0,
                    "the JSON has no curves: %d functions of %d lines are more than %d values, expected --output for so many",
                    view->result->ndone, view->result->nline, JSON_FRF_MOST_LINES);
    if (command_wants_table(command)) {
        status = table_frf(terminal_out(), &command->head, view);
        table_notes(terminal_out(), &command->messages);
    }
    if (status)
        return command_fail(command, status);
    struct result result = {.head = command->head, .frf = command->json ? frf_result_of(view) : NULL};
    int written = command_write_result(command, &result, code);
    code = write_output(command, view, written);
    return code > written ? code : written;
}

int command_frf(struct command *command)
{
    const struct job *job = command->job;
    double last = 0;
    int status = ROTID_OK, code = EXIT_DONE;
    const rotid_environment environment = command_environment(command, &last);
    struct identification identified = {0};
    struct measurement measurement;
    struct frf_measured measured;
    struct frf_result result;
    if (job->options.frf.file)
        status = read_measured(command, &measurement, &measured);
    if (!status && job->measurement.nmode)
        status = identify_run(&command->pool, job, 0, &environment, &command->messages, &identified);
    else if (!status && job->unknowns.nparameter)
        message_add(&command->messages, SEVERITY_WARNING, NULL, 0, 0,
                    "no mode was measured: the model is taken as the deck states it, not at identified parameters");
    const rotid_fit_result *fit = identified.fit;
    if (!status)
        status = frf_run(&command->pool, job, fit ? &identified : NULL, job->options.frf.file ? &measured : NULL, &environment,
                         &command->messages, &result);
    if (environment.progress)
        terminal_progress_end();
    if (status) {
        rotid_fit_free(identified.fit);
        return command_fail(command, status);
    }
    code = command_judge_fit(command, &identified, "synthesised");
    if (result.ndone < result.nrow || command_cancelled(NULL)) {
        terminal_say("rotid: interrupted; %d of %d transfer functions were finished\n", result.ndone, result.nrow);
        code = EXIT_DOUBTFUL;
    }
    const struct frf_view view = {.pool = &command->pool,
                                  .job = job,
                                  .identified = fit ? &identified : NULL,
                                  .set = job->options.frf.file ? &measurement.set : NULL,
                                  .result = &result,
                                  .verbose = command->verbose};
    code = report(command, &view, code);
    rotid_fit_free(identified.fit);
    return code;
}
