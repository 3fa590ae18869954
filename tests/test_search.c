/* What the search once missed: decks of tests/data/search, whose data another program made or whose truth was drawn (their
 * headings). */
#include "api_bench.h"
#include "diagnose/diagnose.h"
#include "support.h"

static rotid_diagnosis *diagnosed(const char *name)
{
    char path[512], failure[ROTID_FAILURE_LENGTH];
    rotid_diagnosis *d;
    (void)snprintf(path, sizeof path, "%s/tests/data/search/%s.inp", ROTID_SOURCE_DIR, name);
    rotid_deck *deck = bench_deck(path);
    assert_status(rotid_diagnose(deck, NULL, NULL, failure, &d), ROTID_OK);
    rotid_deck_free(deck);
    return d;
}

static double value_of(const rotid_cause *cause, const char *name)
{
    for (int i = 0; i < cause->nparameters; i++)
        if (!strcmp(cause->parameters[i].name, name))
            return cause->parameters[i].value;
    return NAN;
}

static void names(const rotid_diagnosis *d, const char *id, const char *target)
{
    assert_int_equal(d->verdict.kind, ROTID_NAMED);
    assert_int_equal(d->verdict.ncauses, 1);
    assert_string_equal(d->verdict.causes[0].id, id);
    assert_string_equal(d->verdict.causes[0].target, target);
}

/* A model that is fitted to positions from the wrong end has frequencies that are half as high again; no line leads from there.
 */
UNIT_TEST(sensors_are_counted_from_the_other_end_of_a_model_that_fits_nothing)
{
    rotid_diagnosis *d = diagnosed("turned");
    assert_int_equal(d->verdict.kind, ROTID_ADEQUATE);
    assert_int_equal(d->ndata_findings, 1);
    assert_string_equal(d->data_findings[0].id, "sensor_line");
    assert_close(d->data_findings[0].parameters[2].value, 1, 0, 0);
    rotid_diagnosis_free(d);
}

/* The shapes beside the trial exchange two modes that cross on the way to the cause. */
UNIT_TEST(modes_that_cross_on_the_way_to_a_far_cause_keep_their_numbers)
{
    rotid_diagnosis *d = diagnosed("far_support");
    names(d, "support", "rear");
    assert_close(value_of(&d->verdict.causes[0], "factor"), 0.064052, 0.005, 0);
    assert_true(d->verdict.adequate_after);
    rotid_diagnosis_free(d);
}

/* The numbers of the deck are tried, as nothing explains the data, and explain less than the shapes' own. */
UNIT_TEST(the_numbers_of_the_deck_give_way_where_they_explain_less)
{
    rotid_diagnosis *d = diagnosed("missed_mode");
    assert_int_equal(d->verdict.kind, ROTID_UNEXPLAINED);
    assert_int_equal(d->ndata_findings, 3);
    for (int i = 0; i < 3; i++) {
        assert_string_equal(d->data_findings[i].id, "mode_pairing");
        assert_int_equal(d->data_findings[i].modes[0], 4 + i);
        assert_int_equal(d->data_findings[i].modes[1], 5 + i);
    }
    rotid_diagnosis_free(d);
}

/* With bars in 160 elements and sections in 8 times as many the moduli of the base are 129.15 and 40.43 GPa. */
UNIT_TEST(the_mesh_of_bars_is_refined_with_that_of_the_sections)
{
    rotid_diagnosis *d = diagnosed("coarse_bars");
    assert_close(d->base->parameters[0].value, 129.15e9, 1e-3, 0);
    assert_close(d->base->parameters[1].value, 40.43e9, 1e-3, 0);
    rotid_diagnosis_free(d);
}

/* What the mesh of a solid is held to is that of the fit, not of the beam's moduli, which are four times off. */
UNIT_TEST(a_solid_far_from_the_beams_moduli_explains_all)
{
    rotid_diagnosis *d = diagnosed("soft_solid");
    names(d, "beam_theory", "");
    assert_true(d->verdict.adequate_after);
    assert_int_equal(d->verdict.explanations[0].ncauses, 1); /* else what the mesh leaves is taken for another cause */
    assert_true(d->verdict.explanations[0].probability > 0.9);
    rotid_diagnosis_free(d);
}

/* Only with ROTID_LONG: scans and fits of solids take their time. */
UNIT_TEST(a_cause_is_found_beside_beam_theory)
{
    if (!getenv("ROTID_LONG"))
        return;
    rotid_diagnosis *d = diagnosed("solid_and_spring");
    const rotid_explanation *lead = &d->verdict.explanations[0];
    assert_int_equal(d->verdict.kind, ROTID_NAMED);
    assert_int_equal(lead->ncauses, 2);
    assert_true(lead->probability > 0.95 && !lead->something_else);
    assert_string_equal(lead->causes[0].id, "beam_theory");
    assert_string_equal(lead->causes[1].id, "support_rotation");
    assert_close(value_of(&lead->causes[1], "stiffness"), 2084.9, 0.1, 0);
    assert_close(value_of(&lead->causes[1], "z"), 0.48848, 0.02, 0);
    rotid_diagnosis_free(d);
}

/* One of two is certain, the other is stiffness or density: the place of the first is that beside the second. */
UNIT_TEST(what_is_named_has_the_place_that_it_has_in_the_likeliest_model)
{
    rotid_diagnosis *d = diagnosed("two_named_one");
    names(d, "support_rotation", "");
    assert_close(value_of(&d->verdict.causes[0], "z"), 0.117401, 0.05, 0);
    assert_close(value_of(&d->verdict.causes[0], "stiffness"), 552.412, 0.15, 0);
    assert_true(d->verdict.adequate_after);
    assert_non_null(strstr(d->verdict.sentence, " % stiffness of left ("));
    assert_int_equal(d->verdict.nlikely_causes, 1);
    assert_string_equal(d->verdict.likely_causes[0].id, "stiffness");
    assert_close(value_of(&d->verdict.likely_causes[0], "factor"), 1.0262, 0.002, 0);
    assert_int_equal(d->extended->nparameters, d->base->nparameters + 3);
    rotid_diagnosis_free(d);
}

/* Beside none of the single causes, each of which leaves a thousand, the other one shows. */
UNIT_TEST(two_causes_that_hide_each_other_are_an_explanation)
{
    rotid_diagnosis *d = diagnosed("hidden_pair");
    double share = 0, mass = NAN, place = NAN, factor = NAN;
    for (int i = 0; i < d->verdict.nexplanations; i++) {
        const rotid_explanation *e = &d->verdict.explanations[i];
        if (e->ncauses != 2 || strcmp(e->causes[0].id, "added_mass") != 0 || strcmp(e->causes[1].id, "density") != 0)
            continue;
        share = e->probability;
        mass = value_of(&e->causes[0], "mass");
        place = value_of(&e->causes[0], "z");
        factor = value_of(&e->causes[1], "factor");
    }
    assert_true(share > 0.1);
    assert_close(mass, 0.0699613, 0.05, 0);
    assert_close(place, 0.0770071, 0.05, 0);
    assert_close(factor, 1.04699, 0.005, 0);
    rotid_diagnosis_free(d);
}

/* Alone the cone at the steps is the eighth of the causes. */
UNIT_TEST(what_leads_beside_something_else_need_not_lead_alone)
{
    rotid_diagnosis *d = diagnosed("step_and_more");
    const rotid_explanation *lead = &d->verdict.explanations[0];
    assert_int_equal(d->verdict.kind, ROTID_UNEXPLAINED);
    assert_true(lead->something_else && lead->ncauses == 1);
    assert_string_equal(lead->causes[0].id, "step_stiffness");
    rotid_diagnosis_free(d);
}

/* Its fit ends elsewhere; beside another one it is found, and then alone. */
UNIT_TEST(a_cause_that_two_lead_to_is_found_alone)
{
    rotid_diagnosis *d = diagnosed("other_place");
    names(d, "support_extra", "");
    assert_close(value_of(&d->verdict.causes[0], "z"), 0.37148, 0.02, 0);
    assert_close(value_of(&d->verdict.causes[0], "stiffness"), 1.45884e7, 0.05, 0);
    rotid_diagnosis_free(d);
}

/* The fits from the scan end at another place; a gradient leads to the right one, and is not needed there. */
UNIT_TEST(the_place_that_two_causes_lead_to_is_that_of_one)
{
    rotid_diagnosis *d = diagnosed("from_two");
    names(d, "support_rotation", "");
    assert_int_equal(d->verdict.explanations[0].ncauses, 1);
    assert_true(d->verdict.explanations[0].probability > 0.9);
    assert_close(value_of(&d->verdict.causes[0], "z"), 0.061368, 0, 0.002);
    rotid_diagnosis_free(d);
}

/* Left of the step the place hardly matters. By `rotid identify` with the spring at fixed places, chi2 is 60.73 at 0.15 m, 58.58
 * at 0.1947, 56.71 at 0.22, 53.19 at 0.399 and 66.94 at 0.42; 3.84 above the least is 57.03. */
UNIT_TEST(the_interval_of_a_place_at_a_step_is_that_of_its_profile)
{
    rotid_diagnosis *d = diagnosed("place_at_a_step");
    names(d, "support_rotation", "");
    const rotid_cause *cause[] = {&d->verdict.causes[0], &d->verdict.explanations[0].causes[0]};
    for (int i = 0; i < 2; i++)
        for (int q = 0; q < cause[i]->nparameters; q++)
            if (!strcmp(cause[i]->parameters[q].name, "z")) {
                assert_close(cause[i]->parameters[q].ci95[0], 0.214, 0, 0.02);
                assert_close(cause[i]->parameters[q].ci95[1], 0.407, 0, 0.01);
            }
    rotid_diagnosis_free(d);
}

/* Four frequencies do not tell where a spring is: each place that explains them is an explanation, the true one among them. */
UNIT_TEST(by_frequencies_alone_each_place_of_a_cause_is_an_explanation)
{
    rotid_diagnosis *d = diagnosed("several_places");
    double z[64] = {0}, sum = 0;
    int count = 0, there = 0;
    assert_int_equal(d->verdict.kind, ROTID_AMBIGUOUS);
    for (int i = 0; i < d->verdict.nexplanations; i++) {
        const rotid_explanation *e = &d->verdict.explanations[i];
        sum += e->probability;
        if (e->something_else || e->ncauses != 1 || strcmp(e->causes[0].id, "support_extra") != 0)
            continue;
        z[count] = value_of(&e->causes[0], "z");
        for (int k = 0; k < count; k++)
            assert_true(fabs(z[k] - z[count]) > 0.125 * 1.758196);
        for (int q = 0; q < e->causes[0].nparameters; q++) {
            const rotid_cause_value *v = &e->causes[0].parameters[q];
            int is_place = !strcmp(v->name, "z");
            double truth = is_place ? 0.0419595 : 6427420;
            there += v->ci95[0] <= truth && truth <= v->ci95[1] && z[count] < 0.2;
        }
        count++;
    }
    assert_true(count >= 4);
    assert_int_equal(there, 2); /* place and stiffness */
    assert_true(sum > 0.99 && sum < 1 + 1e-9);
    rotid_diagnosis_free(d);
}

/* The first explanation by one cause of this id and target alone; NULL: none. */
static const rotid_explanation *alone(const rotid_diagnosis *d, const char *id, const char *target)
{
    for (int i = 0; i < d->verdict.nexplanations; i++) {
        const rotid_explanation *e = &d->verdict.explanations[i];
        if (e->ncauses == 1 && !e->something_else && !strcmp(e->causes[0].id, id) && !strcmp(e->causes[0].target, target))
            return e;
    }
    return NULL;
}

/* Without one mode two causes explain the rest, and with it the true one alone. */
UNIT_TEST(a_mode_that_was_left_out_is_back_beside_its_cause)
{
    rotid_diagnosis *d = diagnosed("left_out");
    names(d, "added_inertia", "disk1");
    assert_int_equal(d->ndata_findings, 0);
    rotid_diagnosis_free(d);
}

/* Less inertia than stated, two draws of the noise: a solid could not take any away, and was of another density. */
UNIT_TEST(a_disk_of_a_solid_has_less_inertia_than_stated)
{
    static const char *const deck[] = {"less_inertia", "less_inertia_again"};
    for (int i = 0; i < 2; i++) {
        rotid_diagnosis *d = diagnosed(deck[i]);
        names(d, "added_inertia", "dd");
        assert_close(value_of(&d->verdict.causes[0], "inertia"), -0.03, 0, 0.001);
        assert_true(d->parameters[0].ci95[0] < 2.1e11 && d->parameters[0].ci95[1] > 2.1e11);
        rotid_diagnosis_free(d);
    }
}

/* A fault that its fit takes to where no data can be put right stays at what was fitted; the diagnosis was an error. */
UNIT_TEST(a_line_of_sensors_stays_in_the_rotor)
{
    rotid_diagnosis *d = diagnosed("beyond");
    assert_int_equal(d->verdict.kind, ROTID_UNEXPLAINED);
    rotid_diagnosis_free(d);
}

/* The moduli of a model that is fitted so badly are no start. */
UNIT_TEST(what_is_far_is_looked_for_from_the_deck)
{
    rotid_diagnosis *d = diagnosed("far_shift");
    names(d, "support_position", "front");
    assert_close(value_of(&d->verdict.causes[0], "shift"), 0.0820297, 0, 0.001);
    rotid_diagnosis_free(d);
}

/* The middle of a stretch is as near to one of its ends as to the other: a density that is 1e-10 larger made 1.5 % of 0.8. */
UNIT_TEST(rounding_does_not_choose_where_a_fit_begins)
{
    static const char *const more[] = {"", ".000001", ".00001", ".0000001"};
    double probability[4] = {0};
    for (int i = 0; i < 4; i++) {
        char failure[ROTID_FAILURE_LENGTH], text[4000] = "", changed[4010];
        FILE *file = fopen(ROTID_SOURCE_DIR "/tests/data/search/tied_start.inp", "rb");
        assert_true(file && fread(text, 1, sizeof text - 1, file) > 0);
        (void)fclose(file);
        const char *density = strstr(text, "7850");
        (void)snprintf(changed, sizeof changed, "%.*s7850%s%s", (int)(density - text), text, more[i], density + 4);
        rotid_deck *deck;
        rotid_diagnosis *d;
        assert_status(rotid_deck_read_text(strlen(changed), changed, NULL, NULL, 0, NULL, NULL, failure, &deck), ROTID_OK);
        assert_status(rotid_diagnose(deck, NULL, NULL, failure, &d), ROTID_OK);
        for (int e = 0; e < d->verdict.nexplanations; e++)
            probability[i] += d->verdict.explanations[e].ncauses == 1 && !d->verdict.explanations[e].something_else &&
                                      !strcmp(d->verdict.explanations[e].causes[0].id, "stiffness_local")
                                  ? d->verdict.explanations[e].probability
                                  : 0;
        rotid_diagnosis_free(d);
        rotid_deck_free(deck);
    }
    assert_true(probability[0] > 0.002);
    for (int i = 1; i < 4; i++)
        assert_close(probability[i], probability[0], 1e-3, 0);
}

/* The prior of a joint spans decades, and smaller ones are possible. */
UNIT_TEST(a_joint_below_its_decades_is_an_explanation)
{
    rotid_diagnosis *d = diagnosed("small_joint");
    assert_int_equal(d->verdict.kind, ROTID_AMBIGUOUS);
    const rotid_explanation *e = alone(d, "joint", "core|right");
    assert_non_null(e);
    assert_true(e->probability > 0.03);
    assert_true(e->causes[0].parameters[0].ci95[0] < 1.25e-9 && e->causes[0].parameters[0].ci95[1] > 1.25e-9);
    rotid_diagnosis_free(d);
}

/* Its interval holds the narrow minima of other places, which have less chi2, and is another explanation for all that. */
UNIT_TEST(a_wide_minimum_counts_beside_narrow_ones)
{
    rotid_diagnosis *d = diagnosed("wide_valley");
    assert_int_equal(d->verdict.kind, ROTID_AMBIGUOUS);
    const rotid_explanation *e = alone(d, "support_rotation", "");
    while (e && e < d->verdict.explanations + d->verdict.nexplanations &&
           (e->ncauses != 1 || strcmp(e->causes[0].id, "support_rotation") != 0 || value_of(&e->causes[0], "z") > 0.64))
        e++;
    assert_true(e && e < d->verdict.explanations + d->verdict.nexplanations);
    assert_true(e->probability > 0.35);
    assert_close(value_of(&e->causes[0], "stiffness"), 2.12e7, 0.1, 0);
    rotid_diagnosis_free(d);
}

/* The data tell a box from a Gaussian, and two of these are none. */
UNIT_TEST(a_zone_has_the_form_that_fits)
{
    rotid_diagnosis *d = diagnosed("box_zone");
    names(d, "stiffness_local", "");
    assert_close(value_of(&d->verdict.causes[0], "depth"), 0.733, 0, 0.02);
    assert_close(value_of(&d->verdict.causes[0], "z"), 0.43432, 0, 0.0005);
    assert_close(value_of(&d->verdict.causes[0], "width"), 0.0208, 0.1, 0);
    rotid_diagnosis_free(d);
}

/* A support of a free bar is at either of two places alike: each has less than nothing has, both have more. */
UNIT_TEST(a_cause_weighs_with_all_its_places)
{
    rotid_diagnosis *d;
    rotid_suggestion *s;
    rotid_deck *deck = bench_deck(ROTID_SOURCE_DIR "/input/foam_bar.inp");
    double support = 0, largest = 0;
    assert_status(rotid_diagnose(deck, NULL, NULL, NULL, &d), ROTID_OK);
    assert_int_equal(d->verdict.kind, ROTID_AMBIGUOUS);
    assert_int_equal(d->verdict.explanations[0].ncauses + d->verdict.explanations[0].something_else, 0);
    for (int i = 0; i < d->verdict.nmarginals; i++) {
        largest = fmax(largest, d->verdict.marginals[i].probability);
        support += strcmp(d->verdict.marginals[i].id, "support_extra") ? 0 : d->verdict.marginals[i].probability;
    }
    assert_true(largest < 0.2 && support > 0.25);
    char words[64];
    (void)snprintf(words, sizeof words, "nothing is wrong and chance did this is %.0f %%", 100 * d->verdict.nothing);
    assert_non_null(strstr(d->verdict.sentence, words)); /* the same as in the list */
    assert_status(rotid_suggest(deck, NULL, NULL, NULL, &s), ROTID_OK);
    for (int i = 0; i < s->nrivals; i++)
        for (int k = 0; k < i; k++)
            assert_string_not_equal(s->rivals[i].label, s->rivals[k].label);
    assert_true(s->nrivals > 4);
    rotid_suggestion_free(s);
    rotid_diagnosis_free(d);
    rotid_deck_free(deck);
}

/* Of 504.7 and 506.6 Hz one is no mode: without shapes only the fits can tell. */
UNIT_TEST(a_mode_that_was_counted_twice_is_left_out)
{
    rotid_diagnosis *d = diagnosed("twice");
    assert_int_equal(d->verdict.kind, ROTID_ADEQUATE);
    assert_int_equal(d->ndata_findings, 1);
    assert_string_equal(d->data_findings[0].id, "mode_pairing");
    assert_int_equal(d->data_findings[0].nmodes, 1);
    assert_int_equal(d->data_findings[0].modes[0], 3);
    rotid_diagnosis_free(d);
}

/* By `rotid identify` with the cone, G is 10.129 GPa on twice as many elements as the deck states, 10.192 and 10.2095 GPa on four
 * and eight times as many, each +- 0.045: chi2 hardly tells that they are too few. */
UNIT_TEST(the_mesh_of_a_cone_moves_no_modulus)
{
    rotid_diagnosis *d = diagnosed("coarse_cone");
    names(d, "step_stiffness", "");
    assert_string_equal(d->parameters[1].name, "core.G");
    assert_close(d->parameters[1].value, 1.02095e10, 0.002, 0);
    rotid_diagnosis_free(d);
}

/* Chance leaves as much in one of a thousand cases. */
UNIT_TEST(an_improbable_misfit_that_no_cause_explains_is_no_explained_one)
{
    rotid_diagnosis *d = diagnosed("improbable");
    assert_int_equal(d->verdict.kind, ROTID_ADEQUATE);
    assert_true(d->verdict.p_value < 0.01);
    assert_true(!strncmp(d->verdict.sentence, "Nothing is wrong with ", 22));
    assert_non_null(strstr(d->verdict.sentence, " %, more than with any cause, though"));
    rotid_diagnosis_free(d);
}

#define COLUMNS 6
#define ROWS    8

/* |r + s a + t b|^2 by all s and t of a grid within the bounds. */
static double least_on_a_grid(const double *a, const double *b, const double *r, const struct scan_item *one,
                              const struct scan_item *two)
{
    enum { POINTS = 400 };
    double least = INFINITY;
    for (int i = 0; i <= POINTS; i++)
        for (int j = 0; j <= POINTS; j++) {
            double s = one->norm * (one->lower + (one->upper - one->lower) * i / POINTS),
                   t = two->norm * (two->lower + (two->upper - two->lower) * j / POINTS), sum = 0;
            for (int k = 0; k < ROWS; k++) {
                double left = r[k] + s * a[k] + t * b[k];
                sum += left * left;
            }
            least = fmin(least, sum);
        }
    return least;
}

POOL_TEST(the_drop_of_a_pair_is_the_least_within_the_bounds)
{
    struct random_stream random = {5};
    struct scan_item item[COLUMNS];
    struct scan_candidate candidate[COLUMNS];
    double column[ROWS * COLUMNS], r[ROWS], square = 0, best = -INFINITY;
    for (int i = 0; i < ROWS; i++) {
        r[i] = random_normal(&random);
        square += r[i] * r[i];
    }
    for (int c = 0; c < COLUMNS; c++) {
        double *own = column + c * ROWS, length = 0;
        for (int i = 0; i < ROWS; i++) {
            own[i] = random_normal(&random) + (c ? 2 * column[i] : 0); /* all somewhat alike */
            length += own[i] * own[i];
        }
        for (int i = 0; i < ROWS; i++)
            own[i] /= sqrt(length);
        item[c] = (struct scan_item){.candidate = c, .usable = 1, .norm = 2, .lower = c % 2 ? 0 : -0.3, .upper = 0.4};
        if (c > 1) /* nothing in the way */
            item[c].lower = -(item[c].upper = 2);
        candidate[c] = (struct scan_candidate){.state = -1, .first = c, .count = 1, .best = c};
    }
    const struct scan scan = {
        .nrow = ROWS, .nitem = COLUMNS, .item = item, .ncandidate = COLUMNS, .candidate = candidate, .column = column, .r = r};
    struct scan_pair pair[4];
    int count;
    assert_status(scan_pairs(&test_pool, &scan, 4, pair, &count), ROTID_OK);
    assert_int_equal(count, 4);
    for (int c = 0; c < COLUMNS; c++)
        for (int d = c + 1; d < COLUMNS; d++)
            best = fmax(best, square - least_on_a_grid(column + c * ROWS, column + d * ROWS, r, &item[c], &item[d]));
    for (int i = 0; i < count; i++) {
        const struct scan_pair *p = &pair[i];
        double drop = square - least_on_a_grid(column + p->item[0] * ROWS, column + p->item[1] * ROWS, r, &item[p->item[0]],
                                               &item[p->item[1]]);
        assert_close(p->drop, drop, 0, 1e-3);
        assert_true(!i || pair[i - 1].drop >= p->drop);
        for (int k = 0; k < 2; k++)
            assert_true(p->amplitude[k] >= item[p->item[k]].lower && p->amplitude[k] <= item[p->item[k]].upper);
    }
    assert_close(pair[0].drop, best, 0, 1e-3);
}
