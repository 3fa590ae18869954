/* Pages of diagnoses: for every kind of verdict the page says what the result holds, with numbers that are computed here anew. */
#include <cJSON.h>

#include "hidden.h"
#include "json_value.h"
#include "page/page.h"
#include "page_bench.h"
#include "result/result.h"
#include "support.h"

#define PAPER  ROTID_SOURCE_DIR "/input/paper_rotor.inp"
#define LAP    ROTID_SOURCE_DIR "/input/brake_reuss_lap.inp"
#define BEAM   ROTID_SOURCE_DIR "/input/brake_reuss_beam.inp"
#define RINGED "ringed.inp" /* the paper's rotor with a mass on it that its deck does not say */

static void diagnose(const char *arguments, const char *name)
{
    if (page_exists(name))
        return;
    assert_int_equal(page_run("cd %s; %s diagnose %s --quiet --json %s", page_path(""), ROTID_PROGRAM, arguments, name), 0);
}

static int open_bench(void **state)
{
    char *text = hidden_read(PAPER), *deck = NULL, *truth = NULL, message[300] = "";
    const char *const effect[] = {"added_mass:mass=14,z=1.9"};
    struct hide_request request = hide_request_default();
    if (!text || page_bench_open(state))
        return 1;
    request.deck = text;
    request.name = "paper_rotor.inp";
    request.effect = effect;
    request.effects = 1;
    int status = hide_case(&request, &deck, &truth, message, sizeof message);
    if (!status)
        page_write_file(RINGED, deck);
    free(text);
    free(deck);
    free(truth);
    return status;
}

static const cJSON *element(const cJSON *json, const char *list, int i)
{
    const cJSON *item = cJSON_GetArrayItem(get(json, list), i);
    assert_non_null(item);
    return item;
}

static const char *text_of(const cJSON *json, const char *key)
{
    assert_true(cJSON_IsString(get(json, key)));
    return get(json, key)->valuestring;
}

/* Significant digits as a page shows them, of numbers from 0.001 to a million. */
static const char *digits(double value, int count)
{
    static char text[8][32];
    static int next;
    int whole = (int)floor(log10(value));
    next = (next + 1) % 8;
    (void)snprintf(text[next], sizeof text[next], "%.*f", whole >= count - 1 ? 0 : count - 1 - whole, value);
    return text[next];
}

/* -------------------------------------------------------------------------------------------------------------- verdicts */

/* "2.3 -> 0.10" */
static void says_pair(const char *html, const cJSON *pair)
{
    page_says(html, "<dd class=\"large\">%s \xe2\x86\x92 %s</dd>", digits(number_of(pair, "before"), 2),
              digits(number_of(pair, "after"), 2));
}

POOL_TEST(a_named_cause_is_told_with_its_evidence_and_its_worth)
{
    diagnose(RINGED, "mass.json");
    cJSON *json = page_json("mass.json");
    const cJSON *verdict = get(json, "verdict"), *gain = get(json, "gain");
    const char *html = page_made("mass.json");
    assert_string_equal(text_of(verdict, "kind"), "named");
    page_says(html, "<p class=\"tone\">Named: added mass");
    /* the answer is the sentence of the verdict, in words */
    page_says(html, "<p class=\"says\">%s", plain_text(&test_pool, text_of(verdict, "sentence")));
    page_says(html, "Next: ");
    says_pair(html, get(gain, "frequency_rms_percent"));
    says_pair(html, get(gain, "chi2_per_dof"));
    says_pair(html, get(gain, "mode_out_frequency_rms_percent"));
    const cJSON *first = element(json, "candidates", 0), *e = element(gain, "parameters", 0);
    page_says(html, "<td class=\"n\">%s</td>", digits(number_of(first, "chi2_drop"), 4));
    page_says(html, "\">named");
    page_says(html, "%s by +%.1f\xc2\xa0%%", text_of(e, "name"), 100 * (number_of(e, "after") / number_of(e, "before") - 1));
    static const char *const sections[] = {"trust", "basis", "look", "misfit", "causes", "worth", "limits", "verdict-parameters"};
    for (size_t i = 0; i < sizeof sections / sizeof *sections; i++)
        page_says(html, "<section id=\"%s\">", sections[i]);
    cJSON_Delete(json);
}

/* The answer, its tiles and the table are those of the explanations. */
UNIT_TEST(what_cannot_be_told_apart_has_shares)
{
    diagnose(PAPER, "paper.json");
    cJSON *json = page_json("paper.json");
    const cJSON *verdict = get(json, "verdict"), *e, *averaged = element(json, "parameters", 0);
    const char *html = page_made("paper.json");
    int listed = 0;
    cJSON_ArrayForEach(e, get(verdict, "explanations"))
    {
        char share[64];
        (void)snprintf(share, sizeof share, "<th scope=\"row\" class=\"n\">%.1f</th>", 100 * number_of(e, "probability"));
        page_says(html, "%s", share);
        listed++;
    }
    assert_true(listed > 1);
    page_says(html, "The deck does not state all of the noise");
    page_says(html, "frequencies 0.30\xc2\xa0%% (assumed)");
    page_says(
        html,
        "The fit as the deck states it (HYBRID, reduction GUYAN, 4.3\xc2\xa0%% rms error of its frequencies) gives core.E = "
        "115.7\xc2\xa0GPa");
    page_says(html, "<dd class=\"large\">%.1f</dd>", number_of(averaged, "value") / 1e9);
    page_says(html, "averaged over the explanations by their probabilities");
    cJSON_Delete(json);
}

POOL_TEST(what_nothing_explains_says_so)
{
    diagnose(BEAM, "beam.json");
    cJSON *json = page_json("beam.json");
    const char *html = page_made("beam.json");
    assert_string_equal(text_of(get(json, "verdict"), "kind"), "unexplained");
    page_says(html, "class=\"answer bad\"");
    page_says(html, "<p class=\"tone\">Unexplained: something outside of the catalogue with ");
    page_says(html, "\">possible (");
    cJSON_Delete(json);
}

/* The extended deck of a diagnosis, with two sensors exchanged by a card that would put an exchange right. */
UNIT_TEST(an_adequate_model_and_a_fault_of_the_data_are_told_apart)
{
    assert_int_equal(page_run("cd %s; %s diagnose %s --quiet --extended better.inp", page_path(""), ROTID_PROGRAM, RINGED), 0);
    page_write_file("swapped.inp", "*INCLUDE, FILE=better.inp\n*CAUSE, NAME=cables, TYPE=sensor_swap, SENSOR=\"23,30\"\n");
    diagnose("better.inp", "adequate.json");
    cJSON *json = page_json("adequate.json");
    const char *html = page_made("adequate.json");
    assert_string_equal(text_of(get(json, "verdict"), "kind"), "adequate");
    /* a ring of any size at any place leaves much for others to hide in */
    const cJSON *most = element(json, "hidden", 0), *fitted = element(get(json, "base"), "parameters", 0);
    double percent = 100 * fabs(number_of(most, "shift") / number_of(fitted, "value")), widest = 0;
    assert_string_equal(text_of(most, "parameter"), text_of(fitted, "name"));
    for (int i = 0; i < cJSON_GetArraySize(get(json, "hidden")); i++)
        for (int p = 0; p < cJSON_GetArraySize(get(get(json, "base"), "parameters")); p++) {
            const cJSON *one = element(json, "hidden", i), *of = element(get(json, "base"), "parameters", p);
            if (!strcmp(text_of(one, "parameter"), text_of(of, "name")))
                widest = fmax(widest, 100 * fabs(number_of(one, "shift") / number_of(of, "value")));
        }
    assert_true(percent < 50 && widest > 15);
    page_says(html, "class=\"answer care\"");
    page_says(html, "Adequate; effects below the detection limits may shift %s by up to %.2g %%", text_of(fitted, "name"),
              percent);
    page_says(html, "<section id=\"verdict-parameters\">");
    page_says(html, "<section id=\"hidden\">");
    page_says(html, "The model explains the data within their noise");
    page_says(html, "Next: read the detection limits");
    page_says(html, "Causes that were tried");
    assert_null(strstr(html, "<section id=\"findings\">"));
    const cJSON *size = element(json, "detectable", 0);
    page_says(html, "<section id=\"limits\">");
    page_says(html, "%s", text_of(size, "parameter"));
    cJSON_Delete(json);

    /* the same with a fault, as the result would hold it */
    json = page_json("adequate.json");
    cJSON *fault =
        cJSON_Parse("{\"id\": \"sensor_swap\", \"sensors\": [23, 30], \"modes\": [], \"block\": null, \"value\": null, "
                    "\"unit\": null, \"std\": null, \"chi2_drop\": 942.8, \"text\": \"sensors 23 and 30 are exchanged; they "
                    "are put back\"}");
    assert_non_null(fault);
    cJSON_AddItemToArray(cJSON_GetObjectItem(json, "data_findings"), fault);
    page_write_json("swap.json", json);
    cJSON_Delete(json);
    html = page_made("swap.json");
    page_says(html, "sensor swap: sensors 23 and 30 are exchanged; they are put back");
    page_says(html, "<section id=\"findings\">");
    page_says(html, "At the test: follow the cables of both channels");
}

UNIT_TEST(an_interrupted_diagnosis_says_so_and_shows_what_is_there)
{
    diagnose(RINGED, "mass.json");
    cJSON *json = page_json("mass.json"), *verdict = cJSON_GetObjectItem(json, "verdict");
    static const char *const nulls[] = {"kind", "sentence", "next_measurement"};
    static const char *const empty[] = {"rounds", "candidates", "detectable", "localisation"};
    cJSON_ReplaceItemInObject(json, "interrupted", cJSON_CreateTrue());
    for (size_t i = 0; i < sizeof nulls / sizeof *nulls; i++)
        cJSON_ReplaceItemInObject(verdict, nulls[i], cJSON_CreateNull());
    page_write_json("late.json", json); /* a round was finished, and names a cause */
    const char *html = page_made("late.json");
    page_says(html, "<p class=\"tone\">Interrupted: no verdict</p>");
    page_says(html, "class=\"answer bad\"");
    page_says(html, "A round that was finished would name ");
    assert_null(strstr(html, "<section id=\"worth\">"));

    cJSON_ReplaceItemInObject(verdict, "causes", cJSON_CreateArray());
    cJSON_ReplaceItemInObject(json, "extended", cJSON_CreateNull());
    for (size_t i = 0; i < sizeof empty / sizeof *empty; i++)
        cJSON_ReplaceItemInObject(json, empty[i], cJSON_CreateArray());
    page_write_json("early.json", json); /* after the base model */
    html = page_made("early.json");
    page_says(html, "The finished part stands below");

    cJSON_ReplaceItemInObject(json, "base", cJSON_CreateNull());
    cJSON_ReplaceItemInObject(json, "today", cJSON_CreateNull());
    cJSON_ReplaceItemInObject(json, "modes_standardised", cJSON_CreateArray());
    page_write_json("first.json", json); /* before it */
    html = page_made("first.json");
    page_says(html, "there is nothing to judge yet");
    cJSON_Delete(json);

    /* a real one, wherever the signal happens to arrive */
    (void)page_run("cd %s; timeout -s INT 0.2 %s diagnose %s --quiet --json cut.json", page_path(""), ROTID_PROGRAM, RINGED);
    if (page_exists("cut.json"))
        (void)page_made("cut.json");
}

UNIT_TEST(a_result_that_lacks_something_says_what)
{
    diagnose(RINGED, "mass.json");
    cJSON *json = page_json("mass.json");
    cJSON_DeleteItemFromObject(json, "geometry");
    page_write_json("old.json", json);
    const char *html = page_made("old.json");
    page_says(html, "Not shown: the drawing of the rotor and the places of the causes on it.");
    page_says(html, "has no key &quot;geometry&quot;");
    static const char *const needed[] = {"verdict", "rounds",       "candidates",  "gain",
                                         "sensors", "localisation", "detectable",  "modes_standardised",
                                         "base",    "extended",     "interrupted", "data_findings"};
    for (size_t i = 0; i < sizeof needed / sizeof *needed; i++) {
        cJSON *item = cJSON_DetachItemFromObject(json, needed[i]);
        char says[64];
        page_write_json("lacks.json", json);
        assert_int_equal(page_run("cd %s; %s report lacks.json -o lacks", page_path(""), ROTID_PROGRAM), 2);
        (void)snprintf(says, sizeof says, "lacks.json: %s: is missing", needed[i]);
        assert_non_null(strstr(page_err, says));
        assert_false(page_exists("lacks"));
        cJSON_AddItemToObject(json, needed[i], item);
    }
    cJSON *explanation = cJSON_GetArrayItem(cJSON_GetObjectItem(cJSON_GetObjectItem(json, "verdict"), "explanations"), 0);
    cJSON_ReplaceItemInObject(explanation, "probability", cJSON_CreateNumber(1000));
    page_write_json("lacks.json", json);
    assert_int_equal(page_run("cd %s; %s report lacks.json -o lacks", page_path(""), ROTID_PROGRAM), 2);
    assert_non_null(strstr(page_err, "verdict.explanations[0].probability: is 1000"));
    cJSON_Delete(json);
}

UNIT_TEST(places_are_found_on_the_rotor)
{
    rotid_group group[] = {{.name = "left", .from_m = 0, .to_m = 0.5}, {.name = "core", .from_m = 0.5, .to_m = 1.2}};
    rotid_spring spring[] = {{.name = "sling", .z_m = 0.1}, {.name = NULL, .z_m = 1.1}};
    rotid_tierods ties[] = {{.name = NULL, .from_m = 0, .to_m = 1}, {.name = "ties", .from_m = 0.4, .to_m = 1.3}};
    const rotid_geometry geometry = {
        .length_m = 1.2, .ngroups = 2, .nsprings = 2, .ntierods = 2, .groups = group, .springs = spring, .tierods = ties};
    rotid_cause_value value[] = {
        {"mass", "kg", 3, 1, {1, 5}, 0}, {"z", "m", 0.9, 0.025, {0.85, 0.95}, 0}, {"width", "m", 0.05, NAN, {NAN, NAN}, 1}};
    static const struct {
        const char *target;
        int nvalue, found;
        double from, to;
    } cases[] = {{"", 2, 1, 0.9, 0.9},      {"", 3, 1, 0.85, 0.95},       {"core", 1, 1, 0.5, 1.2}, {"left|core", 1, 1, 0.5, 0.5},
                 {"sling", 1, 1, 0.1, 0.1}, {"at 1.1 m", 1, 1, 1.1, 1.1}, {"ties", 1, 1, 0.4, 1.3}, {"cor", 1, 0, 0, 0},
                 {"", 1, 0, 0, 0},          {"core2", 1, 0, 0, 0}};
    struct cause_place place;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const rotid_cause cause = {.id = "any", .target = cases[i].target, .nparameters = cases[i].nvalue, .parameters = value};
        assert_int_equal(cause_place(&geometry, &cause, &place), cases[i].found);
        if (!cases[i].found)
            continue;
        assert_close(place.from, cases[i].from, 1e-12, 0);
        assert_close(place.to, cases[i].to, 1e-12, 0);
        assert_int_equal(isfinite(place.ci[0]) != 0, cases[i].nvalue >= 2);
    }
    const rotid_cause ring = {.id = "added_mass", .target = "", .nparameters = 2, .parameters = value};
    assert_false(cause_place(NULL, &ring, &place));
}

TEST_GROUP(open_bench, page_bench_close);
