#include "ema/zoom.h"
#include "ema/poles.h"

#include <math.h>
#include <stdlib.h>

#define LEAST_LINES 150
#define MOST_LINES  5000
#define MOST_PARTS  20
#define PART_ORDER  60

struct part {
    struct stabilisation table;
    int count;
    double complex *candidate;
    double low, high; /* rad/s, what counts */
};

static int compute_part(struct pool *pool, const struct ema_band *band, int order, double decay,
                        const struct ema_options *options, struct part *part)
{
    int status = stabilisation_compute(pool, band, order, decay, options->frequency_tolerance, options->damping_tolerance,
                                       options->threads, &part->table);
    if (status != ROTID_OK)
        return status;
    status = stabilisation_candidates(pool, &part->table, options->frequency_tolerance, options->damping_tolerance, &part->count,
                                      &part->candidate);
    if (status != ROTID_OK)
        return status;
    int kept = 0;
    for (int k = 0; k < part->count; k++)
        if (cimag(part->candidate[k]) >= part->low && cimag(part->candidate[k]) <= part->high)
            part->candidate[kept++] = part->candidate[k];
    part->count = kept;
    return ROTID_OK;
}

/* The poles of all parts, order by order. */
static int merge_tables(struct pool *pool, int nparts, const struct part *part, struct stabilisation *table)
{
    size_t all = 0;
    for (int i = 0; i < nparts; i++)
        all += (size_t)part[i].table.npole;
    *table = (struct stabilisation){.norder = part[0].table.norder, .step = part[0].table.step, .order = part[0].table.order};
    table->first = POOL_ARRAY(pool, int, table->norder + 1);
    table->pole = POOL_ARRAY(pool, double complex, all);
    table->table = POOL_ARRAY(pool, struct ema_pole, all);
    if (!table->first || !table->pole || !table->table)
        return ROTID_ERROR_MEMORY;
    for (int o = 0; o < table->norder; o++) {
        /* parts stand in rising frequency, the whole band comes first: it is merged in on the way */
        int next = table->npole, whole = part[0].table.first[o], end = part[0].table.first[o + 1];
        for (int i = 1; i <= nparts; i++) {
            const struct stabilisation *from = &part[i < nparts ? i : 0].table;
            for (int k = i < nparts && o < from->norder ? from->first[o] : 0;
                 i < nparts && o < from->norder && k < from->first[o + 1]; k++) {
                double at = cimag(from->pole[k]);
                if (at < part[i].low || at > part[i].high)
                    continue;
                for (; whole < end && cimag(part[0].table.pole[whole]) < at; whole++, next++) {
                    table->pole[next] = part[0].table.pole[whole];
                    table->table[next] = part[0].table.table[whole];
                }
                table->pole[next] = from->pole[k];
                table->table[next] = from->table[k];
                table->table[next++].part = i;
            }
        }
        for (; whole < end; whole++, next++) {
            table->pole[next] = part[0].table.pole[whole];
            table->table[next] = part[0].table.table[whole];
        }
        table->npole = next;
        table->first[o + 1] = next;
    }
    return ROTID_OK;
}

/* A candidate that another part has already: within a half-power bandwidth. */
static int is_known(int count, const double complex *known, double complex pole)
{
    for (int k = 0; k < count; k++)
        if (cabs(known[k] - pole) < 2 * fmax(fabs(creal(pole)), fabs(creal(known[k]))))
            return 1;
    return 0;
}

/* First lines of the parts, falling; the last one is 0. edge [MOST_PARTS + 1], edge[0] = nline. Returns their number. */
static int split(const struct ema_band *band, int *edge)
{
    int parts = 0, end = band->nline;
    edge[0] = end;
    while (parts < MOST_PARTS && end > 0) {
        int first = ema_band_line(band, band->omega[end - 1] / 2);
        first = end - first > MOST_LINES ? end - MOST_LINES : first;
        /* what is too short for a part of its own goes with its neighbour */
        if (end - first < LEAST_LINES)
            first = end - LEAST_LINES;
        if (first < LEAST_LINES || parts + 1 == MOST_PARTS)
            first = 0;
        end = edge[++parts] = first;
    }
    return parts;
}

int zoom_compute(struct pool *pool, const struct ema_band *band, double decay, const struct ema_options *options,
                 struct stabilisation *table, int *count, double complex **candidate)
{
    int edge[MOST_PARTS + 1], parts = split(band, edge), nparts = parts > 1 ? parts + 1 : 1;
    struct part *part = POOL_ARRAY(pool, struct part, nparts);
    if (!part)
        return ROTID_ERROR_MEMORY;
    part[0].low = band->low;
    part[0].high = band->high;
    int status = compute_part(pool, band, options->order, decay, options, &part[0]), all = part[0].count;
    for (int i = 1; status == ROTID_OK && i < nparts; i++) {
        struct ema_band zoomed;
        int first = edge[parts - i + 1], last = edge[parts - i] - 1, length = last - first + 1;
        double margin = (band->omega[last] - band->omega[first]) / 50;
        part[i].low = band->omega[first] - margin;
        part[i].high = band->omega[last] + margin;
        first = first - length / 10 > 0 ? first - length / 10 : 0;
        last = last + length / 10 < band->nline ? last + length / 10 : band->nline - 1;
        struct pool scratch; /* the copy of the part is the largest thing of all, and no longer wanted afterwards */
        pool_open(&scratch, pool->allocator);
        status = ema_band_part(&scratch, band, first, last - first + 1, &zoomed);
        if (status == ROTID_OK)
            status =
                compute_part(pool, &zoomed, options->order < PART_ORDER ? options->order : PART_ORDER, decay, options, &part[i]);
        pool_close(&scratch);
        all += part[i].count;
    }
    if (status != ROTID_OK)
        return status;
    *count = 0;
    *candidate = POOL_ARRAY(pool, double complex, all);
    if (!*candidate)
        return ROTID_ERROR_MEMORY;
    /* the parts know better than the whole, which comes last; within one part two poles are two */
    for (int i = 1; i <= nparts; i++) {
        const struct part *from = &part[i < nparts ? i : 0];
        int before = *count;
        for (int k = 0; k < from->count; k++)
            if (!is_known(before, *candidate, from->candidate[k]))
                (*candidate)[(*count)++] = from->candidate[k];
    }
    sort_poles((size_t)*count, *candidate);
    return merge_tables(pool, nparts, part, table);
}
