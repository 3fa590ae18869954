/* The figures of a diagnosis; as figures.h. */
#ifndef ROTID_PAGE_FIGURES_DIAGNOSIS_H
#define ROTID_PAGE_FIGURES_DIAGNOSIS_H

#include "page/document.h"
#include "page/result.h"

/* Standardised residuals of the base model: per mode, and per sensor where shapes were measured. */
void figure_residuals(struct document *document, const struct result *result);
/* The force that the base model lacks along the axis, under the drawn rotor with the places of the named cause, or of those that
 * cannot be told apart. None where the model is adequate: the most of mere noise is no place to look at. */
void figure_places(struct document *document, const struct result *result);
/* Drop of chi2 by each candidate of a round, number from 0. */
void figure_evidence(struct document *document, const struct result *result, int number);
/* Errors of the frequencies before and after, mode by mode; and the rms errors of the fit and of the prediction of held-out data.
 * None without an extended model. */
void figure_improvement(struct document *document, const struct result *result);
void figure_gain(struct document *document, const struct result *result);
/* Intervals of the parameters before and after, and by the fit as the deck states it. */
void figure_change(struct document *document, const struct result *result);

#endif
