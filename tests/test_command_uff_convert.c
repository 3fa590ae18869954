/* rotid uff -o as its users see it: conversion both ways, refusals, no half-written file. */
#include <cJSON.h>
#include <math.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "support.h"
#include "uff_program.h"

extern char **environ;

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
    says("sound.uff --extended out.inp", 2, "--extended is no option of uff, but of diagnose suggest");
    says("../x --replicates 100", 2, "--replicates is no option of uff, but of diagnose suggest");
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
    assert_non_null(strstr(uff_output, "MALFORMED"));
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

/* Interrupted as soon as the uff_output is begun. */
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
    (void)snprintf(in, sizeof in, "%s/large.uff", uff_folder);
    (void)snprintf(out, sizeof out, "%s/half.uff", uff_folder);
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(conversion_goes_both_ways), cmocka_unit_test(a_binary_single_keeps_its_bits_in_text),
        cmocka_unit_test(wrong_usage_is_told),       cmocka_unit_test(a_truncated_file_is_listed_and_not_converted),
        cmocka_unit_test(a_full_disk_is_told),       cmocka_unit_test(an_interrupt_leaves_no_half_file),
    };
    return cmocka_run_group_tests(tests, make_directory, remove_directory);
}
