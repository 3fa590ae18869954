#include "cli/cli.h"

#define DIGITS     1e-5 /* of a function: what six digits in a file leave of it */
#define SAME_PLACE 1e-5 /* m */

/* Whole or not there. */
static int write_modes(struct command *command, const char *source, const struct measurement *measurement, const struct ema *ema)
{
    struct output output;
    int status = output_open(&output, command->output);
    if (!status)
        status = output_close(&output, modes_write(output.stream, source, "rotid " ROTID_VERSION, measurement, ema));
    if (status == ROTID_ERROR_IO)
        return terminal_end(EXIT_INTERNAL, "rotid: %s: cannot be written: %s\n", command->output, output_error());
    return status ? command_fail(command, status) : EXIT_DONE;
}

/* An option that the file leaves without a meaning. 0, or 1 after an error. */
static int refuse_options(struct command *command, const struct measurement *measurement)
{
    static const char *const of_records[] = {"estimator",  "exponential",   "force-window",     "block",
                                             "pretrigger", "trigger-level", "keep-double-hits", NULL},
                             *const of_functions[] = {"averages", NULL};
    const char *const *ignored = measurement->from_records ? of_functions : of_records;
    for (; *ignored; ignored++)
        if (arguments_given(command, *ignored))
            return message_refuse(&command->messages, 1, command->deck, 1, 1,
                                  "--%s is for %s and this file has %s, expected it without", *ignored,
                                  measurement->from_records ? "transfer functions" : "time records",
                                  measurement->from_records ? "time records" : "transfer functions");
    return 0;
}

static int is_doubtful(const struct ema *ema)
{
    int doubtful = !ema->nmode;
    for (int k = 0; k < ema->nmode; k++)
        doubtful |= (ema->mode[k].quality_flags & (EMA_UNSTABLE | EMA_WEAK | EMA_NEGATIVE_DAMPING | EMA_NOT_REFINED)) != 0;
    return doubtful;
}

/* Points of a mode that were measured and have no value: no chain of common points ties their functions to the others. */
static int untied(const struct ema *ema, const struct ema_mode *mode)
{
    int count = 0;
    for (int i = 0; i < ema->npoint; i++) {
        int measured = 0;
        for (int c = 0; c < ema->nfrf && isnan(mode->shape[i]); c++)
            measured |= ema->channel_point[c] == i && !isnan(creal(mode->residue[c]));
        count += measured;
    }
    return count;
}

static void note_untied(struct command *command, const struct ema *ema)
{
    int most = 0;
    for (int k = 0; k < ema->nmode; k++) {
        int count = untied(ema, &ema->mode[k]);
        most = count > most ? count : most;
    }
    if (most)
        message_add(
            &command->messages, SEVERITY_WARNING, command->deck, 1, 1,
            "the shapes are of one part of the points, %d of %d are left out: nothing ties their functions to the others, "
            "expected a point that both parts have",
            most, ema->npoint);
}

#define LEAST_POINTS 5 /* fewer do not tell how a frequency follows the shape (point_mean) */

/* Whether the response went from point to point, and a mode's frequency with it: its accelerometer is felt. */
static int is_moving(const struct frf_set *set, const struct ema *ema)
{
    int felt = 0, points = 0;
    for (int k = 0; k < ema->nmode; k++)
        felt |= ema->mode[k].local_pole != NULL;
    for (int i = 1; i < set->nfrf; i++)
        points |= set->frf[i].response_node != set->frf[0].response_node;
    return felt && points && ema->npoint >= LEAST_POINTS;
}

/* Modes of one file. An exit code, EXIT_DONE to go on; *options: with --per-point where the data ask for it. */
static int extract_modes(struct command *command, struct ema_options *options, struct measurement *measurement, struct ema *ema)
{
    const rotid_environment environment = command_environment(command);
    struct measurement_options from = command->ema.measurement;
    from.threads = options->threads = command->threads;
    from.low_hz = options->low_hz;
    from.high_hz = options->high_hz;
    int status = measurement_read(&command->pool, command->deck, &from, &command->messages, measurement);
    if (!status && command_cancelled(NULL))
        status = ROTID_STOP_CANCELLED;
    if (!status && refuse_options(command, measurement))
        status = ROTID_ERROR_ARGUMENT;
    const struct frf_set *set = &measurement->set;
    for (int i = 0; i < options->npick && !status; i++)
        if (options->pick_hz[i] < set->frequency_hz[0] || options->pick_hz[i] > set->frequency_hz[set->nline - 1])
            status = message_refuse(&command->messages, ROTID_ERROR_ARGUMENT, command->deck, 1, 1,
                                    "--pick %.6g Hz, expected a frequency from %.6g to %.6g Hz", options->pick_hz[i],
                                    set->frequency_hz[0], set->frequency_hz[set->nline - 1]);
    if (!status)
        status = ema_compute(&command->pool, set, options, &environment, ema);
    if (!status && !options->per_point && is_moving(set, ema)) {
        options->per_point = 1;
        status = ema_compute(&command->pool, set, options, &environment, ema);
        message_warn(&command->messages,
                     "frequencies differ from point to point, as with one accelerometer that goes round: they are taken at each "
                     "point as well (--per-point), and identify and diagnose allow for its mass");
    }
    if (!status)
        note_untied(command, ema);
    if (status == ROTID_STOP_CANCELLED)
        return terminal_end(EXIT_DOUBTFUL, "rotid: interrupted; nothing was written\n");
    if (status == ROTID_ERROR_ARGUMENT && !command->messages.errors)
        message_add(
            &command->messages, SEVERITY_ERROR, command->deck, 1, 1,
            "%d transfer functions of %d lines from %.6g to %.6g Hz, expected at least one that is not dead with at least 16 "
            "lines in the band",
            set->nfrf, set->nline, set->nline ? set->frequency_hz[0] : 0, set->nline ? set->frequency_hz[set->nline - 1] : 0);
    if (status)
        return command_fail(command, status);
    command_print_messages(command);
    return EXIT_DONE;
}

/* The file of the modes, where --output asks for it and there is one. */
static int write_output(struct command *command, const char *source, const struct measurement *measurement, const struct ema *ema)
{
    if (command->output && !ema->nmode)
        terminal_say("rotid: %s: not written, there is no mode\n", command->output);
    return command->output && ema->nmode ? write_modes(command, source, measurement, ema) : EXIT_DONE;
}

/* Whether two tests have the same modes to the last digit: one that is given twice has no scatter. */
static int is_same_test(const struct ema *a, const struct ema *b)
{
    int same = a->nmode > 0 && a->nmode == b->nmode && a->npoint == b->npoint;
    for (int k = 0; k < a->nmode && same; k++)
        same = a->mode[k].frequency_hz == b->mode[k].frequency_hz &&
               !memcmp(a->mode[k].shape, b->mode[k].shape, (size_t)a->npoint * sizeof *a->mode[k].shape);
    return same;
}

/* A transfer function of b that is one of a but for the digits in which files are written: parts of one test, in another order or
 * format. NULL: there is none, as of two tests, whose noise differs. */
static const struct frf *shared(const struct frf_set *a, const struct frf_set *b)
{
    int lines = a->nline == b->nline && fabs(a->frequency_hz[0] - b->frequency_hz[0]) <= DIGITS * b->frequency_hz[b->nline - 1] &&
                fabs(a->frequency_hz[a->nline - 1] - b->frequency_hz[b->nline - 1]) <= DIGITS * b->frequency_hz[b->nline - 1];
    for (int i = 0; i < a->nfrf && lines; i++)
        for (int j = 0; j < b->nfrf; j++) {
            const struct frf *one = &a->frf[i], *other = &b->frf[j];
            double apart = 0, whole = 0;
            if (one->response_node != other->response_node || one->response_direction != other->response_direction ||
                one->reference_node != other->reference_node || one->reference_direction != other->reference_direction)
                continue;
            for (int k = 0; k < a->nline; k++) {
                apart += creal((one->h[k] - other->h[k]) * conj(one->h[k] - other->h[k]));
                whole += creal(one->h[k] * conj(one->h[k]));
            }
            if (whole > 0 && apart <= DIGITS * DIGITS * whole)
                return other;
        }
    return NULL;
}

ORDER_BY(by_id, struct uff_node, it->id, 0)

/* The transfer functions and the nodes of all tests, which the means are of. */
static int join(struct command *command, int count, const struct measurement *test, struct measurement *out)
{
    int functions = 0, nodes = 0;
    for (int t = 0; t < count; t++) {
        functions += test[t].set.nfrf;
        nodes += test[t].node_count;
    }
    *out = (struct measurement){.set = {.frf = POOL_ARRAY(&command->pool, struct frf, functions)},
                                .node = POOL_ARRAY(&command->pool, struct uff_node, nodes)};
    if (!out->set.frf || !out->node)
        return ROTID_ERROR_MEMORY;
    for (int t = 0; t < count; t++) {
        int before = out->node_count;
        double apart = 0;
        for (int c = 0; c < test[t].set.nfrf; c++)
            out->set.frf[out->set.nfrf++] = test[t].set.frf[c];
        for (int i = 0; i < test[t].node_count; i++) {
            const struct uff_node *node = &test[t].node[i],
                                  *known = before ? bsearch(node, out->node, (size_t)before, sizeof *node, by_id) : NULL;
            if (!known)
                out->node[out->node_count++] = *node;
            for (int a = 0; a < 3 && known; a++)
                apart = fmax(apart, fabs(known->x[a] - node->x[a]));
        }
        if (apart > SAME_PLACE)
            message_add(&command->messages, SEVERITY_WARNING, command->file[t], 1, 1,
                        "nodes are up to %.2g m from where a file before it has them, whose coordinates are used", apart);
        if (out->node_count)
            qsort(out->node, (size_t)out->node_count, sizeof *out->node, by_id);
    }
    return ROTID_OK;
}

/* Several tests of one structure: their mean, and the scatter between them. */
static int command_ema_tests(struct command *command)
{
    int count = command->nfile, code = EXIT_DONE;
    struct measurement *measurement = POOL_ARRAY(&command->pool, struct measurement, count), all;
    struct ema *test = POOL_ARRAY(&command->pool, struct ema, count), mean;
    struct ema_scatter scatter;
    if (!measurement || !test)
        return command_fail(command, ROTID_ERROR_MEMORY);
    if (command->json)
        return arguments_wrong("--json %s: expected one file, of several tests --output holds the means", command->json);
    for (int t = 0; t < count; t++) {
        struct ema_options options = command->ema.options;
        command->deck = command->file[t];
        int failed = extract_modes(command, &options, &measurement[t], &test[t]);
        if (failed)
            return failed;
        code = is_doubtful(&test[t]) ? EXIT_DOUBTFUL : code;
        for (int before = 0; before < t; before++) {
            const struct frf *twice = shared(&measurement[before].set, &measurement[t].set);
            if (is_same_test(&test[before], &test[t]))
                return arguments_wrong("%s: has the modes of a file before it to the last digit, expected another test",
                                       command->file[t]);
            const char *which = twice ? pool_format(&command->pool, "%s: transfer function %d/%d is that of %s", command->file[t],
                                                    twice->response_node, twice->reference_node, command->file[before])
                                      : NULL;
            if (which)
                return arguments_wrong("%s, expected another test", which);
        }
    }
    command->deck = command->file[0];
    int status = join(command, count, measurement, &all);
    if (!status)
        status = ema_average(&command->pool, count, test, &mean, &scatter);
    if (status)
        return command_fail(command, status);
    command_print_messages(command);
    code = mean.nmode ? code : EXIT_DOUBTFUL;
    int failed = write_output(command, pool_text(&command->pool, "%d tests", count), &all, &mean);
    if (failed)
        return failed;
    if (command_wants_table(command)) {
        const struct screen to = command_screen(command);
        screen_scatter(&to, count, (const char *const *)command->file, test, &mean, &scatter,
                       mean.nmode ? command->output : NULL);
    }
    return code;
}

int command_ema(struct command *command)
{
    if (command->nfile > 1)
        return command_ema_tests(command);
    struct measurement measurement;
    struct ema ema = {0};
    struct ema_options options = command->ema.options;
    double started = clock_seconds();
    int code = extract_modes(command, &options, &measurement, &ema);
    if (code)
        return code;
    const struct ema_report report = {.file = command->deck,
                                      .output = command->output && ema.nmode ? command->output : NULL,
                                      .measurement = &measurement,
                                      .options = &options,
                                      .ema = &ema,
                                      .seconds = clock_seconds() - started};
    int failed = write_output(command, command->deck, &measurement, &ema);
    if (failed)
        return failed;
    if (command_wants_table(command)) {
        const struct screen to = command_screen(command);
        screen_ema(&to, &report);
    }
    struct result result = {.head = command->head, .ema = command->json ? ema_result_of(&command->pool, &report, 1) : NULL};
    return command_write_result(command, &result, is_doubtful(&ema) ? EXIT_DOUBTFUL : EXIT_DONE);
}
