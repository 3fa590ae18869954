/* From the caller's system to stations and pieces. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "oracle_model.h"

static int at_least(double value, double least)
{
    return value >= least && isfinite(value);
}

static int check_system(const struct oracle_system *system, double *length)
{
    *length = 0.0;
    if (!system || system->segments < 1 || !system->segment || system->points < 0 || (system->points > 0 && !system->point) ||
        system->parallels < 0 || (system->parallels > 0 && !system->parallel))
        return ORACLE_ERROR_ARGUMENT;
    for (int i = 0; i < system->segments; i++) {
        const struct oracle_segment *s = &system->segment[i];
        if (!at_least(s->length, DBL_MIN) || !at_least(s->bending, DBL_MIN) || !(s->shear > 0.0) || !at_least(s->mass, DBL_MIN) ||
            !at_least(s->inertia, 0.0) || !isfinite(s->axial))
            return ORACLE_ERROR_ARGUMENT;
        if (!(s->shear + s->axial > 0.0))
            return ORACLE_ERROR_UNSTABLE; /* it buckles in shear at any length */
        *length += s->length;
    }
    for (int i = 0; i < system->points; i++) {
        const struct oracle_point *p = &system->point[i];
        double margin = 1e-9 * *length;
        if (!(p->z >= -margin && p->z <= *length + margin) || isnan(p->spring) || isnan(p->rotational_spring) ||
            p->spring == -INFINITY || p->rotational_spring == -INFINITY || !at_least(p->mass, 0.0) ||
            !at_least(p->inertia, 0.0) || !(p->flexibility >= 0.0) || p->side < ORACLE_LEFT || p->side > ORACLE_RIGHT)
            return ORACLE_ERROR_ARGUMENT;
        if (p->flexibility > 0.0 && (p->z <= margin || p->z >= *length - margin))
            return ORACLE_ERROR_ARGUMENT;
    }
    for (int i = 0; i < system->parallels; i++) {
        const struct oracle_parallel *p = &system->parallel[i];
        double margin = 1e-9 * *length;
        if (!(p->z_a >= -margin && p->z_a <= *length + margin && p->z_b >= -margin && p->z_b <= *length + margin) ||
            p->side_a < ORACLE_LEFT || p->side_a > ORACLE_RIGHT || p->side_b < ORACLE_LEFT || p->side_b > ORACLE_RIGHT)
            return ORACLE_ERROR_ARGUMENT;
        for (int j = 0; j < 16; j++) {
            int transposed = 4 * (j % 4) + j / 4;
            double size = fabs(p->stiffness[5 * (j / 4)]) + fabs(p->stiffness[5 * (j % 4)]);
            double mass_size = fabs(p->mass[5 * (j / 4)]) + fabs(p->mass[5 * (j % 4)]);
            if (!isfinite(p->stiffness[j]) || !isfinite(p->mass[j]) ||
                fabs(p->stiffness[j] - p->stiffness[transposed]) > 1e-9 * size ||
                fabs(p->mass[j] - p->mass[transposed]) > 1e-9 * mass_size)
                return ORACLE_ERROR_ARGUMENT;
        }
    }
    return ORACLE_OK;
}

static int ascending(const void *left, const void *right)
{
    const double *a = left, *b = right;

    return (*a > *b) - (*a < *b);
}

/* The station at z, which exists. */
static int find_station(const struct oracle_model *model, double z)
{
    int best = 0;

    for (int i = 1; i < model->stations; i++) {
        if (fabs(model->station[i].z - z) < fabs(model->station[best].z - z))
            best = i;
    }
    return best;
}

static void place_points(struct oracle_model *model)
{
    const struct oracle_system *system = model->system;

    for (int i = 0; i < system->points; i++) {
        const struct oracle_point *p = &system->point[i];
        struct oracle_station *s = &model->station[find_station(model, p->z)];
        s->spring += p->spring;
        s->mass += p->mass;
        s->rotational_spring[p->side] += p->rotational_spring;
        s->inertia[p->side] += p->inertia;
        s->flexibility += p->flexibility;
        s->hinged |= p->flexibility > 0.0;
    }
    for (int i = 0; i < model->stations; i++) {
        struct oracle_station *s = &model->station[i];
        /* Inside a member may only stand what its transfer matrix and the bound of its resonances take account of. */
        s->must_be_node = i == 0 || i == model->stations - 1 || s->hinged || s->spring < 0.0 || isinf(s->spring);
        for (int side = 0; side < 2; side++)
            s->must_be_node |= s->rotational_spring[side] < 0.0 || isinf(s->rotational_spring[side]);
    }
    for (int i = 0; i < system->parallels; i++) {
        model->parallel_station[2 * i] = find_station(model, system->parallel[i].z_a);
        model->parallel_station[2 * i + 1] = find_station(model, system->parallel[i].z_b);
        for (int end = 0; end < 2; end++)
            model->station[model->parallel_station[2 * i + end]].must_be_node = 1;
    }
}

/* The scales of mass and frequency. */
static void measure(struct oracle_model *model)
{
    const struct oracle_system *system = model->system;
    double length = model->length, bending = 0.0, shear = 0.0, mass = 0.0, stiffest = 0.0;

    for (int i = 0; i < system->segments; i++) {
        bending += system->segment[i].bending * system->segment[i].length / length;
        shear += system->segment[i].shear * system->segment[i].length / length;
        mass += system->segment[i].mass * system->segment[i].length;
    }
    for (int i = 0; i < system->points; i++)
        mass += system->point[i].mass + system->point[i].inertia / (length * length);
    for (int i = 0; i < system->parallels; i++) {
        const double *m = system->parallel[i].mass;
        const double *k = system->parallel[i].stiffness;
        mass += fabs(m[0]) + fabs(m[10]) + (fabs(m[5]) + fabs(m[15])) / (length * length);
        stiffest = fmax(stiffest, fmax(fmax(fabs(k[0]), fabs(k[10])), fmax(fabs(k[5]), fabs(k[15])) / (length * length)));
    }
    model->mass = mass;
    model->reference = 1.0 / sqrt(mass * (length * length * length / bending + length / shear));
    /* Zero is what is far below the elastic modes, or what the rounding of a parallel member's matrix may have made. */
    model->floor_lambda = fmax(1e-12 * model->reference * model->reference, 1e-13 * stiffest / mass);
}

void oracle_model_free(struct oracle_model *model)
{
    free(model->station);
    free(model->parallel_station);
    free(model->piece);
    free(model->cell);
    free(model->member);
    free(model->matrix);
    free(model->scale);
    free(model->vector);
    free(model->work);
    free(model->pivot);
}

int oracle_model_build(const struct oracle_system *system, struct oracle_model *model)
{
    int positions, segment = 0, status;
    double *z, end;

    memset(model, 0, sizeof(*model));
    status = check_system(system, &model->length);
    if (status)
        return status;
    model->system = system;
    positions = system->segments + 1 + system->points + 2 * system->parallels;
    z = malloc((size_t)positions * sizeof(*z));
    model->station = calloc((size_t)positions, sizeof(*model->station));
    model->piece = calloc((size_t)positions, sizeof(*model->piece));
    model->parallel_station = calloc(2 * (size_t)system->parallels + 1, sizeof(*model->parallel_station));
    if (!z || !model->station || !model->piece || !model->parallel_station) {
        free(z);
        return ORACLE_ERROR_MEMORY;
    }
    positions = 0;
    end = z[positions++] = 0.0;
    for (int i = 0; i < system->segments; i++)
        z[positions++] = end += system->segment[i].length;
    for (int i = 0; i < system->points; i++)
        z[positions++] = fmin(fmax(system->point[i].z, 0.0), model->length);
    for (int i = 0; i < system->parallels; i++) {
        z[positions++] = fmin(fmax(system->parallel[i].z_a, 0.0), model->length);
        z[positions++] = fmin(fmax(system->parallel[i].z_b, 0.0), model->length);
    }
    qsort(z, (size_t)positions, sizeof(*z), ascending);
    for (int i = 0; i < positions; i++) {
        if (model->stations == 0 || z[i] - model->station[model->stations - 1].z > 1e-9 * model->length)
            model->station[model->stations++].z = z[i];
    }
    free(z);
    end = system->segment[0].length;
    for (int i = 0; i + 1 < model->stations; i++) {
        double middle = 0.5 * (model->station[i].z + model->station[i + 1].z);
        while (middle > end && segment < system->segments - 1)
            end += system->segment[++segment].length;
        model->piece[i] = &system->segment[segment];
    }
    place_points(model);
    measure(model);
    return ORACLE_OK;
}
