/* A rotor as rectangles in the coordinates of a panel: z along x, distance from the axis along y, both in m. */
#ifndef ROTID_PAGE_ROTOR_H
#define ROTID_PAGE_ROTOR_H

#include "page/geometry.h"
#include "page/plot.h"
#include "page/result.h"

#define ROTOR_MATERIALS 5 /* that have a colour of their own; the others share the last */

struct rotor_materials {
    int count;
    const char *name[ROTOR_MATERIALS];
};

/* Materials in the order of the axis, and the colour of one. */
struct rotor_materials rotor_materials(const rotid_geometry *geometry);
const char *rotor_color(const struct rotor_materials *materials, const char *name);

/* Whether a parameter of the group was identified; fit may be NULL. */
int rotor_is_identified(const rotid_identification *fit, const rotid_group *group);

/* Sections, hollows, tie rods and bars of the rotor as objects of the current panel, what was identified hatched (fit may be
 * NULL). plain: its outline alone, as a strip beside a curve along the axis needs it. Returns the number of the last object. */
int rotor_draw(struct plot *plot, const rotid_geometry *geometry, const rotid_identification *fit, int plain);

#endif
