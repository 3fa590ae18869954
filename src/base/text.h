/* Letters and characters. */
#ifndef ROTID_BASE_TEXT_H
#define ROTID_BASE_TEXT_H

#include <stddef.h>

/* Names in decks are compared without regard to case. */
int same_text(const char *a, const char *b);

/* Bytes of the UTF-8 character that begins here, 0 where there is none (RFC 3629). The text ends with a zero byte. */
size_t text_utf8(const char *text);

/* Whether a control character begins here, one of those that make a terminal do something or show other text than there is: C0
 * (tab and line feed among them), DEL, C1, controls of direction (Unicode Standard Annex 9), line and paragraph separators.
 * *code: its number, where it is one. */
int text_is_control(const char *text, unsigned *code);

/* Bytes of the character that begins here, 0 where that is a control character or no UTF-8: nothing to be shown as it is. */
size_t text_visible(const char *text);

/* In the place of a character that is not shown: U+FFFD, one column. */
#define TEXT_REPLACEMENT "\xef\xbf\xbd"

#endif
