/* What the tables of options and cards give for the completions of the shells, docs/rotid.1, docs/deck.md and docs/reference.md.
 */
#ifndef ROTID_TOOLS_TABLES_GENERATED_H
#define ROTID_TOOLS_TABLES_GENERATED_H

#include <stdio.h>

struct generated {
    const char *path, *begin, *end; /* below the source; lines between which a part of the file is generated */
    void (*write)(FILE *out, int section);
    int section; /* of enum card_section */
};

/* Ended by one without a path. */
extern const struct generated generated_parts[];

/* The text of a file with what stands between the marks of a part anew: to free; NULL where a mark is missing or there is no
 * memory. */
char *generated_text(const struct generated *part, const char *text);

/* What stands between the marks. section: of enum card_section, for the cards alone. */
void write_bash(FILE *out, int section);
void write_zsh(FILE *out, int section);
void write_fish(FILE *out, int section);
void write_manual(FILE *out, int section);
void write_cards(FILE *out, int section);
void write_commands(FILE *out, int section);
void write_card_list(FILE *out, int section);
void write_causes(FILE *out, int section);

struct option_row;
void put_words(FILE *out, const struct option_row *row, const char *between);

#endif
