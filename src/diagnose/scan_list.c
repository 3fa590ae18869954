/* Which causes at which targets there are to look for. */
#include <math.h>
#include <string.h>

#include "base/text.h"
#include "diagnose/causes/catalogue.h"
#include "diagnose/scan.h"

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
        count += rotor->effect[i].kind == cause->effect && rotor->effect[i].target == target;
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

const char *scan_free_name(struct pool *pool, const struct rotor *rotor, const char *id)
{
    const char *name = id;
    for (int i = 2; name && name_is_taken(rotor, name); i++)
        name = pool_format(pool, "%s_%d", id, i);
    return name;
}

static int add(struct pool *pool, const struct job *job, const struct cause_kind *cause, int target, struct scan *scan)
{
    int has_target = cause->target >= TARGET_GROUP && cause->target <= TARGET_TIEROD;
    struct scan_candidate *c = &scan->candidate[scan->ncandidate];
    *c = (struct scan_candidate){.cause = cause, .best = -1};
    c->effect = (struct effect){.kind = cause->effect, .target = has_target ? target : -1};
    c->effect.name = scan_free_name(pool, &job->rotor, cause->id);
    c->target = cause_target_name(pool, &job->rotor, cause, target);
    for (int p = 0; p < EFFECT_MOST_PARAMETERS; p++)
        c->effect.value[p] = cause->parameter[p].neutral;
    scan->ncandidate++;
    return c->effect.name && c->target ? ROTID_OK : ROTID_ERROR_MEMORY;
}

static int add_suspect(struct pool *pool, const struct job *job, const struct suspect *suspect, struct scan *scan)
{
    const struct cause_kind *cause = catalogue_of(&suspect->effect);
    int target = suspect->effect.target;
    for (int i = 0; i < job->rotor.neffect; i++)
        if (same_text(job->rotor.effect[i].name, suspect->effect.name))
            return ROTID_OK; /* accepted in an earlier round */
    if (cause->place < 0 && cause->target == TARGET_SENSOR && is_in_model(&job->rotor, cause, target))
        return ROTID_OK; /* an accelerometer that was weighed already */
    int status = add(pool, job, cause, target, scan);
    struct scan_candidate *c = &scan->candidate[scan->ncandidate - 1];
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

int scan_allows(const struct job *job, const struct scan *scan, int a, int b)
{
    const struct scan_candidate *first = &scan->candidate[a], *second = &scan->candidate[b];
    if (first->cause != second->cause || first->effect.target != second->effect.target)
        return a != b;
    int place = first->cause->place;
    return place >= 0 && !first->fixed[place] && !second->fixed[place] && !first->suspect && !second->suspect &&
           !effects_alike(&job->rotor, first->cause, first->effect.target);
}

int scan_list(struct pool *pool, const struct job *job, struct scan *scan)
{
    const struct rotor *rotor = &job->rotor;
    int most = job->unknowns.nsuspect, status = ROTID_OK;
    int *identified = POOL_ARRAY(pool, int, rotor->ngroup);
    for (int i = 0; i < catalogue_count(); i++)
        most += target_count(rotor, catalogue_item(i)->target);
    *scan = (struct scan){0};
    scan->candidate = POOL_ARRAY(pool, struct scan_candidate, most);
    if (!identified || !scan->candidate)
        return ROTID_ERROR_MEMORY;
    for (int g = 0; g < rotor->ngroup; g++)
        identified[g] = is_identified(job, g);
    for (int i = 0; i < catalogue_count() && !status; i++) {
        const struct cause_kind *cause = catalogue_item(i);
        for (int t = 0; t < target_count(rotor, cause->target) && cause->class == CAUSE_PHYSICAL && !status; t++)
            if (is_of_this_model(job, cause) &&
                !is_in_model(rotor, cause, cause->target == TARGET_NONE || cause->target == TARGET_SENSOR ? -1 : t) &&
                (!cause->applies || cause->applies(rotor, t, identified)))
                status = add(pool, job, cause, t, scan);
    }
    for (int i = 0; i < job->unknowns.nsuspect && !status; i++)
        status = add_suspect(pool, job, &job->unknowns.suspect[i], scan);
    return status;
}
