/* The figures of a page, each added to the current section of the document with its script, caption and numbers. Where a result
 * has nothing to show in one, none is added. A worked example to follow is figures_convergence.c. */
#ifndef ROTID_PAGE_FIGURES_H
#define ROTID_PAGE_FIGURES_H

#include "page/document.h"
#include "page/result.h"

/* The rotor to scale: materials, mesh, sensors, springs, tie rods, disks (Figures 1 and 4 of the paper). fit: what was identified
 * is set off; may be NULL. */
void figure_rotor(struct document *document, const struct result *result, const rotid_geometry *geometry,
                  const rotid_identification *fit);

/* Functional, gradient, damping and step over the iterations (10); parameters over those, relative to the end (11); the iterates
 * on the bijection that keeps them within their bounds (6). */
void figure_convergence(struct document *document, const struct result *result, const rotid_identification *fit);
void figure_iterates(struct document *document, const struct result *result, const rotid_identification *fit);
void figure_bijection(struct document *document, const struct result *result, const rotid_identification *fit);

/* Errors of the frequencies beside those of NLopt's minimisers and of the references of the heading. */
void figure_frequencies(struct document *document, const struct result *result, const rotid_identification *fit);
/* 95 % intervals of the parameters; from three on their correlation as well. */
void figure_intervals(struct document *document, const struct result *result, const rotid_identification *fit);
void figure_correlation(struct document *document, const struct result *result, const rotid_identification *fit);
/* Measured and predicted shapes (16). */
void figure_shapes(struct document *document, const struct result *result, const rotid_identification *fit);
/* NCO and MAC of every measured with every predicted shape (17). */
void figure_matrices(struct document *document, const struct result *result, const rotid_identification *fit);

/* Shapes of the model alone. */
void figure_modes(struct document *document, const struct result *result);
/* Of a solid: the mesh of its meridian, and its motion and strain energy in the first modes. */
void figure_meridian(struct document *document, const struct result *result);
void figure_meridian_modes(struct document *document, const struct result *result);
/* Sensitivity of each mode (Table 1), how the functional grows with each parameter (5), and f(E) against f(F) (3). */
void figure_sensitivity(struct document *document, const struct result *result);
void figure_sensitivity_curves(struct document *document, const struct result *result);
void figure_growth(struct document *document, const struct result *result);
/* What one more sensor is worth along the axis, and the places of the plans of `suggest`. */
void figure_sensor_worth(struct document *document, const struct result *result);
/* Synthesised and measured transfer functions (15), a figure each, the telling ones of many. */
void figure_transfer(struct document *document, const struct result *result);
/* The figure of one function, with the modes and the band of `out`; places that are NaN are not told. why: ", the best of all", "" */
void figure_transfer_function(struct document *document, const char *source, const struct transfer_result *out,
                              const struct transfer_function *f, const char *why);
/* The poles of a modal analysis over the orders, the modes that were taken, the magnitude of all functions. */
void figure_stabilisation(struct document *document, const struct result *result);

#endif
