/* What a diagnosis says may hide in its parameters: each cause is put into the rotor with the size that is said, the modes are
 * those of that rotor, and the model without the cause is fitted to them. The fit is not linear, so it judges the linear number.
 * Data are free of noise. Beam, layers, a solid, two states. */
#include "diagnose/causes/causes.h"
#include "reading.h"
#include "support.h"

#define MODES     6
#define MOST      15.0 /* per cent: beyond it nobody takes a linear number for more than a size */
#define NONLINEAR 0.1  /* of the shift: second order of changes of some per cent */
#define DEEP      0.2  /* a zone of this depth is softer by a quarter of that than its depth says */

#define MATERIALS                                                                                                                \
    "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.30\n*DENSITY\n7850\n"                                                            \
    "*MATERIAL, NAME=stack\n*ELASTIC, TYPE=SHEAR\n1.1e11, 0.35e11, 0.3\n*DENSITY\n7600\n"
#define SHAFTS                                                                                                                   \
    "*SHAFT, NAME=left, MATERIAL=steel\n0.30, 0.10, 0, 36\n*SHAFT, NAME=core, MATERIAL=stack\n0.60, 0.20, 0, 72\n"               \
    "*SHAFT, NAME=right, MATERIAL=steel\n0.25, 0.09, 0, 30\n"
#define SPRINGS "*SPRING, NAME=sling\nstart, 4000\n*SPRING, NAME=tail\nend, 4000\n"
#define UNKNOWN "*IDENTIFY\ncore.E, 1e10, 4e11, 1.1e11\ncore.G, 1e10, 1.3e11, 0.35e11\n"

struct rotor_case {
    const char *name, *rotor, *unknown, *fit;
    int nstate;
    const char *state[2]; /* cards of the states */
};

static const struct rotor_case beam = {"beam", MATERIALS SHAFTS SPRINGS, UNKNOWN, "*FIT\n", 1, {""}},
                               solid = {"solid", MATERIALS SHAFTS SPRINGS, UNKNOWN, "*FIT, MODEL=SOLID\n", 1, {""}},
                               layers = {"layers",
                                         MATERIALS "*SHAFT, NAME=left, MATERIAL=steel\n0.30, 0.10, 0, 36\n"
                                                   "*SHAFT, NAME=core, MATERIAL=steel\n0.60, 0.10, 0, 72\n"
                                                   "*SHAFT, NAME=right, MATERIAL=steel\n0.25, 0.09, 0, 30\n"
                                                   "*LAYER, NAME=sheets, GROUP=core, MATERIAL=stack\n0.24, 0.10\n" SPRINGS,
                                         "*IDENTIFY\nsheets.E, 1e10, 4e11, 1.1e11\nsheets.G, 1e10, 1.3e11, 0.35e11\n",
                                         "*FIT\n",
                                         1,
                                         {""}},
                               states = {"states", MATERIALS SHAFTS SPRINGS,
                                         UNKNOWN,  "*FIT\n",
                                         2,        {"*STATE, NAME=bare\n", "*STATE, NAME=disc\n*DISK\n0.25, 8\n"}};

/* The modes of the rotor with `cause` in it, state by state, as the deck that is fitted. */
static void write_deck(const struct rotor_case *c, const char *cause, size_t room, char *text)
{
    size_t at = (size_t)snprintf(text, room, "%s*NOISE, FREQUENCY=0.0002\n%s%s", c->rotor, c->unknown, c->fit);
    for (int s = 0; s < c->nstate; s++) {
        const char *cards = strchr(c->state[s], '\n'); /* without *STATE */
        char rotor[4096], failure[ROTID_FAILURE_LENGTH];
        (void)snprintf(rotor, sizeof rotor, "%s%s%s%s", c->rotor, cards ? cards + 1 : "", cause, c->fit);
        rotid_deck *deck = read_handle(rotor, 0, NULL);
        rotid_spectrum *spectrum;
        assert_int_equal(rotid_spectrum_compute(deck, NULL, MODES, NULL, failure, &spectrum), ROTID_OK);
        at += (size_t)snprintf(text + at, room - at, "%s*MODES\n", c->state[s]);
        for (int k = 0; k < MODES; k++)
            at += (size_t)snprintf(text + at, room - at, "%d, %.12g\n", k + 1, spectrum->modes[k].full_hz);
        rotid_spectrum_free(spectrum);
        rotid_deck_free(deck);
    }
    assert_true(at < room);
}

static rotid_identification *identified(const char *text, int checks)
{
    char failure[ROTID_FAILURE_LENGTH];
    rotid_deck *deck = read_handle(text, 0, NULL);
    rotid_identification *fit;
    assert_int_equal(rotid_identify(deck, checks, NULL, failure, &fit), ROTID_OK);
    rotid_deck_free(deck);
    return fit;
}

/* The card of what is said to hide. */
static void card_of(const rotid_hidden *hidden, size_t room, char *card)
{
    const struct cause_kind *cause = catalogue_find(hidden->id);
    const char *bar = strchr(hidden->target, '|');
    char target[128] = "";
    assert_non_null(cause);
    if (cause->target == TARGET_INTERFACE)
        (void)snprintf(target, sizeof target, ", BETWEEN=\"%.*s,%s\"", (int)(bar - hidden->target), hidden->target, bar + 1);
    else if (*hidden->target)
        (void)snprintf(target, sizeof target, ", %s=%s", cause->target == TARGET_GROUP ? "GROUP" : "AT", hidden->target);
    size_t at = (size_t)snprintf(card, room, "*CAUSE, NAME=hidden, TYPE=%s%s\n", hidden->id, target);
    if (strcmp(hidden->component, "presence") != 0)
        at += (size_t)snprintf(card + at, room - at, "%s, %.12g\n", hidden->component,
                               cause->parameter[cause->size].neutral + hidden->size);
    if (isfinite(hidden->z_m))
        at += (size_t)snprintf(card + at, room - at, "%s, %.12g\n", cause->effect->parameter[cause->place].name, hidden->z_m);
    if (isfinite(hidden->width_m))
        at += (size_t)snprintf(card + at, room - at, "%s, %.12g\n", cause->effect->parameter[cause->width].name, hidden->width_m);
}

static double value_of(const rotid_identification *fit, const char *name)
{
    for (int p = 0; p < fit->nparameters; p++)
        if (!strcmp(fit->parameters[p].name, name))
            return fit->parameters[p].value;
    return NAN;
}

/* Moduli that fall to a half somewhere: their compliance is not linear, nor is the shear stiffness of layers. */
static int is_deep(const rotid_hidden *hidden)
{
    return (!strcmp(hidden->component, "depth") || !strcmp(hidden->component, "profile")) && fabs(hidden->size) > DEEP;
}

/* Every entry that is small enough to be judged, at least `least` of them. */
static void judge(const struct rotor_case *c, int count, const rotid_hidden *hidden, const rotid_identification *sound, int least)
{
    static char text[16384];
    char card[512];
    int judged = 0;
    for (int i = 0; i < count; i++) {
        double value = value_of(sound, hidden[i].parameter), shift = hidden[i].shift;
        assert_true(isfinite(shift) && shift != 0);
        if (i && !strcmp(hidden[i].parameter, hidden[i - 1].parameter))
            assert_true(fabs(shift) <= fabs(hidden[i - 1].shift));
        if (100 * fabs(shift / value) > MOST || is_deep(&hidden[i]))
            continue;
        card_of(&hidden[i], sizeof card, card);
        write_deck(c, card, sizeof text, text);
        rotid_identification *off = identified(text, 0);
        double is = value_of(off, hidden[i].parameter) - value;
        print_message("%s: %s %+.2f %% said, %+.2f %% by a fit, %s %s %.3g at %.3g\n", c->name, hidden[i].parameter,
                      100 * shift / value, 100 * is / value, hidden[i].id, hidden[i].target, hidden[i].size, hidden[i].z_m);
        assert_true(fabs(is - shift) < NONLINEAR * fabs(shift));
        rotid_identification_free(off);
        judged++;
    }
    assert_true(judged >= least);
}

static void look(const struct rotor_case *c, int least)
{
    static char text[16384];
    char failure[ROTID_FAILURE_LENGTH];
    rotid_diagnosis *d;
    write_deck(c, "", sizeof text, text);
    rotid_deck *deck = read_handle(text, 0, NULL);
    assert_int_equal(rotid_diagnose(deck, NULL, NULL, failure, &d), ROTID_OK);
    rotid_deck_free(deck);
    assert_int_equal(d->verdict.kind, ROTID_ADEQUATE);
    assert_int_equal(d->nhidden, 3 * 2);             /* three causes of each modulus */
    rotid_identification *fit = identified(text, 1); /* on the mesh of the deck, which is that of the data */
    judge(c, d->nhidden, d->hidden, fit, least);
    assert_non_null(strstr(d->verdict.sentence, "A cause below its detection limit may be present"));
    /* identify finds the same, at the end of its own fit */
    assert_int_equal(fit->nhidden, d->nhidden);
    for (int i = 0; i < fit->nhidden; i++)
        if (!strcmp(fit->hidden[i].id, d->hidden[i].id) && !fit->hidden[i].beyond)
            assert_close(fit->hidden[i].shift, d->hidden[i].shift, 0.02, 0);
    rotid_identification_free(fit);
    fit = identified(text, 0);
    assert_int_equal(fit->nhidden, 0);
    rotid_identification_free(fit);
    rotid_diagnosis_free(d);
}

UNIT_TEST(of_a_beam)
{
    look(&beam, 2);
}

UNIT_TEST(of_layers)
{
    look(&layers, 2);
}

UNIT_TEST(of_a_solid)
{
    look(&solid, 2);
}

UNIT_TEST(of_two_states)
{
    look(&states, 2);
}
