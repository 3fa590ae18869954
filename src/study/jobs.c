/* The jobs behind a run: a deck is read with what its cell changes in it, as overrides, and with what the plan hides, as a card.
 */
#include "study/study.h"

/* The overrides of a cell with the noise that the deck is to state, the user's first: what the plan varies it varies. NULL where
 * memory is out. */
static struct override *overrides(struct pool *pool, const struct study *study, const struct study_cell *cell,
                                  const struct plan_item *noise, int *count)
{
    const struct plan_item *variant = plan_at(study->plan, cell, AXIS_VARIANT), *modes = plan_at(study->plan, cell, AXIS_MODES);
    const double stated[] = {noise ? noise->frequency : 0, noise ? noise->shape : 0};
    static const char *const blocks[] = {"FREQUENCY", "SHAPE"};
    struct override *list = POOL_COPY(pool, study->override, study->noverride, variant->noverride + 4);
    *count = study->noverride;
    if (!list)
        return NULL;
    for (int i = 0; i < variant->noverride; i++)
        list[(*count)++] = variant->override[i];
    if (modes->name)
        list[(*count)++] = (struct override){"FIT", "MODES", modes->name, modes->name, NULL};
    for (int i = 0; i < 2; i++)
        if (stated[i] > 0)
            list[(*count)++] = (struct override){"NOISE", blocks[i], pool_format(pool, "%.17g", stated[i]), "noise", NULL};
    return pool->out_of_memory ? NULL : list;
}

/* Whether data with this noise need it stated to the deck, whose functional follows what is known. */
static int lacks_noise(const struct states *states, const struct plan_item *noise)
{
    int lacks = 0;
    for (int s = 0; s < states->nstate; s++) {
        const struct job *job = &states->state[s].job;
        lacks |= (noise->frequency > 0 && !job_knows_frequency_noise(job)) ||
                 (noise->shape > 0 && job->measurement.shape && !job_knows_shape_noise(job));
    }
    return lacks;
}

/* functional: NULL, or in place of that of the deck. */
static int read_states(struct pool *pool, const struct study *study, const struct study_cell *cell, const struct plan_item *noise,
                       const char *functional, struct message_list *messages, struct states *states)
{
    int count;
    struct override *list = overrides(pool, study, cell, noise, &count);
    if (list && functional)
        list[count++] = (struct override){"FIT", "FUNCTIONAL", functional, "", NULL};
    return list ? deck_read_states(pool, plan_at(study->plan, cell, AXIS_DECK)->path, NULL, count, list, messages, states)
                : ROTID_ERROR_MEMORY;
}

int jobs_read_fitted(struct pool *pool, const struct study *study, const struct study_cell *cell, struct message_list *messages,
                     struct states *states)
{
    const struct plan_item *noise = plan_at(study->plan, cell, AXIS_NOISE);
    *states = (struct states){0};
    int status = read_states(pool, study, cell, NULL, NULL, messages, states), bare_status = ROTID_OK;
    if (!noise->name || status == ROTID_ERROR_MEMORY || (!status && !lacks_noise(states, noise)))
        return status;
    struct states bare = *states; /* what it knows of noise itself */
    struct message_list unheard;
    message_open(&unheard, pool);
    if (status) /* by a functional that needs none */
        bare_status = read_states(pool, study, cell, NULL, "HYBRID", &unheard, &bare);
    if (bare_status == ROTID_ERROR_MEMORY)
        return bare_status;
    message_open(messages, messages->pool);
    status = read_states(pool, study, cell, noise, NULL, messages, states);
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

double *truth_value(struct truth *truth, int p)
{
    return truth->effect ? &truth->effect->value[p] : correction_value(&truth->fault, p);
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

/* A component of a shape for a deck that has none: the plan makes them, and a fault of a sensor is one of shapes. NULL where
 * memory is out. */
static const struct card *shape_card(struct pool *pool, const struct job *job)
{
    const char *words = pool_format(pool, "*SHAPE, MODE=%d\n%d, 1\n", job->measurement.number[0], job->rotor.sensor[0].id);
    struct deck_text text = {.ncard = 0};
    if (words)
        deck_text_read_piece(pool, strlen(words), words, &text);
    return text.card;
}

static int makes_shapes(const struct plan *plan)
{
    int makes = 0;
    for (int n = 0; n < plan->axis[AXIS_NOISE].count; n++)
        makes |= !isnan(plan->axis[AXIS_NOISE].item[n].shape);
    return makes && plan->shapes;
}

/* What a state has with the effect of a plan hidden in it, between two values. */
static int hide(const struct plan_item *hidden, struct job *lower, const struct job *upper, struct message_list *messages,
                struct truth *truth)
{
    truth->cause = catalogue_find(card_option(hidden->end[0], "TYPE")->value);
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
            return message_refuse_at(messages, ROTID_ERROR_SYNTAX, hidden->place,
                                     "%s lies between %.6g and %.6g, expected the lower one first",
                                     truth_parameter(truth, p)->name, truth->lower[p], truth->upper[p]);
    return ROTID_OK;
}

int jobs_read_truth(struct pool *pool, const struct study *study, const struct study_cell *cell, struct message_list *messages,
                    struct truth **truths)
{
    const struct plan *plan = study->plan;
    const struct plan_item *hidden = plan_at(plan, cell, AXIS_HIDE);
    /* no variant, no modes; with a noise: the job makes data and is not fitted, and its FIT or a hidden noise_level may need one
     */
    const struct study_cell bare = {{[AXIS_DECK] = cell->at[AXIS_DECK], [AXIS_VARIANT] = -1, [AXIS_MODES] = -1}};
    const char *path = plan_at(plan, cell, AXIS_DECK)->path;
    int count, ncard = 1;
    struct override *list = overrides(pool, study, &bare, plan_at(plan, &bare, AXIS_NOISE), &count);
    struct card card[2];
    struct states states = {0}, with[2];
    int status = list ? deck_read_states(pool, path, NULL, count, list, messages, &states) : ROTID_ERROR_MEMORY;
    struct truth *truth = *truths = POOL_ARRAY(pool, struct truth, states.nstate);
    if (!status && !truth)
        status = ROTID_ERROR_MEMORY;
    for (int s = 0; s < states.nstate && !status; s++)
        truth[s].job = states.state[s].job;
    if (status || !hidden->end[0])
        return status;
    const struct job *first = &truth[0].job;
    if (states.nstate == 1 && !first->measurement.shape && first->rotor.nsensor && first->measurement.nmode &&
        makes_shapes(plan)) {
        const struct card *shape = shape_card(pool, first);
        if (!shape)
            return ROTID_ERROR_MEMORY;
        card[ncard++] = *shape;
    }
    for (int end = 0; end < 2 && !status; end++) {
        card[0] = *hidden->end[end];
        status = deck_read_with(pool, path, NULL, count, list, ncard, card, messages, &with[end]);
    }
    for (int s = 0; s < states.nstate && !status; s++)
        status = hide(hidden, &with[0].state[s].job, &with[1].state[s].job, messages, &truth[s]);
    return status;
}

void jobs_open(const struct study *study, struct jobs *jobs)
{
    *jobs = (struct jobs){.study = study};
    pool_open(&jobs->fitted.pool, NULL);
    pool_open(&jobs->truth.pool, NULL);
}

void jobs_close(struct jobs *jobs)
{
    pool_close(&jobs->fitted.pool);
    pool_close(&jobs->truth.pool);
}

/* What is kept becomes that of the cell, unless it is that of one with the same entries of `count` axes. */
static int keep(struct jobs *jobs, struct kept_jobs *kept, const struct study_cell *cell, int count, const enum plan_axis *axis,
                struct message_list *messages)
{
    int same = kept->has;
    for (int i = 0; i < count; i++)
        same &= kept->of.at[axis[i]] == cell->at[axis[i]];
    if (!same) {
        pool_close(&kept->pool);
        pool_open(&kept->pool, NULL);
        message_open(&kept->messages, &kept->pool);
        kept->status = kept == &jobs->truth ? jobs_read_truth(&kept->pool, jobs->study, cell, &kept->messages, &kept->truth)
                                            : jobs_read_fitted(&kept->pool, jobs->study, cell, &kept->messages, &kept->fitted);
        kept->of = *cell;
        kept->has = 1;
    }
    for (size_t i = 0; i < kept->messages.count && kept->status; i++) {
        const rotid_message *m = &kept->messages.item[i];
        message_at(messages, (enum severity)m->severity, *m, "%s", m->text);
    }
    return kept->status;
}

int jobs_fitted(struct jobs *jobs, const struct study_cell *cell, struct message_list *messages, const struct states **states)
{
    static const enum plan_axis axis[] = {AXIS_DECK, AXIS_VARIANT, AXIS_MODES, AXIS_NOISE};
    *states = &jobs->fitted.fitted;
    return keep(jobs, &jobs->fitted, cell, 4, axis, messages);
}

int jobs_truth(struct jobs *jobs, const struct study_cell *cell, struct message_list *messages, struct truth **truth)
{
    static const enum plan_axis axis[] = {AXIS_DECK, AXIS_HIDE};
    int status = keep(jobs, &jobs->truth, cell, 2, axis, messages);
    *truth = jobs->truth.truth;
    return status;
}
