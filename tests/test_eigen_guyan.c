/* Eigenpairs of Guyan's condensation by bands, and their derivatives, beside those of the dense condensed matrices. */
#include "dense.h"
#include "paper_rotor.h"

#include "modal/modal.h"
#include "model/model.h"
#include "support.h"

#define MOST_MASTERS 80

struct chosen { /* a rotor whose masters are drawn */
    struct rotor_model model;
    int master[MOST_MASTERS];
};

/* Every node of the axis is a master with this probability, the first and the last one in any case. */
static void draw(struct pool *pool, struct random_stream *stream, enum bundle_model bundle, int springs, double share,
                 struct chosen *c)
{
    int failed;
    struct rotor rotor = *paper_rotor(bundle, 1);
    rotor.nspring = springs ? rotor.nspring : 0;
    assert_status(model_open(pool, NULL, &rotor, 2, paper_parameters, 1, &c->model, &failed), ROTID_OK);
    int count = 0, last = c->model.naxis - 1;
    for (int i = 0; i <= last && count < MOST_MASTERS - 1; i++)
        if (i == 0 || i == last || random_uniform(stream) < share)
            c->master[count++] = discrete_place_dof(&c->model.discrete, i);
    c->model.equations.nmaster = count;
    c->model.equations.master = c->master;
}

static void compare(struct prediction *bands, struct prediction *dense, const double *x, const int *wanted, int must)
{
    assert_status(prediction_compute(bands, x), ROTID_OK);
    assert_status(prediction_compute(dense, x), ROTID_OK);
    assert_int_equal(dense->by_bands, 0);
    if (must)
        assert_int_equal(bands->by_bands, 1);
    assert_status(prediction_differentiate(bands, x, wanted, 0), ROTID_OK);
    assert_status(prediction_differentiate(dense, x, wanted, 0), ROTID_OK);
    for (int k = 0; k < bands->count; k++) {
        if (!wanted[k])
            continue;
        const double *a = bands->phi + (ptrdiff_t)k * bands->size, *b = dense->phi + (ptrdiff_t)k * dense->size;
        assert_close(sqrt(bands->lambda[k]), sqrt(dense->lambda[k]), 1e-10, 0);
        for (int q = 0; q < bands->model->nparam; q++) {
            double slope = dense->dlambda[k + (ptrdiff_t)q * dense->count];
            assert_close(bands->dlambda[k + (ptrdiff_t)q * bands->count] * x[q], slope * x[q], 1e-8, 1e-9 * dense->lambda[k]);
        }
        double sign = 0;
        for (int i = 0; i < bands->size; i++)
            sign += a[i] * b[i];
        for (int i = 0; i < bands->size; i++)
            assert_close(a[i], sign > 0 ? b[i] : -b[i], 1e-7, 1e-7);
    }
}

/* Steps of a fit: first large, then small ones */
POOL_TEST(pairs_and_derivatives_are_those_of_the_dense_matrices)
{
    struct random_stream stream = {71};
    int solved = 0;
    for (int trial = 0; trial < 12; trial++) {
        struct chosen c;
        struct prediction bands, dense;
        int wanted[10], count;
        draw(*state, &stream, trial % 3 ? BUNDLE_TUBE : BUNDLE_RODS, trial % 2, 0.15 + 0.05 * (trial % 6), &c);
        const rotid_model *model = &c.model.equations;
        count = model->nrigid + 4 + trial % 3;
        for (int k = 0; k < count; k++)
            wanted[k] = k >= model->nrigid;
        assert_status(prediction_new(*state, model, ROTID_GUYAN, ROTID_NELSON, count, 0, &bands), ROTID_OK);
        assert_status(prediction_new(*state, model, ROTID_GUYAN, ROTID_NELSON, count, 0, &dense), ROTID_OK);
        dense.guyan.applies = 0;
        assert_int_equal(bands.guyan.applies, 1);
        double x[2] = {paper_start[0], paper_start[1]};
        for (int step = 0; step < 6; step++) {
            compare(&bands, &dense, x, wanted, 0);
            solved += bands.by_bands;
            for (int q = 0; q < 2; q++)
                x[q] *= 1 + pow(0.1, step) * random_uniform(&stream);
        }
    }
    assert_true(solved >= 58); /* of 72: the first ones of 12 have nothing to begin with */
}

/* Modes of the full model to begin with, as a run has them */
POOL_TEST(modes_of_the_full_model_are_near_enough)
{
    struct random_stream stream = {72};
    struct chosen c;
    struct prediction full, bands, dense;
    int wanted[8] = {0, 0, 1, 1, 1, 1, 1, 1};
    draw(*state, &stream, BUNDLE_TUBE, 1, 0.3, &c);
    rotid_model *model = &c.model.equations;
    assert_int_equal(model->nrigid, 2);
    assert_status(prediction_new(*state, model, ROTID_REDUCTION_NONE, ROTID_NELSON, 8, 0, &full), ROTID_OK);
    assert_status(prediction_compute(&full, paper_start), ROTID_OK);
    model->modes = full.phi;
    model->nmodes = 8;
    assert_status(prediction_new(*state, model, ROTID_GUYAN, ROTID_NELSON, 8, 0, &bands), ROTID_OK);
    assert_status(prediction_new(*state, model, ROTID_GUYAN, ROTID_NELSON, 8, 0, &dense), ROTID_OK);
    dense.guyan.applies = 0;
    compare(&bands, &dense, paper_start, wanted, 1);
}

/* Vectors that lead to the second to ninth bending modes: a Sturm count tells. */
POOL_TEST(a_mode_that_is_left_out_is_noticed)
{
    struct random_stream stream = {73};
    struct chosen c;
    struct prediction full, bands, dense;
    int wanted[8] = {0, 0, 1, 1, 1, 1, 1, 1};
    draw(*state, &stream, BUNDLE_TUBE, 1, 0.3, &c);
    rotid_model *model = &c.model.equations;
    assert_status(prediction_new(*state, model, ROTID_REDUCTION_NONE, ROTID_NELSON, 9, 0, &full), ROTID_OK);
    assert_status(prediction_compute(&full, paper_start), ROTID_OK);
    memmove(full.phi + 4 * (ptrdiff_t)model->n, full.phi + 5 * (ptrdiff_t)model->n, 4 * (size_t)model->n * sizeof *full.phi);
    model->modes = full.phi;
    model->nmodes = 8;
    assert_status(prediction_new(*state, model, ROTID_GUYAN, ROTID_NELSON, 8, 0, &bands), ROTID_OK);
    assert_status(prediction_new(*state, model, ROTID_GUYAN, ROTID_NELSON, 8, 0, &dense), ROTID_OK);
    dense.guyan.applies = 0;
    compare(&bands, &dense, paper_start, wanted, 0);
    assert_int_equal(bands.by_bands, 0);
}

struct host {
    rotid_matrix k, m;
};

static int host_matrices(void *user, const double *x, rotid_matrix *k, rotid_matrix *m)
{
    const struct host *host = user;
    (void)x;
    memcpy(k->band, host->k.band, 4 * (size_t)k->n * sizeof *k->band);
    memcpy(m->band, host->m.band, 4 * (size_t)m->n * sizeof *m->band);
    return 0;
}

/* A band in which no two neighbours part the left from the right */
POOL_TEST(other_matrices_take_the_dense_way)
{
    enum { N = 60 };
    struct random_stream stream = {74};
    struct host host;
    struct prediction p;
    int master[N / 2];
    random_positive(*state, &stream, N, 3, 0, NULL, 1, &host.k);
    random_positive(*state, &stream, N, 3, 0, NULL, 1, &host.m);
    for (int i = 0; i < N / 2; i++)
        master[i] = 2 * i;
    const rotid_model model = {
        .size = sizeof model, .n = N, .kd = 3, .nmaster = N / 2, .master = master, .matrices = host_matrices, .user = &host};
    assert_status(prediction_new(*state, &model, ROTID_GUYAN, ROTID_NELSON, 4, 0, &p), ROTID_OK);
    for (int pass = 0; pass < 3; pass++) {
        assert_status(prediction_compute(&p, NULL), ROTID_OK);
        assert_int_equal(p.by_bands, 0);
    }
}
