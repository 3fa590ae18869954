#include "page/tables.h"

#include <math.h>

#include "fit/interval.h"
#include "page/human.h"
#include "result/judgement.h"

struct number_table *tables_parameters(struct pool *pool, const rotid_identification *fit)
{
    static const char *const head[] = {"parameter",          "unit",  "value",       "95 % from",   "to",
                                       "standard deviation", "start", "lower bound", "upper bound", "remark"};
    struct number_table *table = table_headed(pool, fit->nparameters, 10, head);
    for (int p = 0; p < fit->nparameters; p++) {
        const rotid_fitted_parameter *parameter = &fit->parameters[p];
        struct human_unit unit = human_unit(parameter->value, parameter->unit);
        double f = unit.factor, half = (parameter->ci95[1] - parameter->ci95[0]) / 2 * f;
        int decimals = human_decimals(parameter->value * f, half);
        table_cell(table, p, 0, parameter->name);
        table_cell(table, p, 1, *unit.text ? pool_copy_text(pool, unit.text) : "1");
        table_cell(table, p, 2, human_fixed(pool, parameter->value * f, decimals));
        table_cell(table, p, 3, human_fixed(pool, parameter->ci95[0] * f, decimals));
        table_cell(table, p, 4, human_fixed(pool, parameter->ci95[1] * f, decimals));
        table_cell(table, p, 5, human_fixed(pool, parameter->std * f, decimals));
        table_cell(table, p, 6, human_trimmed(pool, parameter->start * f, 5));
        table_cell(table, p, 7, human_trimmed(pool, parameter->lower * f, 5));
        table_cell(table, p, 8, human_trimmed(pool, parameter->upper * f, 5));
        table_cell(table, p, 9,
                   parameter->at_bound        ? "at its bound"
                   : !parameter->identifiable ? "not determined by these data"
                   : interval_is_wide(parameter->value, parameter->ci95[0], parameter->ci95[1])
                       ? pool_format(pool, "determined to %s\xc2\xa0%% only",
                                     human_digits(pool, human_half_width_percent(parameter->value, parameter->ci95), 2))
                       : "determined");
    }
    return table;
}

struct number_table *tables_fitted_modes(struct pool *pool, const struct result *result, const rotid_identification *fit)
{
    static const char *const head[] = {"mode",      "measured [Hz]",  "predicted [Hz]",     "error [%]", "noise [%]",
                                       "MAC [1]",   "NCO [1]",        "condensation [%]",   "mesh [%]",  "in the fit",
                                       "paired by", "reference [Hz]", "reference error [%]"};
    const rotid_reference *hz = head_reference(&result->head, "predicted_hz"),
                          *error = head_reference(&result->head, "error_percent");
    int columns = hz || error ? 13 : 11;
    struct number_table *table = table_headed(pool, fit->nmodes, columns, head);
    for (int k = 0; k < fit->nmodes; k++) {
        const rotid_compared_mode *mode = &fit->modes[k];
        const char *state = fit_state_of_mode(fit, k);
        table_cell(table, k, 0, state ? pool_format(pool, "%d, %s", mode->mode, state) : human_fixed(pool, mode->mode, 0));
        table_cell(table, k, 1, human_fixed(pool, mode->measured_hz, 3));
        table_cell(table, k, 2, human_fixed(pool, mode->predicted_hz, 3));
        table_cell(table, k, 3, human_signed(pool, mode->error_percent, 3));
        table_cell(table, k, 4, human_fixed(pool, 100 * mode->frequency_std, 3));
        table_cell(table, k, 5, human_fixed(pool, mode->mac, 3));
        table_cell(table, k, 6, human_fixed(pool, mode->nco, 3));
        table_cell(table, k, 7, human_signed(pool, fit->reduction_error_percent[k], 3));
        table_cell(table, k, 8, human_signed(pool, fit->mesh_error_percent[k], 4));
        table_cell(table, k, 9, mode->holdout ? "held out" : "yes");
        table_cell(table, k, 10, mode->paired_by);
        if (columns == 11)
            continue;
        table_cell(table, k, 11, human_fixed(pool, reference_value(hz, k), 2));
        table_cell(table, k, 12, human_signed(pool, reference_value(error, k), 2));
    }
    return table;
}

struct number_table *tables_states(struct pool *pool, const rotid_identification *fit)
{
    static const char *const head[] = {"state",        "modes",           "residuals in the fit", "rms error, fitted [%]",
                                       "held out [%]", "chi-squared [1]", "length [m]",           "mass [kg]"};
    struct number_table *table = table_headed(pool, fit->nstates, 8, head);
    for (int s = 0; s < fit->nstates; s++) {
        const rotid_identification own = fit_of_state(fit, s);
        table_cell(table, s, 0, fit->states[s].name);
        table_cell(table, s, 1, human_fixed(pool, own.nmodes, 0));
        table_cell(table, s, 2, human_fixed(pool, fit->states[s].fitted_residuals, 0));
        table_cell(table, s, 3, human_fixed(pool, fit_rms_percent(&own, 0), 3));
        table_cell(table, s, 4, human_fixed(pool, fit_rms_percent(&own, 1), 3));
        table_cell(table, s, 5, human_digits(pool, own.chi2, 3));
        table_cell(table, s, 6, human_trimmed(pool, own.geometry ? own.geometry->length_m : (double)NAN, 5));
        table_cell(table, s, 7, human_trimmed(pool, own.mass_kg, 5));
    }
    return table;
}

struct number_table *tables_minimisers(struct pool *pool, const rotid_identification *fit)
{
    struct number_table *table = table_new(pool, fit->nbaseline + 1, 6 + fit->nparameters);
    static const char *const head[] = {"minimiser", "functional [1]", "gradient [1]", "evaluations", "time [ms]"};
    for (int j = 0; j < 5; j++)
        table_head(table, j, head[j]);
    table_head(table, 5 + fit->nparameters, "result");
    for (int b = 0; b <= fit->nbaseline; b++) {
        const rotid_minimiser *other = b ? &fit->baseline[b - 1] : NULL;
        table_cell(table, b, 0, other ? pool_format(pool, "NLopt %s", other->algorithm) : "Levenberg-Marquardt");
        table_cell(table, b, 1, human_digits(pool, other ? other->objective : fit->objective, 9));
        table_cell(table, b, 2, human_digits(pool, other ? other->gradient : fit->gradient, 2));
        table_cell(table, b, 3, human_fixed(pool, other ? other->evaluations : fit->evaluations, 0));
        table_cell(table, b, 4, human_fixed(pool, 1e3 * (other ? other->seconds : fit->seconds), 1));
        table_cell(table, b, 5 + fit->nparameters, other ? other->result : fit->stop_reason);
    }
    for (int p = 0; p < fit->nparameters; p++) {
        const rotid_fitted_parameter *parameter = &fit->parameters[p];
        struct human_unit unit = human_unit(parameter->value, parameter->unit);
        table_head(table, 5 + p, pool_format(pool, "%s [%s]", parameter->name, *unit.text ? unit.text : "1"));
        for (int b = 0; b <= fit->nbaseline; b++)
            table_cell(table, b, 5 + p, human_digits(pool, unit.factor * (b ? fit->baseline[b - 1].x[p] : parameter->value), 7));
    }
    return table;
}

struct number_table *tables_modes(struct pool *pool, const rotid_spectrum *modes)
{
    static const char *const head[] = {"mode",          "full model [Hz]", "condensed [Hz]", "condensation [%]", "mesh [%]",
                                       "measured [Hz]", "error [%]",       "MAC [1]",        "NCO [1]"};
    struct number_table *table = table_headed(pool, modes->nmodes, 9, head);
    for (int k = 0; k < modes->nmodes; k++) {
        const rotid_model_mode *mode = &modes->modes[k];
        table_cell(table, k, 0, human_fixed(pool, mode->mode, 0));
        table_cell(table, k, 1, human_fixed(pool, mode->full_hz, 3));
        table_cell(table, k, 2, human_fixed(pool, mode->reduced_hz, 3));
        table_cell(table, k, 3, human_signed(pool, mode->reduction_error_percent, 3));
        table_cell(table, k, 4, human_signed(pool, mode->mesh_error_percent, 4));
        const rotid_compared_mode *measured = mode->measured;
        table_cell(table, k, 5, human_fixed(pool, measured ? measured->measured_hz : (double)NAN, 3));
        table_cell(table, k, 6, human_signed(pool, measured ? measured->error_percent : (double)NAN, 3));
        table_cell(table, k, 7, human_fixed(pool, measured ? measured->mac : (double)NAN, 3));
        table_cell(table, k, 8, human_fixed(pool, measured ? measured->nco : (double)NAN, 3));
    }
    return table;
}

struct number_table *tables_beside(struct pool *pool, const rotid_beam_beside_solid *beside)
{
    static const char *const head[] = {"mode",    "solid [Hz]", "mode of the beam",  "beam [Hz]",       "difference [%]",
                                       "NCO [1]", "MAC [1]",    "mesh of solid [%]", "mesh of beam [%]"};
    struct number_table *table = table_headed(pool, beside->nmodes, 9, head);
    for (int k = 0; k < beside->nmodes; k++) {
        const rotid_beside_mode *mode = &beside->modes[k];
        table_cell(table, k, 0, human_fixed(pool, mode->mode, 0));
        table_cell(table, k, 1, human_fixed(pool, mode->solid_hz, 3));
        table_cell(table, k, 2, human_fixed(pool, mode->beam_mode, 0));
        table_cell(table, k, 3, human_fixed(pool, mode->beam_hz, 3));
        table_cell(table, k, 4, human_signed(pool, mode->difference_percent, 2));
        table_cell(table, k, 5, human_fixed(pool, mode->nco, 4));
        table_cell(table, k, 6, human_fixed(pool, mode->mac, 4));
        table_cell(table, k, 7, human_signed(pool, mode->solid_mesh_error_percent, 4));
        table_cell(table, k, 8, human_signed(pool, mode->beam_mesh_error_percent, 4));
    }
    return table;
}

struct number_table *tables_beside_moduli(struct pool *pool, const rotid_beam_beside_solid *beside)
{
    static const char *const head[] = {"modulus", "solid", "fitted beam", "change [%]"};
    struct number_table *table = table_headed(pool, beside->nmoduli, 4, head);
    for (int p = 0; p < beside->nmoduli; p++) {
        const rotid_beside_modulus *modulus = &beside->moduli[p];
        table_cell(table, p, 0, modulus->name);
        table_cell(table, p, 1, human_value(pool, modulus->stated_pa, "Pa"));
        table_cell(table, p, 2, human_value(pool, modulus->found_pa, "Pa"));
        table_cell(table, p, 3, human_signed(pool, modulus->change_percent, 1));
    }
    return table;
}

struct number_table *tables_transfer_modes(struct pool *pool, const struct transfer_result *out)
{
    static const char *const head[] = {"mode",         "model [Hz]", "measured [Hz]", "damping ratio [%]",
                                       "damping from", "FRAC [1]",   "level [dB]",    "phase [\xc2\xb0]"};
    static const struct transfer_mode_agreement none = {.frac = NAN, .level_db = NAN, .phase_deg = NAN};
    int shown = 0, row = 0;
    for (int m = 0; m < out->nmodes; m++)
        shown += out->modes[m].model_hz <= out->high_hz;
    struct number_table *table = table_headed(pool, shown, 8, head);
    for (int m = 0; m < out->nmodes && row < shown; m++) {
        const struct transfer_mode *mode = &out->modes[m];
        const struct transfer_mode_agreement *agreement = mode->agreement ? mode->agreement : &none;
        char from[40];
        if (!(mode->model_hz <= out->high_hz))
            continue;
        size_t i = 0;
        for (; mode->damping_from[i] && i + 1 < sizeof from; i++)
            from[i] = mode->damping_from[i] == '_' ? ' ' : mode->damping_from[i];
        from[i] = 0;
        table_cell(table, row, 0, mode->rigid ? "rigid" : human_fixed(pool, mode->mode, 0));
        table_cell(table, row, 1, human_fixed(pool, mode->model_hz, 3));
        table_cell(table, row, 2, human_fixed(pool, mode->measured_hz, 3));
        table_cell(table, row, 3, human_digits(pool, 100 * mode->damping, 4));
        table_cell(table, row, 4, pool_copy_text(pool, from));
        table_cell(table, row, 5, human_fixed(pool, agreement->frac, 3));
        table_cell(table, row, 6, human_signed(pool, agreement->level_db, 2));
        table_cell(table, row++, 7, human_signed(pool, agreement->phase_deg, 1));
    }
    return table;
}
