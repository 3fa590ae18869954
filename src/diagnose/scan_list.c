/* Which causes at which targets there are to look for. */
#include "diagnose/diagnose.h"

#define SAME_LENGTH 1e-9 /* relative: lengths of two states that are one */

static int is_identified(const struct job *job, int group)
{
    for (int p = 0; p < job->unknowns.nparameter; p++)
        if (parameter_is_of_group(&job->unknowns.parameter[p], group) &&
            (job->unknowns.parameter[p].kind == PARAMETER_E || job->unknowns.parameter[p].kind == PARAMETER_G))
            return 1;
    return 0;
}

static int effects_alike(const struct rotor *rotor, const struct cause_kind *cause, int target)
{
    int count = 0;
    for (int i = 0; i < rotor->neffect; i++)
        count += rotor->effect[i].kind == cause->effect && rotor->effect[i].target == target && !rotor->effect[i].stays;
    return count;
}

/* A cause with a place may be there twice, one without only once at a target: with three soft zones or masses anything that is
 * spread along the rotor can be imitated, and nothing is explained. */
static int is_in_model(const struct rotor *rotor, const struct cause_kind *cause, int target)
{
    return effects_alike(rotor, cause, target) >= (cause->place < 0 ? 1 : 2);
}

/* A solid has none of the errors of beams, and a beam that is corrected for one of them is not to become a solid as well. */
static int is_of_this_model(const struct job *job, const struct cause_kind *cause)
{
    if (job->options.solid)
        return !cause_of_beam(cause);
    int corrected = !models_solids(job->models);
    for (int i = 0; i < job->rotor.neffect; i++)
        corrected |= job->rotor.effect[i].kind->section != NULL;
    return !(cause->solid && corrected);
}

static int target_count(const struct rotor *rotor, enum cause_target target)
{
    switch (target) {
    case TARGET_GROUP:
        return rotor->ngroup;
    case TARGET_INTERFACE:
        return rotor_axis_groups(rotor) - 1;
    case TARGET_SPRING:
        return rotor->nspring;
    case TARGET_DISK:
        return rotor->ndisk;
    case TARGET_TIEROD:
        return rotor->ntierod;
    default:
        return 1;
    }
}

static int name_is_taken(const struct rotor *rotor, const char *name)
{
    int taken = 0;
    for (int i = 0; i < rotor->ngroup; i++)
        taken |= same_text(rotor->group[i].name, name);
    for (int i = 0; i < rotor->ntierod; i++)
        taken |= same_text(rotor->tierod[i].name, name);
    for (int i = 0; i < rotor->nspring; i++)
        taken |= rotor->spring[i].name && same_text(rotor->spring[i].name, name);
    for (int i = 0; i < rotor->ndisk; i++)
        taken |= rotor->disk[i].name && same_text(rotor->disk[i].name, name);
    for (int i = 0; i < rotor->neffect; i++)
        taken |= rotor->effect[i].name && same_text(rotor->effect[i].name, name);
    return taken;
}

static int name_is_taken_in_any(const struct states *states, const char *name)
{
    int taken = 0;
    for (int s = 0; s < states->nstate; s++)
        taken |= name_is_taken(&states->state[s].job.rotor, name);
    return taken;
}

/* The same that nothing in any of the states has. */
static const char *states_free_name(struct pool *pool, const struct states *states, const char *id)
{
    const char *name = id;
    for (int i = 2; name && name_is_taken_in_any(states, name); i++)
        name = pool_format(pool, "%s_%d", id, i);
    return name;
}

const char *scan_free_name(struct pool *pool, const struct rotor *rotor, const char *id)
{
    struct state state = {.job.rotor = *rotor};
    const struct states states = {.nstate = 1, .state = &state};
    return states_free_name(pool, &states, id);
}

/* The targets of a cause in one state. */
struct listing {
    struct pool *pool;
    const struct states *states;
    int **identified; /* [nstate] -> [ngroup] */
    struct scan *scan;
};

static int add(struct listing *l, const struct cause_kind *cause, int home, int target)
{
    int has_target = cause->target >= TARGET_GROUP && cause->target <= TARGET_TIEROD;
    struct scan_candidate *c = &l->scan->candidate[l->scan->ncandidate];
    int *in = POOL_ARRAY(l->pool, int, l->states->nstate);
    *c = (struct scan_candidate){.cause = cause, .best = -1, .state = -1, .home = home, .in = in};
    c->effect = (struct effect){.kind = cause->effect, .target = has_target ? target : -1};
    c->effect.name = states_free_name(l->pool, l->states, cause->id);
    c->target = cause_target_name(l->pool, &l->states->state[home].job.rotor, cause, target);
    for (int p = 0; p < EFFECT_MOST_PARAMETERS; p++)
        c->effect.value[p] = cause->parameter[p].neutral;
    l->scan->ncandidate++;
    if (in)
        in[home] = 1;
    return in && c->effect.name && c->target ? ROTID_OK : ROTID_ERROR_MEMORY;
}

/* Whether the cause stands in the list already for this target of a state. */
static int is_listed(const struct scan *scan, const struct cause_kind *cause, int state, int target)
{
    for (int i = 0; i < scan->ncandidate; i++) {
        const struct scan_candidate *c = &scan->candidate[i];
        int has_target = cause->target >= TARGET_GROUP && cause->target <= TARGET_TIEROD;
        if (c->cause == cause && !c->suspect && c->in[state] && (!has_target || c->effect.target == target))
            return 1;
    }
    return 0;
}

static int applies_in(const struct listing *l, const struct cause_kind *cause, int state, int target)
{
    const struct job *job = &l->states->state[state].job;
    return target < target_count(&job->rotor, cause->target) && is_of_this_model(job, cause) &&
           !is_in_model(&job->rotor, cause, cause->target == TARGET_NONE || cause->target == TARGET_SENSOR ? -1 : target) &&
           (!cause->applies || cause->applies(&job->rotor, target, l->identified[state]));
}

/* Between states of one length a place stays where it is; where the length differs nobody says whether it does so from the left
 * end or from the right one, as a mass at a free end. */
static int has_same_places(const struct states *states, int a, int b)
{
    double length = rotor_length(&states->state[a].job.rotor);
    return fabs(rotor_length(&states->state[b].job.rotor) - length) <= SAME_LENGTH * length;
}

/* A cause at the targets that state `home` has and no state before it: the same target has one place in the list and one name. */
static int add_cause(struct listing *l, const struct cause_kind *cause, int home)
{
    const struct states *states = l->states;
    for (int t = 0; t < target_count(&states->state[home].job.rotor, cause->target); t++) {
        if (!applies_in(l, cause, home, t) || (home && is_listed(l->scan, cause, home, t)))
            continue;
        int status = add(l, cause, home, t);
        const struct scan_candidate *c = &l->scan->candidate[l->scan->ncandidate - 1];
        for (int s = home + 1; s < states->nstate && !status; s++) {
            if (!applies_in(l, cause, s, t) || (cause->place >= 0 && !has_same_places(states, home, s)))
                continue;
            const char *name = cause_target_name(l->pool, &states->state[s].job.rotor, cause, t);
            if (!name)
                return ROTID_ERROR_MEMORY;
            ((int *)c->in)[s] = same_text(name, c->target);
        }
        if (status)
            return status;
    }
    return ROTID_OK;
}

/* The candidates that could act in several states, in one of them alone. A rotor is a solid in all of them. */
static int add_single(struct listing *l)
{
    struct scan *scan = l->scan;
    int count = scan->ncandidate;
    for (int i = 0; i < count; i++) {
        const struct scan_candidate *common = &scan->candidate[i];
        int several = 0;
        for (int s = 0; s < l->states->nstate; s++)
            several += common->in[s];
        if (several == 1)
            scan->candidate[i].state_name = l->states->state[common->home].name;
        for (int s = 0; s < l->states->nstate && several > 1 && !common->suspect && !common->cause->solid; s++) {
            struct scan_candidate *c = &scan->candidate[scan->ncandidate];
            int *in = POOL_ARRAY(l->pool, int, l->states->nstate);
            if (!in)
                return ROTID_ERROR_MEMORY;
            if (!common->in[s])
                continue;
            in[s] = 1;
            *c = *common;
            c->state = c->home = s;
            c->state_name = l->states->state[s].name;
            c->in = in;
            scan->ncandidate++;
        }
    }
    return ROTID_OK;
}

/* In every state that has the suspect, by its name. */
static int add_suspect(struct listing *l, int home, const struct suspect *suspect)
{
    const struct cause_kind *cause = catalogue_of(&suspect->effect);
    const struct rotor *rotor = &l->states->state[home].job.rotor;
    int target = suspect->effect.target;
    for (int i = 0; i < rotor->neffect; i++)
        if (same_text(rotor->effect[i].name, suspect->effect.name))
            return ROTID_OK; /* accepted in an earlier round */
    if (cause->place < 0 && cause->target == TARGET_SENSOR && is_in_model(rotor, cause, target))
        return ROTID_OK; /* an accelerometer that was weighed already */
    for (int i = 0; i < l->scan->ncandidate && home; i++) {
        const struct scan_candidate *c = &l->scan->candidate[i];
        if (c->suspect && same_text(c->effect.name, suspect->effect.name)) {
            ((int *)c->in)[home] = 1;
            return ROTID_OK;
        }
    }
    int status = add(l, cause, home, target);
    struct scan_candidate *c = &l->scan->candidate[l->scan->ncandidate - 1];
    c->effect.name = suspect->effect.name;
    c->effect.variant = suspect->effect.variant;
    c->effect.target = target;
    memcpy(c->effect.bound, suspect->effect.bound, sizeof c->effect.bound);
    c->suspect = 1;
    memcpy(c->fixed, suspect->fixed, sizeof c->fixed);
    for (int p = 0; p < EFFECT_MOST_PARAMETERS; p++)
        if (c->fixed[p])
            c->effect.value[p] = suspect->effect.value[p];
    return status;
}

static int open_listing(struct listing *l)
{
    int most = 0, count = l->states->nstate;
    l->identified = POOL_ARRAY(l->pool, int *, count);
    for (int s = 0; s < count && l->identified; s++) {
        const struct job *job = &l->states->state[s].job;
        int *identified = l->identified[s] = POOL_ARRAY(l->pool, int, job->rotor.ngroup);
        most += job->unknowns.nsuspect;
        for (int i = 0; i < catalogue_count(); i++)
            most += target_count(&job->rotor, catalogue_item(i)->target);
        for (int g = 0; g < job->rotor.ngroup && identified; g++)
            identified[g] = is_identified(job, g);
        if (!identified)
            return ROTID_ERROR_MEMORY;
    }
    *l->scan = (struct scan){0};
    l->scan->candidate = POOL_ARRAY(l->pool, struct scan_candidate, (size_t)most * (count > 1 ? 2 : 1));
    return l->identified && l->scan->candidate ? ROTID_OK : ROTID_ERROR_MEMORY;
}

int scan_list(struct pool *pool, const struct states *states, struct scan *scan)
{
    struct listing listing = {.pool = pool, .states = states, .scan = scan};
    int status = open_listing(&listing);
    for (int i = 0; i < catalogue_count() && !status; i++)
        for (int s = 0; s < states->nstate && catalogue_item(i)->class == CAUSE_PHYSICAL && !status; s++)
            status = add_cause(&listing, catalogue_item(i), s);
    for (int s = 0; s < states->nstate && !status; s++)
        for (int i = 0; i < states->state[s].job.unknowns.nsuspect && !status; i++)
            status = add_suspect(&listing, s, &states->state[s].job.unknowns.suspect[i]);
    return status || states->nstate == 1 ? status : add_single(&listing);
}
