#include <math.h>

#include "page/fitted.h"

#define MOST 1000000

static void read_members(const struct json_place *at, struct fitted_shape *shape)
{
    static const char *const keys[] = {"tierods", "bars"};
    struct json_place list[2];
    int count = 0;
    for (int b = 0; b < 2; b++)
        if (place_need(at, keys[b], PLACE_LIST, &list[b]))
            count += place_count(&list[b]);
    shape->member = POOL_ARRAY(at->reader->pool, struct fitted_member, count);
    if (!shape->member) {
        at->reader->status = ROTID_ERROR_MEMORY;
        return;
    }
    for (int b = 0; b < 2; b++)
        for (struct json_place item = place_first(&list[b], PLACE_OBJECT); item.json; item = place_next(&item, PLACE_OBJECT)) {
            struct fitted_member *member = &shape->member[shape->nmember++];
            member->is_bars = b;
            member->name = place_string_if(&item, "name");
            member->npoint = place_list(&item, "z_m", 1, -1, &member->z);
            (void)place_list(&item, "shape", 1, member->npoint, &member->shape);
        }
}

struct fitted_shapes *fitted_read_shapes(const struct json_place *above)
{
    struct json_place at, list;
    struct reader *reader = above->reader;
    struct fitted_shapes *shapes = POOL_NEW(reader->pool, struct fitted_shapes);
    if (!shapes)
        reader->status = ROTID_ERROR_MEMORY;
    if (!shapes || !place_find(above, "shapes", PLACE_OBJECT, &at))
        return NULL;
    shapes->nsensor = place_list(&at, "sensor_id", 1, -1, &shapes->sensor_id);
    (void)place_list(&at, "z_m", 1, shapes->nsensor, &shapes->sensor_z);
    shapes->naxis = place_list(&at, "axis_z_m", 1, -1, &shapes->axis_z);
    shapes->nmode = place_need(&at, "modes", PLACE_LIST, &list) ? place_count(&list) : 0;
    shapes->mode = POOL_ARRAY(reader->pool, struct fitted_shape, shapes->nmode);
    if (!shapes->mode)
        reader->status = ROTID_ERROR_MEMORY;
    for (struct json_place item = place_first(&list, PLACE_OBJECT); item.json && shapes->mode;
         item = place_next(&item, PLACE_OBJECT)) {
        struct fitted_shape *shape = &shapes->mode[item.index];
        shape->mode = place_whole(&item, "mode", 1, MOST);
        shape->measured_mode = place_whole(&item, "measured_mode", 1, MOST);
        (void)place_list(&item, "measured", 0, shapes->nsensor, &shape->measured);
        (void)place_list(&item, "measured_std", 0, shapes->nsensor, &shape->measured_std);
        (void)place_list(&item, "predicted", 1, shapes->nsensor, &shape->predicted);
        (void)place_list(&item, "predicted_axis", 1, shapes->naxis, &shape->axis);
        read_members(&item, shape);
    }
    return reader->status ? NULL : shapes;
}
