/* A rotor as it is drawn, out of "geometry" of a result. Positions and lengths in m. */
#ifndef ROTID_PAGE_GEOMETRY_H
#define ROTID_PAGE_GEOMETRY_H

#include "rotid.h"

/* Its name, "" where it has none. */
const char *material_name(const rotid_material *material);

/* Height of a section in the bending plane: its outer diameter, or that of a rectangle. */
double segment_height(const rotid_segment *segment);

/* Largest radius; and that of the segment around z (the larger one where two meet). */
double geometry_radius(const rotid_geometry *geometry);
double geometry_radius_at(const rotid_geometry *geometry, double z);
/* Whether a parameter called "NAME.E" or the like is one of this group. */
int geometry_is_of(const rotid_group *group, const char *parameter);
/* Elements along the axis. */
int geometry_elements(const rotid_geometry *geometry);

/* The parts of tie rods and bars that are drawn, the tie rods first. */
struct bundle {
    const char *name; /* or NULL */
    int is_bars, number;
    double from, to, diameter, pitch; /* pitch radius */
};
int geometry_nbundle(const rotid_geometry *geometry);
struct bundle geometry_bundle(const rotid_geometry *geometry, int i);

/* Where a cause in the model acts, NaN where it has no place. */
double model_cause_z(const rotid_model_cause *cause);

#endif
