/* What `rotid report` makes of files that are no result, or a broken one: the place and what was expected, and no folder. */
#include <errno.h>

#include <cJSON.h>

#include "page/page.h"
#include "page_bench.h"
#include "result/result.h"
#include "support.h"

#define PAPER ROTID_SOURCE_DIR "/input/paper_rotor.inp"
#define SOLID ROTID_SOURCE_DIR "/input/solid_rotor.inp"
#define STRIP ROTID_SOURCE_DIR "/input/strip_states.inp"
#define LAP   ROTID_SOURCE_DIR "/input/brake_reuss_lap.inp"

static void make_results(void)
{
    if (page_exists("identify.json"))
        return;
    assert_int_equal(
        page_run("cd %s; %s identify %s --quiet --json identify.json; [ $? = 1 ] && %s sensitivity %s --quiet --json "
                 "sensitivity.json && "
                 "%s frf %s --quiet --set FRF.LINES=40 --json frf.json && %s modes %s --quiet --json modes.json && "
                 "%s identify %s --quiet --json states.json && %s modes %s --quiet --json states_modes.json && "
                 "%s diagnose %s --quiet --json diagnose.json && %s study %s %s -o runs.jsonl --quiet --json "
                 "study.json",
                 page_path(""), ROTID_PROGRAM, SOLID, ROTID_PROGRAM, PAPER, ROTID_PROGRAM, PAPER, ROTID_PROGRAM, PAPER,
                 ROTID_PROGRAM, STRIP, ROTID_PROGRAM, STRIP, ROTID_PROGRAM, LAP, ROTID_PROGRAM, SOLID, PAPER),
        0);
}

UNIT_TEST(files_that_are_no_result_are_refused_with_their_place)
{
    static const struct {
        const char *text, *says;
    } wrong[] = {
        {"", "is empty, expected JSON"},
        {" \n\t ", "is empty"},
        {"{\"a\": [1, 2", ":1:11: the file ends within a value"},
        {"{\"a\": 1,\n \"b\": NaN}", ":2:7: 'NaN' is no JSON"},
        {"{\"a\": 1,\n \"b\": -Infinity}", ":2:7: '-Infinity' is no JSON"},
        {"{\"a\": 1} x", ":1:10: 'x' is no JSON"},
        {"{\"a\": 1}{\"b\": 2}", ":1:9: '{\"b\":' is no JSON"},
        {"\x7f"
         "ELF\x01\x02",
         ":1:1: byte 127 is no JSON"},
        {"*HEADING\nA deck\n", ":1:1: '*HEADING' is no JSON"},
        {"[1, 2, 3]", "is no result of rotid, expected what a command writes with --json"},
        {"\"rotid\"", "is no result of rotid"},
        {"null", "is no result of rotid"},
        {"{\"name\": \"other\", \"version\": 2}", "is no result of rotid"},
        {"{\"rotid\": \"0.2.0\", \"command\": \"identify\"}", "schema: is missing"},
        {"{\"rotid\": \"0.2.0\", \"command\": \"identify\", \"schema\": 2}", "schema: is 2, expected 1"},
        {"{\"rotid\": \"0.2.0\", \"command\": \"identify\", \"schema\": \"1\"}", "schema: is a text, expected a number"},
        {"{\"rotid\": \"0.2.0\", \"command\": \"uff\", \"schema\": 1}",
         "command: is 'uff', of which no page is made, expected check, modes, identify, diagnose, suggest, sensitivity, speeds, "
         "frf, ema "
         "or study"},
        {"{\"rotid\": \"0.2.0\", \"command\": 7, \"schema\": 1}", "command: is a number, expected a text"},
        {"{\"rotid\": \"0.2.0\", \"command\": \"modes\", \"schema\": 1}", "modes: is missing"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        page_write_file("wrong.json", wrong[i].text);
        int code = page_run("%s report %s -o %s", ROTID_PROGRAM, page_path("wrong.json"), page_path("page"));
        if (code != 2 || *page_out || !strstr(page_err, wrong[i].says) || !strstr(page_err, "wrong.json"))
            print_error("'%s': exit code %d, '%s', '%s'\n", wrong[i].text, code, page_out, page_err);
        assert_true(code == 2 && !*page_out && strstr(page_err, wrong[i].says) && strstr(page_err, "wrong.json"));
        assert_false(page_exists("page"));
    }
    assert_int_equal(page_run("%s report %s -o %s", ROTID_PROGRAM, page_path(""), page_path("page")), 2);
    assert_non_null(strstr(page_err, "is a folder, expected a file of JSON"));
    assert_int_equal(page_run("%s report /nowhere/x.json -o %s", ROTID_PROGRAM, page_path("page")), 2);
    assert_non_null(strstr(page_err, "/nowhere/x.json: No such file or directory"));
    assert_int_equal(page_run("%s report /dev/null -o %s", ROTID_PROGRAM, page_path("page")), 2);
    assert_non_null(strstr(page_err, "is no regular file"));
    /* larger than any result: sparse, so that it takes no room */
    assert_int_equal(page_run("truncate -s 65M %s", page_path("huge.json")), 0);
    assert_int_equal(page_run("%s report %s -o %s", ROTID_PROGRAM, page_path("huge.json"), page_path("page")), 2);
    assert_non_null(strstr(page_err, "is larger than 64 MiB"));
    assert_int_equal(page_run("rm %s", page_path("huge.json")), 0);
    /* two bytes a value: the tree of these 20 MB would take 800 MB */
    assert_int_equal(page_run("yes 1, | head -c 20000000 | sed '1s/^/[/' > %s", page_path("dense.json")), 0);
    assert_int_equal(page_run("%s report %s -o %s", ROTID_PROGRAM, page_path("dense.json"), page_path("page")), 2);
    assert_non_null(strstr(page_err, "the values up to here would take more memory than 10 times the size of the file"));
    assert_int_equal(page_run("rm %s", page_path("dense.json")), 0);
    /* nested beyond measure, which must not exhaust the stack */
    assert_int_equal(page_run("head -c 200000 /dev/zero | tr '\\0' '[' > %s", page_path("deep.json")), 0);
    assert_int_equal(page_run("%s report %s -o %s", ROTID_PROGRAM, page_path("deep.json"), page_path("page")), 2);
    assert_false(page_exists("page"));
}

UNIT_TEST(all_files_are_judged_and_one_bad_one_is_enough)
{
    make_results();
    page_write_file("wrong.json", "{\"rotid\": \"0.2.0\", \"command\": \"modes\", \"schema\": 1, \"modes\": {\"a\": 1}}");
    assert_int_equal(page_run("%s report %s %s /nowhere/x.json -o %s", ROTID_PROGRAM, page_path("identify.json"),
                              page_path("wrong.json"), page_path("page")),
                     2);
    assert_non_null(strstr(page_err, "wrong.json: modes: is an object, expected a list"));
    assert_non_null(strstr(page_err, "/nowhere/x.json: No such file"));
    assert_false(page_exists("page"));
}

/* ------------------------------------------------------------------------------------------------ every key, wrong in every way
 */

static int try_it(const cJSON *root)
{
    int wrong;
    char *text = cJSON_PrintUnformatted(root);
    assert_non_null(text);
    page_write_file("mutant.json", text);
    cJSON_free(text);
    int status = page_composed("mutant.json", NULL, &wrong);
    assert_true(status == ROTID_OK ? !wrong : status == ROTID_ERROR_SYNTAX && wrong > 0);
    return status != ROTID_OK;
}

/* Swaps what two items hold, links left alone. */
static void swap_value(cJSON *a, cJSON *b)
{
    cJSON held = *a;
    a->type = b->type;
    a->child = b->child;
    a->valuestring = b->valuestring;
    a->valueint = b->valueint;
    a->valuedouble = b->valuedouble;
    b->type = held.type;
    b->child = held.child;
    b->valuestring = held.valuestring;
    b->valueint = held.valueint;
    b->valuedouble = held.valuedouble;
}

static int mutants, refused;

/* In the place of this item: null, a text, a flag, numbers, a list, an object. */
static void replace_in_turn(const cJSON *root, cJSON *item)
{
    cJSON *other[] = {cJSON_CreateNull(),     cJSON_CreateString("'\n\"<x>"), cJSON_CreateTrue(),
                      cJSON_CreateNumber(-1), cJSON_CreateNumber(0),          cJSON_CreateNumber(1e308),
                      cJSON_CreateArray(),    cJSON_CreateObject(),           cJSON_CreateNumber(2.5)};
    for (size_t i = 0; i < sizeof other / sizeof *other; i++) {
        swap_value(item, other[i]);
        refused += try_it(root);
        mutants++;
        swap_value(item, other[i]);
        cJSON_Delete(other[i]);
    }
}

/* Of a diagnosis what an identification has as well. */
static int is_covered(const cJSON *root, const cJSON *item)
{
    static const char *const names[] = {"geometry", "today", "base", "extended"};
    for (size_t i = 0; cJSON_HasObjectItem(root, "verdict") && item->string && i < sizeof names / sizeof *names; i++)
        if (!strcmp(item->string, names[i]))
            return 1;
    return 0;
}

static void mutate(const cJSON *root, cJSON *at, int depth)
{
    int index = 0;
    for (cJSON *item = at->child; item; item = item->next, index++) {
        if (cJSON_IsArray(at) && index > 0) /* elements of a list are alike */
            return;
        replace_in_turn(root, item);
        if (item->child && depth < 8 && !(depth == 0 && is_covered(root, item)))
            mutate(root, item, depth + 1);
        if (!cJSON_IsObject(at))
            continue;
        char *key = item->string; /* a key that nobody asks for: as if it were missing */
        item->string = (char *)"another";
        refused += try_it(root);
        mutants++;
        item->string = key;
    }
}

/* Long lists are cut: what is judged by element is judged by few. */
static void shorten(cJSON *at)
{
    for (cJSON *item = at->child; item; item = item->next) {
        while (cJSON_IsArray(item) && cJSON_GetArraySize(item) > 3)
            cJSON_DeleteItemFromArray(item, 3);
        shorten(item);
    }
}

UNIT_TEST(every_value_that_is_wrong_is_refused_or_does_no_harm)
{
    static const char *const names[] = {"identify.json", "sensitivity.json", "frf.json",    "modes.json",
                                        "diagnose.json", "study.json",       "states.json", "states_modes.json"};
    make_results();
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        cJSON *json = cJSON_Parse(page_read(names[i]));
        assert_non_null(json);
        shorten(json);
        mutants = refused = 0;
        mutate(json, json, 0);
        print_message("%s: %d mutants, %d refused\n", names[i], mutants, refused);
        assert_true(mutants > 200 && refused > mutants / 2);
        cJSON_Delete(json);
    }
}

/* What stands at the end of a path of keys; through lists their first element. */
static cJSON *item_at(cJSON *at, const char *path)
{
    char copy[64], *rest = copy, *key;
    (void)snprintf(copy, sizeof copy, "%s", path);
    while ((key = strtok_r(rest, "/.", &rest))) {
        at = cJSON_GetObjectItem(cJSON_IsArray(at) ? at->child : at, key);
        assert_non_null(at);
    }
    return at;
}

/* A number that is not known is NaN; nothing stands for a text or a flag that is not. */
UNIT_TEST(null_stands_for_numbers_alone)
{
    static const struct {
        const char *path, *says;
    } nulls[] = {{"/functional", "functional: is null, expected a value"},
                 {"/modes.holdout", "modes[0].holdout: is null, expected a value"},
                 {"/modes.error_percent", NULL}};
    make_results();
    for (size_t i = 0; i < sizeof nulls / sizeof *nulls; i++) {
        cJSON *json = page_json("identify.json"), *null = cJSON_CreateNull();
        swap_value(item_at(json, nulls[i].path), null);
        page_write_json("wrong.json", json);
        cJSON_Delete(null);
        cJSON_Delete(json);
        int code = page_run("%s report %s -o %s", ROTID_PROGRAM, page_path("wrong.json"), page_path("nulls"));
        assert_true(nulls[i].says ? code == 2 && strstr(page_err, nulls[i].says) : code < 2);
    }
}

/* What no single value is wrong in. */
UNIT_TEST(a_result_that_contradicts_itself_is_refused)
{
    static const struct {
        const char *file, *list; /* of which the last value is taken away, in the first element */
        const char *says;
    } wrong[] = {
        {"identify.json", "history.x", "history[0].x: has 1 values, expected 2 as parameters"},
        {"identify.json", "baseline.predicted_hz", "baseline[0].predicted_hz: has "},
        {"identify.json", "shapes/modes.predicted", "shapes.modes[0].predicted: has "},
        {"identify.json", "shapes/modes.predicted_axis", "as axis_z_m"},
        {"identify.json", "shapes/modes.measured", "as sensor_id"},
        {"identify.json", "/correlation", "correlation: has 1 rows of 2 values, expected 2 of 2"},
        {"identify.json", "/reduction_error_percent", "reduction_error_percent: has "},
        {"identify.json", "/matrix_rows", "as rows of mac_matrix"},
        {"modes.json", "modes.shape", "modes[0].shape: has "},
        {"diagnose.json", "/modes_standardised", "as base.modes"},
    };
    make_results();
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        cJSON *json = page_json(wrong[i].file), *at = item_at(json, wrong[i].list);
        assert_true(cJSON_IsArray(at) && cJSON_GetArraySize(at) > 1);
        cJSON_DeleteItemFromArray(at, cJSON_GetArraySize(at) - 1);
        page_write_json("wrong.json", json);
        cJSON_Delete(json);
        assert_int_equal(page_run("%s report %s -o %s", ROTID_PROGRAM, page_path("wrong.json"), page_path("page")), 2);
        if (!strstr(page_err, wrong[i].says))
            print_error("%s: '%s'\n", wrong[i].list, page_err);
        assert_non_null(strstr(page_err, wrong[i].says));
        assert_false(page_exists("page"));
    }
}

UNIT_TEST(a_value_out_of_its_range_is_refused)
{
    static const struct {
        const char *file, *path;
        double value;
        const char *says;
    } wrong[] = {
        {"identify.json", "modes.measured_hz", 0, "modes[0].measured_hz: is 0, expected a number above 0"},
        {"identify.json", "modes.predicted_hz", -1, "modes[0].predicted_hz: is -1, expected no number below 0"},
        {"identify.json", "modes.mode", 0, "modes[0].mode: is 0, expected no number below 1"},
        {"identify.json", "modes.mode", 1.5, "modes[0].mode: is 1.5, expected a whole number"},
        {"identify.json", "modes.mac", 1.001, "modes[0].mac: is 1.001, expected a number from 0 to 1"},
        {"identify.json", "parameters.std", -1, "parameters[0].std: is -1, expected no number below 0"},
        {"identify.json", "mass_kg", 0, "mass_kg: is 0, expected a number above 0"},
        {"identify.json", "intervals_widened_by", 0.9, "intervals_widened_by: is 0.9, expected no number below 1"},
        {"diagnose.json", "candidates.probability", -0.001,
         "candidates[0].probability: is -0.001, expected a number from 0 to 1"},
    };
    make_results();
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        cJSON *json = page_json(wrong[i].file), *value = item_at(json, wrong[i].path);
        assert_true(cJSON_IsNumber(value));
        cJSON_SetNumberValue(value, wrong[i].value);
        page_write_json("wrong.json", json);
        cJSON_Delete(json);
        int code = page_run("%s report %s -o %s", ROTID_PROGRAM, page_path("wrong.json"), page_path("page"));
        if (code != 2 || !strstr(page_err, wrong[i].says))
            print_error("%s: exit code %d, '%s'\n", wrong[i].path, code, page_err);
        assert_true(code == 2 && strstr(page_err, wrong[i].says));
    }
}

UNIT_TEST(a_file_cut_off_anywhere_is_refused)
{
    make_results();
    const char *whole = page_read("identify.json");
    size_t length = strlen(whole) - 1;
    while (whole[length] != '}')
        length--;
    for (int i = 0; i < 150; i++) {
        FILE *stream = fopen(page_path("cut.json"), "wb");
        int wrong;
        size_t cut = length * (size_t)i / 150;
        assert_non_null(stream);
        assert_int_equal(fwrite(whole, 1, cut, stream), cut);
        assert_int_equal(fclose(stream), 0);
        assert_status(page_composed("cut.json", NULL, &wrong), ROTID_ERROR_SYNTAX);
        assert_int_equal(wrong, 1);
    }
}

/* Memory of the pool that ends after n blocks: an error, or a page that lacks nothing but a text; never a crash, never a leak. */
UNIT_TEST(memory_that_runs_out_is_survived)
{
    make_results();
    static const char *const names[] = {"identify.json", "sensitivity.json", "frf.json",    "modes.json",
                                        "diagnose.json", "study.json",       "states.json", "states_modes.json"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        assert_true(page_composed_without_memory(names[i]) > 50);
}

static long refuse_at, asked;

static void *failing_malloc(size_t size)
{
    if (++asked == refuse_at) {
        errno = ENOMEM;
        return NULL;
    }
    return malloc(size);
}

/* Memory of the parser: the file is not called wrong, and no line of it is left out. */
UNIT_TEST(a_sound_file_is_not_accused_where_memory_runs_out)
{
    static const char *const texts[] = {"{\"a\": [1, 2, {\"b\": \"text\"}]}", "{\"a\": 1}\n{\"b\": [2]}\n{\"c\": 3}"};
    cJSON_Hooks hooks = {failing_malloc, free};
    for (int i = 0; i < 2; i++) {
        int status = ROTID_ERROR_MEMORY;
        FILE *stream = fopen(page_path("memory.json"), "w");
        assert_non_null(stream);
        assert_true(fputs(texts[i], stream) >= 0 && !fclose(stream));
        for (refuse_at = 1; status; refuse_at++) {
            struct message_list messages;
            struct pool pool;
            cJSON *json;
            int is_lines;
            pool_open(&pool, NULL);
            message_open(&messages, &pool);
            asked = 0;
            cJSON_InitHooks(&hooks);
            status = json_file_read(&pool, page_path("memory.json"), &messages, &json, &is_lines);
            cJSON_InitHooks(NULL);
            assert_true(status == ROTID_ERROR_MEMORY || (!status && refuse_at > asked));
            assert_int_equal(messages.count, 0);
            cJSON_Delete(json);
            pool_close(&pool);
        }
        assert_true(refuse_at > 8);
    }
}

/* Memory of the writer: no page without its study. */
POOL_TEST(a_page_that_lacks_its_study_is_not_written)
{
    cJSON_Hooks hooks = {failing_malloc, free};
    const char *file;
    int status = ROTID_ERROR_MEMORY;
    make_results();
    for (refuse_at = 1; status; refuse_at *= 2) {
        struct message_list messages;
        struct result result;
        struct document document;
        message_open(&messages, &test_pool);
        assert_status(page_result_read(&test_pool, page_path("study.json"), &messages, &result), ROTID_OK);
        assert_status(document_open(&document, &test_pool), ROTID_OK);
        page_compose(&document, 1, &result);
        asked = 0;
        cJSON_InitHooks(&hooks);
        status = page_write(&document, 1, &result, page_path("lacking.html"), "made", &messages, &file);
        cJSON_InitHooks(NULL);
        assert_int_equal(status, refuse_at > asked ? ROTID_OK : ROTID_ERROR_MEMORY);
        assert_int_equal(page_exists("lacking.html"), !status);
        test_pool.out_of_memory = 0;
        cJSON_Delete(result.json);
        document_close(&document);
    }
    assert_true(refuse_at > 16);
}

TEST_GROUP(page_bench_open, page_bench_close);
