/* What a page says of a fit, of modes, sensitivities, transfer functions, a modal analysis and a suggestion. */
#include <math.h>
#include <string.h>

#include "fit/fit.h"
#include "page/page.h"
#include "report/report.h"

#define COUNT_OF(list)            ((int)(sizeof(list) / sizeof *(list)))
#define OPEN(pool, caption, list) open_table(pool, caption, COUNT_OF(list), list)

static struct table *open_table(struct pool *pool, const char *caption, int count, const struct table_column column[])
{
    struct table *table = table_open(pool, caption);
    table_add_columns(table, count, column);
    return table;
}

/* "core.E", in the unit that suits its values; what its values are multiplied by for that. */
static double add_parameter_column(struct table *table, struct pool *pool, const char *name, double value, const char *in,
                                   int digits)
{
    struct human_unit unit = human_unit(value, in);
    table_add_column(table, name, *unit.text ? pool_copy_text(pool, unit.text) : NULL, TABLE_DIGITS, digits);
    return unit.factor;
}

struct table *table_of_fitted_modes(struct pool *pool, const struct result *result, const rotid_identification *fit,
                                    const char *caption)
{
    static const struct table_column columns[] = {
        {"mode", NULL, TABLE_FIXED, 0},         {"state", NULL, TABLE_TEXT, 0},
        {"measured", "Hz", TABLE_FIXED, 3},     {"predicted", "Hz", TABLE_FIXED, 3},
        {"error", "%", TABLE_SIGNED, 3},        {"noise", "%", TABLE_FIXED, 3},
        {"MAC", NULL, TABLE_FIXED, 3},          {"NCO", NULL, TABLE_FIXED, 3},
        {"condensation", "%", TABLE_SIGNED, 3}, {"mesh", "%", TABLE_SIGNED, 4},
        {"in the fit", NULL, TABLE_TEXT, 0},    {"paired by", NULL, TABLE_TEXT, 0},
        {"reference", "Hz", TABLE_FIXED, 2},    {"reference error", "%", TABLE_SIGNED, 2}};
    const rotid_reference *hz = head_reference(&result->head, "predicted_hz"),
                          *error = head_reference(&result->head, "error_percent");
    struct table *table = OPEN(pool, caption, columns);
    for (int k = 0; k < fit->nmodes; k++) {
        const rotid_compared_mode *mode = &fit->modes[k];
        cell_number(table, mode->mode);
        cell_text(table, fit_state_of_mode(fit, k));
        cell_number(table, mode->measured_hz);
        cell_number(table, mode->predicted_hz);
        cell_number(table, mode->error_percent);
        cell_number(table, 100 * mode->frequency_std);
        cell_number(table, mode->mac);
        cell_number(table, mode->nco);
        cell_number(table, fit->reduction_error_percent[k]);
        cell_number(table, fit->mesh_error_percent[k]);
        cell_text(table, mode->holdout ? "held out" : "yes");
        cell_text(table, mode->paired_by);
        cell_number(table, reference_value(hz, k));
        cell_number(table, reference_value(error, k));
    }
    return table;
}

static struct table *parameters_of(struct pool *pool, const rotid_identification *fit)
{
    static const struct table_column columns[] = {
        {"parameter", NULL, TABLE_TEXT, 0},      {"unit", NULL, TABLE_TEXT, 0},
        {"value", NULL, TABLE_DIGITS, 4},        {"95 % from", NULL, TABLE_DIGITS, 4},
        {"to", NULL, TABLE_DIGITS, 4},           {"standard deviation", NULL, TABLE_DIGITS, 2},
        {"start", NULL, TABLE_TRIMMED, 5},       {"lower bound", NULL, TABLE_TRIMMED, 5},
        {"upper bound", NULL, TABLE_TRIMMED, 5}, {"remark", NULL, TABLE_TEXT, 0}};
    struct table *table = OPEN(pool, "Parameters", columns);
    for (int p = 0; p < fit->nparameters; p++) {
        const rotid_fitted_parameter *is = &fit->parameters[p];
        double f = human_unit(is->value, is->unit).factor;
        cell_text(table, is->name);
        cell_interval(table, is->value, is->ci95, is->unit);
        cell_number(table, is->std * f);
        cell_number(table, is->start * f);
        cell_number(table, is->lower * f);
        cell_number(table, is->upper * f);
        cell_text(table, is->at_bound        ? "at its bound"
                         : !is->identifiable ? "not determined by these data"
                         : interval_is_wide(is->value, is->ci95[0], is->ci95[1])
                             ? pool_format(pool, "determined to %s\xc2\xa0%% only",
                                           human_digits(pool, human_half_width_percent(is->value, is->ci95), 2))
                             : "determined");
    }
    return table;
}

static struct table *table_of_states(struct pool *pool, const rotid_identification *fit)
{
    static const struct table_column columns[] = {{"state", NULL, TABLE_TEXT, 0},      {"modes", NULL, TABLE_FIXED, 0},
                                                  {"residuals", NULL, TABLE_FIXED, 0}, {"rms error, fitted", "%", TABLE_FIXED, 3},
                                                  {"held out", "%", TABLE_FIXED, 3},   {"chi-squared", NULL, TABLE_DIGITS, 3},
                                                  {"length", "m", TABLE_TRIMMED, 5},   {"mass", "kg", TABLE_TRIMMED, 5}};
    struct table *table = OPEN(pool, "States: one set of parameters for all, each with its own model and modes", columns);
    for (int s = 0; s < fit->nstates; s++) {
        const rotid_identification own = fit_of_state(fit, s);
        cell_text(table, fit->states[s].name);
        cell_number(table, own.nmodes);
        cell_number(table, fit->states[s].fitted_residuals);
        cell_number(table, fit_rms_percent(&own, 0));
        cell_number(table, fit_rms_percent(&own, 1));
        cell_number(table, own.chi2);
        cell_number(table, own.geometry ? own.geometry->length_m : (double)NAN);
        cell_number(table, own.mass_kg);
    }
    return table;
}

static struct table *minimisers_of(struct pool *pool, const rotid_identification *fit)
{
    static const struct table_column columns[] = {{"minimiser", NULL, TABLE_TEXT, 0},
                                                  {"functional", NULL, TABLE_DIGITS, 9},
                                                  {"gradient", NULL, TABLE_DIGITS, 2},
                                                  {"evaluations", NULL, TABLE_FIXED, 0},
                                                  {"time", "ms", TABLE_FIXED, 1}};
    struct table *table = OPEN(pool, "Minimisers from the same start", columns);
    double *factor = POOL_ARRAY(pool, double, fit->nparameters);
    for (int p = 0; p < fit->nparameters && factor; p++)
        factor[p] =
            add_parameter_column(table, pool, fit->parameters[p].name, fit->parameters[p].value, fit->parameters[p].unit, 7);
    table_add_column(table, "result", NULL, TABLE_TEXT, 0);
    for (int b = 0; b <= fit->nbaseline && factor; b++) {
        const rotid_minimiser *other = b ? &fit->baseline[b - 1] : NULL;
        cell_text(table, other ? pool_format(pool, "NLopt %s", other->algorithm) : "Levenberg-Marquardt");
        cell_number(table, other ? other->objective : fit->objective);
        cell_number(table, other ? other->gradient : fit->gradient);
        cell_number(table, other ? other->evaluations : fit->evaluations);
        cell_number(table, 1e3 * (other ? other->seconds : fit->seconds));
        for (int p = 0; p < fit->nparameters; p++)
            cell_number(table, factor[p] * (other ? other->x[p] : fit->parameters[p].value));
        cell_text(table, other ? other->result : fit->stop_reason);
    }
    return table;
}

void section_agreement(struct document *document, const struct result *result)
{
    document_section(document, "agreement", "Model and measurement");
    document_figures(document, "shapes");
    document_figures(document, "agreement");
    document_figures(document, "matrices");
    document_table(document, table_of_fitted_modes(document->pool, result, result->identify,
                                                   "Modes: errors are predicted over measured frequency, less one"));
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
    document_table(document, parameters_of(document->pool, fit));
    document_section(document, "fit", "How the fit got there");
    document_figures(document, "fit");
    document_table(document, minimisers_of(document->pool, fit));
}

static struct table *modes_of(struct pool *pool, const rotid_spectrum *modes)
{
    static const struct table_column columns[] = {
        {"mode", NULL, TABLE_FIXED, 0},         {"full model", "Hz", TABLE_FIXED, 3}, {"condensed", "Hz", TABLE_FIXED, 3},
        {"condensation", "%", TABLE_SIGNED, 3}, {"mesh", "%", TABLE_SIGNED, 4},       {"measured", "Hz", TABLE_FIXED, 3},
        {"error", "%", TABLE_SIGNED, 3},        {"MAC", NULL, TABLE_FIXED, 3},        {"NCO", NULL, TABLE_FIXED, 3}};
    struct table *table = OPEN(pool, "Modes of the full and of the condensed model", columns);
    for (int k = 0; k < modes->nmodes; k++) {
        const rotid_model_mode *mode = &modes->modes[k];
        const rotid_compared_mode *measured = mode->measured;
        cell_number(table, mode->mode);
        cell_number(table, mode->full_hz);
        cell_number(table, mode->reduced_hz);
        cell_number(table, mode->reduction_error_percent);
        cell_number(table, mode->mesh_error_percent);
        cell_number(table, measured ? measured->measured_hz : (double)NAN);
        cell_number(table, measured ? measured->error_percent : (double)NAN);
        cell_number(table, measured ? measured->mac : (double)NAN);
        cell_number(table, measured ? measured->nco : (double)NAN);
    }
    return table;
}

static void section_beside(struct document *document, const rotid_beam_beside_solid *beside)
{
    static const struct table_column columns[] = {
        {"mode", NULL, TABLE_FIXED, 0}, {"solid", "Hz", TABLE_FIXED, 3},         {"mode of the beam", NULL, TABLE_FIXED, 0},
        {"beam", "Hz", TABLE_FIXED, 3}, {"difference", "%", TABLE_SIGNED, 2},    {"NCO", NULL, TABLE_FIXED, 4},
        {"MAC", NULL, TABLE_FIXED, 4},  {"mesh of solid", "%", TABLE_SIGNED, 4}, {"mesh of beam", "%", TABLE_SIGNED, 4}};
    static const struct table_column moduli[] = {{"modulus", NULL, TABLE_TEXT, 0},
                                                 {"solid", "GPa", TABLE_DIGITS, 4},
                                                 {"fitted beam", "GPa", TABLE_DIGITS, 4},
                                                 {"change", "%", TABLE_SIGNED, 1}};
    struct pool *pool = document->pool;
    struct table *table = OPEN(pool, "Modes of the rotor as a beam and as a solid: the difference is beam over solid, less one",
                               columns),
                 *fitted = OPEN(pool, "Moduli of the beam whose frequencies are nearest to those of the solid", moduli);
    for (int k = 0; k < beside->nmodes; k++) {
        const rotid_beside_mode *mode = &beside->modes[k];
        const double cell[] = {mode->mode,
                               mode->solid_hz,
                               mode->beam_mode,
                               mode->beam_hz,
                               mode->difference_percent,
                               mode->nco,
                               mode->mac,
                               mode->solid_mesh_error_percent,
                               mode->beam_mesh_error_percent};
        for (int j = 0; j < COUNT_OF(cell); j++)
            cell_number(table, cell[j]);
    }
    for (int p = 0; p < beside->nmoduli; p++) {
        cell_text(fitted, beside->moduli[p].name);
        cell_number(fitted, 1e-9 * beside->moduli[p].stated_pa);
        cell_number(fitted, 1e-9 * beside->moduli[p].found_pa);
        cell_number(fitted, beside->moduli[p].change_percent);
    }
    document_section(document, "beside", "The beam beside the solid");
    if (beside->sentence)
        document_paragraph(document, "In short, %s.", beside->sentence);
    document_table(document, table);
    if (beside->nmoduli)
        document_table(document, fitted);
}

void section_modes(struct document *document, const struct result *result)
{
    document_section(document, "model-modes", "Modes of the model");
    document_figures(document, "modes");
    document_table(document, modes_of(document->pool, result->modes));
    if (result->modes->beside)
        section_beside(document, result->modes->beside);
}

void section_sensitivity(struct document *document, const struct result *result)
{
    struct pool *pool = document->pool;
    const struct sensitivity *s = result->sensitivity;
    struct table *table = table_open(pool, "Change of a frequency for a change of a parameter, per cent for a per cent");
    const char *at = "";
    table_add_column(table, "mode", NULL, TABLE_FIXED, 0);
    table_add_column(table, "frequency", "Hz", TABLE_FIXED, 3);
    for (int p = 0; p < s->nparameters && at; p++) {
        at = pool_format(pool, "%s%s%s = %s", at, p ? ", " : "", s->parameters[p].name,
                         human_value(pool, s->parameters[p].reference, s->parameters[p].unit));
        table_add_column(table, s->parameters[p].name, NULL, TABLE_SIGNED, 4);
    }
    for (int k = 0; k < s->nfrequency_hz; k++) {
        cell_number(table, k + 1);
        cell_number(table, s->frequency_hz[k]);
        for (int p = 0; p < s->nparameters; p++)
            cell_number(table,
                        s->parameters[p].frequency_change ? s->parameters[p].frequency_change[k] : (double)NAN); /* older */
    }
    document_section(document, "dependence", "Sensitivity");
    document_paragraph(document, "At %s, reduction %s.", or_nothing(at), s->reduction);
    document_figures(document, "sensitivity");
    document_table(document, table);
}

static struct table *transfer_modes_of(struct pool *pool, const struct transfer_result *out)
{
    static const struct table_column columns[] = {{"mode", NULL, TABLE_TEXT, 0},         {"model", "Hz", TABLE_FIXED, 3},
                                                  {"measured", "Hz", TABLE_FIXED, 3},    {"damping ratio", "%", TABLE_DIGITS, 4},
                                                  {"damping from", NULL, TABLE_TEXT, 0}, {"FRAC", NULL, TABLE_FIXED, 3},
                                                  {"level", "dB", TABLE_SIGNED, 2},      {"phase", "\xc2\xb0", TABLE_SIGNED, 1}};
    struct table *table = OPEN(pool, "Modes within the lines", columns);
    for (int m = 0; m < out->nmodes; m++) {
        const struct transfer_mode *mode = &out->modes[m];
        char *from = pool_copy_text(pool, mode->damping_from);
        if (!(mode->model_hz <= out->high_hz))
            continue;
        for (char *c = from; c && *c; c++)
            *c = *c == '_' ? ' ' : *c;
        cell_text(table, mode->rigid ? "rigid" : human_fixed(pool, mode->mode, 0));
        cell_number(table, mode->model_hz);
        cell_number(table, mode->measured_hz);
        cell_number(table, 100 * mode->damping);
        cell_text(table, from);
        cell_number(table, mode->agreement ? mode->agreement->frac : (double)NAN);
        cell_number(table, mode->agreement ? mode->agreement->level_db : (double)NAN);
        cell_number(table, mode->agreement ? mode->agreement->phase_deg : (double)NAN);
    }
    return table;
}

void section_transfer(struct document *document, const struct result *result)
{
    const struct transfer_result *out = result->frf;
    struct pool *pool = document->pool;
    const char *at = "";
    document_section(document, "transfer", "Transfer functions");
    document_paragraph(document, "%d synthesised %s from modes up to %s\xc2\xa0Hz with the damping below; %s%s.", out->nfunctions,
                       human_plural(out->nfunctions, "function", "functions"), human_trimmed(pool, out->modes_up_to_hz, 4),
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
    document_table(document, transfer_modes_of(pool, out));
}

/* ---- modal analysis */

/* The words of the bits that are set. */
static const char *doubts_in_words(struct pool *pool, int doubts, const char *const words[])
{
    const char *text = "";
    for (int b = 0; words[b] && text; b++)
        if (doubts >> b & 1)
            text = pool_format(pool, "%s%s%s", text, *text ? "; " : "", words[b]);
    return or_nothing(text);
}

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
    document->now.text = pool_format(
        pool, "%d %s from %s to %s\xc2\xa0Hz in %d transfer %s. %s", ema->nmodes, human_plural(ema->nmodes, "mode", "modes"),
        human_trimmed(pool, ema->modes[0].frequency_hz, 5), human_trimmed(pool, ema->modes[ema->nmodes - 1].frequency_hz, 5),
        ema->source.transfer_functions, human_plural(ema->source.transfer_functions, "function", "functions"),
        doubtful ? or_nothing(pool_format(pool, "%d of the modes and %d of the channels %s doubtful, see below.", modes, channels,
                                          modes + channels == 1 ? "is" : "are"))
                 : "Nothing about the modes and the channels looks doubtful.");
    for (int k = 0; k < ema->nmodes && k < TILES_MOST; k++)
        document_tile(document, pool_format(pool, "mode %d [Hz]", ema->modes[k].mode),
                      human_digits(pool, ema->modes[k].frequency_hz, 6),
                      pool_format(pool, "damping %s\xc2\xa0%%%s", human_digits(pool, 100 * ema->modes[k].damping, 3),
                                  ema->modes[k].doubts ? "; doubtful" : ""));
    document->now.next =
        doubtful ? "Next: look at the doubtful ones in the diagram and in the functions, before a model is fitted to them."
                 : "Next: name the file of the modes in *MEASURED of a deck, and identify the model.";
}

static struct table *ema_modes_of(struct pool *pool, const struct ema_result *ema)
{
    static const struct table_column columns[] = {
        {"mode", NULL, TABLE_FIXED, 0},      {"frequency", "Hz", TABLE_FIXED, 3},   {"std", "Hz", TABLE_DIGITS, 2},
        {"damping", "%", TABLE_DIGITS, 4},   {"std", "%", TABLE_DIGITS, 2},         {"MPC", NULL, TABLE_FIXED, 3},
        {"MPD", "\xc2\xb0", TABLE_FIXED, 1}, {"modal mass", "kg", TABLE_DIGITS, 4}, {"peak over noise", NULL, TABLE_DIGITS, 3},
        {"doubtful", NULL, TABLE_TEXT, 0}};
    struct table *table = OPEN(pool, "Modes, with standard deviations", columns);
    for (int k = 0; k < ema->nmodes; k++) {
        const struct ema_mode_result *m = &ema->modes[k];
        cell_number(table, m->mode);
        cell_decimals(table, m->frequency_hz, human_decimals(m->frequency_hz, m->frequency_std_hz));
        cell_number(table, m->frequency_std_hz);
        cell_number(table, 100 * m->damping);
        cell_number(table, 100 * m->damping_std);
        cell_number(table, m->mpc);
        cell_number(table, m->mpd_degrees);
        cell_number(table, m->modal_mass_kg);
        cell_number(table, m->peak_signal_to_noise);
        cell_text(table, m->doubts ? "yes" : "no");
    }
    return table;
}

static void list_doubts(struct document *document, const struct ema_result *ema)
{
    struct pool *pool = document->pool;
    int n = 0;
    const char **text = POOL_ARRAY(pool, const char *, doubtful_modes(ema) + doubtful_channels(ema) + 1);
    if (!text) {
        document->failed = 1;
        return;
    }
    for (int k = 0; k < ema->nmodes; k++)
        if (ema->modes[k].doubts)
            text[n++] = pool_format(pool, "Mode %d at %s\xc2\xa0Hz: %s.", ema->modes[k].mode,
                                    human_trimmed(pool, ema->modes[k].frequency_hz, 5),
                                    doubts_in_words(pool, ema->modes[k].doubts, ema_mode_doubts));
    for (int c = 0; c < ema->nchannels; c++)
        if (ema->channels[c].doubts)
            text[n++] =
                pool_format(pool, "Node %d over node %d: %s.", ema->channels[c].response_node, ema->channels[c].reference_node,
                            doubts_in_words(pool, ema->channels[c].doubts, ema_channel_doubts));
    if (!n)
        text[n++] = "Nothing about the modes and the channels looks doubtful.";
    document_section(document, "doubts", "Doubtful modes and channels");
    document_list(document, n, text);
}

void section_ema(struct document *document, const struct result *result)
{
    const struct ema_result *ema = result->ema;
    document_section(document, "modes-of-test", "Modes of the test");
    document_figures(document, "ema-shapes");
    document_table(document, ema_modes_of(document->pool, ema));
    list_doubts(document, ema);
    document_section(document, "poles", "Where the modes come from");
    document_figures(document, "ema-poles");
    if (!ema->ncurves)
        return;
    document_section(document, "functions", "Measured and synthesised functions");
    document_paragraph(document, "Synthesised is what the modes make of a function, with a term for what lies below and one for "
                                 "what lies above the band. FRAC is 1 where both are the same but for a factor.");
    document_figures(document, "ema-functions");
}

/* ---- what to measure next */

void section_suggest(struct document *document, const struct result *result)
{
    static const struct table_column tests[] = {{"test", NULL, TABLE_TEXT, 0},        {"chance", NULL, TABLE_FIXED, 2},
                                                {"wrong name", NULL, TABLE_FIXED, 2}, {"cost", "points", TABLE_TRIMMED, 4},
                                                {"set-ups", NULL, TABLE_FIXED, 0},    {"points", NULL, TABLE_FIXED, 0},
                                                {"modes", NULL, TABLE_FIXED, 0}};
    static const struct table_column rivals[] = {{"rival", NULL, TABLE_TEXT, 0},
                                                 {"chi-squared", NULL, TABLE_FIXED, 2},
                                                 {"score", NULL, TABLE_FIXED, 2},
                                                 {"share", NULL, TABLE_FIXED, 2}};
    static const struct table_column plan[] = {
        {"plan", NULL, TABLE_TEXT, 0}, {"sensors", NULL, TABLE_FIXED, 0}, {"gain", "%", TABLE_FIXED, 1}};
    const rotid_suggestion *s = result->suggest;
    struct pool *pool = document->pool;
    struct table *table;
    if (s->ntests) {
        document_section(document, "tests", "Tests that could be made next");
        if (s->verdict)
            document_paragraph(document, "The diagnosis: %s", s->verdict);
        document_figures(document, "tests");
        table = OPEN(pool, "Tests: the chance that the true one of the rivals is named, what it takes", tests);
        for (int i = 0; i < s->ntests; i++) {
            const rotid_suggested_test *t = &s->tests[i];
            const double cell[] = {t->chance, t->wrong, t->cost, t->setups, t->points, t->modes};
            cell_text(table, t->text);
            for (int j = 0; j < COUNT_OF(cell); j++)
                cell_number(table, cell[j]);
        }
        document_table(document, table);
        table = OPEN(pool, "Rivals: what the diagnosis cannot tell apart", rivals);
        for (int i = 0; i < s->nrivals; i++) {
            cell_text(table, s->rivals[i].label);
            cell_number(table, s->rivals[i].chi2);
            cell_number(table, s->rivals[i].score);
            cell_number(table, s->rivals[i].share);
        }
        document_table(document, table);
    }
    document_section(document, "sensors", "Sensors and modes");
    document_figures(document, "sensors");
    table = OPEN(pool, "Plans of sensors", plan);
    for (int p = 0; p < s->nparameters; p++)
        table_add_column(table, pool_format(pool, "%s, half-width", s->parameters[p].name), "%", TABLE_DIGITS, 3);
    for (int i = 0; i < s->nplans; i++) {
        const rotid_sensor_plan *p = &s->plans[i];
        cell_text(table, strcmp(p->method, "effective_independence") ? p->method : "effective independence");
        cell_number(table, p->nz_m);
        cell_number(table, p->gain_percent);
        for (int j = 0; j < s->nparameters; j++)
            cell_number(table, j < p->nhalf_width_percent ? p->half_width_percent[j] : (double)NAN);
    }
    document_table(document, table);
    if (!s->nparameters)
        return;
    table = table_open(pool, "Half-widths of the 95\xc2\xa0% intervals that are expected, by the number of modes");
    table_add_column(table, "modes", NULL, TABLE_FIXED, 0);
    for (int p = 0; p < s->nparameters; p++) {
        table_add_column(table, pool_format(pool, "%s by frequencies", s->parameters[p].name), "%", TABLE_DIGITS, 3);
        table_add_column(table, pool_format(pool, "%s with shapes", s->parameters[p].name), "%", TABLE_DIGITS, 3);
    }
    for (int i = 0; i < s->nmodes; i++) {
        const rotid_expected_modes *m = &s->modes[i];
        cell_number(table, m->modes);
        for (int p = 0; p < s->nparameters; p++) {
            cell_number(table, p < m->nfrequencies_percent ? m->frequencies_percent[p] : (double)NAN);
            cell_number(table, p < m->nshapes_percent ? m->shapes_percent[p] : (double)NAN);
        }
    }
    document_table(document, table);
}
