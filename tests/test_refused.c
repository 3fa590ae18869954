/* What a host is told of an argument that cannot be: which one, its value, and what was expected; and what is refused at all, an
 * allocator without a function, a block that is not symmetric, a struct of another size. */
#include "header.h"
#include "support.h"

#define PAPER ROTID_SOURCE_DIR "/input/paper_rotor.inp"

static char failure[ROTID_FAILURE_LENGTH];

#define assert_refused(call, text)                                                                                               \
    do {                                                                                                                         \
        (void)memset(failure, '?', sizeof failure);                                                                              \
        assert_status((call), ROTID_ERROR_ARGUMENT);                                                                             \
        assert_string_equal(failure, (text));                                                                                    \
    } while (0)

/* Three masses of 1 kg on springs of 3 N/m, the outer ones joined by one of 1 N/m across the band. */
struct chain {
    int far[2];
    double k_band[6], m_band[6], k_block[4], m_block[4];
    rotid_matrix k, m;
};

static void chain_open(struct chain *c)
{
    *c = (struct chain){.far = {0, 2}, .k_band = {4, -1, 5, -1, 4, 0}, .m_band = {1, 0, 1, 0, 1, 0}, .k_block = {0, -1, -1, 0}};
    c->k = (rotid_matrix){3, 1, 2, c->far, c->k_band, c->k_block};
    c->m = (rotid_matrix){3, 1, 2, c->far, c->m_band, c->m_block};
}

/* The same as a model, the springs x[0]; `chain` is what it has, with what a test has made of it. */
static int matrices(void *user, const double *x, rotid_matrix *k, rotid_matrix *m)
{
    const struct chain *c = user;
    memcpy(k->band, c->k_band, sizeof c->k_band);
    memcpy(m->band, c->m_band, sizeof c->m_band);
    memcpy(k->block, c->k_block, sizeof c->k_block);
    memcpy(m->block, c->m_block, sizeof c->m_block);
    k->band[0] += x[0] - 3;
    return c->m_band[0] < 0 ? 7 : 0;
}

static int derivatives(void *user, const double *x, int p, rotid_matrix *k, rotid_matrix *m)
{
    (void)user, (void)x, (void)m;
    k->band[0] = 1;
    k->block[1] = 0.5;
    return p;
}

struct fit {
    struct chain chain;
    int number[2];
    double hz[2], hz_std[2], shape[4], shape_std[4];
    int master[2], holdout[2];
    rotid_model model;
    rotid_parameter parameter[1];
    rotid_measured measured;
    rotid_fit_options options;
};

static void fit_open(struct fit *f)
{
    *f = (struct fit){.number = {1, 2},
                      .hz = {0.3, 0.36},
                      .hz_std = {0.01, 0.01},
                      .shape = {1, 1, 1, -1},
                      .shape_std = {0.1, 0.1, 0.1, 0.1},
                      .master = {0, 2},
                      .parameter = {{"spring", "N/m", 1, 10, 3}}};
    chain_open(&f->chain);
    f->model = (rotid_model){.size = sizeof f->model,
                             .n = 3,
                             .kd = 1,
                             .nfar = 2,
                             .far = f->chain.far,
                             .nparam = 1,
                             .nmaster = 2,
                             .master = f->master,
                             .matrices = matrices,
                             .user = &f->chain};
    f->measured = (rotid_measured){.size = sizeof f->measured,
                                   .nmode = 2,
                                   .number = f->number,
                                   .frequency_hz = f->hz,
                                   .frequency_std = f->hz_std,
                                   .shape = f->shape,
                                   .shape_std = f->shape_std,
                                   .holdout = f->holdout};
    f->options = (rotid_fit_options){.size = sizeof f->options, .functional = ROTID_LIKELIHOOD};
}

static int fit(const struct fit *f, const rotid_environment *environment)
{
    rotid_fit_result *result = (void *)&failure; /* must be overwritten in any case */
    int status = rotid_fit(&f->model, f->parameter, &f->measured, &f->options, environment, failure, &result);
    assert_int_equal(result != NULL, status == ROTID_OK);
    rotid_fit_free(result);
    return status;
}

/* Zeros, NULL and rotid_fit_defaults are one choice. */
UNIT_TEST(options_have_one_default)
{
    struct fit f;
    fit_open(&f);
    double chi2[3], x[3];
    rotid_fit_options zeros = {.size = sizeof zeros}, defaults;
    rotid_fit_defaults(sizeof defaults, &defaults);
    const rotid_fit_options *options[] = {&zeros, NULL, &defaults};
    for (int i = 0; i < 3; i++) {
        rotid_fit_result *result;
        assert_status(rotid_fit(&f.model, f.parameter, &f.measured, options[i], NULL, failure, &result), ROTID_OK);
        chi2[i] = result->chi2;
        x[i] = result->x[0];
        assert_close(result->objective, result->chi2 / 2, 1e-12, 0); /* weighed by the noise */
        rotid_fit_free(result);
    }
    for (int i = 1; i < 3; i++) {
        assert_true(x[i] == x[0]);
        assert_true(chi2[i] == chi2[0]);
    }
}

/* ---- which argument it is */

UNIT_TEST(a_fit_names_what_it_refuses)
{
    struct fit f, good;
    static int backwards[] = {2, 0};
    fit_open(&good);
    failure[0] = '?';
    assert_status(fit(&good, NULL), ROTID_OK);
    assert_string_equal(failure, "");
#define refused(change, text)                                                                                                    \
    fit_open(&f);                                                                                                                \
    change;                                                                                                                      \
    assert_refused(fit(&f, NULL), text)
    refused(f.model.n = 1, "model->n is 1, expected 2 or more");
    refused(f.model.kd = 7, "model->kd is 7, expected 0 ... 2 (n - 1)");
    refused(f.model.nparam = -1, "model->nparam is -1, expected 0 or more");
    refused(f.model.nrigid = -2, "model->nrigid is -2, expected 0 or more");
    refused(f.model.matrices = NULL, "model->matrices is NULL, expected a function");
    refused(f.model.nmaster = 4, "nmaster is 4, expected 0 ... 3");
    refused(f.model.master = NULL, "master is NULL, expected nmaster = 2 indices");
    refused(f.model.master = backwards, "master[1] is 0 behind 2, expected increasing numbers");
    static const double rows[6] = {1, 0, 0, 0, 0, 1}, poisoned[6] = {1, 0, 0, 0, NAN, 1};
    refused((f.model.sensor = poisoned, f.model.master = NULL), "model->sensor[4] is nan, expected a number");
    refused((f.model.sensor = rows, f.model.nmaster = -1), "model->nmaster is -1, expected 0 or more");
    refused((f.model.sensor = rows, f.options.reduction = ROTID_GUYAN),
            "model->sensor is not NULL, which options->reduction condenses away, expected ROTID_REDUCTION_NONE");
    refused(f.chain.far[1] = 3, "far[1] is 3, expected 0 ... 2");
    refused(f.parameter[0].start = 10,
            "parameter[0] spring has lower 1, start 10, upper 10, expected numbers with lower < start < "
            "upper, a start other than 0, and a finite upper - lower");
    refused(f.options.functional = 3, "options->functional is 3, expected ROTID_LIKELIHOOD, ROTID_HYBRID or ROTID_HYBRID_F");
    refused(f.options.reduction = -1, "options->reduction is -1, expected ROTID_REDUCTION_NONE, ROTID_GUYAN or ROTID_IRS");
    refused(f.options.derivative = 2, "options->derivative is 2, expected ROTID_NELSON or ROTID_MODAL");
    refused(f.options.derivative = ROTID_MODAL,
            "options->derivative is ROTID_MODAL without a reduction, expected ROTID_GUYAN or ROTID_IRS");
    refused(f.measured.nmode = 0, "measured->nmode is 0, expected 1 or more");
    refused(f.measured.number = NULL, "measured->number is NULL, expected nmode = 2 values");
    refused(f.number[1] = 0, "measured->number[1] is 0, expected a mode of the model, from 1");
    refused(f.hz[1] = -0.5, "measured->frequency_hz[1] is -0.5, expected a positive number");
    refused(f.hz_std[0] = 0, "measured->frequency_std[0] is 0, expected a positive relative standard deviation "
                             "(measured->holdout takes a mode out)");
    refused(f.shape_std[3] = 0, "measured->shape_std of master 1 in mode 1 is 0, expected a positive number (NaN in "
                                "measured->shape takes a component out)");
    refused(f.holdout[0] = f.holdout[1] = 1, "measured->holdout leaves no mode to be fitted, expected a 0 in it");
    refused(f.measured.frequency_std = NULL,
            "measured->frequency_std is NULL, which ROTID_LIKELIHOOD weighs by, expected nmode = "
            "2 values or another options->functional");
    refused(f.measured.shape_std = NULL, "measured->shape_std is NULL beside shapes, which ROTID_LIKELIHOOD weighs by, expected "
                                         "nmaster x nmode values");
    refused(f.number[1] = f.number[0],
            "measured->number[1] is 1, and so is measured->number[0], expected each mode of the model once");
#undef refused
    rotid_fit_result *result;
    assert_refused(rotid_fit(NULL, f.parameter, &f.measured, &f.options, NULL, failure, &result),
                   "model is NULL, expected a struct");
    assert_refused(rotid_fit(&f.model, NULL, &f.measured, &f.options, NULL, failure, &result),
                   "parameter is NULL, expected model->nparam = 1 of them");
    assert_refused(rotid_fit(&f.model, f.parameter, NULL, &f.options, NULL, failure, &result),
                   "measured is NULL, expected a struct");
    assert_refused(rotid_fit(&f.model, f.parameter, &f.measured, &f.options, NULL, failure, NULL),
                   "result is NULL, expected a struct");
    fit_open(&f);
    f.number[1] = 4;
    assert_status(fit(&f, NULL), ROTID_ERROR_UNPAIRED);
    assert_string_equal(failure, "measured->number[1] is 4, but behind 0 rigid ones the model has 3 modes");
}

UNIT_TEST(a_fit_says_what_its_callbacks_did)
{
    struct fit f;
    fit_open(&f);
    f.chain.m_band[0] = -1;
    assert_status(fit(&f, NULL), ROTID_ERROR_CALLBACK);
    assert_string_equal(failure, "model->matrices returned 7");
    fit_open(&f);
    f.chain.k_band[3] = NAN;
    assert_status(fit(&f, NULL), ROTID_ERROR_FINITE);
    assert_string_equal(failure, "the stiffness of model->matrices: entry (2, 1) is nan, expected a number");
    fit_open(&f);
    f.chain.m_block[2] = INFINITY;
    assert_status(fit(&f, NULL), ROTID_ERROR_FINITE);
    assert_string_equal(failure,
                        "the mass of model->matrices: block (0, 1), entry (0, 2) of the matrix, is inf, expected a number");
    fit_open(&f);
    f.chain.m_band[0] = 0; /* nothing more to say than the status does */
    assert_status(fit(&f, NULL), ROTID_ERROR_MASS);
    assert_string_equal(failure, rotid_status_text(ROTID_ERROR_MASS));
}

UNIT_TEST(building_blocks_name_what_they_refuse)
{
    struct chain c, other;
    int master[] = {0, 2}, dof[] = {0, 3}, none[] = {-1, 3};
    double kc[9], mc[9], t[9], lambda[3], phi[9], dlambda, full[9] = {0}, e[4] = {1, -1, -1, 1}, outer, inner;
    chain_open(&c);
    chain_open(&other);
    other.far[0] = 1;
    rotid_matrix narrow = {3, 0, 0, NULL, other.k_band, NULL};
    assert_refused(rotid_eigenpairs(NULL, &c.m, 2, NULL, failure, lambda, phi), "k is NULL, expected a matrix");
    assert_refused(rotid_eigenpairs(&c.k, &c.m, 4, NULL, failure, lambda, phi), "count is 4, expected 1 ... 3 (n)");
    assert_refused(rotid_eigenpairs(&c.k, &c.m, 2, NULL, failure, NULL, phi), "lambda is NULL, expected room for the result");
    assert_refused(rotid_eigenpairs(&c.k, &other.m, 2, NULL, failure, lambda, phi), "m->far[0] is 1, expected that of k, 0");
    assert_refused(rotid_eigenpairs(&c.k, &narrow, 2, NULL, failure, lambda, phi),
                   "m has n, kd, nfar 3, 0, 0, expected those of k, 3, 1, 2");
    assert_status(rotid_eigenpairs(&c.k, &c.m, 3, NULL, failure, lambda, phi), ROTID_OK);
    assert_string_equal(failure, "");
    assert_refused(rotid_eigenpair_derivative(&c.k, &c.m, &c.k, &c.m, 3, lambda, phi, 3, NULL, failure, &dlambda, NULL),
                   "j is 3, expected 0 ... 2 (count - 1)");
    assert_refused(rotid_eigenpair_derivative(&c.k, &c.m, &c.k, &c.m, 3, lambda, full, 1, NULL, failure, &dlambda, NULL),
                   "phi' M phi of column 1 of phi is 0, expected 1, as rotid_eigenpairs gives it");
    assert_refused(rotid_condense(&c.k, &c.m, 0, master, ROTID_GUYAN, NULL, failure, kc, mc, t),
                   "nmaster is 0, expected 1 ... 3 (n)");
    assert_refused(rotid_condense(&c.k, &c.m, 2, master, 0, NULL, failure, kc, mc, t),
                   "kind is 0, expected ROTID_GUYAN (1) or ROTID_IRS (2)");
    assert_refused(rotid_condense_derivative(&c.k, &c.m, &c.k, &narrow, 2, master, ROTID_IRS, NULL, failure, kc, mc),
                   "dm has n, kd, nfar 3, 0, 0, expected those of k, 3, 1, 2");
    assert_refused(rotid_matrix_add(&c.k, 3, 0, 1, failure), "there is no entry (3, 0), expected indices of 0 ... 2");
    assert_refused(rotid_matrix_add(&narrow, 1, 0, 1, failure),
                   "entry (1, 0) lies outside the band, kd = 0, expected both 1 and 0 among the 0 of a->far");
    assert_refused(rotid_matrix_add_element(&c.k, 2, dof, e, failure), "dof[1] is 3, expected at most 2 (n - 1)");
    assert_refused(rotid_matrix_add_element(&c.k, 2, none, e, failure), "dof[1] is 3, expected at most 2 (n - 1)");
    assert_refused(rotid_matrix_add_element(&c.k, 0, dof, e, failure), "nd is 0, expected 1 or more");
    assert_refused(rotid_matrix_set_dense(&c.k, full, 2, failure), "ld is 2, expected at least 3 (n)");
    assert_refused(rotid_matrix_get_dense(&c.k, NULL, 3, failure), "full is NULL, expected an array");
    assert_refused(rotid_matrix_multiply(&c.k, 1, phi, phi + 2, failure), "x and y overlap, expected two arrays");
    assert_refused(rotid_equivalent_cylinder(-1.5, 1, failure, &outer, &inner), "area is -1.5, expected a positive number of m2");
    assert_refused(rotid_equivalent_cylinder(1, NAN, failure, &outer, &inner),
                   "inertia is nan, expected a positive number of m4");
}

static int residual(void *user, int m, int n, const double *x, double *r, double *jacobian)
{
    (void)user, (void)m, (void)n;
    if (r)
        r[0] = x[0];
    else
        jacobian[0] = 1;
    return 0;
}

/* Fails when asked for the residual, user 0, or for the Jacobian, 1. */
static int none_returned(void *user, int m, int n, const double *x, double *r, double *jacobian)
{
    return (r == NULL) == *(int *)user ? 7 : residual(NULL, m, n, x, r, jacobian);
}

UNIT_TEST(least_squares_name_what_they_refuse)
{
    double x[1] = {NAN}, r[1], jacobian[1], error[1], doubt[1], scale[1] = {0}, work[100];
    rotid_lm_result result;
    rotid_lm_options options = {.max_iterations = 3};
    assert_true(rotid_lm_workspace(1, 1) <= 100 && rotid_check_jacobian_workspace(1, 1) <= 100);
    assert_refused(rotid_lm(1, 0, residual, NULL, NULL, failure, x, r, jacobian, work, &result),
                   "m is 1 and n is 0, expected 1 or more");
    assert_refused(rotid_lm(1, 1, residual, NULL, NULL, failure, x, NULL, jacobian, work, &result), "r is NULL, expected one");
    assert_refused(rotid_lm(1, 1, residual, NULL, NULL, failure, x, r, jacobian, work, &result),
                   "x[0] is nan, expected a number to start from");
    assert_refused(rotid_check_jacobian(1, 1, residual, NULL, x, NULL, failure, error, doubt, work),
                   "x[0] is nan, expected a number");
    x[0] = 2;
    assert_status(rotid_lm(1, 1, none_returned, &(int){0}, NULL, failure, x, r, jacobian, work, &result), ROTID_ERROR_CALLBACK);
    assert_string_equal(failure, "residual returned 7 when asked for r at the start, expected 0");
    assert_status(rotid_lm(1, 1, none_returned, &(int){1}, NULL, failure, x, r, jacobian, work, &result), ROTID_ERROR_CALLBACK);
    assert_string_equal(failure, "residual returned 7 when asked for the jacobian, expected 0");
    assert_int_equal(rotid_lm_workspace(-1, 3), 0);
    assert_int_equal(rotid_check_jacobian_workspace(3, 0), 0);
    assert_refused(rotid_lm(1, 1, residual, NULL, &options, failure, x, r, jacobian, work, &result),
                   "options->size is 0, expected sizeof(rotid_lm_options), here 80");
    assert_refused(rotid_check_jacobian(1, 1, residual, NULL, x, scale, failure, error, doubt, work),
                   "scale[0] is 0, expected a positive number");
    options.size = sizeof options;
    assert_true(rotid_lm(1, 1, residual, NULL, &options, failure, x, r, jacobian, work, &result) > 0);
    assert_string_equal(failure, ""); /* why it stopped is no failure */
}

/* A routine that fails without a word would be the exception that a host stumbles over. */
POOL_TEST(every_routine_with_a_status_says_why)
{
    struct header header;
    int count = 0;
    assert_int_equal(header_read(&test_pool, ROTID_SOURCE_DIR "/include/rotid.h", &header), 0);
    for (int i = 0; i < header.nfunction; i++) {
        const struct header_function *f = &header.function[i];
        const char *text = header_function_text(&test_pool, f);
        int says = strstr(text, "char *failure") != NULL,
            fails = strcmp(f->result.base, "int") == 0 && !f->result.pointers && strcmp(f->name, "rotid_status_converged") != 0;
        if (says != fails)
            fail_msg("%s", text);
        count += fails;
    }
    assert_true(count >= 18);
}

UNIT_TEST(a_long_reason_is_whole_characters)
{
    char name[2000];
    for (int i = 0; i < 1999; i++)
        name[i] = "\xc3\xa4"[i % 2];
    name[1999] = 0;
    assert_status(refuse(failure, "%s", name), ROTID_ERROR_ARGUMENT);
    assert_int_equal(strlen(failure), ROTID_FAILURE_LENGTH - 2); /* the last one would not have been whole */
    assert_memory_equal(failure, name, ROTID_FAILURE_LENGTH - 2);
    assert_status(refuse(NULL, "%s", name), ROTID_ERROR_ARGUMENT);
}

/* ---- the environment */

static void *give(void *context, size_t bytes)
{
    ++*(int *)context;
    return malloc(bytes);
}

static void take_back(void *context, void *block)
{
    ++*(int *)context;
    free(block);
}

static int add_nothing(void *user, const double *x, const double *value, rotid_matrix *k, rotid_matrix *m)
{
    (void)user, (void)x, (void)value, (void)k, (void)m;
    return 0;
}

/* Every routine that takes an environment, with this one. */
static int call_all(const rotid_deck *good, const rotid_environment *environment, const char *text)
{
    struct chain c;
    struct fit f;
    int master[] = {0, 2};
    double kc[4], mc[4], lambda[3], phi[9], dlambda, error[2], doubt[2];
    rotid_deck *deck = (void *)&c;
    rotid_spectrum *spectrum = (void *)&c;
    rotid_check *check = (void *)&c;
    rotid_identification *identification = (void *)&c;
    rotid_diagnosis *diagnosis = (void *)&c;
    rotid_suggestion *suggestion = (void *)&c;
    rotid_speeds *speeds = (void *)&c;
    chain_open(&c);
    fit_open(&f);
    assert_refused(rotid_deck_read(PAPER, 0, NULL, environment, failure, &deck), text);
    assert_null(deck);
    deck = (void *)&c;
    assert_refused(rotid_deck_read_text(9, "*MATERIAL", NULL, NULL, 0, NULL, environment, failure, &deck), text);
    assert_refused(rotid_deck_check(good, environment, failure, &check), text);
    assert_refused(rotid_spectrum_compute(good, NULL, 2, environment, failure, &spectrum), text);
    assert_refused(rotid_spectrum_beside(good, NULL, 2, environment, failure, &spectrum), text);
    assert_refused(rotid_spectrum_of_type(good, ROTID_TORSION, NULL, 2, environment, failure, &spectrum), text);
    assert_refused(rotid_identify(good, 0, environment, failure, &identification), text);
    assert_refused(rotid_diagnose(good, NULL, environment, failure, &diagnosis), text);
    assert_refused(rotid_suggest(good, NULL, environment, failure, &suggestion), text);
    assert_refused(rotid_speeds_compute(good, NULL, environment, failure, &speeds), text);
    assert_true(!deck && !spectrum && !identification && !diagnosis && !suggestion && !speeds);
    assert_refused(fit(&f, environment), text);
    const rotid_state state = {sizeof state, &f.model, &f.measured, NULL};
    rotid_fit_result *result = (void *)&c;
    assert_refused(rotid_fit_states(1, &state, 1, f.parameter, &f.options, environment, failure, &result), text);
    assert_null(result);
    assert_refused(rotid_check_model(&f.model, f.parameter, NULL, environment, failure, error, doubt), text);
    assert_refused(rotid_condense(&c.k, &c.m, 2, master, ROTID_GUYAN, environment, failure, kc, mc, NULL), text);
    assert_refused(rotid_condense_derivative(&c.k, &c.m, &c.k, &c.m, 2, master, ROTID_IRS, environment, failure, kc, mc), text);
    assert_refused(rotid_eigenpairs(&c.k, &c.m, 3, environment, failure, lambda, phi), text);
    assert_refused(rotid_eigenpair_derivative(&c.k, &c.m, &c.k, &c.m, 3, lambda, phi, 0, environment, failure, &dlambda, lambda),
                   text);
    const rotid_parameter size = {"mass", "kg", 0, 1, 0.1};
    const rotid_host_cause cause = {
        .size = sizeof cause, .name = "mass", .nparameter = 1, .parameter = &size, .add = add_nothing};
    rotid_host_diagnosis *of_model = (void *)&c;
    assert_refused(rotid_diagnose_model(&f.model, f.parameter, &f.measured, 1, &cause, NULL, environment, failure, &of_model),
                   text);
    assert_null(of_model);
    return 18;
}

POOL_TEST(an_environment_that_is_none_is_refused_by_all)
{
    int calls = 0, count = 0, takers = 0;
    rotid_allocator allocator = {.release = take_back, .context = &calls};
    rotid_environment environment = {.size = sizeof environment, .allocator = &allocator};
    rotid_deck *deck;
    struct header header;
    assert_status(rotid_deck_read(PAPER, 0, NULL, NULL, failure, &deck), ROTID_OK);
    count = call_all(deck, &environment, "environment->allocator->allocate is NULL, expected a function");
    allocator = (rotid_allocator){.allocate = give, .context = &calls};
    (void)call_all(deck, &environment, "environment->allocator->release is NULL, expected a function");
    allocator.release = take_back;
    environment.size = 0;
    (void)call_all(deck, &environment, "environment->size is 0, expected sizeof(rotid_environment), here 40");
    assert_int_equal(calls, 0);
    rotid_deck_free(deck);

    assert_int_equal(header_read(&test_pool, ROTID_SOURCE_DIR "/include/rotid.h", &header), 0);
    for (int i = 0; i < header.nfunction; i++)
        takers += strstr(header_function_text(&test_pool, &header.function[i]), "const rotid_environment *") != NULL;
    if (takers != count)
        fail_msg("%d routines take an environment, and %d are called here", takers, count);
}

/* ---- symmetry */

POOL_TEST(a_block_that_is_not_symmetric_is_refused)
{
    static const char text[] = ": block (1, 0) is -1 and block (0, 1) is -0.999, expected a symmetric block (entries (2, 0) and "
                               "(0, 2) of the matrix)";
    struct chain c;
    struct fit f;
    int master[] = {0, 2};
    double kc[4], mc[4], lambda[3], phi[9], full[9], x[3] = {0}, y[3];
    const char *of_k, *of_a;
    chain_open(&c);
    c.k_block[2] = -0.999;
    of_k = pool_format(&test_pool, "k%s", text);
    of_a = pool_format(&test_pool, "a%s", text);
    assert_refused(rotid_eigenpairs(&c.k, &c.m, 1, NULL, failure, lambda, phi), of_k);
    assert_refused(rotid_condense(&c.k, &c.m, 2, master, ROTID_GUYAN, NULL, failure, kc, mc, NULL), of_k);
    assert_refused(rotid_condense_derivative(&c.m, &c.m, &c.k, &c.m, 2, master, ROTID_IRS, NULL, failure, kc, mc),
                   pool_format(&test_pool, "d%s", of_k));
    assert_refused(rotid_matrix_multiply(&c.k, 1, x, y, failure), of_a);
    assert_refused(rotid_matrix_get_dense(&c.k, full, 3, failure), of_a);
    fit_open(&f);
    f.chain.k_block[2] = -0.999;
    assert_refused(fit(&f, NULL), pool_format(&test_pool, "the stiffness of model->matrices%s", text));
    fit_open(&f);
    f.model.derivatives = derivatives;
    assert_refused(fit(&f, NULL), "the stiffness of model->derivatives: block (1, 0) is 0.5 and block (0, 1) is 0, expected a "
                                  "symmetric block (entries (2, 0) and (0, 2) of the matrix)");

    c.k_block[2] = -1 - 1e-15; /* two triangles that were rounded in two ways */
    assert_status(rotid_eigenpairs(&c.k, &c.m, 1, NULL, failure, lambda, phi), ROTID_OK);
}

/* ---- structs of another version */

struct old {
    size_t size;
    int first, second;
};
struct new
{
    size_t size;
    int first, second;
    double third;
};

UNIT_TEST(a_struct_of_before_is_filled_up_with_zeros)
{
    const struct sized_struct structure = {"new", "it", sizeof(struct old), sizeof(struct new)};
    const struct old old = {sizeof old, 1, 2};
    struct new copy = {1, 1, 1, 1}, given = {sizeof given, 3, 4, 5.5};
    assert_status(sized_copy(&structure, &old, failure, &copy), ROTID_OK);
    assert_true(copy.size == sizeof old && copy.first == 1 && copy.second == 2 && copy.third == 0);
    assert_status(sized_copy(&structure, &given, failure, &copy), ROTID_OK);
    assert_true(copy.first == 3 && copy.third == 5.5);
    given.size = sizeof given - 1; /* in the middle of a member: no version had that, and zeros stay zeros */
    given.third = 0;
    assert_status(sized_copy(&structure, &given, failure, &copy), ROTID_OK);
    given.size = sizeof old - 1;
    assert_refused(sized_copy(&structure, &given, failure, &copy), "it->size is 15, expected sizeof(new), here 24");
}

POOL_TEST(what_a_newer_host_asks_for_is_refused_and_zeros_are_not)
{
    struct fit f;
    struct {
        rotid_fit_options options;
        char more[16];
    } newer;
    rotid_fit_result *result;
    fit_open(&f);
    memset(&newer, 0, sizeof newer);
    newer.options = f.options;
    newer.options.size = sizeof newer;
    assert_status(rotid_fit(&f.model, f.parameter, &f.measured, &newer.options, NULL, failure, &result), ROTID_OK);
    rotid_fit_free(result);
    newer.more[9] = 1;
    assert_refused(rotid_fit(&f.model, f.parameter, &f.measured, &newer.options, NULL, failure, &result),
                   pool_format(&test_pool,
                               "options->size is %zu and byte %zu of it is not zero, but librotid %s knows %zu bytes of "
                               "rotid_fit_options",
                               sizeof newer, sizeof f.options + 9, ROTID_VERSION, sizeof f.options));
    newer.options.size = SIZE_MAX; /* never set: nothing may be read by it */
    assert_refused(rotid_fit(&f.model, f.parameter, &f.measured, &newer.options, NULL, failure, &result),
                   pool_format(&test_pool, "options->size is %zu, expected sizeof(rotid_fit_options), here %zu", SIZE_MAX,
                               sizeof f.options));
    f.model.size = 0;
    assert_refused(fit(&f, NULL), "model->size is 0, expected sizeof(rotid_model), here 112");
    f.model.size = sizeof f.model;
    f.measured.size = 1;
    assert_refused(fit(&f, NULL),
                   pool_format(&test_pool, "measured->size is 1, expected sizeof(rotid_measured), here %zu", sizeof f.measured));
}

UNIT_TEST(defaults_are_written_as_far_as_the_host_has_room)
{
    struct {
        rotid_fit_options options;
        char behind[16];
    } host;
    memset(&host, '?', sizeof host);
    rotid_fit_defaults(offsetof(rotid_fit_options, bijection_chi), &host.options); /* as if that had come later */
    assert_int_equal(host.options.size, offsetof(rotid_fit_options, bijection_chi));
    assert_true(host.options.functional == ROTID_LIKELIHOOD && host.options.step_tolerance > 0);
    assert_int_equal(*(char *)&host.options.bijection_chi, '?');
    rotid_fit_defaults(sizeof host, &host.options); /* of a newer header */
    assert_int_equal(host.options.size, sizeof host);
    assert_close(host.options.bijection_chi, 0.05, 0, 0);
    for (size_t i = 0; i < sizeof host.behind; i++)
        assert_int_equal(host.behind[i], 0);
}
