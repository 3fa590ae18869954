#include "report/diagnosis_items.h"

#include <string.h>

const struct effect_parameter_name *candidate_parameter(const struct candidate *candidate, int p)
{
    const struct effect_kind *kind = candidate->effect.kind;
    if (p >= candidate->nparameter || p >= EFFECT_MOST_PARAMETERS)
        return NULL;
    if (kind)
        return p < kind->nparameter ? &kind->parameter[p] : NULL;
    return p == 0 && candidate->cause->value.name ? &candidate->cause->value : NULL;
}

int fitted_parameter(const struct job *job, const rotid_fit_result *fit, const char *name)
{
    for (int p = 0; fit && p < fit->n; p++)
        if (!strcmp(job->bounds[p].name, name))
            return p;
    return -1;
}
