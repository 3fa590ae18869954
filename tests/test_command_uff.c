/* rotid uff as its users see it: the listing, doubtful places, conversion both ways, refusals, no half-written file. */
#include <cJSON.h>
#include <dirent.h>
#include <math.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "support.h"
#include "uff/uff_write.h"

extern char **environ;

static char directory[] = "/tmp/test_command_uff_XXXXXX";
static char output[1 << 16]; /* both streams of the last run */

static const char *path_of(const char *name)
{
    static char path[8][512];
    static int next;
    next = (next + 1) % 8;
    (void)snprintf(path[next], sizeof path[next], "%s/%s", directory, name);
    return path[next];
}

/* Runs `rotid uff` in the folder of the test and returns its exit code. */
static int run(const char *arguments)
{
    char command[1024];
    (void)snprintf(command, sizeof command, "cd %s && %s uff %s 2>&1", directory, ROTID_PROGRAM, arguments);
    FILE *pipe = popen(command, "r");
    assert_non_null(pipe);
    size_t length = fread(output, 1, sizeof output - 1, pipe);
    output[length] = '\0';
    int status = pclose(pipe);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

static void says(const char *arguments, int code, const char *text)
{
    int seen = run(arguments);
    if (seen != code || !strstr(output, text))
        print_error("rotid uff %s: exit code %d for %d, expected \"%s\" in:\n%s\n", arguments, seen, code, text, output);
    assert_true(seen == code && strstr(output, text));
}

static char *read_file(const char *name, size_t *length)
{
    FILE *stream = fopen(path_of(name), "rb");
    if (!stream)
        return NULL;
    assert_int_equal(fseek(stream, 0, SEEK_END), 0);
    *length = (size_t)ftell(stream);
    rewind(stream);
    char *text = malloc(*length + 1);
    assert_non_null(text);
    assert_int_equal(fread(text, 1, *length, stream), *length);
    text[*length] = '\0';
    (void)fclose(stream);
    return text;
}

static int is_there(const char *name)
{
    return access(path_of(name), F_OK) == 0;
}

/* Files of the folder whose name begins so. */
static int count_files(const char *beginning)
{
    DIR *folder = opendir(directory);
    assert_non_null(folder);
    int count = 0;
    for (const struct dirent *entry; (entry = readdir(folder));)
        count += entry->d_name[0] != '.' && !strncmp(entry->d_name, beginning, strlen(beginning));
    (void)closedir(folder);
    return count;
}

static FILE *create(const char *name)
{
    FILE *stream = fopen(path_of(name), "wb");
    assert_non_null(stream);
    return stream;
}

static struct uff_function function(int type, int node, int count)
{
    int time = type == UFF_TIME, complex_ = type == UFF_TRANSFER;
    struct uff_function f = {.id = {"test"},
                             .type = type,
                             .response_node = node,
                             .response_direction = 1,
                             .reference_node = time ? 0 : 1,
                             .reference_direction = time ? 0 : -3,
                             .ordinate = complex_ ? UFF_COMPLEX_DOUBLE : UFF_REAL_SINGLE,
                             .count = count,
                             .is_even = 1,
                             .step = time ? 1.0 / 1024 : 0.5,
                             .abscissa = {.specific_type = time ? 17 : 18},
                             .numerator = {.specific_type = 12, .length = 1, .unit = "m/s2"},
                             .denominator = {.specific_type = complex_ ? 13 : 0, .force = complex_}};
    (void)strcpy(f.abscissa.unit, time ? "s" : "Hz");
    return f;
}

/* Values: a decaying wave of its own for each node, times `gain`, limited to `most`. */
static void put_function(FILE *stream, const struct uff_function *f, double gain, double most)
{
    struct uff_function_writer writer;
    assert_status(uff_write_function(stream, f, &writer), ROTID_OK);
    for (long long i = 0; i < f->count; i++) {
        double t = (double)i, x = 0.5 * t * t, real = gain * sin(0.8 * t + f->response_node) * exp(-0.01 * t),
               imag = gain * cos(0.3 * t);
        real = real > most ? most : real < -most ? -most : real;
        assert_status(uff_write_values(&writer, 1, &x, &real, &imag), ROTID_OK);
    }
    assert_status(uff_end_function(&writer), ROTID_OK);
}

static const struct uff_units si = {
    .code = 1, .description = "SI", .temperature_mode = 1, .length = 1, .force = 1, .temperature = 1};

static void put_nodes(FILE *stream, int count)
{
    for (int i = 1; i <= count; i++) {
        const struct uff_node node = {.id = i, .x = {0, 0, 0.25 * i}};
        assert_status(uff_write_nodes(stream, 2411, 1, &node), ROTID_OK);
    }
}

/* Three transfer functions with all that belongs to them, and a set that is not known. */
static void make_sound(const char *name)
{
    FILE *stream = create(name);
    int node[] = {1, 2, 3};
    double real[] = {1, 0.5, -1};
    const struct uff_shape shape = {.analysis_type = 2,
                                    .data_characteristic = 1,
                                    .specific_type = 8,
                                    .number = 1,
                                    .frequency_hz = 72.125,
                                    .damping = 0.01,
                                    .component_count = 1,
                                    .node_count = 3,
                                    .node = node,
                                    .real = real};
    assert_status(uff_write_units(stream, &si), ROTID_OK);
    put_nodes(stream, 3);
    (void)fputs("    -1\n   999\nkept  \t as it is\r\n    -1\n", stream);
    for (int i = 1; i <= 3; i++) {
        struct uff_function f = function(UFF_TRANSFER, i, 641);
        put_function(stream, &f, 1, INFINITY);
    }
    assert_status(uff_write_shape(stream, &shape), ROTID_OK);
    assert_int_equal(fclose(stream), 0);
}

static void a_listing_begins_with_what_there_is(void **state)
{
    (void)state;
    make_sound("sound.uff");
    says("sound.uff", 0, "3 transfer functions, 641 lines each, 0 to 320 Hz, responses 1 to 3, reference 1");
    assert_non_null(strstr(output, "1 shape, real, 72.125 to 72.125 Hz, 3 points"));
    assert_non_null(strstr(output, "3 nodes, x 0 to 0, y 0 to 0, z 0.25 to 0.75 m"));
    assert_non_null(strstr(output, "1:+X ... 3:+X / 1:-Z"));
    assert_non_null(strstr(output, "sets 999 are not known"));
    assert_null(strstr(output, "2:+X /")); /* one row for all three */
    says("sound.uff --verbose", 0, "2:+X / 1:-Z");
    says("sound.uff --quiet", 0, "");
    assert_int_equal(strlen(output), 0);
}

/* Kinds of the doubtful places of a file, as ",kind,kind,". */
static void doubts_are(const char *name, const char *expected)
{
    char arguments[256], kinds[1024] = ",";
    (void)snprintf(arguments, sizeof arguments, "%s --json -", name);
    (void)run(arguments);
    cJSON *json = cJSON_Parse(output);
    assert_non_null(json);
    const cJSON *doubt;
    cJSON_ArrayForEach(doubt, cJSON_GetObjectItem(json, "doubtful"))
    {
        const char *kind = cJSON_GetStringValue(cJSON_GetObjectItem(doubt, "kind"));
        (void)snprintf(kinds + strlen(kinds), sizeof kinds - strlen(kinds), "%s,", kind);
    }
    cJSON_Delete(json);
    assert_string_equal(kinds, expected);
}

static void doubtful_places_are_found(void **state)
{
    (void)state;
    FILE *stream = create("doubt.uff");
    assert_status(uff_write_units(stream, &si), ROTID_OK);
    put_nodes(stream, 4);
    const struct uff_node again = {.id = 2, .x = {0, 0, 7}};
    assert_status(uff_write_nodes(stream, 15, 1, &again), ROTID_OK);
    struct uff_function f = function(UFF_TIME, 1, 200);
    put_function(stream, &f, 1, INFINITY);
    f.response_node = 3;
    put_function(stream, &f, 0, INFINITY); /* dead */
    f.response_node = 4;
    put_function(stream, &f, 10, 2); /* clipped */
    f.response_node = 1;
    f.response_direction = 2;
    put_function(stream, &f, 1, INFINITY); /* the first once more */
    f.response_node = 9;                   /* without coordinates */
    f.count = 100;
    (void)strcpy(f.numerator.unit, "g");
    put_function(stream, &f, 1, INFINITY);
    f = function(UFF_COHERENCE, 1, 50);
    f.numerator = (struct uff_axis){0};
    put_function(stream, &f, 1.5, INFINITY);
    f.is_even = 0;
    f.step = 0;
    f.response_node = 3;
    put_function(stream, &f, 0.5, INFINITY);
    assert_int_equal(fclose(stream), 0);
    doubts_are("doubt.uff", ",node_twice,no_coordinates,dead,clipped,unit,coherence,uneven,identical,length,");
    says("doubt.uff", 0, "coherence goes up to 1.4");
    assert_non_null(strstr(output, "functions 1 and 4 have the same values, all 200 of them"));
    assert_non_null(strstr(output, "unit text 'g', which is 9.80665 m/s2, where set 164 says 1"));

    stream = create("bare.uff");
    f = function(UFF_TRANSFER, 1, 20);
    put_function(stream, &f, 1, INFINITY);
    f.response_node = 2;
    f.step = 0.25;
    put_function(stream, &f, 1, INFINITY);
    f.step = -0.5;
    f.response_node = 3;
    put_function(stream, &f, 1, INFINITY);
    assert_int_equal(fclose(stream), 0);
    doubts_are("bare.uff", ",no_units,no_coordinates,abscissa_order,resolution,resolution,");
    make_sound("sound.uff");
    doubts_are("sound.uff", ",unknown_set,");
}

static void a_long_table_is_cut(void **state)
{
    (void)state;
    FILE *stream = create("long.uff");
    for (int i = 0; i < 90; i++) { /* no two neighbours alike */
        struct uff_function f = function(i % 2 ? UFF_TRANSFER : UFF_COHERENCE, i, 3);
        put_function(stream, &f, 0.5, INFINITY);
    }
    assert_int_equal(fclose(stream), 0);
    says("long.uff", 0, "... and 50 more sets; --verbose shows each");
    says("long.uff --verbose", 0, "89:+X / 1:-Z");
    assert_null(strstr(output, "more sets"));
}

static void conversion_goes_both_ways(void **state)
{
    (void)state;
    size_t length[3];
    make_sound("sound.uff");
    says("sound.uff -o binary.uff", 0, "binary.uff: 3 functions in binary (58b, little endian), 6 other sets, 1 of them copied");
    says("binary.uff --output text.uff --format ascii", 0, "text.uff: 3 functions as text (58)");
    char *first = read_file("sound.uff", &length[0]), *binary = read_file("binary.uff", &length[1]);
    char *back = read_file("text.uff", &length[2]);
    assert_int_equal(length[0], length[2]);
    assert_memory_equal(first, back, length[0]); /* 13 digits survive a double */
    assert_non_null(strstr(binary, "    -1\n   999\nkept  \t as it is\r\n    -1\n"));
    says("binary.uff -o again.uff --format binary", 0, "again.uff: 3 functions in binary");
    char *again = read_file("again.uff", &length[2]);
    assert_int_equal(length[1], length[2]);
    assert_memory_equal(binary, again, length[1]);
    free(first);
    free(binary);
    free(back);
    free(again);
}

static void a_binary_single_keeps_its_bits_in_text(void **state)
{
    (void)state;
    size_t length[2];
    FILE *stream = create("single.uff");
    struct uff_function f = function(UFF_TIME, 1, 100);
    f.binary = (struct uff_binary){.is_binary = 1, .order = 1, .format = 2};
    put_function(stream, &f, 1.0 / 3, INFINITY);
    assert_int_equal(fclose(stream), 0);
    assert_int_equal(run("single.uff -o text.uff"), 0);
    assert_int_equal(run("text.uff -o double.uff"), 0);
    assert_int_equal(run("single.uff --json single.json --quiet"), 0);
    assert_int_equal(run("double.uff --json double.json --quiet"), 0);
    char *one = read_file("single.json", &length[0]), *two = read_file("double.json", &length[1]);
    cJSON *single = cJSON_Parse(one), *wide = cJSON_Parse(two);
    const cJSON *a = cJSON_GetArrayItem(cJSON_GetObjectItem(single, "functions"), 0);
    const cJSON *b = cJSON_GetArrayItem(cJSON_GetObjectItem(wide, "functions"), 0);
    assert_int_equal(cJSON_GetObjectItem(a, "ordinate")->valueint, UFF_REAL_SINGLE);
    assert_int_equal(cJSON_GetObjectItem(b, "ordinate")->valueint, UFF_REAL_DOUBLE);
    double x = cJSON_GetArrayItem(cJSON_GetObjectItem(a, "last"), 0)->valuedouble;
    double y = cJSON_GetArrayItem(cJSON_GetObjectItem(b, "last"), 0)->valuedouble;
    assert_close(x, y, 1e-12, 0);
    assert_true((float)x == (float)y);
    cJSON_Delete(single);
    cJSON_Delete(wide);
    free(one);
    free(two);
}

static void wrong_usage_is_told(void **state)
{
    (void)state;
    size_t length;
    make_sound("sound.uff");
    says("", 2, "uff: no file given");
    says("missing.uff", 2, "missing.uff:1:1: cannot be opened");
    says("sound.uff --format ascii", 2, "--format ascii: expected --output as well");
    says("sound.uff -o out.uff --format text", 2, "--format text: expected ascii or binary");
    says("sound.uff -o -", 2, "--output -: expected a file");
    says("sound.uff -o sound.uff", 2, "--output sound.uff is the file that is read");
    says("sound.uff -o ./../../$PWD/sound.uff", 2, "is the file that is read");
    says("sound.uff --json out.uff -o out.uff", 2, "is the file of --json as well");
    says("sound.uff --extended out.inp", 2, "--extended is an option of diagnose alone");
    says("../x --replicates 100", 2, "--replicates is an option of diagnose alone");
    assert_false(is_there("out.uff"));
    char *text = read_file("sound.uff", &length);
    assert_true(length > 1000);
    free(text);
    FILE *stream = create("notes.txt");
    (void)fputs("no universal file at all\n", stream);
    assert_int_equal(fclose(stream), 0);
    says("notes.txt", 2, "no universal file");
    assert_int_not_equal(run("notes.txt -o out.uff"), 0);
    assert_false(is_there("out.uff"));
}

static void a_truncated_file_is_listed_and_not_converted(void **state)
{
    (void)state;
    make_sound("cut.uff");
    assert_int_equal(truncate(path_of("cut.uff"), 60000), 0);
    says("cut.uff", 1, "2 transfer functions");
    assert_non_null(strstr(output, "MALFORMED"));
    says("cut.uff -o out.uff", 2, "out.uff is not written");
    assert_false(is_there("out.uff"));
    assert_int_equal(count_files("out.uff"), 0);
}

static void a_full_disk_is_told(void **state)
{
    (void)state;
    make_sound("sound.uff");
    says("sound.uff -o /dev/full --quiet", 3, "cannot write /dev/full: No space left on device");
    says("sound.uff -o /nowhere/out.uff --quiet", 3, "cannot write /nowhere/out.uff");
    says("sound.uff 3>&1 > /dev/full 2>&3 #", 3, "cannot write to standard output");
    says("sound.uff --quiet --json /dev/full", 3, "cannot write /dev/full");
    assert_int_equal(run("sound.uff -o /dev/null --quiet"), 0);
    FILE *device = fopen("/dev/null", "r"); /* it is still a device, and empty */
    assert_non_null(device);
    assert_int_equal(getc(device), EOF);
    (void)fclose(device);
}

/* Interrupted as soon as the output is begun. */
static void an_interrupt_leaves_no_half_file(void **state)
{
    (void)state;
    FILE *stream = create("large.uff");
    struct uff_function f = function(UFF_TIME, 1, 4000000);
    struct uff_function_writer writer;
    f.binary = (struct uff_binary){.is_binary = 1, .order = 1, .format = 2};
    assert_status(uff_write_function(stream, &f, &writer), ROTID_OK);
    for (int i = 0; i < f.count; i++) {
        const double value = i % 1000;
        assert_status(uff_write_values(&writer, 1, NULL, &value, NULL), ROTID_OK);
    }
    assert_status(uff_end_function(&writer), ROTID_OK);
    assert_int_equal(fclose(stream), 0);

    char in[512], out[512];
    (void)snprintf(in, sizeof in, "%s/large.uff", directory);
    (void)snprintf(out, sizeof out, "%s/half.uff", directory);
    char *arguments[] = {ROTID_PROGRAM, "uff", in, "-o", out, "--quiet", NULL};
    pid_t child;
    int status;
    assert_int_equal(posix_spawn(&child, ROTID_PROGRAM, NULL, NULL, arguments, environ), 0);
    const struct timespec pause = {.tv_nsec = 2000000};
    for (int i = 0; i < 30000 && !count_files("half.uff"); i++)
        (void)nanosleep(&pause, NULL);
    assert_int_equal(kill(child, SIGINT), 0);
    assert_true(waitpid(child, &status, 0) == child);
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), 1);
    assert_int_equal(count_files("half.uff"), 0);
}

static int make_directory(void **state)
{
    (void)state;
    return mkdtemp(directory) == NULL;
}

static int remove_directory(void **state)
{
    (void)state;
    DIR *folder = opendir(directory);
    if (!folder)
        return 1;
    for (const struct dirent *entry; (entry = readdir(folder));)
        if (entry->d_name[0] != '.')
            (void)unlink(path_of(entry->d_name));
    (void)closedir(folder);
    return rmdir(directory);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_listing_begins_with_what_there_is),
        cmocka_unit_test(doubtful_places_are_found),
        cmocka_unit_test(a_long_table_is_cut),
        cmocka_unit_test(conversion_goes_both_ways),
        cmocka_unit_test(a_binary_single_keeps_its_bits_in_text),
        cmocka_unit_test(wrong_usage_is_told),
        cmocka_unit_test(a_truncated_file_is_listed_and_not_converted),
        cmocka_unit_test(a_full_disk_is_told),
        cmocka_unit_test(an_interrupt_leaves_no_half_file),
    };
    return cmocka_run_group_tests(tests, make_directory, remove_directory);
}
