/* From rounds to a verdict: causes are accepted one by one, doubted again together, and withdrawn where what is left unexplained
 * outweighs what they were named for. */
#include "diagnose/diagnose.h"

#include <math.h>
#include <string.h>

#include "modal/modal.h"
#include "model/model.h"

/* Which measurement would settle an ambiguity: the models that cannot be told apart by these data are asked for what was not
 * measured yet, and where they differ most against the noise. */

#define MORE_MODES 3 /* above the highest measured one */

struct future { /* of one model */
    int count;
    double hz[32];
};

/* Where two models can be told apart: a mode that was not measured, in one of the states. */
struct difference {
    int state, mode;     /* from 0 */
    double hz[2], apart; /* in standard deviations of a measured frequency there */
};

/* Frequencies of the model of a refit in one state up to some modes beyond those measured. */
static int foresee(struct pool *pool, const struct job *job, const double *x, int count, struct future *future)
{
    struct rotor_model model;
    struct prediction p;
    int failed, status = model_open(pool, job->models, &job->rotor, job->unknowns.nparameter, job->unknowns.parameter, 1, &model,
                                    &failed);
    future->count = count;
    if (!status)
        status =
            prediction_new(pool, &model.equations, ROTID_REDUCTION_NONE, ROTID_NELSON, model.equations.nrigid + count, 0, &p);
    if (!status)
        status = prediction_compute(&p, x);
    for (int k = 0; k < count && !status; k++)
        future->hz[k] = prediction_hz(&p, model.equations.nrigid + k);
    return status;
}

static double typical_noise(const struct job *job)
{
    double sum = 0;
    for (int k = 0; k < job->measurement.nmode; k++)
        sum += job->measurement.frequency_std[k] * job->measurement.frequency_std[k];
    return sqrt(sum / job->measurement.nmode);
}

/* What the shapes lack, as the beginning of a sentence; "" where they are fitted. */
static const char *shapes_missing(const struct job *job)
{
    if (job_fits_shapes(job))
        return "";
    return job->measurement.shape ? "state the noise of the shapes (*NOISE, SHAPE=), so that they count; "
                                  : "measure mode shapes (some 30 points or more along the rotor, *NOISE, SHAPE=); ";
}

static const char *sentence(struct engine *engine, const struct candidate *first, const struct candidate *second,
                            const struct difference *difference)
{
    const struct state *state = &engine->states.state[difference->state];
    const struct job *job = &state->job;
    struct pool *pool = engine->pool;
    const char *shapes = shapes_missing(job);
    const char *one = candidate_label(pool, first), *two = candidate_label(pool, second);
    if (!one || !two)
        return NULL;
    if (difference->apart < 1)
        return pool_format(pool, "%smore modes will not separate %s from %s; %s", shapes, one, two, first->cause->check);
    return pool_format(pool,
                       "%smeasure mode %d%s%s: %.6g Hz if it is %s, %.6g Hz if it is %s (%.1f standard deviations apart); or %s",
                       shapes, difference->mode + 1, state->name ? " of state " : "", state->name ? state->name : "",
                       difference->hz[0], one, difference->hz[1], two, difference->apart, first->cause->check);
}

static int highest_mode(const struct job *job, const int *number)
{
    int highest = 0;
    for (int k = 0; k < job->measurement.nmode; k++)
        highest = number[k] > highest ? number[k] : highest;
    return highest;
}

/* The largest difference of two models in state s, whose measured modes have `number` and `holdout`, where it is more than
 * `most`. */
static void find_difference(const struct job *job, int s, const int *number, const int *holdout, const struct future future[2],
                            int modes, struct difference *most)
{
    double noise = typical_noise(job);
    for (int k = 0; k < modes; k++) {
        int measured = 0;
        for (int m = 0; m < job->measurement.nmode; m++)
            measured |= number[m] == k + 1 && !holdout[m];
        double apart = fabs(future[0].hz[k] - future[1].hz[k]) / (noise * future[0].hz[k]);
        if (!measured && apart > most->apart)
            *most = (struct difference){s, k, {future[0].hz[k], future[1].hz[k]}, apart};
    }
}

/* Where two models differ most in the frequencies of all states. 0 where one of them cannot be foreseen, -1 where memory is out.
 */
static int compare_two(struct engine *engine, const struct possible *model, struct difference *most)
{
    const struct states *states = &engine->states;
    *most = (struct difference){0};
    for (int s = 0, mode = 0; s < states->nstate; mode += states->state[s].job.measurement.nmode, s++) {
        struct future future[2];
        int known = 1, top = highest_mode(&states->state[s].job, engine->number + mode) + MORE_MODES, modes = top < 32 ? top : 32;
        for (int m = 0; m < 2 && known; m++) {
            struct pool scratch;
            pool_open(&scratch, engine->pool->allocator);
            const struct state *state = &model[m].states->state[s];
            double *x = state_values(&scratch, state, model[m].x);
            int status = x ? foresee(&scratch, &state->job, x, modes, &future[m]) : ROTID_ERROR_MEMORY;
            pool_close(&scratch);
            known = !status;
            if (status == ROTID_ERROR_MEMORY)
                return -1;
        }
        if (known)
            find_difference(&states->state[s].job, s, engine->number + mode, engine->holdout + mode, future, modes, most);
    }
    return 1;
}

const char *advise_between(struct engine *engine, int count, const struct possible *model)
{
    struct difference most;
    if (count < 2)
        return pool_format(engine->pool, "%smore modes and more points along the rotor; %s", shapes_missing(engine->job),
                           count ? model[0].cause->cause->check
                                 : "the geometry, masses and materials of the deck are worth checking");
    return compare_two(engine, model, &most) < 0 ? NULL : sentence(engine, model[0].cause, model[1].cause, &most);
}

/* The measurement that separates the members of an ambiguous set best; last: the fits of that round, NULL where they are gone.
 * NULL where memory is out. */
static const char *advise(struct engine *engine, const struct diagnosis_round *round, const struct round_result *last)
{
    struct possible model[2] = {{0}};
    int count = 0, set = round->result.set > 1 ? round->result.set : 2;
    for (int i = 0; last && i < round->ncandidate && i < set && count < 2; i++)
        if (round->candidate[i].refit >= 0) {
            const struct refit *refit = &last->refit[round->candidate[i].refit];
            model[count++] = (struct possible){&round->candidate[i], &refit->states, refit->fit->x};
        }
    return advise_between(engine, round->result.set ? count : count > 1 ? 1 : count, model);
}

#define MANY          3 /* causes that together still leave something imitate what none of them is */
#define ONE_PARAMETER 2 /* of chi2: a parameter that gains less is worth none */

/* Adds what an approximate cause leaves to the noise, and says so. */
static int add_discrepancy(struct engine *engine, const struct candidate *c, struct states *states)
{
    const struct cause_kind *cause = c->cause;
    message_add(engine->notes, SEVERITY_WARNING, NULL, 0, 0,
                "%s is an approximation: %.2g %% of the frequencies and %.2g %% of the largest component of the shapes are added "
                "to the noise behind it, in later rounds, in the extended model and its intervals",
                cause->id, 100 * cause->discrepancy_frequency, 100 * cause->discrepancy_shape);
    return discrepancy_add(engine->pool, c, 1, states);
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
        if (!discrepancy_of(c->cause))
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

/* Whether one of two causes does alone what the pair does. */
static int adds_nothing(const struct diagnosis_round *round, const struct candidate *pair)
{
    for (const struct candidate *member = pair; member && pair->with; member = member->with)
        for (int i = 0; i < round->ncandidate; i++) {
            const struct candidate *alone = &round->candidate[i];
            if (!alone->with && alone->result.refitted && candidate_is(alone, member) &&
                alone->result.chi2_drop > pair->result.chi2_drop - ONE_PARAMETER)
                return 1;
        }
    return 0;
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
            taken[i] = at_bound ? near && c->result.at_bound && !adds_nothing(round, c)
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

/* The states of the base with all named causes but one, their data as they are now, but without what that one leaves. */
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
    return status ? status : discrepancy_add(engine->pool, &out->cause[left_out], -1, states);
}

/* What a round says without a cause that was named. */
struct doubt {
    int cause;           /* its number, or -1 */
    int alone;           /* it is the only doubtful one of two, and the other one stays named without it */
    struct engine other; /* without it: its states and their fit */
    struct diagnosis_round round;
    struct round_result result;
};

static void doubt_free(struct doubt *d)
{
    round_free(&d->result);
    rotid_fit_free(d->other.fit);
    d->other.fit = NULL;
}

/* The round without cause number `cause`. */
static int doubt_cause(struct engine *engine, int cause, struct doubt *d)
{
    struct diagnosis *out = engine->out;
    rotid_fit_result *fit = NULL;
    struct engine *other = &d->other;
    *d = (struct doubt){.cause = cause, .other = *engine};
    other->fit = NULL;
    int status = states_without(engine, cause, &other->states);
    if (!status)
        status = refit_states(engine->pool, &other->states, engine->number, engine->holdout, engine->environment, &fit);
    if (!status && fit_at_bound(fit, engine->nown)) /* with all causes it may lie elsewhere */
        status = refit_again(engine->pool, &other->states, engine->nown, engine->fit->x, engine->number, engine->holdout,
                             engine->environment, &fit);
    other->fit = fit;
    if (!status)
        status = states_started_at(engine->pool, &other->states, fit->x, &other->states);
    other->job = &other->states.state->job;
    if (!status)
        status = round_run(other, &d->round, &d->result); /* which may put another fit in its place */
    engine->clock = other->clock;
    engine->coloured = other->coloured;
    engine->job->measurement.correction =
        out->judged.state->job.measurement.correction; /* noise that was raised there is raised here: the data are the same */
    engine->job->measurement.ncorrection = out->judged.state->job.measurement.ncorrection;
    return status;
}

/* Alone, or with another one that follows what an approximation leaves. */
static int is_named(const struct doubt *d, const struct candidate *c)
{
    const struct candidate *named = &d->round.candidate[0];
    return d->round.result.kind == ROTID_NAMED && candidate_has(named, c);
}

/* Whether the other one of two stays named: where beside it nothing is missing any more, since the noise has what it leaves as an
 * approximation; and, both having been chosen together, where it is in question only what comes beside it, the doubtful one being
 * in the set. */
static int other_stays(const struct diagnosis *out, const struct doubt *d, int together)
{
    int stays = d->round.result.kind == ROTID_ADEQUATE;
    for (int i = 0; i < d->round.result.set && d->round.result.kind == ROTID_AMBIGUOUS && together; i++)
        stays |= !d->round.candidate[i].with && candidate_is(&d->round.candidate[i], &out->cause[d->cause]);
    return stays && out->ncause == 2;
}

/* With two causes or more each is doubted again in the presence of the others, but one that was named last and alone: a first
 * cause may have been the best single stand-in for two. *found: the first one that is not named again. */
static int confirm(struct engine *engine, struct doubt *found)
{
    struct diagnosis *out = engine->out;
    const struct diagnosis_round *last = out->round; /* that named something */
    for (int r = 0; r < out->nround; r++)
        last = out->round[r].result.kind == ROTID_NAMED ? &out->round[r] : last;
    int status = ROTID_OK, together = last->candidate[0].with != NULL, doubted = together ? out->ncause : out->ncause - 1;
    *found = (struct doubt){.cause = -1};
    for (int c = 0; c < doubted && !status && (found->cause < 0 || found->alone); c++) {
        struct doubt d;
        if (together && c &&
            candidate_is(&out->cause[c], &out->cause[0])) /* the model without the one is that without the other */
            continue;
        status = doubt_cause(engine, c, &d);
        if (status || is_named(&d, &out->cause[c])) {
            doubt_free(&d);
        } else if (found->cause >= 0) {
            found->alone = 0;
            doubt_free(&d);
        } else {
            *found = d;
            found->alone = other_stays(out, found, together);
        }
    }
    return status;
}

/* Takes one name back: the model is the one without it. */
static void take_back(struct engine *engine, struct doubt *d, struct round_result *last)
{
    struct diagnosis *out = engine->out;
    for (int c = d->cause; c + 1 < out->ncause; c++)
        out->cause[c] = out->cause[c + 1];
    out->ncause--;
    if (engine->fit != out->base.fit)
        rotid_fit_free(engine->fit);
    engine->fit = d->other.fit;
    engine->states = d->other.states;
    engine_look_at(engine, 0);
    engine->job->measurement.correction = out->judged.state->job.measurement.correction;
    engine->job->measurement.ncorrection = out->judged.state->job.measurement.ncorrection;
    round_free(last);
    *last = d->result;
    d->other.fit = NULL;
    d->result.nrefit = 0;
    out->result.verdict.kind = ROTID_NAMED;
    out->result.verdict.adequate_after = d->round.result.kind == ROTID_ADEQUATE;
}

/* The set of a doubt, and what to measure for it. */
static int open_doubt(struct engine *engine, const struct doubt *d, const struct round_result *result)
{
    double margin = d->round.result.required_margin;
    int status = take_set(engine, &d->round, isfinite(margin) ? margin : 0);
    if (status || engine->out->result.verdict.adequate_after)
        return status;
    if (!engine->out->nalternative && !engine->out->ncause)
        engine->out->result.verdict.kind = ROTID_UNEXPLAINED;
    engine->out->result.verdict.next_measurement = advise(engine, &d->round, result);
    return engine->out->result.verdict.next_measurement ? ROTID_OK : ROTID_ERROR_MEMORY;
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
    double excess = left_over(end);
    int status = ROTID_OK;
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
        struct doubt found;
        status = confirm(engine, &found);
        int doubtful = found.cause >= 0, alone = doubtful && found.alone;
        if (!status && alone)
            take_back(engine, &found, last);
        else if (!status && doubtful)
            withdraw(out);
        if (!status && doubtful)
            status = open_doubt(engine, &found, alone ? last : &found.result);
        if (doubtful)
            doubt_free(&found);
        if (status || doubtful)
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
