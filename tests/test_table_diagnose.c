/* The report of a diagnosis, on the screen and as JSON, from structs filled by hand: what it has to say, where there is nothing
 * to say, that lines stay short, that JSON is whole or not there. */
#include "support.h"

#include <cJSON.h>

#include "api/api.h"
#include "report/report.h"
#include "result/result.h"

#define MODES   6
#define SENSORS 34
#define LOCAL   80
#define LENGTH  2.03

static char screen[1 << 16];

/* ------------------------------------------------------------------------------------------------ a case filled by hand */

static const struct effect_kind joint_effect = {.id = "joint", .nparameter = 1, .parameter = {{"flexibility", "rad/(N.m)"}}},
                                soft_effect = {.id = "stiffness_local",
                                               .nparameter = 3,
                                               .parameter = {{"depth", "1"}, {"z", "m"}, {"width", "m"}}},
                                mass_effect = {.id = "added_mass", .nparameter = 2, .parameter = {{"mass", "kg"}, {"z", "m"}}},
                                stiffness_effect = {.id = "stiffness", .nparameter = 1, .parameter = {{"factor", "1"}}};

static const struct cause_kind
    joint =
        {.id = "joint", .class = CAUSE_PHYSICAL, .target = TARGET_INTERFACE, .effect = &joint_effect, .place = -1, .width = -1},
    soft = {.id = "stiffness_local",
            .class = CAUSE_PHYSICAL,
            .target = TARGET_NONE,
            .effect = &soft_effect,
            .place = 1,
            .width = 2,
            .variant = {"GAUSS", "BOX"},
            .variant_option = "SHAPE"},
    added = {.id = "added_mass", .class = CAUSE_PHYSICAL, .target = TARGET_NONE, .effect = &mass_effect, .place = 1, .width = -1},
    stiffness = {.id = "stiffness",
                 .class = CAUSE_PHYSICAL,
                 .target = TARGET_GROUP,
                 .effect = &stiffness_effect,
                 .place = -1,
                 .width = -1};

struct fit_store {
    rotid_fit_result fit;
    double x[3], std[3], lower[3], upper[3], correlation[9], direction[9], predicted[MODES], mac[MODES], residual[MODES];
    int at_bound[3], identifiable[3], undetermined[3], number[MODES];
    enum pairing_basis basis[MODES];
    double nco[MODES], reduction[MODES], mesh[MODES];
    struct identification result;
};

static struct store {
    struct diagnosis d;
    struct job deck;
    struct group group[3];
    struct segment segment[3];
    struct sensor sensor[SENSORS];
    rotid_parameter bounds[3];
    double hz[MODES], mode_z[MODES], error[MODES];
    rotid_sensor_residual sensor_rms[SENSORS];
    rotid_localisation local[LOCAL];
    int number[MODES], holdout[MODES], mode[MODES], faulty;
    struct fit_store today, base, extended;
    rotid_data_finding data;
    rotid_numerical_finding numerical;
    struct candidate candidate[4];
    struct diagnosis_round round[2];
    rotid_detectable detectable[5];
    rotid_step step[2];
} s;

static const double measured_hz[MODES] = {435.55, 735.16, 1159.4, 1802, 2425.8, 2918.4};

static void fill_fit(struct fit_store *f, int n, double e, double g, double error_percent)
{
    static const double x[3] = {1.146e11, 3.52e10, 2.13e-10};
    for (int p = 0; p < n; p++) {
        f->x[p] = x[p] * (p == 0 ? 1 + e : p == 1 ? 1 + g : 1);
        f->std[p] = 0.01 * f->x[p];
        f->lower[p] = 0.98 * f->x[p];
        f->upper[p] = 1.02 * f->x[p];
        f->identifiable[p] = 1;
        for (int q = 0; q < n; q++)
            f->correlation[p + q * n] = p == q ? 1 : 0.3;
    }
    for (int k = 0; k < MODES; k++) {
        f->predicted[k] = measured_hz[k] * (1 + 0.01 * error_percent * (k % 2 ? 1 : -0.6));
        f->mac[k] = 0.99;
        f->nco[k] = 0.995 - 0.002 * k;
        f->number[k] = k + 1;
        f->basis[k] = PAIRED_BY_SHAPE;
        f->reduction[k] = 0.02 * (k + 1) * (k + 1);
        f->mesh[k] = 1e-3;
    }
    f->fit = (rotid_fit_result){.status = ROTID_STOP_STEP,
                                .converged = 1,
                                .n = n,
                                .m = MODES,
                                .evaluations = 5,
                                .jacobians = 4,
                                .nresidual = 210,
                                .dof = 202,
                                .objective = 150,
                                .chi2 = 300,
                                .chi2_per_dof = 1.485,
                                .widened_by = 1,
                                .condition_number = 12,
                                .x = f->x,
                                .std = f->std,
                                .ci_lower = f->lower,
                                .ci_upper = f->upper,
                                .at_bound = f->at_bound,
                                .identifiable = f->identifiable,
                                .correlation = f->correlation,
                                .direction = f->direction,
                                .direction_undetermined = f->undetermined,
                                .predicted_hz = f->predicted,
                                .mac = f->mac,
                                .residual = f->residual};
    f->result = (struct identification){
        .fit = &f->fit,
        .compared = {.nmode = MODES, .number = f->number, .basis = f->basis, .mac = f->mac, .nco = f->nco},
        .spectrum = {.count = MODES, .reduction_error_percent = f->reduction, .mesh_error_percent = f->mesh},
        .mass = {.mass = 998, .center = 1.06}};
}

static void fill_candidate(struct candidate *c, const struct cause_kind *cause, const char *target, int index, double a, double b,
                           double width, double drop)
{
    *c = (struct candidate){.cause = cause,
                            .effect = {.name = "found", .kind = cause->effect, .target = index, .value = {a, b, width}},
                            .target = target,
                            .nparameter = cause->effect->nparameter,
                            .result.round = 1,
                            .result.predicted_drop = 1.05 * drop,
                            .result.refitted = 1,
                            .result.chi2 = 300 - drop,
                            .result.chi2_drop = drop,
                            .result.holdout_rms = NAN,
                            .result.sensor_out_rms = 1.03,
                            .result.probability = drop / 100};
    for (int p = 0; p < c->nparameter; p++) {
        c->std[p] = 0.05 * c->effect.value[p];
        c->ci_lower[p] = 0.9 * c->effect.value[p];
        c->ci_upper[p] = 1.1 * c->effect.value[p];
    }
}

/* A joint between core and right, found and named; a sensor with a wrong gain; a fit condensed by Guyan. */
static void fill_named(void)
{
    static const char *const heading[] = {"A rotor of three groups, with a joint that the model does not have"};
    static const char *const names[] = {"left", "core", "right"}, *const parameters[] = {"core.E", "core.G", "found.flexibility"};
    static const double ends[] = {0, 0.70, 1.40, LENGTH};
    memset(&s, 0, sizeof s);
    for (int g = 0; g < 3; g++) {
        s.group[g] = (struct group){.layer_of = -1, .name = names[g]};
        s.segment[g] = (struct segment){.group = g, .elements = 20, .length = ends[g + 1] - ends[g], .outer = 0.2};
        s.bounds[g] = (rotid_parameter){parameters[g], g < 2 ? "Pa" : "rad/(N.m)", 1e-12, 1e12, 1};
    }
    for (int i = 0; i < SENSORS; i++) {
        s.sensor[i] = (struct sensor){i + 1, LENGTH * i / (SENSORS - 1)};
        double z = LENGTH * i / (SENSORS - 1);
        s.sensor_rms[i] = (rotid_sensor_residual){.id = i + 1, .z_m = z, .rms = 1 + 3 * exp(-pow((z - 1.4) / 0.15, 2))};
    }
    for (int i = 0; i < LOCAL; i++) {
        double z = LENGTH * i / (LOCAL - 1);
        s.local[i] = (rotid_localisation){z, exp(-pow((z - 1.4) / 0.12, 2))};
    }
    for (int k = 0; k < MODES; k++) {
        s.hz[k] = measured_hz[k];
        s.number[k] = s.mode[k] = k + 1;
        s.mode_z[k] = (k % 2 ? 2.2 : -4.1) * (k + 1) / 3;
        s.error[k] = 0.02 * (k + 1) * (k + 1);
    }
    fill_fit(&s.today, 2, 0.028, -0.096, 3);
    fill_fit(&s.base, 2, 0.019, -0.011, 0.4);
    fill_fit(&s.extended, 3, 0, 0, 0.05);
    const char **lines = (const char **)heading;
    s.deck = (struct job){
        .deck = "rotor.inp",
        .nheading = 1,
        .heading = lines,
        .rotor = {.ngroup = 3, .nsegment = 3, .nsensor = SENSORS, .group = s.group, .segment = s.segment, .sensor = s.sensor},
        .measurement.nmode = MODES,
        .measurement.number = s.number,
        .measurement.frequency_hz = s.hz,
        .measurement.holdout = s.holdout,
        .unknowns.nparameter = 2,
        .unknowns.bounds = s.bounds,
        .options.fit = {.size = sizeof(rotid_fit_options), .functional = ROTID_HYBRID, .reduction = ROTID_GUYAN}};
    s.faulty = 23;
    s.data =
        (rotid_data_finding){.id = "sensor_gain",
                             .nsensors = 1,
                             .sensors = &s.faulty,
                             .unit = "1",
                             .value = 1.4,
                             .std = 0.03,
                             .chi2_drop = 180,
                             .text = "sensor 23 reads 1.40 times what its neighbours say; its readings were divided by that"};
    s.numerical = (rotid_numerical_finding){
        .id = "guyan_reduction",
        .nmodes = MODES,
        .modes = s.mode,
        .error_percent = s.error,
        .text = "the condensation to the sensors exceeds the noise in modes 4 to 6; the full model is used"};
    fill_candidate(&s.candidate[0], &joint, "core|right", 1, 2.13e-10, 0, 0, 98);
    fill_candidate(&s.candidate[1], &soft, "", -1, 0.42, 1.38, 0.06, 67);
    fill_candidate(&s.candidate[2], &stiffness, "right", 2, 0.93, 0, 0, 41);
    fill_candidate(&s.candidate[3], &added, "", -1, 3.4, 1.9, 0, 20);
    s.candidate[3].result.refitted = 0;
    rotid_candidate *untried = &s.candidate[3].result;
    untried->chi2 = untried->chi2_frequency = untried->chi2_drop = untried->sensor_out_rms = NAN;
    untried->probability = 0;
    s.round[0] = (struct diagnosis_round){.result.round = 1,
                                          .ncandidate = 4,
                                          .candidate = s.candidate,
                                          .result.chi2 = 300,
                                          .result.chi2_frequency = 95,
                                          .result.dof = 202,
                                          .result.frequencies = MODES,
                                          .result.largest = 103,
                                          .result.p_frequency = 0.0003,
                                          .result.p_total = 1e-6};
    s.round[1] = (struct diagnosis_round){.result.round = 2,
                                          .result.chi2 = 202,
                                          .result.chi2_frequency = 5,
                                          .result.dof = 201,
                                          .result.frequencies = MODES,
                                          .result.largest = 4.1,
                                          .result.p_frequency = 0.52,
                                          .result.p_total = 0.44};
    s.detectable[0] = (rotid_detectable){"joint", "left|core", "flexibility", 7.1e-11, "rad/(N.m)", NAN, NAN, 0};
    s.detectable[1] = (rotid_detectable){"joint", "core|right", "flexibility", 6.4e-11, "rad/(N.m)", NAN, NAN, 0};
    s.detectable[2] = (rotid_detectable){"added_mass", "", "mass", 0.11, "kg", 2.03, 9.6, 0};
    s.detectable[3] = (rotid_detectable){"stiffness", "left", "factor", 0.021, "1", NAN, NAN, 0};
    s.detectable[4] = (rotid_detectable){"stiffness", "right", "factor", NAN, "1", NAN, NAN, 1};
    s.step[0] = (rotid_step){"base fit", 0.04};
    s.step[1] = (rotid_step){"refits", 1.3};
    s.d = (struct diagnosis){
        .result = {.verdict = {.kind = ROTID_NAMED,
                               .adequate_after = 1,
                               .p_value = 1e-6,
                               .sentence = "A joint between core and right is softer than continuous material: flexibility "
                                           "2.13e-10 rad/(N.m); every rival leaves more of the misfit."},
                   .ndata_findings = 1,
                   .data_findings = &s.data,
                   .nnumerical_findings = 1,
                   .numerical_findings = &s.numerical,
                   .gain = {{0.41, 0.05},
                            {0.83, 0.08},
                            {0.021, 0.015},
                            {1.485, 1.005},
                            {0.985, 0.995},
                            {NAN, NAN},
                            {NAN, NAN},
                            {0.62, 0.07},
                            {0.024, 0.016},
                            {0.025, 0.015}},
                   .nmodes_standardised = MODES,
                   .modes_standardised = s.mode_z,
                   .nsensors = SENSORS,
                   .sensors = s.sensor_rms,
                   .nlocalisation = LOCAL,
                   .localisation = s.local,
                   .ndetectable = 5,
                   .detectable = s.detectable,
                   .noise = {.frequency = 0.001, .shape = 0.015},
                   .nsteps = 2,
                   .steps = s.step},
        .job = s.deck,
        .today = s.today.result,
        .base = s.base.result,
        .nround = 2,
        .round = s.round,
        .ncause = 1,
        .cause = s.candidate,
        .extended_job = s.deck,
        .extended = s.extended.result,
    };
    s.d.job.options.fit = (rotid_fit_options){.size = sizeof(rotid_fit_options), .functional = ROTID_LIKELIHOOD};
    s.d.extended_job.options.fit = s.d.job.options.fit;
    s.d.extended_job.unknowns.nparameter = 3;
}

static const rotid_pair unknown = {NAN, NAN};

static rotid_pair *pair(int i)
{
    rotid_gain *g = &s.d.result.gain;
    rotid_pair *const pairs[] = {&g->frequency_rms_percent,
                                 &g->frequency_max_percent,
                                 &g->shape_rms,
                                 &g->chi2_per_dof,
                                 &g->nco_min,
                                 &g->holdout_frequency_rms_percent,
                                 &g->holdout_shape_rms,
                                 &g->mode_out_frequency_rms_percent,
                                 &g->mode_out_shape_rms,
                                 &g->sensor_out_shape_rms};
    return i < (int)(sizeof pairs / sizeof *pairs) ? pairs[i] : NULL;
}

static void without_extended(void)
{
    s.d.extended = (struct identification){0};
    s.d.extended_job = s.d.job;
    for (int i = 0; pair(i); i++)
        pair(i)->after = NAN;
}

static void fill_adequate(void)
{
    fill_named();
    s.d.result.verdict.kind = ROTID_ADEQUATE;
    s.d.result.verdict.sentence = "The model is adequate for these data.";
    s.d.result.verdict.p_value = 0.37;
    s.d.ncause = s.d.result.ndata_findings = s.d.result.nnumerical_findings = 0;
    s.d.today = (struct identification){0};
    without_extended();
    s.d.nround = 1;
    s.round[0] = s.round[1];
    s.round[0].result.round = 1;
}

static void fill_ambiguous(void)
{
    fill_named();
    s.d.result.verdict.kind = ROTID_AMBIGUOUS;
    s.d.result.verdict.sentence = "Two causes explain the misfit equally well.";
    s.d.result.verdict.next_measurement =
        "measure the shapes at 1.30, 1.40 and 1.50 m with a roving sensor, or strike the rotor after the joint "
        "has been tightened: the frequency of mode 4 separates the two by five times its noise";
    s.d.ncause = 0;
    s.d.nalternative = 2;
    s.d.alternative = s.candidate;
    s.d.nround = 1;
    s.d.result.verdict.adequate_after = 0;
    without_extended();
}

static void fill_unexplained(void)
{
    fill_ambiguous();
    s.d.result.verdict.kind = ROTID_UNEXPLAINED;
    s.d.result.verdict.sentence = "The misfit is real and nothing in the catalogue earns its parameters; it acts at z = 1.4 m.";
    s.d.result.verdict.next_measurement = NULL;
    s.d.nalternative = 0;
}

static void without_shapes(void)
{
    fill_named();
    s.d.result.nsensors = 0;
    s.deck.rotor.nsensor = s.d.job.rotor.nsensor = s.d.extended_job.rotor.nsensor = 0;
    s.d.result.nlocalisation = 0;
    rotid_gain *g = &s.d.result.gain;
    g->shape_rms = g->nco_min = g->mode_out_shape_rms = g->sensor_out_shape_rms = unknown;
    s.d.result.noise.shape = NAN;
    s.d.result.noise.frequency_assumed = 1;
    for (int k = 0; k < MODES; k++)
        s.base.mac[k] = s.base.nco[k] = s.today.mac[k] = s.today.nco[k] = NAN;
}

static void nothing_to_identify(void)
{
    fill_adequate();
    s.d.base.fit->n = 0;
    s.d.job.unknowns.nparameter = s.deck.unknowns.nparameter = 0;
    s.d.base.fit->correlation = s.d.base.fit->x = NULL;
}

static void everything_nan(void)
{
    static const double none[MODES] = {NAN, NAN, NAN, NAN, NAN, NAN};
    fill_named();
    struct fit_store *fits[] = {&s.today, &s.base, &s.extended};
    for (int i = 0; i < 3; i++) {
        rotid_fit_result *fit = &fits[i]->fit;
        fit->chi2 = fit->chi2_per_dof = fit->objective = fit->gradient = fit->condition_number = fit->widened_by = NAN;
        for (int p = 0; p < fit->n; p++)
            fit->ci_lower[p] = fit->ci_upper[p] = fit->std[p] = NAN;
        memcpy(fits[i]->predicted, none, sizeof none);
        memcpy(fits[i]->mac, none, sizeof none);
        memcpy(fits[i]->nco, none, sizeof none);
        memcpy(fits[i]->reduction, none, sizeof none);
    }
    for (int k = 0; k < MODES; k++)
        s.mode_z[k] = s.error[k] = NAN;
    for (int i = 0; i < SENSORS; i++)
        s.sensor_rms[i].rms = NAN;
    for (int i = 0; i < LOCAL; i++)
        s.local[i].indicator = NAN;
    for (int i = 0; i < 4; i++) {
        struct candidate *c = &s.candidate[i];
        c->result.predicted_drop = c->result.chi2 = c->result.chi2_frequency = c->result.chi2_drop = c->result.sensor_out_rms =
            NAN;
        for (int p = 0; p < EFFECT_MOST_PARAMETERS; p++)
            c->effect.value[p] = c->std[p] = c->ci_lower[p] = c->ci_upper[p] = NAN;
    }
    for (int i = 0; i < 2; i++)
        s.round[i].result.chi2 = s.round[i].result.chi2_frequency = s.round[i].result.largest = s.round[i].result.p_frequency =
            s.round[i].result.p_total = NAN;
    for (int i = 0; i < 5; i++)
        s.detectable[i].smallest = s.detectable[i].z_m = s.detectable[i].worst = NAN;
    s.data.value = s.data.std = s.data.chi2_drop = s.d.result.verdict.p_value = s.d.result.noise.frequency =
        s.d.result.noise.shape = NAN;
    for (int i = 0; pair(i); i++)
        *pair(i) = unknown;
}

/* Stopped before the base fit: next to nothing is there. */
static void interrupted_at_once(void)
{
    fill_named();
    s.d = (struct diagnosis){
        .result = {.interrupted = 1, .verdict = {.kind = -1, .p_value = NAN}, .noise = {.frequency = NAN, .shape = NAN}}};
    for (int i = 0; pair(i); i++)
        *pair(i) = unknown;
}

static void (*const fills[])(void) = {fill_named,     fill_adequate,       fill_ambiguous, fill_unexplained,
                                      without_shapes, nothing_to_identify, everything_nan, interrupted_at_once};

#define CASES (sizeof fills / sizeof *fills)

/* The result that the library makes of it. */
static struct pool *open_result(struct result *result)
{
    struct pool *memory = pool_new(NULL);
    static struct diagnosis d;
    static struct state deck, judged, extended;
    const struct states states = states_of(&s.deck, &deck);
    d = s.d;
    if (d.job.deck)
        d.judged = states_of(&d.job, &judged);
    if (d.extended_job.deck)
        d.extended_states = states_of(&d.extended_job, &extended);
    assert_non_null(memory);
    *result = (struct result){.head = {.schema = RESULT_SCHEMA,
                                       .rotid = "0.1.0",
                                       .commit = "0123456789ab",
                                       .blas = "a BLAS",
                                       .seed = 7,
                                       .threads = 4,
                                       .command = "diagnose",
                                       .deck = s.deck.deck,
                                       .nheading = s.deck.nheading,
                                       .heading = s.deck.heading},
                              .diagnose = result_diagnosis(memory, &states, &d)};
    assert_non_null(result->diagnose);
    return memory;
}

static char *json_text_of(void)
{
    struct result result;
    struct pool *memory = open_result(&result);
    char *text = result_json(&result);
    pool_free(memory);
    return text;
}

/* ------------------------------------------------------------------------------------------------ the screen */

static void show(int verbose, int width)
{
    FILE *out = tmpfile();
    assert_non_null(out);
    struct result result;
    struct pool *memory = open_result(&result);
    screen_result(&(struct screen){out, memory, verbose, width}, &result, screen_diagnose);
    pool_free(memory);
    rewind(out);
    size_t length = fread(screen, 1, sizeof screen - 1, out);
    screen[length] = 0;
    assert_int_equal(fclose(out), 0);
}

static void assert_says(const char *part)
{
    if (!strstr(screen, part))
        print_error("'%s' is not in the report\n", part);
    assert_non_null(strstr(screen, part));
}

static void assert_silent(const char *part)
{
    if (strstr(screen, part))
        print_error("'%s' is in the report\n", part);
    assert_null(strstr(screen, part));
}

/* Whether `first` stands before `second`. */
static void assert_order(const char *first, const char *second)
{
    assert_says(first);
    assert_says(second);
    assert_true(strstr(screen, first) < strstr(screen, second));
}

UNIT_TEST(a_named_cause_is_read_from_top_to_bottom)
{
    static const char *const parts[] = {"A rotor of three groups",
                                        "VERDICT  NAMED",
                                        "The fit as the deck states it (HYBRID, reduction GUYAN",
                                        "Parameters, 95 % intervals",
                                        "What is wrong with the measurement and the numbers",
                                        "sensor_gain: sensor 23",
                                        "guyan_reduction: the condensation",
                                        "What is wrong: full model, likelihood, chi2 300 with 202 degrees of freedom",
                                        "Causes one by one",
                                        "Quality before and after",
                                        "Detection limits",
                                        "seed 7, 4 threads"};
    fill_named();
    show(0, 100);
    for (size_t i = 1; i < sizeof parts / sizeof *parts; i++)
        assert_order(parts[i - 1], parts[i]);
    assert_says("core.E = 117.8 GPa, +2.8 %; core.G = 31.82 GPa, -9.6 % against the extended model here");
    assert_says("    that; 1.4 +- 0.030; chi2 less by 180.0. At the test: check the sensitivity");
    assert_says("error [%]: mode 1 +0.020, mode 2 +0.080");
    assert_says("misfit this large or larger in fewer than 1 of 1,000 tests");
    assert_says("  The extended model is adequate.\n");
    assert_says("    named: flexibility 2.13e-10 rad/(N.m) (95 %: 1.92e-10 to 2.34e-10)");
    assert_says("    possible (67 %): depth 0.42");
    assert_says("core.E             GPa            116.78      114.44      119.11  the model of the deck\n");
    assert_says("found.flexibility  rad/(N.m)  2.1300e-10  2.0874e-10  2.1726e-10  the extended model\n");
    assert_says("joint       core|right  flexibility  rad/(N.m)   6.4e-11         -         -\n");
    assert_says("added_mass              mass         kg             0.11      2.03       9.6\n");
    assert_says("stiffness   right       factor       1                 -         -         -  at no physical size\n");
    assert_silent("nan");
    assert_silent("modes held out by the deck");
    int lines = 0;
    for (const char *c = screen; *c; c++)
        lines += *c == '\n';
    assert_in_range(lines, 40, 86);
}

/* Every candidate that stays has its parameters, best first, the rest with --verbose, then what the dispute is worth; what a
 * cause below its limit would move is said of a model that explains the data alone. */
UNIT_TEST(the_parameters_stand_at_the_top)
{
    static rotid_hidden hidden[2] = {{"core.E", -2.3e9, "Pa", "added_mass", "", "mass", 0.28, "kg", 0.61, NAN, 0},
                                     {"core.G", 4e10, "Pa", "tie_shear", "ties", "presence", 1, "1", NAN, NAN, 1}};
    fill_named();
    s.d.result.nhidden = 2;
    s.d.result.hidden = hidden;
    show(0, 100);
    assert_order("Parameters, 95 % intervals\n",
                 "core.E             GPa            114.60      112.31      116.89  the extended model\n");
    assert_order("Possible bias: causes below their detection limits",
                 "core.E     up to 2 %       added_mass         mass 0.28 kg   0.61\n"
                 "core.G     more than 50 %  tie_shear of ties  there or not      -\n");
    s.d.result.verdict.adequate_after = 0;
    show(0, 100);
    assert_silent("Possible bias");

    static double mean[9], std[9];
    static struct explanation item[9];
    static rotid_averaged_parameter averaged[1] = {{"core.E", "Pa", 1.04e11, 3e9, {0.98e11, 1.1e11}}};
    for (int i = 0; i < 9; i++) { /* the second is a pair */
        mean[i] = 1e11 + 1e9 * i;
        std[i] = 5e9 / 1.96;
        item[i] = (struct explanation){.nmember = 1 + (i == 1),
                                       .member = {s.candidate[0], s.candidate[1]},
                                       .probability = i ? 0.05 : 0.6,
                                       .evidence = {.mean = &mean[i], .std = &std[i]}};
    }
    s.d.posterior = (struct posterior){.count = 9, .item = item, .nown = 1, .naveraged = 1, .averaged = averaged};
    s.d.ncause = 0;
    s.d.extended.fit = NULL;
    s.d.result.verdict.kind = ROTID_AMBIGUOUS;
    show(0, 100);
    assert_order("Parameters, 95 % intervals\n", "core.E     GPa   104.00       98.00      110.00  the average of all\n");
    assert_says("core.E     GPa   100.00       95.00      105.00  joint between core and right\n");
    assert_says("core.E     GPa   101.00       96.00      106.00  joint between core and right with ");
    show(1, 100);
    assert_says("core.E     GPa   108.00      103.00      113.00  joint between core and right\n");
    assert_silent("more with --verbose");
}

UNIT_TEST(what_a_sensor_and_the_place_say_stands_above_the_place_of_the_cause)
{
    fill_named();
    show(0, 100);
    const char *sensors = strstr(screen, "\n  sensors"), *acts = strstr(screen, "\n  force resid. "),
               *mark = strstr(screen, "^ joint");
    assert_true(sensors && acts && mark);
    const char *begin = mark;
    while (begin[-1] != '\n')
        begin--;
    ptrdiff_t column = mark - begin;
    assert_in_range(column - 14, 58, 60); /* 1.40 of 2.03 m on 86 columns */
    assert_in_range(strchr(acts + 14, '@') - acts - 1, column - 4, column);
    assert_in_range(strchr(sensors, '4') - sensors - 1, column - 3, column + 3);
}

UNIT_TEST(every_case_stays_within_its_columns)
{
    for (size_t i = 0; i < CASES; i++)
        for (int width = 100; width <= 120; width += 10)
            for (int verbose = 0; verbose < 2; verbose++) {
                fills[i]();
                show(verbose, width);
                for (char *line = strtok(screen, "\n"); line; line = strtok(NULL, "\n"))
                    if (strlen(line) > (size_t)width)
                        fail_msg("case %zu, %zu columns of %d: %s", i, strlen(line), width, line);
            }
}

UNIT_TEST(each_verdict_says_its_own)
{
    fill_adequate();
    show(0, 100);
    assert_says("VERDICT  ADEQUATE");
    assert_says("misfit this large or larger in about 37 of 100 tests");
    assert_says("Quality of the model\n");
    assert_silent("as the deck states it");
    assert_silent("->");
    assert_silent("force resid"); /* it is noise */
    assert_silent("p-value  modes");
    fill_ambiguous();
    show(0, 100);
    assert_says("VERDICT  AMBIGUOUS");
    assert_says("next step: measure the shapes at 1.30");
    assert_says("    possible (98 %): flexibility");
    fill_unexplained();
    show(0, 100);
    assert_says("VERDICT  UNEXPLAINED");
    assert_says("The misfit that is left still exceeds the noise");
    assert_silent("\n*  ");
}

UNIT_TEST(what_is_absent_is_left_away)
{
    without_shapes();
    show(0, 100);
    assert_says("noise: frequencies 0.10 % (assumed); shapes: not stated\n");
    assert_says("The deck does not state all of the noise");
    assert_silent("\n  sensors ");
    assert_silent("smallest NCO");
    nothing_to_identify();
    show(0, 100);
    assert_says("; nothing to identify");
    assert_silent("Parameters");
    everything_nan();
    show(1, 100);
    assert_silent("smallest NCO");
    assert_says("No p-value can be stated.");
    assert_says("  no interval can be stated");
    interrupted_at_once();
    show(1, 100);
    assert_says("VERDICT  NONE");
    assert_says("INTERRUPTED");
    assert_silent("Causes one by one");
}

UNIT_TEST(verbose_shows_all_candidates_and_the_time)
{
    fill_named();
    show(1, 100);
    assert_says("added_mass ");
    assert_silent("more with --verbose");
    assert_says("base fit 0.04 s, refits 1.3 s");
}

/* ------------------------------------------------------------------------------------------------ JSON */

static const cJSON *get(const cJSON *json, const char *path)
{
    char list[256], *rest = NULL;
    (void)snprintf(list, sizeof list, "%s", path);
    for (char *key = strtok_r(list, "/", &rest); key; key = strtok_r(NULL, "/", &rest)) {
        json = *key >= '0' && *key <= '9' ? cJSON_GetArrayItem(json, atoi(key)) : cJSON_GetObjectItemCaseSensitive(json, key);
        if (!json)
            print_error("no %s of %s\n", key, path);
        assert_non_null(json);
    }
    return json;
}

static cJSON *json_of(void)
{
    char *text = json_text_of();
    assert_non_null(text);
    assert_null(strstr(text, "nan"));
    assert_null(strstr(text, "inf,"));
    cJSON *json = cJSON_ParseWithOpts(text, NULL, 1);
    free(text);
    assert_true(cJSON_IsObject(json));
    return json;
}

UNIT_TEST(json_of_every_case_has_the_keys_of_the_interface)
{
    static const char keys[] =
        "schema command deck interrupted verdict/kind verdict/adequate_after verdict/p_value verdict/causes verdict/alternatives "
        "verdict/next_measurement verdict/sentence data_findings numerical_findings candidates rounds "
        "gain/frequency_rms_percent/before gain/frequency_max_percent/after gain/shape_rms/after gain/chi2_per_dof/before "
        "gain/holdout_frequency_rms_percent/before gain/holdout_shape_rms/before gain/mode_out_frequency_rms_percent/after "
        "gain/sensor_out_shape_rms/after gain/parameters localisation detectable noise/frequency_assumed modes_standardised "
        "sensors today base extended steps warnings";
    for (size_t i = 0; i < CASES; i++) {
        char list[sizeof keys], *rest = NULL;
        memcpy(list, keys, sizeof keys);
        fills[i]();
        cJSON *json = json_of();
        for (char *key = strtok_r(list, " ", &rest); key; key = strtok_r(NULL, " ", &rest))
            (void)get(json, key);
        cJSON_Delete(json);
    }
}

UNIT_TEST(json_holds_what_the_structs_hold)
{
    fill_named();
    cJSON *json = json_of();
    assert_string_equal(get(json, "verdict/kind")->valuestring, "named");
    assert_string_equal(get(json, "verdict/causes/0/id")->valuestring, "joint");
    assert_string_equal(get(json, "verdict/causes/0/target")->valuestring, "core|right");
    assert_close(get(json, "verdict/causes/0/parameters/0/value")->valuedouble, 2.13e-10, 1e-12, 0);
    assert_close(get(json, "verdict/causes/0/parameters/0/ci95/1")->valuedouble, 1.1 * 2.13e-10, 1e-12, 0);
    assert_int_equal(cJSON_GetArraySize(get(json, "candidates")), 4);
    assert_int_equal(get(json, "candidates/1/round")->valueint, 1);
    assert_string_equal(get(json, "candidates/1/variant")->valuestring, "GAUSS");
    assert_true(cJSON_IsNull(get(json, "candidates/3/chi2")));
    assert_close(get(json, "candidates/0/probability")->valuedouble, 0.98, 1e-12, 0);
    assert_int_equal(cJSON_GetArraySize(get(json, "gain/parameters")), 3);
    assert_true(cJSON_IsNull(get(json, "gain/parameters/2/before")));
    assert_close(get(json, "gain/parameters/2/after")->valuedouble, 2.13e-10, 1e-12, 0);
    assert_int_equal(get(json, "data_findings/0/sensors/0")->valueint, 23);
    assert_string_equal(get(json, "today/functional")->valuestring, "HYBRID");
    assert_string_equal(get(json, "base/functional")->valuestring, "LIKELIHOOD");
    assert_int_equal(cJSON_GetArraySize(get(json, "extended/parameters")), 3);
    assert_true(cJSON_IsTrue(get(json, "detectable/4/beyond")));
    cJSON_Delete(json);
    fill_ambiguous();
    json = json_of();
    assert_string_equal(get(json, "verdict/alternatives/1")->valuestring, "stiffness_local");
    assert_true(cJSON_IsNull(get(json, "extended")));
    cJSON_Delete(json);
    interrupted_at_once();
    json = json_of();
    assert_true(cJSON_IsNull(get(json, "verdict/kind")) && cJSON_IsNull(get(json, "base")));
    cJSON_Delete(json);
}

/* ------------------------------------------------------------------------------------------------ the command */

static int run(const char *arguments)
{
    char command[2048];
    (void)snprintf(command, sizeof command, "%s %s 2>&1", ROTID_PROGRAM, arguments);
    FILE *pipe = popen(command, "r");
    assert_non_null(pipe);
    size_t length = fread(screen, 1, sizeof screen - 1, pipe);
    screen[length] = 0;
    int status = pclose(pipe);
    return status < 0 ? -1 : status / 256;
}

/* The table is of a speed of the diagram, which the highest running speed of 12,000 rpm need not be. */
UNIT_TEST(stability_names_the_speed_that_it_is_of)
{
    assert_int_equal(run("speeds " ROTID_SOURCE_DIR "/input/motor_running.inp --draws 20 --speeds 0:100000:6"), 0);
    assert_says("STABILITY: modes at 20000 rpm");
}

UNIT_TEST(no_option_lets_a_file_of_the_user_be_lost)
{
#define DECK ROTID_SOURCE_DIR "/input/solid_steel.inp"
    static const char *const wrong[][2] = {
        {"diagnose " DECK " --extended " DECK, "--extended " DECK " is the file that is read"},
        {"diagnose " DECK " --json " DECK, "is the file that is read"},
        {"diagnose " DECK " --extended /tmp/none.x --json /tmp/../tmp/none.x", "is the file of --json as well"},
        {"diagnose " DECK " --extended -", "--extended -: expected a file"},
        {"speeds " DECK " --campbell /tmp/none.x --response /tmp/./none.x",
         "--campbell /tmp/none.x is the file of --response as well"},
        {"suggest " DECK " --modes 1", "--modes 1: expected a whole number from 2"},
        {"identify " DECK " --extended /tmp/none.x", "--extended is no option of identify, but of diagnose suggest"},
        {"diagnose " DECK " --seed 2", "--seed is no option of diagnose, but of sensitivity suggest speeds study"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_int_equal(run(wrong[i][0]), 2);
        assert_says(wrong[i][1]);
    }
    assert_int_equal(run("diagnose --help"), 0);
    assert_says("--extended FILE");
}

TEST_GROUP(open_test_pool, close_test_pool);
