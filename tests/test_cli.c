/* The program as its users and their scripts see it: exit codes, what goes to which stream, JSON, files, --set. */
#include <dirent.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "folder.h"
#include "json_value.h"
#include "support.h"

#define PAPER       ROTID_SOURCE_DIR "/input/paper_rotor.inp"
#define BRAKE       ROTID_SOURCE_DIR "/input/brake_reuss_beam.inp"
#define ONE_ELEMENT ROTID_SOURCE_DIR "/tests/data/decks/one_element.inp" /* fewer modes than are shown or looked through */
#define STEEL       ROTID_SOURCE_DIR "/input/solid_steel.inp"

#define MODEL "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=core, MATERIAL=steel\n1, 0.1, 0, 20\n"
#define MODES "*MODES\n1, 500\n2, 1300\n3, 2400\n"

extern char **environ;

struct outcome {
    int code; /* 128 + signal where a signal ended it */
    char *out, *err;
};

static void forget(struct outcome *outcome)
{
    free(outcome->out);
    free(outcome->err);
}

/* Runs rotid with the arguments up to NULL. */
static struct outcome run_into(const char *out, ...)
{
    struct outcome outcome;
    char *arguments[20] = {ROTID_PROGRAM};
    posix_spawn_file_actions_t actions;
    pid_t child;
    int status, count = 1;
    va_list list;
    va_start(list, out);
    while ((arguments[count] = va_arg(list, char *)))
        count++;
    va_end(list);
    assert_int_equal(posix_spawn_file_actions_init(&actions), 0);
    assert_int_equal(posix_spawn_file_actions_addopen(&actions, 1, out, O_WRONLY | O_CREAT | O_TRUNC, 0600), 0);
    assert_int_equal(posix_spawn_file_actions_addopen(&actions, 2, folder_path("stderr"), O_WRONLY | O_CREAT | O_TRUNC, 0600), 0);
    assert_int_equal(posix_spawn(&child, ROTID_PROGRAM, &actions, NULL, arguments, environ), 0);
    (void)posix_spawn_file_actions_destroy(&actions);
    assert_true(waitpid(child, &status, 0) == child);
    outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    outcome.out = strncmp(out, "/dev/", 5) ? file_bytes(out, NULL) : NULL;
    outcome.err = file_bytes(folder_path("stderr"), NULL);
    return outcome;
}

#define run(...) run_into(folder_path("stdout"), __VA_ARGS__, (char *)NULL)

/* Exit code, and what the streams hold: NULL nothing, else a part of it ("" anything). */
static int is(struct outcome outcome, int code, const char *out, const char *err)
{
    int good = outcome.code == code && (out ? outcome.out && strstr(outcome.out, out) != NULL : !outcome.out || !*outcome.out) &&
               (err ? strstr(outcome.err, err) != NULL : !*outcome.err);
    if (!good)
        print_error("exit code %d, expected %d; standard output:\n%s\nstandard error:\n%s\n", outcome.code, code,
                    outcome.out ? outcome.out : "", outcome.err);
    forget(&outcome);
    return good;
}

/* Runs and returns the JSON of standard output, which carries nothing else; to be deleted. */
static cJSON *json_of(const char *command, const char *deck, const char *option, const char *value, int code)
{
    struct outcome outcome = run(command, deck, "--json", "-",
                                 strcmp(command, "identify") ? "--set=FIT.DERIVATIVE=NELSON" : "--no-baseline", option, value);
    assert_int_equal(outcome.code, code);
    cJSON *json = cJSON_ParseWithOpts(outcome.out, NULL, 1);
    assert_true(cJSON_IsObject(json));
    forget(&outcome);
    return json;
}

static void has_keys(const cJSON *json, const char *keys)
{
    char list[512], *rest = NULL;
    (void)snprintf(list, sizeof list, "%s", keys);
    for (char *key = strtok_r(list, " ", &rest); key; key = strtok_r(NULL, " ", &rest))
        (void)get(json, key);
}

static int left_over(const char *prefix)
{
    int found = 0;
    DIR *stream = opendir(folder);
    assert_non_null(stream);
    for (struct dirent *entry; (entry = readdir(stream));)
        found += !strncmp(entry->d_name, prefix, strlen(prefix));
    (void)closedir(stream);
    return found;
}

/* ------------------------------------------------------------------------------------------------ arguments */

UNIT_TEST(wrong_usage_exits_2_and_says_what_was_expected)
{
    assert_true(is(run(NULL), 2, NULL, "usage: rotid COMMAND FILE"));
    assert_true(is(run("identify"), 2, NULL, "no file given, expected rotid COMMAND FILE"));
    assert_true(is(run("identity", PAPER), 2, NULL, "identity is no command: did you mean identify?"));
    assert_true(is(run("check", PAPER, BRAKE), 2, NULL, "is one argument too many, expected one file"));
    assert_true(is(run("check", PAPER, "--fast"), 2, NULL, "--fast"));
    assert_true(is(run("check", PAPER, "--json"), 2, NULL, "--json: expected a value behind it"));
    assert_true(is(run("check", PAPER, "--threads", "0"), 2, NULL, "--threads 0: expected a whole number from 1"));
    assert_true(is(run("check", PAPER, "--threads", "1.5"), 2, NULL, "--threads 1.5: expected a whole number"));
    assert_true(is(run("sensitivity", PAPER, "--seed", "x"), 2, NULL, "--seed x: expected a whole number"));
    assert_true(is(run("sensitivity", PAPER, "--step", "0"), 2, NULL, "--step 0: expected a number"));
    assert_true(is(run("sensitivity", PAPER, "--at", "a.E"), 2, NULL, "--at:1:1: a.E is no parameter of this deck, expected"));
    assert_true(is(run("check", PAPER, "--set", "REDUCTION"), 2, NULL, "--set REDUCTION: expected CARD.OPTION=VALUE"));
    assert_true(is(run("check", PAPER, "--set", "FIT.A=1"), 2, NULL, "--set FIT.A=1:1:1: option A of *FIT is not known"));
    assert_true(is(run("check", PAPER, "--set", "FITS.A=1"), 2, NULL, "--set FITS.A=1:1:1: the deck has no card *FITS"));
    assert_true(is(run("check", folder_path("missing.inp")), 2, NULL, "missing.inp:1:1: cannot read"));
}

UNIT_TEST(help_and_version_exit_0)
{
    assert_true(is(run("--help"), 0, "usage: rotid COMMAND FILE", NULL));
    assert_true(is(run("help"), 0, "usage: rotid COMMAND FILE", NULL));
    assert_true(is(run("help", "identify"), 0, "usage: rotid identify FILE", NULL));
    assert_true(is(run("help", "identfy"), 2, NULL, "identfy is no command: did you mean identify?"));
    assert_true(is(run("version"), 0, "rotid " ROTID_VERSION, NULL));
    assert_true(is(run("-V"), 0, "rotid " ROTID_VERSION, NULL));
    assert_true(is(run("identify", "--help"), 0, "usage: rotid identify FILE", NULL));
    assert_true(is(run("--version"), 0, "rotid " ROTID_VERSION, NULL));
    struct outcome outcome = run("--version");
    assert_int_equal(strstr(outcome.out, ", without NLopt: identify has no baseline\n") != NULL, !WITH_NLOPT);
    forget(&outcome);
}

UNIT_TEST(quiet_commands_print_nothing)
{
    static const char *const commands[] = {"check", "modes", "sensitivity", "identify"};
    for (int c = 0; c < 8; c++)
        assert_true(is(run(commands[c % 4], c < 4 ? PAPER : ONE_ELEMENT, "--quiet"), 0, NULL, NULL));
}

/* ------------------------------------------------------------------------------------------------ results */

UNIT_TEST(json_of_identify_has_the_keys_of_the_interface)
{
    struct outcome outcome = run("identify", PAPER, "--json", "-", "--threads", "1");
    assert_true(outcome.code == 0 && !*outcome.err);
    cJSON *json = cJSON_ParseWithOpts(outcome.out, NULL, 1); /* one object and nothing behind it */
    forget(&outcome);
    has_keys(json, "schema rotid commit blas seed threads command deck status functional reduction objective iterations "
                   "evaluations stop_reason parameters correlation condition_number modes reduction_error_percent "
                   "mesh_error_percent history nlopt baseline seconds");
    assert_int_equal(cJSON_IsTrue(get(json, "nlopt")), WITH_NLOPT);
    assert_true(cJSON_GetArraySize(get(json, "parameters")) == 2 && cJSON_GetArraySize(get(json, "modes")) == 6);
    has_keys(cJSON_GetArrayItem(get(json, "parameters"), 1), "name unit value start lower upper std ci95 at_bound identifiable");
    has_keys(cJSON_GetArrayItem(get(json, "modes"), 5), "mode measured_hz predicted_hz error_percent residual mac nco holdout");
    has_keys(cJSON_GetArrayItem(get(json, "history"), 1), "iteration objective gradient mu gain_ratio step x");
    if (WITH_NLOPT)
        has_keys(cJSON_GetArrayItem(get(json, "baseline"), 0), "algorithm objective evaluations seconds x result");
    assert_string_equal(get(json, "status")->valuestring, "converged");
    assert_string_equal(get(json, "rotid")->valuestring, ROTID_VERSION);
    assert_string_equal(get(json, "deck")->valuestring, PAPER);
    assert_true(get(json, "schema")->valueint == 1 && get(json, "seed")->valueint == 1 && get(json, "threads")->valueint == 1);
    assert_int_equal(cJSON_GetArraySize(cJSON_GetArrayItem(get(json, "correlation"), 1)), 2);
    assert_true(cJSON_IsNull(get(cJSON_GetArrayItem(get(json, "modes"), 0), "mac"))); /* no shape, no number */
    cJSON_Delete(json);
}

UNIT_TEST(every_command_writes_json)
{
    static const char *const commands[] = {"check", "modes", "sensitivity", "identify"};
    for (int c = 0; c < 4; c++) {
        cJSON *json = json_of(commands[c], BRAKE, NULL, NULL, 0);
        assert_string_equal(get(json, "command")->valuestring, commands[c]);
        cJSON_Delete(json);
    }
}

UNIT_TEST(json_is_utf_8_whatever_the_deck_holds)
{
    const char *deck =
        folder_write("deck.inp", "*HEADING\nL\xe4ufer, W\xc3\xa4rme \xe2\x82\n" MODEL); /* Latin-1, UTF-8, cut off */
    struct outcome outcome = run("check", deck, "--json", "-");
    assert_non_null(strstr(outcome.out, ", W\xc3\xa4rme "));
    assert_null(strchr(outcome.out, '\xe4'));
    assert_null(strstr(outcome.out, "\xe2\x82\""));
    assert_true(is(outcome, 0, "", NULL));
}

UNIT_TEST(a_result_at_a_bound_is_written_and_exits_1)
{
    const char *deck = folder_write("deck.inp", MODEL MODES "*IDENTIFY\ncore.E, 1e10, 1.5e11, 1e11\n");
    cJSON *json = json_of("identify", deck, NULL, NULL, 1);
    const cJSON *parameter = cJSON_GetArrayItem(get(json, "parameters"), 0);
    assert_true(!strcmp(get(json, "status")->valuestring, "at_bound") && cJSON_IsTrue(get(parameter, "at_bound")));
    assert_close(get(parameter, "value")->valuedouble, 1.5e11, 1e-6, 0);
    cJSON_Delete(json);
}

UNIT_TEST(a_parameter_without_effect_is_flagged_and_exits_1)
{
    const char *deck = folder_write("deck.inp", MODEL MODES "*DISK, NAME=ghost\n0.5, 0, 1e-9\n*IDENTIFY\n"
                                                            "core.E, 1e10, 4e11, 2e11\nghost.inertia, 1e-12, 1e-6, 1e-9\n");
    cJSON *json = json_of("identify", deck, NULL, NULL, 1);
    assert_true(cJSON_IsFalse(get(cJSON_GetArrayItem(get(json, "parameters"), 1), "identifiable")));
    cJSON_Delete(json);
}

/* Converged and at no bound: three frequencies of a slender bar say next to nothing of its shear modulus. */
UNIT_TEST(an_undetermined_parameter_exits_1)
{
    const char *deck = folder_write("deck.inp", "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n"
                                                "*SHAFT, NAME=bar, MATERIAL=steel\n1, 0.02, 0, 20\n"
                                                "*MODES\n1, 91.8\n2, 253.1\n3, 495.2\n"
                                                "*IDENTIFY\nbar.E, 1e10, 1e12, 1.5e11\nbar.G, 1e9, 1e13, 8e10\n");
    cJSON *json = json_of("identify", deck, NULL, NULL, 1);
    const cJSON *parameters = get(json, "parameters");
    assert_string_equal(get(json, "status")->valuestring, "converged");
    for (int p = 0; p < 2; p++)
        assert_true(cJSON_IsFalse(get(cJSON_GetArrayItem(parameters, p), "at_bound")));
    assert_true(cJSON_IsFalse(get(cJSON_GetArrayItem(parameters, 1), "identifiable")));
    cJSON_Delete(json);
}

UNIT_TEST(nothing_to_identify_or_nothing_measured_exits_2)
{
    const char *deck = folder_write("deck.inp", MODEL "*IDENTIFY\ncore.E, 1e10, 4e11, 2e11\n");
    assert_true(is(run("identify", STEEL, "--json", folder_path("out.json")), 2, NULL, "expected the parameters to identify"));
    assert_true(is(run("identify", deck, "--json", folder_path("out.json")), 2, NULL, "expected *MODES or *MEASURED"));
    assert_int_equal(left_over("out.json"), 0);
}

UNIT_TEST(the_same_run_gives_the_same_json_but_for_the_time)
{
    struct outcome outcome[2];
    for (int i = 0; i < 2; i++)
        outcome[i] = run("identify", PAPER, "--json", "-");
    char *a = outcome[0].out, *b = outcome[1].out;
    int compared = 0;
    for (; *a && *b; a += strcspn(a, "\n") + 1, b += strcspn(b, "\n") + 1) {
        size_t length = strcspn(a, "\n");
        const char *seconds = strstr(a, "\"seconds\":");
        if (seconds && seconds < a + length)
            continue;
        assert_true(strcspn(b, "\n") == length && !memcmp(a, b, length));
        compared++;
    }
    assert_true(!*a && !*b && compared > 100);
    for (int i = 0; i < 2; i++)
        forget(&outcome[i]);
}

UNIT_TEST(warnings_stand_on_standard_error_and_in_the_json)
{
    const char *deck =
        folder_write("deck.inp", MODEL "*TIEROD, NAME=t, MATERIAL=steel, FROM=start, TO=end\n6, 0.01, 0.04, 1e3, 4");
    struct outcome outcome = run("check", deck, "--json", "-");
    cJSON *json = cJSON_Parse(outcome.out);
    assert_int_equal(cJSON_GetArraySize(get(json, "warnings")), 1);
    cJSON_Delete(json);
    assert_true(is(outcome, 0, "", "deck.inp:9:21: warning: rods in 4 elements"));
    outcome = run("identify", deck); /* refused: the warning is said before the errors, and once */
    assert_ptr_equal(strstr(outcome.err, "warning"), outcome.err + strlen(deck) + strlen(":9:21: "));
    assert_null(strstr(strchr(outcome.err, '\n'), "warning"));
    forget(&outcome);
}

/* ------------------------------------------------------------------------------------------------ files */

UNIT_TEST(what_cannot_be_written_exits_3_and_leaves_nothing)
{
    assert_true(is(run("check", BRAKE, "--quiet", "--json", folder_path("none/out.json")), 3, NULL, "cannot write"));
    assert_true(is(run("check", BRAKE, "--quiet", "--json", folder), 3, NULL, "cannot write"));
    assert_int_equal(left_over("none"), 0);
    assert_true(is(run_into("/dev/full", "check", BRAKE, NULL), 3, NULL, "cannot write to standard output"));
    assert_true(is(run_into("/dev/full", "check", BRAKE, "--json", "-", NULL), 3, NULL, "No space left on device"));
    assert_true(is(run_into("/dev/full", "identify", BRAKE, "--no-baseline", NULL), 3, NULL, "cannot write to standard output"));
    assert_true(is(run_into("/dev/full", "--help", NULL), 3, NULL, "cannot write to standard output"));
    assert_true(is(run_into("/dev/full", "--version", NULL), 3, NULL, "cannot write to standard output"));
}

UNIT_TEST(a_result_is_replaced_as_a_whole_or_not_at_all)
{
    const char *wrong = folder_write("deck.inp", MODEL "*SHAFT\n"), *result = folder_write("out.json", "old\n");
    assert_true(is(run("check", wrong, "--json", result), 2, NULL, "expected"));
    assert_true(is(run("check", wrong, "--json", wrong), 2, NULL, "is the file that is read, expected another one"));
    char *text = file_bytes(result, NULL);
    assert_string_equal(text, "old\n");
    free(text);
    assert_true(is(run("check", BRAKE, "--json", result), 0, "", NULL));
    text = file_bytes(result, NULL);
    cJSON *json = cJSON_ParseWithOpts(text, NULL, 1);
    assert_true(cJSON_IsObject(json));
    cJSON_Delete(json);
    free(text);
    mode_t mask = umask(0);
    (void)umask(mask);
    struct stat information;
    assert_true(stat(result, &information) == 0 && (information.st_mode & 0777) == (0666 & ~mask));
    assert_int_equal(left_over("out.json"), 1); /* no temporary file beside it */
}

UNIT_TEST(set_changes_the_result)
{
    cJSON *condensed = json_of("identify", PAPER, NULL, NULL, 0);
    cJSON *full = json_of("identify", PAPER, "--set", "FIT.REDUCTION=NONE", 0);
    assert_string_equal(get(condensed, "reduction")->valuestring, "GUYAN");
    assert_string_equal(get(full, "reduction")->valuestring, "NONE");
    assert_true(fabs(get(full, "objective")->valuedouble / get(condensed, "objective")->valuedouble - 1) > 1e-3);
    assert_int_equal(cJSON_GetArraySize(get(full, "baseline")), 0); /* --no-baseline */
    cJSON_Delete(condensed);
    cJSON_Delete(full);
}

UNIT_TEST(a_file_named_by_set_is_looked_for_where_the_user_stands)
{
    char here[4096], deck[512];
    (void)snprintf(deck, sizeof deck, "%s", folder_write("deck.inp", MODEL));
    assert_non_null(getcwd(here, sizeof here));
    assert_int_equal(chdir(ROTID_SOURCE_DIR), 0);
    struct outcome outcome = run("check", deck, "--set", "MEASURED.FILE=tests/data/decks/wrong/two_modes.uff");
    assert_int_equal(chdir(here), 0);
    assert_true(is(outcome, 0, "measured modes             2", NULL));
}

TEST_GROUP(folder_make, folder_remove);
