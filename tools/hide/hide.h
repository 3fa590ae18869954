/* Hidden effects: the data that a test engineer would have of a rotor with something in it that the deck does not say, and the
 * truth beside it. Frequencies and shapes come from exact dynamic stiffness (tools/oracle); nothing of it is shared with
 * librotid.
 *
 * A case is: the rotor of a deck, true values of its identified parameters, effects (a SPEC each, hide_kind.h), and noise.
 * All is in memory, without state: cases may be made in several threads at once. SI units. */
#ifndef HIDE_H
#define HIDE_H

#include <stddef.h>
#include <stdint.h>

enum {
    HIDE_OK = 0,
    HIDE_INPUT = 2,  /* the deck, a SPEC or an option does not fit; the message says what was expected */
    HIDE_FAILURE = 3 /* no memory, or the oracle gave up */
};

#define HIDE_MOST_MODES   20
#define HIDE_MOST_SENSORS 1000
#define HIDE_MOST_EFFECTS 16

struct hide_request {
    const char *deck; /* its text */
    const char *name; /* of the deck, for messages and the truth; never written into the deck */
    uint64_t seed;
    int modes;                           /* elastic modes from 1, at most HIDE_MOST_MODES */
    int sensors;                         /* > 1: as many, evenly spaced from end to end; 0: those of the deck */
    int half_sensors;                    /* every second one of them */
    int no_shapes;                       /* frequencies alone */
    double frequency_noise, shape_noise; /* standard deviations, relative to the frequency, to the largest component */
    double stated_frequency_noise, stated_shape_noise; /* of the NOISE card; NaN: the true ones */
    double correlation;                                /* of the shape noise between neighbours, above -1 and below 1 */
    int truths;                                        /* "core.E=1.1e11": true values; the others are drawn */
    const char *const *truth;
    int effects; /* SPECs */
    const char *const *effect;
    int effects_in; /* "NAME=SPEC": in that state of a deck with several alone, at most HIDE_MOST_EFFECTS */
    const char *const *effect_in;
    const char *random; /* kind of effect to draw beside these, or NULL: hide_draw.h */
    int refine;         /* cuts of varying stiffness start this many times finer than usual; 1 */
    int state;          /* which state of a deck, from 0: each has noise of its own */
};

/* The defaults of the command line. */
struct hide_request hide_request_default(void);

/* Texts to be freed by the caller: the deck with the measured data, the truth as JSON. Whatever fails leaves both NULL and a line
 * in message[room].
 *
 * A deck with *STATE is one rotor in several states: parameters and effects are those of all, what the cards of a state add, its
 * *SET of lengths and its noise are its own. Its data stand behind its cards; the truth is {"states": [{"name", "truth"}]}. */
int hide_case(const struct hide_request *request, char **deck, char **truth, char *message, size_t room);

/* What --list prints; to be freed. NULL without memory. */
char *hide_list(void);

#endif
