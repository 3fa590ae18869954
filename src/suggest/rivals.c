#include "suggest/suggest.h"

#include <math.h>
#include <stdlib.h>

#include "diagnose/diagnose.h"
#include "fit/fit.h"
#include "linalg/linalg.h"

#define SAME_CHI2  1.0   /* of a fit on a mesh that may be finer */
#define SAME_MODEL 2.0   /* times chi2: beyond that the fit did not find what the diagnosis had found */
#define LEAST      1e-12 /* probability: what was left out of the sum may have so much */

struct sources {                 /* of rivals */
    const struct states *base;   /* the model with what is named */
    const double *x;             /* [nparameter] its values */
    int home, *number, *holdout; /* of the modes of all states */
    const rotid_environment *environment;
};

static int is_model(const struct candidate *c)
{
    return c->cause->class == CAUSE_PHYSICAL && c->cause->effect && !c->cause->solid && isfinite(c->result.chi2);
}

static int is_alone(const struct diagnosis *d, int i)
{
    const struct candidate *c = d->alternative;
    return (!i || c[i - 1].set != c[i].set) && (i + 1 == d->nalternative || c[i + 1].set != c[i].set);
}

/* Whether cause i stands alone, and alone at another place as well. */
static int is_elsewhere(const struct diagnosis *d, int i)
{
    const struct candidate *c = d->alternative;
    int found = 0;
    for (int k = 0; k < d->nalternative; k++)
        found |= k != i && is_alone(d, k) && posterior_same_cause(&c[k], &c[i]);
    return found && is_alone(d, i) && c[i].cause->place >= 0;
}

/* The causes [count] of a rival in the states, the own parameters from x (NULL: their starts), the first cause at another place
 * where that is finite; held: at their values. */
static int add_causes(struct pool *pool, const struct sources *from, const double *x, int count, const struct candidate *cause,
                      double other_place, int held, struct states *to)
{
    static const int all[EFFECT_MOST_PARAMETERS] = {1, 1, 1, 1};
    int status = ROTID_OK;
    for (int i = 0; i < count && !status; i++) {
        struct effect effect = cause[i].effect;
        if (i && !(effect.name = states_free_name(pool, to, cause[i].cause->id)))
            return ROTID_ERROR_MEMORY;
        if (!i && isfinite(other_place))
            effect.value[cause->cause->place] = other_place;
        status = states_with_effect(pool, i ? to : from->base, i ? NULL : x, &effect, cause[i].cause, held ? all : cause[i].fixed,
                                    cause[i].in, to);
    }
    return status;
}

static int is_fatal(int status)
{
    return status == ROTID_ERROR_MEMORY || status == ROTID_STOP_CANCELLED;
}

/* The fit from there, kept in *refit where it is better. Statuses of memory and cancellation. */
static int fit_from(struct pool *pool, const struct sources *from, const double *x, int count, const struct candidate *cause,
                    double other_place, struct refit *refit)
{
    struct states states;
    rotid_fit_result *held = NULL, *fit = NULL;
    int status = add_causes(pool, from, x, count, cause, other_place, 1, &states);
    if (!status && states.nparameter) /* the rest follows first: it may be far from where the causes were found */
        status = refit_states(pool, &states, from->number, from->holdout, from->environment, &held);
    if (!status)
        status = add_causes(pool, from, held ? held->x : x, count, cause, other_place, 0, &states);
    rotid_fit_free(held);
    if (!status)
        status = refit_states(pool, &states, from->number, from->holdout, from->environment, &fit);
    if (status)
        return is_fatal(status) ? status : ROTID_OK;
    if (fit->chi2 < refit->chi2)
        return refit_keep(pool, &states, fit, refit);
    rotid_fit_free(fit);
    return ROTID_OK;
}

/* A fit as a rival of that label. */
static int take_fit(struct pool *pool, const struct sources *from, const struct refit *refit, struct rival *rival)
{
    const struct state *home = &refit->states.state[from->home];
    rival->states = refit->states;
    rival->home = from->home;
    rival->job = home->job;
    rival->x = state_values(pool, home, refit->fit->x);
    rival->fit = refit->fit;
    return rival->x && rival->label ? ROTID_OK : ROTID_ERROR_MEMORY;
}

static const char *label_of(struct pool *pool, const struct job_units *units, int count, const struct candidate *cause,
                            double other_place)
{
    const char *text = candidate_label(pool, cause), *second = count > 1 ? candidate_label(pool, cause + 1) : NULL;
    if (!text || (count > 1 && !second))
        return NULL;
    return second                  ? pool_format(pool, "%s with %s", text, second)
           : isfinite(other_place) ? pool_format(pool, "%s near %s", text, job_value_text(pool, units, 3, other_place, "m"))
                                   : text;
}

/* Fits a rival of that probability; one that cannot be fitted is none. */
static int add(struct pool *pool, const struct sources *from, int count, const struct candidate *cause, double other_place,
               double probability, struct rivals *rivals)
{
    struct rival *rival = &rivals->rival[rivals->n];
    struct refit refit = {.chi2 = INFINITY};
    int status = fit_from(pool, from, from->x, count, cause, other_place, &refit);
    if (!status && !(refit.chi2 < cause->result.chi2 + SAME_CHI2)) /* the base may end at a bound, far away */
        status = fit_from(pool, from, NULL, count, cause, other_place, &refit);
    if (!status && (!refit.states.state || !(refit.chi2 < SAME_MODEL * cause->result.chi2 + SAME_CHI2))) {
        rotid_fit_free(refit.fit);
        rivals->left_out++;
        return ROTID_OK;
    }
    if (status)
        return status;
    *rival = (struct rival){.label = label_of(pool, &from->base->state[from->home].job.units, count, cause, other_place),
                            .ncause = count,
                            .cause = cause,
                            .share = probability};
    rivals->n++;
    status = take_fit(pool, from, &refit, rival);
    rival->score = -2 * log(fmax(LEAST, probability));
    return status;
}

static int add_base(struct pool *pool, const struct sources *from, double probability, struct rivals *rivals)
{
    struct states states;
    struct refit refit = {0};
    rotid_fit_result *fit = NULL;
    int status = states_started_at(pool, from->base, from->x, &states);
    if (!status)
        status = refit_states(pool, &states, from->number, from->holdout, from->environment, &fit);
    if (!status)
        status = refit_keep(pool, &states, fit, &refit);
    if (status)
        return status;
    struct rival *rival = &rivals->rival[rivals->n++];
    *rival = (struct rival){.label = "the model as it is", .score = -2 * log(fmax(LEAST, probability))};
    return take_fit(pool, from, &refit, rival);
}

static int by_score(const void *left, const void *right)
{
    double a = ((const struct rival *)left)->score, b = ((const struct rival *)right)->score;
    return (a > b) - (a < b);
}

/* By their probabilities; among: what they have together, the model as it is and something else being the rest. */
static void share(struct rivals *rivals)
{
    double sum = 0;
    if (rivals->n > 1)
        qsort(rivals->rival, (size_t)rivals->n - 1, sizeof *rivals->rival, by_score);
    for (int i = 0; i + 1 < rivals->n; i++)
        sum += rivals->rival[i].share;
    for (int i = 0; i + 1 < rivals->n; i++)
        rivals->rival[i].share /= sum > 0 ? sum : 1;
    rivals->among = sum;
}

int rivals_home(const struct states *states)
{
    int home = 0, most = -1;
    for (int s = 0; s < states->nstate; s++) {
        const struct job *job = &states->state[s].job;
        int fitted = 0;
        for (int k = 0; k < job->measurement.nmode; k++)
            fitted += !job->measurement.holdout[k];
        fitted *= 1 + (job_fits_shapes(job) ? job->rotor.nsensor : 0);
        home = fitted > most ? s : home;
        most = fitted > most ? fitted : most;
    }
    return home;
}

int rivals_find(struct pool *pool, const struct diagnosis *d, const rotid_environment *environment, struct rivals *rivals)
{
    const struct diagnosis_round *last = d->nround ? &d->round[d->nround - 1] : NULL;
    *rivals = (struct rivals){0};
    if (!last || !d->nalternative || !d->base.fit)
        return ROTID_OK;
    int named = d->extended.fit != NULL, status = ROTID_OK, modes, at = 0;
    const struct states *base = named ? &d->extended_states : &d->judged;
    struct sources from = {
        .base = base, .x = (named ? d->extended : d->base).fit->x, .home = rivals_home(base), .environment = environment};
    modes = states_modes(base, base->nstate);
    from.number = POOL_ARRAY(pool, int, modes);
    from.holdout = POOL_ARRAY(pool, int, modes);
    rivals->rival = POOL_ARRAY(pool, struct rival, MOST_RIVALS + 1);
    rivals->number = POOL_ARRAY(pool, int, modes);
    rivals->home = from.home;
    if (!rivals->rival || !rivals->number || !from.number || !from.holdout)
        return ROTID_ERROR_MEMORY;
    for (int s = 0; s < base->nstate; s++)
        for (int k = 0; k < base->state[s].job.measurement.nmode; k++, at++) {
            from.number[at] = (named ? d->state_extended : d->state_base)[s].compared.number[k];
            from.holdout[at] = base->state[s].job.measurement.holdout[k];
            if (s == from.home && !from.holdout[at])
                rivals->number[rivals->nmode++] = from.number[at];
        }
    rivals->margin = 2 * log(VERDICT_NAMED / (1 - VERDICT_NAMED));
    for (int i = 0, count; i < d->nalternative && !status; i += count) {
        const struct candidate *c = &d->alternative[i];
        for (count = 1; i + count < d->nalternative && c[count].set == c->set;)
            count++;
        if (count > 2 || !is_model(c) || !is_model(&c[count - 1]) || rivals->n >= MOST_RIVALS) {
            rivals->left_out++;
            continue;
        }
        int elsewhere =
            count == 1 && c->cause->place >= 0 && !c->fixed[c->cause->place] && c->other_chi2 - c->result.chi2 < rivals->margin;
        double here = elsewhere ? 1 / (1 + exp((c->result.chi2 - c->other_chi2) / 2)) : 1;
        double place = is_elsewhere(d, i) ? c->effect.value[c->cause->place] : NAN; /* that tells the two apart */
        status = add(pool, &from, count, c, place, here * c->probability, rivals);
        if (!status && elsewhere && rivals->n < MOST_RIVALS)
            status = add(pool, &from, count, c, c->other_place, (1 - here) * c->probability, rivals);
    }
    if (!status && rivals->n)
        status = add_base(pool, &from, d->posterior.nothing, rivals);
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

int rival_own(const struct rival *rival, int p)
{
    const struct state *home = &rival->states.state[rival->home];
    for (int q = 0; q < home->job.unknowns.nparameter; q++)
        if (state_unknown(home, q) == p)
            return q;
    return -1;
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
