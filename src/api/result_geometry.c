#include "api/api.h"

static rotid_material material_of(const struct material *material)
{
    return (rotid_material){.name = material->name,
                            .e_pa = material->e,
                            .g_pa = material_shear_modulus(material),
                            .nu = material->nu,
                            .rho_kg_m3 = material->rho,
                            .sheet_e_pa = material->laminated ? material->sheet_e : (double)NAN,
                            .stacking = material->laminated ? material->stacking : (double)NAN};
}

static rotid_segment segment_of(const struct segment *segment, double from)
{
    int round = !segment->rectangular;
    return (rotid_segment){.from_m = from,
                           .to_m = from + segment->length,
                           .elements = segment->elements,
                           .outer_m = round ? segment->outer : (double)NAN,
                           .inner_m = round ? segment->inner : (double)NAN,
                           .stiff_outer_m = round && segment->stiff_outer != segment->outer ? segment->stiff_outer : (double)NAN,
                           .height_m = round ? (double)NAN : segment->height,
                           .width_m = round ? (double)NAN : segment->width};
}

/* The section of a layer on one of its host. */
static rotid_segment ring_of(const struct ring *ring, rotid_segment host)
{
    host.outer_m = ring->outer;
    host.inner_m = ring->inner;
    host.stiff_outer_m = (double)NAN;
    return host;
}

static void fill_group(struct pool *pool, const struct rotor *rotor, int g, rotid_group *out)
{
    const struct group *group = &rotor->group[g];
    double z = 0;
    int count = 0, next = 0;
    for (int s = 0; s < rotor->nsegment; s++)
        count += rotor->segment[s].group == g;
    for (int i = 0; i < rotor->nring; i++)
        count += rotor->ring[i].group == g;
    *out = (rotid_group){.name = group->name, .material = material_of(&group->material)};
    if (group->layer_of >= 0)
        out->layer_of = rotor->group[group->layer_of].name;
    out->preload_n = group->preload;
    rotor_group_span(rotor, g, &out->from_m, &out->to_m);
    out->nsegments = POOL_LIST(pool, out->segments, count);
    for (int s = 0; s < rotor->nsegment && out->nsegments; z += rotor->segment[s++].length) {
        rotid_segment own = segment_of(&rotor->segment[s], z);
        if (rotor->segment[s].group == g)
            out->segments[next++] = own;
        for (int i = 0; i < rotor->nring; i++)
            if (rotor->ring[i].segment == s && rotor->ring[i].group == g)
                out->segments[next++] = ring_of(&rotor->ring[i], own);
    }
    out->perforation = group->holes ? POOL_NEW(pool, rotid_perforation) : NULL;
    if (out->perforation)
        *out->perforation = (rotid_perforation){group->holes, group->hole_diameter, group->hole_pitch};
}

static const char *bundle_name(enum bundle_model model)
{
    return model == BUNDLE_RODS ? "RODS" : "TUBE";
}

static void fill_members(struct pool *pool, const struct rotor *rotor, rotid_geometry *out)
{
    out->ntierods = POOL_LIST(pool, out->tierods, rotor->ntierod);
    for (int i = 0; i < out->ntierods; i++) {
        const struct tierod *rod = &rotor->tierod[i];
        out->tierods[i] = (rotid_tierods){.name = rod->name,
                                          .from_m = rod->from,
                                          .to_m = rod->to,
                                          .material = material_of(&rod->material),
                                          .number = rod->number,
                                          .diameter_m = rod->diameter,
                                          .pitch_radius_m = rod->pitch,
                                          .model = bundle_name(rod->model),
                                          .elements = rod->elements,
                                          .tension_n = rod->tension,
                                          .self_equilibrated = rod->self_equilibrated};
    }
    out->nbars = POOL_LIST(pool, out->bars, rotor->nbars);
    for (int i = 0; i < out->nbars; i++) {
        const struct bars *bars = &rotor->bars[i];
        out->bars[i] = (rotid_bars){.name = bars->name,
                                    .from_m = bars->center - bars->length / 2,
                                    .to_m = bars->center + bars->length / 2,
                                    .center_m = bars->center,
                                    .material = material_of(&bars->material),
                                    .number = bars->number,
                                    .diameter_m = bars->diameter,
                                    .pitch_radius_m = bars->pitch,
                                    .model = bundle_name(bars->model),
                                    .elements = bars->elements};
    }
}

static void fill_attached(struct pool *pool, const struct rotor *rotor, rotid_geometry *out)
{
    out->ndisks = POOL_LIST(pool, out->disks, rotor->ndisk);
    for (int i = 0; i < out->ndisks; i++) {
        const struct disk *disk = &rotor->disk[i];
        out->disks[i] = (rotid_disk){disk->name, disk->position, disk->mass, disk->diametral, disk->polar};
    }
    out->nsprings = POOL_LIST(pool, out->springs, rotor->nspring);
    for (int i = 0; i < out->nsprings; i++) {
        const struct spring *spring = &rotor->spring[i];
        out->springs[i] = (rotid_spring){spring->name, spring->position, spring->lateral, spring->rotational};
    }
    out->sling_m = rotor->sling > 0 ? rotor->sling : (double)NAN;
    out->nsensors = POOL_LIST(pool, out->sensors, rotor->nsensor);
    for (int s = 0; s < out->nsensors; s++)
        out->sensors[s] = (rotid_sensor){rotor->sensor[s].id, rotor->sensor[s].position};
}

static void fill_cause(struct pool *pool, const struct rotor *rotor, const struct effect *effect, rotid_model_cause *out)
{
    const struct cause_kind *cause = catalogue_of(effect);
    const char *target = cause ? cause_target_name(pool, rotor, cause, effect->target) : "";
    int at_sensor = cause && cause->target == TARGET_SENSOR && effect->target >= 0;
    *out = (rotid_model_cause){.name = effect->name,
                               .id = effect->kind->id,
                               .target = target,
                               .sensor = at_sensor ? rotor->sensor[effect->target].id : ROTID_NONE,
                               .variant = cause && cause->variant_option ? cause->variant[effect->variant] : NULL};
    out->nparameters = POOL_LIST(pool, out->parameters, effect_parameters(effect));
    for (int p = 0; p < out->nparameters; p++)
        out->parameters[p] =
            (rotid_cause_parameter){effect->kind->parameter[p].name, effect->kind->parameter[p].unit, effect->value[p]};
}

rotid_geometry *result_geometry(struct pool *pool, const struct rotor *rotor, const struct rotor_model *model)
{
    rotid_geometry *out = POOL_NEW(pool, rotid_geometry);
    if (!out)
        return NULL;
    if (model)
        rotor = model->rotor;
    out->length_m = rotor_length(rotor);
    out->ngroups = POOL_LIST(pool, out->groups, rotor->ngroup);
    for (int g = 0; g < out->ngroups; g++)
        fill_group(pool, rotor, g, &out->groups[g]);
    fill_members(pool, rotor, out);
    fill_attached(pool, rotor, out);
    out->ncauses = POOL_LIST(pool, out->causes, rotor->neffect);
    for (int i = 0; i < out->ncauses; i++)
        fill_cause(pool, rotor, &rotor->effect[i], &out->causes[i]);
    out->nodes_z_m = model ? (double *)model->z : NULL;
    out->nnodes_z_m = model ? model->naxis : 0;
    return out;
}
