/* Derivatives of the modes of the paper's rotor with respect to seven parameters. */
#include "dense.h"
#include "derivative_check.h"
#include "paper_rotor.h"

#include "linalg/linalg.h"
#include "modal/modal.h"
#include "model/model.h"
#include "support.h"

/* The left spring is stiff enough to be felt by the bending modes. */
enum { nparam = 7 };
static const struct parameter seven[nparam] = {{PARAMETER_E, 1, 0, 0, NULL},       {PARAMETER_G, 1, 0, 0, NULL},
                                               {PARAMETER_NU, 1, 0, 0, NULL},      {PARAMETER_RHO, 1, 0, 0, NULL},
                                               {PARAMETER_TENSION, 0, 0, 0, NULL}, {PARAMETER_TIEROD_E, 0, 0, 0, NULL},
                                               {PARAMETER_SPRING_K, 0, 0, 0, NULL}};
static const double rotor_values[nparam] = {0.6e11, 0.3e11, 0.28, 7380.66, 150e3, 2.1e11, 1e8};
/* relative: as large as the curvature allows, since the bending modes hardly feel some of these */
static const double rotor_steps[nparam] = {2e-3, 2e-3, 1e-2, 2e-3, 0.5, 2e-2, 2e-2};

static const rotid_model *open_rotor(struct pool *pool, enum bundle_model bundle, struct rotor_model *client)
{
    int failed;
    struct rotor *rotor = paper_rotor(bundle, 0);
    rotor->spring[0].lateral = rotor_values[6];
    assert_status(model_open(pool, NULL, rotor, nparam, seven, 1, client, &failed), ROTID_OK);
    return &client->equations;
}

POOL_TEST(derivatives_of_the_papers_rotor_match_differences)
{
    for (int bundle = BUNDLE_RODS; bundle <= BUNDLE_TUBE; bundle++) {
        struct rotor_model client;
        const rotid_model *model = open_rotor(*state, (enum bundle_model)bundle, &client);
        int first = model->nrigid, count = first + 4;
        check_derivatives(*state, model, ROTID_REDUCTION_NONE, ROTID_NELSON, first, count, rotor_values, rotor_steps, 1e-6);
        check_derivatives(*state, model, ROTID_GUYAN, ROTID_NELSON, first, count, rotor_values, rotor_steps, 1e-6);
        check_derivatives(*state, model, ROTID_IRS, ROTID_NELSON, first, count, rotor_values, rotor_steps, 1e-6);
    }
}

/* All of them with both methods at once. */
POOL_TEST(nelson_and_modal_superposition_agree)
{
    for (int kind = ROTID_GUYAN; kind <= ROTID_IRS; kind++) {
        struct rotor_model client;
        const rotid_model *model = open_rotor(*state, BUNDLE_TUBE, &client);
        struct prediction nelson, modal;
        int count = model->nrigid + 6, wanted[PAPER_SENSORS] = {0};
        for (int k = model->nrigid; k < count; k++)
            wanted[k] = 1;
        assert_status(prediction_new(*state, model, kind, ROTID_NELSON, count, 1, &nelson), ROTID_OK);
        assert_status(prediction_new(*state, model, kind, ROTID_MODAL, count, 1, &modal), ROTID_OK);
        assert_int_equal(modal.count, PAPER_SENSORS); /* the superposition needs them all */
        assert_status(prediction_compute(&nelson, rotor_values), ROTID_OK);
        assert_status(prediction_compute(&modal, rotor_values), ROTID_OK);
        assert_status(prediction_differentiate(&nelson, rotor_values, wanted, 1), ROTID_OK);
        assert_status(prediction_differentiate(&modal, rotor_values, wanted, 1), ROTID_OK);
        for (int k = model->nrigid; k < count; k++)
            for (int q = 0; q < nparam; q++) {
                double a[PAPER_SENSORS], b[PAPER_SENSORS], dot = 0;
                for (int s = 0; s < PAPER_SENSORS; s++) {
                    dot += prediction_at_sensor(&nelson, k, s) * prediction_at_sensor(&modal, k, s);
                    a[s] = prediction_derivative_at_sensor(&nelson, k, q, s);
                    b[s] = prediction_derivative_at_sensor(&modal, k, q, s);
                }
                for (int s = 0; s < PAPER_SENSORS && dot < 0; s++)
                    b[s] = -b[s];
                assert_close(relative_difference(PAPER_SENSORS, a, b), 0, 0, 1e-8);
            }
    }
}

/* phi' M phi = 1 at every x: 2 phi' M dphi = -phi' dM phi; rho is what moves M. */
POOL_TEST(derivatives_keep_the_normalisation)
{
    struct rotor_model client;
    const rotid_model *model = open_rotor(*state, BUNDLE_RODS, &client);
    struct prediction p;
    int n = model->n, count = model->nrigid + 6, wanted[16] = {0};
    double *work = numbers(*state, n);
    for (int k = model->nrigid; k < count; k++)
        wanted[k] = 1;
    assert_status(prediction_new(*state, model, ROTID_REDUCTION_NONE, ROTID_NELSON, count, 1, &p), ROTID_OK);
    assert_status(prediction_compute(&p, rotor_values), ROTID_OK);
    assert_status(prediction_differentiate(&p, rotor_values, wanted, 1), ROTID_OK);
    for (int q = 0; q < nparam; q++) {
        matrix_zero(&p.dk);
        matrix_zero(&p.dm);
        assert_int_equal(model->derivatives(model->user, rotor_values, q, &p.dk, &p.dm), 0);
        for (int k = model->nrigid; k < count; k++) {
            const double *phi = p.phi + (ptrdiff_t)k * n, *dphi = p.dphi + prediction_place(&p, k, q);
            double change = matrix_product(&p.dm, phi, phi, work), size = sqrt(matrix_product(&p.m, dphi, dphi, work));
            assert_close(matrix_product(&p.m, phi, dphi, work), -0.5 * change, 0, 1e-10 * size);
            if (seven[q].kind == PARAMETER_RHO)
                assert_true(change * rotor_values[q] > 0.1);
        }
    }
}

/* Without derivatives of its own a model gets differences of its matrices. */
POOL_TEST(a_model_without_derivatives_gets_the_same)
{
    for (int kind = ROTID_REDUCTION_NONE; kind <= ROTID_IRS; kind++) {
        struct rotor_model client;
        rotid_model bare = *open_rotor(*state, BUNDLE_TUBE, &client), *models[2] = {&client.equations, &bare};
        struct prediction p[2];
        int count = bare.nrigid + 4, wanted[16] = {0};
        bare.derivatives = NULL;
        for (int k = bare.nrigid; k < count; k++)
            wanted[k] = 1;
        for (int i = 0; i < 2; i++) {
            assert_status(prediction_new(*state, models[i], kind, ROTID_NELSON, count, 1, &p[i]), ROTID_OK);
            assert_status(prediction_compute(&p[i], rotor_values), ROTID_OK);
            assert_status(prediction_differentiate(&p[i], rotor_values, wanted, 1), ROTID_OK);
        }
        for (int k = bare.nrigid; k < count; k++)
            for (int q = 0; q < nparam; q++) {
                ptrdiff_t place = prediction_place(&p[0], k, q);
                assert_close(p[1].dlambda[k + q * p[0].count], p[0].dlambda[k + q * p[0].count], 1e-6, 0);
                assert_close(relative_difference((size_t)p[0].size, p[1].dphi + place, p[0].dphi + place), 0, 0, 1e-6);
            }
    }
}
