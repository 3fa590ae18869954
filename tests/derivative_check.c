#include "derivative_check.h"

#include "dense.h"
#include "modal/modal.h"

static double largest(int n, const double *x)
{
    double most = 0;
    for (int i = 0; i < n; i++)
        most = fmax(most, fabs(x[i]));
    return most;
}

/* Of all modes with respect to x_q: dlambda [count] and dphi [size * count]. Vectors are turned to the sign of those that p
 * holds, at x; their scale is that of phi' M phi = 1 everywhere. `away` computes at the points beside x: p stays there. */
static void differentiate_numerically(struct pool *pool, const struct prediction *p, struct prediction *away, const double *x,
                                      int q, double step, double *dlambda, double *dphi)
{
    const double weight[4] = {1.0 / 12, -2.0 / 3, 2.0 / 3, -1.0 / 12}, at[4] = {-2, -1, 1, 2};
    int n = p->size, nx = p->model->nparam;
    double *moved = numbers(pool, nx);
    memset(dphi, 0, (size_t)n * (size_t)p->count * sizeof *dphi);
    memset(dlambda, 0, (size_t)p->count * sizeof *dlambda);
    for (int i = 0; i < 4; i++) {
        memcpy(moved, x, (size_t)nx * sizeof *x);
        moved[q] *= 1 + at[i] * step;
        assert_status(prediction_compute(away, moved), ROTID_OK);
        for (int k = 0; k < p->count; k++) {
            const double *phi = away->phi + (ptrdiff_t)k * n, *at_x = p->phi + (ptrdiff_t)k * n;
            double dot = 0, factor = weight[i] / (step * x[q]);
            for (int j = 0; j < n; j++)
                dot += phi[j] * at_x[j];
            dlambda[k] += factor * away->lambda[k];
            for (int j = 0; j < n; j++)
                dphi[j + (ptrdiff_t)k * n] += (dot < 0 ? -factor : factor) * phi[j];
        }
    }
}

void check_derivatives(struct pool *pool, const rotid_model *model, int reduction, int derivative, int first, int count,
                       const double *x, const double *steps, double tolerance)
{
    struct prediction p, away, scalar;
    assert_status(prediction_new(pool, model, reduction, derivative, count, 1, &p), ROTID_OK);
    assert_status(prediction_new(pool, model, reduction, derivative, count, 1, &away), ROTID_OK);
    assert_status(prediction_new(pool, model, reduction, derivative, p.count, 0, &scalar), ROTID_OK);
    int n = p.size, *wanted = POOL_ARRAY(pool, int, p.count);
    double *dphi = numbers(pool, (ptrdiff_t)n * p.count), *dlambda = numbers(pool, p.count), *difference = numbers(pool, n);
    for (int k = first; k < count; k++)
        wanted[k] = 1;
    assert_status(prediction_compute(&scalar, x), ROTID_OK);
    assert_status(prediction_differentiate(&scalar, x, wanted, 0), ROTID_OK);
    assert_status(prediction_compute(&p, x), ROTID_OK);
    assert_status(prediction_differentiate(&p, x, wanted, 1), ROTID_OK);
    for (int q = 0; q < model->nparam; q++) {
        differentiate_numerically(pool, &p, &away, x, q, steps[q], dlambda, dphi);
        for (int k = first; k < count; k++) {
            const double *expected = dphi + (ptrdiff_t)k * n, *analytic = p.dphi + prediction_place(&p, k, q);
            assert_true(fabs(dlambda[k] * x[q]) > 1e-7 * p.lambda[k]); /* the parameter acts, or the test shows nothing */
            assert_close(p.dlambda[k + q * p.count], dlambda[k], tolerance, 0);
            assert_close(scalar.dlambda[k + q * p.count], dlambda[k], tolerance, 0);
            for (int i = 0; i < n; i++)
                difference[i] = analytic[i] - expected[i];
            assert_close(largest(n, difference), 0, 0, tolerance * largest(n, expected));
        }
    }
}
