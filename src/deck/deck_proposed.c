/* The *STATE of a test that is proposed, and the deck with that state in it. */
#include "deck/deck_row.h"

#include <ctype.h>

#define WIDER 1e3 /* bounds of the stiffness of a support, from its start */

/* *UNITS states none of a rotational stiffness. */
static const char *unit_of(const char *parameter)
{
    return strcmp(parameter, "k") ? "" : "N/m";
}

static void put_value(struct deck_writer *w, const char *name, const char *parameter, double value)
{
    deck_put(w, "%s.%s", name, parameter);
    deck_put_number(w, ", ", value, unit_of(parameter));
    deck_put(w, "\n");
}

/* The unknown of this state alone that takes the place of a common one. */
static void put_unknown(struct deck_writer *w, const char *name, const char *parameter, double value)
{
    const rotid_parameter bounds = {.unit = unit_of(parameter), .lower = value / WIDER, .upper = value * WIDER, .start = value};
    const char *unknown = pool_format(w->pool, "%s.%s", name, parameter);
    deck_put(w, "*IDENTIFY\n");
    if (unknown)
        deck_put_unknown(w, &bounds, unknown);
}

static int is_unknown(const struct job *job, enum parameter_kind kind, int spring)
{
    for (int p = 0; p < job->unknowns.nparameter; p++)
        if (job->unknowns.parameter[p].kind == kind && job->unknowns.parameter[p].index == spring)
            return 1;
    return 0;
}

static void put_stiffness(struct deck_writer *w, int spring, const char *name, enum parameter_kind kind, double value)
{
    const char *parameter = kind == PARAMETER_SPRING_K ? "k" : "k_rot";
    if (!(value > 0))
        return;
    if (is_unknown(w->job, kind, spring)) {
        put_unknown(w, name, parameter, value);
    } else {
        deck_put(w, "*SET\n");
        put_value(w, name, parameter, value);
    }
}

/* A support that goes elsewhere is hardly there any more, and there is another one. */
static void put_moved(struct deck_writer *w, const struct test *test)
{
    const struct spring *spring = &w->job->rotor.spring[test->spring];
    const char *name = pool_format(w->pool, "%s_moved", spring->name);
    deck_put(w, "*SET\n");
    put_value(w, spring->name, "k", spring->lateral * TEST_SOFTER * TEST_SOFTER);
    if (spring->rotational > 0)
        put_value(w, spring->name, "k_rot", spring->rotational * TEST_SOFTER * TEST_SOFTER);
    deck_put_list_item(
        w, "SPRING",
        &(struct spring){.name = name, .position = test->z, .lateral = spring->lateral, .rotational = spring->rotational});
    if (is_unknown(w->job, PARAMETER_SPRING_K, test->spring) && name)
        put_unknown(w, name, "k", spring->lateral);
}

static void put_supports(struct deck_writer *w, const struct test *test)
{
    const struct rotor *rotor = &w->job->rotor;
    double factor = test->kind == TEST_STIFF ? TEST_STIFFER : TEST_SOFTER;
    for (int s = 0; s < rotor->nspring; s++) {
        put_stiffness(w, s, rotor->spring[s].name, PARAMETER_SPRING_K, rotor->spring[s].lateral * factor);
        put_stiffness(w, s, rotor->spring[s].name, PARAMETER_SPRING_K_ROT, rotor->spring[s].rotational * factor);
    }
}

static void put_sensors(struct deck_writer *w, const struct test *test)
{
    struct job planned;
    if (planned_sensors(w->pool, w->job, test->nsensor, test->sensor, &planned))
        return;
    deck_put_sensors(w, test->nsensor, planned.rotor.sensor);
    if (test->nsensor)
        deck_put(w, "** the shapes, once for each mode; or all of it as *MEASURED, FILE=\n** *SHAPE, MODE=%d\n", test->number[0]);
    for (int s = 0; s < test->nsensor; s++)
        deck_put(w, "** %d, \n", planned.rotor.sensor[s].id);
}

int deck_write_test(struct pool *pool, const struct job *job, const struct test *test, char **text)
{
    struct deck_writer w = {.pool = pool, .job = job};
    const char *what = test_text(pool, job, test);
    double hertz = deck_unit_of(&job->units, "Hz");
    *text = NULL;
    for (int s = 0; s < job->rotor.nspring && test->kind >= TEST_STIFF; s++) /* which a deck calls by name */
        if (!job->rotor.spring[s].name && (test->kind != TEST_MOVED || s == test->spring))
            return ROTID_ERROR_ARGUMENT;
    deck_put(&w, "** proposed by rotid suggest: %s\n*STATE, NAME=%s\n", what ? what : "", test_id(test->kind));
    if (test->kind == TEST_MASS)
        deck_put_list_item(&w, "DISK", &(struct disk){.name = "known_mass", .position = test->z, .mass = test->mass});
    else if (test->kind == TEST_MOVED)
        put_moved(&w, test);
    else if (test->kind >= TEST_STIFF)
        put_supports(&w, test);
    deck_put_noise(&w, test->frequency_std, test->nsensor ? test->shape_std : NAN);
    deck_put(&w, "** the frequencies that are measured%s; expected are\n** *MODES\n",
             hertz != 1 ? ", in the unit of this deck" : " [Hz]");
    for (int k = 0; k < test->modes; k++) {
        deck_put(&w, "** %d, ", test->number[k]);
        if (test->hz)
            deck_put(&w, "%.6g", test->hz[k] / hertz);
        deck_put(&w, "\n");
    }
    put_sensors(&w, test);
    *text = pool->out_of_memory ? NULL : w.text;
    return pool->out_of_memory ? ROTID_ERROR_MEMORY : ROTID_OK;
}

/* ------------------------------------------------------------------------------------------------ the deck with it */

enum { COMMON = 1, MEASURED = 2, RUNNING = 4 };

static int is_called(const struct deck_part *part, const char *name)
{
    const char *own = deck_edit_is(part, "STATE") ? deck_edit_option(part, "NAME") : NULL;
    return own && same_text(own, name);
}

/* The cards of that state of the deck but for what was measured, and without comments. */
static void put_cards_of(struct deck_edit *e, struct deck_writer *w, const char *name)
{
    int inside = 0;
    for (int i = 0; i < e->npart; i++) {
        const struct deck_part *part = &e->part[i];
        if (deck_edit_is(part, "STATE"))
            inside = is_called(part, name);
        else if (inside && part->read.kind && !deck_stands(&part->read, CARD_OF_STATE) && !deck_edit_is(part, "NOISE") &&
                 !deck_edit_is(part, "SENSORS"))
            deck_edit_put(e, w, part, 1);
    }
}

/* The name, or with a number behind it, that no state of the deck has. */
static const char *free_name(struct deck_edit *e, const char *name)
{
    const char *own = name;
    for (int i = 0, n = 1; i < e->npart && own; i++)
        if (is_called(&e->part[i], own)) {
            own = pool_format(e->pool, "%s_%d", name, ++n);
            i = -1;
        }
    return own;
}

/* An option of *FIT that lists modes, which the new state need not have: it goes to the states. Its text, NULL where there is
 * none. */
static const char *take_modes(struct deck_edit *e, const char *option)
{
    const char *list = NULL;
    for (int i = 0; i < e->npart; i++) {
        const struct deck_part *part = &e->part[i];
        const char *value = deck_edit_is(part, "FIT") ? deck_edit_option(part, option) : NULL;
        if (!value || !isdigit((unsigned char)*value))
            continue;
        list = value;
        deck_edit_set(e, i, option, NULL);
    }
    for (int i = 0; i < e->npart && list; i++)
        if (deck_edit_is(&e->part[i], "STATE") && !deck_edit_option(&e->part[i], option))
            deck_edit_set(e, i, option, list);
    return list;
}

static void put_parts(struct deck_edit *e, struct deck_writer *w, unsigned wanted)
{
    for (int i = 0; i < e->npart; i++) {
        int running = e->part[i].state == DECK_BEHIND_STATES, measured = deck_stands(&e->part[i].read, CARD_OF_STATE);
        e->part[i].left_out = !(wanted & (running ? RUNNING : measured ? MEASURED : COMMON));
    }
    deck_edit_text(e, w);
}

int deck_add_state(struct pool *pool, const struct deck_origin *origin, const char *home, const char *state, char **text)
{
    static const char begin[] = "*STATE, NAME=";
    struct deck_edit e;
    struct deck_writer w = {.pool = pool};
    *text = NULL;
    int status = deck_edit_open(&e, pool, origin);
    const char *card = strstr(state, begin), *name = card ? card + sizeof begin - 1 : "", *rest = name + strcspn(name, "\n");
    name = pool_format(pool, "%.*s", (int)(rest - name), name);
    name = name ? free_name(&e, name) : NULL;
    const char *modes = status ? NULL : take_modes(&e, "MODES"), *holdout = status ? NULL : take_modes(&e, "HOLDOUT");
    if (status || !card || !name)
        return status ? status : card ? ROTID_ERROR_MEMORY : ROTID_ERROR_ARGUMENT;
    put_parts(&e, &w, e.nstate ? COMMON | MEASURED : COMMON);
    if (!e.nstate) {
        deck_put(&w, "*STATE, NAME=measured%s%s%s%s\n", modes ? ", MODES=" : "", modes ? modes : "", holdout ? ", HOLDOUT=" : "",
                 holdout ? holdout : "");
        put_parts(&e, &w, MEASURED);
    }
    deck_put(&w, "%.*s%s%s\n", (int)(card - state), state, begin, name);
    if (e.nstate && home)
        put_cards_of(&e, &w, home);
    deck_put(&w, "%s", rest + (*rest == '\n'));
    put_parts(&e, &w, RUNNING);
    *text = pool->out_of_memory ? NULL : w.text;
    return pool->out_of_memory ? ROTID_ERROR_MEMORY : ROTID_OK;
}

/* ------------------------------------------------------------------------------------------------ read back */

/* The text with the expected frequencies, which stand in comments, in the place of those that are to be measured. */
static const char *filled_in(struct pool *pool, const char *text)
{
    static const char modes[] = "** *MODES\n";
    struct deck_writer w = {.pool = pool};
    const char *begin = NULL;
    for (const char *next = text; (next = strstr(next, modes)); next++)
        begin = next;
    if (!begin)
        return NULL;
    deck_put(&w, "%.*s*MODES\n", (int)(begin - text), text);
    for (begin += sizeof modes - 1; !strncmp(begin, "** ", 3) && isdigit((unsigned char)begin[3]);) {
        const char *next = begin + strcspn(begin, "\n");
        next += *next == '\n';
        deck_put(&w, "%.*s", (int)(next - begin) - 3, begin + 3);
        begin = next;
    }
    deck_put(&w, "%s", begin);
    return pool->out_of_memory ? NULL : w.text;
}

/* Names of unknowns have that of their state in front where there are several. */
static struct job without_state(struct pool *pool, const struct job *job)
{
    struct job own = *job;
    int n = POOL_LIST(pool, own.unknowns.bounds, job->unknowns.nparameter);
    for (int p = 0; p < n; p++) {
        own.unknowns.bounds[p] = job->unknowns.bounds[p];
        const char *colon = strchr(own.unknowns.bounds[p].name, ':');
        own.unknowns.bounds[p].name = colon ? colon + 1 : own.unknowns.bounds[p].name;
    }
    return own;
}

/* Whether the rotor of the test is that of the state that it is made like with what the test changes, support `moved` gone
 * elsewhere. */
static int is_changed_rotor(struct pool *pool, const struct job *job, const struct job *like, const struct test *test)
{
    int n = like->unknowns.nparameter, last = like->rotor.nspring, moved = test->kind == TEST_MOVED ? test->spring : -1;
    double *x = POOL_ARRAY(pool, double, 2 * (size_t)n);
    int *unused = POOL_ARRAY(pool, int, n);
    struct job expected;
    struct rotor own;
    const char *card;
    if (!x || !unused || test_apply(pool, test, like, x, &expected, x + n, unused) || deck_copy_rotor(pool, &job->rotor, &own))
        return 0;
    expected.rotor.effect = like->rotor.effect;          /* whatever the sensors */
    for (int p = 0; p < job->unknowns.nparameter; p++) { /* an unknown of the state alone has its value as a start */
        const struct parameter *parameter = &job->unknowns.parameter[p];
        if (strchr(job->unknowns.bounds[p].name, ':') && parameter_is_of_spring(parameter) &&
            (test->kind == TEST_STIFF || test->kind == TEST_FREE || parameter->index == moved || parameter->index == last))
            *parameter_value(&own, *parameter) = job->unknowns.bounds[p].start;
    }
    if (test->kind == TEST_MASS && own.ndisk)
        own.disk[own.ndisk - 1].name = NULL;
    if (moved >= 0 && own.nspring == last + 1) { /* the new one in place of that which is hardly there */
        const struct spring *was = &like->rotor.spring[moved], left = own.spring[moved], new = own.spring[--own.nspring];
        own.spring[moved] = *was;
        own.spring[moved].position = new.position;
        own.spring[moved].lateral = new.lateral;
        own.spring[moved].rotational = new.rotational;
        if (!deck_is_near(left.position, was->position) || !deck_is_near(left.lateral, was->lateral * TEST_SOFTER * TEST_SOFTER))
            return 0;
    }
    /* the mesh follows from the data */
    return !(deck_compare_rotors(&expected.rotor, &own, &card) & ~(unsigned)DECK_OTHER_ELEMENTS);
}

static int is_test(struct pool *pool, const struct job *job, const struct job *like, const rotid_suggested_test *suggested)
{
    const struct rotor *rotor = &job->rotor;
    struct test test = {.kind = TEST_AGAIN, .mass = suggested->mass_kg, .z = suggested->z_m};
    while (test.kind < TEST_MOVED && strcmp(test_id(test.kind), suggested->id) != 0)
        test.kind++;
    if (suggested->nsensors_m && rotor->nsensor != suggested->nsensors_m)
        return 0;
    for (int s = 0; s < suggested->nsensors_m; s++)
        if (fabs(rotor->sensor[s].position - suggested->sensors_m[s]) > 1e-9 * rotor_length(rotor))
            return 0;
    for (; test.kind == TEST_MOVED && test.spring < like->rotor.nspring; test.spring++)
        if (is_changed_rotor(pool, job, like, &test))
            return 1;
    return test.kind != TEST_MOVED && is_changed_rotor(pool, job, like, &test);
}

/* Errors, which go to the list, where the text does not read as the states of the deck and one of the test more. */
static int read_back(struct pool *pool, const struct states *given, const char *home, const rotid_suggested_test *test,
                     const char *text, struct message_list *notes)
{
    const char *from = given->state->job.deck, *filled = filled_in(pool, text), *card;
    const struct job *like = &given->state->job;
    struct states states;
    int status = filled ? deck_read_back(pool, from, filled, ".", notes, &states) : ROTID_ERROR_MEMORY, before = notes->errors;
    if (status)
        return status;
    if (states.nstate != given->nstate + 1)
        return message_refuse(notes, ROTID_ERROR_ARGUMENT, from, 1, 1,
                              "the state of the test is not read, expected a deck without *FIT, STATE=");
    for (int s = 0; s < given->nstate; s++) {
        const struct job was = without_state(pool, &given->state[s].job), is = without_state(pool, &states.state[s].job);
        like = home && given->state[s].name && same_text(home, given->state[s].name) ? &given->state[s].job : like;
        if (deck_compare(pool, &was, &is, &card))
            message_add(notes, SEVERITY_ERROR, from, 1, 1,
                        "state %s would be read as something else with the test in the deck: *%s",
                        given->state[s].name ? given->state[s].name : "measured", card);
    }
    if (!is_test(pool, &states.state[given->nstate].job, like, test))
        message_add(notes, SEVERITY_ERROR, from, 1, 1, "the cards of the test %s would be read as another one", test->id);
    return notes->errors > before ? ROTID_ERROR_ARGUMENT : ROTID_OK;
}

int deck_propose(struct pool *pool, const struct states *given, const char *home, const rotid_suggested_test *test,
                 struct message_list *notes, char **text)
{
    int status = deck_add_state(pool, given->state->job.origin, home, test->cards, text);
    if (!status)
        status = read_back(pool, given, home, test, *text, notes);
    status = pool->out_of_memory ? ROTID_ERROR_MEMORY : status;
    *text = status ? NULL : *text;
    return status;
}
