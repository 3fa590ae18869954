#include "report/json.h"

#include "result/json_tree.h"

static void add_growth(struct json_tree *tree, const struct growth *growth)
{
    static const char *const keys[GROWTH_KINDS] = {[GROWTH_E] = "hybrid", [GROWTH_F] = "hybrid_f"};
    if (!growth->points) {
        json_null(tree, tree->root, "functional_growth");
        return;
    }
    cJSON *item = json_object(tree, tree->root, "functional_growth");
    json_list(tree, item, "epsilon_squared", growth->points, growth->epsilon2);
    for (int kind = 0; kind < GROWTH_KINDS; kind++) {
        cJSON *one = json_object(tree, item, keys[kind]);
        json_list(tree, one, "objective", growth->points, growth->f[kind]);
        json_number(tree, one, "slope", growth->slope[kind]);
        json_number(tree, one, "intercept", growth->intercept[kind]);
    }
    json_list(tree, item, "shapes_alone", growth->points, growth->shapes_alone);
}

char *json_sensitivity(const struct provenance *provenance, const struct job *job, const rotid_parameter *parameter,
                       const struct sensitivity_options *options, const struct sensitivity *result)
{
    struct json_tree tree;
    json_begin(&tree, provenance, job);
    json_text(&tree, tree.root, "reduction", reduction_name(job->fit.reduction));
    json_number(&tree, tree.root, "step", options->step);
    json_list(&tree, tree.root, "frequency_hz", result->m, result->hz);
    json_list(&tree, tree.root, "relative_value", result->points, result->relative);
    cJSON *list = json_array(&tree, tree.root, "parameters");
    for (int p = 0; p < result->n; p++) {
        cJSON *item = json_object(&tree, list, NULL);
        json_text(&tree, item, "name", parameter[p].name);
        json_text(&tree, item, "unit", parameter[p].unit);
        json_number(&tree, item, "reference", result->reference[p]);
        json_list(&tree, item, "sensitivity", result->m, result->difference + (ptrdiff_t)p * result->m);
        json_list(&tree, item, "derivative", result->m, result->derivative + (ptrdiff_t)p * result->m);
        json_matrix(&tree, item, "curves", result->m, result->points, result->curve + (ptrdiff_t)p * result->m * result->points);
    }
    add_growth(&tree, &result->growth);
    return json_close(&tree);
}
