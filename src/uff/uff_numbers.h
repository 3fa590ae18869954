/* One number as Fortran or C writes it. Internal to uff_*.c. */
#ifndef ROTID_UFF_UFF_NUMBERS_H
#define ROTID_UFF_UFF_NUMBERS_H

#include <stddef.h>

enum uff_fault { UFF_FAULT_NONE, UFF_FAULT_COUNT, UFF_FAULT_MALFORMED, UFF_FAULT_RANGE, UFF_FAULT_NOT_FINITE };

/* The whole of text [length] must be the number; *value is set when it is. */
enum uff_fault uff_parse_integer(const char *text, size_t length, long long *value);

/* Fortran writes the exponent as E, D or Q in either case, or, where it has three digits, without the letter: 1.0-100. */
enum uff_fault uff_parse_real(const char *text, size_t length, double *value);

#endif
