#include "deck/deck.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/base.h"
#include "rotid.h"

#define LINE 100 /* a card longer than this goes on in the next line */

void deck_put(struct deck_writer *w, const char *format, ...)
{
    va_list values, again;
    va_start(values, format);
    va_copy(again, values);
    int count = vsnprintf(NULL, 0, format, values);
    va_end(values);
    while (!w->status && count >= 0 && w->length + (size_t)count + 1 > w->room) {
        char *grown = pool_grow(w->pool, w->text, w->room, &w->room, 1);
        if (grown)
            w->text = grown;
        else
            w->status = ROTID_ERROR_MEMORY;
    }
    if (!w->status && count >= 0) {
        (void)vsnprintf(w->text + w->length, (size_t)count + 1, format, again);
        w->length += (size_t)count;
    }
    va_end(again);
}

/* 2.1e11 for 2.1e+11 */
static void shorten_exponent(char *text)
{
    char *e = strchr(text, 'e');
    if (!e)
        return;
    int exponent = atoi(e + 1);
    (void)sprintf(e + 1, "%d", exponent); /* never longer than it was */
}

const char *deck_number_text(double value, char text[DECK_NUMBER_LENGTH])
{
    char plain[DECK_NUMBER_LENGTH];
    int digits = -1;
    do
        (void)snprintf(text, DECK_NUMBER_LENGTH, "%.*e", ++digits, value);
    while (digits < 16 && strtod(text, NULL) != value);
    shorten_exponent(text);
    (void)snprintf(plain, sizeof plain, "%.*g", digits + 1 < 15 ? 15 : digits + 1, value);
    shorten_exponent(plain);
    return strlen(plain) > strlen(text) + 3 ? text : strcpy(text, plain);
}

void deck_put_number(struct deck_writer *w, const char *separator, double value)
{
    char text[DECK_NUMBER_LENGTH];
    if (!isfinite(value))
        w->status = w->status ? w->status : ROTID_ERROR_ARGUMENT;
    deck_put(w, "%s%s", separator, deck_number_text(value, text));
}

/* What the value of an option can be: no comma, no comment, no control character, nothing that trimming takes away. */
static int is_value(const char *text)
{
    size_t length = text ? strlen(text) : 0;
    if (!length || isspace((unsigned char)text[0]) || isspace((unsigned char)text[length - 1]) || strstr(text, "**"))
        return 0;
    for (size_t i = 0, bytes; i < length; i += bytes ? bytes : 1) {
        unsigned char c = (unsigned char)text[i];
        bytes = text_visible(text + i);
        if (c == ',' || (!bytes && c != '\t' && c < 0xa0)) /* names in Latin-1 stay as they are: they may be those of files */
            return 0;
        if (!bytes && text_utf8(text + i) > 1)
            return 0;
    }
    return 1;
}

void deck_put_card(struct deck_writer *w, const char *name)
{
    deck_put(w, "*%s", name);
}

void deck_put_option(struct deck_writer *w, const char *name, const char *value)
{
    size_t column = 0;
    if (!is_value(value)) {
        w->status = w->status ? w->status : ROTID_ERROR_ARGUMENT;
        return;
    }
    while (column < w->length && w->text[w->length - column - 1] != '\n')
        column++;
    deck_put(w, ",%s%s=%s", column + strlen(name) + strlen(value) + 3 > LINE ? "\n    " : " ", name, value);
}

void deck_put_option_number(struct deck_writer *w, const char *name, double value)
{
    char text[DECK_NUMBER_LENGTH];
    deck_put_option(w, name, deck_number_text(value, text));
}
