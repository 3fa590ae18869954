/* The elements are too long for the frequencies asked for. It acts on no hook: the remedy is a finer mesh. */
#include "diagnose/causes/causes.h"

const struct cause_kind cause_mesh = {
    .id = "mesh",
    .class = CAUSE_NUMERICAL,
    .target = TARGET_NONE,
    NO_PLACE,
    .sentence = "the error of the mesh exceeds the noise",
    .check = "double the number of elements and see whether the frequencies move",
};
