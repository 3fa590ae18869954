#include "page/fitted.h"

#include <math.h>
#include <string.h>

#define MOST 2000000000 /* of what is counted */

static void read_parameters(const struct json_place *at, struct fitted *fit)
{
    struct json_place list;
    int rows, columns;
    fit->parameter = place_items(at, "parameters", sizeof *fit->parameter, &list, &fit->nparameter);
    for (struct json_place item = place_first(&list, PLACE_OBJECT); item.json && fit->parameter;
         item = place_next(&item, PLACE_OBJECT)) {
        struct fitted_parameter *p = &fit->parameter[item.index];
        double *ci;
        p->name = place_string(&item, "name");
        p->unit = place_string(&item, "unit");
        p->value = place_number(&item, "value");
        p->start = place_number(&item, "start");
        p->lower = place_number(&item, "lower");
        p->upper = place_number(&item, "upper");
        p->std = place_number(&item, "std");
        p->at_bound = place_flag(&item, "at_bound");
        p->identifiable = place_flag(&item, "identifiable");
        if (place_list(&item, "ci95", 1, 2, &ci))
            memcpy(p->ci, ci, sizeof p->ci);
    }
    const int square[2] = {fit->nparameter, fit->nparameter};
    (void)place_matrix(at, "correlation", 1, square, &rows, &columns, &fit->correlation);
}

static void read_modes(const struct json_place *at, struct fitted *fit)
{
    struct json_place list;
    double *reduction, *mesh;
    fit->mode = place_items(at, "modes", sizeof *fit->mode, &list, &fit->nmode);
    int with_reduction = place_list(at, "reduction_error_percent", 1, fit->nmode, &reduction),
        with_mesh = place_list(at, "mesh_error_percent", 1, fit->nmode, &mesh);
    for (struct json_place item = place_first(&list, PLACE_OBJECT); item.json && fit->mode;
         item = place_next(&item, PLACE_OBJECT)) {
        struct fitted_mode *mode = &fit->mode[item.index];
        double number = place_number_if(&item, "measured_mode");
        mode->mode = place_whole(&item, "mode", 1, MOST);
        mode->measured_mode = number >= 1 && number < MOST ? (int)number : 0;
        mode->measured_hz = place_number(&item, "measured_hz");
        mode->frequency_std = place_number_if(&item, "frequency_std");
        mode->predicted_hz = place_number(&item, "predicted_hz");
        mode->error_percent = place_number(&item, "error_percent");
        mode->residual = place_number(&item, "residual");
        mode->mac = place_number(&item, "mac");
        mode->nco = place_number(&item, "nco");
        mode->holdout = place_flag(&item, "holdout");
        mode->by_shape = !strcmp(place_string(&item, "paired_by"), "shape");
        mode->reduction_percent = with_reduction ? reduction[item.index] : (double)NAN;
        mode->mesh_percent = with_mesh ? mesh[item.index] : (double)NAN;
    }
}

static void read_history(const struct json_place *at, struct fitted *fit)
{
    struct json_place list;
    fit->history = place_items(at, "history", sizeof *fit->history, &list, &fit->nhistory);
    for (struct json_place item = place_first(&list, PLACE_OBJECT); item.json && fit->history;
         item = place_next(&item, PLACE_OBJECT)) {
        struct fitted_iteration *now = &fit->history[item.index];
        now->iteration = place_whole(&item, "iteration", 0, MOST);
        now->objective = place_number(&item, "objective");
        now->gradient = place_number(&item, "gradient");
        now->mu = place_number(&item, "mu");
        now->gain_ratio = place_number(&item, "gain_ratio");
        now->step = place_number(&item, "step");
        now->seconds = place_number_if(&item, "seconds");
        (void)place_list(&item, "x", 1, fit->nparameter, &now->x);
    }
    fit->baseline = place_items(at, "baseline", sizeof *fit->baseline, &list, &fit->nbaseline);
    for (struct json_place item = place_first(&list, PLACE_OBJECT); item.json && fit->baseline;
         item = place_next(&item, PLACE_OBJECT)) {
        struct fitted_baseline *b = &fit->baseline[item.index];
        b->algorithm = place_string(&item, "algorithm");
        b->result = place_string(&item, "result");
        b->usable = place_flag(&item, "usable");
        b->objective = place_number(&item, "objective");
        b->gradient = place_number(&item, "gradient");
        b->evaluations = place_whole(&item, "evaluations", 0, MOST);
        b->seconds = place_number(&item, "seconds");
        (void)place_list(&item, "x", 1, fit->nparameter, &b->x);
        (void)place_list(&item, "predicted_hz", 0, fit->nmode, &b->predicted_hz);
    }
}

static void read_matrices(const struct json_place *at, struct fitted *fit)
{
    (void)place_matrix(at, "nco_matrix", 0, NULL, &fit->nco.rows, &fit->nco.columns, &fit->nco.value);
    (void)place_matrix(at, "mac_matrix", 0, NULL, &fit->mac.rows, &fit->mac.columns, &fit->mac.value);
    if (fit->nco.value && fit->mac.value && (fit->nco.rows != fit->mac.rows || fit->nco.columns != fit->mac.columns))
        place_wrong(at, "nco_matrix and mac_matrix are of different size, expected one row a measured mode in both");
    const struct fitted_matrix *one = fit->mac.value ? &fit->mac : &fit->nco;
    if (one->value && !at->reader->status) {
        (void)place_list(at, "matrix_rows", 1, one->rows, &fit->matrix_row);
        (void)place_list(at, "matrix_columns", 1, one->columns, &fit->matrix_column);
    }
}

struct fitted *fitted_read(const struct json_place *at)
{
    struct reader *reader = at->reader;
    struct fitted *fit = POOL_NEW(reader->pool, struct fitted);
    struct json_place says;
    if (!fit) {
        reader->status = ROTID_ERROR_MEMORY;
        return NULL;
    }
    fit->status = place_string(at, "status");
    fit->functional = place_string(at, "functional");
    fit->reduction = place_string(at, "reduction");
    fit->derivative = place_string(at, "derivative");
    fit->stop_reason = place_string(at, "stop_reason");
    fit->shapes_fitted = place_find(at, "shapes_fitted", PLACE_FLAG, &says) ? cJSON_IsTrue(says.json) : -1;
    fit->bijection_chi = place_number_if(at, "bijection_chi");
    fit->objective = place_number(at, "objective");
    fit->gradient = place_number(at, "gradient");
    fit->chi2 = place_number(at, "chi2");
    fit->chi2_per_dof = place_number(at, "chi2_per_dof");
    fit->dof = place_whole(at, "dof", -MOST, MOST);
    fit->iterations = place_whole(at, "iterations", 0, MOST);
    fit->evaluations = place_whole(at, "evaluations", 0, MOST);
    fit->jacobians = place_whole(at, "jacobians", 0, MOST);
    fit->condition_number = place_number(at, "condition_number");
    fit->widened_by = place_number(at, "intervals_widened_by");
    fit->mass_kg = place_number(at, "mass_kg");
    fit->center_m = place_number(at, "center_of_mass_m");
    fit->seconds = place_number(at, "seconds");
    read_parameters(at, fit);
    read_modes(at, fit);
    read_history(at, fit);
    fit->shapes = fitted_read_shapes(at);
    read_matrices(at, fit);
    return reader->status ? NULL : fit;
}

double fitted_rms_percent(const struct fitted *fit, int holdout)
{
    double sum = 0;
    int count = 0;
    for (int k = 0; k < fit->nmode; k++)
        if (!fit->mode[k].holdout == !holdout) {
            sum += fit->mode[k].error_percent * fit->mode[k].error_percent;
            count++;
        }
    return sqrt(sum / count); /* 0/0 of none */
}

int fitted_worst(const struct fitted *fit)
{
    int worst = -1;
    for (int k = 0; k < fit->nmode; k++)
        if (!fit->mode[k].holdout && (worst < 0 || fabs(fit->mode[k].error_percent) > fabs(fit->mode[worst].error_percent)))
            worst = k;
    return worst;
}
