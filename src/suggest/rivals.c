#include "suggest/rivals.h"

#include <math.h>

#include "diagnose/decide.h"
#include "diagnose/refit.h"
#include "linalg/product.h"

#define CLEAR 2.0 /* times the threshold of the scan: the drop that a name needs, as in decide.c */

/* The candidate, with the second cause of a pair, in the job. */
static int add_causes(struct pool *pool, const struct job *base, const double *x, const struct candidate *c, struct job *to)
{
    int status = job_with_effect(pool, base, x, &c->effect, c->cause, c->fixed, to);
    if (status || !c->with)
        return status;
    struct effect second = c->with->effect;
    second.name = scan_free_name(pool, &to->rotor, c->with->cause->id);
    return second.name ? job_with_effect(pool, to, NULL, &second, c->with->cause, c->with->fixed, to) : ROTID_ERROR_MEMORY;
}

static int is_model(const struct candidate *c)
{
    return c->cause->class == CAUSE_PHYSICAL && c->cause->effect && !c->cause->solid && (!c->with || is_model(c->with));
}

/* Fits a rival; one that cannot be fitted is none. */
static int add(struct pool *pool, const struct job *base, const double *x, const struct candidate *c, const int *number,
               const int *holdout, double other_place, const rotid_environment *environment, struct rivals *rivals)
{
    struct candidate there = *c;
    struct rival *rival = &rivals->rival[rivals->n];
    struct refit refit = {0};
    struct job job;
    rotid_fit_result *fit = NULL;
    if (isfinite(other_place))
        there.effect.value[c->cause->place] = other_place;
    int status = add_causes(pool, base, x, &there, &job);
    if (!status)
        status = refit_job(pool, &job, number, holdout, environment, &fit);
    if (status)
        return status == ROTID_ERROR_MEMORY || status == ROTID_STOP_CANCELLED ? status : ROTID_OK;
    status = refit_keep(pool, &job, fit, &refit);
    if (status)
        return status;
    const char *name = candidate_label(pool, c);
    *rival = (struct rival){.label = name, .candidate = c, .job = refit.job, .fit = refit.fit};
    if (isfinite(other_place) && name)
        rival->label = pool_format(pool, "%s near %.3g m", name, other_place);
    rival->score = refit.chi2 + candidate_score(c) - c->result.chi2;
    rivals->n++;
    return rival->label ? ROTID_OK : ROTID_ERROR_MEMORY;
}

static int add_base(struct pool *pool, const struct job *base, const double *x, const int *number, const int *holdout,
                    const rotid_environment *environment, struct rivals *rivals)
{
    struct job job;
    struct refit refit = {0};
    rotid_fit_result *fit = NULL;
    int status = job_started_at(pool, base, x, &job);
    if (!status)
        status = refit_job(pool, &job, number, holdout, environment, &fit);
    if (!status)
        status = refit_keep(pool, &job, fit, &refit);
    if (status)
        return status;
    rivals->rival[rivals->n++] =
        (struct rival){.label = "the model as it is", .job = refit.job, .fit = refit.fit, .score = refit.chi2};
    return ROTID_OK;
}

static void share(struct rivals *rivals)
{
    double least = INFINITY, sum = 0;
    for (int i = 0; i + 1 < rivals->n; i++)
        least = fmin(least, rivals->rival[i].score);
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i + 1 < rivals->n; i++) {
            double weight = exp(-(rivals->rival[i].score - least) / 2);
            if (pass)
                rivals->rival[i].share = weight / sum;
            else
                sum += weight;
        }
}

int rivals_find(struct pool *pool, const struct diagnosis *d, const rotid_environment *environment, struct rivals *rivals)
{
    const struct diagnosis_round *last = d->nround ? &d->round[d->nround - 1] : NULL;
    *rivals = (struct rivals){0};
    if (!last || last->result.kind != ROTID_AMBIGUOUS || !d->base.fit || !last->result.set)
        return ROTID_OK;
    int named = d->extended.fit != NULL, status = ROTID_OK;
    const struct job *base = named ? &d->extended_job : &d->job;
    const struct identification *fitted = named ? &d->extended : &d->base;
    const int *number = fitted->compared.number, *holdout = base->measurement.holdout;
    const double *x = fitted->fit->x;
    rivals->rival = POOL_ARRAY(pool, struct rival, 2 * MOST_RIVALS + 2);
    rivals->number = POOL_ARRAY(pool, int, base->measurement.nmode);
    if (!rivals->rival || !rivals->number)
        return ROTID_ERROR_MEMORY;
    for (int k = 0; k < base->measurement.nmode; k++)
        if (!holdout[k])
            rivals->number[rivals->nmode++] = number[k];
    rivals->margin = fmax(LEAST_MARGIN, isfinite(last->result.required_margin) ? last->result.required_margin : 0);
    rivals->base_margin = fmax(rivals->margin, CLEAR * last->result.threshold);
    for (int i = 0; i < last->result.set && i < last->ncandidate && !status; i++) {
        const struct candidate *c = &last->candidate[i];
        if (!is_model(c) || !isfinite(c->result.chi2) || rivals->n >= MOST_RIVALS) {
            rivals->left_out++;
            continue;
        }
        status = add(pool, base, x, c, number, holdout, NAN, environment, rivals);
        int elsewhere = !c->with && c->cause->place >= 0 && !c->fixed[c->cause->place] &&
                        c->other_chi2 - c->result.chi2 < rivals->margin;
        if (!status && elsewhere && rivals->n < MOST_RIVALS)
            status = add(pool, base, x, c, number, holdout, c->other_place, environment, rivals);
    }
    if (!status && rivals->n)
        status = add_base(pool, base, x, number, holdout, environment, rivals);
    if (status)
        rivals_free(rivals);
    else
        share(rivals);
    return status;
}

void rivals_free(struct rivals *rivals)
{
    for (int i = 0; i < rivals->n; i++)
        rotid_fit_free(rivals->rival[i].fit);
    rivals->n = 0;
}

int rival_uses(const struct rival *rival, int p)
{
    return !rival->fit->at_bound[p] && rival->fit->x[p] != 0;
}

void rival_gram(const struct rival *rival, const int *own, int n, double *gram)
{
    const rotid_fit_result *fit = rival->fit;
    int rows = fit->nresidual, a = 0;
    for (int p = 0; p < fit->n; p++) {
        int b = 0;
        if (!rival_uses(rival, p))
            continue;
        for (int q = 0; q < fit->n; q++) {
            if (!rival_uses(rival, q))
                continue;
            double product = product_dot(rows, fit->jacobian + (ptrdiff_t)p * rows, fit->jacobian + (ptrdiff_t)q * rows);
            int alone = own && (own[p] || own[q]);
            gram[a + (ptrdiff_t)b++ * n] = alone ? (double)(p == q) : product * fit->x[p] * fit->x[q];
        }
        a++;
    }
}
