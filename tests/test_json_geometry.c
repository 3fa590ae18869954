/* The geometry in a result is the deck's, at the values of the model that the result is of. */
#include "support.h"

#include "json_deck.h"

#define STEEL "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n"
#define FULL                                                                                                                     \
    STEEL "*MATERIAL, NAME=sheets\n*ELASTIC, TYPE=SHEAR\n6e10, 3e10, 0.28\n*DENSITY\n7650\n"                                     \
          "*SHAFT, NAME=left, MATERIAL=steel\n0.3, 0.2, 0.02, 4\n0.2, 0.3, 0, 3, 0.25\n"                                         \
          "*SHAFT, NAME=core, MATERIAL=sheets\n0.5, 0.4, 0, 9\n"                                                                 \
          "*BEAM, NAME=tail, MATERIAL=steel\n0.4, 0.11, 0.07, 5\n"                                                               \
          "*PERFORATION, GROUP=core\n8, 0.02, 0.12\n"                                                                            \
          "*PRELOAD, GROUP=core\n-4e3\n"                                                                                         \
          "*TIEROD, NAME=ties, MATERIAL=steel, FROM=core.start, TO=core.end\n12, 0.015, 0.15, 9e3, 3\n"                          \
          "*TIEROD, NAME=few, MATERIAL=steel, FROM=0.1, TO=core.end, MODEL=TUBE, SELF_EQUILIBRATED=NO\n4, 0.02, 0.05, 0\n"       \
          "*BARS, NAME=cage, MATERIAL=steel, CENTER=0.75, LENGTH=0.6, MODEL=TUBE\n20, 0.01, 0.18, 6\n"                           \
          "*DISK, NAME=fan\n1.3, 4, 0.02, 0.03\n*DISK\n0.05, 1\n"                                                                \
          "*SPRING, NAME=mount\n0.15, 2e4, 30\n*SPRING\nend, 1e3\n*SLING, LENGTH=0.8\n"                                          \
          "*SENSORS\n7, 1.25\n3, 0.1\n5, 0.6\n"                                                                                  \
          "*CAUSE, NAME=crack, TYPE=stiffness_local, SHAPE=BOX\ndepth, 0.3\nz, core.start\nwidth, 0.05\n"                        \
          "*CAUSE, NAME=gap, TYPE=joint, BETWEEN=left,core\nflexibility, 1e-10\n"                                                \
          "*CAUSE, NAME=box, TYPE=accelerometer_mass, SENSOR=5, MOUNT=FIXED\nmass, 0.04\n"

static int is_text(const cJSON *object, const char *key, const char *text)
{
    const cJSON *item = get(object, key);
    return text ? cJSON_IsString(item) && !strcmp(item->valuestring, text) : cJSON_IsNull(item);
}

struct number {
    const char *key;
    double value; /* NaN: null */
};

/* To the digits that are promised. */
static void has(const cJSON *object, size_t count, const struct number *number)
{
    for (size_t i = 0; i < count; i++)
        if (isnan(number[i].value))
            assert_true(cJSON_IsNull(get(object, number[i].key)));
        else
            assert_close(number_of(object, number[i].key), number[i].value, 1e-9, 0);
}

#define HAS(object, ...)                                                                                                         \
    has((object), sizeof((struct number[]){__VA_ARGS__}) / sizeof(struct number), (struct number[]){__VA_ARGS__})

UNIT_TEST(groups_have_the_sections_and_materials_of_their_cards)
{
    struct json_deck deck;
    json_deck_open(&deck, FULL);
    cJSON *json = json_deck_check(&deck);
    const cJSON *geometry = get(json, "geometry"), *left = json_member(geometry, "groups", 0),
                *core = json_member(geometry, "groups", 1), *tail = json_member(geometry, "groups", 2);
    HAS(geometry, {"length_m", 1.4}, {"sling_m", 0.8});
    assert_int_equal(cJSON_GetArraySize(get(geometry, "groups")), 3);
    assert_true(is_text(left, "name", "left") && is_text(core, "name", "core") && is_text(tail, "name", "tail"));
    HAS(left, {"from_m", 0}, {"to_m", 0.5}, {"preload_n", 0});
    HAS(get(left, "material"), {"e_pa", 2.1e11}, {"g_pa", 2.1e11 / 2.6}, {"nu", 0.3}, {"rho_kg_m3", 7850});
    assert_true(is_text(get(left, "material"), "name", "steel") && cJSON_IsNull(get(left, "perforation")));
    assert_int_equal(cJSON_GetArraySize(get(left, "segments")), 2);
    HAS(json_member(left, "segments", 0), {"from_m", 0}, {"to_m", 0.3}, {"elements", 4}, {"outer_m", 0.2}, {"inner_m", 0.02},
        {"stiff_outer_m", NAN});
    HAS(json_member(left, "segments", 1), {"from_m", 0.3}, {"to_m", 0.5}, {"elements", 3}, {"outer_m", 0.3}, {"inner_m", 0},
        {"stiff_outer_m", 0.25});
    HAS(core, {"from_m", 0.5}, {"to_m", 1}, {"preload_n", -4e3});
    HAS(get(core, "material"), {"e_pa", 6e10}, {"g_pa", 3e10}, {"nu", 0.28}, {"rho_kg_m3", 7650});
    HAS(get(core, "perforation"), {"number", 8}, {"hole_diameter_m", 0.02}, {"pitch_radius_m", 0.12});
    HAS(json_member(tail, "segments", 0), {"from_m", 1}, {"to_m", 1.4}, {"height_m", 0.11}, {"width_m", 0.07}, {"elements", 5});
    assert_null(cJSON_GetObjectItemCaseSensitive(json_member(tail, "segments", 0), "outer_m"));
    cJSON_Delete(json);
    json_deck_close(&deck);
}

/* Layers stand behind the groups of the axis, with the sections of their host. */
UNIT_TEST(layers_are_groups_with_rings_and_sheets)
{
    struct json_deck deck;
    json_deck_open(&deck, STEEL "*MATERIAL, NAME=sheets\n*ELASTIC, TYPE=LAMINATED\n1.5e10, 0.7e10, 2.1e11, 0.28, 0.97\n"
                                "*DENSITY\n7650\n*SHAFT, NAME=left, MATERIAL=steel\n0.3, 0.1, 0, 4\n"
                                "*SHAFT, NAME=core, MATERIAL=steel\n0.5, 0.2, 0, 9\n0.2, 0.25, 0, 3\n"
                                "*LAYER, NAME=stack, GROUP=core, MATERIAL=sheets\n0.4, 0.2\n0.45, 0.25\n");
    cJSON *json = json_deck_check(&deck);
    const cJSON *geometry = get(json, "geometry"), *core = json_member(geometry, "groups", 1),
                *stack = json_member(geometry, "groups", 2);
    assert_int_equal(cJSON_GetArraySize(get(geometry, "groups")), 3);
    assert_null(cJSON_GetObjectItemCaseSensitive(core, "layer_of"));
    assert_null(cJSON_GetObjectItemCaseSensitive(get(core, "material"), "sheet_e_pa"));
    assert_true(is_text(stack, "name", "stack") && is_text(stack, "layer_of", "core"));
    HAS(stack, {"from_m", 0.3}, {"to_m", 1});
    HAS(get(stack, "material"), {"e_pa", 1.5e10}, {"g_pa", 0.7e10}, {"nu", 0.28}, {"sheet_e_pa", 2.1e11}, {"stacking", 0.97});
    assert_int_equal(cJSON_GetArraySize(get(stack, "segments")), 2);
    HAS(json_member(stack, "segments", 1), {"from_m", 0.8}, {"to_m", 1}, {"elements", 3}, {"outer_m", 0.45}, {"inner_m", 0.25});
    cJSON_Delete(json);
    json_deck_close(&deck);
}

UNIT_TEST(what_is_attached_stands_where_the_deck_has_it)
{
    struct json_deck deck;
    json_deck_open(&deck, FULL);
    cJSON *json = json_deck_check(&deck);
    const cJSON *geometry = get(json, "geometry"), *ties = json_member(geometry, "tierods", 0),
                *few = json_member(geometry, "tierods", 1), *cage = json_member(geometry, "bars", 0);
    HAS(ties, {"from_m", 0.5}, {"to_m", 1}, {"number", 12}, {"diameter_m", 0.015}, {"pitch_radius_m", 0.15}, {"elements", 3},
        {"tension_n", 9e3});
    assert_true(is_text(ties, "name", "ties") && is_text(ties, "model", "RODS") && cJSON_IsTrue(get(ties, "self_equilibrated")));
    HAS(few, {"from_m", 0.1}, {"to_m", 1}, {"number", 4}, {"tension_n", 0}, {"elements", 1});
    assert_true(is_text(few, "model", "TUBE") && cJSON_IsFalse(get(few, "self_equilibrated")));
    HAS(cage, {"from_m", 0.45}, {"to_m", 1.05}, {"center_m", 0.75}, {"number", 20}, {"diameter_m", 0.01},
        {"pitch_radius_m", 0.18}, {"elements", 6});
    HAS(get(cage, "material"), {"e_pa", 2.1e11}, {"rho_kg_m3", 7850});
    HAS(json_member(geometry, "disks", 0), {"z_m", 1.3}, {"mass_kg", 4}, {"diametral_kg_m2", 0.02}, {"polar_kg_m2", 0.03});
    assert_true(is_text(json_member(geometry, "disks", 0), "name", "fan") &&
                is_text(json_member(geometry, "disks", 1), "name", NULL));
    HAS(json_member(geometry, "springs", 0), {"z_m", 0.15}, {"lateral_n_m", 2e4}, {"rotational_nm_rad", 30});
    HAS(json_member(geometry, "springs", 1), {"z_m", 1.4}, {"lateral_n_m", 1e3}, {"rotational_nm_rad", 0});
    assert_true(is_text(json_member(geometry, "springs", 1), "name", NULL));
    static const double sensor[3][2] = {{3, 0.1}, {5, 0.6}, {7, 1.25}};
    assert_int_equal(cJSON_GetArraySize(get(geometry, "sensors")), 3);
    for (int s = 0; s < 3; s++) {
        assert_close(number_of(json_member(geometry, "sensors", s), "id"), sensor[s][0], 0, 0);
        assert_close(number_of(json_member(geometry, "sensors", s), "z_m"), sensor[s][1], 1e-9, 0);
    }
    cJSON_Delete(json);
    json_deck_close(&deck);
}

/* (44) with the mass and the centre that the same result states */
UNIT_TEST(a_sling_appears_as_its_two_springs)
{
    struct json_deck deck;
    json_deck_open(&deck, FULL);
    cJSON *json = json_deck_check(&deck);
    const cJSON *geometry = get(json, "geometry"), *start = json_member(geometry, "springs", 2),
                *end = json_member(geometry, "springs", 3);
    double weight = 9.81 * number_of(json, "mass_kg"), centre = number_of(json, "center_of_mass_m"), length = 1.4, sling = 0.8;
    assert_int_equal(cJSON_GetArraySize(get(geometry, "springs")), 4);
    assert_close(number_of(start, "lateral_n_m"), weight / sling, 1e-12, 0);
    assert_close(number_of(end, "lateral_n_m"), weight * centre / (length * length + centre * sling), 1e-12, 0);
    assert_close(number_of(start, "z_m"), 0, 0, 0);
    assert_close(number_of(end, "z_m"), length, 1e-9, 0);
    cJSON_Delete(json);
    json_deck_close(&deck);
}

UNIT_TEST(causes_of_the_model_name_their_targets)
{
    struct json_deck deck;
    json_deck_open(&deck, FULL "*CAUSE, NAME=guess, TYPE=density, GROUP=core, SUSPECT\n"); /* no part of the model */
    cJSON *json = json_deck_check(&deck);
    const cJSON *geometry = get(json, "geometry"), *crack = json_member(geometry, "causes", 0),
                *gap = json_member(geometry, "causes", 1), *box = json_member(geometry, "causes", 2);
    assert_int_equal(cJSON_GetArraySize(get(geometry, "causes")), 3);
    assert_true(is_text(crack, "name", "crack") && is_text(crack, "id", "stiffness_local") && is_text(crack, "target", "") &&
                is_text(crack, "variant", "BOX"));
    assert_true(is_text(gap, "id", "joint") && is_text(gap, "target", "left|core") && is_text(gap, "variant", NULL));
    assert_true(is_text(box, "id", "accelerometer_mass") && is_text(box, "target", "") && is_text(box, "variant", "FIXED"));
    HAS(box, {"sensor", 5});
    assert_true(cJSON_IsNull(get(gap, "sensor")));
    static const char *const name[] = {"depth", "z", "width"};
    static const double value[] = {0.3, 0.5, 0.05};
    for (int p = 0; p < 3; p++) {
        assert_true(is_text(json_member(crack, "parameters", p), "name", name[p]));
        assert_true(is_text(json_member(crack, "parameters", p), "unit", p ? "m" : "1"));
        assert_close(number_of(json_member(crack, "parameters", p), "value"), value[p], 1e-14, 0);
    }
    HAS(json_member(gap, "parameters", 0), {"value", 1e-10});
    cJSON_Delete(json);
    json_deck_close(&deck);
}

UNIT_TEST(the_nodes_are_those_of_the_mesh)
{
    static const double wanted[] = {0, 0.05, 0.1, 0.15, 0.3, 0.5, 0.6, 0.75, 1, 1.25, 1.3, 1.4}; /* ends and what is attached */
    double z[64], reach = 0.01 * 0.4 / 5;                                                        /* of the longest element */
    struct json_deck deck;
    json_deck_open(&deck, FULL);
    cJSON *json = json_deck_check(&deck);
    int count = (int)number_of(json, "nodes");
    json_numbers(get(get(json, "geometry"), "nodes_z_m"), count, z);
    for (int i = 1; i < count; i++)
        assert_true(z[i] > z[i - 1]);
    for (size_t w = 0; w < sizeof wanted / sizeof *wanted; w++) {
        double nearest = INFINITY;
        for (int i = 0; i < count; i++)
            nearest = fmin(nearest, fabs(z[i] - wanted[w]));
        assert_true(nearest <= reach);
    }
    assert_true(count >= 4 + 3 + 9 + 5 + 1 && z[0] == 0);
    cJSON_Delete(json);
    json_deck_close(&deck);
}

#define MODES "*MODES\n1, 383\n2, 640\n3, 1690\n"
#define SHAFT                                                                                                                    \
    STEEL "*SHAFT, NAME=left, MATERIAL=steel\n0.3, 0.05, 0, 6\n*SHAFT, NAME=core, MATERIAL=steel\n0.4, 0.1, 0.02, 8\n"           \
          "*SHAFT, NAME=right, MATERIAL=steel\n0.3, 0.05, 0, 6\n"

/* E of the isotropic core moves, and its G with it; the other groups of the same material keep theirs. */
UNIT_TEST(an_identified_model_has_the_identified_values)
{
    struct json_deck deck;
    json_deck_open(&deck, SHAFT MODES "*SPRING, NAME=mount\nstart, 1e4\n*IDENTIFY\ncore.E, 1e9, 1e12, 1.7e11\n"
                                      "mount.k, 1e3, 1e6, 2e4\n");
    cJSON *json = json_deck_identify(&deck, 0);
    const cJSON *geometry = get(json, "geometry");
    double e = number_of(json_member(json, "parameters", 0), "value"), k = number_of(json_member(json, "parameters", 1), "value");
    assert_true(fabs(e / 1.7e11 - 1) > 0.01 && fabs(k / 2e4 - 1) > 0.01);
    const cJSON *core = get(json_member(geometry, "groups", 1), "material");
    assert_close(number_of(core, "e_pa"), e, 1e-15, 0);
    assert_close(number_of(core, "g_pa"), e / 2.6, 1e-15, 0);
    assert_close(number_of(get(json_member(geometry, "groups", 0), "material"), "e_pa"), 2.1e11, 0, 0);
    assert_close(number_of(json_member(geometry, "springs", 0), "lateral_n_m"), k, 1e-15, 0);
    assert_int_equal(cJSON_GetArraySize(get(geometry, "sensors")), 0);
    assert_true(cJSON_IsNull(get(geometry, "sling_m")));
    cJSON_Delete(json);
    json_deck_close(&deck);
}

UNIT_TEST(references_of_the_heading_come_along)
{
    struct json_deck deck;
    double value[3];
    json_deck_open(&deck, "*HEADING\na rotor\npaper error_percent = 1.5, -2, 3e-4\n" SHAFT);
    cJSON *json = json_deck_check(&deck);
    const cJSON *reference = json_member(json, "references", 0);
    assert_true(is_text(reference, "quantity", "error_percent"));
    json_numbers(get(reference, "values"), 3, value);
    assert_true(value[0] == 1.5 && value[1] == -2 && value[2] == 3e-4);
    assert_int_equal(cJSON_GetArraySize(get(json, "references")), 1);
    cJSON_Delete(json);
    json_deck_close(&deck);
}
