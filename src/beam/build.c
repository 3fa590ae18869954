#include "beam/beam.h"

HOST_COMPUTES int equivalent_cylinder(double area, double inertia, char *failure, double *outer, double *inner)
{
    if (!(area > 0 && isfinite(area)))
        return refuse(failure, "area is %g, expected a positive number of m2", area);
    if (!(inertia > 0 && isfinite(inertia)))
        return refuse(failure, "inertia is %g, expected a positive number of m4", inertia);
    if (!outer || !inner)
        return refuse(failure, "%s is NULL, expected room for a diameter", outer ? "inner" : "outer");
    double sum = 8 * inertia / area, difference = 2 * area / PI;
    if (sum < difference * (1 - 1e-14)) /* a solid disc has sum = difference and must not fail on rounding */
        return ROTID_ERROR_SECTION;
    *outer = sqrt(sum + difference);
    *inner = sqrt(fmax(0, sum - difference));
    return ROTID_OK;
}

int rotid_equivalent_cylinder(double area, double inertia, char *failure, double *outer, double *inner)
{
    struct entry entry;
    int status = entry_open(&entry, NULL, failure);
    if (!status)
        status = equivalent_cylinder(area, inertia, failure, outer, inner);
    return entry_close(&entry, status);
}

int section_equivalent(double area, double inertia, struct section *section)
{
    double outer, inner;
    int status = equivalent_cylinder(area, inertia, NULL, &outer, &inner);
    if (!status)
        *section = (struct section){area, inertia, area, inertia, 0, inner / outer, outer, 2 * inertia, 2 * inertia};
    return status;
}

struct effect_span factors_span(const struct beam *beam, int e, const struct section_part *part)
{
    return (struct effect_span){part->group, beam->mesh.segment[e], beam->mesh.z[e], beam->mesh.z[e + 1]};
}

int factors_parts(const struct beam *beam, int e, const struct section_part **part, struct effect_field **factor)
{
    int segment = beam->mesh.segment[e], first = beam->first_part[segment];
    *part = beam->part + first;
    *factor = beam->factor ? beam->factor + (ptrdiff_t)beam->most_parts * e : NULL;
    return beam->first_part[segment + 1] - first;
}

int factors_layers(const struct beam *beam, int e)
{
    const struct section_part *part;
    struct effect_field *factor;
    int count = factors_parts(beam, e, &part, &factor);
    for (int i = 0; i < count; i++) {
        const struct material *material = &beam->rotor.group[part[i].group].material;
        struct shear_layer *layer = &beam->layer[i];
        *layer = (struct shear_layer){.material = shear_material_of(material), .section = &part[i].section};
        if (factor)
            shear_material_scale(material, factor[i].e, factor[i].g, &layer->material);
    }
    return count;
}

void factors_refresh(struct beam *beam)
{
    for (int e = 0; e < beam->mesh.nelement && beam->factor; e++) {
        const struct section_part *part;
        struct effect_field *factor;
        for (int i = 0, count = factors_parts(beam, e, &part, &factor); i < count; i++) {
            struct effect_span span = factors_span(beam, e, &part[i]);
            factor[i] = effects_on_axis(&beam->rotor, &span, beam->type == MODE_BENDING);
        }
    }
}

/* Room for the factors of a beam whose mesh is built, and their first values. ROTID_OK or ROTID_ERROR_MEMORY. */
static int factors_open(struct pool *pool, struct beam *beam)
{
    beam->factor = NULL;
    if (!beam->rotor.neffect)
        return ROTID_OK;
    beam->factor = POOL_ARRAY(pool, struct effect_field, (size_t)beam->most_parts * (size_t)beam->mesh.nelement);
    if (!beam->factor)
        return ROTID_ERROR_MEMORY;
    factors_refresh(beam);
    return ROTID_OK;
}

static int build_sections(struct beam *beam, int *failed)
{
    const struct rotor *rotor = &beam->rotor;
    int count = 0;
    for (int s = 0, r = 0; s < rotor->nsegment; s++) {
        struct section own;
        int own_is_in = 0;
        beam->first_part[s] = count;
        *failed = rotor->segment[s].group;
        if (section_of_segment(rotor, s, &own))
            return ROTID_ERROR_SECTION;
        for (; r < rotor->nring && rotor->ring[r].segment == s; r++) {
            if (!own_is_in && rotor->ring[r].inner > rotor->segment[s].inner) {
                beam->part[count++] = (struct section_part){rotor->segment[s].group, own};
                own_is_in = 1;
            }
            struct section_part *part = &beam->part[count++];
            *failed = part->group = rotor->ring[r].group;
            if (section_of_ring(rotor, r, &part->section))
                return ROTID_ERROR_SECTION;
        }
        if (!own_is_in)
            beam->part[count++] = (struct section_part){rotor->segment[s].group, own};
        beam->first_part[s + 1] = count;
        beam->most_parts = count - beam->first_part[s] > beam->most_parts ? count - beam->first_part[s] : beam->most_parts;
    }
    for (int i = 0; i < rotor->ntierod + rotor->nbars; i++) {
        int is_rod = i < rotor->ntierod, b = i - rotor->ntierod;
        double area, own, pitch;
        if ((is_rod ? rotor->tierod[i].model : rotor->bars[b].model) != BUNDLE_TUBE)
            continue;
        section_rods(is_rod ? rotor->tierod[i].number : rotor->bars[b].number,
                     is_rod ? rotor->tierod[i].diameter : rotor->bars[b].diameter,
                     is_rod ? rotor->tierod[i].pitch : rotor->bars[b].pitch, &area, &own, &pitch);
        *failed = rotor->ngroup + i;
        if (section_equivalent(area, own + pitch, &beam->tube[i]))
            return ROTID_ERROR_SECTION;
    }
    return ROTID_OK;
}

/* Completes a beam that has its rotor, sections, mesh and hinges, by the parts that depend on the values of the rotor. */
static int finish(struct pool *pool, struct beam *beam)
{
    struct mass_properties own;
    int status = factors_open(pool, beam);
    beam->layer = POOL_ARRAY(pool, struct shear_layer, beam->most_parts + 1);
    if (!beam->layer)
        return ROTID_ERROR_MEMORY;
    if (!status && beam->rotor.sling > 0) {
        beam_mass_properties(beam, &own);
        rotor_set_sling(&beam->rotor, own.mass, own.center);
    }
    return status;
}

int beam_build(struct pool *pool, const struct rotor *rotor, int nparameter, const struct parameter *parameter, int refine,
               struct beam *beam, int *failed)
{
    *failed = -1;
    *beam = (struct beam){.nparameter = nparameter, .parameter = parameter};
    int status = rotor_copy(pool, rotor, &beam->rotor);
    if (status)
        return status;
    beam->first_part = POOL_ARRAY(pool, int, rotor->nsegment + 1);
    beam->part = POOL_ARRAY(pool, struct section_part, rotor->nsegment + rotor->nring);
    beam->tube = POOL_ARRAY(pool, struct section, rotor->ntierod + rotor->nbars);
    if (!beam->first_part || !beam->part || !beam->tube)
        return ROTID_ERROR_MEMORY;
    status = build_sections(beam, failed);
    if (!status)
        status = mesh_build(pool, &beam->rotor, refine, &beam->mesh);
    if (!status)
        status = hinge_place(pool, beam);
    return status ? status : finish(pool, beam);
}

int beam_of_shape(struct pool *pool, const struct beam *built, const struct rotor *rotor, int nparameter,
                  const struct parameter *parameter, struct beam *beam)
{
    *beam = *built;
    beam->nparameter = nparameter;
    beam->parameter = parameter;
    int status = rotor_copy(pool, rotor, &beam->rotor);
    return status ? status : finish(pool, beam);
}
