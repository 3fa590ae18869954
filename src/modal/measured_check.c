#include "modal/modal.h"

static int check_mode(const rotid_measured *measured, int k, char *failure)
{
    if (!(isfinite(measured->frequency_hz[k]) && measured->frequency_hz[k] > 0))
        return refuse(failure, "measured->frequency_hz[%d] is %g, expected a positive number", k, measured->frequency_hz[k]);
    if (measured->number[k] < 1)
        return refuse(failure, "measured->number[%d] is %d, expected a mode of the model, from 1", k, measured->number[k]);
    for (int other = 0; other < k; other++)
        if (measured->number[other] == measured->number[k])
            return refuse(failure,
                          "measured->number[%d] is %d, and so is measured->number[%d], expected each mode of the model once", k,
                          measured->number[k], other);
    if (measured->frequency_std && !(measured->frequency_std[k] > 0 && isfinite(measured->frequency_std[k])))
        return refuse(
            failure,
            "measured->frequency_std[%d] is %g, expected a positive relative standard deviation (measured->holdout takes "
            "a mode out)",
            k, measured->frequency_std[k]);
    return ROTID_OK;
}

static int check_shapes(const rotid_model *model, const rotid_measured *measured, char *failure)
{
    int nmaster = model->nmaster;
    if (!measured->shape || !measured->shape_std)
        return ROTID_OK;
    for (int k = 0; k < measured->nmode; k++)
        for (int s = 0; s < nmaster; s++) {
            ptrdiff_t at = s + (ptrdiff_t)k * nmaster;
            if (isfinite(measured->shape[at]) && !(measured->shape_std[at] > 0 && isfinite(measured->shape_std[at])))
                return refuse(failure,
                              "measured->shape_std of master %d in mode %d is %g, expected a positive number (NaN in "
                              "measured->shape takes a component out)",
                              s, k, measured->shape_std[at]);
        }
    return ROTID_OK;
}

static int check_whole(const rotid_measured *measured, char *failure)
{
    const double std[2] = {measured->mass_std, measured->centre_std}, value[2] = {measured->mass, measured->centre};
    static const char *const name[2] = {"mass", "centre"};
    for (int i = 0; i < 2; i++) {
        if (!(std[i] >= 0 && isfinite(std[i])))
            return refuse(failure, "measured->%s_std is %g, expected a standard deviation, or 0 where nothing is measured",
                          name[i], std[i]);
        if (std[i] > 0 && !measured->whole)
            return refuse(failure, "measured->whole is NULL beside measured->%s, expected the two motions of the whole", name[i]);
        if (std[i] > 0 && !(isfinite(value[i]) && (i || value[i] > 0)))
            return refuse(failure, "measured->%s is %g, expected %s", name[i], value[i], i ? "a number" : "a positive number");
    }
    return ROTID_OK;
}

int measured_check(const rotid_model *model, const rotid_measured *measured, int kind, int reduction, char *failure)
{
    int size = reduction == ROTID_REDUCTION_NONE ? model->n : model->nmaster;
    if (measured->nmode < 1)
        return refuse(failure, "measured->nmode is %d, expected 1 or more", measured->nmode);
    if (!measured->number || !measured->frequency_hz)
        return refuse(failure, "measured->%s is NULL, expected nmode = %d values", measured->number ? "frequency_hz" : "number",
                      measured->nmode);
    for (int k = 0; k < measured->nmode; k++) {
        int status = check_mode(measured, k, failure);
        if (status)
            return status;
    }
    if (kind == ROTID_LIKELIHOOD && !measured->frequency_std)
        return refuse(failure,
                      "measured->frequency_std is NULL, which ROTID_LIKELIHOOD weighs by, expected nmode = %d values or "
                      "another options->functional",
                      measured->nmode);
    if (kind == ROTID_LIKELIHOOD && measured->shape && !measured->shape_std)
        return refuse(failure, "measured->shape_std is NULL beside shapes, which ROTID_LIKELIHOOD weighs by, expected nmaster x "
                               "nmode values");
    int status = check_whole(measured, failure);
    if (!status)
        status = check_shapes(model, measured, failure);
    for (int k = 0; k < measured->nmode && !status; k++)
        if (measured->number[k] > size - model->nrigid)
            status = failure_say(failure, ROTID_ERROR_UNPAIRED,
                                 "measured->number[%d] is %d, but behind %d rigid ones the model has %d modes%s", k,
                                 measured->number[k], model->nrigid, model->nrigid < size ? size - model->nrigid : 0,
                                 reduction == ROTID_REDUCTION_NONE ? "" : " on its masters");
    return status;
}
