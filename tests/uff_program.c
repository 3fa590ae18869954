#include "uff_program.h"

#include <dirent.h>
#include <sys/wait.h>
#include <unistd.h>

#include "support.h"

char uff_folder[] = "/tmp/test_command_uff_XXXXXX";
char uff_output[UFF_OUTPUT_LIMIT];

const char *path_of(const char *name)
{
    static char path[8][512];
    static int next;
    next = (next + 1) % 8;
    (void)snprintf(path[next], sizeof path[next], "%s/%s", uff_folder, name);
    return path[next];
}

/* Runs `rotid uff` in the folder of the test and returns its exit code. */
int run(const char *arguments)
{
    char command[1024];
    (void)snprintf(command, sizeof command, "cd %s && %s uff %s 2>&1", uff_folder, ROTID_PROGRAM, arguments);
    FILE *pipe = popen(command, "r");
    assert_non_null(pipe);
    size_t length = fread(uff_output, 1, sizeof uff_output - 1, pipe);
    uff_output[length] = '\0';
    int status = pclose(pipe);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

void says(const char *arguments, int code, const char *text)
{
    int seen = run(arguments);
    if (seen != code || !strstr(uff_output, text))
        print_error("rotid uff %s: exit code %d for %d, expected \"%s\" in:\n%s\n", arguments, seen, code, text, uff_output);
    assert_true(seen == code && strstr(uff_output, text));
}

char *read_file(const char *name, size_t *length)
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

int is_there(const char *name)
{
    return access(path_of(name), F_OK) == 0;
}

/* Files of the folder whose name begins so. */
int count_files(const char *beginning)
{
    DIR *folder = opendir(uff_folder);
    assert_non_null(folder);
    int count = 0;
    for (const struct dirent *entry; (entry = readdir(folder));)
        count += entry->d_name[0] != '.' && !strncmp(entry->d_name, beginning, strlen(beginning));
    (void)closedir(folder);
    return count;
}

FILE *create(const char *name)
{
    FILE *stream = fopen(path_of(name), "wb");
    assert_non_null(stream);
    return stream;
}

struct uff_function function(int type, int node, int count)
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
void put_function(FILE *stream, const struct uff_function *f, double gain, double most)
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

const struct uff_units uff_si = {
    .code = 1, .description = "SI", .temperature_mode = 1, .length = 1, .force = 1, .temperature = 1};

void put_nodes(FILE *stream, int count)
{
    for (int i = 1; i <= count; i++) {
        const struct uff_node node = {.id = i, .x = {0, 0, 0.25 * i}};
        assert_status(uff_write_nodes(stream, 2411, 1, &node), ROTID_OK);
    }
}

/* Three transfer functions with all that belongs to them, and a set that is not known. */
void make_sound(const char *name)
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
    assert_status(uff_write_units(stream, &uff_si), ROTID_OK);
    put_nodes(stream, 3);
    (void)fputs("    -1\n   999\nkept  \t as it is\r\n    -1\n", stream);
    for (int i = 1; i <= 3; i++) {
        struct uff_function f = function(UFF_TRANSFER, i, 641);
        put_function(stream, &f, 1, INFINITY);
    }
    assert_status(uff_write_shape(stream, &shape), ROTID_OK);
    assert_int_equal(fclose(stream), 0);
}

int make_directory(void **state)
{
    (void)state;
    return mkdtemp(uff_folder) == NULL;
}

int remove_directory(void **state)
{
    (void)state;
    DIR *folder = opendir(uff_folder);
    if (!folder)
        return 1;
    for (const struct dirent *entry; (entry = readdir(folder));)
        if (entry->d_name[0] != '.')
            (void)unlink(path_of(entry->d_name));
    (void)closedir(folder);
    return rmdir(uff_folder);
}
