#include "report/report.h"

#include <math.h>

#include "import/import.h"
#include "result/result.h"

static const char *text_or_null(const char *text)
{
    return *text ? text : NULL;
}

static struct listed_axis axis(const struct uff_axis *axis)
{
    return (struct listed_axis){axis->specific_type, text_or_null(axis->label), text_or_null(axis->unit)};
}

/* NULL: memory is out; of all below. */
static struct listed_set *sets(struct pool *pool, const struct listing *listing)
{
    struct listed_set *list = POOL_ARRAY(pool, struct listed_set, listing->set_count);
    for (int i = 0; i < listing->set_count && list; ++i) {
        const struct listing_set *set = &listing->set[i];
        list[i] = (struct listed_set){.line = set->set.line,
                                      .set = set->set.number,
                                      .binary = set->set.is_binary,
                                      .name = name_of_set(set->set.number),
                                      .state = set->is_faulty                 ? "malformed"
                                               : set->is_read                 ? "read"
                                               : name_of_set(set->set.number) ? "read_over"
                                                                              : "not_known",
                                      .count = (double)set->size};
    }
    return list;
}

static struct listed_function *functions(struct pool *pool, const struct listing *listing)
{
    struct listed_function *list = POOL_ARRAY(pool, struct listed_function, listing->function_count);
    for (int i = 0; i < listing->function_count && list; ++i) {
        const struct uff_function *f = &listing->function[i].function;
        const struct values *v = &listing->function[i].values;
        int timed = has_time_axis(f);
        char place[2][PLACE_MOST];
        list[i] = (struct listed_function){
            .line = f->line,
            .type = f->type,
            .kind = name_of_function(f->type, 0),
            .response = pool_copy_text(pool, place_text(f->response_node, f->response_direction, place[0])),
            .reference = pool_copy_text(pool, place_text(f->reference_node, f->reference_direction, place[1])),
            .response_node = f->response_node,
            .response_direction = f->response_direction,
            .reference_node = f->reference_node,
            .reference_direction = f->reference_direction,
            .ordinate = f->ordinate,
            .ordinate_name = name_of_ordinate(f->ordinate),
            .binary = f->binary.is_binary,
            .count = (double)f->count,
            .even = f->is_even,
            .start = v->x_first,
            .step = f->is_even ? f->step : NAN,
            .end = v->x_last,
            .time = timed,
            .sampling_rate_hz = timed && f->is_even ? 1 / (f->step * listing->function[i].x_si_factor) : NAN,
            .abscissa = axis(&f->abscissa),
            .numerator = axis(&f->numerator),
            .denominator = axis(&f->denominator),
            .si_factor = listing->function[i].si_factor,
            .abscissa_si_factor = listing->function[i].x_si_factor,
            .min = v->count ? v->min : NAN,
            .max = v->count ? v->max : NAN,
            .rms = v->count ? v->rms : NAN,
            .nfirst = v->count ? 2 : 0,
            .nlast = v->count ? 2 : 0,
            .first = v->first,
            .last = v->last,
            .sum = {v->sum[0], v->sum[1]},
        };
        for (int k = 0; k < LISTED_ID_LINES; ++k)
            list[i].id[k] = text_or_null(f->id[k]);
        if (!list[i].response || !list[i].reference)
            return NULL;
    }
    return list;
}

static struct listed_shape *shapes(struct pool *pool, const struct listing *listing)
{
    struct listed_shape *list = POOL_ARRAY(pool, struct listed_shape, listing->shape_count);
    for (int i = 0; i < listing->shape_count && list; ++i) {
        const struct listing_shape *entry = &listing->shape[i];
        const struct uff_shape *s = &entry->shape;
        int values = s->component_count * s->node_count;
        list[i] = (struct listed_shape){.line = s->line,
                                        .analysis_type = s->analysis_type,
                                        .analysis = name_of_analysis(s->analysis_type),
                                        .mode = s->number,
                                        .frequency_hz = s->frequency_hz,
                                        .damping = s->damping,
                                        .is_complex = s->is_complex,
                                        .components = s->component_count,
                                        .node_count = s->node_count,
                                        .sum = {entry->sum[0], entry->sum[1]},
                                        .rms = entry->rms,
                                        .nnodes = s->node_count,
                                        .nodes = s->node,
                                        .nreal = values,
                                        .real = s->real,
                                        .nimag = s->imag ? values : 0,
                                        .imag = s->imag};
        for (int k = 0; k < LISTED_ID_LINES; ++k)
            list[i].id[k] = text_or_null(s->id[k]);
    }
    return list;
}

/* 0: memory is out. */
static int add_nodes(struct pool *pool, const struct listing *listing, int all, struct listed_nodes *out)
{
    int n = listing->node_count;
    *out = (struct listed_nodes){.count = n, .min = {NAN, NAN, NAN}, .max = {NAN, NAN, NAN}, .nids = n, .nx = 3};
    int *ids = all ? POOL_ARRAY(pool, int, n) : NULL;
    double *coordinates = all ? POOL_ARRAY(pool, double, 3 * (size_t)n) : NULL;
    out->ids = ids;
    out->x = coordinates;
    if (all && (!ids || !coordinates))
        return 0;
    for (int i = 0; i < n; ++i) {
        const double *x = listing->node[i].x;
        for (int c = 0; c < 3; ++c) {
            out->min[c] = fmin(out->min[c], x[c]); /* fmin and fmax pass over what is not a number */
            out->max[c] = fmax(out->max[c], x[c]);
            if (all)
                coordinates[i + (ptrdiff_t)c * n] = x[c];
        }
        if (all)
            ids[i] = listing->node[i].id;
    }
    return 1;
}

static int add_doubts(struct pool *pool, const struct listing *listing, struct uff_result *out)
{
    out->doubtful = POOL_ARRAY(pool, struct listed_doubt, listing->finding_count);
    for (int i = 0; i < listing->finding_count && out->doubtful; ++i) {
        const struct listing_finding *doubt = &listing->doubt[i];
        out->doubtful[out->ndoubtful++] =
            (struct listed_doubt){doubt->kind, doubt->line > 0 ? doubt->line : ROTID_NONE, doubt->text};
    }
    return out->doubtful != NULL;
}

/* What stopped the reader in malformed sets, with its place. */
static int add_errors(struct pool *pool, const struct message_list *messages, struct uff_result *out)
{
    out->errors = POOL_ARRAY(pool, struct listed_error, messages->count);
    for (size_t i = 0; i < messages->count && out->errors; ++i) {
        const rotid_message *message = &messages->item[i];
        if (message->severity == SEVERITY_ERROR)
            out->errors[out->nerrors++] = (struct listed_error){message->line, message->column, message->text};
    }
    return out->errors != NULL;
}

static struct listed_header *header(struct pool *pool, const struct uff_header *h)
{
    struct listed_header *out = POOL_NEW(pool, struct listed_header);
    if (out)
        *out = (struct listed_header){text_or_null(h->model),   text_or_null(h->description), text_or_null(h->program),
                                      text_or_null(h->created), text_or_null(h->saved),       text_or_null(h->written_by),
                                      text_or_null(h->written)};
    return out;
}

static struct listed_units *units(struct pool *pool, const struct uff_units *u)
{
    struct listed_units *out = POOL_NEW(pool, struct listed_units);
    if (out)
        *out = (struct listed_units){u->code,  name_of_units(u->code), text_or_null(u->description), u->length,
                                     u->force, u->temperature,         u->temperature_offset};
    return out;
}

const struct uff_result *uff_result_of(struct pool *pool, const char *path, const struct listing *listing, int summary_count,
                                       const char *const *summary, int all, const struct message_list *messages)
{
    struct uff_result *out = POOL_NEW(pool, struct uff_result);
    if (!out)
        return NULL;
    *out = (struct uff_result){.file = path,
                               .nsummary = summary_count,
                               .summary = summary,
                               .nsets = listing->set_count,
                               .nfunctions = listing->function_count,
                               .nshapes = listing->shape_count,
                               .header = listing->header ? header(pool, listing->header) : NULL,
                               .units = listing->units ? units(pool, listing->units) : NULL,
                               .sets = sets(pool, listing),
                               .functions = functions(pool, listing),
                               .shapes = shapes(pool, listing)};
    int whole =
        (out->header || !listing->header) && (out->units || !listing->units) && out->sets && out->functions && out->shapes;
    whole =
        whole && add_nodes(pool, listing, all, &out->nodes) && add_doubts(pool, listing, out) && add_errors(pool, messages, out);
    return whole ? out : NULL;
}
