/* A fit over several states: the same numbers as one state where the model is the same, more where it is not; what each state has
 * for itself; and what is refused, by name. */
#include "host_beam.h"

#include "dense.h"
#include "modal/modal.h"
#include "support.h"

static const struct {
    int functional, reduction;
} ways[] = {{ROTID_LIKELIHOOD, ROTID_REDUCTION_NONE}, {ROTID_HYBRID, ROTID_GUYAN}, {ROTID_HYBRID_F, ROTID_IRS}};

enum { WAYS = sizeof ways / sizeof *ways };

/* The plain beam, and the beam with its ends tied, each with its own sensors. */
struct pair {
    struct beam_host host[2];
    struct beam_data data[2];
    rotid_state state[2];
    rotid_fit_options options;
    int holdout[2][BEAM_MODES];
};

static void pair_open(struct pool *pool, int way, int tied, struct pair *pair)
{
    *pair = (struct pair){0};
    for (int s = 0; s < 2; s++) {
        beam_host_open(&pair->host[s], 20, 0, s && tied, s && tied ? 4 : 2);
        beam_host_measure(pool, &pair->host[s], ways[way].reduction, &pair->data[s]);
        pair->data[s].measured.holdout = pair->holdout[s];
        pair->state[s] = (rotid_state){sizeof pair->state[s], &pair->host[s].model, &pair->data[s].measured, NULL};
    }
    if (tied && ways[way].reduction) /* six sensors are too few for five modes of a condensed model */
        pair->data[1].measured.nmode = 3;
    pair->options =
        (rotid_fit_options){.size = sizeof pair->options, .functional = ways[way].functional, .reduction = ways[way].reduction};
}

static rotid_fit_result *fit(const struct pair *pair, int nparam)
{
    rotid_fit_result *result;
    char failure[ROTID_FAILURE_LENGTH];
    int status = rotid_fit_states(2, pair->state, nparam, beam_parameters, &pair->options, NULL, failure, &result);
    if (status)
        print_message("%s\n", failure);
    assert_status(status, ROTID_OK);
    assert_int_equal(result->nstate, 2);
    return result;
}

static rotid_fit_result *fit_one(const struct pair *pair, int s, const rotid_measured *measured)
{
    rotid_fit_result *result;
    assert_status(rotid_fit(&pair->host[s].model, beam_parameters, measured, &pair->options, NULL, NULL, &result), ROTID_OK);
    return result;
}

/* The modes 1, 3, 5 in one state and 2, 4 in the other are the five modes in one. */
POOL_TEST(states_of_one_model_are_one_state_with_all_data)
{
    static int odd_out[BEAM_MODES] = {1, 0, 1, 0, 1}, even_out[BEAM_MODES] = {0, 1, 0, 1, 0};
    for (int w = 0; w < WAYS; w++) {
        struct pair pair;
        pair_open(*state, w, 0, &pair);
        memcpy(pair.holdout[0], even_out, sizeof even_out);
        memcpy(pair.holdout[1], odd_out, sizeof odd_out);
        rotid_measured all = pair.data[0].measured;
        all.holdout = NULL;
        rotid_fit_result *both = fit(&pair, 2), *one = fit_one(&pair, 0, &all);
        assert_true(both->converged && one->converged);
        assert_int_equal(both->nresidual, one->nresidual);
        assert_int_equal(both->dof, one->dof);
        assert_int_equal(both->m, 2 * one->m);
        assert_close(both->objective, one->objective, 1e-9, 0);
        assert_close(both->chi2, one->chi2, 1e-9, 0);
        for (int p = 0; p < 2; p++) {
            assert_close(both->x[p], one->x[p], 1e-9, 0);
            assert_close(both->std[p], one->std[p], 1e-6, 0);
            assert_close(both->ci_lower[p], one->ci_lower[p], 1e-6, 0);
        }
        for (int i = 0; i < both->m; i++) { /* the modes of each state stand in their order, held out or not */
            assert_close(both->predicted_hz[i], one->predicted_hz[i % BEAM_MODES], 1e-9, 0);
            assert_close(both->residual[i], one->residual[i % BEAM_MODES], 1e-6, 1e-9);
            assert_close(both->mac[i], one->mac[i % BEAM_MODES], 1e-9, 0);
        }
        for (int s = 0; s < 2; s++)
            assert_int_equal(both->state_m[s], BEAM_MODES);
        assert_int_equal(both->state_nresidual[0] + both->state_nresidual[1], one->nresidual);
        rotid_fit_free(both);
        rotid_fit_free(one);
    }
}

POOL_TEST(one_state_is_rotid_fit)
{
    for (int w = 0; w < WAYS; w++) {
        struct pair pair;
        rotid_fit_result *one, *plain;
        pair_open(*state, w, 1, &pair);
        pair.options.baseline = 1;
        assert_status(rotid_fit_states(1, &pair.state[1], 3, beam_parameters, &pair.options, NULL, NULL, &one), ROTID_OK);
        plain = fit_one(&pair, 1, &pair.data[1].measured);
        assert_int_equal(one->nstate + plain->nstate, 2);
        assert_int_equal(plain->state_nresidual[0], plain->nresidual);
        assert_memory_equal(one->x, plain->x, 3 * sizeof *one->x);
        assert_memory_equal(one->covariance, plain->covariance, 9 * sizeof *one->x);
        assert_int_equal(one->evaluations, plain->evaluations);
        assert_int_equal(one->nbaseline, plain->nbaseline);
        for (int b = 0; b < one->nbaseline; b++)
            assert_memory_equal(one->baseline[b].x, plain->baseline[b].x, 3 * sizeof *one->x);
        rotid_fit_free(one);
        rotid_fit_free(plain);
    }
}

/* One frequency of the tied beam leaves three unknowns open (that of mode 2, where the ends part), and the plain beam has no tie:
 * together they leave none open. NLopt finds the same point. */
POOL_TEST(two_states_determine_what_neither_does)
{
    struct pair pair;
    pair_open(*state, 0, 1, &pair);
    rotid_measured *tied = &pair.data[1].measured;
    tied->nmode = 1;
    tied->number++;
    tied->frequency_hz++;
    for (int k = 0; k < BEAM_MODES; k++) /* the tie moves its frequency by 2e-3 */
        pair.data[0].hz_std[k] = pair.data[1].hz_std[k] = 1e-4;
    tied->shape = NULL;
    rotid_fit_result *alone = fit_one(&pair, 1, tied);
    assert_true(alone->any_undetermined && !alone->identifiable[2]);
    pair.options.baseline = 1;
    rotid_fit_result *both = fit(&pair, 3);
    print_message("tie %.4f with standard deviation %.4f\n", both->x[2], both->std[2]);
    assert_true(both->converged && !both->any_undetermined && both->identifiable[2]);
    for (int p = 0; p < 3; p++)
        assert_close(both->x[p], beam_truth[p], 0.05, 0);
    assert_true(fabs(both->x[2] - beam_truth[2]) < 3 * both->std[2]);
    for (int b = 0; b < both->nbaseline; b++)
        for (int p = 0; p < 3; p++)
            assert_close(both->baseline[b].x[p], both->x[p], 1e-4, 0);
    assert_int_equal(both->state_nresidual[1], 1);
    rotid_fit_free(alone);
    rotid_fit_free(both);
}

/* The unknowns in another order, and each state with sensors of its own: the map decides. */
POOL_TEST(the_map_decides_which_unknown_a_parameter_is)
{
    static const int swapped[] = {2, 0, 1};
    const rotid_parameter turned[] = {beam_parameters[1], beam_parameters[2], beam_parameters[0]};
    for (int w = 0; w < WAYS; w++) {
        struct pair pair;
        rotid_fit_result *other;
        pair_open(*state, w, 1, &pair);
        rotid_fit_result *straight = fit(&pair, 3);
        pair.state[0].parameter = pair.state[1].parameter = swapped;
        assert_status(rotid_fit_states(2, pair.state, 3, turned, &pair.options, NULL, NULL, &other), ROTID_OK);
        for (int p = 0; p < 3; p++) {
            assert_close(other->x[swapped[p]], straight->x[p], 1e-8, 0);
            assert_close(other->std[swapped[p]], straight->std[p], 1e-5, 0);
        }
        assert_close(other->objective, straight->objective, 1e-8, 0);
        if (!ways[w].reduction)
            assert_int_equal(straight->nresidual, BEAM_MODES * (1 + 11) + BEAM_MODES * (1 + 6));
        rotid_fit_free(straight);
        rotid_fit_free(other);
    }
}

/* A state that is held out is predicted by what the other found, and has no part in that. */
POOL_TEST(a_held_out_state_is_predicted)
{
    struct pair pair;
    pair_open(*state, 0, 1, &pair);
    pair.host[1].model.nparam = 2; /* the tie is known there */
    pair.host[1].tied = 0;
    for (int k = 0; k < BEAM_MODES; k++)
        pair.holdout[1][k] = 1;
    rotid_fit_result *both = fit(&pair, 2), *one = fit_one(&pair, 0, &pair.data[0].measured);
    assert_memory_equal(both->x, one->x, 2 * sizeof *one->x);
    assert_memory_equal(both->std, one->std, 2 * sizeof *one->x);
    assert_close(both->chi2, one->chi2, 1e-14, 0);
    assert_int_equal(both->nresidual, one->nresidual);
    assert_int_equal(both->state_nresidual[1], 0);
    for (int k = 0; k < BEAM_MODES; k++) {
        assert_close(both->predicted_hz[BEAM_MODES + k], one->predicted_hz[k], 1e-12, 0);
        assert_true(isfinite(both->mac[BEAM_MODES + k]) && isfinite(both->residual[BEAM_MODES + k]));
    }
    rotid_fit_free(both);
    rotid_fit_free(one);
}

static int stacked(void *user, int m, int n, const double *x, double *r, double *jacobian)
{
    (void)m, (void)n;
    return r ? joint_residual(user, x, r) : joint_jacobian(user, x, jacobian);
}

/* Against differences of its residual, with a parameter for each half of one beam and one for both halves of the other. */
POOL_TEST(the_jacobian_is_that_of_the_residual)
{
    static const int halves[] = {0, 1}, both_halves[] = {1, 1, 2};
    for (int w = 0; w < WAYS; w++) {
        struct pair pair;
        struct joint joint;
        pair_open(*state, w, 1, &pair);
        pair.holdout[0][1] = 1;
        const struct joint_state states[] = {{&pair.host[0].model, &pair.data[0].measured, halves},
                                             {&pair.host[1].model, &pair.data[1].measured, both_halves}};
        assert_status(joint_new(*state, ways[w].functional, ways[w].reduction, ROTID_NELSON, 3, 2, states, NULL, &joint),
                      ROTID_OK);
        double x[] = {1.1, 0.75, 0.5}, error[3], doubt[3],
               *work = numbers(*state, (ptrdiff_t)rotid_check_jacobian_workspace(joint.nresidual, 3));
        assert_status(rotid_check_jacobian(joint.nresidual, 3, stacked, &joint, x, NULL, NULL, error, doubt, work), ROTID_OK);
        for (int p = 0; p < 3; p++) {
            print_message("way %d, column %d: error %.1e, doubt %.1e\n", w, p, error[p], doubt[p]);
            assert_true(error[p] < 1e-6 || error[p] < doubt[p]);
        }
    }
}

struct counted {
    struct beam_host *host;
    int calls, fail_with;
};

static int counted_matrices(void *user, const double *x, rotid_matrix *k, rotid_matrix *m)
{
    struct counted *counted = user;
    counted->calls++;
    return counted->fail_with ? counted->fail_with : beam_matrices(counted->host, x, k, m);
}

static int counted_derivatives(void *user, const double *x, int p, rotid_matrix *dk, rotid_matrix *dm)
{
    return beam_derivatives(((struct counted *)user)->host, x, p, dk, dm);
}

static void count_calls(struct pair *pair, struct counted *counted)
{
    for (int s = 0; s < 2; s++) {
        counted[s] = (struct counted){.host = &pair->host[s]};
        pair->host[s].model.matrices = counted_matrices;
        pair->host[s].model.derivatives = counted_derivatives;
        pair->host[s].model.user = &counted[s];
    }
}

/* An evaluation asks each model once. */
POOL_TEST(an_evaluation_costs_the_sum_of_the_states)
{
    struct pair pair;
    struct counted counted[2];
    pair_open(*state, 0, 1, &pair);
    count_calls(&pair, counted);
    rotid_fit_result *result = fit(&pair, 3);
    for (int s = 0; s < 2; s++)
        assert_int_equal(counted[s].calls, result->evaluations);
    rotid_fit_free(result);
}

static char failure[ROTID_FAILURE_LENGTH];

static int ends(const struct pair *pair, int nstate, int nparam, const rotid_parameter *parameter)
{
    rotid_fit_result *result = (void *)&failure; /* must be overwritten in any case */
    (void)memset(failure, '?', sizeof failure);
    int status = rotid_fit_states(nstate, pair->state, nparam, parameter, &pair->options, NULL, failure, &result);
    assert_int_equal(result != NULL, status == ROTID_OK);
    rotid_fit_free(result);
    return status;
}

POOL_TEST(what_is_refused_is_named)
{
    static const int beyond[] = {0, 3, 1}, below[] = {0, -1}, twice[] = {0, 0, 1};
    struct pair pair;
#define refused(change, nstate, nparam, text)                                                                                    \
    pair_open(*state, 0, 1, &pair);                                                                                              \
    change;                                                                                                                      \
    assert_status(ends(&pair, nstate, nparam, beam_parameters), ROTID_ERROR_ARGUMENT);                                           \
    assert_string_equal(failure, text)
    refused((void)0, 0, 3, "nstate is 0, expected 1 or more");
    refused((void)0, 2, -1, "nparam is -1, expected 0 or more");
    refused(pair.state[1].model = NULL, 2, 3, "state[1]: model is NULL, expected a struct");
    refused(pair.state[0].measured = NULL, 2, 3, "state[0]: measured is NULL, expected a struct");
    refused(pair.state[1].size = 24, 2, 3, "state[1].size is 24, expected that of the first, 32");
    refused(pair.host[1].model.n = 1, 2, 3, "state[1]: model->n is 1, expected 2 or more");
    refused(pair.data[0].measured.nmode = 0, 2, 3, "state[0]: measured->nmode is 0, expected 1 or more");
    refused(pair.options.functional = 9, 2, 3,
            "options->functional is 9, expected ROTID_LIKELIHOOD, ROTID_HYBRID or ROTID_HYBRID_F");
    refused((void)0, 2, 2, "state[1]: parameter is NULL and model->nparam is 3, expected at most nparam = 2");
    refused(pair.state[1].parameter = beyond, 2, 3, "state[1]: parameter[1] is 3, expected an unknown, 0 ... 2 (nparam - 1)");
    refused(pair.state[0].parameter = below, 2, 3, "state[0]: parameter[1] is -1, expected an unknown, 0 ... 2 (nparam - 1)");
    refused((void)0, 1, 3, "parameter[2] tie is used by no state, expected one that is fitted");
    refused(pair.state[1].parameter = twice, 2, 3, "parameter[2] tie is used by no state, expected one that is fitted");
    refused(memset(pair.holdout[1], 1, sizeof pair.holdout[1]), 2, 3,
            "parameter[2] tie is used by no state but such as are held out, expected one that is fitted");
    refused(memset(pair.holdout, 1, sizeof pair.holdout), 2, 3,
            "measured->holdout leaves no mode to be fitted in any state, expected a 0 in it");
#undef refused
    pair_open(*state, 0, 1, &pair);
    assert_status(ends(&pair, 2, 3, NULL), ROTID_ERROR_ARGUMENT);
    assert_string_equal(failure, "parameter is NULL, expected nparam = 3 of them");
    assert_status(rotid_fit_states(2, NULL, 3, beam_parameters, &pair.options, NULL, failure, NULL), ROTID_ERROR_ARGUMENT);
    assert_string_equal(failure, "state is NULL, expected a struct");
    pair.state[0].size = 0;
    assert_status(ends(&pair, 1, 3, beam_parameters), ROTID_ERROR_ARGUMENT);
    assert_string_equal(failure, "state[0]: state->size is 0, expected sizeof(rotid_state), here 32");
}

POOL_TEST(a_model_that_fails_is_named)
{
    struct pair pair;
    struct counted counted[2];
    pair_open(*state, 0, 1, &pair);
    count_calls(&pair, counted);
    counted[1].fail_with = 7;
    assert_status(ends(&pair, 2, 3, beam_parameters), ROTID_ERROR_CALLBACK);
    assert_string_equal(failure, "state[1]: model->matrices returned 7");
}

/* Hosts of a later version have more behind the last member: zeros are taken, anything else is refused. */
POOL_TEST(states_of_a_later_version_are_taken)
{
    struct {
        rotid_state state;
        void *later;
    } newer[2];
    struct pair pair;
    rotid_fit_result *result;
    pair_open(*state, 0, 1, &pair);
    for (int s = 0; s < 2; s++) {
        newer[s].state = pair.state[s];
        newer[s].state.size = sizeof newer[s];
        newer[s].later = NULL;
    }
    assert_status(rotid_fit_states(2, &newer->state, 3, beam_parameters, &pair.options, NULL, NULL, &result), ROTID_OK);
    rotid_fit_free(result);
    newer[1].later = &pair;
    assert_status(rotid_fit_states(2, &newer->state, 3, beam_parameters, &pair.options, NULL, failure, &result),
                  ROTID_ERROR_ARGUMENT);
    assert_non_null(strstr(failure, "state[1]: state->size is 40"));
}

POOL_TEST(every_failing_allocation_is_survived)
{
    struct pair pair;
    pair_open(*state, 0, 1, &pair);
    for (int n = 1;; n++) {
        struct failing_allocator failing;
        rotid_fit_result *result = (void *)&pair;
        failing_allocator_open(&failing, n);
        const rotid_environment environment = {.size = sizeof environment, .allocator = &failing.allocator};
        int status = rotid_fit_states(2, pair.state, 3, beam_parameters, &pair.options, &environment, NULL, &result);
        if (status)
            assert_status(status, ROTID_ERROR_MEMORY);
        assert_int_equal(!result, status != ROTID_OK);
        assert_int_equal(!status, failing.until_failure > 0);
        rotid_fit_free(result);
        assert_int_equal(failing.in_use, 0);
        assert_true(n < 1000);
        if (!status) {
            print_message("two states: %d allocations\n", n - 1);
            return;
        }
    }
}
