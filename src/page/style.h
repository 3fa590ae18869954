/* The style of a page: light and dark, wide and narrow, screen and paper. */
#ifndef ROTID_PAGE_STYLE_H
#define ROTID_PAGE_STYLE_H

#include <stdio.h>

void style_write(FILE *out);

#endif
