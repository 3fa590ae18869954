/* Shared by the readers of the cards: what has been read so far, and the reading of single fields. */
#ifndef ROTID_DECK_DECK_CARDS_H
#define ROTID_DECK_DECK_CARDS_H

#include "deck/deck_text.h"
#include "run/job.h"

#define DECK_MOST_KINDS 64 /* of cards */
#define DECK_QUANTITIES 8  /* whose units *UNITS can state */

struct deck_reader {
    struct pool *pool;
    struct message_list *messages;
    struct deck_text text;
    struct job *job;
    int nmaterial;
    size_t material_room, group_room, segment_room, ring_room, tierod_room, bars_room, sensor_room, parameter_room;
    size_t list_room[DECK_MOST_KINDS]; /* of cards without code of their own, by their rows in deck_card_table */
    struct material *material;
    long taken;               /* rows of tables, by all cards */
    int nopen, *open_section; /* sections without elements: the mesh follows from modes and noise */
    size_t open_room;
    int *material_complete; /* bit 1: elastic constants, bit 2: density */
    struct place *material_place, *group_place, *tierod_place, *bars_place, *sensor_place;
    size_t material_complete_room, material_place_room, group_place_room, tierod_place_room, bars_place_room, sensor_place_room,
        bounds_room, effect_room, suspect_room, correction_room, correction_place_room, pair_room;
    struct place *correction_place; /* of the CAUSE cards of the measurement chain */
    const char *layout;             /* what a data line of the card at hand holds */
    double length;                  /* of the rotor, once all groups are read */
    double noise_frequency, noise_shape, floor_frequency, floor_shape;
    const struct card *measured_card, *modes_card, *frequencies_card, *fit_card, *identify_card, *noise_card, *frf_card;
    const char *tie;           /* FIT, TIE=E:G */
    int *mean_kept;            /* [nmode] FREQUENCIES, MEAN=NO */
    const char *state;         /* that the cards are of, NULL in a deck without *STATE */
    int ncommon;               /* the first cards of the text are common to all states; the others are of this one */
    int ncommon_unknown;       /* the first unknowns come from those */
    int alone;                 /* no other state is read beside it */
    int held_out;              /* HOLDOUT=STATE: all its modes are */
    int no_section;            /* the one error is that of a section that cannot be */
    int unit[DECK_QUANTITIES]; /* of *UNITS: which word, 0: SI */
    unsigned doubted;          /* kinds of numbers that a warning was given for */
    int out_of_memory;
};

void deck_error(struct deck_reader *reader, struct place place, const char *format, ...) __attribute__((format(printf, 3, 4)));
void deck_note(struct deck_reader *reader, struct place place, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* Appends a zeroed element to a growing array and returns its address, or NULL with out_of_memory set. */
void *deck_append(struct deck_reader *reader, void **array, int count, size_t *room, size_t size);
#define DECK_APPEND(reader, array, count, room) deck_append((reader), (void **)&(array), (count), &(room), sizeof *(array))

enum range { ANY, NOT_NEGATIVE, POSITIVE };

/* Sizes of numbers in SI units that leave room for what is computed of them: fourth powers of lengths, squares of stiffnesses,
 * reciprocals of variances. Beyond, results would be zero, infinite or no numbers, without a place to blame. */
#define DECK_LEAST 1e-30
#define DECK_MOST  1e30
/* Zero, or within these. */
int deck_is_usual(double value);

/* The factor that makes numbers in the unit `word` SI, of what has the unit `si` inside ("m", "1" for a share); 0 where that has
 * no such unit. */
double deck_unit_factor(const char *si, const char *word);
/* The factor that makes a number of the deck SI; what: "length [m]", or a unit alone. 1 for what has no unit. */
double deck_in_si(const struct deck_reader *reader, const char *what);
/* The deck's own unit of it, for messages. */
const char *deck_unit_name(const struct deck_reader *reader, const char *what);
/* Warns of a number, which the deck states by `text` and which is `value` in SI units, that rotors do not have. */
void deck_doubt(struct deck_reader *reader, struct place place, const char *what, const char *text, double value);
/* Warns of an absurd mass or length of the whole. */
void deck_doubt_rotor(struct deck_reader *reader);

/* Number i of a data line within the range; `what` names it in the error, and its unit ("outer diameter [m]"): the value
 * is SI whatever *UNITS says. 0, or 1 after an error. */
int deck_number(struct deck_reader *reader, const struct data_line *line, int i, const char *what, enum range range,
                double *value);
int deck_integer(struct deck_reader *reader, const struct data_line *line, int i, const char *what, int least, int most,
                 int *value);
/* Field i is there and not empty. */
int deck_has(const struct data_line *line, int i);
/* No more than `most` fields; otherwise an error that says what a line of this card holds. */
int deck_count(struct deck_reader *reader, const struct data_line *line, int most, const char *layout);
/* A number in metres, start, end, group.start or group.end, inside the rotor. */
int deck_position(struct deck_reader *reader, const struct field *field, const char *what, double *z);
/* The same of an option. */
int deck_option_position(struct deck_reader *reader, const struct card_option *option, const char *what, double *z);

/* The value of an option that must be there, or NULL after an error. */
const char *deck_option(struct deck_reader *reader, const struct card *card, const char *name, const char *expected);
/* unit: "" or as for deck_in_si. */
int deck_option_number(struct deck_reader *reader, const struct card_option *option, const char *unit, enum range range,
                       double *value);
int deck_option_integer(struct deck_reader *reader, const struct card_option *option, int least, int most, int *value);
extern const char *const deck_answers[]; /* NO, YES */

/* Index of the option's value in a list of words that ends with NULL; -1 after an error. */
int deck_option_word(struct deck_reader *reader, const struct card_option *option, const char *const *words);
/* From `least` to `most` data lines; otherwise an error that says what is expected. Returns how many to read, never more than
 * `most`. */
int deck_lines(struct deck_reader *reader, const struct card *card, int least, int most, const char *layout);

/* deck_text_path of an option of this deck. NULL after an error or where memory is out. */
const char *deck_path(struct deck_reader *reader, const struct card *card, const struct card_option *option);

/* Index of a material, -1 where there is none of that name. */
int deck_find_material(const struct deck_reader *reader, const char *name);

/* A new group of NAME and MATERIAL of the card, on the axis: its index, or -1 after an error. */
int deck_add_group(struct deck_reader *reader, const struct card *card);

#define FRF_MOST_LINES     1000000
#define DECK_MOST_ELEMENTS ROTOR_MOST_ELEMENTS /* of a segment, of a bundle of rods, of the rotor with its bundles */
#define DECK_MOST_STATES   100                 /* each is read with all common cards */
#define DECK_MOST_LINES    10000               /* of a card, and sensors of the rotor: they are compared with each other */

/* The readers of the cards, by file. */
void deck_units(struct deck_reader *reader, const struct card *card);
void deck_material(struct deck_reader *reader, const struct card *card);
void deck_elastic(struct deck_reader *reader, const struct card *card);
void deck_density(struct deck_reader *reader, const struct card *card);
void deck_shaft(struct deck_reader *reader, const struct card *card);
void deck_beam(struct deck_reader *reader, const struct card *card);
void deck_layer(struct deck_reader *reader, const struct card *card);
void deck_perforation(struct deck_reader *reader, const struct card *card);
void deck_tierod(struct deck_reader *reader, const struct card *card);
void deck_bars(struct deck_reader *reader, const struct card *card);
void deck_preload(struct deck_reader *reader, const struct card *card);
void deck_sling(struct deck_reader *reader, const struct card *card);
/* A hub around the shaft under it, of a struct disk. 0, or 1 after an error. */
int deck_check_disk(struct deck_reader *reader, const struct data_line *line, const void *disk);
void deck_heading(struct deck_reader *reader, const struct card *card);
void deck_sensors(struct deck_reader *reader, const struct card *card);
void deck_modes(struct deck_reader *reader, const struct card *card);
void deck_shape(struct deck_reader *reader, const struct card *card);
void deck_frequencies(struct deck_reader *reader, const struct card *card);
void deck_noise(struct deck_reader *reader, const struct card *card);
void deck_cause(struct deck_reader *reader, const struct card *card);

/* The causes that MODEL=SOLID leaves without a meaning: an error each. */
void deck_causes_of_solid(struct deck_reader *reader);

/* The cards of the text into the job, with everything that is checked of them. */
void deck_read_cards(struct deck_reader *reader);

/* parameter_find of a field, also of "left.E=right.E". 3: an error of it has been reported. */
int deck_find_parameter(struct deck_reader *reader, const struct field *field, struct parameter *parameter, const char **unit);

/* Takes an unknown out of the job. */
void deck_drop_unknown(struct deck_reader *reader, int p);
/* MODES and HOLDOUT of a card. */
void deck_choose_modes(struct deck_reader *reader, const struct card *card);
/* The names of HOLDOUT=STATE:a,STATE:b one after the other: that at *rest, which goes on behind it; NULL behind the last one and
 * where the value is a list of modes. */
const char *deck_whole_state(struct deck_reader *reader, const char **rest);

/* What the tables of FILE hold becomes data lines of their cards, of new cards where a table holds that of several. *nread, the
 * number of cards in front, counts these. 0, or 1 after an error that leaves nothing to read. */
int deck_read_tables(struct deck_reader *reader, int *nread);

void deck_identify(struct deck_reader *reader, const struct card *card);
void deck_fit(struct deck_reader *reader, const struct card *card);
/* The universal file of MEASURED: sensors, modes and shapes. */
void deck_measured(struct deck_reader *reader, const struct card *card);
void deck_frf(struct deck_reader *reader, const struct card *card);

/* Whether an option is no option but the second group of BETWEEN=left,core. */
int deck_cause_list_item(const struct card *card, const struct card_option *option);
/* Takes the faults that CAUSE cards state out of the data, in the order of the cards; the noise is known by then. */
void deck_apply_corrections(struct deck_reader *reader);
/* Whether "cause.parameter", which is no parameter of the model, has that name from a CAUSE card: of a suspect or a fault of the
 * data, which this reports, or of a card that was refused, which has been reported. */
int deck_cause_explains(struct deck_reader *reader, const char *parameter, struct place place);

#endif
