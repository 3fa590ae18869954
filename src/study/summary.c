#include "study/summary.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "file/open.h"
#include "study/results.h"

#define SAME_OBJECTIVE 1e-6  /* relative: fits that stopped at one minimum agree to the square of their step tolerance */
#define NO_OBJECTIVE   1e-10 /* exact data leave rounding, which has no relative accuracy */

static double number_of(const cJSON *object, const char *key)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);
    return cJSON_IsNumber(item) ? item->valuedouble : NAN;
}

/* 0 where it is not from 0 to the number of runs there may be. */
static long count_of(const cJSON *object, const char *key)
{
    double value = number_of(object, key);
    return value >= 0 && value <= STUDY_MOST_RUNS ? (long)value : 0;
}

static const char *text_of(const cJSON *object, const char *key)
{
    return cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(object, key));
}

/* The text in the pool; NULL for NULL, and with *failed where memory is out. */
static const char *keep(struct pool *pool, const char *text, int *failed)
{
    const char *copy = text ? pool_copy_text(pool, text) : NULL;
    *failed |= text && !copy;
    return copy;
}

static struct summary_cell *find_cell(struct pool *pool, struct summary *s, const cJSON *line)
{
    const cJSON *object = cJSON_GetObjectItemCaseSensitive(line, "cell");
    char *key = cJSON_PrintUnformatted(object);
    struct summary_cell *cell = NULL;
    int failed = !key;
    for (int i = s->ncell - 1; i >= 0 && key && !cell; i--) /* runs of a cell follow each other */
        cell = strcmp(s->cell[i].key, key) ? NULL : &s->cell[i];
    struct summary_cell *grown = cell || failed ? NULL : pool_grow(pool, s->cell, (size_t)s->ncell, &s->cell_room, sizeof *grown);
    if (grown) {
        s->cell = grown;
        cell = &s->cell[s->ncell++];
        *cell = (struct summary_cell){.key = keep(pool, key, &failed),
                                      .deck = keep(pool, text_of(object, "deck"), &failed),
                                      .variant = keep(pool, text_of(object, "variant"), &failed),
                                      .modes = keep(pool, text_of(object, "modes"), &failed),
                                      .sensors = keep(pool, text_of(object, "sensors"), &failed),
                                      .hide = keep(pool, text_of(object, "hide"), &failed),
                                      .noise_frequency = number_of(object, "noise_frequency"),
                                      .noise_shape = number_of(object, "noise_shape"),
                                      .first = count_of(line, "run")};
    }
    cJSON_free(key);
    return failed ? NULL : cell;
}

static int add_error(struct pool *pool, struct summary *s, const cJSON *line)
{
    const char *text = text_of(line, "error");
    int failed = 0;
    for (int i = 0; i < s->nerror; i++)
        if (!strcmp(s->error[i].text, text ? text : "")) {
            s->error[i].runs++;
            return ROTID_OK;
        }
    struct summary_error *grown = pool_grow(pool, s->error, (size_t)s->nerror, &s->error_room, sizeof *grown);
    if (!grown)
        return ROTID_ERROR_MEMORY;
    s->error = grown;
    s->error[s->nerror++] = (struct summary_error){keep(pool, text ? text : "", &failed), 1, count_of(line, "run")};
    return failed ? ROTID_ERROR_MEMORY : ROTID_OK;
}

static struct summary_parameter *find_parameter(struct pool *pool, struct summary_cell *cell, const cJSON *item)
{
    const char *name = text_of(item, "name");
    int failed = 0;
    for (int p = 0; p < cell->nparameter && name; p++)
        if (!strcmp(cell->parameter[p].name, name))
            return &cell->parameter[p];
    struct summary_parameter *grown =
        pool_grow(pool, cell->parameter, (size_t)cell->nparameter, &cell->parameter_room, sizeof *grown);
    if (!grown)
        return NULL;
    cell->parameter = grown;
    grown[cell->nparameter] = (struct summary_parameter){.name = keep(pool, name ? name : "", &failed),
                                                         .unit = keep(pool, text_of(item, "unit"), &failed),
                                                         .smallest = INFINITY,
                                                         .largest = -INFINITY};
    return failed ? NULL : &cell->parameter[cell->nparameter++];
}

static void add_value(struct summary_parameter *p, const cJSON *item)
{
    double value = number_of(item, "value"), std = number_of(item, "std"), truth = number_of(item, "truth");
    const cJSON *interval = cJSON_GetObjectItemCaseSensitive(item, "ci95"), *lower = cJSON_GetArrayItem(interval, 0),
                *upper = cJSON_GetArrayItem(interval, 1);
    if (!isfinite(value))
        return;
    double from_mean = value - p->mean; /* Welford */
    p->mean += from_mean / (double)++p->count;
    p->square += from_mean * (value - p->mean);
    p->smallest = fmin(p->smallest, value);
    p->largest = fmax(p->largest, value);
    if (isfinite(std)) {
        p->stds++;
        p->std_sum += std;
    }
    if (!isfinite(truth))
        return;
    p->errors++;
    p->error_sum += value - truth;
    p->error_square += (value - truth) * (value - truth);
    if (cJSON_IsNumber(lower) && cJSON_IsNumber(upper)) {
        p->intervals++;
        p->covered += lower->valuedouble <= truth && truth <= upper->valuedouble;
    }
}

static int add_parameters(struct pool *pool, struct summary_cell *cell, const cJSON *line)
{
    const cJSON *item;
    cJSON_ArrayForEach(item, cJSON_GetObjectItemCaseSensitive(line, "parameters"))
    {
        struct summary_parameter *parameter = find_parameter(pool, cell, item);
        if (!parameter)
            return ROTID_ERROR_MEMORY;
        add_value(parameter, item);
    }
    return ROTID_OK;
}

static void add_modes(struct summary_cell *cell, const cJSON *line)
{
    const cJSON *item;
    cJSON_ArrayForEach(item, cJSON_GetObjectItemCaseSensitive(line, "modes"))
    {
        double error = number_of(item, "error_percent");
        int held = cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(item, "holdout"));
        if (!isfinite(error))
            continue;
        *(held ? &cell->held_out : &cell->fitted) += 1;
        *(held ? &cell->held_out_square : &cell->fitted_square) += error * error;
    }
}

static int add_objective(struct pool *pool, struct summary_cell *cell, const cJSON *line, int usable)
{
    struct summary_objective *grown =
        pool_grow(pool, cell->objective, (size_t)cell->nobjective, &cell->objective_room, sizeof *grown);
    if (!grown)
        return ROTID_ERROR_MEMORY;
    cell->objective = grown;
    grown[cell->nobjective++] =
        (struct summary_objective){count_of(line, "replicate"), usable ? number_of(line, "objective") : NAN};
    return ROTID_OK;
}

static int add_cause(struct pool *pool, struct summary_cell *cell, const char *id)
{
    int failed = 0;
    for (int i = 0; i < cell->ncause; i++)
        if (!strcmp(cell->cause[i].id, id)) {
            cell->cause[i].runs++;
            return ROTID_OK;
        }
    struct summary_cause *grown = pool_grow(pool, cell->cause, (size_t)cell->ncause, &cell->cause_room, sizeof *grown);
    if (!grown)
        return ROTID_ERROR_MEMORY;
    cell->cause = grown;
    grown[cell->ncause++] = (struct summary_cause){keep(pool, id, &failed), 1};
    return failed ? ROTID_ERROR_MEMORY : ROTID_OK;
}

static int add_diagnosis(struct pool *pool, struct summary_cell *cell, const cJSON *line)
{
    const cJSON *verdict = cJSON_GetObjectItemCaseSensitive(line, "verdict"), *item;
    const char *kind = text_of(verdict, "kind"), *score = text_of(line, "score");
    int status = ROTID_OK;
    if (!kind)
        return ROTID_OK;
    cell->judged++;
    for (int k = VERDICT_ADEQUATE; k <= VERDICT_UNEXPLAINED; k++)
        cell->verdict[k] += !strcmp(kind, verdict_name((enum verdict_kind)k));
    cell->false_faults += count_of(line, "false_findings");
    if (score && score_find(score) < SCORE_COUNT) {
        cell->scored++;
        cell->score[score_find(score)]++;
    }
    cJSON_ArrayForEach(item, cJSON_GetObjectItemCaseSensitive(verdict, "causes"))
    {
        const char *id = text_of(item, "id");
        status = id && !status ? add_cause(pool, cell, id) : status;
    }
    cJSON_ArrayForEach(item, cJSON_GetObjectItemCaseSensitive(line, "data_findings"))
    {
        const char *id = text_of(item, "id");
        status = id && !status ? add_cause(pool, cell, id) : status;
    }
    return status;
}

static int add_line(struct pool *pool, struct summary *s, const cJSON *line)
{
    struct summary_cell *cell = find_cell(pool, s, line);
    const char *state = text_of(line, "status");
    long start = count_of(line, "start");
    double chi2 = number_of(line, "chi2_per_dof"), evaluations = number_of(line, "evaluations"),
           seconds = number_of(line, "seconds");
    if (!cell || !state)
        return ROTID_ERROR_MEMORY;
    int converged = !strcmp(state, "converged"), at_bound = !strcmp(state, "at_bound"), failed = !strcmp(state, "failed");
    cell->runs++;
    cell->converged += converged;
    cell->at_bound += at_bound;
    cell->failed += failed;
    cell->not_converged += !converged && !at_bound && !failed;
    cell->last_start = start > cell->last_start ? start : cell->last_start;
    cell->seconds += isfinite(seconds) ? seconds : 0;
    s->seconds += isfinite(seconds) ? seconds : 0;
    s->there++;
    s->failed += failed;
    if (failed)
        return add_error(pool, s, line);
    cell->evaluations += isfinite(evaluations) ? evaluations : 0;
    int status = add_objective(pool, cell, line, converged || at_bound);
    if (status || !(converged || at_bound))
        return status;
    if (isfinite(chi2)) {
        cell->chi2s++;
        cell->chi2_sum += chi2;
    }
    add_modes(cell, line);
    status = add_parameters(pool, cell, line);
    return status ? status : add_diagnosis(pool, cell, line);
}

static int compare(const void *left, const void *right)
{
    const struct summary_objective *a = left, *b = right;
    if (a->replicate != b->replicate)
        return a->replicate < b->replicate ? -1 : 1;
    return isnan(a->value) ? !isnan(b->value) : isnan(b->value) ? -1 : (a->value > b->value) - (a->value < b->value);
}

/* How many of the starts of a replicate came to the best objective that any of them found. */
static void count_reached(struct summary_cell *cell)
{
    double best = NAN;
    if (cell->nobjective > 1)
        qsort(cell->objective, (size_t)cell->nobjective, sizeof *cell->objective, compare);
    for (long i = 0; i < cell->nobjective; i++) {
        const struct summary_objective *now = &cell->objective[i];
        if (!i || now->replicate != cell->objective[i - 1].replicate)
            best = now->value;
        cell->reached += now->value <= best + SAME_OBJECTIVE * fabs(best) + NO_OBJECTIVE;
    }
}

static int read_all(struct pool *pool, int descriptor, struct message_list *messages, struct summary *s)
{
    struct result_place *place;
    size_t most;
    int status = results_index(pool, descriptor, s->path, messages, &s->header, &place, &most);
    char *text = status ? NULL : malloc(most + 1);
    if (!status && !text)
        status = ROTID_ERROR_MEMORY;
    for (long run = 0; run < s->header.runs && !status; run++) { /* in their order: sums do not depend on who was faster */
        s->wanted += run % s->header.shards == s->header.shard - 1;
        if (!place[run].length)
            continue;
        status = results_fetch(descriptor, place[run], text);
        if (status)
            message_add(messages, SEVERITY_ERROR, s->path, 1, 1, "reading failed: %s", strerror(errno));
        cJSON *line = status ? NULL : cJSON_ParseWithLength(text, place[run].length);
        if (!status)
            status = line ? add_line(pool, s, line) : ROTID_ERROR_MEMORY;
        cJSON_Delete(line);
    }
    free(text);
    for (int i = 0; i < s->ncell; i++)
        count_reached(&s->cell[i]);
    return status;
}

int summary_read(struct pool *pool, const char *path, struct message_list *messages, struct summary *summary)
{
    struct stat about;
    int descriptor = file_descriptor(path, &about);
    *summary = (struct summary){.path = path};
    if (descriptor < 0) {
        message_add(messages, SEVERITY_ERROR, path, 1, 1, "cannot be opened: %s, expected a file of results", strerror(errno));
        return ROTID_ERROR_IO;
    }
    int status = read_all(pool, descriptor, messages, summary);
    (void)close(descriptor);
    return status;
}

double summary_std(const struct summary_parameter *p)
{
    return p->count > 1 ? sqrt(p->square / (double)(p->count - 1)) : NAN;
}

double summary_mean_std(const struct summary_parameter *p)
{
    return p->stds ? p->std_sum / (double)p->stds : NAN;
}

double summary_bias(const struct summary_parameter *p)
{
    return p->errors ? p->error_sum / (double)p->errors : NAN;
}

double summary_std_error(const struct summary_parameter *p)
{
    double bias = summary_bias(p), n = (double)p->errors;
    return p->errors > 1 ? sqrt(fmax(0, p->error_square - n * bias * bias) / (n - 1)) : NAN;
}

double summary_rms_error(const struct summary_parameter *p)
{
    return p->errors ? sqrt(p->error_square / (double)p->errors) : NAN;
}

double summary_coverage(const struct summary_parameter *p)
{
    return p->intervals ? (double)p->covered / (double)p->intervals : NAN;
}
