#include "study/study.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SAME_OBJECTIVE 1e-6  /* relative: fits that stopped at one minimum agree to the square of their step tolerance */
#define NO_OBJECTIVE   1e-10 /* exact data leave rounding, which has no relative accuracy */

struct parameter_sums {
    struct cell_parameter said; /* count, mean, min, max and intervals grow with the runs, the rest follows at the end */
    double square;              /* sum of squared deviations from the mean */
    int stds;
    double std_sum; /* of those stated by the fits */
    int errors;
    double error_sum, error_square; /* value less truth */
    int covered;                    /* intervals that hold the truth */
};

struct objective { /* of one run */
    int replicate;
    double value; /* NaN where it did not converge */
};

struct cell_sums {
    struct study_cell_result said; /* numbers of runs and seconds grow with the runs, the rest follows at the end */
    struct cell_diagnoses diagnoses;
    int last_start, nparameter, nobjective, scored;
    struct parameter_sums *parameter;
    struct objective *objective;
    int fitted, held_out;                  /* frequencies */
    double fitted_square, held_out_square; /* [%^2] */
    int chi2s;
    double chi2_sum, evaluations;
};

struct sums {
    struct pool *pool;
    struct study_result *out;
    int ncell;
    struct cell_sums *cell;
};

int summary_is_scored(const struct study_cell_result *cell)
{
    return cell->diagnoses && cell->diagnoses->scores[0] != ROTID_NONE;
}

/* The text in the pool of the summary; NULL for NULL. */
static const char *keep(struct sums *s, const char *text)
{
    return text ? pool_copy_text(s->pool, text) : NULL;
}

static struct cell_sums *find_cell(struct sums *s, const struct study_run *run)
{
    const struct study_axes *axes = &run->cell;
    for (int i = s->ncell - 1; i >= 0; i--) /* runs of a cell follow each other */
        if (summary_same_cell(&s->cell[i].said.cell, axes))
            return &s->cell[i];
    const struct cell_sums cell = {.said = {.cell = {.deck = keep(s, axes->deck),
                                                     .variant = keep(s, axes->variant),
                                                     .modes = keep(s, axes->modes),
                                                     .sensors = keep(s, axes->sensors),
                                                     .noise_frequency = axes->noise_frequency,
                                                     .noise_shape = axes->noise_shape,
                                                     .hide = keep(s, axes->hide)},
                                            .first_run = run->run}};
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

static struct parameter_sums *find_parameter(struct sums *s, struct cell_sums *cell, const rotid_fitted_parameter *parameter)
{
    for (int p = 0; p < cell->nparameter; p++)
        if (!strcmp(cell->parameter[p].said.name, parameter->name))
            return &cell->parameter[p];
    const struct parameter_sums sums = {
        .said = {.name = keep(s, parameter->name), .unit = keep(s, parameter->unit), .min = INFINITY, .max = -INFINITY}};
    return POOL_ADD(s->pool, cell->parameter, cell->nparameter, &sums) || s->pool->out_of_memory
               ? NULL
               : &cell->parameter[cell->nparameter - 1];
}

static void add_value(struct parameter_sums *p, const rotid_fitted_parameter *parameter, double truth)
{
    struct cell_parameter *said = &p->said;
    double value = parameter->value;
    if (!isfinite(value))
        return;
    double from_mean = value - said->mean; /* Welford */
    said->mean += from_mean / (double)++said->count;
    p->square += from_mean * (value - said->mean);
    said->min = fmin(said->min, value);
    said->max = fmax(said->max, value);
    if (isfinite(parameter->std)) {
        p->stds++;
        p->std_sum += parameter->std;
    }
    if (!isfinite(truth))
        return;
    p->errors++;
    p->error_sum += value - truth;
    p->error_square += (value - truth) * (value - truth);
    if (isfinite(parameter->ci95[0]) && isfinite(parameter->ci95[1])) {
        said->intervals++;
        p->covered += parameter->ci95[0] <= truth && truth <= parameter->ci95[1];
    }
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

static void add_modes(struct cell_sums *cell, const rotid_identification *fit)
{
    for (int k = 0; k < fit->nmodes; k++) {
        double error = fit->modes[k].error_percent;
        int held = fit->modes[k].holdout;
        if (!isfinite(error))
            continue;
        *(held ? &cell->held_out : &cell->fitted) += 1;
        *(held ? &cell->held_out_square : &cell->fitted_square) += error * error;
    }
}

static void add_objective(struct sums *s, struct cell_sums *cell, const struct study_run *run, int usable)
{
    const struct objective objective = {run->replicate, usable ? run->fit->objective : NAN};
    (void)POOL_ADD(s->pool, cell->objective, cell->nobjective, &objective);
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
    int usable = run->status == STUDY_CONVERGED || run->status == STUDY_AT_BOUND, failed = run->status == STUDY_FAILED;
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
    const rotid_identification *fit = run->fit;
    cell->evaluations += fit->evaluations;
    add_objective(s, cell, run, usable);
    if (!usable)
        return;
    cell->said.not_adequate += misfit_is_inadequate(fit->chi2_per_dof * fit->dof, fit->dof);
    if (isfinite(fit->chi2_per_dof)) {
        cell->chi2s++;
        cell->chi2_sum += fit->chi2_per_dof;
    }
    add_modes(cell, fit);
    struct pool scratch;
    int count;
    pool_open(&scratch, s->pool->allocator);
    const rotid_fitted_parameter *value = study_run_values(&scratch, run, &count);
    s->pool->out_of_memory |= !value;
    for (int p = 0; p < count && value; p++) {
        struct parameter_sums *parameter = find_parameter(s, cell, &value[p]);
        if (parameter)
            add_value(parameter, &value[p], study_run_truth(run, value[p].name));
    }
    pool_close(&scratch);
    if (run->diagnosis)
        add_diagnosis(s, cell, run);
}

static int compare(const void *left, const void *right)
{
    const struct objective *a = left, *b = right;
    if (a->replicate != b->replicate)
        return a->replicate < b->replicate ? -1 : 1;
    return isnan(a->value) ? !isnan(b->value) : isnan(b->value) ? -1 : (a->value > b->value) - (a->value < b->value);
}

/* How many of the starts of a replicate came to the best objective that any of them found. */
static int count_reached(struct cell_sums *cell)
{
    double best = NAN;
    int reached = 0;
    if (cell->nobjective > 1)
        qsort(cell->objective, (size_t)cell->nobjective, sizeof *cell->objective, compare);
    for (int i = 0; i < cell->nobjective; i++) {
        const struct objective *now = &cell->objective[i];
        if (!i || now->replicate != cell->objective[i - 1].replicate)
            best = now->value;
        reached += now->value <= best + SAME_OBJECTIVE * fabs(best) + NO_OBJECTIVE;
    }
    return reached;
}

static double share(double sum, int count)
{
    return count ? sum / (double)count : NAN;
}

static struct cell_parameter finish_parameter(const struct parameter_sums *p)
{
    struct cell_parameter said = p->said;
    double n = p->errors;
    said.mean = said.count ? said.mean : NAN;
    said.std = said.count > 1 ? sqrt(p->square / (double)(said.count - 1)) : NAN;
    said.mean_stated_std = share(p->std_sum, p->stds);
    said.bias = share(p->error_sum, p->errors);
    said.std_error = p->errors > 1 ? sqrt(fmax(0, p->error_square - n * said.bias * said.bias) / (n - 1)) : NAN;
    said.rms_error = sqrt(share(p->error_square, p->errors));
    said.coverage95 = share(p->covered, said.intervals);
    return said;
}

static struct study_cell_result finish_cell(struct sums *s, struct cell_sums *cell)
{
    struct study_cell_result said = cell->said;
    said.reached_best = cell->last_start ? count_reached(cell) : ROTID_NONE;
    said.parameters = POOL_ARRAY(s->pool, struct cell_parameter, cell->nparameter);
    for (int p = 0; p < cell->nparameter && said.parameters; p++)
        said.parameters[said.nparameters++] = finish_parameter(&cell->parameter[p]);
    said.frequency_rms_percent = sqrt(share(cell->fitted_square, cell->fitted));
    said.holdout_frequency_rms_percent = sqrt(share(cell->held_out_square, cell->held_out));
    said.chi2_per_dof = share(cell->chi2_sum, cell->chi2s);
    said.evaluations = share(cell->evaluations, said.runs - said.failed);
    if (cell->diagnoses.count) {
        said.diagnoses = POOL_NEW(s->pool, struct cell_diagnoses);
        if (!cell->scored)
            cell->diagnoses.scores[0] = cell->diagnoses.false_findings = ROTID_NONE;
        if (said.diagnoses)
            *said.diagnoses = cell->diagnoses;
    }
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
    char *text = malloc(file->most + 1);
    int status = text ? ROTID_OK : ROTID_ERROR_MEMORY;
    for (long run = 0; run < file->header.runs && !status; run++) {
        struct pool own, *of = runs ? pool : &own; /* the table keeps its texts */
        struct study_run said;
        out->runs += run % file->shards == file->shard - 1;
        if (!file->place[run].length)
            continue;
        status = results_fetch(file->place[run], text);
        if (status)
            message_add(messages, SEVERITY_ERROR, file->path, 1, 1, "reading failed: %s", strerror(errno));
        pool_open(&own, NULL);
        if (!status)
            status = results_line_read(of, text, file->place[run].length, &said) ? ROTID_ERROR_MEMORY : ROTID_OK;
        if (!status)
            add_run(&sums, &said);
        if (!status && runs)
            table_add_run(runs, &said);
        pool_close(&own);
        status = pool->out_of_memory ? ROTID_ERROR_MEMORY : status;
    }
    free(text);
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
