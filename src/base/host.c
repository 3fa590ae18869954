#include "base/host.h"

#include <stdio.h>
#include <string.h>

#include "rotid.h"

void host_enter_floating(struct host *host)
{
    (void)feholdexcept(&host->floating);
}

void host_leave_floating(const struct host *host)
{
    (void)fesetenv(&host->floating);
}

int host_enter(struct host *host)
{
    host->own = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (!host->own)
        return ROTID_ERROR_MEMORY;
    host->locale = uselocale(host->own);
    host_enter_floating(host);
    return ROTID_OK;
}

void host_leave(const struct host *host)
{
    host_leave_floating(host);
    (void)uselocale(host->locale);
    freelocale(host->own);
}

const char *host_error_text(int number, char *text)
{
    if (strerror_r(number, text, HOST_ERROR_TEXT))
        (void)snprintf(text, HOST_ERROR_TEXT, "error %d", number);
    return text;
}
