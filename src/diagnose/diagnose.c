#include "diagnose/diagnose.h"

#include <math.h>
#include <string.h>

#include "base/clock.h"
#include "diagnose/causes/catalogue.h"
#include "diagnose/engine.h"
#include "diagnose/leave_out.h"
#include "fit/quantile.h"

#define REPLICATES   1000
#define MOST_CLEANED 3 /* rounds of finding faults of channels */
#define MOST_STEPS   64
#define MOST_REFINED 3 /* times the mesh is halved */

const char *verdict_name(enum verdict_kind kind)
{
    static const char *const names[] = {"adequate", "named", "ambiguous", "unexplained"};
    return names[kind];
}

void engine_step(struct engine *engine, const char *name)
{
    struct diagnosis *out = engine->out;
    double now = clock_seconds();
    int i = 0;
    while (i < out->nstep && strcmp(out->step[i].name, name) != 0)
        i++;
    if (i == out->nstep && out->nstep < MOST_STEPS)
        out->step[out->nstep++] = (struct diagnosis_step){name, 0};
    if (i < MOST_STEPS)
        out->step[i].seconds += now - engine->clock;
    engine->clock = now;
}

int engine_stage(const struct engine *engine, const char *stage, int step)
{
    const rotid_environment *e = engine->environment;
    if (e && e->progress)
        e->progress(e->context, stage, step);
    return e && e->cancelled && e->cancelled(e->context) ? ROTID_STOP_CANCELLED : ROTID_OK;
}

/* ---- numbers */

static int add_numerical(struct engine *engine, const char *id, int count, const double *error, const char *text)
{
    struct diagnosis *out = engine->out;
    int *mode = POOL_ARRAY(engine->pool, int, count);
    double *copy = POOL_ARRAY(engine->pool, double, count);
    if (!mode || !copy || !text)
        return ROTID_ERROR_MEMORY;
    for (int k = 0; k < count; k++) {
        mode[k] = k + 1;
        copy[k] = error[k];
    }
    out->numerical_finding[out->nnumerical_finding++] =
        (struct numerical_finding){catalogue_find(id), count, mode, copy, text};
    return ROTID_OK;
}

/* Largest error of the measured modes against the noise of their frequencies; *at: that mode. */
static double against_noise(const struct engine *engine, const double *error, int count, int *at)
{
    double largest = 0;
    *at = 0;
    for (int k = 0; k < engine->job.nmode; k++) {
        int mode = engine->number[k] - 1;
        if (mode >= count || !isfinite(error[mode]))
            continue;
        double ratio = fabs(error[mode]) / (100 * engine->job.frequency_std[k]);
        if (ratio > largest) {
            largest = ratio;
            *at = mode;
        }
    }
    return largest;
}

/* Elements twice as many: the error of the mesh is taken out before anything else is blamed. */
static int refine_mesh(struct engine *engine)
{
    struct rotor *rotor = &engine->job.rotor;
    struct segment *segment = POOL_ARRAY(engine->pool, struct segment, rotor->nsegment);
    if (!segment)
        return ROTID_ERROR_MEMORY;
    for (int s = 0; s < rotor->nsegment; s++) {
        segment[s] = rotor->segment[s];
        segment[s].elements *= 2;
    }
    rotor->segment = segment;
    return ROTID_OK;
}

static int note_reduction(struct engine *engine)
{
    const struct diagnosis *out = engine->out;
    const struct spectrum *s = &out->today.spectrum;
    int at;
    if (!out->has_today || out->today.fit == NULL)
        return ROTID_OK;
    double ratio = against_noise(engine, s->reduction_error_percent, s->count, &at);
    if (!(ratio > 1))
        return ROTID_OK;
    return add_numerical(engine, "guyan_reduction", s->count, s->reduction_error_percent,
                         pool_format(engine->pool,
                                     "the condensation onto %d masters moves mode %d by %+.2f %%, %.1f times its noise; the full "
                                     "model is judged",
                                     s->nmaster, at + 1, s->reduction_error_percent[at], ratio));
}

/* ---- base */

static int fit_base(struct engine *engine, int say)
{
    struct diagnosis *out = engine->out;
    struct message_list quiet;
    message_open(&quiet, engine->pool);
    rotid_fit_free(out->base.fit);
    out->base.fit = NULL;
    int status = identify_run(engine->pool, &engine->job, 0, engine->environment, &quiet, &out->base);
    for (size_t i = 0; i < quiet.count && (say || status); i++)
        message_add(engine->notes, quiet.item[i].severity, NULL, 0, 0, "%s", quiet.item[i].text);
    if (status)
        return status;
    if (out->base.fit->status == ROTID_STOP_CANCELLED)
        return ROTID_STOP_CANCELLED;
    engine->number = out->base.compared.number;
    engine->holdout = engine->job.holdout;
    engine->fit = out->base.fit;
    out->job = engine->job;
    return job_started_at(engine->pool, &engine->job, engine->fit->x, &engine->job);
}

static int note_pairing(struct engine *engine)
{
    const struct job *job = &engine->job;
    for (int k = 0; k < job->nmode; k++) {
        if (engine->number[k] == job->number[k])
            continue;
        struct data_finding finding = {.cause = catalogue_find("mode_pairing"),
                                       .nmode = 2,
                                       .mode = {job->number[k], engine->number[k]},
                                       .value = NAN,
                                       .std = NAN,
                                       .chi2_drop = NAN};
        finding.text = pool_format(engine->pool, "measured mode %d (%.6g Hz) has the shape of mode %d of the model; it is taken as that",
                                   job->number[k], job->frequency_hz[k], engine->number[k]);
        int status = data_add_finding(engine, &finding);
        if (status)
            return status;
    }
    return ROTID_OK;
}

/* Base fit, faults of the data taken out, mesh fine enough: what the rounds start from. */
static int prepare_base(struct engine *engine)
{
    struct diagnosis *out = engine->out;
    int status = fit_base(engine, 1), changed = 1, at;
    if (!status)
        status = note_pairing(engine);
    for (int pass = 0; pass < MOST_CLEANED && !status && changed; pass++) {
        struct scan scan;
        status = scan_run(engine->pool, &engine->job, engine->number, engine->holdout, engine->fit->x, &scan);
        if (!status)
            status = data_clean(engine, &scan, &changed);
        if (!status && changed)
            status = fit_base(engine, 0);
        if (!status)
            status = engine_stage(engine, "measurement chain, pass", pass + 1);
    }
    for (int pass = 0; pass < MOST_REFINED && !status; pass++) {
        const struct spectrum *s = &out->base.spectrum;
        double ratio = against_noise(engine, s->mesh_error_percent, s->count, &at);
        if (!(ratio > 1))
            break;
        if (!pass)
            status = add_numerical(engine, "mesh", s->count, s->mesh_error_percent,
                                   pool_format(engine->pool,
                                               "the mesh moves mode %d by %+.2f %%, %.1f times its noise; a finer one is judged",
                                               at + 1, s->mesh_error_percent[at], ratio));
        if (!status)
            status = refine_mesh(engine);
        if (!status)
            status = fit_base(engine, 0);
    }
    if (!status && engine->fit->dof < 1) {
        message_add(engine->notes, SEVERITY_ERROR, out->job.deck, 1, 1,
                    "%d residuals for %d parameters leave nothing to judge the model by, expected more modes or shapes",
                    engine->fit->nresidual, engine->fit->n);
        return ROTID_ERROR_ARGUMENT;
    }
    return status;
}

static int residuals_of_base(struct engine *engine)
{
    struct diagnosis *out = engine->out;
    const struct job *job = &engine->job;
    const rotid_fit_result *fit = engine->fit;
    int nsensor = job->rotor.nsensor, row = 0, shapes = job->shape && job_knows_shape_noise(job);
    out->mode_z = POOL_ARRAY(engine->pool, double, job->nmode);
    out->sensor_rms = POOL_ARRAY(engine->pool, double, nsensor);
    int *count = POOL_ARRAY(engine->pool, int, nsensor);
    if (!out->mode_z || !out->sensor_rms || !count)
        return ROTID_ERROR_MEMORY;
    for (int k = 0; k < job->nmode; k++) {
        out->mode_z[k] = fit->residual[k];
        row += !engine->holdout[k];
    }
    for (int k = 0; k < job->nmode && shapes; k++)
        for (int s = 0; s < nsensor && !engine->holdout[k]; s++)
            if (isfinite(job->shape[s + (ptrdiff_t)k * nsensor])) {
                out->sensor_rms[s] += fit->r[row] * fit->r[row];
                count[s]++;
                row++;
            }
    for (int s = 0; s < nsensor; s++)
        out->sensor_rms[s] = count[s] ? sqrt(out->sensor_rms[s] / count[s]) : NAN;
    out->frequency_noise = NAN;
    out->shape_noise = NAN;
    if (job->nmode)
        out->frequency_noise = job->frequency_std[0];
    for (ptrdiff_t i = 0; i < (ptrdiff_t)nsensor * job->nmode && shapes && !isfinite(out->shape_noise); i++)
        out->shape_noise = job->shape_std[i];
    return ROTID_OK;
}

/* ---- rounds */

/* The winner of a round becomes part of the model, with what it leaves as an approximation added to the noise. */
static int accept_cause(struct engine *engine, const struct diagnosis_round *round, struct round_result *result)
{
    struct diagnosis *out = engine->out;
    struct refit *refit = &result->refit[result->winner];
    const struct cause_kind *cause = round->candidate[0].cause;
    out->cause[out->ncause++] = round->candidate[0];
    struct job job = refit->job;
    if (engine->fit != out->base.fit)
        rotid_fit_free(engine->fit);
    engine->fit = refit->fit;
    refit->fit = NULL;
    if (cause->discrepancy_frequency > 0 || cause->discrepancy_shape > 0) {
        ptrdiff_t components = (ptrdiff_t)job.rotor.nsensor * job.nmode;
        double *std = POOL_ARRAY(engine->pool, double, job.nmode);
        if (!std)
            return ROTID_ERROR_MEMORY;
        for (int k = 0; k < job.nmode; k++)
            std[k] = hypot(job.frequency_std[k], cause->discrepancy_frequency);
        job.frequency_std = std;
        if (job.shape && cause->discrepancy_shape > 0) {
            double *shapes = POOL_ARRAY(engine->pool, double, components);
            if (!shapes)
                return ROTID_ERROR_MEMORY;
            for (ptrdiff_t i = 0; i < components; i++)
                shapes[i] = hypot(job.shape_std[i], cause->discrepancy_shape);
            job.shape_std = shapes;
        }
        rotid_fit_result *fit = NULL;
        int status = refit_job(engine->pool, &job, engine->number, engine->holdout, engine->environment, &fit);
        if (status)
            return status;
        rotid_fit_free(engine->fit);
        engine->fit = fit;
    }
    engine->job = job;
    return job_started_at(engine->pool, &job, engine->fit->x, &engine->job);
}

/* Evidence that is left when nothing more can be named: how far the best model that could be tried still is from the data. */
static double left_over(const struct diagnosis_round *last)
{
    double chi2 = last->chi2;
    if (last->kind == VERDICT_ADEQUATE)
        return 0;
    for (int i = 0; i < last->ncandidate; i++)
        if (last->candidate[i].refitted && last->candidate[i].chi2 < chi2)
            chi2 = last->candidate[i].chi2;
    return fmax(0, chi2 - last->dof - 2.33 * sqrt(2.0 * last->dof));
}

static int take_set(struct engine *engine, const struct diagnosis_round *round, int count)
{
    struct diagnosis *out = engine->out;
    out->alternative = POOL_ARRAY(engine->pool, struct candidate, count);
    if (!out->alternative)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < count; i++)
        out->alternative[i] = round->candidate[i];
    out->nalternative = count;
    return ROTID_OK;
}

/* The verdict from the rounds. */
static int settle(struct engine *engine, struct round_result *last)
{
    struct diagnosis *out = engine->out;
    const struct diagnosis_round *first = &out->round[0], *end = &out->round[out->nround - 1];
    int status = ROTID_OK;
    out->p_value = fmin(first->p_scan, fmin(first->p_frequency, first->p_total));
    out->adequate_after = end->kind == VERDICT_ADEQUATE;
    out->kind = out->ncause ? VERDICT_NAMED : end->kind;
    if (end->kind == VERDICT_AMBIGUOUS) {
        status = take_set(engine, end, end->nset > 0 ? end->nset : 1);
        if (!status && !(out->next_measurement = advise(engine, end, last)))
            status = ROTID_ERROR_MEMORY;
    } else if (end->kind == VERDICT_UNEXPLAINED && !(out->next_measurement = advise(engine, end, last))) {
        status = ROTID_ERROR_MEMORY;
    }
    return status;
}

static int run_rounds(struct engine *engine, struct round_result *last)
{
    struct diagnosis *out = engine->out;
    out->round = POOL_ARRAY(engine->pool, struct diagnosis_round, DIAGNOSE_MOST_CAUSES + 1);
    out->cause = POOL_ARRAY(engine->pool, struct candidate, DIAGNOSE_MOST_CAUSES);
    if (!out->round || !out->cause)
        return ROTID_ERROR_MEMORY;
    for (;;) {
        struct diagnosis_round *round = &out->round[out->nround];
        round_free(last);
        int status = round_run(engine, round, last);
        if (status)
            return status;
        out->nround++;
        if (out->nround == 1)
            status = localise(engine, &last->scan);
        if (status || round->kind != VERDICT_NAMED || out->ncause == DIAGNOSE_MOST_CAUSES || last->winner < 0)
            return status;
        status = accept_cause(engine, round, last);
        if (status)
            return status;
    }
}

static int run(struct engine *engine, const struct job *job, struct round_result *last)
{
    struct diagnosis *out = engine->out;
    struct message_list quiet;
    message_open(&quiet, engine->pool);
    int status = data_prepare(engine, job);
    engine_step(engine, "data");
    if (!status)
        status = engine_stage(engine, "fit as the deck states it", 1);
    if (!status && job->nparameter) { /* what the user does today; should that fail, there is still the judged model */
        int today = identify_run(engine->pool, job, 0, engine->environment, &quiet, &out->today);
        out->has_today = !today;
        status = today == ROTID_ERROR_MEMORY ? today : ROTID_OK;
    }
    engine_step(engine, "fit of today");
    if (!status)
        status = prepare_base(engine);
    if (!status)
        status = note_reduction(engine);
    if (!status)
        status = residuals_of_base(engine);
    engine->stated_std = engine->job.frequency_std;
    engine_step(engine, "base");
    if (!status)
        status = run_rounds(engine, last);
    if (!status)
        status = settle(engine, last);
    return status ? status : conclude(engine, last);
}

int diagnose_run(struct pool *pool, const struct job *job, const struct diagnose_options *options,
                 const rotid_environment *environment, struct message_list *notes, struct diagnosis *out)
{
    struct engine engine = {.pool = pool,
                            .threads = options->threads > 0 ? options->threads : 1,
                            .replicates = options->replicates > 0 ? options->replicates : REPLICATES,
                            .seed = options->seed,
                            .environment = environment,
                            .notes = notes,
                            .out = out,
                            .mode_out_rms = NAN,
                            .mode_out_shape = NAN,
                            .clock = clock_seconds()};
    struct round_result last = {0};
    *out = (struct diagnosis){0};
    out->step = POOL_ARRAY(pool, struct diagnosis_step, MOST_STEPS);
    out->numerical_finding = POOL_ARRAY(pool, struct numerical_finding, 2);
    if (!out->step || !out->numerical_finding)
        return ROTID_ERROR_MEMORY;
    int status = run(&engine, job, &last);
    round_free(&last);
    if (engine.fit != out->base.fit)
        rotid_fit_free(engine.fit);
    if (status == ROTID_STOP_CANCELLED) {
        out->interrupted = 1;
        return ROTID_OK;
    }
    if (status)
        diagnose_free(out);
    return status;
}

void diagnose_free(struct diagnosis *out)
{
    rotid_fit_free(out->today.fit);
    rotid_fit_free(out->base.fit);
    rotid_fit_free(out->extended.fit);
    out->today.fit = out->base.fit = out->extended.fit = NULL;
}
