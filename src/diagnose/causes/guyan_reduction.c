/* Condensation to the measured points raises the frequencies. It acts on no hook: the remedy is the full model. */
#include "diagnose/causes/causes.h"

const struct cause_kind cause_guyan_reduction = {
    .id = "guyan_reduction",
    .class = CAUSE_NUMERICAL,
    .target = TARGET_NONE,
    NO_PLACE,
    .sentence = "the error of the condensation to the sensors exceeds the noise",
    .check = "repeat the fit with REDUCTION=NONE and see whether the moduli move",
};
