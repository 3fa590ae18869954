/* What stands at the drawn rotor and has no size of its own: names of groups, springs, sensors, disks, causes, nodes. Their sizes
 * are in px, so each layout of the page has its own. */
#ifndef ROTID_PAGE_ROTOR_MARKS_H
#define ROTID_PAGE_ROTOR_MARKS_H

#include "page/geometry.h"
#include "page/result.h"
#include "page/series.h"

struct rotor_label {
    const char *text;
    double z, from; /* where it belongs, m; its left end, px */
    int lane;       /* of those over the rotor; -1: there was no room, the table has it */
};

struct rotor_drawing {           /* in one layout */
    double scale;                /* px a metre, along both axes */
    double left;                 /* px from the left to z = 0 */
    double radius, above, below; /* px: of the rotor; room over and under its axis with all marks */
    struct rotor_label *label;   /* [ngroup] */
};

/* ROTID_OK or ROTID_ERROR_MEMORY. */
int rotor_measure(struct pool *pool, const rotid_geometry *geometry, int layout, struct rotor_drawing *drawing);

/* $sensors, $disks, $causes, $nodes, $springs and `center`: before plot_begin. */
void rotor_marks_data(struct document *document, struct plot *plot, const rotid_geometry *geometry,
                      const rotid_identification *fit);
/* Names and stiffnesses in a layout. */
void rotor_marks_labels(struct plot *plot, const rotid_geometry *geometry, const struct rotor_drawing *drawing, int layout);

#endif
