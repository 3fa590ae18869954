/* What a round concludes from its fits. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "diagnose/causes/causes.h"
#include "diagnose/diagnose.h"
#include "fit/fit.h"

#define NOISIER   3.0  /* times the stated noise is beyond any misjudgement: then it is the model that is wrong */
#define COLOURED  2.0  /* margins, where neighbours share their noise: there are fewer independent residuals than rows */
#define CLEAR     2.0  /* times the threshold: the drop that a name needs; up to there something is wrong, but what stays open */
#define ONE_PLACE 0.03 /* of the length: as near as a second minimum of a fit counts as the first */
#define SURE      3.0  /* standard deviations that exclude a mass */
#define WORSE     1.1  /* held-out modes predicted worse than this factor speak against a cause */
#define SAME      0.02 /* of the drop: so little apart two predictions are those of one model, a cosine of 0.99 */
#define BETTER    0.85 /* a rival that predicts the modes held out by the deck so much better wins against a better fit */

static int free_parameters(const struct candidate *c)
{
    int count = 0;
    for (int p = 0; p < c->nparameter; p++)
        count += !c->fixed[p];
    count = count ? count : !c->cause->solid; /* one that is there or not was searched for too; what a rotor is, was not */
    return c->with ? count + free_parameters(c->with) : count;
}

double candidate_score(const struct candidate *c)
{
    return c->result.chi2 + PARAMETER_PENALTY * free_parameters(c);
}

static int compare(const void *left, const void *right)
{
    const struct candidate *a = left, *b = right;
    if (a->result.refitted != b->result.refitted)
        return b->result.refitted - a->result.refitted;
    double x = a->result.refitted ? candidate_score(a) : -a->result.predicted_drop,
           y = b->result.refitted ? candidate_score(b) : -b->result.predicted_drop;
    return (x > y) - (x < y);
}

/* Chi2 of the measured noise against a model that is wrong: by how much the best of what is left exceeds its noise, 1 where it
 * does not. Margins grow with it, as in quasi-likelihood. */
static double dispersion(const struct before *before, const struct candidate *best, double left_frequency)
{
    int dof = before->dof - best->nparameter - (best->with ? best->with->nparameter : 0);
    double whole = dof > 0 ? best->result.chi2 / dof : 1, block = left_frequency / before->nfrequency;
    double factor = dof > 0 && chi_square_tail(best->result.chi2, dof) < 0.01 ? whole : 1;
    if (chi_square_tail(left_frequency, before->nfrequency) < 0.01)
        factor = fmax(factor, block);
    return fmax(1, factor);
}

/* Minus twice the log-likelihood that frequencies gain when their noise is larger than stated, at its best size:
 * chi2 - m - m ln(chi2/m). A rival of every physical cause that shows in the frequencies alone. */
static double noise_drop(const struct before *before)
{
    double m = before->nfrequency, ratio = before->chi2_frequency / m;
    return ratio > 1 && ratio < NOISIER * NOISIER ? before->chi2_frequency - m - m * log(ratio) : 0;
}

/* Largest stated noise of a frequency, percent. */
static double frequency_noise(const struct states *states)
{
    double noise = 0;
    for (int s = 0; s < states->nstate; s++)
        for (int k = 0; k < states->state[s].job.measurement.nmode; k++)
            noise = fmax(noise, 100 * states->state[s].job.measurement.frequency_std[k]);
    return noise;
}

/* chi2 of the frequencies held out with the cause less that without it, by their stated noise. */
static double predicted_worse(const struct states *states, const struct before *before, const struct candidate *c)
{
    double noise = 0, count = 0,
           worse = c->result.holdout_rms * c->result.holdout_rms - before->holdout_rms * before->holdout_rms;
    for (int s = 0; s < states->nstate; s++) {
        const struct job_measurement *m = &states->state[s].job.measurement;
        for (int k = 0; k < m->nmode; k++)
            if (m->holdout[k]) {
                noise += 1e4 * m->frequency_std[k] * m->frequency_std[k];
                count++;
            }
    }
    return noise > 0 ? worse * count * count / noise : INFINITY;
}

static const char *chance(struct pool *pool, const struct candidate *c)
{
    return isfinite(c->result.p_value) ? pool_format(pool, "gains no more than chance (p = %.2g)", c->result.p_value)
                                       : "gains no more than chance";
}

/* The bounds were tried as wide as is possible (widen.h), but for those of the deck. */
static const char *bound_met(struct pool *pool, const struct candidate *c)
{
    const struct effect_parameter_name *size = &c->cause->effect->parameter[c->cause->size];
    int has_unit = strcmp(size->unit, "1") != 0;
    return pool_format(pool, "its size ends at the physical bound, %.3g%s%s", c->effect.value[c->cause->size],
                       has_unit ? " " : "", has_unit ? size->unit : "");
}

static int is_one_place(const struct engine *engine, const struct candidate *c)
{
    int place = c->cause->place;
    return c->cause == c->with->cause && place >= 0 && states_meet(engine->states.nstate, c->in, c->with->in) &&
           fabs(c->effect.value[place] - c->with->effect.value[place]) <
               ONE_PLACE * rotor_length(&engine->states.state[c->home].job.rotor);
}

/* Two zones, six numbers, follow a wave of the stiffness along a group within the noise. */
static int is_pattern(const struct engine *engine, const struct candidate *c)
{
    return c->cause == c->with->cause && c->cause->width >= 0 && states_meet(engine->states.nstate, c->in, c->with->in);
}

/* Beside a misfit that it leaves a cause has to be worth what is left: less for each of its parameters than is left for each
 * degree of freedom is what any parameter gains. */
static int is_worthless(const struct before *before, const struct candidate *c)
{
    int own = free_parameters(c), dof = before->dof - own;
    return !c->explains && dof > 0 && c->cause->class == CAUSE_PHYSICAL && c->result.chi2_drop * dof < own * c->result.chi2;
}

/* What speaks against a candidate by itself. Not its p-value: the threshold asks whether the best of the family is more than
 * noise, and a rival too weak to be named alone still belongs into the set of what cannot be told from the best. A pair has to do
 * what it was tried for, and what no cause alone comes near: alone is their least chi2. */
static const char *reason(const struct engine *engine, const struct before *before, double threshold, double alone,
                          const struct candidate *c)
{
    struct pool *pool = engine->pool;
    if (!c->result.refitted)
        return "promises too little";
    if (!isfinite(c->result.chi2))
        return "no fit of this cause reached a smaller chi2 than the model without the cause";
    if (c->result.chi2_drop < -REFIT_WORSE) /* it replaces something, or its size is fixed: no part of the model before */
        return "the model is worse with this cause";
    if (c->result.at_bound)
        return bound_met(pool, c->with && c->with->result.at_bound ? c->with : c);
    if (is_worthless(before, c))
        return "gains less for a parameter than it leaves for a degree of freedom";
    if (c->with && is_one_place(engine, c))
        return "two of one cause at one place are one";
    if (c->with && is_pattern(engine, c))
        return "two zones imitate any pattern of the stiffness along the rotor";
    if (c->with && !c->explains)
        return "two causes that still leave more than noise";
    if (c->with && alone - c->result.chi2 <= CLEAR * threshold)
        return "gains no more than chance beyond one cause alone";
    double most = fmax(0, engine->moving.mass) + SURE * engine->moving.std;
    if (engine->moving.usable && is_moving_accelerometer(&c->effect) && c->effect.value[0] > most)
        return pool_format(pool, "the frequencies at single sensors allow no more than %.2g kg", most);
    if (isfinite(c->result.holdout_rms) && c->result.holdout_rms > WORSE * before->holdout_rms &&
        predicted_worse(&engine->states, before, c) > LEAST_MARGIN) /* a true cause does so by noise once in a hundred at most */
        return pool_format(pool, "the prediction of held-out modes gets worse: %.2g %% after %.2g %%", c->result.holdout_rms,
                           before->holdout_rms);
    return NULL;
}

/* Modes left out in turn are predicted worse with the cause. That doubts the cause, and speaks for no other one: with few modes a
 * true cause does it too. */
static int is_doubted(const struct engine *engine, const struct before *before, const struct candidate *c)
{
    int worse = isfinite(c->result.mode_out_rms) && c->result.mode_out_rms > WORSE * before->mode_out_rms,
        no_better = !(isfinite(c->result.sensor_out_rms) && c->result.sensor_out_rms < before->sensor_out_rms);
    return worse && c->result.mode_out_rms > 2 * frequency_noise(&engine->states) && no_better;
}

/* frequencies whose noise is larger than stated, as a candidate among the others */
static void add_noise(const struct before *before, struct diagnosis_round *round)
{
    struct candidate *c = &round->candidate[round->ncandidate];
    double drop = noise_drop(before);
    if (!(drop > round->result.threshold / 2))
        return;
    *c = candidate_blank(catalogue_find("noise_level"), "FREQUENCY");
    c->nparameter = 1;
    c->result.refitted = 1;
    c->result.predicted_drop = c->result.chi2_drop = drop;
    c->result.chi2 = before->chi2 - drop;
    c->result.chi2_frequency = before->nfrequency;
    c->result.bic = before->chi2 - drop + log(before->dof);
    c->effect.value[0] = sqrt(before->chi2_frequency / before->nfrequency);
    round->ncandidate++;
}

/* |r - r'|^2 of two candidates, INFINITY where it is not known. */
static double apart(const struct candidate *a, const struct candidate *b)
{
    double sum = 0;
    if (!a->residual || !b->residual || a->nresidual != b->nresidual)
        return INFINITY;
    for (int i = 0; i < a->nresidual; i++)
        sum += (b->residual[i] - a->residual[i]) * (b->residual[i] - a->residual[i]);
    return sum;
}

/* Whether a rival stands where it turns into the best one: a zone at an interface or inside a group, a spring at a support. */
static int is_at_limit(const struct rotor *rotor, const struct candidate *best, const struct candidate *c)
{
    const struct cause_kind *cause = c->cause;
    double from, to, near = ONE_PLACE * rotor_length(rotor);
    if (!best->cause->limit_of || strcmp(best->cause->limit_of, cause->id) != 0)
        return 0;
    if (cause->width >= 0)
        near = fmax(near, c->effect.value[cause->width]);
    if (best->cause->target == TARGET_SPRING) {
        from = to = rotor->spring[best->effect.target].position;
    } else {
        rotor_group_span(rotor, best->effect.target, &from, &to);
        from = best->cause->target == TARGET_INTERFACE ? to : from;
    }
    return c->effect.value[cause->place] > from - near && c->effect.value[cause->place] < to + near;
}

/* Whether a rival is the best one over again with more parameters, such as a zone so narrow that it is the joint beside it: it
 * stands where it turns into that, and both predict the same, |r - r'|^2 being no more than what parameters without effect gain
 * in 95 % of tests and little of the drop. As a rival that contains the best one it could never lose to it by more than its
 * parameters cost, and chance seldom puts it just there. Another cause that predicts the same is a rival, whatever its
 * parameters. */
static int is_twin(const struct rotor *rotor, const struct candidate *best, const struct candidate *c)
{
    int more = free_parameters(c) - free_parameters(best);
    double distance = apart(best, c);
    if (more < 1 || best->with || c->with || !is_at_limit(rotor, best, c))
        return 0;
    return chi_square_tail(distance, more) > 0.05 && distance < SAME * best->result.chi2_drop;
}

/* Whether c is a cause in one state alone of which these data cannot tell that it is not in the others: both predict the same.
 * What is there does not go by itself, so it is in all of them. */
static int is_in_all(const struct candidate *all, const struct candidate *c)
{
    if (all->with || c->with || all->state >= 0 || c->state < 0 || all->cause != c->cause ||
        all->effect.target != c->effect.target || all->effect.variant != c->effect.variant)
        return 0;
    double distance = apart(all, c);
    return distance < SAME * all->result.chi2_drop && chi_square_tail(distance, 1) > 0.05;
}

int candidate_is(const struct candidate *a, const struct candidate *b)
{
    return a->cause == b->cause && a->effect.target == b->effect.target && a->state == b->state;
}

int candidate_has(const struct candidate *set, const struct candidate *cause)
{
    return candidate_is(set, cause) || (set->with && candidate_has(set->with, cause));
}

/* Pairs that cannot be told apart name what all of them have, and the next round asks for the rest: the candidate of that cause
 * alone becomes the set. Only a cause without a place is known to be the same in all. 1 where there is one. */
static int name_common(struct diagnosis_round *round)
{
    for (int i = round->result.set; i < round->ncandidate; i++) {
        struct candidate c = round->candidate[i];
        int common = !c.with && !c.refused && isfinite(c.result.chi2) && c.cause->class == CAUSE_PHYSICAL && c.cause->place < 0;
        for (int s = 0; s < round->result.set; s++)
            common &= candidate_has(&round->candidate[s], &c);
        if (!common)
            continue;
        for (int s = 0; s < round->result.set; s++)
            round->candidate[s].result.rejected_because = "has what is named; what else it has is for the next round";
        memmove(&round->candidate[1], &round->candidate[0], (size_t)i * sizeof c);
        c.result.rejected_because = NULL;
        round->candidate[0] = c;
        round->result.set = 1;
        return 1;
    }
    return 0;
}

int decide(const struct engine *engine, const struct before *before, struct diagnosis_round *round)
{
    struct pool *pool = engine->pool;
    add_noise(before, round);
    struct candidate *best = NULL;
    int *doubted = POOL_ARRAY(pool, int, round->ncandidate + 1);
    if (!doubted)
        return ROTID_ERROR_MEMORY;
    double left_frequency = 0, predicts = INFINITY, alone = INFINITY, noise = frequency_noise(&engine->states);
    for (int i = 0; i < round->ncandidate; i++)
        if (round->candidate[i].result.refitted && !round->candidate[i].with)
            alone = fmin(alone, round->candidate[i].result.chi2);
    for (int i = 0; i < round->ncandidate; i++) {
        struct candidate *c = &round->candidate[i];
        c->result.rejected_because = reason(engine, before, round->result.threshold, alone, c);
        doubted[i] = !c->result.rejected_because && is_doubted(engine, before, c);
        if (doubted[i])
            c->result.rejected_because =
                pool_format(pool, "the prediction of modes left out in turn gets worse: %.2g %% after %.2g %%",
                            c->result.mode_out_rms, before->mode_out_rms);
        if (!c->result.rejected_because && c->result.chi2_drop > round->result.threshold && isfinite(c->result.holdout_rms))
            predicts = fmin(predicts, c->result.holdout_rms);
    }
    for (int i = 0; i < round->ncandidate; i++) {
        struct candidate *c = &round->candidate[i];
        double more =
            c->result.holdout_rms * c->result.holdout_rms - predicts * predicts; /* beyond what noise makes of two predictions */
        if (!c->result.rejected_because && isfinite(c->result.holdout_rms) && predicts < BETTER * c->result.holdout_rms &&
            more > noise * noise)
            c->result.rejected_because =
                pool_format(pool, "predicts the modes held out worse (%.2g %%) than another one does (%.2g %%)",
                            c->result.holdout_rms, predicts);
        if (!c->result.rejected_because && c->result.chi2_drop > round->result.threshold &&
            (!best || candidate_score(c) < candidate_score(best))) {
            best = c;
            left_frequency = c->result.chi2_frequency;
        }
    }
    for (int i = 0; i < round->ncandidate && best; i++)
        if (!round->candidate[i].result.rejected_because && is_in_all(&round->candidate[i], best))
            best = &round->candidate[i];
    double doubt = engine->coloured ? COLOURED : 1;
    round->result.required_margin = best ? LEAST_MARGIN * doubt * dispersion(before, best, left_frequency) : NAN;
    for (int i = 0; i < round->ncandidate; i++)
        round->candidate[i].refused = round->candidate[i].result.rejected_because != NULL;
    double limit = best ? candidate_score(best) + round->result.required_margin : 0;
    const char *name = best ? candidate_label(pool, best) : "";
    if (!name)
        return ROTID_ERROR_MEMORY;
    round->result.set = 0;
    int refused = 0; /* something refused for its size explains the data better than what is left */
    for (int i = 0; i < round->ncandidate && best; i++) {
        struct candidate *c = &round->candidate[i];
        if (c->result.refitted && c->result.at_bound && (!c->with || c->explains) && candidate_score(c) < candidate_score(best))
            refused = 1;
        if (doubted[i] && candidate_score(c) <= limit) { /* it cannot be named, and keeps the best one from that */
            c->result.rejected_because = NULL;
            c->refused = 0;
        }
        if (c->result.rejected_because)
            continue;
        if (is_in_all(best, c)) {
            c->result.rejected_because =
                pool_format(pool, "is %s, of which these data cannot tell that it is in one state alone", name);
            c->refused = 1;
        } else if (c != best && candidate_score(c) <= limit && is_twin(&engine->states.state[best->home].job.rotor, best, c)) {
            c->result.rejected_because = pool_format(pool, "is %s over again, with more parameters", name);
            c->refused = 1;
        } else if (candidate_score(c) <= limit)
            round->result.set++;
        else if (!(c->result.chi2_drop > round->result.threshold))
            c->result.rejected_because = chance(pool, c);
        else
            c->result.rejected_because =
                pool_format(pool, "loses to %s by %.3g", name, candidate_score(c) - candidate_score(best));
    }
    for (int i = 0; i < round->ncandidate && !best; i++)
        if (!round->candidate[i].result.rejected_because)
            round->candidate[i].result.rejected_because = chance(pool, &round->candidate[i]);
    for (int i = 0; i < round->ncandidate; i++) /* the set first, in the order of the scores */
        if (!round->candidate[i].result.rejected_because && round->candidate[i].result.refitted)
            round->candidate[i].result.refitted = 2;
    qsort(round->candidate, (size_t)round->ncandidate, sizeof *round->candidate, compare);
    for (int i = 0; i < round->ncandidate; i++)
        round->candidate[i].result.refitted = round->candidate[i].result.refitted != 0;
    /* the model as it is counts as one more rival, and noise that happens to look like one cause is the rule among weak ones */
    const struct candidate *first = &round->candidate[0];
    int weak =
        round->result.set &&
        (before->chi2 - before->beyond_drop + PARAMETER_PENALTY <= limit || /* a bound of the deck may be all that is wrong */
         !(first->result.chi2_drop > CLEAR * round->result.threshold) ||    /* or its place is open, or little is left over */
         first->linear || first->other_chi2 - first->result.chi2 < round->result.required_margin ||
         before->dof - free_parameters(first) < (first->explains || first->with ? 1 : 2) * LEAST_RESIDUALS);
    round->result.kind = round->result.set == 0                                                               ? ROTID_UNEXPLAINED
                         : round->result.set > 1 || !engine->out->result.verdict.confident || refused || weak ? ROTID_AMBIGUOUS
                         : round->candidate[0].cause->class != CAUSE_PHYSICAL                                 ? ROTID_UNEXPLAINED
                                                                                                              : ROTID_NAMED;
    if (round->result.set > 1 && round->candidate[0].with && engine->out->result.verdict.confident && !refused && !weak &&
        name_common(round))
        round->result.kind = ROTID_NAMED;
    return ROTID_OK;
}
