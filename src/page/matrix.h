/* Matrices as fields of coloured cells with their numbers in them. */
#ifndef ROTID_PAGE_MATRIX_H
#define ROTID_PAGE_MATRIX_H

#include "page/series.h"

struct matrix_panel {
    const char *title, *row_axis, *column_axis; /* what rows and columns are; the axes with their units */
    int rows, columns;
    const double *value;                    /* column-major; a share from -1 to 1 by its size, NaN left empty */
    const char *const *row, *const *column; /* names */
    const int *mark;                        /* [rows] the column of a cell that is framed, -1: none; or NULL */
};

#define MATRIX_MOST 2 /* in one figure */

/* Series, table and script of a figure with a panel for each; rows of all panels stand below each other in the table. The figure
 * has its texts. */
void matrix_figure(struct document *document, struct figure *figure, const char *source, int count,
                   const struct matrix_panel *panel);

#endif
