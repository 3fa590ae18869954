#include "base/failure.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/host.h"

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

int failure_say(char *failure, int status, const char *format, ...)
{
    char text[2 * ROTID_FAILURE_LENGTH] = ""; /* names of the host may be long */
    struct host_locale locale;
    if (!failure)
        return status;
    int entered = host_enter_locale(&locale) == ROTID_OK;
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (entered)
        host_leave_locale(&locale);
    (void)failure_append(failure, 0, text);
    return status;
}
