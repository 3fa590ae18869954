/* The file of results: what is in it, what is refused, what a sudden end leaves, what happens when it cannot grow. */
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "result/result.h"
#include "study/study.h"
#include "study_bench.h"
#include "support.h"

#define RUNS 6

static struct study study;
static struct study_header header;

static int setup(void **state)
{
    struct message_list messages;
    (void)open_test_pool(state);
    if (bench_study(&test_pool, "*STUDY, REPLICATES=6\n*DECKS\ndeck.inp\n*DATA, SOURCE=MODEL\n*NOISE\n0.001\n", &messages,
                    &study))
        return 1;
    header = header_of(&test_pool, &study, "1.2.3", "abc", 1, 1);
    bench_delete("r.jsonl");
    return 0;
}

#define CELL                                                                                                                     \
    "{\"deck\":\"d\",\"variant\":null,\"modes\":null,\"sensors\":null,\"noise_frequency\":null,\"noise_shape\":null,\"hide\":"   \
    "null}"

/* As study_run writes them: the time last. */
static const char *line_of(long run, const char *status, double value)
{
    static char text[8][900];
    static int next;
    next = (next + 1) % 8;
    (void)snprintf(
        text[next], sizeof text[next],
        "{\"run\":%ld,\"cell\":" CELL ",\"replicate\":%ld,\"start\":0,\"status\":\"%s\",\"error\":null,"
        "\"functional\":\"HYBRID\",\"reduction\":\"GUYAN\",\"objective\":%g,\"chi2\":null,\"chi2_per_dof\":%g,\"dof\":1,"
        "\"iterations\":1,\"evaluations\":1,\"stop_reason\":\"\",\"sensors\":0,\"truth\":{\"a\":3},\"hidden\":null,"
        "\"parameters\":[{\"name\":\"a\",\"unit\":\"1\",\"value\":%g,\"start\":1,\"lower\":0,\"upper\":9,\"std\":2,"
        "\"ci95\":[0,4],\"at_bound\":false,\"identifiable\":true}],\"modes\":[],\"warnings\":[],\"seconds\":%g}\n",
        run, run, status, value, value > 5 ? 6.64 : 6.63, value, 0.001 * (double)run);
    return text[next];
}

/* As they stand in the file. */
static const char *stamped(const char *line)
{
    char study_digest[DIGEST_LETTERS + 1];
    stamp_study(&header, study_digest);
    char *text = stamp_line(study_digest, line), *copy = pool_copy_text(&test_pool, text);
    free(text);
    return copy;
}

static int open_record(int retry, struct message_list *messages, struct study_record *record)
{
    message_open(messages, &test_pool);
    return record_open(&test_pool, bench_path("r.jsonl"), &header, NULL, retry, messages, record);
}

static struct study_record opened(int retry)
{
    struct message_list messages;
    struct study_record record;
    int status = open_record(retry, &messages, &record);
    for (size_t i = 0; i < messages.count && status; i++)
        print_error("%s\n", messages.item[i].text);
    assert_status(status, ROTID_OK);
    return record;
}

static void append(struct study_record *record, long run, const char *status)
{
    assert_status(record_append(record, line_of(run, status, (double)run)), ROTID_OK);
}

/* Refused with these words, and the file is left as it is. */
static void refuses(const char *text, int status, const char *words)
{
    struct message_list messages;
    struct study_record record;
    if (text)
        (void)bench_write("r.jsonl", text);
    char *before = bench_read("r.jsonl");
    int found = open_record(0, &messages, &record);
    char *after = bench_read("r.jsonl");
    if (found != status || !messages.count || !strstr(messages.item[0].text, words))
        print_error("%s, \"%s\"; expected \"%s\"\n", rotid_status_name(found), messages.count ? messages.item[0].text : "",
                    words);
    assert_true(found == status && messages.count && strstr(messages.item[0].text, words));
    assert_string_equal(before, after);
    free(before);
    free(after);
}

/* In any order, whatever interrupts it: in the end the lines stand in the order of the runs. */
FIXTURE_TEST(the_file_ends_in_order, setup, close_test_pool)
{
    static const long order[RUNS] = {3, 0, 5, 1, 4, 2};
    char expected[6000] = "";
    struct study_record record = opened(0);
    assert_true(record.wanted == RUNS && !record.done);
    for (int i = 0; i < RUNS; i++) {
        append(&record, order[i], order[i] == 4 ? "failed" : "converged");
        if (i == 2) { /* a restart */
            record_close(&record);
            record = opened(0);
            assert_int_equal(record.done, 3);
            assert_int_equal(record_take(&record), 1);
            assert_int_equal(record_take(&record), 2);
            assert_int_equal(record_take(&record), 4);
            assert_int_equal(record_take(&record), -1);
        }
    }
    assert_true(record.done == RUNS && record.failed == 1 && !record.file.in_order);
    assert_status(record_finish(&record), ROTID_OK);
    record_close(&record);
    char *text = bench_read("r.jsonl"), *first = header_text(&header);
    (void)snprintf(expected, sizeof expected, "%s", first);
    for (long run = 0; run < RUNS; run++)
        (void)snprintf(expected + strlen(expected), sizeof expected - strlen(expected), "%s",
                       stamped(line_of(run, run == 4 ? "failed" : "converged", (double)run)));
    assert_string_equal(text, expected);
    free(text);
    free(first);
    record = opened(1); /* the failed one again */
    assert_true(record.done == RUNS - 1 && record_take(&record) == 4 && record_take(&record) == -1);
    append(&record, 4, "converged");
    assert_status(record_finish(&record), ROTID_OK);
    record_close(&record);
    assert_int_equal(bench_lines("r.jsonl"), 1 + RUNS);
    record = opened(0);
    assert_true(record.done == RUNS && !record.failed && record.file.in_order);
    record_close(&record);
}

/* Whatever byte the end comes at, everything before the cut line is kept and the cut line goes. */
FIXTURE_TEST(a_cut_line_is_removed, setup, close_test_pool)
{
    struct study_record record = opened(0);
    for (long run = 0; run < 3; run++)
        append(&record, run, "converged");
    record_close(&record);
    char *whole = bench_read("r.jsonl"), *first = header_text(&header);
    size_t head = strlen(first), length = strlen(whole);
    for (size_t cut = 0; cut <= length; cut += cut + 40 < head ? 29 : 1) {
        char kept = whole[cut];
        whole[cut] = 0;
        (void)bench_write("r.jsonl", whole);
        record = opened(0);
        long lines = 0;
        for (size_t i = head; i < cut; i++)
            lines += whole[i] == '\n';
        assert_int_equal(record.done, lines);
        append(&record, 5, "converged");
        record_close(&record);
        whole[cut] = kept;
        char *text = bench_read("r.jsonl");
        size_t same = head;
        for (size_t i = head; i < cut; i++)
            same = whole[i] == '\n' ? i + 1 : same;
        assert_true(!strncmp(text, whole, same) && !strcmp(text + same, stamped(line_of(5, "converged", 5))));
        free(text);
    }
    free(whole);
    free(first);
}

FIXTURE_TEST(other_files_are_left_alone, setup, close_test_pool)
{
    struct study_header other = header;
    struct study_record record = opened(0);
    append(&record, 0, "converged");
    record_close(&record);
    const struct {
        const char *rotid, *plan, *decks, *data, *options, *shard; /* NULL: as it was */
        double seed;
        const char *words;
    } table[] = {
        {.rotid = "1.2.4", .words = "begun by rotid 1.2.3 (abc), this is 1.2.4 (abc)"},
        {.plan = "x", .words = "the plan has changed"},
        {.decks = "x", .data = "y", .words = "a deck and the measured data or a table have changed"},
        {.options = "x", .words = "--set has changed"},
        {.seed = 7, .words = "its seed is 1, not 7"},
        {.shard = "2/3", .words = "is of shard 1/1 and not of 2/3"},
    };
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        header = other;
        header.rotid = table[i].rotid ? table[i].rotid : header.rotid;
        header.digest.plan = table[i].plan ? table[i].plan : header.digest.plan;
        header.digest.decks = table[i].decks ? table[i].decks : header.digest.decks;
        header.digest.data = table[i].data ? table[i].data : header.digest.data;
        header.digest.options = table[i].options ? table[i].options : header.digest.options;
        header.seed = table[i].seed > 0 ? table[i].seed : header.seed;
        header.shard = table[i].shard;
        refuses(NULL, ROTID_ERROR_ARGUMENT, table[i].words);
    }
    header = other;
    refuses("*STUDY\n*DECKS\ndeck.inp\n", ROTID_ERROR_ARGUMENT, "no file of results of rotid study");
    refuses("{\"schema\":1}\n", ROTID_ERROR_ARGUMENT, "no file of results of rotid study");
    refuses("something", ROTID_ERROR_ARGUMENT, "no file of results of rotid study");
    char *first = header_text(&header), text[4000];
    (void)snprintf(text, sizeof text, "%shello\n", first);
    refuses(text, ROTID_ERROR_ARGUMENT, "this line does not end in its digest");
    (void)snprintf(text, sizeof text, "%s%s", first, stamped(line_of(6, "converged", 1)));
    refuses(text, ROTID_ERROR_ARGUMENT, "of a run that the study");
    free(first);
}

FIXTURE_TEST(what_is_no_file_is_refused, setup, close_test_pool)
{
    struct message_list messages;
    struct study_record record;
    static const char *const paths[] = {"/dev/full", "/dev/null", "/tmp", "/nowhere/at/all"};
    for (size_t i = 0; i < 4; i++) {
        message_open(&messages, &test_pool);
        int status = record_open(&test_pool, paths[i], &header, NULL, 0, &messages, &record);
        assert_true(status == ROTID_ERROR_ARGUMENT || status == ROTID_ERROR_IO);
        assert_int_equal(messages.errors, 1);
    }
    assert_int_equal(mkfifo(bench_path("pipe"), 0600), 0);
    message_open(&messages, &test_pool);
    assert_status(record_open(&test_pool, bench_path("pipe"), &header, NULL, 0, &messages, &record), ROTID_ERROR_ARGUMENT);
}

/* A second process is kept out while the first one lives, and no longer. */
FIXTURE_TEST(one_process_at_a_time, setup, close_test_pool)
{
    int pipes[2];
    char byte;
    assert_int_equal(pipe(pipes), 0);
    pid_t child = fork();
    if (!child) {
        struct message_list messages;
        struct study_record record;
        _exit(open_record(0, &messages, &record) || write(pipes[1], "x", 1) != 1 || pause());
    }
    assert_int_equal(read(pipes[0], &byte, 1), 1);
    refuses(NULL, ROTID_ERROR_ARGUMENT, "is being written by process");
    assert_int_equal(kill(child, SIGKILL), 0);
    assert_true(waitpid(child, NULL, 0) == child);
    struct study_record record = opened(0);
    record_close(&record);
    (void)close(pipes[0]);
    (void)close(pipes[1]);
}

/* A file that may not grow, at every size: an error, and whole lines only. */
FIXTURE_TEST(a_full_disk_leaves_whole_lines, setup, close_test_pool)
{
    struct rlimit before, limit;
    struct sigaction ignore = {.sa_handler = SIG_IGN}, old;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    assert_int_equal(sigaction(SIGXFSZ, &ignore, &old), 0);
    char *first = header_text(&header);
    size_t head = strlen(first), one = strlen(stamped(line_of(0, "converged", 0)));
    for (size_t size = 1; size < head + 2 * one; size += 13) {
        struct message_list messages;
        struct study_record record;
        bench_delete("r.jsonl");
        limit = before;
        limit.rlim_cur = size;
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
        int status = open_record(0, &messages, &record), count = 0;
        errno = 0;
        for (long run = 0; run < RUNS && !status; run++) {
            status = record_append(&record, line_of(run, "converged", (double)run));
            count += !status;
        }
        int reason = errno;
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
        assert_status(status, ROTID_ERROR_IO);
        assert_true(size < head || reason == EFBIG);
        if (size >= head) {
            assert_int_equal(bench_lines("r.jsonl"), 1 + count);
            record_close(&record);
        }
        record = opened(0); /* there is room again */
        assert_int_equal(record.done, count);
        for (long run; (run = record_take(&record)) >= 0;)
            append(&record, run, "converged");
        assert_status(record_finish(&record), ROTID_OK);
        record_close(&record);
        assert_int_equal(bench_lines("r.jsonl"), 1 + RUNS);
    }
    /* putting it in order needs room as well */
    bench_delete("r.jsonl");
    struct study_record record = opened(0);
    for (long run = RUNS - 1; run >= 0; run--)
        append(&record, run, "converged");
    char *unordered = bench_read("r.jsonl");
    limit = before;
    limit.rlim_cur = head + one;
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
    assert_status(record_finish(&record), ROTID_ERROR_IO);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
    record_close(&record);
    char *left = bench_read("r.jsonl");
    assert_string_equal(left, unordered);
    record = opened(0);
    assert_status(record_finish(&record), ROTID_OK);
    record_close(&record);
    free(left);
    left = bench_read("r.jsonl");
    assert_string_not_equal(left, unordered);
    free(left);
    free(unordered);
    free(first);
    (void)sigaction(SIGXFSZ, &old, NULL);
}

FIXTURE_TEST(shards_share_the_runs, setup, close_test_pool)
{
    char *paths[3] = {pool_copy_text(&test_pool, bench_path("1.jsonl")), pool_copy_text(&test_pool, bench_path("2.jsonl")),
                      pool_copy_text(&test_pool, bench_path("3.jsonl"))};
    struct message_list messages;
    struct merge merge;
    const char *all = bench_path("all.jsonl");
    bench_delete("all.jsonl");
    for (int shard = 1; shard <= 3; shard++) {
        struct study_record record;
        struct study_header part = header;
        part.shard = pool_format(&test_pool, "%d/3", shard);
        (void)unlink(paths[shard - 1]);
        message_open(&messages, &test_pool);
        assert_status(record_open(&test_pool, paths[shard - 1], &part, NULL, 0, &messages, &record), ROTID_OK);
        assert_int_equal(record.wanted, 2);
        for (long run; (run = record_take(&record)) >= 0;) {
            assert_int_equal(run % 3, shard - 1);
            append(&record, run, "converged");
        }
        assert_true(record.done == record.wanted);
        record_close(&record);
    }
    assert_status(merge_results(&test_pool, 3, paths, all, &messages, &merge), ROTID_OK);
    assert_true(merge.runs == RUNS && !merge.missing && !merge.failed);
    struct study_record record = opened(0); /* what one program alone writes */
    for (long run; (run = record_take(&record)) >= 0;)
        append(&record, run, "converged");
    record_close(&record);
    char *one = bench_read("r.jsonl"), *merged = bench_read("all.jsonl");
    assert_string_equal(one, merged);
    free(one);
    free(merged);
    /* it does not write over anything */
    message_open(&messages, &test_pool);
    assert_status(merge_results(&test_pool, 3, paths, all, &messages, &merge), ROTID_ERROR_ARGUMENT);
    assert_non_null(strstr(messages.item[0].text, "exists"));
    /* without the second: a file that goes on */
    bench_delete("all.jsonl");
    char *two[2] = {paths[0], paths[2]};
    assert_status(merge_results(&test_pool, 2, two, all, &messages, &merge), ROTID_OK);
    assert_int_equal(merge.missing, 2);
    assert_string_equal(merge.list, "1, 4");
    message_open(&messages, &test_pool);
    assert_status(record_open(&test_pool, all, &header, NULL, 0, &messages, &record), ROTID_OK);
    assert_true(record_take(&record) == 1 && record_take(&record) == 4 && record_take(&record) == -1);
    record_close(&record);
}

FIXTURE_TEST(parts_that_contradict_each_other_are_refused, setup, close_test_pool)
{
    char *first = header_text(&header), text[4000];
    char *paths[2] = {pool_copy_text(&test_pool, bench_path("1.jsonl")), pool_copy_text(&test_pool, bench_path("2.jsonl"))};
    struct message_list messages;
    struct merge merge;
    const char *all = bench_path("all.jsonl");
    bench_delete("all.jsonl");
    (void)snprintf(text, sizeof text, "%s%s%s", first, stamped(line_of(0, "converged", 1)), stamped(line_of(1, "failed", 1)));
    (void)bench_write("1.jsonl", text);
    (void)snprintf(text, sizeof text, "%s%s", first, stamped(line_of(0, "converged", 1.5)));
    (void)bench_write("2.jsonl", text);
    message_open(&messages, &test_pool);
    assert_status(merge_results(&test_pool, 2, paths, all, &messages, &merge), ROTID_ERROR_ARGUMENT);
    assert_non_null(strstr(messages.item[0].text, "run 0 has another result in"));
    assert_int_equal(access(all, F_OK), -1);
    /* another time is no contradiction, and what failed in one part is taken from the other */
    char later[900];
    (void)snprintf(later, sizeof later, "%s", line_of(0, "converged", 1));
    strcpy(strstr(later, "\"seconds\":"), "\"seconds\":77}\n");
    (void)snprintf(text, sizeof text, "%s%s%s", first, stamped(later), stamped(line_of(1, "converged", 2)));
    (void)bench_write("2.jsonl", text);
    message_open(&messages, &test_pool);
    assert_status(merge_results(&test_pool, 2, paths, all, &messages, &merge), ROTID_OK);
    assert_true(merge.missing == RUNS - 2 && !merge.failed);
    assert_string_equal(merge.list, "2-5");
    free(first);
    /* of another study */
    header.seed = 2;
    first = header_text(&header);
    (void)bench_write("2.jsonl", first);
    bench_delete("all.jsonl");
    assert_status(merge_results(&test_pool, 2, paths, all, &messages, &merge), ROTID_ERROR_ARGUMENT);
    assert_non_null(strstr(messages.item[messages.count - 1].text, "not of the same study"));
    free(first);
}

/* text with the first `old` in it replaced; old is as long as the replacement, or the line is stamped anew behind it */
static const char *changed(const char *text, const char *old, const char *new)
{
    const char *at = strstr(text, old);
    assert_non_null(at);
    return pool_format(&test_pool, "%.*s%s%s", (int)(at - text), text, new, at + strlen(old));
}

/* Whoever reads the file says where it is wrong and in what, and leaves it as it is. */
static void assert_all_refuse(const char *text, int line, const char *words)
{
    struct message_list messages;
    struct study_record record;
    struct study_result summary;
    struct study_header found;
    struct merge merge;
    char *part = pool_copy_text(&test_pool, bench_path("r.jsonl"));
    const char *all = bench_path("all.jsonl");
    (void)bench_write("r.jsonl", text);
    for (int reader = 0; reader < 3; reader++) {
        message_open(&messages, &test_pool);
        int status = reader == 0   ? record_open(&test_pool, part, &header, NULL, 0, &messages, &record)
                     : reader == 1 ? summary_read(&test_pool, part, &messages, &found, NULL, &summary)
                                   : merge_results(&test_pool, 1, &part, all, &messages, &merge);
        if (status >= 0 || messages.errors != 1 || messages.item[0].line != line || !strstr(messages.item[0].text, words) ||
            !strstr(messages.item[0].text, "expected"))
            fail_msg("reader %d: %s, line %d, \"%s\"; expected line %d, \"%s\"", reader, rotid_status_name(status),
                     messages.count ? messages.item[0].line : 0, messages.count ? messages.item[0].text : "", line, words);
    }
    assert_int_equal(access(all, F_OK), -1);
    char *after = bench_read("r.jsonl");
    assert_string_equal(after, text);
    free(after);
}

/* What accidents make of lines, and what somebody writes who also computes the digest. */
FIXTURE_TEST(a_line_that_is_wrong_is_never_kept, setup, close_test_pool)
{
    static const char changed_words[] = "is not as rotid wrote it";
    bench_delete("all.jsonl");
    struct study_record record = opened(0);
    for (long run = 0; run < RUNS; run++)
        append(&record, run, run == 2 ? "failed" : "converged");
    record_close(&record);
    char *whole = bench_read("r.jsonl"), *first = header_text(&header);
    const char *line = line_of(1, "converged", 1), *good = stamped(line);
    assert_all_refuse(changed(whole, "\"run\":5", "\"run\":4"), 7, changed_words);
    assert_all_refuse(changed(whole, "\"replicate\":4", "\"replicate\":5"), 6, changed_words);
    assert_all_refuse(changed(whole, "\"objective\":3,", "\"objective\":1e999,"), 5, changed_words);
    assert_all_refuse(changed(whole, "\"objective\":3,", "\"objective\":\"3\","), 5, changed_words);
    assert_all_refuse(changed(whole, "\"objective\":3,", "\"objective\":NaN,"), 5, changed_words);
    assert_all_refuse(changed(whole, "\"seconds\":0.005", "\"seconds\":0.006"), 7, changed_words);
    assert_all_refuse(changed(whole, ",\"digest\":\"", ",\"Digest\":\""), 2, "does not end in its digest");
    /* every byte of a line, but its line feed */
    for (size_t i = 0; good[i + 1]; i++) {
        char *copy = pool_format(&test_pool, "%s%s", first, good);
        copy[strlen(first) + i] ^= 1;
        if (copy[strlen(first) + i] != '\n')
            assert_all_refuse(copy, 2, "this line");
    }
    /* twice, cut in the middle of the file, and as early versions had them */
    assert_all_refuse(pool_format(&test_pool, "%s%s", whole, good), 8, "run 1 stands in a line above already");
    assert_all_refuse(pool_format(&test_pool, "%s%.60s\n%s", first, good, stamped(line_of(2, "converged", 2))), 2,
                      "does not end in its digest");
    assert_all_refuse(pool_format(&test_pool, "%s%s", first, line), 2, "does not end in its digest");
    /* of another study: its digest is right */
    const double seed = header.seed;
    header.seed = 7;
    const char *foreign = stamped(line);
    header.seed = seed;
    assert_all_refuse(pool_format(&test_pool, "%s%s", first, foreign), 2, "of another study than the first line");
    /* with the right digest */
    static const char *const forged[][3] = {
        {"\"objective\":1,", "\"objective\":1e999,", "objective: is beyond the range of numbers"},
        {"\"value\":1,", "\"value\":-1e999,", "parameters[0].value: is beyond the range of numbers"},
        {"\"objective\":1,", "\"objective\":NaN,", "no JSON"},
        {"\"objective\":1,", "\"objective\":\"1\",", "objective: is a text, expected a number"},
        {"\"std\":2", "\"std\":[2]", "parameters[0].std: is a list, expected a number"},
        {"\"ci95\":[0,4]", "\"ci95\":4", "parameters[0].ci95: is a number, expected a list"},
        {"\"status\":\"converged\"", "\"status\":\"fine\"",
         "status: is 'fine', expected converged, at_bound, not_converged or failed"},
        {"\"replicate\":1", "\"replicate\":null", "replicate: is null, expected a value"},
        {"\"run\":1,", "\"run\":1.5,", "run: is 1.5, expected a whole number"},
        {"\"run\":1,", "\"run\":\"1\",", "run: is a text, expected a number"},
        {"\"cell\":" CELL, "\"cell\":null", "cell: is null, expected an object"},
        {"\"warnings\"",
         "\"verdict\":{\"kind\":null,\"adequate_after\":false,\"p_value\":null,\"causes\":[],\"alternatives\":[],"
         "\"alternative_causes\":[],\"next_measurement\":null,\"sentence\":null,\"undetermined_parameters\":0},"
         "\"data_findings\":[],\"warnings\"",
         "it has no verdict"},
    };
    for (size_t i = 0; i < sizeof forged / sizeof *forged; i++)
        assert_all_refuse(pool_format(&test_pool, "%s%s", first, stamped(changed(line, forged[i][0], forged[i][1]))), 2,
                          forged[i][2]);
    /* without a line that is wrong the study goes on: it computes that run */
    (void)bench_write("r.jsonl", pool_format(&test_pool, "%s%s", first, good));
    record = opened(0);
    assert_true(record.done == 1 && record_take(&record) == 0 && record_take(&record) == 2);
    record_close(&record);
    free(whole);
    free(first);
}

/* Sums by hand. */
FIXTURE_TEST(summaries_add_up, setup, close_test_pool)
{
    struct message_list messages;
    struct study_result s;
    struct study_header found;
    struct study_record record = opened(0);
    static const double value[] = {2, 3, 5, 6}; /* truth 3, interval 0 to 4, std 2 */
    for (long run = 3; run >= 0; run--)
        assert_status(record_append(&record, line_of(run, run == 1 ? "at_bound" : "converged", value[run])), ROTID_OK);
    append(&record, 4, "failed");
    assert_status(record_append(&record, line_of(5, "not_converged", 1e9)), ROTID_OK);
    record_close(&record);
    message_open(&messages, &test_pool);
    assert_status(summary_read(&test_pool, bench_path("r.jsonl"), &messages, &found, NULL, &s), ROTID_OK);
    assert_true(s.ncells == 1 && s.done == RUNS && s.runs == RUNS && s.missing == 0 && s.failed == 1 && s.nerrors == 1);
    const struct study_cell_result *cell = &s.cells[0];
    assert_true(cell->converged == 3 && cell->at_bound == 1 && cell->not_converged == 1 && cell->failed == 1);
    assert_int_equal(cell->not_adequate,
                     1); /* 1 % of one degree of freedom is at 6.635, and what did not converge is not judged */
    const struct cell_parameter *p = &cell->parameters[0];
    assert_true(cell->nparameters == 1 && p->count == 4 && p->min == 2 && p->max == 6);
    assert_close(p->mean, 4, 1e-14, 0);
    assert_close(p->std, sqrt(10.0 / 3), 1e-14, 0);
    assert_close(p->mean_stated_std, 2, 1e-14, 0);
    assert_close(p->bias, 1, 1e-14, 0);
    assert_close(p->rms_error, sqrt((1 + 0 + 4 + 9) / 4.0), 1e-14, 0);
    assert_close(p->std_error, sqrt(10.0 / 3), 1e-13, 0);
    assert_close(p->coverage95, 1, 1e-14, 0); /* the interval of every line holds 3 */
    assert_close(s.seconds, 0.015, 1e-9, 0);
}

TEST_GROUP(bench_make, bench_remove);
