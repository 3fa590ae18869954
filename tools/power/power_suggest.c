/* What becomes of the promises of `rotid suggest`: the first of its tests that can be simulated and the same test again are made,
 * of the true structure, and judged as the suggestion says they will be. */
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/parallel.h"
#include "deck/deck.h"
#include "power.h"
#include "suggest/joint_fit.h"
#include "suggest/margin.h"
#include "suggest/suggest.h"
#include "support.h"

#define MOST_TRUTHS 8

enum made { MADE_AGAIN, MADE_FIRST, MADE }; /* the same test again, the first of those that were proposed */

struct promise {
    int cases, right, wrong, open; /* cases in which the true cause is among the rivals */
    double promised, promised_wrong;
};

struct promises {
    const struct power_options *options;
    const volatile sig_atomic_t *interrupted;
    char directory[500];
    pthread_mutex_t lock;
    int ambiguous, missing; /* with tests; of these without the true cause among the rivals */
    struct promise promise[MADE];
};

/* The case of a request as a job; its texts are to be freed. */
static int read_case(struct pool *pool, const struct hide_request *request, const char *directory, int number, struct job *job,
                     char **truth)
{
    struct message_list messages;
    char message[300], *deck, path[600];
    if (hide_case(request, &deck, truth, message, sizeof message))
        return ROTID_ERROR_ARGUMENT;
    snprintf(path, sizeof path, "%s/suggest_%d.inp", directory, number);
    FILE *file = fopen(path, "w");
    int bad = !file || fputs(deck, file) < 0;
    if (file)
        bad |= fclose(file) != 0;
    free(deck);
    message_open(&messages, pool);
    int status = bad ? ROTID_ERROR_IO : deck_read(pool, path, 0, NULL, &messages, job);
    remove(path);
    if (status)
        free(*truth);
    return status;
}

/* The request of the test: the same structure, fresh noise. 0 where hide cannot make it. */
static int request_of(struct pool *pool, const struct test *test, const cJSON *truth, struct hide_request *r)
{
    const cJSON *parameters = cJSON_GetObjectItem(truth, "parameters"), *effects = cJSON_GetObjectItem(truth, "effects");
    const char **text = POOL_ARRAY(pool, const char *, MOST_TRUTHS), **spec = POOL_ARRAY(pool, const char *, 1);
    int count = cJSON_GetArraySize(parameters);
    for (int k = 0; k < test->modes; k++)
        if (test->number[k] != k + 1)
            return 0;
    if (!text || !spec || count > MOST_TRUTHS || cJSON_GetArraySize(effects) != 1 || test->modes > HIDE_MOST_MODES)
        return 0;
    for (int i = 0; i < count; i++) {
        const cJSON *p = cJSON_GetArrayItem(parameters, i);
        text[i] = pool_format(pool, "%s=%.17g", cJSON_GetStringValue(cJSON_GetObjectItem(p, "name")),
                              cJSON_GetNumberValue(cJSON_GetObjectItem(p, "value")));
    }
    spec[0] = cJSON_GetStringValue(cJSON_GetObjectItem(cJSON_GetArrayItem(effects, 0), "spec"));
    r->truths = count;
    r->truth = text;
    r->effects = 1;
    r->effect = spec;
    r->random = NULL;
    r->seed += 500000;
    r->modes = test->modes;
    if (test->kind == TEST_NOISE)
        r->shape_noise /= 2;
    if (test->kind == TEST_MASS)
        r->deck = pool_format(pool, "%s\n*DISK\n%.17g, %.17g\n", r->deck, test->z, test->mass);
    return test->kind == TEST_AGAIN || test->kind == TEST_MODES || test->kind == TEST_NOISE || test->kind == TEST_MASS;
}

/* Which rival is named by both tests together, -1: none. -2: the test could not be made. */
static int named_by(struct pool *pool, const struct suggestion *s, const struct test *test,
                    const struct job_measurement *measured)
{
    int n = s->rivals.n, named = -1;
    double *score = POOL_ARRAY(pool, double, n), *lead = POOL_ARRAY(pool, double, n);
    for (int r = 0; r < n; r++) {
        const struct rival *rival = &s->rivals.rival[r];
        if (joint_chi2(pool, rival, test, measured, NULL, &score[r]))
            return -2;
        score[r] += rival->score - rival->fit->chi2;
    }
    for (int r = 0; r + 1 < n; r++) {
        for (int b = 0; b < n; b++)
            lead[b] = score[b] - score[r];
        if (margin_suffices(&s->rivals, r, lead))
            named = r;
    }
    return named;
}

static void make_test(struct promises *run, struct pool *pool, const struct power_case *c, const struct suggestion *s, int t,
                      int true_one, const cJSON *truth, enum made made)
{
    struct hide_request request = c->hidden.request;
    struct job second;
    char *unused;
    if (!request_of(pool, &s->test[t], truth, &request) ||
        read_case(pool, &request, run->directory, 2 * c->hidden.number + 1, &second, &unused))
        return;
    free(unused);
    int named = named_by(pool, s, &s->test[t], &second.measurement);
    if (named == -2)
        return;
    pthread_mutex_lock(&run->lock);
    struct promise *p = &run->promise[made];
    p->cases++;
    p->right += named == true_one;
    p->wrong += named >= 0 && named != true_one;
    p->open += named < 0;
    p->promised += s->result.tests[t].chance;
    p->promised_wrong += s->result.tests[t].wrong;
    pthread_mutex_unlock(&run->lock);
}

/* The first test of the ranking that hide can make. */
static int first_test(struct pool *pool, const struct suggestion *s, const cJSON *truth, const struct hide_request *request)
{
    for (int t = 0; t < s->result.ntests; t++) {
        struct hide_request r = *request;
        if (request_of(pool, &s->test[t], truth, &r))
            return t;
    }
    return -1;
}

static void follow(struct promises *run, struct pool *pool, const struct power_case *c, const struct suggestion *s,
                   const cJSON *truth)
{
    int true_one = -1, first = first_test(pool, s, truth, &c->hidden.request);
    for (int r = 0; r + 1 < s->rivals.n; r++)
        if (s->rivals.rival[r].ncause == 1 && hidden_which(&s->job, s->rivals.rival[r].cause, truth) == 0)
            true_one = r;
    pthread_mutex_lock(&run->lock);
    run->ambiguous++;
    run->missing += true_one < 0;
    pthread_mutex_unlock(&run->lock);
    for (int t = 0; t < s->result.ntests && true_one >= 0; t++) {
        if (s->test[t].kind == TEST_AGAIN)
            make_test(run, pool, c, s, t, true_one, truth, MADE_AGAIN);
        if (t == first)
            make_test(run, pool, c, s, t, true_one, truth, MADE_FIRST);
    }
}

static int run_case(void *context, int index, int worker)
{
    struct promises *run = context;
    const rotid_suggest_options options = {.size = sizeof options, .replicates = 300};
    struct power_case c;
    struct suggestion s;
    struct message_list notes;
    struct job job;
    struct pool pool;
    char *text;
    (void)worker;
    if (*run->interrupted)
        return ROTID_STOP_CANCELLED;
    if (power_draw(run->options, run->options->first + index, &c))
        return ROTID_ERROR_MEMORY;
    pool_open(&pool, NULL);
    message_open(&notes, &pool);
    if (!read_case(&pool, &c.hidden.request, run->directory, 2 * c.hidden.number, &job, &text)) {
        cJSON *truth = cJSON_Parse(text);
        if (truth && !suggest_run(&pool, &job, &options, NULL, &notes, &s)) {
            if (s.result.ntests)
                follow(run, &pool, &c, &s, truth);
            suggest_free(&s);
        }
        cJSON_Delete(truth);
        free(text);
    }
    pool_close(&pool);
    free(c.deck);
    return ROTID_OK;
}

int power_suggest(const struct power_options *options, const volatile sig_atomic_t *interrupted, FILE *out)
{
    static const char *const names[MADE] = {"the same test again", "the first of the tests"};
    const char *temporary = getenv("TMPDIR");
    struct power_options physical = *options;
    struct promises run = {.options = &physical, .interrupted = interrupted};
    physical.only = options->only ? options->only : "physical";
    snprintf(run.directory, sizeof run.directory, "%s/power.XXXXXX", temporary ? temporary : "/tmp");
    if (!mkdtemp(run.directory))
        return 3;
    pthread_mutex_init(&run.lock, NULL);
    int status = parallel_for(options->jobs, options->cases, run_case, &run);
    pthread_mutex_destroy(&run.lock);
    rmdir(run.directory);
    fprintf(out, "power --suggest --seed %llu: %d of %d ambiguous, %d of these without the true cause among the rivals\n",
            (unsigned long long)options->seed, run.ambiguous, options->cases, run.missing);
    fprintf(out, "%-24s cases  named right (promised)  wrong (promised)  open\n", "");
    for (int m = 0; m < MADE; m++) {
        const struct promise *p = &run.promise[m];
        fprintf(out, "%-24s %5d  %11d (%8.1f)  %5d (%8.1f)  %4d\n", names[m], p->cases, p->right, p->promised, p->wrong,
                p->promised_wrong, p->open);
    }
    return status && !*interrupted ? 3 : 0;
}
