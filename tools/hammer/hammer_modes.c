/* Modes of the exact beam with generalised mass 1, and its exact receptance. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "hammer.h"
#include "oracle/oracle_model.h"

/* Places of the quadrature: six points of Gauss on stretches of at most 1/64 of the length, that is on less than a quarter of a
 * wave in the highest mode that is used, and none of which runs across a change of section or a lumped mass. */
#define GAUSS     6
#define STRETCHES 64

struct quadrature {
    int count, stretches;
    double *cut, *z, *weight; /* weight times the mass or the inertia per length of `segment` */
    int *segment;
};

static int ascending(const void *left, const void *right)
{
    const double *a = left, *b = right;
    return (*a > *b) - (*a < *b);
}

static void quadrature_close(struct quadrature *q)
{
    free(q->cut);
    free(q->z);
    free(q->weight);
    free(q->segment);
}

static int quadrature_open(const struct oracle_system *system, struct quadrature *q)
{
    static const double abscissa[GAUSS] = {-0.932469514203152028, -0.661209386466264514, -0.238619186083196909,
                                           0.238619186083196909,  0.661209386466264514,  0.932469514203152028};
    static const double weight[GAUSS] = {0.171324492379170345, 0.360761573048138608, 0.467913934572691047,
                                         0.467913934572691047, 0.360761573048138608, 0.171324492379170345};
    int most = system->segments + system->points + STRETCHES + 2, cuts = 0, segment = 0;
    size_t room = (size_t)most * GAUSS;
    double end = 0, length = 0;
    *q = (struct quadrature){.cut = malloc((size_t)most * sizeof(double)),
                             .z = malloc(room * sizeof(double)),
                             .weight = malloc(room * sizeof(double)),
                             .segment = malloc(room * sizeof(int))};
    if (!q->cut || !q->z || !q->weight || !q->segment)
        return ORACLE_ERROR_MEMORY;
    q->cut[cuts++] = 0;
    for (int i = 0; i < system->segments; i++)
        q->cut[cuts++] = length += system->segment[i].length;
    for (int i = 0; i < system->points; i++)
        q->cut[cuts++] = fmin(fmax(system->point[i].z, 0), length);
    for (int i = 1; i < STRETCHES; i++)
        q->cut[cuts++] = length * i / STRETCHES;
    qsort(q->cut, (size_t)cuts, sizeof(double), ascending);
    end = system->segment[0].length;
    for (int c = 0; c + 1 < cuts; c++) {
        double middle = (q->cut[c] + q->cut[c + 1]) / 2, half = (q->cut[c + 1] - q->cut[c]) / 2;
        while (middle > end && segment + 1 < system->segments)
            end += system->segment[++segment].length;
        for (int g = 0; g < GAUSS && half > 1e-9 * length; g++) {
            q->z[q->count] = middle + abscissa[g] * half;
            q->weight[q->count] = weight[g] * half;
            q->segment[q->count++] = segment;
        }
    }
    return ORACLE_OK;
}

/* u' M u of the shape at the places: those of the quadrature, then the lumped points, then both ends of the parallel members. */
static double generalised_mass(const struct oracle_system *system, const struct quadrature *q, const double *v,
                               const double *theta)
{
    double mass = 0;
    int at = q->count;
    for (int i = 0; i < q->count; i++) {
        const struct oracle_segment *s = &system->segment[q->segment[i]];
        mass += q->weight[i] * (s->mass * v[i] * v[i] + s->inertia * theta[i] * theta[i]);
    }
    for (int i = 0; i < system->points; i++, at++)
        mass += system->point[i].mass * v[at] * v[at] + system->point[i].inertia * theta[at] * theta[at];
    for (int i = 0; i < system->parallels; i++, at += 2) {
        double u[4] = {v[at], theta[at], v[at + 1], theta[at + 1]};
        for (int j = 0; j < 16; j++)
            mass += u[j / 4] * system->parallel[i].mass[j] * u[j % 4];
    }
    return mass;
}

int hammer_modes(const struct oracle_system *system, int modes, int points, const double *z, double *hz, double *shape)
{
    struct quadrature q;
    double *place = NULL, *v = NULL, *theta = NULL;
    int all = 0, status = quadrature_open(system, &q), first = q.count + system->points + 2 * system->parallels;
    if (!status) {
        size_t room = (size_t)(first + points) * sizeof(double);
        place = malloc(room);
        v = malloc(room);
        theta = malloc(room);
        status = place && v && theta ? oracle_frequencies(system, 1, modes, hz) : ORACLE_ERROR_MEMORY;
    }
    if (!status) {
        for (; all < q.count; all++)
            place[all] = q.z[all];
        for (int i = 0; i < system->points; i++)
            place[all++] = system->point[i].z;
        for (int i = 0; i < system->parallels; i++) {
            place[all++] = system->parallel[i].z_a;
            place[all++] = system->parallel[i].z_b;
        }
        memcpy(place + first, z, (size_t)points * sizeof(double));
    }
    for (int k = 0; k < modes && !status; k++) {
        status = oracle_shape(system, hz[k], first + points, place, v, theta);
        if (status)
            break;
        double scale = 1 / sqrt(generalised_mass(system, &q, v, theta));
        for (int i = 0; i < points; i++)
            shape[(ptrdiff_t)k * points + i] = scale * v[first + i];
    }
    free(place);
    free(v);
    free(theta);
    quadrature_close(&q);
    return status;
}

static int nearest(const struct oracle_model *model, double z)
{
    int best = 0;
    for (int i = 1; i < model->stations; i++)
        best = fabs(model->station[i].z - z) < fabs(model->station[best].z - z) ? i : best;
    return best;
}

/* Points without mass make stations of the places, which then become nodes. */
int hammer_receptance(const struct oracle_system *system, double lambda, double z_fixed, int points, const double *z,
                      double *receptance)
{
    struct oracle_system with = *system;
    struct oracle_model model = {0};
    struct oracle_point *point = calloc((size_t)(system->points + points + 1), sizeof *point);
    double log_determinant;
    int negative, status = point ? ORACLE_OK : ORACLE_ERROR_MEMORY, fixed;
    if (!status) {
        if (system->points)
            memcpy(point, system->point, (size_t)system->points * sizeof *point);
        with.point = point;
        with.points += points + 1;
        for (int i = 0; i < points; i++)
            point[system->points + i].z = z[i];
        point[system->points + points].z = z_fixed;
        status = oracle_model_build(&with, &model);
    }
    for (int i = 0; i <= points && !status; i++)
        model.station[nearest(&model, i < points ? z[i] : z_fixed)].must_be_node = 1;
    if (!status && !(status = oracle_make_members(&model, fabs(lambda))) &&
        !(status = oracle_evaluate(&model, lambda, &negative, &log_determinant))) {
        fixed = model.station[nearest(&model, z_fixed)].dof[0];
        memset(model.vector, 0, (size_t)model.dofs * sizeof(double));
        model.vector[fixed] = model.scale[fixed];
        oracle_solve(model.dofs, model.matrix, model.pivot, model.vector, model.work);
        for (int i = 0; i < points; i++) {
            int dof = model.station[nearest(&model, z[i])].dof[0];
            receptance[i] = model.vector[dof] * model.scale[dof];
        }
    }
    oracle_model_free(&model);
    free(point);
    return status;
}
