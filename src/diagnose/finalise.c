/* The end of a diagnosis: the extended model fitted to the end, the gain on what was and was not fitted, and the verdict. */
#include "diagnose/diagnose.h"
#include "fit/fit.h"

/* Parameter p of the final fit, which belongs to the cause: its interval, unless the round found out that the fit's own says too
 * much; and a place that the fit gives no interval for has that of the scan. */
static void settle_parameter(const struct state *state, rotid_fit_result *fit, int q, struct candidate *cause)
{
    const struct job *job = &state->job;
    int component = job->unknowns.parameter[q].component, from_round = isfinite(cause->ci_lower[component]),
        p = state_unknown(state, q);
    if (isfinite(fit->std[p]) && from_round) {
        cause->std[component] = fit->std[p];
        cause->ci_lower[component] = fmax(fit->ci_lower[p], job->unknowns.bounds[q].lower);
        cause->ci_upper[component] = fmin(fit->ci_upper[p], job->unknowns.bounds[q].upper);
    } else if (from_round) {
        fit->ci_lower[p] = cause->ci_lower[component];
        fit->ci_upper[p] = cause->ci_upper[component];
        fit->identifiable[p] = 1;
    }
}

/* Takes the values of the extended model's fit into the causes of the diagnosis, with their intervals: those of the fit, but
 * where the round found that they say too much; of a place that of the profile of chi2, which goes into the fit as well. Statuses
 * of memory and cancellation only. */
static int cause_intervals(const struct engine *engine)
{
    struct diagnosis *out = engine->out;
    rotid_fit_result *fit = out->extended.fit;
    const struct profile_case profile = {.states = &out->extended_states,
                                         .fit = fit,
                                         .number = engine->number,
                                         .holdout = engine->holdout,
                                         .environment = engine->environment};
    int status = ROTID_OK;
    for (int c = 0; c < out->ncause + out->nlikely && !status; c++) {
        struct candidate *cause = &out->cause[c];
        const struct state *state = &out->extended_states.state[cause->home];
        const struct job *job = &state->job;
        int e = effect_named(state, cause->effect.name), place = cause->cause->place;
        if (e < 0)
            continue;
        effect_at(state, e, fit->x, &cause->effect);
        for (int q = 0; q < job->unknowns.nparameter; q++)
            if (job->unknowns.parameter[q].kind == PARAMETER_EFFECT && job->unknowns.parameter[q].index == e)
                settle_parameter(state, fit, q, cause);
        int p = place < 0 || cause->fixed[place] ? -1 : effect_unknown(state, e, place);
        if (p < 0)
            continue;
        status = profile_unknown(engine->pool, &profile, p, 0, NULL, NULL);
        cause->ci_lower[place] = fit->ci_lower[p];
        cause->ci_upper[place] = fit->ci_upper[p];
    }
    return status;
}

static const char *hidden_sentence(struct engine *engine, const rotid_fit_result *fit)
{
    const rotid_diagnosis *out = &engine->out->result;
    const char *text = "", *last = "";
    char figure[32];
    for (int i = 0; i < out->nhidden; i++) {
        const rotid_hidden *hidden = &out->hidden[i];
        int p = 0, first = strcmp(last, hidden->parameter) != 0; /* the one that moves it most */
        while (p < engine->nown && strcmp(engine->states.bounds[p].name, hidden->parameter) != 0)
            p++;
        last = hidden->parameter;
        if (!first || p == engine->nown || p >= fit->n || !(fabs(hidden->shift) > (fit->ci_upper[p] - fit->ci_lower[p]) / 2))
            continue;
        text = pool_text(engine->pool, "%s%s%s by %s", text, *text ? ", " : "", hidden->parameter,
                         linear_percent_text(100 * fabs(hidden->shift / fit->x[p]), figure));
    }
    return !*text ? ""
                  : pool_text(engine->pool,
                              " A cause below its detection limit may be present: beyond the intervals it may move %s.", text);
}

#define ALL_SHARES 0.99 /* of the explanations that are told */
#define LISTED     4    /* causes in a sentence: more stand in the table */
#define SEPARATE   0.7  /* correlation beyond which two parameters are known by a combination only */

static double *side(rotid_pair *pair, int is_after)
{
    return is_after ? &pair->after : &pair->before;
}

static int quality(struct engine *engine, const struct states *states, const struct identification *each,
                   const rotid_fit_result *fit, int is_after)
{
    rotid_gain *gain = &engine->out->result.gain;
    double unused, standardised, *nco_min = side(&gain->nco_min, is_after);
    fitted_errors(states, engine->holdout, fit, 0, side(&gain->frequency_rms_percent, is_after),
                  side(&gain->frequency_max_percent, is_after), side(&gain->shape_rms, is_after));
    fitted_errors(states, engine->holdout, fit, 1, side(&gain->holdout_frequency_rms_percent, is_after), &unused,
                  side(&gain->holdout_shape_rms, is_after));
    *side(&gain->chi2_per_dof, is_after) = fit->chi2_per_dof;
    for (int s = 0; s < states->nstate; s++)
        for (int k = 0; k < states->state[s].job.measurement.nmode; k++)
            if (isfinite(each[s].compared.nco[k]))
                *nco_min = fmin(isfinite(*nco_min) ? *nco_min : 2, each[s].compared.nco[k]);
    struct states started;
    int status = states_started_at(engine->pool, states, fit->x, &started);
    if (!status)
        status = modes_in_turn(engine, &started, fit, side(&gain->mode_out_frequency_rms_percent, is_after),
                               side(&gain->mode_out_shape_rms, is_after));
    return status ? status
                  : sensor_out(engine->pool, states, engine->holdout, fit, &standardised,
                               side(&gain->sensor_out_shape_rms, is_after));
}

/* "joint of core|right (flexibility 4e-10 rad/(N.m))" */
static const char *describe(struct pool *pool, const struct job_units *units, const struct candidate *c)
{
    const struct cause_kind *cause = c->cause; /* `with` is NULL in what a verdict lists; without an effect: a rival that is no
                                                  part of a model */
    const struct effect_parameter_name *name;
    const char *text = candidate_label(pool, c);
    int p = 0;
    for (; (name = !cause->effect      ? correction_parameter(cause, p)
                   : p < c->nparameter ? &cause->effect->parameter[p]
                                       : NULL);
         p++)
        text = pool_text(pool, "%s%s%s %s", text, p ? ", " : " (", name->name,
                         job_value_text(pool, units, 3, c->effect.value[p], name->unit));
    return p ? pool_text(pool, "%s)", text) : text;
}

static const char *list(struct pool *pool, const struct job_units *units, int count, const struct candidate *c)
{
    const char *text = "";
    int shown = count < LISTED ? count : LISTED;
    for (int i = 0; i < shown; i++) {
        int paired = i && c[i].set && c[i].set == c[i - 1].set,
            ends = i + 1 == count || (c[i].set && c[i].set == c[count - 1].set);
        text = pool_text(pool, "%s%s%s", text, !i ? "" : paired ? " with " : ends ? " and " : ", ", describe(pool, units, &c[i]));
    }
    return count > shown ? pool_text(pool, "%s and %d more", text, count - shown) : text;
}

/* "joint of core|right (flexibility 4e-10 rad/(N.m)) (72 %), nothing (8 %) and 3 more": explanations by their probability. */
static const char *shares(struct pool *pool, const struct job_units *units, const struct posterior *p)
{
    const char *text = "";
    double sum = 0;
    int count = 0;
    while (count < p->count && sum < ALL_SHARES)
        sum += p->item[count++].probability;
    int shown = count < LISTED ? count : LISTED;
    for (int i = 0; i < shown; i++) {
        const struct explanation *e = &p->item[i];
        const char *one = e->nmember ? "" : e->something_else ? "something outside of the catalogue" : "nothing";
        for (int m = 0; m < e->nmember; m++)
            one = pool_text(pool, "%s%s%s", one, m ? " with " : "", describe(pool, units, &e->member[m]));
        text = pool_text(pool, e->probability > 0.1 ? "%s%s%s%s (%.0f %%)" : "%s%s%s%s (%.2g %%)", text,
                         !i               ? ""
                         : i + 1 == count ? " and "
                                          : ", ",
                         one, e->nmember && e->something_else ? " and something else" : "", 100 * e->probability);
    }
    return count > shown ? pool_text(pool, "%s and %d more", text, count - shown) : text;
}

/* The parameter that moves most with p, -1 where none does by more than SEPARATE. */
static int partner_of(const rotid_fit_result *fit, int p)
{
    int partner = -1;
    for (int q = 0; q < fit->n; q++) {
        double rho = fabs(fit->correlation[p + (ptrdiff_t)q * fit->n]);
        if (q != p && rho > SEPARATE && (partner < 0 || rho > fabs(fit->correlation[p + (ptrdiff_t)partner * fit->n])))
            partner = q;
    }
    return partner;
}

/* Parameters of the model at the end that the data leave open, or know to little more than their size. */
static const char *open_parameters(struct engine *engine)
{
    struct diagnosis *out = engine->out;
    const struct job_units *units = &engine->states.state[0].job.units;
    const rotid_fit_result *fit = out->extended.fit ? out->extended.fit : out->base.fit;
    const rotid_parameter *parameter = out->extended.fit ? out->extended_states.bounds : out->judged.bounds;
    const char *text =
        fit->converged || fit->status == ROTID_STOP_CANCELLED
            ? ""
            : pool_text(engine->pool, " The fit ended before a minimum (%s): values and intervals are those of its last point.",
                        rotid_status_text(fit->status));
    for (int p = 0; p < fit->n && p < out->judged.nparameter; p++) {
        if (fit->at_bound[p] && out->base.fit->at_bound[p] && out->result.verdict.kind != ROTID_ADEQUATE)
            text = pool_text(engine->pool, "%s %s ends at its %s bound %s, which may be the cause itself: widen it.", text,
                             parameter[p].name, base_bound_side(engine, p),
                             job_value_text(engine->pool, units, 4, out->base.fit->x[p], parameter[p].unit));
        double half = interval_half_percent(fit->x[p], fit->ci_lower[p], fit->ci_upper[p]);
        int determined = fit->identifiable[p], partner = partner_of(fit, p);
        if (!isfinite(half) || (determined && !interval_is_wide(fit->x[p], fit->ci_lower[p], fit->ci_upper[p])))
            continue; /* no interval: it lies at a bound */
        char figure[32];
        const char *how = determined ? pool_text(engine->pool, "determine %s to %s only%s", parameter[p].name,
                                                 percent_text(half, figure), partner < 0 ? "" : ", and not separately from ")
                                     : pool_text(engine->pool, "do not determine %s%s", parameter[p].name,
                                                 partner < 0 ? "" : " separately from ");
        text = pool_text(engine->pool, "%s The data %s%s: its 95 %% interval is %s to %s.", text, how,
                         partner < 0 ? "" : parameter[partner].name,
                         job_value_text(engine->pool, units, 3, fmax(fit->ci_lower[p], parameter[p].lower), parameter[p].unit),
                         job_value_text(engine->pool, units, 3, fmin(fit->ci_upper[p], parameter[p].upper), parameter[p].unit));
        out->result.verdict.undetermined_parameters += !determined;
    }
    return text;
}

/* Misfit without a cause over that of the stated noise: of all residuals, or of the frequencies where that is more. */
static double scatter(const struct engine *engine)
{
    const rotid_round *round = &engine->out->round->result;
    return sqrt(fmax(round->chi2 / fmax(round->dof, 1), round->chi2_frequency / fmax(round->frequencies, 1)));
}

/* The same where the question is what changed: the parts of the sentence, and what it ends with. */
static const char *change_sentence(const struct engine *engine, const char *causes, const char *likely, const char *others,
                                   const char *chance, const char *end)
{
    const rotid_verdict *verdict = &engine->out->result.verdict;
    struct pool *pool = engine->pool;
    const char *from = engine->before, *to = engine->after;
    switch (verdict->kind) {
    case ROTID_ADEQUATE:
        if (verdict->p_value < BLOCK_LEVEL)
            return pool_text(pool,
                             "Between %s and %s the data differ by %.2g times what the stated noise makes (%s), and no change of "
                             "the catalogue explains that: with %.0f %% nothing changed and the noise is larger than stated.%s",
                             from, to, scatter(engine), chance, 100 * engine->out->posterior.nothing, end);
        return pool_text(pool, "Nothing changed between %s and %s that these data show (%s).%s", from, to, chance, end);
    case ROTID_NAMED:
        return pool_text(pool, "Between %s and %s changed: %s%s; %s (%s before).%s", from, to, causes, likely,
                         verdict->adequate_after ? "with this the model explains the difference of the states within the noise"
                                                 : "the rest still exceeds the noise",
                         chance, end);
    case ROTID_AMBIGUOUS:
        return pool_text(pool,
                         "The data cannot tell what changed between %s and %s (%s): %s. The probability that nothing changed "
                         "and chance did this is %s.%s",
                         from, to, chance, others, text_of_probability(pool, 2, engine->out->posterior.nothing), end);
    default:
        return pool_text(pool, "Something changed between %s and %s (%s), and with %.0f %% it is not in the catalogue: %s.%s",
                         from, to, chance, 100 * verdict->something_else, others, end);
    }
}

#define FAULTS_TOLD 3

/* What to look at first where nothing of the catalogue explains the data: the weight shows wrong diameters, bores, densities. */
static const char *weigh_first(const struct engine *engine)
{
    const struct weighed *weighed = &engine->states.state[0].job.measurement.weighed;
    double mass = engine->out->base.mass.mass;
    if (!(weighed->mass_std > 0))
        return pool_text(engine->pool, " Weigh the rotor first: the model has %.4g kg.", mass);
    if (fabs(mass - weighed->mass) > ANOTHER_MASS * weighed->mass_std)
        return pool_text(engine->pool,
                         " The model has %.4g kg and the rotor %.4g kg: correct diameters, bores and densities first.", mass,
                         weighed->mass);
    return "";
}

static const char *verdict_sentence(struct engine *engine)
{
    struct diagnosis *out = engine->out;
    const rotid_verdict *verdict = &out->result.verdict;
    struct pool *pool = engine->pool;
    const struct job_units *units = &engine->states.state[0].job.units;
    const char *causes = list(pool, units, out->ncause, out->cause), *others = shares(pool, units, &out->posterior),
               *likely = out->nlikely ? list(pool, units, out->nlikely, out->cause + out->ncause) : "";
    if (out->nlikely)
        likely = pool_text(pool, ", and with %.0f %% %s", 100 * out->likely_probability, likely);
    int explained = verdict->kind == ROTID_ADEQUATE || verdict->adequate_after;
    const char *undetermined = open_parameters(engine), *faults = "", *solid = "",
               *worth = explained ? hidden_sentence(engine, out->extended.fit ? out->extended.fit : out->base.fit) : "",
               *open = pool_text(pool, "%s%s", undetermined, worth);
    for (int c = 0; c < out->ncause; c++)
        if (out->cause[c].cause->solid)
            solid =
                " The rotor is no beam: near its steps and in its short sections it bends as a beam cannot, so moduli that are "
                "identified with the beam carry the error of beam theory. Identify with *FIT, MODEL=SOLID.";
    for (int i = 0; i < out->result.ndata_findings && i < FAULTS_TOLD; i++) {
        const rotid_data_finding *found = &out->result.data_findings[i];
        faults = pool_text(pool, "%s%s%s%s%s %s", faults, i ? ";" : " In the measurement", found->state ? " of state " : "",
                           found->state ? found->state : "", found->state ? "," : "", found->text);
    }
    if (out->result.ndata_findings)
        faults = pool_text(pool, out->result.ndata_findings > FAULTS_TOLD ? "%s; and %d more." : "%s.", faults,
                           out->result.ndata_findings - FAULTS_TOLD);
    const char *chance = pool_text(pool,
                                   !isfinite(verdict->p_value) ? "no p-value can be stated"
                                   : verdict->p_value < 1e-99  ? "p below 1e-99"
                                                               : "p = %.2g",
                                   verdict->p_value);
    const char *weigh = weigh_first(engine);
    if (engine->before)
        return change_sentence(engine, causes, likely, others, chance, pool_text(pool, "%s%s%s", solid, faults, open));
    switch (verdict->kind) {
    case ROTID_ADEQUATE:
        if (verdict->p_value < BLOCK_LEVEL)
            return pool_text(pool,
                             "Nothing is wrong with %.0f %%, more than with any cause, though the misfit is larger than the "
                             "stated noise makes it (%s).%s%s",
                             100 * out->posterior.nothing, chance, faults, open);
        return pool_text(pool, "The model explains the data within their noise (%s).%s%s", chance, faults, open);
    case ROTID_NAMED:
        return pool_text(pool, "The model lacks %s%s; with %s %s (%s before).%s%s%s", causes, likely,
                         out->ncause + out->nlikely > 1 ? "these causes" : "this cause",
                         verdict->adequate_after ? "the model explains the data within their noise"
                                                 : "the residual still exceeds the noise",
                         chance, solid, faults, open);
    case ROTID_AMBIGUOUS:
        return pool_text(pool,
                         "The data cannot tell what the model lacks (%s): %s. The probability that nothing is wrong and chance "
                         "did this is %s.%s%s",
                         chance, others, text_of_probability(pool, 2, engine->out->posterior.nothing), faults, open);
    default:
        return pool_text(
            pool, "The model does not explain the data (%s), and with %.0f %% what it lacks is not in the catalogue: %s.%s%s%s",
            chance, 100 * verdict->something_else, others, weigh, faults, open);
    }
}

/* A fit that was not ended is none of the results. What the mesh of a solid is held to begins anew, as where somebody runs the
 * deck that is written of it, and stays. */
static int identify_whole(struct engine *engine, struct states *states, struct identification **each,
                          struct identification *first)
{
    struct message_list quiet;
    message_open(&quiet, engine->pool);
    for (int s = 0; s < states->nstate; s++)
        states->state[s].job.held = NULL;
    int status = base_identify(engine, states, &quiet, each, first);
    for (int s = 0; s < states->nstate && !status; s++)
        states->state[s].job.held = (*each)[s].held;
    if (status || first->fit->status != ROTID_STOP_CANCELLED)
        return status;
    rotid_fit_free(first->fit);
    first->fit = NULL;
    return ROTID_STOP_CANCELLED;
}

#define SAME_FIT                                                                                                                 \
    0.1 /* of a standard deviation, or of chi2: what moves a fit by less is no reason to change the mesh of a deck               \
         */

static int same_fit(const rotid_fit_result *a, const rotid_fit_result *b)
{
    int same = fabs(a->chi2 - b->chi2) < SAME_FIT;
    for (int p = 0; p < a->n; p++)
        same &= fabs(a->x[p] - b->x[p]) <= SAME_FIT * (isfinite(a->std[p]) ? a->std[p] : 0);
    return same;
}

/* The base again on a mesh without error: its moduli and intervals are results. */
static int refine_base(struct engine *engine)
{
    struct diagnosis *out = engine->out;
    int status = ROTID_OK, finer_mesh = 0, halvings = 0; /* as the state asks that needs most: a deck states one mesh */
    for (int s = 0, mode = 0; s < out->judged.nstate; mode += out->judged.state[s].job.measurement.nmode, s++) {
        int own = base_halvings(&out->judged.state[s].job, engine->number + mode, &out->state_base[s].spectrum);
        halvings = own > halvings ? own : halvings;
    }
    for (int s = 0; s < out->judged.nstate && !status; s++) {
        struct job *job = &out->judged.state[s].job;
        status = base_refine(engine->pool, job, halvings);
        finer_mesh |= job->rotor.segment != engine->states.state[s].job.rotor.segment;
    }
    if (status || !finer_mesh)
        return status;
    struct identification finer, *each;
    status = identify_whole(engine, &out->judged, &each, &finer);
    if (status)
        return status;
    out->mesh_suffices = same_fit(out->base.fit, finer.fit);
    for (int i = 0; i < out->result.nnumerical_findings; i++)
        out->mesh_suffices &= strcmp(out->result.numerical_findings[i].id, "mesh") != 0;
    if (engine->fit == out->base.fit)
        engine->fit = finer.fit;
    rotid_fit_free(out->base.fit);
    out->base = finer;
    out->state_base = each;
    return ROTID_OK;
}

/* A suspect that was named is part of the model now. */
static int keep_open_suspects(struct pool *pool, struct job *job)
{
    struct suspect *open = POOL_ARRAY(pool, struct suspect, job->unknowns.nsuspect);
    int count = 0;
    if (!open)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < job->unknowns.nsuspect; i++) {
        int named = 0;
        for (int e = 0; e < job->rotor.neffect; e++)
            named |= same_text(job->rotor.effect[e].name, job->unknowns.suspect[i].effect.name);
        if (!named)
            open[count++] = job->unknowns.suspect[i];
    }
    job->unknowns.suspect = open;
    job->unknowns.nsuspect = count;
    return ROTID_OK;
}

/* Whoever reads the extended deck counts its suspension modes anew: the numbers of the measured modes in it are above those. */
static int renumber(struct pool *pool, struct job *job)
{
    struct rotor rotor = job->rotor;
    struct rotor_model model;
    int failed, above, *number = POOL_ARRAY(pool, int, job->measurement.nmode);
    rotor.settled_rigid = 0;
    int status = number ? model_open(pool, job->models, &rotor, 0, NULL, 1, &model, &failed) : ROTID_ERROR_MEMORY;
    if (status || (above = job->rotor.settled_rigid - 1 - model.equations.nrigid) == 0)
        return status;
    for (int k = 0; k < job->measurement.nmode; k++)
        if ((number[k] = job->measurement.number[k] + above) < 1)
            return ROTID_OK;
    job->measurement.number = number;
    job->rotor.settled_rigid = 1 + model.equations.nrigid;
    return ROTID_OK;
}

/* The model with what was named, fitted to the end. */
static int fit_extended(struct engine *engine)
{
    struct diagnosis *out = engine->out;
    struct states *states = &out->extended_states;
    int status = states_copy(engine->pool, &engine->states, states);
    for (int s = 0; s < states->nstate && !status; s++) {
        states->state[s].job.rotor.segment = out->judged.state[s].job.rotor.segment;
        status = keep_open_suspects(engine->pool, &states->state[s].job);
    }
    if (!status)
        status = identify_whole(engine, states, &out->state_extended, &out->extended);
    if (status)
        return status;
    status = cause_intervals(engine);
    if (status)
        return status;
    status = states_started_at(engine->pool, states, out->extended.fit->x, states);
    if (!status)
        status = states_at(engine->pool, states, out->extended.fit->x, states);
    if (!status)
        status = quality(engine, states, out->state_extended, out->extended.fit, 1);
    for (int s = 0; s < states->nstate && !status; s++)
        status = renumber(engine->pool, &states->state[s].job);
    return status;
}

int finalise(struct engine *engine)
{
    struct diagnosis *out = engine->out;
    struct scan *scan = &out->last->scan;
    int status = engine_stage(engine, "final model, causes", out->ncause);
    if (!status)
        status = refine_base(engine);
    if (!status)
        status = quality(engine, &out->judged, out->state_base, out->base.fit, 0);
    if (!status && out->ncause)
        status = fit_extended(engine);
    engine_step(engine, "gain");
    if (!status && scan->ncandidate) {
        amplitudes_shown(&engine->states, scan);
        status = detectable_sizes(engine, scan);
    }
    if (!status && scan->ncandidate)
        status = hidden_shifts(engine, scan);
    engine_step(engine, "detection limits");
    if (status)
        return status;
    out->result.verdict.sentence = verdict_sentence(engine);
    return engine->pool->out_of_memory ? ROTID_ERROR_MEMORY : ROTID_OK;
}
