/* The evidence of a round: what each fit says about its candidate, how well it predicts what was left out, who looks like whom.
 */
#include <math.h>
#include <string.h>

#include "base/base.h"
#include "diagnose/diagnose.h"
#include "fit/fit.h"

#define MOST_OUT   5    /* candidates for which modes are left out in turn */
#define OUT_MARGIN 25.0 /* of chi2 from the best one: further ones do not win whatever they predict */
#define SHOWN      0.05 /* of the best promise: candidates not fitted but worth a line */

/* The effect and its parameters, those of the fit that belong to it: effect number e of a state in which it acts. */
void candidate_values(const struct refit *refit, const struct state *state, int e, struct candidate *c)
{
    const rotid_fit_result *fit = refit->fit;
    const struct job *job = &state->job;
    if (c->cause->solid)
        return;
    c->effect = job->rotor.effect[e];
    for (int q = 0; q < job->unknowns.nparameter; q++) {
        int component = job->unknowns.parameter[q].component, p = state_unknown(state, q);
        if (job->unknowns.parameter[q].kind != PARAMETER_EFFECT || job->unknowns.parameter[q].index != e)
            continue;
        c->std[component] = fit->std[p];
        c->ci_lower[component] = fmax(fit->ci_lower[p], job->unknowns.bounds[q].lower);
        c->ci_upper[component] = fmin(fit->ci_upper[p], job->unknowns.bounds[q].upper);
        if (!isfinite(fit->std[p])) /* fmax and fmin prefer the number */
            c->ci_lower[component] = c->ci_upper[component] = NAN;
        if (component == c->cause->size)
            c->result.at_bound = size_at_bound(&job->unknowns.bounds[q], c->cause->parameter[component].neutral, fit->x[p]);
    }
}

/* Depth and width of a zone trade off: where the width ends at a bound the fit knows the depth for that width alone. And a place
 * that the fit gives no interval for, being at an end or where the modes are symmetric, has that of the scan: wherever the
 * promised drop is within 3.84 of the best. s: its
 * candidate of the scan, NULL in a pair, where the scan of one cause says nothing. */
static void mend_intervals(const struct scan *scan, const struct scan_candidate *s, struct candidate *c)
{
    const struct cause_kind *cause = c->cause;
    int place = cause->place, width = cause->width;
    if (width >= 0 && !c->fixed[width] && !isfinite(c->std[width]))
        c->std[cause->size] = c->ci_lower[cause->size] = c->ci_upper[cause->size] = NAN;
    if (!s || place < 0 || c->fixed[place] || isfinite(c->std[place]) || s->best < 0)
        return;
    double lower = INFINITY, upper = -INFINITY;
    for (int i = s->first; i < s->first + s->count; i++)
        if (scan->item[i].drop >= scan->item[s->best].drop - 3.84) {
            lower = fmin(lower, scan->item[i].effect.value[place]);
            upper = fmax(upper, scan->item[i].effect.value[place]);
        }
    c->ci_lower[place] = fmin(lower, c->effect.value[place]);
    c->ci_upper[place] = fmax(upper, c->effect.value[place]);
}

static double frequency_chi2(const struct scan *scan, const rotid_fit_result *fit)
{
    double sum = 0;
    for (int i = 0; i < scan->nrow; i++)
        sum += scan->is_frequency[i] ? fit->r[i] * fit->r[i] : 0;
    return sum;
}

int fit_explains(const struct scan *scan, const rotid_fit_result *fit)
{
    int dof = scan->dof - (fit->n - scan->nfree);
    return dof > 0 && chi_square_tail(frequency_chi2(scan, fit), scan->nfrequency) > BLOCK_LEVEL &&
           chi_square_tail(fit->chi2, dof) > BLOCK_LEVEL;
}

/* Candidate `index` of the scan as it was listed. */
struct candidate candidate_listed(const struct scan *scan, int index)
{
    const struct scan_candidate *s = &scan->candidate[index];
    struct candidate c = candidate_blank(s->cause, s->target);
    c.state = s->state;
    c.home = s->home;
    c.in = s->in;
    c.state_name = s->state_name;
    c.effect = s->effect;
    c.result.suspect = s->suspect;
    c.nparameter = cause_parameters(&s->effect);
    memcpy(c.fixed, s->fixed, sizeof c.fixed);
    return c;
}

/* The candidate, and where the scan sees it. */
static struct candidate scanned(const struct round_result *result, int index)
{
    const struct scan *scan = &result->scan;
    const struct scan_candidate *s = &scan->candidate[index];
    struct candidate c = candidate_listed(scan, index);
    c.result.predicted_drop = scan_best_drop(scan, index);
    c.result.p_value = bootstrap_p(&result->bootstrap, c.result.predicted_drop);
    if (s->best >= 0) {
        c.effect = scan->item[s->best].effect;
        if (!s->fixed[s->cause->size])
            c.effect.value[s->cause->size] += scan->item[s->best].amplitude * scan->item[s->best].unit;
    }
    return c;
}

/* The unknowns of the deck as the fit has them. */
static int take_identified(struct engine *engine, const struct refit *refit, struct candidate *c)
{
    const rotid_fit_result *fit = refit->fit;
    c->identified = POOL_ARRAY(engine->pool, rotid_cause_value, engine->nown);
    if (!c->identified)
        return ROTID_ERROR_MEMORY;
    for (int p = 0; p < engine->nown; p++) {
        const rotid_parameter *named = &refit->states.bounds[p];
        int has = isfinite(fit->std[p]);
        c->identified[c->nidentified++] = (rotid_cause_value){.name = named->name,
                                                              .unit = named->unit,
                                                              .value = fit->x[p],
                                                              .std = fit->std[p],
                                                              .ci95 = {has ? fmax(fit->ci_lower[p], named->lower) : (double)NAN,
                                                                       has ? fmin(fit->ci_upper[p], named->upper) : (double)NAN}};
    }
    return ROTID_OK;
}

/* What a moving accelerometer does to shapes is in its column of the scan and not in the model of its fit, which has its mass
 * spread over the sensors. Where the column says more it counts: as a rival, not as a name, since no model could go on with it.
 */
static void take_linear(const struct engine *engine, const struct scan *scan, const struct scan_candidate *s, struct candidate *c)
{
    const struct scan_item *item = s->best < 0 ? NULL : &scan->item[s->best];
    if (!item || s->fixed[c->cause->size] || !is_unweighed_accelerometer(&engine->states.state[s->home].job, &c->effect) ||
        !(scan->chi2 - item->drop < c->result.chi2))
        return;
    const double *column = scan->column + (ptrdiff_t)s->best * scan->nrow;
    double square = 0;
    for (int i = 0; i < scan->nrow; i++) {
        double left = scan->r[i] + item->amplitude * item->norm * column[i];
        square += scan->is_frequency[i] ? left * left : 0;
    }
    int size = c->cause->size;
    c->linear = 1;
    c->residual = NULL;
    c->effect.value[size] = item->effect.value[size] + item->amplitude * item->unit;
    c->std[size] = fabs(item->unit) / item->norm;
    c->ci_lower[size] = fmax(0, c->effect.value[size] - 1.96 * c->std[size]);
    c->ci_upper[size] = c->effect.value[size] + 1.96 * c->std[size];
    c->result.at_bound = !(item->amplitude < item->upper);
    c->result.chi2 = scan->chi2 - item->drop;
    c->result.chi2_drop = item->drop;
    c->result.chi2_frequency = square;
    c->explains = scan->dof > 1 && chi_square_tail(square, scan->nfrequency) > BLOCK_LEVEL &&
                  chi_square_tail(c->result.chi2, scan->dof - 1) > BLOCK_LEVEL;
}

/* Fit `number` of the round. No chance is stated for a pair: the bootstrap asks for the best of single columns. */
static int fill_candidate(struct engine *engine, const struct round_result *result, int number, struct candidate *c)
{
    const struct scan *scan = &result->scan;
    const struct refit *refit = &result->refit[number];
    const struct scan_set *set = &result->set[number];
    int pair = set->count > 1;
    *c = pair ? candidate_listed(scan, set->candidate[0]) : scanned(result, set->candidate[0]);
    if (pair && !(c->with = POOL_NEW(engine->pool, struct candidate)))
        return ROTID_ERROR_MEMORY;
    if (pair) {
        *c->with = candidate_listed(scan, set->candidate[1]);
        c->result.predicted_drop = set->drop;
    }
    c->result.refitted = 1;
    if (!refit->fit)
        return ROTID_OK;
    c->refit = number;
    c->other_place = refit->other_place;
    c->other_chi2 = refit->other_chi2;
    double unused, shape;
    c->result.chi2 = refit->chi2;
    c->result.chi2_drop = engine->fit->chi2 - refit->chi2;
    c->result.bic = refit->chi2 + log(scan->nrow) * refit->states.nparameter;
    c->result.p_value = pair ? NAN : bootstrap_p(&result->bootstrap, c->result.chi2_drop);
    c->result.chi2_frequency = frequency_chi2(scan, refit->fit);
    c->explains = fit_explains(scan, refit->fit);
    c->residual = refit->fit->r;
    c->nresidual = refit->fit->nresidual;
    const struct state *home = &refit->states.state[c->home];
    candidate_values(refit, home, refit_effect(scan, set, 0, c->home, &home->job.rotor), c);
    mend_intervals(scan, pair ? NULL : &scan->candidate[set->candidate[0]], c);
    if (pair) {
        home = &refit->states.state[c->with->home];
        candidate_values(refit, home, refit_effect(scan, set, 1, c->with->home, &home->job.rotor), c->with);
        mend_intervals(scan, NULL, c->with);
        c->result.at_bound |= c->with->result.at_bound;
    }
    fitted_errors(&refit->states, engine->holdout, refit->fit, 1, &c->result.holdout_rms, &unused, &shape);
    if (!pair)
        take_linear(engine, scan, &scan->candidate[set->candidate[0]], c);
    int status = c->linear ? ROTID_OK : take_identified(engine, refit, c);
    return status ? status
                  : sensor_out(engine->pool, &refit->states, engine->holdout, refit->fit, &c->result.sensor_out_rms, &shape);
}

/* Whether a pair explains the data but for what one of its causes leaves as an approximation, which is noise once it is named. */
static int explains_nearly(struct engine *engine, const struct scan *scan, const struct refit *refit, struct candidate *c)
{
    struct states states;
    rotid_fit_result *fit = NULL;
    int status = states_copy(engine->pool, &refit->states, &states);
    for (const struct candidate *member = c; member && !status; member = member->with)
        status = discrepancy_add(engine->pool, member, 1, &states);
    if (!status)
        status = refit_states(engine->pool, &states, engine->number, engine->holdout, engine->environment, &fit);
    if (status == ROTID_ERROR_MEMORY || status == ROTID_STOP_CANCELLED)
        return status;
    c->explains = !status && fit_explains(scan, fit);
    rotid_fit_free(fit);
    return ROTID_OK;
}

/* Of the pairs near the best one. */
static int judge_approximations(struct engine *engine, const struct round_result *result, struct candidate *candidate)
{
    double best = INFINITY;
    int status = ROTID_OK;
    for (int i = 0; i < result->nrefit; i++)
        if (candidate[i].with && isfinite(candidate[i].result.chi2))
            best = fmin(best, candidate_score(&candidate[i]));
    for (int i = 0; i < result->nrefit && !status; i++) {
        struct candidate *c = &candidate[i];
        if (c->with && !c->explains && candidate_score(c) < best + OUT_MARGIN &&
            (discrepancy_of(c->cause) || discrepancy_of(c->with->cause)))
            status = explains_nearly(engine, &result->scan, &result->refit[i], c);
    }
    return status;
}

struct leave_out {
    const struct engine *engine;
    const struct states *const *model; /* [models] */
    int nmode;                         /* of all states */
    double *error, *shape;             /* [nmode * models] */
};

static int leave_out_task(void *context, int index, int worker)
{
    struct leave_out *out = context;
    const struct engine *e = out->engine;
    int k = index % out->nmode;
    (void)worker;
    if (e->holdout[k])
        return ROTID_OK;
    return mode_out_fit(out->model[index / out->nmode], e->number, e->holdout, k, e->environment, e->pool->allocator,
                        &out->error[index], &out->shape[index]);
}

static double rms(int n, const double *value)
{
    double sum = 0;
    int count = 0;
    for (int i = 0; i < n; i++)
        if (isfinite(value[i])) {
            sum += value[i] * value[i];
            count++;
        }
    return count ? sqrt(sum / count) : NAN;
}

int modes_in_turn(const struct engine *engine, int models, const struct states *const *model, double *error, double *shape)
{
    int nmode = states_modes(&engine->states, engine->states.nstate);
    size_t cells = (size_t)models * (size_t)nmode;
    struct leave_out out = {engine, model, nmode, POOL_ARRAY(engine->pool, double, cells),
                            POOL_ARRAY(engine->pool, double, cells)};
    if (!out.error || !out.shape)
        return ROTID_ERROR_MEMORY;
    for (size_t i = 0; i < cells; i++)
        out.error[i] = out.shape[i] = NAN;
    int status = parallel_for(engine->threads, (int)cells, leave_out_task, &out);
    for (int m = 0; m < models && !status; m++) {
        error[m] = rms(nmode, out.error + (ptrdiff_t)m * nmode);
        shape[m] = rms(nmode, out.shape + (ptrdiff_t)m * nmode);
    }
    return status;
}

/* For the model before the round, should it not be known, and for the candidates near the best one. */
static int leave_modes_out(struct engine *engine, struct round_result *result, struct candidate *candidate)
{
    const struct states *model[MOST_OUT + 1] = {&engine->states};
    double error[MOST_OUT + 1], shape[MOST_OUT + 1], best = INFINITY;
    int who[MOST_OUT + 1], count = 1;
    for (int i = 0; i < result->nrefit; i++)
        if (isfinite(candidate[i].result.chi2))
            best = fmin(best, candidate_score(&candidate[i]));
    for (double least = -INFINITY; count <= MOST_OUT;) { /* in the order of the scores */
        int next = -1;
        for (int i = 0; i < result->nrefit; i++) {
            double score = isfinite(candidate[i].result.chi2) ? candidate_score(&candidate[i]) : INFINITY;
            if (score > least && score < best + OUT_MARGIN && (next < 0 || score < candidate_score(&candidate[next])))
                next = i;
        }
        if (next < 0)
            break;
        least = candidate_score(&candidate[next]);
        who[count] = next;
        model[count++] = &result->refit[next].states;
    }
    int status = modes_in_turn(engine, count, model, error, shape);
    if (status)
        return status;
    engine->mode_out_rms = error[0];
    engine->mode_out_shape = shape[0];
    for (int m = 1; m < count; m++)
        candidate[who[m]].result.mode_out_rms = error[m];
    return ROTID_OK;
}

/* Who looks like whom: the largest cosine of the columns at their best places. */
static void find_twins(const struct round_result *result, struct candidate *candidate)
{
    const struct scan *scan = &result->scan;
    for (int i = 0; i < result->nrefit; i++)
        for (int j = 0; j < result->nrefit; j++) {
            int a = scan->candidate[result->set[i].candidate[0]].best, b = scan->candidate[result->set[j].candidate[0]].best;
            if (i == j || a < 0 || b < 0 || result->set[i].count > 1 || result->set[j].count > 1)
                continue;
            double cosine = 0;
            for (int k = 0; k < scan->nrow; k++)
                cosine += scan->column[k + (ptrdiff_t)a * scan->nrow] * scan->column[k + (ptrdiff_t)b * scan->nrow];
            if (!(fabs(cosine) <= candidate[i].result.cosine)) {
                candidate[i].result.cosine = fmin(1, fabs(cosine));
                candidate[i].result.collinear_with = candidate[j].cause->id;
                candidate[i].result.collinear_target = candidate[j].target;
            }
        }
}

int evidence_collect(struct engine *engine, struct round_result *result, struct diagnosis_round *round)
{
    struct pool *pool = engine->pool;
    const struct scan *scan = &result->scan;
    int room = scan->ncandidate + result->nrefit + 2, status = ROTID_OK;
    double unused, shape;
    round->candidate = POOL_ARRAY(pool, struct candidate, room);
    if (!round->candidate)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < result->nrefit && !status; i++)
        status = fill_candidate(engine, result, i, &round->candidate[i]);
    if (!status)
        status = judge_approximations(engine, result, round->candidate);
    if (!status && result->nrefit)
        status = leave_modes_out(engine, result, round->candidate);
    if (status)
        return status;
    find_twins(result, round->candidate);
    round->ncandidate = result->nrefit;
    for (int i = 0; i < scan->ncandidate && !status; i++) {
        int taken = 0;
        for (int j = 0; j < result->nrefit; j++)
            taken |= result->set[j].count == 1 && result->set[j].candidate[0] == i;
        if (!taken && scan_best_drop(scan, i) > SHOWN * scan->largest && scan->largest > 0)
            round->candidate[round->ncandidate++] = scanned(result, i);
    }
    if (result->fault)
        round->candidate[round->ncandidate++] = *result->fault;
    struct before before = {.dof = scan->dof,
                            .nfrequency = scan->nfrequency,
                            .chi2 = scan->chi2,
                            .chi2_frequency = scan->chi2_frequency,
                            .mode_out_rms = engine->mode_out_rms};
    fitted_errors(&engine->states, engine->holdout, engine->fit, 1, &before.holdout_rms, &unused, &shape);
    if (!status)
        status = sensor_out(pool, &engine->states, engine->holdout, engine->fit, &before.sensor_out_rms, &shape);
    if (!status && result->nrefit)
        status = refit_beyond(pool, &engine->states, engine->nown, engine->fit, engine->number, engine->holdout,
                              engine->environment, &before.beyond_drop);
    return status ? status : decide(engine, &before, round);
}
