/* A deck for hosts: read once, then only read from. */
#include "api/deck_handle.h"

#include <math.h>

#include "api/result_memory.h"
#include "base/host.h"
#include "beam/effects.h"
#include "deck/deck.h"

struct deck_handle {
    struct result_memory *memory;
    int usable; /* without errors */
    struct job job;
};

static int parse_overrides(struct result_memory *memory, int count, const char *const *text, struct message_list *messages,
                           struct override *override)
{
    for (int i = 0; i < count; i++) {
        if (!text[i])
            return ROTID_ERROR_ARGUMENT;
        const char *copy = result_text(memory, text[i]); /* parts of it become part of the job */
        int status = copy ? override_parse(&memory->pool, copy, &override[i]) : ROTID_ERROR_MEMORY;
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
static void show(struct job *job, struct result_memory *memory, rotid_deck *deck)
{
    int nsensor = job->rotor.nsensor, *id = result_room(memory, nsensor, sizeof *id);
    double *z = result_room(memory, nsensor, sizeof *z), *stated = result_room(memory, job->nparameter, sizeof *stated);
    for (int s = 0; s < nsensor && id && z; s++) {
        id[s] = job->rotor.sensor[s].id;
        z[s] = job->rotor.sensor[s].position;
    }
    for (int p = 0; p < job->nparameter && stated; p++)
        stated[p] = *parameter_value(&job->rotor, job->parameter[p]);
    deck->nreferences = RESULT_LIST(memory, deck->references, job->nreference);
    for (int i = 0; i < deck->nreferences; i++)
        deck->references[i] =
            (rotid_reference){job->reference[i].quantity, job->reference[i].count, job->reference[i].value};
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
    deck->stated = stated;
    deck->nheading = job->nheading;
    deck->heading = job->heading;
}

static int read_deck(struct result_memory *memory, const char *path, int noverride, const char *const *text,
                     const rotid_environment *environment, rotid_deck *deck)
{
    struct pool *pool = &memory->pool;
    struct deck_handle *handle = POOL_NEW(pool, struct deck_handle);
    struct override *override = POOL_ARRAY(pool, struct override, noverride);
    struct message_list messages;
    message_open(&messages, pool);
    if (!handle || !override)
        return ROTID_ERROR_MEMORY;
    *handle = (struct deck_handle){.memory = memory};
    deck->memory = handle;
    deck->path = result_text(memory, path);
    deck->length = deck->mass = deck->centre = NAN;
    int status = parse_overrides(memory, noverride, text, &messages, override);
    if (!status)
        status = deck_read(pool, path, noverride, override, &messages, &handle->job);
    if (!status)
        status = weigh(&handle->job, environment, deck);
    if (!status)
        show(&handle->job, memory, deck);
    handle->usable = status == ROTID_OK;
    deck->nmessage = (int)messages.count;
    deck->nerror = messages.errors;
    deck->message = result_messages(memory, &messages);
    return memory->missing ? ROTID_ERROR_MEMORY : status;
}

int rotid_deck_read(const char *path, int noverride, const char *const *override, const rotid_environment *environment,
                    rotid_deck **deck)
{
    struct host host;
    if (!deck)
        return ROTID_ERROR_ARGUMENT;
    *deck = NULL;
    if (!path || noverride < 0 || (noverride && !override))
        return ROTID_ERROR_ARGUMENT;
    int status = host_enter(&host);
    if (status)
        return status;
    struct result_memory *memory = result_memory_new(environment);
    rotid_deck *made = memory ? POOL_NEW(&memory->pool, rotid_deck) : NULL;
    status = made ? read_deck(memory, path, noverride, override, environment, made) : ROTID_ERROR_MEMORY;
    if (status == ROTID_ERROR_MEMORY || status == ROTID_ERROR_ARGUMENT)
        result_memory_free(memory);
    else
        *deck = made;
    host_leave(&host);
    return status;
}

void rotid_deck_free(rotid_deck *deck)
{
    if (deck)
        result_memory_free(((struct deck_handle *)deck->memory)->memory);
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
