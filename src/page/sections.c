/* What a page says of a fit, of modes, sensitivities, transfer functions, a modal analysis and a suggestion. */
#include <math.h>
#include <string.h>

#include "fit/fit.h"
#include "page/page.h"
#include "report/report.h"

void section_agreement(struct document *document, const struct result *result)
{
    document_section(document, "agreement", "Model and measurement");
    document_figures(document, "shapes");
    document_figures(document, "agreement");
    document_figures(document, "matrices");
    document_table(document, table_of_compared_modes(document->pool, &result->head, 0, result->identify, NULL));
    if (result->identify->nweighed)
        document_table(document, table_of_weighed(document->pool, result->identify->nweighed, result->identify->weighed));
    if (result->identify->nrunup)
        document_table(document, table_of_runup(document->pool, result->identify->nrunup, result->identify->runup));
}

void section_identify(struct document *document, const struct result *result)
{
    const rotid_identification *fit = result->identify;
    section_trust(document, result);
    if (fit->nstates) {
        document_section(document, "states", "All states together");
        document_figures(document, "states");
        document_table(document, table_of_states(document->pool, fit));
    }
    document_section(document, "parameters", "What was identified");
    document_figures(document, "parameters");
    document_table(document, table_of_parameters(document->pool, fit));
    document_section(document, "fit", "How the fit got there");
    document_figures(document, "fit");
    document_table(document, table_of_minimisers(document->pool, fit));
}

void section_modes(struct document *document, const struct result *result)
{
    document_section(document, "model-modes", "Modes of the model");
    document_figures(document, "modes");
    document_table(document, table_of_model_modes(document->pool, result->modes));
    if (!result->modes->beside)
        return;
    document_section(document, "beside", "The beam beside the solid");
    if (result->modes->beside->sentence)
        document_paragraph(document, "In short, %s.", result->modes->beside->sentence);
    document_table(document, table_of_beside_modes(document->pool, result->modes->beside));
    document_table(document, table_of_beside_moduli(document->pool, result->modes->beside));
}

void section_sensitivity(struct document *document, const struct result *result)
{
    struct pool *pool = document->pool;
    const struct sensitivity *s = result->sensitivity;
    const char *at = "";
    for (int p = 0; p < s->nparameters && at; p++)
        at = pool_format(pool, "%s%s%s = %s", at, p ? ", " : "", s->parameters[p].name,
                         human_value(pool, s->parameters[p].reference, s->parameters[p].unit));
    document_section(document, "dependence", "Sensitivity");
    document_paragraph(document, "At %s, reduction %s.", or_nothing(at), s->reduction);
    document_figures(document, "sensitivity");
    document_table(document, table_of_sensitivity(pool, s));
}

void section_transfer(struct document *document, const struct result *result)
{
    const struct transfer_result *out = result->frf;
    struct pool *pool = document->pool;
    const char *at = "";
    document_section(document, "transfer", "Transfer functions");
    document_paragraph(document, "%d synthesised %s from modes up to %s with the damping below; %s%s.", out->nfunctions,
                       human_plural(out->nfunctions, "function", "functions"), human_value(pool, out->modes_up_to_hz, "Hz"),
                       out->measured_file ? "measured ones from " : "none was measured", or_nothing(out->measured_file));
    for (int p = 0; p < out->nparameters && at; p++)
        at = pool_format(pool, "%s%s%s = %s", at, p ? ", " : "", out->parameters[p].name,
                         human_value(pool, out->parameters[p].value, out->parameters[p].unit));
    if (out->nparameters)
        document_paragraph(document, "The model is the identified one: %s.", or_nothing(at));
    if (out->agreement && isfinite(out->agreement->frac))
        document_paragraph(
            document, "FRAC over all functions is %s, and %s with the measured frequencies put in for the model's.",
            human_fixed(pool, out->agreement->frac, 3), human_fixed(pool, out->agreement->frac_at_measured_frequencies, 3));
    if (!out->with_curves)
        document_paragraph(document, "The result has no curves, because there were too many lines: rotid frf -o writes them as a "
                                     "universal file.");
    if (!out->complete)
        document_paragraph(document, "It was interrupted: %d functions were finished.", out->nfunctions);
    document_figures(document, "transfer");
    document_table(document, table_of_transfer_modes(pool, out));
}

/* ---- modal analysis */

static int doubtful_modes(const struct ema_result *ema)
{
    int count = 0;
    for (int k = 0; k < ema->nmodes; k++)
        count += ema->modes[k].doubts != 0;
    return count;
}

static int doubtful_channels(const struct ema_result *ema)
{
    int count = 0;
    for (int c = 0; c < ema->nchannels; c++)
        count += ema->channels[c].doubts != 0;
    return count;
}

void answer_ema(struct document *document, const struct result *result)
{
    const struct ema_result *ema = result->ema;
    struct pool *pool = document->pool;
    int modes = doubtful_modes(ema), channels = doubtful_channels(ema), doubtful = modes || channels;
    if (!ema->nmodes) {
        document->now.tone = TONE_BAD;
        document->now.headline = "No mode was found";
        document->now.text = "No pole of the transfer functions is stable enough to be a mode.";
        return;
    }
    document->now.tone = doubtful ? TONE_CARE : TONE_GOOD;
    document->now.text =
        pool_format(pool, "%d %s from %s in %d transfer %s. %s", ema->nmodes, human_plural(ema->nmodes, "mode", "modes"),
                    human_range(pool, ema->modes[0].frequency_hz, ema->modes[ema->nmodes - 1].frequency_hz, "Hz"),
                    ema->source.transfer_functions, human_plural(ema->source.transfer_functions, "function", "functions"),
                    doubtful ? or_nothing(pool_format(pool, "%d of the modes and %d of the channels %s doubtful, see below.",
                                                      modes, channels, modes + channels == 1 ? "is" : "are"))
                             : "No mode and no channel is doubtful.");
    for (int k = 0; k < ema->nmodes && k < TILES_MOST; k++)
        document_tile(document, pool_format(pool, "mode %d [Hz]", ema->modes[k].mode),
                      human_digits(pool, ema->modes[k].frequency_hz, 6),
                      pool_format(pool, "damping %s\xc2\xa0%%%s", human_digits(pool, 100 * ema->modes[k].damping, 3),
                                  ema->modes[k].doubts ? "; doubtful" : ""));
    document->now.next =
        doubtful ? "Next: look at the doubtful ones in the diagram and in the functions, before a model is fitted to them."
                 : "Next: name the file of the modes in *MEASURED of a deck, and identify the model.";
}

static void list_doubts(struct document *document, const struct ema_result *ema)
{
    int count;
    const char **text = ema_doubts(document->pool, ema, &count);
    if (!text) {
        document->failed = 1;
        return;
    }
    document_section(document, "doubts", "Doubtful modes and channels");
    document_list(document, count, text);
}

void section_ema(struct document *document, const struct result *result)
{
    const struct ema_result *ema = result->ema;
    document_section(document, "modes-of-test", "Modes of the test");
    document_figures(document, "ema-shapes");
    document_table(document, table_of_test_modes(document->pool, ema));
    list_doubts(document, ema);
    document_section(document, "poles", "Where the modes come from");
    document_figures(document, "ema-poles");
    if (!ema->ncurves)
        return;
    document_section(document, "functions", "Measured and synthesised functions");
    document_paragraph(document, "Synthesised: the modes of the result, with one term for the modes below and one for those "
                                 "above the band. FRAC is 1 where both are the same but for a factor.");
    document_figures(document, "ema-functions");
}

/* ---- what to measure next */

void section_suggest(struct document *document, const struct result *result)
{
    const rotid_suggestion *s = result->suggest;
    struct pool *pool = document->pool;
    if (s->ntests) {
        document_section(document, "tests", "Tests that could be made next");
        if (s->verdict)
            document_paragraph(document, "The diagnosis: %s", s->verdict);
        document_figures(document, "tests");
        document_table(document, table_of_tests(pool, s));
        document_table(document, table_of_rivals(pool, s));
    }
    if (isfinite(s->speed_rpm)) {
        document_section(document, "tests", "Tests at rest for a critical speed");
        document_table(document, table_of_speed_tests(pool, s));
        return;
    }
    document_section(document, "sensors", "Sensors and modes");
    document_figures(document, "sensors");
    document_table(document, table_of_plans(pool, s));
    document_table(document, table_of_expected(pool, s));
}
