#include "report/json_uff.h"

#include <math.h>
#include <string.h>

#include "import/names.h"
#include "result/json_tree.h"

static void add_text_or_null(struct json_tree *tree, cJSON *parent, const char *key, const char *text)
{
    json_text(tree, parent, key, *text ? text : NULL);
}

static void add_ids(struct json_tree *tree, cJSON *parent, const char (*id)[UFF_TEXT + 1])
{
    cJSON *array = json_array(tree, parent, "id");
    for (int i = 0; i < UFF_ID_LINES; ++i)
        add_text_or_null(tree, array, NULL, id[i]);
}

static void add_sets(struct json_tree *tree, const struct listing *listing)
{
    cJSON *sets = json_array(tree, tree->root, "sets");
    for (int i = 0; i < listing->set_count; ++i) {
        const struct listing_set *set = &listing->set[i];
        cJSON *item = json_object(tree, sets, NULL);
        json_number(tree, item, "line", set->set.line);
        json_number(tree, item, "set", set->set.number);
        json_flag(tree, item, "binary", set->set.is_binary);
        json_text(tree, item, "name", name_of_set(set->set.number));
        json_text(tree, item, "state", set->is_faulty ? "malformed" : set->is_read ? "read" : "not_known");
        json_number(tree, item, "count", (double)set->size);
    }
}

static void add_units(struct json_tree *tree, const struct uff_units *units)
{
    if (!units) {
        json_null(tree, tree->root, "units");
        return;
    }
    cJSON *item = json_object(tree, tree->root, "units");
    json_number(tree, item, "code", units->code);
    json_text(tree, item, "name", name_of_units(units->code));
    add_text_or_null(tree, item, "description", units->description);
    json_number(tree, item, "length", units->length);
    json_number(tree, item, "force", units->force);
    json_number(tree, item, "temperature", units->temperature);
    json_number(tree, item, "temperature_offset", units->temperature_offset);
}

static void add_header(struct json_tree *tree, const struct uff_header *header)
{
    if (!header) {
        json_null(tree, tree->root, "header");
        return;
    }
    cJSON *item = json_object(tree, tree->root, "header");
    add_text_or_null(tree, item, "model", header->model);
    add_text_or_null(tree, item, "description", header->description);
    add_text_or_null(tree, item, "program", header->program);
    add_text_or_null(tree, item, "created", header->created);
    add_text_or_null(tree, item, "saved", header->saved);
    add_text_or_null(tree, item, "written_by", header->written_by);
    add_text_or_null(tree, item, "written", header->written);
}

static void add_axis(struct json_tree *tree, cJSON *parent, const char *key, const struct uff_axis *axis)
{
    cJSON *item = json_object(tree, parent, key);
    json_number(tree, item, "data_type", axis->specific_type);
    add_text_or_null(tree, item, "label", axis->label);
    add_text_or_null(tree, item, "unit", axis->unit);
}

static void add_values(struct json_tree *tree, cJSON *item, const struct values *v)
{
    json_number(tree, item, "min", v->count ? v->min : NAN);
    json_number(tree, item, "max", v->count ? v->max : NAN);
    json_number(tree, item, "rms", v->count ? v->rms : NAN);
    json_list(tree, item, "first", v->count ? 2 : 0, v->first);
    json_list(tree, item, "last", v->count ? 2 : 0, v->last);
    json_list(tree, item, "sum", 2, v->sum);
}

static void add_function(struct json_tree *tree, cJSON *list, const struct listing_function *entry)
{
    const struct uff_function *f = &entry->function;
    cJSON *item = json_object(tree, list, NULL);
    char place[PLACE_TEXT];
    json_number(tree, item, "line", f->line);
    json_number(tree, item, "type", f->type);
    json_text(tree, item, "kind", name_of_function(f->type, 0));
    add_ids(tree, item, f->id);
    json_text(tree, item, "response", place_text(f->response_node, f->response_direction, place));
    json_text(tree, item, "reference", place_text(f->reference_node, f->reference_direction, place));
    json_number(tree, item, "response_node", f->response_node);
    json_number(tree, item, "response_direction", f->response_direction);
    json_number(tree, item, "reference_node", f->reference_node);
    json_number(tree, item, "reference_direction", f->reference_direction);
    json_number(tree, item, "ordinate", f->ordinate);
    json_text(tree, item, "ordinate_name", name_of_ordinate(f->ordinate));
    json_flag(tree, item, "binary", f->binary.is_binary);
    json_number(tree, item, "count", (double)f->count);
    json_flag(tree, item, "even", f->is_even);
    json_number(tree, item, "start", entry->values.x_first);
    json_number(tree, item, "step", f->is_even ? f->step : NAN);
    json_number(tree, item, "end", entry->values.x_last);
    json_flag(tree, item, "time", has_time_axis(f));
    json_number(tree, item, "sampling_rate_hz", has_time_axis(f) && f->is_even ? 1 / (f->step * entry->x_si_factor) : NAN);
    add_axis(tree, item, "abscissa", &f->abscissa);
    add_axis(tree, item, "numerator", &f->numerator);
    add_axis(tree, item, "denominator", &f->denominator);
    json_number(tree, item, "si_factor", entry->si_factor);
    json_number(tree, item, "abscissa_si_factor", entry->x_si_factor);
    add_values(tree, item, &entry->values);
}

static void add_shape(struct json_tree *tree, cJSON *list, const struct listing_shape *entry)
{
    const struct uff_shape *s = &entry->shape;
    cJSON *item = json_object(tree, list, NULL);
    json_number(tree, item, "line", s->line);
    add_ids(tree, item, s->id);
    json_number(tree, item, "analysis_type", s->analysis_type);
    json_text(tree, item, "analysis", name_of_analysis(s->analysis_type));
    json_number(tree, item, "mode", s->number);
    json_number(tree, item, "frequency_hz", s->frequency_hz);
    json_number(tree, item, "damping", s->damping);
    json_flag(tree, item, "complex", s->is_complex);
    json_number(tree, item, "components", s->component_count);
    json_number(tree, item, "node_count", s->node_count);
    json_list(tree, item, "sum", 2, entry->sum);
    json_number(tree, item, "rms", entry->rms);
    if (!s->node)
        return;
    cJSON *nodes = json_array(tree, item, "nodes");
    for (int i = 0; i < s->node_count && nodes; ++i)
        json_number(tree, nodes, NULL, s->node[i]);
    int values = s->component_count * s->node_count;
    json_list(tree, item, "real", values, s->real);
    json_list(tree, item, "imag", s->imag ? values : 0, s->imag);
}

static void add_nodes(struct json_tree *tree, const struct listing *listing, int all)
{
    cJSON *item = json_object(tree, tree->root, "nodes");
    double least[3] = {NAN, NAN, NAN}, most[3] = {NAN, NAN, NAN};
    for (int i = 0; i < listing->node_count; ++i)
        for (int c = 0; c < 3; ++c) {
            least[c] = fmin(least[c], listing->node[i].x[c]); /* fmin and fmax pass over what is not a number */
            most[c] = fmax(most[c], listing->node[i].x[c]);
        }
    json_number(tree, item, "count", listing->node_count);
    json_list(tree, item, "min", 3, least);
    json_list(tree, item, "max", 3, most);
    if (!all)
        return;
    cJSON *ids = json_array(tree, item, "ids"), *x = json_array(tree, item, "x");
    for (int i = 0; i < listing->node_count; ++i) {
        json_number(tree, ids, NULL, listing->node[i].id);
        json_list(tree, x, NULL, 3, listing->node[i].x);
    }
}

static void add_doubts(struct json_tree *tree, const struct listing *listing)
{
    cJSON *list = json_array(tree, tree->root, "doubtful");
    for (size_t i = 0; i < listing->doubt_count; ++i) {
        cJSON *item = json_object(tree, list, NULL);
        json_text(tree, item, "kind", listing->doubt[i].kind);
        json_number(tree, item, "line", listing->doubt[i].line > 0 ? (double)listing->doubt[i].line : (double)NAN);
        json_text(tree, item, "text", listing->doubt[i].text);
    }
}

/* What stopped the reader in malformed sets, with its place. */
static void add_errors(struct json_tree *tree, const struct message_list *messages)
{
    cJSON *list = json_array(tree, tree->root, "errors");
    for (size_t i = 0; i < messages->count; ++i) {
        const struct message *message = &messages->item[i];
        if (message->severity != SEVERITY_ERROR)
            continue;
        cJSON *item = json_object(tree, list, NULL);
        json_number(tree, item, "line", message->line);
        json_number(tree, item, "column", message->column);
        json_text(tree, item, "text", message->text);
    }
}

char *json_uff(const struct provenance *provenance, const char *path, const struct listing *listing, int summary_count,
               const char *const *summary, int all, const struct message_list *messages)
{
    struct json_tree tree;
    json_open(&tree);
    json_provenance(&tree, provenance);
    json_text(&tree, tree.root, "file", path);
    cJSON *lines = json_array(&tree, tree.root, "summary");
    for (int i = 0; i < summary_count; ++i)
        json_text(&tree, lines, NULL, summary[i]);
    add_header(&tree, listing->header);
    add_units(&tree, listing->units);
    add_sets(&tree, listing);
    add_nodes(&tree, listing, all);
    json_number(&tree, tree.root, "elements", (double)listing->element_count);
    json_number(&tree, tree.root, "trace_lines", listing->trace_count);
    json_number(&tree, tree.root, "coordinate_systems", listing->system_count);
    json_number(&tree, tree.root, "analyses", (double)listing->analysis_count);
    cJSON *functions = json_array(&tree, tree.root, "functions");
    for (int i = 0; i < listing->function_count; ++i)
        add_function(&tree, functions, &listing->function[i]);
    cJSON *shapes = json_array(&tree, tree.root, "shapes");
    for (int i = 0; i < listing->shape_count; ++i)
        add_shape(&tree, shapes, &listing->shape[i]);
    add_doubts(&tree, listing);
    add_errors(&tree, messages);
    return json_close(&tree);
}
