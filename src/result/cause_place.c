#include "result/result.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const rotid_cause_value *value_of(const rotid_cause *cause, const char *name)
{
    for (int p = 0; p < cause->nparameters; p++)
        if (!strcmp(cause->parameters[p].name, name))
            return &cause->parameters[p];
    return NULL;
}

static int set(struct cause_place *place, double from, double to)
{
    *place = (struct cause_place){from, to, {NAN, NAN}};
    return 1;
}

static int at_group(const rotid_geometry *geometry, const char *target, struct cause_place *place)
{
    size_t length = strcspn(target, "|"); /* of an interface: the group before it ends there */
    for (int g = 0; g < geometry->ngroups; g++) {
        const rotid_group *group = &geometry->groups[g];
        if (strlen(group->name) == length && !strncmp(group->name, target, length))
            return set(place, target[length] ? group->to_m : group->from_m, group->to_m);
    }
    return 0;
}

static int at_member(const rotid_geometry *geometry, const char *target, struct cause_place *place)
{
    double z;
    for (int i = 0; i < geometry->ntierods; i++)
        if (geometry->tierods[i].name && !strcmp(geometry->tierods[i].name, target))
            return set(place, geometry->tierods[i].from_m, geometry->tierods[i].to_m);
    for (int i = 0; i < geometry->nbars; i++)
        if (geometry->bars[i].name && !strcmp(geometry->bars[i].name, target))
            return set(place, geometry->bars[i].from_m, geometry->bars[i].to_m);
    for (int i = 0; i < geometry->nsprings; i++)
        if (geometry->springs[i].name && !strcmp(geometry->springs[i].name, target))
            return set(place, geometry->springs[i].z_m, geometry->springs[i].z_m);
    if (sscanf(target, "at %lf m", &z) != 1 || !isfinite(z)) /* of a spring without a name */
        return 0;
    return set(place, z, z);
}

int cause_place(const rotid_geometry *geometry, const rotid_cause *cause, struct cause_place *place)
{
    const rotid_cause_value *z = value_of(cause, "z"), *width = value_of(cause, "width");
    double half = width && isfinite(width->value) ? width->value : 0;
    (void)set(place, NAN, NAN);
    if (!geometry)
        return 0;
    if (z && isfinite(z->value)) {
        *place =
            (struct cause_place){fmax(z->value - half, 0), fmin(z->value + half, geometry->length_m), {z->ci95[0], z->ci95[1]}};
        return place->from <= place->to;
    }
    return *cause->target && (at_group(geometry, cause->target, place) || at_member(geometry, cause->target, place));
}
