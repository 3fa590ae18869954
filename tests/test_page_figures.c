/* The numbers that figures plot, beside the members of the result that they stand for: which member is in which series. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "json_value.h"
#include "page/page.h"
#include "page_bench.h"
#include "plotted.h"
#include "support.h"

#define SOLID ROTID_SOURCE_DIR "/input/solid_rotor.inp"

static struct {
    struct pool pool;
    struct document document;
    cJSON *json;
} bench;

static void open_bench(const char *command, const char *deck)
{
    static struct message_list messages;
    static struct result result;
    char name[64];
    (void)snprintf(name, sizeof name, "%s.json", command);
    if (!page_exists(name))
        assert_int_equal(page_run("%s %s %s --quiet %s --json %s", ROTID_PROGRAM, command, deck,
                                  strcmp(command, "diagnose") ? "" : "--replicates 200", page_path(name)),
                         0);
    pool_open(&bench.pool, NULL);
    message_open(&messages, &bench.pool);
    assert_status(page_result_read(&bench.pool, page_path(name), &messages, &result), ROTID_OK);
    document_open(&bench.document, &bench.pool);
    page_compose(&bench.document, 1, &result);
    assert_false(bench.document.failed);
    bench.json = page_json(name);
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_identification_is_plotted_as_it_is),
        cmocka_unit_test(layers_are_drawn_as_rings),
        cmocka_unit_test(what_is_computed_for_a_plot_is_that_of_its_definition),
        cmocka_unit_test(a_diagnosis_is_plotted_as_it_is),
        cmocka_unit_test(bars_of_the_evidence_are_as_long_as_the_drops),
    };
    return cmocka_run_group_tests(tests, page_bench_open, page_bench_close);
}
