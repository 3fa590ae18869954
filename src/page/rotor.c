#include "page/rotor.h"
#include "page/geometry.h"

#include <math.h>
#include <string.h>

static const char *const faces[ROTOR_MATERIALS] = {"STEEL", "SHEETS", "ROSE", "SAND", "SHADE"};

struct rotor_materials rotor_materials(const rotid_geometry *geometry)
{
    struct rotor_materials materials = {.count = 0};
    for (int g = 0; g < geometry->ngroups; g++) {
        int known = 0;
        for (int i = 0; i < materials.count; i++)
            known |= !strcmp(materials.name[i], material_name(&geometry->groups[g].material));
        if (!known && materials.count < ROTOR_MATERIALS)
            materials.name[materials.count++] = material_name(&geometry->groups[g].material);
    }
    return materials;
}

const char *rotor_color(const struct rotor_materials *materials, const char *name)
{
    for (int i = 0; i < materials->count; i++)
        if (!strcmp(materials->name[i], name))
            return faces[i];
    return faces[ROTOR_MATERIALS - 1];
}

int rotor_is_identified(const rotid_identification *fit, const rotid_group *group)
{
    for (int p = 0; fit && p < fit->nparameters; p++)
        if (geometry_is_of(group, fit->parameters[p].name))
            return 1;
    return 0;
}

static void rectangle(struct plot *plot, int object, double from, double to, double low, double high, const char *how)
{
    plot_line(plot, "set object %d rectangle from %.6g,%.6g to %.6g,%.6g noclip %s", object, from, low, to, high, how);
}

static int draw_segment(struct plot *plot, int object, const rotid_group *group, const rotid_segment *segment, const char *color,
                        int hatched)
{
    double r = segment_height(segment) / 2, hollow = segment->inner_m / 2, stiff = segment->stiff_outer_m / 2,
           holes = group->perforation ? group->perforation->pitch_radius_m : (double)NAN, from = segment->from_m,
           to = segment->to_m;
    char how[96];
    double low = group->layer_of ? hollow : -r; /* of a layer the ring alone, on both sides: its host fills the middle */
    (void)snprintf(how, sizeof how, "fs solid border lc rgb INK fc rgb %s lw 0.75", color);
    for (int side = 1; side >= (group->layer_of ? -1 : 1); side -= 2) {
        rectangle(plot, ++object, from, to, side * low, side * r, how);
        if (hatched)
            rectangle(plot, ++object, from, to, side * low, side * r, "fs transparent pattern 4 noborder fc rgb MUTED");
    }
    if (hollow > 0 && !group->layer_of)
        rectangle(plot, ++object, from, to, -hollow, hollow, "fs solid border lc rgb INK fc rgb PAPER lw 0.75");
    if (isfinite(stiff)) /* what carries stiffness */
        rectangle(plot, ++object, from, to, -stiff, stiff, "fs empty border lc rgb MUTED lw 0.75 dt (4,3)");
    for (int side = -1; side <= 1 && isfinite(holes); side += 2)
        rectangle(plot, ++object, from, to, side * holes, side * holes, "fs empty border lc rgb MUTED lw 0.75 dt (2,3)");
    return object;
}

int rotor_draw(struct plot *plot, const rotid_geometry *geometry, const rotid_identification *fit, int plain)
{
    struct rotor_materials materials = rotor_materials(geometry);
    int object = 0;
    for (int g = 0; g < geometry->ngroups; g++) {
        const rotid_group *group = &geometry->groups[g];
        const char *color = plain ? "SHADE" : rotor_color(&materials, material_name(&group->material));
        for (int s = 0; s < group->nsegments; s++)
            object = draw_segment(plot, object, group, &group->segments[s], color, !plain && rotor_is_identified(fit, group));
    }
    for (int b = 0; b < geometry_nbundle(geometry) && !plain; b++) {
        struct bundle bundle = geometry_bundle(geometry, b);
        for (int side = -1; side <= 1; side += 2)
            rectangle(plot, ++object, bundle.from, bundle.to, side * bundle.pitch - bundle.diameter / 2,
                      side * bundle.pitch + bundle.diameter / 2,
                      bundle.is_bars ? "fs solid border lc rgb INK fc rgb SAND lw 0.75"
                                     : "fs solid border lc rgb GREEN fc rgb LEAF lw 0.75");
    }
    return object;
}
