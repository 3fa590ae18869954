#include "import/import.h"

enum { SET_NODES = 2411, VECTOR = 2, DISPLACEMENT = 8 };

struct writing {
    FILE *stream;
    struct pool scratch;
    const struct ema *ema;
    int node_count, *node; /* of the shapes, rising */
    double *value;         /* [3 * node_count] */
    int *known, *written;  /* [node_count] */
    double *difference;    /* [npoint] */
    int reference;         /* node of the hammer where the sensor roved, 0 where there are several or the hammer roved */
};

static int only_reference(const struct measurement *measurement, const struct ema *ema)
{
    const struct frf_set *set = &measurement->set;
    for (int c = 1; c < set->nfrf; c++)
        if (set->frf[c].reference_node != set->frf[0].reference_node)
            return 0;
    return ema->roving_force || !set->nfrf ? 0 : set->frf[0].reference_node;
}

#define NAME_MOST 50 /* bytes of a name in a line of text, which has 80 */

/* The name of the file without its folder, as far as it can stand in a line of text: no control characters. */
static const char *base_name(const char *path, char name[NAME_MOST + 1])
{
    const char *slash = strrchr(path, '/'), *from = slash ? slash + 1 : path;
    size_t length = 0, taken;
    for (; *from && length + text_visible(from) < NAME_MOST; from += taken) {
        size_t bytes = text_visible(from);
        taken = bytes ? bytes : text_utf8(from) ? text_utf8(from) : 1;
        memcpy(name + length, bytes ? from : "?", bytes ? bytes : 1);
        length += bytes ? bytes : 1;
    }
    name[length] = 0;
    return name;
}

ORDER_BY(by_id, int, *it, 0)

static int collect_nodes(struct writing *w)
{
    w->node = POOL_ARRAY(&w->scratch, int, w->ema->npoint);
    w->value = POOL_ARRAY(&w->scratch, double, 3 * (size_t)w->ema->npoint);
    w->known = POOL_ARRAY(&w->scratch, int, w->ema->npoint);
    w->written = POOL_ARRAY(&w->scratch, int, w->ema->npoint);
    w->difference = POOL_ARRAY(&w->scratch, double, w->ema->npoint);
    if (!w->node || !w->value || !w->known || !w->written || !w->difference)
        return ROTID_ERROR_MEMORY;
    memcpy(w->node, w->ema->point_node, (size_t)w->ema->npoint * sizeof *w->node);
    qsort(w->node, (size_t)w->ema->npoint, sizeof *w->node, by_id);
    for (int i = 0; i < w->ema->npoint; i++)
        if (!i || w->node[i] != w->node[w->node_count - 1])
            w->node[w->node_count++] = w->node[i];
    return ROTID_OK;
}

static int write_nodes(const struct writing *w, const struct measurement *measurement)
{
    struct pool scratch;
    int count = 0;
    pool_open(&scratch, w->scratch.allocator);
    struct uff_node *node = POOL_ARRAY(&scratch, struct uff_node, w->node_count);
    int status = node ? ROTID_OK : ROTID_ERROR_MEMORY;
    for (int i = 0, j = 0; i < w->node_count && !status; i++) {
        while (j < measurement->node_count && measurement->node[j].id < w->node[i])
            j++;
        if (j < measurement->node_count && measurement->node[j].id == w->node[i])
            node[count++] = measurement->node[j];
    }
    if (!status && count)
        status = uff_write_nodes(w->stream, SET_NODES, count, node);
    pool_close(&scratch);
    return status;
}

/* One set 55 of the nodes that have a value: the component of each goes to the axis of its direction, directions without one
 * (scalars) to the first. Rotations have no place in a vector of three and are left out. */
static int write_values(struct writing *w, struct uff_shape *shape, const double *value)
{
    const struct ema *ema = w->ema;
    int count = 0;
    memset(w->value, 0, 3 * (size_t)w->node_count * sizeof *w->value);
    memset(w->known, 0, (size_t)w->node_count * sizeof *w->known);
    for (int p = 0; p < ema->npoint; p++) {
        const int *at = bsearch(&ema->point_node[p], w->node, (size_t)w->node_count, sizeof *w->node, by_id);
        int direction = abs(ema->point_direction[p]);
        if (!at || direction > 3 || !isfinite(value[p]))
            continue;
        w->value[3 * (at - w->node) + (direction ? direction - 1 : 0)] = value[p];
        w->known[at - w->node] = 1;
    }
    for (int i = 0; i < w->node_count; i++)
        if (w->known[i]) {
            w->written[count] = w->node[i];
            memmove(w->value + 3 * (ptrdiff_t)count++, w->value + 3 * (ptrdiff_t)i, 3 * sizeof *w->value);
        }
    if (!count && w->node_count) { /* a set without nodes would be all zeros to others: one zero says the same */
        w->written[count++] = w->node[0];
        memset(w->value, 0, 3 * sizeof *w->value);
    }
    shape->model_type = 1;
    shape->data_characteristic = VECTOR;
    shape->data_type = REAL_DATA;
    shape->load_case = 1;
    shape->component_count = 3;
    shape->node_count = count;
    shape->node = w->written;
    shape->real = w->value;
    return uff_write_shape(w->stream, shape);
}

static int write_companion(struct writing *w, int number, const char *what, const struct ema_mode *mode, const double *value)
{
    struct uff_shape shape = {.analysis_type = UNKNOWN_ANALYSIS, .specific_type = 0, .number = number};
    (void)snprintf(shape.id[0], sizeof shape.id[0], "ROTID %s OF MODE %d", what, number);
    if (mode)
        (void)snprintf(shape.id[1], sizeof shape.id[1], "FREQUENCY_HZ %.10e DAMPING %.10e", mode->frequency_std,
                       isfinite(mode->damping_std) ? mode->damping_std : 0);
    if (mode && (w->ema->tests || (w->ema->impacts && w->ema->std_from_impacts)))
        (void)snprintf(shape.id[2], sizeof shape.id[2], w->ema->tests ? "TESTS %d" : "IMPACTS %d",
                       w->ema->tests ? w->ema->tests : w->ema->impacts);
    return write_values(w, &shape, value);
}

/* As differences: the format has six digits. */
static int write_points(struct writing *w, int number, const struct ema_mode *mode)
{
    struct uff_shape shape = {.analysis_type = UNKNOWN_ANALYSIS, .specific_type = 0, .number = number};
    for (int p = 0; p < w->ema->npoint; p++)
        w->difference[p] = mode->point_frequency_hz[p] - mode->frequency_hz;
    (void)snprintf(shape.id[0], sizeof shape.id[0], "ROTID FREQUENCY AT POINT OF MODE %d", number);
    (void)snprintf(shape.id[1], sizeof shape.id[1], "ABOVE_HZ %.12g", mode->frequency_hz);
    return write_values(w, &shape, w->difference);
}

static int write_mode(struct writing *w, const char *source, int k)
{
    const struct ema_mode *mode = &w->ema->mode[k];
    char name[NAME_MOST + 1];
    struct uff_shape shape = {.analysis_type = NORMAL_MODE,
                              .specific_type = DISPLACEMENT,
                              .number = k + 1,
                              .frequency_hz = mode->frequency_hz,
                              .damping = isfinite(mode->damping) ? mode->damping : 0,
                              .modal_mass = isfinite(mode->modal_mass) ? mode->modal_mass : 0};
    (void)snprintf(shape.id[0], sizeof shape.id[0], "mode %d, %.6g Hz, real normal mode", k + 1, mode->frequency_hz);
    (void)snprintf(shape.id[1], sizeof shape.id[1], "from %s", base_name(source, name));
    (void)snprintf(shape.id[2], sizeof shape.id[2], "MPC %.4f MPD %.2f deg", mode->mpc, mode->mpd);
    (void)snprintf(shape.id[4], sizeof shape.id[4], "ROTID FREQUENCY_HZ %.12g", mode->frequency_hz);
    if (w->reference)
        (void)snprintf(shape.id[3], sizeof shape.id[3], "ROTID HAMMER AT NODE %d", w->reference);
    int status = write_values(w, &shape, mode->shape);
    if (!status && isfinite(mode->frequency_std))
        status = write_companion(w, k + 1, "STANDARD DEVIATION", mode, mode->shape_std);
    if (!status && mode->point_frequency_hz)
        status = write_points(w, k + 1, mode);
    if (!status && mode->point_frequency_hz)
        status = write_companion(w, k + 1, "STANDARD DEVIATION OF FREQUENCY AT POINT", NULL, mode->point_frequency_std);
    return status;
}

int modes_write(FILE *stream, const char *source, const char *program, const struct measurement *measurement,
                const struct ema *ema)
{
    static const struct uff_units si = {1, "SI", 2, 1, 1, 1, 273.15};
    struct uff_header header = {.version = {0, 0}};
    char name[NAME_MOST + 1];
    struct writing w = {.stream = stream, .ema = ema, .reference = only_reference(measurement, ema)};
    pool_open(&w.scratch, NULL);
    (void)snprintf(header.model, sizeof header.model, "modes");
    (void)snprintf(header.description, sizeof header.description, "modal extraction from %s", base_name(source, name));
    (void)snprintf(header.program, sizeof header.program, "%.70s", program);
    int status = collect_nodes(&w);
    if (!status)
        status = uff_write_header(stream, &header);
    if (!status)
        status = uff_write_units(stream, &si);
    if (!status)
        status = write_nodes(&w, measurement);
    for (int k = 0; k < ema->nmode && !status; k++)
        status = write_mode(&w, source, k);
    pool_close(&w.scratch);
    return status;
}
