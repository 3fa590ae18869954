/* Shared by what writes the cards: a text that grows, and the form that a reader of decks accepts. */
#ifndef ROTID_DECK_DECK_WRITER_H
#define ROTID_DECK_DECK_WRITER_H

#include "base/pool.h"
#include "deck/deck_write.h"

struct deck_writer {
    struct pool *pool;
    const struct job *job;
    struct rotor rotor; /* of the job, at x */
    const double *x;    /* [nparameter] or NULL */
    char *text;
    size_t length, room;
    int status; /* the first failure; nothing is written behind it */
};

void deck_put(struct deck_writer *w, const char *format, ...) __attribute__((format(printf, 2, 3)));

#define DECK_NUMBER_LENGTH 32

/* The fewest digits that give the value back to the last bit, written out unless that is much longer. Returns `text`. */
const char *deck_number_text(double value, char text[DECK_NUMBER_LENGTH]);

/* A number in such digits; the value of a data line with the separator in front of it. */
void deck_put_number(struct deck_writer *w, const char *separator, double value);

/* The beginning of a card, and an option of it; the line goes on in the next one where it becomes long. A text that a deck cannot
 * give back is an error. The caller ends the line. */
void deck_put_card(struct deck_writer *w, const char *name);
void deck_put_option(struct deck_writer *w, const char *name, const char *value);
void deck_put_option_number(struct deck_writer *w, const char *name, double value);

/* A writer of the job at x [nparameter], or as it stands where x is NULL, with a copy of what of the rotor can vary: groups,
 * rods, disks, springs, causes. Its status. */
int deck_writer_open(struct deck_writer *w, struct pool *pool, const struct job *job, const double *x);
/* The text, NULL where there is a failure or where it is beyond the limits of a reader. */
int deck_writer_end(struct deck_writer *w, char **text);

/* The cards, by file: the heading; of the model; of the measured data; of their faults, causes and suspects; of the
 * identification; of the transfer functions. */
void deck_write_heading(struct deck_writer *w, const struct deck_write_options *options);
void deck_write_model(struct deck_writer *w);
void deck_write_measured(struct deck_writer *w);
void deck_write_corrections(struct deck_writer *w);
void deck_write_causes(struct deck_writer *w);
void deck_write_fit(struct deck_writer *w, int with_holdout);
void deck_write_frf(struct deck_writer *w);

/* The line of unknown p in *IDENTIFY, under this name; the option HOLDOUT, where modes are held out. */
void deck_write_unknown(struct deck_writer *w, int p, const char *name);
void deck_write_holdout(struct deck_writer *w);

#endif
