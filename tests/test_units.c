/* Units of decks: numbers in another unit are noticed and said, *UNITS converts them, and right decks get no such warning. */
#include "deck/deck.h"
#include "folder.h"
#include "reading.h"
#include "run/run.h"
#include "support.h"

#define INPUT ROTID_SOURCE_DIR "/input/"

/* A rotor of every kind of number, each as %s; SI values in the order of `si`. */
static const char form[] = "%s"
                           "*MATERIAL, NAME=steel\n*ELASTIC\n%s, 0.3\n*DENSITY\n%s\n"
                           "*MATERIAL, NAME=sheets\n*ELASTIC, TYPE=SHEAR\n%s, %s, 0.3\n*DENSITY\n%s\n"
                           "*SHAFT, NAME=left, MATERIAL=steel\n%s, %s, 0, 8\n"
                           "*SHAFT, NAME=core, MATERIAL=sheets\n%s, %s, 0, 12\n"
                           "*DISK, NAME=wheel\n%s, %s, %s\n*SPRING, NAME=soft\n%s, %s\n"
                           "*SENSORS\n1, %s\n2, %s\n*MODES\n1, %s, %s\n2, %s\n*NOISE, FREQUENCY=%s, SHAPE=%s\n"
                           "*CAUSE, NAME=ring, TYPE=added_mass\nmass, %s\nz, %s\n"
                           "*IDENTIFY\ncore.E, %s, %s, %s\nring.mass, %s, %s, %s\n";
enum {
    HEAD,
    E,
    RHO,
    SHEET_E,
    SHEET_G,
    SHEET_RHO,
    L1,
    D1,
    L2,
    D2,
    DISK_Z,
    DISK_M,
    DISK_I,
    SPRING_Z,
    SPRING_K,
    S1,
    S2,
    F1,
    ZETA,
    F2,
    NOISE_F,
    NOISE_S,
    RING_M,
    RING_Z,
    E_LOW,
    E_HIGH,
    E_START,
    M_LOW,
    M_HIGH,
    M_START,
    FIELDS
};
static const char *const si[FIELDS] = {"",      "2.1e11", "7850", "1e11", "4e10", "7600", "0.4",  "0.1",   "0.8",  "0.3",
                                       "0.2",   "5",      "0.02", "0",    "9000", "0.1",  "0.9",  "250",   "0.01", "900",
                                       "0.001", "0.01",   "0.02", "0.3",  "1e10", "3e11", "1e11", "0.001", "0.1",  "0.05"};

static void write_deck(const char *const *field, char *text, size_t size)
{
    const char *const *f = field;
    (void)snprintf(text, size, form, f[0], f[1], f[2], f[3], f[4], f[5], f[6], f[7], f[8], f[9], f[10], f[11], f[12], f[13],
                   f[14], f[15], f[16], f[17], f[18], f[19], f[20], f[21], f[22], f[23], f[24], f[25], f[26], f[27], f[28],
                   f[29]);
}

static int read_fields(const char *const *field, struct message_list *messages, struct job *job)
{
    char text[4096];
    write_deck(field, text, sizeof text);
    message_open(messages, &test_pool);
    int status = deck_read(&test_pool, folder_write("deck.inp", text), 0, NULL, messages, job);
    for (size_t i = 0; i < messages->count && status; i++)
        print_message("%d:%d %s\n", messages->item[i].line, messages->item[i].column, messages->item[i].text);
    return status;
}

/* ---- one number in another unit: the warning stands at its line and says what to write */

static const struct {
    int field;
    const char *value, *says, *cure;
} mistakes[] = {
    {E, "210", "Young's modulus E [Pa] is 210", "*UNITS, MODULUS=GPA"},
    {E, "210000", "Young's modulus E [Pa] is 210000", "*UNITS, MODULUS=MPA"},
    {E, "2.1e14", "Young's modulus E [Pa] is 2.1e14", "outside of what rotors have"},
    {RHO, "7.85", "density [kg/m3] is 7.85", "*UNITS, DENSITY=KG/DM3"},
    {RHO, "7.85e-9", "density [kg/m3] is 7.85e-9", "*UNITS, DENSITY=T/MM3"},
    {RHO, "78500", "density [kg/m3] is 78500", "outside of what rotors have"},
    {SHEET_E, "100", "Young's modulus E [Pa] is 100", "write 1e+11"},
    {SHEET_G, "40000", "shear modulus G [Pa] is 40000", "write 4e+10"},
    {SHEET_RHO, "7.6", "density [kg/m3] is 7.6", "write 7600"},
    {L1, "400", "length [m] is 400", "*UNITS, LENGTH=MM"},
    {L2, "800", "length [m] is 800", "write 0.8"},
    {D1, "100", "outer diameter [m] is 100", "*UNITS, LENGTH=MM"},
    {D2, "12", "outer diameter [m] is 12", "outside of what rotors have"},
    {DISK_M, "5e6", "mass [kg] is 5e6", "*UNITS, MASS=G"},
    {F1, "0.02", "frequency [Hz] is 0.02", "*UNITS, FREQUENCY=KHZ"},
    {F2, "900000", "frequency [Hz] is 900000", "*UNITS, FREQUENCY=R"},
    {ZETA, "1.2", "damping ratio is 1.2", "not percent"},
    {NOISE_F, "0.1", "FREQUENCY is 0.1", "10 % of the frequency"},
    {NOISE_S, "1.5", "SHAPE is 1.5", "not percent"},
    {E_START, "100", "start of a Young's modulus [Pa] is 100", "write 1e+11"},
};

UNIT_TEST(a_number_in_another_unit_is_noticed_with_its_cure)
{
    for (size_t i = 0; i < sizeof mistakes / sizeof *mistakes; i++) {
        const char *field[FIELDS];
        struct message_list messages;
        struct job job;
        memcpy(field, si, sizeof field);
        field[mistakes[i].field] = mistakes[i].value;
        (void)read_fields(field, &messages, &job);
        const rotid_message *found = find_message(&messages, mistakes[i].says);
        if (!found)
            print_error("%s: nothing said\n", mistakes[i].says);
        assert_non_null(found);
        assert_int_equal(found->severity, SEVERITY_WARNING);
        assert_true(found->line > 1);
        if (!strstr(found->text, mistakes[i].cure))
            print_error("%s\n", found->text);
        assert_non_null(strstr(found->text, mistakes[i].cure));
    }
}

/* ---- right decks */

/* Commas in numbers are told before what follows from them; lists without blanks, and with points, are no such numbers. */
UNIT_TEST(a_decimal_comma_is_told_first)
{
    static const char model[] = "*MATERIAL, NAME=m\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=s, MATERIAL=m\n";
    static const struct {
        const char *lines;
        int line;
    } table[] = {{"1.0, 0.05, 0, 20\n*MODES\n1, 435,5\n", 9}, {"1,5, 0,05, 0\n", 7}, {"1.0, 0.05, 0,20\n", 0}, {"1,1,0,20\n", 0}};
    char text[600];
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        struct message_list messages;
        struct states states;
        (void)snprintf(text, sizeof text, "%s%s", model, table[i].lines);
        message_open(&messages, &test_pool);
        (void)deck_read_states(&test_pool, folder_write("comma.inp", text), NULL, 0, NULL, &messages, &states);
        const rotid_message *found = find_message(&messages, "a decimal comma?");
        assert_int_equal(found != NULL, table[i].line > 0);
        assert_true(!found || (found == messages.item && found->line == table[i].line));
    }
}

UNIT_TEST(right_decks_get_no_warning_of_units)
{
    static const char *const decks[] = {"brake_reuss_beam", "brake_reuss_lap",   "converged_rotor",    "converged_stack",
                                        "converged_steel",  "foam_bar",          "foam_bar_supports",  "motor_shaft_stack",
                                        "paper_rotor",      "paper_rotor_solid", "roving_hammer_beam", "solid_rotor",
                                        "solid_steel",      "solid_steel_stiff"};
    /* a strip of 2 mm, a turbine of 60 t, plastic, tungsten, magnesium, rubber-like sheets, thin tubes, a soft sling ... */
    static const struct {
        int field[3];
        const char *value[3];
    } own[] = {{{D1, D2, RHO}, {"0.002", "0.002", "2700"}},
               {{L1, L2, D2}, {"4", "6", "1.2"}},
               {{E, RHO, SHEET_E}, {"2.5e9", "1050", "1e10"}},
               {{E, RHO, D1}, {"4.1e11", "19300", "0.05"}},
               {{E, RHO, E}, {"4.5e10", "1740", "4.5e10"}},
               {{SHEET_E, SHEET_G, E_LOW}, {"5e9", "2e8", "1e8"}},
               {{F1, F2, ZETA}, {"2.5", "31", "0.2"}},
               {{F1, F2, ZETA}, {"8000", "22000", "1e-5"}},
               {{NOISE_F, NOISE_S, ZETA}, {"0.03", "0.2", "0.05"}},
               {{NOISE_F, NOISE_S, ZETA}, {"1e-6", "1e-4", "0"}},
               {{DISK_M, DISK_I, RING_M}, {"0.005", "1e-7", "0.01"}},
               {{DISK_M, DISK_I, L2}, {"4000", "900", "3"}},
               {{L1, D1, D2}, {"0.03", "0.004", "0.006"}},
               {{SPRING_K, F1, F2}, {"1e12", "300", "999"}},
               {{SHEET_RHO, RHO, L1}, {"7000", "8900", "0.2"}},
               {{E_LOW, E_HIGH, E_START}, {"1e6", "1e12", "2e11"}}};
    for (size_t i = 0; i < sizeof decks / sizeof *decks; i++) {
        char path[512];
        struct message_list messages;
        struct job job;
        struct spectrum spectrum;
        (void)snprintf(path, sizeof path, INPUT "%s.inp", decks[i]);
        message_open(&messages, &test_pool);
        assert_status(deck_read(&test_pool, path, 0, NULL, &messages, &job), ROTID_OK);
        assert_null(find_message(&messages, "rotors have"));
        assert_null(find_message(&messages, "percent"));
        assert_null(find_message(&messages, "another unit"));
        if (job.options.solid) /* as fine, and slow */
            continue;
        assert_status(spectrum_compute_parts(&test_pool, job.models, &job.rotor, 0, NULL, NULL, ROTID_GUYAN,
                                             comparison_candidates(&job), 0, &spectrum),
                      ROTID_OK);
        assert_true(check_units(&job, &spectrum, 0, &messages) == 0);
    }
    for (size_t i = 0; i < sizeof own / sizeof *own; i++) {
        const char *field[FIELDS];
        struct message_list messages;
        struct job job;
        memcpy(field, si, sizeof field);
        field[SPRING_Z] = field[DISK_Z] = "start";
        field[S1] = "start";
        field[S2] = "end";
        field[RING_Z] = "core.start";
        for (int k = 0; k < 3; k++)
            field[own[i].field[k]] = own[i].value[k];
        assert_status(read_fields(field, &messages, &job), ROTID_OK);
        for (size_t m = 0; m < messages.count; m++)
            if (messages.item[m].line)
                print_error("deck %zu: %s\n", i, messages.item[m].text);
        assert_null(find_message(&messages, "rotors have"));
        assert_null(find_message(&messages, "percent"));
        assert_null(find_message(&messages, "another unit"));
    }
}

/* ---- *UNITS */

/* Every word, by what the unit is: of a length a micrometre is 1e-6 m, so a newton for each is 1e6 N/m. */
UNIT_TEST(every_unit_is_what_it_is_called)
{
    static const double inch = 0.0254, pound = 0.45359237, standard_g = 9.80665, turn = 6.283185307179586;
    const struct {
        const char *si, *word;
        double factor;
    } unit[] = {{"m", "m", 1},
                {"m", "cm", 1e-2},
                {"m", "mm", 1e-3},
                {"m", "in", inch},
                {"Pa", "MPa", 1e6},
                {"Pa", "GPa", 1e9},
                {"Pa", "N/mm2", 1 / (1e-3 * 1e-3)},
                {"Pa", "psi", pound * standard_g / (inch * inch)},
                {"kg/m3", "kg/dm3", 1 / (0.1 * 0.1 * 0.1)},
                {"kg/m3", "g/cm3", 1e-3 / (1e-2 * 1e-2 * 1e-2)},
                {"kg/m3", "kg/mm3", 1 / (1e-3 * 1e-3 * 1e-3)},
                {"kg/m3", "t/mm3", 1e3 / (1e-3 * 1e-3 * 1e-3)},
                {"kg", "g", 1e-3},
                {"kg", "t", 1e3},
                {"kg", "lb", pound},
                {"kg.m2", "kg.cm2", 1e-2 * 1e-2},
                {"kg.m2", "kg.mm2", 1e-3 * 1e-3},
                {"N", "kN", 1e3},
                {"N", "MN", 1e6},
                {"N", "lbf", pound * standard_g},
                {"N/m", "N/mm", 1 / 1e-3},
                {"N/m", "N/um", 1 / 1e-6},
                {"N/m", "kN/mm", 1e3 / 1e-3},
                {"Hz", "kHz", 1e3},
                {"Hz", "rpm", 1.0 / 60},
                {"Hz", "rad/s", 1 / turn}};
    for (size_t i = 0; i < sizeof unit / sizeof *unit; i++)
        assert_close(deck_unit_factor(unit[i].si, unit[i].word), unit[i].factor, 1e-12, 0);
}

UNIT_TEST(a_deck_in_other_units_is_the_same_rotor)
{
    static const char *const mm[FIELDS] = {
        "*UNITS, LENGTH=MM, MODULUS=GPA, DENSITY=G/CM3, MASS=G, INERTIA=KG.MM2, STIFFNESS=N/MM, FREQUENCY=RPM\n",
        "210",
        "7.85",
        "100",
        "40",
        "7.6",
        "400",
        "100",
        "800",
        "300",
        "200",
        "5000",
        "20000",
        "0",
        "9",
        "100",
        "900",
        "15000",
        "0.01",
        "54000",
        "0.001",
        "0.01",
        "20",
        "300",
        "10",
        "300",
        "100",
        "1",
        "100",
        "50"};
    struct message_list messages;
    struct job job[2];
    const char *card;
    assert_status(read_fields(si, &messages, &job[0]), ROTID_OK);
    assert_status(read_fields(mm, &messages, &job[1]), ROTID_OK);
    assert_null(find_message(&messages, "rotors have"));
    const struct rotor *a = &job[0].rotor, *b = &job[1].rotor;
    for (int g = 0; g < 2; g++) {
        assert_close(b->group[g].material.e, a->group[g].material.e, 1e-14, 0);
        assert_close(b->group[g].material.g, a->group[g].material.g, 1e-14, 0);
        assert_close(b->group[g].material.rho, a->group[g].material.rho, 1e-14, 0);
        assert_close(b->segment[g].length, a->segment[g].length, 1e-14, 0);
        assert_close(b->segment[g].outer, a->segment[g].outer, 1e-14, 0);
        assert_close(b->sensor[g].position, a->sensor[g].position, 1e-14, 0);
        assert_close(job[1].measurement.frequency_hz[g], job[0].measurement.frequency_hz[g], 1e-14, 0);
        assert_close(job[1].unknowns.bounds[g].lower, job[0].unknowns.bounds[g].lower, 1e-14, 0);
        assert_close(job[1].unknowns.bounds[g].upper, job[0].unknowns.bounds[g].upper, 1e-14, 0);
        assert_close(job[1].unknowns.bounds[g].start, job[0].unknowns.bounds[g].start, 1e-14, 0);
        assert_close(b->effect[0].value[g], a->effect[0].value[g], 1e-14, 0);
    }
    assert_close(b->disk[0].position, a->disk[0].position, 1e-14, 0);
    assert_close(b->disk[0].mass, a->disk[0].mass, 1e-14, 0);
    assert_close(b->disk[0].diametral, a->disk[0].diametral, 1e-14, 0);
    assert_close(b->spring[0].lateral, a->spring[0].lateral, 1e-14, 0);
    assert_int_equal(deck_compare(&test_pool, &job[0], &job[1], &card), 0); /* and whatever else there is */
}

UNIT_TEST(units_that_cannot_be_are_refused)
{
    static const struct {
        const char *card, *says;
    } wrong[] = {{"*UNITS, LENGTH=FURLONG\n", "LENGTH=FURLONG is not known, expected one of M, CM, MM, IN"},
                 {"*UNITS, LENGTH=MM\n*UNITS, LENGTH=CM\n", "the unit of LENGTH is given twice"},
                 {"*UNITS, LENGTH=M\n7\n", "*UNITS has no data lines"},
                 {"*UNITS, TIME=H\n", "TIME"}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        const char *field[FIELDS];
        struct message_list messages;
        struct job job;
        memcpy(field, si, sizeof field);
        field[HEAD] = wrong[i].card;
        assert_status(read_fields(field, &messages, &job), ROTID_ERROR_SYNTAX);
        assert_non_null(find_message(&messages, wrong[i].says));
    }
}

/* What sixteen digits cannot hold together has a place, in place of a solution that fails. */
UNIT_TEST(numbers_too_far_apart_are_refused_with_their_place)
{
    static const char shaft[] =
        "*MATERIAL, NAME=steel\n*ELASTIC\n%s, 0.3\n*DENSITY\n7850\n*MATERIAL, NAME=other\n*ELASTIC\n2e11, 0.3\n"
        "*DENSITY\n7850\n*SHAFT, NAME=core, MATERIAL=steel\n1, 0.1, 0, 30\n%s";
    static const struct {
        const char *e, *cards, *says;
        int line;
    } cases[] = {{"2e11", "*SPRING\nstart, 1e29\n", "times as stiff as the shaft", 11},
                 {"2e11", "*SPRING\nstart, 1e18\n", NULL, 0},
                 {"2e11", "*DISK\nend, 1e25\n", "times as heavy as the shaft", 11},
                 {"2e11", "*DISK\nend, 1e8\n", NULL, 0},
                 {"2e11", "1e-9, 0.2, 0, 1\n", "1e-09 m long in a rotor", 11},
                 {"2e11", "1e-6, 0.2, 0, 1\n", NULL, 0},
                 {"2e11", "0.2, 5e-6, 0, 4\n", "5e-06 m thick in a rotor of up to 0.1 m", 11},
                 {"2e11", "0.2, 2e-5, 0, 4\n", NULL, 0},
                 {"150", "*SHAFT, NAME=end, MATERIAL=other\n1, 0.1, 0, 30\n", "Young's modulus of steel is 150 Pa", 1},
                 {"2e9", "*SHAFT, NAME=end, MATERIAL=other\n1, 0.1, 0, 30\n", NULL, 0}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[600], failure[ROTID_FAILURE_LENGTH];
        rotid_deck *deck = NULL;
        rotid_spectrum *spectrum;
        (void)snprintf(text, sizeof text, shaft, cases[i].e, cases[i].cards);
        int status = rotid_deck_read_text(strlen(text), text, NULL, NULL, 0, NULL, NULL, failure, &deck);
        if (cases[i].says) {
            char place[20];
            (void)snprintf(place, sizeof place, ":%d:1", cases[i].line);
            assert_status(status, ROTID_ERROR_SYNTAX);
            assert_non_null(strstr(failure, cases[i].says));
            assert_non_null(strstr(failure, place));
            rotid_deck_free(deck);
            continue;
        }
        assert_status(status, ROTID_OK);
        assert_status(rotid_spectrum_compute(deck, NULL, 3, NULL, failure, &spectrum), ROTID_OK);
        rotid_spectrum_free(spectrum);
        rotid_deck_free(deck);
    }
}

/* Each number alone is possible: the problem fails, and the softest section is named beside the stiffest element. */
UNIT_TEST(sections_too_far_apart_are_named_where_the_problem_fails)
{
    static const char *const sections[][2] = {{"0.5, 0.002, 0, 4", "0.0001, 0.19, 0, 8"},
                                              {"5, 0.0005, 0, 4", "0.002, 1.9, 0, 8"},
                                              {"0.732632, 0.00381895, 0.00114569, 8\n0.122539, 0.000467971, 0.000463292, 2\n"
                                               "0.0586624, 0.00440842, 0, 2\n0.106905, 0.0895228, 0, 8",
                                               "0.000671582, 0.0134166, 0.0132825, 8\n0.000156797, 0.242305, 0.239882, 2\n"
                                               "0.00042614, 0.0344631, 0, 2\n0.170224, 0.0518854, 0, 1\n"
                                               "0.0876256, 0.0623385, 0.0187015, 1\n0.0942644, 0.00406253, 0.0040219, 8\n"
                                               "0.000147997, 0.00382556, 0, 2\n0.000750908, 0.116142, 0, 8"}};
    for (size_t i = 0; i < sizeof sections / sizeof *sections; i++) {
        char text[800], failure[ROTID_FAILURE_LENGTH];
        rotid_deck *deck;
        rotid_check *check;
        (void)snprintf(text, sizeof text,
                       "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.49\n*DENSITY\n7850\n*SHAFT, NAME=thin, MATERIAL=steel\n%s\n"
                       "*SHAFT, NAME=disc, MATERIAL=steel\n%s\n",
                       sections[i][0], sections[i][1]);
        assert_status(rotid_deck_read_text(strlen(text), text, "thin.inp", NULL, 0, NULL, NULL, failure, &deck), ROTID_OK);
        assert_true(rotid_deck_check(deck, NULL, failure, &check) < 0);
        assert_non_null(strstr(failure, "thin.inp:6:1: "));
        assert_non_null(strstr(failure, "a section of thin has EI/L^3 = "));
        rotid_deck_free(deck);
    }
}

/* Of densities too: an error where the deck alone has a warning. */
UNIT_TEST(densities_too_far_apart_are_named_where_the_problem_fails)
{
    static const struct {
        const char *density, *says;
    } table[] = {{"7.65e18", "near.inp:13:1: the stiffness matrix is not positive semidefinite: the density of b is 7.65e+18 "},
                 {"1e-12", "near.inp:11:1: the stiffness matrix is not positive semidefinite: the density of a is 7.85e+03 "}};
    for (size_t i = 0; i < 4; i++) {
        char text[800], failure[ROTID_FAILURE_LENGTH];
        rotid_deck *deck;
        rotid_spectrum *spectrum;
        (void)snprintf(text, sizeof text,
                       "*MATERIAL, NAME=s\n*ELASTIC\n2.1e11, .3\n*DENSITY\n7850\n*MATERIAL, NAME=t\n*ELASTIC\n2.1e11, .3\n"
                       "*DENSITY\n%s\n*SHAFT, NAME=a, MATERIAL=s\n.4, .06, 0, 8\n*SHAFT, NAME=b, MATERIAL=t\n.4, .08, 0, 8\n"
                       "*FIT, MODEL=%s\n",
                       table[i / 2].density, i % 2 ? "SOLID" : "BEAM");
        assert_status(rotid_deck_read_text(strlen(text), text, "near.inp", NULL, 0, NULL, NULL, failure, &deck), ROTID_OK);
        assert_true(rotid_spectrum_compute(deck, NULL, 3, NULL, failure, &spectrum) < 0);
        assert_non_null(strstr(failure, table[i / 2].says));
        rotid_deck_free(deck);
    }
}

/* ---- frequencies beside the model's */

UNIT_TEST(a_common_factor_of_all_frequencies_is_named)
{
    static const struct {
        double factor;
        const char *says;
    } cases[] = {{6.283185307, "rad/s"},
                 {0.159154943, "2 pi"},
                 {1e3, "LENGTH=MM"},
                 {1e-3, "kHz"},
                 {31.6227766, "density"},
                 {0.0316227766, "KG/DM3"},
                 {1, NULL},
                 {2.2, NULL},
                 {0.5, NULL},
                 {100, NULL}};
    struct message_list messages;
    struct job job;
    struct spectrum spectrum;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        for (int spread = 0; spread < 2; spread++) {
            assert_status(read_fields(si, &messages, &job), ROTID_OK);
            assert_status(spectrum_compute_parts(&test_pool, job.models, &job.rotor, 0, NULL, NULL, ROTID_GUYAN, 2, 0, &spectrum),
                          ROTID_OK);
            for (int k = 0; k < 2; k++) /* 12 % between the modes: wrong moduli */
                job.measurement.frequency_hz[k] = spectrum.full_hz[k] * cases[i].factor * (spread && k ? 1.12 : 1);
            message_open(&messages, &test_pool);
            assert_close(check_units(&job, &spectrum, 0, &messages), cases[i].says ? cases[i].factor : 0, 1e-6, 0);
            if (cases[i].says)
                assert_non_null(find_message(&messages, cases[i].says));
        }
}

/* What is probably millimetres is taken for them throughout: 50 alone would rather be centimetres. */
UNIT_TEST(one_unit_is_named_for_all_lengths_of_a_deck)
{
    struct message_list messages;
    struct job job;
    const struct deck_memory memory = {.name = "deck",
                                       .directory = "/",
                                       .text = "*MATERIAL, NAME=m\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n"
                                               "*SHAFT, NAME=s, MATERIAL=m\n1000, 50, 0, 40\n"};
    struct deck_memory whole = memory;
    whole.length = strlen(memory.text);
    message_open(&messages, &test_pool);
    struct states states;
    assert_status(deck_read_states(&test_pool, "deck", &whole, 0, NULL, &messages, &states), ROTID_OK);
    job = states.state->job;
    assert_true(job.rotor.nsegment > 0);
    int said = 0;
    for (size_t i = 0; i < messages.count; i++)
        said += strstr(messages.item[i].text, "should it be in MM, write 1, ") ||
                strstr(messages.item[i].text, "should it be in MM, write 0.05, ");
    assert_int_equal(said, 2);
}

TEST_GROUP(folder_make, folder_remove);
