#include "page/rotor.h"

#include <math.h>
#include <string.h>

static const char *const faces[ROTOR_MATERIALS] = {"STEEL", "SHEETS", "ROSE", "SAND", "SHADE"};

struct rotor_materials rotor_materials(const struct geometry *geometry)
{
    struct rotor_materials materials = {.count = 0};
    for (int g = 0; g < geometry->ngroup; g++) {
        int known = 0;
        for (int i = 0; i < materials.count; i++)
            known |= !strcmp(materials.name[i], geometry->group[g].material.name);
        if (!known && materials.count < ROTOR_MATERIALS)
            materials.name[materials.count++] = geometry->group[g].material.name;
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

int rotor_is_identified(const struct fitted *fit, const struct drawn_group *group)
{
    for (int p = 0; fit && p < fit->nparameter; p++)
        if (geometry_is_of(group, fit->parameter[p].name))
            return 1;
    return 0;
}

static void rectangle(struct plot *plot, int object, double from, double to, double low, double high, const char *how)
{
    plot_line(plot, "set object %d rectangle from %.6g,%.6g to %.6g,%.6g noclip %s", object, from, low, to, high, how);
}

static int draw_segment(struct plot *plot, int object, const struct geometry *geometry, const struct drawn_segment *segment,
                        const char *color, int hatched)
{
    const struct drawn_group *group = &geometry->group[segment->group];
    double r = segment->outer / 2, hollow = segment->inner / 2;
    char how[96];
    (void)snprintf(how, sizeof how, "fs solid border lc rgb INK fc rgb %s lw 0.75", color);
    rectangle(plot, ++object, segment->from, segment->to, -r, r, how);
    if (hatched)
        rectangle(plot, ++object, segment->from, segment->to, -r, r, "fs transparent pattern 4 noborder fc rgb MUTED");
    if (hollow > 0)
        rectangle(plot, ++object, segment->from, segment->to, -hollow, hollow, "fs solid border lc rgb INK fc rgb PAPER lw 0.75");
    if (isfinite(segment->stiff_outer)) /* what carries stiffness */
        rectangle(plot, ++object, segment->from, segment->to, -segment->stiff_outer / 2, segment->stiff_outer / 2,
                  "fs empty border lc rgb MUTED lw 0.75 dt (4,3)");
    for (int side = -1; side <= 1 && isfinite(group->hole_pitch); side += 2)
        rectangle(plot, ++object, segment->from, segment->to, side * group->hole_pitch, side * group->hole_pitch,
                  "fs empty border lc rgb MUTED lw 0.75 dt (2,3)");
    return object;
}

int rotor_draw(struct plot *plot, const struct geometry *geometry, const struct fitted *fit, int plain)
{
    struct rotor_materials materials = rotor_materials(geometry);
    int object = 0;
    for (int s = 0; s < geometry->nsegment; s++) {
        const struct drawn_segment *segment = &geometry->segment[s];
        const struct drawn_group *group = &geometry->group[segment->group];
        object = draw_segment(plot, object, geometry, segment, plain ? "SHADE" : rotor_color(&materials, group->material.name),
                              !plain && rotor_is_identified(fit, group));
    }
    for (int b = 0; b < geometry->nbundle && !plain; b++) {
        const struct drawn_bundle *bundle = &geometry->bundle[b];
        for (int side = -1; side <= 1; side += 2)
            rectangle(plot, ++object, bundle->from, bundle->to, side * bundle->pitch - bundle->diameter / 2,
                      side * bundle->pitch + bundle->diameter / 2,
                      bundle->is_bars ? "fs solid border lc rgb INK fc rgb SAND lw 0.75"
                                      : "fs solid border lc rgb GREEN fc rgb LEAF lw 0.75");
    }
    return object;
}
