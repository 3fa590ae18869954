#include "hide_kind.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define ANY 1e30
#define NUMBER(name, least, most)                                                                                                \
    {                                                                                                                            \
        name, HIDE_NUMBER, 1, 0, least, most, NULL                                                                               \
    }
#define OPTION(name, preset, least, most)                                                                                        \
    {                                                                                                                            \
        name, HIDE_NUMBER, 0, preset, least, most, NULL                                                                          \
    }
#define TARGET(name, type)                                                                                                       \
    {                                                                                                                            \
        name, type, 1, 0, 0, 0, NULL                                                                                             \
    }
#define CHOICE(name, required, words)                                                                                            \
    {                                                                                                                            \
        name, HIDE_WORD, required, 0, 0, 0, words                                                                                \
    }

/* Sizes may be neutral. Limits keep stiffness and mass above zero: 1 + slope xi, and 1 + profile (xi^2 - 1/3) at xi = 0 and 1. */
static const struct hide_kind table[] = {
    {"step_stiffness", NULL, HIDE_PHYSICAL, {NUMBER("angle", 1, 90)}},
    {"stiffness_gradient", NULL, HIDE_PHYSICAL, {TARGET("group", HIDE_GROUP), NUMBER("slope", -0.95, 0.95)}},
    {"stiffness_profile", NULL, HIDE_PHYSICAL, {TARGET("group", HIDE_GROUP), NUMBER("profile", -1.4, 2.8)}},
    {"stiffness_local",
     NULL,
     HIDE_PHYSICAL,
     {NUMBER("depth", 0, 0.95), TARGET("z", HIDE_PLACE), NUMBER("width", 1e-4, ANY), CHOICE("shape", 0, "gaussian|box")}},
    {"joint", NULL, HIDE_PHYSICAL, {TARGET("at", HIDE_INTERFACE), NUMBER("flexibility", 0, ANY)}},
    {"support", NULL, HIDE_PHYSICAL, {TARGET("at", HIDE_SPRING), NUMBER("factor", 0, ANY)}},
    {"support_position", NULL, HIDE_PHYSICAL, {TARGET("at", HIDE_SPRING), NUMBER("shift", -ANY, ANY)}},
    {"support_extra", NULL, HIDE_PHYSICAL, {TARGET("z", HIDE_PLACE), NUMBER("stiffness", 0, ANY)}},
    {"support_rotation", NULL, HIDE_PHYSICAL, {TARGET("z", HIDE_PLACE), NUMBER("stiffness", 0, ANY)}},
    {"clamp", NULL, HIDE_PHYSICAL, {TARGET("at", HIDE_SPRING), NUMBER("rotational", 0, ANY), OPTION("lateral", 0, 0, ANY)}},
    {"added_mass",
     NULL,
     HIDE_PHYSICAL,
     {NUMBER("mass", 0, ANY), TARGET("z", HIDE_PLACE), OPTION("inertia", 0, 0, ANY), OPTION("width", 0, 0, ANY)}},
    {"added_inertia", NULL, HIDE_PHYSICAL, {TARGET("at", HIDE_DISK), NUMBER("inertia", -ANY, ANY)}},
    {"hub_stiffness", NULL, HIDE_PHYSICAL, {NUMBER("share", 0, 1)}},
    {"density", NULL, HIDE_PHYSICAL, {TARGET("group", HIDE_GROUP), NUMBER("factor", 0.01, 100)}},
    {"stiffness", NULL, HIDE_PHYSICAL, {TARGET("group", HIDE_KNOWN_GROUP), NUMBER("factor", 0.01, 100)}},
    {"tie_stiffness", NULL, HIDE_PHYSICAL, {TARGET("at", HIDE_TIE), NUMBER("factor", 1e-6, 100)}},
    {"tie_tension", NULL, HIDE_PHYSICAL, {TARGET("at", HIDE_TIE), NUMBER("factor", 0, 100)}},
    {"tie_shear", NULL, HIDE_PHYSICAL, {TARGET("at", HIDE_TIE)}},
    {"shear_coefficient", NULL, HIDE_PHYSICAL, {TARGET("group", HIDE_KNOWN_GROUP), NUMBER("factor", 0.01, 100)}},
    {"accelerometer_mass",
     NULL,
     HIDE_PHYSICAL,
     {NUMBER("mass", 0, ANY), CHOICE("mount", 1, "fixed|moving"), {"sensor", HIDE_SENSOR, 0, 0, 0, 0, NULL}}},
    {"sensor_gain", NULL, HIDE_DATA, {TARGET("sensor", HIDE_SENSOR), NUMBER("gain", 0.01, 100)}},
    {"sensor_sign", NULL, HIDE_DATA, {TARGET("sensor", HIDE_SENSOR)}},
    {"sensor_swap", NULL, HIDE_DATA, {TARGET("sensors", HIDE_SENSOR_PAIR)}},
    {"sensor_position", NULL, HIDE_DATA, {TARGET("sensor", HIDE_SENSOR), NUMBER("shift", -ANY, ANY)}},
    {"duplicate_channel", NULL, HIDE_DATA, {TARGET("sensor", HIDE_SENSOR), TARGET("of", HIDE_SENSOR)}},
    {"noise_level", NULL, HIDE_DATA, {CHOICE("block", 1, "SHAPE|FREQUENCY"), NUMBER("factor", 0, 100)}},
    {"mode_pairing",
     NULL,
     HIDE_DATA,
     {{"swap", HIDE_MODE_PAIR, 0, 0, 0, 0, NULL},
      {"double", HIDE_MODE, 0, 0, 0, 0, NULL},
      {"missing", HIDE_MODE, 0, 0, 0, 0, NULL},
      OPTION("split", 0.004, 1e-4, 0.1)}},
    {"outside",
     "bend_only",
     HIDE_OUTSIDE,
     {NUMBER("depth", 0, 0.95), TARGET("z", HIDE_PLACE), NUMBER("width", 1e-4, ANY), CHOICE("shape", 0, "gaussian|box")}},
    {"outside", "inertia", HIDE_OUTSIDE, {TARGET("z", HIDE_PLACE), NUMBER("inertia", 0, ANY)}},
    {"outside", "density_zone", HIDE_OUTSIDE, {NUMBER("factor", 0.01, 100), TARGET("z", HIDE_PLACE), NUMBER("width", 1e-4, ANY)}},
    {"outside", "sine", HIDE_OUTSIDE, {TARGET("group", HIDE_GROUP), NUMBER("amplitude", -0.95, 0.95), NUMBER("waves", 0.01, 20)}},
    /* last, and no candidate for other classes: what a seed draws of those stays as it was */
    {"sensor_line", NULL, HIDE_DATA, {OPTION("flip", 0, 0, 1), OPTION("shift", 0, -ANY, ANY), OPTION("scale", 1, 0.1, 10)}},
    /* asked for by name alone */
    {"diameter", NULL, HIDE_PHYSICAL, {TARGET("group", HIDE_KNOWN_GROUP), NUMBER("factor", 0.5, 2)}},
};

int hide_kinds(void)
{
    return (int)(sizeof table / sizeof *table);
}

const struct hide_kind *hide_kind(int i)
{
    return &table[i];
}

int hide_is(const struct hide_effect *effect, const char *id)
{
    return !strcmp(effect->kind->outside ? effect->kind->outside : effect->kind->id, id);
}

const struct hide_value *hide_get(const struct hide_effect *effect, const char *key)
{
    static const struct hide_value none = {0, 0, -1, -1};
    for (int i = 0; i < HIDE_MOST_KEYS && effect->kind->key[i].name; i++)
        if (!strcmp(effect->kind->key[i].name, key))
            return &effect->value[i];
    return &none;
}

void hide_word(const char *words, int i, size_t room, char *word)
{
    for (; i > 0 && words; i--) {
        words = strchr(words, '|');
        words = words ? words + 1 : NULL;
    }
    snprintf(word, room, "%.*s", words ? (int)strcspn(words, "|") : 0, words ? words : "");
}

double hide_on_line(const struct hide_rotor *rotor, const struct hide_effect *effect, int sensor)
{
    double z = hide_get(effect, "shift")->number + hide_get(effect, "scale")->number * rotor->sensor[sensor].z;
    return hide_get(effect, "flip")->number > 0.5 ? rotor->length - z : z;
}
