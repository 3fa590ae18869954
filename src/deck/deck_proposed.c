#include "deck/deck_proposed.h"

#include <ctype.h>
#include <math.h>
#include <string.h>
#include <strings.h>

#include "deck/card_table.h"
#include "deck/deck_writer.h"

#define WIDER 1e3 /* bounds of the stiffness of a support, from its start */

static void put_value(struct deck_writer *w, const char *name, const char *parameter, double value)
{
    deck_put(w, "%s.%s", name, parameter);
    deck_put_number(w, ", ", value);
    deck_put(w, "\n");
}

/* The unknown of this state alone that takes the place of a common one. */
static void put_unknown(struct deck_writer *w, const char *name, const char *parameter, double value)
{
    deck_put(w, "*IDENTIFY\n%s.%s", name, parameter);
    deck_put_number(w, ", ", value / WIDER);
    deck_put_number(w, ", ", value * WIDER);
    deck_put_number(w, ", ", value);
    deck_put(w, "\n");
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
    w->status = name ? w->status : ROTID_ERROR_MEMORY;
    deck_put(w, "*SET\n");
    put_value(w, spring->name, "k", spring->lateral * TEST_SOFTER * TEST_SOFTER);
    if (spring->rotational > 0)
        put_value(w, spring->name, "k_rot", spring->rotational * TEST_SOFTER * TEST_SOFTER);
    deck_put(w, "*SPRING, NAME=%s\n", name ? name : "");
    deck_put_number(w, "", test->z);
    deck_put_number(w, ", ", spring->lateral);
    if (spring->rotational > 0)
        deck_put_number(w, ", ", spring->rotational);
    deck_put(w, "\n");
    if (is_unknown(w->job, PARAMETER_SPRING_K, test->spring) && name)
        put_unknown(w, name, "k", spring->lateral);
}

static void put_supports(struct deck_writer *w, const struct test *test)
{
    const struct rotor *rotor = &w->job->rotor;
    double factor = test->kind == TEST_STIFF ? TEST_STIFFER : TEST_SOFTER;
    for (int s = 0; s < rotor->nspring; s++) {
        if (!rotor->spring[s].name) {
            w->status = w->status ? w->status : ROTID_ERROR_ARGUMENT;
            return;
        }
        put_stiffness(w, s, rotor->spring[s].name, PARAMETER_SPRING_K, rotor->spring[s].lateral * factor);
        put_stiffness(w, s, rotor->spring[s].name, PARAMETER_SPRING_K_ROT, rotor->spring[s].rotational * factor);
    }
}

static void put_change(struct deck_writer *w, const struct test *test)
{
    switch (test->kind) {
    case TEST_MASS:
        deck_put(w, "*DISK, NAME=known_mass\n");
        deck_put_number(w, "", test->z);
        deck_put_number(w, ", ", test->mass);
        deck_put(w, "\n");
        break;
    case TEST_STIFF:
    case TEST_FREE:
        put_supports(w, test);
        break;
    case TEST_MOVED:
        if (!w->job->rotor.spring[test->spring].name)
            w->status = ROTID_ERROR_ARGUMENT;
        else
            put_moved(w, test);
        break;
    default:
        break;
    }
}

static void put_sensors(struct deck_writer *w, const struct test *test)
{
    struct job planned;
    int status = planned_sensors(w->pool, w->job, test->nsensor, test->sensor, &planned);
    w->status = w->status ? w->status : status;
    for (int s = 0; s < test->nsensor && !w->status; s++) {
        if (s % DECK_MOST_LINES == 0)
            deck_put(w, "*SENSORS\n");
        deck_put(w, "%d", planned.rotor.sensor[s].id);
        deck_put_number(w, ", ", planned.rotor.sensor[s].position);
        deck_put(w, "\n");
    }
    if (test->nsensor)
        deck_put(w, "** the shapes, once for each mode; or all of it as *MEASURED, FILE=\n** *SHAPE, MODE=%d\n", test->number[0]);
    for (int s = 0; s < test->nsensor && !w->status; s++)
        deck_put(w, "** %d, \n", planned.rotor.sensor[s].id);
}

int deck_write_test(struct pool *pool, const struct job *job, const struct test *test, char **text)
{
    struct deck_writer w = {.pool = pool, .job = job, .rotor = job->rotor};
    const char *what = test_text(pool, job, test);
    *text = NULL;
    deck_put(&w, "** proposed by rotid suggest: %s\n*STATE, NAME=%s\n", what ? what : "", test_id(test->kind));
    put_change(&w, test);
    deck_put_card(&w, "NOISE");
    deck_put_option_number(&w, "FREQUENCY", test->frequency_std);
    if (test->nsensor)
        deck_put_option_number(&w, "SHAPE", test->shape_std);
    deck_put(&w, "\n** the frequencies that are measured [Hz]; expected are\n** *MODES\n");
    for (int k = 0; k < test->modes; k++) {
        deck_put(&w, "** %d, ", test->number[k]);
        if (test->hz)
            deck_put(&w, "%.6g", test->hz[k]);
        deck_put(&w, "\n");
    }
    put_sensors(&w, test);
    *text = w.status ? NULL : w.text;
    return w.status;
}

/* ------------------------------------------------------------------------------------------------ the deck */

/* The card that a line begins; NULL of a comment, a data line, a card that is not known. */
static const struct deck_card *card_of(const char *line, size_t length)
{
    char name[32];
    size_t count = 0, at = 1;
    if (length < 2 || line[0] != '*' || line[1] == '*')
        return NULL;
    while (at < length && isspace((unsigned char)line[at]))
        at++;
    for (; at < length && count + 1 < sizeof name && (isalpha((unsigned char)line[at]) || line[at] == '_'); at++)
        name[count++] = (char)toupper((unsigned char)line[at]);
    name[count] = 0;
    return deck_card_find(name);
}

/* Of the lines of the deck those of cards that belong to a state, or the others. Comments go with the card above. */
static void put_part(struct deck_writer *w, const char *deck, int of_state)
{
    int here = !of_state;
    for (const char *line = deck; *line;) {
        size_t length = strcspn(line, "\n");
        int begins = line[0] == '*' && line[1] != '*';
        const struct deck_card *card = card_of(line, length);
        if (begins)
            here = (card && card->states == CARD_OF_STATE) == of_state;
        if (here)
            deck_put(w, "%.*s\n", (int)length, line);
        line += length + (line[length] == '\n');
    }
}

static int has_states(const char *deck)
{
    for (const char *line = deck; *line;) {
        size_t length = strcspn(line, "\n");
        const struct deck_card *card = card_of(line, length);
        if (card && !strcmp(card->name, "STATE"))
            return 1;
        line += length + (line[length] == '\n');
    }
    return 0;
}

/* The name of the *STATE that a line is; 0: another one. */
static int is_state_called(const char *line, size_t length, const char *name)
{
    for (size_t i = 0; i + 5 <= length; i++) {
        if (strncasecmp(line + i, "NAME", 4) != 0)
            continue;
        i += 4 + strspn(line + i + 4, " \t=\"");
        return !strncasecmp(line + i, name, strlen(name)) && strchr(", \t\"\r\n", line[i + strlen(name)]);
    }
    return 0;
}

/* The cards of that state of the deck but for what was measured, and without comments. */
static void put_cards_of(struct deck_writer *w, const char *deck, const char *name)
{
    int inside = 0, here = 0;
    for (const char *line = deck; *line;) {
        size_t length = strcspn(line, "\n");
        const struct deck_card *card = card_of(line, length);
        if (card) {
            int state = !strcmp(card->name, "STATE");
            inside = state ? is_state_called(line, length, name) : inside;
            here = inside && !state && card->states != CARD_OF_STATE && strcmp(card->name, "NOISE") != 0 &&
                   strcmp(card->name, "SENSORS") != 0;
        }
        if (here && !(line[0] == '*' && line[1] == '*'))
            deck_put(w, "%.*s\n", (int)length, line);
        line += length + (line[length] == '\n');
    }
}

int deck_add_state(struct pool *pool, const char *deck, const char *home, const char *state, char **text)
{
    struct deck_writer w = {.pool = pool};
    if (has_states(deck)) {
        const char *card = strstr(state, "*STATE");
        size_t head = card ? (size_t)(card - state) + strcspn(card, "\n") + 1 : 0;
        deck_put(&w, "%s%s%.*s", deck, deck[0] && deck[strlen(deck) - 1] != '\n' ? "\n" : "", (int)head, state);
        if (home)
            put_cards_of(&w, deck, home);
        state += head;
    } else {
        put_part(&w, deck, 0);
        deck_put(&w, "*STATE, NAME=measured\n");
        put_part(&w, deck, 1);
    }
    deck_put(&w, "%s", state);
    *text = w.status ? NULL : w.text;
    return w.status;
}
