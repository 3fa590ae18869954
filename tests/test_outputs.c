/* Where outputs go: not over what is read, not in the place of a link to a descriptor, not into a file that has the number of a
 * closed standard stream. Decks that name more than a rotor has end with a message. */
#include "json_value.h"
#include "shell.h"
#include "support.h"

#define ROTID "cd %s && " ROTID_PROGRAM " "
#define INPUT ROTID_SOURCE_DIR "/input"

static char folder[] = "/tmp/test_outputs_XXXXXX";

/* A deck that includes another one and names measured data; a plan of it. */
static int setup(void **state)
{
    struct pool pool;
    (void)state;
    if (!mkdtemp(folder))
        return -1;
    pool_open(&pool, NULL);
    (void)shell(&pool,
                "cd %s && mkdir data && cp " INPUT "/data/converged_steel.uff data/ && cp " INPUT "/solid_steel.inp part.inp && "
                "printf '*INCLUDE, FILE=part.inp\\n*IDENTIFY\\ncore.E, 1e9, 1e12, 2e11\\n' > deck.inp && printf "
                "'*STUDY\\n*DECKS\\ndeck.inp\\n' > runs.plan && "
                "cp part.inp kept.inp && cp data/converged_steel.uff kept.uff",
                folder);
    pool_close(&pool);
    return 0;
}

static int teardown(void **state)
{
    struct pool pool;
    (void)state;
    pool_open(&pool, NULL);
    (void)shell(&pool, "rm -r %s", folder);
    pool_close(&pool);
    return 0;
}

static void refuses(const char *command)
{
    const char *output;
    assert_int_equal(shell_code(&test_pool, &output, ROTID "%s 2>&1", folder, command), 2);
    if (!strstr(output, "is read"))
        fail_msg("rotid %s says:\n%s", command, output);
    (void)shell(&test_pool, "cd %s && cmp part.inp kept.inp && cmp data/converged_steel.uff kept.uff", folder);
}

POOL_TEST(what_a_deck_names_is_not_written)
{
    refuses("check deck.inp --json part.inp");
    refuses("check deck.inp --json ./data/../data/converged_steel.uff");
    refuses("diagnose deck.inp --extended part.inp");
    refuses("frf deck.inp --set FRF.LINES=9 -o data/converged_steel.uff");
    refuses("frf deck.inp --set FRF.FILE=kept.uff -o kept.uff");
    refuses("study runs.plan -o runs.jsonl --json data/converged_steel.uff");
    refuses("study runs.plan -o runs.jsonl --json part.inp");
    refuses("study deck.inp -o runs.jsonl --json part.inp");
    (void)shell(&test_pool, "cd %s && sed s/part/m.mass.mtx/ deck.inp | sed s/mtx.inp/mtx/ > m.inp && cp part.inp m.mass.mtx",
                folder);
    refuses("export m.inp --format matrix-market -o m");
    (void)shell(&test_pool, "cd %s && cmp part.inp m.mass.mtx && test ! -e runs.jsonl && test ! -e m.stiffness.mtx", folder);
    (void)shell(&test_pool, ROTID "check deck.inp --quiet --json other.json", folder);
}

/* As /dev/stdout is one; not by that name, which root would lose where this fails. */
POOL_TEST(a_link_to_a_descriptor_stays)
{
    const char *output;
    (void)shell(&test_pool, "cd %s && ln -s /proc/self/fd/1 out && ln -s /proc/self/fd/5 five && ln -s /proc/self/fd/0 in",
                folder);
    (void)shell(&test_pool, ROTID "check deck.inp --quiet --json expected.json", folder);
    (void)shell(&test_pool, ROTID "check deck.inp --quiet --json out > got && test -L out && cmp got expected.json", folder);
    (void)shell(&test_pool, ROTID "check deck.inp --quiet --json five 5> got && test -L five && cmp got expected.json", folder);
    (void)shell(&test_pool, ROTID "check deck.inp --quiet --json /dev/fd/5 5> got && cmp got expected.json", folder);
    (void)shell(&test_pool, ROTID "check deck.inp --quiet --json out | cmp - expected.json", folder);
    /* the table first, all of both */
    (void)shell(&test_pool,
                ROTID "check deck.inp > table && " ROTID_PROGRAM " check deck.inp --json out > got && "
                      "cat table expected.json | cmp - got",
                folder);
    assert_int_equal(shell_code(&test_pool, &output, ROTID "check deck.inp --quiet --json in 2>&1 < kept.inp && false", folder),
                     3);
    assert_non_null(strstr(output, "cannot write in: Bad file descriptor"));
    (void)shell(&test_pool, "cd %s && test -L in && cmp part.inp kept.inp", folder);
}

/* A file that is opened would have the number of the closed stream, and get what is said there. */
POOL_TEST(closed_streams_are_no_files)
{
    const char *output;
    (void)shell(&test_pool,
                "cd %s && sed 's/=0.01//' " INPUT "/paper_study.plan | sed 's|^paper_rotor|" INPUT "/paper_rotor|' > many.plan",
                folder);
    /* ends by SIGTERM, after it has begun, and says so */
    (void)shell_code(&test_pool, &output,
                     "cd %s && { " ROTID_PROGRAM " study many.plan -o many.jsonl --threads 1 0<&- >&- 2>&- & } && "
                     "while test $(cat many.jsonl 2>/dev/null | wc -l) -lt 2; do sleep 0.05; done; kill -TERM $!; wait $!",
                     folder);
    (void)shell(&test_pool, "cd %s && ! grep -q '^rotid' many.jsonl", folder);
    (void)shell_code(&test_pool, NULL, ROTID "study --summary many.jsonl > table", folder); /* 1: unfinished */
    (void)shell(&test_pool, "cd %s && grep -q 'of 280 runs' table", folder);
    assert_int_equal(shell_code(&test_pool, NULL, ROTID "check deck.inp --json closed.json >&-", folder), 3);
    (void)shell(&test_pool, "cd %s && cmp closed.json expected.json", folder);
}

POOL_TEST(options_follow_the_file_for_posix_as_well)
{
    (void)shell(&test_pool,
                "cd %s && POSIXLY_CORRECT=1 " ROTID_PROGRAM
                " check deck.inp --quiet --json posix.json && cmp posix.json expected.json",
                folder);
}

/* Few masters have fewer modes than are listed. */
POOL_TEST(exported_files_hold_numbers)
{
    (void)shell(&test_pool,
                ROTID "export " INPUT "/brake_reuss_beam.inp --format matrix-market -o few --quiet && ! grep -i nan few.*",
                folder);
}

/* A free bar with six elements where noise asks for more, and frequencies that several causes explain. */
POOL_TEST(a_diagnosis_says_that_it_refines_the_mesh_and_what_chance_does)
{
    (void)shell(
        &test_pool,
        "cd %s && printf '*MATERIAL, NAME=m\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=s, MATERIAL=m\n1.2, 0.05, "
        "0, 6\n*MODES\n1, 159.0\n2, 435.1\n3, 845.1\n4, 1379\n5, 2025\n6, 2770\n*NOISE, FREQUENCY=0.001\n*IDENTIFY\ns.E, "
        "1e10, 4e11, 2e11\n' > coarse.inp",
        folder);
    const char *said = shell(&test_pool, ROTID "diagnose coarse.inp --extended fine.inp 2>&1", folder);
    assert_non_null(strstr(said, "rotid: fine.inp: the mesh is refined: "));
    assert_non_null(strstr(said, " elements in place of 6, as the noise asks for\n"));
    assert_non_null(strstr(said, "VERDICT  AMBIGUOUS"));
    const char *words = shell(&test_pool, "tr -s ' \n' '  ' < %s/fine.inp", folder);
    assert_non_null(strstr(words, "The probability that nothing is wrong and chance did this is "));
    (void)shell(&test_pool, ROTID "check fine.inp", folder);
    said = shell(&test_pool, ROTID "diagnose fine.inp --extended again.inp 2>&1", folder);
    assert_null(strstr(said, "again.inp: the mesh is refined")); /* which the heading of fine.inp says of that one */
    said = shell(&test_pool, ROTID "diagnose " INPUT "/paper_rotor.inp --quiet --extended same.inp 2>&1; true", folder);
    assert_null(strstr(said, "refined")); /* --quiet */
}

/* Mode 4 of four elements is no mode of eight: no error of the mesh can be stated. */
POOL_TEST(the_schema_allows_what_is_not_known_of_a_mode)
{
    (void)shell(&test_pool,
                "cd %s && printf '*MATERIAL, NAME=m\n*ELASTIC, TYPE=SHEAR\n4e10, 1.5e10, 0.28\n*DENSITY\n7650\n*SHAFT, NAME=s, "
                "MATERIAL=m\n0.375, 0.11, 0.065, 4\n' > coarse.inp && " ROTID_PROGRAM
                " modes coarse.inp --quiet --json coarse.json",
                folder);
    cJSON *result = cJSON_Parse(shell(&test_pool, "cat %s/coarse.json", folder));
    cJSON *schema = cJSON_Parse(shell(&test_pool, "cat " ROTID_SOURCE_DIR "/docs/schema/modes.schema.json"));
    const cJSON *mode, *value, *allowed = get(get(get(schema, "$defs"), "model_mode"), "properties");
    int unknown = 0;
    cJSON_ArrayForEach(mode, get(result, "modes")) cJSON_ArrayForEach(value, mode) if (cJSON_IsNull(value))
    {
        const cJSON *type = get(get(allowed, value->string), "type");
        if (!cJSON_IsArray(type) || strcmp(cJSON_GetArrayItem(type, 1)->valuestring, "null"))
            fail_msg("%s is null", value->string);
        unknown += !strcmp(value->string, "mesh_error_percent");
    }
    assert_true(unknown > 0);
    cJSON_Delete(schema);
    cJSON_Delete(result);
}

/* Its two rigid motions were taken for elastic modes 1 and 2 at 0 Hz where the compression was too small for the factors to
 * notice. */
POOL_TEST(compression_that_turns_a_free_rotor_over_is_refused)
{
    static const char *const model[] = {"BEAM", "SOLID"};
    for (int i = 0; i < 4; i++) {
        const char *output;
        (void)shell(&test_pool,
                    "cd %s && printf '*MATERIAL, NAME=m\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=s, "
                    "MATERIAL=m\n0.25, 0.015, 0, "
                    "8\n*DISK\nstart, 7.5, 0.063, 0.008\n*PRELOAD, GROUP=s\n%d\n*FIT, MODEL=%s\n' > over.inp",
                    folder, i < 2 ? -122 : 122, model[i % 2]);
        assert_int_equal(shell_code(&test_pool, &output, ROTID "modes over.inp 2>&1", folder), i < 2 ? 2 : 0);
        assert_true(i >= 2 || strstr(output, "over.inp:6:1: the stiffness matrix is not positive semidefinite"));
    }
}

POOL_TEST(an_export_says_how_large_its_files_are)
{
    const char *said = shell(&test_pool, ROTID "export " INPUT "/brake_reuss_beam.inp --format matrix-market -o size", folder);
    const char *bytes = shell(&test_pool, "cd %s && wc -c < size.mass.mtx", folder), *line = strstr(said, "size.mass.mtx, ");
    assert_non_null(line);
    assert_close(strtod(line + strlen("size.mass.mtx, "), NULL), strtod(bytes, NULL) / 1e6, 6e-3, 0); /* three digits, MB */
}

static void write_cards(const char *name, int cards, const char *head, int lines)
{
    char path[128];
    (void)snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *stream = fopen(path, "w");
    assert_non_null(stream);
    (void)fputs("*MATERIAL, NAME=m\n*ELASTIC\n2e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=s, MATERIAL=m\n1, 0.1, 0, 20\n", stream);
    for (int c = 0; c < cards; c++) {
        (void)fprintf(stream, head, c);
        for (int i = 0; i < lines; i++)
            (void)fprintf(stream, "%d, %.7f\n", c * lines + i + 1, 1 - (c * lines + i) / (double)(cards * lines));
    }
    assert_int_equal(fclose(stream), 0);
}

POOL_TEST(more_than_a_rotor_has_is_refused)
{
    const char *output;
    write_cards("sensors.inp", 30, "*SENSORS\n** %d\n", 10000); /* each with each would take minutes */
    assert_int_equal(
        shell_code(&test_pool, &output, "cd %s && timeout -s KILL 60 " ROTID_PROGRAM " check sensors.inp 2>&1", folder), 2);
    assert_non_null(strstr(output, "more than 10000 sensors, expected fewer"));
    write_cards("bars.inp", 300, "*BARS, NAME=b%d, MATERIAL=m, CENTER=0.5, LENGTH=0.1\n8, 0.001, 0.01, 1000\n", 0);
    assert_int_equal(shell_code(&test_pool, &output, "cd %s && timeout -s KILL 60 " ROTID_PROGRAM " check bars.inp 2>&1", folder),
                     2);
    assert_non_null(
        strstr(output, "bars.inp:26:1: shaft, rods and bars up to these have 10020 elements, expected at most 10000"));
}

TEST_GROUP(setup, teardown);
