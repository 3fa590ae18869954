/* A deck as text: cards with their options and data lines, each piece with its place. */
#ifndef ROTID_DECK_DECK_TEXT_H
#define ROTID_DECK_DECK_TEXT_H

#include "base/message.h"
#include "base/pool.h"
#include "base/text.h"
#include "deck/deck_source.h"

#define DECK_LINE_LENGTH   1024
#define DECK_MOST_BYTES    (16l << 20) /* all files together: a rotor takes kilobytes */
#define DECK_MOST_INCLUDES 16          /* depth */
#define DECK_MOST_FILES    1000        /* included ones: few lines in each of them include thousands more */
#define DECK_MOST_CARDS    5000        /* names are compared with each other */
#define DECK_MOST_MODES    100         /* and the highest number: a spectrum costs the cube of the number of modes */

struct place {
    const char *file;
    int line, column;
};

struct field { /* of a data line, trimmed; empty between two commas */
    const char *text;
    struct place place; /* row and column where the line comes from a table */
    double in_si;       /* factor of a unit that the field has of its own; 0: that of the deck */
};

struct data_line {
    struct place place, end; /* end: just behind the last character */
    const char *text;        /* the whole line, comment removed */
    int count;
    struct field *field;
};

struct table_text;

struct card_option {
    const char *name, *value; /* value "" where there is no '=' */
    struct place place, value_place;
    int overridden; /* --set gave it */
};

struct card {
    const char *name; /* upper case, without the asterisk */
    struct place place;
    int noption, nline;
    size_t option_room, line_room;
    struct card_option *option;
    struct data_line *line;
};

struct deck_text {
    int ncard;
    size_t card_room;
    struct card *card;
    struct place end;
    int nfile; /* the deck, what it includes, and measured data that its cards name */
    size_t file_room;
    const char **file;
    int ntable;
    size_t table_room;
    struct table_text **table;      /* read so far: a table may serve several cards */
    const char *memory, *directory; /* of a deck from memory: the file of its places, what its files are relative to; or NULL */
};

/* "CARD.OPTION=VALUE" that replaces an option of a deck. */
struct override {
    const char *card, *option, *value;
    const char *text;  /* what stands for the file in messages: "--set CARD.OPTION=VALUE" */
    const char *given; /* the whole, NULL of one that nobody wrote so */
};

/* Reads a deck and what it includes. Errors go to the list with their place. ROTID_OK, ROTID_ERROR_SYNTAX, ROTID_ERROR_IO or
 * ROTID_ERROR_MEMORY. */
int deck_text_read(struct pool *pool, const char *path, struct message_list *messages, struct deck_text *text);

/* The same of a deck that is no file; its name is kept, not copied. */
int deck_text_read_memory(struct pool *pool, const struct deck_memory *memory, struct message_list *messages,
                          struct deck_text *text);

/* A path that an option names, as seen from where the program runs: relative ones are relative to the file that names them, those
 * of an override to where the program runs; in a deck from memory both are relative to its directory. NULL: no memory, or, with
 * an error in the list, a deck from memory that may name no files. */
const char *deck_text_path(struct pool *pool, const struct deck_text *text, const struct card *card,
                           const struct card_option *option, struct message_list *messages);

/* One more card, or option of a card. NULL, or not 0, where memory is out. */
struct card *deck_text_add_card(struct pool *pool, struct deck_text *text, const char *name, struct place place);
int deck_text_add_option(struct pool *pool, struct card *card, struct card_option option);

/* The path of a file that the deck is made of; kept, not copied. ROTID_OK or ROTID_ERROR_MEMORY. */
int deck_text_add_file(struct pool *pool, struct deck_text *text, const char *path);

/* Splits "CARD.OPTION=VALUE", parts of which are pointed to. ROTID_OK, ROTID_ERROR_SYNTAX where it has another form, or
 * ROTID_ERROR_MEMORY. */
int override_parse(struct pool *pool, const char *text, struct override *override);

/* Replaces or adds the option on every card of that name; a card of which there can only be one is added if it is missing. */
int deck_text_override(struct pool *pool, const struct override *override, struct message_list *messages, struct deck_text *text);

/* The option of that name, or NULL. */
const struct card_option *card_option(const struct card *card, const char *name);

#endif
