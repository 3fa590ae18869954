/* The verdict of a diagnosis in plain words, what to do next, and what it rests on. */
#include <math.h>
#include <string.h>

#include "page/cause_words.h"
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
static const char *causes(struct pool *pool, const struct diagnosis_outcome *d, int count, const struct told_cause *cause,
                          const char *between)
{
    const char *text = "";
    for (int i = 0; i < count && i < LISTED && text; i++)
        text = pool_format(pool, "%s%s%s", text,
                           !i               ? ""
                           : i + 1 == count ? between
                                            : "; ",
                           cause_in_words(pool, &cause[i], count == 1 || cause == d->cause));
    if (count > LISTED && text)
        text = pool_format(pool, "%s%s%s more", text, between, human_count(pool, count - LISTED));
    return or_nothing(text);
}

/* Faults of the data, as a sentence that begins with a blank. */
static const char *faults(struct pool *pool, const struct diagnosis_outcome *d)
{
    const char *text = "";
    for (int i = 0; i < d->ndata && i < LISTED && text; i++)
        text = pool_format(pool, "%s%s%s", text, i ? "; " : "", d->data[i].text ? d->data[i].text : d->data[i].id);
    if (!d->ndata)
        return "";
    return or_nothing(pool_format(pool, " %s of the measurement %s taken into account: %s%s.",
                                  words_sentence(pool, or_nothing(pool_format(pool, "%s %s", human_count(pool, d->ndata),
                                                                              human_plural(d->ndata, "fault", "faults")))),
                                  human_plural(d->ndata, "was", "were"), or_nothing(text),
                                  d->ndata > LISTED ? "; and more" : ""));
}

/* The data are too few for that, or their noise is not stated: the result says so in its sentence alone. */
static int unsure(const struct diagnosis_outcome *d)
{
    return d->sentence && strstr(d->sentence, "nor with confidence") != NULL;
}

static const char *named(struct pool *pool, const struct diagnosis_outcome *d)
{
    const char *what = causes(pool, d, d->ncause, d->cause, "; and "), *with = d->ncause > 1 ? "With them" : "With it";
    if (d->adequate_after)
        return pool_format(pool, "The model lacks %s. %s it explains the measurement within its noise.", what, with);
    if (d->nalternative)
        return pool_format(pool, "The model lacks %s. What is left then, these data cannot tell: it may be %s.", what,
                           causes(pool, d, d->nalternative, d->alternative, "; or "));
    return pool_format(
        pool, "The model lacks %s. %s it still leaves more than noise, and nothing in the catalogue explains that.", what, with);
}

static const char *verdict(struct pool *pool, const struct diagnosis_outcome *d)
{
    const char *text = "";
    switch (d->kind) {
    case TOLD_NONE:
        return !d->base ? "The diagnosis was interrupted before the model was fitted: there is nothing to judge yet."
               : d->ncause
                   ? pool_format(
                         pool,
                         "The diagnosis was interrupted before a verdict. A round that was finished would name %s; what would "
                         "have followed may speak against it.",
                         causes(pool, d, d->ncause, d->cause, "; and "))
                   : "The diagnosis was interrupted before a verdict. Below stands what was finished: it shows where the model "
                     "misses the measurement, and does not say why.";
    case TOLD_ADEQUATE:
        text = "The model explains the measurement within its noise: these data give no reason to doubt it.";
        break;
    case TOLD_NAMED:
        text = named(pool, d);
        break;
    case TOLD_AMBIGUOUS:
        text = d->nalternative == 1
                   ? pool_format(pool,
                                 "Something is wrong with the model. One cause would explain it, but these data cannot carry its "
                                 "name: %s.",
                                 causes(pool, d, 1, d->alternative, ""))
                   : pool_format(pool,
                                 "Something is wrong with the model, and these data cannot tell which of %s causes it is%s: %s.",
                                 human_count(pool, d->nalternative), unsure(d) ? ", nor surely that it is one of them" : "",
                                 causes(pool, d, d->nalternative, d->alternative, "; or "));
        break;
    case TOLD_UNEXPLAINED:
        text = "Something is wrong with the model, and nothing in the catalogue of causes explains it.";
        break;
    }
    return pool_format(pool, "%s%s%s", or_nothing(text), faults(pool, d),
                       d->interrupted ? " It was interrupted afterwards: what follows is not complete." : "");
}

static const char *headline(struct pool *pool, const struct diagnosis_outcome *d)
{
    const char *label = d->ncause ? cause_label(pool, &d->cause[0]) : "";
    switch (d->kind) {
    case TOLD_ADEQUATE:
        return "Adequate";
    case TOLD_NAMED:
        return d->ncause > 1 ? pool_format(pool, "Named: %s and %s more", label, human_count(pool, d->ncause - 1))
                             : pool_format(pool, "Named: %s", label);
    case TOLD_AMBIGUOUS:
        return d->nalternative == 1 ? "Ambiguous: no name can be given"
                                    : pool_format(pool, "Ambiguous: one of %s causes", human_count(pool, d->nalternative));
    case TOLD_UNEXPLAINED:
        return "Unexplained";
    default:
        return "Interrupted: no verdict";
    }
}

static const char *next(struct pool *pool, const struct diagnosis_outcome *d, const char *deck)
{
    const char *text = d->next_measurement, *check = d->ncause ? cause_check(d->cause[0].id) : "";
    if (d->kind == TOLD_NONE)
        return pool_format(pool, "Next: run rotid diagnose %s to its end.", deck);
    if (d->kind == TOLD_ADEQUATE)
        return "Next: read the blind spots below before you rely on the moduli. What is smaller than they say may be there.";
    if (d->kind == TOLD_NAMED && *check)
        text = text && strstr(text, check)
                   ? text /* says it already */
                   : pool_format(pool, "%s%s%s", check, text ? "; and " : ", before you believe it", text ? text : "");
    return text ? pool_format(pool, "Next: %s.", text) : NULL;
}

/* How often chance does what was found, and what that rests on. */
static void on_chance(struct reasons *reasons, const struct diagnosis_outcome *d, const struct result *result)
{
    struct pool *pool = reasons->pool;
    const struct evidence_round *round = d->nround ? d->round : NULL;
    int assumed = result->frequency_assumed || result->shape_assumed;
    if (round && isfinite(d->p_value))
        say(reasons, pool_format(pool,
                                 "A model that is right misses the measurement so far or further %s tests: the "
                                 "misfit \xcf\x87\xc2\xb2 is %s, where a right model has about %d.",
                                 words_chance(pool, d->p_value), human_digits(pool, round->chi2, 3), round->dof));
    if (round && d->kind == TOLD_ADEQUATE && isfinite(round->largest) && isfinite(round->threshold))
        say(reasons,
            pool_format(pool,
                        "No cause of the catalogue promises to lower it by more than %s; chance alone reaches %s in 3 of "
                        "100 tests.",
                        human_digits(pool, round->largest, 2), human_digits(pool, round->threshold, 2)));
    if (assumed)
        say(reasons, "The deck does not state all of the noise. What is assumed stands below; with another noise the verdict may "
                     "be another one, so no cause is named: state *NOISE.");
}

static void on_lead(struct reasons *reasons, const struct diagnosis_outcome *d)
{
    struct pool *pool = reasons->pool;
    const struct evidence_round *round = d->round;
    int first, second, tried = 0;
    if (!d->nround || d->kind == TOLD_NONE)
        return;
    diagnosis_leaders(round, &first, &second);
    for (int i = 0; i < round->ncandidate; i++)
        tried += round->candidate[i].refitted;
    if (d->kind == TOLD_NAMED && first >= 0 && second >= 0)
        say(reasons,
            pool_format(pool, "Of %s causes that were fitted it leads the next one, %s, by %s in the misfit; %s are asked for.",
                        human_count(pool, tried), cause_label(pool, &round->candidate[second].cause),
                        human_digits(pool, diagnosis_lead(&round->candidate[first], &round->candidate[second]), 3),
                        human_trimmed(pool, round->required_margin, 3)));
    else if (d->kind == TOLD_NAMED && first >= 0 && tried > 1)
        say(reasons,
            pool_format(pool,
                        "Of %s causes that were fitted all others were refused, for their size or for what they do to modes "
                        "that were held out.",
                        human_count(pool, tried)));
    if (d->kind == TOLD_AMBIGUOUS && d->nalternative > 1 && isfinite(round->required_margin))
        say(reasons, pool_format(pool,
                                 "None of them leads the others by %s in the misfit, which a name asks for. The order in which "
                                 "they stand is that of the fit, and the next test may reverse it.",
                                 human_trimmed(pool, round->required_margin, 3)));
    if (d->kind == TOLD_UNEXPLAINED)
        say(reasons,
            tried ? pool_format(pool, "%s %s fitted and refused; the evidence says why.",
                                words_sentence(pool, human_count(pool, tried)), human_plural(tried, "cause was", "causes were"))
                  : "No cause of the catalogue promises enough to be fitted.");
}

static void on_left_out(struct reasons *reasons, const struct diagnosis_outcome *d)
{
    struct pool *pool = reasons->pool;
    static const struct {
        enum gain_kind gain;
        const char *what;
    } rows[] = {{GAIN_HELD_FREQUENCY, "the modes that the deck holds out"}, {GAIN_MODE_FREQUENCY, "modes left out in turn"}};
    for (int i = 0; i < 2; i++) {
        double before = d->gain[rows[i].gain].before, after = d->gain[rows[i].gain].after;
        if (!isfinite(before) || !d->ncause || !isfinite(after))
            continue;
        say(reasons,
            pool_format(pool,
                        "Frequencies of %s are predicted to %s\xc2\xa0%% rms, where the model without it leaves %s\xc2\xa0%%.",
                        rows[i].what, human_digits(pool, after, 2), human_digits(pool, before, 2)));
    }
}

static void on_parameters(struct reasons *reasons, const struct diagnosis_outcome *d)
{
    struct pool *pool = reasons->pool;
    const char *moved = "";
    int count = 0;
    for (int p = 0; p < d->nparameter && moved; p++) {
        double percent = 100 * (d->parameter[p].after / d->parameter[p].before - 1);
        if (isfinite(percent))
            moved = pool_format(pool, "%s%s%s by %s\xc2\xa0%%", moved, count++ ? ", " : "", d->parameter[p].name,
                                human_signed(pool, percent, fabs(percent) < 1 ? 2 : 1));
    }
    if (count && moved && d->kind != TOLD_NONE)
        say(reasons, pool_format(pool, "What was missing had moved the parameters: with it they change, %s.", moved));
    const struct fitted *fit = d->extended ? d->extended : d->base;
    for (int p = 0; fit && p < fit->nparameter; p++)
        if (!fit->parameter[p].identifiable)
            say(reasons, pool_format(pool, "%s %s.", fit->parameter[p].name,
                                     fit->parameter[p].at_bound ? "ends at its bound: what it would be beyond is not known"
                                                                : "is not determined by these data"));
}

/* What the FIT of the deck makes of the parameters beside the full model. */
static void on_today(struct reasons *reasons, const struct diagnosis_outcome *d)
{
    struct pool *pool = reasons->pool;
    const struct fitted *final = d->extended ? d->extended : d->base, *today = diagnosis_today(d);
    const char *text = "";
    int count = 0;
    if (!today || !final)
        return;
    for (int p = 0; p < today->nparameter && text; p++)
        for (int q = 0; q < final->nparameter && text; q++) {
            double percent = 100 * (today->parameter[p].value / final->parameter[q].value - 1);
            if (strcmp(today->parameter[p].name, final->parameter[q].name) != 0 || !isfinite(percent))
                continue;
            text = pool_format(pool, "%s%s%s = %s, %s\xc2\xa0%%", text, count++ ? "; " : "", today->parameter[p].name,
                               human_value(pool, today->parameter[p].value, today->parameter[p].unit),
                               human_signed(pool, percent, 1));
        }
    if (count && text)
        say(reasons,
            pool_format(pool,
                        "The fit as the deck states it (%s, reduction %s) gives %s against the %s here, which is the full "
                        "model judged by the likelihood.",
                        today->functional, today->reduction, text, d->extended ? "extended model" : "model"));
}

static void on_data(struct reasons *reasons, const struct diagnosis_outcome *d)
{
    for (int i = 0; i < d->nnumerical; i++)
        if (d->numerical[i].text)
            say(reasons, pool_format(reasons->pool, "Numbers: %s.", d->numerical[i].text));
}

void answer_diagnose(struct document *document, const struct result *result)
{
    static const enum tone tones[] = {TONE_BAD, TONE_GOOD, TONE_CARE, TONE_CARE, TONE_BAD};
    const struct diagnosis_outcome *d = result->diagnosis;
    struct reasons reasons = {.pool = document->pool};
    document->tone = tones[d->kind];
    document->headline = headline(document->pool, d);
    document->answer = or_nothing(verdict(document->pool, d));
    document->next = next(document->pool, d, result->deck ? result->deck : "DECK");
    on_chance(&reasons, d, result);
    on_lead(&reasons, d);
    on_left_out(&reasons, d);
    on_parameters(&reasons, d);
    on_today(&reasons, d);
    on_data(&reasons, d);
    if (!reasons.count)
        return;
    document_section(document, "trust", "Why");
    document_list(document, reasons.count, reasons.text);
}
