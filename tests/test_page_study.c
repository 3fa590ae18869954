/* Pages of studies: what they count and draw is counted here anew, from the lines of the file of results. */
#include <cJSON.h>

#include "json_value.h"
#include "page/page.h"
#include "page_bench.h"
#include "study/study.h"
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

static const char *const truth_plan =
    "*STUDY, REPLICATES=40\n*DECKS\nbeam.inp\n*DATA, SOURCE=MODEL\n*TRUTH\ncore.E, 1.8e11, 2.2e11\n"
    "left.E, 2e11\n*NOISE\n0.001\n0.003\n";

UNIT_TEST(intervals_are_counted_against_the_truth)
{
    page_make_study("truth", truth_plan);
    cJSON *runs = page_runs("truth.jsonl"), *run;
    const char *html = page_made("truth.jsonl");
    int held[2] = {0, 0}, all = 0, count = 0;
    cJSON_ArrayForEach(run, runs)
    {
        int first = number_of(get(run, "cell"), "noise_frequency") < 0.002;
        for (int p = 0; p < 2; p++) {
            const cJSON *item = parameter(run, p), *ci = get(item, "ci95");
            double truth = number_of(get(run, "truth"), get(item, "name")->valuestring);
            int holds = cJSON_GetArrayItem(ci, 0)->valuedouble <= truth && truth <= cJSON_GetArrayItem(ci, 1)->valuedouble;
            all += holds;
            held[p] += first && holds;
            count += first && p == 0;
        }
    }
    assert_int_equal(count, 40);
    page_says(html, "Of 160 95\xc2\xa0%% intervals %.1f\xc2\xa0%% hold the truth.", 100.0 * all / 160);
    cJSON *summary = page_json("truth.json");
    const cJSON *cell = cJSON_GetArrayItem(get(summary, "cells"), 0);
    for (int p = 0; p < 2; p++) /* the summary, from which figure and table are made */
        assert_close(number_of(cJSON_GetArrayItem(get(cell, "parameters"), p), "coverage95"), held[p] / 40.0, 1e-12, 0);
    page_says(html, "<td class=\"n\">%.1f</td>", 100.0 * held[0] / 40);
    cJSON_Delete(summary);
    page_says(html, ">0.003</th>");
    cJSON_Delete(runs);
}

UNIT_TEST(a_summary_says_what_it_does_not_hold)
{
    page_make_study("truth", truth_plan);
    const char *html = page_made("truth.json");
    page_says(html, "truth.json is a summary.");
    assert_null(strstr(html, "\"runs\":[{"));
    /* beside another result it adds its section, and the answer of the fit stands there */
    assert_int_equal(page_run("cd %s; %s identify beam.inp --quiet --json fit.json; %s report fit.json truth.jsonl -o both.html",
                              page_path(""), ROTID_PROGRAM, ROTID_PROGRAM),
                     0);
    html = page_read("both.html");
    assert_int_equal(page_problems(html), 0);
    page_says(html, "<section id=\"study\">");
    page_says(html, "<p class=\"says\">core.E = ");
}

/* Runs in the data of the page: all of few, evenly thinned of many; with what figures show and no more. */
POOL_TEST(runs_are_in_the_data_of_the_page)
{
    page_make_study("truth", truth_plan);
    const char *html = page_made("truth.jsonl"), *data = strstr(html, "id=\"data\">") + strlen("id=\"data\">");
    cJSON *json = cJSON_Parse(pool_format(&test_pool, "%.*s", (int)(strstr(data, "</script>") - data), data)), *run,
          *lines = page_runs("truth.jsonl");
    assert_non_null(json);
    const cJSON *entry = cJSON_GetArrayItem(json, 0), *runs = get(entry, "runs");
    assert_int_equal(cJSON_GetArraySize(runs), 80);
    assert_close(number_of(entry, "thinned"), 1, 0, 0);
    int i = 0;
    cJSON_ArrayForEach(run, runs)
    {
        const cJSON *line = cJSON_GetArrayItem(lines, i++);
        assert_close(number_of(run, "objective"), number_of(line, "objective"), 0, 0);
        assert_close(number_of(parameter(run, 1), "value"), number_of(parameter(line, 1), "value"), 0, 0);
        assert_null(cJSON_GetObjectItem(run, "stop_reason"));
    }
    cJSON_Delete(json);
    cJSON_Delete(lines);
}

UNIT_TEST(verdicts_are_counted)
{
    static const char *const score[] = {"right", "quiet", "in_set", "silent", "wrong", "false_alarm"};
    page_make_study("hidden",
                    "*STUDY, COMMAND=DIAGNOSE, REPLICATES=3\n*DECKS\nbeam.inp\n*DATA, SOURCE=MODEL\n*NOISE\n"
                    "0.001, 0.01\n*HIDE, TYPE=NONE, NAME=control\n*HIDE, TYPE=DENSITY, NAME=a <core>, GROUP=core\nfactor, 1.2\n");
    cJSON *runs = page_runs("hidden.jsonl"), *run;
    const char *html = page_made("hidden.jsonl");
    cJSON *summary = page_json("hidden.json"), *cell;
    page_says(html, "Of 6 diagnoses ");
    for (size_t k = 0; k < sizeof score / sizeof *score; k++) {
        int count = 0;
        double told = 0;
        cJSON_ArrayForEach(run, runs) count += !strcmp(get(run, "score")->valuestring, score[k]);
        cJSON_ArrayForEach(cell, get(summary, "cells")) told += number_of(get(get(cell, "diagnoses"), "scores"), score[k]);
        assert_close(told, count, 0, 0);
    }
    cJSON_Delete(summary);
    page_says(html, "a &lt;core&gt;");
    assert_null(strstr(html, "<core>"));
    cJSON_Delete(runs);
}

UNIT_TEST(many_decks_stand_beside_each_other)
{
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
    page_says(html, "6 of 6 runs of identify in 6 cells, 1 failed, 0 did not converge");
    page_says(html, "<li>1 failed, the first is run ");
    page_says(html, "deck3.inp");
}

/* The file of results with its second line stamped anew. */
static char *stamp_second(const char *text)
{
    struct pool pool;
    struct study_header header;
    char study[DIGEST_LETTERS + 1];
    const char *line = strchr(text, '\n') + 1, *end = strchr(line, '\n') + 1, *stamp = strstr(line, ",\"study\":\"");
    pool_open(&pool, NULL);
    assert_true(stamp && stamp < end && !results_header_read(&pool, text, (size_t)(line - text), &header));
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
UNIT_TEST(a_file_of_results_without_a_run_is_told_so)
{
    page_make_study("truth", truth_plan);
    const char *whole = page_read("truth.jsonl");
    char header[2048];
    (void)snprintf(header, sizeof header, "%.*s", (int)(strchr(whole, '\n') + 1 - whole), whole);
    assert_refused(header, "broken.jsonl: is the file of results of a study and holds no run yet, expected the line of a run");
}

UNIT_TEST(broken_lines_are_told_with_their_place)
{
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
    assert_int_equal(page_run("cd %s; %s report cut.jsonl -o cut", page_path(""), ROTID_PROGRAM), 0);
    assert_non_null(strstr(page_err, "cut.jsonl: the last line is not complete and left out"));
    page_says(page_read("cut/index.html"), " of 80 runs</p>");
    page_says(page_read("cut/index.html"), "class=\"answer care\"");
}

/* Memory of the pool that ends after n blocks, while the lines are read and composed. */
UNIT_TEST(memory_that_runs_out_is_survived)
{
    page_make_study("starts", starts_plan);
    assert_true(page_composed_without_memory("starts.jsonl") > 150);
}

TEST_GROUP(page_bench_open, page_bench_close);
