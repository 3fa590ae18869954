/* A deck that reads as it is meant, from the text that it was read from. The text is edited where it has to say something else,
 * read again, and compared with what is meant; where the two differ in what can be stated (*FIT, elements, noise, the data), that
 * is stated as well, so that as little as possible changes:
 *
 *   1 prepare   what is meant at the starts, inside the physical bounds of its causes, which other names lack names for
 *   2 compose   edits of the parts (deck_edit.c): starts, suspects that were named, and what step 4 asked for; then what is new
 *   3 read      the whole text as any deck is read
 *   4 compare   deck_compare.c: nothing differs: done; else step 2 with more, as long as there is more that can be stated */
#include "deck/deck_row.h"
#include "running/running.h"

#include <strings.h>

struct writing {
    struct pool *pool;
    const struct states *given;
    struct states meant;
    const struct deck_write_options *options;
    struct deck_edit edit;
    unsigned *todo; /* [meant.nstate] of enum deck_difference */
    int *of;        /* [meant.nstate] which *STATE of the text it is, -1: that of a deck without */
};

/* ------------------------------------------------------------------------------------------------ what is meant */

/* A start has to lie between the bounds and must not be zero, being the scale of the parameter. */
static double start_of(const rotid_parameter *bounds, double x)
{
    double margin = 1e-6 * (bounds->upper - bounds->lower);
    if (!(x > bounds->lower))
        x = bounds->lower + margin;
    if (!(x < bounds->upper))
        x = bounds->upper - margin;
    return x != 0 ? x : bounds->start;
}

static int is_new(const struct rotor *given, const struct effect *effect)
{
    for (int i = 0; i < given->neffect; i++)
        if (same_text(given->effect[i].name, effect->name))
            return 0;
    return 1;
}

/* Physical bounds may move with the model, such as those of a joint with E beside it: what is written has to lie inside those of
 * the deck it is written into. */
static double inside_physical(const struct rotor *rotor, const struct effect *effect, int p, double value)
{
    const struct cause_kind *kind = catalogue_of(effect);
    double lower, upper;
    if (!kind)
        return value;
    cause_reach(kind, rotor, effect, p, &lower, &upper);
    return fmin(fmax(value, lower), upper);
}

/* A cause is said to act on a spring or a disk by its name: those without one get one. */
static void name_target(struct pool *pool, struct rotor *rotor, const struct effect *effect)
{
    const struct cause_kind *kind = catalogue_of(effect);
    const char **name = kind && effect->target >= 0 ? deck_name_of(rotor, kind->target, effect->target) : NULL;
    if (name && !*name)
        *name = scan_free_name(pool, rotor, kind->target == TARGET_SPRING ? "spring" : "disk");
}

static void prepare_state(struct writing *w, int s)
{
    struct state *state = &w->meant.state[s];
    struct job *job = &state->job;
    const struct rotor *given = &w->given->state[s].job.rotor;
    int n = job->unknowns.nparameter;
    rotid_parameter *bounds = POOL_COPY(w->pool, job->unknowns.bounds, n, 0);
    double *x = POOL_ARRAY(w->pool, double, n);
    struct rotor rotor;
    if (!bounds || !x || deck_copy_rotor(w->pool, &job->rotor, &rotor))
        return;
    for (int p = 0; p < n; p++) {
        const struct parameter *parameter = &job->unknowns.parameter[p];
        const struct effect *effect = parameter->kind == PARAMETER_EFFECT ? &rotor.effect[parameter->index] : NULL;
        if (effect && is_new(given, effect)) {
            bounds[p].lower = inside_physical(given, effect, parameter->component, bounds[p].lower);
            bounds[p].upper = inside_physical(given, effect, parameter->component, bounds[p].upper);
        }
        double start = w->options->x ? w->options->x[state_unknown(state, p)] : bounds[p].start;
        x[p] = bounds[p].start = start_of(&bounds[p], start);
    }
    parameters_set(&rotor, n, job->unknowns.parameter, x);
    for (struct effect *effect = rotor.effect; effect && effect < rotor.effect + rotor.neffect; effect++) {
        const struct cause_kind *kind = catalogue_of(effect);
        for (int p = 0; p < effect_parameters(effect) && kind && is_new(given, effect); p++)
            if (effect->value[p] != kind->parameter[p].neutral)
                effect->value[p] = inside_physical(given, effect, p, effect->value[p]);
        name_target(w->pool, &rotor, effect);
    }
    job->rotor = rotor;
    job->unknowns.bounds = bounds;
    job->units = w->given->state->job.units;
}

/* One mesh for what is common to states: the finest of theirs. */
static void share_mesh(struct states *meant)
{
    for (int s = 0; s < meant->nstate; s++)
        for (int t = 0; t < meant->nstate; t++) {
            struct rotor *a = &meant->state[s].job.rotor;
            const struct rotor *b = &meant->state[t].job.rotor;
            for (int i = 0; i < a->nsegment && i < b->nsegment; i++)
                if (b->segment[i].elements > a->segment[i].elements)
                    a->segment[i].elements = b->segment[i].elements;
            for (int i = 0; i < a->nbars && i < b->nbars; i++)
                if (b->bars[i].elements > a->bars[i].elements)
                    a->bars[i].elements = b->bars[i].elements;
        }
}

/* Whether all states have it, with the same values: a place may lie beyond the end of a shorter one. */
static int is_in_all(const struct writing *w, const struct effect *effect)
{
    int all = 0;
    for (int s = 0; s < w->meant.nstate; s++)
        for (int i = 0; i < w->meant.state[s].job.rotor.neffect; i++) {
            const struct effect *other = &w->meant.state[s].job.rotor.effect[i];
            int same = same_text(other->name, effect->name);
            for (int p = 0; p < effect_parameters(effect) && same; p++)
                same = deck_is_near(other->value[p], effect->value[p]);
            all += same;
        }
    return all == w->meant.nstate;
}

/* The unknowns of a cause that some states lack are each state's own, as the reader names those. */
static void name_unknowns(struct writing *w)
{
    for (int s = 0; s < w->meant.nstate && w->meant.nstate > 1; s++) {
        const struct job *job = &w->meant.state[s].job;
        for (int p = 0; p < job->unknowns.nparameter; p++) {
            const struct parameter *parameter = &job->unknowns.parameter[p];
            rotid_parameter *bounds = &job->unknowns.bounds[p];
            if (parameter->kind == PARAMETER_EFFECT && bounds->name && !strchr(bounds->name, ':') &&
                !is_in_all(w, &job->rotor.effect[parameter->index]))
                bounds->name = pool_format(w->pool, "%s:%s", w->meant.state[s].name, bounds->name);
        }
    }
}

/* ------------------------------------------------------------------------------------------------ where things stand */

/* The text state of a part that says something of state s: its own one, or -1 of what is common. */
static int is_in(const struct writing *w, const struct deck_part *part, int s)
{
    return part->state == -1 || part->state == w->of[s];
}

static void find_states(struct writing *w)
{
    for (int s = 0; s < w->meant.nstate; s++) {
        w->of[s] = -1;
        for (int i = 0; i < w->edit.npart && w->meant.state[s].name; i++) {
            const char *name = deck_edit_is(&w->edit.part[i], "STATE") ? deck_edit_option(&w->edit.part[i], "NAME") : NULL;
            if (name && same_text(name, w->meant.state[s].name))
                w->of[s] = w->edit.part[i].state;
        }
    }
}

/* Behind the last card of a text state, or of those that are common (-1). */
static int end_of(const struct writing *w, int state)
{
    int at = 0;
    for (int i = 0; i < w->edit.npart; i++)
        if (w->edit.part[i].state == state)
            at = i + 1;
        else if (state < 0)
            break;
    return at;
}

static struct deck_writer writer_of(const struct writing *w, int s)
{
    return (struct deck_writer){.pool = w->pool, .job = &w->meant.state[s].job};
}

static void insert(struct writing *w, int state, const struct deck_writer *cards)
{
    if (cards->length)
        deck_edit_insert(&w->edit, end_of(w, state), cards->text);
}

/* ------------------------------------------------------------------------------------------------ what is searched */

/* "front.k" of "bearings:front.k" */
static const char *own_name(const struct state *state, int p)
{
    const char *name = state->job.unknowns.bounds[p].name;
    size_t length = state->name ? strlen(state->name) : 0;
    return length && !strncasecmp(name, state->name, length) && name[length] == ':' ? name + length + 1 : name;
}

static int find_unknown(const struct state *state, const char *name)
{
    for (int p = 0; p < state->job.unknowns.nparameter; p++)
        if (same_text(own_name(state, p), name))
            return p;
    return -1;
}

struct in_part {
    struct writing *w;
    const struct deck_part *part;
    int s, first; /* first: of a list, the number of the part's first line in it */
};

/* A line of *IDENTIFY: what differs of bounds and start, in the unit of the deck. */
static void edit_unknown(struct deck_line_edit *edit, void *context)
{
    const struct in_part *in = context;
    struct writing *w = in->w;
    const char *name = edit->line->field[0].text;
    for (int s = 0; s < w->meant.nstate; s++) {
        const struct state *meant = &w->meant.state[s], *given = &w->given->state[s];
        int p = is_in(w, in->part, s) ? find_unknown(meant, name) : -1,
            q = is_in(w, in->part, s) ? find_unknown(given, name) : -1;
        if (p < 0 || q < 0 || (in->part->state < 0 && own_name(given, q) != given->job.unknowns.bounds[q].name))
            continue;
        const rotid_parameter *to = &meant->job.unknowns.bounds[p], *from = &given->job.unknowns.bounds[q];
        const double value[] = {to->lower, to->upper, to->start}, was[] = {from->lower, from->upper, from->start};
        for (int k = 0; k < 3; k++) {
            struct deck_writer number = writer_of(w, s);
            if (value[k] == was[k])
                continue;
            deck_put_number(&number, "", value[k], to->unit ? to->unit : "");
            edit->value[k + 1] = number.text;
        }
        return;
    }
}

/* A suspect that was named: it stands among the causes of the model, which come last. */
static int is_named_suspect(struct writing *w, const struct deck_part *part)
{
    const char *name = deck_edit_is(part, "CAUSE") ? deck_edit_option(part, "NAME") : NULL;
    for (int s = 0; s < w->given->nstate && name; s++) {
        int was = 0, is = 0;
        for (int i = 0; i < w->given->state[s].job.unknowns.nsuspect; i++)
            was |= is_in(w, part, s) && same_text(w->given->state[s].job.unknowns.suspect[i].effect.name, name);
        for (int i = 0; i < w->meant.state[s].job.unknowns.nsuspect; i++)
            is |= same_text(w->meant.state[s].job.unknowns.suspect[i].effect.name, name);
        if (was && !is)
            return 1;
    }
    return 0;
}

static void edit_searched(struct writing *w)
{
    for (int i = 0; i < w->edit.npart; i++) {
        struct in_part in = {.w = w, .part = &w->edit.part[i]};
        if (deck_edit_is(in.part, "IDENTIFY"))
            deck_edit_lines(&w->edit, i, edit_unknown, &in);
        else if (is_named_suspect(w, in.part))
            deck_edit_clear(&w->edit, i);
    }
}

/* ------------------------------------------------------------------------------------------------ *FIT and what is held out */

static int find_card(const struct writing *w, const char *name, int state)
{
    for (int i = 0; i < w->edit.npart; i++)
        if (deck_edit_is(&w->edit.part[i], name) && w->edit.part[i].state == state)
            return i;
    return -1;
}

/* The card, which is made where there is none. */
static int card_at(struct writing *w, const char *name, int state)
{
    int at = find_card(w, name, state);
    return at >= 0 || w->pool->out_of_memory ? at : deck_edit_new(&w->edit, end_of(w, state), name);
}

static void edit_fit(struct writing *w)
{
    const struct job_options *options = &w->meant.state->job.options;
    int at = card_at(w, "FIT", -1);
    if (w->pool->out_of_memory)
        return;
    if (options->fit.functional >= 0)
        deck_edit_set(&w->edit, at, "FUNCTIONAL", functional_words[options->fit.functional]);
    deck_edit_set(&w->edit, at, "REDUCTION", reduction_words[options->fit.reduction]);
    if (options->fit.derivative != ROTID_NELSON || deck_edit_option(&w->edit.part[at], "DERIVATIVE"))
        deck_edit_set(&w->edit, at, "DERIVATIVE", derivative_words[options->fit.derivative]);
    if (options->solid || deck_edit_option(&w->edit.part[at], "MODEL"))
        deck_edit_set(&w->edit, at, "MODEL", options->solid ? "SOLID" : "BEAM");
}

static void set_or_drop(struct writing *w, int at, const char *option, const char *value)
{
    if (!w->pool->out_of_memory && ((value && *value) || deck_edit_option(&w->edit.part[at], option)))
        deck_edit_set(&w->edit, at, option, value && *value ? value : NULL);
}

/* "RUNUP, 1-3": HOLDOUT with the measured critical speeds, which are not the writer's to take away. */
static const char *with_runup(const struct writing *w, const char *list)
{
    const struct machine *machine = w->meant.machine;
    return !machine || !machine->runup_held ? list
                                            : pool_format(w->pool, "RUNUP%s%s", list && *list ? ", " : "", list ? list : "");
}

/* The modes that are held out: on *FIT, of states on the card of each, *FIT has those that are held out as a whole. */
static void edit_holdout(struct writing *w)
{
    int fit = card_at(w, "FIT", -1);
    struct deck_writer whole = {.pool = w->pool};
    for (int s = 0; s < w->meant.nstate; s++) {
        struct deck_writer modes = writer_of(w, s);
        const struct job *job = &w->meant.state[s].job;
        int all = w->meant.nstate > 1 && job->measurement.nmode && !job_fitted(job, job->measurement.holdout);
        if (all)
            deck_put(&whole, "%sSTATE:%s", whole.length ? ", " : "", w->meant.state[s].name);
        else
            deck_put_holdout(&modes);
        int at = w->of[s] < 0 ? fit : find_card(w, "STATE", w->of[s]);
        set_or_drop(w, at, "MODES", NULL);
        set_or_drop(w, at, "HOLDOUT", w->of[s] < 0 ? with_runup(w, modes.text) : modes.text);
    }
    if (w->of[0] < 0)
        return;
    set_or_drop(w, fit, "MODES", NULL);
    set_or_drop(w, fit, "HOLDOUT", with_runup(w, whole.text));
}

/* ------------------------------------------------------------------------------------------------ elements */

static int group_of(const struct rotor *rotor, const char *name)
{
    return name ? deck_find_group(rotor, rotor_axis_groups(rotor), name, strlen(name)) : -1;
}

static const struct segment *segment_of(const struct rotor *rotor, int group, int number)
{
    for (int s = 0; s < rotor->nsegment; s++)
        if (rotor->segment[s].group == group && !number--)
            return &rotor->segment[s];
    return NULL;
}

static void set_elements(struct deck_line_edit *edit, void *context)
{
    const struct in_part *in = context;
    const struct segment *to = segment_of(&in->w->meant.state[in->s].job.rotor, in->first, edit->number),
                         *from = segment_of(&in->w->given->state[in->s].job.rotor, in->first, edit->number);
    if (!to || (deck_has(edit->line, 3) && from && to->elements == from->elements))
        return;
    edit->value[2] = edit->line->count > 2 ? NULL : "0"; /* the inner diameter was left out */
    edit->value[3] = pool_format(in->w->pool, "%d", to->elements);
}

/* A card has one line. */
static void set_bar_elements(struct deck_line_edit *edit, void *context)
{
    const struct in_part *in = context;
    int to = in->w->meant.state[in->s].job.rotor.bars[in->first].elements;
    if (to != in->w->given->state[in->s].job.rotor.bars[in->first].elements)
        edit->value[3] = pool_format(in->w->pool, "%d", to);
}

/* The sections of a table become lines: a table is not ours to change. first ... last: its groups, a card each; `named`: the card
 * has the name of the only one. */
static void write_sections(struct writing *w, int at, int s, int first, int last, int named)
{
    const struct rotor *rotor = &w->meant.state[s].job.rotor;
    struct deck_writer lines = writer_of(w, s);
    const char *card = w->edit.part[at].read.name;
    for (int g = first; g <= last; g++) {
        const struct segment *segment;
        if (g > first)
            deck_put(&lines, "*%s, NAME=%s, MATERIAL=%s\n", card, rotor->group[g].name, rotor->group[g].material.name);
        for (int i = 0; (segment = segment_of(rotor, g, i)); i++)
            deck_put_values(&lines, deck_rows(card), segment);
    }
    if (!named) {
        deck_edit_set(&w->edit, at, "NAME", rotor->group[first].name);
        deck_edit_set(&w->edit, at, "MATERIAL", rotor->group[first].material.name);
    }
    deck_edit_set(&w->edit, at, "FILE", NULL);
    deck_edit_append(&w->edit, at, lines.text);
}

static int is_sections(const struct deck_part *part)
{
    return deck_edit_is(part, "SHAFT") || deck_edit_is(part, "BEAM");
}

/* The last of the groups from `first` on that no *SHAFT or *BEAM has the name of: those of a table with a column of groups. */
static int last_unnamed(const struct writing *w, const struct rotor *rotor, int first)
{
    int last = first;
    for (; last < rotor_axis_groups(rotor); last++)
        for (int i = 0; i < w->edit.npart; i++)
            if (is_sections(&w->edit.part[i]) && group_of(rotor, deck_edit_option(&w->edit.part[i], "NAME")) == last)
                return last - 1;
    return last - 1;
}

static void edit_elements(struct writing *w)
{
    for (int i = 0, before = -1; i < w->edit.npart; i++) {
        struct deck_part *part = &w->edit.part[i];
        struct in_part in = {.w = w, .part = part};
        int is_bars = deck_edit_is(part, "BARS");
        while (in.s < w->meant.nstate && !is_in(w, part, in.s))
            in.s++;
        if (in.s == w->meant.nstate || !(is_bars || is_sections(part)))
            continue;
        if (is_bars) {
            for (int k = 0; k < i; k++)
                in.first += deck_edit_is(&w->edit.part[k], "BARS") && is_in(w, &w->edit.part[k], in.s);
            deck_edit_lines(&w->edit, i, set_bar_elements, &in);
            continue;
        }
        const struct rotor *rotor = &w->meant.state[in.s].job.rotor;
        int last = in.first = group_of(rotor, deck_edit_option(part, "NAME")), named = in.first >= 0;
        int is_table = deck_edit_option(part, "FILE") != NULL;
        if (is_table && !named) {
            in.first = before + 1;
            last = last_unnamed(w, rotor, in.first);
        }
        if (is_table && in.first <= last)
            write_sections(w, i, in.s, in.first, last, named);
        else if (is_table) /* its groups stand with those of the table before */
            deck_edit_clear(&w->edit, i);
        else if (named)
            deck_edit_lines(&w->edit, i, set_elements, &in);
        before = last > before ? last : before;
    }
}

/* ------------------------------------------------------------------------------------------------ noise, data */

/* Whether all states need *NOISE, the same one, and none has a card of its own: it is common then. */
static int shares_noise(const struct writing *w)
{
    double first[2], other[2];
    int same = 1;
    deck_noise_of_all(&w->meant.state->job, &first[0], &first[1]);
    for (int s = 0; s < w->meant.nstate; s++) {
        deck_noise_of_all(&w->meant.state[s].job, &other[0], &other[1]);
        same &= (w->todo[s] & (DECK_OTHER_NOISE | DECK_OTHER_DATA)) == DECK_OTHER_NOISE && deck_is_near(first[0], other[0]) &&
                deck_is_near(first[1], other[1]) && find_card(w, "NOISE", w->of[s]) < 0;
    }
    return same;
}

static void edit_noise(struct writing *w, int s)
{
    double frequency, shape;
    deck_noise_of_all(&w->meant.state[s].job, &frequency, &shape);
    char text[DECK_NUMBER_LENGTH];
    if (!isfinite(frequency) && !isfinite(shape))
        return;
    int at = card_at(w, "NOISE", w->meant.nstate > 1 && shares_noise(w) ? -1 : w->of[s]);
    if (isfinite(frequency))
        deck_edit_set(&w->edit, at, "FREQUENCY", deck_number_text(frequency, text));
    if (isfinite(shape))
        deck_edit_set(&w->edit, at, "SHAPE", deck_number_text(shape, text));
}

static void edit_data(struct writing *w, int s)
{
    static const char *const names[] = {"MODES", "SHAPE", "FREQUENCIES", "MEASURED", "NOISE", "SENSORS"};
    int first = -1, sensors = (w->todo[s] & DECK_OTHER_SENSORS) != 0, stated = 0, file = 0;
    for (int i = 0; i < w->edit.npart; i++) {
        stated |= deck_edit_is(&w->edit.part[i], "SENSORS") && is_in(w, &w->edit.part[i], s);
        file |= deck_edit_is(&w->edit.part[i], "MEASURED") && is_in(w, &w->edit.part[i], s);
    }
    sensors |= file && !stated;
    for (int i = w->edit.npart - 1; i >= 0; i--)
        for (int k = 0; k < 5 + sensors; k++)
            if (deck_edit_is(&w->edit.part[i], names[k]) && w->edit.part[i].state == w->of[s]) {
                deck_edit_clear(&w->edit, i);
                first = i;
            }
    struct deck_writer cards = writer_of(w, s);
    int noise = find_card(w, "NOISE", -1);
    double std = w->meant.state[s].job.measurement.nmode ? w->meant.state[s].job.measurement.frequency_std[0] : NAN;
    deck_put_measured(&cards, sensors);
    if (w->of[s] >= 0 && noise >= 0 && isfinite(std) && (!cards.text || !strstr(cards.text, "*NOISE")))
        deck_put_noise(&cards, std, NAN); /* in place of a common one, whose floor would add to the deviations of the modes */
    if (first < 0)
        insert(w, w->of[s], &cards);
    else if (cards.length) {
        deck_put(&cards, "%.*s", (int)w->edit.part[first].length, w->edit.part[first].text);
        w->edit.part[first].text = cards.text;
        w->edit.part[first].length = cards.length;
    }
}

/* ------------------------------------------------------------------------------------------------ names */

/* The name of spring or disk i, NULL where it has none. */
static const char *name_of_part(const struct rotor *rotor, const char *card, int i)
{
    const char **name = deck_name_of(rotor, !strcmp(card, "SPRING") ? TARGET_SPRING : TARGET_DISK, i);
    return name ? *name : NULL;
}

/* A line of a list of springs or disks whose item has got a name stands under a card of its own, and so does what follows. */
static void split_list(struct deck_line_edit *edit, void *context)
{
    const struct in_part *in = context;
    const struct rotor *meant = &in->w->meant.state[in->s].job.rotor, *given = &in->w->given->state[in->s].job.rotor;
    const char *card = in->part->read.name;
    int at = in->first + edit->number;
    const char *name = name_of_part(given, card, at) ? NULL : name_of_part(meant, card, at);
    if (edit->number && name)
        edit->before = pool_format(in->w->pool, "*%s, NAME=%s\n", card, name);
    else if (edit->number && name_of_part(meant, card, at - 1))
        edit->before = pool_format(in->w->pool, "*%s\n", card);
}

/* Names of springs or disks on which a new cause acts. */
static void edit_names(struct writing *w, int s, const char *card)
{
    int next = 0;
    const struct rotor *meant = &w->meant.state[s].job.rotor, *given = &w->given->state[s].job.rotor;
    for (int own = 0; own < 2; own++)
        for (int i = 0; i < w->edit.npart; i++) {
            struct in_part in = {.w = w, .part = &w->edit.part[i], .s = s, .first = next};
            int lines = in.part->read.nline, any = 0;
            if (!deck_edit_is(in.part, card) || !is_in(w, in.part, s) || (in.part->state >= 0) != own)
                continue;
            for (int k = next; k < next + lines; k++)
                any |= name_of_part(meant, card, k) && !name_of_part(given, card, k);
            const char *first = name_of_part(meant, card, next);
            next += lines;
            if (any)
                deck_edit_lines(&w->edit, i, split_list, &in);
            if (any && first)
                deck_edit_set(&w->edit, i, "NAME", first);
        }
}

/* ------------------------------------------------------------------------------------------------ what is new */

/* What state s has besides: of the causes and unknowns those that are common to all, or those of its own. */
static void put_new(struct writing *w, int s, int common, struct deck_writer *out)
{
    const struct state *meant = &w->meant.state[s], *given = &w->given->state[s];
    int any = 0, alone = w->of[s] < 0;
    if (!common || alone)
        deck_put_corrections(out, given->job.measurement.ncorrection);
    for (int i = 0; i < meant->job.rotor.neffect; i++) {
        const struct effect *effect = &meant->job.rotor.effect[i];
        int in_all = alone || (w->meant.nstate > 1 && is_in_all(w, effect));
        if (is_new(&given->job.rotor, effect) && in_all == common)
            deck_put_cause(out, effect);
    }
    for (int p = 0; p < meant->job.unknowns.nparameter; p++) {
        const char *name = own_name(meant, p);
        int is_common = alone || (w->meant.nstate > 1 && name == meant->job.unknowns.bounds[p].name);
        if (find_unknown(given, name) >= 0 || is_common != common)
            continue;
        deck_put(out, "%s", any++ ? "" : "*IDENTIFY\n");
        deck_put_unknown(out, &meant->job.unknowns.bounds[p], name);
    }
}

/* A line of text that a deck takes for text. */
static void deck_put_text(struct deck_writer *w, const char *text)
{
    char line[DECK_LINE_LENGTH + 1];
    size_t length = 0, taken;
    text += strspn(text, "* \t\r\n");
    for (; *text; text += taken) {
        size_t bytes = text_visible(text);
        taken = bytes ? bytes : text_utf8(text) ? text_utf8(text) : 1;
        const char *shown = (*text == '*' && text[1] == '*') || (unsigned char)*text < ' ' ? " "
                            : bytes                                                        ? text
                                                                                           : TEXT_REPLACEMENT;
        size_t count = shown == text ? bytes : strlen(shown);
        if (length + count > DECK_LINE_LENGTH)
            break;
        memcpy(line + length, shown, count);
        length += count;
    }
    line[length] = 0;
    if (length)
        deck_put(w, "%s\n", line);
}

static void add_heading(struct writing *w)
{
    struct deck_writer lines = {.pool = w->pool};
    int at = find_card(w, "HEADING", -1), first = 0;
    for (int i = 0; i < w->options->nextra; i++)
        deck_put_text(&lines, w->options->extra[i]);
    while (first < w->edit.npart && !*w->edit.part[first].read.name)
        first++;
    if (lines.length && at >= 0)
        deck_edit_append(&w->edit, at, lines.text);
    else if (lines.length)
        deck_edit_insert(&w->edit, first, pool_format(w->pool, "*HEADING\n%s", lines.text));
}

/* ------------------------------------------------------------------------------------------------ the text */

/* Lines end as those of the deck do, and a byte that is no character and no letter of Latin-1 goes: a terminal may obey it. */
static char *finish(struct pool *pool, const char *deck, const char *text)
{
    const char *feed = strchr(deck, '\n');
    int carriage = feed && feed > deck && feed[-1] == '\r';
    struct deck_writer out = {.pool = pool};
    for (const char *from = text, *c = from; c && *c; from = c) {
        size_t bytes;
        while (*c && *c != '\n' && ((bytes = text_visible(c)) || *c == '\t' || *c == '\r' || (unsigned char)*c >= 0xa0))
            c += bytes ? bytes : 1;
        deck_put(&out, "%.*s%s", (int)(c - from), from,
                 !*c                                        ? ""
                 : *c != '\n'                               ? TEXT_REPLACEMENT
                 : carriage && !(c > text && c[-1] == '\r') ? "\r\n"
                                                            : "\n");
        c += *c != 0;
    }
    return out.text;
}

static int compose(struct writing *w, char **text)
{
    struct deck_writer out = {.pool = w->pool};
    unsigned any = 0;
    const struct deck_origin *origin = w->given->state->job.origin;
    int status = deck_edit_open(&w->edit, w->pool, origin);
    if (status)
        return status;
    find_states(w);
    for (int s = 0; s < w->meant.nstate; s++)
        any |= w->todo[s];
    edit_searched(w);
    for (int s = 0; s < w->meant.nstate; s++) {
        edit_names(w, s, "SPRING");
        edit_names(w, s, "DISK");
    }
    if (any & DECK_OTHER_ELEMENTS)
        edit_elements(w);
    for (int s = 0; s < w->meant.nstate; s++) {
        if (w->todo[s] & (DECK_OTHER_DATA | DECK_OTHER_SENSORS))
            edit_data(w, s);
        else if (w->todo[s] & DECK_OTHER_NOISE)
            edit_noise(w, s);
    }
    for (int s = 0; s < w->meant.nstate; s++) {
        struct deck_writer own = writer_of(w, s), common = writer_of(w, s);
        if (!s) {
            put_new(w, 0, 1, &common);
            insert(w, -1, &common);
        }
        if (w->of[s] >= 0) {
            put_new(w, s, 0, &own);
            insert(w, w->of[s], &own);
        }
    }
    if (any & DECK_OTHER_FIT)
        edit_fit(w);
    if (any & DECK_OTHER_HOLDOUT)
        edit_holdout(w);
    add_heading(w);
    deck_edit_text(&w->edit, &out);
    *text = finish(w->pool, origin->file[origin->nfile - 1].text, out.text);
    return !*text || w->pool->out_of_memory ? ROTID_ERROR_MEMORY : ROTID_OK;
}

int deck_read_back(struct pool *pool, const char *path, const char *text, const char *directory, struct message_list *notes,
                   struct states *states)
{
    struct message_list messages;
    message_open(&messages, pool);
    const struct deck_memory memory = {.name = path, .length = strlen(text), .text = text, .directory = directory};
    int status = deck_read_states(pool, path, &memory, 0, NULL, &messages, states);
    for (size_t i = 0; i < messages.count && status; i++)
        if (messages.item[i].severity == SEVERITY_ERROR) {
            message_add(notes, SEVERITY_ERROR, path, 1, 1, "the deck that is to be written would not be read: line %d, %s",
                        messages.item[i].line, messages.item[i].text);
            break;
        }
    return status == ROTID_ERROR_MEMORY || !status ? status : ROTID_ERROR_ARGUMENT;
}

/* What differs of each state into todo: of noise that *NOISE did not give, the data. 0 where nothing does, 1 where there is more
 * to be stated, -1 with the card at which there is not. */
static int compare(struct writing *w, const struct states *read, const char **card)
{
    int more = 0, rest = 0;
    if (read->nstate != w->meant.nstate) {
        *card = "STATE";
        return -1;
    }
    for (int s = 0; s < read->nstate; s++) {
        const char *one = "";
        unsigned bits = deck_compare(w->pool, &w->meant.state[s].job, &read->state[s].job, &one);
        if (bits & w->todo[s] & DECK_OTHER_NOISE)
            bits |= DECK_OTHER_DATA;
        more |= (bits & ~w->todo[s] & ~(unsigned)DECK_OTHER_MODEL) != 0;
        if (bits && !**card)
            *card = one;
        rest |= bits != 0;
        w->todo[s] |= bits;
    }
    return more ? 1 : rest ? -1 : 0;
}

int deck_write(struct pool *pool, const struct states *given, const struct states *meant,
               const struct deck_write_options *options, struct message_list *notes, char **text)
{
    static const struct deck_write_options none = {0};
    struct writing w = {.pool = pool, .given = given, .options = options ? options : &none};
    int left = 1;
    w.todo = POOL_ARRAY(pool, unsigned, meant->nstate);
    w.of = POOL_ARRAY(pool, int, meant->nstate);
    *text = NULL;
    if (given->nstate != meant->nstate)
        return ROTID_ERROR_ARGUMENT;
    if (!w.todo || !w.of || states_copy(pool, meant, &w.meant))
        return ROTID_ERROR_MEMORY;
    for (int s = 0; s < meant->nstate; s++)
        prepare_state(&w, s);
    share_mesh(&w.meant);
    name_unknowns(&w);
    int status = pool->out_of_memory ? ROTID_ERROR_MEMORY : ROTID_OK;
    const char *path = given->state->job.deck, *card = "";
    while (!status && left > 0) { /* there is more to be stated each time */
        struct states read;
        card = "";
        status = compose(&w, text);
        if (!status)
            status = deck_read_back(pool, path, *text, ".", notes, &read);
        left = status ? 1 : compare(&w, &read, &card);
    }
    if (!status && left)
        status = message_refuse(notes, ROTID_ERROR_ARGUMENT, path, 1, 1,
                                "no deck is written: *%s would be read as something else than what is meant", card);
    status = pool->out_of_memory ? ROTID_ERROR_MEMORY : status;
    *text = status ? NULL : *text;
    return status;
}
