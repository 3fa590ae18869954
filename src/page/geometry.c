#include "page/geometry.h"

#include <math.h>
#include <string.h>

const char *material_name(const rotid_material *material)
{
    return material->name ? material->name : "";
}

double segment_height(const rotid_segment *segment)
{
    return isfinite(segment->height_m) ? segment->height_m : segment->outer_m;
}

/* The largest radius of what lies around z; of NaN: of all. */
static double radius_around(const rotid_geometry *geometry, double z)
{
    double radius = 0, near = 1e-9 * geometry->length_m;
    for (int g = 0; g < geometry->ngroups; g++)
        for (int s = 0; s < geometry->groups[g].nsegments; s++) {
            const rotid_segment *segment = &geometry->groups[g].segments[s];
            if (!(z < segment->from_m - near || z > segment->to_m + near))
                radius = fmax(radius, segment_height(segment) / 2);
        }
    return radius;
}

double geometry_radius(const rotid_geometry *geometry)
{
    return radius_around(geometry, NAN);
}

double geometry_radius_at(const rotid_geometry *geometry, double z)
{
    return isfinite(z) ? radius_around(geometry, z) : 0;
}

int geometry_is_of(const rotid_group *group, const char *parameter)
{
    size_t length = strlen(group->name);
    for (const char *next = parameter; next; next = strchr(parameter, '=')) { /* left.E=right.E is of both */
        parameter = next + (next != parameter);
        if (!strncmp(parameter, group->name, length) && parameter[length] == '.')
            return 1;
    }
    return 0;
}

int geometry_elements(const rotid_geometry *geometry)
{
    int elements = 0;
    for (int g = 0; g < geometry->ngroups; g++)
        for (int s = 0; s < geometry->groups[g].nsegments && !geometry->groups[g].layer_of; s++)
            elements += geometry->groups[g].segments[s].elements;
    return elements;
}

int geometry_nbundle(const rotid_geometry *geometry)
{
    return geometry->ntierods + geometry->nbars;
}

struct bundle geometry_bundle(const rotid_geometry *geometry, int i)
{
    if (i < geometry->ntierods) {
        const rotid_tierods *t = &geometry->tierods[i];
        return (struct bundle){t->name, 0, t->number, t->from_m, t->to_m, t->diameter_m, t->pitch_radius_m};
    }
    const rotid_bars *b = &geometry->bars[i - geometry->ntierods];
    return (struct bundle){b->name, 1, b->number, b->from_m, b->to_m, b->diameter_m, b->pitch_radius_m};
}

double model_cause_z(const rotid_model_cause *cause)
{
    double z = NAN;
    for (int p = 0; p < cause->nparameters; p++)
        if (!strcmp(cause->parameters[p].name, "z"))
            z = cause->parameters[p].value;
    return z;
}
