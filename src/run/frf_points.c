#include "run/frf_points.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static int refuse_points(struct message_list *notes, const struct job *job, const char *format, int id)
{
    message_add(notes, SEVERITY_ERROR, job->deck, 1, 1, format, id);
    return ROTID_ERROR_ARGUMENT;
}

/* ------------------------------------------------------------------------------------------------ rows */

/* A lateral motion for a lateral force along the same axis: what a beam in one plane knows. Direction 0 is taken for one. */
static int is_lateral(const struct frf *frf, int axis)
{
    int response = abs(frf->response_direction), reference = abs(frf->reference_direction);
    return response <= 3 && reference <= 3 && (!response || !reference || response == reference) && response != axis + 1 &&
           reference != axis + 1;
}

static double sign_of(const struct frf *frf)
{
    return (frf->response_direction < 0) == (frf->reference_direction < 0) ? 1 : -1;
}

struct chooser {
    struct pool *pool;
    struct frf_result *out;
    size_t room;
    int out_of_memory;
};

static void take(struct chooser *chooser, int response, int reference, const struct frf *frf)
{
    struct frf_result *out = chooser->out;
    struct frf_row *rows = pool_grow(chooser->pool, out->row, (size_t)out->nrow, &chooser->room, sizeof *rows);
    if (!rows) {
        chooser->out_of_memory = 1;
        return;
    }
    out->row = rows;
    out->row[out->nrow++] = (struct frf_row){.response = response,
                                             .reference = reference,
                                             .measured = frf,
                                             .sign = frf ? sign_of(frf) : 1,
                                             .is_reciprocal = frf && frf->response_node != response};
}

/* The functions of a pair, those measured with force and response exchanged only where there is none the right way round. How
 * many there are. */
static int take_pair(struct chooser *chooser, const struct frf_set *set, struct frf_pair pair, int axis)
{
    int found = 0;
    for (int swapped = 0; swapped < 2 && !found; swapped++)
        for (int c = 0; c < set->nfrf; c++) {
            const struct frf *frf = &set->frf[c];
            int response = swapped ? frf->reference_node : frf->response_node,
                reference = swapped ? frf->response_node : frf->reference_node;
            if (response != pair.response || reference != pair.reference || !is_lateral(frf, axis))
                continue;
            take(chooser, response, reference, frf);
            found++;
        }
    return found;
}

static int requested_rows(struct chooser *chooser, const struct job *job, const struct frf_measured *measured,
                          struct message_list *notes)
{
    const struct frf_request *request = &job->options.frf;
    for (int i = 0; i < request->npair; i++)
        if (!take_pair(chooser, measured->set, request->pair[i], request->axis)) {
            message_add(
                notes, SEVERITY_ERROR, measured->path, 1, 1,
                "there is no lateral transfer function between %d and %d, expected what *FRF names, or the axis of the rotor "
                "as AXIS on that card",
                request->pair[i].response, request->pair[i].reference);
            return ROTID_ERROR_ARGUMENT;
        }
    return ROTID_OK;
}

static int all_rows(struct chooser *chooser, const struct job *job, const struct frf_set *set, struct message_list *notes)
{
    int axis = job->options.frf.axis;
    for (int c = 0; c < set->nfrf; c++)
        if (is_lateral(&set->frf[c], axis))
            take(chooser, set->frf[c].response_node, set->frf[c].reference_node, &set->frf[c]);
    if (!chooser->out->nrow)
        return refuse_points(
            notes, job,
            "none of the %d measured transfer functions is lateral, expected response and force along one axis other "
            "than that of the rotor, AXIS on *FRF",
            set->nfrf);
    chooser->out->nleft_out = set->nfrf - chooser->out->nrow;
    if (chooser->out->nleft_out)
        message_add(
            notes, SEVERITY_WARNING, NULL, 0, 0,
            "%d measured transfer functions are left out: not lateral (AXIS=%s is that of the rotor), or response and force "
            "along different axes",
            chooser->out->nleft_out,
            axis == 0   ? "X"
            : axis == 1 ? "Y"
                        : "Z");
    return ROTID_OK;
}

int frf_choose_rows(struct pool *pool, const struct job *job, const struct frf_measured *measured, struct message_list *notes,
                    struct frf_result *out)
{
    const struct rotor *rotor = &job->rotor;
    const struct frf_request *request = &job->options.frf;
    struct chooser chooser = {.pool = pool, .out = out};
    int status = ROTID_OK;
    if (measured)
        status = request->npair ? requested_rows(&chooser, job, measured, notes) : all_rows(&chooser, job, measured->set, notes);
    else if (!request->npair && !rotor->nsensor)
        status = refuse_points(notes, job, "the deck has %d sensors, expected *SENSORS, the points of the transfer functions", 0);
    for (int i = 0; i < request->npair && !measured; i++)
        take(&chooser, request->pair[i].response, request->pair[i].reference, NULL);
    for (int s = 0; s < rotor->nsensor && !measured && !request->npair; s++)
        take(&chooser, rotor->sensor[s].id, rotor->sensor[0].id, NULL);
    return chooser.out_of_memory ? ROTID_ERROR_MEMORY : status;
}

/* ------------------------------------------------------------------------------------------------ points */

struct placed {
    int id, is_sensor;
    double z;
};

static int by_id(const void *left, const void *right)
{
    const struct placed *a = left, *b = right;
    return (a->id > b->id) - (a->id < b->id);
}

static int node_position(const struct job *job, const struct frf_measured *measured, struct message_list *notes,
                         struct placed *point)
{
    double *z = &point->z;
    int id = point->id;
    const struct frf_request *request = &job->options.frf;
    double length = rotor_length(&job->rotor);
    for (int s = 0; s < job->rotor.nsensor; s++)
        if (job->rotor.sensor[s].id == id) {
            *z = job->rotor.sensor[s].position;
            point->is_sensor = 1;
            return ROTID_OK;
        }
    for (int i = 0; measured && i < measured->nnode; i++)
        if (measured->node[i].id == id) {
            *z = request->origin + (request->flip ? -1 : 1) * measured->node[i].x[request->axis];
            if (*z >= -1e-5 * length && *z <= length * (1 + 1e-5)) { /* coordinates of files carry six digits */
                *z = fmin(fmax(*z, 0), length);
                return ROTID_OK;
            }
            message_add(
                notes, SEVERITY_ERROR, measured->path, 1, 1,
                "node %d lies at %.6g m of the model, outside the rotor, expected 0 to %.6g m: check AXIS, ORIGIN, FLIP and "
                "the unit",
                id, *z, length);
            return ROTID_ERROR_ARGUMENT;
        }
    return refuse_points(
        notes, job, "point %d of the transfer functions has no position, expected it in *SENSORS or among the nodes of the file",
        id);
}

/* The distinct points of the rows by id, with their positions. */
static int distinct_points(struct pool *pool, const struct job *job, const struct frf_measured *measured,
                           struct message_list *notes, const struct frf_result *out, struct placed **points, int *count)
{
    struct placed *all = POOL_ARRAY(pool, struct placed, 2 * (size_t)out->nrow);
    int kept = 0;
    *points = all;
    if (!all)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < 2 * out->nrow; i++)
        all[i].id = i % 2 ? out->row[i / 2].reference : out->row[i / 2].response;
    qsort(all, 2 * (size_t)out->nrow, sizeof *all, by_id);
    for (int i = 0; i < 2 * out->nrow; i++) {
        if (kept && all[i].id == all[kept - 1].id)
            continue;
        all[kept].id = all[i].id;
        int status = node_position(job, measured, notes, &all[kept]);
        if (status)
            return status;
        kept++;
    }
    *count = kept;
    return ROTID_OK;
}

/* A disk without mass makes the mesh have a node where it is, behind all others so that parameters find theirs. Another sensor
 * would share the mass of an accelerometer that goes from sensor to sensor. */
static int add_nodes(struct pool *pool, int count, const struct placed *point, struct rotor *rotor)
{
    struct disk *disk = POOL_ARRAY(pool, struct disk, rotor->ndisk + count);
    if (!disk)
        return ROTID_ERROR_MEMORY;
    if (rotor->ndisk)
        memcpy(disk, rotor->disk, (size_t)rotor->ndisk * sizeof *disk);
    for (int i = 0; i < count; i++)
        if (!point[i].is_sensor)
            disk[rotor->ndisk++] = (struct disk){.position = point[i].z};
    rotor->disk = disk;
    return ROTID_OK;
}

static int find(const struct placed *point, int count, int id)
{
    struct placed key = {.id = id};
    const struct placed *found = bsearch(&key, point, (size_t)count, sizeof *point, by_id);
    return (int)(found - point);
}

int frf_place_points(struct pool *pool, const struct job *job, int parameters, const struct frf_measured *measured,
                     struct message_list *notes, const struct frf_result *out, struct rotor_model *model,
                     struct synthesis_pair *pair, int *dof, int *npoint)
{
    struct rotor rotor = job->rotor;
    struct placed *point;
    int failed, status = distinct_points(pool, job, measured, notes, out, &point, npoint);
    if (!status)
        status = add_nodes(pool, *npoint, point, &rotor);
    if (!status)
        status = model_open(pool, job->models, &rotor, parameters ? job->unknowns.nparameter : 0, job->unknowns.parameter, 1,
                            model, &failed);
    for (int i = 0; i < *npoint && !status; i++)
        dof[i] = model_lateral_dof(model, point[i].z);
    for (int i = 0; i < out->nrow && !status; i++) {
        struct frf_row *row = &out->row[i];
        pair[i].response = find(point, *npoint, row->response);
        pair[i].reference = find(point, *npoint, row->reference);
        row->response_z = point[pair[i].response].z;
        row->reference_z = point[pair[i].reference].z;
    }
    return status;
}
