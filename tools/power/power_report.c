/* Tables of many cases. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "power.h"

#define MOST_ROWS 64
#define BINS      5
#define LARGE     (BINS - 1)

static const double bin_from[BINS] = {0, 10, 30, 60, 150};
static const char *const bin_name[BINS] = {"below 10", "10 to 30", "30 to 60", "60 to 150", "150 or more"};

enum { NAMED, HALF, IN_SET, NO_NAME, MISSED, WRONG, ENDS };

static const char heading[] = " cases   named in set no name missed  wrong";

struct row {
    enum hidden_class class;
    const char *id;
    int count, end[ENDS];
    struct power_share large; /* named, of those worth 150 or more */
};

/* How a case ends in these tables; no name: it is seen that something is wrong, and a set, if any, does not hold the truth. */
static int end_of(const struct hidden_score *s)
{
    static const int end[HIDDEN_OUTCOMES] = {
        [HIDDEN_RIGHT] = NAMED,         [HIDDEN_IN_SET] = IN_SET,     [HIDDEN_SILENT] = MISSED,
        [HIDDEN_UNEXPLAINED] = NO_NAME, [HIDDEN_OTHER_SET] = NO_NAME, [HIDDEN_WRONG] = WRONG};
    return s->class == HIDDEN_PAIR && s->outcome == HIDDEN_RIGHT && s->names < 2 ? HALF : end[s->outcome];
}

static int bin_of(double drop)
{
    int bin = 0;
    while (bin + 1 < BINS && drop >= bin_from[bin + 1])
        bin++;
    return bin;
}

static int is_counted(const struct power_result *r)
{
    return r->done && r->score.outcome != HIDDEN_FAILED;
}

static void show_ends(FILE *out, const char *name, int count, const int *end)
{
    fprintf(out, "  %-24s %6d %7d %6d %7d %6d %6d", name, count, end[NAMED] + end[HALF], end[IN_SET], end[NO_NAME], end[MISSED],
            end[WRONG]);
}

static void show_singles(FILE *out, int count, const struct power_result *result)
{
    fprintf(out, "\n%-26s%s\n", "one effect, worth a drop", heading);
    for (int b = 0; b < BINS; b++) {
        int cases = 0, end[ENDS] = {0};
        for (int i = 0; i < count; i++)
            if (is_counted(&result[i]) && result[i].score.class == HIDDEN_PHYSICAL && bin_of(result[i].score.drop) == b) {
                cases++;
                end[end_of(&result[i].score)]++;
            }
        show_ends(out, bin_name[b], cases, end);
        fprintf(out, "\n");
    }
}

static void show_pairs(FILE *out, int count, const struct power_result *result)
{
    fprintf(out, "\n%-26s cases    both    one in set no name missed  wrong\n", "two, the lesser worth");
    for (int b = 0; b < BINS; b++) {
        int cases = 0, end[ENDS] = {0};
        for (int i = 0; i < count; i++)
            if (is_counted(&result[i]) && result[i].score.class == HIDDEN_PAIR && bin_of(result[i].score.lesser) == b) {
                cases++;
                end[end_of(&result[i].score)]++;
            }
        fprintf(out, "  %-24s %6d %7d %6d %6d %7d %6d %6d\n", bin_name[b], cases, end[NAMED], end[HALF], end[IN_SET],
                end[NO_NAME], end[MISSED], end[WRONG]);
    }
}

static int order(const void *left, const void *right)
{
    const struct row *a = left, *b = right;
    return a->class != b->class ? (int)a->class - (int)b->class : strcmp(a->id, b->id);
}

/* Both members of a pair share one row. */
static const char *row_id(const struct hidden_score *s)
{
    return s->class == HIDDEN_PAIR ? "two effects" : s->id;
}

static int is_of_row(const struct power_result *r, const struct row *row)
{
    return is_counted(r) && r->score.class == row->class && !strcmp(row_id(&r->score), row->id);
}

static int collect(int count, const struct power_result *result, struct row row[MOST_ROWS])
{
    int rows = 0;
    for (int i = 0; i < count; i++) {
        const struct hidden_score *s = &result[i].score;
        int r = 0, end = end_of(s);
        if (!is_counted(&result[i]))
            continue;
        while (r < rows && !is_of_row(&result[i], &row[r]))
            r++;
        if (r == MOST_ROWS)
            continue;
        if (r == rows)
            row[rows++] = (struct row){.class = s->class, .id = row_id(s)};
        row[r].count++;
        row[r].end[end]++;
        if (bin_of(s->class == HIDDEN_PAIR ? s->lesser : s->drop) == LARGE) {
            row[r].large.count++;
            row[r].large.right += end == NAMED;
        }
    }
    qsort(row, (size_t)rows, sizeof *row, order);
    return rows;
}

/* The id that is named most often where it is not true. */
static const char *usual_mistake(int count, const struct power_result *result, const struct row *row)
{
    const char *best = "";
    int most = 0;
    for (int i = 0; i < count; i++) {
        int same = 0;
        for (int j = 0; j < count && is_of_row(&result[i], row); j++)
            same += is_of_row(&result[j], row) && *result[i].score.wrong && !strcmp(result[i].score.wrong, result[j].score.wrong);
        if (same > most) {
            most = same;
            best = result[i].score.wrong;
        }
    }
    return best;
}

static void show_kinds(FILE *out, int count, const struct power_result *result)
{
    struct row row[MOST_ROWS];
    int rows = collect(count, result, row);
    fprintf(out, "\n%-26s%s  of those worth 150\n", "hidden", heading);
    for (int r = 0; r < rows; r++) {
        if (!r || row[r].class != row[r - 1].class)
            fprintf(out, "%s\n", hidden_class_name(row[r].class));
        show_ends(out, row[r].id, row[r].count, row[r].end);
        fprintf(out, "  %3d of %-3d %s\n", row[r].large.right, row[r].large.count, usual_mistake(count, result, &row[r]));
    }
}

static int ascending(const void *left, const void *right)
{
    double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

static void show_quantiles(FILE *out, const char *what, int n, double *value)
{
    qsort(value, (size_t)n, sizeof *value, ascending);
    if (n)
        fprintf(out, "  %-32s median %6.2f %%   95 %% below %6.2f %%   (%d)\n", what, 100 * value[n / 2],
                100 * value[(int)(0.95 * (n - 1) + 0.5)], n);
}

static int show_errors(FILE *out, int count, const struct power_result *result)
{
    double *place = calloc((size_t)count, sizeof *place), *size = calloc((size_t)count, sizeof *size);
    int places = 0, sizes = 0, bad = !place || !size;
    for (int i = 0; i < count && !bad; i++) {
        if (!result[i].done)
            continue;
        if (isfinite(result[i].score.place_error))
            place[places++] = result[i].score.place_error;
        if (isfinite(result[i].score.size_error))
            size[sizes++] = result[i].score.size_error;
    }
    if (!bad) {
        fprintf(out, "\nwhere the name is right\n");
        show_quantiles(out, "error of the place, of the length", places, place);
        show_quantiles(out, "error of the size, of the size", sizes, size);
    }
    free(place);
    free(size);
    return bad;
}

static void show_coverage(FILE *out, int count, const struct power_result *result)
{
    struct {
        const char *name;
        struct power_share share;
    } kind[MOST_ROWS];
    int kinds = 0;
    fprintf(out, "\ncoverage of the 95 %% intervals\n");
    for (int i = 0; i < count; i++)
        for (int v = 0; result[i].done && v < result[i].score.nvalue; v++) {
            const struct hidden_value *value = &result[i].score.value[v];
            int k = 0;
            while (k < kinds && strcmp(kind[k].name, value->name) != 0)
                k++;
            if (k == MOST_ROWS)
                continue;
            if (k == kinds) {
                kind[kinds].name = value->name;
                kind[kinds++].share = (struct power_share){0, 0};
            }
            kind[k].share.count++;
            kind[k].share.right += hidden_covers(value);
        }
    for (int k = 0; k < kinds; k++) {
        double lower, upper;
        power_interval(kind[k].share, &lower, &upper);
        fprintf(out, "  %-32s %4d of %-4d  %5.1f %%  (%.0f to %.0f)\n", kind[k].name, kind[k].share.right, kind[k].share.count,
                100.0 * kind[k].share.right / kind[k].share.count, 100 * lower, 100 * upper);
    }
}

/* Of the averages over the explanations: their intervals beside those of the model with what is there and nothing else. */
static void show_widths(FILE *out, int count, const struct power_result *result)
{
    double *ratio = malloc(((size_t)count * HIDDEN_VALUES + 1) * sizeof *ratio);
    int n = 0;
    for (int i = 0; i < count && ratio; i++)
        for (int v = 0; result[i].done && v < result[i].score.nvalue; v++) {
            const struct hidden_value *value = &result[i].score.value[v];
            if (value->of == HIDDEN_OF_MIXTURE && value->known > 0)
                ratio[n++] = (value->upper - value->lower) / (2 * value->known);
        }
    if (n) {
        qsort(ratio, (size_t)n, sizeof *ratio, ascending);
        fprintf(out, "width of averaged intervals over that with the true causes known: median %.2f, nine in ten below %.2f\n",
                ratio[n / 2], ratio[n * 9 / 10]);
    }
    free(ratio);
}

static void show_mistakes(FILE *out, int count, const struct power_result *result)
{
    double seconds = 0, longest = 0;
    int done = 0;
    fprintf(out, "\nwrong names, false alarms, and errors\n");
    for (int i = 0; i < count; i++) {
        const struct hidden_score *s = &result[i].score;
        if (!result[i].done)
            continue;
        done++;
        seconds += s->seconds;
        longest = fmax(longest, s->seconds);
        if (s->outcome == HIDDEN_WRONG || s->outcome == HIDDEN_FAILED || (s->class == HIDDEN_NOTHING && s->reported))
            fprintf(out, "  %s: %s -> %s%s (drop %.3g, margin %.3g)\n", result[i].again, s->id,
                    *s->wrong || *s->failure ? s->wrong : hidden_outcome_name(s->outcome), s->failure, s->drop, s->margin);
    }
    if (done)
        fprintf(out, "\n%.2f s a case, the longest %.2f s\n", seconds / done, longest);
}

int power_report(FILE *out, int count, const struct power_result *result)
{
    int bad;
    show_singles(out, count, result);
    show_pairs(out, count, result);
    show_kinds(out, count, result);
    show_coverage(out, count, result);
    show_widths(out, count, result);
    bad = show_errors(out, count, result);
    show_mistakes(out, count, result);
    return power_requirements(out, count, result) || bad;
}
