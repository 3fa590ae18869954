/* Why a call failed, in words for its host. */
#ifndef ROTID_BASE_FAILURE_H
#define ROTID_BASE_FAILURE_H

#include <stddef.h>

#include "rotid.h"

/* Writes the text into failure [ROTID_FAILURE_LENGTH] (NULL is allowed), cut off where it is too long, with a point in its
 * numbers whatever the locale of the host. Returns status. */
int failure_say(char *failure, int status, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* An argument out of its range: the text names it as rotid.h does, its value, and what was expected. */
#define refuse(failure, ...) ((void)failure_say((failure), ROTID_ERROR_ARGUMENT, __VA_ARGS__), ROTID_ERROR_ARGUMENT)

/* Puts the text in front of what is there already; nothing where nothing is. Returns status. */
int failure_say_of(char *failure, int status, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* Puts as much of the text as fits behind the first `length` characters; returns the length then, that of a full buffer once
 * something was cut off. Characters of UTF-8 stay whole. */
size_t failure_append(char *failure, size_t length, const char *text);

#endif
