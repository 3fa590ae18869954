/* Synthesised transfer functions as sets 58. */
#include <stdlib.h>
#include <string.h>

#include "report/report.h"
#include "result/result.h"
#include "uff/uff.h"

static int by_id(const void *left, const void *right)
{
    const struct uff_node *a = left, *b = right;
    return (a->id > b->id) - (a->id < b->id);
}

static int write_nodes(FILE *stream, const struct frf_view *view)
{
    const struct frf_result *r = view->result;
    struct uff_node *node = POOL_ARRAY(view->pool, struct uff_node, 2 * (size_t)r->ndone);
    int axis = view->job->options.frf.axis, count = 0;
    if (!node)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < 2 * r->ndone; i++) {
        const struct frf_row *row = &r->row[i / 2];
        node[i].id = i % 2 ? row->reference : row->response;
        node[i].color = 1;
        node[i].x[axis] = i % 2 ? row->reference_z : row->response_z;
    }
    qsort(node, 2 * (size_t)r->ndone, sizeof *node, by_id);
    for (int i = 0; i < 2 * r->ndone; i++)
        if (!count || node[i].id != node[count - 1].id)
            node[count++] = node[i];
    return uff_write_nodes(stream, 2411, count, node);
}

/* The direction of the measurement without its sign, which the synthesised function does not have; else the first lateral axis.
 */
static int direction_of(const struct frf_view *view, const struct frf_row *row)
{
    int measured = row->measured ? abs(row->measured->response_direction) : 0;
    return measured ? measured : view->job->options.frf.axis == 0 ? 2 : 1;
}

static int write_function(FILE *stream, const struct frf_view *view, int i, double complex *h, double complex *work, double *re,
                          double *im)
{
    static const int specific[] = {8, 11, 12};
    static const char *const labels[] = {"Displacement", "Velocity", "Acceleration"}, *const units[] = {"m", "m/s", "m/s2"};
    const struct frf_result *r = view->result;
    const struct frf_row *row = &r->row[i];
    struct uff_function_writer writer;
    struct uff_function f = {.type = UFF_TRANSFER,
                             .number = i + 1,
                             .response_node = row->response,
                             .reference_node = row->reference,
                             .ordinate = UFF_COMPLEX_DOUBLE,
                             .count = r->nline,
                             .start = r->frequency_hz[0],
                             .abscissa = {.specific_type = 18, .label = "Frequency", .unit = "Hz"},
                             .numerator = {.specific_type = specific[r->quantity], .length = 1},
                             .denominator = {.specific_type = 13, .force = 1, .label = "Excitation force", .unit = "N"}};
    f.response_direction = f.reference_direction = direction_of(view, row);
    f.step = r->nline > 1 ? (r->frequency_hz[r->nline - 1] - f.start) / (r->nline - 1) : 1;
    f.is_even = 1; /* lines of a measured file and of LOW, HIGH are */
    (void)snprintf(f.id[0], sizeof f.id[0], "synthesised %s %d over %d", transfer_quantity_words[r->quantity], row->response,
                   row->reference);
    (void)snprintf(f.numerator.label, sizeof f.numerator.label, "%s", labels[r->quantity]);
    (void)snprintf(f.numerator.unit, sizeof f.numerator.unit, "%s", units[r->quantity]);
    frf_synthesised(r, i, 1, h, work);
    for (int l = 0; l < r->nline; l++) {
        re[l] = creal(h[l]);
        im[l] = cimag(h[l]);
    }
    int status = uff_write_function(stream, &f, &writer);
    if (!status)
        status = uff_write_values(&writer, r->nline, NULL, re, im);
    return status ? status : uff_end_function(&writer);
}

int frf_write_file(FILE *stream, const char *version, const struct frf_view *view)
{
    static const struct uff_units si = {1, "SI", 2, 1, 1, 1, 273.15};
    const struct frf_result *r = view->result;
    struct uff_header header = {0};
    double complex *h = POOL_ARRAY(view->pool, double complex, r->nline),
                   *work = POOL_ARRAY(view->pool, double complex, r->nline);
    double *re = POOL_ARRAY(view->pool, double, r->nline), *im = POOL_ARRAY(view->pool, double, r->nline);
    if (!h || !work || !re || !im)
        return ROTID_ERROR_MEMORY;
    (void)snprintf(header.model, sizeof header.model, "rotid frf");
    (void)snprintf(header.program, sizeof header.program, "rotid %s", version);
    int status = uff_write_header(stream, &header);
    if (!status)
        status = uff_write_units(stream, &si);
    if (!status)
        status = write_nodes(stream, view);
    for (int i = 0; i < r->ndone && !status; i++)
        status = write_function(stream, view, i, h, work, re, im);
    return status;
}
