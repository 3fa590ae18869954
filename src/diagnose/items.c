#include "diagnose/diagnose.h"

const struct effect_parameter_name *candidate_parameter(const struct candidate *candidate, int p)
{
    const struct effect_kind *kind = candidate->effect.kind;
    if (p >= candidate->nparameter || p >= EFFECT_MOST_PARAMETERS)
        return NULL;
    if (kind)
        return p < kind->nparameter ? &kind->parameter[p] : NULL;
    return correction_parameter(candidate->cause, p);
}

const char *candidate_variant(const struct candidate *candidate)
{
    const struct cause_kind *cause = candidate->cause;
    int variant = candidate->effect.variant, words = (int)(sizeof cause->variant / sizeof *cause->variant);
    return cause->variant_option && variant >= 0 && variant < words ? cause->variant[variant] : NULL;
}

int fitted_parameter(const rotid_parameter *unknown, const rotid_fit_result *fit, const char *name)
{
    for (int p = 0; fit && p < fit->n; p++)
        if (!strcmp(unknown[p].name, name))
            return p;
    return -1;
}
