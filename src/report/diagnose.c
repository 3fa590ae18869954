/* A diagnosis: its tables, and `rotid diagnose` on one screen for a test engineer. */
#include <ctype.h>

#include "diagnose/causes/causes.h"
#include "fit/fit.h"
#include "report/report.h"

#define LABEL    14 /* columns before a strip */
#define BAR_HALF 14
#define MARKS    4 /* causes that are drawn */
#define SHOWN    4 /* of the others */
#define LISTED   6 /* causes of a set by which a parameter is said */

/* ---- words of causes */

/* "mass 22.22 kg (95 %: 18.96 to 25.48), z 0.8983 m (95 %: 0.8886 to 0.9080)" */
static const char *values_of(struct pool *pool, const rotid_cause *cause)
{
    const char *text = "";
    for (int p = 0; p < cause->nparameters; p++) {
        const rotid_cause_value *value = &cause->parameters[p];
        text = pool_text(pool, "%s%s%s %s", text, p ? ", " : "", value->name,
                         value->fixed ? pool_text(pool, "%s (given)", human_value(pool, value->value, value->unit))
                                      : human_interval(pool, value->value, value->ci95, value->unit));
    }
    return text;
}

static int same_cause(const rotid_cause *a, const rotid_cause *b)
{
    return !strcmp(a->id, b->id) && !strcmp(a->target, b->target) && equal_texts(a->name, b->name) &&
           equal_texts(a->state, b->state);
}

const char *candidate_fate(struct pool *pool, const rotid_diagnosis *d, const rotid_candidate *c)
{
    for (int i = 0; i < d->verdict.ncauses; i++)
        if (same_cause(&c->cause, &d->verdict.causes[i]))
            return "named";
    if (c->probability > 0)
        return pool_text(pool, c->probability > 0.1 ? "possible (%.0f %%)" : "possible (%.2g %%)", 100 * c->probability);
    return c->refitted ? "unlikely" : "not fitted";
}

/* "named; mass 22 kg (95 %: 19 to 25); at a bound" */
static const char *note_of(struct pool *pool, const rotid_diagnosis *d, const rotid_candidate *c)
{
    const char *values = c->refitted ? values_of(pool, &c->cause) : "", *text = candidate_fate(pool, d, c);
    text = pool_text(pool, "%s%s%s", text, *values ? ": " : "", values);
    if (c->at_bound)
        text = pool_text(pool, "%s; at a bound", text);
    return c->suspect ? pool_text(pool, "%s; your suspicion, a %s", text, c->cause.id) : text;
}

/* ---- tables */

static const char *p_value(struct pool *pool, double p)
{
    return p < 0.001 ? "<0.001" : human_fixed(pool, p, 3);
}

struct table *table_of_candidates(struct pool *pool, const rotid_diagnosis *d, int round, int all)
{
    int count, more = 0;
    const rotid_candidate *list = diagnosis_candidates(d, round, &count);
    const rotid_round *r = &d->rounds[round];
    struct table *table = table_open(
        pool,
        pool_text(pool,
                  "Causes one by one: expected, chi2 drop: of the misfit, chi2 %s with %d degrees of freedom, p-value of it %s, "
                  "of the frequencies %s; sensors, held out: res./sigma of those left out",
                  human_digits(pool, r->chi2, 4), r->dof, p_value(pool, r->p_total), p_value(pool, r->p_frequency)));
    for (int i = 0; i < count; i++) {
        const rotid_candidate *c = &list[i];
        if (!all && !c->suspect && i >= SHOWN) {
            more++;
            continue;
        }
        text_column(table, "cause", MAY_BE_CUT, c->suspect ? c->cause.name : c->cause.id);
        text_column(table, "target", MAY_BE_CUT, c->cause.target);
        text_column(table, "state", MAY_BE_CUT, c->cause.state);
        number_column(table, "expected", NULL, SHOW_DIGITS(4), c->predicted_drop);
        number_column(table, "chi2 drop", NULL, SHOW_DIGITS(4), c->chi2_drop);
        number_column(table, "share", "%", SHOW_DIGITS(3), 100 * c->probability);
        number_column(table, "sensors", NULL, SHOW_DIGITS(3), c->sensor_out_rms);
        number_column(table, "held out", NULL, SHOW_DIGITS(3), c->holdout_rms);
        row_note(table, note_of(pool, d, c));
    }
    if (more)
        table_note(table, "%d more with --verbose", more);
    return table;
}

static void value_row(struct table *table, const char *name, const char *by, double value, const double ci[2], const char *unit,
                      const char *remark)
{
    text_column(table, "parameter", SHOW_TEXT, name);
    unit_column(table, value, (ci[1] - ci[0]) / 2, unit);
    number_column(table, "value", ROW_UNIT, SHOW_ROW, value);
    number_column(table, "lower 95 %", ROW_UNIT, SHOW_ROW, ci[0]);
    number_column(table, "upper 95 %", ROW_UNIT, SHOW_ROW, ci[1]);
    text_column(table, "remark", SHOW_TEXT, remark);
    text_column(table, "if it is", MAY_BE_CUT, by);
}

static void fitted_row(struct table *table, const char *by, const rotid_fitted_parameter *is)
{
    value_row(table, is->name, by, is->value, is->ci95, is->unit, table ? parameter_remark(table->pool, is) : "");
}

/* Two digits of a size: more is not known of one that would have shown. */
struct table *table_of_hidden(struct pool *pool, const rotid_identification *fit, int count, const rotid_hidden *hidden)
{
    struct table *table = table_open(pool, "Possible bias: causes below their detection limits that move the parameters most");
    for (int i = 0; i < count; i++) {
        const rotid_fitted_parameter *value = fit_parameter(fit, hidden[i].parameter);
        const struct human_unit unit = human_unit(fabs(hidden[i].size), hidden[i].size_unit);
        text_column(table, "parameter", SHOW_TEXT, hidden[i].parameter);
        text_column(table, "moved by", SHOW_TEXT,
                    value ? pool_copy_text(pool, linear_percent_text(100 * fabs(hidden[i].shift / value->value), (char[32]){""}))
                          : "");
        text_column(table, "cause", SHOW_TEXT, cause_name(pool, hidden[i].id, hidden[i].target));
        text_column(table, "its size", SHOW_TEXT,
                    strcmp(hidden[i].component, "presence")
                        ? pool_text(pool, "%s %s%s%s", hidden[i].component,
                                    human_digits(pool, fabs(hidden[i].size) * unit.factor, 2), *unit.text ? " " : "", unit.text)
                        : "there or not");
        number_column(table, "z", "m", SHOW_TRIMMED(3), hidden[i].z_m);
    }
    return table;
}

/* "joint between core and right in state hot with added_mass, and something else"; "nothing is wrong" */
static const char *explanation_of(struct pool *pool, const rotid_explanation *e)
{
    const char *text = "";
    for (int i = 0; i < e->ncauses; i++) {
        const rotid_cause *cause = &e->causes[i];
        text = pool_text(pool, "%s%s%s%s%s", text, i ? " with " : "", cause_name(pool, cause->id, cause->target),
                         cause->state ? " in state " : "", or_nothing(cause->state));
    }
    if (!e->ncauses)
        return e->something_else ? "something outside of the catalogue" : "nothing is wrong";
    return e->something_else ? pool_text(pool, "%s, and something else", text) : text;
}

struct table *table_of_explanations(struct pool *pool, const rotid_diagnosis *d, int all)
{
    const rotid_verdict *v = &d->verdict;
    struct table *table = table_open(pool, "Explanations and how probable they are");
    int shown = all || v->nexplanations < LISTED ? v->nexplanations : LISTED;
    for (int i = 0; i < shown; i++) {
        const rotid_explanation *e = &v->explanations[i];
        const char *values = "";
        number_column(table, "share %", NULL, SHOW_FIXED(1), 100 * e->probability);
        if (isfinite(v->runup_p))
            number_column(table, "at rest %", NULL, SHOW_FIXED(1), 100 * e->at_rest);
        text_column(table, "explanation", SHOW_TEXT, explanation_of(pool, e));
        for (int c = 0; c < e->ncauses; c++) {
            const char *own = values_of(pool, &e->causes[c]);
            values = pool_text(pool, "%s%s%s", values, *own && c ? "; " : "", own);
        }
        row_note(table, values);
    }
    table_note(
        table,
        "Probability that nothing is wrong: %s before the data, %s after; that something is outside of the catalogue: "
        "%s.%s%s",
        text_of_probability(pool, 3, v->nothing_prior), text_of_probability(pool, 3, v->nothing),
        text_of_probability(pool, 3, v->something_else),
        isfinite(v->runup_p)
            ? pool_text(pool,
                        " The measured critical speeds count; beside the first explanation the probability of such ones is "
                        "%s.",
                        text_of_probability(pool, 2, v->runup_p))
            : "",
        shown < v->nexplanations ? pool_text(pool, " %d more share the rest up to 99 %%: --verbose", v->nexplanations - shown)
                                 : "");
    return table;
}

struct table *table_of_verdict_values(struct pool *pool, const rotid_diagnosis *d, int all)
{
    const rotid_verdict *v = &d->verdict;
    struct table *table = table_open(pool, "Parameters, 95 % intervals");
    for (int p = 0; p < d->base->nparameters; p++) {
        const rotid_fitted_parameter *base = &d->base->parameters[p], *extended = fit_parameter(d->extended, base->name);
        int of = 0; /* explanations that say it */
        if (p < d->nparameters)
            value_row(table, d->parameters[p].name, "the average of all", d->parameters[p].value, d->parameters[p].ci95,
                      d->parameters[p].unit, "");
        if (extended)
            fitted_row(table, "the extended model", extended);
        fitted_row(table, "the model of the deck", base);
        for (int i = 0; i < v->nexplanations && v->kind == ROTID_AMBIGUOUS; i++) {
            const rotid_cause_value *by = p < v->explanations[i].nidentified ? &v->explanations[i].identified[p] : NULL;
            of += by != NULL;
            if (by && (all || of <= LISTED))
                value_row(table, by->name, explanation_of(pool, &v->explanations[i]), by->value, by->ci95, by->unit,
                          isfinite(by->ci95[0]) ? "" : "at its bound");
        }
        if (of > LISTED && !all)
            table_note(table, "%d more with --verbose", of - LISTED);
    }
    for (int p = 0; d->extended && p < d->extended->nparameters; p++)
        if (!fit_parameter(d->base, d->extended->parameters[p].name))
            fitted_row(table, "the extended model", &d->extended->parameters[p]);
    return table;
}

struct table *table_of_quality(struct pool *pool, const rotid_diagnosis *d)
{
    const rotid_gain *gain = &d->gain;
    const struct {
        const rotid_pair *pair;
        const char *text;
        double factor;
    } rows[] = {{&gain->frequency_rms_percent, "frequencies fitted, error rms [%]", 1},
                {&gain->frequency_max_percent, "frequencies fitted, largest error [%]", 1},
                {&gain->shape_rms, "shapes fitted, rms of the largest component [%]", 100},
                {&gain->chi2_per_dof, "chi2 per degree of freedom", 1},
                {&gain->nco_min, "smallest NCO", 1},
                {&gain->holdout_frequency_rms_percent, "modes held out by the deck, frequency rms [%]", 1},
                {&gain->holdout_shape_rms, "modes held out by the deck, shape rms [%]", 100},
                {&gain->mode_out_frequency_rms_percent, "modes left out in turn, frequency rms [%]", 1},
                {&gain->mode_out_shape_rms, "modes left out in turn, shape rms [%]", 100},
                {&gain->sensor_out_shape_rms, "sensors left out in turn, shape rms [%]", 100}};
    struct table *table = table_open(pool, d->extended ? "Quality before and after" : "Quality of the model");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        if (!isfinite(rows[i].pair->before) && !(d->extended && isfinite(rows[i].pair->after)))
            continue;
        text_column(table, "quality", SHOW_TEXT, rows[i].text);
        number_column(table, d->extended ? "before" : "value", NULL, SHOW_DIGITS(3), rows[i].factor * rows[i].pair->before);
        if (d->extended)
            number_column(table, "after", NULL, SHOW_DIGITS(3), rows[i].factor * rows[i].pair->after);
    }
    return table;
}

/* What has no effect of a size, where that is not zero and sizes are told as they are: 90 degrees of a cone; NaN else. */
static double falls_from(const char *id)
{
    const struct cause_kind *kind = catalogue_find(id);
    int falls = kind && kind->size >= 0 && kind->size < EFFECT_MOST_PARAMETERS && kind->parameter[kind->size].one_sided < 0;
    return falls ? kind->parameter[kind->size].neutral : (double)NAN;
}

struct table *table_of_detectable(struct pool *pool, int count, const rotid_detectable *list)
{
    struct table *table =
        table_open(pool, "Detection limits: smallest size that shows in 9 tests of 10 at 3 false alarms in 100");
    for (int i = 0; i < count; i++) {
        const rotid_detectable *d = &list[i];
        int beyond = d->beyond || !isfinite(d->smallest);
        double neutral = falls_from(d->id), shown = beyond              ? (double)NAN
                                                    : isfinite(neutral) ? neutral - d->smallest
                                                                        : d->smallest;
        text_column(table, "cause", MAY_BE_CUT, d->id);
        text_column(table, "target", MAY_BE_CUT, d->target);
        text_column(table, "parameter", MAY_BE_CUT, d->parameter);
        unit_column(table, shown, NAN, d->unit);
        number_column(table, "smallest", ROW_UNIT, SHOW_DIGITS(2), shown);
        number_column(table, "at z", "m", SHOW_DIGITS(3), d->z_m);
        number_column(table, "at worst", ROW_UNIT, SHOW_DIGITS(2), d->worst);
        text_column(table, "remark", SHOW_TEXT,
                    beyond                                    ? "at no physical size"
                    : isfinite(neutral)                       ? "or less"
                    : isfinite(d->z_m) && !isfinite(d->worst) ? "not everywhere"
                                                              : "");
    }
    return table;
}

static struct table *table_of_misfit(struct pool *pool, const rotid_diagnosis *d)
{
    const rotid_identification *base = d->base;
    struct table *table = table_open(
        pool,
        pool_text(pool, "%s%s%s",
                  d->before ? pool_text(pool, "What changed: %s against the model fitted to %s, less its residuals there",
                                        d->after, d->before)
                            : "What is wrong: full model, likelihood",
                  isfinite(base->chi2) ? pool_text(pool, ", chi2 %.4g with %d degrees of freedom", base->chi2, base->dof) : "",
                  !base->nparameters                       ? "; nothing to identify"
                  : !strcmp(base->status, "not_converged") ? "; NOT CONVERGED"
                                                           : ""));
    double scale = 3; /* noise alone fills no more than the bar */
    for (int k = 0; k < base->nmodes && k < d->nmodes_standardised; k++)
        if (isfinite(d->modes_standardised[k]))
            scale = fmax(scale, ceil(fabs(d->modes_standardised[k])));
    const char *head = pool_text(pool, "%-+*.4g0%+*.4g", BAR_HALF, -scale, BAR_HALF, scale);
    for (int k = 0; k < base->nmodes; k++) {
        const rotid_compared_mode *mode = &base->modes[k];
        double standardised = k < d->nmodes_standardised ? d->modes_standardised[k] : (double)NAN;
        char bar[2 * BAR_HALF + 2];
        chart_bar(bar, BAR_HALF, scale, standardised);
        text_column(table, "state", MAY_BE_CUT, fit_state_of_mode(base, k));
        number_column(table, "mode", NULL, SHOW_COUNT, mode->mode);
        number_column(table, "measured", "Hz", SHOW_DIGITS(6), mode->measured_hz);
        number_column(table, "predicted", "Hz", SHOW_DIGITS(6), mode->predicted_hz);
        number_column(table, "error", "%", SHOW_SIGNED(3), mode->error_percent);
        number_column(table, "res./sigma", NULL, SHOW_SIGNED(1), standardised);
        text_column(table, head, SHOW_TEXT, pool_copy_text(pool, bar));
        number_column(table, "nco", NULL, SHOW_FIXED(3), mode->nco);
        text_column(table, "remark", SHOW_TEXT, mode->holdout ? "held out" : "");
    }
    return table;
}

/* ---- screen */

/* A line for each state. */
static int print_sensors(const struct screen *to, const rotid_diagnosis *d, int columns)
{
    int any = 0;
    for (int s = 0, end; s < d->nsensors; s = end) {
        char label[LABEL + 1];
        int measured = 0;
        struct strip strip = strip_open(d->geometry->length_m, columns);
        for (end = s; end < d->nsensors && equal_texts(d->sensors[s].state, d->sensors[end].state); end++) {
            strip_digits(&strip, 1, &d->sensors[end].z_m, &d->sensors[end].rms);
            measured |= isfinite(d->sensors[end].rms);
        }
        (void)snprintf(label, sizeof label, "  %.11s", d->sensors[s].state ? d->sensors[s].state : "sensors");
        if (measured)
            strip_print(&strip, to->out, LABEL, label);
        any |= measured;
    }
    return any;
}

/* The most of mere noise is no place to look at. */
static int print_localisation(const struct screen *to, const rotid_diagnosis *d, int columns)
{
    if (!d->nlocalisation || !(to->verbose || !d->verdict.sentence || d->verdict.kind != ROTID_ADEQUATE))
        return 0;
    struct strip strip = strip_open(d->geometry->length_m, columns);
    strip_density(&strip, d->nlocalisation, d->localisation);
    strip_print(&strip, to->out, LABEL, "  force resid.");
    return 1;
}

static void print_axis(const struct screen *to, const rotid_diagnosis *d)
{
    const rotid_verdict *v = &d->verdict;
    const rotid_geometry *geometry = d->geometry;
    const rotid_cause *mark = v->ncauses ? v->causes : v->alternative_causes;
    int columns = to->width - LABEL, nmark = v->ncauses ? v->ncauses : v->nalternative_causes;
    struct cause_place place;
    (void)fputs("\n", to->out);
    int sensors = print_sensors(to, d, columns), local = print_localisation(to, d, columns);
    struct strip strip = strip_open(geometry->length_m, columns);
    for (int g = 0; g < geometry->ngroups; g++)
        if (!geometry->groups[g].layer_of)
            strip_name(&strip, geometry->groups[g].from_m, geometry->groups[g].to_m, geometry->groups[g].name);
    strip_print(&strip, to->out, LABEL, "  group");
    for (int i = 0; i < nmark && i < MARKS; i++) {
        if (!cause_place(geometry, &mark[i], &place))
            continue;
        strip = strip_open(geometry->length_m, columns);
        strip_mark(&strip, place.from, place.to, mark[i].id);
        strip_print(&strip, to->out, LABEL, v->ncauses ? "  cause" : "  possible");
    }
    strip = strip_open(geometry->length_m, columns);
    strip_ticks(&strip);
    strip_print(&strip, to->out, LABEL, "  z [m]");
    if (sensors)
        screen_paragraph(to, "  ", "sensors: rms of residual/sigma, 1 is noise alone");
    if (local)
        screen_paragraph(to, "  ", "force residual: force that the model lacks, most at @");
}

static void print_verdict(const struct screen *to, const rotid_diagnosis *d)
{
    const rotid_verdict *v = &d->verdict;
    const struct reasons reasons = reasons_of_diagnosis(to->pool, d);
    (void)fputs("VERDICT  ", to->out);
    for (const char *c = v->sentence ? rotid_verdict_name(v->kind) : "none"; *c; c++)
        (void)fputc(toupper((unsigned char)*c), to->out);
    (void)fputc('\n', to->out);
    if (d->interrupted)
        screen_paragraph(to, "  ", "INTERRUPTED: the finished part stands below; the diagnosis is not complete.");
    if (v->sentence)
        wrap_text(to->out, 2, to->width, "  ", v->sentence);
    screen_reasons(to, &reasons);
    if (v->next_measurement)
        wrap_text(to->out, 10, to->width, "  next step: ", v->next_measurement);
}

static void print_foot(const struct screen *to, const struct result_head *head, const rotid_diagnosis *d)
{
    double seconds = 0;
    const char *steps = "";
    for (int i = 0; i < d->nsteps; i++) {
        seconds += d->steps[i].seconds;
        steps = pool_text(to->pool, "%s%s%s %.3g s", steps, i ? ", " : "", d->steps[i].name, d->steps[i].seconds);
    }
    (void)fputc('\n', to->out);
    screen_paragraph(to, "noise: ", noise_in_words(to->pool, &d->noise));
    screen_say(to, "seed %.0f, %d %s%s", head->seed, head->threads, human_plural(head->threads, "thread", "threads"),
               d->nsteps ? pool_text(to->pool, ", %.3g s", seconds) : "");
    if (to->verbose && d->nsteps)
        screen_paragraph(to, "time: ", steps);
}

void screen_diagnose(const struct screen *to, const struct result *result)
{
    const rotid_diagnosis *d = result->diagnose;
    const rotid_verdict *v = &d->verdict;
    const rotid_identification *last = d->extended ? d->extended : d->base;
    const struct reasons findings = findings_of_diagnosis(to->pool, d);
    print_verdict(to, d);
    screen_table(to, table_of_explanations(to->pool, d, to->verbose));
    if (last && v->sentence)
        screen_table(to, table_of_verdict_values(to->pool, d, to->verbose));
    if (last && (v->kind == ROTID_ADEQUATE || v->adequate_after)) /* else what is left is seen */
        screen_table(to, table_of_hidden(to->pool, last, d->nhidden, d->hidden));
    if (last) {
        screen_table(to, table_of_weighed(to->pool, last->nweighed, last->weighed));
        screen_table(to, table_of_runup(to->pool, last->nrunup, last->runup));
    }
    if (findings.count)
        screen_say(to, "\nWhat is wrong with the measurement and the numbers, corrected before causes are sought");
    screen_reasons(to, &findings);
    if (d->base) {
        screen_table(to, table_of_misfit(to->pool, d));
        print_axis(to, d);
    }
    for (int i = 0; i < d->nrounds; i++)
        screen_table(to, table_of_candidates(to->pool, d, i, to->verbose));
    if (d->base && v->sentence) /* else interrupted before it was measured */
        screen_table(to, table_of_quality(to->pool, d));
    screen_table(to, table_of_detectable(to->pool, d->ndetectable, d->detectable));
    print_foot(to, &result->head, d);
}
