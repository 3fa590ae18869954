/* A host that builds its matrices with the building blocks and fits its own parameters: the storage of the matrices, the size of
 * the model and whether there are derivatives make no difference to what is found. */
#include "dense.h"
#include "host_beam.h"
#include "support.h"

static rotid_fit_result *fit(struct beam_host *host, const struct beam_data *data, int functional, int reduction)
{
    rotid_fit_options options = {.size = sizeof options, .functional = functional, .reduction = reduction};
    rotid_fit_result *result;
    assert_status(rotid_fit(&host->model, beam_parameters, &data->measured, &options, NULL, NULL, &result), ROTID_OK);
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
POOL_TEST(the_storage_does_not_matter)
{
    for (size_t w = 0; w < sizeof ways / sizeof *ways; w++) {
        struct beam_host bordered, wide, dense;
        struct beam_data data;
        beam_host_open(&bordered, 20, 0, 1, 1);
        beam_host_open(&wide, 20, 40, 1, 1);
        beam_host_open(&dense, 20, 41, 1, 1);
        beam_host_measure(*state, &bordered, ways[w].reduction, &data);
        rotid_fit_result *a = fit(&bordered, &data, ways[w].functional, ways[w].reduction),
                         *b = fit(&wide, &data, ways[w].functional, ways[w].reduction),
                         *c = fit(&dense, &data, ways[w].functional, ways[w].reduction);
        assert_same_fit(b, a, 1e-7);
        assert_same_fit(c, a, 1e-7);
        for (int p = 0; p < 3 && ways[w].reduction == ROTID_REDUCTION_NONE; p++)
            assert_close(a->x[p], beam_truth[p], 0.05, 0); /* of errors of 1e-4 in the frequencies */
        rotid_fit_free(a);
        rotid_fit_free(b);
        rotid_fit_free(c);
    }
}

POOL_TEST(a_host_without_derivatives_finds_the_same)
{
    for (size_t w = 0; w < sizeof ways / sizeof *ways; w++)
        for (int dense = 0; dense < 2; dense++) {
            struct beam_host with, without;
            struct beam_data data;
            beam_host_open(&with, 20, dense ? 41 : 0, 1, 2);
            beam_host_open(&without, 20, dense ? 41 : 0, 1, 2);
            without.model.derivatives = NULL;
            beam_host_measure(*state, &with, ways[w].reduction, &data);
            rotid_fit_result *a = fit(&with, &data, ways[w].functional, ways[w].reduction),
                             *b = fit(&without, &data, ways[w].functional, ways[w].reduction);
            assert_same_fit(b, a, 1e-7);
            rotid_fit_free(a);
            rotid_fit_free(b);
        }
}

/* 1200 degrees of freedom, 600 of them masters. */
POOL_TEST(large_models_are_fitted_as_well)
{
    static const int large[][2] = {{ROTID_HYBRID, ROTID_GUYAN}, {ROTID_LIKELIHOOD, ROTID_REDUCTION_NONE}};
    for (int w = 0; w < 2; w++) {
        struct beam_host narrow, dense;
        struct beam_data data;
        beam_host_open(&narrow, 599, 0, 0, 1);
        beam_host_open(&dense, 599, 1199, 0, 1);
        assert_int_equal(narrow.model.nmaster, 600);
        beam_host_measure(*state, &narrow, large[w][1], &data);
        rotid_fit_result *a = fit(&narrow, &data, large[w][0], large[w][1]), *b = fit(&dense, &data, large[w][0], large[w][1]);
        print_message("1200 degrees of freedom, reduction %d: band %.2f s, dense %.2f s, evaluations %d and %d\n", large[w][1],
                      a->seconds, b->seconds, a->evaluations, b->evaluations);
        assert_same_fit(b, a, 1e-6);
        for (int p = 0; p < 2; p++)
            assert_close(a->x[p], beam_truth[p], 0.01, 0);
        rotid_fit_free(a);
        rotid_fit_free(b);
    }
}
