/* A deck for hosts: read once, then only read from. */
#include "api/deck_handle.h"

#include <math.h>

#include "api/holding.h"
#include "base/host.h"
#include "beam/effects.h"
#include "deck/deck.h"

struct deck_handle {
    struct holding *holding;
    int usable; /* without errors */
    struct job job;
};

static int parse_overrides(struct holding *holding, int count, const char *const *text, struct message_list *messages,
                           struct override *override)
{
    for (int i = 0; i < count; i++) {
        const char *copy = holding_text(holding, text[i]); /* parts of it become part of the job */
        int status = copy ? override_parse(&holding->pool, copy, &override[i]) : ROTID_ERROR_MEMORY;
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
    struct beam beam;
    struct mass_properties properties;
    int failed;
    pool_open(&scratch, environment ? environment->allocator : NULL);
    int status = beam_build(&scratch, &job->rotor, job->nparameter, job->parameter, 1, &beam, &failed);
    if (!status) {
        for (int p = 0; p < job->nparameter; p++)
            *parameter_value(&beam.rotor, job->parameter[p]) = job->bounds[p].start;
        effects_refresh(&beam);
        beam_mass_properties(&beam, &properties);
        deck->length = rotor_length(&job->rotor);
        deck->mass = properties.mass;
        deck->centre = properties.center;
    }
    pool_close(&scratch);
    return status;
}

/* The job lives as long as the deck: what it holds as arrays is not copied. */
static void show(const struct job *job, struct holding *holding, rotid_deck *deck)
{
    int nsensor = job->rotor.nsensor, *id = POOL_ARRAY(&holding->pool, int, nsensor);
    double *z = POOL_ARRAY(&holding->pool, double, nsensor);
    holding->missing |= !id || !z;
    for (int s = 0; s < nsensor && id && z; s++) {
        id[s] = job->rotor.sensor[s].id;
        z[s] = job->rotor.sensor[s].position;
    }
    deck->nsensor = nsensor;
    deck->sensor_id = id;
    deck->sensor_z = z;
    deck->nmode = job->nmode;
    deck->number = job->number;
    deck->frequency_hz = job->frequency_hz;
    deck->frequency_std = job->frequency_std;
    deck->shape = job->shape;
    deck->shape_std = job->shape ? job->shape_std : NULL;
    deck->holdout = job->holdout;
    deck->nparameter = job->nparameter;
    deck->parameter = job->bounds;
}

static int read_deck(struct holding *holding, const struct deck_memory *memory, const char *path, int noverride,
                     const char *const *text, struct call *call, rotid_deck *deck)
{
    struct pool *pool = &holding->pool;
    struct message_list *messages = &call->notes;
    struct deck_handle *handle = POOL_NEW(pool, struct deck_handle);
    struct override *override = POOL_ARRAY(pool, struct override, noverride);
    if (!handle || !override)
        return ROTID_ERROR_MEMORY;
    *handle = (struct deck_handle){.holding = holding};
    deck->memory = handle;
    deck->path = holding_text(holding, path);
    deck->length = deck->mass = deck->centre = NAN;
    int status = parse_overrides(holding, noverride, text, messages, override);
    if (!status)
        status = memory ? deck_read_memory(pool, memory, noverride, override, messages, &handle->job)
                        : deck_read(pool, path, noverride, override, messages, &handle->job);
    if (!status)
        status = weigh(&handle->job, &call->environment, deck);
    if (!status)
        show(&handle->job, holding, deck);
    handle->usable = status == ROTID_OK;
    deck->nmessage = (int)messages->count;
    deck->nerror = messages->errors;
    deck->message = holding_messages(holding, messages);
    return holding->missing ? ROTID_ERROR_MEMORY : status;
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
    struct holding *holding = holding_new(&call->environment);
    rotid_deck *made = holding ? POOL_NEW(&holding->pool, rotid_deck) : NULL;
    int status = made ? read_deck(holding, memory, path, noverride, override, call, made) : ROTID_ERROR_MEMORY;
    if (status == ROTID_ERROR_MEMORY)
        holding_free(holding);
    else
        *deck = made;
    return status;
}

int rotid_deck_read(const char *path, int noverride, const char *const *override, const rotid_environment *environment,
                    char *failure, rotid_deck **deck)
{
    struct call call;
    int status = call_open(&call, environment, failure, deck, "deck");
    if (deck)
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
    if (deck)
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
        holding_free(((struct deck_handle *)deck->memory)->holding);
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
