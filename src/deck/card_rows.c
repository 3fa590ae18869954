/* Options and values of the cards that have code of their own. */
#include "deck/deck.h"
#include "deck/deck_row.h"

static const char *const models[] = {"RODS", "TUBE", NULL}, *const axes[] = {"X", "Y", "Z", NULL},
                         *const quantities[] = {"DISPLACEMENT", "VELOCITY", "ACCELERATION", NULL}, *const ties[] = {"E:G", NULL},
                         *const discretisations[] = {"BEAM", "SOLID", NULL};

/* clang-format off */

/* ---- the model */

const struct deck_row deck_elastic_rows[] = {
    {ABOVE_0(struct material, e, "Young's modulus E [Pa]")},
    {NUMBER(struct material, nu, "Poisson ratio nu")},
    LAST};
const struct deck_row deck_shear_rows[] = {
    {ABOVE_0(struct material, e, "Young's modulus E [Pa]")},
    {ABOVE_0(struct material, g, "shear modulus G [Pa]")},
    {NUMBER(struct material, nu, "Poisson ratio nu")},
    LAST};
const struct deck_row deck_laminated_rows[] = {
    {ABOVE_0(struct material, e, "Young's modulus E along the axis [Pa]")},
    {ABOVE_0(struct material, g, "shear modulus G along the axis [Pa]")},
    {ABOVE_0(struct material, sheet_e, "Young's modulus of a sheet [Pa]")},
    {NUMBER(struct material, nu, "Poisson ratio of a sheet")},
    {ABOVE_0(struct material, stacking, "stacking factor"), OPTIONAL},
    LAST};
const struct deck_row deck_density_rows[] = {
    {ABOVE_0(struct material, rho, "density [kg/m3]")},
    LAST};
const struct deck_row deck_shaft_rows[] = {
    {ABOVE_0(struct segment, length, "length [m]")},
    {ABOVE_0(struct segment, outer, "outer diameter [m]")},
    {FROM_0(struct segment, inner, "inner diameter [m]")},
    ELEMENTS(struct segment),
    {ABOVE_0(struct segment, stiff_outer, "outer diameter that carries stiffness [m]"), OPTIONAL,
     .as = offsetof(struct segment, outer)},
    LAST};
const struct deck_row deck_beam_rows[] = {
    {ABOVE_0(struct segment, length, "length [m]")},
    {ABOVE_0(struct segment, height, "height in the bending plane [m]")},
    {ABOVE_0(struct segment, width, "width [m]")},
    ELEMENTS(struct segment),
    LAST};
const struct deck_row deck_layer_rows[] = {
    {ABOVE_0(struct ring, outer, "outer diameter [m]")},
    {FROM_0(struct ring, inner, "inner diameter [m]")},
    LAST};
const struct deck_row deck_perforation_rows[] = {
    {WHOLE(struct group, holes, "number of holes"), FROM_TO(3, 10000)},
    {ABOVE_0(struct group, hole_diameter, "hole diameter [m]")},
    {ABOVE_0(struct group, hole_pitch, "pitch radius [m]")},
    LAST};
const struct deck_row deck_tierod_rows[] = {
    NAME(struct tierod),
    MATERIAL(struct tierod),
    {.option = "FROM", POSITION(struct tierod, from)},
    {.option = "TO", POSITION(struct tierod, to)},
    {.option = "MODEL", WORD(struct tierod, model, models)},
    {.option = "SELF_EQUILIBRATED", WORD(struct tierod, self_equilibrated, deck_answers), .standard = 1},
    {WHOLE(struct tierod, number, "number of rods"), FROM_TO(3, 10000)},
    {ABOVE_0(struct tierod, diameter, "diameter [m]")},
    {ABOVE_0(struct tierod, pitch, "pitch radius [m]")},
    {NUMBER(struct tierod, tension, "tension per rod [N]")},
    {WHOLE(struct tierod, elements, "number of elements"), FROM_TO(1, DECK_MOST_ELEMENTS), OPTIONAL},
    LAST};
const struct deck_row deck_bars_rows[] = {
    NAME(struct bars),
    MATERIAL(struct bars),
    {.option = "CENTER", POSITION(struct bars, center)},
    {.option = "LENGTH", ABOVE_0(struct bars, length, "length [m]")},
    {.option = "MODEL", WORD(struct bars, model, models)},
    {WHOLE(struct bars, number, "number of bars"), FROM_TO(3, 10000)},
    {ABOVE_0(struct bars, diameter, "diameter [m]")},
    {ABOVE_0(struct bars, pitch, "pitch radius [m]")},
    {WHOLE(struct bars, elements, "number of elements"), FROM_TO(2, DECK_MOST_ELEMENTS)},
    LAST};
const struct deck_row deck_sling_rows[] = {
    {.option = "LENGTH", ABOVE_0(struct rotor, sling, "length [m]")},
    LAST};

/* ---- measured data, causes, identification, transfer functions */

const struct deck_row deck_noise_rows[] = {
    {.option = "FREQUENCY", ABOVE_0(struct deck_reader, noise_frequency, ""), OPTIONAL},
    {.option = "SHAPE", ABOVE_0(struct deck_reader, noise_shape, ""), OPTIONAL},
    {.option = "FLOOR_FREQUENCY", FROM_0(struct deck_reader, floor_frequency, "(0)"), OPTIONAL},
    {.option = "FLOOR_SHAPE", FROM_0(struct deck_reader, floor_shape, "(0)"), OPTIONAL},
    LAST};
const struct deck_row deck_fit_rows[] = {
    {.option = "FUNCTIONAL", WORD(rotid_fit_options, functional, functional_words), OPTIONAL, .standard = -1},
    {.option = "REDUCTION", WORD(rotid_fit_options, reduction, reduction_words), OPTIONAL},
    OTHER("MODES", .what = ""),
    OTHER("HOLDOUT", .what = ""),
    OTHER("STATE", .what = ""),
    {.option = "DERIVATIVE", WORD(rotid_fit_options, derivative, derivative_words), OPTIONAL},
    OTHER("TIE", .words = ties, .standard = -1),
    OTHER("MODEL", .words = discretisations),
    LAST};
const struct deck_row deck_frf_rows[] = {
    OTHER("FILE", .what = ""),
    {.option = "LOW", ABOVE_0(struct frf_request, low_hz, "[Hz]"), .bits = ROW_MAY_LACK | ROW_ABOVE_0},
    {.option = "HIGH", ABOVE_0(struct frf_request, high_hz, "[Hz]"), .bits = ROW_MAY_LACK | ROW_ABOVE_0},
    {.option = "STEP", ABOVE_0(struct frf_request, step_hz, "[Hz]"), .bits = ROW_MAY_LACK | ROW_ABOVE_0},
    {.option = "LINES", WHOLE(struct frf_request, nline, "(1601)"), FROM_TO(2, FRF_MOST_LINES),
     .bits = ROW_MAY_LACK | ROW_ABOVE_0},
    OTHER("QUANTITY", .words = quantities, .standard = 2),
    OTHER("DAMPING", .what = ""),
    OTHER("AXIS", .words = axes, .standard = 2),
    OTHER("ORIGIN", .what = "[m]"),
    OTHER("FLIP", .words = deck_answers),
    LAST};
/* clang-format on */
