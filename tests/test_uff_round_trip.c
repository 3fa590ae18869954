/* What is written is read again: every struct through a file. */
#include <unistd.h>

#include "support.h"
#include "uff/uff.h"

static char path[] = "/tmp/test_uff_round_trip_XXXXXX";
static struct message_list messages;

static FILE *open_file(void)
{
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    return stream;
}

/* Closes the file and opens a reader at its first set. */
static struct uff_reader *reader_of(FILE *stream, int set)
{
    struct uff_reader *reader;
    struct uff_set found;
    assert_int_equal(fclose(stream), 0);
    message_open(&messages, &test_pool);
    assert_status(uff_open(&test_pool, path, &messages, &reader), ROTID_OK);
    assert_status(uff_next(reader, &found), ROTID_OK);
    assert_int_equal(found.number, set);
    return reader;
}

static void at_end(struct uff_reader *reader)
{
    struct uff_set found;
    assert_int_equal(uff_next(reader, &found), UFF_END);
    assert_int_equal(messages.errors, 0);
    uff_close(reader);
}

POOL_TEST(header_and_units)
{
    const struct uff_header header = {.model = "rotor.mdl",
                                      .description = "hammer test",
                                      .program = "bench",
                                      .created = "21-NOV-26 16:31:39",
                                      .version = {4, 10},
                                      .file_type = 1,
                                      .saved = "22-NOV-26 08:00:00",
                                      .written_by = "rotid 1",
                                      .written = "22-NOV-26 10:00:00"};
    const struct uff_units units = {.code = 9,
                                    .description = "mm, N",
                                    .temperature_mode = 2,
                                    .length = 1000.0 / 3,
                                    .force = 0.1,
                                    .temperature = 1.8,
                                    .temperature_offset = 459.67};
    struct uff_header header_read;
    struct uff_units units_read;
    FILE *stream = open_file();
    assert_status(uff_write_header(stream, &header), ROTID_OK);
    struct uff_reader *reader = reader_of(stream, 151);
    assert_status(uff_read_header(reader, &header_read), ROTID_OK);
    assert_string_equal(header_read.model, header.model);
    assert_string_equal(header_read.description, header.description);
    assert_string_equal(header_read.program, header.program);
    assert_string_equal(header_read.saved, header.saved);
    assert_string_equal(header_read.written_by, header.written_by);
    assert_string_equal(header_read.written, header.written);
    assert_int_equal(header_read.version[1], 10);
    assert_int_equal(header_read.file_type, 1);
    at_end(reader);
    stream = open_file();
    assert_status(uff_write_units(stream, &units), ROTID_OK);
    reader = reader_of(stream, 164);
    assert_status(uff_read_units(reader, &units_read), ROTID_OK);
    assert_int_equal(units_read.code, 9);
    assert_string_equal(units_read.description, "mm, N");
    assert_true(units_read.length == units.length && units_read.force == units.force);
    assert_true(units_read.temperature == units.temperature && units_read.temperature_offset == units.temperature_offset);
    at_end(reader);
}

POOL_TEST(geometry)
{
    const struct uff_node node[] = {{.id = 7, .definition_system = 1, .color = 8, .x = {1.0 / 3, -2e-7, 1e5}},
                                    {.id = 3, .displacement_system = 2, .x = {0, 0.1, -0.5}}};
    int count;
    for (int set = 15; set; set = set == 15 ? 2411 : 0) {
        struct uff_node *read;
        FILE *stream = open_file();
        assert_status(uff_write_nodes(stream, set, 2, node), ROTID_OK);
        struct uff_reader *reader = reader_of(stream, set);
        assert_status(uff_read_nodes(reader, &test_pool, &count, &read), ROTID_OK);
        assert_int_equal(count, 2);
        for (int i = 0; i < 2; i++) {
            assert_int_equal(read[i].id, node[i].id);
            assert_int_equal(read[i].color, node[i].color);
            for (int c = 0; c < 3; c++)
                assert_close(read[i].x[c], node[i].x[c], set == 15 ? 5e-6 : 0, 0);
        }
        at_end(reader);
    }
}

POOL_TEST(shapes)
{
    static const int analysis[] = {0, 2, 3, 5, 7};
    int node[] = {30, 2};
    double real[12] = {1, -0.5, 0.25, 1e-3, 5, 6, 7, 8, 9, 10, 11, 12}, imag[12] = {0, 1, 2, -3, 4, 5, 6, 7, 8, 9, 10, -11};
    for (int a = 0; a < 5; a++)
        for (int complex_ = 0; complex_ < 2; complex_++) {
            int is_eigenvalue = analysis[a] == 3 || analysis[a] == 7;
            struct uff_shape read, shape = {.id = {"mode", "", "line 3"},
                                            .model_type = 1,
                                            .analysis_type = analysis[a],
                                            .data_characteristic = 3,
                                            .specific_type = 12,
                                            .load_case = 2,
                                            .number = 9,
                                            .is_complex = complex_,
                                            .component_count = 6,
                                            .node_count = 2,
                                            .node = node,
                                            .real = real,
                                            .imag = complex_ ? imag : NULL};
            if (is_eigenvalue) {
                shape.eigenvalue[0] = -4.5;
                shape.eigenvalue[1] = 453.25;
                shape.modal_b[1] = 2.5;
            } else {
                shape.frequency_hz = 72.125;
                shape.damping = analysis[a] == 2 ? 0.0125 : 0;
            }
            FILE *stream = open_file();
            assert_status(uff_write_shape(stream, &shape), ROTID_OK);
            struct uff_reader *reader = reader_of(stream, 55);
            assert_status(uff_read_shape_set(reader, &test_pool, &read), ROTID_OK);
            assert_int_equal(read.analysis_type, analysis[a]);
            assert_int_equal(read.number, 9);
            assert_int_equal(read.load_case, 2);
            assert_int_equal(read.component_count, 6);
            assert_string_equal(read.id[2], "line 3");
            assert_string_equal(read.id[1], "");
            assert_memory_equal(read.node, node, sizeof node);
            assert_memory_equal(read.real, real, sizeof real); /* six digits hold them */
            if (complex_)
                assert_memory_equal(read.imag, imag, sizeof imag);
            if (is_eigenvalue)
                assert_true(read.eigenvalue[0] == -4.5 && read.eigenvalue[1] == 453.25 && read.modal_b[1] == 2.5);
            else
                assert_true(read.frequency_hz == 72.125 && read.damping == shape.damping);
            at_end(reader);
        }
}

#define VALUES 1001 /* more than a piece, and no multiple of the numbers on a line */

static double wave(int i, int part)
{
    return part ? cos(0.37 * i) * exp(0.01 * i) : sin(1.0 + 0.11 * i) / (i + 1);
}

/* Relative error that the format leaves. */
static double digits(const struct uff_function *f)
{
    int single = f->ordinate == UFF_REAL_SINGLE || f->ordinate == UFF_COMPLEX_SINGLE;
    return single ? 5.1e-6 : 5.1e-13;
}

POOL_TEST(functions)
{
    static const int ordinate[] = {UFF_REAL_SINGLE, UFF_REAL_DOUBLE, UFF_COMPLEX_SINGLE, UFF_COMPLEX_DOUBLE};
    static double x[VALUES], real[VALUES], imag[VALUES], x_read[VALUES], real_read[VALUES], imag_read[VALUES];
    for (int i = 0; i < VALUES; i++) {
        x[i] = 0.5 * i + 0.125 * (i % 3);
        real[i] = wave(i, 0);
        imag[i] = wave(i, 1);
    }
    for (int variant = 0; variant < 8; variant++) { /* ordinates, spacing */
        struct uff_function_writer writer;
        struct uff_function read, f = {.id = {"H", "", "", "", "last"},
                                       .type = UFF_TRANSFER,
                                       .number = 4,
                                       .response_node = 19,
                                       .response_direction = -1,
                                       .reference_node = 1,
                                       .reference_direction = 3,
                                       .ordinate = ordinate[variant % 4],
                                       .count = VALUES,
                                       .is_even = variant / 4 % 2,
                                       .abscissa = {.specific_type = 18, .label = "Frequency", .unit = "Hz"},
                                       .numerator = {.specific_type = 12, .length = 1, .unit = "m/s2"},
                                       .denominator = {.specific_type = 13, .force = 1, .label = "Force", .unit = "N"}};
        f.start = f.is_even ? 10 : 0;
        f.step = f.is_even ? 0.1953125 : 0; /* seven digits */
        int is_complex = variant % 4 >= 2;
        FILE *stream = open_file();
        assert_status(uff_write_function(stream, &f, &writer), ROTID_OK);
        assert_status(uff_write_values(&writer, 500, x, real, imag), ROTID_OK);
        assert_status(uff_write_values(&writer, VALUES - 500, x + 500, real + 500, imag + 500), ROTID_OK);
        assert_status(uff_end_function(&writer), ROTID_OK);
        struct uff_reader *reader = reader_of(stream, 58);
        assert_status(uff_read_function(reader, &read), ROTID_OK);
        assert_int_equal(read.binary.is_binary, 0);
        assert_int_equal(read.ordinate, f.ordinate);
        assert_int_equal(read.is_even, f.is_even);
        assert_int_equal(read.response_direction, -1);
        assert_string_equal(read.denominator.label, "Force");
        assert_string_equal(read.id[4], "last");
        assert_true(read.start == f.start && read.step == f.step);
        long long done = 0, got = 1;
        while (got) {
            assert_status(uff_read_values(reader, 300, x_read + done, real_read + done, imag_read + done, &got), ROTID_OK);
            done += got;
        }
        assert_int_equal(done, VALUES);
        double tolerance = digits(&f);
        for (int i = 0; i < VALUES; i++) {
            assert_close(real_read[i], real[i], tolerance, 0);
            assert_close(imag_read[i], is_complex ? imag[i] : 0, tolerance, 0);
            assert_close(x_read[i], f.is_even ? f.start + i * f.step : x[i], 5e-6, 0);
        }
        at_end(reader);
    }
}

static int make_file(void **state)
{
    (void)state;
    int descriptor = mkstemp(path);
    return descriptor < 0 || close(descriptor) != 0;
}

static int remove_file(void **state)
{
    (void)state;
    return unlink(path);
}

TEST_GROUP(make_file, remove_file);
