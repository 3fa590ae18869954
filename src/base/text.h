/* Letters and characters. */
#ifndef ROTID_BASE_TEXT_H
#define ROTID_BASE_TEXT_H

#include <stddef.h>

/* Names in decks are compared without regard to case. */
int same_text(const char *a, const char *b);

/* Edits that make one text of the other without regard to case: a letter more, less, changed, or two neighbours exchanged; more
 * than a third of the letters, and 3 at most, count as TEXT_FAR, as do texts beyond 31 letters. */
#define TEXT_FAR 99
int text_distance(const char *a, const char *b);

/* Edits that make one word of the other without regard to case: a letter more, less, changed, or two neighbours exchanged.
 * TEXT_FAR where they are more than a third of its letters or more than 3, and of words beyond 31 letters. */
#define TEXT_FAR 99
int text_distance(const char *word, const char *other);

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
