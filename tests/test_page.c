/* `rotid report` end to end: what stands on a page, what a page is without gnuplot and with one that fails, whose files it
 * writes, and that nobody's text becomes a part of it. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cJSON.h>

#include "base/clock.h"
#include "json_value.h"
#include "page_bench.h"
#include "picture_check.h"
#include "support.h"

#define PAPER ROTID_SOURCE_DIR "/input/paper_rotor.inp"
#define SOLID ROTID_SOURCE_DIR "/input/solid_rotor.inp"

static void make_result(const char *command, const char *deck, const char *name)
{
    if (!page_exists(name))
        assert_int_equal(page_run("%s %s %s --quiet --json %s", ROTID_PROGRAM, command, deck, page_path(name)), 0);
}

static void assert_says(const char *html, const char *text)
{
    if (!strstr(html, text))
        print_error("the page does not say '%s'\n", text);
    assert_non_null(strstr(html, text));
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

static void a_page_is_whole_and_says_what_the_result_holds(void **state)
{
    (void)state;
    char text[128];
    make_result("identify", PAPER, "paper.json");
    assert_int_equal(
        page_run("%s %s report %s -o %s", page_stand_in(NULL), ROTID_PROGRAM, page_path("paper.json"), page_path("one")), 0);
    (void)snprintf(text, sizeof text, "%s/index.html\n", page_path("one"));
    assert_string_equal(page_out, text);
    assert_string_equal(page_err, "");
    const char *html = page_read("one/index.html");
    assert_int_equal(page_problems(html), 0);
    cJSON *json = page_json("paper.json");
    const cJSON *e = cJSON_GetArrayItem(get(json, "parameters"), 0), *ci = get(e, "ci95");
    (void)snprintf(text, sizeof text, "core.E = %s\xc2\xa0GPa (95\xc2\xa0%%: %s to %s)", shown(number_of(e, "value") / 1e9, 1),
                   shown(cJSON_GetArrayItem(ci, 0)->valuedouble / 1e9, 1),
                   shown(cJSON_GetArrayItem(ci, 1)->valuedouble / 1e9, 1));
    assert_says(html, text);
    const cJSON *mode = cJSON_GetArrayItem(get(json, "modes"), 1);
    (void)snprintf(text, sizeof text, "largest +%s\xc2\xa0%% in mode 2", shown(number_of(mode, "error_percent"), 2));
    assert_says(html, text);
    (void)snprintf(text, sizeof text, "in ten iterations and eleven evaluations");
    assert_int_equal((int)number_of(json, "iterations"), 10);
    assert_int_equal((int)number_of(json, "evaluations"), 11);
    assert_says(html, text);
    assert_says(html, "Their correlation is \xe2\x88\x92"
                      "0.69");
    assert_says(html, "175 elements");
    assert_says(html, "68 sensors");
    assert_says(html, "moves the frequency of mode 5 by +3.30\xc2\xa0%");
    assert_says(html, get(json, "commit")->valuestring);
    assert_says(html, "input/paper_rotor.inp");
    assert_says(html, "seed 1");
    assert_int_equal(page_times(html, "<figure "), 7);
    assert_int_equal(page_times(html, "<img "), 14);
    assert_int_equal(page_times(html, "<h1>"), 1);
    assert_int_equal(page_count("one/figures", ""), 21); /* script, SVG and PDF of each */
    assert_int_equal(page_count("", "one"), 1);
    cJSON_Delete(json);
}

static void further_results_add_their_sections(void **state)
{
    (void)state;
    make_result("identify", PAPER, "paper.json");
    make_result("sensitivity", PAPER " --at core.E=8e10,core.G=3e10", "sensitivity.json");
    make_result("frf", PAPER, "frf.json");
    make_result("modes", PAPER, "modes.json");
    make_result("check", PAPER, "check.json");
    assert_int_equal(page_run("%s %s report %s %s %s %s -o %s --quiet", page_stand_in(NULL), ROTID_PROGRAM,
                              page_path("paper.json"), page_path("sensitivity.json"), page_path("frf.json"),
                              page_path("modes.json"), page_path("all")),
                     0);
    assert_string_equal(page_out, "");
    const char *html = page_read("all/index.html");
    assert_int_equal(page_problems(html), 0);
    static const char *const ids[] = {"rotor",         "frequencies", "shapes",      "intervals",          "convergence",
                                      "iterates",      "bijection",   "sensitivity", "sensitivity-curves", "growth",
                                      "transfer-19-1", "modes"};
    for (size_t i = 0; i < sizeof ids / sizeof *ids; i++) {
        char text[64];
        (void)snprintf(text, sizeof text, "<figure id=\"%s\">", ids[i]);
        assert_says(html, text);
        (void)snprintf(text, sizeof text, "all/figures/%s.gp", ids[i]);
        assert_true(page_exists(text));
    }
    assert_int_equal(page_times(html, "<figure "), (int)(sizeof ids / sizeof *ids));
    assert_says(html, "core.E does most (0.5"); /* the paper's Table 1 has 0.669 of a rotor that it does not print */
    assert_says(html, "Point 19 (0.4457\xc2\xa0m) over a force at point 1 (0\xc2\xa0m), acceleration per newton.");
    /* each alone is a page as well */
    static const char *const alone[] = {"sensitivity.json", "frf.json", "modes.json", "check.json"};
    for (size_t i = 0; i < sizeof alone / sizeof *alone; i++) {
        assert_int_equal(
            page_run("%s %s report %s -o %s", page_stand_in(NULL), ROTID_PROGRAM, page_path(alone[i]), page_path("alone")), 0);
        assert_int_equal(page_problems(page_read("alone/index.html")), 0);
    }
}

/* Shapes that were measured, noise that was stated: the other branches of what is said. */
static void a_model_that_is_not_adequate_is_called_that(void **state)
{
    (void)state;
    char text[128];
    make_result("identify", SOLID, "solid.json");
    assert_int_equal(
        page_run("%s %s report %s -o %s", page_stand_in(NULL), ROTID_PROGRAM, page_path("solid.json"), page_path("solid")), 0);
    const char *html = page_read("solid/index.html");
    cJSON *json = page_json("solid.json");
    assert_int_equal(page_problems(html), 0);
    assert_says(html, "Not to be relied on as it stands");
    (void)snprintf(text, sizeof text, "\xcf\x87\xc2\xb2 = %.0f with %.0f degrees of freedom", number_of(json, "chi2"),
                   number_of(json, "dof"));
    assert_says(html, text);
    assert_says(html, "frequencies 0.10\xc2\xa0%");
    assert_says(html, "<figure id=\"correlation-of-shapes\">");
    double least = 1;
    const cJSON *mode;
    cJSON_ArrayForEach(mode, get(json, "modes")) least = fmin(least, number_of(mode, "nco"));
    (void)snprintf(text, sizeof text, "normalised cross orthogonality of %s", shown(least, 3));
    assert_says(html, text);
    cJSON_Delete(json);
}

static void an_older_result_says_what_it_lacks(void **state)
{
    (void)state;
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
    assert_int_equal(
        page_run("%s %s report %s -o %s", page_stand_in(NULL), ROTID_PROGRAM, page_path("old.json"), page_path("old")), 0);
    const char *html = page_read("old/index.html");
    assert_int_equal(page_problems(html), 0);
    assert_says(html, "Not shown: the drawing of the rotor.");
    assert_says(html, "has no key &quot;geometry&quot;");
    assert_says(html, "has no key &quot;shapes&quot;");
    assert_says(html, "makes a new one");
    assert_null(strstr(html, "<figure id=\"rotor\">"));
    assert_says(html, "<figure id=\"convergence\">");
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
    assert_int_equal(page_run("%s %s report %s -o %s", page_stand_in(NULL), ROTID_PROGRAM, page_path("old-modes.json"),
                              page_path("old-modes")),
                     0);
    assert_says(page_read("old-modes/index.html"), measured);
    cJSON_Delete(json);
}

/* ------------------------------------------------------------------------------------------------ gnuplot */

static void without_gnuplot_the_numbers_stand_in_tables(void **state)
{
    (void)state;
    make_result("identify", PAPER, "paper.json");
    assert_int_equal(
        page_run("GNUPLOT=/nowhere/gnuplot %s report %s -o %s", ROTID_PROGRAM, page_path("paper.json"), page_path("bare")), 0);
    assert_non_null(strstr(page_err, "warning: no figures: /nowhere/gnuplot could not be run"));
    assert_non_null(strstr(page_err, "apt-get install gnuplot-nox"));
    const char *html = page_read("bare/index.html");
    assert_int_equal(page_problems(html), 0);
    assert_says(html, "apt-get install gnuplot-nox");
    assert_null(strstr(html, "<img"));
    assert_null(strstr(html, "<details"));
    assert_int_equal(page_times(html, "<figure "), 7);
    assert_true(page_times(html, "<table>") >= 9);
    assert_says(html, "iteration</th>");
    assert_int_equal(page_count("bare/figures", ""), 7); /* the scripts */
    /* PATH without it */
    assert_int_equal(
        page_run("PATH=/nowhere GNUPLOT= %s report %s -o %s", ROTID_PROGRAM, page_path("paper.json"), page_path("bare")), 0);
    assert_non_null(strstr(page_err, "gnuplot could not be run: No such file or directory"));
    /* what is no gnuplot, and what is too old */
    assert_int_equal(page_run("GNUPLOT=/bin/true %s report %s -o %s", ROTID_PROGRAM, page_path("paper.json"), page_path("bare")),
                     0);
    assert_non_null(strstr(page_err, "/bin/true does not tell its version"));
    page_write_file("old-gnuplot", "#!/bin/sh\necho gnuplot 4.6 patchlevel 6\n");
    assert_int_equal(page_run("chmod 755 %s; GNUPLOT=%s %s report %s -o %s", page_path("old-gnuplot"), page_path("old-gnuplot"),
                              ROTID_PROGRAM, page_path("paper.json"), page_path("bare")),
                     0);
    assert_non_null(strstr(page_err, "is version 4.6, expected 5.2 or newer"));
}

static void a_figure_that_fails_costs_no_other(void **state)
{
    (void)state;
    make_result("identify", PAPER, "paper.json");
    assert_int_equal(
        page_run("%s %s report %s -o %s", page_stand_in("iterates"), ROTID_PROGRAM, page_path("paper.json"), page_path("some")),
        1);
    assert_non_null(strstr(page_err, "figure iterates is not drawn: line 7: stand-in fails on iterates"));
    const char *html = page_read("some/index.html");
    assert_int_equal(page_problems(html), 0);
    assert_int_equal(page_times(html, "<img "), 12);
    assert_says(html, "Some figures are missing");
    assert_true(page_exists("some/figures/iterates.gp") && !page_exists("some/figures/iterates.svg"));
    assert_true(page_exists("some/figures/bijection.pdf"));
    /* one that fails on everything, and one that draws nothing and says so to nobody */
    assert_int_equal(
        page_run("%s %s report %s -o %s", page_stand_in(""), ROTID_PROGRAM, page_path("paper.json"), page_path("none")), 1);
    assert_int_equal(page_times(page_err, "is not drawn"), 7);
    assert_int_equal(page_problems(page_read("none/index.html")), 0);
    page_write_file("idle", "#!/bin/sh\n[ \"$1\" = --version ] && echo gnuplot 6.0 patchlevel 1\nexit 0\n");
    assert_int_equal(page_run("chmod 755 %s; GNUPLOT=%s %s report %s -o %s", page_path("idle"), page_path("idle"), ROTID_PROGRAM,
                              page_path("paper.json"), page_path("none")),
                     1);
    assert_non_null(strstr(page_err, "gnuplot wrote no complete picture"));
}

static void an_interrupt_leaves_nothing_behind(void **state)
{
    (void)state;
    make_result("identify", PAPER, "paper.json");
    page_write_file("slow", "#!/bin/sh\n[ \"$1\" = --version ] && { echo gnuplot 5.4 patchlevel 0; exit 0; }\nexec sleep 30\n");
    double begin = clock_seconds();
    assert_int_equal(page_run("chmod 755 %s; GNUPLOT=%s %s report %s -o %s & sleep 0.7; kill -INT $!; wait $!", page_path("slow"),
                              page_path("slow"), ROTID_PROGRAM, page_path("paper.json"), page_path("stopped")),
                     1);
    assert_true(clock_seconds() - begin < 15);
    assert_non_null(strstr(page_err, "interrupted; "));
    assert_int_equal(page_count("", "stopped"), 0); /* nor anything beside it */
}

/* ------------------------------------------------------------------------------------------------ whose files */

static void nothing_of_anybody_else_is_written_over(void **state)
{
    (void)state;
    make_result("identify", PAPER, "paper.json");
    const char *report = "%s %s report %s -o %s";
    page_write_file("file", "mine");
    assert_int_equal(page_run(report, page_stand_in(NULL), ROTID_PROGRAM, page_path("paper.json"), page_path("file")), 2);
    assert_non_null(strstr(page_err, "is a file, expected a folder or a new name"));
    assert_string_equal(page_read("file"), "mine");
    /* a page that somebody else wrote */
    assert_int_equal(page_run("mkdir %s", page_path("site")), 0);
    page_write_file("site/index.html", "<!DOCTYPE html><title>mine</title>");
    assert_int_equal(page_run(report, page_stand_in(NULL), ROTID_PROGRAM, page_path("paper.json"), page_path("site")), 2);
    assert_non_null(strstr(page_err, "its index.html is no page of rotid"));
    assert_string_equal(page_read("site/index.html"), "<!DOCTYPE html><title>mine</title>");
    assert_int_equal(page_count("site", ""), 1);
    /* a picture of the same name, without a page */
    assert_int_equal(page_run("mkdir -p %s", page_path("draft/figures")), 0);
    page_write_file("draft/figures/rotor.svg", "mine");
    assert_int_equal(page_run(report, page_stand_in(NULL), ROTID_PROGRAM, page_path("paper.json"), page_path("draft")), 2);
    assert_non_null(strstr(page_err, "rotor.svg: there is a file of that name"));
    assert_string_equal(page_read("draft/figures/rotor.svg"), "mine");
    /* a folder with other things in it gets a page, and a second one in its place; the other things stay */
    assert_int_equal(page_run("mkdir %s", page_path("home")), 0);
    page_write_file("home/notes.txt", "mine");
    for (int i = 0; i < 2; i++) {
        assert_int_equal(page_run(report, page_stand_in(NULL), ROTID_PROGRAM, page_path("paper.json"), page_path("home")), 0);
        assert_string_equal(page_read("home/notes.txt"), "mine");
        assert_int_equal(page_count("home", ""), 3);
        assert_int_equal(page_count("home/figures", ""), 21);
    }
}

/* Another one who may write into the folder puts links there. */
static void no_link_in_the_folder_is_followed(void **state)
{
    (void)state;
    make_result("identify", PAPER, "paper.json");
    const char *report = "%s %s report %s -o %s";
    assert_int_equal(page_run("cd %s; mkdir elsewhere shared linked; ln -s ../elsewhere shared/figures", page_path("")), 0);
    assert_int_equal(page_run(report, page_stand_in(NULL), ROTID_PROGRAM, page_path("paper.json"), page_path("shared")), 2);
    assert_non_null(strstr(page_err, "shared: its figures is a symbolic link, which is not followed, expected a folder or none"));
    assert_int_equal(page_count("elsewhere", ""), 0);
    assert_int_equal(page_count("shared", ""), 1);
    /* also where it comes behind the look at the folder, while the figures are drawn */
    char text[1024];
    (void)snprintf(text, sizeof text,
                   "#!/bin/sh\n[ \"$1\" = --version ] && { echo gnuplot 5.4 patchlevel 0; exit 0; }\n"
                   "ln -sfn ../elsewhere %s\nexit 0\n",
                   page_path("linked/figures"));
    page_write_file("linker", text);
    assert_int_equal(page_run("chmod 755 %s; GNUPLOT=%s %s report %s -o %s", page_path("linker"), page_path("linker"),
                              ROTID_PROGRAM, page_path("paper.json"), page_path("linked")),
                     3);
    assert_non_null(strstr(page_err, "cannot write"));
    assert_int_equal(page_count("elsewhere", ""), 0);
    assert_int_equal(page_count("linked", ""), 1);
    /* a page that is a link to one of rotid, and pictures that are links */
    assert_int_equal(page_run(report, page_stand_in(NULL), ROTID_PROGRAM, page_path("paper.json"), page_path("elsewhere/true")),
                     0);
    assert_int_equal(page_run("cd %s; mkdir page; ln -s ../elsewhere/true/index.html page/index.html", page_path("")), 0);
    assert_int_equal(page_run(report, page_stand_in(NULL), ROTID_PROGRAM, page_path("paper.json"), page_path("page")), 2);
    assert_non_null(strstr(page_err, "its index.html is no page of rotid"));
    assert_int_equal(
        page_run("cd %s/elsewhere/true/figures; echo mine > ../../mine; ln -sf ../../mine rotor.svg; ln -sf ../../mine "
                 "rotor.gp; ln -sf ../../none rotor.pdf",
                 page_path("")),
        0);
    /* the folder itself may be a link: its user says so */
    assert_int_equal(page_run("cd %s; ln -s elsewhere/true by-link", page_path("")), 0);
    assert_int_equal(page_run(report, page_stand_in(NULL), ROTID_PROGRAM, page_path("paper.json"), page_path("by-link")), 0);
    assert_string_equal(page_read("elsewhere/mine"), "mine\n");
    assert_false(page_exists("elsewhere/none"));
    assert_int_equal(page_run("cd %s; find elsewhere -type l; ls -A elsewhere/true/figures | grep -v -x .files | wc -l", page_path("")), 0);
    assert_string_equal(page_out, "21\n");
}

/* gnuplot runs in the folder of the figures, wherever it was named from. */
static void gnuplot_may_be_named_from_here(void **state)
{
    (void)state;
    make_result("identify", PAPER, "paper.json");
    (void)page_stand_in(NULL);
    assert_int_equal(page_run("cd %s; GNUPLOT=./stand-in %s report paper.json -o from-here", page_path(""), ROTID_PROGRAM), 0);
    assert_int_equal(page_times(page_read("from-here/index.html"), "<img "), 14);
}

static void a_folder_that_cannot_be_written_is_said(void **state)
{
    (void)state;
    make_result("identify", PAPER, "paper.json");
    assert_int_equal(page_run("%s %s report %s -o /nowhere/at/all", page_stand_in(NULL), ROTID_PROGRAM, page_path("paper.json")),
                     3);
    assert_non_null(strstr(page_err, "cannot write /nowhere/at/all: No such file or directory"));
    assert_int_equal(page_run("%s report %s", ROTID_PROGRAM, page_path("paper.json")), 2);
    assert_non_null(strstr(page_err, "report: expected -o FOLDER"));
    assert_int_equal(page_run("%s report -o %s", ROTID_PROGRAM, page_path("x")), 2);
    assert_int_equal(page_run("%s report %s --json - -o %s", ROTID_PROGRAM, page_path("paper.json"), page_path("x")), 2);
    assert_int_equal(page_run("%s identify %s %s", ROTID_PROGRAM, PAPER, SOLID), 2);
    assert_non_null(strstr(page_err, "is one argument too many"));
    /* figures where a file stands in the way */
    assert_int_equal(page_run("mkdir %s", page_path("blocked")), 0);
    page_write_file("blocked/figures", "mine");
    assert_int_equal(
        page_run("%s %s report %s -o %s", page_stand_in(NULL), ROTID_PROGRAM, page_path("paper.json"), page_path("blocked")), 2);
    assert_int_equal(page_count("blocked", ""), 1);
    assert_false(page_exists("x"));
    /* a name with a quote and a blank; one with a slash at its end */
    assert_int_equal(page_run("%s %s report %s -o \"%s/\"", page_stand_in(NULL), ROTID_PROGRAM, page_path("paper.json"),
                              page_path("it's a page")),
                     0);
    assert_int_equal(page_problems(page_read("it's a page/index.html")), 0);
    assert_int_equal(page_times(page_read("it's a page/index.html"), "<img "), 14);
}

/* ------------------------------------------------------------------------------------------------ texts of others */

static void replace_text(cJSON *object, const char *key, const char *text)
{
    cJSON_ReplaceItemInObject(object, key, cJSON_CreateString(text));
}

static void a_text_in_a_deck_stays_a_text(void **state)
{
    (void)state;
    static const char hostile[] =
        "<script>alert(1)</script> & \"q\" it's \xc3\xa9\xe2\x82\xac\n`touch pwned` @name $x } { # \xff\xfe \x01 ]]> -->";
    make_result("identify", PAPER, "paper.json");
    cJSON *json = page_json("paper.json"), *geometry = cJSON_GetObjectItem(json, "geometry");
    cJSON_ReplaceItemInArray(cJSON_GetObjectItem(json, "heading"), 0, cJSON_CreateString(hostile));
    replace_text(json, "deck", hostile);
    replace_text(json, "commit", hostile);
    replace_text(json, "stop_reason", hostile);
    replace_text(cJSON_GetArrayItem(cJSON_GetObjectItem(json, "parameters"), 0), "name", hostile);
    replace_text(cJSON_GetArrayItem(cJSON_GetObjectItem(json, "parameters"), 0), "unit", hostile);
    replace_text(cJSON_GetArrayItem(cJSON_GetObjectItem(json, "baseline"), 0), "result", hostile);
    cJSON_AddItemToArray(cJSON_GetObjectItem(json, "warnings"), cJSON_CreateString(hostile));
    cJSON *group = cJSON_GetArrayItem(cJSON_GetObjectItem(geometry, "groups"), 1);
    replace_text(group, "name", hostile);
    replace_text(cJSON_GetObjectItem(group, "material"), "name", hostile);
    page_write_json("hostile.json", json);
    cJSON_Delete(json);
    for (int real = 0; real < 2; real++) {
        if (real && page_run("gnuplot --version") != 0)
            break; /* said by the test of the real one */
        assert_int_equal(page_run("cd %s; %s %s report hostile.json -o hostile", page_path(""), real ? "" : page_stand_in(NULL),
                                  ROTID_PROGRAM),
                         0);
        const char *html = page_read("hostile/index.html");
        assert_int_equal(page_problems(html), 0);
        assert_says(html, "&lt;script&gt;alert(1)&lt;/script&gt; &amp; &quot;q&quot; it&#39;s \xc3\xa9\xe2\x82\xac");
        assert_null(strstr(html, "<script"));
        assert_null(strchr(html, 1));
        assert_null(strchr(html, 0xff));
        const char *script = page_read("hostile/figures/rotor.gp");
        assert_non_null(strstr(script, "it\xe2\x80\x99s"));
        assert_null(strstr(script, "\n`touch"));
        assert_false(page_exists("pwned") || page_exists("hostile/pwned") || page_exists("hostile/figures/pwned"));
    }
    /* units that would end a text of a script, and that would name a typeface: the unit of transfer functions is one of few words
     */
    static const char *const units[] = {"'\nsystem('touch pwned')\n#", "{/X\"><script>alert(1)</script> y}",
                                        "{/X\" onload=\"alert(1) y}", "^{/:Bold a}_b"};
    make_result("frf", PAPER, "frf.json");
    for (size_t i = 0; i < sizeof units / sizeof *units; i++) {
        json = page_json("frf.json");
        replace_text(json, "unit", units[i]);
        page_write_json("unit.json", json);
        cJSON_Delete(json);
        assert_int_equal(page_run("cd %s; %s report unit.json -o unit", page_path(""), ROTID_PROGRAM), 2);
        assert_says(page_err, "unit: is '");
        assert_false(page_exists("unit") || page_exists("pwned"));
    }
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
static void a_large_result_makes_a_page_of_less_than_five_megabytes(void **state)
{
    (void)state;
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
    int real = page_run("gnuplot --version") == 0;
    double begin = clock_seconds();
    assert_int_equal(page_run("%s %s report %s -o %s", real ? "" : page_stand_in(NULL), ROTID_PROGRAM, page_path("large.json"),
                              page_path("large")),
                     0);
    assert_true(clock_seconds() - begin < 20); /* two on an idle machine, valgrind apart */
    const char *html = page_read("large/index.html");
    assert_int_equal(page_problems(html), 0);
    assert_true(strlen(html) < 5000000);
}

/* The stand-in draws nothing: the scripts have to run in the real one, where there is one. */
static void the_real_gnuplot_draws_every_figure(void **state)
{
    (void)state;
    if (page_run("gnuplot --version") != 0) {
        print_message("no gnuplot: its run over every script is left out\n");
        skip();
    }
    static const char *const decks[] = {"paper_rotor", "solid_rotor", "brake_reuss_beam", "roving_hammer_beam"};
    for (size_t i = 0; i < sizeof decks / sizeof *decks; i++) {
        assert_int_equal(
            page_run("cd %s; for c in identify modes sensitivity; do %s $c %s/input/%s.inp --quiet --json $c.json || exit 9; "
                     "done; %s report identify.json modes.json sensitivity.json -o real",
                     page_path(""), ROTID_PROGRAM, ROTID_SOURCE_DIR, decks[i], ROTID_PROGRAM),
            0);
        const char *html = page_read("real/index.html");
        assert_string_equal(page_err, "");
        assert_int_equal(page_problems(html), 0);
        assert_int_equal(page_times(html, "<img "), 2 * page_times(html, "<figure "));
        assert_true(page_count("real/figures", "") == 3 * page_times(html, "<figure ") || i > 0); /* the same folder four times */
    }
    /* a script is complete: a user runs it alone, where it stands; in the locale C gnuplot warns that it knows no degree sign */
    assert_int_equal(page_run("cd %s && rm *.svg *.pdf && LC_ALL=C.UTF-8 gnuplot shapes.gp", page_path("real/figures")), 0);
    assert_string_equal(page_err, "");
    assert_true(page_exists("real/figures/shapes.svg"));
    assert_false(page_exists("real/figures/shapes-narrow.svg"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_page_is_whole_and_says_what_the_result_holds),
        cmocka_unit_test(further_results_add_their_sections),
        cmocka_unit_test(a_model_that_is_not_adequate_is_called_that),
        cmocka_unit_test(an_older_result_says_what_it_lacks),
        cmocka_unit_test(without_gnuplot_the_numbers_stand_in_tables),
        cmocka_unit_test(a_figure_that_fails_costs_no_other),
        cmocka_unit_test(an_interrupt_leaves_nothing_behind),
        cmocka_unit_test(nothing_of_anybody_else_is_written_over),
        cmocka_unit_test(no_link_in_the_folder_is_followed),
        cmocka_unit_test(gnuplot_may_be_named_from_here),
        cmocka_unit_test(a_folder_that_cannot_be_written_is_said),
        cmocka_unit_test(a_text_in_a_deck_stays_a_text),
        cmocka_unit_test(a_large_result_makes_a_page_of_less_than_five_megabytes),
        cmocka_unit_test(the_real_gnuplot_draws_every_figure),
    };
    return cmocka_run_group_tests(tests, page_bench_open, page_bench_close);
}
