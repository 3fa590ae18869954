/* Standard output and standard error. What is printed passes one filter here, whatever deck, file or argument it comes from:
 * control characters and bytes that are no UTF-8 become U+FFFD; line feeds and tabs stay. No other file of the program names the
 * two. */
#ifndef ROTID_REPORT_TERMINAL_H
#define ROTID_REPORT_TERMINAL_H

#include <stdio.h>

/* Before anything is printed and any file is opened: no file of the program takes the place of a standard stream that is closed.
 * ROTID_OK, ROTID_ERROR_MEMORY, or ROTID_ERROR_IO where that cannot be seen to. */
int terminal_open(void);

/* Where tables are written to: memory, until terminal_flush or a message sends it to standard output. */
FILE *terminal_out(void);

/* ROTID_OK, or ROTID_ERROR_IO with errno where something did not arrive, now or before. */
int terminal_flush(void);

/* Appends the text to standard output. Statuses of terminal_flush. */
int terminal_print(const char *text);

/* A line to standard error, its line feed included: line feeds within the values would be lines of somebody else. */
void terminal_say(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Marks on standard error: what is said until the next mark stands out where that is a terminal with colours, unless the
 * environment has a NO_COLOR that is not empty or TERM=dumb. */
enum terminal_mark { TERMINAL_PLAIN, TERMINAL_BOLD, TERMINAL_WARNING, TERMINAL_ERROR };
void terminal_mark(enum terminal_mark mark);

/* What stands in terminal_out to standard error instead. */
void terminal_to_error(void);

/* A line on standard error that the next one is written over, and its end. */
void terminal_progress(const char *format, ...) __attribute__((format(printf, 1, 2)));
void terminal_progress_end(void);

#endif
