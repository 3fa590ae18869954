/* Text and elements of a page, escaped and closed. */
#ifndef ROTID_PAGE_HTML_H
#define ROTID_PAGE_HTML_H

#include <stdio.h>

#include "page/figure.h"

/* A text of any origin: & < > and quotes as references; bytes that are not UTF-8, and controls (of direction as
 * well, which would show another text than there is), as U+FFFD. */
void html_text(FILE *out, const char *text);

/* <NAME>text</NAME> and a line feed. */
void html_element(FILE *out, const char *name, const char *text);

/* The table in a box that scrolls by itself. id: of its caption; caption: what it holds. */
void html_table(FILE *out, const char *id, const char *caption, const struct number_table *table);

/* A figure with its pictures in both layouts, its caption, its numbers and its files; number from 1. Without pictures its numbers
 * stand open. */
void html_figure(FILE *out, int number, const struct figure *figure);

#endif
