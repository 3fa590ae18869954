/* Numbers of a figure as named series with units: from them follow the data of the script and the table of numbers on the page.
 *
 *     static const struct column columns[] = {{"iteration", NULL, AS_FIXED, 0}, {"objective", "1", AS_DIGITS, 8}};
 *     struct series *series = series_new(document, "iterations", n, 2, columns);
 *     for (int i = 0; i < n; i++)
 *         series_row(series, i, (const double[]){history[i].iteration, history[i].objective});
 *     figure->table = series_table(series);
 *     ...
 *     plot_series(&plot, series);
 *     plot_line(&plot, "plot $iterations using 1:2 with lines ls 1");
 *
 * Where memory is out the document is marked, and there are no series: every routine takes NULL then. */
#ifndef ROTID_PAGE_SERIES_H
#define ROTID_PAGE_SERIES_H

#include "page/document.h"
#include "page/plot.h"

/* How the table shows the numbers: with so many decimals, with a sign too, with so many significant digits, without zeros at the
 * end of these; not at all, since they only say where something is drawn; or texts, which are not among the data. */
enum column_look { AS_FIXED, AS_SIGNED, AS_DIGITS, AS_TRIMMED, AS_PLACE, AS_TEXT };

struct column {
    const char *name, *unit; /* "objective", "1"; unit NULL: none is told */
    enum column_look look;
    int digits;
};

struct series; /* columns by rows */

/* All NaN, or without a text. name: of the data in the script, as $name. A name that is NULL, of a column too: memory is out. The
 * texts of the columns are copied, name is not. */
struct series *series_new(struct document *document, const char *name, int rows, int columns, const struct column column[]);
/* The numbers of a row, in the order of the columns without texts. */
void series_row(struct series *series, int row, const double value[]);
/* A cell of the table in the place of what would stand there; text NULL: memory is out. */
void series_text(struct series *series, int row, int column, const char *text);
/* 0 of none. */
int series_rows(const struct series *series);
/* The numbers [rows] of a column, followed by those of the next; NULL where memory is out. */
double *series_values(struct series *series, int column);

/* The table of numbers; NULL where memory is out. */
struct number_table *series_table(const struct series *series);
/* The rows of several ones, one after the other, under a head of the first one's names and of the others' where they differ:
 * "measured [Hz], or z [m]". They have as many columns that are shown. */
struct number_table *series_table_of(int count, const struct series *const series[]);
/* The data with a comment that names the columns, NaN for what is not finite; before plot_begin. */
void plot_series(struct plot *plot, const struct series *series);

/* Begins the script of a figure: 1, or 0 where memory is out. Ends the script; a figure that lacks a text marks the document. */
int figure_begin(struct document *document, struct figure *figure, const char *source, struct plot *plot);
void figure_end(struct document *document, struct plot *plot);
/* "set xtics" with the numbers of modes, at places 1 ... count, with a star for those that were held out; at most `most`. */
void plot_mode_tics(struct plot *plot, int count, const rotid_compared_mode *mode, int most);

#endif
