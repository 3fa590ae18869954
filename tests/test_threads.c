/* The first two layers from several threads at once: the same numbers as one after the other, to the last bit. `make check-tsan`
 * runs it under the thread sanitizer. */
#include <pthread.h>
#include <unistd.h>

#include "api_bench.h"
#include "api_dump.h"
#include "support.h"

#define IDENTIFIERS 8 /* threads; the last two work on one deck */
#define DECKS       (IDENTIFIERS - 1)
#define DIAGNOSERS  2 /* each asks for two threads; the second one works on that same deck */
#define REPEATS     2

static char directory[] = "/tmp/test_threads_XXXXXX", path[DECKS][64];

struct task {
    const char *path;       /* of a deck to read, or NULL */
    const rotid_deck *deck; /* then: one that others use too */
    int diagnoses;
    pthread_barrier_t *begin; /* NULL: alone */
    int status;
    rotid_deck *own;
    rotid_spectrum *spectrum[REPEATS];
    rotid_identification *identification[REPEATS];
    rotid_diagnosis *diagnosis;
};

static void *run(void *argument)
{
    struct task *task = argument;
    const rotid_diagnose_options options = {.size = sizeof options, .threads = 2};
    char failure[512];
    if (task->begin)
        (void)pthread_barrier_wait(task->begin);
    if (task->path)
        task->status = rotid_deck_read(task->path, 0, NULL, NULL, NULL, &task->own);
    const rotid_deck *deck = task->path ? task->own : task->deck;
    for (int i = 0; i < REPEATS && !task->status && !task->diagnoses; i++) {
        task->status = rotid_spectrum_compute(deck, NULL, 5, NULL, NULL, &task->spectrum[i]);
        if (!task->status)
            task->status = rotid_identify(deck, 1, NULL, failure, &task->identification[i]);
    }
    if (!task->status && task->diagnoses)
        task->status = rotid_diagnose(deck, &options, NULL, failure, &task->diagnosis);
    return NULL;
}

/* What the deck gives when nothing else runs. */
struct expected {
    char *deck, *spectrum, *identification, *diagnosis;
};

static struct expected run_alone(const char *deck_path, int diagnoses)
{
    struct expected e = {.deck = NULL};
    struct task task = {.path = deck_path, .diagnoses = diagnoses};
    const rotid_diagnose_options one = {.size = sizeof one, .threads = 1};
    (void)run(&task);
    assert_status(task.status, ROTID_OK);
    e.deck = dump_deck(task.own);
    if (diagnoses) {
        rotid_diagnosis *serial;
        e.diagnosis = dump_diagnosis(task.diagnosis);
        rotid_diagnosis_free(task.diagnosis);
        assert_status(rotid_diagnose(task.own, &one, NULL, NULL, &serial), ROTID_OK);
        assert_dump(dump_diagnosis(serial), e.diagnosis); /* whatever the number of threads */
        rotid_diagnosis_free(serial);
    } else {
        e.spectrum = dump_spectrum(task.spectrum[0]);
        e.identification = dump_identification(task.identification[0]);
    }
    for (int i = 0; i < REPEATS; i++) {
        rotid_spectrum_free(task.spectrum[i]);
        rotid_identification_free(task.identification[i]);
    }
    rotid_deck_free(task.own);
    return e;
}

static void check(struct task *task, const struct expected *e)
{
    assert_status(task->status, ROTID_OK);
    if (task->own)
        assert_dump(dump_deck(task->own), e->deck);
    rotid_deck_free(task->own); /* before its results */
    for (int i = 0; i < REPEATS && !task->diagnoses; i++) {
        assert_dump(dump_spectrum(task->spectrum[i]), e->spectrum);
        assert_dump(dump_identification(task->identification[i]), e->identification);
        rotid_spectrum_free(task->spectrum[i]);
        rotid_identification_free(task->identification[i]);
    }
    if (task->diagnoses)
        assert_dump(dump_diagnosis(task->diagnosis), e->diagnosis);
    rotid_diagnosis_free(task->diagnosis);
}

UNIT_TEST(eight_identifications_and_two_diagnoses_at_once)
{
    pthread_t thread[IDENTIFIERS + DIAGNOSERS];
    struct task task[IDENTIFIERS + DIAGNOSERS] = {{.path = NULL}};
    struct expected expected[DECKS], diagnosed[DIAGNOSERS];
    pthread_barrier_t begin;
    for (int d = 0; d < DECKS; d++)
        expected[d] = run_alone(path[d], 0);
    assert_string_not_equal(expected[0].identification, expected[1].identification);
    diagnosed[0] = run_alone(path[0], 1);
    diagnosed[1] = run_alone(path[DECKS - 1], 1);
    rotid_deck *shared = bench_deck(path[DECKS - 1]);
    assert_int_equal(pthread_barrier_init(&begin, NULL, IDENTIFIERS + DIAGNOSERS), 0);
    for (int t = 0; t < IDENTIFIERS + DIAGNOSERS; t++) {
        int shares = t == IDENTIFIERS - 2 || t == IDENTIFIERS - 1 || t == IDENTIFIERS + 1;
        task[t] = (struct task){.path = shares            ? NULL
                                        : t < IDENTIFIERS ? path[t]
                                                          : path[0],
                                .deck = shared,
                                .diagnoses = t >= IDENTIFIERS,
                                .begin = &begin};
        assert_int_equal(pthread_create(&thread[t], NULL, run, &task[t]), 0);
    }
    for (int t = 0; t < IDENTIFIERS + DIAGNOSERS; t++)
        assert_int_equal(pthread_join(thread[t], NULL), 0);
    (void)pthread_barrier_destroy(&begin);
    rotid_deck_free(shared);
    for (int t = 0; t < IDENTIFIERS; t++)
        check(&task[t], &expected[t < DECKS ? t : DECKS - 1]);
    for (int t = 0; t < DIAGNOSERS; t++)
        check(&task[IDENTIFIERS + t], &diagnosed[t]);
    for (int d = 0; d < DECKS + DIAGNOSERS; d++) {
        const struct expected *e = d < DECKS ? &expected[d] : &diagnosed[d - DECKS];
        free(e->deck);
        free(e->spectrum);
        free(e->identification);
        free(e->diagnosis);
    }
}

static int open_directory(void **state)
{
    (void)state;
    set_blas_threads(1);
    if (!mkdtemp(directory))
        return 1;
    for (int d = 0; d < DECKS; d++) {
        (void)snprintf(path[d], sizeof path[d], "%s/%d.inp", directory, d);
        bench_hidden_deck(path[d], d % 2 ? 0.1 * d : 0, (unsigned)d + 1);
    }
    return 0;
}

static int remove_directory(void **state)
{
    (void)state;
    for (int d = 0; d < DECKS; d++)
        (void)unlink(path[d]);
    return rmdir(directory);
}

TEST_GROUP(open_directory, remove_directory);
