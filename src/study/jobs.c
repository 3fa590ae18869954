#include "study/study.h"

#include <math.h>
#include <string.h>

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
static int lacks_noise(const struct states *states, const struct plan_noise *noise)
{
    int lacks = 0;
    for (int s = 0; s < states->nstate; s++) {
        const struct job *job = &states->state[s].job;
        lacks |= (noise->frequency > 0 && !job_knows_frequency_noise(job)) ||
                 (noise->shape > 0 && job->measurement.shape && !job_knows_shape_noise(job));
    }
    return lacks;
}

static int read_states(struct pool *pool, const struct study *study, const struct study_cell *cell, int count,
                       const struct override *list, struct message_list *messages, struct states *states)
{
    return list ? deck_read_states(pool, study->plan->deck[cell->deck].path, NULL, count, list, messages, states)
                : ROTID_ERROR_MEMORY;
}

/* The deck by a functional that needs no noise: what it knows of that itself. */
static int read_bare(struct pool *pool, const struct study *study, const struct study_cell *cell, struct states *bare)
{
    struct message_list unheard;
    int count;
    struct override *list = overrides(pool, study, cell, -1, &count);
    message_open(&unheard, pool);
    if (!list)
        return ROTID_ERROR_MEMORY;
    list[count++] = (struct override){"FIT", "FUNCTIONAL", "HYBRID", "", NULL};
    return read_states(pool, study, cell, count, list, &unheard, bare);
}

int jobs_read_fitted(struct pool *pool, const struct study *study, const struct study_cell *cell, struct message_list *messages,
                     struct states *states)
{
    int count;
    struct override *list = overrides(pool, study, cell, -1, &count);
    *states = (struct states){0};
    int status = read_states(pool, study, cell, count, list, messages, states);
    if (!study->plan->has_noise || status == ROTID_ERROR_MEMORY ||
        (!status && !lacks_noise(states, &study->plan->noise[cell->noise])))
        return status;
    struct states bare = *states;
    int bare_status = status ? read_bare(pool, study, cell, &bare) : ROTID_OK;
    if (bare_status == ROTID_ERROR_MEMORY)
        return bare_status;
    message_open(messages, messages->pool);
    list = overrides(pool, study, cell, cell->noise, &count);
    status = read_states(pool, study, cell, count, list, messages, states);
    for (int s = 0; s < states->nstate && !status && !bare_status; s++) { /* the noise of the plan is added to this one */
        states->state[s].job.measurement.frequency_std = bare.state[s].job.measurement.frequency_std;
        states->state[s].job.measurement.shape_std = bare.state[s].job.measurement.shape_std;
    }
    return status;
}

const struct effect_parameter_name *truth_parameter(const struct truth *truth, int p)
{
    if (!truth->cause)
        return NULL;
    if (truth->effect)
        return p < effect_parameters(truth->effect) ? &truth->effect->kind->parameter[p] : NULL;
    return correction_parameter(truth->cause, p);
}

/* Values of the hidden effect as the card behind the deck gives them. */
static void take_values(const struct job *job, struct truth *truth, double *value)
{
    if (truth->effect)
        memcpy(value, job->rotor.effect[job->rotor.neffect - 1].value, sizeof truth->lower);
    else if (job->measurement.ncorrection)
        for (int p = 0; correction_parameter(truth->cause, p); p++)
            value[p] = *correction_value(&job->measurement.correction[job->measurement.ncorrection - 1], p);
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

/* What a state has with the effect of a plan hidden in it, between two values. */
static int hide(const struct plan_hide *hidden, struct job *lower, const struct job *upper, struct message_list *messages,
                struct truth *truth)
{
    truth->cause = catalogue_find(card_option(hidden->lower, "TYPE")->value);
    if (truth->cause->class == CAUSE_PHYSICAL) { /* else the deck as it stands: the fault is put into the data of the model */
        truth->job = *lower;
        truth->effect = &truth->job.rotor.effect[truth->job.rotor.neffect - 1];
    } else {
        truth->fault = lower->measurement.correction[lower->measurement.ncorrection - 1];
    }
    take_values(lower, truth, truth->lower);
    take_values(upper, truth, truth->upper);
    for (int p = 0; truth_parameter(truth, p); p++)
        if (truth->upper[p] < truth->lower[p])
            return message_refuse(messages, ROTID_ERROR_SYNTAX, hidden->place.file, hidden->place.line, hidden->place.column,
                                  "%s lies between %.6g and %.6g, expected the lower one first", truth_parameter(truth, p)->name,
                                  truth->lower[p], truth->upper[p]);
    return ROTID_OK;
}

int jobs_read_truth(struct pool *pool, const struct study *study, int deck, int hide_index, struct message_list *messages,
                    struct truth **truths)
{
    const struct plan *plan = study->plan;
    const struct plan_hide *hidden = &plan->hide[hide_index];
    const char *path = plan->deck[deck].path;
    int count,
        ncard = 1; /* with a noise: the job makes data and is not fitted, and its FIT or a hidden noise_level may need one */
    struct override *list = overrides(pool, study, NULL, plan->has_noise ? 0 : -1, &count);
    struct card card[2];
    struct states states = {0}, lower, upper;
    int status = list ? deck_read_states(pool, path, NULL, count, list, messages, &states) : ROTID_ERROR_MEMORY;
    struct truth *truth = *truths = POOL_ARRAY(pool, struct truth, states.nstate);
    if (!status && !truth)
        status = ROTID_ERROR_MEMORY;
    for (int s = 0; s < states.nstate && !status; s++)
        truth[s].job = states.state[s].job;
    if (status || !hidden->lower)
        return status;
    const struct job *first = &truth[0].job;
    if (states.nstate == 1 && !first->measurement.shape && first->rotor.nsensor && first->measurement.nmode &&
        makes_shapes(plan)) {
        struct card *shape = shape_card(pool, first, hidden->place);
        if (!shape)
            return ROTID_ERROR_MEMORY;
        card[ncard++] = *shape;
    }
    card[0] = *hidden->lower;
    status = deck_read_with(pool, path, count, list, ncard, card, messages, &lower);
    card[0] = *hidden->upper;
    if (!status)
        status = deck_read_with(pool, path, count, list, ncard, card, messages, &upper);
    for (int s = 0; s < states.nstate && !status; s++)
        status = hide(hidden, &lower.state[s].job, &upper.state[s].job, messages, &truth[s]);
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

int jobs_fitted(struct jobs *jobs, const struct study_cell *cell, const struct states **states)
{
    int status = ROTID_OK;
    if (!jobs->has_fitted || !is_same(&jobs->fitted_of, cell)) {
        pool_close(&jobs->fitted_pool);
        pool_open(&jobs->fitted_pool, NULL);
        message_open(&jobs->fitted_messages, &jobs->fitted_pool);
        status = jobs_read_fitted(&jobs->fitted_pool, jobs->study, cell, &jobs->fitted_messages, &jobs->fitted);
        jobs->fitted_of = *cell;
        jobs->has_fitted = status ? -1 : 1;
    }
    *states = &jobs->fitted;
    return jobs->has_fitted > 0 ? ROTID_OK : status ? status : ROTID_ERROR_SYNTAX;
}

int jobs_truth(struct jobs *jobs, const struct study_cell *cell, struct truth **truth)
{
    int status = ROTID_OK;
    if (!jobs->has_truth || jobs->truth_of.deck != cell->deck || jobs->truth_of.hide != cell->hide) {
        pool_close(&jobs->truth_pool);
        pool_open(&jobs->truth_pool, NULL);
        message_open(&jobs->truth_messages, &jobs->truth_pool);
        status = jobs_read_truth(&jobs->truth_pool, jobs->study, cell->deck, cell->hide, &jobs->truth_messages, &jobs->truth);
        jobs->truth_of = *cell;
        jobs->has_truth = status ? -1 : 1;
    }
    *truth = jobs->truth;
    return jobs->has_truth > 0 ? ROTID_OK : status ? status : ROTID_ERROR_SYNTAX;
}
