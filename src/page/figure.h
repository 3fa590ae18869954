/* Figures of a page: what each shows, the script that draws it, the numbers behind it, and the pictures once they are drawn. */
#ifndef ROTID_PAGE_FIGURE_H
#define ROTID_PAGE_FIGURE_H

#include "base/pool.h"

/* Cells as they are shown, by rows; the first column heads its row. */
struct number_table {
    int columns, rows;
    const char **head; /* [columns] with units in brackets */
    const char **cell; /* [rows * columns] */
    char *look;        /* [columns] what html_table finds them to be */
};

enum { WIDE, NARROW, LAYOUTS }; /* for a page 720 px wide, and for a phone */
#define WIDE_PX   720
#define NARROW_PX 360

struct figure {
    const char *id;               /* [a-z0-9-]: name of its files and of its place on the page */
    const char *title;            /* over it */
    const char *caption;          /* what it shows for this result */
    const char *alt;              /* the figure in words, for those who do not see it */
    char *script;                 /* for gnuplot, complete */
    int height[LAYOUTS];          /* px */
    struct number_table *table;   /* of its numbers, NULL: they stand elsewhere on the page */
    const char *picture[LAYOUTS]; /* for the page, as a data URI; NULL: not drawn */
    int has_pdf;
};

/* A table with room for as many cells, all "" (pool); NULL where memory is out. */
struct number_table *table_new(struct pool *pool, int rows, int columns);
/* The same under the heads [columns]. */
struct number_table *table_headed(struct pool *pool, int rows, int columns, const char *const *head);
/* text NULL: memory was out when it was made; becomes "". */
void table_head(struct number_table *table, int column, const char *text);
void table_cell(struct number_table *table, int row, int column, const char *text);

#endif
