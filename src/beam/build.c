#include <string.h>

#include "beam/beam.h"
#include "beam/effects.h"
#include "beam/hinge.h"
#include "linalg/eigen.h"
#include "linalg/matrix.h"

static const double gravity = 9.81; /* m/s2: the value the paper's table of the rotor rests on */

static void *copy_array(struct pool *pool, const void *source, int count, size_t size, int room)
{
    void *copy = pool_get(pool, (size_t)count + (size_t)room, size);
    if (copy && count)
        memcpy(copy, source, (size_t)count * size);
    return copy;
}

static int copy_rotor(struct pool *pool, const struct rotor *rotor, struct rotor *copy)
{
    *copy = *rotor;
    copy->group = copy_array(pool, rotor->group, rotor->ngroup, sizeof *rotor->group, 0);
    copy->tierod = copy_array(pool, rotor->tierod, rotor->ntierod, sizeof *rotor->tierod, 0);
    copy->disk = copy_array(pool, rotor->disk, rotor->ndisk, sizeof *rotor->disk, 0);
    copy->spring = copy_array(pool, rotor->spring, rotor->nspring, sizeof *rotor->spring, 2); /* two more for a sling */
    copy->effect = copy_array(pool, rotor->effect, rotor->neffect, sizeof *rotor->effect, 0);
    return copy->group && copy->tierod && copy->disk && copy->spring && copy->effect ? ROTID_OK : ROTID_ERROR_MEMORY;
}

static int build_sections(struct beam *beam, int *failed)
{
    const struct rotor *rotor = &beam->rotor;
    for (int s = 0; s < rotor->nsegment; s++) {
        const struct segment *segment = &rotor->segment[s];
        const struct group *group = &rotor->group[segment->group];
        if (segment->rectangular)
            section_rectangular(segment->height, segment->width, &beam->section[s]);
        else
            section_round(segment->outer, segment->inner, segment->stiff_outer, &beam->section[s]);
        *failed = segment->group;
        if (group->holes &&
            section_perforate(group->holes, group->hole_diameter, group->hole_pitch, segment->stiff_outer, &beam->section[s]))
            return ROTID_ERROR_SECTION;
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

/* (44): the rotor hangs by its left end on a sling of length L_e; both springs from the model's own mass and centre of mass */
static void set_sling(struct beam *beam)
{
    struct mass_properties properties;
    beam_mass_properties(beam, &properties);
    struct spring *spring = beam->rotor.spring + beam->rotor.nspring - 2;
    double weight = properties.mass * gravity, length = rotor_length(&beam->rotor);
    spring[0].lateral = weight / beam->rotor.sling;
    spring[1].lateral = weight * properties.center / (length * length + properties.center * beam->rotor.sling);
}

int beam_build(struct pool *pool, const struct rotor *rotor, int nparameter, const struct parameter *parameter, int refine,
               struct beam *beam, int *failed)
{
    *failed = -1;
    *beam = (struct beam){.nparameter = nparameter, .parameter = parameter};
    int status = copy_rotor(pool, rotor, &beam->rotor);
    if (status)
        return status;
    beam->section = POOL_ARRAY(pool, struct section, rotor->nsegment);
    beam->tube = POOL_ARRAY(pool, struct section, rotor->ntierod + rotor->nbars);
    if (!beam->section || !beam->tube)
        return ROTID_ERROR_MEMORY;
    status = build_sections(beam, failed);
    if (status)
        return status;
    if (rotor->sling > 0) {
        beam->rotor.spring[beam->rotor.nspring++] = (struct spring){.name = "sling", .position = 0};
        beam->rotor.spring[beam->rotor.nspring++] = (struct spring){.name = "sling end", .position = rotor_length(rotor)};
    }
    status = mesh_build(pool, &beam->rotor, refine, &beam->mesh);
    if (!status)
        status = effects_open(pool, beam);
    if (!status)
        status = hinge_place(pool, beam);
    if (!status && rotor->sling > 0)
        set_sling(beam);
    return status;
}

int beam_count_rigid(struct pool *pool, struct beam *beam, const double *x, int *nrigid)
{
    const struct mesh *mesh = &beam->mesh;
    int n = mesh->ndof, wanted = n < 4 ? n : 4; /* plane bending has two rigid motions: the third mode is always elastic */
    rotid_matrix k, m;
    struct eigen_band eigen;
    double lambda[4], *phi = POOL_ARRAY(pool, double, (size_t)wanted *(size_t)n), *work = POOL_ARRAY(pool, double, n);
    int status = phi && work ? matrix_new(pool, n, mesh->kd, mesh->nfar, mesh->far, &k) : ROTID_ERROR_MEMORY;
    if (!status)
        status = matrix_new(pool, n, mesh->kd, mesh->nfar, mesh->far, &m);
    if (!status)
        status = eigen_band_new(pool, &k, wanted, &eigen);
    if (status)
        return status;
    beam_assemble(beam, x, &k, &m);
    status = eigen_band_solve(&eigen, &k, &m, lambda, phi);
    if (status)
        return status;
    matrix_zero(&k);
    matrix_zero(&m);
    beam->elastic_only = 1;
    beam_assemble(beam, x, &k, &m);
    beam->elastic_only = 0;
    *nrigid = 0;
    for (int j = 0; j < 2; j++) {
        const double *shape = phi + (ptrdiff_t)j * n;
        double elastic = matrix_product(&k, shape, shape, work);
        if (lambda[j] > 1e-6 * lambda[2] && elastic > 0.5 * lambda[j])
            break;
        (*nrigid)++;
    }
    return ROTID_OK;
}
