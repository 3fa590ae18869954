/* A mass that the model does not have: at a point, or spread evenly over a width. */
#include "diagnose/causes/causes.h"

enum { POINT, BOX };
enum { MASS, PLACE, WIDTH };

#define PANELS 2 /* of Gauss points over the width: two half waves of a mode in each at most */

static const double most_width = 0.5; /* of the rotor's length; what is longer is a density */

static int point(const struct effect *effect, const struct rotor *rotor, int i, int p, struct effect_point *point)
{
    (void)rotor;
    int spread = effect->variant == BOX;
    if (i >= (spread ? PANELS * GAUSS_POINTS : 1))
        return 0;
    int panel = i / GAUSS_POINTS, g = i % GAUSS_POINTS;
    double share = spread ? gauss_weight[g] / 2 / PANELS : 1,
           off = spread ? (panel + (1 + gauss_place[g]) / 2) / PANELS - 0.5 : 0; /* from the middle, in widths */
    *point = (struct effect_point){.z = p < 0        ? effect->value[PLACE] + off * effect->value[WIDTH]
                                        : p == PLACE ? 1
                                        : p == WIDTH ? off
                                                     : 0,
                                   .mass = p < 0       ? share * effect->value[MASS]
                                           : p == MASS ? share
                                                       : 0};
    return 1;
}

static int count(const struct effect *effect)
{
    return effect->variant == BOX ? WIDTH + 1 : WIDTH;
}

static void bounds(const struct rotor *rotor, const struct effect *effect, int p, double *lower, double *upper)
{
    (void)effect;
    *lower = 0;
    *upper = p == MASS ? heaviest_overlooked(rotor) : (p == WIDTH ? most_width : 1) * rotor_length(rotor);
}

static const struct effect_kind kind = {.id = "added_mass",
                                        .nparameter = 3,
                                        .parameter = {{"mass", "kg"}, {"z", "m"}, {"width", "m"}},
                                        .point = point,
                                        .count = count};

const struct cause_kind cause_added_mass = {
    .id = "added_mass",
    .class = CAUSE_PHYSICAL,
    .target = TARGET_NONE,
    .effect = &kind,
    .parameter = {{.typical = 1, .one_sided = 1, PRIOR_OF_BOUND(0.125)},
                  {0},
                  {.typical = 0.05, .one_sided = 1, PRIOR_OF_BOUND(0.5)}},
    .place = PLACE,
    .width = -1, /* 0 is a width like others */
    .variant = {"POINT", "BOX"},
    .variant_option = "SHAPE",
    .bounds = bounds,
    .widest = 4, /* a tenth of a rotor and more */
    .sentence = "a mass that is not in the model",
    .check = "weigh the rotor, and look for a part that was fixed to it there",
};
