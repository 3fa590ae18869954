/* What becomes of the promises of `rotid suggest`: the first of its tests and two blind choices are made, of the true structure,
 * and diagnosed together with what was measured before. */
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "base/base.h"
#include "deck/deck.h"
#include "one_state.h"
#include "power.h"
#include "suggest/suggest.h"

#define MOST_TRUTHS 8
#define REPLICATES  300

enum made { MADE_AGAIN, MADE_TWICE, MADE_FIRST, MADE };

static const char *const made_name[MADE] = {"same", "twice", "first"};
static const char *const made_text[MADE] = {"the same test again", "with twice the sensors", "the first of the tests"};

struct follow_up {
    char kind[20]; /* of the test; "": it was not made */
    double chance, wrong;
    enum hidden_outcome outcome;
    char said[400]; /* the sentence, for the log */
};

struct followed {
    int done, ambiguous, among; /* among: the true cause is one of the rivals */
    struct follow_up made[MADE];
};

struct promises {
    const struct power_options *options;
    const volatile sig_atomic_t *interrupted;
    pthread_mutex_t lock; /* of the log */
    FILE *log;
    struct followed *followed; /* [cases] */
};

/* ------------------------------------------------------------------------------------------------ one test */

static int read_states(struct pool *pool, const char *text, struct states *states)
{
    const struct deck_memory memory = {"case", strlen(text), text, NULL};
    struct message_list messages;
    message_open(&messages, pool);
    return deck_read_states(pool, "case", &memory, 0, NULL, &messages, states);
}

/* "core.E=1.1e11" of what is true, and the effect. Nonzero where there is not one effect, or too much else. */
static int take_truth(struct pool *pool, const cJSON *truth, struct hide_request *r)
{
    const cJSON *parameter, *effects = cJSON_GetObjectItem(truth, "effects");
    const char **text = POOL_ARRAY(pool, const char *, MOST_TRUTHS), **spec = POOL_ARRAY(pool, const char *, 1);
    r->truths = 0;
    if (!text || !spec || cJSON_GetArraySize(effects) != 1)
        return 1;
    cJSON_ArrayForEach(parameter, cJSON_GetObjectItem(truth, "parameters"))
    {
        if (r->truths == MOST_TRUTHS)
            return 1;
        text[r->truths++] = pool_format(pool, "%s=%.17g", cJSON_GetStringValue(cJSON_GetObjectItem(parameter, "name")),
                                        cJSON_GetNumberValue(cJSON_GetObjectItem(parameter, "value")));
    }
    spec[0] = cJSON_GetStringValue(cJSON_GetObjectItem(cJSON_GetArrayItem(effects, 0), "spec"));
    r->truth = text;
    r->effects = 1;
    r->effect = spec;
    r->random = NULL;
    return pool->out_of_memory;
}

/* The cards of the test with data behind them: from its *STATE card to the end of what hide writes of both states. NULL where
 * nobody can make the test. */
static const char *measure(struct pool *pool, const struct suggestion *s, const struct test *test, const cJSON *truth,
                           const struct hide_request *request)
{
    struct hide_request r = *request;
    char message[300], *cards, *deck, *unused;
    for (int k = 0; k < test->modes; k++)
        if (test->number[k] != k + 1)
            return NULL;
    if (test->modes > HIDE_MOST_MODES || take_truth(pool, truth, &r) ||
        deck_write_test(pool, &s->rivals.rival[s->rivals.n - 1].job, test, &cards))
        return NULL;
    r.seed += 500000;
    r.modes = test->modes;
    r.no_shapes = !test->nsensor;
    r.frequency_noise = test->frequency_std;
    r.shape_noise = test->nsensor ? test->shape_std : r.shape_noise;
    r.deck = pool_format(pool, "%s\n*STATE, NAME=measured\n%s", r.deck, cards);
    if (!r.deck || hide_case(&r, &deck, &unused, message, sizeof message))
        return NULL;
    const char *state = strstr(deck, "*STATE, NAME=measured");
    state = state ? strstr(state + 1, "*STATE") : NULL;
    char *text = state ? pool_copy_text(pool, state) : NULL;
    free(deck);
    free(unused);
    return text;
}

/* The verdict of both states together. deck: of the first */
static int judge(struct promises *run, const char *deck, const char *state, const cJSON *truth, struct follow_up *made)
{
    const struct diagnose_options options = {.threads = 1};
    const rotid_environment environment = {
        .size = sizeof environment, .cancelled = power_interrupted, .context = (void *)run->interrupted};
    struct message_list messages;
    struct states states;
    struct diagnosis d;
    struct pool pool;
    char *text = NULL;
    pool_open(&pool, NULL);
    message_open(&messages, &pool);
    const struct deck_file file = {"case", deck};
    const struct deck_origin origin = {.path = "case", .memory = 1, .nfile = 1, .file = &file};
    int status = deck_add_state(&pool, &origin, NULL, state, &text);
    if (!status)
        status = read_states(&pool, text, &states);
    if (!status)
        status = diagnose_states(&pool, &states, &options, &environment, &messages, &d);
    int interrupted = status == ROTID_STOP_CANCELLED || (!status && d.result.interrupted);
    made->outcome = HIDDEN_FAILED;
    if (!status && !interrupted) {
        made->outcome = hidden_outcome_of(&d, truth);
        (void)snprintf(made->said, sizeof made->said, "%s", d.result.verdict.sentence);
    }
    for (size_t i = 0; i < messages.count && status; i++)
        if (messages.item[i].severity == SEVERITY_ERROR)
            (void)snprintf(made->said, sizeof made->said, "%s", messages.item[i].text);
    if (!status)
        diagnose_free(&d);
    pool_close(&pool);
    return interrupted ? ROTID_STOP_CANCELLED : ROTID_OK;
}

static int make_test(struct promises *run, struct pool *pool, const struct suggestion *s, const struct test *test, double chance,
                     double wrong, const char *deck, const cJSON *truth, const struct hide_request *request,
                     struct follow_up *made)
{
    const char *state = measure(pool, s, test, truth, request);
    if (!state)
        return ROTID_OK;
    made->chance = chance;
    made->wrong = wrong;
    (void)snprintf(made->kind, sizeof made->kind, "%s", test_id(test->kind));
    return judge(run, deck, state, truth, made);
}

/* ------------------------------------------------------------------------------------------------ one case */

/* The same test with one sensor more between any two. */
static struct test twice(struct pool *pool, const struct test *again)
{
    struct test t = *again;
    double *z = POOL_ARRAY(pool, double, 2 * t.nsensor);
    t.kind = TEST_SENSORS;
    t.nsensor = t.nsensor ? 2 * t.nsensor - 1 : 0;
    for (int i = 0; i < t.nsensor && z; i++)
        z[i] = i % 2 ? (again->sensor[i / 2] + again->sensor[i / 2 + 1]) / 2 : again->sensor[i / 2];
    t.sensor = z;
    return t;
}

static int follow(struct promises *run, struct pool *pool, const struct suggestion *s, const char *deck, const cJSON *truth,
                  const struct hide_request *request, struct followed *f)
{
    const rotid_suggestion *r = &s->result;
    int status = ROTID_OK;
    f->ambiguous = 1;
    for (int i = 0; i + 1 < s->rivals.n; i++)
        f->among |= s->rivals.rival[i].ncause == 1 && hidden_which(&s->job, s->rivals.rival[i].cause, truth) == 0;
    for (int t = 0; t < r->ntests && !status && !f->made[MADE_FIRST].kind[0]; t++)
        status = make_test(run, pool, s, &s->test[t], r->tests[t].chance, r->tests[t].wrong, deck, truth, request,
                           &f->made[MADE_FIRST]);
    for (int t = 0; t < r->ntests && !status; t++) {
        if (s->test[t].kind != TEST_AGAIN)
            continue;
        const struct test more = twice(pool, &s->test[t]);
        status = make_test(run, pool, s, &s->test[t], r->tests[t].chance, r->tests[t].wrong, deck, truth, request,
                           &f->made[MADE_AGAIN]);
        if (!status && more.nsensor)
            status = make_test(run, pool, s, &more, NAN, NAN, deck, truth, request, &f->made[MADE_TWICE]);
    }
    return status;
}

static void write_line(struct promises *run, const struct power_case *c, const cJSON *truth, const struct followed *f)
{
    cJSON *line = cJSON_CreateObject();
    cJSON_AddNumberToObject(line, "case", c->hidden.number);
    cJSON_AddStringToObject(line, "again", c->again);
    if (truth)
        cJSON_AddItemToObject(line, "effects", cJSON_Duplicate(cJSON_GetObjectItem(truth, "effects"), 1));
    cJSON_AddBoolToObject(line, "ambiguous", f->ambiguous);
    cJSON_AddBoolToObject(line, "among", f->among);
    for (int m = 0; m < MADE && f->ambiguous; m++) {
        cJSON *made = cJSON_AddObjectToObject(line, made_name[m]);
        cJSON_AddStringToObject(made, "kind", f->made[m].kind);
        cJSON_AddStringToObject(made, "outcome", hidden_outcome_name(f->made[m].outcome));
        cJSON_AddStringToObject(made, "said", f->made[m].said);
        if (isfinite(f->made[m].chance)) {
            cJSON_AddNumberToObject(made, "chance", f->made[m].chance);
            cJSON_AddNumberToObject(made, "wrong", f->made[m].wrong);
        }
    }
    char *text = cJSON_PrintUnformatted(line);
    cJSON_Delete(line);
    pthread_mutex_lock(&run->lock);
    if (text && run->log) {
        fprintf(run->log, "%s\n", text);
        fflush(run->log);
    }
    pthread_mutex_unlock(&run->lock);
    free(text);
}

static const char *text_in(const cJSON *object, const char *name)
{
    const char *text = cJSON_GetStringValue(cJSON_GetObjectItem(object, name));
    return text ? text : "";
}

static int take_line(void *context, const cJSON *line)
{
    struct promises *run = context;
    const cJSON *number = cJSON_GetObjectItem(line, "case");
    int index = cJSON_IsNumber(number) ? number->valueint - run->options->first : -1;
    struct power_case c;
    if (!cJSON_IsNumber(number) || power_draw(run->options, number->valueint, &c))
        return 1;
    free(c.deck);
    if (strcmp(c.again, text_in(line, "again")) != 0)
        return 1;
    if (index < 0 || index >= run->options->cases)
        return 0;
    struct followed *f = &run->followed[index];
    *f = (struct followed){.done = 1,
                           .ambiguous = cJSON_IsTrue(cJSON_GetObjectItem(line, "ambiguous")),
                           .among = cJSON_IsTrue(cJSON_GetObjectItem(line, "among"))};
    for (int m = 0; m < MADE; m++) {
        const cJSON *made = cJSON_GetObjectItem(line, made_name[m]);
        struct follow_up *to = &f->made[m];
        (void)snprintf(to->kind, sizeof to->kind, "%s", text_in(made, "kind"));
        to->chance = cJSON_GetNumberValue(cJSON_GetObjectItem(made, "chance"));
        to->wrong = cJSON_GetNumberValue(cJSON_GetObjectItem(made, "wrong"));
        for (int o = 0; o < HIDDEN_OUTCOMES; o++)
            if (!strcmp(hidden_outcome_name((enum hidden_outcome)o), text_in(made, "outcome")))
                to->outcome = (enum hidden_outcome)o;
    }
    return 0;
}

static int run_case(void *context, int index, int worker)
{
    struct promises *run = context;
    const rotid_suggest_options options = {.size = sizeof options};
    const rotid_environment environment = {
        .size = sizeof environment, .cancelled = power_interrupted, .context = (void *)run->interrupted};
    struct followed *f = &run->followed[index];
    struct power_case c;
    struct suggestion s;
    struct message_list notes;
    struct states states;
    struct pool pool;
    char *deck, *text, message[300];
    int suggested = 0;
    (void)worker;
    if (f->done)
        return ROTID_OK;
    if (*run->interrupted)
        return ROTID_STOP_CANCELLED;
    if (power_draw(run->options, run->options->first + index, &c))
        return ROTID_ERROR_MEMORY;
    int status = hide_case(&c.hidden.request, &deck, &text, message, sizeof message);
    cJSON *truth = status ? NULL : cJSON_Parse(text);
    pool_open(&pool, NULL);
    message_open(&notes, &pool);
    if (truth && !read_states(&pool, deck, &states)) {
        status = suggest_run(&pool, &states.state->job, &options, &environment, &notes, &s);
        suggested = 1;
    }
    if (suggested && !status && s.result.ntests)
        status = follow(run, &pool, &s, deck, truth, &c.hidden.request, f);
    if (status != ROTID_STOP_CANCELLED) {
        f->done = 1;
        write_line(run, &c, truth, f);
    }
    if (suggested)
        suggest_free(&s);
    if (truth) {
        cJSON_Delete(truth);
        free(deck);
        free(text);
    }
    pool_close(&pool);
    free(c.deck);
    return status == ROTID_STOP_CANCELLED ? status : ROTID_OK;
}

/* ------------------------------------------------------------------------------------------------ the report */

static void report(FILE *out, const struct promises *run)
{
    int done = 0, ambiguous = 0, among = 0;
    for (int i = 0; i < run->options->cases; i++) {
        const struct followed *f = &run->followed[i];
        done += f->done;
        ambiguous += f->ambiguous;
        among += f->among;
    }
    fprintf(out, "power --suggest --seed %llu: of %d cases %d are ambiguous, of these %d with the true cause among the rivals\n",
            (unsigned long long)run->options->seed, done, ambiguous, among);
    fprintf(out, "%-24s cases  named  promised  wrong  promised | with the true one among the rivals: cases  named  promised\n",
            "");
    for (int m = 0; m < MADE; m++) {
        int count[2] = {0}, named[2] = {0}, wrong = 0;
        double promised[2] = {0}, promised_wrong = 0;
        for (int i = 0; i < run->options->cases; i++) {
            const struct followed *f = &run->followed[i];
            const struct follow_up *made = &f->made[m];
            if (!f->done || !made->kind[0] || made->outcome == HIDDEN_FAILED)
                continue;
            for (int a = 0; a <= f->among; a++) {
                count[a]++;
                named[a] += made->outcome == HIDDEN_RIGHT;
                promised[a] += isfinite(made->chance) ? made->chance : 0;
            }
            wrong += made->outcome == HIDDEN_WRONG;
            promised_wrong += isfinite(made->wrong) ? made->wrong : 0;
        }
        fprintf(out, "%-24s %5d  %5d  %8.1f  %5d  %8.1f | %41d  %5d  %8.1f\n", made_text[m], count[0], named[0], promised[0],
                wrong, promised_wrong, count[1], named[1], promised[1]);
    }
}

int power_suggest(const struct power_options *options, const volatile sig_atomic_t *interrupted, FILE *out)
{
    struct power_options physical = *options;
    struct promises run = {
        .options = &physical, .interrupted = interrupted, .followed = calloc((size_t)options->cases, sizeof *run.followed)};
    physical.only = options->only ? options->only : "physical";
    run.log = options->log && run.followed ? power_lines(options->log, take_line, &run) : NULL;
    if (!run.followed || (options->log && !run.log)) {
        free(run.followed);
        return 3;
    }
    pthread_mutex_init(&run.lock, NULL);
    int status = parallel_for(options->jobs, options->cases, run_case, &run);
    pthread_mutex_destroy(&run.lock);
    report(out, &run);
    int bad = run.log && fclose(run.log);
    free(run.followed);
    return (status && !*interrupted) || bad ? 3 : 0;
}
