/* Texts: messages, words, numbers, and a text that grows. */
#ifndef HIDE_TEXT_H
#define HIDE_TEXT_H

#include <stddef.h>

#ifdef __GNUC__
#define HIDE_PRINTF(text, first) __attribute__((format(printf, text, first)))
#else
#define HIDE_PRINTF(text, first)
#endif

struct hide_message {
    char *text;
    size_t room;
};

/* Writes the message and returns the status it is given. */
int hide_fail(const struct hide_message *message, int status, const char *format, ...) HIDE_PRINTF(3, 4);

struct hide_text {
    char *data;
    size_t length, room;
    int failed; /* no memory: what follows is not added */
};

void hide_add(struct hide_text *text, const char *format, ...) HIDE_PRINTF(2, 3);
void hide_add_bytes(struct hide_text *text, const char *bytes, size_t count);

/* The whole file, to be freed. NULL where it cannot be read: the program says so on standard error, with `hint` behind the
 * reason. */
char *hide_read_file(const char *program, const char *path, const char *hint);

int hide_same(const char *a, const char *b); /* without regard to case */

/* Nonzero if the whole text is one finite number. */
int hide_read_number(const char *text, double *value);

/* Takes the blanks off both ends, in place. */
char *hide_trim(char *text);

/* Cuts the line at commas, in place; an empty piece after the last comma does not count. -1: more than `most`. */
int hide_fields(char *line, int most, char **field);

#endif
