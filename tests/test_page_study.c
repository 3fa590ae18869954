/* Pages of studies: what they count and draw is counted here anew, from the lines of the file of results. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cJSON.h>

#include "json_value.h"
#include "page/by_modes.h"
#include "page/figures_study.h"
#include "page/page.h"
#include "page_bench.h"
#include "study/stamp.h"
#include "study_bench.h"
#include "support.h"

#define PAPER ROTID_SOURCE_DIR "/input/paper_rotor.inp"

static const cJSON *parameter(const cJSON *run, int p)
{
    const cJSON *item = cJSON_GetArrayItem(get(run, "parameters"), p);
    assert_non_null(item);
    return item;
}

static const char *const starts_plan = "*STUDY\n*DECKS\nbeam.inp\n*VARIANT, NAME=both\n*VARIANT, NAME=of "
                                       "likelihood\nFIT.FUNCTIONAL=HYBRID_F\n*MODES\n1-3\n1-4\n1-6\n"
                                       "*STARTS, SPREAD=0.5, GRID=3\n";

static void starts_and_numbers_of_modes_are_drawn_with_their_ends(void **state)
{
    (void)state;
    page_make_study("starts", starts_plan);
    cJSON *runs = page_runs("starts.jsonl"), *run;
    const char *html = page_made("starts.jsonl");
    assert_int_equal(cJSON_GetArraySize(runs), 2 * 3 * 9);
    page_says(html, "<h1>Study starts.plan</h1>");
    page_says(html, "54 identifications: none failed, all converged. Every start leads to the same minimum in its cell.");
    page_says(html, "9 iterations (both, modes 1-6), started within \xc2\xb1"
                    "50\xc2\xa0%% of core.E = 200\xc2\xa0GPa, left.E = 200\xc2\xa0GPa: all end at the same minimum, core.E = ");
    /* mean functional over the square of the number of fitted modes */
    double sum = 0;
    int count = 0;
    cJSON_ArrayForEach(run, runs)
    {
        const cJSON *cell = get(run, "cell");
        if (strcmp(get(cell, "variant")->valuestring, "both") != 0 || strcmp(get(cell, "modes")->valuestring, "1-3") != 0)
            continue;
        sum += number_of(run, "objective");
        count++;
    }
    assert_int_equal(count, 9);
    double mean = sum / count / 9;
    int power = (int)floor(log10(mean));
    if (power < -3 && power > -8)
        page_says(html, "both %.2fe%d with 3 modes", mean / pow(10, power), power);
    else
        page_says(html, "both %.*f with 3 modes", 2 - power, mean);
    static const char *const figures[] = {"starts", "functional-by-modes", "parameters-by-modes"};
    for (size_t i = 0; i < sizeof figures / sizeof *figures; i++)
        page_says(html, "<figure id=\"%s\">", figures[i]);
    assert_null(strstr(html, "<figure id=\"coverage\">")); /* no truth */
    page_says(html, "of likelihood, modes 1-4");
    /* one row of the table of the starts for each run, and each start of the file in it */
    page_says(html, "Small dots are the iterates between.");
    const char *table = strstr(html, "id=\"starts-numbers\"");
    assert_non_null(table);
    page_says(table, "<td class=\"n\">100.0</td><td class=\"n\">300.0</td>");
    cJSON_Delete(runs);
}

static const char *const truth_plan =
    "*STUDY, REPLICATES=40\n*DECKS\nbeam.inp\n*DATA, SOURCE=MODEL\n*TRUTH\ncore.E, 1.8e11, 2.2e11\n"
    "left.E, 2e11\n*NOISE\n0.001\n0.003\n";

static void intervals_are_counted_against_the_truth(void **state)
{
    (void)state;
    page_make_study("truth", truth_plan);
    cJSON *runs = page_runs("truth.jsonl"), *run;
    const char *html = page_made("truth.jsonl");
    int held[2] = {0, 0}, all = 0, count = 0;
    double sum = 0;
    cJSON_ArrayForEach(run, runs)
    {
        int first = number_of(get(run, "cell"), "noise_frequency") < 0.002;
        for (int p = 0; p < 2; p++) {
            const cJSON *item = parameter(run, p), *ci = get(item, "ci95");
            double truth = number_of(item, "truth");
            int holds = cJSON_GetArrayItem(ci, 0)->valuedouble <= truth && truth <= cJSON_GetArrayItem(ci, 1)->valuedouble;
            all += holds;
            held[p] += first && holds;
            if (first && p == 0) {
                sum += (number_of(item, "value") - truth) / number_of(item, "std");
                count++;
            }
        }
    }
    assert_int_equal(count, 40);
    page_says(html, "Of 160 95\xc2\xa0%% intervals %.1f\xc2\xa0%% hold the truth.", 100.0 * all / 160);
    page_says(html, "core.E: mean %s%.2f, deviation ", sum < 0 ? "\xe2\x88\x92" : "+", fabs(sum / count));
    page_says(html, "%d of 40 intervals hold the truth; left.E: mean ", held[0]);
    page_says(html, "%d of 40 intervals hold the truth. Where the fits", held[1]);
    page_says(html, "<figure id=\"coverage\">");
    page_says(html, "noise 0.003");
    assert_null(strstr(html, "<figure id=\"starts\">"));
    cJSON_Delete(runs);
}

static void a_summary_says_what_it_does_not_hold(void **state)
{
    (void)state;
    page_make_study("truth", truth_plan);
    const char *html = page_made("truth.json");
    page_says(html, "truth.json is a summary.");
    page_says(html, "<figure id=\"coverage\">");
    assert_null(strstr(html, "<figure id=\"errors-of-runs\">"));
    /* beside another result it adds its section, and the answer stays that of the first */
    assert_int_equal(page_run("cd %s; %s identify beam.inp --quiet --json fit.json; %s %s report fit.json starts.jsonl -o both",
                              page_path(""), ROTID_PROGRAM, page_stand_in(NULL), ROTID_PROGRAM),
                     0);
    html = page_read("both/index.html");
    assert_int_equal(page_problems(html), 0);
    page_says(html, "<section id=\"study\">");
    page_says(html, "<figure id=\"starts\">");
    page_says(html, "<p class=\"says\">core.E = ");
}

static void verdicts_are_counted(void **state)
{
    (void)state;
    static const char *const score[] = {"right", "quiet", "in_set", "silent", "wrong", "false_alarm"};
    static const char *const says[] = {"right",  "rightly quiet", "in the set that cannot be told apart",
                                       "silent", "wrong",         "false alarms"};
    page_make_study("hidden",
                    "*STUDY, COMMAND=DIAGNOSE, REPLICATES=3, BOOTSTRAP=100\n*DECKS\nbeam.inp\n*DATA, SOURCE=MODEL\n*NOISE\n"
                    "0.001, 0.01\n*HIDE, TYPE=NONE, NAME=control\n*HIDE, TYPE=DENSITY, NAME=a <core>, GROUP=core\nfactor, 1.2\n");
    cJSON *runs = page_runs("hidden.jsonl"), *run;
    const char *html = page_made("hidden.jsonl");
    int kinds = 0;
    page_says(html, "Of 6 diagnoses: ");
    for (size_t k = 0; k < sizeof score / sizeof *score; k++) {
        int count = 0;
        cJSON_ArrayForEach(run, runs) count += !strcmp(get(run, "score")->valuestring, score[k]);
        kinds += count > 0;
        if (count)
            page_says(html, "%d %s", count, says[k]);
    }
    assert_true(kinds >= 1);
    page_says(html, "<figure id=\"verdicts\">");
    page_says(html, "a &lt;core&gt;");
    assert_null(strstr(html, "<core>"));
    cJSON_Delete(runs);
}

static void many_decks_stand_beside_each_other(void **state)
{
    (void)state;
    char list[256] = "";
    for (int i = 0; i < 5; i++) {
        char name[32], text[2048];
        (void)snprintf(name, sizeof name, "deck%d.inp", i);
        (void)snprintf(text, sizeof text,
                       BENCH_BEAM "*MODES\n1, %g\n2, 713.5\n3, 1722\n4, 2480\n5, 3970\n6, 5020\n" BENCH_SENSORS BENCH_WANTED,
                       398.9 + i);
        page_write_file(name, text);
        (void)snprintf(list + strlen(list), sizeof list - strlen(list), " %s", name);
    }
    page_write_file("broken.inp", "*MATERIAL, NAME=a\n");
    assert_int_equal(page_run("cd %s; %s study%s broken.inp -o decks.jsonl --quiet", page_path(""), ROTID_PROGRAM, list), 1);
    const char *html = page_made("decks.jsonl");
    page_says(html, "class=\"answer care\"");
    page_says(html, "6 identifications: 1 failed, 0 did not converge.");
    page_says(html, "<p>One failed: ");
    page_says(html, "<figure id=\"decks\">");
    page_says(html, "deck3.inp");
    page_says(html, "A point with its interval for each of 5 decks.");
}

/* ------------------------------------------------------------------------------------------------------------ broken files */

/* The file of results with its second line stamped anew. */
static char *stamp_second(const char *text)
{
    struct pool pool;
    struct header header;
    char study[DIGEST_LETTERS + 1];
    const char *line = strchr(text, '\n') + 1, *end = strchr(line, '\n') + 1, *stamp = strstr(line, ",\"study\":\"");
    cJSON *json = cJSON_ParseWithLength(text, (size_t)(line - text));
    pool_open(&pool, NULL);
    assert_true(stamp && stamp < end && !results_header_read(&pool, json, &header));
    cJSON_Delete(json);
    stamp_study(&header, study);
    char *stamped = stamp_line(study, pool_format(&pool, "%.*s}\n", (int)(stamp - line), line));
    char *all = strdup(pool_format(&pool, "%.*s%s%s", (int)(line - text), text, stamped, end));
    free(stamped);
    pool_close(&pool);
    return all;
}

static void assert_refused(const char *text, const char *says)
{
    page_write_file("broken.jsonl", text);
    assert_int_equal(page_run("cd %s; %s report broken.jsonl -o broken", page_path(""), ROTID_PROGRAM), 2);
    if (!strstr(page_err, says))
        print_error("expected '%s', got '%s'\n", says, page_err);
    assert_non_null(strstr(page_err, says));
    assert_false(page_exists("broken"));
}

/* What a study leaves that was stopped before its first run ended. */
static void a_file_of_results_without_a_run_is_told_so(void **state)
{
    (void)state;
    page_make_study("truth", truth_plan);
    const char *whole = page_read("truth.jsonl");
    char header[2048];
    (void)snprintf(header, sizeof header, "%.*s", (int)(strchr(whole, '\n') + 1 - whole), whole);
    assert_refused(header, "broken.jsonl: is the file of results of a study and holds no run yet, expected the line of a run");
}

static void broken_lines_are_told_with_their_place(void **state)
{
    (void)state;
    page_make_study("truth", truth_plan);
    static const struct {
        const char *from, *to, *says;
    } wrong[] = {
        {"\"status\":\"converged\"", "\"status\":\"perhaps\"",
         "2:1: this line is no result: status: is 'perhaps', expected converged, at_bound, not_converged or failed"},
        {"\"objective\":", "\"objective\":\"x\",\"y\":", "2:1: this line is no result: objective: is a text, expected a number"},
        {"\"parameters\":[{", "\"parameters\":[7,{",
         "2:1: this line is no result: parameters[0]: is a number, expected an object"},
        {"\"modes\":[", "\"modes\":7,\"y\":[", "2:1: this line is no result: modes: is a number, expected a list"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        const char *whole = page_read("truth.jsonl"), *at = strstr(strchr(whole, '\n'), wrong[i].from);
        assert_non_null(at);
        char *broken = malloc(strlen(whole) + strlen(wrong[i].to) + 1);
        assert_non_null(broken);
        (void)sprintf(broken, "%.*s%s%s", (int)(at - whole), whole, wrong[i].to, at + strlen(wrong[i].from)); /* NOLINT: fits */
        char *forged = stamp_second(broken);
        assert_refused(broken, "broken.jsonl:2:1: this line is not as rotid wrote it");
        assert_refused(forged, wrong[i].says);
        free(broken);
        free(forged);
    }
    page_write_file("other.jsonl", "{\"a\": 1}\n{\"b\": 2}\n");
    assert_int_equal(page_run("cd %s; %s report other.jsonl -o broken", page_path(""), ROTID_PROGRAM), 2);
    assert_non_null(strstr(page_err, "other.jsonl: has a value a line and is no file of results"));
    /* killed while it wrote: what is whole is shown, and that something is missing said */
    const char *whole = page_read("truth.jsonl");
    char *cut = strdup(whole);
    assert_non_null(cut);
    cut[strlen(cut) / 2] = 0;
    page_write_file("cut.jsonl", cut);
    free(cut);
    assert_int_equal(page_run("cd %s; %s %s report cut.jsonl -o cut", page_path(""), page_stand_in(NULL), ROTID_PROGRAM), 0);
    assert_non_null(strstr(page_err, "cut.jsonl: the last line is not complete and left out"));
    page_says(page_read("cut/index.html"), " of 80 runs</p>");
    page_says(page_read("cut/index.html"), "class=\"answer care\"");
}

/* --------------------------------------------------------------------------------------------------------------- routines */

static void runs_are_sorted_into_series_by_their_modes(void **state)
{
    (void)state;
    struct told_cell cell[] = {{.label = "one, modes 1-4", .but_modes = "one"},
                               {.label = "one, modes 1-2", .but_modes = "one"},
                               {.label = "two, modes 1-2", .but_modes = "two"}};
    for (int i = 0; i < 3; i++)
        cell[i].is.cell = (struct study_axes){.deck = "a",
                                              .variant = i < 2 ? "one" : "two",
                                              .modes = i < 1 ? "1-4" : "1-2",
                                              .noise_frequency = NAN,
                                              .noise_shape = NAN};
    struct told_run run[] = {{.cell = 0, .fitted = 4, .objective = 32},
                             {.cell = 0, .fitted = 4, .objective = 16},
                             {.cell = 1, .fitted = 2, .objective = 4},
                             {.cell = 2, .fitted = 2, .objective = 8},
                             {.cell = 2, .fitted = 2, .objective = 800, .status = STUDY_NOT_CONVERGED},
                             {.cell = 2, .status = STUDY_FAILED, .objective = NAN}};
    struct study_outcome study = {.is = {.ncells = 3}, .nrun = 6, .cell = cell, .run = run};
    struct by_modes by;
    assert_status(by_modes_make(&test_pool, &study, &by), ROTID_OK);
    assert_int_equal(by.nseries, 2);
    assert_int_equal(by.series[0].count, 2);
    assert_string_equal(by.series[0].name, "one");
    assert_int_equal(by.series[0].point[0].fitted, 2); /* by rising number */
    assert_close(by.series[0].point[0].functional, 1, 1e-15, 0);
    assert_close(by.series[0].point[1].functional, 24 / 16.0, 1e-15, 0);
    assert_close(by.series[1].point[0].functional, 2, 1e-15, 0);
    study.nrun = 0; /* a summary */
    assert_status(by_modes_make(&test_pool, &study, &by), ROTID_OK);
    assert_int_equal(by.nseries, 0);
}

/* A name that reads like that of an axis is cut out of no label. */
static void a_variant_may_be_named_like_an_axis(void **state)
{
    (void)state;
    page_make_study("named", "*STUDY\n*DECKS\nbeam.inp\n*VARIANT, NAME=xmodes 1\n*VARIANT, NAME=of "
                             "likelihood\nFIT.FUNCTIONAL=HYBRID_F\n*MODES\n1-3\n1-4\n");
    const char *html = page_made("named.jsonl"),
               *caption = strstr(html, "Mean functional for each pair of modes at the optimum: xmodes 1 ");
    assert_non_null(caption);
    page_says(caption, " with 3 modes, ");
    page_says(caption, "; of likelihood ");
    assert_null(strstr(page_read("page-named.jsonl/figures/functional-by-modes.gp"), "'xmodes 1, modes"));
}

/* One parameter many times in a cell: no rotid writes that. The reader refuses it, and the figure has room for it all the same.
 */
static void a_parameter_that_stands_again_is_refused(void **state)
{
    (void)state;
    enum { AGAIN = 2000 };
    page_make_study("truth", truth_plan);
    cJSON *json = page_json("truth.json"), *first = cJSON_GetArrayItem(get(json, "cells"), 0),
          *list = cJSON_GetObjectItem(first, "parameters");
    for (int i = 0; i < AGAIN; i++)
        cJSON_AddItemToArray(list, cJSON_Duplicate(cJSON_GetArrayItem(list, 0), 1));
    page_write_json("again.json", json);
    cJSON_Delete(json);
    assert_int_equal(page_run("cd %s; %s %s report again.json -o again", page_path(""), page_stand_in(NULL), ROTID_PROGRAM), 2);
    assert_non_null(strstr(page_err, "again.json: cells[0].parameters[2]: name: is 'core.E' as in parameters[0], expected each "
                                     "parameter once"));
    assert_false(page_exists("again"));
    static struct cell_parameter parameter[2][AGAIN];
    struct told_cell cell[2] = {{.label = "one", .is = {.nparameters = AGAIN, .parameters = parameter[0]}},
                                {.label = "two", .is = {.nparameters = AGAIN, .parameters = parameter[1]}}};
    for (int i = 0; i < 2 * AGAIN; i++)
        parameter[i / AGAIN][i % AGAIN] = (struct cell_parameter){
            .name = i % 3 ? "a" : "b", .unit = "1", .coverage95 = i < AGAIN ? 0.9 : 0.875, .intervals = 40};
    struct study_outcome study = {.is = {.ncells = 2}, .cell = cell};
    struct result result = {.file = "again.json", .studied = &study};
    struct document document;
    document_open(&document, &test_pool);
    document_section(&document, "study", "Study");
    figure_coverage(&document, &result);
    assert_false(document.failed);
    const char *script = document_figures(&document)[0]->script;
    assert_non_null(strstr(script, "$coverage << end\n2 90 90\n1 87.5 87.5\nend\n"));
}

/* Memory of the pool that ends after n blocks, while the lines are read and composed. */
static void memory_that_runs_out_is_survived(void **state)
{
    (void)state;
    long served = 0;
    page_make_study("starts", starts_plan);
    for (long n = 0; n == 0 || n <= served; n += 1 + n / 9) { /* 0: counts */
        struct failing_allocator failing;
        struct pool pool;
        struct message_list messages;
        struct result result;
        struct document document;
        failing_allocator_open(&failing, n);
        pool_open(&pool, &failing.allocator);
        message_open(&messages, &pool);
        int status = page_result_read(&pool, page_path("starts.jsonl"), &messages, &result);
        if (!status) {
            document_open(&document, &pool);
            page_compose(&document, 1, &result);
            assert_true(n > 0 || !document.failed);
        } else {
            assert_true(n > 0);
        }
        served = n ? served : failing.served;
        pool_close(&pool);
        assert_int_equal(failing.in_use, 0);
    }
    assert_true(served > 150);
}

static void the_real_gnuplot_draws_them(void **state)
{
    (void)state;
    if (page_run("gnuplot --version") != 0) {
        print_message("no gnuplot: its run over every script is left out\n");
        skip();
    }
    static const char *const names[] = {"starts", "truth", "hidden", "decks"};
    page_make_study("starts", starts_plan);
    page_make_study("truth", truth_plan);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char path[64];
        assert_int_equal(page_run("cd %s; %s report %s.jsonl -o real-%s", page_path(""), ROTID_PROGRAM, names[i], names[i]), 0);
        assert_string_equal(page_err, "");
        (void)snprintf(path, sizeof path, "real-%s/index.html", names[i]);
        assert_int_equal(page_times(page_read(path), "<img "), 2 * page_times(page_read(path), "<figure "));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(starts_and_numbers_of_modes_are_drawn_with_their_ends),
        cmocka_unit_test(intervals_are_counted_against_the_truth),
        cmocka_unit_test(a_summary_says_what_it_does_not_hold),
        cmocka_unit_test(verdicts_are_counted),
        cmocka_unit_test(many_decks_stand_beside_each_other),
        cmocka_unit_test(a_file_of_results_without_a_run_is_told_so),
        cmocka_unit_test(broken_lines_are_told_with_their_place),
        cmocka_unit_test_setup_teardown(runs_are_sorted_into_series_by_their_modes, open_test_pool, close_test_pool),
        cmocka_unit_test(a_variant_may_be_named_like_an_axis),
        cmocka_unit_test_setup_teardown(a_parameter_that_stands_again_is_refused, open_test_pool, close_test_pool),
        cmocka_unit_test(memory_that_runs_out_is_survived),
        cmocka_unit_test(the_real_gnuplot_draws_them),
    };
    return cmocka_run_group_tests(tests, page_bench_open, page_bench_close);
}
