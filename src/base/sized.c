#include "base/base.h"

#include <stddef.h>
#include <string.h>

#define MOST 4096 /* bytes: a larger size was never written by a sizeof, and what it claims may not be readable */

/* The first version ends with the member `last`, which stays the one that is named here when others follow it. No struct may end
 * in padding: a host of before would have anything there, where a later version has a member. */
#define STRUCT(type, argument, last)                                                                                             \
    {                                                                                                                            \
#type, argument, offsetof(type, last) + sizeof(((type *)0)->last), sizeof(type)                                          \
    }
#define ENDS_WITH(type, last)                                                                                                    \
    _Static_assert(offsetof(type, size) == 0 && offsetof(type, last) + sizeof(((type *)0)->last) == sizeof(type), #type)

static const struct sized_struct table[] = {
    [SIZED_ENVIRONMENT] = STRUCT(rotid_environment, "environment", context),
    [SIZED_DIAGNOSE_OPTIONS] = STRUCT(rotid_diagnose_options, "options", seed),
    [SIZED_SUGGEST_OPTIONS] = STRUCT(rotid_suggest_options, "options", seed),
    [SIZED_SPEEDS_OPTIONS] = STRUCT(rotid_speeds_options, "options", seed),
    [SIZED_MODEL] = STRUCT(rotid_model, "model", user),
    [SIZED_MEASURED] = STRUCT(rotid_measured, "measured", holdout),
    [SIZED_STATE] = STRUCT(rotid_state, "state", parameter),
    [SIZED_FIT_OPTIONS] = STRUCT(rotid_fit_options, "options", bijection_chi),
    [SIZED_LM_OPTIONS] = STRUCT(rotid_lm_options, "options", trace_user),
    [SIZED_CAUSE] = STRUCT(rotid_host_cause, "cause", user),
    [SIZED_HOST_OPTIONS] = STRUCT(rotid_host_options, "options", reserved),
};

ENDS_WITH(rotid_environment, context);
ENDS_WITH(rotid_diagnose_options, after);
ENDS_WITH(rotid_suggest_options, speed_backward);
ENDS_WITH(rotid_speeds_options, seed);
ENDS_WITH(rotid_model, sensor);
ENDS_WITH(rotid_measured, centre_std);
ENDS_WITH(rotid_state, parameter);
ENDS_WITH(rotid_fit_options, decrease_least);
ENDS_WITH(rotid_lm_options, decrease_least);
ENDS_WITH(rotid_host_cause, user);
ENDS_WITH(rotid_host_options, reserved);

int sized_copy(const struct sized_struct *structure, const void *given, char *failure, void *copy)
{
    const char *type = structure->type, *argument = structure->argument;
    const unsigned char *byte = given;
    size_t known = structure->known, size;
    memcpy(&size, given, sizeof size);
    if (size < structure->first || size > MOST)
        return refuse(failure, "%s->size is %zu, expected sizeof(%s), here %zu", argument, size, type, known);
    for (size_t i = known; i < size; i++)
        if (byte[i])
            return refuse(failure, "%s->size is %zu and byte %zu of it is not zero, but librotid %s knows %zu bytes of %s",
                          argument, size, i, ROTID_VERSION, known, type);
    memset(copy, 0, known);
    memcpy(copy, given, size < known ? size : known);
    return ROTID_OK;
}

int sized_take(enum sized which, const void *given, char *failure, void *copy)
{
    return sized_copy(&table[which], given, failure, copy);
}
