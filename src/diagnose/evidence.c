/* The candidates of the search: what each fit says about its cause, and how well it predicts what was left out. */
#include "diagnose/diagnose.h"
#include "fit/fit.h"

#define AT_BOUND 0.005 /* of the physical range */
#define SHOWN    0.05  /* of the best promise: candidates not fitted but worth a line */

/* Whether x lies so near a bound that it is not the size the data want. A bound at which the effect vanishes (neutral) is none: a
 * small size lies near it. Between bounds above zero sizes are factors, and a distance is a ratio. */
static int size_at_bound(const rotid_parameter *bounds, double neutral, double x)
{
    double lower = bounds->lower, upper = bounds->upper;
    if (lower > 0 && neutral > 0 && x > 0) {
        lower = log(lower);
        upper = log(upper);
        neutral = log(neutral);
        x = log(x);
    }
    double near = AT_BOUND * (upper - lower);
    return (x < lower + near && fabs(lower - neutral) > near) || (x > upper - near && fabs(upper - neutral) > near);
}

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
 * that neither the fit nor a profile gives an interval for, being at an end or where the modes are symmetric, has that of the
 * scan: wherever the promised drop is within 3.84 of the best. s: its candidate of the scan. */
static void mend_intervals(const struct scan *scan, const struct scan_candidate *s, struct candidate *c)
{
    const struct cause_kind *cause = c->cause;
    int place = cause->place, width = cause->width;
    if (width >= 0 && !c->fixed[width] && !isfinite(c->std[width]))
        c->std[cause->size] = c->ci_lower[cause->size] = c->ci_upper[cause->size] = NAN;
    if (place < 0 || c->fixed[place] || isfinite(c->ci_lower[place]) || s->best < 0)
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
    c.nparameter = effect_parameters(&s->effect);
    memcpy(c.fixed, s->fixed, sizeof c.fixed);
    return c;
}

/* The candidate, and where the scan sees it. */
static struct candidate scanned(const struct scan *scan, int index)
{
    const struct scan_candidate *s = &scan->candidate[index];
    struct candidate c = candidate_listed(scan, index);
    c.result.predicted_drop = scan_best_drop(scan, index);
    if (s->best >= 0)
        c.effect = scan_effect(scan, s->best, scan->item[s->best].amplitude);
    return c;
}

/* Candidate `index` by the explanation of it alone. */
static int fill_candidate(struct engine *engine, const struct scan *scan, int index, const struct explanation *e,
                          struct candidate *c)
{
    double unused, shape;
    *c = e->member[0];
    c->result.predicted_drop = scan_best_drop(scan, index);
    c->result.chi2_frequency = frequency_chi2(scan, e->refit->fit);
    mend_intervals(scan, &scan->candidate[index], c);
    fitted_errors(&e->refit->states, engine->holdout, e->refit->fit, 1, &c->result.holdout_rms, &unused, &shape);
    return sensor_out(engine->pool, &e->refit->states, engine->holdout, e->refit->fit, &c->result.sensor_out_rms, &shape);
}

struct leave_out {
    const struct engine *engine;
    const struct states *states;
    const rotid_fit_result *fit;
    double *error, *shape; /* [nmode] of all states */
};

static int leave_out_task(void *context, int k, int worker)
{
    struct leave_out *out = context;
    const struct engine *e = out->engine;
    (void)worker;
    return e->holdout[k] ? ROTID_OK
                         : mode_out_fit(out->states, out->fit, e->number, e->holdout, k, e->environment, e->pool->allocator,
                                        &out->error[k], &out->shape[k]);
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

int modes_in_turn(const struct engine *engine, const struct states *states, const rotid_fit_result *fit, double *error,
                  double *shape)
{
    int nmode = states_modes(&engine->states, engine->states.nstate);
    struct leave_out out = {engine, states, fit, pool_unknown(engine->pool, (size_t)nmode),
                            pool_unknown(engine->pool, (size_t)nmode)};
    if (!out.error || !out.shape)
        return ROTID_ERROR_MEMORY;
    int status = parallel_for(engine->threads, nmode, leave_out_task, &out);
    *error = status ? (double)NAN : rms(nmode, out.error);
    *shape = status ? (double)NAN : rms(nmode, out.shape);
    return status;
}

static int compare(const void *left, const void *right)
{
    const rotid_candidate *a = &((const struct candidate *)left)->result, *b = &((const struct candidate *)right)->result;
    if (a->probability != b->probability)
        return a->probability < b->probability ? 1 : -1;
    if (a->refitted != b->refitted)
        return b->refitted - a->refitted;
    double one = isfinite(a->chi2) ? a->chi2 : INFINITY, two = isfinite(b->chi2) ? b->chi2 : INFINITY;
    return (one > two) - (one < two) +
           ((one == two) ? (a->predicted_drop < b->predicted_drop) - (a->predicted_drop > b->predicted_drop) : 0);
}

int evidence_collect(struct engine *engine, const struct scan *scan, const struct posterior *posterior,
                     struct diagnosis_round *round)
{
    int status = ROTID_OK;
    round->candidate = POOL_ARRAY(engine->pool, struct candidate, scan->ncandidate + 1);
    if (!round->candidate)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < scan->ncandidate && !status; i++) {
        const struct candidate listed = candidate_listed(scan, i);
        const struct explanation *alone = NULL; /* the likeliest place comes first */
        for (int k = 0; k < posterior->count && !alone; k++) {
            const struct explanation *e = &posterior->item[k];
            alone = e->nmember == 1 && e->refit && !e->something_else && posterior_same_model(&e->member[0], &listed) ? e : NULL;
        }
        if (alone)
            status = fill_candidate(engine, scan, i, alone, &round->candidate[round->ncandidate++]);
        else if (scan_best_drop(scan, i) > SHOWN * scan->largest && scan->largest > 0)
            round->candidate[round->ncandidate++] = scanned(scan, i);
    }
    for (int i = 0; i < round->ncandidate; i++) {
        round->candidate[i].result.probability = posterior_of_cause(posterior, &round->candidate[i]);
        round->candidate[i].result.round = 1;
    }
    qsort(round->candidate, (size_t)round->ncandidate, sizeof *round->candidate, compare);
    return status;
}
