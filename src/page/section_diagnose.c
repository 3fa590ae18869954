/* The sections of a diagnosis, in the order in which a reader asks: is the measurement sound, where does the model miss the
 * measurement, which causes are possible, what does the extended model gain, which effects stay undetected. */
#include <math.h>

#include "page/cause_words.h"
#include "page/figures.h"
#include "page/figures_diagnosis.h"
#include "page/human.h"
#include "page/sections.h"
#include "page/tables.h"
#include "page/tables_diagnosis.h"

/* How to look for what was named, or for what cannot be told apart, each check once. */
static void section_next(struct document *document, const rotid_diagnosis *d, const char *deck)
{
    struct pool *pool = document->pool;
    int count = d->verdict.kind == -1 ? 0 : d->verdict.ncauses + d->verdict.nalternative_causes, n = 0;
    const char **text = POOL_ARRAY(pool, const char *, count + 1);
    if (!text) {
        document->failed = 1;
        return;
    }
    for (int i = 0; i < count; i++) {
        const rotid_cause *cause =
            i < d->verdict.ncauses ? &d->verdict.causes[i] : &d->verdict.alternative_causes[i - d->verdict.ncauses];
        const char *check = cause_check(cause->id);
        int seen = !*check;
        for (int j = 0; j < i; j++)
            seen |= cause_check(
                        (j < d->verdict.ncauses ? &d->verdict.causes[j] : &d->verdict.alternative_causes[j - d->verdict.ncauses])
                            ->id) == check;
        if (!seen)
            text[n++] = pool_format(pool, "%s: %s.", cause->id, check);
    }
    if (count && d->verdict.ncauses)
        text[n++] =
            pool_format(pool,
                        "To go on with the extended model: rotid diagnose %s --extended better.inp writes the deck with the "
                        "cause as a *CAUSE card, and rotid identify better.inp uses it.",
                        deck);
    if (!n)
        return;
    document_section(document, "look",
                     d->verdict.ncauses ? "Inspect the rotor before you believe the verdict"
                                        : "The measurement that would decide");
    document_list(document, n, text);
}

static void section_findings(struct document *document, const rotid_diagnosis *d)
{
    struct pool *pool = document->pool;
    if (!d->ndata_findings && !d->nnumerical_findings)
        return;
    document_section(document, "findings", "Measurement and numbers");
    for (int i = 0; i < d->ndata_findings; i++) {
        const char *check = cause_check(d->data_findings[i].id);
        document_paragraph(document, "%s: %s. At the test: %s.", d->data_findings[i].id,
                           d->data_findings[i].text ? d->data_findings[i].text : "found", check);
    }
    for (int i = 0; i < d->nnumerical_findings; i++) {
        const rotid_numerical_finding *finding = &d->numerical_findings[i];
        document_paragraph(document, "%s: %s.", finding->id, finding->text ? finding->text : "found");
        if (finding->nmodes)
            document_table(document, pool_format(pool, "%s: its error in each mode", finding->id),
                           tables_numerical(pool, finding));
    }
}

static void section_misfit(struct document *document, const struct result *result)
{
    const rotid_diagnosis *d = result->diagnose;
    if (!d->base)
        return;
    document_section(document, "misfit", d->verdict.kind == ROTID_ADEQUATE ? "Model and measurement" : "Where the model misses");
    figure_residuals(document, result);
    figure_places(document, result);
    document_table(document,
                   d->extended ? "Modes of the model without the cause"
                               : "Modes: errors are predicted over measured frequency, less one",
                   tables_fitted_modes(document->pool, result, d->base));
}

static const char *round_says(struct pool *pool, const rotid_round *round, int number, int fitted)
{
    static const char *const kinds[] = {"no verdict", "the model is adequate", "a cause is named", "the data cannot tell",
                                        "no cause explains the misfit"};
    const char *text = pool_format(
        pool,
        "Round %d, %s: the misfit is %s for %d degrees of freedom. The largest drop that the linear scan expects is %s; %s.%s",
        number + 1, kinds[round->kind + 1], human_digits(pool, round->chi2, 4), round->dof, human_digits(pool, round->largest, 3),
        isfinite(round->threshold)
            ? pool_format(pool, "chance alone reaches %s in 3 of 100 tests", human_digits(pool, round->threshold, 3))
            : "the threshold of chance was not reached before the end",
        fitted ? "" : " Nothing promised enough to be fitted.");
    return text ? text : "";
}

static void section_evidence(struct document *document, const struct result *result)
{
    const rotid_diagnosis *d = result->diagnose;
    struct pool *pool = document->pool;
    if (!d->nrounds)
        return;
    document_section(document, "causes", d->verdict.kind == ROTID_ADEQUATE ? "Causes that were tried" : "Possible causes");
    for (int i = 0; i < d->nrounds; i++) {
        int fitted = 0, count;
        const rotid_candidate *candidate = diagnosis_candidates(d, i, &count);
        for (int k = 0; k < count; k++)
            fitted += candidate[k].refitted;
        document_paragraph(document, "%s", round_says(pool, &d->rounds[i], i, fitted));
        figure_evidence(document, result, i);
        if (!fitted)
            continue;
        document_table(document, pool_format(pool, "Candidates of round %d, those that stay first", i + 1),
                       tables_candidates(pool, d, i));
        document_table(
            document,
            pool_format(pool, "Fitted candidates of round %d: prediction error on held-out data, and the most similar candidate",
                        i + 1),
            tables_candidate_quality(pool, d, i));
        document_table(document, pool_format(pool, "Sizes and places of the candidates of round %d", i + 1),
                       tables_candidate_sizes(pool, d, i));
    }
}

static void section_gain(struct document *document, const struct result *result)
{
    const rotid_diagnosis *d = result->diagnose;
    if (!d->base || d->verdict.kind == -1)
        return;
    document_section(document, "worth", d->extended ? "Gain of the extended model" : "Quality and parameters of the model");
    figure_improvement(document, result);
    figure_gain(document, result);
    document_table(document, d->extended ? "Quality before and after" : "Quality of the model",
                   tables_quality(document->pool, d));
    figure_change(document, result);
    if (!d->extended && !diagnosis_today(d))
        figure_intervals(document, result, d->base);
    figure_shapes(document, result, d->extended ? d->extended : d->base);
}

static void section_detection_limits(struct document *document, const rotid_diagnosis *d)
{
    if (!d->ndetectable)
        return;
    document_section(document, "limits", "Detection limits");
    document_paragraph(document,
                       "An effect below its limit would not have shown in this measurement, and may be present. A size is the "
                       "distance from no effect; an effect of that size shows in 9 of 10 tests at 3 false alarms in 100.");
    document_table(document, "Detection limits: the smallest size of each cause that would have shown",
                   tables_detection_limits(document->pool, d));
}

void section_diagnose(struct document *document, const struct result *result)
{
    const rotid_diagnosis *d = result->diagnose;
    section_next(document, d, result->head.deck ? result->head.deck : "DECK");
    section_findings(document, d);
    section_misfit(document, result);
    section_evidence(document, result);
    section_gain(document, result);
    section_detection_limits(document, d);
}
