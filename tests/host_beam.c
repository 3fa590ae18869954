#include "host_beam.h"

#include "dense.h"

const double beam_truth[3] = {1.2, 0.7, 0.4};
const rotid_parameter beam_parameters[3] = {
    {"left", NULL, 0.01, 10, 1.1}, {"right", NULL, 0.01, 10, 0.75}, {"tie", NULL, 0.01, 10, 0.5}};
static const int numbers_of[BEAM_MODES] = {1, 2, 3, 4, 5};

static void assemble(struct beam_host *host, const double *x, rotid_matrix *k, rotid_matrix *m)
{
    int last = 2 * host->elements;
    for (int e = 0; e < host->elements; e++) {
        double l = 1.0 / host->elements, ei = 1e5 * x[2 * e >= host->elements], ke[16], me[16];
        const int dof[4] = {2 * e, 2 * e + 1, 2 * e + 2, 2 * e + 3};
        rotid_element_stiffness(ei, 1e3 * ei, l, ke);
        rotid_element_mass(20, 0.01, 12 / (1e3 * l * l), l, me);
        if (ei > 0)
            host->failed |= rotid_matrix_add_element(k, 4, dof, ke, NULL) != ROTID_OK;
        host->failed |= rotid_matrix_add_element(m, 4, dof, me, NULL) != ROTID_OK;
    }
    host->failed |= rotid_matrix_add(k, 0, 0, 1e4, NULL) != ROTID_OK;
    host->failed |= rotid_matrix_add(k, last, last, 1e4, NULL) != ROTID_OK;
    if (host->tied) {
        const double tie[4] = {1e5 * x[2], -1e5 * x[2], -1e5 * x[2], 1e5 * x[2]};
        host->failed |= rotid_matrix_add_element(k, 2, host->far, tie, NULL) != ROTID_OK;
    }
}

int beam_matrices(void *user, const double *x, rotid_matrix *k, rotid_matrix *m)
{
    struct beam_host *host = user;
    assemble(host, x, k, m);
    return host->failed;
}

/* K is linear in x, M does not depend on it: dK/dx_p = K(e_p) - K(0) */
int beam_derivatives(void *user, const double *x, int p, rotid_matrix *dk, rotid_matrix *dm)
{
    struct beam_host *host = user;
    double unit[3] = {0}, none[3] = {0};
    (void)x, (void)dm;
    size_t length = (size_t)dk->n * (size_t)(dk->kd + 1) * sizeof(double),
           square = (size_t)(dk->nfar * dk->nfar) * sizeof(double);
    rotid_matrix mass = *dk, zero = *dk;
    mass.band = calloc(1, length);
    mass.block = calloc(1, square + 1);
    zero.band = calloc(1, length);
    zero.block = calloc(1, square + 1);
    unit[p] = 1;
    assemble(host, unit, dk, &mass);
    assemble(host, none, &zero, &mass);
    for (size_t i = 0; i < length / sizeof(double); i++)
        dk->band[i] -= zero.band[i];
    for (size_t i = 0; i < square / sizeof(double); i++)
        dk->block[i] -= zero.block[i];
    free(mass.band);
    free(mass.block);
    free(zero.band);
    free(zero.block);
    return host->failed;
}

void beam_host_open(struct beam_host *host, int elements, int kd, int tied, int every)
{
    *host = (struct beam_host){.elements = elements, .tied = tied, .far = {0, 2 * elements}};
    rotid_model *model = &host->model;
    model->n = 2 * (elements + 1);
    model->kd = kd ? kd : 3;
    model->nfar = tied && !kd ? 2 : 0;
    model->far = host->far;
    model->size = sizeof *model;
    model->nparam = tied ? 3 : 2;
    model->nrigid = 2;
    for (int node = 0; node <= elements; node += every)
        host->master[model->nmaster++] = 2 * node;
    model->master = host->master;
    model->matrices = beam_matrices;
    model->derivatives = beam_derivatives;
    model->user = host;
}

/* Frequencies and shapes at the beam_truth, with a pinch of error so that the residual is not zero. */
void beam_host_measure(struct pool *pool, struct beam_host *host, int reduction, struct beam_data *data)
{
    const rotid_model *model = &host->model;
    int n = model->n, nmaster = model->nmaster, count = BEAM_MODES + 2;
    size_t band = (size_t)n * (size_t)(model->kd + 1);
    rotid_matrix k = {.n = n, .kd = model->kd, .nfar = model->nfar, .far = model->far, .band = numbers(pool, (ptrdiff_t)band)},
                 m = k;
    k.block = numbers(pool, 4);
    m.band = numbers(pool, (ptrdiff_t)band);
    m.block = numbers(pool, 4);
    assemble(host, beam_truth, &k, &m);
    double *lambda = numbers(pool, count), *phi = numbers(pool, (ptrdiff_t)n * count);
    assert_status(rotid_eigenpairs(&k, &m, count, NULL, NULL, lambda, phi), ROTID_OK);
    data->shape = numbers(pool, (ptrdiff_t)nmaster * BEAM_MODES);
    data->shape_std = numbers(pool, (ptrdiff_t)nmaster * BEAM_MODES);
    for (int j = 0; j < BEAM_MODES; j++) {
        data->hz[j] = sqrt(lambda[2 + j]) / (2 * 3.14159265358979323846) * (1 + 1e-4 * sin(3.0 * j));
        data->hz_std[j] = 1e-3;
        for (int s = 0; s < nmaster; s++) {
            data->shape[s + j * nmaster] = phi[model->master[s] + (2 + j) * n];
            data->shape_std[s + j * nmaster] = 0.02;
        }
    }
    data->measured = (rotid_measured){.size = sizeof data->measured,
                                      .nmode = BEAM_MODES,
                                      .number = numbers_of,
                                      .frequency_hz = data->hz,
                                      .frequency_std = data->hz_std};
    if (reduction == ROTID_REDUCTION_NONE || nmaster < 50) {
        data->measured.shape = data->shape;
        data->measured.shape_std = data->shape_std;
    }
}
