/* What a call leaves of its host: traps, flags, rounding, locale and the number of BLAS threads are as they were, and none of
 * them changes a number of the result. */
#define _GNU_SOURCE /* feenableexcept */
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "api_bench.h"
#include "api_dump.h"
#include "paper_fit.h"
#include "support.h"

#define TRAPS (FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW)

static char directory[] = "/tmp/test_host_XXXXXX", deck_path[64];

static const rotid_diagnose_options quick = {.size = sizeof quick, .threads = 2};

/* Everything the first layer does, as text. */
struct results {
    char *deck, *spectrum, *identification, *diagnosis;
};

static struct results run_all(const rotid_environment *environment)
{
    struct results r;
    rotid_deck *deck;
    rotid_spectrum *spectrum;
    rotid_identification *identification;
    rotid_diagnosis *diagnosis;
    static const char *const lower_case[] = {"fit.functional=likelihood", "fit.reduction=irs"};
    assert_status(rotid_deck_read(deck_path, 2, lower_case, environment, NULL, &deck), ROTID_OK);
    assert_status(rotid_spectrum_compute(deck, NULL, 5, environment, NULL, &spectrum), ROTID_OK);
    assert_status(rotid_identify(deck, 0, environment, NULL, &identification), ROTID_OK);
    assert_status(rotid_diagnose(deck, &quick, environment, NULL, &diagnosis), ROTID_OK);
    struct host_locale host; /* the texts of the numbers are to be those of one locale */
    assert_int_equal(host_enter_locale(&host), 0);
    r = (struct results){dump_deck(deck), dump_spectrum(spectrum), dump_identification(identification),
                         dump_diagnosis(diagnosis)};
    host_leave_locale(&host);
    rotid_deck_free(deck);
    rotid_spectrum_free(spectrum);
    rotid_identification_free(identification);
    rotid_diagnosis_free(diagnosis);
    return r;
}

static struct results usual; /* of the environment that a C program starts with */

/* Frees them. */
static void assert_usual(struct results *results)
{
    assert_dump(results->deck, usual.deck);
    assert_dump(results->spectrum, usual.spectrum);
    assert_dump(results->identification, usual.identification);
    assert_dump(results->diagnosis, usual.diagnosis);
}

/* ------------------------------------------------------------------------------------------------ floating point */

/* A child that divides by zero with the traps on: killed, unless the machine (valgrind's, say) has none. */
static int traps_work(void)
{
    int status = 0;
    (void)fflush(NULL);
    pid_t child = fork();
    if (child == 0) {
        const struct rlimit no_core = {0, 0};
        volatile double zero = 0;
        (void)setrlimit(RLIMIT_CORE, &no_core);
        (void)signal(SIGFPE, SIG_DFL);
        (void)feenableexcept(TRAPS);
        zero = zero / zero;
        _exit(zero == 0);
    }
    assert_true(child > 0 && waitpid(child, &status, 0) == child);
    return WIFSIGNALED(status) && WTERMSIG(status) == SIGFPE;
}

static void trap(void)
{
    (void)feclearexcept(FE_ALL_EXCEPT);
    (void)feraiseexcept(FE_UNDERFLOW); /* a flag of the host's own */
    (void)feenableexcept(TRAPS);
}

/* Traps and flags as `trap` left them; switches them off. */
static void assert_trapping(void)
{
    int traps = fegetexcept(), flags = fetestexcept(FE_ALL_EXCEPT & ~FE_INEXACT), rounding = fegetround();
    (void)fedisableexcept(FE_ALL_EXCEPT);
    assert_int_equal(traps, TRAPS);
    assert_int_equal(flags, FE_UNDERFLOW);
    assert_int_equal(rounding, FE_TONEAREST);
}

UNIT_TEST(a_host_with_traps_survives_the_first_layer)
{
    if (!traps_work())
        skip();
    trap();
    struct results r = run_all(NULL);
    assert_trapping();
    assert_usual(&r);
    rotid_deck *deck;
    rotid_identification *identification;
    trap(); /* and the ways out of it that are errors */
    int read = rotid_deck_read("/nowhere", 0, NULL, NULL, NULL, &deck),
        identified = rotid_identify(deck, 0, NULL, NULL, &identification);
    assert_trapping();
    assert_status(read, ROTID_ERROR_IO);
    assert_status(identified, ROTID_ERROR_ARGUMENT);
    rotid_deck_free(deck);
}

static int has_no_number(void *user, int m, int n, const double *x, double *r, double *jacobian)
{
    int *calls = user;
    (void)n, (void)m;
    ++*calls;
    if (r) { /* overflows and becomes a NaN away from the start */
        r[0] = (x[0] - 1) * 1e-3;
        r[1] = *calls == 1 ? 0 : exp(1e3 * fabs(x[0])) * 0;
    } else {
        jacobian[0] = 1e-3;
        jacobian[1] = 0;
    }
    return 0;
}

UNIT_TEST(a_host_with_traps_survives_a_fit)
{
    if (!traps_work())
        skip();
    struct paper_fit fit;
    paper_fit_open(&fit, BUNDLE_TUBE);
    paper_synthesise(&fit, scipy_optimum, 1e-3, 0.015);
    fit.shape[3] = fit.shape[7] = NAN;
    fit.options.functional = ROTID_LIKELIHOOD;
    fit.options.reduction = ROTID_REDUCTION_NONE;
    fit.options.baseline = 1;
    rotid_fit_result *result, *none;
    trap();
    int status = rotid_fit(&fit.client.equations, fit.parameter, &fit.measured, &fit.options, NULL, NULL, &result);
    assert_trapping();
    assert_status(status, ROTID_OK);
    assert_true(result->converged);
    rotid_fit_free(result);
    fit.parameter[0].start = NAN;
    trap();
    status = rotid_fit(&fit.client.equations, fit.parameter, &fit.measured, &fit.options, NULL, NULL, &none);
    assert_trapping();
    assert_status(status, ROTID_ERROR_ARGUMENT);
    paper_fit_close(&fit);

    double x[1] = {3}, r[2], jacobian[2], work[512];
    int calls = 0;
    rotid_lm_result lm;
    assert_true(rotid_lm_workspace(2, 1) <= sizeof work / sizeof *work);
    trap();
    status = rotid_lm(2, 1, has_no_number, &calls, NULL, NULL, x, r, jacobian, work, &lm);
    assert_trapping();
    assert_true(status > 0 && calls > 2);
    x[0] = NAN;
    trap();
    status = rotid_lm(2, 1, has_no_number, &calls, NULL, NULL, x, r, jacobian, work, &lm);
    assert_trapping();
    assert_status(status, ROTID_ERROR_ARGUMENT);
}

/* ------------------------------------------------------------------------------------------------ locale */

/* A locale of the system, built for this test alone; 0 where that cannot be done. */
static int build_locale(const char *source, const char *charset, const char *name)
{
    char command[256], sources[128];
    (void)snprintf(sources, sizeof sources, "/usr/share/i18n/locales/%s", source);
    if (access(sources, R_OK))
        return 0;
    (void)snprintf(command, sizeof command, "localedef --no-archive -i %s -f %s %s/%s >/dev/null 2>&1", source, charset,
                   directory, name);
    return system(command) == 0;
}

static void say_number(void *context, const char *stage, int step)
{
    (void)stage, (void)step;
    (void)snprintf(context, 16, "%.1f", 1.5);
}

/* In that locale, of the process or of the thread alone. */
static void run_in(const char *name, const char *text_of_number)
{
    char text[16], inside[16] = "";
    for (int of_thread = 0; of_thread < 2; of_thread++) {
        locale_t own = (locale_t)0;
        assert_non_null(setlocale(LC_ALL, name));
        if (of_thread) {
            own = duplocale(LC_GLOBAL_LOCALE); /* newlocale of glibc loses a few bytes for each LOCPATH */
            assert_true(own != (locale_t)0);
            (void)setlocale(LC_ALL, "C");
            (void)uselocale(own);
        }
        const locale_t before = uselocale((locale_t)0);
        (void)snprintf(text, sizeof text, "%.1f", 1.5);
        assert_string_equal(text, text_of_number); /* it is what it says it is */
        const rotid_environment environment = {.size = sizeof environment, .progress = say_number, .context = inside};
        struct results r = run_all(&environment);
        (void)snprintf(text, sizeof text, "%.1f", 1.5);
        int same = uselocale((locale_t)0) == before;
        (void)uselocale(LC_GLOBAL_LOCALE);
        (void)setlocale(LC_ALL, "C");
        if (of_thread)
            freelocale(own);
        assert_true(same);
        assert_string_equal(text, text_of_number);
        assert_string_equal(inside, "1.5");
        assert_usual(&r);
    }
}

UNIT_TEST(a_host_with_a_decimal_comma_gets_the_same_numbers)
{
    if (!build_locale("de_DE", "UTF-8", "de_DE.UTF-8")) {
        print_message("skipped: localedef cannot build de_DE.UTF-8\n");
        skip();
    }
    run_in("de_DE.UTF-8", "1,5");
}

/* There the capital of i is no I, so that "fit" would not be FIT. */
UNIT_TEST(a_turkish_host_may_write_cards_in_small_letters)
{
    if (!build_locale("tr_TR", "ISO-8859-9", "tr_TR.ISO-8859-9")) {
        print_message("skipped: localedef cannot build tr_TR.ISO-8859-9\n");
        skip();
    }
    run_in("tr_TR.ISO-8859-9", "1,5");
}

/* ------------------------------------------------------------------------------------------------ threads */

struct seen {
    int failed[64];
    locale_t locale;
};

/* Long enough for both threads to get some. */
static int look(void *context, int index, int worker)
{
    struct seen *seen = context;
    volatile double zero = 0;
    double sum = 0;
    (void)worker;
    for (int i = 0; i < 200000; i++)
        sum += i;
    sum += zero / zero; /* would kill the process */
    seen->failed[index] = !isnan(sum) || uselocale((locale_t)0) != seen->locale || fegetround() != FE_TOWARDZERO;
    return 0;
}

UNIT_TEST(workers_compute_as_their_caller)
{
    struct seen seen = {.failed = {0}};
    struct host_locale outer;
    fenv_t floating;
    (void)fesetround(FE_TOWARDZERO);
    if (traps_work())
        trap();
    host_enter_floating(&floating);
    assert_int_equal(host_enter_locale(&outer), 0);
    seen.locale = uselocale((locale_t)0);
    (void)parallel_for(4, 64, look, &seen);
    host_leave_locale(&outer);
    host_leave_floating(&floating);
    (void)fedisableexcept(FE_ALL_EXCEPT);
    int rounding = fegetround();
    (void)fesetround(FE_TONEAREST);
    assert_int_equal(rounding, FE_TOWARDZERO);
    for (int i = 0; i < 64; i++)
        assert_false(seen.failed[i]);
    assert_true(uselocale((locale_t)0) == LC_GLOBAL_LOCALE);
}

UNIT_TEST(the_blas_keeps_the_number_of_threads_of_its_host)
{
    int began_with = blas_threads();
    if (!began_with)
        skip(); /* a BLAS without */
    for (int threads = 1; threads <= 2; threads++) {
        rotid_deck *deck;
        rotid_spectrum *spectrum;
        rotid_identification *identification;
        rotid_diagnosis *diagnosis;
        set_blas_threads(threads);
        assert_int_equal(blas_threads(), threads); /* or there would be nothing to see */
        assert_status(rotid_deck_read(deck_path, 0, NULL, NULL, NULL, &deck), ROTID_OK);
        assert_int_equal(blas_threads(), threads);
        assert_status(rotid_spectrum_compute(deck, NULL, 5, NULL, NULL, &spectrum), ROTID_OK);
        assert_int_equal(blas_threads(), threads);
        assert_status(rotid_identify(deck, 1, NULL, NULL, &identification), ROTID_OK);
        assert_int_equal(blas_threads(), threads);
        assert_status(rotid_diagnose(deck, &quick, NULL, NULL, &diagnosis), ROTID_OK);
        assert_int_equal(blas_threads(), threads);
        rotid_diagnosis_free(diagnosis);
        rotid_identification_free(identification);
        rotid_spectrum_free(spectrum);
        rotid_deck_free(deck);
    }
    set_blas_threads(began_with);
}

UNIT_TEST(an_error_of_the_system_has_a_text)
{
    char text[HOST_ERROR_TEXT];
    assert_string_equal(host_error_text(2, text), strerror(2));
    assert_true(host_error_text(123456, text)[0] != 0);
}

static int open_directory(void **state)
{
    (void)state;
    set_blas_threads(1);
    if (!mkdtemp(directory) || setenv("LOCPATH", directory, 1))
        return 1;
    (void)snprintf(deck_path, sizeof deck_path, "%s/deck.inp", directory);
    bench_hidden_deck(deck_path, 0.4, 2);
    usual = run_all(NULL);
    return 0;
}

static int remove_directory(void **state)
{
    char command[64];
    (void)state;
    free(usual.deck);
    free(usual.spectrum);
    free(usual.identification);
    free(usual.diagnosis);
    (void)snprintf(command, sizeof command, "rm -r '%s'", directory);
    return system(command);
}

TEST_GROUP(open_directory, remove_directory);
