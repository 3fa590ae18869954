#include "page/by_modes.h"

#include <math.h>
#include <string.h>

static struct modes_point point_of(const struct study_outcome *study, int cell)
{
    struct modes_point point = {.cell = cell};
    double sum = 0;
    int count = 0;
    for (int i = 0; i < study->nrun; i++) {
        const struct told_run *run = &study->run[i];
        if (run->cell != cell || run->status > STUDY_AT_BOUND || !isfinite(run->objective))
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
    for (int i = 0; i < study->is.ncells; i++) {
        int s = 0;
        struct modes_point point = study->cell[i].is.cell.modes ? point_of(study, i) : (struct modes_point){.fitted = 0};
        if (!point.fitted)
            continue;
        while (s < by->nseries &&
               !study_same_but_modes(&study->cell[by->series[s].point[0].cell].is.cell, &study->cell[i].is.cell))
            s++;
        if (s == BY_MODES_SERIES) {
            by->more++;
            continue;
        }
        struct modes_series *series = &by->series[s];
        if (s == by->nseries) {
            *series = (struct modes_series){study->cell[i].but_modes, 0, POOL_ARRAY(pool, struct modes_point, study->is.ncells)};
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
