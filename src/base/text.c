#include "base/base.h"

#include <ctype.h>

int equal_texts(const char *a, const char *b)
{
    return a == b || (a && b && !strcmp(a, b));
}

int same_text(const char *a, const char *b)
{
    for (; *a && *b; a++, b++)
        if (toupper((unsigned char)*a) != toupper((unsigned char)*b))
            return 0;
    return *a == *b;
}

#define MOST_LETTERS 31

int text_distance(const char *word, const char *other)
{
    int d[MOST_LETTERS + 1][MOST_LETTERS + 1];
    size_t m = strlen(word), n = strlen(other);
    if (m > MOST_LETTERS || n > MOST_LETTERS)
        return TEXT_FAR;
    for (size_t i = 0; i <= m; i++)
        for (size_t j = 0; j <= n; j++) {
            if (!i || !j) {
                d[i][j] = (int)(i + j);
                continue;
            }
            int a = toupper((unsigned char)word[i - 1]), b = toupper((unsigned char)other[j - 1]);
            int least = d[i - 1][j - 1] + (a != b);
            least = d[i - 1][j] + 1 < least ? d[i - 1][j] + 1 : least;
            least = d[i][j - 1] + 1 < least ? d[i][j - 1] + 1 : least;
            if (i > 1 && j > 1 && a == toupper((unsigned char)other[j - 2]) && b == toupper((unsigned char)word[i - 2]))
                least = d[i - 2][j - 2] + 1 < least ? d[i - 2][j - 2] + 1 : least;
            d[i][j] = least;
        }
    return d[m][n] > 3 || 3 * d[m][n] > (int)n ? TEXT_FAR : d[m][n];
}

const char *text_nearest(const char *word, const void *list, size_t stride)
{
    const char *nearest = NULL;
    int least = TEXT_FAR;
    for (const char *at = list, *name; (name = *(const char *const *)at); at += stride) {
        int distance = text_distance(word, name);
        nearest = distance < least ? name : nearest;
        least = distance < least ? distance : least;
    }
    return nearest;
}

size_t text_utf8(const char *text)
{
    const unsigned char *c = (const unsigned char *)text;
    size_t bytes = *c < 0x80 ? 1 : *c < 0xc2 ? 0 : *c < 0xe0 ? 2 : *c < 0xf0 ? 3 : *c < 0xf5 ? 4 : 0;
    for (size_t i = 1; i < bytes; i++)
        if ((c[i] & 0xc0) != 0x80)
            return 0;
    if ((*c == 0xe0 && c[1] < 0xa0) || (*c == 0xed && c[1] > 0x9f) || (*c == 0xf0 && c[1] < 0x90) || (*c == 0xf4 && c[1] > 0x8f))
        return 0;
    return bytes;
}

int text_is_control(const char *text, unsigned *code)
{
    const unsigned char *c = (const unsigned char *)text;
    size_t bytes = text_utf8(text);
    unsigned u = bytes == 1   ? c[0]
                 : bytes == 2 ? (c[0] & 0x1fu) << 6 | (c[1] & 0x3fu)
                 : bytes == 3 ? (c[0] & 0x0fu) << 12 | (c[1] & 0x3fu) << 6 | (c[2] & 0x3fu)
                              : ' '; /* none has four bytes */
    *code = u;
    return u < ' ' || (u >= 0x7f && u < 0xa0) || u == 0x61c || u == 0x200e || u == 0x200f || (u >= 0x2028 && u <= 0x202e) ||
           (u >= 0x2066 && u <= 0x2069);
}

size_t text_visible(const char *text)
{
    unsigned code;
    return text_is_control(text, &code) ? 0 : text_utf8(text);
}

const char *text_of_probability(struct pool *pool, int digits, double probability)
{
    return probability < 1e-4 ? "below 0.01 %" : pool_format(pool, "%.*g %%", digits, 100 * probability);
}
