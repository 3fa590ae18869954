/* Which measured shape looks like which of the model, and how the parameters depend on each other. */
#include <math.h>

#include "page/figures.h"
#include "page/human.h"
#include "page/matrix.h"

#define MOST_SIDE 40 /* rows and columns that are drawn: beyond that nobody can read a cell */

static const char **numbers_as_text(struct pool *pool, int count, const double *number)
{
    const char **text = POOL_ARRAY(pool, const char *, count);
    for (int i = 0; i < count && text; i++)
        text[i] = human_fixed(pool, number[i], 0);
    return text;
}

/* Columns of the cells that belong together: measured mode of a row with the mode of the model it is paired with. */
static int *pairs(struct pool *pool, const struct fitted *fit, int rows, int columns)
{
    int *column = POOL_ARRAY(pool, int, rows);
    for (int i = 0; i < rows && column; i++) {
        column[i] = -1;
        for (int j = 0; j < columns && i < fit->nmode; j++)
            if (fit->matrix_column[j] == fit->mode[i].mode)
                column[i] = j;
    }
    return column;
}

struct extremes { /* of the pairs, and of what is no pair */
    double least, most, other;
    int row, column; /* of the latter, -1: none */
};

static struct extremes judge(const struct fitted_matrix *matrix, const int *mark)
{
    struct extremes e = {INFINITY, -INFINITY, -INFINITY, -1, -1};
    for (int i = 0; i < matrix->rows; i++)
        for (int j = 0; j < matrix->columns; j++) {
            double value = matrix->value[i + (ptrdiff_t)j * matrix->rows];
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

static const char *sentence(struct pool *pool, const char *name, const struct fitted_matrix *matrix, const struct fitted *fit,
                            const int *mark)
{
    struct extremes e = judge(matrix, mark);
    if (!isfinite(e.least))
        return "";
    const char *other =
        e.row < 0 ? ""
                  : pool_format(pool, "; of all others the largest is %s, measured mode %.0f with mode %.0f of the model",
                                human_fixed(pool, e.other, 2), fit->matrix_row[e.row], fit->matrix_column[e.column]);
    const char *text = pool_format(pool, "%s of the pairs (framed) lies between %s and %s%s. ", name,
                                   human_fixed(pool, e.least, 2), human_fixed(pool, e.most, 2), other ? other : "");
    return text ? text : "";
}

void figure_matrices(struct document *document, const struct result *result, const struct fitted *fit)
{
    struct pool *pool = document->pool;
    const struct fitted_matrix *matrix[2] = {&fit->nco, &fit->mac};
    static const char *const title[] = {"NCO", "MAC"};
    static const char *const full[] = {"NCO, weighed with the mass", "MAC, without the mass"};
    struct matrix_panel panel[2];
    const char *says = "";
    int count = 0;
    for (int i = 0; i < 2 && says; i++) {
        const struct fitted_matrix *m = matrix[i];
        if (!m->value || m->rows > MOST_SIDE || m->columns > MOST_SIDE || !m->rows || !m->columns)
            continue;
        int *mark = pairs(pool, fit, m->rows, m->columns);
        panel[count++] = (struct matrix_panel){.title = full[i],
                                               .row_axis = "measured mode [1]",
                                               .column_axis = "mode of the model [1]",
                                               .rows = m->rows,
                                               .columns = m->columns,
                                               .value = m->value,
                                               .row = numbers_as_text(pool, m->rows, fit->matrix_row),
                                               .column = numbers_as_text(pool, m->columns, fit->matrix_column),
                                               .mark = mark};
        if (!mark || !panel[count - 1].row || !panel[count - 1].column) {
            document->failed = 1;
            return;
        }
        says = pool_format(pool, "%s%s", says, sentence(pool, title[i], m, fit, mark));
    }
    if (!count)
        return;
    struct figure *figure = document_figure(document, "correlation-of-shapes", "Each measured shape beside each of the model");
    figure->caption = pool_format(pool, "%s1 is the same shape, 0 a shape that has nothing in common.", says ? says : "");
    figure->alt = pool_format(pool, "%d fields of %d by %d cells, dark where a measured shape is like one of the model.", count,
                              panel[0].rows, panel[0].columns);
    figure->table = matrix_table(pool, count, panel);
    document->failed |= !figure->caption || !figure->alt || matrix_script(pool, figure, result->file, count, panel) != ROTID_OK;
}

void figure_correlation(struct document *document, const struct result *result, const struct fitted *fit)
{
    struct pool *pool = document->pool;
    int n = fit->nparameter, first = -1, second = -1;
    if (n < 3 || n > MOST_SIDE || !fit->correlation)
        return; /* of two the caption of the intervals tells it */
    const char **name = POOL_ARRAY(pool, const char *, n);
    if (!name) {
        document->failed = 1;
        return;
    }
    for (int i = 0; i < n; i++) {
        name[i] = fit->parameter[i].name;
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
    figure->table = matrix_table(pool, 1, &panel);
    document->failed |= !figure->caption || !figure->alt || matrix_script(pool, figure, result->file, 1, &panel) != ROTID_OK;
}
