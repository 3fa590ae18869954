/* Pictures of gnuplot made ready to stand in a page: identifiers that occur once, colours and type of the page, no size of their
 * own, a title and a description for those who do not see them, and without what draws nothing. */
#ifndef ROTID_PAGE_SVG_H
#define ROTID_PAGE_SVG_H

#include "page/figure.h"

/* The element <svg> for a layout of the figure (pool); NULL where the text is no complete SVG of gnuplot, or memory is out. */
char *svg_clean(struct pool *pool, const char *text, const struct figure *figure, int layout);

#endif
