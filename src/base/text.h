/* Letters and characters. */
#ifndef ROTID_BASE_TEXT_H
#define ROTID_BASE_TEXT_H

#include <stddef.h>

/* Names in decks are compared without regard to case. */
int same_text(const char *a, const char *b);

/* Bytes of the UTF-8 character that begins here, 0 where there is none (RFC 3629). The text ends with a zero byte. */
size_t text_utf8(const char *text);

#endif
