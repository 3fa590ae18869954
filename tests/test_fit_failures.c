/* A host whose model fails while it is fitted: once, for ever from the n-th call on, or beyond an edge; with derivatives of its
 * own, and where they are differences. */
#include <limits.h>

#include "dense.h"
#include "host_beam.h"
#include "support.h"

enum {
    MATRICES,
    DERIVATIVES,
    DIFFERENCES,
    KINDS
}; /* what fails: K and M, the host's derivatives, K and M that are differenced */

struct failing {
    struct beam_host host;
    int kind, calls, fail_at, for_ever; /* calls of what fails, from 1; fail_at 0: never */
    double edge;                        /* x1 beyond which there is no model */
};

static int fails(struct failing *f)
{
    f->calls++;
    return f->fail_at && (f->for_ever ? f->calls >= f->fail_at : f->calls == f->fail_at);
}

static int matrices(void *user, const double *x, rotid_matrix *k, rotid_matrix *m)
{
    struct failing *f = user;
    if (x[0] > f->edge || (f->kind != DERIVATIVES && fails(f)))
        return 1;
    return beam_matrices(&f->host, x, k, m);
}

static int derivatives(void *user, const double *x, int p, rotid_matrix *dk, rotid_matrix *dm)
{
    struct failing *f = user;
    return (f->kind == DERIVATIVES && fails(f)) || beam_derivatives(&f->host, x, p, dk, dm);
}

static void open_failing(struct pool *pool, int kind, struct failing *f, struct beam_data *data)
{
    *f = (struct failing){.kind = kind, .edge = INFINITY};
    beam_host_open(&f->host, 8, 0, 1, 1);
    beam_host_measure(pool, &f->host, ROTID_REDUCTION_NONE, data);
    f->host.model.matrices = matrices;
    f->host.model.derivatives = kind == DIFFERENCES ? NULL : derivatives;
    f->host.model.user = f;
}

static int fit(struct failing *f, const struct beam_data *data, rotid_fit_result **result)
{
    rotid_fit_options options = {.size = sizeof options, .functional = ROTID_LIKELIHOOD};
    f->calls = 0;
    return rotid_fit(&f->host.model, beam_parameters, &data->measured, &options, NULL, NULL, result);
}

/* Objective, residuals and frequencies are those of the x that came back. */
static void assert_belongs_together(const rotid_fit_result *result, const struct beam_data *data)
{
    const rotid_fit_iteration *last = &result->history[result->nhistory - 1];
    double sum = 0;
    for (int i = 0; i < result->nresidual; i++)
        sum += result->r[i] * result->r[i] / 2;
    assert_close(result->objective, sum, 1e-12, 0);
    assert_close(result->objective, last->objective, 1e-12, 0);
    assert_memory_equal(result->x, result->history_x + (result->nhistory - 1) * result->n, (size_t)result->n * sizeof *result->x);
    for (int k = 0; k < result->m; k++) {
        assert_close(result->predicted_hz[k], data->hz[k] * (1 + result->r[k] * data->hz_std[k]), 1e-12, 0);
        assert_true(result->mac[k] > 0.5 && result->mac[k] <= 1);
    }
    for (int p = 0; p < result->n; p++) { /* the Jacobian is that of this point: at an optimum J'r vanishes */
        double g = 0, square = 0;
        for (int i = 0; i < result->nresidual; i++) {
            double j = result->jacobian[i + p * result->nresidual];
            g += j * result->r[i];
            square += j * j;
        }
        assert_true(!result->converged || fabs(g) <= 1e-5 * sqrt(2 * square * result->objective));
    }
}

/* At the start a failure ends the call; later the fit ends with the best point it has reached, which it would have passed through
 * without the failure as well, and if that came once only, at the same minimum. */
POOL_TEST(the_best_point_comes_back_whenever_the_host_fails)
{
    for (int kind = 0; kind < KINDS; kind++) {
        struct failing f;
        struct beam_data data;
        rotid_fit_result *clean, *result;
        open_failing(*state, kind, &f, &data);
        assert_status(fit(&f, &data, &clean), ROTID_OK);
        assert_true(clean->converged);
        int calls = f.calls, nerror = 0, nstart = kind == MATRICES ? 1 : kind == DERIVATIVES ? 3 : 13;
        for (int for_ever = 0; for_ever < 2; for_ever++)
            for (int n = 1; n <= calls; n++) {
                f.fail_at = n;
                f.for_ever = for_ever;
                int status = fit(&f, &data, &result);
                if (status) {
                    assert_status(status, ROTID_ERROR_CALLBACK);
                    assert_null(result);
                    assert_true(n <= nstart);
                    nerror++;
                    continue;
                }
                assert_true(result->status > 0);
                assert_belongs_together(result, &data);
                if (for_ever)
                    assert_memory_equal(result->history_x, clean->history_x,
                                        (size_t)(result->nhistory * result->n) * sizeof *result->x);
                for (int p = 0; p < result->n && !for_ever; p++)
                    assert_close(result->x[p], clean->x[p], 1e-6, 0);
                assert_true(for_ever || result->converged);
                rotid_fit_free(result);
            }
        /* of differences at the start a single failure costs one side only */
        assert_int_equal(nerror, kind == DIFFERENCES ? 1 + nstart : 2 * nstart);
        rotid_fit_free(clean);
    }
}

/* A third parameter, whose derivative is of the size of rounding: of one entry of K, or of all that the first one moves. */
static double idle_share;

static int idle_derivatives(void *user, const double *x, int p, rotid_matrix *dk, rotid_matrix *dm)
{
    if (p < 2)
        return beam_derivatives(user, x, p, dk, dm);
    dk->band[0] = 1e-12;
    int status = idle_share > 0 ? beam_derivatives(user, x, 0, dk, dm) : 0;
    for (int i = 0; i < dk->n * (dk->kd + 1) && idle_share > 0; i++)
        dk->band[i] *= idle_share;
    return status;
}

POOL_TEST(a_parameter_that_does_nothing_holds_nothing_up)
{
    struct beam_host host;
    struct beam_data data;
    rotid_fit_result *clean, *result;
    const rotid_parameter three[3] = {beam_parameters[0], beam_parameters[1], {"idle", NULL, 0.1, 10, 1}};
    rotid_fit_options options = {.size = sizeof options, .functional = ROTID_LIKELIHOOD};
    beam_host_open(&host, 8, 0, 0, 1);
    beam_host_measure(*state, &host, ROTID_REDUCTION_NONE, &data);
    assert_status(rotid_fit(&host.model, three, &data.measured, &options, NULL, NULL, &clean), ROTID_OK);
    host.model.nparam = 3;
    host.model.derivatives = idle_derivatives;
    for (int all = 0; all < 2; all++) {
        idle_share = all * 1e-12;
        assert_status(rotid_fit(&host.model, three, &data.measured, &options, NULL, NULL, &result), ROTID_OK);
        assert_true(result->converged && result->any_undetermined);
        for (int p = 0; p < 2; p++) {
            assert_close(result->x[p], clean->x[p], 1e-8, 0);
            assert_true(result->identifiable[p] && isfinite(result->std[p]));
        }
        assert_close(result->x[2], 1, 1e-12, 0);
        assert_true(!result->identifiable[2] && isnan(result->std[2]));
        rotid_fit_free(result);
    }
    idle_share = 0;
    rotid_fit_free(clean);
}

/* The history is as long as it gets, not as long as it might: INT_MAX says that there is no limit. */
POOL_TEST(a_history_grows_with_the_iterations)
{
    struct beam_host host;
    struct beam_data data;
    rotid_fit_result *result;
    const rotid_parameter far[2] = {{"left", NULL, 0, 1e306, 1e150}, {"right", NULL, 0, 1e306, 1e150}};
    rotid_fit_options options = {.size = sizeof options, .functional = ROTID_LIKELIHOOD, .max_iterations = INT_MAX};
    beam_host_open(&host, 8, 0, 0, 1);
    beam_host_measure(*state, &host, ROTID_REDUCTION_NONE, &data);
    assert_status(rotid_fit(&host.model, far, &data.measured, &options, NULL, NULL, &result), ROTID_OK);
    print_message("%d iterations, %d rows, x %g %g, objective %g\n", result->iterations, result->nhistory, result->x[0],
                  result->x[1], result->objective);
    assert_true(result->iterations > 100);
    assert_int_equal(result->nhistory, result->iterations + 1);
    for (int i = 0; i < result->nhistory; i++) {
        assert_int_equal(result->history[i].iteration, i);
        assert_true(!i || result->history[i].objective <= result->history[i - 1].objective * (1 + 1e-6));
    }
    assert_belongs_together(result, &data);
    rotid_fit_free(result);
}

/* The minimum lies beyond the edge of the model: the fit ends near the edge, and says that it is no minimum. */
POOL_TEST(a_fit_ends_at_the_edge_of_the_model)
{
    for (int kind = MATRICES; kind < KINDS; kind += DIFFERENCES) {
        struct failing f;
        struct beam_data data;
        rotid_fit_result *result;
        open_failing(*state, kind, &f, &data);
        f.edge = 1.15;
        assert_status(fit(&f, &data, &result), ROTID_OK);
        assert_status(result->status, ROTID_STOP_STALLED);
        assert_true(!result->converged && result->x[0] <= f.edge);
        assert_close(result->x[0], f.edge, 1e-2, 0);
        assert_belongs_together(result, &data);
        rotid_fit_free(result);
    }
}
