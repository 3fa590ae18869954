/* gnuplot draws the figures: found, asked for its version, and run on scripts. */
#ifndef ROTID_PAGE_GNUPLOT_H
#define ROTID_PAGE_GNUPLOT_H

#include "page/figure.h"

struct gnuplot {
    const char *path;    /* of the program: $GNUPLOT, or gnuplot out of PATH */
    const char *version; /* "5.4 patchlevel 4", NULL: there is none that can be used */
    const char *why;     /* then: in a sentence, without a full stop */
};

/* ROTID_OK, whether there is one or not, or ROTID_ERROR_MEMORY. */
int gnuplot_find(struct pool *pool, const rotid_environment *environment, struct gnuplot *gnuplot);

/* Runs the scripts ID.gp of the figures, which stand in the folder of this descriptor, and reads ID.svg and ID-narrow.svg back
 * into them, made ready for a page. As few runs as it takes: after a script that fails the others are drawn in another run. why
 * [count]: what gnuplot says of a figure that it did not draw, else NULL. ROTID_OK, ROTID_ERROR_MEMORY, or ROTID_STOP_CANCELLED.
 */
int gnuplot_draw(struct pool *pool, const struct gnuplot *gnuplot, const rotid_environment *environment, int folder, int count,
                 struct figure *const figure[], const char **why);

#endif
