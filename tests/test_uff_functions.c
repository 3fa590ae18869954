/* Sets 58 and 58b: every kind of value in every layout, in pieces of any length, and what writers make of the format. */
#include "support.h"
#include "uff_fixture.h"

enum { COUNT = 13, ROOM = 8192 };

/* A function of COUNT values: x_i = i/2 - 1, or from start and step the same; y_i = 1.5 - i - j i/8. All exact in six digits. */
struct specimen {
    int ordinate, is_even, order; /* order 0: text */
    int x_size;                   /* of an uneven abscissa in binary */
    long long bytes;              /* announced; -1: the right number */
    const char *before_end, *line_end;
    char data[ROOM];
    size_t length;
};

static int is_double(const struct specimen *s)
{
    return s->ordinate == UFF_REAL_DOUBLE || s->ordinate == UFF_COMPLEX_DOUBLE;
}

static int is_complex(const struct specimen *s)
{
    return s->ordinate == UFF_COMPLEX_SINGLE || s->ordinate == UFF_COMPLEX_DOUBLE;
}

static void add_text(struct specimen *s, const char *text)
{
    for (; *text; ++text) {
        if (*text == '\n')
            for (const char *end = s->line_end ? s->line_end : "\n"; *end; ++end)
                s->data[s->length++] = *end;
        else
            s->data[s->length++] = *text;
        assert_true(s->length < ROOM);
    }
}

static void add_number(struct specimen *s, double value, int size)
{
    unsigned char byte[8];
    float single = (float)value;
    memcpy(byte, size == 8 ? (const void *)&value : (const void *)&single, (size_t)size);
    const uint16_t one = 1;
    int machine = *(const unsigned char *)&one ? 1 : 2;
    for (int i = 0; i < size; ++i)
        s->data[s->length++] = (char)byte[machine == s->order ? i : size - 1 - i];
}

static void add_records(struct specimen *s, long long count)
{
    char line[256];
    add_text(s, "Rotor no. 3, caf\xe9\nhammer\n01-JAN-26 10:00:00\n    -1\nNONE\n");
    (void)snprintf(line, sizeof line, "%5d%10d%5d%10d %-10s%10d%4d %-10s%10d%4d\n", 4, 7, 2, 0, "Shaft", 12, -3, "NONE", 1, 3);
    add_text(s, line);
    (void)snprintf(line, sizeof line, "%10d%10lld%10d%13.5E%13.5E%13.5E\n", s->ordinate, count, s->is_even, s->is_even ? -1. : 0,
                   s->is_even ? 0.5 : 0, 0.25);
    add_text(s, line);
    add_text(s, "        18    0    0    0 Frequency            Hz\n"
                "        12    1   -2    3 Acceleration         g                    \n"
                "        13    0    1    0 NONE                 N\n         0    0    0    0\n");
}

static void make(struct specimen *s)
{
    char line[128];
    s->length = 0;
    int per = 1 + is_complex(s) + !s->is_even;
    long long bytes = COUNT * ((is_double(s) ? 8 : 4) * (1 + is_complex(s)) + (s->is_even ? 0 : s->x_size));
    add_text(s, UFF_EDGE);
    if (s->order)
        (void)snprintf(line, sizeof line, "    58b%6d%6d%12d%12lld%6d%6d%12d%12d\n", s->order, 2, 11,
                       s->bytes >= 0 ? s->bytes : bytes, 0, 0, 0, 0);
    else
        (void)snprintf(line, sizeof line, "    58%74s\n", "");
    add_text(s, line);
    add_records(s, COUNT);
    int on_line = 0, columns = !is_double(s) ? 6 : per == 3 ? 3 : 4;
    for (int i = 0; i < COUNT; ++i)
        for (int k = 0; k < per; ++k) {
            int is_x = !s->is_even && !k, is_imag = is_complex(s) && k == per - 1;
            double value = is_x ? 0.5 * i - 1 : is_imag ? -i / 8. : 1.5 - i;
            if (s->order) {
                add_number(s, value, is_x ? s->x_size : is_double(s) ? 8 : 4);
                continue;
            }
            (void)snprintf(line, sizeof line, is_double(s) && !is_x ? "%20.11E" : "%13.5E", value);
            add_text(s, line);
            if (++on_line == columns || (i == COUNT - 1 && k == per - 1)) {
                add_text(s, "\n");
                on_line = 0;
            }
        }
    add_text(s, s->before_end ? s->before_end : "");
    add_text(s, UFF_EDGE);
}

static void check_records(const struct specimen *s, const struct uff_function *f)
{
    assert_int_equal(f->binary.is_binary, s->order != 0);
    assert_int_equal(f->binary.order, s->order);
    assert_string_equal(f->id[0], "Rotor no. 3, caf\xe9");
    assert_string_equal(f->id[3], "    -1"); /* where a text is due it is one */
    assert_string_equal(f->id[4], "");
    assert_int_equal(f->type, UFF_TRANSFER);
    assert_int_equal(f->number, 7);
    assert_int_equal(f->version, 2);
    assert_string_equal(f->response_name, "Shaft");
    assert_int_equal(f->response_node, 12);
    assert_int_equal(f->response_direction, -3);
    assert_string_equal(f->reference_name, "");
    assert_int_equal(f->reference_node, 1);
    assert_int_equal(f->reference_direction, 3);
    assert_int_equal(f->ordinate, s->ordinate);
    assert_int_equal(f->count, COUNT);
    assert_int_equal(f->is_even, s->is_even);
    assert_close(f->z, 0.25, 0, 0);
    assert_int_equal(f->abscissa.specific_type, 18);
    assert_string_equal(f->abscissa.label, "Frequency");
    assert_string_equal(f->abscissa.unit, "Hz");
    assert_int_equal(f->numerator.length, 1);
    assert_int_equal(f->numerator.force, -2);
    assert_int_equal(f->numerator.temperature, 3);
    assert_string_equal(f->numerator.unit, "g");
    assert_string_equal(f->denominator.label, "");
    assert_string_equal(f->denominator.unit, "N");
    assert_string_equal(f->z_axis.unit, "");
}

/* The function at hand, in pieces of `most`. */
static void check_function(struct uff_fixture *fixture, const struct specimen *s, long long most)
{
    struct uff_function function;
    double x[COUNT + 1], real[COUNT + 1], imag[COUNT + 1];
    long long got = 0, total = 0;
    assert_int_equal(uff_read_function(fixture->reader, &function), ROTID_OK);
    check_records(s, &function);
    for (int status = ROTID_OK; total <= COUNT; total += got) {
        status = uff_read_values(fixture->reader, most, x + total, real + total, imag + total, &got);
        assert_int_equal(status, ROTID_OK);
        assert_true(got <= most);
        if (!got)
            break;
    }
    assert_int_equal(total, COUNT);
    for (int i = 0; i < COUNT; ++i) {
        assert_close(x[i], 0.5 * i - 1, 0, 0);
        assert_close(real[i], 1.5 - i, 0, 0);
        assert_close(imag[i], is_complex(s) ? -i / 8. : 0, 0, 0);
    }
    assert_int_equal(uff_read_values(fixture->reader, most, x, real, imag, &got), ROTID_OK); /* and so it stays */
    assert_int_equal(got, 0);
}

UNIT_TEST(every_kind)
{
    static const int ordinate[] = {UFF_REAL_SINGLE, UFF_REAL_DOUBLE, UFF_COMPLEX_SINGLE, UFF_COMPLEX_DOUBLE};
    static const int most[] = {1, 7, 100};
    for (int kind = 0; kind < 4; ++kind)
        for (int variant = 0; variant < 2 * 3 * 2 * 3; ++variant) {
            struct specimen s = {.ordinate = ordinate[kind],
                                 .is_even = variant % 2,
                                 .order = variant / 2 % 3,
                                 .x_size = variant / 6 % 2 ? 8 : 4,
                                 .bytes = -1,
                                 .line_end = variant / 6 % 2 ? "\r\n" : "\n"};
            if (s.x_size == 8 && !is_double(&s))
                s.x_size = 4;
            make(&s);
            struct uff_fixture fixture;
            uff_fixture_bytes(&fixture, s.data, s.length);
            struct uff_set set = uff_fixture_next(&fixture, 58), other;
            assert_int_equal(set.is_binary, s.order != 0);
            assert_int_equal(set.line, 1);
            check_function(&fixture, &s, most[variant / 12]);
            assert_int_equal(uff_next(fixture.reader, &other), UFF_END);
            assert_int_equal(uff_return_to(fixture.reader, &set), ROTID_OK);
            check_function(&fixture, &s, most[variant / 12]);
            uff_fixture_is_quiet(&fixture);
            uff_fixture_close(&fixture);
        }
}

/* What was not read is read over, from every place in a set. */
UNIT_TEST(sets_read_in_part)
{
    static char all[8 * ROOM];
    size_t length = 0;
    struct specimen s;
    for (int i = 0; i < 8; ++i) {
        s = (struct specimen){
            .ordinate = UFF_COMPLEX_DOUBLE, .is_even = i / 2 % 2, .order = i % 2 ? i / 4 + 1 : 0, .x_size = 4, .bytes = -1};
        make(&s);
        memcpy(all + length, s.data, s.length);
        length += s.length;
    }
    for (int values = -1; values <= COUNT; ++values) {
        struct uff_fixture fixture;
        uff_fixture_bytes(&fixture, all, length);
        for (int i = 0; i < 8; ++i) {
            struct uff_function function;
            long long got = 0;
            (void)uff_fixture_next(&fixture, 58);
            if (values >= 0)
                assert_int_equal(uff_read_function(fixture.reader, &function), ROTID_OK);
            if (values > 0)
                assert_int_equal(uff_read_values(fixture.reader, values, NULL, NULL, NULL, &got), ROTID_OK);
            assert_int_equal(got, values > 0 ? values : 0);
        }
        struct uff_set set;
        assert_int_equal(uff_next(fixture.reader, &set), UFF_END);
        uff_fixture_is_quiet(&fixture);
        uff_fixture_close(&fixture);
    }
}

/* The number of bytes announced is 0, or half of it as pyuff writes it for complex values; the end may stand in a line of its
 * own, and the bytes may look like it. */
UNIT_TEST(binary_lengths)
{
    static const char *const before_end[] = {"", "\n", "\r\n"};
    for (int i = 0; i < 9; ++i) {
        struct specimen s = {.ordinate = UFF_COMPLEX_DOUBLE,
                             .is_even = 1,
                             .order = 1,
                             .bytes = i % 3 == 0   ? 0
                                      : i % 3 == 1 ? COUNT * 8
                                                   : 1000000,
                             .before_end = before_end[i / 3]};
        make(&s);
        struct uff_fixture fixture;
        uff_fixture_bytes(&fixture, s.data, s.length);
        struct uff_set set = uff_fixture_next(&fixture, 58), other;
        assert_int_equal(uff_next(fixture.reader, &other), UFF_END);
        uff_fixture_warns(&fixture, "13 values make 208");
        assert_int_equal(uff_return_to(fixture.reader, &set), ROTID_OK);
        check_function(&fixture, &s, 5);
        uff_fixture_warns(&fixture, "13 values make 208"); /* still once */
        uff_fixture_close(&fixture);
    }

    struct specimen s = {.ordinate = UFF_REAL_SINGLE, .is_even = 1, .order = 1, .bytes = -1};
    make(&s);
    memcpy(s.data + s.length - 7 - COUNT * 4, "\n    -1\n    -1\n    58\n", 21);
    struct uff_fixture fixture;
    uff_fixture_bytes(&fixture, s.data, s.length);
    struct uff_set set = uff_fixture_next(&fixture, 58), other;
    assert_int_equal(uff_next(fixture.reader, &other), UFF_END);
    assert_int_equal(uff_return_to(fixture.reader, &set), ROTID_OK);
    struct uff_function function;
    double real[COUNT];
    long long got;
    assert_int_equal(uff_read_function(fixture.reader, &function), ROTID_OK);
    assert_int_equal(uff_read_values(fixture.reader, COUNT, NULL, real, NULL, &got), ROTID_OK);
    assert_int_equal(got, COUNT);
    assert_close(real[COUNT - 1], 1.5 - (COUNT - 1), 0, 0);
    uff_fixture_is_quiet(&fixture);
    uff_fixture_close(&fixture);
}

UNIT_TEST(binary_that_is_wrong)
{
    struct specimen s = {.ordinate = UFF_REAL_DOUBLE, .is_even = 1, .order = 2, .bytes = -1};
    make(&s);
    for (size_t cut = s.length - 7; cut > s.length - 7 - COUNT * 8; --cut) {
        struct uff_fixture fixture;
        struct uff_function function;
        struct uff_set set;
        uff_fixture_bytes(&fixture, s.data, cut);
        (void)uff_fixture_next(&fixture, 58);
        int status = cut % 2 ? uff_read_function(fixture.reader, &function) : uff_next(fixture.reader, &set);
        uff_fixture_refuses(&fixture, status, 13, 0,
                            cut == s.length - 7 ? "expected a line '    -1' behind 104 bytes"
                                                : "bytes before the binary data do");
        assert_int_equal(uff_next(fixture.reader, &set), UFF_END);
        uff_fixture_close(&fixture);
    }
    static const struct {
        int column;
        char byte;
        const char *part;
    } header[] = {{24, '1', "binary numbers in DEC VMS; expected number format 2"},
                  {24, '3', "binary numbers in IBM 5/370; expected number format 2"},
                  {24, '7', "binary numbers in an unknown format"},
                  {18, '9', "unknown byte order"}};
    for (size_t k = 0; k < 4; ++k) {
        struct uff_fixture fixture;
        struct uff_function function;
        double real[4];
        long long got;
        make(&s);
        s.data[7 + header[k].column - 6] = header[k].byte;
        uff_fixture_bytes(&fixture, s.data, s.length);
        (void)uff_fixture_next(&fixture, 58);
        assert_int_equal(uff_read_function(fixture.reader, &function), ROTID_OK); /* what it is can be listed */
        uff_fixture_refuses(&fixture, uff_read_values(fixture.reader, 4, NULL, real, NULL, &got), 13, 0, header[k].part);
        uff_fixture_close(&fixture);
    }
    struct uff_fixture fixture;
    struct uff_function function;
    long long got;
    make(&s);
    memset(s.data + s.length - 7 - 16, 0xff, 8); /* a NaN, the last but one */
    uff_fixture_bytes(&fixture, s.data, s.length);
    (void)uff_fixture_next(&fixture, 58);
    assert_int_equal(uff_read_function(fixture.reader, &function), ROTID_OK);
    uff_fixture_refuses(&fixture, uff_read_values(fixture.reader, 100, NULL, NULL, NULL, &got), 13, 0, "value 12 of 13 is");
    uff_fixture_close(&fixture);
}
