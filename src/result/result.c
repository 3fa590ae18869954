#include "result/result.h"
#include "record/rows.h"

static const rotid_cause_value *value_of(const rotid_cause *cause, const char *name)
{
    for (int p = 0; p < cause->nparameters; p++)
        if (!strcmp(cause->parameters[p].name, name))
            return &cause->parameters[p];
    return NULL;
}

static int set(struct cause_place *place, double from, double to)
{
    *place = (struct cause_place){from, to, {NAN, NAN}};
    return 1;
}

static int at_group(const rotid_geometry *geometry, const char *target, struct cause_place *place)
{
    size_t length = strcspn(target, "|"); /* of an interface: the group before it ends there */
    for (int g = 0; g < geometry->ngroups; g++) {
        const rotid_group *group = &geometry->groups[g];
        if (strlen(group->name) == length && !strncmp(group->name, target, length))
            return set(place, target[length] ? group->to_m : group->from_m, group->to_m);
    }
    return 0;
}

static int at_member(const rotid_geometry *geometry, const char *target, struct cause_place *place)
{
    double z;
    for (int i = 0; i < geometry->ntierods; i++)
        if (geometry->tierods[i].name && !strcmp(geometry->tierods[i].name, target))
            return set(place, geometry->tierods[i].from_m, geometry->tierods[i].to_m);
    for (int i = 0; i < geometry->nbars; i++)
        if (geometry->bars[i].name && !strcmp(geometry->bars[i].name, target))
            return set(place, geometry->bars[i].from_m, geometry->bars[i].to_m);
    for (int i = 0; i < geometry->nsprings; i++)
        if (geometry->springs[i].name && !strcmp(geometry->springs[i].name, target))
            return set(place, geometry->springs[i].z_m, geometry->springs[i].z_m);
    if (sscanf(target, "at %lf m", &z) != 1 || !isfinite(z)) /* of a spring without a name */
        return 0;
    return set(place, z, z);
}

int cause_place(const rotid_geometry *geometry, const rotid_cause *cause, struct cause_place *place)
{
    const rotid_cause_value *z = value_of(cause, "z"), *width = value_of(cause, "width");
    double half = width && isfinite(width->value) ? width->value : 0;
    (void)set(place, NAN, NAN);
    if (!geometry)
        return 0;
    if (z && isfinite(z->value)) {
        *place =
            (struct cause_place){fmax(z->value - half, 0), fmin(z->value + half, geometry->length_m), {z->ci95[0], z->ci95[1]}};
        return place->from <= place->to;
    }
    return *cause->target && (at_group(geometry, cause->target, place) || at_member(geometry, cause->target, place));
}

TABLE(provenance_record, struct result_head) = {
    INTEGER(struct result_head, schema, FROM_1),
    KEYS(struct result_head, 0, rotid, commit, blas),
    NUMBER(struct result_head, seed, FROM_0 | WHOLE),
    INTEGER(struct result_head, threads, FROM_1),
    TEXT(struct result_head, command, 0),
    {0},
};

TABLE(deck_record, struct result_head) = {
    TEXT(struct result_head, deck, 0),
    TEXTS(struct result_head, heading, SINCE_LATER),
    STRUCTS(struct result_head, references, SINCE_LATER,
            RECORD_OF(rotid_reference, TEXT(rotid_reference, quantity, 0),
                      NUMBERS(rotid_reference, values, ELEMENTS_MAY_BE_NULL))),
    KEYS(struct result_head, IF_KNOWN, length_unit, frequency_unit),
    {0},
};

const rotid_reference *head_reference(const struct result_head *head, const char *quantity)
{
    for (int i = 0; i < head->nreferences; i++)
        if (!strcmp(head->references[i].quantity, quantity))
            return &head->references[i];
    return NULL;
}

double reference_value(const rotid_reference *reference, int k)
{
    return reference && k < reference->nvalues ? reference->values[k] : NAN;
}

/* Rows of the parts that results are made of. */
#define PROVENANCE INLINE(struct result, head, 0, provenance_record)
#define HEAD       PROVENANCE, INLINE(struct result, head, 0, deck_record)
#define WARNINGS   TEXTS(struct result, warnings, SINCE_LATER)
#define OWN(M, R)  INLINE(struct result, M, BEHIND_POINTER, R)

/* The same of each state. */
#define STATES(M, R)                                                                                                             \
    STRUCTS(                                                                                                                     \
        struct result, states, IF_KNOWN,                                                                                         \
        RECORD_OF(struct result_state, TEXT(struct result_state, name, 0), INLINE(struct result_state, M, BEHIND_POINTER, R)))

#define KIND(COMMAND, HAS_PAGE, ...)                                                                                             \
    {                                                                                                                            \
        .command = #COMMAND, .has_page = (HAS_PAGE),                                                                             \
        .record = RECORD(struct result, ((const struct record_field[]){__VA_ARGS__, {0}}))                                       \
    }

const struct result_kind result_kinds[] = {
    KIND(check, 1, HEAD, OWN(check, check_record), STATES(check, check_record), WARNINGS),
    KIND(modes, 1, HEAD, OWN(modes, spectrum_record), STATES(modes, spectrum_record), WARNINGS),
    KIND(identify, 1, HEAD, OWN(identify, identification_record), OWN(identify, identification_alone_record), WARNINGS),
    KIND(diagnose, 1, HEAD, OWN(diagnose, diagnosis_record), WARNINGS),
    KIND(suggest, 1, HEAD, OWN(suggest, suggestion_record), WARNINGS),
    KIND(sensitivity, 1, HEAD, OWN(sensitivity, sensitivity_record), STATES(sensitivity, sensitivity_record)),
    KIND(speeds, 1, HEAD, OWN(speeds, speeds_record), WARNINGS),
    KIND(frf, 1, HEAD, OWN(frf, transfer_result_record), STATES(frf, transfer_result_record), WARNINGS),
    KIND(ema, 1, PROVENANCE, OWN(ema, ema_result_record), WARNINGS),
    KIND(uff, 0, PROVENANCE, OWN(uff, uff_result_record)),
    KIND(export, 0, HEAD, OWN(export, export_result_record), WARNINGS),
    KIND(study, 1, PROVENANCE, OWN(study, study_result_record)),
    {0},
};

const struct result_kind *result_kind(const char *command)
{
    const struct result_kind *kind = result_kinds;
    while (kind->command && strcmp(kind->command, command) != 0)
        kind++;
    return kind->command ? kind : NULL;
}

char *result_json(const struct result *result)
{
    const struct record *record = &result_kind(result->head.command)->record;
    for (const struct record_field *field = record->field; field->key; field++)
        if (field->bits & BEHIND_POINTER && !*(void *const *)((const char *)result + field->offset))
            return NULL;
    return record_text(record, result, 1);
}

int result_states(const struct result *result)
{
    return result->identify ? result->identify->nstates : result->nstates;
}

/* References go over the modes of all states. */
static void take_references(struct pool *pool, struct result_head *head, int first)
{
    rotid_reference *reference = POOL_ARRAY(pool, rotid_reference, head->nreferences);
    for (int i = 0; i < head->nreferences && reference; i++) {
        int skip = first < head->references[i].nvalues ? first : head->references[i].nvalues;
        reference[i] = head->references[i];
        reference[i].values += skip;
        reference[i].nvalues -= skip;
    }
    head->nreferences = reference ? head->nreferences : 0;
    head->references = reference;
}

struct result result_of_state(struct pool *pool, const struct result *result, int s)
{
    struct result own = *result;
    int first = 0;
    own.nstates = 0;
    own.states = NULL;
    if (result->identify) {
        for (int before = 0; before < s; before++)
            first += result->identify->states[before].nmodes;
        take_references(pool, &own.head, first);
        if ((own.identify = POOL_NEW(pool, rotid_identification)))
            *own.identify = fit_of_state(pool, result->identify, s);
        return own;
    }
    own.job = result->states[s].job;
    own.check = result->states[s].check;
    own.modes = result->states[s].modes;
    own.sensitivity = result->states[s].sensitivity;
    own.frf = result->states[s].frf;
    return own;
}

const rotid_geometry *geometry_of_result(const struct result *result)
{
    return result->identify   ? result->identify->geometry
           : result->diagnose ? result->diagnose->geometry
           : result->suggest  ? result->suggest->geometry
           : result->modes    ? result->modes->geometry
           : result->check    ? result->check->geometry
                              : NULL;
}

const rotid_identification *fit_of_result(const struct result *result)
{
    return result->diagnose ? result->diagnose->base : result->identify;
}

const rotid_noise *noise_of_result(const struct result *result)
{
    return result->diagnose   ? &result->diagnose->noise
           : result->suggest  ? &result->suggest->noise
           : result->identify ? result->identify->noise
                              : NULL;
}
