/* The first layer of rotid.h: the same numbers as the routines below it and as the program, and closed forms where there are. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "api_bench.h"
#include "deck/deck.h"
#include "json_value.h"
#include "run/identify.h"
#include "support.h"

#define PAPER ROTID_SOURCE_DIR "/input/paper_rotor.inp"
#define SOLID ROTID_SOURCE_DIR "/input/solid_rotor.inp"
#define BAR                                                                                                                      \
    "*MATERIAL, NAME=steel\n*ELASTIC\n2e11, 0.3\n*DENSITY\n7850\n*SHAFT, NAME=core, MATERIAL=steel\n1.2, 0.1, 0, 24\n"           \
    "*SENSORS\n1, 0\n2, 0.15\n3, 0.3\n4, 0.45\n5, 0.6\n6, 0.75\n7, 0.9\n8, 1.05\n9, 1.2\n"

void openblas_set_num_threads(int threads);

static char directory[] = "/tmp/test_api_XXXXXX";

static const char *path_of(const char *name)
{
    static char path[2][256];
    static int next;
    next = !next;
    (void)snprintf(path[next], sizeof path[next], "%s/%s", directory, name);
    return path[next];
}

static const char *write_text(const char *name, const char *text)
{
    const char *path = path_of(name);
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    assert_true(fputs(text, stream) >= 0 && fclose(stream) == 0);
    return path;
}

static rotid_deck *read_deck(const char *path)
{
    rotid_deck *deck = NULL;
    int status = rotid_deck_read(path, 0, NULL, NULL, &deck);
    for (int i = 0; status && deck && i < deck->nmessage; i++)
        print_error("%d:%d: %s\n", deck->message[i].line, deck->message[i].column, deck->message[i].text);
    assert_status(status, ROTID_OK);
    return deck;
}

/* What the program prints for the arguments, parsed. */
static cJSON *program(const char *arguments)
{
    char command[1024];
    size_t room = 4u << 20;
    char *text = calloc(room, 1);
    assert_non_null(text);
    (void)snprintf(command, sizeof command, "'%s' %s --quiet --json -", ROTID_PROGRAM, arguments);
    FILE *stream = popen(command, "r");
    assert_non_null(stream);
    size_t length = fread(text, 1, room - 1, stream);
    assert_true(length > 0 && length < room - 1);
    int status = pclose(stream), code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    assert_true(code == 0 || code == 1);
    cJSON *json = cJSON_Parse(text);
    assert_non_null(json);
    free(text);
    return json;
}

/* null stands for what is not finite */
static void assert_number(const cJSON *json, const char *key, double value)
{
    const cJSON *item = get(json, key);
    if (cJSON_IsNull(item))
        assert_true(!isfinite(value));
    else
        assert_close(value, item->valuedouble, 1e-14, 0);
}

static void assert_text(const cJSON *json, const char *key, const char *text)
{
    const cJSON *item = get(json, key);
    if (cJSON_IsNull(item))
        assert_null(text);
    else
        assert_string_equal(text, item->valuestring);
}

/* ------------------------------------------------------------------------------------------------ decks */

static void a_deck_shows_what_was_read(void **state)
{
    struct pool pool;
    struct message_list messages;
    struct job job;
    (void)state;
    pool_open(&pool, NULL);
    message_open(&messages, &pool);
    assert_status(deck_read(&pool, SOLID, 0, NULL, &messages, &job), ROTID_OK);
    rotid_deck *deck = read_deck(SOLID);
    assert_string_equal(deck->path, SOLID);
    assert_int_equal(deck->nerror, 0);
    assert_int_equal(deck->nmessage, messages.count);
    assert_int_equal(deck->nsensor, job.rotor.nsensor);
    for (int s = 0; s < deck->nsensor; s++) {
        assert_int_equal(deck->sensor_id[s], job.rotor.sensor[s].id);
        assert_true(deck->sensor_z[s] == job.rotor.sensor[s].position);
    }
    size_t modes = (size_t)job.nmode, components = modes * (size_t)job.rotor.nsensor;
    assert_int_equal(deck->nmode, job.nmode);
    assert_true(modes > 3 && components > 60);
    assert_memory_equal(deck->number, job.number, modes * sizeof(int));
    assert_memory_equal(deck->frequency_hz, job.frequency_hz, modes * sizeof(double));
    assert_memory_equal(deck->frequency_std, job.frequency_std, modes * sizeof(double));
    assert_memory_equal(deck->shape, job.shape, components * sizeof(double));
    assert_memory_equal(deck->shape_std, job.shape_std, components * sizeof(double));
    assert_memory_equal(deck->holdout, job.holdout, modes * sizeof(int));
    assert_int_equal(deck->nparameter, job.nparameter);
    for (int p = 0; p < deck->nparameter; p++) {
        assert_string_equal(deck->parameter[p].name, job.bounds[p].name);
        assert_true(deck->parameter[p].start == job.bounds[p].start && deck->parameter[p].upper == job.bounds[p].upper);
    }
    rotid_deck_free(deck);
    pool_close(&pool);
}

static void mass_and_centre_are_those_at_the_start_of_the_parameters(void **state)
{
    (void)state;
    const double area = 3.14159265358979323846 / 4 * 0.1 * 0.1;
    rotid_deck *deck = read_deck(write_text("bar.inp", BAR));
    assert_close(deck->length, 1.2, 1e-15, 0);
    assert_close(deck->mass, 7850 * 1.2 * area, 1e-13, 0);
    assert_close(deck->centre, 0.6, 1e-13, 0);
    assert_null(deck->shape);
    assert_int_equal(deck->nmode, 0);
    rotid_deck_free(deck);
    deck = read_deck(write_text("bar.inp", BAR "*IDENTIFY\ncore.rho, 5000, 9000, 6000\n"));
    assert_close(deck->mass, 6000 * 1.2 * area, 1e-13, 0);
    rotid_deck_free(deck);
    /* density of the left half raised by a cause that is part of the model, its size searched from a start of its own */
    deck = read_deck(write_text("bar.inp", "*MATERIAL, NAME=steel\n*ELASTIC\n2e11, 0.3\n*DENSITY\n7850\n"
                                           "*SHAFT, NAME=a, MATERIAL=steel\n0.6, 0.1, 0, 12\n"
                                           "*SHAFT, NAME=b, MATERIAL=steel\n0.6, 0.1, 0, 12\n"
                                           "*CAUSE, NAME=heavy, TYPE=density, GROUP=a\nfactor, 1.2\n"
                                           "*IDENTIFY\nheavy.factor, 0.8, 1.5, 1.1\n"));
    assert_close(deck->mass, 7850 * area * (0.6 * 1.1 + 0.6), 1e-13, 0);
    assert_close(deck->centre, (0.3 * 1.1 + 0.9) / (1.1 + 1), 1e-13, 0);
    rotid_deck_free(deck);
}

static void overrides_act_and_those_of_another_form_are_refused(void **state)
{
    static const char *const good[] = {"FIT.MODES=1-4", "fit.holdout=2"}, *const none[] = {NULL},
                             *const bad[] = {"FIT.MODES", "=", "FIT=3", ".MODES=1", "SHAFTS.NAME=a", "FIT.MODES=fish"};
    rotid_deck *deck;
    (void)state;
    assert_status(rotid_deck_read(PAPER, 2, good, NULL, &deck), ROTID_OK);
    assert_int_equal(deck->nmode, 6);
    for (int k = 0; k < 6; k++) /* those not fitted are predicted */
        assert_int_equal(deck->holdout[k], k == 1 || k > 3);
    rotid_deck_free(deck);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_status(rotid_deck_read(PAPER, 1, &bad[i], NULL, &deck), ROTID_ERROR_SYNTAX);
        assert_non_null(deck);
        assert_int_equal(deck->nerror, 1);
        assert_non_null(strstr(deck->message[deck->nmessage - 1].text, "expected"));
        rotid_deck_free(deck);
    }
    assert_status(rotid_deck_read(PAPER, 1, none, NULL, &deck), ROTID_ERROR_ARGUMENT);
    assert_null(deck);
}

/* ------------------------------------------------------------------------------------------------ modes */

static void modes_follow_the_parameters(void **state)
{
    (void)state;
    const double four = 8e11;
    rotid_spectrum *one, *two;
    rotid_deck *deck = read_deck(write_text("bar.inp", BAR "*IDENTIFY\ncore.E, 1e11, 9e11, 2e11\n"));
    assert_status(rotid_spectrum_compute(deck, NULL, 4, NULL, &one), ROTID_OK);
    assert_status(rotid_spectrum_compute(deck, &four, 4, NULL, &two), ROTID_OK);
    assert_int_equal(one->nrigid, 2);
    assert_int_equal(one->nmode, 4);
    assert_int_equal(one->nmaster, 9);
    for (int k = 0; k < 4; k++) { /* G follows E: every stiffness times four */
        assert_close(two->hz[k], 2 * one->hz[k], 1e-9, 0);
        assert_close(two->reduced_hz[k], 2 * one->reduced_hz[k], 1e-9, 0);
        assert_true(one->mesh_error_percent[k] > 0 && one->mesh_error_percent[k] < 0.3);
        assert_true(one->reduction_error_percent[k] > 0);
    }
    /* Euler-Bernoulli (4.730)^2/(2 pi l^2) sqrt(EI/rho S), lowered by shear and rotary inertia */
    double slender = 4.7300407 * 4.7300407 / (2 * 3.14159265 * 1.44) * sqrt(2e11 / 7850) * 0.1 / 4;
    assert_true(one->hz[0] < slender && one->hz[0] > 0.96 * slender);
    double total = 0, turning = 0; /* the condensed mass moves rigid bodies as they are */
    for (int i = 0; i < 9; i++)
        for (int j = 0; j < 9; j++) {
            total += one->master_mass[i + 9 * j];
            turning += one->master_mass[i + 9 * j] * one->master_z[j];
        }
    assert_close(total, deck->mass, 1e-9, 0);
    assert_close(turning, deck->mass * deck->centre, 1e-9, 0);
    for (int k = 0; k < 4; k++) {
        double largest = 0, work[9];
        for (int i = 0; i < 9; i++)
            largest = fmax(largest, one->shape[i + 9 * k]);
        assert_close(largest, 1, 1e-12, 0);
        assert_close(rotid_nco(9, one->master_mass, one->shape + 9 * k, one->shape + 9 * k, work), 1, 1e-12, 0);
    }
    rotid_spectrum_free(one);
    rotid_spectrum_free(two);
    rotid_deck_free(deck);
}

static void a_model_with_few_modes_gives_what_it_has(void **state)
{
    (void)state;
    rotid_spectrum *s;
    rotid_deck *deck = read_deck(ROTID_SOURCE_DIR "/tests/data/decks/one_element.inp");
    assert_status(rotid_spectrum_compute(deck, NULL, 1000000000, NULL, &s), ROTID_OK);
    assert_true(s->nmode >= 1 && s->nmode <= 4);
    for (int i = s->nrigid; i < 2; i++)
        assert_true(isnan(s->rigid_hz[i]));
    rotid_spectrum_free(s);
    rotid_deck_free(deck);
}

/* ------------------------------------------------------------------------------------------------ identification */

static void an_identification_is_that_of_the_run_below(void **state)
{
    struct pool pool;
    struct message_list messages;
    struct job job;
    struct identification found;
    (void)state;
    pool_open(&pool, NULL);
    message_open(&messages, &pool);
    assert_status(deck_read(&pool, PAPER, 0, NULL, &messages, &job), ROTID_OK);
    message_open(&messages, &pool);
    assert_status(identify_run(&pool, &job, 1, NULL, &messages, &found), ROTID_OK);
    identify_warn_of_mesh(&job, &found, &messages);
    char failure[512] = "not touched";
    rotid_identification *r;
    rotid_deck *deck = read_deck(PAPER);
    assert_status(rotid_identify(deck, 1, NULL, failure, &r), ROTID_OK);
    rotid_deck_free(deck);
    assert_string_equal(failure, "");
    size_t n = (size_t)job.nparameter * sizeof(double), m = (size_t)job.nmode * sizeof(double);
    assert_int_equal(r->nparameter, job.nparameter);
    assert_int_equal(r->nmode, job.nmode);
    assert_int_equal(r->fit->status, found.fit->status);
    assert_int_equal(r->fit->nbaseline, found.fit->nbaseline);
    assert_memory_equal(r->fit->x, found.fit->x, n);
    assert_memory_equal(r->fit->ci_lower, found.fit->ci_lower, n);
    assert_memory_equal(r->fit->predicted_hz, found.fit->predicted_hz, m);
    assert_memory_equal(r->number, found.compared.number, (size_t)job.nmode * sizeof(int));
    assert_memory_equal(r->measured_hz, job.frequency_hz, m);
    for (int k = 0; k < job.nmode; k++) {
        assert_true(r->mesh_error_percent[k] == found.spectrum.mesh_error_percent[found.compared.number[k] - 1]);
        assert_true(r->reduction_error_percent[k] == found.spectrum.reduction_error_percent[found.compared.number[k] - 1]);
    }
    assert_true(r->mass == found.mass.mass && r->centre == found.mass.center);
    assert_int_equal(r->nmessage, messages.count);
    for (int i = 0; i < r->nmessage; i++)
        assert_string_equal(r->message[i].text, messages.item[i].text);
    rotid_identification_free(r);
    rotid_fit_free(found.fit);
    pool_close(&pool);
}

static void an_identification_is_that_of_the_program(void **state)
{
    (void)state;
    cJSON *json = program("identify '" PAPER "'");
    rotid_identification *r;
    rotid_deck *deck = read_deck(PAPER);
    assert_status(rotid_identify(deck, 1, NULL, NULL, &r), ROTID_OK);
    const cJSON *item, *modes = get(json, "modes");
    int p = 0, k = 0, b = 0;
    cJSON_ArrayForEach(item, get(json, "parameters"))
    {
        assert_text(item, "name", r->parameter[p].name);
        assert_text(item, "unit", r->parameter[p].unit);
        assert_number(item, "start", r->parameter[p].start);
        assert_number(item, "value", r->fit->x[p]);
        assert_number(item, "std", r->fit->std[p++]);
    }
    assert_int_equal(p, r->nparameter);
    cJSON_ArrayForEach(item, modes)
    {
        assert_int_equal(number_of(item, "mode"), r->number[k]);
        assert_number(item, "measured_hz", r->measured_hz[k]);
        assert_number(item, "predicted_hz", r->fit->predicted_hz[k]);
        assert_number(item, "nco", r->nco[k]);
        assert_close(r->mesh_error_percent[k], cJSON_GetArrayItem(get(json, "mesh_error_percent"), k)->valuedouble, 1e-14, 0);
        k++;
    }
    assert_int_equal(k, r->nmode);
    cJSON_ArrayForEach(item, get(json, "baseline"))
    {
        assert_text(item, "algorithm", r->fit->baseline[b].algorithm);
        assert_number(item, "objective", r->fit->baseline[b++].objective);
    }
    assert_int_equal(b, r->fit->nbaseline);
    assert_number(json, "mass_kg", r->mass);
    assert_number(json, "center_of_mass_m", r->centre);
    assert_number(json, "objective", r->fit->objective);
    int warnings = 0;
    for (int i = 0; i < r->nmessage; i++)
        if (r->message[i].severity == ROTID_WARNING)
            assert_string_equal(r->message[i].text, cJSON_GetArrayItem(get(json, "warnings"), warnings++)->valuestring);
    assert_int_equal(warnings, cJSON_GetArraySize(get(json, "warnings")));
    rotid_identification_free(r);
    rotid_deck_free(deck);
    cJSON_Delete(json);
}

static void with_nothing_to_identify_the_model_is_compared(void **state)
{
    (void)state;
    rotid_spectrum *s;
    rotid_identification *r;
    rotid_deck *deck = read_deck(write_text("bar.inp", BAR "*MODES\n1, 350\n3, 1600\n"));
    assert_status(rotid_identify(deck, 1, NULL, NULL, &r), ROTID_OK);
    assert_status(rotid_spectrum_compute(deck, NULL, 3, NULL, &s), ROTID_OK);
    assert_int_equal(r->fit->iterations, 0);
    assert_int_equal(r->nparameter, 0);
    assert_true(r->fit->predicted_hz[0] == s->hz[0] && r->fit->predicted_hz[1] == s->hz[2]);
    assert_close(r->mass, deck->mass, 1e-15, 0);
    rotid_identification_free(r);
    rotid_spectrum_free(s);
    rotid_deck_free(deck);
}

/* ------------------------------------------------------------------------------------------------ diagnosis */

static void compare_cause(const cJSON *json, const rotid_cause *c)
{
    const cJSON *item;
    int v = 0;
    assert_text(json, "id", c->id);
    assert_text(json, "target", c->target);
    if (!cJSON_IsNull(get(json, "name"))) /* the program has none for noise_level */
        assert_text(json, "name", c->name);
    assert_text(json, "variant", c->variant);
    cJSON_ArrayForEach(item, get(json, "parameters"))
    {
        assert_text(item, "name", c->value[v].name);
        assert_text(item, "unit", c->value[v].unit);
        assert_number(item, "value", c->value[v].value);
        assert_number(item, "std", c->value[v].std);
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
        assert_number(item, "chi2", c->chi2);
        assert_number(item, "chi2_drop", c->chi2_drop);
        assert_number(item, "bic", c->bic);
        assert_number(item, "holdout_rms", c->holdout_rms);
        assert_number(item, "mode_out_rms", c->mode_out_rms);
        assert_number(item, "sensor_out_rms", c->sensor_out_rms);
        assert_number(item, "predicted_drop", c->predicted_drop);
        assert_number(item, "p_value", c->p_value);
        assert_number(item, "cosine", c->cosine);
        assert_int_equal(cJSON_IsTrue(get(item, "at_bound")), c->at_bound);
        assert_text(item, "collinear_with", c->collinear_with);
        assert_text(item, "rejected_because", c->rejected_because);
    }
    assert_int_equal(i, d->ncandidate);
}

static void compare_gain(const cJSON *gain, const rotid_quality *q, const char *state)
{
    assert_number(get(gain, "frequency_rms_percent"), state, q->frequency_rms_percent);
    assert_number(get(gain, "frequency_max_percent"), state, q->frequency_max_percent);
    assert_number(get(gain, "shape_rms"), state, q->shape_rms);
    assert_number(get(gain, "chi2_per_dof"), state, q->chi2_per_dof);
    assert_number(get(gain, "nco_min"), state, q->nco_min);
    assert_number(get(gain, "holdout_frequency_rms_percent"), state, q->holdout_frequency_rms_percent);
    assert_number(get(gain, "holdout_shape_rms"), state, q->holdout_shape_rms);
    assert_number(get(gain, "mode_out_frequency_rms_percent"), state, q->mode_out_frequency_rms_percent);
    assert_number(get(gain, "mode_out_shape_rms"), state, q->mode_out_shape_rms);
    assert_number(get(gain, "sensor_out_shape_rms"), state, q->sensor_out_shape_rms);
}

static void compare_lists(const cJSON *json, const rotid_diagnosis *d)
{
    const cJSON *item;
    int i = 0;
    cJSON_ArrayForEach(item, get(json, "detectable"))
    {
        const rotid_detectable *f = &d->detectable[i++];
        assert_text(item, "id", f->id);
        assert_text(item, "target", f->target);
        assert_text(item, "parameter", f->parameter);
        assert_number(item, "smallest", f->smallest);
        assert_number(item, "z_m", f->z);
        assert_number(item, "worst", f->worst);
        assert_int_equal(cJSON_IsTrue(get(item, "beyond")), f->beyond);
    }
    assert_int_equal(i, d->ndetectable);
    i = 0;
    cJSON_ArrayForEach(item, get(json, "localisation"))
    {
        assert_number(item, "z_m", d->local_z[i]);
        assert_number(item, "indicator", d->local[i++]);
    }
    assert_int_equal(i, d->nlocal);
    i = 0;
    cJSON_ArrayForEach(item, get(json, "numerical_findings"))
    {
        const rotid_finding *f = &d->numerical_finding[i++];
        assert_text(item, "id", f->id);
        assert_text(item, "text", f->text);
        for (int k = 0; k < f->nmode; k++)
            assert_close(f->error_percent[k], cJSON_GetArrayItem(get(item, "error_percent"), k)->valuedouble, 1e-14, 0);
    }
    assert_int_equal(i, d->nnumerical_finding);
    i = 0;
    cJSON_ArrayForEach(item, get(json, "data_findings"))
    {
        const rotid_finding *f = &d->data_finding[i++];
        assert_text(item, "id", f->id);
        assert_text(item, "text", f->text);
        assert_text(item, "block", f->block);
        assert_number(item, "value", f->value);
        for (int s = 0; s < f->nsensor; s++)
            assert_int_equal(f->sensor[s], cJSON_GetArrayItem(get(item, "sensors"), s)->valueint);
    }
    assert_int_equal(i, d->ndata_finding);
}

/* By the library and by the program, one with what it writes into a file. */
static void compare_diagnoses(const char *path)
{
    char arguments[512], *text = calloc(1 << 20, 1);
    (void)snprintf(arguments, sizeof arguments, "diagnose '%s' --threads 2 --extended '%s/extended.inp'", path, directory);
    cJSON *json = program(arguments);
    const cJSON *verdict = get(json, "verdict"), *gain = get(json, "gain"), *item;
    rotid_diagnosis *d;
    rotid_deck *deck = read_deck(path);
    char failure[512] = "not touched";
    assert_status(rotid_diagnose(deck, NULL, NULL, failure, &d), ROTID_OK);
    assert_string_equal(failure, "");
    rotid_deck_free(deck);
    assert_text(verdict, "kind", rotid_verdict_name(d->kind));
    assert_text(verdict, "sentence", d->sentence);
    assert_text(verdict, "next_measurement", d->next_measurement);
    assert_number(verdict, "p_value", d->p_value);
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
            assert_text(item, "name", r->parameter[p].name);
            assert_number(item, "value", r->fit->x[p]);
            assert_number(item, "std", r->fit->std[p]);
        }
        if (r)
            assert_number(fit, "mass_kg", r->mass);
    }
    FILE *stream = fopen(path_of("extended.inp"), "rb");
    assert_non_null(stream);
    assert_true(fread(text, 1, (1 << 20) - 1, stream) > 0);
    (void)fclose(stream);
    assert_string_equal(d->extended_deck, text);
    deck = read_deck(path_of("extended.inp")); /* and it is one */
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
    const rotid_diagnose_options options = {.replicates = 200, .threads = 2, .seed = 4};
    bench_hidden_deck(path_of("bar.inp"), 0.4, 3);
    rotid_deck *deck = read_deck(path_of("bar.inp"));
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

static void verdicts_have_names(void **state)
{
    (void)state;
    assert_string_equal(rotid_verdict_name(ROTID_ADEQUATE), "adequate");
    assert_string_equal(rotid_verdict_name(ROTID_NAMED), "named");
    assert_string_equal(rotid_verdict_name(ROTID_AMBIGUOUS), "ambiguous");
    assert_string_equal(rotid_verdict_name(ROTID_UNEXPLAINED), "unexplained");
    assert_non_null(rotid_verdict_name(-1));
    assert_non_null(rotid_verdict_name(4));
}

static int open_directory(void **state)
{
    (void)state;
    openblas_set_num_threads(1); /* the numbers of the program too are those of one */
    return mkdtemp(directory) == NULL;
}

static int remove_directory(void **state)
{
    static const char *const names[] = {"bar.inp", "extended.inp"};
    (void)state;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        (void)unlink(path_of(names[i]));
    return rmdir(directory);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_deck_shows_what_was_read),
        cmocka_unit_test(mass_and_centre_are_those_at_the_start_of_the_parameters),
        cmocka_unit_test(overrides_act_and_those_of_another_form_are_refused),
        cmocka_unit_test(modes_follow_the_parameters),
        cmocka_unit_test(a_model_with_few_modes_gives_what_it_has),
        cmocka_unit_test(an_identification_is_that_of_the_run_below),
        cmocka_unit_test(an_identification_is_that_of_the_program),
        cmocka_unit_test(with_nothing_to_identify_the_model_is_compared),
        cmocka_unit_test(a_diagnosis_is_that_of_the_program),
        cmocka_unit_test(what_was_hidden_is_named),
        cmocka_unit_test(verdicts_have_names),
    };
    return cmocka_run_group_tests_name("api", tests, open_directory, remove_directory);
}
