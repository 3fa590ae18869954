#include "fit/fit.h"

double interval_half_percent(double value, double lower, double upper)
{
    double percent = 50 * (upper - lower) / fabs(value);
    return isfinite(percent) ? percent : (double)NAN;
}

int interval_is_wide(double value, double lower, double upper)
{
    return interval_half_percent(value, lower, upper) > 100 * INTERVAL_WIDE;
}

const char *percent_text(double percent, char text[32])
{
    (void)snprintf(text, 32, percent < 99.5 ? "%.2g %%" : "%.0f %%", percent);
    return text;
}

const char *linear_percent_text(double percent, char text[32])
{
    int linear = percent <= 100 * LINEAR_MOST;
    (void)snprintf(text, 32, "%s %.2g %%", linear ? "up to" : "more than", linear ? percent : 100 * LINEAR_MOST);
    return text;
}
