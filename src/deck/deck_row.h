/* The cards of a deck, a row for each of their options and values. From the rows follow what is read and what is said where it is
 * wrong (deck_fields.c), what is written, and the tables of docs/deck.md (make tables). What no row says, such as an outer
 * diameter above the inner one, is plain code in the reader of the card. */
#ifndef ROTID_DECK_DECK_ROW_H
#define ROTID_DECK_DECK_ROW_H

#include "deck/deck.h"

enum row_kind {
    ROW_OTHER,    /* read and written by the code of the card; what: its form, as docs/deck.md has it */
    ROW_NAME,     /* const char * */
    ROW_GROUP,    /* int: index of the group of that name */
    ROW_MATERIAL, /* struct material: of the *MATERIAL of that name; written with the name of the row before */
    ROW_WORD,     /* int: which of the words */
    ROW_NUMBER,   /* double */
    ROW_WHOLE,    /* int */
    ROW_POSITION  /* double */
};

enum row_bit {
    ROW_MAY_LACK = 1,
    ROW_NAN = 4,     /* what lacks is NaN: zero is a value */
    ROW_ABOVE_0 = 2, /* written where the member is above zero: else it was not stated; of values the last ones */
    ROW_MESH = 8     /* the mesh, which may follow from the data */
};

struct deck_row {
    const char *option; /* NULL: the next value of a data line */
    enum row_kind kind;
    size_t offset;            /* of its member; without it the member is left as it is */
    const char *what;         /* of a value, in messages: "outer diameter [m]"; of an option what is expected behind the = */
    enum range range;         /* ROW_NUMBER */
    double factor;            /* ROW_NUMBER: to SI, of what *UNITS states no unit of; 0: 1 */
    int least, most;          /* ROW_WHOLE */
    const char *const *words; /* ROW_WORD, or ROW_OTHER for docs/deck.md; the first is the one without the option, but for */
    int standard;             /* another one, from 0; ROW_WHOLE: where the value lacks */
    size_t as;                /* of a value that may lack, not 0: the member that it equals then */
    unsigned bits;            /* of enum row_bit */
};

/* For tables of rows. */
#define IN(S, M)      .offset = offsetof(S, M)
#define FROM_TO(A, B) .least = (A), .most = (B)
#define NAME(S)                                                                                                                  \
    {                                                                                                                            \
        .option = "NAME", .kind = ROW_NAME, IN(S, name), .what = "name"                                                          \
    }
#define MATERIAL(S)                                                                                                              \
    {                                                                                                                            \
        .option = "MATERIAL", .kind = ROW_MATERIAL, IN(S, material), .what = "name of a material"                                \
    }
#define POSITION(S, M)   .kind = ROW_POSITION, IN(S, M), .what = "position"
#define NUMBER(S, M, W)  .kind = ROW_NUMBER, IN(S, M), .what = (W)
#define ABOVE_0(S, M, W) NUMBER(S, M, W), .range = POSITIVE
#define FROM_0(S, M, W)  NUMBER(S, M, W), .range = NOT_NEGATIVE
#define WHOLE(S, M, W)   .kind = ROW_WHOLE, IN(S, M), .what = (W)
#define ELEMENTS(S)                                                                                                              \
    {                                                                                                                            \
        WHOLE(S, elements, "number of elements"), FROM_TO(1, DECK_MOST_ELEMENTS), .bits = (ROW_MAY_LACK | ROW_MESH)              \
    }
#define WORD(S, M, W) .kind = ROW_WORD, IN(S, M), .words = (W)
#define OTHER(O, ...)                                                                                                            \
    {                                                                                                                            \
        .option = (O), .kind = ROW_OTHER, __VA_ARGS__                                                                            \
    }
#define OPTION(O) OTHER(O, .what = "")
#define OPTIONAL  .bits = ROW_MAY_LACK
#define OR_NAN    .bits = (ROW_MAY_LACK | ROW_NAN)
#define LAST                                                                                                                     \
    {                                                                                                                            \
        .option = NULL, .what = NULL                                                                                             \
    }

enum card_section { CARD_MODEL, CARD_MEASURED, CARD_CAUSE, CARD_IDENTIFICATION, CARD_FRF, CARD_STATES, CARD_RUNNING };

/* Where a card stands in a deck with *STATE. */
enum card_states {
    CARD_ANYWHERE,  /* what a state has adds to what is common */
    CARD_REPLACES,  /* a state that has one has it in place of the common one */
    CARD_COMMON,    /* before the first *STATE */
    CARD_OF_STATE,  /* behind it */
    CARD_OF_MACHINE /* behind *RUNNING */
};

struct deck_card {
    const char *name;
    enum card_section section;  /* of docs/deck.md */
    int phase;                  /* cards are read by phases: what a later one refers to comes first, wherever it stands */
    deck_card_reader *read;     /* NULL: into a list of structs of the rotor, or of the machine */
    const char *lines;          /* what a data line holds, in messages too; NULL: there is none */
    const struct deck_row *row; /* ended by one without option and what */
    enum card_states states;
    size_t size, list, count; /* of a list: a struct, and where in struct rotor or struct machine pointer and number stand */
    deck_item_check *check;   /* of a list: what no row says */
    enum deck_places places;  /* of a list: which places it adds to */
    int single;               /* of a list: the card has one data line */
    int once;                 /* it may stand once */
    const char *instead;      /* of a card without data lines, what is expected in their place */
};

/* Values of *ELASTIC by its TYPE; *UNITS. */
extern const struct deck_row deck_elastic_rows[], deck_shear_rows[], deck_laminated_rows[], deck_units_rows[];

/* Of *MEASURED: where the nodes of the file lie on the rotor, z = origin + scale * coordinate, with flip the other way. */
struct measured_nodes {
    int axis, component, flip;
    double origin, scale;
};

/* x along the horizontal; x along the load of the bearing, which the weight makes. */
extern const char *const deck_axes[];

struct pedestal_line {
    double m[2], k[2], c[2]; /* kg, N/m, N.s/m in x and y */
};

struct mode_line { /* of *MODES */
    int number;
    double hz, damping, std;
};

struct point_line { /* of *SHAPE and *FREQUENCIES */
    int id;
    double value, std;
};

/* The cards there are, ended by one without a name; that of a name, NULL where there is none. Behind *RUNNING some names of cards
 * of the rotor at rest mean the same of the machine. */
extern const struct deck_card deck_card_table[];
const struct deck_card *deck_card_find(const char *name);
const struct deck_card *deck_card_of_machine(const char *name);
const struct deck_row *deck_rows(const char *card);

/* Whether there is such a card and it stands there. */
int deck_stands(const struct card *card, enum card_states where);

int deck_row_is_last(const struct deck_row *row);

/* Takes the options of a card, or the values of a data line, that are rows of the reader other than ROW_OTHER into the struct
 * `to`. 0, or 1 after an error. */
int deck_read_options(struct deck_reader *reader, const struct card *card, void *to);
int deck_read_values(struct deck_reader *reader, const struct data_line *line, void *to);
/* Errors at options that have no row. */
void deck_check_options(struct deck_reader *reader, const struct card *card, const struct deck_row *row);

/* A card by what its row of the table says: by its code, or a struct for each data line, one where it has a name. */
void deck_read_card(struct deck_reader *reader, const struct card *card, const struct deck_card *kind);

/* The values of a struct as a data line, in the units of the deck; the card and line of a struct of a list. */
void deck_put_values(struct deck_writer *w, const struct deck_row *row, const void *from);
void deck_put_list_item(struct deck_writer *w, const char *card, const void *from);

/* Whether two numbers are the same but for rounding: of sums and ratios of lengths, of a quotient by a unit. */
#define DECK_ROUNDING      1e-11
#define MORE_THAN_ROUNDING 1.02 /* of inertias stated with two or three digits */
int deck_is_near(double a, double b);

/* Whether a value lies from lower to upper; one beyond them by rounding becomes the bound. */
int deck_clip(double lower, double upper, double *value);

#endif
