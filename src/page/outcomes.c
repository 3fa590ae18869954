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

static struct growth_outcome *read_growth(const struct json_place *root)
{
    static const char *const keys[] = {"hybrid", "hybrid_f"};
    struct json_place at, one;
    struct growth_outcome *growth = new_outcome(root, sizeof *growth);
    if (!growth || !place_find(root, "functional_growth", PLACE_OBJECT, &at))
        return NULL;
    growth->points = place_list(&at, "epsilon_squared", 1, -1, &growth->epsilon2);
    for (int kind = 0; kind < 2; kind++) {
        (void)place_need(&at, keys[kind], PLACE_OBJECT, &one);
        (void)place_list(&one, "objective", 1, growth->points, &growth->objective[kind]);
        growth->slope[kind] = place_number(&one, "slope");
        growth->intercept[kind] = place_number(&one, "intercept");
    }
    (void)place_list(&at, "shapes_alone", 0, growth->points, &growth->shapes_alone);
    return growth;
}

struct sensitivity_outcome *sensitivity_read(const struct json_place *root)
{
    struct sensitivity_outcome *out = new_outcome(root, sizeof *out);
    struct json_place list;
    int rows, columns;
    if (!out)
        return NULL;
    out->reduction = place_string(root, "reduction");
    out->step = place_number(root, "step");
    out->nmode = place_list(root, "frequency_hz", 1, -1, &out->hz);
    out->npoint = place_list(root, "relative_value", 1, -1, &out->relative);
    const int size[2] = {out->nmode, out->npoint};
    out->parameter = place_items(root, "parameters", sizeof *out->parameter, &list, &out->nparameter);
    for (struct json_place item = place_first(&list, PLACE_OBJECT); item.json && out->parameter;
         item = place_next(&item, PLACE_OBJECT)) {
        struct sensitivity_parameter *p = &out->parameter[item.index];
        p->name = place_string(&item, "name");
        p->unit = place_string(&item, "unit");
        p->reference = place_number(&item, "reference");
        (void)place_list(&item, "sensitivity", 1, out->nmode, &p->difference);
        (void)place_list(&item, "derivative", 1, out->nmode, &p->derivative);
        (void)place_matrix(&item, "curves", 1, size, &rows, &columns, &p->curve);
    }
    out->growth = read_growth(root);
    return root->reader->status ? NULL : out;
}

static void read_function(const struct json_place *item, struct transfer_outcome *out, struct transfer_function *f)
{
    int measured = out->measured_file != NULL;
    f->response = place_whole(item, "response", -MOST, MOST);
    f->reference = place_whole(item, "reference", -MOST, MOST);
    f->response_z = place_number(item, "response_z_m");
    f->reference_z = place_number(item, "reference_z_m");
    f->frac = place_number_if(item, "frac");
    f->frac_moved = place_number_if(item, "frac_at_measured_frequencies");
    f->level_db = place_number_if(item, "level_db");
    if (!out->with_curves)
        return;
    f->nline = place_list(item, "frequency_hz", 1, -1, &f->hz);
    (void)place_list(item, "synthesised_re", 1, f->nline, &f->re);
    (void)place_list(item, "synthesised_im", 1, f->nline, &f->im);
    (void)place_list(item, "measured_re", measured, f->nline, &f->measured_re);
    (void)place_list(item, "measured_im", measured, f->nline, &f->measured_im);
}

static void read_transfer_modes(const struct json_place *root, struct transfer_outcome *out)
{
    struct json_place list;
    out->mode = place_items(root, "modes", sizeof *out->mode, &list, &out->nmode);
    for (struct json_place item = place_first(&list, PLACE_OBJECT); item.json && out->mode;
         item = place_next(&item, PLACE_OBJECT)) {
        struct transfer_mode *mode = &out->mode[item.index];
        int rigid = place_flag(&item, "rigid");
        mode->mode = rigid ? 0 : place_whole(&item, "mode", 1, MOST);
        mode->model_hz = place_number(&item, "model_hz");
        mode->measured_hz = place_number(&item, "measured_hz");
        mode->damping = place_number(&item, "damping");
        mode->damping_from = place_string(&item, "damping_from");
        mode->frac = place_number_if(&item, "frac");
        mode->level_db = place_number_if(&item, "level_db");
        mode->phase_deg = place_number_if(&item, "phase_deg");
    }
}

struct transfer_outcome *transfer_read(const struct json_place *root)
{
    struct transfer_outcome *out = new_outcome(root, sizeof *out);
    struct json_place list, agreement;
    if (!out)
        return NULL;
    out->quantity = place_string(root, "quantity");
    out->unit = place_string(root, "unit");
    out->measured_file = place_string_if(root, "measured_file");
    out->low_hz = place_number(root, "low_hz");
    out->high_hz = place_number(root, "high_hz");
    out->up_to_hz = place_number(root, "modes_up_to_hz");
    out->complete = place_flag(root, "complete");
    out->with_curves = place_flag(root, "with_curves");
    (void)place_find(root, "agreement", PLACE_OBJECT, &agreement);
    out->frac = place_number_if(&agreement, "frac");
    out->frac_moved = place_number_if(&agreement, "frac_at_measured_frequencies");
    read_transfer_modes(root, out);
    out->function = place_items(root, "functions", sizeof *out->function, &list, &out->nfunction);
    for (struct json_place item = place_first(&list, PLACE_OBJECT); item.json && out->function;
         item = place_next(&item, PLACE_OBJECT))
        read_function(&item, out, &out->function[item.index]);
    out->parameter = place_items(root, "parameters", sizeof *out->parameter, &list, &out->nparameter);
    for (struct json_place item = place_first(&list, PLACE_OBJECT); item.json && out->parameter;
         item = place_next(&item, PLACE_OBJECT)) {
        out->parameter[item.index].name = place_string(&item, "name");
        out->parameter[item.index].unit = place_string(&item, "unit");
        out->parameter[item.index].value = place_number(&item, "value");
    }
    return root->reader->status ? NULL : out;
}
