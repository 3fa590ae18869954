/* Cells of tables and running text of a given width. A text may be UTF-8: columns are counted, not bytes. */
#ifndef ROTID_REPORT_LAYOUT_H
#define ROTID_REPORT_LAYOUT_H

#include <stddef.h>
#include <stdio.h>

/* A number in the width given, or a dash where there is none; one that is too large for it with an exponent. Width 0:
 * as wide as it is. */
void number_cell(FILE *out, int width, int decimals, double value);
void signed_cell(FILE *out, int width, int decimals, double value);
/* The same with a number of significant digits, and with decimals before a power of ten. */
void digits_cell(FILE *out, int width, int digits, double value);
void power_cell(FILE *out, int width, int decimals, double value);
/* A number within a sentence, or a dash. Returns text. */
const char *layout_number(char text[64], int digits, double value);
#define IN_DIGITS(digits, value) layout_number((char[64]){""}, (digits), (value))
/* What stands behind a value: its unit, and the blank before it; both empty of a pure number. */
const char *layout_unit(const char *unit);
const char *layout_gap(const char *unit);
/* A probability: three decimals, "<0.001" below. */
void chance_cell(FILE *out, int width, double value);
/* A text to the left; what does not fit ends in '~'. Control characters, line feeds among them, become U+FFFD. */
void text_cell(FILE *out, int width, const char *text);
/* The same of any length, with at least `width` columns. */
void name_cell(FILE *out, int width, const char *text);

int text_columns(const char *text);
/* The character that begins here, or U+FFFD. */
void text_character(FILE *out, const char *text);

/* Running text: lines of `width` columns, all but the first indented. */
struct wrap {
    FILE *out;
    int indent, width, column, fresh;
};

/* Begins with `head`. */
void wrap_open(struct wrap *wrap, FILE *out, int indent, int width, const char *head);
/* Text that is broken between words. */
void wrap_words(struct wrap *wrap, const char *text);
/* Text that stays on one line where it fits on one; 255 bytes of it. */
void wrap_item(struct wrap *wrap, const char *format, ...) __attribute__((format(printf, 2, 3)));
void wrap_close(struct wrap *wrap);

/* All of that for one text. */
void wrap_text(FILE *out, int indent, int width, const char *head, const char *text);

#endif
