/* The beam beside the solid, what a solid says of its mesh, and what a result carries of its meridian. */
#include "support.h"

#define STEEL  "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n"
#define SHEETS "*MATERIAL, NAME=sheets\n*ELASTIC, TYPE=LAMINATED\n0.7e11, 0.25e11, 2.1e11, 0.3\n*DENSITY\n7600\n"
#define STEP(OUTER)                                                                                                              \
    "*SHAFT, NAME=left, MATERIAL=steel\n0.3, 0.06, 0, 20\n*SHAFT, NAME=core, MATERIAL=sheets\n0.4, " OUTER ", 0, 30\n"           \
    "*SHAFT, NAME=right, MATERIAL=steel\n0.3, 0.06, 0, 20\n"
#define STEPPED       STEP("0.09")
#define STEPPED_TWICE STEP("0.12")
#define SOLID         "*FIT, MODEL=SOLID\n"

static rotid_deck *read(const char *text, int status)
{
    rotid_deck *deck;
    int found = rotid_deck_read_text(strlen(text), text, "deck", NULL, 0, NULL, NULL, NULL, &deck);
    assert_int_equal(found, status);
    return deck;
}

static rotid_spectrum *beside(const char *text)
{
    rotid_spectrum *s;
    rotid_deck *deck = read(text, ROTID_OK);
    assert_status(rotid_spectrum_beside(deck, NULL, 4, NULL, NULL, &s), ROTID_OK);
    rotid_deck_free(deck);
    return s;
}

static int messages_with(int count, const rotid_message *message, const char *text)
{
    int found = 0;
    for (int i = 0; i < count; i++)
        found += strstr(message[i].text, text) != NULL;
    return found;
}

/* A slender bar is what a beam is made for; steel leaves no modulus of its own to compare. */
UNIT_TEST(a_slender_bar_is_the_same_as_both)
{
    rotid_spectrum *s = beside(STEEL "*SHAFT, NAME=bar, MATERIAL=steel\n1.5, 0.05, 0, 60\n");
    assert_non_null(s->beside);
    assert_int_equal(s->beside->nmodes, 4);
    for (int k = 0; k < 4; k++) {
        const rotid_beside_mode *mode = &s->beside->modes[k];
        assert_int_equal(mode->beam_mode, k + 1);
        assert_close(mode->beam_hz, mode->solid_hz, 1e-3, 0);
        assert_close(mode->difference_percent, 100 * (mode->beam_hz / mode->solid_hz - 1), 1e-12, 0);
        assert_true(mode->nco > 0.9999 && mode->mac > 0.999);
        assert_close(mode->beam_hz, s->modes[k].full_hz, 1e-9, 0); /* the deck asks for a beam */
    }
    assert_int_equal(s->beside->nmoduli, 0);
    assert_null(s->beside->sentence);
    assert_null(s->meridian);
    rotid_spectrum_free(s);
}

UNIT_TEST(a_beam_that_follows_a_stepped_solid_is_softer)
{
    rotid_spectrum *solid = beside(STEEL SHEETS STEPPED SOLID), *beam = beside(STEEL SHEETS STEPPED);
    const rotid_beam_beside_solid *b = solid->beside;
    double before = 0;
    for (int k = 0; k < b->nmodes; k++) {
        assert_true(b->modes[k].difference_percent > 0.1);
        before += b->modes[k].difference_percent * b->modes[k].difference_percent / b->nmodes;
        assert_close(b->modes[k].solid_hz, beam->beside->modes[k].solid_hz, 1e-12, 0);
    }
    assert_int_equal(b->nmoduli, 2);
    assert_string_equal(b->moduli[0].name, "core.E");
    assert_string_equal(b->moduli[1].name, "core.G");
    assert_close(b->moduli[0].stated_pa, 0.7e11, 0, 0);
    for (int p = 0; p < 2; p++) {
        assert_close(b->moduli[p].change_percent, 100 * (b->moduli[p].found_pa / b->moduli[p].stated_pa - 1), 1e-12, 0);
        assert_close(b->moduli[p].found_pa, beam->beside->moduli[p].found_pa, 1e-6, 0);
    }
    assert_true(b->moduli[0].change_percent < -3);
    assert_int_equal(b->nfitted_modes, 4);
    assert_true(b->fitted_rms_percent < sqrt(before));
    assert_non_null(strstr(b->sentence, "core.E -"));
    rotid_spectrum_free(solid);
    rotid_spectrum_free(beam);
}

/* A step of two to one: no moduli of the core make up for what the beam counts in full. */
UNIT_TEST(where_no_beam_follows_none_is_stated)
{
    rotid_spectrum *s = beside(STEEL SHEETS STEPPED_TWICE);
    assert_int_equal(s->beside->nmodes, 4);
    assert_int_equal(s->beside->nmoduli, 0);
    assert_true(isnan(s->beside->fitted_rms_percent));
    assert_int_equal(messages_with(s->nmessage, s->message, "no moduli make a beam follow this solid"), 1);
    rotid_spectrum_free(s);
}

UNIT_TEST(what_is_no_solid_is_refused_with_its_reason)
{
    static const struct {
        const char *deck, *place, *reason;
    } cases[] = {
        {STEEL "*BEAM, NAME=bar, MATERIAL=steel\n1, 0.05, 0.04, 20\n", "deck:6:1: ", "a *BEAM is not"},
        {STEEL "*SHAFT, NAME=bar, MATERIAL=steel\n1, 0.2, 0.05, 20\n"
               "*TIEROD, NAME=rods, MATERIAL=steel, FROM=0.1, TO=0.9, MODEL=TUBE\n8, 0.01, 0.08, 0\n",
         "deck:8:1: ", "an equivalent tube has no counterpart"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char failure[ROTID_FAILURE_LENGTH], text[1024];
        rotid_spectrum *s;
        rotid_deck *deck = read(cases[i].deck, ROTID_OK);
        assert_status(rotid_spectrum_beside(deck, NULL, 2, NULL, failure, &s), ROTID_ERROR_SECTION);
        assert_null(s);
        assert_non_null(strstr(failure, cases[i].place));
        assert_non_null(strstr(failure, cases[i].reason));
        rotid_deck_free(deck);
        (void)snprintf(text, sizeof text, "%s%s", cases[i].deck, SOLID);
        deck = read(text, ROTID_ERROR_SECTION);
        assert_int_equal(messages_with(deck->nmessage, deck->message, cases[i].reason), 1);
        rotid_deck_free(deck);
    }
}

UNIT_TEST(a_solid_tells_its_mesh_and_what_it_takes_for_granted)
{
    rotid_check *check;
    rotid_deck *deck = read("*MATERIAL, NAME=core\n*ELASTIC, TYPE=SHEAR\n1e11, 0.3e11, 0.3\n*DENSITY\n7600\n" STEEL
                            "*SHAFT, NAME=left, MATERIAL=steel\n0.2, 0.06, 0, 5\n"
                            "*SHAFT, NAME=core, MATERIAL=core\n0.3, 0.12, 0, 5\n*PERFORATION, GROUP=core\n8, 0.01, 0.04\n" SOLID,
                            ROTID_OK);
    assert_int_equal(messages_with(deck->nmessage, deck->message, "TYPE=LAMINATED states the sheets"), 1);
    assert_int_equal(messages_with(deck->nmessage, deck->message, "smears the holes of core"), 1);
    assert_status(rotid_deck_check(deck, NULL, NULL, &check), ROTID_OK);
    assert_non_null(check->solid);
    assert_true(check->solid->unknowns > 2 * check->nodes && check->solid->unknowns < 3 * check->nodes);
    assert_true(check->solid->half_band < check->solid->unknowns / 5);
    assert_true(check->elements > check->solid->slices);
    assert_close(check->solid->corner_m, 0.05 * 0.03, 0.3, 0); /* a twentieth of the thinner radius */
    assert_true(check->solid->largest_m <= 0.12 / 8 * 1.5);
    rotid_check_free(check);
    rotid_deck_free(deck);
}

UNIT_TEST(a_mesh_that_exceeds_a_third_of_the_noise_is_named)
{
    for (int fine = 0; fine < 2; fine++) {
        char text[2048];
        rotid_spectrum *s;
        (void)snprintf(text, sizeof text, "%s*SENSORS\n1, 0\n2, 1\n*MODES\n1, 300\n*NOISE, FREQUENCY=%g\n" SOLID,
                       STEEL SHEETS STEPPED, fine ? 1e-6 : 0.1);
        rotid_deck *deck = read(text, ROTID_OK);
        assert_status(rotid_spectrum_compute(deck, NULL, 2, NULL, NULL, &s), ROTID_OK);
        assert_int_equal(messages_with(s->nmessage, s->message, "the mesh of the solid leaves measured mode 1 in doubt"), fine);
        rotid_spectrum_free(s);
        rotid_deck_free(deck);
    }
}

UNIT_TEST(the_meridian_weighs_what_the_rotor_weighs)
{
    rotid_check *check;
    rotid_spectrum *s;
    rotid_deck *deck = read(STEEL SHEETS STEPPED SOLID, ROTID_OK);
    assert_status(rotid_spectrum_compute(deck, NULL, 2, NULL, NULL, &s), ROTID_OK);
    assert_status(rotid_deck_check(deck, NULL, NULL, &check), ROTID_OK);
    const rotid_meridian *m = s->meridian;
    const double pi = 3.14159265358979323846;
    double mass = 0;
    assert_int_equal(m->nelements, check->elements);
    for (int e = 0; e < m->nelements; e++) {
        const int *corner = m->elements[e].corner;
        double inner = m->r_m[corner[0]], outer = m->r_m[corner[1]], from = m->z_m[corner[0]], to = m->z_m[corner[3]];
        assert_true(outer > inner && to > from && m->r_m[corner[2]] == outer && m->z_m[corner[2]] == to);
        mass += pi * (outer * outer - inner * inner) * (to - from) * s->geometry->groups[m->elements[e].group].material.rho_kg_m3;
    }
    assert_close(mass, check->mass_kg, 1e-9, 0);
    for (int k = 0; k < 2; k++) {
        const rotid_meridian_mode *mode = s->modes[k].meridian;
        double energy = 0, largest = 0;
        for (int i = 0; i < mode->nu; i++)
            largest = fmax(largest, mode->u[i]);
        for (int e = 0; e < mode->nenergy; e++) {
            assert_true(mode->energy[e] >= 0);
            energy += mode->energy[e];
        }
        assert_close(energy, 1, 1e-3, 0); /* of four digits each */
        assert_close(largest, 1, 0, 0);
    }
    rotid_check_free(check);
    rotid_spectrum_free(s);
    rotid_deck_free(deck);
}
