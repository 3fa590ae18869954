/* What a call owes the thread of its host: no trap on a NaN that is compared, and no comma in the numbers it reads and writes. */
#ifndef ROTID_BASE_HOST_H
#define ROTID_BASE_HOST_H

#include <fenv.h>
#include <locale.h>

/* Between the two the calling thread computes with floating-point exceptions masked, whatever traps the host has enabled (legacy
 * Fortran runs with -ffpe-trap=invalid,zero,overflow); behind them traps, flags and rounding are the host's again. Pairs may be
 * nested. What is computed in between has to reach the caller through memory, in a function of its own: compilers know nothing of
 * traps, and move an operation on registers across either call. */
void host_enter_floating(fenv_t *floating);
void host_leave_floating(const fenv_t *floating);

/* Such a function, where the public routine beside it does nothing else than enter, call it and leave. */
#define HOST_COMPUTES static __attribute__((noinline))

struct host_locale {
    locale_t before, own;
};

/* Between the two the thread's locale is "C": one with a decimal comma cuts 2.1e11 off behind the 2, and in a Turkish one "fit"
 * is no other spelling of "FIT". ROTID_OK, or ROTID_ERROR_MEMORY, where there is nothing to leave. */
int host_enter_locale(struct host_locale *locale);
void host_leave_locale(const struct host_locale *locale);

/* What the operating system calls an error number, in text [HOST_ERROR_TEXT]: the buffer of strerror may be that of another
 * thread. Returns text. */
#define HOST_ERROR_TEXT 128
const char *host_error_text(int number, char *text);

#endif
