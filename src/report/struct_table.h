/* One table for all ways to show it: made once from a result, then written as lines of text, as CSV or as HTML. Cells are added
 * row by row, from the left. What was added when memory was out is lost and marks the table. Texts are not copied. */
#ifndef ROTID_REPORT_STRUCT_TABLE_H
#define ROTID_REPORT_STRUCT_TABLE_H

#include <stdio.h>

#include "base/pool.h"

enum table_format {
    TABLE_TEXT,
    TABLE_FIXED,   /* `digits` decimals */
    TABLE_SIGNED,  /* the same with a sign */
    TABLE_DIGITS,  /* `digits` significant digits */
    TABLE_TRIMMED, /* the same without zeros at the end */
    TABLE_CHANCE   /* a probability: "<0.001" below that, else significant digits */
};

struct table_column {
    const char *name, *unit; /* unit: NULL of a text, a count and a pure number */
    enum table_format format;
    int digits;
};

struct table_cell {
    const char *text; /* as it is shown; "" of a cell that stays blank */
    double value;     /* of a number, in the unit of its column, or of its row where a column of the table holds the unit */
    int is_number;
};

struct table {
    struct pool *pool;
    int failed;                 /* memory was out */
    const char *caption, *note; /* note: what a reader has to know of it, under the table; NULL: nothing */
    int ncolumns, ncells;
    size_t column_room, cell_room;
    struct table_column *column;
    struct table_cell *cell; /* by rows; a row that is not full ends in blanks */
};

/* A table without columns; NULL where memory is out, which all that adds takes. */
struct table *table_open(struct pool *pool, const char *caption);
/* Columns, before the first cell. */
void table_add_column(struct table *table, const char *name, const char *unit, enum table_format format, int digits);
void table_add_columns(struct table *table, int count, const struct table_column column[]);
int table_rows(const struct table *table);

/* The next cell. A number that is not finite is shown as a dash. */
void cell_text(struct table *table, const char *text);
void cell_number(struct table *table, double value);
/* A number with its own count of decimals in place of that of its column. */
void cell_decimals(struct table *table, double value, int decimals);
/* Four cells: the unit that suits the value, the value, both ends of its 95 % interval. */
void cell_interval(struct table *table, double value, const double ci95[2], const char *unit);

/* Whether a column holds anything: one of dashes and blanks alone is shown in no form but CSV. The first one always does. */
int table_column_is_shown(const struct table *table, int column);
/* Lines with a head, columns two blanks apart, numbers to the right; the caption in front and the note behind, both wrapped to
 * `width` columns. */
void table_write_text(FILE *out, const struct table *table, int width);
/* A head and a line a row; numbers with the digits that give them back, blank where there is none. */
void table_write_csv(FILE *out, const struct table *table);
/* <table> with caption; number: of the table on its page, for the id of the caption. */
void table_write_html(FILE *out, const struct table *table, int number);

#endif
