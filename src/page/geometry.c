#include "page/geometry.h"

#include <math.h>
#include <string.h>

#define MOST     1000000    /* of anything that is counted in one place */
#define MOST_SUM 1000000000 /* over all places: an int holds it */

static void read_material(const struct json_place *owner, struct drawn_material *material)
{
    struct json_place at;
    if (!place_need(owner, "material", PLACE_OBJECT, &at))
        return;
    material->name = place_string(&at, "name");
    material->e = place_number(&at, "e_pa");
    material->g = place_number(&at, "g_pa");
    material->nu = place_number(&at, "nu");
    material->rho = place_number(&at, "rho_kg_m3");
}

static void read_segment(const struct json_place *at, struct drawn_segment *segment)
{
    struct json_place rectangle;
    segment->from = place_number(at, "from_m");
    segment->to = place_number(at, "to_m");
    segment->elements = place_whole(at, "elements", 1, MOST);
    segment->stiff_outer = NAN;
    if (place_find(at, "height_m", PLACE_NUMBER, &rectangle)) {
        segment->outer = rectangle.json->valuedouble;
        return;
    }
    segment->outer = place_number(at, "outer_m");
    segment->inner = place_number(at, "inner_m");
    segment->stiff_outer = place_number_if(at, "stiff_outer_m");
}

/* Groups, and their segments in room that grows. */
static void read_groups(const struct json_place *at, struct geometry *geometry)
{
    struct reader *reader = at->reader;
    struct json_place list, segments, holes;
    size_t capacity = 0;
    geometry->group = place_items(at, "groups", sizeof *geometry->group, &list, &geometry->ngroup);
    for (struct json_place item = place_first(&list, PLACE_OBJECT); item.json && !(reader->status == ROTID_ERROR_MEMORY);
         item = place_next(&item, PLACE_OBJECT)) {
        struct drawn_group *group = &geometry->group[item.index];
        group->name = place_string(&item, "name");
        group->from = place_number(&item, "from_m");
        group->to = place_number(&item, "to_m");
        group->hole_pitch = place_find(&item, "perforation", PLACE_OBJECT, &holes) ? place_number(&holes, "pitch_radius_m") : NAN;
        read_material(&item, &group->material);
        if (!place_need(&item, "segments", PLACE_LIST, &segments))
            continue;
        for (struct json_place one = place_first(&segments, PLACE_OBJECT); one.json; one = place_next(&one, PLACE_OBJECT)) {
            struct drawn_segment *grown =
                pool_grow(reader->pool, geometry->segment, (size_t)geometry->nsegment, &capacity, sizeof *geometry->segment);
            if (!grown) {
                reader->status = ROTID_ERROR_MEMORY;
                return;
            }
            geometry->segment = grown;
            grown[geometry->nsegment] = (struct drawn_segment){.group = item.index};
            read_segment(&one, &grown[geometry->nsegment++]);
        }
    }
    if (!geometry->nsegment && !reader->status)
        place_wrong(&list, "has no segment, expected one");
}

static void read_bundles(const struct json_place *at, struct geometry *geometry)
{
    static const char *const keys[] = {"tierods", "bars"};
    struct json_place list[2];
    int count[2];
    struct drawn_bundle *kind[2];
    for (int b = 0; b < 2; b++)
        kind[b] = place_items(at, keys[b], sizeof **kind, &list[b], &count[b]);
    geometry->bundle = POOL_ARRAY(at->reader->pool, struct drawn_bundle, count[0] + count[1]);
    if (!geometry->bundle || !kind[0] || !kind[1]) {
        at->reader->status = ROTID_ERROR_MEMORY;
        return;
    }
    for (int b = 0; b < 2; b++)
        for (struct json_place item = place_first(&list[b], PLACE_OBJECT); item.json; item = place_next(&item, PLACE_OBJECT)) {
            struct drawn_bundle *bundle = &geometry->bundle[geometry->nbundle++];
            bundle->is_bars = b;
            bundle->name = place_string_if(&item, "name");
            bundle->from = place_number(&item, "from_m");
            bundle->to = place_number(&item, "to_m");
            bundle->number = place_whole(&item, "number", 1, MOST);
            bundle->diameter = place_number(&item, "diameter_m");
            bundle->pitch = place_number(&item, "pitch_radius_m");
        }
}

static struct drawn_point *read_points(const struct json_place *at, const char *key, const char *value, const char *rotational,
                                       int *n)
{
    struct json_place list;
    struct drawn_point *point = place_items(at, key, sizeof *point, &list, n);
    for (struct json_place item = place_first(&list, PLACE_OBJECT); item.json && point; item = place_next(&item, PLACE_OBJECT)) {
        struct drawn_point *p = &point[item.index];
        p->name = place_string_if(&item, "name");
        p->z = place_number(&item, "z_m");
        p->value = place_number(&item, value);
        p->rotational = rotational ? place_number(&item, rotational) : 0;
    }
    return point;
}

static void read_causes(const struct json_place *at, struct geometry *geometry)
{
    struct json_place list, parameters;
    geometry->cause = place_items(at, "causes", sizeof *geometry->cause, &list, &geometry->ncause);
    for (struct json_place item = place_first(&list, PLACE_OBJECT); item.json && geometry->cause;
         item = place_next(&item, PLACE_OBJECT)) {
        struct drawn_cause *cause = &geometry->cause[item.index];
        cause->name = place_string_if(&item, "name");
        cause->id = place_string(&item, "id");
        cause->target = place_string_if(&item, "target");
        cause->z = NAN;
        if (!place_find(&item, "parameters", PLACE_LIST, &parameters))
            continue;
        for (struct json_place p = place_first(&parameters, PLACE_OBJECT); p.json; p = place_next(&p, PLACE_OBJECT))
            if (!strcmp(place_string(&p, "name"), "z"))
                cause->z = place_number(&p, "value");
    }
}

/* What a drawing rests on: nothing that is drawn to scale may lack a size. */
static void check(const struct json_place *at, const struct geometry *geometry)
{
    int good = geometry->length > 0;
    double elements = 0, members = 0;
    for (int s = 0; s < geometry->nsegment; s++) {
        const struct drawn_segment *segment = &geometry->segment[s];
        good &= segment->to > segment->from && segment->outer > 0 && segment->inner >= 0 && segment->inner < segment->outer;
        elements += segment->elements;
    }
    for (int b = 0; b < geometry->nbundle; b++)
        members += geometry->bundle[b].number;
    if (fmax(elements, members) > MOST_SUM && !at->reader->status)
        place_wrong(at, "has %.0f elements, %.0f tie rods and bars, expected fewer than %d", elements, members, MOST_SUM);
    if (!good && !at->reader->status)
        place_wrong(at, "has a length or a section of no size, expected a rotor that can be drawn");
}

struct geometry *geometry_read(const struct json_place *above)
{
    struct json_place at;
    struct reader *reader = above->reader;
    struct geometry *geometry = POOL_NEW(reader->pool, struct geometry);
    if (!geometry)
        reader->status = ROTID_ERROR_MEMORY;
    if (!geometry || !place_find(above, "geometry", PLACE_OBJECT, &at))
        return NULL;
    geometry->length = place_number(&at, "length_m");
    read_groups(&at, geometry);
    read_bundles(&at, geometry);
    geometry->disk = read_points(&at, "disks", "mass_kg", NULL, &geometry->ndisk);
    geometry->spring = read_points(&at, "springs", "lateral_n_m", "rotational_nm_rad", &geometry->nspring);
    geometry->sensor = read_points(&at, "sensors", "id", NULL, &geometry->nsensor);
    read_causes(&at, geometry);
    geometry->nnode = place_list(&at, "nodes_z_m", 1, -1, &geometry->node_z);
    check(&at, geometry);
    return reader->status ? NULL : geometry;
}

double geometry_radius(const struct geometry *geometry)
{
    double radius = 0;
    for (int s = 0; s < geometry->nsegment; s++)
        radius = fmax(radius, geometry->segment[s].outer / 2);
    return radius;
}

double geometry_radius_at(const struct geometry *geometry, double z)
{
    double radius = 0, near = 1e-9 * geometry->length;
    for (int s = 0; s < geometry->nsegment; s++)
        if (z >= geometry->segment[s].from - near && z <= geometry->segment[s].to + near)
            radius = fmax(radius, geometry->segment[s].outer / 2);
    return radius;
}

int geometry_is_of(const struct drawn_group *group, const char *parameter)
{
    size_t length = strlen(group->name);
    return !strncmp(parameter, group->name, length) && parameter[length] == '.';
}

int geometry_elements(const struct geometry *geometry)
{
    int elements = 0;
    for (int s = 0; s < geometry->nsegment; s++)
        elements += geometry->segment[s].elements;
    return elements;
}
