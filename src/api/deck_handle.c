/* A deck for hosts: read once, then only read from. */
#include "api/api.h"
#include "deck/deck.h"

static int cancelled(void *context)
{
    struct call *call = context;
    const rotid_environment *given = &call->entry.environment;
    if (!atomic_load(&call->cancelled) && given->cancelled(given->context))
        atomic_store(&call->cancelled, 1);
    return atomic_load(&call->cancelled);
}

static void progress(void *context, const char *stage, int step)
{
    struct call *call = context;
    if (!atomic_load(&call->cancelled))
        call->entry.environment.progress(call->entry.environment.context, stage, step);
}

int call_open(struct call *call, const rotid_environment *given, char *failure, void *result, const char *name)
{
    int status = entry_open(&call->entry, given, failure);
    const rotid_environment *taken = &call->entry.environment;
    atomic_init(&call->cancelled, 0);
    call->environment = (rotid_environment){.size = sizeof call->environment,
                                            .allocator = taken->allocator,
                                            .cancelled = taken->cancelled ? cancelled : NULL,
                                            .progress = taken->progress ? progress : NULL,
                                            .context = call};
    message_open(&call->notes, &call->entry.scratch);
    if (result)
        memset(result, 0, sizeof(void *)); /* of whatever type it is */
    call->job = NULL;
    if (!status && !result)
        status = refuse(failure, "%s is NULL, expected the address of a pointer", name);
    if (!status)
        status = host_enter_locale(&call->locale);
    call->entered = status == ROTID_OK;
    return status;
}

int call_close(struct call *call, int status)
{
    char *failure = call->entry.failure;
    if (call->job && status < 0)
        check_sections(call->job, status, &call->notes);
    if (failure && !*failure && status < 0)
        (void)failure_append(failure, 0, message_errors(&call->notes, &call->entry.scratch));
    if (call->entered)
        host_leave_locale(&call->locale);
    return entry_close(&call->entry, status);
}

void *call_keep(const struct call *call, const struct record *record, const void *made, void **memory, int *nmessage,
                const rotid_message **message)
{
    struct pool *pool = call->entry.scratch.out_of_memory ? NULL : pool_new(call->environment.allocator);
    rotid_message *notes = pool ? POOL_COPY(pool, call->notes.item, call->notes.count, 0) : NULL;
    *memory = pool;
    *nmessage = notes ? (int)call->notes.count : 0;
    *message = notes;
    for (int i = 0; i < *nmessage; i++) {
        notes[i].file = notes[i].file ? pool_copy_text(pool, notes[i].file) : NULL;
        notes[i].text = pool_copy_text(pool, notes[i].text);
    }
    void *kept = pool && !pool->out_of_memory ? record_copy(pool, record, made) : NULL;
    if (!kept)
        pool_free(pool);
    return kept;
}

struct deck_handle {
    struct pool *own;
    int usable; /* without errors */
    struct states states;
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
    const double *x = parameter_starts(&scratch, job->unknowns.nparameter, job->unknowns.bounds);
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

/* Each state as a deck of its own, and the unknowns of all. */
static int show_states(const struct states *states, struct pool *own, const rotid_environment *environment, rotid_deck *deck)
{
    rotid_deck **list = POOL_ARRAY(own, rotid_deck *, states->nstate);
    const char **name = POOL_ARRAY(own, const char *, states->nstate);
    double *stated = POOL_ARRAY(own, double, states->nparameter);
    if (!list || !name || !stated)
        return ROTID_ERROR_MEMORY;
    for (int s = 0; s < states->nstate; s++) {
        const struct state *state = &states->state[s];
        struct deck_handle *handle = POOL_NEW(own, struct deck_handle);
        list[s] = POOL_NEW(own, rotid_deck);
        if (!handle || !list[s])
            return ROTID_ERROR_MEMORY;
        *handle = (struct deck_handle){.usable = 1,
                                       .states = {.nstate = 1,
                                                  .state = (struct state *)state,
                                                  .nparameter = state->job.unknowns.nparameter,
                                                  .bounds = state->job.unknowns.bounds}};
        *list[s] = (rotid_deck){.path = deck->path, .memory = handle};
        int status = weigh(&state->job, environment, list[s]);
        if (status)
            return status;
        show(&state->job, own, list[s]);
        if (own->out_of_memory)
            return ROTID_ERROR_MEMORY;
        name[s] = state->name;
        for (int p = 0; p < state->job.unknowns.nparameter; p++)
            stated[state->unknown[p]] = list[s]->stated[p];
    }
    deck->nparameter = states->nparameter;
    deck->parameter = states->bounds;
    deck->stated = stated;
    deck->nstate = states->nstate;
    deck->state = list;
    deck->state_name = name;
    return ROTID_OK;
}

/* The places in the cards and the origin keep the path, the name and the directory: those of the caller may go. */
static int read_deck(struct pool *own, const struct deck_memory *memory, const char *path, int noverride, const char *const *text,
                     struct call *call, rotid_deck *deck)
{
    struct deck_memory kept = memory ? *memory : (struct deck_memory){0};
    struct message_list *messages = &call->notes;
    message_open(messages, own); /* they stay with the deck */
    struct deck_handle *handle = POOL_NEW(own, struct deck_handle);
    struct override *override = POOL_ARRAY(own, struct override, noverride);
    if (!handle || !override)
        return ROTID_ERROR_MEMORY;
    *handle = (struct deck_handle){.own = own};
    deck->memory = handle;
    deck->path = kept.name = pool_copy_text(own, path);
    kept.directory = kept.directory ? pool_copy_text(own, kept.directory) : NULL;
    if (own->out_of_memory)
        return ROTID_ERROR_MEMORY;
    deck->length = deck->mass = deck->centre = NAN;
    int status = parse_overrides(own, noverride, text, messages, override);
    if (!status)
        status = deck_read_states(own, deck->path, memory ? &kept : NULL, noverride, override, messages, &handle->states);
    if (!status)
        status = weigh(&handle->states.state[0].job, &call->environment, deck);
    if (!status)
        show(&handle->states.state[0].job, own, deck);
    if (!status && handle->states.nstate > 1)
        status = show_states(&handle->states, own, &call->environment, deck);
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
    if (!status && length && !text)
        status = refuse(failure, "text is NULL, expected %zu characters", length);
    if (!status)
        status = make_deck(&call, &memory, memory.name, noverride, override, deck);
    return call_close(&call, status);
}

void rotid_deck_free(rotid_deck *deck)
{
    if (deck && ((struct deck_handle *)deck->memory)->own) /* not a state of another deck */
        pool_free(((struct deck_handle *)deck->memory)->own);
}

const struct states *deck_states_of(const rotid_deck *deck)
{
    const struct deck_handle *handle = deck ? deck->memory : NULL;
    return handle && handle->usable ? &handle->states : NULL;
}

const struct job *deck_job_of(const rotid_deck *deck)
{
    const struct states *states = deck_states_of(deck);
    return states ? &states->state[0].job : NULL;
}

const struct job *deck_job(const rotid_deck *deck, struct call *call)
{
    const struct states *states = deck_states(deck, call);
    if (!states || states->nstate == 1)
        return states ? &states->state[0].job : NULL;
    states_refuse(states, deck->path, &call->notes);
    return NULL;
}

const struct states *deck_states(const rotid_deck *deck, struct call *call)
{
    const struct deck_handle *handle = deck ? deck->memory : NULL;
    const struct states *states = deck_states_of(deck);
    if (states) {
        call->job = &states->state[0].job;
        return states;
    }
    for (int i = 0; handle && i < deck->nmessage; i++)
        if (deck->message[i].severity == ROTID_ERROR) {
            const rotid_message *m = &deck->message[i];
            message_at(&call->notes, SEVERITY_ERROR, *m, "%s", m->text);
            return NULL;
        }
    message_add(&call->notes, SEVERITY_ERROR, NULL, 0, 0, "there is no deck to work on, expected one without errors");
    return NULL;
}
