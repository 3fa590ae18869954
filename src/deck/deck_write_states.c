/* Decks of several states. Each state is written as the deck of one, card by card; common are the cards that the decks of all
 * states begin with, kind by kind, and what is left of a deck stands behind its *STATE. */
#include <stdio.h>
#include <string.h>

#include "deck/card_table.h"
#include "deck/deck_write_states.h"
#include "rotid.h"

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
