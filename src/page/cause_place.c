#include "page/cause_place.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "page/geometry.h"

static const rotid_cause_value *value_of(const rotid_cause *cause, const char *name)
{
    for (int p = 0; p < cause->nparameters; p++)
        if (!strcmp(cause->parameters[p].name, name))
            return &cause->parameters[p];
    return NULL;
}

static int at_group(const rotid_geometry *geometry, const char *target, struct cause_place *place)
{
    size_t length = strcspn(target, "|"); /* of an interface: the group before it ends there */
    for (int g = 0; g < geometry->ngroups; g++) {
        const rotid_group *group = &geometry->groups[g];
        if (strlen(group->name) != length || strncmp(group->name, target, length) != 0)
            continue;
        *place = (struct cause_place){target[length] ? group->to_m : group->from_m, group->to_m, {NAN, NAN}};
        return 1;
    }
    return 0;
}

static int at_member(const rotid_geometry *geometry, const char *target, struct cause_place *place)
{
    double z;
    for (int b = 0; b < geometry_nbundle(geometry); b++) {
        struct bundle bundle = geometry_bundle(geometry, b);
        if (bundle.name && !strcmp(bundle.name, target)) {
            *place = (struct cause_place){bundle.from, bundle.to, {NAN, NAN}};
            return 1;
        }
    }
    for (int s = 0; s < geometry->nsprings; s++)
        if (geometry->springs[s].name && !strcmp(geometry->springs[s].name, target)) {
            *place = (struct cause_place){geometry->springs[s].z_m, geometry->springs[s].z_m, {NAN, NAN}};
            return 1;
        }
    if (sscanf(target, "at %lf m", &z) != 1 || !isfinite(z)) /* of a spring without a name */
        return 0;
    *place = (struct cause_place){z, z, {NAN, NAN}};
    return 1;
}

int cause_place(const rotid_geometry *geometry, const rotid_cause *cause, struct cause_place *place)
{
    const rotid_cause_value *z = value_of(cause, "z"), *width = value_of(cause, "width");
    double half = width && isfinite(width->value) ? width->value : 0;
    *place = (struct cause_place){NAN, NAN, {NAN, NAN}};
    if (!geometry)
        return 0;
    if (z && isfinite(z->value)) {
        *place =
            (struct cause_place){fmax(z->value - half, 0), fmin(z->value + half, geometry->length_m), {z->ci95[0], z->ci95[1]}};
        return place->from <= place->to;
    }
    return *cause->target && (at_group(geometry, cause->target, place) || at_member(geometry, cause->target, place));
}
