/* What the program says to a person: help with examples, the nearest name where one is misspelt, colours on a terminal. */
#define _GNU_SOURCE /* posix_openpt */
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "cli/cli.h"
#include "folder.h"
#include "shell.h"
#include "support.h"

#define PAPER    ROTID_SOURCE_DIR "/input/paper_rotor.inp"
#define MATERIAL "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n"
#define SHAFT    "*SHAFT, NAME=core, MATERIAL=steel\n1, 0.1, 0, 20\n*SPRING, NAME=foot\n0, 1e6\n"

POOL_TEST(help_has_examples_that_the_command_takes)
{
    for (const char *const *c = (const char *const[]){"check", "modes", "sensitivity", "identify", "diagnose", "frf", "ema",
                                                      "test", "export", "uff", "report", "study", NULL};
         *c; c++) {
        const char *help = shell(&test_pool, ROTID_PROGRAM " %s -h", *c), *line = strstr(help, "examples:\n"), *output;
        assert_string_equal(help, shell(&test_pool, ROTID_PROGRAM " %s --help", *c));
        assert_non_null(line);
        int examples = 0;
        for (line = strchr(line, '\n') + 1; *line == ' '; line = strchr(line, '\n') + 1, examples++) {
            const char *wanted = pool_format(&test_pool, "  rotid %s ", *c), *rest = line + strlen("  rotid ");
            assert_int_equal(strncmp(line, wanted, strlen(wanted)), 0);
            /* in an empty folder: nothing but the files is missing */
            int code = shell_code(&test_pool, &output, "cd %s && " ROTID_PROGRAM " %.*s", folder, (int)strcspn(rest, "\n"), rest);
            if (code < 2 || strstr(output, "expected rotid") || strstr(output, "option") || strstr(output, "rotid: --"))
                fail_msg("%.*s: exit code %d, %s", (int)strcspn(line, "\n"), line, code, output);
        }
        assert_true(examples > 0);
    }
}

/* A deck with one mistake, of which the error has this part. */
static void assert_says(const char *deck, const char *part)
{
    const char *output, *path = folder_write("deck.inp", deck);
    assert_int_equal(shell_code(&test_pool, &output, ROTID_PROGRAM " check %s", path), 2);
    if (!strstr(output, part))
        fail_msg("%s: expected %s", output, part);
}

POOL_TEST(the_nearest_name_is_offered)
{
    const char *output;
    assert_says(MATERIAL SHAFT "*MODE\n1, 500\n", "card *MODE is not known, expected *MODES");
    assert_says(MATERIAL SHAFT "*SENSOR\n1, 0\n", "card *SENSOR is not known, expected *SENSORS");
    assert_says(MATERIAL SHAFT "*IDNETIFY\ncore.E, 1e10, 1e12, 2e11\n", "expected *IDENTIFY");
    assert_says(MATERIAL SHAFT "*STEP\n", "card *STEP is not known, expected one of docs/deck.md");
    assert_int_equal(shell_code(&test_pool, &output, ROTID_PROGRAM " modes %s --jsn x", PAPER), 2);
    assert_non_null(strstr(output, "--jsn is no option, expected --json"));
}

POOL_TEST(parameters_that_there_are_are_listed)
{
    const char *output;
    assert_says(MATERIAL SHAFT "*IDENTIFY\nshell.E, 1e10, 1e12, 2e11\n",
                "shell.E is no parameter, expected one of core.E, core.G, core.nu, core.rho, foot.k, foot.k_rot");
    assert_says(MATERIAL SHAFT "*IDENTIFY\ncore.k, 1e10, 1e12, 2e11\n", "expected one of core.E, core.G, core.nu, core.rho\n");
    assert_int_equal(shell_code(&test_pool, &output, ROTID_PROGRAM " sensitivity %s --at foot.E", folder_path("deck.inp")), 2);
    const char *many = MATERIAL SHAFT;
    for (int i = 0; i < 9; i++)
        many = pool_format(&test_pool, "%s*SHAFT, NAME=s%d, MATERIAL=steel\n1, 0.1, 0, 20\n", many, i);
    assert_says(pool_format(&test_pool, "%s*IDENTIFY\nx.E, 1, 3, 2\n", many), "and 18 more");
}

POOL_TEST(distances_count_edits)
{
    assert_int_equal(text_distance("modes", "MODES"), 0);
    assert_int_equal(text_distance("MODE", "MODES"), 1);
    assert_int_equal(text_distance("MOEDS", "MODES"), 1); /* neighbours exchanged */
    assert_int_equal(text_distance("FRQUENCES", "FREQUENCIES"), 2);
    assert_int_equal(text_distance("SET", "SLING"), TEXT_FAR);
    assert_int_equal(text_distance("", "SET"), TEXT_FAR);
    assert_int_equal(text_distance("A123456789012345678901234567890123456789", "SET"), TEXT_FAR);
}

POOL_TEST(an_option_without_a_meaning_is_refused)
{
    static const char *const wrong[][2] = {
        {"check " PAPER " --seed 2", "--seed is no option of check"},
        {"uff x.uff --threads 2", "--threads is no option of uff"},
        {"report x.json -o page --verbose", "--verbose is no option of report"},
        {"ema " ROTID_SOURCE_DIR "/tests/data/uff/beam_excerpt.uff --block 1", "--block is for time records"}};
    const char *output;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_int_equal(shell_code(&test_pool, &output, ROTID_PROGRAM " %s", wrong[i][0]), 2);
        assert_non_null(strstr(output, wrong[i][1]));
    }
}

/* One isotropic material and nothing else: all frequencies go with the root of E. */
POOL_TEST(sensitivity_is_per_cent_for_a_per_cent)
{
    const char *deck = folder_write("deck.inp", MATERIAL "*SHAFT, NAME=core, MATERIAL=steel\n1, 0.1, 0, 20\n"),
               *text = shell(&test_pool, ROTID_PROGRAM " sensitivity %s --at core.E,core.rho", deck), *at = text;
    for (int k = 0; k < 6; k++) {
        at = strstr(at, "+0.5000   -0.5000");
        assert_non_null(at++);
    }
    at = strstr(at, "core.E: E_k = ");
    assert_non_null(at);
    assert_non_null(strstr(at, "-1.0000  -1.0000\n"));
    at = strstr(at, "core.rho: E_k = ");
    assert_non_null(at);
    assert_non_null(strstr(at, "0.99010  1.0000\n")); /* 1 - 1/1.01 for a step of 1 % */
}

POOL_TEST(a_reduction_that_is_none_has_no_column)
{
    static const char deck[] = MATERIAL SHAFT "*SENSORS\n1, 0\n2, 0.3\n3, 0.7\n4, 1\n*MODES\n1, 500\n2, 1300\n"
                                              "*IDENTIFY\ncore.E, 1e10, 1e12, 2e11\n";
    const char *output, *path = folder_write("deck.inp", deck);
    (void)shell_code(&test_pool, &output, ROTID_PROGRAM " identify %s --no-baseline", path);
    assert_non_null(strstr(output, "mode  measured [Hz]  predicted [Hz]  error [%]  mesh [%]"));
    (void)shell_code(&test_pool, &output, ROTID_PROGRAM " identify %s --no-baseline --set FIT.REDUCTION=GUYAN", path);
    assert_non_null(strstr(output, "mode  measured [Hz]  predicted [Hz]  error [%]  reduction [%]  mesh [%]"));
    assert_non_null(strstr(shell(&test_pool, ROTID_PROGRAM " modes %s", path), "condensed [Hz]  reduction [%]"));
    path = folder_write("deck.inp", MATERIAL SHAFT "*SENSORS\n1, 0.3\n");
    assert_null(strstr(shell(&test_pool, ROTID_PROGRAM " modes %s", path), "reduction"));
}

/* What a check of the deck prints where standard error is a terminal. */
static const char *on_terminal(const char *deck, const char *term, const char *no_color)
{
    static char text[4096];
    int master = posix_openpt(O_RDWR | O_NOCTTY);
    size_t length = 0;
    assert_true(master >= 0 && grantpt(master) == 0 && unlockpt(master) == 0);
    int slave = open(ptsname(master), O_RDWR | O_NOCTTY);
    pid_t child = fork();
    assert_true(slave >= 0 && child >= 0);
    if (child == 0) {
        (void)dup2(slave, STDERR_FILENO);
        (void)setenv("TERM", term, 1);
        if (no_color)
            (void)setenv("NO_COLOR", no_color, 1);
        else
            (void)unsetenv("NO_COLOR");
        (void)execl(ROTID_PROGRAM, "rotid", "check", deck, (char *)NULL);
        _exit(127);
    }
    int code;
    assert_int_equal(waitpid(child, &code, 0), child); /* a few hundred bytes: the terminal holds them */
    assert_int_equal(fcntl(master, F_SETFL, O_NONBLOCK), 0);
    for (ssize_t got; (got = read(master, text + length, sizeof text - 1 - length)) > 0;)
        length += (size_t)got;
    text[length] = 0;
    assert_int_equal(close(slave) | close(master), 0);
    return text;
}

POOL_TEST(a_terminal_with_colours_gets_them)
{
    const char *deck = folder_write("deck.inp", MATERIAL SHAFT "*MODE\n\x1b[31m\n");
    const char *text = on_terminal(deck, "xterm-256color", NULL);
    assert_non_null(strstr(text, "\x1b[1m"));
    assert_non_null(strstr(text, "\x1b[31mbyte 0x1b is not text"));
    assert_non_null(strstr(text, "\x1b[0m"));
    assert_null(strchr(on_terminal(deck, "xterm-256color", "1"), '\x1b'));
    assert_non_null(strchr(on_terminal(deck, "xterm-256color", ""), '\x1b')); /* NO_COLOR counts where it is not empty */
    assert_null(strchr(on_terminal(deck, "dumb", NULL), '\x1b'));
    assert_null(strchr(shell(&test_pool, "TERM=xterm " ROTID_PROGRAM " check %s 2>&1 || true", deck), '\x1b'));
}

TEST_GROUP(folder_make, folder_remove);
