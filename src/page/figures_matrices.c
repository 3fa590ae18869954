/* Which measured shape looks like which of the model, and how the parameters depend on each other. */
#include <math.h>

#include "page/figures.h"
#include "page/human.h"
#include "page/matrix.h"

#define MOST_SIDE 40 /* rows and columns that are drawn: beyond that nobody can read a cell */

static const char **numbers_as_text(struct pool *pool, int count, const int *number)
{
    const char **text = POOL_ARRAY(pool, const char *, count);
    for (int i = 0; i < count && text; i++)
        text[i] = human_fixed(pool, number[i], 0);
    return text;
}

/* Columns of the cells that belong together: measured mode of a row with the mode of the model it is paired with. */
static int *pairs(struct pool *pool, const rotid_identification *fit)
{
    int rows = fit->nmatrix_rows, columns = fit->nmatrix_columns;
    int *column = POOL_ARRAY(pool, int, rows);
    for (int i = 0; i < rows && column; i++) {
        column[i] = -1;
        for (int j = 0; j < columns && i < fit->nmodes; j++)
            if (fit->matrix_columns[j] == fit->modes[i].mode)
                column[i] = j;
    }
    return column;
}

struct extremes { /* of the pairs, and of what is no pair */
    double least, most, other;
    int row, column; /* of the latter, -1: none */
};

static struct extremes judge(const rotid_identification *fit, const double *matrix, const int *mark)
{
    struct extremes e = {INFINITY, -INFINITY, -INFINITY, -1, -1};
    for (int i = 0; i < fit->nmatrix_rows; i++)
        for (int j = 0; j < fit->nmatrix_columns; j++) {
            double value = matrix[i + (ptrdiff_t)j * fit->nmatrix_rows];
            if (!isfinite(value))
                continue;
            if (mark[i] == j) {
                e.least = fmin(e.least, value);
                e.most = fmax(e.most, value);
            } else if (value > e.other) {
                e.other = value;
                e.row = i;
                e.column = j;
            }
        }
    return e;
}

static const char *sentence(struct pool *pool, const char *name, const rotid_identification *fit, const double *matrix,
                            const int *mark)
{
    struct extremes e = judge(fit, matrix, mark);
    if (!isfinite(e.least))
        return "";
    const char *other = e.row < 0
                            ? ""
                            : pool_format(pool, "; of all others the largest is %s, measured mode %d with mode %d of the model",
                                          human_fixed(pool, e.other, 2), fit->matrix_rows[e.row], fit->matrix_columns[e.column]);
    const char *text = pool_format(pool, "%s of the pairs (framed) lies between %s and %s%s. ", name,
                                   human_fixed(pool, e.least, 2), human_fixed(pool, e.most, 2), other ? other : "");
    return text ? text : "";
}

void figure_matrices(struct document *document, const struct result *result, const rotid_identification *fit)
{
    struct pool *pool = document->pool;
    const double *const matrix[2] = {fit->nco_matrix, fit->mac_matrix};
    static const char *const title[] = {"NCO", "MAC"};
    static const char *const full[] = {"NCO, weighed with the mass", "MAC, without the mass"};
    struct matrix_panel panel[MATRIX_MOST];
    const char *says = "";
    int count = 0, rows = fit->nmatrix_rows, columns = fit->nmatrix_columns;
    if (rows > MOST_SIDE || columns > MOST_SIDE || !rows || !columns || !fit->matrix_rows || !fit->matrix_columns)
        return;
    int *mark = pairs(pool, fit);
    const char **row = numbers_as_text(pool, rows, fit->matrix_rows),
               **column = numbers_as_text(pool, columns, fit->matrix_columns);
    if (!mark || !row || !column) {
        document->failed = 1;
        return;
    }
    for (int i = 0; i < 2 && says; i++) {
        if (!matrix[i])
            continue;
        panel[count++] = (struct matrix_panel){.title = full[i],
                                               .row_axis = "measured mode [1]",
                                               .column_axis = "mode of the model [1]",
                                               .rows = rows,
                                               .columns = columns,
                                               .value = matrix[i],
                                               .row = row,
                                               .column = column,
                                               .mark = mark};
        says = pool_format(pool, "%s%s", says, sentence(pool, title[i], fit, matrix[i], mark));
    }
    if (!count)
        return;
    struct figure *figure = document_figure(document, "correlation-of-shapes", "Each measured shape beside each of the model");
    figure->caption = pool_format(pool, "%s1 is the same shape, 0 a shape that has nothing in common.", says ? says : "");
    figure->alt = pool_format(pool, "%d fields of %d by %d cells, dark where a measured shape is like one of the model.", count,
                              panel[0].rows, panel[0].columns);
    matrix_figure(document, figure, result->file, count, panel);
}

void figure_correlation(struct document *document, const struct result *result, const rotid_identification *fit)
{
    struct pool *pool = document->pool;
    int n = fit->nparameters, first = -1, second = -1;
    if (n < 3 || n > MOST_SIDE || !fit->correlation)
        return; /* of two the caption of the intervals tells it */
    const char **name = POOL_ARRAY(pool, const char *, n);
    if (!name) {
        document->failed = 1;
        return;
    }
    for (int i = 0; i < n; i++) {
        name[i] = fit->parameters[i].name;
        for (int j = 0; j < i; j++)
            if (isfinite(fit->correlation[i + (ptrdiff_t)j * n]) &&
                (first < 0 ||
                 fabs(fit->correlation[i + (ptrdiff_t)j * n]) > fabs(fit->correlation[first + (ptrdiff_t)second * n]))) {
                first = i;
                second = j;
            }
    }
    if (first < 0)
        return; /* none can be stated */
    struct figure *figure = document_figure(document, "correlation-of-parameters", "How the parameters depend on each other");
    const struct matrix_panel panel = {.title = "correlation",
                                       .row_axis = NULL,
                                       .column_axis = NULL,
                                       .rows = n,
                                       .columns = n,
                                       .value = fit->correlation,
                                       .row = name,
                                       .column = name};
    figure->caption =
        pool_format(pool,
                    "Strongest between %s and %s, %s. Close to 1 or \xe2\x88\x92"
                    "1 the data determine a combination of the two "
                    "rather than each (condition number %s).",
                    name[first], name[second], human_fixed(pool, fit->correlation[first + (ptrdiff_t)second * n], 2),
                    human_digits(pool, fit->condition_number, 3));
    figure->alt = pool_format(pool, "A field of %d by %d cells, dark where two parameters depend on each other.", n, n);
    matrix_figure(document, figure, result->file, 1, &panel);
}
