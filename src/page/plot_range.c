#include <math.h>
#include <stdio.h>

#include "base/text.h"
#include "page/plot.h"

#define TYPE_PX   12.0
#define NAME_PX   22.0 /* of a turned name beside the numbers */
#define MOST_TICS 50   /* of an axis */
#define TICK_PX   10.0 /* between a number and the axis */

void plot_range_join(struct plot_range *range, double value)
{
    if (!isfinite(value))
        return;
    range->from = fmin(range->from, value);
    range->to = fmax(range->to, value);
}

struct plot_range plot_range_of(int count, const double *value, double margin)
{
    struct plot_range range = {INFINITY, -INFINITY};
    for (int i = 0; i < count; i++)
        plot_range_join(&range, value[i]);
    if (!(range.from <= range.to))
        return (struct plot_range){0, 1};
    double width = range.to - range.from;
    if (width <= 1e-12 * fmax(fabs(range.from), fabs(range.to))) /* one value: gnuplot has no range of no width */
        width = range.from != 0 ? 0.1 * fabs(range.from) : 1, margin = fmax(margin, 0.5);
    return (struct plot_range){range.from - margin * width, range.to + margin * width};
}

double plot_share(const struct plot_range *range, double value)
{
    return (value - range->from) / (range->to - range->from);
}

struct plot_range plot_decades(int count, const double *value, int most)
{
    struct plot_range range = {INFINITY, -INFINITY};
    for (int i = 0; i < count; i++)
        if (value[i] > 0 && isfinite(value[i]))
            plot_range_join(&range, log10(value[i]));
    if (!(range.from <= range.to))
        return (struct plot_range){-1, 0};
    range.from = floor(range.from);
    range.to = ceil(range.to);
    range.to += range.to == range.from;
    range.from = fmax(range.from, range.to - most);
    return range;
}

double plot_tic(double length, int count)
{
    double rough = length / count, power = pow(10, floor(log10(rough))), step = rough / power;
    if (!(power > 0) || !isfinite(length)) /* numbers of no size, or beyond all: whatever is drawn of them */
        return 1;
    return power * (step < 1.5 ? 1 : step < 3.5 ? 2 : step < 7.5 ? 5 : 10);
}

double plot_width(const char *text)
{
    double width = 0;
    while (*text) { /* Arial: a few classes of letters */
        size_t bytes = text_utf8(text);
        char c = *text;
        width += c == ' '                                                                                        ? 0.28
                 : c == 'i' || c == 'j' || c == 'l' || c == '.' || c == ',' || c == ':' || c == '|' || c == '\'' ? 0.25
                 : c == 'm' || c == 'w' || c == 'M' || c == 'W' || c == '%'                                      ? 0.86
                 : c >= 'A' && c <= 'Z'                                                                          ? 0.70
                                                                                                                 : 0.56;
        text += bytes ? bytes : 1;
    }
    return TYPE_PX * width;
}

double plot_left(const struct plot_range *range, double tic)
{
    double widest = 0, first = ceil(range->from / tic), last = floor(range->to / tic);
    for (double k = first; k <= last && k < first + MOST_TICS; k++) {
        char text[32];
        (void)snprintf(text, sizeof text, "%g", fabs(k) < 0.5 ? 0 : k * tic);
        widest = fmax(widest, plot_width(text));
    }
    return NAME_PX + widest + TICK_PX;
}
