/* The numbers that figures plot, beside the members of the result that they stand for: which member is in which series. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "json_value.h"
#include "page/page.h"
#include "page_bench.h"
#include "plotted.h"
#include "study_bench.h"
#include "support.h"

#define SOLID ROTID_SOURCE_DIR "/input/solid_rotor.inp"
#define PAPER ROTID_SOURCE_DIR "/input/paper_rotor.inp"

static const char *const truth_plan =
    "*STUDY, REPLICATES=25\n*DECKS\nbeam.inp\n*DATA, SOURCE=MODEL\n*TRUTH\ncore.E, 1.8e11, 2.2e11\nleft.E, 2e11\n"
    "*NOISE\n0.001\n0.003\n";

static struct {
    struct pool pool;
    struct document document;
    cJSON *json;
} bench;

/* The figures of a result in the folder, compared with the JSON of one there: of a study the result is its file of results. */
static void open_result(const char *name, const char *json)
{
    static struct message_list messages;
    static struct result result;
    pool_open(&bench.pool, NULL);
    message_open(&messages, &bench.pool);
    assert_status(page_result_read(&bench.pool, page_path(name), &messages, &result), ROTID_OK);
    document_open(&bench.document, &bench.pool);
    page_compose(&bench.document, 1, &result);
    assert_false(bench.document.failed);
    bench.json = json ? page_json(json) : page_runs(name);
}

static void open_bench(const char *command, const char *deck)
{
    char name[64];
    (void)snprintf(name, sizeof name, "%s.json", command);
    if (!page_exists(name))
        assert_int_equal(page_run("cd %s; %s %s %s --quiet %s --json %s", page_path(""), ROTID_PROGRAM, command, deck,
                                  strcmp(command, "diagnose") ? "" : "--replicates 200", name),
                         0);
    open_result(name, name);
}

static void close_bench(void)
{
    cJSON_Delete(bench.json);
    pool_close(&bench.pool);
}

static const char *script_of(const char *id)
{
    struct figure **figure = document_figures(&bench.document);
    for (int i = 0; i < bench.document.nfigure; i++)
        if (!strcmp(figure[i]->id, id))
            return figure[i]->script;
    print_error("there is no figure '%s'\n", id);
    fail();
    return "";
}

struct expected {
    const char *figure, *block, *series, *path;
    double factor;
};

static void compare(size_t count, const struct expected *expected)
{
    static double is[PLOTTED_MOST], has_to_be[PLOTTED_MOST];
    for (size_t i = 0; i < count; i++) {
        const struct expected *e = &expected[i];
        int n = numbers_at(bench.json, e->path, has_to_be), found = plotted(script_of(e->figure), e->block, e->series, is);
        if (found != n)
            print_error("%s, $%s, %s: %d numbers, %d in the result\n", e->figure, e->block, e->series, found, n);
        assert_true(n > 0 && found == n);
        for (int k = 0; k < n; k++) {
            if (isnan(is[k]) && isnan(has_to_be[k]))
                continue;
            if (!(fabs(is[k] - e->factor * has_to_be[k]) <= 1e-6 * fabs(e->factor * has_to_be[k])))
                print_error("%s, $%s, %s, row %d\n", e->figure, e->block, e->series, k);
            assert_close(is[k], e->factor * has_to_be[k], 1e-6, 0); /* seven digits are written */
        }
    }
}

static void an_identification_is_plotted_as_it_is(void **state)
{
    (void)state;
    static const struct expected expected[] = {
        {"rotor", "sensors", "z [m]", "geometry.sensors[].z_m", 1},
        {"rotor", "nodes", "z [m]", "geometry.nodes_z_m[]", 1},
        {"convergence", "iterations", "iteration [1]", "history[].iteration", 1},
        {"convergence", "iterations", "objective [1]", "history[].objective", 1},
        {"convergence", "iterations", "gradient [1]", "history[].gradient", 1},
        {"convergence", "iterations", "step [1]", "history[].step", 1},
        {"convergence", "iterations", "damping [1]", "history[].mu", 1},
        {"convergence", "iterations", "gain ratio [1]", "history[].gain_ratio", 1},
        {"convergence", "iterations", "time [ms]", "history[].seconds", 1e3},
        {"iterates", "parameters", "iteration [1]", "history[].iteration", 1},
        {"iterates", "parameters", "core.E [GPa]", "history[].x[0]", 1e-9},
        {"iterates", "parameters", "core.G [GPa]", "history[].x[1]", 1e-9},
        {"bijection", "iterates2", "iteration [1]", "history[].iteration", 1},
        {"frequencies", "errors", "mode [1]", "modes[].mode", 1},
        {"frequencies", "errors", "measured [Hz]", "modes[].measured_hz", 1},
        {"frequencies", "errors", "predicted [Hz]", "modes[].predicted_hz", 1},
        {"frequencies", "errors", "error, Levenberg-Marquardt [%]", "modes[].error_percent", 1},
        {"frequencies", "errors", "95 % noise [%]", "modes[].frequency_std", 196},
        {"shapes", "model2", "z [m]", "shapes.axis_z_m[]", 1},
        {"shapes", "model2", "deflection [1]", "shapes.modes[1].predicted_axis[]", 1},
        {"shapes", "measured2", "z [m]", "shapes.z_m[]", 1},
        {"shapes", "measured2", "deflection [1]", "shapes.modes[1].measured[]", 1},
        {"correlation-of-shapes", "matrix1", "3 [1]", "nco_matrix[][2]", 1},
        {"correlation-of-shapes", "matrix2", "3 [1]", "mac_matrix[][2]", 1},
    };
    open_bench("identify", SOLID);
    compare(sizeof expected / sizeof *expected, expected);
    close_bench();
}

/* Every state has figures of its own numbers, and all are in one. */
static void states_are_plotted_each_as_it_is(void **state)
{
    (void)state;
    static const struct expected identified[] =
        {
            {"frequencies", "errors", "error, Levenberg-Marquardt [%]", "modes[].error_percent", 1},
            {"frequencies-2", "errors", "predicted [Hz]", "states[0].modes[].predicted_hz", 1},
            {"frequencies-3", "errors", "predicted [Hz]", "states[1].modes[].predicted_hz", 1},
            {"frequencies-3", "errors", "error, reference in the deck [%]", "states[1].modes[].mode", 0.5},
            {"frequencies-4", "errors", "error, Levenberg-Marquardt [%]", "states[2].modes[].error_percent", 1},
            {"rotor", "nodes", "z [m]", "states[0].geometry.nodes_z_m[]", 1},
            {"rotor-2", "nodes", "z [m]", "states[1].geometry.nodes_z_m[]", 1},
            {"shapes-2", "model1", "deflection [1]", "states[1].shapes.modes[0].predicted_axis[]", 1},
            {"shapes-2", "measured1", "deflection [1]", "states[1].shapes.modes[0].measured[]", 1},
            {"correlation-of-shapes", "matrix2", "1 [1]", "states[1].mac_matrix[][0]", 1},
            {"convergence", "iterations", "objective [1]", "history[].objective", 1},
        },
                                 modes[] = {
                                     {"modes", "model1", "deflection [1]", "states[0].modes[0].shape[]", 1},
                                     {"modes-2", "model1", "deflection [1]", "states[1].modes[0].shape[]", 1},
                                     {"rotor-3", "nodes", "z [m]", "states[2].geometry.nodes_z_m[]", 1},
                                 };
    page_write_file(
        "states.inp",
        "*HEADING\nstrip\npaper error_percent = 9, 9, 0.5, 1, 9\n"
        "*MATERIAL, NAME=alu\n*ELASTIC\n70e9, 0.33\n*DENSITY\n2700\n*BEAM, NAME=strip, MATERIAL=alu\n"
        "0.30, 0.002, 0.050, 12\n*SPRING, NAME=clamp\nstart, 1e9, 1e7\n*SENSORS\n1, 0.15\n2, end\n"
        "*NOISE, FREQUENCY=0.02, SHAPE=0.05\n*IDENTIFY\nstrip.E, 2e10, 2e11, 7e10\n*FIT, HOLDOUT=STATE:last\n"
        "*STATE, NAME=short\n*NOISE, FREQUENCY=0.02\n*MODES\n1, 16.49333\n2, 107.6\n*STATE, NAME=long\n*SET\nstrip.length, 0.4\n"
        "*MODES\n1, 9.383333\n2, 61.53667\n*SHAPE, MODE=1\n1, 0.34\n2, 1\n*STATE, NAME=last\n"
        "*SET\nstrip.length, 0.5\n*NOISE, FREQUENCY=0.02\n*MODES\n1, 6.02\n");
    assert_int_equal(page_run("cd %s; for c in identify modes; do %s $c states.inp --quiet --json states_$c.json; done",
                              page_path(""), ROTID_PROGRAM),
                     0);
    open_result("states_identify.json", "states_identify.json");
    compare(sizeof identified / sizeof *identified, identified);
    static double is[PLOTTED_MOST], x[PLOTTED_MOST], hz[PLOTTED_MOST]; /* of the second state: modes 2 and 3 of all */
    assert_int_equal(plotted(script_of("frequencies-3"), "errors", "error, NLopt LN_SBPLX [%]", is), 2);
    assert_int_equal(numbers_at(bench.json, "baseline[0].predicted_hz[]", x), 5);
    assert_int_equal(numbers_at(bench.json, "modes[].measured_hz", hz), 5);
    assert_string_equal(get(cJSON_GetArrayItem(get(bench.json, "baseline"), 0), "algorithm")->valuestring, "LN_SBPLX");
    for (int k = 0; k < 2; k++)
        assert_close(is[k], 100 * (x[k + 2] / hz[k + 2] - 1), 1e-5, 1e-9);
    close_bench();
    open_result("states_modes.json", "states_modes.json");
    compare(sizeof modes / sizeof *modes, modes);
    close_bench();
}

/* A ring is drawn on both sides of what lies within, and its bore is no hole in that. */
static void layers_are_drawn_as_rings(void **state)
{
    (void)state;
    open_bench("check", ROTID_SOURCE_DIR "/input/motor_shaft_stack.inp");
    const char *script = script_of("rotor");
    assert_int_equal(page_times(script, "rectangle from 1.01,0.225 to 2.16,0.41 "), 1);
    assert_int_equal(page_times(script, "rectangle from 1.01,-0.225 to 2.16,-0.41 "), 1);
    assert_int_equal(page_times(script, "rectangle from 1.01,-0.225 to 2.16,0.225 "), 1); /* the shaft itself */
    assert_int_equal(page_times(script, "fc rgb PAPER"), 0);
    close_bench();
}

/* What is computed of the result: shares, intervals in per cent, what others make of the frequencies. */
static void what_is_computed_for_a_plot_is_that_of_its_definition(void **state)
{
    (void)state;
    static double is[PLOTTED_MOST], x[PLOTTED_MOST], hz[PLOTTED_MOST];
    open_bench("identify", SOLID);
    const cJSON *parameters = get(bench.json, "parameters"), *core = cJSON_GetArrayItem(parameters, 1);
    double lower = number_of(core, "lower"), upper = number_of(core, "upper"), value = number_of(core, "value"),
           chi = number_of(bench.json, "bijection_chi");
    int n = numbers_at(bench.json, "history[].x[1]", x);
    assert_int_equal(plotted(script_of("bijection"), "iterates2", "share of the way from the lower to the upper bound [1]", is),
                     n);
    for (int i = 0; i < n; i++)
        assert_close(is[i], (x[i] - lower) / (upper - lower), 1e-6, 0);
    assert_int_equal(plotted(script_of("bijection"), "iterates2", "y [1]", is), n);
    for (int i = 0; i < n; i++) /* (30) */
        assert_close(lower + (upper - lower) / (1 + exp(chi * is[i])), x[i], 1e-5, 0);
    assert_int_equal(plotted(script_of("iterates"), "parameters", "core.G over its end [1]", is), n);
    for (int i = 0; i < n; i++)
        assert_close(is[i], x[i] / value, 1e-6, 0);
    int count = numbers_at(bench.json, "parameters[].ci95[1]", x);
    assert_int_equal(plotted(script_of("intervals"), "intervals", "upper end [% of the value]", is), count);
    for (int p = 0; p < count; p++) {
        double its = number_of(cJSON_GetArrayItem(parameters, p), "value");
        assert_close(is[p], fmin(100 * (x[p] / its - 1), 300), 1e-5, 0);
    }
    count = numbers_at(bench.json, "baseline[0].predicted_hz[]", x);
    char series[64];
    (void)snprintf(series, sizeof series, "error, NLopt %s [%%]",
                   get(cJSON_GetArrayItem(get(bench.json, "baseline"), 0), "algorithm")->valuestring);
    assert_int_equal(plotted(script_of("frequencies"), "errors", series, is), count);
    assert_int_equal(numbers_at(bench.json, "modes[].measured_hz", hz), count);
    for (int k = 0; k < count; k++)
        assert_close(is[k], 100 * (x[k] / hz[k] - 1), 1e-5, 1e-9);
    close_bench();
}

static void a_diagnosis_is_plotted_as_it_is(void **state)
{
    (void)state;
    static const struct expected expected[] = {
        {"residuals", "modes", "measured [Hz]", "base.modes[].measured_hz", 1},
        {"residuals", "modes", "residual/sigma [1]", "modes_standardised[]", 1},
        {"residuals", "sensors", "z [m]", "sensors[].z_m", 1},
        {"residuals", "sensors", "residual/sigma [1]", "sensors[].rms", 1},
        {"places", "indicator", "z [m]", "localisation[].z_m", 1},
        {"places", "indicator", "indicator [1]", "localisation[].indicator", 1},
        {"improvement", "errors", "mode [1]", "base.modes[].mode", 1},
        {"improvement", "errors", "error without the cause [%]", "base.modes[].error_percent", 1},
        {"improvement", "errors", "error with it [%]", "extended.modes[].error_percent", 1},
        {"improvement", "errors", "95 % noise [%]", "base.modes[].frequency_std", 196},
        {"shapes", "model1", "deflection [1]", "extended.shapes.modes[0].predicted_axis[]", 1},
        {"shapes", "measured1", "deflection [1]", "extended.shapes.modes[0].measured[]", 1},
        {"shapes", "measured1", "half of the 95 % of its noise [1]", "extended.shapes.modes[0].measured_std[]", 1.96},
    };
    static double is[PLOTTED_MOST];
    open_bench("diagnose", SOLID);
    compare(sizeof expected / sizeof *expected, expected);
    const cJSON *gain = get(bench.json, "gain"), *parameter = cJSON_GetArrayItem(get(gain, "parameters"), 0);
    static const char *const sides[] = {"before", "after"}, *const series[] = {"without the cause [%]", "with it [%]"};
    for (int s = 0; s < 2; s++) {
        assert_true(plotted(script_of("gain"), "frequencies", series[s], is) > 0);
        assert_close(is[0], number_of(get(gain, "frequency_rms_percent"), sides[s]), 1e-6, 0);
        assert_true(plotted(script_of("gain"), "shapes", series[s], is) > 0);
        assert_close(is[0], 100 * number_of(get(gain, "shape_rms"), sides[s]), 1e-6, 0);
    }
    char name[64];
    (void)snprintf(name, sizeof name, "%s [GPa]", get(parameter, "name")->valuestring);
    int rows = plotted(script_of("change"), "parameter1", name, is); /* the states from above: before and after are the last */
    assert_true(rows >= 2);
    assert_close(is[rows - 2], 1e-9 * number_of(parameter, "before"), 1e-6, 0);
    assert_close(is[rows - 1], 1e-9 * number_of(parameter, "after"), 1e-6, 0);
    assert_int_equal(plotted(script_of("change"), "parameter1", "to [GPa]", is), rows);
    assert_close(is[rows - 1], 1e-9 * cJSON_GetArrayItem(get(parameter, "after_ci95"), 1)->valuedouble, 1e-6, 0);
    close_bench();
}

static int falling(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x < y) - (x > y);
}

/* A bar is as long as the drop that the fit of its candidate reached, or that the scan expects of one that was not fitted. */
static void bars_of_the_evidence_are_as_long_as_the_drops(void **state)
{
    (void)state;
    static double is[PLOTTED_MOST], drop[PLOTTED_MOST];
    int count = 0;
    const cJSON *item;
    open_bench("diagnose", SOLID);
    cJSON_ArrayForEach(item, get(bench.json, "candidates")) if (number_of(item, "round") == 1)
    {
        int refitted = cJSON_IsTrue(get(item, "refitted"));
        const cJSON *number = get(item, refitted ? "chi2_drop" : "predicted_drop");
        if (cJSON_IsNumber(number))
            drop[count++] = fmax(number->valuedouble, 0);
    }
    qsort(drop, (size_t)count, sizeof *drop, falling);
    int drawn = plotted(script_of("evidence"), "candidates", "length of the bar [1]", is);
    assert_true(drawn >= 5 && drawn <= count);
    for (int i = 0; i < drawn; i++)
        assert_close(is[i], drop[i], 1e-6, 0);
    close_bench();
}

static void sensitivities_are_plotted_as_they_are(void **state)
{
    (void)state;
    static const struct expected expected[] = {
        {"sensitivity", "sensitivity", "frequency [Hz]", "frequency_hz[]", 1},
        {"sensitivity", "sensitivity", "core.E, 1.0\xc2\xa0% step [1]", "parameters[0].sensitivity[]", 1},
        {"sensitivity", "sensitivity", "core.G, 1.0\xc2\xa0% step [1]", "parameters[1].sensitivity[]", 1},
        {"sensitivity", "sensitivity", "core.G, limit [1]", "parameters[1].derivative[]", 1},
        {"sensitivity", "sensitivity", "core.G, reference [1]", "references[3].values[]", 1},
        {"sensitivity-curves", "curves", "value over reference [1]", "relative_value[]", 1},
        {"sensitivity-curves", "curves", "core.E, mode 1 [1]", "parameters[0].curves[0][]", 1},
        {"sensitivity-curves", "curves", "core.G, mode 3 [1]", "parameters[1].curves[2][]", 1},
        {"growth", "growth", "\xce\xb5\xc2\xb2 [1]", "functional_growth.epsilon_squared[]", 1},
        {"growth", "growth", "f(E) [1]", "functional_growth.hybrid.objective[]", 1},
        {"growth", "growth", "f(F) [1]", "functional_growth.hybrid_f.objective[]", 1},
        {"growth", "growth", "f(E), shapes alone [1]", "functional_growth.shapes_alone[]", 1},
    };
    open_bench("sensitivity", PAPER);
    compare(sizeof expected / sizeof *expected, expected);
    close_bench();
}

static void the_worth_of_sensors_is_plotted_as_it_is(void **state)
{
    (void)state;
    static const struct expected expected[] = {
        {"sensor-worth", "places", "z [m]", "places[].z_m", 1},
        {"sensor-worth", "places", "worth of one more sensor [%]", "places[].worth_percent", 1},
        {"sensor-worth", "places", "rise of the margins by it [%]", "places[].margin_percent", 1},
    };
    static double loss[PLOTTED_MOST], z[PLOTTED_MOST];
    open_bench("suggest", PAPER);
    compare(sizeof expected / sizeof *expected, expected);
    int n = numbers_at(bench.json, "plans[0].loss_percent[]", loss);
    assert_true(n > 3);
    assert_true(plotted(script_of("sensor-worth"), "sensors", "loss without this sensor [%]", z) > n);
    for (int i = 0; i < n; i++)
        assert_close(z[i], loss[i], 1e-6, 0);
    close_bench();
}

/* Fewer lines than the picture has room for are all drawn; the functions of one damping stand for measured ones of another. */
static void transfer_functions_are_plotted_as_they_are(void **state)
{
    (void)state;
    static const struct expected lines[] = {
        {"transfer-5-1", "synthesised", "frequency [Hz]", "functions[1].frequency_hz[]", 1},
        {"transfer-5-1", "measured", "frequency [Hz]", "functions[1].frequency_hz[]", 1},
    };
    static double size[PLOTTED_MOST], phase[PLOTTED_MOST], re[PLOTTED_MOST], im[PLOTTED_MOST];
    static const char *const curve[] = {"synthesised", "measured"};
    page_write_file("source.inp", BENCH_DECK "*FRF, DAMPING=0.01, LINES=801\n1, 1\n5, 1\n");
    page_write_file("frf.inp", BENCH_DECK "*FRF, FILE=source.unv, DAMPING=0.02\n");
    assert_int_equal(page_run("cd %s; %s frf source.inp -o source.unv --quiet", page_path(""), ROTID_PROGRAM), 0);
    open_bench("frf", "frf.inp");
    compare(sizeof lines / sizeof *lines, lines);
    for (int c = 0; c < 2; c++) {
        char path[64];
        (void)snprintf(path, sizeof path, "functions[1].%s_re[]", curve[c]);
        int n = numbers_at(bench.json, path, re), turned = 0;
        (void)snprintf(path, sizeof path, "functions[1].%s_im[]", curve[c]);
        assert_int_equal(numbers_at(bench.json, path, im), n);
        assert_int_equal(plotted(script_of("transfer-5-1"), curve[c], "magnitude [m/(s2 N)]", size), n);
        assert_int_equal(plotted(script_of("transfer-5-1"), curve[c], "phase [\xc2\xb0]", phase), n);
        for (int l = 0; l < n; l++) {
            assert_close(size[l], hypot(re[l], im[l]), 1e-6, 0);
            turned += isnan(phase[l]);
            if (!isnan(phase[l]))
                assert_close(phase[l], atan2(im[l], re[l]) * 180 / acos(-1), 1e-6, 0);
        }
        assert_true(n == 801 && turned < 20); /* none where the phase turns over */
    }
    close_bench();
}

static void studies_are_plotted_as_they_are(void **state)
{
    (void)state;
    static const struct expected starts[] = {
        {"starts", "runs", "start, core.E [GPa]", "[].parameters[0].start", 1e-9},
        {"starts", "runs", "start, left.E [GPa]", "[].parameters[1].start", 1e-9},
        {"starts", "runs", "end, core.E [GPa]", "[].parameters[0].value", 1e-9},
        {"starts", "runs", "end, left.E [GPa]", "[].parameters[1].value", 1e-9},
    };
    static const struct expected modes[] = {
        {"parameters-by-modes", "p1_1", "core.E [GPa]", "cells[].parameters[0].mean", 1e-9},
        {"parameters-by-modes", "p2_1", "left.E [GPa]", "cells[].parameters[1].mean", 1e-9},
        {"parameters-by-modes", "p2_1", "its stated standard deviation [GPa]", "cells[].parameters[1].mean_stated_std", 1e-9},
    };
    static const struct expected coverage[] = {
        {"coverage", "coverage", "core.E [%]", "cells[].parameters[0].coverage95", 100},
        {"coverage", "coverage", "left.E [%]", "cells[].parameters[1].coverage95", 100},
    };
    static const struct expected decks[] = {
        {"decks", "decks", "core.E [GPa]", "[].parameters[0].value", 1e-9},
        {"decks", "decks", "95 % from [GPa]", "[].parameters[0].ci95[0]", 1e-9},
        {"decks", "decks", "to [GPa]", "[].parameters[0].ci95[1]", 1e-9},
    };
    page_make_study("starts", "*STUDY\n*DECKS\nbeam.inp\n*STARTS, SPREAD=0.5, GRID=3\n");
    open_result("starts.jsonl", NULL);
    compare(sizeof starts / sizeof *starts, starts);
    close_bench();
    page_make_study("modes", "*STUDY\n*DECKS\nbeam.inp\n*MODES\n1-3\n1-4\n1-6\n");
    open_result("modes.jsonl", "modes.json");
    compare(sizeof modes / sizeof *modes, modes);
    close_bench();
    page_make_study("truth", truth_plan);
    open_result("truth.jsonl", "truth.json");
    compare(sizeof coverage / sizeof *coverage, coverage);
    close_bench();
    assert_int_equal(page_run("cd %s; for i in 1 2 3; do cp beam.inp deck$i.inp; done; %s study deck?.inp -o decks.jsonl --quiet",
                              page_path(""), ROTID_PROGRAM),
                     0);
    open_result("decks.jsonl", NULL);
    compare(sizeof decks / sizeof *decks, decks);
    close_bench();
}

static void verdicts_are_plotted_as_they_are(void **state)
{
    (void)state;
    static const struct expected runs = {"verdicts", "verdicts", "runs [1]", "cells[].diagnoses.count", 1};
    static const char *const scores[][2] = {{"right [1]", "right"},
                                            {"quiet: nothing was hidden, nothing found [1]", "quiet"},
                                            {"in the set that cannot be told apart [1]", "in_set"},
                                            {"in another set [1]", "other_set"},
                                            {"silent: judged adequate [1]", "silent"},
                                            {"unexplained [1]", "unexplained"},
                                            {"wrong [1]", "wrong"},
                                            {"false alarm [1]", "false_alarm"}};
    static double is[PLOTTED_MOST], has_to_be[PLOTTED_MOST];
    int drawn = 0;
    page_make_study("hidden",
                    "*STUDY, COMMAND=DIAGNOSE, REPLICATES=3, BOOTSTRAP=100\n*DECKS\nbeam.inp\n*DATA, SOURCE=MODEL\n*NOISE\n"
                    "0.001, 0.01\n*HIDE, TYPE=NONE, NAME=control\n*HIDE, TYPE=DENSITY, NAME=a, GROUP=core\nfactor, 1.2\n");
    open_result("hidden.jsonl", "hidden.json");
    compare(1, &runs);
    for (size_t k = 0; k < sizeof scores / sizeof *scores; k++) {
        char path[64];
        (void)snprintf(path, sizeof path, "cells[].diagnoses.scores.%s", scores[k][1]);
        double sum = 0;
        int n = numbers_at(bench.json, path, has_to_be), found = plotted(script_of("verdicts"), "verdicts", scores[k][0], is);
        for (int i = 0; i < n; i++)
            sum += has_to_be[i];
        assert_int_equal(found, sum > 0 ? n : -1); /* what occurs nowhere is left out */
        for (int i = 0; i < found; i++)
            assert_close(is[i], has_to_be[i], 0, 0);
        drawn += found > 0;
    }
    assert_true(drawn >= 1);
    close_bench();
}

/* Means over the square of the number of modes; errors over their stated deviations, counted in bins of a half. */
static void what_is_computed_of_a_study_is_that_of_its_definition(void **state)
{
    (void)state;
    static double is[PLOTTED_MOST], m[PLOTTED_MOST], x[PLOTTED_MOST];
    page_make_study("modes", "*STUDY\n*DECKS\nbeam.inp\n*MODES\n1-3\n1-4\n1-6\n");
    open_result("modes.jsonl", NULL);
    assert_int_equal(plotted(script_of("functional-by-modes"), "variant1", "fitted modes m [1]", m), 3);
    assert_int_equal(plotted(script_of("functional-by-modes"), "variant1", "mean functional f/m\xc2\xb2 [1]", is), 3);
    assert_int_equal(numbers_at(bench.json, "[].objective", x), 3);
    for (int i = 0; i < 3; i++) {
        assert_close(m[i], i < 2 ? 3 + i : 6, 0, 0);
        assert_close(is[i], x[i] / (m[i] * m[i]), 1e-6, 0);
    }
    close_bench();
    page_make_study("truth", truth_plan);
    open_result("truth.jsonl", NULL);
    double bin[16] = {0};
    const cJSON *run;
    cJSON_ArrayForEach(run, bench.json)
    {
        const cJSON *left = cJSON_GetArrayItem(get(run, "parameters"), 1);
        double error = (number_of(left, "value") - number_of(left, "truth")) / number_of(left, "std");
        if (number_of(get(run, "cell"), "noise_frequency") < 0.002)
            bin[(int)fmin(fmax(floor(2 * (error + 4)), 0), 15)] += 1;
    }
    assert_int_equal(plotted(script_of("errors-of-runs"), "errors", "middle of the bin [1]", m), 16);
    assert_int_equal(plotted(script_of("errors-of-runs"), "errors", "runs, left.E [1]", is), 16);
    for (int b = 0; b < 16; b++) {
        assert_close(m[b], -3.75 + 0.5 * b, 1e-6, 0);
        assert_close(is[b], bin[b], 0, 0);
    }
    close_bench();
}

/* Energies stand beside the extents of their elements; the density is the share of the energy over that of the volume. */
static void a_solid_is_plotted_as_it_is(void **state)
{
    (void)state;
    static const struct expected expected[] = {
        {"meridian", "elements", "group [1]", "meridian.elements[].group", 1},
        {"meridian", "sensors", "z [m]", "geometry.sensors[].z_m", 1},
        {"strain-energy", "energy2", "share of the strain energy [1]", "modes[1].meridian.energy[]", 1},
        {"strain-energy", "motion2", "z [m]", "meridian.z_m[]", 1},
        {"strain-energy", "motion2", "radius [m]", "meridian.r_m[]", 1},
        {"strain-energy", "motion2", "radial motion [1]", "modes[1].meridian.u[]", 1},
        {"strain-energy", "motion2", "axial motion [1]", "modes[1].meridian.w[]", 1},
    };
    static double from[PLOTTED_MOST], to[PLOTTED_MOST], inner[PLOTTED_MOST], outer[PLOTTED_MOST], share[PLOTTED_MOST],
        density[PLOTTED_MOST];
    const double volume = 0.4 * 0.03 * 0.03 + 0.3 * 0.06 * 0.06; /* over pi */
    page_write_file("stepped.inp", "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n"
                                   "*SHAFT, NAME=thin, MATERIAL=steel\n0.4, 0.06, 0, 8\n"
                                   "*SHAFT, NAME=thick, MATERIAL=steel\n0.3, 0.12, 0, 6\n"
                                   "*SENSORS\n1, 0.1\n2, 0.3\n3, 0.6\n*FIT, MODEL=SOLID\n");
    open_bench("modes", "stepped.inp");
    compare(sizeof expected / sizeof *expected, expected);
    const char *script = script_of("strain-energy");
    int n = plotted(script, "energy1", "from [m]", from);
    (void)plotted(script, "energy1", "to [m]", to);
    (void)plotted(script, "energy1", "inner radius [m]", inner);
    (void)plotted(script, "energy1", "outer radius [m]", outer);
    (void)plotted(script, "energy1", "share of the strain energy [1]", share);
    assert_int_equal(plotted(script, "energy1", "density over its mean [1]", density), n);
    assert_true(n > 50);
    for (int e = 0; e < n; e++)
        assert_close(density[e], share[e] * volume / ((outer[e] * outer[e] - inner[e] * inner[e]) * (to[e] - from[e])), 2e-5, 0);
    close_bench();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_identification_is_plotted_as_it_is),
        cmocka_unit_test(states_are_plotted_each_as_it_is),
        cmocka_unit_test(layers_are_drawn_as_rings),
        cmocka_unit_test(what_is_computed_for_a_plot_is_that_of_its_definition),
        cmocka_unit_test(a_solid_is_plotted_as_it_is),
        cmocka_unit_test(a_diagnosis_is_plotted_as_it_is),
        cmocka_unit_test(bars_of_the_evidence_are_as_long_as_the_drops),
        cmocka_unit_test(sensitivities_are_plotted_as_they_are),
        cmocka_unit_test(the_worth_of_sensors_is_plotted_as_it_is),
        cmocka_unit_test(transfer_functions_are_plotted_as_they_are),
        cmocka_unit_test(studies_are_plotted_as_they_are),
        cmocka_unit_test(verdicts_are_plotted_as_they_are),
        cmocka_unit_test(what_is_computed_of_a_study_is_that_of_its_definition),
    };
    return cmocka_run_group_tests(tests, page_bench_open, page_bench_close);
}
