/* rotid study as its users see it: the same results whatever the number of processes, whatever kills whom, whoever goes on. */
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "json_value.h"
#include "study_bench.h"
#include "support.h"

/* 120 runs of some milliseconds */
#define PLAN                                                                                                                     \
    "*STUDY, REPLICATES=20\n*DECKS\ndeck.inp\n*DATA, SOURCE=MODEL\n*MODES\n1-4\n1-6\n*NOISE\n0.001\n0.002, 0.01\n0.004, 0.02\n"
#define RUNS 120

static void rest(double seconds)
{
    const struct timespec time = {(time_t)seconds, (long)(1e9 * (seconds - (double)(time_t)seconds))};
    (void)nanosleep(&time, NULL);
}

static int setup(void **state)
{
    if (bench_make(state))
        return 1;
    (void)bench_write("a.plan", PLAN);
    (void)bench_write("plain.inp", BENCH_DECK);
    return bench_run("study a.plan -o one.jsonl --threads 1 --quiet").code;
}

UNIT_TEST(any_number_of_processes_gives_one_result)
{
    assert_int_equal(bench_lines("one.jsonl"), 1 + RUNS);
    bench_says("study a.plan -o three.jsonl --threads 3 --quiet", 0, "");
    assert_true(bench_same("one.jsonl", "three.jsonl"));
    bench_says("study a.plan -o three.jsonl --quiet", 0, ""); /* everything is there */
    assert_true(bench_same("one.jsonl", "three.jsonl"));
}

/* Results in order take the place of those that came out of order, and a summary that of an earlier one. */
UNIT_TEST(who_may_read_a_file_is_kept)
{
    struct stat is;
    char *whole = bench_read("one.jsonl"), *last = strstr(whole, "{\"run\":119,"), *second = strstr(whole, "{\"run\":0,");
    assert_true(last && second);
    FILE *stream = fopen(bench_path("private.jsonl"), "wb");
    assert_non_null(stream);
    assert_true(fprintf(stream, "%.*s%s%.*s", (int)(second - whole), whole, last, (int)(last - second), second) > 0);
    assert_int_equal(fclose(stream), 0);
    free(whole);
    (void)bench_write("private.json", "");
    assert_int_equal(chmod(bench_path("private.jsonl"), 0600), 0);
    assert_int_equal(chmod(bench_path("private.json"), 0640), 0);
    bench_says("study a.plan -o private.jsonl --json private.json --quiet", 0, "");
    assert_true(bench_same("one.jsonl", "private.jsonl"));
    assert_true(stat(bench_path("private.jsonl"), &is) == 0 && (is.st_mode & 0777) == 0600);
    assert_true(stat(bench_path("private.json"), &is) == 0 && (is.st_mode & 0777) == 0640);
}

UNIT_TEST(shards_merge_to_one_result)
{
    bench_says("study a.plan -o s1.jsonl --shard 1/3 --quiet", 0, "");
    bench_says("study a.plan -o s2.jsonl --shard 2/3 --quiet", 0, "");
    bench_says("study --merge s1.jsonl s2.jsonl -o most.jsonl --quiet", 1, "40 of 120 runs are missing in most.jsonl: 2, 5, 8,");
    bench_says("study a.plan -o s3.jsonl --shard 3/3 --quiet", 0, "");
    bench_says("study --merge s3.jsonl s1.jsonl s2.jsonl -o all.jsonl --quiet", 0, "");
    assert_true(bench_same("one.jsonl", "all.jsonl"));
    bench_says("study a.plan -o most.jsonl --quiet", 0, ""); /* or the rest is computed here */
    assert_true(bench_same("one.jsonl", "most.jsonl"));
    bench_says("study --merge s1.jsonl deck.inp -o x.jsonl", 2, "deck.inp:1:1: this is no file of results");
}

/* The coordinator is killed at some moment, again and again: what is there is whole, and in the end all is. Where a machine is
 * too slow for a run to end before that moment, the next one comes later. */
UNIT_TEST(nothing_is_lost_by_kill_9)
{
    unsigned seed = 12345;
    for (int round = 0; round < 4; round++) {
        int kills = 0, before = 0;
        double slowness = 1;
        bench_delete("killed.jsonl");
        for (int left = 1; left;) {
            pid_t process = bench_start("study a.plan -o killed.jsonl --threads 2 --quiet"), child[8];
            seed = seed * 1103515245u + 12345u;
            rest(slowness * (0.01 + 0.08 * (double)(seed >> 16 & 1023) / 1023));
            int children = bench_children(process, 8, child);
            (void)kill(process, SIGKILL);
            struct bench_outcome outcome = bench_wait(process);
            left = outcome.code != 0;
            assert_true(left == 0 || outcome.code == 128 + SIGKILL);
            kills += left;
            for (int i = 0; i < children; i++) /* nobody is left behind */
                assert_true(bench_ends(child[i], 5));
            int lines = bench_lines("killed.jsonl");
            assert_true(lines >= before && lines <= 1 + RUNS);
            slowness = lines > before ? 1 : 1.1 * slowness;
            before = lines;
            assert_true(kills < 400);
        }
        print_message("%d kills\n", kills);
        assert_true(bench_same("one.jsonl", "killed.jsonl"));
    }
}

/* A plan of diagnoses takes long enough for somebody to step in. */
#define SLOW                                                                                                                     \
    "*STUDY, COMMAND=DIAGNOSE, REPLICATES=4\n*DECKS\n" ROTID_SOURCE_DIR                                                          \
    "/input/solid_rotor.inp\n*DATA, SOURCE=MODEL\n*SENSORS\nEVERY, 6\n*NOISE\n0.001, 0.01\n"

static int wait_for_children(pid_t process, int wanted, pid_t *child)
{
    int count = 0;
    for (int tries = 0; tries < 1000 && count < wanted; tries++) {
        rest(0.005);
        count = bench_children(process, wanted, child);
    }
    return count;
}

UNIT_TEST(a_worker_that_dies_costs_its_run)
{
    (void)bench_write("slow.plan", SLOW);
    bench_delete("slow.jsonl");
    pid_t process = bench_start("study slow.plan -o slow.jsonl --threads 2"), child[2];
    assert_int_equal(wait_for_children(process, 2, child), 2);
    rest(0.05);
    assert_int_equal(kill(child[0], SIGKILL), 0);
    struct bench_outcome outcome = bench_wait(process);
    assert_int_equal(outcome.code, 1);
    assert_non_null(strstr(outcome.out, "worker ended by signal 9"));
    assert_int_equal(bench_lines("slow.jsonl"), 5);
    char *text = bench_read("slow.jsonl");
    assert_non_null(strstr(text, "\"status\":\"failed\",\"error\":\"worker ended by signal 9"));
    free(text);
    bench_says("study slow.plan -o slow.jsonl --quiet", 1, ""); /* it is kept */
    bench_says("study slow.plan -o slow.jsonl --quiet --retry-failed", 0, "");
    bench_says("study slow.plan -o again.jsonl --quiet", 0, "");
    assert_true(bench_same("slow.jsonl", "again.jsonl"));
}

/* A parent that ignores SIGCHLD hands that on, and then the system keeps no word of how a child ended. */
UNIT_TEST(a_worker_says_how_it_died_whoever_started_the_program)
{
    (void)bench_write("slow.plan", SLOW);
    bench_delete("ignored.jsonl");
    void (*before)(int) = signal(SIGCHLD, SIG_IGN);
    pid_t process = bench_start("study slow.plan -o ignored.jsonl --threads 2"), child[2];
    (void)signal(SIGCHLD, before);
    assert_int_equal(wait_for_children(process, 2, child), 2);
    rest(0.05);
    assert_int_equal(kill(child[0], SIGKILL), 0);
    struct bench_outcome outcome = bench_wait(process);
    assert_int_equal(outcome.code, 1);
    assert_non_null(strstr(outcome.out, "worker ended by signal 9"));
}

/* With standard error closed the file of results must not become it: the message would stand among the results. */
UNIT_TEST(closed_streams_are_no_files_of_results)
{
    for (int closed = STDERR_FILENO; closed >= STDIN_FILENO; closed--) { /* that stream and those behind it */
        bench_delete("closed.jsonl");
        pid_t process = fork();
        if (!process) {
            for (int stream = closed; stream <= STDERR_FILENO; stream++)
                (void)close(stream);
            if (chdir(bench_folder) == 0)
                (void)execl(ROTID_PROGRAM, "rotid", "study", "a.plan", "-o", "closed.jsonl", "--threads", "2", "--quiet", NULL);
            _exit(127);
        }
        for (int tries = 0; tries < 2000 && bench_lines("closed.jsonl") < 10; tries++)
            rest(0.002);
        assert_int_equal(kill(process, SIGTERM), 0);
        int status;
        assert_true(waitpid(process, &status, 0) == process && WIFEXITED(status));
        assert_int_equal(WEXITSTATUS(status), 1);
        bench_says("study a.plan -o closed.jsonl --quiet", 0, "");
        assert_true(bench_same("one.jsonl", "closed.jsonl"));
    }
}

UNIT_TEST(a_run_that_takes_too_long_has_failed)
{
    (void)bench_write("slow.plan", SLOW);
    bench_delete("late.jsonl");
    bench_says("study slow.plan -o late.jsonl --timeout 0.05", 1, "no result within 0.05 s (--timeout)");
    bench_says("study --summary late.jsonl", 1, "4 of 4 runs of diagnose in 1 cell, 4 failed");
}

UNIT_TEST(an_interruption_keeps_what_is_finished)
{
    static const int signals[] = {SIGINT, SIGTERM};
    for (int i = 0; i < 2; i++) {
        bench_delete("stopped.jsonl");
        int lines = 0;
        pid_t process = bench_start("study a.plan -o stopped.jsonl --threads 2 --json s.json --quiet");
        for (int tries = 0; tries < 2000 && lines < 10; tries++) {
            rest(0.002);
            lines = bench_lines("stopped.jsonl");
        }
        assert_int_equal(kill(process, signals[i]), 0);
        struct bench_outcome outcome = bench_wait(process);
        assert_int_equal(outcome.code, 1);
        lines = bench_lines("stopped.jsonl");
        char words[100], *json = bench_read("s.json");
        (void)snprintf(words, sizeof words, "interrupted, %d of 120 runs are in stopped.jsonl; the same command goes on",
                       lines - 1);
        assert_non_null(strstr(outcome.out, words));
        cJSON *summary = cJSON_Parse(json);
        assert_true(number_of(summary, "missing") == (double)(1 + RUNS - lines) && number_of(summary, "failed") == 0);
        cJSON_Delete(summary);
        free(json);
        bench_says("study a.plan -o stopped.jsonl --quiet", 0, "");
        assert_true(bench_same("one.jsonl", "stopped.jsonl"));
    }
}

/* Whatever they do: a stopped one would not see that nobody listens any more. */
UNIT_TEST(workers_end_with_their_study)
{
    pid_t child[2];
    (void)bench_write("slow.plan", SLOW);
    bench_delete("orphan.jsonl");
    pid_t process = bench_start("study slow.plan -o orphan.jsonl --threads 2 --quiet");
    assert_int_equal(wait_for_children(process, 2, child), 2);
    rest(0.2); /* they are at work */
    for (int i = 0; i < 2; i++)
        assert_int_equal(kill(child[i], SIGSTOP), 0);
    assert_int_equal(kill(process, SIGKILL), 0);
    assert_int_equal(bench_wait(process).code, 128 + SIGKILL);
    for (int i = 0; i < 2; i++) {
        int ended = bench_ends(child[i], 5);
        if (!ended)
            (void)kill(child[i], SIGKILL);
        assert_true(ended);
    }
}

UNIT_TEST(two_studies_do_not_write_one_file)
{
    (void)bench_write("slow.plan", SLOW);
    bench_delete("held.jsonl");
    pid_t process = bench_start("study slow.plan -o held.jsonl --threads 1 --quiet"), child[1];
    assert_int_equal(wait_for_children(process, 1, child), 1);
    bench_says("study slow.plan -o held.jsonl --quiet", 2, "held.jsonl:1:1: is being written by process");
    bench_says("study --summary held.jsonl", 1, "runs are missing"); /* reading is no harm */
    assert_int_equal(kill(process, SIGTERM), 0);
    assert_int_equal(bench_wait(process).code, 1);
}

UNIT_TEST(decks_are_identified_as_they_stand)
{
    (void)bench_write("wrong.inp", "*SHAFT\n");
    bench_says("study deck.inp wrong.inp plain.inp -o decks.jsonl --json d.json", 1, "1 of 3 decks cannot be used");
    assert_int_equal(bench_lines("decks.jsonl"), 4);
    char *text = bench_read("d.json");
    cJSON *json = cJSON_Parse(text);
    assert_true(cJSON_GetArraySize(get(json, "cells")) == 3 && number_of(json, "failed") == 1 && cJSON_IsNull(get(json, "plan")));
    cJSON_Delete(json);
    free(text);
    bench_says("study deck.inp a.plan -o x.jsonl", 2, "a plan and another file, expected one plan, or decks");
    bench_says("study wrong.inp -o x.jsonl --quiet", 2, "wrong.inp:1:1: *SHAFT has no NAME");
    assert_int_equal(bench_lines("x.jsonl"), 0);
}

/* Of decks named on the command line a repeated command computes those again that were mended, and nothing else. */
UNIT_TEST(a_mended_deck_runs_again)
{
    (void)bench_write("first.inp", BENCH_DECK);
    (void)bench_write("second.inp", "*SHAFT\n");
    bench_says("study first.inp second.inp -o mended.jsonl", 1, "1 failed");
    char *before = bench_read("mended.jsonl");
    (void)bench_write("second.inp", BENCH_DECK);
    bench_says("study first.inp second.inp -o mended.jsonl --json m.json", 0, "2 of 2 runs of identify in 2 cells, 0 failed");
    char *after = bench_read("mended.jsonl"), *json = bench_read("m.json");
    const char *run = strstr(before, "{\"run\":0");
    size_t length = strcspn(run, "\n") + 1;
    assert_non_null(strstr(after, "{\"run\":0"));
    assert_int_equal(strncmp(strstr(after, "{\"run\":0"), run, length), 0); /* its time as well: it was not computed again */
    assert_int_equal(bench_lines("mended.jsonl"), 3);
    free(before);
    free(json);
    bench_says("study --summary mended.jsonl", 0, "2 of 2 runs");
    bench_says("study first.inp second.inp -o mended.jsonl --quiet", 0, "");
    before = bench_read("mended.jsonl");
    assert_string_equal(before, after);
    free(before);
    (void)bench_write("first.inp", BENCH_DECK "*NOISE, FREQUENCY=0.01\n"); /* of one that had not failed as well */
    bench_says("study first.inp second.inp -o mended.jsonl", 0,
               "lines of decks that have changed since: 1; their runs are computed again");
    before = bench_read("mended.jsonl"); /* interrupted before the lines were in order: both stand there */
    char *both = calloc(1, strlen(before) + strlen(after) + 1);
    run = strstr(before, "{\"run\":0");
    (void)strncat(strcpy(both, after), run, strcspn(run, "\n") + 1);
    (void)bench_write("both.jsonl", both);
    bench_says("study --summary both.jsonl", 0, "2 of 2 runs");
    free(both);
    free(before);
    free(after);
    bench_says("study first.inp -o mended.jsonl", 2, "the plan has changed"); /* not the same decks */
}

/* Sections and bearings in tables are part of the deck. */
UNIT_TEST(a_deck_with_a_changed_table_runs_again)
{
    (void)bench_write("core.csv", "length,od,elements\n0.4,0.1,8\n");
    (void)bench_write("oil.csv", "speed_rpm,kxx,kyy,cxx,cyy\n1000,1e8,1e8,1e4,1e4\n");
    (void)bench_write("tables.inp", "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=core, "
                                    "MATERIAL=steel, FILE=core.csv\n*MODES\n1, 2600\n2, 6000\n*IDENTIFY\ncore.E, 1e10, 1e12, "
                                    "2e11\n*RUNNING\n*BEARING, FILE=oil.csv\nstart\n*BEARING, FILE=oil.csv\nend\n");
    (void)bench_write("oil.plan", "*STUDY, COMMAND=SPEEDS\n*DECKS\ntables.inp\n");
    bench_says("study tables.inp -o tables.jsonl", 0, "1 of 1 runs");
    bench_says("study oil.plan -o oil.jsonl", 0, "1 of 1 runs");
    (void)bench_write("core.csv", "length,od,elements\n0.4,0.11,8\n");
    bench_says("study tables.inp -o tables.jsonl", 0, "lines of decks that have changed since: 1");
    (void)bench_write("core.csv", "length,od,elements\n0.4,0.1,8\n");
    bench_says("study oil.plan -o oil.jsonl --quiet", 0, "");
    (void)bench_write("oil.csv", "speed_rpm,kxx,kyy,cxx,cyy\n1000,1e8,1e8,1e4,2e4\n");
    bench_says("study oil.plan -o oil.jsonl", 2, "the measured data or a table has changed since it was begun");
}

UNIT_TEST(wrong_usage_is_refused)
{
    bench_says("study a.plan", 2, "no file for the results, expected -o FILE");
    bench_says("study a.plan -o -", 2, "expected a file");
    bench_says("study a.plan -o a.plan", 2, "is the file that is read");
    bench_says("study a.plan -o x.jsonl --shard 0/3", 2, "--shard 0/3: expected I/N with I from 1 to N");
    bench_says("study a.plan -o x.jsonl --shard 4/3", 2, "expected I/N");
    bench_says("study a.plan -o x.jsonl --shard 1/3x", 2, "expected I/N");
    bench_says("study a.plan -o x.jsonl --timeout 0", 2, "--timeout 0: expected a number");
    bench_says("study --summary one.jsonl a.plan", 2, "is one argument too many");
    bench_says("study --summary one.jsonl -o x.jsonl", 2, "--summary writes no results");
    bench_says("study --summary a.plan", 2, "this is no file of results");
    (void)bench_write("null.jsonl",
                      "{\"schema\":1,\"rotid\":\"0\",\"commit\":\"\",\"command\":\"study\",\"plan\":null,\"studies\":"
                      "\"identify\",\"digest\":{\"plan\":\"1\",\"decks\":\"1\",\"data\":\"1\",\"options\":\"1\"},"
                      "\"seed\":null,\"runs\":1,\"shard\":null}\n");
    bench_says("study --summary null.jsonl", 2, "null.jsonl:1:1: this is no file of results");
    bench_says("study --summary none.jsonl", 3, "cannot be opened");
    bench_says("study --merge one.jsonl", 2, "no file for the results");
    bench_says("study --merge --summary one.jsonl", 2, "both given");
    bench_says("study --merge one.jsonl -o x.jsonl --shard 1/2", 2, "--merge computes nothing");
    bench_says("identify deck.inp --shard 1/2", 2, "--shard is an option of study alone");
    bench_says("identify deck.inp deck.inp", 2, "is one argument too many");
    bench_says("study a.plan -o x.jsonl --no-baseline", 2, "--no-baseline is an option of identify alone");
    assert_int_equal(bench_lines("x.jsonl"), 0);
}

/* A row a cell, a row for each parameter of it, a row for each parameter of a run; in SI, what the JSON holds. */
UNIT_TEST(summary_and_runs_are_tables_for_a_spreadsheet)
{
    bench_says("study --summary one.jsonl --csv out --json out.json", 0,
               "out.cells.csv, out.parameters.csv and out.runs.csv are written");
    char *json = bench_read("out.json"), *cells = bench_read("out.cells.csv"), *parameters = bench_read("out.parameters.csv"),
         *runs = bench_read("out.runs.csv");
    cJSON *summary = cJSON_Parse(json);
    const cJSON *first = cJSON_GetArrayItem(get(summary, "cells"), 0), *p = cJSON_GetArrayItem(get(first, "parameters"), 0);
    int ncell = cJSON_GetArraySize(get(summary, "cells")), nparameter = cJSON_GetArraySize(get(first, "parameters"));
    assert_int_equal(bench_lines("out.cells.csv"), 1 + ncell);
    assert_int_equal(bench_lines("out.parameters.csv"), 1 + ncell * nparameter);
    assert_int_equal(bench_lines("out.runs.csv"), 1 + (int)number_of(summary, "done") * nparameter);
    assert_int_equal(strncmp(cells, "deck,variant,modes,sensors,hidden,noise,shape noise,runs,failed,", 62), 0);
    assert_int_equal(strncmp(runs, "run,deck,variant,", 17), 0);
    const char *row = strstr(parameters, ",core.E,Pa,");
    assert_non_null(row);
    row += strlen(",core.E,Pa,");
    assert_close(strtod(row, (char **)&row), number_of(p, "count"), 0, 0);
    assert_close(strtod(row + 1, (char **)&row), number_of(p, "mean"), 1e-15, 0);
    cJSON_Delete(summary);
    free(json);
    free(cells);
    free(parameters);
    free(runs);
    bench_says("study --summary one.jsonl --csv out --json out.runs.csv", 2, "the file of --json");
}

UNIT_TEST(the_summary_is_a_table_or_json)
{
    bench_says("study --summary one.jsonl", 0, "a.plan: 120 of 120 runs of identify in ");
    bench_says("study --summary one.jsonl", 0, "core.E");
    struct bench_outcome outcome = bench_run("study --summary one.jsonl --json -");
    cJSON *json = cJSON_Parse(outcome.out), *same;
    if (!json) { /* longer than the outcome holds */
        char *text = bench_read("said");
        json = cJSON_Parse(text);
        free(text);
    }
    assert_int_equal(cJSON_GetArraySize(get(json, "cells")), 6);
    const cJSON *cell = cJSON_GetArrayItem(get(json, "cells"), 5);
    assert_true(number_of(cell, "runs") == 20 && number_of(cell, "converged") == 20 && number_of(cell, "first_run") == 100);
    assert_true(number_of(get(cell, "cell"), "noise_frequency") == 0.004);
    assert_true(bench_number(cell, "parameters", 0, "coverage95") > 0.5);
    /* the lines in another order say the same */
    char *text = bench_read("one.jsonl"), *turned = calloc(1, strlen(text) + 1);
    size_t head = strcspn(text, "\n") + 1;
    (void)snprintf(turned, head + 1, "%s", text);
    for (char *end = text + strlen(text) - 1; end > text + head;) {
        char *begin = end;
        while (begin > text + head && begin[-1] != '\n')
            begin--;
        strncat(turned, begin, (size_t)(end - begin) + 1);
        end = begin - 1;
    }
    (void)bench_write("turned.jsonl", turned);
    bench_says("study --summary turned.jsonl --quiet --json t.json", 0, "");
    free(text);
    text = bench_read("t.json");
    same = cJSON_Parse(text);
    cJSON_ReplaceItemInObject(same, "results", cJSON_CreateString("one.jsonl"));
    assert_true(cJSON_Compare(json, same, 1));
    cJSON_Delete(json);
    cJSON_Delete(same);
    free(text);
    free(turned);
}

/* A file that may not grow: exit code 3, whole lines, and on it goes. */
UNIT_TEST(a_full_disk_stops_it)
{
    char command[1500];
    bench_delete("full.jsonl");
    (void)snprintf(command, sizeof command, "cd %s && (ulimit -f 40; exec %s study a.plan -o full.jsonl --quiet) >said 2>&1",
                   bench_folder, ROTID_PROGRAM); /* 40 blocks of 512 or 1024 bytes */
    int status = system(command);
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 3);
    char *said = bench_read("said");
    assert_non_null(strstr(said, "runs are in full.jsonl, the same command goes on with the rest: File too large"));
    free(said);
    int lines = bench_lines("full.jsonl");
    assert_true(lines > 2 && lines < RUNS);
    bench_says("study a.plan -o full.jsonl --quiet", 0, "");
    assert_true(bench_same("one.jsonl", "full.jsonl"));
}

/* Last: it changes the deck. */
UNIT_TEST(a_changed_study_is_refused)
{
    bench_says("study a.plan -o one.jsonl --seed 2", 2, "its seed is 1, not 2");
    bench_says("study a.plan -o one.jsonl --set NOISE.FREQUENCY=0.01", 2, "--set has changed");
    bench_says("study a.plan -o one.jsonl --shard 1/2", 2, "this file is of shard 1/1 and not of 1/2");
    (void)bench_write("a.plan", PLAN "*SENSORS\nALL\n");
    bench_says("study a.plan -o one.jsonl", 2, "the plan has changed since it was begun");
    (void)bench_write("a.plan", PLAN);
    (void)bench_write("deck.inp", BENCH_BEAM BENCH_SENSORS BENCH_WANTED BENCH_MODES "*DISK\n0.5, 1\n");
    bench_says("study a.plan -o one.jsonl", 2, "a deck has changed since it was begun");
    (void)bench_write("deck.inp", "** the same\n" BENCH_DECK);
    bench_says("study a.plan -o one.jsonl --quiet", 0, "");
    bench_says("study a.plan -o deck.inp", 2, "--output deck.inp is a file that is read");
    (void)bench_write("other.inp", BENCH_DECK);
    bench_says("study a.plan -o other.inp", 2, "other.inp:1:1: this is no file of results");
    assert_int_equal(bench_lines("deck.inp"), 1 + bench_lines("plain.inp"));
}

TEST_GROUP(setup, bench_remove);
