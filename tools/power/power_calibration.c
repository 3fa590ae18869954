/* Self-consistency: whether the leading explanation is true as often as its probability says, where rotor and data are drawn from
 * the priors. It is true where it has the same causes at the same targets, channels and free numbers, and something else or not:
 * places are integrated over, and two names that no data tell apart share their probability as their priors say. */
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "base/base.h"
#include "deck/deck.h"
#include "power.h"

#define BINS   10
#define TIMES  0.95 /* that all bands hold */
#define LITTLE 1e-12

/* ---- bands */

/* Probability that a count of pmf [n + 1] lies between its quantiles of level/2 on either side. */
static double inside(int n, const double *pmf, double level, int *low, int *high)
{
    double below = 0, above = 0, sum = 0;
    for (*low = 0; *low < n && below + pmf[*low] <= level / 2; (*low)++)
        below += pmf[*low];
    for (*high = n; *high > *low && above + pmf[*high] <= level / 2; (*high)--)
        above += pmf[*high];
    for (int k = *low; k <= *high; k++)
        sum += pmf[k];
    return fmin(sum, 1);
}

int power_bands(FILE *out, int count, const double *probability, const int *right)
{
    int n[BINS] = {0}, found[BINS] = {0}, low, high, outside = 0;
    double sum[BINS] = {0}, *pmf[BINS], least = 0, most = 1, score = 0, expected = 0, variance = 0;
    double *room = calloc((size_t)(count + 1) * BINS, sizeof *room);
    if (!room)
        return 3;
    for (int b = 0; b < BINS; b++)
        (pmf[b] = room + (ptrdiff_t)b * (count + 1))[0] = 1;
    for (int i = 0; i < count; i++) {
        double p = fmin(fmax(probability[i], LITTLE), 1 - LITTLE), odds = log(p / (1 - p));
        int b = (int)fmin(BINS * p, BINS - 1);
        n[b]++;
        found[b] += right[i];
        sum[b] += p;
        for (int k = n[b]; k >= 0; k--) /* Poisson-binomial */
            pmf[b][k] = (1 - p) * pmf[b][k] + (k ? p * pmf[b][k - 1] : 0);
        score += log(right[i] ? p : 1 - p) / count;
        expected += (p * log(p) + (1 - p) * log1p(-p)) / count;
        variance += p * (1 - p) * odds * odds / count / count;
    }
    for (int pass = 0; pass < 60; pass++) { /* largest level of one bin at which all hold */
        double level = (least + most) / 2, all = 1;
        for (int b = 0; b < BINS; b++)
            all *= inside(n[b], pmf[b], level, &low, &high);
        *(all >= TIMES ? &least : &most) = level;
    }
    fprintf(out, "\nprobability   cases  stated  right  simultaneous 95 %% band\n");
    for (int b = 0; b < BINS; b++) {
        (void)inside(n[b], pmf[b], least, &low, &high);
        if (!n[b])
            continue;
        int misses = found[b] < low || found[b] > high;
        fprintf(out, "%.1f to %.1f  %7d  %6.3f  %5.3f  %.3f to %.3f%s\n", (double)b / BINS, (b + 1.0) / BINS, n[b], sum[b] / n[b],
                (double)found[b] / n[b], (double)low / n[b], (double)high / n[b], misses ? "  OUTSIDE" : "");
        outside |= misses;
    }
    fprintf(out, "log score %.4f a case, expected %.4f +- %.4f; the bands %s\n", score, expected, sqrt(variance),
            outside ? "do not hold" : "hold");
    free(room);
    return outside;
}

/* ---- a case */

struct calibrated {
    int done, failed, right, draws;
    int intervals, held;          /* averaged 95 % intervals, and how many hold the true value */
    double probability, of_truth; /* of_truth: 0 where the truth is not in the list */
};

struct calibration {
    const struct power_options *options;
    const volatile sig_atomic_t *interrupted;
    struct calibrated *item; /* [cases] */
    pthread_mutex_t lock;    /* of the log */
    FILE *log;
};

static int same_cause(const struct candidate *a, const struct candidate *b)
{
    return a->cause == b->cause && !memcmp(a->sensor, b->sensor, sizeof a->sensor) &&
           !memcmp(a->fixed, b->fixed, sizeof a->fixed) && (a->cause->class == CAUSE_DATA || !strcmp(a->target, b->target));
}

static int same_set(const struct explanation *a, const struct explanation *b)
{
    int used = 0, same = a->nmember == b->nmember && a->something_else == b->something_else;
    for (int m = 0; m < a->nmember && same; m++) {
        int k = 0;
        while (k < b->nmember && (used & 1 << k || !same_cause(&a->member[m], &b->member[k])))
            k++;
        same = k < b->nmember;
        used |= 1 << k;
    }
    return same;
}

static cJSON *line_of(const struct explanation *e)
{
    cJSON *list = cJSON_CreateArray();
    for (int m = 0; m < e->nmember; m++) {
        const struct candidate *c = &e->member[m];
        cJSON *o = cJSON_CreateObject();
        cJSON_AddStringToObject(o, "id", c->cause->id);
        cJSON_AddStringToObject(o, "target", c->target);
        cJSON_AddItemToObject(o, "sensor", cJSON_CreateIntArray(c->sensor, 2));
        cJSON_AddItemToObject(o, "value", cJSON_CreateDoubleArray(c->effect.value, c->nparameter));
        cJSON_AddItemToArray(list, o);
    }
    if (e->something_else)
        cJSON_AddItemToArray(list, cJSON_CreateString("something else"));
    return list;
}

/* With the faults that were taken out of the data before the last search: the explanation is theirs and what was found then, its
 * probability the product. */
static double with_faults(const struct posterior *p, struct explanation *e)
{
    double probability = e->probability;
    for (int i = 0; i < p->nmarginal && e->nmember < MOST_MEMBERS; i++) {
        const struct marginal *fault = &p->marginal[i];
        int there = 0;
        if (fault->cause.cause->class != CAUSE_DATA || fault->probability < VERDICT_NAMED)
            break;
        for (int m = 0; m < e->nmember; m++)
            there |= same_cause(&e->member[m], &fault->cause);
        if (there)
            continue;
        e->member[e->nmember++] = fault->cause;
        probability *= fault->probability;
    }
    return probability;
}

/* Probability of each cause, at any target: summed over cases, as many as there are. */
static cJSON *kinds_of(const struct posterior *p)
{
    cJSON *list = cJSON_CreateObject();
    for (int k = -2; k < catalogue_count(); k++) {
        double sum = 0;
        for (int i = 0; i < p->count; i++) {
            struct explanation e = p->item[i];
            double probability = with_faults(p, &e);
            int there = k == -1 ? e.something_else : k == -2 && !e.nmember && !e.something_else;
            for (int m = 0; m < e.nmember && k >= 0; m++)
                there |= e.member[m].cause == catalogue_item(k);
            sum += there ? probability : 0;
        }
        if (sum > 0)
            cJSON_AddNumberToObject(list, k == -2 ? "nothing" : k == -1 ? "something else" : catalogue_item(k)->id, sum);
    }
    return list;
}

static void write_line(struct calibration *run, const struct power_case *c, const struct explanation *truth,
                       const struct explanation *lead, const struct posterior *p, const char *failure,
                       const struct calibrated *item)
{
    cJSON *line = cJSON_CreateObject();
    cJSON_AddNumberToObject(line, "case", c->hidden.number);
    cJSON_AddStringToObject(line, "again", c->again);
    cJSON_AddNumberToObject(line, "right", item->right);
    cJSON_AddNumberToObject(line, "probability", item->probability);
    cJSON_AddNumberToObject(line, "of_truth", item->of_truth);
    cJSON_AddNumberToObject(line, "draws", item->draws);
    cJSON_AddNumberToObject(line, "intervals", item->intervals);
    cJSON_AddNumberToObject(line, "held", item->held);
    cJSON_AddItemToObject(line, "truth", line_of(truth));
    if (failure) {
        cJSON_AddStringToObject(line, "failure", failure);
    } else {
        cJSON_AddItemToObject(line, "lead", line_of(lead));
        cJSON_AddItemToObject(line, "kinds", kinds_of(p));
    }
    char *text = cJSON_PrintUnformatted(line);
    pthread_mutex_lock(&run->lock);
    if (text && run->log) {
        fprintf(run->log, "%s\n", text);
        fflush(run->log);
    }
    pthread_mutex_unlock(&run->lock);
    cJSON_Delete(line);
    free(text);
}

static void compare(const struct posterior *p, const struct explanation *truth, struct explanation *lead, struct calibrated *item)
{
    *lead = p->item[0];
    item->probability = with_faults(p, lead);
    item->right = same_set(lead, truth);
    for (int i = 0; i < p->count; i++) {
        struct explanation e = p->item[i];
        double probability = with_faults(p, &e);
        item->of_truth += same_set(&e, truth) ? probability : 0;
    }
}

/* The averages over the explanations. */
static void judge_intervals(const struct diagnosis *d, const struct prior_case *made, struct calibrated *item)
{
    for (int q = 0; q < d->posterior.naveraged && q < made->nown; q++) {
        const double *interval = d->posterior.averaged[q].ci95;
        item->intervals++;
        item->held += interval[0] <= made->x[q] && made->x[q] <= interval[1];
    }
}

static int diagnose(struct pool *pool, const struct prior_case *made, const rotid_environment *environment, struct diagnosis *d,
                    struct message_list *messages)
{
    const struct diagnose_options options = {.threads = 1};
    const struct deck_memory memory = {"prior", strlen(made->deck.data), made->deck.data, NULL};
    struct states states;
    int status = deck_read_states(pool, "prior", &memory, 0, NULL, messages, &states);
    if (status)
        return status;
    for (int s = 0; s < states.state->job.rotor.nsegment; s++)
        states.state->job.rotor.segment[s].elements = made->segment[s].elements;
    return diagnose_states(pool, &states, &options, environment, messages, d);
}

static void case_text(const struct power_options *o, int number, char again[200])
{
    (void)snprintf(again, 200, "--prior%s --seed %llu --first %d --cases 1", o->prior > 1 ? "=stated" : "",
                   (unsigned long long)o->seed, number);
}

static int run_case(void *context, int index, int worker)
{
    struct calibration *run = context;
    struct calibrated *item = &run->item[index];
    const rotid_environment environment = {
        .size = sizeof environment, .cancelled = power_interrupted, .context = (void *)run->interrupted};
    struct power_options options = *run->options;
    struct message_list messages;
    struct explanation lead;
    struct prior_case made;
    struct power_case c;
    struct diagnosis d;
    struct pool pool;
    (void)worker;
    options.only = "none";
    if (item->done)
        return ROTID_OK;
    if (*run->interrupted)
        return ROTID_STOP_CANCELLED;
    if (power_draw(&options, options.first + index, &c))
        return ROTID_ERROR_MEMORY;
    case_text(&options, c.hidden.number, c.again);
    pool_open(&pool, NULL);
    message_open(&messages, &pool);
    int status = power_prior_case(&pool, &c.hidden.request, options.prior > 1, &made);
    if (!status && options.keep)
        power_keep(&options, "prior", c.hidden.number, made.deck.data);
    *item = (struct calibrated){.draws = made.draws};
    if (!status)
        status = diagnose(&pool, &made, &environment, &d, &messages);
    int diagnosed = !status, interrupted = diagnosed && d.result.interrupted;
    const char *failure = status ? rotid_status_name(status) : NULL;
    for (size_t i = 0; i < messages.count && status; i++)
        if (messages.item[i].severity == SEVERITY_ERROR)
            failure = messages.item[i].text;
    if (diagnosed && !interrupted && d.posterior.nkind != made.kinds)
        failure = "the kinds of causes are others than those that were drawn from";
    item->failed = failure != NULL;
    if (!interrupted && !failure)
        compare(&d.posterior, &made.truth, &lead, item);
    if (!interrupted && !failure)
        judge_intervals(&d, &made, item);
    item->done = !interrupted && status != ROTID_STOP_CANCELLED;
    if (item->done)
        write_line(run, &c, &made.truth, &lead, &d.posterior, failure, item);
    if (diagnosed)
        diagnose_free(&d);
    pool_close(&pool);
    free(made.deck.data);
    free(c.deck);
    return item->done ? ROTID_OK : ROTID_STOP_CANCELLED;
}

/* ---- the run */

static int take_line(void *context, const cJSON *line)
{
    const struct calibration *run = context;
    const cJSON *number = cJSON_GetObjectItem(line, "case");
    const char *said = cJSON_GetStringValue(cJSON_GetObjectItem(line, "again"));
    int index = number ? number->valueint - run->options->first : -1;
    char again[200];
    case_text(run->options, number ? number->valueint : 0, again);
    if (!number || !said || strcmp(said, again) != 0)
        return 1;
    if (index >= 0 && index < run->options->cases)
        run->item[index] = (struct calibrated){.done = 1,
                                               .failed = cJSON_HasObjectItem(line, "failure"),
                                               .right = cJSON_GetObjectItem(line, "right")->valueint,
                                               .draws = cJSON_GetObjectItem(line, "draws")->valueint,
                                               .intervals = cJSON_GetObjectItem(line, "intervals")->valueint,
                                               .held = cJSON_GetObjectItem(line, "held")->valueint,
                                               .probability = cJSON_GetNumberValue(cJSON_GetObjectItem(line, "probability")),
                                               .of_truth = cJSON_GetNumberValue(cJSON_GetObjectItem(line, "of_truth"))};
    return 0;
}

static int report(FILE *out, const struct calibration *run)
{
    int cases = run->options->cases, done = 0, failed = 0, count = 0, draws = 0, unlisted = 0;
    struct power_share intervals = {0};
    double *probability = calloc((size_t)cases, sizeof *probability), of_truth = 0;
    int *right = calloc((size_t)cases, sizeof *right), code = 3;
    for (int i = 0; i < cases && probability && right; i++) {
        const struct calibrated *c = &run->item[i];
        if (!c->done)
            continue;
        done++;
        draws += c->draws;
        failed += c->failed;
        if (c->failed)
            continue;
        unlisted += !(c->of_truth > 0);
        intervals.right += c->held;
        intervals.count += c->intervals;
        of_truth += c->of_truth > 0 ? log(c->of_truth) : 0;
        probability[count] = c->probability;
        right[count++] = c->right;
    }
    fprintf(out, "power --prior%s --seed %llu: %d cases, %d draws of them without data, %d without a diagnosis\n",
            run->options->prior > 1 ? "=stated" : "", (unsigned long long)run->options->seed, done, draws - done, failed);
    if (probability && right)
        code = power_bands(out, count, probability, right);
    fprintf(out, "ln of the probability of the truth %.3f, and in %d cases it is not listed\n",
            count > unlisted ? of_truth / (count - unlisted) : NAN, unlisted);
    double lower, upper;
    power_interval(intervals, &lower, &upper);
    fprintf(out, "averaged 95 %% intervals hold the true values: %d of %d, %.1f %% (%.1f to %.1f)\n", intervals.right,
            intervals.count, intervals.count ? 100.0 * intervals.right / intervals.count : NAN, 100 * lower, 100 * upper);
    free(probability);
    free(right);
    return code;
}

int power_calibration(const struct power_options *options, const volatile sig_atomic_t *interrupted, FILE *out)
{
    struct calibration run = {
        .options = options, .interrupted = interrupted, .item = calloc((size_t)options->cases, sizeof *run.item)};
    run.log = options->log && run.item ? power_lines(options->log, take_line, &run) : NULL;
    if (!run.item || (options->log && !run.log)) {
        free(run.item);
        return 3;
    }
    pthread_mutex_init(&run.lock, NULL);
    int status = parallel_for(options->jobs, options->cases, run_case, &run);
    pthread_mutex_destroy(&run.lock);
    int code = report(out, &run), bad = run.log && fclose(run.log);
    free(run.item);
    return (status && !*interrupted) || bad ? 3 : code;
}
