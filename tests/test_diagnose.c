/* The diagnosis as a whole on a small rotor: the same for any number of threads, interrupted or out of memory at any point, and
 * on data that cannot carry a name. Decks are written as a user would write them; the data are modes of a rotor with an effect
 * in it that the deck does not have, and noise. */
#include <unistd.h>

#include "deck/deck.h"
#include "diagnose/causes/causes.h"
#include "diagnose/diagnose.h"
#include "folder.h"
#include "modal/modal.h"
#include "model/model.h"
#include "one_state.h"
#include "support.h"

#define SENSORS 17
#define MODES   5
#define LENGTH  1.8

static const char model[] = "*HEADING\nhidden\n"
                            "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n"
                            "*MATERIAL, NAME=sheets\n*ELASTIC, TYPE=SHEAR\n1.1e11, 0.4e11, 0.28\n*DENSITY\n7600\n"
                            "*SHAFT, NAME=left, MATERIAL=steel\n0.4, 0.15, 0, 8\n"
                            "*SHAFT, NAME=core, MATERIAL=sheets\n0.9, 0.3, 0, 16\n"
                            "*SHAFT, NAME=right, MATERIAL=steel\n0.5, 0.17, 0, 10\n"
                            "*SPRING, NAME=sling\nstart, 9000\n*SPRING, NAME=tail\nend, 2000\n";
static const char identify[] = "*IDENTIFY\ncore.E, 2e10, 2.2e11, 0.9e11\ncore.G, 1e10, 0.9e11, 0.35e11\n";
static const char noise_card[] = "*NOISE, FREQUENCY=0.001, SHAPE=0.015\n";

static char text[60000];

static void append(const char *format, ...) __attribute__((format(printf, 1, 2)));
static void append(const char *format, ...)
{
    size_t used = strlen(text);
    va_list arguments;
    va_start(arguments, format);
    int count = vsnprintf(text + used, sizeof text - used, format, arguments);
    va_end(arguments);
    assert_true(count >= 0 && used + (size_t)count < sizeof text);
}

/* ---- the data ---- */

struct data {
    double z[SENSORS], hz[MODES + 1], shape[SENSORS * (MODES + 1)];
};

static int read_deck(struct pool *pool, struct message_list *messages, struct job *job)
{
    message_open(messages, pool);
    int status = deck_read(pool, folder_path("deck.inp"), 0, NULL, messages, job);
    for (size_t i = 0; i < messages->count && status; i++)
        print_message("deck %d:%d: %s\n", messages->item[i].line, messages->item[i].column, messages->item[i].text);
    return status;
}

static void append_sensors(const struct data *d, int from, int step, int to)
{
    append("*SENSORS\n");
    for (int s = from; s < to; s += step)
        append("%d, %.9g\n", s + 1, d->z[s]);
}

/* Modes of the model with a CAUSE card behind it (NULL: nothing hidden), white noise of 0.1 % and 1.5 %. */
static void simulate(const char *cause, uint64_t seed, struct data *d)
{
    struct pool pool;
    struct message_list messages;
    struct job job;
    struct rotor_model client;
    struct prediction p;
    struct random_stream stream = {seed};
    int failed;
    text[0] = 0;
    append("%s%s", model, cause ? cause : "");
    for (int s = 0; s < SENSORS; s++)
        d->z[s] = LENGTH * (s + 0.2) / (SENSORS - 0.6);
    append_sensors(d, 0, 1, SENSORS);
    (void)folder_write("deck.inp", text);
    pool_open(&pool, NULL);
    assert_status(read_deck(&pool, &messages, &job), ROTID_OK);
    assert_status(model_open(&pool, NULL, &job.rotor, 0, NULL, 4, &client, &failed),
                  ROTID_OK); /* finer than the deck's own mesh */
    int count = client.equations.nrigid + MODES + 1;
    assert_status(prediction_new(&pool, &client.equations, ROTID_REDUCTION_NONE, ROTID_NELSON, count, 0, &p), ROTID_OK);
    assert_status(prediction_compute(&p, NULL), ROTID_OK);
    for (int k = 0; k <= MODES; k++) {
        int pair = client.equations.nrigid + k;
        double largest = 0;
        d->hz[k] = prediction_hz(&p, pair) * (1 + 0.001 * random_normal(&stream));
        for (int s = 0; s < SENSORS; s++)
            largest = fmax(largest, fabs(prediction_at_sensor(&p, pair, s)));
        for (int s = 0; s < SENSORS; s++)
            d->shape[s + k * SENSORS] = prediction_at_sensor(&p, pair, s) / largest + 0.015 * random_normal(&stream);
    }
    pool_close(&pool);
}

/* Measured mode `number` is mode `k` of the data. Sensors from, from + step, ... below to; step 0: no shape. */
static void append_shape(const struct data *d, int number, int k, int from, int step, int to)
{
    append("*SHAPE, MODE=%d\n", number);
    for (int s = from; s < to; s += step)
        append("%d, %.9g\n", s + 1, d->shape[s + k * SENSORS]);
}

static void append_data(const struct data *d, int nmode, int from, int step, int to, double factor)
{
    if (step)
        append_sensors(d, from, step, to);
    append("*MODES\n");
    for (int k = 0; k < nmode; k++)
        append("%d, %.9g\n", k + 1, d->hz[k] * factor);
    for (int k = 0; k < nmode && step; k++)
        append_shape(d, k + 1, k, from, step, to);
}

static void usual_deck(const struct data *d)
{
    text[0] = 0;
    append("%s%s%s", model, identify, noise_card);
    append_data(d, MODES, 0, 1, SENSORS, 1);
    (void)folder_write("deck.inp", text);
}

static const char gradient[] = "*CAUSE, NAME=hidden, TYPE=stiffness_gradient, GROUP=core\nslope, 0.3\n";

/* ---- one diagnosis of what stands in the deck ---- */

struct run {
    struct pool pool;
    struct message_list messages, notes;
    struct job job;
    struct diagnosis d;
    int status;
};

static void read_run(struct run *r)
{
    pool_open(&r->pool, NULL);
    assert_status(read_deck(&r->pool, &r->messages, &r->job), ROTID_OK);
}

static void run_with(struct run *r, int threads)
{
    const struct diagnose_options options = {.threads = threads};
    read_run(r);
    message_open(&r->notes, &r->pool);
    r->status = diagnose_run(&r->pool, &r->job, &options, NULL, &r->notes, &r->d);
}

static void close_run(struct run *r)
{
    if (!r->status)
        diagnose_free(&r->d);
    pool_close(&r->pool);
}

static int says(const struct run *r, const char *words)
{
    for (size_t i = 0; i < r->notes.count; i++)
        if (strstr(r->notes.item[i].text, words))
            return 1;
    return 0;
}

static const rotid_data_finding *found(const struct run *r, const char *id)
{
    for (int i = 0; i < r->d.result.ndata_findings; i++)
        if (!strcmp(r->d.result.data_findings[i].id, id))
            return &r->d.result.data_findings[i];
    return NULL;
}

static void print_verdict(const struct run *r)
{
    print_error("%s: %s\n", rotid_verdict_name(r->d.result.verdict.kind), r->d.result.verdict.sentence);
    for (size_t i = 0; i < r->notes.count; i++)
        print_error("note: %s\n", r->notes.item[i].text);
    for (int i = 0; i < r->d.result.ndata_findings; i++)
        print_error("finding: %s\n", r->d.result.data_findings[i].text);
}

/* Done, with a sentence, and no other name than the truth (NULL: nothing is wrong, or nothing that could be named). */
static void assert_honest(const struct run *r, const char *truth)
{
    assert_status(r->status, ROTID_OK);
    assert_false(r->d.result.interrupted);
    assert_non_null(r->d.result.verdict.sentence);
    int right = 1;
    for (int c = 0; c < r->d.ncause; c++)
        right = right && truth && !strcmp(r->d.cause[c].cause->id, truth);
    if (!right || (r->d.result.verdict.kind == ROTID_NAMED && !r->d.ncause))
        print_verdict(r);
    assert_true(right);
    if (r->d.result.verdict.kind == ROTID_AMBIGUOUS ||
        r->d.result.verdict.kind == ROTID_UNEXPLAINED) /* open: what would settle it is said */
        assert_non_null(r->d.result.verdict.next_measurement);
    assert_true((r->d.result.verdict.kind == ROTID_NAMED) == (r->d.ncause > 0));
}

/* ---- what it does with good data ---- */

UNIT_TEST(nothing_hidden_is_adequate)
{
    struct data d;
    struct run r;
    simulate(NULL, 1, &d);
    usual_deck(&d);
    run_with(&r, 1);
    assert_honest(&r, NULL);
    if (r.d.result.verdict.kind != ROTID_ADEQUATE)
        print_verdict(&r);
    assert_int_equal(r.d.result.verdict.kind, ROTID_ADEQUATE);
    assert_true(r.d.result.verdict.adequate_after && r.d.nround == 1 && !r.d.extended.fit);
    assert_true(isfinite(r.d.result.gain.chi2_per_dof.before) && isnan(r.d.result.gain.chi2_per_dof.after));
    assert_true(r.d.result.ndetectable > 5);
    close_run(&r);
}

UNIT_TEST(what_is_hidden_is_named_and_measured)
{
    struct data d;
    struct run r;
    simulate(gradient, 2, &d);
    usual_deck(&d);
    run_with(&r, 2);
    assert_honest(&r, "stiffness_gradient");
    if (r.d.result.verdict.kind != ROTID_NAMED)
        print_verdict(&r);
    assert_int_equal(r.d.result.verdict.kind, ROTID_NAMED);
    assert_int_equal(r.d.ncause, 1);
    const struct candidate *c = &r.d.cause[0];
    assert_string_equal(c->target, "core");
    assert_true(c->ci_lower[0] < 0.3 && 0.3 < c->ci_upper[0]);
    assert_close(c->effect.value[0], 0.3, 0, 0.1);
    assert_true(r.d.result.verdict.adequate_after && r.d.result.verdict.p_value < 0.01);
    assert_true(r.d.result.gain.chi2_per_dof.after < r.d.result.gain.chi2_per_dof.before);
    assert_true(r.d.result.gain.frequency_rms_percent.after < r.d.result.gain.frequency_rms_percent.before);
    assert_true(r.d.result.gain.mode_out_frequency_rms_percent.after < r.d.result.gain.mode_out_frequency_rms_percent.before);
    assert_true(r.d.result.gain.sensor_out_shape_rms.after < r.d.result.gain.sensor_out_shape_rms.before);
    assert_int_equal(r.d.extended_job.rotor.neffect, 1);
    assert_int_equal(r.d.extended_job.unknowns.nparameter, 3);
    assert_close(r.d.extended_job.rotor.effect[0].value[0], r.d.extended.fit->x[2], 0, 0);
    close_run(&r);
}

/* ---- threads ---- */

static void same(const double *a, const double *b, size_t count, const char *what)
{
    for (size_t i = 0; i < count; i++)
        if (memcmp(&a[i], &b[i], sizeof *a) != 0 && !(isnan(a[i]) && isnan(b[i]))) {
            print_error("%s [%zu]: %.17g with one thread, %.17g with more\n", what, i, a[i], b[i]);
            fail();
        }
}
#define SAME(member, count)       same(&a->member, &b->member, (size_t)(count), #member)
#define SAME_ARRAY(member, count) same(a->member, b->member, (size_t)(count), #member)

static void both_say(const char *a, const char *b)
{
    assert_int_equal(a == NULL, b == NULL);
    if (a)
        assert_string_equal(a, b);
}

static void same_candidate(const struct candidate *a, const struct candidate *b)
{
    assert_ptr_equal(a->cause, b->cause);
    both_say(a->effect.name, b->effect.name);
    both_say(a->target, b->target);
    SAME_ARRAY(effect.value, EFFECT_MOST_PARAMETERS);
    SAME_ARRAY(std, EFFECT_MOST_PARAMETERS);
    SAME_ARRAY(ci_lower, EFFECT_MOST_PARAMETERS);
    SAME_ARRAY(ci_upper, EFFECT_MOST_PARAMETERS);
    SAME(result.predicted_drop, 1);
    SAME(result.chi2, 1);
    SAME(result.chi2_drop, 1);
    SAME(result.chi2_frequency, 1);
    SAME(result.holdout_rms, 1);
    SAME(result.sensor_out_rms, 1);
    SAME(result.probability, 1);
    assert_true(a->result.refitted == b->result.refitted && a->result.at_bound == b->result.at_bound &&
                a->nparameter == b->nparameter);
}

static void same_fit(const rotid_fit_result *a, const rotid_fit_result *b)
{
    assert_int_equal(a == NULL, b == NULL);
    if (!a)
        return;
    assert_true(a->n == b->n && a->nresidual == b->nresidual && a->iterations == b->iterations && a->status == b->status);
    SAME(objective, 1);
    SAME(chi2, 1);
    SAME_ARRAY(x, a->n);
    SAME_ARRAY(ci_lower, a->n);
    SAME_ARRAY(ci_upper, a->n);
    SAME_ARRAY(predicted_hz, a->m);
    SAME_ARRAY(r, a->nresidual);
}

static void same_diagnosis(const struct diagnosis *a, const struct diagnosis *b)
{
    assert_int_equal(a->result.verdict.kind, b->result.verdict.kind);
    both_say(a->result.verdict.sentence, b->result.verdict.sentence);
    both_say(a->result.verdict.next_measurement, b->result.verdict.next_measurement);
    assert_true(a->nround == b->nround && a->ncause == b->ncause && a->nalternative == b->nalternative);
    assert_true(a->result.ndata_findings == b->result.ndata_findings &&
                a->result.nnumerical_findings == b->result.nnumerical_findings);
    assert_true(a->result.verdict.adequate_after == b->result.verdict.adequate_after &&
                a->result.ndetectable == b->result.ndetectable && a->result.nlocalisation == b->result.nlocalisation);
    SAME(result.verdict.p_value, 1);
    same_fit(a->today.fit, b->today.fit);
    same_fit(a->base.fit, b->base.fit);
    same_fit(a->extended.fit, b->extended.fit);
    same(&a->result.gain.frequency_rms_percent.before, &b->result.gain.frequency_rms_percent.before,
         offsetof(rotid_gain, nparameters) / sizeof(double), "gain");
    SAME_ARRAY(result.modes_standardised, a->result.nmodes_standardised);
    for (int i = 0; i < a->result.nsensors; i++)
        SAME(result.sensors[i].rms, 1);
    for (int i = 0; i < a->result.nlocalisation; i++) {
        SAME(result.localisation[i].z_m, 1);
        SAME(result.localisation[i].indicator, 1);
    }
    for (int i = 0; i < a->result.ndata_findings; i++)
        both_say(a->result.data_findings[i].text, b->result.data_findings[i].text);
    for (int i = 0; i < a->result.nnumerical_findings; i++)
        both_say(a->result.numerical_findings[i].text, b->result.numerical_findings[i].text);
    for (int r = 0; r < a->nround; r++) {
        SAME(round[r].result.chi2, 1);
        SAME(round[r].result.chi2_frequency, 1);
        SAME(round[r].result.largest, 1);
        SAME(round[r].result.p_frequency, 1);
        SAME(round[r].result.p_total, 1);
        assert_int_equal(a->round[r].ncandidate, b->round[r].ncandidate);
        for (int i = 0; i < a->round[r].ncandidate; i++)
            same_candidate(&a->round[r].candidate[i], &b->round[r].candidate[i]);
    }
    for (int i = 0; i < a->ncause; i++)
        same_candidate(&a->cause[i], &b->cause[i]);
    for (int i = 0; i < a->nalternative; i++)
        same_candidate(&a->alternative[i], &b->alternative[i]);
    for (int i = 0; i < a->result.ndetectable; i++) {
        SAME(result.detectable[i].smallest, 1);
        SAME(result.detectable[i].worst, 1);
        SAME(result.detectable[i].z_m, 1);
        assert_int_equal(a->result.detectable[i].beyond, b->result.detectable[i].beyond);
    }
}

static const char soft_zone[] = "*CAUSE, NAME=hidden, TYPE=stiffness_local\ndepth, 0.35\nz, 0.9\nwidth, 0.05\n";

UNIT_TEST(the_same_diagnosis_for_any_number_of_threads)
{
    static const char *const hidden[] = {gradient, soft_zone};
    for (int h = 0; h < 2; h++) {
        struct data d;
        struct run one, more;
        simulate(hidden[h], 2, &d);
        for (int k = 0; k < MODES && !h; k++)
            d.shape[6 + k * SENSORS] *= -1; /* a fault to take out on the way */
        usual_deck(&d);
        run_with(&one, 1);
        assert_status(one.status, ROTID_OK);
        for (int threads = 2; threads < 4 - h; threads++) {
            run_with(&more, threads);
            assert_status(more.status, ROTID_OK);
            same_diagnosis(&one.d, &more.d);
            close_run(&more);
        }
        close_run(&one);
    }
}

/* ---- interrupted, out of memory ---- */

#define MOST_STAGES 64

struct host {
    long polls, until;         /* cancels at this poll; 0: never */
    int nstage, stop_at_stage; /* cancels from this stage on; -1: never */
    char stage[MOST_STAGES][64];
};

static int cancelled(void *context)
{
    struct host *host = context;
    host->polls++;
    return (host->until && host->polls >= host->until) || (host->stop_at_stage >= 0 && host->nstage > host->stop_at_stage);
}

static void progress(void *context, const char *stage, int step)
{
    struct host *host = context;
    char name[64];
    (void)snprintf(name, sizeof name, "%s %d", stage, step);
    for (int i = 0; i < host->nstage; i++)
        if (!strcmp(host->stage[i], name))
            return;
    if (host->nstage < MOST_STAGES)
        memcpy(host->stage[host->nstage++], name, sizeof name);
}

/* One thread, all memory by the allocator, which is asked afterwards. Returns the status. */
static int run_in(const struct job *job, struct failing_allocator *failing, struct host *host, int *interrupted)
{
    const rotid_environment environment = {.size = sizeof environment,
                                           .allocator = &failing->allocator,
                                           .cancelled = cancelled,
                                           .progress = progress,
                                           .context = host};
    const struct diagnose_options options = {.threads = 1};
    struct pool pool;
    struct message_list notes;
    struct diagnosis d;
    pool_open(&pool, &failing->allocator);
    message_open(&notes, &pool);
    int status = diagnose_run(&pool, job, &options, &environment, &notes, &d);
    if (interrupted)
        *interrupted = d.result.interrupted;
    diagnose_free(&d); /* harmless behind an error */
    pool_close(&pool);
    assert_int_equal(failing->in_use, 0);
    return status;
}

/* With a fault in the data and a cause to name, so that every step is passed through. */
static void open_long_run(struct run *r)
{
    struct data d;
    simulate(gradient, 2, &d);
    for (int k = 0; k < MODES; k++)
        d.shape[6 + k * SENSORS] *= -1;
    usual_deck(&d);
    read_run(r);
}

UNIT_TEST(interrupted_at_any_point)
{
    struct run r;
    struct failing_allocator failing;
    struct host whole = {.stop_at_stage = -1};
    int interrupted;
    open_long_run(&r);
    failing_allocator_open(&failing, 0);
    assert_status(run_in(&r.job, &failing, &whole, &interrupted), ROTID_OK);
    assert_false(interrupted);
    assert_true(whole.polls > 100 && whole.nstage > 5);
    for (int i = 0; i<7; i += SPARSE> 1 ? 2 : 1) {
        struct host host = {.stop_at_stage = -1, .until = 1 + (whole.polls - 1) * i / 6};
        failing_allocator_open(&failing, 0);
        assert_status(run_in(&r.job, &failing, &host, &interrupted), ROTID_OK);
        if (!interrupted)
            print_error("poll %ld of %ld does not interrupt\n", host.until, whole.polls);
        assert_true(interrupted);
    }
    for (int i = 0; i < whole.nstage; i += 1 + whole.nstage / (SPARSE > 1 ? 3 : 6)) {
        struct host host = {.stop_at_stage = i};
        failing_allocator_open(&failing, 0);
        assert_status(run_in(&r.job, &failing, &host, &interrupted), ROTID_OK);
        if (!interrupted)
            print_error("stage \"%s\" cannot be interrupted\n", whole.stage[i]);
        assert_true(interrupted);
    }
    pool_close(&r.pool);
}

UNIT_TEST(out_of_memory_at_any_point)
{
    struct run r;
    struct failing_allocator failing;
    struct host host = {.stop_at_stage = -1};
    struct random_stream stream = {3};
    open_long_run(&r);
    failing_allocator_open(&failing, 0);
    assert_status(run_in(&r.job, &failing, &host, NULL), ROTID_OK);
    long served = failing.served;
    for (int i = 0, last = 24 / SPARSE - 1; i <= last; i++) {
        long n = i < 4 ? i + 1 : i == last ? served : 1 + (long)((double)served * random_uniform(&stream));
        host = (struct host){.stop_at_stage = -1};
        failing_allocator_open(&failing, n);
        int status = run_in(&r.job, &failing, &host, NULL);
        if (status != ROTID_ERROR_MEMORY)
            print_error("allocation %ld of %ld: %s, last stage \"%s\"\n", n, served, rotid_status_name(status),
                        host.nstage ? host.stage[host.nstage - 1] : "");
        assert_status(status, ROTID_ERROR_MEMORY);
    }
    pool_close(&r.pool);
}

/* ---- data that cannot carry a name ---- */

UNIT_TEST(fewer_data_than_parameters)
{
    struct data d;
    struct run r;
    simulate(gradient, 2, &d);
    for (int nmode = 1; nmode <= 2; nmode++) {
        text[0] = 0;
        append("%s%s%s", model, identify, noise_card);
        append_data(&d, nmode, 0, 0, 0, 1);
        (void)folder_write("deck.inp", text);
        run_with(&r, 1);
        assert_status(r.status, ROTID_ERROR_ARGUMENT);
        assert_true(says(&r, "leave no degree of freedom to test the model"));
        close_run(&r);
    }
    text[0] = 0;
    append("%s%s%s", model, identify, noise_card);
    (void)folder_write("deck.inp", text);
    run_with(&r, 1);
    assert_status(r.status, ROTID_ERROR_ARGUMENT);
    assert_true(says(&r, "no measured modes"));
    close_run(&r);
}

UNIT_TEST(few_modes_carry_no_name)
{
    struct data d;
    struct run r;
    simulate(gradient, 2, &d);
    for (int nmode = 1; nmode <= 2; nmode++) {
        text[0] = 0;
        append("%s%s%s", model, identify, noise_card);
        append_data(&d, nmode, 0, 1, SENSORS, 1);
        (void)folder_write("deck.inp", text);
        run_with(&r, 1);
        assert_honest(&r, NULL);
        assert_true(says(&r, "too few to name a cause"));
        close_run(&r);
    }
}

UNIT_TEST(frequencies_alone)
{
    static const char *const hidden[] = {gradient, soft_zone};
    static const char *const truth[] = {"stiffness_gradient", "stiffness_local"};
    for (int h = 0; h < 2; h++) {
        struct data d;
        struct run r;
        simulate(hidden[h], 4, &d);
        text[0] = 0;
        append("%s%s%s", model, identify, noise_card);
        append_data(&d, MODES, 0, 0, 0, 1);
        (void)folder_write("deck.inp", text);
        run_with(&r, 1);
        assert_honest(&r, truth[h]);
        close_run(&r);
    }
}

UNIT_TEST(sensors_at_one_end)
{
    struct data d;
    struct run r;
    simulate(gradient, 2, &d);
    text[0] = 0;
    append("%s%s%s", model, identify, noise_card);
    append_data(&d, MODES, 0, 1, 5, 1);
    (void)folder_write("deck.inp", text);
    run_with(&r, 1);
    assert_honest(&r, "stiffness_gradient");
    assert_true(says(&r, "the sensors cover"));
    close_run(&r);
}

UNIT_TEST(two_sensors)
{
    static const char *const hidden[] = {gradient, soft_zone, NULL};
    static const char *const truth[] = {"stiffness_gradient", "stiffness_local", NULL};
    for (int h = 0; h < 3; h++) {
        struct data d;
        struct run r;
        simulate(hidden[h], 3, &d);
        text[0] = 0;
        append("%s%s%s", model, identify, noise_card);
        append_data(&d, MODES, 0, SENSORS - 1, SENSORS, 1);
        (void)folder_write("deck.inp", text);
        run_with(&r, 1);
        assert_honest(&r, truth[h]);
        close_run(&r);
    }
}

UNIT_TEST(noise_not_stated_or_zero)
{
    struct data d;
    struct run r;
    simulate(gradient, 2, &d);
    text[0] = 0;
    append("%s%s", model, identify);
    append_data(&d, MODES, 0, 1, SENSORS, 1);
    (void)folder_write("deck.inp", text);
    run_with(&r, 1);
    assert_honest(&r, NULL); /* relative statements only: nothing is named */
    assert_true(r.d.result.noise.frequency_assumed);
    assert_true(says(&r, "the deck states no noise"));
    close_run(&r);
    text[0] = 0;
    append("%s%s*NOISE, FREQUENCY=0, SHAPE=0\n", model, identify);
    append_data(&d, MODES, 0, 1, SENSORS, 1);
    (void)folder_write("deck.inp", text);
    struct pool pool;
    struct message_list messages;
    struct job job;
    pool_open(&pool, NULL);
    message_open(&messages, &pool);
    assert_status(deck_read(&pool, folder_path("deck.inp"), 0, NULL, &messages, &job), ROTID_ERROR_SYNTAX);
    assert_true(messages.count > 0);
    pool_close(&pool);
}

UNIT_TEST(frequencies_in_another_unit)
{
    struct data d;
    struct run r;
    simulate(gradient, 2, &d);
    for (int i = 0; i < 4; i++) {
        text[0] = 0;
        append("%s%s%s", model, identify, noise_card);
        append_data(&d, MODES, 0, i % 2, SENSORS, i < 2 ? 6.283185307 : 1e-3);
        (void)folder_write("deck.inp", text);
        run_with(&r, 1);
        assert_status(r.status, ROTID_ERROR_ARGUMENT);
        assert_true(says(&r, i < 2 ? "rad/s" : "kHz"));
        close_run(&r);
    }
}

/* Two frequencies exchanged: the deck says so. */
UNIT_TEST(frequencies_in_the_wrong_order)
{
    struct data d;
    struct pool pool;
    struct message_list messages;
    struct job job;
    simulate(NULL, 1, &d);
    text[0] = 0;
    append("%s%s%s*MODES\n1, %.9g\n2, %.9g\n3, %.9g\n", model, identify, noise_card, d.hz[0], d.hz[2], d.hz[1]);
    (void)folder_write("deck.inp", text);
    pool_open(&pool, NULL);
    message_open(&messages, &pool);
    assert_status(deck_read(&pool, folder_path("deck.inp"), 0, NULL, &messages, &job), ROTID_ERROR_SYNTAX);
    assert_int_equal(messages.count, 1);
    assert_non_null(strstr(messages.item[0].text, "rise"));
    pool_close(&pool);
}

/* Mode 2 was missed and the others are counted through. Shapes say which they are. */
UNIT_TEST(a_mode_missing_from_the_count)
{
    static const int order[MODES] = {0, 2, 3, 4, 5};
    struct data d;
    struct run r;
    for (int shapes = 0; shapes < 2; shapes++) {
        simulate(NULL, 1, &d);
        text[0] = 0;
        append("%s%s%s", model, identify, noise_card);
        if (shapes)
            append_sensors(&d, 0, 1, SENSORS);
        append("*MODES\n");
        for (int k = 0; k < MODES; k++)
            append("%d, %.9g\n", k + 1, d.hz[order[k]]);
        for (int k = 0; k < MODES && shapes; k++)
            append_shape(&d, k + 1, order[k], 0, 1, SENSORS);
        (void)folder_write("deck.inp", text);
        run_with(&r, 1);
        if (r.status == ROTID_ERROR_ARGUMENT) { /* a clear refusal will do where only frequencies are there */
            assert_true(!shapes && r.notes.count > 0);
            close_run(&r);
            continue;
        }
        assert_honest(&r, NULL);
        if (shapes) {
            assert_non_null(found(&r, "mode_pairing"));
            if (r.d.result.verdict.kind != ROTID_ADEQUATE)
                print_verdict(&r);
            assert_int_equal(r.d.result.verdict.kind, ROTID_ADEQUATE); /* once they are paired rightly nothing is wrong */
        }
        close_run(&r);
    }
}

UNIT_TEST(a_mode_measured_twice)
{
    static const int order[MODES + 1] = {0, 1, 2, 2, 3, 4};
    struct data d;
    struct run r;
    struct random_stream stream = {8};
    simulate(NULL, 1, &d);
    text[0] = 0;
    append("%s%s%s", model, identify, noise_card);
    append_sensors(&d, 0, 1, SENSORS);
    append("*MODES\n");
    for (int k = 0; k <= MODES; k++)
        append("%d, %.9g\n", k + 1, d.hz[order[k]] * (k == 3 ? 1.006 : 1));
    for (int k = 0; k <= MODES; k++) {
        for (int s = 0; s < SENSORS && k == 3; s++)
            d.shape[s + 2 * SENSORS] += 0.01 * random_normal(&stream);
        append_shape(&d, k + 1, order[k], 0, 1, SENSORS);
    }
    (void)folder_write("deck.inp", text);
    run_with(&r, 1);
    assert_honest(&r, NULL);
    assert_non_null(found(&r, "mode_pairing"));
    assert_int_equal(r.d.job.measurement.nmode, MODES);
    if (r.d.result.verdict.kind != ROTID_ADEQUATE)
        print_verdict(&r);
    assert_int_equal(r.d.result.verdict.kind, ROTID_ADEQUATE);
    close_run(&r);
}

UNIT_TEST(nothing_to_identify)
{
    struct data d;
    struct run r;
    simulate(gradient, 2, &d);
    text[0] = 0;
    append("%s%s", model, noise_card);
    append_data(&d, MODES, 0, 1, SENSORS, 1);
    (void)folder_write("deck.inp", text);
    run_with(&r, 1);
    assert_honest(&r, "stiffness_gradient");
    assert_int_equal(r.d.base.fit->n, 0);
    assert_false(r.d.today.fit);
    close_run(&r);
}

TEST_GROUP(folder_make, folder_remove);
