#include "report/json_geometry.h"

#include <math.h>

#include "base/pool.h"
#include "diagnose/causes/catalogue.h"

static void add_material(struct json_tree *tree, cJSON *owner, const struct material *material)
{
    cJSON *item = json_object(tree, owner, "material");
    json_text(tree, item, "name", material->name);
    json_number(tree, item, "e_pa", material->e);
    json_number(tree, item, "g_pa", material_shear_modulus(material));
    json_number(tree, item, "nu", material->nu);
    json_number(tree, item, "rho_kg_m3", material->rho);
}

static void add_segment(struct json_tree *tree, cJSON *list, const struct segment *segment, double from)
{
    cJSON *item = json_object(tree, list, NULL);
    json_rounded(tree, item, "from_m", from);
    json_rounded(tree, item, "to_m", from + segment->length);
    json_number(tree, item, "elements", segment->elements);
    if (segment->rectangular) {
        json_rounded(tree, item, "height_m", segment->height);
        json_rounded(tree, item, "width_m", segment->width);
        return;
    }
    json_rounded(tree, item, "outer_m", segment->outer);
    json_rounded(tree, item, "inner_m", segment->inner);
    if (segment->stiff_outer != segment->outer)
        json_rounded(tree, item, "stiff_outer_m", segment->stiff_outer);
    else
        json_null(tree, item, "stiff_outer_m");
}

static void add_groups(struct json_tree *tree, cJSON *geometry, const struct rotor *rotor)
{
    cJSON *list = json_array(tree, geometry, "groups");
    for (int g = 0; g < rotor->ngroup; g++) {
        const struct group *group = &rotor->group[g];
        cJSON *item = json_object(tree, list, NULL), *segments;
        double from, to, z = 0;
        rotor_group_span(rotor, g, &from, &to);
        json_text(tree, item, "name", group->name);
        json_rounded(tree, item, "from_m", from);
        json_rounded(tree, item, "to_m", to);
        add_material(tree, item, &group->material);
        segments = json_array(tree, item, "segments");
        for (int s = 0; s < rotor->nsegment; z += rotor->segment[s++].length)
            if (rotor->segment[s].group == g)
                add_segment(tree, segments, &rotor->segment[s], z);
        if (group->holes) {
            cJSON *holes = json_object(tree, item, "perforation");
            json_number(tree, holes, "number", group->holes);
            json_rounded(tree, holes, "hole_diameter_m", group->hole_diameter);
            json_rounded(tree, holes, "pitch_radius_m", group->hole_pitch);
        } else {
            json_null(tree, item, "perforation");
        }
        json_number(tree, item, "preload_n", group->preload);
    }
}

/* What tie rods and bars have in common. */
static void add_bundle(struct json_tree *tree, cJSON *item, enum bundle_model model, int number, double diameter, double pitch,
                       int elements)
{
    json_number(tree, item, "number", number);
    json_rounded(tree, item, "diameter_m", diameter);
    json_rounded(tree, item, "pitch_radius_m", pitch);
    json_text(tree, item, "model", model == BUNDLE_RODS ? "RODS" : "TUBE");
    json_number(tree, item, "elements", elements);
}

static void add_members(struct json_tree *tree, cJSON *geometry, const struct rotor *rotor)
{
    cJSON *list = json_array(tree, geometry, "tierods");
    for (int i = 0; i < rotor->ntierod; i++) {
        const struct tierod *rod = &rotor->tierod[i];
        cJSON *item = json_object(tree, list, NULL);
        json_text(tree, item, "name", rod->name);
        json_rounded(tree, item, "from_m", rod->from);
        json_rounded(tree, item, "to_m", rod->to);
        add_material(tree, item, &rod->material);
        add_bundle(tree, item, rod->model, rod->number, rod->diameter, rod->pitch, rod->elements);
        json_number(tree, item, "tension_n", rod->tension);
        json_flag(tree, item, "self_equilibrated", rod->self_equilibrated);
    }
    list = json_array(tree, geometry, "bars");
    for (int i = 0; i < rotor->nbars; i++) {
        const struct bars *bars = &rotor->bars[i];
        cJSON *item = json_object(tree, list, NULL);
        json_text(tree, item, "name", bars->name);
        json_rounded(tree, item, "from_m", bars->center - bars->length / 2);
        json_rounded(tree, item, "to_m", bars->center + bars->length / 2);
        json_rounded(tree, item, "center_m", bars->center);
        add_material(tree, item, &bars->material);
        add_bundle(tree, item, bars->model, bars->number, bars->diameter, bars->pitch, bars->elements);
    }
}

static void add_points(struct json_tree *tree, cJSON *geometry, const struct rotor *rotor)
{
    cJSON *list = json_array(tree, geometry, "disks");
    for (int i = 0; i < rotor->ndisk; i++) {
        const struct disk *disk = &rotor->disk[i];
        cJSON *item = json_object(tree, list, NULL);
        json_text(tree, item, "name", disk->name);
        json_rounded(tree, item, "z_m", disk->position);
        json_number(tree, item, "mass_kg", disk->mass);
        json_number(tree, item, "diametral_kg_m2", disk->diametral);
        json_number(tree, item, "polar_kg_m2", disk->polar);
    }
    list = json_array(tree, geometry, "springs");
    for (int i = 0; i < rotor->nspring; i++) {
        const struct spring *spring = &rotor->spring[i];
        cJSON *item = json_object(tree, list, NULL);
        json_text(tree, item, "name", spring->name);
        json_rounded(tree, item, "z_m", spring->position);
        json_number(tree, item, "lateral_n_m", spring->lateral);
        json_number(tree, item, "rotational_nm_rad", spring->rotational);
    }
    json_number(tree, geometry, "sling_m", rotor->sling > 0 ? rotor->sling : NAN);
    list = json_array(tree, geometry, "sensors");
    for (int s = 0; s < rotor->nsensor; s++) {
        cJSON *item = json_object(tree, list, NULL);
        json_number(tree, item, "id", rotor->sensor[s].id);
        json_rounded(tree, item, "z_m", rotor->sensor[s].position);
    }
}

static void add_cause(struct json_tree *tree, struct pool *pool, cJSON *list, const struct rotor *rotor,
                      const struct effect *effect)
{
    const struct cause_kind *cause = catalogue_of(effect);
    const char *target = cause ? cause_target_name(pool, rotor, cause, effect->target) : "";
    cJSON *item = json_object(tree, list, NULL), *parameters;
    tree->failed |= !target;
    json_text(tree, item, "name", effect->name);
    json_text(tree, item, "id", effect->kind->id);
    json_text(tree, item, "target", target);
    if (cause && cause->target == TARGET_SENSOR && effect->target >= 0)
        json_number(tree, item, "sensor", rotor->sensor[effect->target].id);
    else
        json_null(tree, item, "sensor");
    json_text(tree, item, "variant", cause && cause->variant_option ? cause->variant[effect->variant] : NULL);
    parameters = json_array(tree, item, "parameters");
    for (int p = 0; p < effect_parameters(effect); p++) {
        cJSON *parameter = json_object(tree, parameters, NULL);
        json_text(tree, parameter, "name", effect->kind->parameter[p].name);
        json_text(tree, parameter, "unit", effect->kind->parameter[p].unit);
        json_number(tree, parameter, "value", effect->value[p]);
    }
}

void json_geometry(struct json_tree *tree, const struct job *job, const struct spectrum *spectrum)
{
    const struct rotor_model *model = spectrum->model;
    const struct rotor *rotor = model ? model->rotor : &job->rotor;
    cJSON *geometry = json_object(tree, tree->root, "geometry"), *causes;
    struct pool pool;
    json_rounded(tree, geometry, "length_m", rotor_length(rotor));
    add_groups(tree, geometry, rotor);
    add_members(tree, geometry, rotor);
    add_points(tree, geometry, rotor);
    causes = json_array(tree, geometry, "causes");
    pool_open(&pool, NULL);
    for (int i = 0; i < rotor->neffect; i++)
        add_cause(tree, &pool, causes, rotor, &rotor->effect[i]);
    pool_close(&pool);
    json_digits(tree, geometry, "nodes_z_m", model ? model->naxis : 0, model ? model->z : NULL);
}
