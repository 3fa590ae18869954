/* SPECs: from text to an effect on this rotor. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hide_kind.h"

struct spec {
    const struct hide_rotor *rotor;
    int modes;
    const char *text; /* the whole SPEC */
    const struct hide_message *message;
};

static int expected(const struct spec *spec, const char *key, const char *what)
{
    return hide_fail(spec->message, HIDE_INPUT, "--effect %s: %s: expected %s", spec->text, key, what);
}

static int sensor(const struct spec *spec, const char *text)
{
    double id;
    return hide_read_number(text, &id) && id >= 1 && id <= 1e9 ? hide_find_sensor(spec->rotor, (long)id) : -1;
}

static int mode(const struct spec *spec, const char *text)
{
    double number;
    return hide_read_number(text, &number) && number >= 1 && number <= spec->modes && number == floor(number) ? (int)number - 1
                                                                                                              : -1;
}

/* A and B of "A+B" by the routine; nonzero if both are there and differ */
static int pair(const struct spec *spec, const char *text, int (*find)(const struct spec *, const char *),
                struct hide_value *value)
{
    char first[HIDE_SPEC];
    const char *plus = strchr(text, '+');
    if (!plus)
        return 0;
    snprintf(first, sizeof first, "%.*s", (int)(plus - text), text);
    value->index = find(spec, first);
    value->second = find(spec, plus + 1);
    return value->index >= 0 && value->second >= 0 && value->index != value->second;
}

/* The group that ends at the place between two groups. */
static int interface(const struct hide_rotor *rotor, const char *text, double *z)
{
    if (!hide_position(rotor, text, z))
        return -1;
    for (int g = 0; g + 1 < rotor->shafts; g++)
        if (fabs(rotor->group[g].to - *z) <= 1e-6 * rotor->length) {
            *z = rotor->group[g].to;
            return g;
        }
    return -1;
}

static int words_index(const char *words, const char *text)
{
    char word[HIDE_NAME];
    for (int i = 0;; i++) {
        hide_word(words, i, sizeof word, word);
        if (!*word)
            return -1;
        if (hide_same(word, text))
            return i;
    }
}

static int read_number(const struct spec *spec, const struct hide_key *key, const char *text, struct hide_value *value)
{
    char what[100];
    if (hide_read_number(text, &value->number) && value->number >= key->least && value->number <= key->most)
        return HIDE_OK;
    if (key->most < 1e29)
        snprintf(what, sizeof what, "a number from %g to %g", key->least, key->most);
    else if (key->least > -1e29)
        snprintf(what, sizeof what, "a number not below %g", key->least);
    else
        snprintf(what, sizeof what, "a number");
    return expected(spec, key->name, what);
}

static int read_value(const struct spec *spec, const struct hide_key *key, const char *text, struct hide_value *value)
{
    const struct hide_rotor *rotor = spec->rotor;
    char what[100];
    switch (key->type) {
    case HIDE_NUMBER:
        return read_number(spec, key, text, value);
    case HIDE_PLACE:
        snprintf(what, sizeof what, "a position inside the rotor, 0 to %.6g m", rotor->length);
        return hide_position(rotor, text, &value->number) ? HIDE_OK : expected(spec, key->name, what);
    case HIDE_GROUP:
    case HIDE_KNOWN_GROUP:
        value->index = hide_find_group(rotor, text);
        if (value->index >= 0 && key->type == HIDE_KNOWN_GROUP && rotor->group[value->index].free_modulus)
            return expected(spec, key->name, "a group of which no modulus is identified");
        return value->index >= 0 ? HIDE_OK : expected(spec, key->name, "the name of a group");
    case HIDE_INTERFACE:
        value->index = interface(rotor, text, &value->number);
        return value->index >= 0 ? HIDE_OK : expected(spec, key->name, "GROUP.end or GROUP.start between two groups");
    case HIDE_TIE:
        value->index = hide_find_tie(rotor, text);
        return value->index >= 0 ? HIDE_OK : expected(spec, key->name, "the name of tie rods");
    case HIDE_SPRING:
        value->index = hide_find_spring(rotor, text);
        return value->index >= 0 ? HIDE_OK : expected(spec, key->name, "the name of a spring, or its number from 1");
    case HIDE_DISK:
        value->index = hide_find_disk(rotor, text);
        return value->index >= 0 ? HIDE_OK : expected(spec, key->name, "the name of a disk, or its number from 1");
    case HIDE_SENSOR:
        value->index = sensor(spec, text);
        return value->index >= 0 ? HIDE_OK : expected(spec, key->name, "the id of a sensor");
    case HIDE_SENSOR_PAIR:
        return pair(spec, text, sensor, value) ? HIDE_OK : expected(spec, key->name, "the ids of two sensors, such as 12+13");
    case HIDE_MODE:
        value->index = mode(spec, text);
        return value->index >= 0 ? HIDE_OK : expected(spec, key->name, "the number of a measured mode");
    case HIDE_MODE_PAIR:
        return pair(spec, text, mode, value) ? HIDE_OK : expected(spec, key->name, "two measured modes, such as 2+3");
    case HIDE_WORD:
        value->index = words_index(key->words, text);
        return value->index >= 0 ? HIDE_OK : expected(spec, key->name, key->words);
    }
    return HIDE_INPUT;
}

/* kind= of an effect outside the catalogue, taken out of the fields */
static const char *take_outside(int count, char **field)
{
    for (int i = 0; i < count; i++)
        if (!strncmp(field[i], "kind=", 5)) {
            const char *name = field[i] + 5;
            field[i] = NULL;
            return name;
        }
    return "";
}

static const struct hide_kind *find_kind(const char *id, const char *outside)
{
    for (int i = 0; i < hide_kinds(); i++)
        if (hide_same(hide_kind(i)->id, id) && (!hide_kind(i)->outside || hide_same(hide_kind(i)->outside, outside)))
            return hide_kind(i);
    return NULL;
}

/* What the table cannot say of one key alone. */
static int check_together(const struct spec *spec, const struct hide_effect *effect)
{
    const struct hide_value *at = hide_get(effect, "at"), *on = hide_get(effect, "sensor");
    if (hide_is(effect, "tie_shear") && !spec->rotor->tie[at->index].tube)
        return expected(spec, "at", "tie rods with MODEL=TUBE in the deck");
    if (hide_is(effect, "density") && spec->rotor->group[hide_get(effect, "group")->index].free_density)
        return expected(spec, "group", "a group whose density is not identified");
    if (hide_is(effect, "step_stiffness") && spec->rotor->groups > spec->rotor->shafts)
        return expected(spec, "step_stiffness", "a deck without *LAYER: this program has no cones through rings");
    if (hide_is(effect, "accelerometer_mass") && (hide_get(effect, "mount")->index == 0) != on->given)
        return expected(spec, "sensor", "the id of a sensor with mount=fixed, none with mount=moving");
    if (hide_is(effect, "support_position")) {
        double z = spec->rotor->spring[at->index].z + hide_get(effect, "shift")->number;
        if (!(z >= 0 && z <= spec->rotor->length))
            return expected(spec, "shift", "one that leaves the spring on the rotor");
    }
    if (hide_is(effect, "added_inertia") && spec->rotor->disk[at->index].inertia + hide_get(effect, "inertia")->number < 0)
        return expected(spec, "inertia", "one that leaves the disk some");
    if (hide_is(effect, "sensor_position")) {
        double z = spec->rotor->sensor[on->index].z + hide_get(effect, "shift")->number;
        if (!(z >= 0 && z <= spec->rotor->length))
            return expected(spec, "shift", "one that leaves the sensor on the rotor");
    }
    for (int s = 0; s < spec->rotor->sensors && hide_is(effect, "sensor_line"); s++) {
        double z = hide_on_line(spec->rotor, effect, s);
        if (!(z >= 0 && z <= spec->rotor->length))
            return expected(spec, "shift", "one that with scale= leaves all sensors on the rotor");
    }
    if (hide_is(effect, "duplicate_channel") && on->index == hide_get(effect, "of")->index)
        return expected(spec, "of", "another sensor");
    if (hide_is(effect, "mode_pairing") &&
        hide_get(effect, "swap")->given + hide_get(effect, "double")->given + hide_get(effect, "missing")->given != 1)
        return expected(spec, "mode_pairing", "one of swap=, double=, missing=");
    return HIDE_OK;
}

int hide_effect_read(const struct hide_rotor *rotor, int modes, const char *text, struct hide_effect *effect,
                     const struct hide_message *message)
{
    struct spec spec = {rotor, modes, text, message};
    char copy[HIDE_SPEC], *field[HIDE_MOST_KEYS + 1];
    *effect = (struct hide_effect){.kind = NULL};
    if (strlen(text) >= sizeof copy)
        return hide_fail(message, HIDE_INPUT, "--effect: expected a SPEC of less than %d characters", HIDE_SPEC);
    memcpy(copy, text, strlen(text) + 1);
    memcpy(effect->spec, text, strlen(text) + 1);
    char *colon = strchr(copy, ':');
    if (colon)
        *colon = 0;
    int count = colon ? hide_fields(colon + 1, HIDE_MOST_KEYS + 1, field) : 0;
    if (count < 0)
        return expected(&spec, "keys", "fewer");
    char *id = hide_trim(copy);
    effect->kind = find_kind(id, hide_same(id, "outside") ? take_outside(count, field) : "");
    if (!effect->kind)
        return expected(&spec, "id", "one of --list");
    const struct hide_key *key = effect->kind->key;
    for (int i = 0; i < count; i++) {
        char *equals = field[i] ? strchr(field[i], '=') : NULL;
        int k = 0, status;
        if (!field[i])
            continue;
        if (!equals)
            return expected(&spec, field[i], "key=value");
        *equals = 0;
        char *name = hide_trim(field[i]);
        while (k < HIDE_MOST_KEYS && key[k].name && !hide_same(key[k].name, name))
            k++;
        if (k == HIDE_MOST_KEYS || !key[k].name || effect->value[k].given)
            return expected(&spec, name, "a key that --list names for it, once");
        if ((status = read_value(&spec, &key[k], hide_trim(equals + 1), &effect->value[k])))
            return status;
        effect->value[k].given = 1;
    }
    for (int k = 0; k < HIDE_MOST_KEYS && key[k].name; k++) {
        if (!effect->value[k].given && key[k].required)
            return expected(&spec, key[k].name, "it to be given");
        if (!effect->value[k].given)
            effect->value[k].number = key[k].preset;
    }
    return check_together(&spec, effect);
}
