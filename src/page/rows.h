/* Panels of rows with names: beside them, or over them where the page is narrow. In scripts LIFT is then how far what belongs to
 * a row lies under its middle; rows count from below, from 1. */
#ifndef ROTID_PAGE_ROWS_H
#define ROTID_PAGE_ROWS_H

#include "page/names.h"

#define ROWS_MOST 24

/* name [rows] from the top: rows grow with their lines. */
struct plot_layout rows_layout(int rows, const char *const name[]);
/* Sets the rows of the current panel, its y range and its border; name [rows] from the top. */
void rows_draw(struct plot *plot, int rows, const char *const name[]);

#endif
