#include "uff/uff_numbers.h"

#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static int is_digit(char c)
{
    return c >= '0' && c <= '9';
}

enum uff_fault uff_parse_integer(const char *text, size_t length, long long *value)
{
    size_t i = length && (text[0] == '-' || text[0] == '+');
    if (i == length)
        return UFF_FAULT_MALFORMED;
    long long sum = 0;
    enum uff_fault fault = UFF_FAULT_NONE;
    for (; i < length; ++i) {
        if (!is_digit(text[i]))
            return UFF_FAULT_MALFORMED;
        if (sum > (LLONG_MAX - 9) / 10)
            fault = UFF_FAULT_RANGE;
        else
            sum = 10 * sum + (text[i] - '0');
    }
    *value = text[0] == '-' ? -sum : sum;
    return fault;
}

static int is_word(const char *text, size_t length, const char *word)
{
    size_t i = 0;
    while (i < length && word[i] && (text[i] | 0x20) == word[i])
        ++i;
    return !word[i];
}

/* What the C libraries write for a number that is none, such as "-nan", "Infinity", "1.#QNAN". */
static int is_not_finite(const char *text, size_t length)
{
    size_t i = length && (text[0] == '-' || text[0] == '+');
    return is_word(text + i, length - i, "nan") || is_word(text + i, length - i, "inf") ||
           (length - i > 3 && memcmp(text + i, "1.#", 3) == 0);
}

/* Sign, digits with at most one point, and the exponent that Fortran may write without its letter where a point has been. */
struct decimal {
    uint64_t digits; /* all of them as one number, of which `point` stand behind the point; of no use when is_long */
    int is_negative, is_long, point, exponent;
};

/* Digits past this many may not fit into 64 bits, and an exponent of so many decides by itself. */
enum { DIGIT_LIMIT = 18, EXPONENT_LIMIT = 100000 };

static enum uff_fault scan(const char *text, size_t length, struct decimal *out)
{
    size_t i = 0;
    int digits = 0, points = 0, exponent_digits = 0, significant = 0;
    if (i < length && (text[i] == '-' || text[i] == '+'))
        out->is_negative = text[i++] == '-';
    for (; i < length && (is_digit(text[i]) || (text[i] == '.' && !points)); ++i) {
        if (text[i] == '.') {
            points = 1;
            continue;
        }
        ++digits;
        out->point += points;
        significant += significant || text[i] != '0';
        if (significant <= DIGIT_LIMIT)
            out->digits = 10 * out->digits + (uint64_t)(text[i] - '0');
    }
    out->is_long = significant > DIGIT_LIMIT;
    if (!digits)
        return UFF_FAULT_MALFORMED;
    if (i == length)
        return UFF_FAULT_NONE;
    int letter = memchr("eEdDqQ", text[i], 6) != NULL, negative = 0;
    i += (size_t)letter;
    int sign = i < length && (text[i] == '-' || text[i] == '+');
    if (!letter && (!sign || !points))
        return UFF_FAULT_MALFORMED;
    if (sign)
        negative = text[i++] == '-';
    for (; i < length && is_digit(text[i]); ++i, ++exponent_digits)
        if (out->exponent < EXPONENT_LIMIT)
            out->exponent = 10 * out->exponent + (text[i] - '0');
    if (i < length || !exponent_digits)
        return UFF_FAULT_MALFORMED;
    out->exponent = negative ? -out->exponent : out->exponent;
    return UFF_FAULT_NONE;
}

/* By strtod, for what the short way cannot do: the text with the exponent as C writes it. */
static enum uff_fault convert(const char *text, size_t length, double *value)
{
    char c_text[128];
    size_t n = 0;
    int exponent = 0;
    for (size_t i = 0; i < length; ++i) {
        int letter = memchr("eEdDqQ", text[i], 6) != NULL;
        if (!exponent && (letter || (i && (text[i] == '-' || text[i] == '+')))) {
            c_text[n++] = 'e';
            exponent = 1;
            if (letter)
                continue;
        }
        c_text[n++] = text[i];
    }
    c_text[n] = '\0';
    char *end;
    *value = strtod(c_text, &end);
    if (end != c_text + n) /* a locale with a decimal comma */
        return UFF_FAULT_MALFORMED;
    return isfinite(*value) ? UFF_FAULT_NONE : UFF_FAULT_NOT_FINITE;
}

enum uff_fault uff_parse_real(const char *text, size_t length, double *value)
{
    /* powers of ten that a double holds exactly */
    static const double ten[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    struct decimal decimal = {0};
    if (length > 120) /* no format writes that; convert has room for it */
        return is_not_finite(text, length) ? UFF_FAULT_NOT_FINITE : UFF_FAULT_MALFORMED;
    if (scan(text, length, &decimal) != UFF_FAULT_NONE)
        return is_not_finite(text, length) ? UFF_FAULT_NOT_FINITE : UFF_FAULT_MALFORMED;
    int power = decimal.exponent - decimal.point;
    /* both factors are exact, so one rounding, which is what correctly rounded means: as strtod, at a fifth of its time */
    if (FLT_EVAL_METHOD == 0 && !decimal.is_long && decimal.digits <= UINT64_C(1) << DBL_MANT_DIG && power >= -22 &&
        power <= 22) {
        double digits = (double)decimal.digits;
        digits = power < 0 ? digits / ten[-power] : digits * ten[power];
        *value = decimal.is_negative ? -digits : digits;
        return UFF_FAULT_NONE;
    }
    return convert(text, length, value);
}
