/* The numbers of universal files: to the last bit what strtod makes of them. */
#include "support.h"
#include "uff/uff.h"

static void check_as_strtod(const char *text)
{
    char c_text[128];
    double value = 0;
    (void)snprintf(c_text, sizeof c_text, "%s", text);
    for (char *c = c_text; *c; ++c)
        if (strchr("dDqQ", *c))
            *c = 'e';
    double expected = strtod(c_text, NULL);
    enum uff_fault fault = uff_parse_real(text, strlen(text), &value);
    if (!isfinite(expected)) {
        assert_int_equal(fault, UFF_FAULT_NOT_FINITE);
        return;
    }
    if (fault != UFF_FAULT_NONE || memcmp(&value, &expected, sizeof value) != 0)
        fail_msg("%s: found %a, expected %a", text, value, expected);
}

static uint64_t next_random(uint64_t *state)
{
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    return *state;
}

UNIT_TEST(random_bits)
{
    static const char *const format[] = {"%.5E", "%.12E", "%.16E", "%.17E", "%.24E", "%.0f", "%.6f"};
    uint64_t random = 88172645463325252u;
    for (int i = 0; i < 200000; ++i) {
        char text[512];
        double value;
        uint64_t bits = next_random(&random);
        memcpy(&value, &bits, sizeof value);
        if (i % 2) /* the sizes that measurements have */
            value = ldexp((double)(int64_t)bits, -60 - (int)(bits % 40));
        if (!isfinite(value) || (i % 7 >= 5 && fabs(value) > 1e80))
            continue;
        (void)snprintf(text, sizeof text, format[i % 7], value);
        char *letter = strchr(text, 'E');
        if (letter && i % 3)
            *letter = "dDqQ"[i % 4];
        check_as_strtod(text);
    }
}

UNIT_TEST(corners)
{
    static const char *const text[] = {"0",
                                       "-0",
                                       "+0.0",
                                       "-.0e-999",
                                       "1e22",
                                       "1e23",
                                       "9007199254740993",
                                       "9007199254740992e1",
                                       "9007199254740993.0e-1",
                                       "123456789012345678",
                                       "1234567890123456789",
                                       "0.000000000000000000000000000000000012345678901234567",
                                       "4.9e-324",
                                       "2.4e-324",
                                       "2.2250738585072011e-308",
                                       "1.7976931348623157e308",
                                       "1.7976931348623159e308",
                                       "1e-400",
                                       "1e99999999999",
                                       "1e-99999999999",
                                       "0e99999999999",
                                       "1.",
                                       ".5",
                                       "00000000000000000000000000000000001e5"};
    for (size_t i = 0; i < sizeof text / sizeof *text; ++i)
        check_as_strtod(text[i]);
    double value;
    static const struct {
        const char *text;
        double value;
    } fortran[] = {{"1.0-100", 1e-100}, {"-1.5+003", -1500}, {"1.0D+00", 1}, {"1.0q2", 100}};
    for (size_t i = 0; i < sizeof fortran / sizeof *fortran; ++i) {
        assert_int_equal(uff_parse_real(fortran[i].text, strlen(fortran[i].text), &value), UFF_FAULT_NONE);
        assert_close(value, fortran[i].value, 0, 0);
    }
    static const char *const wrong[] = {"", "-", ".", "e5", "1e", "1e+", "1-2", "1.2.3", "0x10", "1 2", "1.0e5x", "1.0e5-3"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; ++i)
        assert_int_equal(uff_parse_real(wrong[i], strlen(wrong[i]), &value), UFF_FAULT_MALFORMED);
}
