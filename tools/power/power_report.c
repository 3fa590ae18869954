/* Tables of many cases. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "power.h"

#define MOST_ROWS 64
#define BINS      5

static const double bin_from[BINS] = {0, 5, 15, 30, 60};
static const char *const bin_name[BINS] = {"< 5", "5-15", "15-30", "30-60", "> 60"};

struct row {
    enum hidden_class class;
    const char *id;
    int count, outcome[HIDDEN_OUTCOMES];
    struct power_share reported[BINS];
};

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

static int collect(int count, const struct power_result *result, struct row row[MOST_ROWS])
{
    int rows = 0;
    for (int i = 0; i < count; i++) {
        const struct hidden_score *s = &result[i].score;
        int r = 0, bin = 0;
        if (!result[i].done || s->outcome == HIDDEN_FAILED)
            continue;
        while (r < rows && (strcmp(row[r].id, row_id(s)) != 0 || row[r].class != s->class))
            r++;
        if (r == MOST_ROWS)
            continue;
        if (r == rows)
            row[rows++] = (struct row){.class = s->class, .id = row_id(s)};
        row[r].count++;
        row[r].outcome[s->outcome]++;
        while (bin + 1 < BINS && s->drop >= bin_from[bin + 1])
            bin++;
        if (isfinite(s->drop)) {
            row[r].reported[bin].count++;
            row[r].reported[bin].right += s->reported || (s->class == HIDDEN_DATA && s->outcome == HIDDEN_RIGHT);
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
        const struct hidden_score *s = &result[i].score;
        int same = 0;
        if (!result[i].done || s->outcome != HIDDEN_WRONG || s->class != row->class || strcmp(row_id(s), row->id) != 0)
            continue;
        for (int j = 0; j < count; j++) {
            const struct hidden_score *t = &result[j].score;
            same += result[j].done && t->outcome == HIDDEN_WRONG && t->class == row->class && !strcmp(row_id(t), row->id) &&
                    !strcmp(t->wrong, s->wrong);
        }
        if (same > most) {
            most = same;
            best = s->wrong;
        }
    }
    return best;
}

static void show_confusion(FILE *out, int count, const struct power_result *result, int rows, const struct row *row)
{
    static const char *const class_name[] = {"nothing", "one effect", "two effects", "data", "noise stated wrongly", "outside"};
    fprintf(out, "\n%-22s %6s %6s %6s %6s %11s %9s %6s\n", "hidden", "cases", "right", "in set", "silent", "unexplained",
            "other set", "wrong");
    for (int r = 0; r < rows; r++) {
        if (!r || row[r].class != row[r - 1].class)
            fprintf(out, "%s\n", class_name[row[r].class]);
        fprintf(out, "  %-20s %6d %6d %6d %6d %11d %9d %6d %s\n", row[r].id, row[r].count, row[r].outcome[HIDDEN_RIGHT],
                row[r].outcome[HIDDEN_IN_SET], row[r].outcome[HIDDEN_SILENT], row[r].outcome[HIDDEN_UNEXPLAINED],
                row[r].outcome[HIDDEN_OTHER_SET], row[r].outcome[HIDDEN_WRONG], usual_mistake(count, result, &row[r]));
    }
}

static void show_detection(FILE *out, int rows, const struct row *row)
{
    fprintf(out, "\nshare reported, by the chi2 drop that the effect is worth\n%-22s", "");
    for (int b = 0; b < BINS; b++)
        fprintf(out, " %13s", bin_name[b]);
    fprintf(out, "\n");
    for (int r = 0; r < rows; r++) {
        fprintf(out, "  %-20s", row[r].id);
        for (int b = 0; b < BINS; b++)
            if (row[r].reported[b].count)
                fprintf(out, " %5d of %-5d", row[r].reported[b].right, row[r].reported[b].count);
            else
                fprintf(out, " %13s", "-");
        fprintf(out, "\n");
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
        fprintf(out, "  %-44s median %6.2f %%   95 %% below %6.2f %%   (%d)\n", what, 100 * value[n / 2],
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
    static struct { /* the report is made once, in one thread */
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
            if (k == kinds)
                kind[kinds++].name = value->name;
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

static void show_mistakes(FILE *out, int count, const struct power_result *result)
{
    double seconds = 0, longest = 0;
    int done = 0;
    fprintf(out, "\nwrong names, and cases without a diagnosis\n");
    for (int i = 0; i < count; i++) {
        const struct hidden_score *s = &result[i].score;
        if (!result[i].done)
            continue;
        done++;
        seconds += s->seconds;
        longest = fmax(longest, s->seconds);
        if (s->outcome == HIDDEN_WRONG || s->outcome == HIDDEN_FAILED)
            fprintf(out, "  case %d, seed %llu, %s: %s -> %s%s (drop %.3g, margin %.3g)\n", result[i].number,
                    (unsigned long long)result[i].seed, result[i].deck, s->id, s->wrong, s->failure, s->drop, s->margin);
    }
    if (done)
        fprintf(out, "\n%.2f s a case, the longest %.2f s\n", seconds / done, longest);
}

int power_report(FILE *out, int count, const struct power_result *result)
{
    struct row row[MOST_ROWS];
    int rows = collect(count, result, row), bad;
    show_confusion(out, count, result, rows, row);
    show_detection(out, rows, row);
    show_coverage(out, count, result);
    bad = show_errors(out, count, result);
    show_mistakes(out, count, result);
    return power_requirements(out, count, result) || bad;
}
