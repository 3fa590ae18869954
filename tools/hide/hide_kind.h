/* Kinds of effects, and SPECs: id[:key=value,...]. One line of the table in hide_kind.c is one kind.
 *
 * Physical effects carry the ids of the catalogue of causes, effects on the data likewise. What lies outside the catalogue has
 * the id "outside" and its name as kind=. */
#ifndef HIDE_KIND_H
#define HIDE_KIND_H

#include "hide_rotor.h"

#define HIDE_MOST_KEYS 6
#define HIDE_SPEC      256

enum hide_class { HIDE_PHYSICAL, HIDE_DATA, HIDE_OUTSIDE };

enum hide_key_type {
    HIDE_NUMBER,      /* least <= value <= most */
    HIDE_PLACE,       /* a position inside the rotor */
    HIDE_GROUP,       /* any group */
    HIDE_KNOWN_GROUP, /* a group of which no modulus is identified */
    HIDE_INTERFACE,   /* GROUP.end or GROUP.start between two groups; index: of the left one, number: its place */
    HIDE_TIE,
    HIDE_SPRING,
    HIDE_DISK,
    HIDE_SENSOR, /* an id; index: of the sensor */
    HIDE_SENSOR_PAIR,
    HIDE_MODE, /* from 1; index: from 0 */
    HIDE_MODE_PAIR,
    HIDE_WORD /* one of `words`, index its place there */
};

struct hide_key {
    const char *name;
    enum hide_key_type type;
    int required;
    double preset, least, most;
    const char *words; /* "gaussian|box" */
};

struct hide_kind {
    const char *id, *outside;
    enum hide_class class;
    struct hide_key key[HIDE_MOST_KEYS];
};

struct hide_value {
    int given;
    double number;
    int index, second;
};

struct hide_effect {
    const struct hide_kind *kind;
    char spec[HIDE_SPEC]; /* as it was written */
    struct hide_value value[HIDE_MOST_KEYS];
};

int hide_kinds(void);
const struct hide_kind *hide_kind(int i);

/* modes: how many are measured. HIDE_INPUT with a message of what was expected. */
int hide_effect_read(const struct hide_rotor *rotor, int modes, const char *spec, struct hide_effect *effect,
                     const struct hide_message *message);

int hide_is(const struct hide_effect *effect, const char *id); /* also of the kinds outside, by their name */
/* Where a sensor (index) is with the effect sensor_line: shift + scale z from the left end, with flip from the right one. */
double hide_on_line(const struct hide_rotor *rotor, const struct hide_effect *effect, int sensor);
const struct hide_value *hide_get(const struct hide_effect *effect, const char *key);

/* Word number i of "gaussian|box" into word[room]. */
void hide_word(const char *words, int i, size_t room, char *word);

#endif
