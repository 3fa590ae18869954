/* Rotors that ROSS has saved. tests/data/ross holds what Rotor.save of ROSS 2.3.0 wrote of the rotors of
 * tests/peers/export_peer.py (parts_of_ross); their frequencies come from the matrices of ROSS, by eigh of SciPy in the plane x.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "deck/deck.h"
#include "export/ross_saved.h"
#include "folder.h"
#include "run/spectrum.h"
#include "shell.h"
#include "support.h"

#define SAVED ROTID_SOURCE_DIR "/tests/data/ross/"

static struct message_list messages;

static int read_rotor(const char *path, struct rotor *rotor)
{
    struct ross_saved saved;
    message_open(&messages, &test_pool);
    int status = ross_saved_read(&test_pool, path, &messages, &saved);
    return status ? status : ross_saved_rotor(&test_pool, path, &saved, &messages, rotor);
}

static int says(const char *part)
{
    for (size_t i = 0; i < messages.count; i++)
        if (strstr(messages.item[i].text, part))
            return 1;
    return 0;
}

static void shafts_disks_and_bearings_become_a_rotor(void **state)
{
    struct rotor rotor;
    (void)state;
    assert_status(read_rotor(SAVED "support.json", &rotor), ROTID_OK);
    assert_int_equal(rotor.ngroup, 2); /* the force ends at node 4 */
    assert_string_equal(rotor.group[0].name, "steel");
    assert_string_equal(rotor.group[1].name, "steel_2");
    assert_true(rotor.group[0].preload == 2e4 && rotor.group[1].preload == 0);
    assert_close(rotor.group[0].material.nu, 2.1e11 / 16.2e10 - 1, 1e-15, 0);
    assert_int_equal(rotor.nsegment, 3);
    assert_int_equal(rotor.segment[0].elements, 4);
    assert_close(rotor.segment[0].length, 0.4, 1e-14, 0);
    assert_true(rotor.segment[0].inner == 0.01 && rotor.segment[0].outer == 0.05);
    assert_int_equal(rotor.segment[1].elements, 4);
    assert_close(rotor.segment[1].length, 0.24, 1e-14, 0);
    assert_close(rotor.segment[2].length, 0.11, 1e-14, 0);
    assert_int_equal(rotor.ndisk, 1);
    assert_close(rotor.disk[0].position, 0.46, 1e-14, 0);
    assert_true(rotor.disk[0].mass == 12.5 && rotor.disk[0].diametral == 0.07 && rotor.disk[0].polar == 0.12);
    assert_int_equal(rotor.nspring, 2);
    assert_close(rotor.spring[0].lateral, 3e7 * 5e7 / 8e7, 1e-15, 0); /* in series with its support */
    assert_true(rotor.spring[1].lateral == 2e7);
    assert_close(rotor.spring[1].position, 0.75, 1e-14, 0);
    assert_close(rotor_mass(&rotor), 26.483071821495493, 1e-12, 0);
    assert_true(says("damping is left out") && says("kyy is not kxx") && says("1 masses on supports"));
    assert_int_equal(messages.count, 3);
}

static void rings_become_layers(void **state)
{
    struct rotor rotor;
    (void)state;
    assert_status(read_rotor(SAVED "rings.json", &rotor), ROTID_OK);
    assert_int_equal(rotor_axis_groups(&rotor), 4);
    assert_int_equal(rotor.ngroup, 5);
    assert_int_equal(rotor.nring, 1);
    assert_string_equal(rotor.group[4].name, "brass_cast");
    assert_int_equal(rotor.group[4].layer_of, 2);
    assert_int_equal(rotor.segment[rotor.ring[0].segment].elements, 2);
    assert_true(rotor.ring[0].outer == 0.16 && rotor.ring[0].inner == 0.07 && rotor.ring[0].group == 4);
    assert_close(rotor_mass(&rotor), 43.06596864346922, 1e-12, 0);
}

/* By the program: the deck is read and has the frequencies of ROSS. */
static void assert_frequencies(const char *saved, int count, const double *hz, double tolerance)
{
    struct pool pool;
    struct job job;
    struct spectrum s;
    const char *deck = folder_path("rotor.inp");
    (void)shell(&test_pool, ROTID_PROGRAM " import %s -o %s", saved, deck);
    pool_open(&pool, NULL);
    message_open(&messages, &pool);
    assert_status(deck_read(&pool, deck, 0, NULL, &messages, &job), ROTID_OK);
    assert_status(spectrum_compute(&pool, job.models, &job.rotor, 0, NULL, NULL, ROTID_GUYAN, count, &s), ROTID_OK);
    for (int j = 0; j < count; j++) /* among them the modes on the supports */
        assert_close(j < s.nrigid ? s.rigid_hz[j] : s.full_hz[j - s.nrigid], hz[j], tolerance, 0);
    pool_close(&pool);
}

static void the_deck_has_the_frequencies_of_ross(void **state)
{
    static const double support[] = {103.62002579714586, 379.5047531745164, 665.6634390763212,
                                     1409.011943012495,  1764.848221667097, 3232.6442038126784},
                        rings[] = {85.68415926741608,  334.27295665481864, 629.9866291886121,
                                   1439.9446927674765, 2563.4843190053466, 3279.9126767669654};
    (void)state;
    assert_frequencies(SAVED "support.json", 6, support, 1e-10);
    assert_frequencies(SAVED "rings.json", 6, rings,
                       1e-3); /* rings share one shear angle with their shaft, in ROSS each has its own */
}

/* ---- a small rotor, to be spoilt */

#define MATERIAL "\"material\": {\"name\": \"steel\", \"rho\": 7850, \"E\": 2.1e11, \"G_s\": 8.1e10}"
#define ELEMENT(NAME, N, L, A, B)                                                                                                \
    "\"ShaftElement_" NAME "\": {\"L\": " L ", \"idl\": 0, \"odl\": " A ", \"idr\": 0, \"odr\": " B ", " MATERIAL ", \"n\": " N  \
    "}"
#define ROTOR(PARTS)  "{\"ross_version\": \"2.3.0\", \"parameters\": {}, " PARTS "}"
#define TWO           ELEMENT("a", "0", "0.5", "0.1", "0.1") ", " ELEMENT("b", "1", "0.5", "0.1", "0.1")
#define DISK(N, M)    "\"DiskElement_d\": {\"n\": " N ", \"m\": " M ", \"Id\": 0.1, \"Ip\": 0.2, \"tag\": \"d\"}"
#define BEARING(N, K) "\"SealElement_s\": {\"n\": " N ", \"kxx\": " K ", \"kyy\": " K ", \"tag\": \"s\"}"

static void cones_become_cylinders(void **state)
{
    struct rotor rotor;
    (void)state;
    assert_status(read_rotor(folder_write("cone.json", ROTOR(ELEMENT("a", "0", "0.8", "0.10", "0.06"))), &rotor), ROTID_OK);
    assert_int_equal(rotor.nsegment, ROSS_CONE_STEPS);
    double volume = 0, exact = 3.14159265358979 / 12 * 0.8 * (0.01 + 0.006 + 0.0036);
    for (int s = 0; s < rotor.nsegment; s++)
        volume += 3.14159265358979 / 4 * rotor.segment[s].outer * rotor.segment[s].outer * rotor.segment[s].length;
    assert_close(volume, exact, 1e-3, 0);
    assert_true(rotor.segment[0].outer > rotor.segment[7].outer && says("1 conical elements"));
}

static void bearings_may_have_lists_and_other_classes(void **state)
{
    struct rotor rotor;
    (void)state;
    const char *path = folder_write("list.json", ROTOR(TWO ", " BEARING("2", "[3e6, 4e6]") ", " DISK("1", "0")));
    assert_status(read_rotor(path, &rotor), ROTID_OK);
    assert_true(rotor.nspring == 1 && rotor.spring[0].lateral == 3e6 && rotor.ndisk == 1);
    assert_true(says("SealElement_s: of bearings with values at several speeds the first one is taken"));
}

static void what_is_wrong_is_said_with_its_place(void **state)
{
    static const char *const wrong[][2] = {
        {"{\"a\": ]", "']' is no JSON"},
        {"[1]", "is no rotor of ROSS"},
        {"{\"a\": 1}", "is no rotor of ROSS"},
        {ROTOR("\"x\": 1"), "has no ShaftElement"},
        {ROTOR(ELEMENT("a", "0", "0", "0.1", "0.1")), "ShaftElement_a.L: is 0, expected a number above 0"},
        {ROTOR(ELEMENT("a", "0", "1e999", "0.1", "0.1")), "ShaftElement_a.L"},
        {ROTOR(ELEMENT("a", "0", "\"one\"", "0.1", "0.1")), "ShaftElement_a.L: is a text, expected a number"},
        {ROTOR(ELEMENT("a", "0", "1", "0", "0.1")), "ShaftElement_a.odl: is 0"},
        {ROTOR(ELEMENT("a", "-1", "1", "0.1", "0.1")), "ShaftElement_a.n: is -1, expected the number of a node"},
        {ROTOR(ELEMENT("a", "1e9", "1", "0.1", "0.1")), "ShaftElement_a.n: is 1e+09"},
        {ROTOR("\"ShaftElement_a\": {\"n\": 0}"), "ShaftElement_a.L"},
        {ROTOR(ELEMENT("a", "0", "1", "0.1", "0.1") ", " ELEMENT("c", "2", "1", "0.1", "0.1")), "leave a gap"},
        {ROTOR(ELEMENT("a", "0", "1", "0.1", "0.1") ", " ELEMENT("c", "0", "1", "0.2", "0.2")), "does not touch"},
        {ROTOR(ELEMENT("a", "0", "1", "0.1", "0.1") ", " ELEMENT("c", "0", "2", "0.2", "0.2")), "not as long"},
        {ROTOR(TWO ", " DISK("7", "1")), "d at node 7: it stands at no node of the shaft"},
        {ROTOR(TWO ", " DISK("1", "-1")), "DiskElement_d.m: is -1, expected a number not below 0"},
        {ROTOR(TWO ", " BEARING("1", "-5")), "SealElement_s: has kxx -5"},
        {ROTOR(TWO ", \"GearBox_g\": {\"n\": 1}"), "GearBox_g: is no part that rotid knows"}};
    struct rotor rotor;
    (void)state;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        int status = read_rotor(folder_write("wrong.json", wrong[i][0]), &rotor);
        if (status != ROTID_ERROR_SYNTAX || !says(wrong[i][1]))
            fail_msg("%zu: status %d, %s", i, status, messages.count ? messages.item[0].text : "nothing is said");
    }
    assert_status(read_rotor(folder_path("absent.json"), &rotor), ROTID_ERROR_IO);
}

static void the_command_writes_a_deck_or_nothing(void **state)
{
    const char *output, *deck = folder_path("out.inp"),
                        *bad = folder_write("bad.json", ROTOR(ELEMENT("a", "0", "0", "0.1", "0.1")));
    (void)state;
    assert_int_equal(shell_code(&test_pool, &output, ROTID_PROGRAM " import %s -o %s", bad, deck), 2);
    assert_null(file_bytes(deck, NULL));
    assert_int_equal(shell_code(&test_pool, &output, ROTID_PROGRAM " import %s", SAVED "rings.json"), 2);
    assert_non_null(strstr(output, "expected -o FILE"));
    assert_int_equal(shell_code(&test_pool, &output, ROTID_PROGRAM " import %s -o %s", SAVED "rings.json", SAVED "rings.json"),
                     2);
    assert_int_equal(shell_code(&test_pool, &output, ROTID_PROGRAM " import %s -o %s", SAVED "rings.json", deck), 0);
    assert_non_null(strstr(output, "5 groups, 1 disks, 2 springs"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(shafts_disks_and_bearings_become_a_rotor, open_test_pool, close_test_pool),
        cmocka_unit_test_setup_teardown(rings_become_layers, open_test_pool, close_test_pool),
        cmocka_unit_test_setup_teardown(the_deck_has_the_frequencies_of_ross, open_test_pool, close_test_pool),
        cmocka_unit_test_setup_teardown(cones_become_cylinders, open_test_pool, close_test_pool),
        cmocka_unit_test_setup_teardown(bearings_may_have_lists_and_other_classes, open_test_pool, close_test_pool),
        cmocka_unit_test_setup_teardown(what_is_wrong_is_said_with_its_place, open_test_pool, close_test_pool),
        cmocka_unit_test_setup_teardown(the_command_writes_a_deck_or_nothing, open_test_pool, close_test_pool)};
    return cmocka_run_group_tests(tests, folder_make, folder_remove);
}
