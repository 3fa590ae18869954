/* Frequencies at single sensors, from a card or a universal file. */
#ifndef ROTID_DECK_DECK_FREQUENCIES_H
#define ROTID_DECK_DECK_FREQUENCIES_H

#include "deck/deck_cards.h"

/* What a reading may differ from its mode, relative: no accelerometer loads a rotor more, and another mode is not far. */
#define POINT_FREQUENCY_RANGE 0.05

/* Room for them in the job, once its sensors and modes are known. 0, or 1 where memory is out. */
int deck_new_points(struct deck_reader *reader);

/* Whether hz cannot be a reading of measured mode `mode`. */
int deck_point_is_far(const struct job *job, int mode, double hz);

/* The frequencies of modes that have readings at single sensors, and the noise of all: what a mode, a component or a reading has
 * of its own, with the floors of *NOISE in quadrature; *NOISE itself where there is none. */
void deck_settle_noise(struct deck_reader *reader);

#endif
