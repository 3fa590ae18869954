/* Measured critical speeds: bearings identified with the core, and held out, on machines that are solved by another route: the
 * differential equation of the shaft, in steps. */
#include "api/api.h"
#include "running_case.h"
#include "support.h"

#define pi 3.14159265358979323846

/* A uniform shaft on two springs, Q = S (v' - psi), M = EI psi', Q' = -m w^2 v, M' + Q = -J w^2 psi. At rest J = rho I; where a
 * forward whirl has the speed of the shaft J = rho I - 2 rho I. */
struct shaft {
    double length, e, g, nu, rho, diameter, at[2], stiffness[2], mass, support; /* in the middle, at the end */
};

enum { AT_REST = 1, FORWARD = -1, BACKWARD = 3 }; /* J/rho I */

static void stretch(const struct shaft *s, double w, int whirl, double length, double y[4])
{
    double area = pi * s->diameter * s->diameter / 4, inertia = pi * pow(s->diameter, 4) / 64,
           shear = 6 * (1 + s->nu) / (7 + 6 * s->nu) * s->g * area;
    int steps = (int)(100 * length) + 1;
    double h = length / steps;
    for (int i = 0; i < steps; i++) {
        double term[4], sum[4];
        memcpy(term, y, sizeof term);
        memcpy(sum, y, sizeof sum);
        for (int k = 1; k < 14; k++) { /* y(z + h) = exp(A h) y */
            double next[4] = {term[1] + term[3] / shear, term[2] / (s->e * inertia),
                              -term[3] - whirl * s->rho * inertia * w * w * term[1], -s->rho * area * w * w * term[0]};
            for (int j = 0; j < 4; j++) {
                term[j] = next[j] * h / k;
                sum[j] += term[j];
            }
        }
        memcpy(y, sum, sizeof sum);
    }
}

/* Zero where the shaft has a mode: M and Q at the end of motions with neither at the beginning. */
static double left_over(const struct shaft *s, double w, int whirl)
{
    double y[2][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}};
    for (int i = 0; i < 2; i++) {
        stretch(s, w, whirl, s->at[0], y[i]);
        y[i][3] += s->stiffness[0] * y[i][0];
        stretch(s, w, whirl, (s->at[1] - s->at[0]) / 2, y[i]);
        y[i][3] -= s->mass * w * w * y[i][0];
        stretch(s, w, whirl, (s->at[1] - s->at[0]) / 2, y[i]);
        y[i][3] += s->stiffness[1] * y[i][0];
        stretch(s, w, whirl, s->length - s->at[1], y[i]);
        y[i][3] += s->support * y[i][0];
    }
    return y[0][2] * y[1][3] - y[0][3] * y[1][2];
}

/* The index-th one above `from` [rad/s]. */
static double frequency(const struct shaft *s, double from, int whirl, int index)
{
    double step = 5, low = from, value = left_over(s, low, whirl);
    for (;;) {
        double next = left_over(s, low + step, whirl);
        if (next * value < 0 && !--index)
            break;
        low += step;
        value = next;
    }
    for (int i = 0; i < 60; i++) {
        step /= 2;
        if (left_over(s, low + step, whirl) * value > 0)
            low += step;
    }
    return low;
}

static const struct shaft truth = {2, 1.1e11, 3e10, 0.28, 7600, 0.2, {0.3, 1.7}, {2.4e8, 2.4e8}, 0, 0};

/* The deck: modes at rest of a shaft, bearings as stated, `more` behind. */
static char *deck_of_shaft(struct shaft free, double stated, const char *fit, const char *more)
{
    char *text = pool_format(&test_pool,
                             "*MATERIAL, NAME=l\n*ELASTIC, TYPE=SHEAR\n1.25e11, 2.5e10, 0.28\n*DENSITY\n7600\n*SHAFT, NAME=core, "
                             "MATERIAL=l\n2, 0.2, 0, 200\n*NOISE, FREQUENCY=1e-4\n*MODES\n");
    free.stiffness[0] = free.stiffness[1] = 0;
    for (int k = 1; k <= 4; k++)
        text = pool_format(&test_pool, "%s%d, %.12g\n", text, k, frequency(&free, 500, AT_REST, k) / (2 * pi)); /* elastic ones */
    return pool_format(&test_pool,
                       "%s*FIT, FUNCTIONAL=LIKELIHOOD%s\n*IDENTIFY\ncore.E, 5e10, 3e11, 1.25e11\ncore.G, 5e9, 1e11, 2.5e10\n"
                       "*RUNNING\n*BEARING, NAME=a, STD=0.05\n0.3, %g, 0\n*BEARING, NAME=b, LIKE=a\n1.7, %g, 0\n%s",
                       text, fit, stated, stated, more);
}

static char *deck_of(double stated, const char *fit, const char *more)
{
    return deck_of_shaft(truth, stated, fit, more);
}

static char *readings_of(const struct shaft *shaft, double std)
{
    char *text = pool_format(&test_pool, "*RUNUP\n");
    for (int k = 1; k <= 2; k++)
        text = pool_format(&test_pool, "%s%d, %.12g, %g\n", text, k, frequency(shaft, 50, FORWARD, k) / RPM, std);
    return text;
}

static char *readings(double std)
{
    return readings_of(&truth, std);
}

static rotid_identification *identify(const char *text, int expected)
{
    rotid_deck *deck;
    rotid_identification *found = NULL;
    char failure[ROTID_FAILURE_LENGTH];
    assert_status(rotid_deck_read_text(strlen(text), text, "deck", NULL, 0, NULL, NULL, failure, &deck), ROTID_OK);
    int status = rotid_identify(deck, 0, NULL, failure, &found);
    if (status != expected)
        print_message("%s\n", failure);
    assert_int_equal(status, expected);
    rotid_deck_free(deck);
    return found;
}

POOL_TEST(the_critical_speeds_are_those_of_the_differential_equation)
{
    struct running_case c;
    char *deck = deck_of(2.4e8, "", "");
    assert_int_equal(running_case_open(deck, 30000, 9, 0, &c), ROTID_OK);
    c.x[0] = truth.e;
    c.x[1] = truth.g;
    assert_int_equal(running_case_run(&c, NULL, 30000, 9, 0), ROTID_OK);
    for (int whirl = FORWARD; whirl <= BACKWARD; whirl += BACKWARD - FORWARD)
        for (int i = 0, k = 0; i < c.speeds.ncritical_speeds; i++)
            if (!strcmp(c.speeds.critical_speeds[i].whirl, whirl == FORWARD ? "forward" : "backward"))
                assert_close(c.speeds.critical_speeds[i].speed_rpm, frequency(&truth, 50, whirl, ++k) / RPM, 2e-5, 0);
    running_case_close(&c);
}

POOL_TEST(bearings_and_core_are_identified_together)
{
    char *text = deck_of(2e8, "", pool_format(&test_pool, "%s*IDENTIFY\na.k, 0.2, 5, 0.8\n", readings(10)));
    rotid_identification *found = identify(text, ROTID_OK);
    assert_int_equal(found->nparameters, 3);
    assert_string_equal(found->status, "converged");
    assert_string_equal(found->parameters[2].name, "a.k");
    assert_string_equal(found->parameters[2].unit, "1");
    assert_close(found->parameters[0].value, truth.e, 2e-4, 0);
    assert_close(found->parameters[1].value, truth.g, 1e-3, 0);
    assert_close(found->parameters[2].value, 1.2, 1e-3, 0);
    assert_int_equal(found->dof, 4 + 2 - 3);
    assert_true(found->parameters[2].identifiable && found->parameters[2].std < 0.05);
    assert_int_equal(found->nrunup, 2);
    for (int i = 0; i < 2; i++) {
        assert_close(found->runup[i].predicted_rpm, found->runup[i].measured_rpm, 1e-4, 0);
        assert_close(found->runup[i].measured_std, 10, 1e-12, 0);
        assert_true(!found->runup[i].holdout && fabs(found->runup[i].z) < 0.2);
        assert_true(found->runup[i].predicted_std < 11); /* of the fit: STD of the bearing is replaced by it */
    }
    rotid_identification_free(found);
}

/* The deviation of the bearing from the first reading alone: std_k = std_W/(dW/dk), by the differential equation. */
POOL_TEST(a_reading_weighs_by_its_standard_deviation)
{
    struct shaft side[2] = {truth, truth};
    for (int i = 0; i < 2; i++)
        side[i].stiffness[0] = side[i].stiffness[1] = truth.stiffness[0] * (i ? 1.01 : 0.99);
    double rate = (frequency(&side[1], 50, FORWARD, 1) - frequency(&side[0], 50, FORWARD, 1)) / 0.02 / RPM, /* by ln k */
        measured = frequency(&truth, 50, FORWARD, 1) / RPM;
    char *text = deck_of(2e8, "", pool_format(&test_pool, "*RUNUP\n1, %.12g, 200\n*IDENTIFY\na.k, 0.2, 5, 1\n", measured));
    rotid_identification *found = identify(text, ROTID_OK);
    /* the moduli, which the modes determine to 1e-4, add nothing */
    assert_close(found->parameters[2].std / found->parameters[2].value, 200 / rate, 5e-3, 0);
    rotid_identification_free(found);
}

POOL_TEST(a_run_up_that_is_held_out_shows_a_wrong_bearing)
{
    for (int wrong = 0; wrong < 2; wrong++) {
        rotid_identification *found = identify(deck_of(wrong ? 1.6e8 : 2.4e8, ", HOLDOUT=RUNUP", readings(10)), ROTID_OK);
        assert_int_equal(found->nparameters, 2);
        assert_int_equal(found->dof, 2);
        assert_int_equal(found->nrunup, 2);
        const rotid_runup_speed *first = &found->runup[0];
        assert_true(first->holdout);
        if (wrong)
            assert_true(first->z > 4 && first->predicted_rpm < first->measured_rpm);
        else
            assert_true(fabs(first->z) < 0.1);
        assert_close(first->z, (first->measured_rpm - first->predicted_rpm) / hypot(10, first->predicted_std), 1e-9, 1e-11);
        assert_true(first->predicted_std > 20); /* of the bearings: 5 % of their stiffness */
        rotid_identification_free(found);
    }
}

/* A diagnosis at rest says the same of the machine: what stays in the model goes on in operation. */
POOL_TEST(a_diagnosis_has_the_run_up_beside_it)
{
    for (int wrong = 0; wrong < 2; wrong++) {
        const char *text = deck_of(wrong ? 1.6e8 : 2.4e8, ", HOLDOUT=RUNUP", readings(10));
        rotid_identification *found = identify(text, ROTID_OK);
        rotid_deck *deck;
        rotid_diagnosis *d;
        char failure[ROTID_FAILURE_LENGTH] = "";
        assert_status(rotid_deck_read_text(strlen(text), text, "deck", NULL, 0, NULL, NULL, failure, &deck), ROTID_OK);
        assert_status(rotid_diagnose(deck, NULL, NULL, failure, &d), ROTID_OK);
        assert_int_equal(d->base->nrunup, 2);
        for (int i = 0; i < 2; i++) {
            assert_true(d->base->runup[i].holdout);
            assert_close(d->base->runup[i].predicted_rpm, found->runup[i].predicted_rpm, 2e-3,
                         0); /* another fit of exact modes */
        }
        assert_true(wrong == (d->base->runup[0].z > 4));
        rotid_diagnosis_free(d);
        rotid_identification_free(found);
        rotid_deck_free(deck);
    }
}

static rotid_diagnosis *diagnose(char *text)
{
    memcpy(strstr(text, "0, 200\n"), "0, 120\n", strlen("0, 120\n")); /* which suffices for this noise */
    memcpy(strstr(text, "FREQUENCY=1e-4"), "FREQUENCY=3e-3", strlen("FREQUENCY=3e-3"));
    rotid_deck *deck;
    rotid_diagnosis *d;
    char failure[ROTID_FAILURE_LENGTH] = "";
    assert_status(rotid_deck_read_text(strlen(text), text, "deck", NULL, 0, NULL, NULL, failure, &deck), ROTID_OK);
    assert_status(rotid_diagnose(deck, NULL, NULL, failure, &d), ROTID_OK);
    rotid_deck_free(deck);
    return d;
}

static double share_of(const rotid_diagnosis *d, const char *cause)
{
    double sum = 0;
    for (int i = 0; i < d->verdict.nmarginals; i++)
        sum += strcmp(d->verdict.marginals[i].id, cause) ? 0 : d->verdict.marginals[i].probability;
    return sum;
}

static double odds(double probability)
{
    return probability / (1 - probability);
}

/* A mass that nobody stated goes on in operation, a support of the test does not. */
POOL_TEST(measured_critical_speeds_tell_causes_apart)
{
    struct shaft loaded = truth, supported = truth;
    double before[2] = {0, 0}, after[2];
    loaded.mass = 6;
    supported.support = 4e6;
    for (int support = 0; support < 2; support++) {
        const struct shaft *is = support ? &supported : &loaded;
        const char *cause[2] = {support ? "support_extra" : "added_mass", support ? "support_rotation" : "none"};
        struct shaft machine = *is;
        machine.support = 0;
        for (int joined = support; joined < 2; joined++) {
            rotid_diagnosis *d = diagnose(deck_of_shaft(*is, 2.4e8, joined ? "" : ", HOLDOUT=RUNUP", readings_of(&machine, 5)));
            (joined ? after : before)[support] = share_of(d, cause[0]) + share_of(d, cause[1]);
            assert_int_equal(isfinite(d->verdict.runup_p), joined);
            if (joined) {
                double sum = 0;
                for (int i = 0; i < d->verdict.nexplanations; i++)
                    sum += d->verdict.explanations[i].at_rest;
                assert_true(sum < 1 && sum > 0.01 && d->verdict.runup_p > 0.01);
                for (int i = 0; i < 3 && support; i++) /* before a mass at either of two places that are alike */
                    assert_memory_equal(d->verdict.explanations[i].causes[0].id, "support_", strlen("support_"));
            }
            for (int i = 0; i < 2; i++)
                assert_int_equal(d->base->runup[i].holdout, 1); /* no fit has seen them */
            rotid_diagnosis_free(d);
        }
        assert_true(after[support] > (support ? 0.75 : 0.8));
        assert_true(support || odds(after[0]) > 5 * odds(before[0]));
    }
}

/* ln p(W^ | rest) and the moduli by sums over a grid of E, G and of the stiffness of the bearings, every critical speed solved.
 */
POOL_TEST(what_a_run_up_teaches_is_the_integral)
{
    enum { MODULI = 5, BEARINGS = 41 };
    static const double node[MODULI] = {-2.8569700138728, -1.3556261799743, 0, 1.3556261799743, 2.8569700138728},
                        share[MODULI] = {0.011257411327721, 0.22207592200561, 0.53333333333333, 0.22207592200561,
                                         0.011257411327721}; /* Gauss-Hermite, of a normal */
    static const double nearby[2] = {1.02, 1.42};            /* beyond there is no weight */
    for (int open = 0; open < 2; open++) {                   /* is the stiffness of the bearings an unknown? */
        char *text =
            deck_of_shaft(truth, open ? 2e8 : 2.38e8, "",
                          pool_format(&test_pool, "%s%s", readings(open ? 25 : 60), open ? "*IDENTIFY\na.k, 0.5, 2.5, 1\n" : ""));
        memcpy(strstr(text, "FREQUENCY=1e-4"), "FREQUENCY=1e-2", strlen("FREQUENCY=1e-2"));
        memcpy(strstr(text, "STD=0.05"), "STD=0.00", strlen("STD=0.00"));
        memcpy(strstr(text, "0, 200\n"), "0, 40 \n", strlen("0, 40 \n"));
        rotid_identification *rest;
        rotid_deck *deck, *held;
        struct message_list notes;
        struct states joined;
        struct runup *runup;
        const char *at = strstr(text, "LIKELIHOOD") + strlen("LIKELIHOOD");
        char *without = pool_format(&test_pool, "%.*s, HOLDOUT=RUNUP%s", (int)(at - text), text, at);
        if (open) /* what is to be identified needs its readings */
            *strstr(without, "*IDENTIFY\na.k") = 0;
        assert_status(rotid_deck_read_text(strlen(without), without, "deck", NULL, 0, NULL, NULL, NULL, &held), ROTID_OK);
        assert_status(rotid_deck_read_text(strlen(text), text, "deck", NULL, 0, NULL, NULL, NULL, &deck), ROTID_OK);
        assert_status(rotid_identify(held, 0, NULL, NULL, &rest), ROTID_OK);
        const rotid_fit_result *fit = rest->fit;
        assert_int_equal(fit->n, 2);
        const struct states *states = deck_states_of(deck);
        double mean[2] = {fit->x[0], fit->x[1]}, std[2] = {fit->std[0], fit->std[1]}, log_z, chi2;
        message_open(&notes, &test_pool);
        assert_status(runup_learn(&test_pool, states, states, fit, 2, mean, std, &log_z, &chi2), ROTID_OK);
        assert_status(runup_join(&test_pool, states, &notes, &joined, &runup), ROTID_OK);
        /* ln E and ln G are normal: L L' = C */
        double c00 = fit->covariance[0] / fit->x[0] / fit->x[0], c01 = fit->covariance[1] / fit->x[0] / fit->x[1],
               c11 = fit->covariance[3] / fit->x[1] / fit->x[1], l00 = sqrt(c00), l10 = c01 / l00, l11 = sqrt(c11 - l10 * l10),
               sum = 0, first = 0, second = 0, span = log(nearby[1] / nearby[0]);
        for (int i = 0; i < MODULI; i++)
            for (int j = 0; j < MODULI; j++)
                for (int k = 0; k < (open ? BEARINGS : 1); k++) {
                    double r[2], x[3] = {fit->x[0] * exp(l00 * node[i]), fit->x[1] * exp(l10 * node[i] + l11 * node[j]),
                                         nearby[0] * exp(span * (k + 0.5) / BEARINGS)};
                    assert_status(joined.more->residual(joined.more->user, x, r), ROTID_OK);
                    double weight = share[i] * share[j] * exp(-(r[0] * r[0] + r[1] * r[1]) / 2);
                    if (open) /* of a uniform density between the bounds */
                        weight *= span / BEARINGS / log(2.5 / 0.5);
                    sum += weight;
                    first += weight * log(x[0] / fit->x[0]);
                    second += weight * log(x[0] / fit->x[0]) * log(x[0] / fit->x[0]);
                }
        double exact = log(sum), relative = first / sum;
        for (int i = 0; i < 2; i++) { /* a density of ln W */
            const struct runup_reading *reading = &states->machine->runup[i];
            exact += log(reading->speed / reading->std) - log(2 * pi) / 2;
        }
        assert_close(log_z, exact, 0, 0.3);
        assert_close(log(mean[0] / fit->x[0]), relative, 0, 0.1 * sqrt(c00));
        assert_close(std[0] / fit->x[0], sqrt(second / sum - relative * relative), 0.1, 0);
        runup_close(runup);
        rotid_identification_free(rest);
        rotid_deck_free(deck);
        rotid_deck_free(held);
    }
}

/* The unknowns of the machine stand behind those of all states, and the fit of all has their covariance. */
POOL_TEST(states_share_the_machine)
{
    struct shaft free = truth;
    const rotid_speeds_options options = {.size = sizeof options, .draws = 30, .count = 9};
    rotid_speeds *speeds;
    rotid_deck *deck;
    free.stiffness[0] = free.stiffness[1] = 0;
    char *text = pool_format(
        &test_pool, "*MATERIAL, NAME=l\n*ELASTIC, TYPE=SHEAR\n1.25e11, 2.5e10, 0.28\n*DENSITY\n7600\n*SHAFT, NAME=core, "
                    "MATERIAL=l\n2, 0.2, 0, 200\n*NOISE, FREQUENCY=1e-4\n*IDENTIFY\ncore.E, 5e10, 3e11, 1.25e11\ncore.G, "
                    "5e9, 1e11, 2.5e10\n");
    for (int s = 0; s < 2; s++) {
        text = pool_format(&test_pool, "%s*STATE, NAME=s%d\n*MODES\n", text, s);
        for (int k = 1 + s; k <= 3 + s; k++)
            text = pool_format(&test_pool, "%s%d, %.12g\n", text, k, frequency(&free, 50, AT_REST, k) / (2 * pi));
    }
    text = pool_format(&test_pool,
                       "%s*RUNNING\n*BEARING, NAME=a\n0.3, 2e8, 0\n*BEARING, NAME=b, LIKE=a\n1.7, 2e8, 0\n%s*IDENTIFY\n"
                       "a.k, 0.2, 5, 1\n",
                       text, readings(10));
    rotid_identification *found = identify(text, ROTID_OK);
    assert_int_equal(found->nstates, 2);
    assert_int_equal(found->dof, 3 + 3 + 2 - 3);
    assert_string_equal(found->parameters[2].name, "a.k");
    assert_close(found->parameters[2].value, 1.2, 1e-3, 0);
    assert_close(found->parameters[0].value, truth.e, 2e-4, 0);
    assert_int_equal(found->nrunup, 2);
    assert_close(found->runup[1].predicted_rpm, found->runup[1].measured_rpm, 1e-4, 0);
    assert_status(rotid_deck_read_text(strlen(text), text, "deck", NULL, 0, NULL, NULL, NULL, &deck), ROTID_OK);
    assert_status(rotid_speeds_compute(deck, &options, NULL, NULL, &speeds), ROTID_OK);
    const rotid_critical_speed *c = &speeds->critical_speeds[0];
    assert_string_equal(c->variance_shares[0].source, "identified");
    assert_true(isfinite(c->std) && c->std > 0 && c->ci95[0] < c->speed_rpm && c->speed_rpm < c->ci95[1]);
    rotid_speeds_free(speeds);
    rotid_deck_free(deck);
    rotid_identification_free(found);
}

/* What is said of a run-up that no machine of that deck has. */
static const char *refusal_of(const char *runup)
{
    char failure[ROTID_FAILURE_LENGTH];
    rotid_deck *deck;
    rotid_identification *found;
    char *text = deck_of(2e8, "", runup);
    assert_status(rotid_deck_read_text(strlen(text), text, "deck", NULL, 0, NULL, NULL, failure, &deck), ROTID_OK);
    assert_status(rotid_identify(deck, 0, NULL, failure, &found), ROTID_ERROR_ARGUMENT);
    rotid_deck_free(deck);
    print_message("%s\n", failure);
    return pool_copy_text(&test_pool, failure);
}

/* A search so far beyond the third mode would take minutes. */
POOL_TEST(a_speed_far_beyond_the_machine_is_refused)
{
    const char *said = refusal_of("*RUNUP\n1, 5000, 10\n2, 1e7, 10\n");
    assert_non_null(strstr(said, "speeds up to 1.1e+07 rpm, expected at most 2.31e+05 rpm for this machine"));
}

POOL_TEST(a_number_that_the_model_does_not_have_is_refused)
{
    const char *said = refusal_of("*RUNUP\n90, 5000, 10\n");
    assert_non_null(strstr(said, "expected number 90 of *RUNUP"));
    assert_non_null(strstr(said, "deck:"));
}

/* dW/dp of a machine with everything, beside differences of residuals that are solved again. */
POOL_TEST(derivatives_are_those_of_differences)
{
    static const char text[] =
        "*MATERIAL, NAME=s\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n*MATERIAL, NAME=l\n*ELASTIC, TYPE=SHEAR\n1.1e11, 3e10, "
        "0.28\n*DENSITY\n7600\n*SHAFT, NAME=left, MATERIAL=s\n0.3, 0.10, 0, 12\n0.2, 0.16, 0.02, 8\n*SHAFT, NAME=core, "
        "MATERIAL=l\n0.7, 0.30, 0, 20\n*SHAFT, NAME=right, MATERIAL=s\n0.4, 0.11, 0, 14\n*NOISE, FREQUENCY=1e-3\n*MODES\n1, "
        "200\n*IDENTIFY\ncore.E, 1e10, 1e12, 1.1e11\ncore.G, 1e9, 1e12, 3e10\nleft.E, 1e10, 1e12, 2.1e11\n*RUNNING\n*DISK\nend, "
        "12, 0.1, 0.18\n*BEARING, NAME=a\n0.15, 8e7, 2e7, -1e7, 6e7, 3e4, -2e3, 1e3, 2.5e4\n*BEARING, NAME=b\n1.5, 9e7, 7e7, "
        "2e4, "
        "3e4\n*PEDESTAL, BEARING=b\n150, 200, 6e8, 4e8, 1e4, 2e4\n*PULL, GROUP=core\n1e7\n*LOSS\ncore, 0.02\n*RUNUP\n1, 4000, "
        "10\n2, 9000, 20\n1, 3500, 10, BACKWARD\n*IDENTIFY\na.k, 0.1, 10, 1.1\na.c, 0.1, 10, 0.9\nb.k, 0.1, 10, 1\n";
    enum { N = 6, ROWS = 3 };
    struct message_list notes;
    struct states joined;
    struct runup *runup;
    rotid_deck *deck;
    char failure[ROTID_FAILURE_LENGTH];
    assert_status(rotid_deck_read_text(strlen(text), text, "deck", NULL, 0, NULL, NULL, failure, &deck), ROTID_OK);
    message_open(&notes, &test_pool);
    assert_status(runup_join(&test_pool, deck_states_of(deck), &notes, &joined, &runup), ROTID_OK);
    assert_int_equal(joined.nparameter, N);
    assert_int_equal(joined.more->count, ROWS);
    double x[N], r[2][ROWS], jacobian[(ROWS + 2) * N] = {0};
    for (int p = 0; p < N; p++)
        x[p] = joined.bounds[p].start;
    assert_status(joined.more->residual(joined.more->user, x, r[0]), ROTID_OK);
    assert_status(joined.more->jacobian(joined.more->user, x, ROWS + 2, jacobian + 2), ROTID_OK);
    for (int p = 0; p < N; p++) {
        double step = 1e-4 * x[p];
        for (int side = 0; side < 2; side++) {
            x[p] = joined.bounds[p].start + (side ? step : -step);
            assert_status(joined.more->residual(joined.more->user, x, r[side]), ROTID_OK);
        }
        x[p] = joined.bounds[p].start;
        for (int i = 0; i < ROWS; i++) {
            double by_difference = (r[1][i] - r[0][i]) / (2 * step),
                   scale = fabs(jacobian[2 + i]) * joined.bounds[0].start / x[p];
            assert_close(jacobian[2 + i + (ROWS + 2) * p], by_difference, 1e-6, 1e-5 * scale);
        }
    }
    runup_close(runup);
    rotid_deck_free(deck);
}

/* What changed between two states is judged in the rotor of the second one, the machine has that of the first. */
POOL_TEST(what_changed_between_states_has_no_run_up)
{
    static const char text[] =
        "*MATERIAL, NAME=s\n*ELASTIC\n2e11, 0.3\n*DENSITY\n7800\n*SHAFT, NAME=a, MATERIAL=s\n1, 0.05, 0, 12\n*NOISE, "
        "FREQUENCY=1e-3\n*IDENTIFY\na.E, 1e10, 1e12, 2e11\n*STATE, NAME=bare\n*MODES\n1, 222\n2, 605\n*STATE, NAME=disc\n*DISK, "
        "NAME=hub\n0.3, 1\n*MODES\n1, 221\n2, 570\n*RUNNING\n*BEARING, NAME=p\nstart, 5e6, 100\n*BEARING, NAME=q\nend, 5e6, "
        "100\n*RUNUP\n1, 4200, 50\n";
    const rotid_diagnose_options options = {.size = sizeof options, .before = "bare", .after = "disc"};
    rotid_deck *deck;
    rotid_diagnosis *r;
    assert_status(rotid_deck_read_text(strlen(text), text, NULL, NULL, 0, NULL, NULL, NULL, &deck), ROTID_OK);
    assert_status(rotid_diagnose(deck, &options, NULL, NULL, &r), ROTID_OK);
    assert_non_null(r->base);
    assert_int_equal(r->base->nrunup, 0);
    rotid_diagnosis_free(r);
    rotid_deck_free(deck);
}
