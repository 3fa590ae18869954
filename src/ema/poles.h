/* Poles lambda [1/s] in the order of their frequencies. */
#ifndef ROTID_EMA_POLES_H
#define ROTID_EMA_POLES_H

#include <stddef.h>

#include "base/complex.h"

/* By rising Im lambda. pole [count] in and out. */
void sort_poles(size_t count, double complex *pole);

#endif
