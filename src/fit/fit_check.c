#include "fit/fit.h"

/* y is of the size of 1/chi: it has to have a square, and a small part of it to stand out against 1e-24, where steps end */
#define CHI_LEAST 1e-50
#define CHI_MOST  1e6

int fit_check_model(const rotid_model *model, char *failure)
{
    if (model->n < 2)
        return refuse(failure, "model->n is %d, expected 2 or more", model->n);
    if (model->kd < 0 || model->kd >= model->n)
        return refuse(failure, "model->kd is %d, expected 0 ... %d (n - 1)", model->kd, model->n - 1);
    if (model->nparam < 0)
        return refuse(failure, "model->nparam is %d, expected 0 or more", model->nparam);
    if (model->nrigid < 0)
        return refuse(failure, "model->nrigid is %d, expected 0 or more", model->nrigid);
    if (!model->matrices)
        return refuse(failure, "model->matrices is NULL, expected a function");
    if (model->sensor && model->nmaster < 0)
        return refuse(failure, "model->nmaster is %d, expected 0 or more", model->nmaster);
    for (ptrdiff_t i = 0; model->sensor && i < (ptrdiff_t)model->n * model->nmaster; i++)
        if (!isfinite(model->sensor[i]))
            return refuse(failure, "model->sensor[%td] is %g, expected a number", i, model->sensor[i]);
    int status = model->sensor ? ROTID_OK : indices_check("master", model->nmaster, model->master, model->n, failure);
    return status ? status : indices_check("far", model->nfar, model->far, model->n, failure);
}

int fit_check_parameters(const char *count, int nparam, const rotid_parameter *parameter, char *failure)
{
    if (nparam && !parameter)
        return refuse(failure, "parameter is NULL, expected %s = %d of them", count, nparam);
    for (int p = 0; p < nparam; p++) {
        const rotid_parameter *q = &parameter[p];
        if (!(isfinite(q->upper - q->lower) && q->lower < q->start && q->start < q->upper && q->start != 0))
            return refuse(failure,
                          "parameter[%d]%s%.40s has lower %g, start %g, upper %g, expected numbers with lower < start < upper, a "
                          "start other than 0, and a finite upper - lower",
                          p, q->name ? " " : "", q->name ? q->name : "", q->lower, q->start, q->upper);
    }
    return ROTID_OK;
}

static int check_options(const rotid_fit_options *options, char *failure)
{
    if (options->functional < ROTID_LIKELIHOOD || options->functional > ROTID_HYBRID_F)
        return refuse(failure, "options->functional is %d, expected ROTID_LIKELIHOOD, ROTID_HYBRID or ROTID_HYBRID_F",
                      options->functional);
    if (options->reduction < ROTID_REDUCTION_NONE || options->reduction > ROTID_IRS)
        return refuse(failure, "options->reduction is %d, expected ROTID_REDUCTION_NONE, ROTID_GUYAN or ROTID_IRS",
                      options->reduction);
    if (options->derivative < ROTID_NELSON || options->derivative > ROTID_MODAL)
        return refuse(failure, "options->derivative is %d, expected ROTID_NELSON or ROTID_MODAL", options->derivative);
    if (options->derivative == ROTID_MODAL && options->reduction == ROTID_REDUCTION_NONE)
        return refuse(failure, "options->derivative is ROTID_MODAL without a reduction, expected ROTID_GUYAN or ROTID_IRS");
    if (options->bijection_chi > 0 && !(options->bijection_chi >= CHI_LEAST && options->bijection_chi <= CHI_MOST))
        return refuse(failure, "options->bijection_chi is %g, expected %g ... %g, or 0 for the default", options->bijection_chi,
                      CHI_LEAST, CHI_MOST);
    return ROTID_OK;
}

static int of_state(const struct fit_problem *problem, int s, int status, char *failure)
{
    return status && problem->named ? failure_say_of(failure, status, "state[%d]: ", s) : status;
}

static int check_map(const struct joint_state *state, int nparam, char *failure)
{
    int n = state->model->nparam;
    if (!state->parameter && n > nparam)
        return refuse(failure, "parameter is NULL and model->nparam is %d, expected at most nparam = %d", n, nparam);
    for (int q = 0; q < n; q++)
        if (joint_unknown(state->parameter, q) < 0 || joint_unknown(state->parameter, q) >= nparam)
            return refuse(failure, "parameter[%d] is %d, expected an unknown, 0 ... %d (nparam - 1)", q, state->parameter[q],
                          nparam - 1);
    return ROTID_OK;
}

static int is_fitted(const rotid_measured *measured)
{
    for (int k = 0; k < measured->nmode; k++)
        if (functional_fits(measured, k))
            return 1;
    return 0;
}

/* Somewhere a mode is fitted, and every unknown acts there. */
static int check_use(const struct fit_problem *problem, char *failure)
{
    int any = 0;
    for (int s = 0; s < problem->nstate; s++)
        any |= is_fitted(problem->state[s].measured);
    if (!any)
        return refuse(failure, "measured->holdout leaves no mode to be fitted%s, expected a 0 in it",
                      problem->named ? " in any state" : "");
    for (int p = 0; p < problem->nparam; p++) {
        int used = 0, known = 0;
        for (int s = 0; s < problem->nstate; s++)
            for (int q = 0; q < problem->state[s].model->nparam; q++)
                if (joint_unknown(problem->state[s].parameter, q) == p) {
                    known = 1;
                    used |= is_fitted(problem->state[s].measured);
                }
        const char *name = problem->parameter[p].name;
        if (!used && !(problem->more && !known))
            return refuse(failure, "parameter[%d]%s%.40s is used by no state%s, expected one that is fitted", p, name ? " " : "",
                          name ? name : "", known ? " but such as are held out" : "");
    }
    return ROTID_OK;
}

int fit_check(const struct fit_problem *problem, const rotid_fit_options *options, char *failure)
{
    int status = ROTID_OK;
    for (int s = 0; s < problem->nstate && !status; s++)
        status = of_state(problem, s, fit_check_model(problem->state[s].model, failure), failure);
    if (!status)
        status = fit_check_parameters(problem->named ? "nparam" : "model->nparam", problem->nparam, problem->parameter, failure);
    if (!status)
        status = check_options(options, failure);
    for (int s = 0; s < problem->nstate && !status; s++) {
        const struct joint_state *state = &problem->state[s];
        status = check_map(state, problem->nparam, failure);
        if (!status && state->model->sensor && options->reduction != ROTID_REDUCTION_NONE)
            status = refuse(failure, "model->sensor is not NULL, which options->reduction condenses away, expected "
                                     "ROTID_REDUCTION_NONE");
        if (!status)
            status = measured_check(state->model, state->measured, options->functional, options->reduction, failure);
        status = of_state(problem, s, status, failure);
    }
    return status ? status : check_use(problem, failure);
}
