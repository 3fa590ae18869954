/* The verdict of a diagnosis in plain words, what to do next, and what it rests on. */
#include <math.h>
#include <string.h>

#include "page/cause_words.h"
#include "page/hidden_words.h"
#include "page/human.h"
#include "page/sections.h"

#define MOST_REASONS 16
#define LISTED       3 /* causes in the answer; the others stand in the table */

struct reasons {
    struct pool *pool;
    int count;
    const char *text[MOST_REASONS];
};

static void say(struct reasons *reasons, const char *text)
{
    if (reasons->count < MOST_REASONS && text && *text)
        reasons->text[reasons->count++] = text;
}

static const char *or_nothing(const char *text)
{
    return text ? text : "";
}

/* "a mass ... (added_mass: ...); and a zone ..." */
static const char *causes(struct pool *pool, const rotid_diagnosis *d, int count, const rotid_cause *cause, const char *between)
{
    const char *text = "";
    int others = cause == d->verdict.alternative_causes;
    for (int i = 0; i < count && i < LISTED && text; i++)
        text = pool_format(pool, "%s%s%s", text,
                           !i                                          ? ""
                           : others && verdict_is_pair(&d->verdict, i) ? " together with "
                           : i + 1 == count                            ? between
                                                                       : "; ",
                           cause_in_words(pool, d, &cause[i], count == 1 || cause == d->verdict.causes));
    if (count > LISTED && text)
        text = pool_format(pool, "%s%s%s more", text, between, human_count(pool, count - LISTED));
    return or_nothing(text);
}

/* Faults of the data, as a sentence that begins with a blank. */
static const char *faults(struct pool *pool, const rotid_diagnosis *d)
{
    const char *text = "";
    for (int i = 0; i < d->ndata_findings && i < LISTED && text; i++)
        text = pool_format(pool, "%s%s%s", text, i ? "; " : "",
                           d->data_findings[i].text ? d->data_findings[i].text : d->data_findings[i].id);
    if (!d->ndata_findings)
        return "";
    return or_nothing(pool_format(
        pool, " %s of the measurement %s taken into account: %s%s.",
        words_sentence(pool, or_nothing(pool_format(pool, "%s %s", human_count(pool, d->ndata_findings),
                                                    human_plural(d->ndata_findings, "fault", "faults")))),
        human_plural(d->ndata_findings, "was", "were"), or_nothing(text), d->ndata_findings > LISTED ? "; and more" : ""));
}

static const char *named(struct pool *pool, const rotid_diagnosis *d)
{
    const char *what = causes(pool, d, d->verdict.ncauses, d->verdict.causes, "; and "),
               *with = d->verdict.ncauses > 1 ? "With these causes" : "With this cause";
    if (d->verdict.adequate_after)
        return pool_format(pool, "The model lacks %s. %s the model explains the measurement within its noise.", what, with);
    if (d->verdict.nalternative_causes)
        return pool_format(pool, "The model lacks %s. These data cannot tell what causes the rest: it may be %s.", what,
                           causes(pool, d, d->verdict.nalternative_causes, d->verdict.alternative_causes, "; or "));
    return pool_format(
        pool, "The model lacks %s. %s the residual still exceeds the noise, and no cause in the catalogue explains the rest.",
        what, with);
}

static const char *verdict(struct pool *pool, const rotid_diagnosis *d)
{
    const char *text = "";
    switch (d->verdict.kind) {
    default:
        return !d->base ? "The diagnosis was interrupted before the model was fitted: there is nothing to judge yet."
               : d->verdict.ncauses
                   ? pool_format(
                         pool,
                         "The diagnosis was interrupted before a verdict. A round that was finished would name %s; the rounds "
                         "that did not run may speak against that.",
                         causes(pool, d, d->verdict.ncauses, d->verdict.causes, "; and "))
                   : "The diagnosis was interrupted before a verdict. The finished part stands below: it shows where the model "
                     "misses the measurement, and does not say why.";
    case ROTID_ADEQUATE:
        text = "The model explains the measurement within its noise: these data give no reason to doubt it.";
        break;
    case ROTID_NAMED:
        text = named(pool, d);
        break;
    case ROTID_AMBIGUOUS:
        text =
            verdict_sets(&d->verdict) == 1
                ? pool_format(pool,
                              "Something is wrong with the model. One cause would explain the misfit, but these data do not "
                              "suffice to name a cause: %s.",
                              causes(pool, d, d->verdict.nalternative_causes, d->verdict.alternative_causes, ""))
                : pool_format(
                      pool, "Something is wrong with the model, and these data cannot tell which of %s causes is present%s: %s.",
                      human_count(pool, verdict_sets(&d->verdict)),
                      !d->verdict.confident ? ", nor surely that any of them is" : "",
                      causes(pool, d, d->verdict.nalternative_causes, d->verdict.alternative_causes, "; or "));
        break;
    case ROTID_UNEXPLAINED:
        text = "Something is wrong with the model, and no cause in the catalogue explains the misfit.";
        break;
    }
    return pool_format(pool, "%s%s%s", or_nothing(text), faults(pool, d),
                       d->interrupted ? " The diagnosis was interrupted afterwards: the rest of this page is not complete." : "");
}

/* "step_stiffness and added_mass" */
static const char *names(struct pool *pool, const rotid_diagnosis *d)
{
    const char *text = "";
    for (int i = 0; i < d->verdict.ncauses && text; i++)
        text = pool_format(pool, "%s%s%s", text,
                           !i                            ? ""
                           : i + 1 == d->verdict.ncauses ? " and "
                                                         : ", ",
                           cause_label(pool, d, &d->verdict.causes[i]));
    return or_nothing(text);
}

/* The parameters in a sentence, with a blank before it: "core.E = 115.7 GPa (95 %: 115.0 to 116.4)"; what cannot be told apart
 * has its spread. */
static const char *values(struct pool *pool, const rotid_diagnosis *d)
{
    const rotid_identification *fit = d->extended ? d->extended : d->base;
    const rotid_verdict *v = &d->verdict;
    const char *text = "";
    int shown = 0;
    for (int p = 0; d->base && fit && v->kind >= 0 && p < d->base->nparameters && p < LISTED && text; p++) {
        const rotid_fitted_parameter *value = fit_parameter(fit, d->base->parameters[p].name);
        const rotid_spread *spread = p < v->nspread && verdict_sets(v) > 1 ? &v->spread[p] : NULL;
        if (spread) {
            struct human_unit unit = human_unit(spread->highest, spread->unit);
            text = pool_format(pool, "%s%s%s = %s to %s%s%s, depending on the cause", text, shown++ ? "; " : " ", spread->name,
                               human_digits(pool, spread->lowest * unit.factor, 4),
                               human_digits(pool, spread->highest * unit.factor, 4), *unit.text ? "\xc2\xa0" : "", unit.text);
        } else if (value) {
            text = pool_format(pool, "%s%s%s = %s", text, shown++ ? "; " : " ", value->name,
                               human_interval(pool, value->value, value->ci95, value->unit));
        }
    }
    return shown && text ? or_nothing(pool_format(pool, "%s.", text)) : "";
}

static const char *headline(struct pool *pool, const rotid_diagnosis *d, const char *shifts)
{
    switch (d->verdict.kind) {
    case ROTID_ADEQUATE:
        return *shifts ? pool_format(pool, "Adequate, but what these data do not show may move %s", shifts) : "Adequate";
    case ROTID_NAMED:
        return pool_format(pool, "Named: %s%s%s", names(pool, d), *shifts ? "; what these data do not show may move " : "",
                           shifts);
    case ROTID_AMBIGUOUS:
        return verdict_sets(&d->verdict) == 1
                   ? "Ambiguous: no name can be given"
                   : pool_format(pool, "Ambiguous: one of %s causes", human_count(pool, verdict_sets(&d->verdict)));
    case ROTID_UNEXPLAINED:
        return "Unexplained";
    default:
        return "Interrupted: no verdict";
    }
}

/* How to look for all that was named. */
static const char *checks(struct pool *pool, const rotid_diagnosis *d)
{
    const char *text = "";
    for (int i = 0; i < d->verdict.ncauses && text; i++)
        if (!strstr(text, cause_check(d->verdict.causes[i].id)))
            text = pool_format(pool, "%s%s%s", text, *text ? "; " : "", cause_check(d->verdict.causes[i].id));
    return or_nothing(text);
}

static const char *next(struct pool *pool, const rotid_diagnosis *d, const char *deck)
{
    const char *text = d->verdict.next_measurement, *look = checks(pool, d);
    if (d->verdict.kind == -1)
        return pool_format(pool, "Next: run rotid diagnose %s to its end.", deck);
    if (d->verdict.kind == ROTID_ADEQUATE)
        return "Next: read the detection limits below before you rely on the moduli. Smaller effects may be present.";
    if (d->verdict.kind == ROTID_NAMED && *look && !(text && strstr(text, look))) /* or it says it already */
        text = pool_format(pool, "%s%s%s", look, text ? "; and " : ", before you believe the verdict", text ? text : "");
    return text ? pool_format(pool, "Next: %s.", text) : NULL;
}

/* How often chance does what was found, and what that rests on. */
static void on_chance(struct reasons *reasons, const rotid_diagnosis *d)
{
    struct pool *pool = reasons->pool;
    const rotid_round *round = d->nrounds ? d->rounds : NULL;
    int assumed = d->noise.frequency_assumed || d->noise.shape_assumed;
    if (round && isfinite(d->verdict.p_value))
        say(reasons, pool_format(pool,
                                 "A model that is right misses the measurement so far or further %s tests: the "
                                 "misfit \xcf\x87\xc2\xb2 is %s, where a right model has about %d.",
                                 words_chance(pool, d->verdict.p_value), human_digits(pool, round->chi2, 3), round->dof));
    if (round && d->verdict.kind == ROTID_ADEQUATE && isfinite(round->largest) && isfinite(round->threshold))
        say(reasons,
            pool_format(pool,
                        "No cause of the catalogue promises to lower it by more than %s; chance alone reaches %s in 3 of "
                        "100 tests.",
                        human_digits(pool, round->largest, 2), human_digits(pool, round->threshold, 2)));
    if (assumed)
        say(reasons, "The deck does not state all of the noise. The assumed values stand below; another noise may change the "
                     "verdict, so no cause is named: state *NOISE.");
}

static void on_lead(struct reasons *reasons, const rotid_diagnosis *d)
{
    struct pool *pool = reasons->pool;
    const rotid_round *round = d->rounds;
    int first, second, count, tried = 0;
    if (!d->nrounds || d->verdict.kind == -1)
        return;
    const rotid_candidate *candidate = diagnosis_candidates(d, 0, &count);
    diagnosis_leaders(d, 0, &first, &second);
    for (int i = 0; i < count; i++)
        tried += candidate[i].refitted;
    if (d->verdict.kind == ROTID_NAMED && first >= 0 && second >= 0)
        say(reasons,
            pool_format(pool,
                        "Of %s causes that were fitted %s leads the next one, %s, by %s in the misfit; the required lead is %s.",
                        human_count(pool, tried), candidate_words(pool, d, &candidate[first]),
                        candidate_words(pool, d, &candidate[second]),
                        human_digits(pool, candidate_lead(&candidate[first], &candidate[second]), 3),
                        human_trimmed(pool, round->required_margin, 3)));
    else if (d->verdict.kind == ROTID_NAMED && first >= 0 && tried > 1)
        say(reasons, pool_format(pool,
                                 "Of %s causes that were fitted all others were refused, for their size or because they predict "
                                 "held-out modes worse.",
                                 human_count(pool, tried)));
    if (d->verdict.kind == ROTID_AMBIGUOUS && verdict_sets(&d->verdict) > 1 && isfinite(round->required_margin))
        say(reasons, pool_format(pool,
                                 "None of them leads the others by %s in the misfit, the lead that a name requires. Their order "
                                 "is that of the fit, and the next test may reverse it.",
                                 human_trimmed(pool, round->required_margin, 3)));
    if (d->verdict.kind == ROTID_UNEXPLAINED)
        say(reasons,
            tried ? pool_format(pool, "%s %s fitted and refused; the evidence says why.",
                                words_sentence(pool, human_count(pool, tried)), human_plural(tried, "cause was", "causes were"))
                  : "No cause of the catalogue promises enough to be fitted.");
}

static void on_left_out(struct reasons *reasons, const rotid_diagnosis *d)
{
    struct pool *pool = reasons->pool;
    const struct {
        const rotid_pair *pair;
        const char *what;
    } rows[] = {{&d->gain.holdout_frequency_rms_percent, "the modes that the deck holds out"},
                {&d->gain.mode_out_frequency_rms_percent, "modes left out in turn"}};
    for (int i = 0; i < 2; i++) {
        double before = rows[i].pair->before, after = rows[i].pair->after;
        if (!isfinite(before) || !d->verdict.ncauses || !isfinite(after))
            continue;
        say(reasons,
            pool_format(pool,
                        "Frequencies of %s are predicted to %s\xc2\xa0%% rms, the model without the cause leaves %s\xc2\xa0%%.",
                        rows[i].what, human_digits(pool, after, 2), human_digits(pool, before, 2)));
    }
}

static void on_parameters(struct reasons *reasons, const rotid_diagnosis *d)
{
    struct pool *pool = reasons->pool;
    const char *moved = "";
    int count = 0;
    for (int p = 0; p < d->gain.nparameters && moved; p++) {
        double percent = 100 * (d->gain.parameters[p].after / d->gain.parameters[p].before - 1);
        if (isfinite(percent))
            moved = pool_format(pool, "%s%s%s by %s\xc2\xa0%%", moved, count++ ? ", " : "", d->gain.parameters[p].name,
                                human_signed(pool, percent, fabs(percent) < 1 ? 2 : 1));
    }
    if (count && moved && d->verdict.kind != -1)
        say(reasons, pool_format(pool, "The missing cause had biased the parameters; the extended model moves %s.", moved));
    const rotid_identification *fit = d->extended ? d->extended : d->base;
    for (int p = 0; fit && p < fit->nparameters; p++)
        if (!fit->parameters[p].identifiable)
            say(reasons, pool_format(pool, "%s %s.", fit->parameters[p].name,
                                     fit->parameters[p].at_bound ? "ends at its bound: its value without the bound is not known"
                                                                 : "is not determined by these data"));
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
    for (int p = 0; p < today->nparameters && text; p++)
        for (int q = 0; q < final->nparameters && text; q++) {
            double percent = 100 * (today->parameters[p].value / final->parameters[q].value - 1);
            if (strcmp(today->parameters[p].name, final->parameters[q].name) != 0 || !isfinite(percent))
                continue;
            text = pool_format(pool, "%s%s%s = %s, %s\xc2\xa0%%", text, count++ ? "; " : "", today->parameters[p].name,
                               human_value(pool, today->parameters[p].value, today->parameters[p].unit),
                               human_signed(pool, percent, 1));
        }
    if (count && text)
        say(reasons,
            pool_format(pool,
                        "The fit as the deck states it (%s, reduction %s) gives %s against the %s here, which is the full "
                        "model judged by the likelihood.",
                        today->functional, today->reduction, text, d->extended ? "extended model" : "model"));
}

static void on_data(struct reasons *reasons, const rotid_diagnosis *d)
{
    for (int i = 0; i < d->nnumerical_findings; i++)
        if (d->numerical_findings[i].text)
            say(reasons, pool_format(reasons->pool, "Numbers: %s.", d->numerical_findings[i].text));
}

void answer_diagnose(struct document *document, const struct result *result)
{
    static const enum tone tones[] = {TONE_BAD, TONE_GOOD, TONE_CARE, TONE_CARE, TONE_BAD};
    const rotid_diagnosis *d = result->diagnose;
    struct reasons reasons = {.pool = document->pool};
    document->tone = tones[d->verdict.kind + 1];
    const rotid_identification *fit = d->extended ? d->extended : d->base;
    int explained = d->verdict.kind == ROTID_ADEQUATE || d->verdict.adequate_after;
    if (d->verdict.kind == ROTID_ADEQUATE && fit && hidden_is_wide(fit, d->nhidden, d->hidden))
        document->tone = TONE_CARE;
    document->headline =
        headline(document->pool, d, explained && fit ? hidden_shifts_in_words(document->pool, fit, d->nhidden, d->hidden) : "");
    document->answer =
        or_nothing(pool_format(document->pool, "%s%s", or_nothing(verdict(document->pool, d)), values(document->pool, d)));
    document->next = next(document->pool, d, result->head.deck ? result->head.deck : "DECK");
    on_chance(&reasons, d);
    on_lead(&reasons, d);
    on_left_out(&reasons, d);
    on_parameters(&reasons, d);
    on_today(&reasons, d);
    on_data(&reasons, d);
    if (d->verdict.sentence) /* holds what no key does: a second place, parameters that the data leave open */
        say(&reasons, pool_format(document->pool, "In the words of rotid diagnose: %s", d->verdict.sentence));
    if (!reasons.count)
        return;
    document_section(document, "trust", "Why");
    document_list(document, reasons.count, reasons.text);
    section_parameters(document, d);
}
