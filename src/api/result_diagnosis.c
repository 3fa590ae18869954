#include "api/api.h"

#define SHARED 0.99 /* probability of the explanations that are listed */

/* Name and unit of parameter p of a candidate, that of the card for a fault of the measurement; NULL behind the last. */
static const struct effect_parameter_name *candidate_parameter(const struct candidate *candidate, int p)
{
    const struct effect_kind *kind = candidate->effect.kind;
    if (p >= candidate->nparameter || p >= EFFECT_MOST_PARAMETERS)
        return NULL;
    if (kind)
        return p < kind->nparameter ? &kind->parameter[p] : NULL;
    return correction_parameter(candidate->cause, p);
}

/* The word for its shape or mount, NULL where its cause has none. */
static const char *candidate_variant(const struct candidate *candidate)
{
    const struct cause_kind *cause = candidate->cause;
    int variant = candidate->effect.variant, words = (int)(sizeof cause->variant / sizeof *cause->variant);
    return cause->variant_option && variant >= 0 && variant < words ? cause->variant[variant] : NULL;
}

static rotid_cause cause_of(struct pool *pool, const struct candidate *c)
{
    const struct effect_parameter_name *parameter;
    rotid_cause out = {
        .id = c->cause->id, .target = c->target, .name = c->effect.name, .variant = candidate_variant(c), .state = c->state_name};
    int room = POOL_LIST(pool, out.parameters, EFFECT_MOST_PARAMETERS);
    for (int p = 0; p < room && (parameter = candidate_parameter(c, p)); p++)
        out.parameters[out.nparameters++] = (rotid_cause_value){.name = parameter->name,
                                                                .unit = parameter->unit,
                                                                .value = c->effect.value[p],
                                                                .std = c->std[p],
                                                                .ci95 = {c->ci_lower[p], c->ci_upper[p]},
                                                                .fixed = c->fixed[p]};
    return out;
}

int result_causes(struct pool *pool, int count, const struct candidate *candidate, rotid_cause **list)
{
    int room = POOL_LIST(pool, *list, count);
    for (int i = 0; i < room; i++)
        (*list)[i] = cause_of(pool, &candidate[i]);
    return room;
}

static void fill_verdict(struct pool *pool, const struct diagnosis *d, rotid_verdict *out)
{
    out->ncauses = result_causes(pool, d->ncause, d->cause, &out->causes);
    out->nlikely_causes = result_causes(pool, d->nlikely, d->cause + d->ncause, &out->likely_causes);
    out->nalternative_causes = result_causes(pool, d->nalternative, d->alternative, &out->alternative_causes);
    out->nalternatives = POOL_LIST(pool, out->alternatives, d->nalternative);
    out->nalternative_sets = POOL_LIST(pool, out->alternative_sets, d->nalternative);
    for (int i = 0; i < out->nalternatives && i < out->nalternative_sets; i++) {
        out->alternatives[i] = d->alternative[i].cause->id;
        out->alternative_sets[i] = d->alternative[i].set;
    }
}

/* The likeliest, together SHARED, and the marginals of all causes that are worth a line. */
static void fill_explanations(struct pool *pool, const struct diagnosis *d, rotid_verdict *out)
{
    const struct posterior *p = &d->posterior;
    int count = 0, room;
    for (double sum = 0; count < p->count && sum < SHARED; count++)
        sum += p->item[count].probability;
    room = POOL_LIST(pool, out->explanations, count);
    for (int i = 0; i < room; i++) {
        const struct explanation *e = &p->item[i];
        rotid_explanation *o = &out->explanations[out->nexplanations++];
        *o = (rotid_explanation){.something_else = e->something_else,
                                 .probability = e->probability,
                                 .at_rest = p->has_runup ? e->at_rest : (double)NAN};
        o->ncauses = result_causes(pool, e->nmember, e->member, &o->causes);
        int nown = POOL_LIST(pool, o->identified, p->nown);
        for (int q = 0; q < nown; q++) {
            double x = e->evidence.mean[q], half = 1.96 * e->evidence.std[q];
            const rotid_parameter *b = &d->judged.bounds[q];
            o->identified[o->nidentified++] = (rotid_cause_value){.name = b->name,
                                                                  .unit = b->unit,
                                                                  .value = x,
                                                                  .std = e->evidence.std[q],
                                                                  .ci95 = {fmax(b->lower, x - half), fmin(b->upper, x + half)}};
        }
    }
    room = POOL_LIST(pool, out->marginals, p->nmarginal);
    for (int i = 0; i < room; i++) {
        const struct candidate *c = &p->marginal[i].cause;
        double z = c->cause->place < 0 ? (double)NAN : c->effect.value[c->cause->place];
        out->marginals[out->nmarginals++] =
            (rotid_marginal){c->cause->id, c->target, c->state_name, z, p->marginal[i].probability};
    }
    out->nothing = p->count ? p->nothing : (double)NAN;
    out->nothing_prior = p->count ? p->nothing_prior : (double)NAN;
    out->something_else = p->count ? p->something_else : (double)NAN;
    out->runup_p = p->has_runup ? p->runup_p : (double)NAN;
}

static void fill_rounds(struct pool *pool, const struct diagnosis *d, rotid_diagnosis *out)
{
    int count = 0;
    for (int i = 0; i < d->nround; i++)
        count += d->round[i].ncandidate;
    if (!POOL_LIST(pool, out->candidates, count) && count)
        return;
    out->nrounds = POOL_LIST(pool, out->rounds, d->nround);
    for (int i = 0; i < out->nrounds; i++) {
        const struct diagnosis_round *round = &d->round[i];
        out->rounds[i] = round->result;
        for (int k = 0; k < round->ncandidate; k++) {
            rotid_candidate *candidate = &out->candidates[out->ncandidates++];
            *candidate = round->candidate[k].result;
            candidate->cause = cause_of(pool, &round->candidate[k]);
        }
    }
}

static rotid_changed_parameter changed_parameter(const rotid_parameter *name, const rotid_fit_result *base, int before,
                                                 const rotid_fit_result *extended, int after)
{
    int was = base && before >= 0, is = extended && after >= 0;
    return (rotid_changed_parameter){
        .name = name->name,
        .unit = name->unit,
        .before = was ? base->x[before] : (double)NAN,
        .after = is ? extended->x[after] : (double)NAN,
        .before_ci95 = {was ? base->ci_lower[before] : (double)NAN, was ? base->ci_upper[before] : (double)NAN},
        .after_ci95 = {is ? extended->ci_lower[after] : (double)NAN, is ? extended->ci_upper[after] : (double)NAN}};
}

/* Index in the fit (may be NULL) of the unknown [fit->n] of that name, -1 where there is none. */
static int fitted_parameter(const rotid_parameter *unknown, const rotid_fit_result *fit, const char *name)
{
    for (int p = 0; fit && p < fit->n; p++)
        if (!strcmp(unknown[p].name, name))
            return p;
    return -1;
}

/* Parameters of the base model, then those that the extended one has besides. A diagnosis that was broken off in its first fit
 * has that fit, and no judged model yet. */
static void fill_changes(struct pool *pool, const struct diagnosis *d, rotid_gain *out)
{
    const rotid_fit_result *base = d->base.fit, *extended = d->extended.fit;
    const rotid_parameter *before = d->judged.bounds, *after = d->extended_states.bounds;
    int nbase = base ? base->n : 0, nextended = extended ? extended->n : 0,
        room = POOL_LIST(pool, out->parameters, nbase + nextended);
    for (int p = 0; p < nbase && room; p++)
        out->parameters[out->nparameters++] =
            changed_parameter(&before[p], base, p, extended, fitted_parameter(after, extended, before[p].name));
    for (int p = 0; p < nextended && room; p++)
        if (fitted_parameter(before, base, after[p].name) < 0)
            out->parameters[out->nparameters++] = changed_parameter(&after[p], base, -1, extended, p);
}

/* As part of a diagnosis, which has the noise and the geometry. */
static rotid_identification *identification(struct pool *pool, const struct states *states, const struct identification *first,
                                            const struct identification *each)
{
    rotid_identification *out =
        states->nstate && first->fit ? result_identification(pool, states, states->nstate > 1 ? each : first, first->fit) : NULL;
    if (out) {
        out->noise = NULL;
        out->geometry = NULL;
    }
    return out;
}

/* A fit that was broken off before its model was taken belongs to no result, which would free it. */
static void drop_unjudged(const struct states *states, struct identification *fitted)
{
    if (states->nstate)
        return;
    rotid_fit_free(fitted->fit);
    fitted->fit = NULL;
}

rotid_diagnosis *result_diagnosis(struct pool *pool, const struct states *deck, struct diagnosis *d)
{
    rotid_diagnosis *out = &d->result;
    drop_unjudged(&d->judged, &d->base);
    drop_unjudged(&d->extended_states, &d->extended);
    fill_verdict(pool, d, &out->verdict);
    fill_explanations(pool, d, &out->verdict);
    out->nparameters = d->posterior.naveraged;
    out->parameters = d->posterior.averaged;
    fill_rounds(pool, d, out);
    fill_changes(pool, d, &out->gain);
    out->geometry =
        result_geometry(pool, d->judged.nstate ? &d->judged.state->job.rotor : &deck->state->job.rotor, d->base.spectrum.model);
    out->today = identification(pool, deck, &d->today, d->state_today);
    out->base = identification(pool, &d->judged, &d->base, d->state_base);
    out->extended = identification(pool, &d->extended_states, &d->extended, d->state_extended);
    return out;
}
