/* A diagnosis: its tables, and `rotid diagnose` on one screen for a test engineer. */
#include <ctype.h>
#include <math.h>
#include <string.h>

#include "diagnose/causes/causes.h"
#include "fit/fit.h"
#include "report/report.h"

#define LABEL    14 /* columns before a strip */
#define BAR_HALF 14
#define MARKS    4     /* causes that are drawn */
#define SHOWN    4     /* of the others */
#define LISTED   6     /* causes of a set by which a parameter is said */
#define TINY     1e-12 /* zero but for rounding, in SI units */
#define SMALL    1e-3  /* shown with a power of ten */
#define LARGE    1e5

/* ---- words of causes */

/* What stands between the name of a cause and its target: "joint of core|right", "support at 0 m". */
static const char *before_target(const char *target)
{
    return !*target ? "" : strncmp(target, "at ", 3) ? " of " : " ";
}

/* "22.2 kg (95 %: 19.0 to 25.5)": two digits of half the interval, and of the value; this is read as a sentence. */
static const char *with_interval(struct pool *pool, const rotid_cause_value *value)
{
    struct human_unit shown = human_unit(value->value, value->unit);
    double f = shown.factor, number = fabs(value->value) < TINY ? 0 : f * value->value,
           half = f * (value->ci95[1] - value->ci95[0]) / 2;
    const char *text[3], *space = *shown.text ? "\xc2\xa0" : "";
    if (value->fixed || !isfinite(half) || (number == 0 && half < TINY))
        return human_value(pool, number == 0 ? 0 : value->value, value->unit);
    int power = number != 0 && (fabs(number) < SMALL || fabs(number) >= LARGE),
        decimals = human_decimals(number, fmin(10 * half, fabs(number) > 0 ? 10 * fabs(number) : INFINITY));
    const double part[3] = {number, f * value->ci95[0], f * value->ci95[1]};
    for (int i = 0; i < 3; i++)
        text[i] = power ? human_digits(pool, part[i], 3) : human_fixed(pool, part[i], decimals);
    return pool_text(pool, "%s%s%s (95\xc2\xa0%%: %s to %s)", text[0], space, shown.text, text[1], text[2]);
}

/* "mass 22.22 kg (95 %: 18.96 to 25.48), z 0.8983 m (95 %: 0.8886 to 0.9080)" */
static const char *values_of(struct pool *pool, const rotid_cause *cause)
{
    const char *text = "";
    for (int p = 0; p < cause->nparameters; p++) {
        const rotid_cause_value *value = &cause->parameters[p];
        text = pool_text(pool, "%s%s%s %s%s", text, p ? ", " : "", value->name, with_interval(pool, value),
                         value->fixed ? " (given)" : "");
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

struct table *table_of_candidates(struct pool *pool, const rotid_diagnosis *d, int round, int all)
{
    int count, more = 0;
    const rotid_candidate *list = diagnosis_candidates(d, round, &count);
    struct table *table = table_open(pool, "");
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

static void value_row(struct table *table, const char *name, const char *by, const rotid_fitted_parameter *is)
{
    text_column(table, "parameter", MAY_BE_CUT, name);
    unit_column(table, is->value, (is->ci95[1] - is->ci95[0]) / 2, is->unit);
    number_column(table, "value", ROW_UNIT, SHOW_ROW, is->value);
    number_column(table, "lower 95 %", ROW_UNIT, SHOW_ROW, is->ci95[0]);
    number_column(table, "upper 95 %", ROW_UNIT, SHOW_ROW, is->ci95[1]);
    text_column(table, "remark", SHOW_TEXT,
                is->at_bound             ? "at its bound"
                : !is->identifiable      ? "not determined"
                : !isfinite(is->ci95[0]) ? "no interval can be stated"
                                         : "");
    text_column(table, "if it is", MAY_BE_CUT, by);
}

/* What may hide in it: the causes that move it most. */
static const char *hidden_of(struct pool *pool, const rotid_diagnosis *d, const rotid_fitted_parameter *p)
{
    const char *text = "";
    char figure[32];
    for (int i = 0; i < d->nhidden; i++) {
        const rotid_hidden *hidden = &d->hidden[i];
        if (strcmp(hidden->parameter, p->name) != 0)
            continue;
        text = pool_text(pool, "%s%s %s by %s%s%s", text,
                         *text ? ";" : "possible bias:", linear_percent_text(100 * fabs(hidden->shift / p->value), figure),
                         hidden->id, before_target(hidden->target), hidden->target);
        if (isfinite(hidden->z_m))
            text = pool_text(pool, "%s at z %s", text, human_value(pool, hidden->z_m, "m"));
        if (strcmp(hidden->component, "presence") != 0)
            text = pool_text(pool, "%s (%s %.2g%s%s)", text, hidden->component, fabs(hidden->size), layout_gap(hidden->size_unit),
                             layout_unit(hidden->size_unit));
    }
    return text;
}

/* "joint of core|right in state hot with added_mass, and something else"; "nothing is wrong" */
static const char *explanation_of(struct pool *pool, const rotid_explanation *e)
{
    const char *text = "";
    for (int i = 0; i < e->ncauses; i++) {
        const rotid_cause *cause = &e->causes[i];
        text = pool_text(pool, "%s%s%s%s%s%s%s", text, i ? " with " : "", cause->id, before_target(cause->target), cause->target,
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
    const char *runup = "";
    if (isfinite(v->runup_p))
        runup = pool_text(pool,
                          "The measured critical speeds count; beside the first explanation the probability of such ones is %s.",
                          text_of_probability(pool, 2, v->runup_p));
    if (shown < v->nexplanations)
        table_note(table, "%s%s%d more share the rest up to 99 %%: --verbose", runup, *runup ? " " : "",
                   v->nexplanations - shown);
    else
        table_note(table, "%s", runup);
    return table;
}

struct table *table_of_verdict_values(struct pool *pool, const rotid_diagnosis *d, int all)
{
    const rotid_verdict *v = &d->verdict;
    const rotid_identification *fit = d->extended ? d->extended : d->base;
    int unseen = d->nhidden && (v->kind == ROTID_ADEQUATE || v->adequate_after); /* else what is left is seen */
    struct table *table =
        table_open(pool, d->extended ? "Parameters of the extended model" : "Parameters of the model of the deck");
    for (int p = 0; p < d->base->nparameters; p++) {
        const rotid_fitted_parameter *value = fit_parameter(fit, d->base->parameters[p].name);
        int shown = 0, left = 0, averaged = p < d->nparameters;
        if (averaged) {
            const rotid_averaged_parameter *mean = &d->parameters[p];
            value_row(table, mean->name, "averaged over the explanations",
                      &(rotid_fitted_parameter){
                          .value = mean->value, .unit = mean->unit, .ci95 = {mean->ci95[0], mean->ci95[1]}, .identifiable = 1});
        }
        if (value) {
            value_row(table, value->name, averaged ? d->extended ? "the extended model" : "the model of the deck" : "", value);
            row_note(table, unseen ? hidden_of(pool, d, value) : "");
        }
        for (int i = 0; i < v->nexplanations && v->kind == ROTID_AMBIGUOUS; i++) {
            const rotid_cause_value *by = p < v->explanations[i].nidentified ? &v->explanations[i].identified[p] : NULL;
            if (!by)
                continue;
            if (shown == LISTED && !all) {
                left++;
                continue;
            }
            shown++;
            value_row(table, by->name, explanation_of(pool, &v->explanations[i]),
                      &(rotid_fitted_parameter){.value = by->value,
                                                .unit = by->unit,
                                                .ci95 = {by->ci95[0], by->ci95[1]},
                                                .at_bound = !isfinite(by->ci95[0]),
                                                .identifiable = 1});
        }
        if (left)
            table_note(table, "%d more with --verbose", left);
    }
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

static struct table *table_of_change(struct pool *pool, const rotid_diagnosis *d)
{
    struct table *table = table_open(pool, "");
    for (int i = 0; i < d->gain.nparameters && d->extended; i++) {
        const rotid_changed_parameter *p = &d->gain.parameters[i];
        const double *ci = isfinite(p->after) ? p->after_ci95 : p->before_ci95;
        text_column(table, "parameter", MAY_BE_CUT, p->name);
        unit_column(table, isfinite(p->after) ? p->after : p->before, (ci[1] - ci[0]) / 2, p->unit);
        number_column(table, "before", ROW_UNIT, SHOW_ROW, p->before);
        number_column(table, "lower", ROW_UNIT, SHOW_ROW, p->before_ci95[0]);
        number_column(table, "upper", ROW_UNIT, SHOW_ROW, p->before_ci95[1]);
        number_column(table, "after", ROW_UNIT, SHOW_ROW, p->after);
        number_column(table, "lower", ROW_UNIT, SHOW_ROW, p->after_ci95[0]);
        number_column(table, "upper", ROW_UNIT, SHOW_ROW, p->after_ci95[1]);
        number_column(table, "change", "%", SHOW_SIGNED(1), 100 * (p->after / p->before - 1));
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

struct table *table_of_detectable(struct pool *pool, int count, const rotid_detectable *list, const char *caption)
{
    struct table *table = table_open(pool, caption);
    const char *beyond = "";
    for (int i = 0; i < count; i++) {
        const rotid_detectable *d = &list[i];
        double neutral = falls_from(d->id), shown = isfinite(neutral) ? neutral - d->smallest : d->smallest;
        if (d->beyond || !isfinite(d->smallest)) {
            beyond = pool_text(pool, "%s%s %s%s%s", beyond, *beyond ? ";" : "Not detectable at any physical size:", d->id,
                               before_target(d->target), d->target);
            continue;
        }
        text_column(table, "cause", MAY_BE_CUT, d->id);
        text_column(table, "target", MAY_BE_CUT, d->target);
        text_column(table, "parameter", MAY_BE_CUT, d->parameter);
        unit_column(table, shown, NAN, d->unit);
        number_column(table, "smallest", ROW_UNIT, SHOW_DIGITS(2), shown);
        number_column(table, "at z", "m", SHOW_DIGITS(3), d->z_m);
        number_column(table, "at worst", ROW_UNIT, SHOW_DIGITS(2), d->worst);
        text_column(table, "remark", SHOW_TEXT,
                    isfinite(neutral)                         ? "or less"
                    : isfinite(d->z_m) && !isfinite(d->worst) ? "not everywhere"
                                                              : "");
    }
    table_note(table, "%s", beyond);
    return table;
}

static struct table *table_of_misfit(struct pool *pool, const rotid_diagnosis *d)
{
    const rotid_identification *base = d->base;
    struct table *table = table_open(pool, "");
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
    if (!sensors && !local)
        return;
    struct wrap wrap = wrap_open(to->out, 4, to->width, "  ");
    if (sensors)
        wrap_words(&wrap, "sensors: rms of residual/sigma, 1 is noise alone;");
    if (local)
        wrap_words(&wrap, "force residual: force that the model lacks, most at @");
    wrap_close(&wrap);
}

static void print_misfit(const struct screen *to, const rotid_diagnosis *d)
{
    const rotid_identification *base = d->base;
    if (!base)
        return;
    if (d->before)
        (void)fprintf(to->out, "\nWHAT CHANGED  %s against the model fitted to %s, less its residuals there", d->after,
                      d->before);
    else
        (void)fprintf(to->out, "\nWHAT IS WRONG  full model, likelihood");
    if (isfinite(base->chi2))
        (void)fprintf(to->out, ", chi2 %.4g with %d degrees of freedom", base->chi2, base->dof);
    (void)fprintf(to->out, "%s\n",
                  !base->nparameters                       ? "; nothing to identify"
                  : !strcmp(base->status, "not_converged") ? "; NOT CONVERGED"
                                                           : "");
    table_write_text(to->out, table_of_misfit(to->pool, d), to->width);
    print_axis(to, d);
}

static void print_chance(struct wrap *wrap, const char *what, double chance)
{
    if (isfinite(chance))
        wrap_item(wrap, chance < 0.001 ? "%s <0.001" : "%s %.3f", what, chance);
}

static void print_round(const struct screen *to, const rotid_diagnosis *d, int number)
{
    const rotid_round *round = &d->rounds[number];
    struct wrap wrap = wrap_open(to->out, 4, to->width, "  ");
    if (isfinite(round->chi2))
        wrap_item(&wrap, "chi2 %.4g of %d degrees of freedom", round->chi2, round->dof);
    if (isfinite(round->largest))
        wrap_item(&wrap, "; expected drop %.3g", round->largest);
    print_chance(&wrap, "; p-value of the frequencies", round->p_frequency);
    print_chance(&wrap, ", of chi2", round->p_total);
    wrap_close(&wrap);
    table_write_text(to->out, table_of_candidates(to->pool, d, number, to->verbose), to->width);
}

static void print_evidence(const struct screen *to, const rotid_diagnosis *d)
{
    if (d->nrounds)
        (void)fprintf(to->out, "\nEVIDENCE  (expected, chi2 drop: of the misfit; sensors: res./sigma of sensors left out)\n");
    for (int i = 0; i < d->nrounds; i++)
        print_round(to, d, i);
}

/* A table under a heading in place of its caption. */
static void print_bare(const struct screen *to, struct table *table)
{
    if (table)
        table->caption = "";
    table_write_text(to->out, table, to->width);
}

static void print_shares(const struct screen *to, const rotid_diagnosis *d)
{
    const rotid_verdict *v = &d->verdict;
    if (!v->nexplanations)
        return;
    (void)fprintf(to->out, "\nEXPLANATIONS  shares of probability; nothing is wrong: %s before the data, %s after\n",
                  text_of_probability(to->pool, 3, v->nothing_prior), text_of_probability(to->pool, 3, v->nothing));
    print_bare(to, table_of_explanations(to->pool, d, to->verbose));
}

static void print_parameters(const struct screen *to, const rotid_diagnosis *d)
{
    const rotid_verdict *v = &d->verdict;
    if (!v->sentence || !d->base || !d->base->nparameters)
        return;
    (void)fprintf(to->out, "\nPARAMETERS  %s, 95 %% intervals%s\n", d->extended ? "extended model" : "model of the deck",
                  d->nhidden && (v->kind == ROTID_ADEQUATE || v->adequate_after)
                      ? "; possible bias: shift by an effect this test cannot show"
                      : "");
    print_bare(to, table_of_verdict_values(to->pool, d, to->verbose));
}

static void print_verdict(const struct screen *to, const rotid_diagnosis *d)
{
    const rotid_verdict *v = &d->verdict;
    const rotid_noise *noise = &d->noise;
    (void)fputs("VERDICT  ", to->out);
    for (const char *c = v->sentence ? rotid_verdict_name(v->kind) : "none"; *c; c++)
        (void)fputc(toupper((unsigned char)*c), to->out);
    (void)fputc('\n', to->out);
    if (d->interrupted)
        wrap_text(to->out, 2, to->width, "  ", "INTERRUPTED: the finished part stands below; the diagnosis is not complete.");
    if (v->sentence)
        wrap_text(to->out, 2, to->width, "  ", v->sentence);
    struct wrap wrap = wrap_open(to->out, 2, to->width, "  ");
    if (isfinite(v->p_value) && v->sentence) {
        wrap_words(&wrap, "p-value (hypothesis: adequate model):");
        wrap_item(&wrap, v->p_value < 0.001 ? "below %g" : "%.3g", v->p_value < 0.001 ? 0.001 : v->p_value);
        if (v->kind != ROTID_ADEQUATE)
            wrap_words(&wrap, !v->adequate_after           ? "; the residual still exceeds the noise"
                              : v->kind == ROTID_AMBIGUOUS ? "; with the best of these causes the model is adequate"
                                                           : "; the extended model is adequate");
    } else {
        wrap_words(&wrap, v->sentence ? "no p-value can be stated" : "no verdict was reached");
    }
    wrap_close(&wrap);
    if (noise->frequency_assumed || noise->shape_assumed)
        wrap_text(to->out, 2, to->width, "  ",
                  "The deck states no noise for all of the data: the assumed values stand below, so statements are relative.");
    if (v->next_measurement)
        wrap_text(to->out, 10, to->width, "  next step: ", v->next_measurement);
}

static double value_of(const rotid_identification *fit, const char *name)
{
    const rotid_fitted_parameter *parameter = fit_parameter(fit, name);
    return parameter ? parameter->value : NAN;
}

/* Errors of its frequencies, and the share of the reduction in them. */
static void print_frequencies_today(const struct screen *to, const rotid_diagnosis *d)
{
    const rotid_identification *fit = d->today;
    int shown = 0, found = !strcmp(fit->reduction, "NONE"), worst = fit_worst_mode(fit);
    if (worst < 0)
        return;
    for (int i = 0; i < d->nnumerical_findings; i++) /* says it mode by mode */
        found |= !strcmp(d->numerical_findings[i].id, "guyan_reduction");
    struct wrap wrap = wrap_open(to->out, 4, to->width, "  ");
    wrap_item(&wrap, "frequencies that were fitted: error %.3g %% rms, %.3g %% at most", fit_rms_percent(fit, 0),
              fabs(fit->modes[worst].error_percent));
    for (int k = 0; k < fit->nmodes && !found; k++) {
        double error = fit->reduction_error_percent[k];
        if (isfinite(error))
            wrap_item(&wrap, "%smode %d %+.2f", shown++ ? "" : "; error of the reduction [%]: ", fit->modes[k].mode, error);
    }
    wrap_close(&wrap);
}

static void print_today(const struct screen *to, const rotid_diagnosis *d)
{
    const rotid_identification *fit = d->today;
    if (!fit)
        return;
    int as_judged = !strcmp(fit->functional, "LIKELIHOOD") && !strcmp(fit->reduction, "NONE");
    (void)fprintf(to->out, "\nFIT AS SPECIFIED  %s, reduction %s: %s\n", fit->functional, fit->reduction,
                  as_judged ? "as it is tested below" : "the error of that choice");
    for (int i = 0; i < fit->nparameters; i++) {
        const rotid_fitted_parameter *p = &fit->parameters[i];
        const struct human_unit unit = human_unit(p->value, p->unit);
        double base = 100 * (p->value / value_of(d->base, p->name) - 1),
               extended = 100 * (p->value / value_of(d->extended, p->name) - 1);
        struct wrap wrap = wrap_open(to->out, 4, to->width, "  ");
        wrap_item(&wrap, "%s %s%s%s", p->name, IN_DIGITS(4, p->value * unit.factor), *unit.text ? " " : "", unit.text);
        if (p->at_bound)
            wrap_item(&wrap, "AT ITS BOUND");
        if (isfinite(base))
            wrap_item(&wrap, ": %+.1f %% off the full model by the likelihood", base);
        if (isfinite(extended))
            wrap_item(&wrap, ", %+.1f %% off the extended one", extended);
        wrap_close(&wrap);
    }
    print_frequencies_today(to, d);
}

static void print_numerical(const struct screen *to, const rotid_diagnosis *d)
{
    if (d->nnumerical_findings)
        (void)fprintf(to->out, "\nNUMBERS  numerical errors, removed from the model that is tested\n");
    for (int i = 0; i < d->nnumerical_findings; i++) {
        const rotid_numerical_finding *finding = &d->numerical_findings[i];
        struct wrap wrap = wrap_open(to->out, 4, to->width, "  ");
        wrap_item(&wrap, "%s%s%s:", finding->id, finding->state ? " in state " : "", finding->state ? finding->state : "");
        if (finding->text)
            wrap_words(&wrap, finding->text);
        for (int k = 0, shown = 0; k < finding->nmodes; k++)
            if (isfinite(finding->error_percent[k]))
                wrap_item(&wrap, "%smode %d %+.3g", shown++ ? ", " : "; error [%]: ", finding->modes[k],
                          finding->error_percent[k]);
        wrap_close(&wrap);
    }
}

static void print_data(const struct screen *to, const rotid_diagnosis *d)
{
    if (d->ndata_findings)
        (void)fprintf(to->out, "\nDATA  faults of the measurement, removed before causes are sought\n");
    for (int i = 0; i < d->ndata_findings; i++) {
        const rotid_data_finding *finding = &d->data_findings[i];
        const struct human_unit unit = human_unit(finding->value, finding->unit);
        struct wrap wrap = wrap_open(to->out, 4, to->width, "  ");
        wrap_item(&wrap, "%s%s%s", finding->id, finding->state ? " in state " : "", finding->state ? finding->state : "");
        for (int n = 0; n < finding->nsensors; n++)
            wrap_item(&wrap, "%s%d", n ? "and " : "sensor ", finding->sensors[n]);
        for (int k = 0; k < finding->nmodes; k++)
            wrap_item(&wrap, "%s%d", k ? "and " : "mode ", finding->modes[k]);
        if (finding->block)
            wrap_item(&wrap, "%s", finding->block);
        if (isfinite(finding->value))
            wrap_item(&wrap, ": %.3g%s%s", finding->value * unit.factor, layout_gap(unit.text), unit.text);
        if (isfinite(finding->std))
            wrap_item(&wrap, "+- %.2g", finding->std * unit.factor);
        if (isfinite(finding->chi2_drop))
            wrap_item(&wrap, ", chi2 less by %.4g", finding->chi2_drop);
        if (finding->text) {
            wrap_item(&wrap, ";");
            wrap_words(&wrap, finding->text);
        }
        wrap_close(&wrap);
    }
}

static void print_noise(const struct screen *to, const rotid_diagnosis *d)
{
    static const char *const said[] = {"stated", "the deck states none: assumed"};
    const rotid_noise *noise = &d->noise;
    int frequency = noise->frequency > 0, shape = noise->shape > 0; /* NaN: no */
    struct wrap wrap = wrap_open(to->out, 7, to->width, "noise  ");
    if (frequency)
        wrap_item(&wrap, "frequencies %.3g %% (%s)%s", 100 * noise->frequency, said[noise->frequency_assumed != 0],
                  shape ? "," : "");
    if (shape)
        wrap_item(&wrap, "shapes %.3g %% of the largest component (%s)", 100 * noise->shape, said[noise->shape_assumed != 0]);
    if (!frequency && !shape)
        wrap_item(&wrap, "unknown");
    wrap_close(&wrap);
}

static void print_foot(const struct screen *to, const struct result_head *head, const rotid_diagnosis *d)
{
    double seconds = 0;
    (void)fputc('\n', to->out);
    print_noise(to, d);
    for (int i = 0; i < d->nsteps; i++)
        seconds += d->steps[i].seconds;
    (void)fprintf(to->out, "seed %.0f, %d thread%s", head->seed, head->threads, head->threads == 1 ? "" : "s");
    if (d->nsteps)
        (void)fprintf(to->out, ", %.3g s", seconds);
    (void)fputc('\n', to->out);
    if (!to->verbose || !d->nsteps)
        return;
    struct wrap wrap = wrap_open(to->out, 7, to->width, "time   ");
    for (int i = 0; i < d->nsteps; i++)
        wrap_item(&wrap, "%s %.3g s%s", d->steps[i].name, d->steps[i].seconds, i + 1 < d->nsteps ? "," : "");
    wrap_close(&wrap);
}

static void print_gain(const struct screen *to, const rotid_diagnosis *d)
{
    const struct {
        const rotid_identification *fit;
        const char *when;
    } fits[] = {{d->base, d->extended ? " before" : ""}, {d->extended, " after"}};
    if (!d->base || !d->verdict.sentence) /* interrupted before it was measured */
        return;
    (void)fprintf(to->out, "\n%s\n",
                  d->extended ? "GAIN  base model -> extended model" : "QUALITY  of the base model, without a cause");
    print_bare(to, table_of_quality(to->pool, d));
    if (d->extended)
        table_write_text(to->out, table_of_change(to->pool, d), to->width);
    for (int i = 0; i < 2; i++)
        if (fits[i].fit && fits[i].fit->intervals_widened_by > 1)
            (void)fprintf(to->out, "  intervals%s are widened by %s: the misfit exceeds the noise\n", fits[i].when,
                          IN_DIGITS(3, fits[i].fit->intervals_widened_by));
}

static void print_detection_limits(const struct screen *to, const rotid_diagnosis *d)
{
    if (d->ndetectable)
        (void)fprintf(to->out, "\nDETECTION LIMITS  smallest effect that is detected in 9 tests of 10\n");
    table_write_text(to->out, table_of_detectable(to->pool, d->ndetectable, d->detectable, ""), to->width);
}

void screen_diagnose(const struct screen *to, const struct result *result)
{
    const rotid_diagnosis *d = result->diagnose;
    screen_heading(to, &result->head);
    print_verdict(to, d);
    print_shares(to, d);
    print_parameters(to, d);
    const rotid_identification *last = d->extended ? d->extended : d->base;
    if (last) {
        screen_table(to, table_of_weighed(to->pool, last->nweighed, last->weighed));
        screen_table(to, table_of_runup(to->pool, last->nrunup, last->runup));
    }
    print_today(to, d);
    print_numerical(to, d);
    print_data(to, d);
    print_misfit(to, d);
    print_evidence(to, d);
    print_gain(to, d);
    print_detection_limits(to, d);
    print_foot(to, &result->head, d);
}
