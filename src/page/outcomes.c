#include "page/outcomes.h"

#include <math.h>

#define MOST 1000000000 /* of what is counted */

/* NULL with the mark on the reader where memory is out. */
static void *new_outcome(const struct json_place *root, size_t size)
{
    void *outcome = pool_get(root->reader->pool, 1, size);
    if (!outcome)
        root->reader->status = ROTID_ERROR_MEMORY;
    return outcome;
}

struct modes_outcome *modes_read(const struct json_place *root)
{
    struct modes_outcome *out = new_outcome(root, sizeof *out);
    struct json_place list;
    if (!out)
        return NULL;
    out->reduction = place_string(root, "reduction");
    out->nrigid = place_list(root, "rigid_hz", 1, -1, &out->rigid_hz);
    out->nsensor = place_list(root, "sensor_z_m", 1, -1, &out->sensor_z);
    out->mode = place_items(root, "modes", sizeof *out->mode, &list, &out->nmode);
    for (struct json_place item = place_first(&list, PLACE_OBJECT); item.json && out->mode;
         item = place_next(&item, PLACE_OBJECT)) {
        struct modes_entry *mode = &out->mode[item.index];
        mode->mode = place_whole(&item, "mode", 1, MOST);
        mode->full_hz = place_number(&item, "full_hz");
        mode->reduced_hz = place_number(&item, "reduced_hz");
        mode->reduction_percent = place_number(&item, "reduction_error_percent");
        mode->mesh_percent = place_number(&item, "mesh_error_percent");
        mode->measured_hz = place_number_if(&item, "measured_hz");
        mode->error_percent = place_number_if(&item, "error_percent");
        mode->mac = place_number_if(&item, "mac");
        mode->nco = place_number_if(&item, "nco");
        (void)place_list(&item, "shape", 1, out->nsensor, &mode->shape);
    }
    return root->reader->status ? NULL : out;
}
