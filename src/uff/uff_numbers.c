#include "uff/uff_numbers.h"

#include <limits.h>
#include <math.h>
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

enum uff_fault uff_parse_real(const char *text, size_t length, double *value)
{
    char c_text[128];
    size_t n = 0, i = 0;
    int digits = 0, exponent_digits = 0, points = 0;
    if (is_not_finite(text, length))
        return UFF_FAULT_NOT_FINITE;
    if (length + 2 > sizeof c_text)
        return UFF_FAULT_MALFORMED;
    if (i < length && (text[i] == '-' || text[i] == '+'))
        c_text[n++] = text[i++];
    for (; i < length && (is_digit(text[i]) || (text[i] == '.' && !points)); ++i) {
        digits += is_digit(text[i]);
        points += text[i] == '.';
        c_text[n++] = text[i];
    }
    if (!digits)
        return UFF_FAULT_MALFORMED;
    if (i < length) {
        c_text[n++] = 'e';
        int letter = memchr("eEdDqQ", text[i], 6) != NULL;
        i += (size_t)letter;
        int sign = i < length && (text[i] == '-' || text[i] == '+');
        if (!letter && (!sign || !points))
            return UFF_FAULT_MALFORMED;
        if (sign)
            c_text[n++] = text[i++];
        for (; i < length && is_digit(text[i]); ++i, ++exponent_digits)
            c_text[n++] = text[i];
        if (i < length || !exponent_digits)
            return UFF_FAULT_MALFORMED;
    }
    c_text[n] = '\0';
    char *end;
    *value = strtod(c_text, &end);
    if (end != c_text + n) /* a locale with a decimal comma */
        return UFF_FAULT_MALFORMED;
    return isfinite(*value) ? UFF_FAULT_NONE : UFF_FAULT_NOT_FINITE;
}
