/* What every page keeps to: causes by name, no folders, ids and builds before the last section; the gravest answer of several
 * results first, wherever it was given; labels whole; the files of a page that is written anew; the page of a modal analysis. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cJSON.h>

#include "json_value.h"
#include "page/document.h"
#include "page/names.h"
#include "page/plain.h"
#include "page_bench.h"
#include "support.h"

#define PAPER ROTID_SOURCE_DIR "/input/paper_rotor.inp"
#define BEAM  ROTID_SOURCE_DIR "/input/brake_reuss_beam.inp"

static void make_result(const char *command, const char *deck, const char *name)
{
    if (!page_exists(name)) {
        int code = page_run("%s %s %s --quiet --json %s", ROTID_PROGRAM, command, deck, page_path(name));
        assert_true(code == 0 || code == 1);
    }
}

static void report(const char *results, const char *folder)
{
    assert_int_equal(
        page_run("cd %s && %s %s report %s -o %s --quiet", page_path(""), page_stand_in(NULL), ROTID_PROGRAM, results, folder),
        0);
}

static void ids_become_words_and_paths_names(void **state)
{
    (void)state;
    static const char *const text[][2] = {{"The model lacks added_mass; it explains", "The model lacks added mass; it explains"},
                                          {"stiffness_local of core, joint", "soft zone of core, joint"},
                                          {"my_added_mass added_mass2 added_mass.inp core.added_mass", NULL},
                                          {"(beam_theory)", "(error of beam theory)"},
                                          {"rotid diagnose /home/a/rotor.inp --extended", "rotid diagnose rotor.inp --extended"},
                                          {"added_mass of '/a/b.inp', /c/d/e", "added mass of 'b.inp', e"},
                                          {"kg/m3, input/rotor.inp, and /or, https://x/y/z", NULL},
                                          {"", NULL}};
    for (size_t i = 0; i < sizeof text / sizeof *text; i++)
        assert_string_equal(plain_text(&test_pool, text[i][0]), text[i][1] ? text[i][1] : text[i][0]);
    assert_null(plain_text(&test_pool, NULL));
    assert_string_equal(plain_file("/a/b.inp"), "b.inp");
    assert_string_equal(plain_file("a/b.inp"), "a/b.inp");
    assert_string_equal(plain_cause(&test_pool, "step_stiffness"), "step stiffness");
}

/* Whoever adds a text to a page: outside of the section on provenance it is shown so. */
static void every_text_of_a_page_is_shown_so(void **state)
{
    (void)state;
    struct document document;
    char *html = NULL;
    size_t length;
    FILE *out = open_memstream(&html, &length);
    static const char *const text[] = {"list: added_mass of /a/b/c1.inp"}, *const name[] = {"fact"};
    document_open(&document, &test_pool);
    document.title = document.subtitle = "";
    document.answer = "answer: beam_theory";
    document.headline = "headline: support_extra";
    document.next = "next: rotid diagnose /a/b/c2.inp";
    document_answer(&document, NULL);
    document_section(&document, "one", "One");
    document_paragraph(&document, "paragraph: %s", "stiffness_local");
    document_heading(&document, "heading: step_stiffness");
    document_list(&document, 1, text);
    document_facts(&document, 1, name, text);
    struct number_table *table = table_headed(&test_pool, 1, 1, (const char *const[]){"head: tie_shear"});
    table_cell(table, 0, 0, "cell: tie_tension");
    document_table(&document, "caption: layer_slip", table);
    document.verbatim = 1;
    document_section(&document, "provenance", "Provenance");
    document_paragraph(&document, "as it is: added_inertia /a/b/c3.inp");
    document.verbatim = 0;
    assert_false(document.failed);
    document_write(out, &document, "made", NULL);
    assert_int_equal(fclose(out), 0);
    static const char *const shown[] = {"answer: error of beam theory",
                                        "headline: extra support",
                                        "next: rotid diagnose c2.inp",
                                        "paragraph: soft zone",
                                        "heading: step stiffness",
                                        "<li>list: added mass of c1.inp",
                                        "<dd>list: added mass of c1.inp",
                                        "head: tie shear",
                                        "cell: tie tension",
                                        "caption: layer slip",
                                        "as it is: added_inertia /a/b/c3.inp"};
    for (size_t i = 0; i < sizeof shown / sizeof *shown; i++)
        if (!strstr(html, shown[i]))
            fail_msg("'%s' is not on the page:\n%s", shown[i], html);
    free(html);
}

static void names_go_on_in_further_lines(void **state)
{
    (void)state;
    const char *name = "added mass with extra rotational support of the left end of the rotor", *rest = name;
    char whole[512] = "";
    int lines = 0;
    for (; *rest; lines++) {
        size_t bytes = name_line(rest, 200);
        char line[128];
        (void)snprintf(line, sizeof line, "%.*s", (int)bytes, rest);
        assert_true(bytes > 0 && plot_width(line) <= 200);
        (void)strcat(strcat(whole, lines ? " " : ""), line);
        rest += bytes;
        rest += strspn(rest, " ");
    }
    assert_string_equal(whole, name); /* all of it */
    assert_true(lines > 1);
    assert_int_equal(name_line_count(name, 200), lines);
    assert_int_equal(name_line_count("short", 200), 1);
    assert_true(name_line("a_word_that_is_longer_than_its_room_without_any_blank", 100) < 30);
    assert_int_equal(name_line("\xc3\xa4\xc3\xb6", 8), 2); /* not within a character */
    static const double room[LAYOUTS] = {200, 1000}, single[LAYOUTS] = {26, 40};
    const struct name_rows names = names_measure(1, &name, room, single);
    assert_true(names.height[WIDE] >= 13 * lines);
    assert_close(names.height[NARROW], 40, 1e-12, 0);
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

static void folders_ids_and_builds_stand_in_the_last_section(void **state)
{
    (void)state;
    assert_int_equal(page_run("mkdir -p '%s'", page_path("a b")), 0);
    page_write_file("a b/noisy.inp", "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n"
                                     "*SHAFT, NAME=bar, MATERIAL=steel\n1, 0.05, 0, 20\n*MODES\n1, 200\n2, 640\n3, 1300\n"
                                     "*NOISE, FREQUENCY=0.001\n*IDENTIFY\nbar.E, 1e10, 1e12, 2e11\n");
    assert_int_equal(
        page_run("cd '%s' && %s identify \"$PWD/a b/noisy.inp\" --quiet --json blank.json", page_path(""), ROTID_PROGRAM), 1);
    report("blank.json", "blank");
    assert_null(strstr(before_provenance(page_read("blank/index.html")), "b/noisy.inp"));
    page_says(page_read("blank/index.html"), "rotid diagnose noisy.inp looks for the cause");
    assert_null(strstr(before_provenance(page_read("blank/index.html")), page_path("a")));
    make_result("identify", PAPER, "paper.json");
    make_result("diagnose", BEAM " --replicates 200", "beam.json");
    static const char *const results[] = {"paper.json", "beam.json"};
    for (int i = 0; i < 2; i++) {
        cJSON *json = page_json(results[i]);
        report(results[i], "last");
        const char *html = page_read("last/index.html"), *before = before_provenance(html);
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

static void the_gravest_answer_comes_first(void **state)
{
    (void)state;
    make_result("modes", PAPER, "modes.json");
    make_result("identify", PAPER, "paper.json");
    make_result("diagnose", BEAM " --replicates 200", "beam.json");
    static const char *const order[] = {"modes.json paper.json beam.json", "beam.json paper.json modes.json",
                                        "paper.json modes.json beam.json"};
    char title[256] = "";
    for (int i = 0; i < 3; i++) {
        report(order[i], "several");
        const char *html = page_read("several/index.html"), *answer = strstr(html, "class=\"answer ");
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

static void a_page_written_anew_leaves_nothing_of_the_one_before(void **state)
{
    (void)state;
    make_result("modes", PAPER, "modes.json");
    make_result("identify", PAPER, "paper.json");
    report("paper.json", "anew");
    assert_true(page_exists("anew/figures/convergence.gp"));
    assert_true(page_exists("anew/figures/intervals.svg"));
    page_write_file("anew/figures/mine.svg", "mine");
    page_write_file("anew/figures/modes.gp", "mine too");
    page_write_file("anew/figures/bijection.gp", "changed");
    page_write_file("anew/figures/rotor.gp", "changed as well");
    assert_int_equal(page_run("cd %s && %s %s report modes.json -o anew", page_path(""), page_stand_in(NULL), ROTID_PROGRAM), 0);
    assert_non_null(strstr(page_err, "warning: figures/modes.gp is not as rotid wrote it, and is kept as figures/modes.gp~"));
    assert_false(page_exists("anew/figures/convergence.gp"));
    assert_false(page_exists("anew/figures/intervals.svg"));
    assert_string_equal(page_read("anew/figures/mine.svg"), "mine");
    assert_string_equal(page_read("anew/figures/modes.gp~"), "mine too");
    assert_string_equal(page_read("anew/figures/bijection.gp"), "changed");
    assert_string_equal(page_read("anew/figures/rotor.gp~"), "changed as well");
    assert_non_null(strstr(page_read("anew/figures/rotor.gp"), "gnuplot"));
    /* once more, with a script of that name aside already */
    page_write_file("anew/figures/rotor.gp", "third");
    report("modes.json", "anew");
    assert_string_equal(page_read("anew/figures/rotor.gp~"), "changed as well");
    assert_string_equal(page_read("anew/figures/rotor.gp~2"), "third");
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

static void a_modal_analysis_has_a_page(void **state)
{
    (void)state;
    assert_int_equal(
        page_run("cd %s && %s/hammer beam -o rec.unv --deck b.inp --modes-file m.unv --noise 0.01 --fault loose:12=1500 "
                 "--fault dead:7 --floor 1e-5 --seed 3",
                 page_path(""), ROTID_BUILD),
        0);
    int code = page_run("cd %s && %s ema rec.unv -o m.unv --quiet --json ema.json", page_path(""), ROTID_PROGRAM);
    assert_true(code == 0 || code == 1);
    report("ema.json", "ema");
    const char *html = page_read("ema/index.html");
    assert_int_equal(page_problems(html), 0);
    cJSON *json = page_json("ema.json");
    const cJSON *mode, *channel, *curves = get(json, "curves");
    int doubtful = 0;
    page_says(html, "<figure id=\"stabilisation\">");
    page_says(html, "Modal analysis of rec.unv");
    page_says(html, "class=\"answer care\"");
    cJSON_ArrayForEach(mode, get(json, "modes")) if (cJSON_GetArraySize(get(mode, "doubts")))
    {
        doubtful++;
        page_says(html, "Mode %.0f at ", number_of(mode, "mode"));
    }
    int channels = 0;
    cJSON_ArrayForEach(channel, get(json, "channels")) if (cJSON_GetArraySize(get(channel, "doubts")))
    {
        channels++;
        page_says(html, "Node %.0f over node %.0f: %s", number_of(channel, "response_node"), number_of(channel, "reference_node"),
                  get(channel, "doubts")->child->valuestring);
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
    const cJSON *best = cJSON_GetArrayItem(curves, n - 1),
                *of = cJSON_GetArrayItem(get(json, "channels"), (int)number_of(best, "channel") - 1);
    page_says(html, "Transfer function between points %.0f and %.0f, the best of all", number_of(of, "response_node"),
              number_of(of, "reference_node"));
    assert_int_equal(cJSON_GetArraySize(get(json, "rms_measured")), (int)number_of(get(json, "source"), "lines"));
    /* a result of before has no curves */
    cJSON_DeleteItemFromObject(json, "curves");
    cJSON_DeleteItemFromObject(json, "rms_frequency_hz");
    cJSON_DeleteItemFromObject(json, "rms_measured");
    cJSON_DeleteItemFromObject(json, "rms_synthesised");
    page_write_json("older.json", json);
    cJSON_Delete(json);
    report("older.json", "older");
    assert_null(strstr(page_read("older/index.html"), "the best of all"));
    page_says(page_read("older/index.html"), "<figure id=\"stabilisation\">");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(ids_become_words_and_paths_names, open_test_pool, close_test_pool),
        cmocka_unit_test_setup_teardown(every_text_of_a_page_is_shown_so, open_test_pool, close_test_pool),
        cmocka_unit_test(names_go_on_in_further_lines),
        cmocka_unit_test(folders_ids_and_builds_stand_in_the_last_section),
        cmocka_unit_test(the_gravest_answer_comes_first),
        cmocka_unit_test(a_page_written_anew_leaves_nothing_of_the_one_before),
        cmocka_unit_test(a_modal_analysis_has_a_page),
    };
    return cmocka_run_group_tests(tests, page_bench_open, page_bench_close);
}
