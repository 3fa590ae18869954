#include "deck/deck_row.h"

static const char *name_of(const struct card *card)
{
    const struct card_option *option = card_option(card, "NAME");
    return option ? option->value : "";
}

/* Where the deck says which states: its *STATE cards, and those that *FIT chooses or holds out. */
struct division {
    int nread, nstate, first; /* first: number of common cards in front */
    const struct card **state;
    const char *list;   /* "bare, disc" for messages */
    const char *chosen; /* FIT, STATE=NAME, or NULL */
};

static const struct card *find_state(const struct division *d, const char *name)
{
    for (int s = 0; s < d->nstate; s++)
        if (same_text(name_of(d->state[s]), name))
            return d->state[s];
    return NULL;
}

static void check_option(struct deck_reader *reader, const struct division *d, const struct card_option *option, const char *name)
{
    if (!find_state(d, name))
        deck_error(reader, option->value_place, d->nstate ? "state %s is not defined, expected one of %s" : "state %s: %s", name,
                   d->nstate ? d->list : "the deck has no *STATE, expected none");
}

static void find_states(struct deck_reader *reader, int nread, struct division *d)
{
    const struct deck_text *text = &reader->text;
    *d = (struct division){.nread = nread, .first = nread, .state = POOL_ARRAY(reader->pool, const struct card *, text->ncard)};
    for (int c = 0; c < nread && d->state; c++) {
        const struct card *card = &text->card[c];
        if (strcmp(card->name, "STATE") != 0)
            continue;
        const char *name = deck_option(reader, card, "NAME", "name");
        d->first = d->nstate ? d->first : c;
        if (name && find_state(d, name))
            deck_error(reader, card_option(card, "NAME")->value_place, "state %s is given twice, expected a new name", name);
        if (name && strpbrk(name, ":,"))
            deck_error(reader, card_option(card, "NAME")->value_place, "%s is no name of a state, expected one without colon",
                       name);
        d->state[d->nstate++] = card;
        d->list = d->nstate == 1 ? name : pool_format(reader->pool, "%s, %s", d->list ? d->list : "", name ? name : "");
    }
    if (d->nstate > DECK_MOST_STATES)
        deck_error(reader, d->state[DECK_MOST_STATES]->place, "the deck has more than %d states, expected fewer",
                   DECK_MOST_STATES);
    for (int c = 0; c < text->ncard; c++) {
        const struct card_option *option = card_option(&text->card[c], "STATE"),
                                 *holdout = card_option(&text->card[c], "HOLDOUT");
        struct deck_holdout held;
        if (strcmp(text->card[c].name, "FIT") != 0)
            continue;
        if (option)
            check_option(reader, d, option, option->value);
        deck_read_holdout(reader->pool, holdout, &held);
        for (int i = 0; i < held.nstate; i++)
            check_option(reader, d, holdout, held.state[i]);
        d->chosen = option ? option->value : d->chosen;
    }
}

/* Cards of which a state has one kind alone, or none. */
static void check_places(struct deck_reader *reader, const struct division *d)
{
    for (int c = 0; c < reader->text.ncard && d->nstate; c++) {
        const struct card *card = &reader->text.card[c];
        int of_state = c >= d->first && c < d->nread;
        if (of_state && deck_stands(card, CARD_COMMON))
            deck_error(reader, card->place, "*%s stands behind *STATE, expected it before the first one: it is common to all",
                       card->name);
        if (!of_state && deck_stands(card, CARD_OF_STATE))
            deck_error(reader, card->place, "*%s stands before the first *STATE, expected it behind that of the state it is of",
                       card->name);
    }
}

/* One override gives all cards of a kind the same file, but what is measured in a state is of that state. */
static void check_overridden_files(struct deck_reader *reader, const struct division *d)
{
    const struct card_option *overridden = NULL;
    const char *name = NULL;
    for (int s = 0; s < d->nstate; s++) {
        const struct card *card = d->state[s] + 1, *end = s + 1 < d->nstate ? d->state[s + 1] : reader->text.card + d->nread;
        for (; card < end; card++) {
            const struct card_option *file = card_option(card, "FILE");
            if (!deck_stands(card, CARD_OF_STATE) || !file || !file->overridden)
                continue;
            if (overridden && name != name_of(d->state[s])) {
                deck_error(reader, file->place,
                           "the states %s and %s would both have what is measured in one file, expected FIT.STATE as well", name,
                           name_of(d->state[s]));
                return;
            }
            overridden = file;
            name = name_of(d->state[s]);
        }
    }
}

/* The text of one state: common cards, but for those in whose place it has its own, then its own. */
static void text_of_state(struct deck_reader *reader, const struct division *d, int s, struct deck_reader *own)
{
    const struct deck_text *text = &reader->text;
    const struct card *begin = d->state[s], *end = s + 1 < d->nstate ? d->state[s + 1] : text->card + d->nread;
    own->text.card = POOL_ARRAY(reader->pool, struct card, text->ncard);
    own->text.ncard = 0;
    if (!own->text.card)
        return;
    for (int c = 0; c < text->ncard; c++) {
        const struct card *card = &text->card[c];
        int replaced = 0;
        if (c >= d->first && c < d->nread)
            continue;
        for (const struct card *other = begin; other < end; other++)
            replaced |= deck_stands(card, CARD_REPLACES) && !strcmp(other->name, card->name);
        if (!replaced)
            own->text.card[own->text.ncard++] = *card;
    }
    own->ncommon = own->text.ncard;
    for (const struct card *card = begin; card < end; card++)
        own->text.card[own->text.ncard++] = *card;
}

static void read_one(struct deck_reader *reader, const struct division *d, int s, struct message_list *messages, struct state *to)
{
    struct deck_reader own = {.pool = reader->pool,
                              .messages = messages,
                              .text = reader->text,
                              .job = &to->job,
                              .nrunning = reader->nrunning,
                              .running = reader->running};
    to->name = d->nstate ? name_of(d->state[s]) : NULL;
    to->job = *reader->job;
    own.state = to->name;
    own.alone = d->nstate < 2 || d->chosen;
    own.ncommon = own.text.ncard;
    if (d->nstate)
        text_of_state(reader, d, s, &own);
    if (!reader->pool->out_of_memory)
        deck_read_cards(&own);
    reader->no_section |= own.no_section;
    reader->text.nfile = own.text.nfile; /* they go on where this one ends */
    reader->text.file = own.text.file;
    to->job.nfile = own.text.nfile;
    to->job.file = own.text.file;
    to->unknown = POOL_ARRAY(reader->pool, int, to->job.unknowns.nparameter);
    for (int p = own.ncommon_unknown; p < to->job.unknowns.nparameter && !own.alone; p++) {
        rotid_parameter *bounds = &to->job.unknowns.bounds[p];
        bounds->name = pool_format(reader->pool, "%s:%s", to->name, bounds->name);
    }
    to->ncommon = own.ncommon_unknown;
}

static int says(const struct message_list *list, const rotid_message *m)
{
    for (size_t i = 0; i < list->count; i++) {
        const rotid_message *n = &list->item[i];
        if (m->line == n->line && m->column == n->column && m->severity == n->severity && !strcmp(m->text, n->text) &&
            !strcmp(m->file ? m->file : "", n->file ? n->file : ""))
            return 1;
    }
    return 0;
}

/* What every state says is said once, the rest with the name of the state. */
static void merge_messages(struct deck_reader *reader, const struct states *states, const struct message_list *of)
{
    for (int s = 0; s < states->nstate; s++)
        for (size_t i = 0; i < of[s].count; i++) {
            const rotid_message *m = &of[s].item[i];
            int all = 1;
            for (int t = 0; t < states->nstate && all; t++)
                all &= says(&of[t], m);
            if (!all || s == 0)
                message_at(reader->messages, m->severity, *m, all ? "%s" : "%s (state %s)", m->text, states->state[s].name);
        }
}

static int add_unknown(struct states *states, const rotid_parameter *bounds)
{
    for (int p = 0; p < states->nparameter; p++)
        if (same_text(states->bounds[p].name, bounds->name))
            return p;
    states->bounds[states->nparameter] = *bounds;
    return states->nparameter++;
}

/* The unknowns of all: the common ones first. */
static void number_unknowns(struct deck_reader *reader, struct states *states)
{
    int most = 0;
    for (int s = 0; s < states->nstate; s++)
        most += states->state[s].job.unknowns.nparameter;
    states->bounds = POOL_ARRAY(reader->pool, rotid_parameter, most);
    for (int own = 0; own < 2 && !reader->pool->out_of_memory; own++)
        for (int s = 0; s < states->nstate; s++) {
            struct state *state = &states->state[s];
            int first = own ? state->ncommon : 0, end = own ? state->job.unknowns.nparameter : state->ncommon;
            for (int p = first; p < end; p++)
                state->unknown[p] = add_unknown(states, &state->job.unknowns.bounds[p]);
        }
}

/* What is fitted together is weighed alike: without a word from the user by the noise where all states know it. */
static void agree_on_functional(struct states *states)
{
    int functional = ROTID_LIKELIHOOD;
    for (int s = 0; s < states->nstate; s++)
        if (states->state[s].job.options.fit.functional != ROTID_LIKELIHOOD)
            functional = states->state[s].job.options.fit.functional;
    for (int s = 0; s < states->nstate; s++)
        states->state[s].job.options.fit.functional = functional;
}

/* An unknown acts in a state with a mode that is fitted. */
static void check_use(struct deck_reader *reader, const struct division *d, const struct states *states)
{
    for (int p = 0; p < states->nparameter; p++) {
        int used = 0, of = 0;
        for (int s = states->nstate - 1; s >= 0; s--)
            for (int q = 0; q < states->state[s].job.unknowns.nparameter; q++)
                if (states->state[s].unknown[q] == p) {
                    of = s;
                    used |= job_fitted(&states->state[s].job, states->state[s].job.measurement.holdout);
                }
        if (!used)
            deck_error(reader, d->state[of]->place, "%s acts in no state that is fitted, expected it in one that is not held out",
                       states->bounds[p].name);
    }
}

void deck_read_all_states(struct deck_reader *reader, int nread, struct states *states)
{
    struct division d;
    find_states(reader, nread, &d);
    check_places(reader, &d);
    *states = (struct states){0};
    if (d.nstate && (reader->messages->errors || reader->pool->out_of_memory))
        return;
    int several = d.nstate > 1 && !d.chosen, count = several ? d.nstate : 1, s = 0;
    if (several)
        check_overridden_files(reader, &d);
    while (d.chosen && d.nstate && d.state[s] != find_state(&d, d.chosen))
        s++;
    struct message_list *of = POOL_ARRAY(reader->pool, struct message_list, count);
    states->state = POOL_ARRAY(reader->pool, struct state, count);
    for (int i = 0; i < count && !reader->pool->out_of_memory; i++) {
        message_open(&of[i], reader->pool);
        states->nstate = i + 1;
        read_one(reader, &d, several ? i : s, several ? &of[i] : reader->messages, &states->state[i]);
    }
    if (reader->pool->out_of_memory)
        return;
    if (several)
        merge_messages(reader, states, of);
    number_unknowns(reader, states);
    if (several && !reader->messages->errors && !reader->pool->out_of_memory) {
        agree_on_functional(states);
        check_use(reader, &d, states);
    }
}

/* ------------------------------------------------------------------------------------------------ *SET */

static int is_length(const char *name)
{
    const char *dot = strrchr(name, '.');
    return dot && same_text(dot + 1, "length");
}

/* All sections of the group in proportion. */
static void set_length(struct deck_reader *reader, const struct data_line *line)
{
    struct rotor *rotor = &reader->job->rotor;
    const char *name = line->field[0].text;
    double length, from, to;
    int group = deck_find_group(rotor, rotor->ngroup, name, (size_t)(strrchr(name, '.') - name));
    if (group < 0) {
        deck_error(reader, line->field[0].place, "%s is no length, expected that of a *SHAFT or *BEAM", name);
        return;
    }
    if (deck_count(reader, line, 2) || deck_number(reader, line, 1, "length [m]", POSITIVE, &length))
        return;
    rotor_group_span(rotor, group, &from, &to);
    for (int s = 0; s < rotor->nsegment; s++)
        if (rotor->segment[s].group == group)
            rotor->segment[s].length *= length / (to - from);
}

void deck_set_lengths(struct deck_reader *reader)
{
    for (int c = 0; c < reader->text.ncard; c++) {
        const struct card *card = &reader->text.card[c];
        for (int i = 0; i < card->nline && !strcmp(card->name, "SET"); i++)
            if (is_length(card->line[i].field[0].text))
                set_length(reader, &card->line[i]);
    }
}

const char *deck_outside_range(struct pool *pool, const struct rotor *rotor, struct parameter parameter, double si, double *value)
{
    double lower, upper;
    deck_range_of(rotor, &parameter, &lower, &upper);
    int above = parameter.kind <= PARAMETER_TIEROD_E; /* moduli, nu, densities */
    if (deck_clip(lower, upper, value) && (*value > lower || !above))
        return NULL;
    const char *range =
        pool_format(pool, "%s %.6g%s%.6g", above ? "above" : "from", lower / si, above ? " and at most " : " to ", upper / si);
    return range ? range : "inside its range";
}

/* An unknown that a later *SET gives a value is known. */
static void set_parameter(struct deck_reader *reader, const struct data_line *line)
{
    struct job *job = reader->job;
    const char *unit = NULL;
    struct parameter parameter;
    double value;
    if (deck_find_parameter(reader, &line->field[0], &parameter, &unit) || deck_count(reader, line, 2) ||
        deck_number(reader, line, 1, "value", ANY, &value))
        return;
    double si = deck_in_si(reader, unit ? unit : "");
    value *= si;
    const char *range = deck_outside_range(reader->pool, &job->rotor, parameter, si, &value);
    if (range) {
        deck_error(reader, line->field[1].place, "%s is %s, expected a value %s", line->field[0].text, line->field[1].text,
                   range);
        return;
    }
    parameter_state(&job->rotor, &parameter, value);
    for (int p = 0; p < job->unknowns.nparameter; p++) {
        if (!parameters_overlap(&job->unknowns.parameter[p], &parameter))
            continue;
        if (job->unknowns.parameter[p].nalso != parameter.nalso)
            deck_error(reader, line->field[0].place, "%s has a value in common with the unknown %s, expected *SET of that name",
                       line->field[0].text, job->unknowns.bounds[p].name);
        deck_drop_unknown(reader, p--);
    }
}

void deck_set(struct deck_reader *reader, const struct card *card)
{
    for (int i = 0, count = deck_lines(reader, card, 1, 100); i < count; i++)
        if (!is_length(card->line[i].field[0].text))
            set_parameter(reader, &card->line[i]);
}
