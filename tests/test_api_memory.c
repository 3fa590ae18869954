/* The memory of the first layer: every allocation that fails, all of it from the host's allocator, all of it given back, and no
 * result that leans on the deck. */
#include <errno.h>
#include <unistd.h>

#include "api_bench.h"
#include "api_dump.h"
#include "folder.h"
#include "support.h"

#define PAPER ROTID_SOURCE_DIR "/input/paper_rotor.inp"

/* ------------------------------------------------------------------------------------------------ failing allocations */

typedef int (*attempt)(const rotid_deck *deck, const rotid_environment *environment, void **result);

static void free_deck(void *result)
{
    rotid_deck_free(result);
}

static int try_read(const rotid_deck *deck, const rotid_environment *environment, void **result)
{
    static const char *const override[] = {"FIT.MODES=1-4", "NOISE.FREQUENCY=0.001"};
    rotid_deck *made = (void *)1;
    (void)deck;
    int status = rotid_deck_read(folder_path("deck.inp"), 2, override, environment, NULL, &made);
    *result = made;
    return status;
}

static int try_read_states(const rotid_deck *deck, const rotid_environment *environment, void **result)
{
    rotid_deck *made = (void *)1;
    (void)deck;
    int status = rotid_deck_read(ROTID_SOURCE_DIR "/input/strip_states.inp", 0, NULL, environment, NULL, &made);
    *result = made;
    return status;
}

static int try_read_wrong(const rotid_deck *deck, const rotid_environment *environment, void **result)
{
    static const char *const override[] = {"FIT.FUNCTIONAL=NONE", "SHAFTS.NAME=x"};
    rotid_deck *made = (void *)1;
    (void)deck;
    int status = rotid_deck_read(PAPER, 2, override, environment, NULL, &made);
    *result = made;
    return status == ROTID_ERROR_SYNTAX && made && made->nerror == 2 && made->nmessage >= 2 ? ROTID_OK : status;
}

static int try_spectrum(const rotid_deck *deck, const rotid_environment *environment, void **result)
{
    rotid_spectrum *made = (void *)1;
    int status = rotid_spectrum_compute(deck, NULL, 6, environment, NULL, &made);
    *result = made;
    return status;
}

static void free_spectrum(void *result)
{
    rotid_spectrum_free(result);
}

static int try_identify(const rotid_deck *deck, const rotid_environment *environment, void **result)
{
    char failure[512];
    rotid_identification *made = (void *)1;
    int status = rotid_identify(deck, 1, environment, failure, &made);
    assert_string_equal(failure, status ? rotid_status_text(status) : "");
    *result = made;
    return status;
}

static void free_identification(void *result)
{
    rotid_identification_free(result);
}

static int try_diagnose(const rotid_deck *deck, const rotid_environment *environment, void **result)
{
    const rotid_diagnose_options options = {.size = sizeof options};
    char failure[512];
    rotid_diagnosis *made = (void *)1;
    int status = rotid_diagnose(deck, &options, environment, failure, &made);
    assert_string_equal(failure, status ? rotid_status_text(status) : "");
    *result = made;
    return status;
}

static void free_diagnosis(void *result)
{
    rotid_diagnosis_free(result);
}

static int try_suggest(const rotid_deck *deck, const rotid_environment *environment, void **result)
{
    const rotid_suggest_options options = {.size = sizeof options, .sensors = 3, .modes = 3};
    char failure[512];
    rotid_suggestion *made = (void *)1;
    int status = rotid_suggest(deck, &options, environment, failure, &made);
    assert_string_equal(failure, status ? rotid_status_text(status) : "");
    *result = made;
    return status;
}

static void free_suggestion(void *result)
{
    rotid_suggestion_free(result);
}

static int try_speeds(const rotid_deck *deck, const rotid_environment *environment, void **result)
{
    const rotid_speeds_options options = {.size = sizeof options, .draws = 20, .count = 5};
    char failure[512];
    rotid_speeds *made = (void *)1;
    int status = rotid_speeds_compute(deck, &options, environment, failure, &made);
    assert_string_equal(failure, status ? rotid_status_text(status) : "");
    *result = made;
    return status;
}

static void free_speeds(void *result)
{
    rotid_speeds_free(result);
}

/* One run whose n-th allocation fails, 0: none. Returns how many it was served. */
static long run_once(const rotid_deck *deck, attempt try_it, void (*release)(void *result), long n)
{
    struct failing_allocator failing;
    void *result;
    failing_allocator_open(&failing, n);
    const rotid_environment environment = {.size = sizeof environment, .allocator = &failing.allocator};
    int status = try_it(deck, &environment, &result), failed = n && failing.until_failure == 0;
    if (status != (failed ? ROTID_ERROR_MEMORY : ROTID_OK))
        print_error("allocation %ld: %s\n", n, rotid_status_name(status));
    assert_int_equal(status, failed ? ROTID_ERROR_MEMORY : ROTID_OK);
    assert_true((result == NULL) == failed);
    release(result);
    assert_int_equal(failing.in_use, 0);
    return failing.served;
}

#define LAST (SPARSE > 1 ? 1 : 3) /* that are made to fail, each behind nearly all of the work */

/* Every n up to `early`, then further apart by `factor`, and the last ones. */
static void sweep(const char *name, const rotid_deck *deck, attempt try_it, void (*release)(void *result), long early,
                  double factor)
{
    long all = run_once(deck, try_it, release, 0), tried = 0, next;
    factor = pow(factor, SPARSE);
    for (long n = 1; n <= all; n = next) {
        (void)run_once(deck, try_it, release, n);
        tried++;
        next = n < early || n + LAST > all ? n + 1 : (long)(factor * (double)n) + 1;
        next = n < all - LAST + 1 && next > all - LAST + 1 ? all - LAST + 1 : next;
    }
    if (SPARSE == 1)
        assert_int_equal(run_once(deck, try_it, release, all + 1), all);
    print_message("%s: %ld allocations, %ld of them made to fail\n", name, all, tried);
}

static const char machine[] =
    "*MATERIAL, NAME=s\n*ELASTIC\n2e11, 0.3\n*DENSITY\n7800\n*SHAFT, NAME=a, MATERIAL=s\n1, 0.05, 0, 12\n*NOISE, "
    "FREQUENCY=1e-3\n*MODES\n1, 222\n2, 605\n*IDENTIFY\na.E, 1e10, 1e12, 2e11\n*RUNNING\n*BEARING, NAME=p\nstart, 5e6, "
    "100\n*BEARING, NAME=q, STD=0.1\nend, 5e6, 100\n*UNBALANCE\n0.5, 0.001\n*PROBE, NAME=x\n0.4\n*OPERATION, "
    "MARGIN=0.1\n1000, 3000\n*RUNUP\n1, 4200, 50\n*IDENTIFY\np.k, 0.1, 10, 1\n";

UNIT_TEST(every_allocation_may_fail)
{
    rotid_deck *deck = bench_deck(folder_path("deck.inp")), *bar = bench_deck(folder_path("bar.inp"));
    sweep("rotid_deck_read", NULL, try_read, free_deck, 100000, 1);
    sweep("rotid_deck_read of states", NULL, try_read_states, free_deck, 100000, 1);
    sweep("rotid_deck_read of a wrong deck", NULL, try_read_wrong, free_deck, 300, 1.1);
    sweep("rotid_spectrum_compute", bar, try_spectrum, free_spectrum, 100000, 1);
    sweep("rotid_identify", bar, try_identify, free_identification, 200, 1.02);
    sweep("rotid_diagnose", deck, try_diagnose, free_diagnosis, 150, 1.7);
    sweep("rotid_suggest", bar, try_suggest, free_suggestion, 40, 2.2);
    rotid_deck_free(deck);
    rotid_deck_free(bar);
    assert_int_equal(rotid_deck_read_text(strlen(machine), machine, NULL, NULL, 0, NULL, NULL, NULL, &deck), ROTID_OK);
    sweep("rotid_identify with a run-up", deck, try_identify, free_identification, 40, 2.5);
    sweep("rotid_speeds_compute", deck, try_speeds, free_speeds, 60, 1.7);
    long all = run_once(deck, try_speeds, free_speeds, 0);
    for (long n = all / 2; n < all; n += SPARSE * (all / 40)) /* in torsion and its deviations */
        (void)run_once(deck, try_speeds, free_speeds, n);
    rotid_deck_free(deck);
    deck = bench_deck(ROTID_SOURCE_DIR "/input/motor_running.inp");
    all = run_once(deck, try_speeds, free_speeds, 0);
    for (long n = all / 2; n < all; n += SPARSE * (all / 5)) /* in the draws of the bands, one of which may have no result */
        (void)run_once(deck, try_speeds, free_speeds, n);
    rotid_deck_free(deck);
}

/* ------------------------------------------------------------------------------------------------ whose memory */

#define OWNED(pointer) assert_true(bench_owns(&memory, (pointer)))

static void check_identification(const struct bench_memory *owner, const rotid_identification *r)
{
    const struct bench_memory memory = *owner;
    OWNED(r);
    OWNED(r->fit);
    OWNED(r->fit->jacobian);
    OWNED(r->parameters);
    OWNED(r->parameters[0].name);
    OWNED(r->modes);
}

/* The allocator spoils what it gets back, so a pointer into the deck, from any member that a result has, would show. */
UNIT_TEST(results_outlive_the_deck_and_live_on_the_allocator)
{
    struct bench_memory memory;
    rotid_deck *deck;
    rotid_spectrum *spectrum;
    rotid_identification *identification;
    rotid_diagnosis *diagnosis;
    const rotid_diagnose_options options = {.size = sizeof options};
    bench_memory_open(&memory);
    const rotid_environment environment = {.size = sizeof environment, .allocator = &memory.allocator};
    assert_status(rotid_deck_read(folder_path("deck.inp"), 0, NULL, &environment, NULL, &deck), ROTID_OK);
    OWNED(deck);
    OWNED(deck->path);
    OWNED(deck->sensor_z);
    OWNED(deck->shape);
    OWNED(deck->parameter[0].name);
    assert_status(rotid_spectrum_compute(deck, NULL, 5, &environment, NULL, &spectrum), ROTID_OK);
    OWNED(spectrum);
    OWNED(spectrum->modes);
    OWNED(spectrum->modes[0].shape);
    OWNED(spectrum->master_mass);
    assert_status(rotid_identify(deck, 1, &environment, NULL, &identification), ROTID_OK);
    check_identification(&memory, identification);
    assert_status(rotid_diagnose(deck, &options, &environment, NULL, &diagnosis), ROTID_OK);
    assert_int_equal(diagnosis->verdict.kind, ROTID_NAMED);
    OWNED(diagnosis->extended_deck);
    OWNED(diagnosis->candidates);
    check_identification(&memory, diagnosis->base);
    check_identification(&memory, diagnosis->extended);
    char *with[3] = {dump_spectrum(spectrum), dump_identification(identification), dump_diagnosis(diagnosis)};
    rotid_deck_free(deck);
    assert_dump(dump_spectrum(spectrum), with[0]);
    rotid_spectrum_free(spectrum);
    assert_dump(dump_identification(identification), with[1]);
    rotid_identification_free((rotid_identification *)diagnosis->base); /* belongs to the diagnosis: nothing happens */
    rotid_identification_free(identification);
    assert_dump(dump_diagnosis(diagnosis), with[2]);
    rotid_diagnosis_free(diagnosis);
    assert_int_equal(memory.in_use, 0);
    for (int i = 0; i < 3; i++)
        free(with[i]);
}

/* What a result keeps, against what its run took: the scratch is gone when the call returns. */
UNIT_TEST(results_are_small)
{
    struct bench_memory memory;
    rotid_identification *identification;
    rotid_diagnosis *diagnosis;
    const rotid_diagnose_options options = {.size = sizeof options};
    bench_memory_open(&memory);
    const rotid_environment environment = {.size = sizeof environment, .allocator = &memory.allocator};
    rotid_deck *deck = bench_deck(folder_path("deck.inp"));
    assert_status(rotid_identify(deck, 0, &environment, NULL, &identification), ROTID_OK);
    print_message("identification: %ld blocks of %ld kept\n", memory.in_use, memory.served);
    assert_true(memory.served > 5 * memory.in_use);
    rotid_identification_free(identification);
    memory.served = 0;
    assert_status(rotid_diagnose(deck, &options, &environment, NULL, &diagnosis), ROTID_OK);
    print_message("diagnosis: %ld blocks of %ld kept\n", memory.in_use, memory.served);
    assert_true(memory.in_use < 2000 && memory.served > 10 * memory.in_use);
    rotid_diagnosis_free(diagnosis);
    rotid_deck_free(deck);
    assert_int_equal(memory.in_use, 0);
}

/* ------------------------------------------------------------------------------------------------ files */

static int openings = -1; /* before the one for whose stream there is no memory; below 0: none */

/* In place of the one of libc, in this program */
FILE *fdopen(int descriptor, const char *mode)
{
    char path[40];
    if (openings-- == 0) {
        errno = ENOMEM;
        return NULL;
    }
    (void)snprintf(path, sizeof path, "/proc/self/fd/%d", descriptor);
    FILE *stream = fopen(path, mode);
    if (stream)
        (void)close(descriptor);
    return stream;
}

/* A file that has no stream for want of memory is no mistake of the deck. */
UNIT_TEST(no_memory_for_a_stream_is_no_error_of_the_input)
{
    static const struct {
        const char *name, *text;
    } decks[] = {
        {"plain.inp", "*MATERIAL, NAME=s\n"},
        {"outer.inp", "*INCLUDE, FILE=bar.inp\n"},
        {"table.inp", "*MODES, FILE=modes.csv\n"},
        {"shapes.inp", "*MATERIAL, NAME=s\n*ELASTIC\n2e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=a, MATERIAL=s\n1, 0.1\n"
                       "*MEASURED, FILE=modes.unv\n"},
    };
    (void)folder_write("modes.csv", "mode,frequency\n1,100\n");
    (void)folder_write("modes.unv", "    -1\n    15\n    -1\n");
    for (size_t i = 0; i < sizeof decks / sizeof *decks; i++) {
        rotid_deck *deck;
        const char *path = folder_write(decks[i].name, decks[i].text);
        openings = i > 0;
        assert_status(rotid_deck_read(path, 0, NULL, NULL, NULL, &deck), ROTID_ERROR_MEMORY);
        assert_int_equal(openings, -1);
        rotid_deck_free(deck);
    }
}

static int open_folder(void **state)
{
    set_blas_threads(1);
    if (folder_make(state))
        return 1;
    bench_hidden_deck(folder_path("deck.inp"), 0.4, 3);
    (void)folder_write("bar.inp",
                       "*MATERIAL, NAME=steel\n*ELASTIC\n2e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=core, MATERIAL=steel\n"
                       "1.2, 0.1, 0, 6\n*MODES\n1, 300\n2, 800\n3, 1500\n*NOISE, FREQUENCY=0.001\n"
                       "*IDENTIFY\ncore.E, 1e11, 3e11, 1.9e11\ncore.rho, 7000, 9000, 8000\n");
    return 0;
}

TEST_GROUP(open_folder, folder_remove);
