#include "export/export.h"

#include <stdlib.h>
#include <string.h>

#define LINE_WIDTH 72 /* Nastran reads comments as far as column 80 */

double dmig_number(double value, char *text)
{
    char number[32];
    for (int digits = 12; digits > 0; digits--) {
        (void)snprintf(number, sizeof number, "%.*E", digits, value);
        char *exponent = strchr(number, 'E');
        long power = exponent ? strtol(exponent + 1, NULL, 10) : 0;
        if (exponent && exponent - number + snprintf(NULL, 0, "D%+ld", power) <= 16) {
            (void)snprintf(text, 17, "%.*sD%+ld", (int)(exponent - number), number, power);
            break;
        }
    }
    return strtod(number, NULL);
}

/* Either kind of matrix: entry (row, column) of `full`, or of `dense` with n rows, in the order of the lower triangle. */
struct source {
    const rotid_matrix *full;
    const double *dense;
    int n;
};

static int next_entry(const struct source *source, struct triplet *t)
{
    if (source->full)
        return triplet_next(source->full, t);
    while (t->column < source->n) {
        t->row = t->row < t->column ? t->column : t->row + 1;
        if (t->row >= source->n) {
            t->column++;
            t->row = -1;
            continue;
        }
        t->value = source->dense[t->row + (ptrdiff_t)t->column * source->n];
        if (t->value != 0)
            return 1;
    }
    return 0;
}

struct writer {
    FILE *stream;
    const struct export_model *model;
    struct source source;
};

/* Its GRID, its component, and the sign of the rotation there: 1 for v, -1 for theta. */
static int grid_of(const struct writer *w, int dof, int *component, int *sign)
{
    int rotation = w->source.full && dof % 2;
    *component = rotation ? 5 : 1;
    *sign = rotation ? -1 : 1;
    return w->source.full ? dof / 2 + 1 : export_master_id(w->model, dof);
}

/* The number that goes into the main matrix, or into the remainder; 0 where there is none to write. */
static int split(double value, int remainder, char *text)
{
    double main = dmig_number(value, text);
    if (remainder && value - main != 0)
        (void)dmig_number(value - main, text);
    return !remainder || value - main != 0;
}

static long count_remainders(const struct source *source)
{
    char text[17];
    long count = 0;
    for (struct triplet t = {.row = -1}; next_entry(source, &t);)
        count += split(t.value, 1, text);
    return count;
}

/* Header and columns of one matrix. */
static void put_matrix(const struct writer *w, const char *name, int remainder)
{
    char text[17];
    int column = -1, row_component, row_sign, column_component, column_sign;
    (void)fprintf(w->stream, "DMIG    %-8s%8d%8d%8d%8d\n", name, 0, 6, 2, 0);
    for (struct triplet t = {.row = -1}; next_entry(&w->source, &t);) {
        int row = grid_of(w, t.row, &row_component, &row_sign), grid = grid_of(w, t.column, &column_component, &column_sign);
        if (!split(row_sign * column_sign * t.value, remainder, text))
            continue;
        if (t.column != column)
            (void)fprintf(w->stream, "DMIG*   %-16s%16d%16d\n", name, grid, column_component);
        (void)fprintf(w->stream, "*       %16d%16d%16s\n", row, row_component, text);
        column = t.column;
    }
}

static void put_grid(FILE *stream, int id, double z)
{
    char text[32];
    for (int decimals = 14; decimals > 0 && snprintf(text, sizeof text, "%.*f", decimals, z) > 16;)
        decimals--;
    (void)fprintf(stream, "GRID*   %16d%16s%16s%16s\n*       %16s\n", id, "", "0.0", "0.0", text);
}

static void put_case(FILE *stream, const struct export_model *model, const char *const *name, const int *remainder)
{
    int modes = model->spectrum.nrigid + model->spectrum.count;
    (void)fputs("SOL 103\nCEND\nTITLE = BENDING OF A ROTOR IN ONE PLANE, FROM ROTID\nECHO = NONE\nMETHOD = 1\nSPC = 1\n", stream);
    (void)fprintf(stream, "K2GG = %s%s%s\n", name[0], remainder[0] ? ", " : "", remainder[0] ? name[1] : "");
    (void)fprintf(stream, "M2GG = %s%s%s\n", name[2], remainder[1] ? ", " : "", remainder[1] ? name[3] : "");
    (void)fprintf(stream, "DISPLACEMENT = ALL\nBEGIN BULK\nEIGRL   %8d%8s%8s%8d\n", 1, "", "", modes);
}

static void put_remarks(FILE *stream, const struct export_model *model, int condensed)
{
    struct remark remark = {stream, "$ ", LINE_WIDTH};
    remark_model(&remark, model);
    if (condensed)
        remark_condensed(&remark, model);
    remark_put(&remark, "%s", "");
    remark_put(&remark, "One bending plane, x-z: T1 = v%s; all else is held.", condensed ? "" : ", R2 = dv/dz = -theta of rotid");
    remark_put(&remark, "%s",
               condensed ? "A GRID is a sensor and has its id; without sensors it is a node of the axis, from 1."
                         : "GRID i is node i: first those of the axis, then inner nodes of rods and bars.");
    remark_put(&remark, "%s",
               "Sixteen columns hold 10 to 12 digits: the matrices that end in R hold the rest, and the sum of both is "
               "the matrix of rotid to the last bit. A program that takes one name after K2GG only must not run this.");
}

static int write_deck(struct writer *w, const char *const *name, const struct source *mass)
{
    FILE *stream = w->stream;
    const struct export_model *model = w->model;
    const struct source stiffness = w->source;
    const int remainder[2] = {count_remainders(&stiffness) > 0, count_remainders(mass) > 0};
    int condensed = !stiffness.full, count = condensed ? stiffness.n : model->nnode;
    put_remarks(stream, model, condensed);
    put_case(stream, model, name, remainder);
    for (int i = 0; i < count; i++)
        put_grid(stream, condensed ? export_master_id(model, i) : i + 1,
                 condensed ? export_master_z(model, i) : model->node[i].z);
    if (!condensed)
        (void)fprintf(stream, "SPC1    %8d%8d%8d%8s%8d\n", 1, 2346, 1, "THRU", count);
    for (int i = 0; i < count && condensed; i++)
        (void)fprintf(stream, "SPC1    %8d%8d%8d\n", 1, 23456, export_master_id(model, i));
    put_matrix(w, name[0], 0);
    if (remainder[0])
        put_matrix(w, name[1], 1);
    w->source = *mass;
    put_matrix(w, name[2], 0);
    if (remainder[1])
        put_matrix(w, name[3], 1);
    (void)fputs("ENDDATA\n", stream);
    return ROTID_OK;
}

int dmig_full(FILE *stream, const struct export_model *model)
{
    static const char *const name[] = {"KFULL", "KFULLR", "MFULL", "MFULLR"};
    const struct source mass = {.full = &model->m};
    struct writer w = {stream, model, {.full = &model->k}};
    return write_deck(&w, name, &mass);
}

int dmig_condensed(FILE *stream, const struct export_model *model)
{
    static const char *const name[] = {"KRED", "KREDR", "MRED", "MREDR"};
    const struct source mass = {.dense = model->condensed.m, .n = model->condensed.count};
    struct writer w = {stream, model, {.dense = model->condensed.k, .n = model->condensed.count}};
    return write_deck(&w, name, &mass);
}
