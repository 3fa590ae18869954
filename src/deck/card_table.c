#include "deck/deck_row.h"
#include "running/running.h"

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
static const struct deck_row density[] = {
    {ABOVE_0(struct material, rho, "density [kg/m3]")},
    LAST};
static const struct deck_row shaft[] = {
    OPTION("NAME"), OPTION("MATERIAL"), OPTION("FILE"),
    {ABOVE_0(struct segment, length, "length [m]")},
    {ABOVE_0(struct segment, outer, "outer diameter [m]")},
    {FROM_0(struct segment, inner, "inner diameter [m]"), OPTIONAL},
    ELEMENTS(struct segment),
    {ABOVE_0(struct segment, stiff_outer, "outer diameter that carries stiffness [m]"), OPTIONAL,
     .as = offsetof(struct segment, outer)},
    LAST};
static const struct deck_row beam[] = {
    OPTION("NAME"), OPTION("MATERIAL"), OPTION("FILE"),
    {ABOVE_0(struct segment, length, "length [m]")},
    {ABOVE_0(struct segment, height, "height in the bending plane [m]")},
    {ABOVE_0(struct segment, width, "width [m]")},
    ELEMENTS(struct segment),
    LAST};
static const struct deck_row layer[] = {
    OPTION("NAME"), OPTION("GROUP"), OPTION("MATERIAL"),
    {ABOVE_0(struct ring, outer, "outer diameter [m]")},
    {FROM_0(struct ring, inner, "inner diameter [m]")},
    LAST};
static const struct deck_row perforation[] = {
    OPTION("GROUP"),
    {WHOLE(struct group, holes, "number of holes"), FROM_TO(3, 10000)},
    {ABOVE_0(struct group, hole_diameter, "hole diameter [m]")},
    {ABOVE_0(struct group, hole_pitch, "pitch radius [m]")},
    LAST};
static const struct deck_row tierod[] = {
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
    {WHOLE(struct tierod, elements, "number of elements"), FROM_TO(1, DECK_MOST_ELEMENTS), OPTIONAL, .standard = 1},
    LAST};
static const struct deck_row bars[] = {
    NAME(struct bars),
    MATERIAL(struct bars),
    {.option = "CENTER", POSITION(struct bars, center)},
    {.option = "LENGTH", ABOVE_0(struct bars, length, "length [m]")},
    {.option = "MODEL", WORD(struct bars, model, models)},
    {WHOLE(struct bars, number, "number of bars"), FROM_TO(3, 10000)},
    {ABOVE_0(struct bars, diameter, "diameter [m]")},
    {ABOVE_0(struct bars, pitch, "pitch radius [m]")},
    {WHOLE(struct bars, elements, "number of elements"), FROM_TO(2, DECK_MOST_ELEMENTS), .bits = ROW_MESH},
    LAST};
static const struct deck_row clamp[] = {
    {.option = "NAME", .kind = ROW_NAME, IN(struct spring, name), OPTIONAL, .what = "name"},
    {.option = "AT", POSITION(struct spring, position)},
    LAST};
static const struct deck_row sling[] = {
    {.option = "LENGTH", ABOVE_0(struct rotor, sling, "length [m]")},
    LAST};

/* ---- measured data, causes, identification, transfer functions */

static const struct deck_row noise[] = {
    {.option = "FREQUENCY", ABOVE_0(struct deck_reader, noise_frequency, ""), OPTIONAL},
    {.option = "SHAPE", ABOVE_0(struct deck_reader, noise_shape, ""), OPTIONAL},
    {.option = "FLOOR_FREQUENCY", FROM_0(struct deck_reader, floor_frequency, "(0)"), OPTIONAL},
    {.option = "FLOOR_SHAPE", FROM_0(struct deck_reader, floor_shape, "(0)"), OPTIONAL},
    LAST};
static const struct deck_row weight[] = {
    {ABOVE_0(struct weighed, mass, "mass [kg]")},
    {ABOVE_0(struct weighed, mass_std, "standard deviation of it [kg]")},
    LAST};
static const struct deck_row centre[] = {
    {POSITION(struct weighed, centre)},
    {ABOVE_0(struct weighed, centre_std, "standard deviation of it [m]")},
    LAST};
static const struct deck_row fit[] = {
    {.option = "FUNCTIONAL", WORD(struct job_options, fit.functional, functional_words), OPTIONAL, .standard = -1},
    {.option = "REDUCTION", WORD(struct job_options, fit.reduction, reduction_words), OPTIONAL},
    OPTION("MODES"), OPTION("HOLDOUT"), OPTION("STATE"),
    {.option = "DERIVATIVE", WORD(struct job_options, fit.derivative, derivative_words), OPTIONAL},
    OTHER("TIE", .words = ties, .standard = -1),
    {.option = "MODEL", WORD(struct job_options, solid, discretisations)},
    LAST};
static const struct deck_row frf[] = {
    OPTION("FILE"),
    {.option = "LOW", ABOVE_0(struct frf_request, low_hz, "[Hz]"), .bits = ROW_MAY_LACK | ROW_ABOVE_0},
    {.option = "HIGH", ABOVE_0(struct frf_request, high_hz, "[Hz]"), .bits = ROW_MAY_LACK | ROW_ABOVE_0},
    {.option = "STEP", ABOVE_0(struct frf_request, step_hz, "[Hz]"), .bits = ROW_MAY_LACK | ROW_ABOVE_0},
    {.option = "LINES", WHOLE(struct frf_request, nline, "(1601)"), FROM_TO(2, FRF_MOST_LINES),
     .bits = ROW_MAY_LACK | ROW_ABOVE_0},
    {.option = "QUANTITY", WORD(struct frf_request, quantity, quantities), .standard = FRF_ACCELERATION},
    {.option = "DAMPING", ABOVE_0(struct frf_request, damping, ""), OPTIONAL},
    {.option = "AXIS", WORD(struct frf_request, axis, axes), .standard = 2},
    {.option = "ORIGIN", NUMBER(struct frf_request, origin, "[m]"), OPTIONAL},
    {.option = "FLIP", WORD(struct frf_request, flip, deck_answers)},
    LAST};
static const struct deck_row identify[] = {
    {.kind = ROW_NAME, IN(rotid_parameter, name), .what = "parameter"},
    {NUMBER(rotid_parameter, lower, "lower bound")},
    {NUMBER(rotid_parameter, upper, "upper bound")},
    {NUMBER(rotid_parameter, start, "start")},
    LAST};

static const char *const types[] = {"ISOTROPIC", "SHEAR", "LAMINATED", NULL};

static const struct deck_row nothing[] = {LAST}, material[] = {NAME(struct material), LAST},
    elastic[] = {OTHER("TYPE", .words = types), LAST}, preload[] = {OPTION("GROUP"), LAST};

static const struct deck_row disk[] = {
    {.option = "NAME", .kind = ROW_NAME, IN(struct disk, name), OPTIONAL, .what = "name"},
    {POSITION(struct disk, position)},
    {FROM_0(struct disk, mass, "mass [kg]")},
    {FROM_0(struct disk, diametral, "diametral inertia [kg.m2]"), OPTIONAL},
    {FROM_0(struct disk, polar, "polar inertia [kg.m2]"), OPTIONAL},
    {FROM_0(struct disk, hub_length, "hub length [m]"), .bits = ROW_MAY_LACK | ROW_ABOVE_0},
    {FROM_0(struct disk, hub_outer, "hub outer diameter [m]"), .bits = ROW_MAY_LACK | ROW_ABOVE_0},
    LAST};
static const struct deck_row spring[] = {
    {.option = "NAME", .kind = ROW_NAME, IN(struct spring, name), OPTIONAL, .what = "name"},
    {POSITION(struct spring, position)},
    {FROM_0(struct spring, lateral, "lateral stiffness [N/m]")},
    {FROM_0(struct spring, rotational, "rotational stiffness [N.m/rad]"), OPTIONAL},
    {FROM_0(struct spring, torsional, "torsional stiffness [N.m/rad]"), OPTIONAL},
    {FROM_0(struct spring, axial, "axial stiffness [N/m]"), OPTIONAL},
    LAST};

const char *const deck_counts[] = {"ELASTIC", "ALL", NULL};
static const struct deck_row sensors[] = {
    OPTION("FILE"),
    {WHOLE(struct sensor, id, "sensor id"), FROM_TO(1, 1000000000)},
    {POSITION(struct sensor, position)},
    LAST};
static const struct deck_row modes[] = {
    OTHER("TYPE", .words = mode_type_words),
    OTHER("COUNT", .words = deck_counts, .standard = -1),
    OPTION("FILE"),
    {WHOLE(struct mode_line, number, "mode"), FROM_TO(1, DECK_MOST_MODES)},
    {ABOVE_0(struct mode_line, hz, "frequency [Hz]")},
    {FROM_0(struct mode_line, damping, "damping ratio"), OR_NAN},
    {ABOVE_0(struct mode_line, std, "standard deviation of the frequency [Hz]"), OR_NAN},
    LAST};
static const struct deck_row shape[] = {
    OPTION("MODE"), OPTION("FILE"),
    {WHOLE(struct point_line, id, "sensor id"), FROM_TO(1, 1000000000)},
    {NUMBER(struct point_line, value, "value")},
    {ABOVE_0(struct point_line, std, "standard deviation"), OR_NAN},
    LAST};
static const struct deck_row frequencies[] = {
    OPTION("MODE"), OPTION("FILE"),
    OTHER("MEAN", .words = deck_answers, .standard = 1),
    {WHOLE(struct point_line, id, "sensor id"), FROM_TO(1, 1000000000)},
    {ABOVE_0(struct point_line, value, "frequency [Hz]")},
    {ABOVE_0(struct point_line, std, "standard deviation [Hz]"), OR_NAN},
    LAST};
static const struct deck_row measured[] = {
    OPTION("FILE"),
    {.option = "AXIS", WORD(struct measured_nodes, axis, axes), .standard = 2},
    {.option = "DIRECTION", WORD(struct measured_nodes, component, axes)},
    {.option = "ORIGIN", NUMBER(struct measured_nodes, origin, "[m]"), OPTIONAL},
    {.option = "FLIP", WORD(struct measured_nodes, flip, deck_answers)},
    {.option = "SCALE", ABOVE_0(struct measured_nodes, scale, "(1)"), OPTIONAL},
    OTHER("COUNT", .words = deck_counts, .standard = -1),
    OPTION("HAMMER"),
    LAST};
static const struct deck_row state[] = {OPTION("NAME"), OPTION("MODES"), OPTION("HOLDOUT"), LAST};
static const struct deck_row cause[] = {
    OPTION("NAME"), OPTION("TYPE"), OPTION("GROUP"), OPTION("AT"), OPTION("SENSOR"), OPTION("BETWEEN"),
    OPTION("SHAPE"), OPTION("MOUNT"),
    OTHER("SUSPECT", .words = deck_answers),
    LAST};

/* ---- the machine in operation */

#define DEGREE 0.017453292519943295

static const char *const losses[] = {"HYSTERETIC", "VISCOUS", NULL}, *const whirls[] = {"FORWARD", "BACKWARD", NULL};
const char *const deck_axes[] = {"XY", "LOAD", NULL};

static const struct deck_row pedestal[] = {
    OPTION("BEARING"), OPTION("FILE"),
    {ABOVE_0(struct pedestal_line, m[0], "mass mx [kg]")},
    {ABOVE_0(struct pedestal_line, m[1], "mass my [kg]")},
    {ABOVE_0(struct pedestal_line, k[0], "stiffness kx [N/m]"), OPTIONAL},
    {ABOVE_0(struct pedestal_line, k[1], "stiffness ky [N/m]"), OPTIONAL},
    {FROM_0(struct pedestal_line, c[0], "damping cx [N.s/m]"), OPTIONAL},
    {FROM_0(struct pedestal_line, c[1], "damping cy [N.s/m]"), OPTIONAL},
    LAST};
static const struct deck_row loss[] = {
    {.option = "TYPE", WORD(struct loss, viscous, losses)},
    OPTION("TEST"),
    {.kind = ROW_GROUP, IN(struct loss, group), .what = "group"},
    {FROM_0(struct loss, value, "loss factor"), OPTIONAL},
    {FROM_0(struct loss, std, "standard deviation of the loss"), OPTIONAL},
    LAST};
static const struct deck_row pull[] = {
    {.option = "GROUP", .kind = ROW_GROUP, IN(struct pull, group)},
    {.option = "STD", FROM_0(struct pull, std, "(0)"), OPTIONAL},
    {FROM_0(struct pull, value, "stiffness of the pull, without its sign [N/m]")},
    LAST};
static const struct deck_row change[] = {
    {.kind = ROW_NAME, IN(struct change, name), .what = "parameter"},
    {ABOVE_0(struct change, factor, "factor")},
    {FROM_0(struct change, std, "standard deviation of the factor"), OPTIONAL},
    LAST};
static const struct deck_row unbalance[] = {
    {.option = "G", ABOVE_0(struct unbalance, grade, ""), OPTIONAL, .factor = 1e-3},
    {POSITION(struct unbalance, z)},
    {FROM_0(struct unbalance, value, "unbalance [kg.m]")},
    {NUMBER(struct unbalance, phase, "phase [deg]"), OPTIONAL, .factor = DEGREE},
    LAST};
static const struct deck_row probe[] = {
    {.option = "NAME", .kind = ROW_NAME, IN(struct probe, name), .what = "name"},
    {POSITION(struct probe, z)},
    {NUMBER(struct probe, angle, "angle [deg]"), OPTIONAL, .factor = DEGREE},
    LAST};
static const struct deck_row runup[] = {
    {WHOLE(struct runup_reading, number, "number of the critical speed"), FROM_TO(1, DECK_MOST_MODES)},
    {ABOVE_0(struct runup_reading, speed, "critical speed [rpm]"), .factor = RPM},
    {ABOVE_0(struct runup_reading, std, "standard deviation of it [rpm]"), .factor = RPM},
    {WORD(struct runup_reading, backward, whirls), .what = "whirl ", OPTIONAL},
    LAST};
static const struct deck_row unknown[] = {
    {.kind = ROW_NAME, IN(struct machine_unknown, bounds.name), .what = "parameter"},
    {ABOVE_0(struct machine_unknown, bounds.lower, "lower bound")},
    {ABOVE_0(struct machine_unknown, bounds.upper, "upper bound")},
    {ABOVE_0(struct machine_unknown, bounds.start, "start")},
    LAST};
static const struct deck_row running[] = {OPTION("WITHOUT"), LAST},
    bearing[] = {OPTION("NAME"), OPTION("FILE"), OTHER("STD", .what = "(0)"), OPTION("LIKE"), OTHER("AXES", .words = deck_axes), LAST};
static const struct deck_row operation[] = {
    OTHER("MARGIN", .what = "(0)"),
    {.option = "LINE", ABOVE_0(struct machine, line_hz, "[Hz]"), OPTIONAL},
    OPTION("POLES"),
    {ABOVE_0(struct machine, low, "lowest speed [rpm]"), .factor = RPM},
    {ABOVE_0(struct machine, high, "highest speed [rpm]"), .factor = RPM},
    LAST};

#define BY_CODE    .size = 0
#define COMMON     BY_CODE, .states = CARD_COMMON
#define REPLACES   BY_CODE, .states = CARD_REPLACES
#define OF_STATE   BY_CODE, .states = CARD_OF_STATE
#define OF_MACHINE BY_CODE, .states = CARD_OF_MACHINE
#define LIST_IN(O, S, M) .size = sizeof(struct S), .list = offsetof(struct O, M), .count = offsetof(struct O, n##M)
#define LIST(S, M)       LIST_IN(rotor, S, M)
#define MACHINE(S, M)    LIST_IN(machine, S, M), .states = CARD_OF_MACHINE

#define DISK_LINES     "position, mass [kg] [, diametral inertia, polar inertia [kg.m2] [, hub length, hub outer diameter [m]]]"
#define IDENTIFY_LINES "parameter, lower bound, upper bound, start"

/* In the order of docs/deck.md. */
const struct deck_card deck_card_table[] = {
    {"HEADING", CARD_MODEL, 4, deck_heading, "text; see [References](#references-in-the-heading)", nothing, COMMON, .once = 1},
    {"UNITS", CARD_MODEL, 0, deck_units, NULL, deck_units_rows, COMMON, .instead = "options such as LENGTH=MM"},
    {"MATERIAL", CARD_MODEL, 1, deck_material, NULL, material, BY_CODE, .instead = "*ELASTIC and *DENSITY behind it"},
    {"ELASTIC", CARD_MODEL, 1, deck_elastic, "E [Pa], nu; with SHEAR: E [Pa], G [Pa], nu; with LAMINATED: E, G along the axis [Pa], E [Pa], nu of a sheet [, stacking factor]", elastic, BY_CODE},
    {"DENSITY", CARD_MODEL, 1, deck_density, "density [kg/m3]", density, BY_CODE},
    {"SHAFT", CARD_MODEL, 2, deck_sections,
     "length, outer diameter [m] [, inner diameter [, elements [, outer diameter that carries stiffness]]]", shaft, BY_CODE},
    {"BEAM", CARD_MODEL, 2, deck_sections, "length, height in the bending plane, width [m] [, elements]", beam, BY_CODE},
    {"LAYER", CARD_MODEL, 3, deck_layer, "outer diameter, inner diameter [m]", layer, BY_CODE},
    {"PERFORATION", CARD_MODEL, 4, deck_perforation, "number, hole diameter [m], pitch radius [m]", perforation, BY_CODE},
    {"TIEROD", CARD_MODEL, 4, NULL, "number, diameter [m], pitch radius [m], tension per rod [N] [, elements]",
     tierod, LIST(tierod, tierod), .check = deck_check_tierod, .places = TIEROD_PLACES, .single = 1},
    {"BARS", CARD_MODEL, 4, NULL, "number, diameter [m], pitch radius [m], elements", bars, LIST(bars, bars),
     .check = deck_check_bars, .places = BARS_PLACES, .single = 1},
    {"PRELOAD", CARD_MODEL, 4, deck_preload, "axial force [N], tension positive", preload, BY_CODE},
    {"DISK", CARD_MODEL, 4, NULL, DISK_LINES, disk, LIST(disk, disk),
     .check = deck_check_disk},
    {"SPRING", CARD_MODEL, 4, NULL, "position, lateral stiffness [N/m] [, rotational stiffness [N.m/rad] [, torsional stiffness [N.m/rad] [, axial stiffness [N/m]]]]", spring,
     LIST(spring, spring)},
    {"CLAMP", CARD_MODEL, 4, deck_clamp, NULL, clamp, BY_CODE, .instead = "AT=start or AT=end on the card"},
    {"SLING", CARD_MODEL, 4, deck_sling, NULL, sling, REPLACES, .instead = "LENGTH=length [m] on the card", .once = 1},
    {"SENSORS", CARD_MEASURED, 4, NULL, "sensor id, position", sensors, LIST(sensor, sensor), .states = CARD_REPLACES, .check = deck_check_sensor, .places = SENSOR_PLACES},
    {"MODES", CARD_MEASURED, 5, deck_modes,
     "mode, frequency [Hz] [, damping ratio [, standard deviation of the frequency [Hz]]]", modes, OF_STATE, .once = 1},
    {"SHAPE", CARD_MEASURED, 6, deck_shape, "sensor id, value [, standard deviation relative to the largest component]", shape, OF_STATE},
    {"FREQUENCIES", CARD_MEASURED, 6, deck_frequencies, "sensor id, frequency [Hz] [, standard deviation of it [Hz]]",
     frequencies, OF_STATE},
    {"MEASURED", CARD_MEASURED, 6, deck_measured, NULL, measured, OF_STATE, .once = 1},
    {"NOISE", CARD_MEASURED, 5, deck_noise, NULL, noise, REPLACES, .instead = "options on the card", .once = 1},
    {"WEIGHT", CARD_MEASURED, 6, deck_weight, "mass, standard deviation [kg]", weight, OF_STATE, .once = 1},
    {"CENTRE", CARD_MEASURED, 6, deck_weight, "position of the centre of mass, standard deviation [m]", centre, OF_STATE, .once = 1},
    {"CAUSE", CARD_CAUSE, 7, deck_cause, "parameter, value", cause, BY_CODE},
    {"IDENTIFY", CARD_IDENTIFICATION, 8, deck_identify, IDENTIFY_LINES, identify, BY_CODE},
    {"FIT", CARD_IDENTIFICATION, 8, deck_fit, NULL, fit, COMMON, .instead = "options on the card", .once = 1},
    {"FRF", CARD_FRF, 6, deck_frf, "response sensor id, reference sensor id", frf, REPLACES, .once = 1},
    {"STATE", CARD_STATES, 8, deck_choose_modes, NULL, state, BY_CODE, .instead = "the cards of the state behind it"},
    {"SET", CARD_STATES, 8, deck_set, "parameter or GROUP.length, value", nothing, BY_CODE},
    {"RUNNING", CARD_RUNNING, 9, deck_running, "names of supports and masses that were left at the test", running, OF_MACHINE},
    {"BEARING", CARD_RUNNING, 9, deck_bearing, "position, k [N/m], c [N.s/m]; or kxx, kyy, cxx, cyy; or kxx, kxy, kyx, kyy, cxx, cxy, cyx, cyy; with FILE: position", bearing, OF_MACHINE},
    {"PEDESTAL", CARD_RUNNING, 10, deck_pedestal, "mx, my [kg], kx, ky [N/m] [, cx, cy [N.s/m]]; with FILE: mx, my", pedestal, OF_MACHINE},
    {"LOSS", CARD_RUNNING, 10, NULL, "group, loss factor [, standard deviation]; VISCOUS: group, loss [s] [, standard deviation]; with TEST: group", loss, MACHINE(loss, loss), .check = deck_check_loss},
    {"PULL", CARD_RUNNING, 10, NULL, "stiffness of the magnetic pull, without its sign [N/m]", pull, MACHINE(pull, pull), .single = 1},
    {"CHANGE", CARD_RUNNING, 10, NULL, "parameter, factor [, standard deviation of its logarithm]", change, MACHINE(change, change), .check = deck_check_change},
    {"UNBALANCE", CARD_RUNNING, 10, NULL, "position, unbalance [kg.m] [, phase [deg]]; with G: position, fraction of the permitted unbalance [, phase [deg]]", unbalance, MACHINE(unbalance, unbalance)},
    {"PROBE", CARD_RUNNING, 10, NULL, "position [, angle from x [deg]]", probe, MACHINE(probe, probe), .single = 1},
    {"OPERATION", CARD_RUNNING, 10, deck_operation, "lowest, highest speed [rpm]", operation, OF_MACHINE, .once = 1},
    {"RUNUP", CARD_RUNNING, 10, NULL, "number, critical speed, standard deviation [rpm] [, BACKWARD]", runup, MACHINE(runup_reading, runup), .check = deck_check_runup, .once = 1},
    {.name = NULL}};

/* What two cards of the rotor at rest mean behind *RUNNING. */
static const struct deck_card of_machine[] = {
    {"DISK", CARD_RUNNING, 10, NULL, DISK_LINES, disk, MACHINE(disk, disk), .check = deck_check_disk},
    {"IDENTIFY", CARD_RUNNING, 10, NULL, IDENTIFY_LINES, unknown, MACHINE(machine_unknown, unknown), .check = deck_check_unknown},
    {.name = NULL}};
/* clang-format on */

static const struct deck_card *find(const struct deck_card *kind, const char *name)
{
    while (kind->name && strcmp(kind->name, name) != 0)
        kind++;
    return kind->name ? kind : NULL;
}

const struct deck_card *deck_card_find(const char *name)
{
    return find(deck_card_table, name);
}

int deck_stands(const struct card *card, enum card_states where)
{
    return card->kind && card->kind->states == where;
}

const struct deck_row *deck_rows(const char *card)
{
    return deck_card_find(card)->row;
}

const struct deck_card *deck_card_of_machine(const char *name)
{
    const struct deck_card *kind = find(of_machine, name);
    return kind ? kind : find(deck_card_table, name);
}
