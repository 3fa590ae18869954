#include "report/json_shapes.h"

#include <math.h>

#include "run/mode_shapes.h"

static void add_members(struct json_tree *tree, cJSON *item, const char *key, const struct mode_shapes *shapes, int is_bars,
                        int k)
{
    cJSON *list = json_array(tree, item, key);
    for (int i = 0; i < shapes->nmember; i++) {
        const struct member_shape *member = &shapes->member[i];
        if (member->is_bars != is_bars)
            continue;
        cJSON *one = json_object(tree, list, NULL);
        json_text(tree, one, "name", member->name);
        json_digits(tree, one, "z_m", member->npoint, member->z);
        json_digits(tree, one, "shape", member->npoint, member->shape + (ptrdiff_t)k * member->npoint);
    }
}

static int knows_noise(const struct job *job, int nsensor, int k)
{
    int known = 0;
    for (int i = 0; i < nsensor && job->shape_std && !known; i++)
        known = isfinite(job->shape_std[i + (ptrdiff_t)k * nsensor]);
    return known;
}

static void add_mode(struct json_tree *tree, cJSON *list, const struct job *job, const struct comparison *compared,
                     const struct mode_shapes *shapes, int k)
{
    cJSON *item = json_object(tree, list, NULL);
    ptrdiff_t at = (ptrdiff_t)k * shapes->nsensor;
    json_number(tree, item, "mode", compared->number[k]);
    json_number(tree, item, "measured_mode", job->number[k]);
    if (shapes->has_shape[k])
        json_digits(tree, item, "measured", shapes->nsensor, shapes->measured + at);
    else
        json_null(tree, item, "measured");
    if (shapes->has_shape[k] && knows_noise(job, shapes->nsensor, k))
        json_digits(tree, item, "measured_std", shapes->nsensor, job->shape_std + at);
    else
        json_null(tree, item, "measured_std");
    json_digits(tree, item, "predicted", shapes->nsensor, shapes->predicted + at);
    json_digits(tree, item, "predicted_axis", shapes->naxis, shapes->axis + (ptrdiff_t)k * shapes->naxis);
    add_members(tree, item, "tierods", shapes, 0, k);
    add_members(tree, item, "bars", shapes, 1, k);
}

/* rows [nmode] of a matrix that may be missing */
static void add_matrix(struct json_tree *tree, cJSON *object, const char *key, const struct mode_shapes *shapes,
                       const double *matrix, double *row)
{
    if (!matrix) {
        json_null(tree, object, key);
        return;
    }
    cJSON *rows = json_array(tree, object, key);
    for (int k = 0; k < shapes->nmode; k++) {
        for (int j = 0; j < shapes->ncolumn; j++)
            row[j] = matrix[k + (ptrdiff_t)j * shapes->nmode];
        json_digits(tree, rows, NULL, shapes->ncolumn, row);
    }
}

static void add_shapes(struct json_tree *tree, cJSON *object, const struct job *job, const struct identification *result,
                       const struct mode_shapes *shapes, double *work)
{
    const struct rotor *rotor = result->spectrum.model->rotor;
    cJSON *item = json_object(tree, object, "shapes"), *list = json_array(tree, item, "sensor_id");
    for (int s = 0; s < shapes->nsensor; s++) {
        json_number(tree, list, NULL, rotor->sensor[s].id);
        work[s] = rotor->sensor[s].position;
    }
    json_digits(tree, item, "z_m", shapes->nsensor, work);
    json_digits(tree, item, "axis_z_m", shapes->naxis, shapes->axis_z);
    list = json_array(tree, item, "modes");
    for (int k = 0; k < shapes->nmode; k++)
        add_mode(tree, list, job, &result->compared, shapes, k);
    add_matrix(tree, object, "nco_matrix", shapes, shapes->nco, work);
    add_matrix(tree, object, "mac_matrix", shapes, shapes->mac, work);
    list = json_array(tree, object, "matrix_rows");
    for (int k = 0; k < shapes->nmode && shapes->mac; k++)
        json_number(tree, list, NULL, job->number[k]);
    list = json_array(tree, object, "matrix_columns");
    for (int j = 0; j < shapes->ncolumn && shapes->mac; j++)
        json_number(tree, list, NULL, j + 1);
}

void json_shapes(struct json_tree *tree, cJSON *object, const struct job *job, const struct identification *result)
{
    struct pool pool;
    struct mode_shapes shapes;
    if (!result->spectrum.model) {
        json_null(tree, object, "shapes");
        return;
    }
    pool_open(&pool, NULL);
    int status = mode_shapes_make(&pool, job, &result->spectrum, &result->compared, &shapes);
    double *work = status ? NULL : POOL_ARRAY(&pool, double, shapes.nsensor + shapes.ncolumn);
    if (work)
        add_shapes(tree, object, job, result, &shapes, work);
    else
        tree->failed = 1;
    pool_close(&pool);
}
