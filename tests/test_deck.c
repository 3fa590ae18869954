/* Right decks: every card into the right numbers of a job, and the freedom of form that a deck has. Wrong ones:
 * test_wrong_decks.c; measured data from universal files: test_decks.c; --set: test_cli.c. */
#include <sys/stat.h>
#include <unistd.h>

#include "deck/deck.h"
#include "folder.h"
#include "reading.h"
#include "support.h"

#define EVERY_CARD ROTID_SOURCE_DIR "/tests/data/decks/every_card.inp"

#define MATERIAL "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n"
#define SHAFT    "*SHAFT, NAME=core, MATERIAL=steel\n1, 0.1, 0, 20\n"
#define MODES    "*MODES\n1, 500\n2, 1300\n3, 2400\n5, 5400\n"
#define START    MATERIAL SHAFT MODES

#define assert_number(value, expected) assert_close((value), (expected), 1e-14, 0)

static struct reading every;

/* ------------------------------------------------------------------------------------------------ every card */

UNIT_TEST(materials_are_isotropic_unless_a_shear_modulus_is_given)
{
    const struct group *group = every.job.rotor.group;
    const struct material *steel = &group[0].material, *lamination = &group[1].material;
    assert_true(steel->e == 2.1e11 && steel->nu == 0.3 && steel->rho == 7850 && steel->isotropic);
    assert_number(material_shear_modulus(steel), 2.1e11 / 2.6);
    assert_true(lamination->e == 0.6e11 && lamination->g == 0.3e11 && lamination->nu == 0.28 && lamination->rho == 7650);
    assert_false(lamination->isotropic);
}

UNIT_TEST(shafts_and_beams_are_laid_end_to_end)
{
    const struct rotor *rotor = &every.job.rotor;
    const struct segment *s = rotor->segment;
    double from, to;
    rotor_group_span(rotor, 1, &from, &to);
    assert_true(rotor->ngroup == 3 && rotor->nsegment == 4 && !strcmp(rotor->group[1].name, "core"));
    assert_number(from, 0.5);
    assert_number(to, 1.2);
    assert_number(rotor_length(rotor), 1.3);
    assert_true(s[0].length == 0.25 && s[0].outer == 0.14 && s[0].inner == 0 && s[0].elements == 8 && s[0].stiff_outer == 0.14);
    assert_true(s[1].outer == 0.20 && s[1].inner == 0.05 && s[1].stiff_outer == 0.18 && s[1].group == 0);
    assert_true(s[2].length == 0.7 && s[2].outer == 0.36 && s[2].inner == 0.04 && s[2].elements == 14 && s[2].group == 1);
    assert_true(s[3].length == 0.1 && s[3].height == 0.03 && s[3].width == 0.2 && s[3].elements == 2 && s[3].group == 2);
    assert_true(s[3].rectangular && !s[0].rectangular && !s[1].rectangular && !s[2].rectangular);
}

UNIT_TEST(holes_and_forces_belong_to_their_group_and_forces_add)
{
    const struct group *group = every.job.rotor.group;
    assert_true(group[1].holes == 8 && group[1].hole_diameter == 0.02 && group[1].hole_pitch == 0.12);
    assert_true(!group[0].holes && !group[2].holes && group[0].preload == 1000 && group[1].preload == 0 && group[2].preload == 0);
}

UNIT_TEST(tie_rods_are_balanced_rods_of_one_element_unless_told_otherwise)
{
    const struct tierod *ties = &every.job.rotor.tierod[0], *bolts = &every.job.rotor.tierod[1];
    assert_int_equal(every.job.rotor.ntierod, 2);
    assert_true(ties->model == BUNDLE_RODS && ties->self_equilibrated && ties->elements == 1 && ties->material.e == 2.1e11);
    assert_true(ties->number == 12 && ties->diameter == 0.02 && ties->pitch == 0.14 && ties->tension == 50e3);
    assert_true(bolts->model == BUNDLE_TUBE && !bolts->self_equilibrated && bolts->number == 6 && bolts->from == 0.1);
    assert_number(ties->from, 0.5);
    assert_number(ties->to, 1.2);
    assert_number(bolts->to, 0.5);
}

UNIT_TEST(rods_with_modes_of_their_own_are_warned_about)
{
    struct reading r;
    read_text(&r, START "*TIEROD, NAME=t, MATERIAL=steel, FROM=start, TO=end\n6, 0.01, 0.04, 1e3, 4\n", NULL);
    assert_true(r.job.rotor.tierod[0].elements == 4 && warns(&r.messages, "rods in 4 elements have modes of their own"));
    pool_close(&r.pool);
    read_text(&r, START "*BARS, NAME=cage, MATERIAL=steel, CENTER=0.5, LENGTH=0.8\n6, 0.01, 0.04, 2\n", NULL);
    assert_true(warns(&r.messages, "bars fixed at their centre alone have a mode of their own near 45 Hz"));
    pool_close(&r.pool);
}

UNIT_TEST(bars_disks_springs_and_the_sling_are_read)
{
    const struct rotor *rotor = &every.job.rotor;
    const struct bars *bars = rotor->bars;
    const struct disk *disk = rotor->disk;
    const struct spring *spring = rotor->spring;
    assert_true(rotor->nbars == 1 && rotor->ndisk == 3 && rotor->nspring == 3 && rotor->sling == 1.1);
    assert_true(bars->model == BUNDLE_TUBE && bars->number == 24 && bars->elements == 4 && bars->material.e == 0.6e11);
    assert_true(bars->center == 0.85 && bars->length == 0.6 && bars->diameter == 0.01 && bars->pitch == 0.15);
    assert_true(!strcmp(disk[0].name, "fan") && !strcmp(spring[0].name, "sling") && !disk[1].name && !spring[1].name);
    assert_true(disk[0].position == 0.2 && disk[0].mass == 12 && disk[0].diametral == 0.3 && disk[0].polar == 0.5);
    assert_true(disk[1].mass == 3 && disk[1].diametral == 0 && disk[1].polar == 0);
    assert_true(disk[2].position == 0.9 && disk[2].diametral == 0.1 && disk[2].polar == 0);
    assert_true(spring[0].position == 0 && spring[0].lateral == 9790 && spring[0].rotational == 0);
    assert_true(spring[1].lateral == 2000 && spring[1].rotational == 10);
    assert_true(spring[2].position == 0.5 && spring[2].lateral == 1);
    assert_number(disk[1].position, 1.3);
    assert_number(spring[1].position, 1.3);
}

UNIT_TEST(sensors_are_sorted_and_shapes_follow_them)
{
    static const int id[] = {10, 40, 20, 30};
    static const double z[] = {0, 0.4, 1.2, 1.25};
    const double *shape = every.job.measurement.shape, *std = every.job.measurement.shape_std;
    assert_int_equal(every.job.rotor.nsensor, 4);
    for (int s = 0; s < 4; s++) {
        assert_int_equal(every.job.rotor.sensor[s].id, id[s]);
        assert_number(every.job.rotor.sensor[s].position, z[s]);
        assert_true(isnan(shape[4 + s])); /* of mode 2 nothing was measured */
    }
    assert_true(shape[0] == 1 && isnan(shape[1]) && shape[2] == -0.5 && isnan(shape[3]));
    assert_true(isnan(shape[8]) && shape[9] == -2 && isnan(shape[10]) && shape[11] == 0);
    assert_true(std[0] == 0.02 && std[2] == 0.03 && std[9] == 0.02); /* *NOISE where the line states none */
}

UNIT_TEST(transfer_functions_are_as_the_card_says)
{
    const struct frf_request *frf = &every.job.options.frf;
    assert_true(frf->given && !frf->file && frf->low_hz == 100 && frf->high_hz == 1800 && frf->step_hz == 0.5 && !frf->nline);
    assert_true(frf->has_quantity && frf->quantity == FRF_VELOCITY && frf->damping == 0.008 && frf->npair == 2);
    assert_true(frf->pair[1].response == 40 && frf->pair[1].reference == 10);
}

UNIT_TEST(modes_carry_damping_and_noise_where_there_is_any)
{
    static const int number[] = {1, 2, 4};
    static const double hz[] = {300, 700, 1500}, std[] = {0.6 / 300, 0.004, 3.0 / 1500};
    assert_int_equal(every.job.measurement.nmode, 3);
    for (int k = 0; k < 3; k++) {
        assert_true(every.job.measurement.number[k] == number[k] && every.job.measurement.frequency_hz[k] == hz[k]);
        assert_number(every.job.measurement.frequency_std[k], std[k]);
    }
    assert_true(every.job.measurement.damping[0] == 0.01 && isnan(every.job.measurement.damping[1]) &&
                isnan(every.job.measurement.damping[2]));
}

UNIT_TEST(every_kind_of_parameter_is_identified_by_its_name)
{
    static const struct {
        struct parameter parameter;
        const char *unit;
        double lower, upper, start;
    } expected[] = {{{PARAMETER_E, 1, 0, 0, NULL}, "Pa", 1e6, 2.3e11, 0.6e11},
                    {{PARAMETER_G, 1, 0, 0, NULL}, "Pa", 1e6, 0.9e11, 0.25e11},
                    {{PARAMETER_NU, 0, 0, 0, NULL}, "1", 0.1, 0.45, 0.3},
                    {{PARAMETER_RHO, 1, 0, 0, NULL}, "kg/m3", 7000, 8000, 7650},
                    {{PARAMETER_TIEROD_E, 0, 0, 0, NULL}, "Pa", 1e10, 3e11, 2e11},
                    {{PARAMETER_TENSION, 0, 0, 0, NULL}, "N", -1e5, 1e6, 5e4},
                    {{PARAMETER_SPRING_K, 0, 0, 0, NULL}, "N/m", 0, 1e5, 9790},
                    {{PARAMETER_SPRING_K_ROT, 0, 0, 0, NULL}, "N.m/rad", 0, 1e3, 1},
                    {{PARAMETER_DISK_MASS, 0, 0, 0, NULL}, "kg", 1, 20, 12},
                    {{PARAMETER_DISK_INERTIA, 0, 0, 0, NULL}, "kg.m2", 0.1, 1, 0.3}};
    assert_int_equal(every.job.unknowns.nparameter, sizeof expected / sizeof *expected);
    for (int p = 0; p < every.job.unknowns.nparameter; p++) {
        const rotid_parameter *bounds = &every.job.unknowns.bounds[p];
        assert_memory_equal(&every.job.unknowns.parameter[p], &expected[p].parameter, sizeof(struct parameter));
        assert_string_equal(bounds->unit, expected[p].unit);
        assert_memory_equal(&bounds->lower, &expected[p].lower, 3 * sizeof(double)); /* lower, upper, start */
    }
}

UNIT_TEST(the_heading_keeps_its_text_and_gives_references)
{
    const rotid_reference *paper = every.job.reference;
    assert_true(every.job.nheading == 2 && every.job.nreference == 1);
    assert_string_equal(paper->quantity, "error_percent");
    assert_string_equal(every.job.heading[0], "A rotor that has everything");
    assert_string_equal(every.job.heading[1], "second line, with a comma");
    assert_true(paper->nvalues == 3 && paper->values[0] == 1.5 && paper->values[1] == -2 && paper->values[2] == 3);
    assert_string_equal(every.job.deck, EVERY_CARD);
}

/* ------------------------------------------------------------------------------------------------ what to fit */

UNIT_TEST(without_a_word_of_the_user_the_fit_is_what_can_be_trusted)
{
    static const struct {
        const char *text;
        int functional, reduction, derivative;
    } expected[] = {{START, ROTID_HYBRID, ROTID_REDUCTION_NONE, ROTID_NELSON},
                    {START "*NOISE, FREQUENCY=0.001\n", ROTID_LIKELIHOOD, ROTID_REDUCTION_NONE, ROTID_NELSON},
                    {START "*NOISE, SHAPE=0.01\n", ROTID_HYBRID, ROTID_REDUCTION_NONE, ROTID_NELSON},
                    {MATERIAL SHAFT "*MODES\n1, 500, , 2\n2, 1300, , 1\n", ROTID_LIKELIHOOD, ROTID_REDUCTION_NONE, ROTID_NELSON},
                    {START "*FIT, REDUCTION=IRS\n", ROTID_HYBRID, ROTID_IRS, ROTID_NELSON},
                    {START "*FIT, REDUCTION=GUYAN, DERIVATIVE=MODAL\n", ROTID_HYBRID, ROTID_GUYAN, ROTID_MODAL},
                    {START "*NOISE, FREQUENCY=1e-3\n*FIT, FUNCTIONAL=hybrid_f\n", ROTID_HYBRID_F, 0, 0}};
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        struct reading r;
        read_text(&r, expected[i].text, NULL);
        assert_int_equal(r.job.options.fit.functional, expected[i].functional);
        assert_int_equal(r.job.options.fit.reduction, expected[i].reduction);
        assert_int_equal(r.job.options.fit.derivative, expected[i].derivative);
        for (int k = 0; k < r.job.measurement.nmode; k++)
            assert_int_equal(r.job.measurement.holdout[k], 0);
        pool_close(&r.pool);
    }
}

UNIT_TEST(lists_of_modes_choose_what_is_fitted_and_what_is_held_out)
{
    static const struct {
        const char *text;
        int holdout[4]; /* of modes 1, 2, 3 and 5 */
    } expected[] = {{START "*FIT, MODES=1-3,5, HOLDOUT=5\n", {0, 0, 0, 1}},  {START "*FIT, HOLDOUT=2\n", {0, 1, 0, 0}},
                    {START "*FIT, HOLDOUT=1, 3,5, TIE=E:G\n", {1, 0, 1, 1}}, {START "*FIT, MODES=2-3\n", {1, 0, 0, 1}},
                    {START "*FIT, MODES=1,\n 2, HOLDOUT=2\n", {0, 1, 1, 1}}, {START "*FIT, MODES=5\n", {1, 1, 1, 0}}};
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        struct reading r;
        read_text(&r, expected[i].text, NULL);
        assert_memory_equal(r.job.measurement.holdout, expected[i].holdout, sizeof expected[i].holdout);
        pool_close(&r.pool);
    }
}

UNIT_TEST(a_tie_makes_the_group_isotropic_and_drops_its_shear_modulus)
{
    static const char *const texts[] = {
        START "*FIT, TIE=E:G\n*IDENTIFY\ncore.E, 1e10, 4e11, 2e11\ncore.G, 1e9, 2e11, 8e10\ncore.rho, 7000, 8000, 7850\n",
        START "*FIT, TIE=E:G\n*IDENTIFY\ncore.G, 1e9, 2e11, 8e10\ncore.E, 1e10, 4e11, 2e11\ncore.rho, 7000, 8000, 7850\n"};
    for (int i = 0; i < 2; i++) {
        struct reading r;
        read_text(&r, texts[i], NULL);
        assert_true(r.job.unknowns.nparameter == 2 && r.job.unknowns.parameter[0].kind == PARAMETER_E &&
                    r.job.unknowns.parameter[1].kind == PARAMETER_RHO);
        assert_true(!strcmp(r.job.unknowns.bounds[0].name, "core.E") && !strcmp(r.job.unknowns.bounds[1].name, "core.rho"));
        assert_true(r.job.rotor.group[0].material.isotropic && warns(&r.messages, "core.G follows core.E"));
        pool_close(&r.pool);
    }
}

UNIT_TEST(an_identified_shear_modulus_is_no_longer_that_of_an_isotropic_material)
{
    struct reading r;
    read_text(&r, START "*IDENTIFY\ncore.G, 1e9, 2e11, 7e10\n", NULL);
    assert_false(r.job.rotor.group[0].material.isotropic);
    assert_number(r.job.rotor.group[0].material.g, 2.1e11 / 2.6);
    pool_close(&r.pool);
}

/* ------------------------------------------------------------------------------------------------ form */

UNIT_TEST(form_does_not_change_what_a_deck_says)
{
    static const char *const texts[] = {
        START "*IDENTIFY\ncore.E, 1e10, 4e11, 2e11\n",
        "*material,name=STEEL\n*Elastic\n2.1E11,.3\n*density\n7850.\n*shaft,material=Steel,name=core\n1,0.1,0,20\n*modes\n1,500\n"
        "2,1300\n3,2400\n5,5400\n*identify\nCORE.e,1e10,4e11,2e11",
        /* an editor of Windows, half an end of the last line */
        "\xef\xbb\xbf*MATERIAL, NAME=steel\r\n*ELASTIC\r\n2.1e11, 0.3\r\n*DENSITY\r\n7850\r\n\r\n*SHAFT, NAME=core, MATERIAL="
        "steel\r\n1, 0.1, 0, 20\r\n*MODES\r\n1, 500\r\n2, 1300\r\n3, 2400\r\n5, 5400\r\n*IDENTIFY\r\ncore.E, 1e10, 4e11, 2e11\r",
        /* blanks, tabs, comments, a keyword line in several lines, a comma behind the last option or value */
        "** comment\n\n * MATERIAL , NAME = steel ,\n*ELASTIC ** isotropic\n\t2.1e11\t,0.3,** E, nu\n**\n*DENSITY\n7850**kg/m3\n"
        " \t \n*SHAFT,\n NAME=core,\n  \n** and\n MATERIAL=steel\n1, 0.1, 0, 20,\n\t*MODES\n1, 500\n2, 1300\n3, 2400\n5, 5400\n"
        "*IDENTIFY\ncore.E, 1e10, 4e11, 2e11\n"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        struct reading r;
        read_text(&r, texts[i], NULL);
        const struct segment *s = r.job.rotor.segment;
        const struct material *m = &r.job.rotor.group[0].material;
        assert_true(r.job.rotor.nsegment == 1 && s->length == 1 && s->outer == 0.1 && s->inner == 0 && s->elements == 20);
        assert_true(m->e == 2.1e11 && m->nu == 0.3 && m->rho == 7850);
        assert_true(r.job.measurement.nmode == 4 && r.job.measurement.number[3] == 5 &&
                    r.job.measurement.frequency_hz[3] == 5400);
        assert_true(r.job.unknowns.nparameter == 1 && r.job.unknowns.parameter[0].kind == PARAMETER_E &&
                    r.job.unknowns.bounds[0].start == 2e11);
        pool_close(&r.pool);
    }
}

UNIT_TEST(a_line_may_have_1024_characters)
{
    char text[2200] = "*HEADING\n";
    struct reading r;
    memset(text + strlen(text), 'x', 1024);
    (void)strcat(text, "\r\n" START);
    read_text(&r, text, NULL);
    assert_int_equal(strlen(r.job.heading[0]), 1024);
    pool_close(&r.pool);
}

UNIT_TEST(an_included_file_is_looked_for_beside_the_one_that_names_it)
{
    struct reading r;
    assert_int_equal(mkdir(folder_path("sub"), 0700), 0);
    assert_int_equal(mkdir(folder_path("sub/deep"), 0700), 0);
    (void)folder_write("sub/steel.inc",
                       "*MATERIAL, NAME=steel\n*INCLUDE, FILE=deep/elastic.inc\n*DENSITY\n*include, file=deep/rho.inc");
    (void)folder_write("sub/deep/elastic.inc", "*ELASTIC\n2.1e11, 0.3\n");
    (void)folder_write("sub/deep/rho.inc", "7850\n"); /* goes on with the card of the deck that names it */
    read_text(&r, "*INCLUDE, FILE=sub/steel.inc\n" SHAFT, NULL);
    assert_number(r.job.rotor.group[0].material.rho, 7850);
    pool_close(&r.pool);
    static const char *const left[] = {"sub/deep/rho.inc", "sub/deep/elastic.inc", "sub/deep", "sub/steel.inc", "sub"};
    for (int i = 0; i < 5; i++)
        assert_int_equal(remove(folder_path(left[i])), 0);
}

UNIT_TEST(positions_are_metres_ends_or_ends_of_groups)
{
    static const double expected[] = {0, 1.5, 1, 1.5, 0, 1, 0.25, 1.5};
    struct reading r;
    read_text(&r,
              MATERIAL SHAFT "*SHAFT, NAME=tail.a, MATERIAL=steel\n0.5, 0.08, 0, 10\n*SPRING\nSTART, 1\nend, 1\ncore.end, 1\n"
                             "Tail.A.End, 1\n-0.000001, 1\ntail.a.start, 1\n0.25, 1\n1.500001, 1\n",
              NULL);
    assert_int_equal(r.job.rotor.nspring, 8);
    for (int i = 0; i < 8; i++) /* a coordinate with six digits may lie a little outside */
        assert_number(r.job.rotor.spring[i].position, expected[i]);
    pool_close(&r.pool);
}

static int open_all(void **state)
{
    read_path(&every, EVERY_CARD, NULL);
    return folder_make(state);
}

static int close_all(void **state)
{
    pool_close(&every.pool);
    return folder_remove(state);
}

TEST_GROUP(open_all, close_all);
