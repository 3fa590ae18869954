/* rotid_diagnose: a hidden effect that it names, and the deck that it hands over. */
#include <unistd.h>

#include "api_bench.h"
#include "folder.h"
#include "support.h"

#define LAP ROTID_SOURCE_DIR "/input/brake_reuss_lap.inp"

/* The deck that a diagnosis hands over is the one that the program writes, and it is one. */
UNIT_TEST(the_extended_deck_is_that_of_the_program)
{
    char command[512], *text = calloc(1 << 20, 1);
    rotid_diagnosis *d;
    rotid_deck *deck = bench_deck(LAP);
    char failure[512] = "not touched";
    (void)snprintf(command, sizeof command, "'%s' diagnose '%s' --threads 2 --quiet --extended '%s'", ROTID_PROGRAM, LAP,
                   folder_path("extended.inp"));
    assert_int_equal(system(command), 0);
    assert_status(rotid_diagnose(deck, NULL, NULL, failure, &d), ROTID_OK);
    assert_string_equal(failure, "");
    rotid_deck_free(deck);
    FILE *stream = fopen(folder_path("extended.inp"), "rb");
    assert_non_null(stream);
    assert_true(fread(text, 1, (1 << 20) - 1, stream) > 0);
    (void)fclose(stream);
    assert_string_equal(d->extended_deck, text);
    deck = bench_deck(folder_path("extended.inp"));
    assert_int_equal(deck->nparameter, (d->extended ? d->extended : d->base)->nparameters);
    rotid_deck_free(deck);
    rotid_diagnosis_free(d);
    free(text);
}

/* Why a diagnosis has no deck to hand over is a note of its own: notes with a place are those of reading. Here the table of modes
 * is gone when the deck is read back. */
UNIT_TEST(the_reason_for_no_extended_deck_is_told)
{
    char failure[ROTID_FAILURE_LENGTH];
    rotid_diagnosis *d;
    int told = 0;
    (void)folder_write("modes.csv", "mode,frequency,std\n1,183.39,0.2\n2,501.6,0.5\n3,972.5,1\n");
    const char *path = folder_write("bar.inp", "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=bar, "
                                               "MATERIAL=steel\n1.0, 0.04, 0, 60\n*SENSORS\n1, 0\n2, 0.5\n3, 1.0\n*MODES, "
                                               "FILE=modes.csv\n*IDENTIFY\nbar.E, 1e11, 3e11, 2e11\n");
    rotid_deck *deck = bench_deck(path);
    assert_int_equal(unlink(folder_path("modes.csv")), 0);
    assert_status(rotid_diagnose(deck, NULL, NULL, failure, &d), ROTID_OK);
    assert_non_null(d->verdict.sentence);
    assert_null(d->extended_deck);
    for (int i = 0; i < d->nmessage; i++)
        told |= !d->message[i].file && strstr(d->message[i].text, "would not be read") && strstr(d->message[i].text, "modes.csv");
    assert_true(told);
    rotid_diagnosis_free(d);
    rotid_deck_free(deck);
}

/* Whether `line` [length] stands in the text as a line. */
static int has_line(const char *text, const char *line, size_t length)
{
    for (const char *at = text; *at; at += strcspn(at, "\n"), at += *at == '\n')
        if (strcspn(at, "\n") == length && !strncmp(at, line, length))
            return 1;
    return 0;
}

static char *file_text(const char *path)
{
    char *text = calloc(1 << 20, 1);
    FILE *stream = fopen(path, "rb");
    assert_non_null(stream);
    assert_true(fread(text, 1, (1 << 20) - 1, stream) > 0);
    (void)fclose(stream);
    return text;
}

/* The extended deck has every line of the user's but those that had to change, in its order, and is fitted as the diagnosis was:
 * a suspicion that was named; a mesh that is fine enough; noise that was assumed; measured data in a file. */
UNIT_TEST(the_extended_deck_keeps_the_words_of_the_user)
{
    static const struct {
        const char *deck, *gone[6]; /* beginnings of lines that change */
        int in_file;
    } table[] = {
        {"brake_reuss_lap.inp", {"*FIT", "*CAUSE, NAME=lap, ", "width, 0.12"}, 0},
        {"roving_hammer_beam.inp", {"*FIT", "beam.E", "beam.G"}, 0},
        {"foam_bar_supports.inp", {"*FIT", "bar.E"}, 0},
        {"solid_rotor.inp", {"*FIT", "core.E", "core.G", "*MEASURED"}, 1},
    };
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        char path[512], failure[ROTID_FAILURE_LENGTH];
        (void)snprintf(path, sizeof path, ROTID_SOURCE_DIR "/input/%s", table[i].deck);
        rotid_deck *deck = bench_deck(path);
        rotid_diagnosis *d;
        rotid_identification *fit;
        assert_status(rotid_diagnose(deck, NULL, NULL, failure, &d), ROTID_OK);
        rotid_deck_free(deck);
        char *text = file_text(path);
        int comments = 0;
        for (const char *line = text; *line; line += strcspn(line, "\n"), line += *line == '\n') {
            size_t length = strcspn(line, "\n");
            int goes = !length;
            for (int g = 0; g < 6 && table[i].gone[g]; g++)
                goes |= !strncmp(line, table[i].gone[g], strlen(table[i].gone[g]));
            if (goes)
                continue;
            comments += !strncmp(line, "**", 2);
            if (!has_line(d->extended_deck, line, length))
                print_error("%s lacks: %.*s\n", table[i].deck, (int)length, line);
            assert_true(has_line(d->extended_deck, line, length));
        }
        assert_true(comments > 2);
        assert_true(!table[i].in_file || strstr(d->extended_deck, "FILE=/")); /* it may be read from anywhere */
        free(text);
        /* what it gives is what the diagnosis found */
        const rotid_identification *found = d->extended ? d->extended : d->base;
        FILE *stream = fopen(folder_path("extended.inp"), "wb");
        assert_non_null(stream);
        (void)fputs(d->extended_deck, stream);
        (void)fclose(stream);
        deck = bench_deck(folder_path("extended.inp"));
        assert_status(rotid_identify(deck, 0, NULL, failure, &fit), ROTID_OK);
        rotid_deck_free(deck);
        assert_int_equal(fit->nparameters, found->nparameters);
        for (int p = 0; p < fit->nparameters; p++) {
            double half = (found->parameters[p].ci95[1] - found->parameters[p].ci95[0]) / 2;
            assert_string_equal(fit->parameters[p].name, found->parameters[p].name);
            assert_close(fit->parameters[p].value, found->parameters[p].value, 1e-4, isfinite(half) ? 0.05 * half : 0);
        }
        rotid_identification_free(fit);
        rotid_diagnosis_free(d);
    }
}

static double rms_of_fitted(const rotid_identification *fit)
{
    double sum = 0;
    for (int k = 0; k < fit->nmodes; k++)
        sum += fit->modes[k].error_percent * fit->modes[k].error_percent;
    return sqrt(sum / fit->nmodes);
}

/* What a diagnosis says in two places is the same in both. No mode is held out. */
static void a_diagnosis_agrees_with_its_fits(const rotid_diagnosis *d)
{
    const rotid_identification *fits[2] = {d->base, d->extended};
    const rotid_gain *gain = &d->gain;
    const double chi2[2] = {gain->chi2_per_dof.before, gain->chi2_per_dof.after},
                 rms[2] = {gain->frequency_rms_percent.before, gain->frequency_rms_percent.after};
    for (int f = 0; f < 2; f++) {
        assert_close(chi2[f], fits[f]->chi2_per_dof, 1e-9, 0);
        assert_close(rms[f], rms_of_fitted(fits[f]), 1e-9, 0);
        for (int p = 0; p < fits[f]->nparameters; p++) {
            const rotid_fitted_parameter *is = &fits[f]->parameters[p];
            const rotid_changed_parameter *of = &gain->parameters[p];
            const double *ci95 = f ? of->after_ci95 : of->before_ci95;
            assert_true(!strcmp(of->name, is->name) && !strcmp(of->unit, is->unit));
            assert_true((f ? of->after : of->before) == is->value && ci95[0] == is->ci95[0] && ci95[1] == is->ci95[1]);
        }
    }
    assert_true(gain->frequency_max_percent.before >= rms[0] && gain->frequency_max_percent.after >= rms[1]);
    assert_true(isnan(gain->holdout_frequency_rms_percent.before) && isnan(gain->holdout_shape_rms.after));
    /* what was left out is predicted worse than what was fitted */
    assert_true(gain->mode_out_frequency_rms_percent.after > rms[1]);
    /* The rounds judge on a mesh whose error is below the noise (24 elements), base and extended are fitted once more on one
     * whose error is below a tenth of it (48): on the same mesh both pairs are equal to 1e-9. */
    assert_close(d->rounds[0].chi2, d->base->chi2, 0, 0.2);
    assert_true(d->rounds[0].chi2_frequency < d->rounds[0].chi2 && d->rounds[0].dof == d->base->dof);
    const rotid_candidate *named = &d->candidates[0];
    assert_true(named->round == 1 && named->refitted && !strcmp(named->cause.id, d->verdict.causes[0].id));
    assert_close(named->chi2, d->extended->chi2, 0, 0.2);
    assert_close(named->chi2_drop, d->rounds[0].chi2 - named->chi2, 1e-6, 0);
    assert_true(named->chi2_frequency < named->chi2 && named->probability > 0.95);
}

/* Data made by the library itself from a deck that says what is wrong, given to one that does not. */
/* One mode in each of two states, two moduli: the fit creeps along a valley to the limit of iterations, and the verdict says so.
 */
UNIT_TEST(a_verdict_on_a_fit_that_did_not_end_says_so)
{
    static const char *const text =
        "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.30\n*DENSITY\n7850\n*SHAFT, NAME=a, MATERIAL=steel\n0.3076, 0.100, 0, 40\n"
        "*SHAFT, NAME=b, MATERIAL=steel\n0.2570, 0.050, 0, 40\n*SPRING\nstart, 1.12652e7\n*SPRING\nend, 2.83768e6\n"
        "*SENSORS\n1, 0.31515\n2, 0.37338\n*NOISE, FREQUENCY=0.0001, SHAPE=0.01\n*IDENTIFY\na.E, 1e10, 1e12, 1.8e11\n"
        "b.E, 1e10, 1e12, 1.8e11\n*STATE, NAME=st0\n*MODES\n1, 106.799489901\n*SHAPE, MODE=1\n1, 0.931894\n2, 1.00742\n"
        "*STATE, NAME=st1\n*MODES\n1, 106.807294634\n*SHAPE, MODE=1\n1, 0.937621\n2, 0.987944\n";
    const rotid_diagnose_options options = {.size = sizeof options};
    rotid_deck *deck;
    rotid_diagnosis *d;
    assert_status(rotid_deck_read_text(strlen(text), text, "deck", NULL, 0, NULL, NULL, NULL, &deck), ROTID_OK);
    assert_status(rotid_diagnose(deck, &options, NULL, NULL, &d), ROTID_OK);
    assert_string_equal(d->base->status, "not_converged");
    assert_non_null(strstr(d->verdict.sentence, "The fit ended before a minimum ("));
    rotid_diagnosis_free(d);
    rotid_deck_free(deck);
}

UNIT_TEST(what_was_hidden_is_named)
{
    rotid_diagnosis *d;
    const rotid_diagnose_options options = {.size = sizeof options, .threads = 2};
    bench_hidden_deck(folder_path("deck.inp"), 0.4, 3);
    rotid_deck *deck = bench_deck(folder_path("deck.inp"));
    assert_status(rotid_diagnose(deck, &options, NULL, NULL, &d), ROTID_OK);
    rotid_deck_free(deck);
    assert_int_equal(d->verdict.kind, ROTID_NAMED);
    assert_int_equal(d->verdict.ncauses, 1);
    assert_true(d->verdict.confident);
    assert_string_equal(d->verdict.causes[0].id, "stiffness_gradient");
    assert_string_equal(d->verdict.causes[0].target, "core");
    assert_string_equal(d->verdict.causes[0].parameters[0].name, "slope");
    assert_true(d->verdict.causes[0].parameters[0].ci95[0] < 0.4 && d->verdict.causes[0].parameters[0].ci95[1] > 0.4);
    assert_true(d->verdict.causes[0].parameters[0].std < 0.05);
    assert_true(d->gain.chi2_per_dof.after < 2 && d->gain.chi2_per_dof.before > 5 * d->gain.chi2_per_dof.after);
    assert_int_equal(d->extended->nparameters, 3);
    a_diagnosis_agrees_with_its_fits(d);
    rotid_diagnosis_free(d);
}

static int open_folder(void **state)
{
    set_blas_threads(1); /* the numbers of the program too are those of one */
    return folder_make(state);
}

TEST_GROUP(open_folder, folder_remove);
