/* Names in decks are compared without regard to case. */
#ifndef ROTID_BASE_TEXT_H
#define ROTID_BASE_TEXT_H

int same_text(const char *a, const char *b);

#endif
