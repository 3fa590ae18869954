/* A host that says stop, once or from then on: what is still computed, what it is told, and what it gets. */
#include <limits.h>
#include <stdatomic.h>
#include <unistd.h>

#include "api_bench.h"
#include "api_dump.h"
#include "fit/fit.h"
#include "folder.h"
#include "paper_fit.h"
#include "support.h"

#define PAPER ROTID_SOURCE_DIR "/input/paper_rotor.inp"

struct host {
    int stop_at, once; /* the poll that says so; once: the next ones do not */
    const char *stage; /* NULL, or polls are counted from the first time that this is told */
    atomic_int polls, told, polls_after, told_after, matrices_after;
    atomic_int said;
    double when;
    const rotid_model *model; /* counted, or NULL */
};

static int cancelled(void *context)
{
    struct host *host = context;
    int poll = atomic_fetch_add(&host->polls, 1) + 1;
    if (atomic_load(&host->said))
        atomic_fetch_add(&host->polls_after, 1);
    if (host->stage)
        return 0;
    if (poll == host->stop_at) {
        host->when = clock_seconds();
        atomic_store(&host->said, 1);
    }
    return host->once ? poll == host->stop_at : poll >= host->stop_at;
}

static void progress(void *context, const char *stage, int step)
{
    struct host *host = context;
    (void)step;
    atomic_fetch_add(&host->told, 1);
    if (host->stage && !strcmp(stage, host->stage)) {
        atomic_store(&host->polls, 0);
        host->stage = NULL;
    }
    if (atomic_load(&host->said))
        atomic_fetch_add(&host->told_after, 1);
}

static rotid_environment environment_of(struct host *host, const rotid_allocator *allocator)
{
    return (rotid_environment){
        .size = sizeof(rotid_environment), .allocator = allocator, .cancelled = cancelled, .progress = progress, .context = host};
}

/* ------------------------------------------------------------------------------------------------ a host's own model */

static int matrices(void *user, const double *x, rotid_matrix *stiffness, rotid_matrix *mass)
{
    struct host *host = user;
    if (atomic_load(&host->said))
        atomic_fetch_add(&host->matrices_after, 1);
    return host->model->matrices(host->model->user, x, stiffness, mass);
}

static int derivatives(void *user, const double *x, int p, rotid_matrix *stiffness, rotid_matrix *mass)
{
    struct host *host = user;
    return host->model->derivatives(host->model->user, x, p, stiffness, mass);
}

UNIT_TEST(a_fit_evaluates_nothing_more)
{
    int ended = 0, in_baseline = 0, most = 0;
    struct paper_fit fit;
    paper_fit_open(&fit, BUNDLE_TUBE);
    fit.options.baseline = 1;
    for (int k = 1; !ended; k = k < 8 ? k + 1 : k * 3 / 2) {
        struct host host = {.stop_at = k, .once = 1, .model = &fit.client.equations};
        rotid_model model = fit.client.equations;
        const rotid_environment environment = environment_of(&host, NULL);
        rotid_fit_result *result;
        model.matrices = matrices;
        model.derivatives = derivatives;
        model.user = &host;
        assert_status(rotid_fit(&model, fit.parameter, &fit.measured, &fit.options, &environment, NULL, &result), ROTID_OK);
        ended = !host.said;
        assert_int_equal(host.polls_after, 0);
        assert_int_equal(host.told_after, 0);
        most = host.matrices_after > most ? host.matrices_after : most;
        in_baseline += host.said && result->status != ROTID_STOP_CANCELLED;
        if (result->status == ROTID_STOP_CANCELLED)
            assert_int_equal(result->iterations, k - 1);
        else
            assert_int_equal(result->nbaseline, ended ? baseline_count(2) : 0);
        rotid_fit_free(result);
    }
    print_message("evaluations after the poll that stopped a fit: at most %d\n", most);
    assert_int_equal(most, 0);
    assert_true(in_baseline > 2 || !baseline_count(2));
    paper_fit_close(&fit);
}

/* ------------------------------------------------------------------------------------------------ decks */

UNIT_TEST(a_beam_beside_a_solid_is_whole_or_stopped)
{
    static const char text[] =
        "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n"
        "*MATERIAL, NAME=cast\n*ELASTIC, TYPE=SHEAR\n1e11, 4e10, 0.3\n*DENSITY\n7850\n"
        "*SHAFT, NAME=left, MATERIAL=steel\n0.4, 0.1, 0, 8\n*SHAFT, NAME=core, MATERIAL=cast\n0.5, 0.2, 0, 8\n";
    rotid_deck *deck;
    assert_status(rotid_deck_read_text(sizeof text - 1, text, "deck", NULL, 0, NULL, NULL, NULL, &deck), ROTID_OK);
    int ended = 0, k = 1;
    for (; !ended; k++) {
        struct host host = {.stop_at = k, .once = 1};
        const rotid_environment environment = environment_of(&host, NULL);
        rotid_spectrum *s;
        int status = rotid_spectrum_beside(deck, NULL, 4, &environment, NULL, &s);
        ended = !host.said;
        assert_int_equal(status, ended ? ROTID_OK : ROTID_STOP_CANCELLED);
        assert_int_equal(host.polls_after, 0);
        if (ended)
            assert_int_equal(s->beside->nmoduli, 2);
        else
            assert_null(s);
        rotid_spectrum_free(s);
    }
    assert_true(k > 3);
    rotid_deck_free(deck);
}

UNIT_TEST(an_identification_ends_with_the_best_point_so_far)
{
    rotid_deck *deck = bench_deck(PAPER);
    rotid_identification *whole, *r;
    double longest = 0;
    int ended = 0, in_baseline = 0;
    assert_status(rotid_identify(deck, 0, NULL, NULL, &whole), ROTID_OK);
    const rotid_fit_result *full = whole->fit;
    for (int baseline = 0; baseline < 2; baseline++)
        for (int k = ended = 0; !ended;) {
            struct failing_allocator memory;
            char failure[512] = "not touched";
            failing_allocator_open(&memory, 0);
            k = k < 8 ? k + 1 : k * 3 / 2;
            struct host host = {.stop_at = k, .once = 1};
            const rotid_environment environment = environment_of(&host, &memory.allocator);
            assert_status(rotid_identify(deck, baseline, &environment, failure, &r), ROTID_OK);
            ended = !host.said;
            if (!ended)
                longest = fmax(longest, clock_seconds() - host.when);
            assert_string_equal(failure, "");
            assert_int_equal(host.polls_after, 0);
            assert_int_equal(host.told_after, 0);
            if (r->fit->status == ROTID_STOP_CANCELLED) {
                int i = r->fit->iterations;
                assert_int_equal(i, k - 1);
                assert_false(r->fit->converged);
                assert_memory_equal(r->fit->x, full->history_x + (ptrdiff_t)i * full->n, (size_t)full->n * sizeof(double));
                assert_close(r->fit->objective, full->history[i].objective, 1e-12, 0);
                assert_true(r->fit->evaluations <= full->evaluations && r->fit->jacobians <= i + 1);
            } else {
                assert_true(r->fit->converged);
                assert_memory_equal(r->fit->x, full->x, (size_t)full->n * sizeof(double));
                int all = baseline ? baseline_count(full->n) : 0, left_out = !ended && all && !r->fit->nbaseline;
                assert_true(left_out ||
                            r->fit->nbaseline == all); /* the stop may come behind it, while other numbers are tried */
                in_baseline += left_out;
            }
            free(dump_identification(r)); /* every number of it is there */
            rotid_identification_free(r);
            assert_int_equal(memory.in_use, 0);
        }
    assert_true(in_baseline > 2 || !baseline_count(2));
    print_message("identification: at most %.1f ms from the poll to the return\n", 1e3 * longest);
    rotid_identification_free(whole);
    rotid_deck_free(deck);
}

UNIT_TEST(a_diagnosis_shows_what_was_finished)
{
    rotid_deck *deck = bench_deck(folder_path("deck.inp"));
    for (int threads = 1; threads <= 2; threads++) {
        const rotid_diagnose_options options = {.size = sizeof options, .threads = threads};
        struct host whole = {.stop_at = INT_MAX};
        const rotid_environment undisturbed = environment_of(&whole, NULL);
        rotid_diagnosis *r;
        double longest = 0, total;
        int nobase = 0, at = 0;
        double begin = clock_seconds();
        assert_status(rotid_diagnose(deck, &options, &undisturbed, NULL, &r), ROTID_OK);
        total = clock_seconds() - begin;
        assert_false(r->interrupted);
        rotid_diagnosis_free(r);
        for (int i = 0; i < 11; i += SPARSE) {
            struct failing_allocator memory;
            struct host host = {.once = i % 2, .stop_at = i < 5 ? i + 1 : 1 + (whole.polls - 1) * (i - 4) / 6};
            failing_allocator_open(&memory, 0);
            /* the allocator of the test counts without a lock */
            const rotid_environment environment = environment_of(&host, threads == 1 ? &memory.allocator : NULL);
            assert_status(rotid_diagnose(deck, &options, &environment, NULL, &r), ROTID_OK);
            if (clock_seconds() - host.when > longest) {
                longest = clock_seconds() - host.when;
                at = host.stop_at;
            }
            if (!r->interrupted)
                print_error("poll %d of %d does not interrupt\n", host.stop_at, (int)whole.polls);
            assert_true(host.said && r->interrupted);
            assert_true(host.polls_after < threads); /* the others may be asking */
            assert_true(host.told_after < threads);
            assert_null(r->verdict.sentence);
            assert_null(r->extended_deck);
            assert_int_equal(r->verdict.kind, -1);
            assert_true(isnan(r->verdict.p_value) && isnan(r->gain.shape_rms.before) && isnan(r->gain.shape_rms.after));
            if (r->extended)
                assert_true(r->extended->fit->status != ROTID_STOP_CANCELLED);
            nobase += r->base == NULL;
            free(dump_diagnosis(r));
            rotid_diagnosis_free(r);
            assert_int_equal(memory.in_use, 0);
        }
        assert_true(nobase > 0);
        print_message("diagnosis of %.0f ms with %d polls, %d thread%s: at most %.1f ms to the return, after poll %d\n",
                      1e3 * total, (int)whole.polls, threads, threads > 1 ? "s" : "", 1e3 * longest, at);
        assert_true(longest < 0.5 * total);
    }
    rotid_deck_free(deck);
}

/* Broken off in the first fit, which ends with a point and without a judged model: at every poll. */
UNIT_TEST(a_diagnosis_may_end_in_its_first_fit)
{
    const rotid_diagnose_options options = {.size = sizeof options};
    rotid_deck *deck;
    assert_status(rotid_deck_read(ROTID_SOURCE_DIR "/input/paper_rotor.inp", 0, NULL, NULL, NULL, &deck), ROTID_OK);
    for (int k = 1; k <= 40; k++) {
        struct failing_allocator memory;
        struct host host = {.stop_at = k};
        failing_allocator_open(&memory, 0);
        const rotid_environment environment = environment_of(&host, &memory.allocator);
        rotid_diagnosis *r;
        assert_status(rotid_diagnose(deck, &options, &environment, NULL, &r), ROTID_OK);
        assert_true(r->interrupted);
        assert_true(r->base || !r->gain.nparameters);
        rotid_diagnosis_free(r);
        assert_int_equal(memory.in_use, 0);
    }
    rotid_deck_free(deck);
}

/* Broken off while the final models are fitted: each is there whole or not at all. */
UNIT_TEST(a_broken_off_model_is_no_result)
{
    const rotid_diagnose_options options = {.size = sizeof options};
    rotid_deck *deck = bench_deck(folder_path("deck.inp"));
    rotid_diagnosis *r;
    int with = 0, without = 0, ended = 0;
    for (int k = 1; !ended; k += 2 * SPARSE) {
        struct host host = {.stop_at = k, .once = 1, .stage = "final model, causes"};
        const rotid_environment environment = environment_of(&host, NULL);
        assert_status(rotid_diagnose(deck, &options, &environment, NULL, &r), ROTID_OK);
        ended = !host.said;
        assert_int_equal(r->interrupted, !ended);
        assert_true(r->base && r->base->fit->converged);
        assert_true(!r->extended || r->extended->fit->converged);
        assert_int_equal(r->verdict.ncauses, 1);
        with += r->extended != NULL;
        without += r->extended == NULL;
        rotid_diagnosis_free(r);
    }
    print_message("broken off at %d polls, %d of them before the extended model was fitted\n", with + without - 1, without);
    assert_true(with > 2 / SPARSE && without > 2 / SPARSE);
    rotid_deck_free(deck);
}

static int open_folder(void **state)
{
    set_blas_threads(1);
    if (folder_make(state))
        return 1;
    bench_hidden_deck(folder_path("deck.inp"), 0.4, 3);
    return 0;
}

TEST_GROUP(open_folder, folder_remove);
