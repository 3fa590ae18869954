/* Text and elements of a page, escaped and closed. */
#ifndef ROTID_REPORT_HTML_H
#define ROTID_REPORT_HTML_H

#include <stdio.h>

/* A text of any origin: & < > and quotes as references; bytes that are not UTF-8, and controls (of direction as
 * well, which would show another text than there is), as U+FFFD. */
void html_text(FILE *out, const char *text);

/* <NAME>text</NAME> and a line feed; name: with attributes. */
void html_element(FILE *out, const char *name, const char *text);

#endif
