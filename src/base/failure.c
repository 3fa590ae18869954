#include "base/base.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

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
