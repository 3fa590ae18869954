/* A mode that is paired wrongly, measured twice, missing, or no bending mode. A finding: what the shapes say about the pairing is
 * settled before the fit, and the numbers of *MODES are the user's to correct. */
#include "diagnose/causes/causes.h"

const struct cause_kind cause_mode_pairing = {
    .id = "mode_pairing",
    .class = CAUSE_DATA,
    .target = TARGET_MODES,
    NO_PLACE,
    .secant = 1,
    .sentence = "a mode that is numbered wrongly, measured twice, missing, or does not bend the rotor",
    .check = "compare the measured shapes with those of the model, and measure in a second direction",
};
