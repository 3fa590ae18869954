/* Matrices as fields of coloured cells with their numbers in them. */
#ifndef ROTID_PAGE_MATRIX_H
#define ROTID_PAGE_MATRIX_H

#include "page/plot.h"

struct matrix_panel {
    const char *title, *row_axis, *column_axis; /* what rows and columns are; the axes with their units */
    int rows, columns;
    const double *value;                    /* column-major; a share from -1 to 1 by its size, NaN left empty */
    const char *const *row, *const *column; /* names */
    const int *mark;                        /* [rows] the column of a cell that is framed, -1: none; or NULL */
};

/* A script with a panel for each. */
int matrix_script(struct pool *pool, struct figure *figure, const char *source, int count, const struct matrix_panel *panel);
/* Its numbers, rows of all panels below each other, headed by title and row. */
struct number_table *matrix_table(struct pool *pool, int count, const struct matrix_panel *panel);

#endif
