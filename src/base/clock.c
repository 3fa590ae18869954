#include "base/base.h"

#include <time.h>

double clock_seconds(void)
{
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now); /* which nobody sets */
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}
