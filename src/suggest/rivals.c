#include "fit/fit.h"
#include "suggest/suggest.h"

#define SHARED 0.99  /* of the explanations that are rivals */
#define LEAST  1e-12 /* probability: what was left out of the sum may have so much */

static int is_model(const struct explanation *e)
{
    int all = e->refit != NULL && e->nmember <= 2;
    for (int m = 0; m < e->nmember; m++) {
        const struct cause_kind *cause = e->member[m].cause;
        all &= cause->class == CAUSE_PHYSICAL && cause->effect && !cause->solid;
    }
    return all;
}

/* "support_rotation near 0.4 m": where another explanation is the same cause at another place. */
static const char *label_of(struct pool *pool, const struct job_units *units, const struct posterior *p,
                            const struct explanation *e)
{
    const struct candidate *c = e->member;
    const char *text = candidate_label(pool, c), *second = e->nmember > 1 ? candidate_label(pool, c + 1) : "";
    int elsewhere = 0;
    double shown = 0;
    if (e->nmember > 1)
        return pool_format(pool, "%s with %s", text, second);
    for (int i = 0; i < p->count && shown < SHARED; shown += p->item[i++].probability)
        elsewhere |= &p->item[i] != e && p->item[i].nmember == 1 && posterior_same_cause(&p->item[i].member[0], c);
    return elsewhere && c->cause->place >= 0
               ? pool_format(pool, "%s near %s", text, job_value_text(pool, units, 3, c->effect.value[c->cause->place], "m"))
               : text;
}

/* The states with a fit to them as a rival of that probability. */
static int add(struct pool *pool, const struct states *states, const rotid_fit_result *fit, double probability,
               struct rivals *rivals)
{
    struct rival *rival = &rivals->rival[rivals->n++];
    const struct state *home = &states->state[rivals->home];
    rival->states = *states;
    rival->home = rivals->home;
    rival->job = home->job;
    rival->x = state_values(pool, home, fit->x);
    rival->fit = fit;
    rival->share = probability;
    rival->score = -2 * log(fmax(LEAST, probability));
    return rival->x && rival->label ? states_copy(pool, states, &rival->states) : ROTID_ERROR_MEMORY;
}

ORDER_BY(by_score, struct rival, it->score, 0)

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
        int fitted = job_fitted(job, job->measurement.holdout) * (1 + (job_fits_shapes(job) ? job->rotor.nsensor : 0));
        home = fitted > most ? s : home;
        most = fitted > most ? fitted : most;
    }
    return home;
}

int rivals_find(struct pool *pool, const struct diagnosis *d, struct rivals *rivals)
{
    const struct posterior *p = &d->posterior;
    double shown = 0;
    int status = ROTID_OK, at = 0;
    *rivals = (struct rivals){.home = rivals_home(&d->judged), .margin = 2 * log(VERDICT_NAMED / (1 - VERDICT_NAMED))};
    if (!d->nalternative || !d->base.fit)
        return ROTID_OK;
    rivals->rival = POOL_ARRAY(pool, struct rival, MOST_RIVALS + 1);
    rivals->number = POOL_ARRAY(pool, int, states_modes(&d->judged, d->judged.nstate));
    if (!rivals->rival || !rivals->number)
        return ROTID_ERROR_MEMORY;
    const struct job_measurement *m = &d->judged.state[rivals->home].job.measurement;
    for (int k = 0; k < m->nmode; k++)
        if (!m->holdout[k])
            rivals->number[rivals->nmode++] = d->state_base[rivals->home].compared.number[k];
    for (; at < p->count && shown < SHARED && !status; shown += p->item[at++].probability) {
        const struct explanation *e = &p->item[at];
        if (!e->nmember || e->something_else)
            continue;
        if (!is_model(e) || rivals->n >= MOST_RIVALS) {
            rivals->left_out++;
            continue;
        }
        struct rival *rival = &rivals->rival[rivals->n];
        *rival =
            (struct rival){.label = label_of(pool, &d->judged.state->job.units, p, e), .ncause = e->nmember, .cause = e->member};
        status = add(pool, &e->refit->states, e->refit->fit, e->probability, rivals);
    }
    if (!status && rivals->n) {
        struct states base;
        rivals->rival[rivals->n] = (struct rival){.label = "the model as it is"};
        status = states_started_at(pool, &d->judged, d->base.fit->x, &base);
        if (!status)
            status = add(pool, &base, d->base.fit, d->posterior.nothing, rivals);
    }
    if (!status)
        share(rivals);
    return status;
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
