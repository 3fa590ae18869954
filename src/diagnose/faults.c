/* Which channels are faulty, whatever the physics is. */
#include "diagnose/faults.h"

#include <math.h>
#include <string.h>

#include "base/text.h"
#include "diagnose/causes/catalogue.h"
#include "diagnose/correct.h"
#include "diagnose/data.h"
#include "diagnose/decide.h"
#include "diagnose/fault_text.h"
#include "diagnose/line_check.h"
#include "diagnose/sensor_check.h"
#include "fit/quantile.h"
#include "model/deflection.h"

#define MOST_FAULTS   8
#define MOST_RIVALS   4 /* refits beside which the channels are looked at */
#define FALSE_ALARM   0.005
#define LEAST_SHIFT   5e-4                    /* m: nobody glues a sensor more closely than that */
#define FAULT_PENALTY (2 * PARAMETER_PENALTY) /* which sensor, and its value or its partner */

struct rival { /* an explanation of the data */
    const struct job *stated;
    const rotid_fit_result *fit; /* of that job */
    rotid_fit_result *right;     /* with the faults put right, NULL where there is none */
    double score;                /* with the faults put right */
    double chi2, chi2_frequency;
    int dof, nfault;
    struct sensor_fault fault[MOST_FAULTS]; /* indices of sensors are those of the data as they are judged */
    int has_line;                           /* all positions are put right, before single channels */
    struct line_fault line;
};

/* Shapes of the fitted model on the nodes of the axis, each times its best scale to the measured one. What is fitted of a solid
 * is the measured shape less what the coarse mesh misses, so channels that read the same differ there: `read` is as it was
 * measured. */
static int shape_data(struct pool *pool, const struct job *job, const struct columns *columns, struct shape_data *data)
{
    const struct rotor_model *model = &columns->model;
    const struct prediction *p = &columns->functional.prediction;
    int nsensor = job->rotor.nsensor, nmode = columns->nmode;
    double *z = POOL_ARRAY(pool, double, nsensor), *shape = POOL_ARRAY(pool, double, (size_t)nsensor *(size_t)nmode),
           *std = POOL_ARRAY(pool, double, (size_t)nsensor *(size_t)nmode),
           *read = POOL_ARRAY(pool, double, (size_t)nsensor *(size_t)nmode),
           *axis = POOL_ARRAY(pool, double, (size_t)model->naxis *(size_t)nmode);
    if (!z || !shape || !std || !read || !axis)
        return ROTID_ERROR_MEMORY;
    for (int s = 0; s < nsensor; s++)
        z[s] = job->rotor.sensor[s].position;
    for (int m = 0; m < nmode; m++) {
        const struct columns_mode *mode = &columns->mode[m];
        ptrdiff_t from = (ptrdiff_t)mode->k * nsensor, to = (ptrdiff_t)m * nsensor;
        memcpy(shape + to, columns->functional.shape + from, (size_t)nsensor * sizeof *shape);
        memcpy(std + to, job->measurement.shape_std + from, (size_t)nsensor * sizeof *std);
        memcpy(read + to, job->measurement.shape + from, (size_t)nsensor * sizeof *read);
        for (int i = 0; i < model->naxis; i++)
            axis[i + (ptrdiff_t)m * model->naxis] =
                mode->scale * model_deflection(model, i, p->phi + (ptrdiff_t)mode->pair * p->size);
    }
    *data = (struct shape_data){nsensor, nmode, z, shape, std, read, model->naxis, model->z, axis};
    return ROTID_OK;
}

/* Puts a fault right in the data of a job. id [nsensor]: of the sensors when the fault was found, since a moved sensor changes
 * their order. */
static int put_right(struct pool *pool, const struct sensor_fault *fault, const int *id, struct job *job)
{
    struct correction correction;
    if (fault->kind != FAULT_DEAD) {
        correction = fault_correction(fault, id);
        return correction_apply(pool, job, &correction);
    }
    for (int s = 0; s < job->rotor.nsensor; s++) /* as if it had not been there */
        for (int k = 0; k < job->measurement.nmode && job->rotor.sensor[s].id == id[fault->sensor]; k++)
            job->measurement.shape[s + (ptrdiff_t)k * job->rotor.nsensor] = NAN;
    return ROTID_OK;
}

/* A copy of the job with all positions put right, where the rival says so, and the numbers of the modes by the shapes as they
 * stand then. */
static int put_line_right(struct engine *engine, const struct rival *rival, const double *x, struct job *job, int **number)
{
    struct spectrum spectrum;
    struct comparison compared;
    struct message_list quiet;
    *job = *rival->stated;
    *number = engine->number;
    int status = data_copy(engine->pool, job);
    if (status || !rival->has_line)
        return status;
    const struct correction correction = line_correction(&rival->line.line);
    status = correction_apply(engine->pool, job, &correction);
    message_open(&quiet, engine->pool);
    if (!status)
        status = spectrum_compute_parts(engine->pool, job->models, &job->rotor, job->unknowns.nparameter, job->unknowns.parameter,
                                        x, ROTID_GUYAN, comparison_candidates(job), SPECTRUM_REDUCED, &spectrum);
    if (!status && !comparison_make(engine->pool, job, &spectrum, &quiet, &compared))
        *number = compared.number;
    return status;
}

/* The line that the shapes as they stand show beside the model of a rival at x. */
static int look_for_line(struct engine *engine, const double *x, const int *number, struct rival *rival)
{
    const struct job *job = rival->stated;
    struct columns columns;
    struct shape_data data;
    for (int i = 0; i < job->measurement.ncorrection; i++) { /* once: what is left is not of the positions */
        const struct correction *c = &job->measurement.correction[i];
        if (same_text(c->id, "sensor_line") && (c->value != 0 || c->more[0] != 1))
            return ROTID_OK;
    }
    int status = columns_open(engine->pool, job, number, engine->holdout, NULL, x, &columns);
    if (!status)
        status = shape_data(engine->pool, job, &columns, &data);
    return status ? status : line_check(engine->pool, &data, rotor_length(&job->rotor), &rival->line, &rival->has_line);
}

/* The faults of channels that show beside the model of a rival at x. */
static int look(struct engine *engine, const double *x, const int *id, struct rival *rival)
{
    struct columns columns;
    struct shape_data data;
    struct job job;
    int found = 0, *number, status = put_line_right(engine, rival, x, &job, &number);
    if (!status)
        status = columns_open(engine->pool, &job, number, engine->holdout, NULL, x, &columns);
    if (!status)
        status = shape_data(engine->pool, &job, &columns, &data);
    if (!status)
        status = sensor_check(engine->pool, &data, FALSE_ALARM, MOST_FAULTS, rival->fault, &found);
    rival->nfault = 0;
    for (int i = 0; i < found && !status; i++) {
        struct sensor_fault fault = rival->fault[i];
        if (fault.kind == FAULT_POSITION && fabs(fault.value) < LEAST_SHIFT)
            continue;
        for (int s = engine->job->rotor.nsensor - 1, one = fault.sensor, two = fault.other; s >= 0; s--) {
            fault.sensor = id[s] == job.rotor.sensor[one].id ? s : fault.sensor;
            fault.other = two >= 0 && id[s] == job.rotor.sensor[two].id ? s : fault.other;
        }
        rival->fault[rival->nfault++] = fault;
    }
    return status;
}

/* The fit of a rival with its faults put right; NULL where there is none. */
static int fit_right(struct engine *engine, const int *id, const struct rival *rival, rotid_fit_result **fit)
{
    struct job job;
    int *number, status = put_line_right(engine, rival, rival->fit->x, &job, &number);
    for (int i = 0; i < rival->nfault && !status; i++)
        status = put_right(engine->pool, &rival->fault[i], id, &job);
    if (!status)
        status = refit_job(engine->pool, &job, number, engine->holdout, engine->environment, fit);
    return status == ROTID_ERROR_MEMORY || status == ROTID_STOP_CANCELLED ? status : ROTID_OK;
}

/* The score of a rival with its faults put right. Components that a fault takes away count as what they would leave. */
static int weigh(struct engine *engine, const int *id, struct rival *rival)
{
    const rotid_fit_result *best = rival->fit;
    int nfrequency = 0, status = ROTID_OK;
    rotid_fit_free(rival->right);
    rival->right = NULL;
    rival->score = INFINITY;
    if (rival->nfault || rival->has_line) {
        status = fit_right(engine, id, rival, &rival->right);
        best = rival->right;
    }
    if (status || !best)
        return status;
    for (int k = 0; k < engine->job->measurement.nmode; k++)
        nfrequency += !engine->holdout[k];
    rival->dof = best->dof;
    rival->chi2 = best->chi2 + (rival->fit->nresidual - best->nresidual);
    rival->chi2_frequency = 0;
    for (int i = 0; i < nfrequency; i++)
        rival->chi2_frequency += best->r[i] * best->r[i];
    rival->score = rival->chi2 + PARAMETER_PENALTY * (best->n - engine->job->unknowns.nparameter) + FAULT_PENALTY * rival->nfault;
    rival->score += rival->has_line ? PARAMETER_PENALTY * line_parameters(&rival->line.line) : 0;
    return ROTID_OK;
}

/* The faults have spoilt the fit beside which they were found: once more beside the one without them. */
static int look_again(struct engine *engine, const int *id, struct rival *rival)
{
    struct job job;
    int *number, status = ROTID_OK;
    if (!rival->right)
        return ROTID_OK;
    if (rival->has_line) {
        status = put_line_right(engine, rival, rival->right->x, &job, &number);
        if (!status)
            status = look_for_line(engine, rival->right->x, number, rival);
    }
    if (!status)
        status = look(engine, rival->right->x, id, rival);
    return status ? status : weigh(engine, id, rival);
}

/* The highest score within the margin of a name; where nothing explains the data, every rival has a say: what the model lacks
 * then looks like faults beside one model, and otherwise beside the next. */
static double find_limit(int count, const struct rival *rival, int *best)
{
    *best = 0;
    for (int i = 1; i < count; i++)
        *best = rival[i].score < rival[*best].score ? i : *best;
    const struct rival *r = &rival[*best];
    return chi_square_tail(r->chi2, r->dof) < 0.01 ? (double)INFINITY : r->score + LEAST_MARGIN;
}

static int same(const struct sensor_fault *a, const struct sensor_fault *b)
{
    return a->kind == b->kind &&
           ((a->sensor == b->sensor && a->other == b->other) || (a->sensor == b->other && a->other == b->sensor));
}

static int has(const struct rival *rival, const struct sensor_fault *fault)
{
    int found = 0;
    for (int i = 0; i < rival->nfault; i++)
        found |= same(&rival->fault[i], fault);
    return found;
}

/* The refits to ask, best first, behind the model without a cause. */
static int choose(const struct engine *engine, const struct round_result *result, struct rival *rival)
{
    int count = 1, taken[MOST_RIVALS];
    rival[0] = (struct rival){.stated = engine->job, .fit = engine->fit};
    while (count <= MOST_RIVALS) {
        int best = -1;
        for (int i = 0; i < result->nrefit; i++) {
            int used = !result->refit[i].fit;
            for (int j = 0; j + 1 < count; j++)
                used |= taken[j] == i;
            if (!used && (best < 0 || result->refit[i].chi2 < result->refit[best].chi2))
                best = i;
        }
        if (best < 0)
            break;
        taken[count - 1] = best;
        rival[count++] = (struct rival){.stated = &result->refit[best].states.state->job, .fit = result->refit[best].fit};
    }
    return count;
}

/* Takes a fault out of the judged data. */
static int correct(struct engine *engine, const struct sensor_fault *fault, const int *id)
{
    rotid_data_finding finding;
    int status = fault_finding(engine->pool, fault, id, &finding);
    if (status)
        return status;
    if (fault->kind == FAULT_DEAD) {
        status = put_right(engine->pool, fault, id, engine->job);
        return status ? status : data_add_finding(engine, &finding);
    }
    const struct correction correction = fault_correction(fault, id);
    return data_correct(engine, &finding, &correction);
}

/* A fault that no more than the margin separates from a physical cause stays open with it, among the candidates of the round. */
static int keep_open(struct engine *engine, const struct rival *base, const int *id, struct round_result *result)
{
    rotid_data_finding finding;
    int status = base->has_line ? line_finding(engine->pool, &base->line, &finding)
                                : fault_finding(engine->pool, &base->fault[0], id, &finding),
        line = base->has_line ? line_parameters(&base->line.line) : 0;
    result->fault = POOL_NEW(engine->pool, struct candidate);
    if (status || !result->fault)
        return ROTID_ERROR_MEMORY;
    *result->fault = candidate_blank(catalogue_find(finding.id), fault_target(engine->pool, &finding));
    result->fault->nparameter = 2 * base->nfault + line;
    for (int p = 0; p < 3; p++)
        result->fault->effect.value[p] = base->has_line ? finding.parameters[p].value : finding.value;
    result->fault->result.refitted = 1;
    result->fault->result.chi2 = base->chi2;
    result->fault->result.chi2_drop = result->fault->result.predicted_drop = engine->fit->chi2 - base->chi2;
    result->fault->result.chi2_frequency = base->chi2_frequency;
    result->fault->result.bic = base->chi2 + log(result->scan.nrow) * (engine->fit->n + base->nfault + line);
    return result->fault->target ? ROTID_OK : ROTID_ERROR_MEMORY;
}

/* Each rival once more with the line that it finds, in the place of the channels, behind the others. */
static void add_lines(int *count, struct rival *rival)
{
    for (int i = 0, stated = *count; i < stated; i++) {
        if (!rival[i].has_line)
            continue;
        rival[*count] = rival[i];
        rival[(*count)++].nfault = 0;
        rival[i].has_line = 0;
    }
}

/* Beside one model the line and single channels explain the same shapes: the line stays where it leads by the margin of a name,
 * else it goes. */
static void choose_line(int stated, int *count, struct rival *rival)
{
    int kept = stated;
    for (int j = stated; j < *count; j++) {
        int own = 0;
        while (own < stated && rival[own].fit != rival[j].fit)
            own++;
        if (own < stated && rival[j].score + LEAST_MARGIN < rival[own].score) {
            rotid_fit_free(rival[own].right);
            rival[own] = rival[j];
        } else {
            rotid_fit_free(rival[j].right);
        }
        rival[j].right = NULL;
    }
    *count = kept;
}

/* Takes the line out where it leaves a model that explains the data, and every rival within the margin of a name has it. Beside a
 * model that is grossly wrong a shift or another scale of all positions lowers chi2, too. *changed then. */
static int settle_line(struct engine *engine, int count, const struct rival *rival, int best, int *changed)
{
    rotid_data_finding finding;
    double limit = rival[best].score + LEAST_MARGIN;
    if (chi_square_tail(rival[best].chi2, rival[best].dof) < 0.01)
        return ROTID_OK;
    for (int i = 0; i < count; i++)
        if (rival[i].score <= limit && !(rival[i].has_line && rival[i].line.line.flip == rival[best].line.line.flip))
            return ROTID_OK;
    const struct correction correction = line_correction(&rival[best].line.line);
    int status = line_finding(engine->pool, &rival[best].line, &finding);
    *changed = 1;
    return status ? status : data_correct(engine, &finding, &correction);
}

static int settle(struct engine *engine, int count, struct rival *rival, struct round_result *result, int *changed)
{
    int best, any = 0, stated = count, status = ROTID_OK, nsensor = engine->job->rotor.nsensor;
    int *id = POOL_ARRAY(engine->pool, int, nsensor);
    if (!id)
        return ROTID_ERROR_MEMORY;
    for (int s = 0; s < nsensor; s++)
        id[s] = engine->job->rotor.sensor[s].id;
    for (int i = 0; i < count && !status; i++) {
        status = look(engine, rival[i].fit->x, id, &rival[i]);
        if (!status)
            status = look_for_line(engine, rival[i].fit->x, engine->number, &rival[i]);
        any |= rival[i].nfault || rival[i].has_line;
    }
    if (status || !any)
        return status;
    add_lines(&count, rival);
    for (int i = 0; i < count && !status; i++)
        status = weigh(engine, id, &rival[i]);
    for (int i = stated; i < count && !status; i++)
        status = look_again(engine, id, &rival[i]);
    choose_line(stated, &count, rival);
    if (status)
        return status;
    double limit = find_limit(count, rival, &best);
    for (int i = 0; i < count && !status; i++)
        if (rival[i].score <= limit)
            status = look_again(engine, id, &rival[i]);
    limit = find_limit(count, rival, &best);
    if (!status && rival[best].has_line)
        status = settle_line(engine, count, rival, best, changed);
    for (int f = 0; f < rival[best].nfault && !status && !*changed; f++) {
        int all = 1;
        for (int i = 0; i < count; i++)
            all &= rival[i].score > limit || has(&rival[i], &rival[best].fault[f]);
        if (all) {
            status = correct(engine, &rival[best].fault[f], id);
            rival[best].fault[f].sensor = -1; /* put right */
        }
    }
    for (int f = 0; f < rival[best].nfault; f++)
        *changed |= rival[best].fault[f].sensor < 0;
    if (!status && !*changed && (rival[0].nfault || (rival[0].has_line && isfinite(limit))) && rival[0].score <= limit)
        status = keep_open(engine, &rival[0], id, result);
    return status;
}

int faults_settle(struct engine *engine, struct round_result *result, int *changed)
{
    struct rival rival[2 * (MOST_RIVALS + 1)] = {0};
    *changed = 0;
    if (!job_fits_shapes(engine->job))
        return ROTID_OK;
    int count = choose(engine, result, rival), status = settle(engine, count, rival, result, changed);
    for (int i = 0; i < 2 * (MOST_RIVALS + 1); i++)
        rotid_fit_free(rival[i].right);
    return status;
}
