/* Residuals between measured and predicted modes by their definitions, and their Jacobians by central differences. */
#include "dense.h"
#include "paper_rotor.h"

#include "linalg/linalg.h"
#include "modal/modal.h"
#include "model/model.h"
#include "support.h"

static const double two_pi = 6.28318530717958647692;

/* Five modes as somebody might list them: out of order, the last but one held out in some tests. */
enum { nparam = 3, nmode = 5, nmaster = PAPER_SENSORS / 2 };
static const int numbers_of_modes[nmode] = {2, 1, 5, 3, 4};
static const struct parameter parameters[nparam] = {
    {PARAMETER_E, 1, 0, 0, NULL}, {PARAMETER_G, 1, 0, 0, NULL}, {PARAMETER_RHO, 1, 0, 0, NULL}};
static const double here[nparam] = {0.6e11, 0.3e11, 7380.66}, truth[nparam] = {0.75e11, 0.25e11, 7600};

struct data {
    struct rotor_model client;
    double hz[nmode], frequency_std[nmode], shape[nmaster * nmode], shape_std[nmaster * nmode];
    int holdout[nmode];
    rotid_measured measured;
};

/* Modes of the full model at `truth` with noise on both; each shape with a scale and sign of its own. */
static const rotid_model *measure(struct pool *pool, double shape_noise, uint64_t seed, struct data *data)
{
    struct random_stream stream = {seed};
    struct prediction p;
    struct rotor *rotor = paper_rotor(BUNDLE_TUBE, 1);
    int failed;
    rotor->nsensor = nmaster; /* half of them make the Jacobians several times as fast, and show the same */
    for (int s = 0; s < nmaster; s++)
        rotor->sensor[s] = rotor->sensor[2 * s];
    assert_status(model_open(pool, NULL, rotor, nparam, parameters, 1, &data->client, &failed), ROTID_OK);
    const rotid_model *model = &data->client.equations;
    assert_status(prediction_new(pool, model, ROTID_REDUCTION_NONE, ROTID_NELSON, model->nrigid + 6, 0, &p), ROTID_OK);
    assert_status(prediction_compute(&p, truth), ROTID_OK);
    for (int k = 0; k < nmode; k++) {
        int pair = model->nrigid + numbers_of_modes[k] - 1;
        double largest = 0, scale = (k % 2 ? -1 : 1) * (k + 0.3);
        data->frequency_std[k] = 1e-3 * (k + 1);
        data->hz[k] = sqrt(p.lambda[pair]) / two_pi * (1 + data->frequency_std[k] * random_normal(&stream));
        for (int s = 0; s < nmaster; s++)
            largest = fmax(largest, fabs(prediction_at_sensor(&p, pair, s)));
        for (int s = 0; s < nmaster; s++) {
            double noisy = prediction_at_sensor(&p, pair, s) / largest + shape_noise * random_normal(&stream);
            data->shape[s + k * nmaster] = scale * noisy;
            data->shape_std[s + k * nmaster] = 0.01 * (1 + random_uniform(&stream));
        }
        data->holdout[k] = 0;
    }
    data->measured = (rotid_measured){.size = sizeof(rotid_measured),
                                      .nmode = nmode,
                                      .number = numbers_of_modes,
                                      .frequency_hz = data->hz,
                                      .frequency_std = data->frequency_std,
                                      .shape = data->shape,
                                      .shape_std = data->shape_std};
    return model;
}

/* Sensors that failed in one mode or another, and a mode whose shape was not measured at all. */
static int lose_sensors(struct data *data)
{
    int lost = 0;
    for (int i = 0; i < nmaster * nmode; i++)
        if (i % 11 == 3 || i / nmaster == 2) {
            data->shape[i] = i % 2 ? NAN : INFINITY;
            data->shape_std[i] = NAN; /* of no meaning where there is no value */
            lost++;
        }
    return lost;
}

static double *residual_here(struct pool *pool, struct functional *f, int kind, int reduction, int derivative,
                             const rotid_model *model, const rotid_measured *measured)
{
    assert_status(functional_new(pool, kind, reduction, derivative, model, measured, f), ROTID_OK);
    double *r = numbers(pool, f->nresidual);
    assert_status(functional_residual(f, here, r), ROTID_OK);
    return r;
}

/* (15, 16) from dense matrices and dense eigenvectors. */
POOL_TEST(hybrid_residuals_are_those_of_their_definition)
{
    for (int kind = ROTID_GUYAN; kind <= ROTID_IRS; kind++)
        for (int lost = 0; lost < 2; lost++) {
            struct data data;
            struct functional e, f;
            const rotid_model *model = measure(*state, 0.02, 61, &data);
            if (lost)
                lose_sensors(&data);
            const double *r_e = residual_here(*state, &e, ROTID_HYBRID, kind, ROTID_NELSON, model, &data.measured);
            const double *r_f = residual_here(*state, &f, ROTID_HYBRID_F, kind, ROTID_NELSON, model, &data.measured);
            assert_int_equal(e.nresidual, nmode);
            int n = model->n;
            const double *k = dense_of(*state, &e.prediction.k), *m = dense_of(*state, &e.prediction.m);
            const double *t = kind == ROTID_GUYAN ? dense_guyan(*state, n, k, nmaster, model->master)
                                                  : dense_irs(*state, n, k, m, nmaster, model->master);
            const double *kc = dense_congruence(*state, n, nmaster, k, t), *mc = dense_congruence(*state, n, nmaster, m, t);
            double lambda[nmaster], *phi = numbers(*state, nmaster * nmaster);
            dense_pairs(*state, nmaster, kc, mc, -1e6, lambda, phi);
            for (int mode = 0; mode < nmode; mode++) {
                int pair = model->nrigid + numbers_of_modes[mode] - 1;
                const double *right = phi + pair * nmaster;
                double numerator = 0, denominator = 0, omega = two_pi * data.hz[mode];
                for (int j = 0; j < nmaster; j++)
                    for (int i = 0; i < nmaster; i++) {
                        double left = data.shape[i + mode * nmaster];
                        if (!isfinite(left))
                            continue;
                        numerator += left * kc[i + j * nmaster] * right[j];
                        denominator += left * mc[i + j * nmaster] * right[j];
                    }
                double quotient = lost && mode == 2 ? lambda[pair] : numerator / denominator;
                assert_close(r_e[mode], 1 - quotient / (omega * omega), 0, 1e-9);
                assert_close(r_f[mode], 1 - quotient / (omega * sqrt(lambda[pair])), 0, 1e-9);
                assert_close(functional_frequency_residual(&e, mode), r_e[mode], 0, 0);
            }
        }
}

/* phi~ solves K~ phi~ = lambda~ M~ phi~, so the left vector cancels: the quotient carries no shape. */
POOL_TEST(the_hybrid_quotient_is_the_eigenvalue_under_any_noise)
{
    for (int kind = ROTID_GUYAN; kind <= ROTID_IRS; kind++)
        for (uint64_t seed = 1; seed <= 20; seed++) {
            struct data data;
            struct functional f;
            residual_here(*state, &f, ROTID_HYBRID, kind, ROTID_NELSON, measure(*state, 0.3, seed, &data), &data.measured);
            for (int mode = 0; mode < nmode; mode++) {
                double lambda = f.prediction.lambda[f.pair[mode]];
                assert_true(f.with_vectors);
                assert_close(f.quotient[mode], lambda, 1e-10, 0);
            }
        }
}

/* Frequencies first, then the shapes mode by mode, (a phi - phi^)/s with the a of least squares. */
POOL_TEST(likelihood_residuals_are_those_of_their_definition)
{
    for (int kind = ROTID_REDUCTION_NONE; kind <= ROTID_IRS; kind++) {
        struct data data;
        struct functional f;
        const rotid_model *model = measure(*state, 0.02, 62, &data);
        int lost = lose_sensors(&data), row = 0;
        const double *r = residual_here(*state, &f, ROTID_LIKELIHOOD, kind, ROTID_NELSON, model, &data.measured);
        assert_int_equal(f.nresidual, nmode + nmode * nmaster - lost);
        for (; row < nmode; row++) {
            double hz = sqrt(f.prediction.lambda[f.pair[row]]) / two_pi;
            assert_close(r[row], (hz - data.hz[row]) / (data.frequency_std[row] * data.hz[row]), 1e-10, 1e-10);
        }
        for (int mode = 0; mode < nmode; mode++) {
            const double *shape = data.shape + mode * nmaster, *std = data.shape_std + mode * nmaster;
            double largest = 0, top = 0, bottom = 0;
            for (int s = 0; s < nmaster; s++)
                if (isfinite(shape[s])) {
                    double phi = prediction_at_sensor(&f.prediction, f.pair[mode], s);
                    largest = fmax(largest, fabs(shape[s]));
                    top += phi * shape[s] / (std[s] * std[s]);
                    bottom += phi * phi / (std[s] * std[s]);
                }
            for (int s = 0; s < nmaster; s++)
                if (isfinite(shape[s])) {
                    double phi = prediction_at_sensor(&f.prediction, f.pair[mode], s);
                    assert_close(r[row++], (top / bottom * phi - shape[s]) / largest / std[s], 1e-10, 1e-10);
                }
        }
        assert_int_equal(row, f.nresidual);
    }
}

POOL_TEST(likelihood_does_not_see_scale_and_sign_of_a_shape)
{
    const double scale[nmode] = {-1, 1e-9, -3e7, 0.5, 1};
    const int kind = ROTID_LIKELIHOOD, full = ROTID_REDUCTION_NONE;
    struct data data;
    struct functional f, other;
    const rotid_model *model = measure(*state, 0.02, 63, &data);
    lose_sensors(&data);
    const double *r = residual_here(*state, &f, kind, full, ROTID_NELSON, model, &data.measured);
    for (int i = 0; i < nmaster * nmode; i++)
        data.shape[i] *= scale[i / nmaster];
    const double *scaled = residual_here(*state, &other, kind, full, ROTID_NELSON, model, &data.measured);
    assert_int_equal(other.nresidual, f.nresidual);
    for (int i = 0; i < f.nresidual; i++)
        assert_close(fabs(scaled[i]), fabs(r[i]), 1e-9, 1e-9);
}

/* Fourth order; rows [first, last) of column q relative to the largest of them. */
static void check_column(const double *jacobian, const double *difference, int first, int last)
{
    double largest = 0;
    for (int i = first; i < last; i++)
        largest = fmax(largest, fabs(difference[i]));
    assert_true(last == first || largest > 0);
    for (int i = first; i < last; i++)
        assert_close(jacobian[i], difference[i], 0, 1e-6 * largest);
}

static void check_jacobian(struct pool *pool, int kind, int reduction, int derivative, const rotid_model *model,
                           const rotid_measured *measured, int fitted)
{
    const double weight[4] = {1.0 / 12, -2.0 / 3, 2.0 / 3, -1.0 / 12}, at[4] = {-2, -1, 1, 2}, step = 2e-3;
    struct functional f, away;
    residual_here(pool, &f, kind, reduction, derivative, model, measured);
    assert_status(functional_new(pool, kind, reduction, derivative, model, measured, &away), ROTID_OK);
    int m = f.nresidual;
    double *jacobian = numbers(pool, (ptrdiff_t)m * nparam), *r = numbers(pool, m), *difference = numbers(pool, m);
    assert_status(functional_jacobian(&f, here, jacobian), ROTID_OK);
    for (int q = 0; q < nparam; q++) {
        memset(difference, 0, (size_t)m * sizeof *difference);
        for (int i = 0; i < 4; i++) {
            double x[nparam];
            memcpy(x, here, sizeof x);
            x[q] *= 1 + at[i] * step;
            assert_status(functional_residual(&away, x, r), ROTID_OK);
            for (int row = 0; row < m; row++)
                difference[row] += weight[i] / (step * here[q]) * r[row];
        }
        check_column(jacobian + (ptrdiff_t)q * m, difference, 0, fitted);
        check_column(jacobian + (ptrdiff_t)q * m, difference, fitted, m);
    }
}

POOL_TEST(jacobians_match_central_differences)
{
    for (int kind = ROTID_LIKELIHOOD; kind <= ROTID_HYBRID_F; kind++)
        for (int reduction = ROTID_REDUCTION_NONE; reduction <= ROTID_IRS; reduction++)
            for (int derivative = ROTID_NELSON; derivative <= (reduction ? ROTID_MODAL : ROTID_NELSON); derivative++) {
                struct data data;
                const rotid_model *model = measure(*state, 0.02, 64, &data);
                check_jacobian(*state, kind, reduction, derivative, model, &data.measured, nmode);
                data.measured.shape = NULL;
                check_jacobian(*state, kind, reduction, derivative, model, &data.measured, nmode);
                data.measured.shape = data.shape;
                data.measured.holdout = data.holdout;
                data.holdout[3] = 1;
                lose_sensors(&data);
                check_jacobian(*state, kind, reduction, derivative, model, &data.measured, nmode - 1);
            }
}

/* Mass and centre of mass are those of the model's geometry, and move with the density as differences say. */
POOL_TEST(what_the_rotor_weighs_stands_in_the_last_rows)
{
    for (int i = 0; i < 3; i++) {
        struct data data;
        struct functional f;
        struct mass_properties mass;
        const rotid_model *model = measure(*state, 0.02, 64, &data);
        double *whole = numbers(*state, 2 * model->n);
        model_whole(&data.client, whole);
        data.measured.whole = whole;
        data.measured.mass = 900;
        data.measured.mass_std = i == 1 ? 0 : 3;
        data.measured.centre = 1.1;
        data.measured.centre_std = i == 2 ? 0 : 0.02;
        const double *r = residual_here(*state, &f, ROTID_LIKELIHOOD, ROTID_REDUCTION_NONE, ROTID_NELSON, model, &data.measured);
        int m = f.nresidual, rows = i ? 1 : 2;
        model_mass_properties(&data.client, &mass);
        assert_int_equal(f.nwhole, rows);
        assert_int_equal(m, nmode * (1 + nmaster) + rows);
        if (i != 1)
            assert_close(r[m - rows], (mass.mass - 900) / 3, 1e-9, 0);
        if (i != 2)
            assert_close(r[m - 1], (mass.center - 1.1) / 0.02, 1e-9, 0);
        double *jacobian = numbers(*state, m * nparam), *moved[2] = {numbers(*state, m), numbers(*state, m)}, x[nparam];
        assert_status(functional_jacobian(&f, here, jacobian), ROTID_OK);
        for (int side = 0; side < 2; side++) {
            memcpy(x, here, sizeof x);
            x[2] *= side ? 1.01 : 0.99;
            assert_status(functional_residual(&f, x, moved[side]), ROTID_OK);
        }
        for (int row = m - rows; row < m; row++) {
            assert_close(jacobian[row], 0, 0, 1e-20); /* a modulus weighs nothing */
            assert_close(jacobian[row + 2 * m], (moved[1][row] - moved[0][row]) / (0.02 * here[2]), 1e-3, 0);
        }
        for (int k = 0; k < nmode; k++) /* nothing is fitted: neither is the weight */
            data.holdout[k] = 1;
        data.measured.holdout = data.holdout;
        assert_status(functional_new(*state, ROTID_LIKELIHOOD, ROTID_REDUCTION_NONE, ROTID_NELSON, model, &data.measured, &f),
                      ROTID_OK);
        assert_int_equal(f.nresidual, 0);
    }
}

POOL_TEST(held_out_modes_are_predicted_but_not_fitted)
{
    for (int kind = ROTID_LIKELIHOOD; kind <= ROTID_HYBRID_F; kind++) {
        struct data data;
        struct functional all, some;
        const rotid_model *model = measure(*state, 0.02, 65, &data);
        const double *r_all = residual_here(*state, &all, kind, ROTID_GUYAN, ROTID_NELSON, model, &data.measured);
        data.measured.holdout = data.holdout;
        data.holdout[0] = data.holdout[3] = 1;
        const double *r_some = residual_here(*state, &some, kind, ROTID_GUYAN, ROTID_NELSON, model, &data.measured);
        int row = 0, components = kind == ROTID_LIKELIHOOD ? nmaster : 0;
        assert_int_equal(some.nresidual, 3 * (1 + components));
        for (int k = 0; k < nmode; k++) {
            assert_close(functional_frequency_residual(&some, k), r_all[k], 1e-9, 1e-9);
            if (!data.holdout[k])
                assert_close(r_some[row++], r_all[k], 1e-9, 1e-9);
            assert_int_equal(some.wanted[some.pair[k]], !data.holdout[k]);
        }
        for (int k = 0; k < nmode && components; k++)
            for (int s = 0; s < nmaster && !data.holdout[k]; s++)
                assert_close(r_some[row++], r_all[nmode + s + k * nmaster], 1e-9, 1e-9);
        assert_int_equal(row, some.nresidual);
    }
}

/* A shape that is M~-orthogonal to the mode it is said to be leaves (15) without meaning, unless the mode is only compared. */
POOL_TEST(a_shape_orthogonal_to_its_partner_is_unpaired)
{
    for (int kind = ROTID_LIKELIHOOD; kind <= ROTID_HYBRID_F; kind++) {
        struct data data;
        struct functional f, wrong;
        const rotid_model *model = measure(*state, 0.02, 66, &data);
        residual_here(*state, &f, kind, ROTID_GUYAN, ROTID_NELSON, model, &data.measured);
        for (int s = 0; s < nmaster; s++) /* of mode 2, where mode 5 is said to be */
            data.shape[s + 2 * nmaster] = prediction_at_sensor(&f.prediction, f.pair[0], s);
        assert_status(functional_new(*state, kind, ROTID_GUYAN, ROTID_NELSON, model, &data.measured, &wrong), ROTID_OK);
        double *r = numbers(*state, wrong.nresidual);
        if (kind == ROTID_LIKELIHOOD)
            assert_status(functional_residual(&wrong, here, r), ROTID_OK); /* there it is a bad shape, no more */
        else
            assert_status(functional_residual(&wrong, here, r), ROTID_ERROR_UNPAIRED);
        data.measured.holdout = data.holdout;
        data.holdout[2] = 1;
        assert_status(functional_new(*state, kind, ROTID_GUYAN, ROTID_NELSON, model, &data.measured, &wrong), ROTID_OK);
        assert_status(functional_residual(&wrong, here, r), ROTID_OK);
    }
}

static int status_of(struct pool *pool, int kind, int reduction, const rotid_model *model, const rotid_measured *measured)
{
    struct functional f;
    return functional_new(pool, kind, reduction, ROTID_NELSON, model, measured, &f);
}

POOL_TEST(measured_data_out_of_range_are_refused)
{
    struct data data;
    const rotid_model *model = measure(*state, 0.02, 67, &data);
    int number[nmode];
    memcpy(number, numbers_of_modes, sizeof number);
    data.measured.number = number;
    data.measured.holdout = data.holdout;
    double *values[] = {&data.hz[1],
                        &data.hz[1],
                        &data.hz[1],
                        &data.hz[1],
                        &data.frequency_std[4],
                        &data.frequency_std[4],
                        &data.frequency_std[4],
                        &data.shape_std[40],
                        &data.shape_std[40],
                        &data.shape_std[40]};
    const double bad[] = {0, -1, NAN, INFINITY, 0, -1e-3, NAN, 0, -0.01, NAN};
    for (int kind = ROTID_LIKELIHOOD; kind <= ROTID_HYBRID_F; kind++) {
        assert_status(status_of(*state, kind, ROTID_GUYAN, model, &data.measured), ROTID_OK);
        for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
            double kept = *values[i];
            *values[i] = bad[i];
            assert_status(status_of(*state, kind, ROTID_GUYAN, model, &data.measured), ROTID_ERROR_ARGUMENT);
            *values[i] = kept;
        }
        number[0] = 0;
        assert_status(status_of(*state, kind, ROTID_GUYAN, model, &data.measured), ROTID_ERROR_ARGUMENT);
        number[0] = nmaster - model->nrigid; /* the last one that the condensed model has */
        assert_status(status_of(*state, kind, ROTID_GUYAN, model, &data.measured), ROTID_OK);
        number[0]++;
        assert_status(status_of(*state, kind, ROTID_GUYAN, model, &data.measured), ROTID_ERROR_UNPAIRED);
        assert_status(status_of(*state, kind, ROTID_REDUCTION_NONE, model, &data.measured), ROTID_OK);
        number[0] = numbers_of_modes[0];
        for (int k = 0; k < nmode; k++)
            data.holdout[k] = 1;
        assert_status(status_of(*state, kind, ROTID_GUYAN, model, &data.measured), ROTID_OK); /* among several states */
        memset(data.holdout, 0, sizeof data.holdout);
    }
    data.measured.shape_std = NULL; /* only the likelihood needs to know the noise */
    assert_status(status_of(*state, ROTID_HYBRID, ROTID_GUYAN, model, &data.measured), ROTID_OK);
    assert_status(status_of(*state, ROTID_LIKELIHOOD, ROTID_GUYAN, model, &data.measured), ROTID_ERROR_ARGUMENT);
    data.measured.shape_std = data.shape_std;
    data.measured.frequency_std = NULL;
    assert_status(status_of(*state, ROTID_HYBRID_F, ROTID_GUYAN, model, &data.measured), ROTID_OK);
    assert_status(status_of(*state, ROTID_LIKELIHOOD, ROTID_GUYAN, model, &data.measured), ROTID_ERROR_ARGUMENT);
}

POOL_TEST(any_allocation_that_fails_is_reported)
{
    for (int reduction = ROTID_REDUCTION_NONE; reduction <= ROTID_IRS; reduction++) {
        struct data data;
        const rotid_model *model = measure(*state, 0.02, 68, &data);
        int status = ROTID_ERROR_MEMORY;
        long n = 0;
        while (status) {
            struct failing_allocator failing;
            struct pool pool;
            failing_allocator_open(&failing, ++n);
            pool_open(&pool, &failing.allocator);
            status = status_of(&pool, ROTID_LIKELIHOOD, reduction, model, &data.measured);
            if (status)
                assert_status(status, ROTID_ERROR_MEMORY);
            pool_close(&pool);
            assert_int_equal(failing.in_use, 0);
            assert_true(n < 500);
        }
        assert_true(n > 50);
    }
}
