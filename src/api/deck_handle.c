/* A deck for hosts: read once, then only read from. */
#include "api/deck_handle.h"

#include <math.h>

#include "base/host.h"
#include "deck/deck.h"
#include "model/model.h"

struct deck_handle {
    struct pool *own;
    int usable; /* without errors */
    struct job job;
};

static int parse_overrides(struct pool *own, int count, const char *const *text, struct message_list *messages,
                           struct override *override)
{
    for (int i = 0; i < count; i++) {
        const char *copy = pool_copy_text(own, text[i]); /* parts of it become part of the job */
        int status = copy ? override_parse(own, copy, &override[i]) : ROTID_ERROR_MEMORY;
        if (status == ROTID_ERROR_SYNTAX)
            message_add(messages, SEVERITY_ERROR, NULL, 0, 0, "override %s: expected CARD.OPTION=VALUE", copy);
        if (status)
            return status;
        override[i].text = copy;
    }
    return ROTID_OK;
}

/* Mass and its centre at the start of the parameters. */
static int weigh(const struct job *job, const rotid_environment *environment, rotid_deck *deck)
{
    struct pool scratch;
    struct mass_properties properties;
    pool_open(&scratch, environment ? environment->allocator : NULL);
    double *x = POOL_ARRAY(&scratch, double, job->unknowns.nparameter);
    for (int p = 0; p < job->unknowns.nparameter && x; p++)
        x[p] = job->unknowns.bounds[p].start;
    int status =
        x ? model_weigh(&scratch, job->models, &job->rotor, job->unknowns.nparameter, job->unknowns.parameter, x, &properties)
          : ROTID_ERROR_MEMORY;
    if (!status) {
        deck->length = rotor_length(&job->rotor);
        deck->mass = properties.mass;
        deck->centre = properties.center;
    }
    pool_close(&scratch);
    return status;
}

/* The job lives as long as the deck: what it holds as arrays is not copied. */
static void show(const struct job *job, struct pool *own, rotid_deck *deck)
{
    int nsensor = job->rotor.nsensor, *id = POOL_ARRAY(own, int, nsensor);
    double *z = POOL_ARRAY(own, double, nsensor), *stated = POOL_ARRAY(own, double, job->unknowns.nparameter);
    for (int s = 0; s < nsensor && id && z; s++) {
        id[s] = job->rotor.sensor[s].id;
        z[s] = job->rotor.sensor[s].position;
    }
    for (int p = 0; p < job->unknowns.nparameter && stated; p++)
        stated[p] = *parameter_value(&job->rotor, job->unknowns.parameter[p]);
    deck->nsensor = nsensor;
    deck->sensor_id = id;
    deck->sensor_z = z;
    deck->nmode = job->measurement.nmode;
    deck->number = job->measurement.number;
    deck->frequency_hz = job->measurement.frequency_hz;
    deck->frequency_std = job->measurement.frequency_std;
    deck->shape = job->measurement.shape;
    deck->shape_std = job->measurement.shape ? job->measurement.shape_std : NULL;
    deck->holdout = job->measurement.holdout;
    deck->nparameter = job->unknowns.nparameter;
    deck->parameter = job->unknowns.bounds;
    deck->stated = stated;
    deck->nheading = job->nheading;
    deck->heading = job->heading;
    deck->nreferences = job->nreference;
    deck->references = job->reference;
}

static int read_deck(struct pool *own, const struct deck_memory *memory, const char *path, int noverride, const char *const *text,
                     struct call *call, rotid_deck *deck)
{
    struct message_list *messages = &call->notes;
    message_open(messages, own); /* they stay with the deck */
    struct deck_handle *handle = POOL_NEW(own, struct deck_handle);
    struct override *override = POOL_ARRAY(own, struct override, noverride);
    if (!handle || !override)
        return ROTID_ERROR_MEMORY;
    *handle = (struct deck_handle){.own = own};
    deck->memory = handle;
    deck->path = pool_copy_text(own, path);
    deck->length = deck->mass = deck->centre = NAN;
    int status = parse_overrides(own, noverride, text, messages, override);
    if (!status)
        status = memory ? deck_read_memory(own, memory, noverride, override, messages, &handle->job)
                        : deck_read(own, path, noverride, override, messages, &handle->job);
    if (!status)
        status = weigh(&handle->job, &call->environment, deck);
    if (!status)
        show(&handle->job, own, deck);
    handle->usable = status == ROTID_OK;
    deck->nmessage = (int)messages->count;
    deck->nerror = messages->errors;
    deck->message = messages->item;
    return own->out_of_memory ? ROTID_ERROR_MEMORY : status;
}

static int make_deck(struct call *call, const struct deck_memory *memory, const char *path, int noverride,
                     const char *const *override, rotid_deck **deck)
{
    if (noverride < 0)
        return refuse(call->entry.failure, "noverride is %d, expected 0 or more", noverride);
    if (noverride && !override)
        return refuse(call->entry.failure, "override is NULL, expected noverride = %d texts", noverride);
    for (int i = 0; i < noverride; i++)
        if (!override[i])
            return refuse(call->entry.failure, "override[%d] is NULL, expected CARD.OPTION=VALUE", i);
    struct pool *own = pool_new(call->environment.allocator);
    rotid_deck *made = own ? POOL_NEW(own, rotid_deck) : NULL;
    int status = made ? read_deck(own, memory, path, noverride, override, call, made) : ROTID_ERROR_MEMORY;
    if (status == ROTID_ERROR_MEMORY) {
        message_open(&call->notes, &call->entry.scratch);
        pool_free(own);
    } else {
        *deck = made;
    }
    return status;
}

int rotid_deck_read(const char *path, int noverride, const char *const *override, const rotid_environment *environment,
                    char *failure, rotid_deck **deck)
{
    struct call call;
    int status = call_open(&call, environment, failure, deck, "deck");
    if (!deck)
        return call_close(&call, status);
    *deck = NULL;
    if (!status && !path)
        status = refuse(failure, "path is NULL, expected that of a deck");
    if (!status)
        status = make_deck(&call, NULL, path, noverride, override, deck);
    return call_close(&call, status);
}

int rotid_deck_read_text(size_t length, const char *text, const char *name, const char *directory, int noverride,
                         const char *const *override, const rotid_environment *environment, char *failure, rotid_deck **deck)
{
    struct call call;
    const struct deck_memory memory = {name ? name : "deck", length, text, directory};
    int status = call_open(&call, environment, failure, deck, "deck");
    if (!deck)
        return call_close(&call, status);
    *deck = NULL;
    if (!status && length && !text)
        status = refuse(failure, "text is NULL, expected %zu characters", length);
    if (!status)
        status = make_deck(&call, &memory, memory.name, noverride, override, deck);
    return call_close(&call, status);
}

void rotid_deck_free(rotid_deck *deck)
{
    if (deck)
        pool_free(((struct deck_handle *)deck->memory)->own);
}

const struct job *deck_job_of(const rotid_deck *deck)
{
    const struct deck_handle *handle = deck ? deck->memory : NULL;
    return handle && handle->usable ? &handle->job : NULL;
}

const struct job *deck_job(const rotid_deck *deck, struct call *call)
{
    const struct deck_handle *handle = deck ? deck->memory : NULL;
    if (handle && handle->usable)
        return &handle->job;
    for (int i = 0; handle && i < deck->nmessage; i++)
        if (deck->message[i].severity == ROTID_ERROR) {
            const rotid_message *m = &deck->message[i];
            message_add(&call->notes, SEVERITY_ERROR, m->file, m->line, m->column, "%s", m->text);
            return NULL;
        }
    message_add(&call->notes, SEVERITY_ERROR, NULL, 0, 0, "there is no deck to work on, expected one without errors");
    return NULL;
}
