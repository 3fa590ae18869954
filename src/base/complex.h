/* Complex numbers of C. glibc defines CMPLX for compilers that call themselves GCC 4.7 or later, which clang does not. */
#ifndef ROTID_BASE_COMPLEX_H
#define ROTID_BASE_COMPLEX_H

#include <complex.h>

#ifndef CMPLX
#define CMPLX(re, im) __builtin_complex((double)(re), (double)(im))
#endif

#endif
