/* The rotor is no beam: a step of the diameter, at which beam theory is too stiff, a short section, a section that warps. It acts
 * on no hook and has no parameter: the remedy is the same rotor as a solid, with what is identified fitted anew. */
#include "diagnose/causes/causes.h"

static const struct effect_kind kind = {.id = "beam_theory"};

const struct cause_kind cause_beam_theory = {
    .id = "beam_theory",
    .class = CAUSE_PHYSICAL,
    .target = TARGET_NONE,
    .effect = &kind,
    NO_PLACE,
    .solid = 1,
    .sentence = "a rotor that is no beam: the same rotor as a solid fits the data better",
    .check = "identify with *FIT, MODEL=SOLID",
};
