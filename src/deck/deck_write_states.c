/* Decks of several states. Each state is written as the deck of one, card by card; common are the cards that the decks of all
 * states begin with, kind by kind, and what is left of a deck stands behind its *STATE. */
#include "deck/deck.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/base.h"
#include "deck/card_table.h"
#include "rotid.h"

/* What *SET says of each state: how its groups differ from the common ones, and what is known in it of the common unknowns. */

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

/* Gives the groups of all states [nstate] one material and one length each where *SET can say how they differ, and writes the
 * lines of *SET. ROTID_OK, ROTID_ERROR_MEMORY or, of a name that no deck can say, ROTID_ERROR_ARGUMENT. */
static int deck_put_sets(struct pool *pool, int nstate, struct written *state)
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

/* ------------------------------------------------------------------------------------------------ cards */

static const struct deck_card *kind_of(const char *line)
{
    char name[32];
    size_t count = strcspn(line + 1, ", \n");
    (void)snprintf(name, sizeof name, "%.*s", (int)count, line + 1);
    return !strcmp(name, "MATERIAL") || !strcmp(name, "ELASTIC") || !strcmp(name, "DENSITY") ? NULL
           : !strcmp(name, "BEAM") ? deck_card_find("SHAFT") /* one list */
                                   : deck_card_find(name);
}

static int count_lines(const char *text, size_t length)
{
    int count = 1;
    for (size_t i = 0; i < length; i++)
        count += text[i] == '\n';
    return count;
}

/* Adds the cards of the text from `begin` on. */
static void split(struct written *s, size_t begin, int part)
{
    struct block *block = NULL;
    for (size_t i = begin, next; i < s->w.length; i = next) {
        const char *line = s->w.text + i;
        next = i + strcspn(line, "\n") + 1;
        if (*line == '*' && (!block || block->kind)) {
            block = &s->block[s->nblock++];
            *block = (struct block){.text = line, .part = part};
        }
        if (!block) /* none: a deck begins with a card */
            continue;
        if (*line == '*')
            block->kind = kind_of(line);
        block->length += next - i;
    }
}

/* The cards of a state, with what is common of its material taken out. */
static int write_cards(struct pool *pool, struct written *s)
{
    size_t end[3];
    deck_write_model(&s->w);
    deck_write_measured(&s->w);
    end[0] = s->w.length;
    deck_write_corrections(&s->w);
    end[1] = s->w.length;
    deck_write_causes(&s->w);
    deck_write_frf(&s->w);
    end[2] = s->w.length;
    if (s->w.status)
        return s->w.status;
    s->block = POOL_ARRAY(pool, struct block, count_lines(s->w.text ? s->w.text : "", s->w.length));
    if (!s->block)
        return ROTID_ERROR_MEMORY;
    for (int part = 0; part < 3; part++) {
        s->w.length = end[part];
        split(s, part ? end[part - 1] : 0, part);
    }
    return ROTID_OK;
}

/* Card n of the kind of this one; NULL: there are fewer. */
static struct block *nth(const struct written *s, const struct block *like, int n)
{
    for (int i = 0; i < s->nblock; i++)
        if (s->block[i].kind == like->kind && s->block[i].part == like->part && !n--)
            return &s->block[i];
    return NULL;
}

static int in_all(int nstate, const struct written *state, const struct block *block, int n)
{
    for (int s = 1; s < nstate; s++) {
        const struct block *other = nth(&state[s], block, n);
        if (!other || other->length != block->length || memcmp(other->text, block->text, block->length) != 0)
            return 0;
    }
    return 1;
}

/* The cards with which the lists of all states begin; of those that a state has in place of the common ones all or none. */
static void find_common(int nstate, struct written *state)
{
    for (int i = 0; i < state[0].nblock; i++) {
        const struct block *block = &state[0].block[i];
        int n = 0, all = 1;
        if (block->kind->states == CARD_OF_STATE || nth(&state[0], block, 0) != block)
            continue;
        while (nth(&state[0], block, n) && in_all(nstate, state, nth(&state[0], block, n), n))
            n++;
        for (int s = 0; s < nstate; s++)
            all &= !nth(&state[s], block, n);
        if (block->kind->states == CARD_REPLACES && !all)
            continue;
        for (int s = 0; s < nstate; s++)
            for (int k = 0; k < n; k++)
                nth(&state[s], block, k)->common = 1;
    }
}

static void put_blocks(struct deck_writer *out, const struct written *s, int common)
{
    for (int i = 0; i < s->nblock; i++)
        if (s->block[i].common == common)
            deck_put(out, "%.*s", (int)s->block[i].length, s->block[i].text);
}

/* ------------------------------------------------------------------------------------------------ the deck */

static void put_unknown(struct deck_writer *out, const struct written *s, int p, const char *name)
{
    struct deck_writer line = s->w; /* of its values, into a text of its own */
    line.text = NULL;
    line.length = line.room = 0;
    deck_write_unknown(&line, p, name);
    out->status = out->status ? out->status : line.status;
    if (!line.status)
        deck_put(out, "%s", line.text);
}

/* Whether unknown p of all is the next common one of every state that has it: none of those before it is still to be put. */
static int is_next(const struct states *states, const struct written *state, int p, const int *done, int *of, int *own)
{
    *of = -1;
    for (int s = 0; s < states->nstate; s++)
        for (int q = 0; q < states->state[s].job.unknowns.nparameter; q++) {
            if (!state[s].common[q] || states->state[s].unknown[q] != p)
                continue;
            for (int before = 0; before < q; before++)
                if (state[s].common[before] && !done[states->state[s].unknown[before]])
                    return 0;
            *of = s;
            *own = q;
        }
    return *of >= 0;
}

/* In an order in which every state has them. */
static void put_common_unknowns(struct deck_writer *out, const struct states *states, const struct written *state)
{
    int *done = POOL_ARRAY(out->pool, int, states->nparameter), any = 0, of = 0, own = 0, p;
    if (!done)
        out->status = ROTID_ERROR_MEMORY;
    do {
        for (p = 0; !out->status && p < states->nparameter; p++)
            if (!done[p] && is_next(states, state, p, done, &of, &own))
                break;
        if (out->status || p == states->nparameter)
            return;
        deck_put(out, "%s", any++ ? "" : "*IDENTIFY\n");
        put_unknown(out, &state[of], own, states->bounds[p].name);
        done[p] = 1;
    } while (1);
}

/* "front.k" of "bearings:front.k" */
static const char *own_name(const struct state *state, int p)
{
    const char *name = state->job.unknowns.bounds[p].name;
    size_t length = strlen(state->name);
    return !strncmp(name, state->name, length) && name[length] == ':' ? name + length + 1 : name;
}

/* Those that the common cards name, and causes that somebody has put into all states: into one of them alone they are its own. */
static int find_common_unknowns(struct pool *pool, int nstate, struct written *state)
{
    for (int s = 0; s < nstate; s++) {
        const struct job_unknowns *unknowns = &state[s].state->job.unknowns;
        state[s].common = POOL_ARRAY(pool, int, unknowns->nparameter);
        if (!state[s].common)
            return ROTID_ERROR_MEMORY;
        for (int p = 0; p < unknowns->nparameter; p++) {
            const char *name = unknowns->bounds[p].name, *unit;
            struct parameter parameter;
            int all = own_name(state[s].state, p) == name;
            for (int t = 0; t < nstate && p >= state[s].state->ncommon; t++)
                all &= parameter_find(&state[t].w.rotor, name, &parameter, &unit) == 0;
            state[s].common[p] = p < state[s].state->ncommon || all;
        }
    }
    return ROTID_OK;
}

static int is_held_out(const struct job *job)
{
    int fitted = 0;
    for (int k = 0; k < job->measurement.nmode; k++)
        fitted += !job->measurement.holdout[k];
    return job->measurement.nmode && !fitted;
}

/* *FIT, common to all, with the states that are held out as a whole. */
static void put_fit(struct deck_writer *out, const struct states *states)
{
    size_t begin = out->length;
    const char *separator = ", HOLDOUT=STATE:";
    deck_write_fit(out, 0);
    for (int s = 0; s < states->nstate; s++) {
        if (!is_held_out(&states->state[s].job))
            continue;
        if (out->length == begin)
            deck_put_card(out, "FIT");
        else if (!out->status && out->text[out->length - 1] == '\n')
            out->length--;
        deck_put(out, "%s%s\n", separator, states->state[s].name);
        separator = ",\n    STATE:";
    }
}

static void put_state(struct deck_writer *out, struct written *s)
{
    const struct job *job = &s->state->job;
    deck_put_card(out, "STATE");
    deck_put_option(out, "NAME", s->state->name);
    out->job = job;
    if (!is_held_out(job))
        deck_write_holdout(out);
    deck_put(out, "\n");
    if (s->set.length)
        deck_put(out, "*SET\n%s", s->set.text);
    put_blocks(out, s, 0);
    for (int p = 0, any = 0; p < job->unknowns.nparameter; p++) {
        if (s->common[p])
            continue;
        deck_put(out, "%s", any++ ? "" : "*IDENTIFY\n");
        put_unknown(out, s, p, own_name(s->state, p));
    }
}

static int open_state(struct pool *pool, const struct state *from, const double *x, struct written *s)
{
    int n = from->job.unknowns.nparameter;
    double *own = x ? POOL_ARRAY(pool, double, n) : NULL;
    *s = (struct written){.state = from, .set.pool = pool};
    if (x && !own)
        return ROTID_ERROR_MEMORY;
    for (int p = 0; p < n && x; p++)
        own[p] = x[from->unknown[p]];
    return deck_writer_open(&s->w, pool, &from->job, own);
}

static int write_states(struct pool *pool, const struct states *states, const struct deck_write_options *options,
                        struct written *state, struct deck_writer *out)
{
    int nstate = states->nstate, status = ROTID_OK;
    for (int s = 0; s < nstate && !status; s++)
        status = open_state(pool, &states->state[s], options ? options->x : NULL, &state[s]);
    if (!status)
        status = find_common_unknowns(pool, nstate, state);
    if (!status)
        status = deck_put_sets(pool, nstate, state);
    for (int s = 0; s < nstate && !status; s++)
        status = write_cards(pool, &state[s]);
    if (status)
        return status;
    find_common(nstate, state);
    deck_write_heading(out, options);
    put_blocks(out, &state[0], 1);
    put_common_unknowns(out, states, state);
    put_fit(out, states);
    for (int s = 0; s < nstate; s++)
        put_state(out, &state[s]);
    return out->status;
}

int deck_write_states(struct pool *pool, const struct states *states, const struct deck_write_options *options, char **text)
{
    struct deck_writer out = {.pool = pool, .job = &states->state[0].job};
    struct written *state = POOL_ARRAY(pool, struct written, states->nstate);
    *text = NULL;
    if (states->nstate == 1)
        return deck_write(pool, &states->state[0].job, options, text);
    if (!state)
        return ROTID_ERROR_MEMORY;
    out.status = write_states(pool, states, options, state, &out);
    return deck_writer_end(&out, text);
}
