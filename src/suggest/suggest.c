#include "suggest/suggest.h"

#include <math.h>
#include <string.h>

#include "base/order.h"
#include "fit/quantile.h"
#include "suggest/advice.h"
#include "suggest/candidates.h"
#include "suggest/plan.h"

#define WANTED_PERCENT  2.0
#define FREQUENCY_NOISE 0.003 /* as a diagnosis assumes it */
#define SHAPE_NOISE     0.02  /* of a hammer test with care */
#define SET_UP_COST     20.0  /* points: an hour beside some minutes each */
#define SENSORS         8
#define MODES           5
#define REPLICATES      1000

/* Median of those that are finite; 0 without any. */
static double median(struct pool *pool, ptrdiff_t n, const double *value)
{
    double *known = POOL_ARRAY(pool, double, n);
    size_t count = 0;
    for (ptrdiff_t i = 0; known && i < n; i++)
        if (isfinite(value[i]))
            known[count++] = value[i];
    return count ? median_of(count, known) : 0;
}

/* What the deck and the user leave open. */
static void settle(struct pool *pool, const struct job *job, rotid_suggest_options *o, rotid_noise *noise)
{
    const struct job_measurement *m = &job->measurement;
    int fitted = 0;
    for (int k = 0; k < m->nmode; k++)
        fitted += !m->holdout[k];
    if (!(o->frequency_noise > 0))
        o->frequency_noise = m->nmode ? median(pool, m->nmode, m->frequency_std) : m->stated_frequency_noise;
    if (!(o->shape_noise > 0))
        o->shape_noise = m->shape && m->shape_std ? median(pool, (ptrdiff_t)m->nmode * job->rotor.nsensor, m->shape_std)
                                                  : m->stated_shape_noise;
    *noise = (rotid_noise){.frequency_assumed = !(o->frequency_noise > 0), .shape_assumed = !(o->shape_noise > 0)};
    o->frequency_noise = noise->frequency = o->frequency_noise > 0 ? o->frequency_noise : FREQUENCY_NOISE;
    o->shape_noise = noise->shape = o->shape_noise > 0 ? o->shape_noise : SHAPE_NOISE;
    o->wanted_percent = o->wanted_percent > 0 ? o->wanted_percent : WANTED_PERCENT;
    o->set_up_cost = o->set_up_cost > 0 ? o->set_up_cost : SET_UP_COST;
    o->sensors = o->sensors > 0 ? o->sensors : job->rotor.nsensor ? job->rotor.nsensor : SENSORS;
    o->modes = o->modes > 0 ? o->modes : fitted > 1 ? fitted : MODES;
    o->threads = o->threads > 0 ? o->threads : 1;
    o->replicates = o->replicates > 0 ? o->replicates : REPLICATES;
    o->seed = o->seed > 0 ? o->seed : 1;
}

static int list_parameters(struct pool *pool, struct suggestion *out)
{
    rotid_suggestion *r = &out->result;
    const rotid_fit_result *fit = out->found.extended.fit ? out->found.extended.fit : out->found.base.fit;
    int n = POOL_LIST(pool, r->parameters, out->job.unknowns.nparameter);
    for (int q = 0; q < n; q++) {
        const rotid_parameter *b = &out->job.unknowns.bounds[q];
        int p = state_unknown(&out->home, q);
        rotid_fitted_parameter *to = &r->parameters[r->nparameters++];
        *to = (rotid_fitted_parameter){.name = b->name,
                                       .unit = b->unit,
                                       .value = out->x[q],
                                       .start = b->start,
                                       .lower = b->lower,
                                       .upper = b->upper,
                                       .std = fit ? fit->std[p] : (double)NAN,
                                       .ci95 = {fit ? fit->ci_lower[p] : (double)NAN, fit ? fit->ci_upper[p] : (double)NAN},
                                       .at_bound = fit ? fit->at_bound[p] : 0,
                                       .identifiable = fit ? fit->identifiable[p] : 1};
    }
    return n == out->job.unknowns.nparameter ? ROTID_OK : ROTID_ERROR_MEMORY;
}

static int take_home(struct pool *pool, const struct states *states, int home, const double *x, struct suggestion *out)
{
    out->home = states->state[home];
    out->job = out->home.job;
    out->x = state_values(pool, &out->home, x);
    return out->x ? ROTID_OK : ROTID_ERROR_MEMORY;
}

/* Without measurements: the model as the deck states it, its unknowns at their starts. */
static int take_starts(struct pool *pool, const struct states *states, struct suggestion *out)
{
    double *x = POOL_ARRAY(pool, double, states->nparameter);
    for (int p = 0; x && p < states->nparameter; p++)
        x[p] = states->bounds[p].start;
    return x ? take_home(pool, states, rivals_home(states), x, out) : ROTID_ERROR_MEMORY;
}

static int take_diagnosis(struct pool *pool, const struct states *states, const rotid_suggest_options *o,
                          const rotid_environment *environment, struct message_list *notes, struct suggestion *out)
{
    const struct diagnose_options options = {.threads = o->threads, .replicates = o->replicates, .seed = (unsigned long)o->seed};
    int status = diagnose_states(pool, states, &options, environment, notes, &out->found);
    if (!status && out->found.result.interrupted)
        return ROTID_STOP_CANCELLED;
    if (status)
        return status;
    const struct diagnosis *d = &out->found;
    const struct states *judged = d->extended.fit ? &d->extended_states : &d->judged;
    int home = rivals_home(judged);
    status = take_home(pool, judged, home, (d->extended.fit ? d->extended : d->base).fit->x, out);
    out->job.models = states->state[home].job.models;
    out->result.verdict = d->result.verdict.sentence;
    out->result.ndetectable = d->result.ndetectable;
    out->result.detectable = d->result.detectable;
    if (!status)
        status = rivals_find(pool, d, environment, &out->rivals);
    for (int i = 0; i < out->rivals.n; i++) {
        struct rival *rival = &out->rivals.rival[i];
        for (int s = 0; s < states->nstate; s++)
            rival->states.state[s].job.models = states->state[s].job.models;
        rival->job.models = out->job.models;
    }
    return status;
}

/* What the chances rest on, and do not hold without. */
static void note_rivals(struct message_list *notes, const struct rivals *rivals)
{
    const rotid_fit_result *best = rivals->n ? rivals->rival[0].fit : NULL;
    if (rivals->left_out)
        message_add(notes, SEVERITY_WARNING, NULL, 0, 0,
                    "%d of the alternatives of the diagnosis %s left out: not among the first %d, no model of this kind, or not "
                    "fitted again; the chances of the tests hold among the others",
                    rivals->left_out, rivals->left_out == 1 ? "is" : "are", MOST_RIVALS);
    if (best && best->dof > 0 && chi_square_tail(best->chi2, best->dof) < JUDGED)
        message_add(
            notes, SEVERITY_WARNING, NULL, 0, 0,
            "the best of the rivals leaves chi2 %.3g for %d degrees of freedom: perhaps none of them is the true one, and "
            "the chances hold only if one is",
            best->chi2, best->dof);
}

static int list_rivals(struct pool *pool, struct suggestion *out)
{
    rotid_suggestion *r = &out->result;
    int n = POOL_LIST(pool, r->rivals, out->rivals.n);
    r->among = n ? out->rivals.among : (double)NAN;
    for (int i = 0; i < n; i++) {
        const struct rival *rival = &out->rivals.rival[i];
        r->rivals[r->nrivals++] =
            (rotid_rival){.label = rival->label, .chi2 = rival->fit->chi2, .score = rival->score, .share = rival->share};
    }
    return n == out->rivals.n ? ROTID_OK : ROTID_ERROR_MEMORY;
}

static int run(struct pool *pool, const struct states *states, rotid_suggest_options *o, const rotid_environment *environment,
               struct message_list *notes, struct suggestion *out)
{
    rotid_suggestion *r = &out->result;
    struct places places;
    int *first, measured = states_modes(states, states->nstate) > 0,
                status = measured ? take_diagnosis(pool, states, o, environment, notes, out) : take_starts(pool, states, out);
    r->state = out->home.name;
    if (!status)
        settle(pool, &out->job, o, &r->noise);
    r->wanted_percent = o->wanted_percent;
    r->set_up_cost = o->set_up_cost;
    if (!status)
        status = list_parameters(pool, out);
    if (!status)
        status = spectrum_compute_parts(pool, out->job.models, &out->job.rotor, out->job.unknowns.nparameter,
                                        out->job.unknowns.parameter, out->x, ROTID_REDUCTION_NONE, 1, 0, &out->spectrum);
    if (!status)
        status = places_find(pool, &out->job, &places);
    if (status)
        return status;
    const struct plan_request request = {.frequency_std = o->frequency_noise,
                                         .shape_std = o->shape_noise,
                                         .wanted_percent = o->wanted_percent,
                                         .sensors = o->sensors,
                                         .modes = o->modes,
                                         .detect = !measured,
                                         .threads = o->threads,
                                         .replicates = o->replicates,
                                         .seed = (unsigned long)o->seed,
                                         .environment = environment};
    first = POOL_ARRAY(pool, int, places.n);
    status = first ? plan_run(pool, &out->job, out->x, &places, &request, r, first) : ROTID_ERROR_MEMORY;
    if (!status)
        status = list_rivals(pool, out);
    if (!status)
        note_rivals(notes, &out->rivals);
    if (!status && out->rivals.n)
        status = candidates_judge(pool, &places, o, environment, out);
    if (status)
        return status;
    r->sentence = advice_sentence(pool, out);
    return r->sentence ? ROTID_OK : ROTID_ERROR_MEMORY;
}

int suggest_states(struct pool *pool, const struct states *states, const rotid_suggest_options *options,
                   const rotid_environment *environment, struct message_list *notes, struct suggestion *out)
{
    rotid_suggest_options o = *options;
    struct states mine;
    int begun = 0, status = states_copy(pool, states, &mine);
    *out = (struct suggestion){.result = {.noise = {.frequency = NAN, .shape = NAN}}};
    if (!status && !states->nparameter && !states_modes(states, states->nstate)) {
        message_add(notes, SEVERITY_ERROR, states->state->job.deck, 1, 1,
                    "the deck asks for nothing, expected *IDENTIFY with the parameters that a test is to determine");
        return ROTID_ERROR_ARGUMENT;
    }
    for (; begun < states->nstate && !status; begun++) {
        struct job *job = &mine.state[begun].job;
        job->models = models_for_run(pool, job->models);
        status = job->models ? ROTID_OK : ROTID_ERROR_MEMORY;
    }
    if (!status)
        status = run(pool, &mine, &o, environment, notes, out);
    for (int s = 0; s < begun; s++)
        if (mine.state[s].job.models)
            models_end_run(pool, mine.state[s].job.models, states->state[s].job.models);
    return status;
}

int suggest_run(struct pool *pool, const struct job *job, const rotid_suggest_options *options,
                const rotid_environment *environment, struct message_list *notes, struct suggestion *out)
{
    struct state state;
    const struct states states = states_of(job, &state);
    return suggest_states(pool, &states, options, environment, notes, out);
}

void suggest_free(struct suggestion *out)
{
    rivals_free(&out->rivals);
    diagnose_free(&out->found);
}
