/* What *SET says of each state: how its groups differ from the common ones, and what is known in it of the common unknowns. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "deck/deck_write_states.h"
#include "rotid.h"

#define SAME_LENGTH 1e-12 /* relative: what the sums and ratios of a handful of lengths lose */

/* Which unknown of the state a parameter is, -1: none. */
static int unknown_of(const struct state *state, struct parameter parameter)
{
    for (int p = 0; p < state->job.unknowns.nparameter; p++)
        if (!memcmp(&state->job.unknowns.parameter[p], &parameter, sizeof parameter))
            return p;
    return -1;
}

static int is_common_unknown(const struct written *s, struct parameter parameter)
{
    int p = unknown_of(s->state, parameter);
    return p >= 0 && s->common[p];
}

static void put_set(struct written *s, const char *name, double value)
{
    if (!name || strchr(name, ',') || *name == '*')
        s->set.status = name ? ROTID_ERROR_ARGUMENT : ROTID_ERROR_MEMORY;
    deck_put(&s->set, "%s", name ? name : "");
    deck_put_number(&s->set, ", ", value);
    deck_put(&s->set, "\n");
}

static struct group *group_of(const struct written *s, const char *name)
{
    for (int g = 0; g < s->w.rotor.ngroup; g++)
        if (same_text(s->w.rotor.group[g].name, name))
            return &s->w.rotor.group[g];
    return NULL;
}

static struct parameter of_group(const struct written *s, const struct group *group, enum parameter_kind kind)
{
    return (struct parameter){.kind = kind, .index = (int)(group - s->w.rotor.group)};
}

static double value_of(const struct group *group, enum parameter_kind kind)
{
    const struct material *m = &group->material;
    return kind == PARAMETER_E ? m->e : kind == PARAMETER_G ? material_shear_modulus(m) : kind == PARAMETER_NU ? m->nu : m->rho;
}

static int has_value(const struct group *group, enum parameter_kind kind)
{
    return kind != PARAMETER_G || !group->material.isotropic;
}

/* The state whose value of a group is the common one: the first where it is a common unknown, or, of G, where it follows E. */
static int base_of(int nstate, const struct written *state, const char *name, enum parameter_kind kind)
{
    int base = -1;
    for (int s = nstate - 1; s >= 0; s--) {
        struct group *group = group_of(&state[s], name);
        if (is_common_unknown(&state[s], of_group(&state[s], group, kind)))
            return s;
        base = base < 0 || !has_value(group, kind) || has_value(group_of(&state[base], name), kind) ? s : base;
    }
    return base;
}

static const enum parameter_kind of_groups[] = {PARAMETER_E, PARAMETER_G, PARAMETER_NU, PARAMETER_RHO};
static const char *const suffix[] = {"E", "G", "nu", "rho"};

static int differs(const struct group *group, const struct group *base, enum parameter_kind kind)
{
    if (!has_value(base, kind))
        return has_value(group, kind);
    return !has_value(group, kind) || value_of(group, kind) != value_of(base, kind);
}

/* Whether *SET can say how the group of a state differs from the common one. */
static int can_be_set(int nstate, const struct written *state, const char *name)
{
    const struct group *first = group_of(&state[0], name);
    for (int s = 0; s < nstate; s++) {
        const struct group *group = group_of(&state[s], name);
        if (!group || group->material.laminated != first->material.laminated ||
            group->material.sheet_e != first->material.sheet_e || group->material.stacking != first->material.stacking)
            return 0;
    }
    for (int k = 0; k < 4; k++) {
        const struct group *base = group_of(&state[base_of(nstate, state, name, of_groups[k])], name);
        for (int s = 0; s < nstate; s++) {
            const struct group *group = group_of(&state[s], name);
            if (differs(group, base, of_groups[k]) &&
                (!has_value(group, of_groups[k]) || is_common_unknown(&state[s], of_group(&state[s], group, of_groups[k]))))
                return 0;
        }
    }
    return 1;
}

static void set_materials(struct pool *pool, int nstate, struct written *state, const char *name)
{
    struct material common = group_of(&state[0], name)->material;
    for (int k = 0; k < 4; k++) {
        const struct group *base = group_of(&state[base_of(nstate, state, name, of_groups[k])], name);
        for (int s = 0; s < nstate; s++) {
            const struct group *group = group_of(&state[s], name);
            if (differs(group, base, of_groups[k]))
                put_set(&state[s], pool_format(pool, "%s.%s", name, suffix[k]), value_of(group, of_groups[k]));
        }
        if (of_groups[k] == PARAMETER_E)
            common.e = base->material.e;
        else if (of_groups[k] == PARAMETER_NU)
            common.nu = base->material.nu;
        else if (of_groups[k] == PARAMETER_RHO)
            common.rho = base->material.rho;
        else {
            common.g = base->material.g;
            common.isotropic = base->material.isotropic;
        }
    }
    for (int s = 0; s < nstate; s++)
        group_of(&state[s], name)->material = common;
}

/* The segments of a group, and their length together. */
static struct segment *segments_of(const struct rotor *rotor, int group, int *count, double *length)
{
    int first = 0;
    while (first < rotor->nsegment && rotor->segment[first].group != group)
        first++;
    *length = 0;
    for (*count = 0; first + *count < rotor->nsegment && rotor->segment[first + *count].group == group; ++*count)
        *length += rotor->segment[first + *count].length;
    return rotor->segment + first;
}

/* The length of the group in the first state is the common one, where the others are as long or in proportion. */
static void set_lengths(int nstate, struct written *state, const char *name)
{
    int count, base_count;
    double length, base_length;
    const struct segment *base =
        segments_of(&state[0].w.rotor, (int)(group_of(&state[0], name) - state[0].w.rotor.group), &base_count, &base_length);
    for (int s = 1; s < nstate && base_count; s++) {
        struct segment *own =
            segments_of(&state[s].w.rotor, (int)(group_of(&state[s], name) - state[s].w.rotor.group), &count, &length);
        int alike = count == base_count, same = 1;
        for (int i = 0; i < count && alike; i++) {
            alike &= fabs(own[i].length * base_length - base[i].length * length) <= SAME_LENGTH * length * base_length;
            same &= own[i].length == base[i].length;
        }
        if (!alike || same)
            continue;
        char shown[32];
        (void)snprintf(shown, sizeof shown, "%.13g", length); /* 0.4, which two segments may miss by the last digit */
        deck_put(&state[s].set, "%s.length, %s\n", name, shown);
        for (int i = 0; i < count; i++)
            own[i].length = base[i].length;
    }
}

static int was_set(const struct written *s, const char *name)
{
    size_t length = strlen(name);
    for (const char *line = s->set.text, *end; line && (end = strchr(line, '\n')); line = end + 1)
        if (!strncmp(line, name, length) && line[length] == ',')
            return 1;
    return 0;
}

/* A common unknown that a state does not have is known there. */
static void set_what_is_known(int nstate, struct written *state)
{
    for (int s = 0; s < nstate; s++)
        for (int p = 0; p < state[s].state->job.unknowns.nparameter; p++) {
            if (!state[s].common[p])
                continue;
            const char *name = state[s].state->job.unknowns.bounds[p].name, *unit;
            for (int t = 0; t < nstate; t++) {
                struct parameter parameter;
                if (parameter_find(&state[t].w.rotor, name, &parameter, &unit) == 0 &&
                    unknown_of(state[t].state, parameter) < 0 && !was_set(&state[t], name))
                    put_set(&state[t], name, *parameter_value(&state[t].w.rotor, parameter));
            }
        }
}

static int copy_segments(struct pool *pool, struct written *s)
{
    struct rotor *rotor = &s->w.rotor;
    struct segment *copy = POOL_ARRAY(pool, struct segment, rotor->nsegment);
    if (!copy)
        return ROTID_ERROR_MEMORY;
    memcpy(copy, rotor->segment, (size_t)rotor->nsegment * sizeof *copy);
    rotor->segment = copy;
    return ROTID_OK;
}

int deck_put_sets(struct pool *pool, int nstate, struct written *state)
{
    for (int s = 0; s < nstate; s++)
        if (copy_segments(pool, &state[s]))
            return ROTID_ERROR_MEMORY;
    for (int g = 0; g < state[0].w.rotor.ngroup; g++) {
        const char *name = state[0].w.rotor.group[g].name;
        if (!can_be_set(nstate, state, name))
            continue;
        set_lengths(nstate, state, name);
        set_materials(pool, nstate, state, name);
    }
    set_what_is_known(nstate, state);
    for (int s = 0; s < nstate; s++)
        if (state[s].set.status)
            return state[s].set.status;
    return ROTID_OK;
}
