/* The lines of the writers against lines made by hand from the formats of the sets. */
#include "support.h"
#include "uff/uff.h"

static char *text;
static size_t length;

static FILE *open_text(void)
{
    free(text);
    text = NULL;
    FILE *stream = open_memstream(&text, &length);
    assert_non_null(stream);
    return stream;
}

static void is_text(FILE *stream, const char *expected)
{
    assert_int_equal(fclose(stream), 0);
    assert_string_equal(text, expected);
}

UNIT_TEST(the_header_has_seven_records)
{
    const struct uff_header header = {.model = "rotor.mdl",
                                      .program = "rotid",
                                      .created = "21-NOV-26 16:31:39",
                                      .version = {4, 10},
                                      .file_type = 1,
                                      .saved = "22-NOV-26",
                                      .written_by = "rotid 1",
                                      .written = "22-NOV-26 10:00:00"};
    FILE *stream = open_text();
    assert_status(uff_write_header(stream, &header), ROTID_OK);
    is_text(stream, "    -1\n   151\n"
                    "rotor.mdl\nNONE\nrotid\n"
                    "21-NOV-26 16:31:39           4        10         1\n"
                    "22-NOV-26\nrotid 1\n22-NOV-26 10:00:00\n    -1\n");
}

UNIT_TEST(units_keep_seventeen_digits)
{
    const struct uff_units units = {.code = 2,
                                    .description = "Foot (pound f)",
                                    .temperature_mode = 2,
                                    .length = 3.28083989501312334,
                                    .force = 0.224808943099710480,
                                    .temperature = 1.8,
                                    .temperature_offset = 459.67};
    FILE *stream = open_text();
    assert_status(uff_write_units(stream, &units), ROTID_OK);
    is_text(stream, "    -1\n   164\n"
                    "         2Foot (pound f)               2\n"
                    "   3.2808398950131235E+00   2.2480894309971047E-01   1.8000000000000000E+00\n"
                    "   4.5967000000000002E+02\n"
                    "    -1\n");
}

UNIT_TEST(nodes_stand_in_columns)
{
    const struct uff_node node[] = {
        {.id = 16, .definition_system = 11, .displacement_system = 12, .color = 8, .x = {0, -1.53, 2e-101}},
        {.id = 2147483647, .x = {0.1, 1, -1}}};
    FILE *stream = open_text();
    assert_status(uff_write_nodes(stream, 15, 2, node), ROTID_OK);
    is_text(stream, "    -1\n    15\n"
                    "        16        11        12         8  0.00000E+00 -1.53000E+00 2.00000E-101\n"
                    "2147483647         0         0         0  1.00000E-01  1.00000E+00 -1.00000E+00\n"
                    "    -1\n");
    stream = open_text();
    assert_status(uff_write_nodes(stream, 2411, 1, node), ROTID_OK);
    is_text(stream, "    -1\n  2411\n"
                    "        16        11        12         8\n"
                    "   0.0000000000000000E+00  -1.5300000000000000E+00  2.0000000000000001E-101\n"
                    "    -1\n");
}

UNIT_TEST(shapes_say_their_analysis)
{
    int node[] = {3, 1};
    double real[] = {1, 0, -0.5, 2, 3, 4}, imag[] = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6};
    struct uff_shape shape = {.id = {"mode 1"},
                              .model_type = 1,
                              .analysis_type = 2,
                              .data_characteristic = 2,
                              .specific_type = 8,
                              .load_case = 1,
                              .number = 4,
                              .frequency_hz = 72.125,
                              .damping = 0.01,
                              .modal_mass = 1,
                              .component_count = 3,
                              .node_count = 2,
                              .node = node,
                              .real = real};
    FILE *stream = open_text();
    assert_status(uff_write_shape(stream, &shape), ROTID_OK);
    is_text(stream, "    -1\n    55\nmode 1\nNONE\nNONE\nNONE\nNONE\n"
                    "         1         2         2         8         2         3\n"
                    "         2         4         1         4\n"
                    "  7.21250E+01  1.00000E+00  1.00000E-02  0.00000E+00\n"
                    "         3\n  1.00000E+00  0.00000E+00 -5.00000E-01\n"
                    "         1\n  2.00000E+00  3.00000E+00  4.00000E+00\n"
                    "    -1\n");
    shape.analysis_type = 3;
    shape.is_complex = 1;
    shape.imag = imag;
    stream = open_text();
    assert_status(uff_write_shape(stream, &shape), ROTID_ERROR_ARGUMENT); /* without its eigenvalue */
    (void)fclose(stream);
    shape.eigenvalue[0] = -4.5;
    shape.eigenvalue[1] = 453.2;
    stream = open_text();
    assert_status(uff_write_shape(stream, &shape), ROTID_OK);
    is_text(stream, "    -1\n    55\nmode 1\nNONE\nNONE\nNONE\nNONE\n"
                    "         1         3         2         8         5         3\n"
                    "         2         6         1         4\n"
                    " -4.50000E+00  4.53200E+02  0.00000E+00  0.00000E+00  0.00000E+00  0.00000E+00\n"
                    "         3\n  1.00000E+00  1.00000E-01  0.00000E+00  2.00000E-01 -5.00000E-01  3.00000E-01\n"
                    "         1\n  2.00000E+00  4.00000E-01  3.00000E+00  5.00000E-01  4.00000E+00  6.00000E-01\n"
                    "    -1\n");
}

static struct uff_function transfer(int ordinate, int count)
{
    return (struct uff_function){.id = {"H"},
                                 .type = UFF_TRANSFER,
                                 .number = 1,
                                 .response_name = "TOP",
                                 .response_node = 19,
                                 .response_direction = -1,
                                 .reference_node = 1,
                                 .reference_direction = 3,
                                 .ordinate = ordinate,
                                 .count = count,
                                 .is_even = 1,
                                 .step = 9.765625e-4,
                                 .abscissa = {.specific_type = 18, .label = "Frequency", .unit = "Hz"},
                                 .numerator = {.specific_type = 12, .length = 1, .unit = "m/s2"},
                                 .denominator = {.specific_type = 13, .force = 1, .unit = "N"}};
}

#define RECORDS(form)                                                                                                            \
    "H\nNONE\nNONE\nNONE\nNONE\n"                                                                                                \
    "    4         1    0         0 TOP               19  -1 NONE               1   3\n" form                                    \
    "        18    0    0    0 Frequency            Hz\n"                                                                        \
    "        12    1    0    0 NONE                 m/s2\n"                                                                      \
    "        13    0    1    0 NONE                 N\n"                                                                         \
    "         0    0    0    0 NONE                 NONE\n"

static void write_all(const struct uff_function *function, const double *x, const double *real, const double *imag, FILE *stream)
{
    struct uff_function_writer writer;
    assert_status(uff_write_function(stream, function, &writer), ROTID_OK);
    assert_status(uff_write_values(&writer, 1, x, real, imag), ROTID_OK); /* in two pieces */
    assert_status(uff_write_values(&writer, function->count - 1, x ? x + 1 : NULL, real + 1, imag ? imag + 1 : NULL), ROTID_OK);
    assert_status(uff_write_values(&writer, 1, x, real, imag), ROTID_ERROR_ARGUMENT); /* one too many */
    assert_status(uff_end_function(&writer), ROTID_OK);
}

static const double x[] = {0.5, 1, 2, 4}, real[] = {1, -2, 3.25, 0.1}, imag[] = {0, 5e-10, -1, 7};

UNIT_TEST(text_has_the_columns_of_each_case)
{
    struct uff_function f = transfer(UFF_COMPLEX_SINGLE, 4);
    FILE *stream = open_text();
    write_all(&f, NULL, real, imag, stream);
    is_text(
        stream,
        "    -1\n    58\n" RECORDS(
            "         5         4         1  0.00000E+00 9.765625E-04  0.00000E+00\n") "  1.00000E+00  0.00000E+00 -2.00000E+00  "
                                                                                       "5.00000E-10  3.25000E+00 -1.00000E+00\n"
                                                                                       "  1.00000E-01  7.00000E+00\n    -1\n");
    f = transfer(UFF_REAL_DOUBLE, 4);
    f.is_even = 0;
    stream = open_text();
    write_all(&f, x, real, NULL, stream);
    is_text(stream,
            "    -1\n    58\n" RECORDS(
                "         4         4         0  0.00000E+00  0.00000E+00  0.00000E+00\n") "  5.00000E-01  1.000000000000E+00  "
                                                                                           "1.00000E+00 -2.000000000000E+00\n"
                                                                                           "  2.00000E+00  3.250000000000E+00  "
                                                                                           "4.00000E+00  1.000000000000E-01\n    "
                                                                                           "-1\n");
    f.ordinate = UFF_COMPLEX_DOUBLE;
    f.count = 2;
    stream = open_text();
    write_all(&f, x, real, imag, stream);
    is_text(stream,
            "    -1\n    58\n" RECORDS(
                "         6         2         0  0.00000E+00  0.00000E+00  0.00000E+00\n") "  5.00000E-01  1.000000000000E+00  "
                                                                                           "0.000000000000E+00\n"
                                                                                           "  1.00000E+00 -2.000000000000E+00  "
                                                                                           "5.000000000000E-10\n    -1\n");
    f = transfer(UFF_REAL_DOUBLE, 4);
    stream = open_text();
    write_all(&f, NULL, real, NULL, stream);
    is_text(
        stream,
        "    -1\n    58\n" RECORDS(
            "         4         4         1  0.00000E+00 9.765625E-04  0.00000E+00\n") "  1.000000000000E+00 -2.000000000000E+00 "
                                                                                       " 3.250000000000E+00  "
                                                                                       "1.000000000000E-01\n    -1\n");
}

/* Each of them alone is refused. */
UNIT_TEST(what_the_format_cannot_hold_is_refused)
{
    struct uff_shape shape = {.id = {"    -1"}, .component_count = 1};
    struct uff_node node = {.id = 1, .x = {0, NAN, 0}};
    struct uff_function f = transfer(UFF_REAL_SINGLE, 1);
    struct uff_function_writer writer;
    const double infinite = INFINITY;
    FILE *stream = open_text();
    assert_status(uff_write_shape(stream, &shape), ROTID_ERROR_ARGUMENT);
    (void)strcpy(shape.id[0], "two\nlines");
    assert_status(uff_write_shape(stream, &shape), ROTID_ERROR_ARGUMENT);
    assert_status(uff_write_nodes(stream, 15, 1, &node), ROTID_ERROR_ARGUMENT);
    assert_status(uff_write_nodes(stream, 781, 1, &node), ROTID_ERROR_ARGUMENT);
    assert_status(uff_write_function(stream, &f, &writer), ROTID_OK);
    assert_status(uff_write_values(&writer, 1, NULL, &infinite, NULL), ROTID_ERROR_ARGUMENT);
    assert_status(uff_end_function(&writer), ROTID_ERROR_ARGUMENT); /* a value is missing */
    f.binary = (struct uff_binary){.is_binary = 1, .order = 1, .format = 2};
    assert_status(uff_write_function(stream, &f, &writer), ROTID_ERROR_ARGUMENT);
    f = transfer(7, 1);
    assert_status(uff_write_function(stream, &f, &writer), ROTID_ERROR_ARGUMENT);
    f = transfer(UFF_REAL_SINGLE, 1);
    f.response_direction = -12345;
    assert_status(uff_write_function(stream, &f, &writer), ROTID_ERROR_ARGUMENT);
    (void)fclose(stream);
}

UNIT_TEST(a_full_disk_is_told)
{
    struct uff_function f = transfer(UFF_REAL_DOUBLE, 1);
    struct uff_function_writer writer;
    FILE *stream = fopen("/dev/full", "w");
    assert_non_null(stream);
    (void)setvbuf(stream, NULL, _IONBF, 0);
    assert_status(uff_write_function(stream, &f, &writer), ROTID_ERROR_IO);
    assert_status(uff_write_values(&writer, 1, NULL, real, NULL), ROTID_ERROR_IO);
    (void)fclose(stream);
}

static int forget_text(void **state)
{
    (void)state;
    free(text);
    return 0;
}

TEST_GROUP(NULL, forget_text);
