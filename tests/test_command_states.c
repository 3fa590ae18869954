/* Commands on a deck of several states: every state in turn, as the deck of that state alone has it; what is fitted is so over
 * all of them. */
#include "support.h"

#include "folder.h"
#include "page/page.h"
#include "shell.h"

#define DECK                                                                                                                     \
    "*HEADING\nstrip\n*MATERIAL, NAME=alu\n*ELASTIC\n70e9, 0.33\n*DENSITY\n2700\n*BEAM, NAME=strip, MATERIAL=alu\n"              \
    "0.30, 0.002, 0.050, 12\n*SPRING, NAME=clamp\nstart, 1e9, 1e7\n*SENSORS\n1, 0.15\n2, end\n"                                  \
    "*DISK, NAME=tip\nend, 0.005\n*NOISE, FREQUENCY=0.02\n*FRF, DAMPING=0.01, LINES=40\n*IDENTIFY\nstrip.E, 2e10, 2e11, "        \
    "7e10\n"                                                                                                                     \
    "*STATE, NAME=short\n*MODES\n1, 16.49333\n2, 107.6\n*IDENTIFY\ntip.mass, 1e-6, 0.05, 0.005\n*STATE, NAME=long "              \
    "one\n*SET\nstrip.length, 0.4\n"                                                                                             \
    "*MODES\n1, 9.383333\n2, 61.53667\n*IDENTIFY\ntip.mass, 1e-6, 0.05, 0.004\n"

static const char *const states[] = {"short", "long one"};

static const char *deck(void)
{
    return folder_write("states.inp", DECK);
}

/* What a command finds, as its JSON gives it back. */
static struct result run(const char *command, const char *options)
{
    struct message_list messages;
    struct result result;
    const char *json = folder_path("result.json");
    (void)shell(&test_pool, "%s %s %s %s --json %s", ROTID_PROGRAM, command, deck(), options, json);
    message_open(&messages, &test_pool);
    assert_status(page_result_read(&test_pool, json, &messages, &result), ROTID_OK);
    cJSON_Delete(result.json);
    result.json = NULL;
    return result;
}

static struct result alone(const char *command, int state)
{
    return run(command, pool_format(&test_pool, "--set 'FIT.STATE=%s'", states[state]));
}

static void assert_named(const struct result *result)
{
    assert_int_equal(result->nstates, 2);
    for (int s = 0; s < 2; s++)
        assert_string_equal(result->states[s].name, states[s]);
}

POOL_TEST(modes_are_those_of_each_state)
{
    struct result all = run("modes", "");
    assert_named(&all);
    for (int s = 0; s < 2; s++) {
        struct result one = alone("modes", s);
        assert_int_equal(one.nstates, 0);
        assert_int_equal(all.states[s].modes->nmodes, one.modes->nmodes);
        for (int j = 0; j < one.modes->nmodes; j++) {
            assert_close(all.states[s].modes->modes[j].full_hz, one.modes->modes[j].full_hz, 1e-14, 0);
            assert_int_equal(all.states[s].modes->modes[j].measured != NULL, one.modes->modes[j].measured != NULL);
        }
        assert_close(all.states[s].modes->geometry->length_m, s ? 0.4 : 0.3, 1e-12, 0);
    }
    assert_close(all.modes->modes[0].full_hz, all.states[0].modes->modes[0].full_hz, 1e-14, 0); /* beside: the first */
}

POOL_TEST(check_tells_of_each_state)
{
    struct result all = run("check", "");
    assert_named(&all);
    for (int s = 0; s < 2; s++) {
        struct result one = alone("check", s);
        assert_close(all.states[s].check->mass_kg, one.check->mass_kg, 1e-14, 0);
        assert_close(all.states[s].check->mass_kg, (s ? 0.4 : 0.3) * 0.002 * 0.05 * 2700 + 0.005, 1e-12, 0);
        assert_int_equal(all.states[s].check->nparameters, 2);
    }
}

POOL_TEST(sensitivity_is_that_of_each_state)
{
    struct result all = run("sensitivity", "");
    assert_named(&all);
    for (int s = 0; s < 2; s++) {
        struct result one = alone("sensitivity", s);
        const struct sensitivity *a = all.states[s].sensitivity, *b = one.sensitivity;
        assert_int_equal(a->nparameters, 2);
        for (int p = 0; p < 2; p++)
            for (int k = 0; k < 2; k++)
                assert_close(a->parameters[p].derivative[k], b->parameters[p].derivative[k], 1e-12, 0);
    }
    assert_string_equal(all.states[1].sensitivity->parameters[1].name, "long one:tip.mass");
    all = run("sensitivity", "--at strip.rho");
    assert_string_equal(all.states[1].sensitivity->parameters[0].name, "strip.rho");
}

/* Both states at the modulus of the fit over both, and each with its own unknowns. */
POOL_TEST(functions_are_synthesised_at_the_fit_of_all)
{
    struct result all = run("frf", ""), fit = run("identify", "--no-baseline"), one = run("frf", "--state 'Long one'");
    assert_named(&all);
    assert_int_equal(fit.identify->nparameters, 3);
    for (int s = 0; s < 2; s++) {
        const struct transfer_result *frf = all.states[s].frf;
        assert_int_equal(frf->nparameters, 2);
        assert_close(frf->parameters[0].value, fit.identify->parameters[0].value, 1e-10, 0);
        assert_close(frf->parameters[1].value, fit.identify->parameters[1 + s].value, 1e-10, 0);
        assert_close(frf->modes[0].model_hz, fit.identify->states[s].modes[0].predicted_hz, 1e-9, 0);
    }
    assert_int_equal(one.nstates, 1);
    assert_string_equal(one.states[0].name, "long one");
    assert_close(one.frf->parameters[1].value, all.states[1].frf->parameters[1].value, 1e-12, 0);
    assert_close(one.frf->functions[1].synthesised_re[7], all.states[1].frf->functions[1].synthesised_re[7], 1e-12, 0);
}

static const char *refused(const char *arguments)
{
    const char *output;
    assert_int_equal(shell_code(&test_pool, &output, "%s %s", ROTID_PROGRAM, arguments), 2);
    return output;
}

/* A file holds one state. */
POOL_TEST(files_are_of_one_state)
{
    const char *at = deck(), *out = folder_path("model");
    (void)shell(&test_pool, "%s export %s --format matrix-market --state 'long one' -o %s", ROTID_PROGRAM, at, out);
    assert_non_null(strstr(shell(&test_pool, "cat %s.mass.mtx; rm %s.*", out, out), "strip.E"));
    assert_non_null(
        strstr(refused(pool_format(&test_pool, "export %s --format dmig -o %s", at, out)),
               ":1:1: the deck has 2 states and a file holds the model of one, expected --state short or another one\n"));
    assert_non_null(strstr(refused(pool_format(&test_pool, "frf %s -o %s", at, out)),
                           "--output:1:1: a universal file has no states and the deck has 2, expected --state short or "
                           "another one beside it\n"));
    assert_non_null(strstr(refused(pool_format(&test_pool, "frf %s --state x", at)),
                           "--state:1:1: state x is not defined, expected one of short, long one\n"));
    assert_non_null(strstr(refused(pool_format(&test_pool, "sensitivity %s --at strip.E=8e10,strip.E", at)),
                           "--at:1:14: strip.E is named twice, expected once"));
    assert_non_null(strstr(refused(pool_format(&test_pool, "sensitivity %s --at strip.E,clamp.x", at)),
                           "--at:1:9: clamp.x is no parameter of this deck, expected one of clamp.k, "));
}

POOL_TEST(tables_name_their_state)
{
    static const char *const commands[] = {"modes", "check", "sensitivity", "frf"};
    for (size_t i = 0; i < sizeof commands / sizeof *commands; i++) {
        const char *text = shell(&test_pool, "%s %s %s", ROTID_PROGRAM, commands[i], deck()),
                   *first = strstr(text, "state short\n"), *second = strstr(text, "\nstate long one\n");
        assert_true(first && second && first < second);
    }
    const char *text = shell(&test_pool, "%s identify --no-baseline %s", ROTID_PROGRAM, deck()),
               *table = strstr(text, "\nStates: ");
    assert_true(table && strstr(table, "\nshort ") && strstr(table, "\nlong one "));
}

TEST_GROUP(folder_make, folder_remove);
