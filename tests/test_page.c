/* `rotid report` end to end: what stands on a page are the numbers of the result, in text and in its data; whose files it writes;
 * causes by name, no folders before the last section; the gravest answer of several results first. */
#include <cJSON.h>

#include "json_value.h"
#include "page_bench.h"
#include "support.h"

#define PAPER ROTID_SOURCE_DIR "/input/paper_rotor.inp"
#define SOLID ROTID_SOURCE_DIR "/input/solid_rotor.inp"
#define BEAM  ROTID_SOURCE_DIR "/input/brake_reuss_beam.inp"

static void make_result(const char *command, const char *deck, const char *name)
{
    if (!page_exists(name)) {
        int code = page_run("%s %s %s --quiet --json %s", ROTID_PROGRAM, command, deck, page_path(name));
        assert_true(code == 0 || code == 1);
    }
}

static void report(const char *results, const char *name)
{
    assert_int_equal(page_run("cd %s && %s report %s -o %s.html --quiet", page_path(""), ROTID_PROGRAM, results, name), 0);
}

static void assert_says(const char *html, const char *text)
{
    page_says(html, "%s", text);
}

/* "115.7" as a page shows it. */
static const char *shown(double value, int decimals)
{
    static char text[8][32];
    static int next;
    next = (next + 1) % 8;
    (void)snprintf(text[next], sizeof text[next], "%s%.*f", value < 0 ? "\xe2\x88\x92" : "", decimals, fabs(value));
    return text[next];
}

/* ------------------------------------------------------------------------------------------------ what stands on it */

UNIT_TEST(a_page_is_whole_and_says_what_the_result_holds)
{
    char text[128];
    make_result("identify", PAPER, "paper.json");
    assert_int_equal(page_run("%s report %s -o %s", ROTID_PROGRAM, page_path("paper.json"), page_path("one")), 0);
    (void)snprintf(text, sizeof text, "%s/index.html\n", page_path("one"));
    assert_string_equal(page_out, text);
    assert_string_equal(page_err, "");
    const char *html = page_read("one/index.html");
    assert_int_equal(page_problems(html), 0);
    cJSON *json = page_json("paper.json");
    const cJSON *e = cJSON_GetArrayItem(get(json, "parameters"), 0), *ci = get(e, "ci95"), *mode;
    const char *value = shown(number_of(e, "value") / 1e9, 1), *low = shown(cJSON_GetArrayItem(ci, 0)->valuedouble / 1e9, 1),
               *high = shown(cJSON_GetArrayItem(ci, 1)->valuedouble / 1e9, 1);
    page_says(html, "core.E = %.0f\xc2\xa0GPa (95\xc2\xa0%%: %.0f to %.0f)", number_of(e, "value") / 1e9,
              cJSON_GetArrayItem(ci, 0)->valuedouble / 1e9, cJSON_GetArrayItem(ci, 1)->valuedouble / 1e9);
    page_says(html, "<dt>core.E [GPa]</dt>\n<dd class=\"large\">%s</dd>\n<dd>95\xc2\xa0%%: %s to %s</dd>", value, low, high);
    page_says(html,
              "<tr><th scope=\"row\">core.E</th><td>GPa</td><td class=\"n\">%s</td><td class=\"n\">22</td><td "
              "class=\"n\">%s</td><td class=\"n\">%s</td>",
              value, low, high);
    cJSON_ArrayForEach(mode, get(json, "modes"))
    {
        double error = number_of(mode, "error_percent");
        page_says(html, "<td class=\"n\">%s</td><td class=\"n\">%s</td><td class=\"n\">%s%s</td>",
                  shown(number_of(mode, "measured_hz"), 3), shown(number_of(mode, "predicted_hz"), 3), error > 0 ? "+" : "",
                  shown(error, 3));
    }
    cJSON *other;
    double least = INFINITY;
    cJSON_ArrayForEach(other, get(json, "baseline")) least = fmin(least, number_of(other, "objective"));
    assert_true(least >= number_of(json, "objective") * (1 - 1e-6));
    assert_says(html, "moves the frequency of mode 5 by +3.30\xc2\xa0%");
    cJSON_Delete(json);
}

/* What a page keeps of a result: every value, lists of many numbers with six digits, without what no figure shows. */
static void compare(const cJSON *whole, const cJSON *kept, int is_drawn)
{
    static const char *const left_out[] = {"steps", "extended_deck", "warnings", "cards", "jacobians"};
    const cJSON *item;
    if (cJSON_IsNumber(whole))
        assert_close(kept->valuedouble, whole->valuedouble, is_drawn ? 1e-5 : 0, 0);
    else
        assert_int_equal(whole->type & 0xff, kept->type & 0xff);
    if (cJSON_IsString(whole))
        assert_string_equal(kept->valuestring, whole->valuestring);
    if (cJSON_IsArray(whole)) {
        int i = 0;
        assert_int_equal(cJSON_GetArraySize(whole), cJSON_GetArraySize(kept));
        cJSON_ArrayForEach(item, whole) compare(item, cJSON_GetArrayItem(kept, i++), cJSON_GetArraySize(whole) > 24);
    }
    if (!cJSON_IsObject(whole))
        return;
    cJSON_ArrayForEach(item, whole)
    {
        const cJSON *same = cJSON_GetObjectItemCaseSensitive(kept, item->string);
        int missing = 0;
        for (size_t i = 0; i < sizeof left_out / sizeof *left_out; i++)
            missing |= !strcmp(left_out[i], item->string);
        assert_true(missing ? !same : same != NULL);
        if (same)
            compare(item, same, 0);
    }
}

UNIT_TEST(the_data_of_a_page_are_the_result)
{
    static const char *const names[] = {"paper.json", "sensitivity.json", "frf.json", "modes.json", "check.json", "beam.json"};
    make_result("identify", PAPER, "paper.json");
    make_result("sensitivity", PAPER " --at core.E=8e10,core.G=3e10", "sensitivity.json");
    make_result("frf", PAPER, "frf.json");
    make_result("modes", PAPER, "modes.json");
    make_result("check", PAPER, "check.json");
    make_result("diagnose", BEAM "", "beam.json");
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        const char *html = page_made(names[i]), *from = strstr(html, "id=\"data\">");
        assert_non_null(from); /* else this rotid was built without D3: tools/setup */
        from += strlen("id=\"data\">");
        const char *end = strstr(from, "</script>");
        assert_null(memchr(from, '<', (size_t)(end - from)));
        cJSON *json = cJSON_ParseWithLength(from, (size_t)(end - from)), *whole = page_json(names[i]);
        assert_non_null(json);
        compare(whole, get(cJSON_GetArrayItem(json, 0), "result"), 0);
        cJSON_Delete(json);
        cJSON_Delete(whole);
    }
    /* all of them on one page */
    report("paper.json sensitivity.json frf.json modes.json check.json beam.json", "all");
    const char *html = page_read("all.html");
    assert_int_equal(page_problems(html), 0);
    static const char *const ids[] = {"agreement", "parameters",  "fit",    "dependence",
                                      "transfer",  "model-modes", "causes", "provenance"};
    for (size_t i = 0; i < sizeof ids / sizeof *ids; i++)
        page_says(html, "<section id=\"%s\">", ids[i]);
}

UNIT_TEST(an_older_result_says_what_it_lacks)
{
    make_result("identify", SOLID, "solid.json");
    cJSON *json = page_json("solid.json");
    static const char *const newer[] = {"geometry",       "shapes", "nco_matrix", "mac_matrix",    "matrix_rows",
                                        "matrix_columns", "noise",  "references", "shapes_fitted", "bijection_chi"};
    for (size_t i = 0; i < sizeof newer / sizeof *newer; i++)
        cJSON_DeleteItemFromObject(json, newer[i]);
    cJSON *item;
    cJSON_ArrayForEach(item, get(json, "history")) cJSON_DeleteItemFromObject(item, "seconds");
    cJSON_ArrayForEach(item, get(json, "baseline")) cJSON_DeleteItemFromObject(item, "predicted_hz");
    page_write_json("old.json", json);
    cJSON_Delete(json);
    assert_int_equal(page_run("%s report %s -o %s", ROTID_PROGRAM, page_path("old.json"), page_path("old.html")), 0);
    const char *html = page_read("old.html");
    assert_int_equal(page_problems(html), 0);
    assert_says(html, "Not shown: the drawing of the rotor.");
    assert_says(html, "has no key &quot;geometry&quot;");
    assert_says(html, "has no key &quot;shapes&quot;");
    assert_says(html, "makes a new one");
    /* of the modes of a model the measured ones beside them */
    make_result("modes", SOLID, "modes.json");
    json = page_json("modes.json");
    cJSON_ArrayForEach(item, get(json, "modes"))
    {
        cJSON_DeleteItemFromObject(item, "measured_mode");
        cJSON_DeleteItemFromObject(item, "frequency_std");
    }
    page_write_json("old-modes.json", json);
    const char *measured = shown(number_of(cJSON_GetArrayItem(get(json, "modes"), 0), "measured_hz"), 3);
    assert_int_equal(page_run("%s report %s -o %s", ROTID_PROGRAM, page_path("old-modes.json"), page_path("old-modes.html")), 0);
    assert_says(page_read("old-modes.html"), measured);
    cJSON_Delete(json);
}

/* The part of a page before its last section. */
static const char *before_provenance(const char *html)
{
    static char *text;
    const char *last = strstr(html, "<section id=\"provenance\">");
    assert_non_null(last);
    assert_null(strstr(last + 10, "<section "));
    free(text);
    text = malloc((size_t)(last - html) + 1);
    assert_non_null(text);
    memcpy(text, html, (size_t)(last - html));
    text[last - html] = 0;
    return text;
}

UNIT_TEST(folders_ids_and_builds_stand_in_the_last_section)
{
    assert_int_equal(page_run("mkdir -p '%s'", page_path("a b")), 0);
    page_write_file("a b/noisy.inp", "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n"
                                     "*SHAFT, NAME=bar, MATERIAL=steel\n1, 0.05, 0, 20\n*MODES\n1, 200\n2, 640\n3, 1300\n"
                                     "*NOISE, FREQUENCY=0.001\n*IDENTIFY\nbar.E, 1e10, 1e12, 2e11\n");
    assert_int_equal(
        page_run("cd '%s' && %s identify \"$PWD/a b/noisy.inp\" --quiet --json blank.json", page_path(""), ROTID_PROGRAM), 1);
    report("blank.json", "blank");
    assert_null(strstr(before_provenance(page_read("blank.html")), "b/noisy.inp"));
    page_says(page_read("blank.html"), "rotid diagnose noisy.inp looks for the cause");
    assert_null(strstr(before_provenance(page_read("blank.html")), page_path("a")));
    make_result("identify", PAPER, "paper.json");
    make_result("diagnose", BEAM "", "beam.json");
    static const char *const results[] = {"paper.json", "beam.json"};
    for (int i = 0; i < 2; i++) {
        cJSON *json = page_json(results[i]);
        report(results[i], "last");
        const char *html = page_read("last.html"), *before = before_provenance(html);
        assert_int_equal(page_problems(html), 0);
        static const char *const hidden[] = {"commit", "blas"};
        for (int k = 0; k < 2; k++) {
            const char *text = get(json, hidden[k])->valuestring;
            assert_null(strstr(before, text));
            page_says(html, "%s", text);
        }
        assert_null(strstr(before, ROTID_SOURCE_DIR));
        page_says(html, "%s/input/", ROTID_SOURCE_DIR);
        static const char *const ids[] = {"added_mass", "stiffness_local", "support_extra", "stiffness_gradient"};
        for (size_t k = 0; k < sizeof ids / sizeof *ids; k++)
            assert_null(strstr(before, ids[k]));
        if (i)
            page_says(html, "soft zone: stiffness_local");
        cJSON_Delete(json);
    }
}

UNIT_TEST(the_gravest_answer_comes_first)
{
    make_result("modes", PAPER, "modes.json");
    make_result("identify", PAPER, "paper.json");
    make_result("diagnose", BEAM "", "beam.json");
    static const char *const order[] = {"modes.json paper.json beam.json", "beam.json paper.json modes.json",
                                        "paper.json modes.json beam.json"};
    char title[256] = "";
    for (int i = 0; i < 3; i++) {
        report(order[i], "several");
        const char *html = page_read("several.html"), *answer = strstr(html, "class=\"answer ");
        assert_int_equal(page_problems(html), 0);
        assert_non_null(answer);
        assert_int_equal(strncmp(answer, "class=\"answer bad\"", 18), 0);
        assert_int_equal(page_times(html, "class=\"answer "), 2); /* modes judge nothing */
        const char *first = strstr(html, "<p class=\"of\">"), *second = strstr(first + 1, "<p class=\"of\">");
        assert_int_equal(strncmp(first, "<p class=\"of\">Diagnosis of brake_reuss_beam.inp<", 48), 0);
        assert_int_equal(strncmp(second, "<p class=\"of\">Identification of paper_rotor.inp<", 48), 0);
        const char *h1 = strstr(html, "<h1>");
        char own[256];
        (void)snprintf(own, sizeof own, "%.*s", (int)strcspn(h1, "\n"), h1);
        if (i)
            assert_string_equal(own, title);
        (void)snprintf(title, sizeof title, "%s", own);
    }
}

/* Magnitudes of a curve of the result at its largest line. */
static double largest(const cJSON *curve, const char *re, const char *im)
{
    double most = 0;
    const cJSON *x = get(curve, re)->child, *y = get(curve, im)->child;
    for (; x && y; x = x->next, y = y->next)
        most = fmax(most, hypot(x->valuedouble, y->valuedouble));
    return most;
}

UNIT_TEST(a_modal_analysis_has_a_page)
{
    assert_int_equal(
        page_run("cd %s && %s/hammer beam -o rec.unv --deck b.inp --modes-file m.unv --noise 0.01 --fault loose:12=1500 "
                 "--fault dead:7 --floor 1e-5 --seed 3",
                 page_path(""), ROTID_BUILD),
        0);
    int code = page_run("cd %s && %s ema rec.unv -o m.unv --quiet --json ema.json", page_path(""), ROTID_PROGRAM);
    assert_true(code == 0 || code == 1);
    report("ema.json", "ema");
    const char *html = page_read("ema.html");
    assert_int_equal(page_problems(html), 0);
    cJSON *json = page_json("ema.json");
    const cJSON *mode, *channel, *curves = get(json, "curves");
    int doubtful = 0;
    page_says(html, "Modal analysis of rec.unv");
    page_says(html, "class=\"answer care\"");
    cJSON_ArrayForEach(mode, get(json, "modes")) if (cJSON_GetArraySize(get(mode, "doubts")))
    {
        doubtful++;
        page_says(html, "<li>mode %.0f, ", number_of(mode, "mode"));
    }
    int channels = 0;
    cJSON_ArrayForEach(channel, get(json, "channels")) if (cJSON_GetArraySize(get(channel, "doubts")))
    {
        channels++;
        page_says(html, "%s at node %.0f over node %.0f (FRAC ",
                  strcmp(get(channel, "doubts")->child->valuestring, "dead") ? "" : "no signal",
                  number_of(channel, "response_node"), number_of(channel, "reference_node"));
    }
    assert_true(channels >= 1);
    page_says(html, "%d of the modes and %d of the channels", doubtful, channels);
    /* by rising FRAC, synthesised from the modes: near to what was measured where FRAC is near 1 */
    int n = cJSON_GetArraySize(curves);
    assert_true(n >= 3);
    double before = 0;
    for (int i = 0; i < n; i++) {
        const cJSON *curve = cJSON_GetArrayItem(curves, i),
                    *of = cJSON_GetArrayItem(get(json, "channels"), (int)number_of(curve, "channel") - 1);
        double frac = number_of(of, "frac"), measured = largest(curve, "measured_re", "measured_im"),
               synthesised = largest(curve, "synthesised_re", "synthesised_im");
        assert_true(frac >= before);
        before = frac;
        assert_int_equal(cJSON_GetArraySize(get(curve, "frequency_hz")), (int)number_of(get(json, "source"), "lines"));
        if (frac > 0.999)
            assert_close(synthesised, measured, 0.05, 0);
    }
    assert_true(before > 0.999);
    assert_int_equal(cJSON_GetArraySize(get(json, "rms_measured")), (int)number_of(get(json, "source"), "lines"));
    /* a result of before has no curves */
    cJSON_DeleteItemFromObject(json, "curves");
    cJSON_DeleteItemFromObject(json, "rms_frequency_hz");
    cJSON_DeleteItemFromObject(json, "rms_measured");
    cJSON_DeleteItemFromObject(json, "rms_synthesised");
    page_write_json("older.json", json);
    cJSON_Delete(json);
    report("older.json", "older");
    assert_null(strstr(page_read("older.html"), "id=\"functions\""));
    page_says(page_read("older.html"), "<section id=\"poles\">");
}

/* ------------------------------------------------------------------------------------------------ whose files it writes */

UNIT_TEST(nothing_of_anybody_else_is_written_over)
{
    make_result("identify", PAPER, "paper.json");
    const char *to = "%s report %s -o %s";
    static const char mine[] = "<!DOCTYPE html><title>mine</title>";
    page_write_file("file", "mine");
    assert_int_equal(page_run(to, ROTID_PROGRAM, page_path("paper.json"), page_path("file")), 2);
    assert_non_null(strstr(page_err, "is a file, expected a folder, a new name, or one in .html"));
    assert_string_equal(page_read("file"), "mine");
    /* a page that somebody else wrote, by its name and in a folder */
    assert_int_equal(page_run("mkdir %s", page_path("site")), 0);
    page_write_file("site/index.html", mine);
    page_write_file("site/other.html", mine);
    static const char *const others[] = {"site", "site/other.html"};
    for (int i = 0; i < 2; i++) {
        assert_int_equal(page_run(to, ROTID_PROGRAM, page_path("paper.json"), page_path(others[i])), 2);
        assert_non_null(strstr(page_err, "is no page of rotid"));
        assert_string_equal(page_read("site/index.html"), mine);
        assert_string_equal(page_read("site/other.html"), mine);
    }
    assert_int_equal(page_count("site", ""), 2);
    /* a link is not followed to what it names */
    assert_int_equal(page_run("cd %s && ln -s site/other.html link.html", page_path("")), 0);
    assert_int_equal(page_run(to, ROTID_PROGRAM, page_path("paper.json"), page_path("link.html")), 2);
    assert_string_equal(page_read("site/other.html"), mine);
    /* a folder with other things in it gets a page, and a second one in its place; the other things stay */
    assert_int_equal(page_run("mkdir %s", page_path("home")), 0);
    page_write_file("home/notes.txt", "mine");
    for (int i = 0; i < 2; i++) {
        assert_int_equal(page_run(to, ROTID_PROGRAM, page_path("paper.json"), page_path("home")), 0);
        assert_string_equal(page_read("home/notes.txt"), "mine");
        assert_int_equal(page_count("home", ""), 2);
        assert_int_equal(page_problems(page_read("home/index.html")), 0);
    }
}

UNIT_TEST(what_cannot_be_written_is_said)
{
    make_result("identify", PAPER, "paper.json");
    static const char *const where[] = {"/dev/null/at/all", "/dev/null/at/all.html"};
    for (int i = 0; i < 2; i++) {
        assert_int_equal(page_run("%s report %s -o %s", ROTID_PROGRAM, page_path("paper.json"), where[i]), 3);
        page_says(page_err, "cannot write %s: Not a directory", where[i]);
    }
    assert_int_equal(page_run("%s report %s -o -", ROTID_PROGRAM, page_path("paper.json")), 2);
    /* without -o beside the result; folders that are not there are made */
    assert_int_equal(page_run("%s report %s", ROTID_PROGRAM, page_path("paper.json")), 0);
    assert_int_equal(page_problems(page_read("paper.html")), 0);
    assert_int_equal(page_run("%s report %s -o %s", ROTID_PROGRAM, page_path("paper.json"), page_path("a/b/c.html")), 0);
    assert_int_equal(page_problems(page_read("a/b/c.html")), 0);
    assert_int_equal(page_run("%s report -o %s", ROTID_PROGRAM, page_path("x")), 2);
    assert_int_equal(page_run("%s report %s --json - -o %s", ROTID_PROGRAM, page_path("paper.json"), page_path("x")), 2);
    assert_false(page_exists("x"));
    /* a file that may not grow, as on a full disk, leaves the page of before */
    report("paper.json", "kept");
    assert_int_equal(
        page_run("cd %s && ( ulimit -f 40; trap '' XFSZ; %s report paper.json -o kept.html )", page_path(""), ROTID_PROGRAM), 3);
    assert_int_equal(page_problems(page_read("kept.html")), 0);
    assert_int_equal(page_count("", "kept.html"), 1);
    /* a name with a quote and a blank; a folder with a slash at its end */
    assert_int_equal(page_run("%s report %s -o \"%s/\"", ROTID_PROGRAM, page_path("paper.json"), page_path("it's a page")), 0);
    assert_int_equal(page_problems(page_read("it's a page/index.html")), 0);
}

/* ------------------------------------------------------------------------------------------------ size */

#define SENSORS  500
#define ELEMENTS 2000
#define MODES    8

static void add_list(cJSON *object, const char *key, int count, double from, double step, double waves)
{
    cJSON *list = cJSON_AddArrayToObject(object, key);
    for (int i = 0; i < count; i++)
        cJSON_AddItemToArray(list, cJSON_CreateNumber(waves > 0 ? cos(waves * i / count) : from + step * i));
}

/* The paper's result blown up: more nodes, more sensors, more shapes. */
UNIT_TEST(a_large_result_makes_a_page_of_less_than_two_megabytes)
{
    make_result("identify", SOLID, "solid.json");
    cJSON *json = page_json("solid.json"), *geometry = cJSON_GetObjectItem(json, "geometry"),
          *shapes = cJSON_GetObjectItem(json, "shapes");
    double length = number_of(geometry, "length_m");
    cJSON_DeleteItemFromObject(geometry, "nodes_z_m");
    add_list(geometry, "nodes_z_m", ELEMENTS + 1, 0, length / ELEMENTS, 0);
    cJSON_DeleteItemFromObject(geometry, "sensors");
    cJSON *sensors = cJSON_AddArrayToObject(geometry, "sensors");
    for (int s = 0; s < SENSORS; s++) {
        cJSON *sensor = cJSON_CreateObject();
        (void)cJSON_AddNumberToObject(sensor, "id", s + 1);
        (void)cJSON_AddNumberToObject(sensor, "z_m", length * s / (SENSORS - 1));
        cJSON_AddItemToArray(sensors, sensor);
    }
    static const char *const keys[] = {"sensor_id", "z_m", "axis_z_m"};
    for (int i = 0; i < 3; i++)
        cJSON_DeleteItemFromObject(shapes, keys[i]);
    add_list(shapes, "sensor_id", SENSORS, 1, 1, 0);
    add_list(shapes, "z_m", SENSORS, 0, length / (SENSORS - 1), 0);
    add_list(shapes, "axis_z_m", ELEMENTS + 1, 0, length / ELEMENTS, 0);
    cJSON *mode;
    cJSON_ArrayForEach(mode, cJSON_GetObjectItem(shapes, "modes"))
    {
        static const char *const lists[] = {"measured", "measured_std", "predicted", "predicted_axis"};
        for (int i = 0; i < 4; i++) {
            cJSON_DeleteItemFromObject(mode, lists[i]);
            add_list(mode, lists[i], i < 3 ? SENSORS : ELEMENTS + 1, 0.01, 0, i == 1 ? 0 : 20);
        }
    }
    page_write_json("large.json", json);
    cJSON_Delete(json);
    double begin = clock_seconds();
    assert_int_equal(page_run("%s report %s -o %s", ROTID_PROGRAM, page_path("large.json"), page_path("large.html")), 0);
    assert_true(clock_seconds() - begin < 20); /* two on an idle machine, valgrind apart */
    const char *html = page_read("large.html");
    assert_int_equal(page_problems(html), 0);
    assert_true(strlen(html) < 2000000);
}

TEST_GROUP(page_bench_open, page_bench_close);
