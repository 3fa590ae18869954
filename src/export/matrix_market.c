#include "export/export.h"

#include <math.h>

#define LINE_WIDTH 120 /* the format allows 1,024 */

static struct remark begin(FILE *stream, const struct export_model *model, const char *form, const char *what)
{
    struct remark remark = {stream, "% ", LINE_WIDTH};
    (void)fprintf(stream, "%%%%MatrixMarket matrix %s real symmetric\n", form);
    remark_put(&remark, "%s", what);
    remark_model(&remark, model);
    return remark;
}

static int write_full(FILE *stream, const struct export_model *model, const rotid_matrix *a, const char *what)
{
    struct remark remark = begin(stream, model, "coordinate", what);
    if (model->is_solid)
        remark_put(
            &remark,
            "Lower triangle. Rows are U, V, W [m] of the nodes of a solid of revolution that bends: u_r = U cos t, u_t = V "
            "sin t, u_z = W cos t; on the axis V = -U and W = 0. Those of rods and bars beside it are v [m] and theta [rad] "
            "= -dv/dz. Which row is which, and where, stands in the file NAME.nodes.csv beside this one; in the row of a "
            "sensor U is that of the surface at the sensor.");
    else
        remark_put(&remark,
                   "Lower triangle. Rows 2 i - 1 and 2 i are v [m] and theta [rad] of node i = 1 ... %d, theta = -dv/dz; their "
                   "positions stand in the file NAME.nodes.csv beside this one.",
                   a->n / 2);
    (void)fprintf(stream, "%d %d %ld\n", a->n, a->n, triplet_count(a));
    for (struct triplet t = {.row = -1}; triplet_next(a, &t);)
        (void)fprintf(stream, "%d %d %.17g\n", t.row + 1, t.column + 1, t.value);
    return ROTID_OK;
}

int matrix_market_stiffness(FILE *stream, const struct export_model *model)
{
    return write_full(stream, model, &model->k, "Stiffness matrix [N/m, N, N.m]");
}

int matrix_market_mass(FILE *stream, const struct export_model *model)
{
    return write_full(stream, model, &model->m, "Mass matrix [kg, kg.m, kg.m2]");
}

static int write_condensed(FILE *stream, const struct export_model *model, const double *a, const char *what)
{
    int n = model->condensed.count;
    struct remark remark = begin(stream, model, "array", what);
    remark_condensed(&remark, model);
    for (int i = 0; i < n; i++)
        remark_put(&remark, "row %d: %s %d at %.10g m", i + 1, model->job->rotor.nsensor ? "sensor" : "node",
                   export_master_id(model, i), export_master_z(model, i));
    (void)fprintf(stream, "%d %d\n", n, n);
    for (int j = 0; j < n; j++)
        for (int i = j; i < n; i++)
            (void)fprintf(stream, "%.17g\n", a[i + (ptrdiff_t)j * n]);
    return ROTID_OK;
}

int matrix_market_condensed_stiffness(FILE *stream, const struct export_model *model)
{
    return write_condensed(stream, model, model->condensed.k, "Condensed stiffness matrix [N/m]");
}

int matrix_market_condensed_mass(FILE *stream, const struct export_model *model)
{
    return write_condensed(stream, model, model->condensed.m, "Condensed mass matrix [kg]");
}

static void put_row(FILE *stream, int row)
{
    (void)fprintf(stream, row ? "%d," : ",", row);
}

int matrix_market_nodes(FILE *stream, const struct export_model *model)
{
    int solid = model->is_solid;
    (void)fprintf(stream, solid ? "node,r_m,z_m,row_u,row_v,row_w,row_theta,member,sensor\n"
                                : "node,z_m,row_v,row_theta,member,sensor\n");
    for (int i = 0; i < model->nnode; i++) {
        const struct export_node *node = &model->node[i];
        (void)fprintf(stream, "%d,", i + 1);
        if (isfinite(node->r))
            (void)fprintf(stream, "%.17g", node->r);
        (void)fprintf(stream, solid ? ",%.17g," : "%.17g,", node->z);
        for (int c = 0; c < (solid ? 4 : 2); c++)
            put_row(stream, node->row[c]);
        remark_word(stream, node->member);
        (void)fprintf(stream, node->sensor ? ",%d\n" : ",\n", node->sensor);
    }
    return ROTID_OK;
}
