/* `rotid frf` on a whole hammer test whose truth is known: records and exact damped accelerances of tools/hammer, which shares
 * nothing with the library. The steel beam is identified from its true frequencies; then the synthesised functions are the exact
 * ones, and those out of the records agree with them. */
#include <cJSON.h>
#include <sys/wait.h>

#include "folder.h"
#include "hammer/hammer.h"
#include "support.h"

#define HIGH 3000.0

static struct hammer_test truth;

/* The deck of the rotor, what a perfect modal analysis would find, and a card FRF. */
static void write_deck(const char *name, const char *card)
{
    FILE *stream = fopen(folder_path(name), "wb");
    assert_non_null(stream);
    (void)fprintf(stream, "%s\n*MODES\n", truth.deck);
    for (int m = truth.rigid; m < truth.modes && truth.bare_hz[m] < HIGH; m++)
        (void)fprintf(stream, "%d, %.12g, %.12g\n", m - truth.rigid + 1, truth.bare_hz[m], hammer_damping(&truth, m));
    (void)fprintf(stream, "*FIT, FUNCTIONAL=HYBRID, REDUCTION=NONE\n%s", card);
    assert_int_equal(fclose(stream), 0);
}

static cJSON *result_of(const char *deck)
{
    char command[1024];
    (void)snprintf(command, sizeof command, "%s frf %s --quiet --json %s", ROTID_PROGRAM, folder_path(deck),
                   folder_path("out.json"));
    int status = system(command); /* NOLINT: a fixed command of the test */
    assert_int_equal(WEXITSTATUS(status), 0);
    FILE *stream = fopen(folder_path("out.json"), "rb");
    assert_non_null(stream);
    size_t room = 1 << 25;
    char *text = calloc(room, 1);
    assert_non_null(text);
    (void)fread(text, 1, room - 1, stream);
    (void)fclose(stream);
    cJSON *json = cJSON_Parse(text);
    free(text);
    assert_true(cJSON_IsObject(json));
    return json;
}

static double number_of(const cJSON *json, const char *key)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(json, key);
    assert_true(cJSON_IsNumber(item));
    return item->valuedouble;
}

static int point_of(double id)
{
    for (int i = 0; i < truth.points; i++)
        if (truth.id[i] == (long)id)
            return i;
    fail();
    return -1;
}

/* Error over the largest magnitude of the function. */
static double worst_of(const cJSON *function)
{
    const cJSON *hz = cJSON_GetObjectItemCaseSensitive(function, "frequency_hz")->child,
                *re = cJSON_GetObjectItemCaseSensitive(function, "synthesised_re")->child,
                *im = cJSON_GetObjectItemCaseSensitive(function, "synthesised_im")->child;
    int point = point_of(number_of(function, "response"));
    double largest = 0, apart = 0;
    for (; hz; hz = hz->next, re = re->next, im = im->next) {
        double complex exact = hammer_frf(&truth, point, I * TWO_PI * hz->valuedouble);
        largest = fmax(largest, cabs(exact));
        apart = fmax(apart, cabs(exact - re->valuedouble - I * im->valuedouble));
    }
    return apart / largest;
}

UNIT_TEST(the_synthesised_functions_are_the_exact_ones)
{
    double worst = 0;
    write_deck("alone.inp", "*FRF, LOW=60, HIGH=3000, STEP=5\n");
    cJSON *json = result_of("alone.inp");
    const cJSON *function;
    cJSON_ArrayForEach(function, cJSON_GetObjectItemCaseSensitive(json, "functions"))
    {
        assert_close(number_of(function, "reference"), (double)truth.id[truth.fixed], 0, 0);
        worst = fmax(worst, worst_of(function));
    }
    print_message("%d functions to %g Hz: %.1e of the peak\n", truth.points, HIGH, worst);
    assert_true(worst < 5e-3);
    cJSON_Delete(json);
}

UNIT_TEST(the_functions_out_of_the_records_agree)
{
    char message[256];
    assert_int_equal(hammer_write(&truth, 7, 0, folder_path("records.unv"), message, sizeof message), HAMMER_OK);
    write_deck("beside.inp", "*FRF, FILE=records.unv, LOW=60, HIGH=1300\n");
    cJSON *json = result_of("beside.inp");
    const cJSON *functions = cJSON_GetObjectItemCaseSensitive(json, "functions"), *function, *mode;
    assert_int_equal(cJSON_GetArraySize(functions), truth.points);
    cJSON_ArrayForEach(function, functions)
    {
        assert_close(number_of(function, "frac"), 1, 1e-3, 0);
        assert_close(number_of(function, "frac_at_measured_frequencies"), 1, 1e-3, 0);
        assert_close(number_of(function, "scale"), 1, 1e-2, 0);
    }
    cJSON_ArrayForEach(mode, cJSON_GetObjectItemCaseSensitive(json, "modes")) if (cJSON_GetObjectItemCaseSensitive(mode, "frac"))
    {
        assert_close(number_of(mode, "frac"), 1, 1e-3, 0);
        assert_close(number_of(mode, "level_db"), 0, 0, 0.2);
        assert_close(number_of(mode, "phase_deg"), 0, 0, 2);
    }
    cJSON_Delete(json);
}

static int open_truth(void **state)
{
    struct hammer_options options = hammer_options_default();
    const char *const *values = NULL;
    char message[256];
    int count = 0;
    char *deck = hammer_rotor_deck("beam", &options, &count, &values);
    int bad = !deck || folder_make(state) ||
              hammer_open(deck, "beam", count, values, 1, &options, &truth, message, sizeof message) != HAMMER_OK;
    free(deck);
    return bad ? -1 : 0;
}

static int close_truth(void **state)
{
    hammer_close(&truth);
    return folder_remove(state);
}

TEST_GROUP(open_truth, close_truth);
