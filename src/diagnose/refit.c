#include "diagnose/refit.h"

#include <math.h>
#include <string.h>

#include "diagnose/as_solid.h"
#include "diagnose/widen.h"
#include "fit/bounds.h"

#define STARTS     3    /* places a candidate is fitted from */
#define APART      0.06 /* of the rotor's length: nearer ones lead to the same minimum */
#define SAME_PLACE 0.03 /* of the rotor's length */
#define OFF        0.02 /* of the distance between the bounds: the bijection is flat at them */
#define WIDER      10.0

static double inside(const rotid_parameter *bounds, double value)
{
    double margin = OFF * (bounds->upper - bounds->lower);
    return fmin(fmax(value, bounds->lower + margin), bounds->upper - margin);
}

static void set_start(rotid_parameter *bounds, double value)
{
    int open = value > bounds->lower && value < bounds->upper && !bounds_pressed(bounds, value);
    bounds->start = open ? value : inside(bounds, value);
    if (bounds->start == 0) /* its size is the scale of the parameter */
        bounds->start = 1e-3 * (bounds->upper > 0 ? bounds->upper : bounds->lower);
}

int job_started_at(struct pool *pool, const struct job *job, const double *x, struct job *to)
{
    rotid_parameter *bounds = POOL_ARRAY(pool, rotid_parameter, job->unknowns.nparameter);
    if (!bounds)
        return ROTID_ERROR_MEMORY;
    for (int p = 0; p < job->unknowns.nparameter; p++) {
        bounds[p] = job->unknowns.bounds[p];
        set_start(&bounds[p], x[p]);
    }
    *to = *job;
    to->unknowns.bounds = bounds;
    return ROTID_OK;
}

int job_with_effect(struct pool *pool, const struct job *from, const double *x, const struct effect *effect,
                    const struct cause_kind *cause, const int *fixed, struct job *to)
{
    const struct job copy = *from, *job = &copy; /* `to` may be the same */
    const struct rotor *rotor = &job->rotor;
    int nown = job->unknowns.nparameter, nnew = cause_parameters(effect), index = rotor->neffect;
    if (cause->solid) {
        int status = job_as_solid(pool, job, to);
        return status || !x ? status : job_started_at(pool, to, x, to);
    }
    *to = *job;
    to->rotor.effect = POOL_ARRAY(pool, struct effect, index + 1);
    to->unknowns.parameter = POOL_ARRAY(pool, struct parameter, nown + nnew);
    to->unknowns.bounds = POOL_ARRAY(pool, rotid_parameter, nown + nnew);
    if (!to->rotor.effect || !to->unknowns.parameter || !to->unknowns.bounds)
        return ROTID_ERROR_MEMORY;
    if (index)
        memcpy(to->rotor.effect, rotor->effect, (size_t)index * sizeof *effect);
    to->rotor.effect[to->rotor.neffect++] = *effect;
    for (int p = 0; p < nown; p++) {
        to->unknowns.parameter[p] = job->unknowns.parameter[p];
        to->unknowns.bounds[p] = job->unknowns.bounds[p];
        if (x)
            set_start(&to->unknowns.bounds[p], x[p]);
    }
    for (int p = 0; p < nnew; p++) {
        if (fixed && fixed[p])
            continue;
        rotid_parameter *bounds = &to->unknowns.bounds[to->unknowns.nparameter];
        *bounds = (rotid_parameter){.unit = effect->kind->parameter[p].unit};
        bounds->name = pool_format(pool, "%s.%s", effect->name, effect->kind->parameter[p].name);
        if (!bounds->name)
            return ROTID_ERROR_MEMORY;
        cause_bounds(cause, rotor, effect, p, &bounds->lower, &bounds->upper);
        set_start(bounds, inside(bounds, effect->value[p]));
        to->unknowns.parameter[to->unknowns.nparameter++] =
            (struct parameter){.kind = PARAMETER_EFFECT, .index = index, .component = p};
    }
    return ROTID_OK;
}

void effect_at(const struct job *job, int effect, const double *x, struct effect *out)
{
    *out = job->rotor.effect[effect];
    for (int p = 0; p < job->unknowns.nparameter; p++)
        if (job->unknowns.parameter[p].kind == PARAMETER_EFFECT && job->unknowns.parameter[p].index == effect)
            out->value[job->unknowns.parameter[p].component] = x[p];
}

int refit_job(struct pool *pool, const struct job *job, const int *number, const int *holdout,
              const rotid_environment *environment, rotid_fit_result **fit)
{
    rotid_fit_options options = job->options.fit;
    const rotid_environment quiet = {.size = sizeof quiet,
                                     .cancelled = environment ? environment->cancelled : NULL,
                                     .context = environment ? environment->context : NULL,
                                     .allocator = environment ? environment->allocator : NULL};
    options.baseline = 0;
    options.max_iterations = 40;
    options.gradient_tolerance = REFIT_GRADIENT;
    options.step_tolerance = REFIT_STEP;
    options.decrease_tolerance = REFIT_DECREASE;
    struct pool scratch; /* the model of a fit is not needed behind it */
    pool_open(&scratch, pool->allocator);
    int status = identify_fit(&scratch, job, number, holdout, &options, &quiet, NULL, fit);
    pool_close(&scratch);
    if (!status && (*fit)->status == ROTID_STOP_CANCELLED) {
        rotid_fit_free(*fit);
        *fit = NULL;
        return ROTID_STOP_CANCELLED;
    }
    return status;
}

/* The items to start from: best first, each a distance away from those before. */
static int choose_starts(const struct scan *scan, const struct scan_candidate *c, double length, int *start)
{
    int count = 0, place = c->cause->place;
    while (count < STARTS) {
        int best = -1;
        for (int i = c->first; i < c->first + c->count; i++) {
            const struct scan_item *item = &scan->item[i];
            int near = 0;
            for (int s = 0; s < count && place >= 0; s++)
                near |= fabs(scan->item[start[s]].effect.value[place] - item->effect.value[place]) < APART * length;
            if (item->usable && !near && (!count || place >= 0) && (best < 0 || item->drop > scan->item[best].drop))
                best = i;
        }
        if (best < 0 || (count && scan->item[best].drop < 0.3 * scan->item[start[0]].drop))
            break;
        start[count++] = best;
    }
    return count;
}

static struct effect effect_of_item(const struct scan *scan, int item, double amplitude)
{
    const struct scan_item *i = &scan->item[item];
    const struct scan_candidate *c = &scan->candidate[i->candidate];
    struct effect effect = i->effect;
    if (!c->fixed[c->cause->size])
        effect.value[c->cause->size] += amplitude * i->unit;
    return effect;
}

/* The effects to start from; a solid and a pair have but one. */
static int starting_effects(const struct scan *scan, const struct scan_set *set, double length, struct effect effect[][2])
{
    const struct scan_candidate *c = &scan->candidate[set->candidate[0]];
    int item[STARTS], count = set->count > 1 ? 0 : choose_starts(scan, c, length, item);
    for (int s = 0; s < count; s++)
        effect[s][0] = effect_of_item(scan, item[s], scan->item[item[s]].amplitude);
    if (c->cause->solid)
        effect[count++][0] = c->effect;
    if (set->count > 1) {
        for (int m = 0; m < 2; m++)
            effect[0][m] = effect_of_item(scan, set->item[m], set->amplitude[m]);
        count = 1;
    }
    return count;
}

/* Another minimum at another place that is nearly as good means that the place is not known. */
static void note_place(const struct job *extended, const struct cause_kind *cause, const rotid_fit_result *fit,
                       struct refit *refit)
{
    struct effect here;
    int last = extended->rotor.neffect - 1, place = cause->place, width = cause->width;
    if (place < 0)
        return;
    effect_at(extended, last, fit->x, &here);
    double near = fmax(SAME_PLACE * rotor_length(&extended->rotor), width < 0 ? 0 : here.value[width]);
    if (!refit->fit)
        return;
    double there = refit->job.rotor.effect[last].value[place];
    if (fabs(here.value[place] - there) <= near)
        return;
    int better = fit->chi2 < refit->chi2; /* the one before becomes the other one */
    double chi2 = better ? refit->chi2 : fit->chi2;
    if (!(refit->other_chi2 <= chi2)) {
        refit->other_chi2 = chi2;
        refit->other_place = better ? there : here.value[place];
    }
}

int fit_at_bound(const rotid_fit_result *fit, int nown)
{
    int any = 0;
    for (int p = 0; p < nown; p++)
        any |= fit->at_bound[p];
    return any;
}

int refit_again(struct pool *pool, const struct job *job, int nown, const double *own, const int *number, const int *holdout,
                const rotid_environment *environment, rotid_fit_result **fit)
{
    struct job other = *job;
    rotid_fit_result *second = NULL;
    other.unknowns.bounds = POOL_ARRAY(pool, rotid_parameter, job->unknowns.nparameter);
    if (!other.unknowns.bounds)
        return ROTID_ERROR_MEMORY;
    for (int p = 0; p < job->unknowns.nparameter; p++) {
        other.unknowns.bounds[p] = job->unknowns.bounds[p];
        if (p < nown)
            set_start(&other.unknowns.bounds[p], own[p]);
    }
    int status = refit_job(pool, &other, number, holdout, environment, &second);
    if (status == ROTID_ERROR_MEMORY || status == ROTID_STOP_CANCELLED)
        return status;
    int better = !status && second->chi2 < (*fit)->chi2;
    rotid_fit_free(better ? *fit : second);
    *fit = better ? second : *fit;
    return ROTID_OK;
}

int refit_beyond(struct pool *pool, const struct job *job, int nown, const rotid_fit_result *fit, const int *number,
                 const int *holdout, const rotid_environment *environment, double *drop)
{
    struct job wider;
    rotid_fit_result *beyond = NULL;
    int widened = 0, status = job_started_at(pool, job, fit->x, &wider);
    *drop = 0;
    for (int p = 0; p < nown && !status; p++) {
        rotid_parameter *bounds = &wider.unknowns.bounds[p];
        if (!fit->at_bound[p] || job->unknowns.parameter[p].kind == PARAMETER_NU) /* whose bounds are physical */
            continue;
        if (fit->x[p] - bounds->lower < bounds->upper - fit->x[p])
            bounds->lower = bounds->lower > 0 ? bounds->lower / WIDER : bounds->lower * WIDER;
        else
            bounds->upper = bounds->upper > 0 ? bounds->upper * WIDER : bounds->upper / WIDER;
        bounds->start = fit->x[p];
        widened = 1;
    }
    if (status || !widened)
        return status;
    status = refit_job(pool, &wider, number, holdout, environment, &beyond);
    if (status == ROTID_ERROR_MEMORY || status == ROTID_STOP_CANCELLED)
        return status;
    if (!status)
        *drop = fmax(0, fit->chi2 - beyond->chi2);
    rotid_fit_free(beyond);
    return ROTID_OK;
}

int refit_keep(struct pool *pool, const struct job *job, rotid_fit_result *fit, struct refit *refit)
{
    struct job started;
    int status = job_started_at(pool, job, fit->x, &started);
    if (status) {
        rotid_fit_free(fit);
        return status;
    }
    for (int e = 0; e < started.rotor.neffect; e++)
        effect_at(job, e, fit->x, &started.rotor.effect[e]);
    rotid_fit_free(refit->fit);
    refit->job = started;
    refit->fit = fit;
    refit->chi2 = fit->chi2;
    return ROTID_OK;
}

/* The job with the causes of a set from `effect`. */
static int job_with_set(struct pool *pool, const struct job *job, const double *x, const struct scan *scan,
                        const struct scan_set *set, const struct effect *effect, struct job *to)
{
    int status = ROTID_OK;
    for (int m = 0; m < set->count && !status; m++) {
        const struct scan_candidate *c = &scan->candidate[set->candidate[m]];
        struct effect named = effect[m];
        if (m && !(named.name = c->suspect ? named.name : scan_free_name(pool, &to->rotor, c->cause->id)))
            return ROTID_ERROR_MEMORY;
        status = job_with_effect(pool, m ? to : job, m ? NULL : x, &named, c->cause, c->fixed, to);
    }
    return status;
}

/* Fits from the scan's places with the job's own parameters at x; the best is kept. Statuses of memory and cancellation only. */
static int fit_from(struct pool *pool, const struct job *job, const int *number, const int *holdout, const double *x,
                    const struct scan *scan, const struct scan_set *set, const rotid_environment *environment,
                    struct refit *refit)
{
    struct effect start[STARTS][2];
    int count = starting_effects(scan, set, rotor_length(&job->rotor), start);
    for (int s = 0; s < count; s++) {
        struct job extended;
        rotid_fit_result *fit = NULL;
        int status = job_with_set(pool, job, x, scan, set, start[s], &extended);
        if (!status)
            status = refit_job(pool, &extended, number, holdout, environment, &fit);
        if (status == ROTID_ERROR_MEMORY || status == ROTID_STOP_CANCELLED)
            return status;
        if (!status && set->count == 1)
            note_place(&extended, scan->candidate[set->candidate[0]].cause, fit, refit);
        if (status || !(fit->chi2 < refit->chi2)) {
            rotid_fit_free(fit);
            continue;
        }
        status = refit_keep(pool, &extended, fit, refit);
        if (status)
            return status;
    }
    return ROTID_OK;
}

int refit_set(struct pool *pool, const struct job *job, const int *number, const int *holdout, const double *x,
              const double *deck, const struct scan *scan, const struct scan_set *set, const rotid_environment *environment,
              struct refit *refit)
{
    int nested =
        1; /* without its causes it is the model that the scan looked at, unless a user has fixed a size, or there is none */
    for (int m = 0; m < set->count; m++) {
        const struct scan_candidate *c = &scan->candidate[set->candidate[m]];
        nested &= c->cause->effect->nparameter && !c->fixed[c->cause->size];
    }
    *refit = (struct refit){.chi2 = INFINITY, .other_chi2 = NAN, .other_place = NAN};
    int status = fit_from(pool, job, number, holdout, x, scan, set, environment, refit);
    if (!status && deck &&
        (!refit->fit || refit->chi2 > scan->chi2 + REFIT_WORSE || fit_at_bound(refit->fit, job->unknowns.nparameter)))
        status = fit_from(pool, job, number, holdout, deck, scan, set, environment, refit);
    if (!status)
        status = refit_widen(pool, scan, set, number, holdout, environment, refit);
    if (status || !nested || !refit->fit || refit->chi2 <= scan->chi2 + REFIT_WORSE)
        return status;
    rotid_fit_free(refit->fit);
    *refit = (struct refit){.chi2 = INFINITY, .other_chi2 = NAN, .other_place = NAN};
    return ROTID_OK;
}
