/* From rounds to a verdict: causes are accepted one by one, doubted again together, and withdrawn where what is left unexplained
 * outweighs what they were named for. */
#include <math.h>
#include <string.h>

#include "diagnose/advice.h"
#include "diagnose/decide.h"
#include "diagnose/refit.h"
#include "diagnose/round.h"
#include "diagnose/verdict.h"

#define MANY 3 /* causes that together still leave something imitate what none of them is */

/* What a cause that is an approximation leaves, added to the noise of a job. */
static int add_to_noise(struct engine *engine, const struct cause_kind *cause, struct job *job)
{
    ptrdiff_t components = (ptrdiff_t)job->rotor.nsensor * job->measurement.nmode;
    double *std = POOL_ARRAY(engine->pool, double, job->measurement.nmode);
    if (!std)
        return ROTID_ERROR_MEMORY;
    for (int k = 0; k < job->measurement.nmode; k++)
        std[k] = hypot(job->measurement.frequency_std[k], cause->discrepancy_frequency);
    job->measurement.frequency_std = std;
    if (!job->measurement.shape || !(cause->discrepancy_shape > 0))
        return ROTID_OK;
    double *shapes = POOL_ARRAY(engine->pool, double, components);
    if (!shapes)
        return ROTID_ERROR_MEMORY;
    for (ptrdiff_t i = 0; i < components; i++)
        shapes[i] = hypot(job->measurement.shape_std[i], cause->discrepancy_shape);
    job->measurement.shape_std = shapes;
    return ROTID_OK;
}

/* The same of the states in which it acts, and says so. */
static int add_discrepancy(struct engine *engine, const struct candidate *c, struct states *states)
{
    const struct cause_kind *cause = c->cause;
    int status = ROTID_OK;
    message_add(engine->notes, SEVERITY_WARNING, NULL, 0, 0,
                "%s is an approximation: %.2g %% of the frequencies and %.2g %% of the largest component of the shapes are added "
                "to the noise behind it, in later rounds, in the extended model and its intervals",
                cause->id, 100 * cause->discrepancy_frequency, 100 * cause->discrepancy_shape);
    for (int s = 0; s < states->nstate && !status; s++)
        if (c->in[s])
            status = add_to_noise(engine, cause, &states->state[s].job);
    return status;
}

/* A size that was found only where the bounds had been widened. */
static void note_size(const struct engine *engine, const struct candidate *c)
{
    double lower, upper, size = c->effect.value[c->cause->size];
    if (!(c->effect.bound[0] < c->effect.bound[1]))
        return;
    c->cause->bounds(&engine->states.state[c->home].job.rotor, &c->effect, c->cause->size, &lower, &upper);
    if (size < lower || size > upper)
        message_add(engine->notes, SEVERITY_NOTE, NULL, 0, 0,
                    "%s: %s %.3g lies outside the usual bounds, %.3g to %.3g; it was looked for from %.3g to %.3g", c->cause->id,
                    c->effect.kind->parameter[c->cause->size].name, size, lower, upper, c->effect.bound[0], c->effect.bound[1]);
}

/* The winner of a round becomes part of the model, with what it leaves as an approximation added to the noise. */
int accept_cause(struct engine *engine, const struct diagnosis_round *round, struct round_result *result)
{
    struct diagnosis *out = engine->out;
    struct refit *refit = &result->refit[round->candidate[0].refit];
    struct states states = refit->states;
    int approximate = 0, status = ROTID_OK;
    if (engine->fit != out->base.fit)
        rotid_fit_free(engine->fit);
    engine->fit = refit->fit;
    refit->fit = NULL;
    for (const struct candidate *c = &round->candidate[0]; c && !status; c = c->with) {
        out->cause[out->ncause] = *c;
        out->cause[out->ncause++].with = NULL;
        note_size(engine, c);
        if (!(c->cause->discrepancy_frequency > 0 || c->cause->discrepancy_shape > 0))
            continue;
        approximate = 1;
        status = add_discrepancy(engine, c, &states);
    }
    if (!status && approximate) {
        rotid_fit_result *fit = NULL;
        status = refit_states(engine->pool, &states, engine->number, engine->holdout, engine->environment, &fit);
        if (!status) {
            rotid_fit_free(engine->fit);
            engine->fit = fit;
        }
    }
    if (status)
        return status;
    status = states_started_at(engine->pool, &states, engine->fit->x, &engine->states);
    if (!status)
        engine_look_at(engine, 0);
    return status;
}

/* Excess of a chi2 over its expectation, where noise makes it that large less than once in a hundred times. */
static double beyond_noise(double chi2, double dof)
{
    return chi2 > dof + 2.33 * sqrt(2 * dof) ? chi2 - dof : 0;
}

/* Evidence that is left when nothing more can be named: how far the best model that could be tried is from the data: by the whole
 * chi2, by the frequencies, and by the scan. */
static double left_over(const struct diagnosis_round *last)
{
    double chi2 = last->result.chi2, frequency = last->result.chi2_frequency, f = last->result.frequencies;
    if (last->result.kind == ROTID_ADEQUATE)
        return 0;
    for (int i = 0; i < last->ncandidate && last->result.kind == ROTID_AMBIGUOUS; i++)
        if (last->candidate[i].result.refitted && last->candidate[i].cause->class == CAUSE_PHYSICAL &&
            last->candidate[i].result.chi2 < chi2) {
            chi2 = last->candidate[i].result.chi2;
            frequency = last->candidate[i].result.chi2_frequency;
        }
    double whole = beyond_noise(chi2, last->result.dof), block = beyond_noise(frequency, f);
    double scan =
        last->result.kind == ROTID_UNEXPLAINED && last->result.largest > last->result.threshold ? last->result.largest : 0;
    return fmax(scan, fmax(whole, block));
}

/* Whether no single cause of the last round explains what is left: two more, or nothing of the catalogue, and then what was named
 * before may as well stand in for what is not in it. */
static int is_beyond_one(const struct diagnosis_round *last)
{
    double least = last->result.chi2;
    for (int i = 0; i < last->ncandidate; i++)
        if (last->candidate[i].result.refitted && !last->candidate[i].with && last->candidate[i].cause->class == CAUSE_PHYSICAL)
            least = fmin(least, last->candidate[i].result.chi2);
    return last->result.kind == ROTID_AMBIGUOUS && beyond_noise(least, last->result.dof) > 0;
}

/* By how much the named cause of a round beats the best of the others. */
static double margin_of(const struct diagnosis_round *round)
{
    const struct candidate *first = &round->candidate[0];
    double margin = INFINITY;
    for (int i = 1; i < round->ncandidate; i++) {
        const struct candidate *c = &round->candidate[i];
        if (c->result.refitted && isfinite(c->result.chi2) && !c->refused)
            margin = fmin(margin, candidate_score(c) - candidate_score(first));
    }
    return margin;
}

/* The candidates of a round that lie within `margin` of the first, those refused for their size alone behind the others. One may
 * be alone: what keeps it from a name is then not another one. */
static int take_set(struct engine *engine, const struct diagnosis_round *round, double margin)
{
    struct diagnosis *out = engine->out;
    int *taken = POOL_ARRAY(engine->pool, int, round->ncandidate + 1);
    out->alternative = POOL_ARRAY(engine->pool, struct candidate, 2 * (size_t)round->ncandidate + 1);
    int sets = 0;
    if (!out->alternative || !taken)
        return ROTID_ERROR_MEMORY;
    out->nalternative = 0;
    for (int at_bound = 0; at_bound < 2; at_bound++)
        for (int i = 0; i < round->ncandidate; i++) {
            const struct candidate *c = &round->candidate[i];
            if (taken[i] || !c->result.refitted || !(c->result.chi2_drop > round->result.threshold / 2))
                continue;
            int near = candidate_score(c) - candidate_score(&round->candidate[0]) <= margin;
            taken[i] = at_bound ? near && c->result.at_bound
                                : i < round->result.set || (near && !c->refused && c->result.chi2_drop > round->result.threshold);
            sets += taken[i];
            for (const struct candidate *member = c; taken[i] && member; member = member->with) {
                struct candidate *listed = &out->alternative[out->nalternative++];
                *listed = *member;
                listed->with = NULL;
                listed->set = sets;
            }
        }
    return ROTID_OK;
}

static int same_cause(const struct candidate *a, const struct candidate *b)
{
    return a->cause == b->cause && a->effect.target == b->effect.target && a->state == b->state;
}

/* The states of the base with all named causes but one, their data as they are now. */
static int states_without(struct engine *engine, int left_out, struct states *states)
{
    struct diagnosis *out = engine->out;
    int status = states_started_at(engine->pool, &out->judged, out->base.fit->x, states);
    for (int c = 0; c < out->ncause && !status; c++)
        if (c != left_out)
            status = states_with_effect(engine->pool, states, NULL, &out->cause[c].effect, out->cause[c].cause,
                                        out->cause[c].fixed, out->cause[c].in, states);
    for (int s = 0; s < states->nstate && !status; s++) {
        states->state[s].job.measurement.frequency_std = engine->states.state[s].job.measurement.frequency_std;
        states->state[s].job.measurement.shape_std = engine->states.state[s].job.measurement.shape_std;
    }
    return status;
}

/* With two causes or more each is doubted again in the presence of the others, but one that was named last and alone: a first
 * cause may have been the best single stand-in for two. *round, *result: the one in which a cause was not named again; *doubtful:
 * its index, or -1. */
static int confirm(struct engine *engine, struct diagnosis_round *round, struct round_result *result, int *doubtful)
{
    struct diagnosis *out = engine->out;
    const struct diagnosis_round *last = out->round; /* that named something */
    for (int r = 0; r < out->nround; r++)
        last = out->round[r].result.kind == ROTID_NAMED ? &out->round[r] : last;
    int status = ROTID_OK, doubted = last->candidate[0].with ? out->ncause : out->ncause - 1;
    *doubtful = -1;
    for (int c = 0; c < doubted && !status && *doubtful < 0; c++) {
        struct engine other = *engine;
        rotid_fit_result *fit = NULL;
        status = states_without(engine, c, &other.states);
        other.job = &other.states.state->job;
        if (!status)
            status = refit_states(engine->pool, &other.states, engine->number, engine->holdout, engine->environment, &fit);
        if (!status && fit_at_bound(fit, engine->nown)) /* with all causes it may lie elsewhere */
            status = refit_again(engine->pool, &other.states, engine->nown, engine->fit->x, engine->number, engine->holdout,
                                 engine->environment, &fit);
        other.fit = fit;
        if (!status)
            status = states_started_at(engine->pool, &other.states, fit->x, &other.states);
        other.job = &other.states.state->job;
        round_free(result);
        if (!status)
            status = round_run(&other, round, result);
        rotid_fit_free(other.fit); /* the round may have put another one in its place */
        engine->clock = other.clock;
        engine->coloured = other.coloured;
        engine->job->measurement.correction =
            out->judged.state->job.measurement.correction; /* noise that was raised there is raised here: the data are the same */
        engine->job->measurement.ncorrection = out->judged.state->job.measurement.ncorrection;
        if (!status && !(round->result.kind == ROTID_NAMED && same_cause(&round->candidate[0], &out->cause[c])))
            *doubtful = c;
    }
    return status;
}

/* Takes the names back: what they would have explained is open between the members of a set. */
static void withdraw(struct diagnosis *out)
{
    out->ncause = 0;
    out->result.verdict.adequate_after = 0;
    out->result.verdict.kind = ROTID_AMBIGUOUS;
}

int reach_verdict(struct engine *engine, struct round_result *last)
{
    struct diagnosis *out = engine->out;
    rotid_verdict *verdict = &out->result.verdict;
    const struct diagnosis_round *first = &out->round[0], *end = &out->round[out->nround - 1];
    struct diagnosis_round *again = POOL_ARRAY(engine->pool, struct diagnosis_round, 1);
    double excess = left_over(end);
    int status = again ? ROTID_OK : ROTID_ERROR_MEMORY, doubtful = -1;
    verdict->p_value = fmin(first->result.p_scan, fmin(first->result.p_frequency, first->result.p_total));
    verdict->adequate_after = end->result.kind == ROTID_ADEQUATE;
    for (int r = 0; r < out->nround && !status; r++) {
        const struct diagnosis_round *round = &out->round[r];
        if (round->result.kind != ROTID_NAMED)
            continue;
        int stacked = is_beyond_one(end) || (out->ncause >= MANY && !verdict->adequate_after);
        if (!stacked && (excess == 0 || margin_of(round) >= round->result.required_margin + excess))
            continue;
        withdraw(out);
        status = take_set(engine, round, round->result.required_margin + excess);
        if (!status && (!out->nalternative ||
                        out->alternative[out->nalternative - 1].set < 2)) /* none near it, yet the rest says that it is not all */
            verdict->kind = ROTID_UNEXPLAINED;
        verdict->next_measurement = advise(engine, round, NULL); /* the fits of that round are gone */
        return status || !verdict->next_measurement ? ROTID_ERROR_MEMORY : ROTID_OK;
    }
    if (!status && out->ncause > 1) {
        struct round_result result = {0};
        status = confirm(engine, again, &result, &doubtful);
        if (!status && doubtful >= 0) {
            withdraw(out);
            status = take_set(engine, again, isfinite(again->result.required_margin) ? again->result.required_margin : 0);
            if (!status && !out->nalternative)
                verdict->kind = ROTID_UNEXPLAINED;
            if (!status && !(verdict->next_measurement = advise(engine, again, &result)))
                status = ROTID_ERROR_MEMORY;
        }
        round_free(&result);
        if (status || doubtful >= 0)
            return status;
    }
    verdict->kind = out->ncause ? ROTID_NAMED : end->result.kind;
    if (!status && end->result.kind == ROTID_AMBIGUOUS)
        status = take_set(engine, end, isfinite(end->result.required_margin) ? end->result.required_margin : 0);
    if (!status && (end->result.kind == ROTID_AMBIGUOUS || end->result.kind == ROTID_UNEXPLAINED) &&
        !(verdict->next_measurement = advise(engine, end, last)))
        status = ROTID_ERROR_MEMORY;
    return status;
}
