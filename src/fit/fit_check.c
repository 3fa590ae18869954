#include "fit/fit_check.h"

#include <math.h>

#include "base/failure.h"
#include "linalg/matrix_check.h"
#include "modal/measured_check.h"

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
    int status = indices_check("master", model->nmaster, model->master, model->n, failure);
    return status ? status : indices_check("far", model->nfar, model->far, model->n, failure);
}

int fit_check_parameters(int count, const rotid_parameter *parameter, char *failure)
{
    if (count && !parameter)
        return refuse(failure, "parameter is NULL, expected model->nparam = %d of them", count);
    for (int p = 0; p < count; p++) {
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
    if (options->functional < ROTID_HYBRID || options->functional > ROTID_LIKELIHOOD)
        return refuse(failure, "options->functional is %d, expected ROTID_HYBRID, ROTID_HYBRID_F or ROTID_LIKELIHOOD",
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

int fit_check(const rotid_model *model, const rotid_parameter *parameter, const rotid_measured *measured,
              const rotid_fit_options *options, char *failure)
{
    int status = fit_check_model(model, failure);
    if (!status)
        status = fit_check_parameters(model->nparam, parameter, failure);
    if (!status)
        status = check_options(options, failure);
    return status ? status : measured_check(model, measured, options->functional, options->reduction, failure);
}
