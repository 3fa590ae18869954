/* A picture of gnuplot as an image of a page: a browser draws an image without running or loading anything, whatever stands in
 * it. */
#ifndef ROTID_PAGE_PICTURE_H
#define ROTID_PAGE_PICTURE_H

#include "base/pool.h"

/* The SVG as a data URI (RFC 2397) in the type of the page, which follows light and dark by itself and is light on paper (pool);
 * NULL where the text is no complete SVG of gnuplot, or memory is out. */
const char *picture_uri(struct pool *pool, const char *svg);

#endif
