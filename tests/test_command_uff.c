/* rotid uff as its users see it: the listing, the doubtful places, refusals. */
#include <cJSON.h>
#include <unistd.h>

#include "support.h"
#include "uff_program.h"

UNIT_TEST(a_listing_begins_with_what_there_is)
{
    make_sound("sound.uff");
    says("sound.uff", 0, "3 transfer functions, 641 lines each, 0 to 320 Hz, responses 1 to 3, reference 1");
    assert_non_null(strstr(uff_output, "1 shape, real, 72.125 to 72.125 Hz, 3 points"));
    assert_non_null(strstr(uff_output, "3 nodes, x 0 to 0, y 0 to 0, z 0.25 to 0.75 m"));
    assert_non_null(strstr(uff_output, "1:+X ... 3:+X / 1:-Z"));
    assert_non_null(strstr(uff_output, "sets 999 are not known"));
    assert_null(strstr(uff_output, "2:+X /")); /* one row for all three */
    says("sound.uff --verbose", 0, "2:+X / 1:-Z");
    says("sound.uff --quiet", 0, "");
    assert_int_equal(strlen(uff_output), 0);
}

/* Kinds of the doubtful places of a file, as ",kind,kind,". */
static void doubts_are(const char *name, const char *expected)
{
    char arguments[256], kinds[1024] = ",";
    (void)snprintf(arguments, sizeof arguments, "%s --json -", name);
    (void)run(arguments);
    cJSON *json = cJSON_Parse(uff_output);
    assert_non_null(json);
    const cJSON *doubt;
    cJSON_ArrayForEach(doubt, cJSON_GetObjectItem(json, "doubtful"))
    {
        const char *kind = cJSON_GetStringValue(cJSON_GetObjectItem(doubt, "kind"));
        (void)snprintf(kinds + strlen(kinds), sizeof kinds - strlen(kinds), "%s,", kind);
    }
    cJSON_Delete(json);
    assert_string_equal(kinds, expected);
}

/* A record of 33 levels, longer than what is read at a time, and one of a thousand. */
UNIT_TEST(records_of_few_levels_are_doubtful)
{
    struct uff_function f = function(UFF_TIME, 1, 9000);
    FILE *stream = create("coarse.uff");
    assert_status(uff_write_units(stream, &uff_si), ROTID_OK);
    put_nodes(stream, 2);
    for (int levels = 32; levels <= 1000; levels += 968) {
        struct uff_function_writer writer;
        f.response_node = levels == 32 ? 1 : 2;
        assert_status(uff_write_function(stream, &f, &writer), ROTID_OK);
        for (int i = 0; i < 9000; i++) {
            double x = i, value = round(levels / 2. * sin(0.9 * i)) / levels;
            assert_status(uff_write_values(&writer, 1, &x, &value, NULL), ROTID_OK);
        }
        assert_status(uff_end_function(&writer), ROTID_OK);
    }
    assert_int_equal(fclose(stream), 0);
    doubts_are("coarse.uff", ",coarse,");
    says("coarse.uff", 0, "coarse, 33 levels, expected 256 or more");
}

UNIT_TEST(doubtful_places_are_found)
{
    FILE *stream = create("doubt.uff");
    assert_status(uff_write_units(stream, &uff_si), ROTID_OK);
    put_nodes(stream, 4);
    const struct uff_node again = {.id = 2, .x = {0, 0, 7}};
    assert_status(uff_write_nodes(stream, 15, 1, &again), ROTID_OK);
    struct uff_function f = function(UFF_TIME, 1, 200);
    put_function(stream, &f, 1, INFINITY);
    f.response_node = 3;
    put_function(stream, &f, 0, INFINITY); /* dead */
    f.response_node = 4;
    put_function(stream, &f, 10, 2); /* clipped */
    f.response_node = 1;
    f.response_direction = 2;
    put_function(stream, &f, 1, INFINITY); /* the first once more */
    f.response_node = 9;                   /* without coordinates */
    f.count = 100;
    (void)strcpy(f.numerator.unit, "g");
    put_function(stream, &f, 1, INFINITY);
    f = function(UFF_COHERENCE, 1, 50);
    f.numerator = (struct uff_axis){0};
    put_function(stream, &f, 1.5, INFINITY);
    f.is_even = 0;
    f.step = 0;
    f.response_node = 3;
    put_function(stream, &f, 0.5, INFINITY);
    assert_int_equal(fclose(stream), 0);
    doubts_are("doubt.uff", ",node_twice,no_coordinates,dead,clipped,unit,coherence,uneven,identical,length,");
    says("doubt.uff", 0, "coherence goes up to 1.4");
    assert_non_null(strstr(uff_output, "functions 1 and 4 have the same values, all 200 of them"));
    assert_non_null(strstr(uff_output, "unit text 'g', which is 9.80665 m/s2, where set 164 says 1"));

    stream = create("bare.uff");
    f = function(UFF_TRANSFER, 1, 20);
    put_function(stream, &f, 1, INFINITY);
    f.response_node = 2;
    f.step = 0.25;
    put_function(stream, &f, 1, INFINITY);
    f.step = -0.5;
    f.response_node = 3;
    put_function(stream, &f, 1, INFINITY);
    assert_int_equal(fclose(stream), 0);
    doubts_are("bare.uff", ",no_units,no_coordinates,abscissa_order,resolution,resolution,");
    make_sound("sound.uff");
    doubts_are("sound.uff", ",unknown_set,");
}

UNIT_TEST(a_long_table_is_cut)
{
    FILE *stream = create("long.uff");
    for (int i = 0; i < 90; i++) { /* no two neighbours alike */
        struct uff_function f = function(i % 2 ? UFF_TRANSFER : UFF_COHERENCE, i, 3);
        put_function(stream, &f, 0.5, INFINITY);
    }
    assert_int_equal(fclose(stream), 0);
    says("long.uff", 0, "... and 50 more sets; --verbose shows each");
    says("long.uff --verbose", 0, "89:+X / 1:-Z");
    assert_null(strstr(uff_output, "more sets"));
}

/* Sets of geometry that rotid uses nothing of are named and read over, whatever they hold. */
UNIT_TEST(sets_that_are_not_used_are_read_over)
{
    static const int sets[] = {18, 82, 2412, 2414, 2420};
    FILE *stream = create("over.uff");
    for (int i = 0; i < 5; i++)
        (void)fprintf(stream, "    -1\n%6d\nno numbers at all\n    -1\n", sets[i]);
    assert_status(uff_write_units(stream, &uff_si), ROTID_OK);
    assert_int_equal(fclose(stream), 0);
    doubts_are("over.uff", ",");
    says("over.uff", 0, "read over");
    assert_non_null(strstr(uff_output, "elements  "));
    assert_int_equal(run("over.uff --json -"), 0);
    cJSON *json = cJSON_Parse(uff_output);
    for (int i = 0; i < 6; i++) {
        const cJSON *set = cJSON_GetArrayItem(cJSON_GetObjectItem(json, "sets"), i);
        assert_string_equal(cJSON_GetObjectItem(set, "state")->valuestring, i < 5 ? "read_over" : "read");
    }
    cJSON_Delete(json);
}

UNIT_TEST(wrong_usage_is_told)
{
    make_sound("sound.uff");
    says("", 2, "uff: no file given");
    says("missing.uff", 2, "missing.uff:1:1: cannot be opened");
    says("sound.uff -o out.uff", 2, "is no option of uff");
    says("sound.uff --json sound.uff", 2, "is the file that is read");
    says("sound.uff --extended out.inp", 2, "--extended is no option of uff, but of diagnose suggest");
    assert_false(is_there("out.uff"));
    FILE *stream = create("notes.txt");
    (void)fputs("no universal file at all\n", stream);
    assert_int_equal(fclose(stream), 0);
    says("notes.txt", 2, "no universal file");
}

UNIT_TEST(a_truncated_file_is_listed_and_has_no_tables)
{
    make_sound("cut.uff");
    assert_int_equal(truncate(path_of("cut.uff"), 60000), 0);
    says("cut.uff", 1, "2 transfer functions");
    assert_non_null(strstr(uff_output, "MALFORMED"));
    says("cut.uff --csv out", 2, "out is not written");
    assert_int_equal(count_files("out"), 0);
}

/* The first mode bends in y, the second one in z, with a tenth of it in the other plane: one table cannot have both. */
UNIT_TEST(modes_of_two_planes_are_warned_of)
{
    FILE *stream = create("planes.uff");
    for (int k = 0; k < 2; k++) {
        (void)fprintf(stream, "    -1\n    55\nmode\nNONE\nNONE\nNONE\nNONE\n%10d%10d%10d%10d%10d%10d\n%10d%10d%10d%10d\n", 1, 2,
                      2, 8, 2, 3, 2, 4, 1, k + 1);
        (void)fprintf(stream, "%13.5e%13.5e%13.5e%13.5e\n", 100. + 150 * k, 1., 0.01, 0.);
        for (int n = 1; n <= 3; n++)
            (void)fprintf(stream, "%10d\n%13.5e%13.5e%13.5e\n", n, 0., k ? 0.1 : n - 2.5, k ? n - 2.5 : 0.2);
        (void)fputs("    -1\n", stream);
    }
    assert_int_equal(fclose(stream), 0);
    says("planes.uff --csv out", 0, "mode 1 moves most along y, written is what it moves along z");
    assert_null(strstr(uff_output, "mode 2 moves most"));
}

UNIT_TEST(a_full_disk_is_told)
{
    make_sound("sound.uff");
    says("sound.uff 3>&1 > /dev/full 2>&3 #", 3, "cannot write to standard output");
    says("sound.uff --quiet --json /dev/full", 3, "cannot write /dev/full");
}

TEST_GROUP(make_directory, remove_directory);
