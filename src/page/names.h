/* Names of the rows of a panel, whole: a name that is longer than its room goes on in further lines, and the rows grow. Beside
 * the rows on a wide page, over what belongs to them on a narrow one. */
#ifndef ROTID_PAGE_NAMES_H
#define ROTID_PAGE_NAMES_H

#include "page/plot.h"

struct name_rows {
    int rows;
    const char *const *name; /* [rows] from the top */
    double room[LAYOUTS];    /* px of a line */
    double height[LAYOUTS];  /* px of a row */
    double single[LAYOUTS];  /* px of a row whose name is one line */
};

/* Bytes of the first line of a text that is `room` px wide: up to a blank, or within a word that is longer than the room. All of
 * a text that fits. */
size_t name_line(const char *text, double room);
int name_line_count(const char *text, double room);

/* Rows that are single[] px high where every name is one line, higher by what the longest name needs. */
struct name_rows names_measure(int rows, const char *const name[], const double room[LAYOUTS], const double single[LAYOUTS]);
/* Draws the names in the current panel, where row i is at y = i, from below from 1; color [rows], NULL: ink. Sets LIFT and SHARE
 * in the script: how far under the middle of its row that stands what belongs to it, and the height of a single row over that of
 * a row. */
void names_draw(struct plot *plot, const struct name_rows *names, const char *const color[]);

#endif
