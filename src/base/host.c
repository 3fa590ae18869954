#include "base/base.h"

#ifdef __SSE2_MATH__
#include <xmmintrin.h>
#endif

void host_enter_floating(fenv_t *floating)
{
    (void)feholdexcept(floating);
}

void host_leave_floating(const fenv_t *floating)
{
    (void)fesetenv(floating);
}

void host_enter_arithmetic(struct host_arithmetic *arithmetic)
{
#ifdef __SSE2_MATH__
    arithmetic->sse = _mm_getcsr();
    _mm_setcsr(arithmetic->sse | _MM_MASK_MASK);
#else
    host_enter_floating(&arithmetic->floating);
#endif
}

void host_leave_arithmetic(const struct host_arithmetic *arithmetic)
{
#ifdef __SSE2_MATH__
    _mm_setcsr(arithmetic->sse);
#else
    host_leave_floating(&arithmetic->floating);
#endif
}

int host_enter_locale(struct host_locale *locale)
{
    locale->own = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (!locale->own)
        return ROTID_ERROR_MEMORY;
    locale->before = uselocale(locale->own);
    return ROTID_OK;
}

void host_leave_locale(const struct host_locale *locale)
{
    (void)uselocale(locale->before);
    freelocale(locale->own);
}

const char *host_error_text(int number, char *text)
{
    if (strerror_r(number, text, HOST_ERROR_TEXT))
        (void)snprintf(text, HOST_ERROR_TEXT, "error %d", number);
    return text;
}
