/* The generator of hidden effects (tools/hide): its physics against the oracle and against decks that say the same in other
 * cards, its noise, its faults of the data, its messages. */
#include <pthread.h>

#include <cjson/cJSON.h>

#include "exact.h"
#include "hide/hide.h"
#include "paper_rotor.h"
#include "support.h"

#define MODES   6
#define SENSORS 68

static char *paper, *solid; /* texts of decks */

struct result {
    char *deck, *truth;
    cJSON *json;
};

static char *read_deck(const char *path)
{
    char name[600], *text = calloc(1, 100000);
    snprintf(name, sizeof name, "%s/input/%s", ROTID_SOURCE_DIR, path);
    FILE *file = fopen(name, "rb");
    assert_non_null(file);
    assert_true(fread(text, 1, 99999, file) > 0);
    fclose(file);
    return text;
}

static struct hide_request clean(const char *deck)
{
    static const char *const truth[] = {"core.E=6e10", "core.G=3e10"};
    struct hide_request r = hide_request_default();
    r.deck = deck;
    r.frequency_noise = r.shape_noise = 0;
    r.truth = truth;
    r.truths = 2;
    r.sensors = deck == solid ? SENSORS : 0;
    return r;
}

static struct result make(const struct hide_request *request)
{
    char message[600] = "";
    struct result result;
    int status = hide_case(request, &result.deck, &result.truth, message, sizeof message);
    if (status)
        fail_msg("%s: %s", request->effects ? request->effect[0] : "no effect", message);
    result.json = cJSON_Parse(result.truth);
    assert_non_null(result.json);
    return result;
}

static struct result make_with(const char *deck, const char *spec)
{
    struct hide_request r = clean(deck);
    r.effect = &spec;
    r.effects = spec != NULL;
    return make(&r);
}

static void close_result(struct result *result)
{
    cJSON_Delete(result->json);
    free(result->deck);
    free(result->truth);
}

/* "with" or "without" of the truth */
static const cJSON *of(const struct result *result, const char *which, const char *what)
{
    const cJSON *item = cJSON_GetObjectItem(cJSON_GetObjectItem(result->json, which), what);
    assert_non_null(item);
    return item;
}

static double hz(const struct result *result, const char *which, int mode)
{
    return cJSON_GetArrayItem(of(result, which, "frequency_hz"), mode)->valuedouble;
}

/* The shapes that stand in the deck, shape[mode * sensors + i] in its order; returns how many values. */
static int deck_shapes(const char *deck, double *shape)
{
    int count = 0, inside = 0;
    for (const char *line = deck; line; line = strchr(line, '\n'), line += line != NULL) {
        long id;
        double value;
        if (*line == '*')
            inside = !strncmp(line, "*SHAPE", 6);
        else if (inside && sscanf(line, "%ld, %lf", &id, &value) == 2)
            shape[count++] = value;
    }
    return count;
}

static int deck_hz(const char *deck, double *frequency)
{
    int count = 0, number, used;
    const char *line = strstr(deck, "*MODES\n");
    assert_non_null(line);
    for (line += 7; sscanf(line, "%d, %lf\n%n", &number, &frequency[count], &used) == 2; line += used) {
        assert_int_equal(number, count + 1);
        count++;
    }
    return count;
}

/* ---- physics ---- */

UNIT_TEST(without_effect_it_is_the_oracle)
{
    struct result r = make_with(paper, NULL);
    struct exact exact;
    double truth[MODES], frequency[MODES], shape[SENSORS], z[SENSORS], written[MODES * SENSORS];
    exact_open(paper_rotor(BUNDLE_TUBE, 0), &exact);
    exact_hz(&exact, 3, MODES, truth);
    assert_int_equal(deck_hz(r.deck, frequency), MODES);
    assert_hz(MODES, frequency, truth, 1e-9);
    assert_int_equal(deck_shapes(r.deck, written), MODES * SENSORS);
    for (int s = 0; s < SENSORS; s++)
        z[s] = cJSON_GetObjectItem(cJSON_GetArrayItem(cJSON_GetObjectItem(r.json, "sensors"), s), "z")->valuedouble;
    for (int k = 0; k < MODES; k++) {
        assert_int_equal(oracle_shape(&exact.system, truth[k], SENSORS, z, shape, NULL), ORACLE_OK);
        for (int s = 0; s < SENSORS; s++)
            assert_close(written[k * SENSORS + s], shape[s], 0, 1e-6);
        assert_close(hz(&r, "without", k), truth[k], 1e-9, 0);
    }
    close_result(&r);
}

/* Rayleigh: less stiffness or more mass lowers every frequency, more stiffness raises it. */
UNIT_TEST(frequencies_move_as_they_must)
{
    static const struct {
        const char *spec;
        int sign;
    } table[] = {{"step_stiffness:angle=35", -1},
                 {"stiffness_local:depth=0.5,z=0.609,width=0.03", -1},
                 {"stiffness_local:depth=0.5,z=0.609,width=0.05,shape=box", -1},
                 {"joint:at=core.end,flexibility=4e-10", -1},
                 {"support:at=sling,factor=3", 1},
                 {"added_mass:mass=10,z=1.6,inertia=0.1", -1},
                 {"density:group=core,factor=0.94", 1},
                 {"stiffness:group=left,factor=0.96", -1},
                 {"tie_stiffness:at=ties,factor=0.3", -1},
                 {"tie_tension:at=ties,factor=2", 1}, /* SELF_EQUILIBRATED=NO */
                 {"tie_shear:at=ties", -1},
                 {"shear_coefficient:group=left,factor=0.9", -1},
                 {"accelerometer_mass:mass=0.5,mount=fixed,sensor=23", -1},
                 {"accelerometer_mass:mass=0.5,mount=moving", -1},
                 {"outside:kind=bend_only,depth=0.5,z=0.6,width=0.03", -1},
                 {"added_mass:mass=10,z=1.6,width=0.3", -1},
                 {"support_extra:z=1,stiffness=1e7", 1},
                 {"support_rotation:z=1,stiffness=1e7", 1},
                 {"clamp:at=sling,rotational=0,lateral=1e-4", -1},
                 {"outside:kind=inertia,z=1,inertia=0.5", -1},
                 {"outside:kind=density_zone,factor=1.2,z=1,width=0.1", -1}};
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        struct result r = make_with(paper, table[i].spec);
        double largest = 0;
        for (int k = 0; k < MODES; k++) {
            double change = hz(&r, "with", k) / hz(&r, "without", k) - 1;
            assert_true(table[i].sign * change > -1e-9);
            largest = fmax(largest, fabs(change));
        }
        if (!(largest > 1e-7 && largest < 0.2))
            fail_msg("%s: largest change %g", table[i].spec, largest);
        close_result(&r);
    }
}

/* Nothing at the neutral size, and near it a change in proportion. */
UNIT_TEST(effects_vanish_smoothly)
{
    static const struct {
        const char *format;
        double neutral, step, tolerance;
    } table[] = {{"step_stiffness:angle=%.9g", 90, -0.5, 0.1},
                 {"stiffness_gradient:group=core,slope=%.9g", 0, 0.01, 0.1},
                 {"stiffness_profile:group=core,profile=%.9g", 0, 0.01, 0.1},
                 {"stiffness_local:depth=%.9g,z=0.609,width=0.03", 0, 0.01, 0.1},
                 {"joint:at=core.start,flexibility=%.9g", 0, 1e-11, 0.1},
                 {"support:at=tail,factor=%.9g", 1, 1, 0.1},
                 {"added_mass:mass=%.9g,z=0.3", 0, 0.5, 0.1},
                 {"added_mass:mass=%.9g,z=0.9,width=0.2", 0, 0.5, 0.1},
                 {"support_rotation:z=1.2,stiffness=%.9g", 0, 1e5, 0.1},
                 {"density:group=left,factor=%.9g", 1, 0.005, 0.1},
                 {"stiffness:group=right,factor=%.9g", 1, 0.005, 0.1},
                 {"tie_stiffness:at=ties,factor=%.9g", 1, 0.02, 0.1},
                 {"tie_tension:at=ties,factor=%.9g", 1, 0.1, 0.1},
                 {"shear_coefficient:group=right,factor=%.9g", 1, 0.01, 0.1},
                 {"accelerometer_mass:mass=%.9g,mount=moving", 0, 0.02, 0.1},
                 {"outside:kind=sine,group=core,waves=2,amplitude=%.9g", 0, 0.01, 0.2},
                 {"outside:kind=density_zone,z=1,width=0.1,factor=%.9g", 1, 0.01, 0.1}};
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        double change[3] = {0}, sum = 0;
        for (int size = 0; size < 3; size++) {
            char spec[200];
            snprintf(spec, sizeof spec, table[i].format, table[i].neutral + size * table[i].step);
            struct result r = make_with(paper, spec);
            for (int k = 0; k < MODES; k++)
                change[size] = fmax(change[size], fabs(hz(&r, "with", k) / hz(&r, "without", k) - 1));
            close_result(&r);
        }
        sum = change[1];
        assert_close(change[0], 0, 0, 1e-9);
        assert_true(sum > 1e-8);
        assert_close(change[2], 2 * sum, table[i].tolerance, 0);
    }
}

/* The deck with `old` replaced by `new` once; to be freed. */
static char *edited(const char *deck, const char *old, const char *new)
{
    const char *at = strstr(deck, old);
    assert_non_null(at);
    char *text = malloc(strlen(deck) + strlen(new) + 1);
    sprintf(text, "%.*s%s%s", (int)(at - deck), deck, new, at + strlen(old));
    return text;
}

/* An effect does what a deck with other cards says. */
UNIT_TEST(effects_are_what_other_cards_say)
{
    static const char core[] = "*SHAFT, NAME=core, MATERIAL=lamination\n0.924192, 0.334092, 0, 50\n";
    static const char tie[] = "FROM=core.start, TO=core.end, MODEL=TUBE, SELF_EQUILIBRATED=NO\n12, 0.032, 0.13364, 150e3, 1";
    /* a joint is a disc that bends with EI = length/flexibility, does not shear and weighs nothing, inside of the rods' ends */
    static const char disc[] = "*MATERIAL, NAME=disc\n*ELASTIC, TYPE=SHEAR\n1.63500e6, 1e16, 0.3\n*DENSITY\n1e-3\n";
    char before[600], behind[600];
    snprintf(before, sizeof before, "%s*SHAFT, NAME=soft, MATERIAL=disc\n1e-6, 0.334092, 0, 1\n%s", disc, core);
    snprintf(behind, sizeof behind, "%s%s*SHAFT, NAME=soft, MATERIAL=disc\n1e-6, 0.334092, 0, 1\n", disc, core);
    const struct {
        const char *spec, *old, *new, *old_tie, *new_tie;
        double tolerance;
    } table[] = {
        {"added_mass:mass=10,z=1.6,inertia=0.5", "*MODES", "*DISK\n1.6, 10, 0.5\n*MODES", "", "", 1e-10},
        {"support:at=sling,factor=3", "9790", "29370", "", "", 1e-10},
        {"clamp:at=sling,rotational=0,lateral=2e-5", "9790", "8186.98779", "", "", 1e-9}, /* k/(1 + c k) */
        {"support_extra:z=1,stiffness=1e7", "*MODES", "*SPRING\n1.0, 1e7\n*MODES", "", "", 1e-10},
        {"density:group=core,factor=0.94", "7380.66", "6937.8204", "", "", 1e-10},
        {"tie_tension:at=ties,factor=2", "", "", tie,
         "FROM=core.start, TO=core.end, MODEL=TUBE, SELF_EQUILIBRATED=NO\n12, 0.032, 0.13364, 300e3, 1", 1e-10},
        {"tie_shear:at=ties", "", "", tie, "FROM=core.start, TO=core.end, SELF_EQUILIBRATED=NO\n12, 0.032, 0.13364, 150e3",
         1e-10},
        {"joint:at=core.start,flexibility=1e-9", core, before, "FROM=core.start, TO=core.end", "FROM=soft.start, TO=core.end",
         2e-5},
        {"joint:at=core.end,flexibility=1e-9", core, behind, "FROM=core.start, TO=core.end", "FROM=core.start, TO=soft.end",
         2e-5},
        {"stiffness:group=left,factor=0.96", "MATERIAL=steel", "MATERIAL=soft", "*MATERIAL, NAME=lamination",
         "*MATERIAL, NAME=soft\n*ELASTIC\n2.016e11, 0.3\n*DENSITY\n7850\n*MATERIAL, NAME=lamination", 1e-10},
        {"stiffness_local:depth=0.5,z=1.0,width=0.2,shape=box", core,
         "*MATERIAL, NAME=half\n*ELASTIC, TYPE=SHEAR\n3e10, 1.5e10, 0.28\n*DENSITY\n7380.66\n"
         "*SHAFT, NAME=core, MATERIAL=lamination\n0.274178, 0.334092, 0, 50\n*SHAFT, NAME=zone, MATERIAL=half\n0.2, 0.334092, 0, "
         "50\n"
         "*SHAFT, NAME=rest, MATERIAL=twin\n0.450014, 0.334092, 0, 50\n",
         "*TIEROD, NAME=ties, MATERIAL=steel, FROM=core.start, TO=core.end",
         "*MATERIAL, NAME=twin\n*ELASTIC, TYPE=SHEAR\n6e10, 3e10, 0.28\n*DENSITY\n7380.66\n"
         "*TIEROD, NAME=ties, MATERIAL=steel, FROM=core.start, TO=rest.end",
         1e-10},
    };
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        char *once = edited(paper, table[i].old, table[i].new), *twice = edited(once, table[i].old_tie, table[i].new_tie);
        struct result hidden = make_with(paper, table[i].spec), stated = make_with(twice, NULL);
        for (int k = 0; k < MODES; k++)
            assert_close(hz(&hidden, "with", k), hz(&stated, "with", k), table[i].tolerance, 0);
        close_result(&hidden);
        close_result(&stated);
        free(once);
        free(twice);
    }
}

/* A pin in the bore of a shaft makes a solid one, and made stiff in shear, both stay the same beam. */
UNIT_TEST(a_layer_is_a_part_of_the_section)
{
    static const char solid_bar[] =
        "*MATERIAL, NAME=steel\n*ELASTIC\n2e11, 0.3\n*DENSITY\n7800\n*SHAFT, NAME=bar, MATERIAL=steel\n"
        "0.4, 0.1, 0, 9\n0.6, 0.12, 0, 9\n*SENSORS\n1, 0.3\n";
    char *tube = edited(solid_bar, "0.4, 0.1, 0, 9\n0.6, 0.12, 0, 9", "0.4, 0.1, 0.05, 9\n0.6, 0.12, 0.07, 9");
    char *lined = edited(tube, "*SENSORS", "*LAYER, NAME=pin, GROUP=bar, MATERIAL=steel\n0.05, 0\n0.07, 0\n*SENSORS");
    char *harder = edited(lined, "NAME=pin, GROUP=bar, MATERIAL=steel", "NAME=pin, GROUP=bar, MATERIAL=hard\n** of its own");
    char *hard = edited(harder, "*SHAFT", "*MATERIAL, NAME=hard\n*ELASTIC\n3e11, 0.3\n*DENSITY\n7800\n*SHAFT");
    const char *stiff[] = {"shear_coefficient:group=bar,factor=100", "shear_coefficient:group=pin,factor=100"};
    const char *factor = "stiffness:group=pin,factor=1.5", *cone = "step_stiffness:angle=45";
    struct hide_request r = hide_request_default();
    r.deck = solid_bar;
    r.effect = stiff;
    r.effects = 1;
    struct result bar = make(&r);
    r.deck = lined;
    r.effects = 2;
    struct result both = make(&r);
    r.effect = &factor;
    r.effects = 1;
    struct result factored = make(&r);
    r.deck = hard;
    r.effects = 0;
    struct result stated = make(&r);
    for (int k = 0; k < MODES; k++) {
        assert_close(hz(&both, "with", k), hz(&bar, "with", k), 3e-3, 0); /* a hundredth of what shear lowers mode 6 by */
        assert_close(hz(&both, "without", k), hz(&bar, "without", k), 1e-7, 0);
        assert_close(hz(&factored, "with", k), hz(&stated, "without", k), 1e-10, 0);
    }
    char *deck, *truth, message[300];
    r.effect = &cone;
    r.effects = 1;
    assert_int_equal(hide_case(&r, &deck, &truth, message, sizeof message), HIDE_INPUT);
    assert_non_null(strstr(message, "expected a deck without *LAYER"));
    close_result(&bar);
    close_result(&both);
    close_result(&factored);
    close_result(&stated);
    free(tube);
    free(lined);
    free(harder);
    free(hard);
}

/* input/solid_steel_stiff.inp has cones of 30 degrees as stairs of four: within 1e-3, of an effect of up to 6 %. */
UNIT_TEST(cones_are_those_of_the_deck_with_stairs)
{
    char *steel = read_deck("solid_steel.inp"), *stairs = read_deck("solid_steel_stiff.inp");
    const char *cone = "step_stiffness:angle=30";
    struct hide_request r = hide_request_default();
    r.sensors = SENSORS;
    r.deck = stairs;
    struct result stated = make(&r);
    r.deck = steel;
    r.effect = &cone;
    r.effects = 1;
    struct result hidden = make(&r);
    for (int k = 0; k < MODES; k++) {
        assert_close(hz(&hidden, "with", k), hz(&stated, "with", k), 1e-3, 0);
        assert_true(hz(&hidden, "with", k) < 0.98 * hz(&hidden, "without", k));
    }
    close_result(&stated);
    close_result(&hidden);
    free(steel);
    free(stairs);
}

/* Cutting finer changes what cannot be seen. */
UNIT_TEST(varying_stiffness_is_converged)
{
    static const char *const table[] = {"step_stiffness:angle=30", "stiffness_local:depth=0.9,z=0.62,width=0.06",
                                        "stiffness_gradient:group=core,slope=0.6", "stiffness_profile:group=core,profile=-0.8",
                                        "outside:kind=sine,group=core,amplitude=0.5,waves=3"};
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        struct hide_request r = clean(solid);
        r.effect = &table[i];
        r.effects = 1;
        struct result usual = make(&r);
        r.refine = 8;
        struct result fine = make(&r);
        for (int k = 0; k < MODES; k++)
            assert_close(hz(&usual, "with", k), hz(&fine, "with", k), 1e-5, 0);
        close_result(&usual);
        close_result(&fine);
    }
}

/* ---- noise ---- */

UNIT_TEST(noise_is_as_stated)
{
    struct hide_request r = clean(solid);
    enum { sensors = 1000, modes = 10, seeds = 300 };
    double *shape = malloc(2 * modes * sensors * sizeof *shape), *without = shape + modes * sensors, sum = 0, lag = 0,
           squares = 0;
    r.sensors = sensors;
    r.modes = modes;
    struct result bare = make(&r);
    assert_int_equal(deck_shapes(bare.deck, without), modes * sensors);
    r.shape_noise = 0.02;
    r.correlation = 0.6;
    r.stated_shape_noise = 0.01;
    struct result noisy = make(&r);
    assert_int_equal(deck_shapes(noisy.deck, shape), modes * sensors);
    for (int i = 0; i < modes * sensors; i++) {
        shape[i] = (shape[i] - without[i]) / 0.02;
        sum += shape[i];
        squares += shape[i] * shape[i];
        lag += i % sensors ? shape[i] * shape[i - 1] : 0;
    }
    assert_close(sum / (modes * sensors), 0, 0, 0.08); /* four standard deviations with this correlation */
    assert_close(sqrt(squares / (modes * sensors)), 1, 0.05, 0);
    assert_close(lag / squares, 0.6, 0.05, 0);
    assert_non_null(strstr(noisy.deck, "*NOISE, SHAPE=0.01\n"));
    free(shape);
    close_result(&noisy);
    close_result(&bare);
    squares = 0;
    r = clean(solid);
    r.frequency_noise = 0.002;
    for (uint64_t seed = 1; seed <= seeds; seed++) {
        double frequency[MODES];
        r.seed = seed;
        r.no_shapes = 1;
        struct result one = make(&r);
        assert_int_equal(deck_hz(one.deck, frequency), MODES);
        for (int k = 0; k < MODES; k++)
            squares += pow((frequency[k] / hz(&one, "with", k) - 1) / 0.002, 2);
        close_result(&one);
    }
    assert_close(sqrt(squares / (seeds * MODES)), 1, 0.05, 0);
}

UNIT_TEST(a_seed_is_a_case)
{
    struct hide_request r = hide_request_default();
    const char *mass = "added_mass:mass=1e-9,z=1";
    double shape[2][MODES * SENSORS];
    r.deck = paper;
    struct result first = make(&r), second = make(&r);
    assert_string_equal(first.deck, second.deck);
    assert_string_equal(first.truth, second.truth);
    close_result(&second);
    r.effect = &mass; /* leaves noise and parameters of the seed as they were */
    r.effects = 1;
    second = make(&r);
    deck_shapes(first.deck, shape[0]);
    deck_shapes(second.deck, shape[1]);
    for (int i = 0; i < MODES * SENSORS; i++)
        assert_close(shape[1][i], shape[0][i], 0, 1e-6);
    close_result(&second);
    r.seed++;
    second = make(&r);
    assert_string_not_equal(first.deck, second.deck);
    deck_shapes(second.deck, shape[1]);
    assert_true(fabs(shape[1][20] - shape[0][20]) > 1e-4);
    close_result(&first);
    close_result(&second);
}

/* ---- faults of the data ---- */

UNIT_TEST(faults_are_where_they_are_said_to_be)
{
    static const char *const table[] = {"sensor_gain:sensor=23,gain=1.4",   "sensor_sign:sensor=5",
                                        "sensor_swap:sensors=12+13",        "duplicate_channel:sensor=7,of=6",
                                        "noise_level:block=SHAPE,factor=2", "mode_pairing:swap=2+3"};
    static double right[MODES][SENSORS], wrong[MODES][SENSORS], expected[MODES][SENSORS], truth[MODES][SENSORS];
    struct hide_request r = hide_request_default();
    r.deck = paper;
    struct result bare = make(&r);
    deck_shapes(bare.deck, right[0]);
    for (int i = 0; i < MODES * SENSORS; i++)
        truth[i / SENSORS][i % SENSORS] =
            cJSON_GetArrayItem(cJSON_GetArrayItem(of(&bare, "with", "shape"), i / SENSORS), i % SENSORS)->valuedouble;
    close_result(&bare);
    r.effects = 1;
    for (int fault = 0; fault < 6; fault++) {
        r.effect = &table[fault];
        struct result one = make(&r);
        assert_int_equal(deck_shapes(one.deck, wrong[0]), MODES * SENSORS);
        for (int i = 0; i < MODES * SENSORS; i++) { /* the id of a sensor of this deck is its index + 1 */
            int k = i / SENSORS, s = i % SENSORS, other = k == 1 ? 2 : k == 2 ? 1 : k;
            double *e = &expected[k][s];
            *e = right[k][s];
            if (fault == 0 && s == 22)
                *e *= 1.4;
            if (fault == 1 && s == 4)
                *e = -*e;
            if (fault == 2 && (s == 11 || s == 12))
                *e = right[k][23 - s];
            if (fault == 3 && s == 6)
                *e = right[k][5];
            if (fault == 4)
                *e += right[k][s] - truth[k][s];
            if (fault == 5)
                *e = right[other][s];
            assert_close(wrong[k][s], *e, 0, 1e-6);
        }
        close_result(&one);
    }
}

UNIT_TEST(sensors_and_modes_change_as_asked)
{
    double all[MODES], some[MODES + 1], shape[MODES * SENSORS];
    struct result bare = make_with(paper, NULL), missing = make_with(paper, "mode_pairing:missing=3"),
                  twice = make_with(paper, "mode_pairing:double=3,split=0.01"),
                  moved = make_with(paper, "sensor_position:sensor=30,shift=0.037"); /* to where sensor 31 sits, nearly */
    deck_hz(bare.deck, all);
    assert_int_equal(deck_hz(missing.deck, some), MODES - 1);
    for (int k = 0; k < MODES - 1; k++)
        assert_close(some[k], all[k < 2 ? k : k + 1], 1e-9, 0);
    assert_int_equal(deck_hz(twice.deck, some), MODES + 1);
    for (int k = 0; k < MODES + 1; k++)
        assert_close(some[k], k == 3 ? 1.01 * all[2] : all[k < 3 ? k : k - 1], 1e-9, 0);
    deck_shapes(moved.deck, shape);
    for (int k = 0; k < MODES; k++)
        assert_close(shape[k * SENSORS + 29], shape[k * SENSORS + 30], 0, 1e-3);
    assert_non_null(strstr(moved.deck, "30, 0.810660")); /* as if it were where it should be */
    close_result(&bare);
    close_result(&missing);
    close_result(&twice);
    close_result(&moved);
    struct hide_request r = clean(paper);
    r.half_sensors = 1;
    struct result half = make(&r);
    assert_int_equal(deck_shapes(half.deck, shape), MODES * SENSORS / 2);
    assert_null(strstr(half.deck, "\n30, ")); /* even ids are gone from *SENSORS, too */
    r.no_shapes = 1;
    struct result none = make(&r);
    assert_int_equal(deck_shapes(none.deck, shape), 0);
    close_result(&half);
    close_result(&none);
}

/* ---- draws, threads, messages ---- */

static void *draw(void *seed)
{
    struct hide_request r = hide_request_default();
    struct result *result = malloc(sizeof *result);
    char message[300];
    r.deck = paper;
    r.random = "any";
    r.seed = *(uint64_t *)seed;
    if (hide_case(&r, &result->deck, &result->truth, message, sizeof message))
        fprintf(stderr, "seed %d: %s\n", (int)r.seed, message);
    return result;
}

/* Cases made beside each other are the cases made alone; what was drawn can be typed; the deck does not say it. */
UNIT_TEST(draws)
{
    enum { together = 4 };
    int effects = 0;
    for (uint64_t first = 1; first <= 60; first += together) {
        pthread_t thread[together];
        uint64_t seed[together];
        for (int i = 0; i < together; i++) {
            seed[i] = first + (uint64_t)i;
            assert_int_equal(pthread_create(&thread[i], NULL, draw, &seed[i]), 0);
        }
        for (int i = 0; i < together; i++) {
            void *joined;
            const char *spec[2];
            assert_int_equal(pthread_join(thread[i], &joined), 0);
            struct result *one = joined;
            struct hide_request r = hide_request_default();
            assert_non_null(one->deck);
            one->json = cJSON_Parse(one->truth);
            const cJSON *list = cJSON_GetObjectItem(one->json, "effects");
            r.deck = paper;
            r.seed = seed[i];
            r.effects = cJSON_GetArraySize(list);
            r.effect = spec;
            for (int e = 0; e < r.effects; e++) {
                spec[e] = cJSON_GetObjectItem(cJSON_GetArrayItem(list, e), "spec")->valuestring;
                assert_null(strstr(one->deck, cJSON_GetObjectItem(cJSON_GetArrayItem(list, e), "id")->valuestring));
            }
            struct result again = make(&r);
            assert_string_equal(again.deck, one->deck);
            effects += r.effects;
            close_result(&again);
            close_result(one);
            free(one);
        }
    }
    assert_in_range(effects, 30, 90);
}

UNIT_TEST(messages_say_what_was_expected)
{
    static const struct {
        const char *spec, *text;
    } table[] = {{"stiffnes:group=left", "expected one of --list"},
                 {"stiffness:group=middle,factor=0.9", "expected the name of a group"},
                 {"stiffness:group=core,factor=0.9", "no modulus is identified"},
                 {"stiffness:group=left", "factor: expected it to be given"},
                 {"stiffness:group=left,factor=soft", "expected a number from 0.01 to 100"},
                 {"stiffness:group=left,size=2", "expected a key that --list names"},
                 {"added_mass:mass=1,z=2.5", "expected a position inside the rotor, 0 to 2.03"},
                 {"joint:at=right.end,flexibility=1e-9", "between two groups"},
                 {"support:at=bearing,factor=2", "expected the name of a spring"},
                 {"sensor_gain:sensor=99,gain=2", "expected the id of a sensor"},
                 {"sensor_position:sensor=1,shift=-0.1", "leaves the sensor on the rotor"},
                 {"sensor_line:scale=1.1", "leaves all sensors on the rotor"},
                 {"mode_pairing:swap=2+9", "expected two measured modes"},
                 {"mode_pairing", "one of swap=, double=, missing="},
                 {"outside:kind=nothing", "expected one of --list"},
                 {"stiffness_local:depth=0.5,z=1,width=0.1,shape=cone", "expected gaussian|box"}};
    char *deck = (char *)1, *truth, message[300];
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        struct hide_request r = clean(paper);
        r.effect = &table[i].spec;
        r.effects = 1;
        assert_int_equal(hide_case(&r, &deck, &truth, message, sizeof message), HIDE_INPUT);
        assert_null(deck);
        if (!strstr(message, table[i].text))
            fail_msg("%s: expected %s", message, table[i].text);
    }
    char *bars = edited(paper, "*MODES", "*BARS, NAME=b\n*MODES");
    struct hide_request r = clean(bars);
    assert_int_equal(hide_case(&r, &deck, &truth, message, sizeof message), HIDE_INPUT);
    assert_non_null(strstr(message, "*BARS: expected a deck without"));
    r = clean(solid);
    r.sensors = 0;
    assert_int_equal(hide_case(&r, &deck, &truth, message, sizeof message), HIDE_INPUT);
    assert_non_null(strstr(message, "expected --sensors N"));
    free(bars);
}

/* The core by E, G and nu alone: tools/hide makes beams. */
static void state_as_shear(char *text)
{
    static const char sheets[] = "TYPE=LAMINATED\n1.05e11, 0.47e11, 1.9e11, 0.28 ",
                      shear[] = "TYPE=SHEAR    \n1.05e11, 0.47e11, 0.28 **      ";
    char *at = strstr(text, sheets);
    assert_non_null(at);
    memcpy(at, shear, sizeof shear - 1);
}

static int open_decks(void **state)
{
    (void)state;
    paper = read_deck("paper_rotor.inp");
    solid = read_deck("solid_rotor.inp");
    state_as_shear(solid);
    return 0;
}

static int close_decks(void **state)
{
    (void)state;
    free(paper);
    free(solid);
    return 0;
}

TEST_GROUP(open_decks, close_decks);
