#include "uff/uff_modes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int uff_is_mode(const struct uff_shape *shape)
{
    return shape->analysis_type != 5; /* 5 is a frequency response: an operating shape */
}

static int compare_shapes(const void *left, const void *right)
{
    const struct uff_shape *const *a = left, *const *b = right;
    return ((*a)->frequency_hz > (*b)->frequency_hz) - ((*a)->frequency_hz < (*b)->frequency_hz);
}

/* A complex eigenvalue comes with its conjugate; two real modes of one frequency are two modes. */
static int is_conjugate(const struct uff_shape *a, const struct uff_shape *b)
{
    return a->is_complex && b->is_complex && fabs(a->frequency_hz - b->frequency_hz) <= 1e-9 * a->frequency_hz;
}

int uff_choose_modes(const struct uff_file *file, const struct uff_shape **chosen, int *rigid, int *conjugates)
{
    int count = 0, kept = 0;
    *rigid = 0;
    for (int k = 0; k < file->shape_count; k++) {
        if (uff_is_mode(&file->shape[k]) && file->shape[k].frequency_hz > 0)
            chosen[count++] = &file->shape[k];
        else
            *rigid += uff_is_mode(&file->shape[k]);
    }
    if (count)
        qsort(chosen, (size_t)count, sizeof *chosen, compare_shapes);
    for (int k = 0; k < count; k++)
        if (!kept || !is_conjugate(chosen[k], chosen[kept - 1]))
            chosen[kept++] = chosen[k];
    *conjugates = count - kept;
    return kept;
}

int uff_modes_are_numbered(int count, const struct uff_shape *const *chosen)
{
    for (int k = 0; k < count; k++)
        if (chosen[k]->number <= 0 || (k && chosen[k]->number <= chosen[k - 1]->number))
            return 0;
    return 1;
}

double uff_mode_frequency(const struct uff_shape *mode)
{
    double hz;
    for (int i = 0; i < UFF_ID_LINES; i++)
        if (sscanf(mode->id[i], "ROTID FREQUENCY_HZ %lf", &hz) == 1 && fabs(hz - mode->frequency_hz) < 1e-5 * mode->frequency_hz)
            return hz;
    return mode->frequency_hz;
}

double uff_real_shape(const struct uff_shape *mode, int component, double *value)
{
    int n = mode->node_count, step = mode->component_count;
    double xx = 0, yy = 0, xy = 0, left = 0;
    for (int i = 0; i < n; i++) {
        double x = mode->real[i * step + component], y = mode->imag ? mode->imag[i * step + component] : 0;
        xx += x * x;
        yy += y * y;
        xy += x * y;
    }
    double turn = mode->imag ? -0.5 * atan2(2 * xy, xx - yy) : 0;
    for (int i = 0; i < n; i++) {
        double x = mode->real[i * step + component], y = mode->imag ? mode->imag[i * step + component] : 0;
        value[i] = mode->imag ? x * cos(turn) - y * sin(turn) : x;
        left += mode->imag ? pow(x * sin(turn) + y * cos(turn), 2) : 0;
    }
    return xx + yy > 0 ? left / (xx + yy) : 0;
}

enum uff_extra uff_extra_of(const struct uff_shape *set, int *number)
{
    static const char *const title[UFF_EXTRAS] = {[UFF_EXTRA_SHAPE_STD] = "ROTID STANDARD DEVIATION OF MODE ",
                                                  [UFF_EXTRA_POINT] = "ROTID FREQUENCY AT POINT OF MODE ",
                                                  [UFF_EXTRA_POINT_STD] =
                                                      "ROTID STANDARD DEVIATION OF FREQUENCY AT POINT OF MODE "};
    enum uff_extra kind = 0;
    while (kind < UFF_EXTRAS && strncmp(set->id[0], title[kind], strlen(title[kind])) != 0)
        kind++;
    const char *rest = kind < UFF_EXTRAS ? set->id[0] + strlen(title[kind]) : "";
    char *end;
    long of = strtol(rest, &end, 10); /* the end of the text is one whole number above zero */
    *number = end != rest && !*end && of > 0 && of <= 1000000 ? (int)of : 0;
    return kind;
}

int uff_extra_frequency_std(const struct uff_shape *set, double *hz)
{
    double damping; /* nothing needs its deviation yet, but it has to be one */
    int length = 0;
    return sscanf(set->id[1], "FREQUENCY_HZ %lf DAMPING %lf%n", hz, &damping, &length) != 2 || set->id[1][length] ||
           !(isfinite(*hz) && *hz >= 0 && isfinite(damping) && damping >= 0);
}
