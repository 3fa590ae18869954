#include "page/sections.h"

#include <math.h>

#include "page/figures.h"
#include "page/human.h"
#include "page/tables.h"

void section_rotor(struct document *document, const struct result *result, const rotid_identification *fit)
{
    document_section(document, "model", "The rotor");
    figure_rotor(document, result, geometry_of_result(result), fit);
}

void section_agreement(struct document *document, const struct result *result)
{
    const rotid_identification *fit = result->identify;
    document_section(document, "agreement", "Model and measurement");
    figure_frequencies(document, result, fit);
    figure_shapes(document, result, fit);
    figure_matrices(document, result, fit);
    document_table(document, "Modes: errors are predicted over measured frequency, less one",
                   tables_fitted_modes(document->pool, result, fit));
}

void section_states(struct document *document, const struct result *result)
{
    const rotid_identification *fit = result->identify;
    document_section(document, "states", "All states together");
    figure_frequencies(document, result, fit);
    document_table(document, "States: one set of parameters for all, each with its own model and modes",
                   tables_states(document->pool, fit));
}

void section_fit(struct document *document, const struct result *result)
{
    const rotid_identification *fit = result->identify;
    document_section(document, "parameters", "What was identified");
    figure_intervals(document, result, fit);
    figure_correlation(document, result, fit);
    document_table(document, "Parameters", tables_parameters(document->pool, fit));
    document_section(document, "fit", "How the fit got there");
    figure_convergence(document, result, fit);
    figure_iterates(document, result, fit);
    figure_bijection(document, result, fit);
    document_table(document, "Minimisers from the same start", tables_minimisers(document->pool, fit));
}

void section_modes(struct document *document, const struct result *result)
{
    document_section(document, "model-modes", "Modes of the model");
    figure_modes(document, result);
    figure_meridian(document, result);
    figure_meridian_modes(document, result);
    document_table(document, "Modes of the full and of the condensed model", tables_modes(document->pool, result->modes));
    if (!result->modes->beside)
        return;
    document_section(document, "beside", "The beam beside the solid");
    if (result->modes->beside->sentence)
        document_paragraph(document, "In short, %s.", result->modes->beside->sentence);
    document_table(document, "Modes of the rotor as a beam and as a solid: the difference is beam over solid, less one",
                   tables_beside(document->pool, result->modes->beside));
    if (result->modes->beside->nmoduli)
        document_table(document, "Moduli of the beam whose frequencies are nearest to those of the solid",
                       tables_beside_moduli(document->pool, result->modes->beside));
}

void section_sensitivity(struct document *document, const struct result *result)
{
    struct pool *pool = document->pool;
    const struct sensitivity *s = result->sensitivity;
    const char *at = "";
    document_section(document, "dependence", "Sensitivity");
    for (int p = 0; p < s->nparameters && at; p++)
        at = pool_format(pool, "%s%s%s = %s", at, p ? ", " : "", s->parameters[p].name,
                         human_value(pool, s->parameters[p].reference, s->parameters[p].unit));
    document_paragraph(document, "At %s, reduction %s.", at ? at : "", s->reduction);
    figure_sensitivity(document, result);
    figure_sensitivity_curves(document, result);
    figure_growth(document, result);
}

void section_transfer(struct document *document, const struct result *result)
{
    const struct transfer_result *out = result->frf;
    struct pool *pool = document->pool;
    const char *at = "";
    document_section(document, "transfer", "Transfer functions");
    document_paragraph(document, "%d synthesised %s from modes up to %s\xc2\xa0Hz with the damping below; %s%s.", out->nfunctions,
                       human_plural(out->nfunctions, "function", "functions"), human_trimmed(pool, out->modes_up_to_hz, 4),
                       out->measured_file ? "measured ones from " : "none was measured",
                       out->measured_file ? out->measured_file : "");
    for (int p = 0; p < out->nparameters && at; p++)
        at = pool_format(pool, "%s%s%s = %s", at, p ? ", " : "", out->parameters[p].name,
                         human_value(pool, out->parameters[p].value, out->parameters[p].unit));
    if (out->nparameters)
        document_paragraph(document, "The model is the identified one: %s.", at ? at : "");
    if (out->agreement && isfinite(out->agreement->frac))
        document_paragraph(
            document, "FRAC over all functions is %s, and %s with the measured frequencies put in for the model's.",
            human_fixed(pool, out->agreement->frac, 3), human_fixed(pool, out->agreement->frac_at_measured_frequencies, 3));
    if (!out->with_curves)
        document_paragraph(document, "The result has no curves, because there were too many lines: rotid frf -o writes them as a "
                                     "universal file.");
    if (!out->complete)
        document_paragraph(document, "It was interrupted: %d functions were finished.", out->nfunctions);
    figure_transfer(document, result);
    document_table(document, "Modes within the lines", tables_transfer_modes(pool, out));
}
