#include "study/jobs.h"

#include <math.h>
#include <string.h>

#include "deck/deck.h"
#include "diagnose/causes/catalogue.h"

/* The overrides of a cell, the user's first: what the plan varies it varies. */
static struct override *overrides(struct pool *pool, const struct study *study, const struct study_cell *cell, int noise,
                                  int *count)
{
    const struct plan *plan = study->plan;
    const struct plan_variant *variant = cell ? &plan->variant[cell->variant] : NULL;
    const struct plan_modes *modes = cell ? &plan->modes[cell->modes] : NULL;
    struct override *list = POOL_ARRAY(pool, struct override, study->noverride + (variant ? variant->noverride : 0) + 4);
    *count = study->noverride;
    if (!list)
        return NULL;
    if (study->noverride)
        memcpy(list, study->override, (size_t)study->noverride * sizeof *list);
    for (int i = 0; variant && i < variant->noverride; i++)
        list[(*count)++] = variant->override[i];
    if (modes && modes->text)
        list[(*count)++] = (struct override){"FIT", "MODES", modes->text, modes->text, NULL};
    if (noise >= 0) {
        const struct plan_noise *stated = &plan->noise[noise];
        if (stated->frequency > 0)
            list[(*count)++] =
                (struct override){"NOISE", "FREQUENCY", pool_format(pool, "%.17g", stated->frequency), "noise", NULL};
        if (stated->shape > 0)
            list[(*count)++] = (struct override){"NOISE", "SHAPE", pool_format(pool, "%.17g", stated->shape), "noise", NULL};
    }
    for (int i = 0; i < *count; i++)
        if (!list[i].value)
            return NULL;
    return list;
}

/* Whether data with this noise need it stated to the deck, whose functional follows what is known. */
static int lacks_noise(const struct job *job, const struct plan_noise *noise)
{
    return (noise->frequency > 0 && !job_knows_frequency_noise(job)) ||
           (noise->shape > 0 && job->measurement.shape && !job_knows_shape_noise(job));
}

/* The deck by a functional that needs no noise: what it knows of that itself. */
static int read_bare(struct pool *pool, const struct study *study, const struct study_cell *cell, struct job *bare)
{
    struct message_list unheard;
    int count;
    struct override *list = overrides(pool, study, cell, -1, &count);
    message_open(&unheard, pool);
    if (!list)
        return ROTID_ERROR_MEMORY;
    list[count++] = (struct override){"FIT", "FUNCTIONAL", "HYBRID", "", NULL};
    return deck_read(pool, study->plan->deck[cell->deck].path, count, list, &unheard, bare);
}

int jobs_read_fitted(struct pool *pool, const struct study *study, const struct study_cell *cell, struct message_list *messages,
                     struct job *job)
{
    const char *path = study->plan->deck[cell->deck].path;
    int count;
    struct override *list = overrides(pool, study, cell, -1, &count);
    int status = list ? deck_read(pool, path, count, list, messages, job) : ROTID_ERROR_MEMORY;
    if (!study->plan->has_noise || status == ROTID_ERROR_MEMORY ||
        (!status && !lacks_noise(job, &study->plan->noise[cell->noise])))
        return status;
    struct job bare = *job;
    int bare_status = status ? read_bare(pool, study, cell, &bare) : ROTID_OK;
    if (bare_status == ROTID_ERROR_MEMORY)
        return bare_status;
    message_open(messages, messages->pool);
    list = overrides(pool, study, cell, cell->noise, &count);
    status = list ? deck_read(pool, path, count, list, messages, job) : ROTID_ERROR_MEMORY;
    if (!status && !bare_status) { /* the noise of the plan is added to this one */
        job->measurement.frequency_std = bare.measurement.frequency_std;
        job->measurement.shape_std = bare.measurement.shape_std;
    }
    return status;
}

const struct effect_parameter_name *truth_parameter(const struct truth *truth, int p)
{
    if (!truth->cause)
        return NULL;
    if (truth->effect)
        return p < effect_parameters(truth->effect) ? &truth->effect->kind->parameter[p] : NULL;
    return p == 0 && truth->cause->value.name ? &truth->cause->value : NULL;
}

/* Values of the hidden effect as the card behind the deck gives them. */
static void take_values(const struct job *job, struct truth *truth, double *value)
{
    if (truth->effect)
        memcpy(value, job->rotor.effect[job->rotor.neffect - 1].value, sizeof truth->lower);
    else if (job->measurement.ncorrection)
        value[0] = job->measurement.correction[job->measurement.ncorrection - 1].value;
}

/* A component of a shape for a deck that has none: the plan makes them, and a fault of a sensor is one of shapes. */
static struct card *shape_card(struct pool *pool, const struct job *job, struct place place)
{
    struct card *card = POOL_NEW(pool, struct card);
    struct card_option *option = POOL_NEW(pool, struct card_option);
    struct data_line *line = POOL_NEW(pool, struct data_line);
    struct field *field = POOL_ARRAY(pool, struct field, 2);
    if (!card || !option || !line || !field)
        return NULL;
    field[0] = (struct field){pool_format(pool, "%d", job->rotor.sensor[0].id), place, 0};
    field[1] = (struct field){"1", place, 0};
    *line = (struct data_line){.place = place, .end = place, .text = "", .count = 2, .field = field};
    *option = (struct card_option){
        .name = "MODE", .value = pool_format(pool, "%d", job->measurement.number[0]), .place = place, .value_place = place};
    *card = (struct card){.name = "SHAPE", .place = place, .noption = 1, .nline = 1, .option = option, .line = line};
    return field[0].text && option->value ? card : NULL;
}

static int makes_shapes(const struct plan *plan)
{
    int makes = 0;
    for (int n = 0; n < plan->nnoise; n++)
        makes |= !isnan(plan->noise[n].shape);
    return makes && !plan->no_shapes;
}

int jobs_read_truth(struct pool *pool, const struct study *study, int deck, int hide, struct message_list *messages,
                    struct truth *truth)
{
    const struct plan *plan = study->plan;
    const struct plan_hide *hidden = &plan->hide[hide];
    const char *path = plan->deck[deck].path;
    int count,
        ncard = 1; /* with a noise: the job makes data and is not fitted, and its FIT or a hidden noise_level may need one */
    struct override *list = overrides(pool, study, NULL, plan->has_noise ? 0 : -1, &count);
    struct card card[2];
    *truth = (struct truth){0};
    int status = list ? deck_read(pool, path, count, list, messages, &truth->job) : ROTID_ERROR_MEMORY;
    if (status || !hidden->lower)
        return status;
    if (!truth->job.measurement.shape && truth->job.rotor.nsensor && truth->job.measurement.nmode && makes_shapes(plan)) {
        struct card *shape = shape_card(pool, &truth->job, hidden->place);
        if (!shape)
            return ROTID_ERROR_MEMORY;
        card[ncard++] = *shape;
    }
    struct job lower, upper;
    card[0] = *hidden->lower;
    status = deck_read_with(pool, path, count, list, ncard, card, messages, &lower);
    card[0] = *hidden->upper;
    if (!status)
        status = deck_read_with(pool, path, count, list, ncard, card, messages, &upper);
    if (status)
        return status;
    truth->cause = catalogue_find(card_option(hidden->lower, "TYPE")->value);
    if (truth->cause->class == CAUSE_PHYSICAL) { /* else the deck as it stands: the fault is put into the data of the model */
        truth->job = lower;
        truth->effect = &truth->job.rotor.effect[truth->job.rotor.neffect - 1];
    } else {
        truth->fault = lower.measurement.correction[lower.measurement.ncorrection - 1];
    }
    take_values(&lower, truth, truth->lower);
    take_values(&upper, truth, truth->upper);
    for (int p = 0; truth_parameter(truth, p); p++)
        if (truth->upper[p] < truth->lower[p]) {
            message_add(messages, SEVERITY_ERROR, hidden->place.file, hidden->place.line, hidden->place.column,
                        "%s lies between %.6g and %.6g, expected the lower one first", truth_parameter(truth, p)->name,
                        truth->lower[p], truth->upper[p]);
            status = ROTID_ERROR_SYNTAX;
        }
    return status;
}

void jobs_open(const struct study *study, struct jobs *jobs)
{
    *jobs = (struct jobs){.study = study};
    pool_open(&jobs->fitted_pool, NULL);
    pool_open(&jobs->truth_pool, NULL);
}

void jobs_close(struct jobs *jobs)
{
    pool_close(&jobs->fitted_pool);
    pool_close(&jobs->truth_pool);
}

static int is_same(const struct study_cell *a, const struct study_cell *b)
{
    return a->deck == b->deck && a->variant == b->variant && a->modes == b->modes && a->noise == b->noise;
}

int jobs_fitted(struct jobs *jobs, const struct study_cell *cell, const struct job **job)
{
    int status = ROTID_OK;
    if (!jobs->has_fitted || !is_same(&jobs->fitted_of, cell)) {
        pool_close(&jobs->fitted_pool);
        message_open(&jobs->fitted_messages, &jobs->fitted_pool);
        status = jobs_read_fitted(&jobs->fitted_pool, jobs->study, cell, &jobs->fitted_messages, &jobs->fitted);
        jobs->fitted_of = *cell;
        jobs->has_fitted = status ? -1 : 1;
    }
    *job = &jobs->fitted;
    return jobs->has_fitted > 0 ? ROTID_OK : status ? status : ROTID_ERROR_SYNTAX;
}

int jobs_truth(struct jobs *jobs, const struct study_cell *cell, struct truth **truth)
{
    int status = ROTID_OK;
    if (!jobs->has_truth || jobs->truth_of.deck != cell->deck || jobs->truth_of.hide != cell->hide) {
        pool_close(&jobs->truth_pool);
        message_open(&jobs->truth_messages, &jobs->truth_pool);
        status = jobs_read_truth(&jobs->truth_pool, jobs->study, cell->deck, cell->hide, &jobs->truth_messages, &jobs->truth);
        jobs->truth_of = *cell;
        jobs->has_truth = status ? -1 : 1;
    }
    *truth = &jobs->truth;
    return jobs->has_truth > 0 ? ROTID_OK : status ? status : ROTID_ERROR_SYNTAX;
}
