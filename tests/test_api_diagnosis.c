/* rotid_diagnose: every list of its result as the program gives it, and a hidden effect that it names. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "api_bench.h"
#include "api_program.h"

#define PAPER ROTID_SOURCE_DIR "/input/paper_rotor.inp"
#define SOLID ROTID_SOURCE_DIR "/input/solid_rotor.inp"

static char directory[] = "/tmp/test_api_diagnosis_XXXXXX", deck_path[64], extended_path[64];

static void compare_cause(const cJSON *json, const rotid_cause *c)
{
    const cJSON *item;
    int v = 0;
    assert_json_text(json, "id", c->id);
    assert_json_text(json, "target", c->target);
    if (!cJSON_IsNull(get(json, "name"))) /* the program has none for noise_level */
        assert_json_text(json, "name", c->name);
    assert_json_text(json, "variant", c->variant);
    cJSON_ArrayForEach(item, get(json, "parameters"))
    {
        assert_json_text(item, "name", c->value[v].name);
        assert_json_text(item, "unit", c->value[v].unit);
        assert_json_number(item, "value", c->value[v].value);
        assert_json_number(item, "std", c->value[v].std);
        assert_int_equal(cJSON_IsTrue(get(item, "fixed")), c->value[v++].fixed);
    }
    assert_int_equal(v, c->nvalue);
}

static void compare_candidates(const cJSON *json, const rotid_diagnosis *d)
{
    const cJSON *item;
    int i = 0;
    cJSON_ArrayForEach(item, get(json, "candidates"))
    {
        const rotid_cause *c = &d->candidate[i++];
        assert_true(i <= d->ncandidate);
        compare_cause(item, c);
        assert_int_equal(number_of(item, "round"), c->round);
        assert_int_equal(cJSON_IsTrue(get(item, "refitted")), c->refitted);
        assert_json_number(item, "chi2", c->chi2);
        assert_json_number(item, "chi2_drop", c->chi2_drop);
        assert_json_number(item, "bic", c->bic);
        assert_json_number(item, "holdout_rms", c->holdout_rms);
        assert_json_number(item, "mode_out_rms", c->mode_out_rms);
        assert_json_number(item, "sensor_out_rms", c->sensor_out_rms);
        assert_json_number(item, "predicted_drop", c->predicted_drop);
        assert_json_number(item, "p_value", c->p_value);
        assert_json_number(item, "cosine", c->cosine);
        assert_int_equal(cJSON_IsTrue(get(item, "at_bound")), c->at_bound);
        assert_json_text(item, "collinear_with", c->collinear_with);
        assert_json_text(item, "rejected_because", c->rejected_because);
    }
    assert_int_equal(i, d->ncandidate);
}

static void compare_gain(const cJSON *gain, const rotid_quality *q, const char *state)
{
    assert_json_number(get(gain, "frequency_rms_percent"), state, q->frequency_rms_percent);
    assert_json_number(get(gain, "frequency_max_percent"), state, q->frequency_max_percent);
    assert_json_number(get(gain, "shape_rms"), state, q->shape_rms);
    assert_json_number(get(gain, "chi2_per_dof"), state, q->chi2_per_dof);
    assert_json_number(get(gain, "nco_min"), state, q->nco_min);
    assert_json_number(get(gain, "holdout_frequency_rms_percent"), state, q->holdout_frequency_rms_percent);
    assert_json_number(get(gain, "holdout_shape_rms"), state, q->holdout_shape_rms);
    assert_json_number(get(gain, "mode_out_frequency_rms_percent"), state, q->mode_out_frequency_rms_percent);
    assert_json_number(get(gain, "mode_out_shape_rms"), state, q->mode_out_shape_rms);
    assert_json_number(get(gain, "sensor_out_shape_rms"), state, q->sensor_out_shape_rms);
}

static void compare_lists(const cJSON *json, const rotid_diagnosis *d)
{
    const cJSON *item;
    int i = 0;
    cJSON_ArrayForEach(item, get(json, "detectable"))
    {
        const rotid_detectable *f = &d->detectable[i++];
        assert_json_text(item, "id", f->id);
        assert_json_text(item, "target", f->target);
        assert_json_text(item, "parameter", f->parameter);
        assert_json_number(item, "smallest", f->smallest);
        assert_json_number(item, "z_m", f->z);
        assert_json_number(item, "worst", f->worst);
        assert_int_equal(cJSON_IsTrue(get(item, "beyond")), f->beyond);
    }
    assert_int_equal(i, d->ndetectable);
    i = 0;
    cJSON_ArrayForEach(item, get(json, "localisation"))
    {
        assert_json_number(item, "z_m", d->local_z[i]);
        assert_json_number(item, "indicator", d->local[i++]);
    }
    assert_int_equal(i, d->nlocal);
    i = 0;
    cJSON_ArrayForEach(item, get(json, "numerical_findings"))
    {
        const rotid_finding *f = &d->numerical_finding[i++];
        assert_json_text(item, "id", f->id);
        assert_json_text(item, "text", f->text);
        for (int k = 0; k < f->nmode; k++)
            assert_close(f->error_percent[k], cJSON_GetArrayItem(get(item, "error_percent"), k)->valuedouble, 1e-14, 0);
    }
    assert_int_equal(i, d->nnumerical_finding);
    i = 0;
    cJSON_ArrayForEach(item, get(json, "data_findings"))
    {
        const rotid_finding *f = &d->data_finding[i++];
        assert_json_text(item, "id", f->id);
        assert_json_text(item, "text", f->text);
        assert_json_text(item, "block", f->block);
        assert_json_number(item, "value", f->value);
        for (int s = 0; s < f->nsensor; s++)
            assert_int_equal(f->sensor[s], cJSON_GetArrayItem(get(item, "sensors"), s)->valueint);
    }
    assert_int_equal(i, d->ndata_finding);
}

/* By the library and by the program, one with what it writes into a file. */
static void compare_diagnoses(const char *path)
{
    char arguments[512], *text = calloc(1 << 20, 1);
    (void)snprintf(arguments, sizeof arguments, "diagnose '%s' --threads 2 --extended '%s'", path, extended_path);
    cJSON *json = program_json(arguments);
    const cJSON *verdict = get(json, "verdict"), *gain = get(json, "gain"), *item;
    rotid_diagnosis *d;
    rotid_deck *deck = bench_deck(path);
    char failure[512] = "not touched";
    assert_status(rotid_diagnose(deck, NULL, NULL, failure, &d), ROTID_OK);
    assert_string_equal(failure, "");
    rotid_deck_free(deck);
    assert_json_text(verdict, "kind", rotid_verdict_name(d->kind));
    assert_json_text(verdict, "sentence", d->sentence);
    assert_json_text(verdict, "next_measurement", d->next_measurement);
    assert_json_number(verdict, "p_value", d->p_value);
    assert_int_equal(cJSON_IsTrue(get(verdict, "adequate_after")), d->adequate_after);
    assert_false(d->interrupted);
    int i = 0;
    cJSON_ArrayForEach(item, get(verdict, "causes")) compare_cause(item, &d->cause[i++]);
    assert_int_equal(i, d->ncause);
    for (i = 0; i < d->ncause; i++)
        assert_int_equal(d->cause[i].round, i + 1);
    i = 0;
    cJSON_ArrayForEach(item, get(verdict, "alternative_causes")) compare_cause(item, &d->alternative[i++]);
    assert_int_equal(i, d->nalternative);
    compare_candidates(json, d);
    compare_gain(gain, &d->before, "before");
    compare_gain(gain, &d->after, "after");
    compare_lists(json, d);
    for (int e = 0; e < 2; e++) {
        const rotid_identification *r = e ? d->extended : d->base;
        const cJSON *fit = get(json, e ? "extended" : "base");
        assert_int_equal(cJSON_IsNull(fit), r == NULL);
        for (int p = 0; r && p < r->nparameter; p++) {
            item = cJSON_GetArrayItem(get(fit, "parameters"), p);
            assert_json_text(item, "name", r->parameter[p].name);
            assert_json_number(item, "value", r->fit->x[p]);
            assert_json_number(item, "std", r->fit->std[p]);
        }
        if (r)
            assert_json_number(fit, "mass_kg", r->mass);
    }
    FILE *stream = fopen(extended_path, "rb");
    assert_non_null(stream);
    assert_true(fread(text, 1, (1 << 20) - 1, stream) > 0);
    (void)fclose(stream);
    assert_string_equal(d->extended_deck, text);
    deck = bench_deck(extended_path); /* and it is one */
    assert_int_equal(deck->nparameter, (d->extended ? d->extended : d->base)->nparameter);
    rotid_deck_free(deck);
    rotid_diagnosis_free(d);
    cJSON_Delete(json);
    free(text);
}

static void a_diagnosis_is_that_of_the_program(void **state)
{
    (void)state;
    compare_diagnoses(SOLID);
    compare_diagnoses(PAPER);
}

/* Data made by the library itself from a deck that says what is wrong, given to one that does not. */
static void what_was_hidden_is_named(void **state)
{
    (void)state;
    rotid_diagnosis *d;
    const rotid_diagnose_options options = {.size = sizeof options, .replicates = 200, .threads = 2, .seed = 4};
    bench_hidden_deck(deck_path, 0.4, 3);
    rotid_deck *deck = bench_deck(deck_path);
    assert_status(rotid_diagnose(deck, &options, NULL, NULL, &d), ROTID_OK);
    rotid_deck_free(deck);
    assert_int_equal(d->kind, ROTID_NAMED);
    assert_int_equal(d->ncause, 1);
    assert_string_equal(d->cause[0].id, "stiffness_gradient");
    assert_string_equal(d->cause[0].target, "core");
    assert_string_equal(d->cause[0].value[0].name, "slope");
    assert_true(d->cause[0].value[0].ci_lower < 0.4 && d->cause[0].value[0].ci_upper > 0.4);
    assert_true(d->cause[0].value[0].std < 0.05);
    assert_true(d->after.chi2_per_dof < 2 && d->before.chi2_per_dof > 5 * d->after.chi2_per_dof);
    assert_int_equal(d->extended->nparameter, 3);
    rotid_diagnosis_free(d);
}

static int open_directory(void **state)
{
    (void)state;
    set_blas_threads(1); /* the numbers of the program too are those of one */
    if (!mkdtemp(directory))
        return 1;
    (void)snprintf(deck_path, sizeof deck_path, "%s/deck.inp", directory);
    (void)snprintf(extended_path, sizeof extended_path, "%s/extended.inp", directory);
    return 0;
}

static int remove_directory(void **state)
{
    (void)state;
    (void)unlink(deck_path);
    (void)unlink(extended_path);
    return rmdir(directory);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_diagnosis_is_that_of_the_program),
        cmocka_unit_test(what_was_hidden_is_named),
    };
    return cmocka_run_group_tests_name("api diagnosis", tests, open_directory, remove_directory);
}
