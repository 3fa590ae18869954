/* Scripts for gnuplot, from 5.2 on. A script is complete: data, styles, panels; it writes ID.svg and ID.pdf, and on the page's
 * behalf ID-narrow.svg. Its layout is one of panels of equal size in rows, fewer a row where the page is narrow.
 *
 *     struct plot plot;
 *     if (plot_open(&plot, pool, figure, "result.json"))    // no memory
 *         return ROTID_ERROR_MEMORY;
 *     plot_series(&plot, curve);                            // of page/series.h
 *     plot_begin(&plot, &(struct plot_layout){.panels = 1, .columns = {1, 1}, .height = 300, .left = 60, ...});
 *     plot_panel(&plot, 0);
 *     plot_axes(&plot, "iteration [1]", "objective [1]");
 *     plot_line(&plot, "set yrange [0:1]");
 *     plot_line(&plot, "plot $curve using 1:2 with linespoints ls 1 notitle");
 *     return plot_close(&plot);                             // the script hangs on the figure
 *
 * Texts of a user (names of groups, parameters, units, files) go through plot_quote, plot_quote_tick, plot_axes or plot_label
 * alone: gnuplot runs what stands in backquotes in a text of double quotes. The enhanced mode of gnuplot, whose marks name
 * typefaces that gnuplot copies into its SVG unescaped, is off: ^ and _ stand for themselves, and exponents are characters. */
#ifndef ROTID_PAGE_PLOT_H
#define ROTID_PAGE_PLOT_H

#include <stdio.h>

#include "page/figure.h"

struct plot_layout {
    int panels, columns[LAYOUTS];
    double height;                   /* of a panel with its margins, px */
    double narrow_height;            /* the same where the page is narrow; 0: no other */
    double left, right, top, bottom; /* margins of a panel, px */
    double head[LAYOUTS];            /* above all panels, px: plot_head for a legend */
};

/* An entry of a legend: a line in a line style, a mark in it, a face, hatched or not. */
enum plot_key { KEY_LINE = 1, KEY_MARK = 2, KEY_FACE = 4, KEY_HATCH = 8 };
struct plot_entry {
    const char *text;
    int style;        /* of the line, as ls in scripts */
    int keys;         /* of enum plot_key */
    const char *face; /* its colour; "" of none but hatching */
};

struct plot {
    struct pool *pool;
    struct figure *figure;
    FILE *out;
    char *text;
    size_t length;
    struct plot_layout layout;
    int panel, labels; /* the current one; labels set so far in it */
};

/* Begins the script of a figure, which has its id. ROTID_OK or ROTID_ERROR_MEMORY, then there is nothing to close. */
int plot_open(struct plot *plot, struct pool *pool, struct figure *figure, const char *source);
/* A text of a user within a comment. */
void plot_comment(struct plot *plot, const char *text);
/* From here on everything is done once for each layout: W, H [px], COLUMNS and `narrow` are set in the script. */
void plot_begin(struct plot *plot, const struct plot_layout *layout);
/* Room of panel i; the settings of the panel before are gone. */
void plot_panel(struct plot *plot, int i);
/* What the axes of the current panel show, with units, below it in lines as wide as the panel: the layout has the room, plot_lines_px
 * at the bottom. NULL where an axis has none. */
void plot_axes(struct plot *plot, const char *x, const char *y);
/* A line of the script. */
void plot_line(struct plot *plot, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* A number as scripts read it, NaN where it is not finite. */
const char *plot_number(struct plot *plot, double value);
/* A text of a user as a script can hold it, with its quotes: 'text'. */
const char *plot_quote(struct plot *plot, const char *text);
/* The same as the label of a tick, in which gnuplot would take % for a format of the number there. */
const char *plot_quote_tick(struct plot *plot, const char *text);
/* set label TEXT at X, Y: `where` is "graph 0, graph 1" and the like; more: "right", "offset ...", or "". */
void plot_label(struct plot *plot, const char *text, const char *where, const char *color, const char *more);
/* A label over another place: lines of at most `room` px, the last one `up` lines of text above `where`, which is two coordinates. */
void plot_label_over(struct plot *plot, const char *text, double room, const char *where, double up, const char *color);
/* px that the longest of some texts needs in such lines beyond the first. */
double plot_lines_px(int count, const char *const *text, double room);
/* px of the narrower of the panels of both layouts, without their margins. */
double plot_panel_px(const struct plot_layout *layout);

/* px of a line of the name of an axis. */
double plot_axis_px(const struct plot_layout *layout);

/* Labels of lines at the right edge, at heights 0 ... 1 of the panel, in lines as wide as the margin there, moved apart where they
 * would overlap. */
void plot_end_labels(struct plot *plot, int count, const char *const *text, const double *height, const char *const *color);
/* Height of a legend [px] for layout.head, and the legend, over the first panel; entries go on in a new row where one is full. */
void plot_head(const struct plot_entry *entry, int count, double head[LAYOUTS]);
void plot_legend(struct plot *plot, const struct plot_entry *entry, int count);
/* Ends the script, which hangs on the figure. ROTID_OK or ROTID_ERROR_MEMORY. */
int plot_close(struct plot *plot);

/* Least and largest finite value, widened by `margin` of their distance at both ends; 0 ... 1 of nothing. */
struct plot_range {
    double from, to;
};
struct plot_range plot_range_of(int count, const double *value, double margin);
void plot_range_join(struct plot_range *range, double value);
double plot_share(const struct plot_range *range, double value); /* 0 ... 1 */
/* Whole decades around the values above zero, as exponents; at most `most` decades, the upper ones. */
struct plot_range plot_decades(int count, const double *value, int most);

/* Axis 'x' or 'y' is logarithmic over these decades, with at most about `most` of them numbered. */
void plot_decades_axis(struct plot *plot, char axis, const struct plot_range *range, int most);

/* A round distance of ticks that puts about `count` of them on a length: 1, 2 or 5 times a power of ten. */
double plot_tic(double length, int count);

/* Left margin [px] for an axis with its name and the numbers of these ticks. */
double plot_left(const struct plot_range *range, double tic);

/* px of a text in the type of the figures, about. */
double plot_width(const char *text);

#endif
