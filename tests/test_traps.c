/* A host that traps every floating-point exception calls every routine, with what it usually has and with what it never should:
 * no call kills it, and traps, flags and rounding are its own behind each. */
#define _GNU_SOURCE /* feenableexcept */
#include <float.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "header.h"
#include "support.h"

#define SOLID ROTID_SOURCE_DIR "/input/solid_rotor.inp"

/* A stepped shaft, small as a beam and as a solid; frequencies of the solid with 0.1 % of noise. */
static const char rotor_text[] = "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n"
                                 "*SHAFT, NAME=end, MATERIAL=steel\n0.25, 0.10, 0, 10\n"
                                 "*SHAFT, NAME=core, MATERIAL=steel\n0.35, 0.20, 0, 10\n"
                                 "*NOISE, FREQUENCY=0.001\n*MODES\n1, 1253\n2, 4009\n3, 5618\n"
                                 "*IDENTIFY\ncore.E, 1e10, 4e11, 1.8e11\n"
                                 "*RUNNING\n*BEARING, NAME=a, STD=0.1\nstart, 1e8, 1e4\n*BEARING, NAME=b\nend, 1e8, 1e4\n"
                                 "*UNBALANCE\n0.4, 0.001\n*PROBE, NAME=p\n0.4\n*OPERATION\n1000, 20000\n";

/* A chain of three masses with a far block, and room for what comes of it. Made before the traps are on. */
static struct {
    double band_k[6], band_m[6], band_d[6], block_k[4], block_m[4], block_d[4], full[9], element[16], lambda[3], phi[9], shape[3],
        out[9], more[9], t[9], work[4000];
    int far[2], master[2], dof[2], number[2];
    double hz[2];
    rotid_matrix k, m, d;
    rotid_model model;
    rotid_parameter parameter;
    rotid_measured measured;
    rotid_fit_options options;
    rotid_deck *deck;
    double x[1], r[2], jacobian[2], error[2], doubt[2]; /* of a fit: of K, then of M */
} with;

static volatile double got;
static int survived, failed; /* what may fail, and what should not */

static int matrices(void *user, const double *x, rotid_matrix *k, rotid_matrix *m)
{
    (void)user;
    memcpy(k->band, with.band_k, sizeof with.band_k);
    memcpy(k->block, with.block_k, sizeof with.block_k);
    memcpy(m->band, with.band_m, sizeof with.band_m);
    k->band[0] = x[0] * x[0] / 3;
    return 0;
}

static int residual(void *user, int m, int n, const double *x, double *r, double *jacobian)
{
    double one = *(const double *)user; /* 1, or what makes everything overflow */
    (void)m, (void)n;
    if (r) {
        r[0] = exp(one * x[0]) - 2;
        r[1] = x[0] / 3;
    } else {
        jacobian[0] = one * exp(one * x[0]);
        jacobian[1] = 1.0 / 3;
    }
    return 0;
}

static void prepare(double scale)
{
    static const double k[6] = {4, -1, 5, -1, 4, 0}, m[6] = {1, 0, 1, 0, 1, 0};
    for (int i = 0; i < 6; i++) {
        with.band_k[i] = k[i] * scale;
        with.band_m[i] = with.band_d[i] = m[i];
        if (i % 2 == 0)
            with.band_k[i] *= 1.1;
    }
    memset(with.block_m, 0, sizeof with.block_m);
    memset(with.block_d, 0, sizeof with.block_d);
    memcpy(with.block_k, (double[]){0, -scale / 3, -scale / 3, 0}, sizeof with.block_k);
    for (int i = 0; i < 9; i++)
        with.full[i] = i % 4 ? -scale / 3 : scale;
    for (int i = 0; i < 16; i++)
        with.element[i] = scale / 3;
    memcpy(with.far, (int[]){0, 2}, sizeof with.far);
    memcpy(with.master, (int[]){0, 2}, sizeof with.master);
    memcpy(with.dof, (int[]){0, 1}, sizeof with.dof);
    memcpy(with.number, (int[]){1, 2}, sizeof with.number);
    memcpy(with.hz, (double[]){0.3, 0.36}, sizeof with.hz);
    memcpy(with.shape, (double[]){0.1 * scale, -0.7 * scale, 1.3 * scale}, sizeof with.shape);
    with.k = (rotid_matrix){3, 1, 2, with.far, with.band_k, with.block_k};
    with.m = (rotid_matrix){3, 1, 2, with.far, with.band_m, with.block_m};
    with.d = (rotid_matrix){3, 1, 2, with.far, with.band_d, with.block_d};
    with.model = (rotid_model){.size = sizeof with.model,
                               .n = 3,
                               .kd = 1,
                               .nfar = 2,
                               .far = with.far,
                               .nparam = 1,
                               .nmaster = 2,
                               .master = with.master,
                               .matrices = matrices};
    with.parameter = (rotid_parameter){"a", "", 0.1, 10, 3};
    with.measured = (rotid_measured){.size = sizeof with.measured, .nmode = 2, .number = with.number, .frequency_hz = with.hz};
    with.options = (rotid_fit_options){.size = sizeof with.options, .baseline = 1};
    with.x[0] = 0.5;
    (void)rotid_eigenpairs(&with.k, &with.m, 3, NULL, NULL, with.lambda, with.phi);
}

/* ---- one routine each, at the numbers that are prepared: `extreme` of a kind that nothing can be made of */

static const double extreme[] = {0, -0.0, NAN, INFINITY, -INFINITY, DBL_MAX, DBL_MIN, 4.9e-324, -1, 1.0 / 3, 1e200, 1e-200};
enum { EXTREMES = sizeof extreme / sizeof *extreme };

static void say(void)
{
    survived += rotid_version() != NULL && rotid_status_text(-1) != NULL && rotid_status_name(3) != NULL &&
                rotid_verdict_name(2) != NULL && rotid_status_converged(2);
}

static void sections(void)
{
    double outer, inner;
    for (int i = 0; i < EXTREMES; i++)
        for (int j = 0; j < EXTREMES; j++) {
            got = rotid_shear_coefficient_annulus(extreme[i], extreme[j]);
            got = rotid_shear_coefficient_rectangle(extreme[i]);
            survived += rotid_equivalent_cylinder(extreme[i], extreme[j], NULL, &outer, &inner) <= 0;
        }
}

static void elements(void)
{
    for (int i = 0; i < EXTREMES; i++)
        for (int j = 0; j < EXTREMES; j++)
            for (int k = 0; k < EXTREMES; k++) {
                rotid_element_stiffness(extreme[i], extreme[j], extreme[k], with.element);
                rotid_element_geometric(extreme[i], extreme[j], extreme[k], with.element);
                rotid_element_mass(extreme[i], extreme[j], extreme[k], extreme[(i + j) % EXTREMES], with.element);
            }
}

static void correlations(void)
{
    double mass[9], a[3], b[3], work[3];
    for (int i = 0; i < EXTREMES; i++)
        for (int j = 0; j < EXTREMES; j++) {
            for (int k = 0; k < 9; k++)
                mass[k] = extreme[(i + k) % EXTREMES];
            for (int k = 0; k < 3; k++) {
                a[k] = extreme[(i + 5 * k) % EXTREMES];
                b[k] = extreme[(j + 7 * k) % EXTREMES];
            }
            got = rotid_mac(3, a, b);
            got = rotid_nco(3, mass, a, b, work);
        }
    got = rotid_mac(3, with.shape, with.phi);
    got = rotid_nco(3, with.full, with.shape, with.phi, work);
}

static void entries(void)
{
    for (int i = 0; i < EXTREMES; i++) {
        for (int repeat = 0; repeat < 2; repeat++)
            survived += rotid_matrix_add(&with.k, 1, 0, extreme[i], NULL) == 0;
        for (int k = 0; k < 4; k++)
            with.element[k] = extreme[(i + k) % EXTREMES];
        survived += rotid_matrix_add_element(&with.k, 2, with.dof, with.element, NULL) == 0;
        for (int k = 0; k < 9; k++)
            with.full[k] = extreme[i];
        survived += rotid_matrix_set_dense(&with.d, with.full, 3, NULL) == 0;
        survived += rotid_matrix_get_dense(&with.d, with.out, 3, NULL) <= 0;
        survived += rotid_matrix_multiply(&with.d, 3, with.full, with.out, NULL) <= 0;
    }
}

static void pairs(void)
{
    survived += rotid_eigenpairs(&with.k, &with.m, 3, NULL, NULL, with.lambda, with.phi) <= 0;
    for (int j = 0; j < 3; j++)
        survived += rotid_eigenpair_derivative(&with.k, &with.m, &with.d, &with.d, 3, with.lambda, with.phi, j, NULL, NULL,
                                               with.out, with.more) <= 0;
}

static void condensations(void)
{
    for (int kind = ROTID_GUYAN; kind <= ROTID_IRS; kind++) {
        survived += rotid_condense(&with.k, &with.m, 2, with.master, kind, NULL, NULL, with.out, with.more, with.t) <= 0;
        survived += rotid_condense_derivative(&with.k, &with.m, &with.d, &with.d, 2, with.master, kind, NULL, NULL, with.out,
                                              with.more) <= 0;
    }
}

static void least_squares(void)
{
    static double usual = 1, much = 1e300;
    double x[1];
    for (int i = 0; i < EXTREMES; i++)
        for (double *one = &usual; one; one = one == &usual ? &much : NULL) {
            rotid_lm_result result;
            memcpy(x, &extreme[i], sizeof x);
            survived += rotid_lm_workspace(2, 1) + rotid_check_jacobian_workspace(2, 1) < 4000;
            survived += rotid_check_jacobian(2, 1, residual, one, x, NULL, NULL, with.error, with.doubt, with.work) <= 0;
            survived += rotid_lm(2, 1, residual, one, NULL, NULL, x, with.r, with.jacobian, with.work, &result) != 0;
        }
}

static int add_mass(void *user, const double *x, const double *value, rotid_matrix *k, rotid_matrix *m)
{
    (void)user, (void)x, (void)k;
    return rotid_matrix_add(m, 0, 0, value[0], NULL);
}

static void fits(void)
{
    static const rotid_parameter mass = {"mass", "kg", 0, 1, 0.1};
    static const rotid_host_cause added = {
        .size = sizeof added, .name = "mass", .nparameter = 1, .parameter = &mass, .add = add_mass};
    rotid_fit_result *result;
    for (int i = -1; i < EXTREMES; i++) {
        rotid_fit_defaults(sizeof with.options, &with.options);
        with.options.functional = ROTID_HYBRID;
        if (i >= 0)
            memcpy(&with.hz[1], &extreme[i], sizeof extreme[i]);
        survived += rotid_fit(&with.model, &with.parameter, &with.measured, &with.options, NULL, NULL, &result) <= 0;
        rotid_fit_free(result);
        const rotid_state state[2] = {{sizeof state[0], &with.model, &with.measured, NULL},
                                      {sizeof state[0], &with.model, &with.measured, NULL}};
        survived += rotid_fit_states(2, state, 1, &with.parameter, &with.options, NULL, NULL, &result) <= 0;
        rotid_fit_free(result);
        survived += rotid_check_model(&with.model, &with.parameter, NULL, NULL, NULL, with.error, with.doubt) <= 0;
        rotid_host_diagnosis *found;
        rotid_measured measured = with.measured;
        measured.frequency_std = with.lambda;
        for (int k = 0; k < measured.nmode; k++)
            with.lambda[k] = 0.01;
        int diagnosed = rotid_diagnose_model(&with.model, &with.parameter, &measured, 1, &added, NULL, NULL, NULL, &found);
        survived += diagnosed <= 0;
        rotid_host_diagnosis_free(found);
    }
}

static void decks(void)
{
    rotid_deck *deck;
    rotid_spectrum *spectrum;
    rotid_check *check;
    rotid_identification *found;
    rotid_diagnosis *diagnosis;
    rotid_suggestion *suggestion;
    rotid_speeds *speeds;
    char failure[ROTID_FAILURE_LENGTH];
    static const rotid_diagnose_options quick = {.size = sizeof quick};
    static const rotid_suggest_options brief = {.size = sizeof brief};
    static const rotid_speeds_options few = {.size = sizeof few, .draws = 25};
    failed |= rotid_deck_read(SOLID, 0, NULL, NULL, failure, &deck);
    rotid_deck_free(deck);
    failed |= rotid_deck_read_text(strlen(rotor_text), rotor_text, NULL, NULL, 0, NULL, NULL, failure, &deck);
    failed |= rotid_deck_check(deck, NULL, failure, &check);
    rotid_check_free(check);
    failed |= rotid_spectrum_compute(deck, NULL, 4, NULL, failure, &spectrum);
    rotid_spectrum_free(spectrum);
    failed |= rotid_spectrum_beside(deck, NULL, 4, NULL, failure, &spectrum);
    rotid_spectrum_free(spectrum);
    failed |= rotid_spectrum_of_type(deck, ROTID_TORSION, NULL, 4, NULL, failure, &spectrum);
    rotid_spectrum_free(spectrum);
    failed |= rotid_identify(deck, 1, NULL, failure, &found);
    rotid_identification_free(found);
    failed |= rotid_diagnose(deck, &quick, NULL, failure, &diagnosis);
    rotid_diagnosis_free(diagnosis);
    failed |= rotid_suggest(deck, &brief, NULL, failure, &suggestion);
    rotid_suggestion_free(suggestion);
    failed |= rotid_speeds_compute(deck, &few, NULL, failure, &speeds);
    rotid_speeds_free(speeds);
    rotid_deck_free(deck);
    failed |= rotid_deck_read("/nowhere", 0, NULL, NULL, failure, &deck) != ROTID_ERROR_IO;
    rotid_deck_free(deck);
}

static const struct {
    void (*call)(void);
    const char *routines;
} table[] = {
    {say, "rotid_version rotid_status_text rotid_status_name rotid_status_converged rotid_verdict_name "},
    {sections, "rotid_shear_coefficient_annulus rotid_shear_coefficient_rectangle rotid_equivalent_cylinder "},
    {elements, "rotid_element_stiffness rotid_element_geometric rotid_element_mass "},
    {correlations, "rotid_mac rotid_nco "},
    {entries, "rotid_matrix_add rotid_matrix_add_element rotid_matrix_set_dense rotid_matrix_get_dense rotid_matrix_multiply "},
    {pairs, "rotid_eigenpairs rotid_eigenpair_derivative "},
    {condensations, "rotid_condense rotid_condense_derivative "},
    {least_squares, "rotid_lm_workspace rotid_check_jacobian_workspace rotid_lm rotid_check_jacobian "},
    {fits, "rotid_check_model rotid_fit_defaults rotid_fit rotid_fit_states rotid_fit_free rotid_diagnose_model "
           "rotid_host_diagnosis_free "},
    {decks, "rotid_deck_read rotid_deck_read_text rotid_deck_free rotid_deck_check rotid_check_free rotid_spectrum_compute "
            "rotid_spectrum_beside rotid_spectrum_of_type rotid_spectrum_free rotid_identify "
            "rotid_identification_free rotid_diagnose rotid_diagnosis_free rotid_suggest rotid_suggestion_free "
            "rotid_speeds_compute rotid_speeds_free "},
};
enum { CALLS = sizeof table / sizeof *table };

/* ---- under traps */

/* How a child ends that makes call `i` after `prepare(scale)`; i < 0: that divides by zero itself. 0: as it should. */
static int run(int i, double scale)
{
    int status = 0;
    (void)fflush(NULL);
    pid_t child = fork();
    if (child == 0) {
        const struct rlimit no_core = {0, 0};
        volatile double zero = 0;
        (void)setrlimit(RLIMIT_CORE, &no_core);
        (void)signal(SIGFPE, SIG_DFL);
        prepare(scale);
        (void)fesetround(FE_UPWARD);
        (void)feclearexcept(FE_ALL_EXCEPT);
        (void)feenableexcept(FE_ALL_EXCEPT);
        if (i < 0)
            zero = zero / zero;
        else
            table[i].call();
        int own = fegetexcept() == FE_ALL_EXCEPT && fetestexcept(FE_ALL_EXCEPT) == 0 && fegetround() == FE_UPWARD;
        _exit(failed ? 2 : own ? 0 : 1);
    }
    assert_true(child > 0 && waitpid(child, &status, 0) == child);
    return status;
}

UNIT_TEST(no_routine_kills_a_host_with_traps)
{
    static const double scale[] = {1, 1e300, 1e-300};
    int status = run(-1, 1);
    if (!WIFSIGNALED(status) || WTERMSIG(status) != SIGFPE)
        skip(); /* a machine without traps, valgrind's say */
    for (int i = 0; i < CALLS; i++)
        for (size_t s = 0; s < (table[i].call == decks ? 1 : sizeof scale / sizeof *scale); s++) {
            status = run(i, scale[s]);
            if (WIFSIGNALED(status))
                fail_msg("one of %sends with signal %d, matrices times %g", table[i].routines, WTERMSIG(status), scale[s]);
            if (WEXITSTATUS(status) == 2)
                fail_msg("one of %sfails, matrices times %g", table[i].routines, scale[s]);
            if (status)
                fail_msg("one of %sleaves traps, flags or rounding changed, matrices times %g", table[i].routines, scale[s]);
        }
}

POOL_TEST(every_routine_is_called)
{
    struct header header;
    const char *called = " ";
    for (int i = 0; i < CALLS; i++)
        called = pool_format(&test_pool, "%s%s", called, table[i].routines);
    assert_int_equal(header_read(&test_pool, ROTID_SOURCE_DIR "/include/rotid.h", &header), 0);
    for (int i = 0; i < header.nfunction; i++)
        if (!strstr(called, pool_format(&test_pool, " %s ", header.function[i].name)))
            fail_msg("%s is not called here", header.function[i].name);
}
