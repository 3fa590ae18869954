/* What a public routine does first and last: reasons of failures, structs that begin with their size, texts of a status, the
 * entry. */
#include "base/base.h"

size_t failure_append(char *failure, size_t length, const char *text)
{
    const size_t full = ROTID_FAILURE_LENGTH - 1;
    size_t count = strlen(text), room = full - length;
    int cut = count > room;
    if (cut)
        for (count = room; count && ((unsigned char)text[count] & 0xc0) == 0x80;)
            count--; /* not within a character of UTF-8 */
    memcpy(failure + length, text, count);
    failure[length + count] = 0;
    return cut ? full : length + count;
}

static void say(char *failure, const char *format, va_list arguments, const char *behind)
{
    char text[2 * ROTID_FAILURE_LENGTH] = ""; /* names of the host may be long */
    struct host_locale locale;
    int entered = host_enter_locale(&locale) == ROTID_OK;
    (void)vsnprintf(text, sizeof text, format, arguments);
    if (entered)
        host_leave_locale(&locale);
    (void)failure_append(failure, failure_append(failure, 0, text), behind);
}

int failure_say(char *failure, int status, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    if (failure)
        say(failure, format, arguments, "");
    va_end(arguments);
    return status;
}

int failure_say_of(char *failure, int status, const char *format, ...)
{
    char own[ROTID_FAILURE_LENGTH] = "";
    va_list arguments;
    va_start(arguments, format);
    if (failure && *failure) {
        (void)failure_append(own, 0, failure);
        say(failure, format, arguments, own);
    }
    va_end(arguments);
    return status;
}

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
    [SIZED_DIAGNOSE_OPTIONS] = STRUCT(rotid_diagnose_options, "options", after),
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

const char *rotid_status_text(int status)
{
    switch (status) {
#define STATUS_TEXT(name, value, text)                                                                                           \
    case value:                                                                                                                  \
        return text;
        ROTID_STATUS_LIST(STATUS_TEXT)
#undef STATUS_TEXT
    default:
        return "unknown status";
    }
}

int rotid_status_converged(int status)
{
    return status == ROTID_STOP_GRADIENT || status == ROTID_STOP_STEP || status == ROTID_STOP_OBJECTIVE;
}

const char *rotid_status_name(int status)
{
    switch (status) {
#define STATUS_NAME(name, value, text)                                                                                           \
    case value:                                                                                                                  \
        return #name;
        ROTID_STATUS_LIST(STATUS_NAME)
#undef STATUS_NAME
    default:
        return "unknown status";
    }
}

static int take_environment(const rotid_environment *given, char *failure, rotid_environment *environment)
{
    int status = sized_take(SIZED_ENVIRONMENT, given, failure, environment);
    const rotid_allocator *allocator = status ? NULL : environment->allocator;
    if (allocator && (!allocator->allocate || !allocator->release)) {
        environment->allocator = NULL;
        return refuse(failure, "environment->allocator->%s is NULL, expected a function",
                      allocator->allocate ? "release" : "allocate");
    }
    return status;
}

int entry_open(struct entry *entry, const rotid_environment *environment, char *failure)
{
    host_enter_floating(&entry->floating);
    entry->failure = failure;
    entry->environment = (rotid_environment){0};
    if (failure)
        *failure = 0;
    int status = environment ? take_environment(environment, failure, &entry->environment) : ROTID_OK;
    pool_open(&entry->scratch, entry->environment.allocator);
    return status;
}

int entry_close(struct entry *entry, int status)
{
    char *failure = entry->failure;
    pool_close(&entry->scratch);
    if (failure && status >= 0)
        *failure = 0;
    else if (failure && (!*failure || status == ROTID_ERROR_MEMORY))
        (void)failure_append(failure, 0, rotid_status_text(status));
    host_leave_floating(&entry->floating);
    return status;
}
