/* `rotid export` as its users and their scripts see it: what is fitted first, which files there are, what is refused, what is
 * left when something fails, and how large and slow a large model is. */
#include <dirent.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/times.h>
#include <sys/wait.h>
#include <unistd.h>

#include "export_readers.h"
#include "folder.h"
#include "json_value.h"
#include "support.h"

#define PAPER ROTID_SOURCE_DIR "/input/paper_rotor.inp"
#define BRAKE ROTID_SOURCE_DIR "/input/brake_reuss_beam.inp"
#define MODEL                                                                                                                    \
    "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=left, MATERIAL=steel\n0.3, 0.05, 0, 6\n"         \
    "*SHAFT, NAME=core, MATERIAL=steel\n0.4, 0.1, 0.02, 8\n*SHAFT, NAME=right, MATERIAL=steel\n0.3, 0.05, 0, 6\n"
#define MODES    "*MODES\n1, 383\n2, 640\n3, 1690\n"
#define IDENTIFY "*IDENTIFY\ncore.E, 1e9, 1e12, 2e11\n"
#define SENSORS  "*SENSORS\n1, 0\n2, 0.2\n3, 0.4\n4, 0.6\n5, 0.8\n6, 1\n"

static char output[1 << 16], errors[1 << 16];

static void read_into(const char *name, char *text, size_t size)
{
    FILE *stream = fopen(folder_path(name), "rb");
    assert_non_null(stream);
    text[fread(text, 1, size - 1, stream)] = 0;
    (void)fclose(stream);
}

/* Exit code of rotid with the arguments, in the folder of the test; keeps what it prints. */
static int run(const char *arguments)
{
    char command[2048];
    (void)snprintf(command, sizeof command, "cd %s && %s %s > out 2> err", folder, ROTID_PROGRAM, arguments);
    int status = system(command); /* NOLINT: a fixed command of the test */
    read_into("out", output, sizeof output);
    read_into("err", errors, sizeof errors);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

static void refuses(const char *arguments, int code, const char *text)
{
    int seen = run(arguments);
    if (seen != code || !strstr(errors, text))
        fail_msg("rotid %s: exit code %d for %d, expected \"%s\" in:\n%s", arguments, seen, code, text, errors);
    assert_string_equal(output, "");
}

static int is_there(const char *name)
{
    return access(folder_path(name), F_OK) == 0;
}

/* Files whose name begins so. */
static int count_files(const char *beginning)
{
    DIR *stream = opendir(folder);
    int count = 0;
    assert_non_null(stream);
    for (const struct dirent *entry; (entry = readdir(stream));)
        count += !strncmp(entry->d_name, beginning, strlen(beginning));
    (void)closedir(stream);
    return count;
}

static int holds(const char *name, const char *text)
{
    static char content[1 << 22];
    read_into(name, content, sizeof content);
    return strstr(content, text) != NULL;
}

static cJSON *json_of(const char *arguments, int code)
{
    int seen = run(arguments);
    if (seen != code)
        fail_msg("rotid %s: exit code %d for %d: %s", arguments, seen, code, errors);
    cJSON *json = cJSON_ParseWithOpts(output, NULL, 1);
    assert_true(cJSON_IsObject(json));
    return json;
}

static double number_at(const cJSON *json, const char *list, int i, const char *key)
{
    const cJSON *item = cJSON_GetArrayItem(get(json, list), i);
    const cJSON *value = key ? cJSON_GetObjectItem(item, key) : item;
    assert_true(cJSON_IsNumber(value));
    return value->valuedouble;
}

static void empty_folder(void)
{
    char command[256];
    (void)snprintf(command, sizeof command, "rm -rf %s/* ", folder);
    assert_int_equal(system(command), 0); /* NOLINT: a fixed command of the test */
}

/* ------------------------------------------------------------------------------------------------ what is exported */

static int clear(void **state)
{
    (void)state;
    empty_folder();
    return 0;
}

FIXTURE_TEST(test_the_model_is_fitted_first, NULL, clear)
{
    cJSON *fit = json_of("identify " PAPER " --json - --no-baseline", 0);
    cJSON *out = json_of("export " PAPER " --format matrix-market -o p --json -", 0);
    for (int p = 0; p < 2; p++) {
        assert_close(number_at(out, "parameters", p, "value"), number_at(fit, "parameters", p, "value"), 1e-14, 0);
        assert_close(number_at(out, "parameters", p, "std"), number_at(fit, "parameters", p, "std"), 1e-12, 0);
    }
    assert_string_equal(get(out, "model")->valuestring, "identified");
    assert_int_equal(cJSON_GetArraySize(get(out, "files")), 5);
    assert_int_equal(count_files("p."), 5);
    cJSON_Delete(out);
    out = json_of("export " PAPER " --format matrix-market -o p --json - --start", 0);
    cJSON *modes = json_of("modes " PAPER " --json -", 0);
    for (int j = 0; j < 6; j++)
        assert_close(number_at(out, "full_hz", j, NULL), number_at(modes, "modes", j, "full_hz"), 1e-12, 0);
    assert_string_equal(get(out, "model")->valuestring, "stated");
    assert_true(cJSON_IsNull(get(out, "status")));
    assert_close(number_at(out, "parameters", 0, "value"), 1.157e11, 1e-15, 0);
    assert_true(holds("p.mass.mtx", "nothing was fitted"));
    cJSON_Delete(fit);
    cJSON_Delete(out);
    cJSON_Delete(modes);
}

FIXTURE_TEST(test_a_doubtful_fit_is_written_with_exit_code_1, NULL, clear)
{
    (void)folder_write("bound.inp", MODEL MODES "*IDENTIFY\ncore.E, 2.5e11, 1e12, 3e11\n");
    static const char *const formats[] = {"matrix-market", "dmig"};
    for (int f = 0; f < 2; f++) {
        char arguments[128];
        (void)snprintf(arguments, sizeof arguments, "export bound.inp --format %s -o b%d", formats[f], f);
        assert_int_equal(run(arguments), 1);
        assert_non_null(strstr(output, "is not reliable"));
    }
    assert_true(holds("b0.stiffness.mtx", "AT A BOUND") && holds("b1", "AT A BOUND"));
    assert_int_equal(run("export bound.inp --format dmig -o b1 --start"), 0);
}

FIXTURE_TEST(test_a_deck_with_nothing_to_fit, NULL, clear)
{
    (void)folder_write("plain.inp", MODEL);
    assert_int_equal(run("export plain.inp --format matrix-market -o plain"), 0);
    assert_non_null(strstr(output, "as the deck states it"));
    assert_true(holds("plain.condensed_mass.mtx", "row 21: node 21 at 1 m")); /* without sensors all nodes are masters */
    (void)folder_write("open.inp", MODEL IDENTIFY);
    assert_int_equal(run("export open.inp --format dmig -o open.bdf"), 0);
    assert_non_null(strstr(output, "no mode was measured"));
    (void)folder_write("measured.inp", MODEL MODES);
    assert_int_equal(run("export measured.inp --format dmig -o measured.bdf --quiet"), 0);
    assert_string_equal(output, "");
}

FIXTURE_TEST(test_set_changes_the_model, NULL, clear)
{
    cJSON *guyan = json_of("export " PAPER " --start --format matrix-market -o g --json -", 0);
    cJSON *irs = json_of("export " PAPER " --start --format matrix-market -o i --json - --set FIT.REDUCTION=IRS", 0);
    cJSON *rods = json_of("export " PAPER " --start --format matrix-market -o r --json - --set TIEROD.MODEL=RODS", 0);
    assert_string_equal(get(irs, "reduction")->valuestring, "IRS");
    assert_true(holds("i.condensed_mass.mtx", "Condensed by IRS") && holds("g.condensed_mass.mtx", "Condensed by GUYAN"));
    assert_close(number_at(irs, "full_hz", 0, NULL), number_at(guyan, "full_hz", 0, NULL), 1e-14, 0);
    assert_true(fabs(number_at(rods, "full_hz", 1, NULL) / number_at(guyan, "full_hz", 1, NULL) - 1) > 1e-3);
    cJSON_Delete(guyan);
    cJSON_Delete(irs);
    cJSON_Delete(rods);
}

FIXTURE_TEST(test_too_few_sensors_to_condense_onto, NULL, clear)
{
    (void)folder_write("one.inp", MODEL "*SENSORS\n1, 0.3\n");
    cJSON *out = json_of("export one.inp --format matrix-market -o one --json -", 0);
    assert_int_equal(cJSON_GetArraySize(get(out, "files")), 3);
    assert_true(cJSON_IsNull(get(out, "reduction")) && cJSON_IsNull(get(out, "masters")));
    assert_non_null(
        strstr(cJSON_GetArrayItem(get(out, "warnings"), 0)->valuestring, "no condensed matrices: 1 sensor is too few"));
    assert_int_equal(count_files("one."), 4); /* with the deck */
    cJSON_Delete(out);
    refuses("export one.inp --format dmig --condensed -o one.bdf", 2, "no condensed matrices");
    assert_false(is_there("one.bdf"));
    (void)folder_write("two.inp", MODEL "*SENSORS\n1, 0.3\n2, 0.9\n");
    assert_int_equal(run("export two.inp --format dmig --condensed -o two.bdf"), 0);
    assert_non_null(strstr(output, "2 masters are too few"));
}

FIXTURE_TEST(test_sensors_are_the_grids_of_the_condensed_model, NULL, clear)
{
    struct dmig_file file;
    (void)folder_write("ids.inp", MODEL "*SENSORS\n40, 0\n7, 0.2\n99999999, 0.4\n1, 0.7\n3, 1\n");
    assert_int_equal(run("export ids.inp --format dmig --condensed -o ids.bdf"), 0);
    FILE *stream = fopen(folder_path("ids.bdf"), "rb");
    assert_non_null(stream);
    read_bulk(stream, &file);
    (void)fclose(stream);
    const int id[] = {40, 7, 99999999, 1, 3};
    assert_int_equal(file.ngrid, 5);
    for (int g = 0; g < 5; g++)
        assert_true(file.grid[g] == id[g] && is_held(&file, id[g], "23456"));
    assert_true(file.longest <= 80);
    free(file.text);
    (void)folder_write("ids.inp", MODEL "*SENSORS\n40, 0\n100000000, 0.4\n1, 0.7\n");
    refuses("export ids.inp --format dmig --condensed -o no.bdf", 2, "ids.inp:14:1: sensor 100000000 cannot be the id of a GRID");
    assert_int_equal(run("export ids.inp --format dmig -o full.bdf"), 0);
    assert_false(is_there("no.bdf"));
}

FIXTURE_TEST(test_a_solid_has_no_beam_elements, NULL, clear)
{
    folder_write("solid.inp", MODEL SENSORS "*FIT, MODEL=SOLID\n");
    refuses("export solid.inp --format dmig -o x.bdf", 2, "a Nastran deck of rotid has beam elements");
    assert_int_equal(run("export solid.inp --format dmig --condensed -o x.bdf"), 0);
    assert_int_equal(run("export solid.inp --format matrix-market -o x"), 0);
    read_into("x.nodes.csv", output, sizeof output);
    assert_non_null(strstr(output, "node,r_m,z_m,row_u,row_v,row_w,row_theta,member,sensor\n1,0,0,1,1,,,section,\n"));
    assert_int_equal(run("export solid.inp --format dmig -o x.bdf --set FIT.MODEL=BEAM"), 0);
}

/* Texts of a deck end in comments: what other programs would stop at is replaced. */
FIXTURE_TEST(test_names_cannot_break_out, NULL, clear)
{
    (void)folder_write("odd.inp",
                       "*HEADING\n\"\"\" k\xc3\xa4se \\\n*MATERIAL, NAME=s\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, "
                       "NAME=a\");import os#, MATERIAL=s\n1, 0.1, 0, 4\n*DISK, NAME=d\"\\\n0.5, 1, 0.1\n");
    assert_int_equal(run("export odd.inp --format matrix-market -o odd"), 0);
    assert_int_equal(run("export odd.inp --format dmig -o odd.bdf"), 0);
    assert_true(holds("odd.bdf", "$ \"\"\" k??se \\\n") && !holds("odd.bdf", "\xc3"));
}

/* ------------------------------------------------------------------------------------------------ what is refused */

FIXTURE_TEST(test_wrong_arguments, NULL, clear)
{
    (void)folder_write("plain.inp", MODEL);
    refuses("export plain.inp -o x", 2, "expected --format matrix-market or dmig");
    refuses("export plain.inp --format ansys -o x", 2, "--format ansys: expected matrix-market or dmig");
    refuses("export plain.inp --format ascii -o x", 2, "--format ascii: expected matrix-market");
    refuses("export plain.inp --format dmig", 2, "expected --output FILE as well");
    refuses("export plain.inp --format dmig -o -", 2, "expected a file");
    refuses("export plain.inp --format matrix-market --condensed -o x", 2, "--condensed is an option of --format dmig");
    refuses("modes plain.inp --start", 2, "--start is an option of export alone");
    refuses("identify plain.inp --condensed", 2, "--condensed is an option of export alone");
    refuses("modes plain.inp --format dmig", 2, "--format is an option of export alone");
    refuses("uff plain.inp --format dmig", 2, "--format is an option of export alone");
    refuses("export plain.inp --format dmig -o ./plain.inp", 2, "is the file that is read");
    refuses("export plain.inp --format dmig -o x --json x", 2, "is the file of --json as well");
    refuses("export plain.inp --format matrix-market -o x --json x.mass.mtx", 2, "would write x.mass.mtx, the file of --json");
    refuses("export none.inp --format dmig -o x", 2, "none.inp");
    assert_int_equal(rename(folder_path("plain.inp"), folder_path("x.nodes.csv")), 0);
    refuses("export x.nodes.csv --format matrix-market -o x", 2, "would write x.nodes.csv, which is read");
    assert_int_equal(count_files("x"), 1);
    (void)folder_write("wrong.inp", MODEL "*SHAFT\n");
    refuses("export wrong.inp --format dmig -o x", 2, "wrong.inp:");
    (void)folder_write("clash.inp", MODEL MODES IDENTIFY "*FIT, FUNCTIONAL=LIKELIHOOD\n");
    refuses("export clash.inp --format dmig -o x", 2, "LIKELIHOOD");
    assert_int_equal(count_files("x"), 1);
}

static const char *const suffix[] = {"stiffness.mtx", "mass.mtx", "nodes.csv", "condensed_stiffness.mtx", "condensed_mass.mtx"};

/* Whichever of the five cannot be written: those that were there are as they were, those that were not are not. */
FIXTURE_TEST(test_all_files_or_none, NULL, clear)
{
    (void)folder_write("s.inp", MODEL SENSORS);
    for (int bad = 0; bad < 5; bad++) {
        char name[64];
        for (int i = 0; i < 5; i++) {
            (void)snprintf(name, sizeof name, "a.%s", suffix[i]);
            if (i == bad)
                assert_int_equal(mkdir(folder_path(name), 0700), 0); /* in its place */
            else if (i % 2)
                (void)folder_write(name, "old");
        }
        refuses("export s.inp --format matrix-market -o a", 3, "no file was written");
        assert_non_null(strstr(errors, suffix[bad]));
        for (int i = 0; i < 5; i++) {
            (void)snprintf(name, sizeof name, "a.%s", suffix[i]);
            if (i == bad)
                assert_int_equal(rmdir(folder_path(name)), 0);
            else if (i % 2)
                assert_true(holds(name, "old"));
            else
                assert_false(is_there(name));
            (void)unlink(folder_path(name));
        }
        assert_int_equal(count_files("a"), 0); /* nor anything beside them */
    }
    for (int i = 0; i < 5; i++) {
        char name[64];
        (void)snprintf(name, sizeof name, "a.%s", suffix[i]);
        (void)folder_write(name, "old");
    }
    assert_int_equal(run("export s.inp --format matrix-market -o a"), 0);
    assert_int_equal(count_files("a."), 5);
    assert_false(holds("a.mass.mtx", "old") || holds("a.nodes.csv", "old"));
}

FIXTURE_TEST(test_places_that_cannot_be_written, NULL, clear)
{
    (void)folder_write("s.inp", MODEL SENSORS);
    refuses("export s.inp --format dmig -o no/where.bdf", 3, "cannot write no/where.bdf");
    refuses("export s.inp --format matrix-market -o no/where", 3, "cannot write no/where.stiffness.mtx");
    refuses("export s.inp --format dmig -o /dev/full", 3, "No space left on device");
    refuses("export s.inp --format dmig -o /dev/full", 3, "No space left on device");
    (void)folder_write("old.bdf", "old");
    assert_int_equal(symlink("/dev/full", folder_path("f.mass.mtx")), 0); /* one of five, found at the end */
    refuses("export s.inp --format matrix-market -o f", 3, "f.mass.mtx");
    assert_int_equal(count_files("f."), 1);
    assert_int_equal(run("export s.inp --format dmig -o /dev/null"), 0);
}

/* Nine thousand elements are fitted for a third of a second. On a loaded machine the signal may come before the program can take
 * it: later and later, by less than the fit takes from there. */
FIXTURE_TEST(test_an_interrupted_fit_writes_nothing, NULL, clear)
{
    char command[512];
    (void)folder_write(
        "slow.inp", "*MATERIAL, NAME=s\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=a, MATERIAL=s\n0.3, 0.05, 0, 3000\n"
                    "*SHAFT, NAME=b, MATERIAL=s\n0.4, 0.1, 0.02, 3000\n*SHAFT, NAME=c, MATERIAL=s\n0.3, 0.05, 0, 3000\n" MODES
                    "*IDENTIFY\na.E, 1e9, 1e12, 2e10\nb.E, 1e9, 1e12, 2e10\nc.E, 1e9, 1e13, 2e12\n");
    int status = 128 + SIGTERM;
    for (double wait = 0.02; status == 128 + SIGTERM && wait < 20; wait *= 1.5) {
        (void)snprintf(command, sizeof command,
                       "cd %s && timeout --preserve-status -s TERM %g %s export slow.inp --format dmig -o slow.bdf > out 2> err",
                       folder, wait, ROTID_PROGRAM);
        status = WEXITSTATUS(system(command)); /* NOLINT: a fixed command of the test */
    }
    assert_int_equal(status, 1);
    assert_true(holds("err", "interrupted, nothing was written") && !holds("out", "mode"));
    assert_int_equal(count_files("slow."), 1);
}

/* ------------------------------------------------------------------------------------------------ large models */

static long size_of(const char *name)
{
    struct stat state;
    assert_int_equal(stat(folder_path(name), &state), 0);
    return (long)state.st_size;
}

/* Of the programs that were run so far [s]: processor time, which other programs on the machine do not change. */
static double time_of_children(void)
{
    struct tms spent;
    assert_true(times(&spent) != (clock_t)-1);
    return (double)(spent.tms_cutime + spent.tms_cstime) / (double)sysconf(_SC_CLK_TCK);
}

FIXTURE_TEST(test_two_thousand_elements, NULL, clear)
{
    (void)folder_write("long.inp",
                       "*MATERIAL, NAME=s\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=a, MATERIAL=s\n20, 0.4, 0.1, "
                       "2000\n" SENSORS);
    double start = time_of_children();
    assert_int_equal(run("export long.inp --format matrix-market -o long"), 0);
    assert_int_equal(run("export long.inp --format dmig -o long.bdf"), 0);
    double seconds = time_of_children() - start;
    print_message("2000 elements: %.2f s; %ld, %ld bytes\n", seconds, size_of("long.stiffness.mtx"), size_of("long.bdf"));
    assert_true(seconds < 60); /* 1 s here; ten times that under valgrind */
    assert_true(size_of("long.stiffness.mtx") < 1000000 && size_of("long.bdf") < 6000000);
    FILE *stream = fopen(folder_path("long.mass.mtx"), "rb");
    assert_non_null(stream);
    struct dense_file mass = read_market(stream);
    double sum = 0;
    for (ptrdiff_t i = 0; i < mass.n; i += 2)
        for (ptrdiff_t j = 0; j < mass.n; j += 2)
            sum += mass.a[i + j * mass.n];
    assert_close(sum, 7850 * 20 * acos(-1) / 4 * (0.16 - 0.01), 1e-10, 0);
    (void)fclose(stream);
    free(mass.a);
    (void)folder_write("bare.inp",
                       "*MATERIAL, NAME=s\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=a, MATERIAL=s\n20, 0.4, 0.1, "
                       "2000\n");
    assert_int_equal(run("export bare.inp --format matrix-market -o bare"), 0); /* 2,001 masters */
    assert_non_null(strstr(output, "2001 nodes (the deck has no sensors) are too many to condense onto"));
    assert_false(is_there("bare.condensed_mass.mtx"));
}

TEST_GROUP(folder_make, folder_remove);
