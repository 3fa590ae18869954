/* What a file of results says as a whole: for each cell how its runs ended and what they found, by sums that grow with the runs.
 */
#include "study/study.h"

#include <errno.h>

#define SAME_OBJECTIVE 1e-6  /* relative: fits that stopped at one minimum agree to the square of their step tolerance */
#define NO_OBJECTIVE   1e-10 /* exact data leave rounding, which has no relative accuracy */

/* Of values one after the other: their sum, their mean and the sum of squared deviations from it (Welford). */
struct tally {
    int count;
    double sum, mean, square;
};

/* What is not known does not count. */
static void tally(struct tally *t, double value)
{
    if (!isfinite(value))
        return;
    double from_mean = value - t->mean;
    t->sum += value;
    t->mean += from_mean / (double)++t->count;
    t->square += from_mean * (value - t->mean);
}

static double mean(const struct tally *t)
{
    return t->count ? t->sum / (double)t->count : NAN;
}

static double deviation(const struct tally *t)
{
    return t->count > 1 ? sqrt(t->square / (double)(t->count - 1)) : NAN;
}

static double rms(const struct tally *t)
{
    return t->count ? sqrt(t->mean * t->mean + t->square / (double)t->count) : NAN;
}

struct parameter_sums {
    struct cell_parameter said;        /* min, max and intervals grow with the runs, the rest follows at the end */
    struct tally value, stated, error; /* stated: deviations of the fits; error: value less truth */
    int covered;                       /* intervals that hold a truth */
};

struct cell_sums {
    struct study_cell_result said; /* numbers of runs and seconds grow with the runs, the rest follows at the end */
    struct cell_diagnoses diagnoses;
    int last_start, nparameter, scored;
    struct parameter_sums *parameter;
    struct tally fitted, held_out, chi2, evaluations; /* the first two: errors of frequencies [%] */
    int replicate, reached; /* reached: starts of the replicates before this one that came to the best of theirs */
    double *objective;      /* [nobjective] of the starts of this replicate so far; NaN where one did not converge */
    size_t nobjective, room;
};

struct sums {
    struct pool *pool;
    struct study_result *out;
    int ncell;
    struct cell_sums *cell;
};

/* The text in the pool of the summary; NULL for NULL. */
static const char *keep(struct sums *s, const char *text)
{
    return text ? pool_copy_text(s->pool, text) : NULL;
}

static struct cell_sums *find_cell(struct sums *s, const struct study_run *run)
{
    for (int i = s->ncell - 1; i >= 0; i--) /* runs of a cell follow each other */
        if (summary_same_cell(&s->cell[i].said.cell, &run->cell))
            return &s->cell[i];
    struct cell_sums cell = {.said = {.cell = run->cell, .first_run = run->run}};
    const char **const text[] = {&cell.said.cell.deck, &cell.said.cell.variant, &cell.said.cell.modes, &cell.said.cell.sensors,
                                 &cell.said.cell.hide};
    for (size_t i = 0; i < sizeof text / sizeof *text; i++)
        *text[i] = keep(s, *text[i]);
    return POOL_ADD(s->pool, s->cell, s->ncell, &cell) || s->pool->out_of_memory ? NULL : &s->cell[s->ncell - 1];
}

static void add_error(struct sums *s, const struct study_run *run)
{
    struct study_result *out = s->out;
    const char *text = run->error ? run->error : "";
    for (int i = 0; i < out->nerrors; i++)
        if (!strcmp(out->errors[i].error, text)) {
            out->errors[i].runs++;
            return;
        }
    const struct study_error error = {keep(s, text), 1, run->run};
    (void)POOL_ADD(s->pool, out->errors, out->nerrors, &error);
}

double study_run_truth(const struct study_run *run, const char *name)
{
    for (int i = 0; i < run->ntruth; i++)
        if (!strcmp(run->truth[i].name, name))
            return run->truth[i].value;
    return NAN;
}

rotid_fitted_parameter *study_run_values(struct pool *pool, const struct study_run *run, int *count)
{
    int parameters = run->fit ? run->fit->nparameters : 0, speeds = run->speeds ? run->speeds->ncritical_speeds : 0,
        number[2] = {0, 0};
    rotid_fitted_parameter *list = POOL_ARRAY(pool, rotid_fitted_parameter, parameters + speeds);
    *count = list ? parameters + speeds : 0;
    for (int p = 0; p < parameters && list; p++)
        list[p] = run->fit->parameters[p];
    for (int i = 0; i < speeds && list; i++) {
        const rotid_critical_speed *c = &run->speeds->critical_speeds[i];
        int backward = !strcmp(c->whirl, whirl_words[0]);
        list[parameters + i] =
            (rotid_fitted_parameter){.name = pool_format(pool, "%s:%d", backward ? "backward" : "forward", ++number[backward]),
                                     .unit = "rpm",
                                     .value = c->speed_rpm,
                                     .start = NAN,
                                     .std = c->std,
                                     .ci95 = {c->ci95[0], c->ci95[1]}};
        if (!list[parameters + i].name)
            return NULL;
    }
    return list;
}

static void add_value(struct sums *s, struct cell_sums *cell, const rotid_fitted_parameter *parameter, double truth)
{
    int i = 0;
    while (i < cell->nparameter && strcmp(cell->parameter[i].said.name, parameter->name) != 0)
        i++;
    if (i == cell->nparameter) {
        const struct parameter_sums none = {
            .said = {.name = keep(s, parameter->name), .unit = keep(s, parameter->unit), .min = INFINITY, .max = -INFINITY}};
        if (s->pool->out_of_memory || POOL_ADD(s->pool, cell->parameter, cell->nparameter, &none)) /* without a name it is none */
            return;
    }
    struct parameter_sums *p = &cell->parameter[i];
    double value = parameter->value, lower = parameter->ci95[0], upper = parameter->ci95[1];
    if (!isfinite(value))
        return;
    tally(&p->value, value);
    tally(&p->stated, parameter->std);
    tally(&p->error, value - truth);
    p->said.min = fmin(p->said.min, value);
    p->said.max = fmax(p->said.max, value);
    if (isfinite(truth) && isfinite(lower) && isfinite(upper)) {
        p->said.intervals++;
        p->covered += lower <= truth && truth <= upper;
    }
}

/* How many of the starts of a replicate came to the best objective that any of them found. */
static void count_reached(struct cell_sums *cell)
{
    double best = INFINITY;
    for (size_t i = 0; i < cell->nobjective; i++)
        best = fmin(best, cell->objective[i]); /* of a NaN the other one */
    for (size_t i = 0; i < cell->nobjective; i++)
        cell->reached += cell->objective[i] <= best + SAME_OBJECTIVE * fabs(best) + NO_OBJECTIVE;
    cell->nobjective = 0;
}

/* Starts follow each other. */
static void add_objective(struct sums *s, struct cell_sums *cell, int replicate, double objective)
{
    if (replicate != cell->replicate)
        count_reached(cell);
    double *list = pool_grow(s->pool, cell->objective, cell->nobjective, &cell->room, sizeof *list);
    cell->replicate = replicate;
    if (!list)
        return;
    cell->objective = list;
    list[cell->nobjective++] = objective;
}

static void add_named(struct sums *s, struct cell_sums *cell, const char *id)
{
    struct cell_diagnoses *d = &cell->diagnoses;
    for (int i = 0; i < d->nnamed; i++)
        if (!strcmp(d->named[i].name, id)) {
            d->named[i].value++;
            return;
        }
    const rotid_component named = {.name = keep(s, id), .value = 1};
    (void)POOL_ADD(s->pool, d->named, d->nnamed, &named);
}

static void add_diagnosis(struct sums *s, struct cell_sums *cell, const struct study_run *run)
{
    const rotid_diagnosis *diagnosis = run->diagnosis;
    struct cell_diagnoses *d = &cell->diagnoses;
    d->count++;
    d->verdicts[diagnosis->verdict.kind]++;
    d->false_findings += run->false_findings != ROTID_NONE ? run->false_findings : 0;
    if (run->score >= 0) {
        cell->scored++;
        d->scores[run->score]++;
    }
    for (int i = 0; i < diagnosis->verdict.ncauses; i++)
        add_named(s, cell, diagnosis->verdict.causes[i].id);
    for (int i = 0; i < diagnosis->ndata_findings; i++)
        add_named(s, cell, diagnosis->data_findings[i].id);
}

static void add_run(struct sums *s, const struct study_run *run)
{
    struct cell_sums *cell = find_cell(s, run);
    const rotid_identification *fit = run->fit;
    int usable = run->status == STUDY_CONVERGED || run->status == STUDY_AT_BOUND, failed = run->status == STUDY_FAILED, count;
    double seconds = isfinite(run->seconds) ? run->seconds : 0;
    if (!cell)
        return;
    cell->said.runs++;
    cell->said.converged += run->status == STUDY_CONVERGED;
    cell->said.at_bound += run->status == STUDY_AT_BOUND;
    cell->said.not_converged += run->status == STUDY_NOT_CONVERGED;
    cell->said.failed += failed;
    cell->said.seconds += seconds;
    cell->last_start = run->start > cell->last_start ? run->start : cell->last_start;
    s->out->seconds += seconds;
    s->out->done++;
    s->out->failed += failed;
    if (failed) {
        add_error(s, run);
        return;
    }
    if (!fit)
        return;
    tally(&cell->evaluations, fit->evaluations);
    add_objective(s, cell, run->replicate, usable ? fit->objective : (double)NAN);
    if (!usable)
        return;
    cell->said.not_adequate += misfit_is_inadequate(fit->chi2_per_dof * fit->dof, fit->dof);
    tally(&cell->chi2, fit->chi2_per_dof);
    for (int k = 0; k < fit->nmodes; k++)
        tally(fit->modes[k].holdout ? &cell->held_out : &cell->fitted, fit->modes[k].error_percent);
    struct pool scratch;
    pool_open(&scratch, s->pool->allocator);
    const rotid_fitted_parameter *value = study_run_values(&scratch, run, &count);
    s->pool->out_of_memory |= !value;
    for (int p = 0; p < count && value; p++)
        add_value(s, cell, &value[p], study_run_truth(run, value[p].name));
    pool_close(&scratch);
    if (run->diagnosis)
        add_diagnosis(s, cell, run);
}

static struct cell_parameter finish_parameter(const struct parameter_sums *p)
{
    struct cell_parameter said = p->said;
    said.count = p->value.count;
    said.mean = mean(&p->value);
    said.std = deviation(&p->value);
    said.mean_stated_std = mean(&p->stated);
    said.bias = mean(&p->error);
    said.std_error = deviation(&p->error);
    said.rms_error = rms(&p->error);
    said.coverage95 = said.intervals ? (double)p->covered / (double)said.intervals : (double)NAN;
    return said;
}

static struct study_cell_result finish_cell(struct sums *s, struct cell_sums *cell)
{
    struct study_cell_result said = cell->said;
    count_reached(cell);
    said.reached_best = cell->last_start ? cell->reached : ROTID_NONE;
    said.parameters = POOL_ARRAY(s->pool, struct cell_parameter, cell->nparameter);
    for (int p = 0; p < cell->nparameter && said.parameters; p++)
        said.parameters[said.nparameters++] = finish_parameter(&cell->parameter[p]);
    said.frequency_rms_percent = rms(&cell->fitted);
    said.holdout_frequency_rms_percent = rms(&cell->held_out);
    said.chi2_per_dof = mean(&cell->chi2);
    said.evaluations = mean(&cell->evaluations);
    if (cell->diagnoses.count && !cell->scored)
        cell->diagnoses.scores[0] = cell->diagnoses.false_findings = ROTID_NONE;
    said.diagnoses = cell->diagnoses.count ? POOL_COPY(s->pool, &cell->diagnoses, 1, 0) : NULL;
    return said;
}

static void finish(struct sums *s)
{
    s->out->cells = POOL_ARRAY(s->pool, struct study_cell_result, s->ncell);
    for (int i = 0; i < s->ncell && s->out->cells; i++)
        s->out->cells[s->out->ncells++] = finish_cell(s, &s->cell[i]);
    s->out->missing = s->out->runs - s->out->done;
}

/* In order of the runs: sums do not depend on who was faster. */
static int add_runs(struct pool *pool, struct message_list *messages, const struct results *file, struct table *runs,
                    struct study_result *out)
{
    struct sums sums = {.pool = pool, .out = out};
    int status = ROTID_OK;
    for (long run = 0; run < file->header.runs && !status; run++) {
        struct pool own, *of = runs ? pool : &own; /* the table keeps its texts */
        struct study_run said = {0};
        out->runs += run % file->shards == file->shard - 1;
        if (!file->place[run].length)
            continue;
        pool_open(&own, NULL);
        const char *text = results_fetch(&own, file->place[run]);
        if (!text)
            status = message_refuse(messages, ROTID_ERROR_IO, file->path, 1, 1, "reading failed: %s", strerror(errno));
        else if (results_line_read(of, text, file->place[run].length, &said))
            status = ROTID_ERROR_MEMORY;
        if (!status)
            add_run(&sums, &said);
        if (!status && runs)
            table_add_run(runs, &said);
        pool_close(&own);
    }
    finish(&sums);
    return !status && pool->out_of_memory ? ROTID_ERROR_MEMORY : status;
}

int summary_read(struct pool *pool, const char *path, struct message_list *messages, struct study_header *header,
                 struct table *runs, struct study_result *out)
{
    struct results file;
    *out = (struct study_result){.results = path};
    int status = results_open(pool, path, messages, &file);
    if (status)
        return status;
    *header = file.header;
    out->plan = header->plan;
    out->studies = header->studies;
    out->shard = file.shard;
    out->shards = file.shards;
    status = add_runs(pool, messages, &file, runs, out);
    results_close(&file);
    return status;
}
