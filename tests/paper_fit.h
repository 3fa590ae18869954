/* A fit of the paper's rotor, ready to be changed before it is run, and an objective of its own to judge the result by. */
#ifndef ROTID_TESTS_PAPER_FIT_H
#define ROTID_TESTS_PAPER_FIT_H

#include "modal/modal.h"
#include "model/model.h"
#include "paper_rotor.h"
#include "support.h"

#define PAPER_MOST_PARAMETERS 5

struct paper_fit {
    struct pool pool;
    struct rotor_model client;
    struct parameter chosen[PAPER_MOST_PARAMETERS];
    rotid_parameter parameter[PAPER_MOST_PARAMETERS];
    int number[PAPER_MODES], holdout[PAPER_MODES];
    double frequency_hz[PAPER_MODES], frequency_std[PAPER_MODES];
    double shape[PAPER_SENSORS * PAPER_MODES], shape_std[PAPER_SENSORS * PAPER_MODES];
    rotid_measured measured; /* frequencies of the paper; no noise, shapes or held-out modes until they are asked for */
    rotid_fit_options options;
    struct prediction prediction; /* of paper_predict */
    int predicts, reduction;
};

/* Where SciPy's Gauss-Newton with a five-point Jacobian puts the minimum of HYBRID with GUYAN (scipy 1.17.1, dense generalised
 * eigenproblem; it agrees with scipy.optimize.least_squares to 1e-7). */
extern const double scipy_optimum[2];
extern const double scipy_objective;

/* HYBRID and GUYAN on core.E and core.G from the paper's start, bounds 1e6 to 2.3e11 and 1e6 to 0.898e11 Pa. */
void paper_fit_open(struct paper_fit *fit, enum bundle_model model);
void paper_fit_open_rotor(struct paper_fit *fit, const struct rotor *rotor, int nparameter, const struct parameter *parameter);
void paper_fit_close(struct paper_fit *fit);

/* Frequencies [Hz] and, unless NULL, shapes [sensors * modes] with a largest component of 1 at x. */
void paper_predict(struct paper_fit *fit, int reduction, const double *x, double *frequency_hz, double *shape);

/* Takes the prediction of the full model at x as what was measured; a standard deviation of 0: not known, or no shapes at all. */
void paper_synthesise(struct paper_fit *fit, const double *x, double frequency_std, double shape_std);

/* Runs it; the status must be ROTID_OK. */
rotid_fit_result *paper_run(struct paper_fit *fit);

/* The objective at x from its definition, and its gradient with respect to x_p/start_p by five-point differences: shares the
 * prediction with the fit, but neither the residuals nor any derivative. */
double paper_objective(struct paper_fit *fit, const double *x);
double paper_gradient(struct paper_fit *fit, const double *x, double *gradient); /* its largest component; gradient may be NULL */

/* The x[p] between low and high that minimises paper_objective with the others as they are, by golden section. */
double paper_line_minimum(struct paper_fit *fit, double *x, int p, double low, double high);

#endif
