/* What holds a program: too little address space, a pipe with nobody at its other end, a computation that does not look at
 * signals. None of these does. */
#include <signal.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "cli/interrupt.c" /* of the program, which the tests do not link */
#include "shell.h"
#include "support.h"

#ifndef ROTID_FLAGS
#define ROTID_FLAGS ""
#endif

#define DECK    ROTID_SOURCE_DIR "/input/paper_rotor.inp"
#define UFF     ROTID_SOURCE_DIR "/tests/data/uff/beam_excerpt.uff"
#define MODES   ROTID_SOURCE_DIR "/tests/data/uff/real_modes.uff"
#define LIMITED "timeout -s KILL 120 " ROTID_PROGRAM " "

#define STEEL "*MATERIAL, NAME=steel\n*ELASTIC\n2e11, 0.3\n*DENSITY\n7850\n"
#define SHAFT STEEL "*SHAFT, NAME=bar, MATERIAL=steel\n1, 0.05, 0"

static char folder[] = "/tmp/test_limits_XXXXXX";

static int setup(void **state)
{
    (void)state;
    return mkdtemp(folder) ? 0 : -1;
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

/* ---- address space */

/* Sanitizers take terabytes of it, and other libraries do not need the buffer. */
static int without_limits(void)
{
    return strstr(ROTID_FLAGS, "-fsanitize") || !strstr(shell(&test_pool, ROTID_PROGRAM " --version"), "OpenBLAS");
}

POOL_TEST(little_address_space_is_said)
{
    const char *output;
    if (without_limits())
        return;
    for (int kib = 120000; kib <= 200000; kib += 40000) {
        static const char *const command[] = {"identify " DECK, "check " DECK, "diagnose " DECK, "ema " UFF,
                                              "study " DECK " -o x.jsonl"};
        for (size_t c = 0; c < sizeof command / sizeof *command; c++) {
            assert_int_equal(shell_code(&test_pool, &output,
                                        "cd %s; unset OPENBLAS_NUM_THREADS; ulimit -v %d; " LIMITED "%s --quiet", folder, kib,
                                        command[c]),
                             3);
            assert_non_null(strstr(output, "rotid: too little address space: OpenBLAS needs 128 MiB"));
        }
        (void)shell(&test_pool,
                    "unset OPENBLAS_NUM_THREADS; ulimit -v %d; " LIMITED "--help && " LIMITED "--version && " LIMITED "uff " UFF,
                    kib);
    }
    assert_int_equal(shell_code(&test_pool, &output, "ulimit -d 120000; " LIMITED "identify " DECK " --quiet"), 3);
    assert_int_equal(shell_code(&test_pool, NULL, "test -e %s/x.jsonl", folder), 1);
}

/* As many threads as there is room for, with the numbers of any other run. */
POOL_TEST(what_fits_is_computed)
{
    const char *output;
    if (without_limits() || sysconf(_SC_NPROCESSORS_ONLN) > 64)
        return;
    const char *all = shell(&test_pool, LIMITED "diagnose " DECK " --json - | grep -v -e seconds -e threads");
    for (int kib = 300000; kib <= 1200000; kib += 450000) {
        assert_string_equal(shell(&test_pool,
                                  "unset OPENBLAS_NUM_THREADS; ulimit -v %d; " LIMITED "diagnose " DECK
                                  " --json - | grep -v -e seconds -e threads",
                                  kib),
                            all);
        (void)shell(&test_pool, "ulimit -v %d; export OPENBLAS_NUM_THREADS=16; " LIMITED "check " DECK, kib);
    }
    assert_int_equal(
        shell_code(&test_pool, &output, "unset OPENBLAS_NUM_THREADS; ulimit -v 300000; " LIMITED "diagnose " DECK " --threads 8"),
        3);
    assert_non_null(strstr(output, "rotid: --threads 8: there is address space for 1, expected no more than these"));
}

/* ---- pipes */

POOL_TEST(a_pipe_without_another_end_is_refused)
{
    const char *said = shell(&test_pool,
                             "cd %s && mkfifo pipe out && for c in 'check pipe' 'uff pipe' 'ema pipe' 'report pipe -o page' "
                             "'study pipe -o x.jsonl' 'study --summary pipe' 'study --merge pipe pipe -o x.jsonl' "
                             "'identify " DECK " --json out' 'frf " DECK " -o out' 'export " DECK " --format dmig -o out'; do "
                             "(said=$(" LIMITED "$c --quiet 2>&1 < /dev/null); echo \"$c: $? $said\") & "
                             "done; wait; ls",
                             folder);
    static const char *const expected[] = {
        "check pipe: 2 pipe:1:1: cannot read pipe: nobody is at the other end of this pipe, expected a deck",
        "uff pipe: 2 pipe:1:1: cannot be opened: nobody is at the other end of this pipe",
        "ema pipe: 2 pipe:1:1: cannot be opened: nobody is at the other end of this pipe",
        "report pipe -o page: 2 pipe: is no regular file, expected one of JSON",
        "study pipe -o x.jsonl: 2 rotid: pipe is no regular file, expected one, for it is read several times",
        "study --summary pipe: 2 pipe:1:1: this is no file of results",
        "study --merge pipe pipe -o x.jsonl: 2 pipe:1:1: this is no file of results",
        "identify " DECK " --json out: 3 rotid: cannot write out: nobody is at the other end of this pipe",
        "frf " DECK " -o out: 3 rotid: cannot write out: nobody is at the other end of this pipe",
        "export " DECK " --format dmig -o out: 3 rotid: cannot write out: nobody is at the other end of this pipe"};
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++)
        if (!strstr(said, expected[i]))
            fail_msg("\"%s\" is not among\n%s", expected[i], said);
    assert_null(strstr(said, "\nx.jsonl"));
    (void)shell(&test_pool, "cd %s && rm -r *", folder);
}

POOL_TEST(a_pipe_with_another_end_is_one_file_more)
{
    const char *json = shell(&test_pool, LIMITED "identify " DECK " --no-baseline --json - | grep -v seconds");
    /* that begins at once, later, and after the wait for one, of which it tells at once by having it open */
    (void)shell(&test_pool, "cat " DECK " | " LIMITED "check /dev/stdin --quiet");
    (void)shell(&test_pool, LIMITED "check /dev/stdin --quiet < " DECK);
    (void)shell(&test_pool, "cat " UFF " | " LIMITED "uff /dev/stdin --quiet");
    (void)shell(&test_pool, "cd %s && mkfifo pipe && { (sleep 1; cat " DECK " > pipe) & } && " LIMITED "check pipe --quiet",
                folder);
    (void)shell(&test_pool, "cd %s && { (sleep 1; cat " UFF " > pipe) & } && " LIMITED "uff pipe --quiet", folder);
    (void)shell(&test_pool,
                "cd %s && mkfifo late && { (sleep 6; cat " DECK ") > late & } && { " LIMITED
                "check late --quiet & } && { sleep 6; cat " DECK "; } | " LIMITED "check /dev/stdin --quiet && wait $!",
                folder);
    assert_string_equal(
        shell(&test_pool,
              "cd %s && { (sleep 1; cat pipe > got) & } && " LIMITED "identify " DECK
              " --no-baseline --json pipe --quiet && wait && while ! grep -q '}$' got; do sleep 0.1; done; grep -v seconds got",
              folder),
        json);
    assert_string_equal(shell(&test_pool, LIMITED "identify " DECK " --no-baseline --quiet --json /dev/stdout | grep -v seconds"),
                        json);
    (void)shell(&test_pool, LIMITED "identify " DECK " --no-baseline --quiet --json /dev/null");
    (void)shell(&test_pool, "cd %s && rm -r *", folder);
}

/* Functions are read a second time, with room for as many values as they announce. */
POOL_TEST(what_is_read_twice_is_no_pipe)
{
    const char *output;
    assert_int_equal(shell_code(&test_pool, &output, "cat " UFF " | " LIMITED "ema /dev/stdin 2>&1"), 2);
    assert_non_null(strstr(output, "/dev/stdin:1:1: this is no regular file, expected one"));
    assert_int_equal(shell_code(&test_pool, &output, "cat " UFF " | " LIMITED "uff /dev/stdin --csv %s/copy 2>&1", folder), 2);
    assert_non_null(strstr(output, "/dev/stdin is a pipe, expected a regular file"));
    (void)shell_code(&test_pool, NULL, LIMITED "uff /dev/stdin --csv %s/copy --quiet < " MODES, folder);
    (void)shell(&test_pool, "cd %s && rm copy.modes.csv copy.shapes.csv", folder);
}

/* ---- signals */

/* A program that never asks command_cancelled, or all the time. */
static pid_t start(int asks)
{
    int ready[2];
    char byte = 0;
    assert_int_equal(pipe(ready), 0);
    pid_t child = fork();
    assert_true(child >= 0);
    if (!child) {
        alarm(120);
        command_watch_signals();
        (void)!write(ready[1], &byte, 1);
        while (!asks)
            (void)pause();
        for (const struct timespec pause = {.tv_nsec = 10000000};; (void)nanosleep(&pause, NULL))
            (void)command_cancelled(NULL);
    }
    assert_int_equal(read(ready[0], &byte, 1), 1);
    (void)close(ready[0]);
    (void)close(ready[1]);
    return child;
}

static void rest(void)
{
    const struct timespec time = {0, 500000000}; /* more than what counts as one request, less than what a program is given */
    (void)nanosleep(&time, NULL);
}

UNIT_TEST(a_second_signal_ends_the_program)
{
    static const int signals[4][2] = {{SIGINT, SIGINT}, {SIGINT, SIGTERM}, {SIGTERM, SIGINT}, {SIGTERM, SIGTERM}};
    pid_t child[4];
    int status;
    for (int i = 0; i < 4; i++) {
        child[i] = start(0);
        assert_int_equal(kill(child[i], signals[i][0]), 0);
    }
    rest();
    for (int i = 0; i < 4; i++) {
        assert_int_equal(waitpid(child[i], &status, WNOHANG), 0);
        assert_int_equal(kill(child[i], signals[i][1]), 0);
        assert_int_equal(waitpid(child[i], &status, 0), child[i]);
        assert_true(WIFSIGNALED(status));
        assert_int_equal(WTERMSIG(status), signals[i][1]);
    }
}

/* As timeout(1) sends its signal twice, and a terminal one beside that of a script. */
UNIT_TEST(two_signals_at_once_are_one)
{
    int status;
    pid_t child = start(0);
    assert_int_equal(kill(child, SIGSTOP), 0);
    assert_int_equal(waitpid(child, &status, WUNTRACED), child);
    assert_int_equal(kill(child, SIGINT), 0);
    assert_int_equal(kill(child, SIGTERM), 0);
    assert_int_equal(kill(child, SIGCONT), 0); /* both are there when it goes on */
    rest();
    assert_int_equal(waitpid(child, &status, WNOHANG), 0);
    assert_int_equal(kill(child, SIGKILL), 0);
    assert_int_equal(waitpid(child, &status, 0), child);
}

static double seconds_to_end(pid_t child, int expected)
{
    struct timespec from, to;
    int status;
    (void)clock_gettime(CLOCK_MONOTONIC, &from);
    assert_int_equal(kill(child, expected), 0);
    assert_int_equal(waitpid(child, &status, 0), child);
    (void)clock_gettime(CLOCK_MONOTONIC, &to);
    assert_true(WIFSIGNALED(status));
    assert_int_equal(WTERMSIG(status), expected);
    return (double)(to.tv_sec - from.tv_sec) + 1e-9 * (double)(to.tv_nsec - from.tv_nsec);
}

/* One signal is enough, for a library that does not ask and for results that do not come together. */
UNIT_TEST(who_does_not_end_is_ended)
{
    assert_in_range((int)(1000 * seconds_to_end(start(0), SIGTERM)), 850, 1800);
    assert_in_range((int)(1000 * seconds_to_end(start(1), SIGINT)), 850, 1800);
}

/* Nothing is written while a deck is read: the first signal ends that. A file that may not grow is no signal at all. */
POOL_TEST(reading_ends_and_limits_of_files_are_errors)
{
    const char *output;
    assert_int_equal(
        shell_code(&test_pool, &output, "cd %s && (sleep 5 | timeout -s TERM 0.5 " ROTID_PROGRAM " check /dev/stdin)", folder),
        124);
    assert_int_equal(shell_code(&test_pool, &output,
                                "cd %s && ulimit -f 1 && " LIMITED "identify " DECK " --no-baseline --json x.json", folder),
                     3);
    assert_non_null(strstr(output, "rotid: cannot write x.json: File too large"));
    assert_string_equal(shell(&test_pool, "ls %s", folder), "");
}

/* 101 sets 55 of modes at three nodes */
POOL_TEST(more_modes_of_a_file_than_a_deck_takes_are_refused)
{
    const char *output;
    (void)shell(
        &test_pool,
        "cd %s && awk 'BEGIN { print \"    -1\\n    15\"; for (i = 1; i < 4; i++) printf "
        "\"%%10d%%10d%%10d%%10d%%13.5e%%13.5e%%13.5e\\n\", i, 0, 0, 1, 0, 0, 0.3 * i; print \"    -1\"; for (k = 1; k <= 101; "
        "k++) { print \"    -1\\n    55\\nNONE\\nNONE\\nNONE\\nNONE\\nNONE\"; printf "
        "\"%%10d%%10d%%10d%%10d%%10d%%10d\\n%%10d%%10d%%10d%%10d\\n%%13.5e%%13.5e%%13.5e%%13.5e\\n\", 1, 2, 2, 8, 2, 3, 2, 4, 1, "
        "k, "
        "100 * k, 1, 0, 0; for (i = 1; i < 4; i++) printf \"%%10d\\n%%13.5e%%13.5e%%13.5e\\n\", i, 1, 0.5 * i, k %% i; print "
        "\"    -1\" } }' > m.uff && printf '" SHAFT "\n*MEASURED, FILE=m.uff, DIRECTION=X, AXIS=Z\n' > deck",
        folder);
    assert_int_equal(shell_code(&test_pool, &output, "cd %s && " LIMITED "check deck 2>&1", folder), 2);
    assert_non_null(strstr(output, "m.uff:1707:1: the number of a mode is 101, expected 1 to 100"));
    (void)shell(&test_pool, "cd %s && rm m.uff deck", folder);
}

/* A pipe into which nobody writes, and one in which nothing more comes: reading ends by the signal and not by an error. */
POOL_TEST(a_signal_is_no_error_of_what_is_read)
{
    static const char *const writer[] = {":", "exec 3<> slow; printf '    -1\\n    55\\n' >&3"};
    for (int w = 0; w < 2; w++) {
        const char *output;
        assert_int_equal(shell_code(&test_pool, &output,
                                    "cd %s && rm -f slow && mkfifo slow && { %s; timeout -s TERM -k 8 0.5 " ROTID_PROGRAM
                                    " uff slow; } 2>&1",
                                    folder, writer[w]),
                         124);
        assert_null(strstr(output, "Interrupted system call"));
        assert_true(w || strstr(output, "rotid: interrupted")); /* else the clock of signals has ended it */
    }
    (void)shell(&test_pool, "cd %s && rm slow", folder);
}

/* Every command on an input that keeps it busy for seconds, or on a program or a pipe that does: ended by the signal of
 * timeout(1), code 124, and not by the SIGKILL that follows, 137, within a second and what the machine is late. */
POOL_TEST(every_command_obeys_within_a_second)
{
    static const char *const command[] = {
        "check solid",
        "modes solid",
        "sensitivity solid --points 1000",
        "identify solid",
        "diagnose solid",
        "suggest solid",
        "frf solid -o f.uff",
        "export solid --format matrix-market -o blocked",
        "ema many.uff",
        "uff slow",
        "study solid -o s.jsonl",
    };
    (void)shell(
        &test_pool,
        "cd %s && mkfifo slow blocked && { printf '" STEEL "' && awk 'BEGIN { "
        "for (i = 0; i < 60; i++) printf \"*SHAFT, NAME=s%%d, MATERIAL=steel\\n0.03, %%g, 0\\n\", i, 0.05 + 0.004 * (7 * "
        "i %% 13); print \"*SENSORS\"; for (i = 0; i < 20; i++) print i + 1 \", \" 0.09 * i; print \"*MODES\"; for (i = 1; "
        "i < 13; i++) print i \", \" 60 * i * i \", 0.01\"; print \"*FIT, MODEL=SOLID\\n*NOISE, FREQUENCY=0.001, "
        "SHAPE=0.02\\n*FRF, LOW=20, HIGH=3200, LINES=16001\\n*IDENTIFY\\ns0.E, 1e10, 4e11, 2e11\\ns30.E, 1e10, 4e11, "
        "2e11\" }'; } > solid && awk '/^    -1$/ && ++n == 2 { exit } { line[NR] = $0 } END { for (i = 1; i < 400; "
        "i++) { for (j = 1; j < NR; j++) if (line[j] ~ /NewModel/) printf \"    4         0    0         0   NewModel%%10d   1"
        "   NewModel        21   1\\n\", i; else print line[j]; print \"    -1\" } }' " UFF " > many.uff",
        folder);
    for (size_t c = 0; c < sizeof command / sizeof *command; c++) {
        int code, ms;
        const char *took =
            shell(&test_pool,
                  "cd %s; { exec 3> slow; sleep 8; } 2> /dev/null & slow=$!; { exec 3< "
                  "blocked; sleep 8; } 2> /dev/null & blocked=$!; begun=$(date +%%s%%N); timeout -s TERM -k 8 0.25 " ROTID_PROGRAM
                  " %s --quiet > said 2>&1; echo $? $((($(date +%%s%%N) - begun) / 1000000)); kill $slow $blocked; "
                  "tail -3 said >&2",
                  folder, command[c]);
        assert_int_equal(sscanf(took, "%d %d", &code, &ms), 2);
        assert_int_equal(code, 124);
        assert_in_range(ms, 250, 5000); /* a second on a quiet machine, and never until it is killed */
    }
    (void)shell(&test_pool, "cd %s && rm -r *", folder);
}

/* ---- decks that are small and ask for much */

POOL_TEST(decks_that_ask_for_much_are_refused_soon)
{
    const char *output;
    (void)shell(&test_pool,
                "cd %s && for i in $(seq 0 14); do for j in 1 2 3 4; do echo \"*INCLUDE, FILE=f$((i + 1))\"; done > f$i; "
                "done; echo '** end' > f15",
                folder);
    assert_int_equal(shell_code(&test_pool, &output, "cd %s && timeout 10 " ROTID_PROGRAM " check f0", folder), 2);
    assert_non_null(strstr(output, "f14:3:16: the deck includes more than 1000 files, expected fewer"));
    assert_null(strstr(output, "larger than")); /* one message */
    (void)shell(&test_pool,
                "cd %s && printf '" SHAFT ", 4\n' > deck && seq 1 2000 | sed 's/.*/*SHAPE, FILE=t.csv/' >> deck && "
                "seq 1 160000 | awk 'BEGIN { print \"mode,sensor,value\" } { print $1 %% 4 + 1 \",\" $1 %% 160 + 1 \",0.5\" "
                "}' > t.csv",
                folder);
    assert_int_equal(shell_code(&test_pool, &output, "cd %s && timeout 30 " ROTID_PROGRAM " check deck", folder), 2);
    assert_non_null(strstr(output, "deck:14:1: the cards of the deck take more than 1000000 rows of tables, expected fewer"));
    (void)shell(&test_pool,
                "cd %s && printf '" SHAFT "\n*MODES\n' > deck && seq 1 1000 | awk '{ print $1 \", \" 100 * $1 }' >> deck",
                folder);
    assert_int_equal(shell_code(&test_pool, &output, "cd %s && timeout 10 " ROTID_PROGRAM " identify deck", folder), 2);
    assert_non_null(strstr(output, "deck:109:1: *MODES has a data line too many"));
    (void)shell(&test_pool, "cd %s && printf '" SHAFT "\n*MODES\n101, 300\n' > deck", folder);
    assert_int_equal(shell_code(&test_pool, &output, "cd %s && " LIMITED "modes deck", folder), 2);
    assert_non_null(strstr(output, "deck:9:1: mode is 101, expected a whole number from 1 to 100"));
    (void)shell(&test_pool, /* a layer that the masses of the rest drown in: the room of the block iteration was passed */
                "cd %s && printf '" STEEL "*SHAFT, NAME=left, MATERIAL=steel\n0.30, 0.05, 0\n*SHAFT, NAME=core, "
                "MATERIAL=steel\n0.40, 0.10, 0\n*LAYER, NAME=stack, GROUP=core, "
                "MATERIAL=steel\n2e5, 0.1\n*FIT, MODEL=SOLID\n' > deck",
                folder);
    assert_int_equal(shell_code(&test_pool, &output, "cd %s && " LIMITED "check deck", folder), 2);
    assert_non_null(strstr(output, "deck:11:1: warning: outer diameter [m] is 2e5, 2e+05 m, outside of what rotors have"));
    assert_non_null(strstr(output, "deck:6:1: a solid of this rotor has too many unknowns"));
    (void)shell(&test_pool, /* few elements, and a band of most of them: its coarse mesh alone takes minutes */
                "cd %s && printf '" STEEL "*SHAFT, NAME=disc, MATERIAL=steel\n0.0006, 4, 0\n*FIT, MODEL=SOLID\n' > deck", folder);
    assert_int_equal(shell_code(&test_pool, &output, "cd %s && timeout 5 " ROTID_PROGRAM " modes deck", folder), 2);
    assert_non_null(strstr(output, "deck:6:1: a solid of this rotor has too many unknowns"));
    (void)shell(&test_pool, "cd %s && rm -r *", folder);
}

TEST_GROUP(setup, teardown);
