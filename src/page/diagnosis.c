/* A diagnosis: the verdict in the words of the verdict itself, the tiles, then what a reader asks: what did the cause change,
 * which causes are possible, is the measurement sound, where does the model miss it, which effects stay undetected. */
#include "diagnose/causes/causes.h"
#include "fit/fit.h"
#include "page/page.h"

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

static const char *next(struct pool *pool, const rotid_diagnosis *d, const char *deck)
{
    const char *text = d->verdict.next_measurement;
    if (d->verdict.kind == -1)
        return pool_text(pool, "Next: run rotid diagnose %s to its end.", deck);
    if (d->verdict.kind == ROTID_ADEQUATE)
        return "Next: read the detection limits below before you rely on the moduli. Smaller effects may be present.";
    if (d->verdict.kind == ROTID_NAMED)
        text = pool_text(pool, "inspect the rotor as below, before you believe the verdict%s%s", text ? "; and " : "",
                         or_nothing(text));
    return text ? pool_text(pool, "Next: %s.", text) : NULL;
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

static void section_said(struct document *document, const char *id, const char *heading, struct reasons said)
{
    if (!said.count)
        return;
    document_section(document, id, heading, NULL);
    document_list(document, said.count, said.text);
}

/* ---- parameters */

void section_hidden(struct document *document, const rotid_identification *fit, int count, const rotid_hidden *hidden)
{
    if (!count)
        return;
    document_section(document, "hidden", "Possible bias of the parameters", NULL);
    document_paragraph(
        document, "The model explains the measurement, and so would a model with one of these causes in it, of a size below its "
                  "detection limit. The fit without the cause moves the parameter as far as this. The size is the smallest "
                  "that shows in 9 of 10 tests at that place, or the largest that is physical, as its distance from no effect; a "
                  "smaller one moves the parameter less in proportion.");
    document_table(document, table_of_hidden(document->pool, fit, count, hidden));
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
    document_table(document, table_of_explanations(document->pool, d, 1));
}

static void section_evidence(struct document *document, const rotid_diagnosis *d)
{
    if (!d->nrounds)
        return;
    document_section(document, "causes", d->verdict.kind == ROTID_ADEQUATE ? "Causes that were tried" : "Possible causes",
                     "causes");
    for (int i = 0; i < d->nrounds; i++)
        document_table(document, table_of_candidates(document->pool, d, i, 1));
}

/* ---- the rest */

/* How to look for a cause. */
static const char *cause_check(const char *id)
{
    const struct cause_kind *kind = catalogue_find(id);
    return kind ? kind->check : "";
}

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

static void section_detection_limits(struct document *document, const rotid_diagnosis *d)
{
    if (!d->ndetectable)
        return;
    document_section(document, "limits", "Detection limits", NULL);
    document_paragraph(document,
                       "An effect below its limit would not have shown in this measurement, and may be present. A size is the "
                       "distance from no effect.");
    document_figures(document, "limits");
    document_table(document, table_of_detectable(document->pool, d->ndetectable, d->detectable));
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
    section_said(document, "trust", "Why", reasons_of_diagnosis(document->pool, d));
    section_next(document, d, result->head.deck ? result->head.deck : "DECK");
    section_parameters(document, d);
    section_said(document, "findings", "Measurement and numbers", findings_of_diagnosis(document->pool, d));
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
