/* Shapes in a result: measured and predicted on one scale, along the axis and beside it, and the matrices of their likeness. */
#include "support.h"

#include "json_deck.h"
#include "result/result.h"
#include "run/run.h"

#define STEEL "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n"
#define SHAFT                                                                                                                    \
    STEEL "*SHAFT, NAME=left, MATERIAL=steel\n0.3, 0.05, 0, 6\n*SHAFT, NAME=core, MATERIAL=steel\n0.4, 0.1, 0.02, 8\n"           \
          "*SHAFT, NAME=right, MATERIAL=steel\n0.3, 0.05, 0, 6\n"
#define MODES    "*MODES\n1, 383\n2, 640\n3, 1690\n"
#define IDENTIFY "*IDENTIFY\ncore.E, 1e9, 1e12, 1.8e11\n"
#define SENSORS  9
#define UNREAD   3 /* that was not read in mode 2 */
#define NOISE    "*NOISE, FREQUENCY=0.001, SHAPE=0.03\n"
#define TEXT     (1 << 20)

static double std_of(int sensor)
{
    return 0.02 * (1 + sensor % 3);
}

/* A deck whose shapes are those of its own model with noise; mode 3 has none. with_std: the components state theirs. */
static char *noisy_deck(const char *noise, int with_std)
{
    static char text[TEXT];
    struct json_deck deck;
    struct spectrum s;
    struct random_stream stream = {4};
    char sensors[256] = "*SENSORS\n";
    for (int i = 0; i < SENSORS; i++)
        (void)snprintf(sensors + strlen(sensors), sizeof sensors - strlen(sensors), "%d, %.3f\n", 10 + i, 0.125 * i);
    (void)snprintf(text, sizeof text, SHAFT "%s", sensors);
    json_deck_open(&deck, text);
    assert_status(spectrum_compute(&deck.pool, NULL, &deck.job->rotor, 0, NULL, NULL, ROTID_GUYAN, 3, &s), ROTID_OK);
    (void)snprintf(text, sizeof text, SHAFT MODES IDENTIFY "%s%s", noise, sensors);
    for (int k = 0; k < 2; k++) {
        (void)snprintf(text + strlen(text), 64, "*SHAPE, MODE=%d\n", k + 1);
        for (int i = 0; i < SENSORS; i++)
            if (!(k == 1 && i == UNREAD)) {
                char std[32] = "";
                if (with_std)
                    (void)snprintf(std, sizeof std, ", %.3f", std_of(i));
                (void)snprintf(text + strlen(text), 64, "%d, %.9g%s\n", 10 + i,
                               -3 * s.shape[i + k * s.nmaster] + 0.1 * random_normal(&stream), std);
            }
    }
    json_deck_close(&deck);
    return text;
}

/* MAC over the components that both have */
static double mac_of(int n, const double *a, const double *b)
{
    double ab = 0, aa = 0, bb = 0;
    for (int i = 0; i < n; i++)
        if (isfinite(a[i])) {
            ab += a[i] * b[i];
            aa += a[i] * a[i];
            bb += b[i] * b[i];
        }
    return ab * ab / (aa * bb);
}

/* Mode k of a result with two measured shapes. std: whether their noise is stated. */
static void judge_shape(const cJSON *json, int k, int with_std)
{
    const cJSON *shapes = get(json, "shapes"), *mode = json_member(shapes, "modes", k), *printed = json_member(json, "modes", k);
    double z[SENSORS], axis_z[64], axis[64], measured[SENSORS], predicted[SENSORS], std[SENSORS], largest = 0, slope = 0,
                                                                                                  scale = 0;
    int nodes = cJSON_GetArraySize(get(shapes, "axis_z_m")), met = 0;
    json_numbers(get(shapes, "z_m"), SENSORS, z);
    json_numbers(get(shapes, "axis_z_m"), nodes, axis_z);
    json_numbers(get(mode, "measured"), SENSORS, measured);
    json_numbers(get(mode, "predicted"), SENSORS, predicted);
    json_numbers(get(mode, "predicted_axis"), nodes, axis);
    assert_true(with_std || cJSON_IsNull(get(mode, "measured_std")));
    if (with_std)
        json_numbers(get(mode, "measured_std"), SENSORS, std);
    for (int i = 0; i < SENSORS && with_std; i++)
        assert_true(!isfinite(measured[i]) || fabs(std[i] - std_of(i)) < 1e-9);
    for (int i = 0; i < SENSORS; i++) {
        assert_true(isfinite(measured[i]) != (k == 1 && i == UNREAD));
        for (int node = 0; node < nodes; node++)
            if (fabs(axis_z[node] - z[i]) < 1e-6) {
                assert_close(predicted[i], axis[node], 1e-8, 1e-12);
                met++;
            }
        if (!isfinite(measured[i]))
            continue;
        double weight = with_std ? 1 / (std[i] * std[i]) : 1;
        slope += weight * predicted[i] * (predicted[i] - measured[i]); /* vanishes at the best scale */
        scale += weight * predicted[i] * predicted[i];
        largest = fmax(largest, measured[i]);
        assert_true(measured[i] >= -1);
    }
    assert_int_equal(met, SENSORS);
    assert_close(largest, 1, 0, 0); /* and positive, whatever the sign of the test */
    assert_close(slope / scale, 0, 0, 1e-8);
    double mac = mac_of(SENSORS, measured, predicted);
    assert_close(mac, number_of(printed, "mac"), 1e-7, 0);
    assert_true(mac > 0.9 && mac < 0.99999);
}

UNIT_TEST(shapes_have_one_scale_and_give_the_printed_mac)
{
    for (int with = 0; with < 2; with++) {
        struct json_deck deck;
        json_deck_open(&deck, noisy_deck(with ? NOISE : "", with));
        cJSON *json = json_deck_identify(&deck, 0);
        const cJSON *noise = get(json, "noise");
        for (int k = 0; k < 2; k++)
            judge_shape(json, k, with);
        if (with) {
            assert_close(number_of(noise, "frequency"), 1e-3, 0, 0);
            assert_close(number_of(noise, "shape"), 0.04, 1e-9, 0); /* the median */
            assert_close(number_of(json_member(json, "modes", 2), "frequency_std"), 1e-3, 0, 0);
        } else {
            assert_true(cJSON_IsNull(get(noise, "frequency")) && cJSON_IsNull(get(noise, "shape")));
        }
        assert_string_equal(get(noise, "intervals_from")->valuestring, with ? "noise" : "residuals");
        assert_int_equal(cJSON_IsTrue(get(json, "shapes_fitted")), with); /* HYBRID of the full model needs none */
        cJSON_Delete(json);
        json_deck_close(&deck);
    }
}

UNIT_TEST(matrices_hold_the_printed_values_where_mode_meets_partner)
{
    struct json_deck deck;
    double row[8];
    json_deck_open(&deck, noisy_deck(NOISE, 0));
    cJSON *json = json_deck_identify(&deck, 0);
    int columns = deck.result->nmatrix_columns;
    static const char *const keys[2][2] = {{"mac_matrix", "mac"}, {"nco_matrix", "nco"}};
    assert_true(columns == 6);
    for (int m = 0; m < 2; m++)
        for (int k = 0; k < 3; k++) {
            json_numbers(json_member(json, keys[m][0], k), columns, row);
            for (int j = 0; j < columns; j++)
                assert_true(k == 2 ? isnan(row[j]) : row[j] >= 0 && row[j] <= 1 + 1e-9);
            if (k < 2)
                assert_close(row[k], number_of(json_member(json, "modes", k), keys[m][1]), 1e-8, 0);
            for (int j = 0; j < columns && k < 2 && m == 1; j++)
                assert_true(j == k || row[j] < 0.1);
        }
    json_numbers(get(json, "matrix_rows"), 3, row);
    assert_true(row[0] == 1 && row[1] == 2 && row[2] == 3);
    json_numbers(get(json, "matrix_columns"), columns, row);
    assert_true(row[0] == 1 && row[5] == 6);
    const cJSON *mode = json_member(get(json, "shapes"), "modes", 2);
    assert_true(cJSON_IsNull(get(mode, "measured")) && cJSON_IsNull(get(mode, "measured_std")));
    cJSON_Delete(json);
    json_deck_close(&deck);
}

/* The numbers of a measured mode and of its partner stand apart: here the deck numbers modes 1 and 2 the wrong way round. */
UNIT_TEST(rows_carry_the_numbers_of_the_deck)
{
    char *text = noisy_deck(NOISE, 0), *first = strstr(text, "MODE=1"), *second = strstr(text, "MODE=2");
    struct json_deck deck;
    double row[6];
    first[5] = '2';
    second[5] = '1';
    json_deck_open(&deck, text);
    cJSON *json = json_deck_identify(&deck, 0);
    for (int k = 0; k < 2; k++) {
        const cJSON *mode = json_member(json, "modes", k);
        assert_close(number_of(mode, "measured_mode"), k + 1, 0, 0);
        assert_close(number_of(mode, "mode"), 2 - k, 0, 0);
        assert_close(number_of(json_member(get(json, "shapes"), "modes", k), "mode"), 2 - k, 0, 0);
        json_numbers(json_member(json, "mac_matrix", k), 6, row);
        assert_close(row[1 - k], number_of(mode, "mac"), 1e-8, 0);
        assert_true(row[1 - k] > 0.9);
    }
    json_numbers(get(json, "matrix_rows"), 3, row);
    assert_true(row[0] == 1 && row[1] == 2);
    cJSON_Delete(json);
    json_deck_close(&deck);
}

static double largest_of(int count, const double *x)
{
    double largest = 0;
    for (int i = 0; i < count; i++)
        if (fabs(x[i]) > fabs(largest))
            largest = x[i];
    return largest;
}

UNIT_TEST(without_measured_shapes_the_axis_has_its_largest_deflection_at_one)
{
    static const char *const sensors[] = {"", "*SENSORS\n1, 0.02\n2, 0.5\n"};
    for (int with = 0; with < 2; with++) {
        char text[1024];
        double axis[64], at_sensor[2];
        struct json_deck deck;
        (void)snprintf(text, sizeof text, SHAFT MODES IDENTIFY "%s", sensors[with]);
        json_deck_open(&deck, text);
        cJSON *json = json_deck_identify(&deck, 0);
        const cJSON *shapes = get(json, "shapes");
        int nodes = cJSON_GetArraySize(get(shapes, "axis_z_m"));
        assert_true(cJSON_IsNull(get(json, "nco_matrix")) && cJSON_IsNull(get(json, "mac_matrix")));
        assert_true(!cJSON_GetArraySize(get(json, "matrix_rows")) && !cJSON_GetArraySize(get(json, "matrix_columns")));
        assert_int_equal(cJSON_GetArraySize(get(shapes, "sensor_id")), 2 * with);
        for (int k = 0; k < 3; k++) {
            const cJSON *mode = json_member(shapes, "modes", k);
            json_numbers(get(mode, "predicted_axis"), nodes, axis);
            json_numbers(get(mode, "predicted"), 2 * with, at_sensor);
            assert_close(fabs(largest_of(nodes, axis)), 1, 0, 0); /* of an even mode either end */
            assert_true(cJSON_IsNull(get(mode, "measured")));
        }
        cJSON_Delete(json);
        json_deck_close(&deck);
    }
}

/* ---- members beside the axis */

#define MEMBERS                                                                                                                  \
    SHAFT "*TIEROD, NAME=rods, MATERIAL=steel, FROM=core.start, TO=core.end\n6, 0.008, 0.035, 1e3, 3\n"                          \
          "*TIEROD, NAME=tube, MATERIAL=steel, FROM=0.1, TO=0.8, MODEL=TUBE\n6, 0.008, 0.035, 1e3\n"                             \
          "*BARS, NAME=cage, MATERIAL=steel, CENTER=0.5, LENGTH=0.3\n12, 0.006, 0.045, 4\n"

UNIT_TEST(members_of_a_result_meet_the_axis_where_they_are_fixed)
{
    struct json_deck deck;
    double axis_z[128], axis[128], z[32], shape[32];
    json_deck_open(&deck, MEMBERS "*MODES\n1, 350\n2, 640\n" IDENTIFY);
    cJSON *json = json_deck_identify(&deck, 0);
    const cJSON *shapes = get(json, "shapes");
    int nodes = cJSON_GetArraySize(get(shapes, "axis_z_m"));
    json_numbers(get(shapes, "axis_z_m"), nodes, axis_z);
    for (int k = 0; k < 2; k++) {
        const cJSON *mode = json_member(shapes, "modes", k);
        json_numbers(get(mode, "predicted_axis"), nodes, axis);
        assert_int_equal(cJSON_GetArraySize(get(mode, "tierods")), 2);
        for (int member = 0; member < 3; member++) {
            const cJSON *item = member < 2 ? json_member(mode, "tierods", member) : json_member(mode, "bars", 0);
            static const char *const name[] = {"rods", "tube", "cage"};
            int count = cJSON_GetArraySize(get(item, "z_m")), met = 0;
            assert_string_equal(get(item, "name")->valuestring, name[member]);
            json_numbers(get(item, "z_m"), count, z);
            json_numbers(get(item, "shape"), count, shape);
            for (int node = 0; node < nodes; node++)
                for (int i = 0; i < count; i++)
                    if ((member < 2 ? i == 0 || i == count - 1 : 2 * i == count - 1) && fabs(z[i] - axis_z[node]) < 1e-6) {
                        assert_close(shape[i], axis[node], 1e-7, 1e-9);
                        met++;
                    }
            assert_int_equal(met, member < 2 ? 2 : 1);
        }
    }
    cJSON_Delete(json);
    json_deck_close(&deck);
}

/* ---- the rest of an identification */

/* NLopt ends where Levenberg-Marquardt does, so it predicts the same; the history ends at the result. */
UNIT_TEST(the_baseline_says_what_it_predicts)
{
    struct json_deck deck;
    double hz[3];
    json_deck_open(&deck, noisy_deck(NOISE "*FIT, REDUCTION=IRS, FUNCTIONAL=HYBRID\n", 0));
    cJSON *json = json_deck_identify(&deck, 1);
    int count = cJSON_GetArraySize(get(json, "baseline"));
    assert_true(count > 0 || !WITH_NLOPT);
    for (int i = 0; i < count; i++) {
        json_numbers(get(json_member(json, "baseline", i), "predicted_hz"), 3, hz);
        for (int k = 0; k < 3; k++)
            assert_close(hz[k], number_of(json_member(json, "modes", k), "predicted_hz"), 1e-6, 0);
    }
    assert_close(number_of(json, "bijection_chi"), 0.05, 0, 0);
    int last = cJSON_GetArraySize(get(json, "history")) - 1;
    assert_true(number_of(json_member(json, "history", last), "seconds") <= number_of(json, "seconds"));
    cJSON_Delete(json);
    json_deck_close(&deck);
}

/* ---- size */

/* 2,000 elements, 500 sensors, ten modes with shapes. */
UNIT_TEST(a_large_result_stays_small)
{
    static char text[TEXT];
    struct json_deck deck;
    struct spectrum s;
    struct random_stream stream = {9};
    size_t length = 0;
#define ADD(...) length += (size_t)snprintf(text + length, sizeof text - length, __VA_ARGS__)
    ADD(STEEL "*SHAFT, NAME=left, MATERIAL=steel\n0.5, 0.1, 0, 500\n*SHAFT, NAME=core, MATERIAL=steel\n1, 0.2, 0, 1000\n"
              "*SHAFT, NAME=right, MATERIAL=steel\n0.5, 0.1, 0, 500\n");
    for (int i = 0; i < 500; i++)
        ADD("%s%d, %.3f\n", i ? "" : "*SENSORS\n", i + 1, 0.004 * i);
    json_deck_open(&deck, text);
    assert_status(spectrum_compute(&deck.pool, NULL, &deck.job->rotor, 0, NULL, NULL, ROTID_GUYAN, 10, &s), ROTID_OK);
    ADD("*NOISE, FREQUENCY=0.001, SHAPE=0.02\n" IDENTIFY "*MODES\n");
    for (int k = 0; k < 10; k++)
        ADD("%d, %.9g\n", k + 1, s.full_hz[k] * (1 + 1e-3 * random_normal(&stream)));
    for (int k = 0; k < 10; k++)
        for (int i = 0; i < 500; i++) {
            if (!i)
                ADD("*SHAPE, MODE=%d\n", k + 1);
            ADD("%d, %.6g\n", i + 1, s.shape[i + k * 500] + 0.02 * random_normal(&stream));
        }
    json_deck_close(&deck);
    json_deck_open(&deck, text);
    cJSON *json = json_deck_identify(&deck, 0);
    char *printed = cJSON_Print(json);
    const cJSON *shapes = get(json, "shapes"), *nodes = get(get(json, "geometry"), "nodes_z_m");
    double z[401];
    json_numbers(get(shapes, "axis_z_m"), 401, z);
    for (int i = 1; i < 401; i++)
        assert_true(z[i] > z[i - 1]);
    assert_true(z[0] == 0 && z[400] == 2 && cJSON_GetArraySize(nodes) == 2001);
    print_message("2,001 nodes, 500 sensors, 10 modes: %.0f kB\n", (double)strlen(printed) / 1e3);
    assert_true(strlen(printed) < 500000);
    cJSON_free(printed);
    cJSON_Delete(json);
    json_deck_close(&deck);
}
