/* A host that builds its matrices with the building blocks and fits its own parameters: the storage of the matrices, the size of
 * the model and whether there are derivatives make no difference to what is found. */
#include "dense.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A free beam of two halves, EI = x1 and x2 (times 1e5) and the shear stiffness with them, on soft springs; a tie of stiffness x3
 * between its ends where there is one.
 */
struct host {
    int elements, tied, failed;
    rotid_model model;
    int far[2], master[2000];
};

static void assemble(struct host *host, const double *x, rotid_matrix *k, rotid_matrix *m)
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

static int matrices(void *user, const double *x, rotid_matrix *k, rotid_matrix *m)
{
    struct host *host = user;
    assemble(host, x, k, m);
    return host->failed;
}

/* K is linear in x, M does not depend on it: dK/dx_p = K(e_p) - K(0) */
static int derivatives(void *user, const double *x, int p, rotid_matrix *dk, rotid_matrix *dm)
{
    struct host *host = user;
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

/* Sensors measure the deflection of every `every`-th node. kd 0: as narrow as the elements and the tie let it be. */
static void open_host(struct host *host, int elements, int kd, int tied, int every)
{
    *host = (struct host){.elements = elements, .tied = tied, .far = {0, 2 * elements}};
    rotid_model *model = &host->model;
    model->size = sizeof *model;
    model->n = 2 * (elements + 1);
    model->kd = kd ? kd : 3;
    model->nfar = tied && !kd ? 2 : 0;
    model->far = host->far;
    model->nparam = tied ? 3 : 2;
    model->nrigid = 2;
    for (int node = 0; node <= elements; node += every)
        host->master[model->nmaster++] = 2 * node;
    model->master = host->master;
    model->matrices = matrices;
    model->derivatives = derivatives;
    model->user = host;
}

enum { MODES = 5 };
static const double truth[3] = {1.2, 0.7, 0.4};
static const rotid_parameter parameters[3] = {
    {"left", NULL, 0.01, 10, 1.1}, {"right", NULL, 0.01, 10, 0.75}, {"tie", NULL, 0.01, 10, 0.5}};
static const int numbers_of[MODES] = {1, 2, 3, 4, 5};

struct data {
    double hz[MODES], hz_std[MODES], *shape, *shape_std;
    rotid_measured measured;
};

/* Frequencies and shapes at the truth, with a pinch of error so that the residual is not zero. */
static void measure(struct pool *pool, struct host *host, int reduction, struct data *data)
{
    const rotid_model *model = &host->model;
    int n = model->n, nmaster = model->nmaster, count = MODES + 2;
    size_t band = (size_t)n * (size_t)(model->kd + 1);
    rotid_matrix k = {.n = n, .kd = model->kd, .nfar = model->nfar, .far = model->far, .band = numbers(pool, (ptrdiff_t)band)},
                 m = k;
    k.block = numbers(pool, 4);
    m.band = numbers(pool, (ptrdiff_t)band);
    m.block = numbers(pool, 4);
    assemble(host, truth, &k, &m);
    double *lambda = numbers(pool, count), *phi = numbers(pool, (ptrdiff_t)n * count);
    assert_status(rotid_eigenpairs(&k, &m, count, NULL, NULL, lambda, phi), ROTID_OK);
    data->shape = numbers(pool, (ptrdiff_t)nmaster * MODES);
    data->shape_std = numbers(pool, (ptrdiff_t)nmaster * MODES);
    for (int j = 0; j < MODES; j++) {
        data->hz[j] = sqrt(lambda[2 + j]) / (2 * 3.14159265358979323846) * (1 + 1e-4 * sin(3.0 * j));
        data->hz_std[j] = 1e-3;
        for (int s = 0; s < nmaster; s++) {
            data->shape[s + j * nmaster] = phi[model->master[s] + (2 + j) * n];
            data->shape_std[s + j * nmaster] = 0.02;
        }
    }
    data->measured = (rotid_measured){.size = sizeof(rotid_measured),
                                      .nmode = MODES,
                                      .number = numbers_of,
                                      .frequency_hz = data->hz,
                                      .frequency_std = data->hz_std};
    if (reduction == ROTID_REDUCTION_NONE || nmaster < 50) {
        data->measured.shape = data->shape;
        data->measured.shape_std = data->shape_std;
    }
}

static rotid_fit_result *fit(struct host *host, const struct data *data, int functional, int reduction)
{
    rotid_fit_options options = {.size = sizeof options, .functional = functional, .reduction = reduction};
    rotid_fit_result *result;
    assert_status(rotid_fit(&host->model, parameters, &data->measured, &options, NULL, NULL, &result), ROTID_OK);
    assert_int_equal(host->failed, 0);
    assert_true(result->converged);
    return result;
}

static void assert_same_fit(const rotid_fit_result *a, const rotid_fit_result *b, double digits)
{
    for (int p = 0; p < a->n; p++) {
        assert_close(a->x[p], b->x[p], digits, 0);
        assert_true(isnan(a->std[p]) == isnan(b->std[p]));
        if (isfinite(b->std[p]))
            assert_close(a->std[p], b->std[p], 1e-4, 0);
    }
    assert_close(a->objective, b->objective, 1e3 * digits, 0);
    for (int k = 0; k < a->m; k++)
        assert_close(a->predicted_hz[k], b->predicted_hz[k], digits, 0);
}

static const struct {
    int functional, reduction;
} ways[] = {{ROTID_LIKELIHOOD, ROTID_REDUCTION_NONE}, {ROTID_HYBRID, ROTID_GUYAN},   {ROTID_HYBRID_F, ROTID_IRS},
            {ROTID_LIKELIHOOD, ROTID_GUYAN},          {ROTID_LIKELIHOOD, ROTID_IRS}, {ROTID_HYBRID, ROTID_REDUCTION_NONE}};

/* A band with a block for the tie, the same in a wide band and as a dense matrix. */
static void the_storage_does_not_matter(void **state)
{
    for (size_t w = 0; w < sizeof ways / sizeof *ways; w++) {
        struct host bordered, wide, dense;
        struct data data;
        open_host(&bordered, 20, 0, 1, 1);
        open_host(&wide, 20, 40, 1, 1);
        open_host(&dense, 20, 41, 1, 1);
        measure(*state, &bordered, ways[w].reduction, &data);
        rotid_fit_result *a = fit(&bordered, &data, ways[w].functional, ways[w].reduction),
                         *b = fit(&wide, &data, ways[w].functional, ways[w].reduction),
                         *c = fit(&dense, &data, ways[w].functional, ways[w].reduction);
        assert_same_fit(b, a, 1e-7);
        assert_same_fit(c, a, 1e-7);
        for (int p = 0; p < 3 && ways[w].reduction == ROTID_REDUCTION_NONE; p++)
            assert_close(a->x[p], truth[p], 0.05, 0); /* of errors of 1e-4 in the frequencies */
        rotid_fit_free(a);
        rotid_fit_free(b);
        rotid_fit_free(c);
    }
}

static void a_host_without_derivatives_finds_the_same(void **state)
{
    for (size_t w = 0; w < sizeof ways / sizeof *ways; w++)
        for (int dense = 0; dense < 2; dense++) {
            struct host with, without;
            struct data data;
            open_host(&with, 20, dense ? 41 : 0, 1, 2);
            open_host(&without, 20, dense ? 41 : 0, 1, 2);
            without.model.derivatives = NULL;
            measure(*state, &with, ways[w].reduction, &data);
            rotid_fit_result *a = fit(&with, &data, ways[w].functional, ways[w].reduction),
                             *b = fit(&without, &data, ways[w].functional, ways[w].reduction);
            assert_same_fit(b, a, 1e-7);
            rotid_fit_free(a);
            rotid_fit_free(b);
        }
}

/* 1200 degrees of freedom, 600 of them masters. */
static void large_models_are_fitted_as_well(void **state)
{
    static const int large[][2] = {{ROTID_HYBRID, ROTID_GUYAN}, {ROTID_LIKELIHOOD, ROTID_REDUCTION_NONE}};
    for (int w = 0; w < 2; w++) {
        struct host narrow, dense;
        struct data data;
        open_host(&narrow, 599, 0, 0, 1);
        open_host(&dense, 599, 1199, 0, 1);
        assert_int_equal(narrow.model.nmaster, 600);
        measure(*state, &narrow, large[w][1], &data);
        rotid_fit_result *a = fit(&narrow, &data, large[w][0], large[w][1]), *b = fit(&dense, &data, large[w][0], large[w][1]);
        print_message("1200 degrees of freedom, reduction %d: band %.2f s, dense %.2f s, evaluations %d and %d\n", large[w][1],
                      a->seconds, b->seconds, a->evaluations, b->evaluations);
        assert_same_fit(b, a, 1e-6);
        for (int p = 0; p < 2; p++)
            assert_close(a->x[p], truth[p], 0.01, 0);
        rotid_fit_free(a);
        rotid_fit_free(b);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        WITH_POOL(the_storage_does_not_matter),
        WITH_POOL(a_host_without_derivatives_finds_the_same),
        WITH_POOL(large_models_are_fitted_as_well),
    };
    return cmocka_run_group_tests_name("blocks_fit", tests, NULL, NULL);
}
