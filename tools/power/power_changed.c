/* What changed between two states: random rotors with an error of the model that stays and an effect that comes, measured before
 * and after. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/base.h"
#include "deck/deck.h"
#include "diagnose/diagnose.h"
#include "hidden_states.h"
#include "power.h"

#define NOTHING 5    /* every fifth time nothing changes */
#define DRAWS   8    /* until an effect is drawn that the rotor can have beside the first */
#define VISIBLE 60.0 /* chi2 of the change, free of noise, with the noise of both states: from there on a name is asked for */
#define ASKED   0.9

struct pair {
    int done;
    enum hidden_outcome outcome;
    double worth, seconds;
    double lead; /* of the change over every other explanation of the data without noise; NaN where that was not asked */
    char stays[200], comes[200], said[600];
};

struct pairs {
    const struct power_options *options;
    const volatile sig_atomic_t *interrupted;
    struct pair *pair;
};

/* SPEC of the first effect that hide has drawn; empty: none. */
static void take_spec(const cJSON *truth, char *spec, size_t room)
{
    const char *text =
        cJSON_GetStringValue(cJSON_GetObjectItem(cJSON_GetArrayItem(cJSON_GetObjectItem(truth, "effects"), 0), "spec"));
    (void)snprintf(spec, room, "%s", text ? text : "");
}

/* The truth of a rotor with these effects, or with one drawn where there are none; NULL where hide refuses. */
static cJSON *hide(const struct hide_request *request, int effects, const char *const *effect, uint64_t seed)
{
    struct hide_request r = *request;
    char message[300], *deck, *truth;
    r.seed = seed;
    r.random = effects ? NULL : "physical";
    r.effects = effects;
    r.effect = effect;
    if (hide_case(&r, &deck, &truth, message, sizeof message))
        return NULL;
    cJSON *json = cJSON_Parse(truth);
    free(deck);
    free(truth);
    return json;
}

static double at(const cJSON *json, const char *name, int i)
{
    return cJSON_GetNumberValue(cJSON_GetArrayItem(cJSON_GetObjectItem(json, name), i));
}

/* chi2 of what the effect makes of the data, with the noise of both states; shapes at their best scale. */
static double worth(const struct hide_request *r, const cJSON *truth)
{
    const cJSON *with = cJSON_GetObjectItem(truth, "with"), *without = cJSON_GetObjectItem(truth, "without");
    double chi2 = 0;
    for (int k = 0; k < r->modes; k++) {
        double d = (at(with, "frequency_hz", k) / at(without, "frequency_hz", k) - 1) / r->frequency_noise;
        const cJSON *a = cJSON_GetArrayItem(cJSON_GetObjectItem(with, "shape"), k),
                    *b = cJSON_GetArrayItem(cJSON_GetObjectItem(without, "shape"), k), *item;
        double aa = 0, ab = 0, bb = 0;
        int i = 0;
        chi2 += d * d / 2;
        cJSON_ArrayForEach(item, a)
        {
            double y = cJSON_GetNumberValue(cJSON_GetArrayItem(b, i++));
            aa += item->valuedouble * item->valuedouble;
            ab += item->valuedouble * y;
            bb += y * y;
        }
        if (!r->no_shapes && bb > 0)
            chi2 += fmax(0, aa - ab * ab / bb) / (2 * r->shape_noise * r->shape_noise);
    }
    return chi2;
}

static int diagnose(const char *text, const cJSON *truth, const rotid_environment *environment, int quiet, struct pair *pair)
{
    const struct diagnose_options options = {.threads = 1, .before = "before", .after = "after"};
    const struct deck_memory memory = {"pair", strlen(text), text, NULL};
    struct message_list messages;
    struct hidden_score score = hidden_score_none();
    struct states states;
    struct diagnosis d;
    struct pool pool;
    pool_open(&pool, NULL);
    message_open(&messages, &pool);
    int status = deck_read_states(&pool, "pair", &memory, 0, NULL, &messages, &states);
    double begin = clock_seconds();
    if (!status)
        status = diagnose_states(&pool, &states, &options, environment, &messages, &d);
    if (quiet) {
        pair->lead = status || d.result.interrupted ? NAN : hidden_lead(&d, truth);
        if (!status)
            diagnose_free(&d);
        pool_close(&pool);
        return ROTID_OK;
    }
    pair->seconds = clock_seconds() - begin;
    pair->outcome = HIDDEN_FAILED;
    for (size_t i = 0; i < messages.count && status; i++)
        if (messages.item[i].severity == SEVERITY_ERROR)
            (void)snprintf(pair->said, sizeof pair->said, "%s", messages.item[i].text);
    if (!status && d.result.interrupted)
        status = ROTID_STOP_CANCELLED;
    if (!status) {
        status = hidden_score_make(&pool, &d, &d.given.state->job, truth, &score);
        pair->outcome = score.outcome;
        (void)snprintf(pair->said, sizeof pair->said, "%s", d.result.verdict.sentence);
        diagnose_free(&d);
    }
    pool_close(&pool);
    return status == ROTID_STOP_CANCELLED ? status : ROTID_OK;
}

/* The same states without noise, which the deck states all the same. */
static char *quiet_deck(const struct hide_request *request, const struct hidden_state *states)
{
    struct hide_request r = *request;
    char message[300];
    r.stated_frequency_noise = r.frequency_noise;
    r.stated_shape_noise = r.shape_noise;
    r.frequency_noise = r.shape_noise = 0;
    return hidden_states_deck(&r, 2, states, NULL, message, sizeof message);
}

static int run_pair(void *context, int index, int worker)
{
    struct pairs *pairs = context;
    struct pair *pair = &pairs->pair[index];
    const rotid_environment environment = {
        .size = sizeof environment, .cancelled = power_interrupted, .context = (void *)pairs->interrupted};
    struct power_options options = *pairs->options;
    struct power_case c;
    char message[300];
    (void)worker;
    pair->lead = NAN;
    options.only = "none";
    if (*pairs->interrupted)
        return ROTID_STOP_CANCELLED;
    if (power_draw(&options, options.first + index, &c))
        return ROTID_ERROR_MEMORY;
    struct hide_request *r = &c.hidden.request;
    const char *effect[2] = {pair->stays, pair->comes};
    cJSON *first = hide(r, 0, NULL, r->seed), *second = NULL;
    char *text = NULL, *quiet = NULL;
    int comes = (options.first + index) % NOTHING != 0, status = ROTID_OK;
    r->random = NULL;
    take_spec(first, pair->stays, sizeof pair->stays);
    for (int draw = 1; draw <= DRAWS && first && !text; draw++) {
        uint64_t seed = r->seed + 100000000u * (uint64_t)draw;
        cJSON_Delete(second);
        second = comes ? hide(r, 0, NULL, seed) : hide(r, 0, NULL, r->seed);
        take_spec(second, pair->comes, sizeof pair->comes);
        if (!comes)
            pair->comes[0] = 0;
        const struct hidden_state states[] = {{"before", "", 1, effect}, {"after", "", 1 + comes, effect}};
        text = second ? hidden_states_deck(r, 2, states, NULL, message, sizeof message) : NULL;
        if (text && comes) {
            free(quiet);
            quiet = quiet_deck(r, states);
        }
    }
    if (text && options.keep)
        power_keep(&options, "pair", options.first + index, text);
    if (text) {
        if (!comes) {
            cJSON_DeleteItemFromObject(second, "effects");
            cJSON_AddArrayToObject(second, "effects");
        }
        pair->worth = comes ? worth(r, second) : 0;
        status = diagnose(text, second, &environment, 0, pair);
        if (!status && quiet && pair->outcome == HIDDEN_IN_SET && pair->worth >= VISIBLE)
            status = diagnose(quiet, second, &environment, 1, pair);
    } else {
        pair->outcome = HIDDEN_FAILED;
        (void)snprintf(pair->said, sizeof pair->said, "no such rotor: %s", message);
    }
    cJSON_Delete(first);
    cJSON_Delete(second);
    free(text);
    free(quiet);
    free(c.deck);
    pair->done = !status;
    return status;
}

/* What a pair is judged by. */
enum kind { NOTHING_COMES, UNSEEN, VISIBLE_ONE, KINDS };

static enum kind kind_of(const struct pair *p)
{
    return !p->comes[0] ? NOTHING_COMES : p->worth < VISIBLE ? UNSEEN : VISIBLE_ONE;
}

/* Nothing came: quiet. What comes and is worth little: quiet as well, or what is said holds it. What is visible has a name, or is
 * in a set with something that explains the data as well even without their noise: then a name would be luck. Where the truth
 * explains these worse than something else, the method is at fault. */
static int is_right(const struct pair *p)
{
    int quiet = p->outcome == HIDDEN_SILENT, named = p->outcome == HIDDEN_RIGHT, holds = named || p->outcome == HIDDEN_IN_SET;
    switch (kind_of(p)) {
    case NOTHING_COMES:
        return quiet;
    case UNSEEN:
        return quiet || holds;
    default:
        return named || (holds && fabs(p->lead) < LEAST_MARGIN);
    }
}

static int report(FILE *out, int count, int first, const struct pair *pair)
{
    static const char *const what[KINDS] = {"nothing changed", "worth less than 60 of chi2", "worth 60 or more"};
    int all[KINDS] = {0}, right[KINDS] = {0}, outcome[KINDS][HIDDEN_OUTCOMES] = {{0}}, twins = 0, sum = 0, done = 0;
    double seconds = 0;
    for (int i = 0; i < count; i++) {
        const struct pair *p = &pair[i];
        enum kind kind = kind_of(p);
        if (!p->done)
            continue;
        done++;
        fprintf(out, "%3d %-12s %s %9.3g %9.3g %5.1f s  stays %s, comes %s\n    %s\n", first + i, hidden_outcome_name(p->outcome),
                is_right(p) ? "right" : "NOT  ", p->worth, p->lead, p->seconds, p->stays, p->comes[0] ? p->comes : "nothing",
                p->said);
        seconds += p->seconds;
        all[kind]++;
        right[kind] += is_right(p);
        outcome[kind][p->outcome]++;
        sum += is_right(p);
        twins += kind == VISIBLE_ONE && p->outcome == HIDDEN_IN_SET && is_right(p);
    }
    fprintf(out, "%d pairs, %.2f s each\n%-28s pairs  right", done, done ? seconds / done : 0, "");
    for (int o = 0; o < HIDDEN_OUTCOMES; o++)
        fprintf(out, "  %11s", o == HIDDEN_RIGHT ? "named" : hidden_outcome_name((enum hidden_outcome)o));
    for (int k = 0; k < KINDS; k++) {
        fprintf(out, "\n%-28s %5d  %5d", what[k], all[k], right[k]);
        for (int o = 0; o < HIDDEN_OUTCOMES; o++)
            fprintf(out, "  %11d", outcome[k][o]);
    }
    fprintf(out,
            "\nright: %d of %d, %.0f %%; in %d of the sets truth and another one are within %g without noise, so no data of this "
            "kind "
            "could name it\n",
            sum, done, done ? 100.0 * sum / done : 0, twins, LEAST_MARGIN);
    return !(sum >= ASKED * done);
}

int power_changed(const struct power_options *options, const volatile sig_atomic_t *interrupted, FILE *out)
{
    struct pairs pairs = {options, interrupted, calloc((size_t)options->cases, sizeof(struct pair))};
    int status = pairs.pair ? parallel_for(options->jobs, options->cases, run_pair, &pairs) : ROTID_ERROR_MEMORY;
    int code = status == ROTID_ERROR_MEMORY ? 3 : report(out, options->cases, options->first, pairs.pair);
    free(pairs.pair);
    return code;
}
