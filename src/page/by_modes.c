#include "page/by_modes.h"

#include <math.h>
#include <string.h>

/* Cells that differ in the modes alone. */
static int same_but_modes(const struct told_cell *a, const struct told_cell *b)
{
    return axis_same_text(a->deck, b->deck) && axis_same_text(a->variant, b->variant) && axis_same_text(a->sensors, b->sensors) &&
           axis_same_text(a->hide, b->hide) && axis_same_number(a->noise_frequency, b->noise_frequency) &&
           axis_same_number(a->noise_shape, b->noise_shape);
}

static struct modes_point point_of(const struct study_outcome *study, int cell)
{
    struct modes_point point = {.cell = cell};
    double sum = 0;
    int count = 0;
    for (int i = 0; i < study->nrun; i++) {
        const struct told_run *run = &study->run[i];
        if (run->cell != cell || run->status > TOLD_AT_BOUND || !isfinite(run->objective))
            continue;
        point.fitted = run->fitted > point.fitted ? run->fitted : point.fitted;
        sum += run->objective;
        count++;
    }
    point.functional = count && point.fitted ? sum / count / ((double)point.fitted * point.fitted) : (double)NAN;
    return point;
}

static void insert(struct modes_series *series, struct modes_point point)
{
    int k = series->count++;
    for (; k > 0 && series->point[k - 1].fitted > point.fitted; k--)
        series->point[k] = series->point[k - 1];
    series->point[k] = point;
}

int by_modes_make(struct pool *pool, const struct study_outcome *study, struct by_modes *by)
{
    *by = (struct by_modes){0};
    for (int i = 0; i < study->ncell; i++) {
        int s = 0;
        struct modes_point point = study->cell[i].modes ? point_of(study, i) : (struct modes_point){.fitted = 0};
        if (!point.fitted)
            continue;
        while (s < by->nseries && !same_but_modes(&study->cell[by->series[s].point[0].cell], &study->cell[i]))
            s++;
        if (s == BY_MODES_SERIES) {
            by->more++;
            continue;
        }
        struct modes_series *series = &by->series[s];
        if (s == by->nseries) {
            *series = (struct modes_series){study->cell[i].but_modes, 0, POOL_ARRAY(pool, struct modes_point, study->ncell)};
            by->nseries++;
        }
        if (!series->point)
            return ROTID_ERROR_MEMORY;
        insert(series, point);
    }
    int longest = 0;
    for (int s = 0; s < by->nseries; s++)
        longest = by->series[s].count > longest ? by->series[s].count : longest;
    if (longest < 2) /* nothing to draw over the number of modes */
        by->nseries = 0;
    return ROTID_OK;
}
