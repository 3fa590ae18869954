#include "page/sections.h"

#include "page/figures.h"

void section_rotor(struct document *document, const struct result *result, const struct fitted *fit)
{
    (void)document, (void)result, (void)fit;
}

void section_identify(struct document *document, const struct result *result)
{
    const struct fitted *fit = result->identify;
    document_section(document, "fit", "How the fit got there");
    figure_convergence(document, result, fit);
}

void section_modes(struct document *document, const struct result *result)
{
    (void)document, (void)result;
}

void section_sensitivity(struct document *document, const struct result *result)
{
    (void)document, (void)result;
}

void section_transfer(struct document *document, const struct result *result)
{
    (void)document, (void)result;
}
