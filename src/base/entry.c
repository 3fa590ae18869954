#include "base/base.h"

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
