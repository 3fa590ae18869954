/* A diagnosis: the verdict in the words of the verdict itself, the tiles, then what a reader asks: what did the cause change,
 * which causes are possible, is the measurement sound, where does the model miss it, which effects stay undetected. */
#include <ctype.h>
#include <math.h>
#include <string.h>

#include "diagnose/causes/causes.h"
#include "fit/fit.h"
#include "page/page.h"

#define COUNT_OF(list) ((int)(sizeof(list) / sizeof *(list)))

/* "in fewer than 1 of 1,000": how often chance does it; "" where p is not known. */
static const char *words_chance(struct pool *pool, double p)
{
    if (!isfinite(p))
        return "";
    if (p < 0.001)
        return "in fewer than 1 of 1,000";
    if (p < 0.01)
        return pool_text(pool, "in about %.0f of 1,000", 1000 * p);
    return pool_text(pool, "in about %.0f of 100", 100 * p);
}

/* "step_stiffness and added_mass"; all: those that are likely beside what was named, too */
static const char *names(struct pool *pool, const rotid_diagnosis *d, int all)
{
    const rotid_verdict *v = &d->verdict;
    const char *text = "";
    int count = v->ncauses + (all ? v->nlikely_causes : 0);
    for (int i = 0; i < count; i++)
        text = pool_text(pool, "%s%s%s", text, !i ? "" : i + 1 == count ? " and " : ", ", extended_label(pool, d, i));
    return text;
}

static const char *headline(struct pool *pool, const rotid_diagnosis *d, const char *shifts)
{
    switch (d->verdict.kind) {
    case ROTID_ADEQUATE:
        return *shifts ? pool_text(pool, "Adequate; effects below the detection limits may shift %s", shifts) : "Adequate";
    case ROTID_NAMED:
        return pool_text(pool, "Named: %s%s%s", names(pool, d, 0),
                         *shifts ? "; effects below the detection limits may shift " : "", shifts);
    case ROTID_AMBIGUOUS:
        return d->verdict.nexplanations == 1
                   ? "Ambiguous: one explanation, which these data do not name"
                   : pool_text(pool, "Ambiguous: one of %s explanations", human_count(pool, d->verdict.nexplanations));
    case ROTID_UNEXPLAINED:
        return pool_text(pool, "Unexplained: something outside of the catalogue with %s %%",
                         human_digits(pool, 100 * d->verdict.something_else, 2));
    default:
        return "Interrupted: no verdict";
    }
}

/* How to look for all that was named. */
static const char *checks(struct pool *pool, const rotid_diagnosis *d)
{
    const char *text = "";
    for (int i = 0; i < d->verdict.ncauses; i++)
        if (!strstr(text, cause_check(d->verdict.causes[i].id)))
            text = pool_text(pool, "%s%s%s", text, *text ? "; " : "", cause_check(d->verdict.causes[i].id));
    return text;
}

static const char *next(struct pool *pool, const rotid_diagnosis *d, const char *deck)
{
    const char *text = d->verdict.next_measurement, *look = checks(pool, d);
    if (d->verdict.kind == -1)
        return pool_text(pool, "Next: run rotid diagnose %s to its end.", deck);
    if (d->verdict.kind == ROTID_ADEQUATE)
        return "Next: read the detection limits below before you rely on the moduli. Smaller effects may be present.";
    if (d->verdict.kind == ROTID_NAMED && *look && !(text && strstr(text, look))) /* or it says it already */
        text = pool_text(pool, "%s%s%s", look, text ? "; and " : ", before you believe the verdict", text ? text : "");
    return text ? pool_text(pool, "Next: %s.", text) : NULL;
}

/* How often chance does what was found, and what that rests on. */
static void on_chance(struct reasons *reasons, const rotid_diagnosis *d)
{
    struct pool *pool = reasons->pool;
    const rotid_round *round = d->nrounds ? d->rounds : NULL;
    int assumed = d->noise.frequency_assumed || d->noise.shape_assumed;
    if (round && isfinite(d->verdict.p_value))
        reasons_add(reasons, TONE_NONE,
                    "A correct model has a misfit this large or larger %s tests: the misfit \xcf\x87\xc2\xb2 is %s, "
                    "where a correct model has about %d.",
                    words_chance(pool, d->verdict.p_value), human_digits(pool, round->chi2, 3), round->dof);
    if (round && d->verdict.kind == ROTID_ADEQUATE && isfinite(round->largest))
        reasons_add(reasons, TONE_NONE, "No cause of the catalogue is expected to lower it by more than %s.",
                    human_digits(pool, round->largest, 2));
    if (assumed)
        reasons_add(reasons, TONE_NONE,
                    "The deck does not state all of the noise. The assumed values stand below; another noise may change the "
                    "verdict, so no cause is named: state *NOISE.");
}

/* The likeliest causes and what is left to the rest. */
static void on_shares(struct reasons *reasons, const rotid_diagnosis *d)
{
    struct pool *pool = reasons->pool;
    const rotid_verdict *v = &d->verdict;
    int tried = 0;
    for (int i = 0; i < d->ncandidates; i++)
        tried += d->candidates[i].refitted;
    for (int i = 0; i < v->nmarginals && v->kind == ROTID_NAMED && i < v->ncauses; i++)
        reasons_add(reasons, TONE_NONE, "%s%s%s: probability %s %%.", plain_cause(pool, v->marginals[i].id),
                    *v->marginals[i].target ? " of " : "", v->marginals[i].target,
                    human_digits(pool, 100 * v->marginals[i].probability, 3));
    if (v->nexplanations && v->something_else > 0.01)
        reasons_add(reasons, TONE_NONE, "Probability of something outside of the catalogue: %s %%.",
                    human_digits(pool, 100 * v->something_else, 2));
    const char *count = human_count(pool, tried);
    if (tried && v->kind != ROTID_ADEQUATE)
        reasons_add(reasons, TONE_NONE, "%c%s single %s fitted, then sets of them.", toupper((unsigned char)*count), count + 1,
                    human_plural(tried, "cause was", "causes were"));
}

static void on_parameters(struct reasons *reasons, const rotid_diagnosis *d)
{
    struct pool *pool = reasons->pool;
    const char *moved = "";
    int count = 0;
    for (int p = 0; p < d->gain.nparameters; p++) {
        double percent = 100 * (d->gain.parameters[p].after / d->gain.parameters[p].before - 1);
        if (isfinite(percent))
            moved = pool_text(pool, "%s%s%s by %s\xc2\xa0%%", moved, count++ ? ", " : "", d->gain.parameters[p].name,
                              human_signed(pool, percent, fabs(percent) < 1 ? 2 : 1));
    }
    if (count && d->verdict.kind != -1)
        reasons_add(reasons, TONE_NONE, "The missing cause had biased the parameters; the extended model moves %s.", moved);
    const rotid_identification *fit = d->extended ? d->extended : d->base;
    for (int p = 0; fit && p < fit->nparameters; p++)
        if (!fit->parameters[p].identifiable)
            reasons_add(reasons, TONE_NONE, "%s %s.", fit->parameters[p].name,
                        fit->parameters[p].at_bound ? "ends at its bound: its value without the bound is not known"
                                                    : "is not determined by these data");
}

/* What the FIT of the deck makes of the parameters beside the full model. */
static void on_today(struct reasons *reasons, const rotid_diagnosis *d)
{
    struct pool *pool = reasons->pool;
    const rotid_identification *final = d->extended ? d->extended : d->base, *today = diagnosis_today(d);
    const char *text = "";
    int count = 0;
    if (!today || !final)
        return;
    for (int p = 0; p < today->nparameters; p++)
        for (int q = 0; q < final->nparameters; q++) {
            double percent = 100 * (today->parameters[p].value / final->parameters[q].value - 1);
            if (strcmp(today->parameters[p].name, final->parameters[q].name) != 0 || !isfinite(percent))
                continue;
            text = pool_text(pool, "%s%s%s = %s, %s\xc2\xa0%%", text, count++ ? "; " : "", today->parameters[p].name,
                             human_value(pool, today->parameters[p].value, today->parameters[p].unit),
                             human_signed(pool, percent, 1));
        }
    if (count)
        reasons_add(reasons, TONE_NONE,
                    "The fit as the deck states it (%s, reduction %s) gives %s against the %s here, which is the full "
                    "model judged by the likelihood.",
                    today->functional, today->reduction, text, d->extended ? "extended model" : "model");
}

static const char *interrupted(struct pool *pool, const rotid_diagnosis *d)
{
    if (!d->base)
        return "The diagnosis was interrupted before the model was fitted: there is nothing to judge yet.";
    return d->verdict.ncauses
               ? pool_text(pool,
                           "The diagnosis was interrupted before a verdict. A round that was finished would name %s; "
                           "the rounds that did not run may speak against that.",
                           names(pool, d, 0))
               : "The diagnosis was interrupted before a verdict. The finished part stands below: it shows where "
                 "the model misses "
                 "the measurement, and does not say why.";
}

static void tile_pair(struct document *document, const char *name, const rotid_pair *pair, const char *note)
{
    struct pool *pool = document->pool;
    if (!isfinite(pair->before) && !isfinite(pair->after))
        return;
    document_tile(
        document, name,
        isfinite(pair->after) && isfinite(pair->before)
            ? pool_text(pool, "%s \xe2\x86\x92 %s", human_digits(pool, pair->before, 2), human_digits(pool, pair->after, 2))
            : human_digits(pool, isfinite(pair->after) ? pair->after : pair->before, 2),
        note);
}

static void add_tiles(struct document *document, const rotid_diagnosis *d)
{
    const rotid_identification *fit = d->extended ? d->extended : d->base;
    const rotid_verdict *v = &d->verdict;
    struct pool *pool = document->pool;
    const char *both = d->extended ? pool_text(pool, "without \xe2\x86\x92 with %s", plain_text(pool, names(pool, d, 1))) : NULL;
    for (int p = 0; fit && p < d->base->nparameters && p < TILES_MOST - 3; p++) {
        const rotid_fitted_parameter *value = fit_parameter(fit, d->base->parameters[p].name);
        double was = d->base->parameters[p].value;
        if (p < d->nparameters && v->nexplanations > 1 && v->kind != ROTID_NAMED) {
            const rotid_averaged_parameter *mean = &d->parameters[p];
            const rotid_fitted_parameter whole = {.name = mean->name,
                                                  .unit = mean->unit,
                                                  .value = mean->value,
                                                  .ci95 = {mean->ci95[0], mean->ci95[1]},
                                                  .identifiable = 1};
            tile_parameter(document, &whole, "averaged over the explanations by their probabilities");
        } else if (value)
            tile_parameter(document, value, d->extended ? pool_text(pool, "was %s", human_value(pool, was, value->unit)) : NULL);
    }
    tile_pair(document, "error of the frequencies, rms [%]", &d->gain.frequency_rms_percent, both);
    if (isfinite(d->gain.holdout_frequency_rms_percent.before))
        tile_pair(document, "held-out frequencies, rms [%]", &d->gain.holdout_frequency_rms_percent, both);
    else
        tile_pair(document, "modes left out in turn, rms [%]", &d->gain.mode_out_frequency_rms_percent, both);
    tile_pair(document, "\xcf\x87\xc2\xb2 per degree of freedom", &d->gain.chi2_per_dof,
              both ? both : "1 is what the noise leaves");
}

void answer_diagnose(struct document *document, const struct result *result)
{
    static const enum tone tones[] = {TONE_BAD, TONE_GOOD, TONE_CARE, TONE_CARE, TONE_BAD};
    const rotid_diagnosis *d = result->diagnose;
    const rotid_identification *fit = d->extended ? d->extended : d->base;
    struct pool *pool = document->pool;
    int explained = d->verdict.kind == ROTID_ADEQUATE || d->verdict.adequate_after;
    document->now.tone = tones[d->verdict.kind + 1];
    if (d->verdict.kind == ROTID_ADEQUATE && fit && hidden_is_wide(fit, d->nhidden, d->hidden))
        document->now.tone = TONE_CARE;
    document->now.headline = headline(pool, d, explained && fit ? hidden_in_words(pool, fit, d->nhidden, d->hidden, 0) : "");
    document->now.text =
        d->verdict.kind < 0 || !d->verdict.sentence ? interrupted(pool, d)
        : d->interrupted ? pool_text(pool, "%s The diagnosis was interrupted afterwards: the rest of this page is not complete.",
                                     d->verdict.sentence)
                         : d->verdict.sentence;
    document->now.next = next(pool, d, result->head.deck ? result->head.deck : "DECK");
    if (d->base && d->verdict.kind >= 0)
        add_tiles(document, d);
}

static void section_why(struct document *document, const rotid_diagnosis *d)
{
    struct reasons reasons = {.pool = document->pool};
    on_chance(&reasons, d);
    on_shares(&reasons, d);
    on_parameters(&reasons, d);
    on_today(&reasons, d);
    if (!reasons.count)
        return;
    document_section(document, "trust", "Why", NULL);
    document_list(document, reasons.count, reasons.text);
}

/* ---- parameters */

/* Two digits: more is not known of a size that would have shown. */
static const char *size_of(struct pool *pool, double size, const char *unit)
{
    struct human_unit shown = human_unit(size, unit);
    return pool_text(pool, "%s%s%s", human_digits(pool, size * shown.factor, 2), *shown.text ? "\xc2\xa0" : "", shown.text);
}

void section_hidden(struct document *document, const rotid_identification *fit, int count, const rotid_hidden *hidden)
{
    struct pool *pool = document->pool;
    struct table *table = table_open(pool, "Causes below their detection limits that move the parameters most");
    char figure[32];
    if (!count)
        return;
    for (int i = 0; i < count; i++) {
        const rotid_fitted_parameter *value = fit_parameter(fit, hidden[i].parameter);
        text_column(table, "parameter", SHOW_TEXT, hidden[i].parameter);
        text_column(table, "moved by", SHOW_TEXT,
                    value ? pool_copy_text(pool, linear_percent_text(100 * fabs(hidden[i].shift / value->value), figure)) : "");
        text_column(table, "cause", SHOW_TEXT, cause_name(pool, hidden[i].id, hidden[i].target));
        text_column(
            table, "its size", SHOW_TEXT,
            !strcmp(hidden[i].component, "presence")
                ? "there or not"
                : pool_text(pool, "%s %s", hidden[i].component, size_of(pool, fabs(hidden[i].size), hidden[i].size_unit)));
        number_column(table, "z", "m", SHOW_TRIMMED(3), hidden[i].z_m);
    }
    document_section(document, "hidden", "Possible bias of the parameters", NULL);
    document_paragraph(
        document, "The model explains the measurement, and so would a model with one of these causes in it, of a size below its "
                  "detection limit. The fit without the cause moves the parameter as far as this. The size is the smallest "
                  "that shows in 9 of 10 tests at that place, or the largest that is physical, as its distance from no effect; a "
                  "smaller one moves the parameter less in proportion.");
    document_table(document, table);
}

static void section_parameters(struct document *document, const rotid_diagnosis *d)
{
    const rotid_identification *fit = d->extended ? d->extended : d->base;
    if (!d->base || !fit || d->verdict.kind < 0 || !d->base->nparameters)
        return;
    document_section(document, "verdict-parameters", "Parameters of the verdict", "correlation");
    document_table(document, table_of_verdict_values(document->pool, d, 1));
    document_table(document, table_of_weighed(document->pool, fit->nweighed, fit->weighed));
    document_table(document, table_of_runup(document->pool, fit->nrunup, fit->runup));
    if (d->verdict.kind == ROTID_ADEQUATE || d->verdict.adequate_after)
        section_hidden(document, fit, d->nhidden, d->hidden);
}

/* ---- causes */

static void section_explanations(struct document *document, const rotid_diagnosis *d)
{
    const rotid_verdict *v = &d->verdict;
    if (!v->nexplanations)
        return;
    document_section(document, "explanations", "Explanations", NULL);
    document_paragraph(
        document, "Probability that nothing is wrong: %s before the data, %s after. Something outside of the catalogue: %s.",
        text_of_probability(document->pool, 3, v->nothing_prior), text_of_probability(document->pool, 3, v->nothing),
        text_of_probability(document->pool, 3, v->something_else));
    document_table(document, table_of_explanations(document->pool, d, 1));
}

static void section_evidence(struct document *document, const rotid_diagnosis *d)
{
    struct pool *pool = document->pool;
    if (!d->nrounds)
        return;
    document_section(document, "causes", d->verdict.kind == ROTID_ADEQUATE ? "Causes that were tried" : "Possible causes",
                     "causes");
    for (int i = 0; i < d->nrounds; i++) {
        const rotid_round *round = &d->rounds[i];
        int fitted = 0, count;
        const rotid_candidate *candidate = diagnosis_candidates(d, i, &count);
        for (int k = 0; k < count; k++)
            fitted += candidate[k].refitted;
        document_paragraph(document, "The misfit \xcf\x87\xc2\xb2 of the model without causes is %s.",
                           human_digits(pool, round->chi2, 4));
        if (!fitted) {
            document_paragraph(document, "No cause was likely enough to be fitted.");
            continue;
        }
        struct table *table = table_of_candidates(pool, d, i, 1);
        if (table)
            table->caption = "Single causes: sizes and places with 95 % intervals";
        document_table(document, table);
    }
}

/* ---- the rest */

/* How to look for what was named, or for what cannot be told apart, each check once. */
static void section_next(struct document *document, const rotid_diagnosis *d, const char *deck)
{
    struct pool *pool = document->pool;
    const rotid_verdict *v = &d->verdict;
    int count = v->kind == -1 ? 0 : v->ncauses + v->nalternative_causes, n = 0;
    const char **text = POOL_ARRAY(pool, const char *, count + 1), *said = "";
    if (!text)
        return;
    for (int i = 0; i < count; i++) {
        const char *id = (i < v->ncauses ? &v->causes[i] : &v->alternative_causes[i - v->ncauses])->id, *check = cause_check(id);
        if (*check && !strstr(said, check))
            text[n++] = pool_text(pool, "%s: %s.", id, check);
        said = pool_text(pool, "%s%s;", said, check);
    }
    if (count && v->ncauses)
        text[n++] =
            pool_text(pool,
                      "To go on with the extended model: rotid diagnose %s --extended better.inp writes the deck with the "
                      "cause as a *CAUSE card, and rotid identify better.inp uses it.",
                      deck);
    if (!n)
        return;
    document_section(
        document, "look",
        d->verdict.ncauses ? "Inspect the rotor before you believe the verdict" : "The measurement that would decide", NULL);
    document_list(document, n, text);
}

static void section_findings(struct document *document, const rotid_diagnosis *d)
{
    struct pool *pool = document->pool;
    if (!d->ndata_findings && !d->nnumerical_findings)
        return;
    document_section(document, "findings", "Measurement and numbers", NULL);
    for (int i = 0; i < d->ndata_findings; i++)
        document_paragraph(document, "%s: %s. At the test: %s.", d->data_findings[i].id,
                           d->data_findings[i].text ? d->data_findings[i].text : "found", cause_check(d->data_findings[i].id));
    for (int i = 0; i < d->nnumerical_findings; i++) {
        const rotid_numerical_finding *finding = &d->numerical_findings[i];
        struct table *table = table_open(pool, pool_text(pool, "%s: its error in each mode", finding->id));
        document_paragraph(document, "%s: %s.", finding->id, finding->text ? finding->text : "found");
        for (int k = 0; k < finding->nmodes; k++) {
            number_column(table, "mode", NULL, SHOW_COUNT, finding->modes[k]);
            number_column(table, "error of the frequency", "%", SHOW_SIGNED(3), finding->error_percent[k]);
        }
        document_table(document, table);
    }
}

static void section_detection_limits(struct document *document, const rotid_diagnosis *d)
{
    if (!d->ndetectable)
        return;
    document_section(document, "limits", "Detection limits", NULL);
    document_paragraph(document,
                       "An effect below its limit would not have shown in this measurement, and may be present. A size is the "
                       "distance from no effect; an effect of that size shows in 9 of 10 tests at 3 false alarms in 100.");
    document_figures(document, "limits");
    document_table(document, table_of_detectable(document->pool, d->ndetectable, d->detectable,
                                                 "Detection limits: the smallest size of each cause that would have shown"));
}

void section_diagnose(struct document *document, const struct result *result)
{
    const rotid_diagnosis *d = result->diagnose;
    if (d->base) {
        document_section(document, "misfit",
                         d->extended || d->verdict.kind == ROTID_ADEQUATE ? "Model and measurement" : "Where the model misses",
                         "shapes");
        document_figures(document, "agreement");
    }
    if (d->base && d->verdict.kind >= 0) {
        document_section(document, "worth", d->extended ? "Gain of the extended model" : "Quality of the model", "gain");
        document_table(document, table_of_quality(document->pool, d));
    }
    section_explanations(document, d);
    section_evidence(document, d);
    section_why(document, d);
    section_next(document, d, result->head.deck ? result->head.deck : "DECK");
    section_parameters(document, d);
    section_findings(document, d);
    if (d->base) {
        document_section(document, "modes-compared", "Mode by mode", "matrices");
        document_table(document, table_of_compared_modes(document->pool, &result->head, d->extended ? d->extended : d->base,
                                                         d->extended ? "Modes of the extended model" : NULL));
        if (d->extended)
            document_table(document, table_of_compared_modes(document->pool, &result->head, d->base,
                                                             "Modes of the model without the cause"));
    }
    if (d->base && d->verdict.kind != ROTID_ADEQUATE) { /* the most of mere noise is no place to look at */
        document_section(document, "places", "Where on the rotor", "places");
    }
    section_detection_limits(document, d);
}
