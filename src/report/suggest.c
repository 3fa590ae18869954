/* `rotid suggest` on the screen, and its tables. */
#include "report/report.h"

#define MOST_LISTED 24 /* places of a plan; more with --verbose */

static double or_nan(int i, int count, const double *value)
{
    return i < count ? value[i] : (double)NAN;
}

/* "0.1 m (3 %), 0.5 m (12 %)" */
static const char *places_of(struct pool *pool, const rotid_sensor_plan *plan)
{
    const char *text = "";
    for (int k = 0; k < plan->nz_m; k++)
        text = pool_text(pool, "%s%s%s (%s\xc2\xa0%%)", text, k ? ", " : "", human_value(pool, plan->z_m[k], "m"),
                         human_digits(pool, plan->loss_percent[k], 2));
    return text;
}

static struct table *table_of_plans(struct pool *pool, const rotid_suggestion *s, int all)
{
    struct table *table =
        table_open(pool, "Plans of sensors: half-widths of 95 % intervals in per cent of the parameters; places, and "
                         "how far the deviations rise without the sensor there");
    table_note(table,
               "For %d modes; gain: how far the standard deviations of moduli and causes fall below those of the "
               "frequencies alone (geometric mean).",
               s->plan_modes);
    for (int i = 0; i < s->nplans; i++) {
        const rotid_sensor_plan *p = &s->plans[i];
        text_column(table, "plan", SHOW_TEXT, strcmp(p->method, "effective_independence") ? p->method : "effective independence");
        number_column(table, "sensors", NULL, SHOW_COUNT, p->nz_m);
        number_column(table, "gain", "%", SHOW_FIXED(1), p->gain_percent);
        for (int j = 0; j < s->nparameters; j++)
            number_column(table, s->parameters[j].name, "%", SHOW_DIGITS(3),
                          or_nan(j, p->nhalf_width_percent, p->half_width_percent));
        row_note(table, all || p->nz_m <= MOST_LISTED ? places_of(pool, p) : "");
    }
    return table;
}

static struct table *table_of_expected(struct pool *pool, const rotid_suggestion *s)
{
    struct table *table = table_open(pool, "Half-widths of the 95 % intervals that are expected, by the number of modes");
    for (int i = 0; i < s->nmodes && s->nparameters; i++) {
        const rotid_expected_modes *m = &s->modes[i];
        number_column(table, "modes", NULL, SHOW_COUNT, m->modes);
        for (int p = 0; p < s->nparameters; p++) {
            const char *name = s->parameters[p].name;
            number_column(table, i ? "" : pool_text(pool, "%s by frequencies", name), "%", SHOW_DIGITS(3),
                          or_nan(p, m->nfrequencies_percent, m->frequencies_percent));
            number_column(table, i ? "" : pool_text(pool, "%s with shapes", name), "%", SHOW_DIGITS(3),
                          or_nan(p, m->nshapes_percent, m->shapes_percent));
        }
    }
    if (s->modes_needed != ROTID_NONE)
        table_note(table, "Wanted %g %%: frequencies of %d modes", s->wanted_percent, s->modes_needed);
    else if (s->sensors_needed != ROTID_NONE)
        table_note(table, "Wanted %g %%: shapes of %d modes at the %d best points", s->wanted_percent, s->plan_modes,
                   s->sensors_needed);
    else
        table_note(table, "Wanted %g %%: not reached by 8 modes, nor by %d modes at %d points", s->wanted_percent, s->plan_modes,
                   s->ncounts ? s->counts[s->ncounts - 1].sensors : 0);
    return table;
}

static struct table *table_of_rivals(struct pool *pool, const rotid_suggestion *s)
{
    struct table *table = table_open(pool, "Rivals: what the diagnosis cannot tell apart");
    for (int i = 0; i < s->nrivals; i++) {
        number_column(table, "number", NULL, SHOW_COUNT, i + 1);
        text_column(table, "rival", SHOW_TEXT, s->rivals[i].label);
        number_column(table, "chi2", NULL, SHOW_FIXED(2), s->rivals[i].chi2);
        number_column(table, "score", NULL, SHOW_FIXED(2), s->rivals[i].score);
        number_column(table, "share", NULL, SHOW_FIXED(2), s->rivals[i].share);
    }
    table_note(table, "The true one is among them with a chance of %.2f; the chances of the tests allow for that.", s->among);
    return table;
}

/* Of the best rival, were it true: the other one that a test tells from it least, the model as it is where there is no other. */
static const rotid_expected_margin *closest(const rotid_suggestion *s, const rotid_suggested_test *test)
{
    const rotid_expected_margin *least = NULL;
    for (int i = 0; i < test->nmargins; i++) {
        const rotid_expected_margin *m = &test->margins[i];
        if (m->truth || (m->rival == s->nrivals - 1 && s->nrivals > 2))
            continue;
        if (!least || m->expected < least->expected)
            least = m;
    }
    return least;
}

static struct table *table_of_tests(struct pool *pool, const rotid_suggestion *s)
{
    struct table *table = table_open(pool, "Tests: the chance that the true one of the rivals is named, what it takes");
    int narrow = 0; /* the test after which the first parameter is known best */
    for (int i = 1; i < s->ntests; i++)
        if (s->tests[i].nexpected_percent && s->tests[i].expected_percent[0] < s->tests[narrow].expected_percent[0])
            narrow = i;
    if (s->ntests)
        table_note(table,
                   "Sorted by how far the entropy of the shares of the rivals falls (now %.2f); %s is known best after test "
                   "%d. +-: half of the 95 %% interval, averaged over the rivals; margin: lead of rival 1 that is expected, "
                   "were it true, over the closest other one; a set-up costs as much as %g points.",
                   s->entropy, s->nparameters ? s->parameters[0].name : "nothing", narrow + 1, s->set_up_cost);
    for (int i = 0; i < s->ntests; i++) {
        const rotid_suggested_test *t = &s->tests[i];
        const rotid_expected_margin *m = closest(s, t);
        number_column(table, "chance", NULL, SHOW_FIXED(2), t->chance);
        number_column(table, "wrong", NULL, SHOW_FIXED(2), t->wrong);
        number_column(table, "entropy", NULL, SHOW_FIXED(2), t->entropy);
        for (int p = 0; p < t->nexpected_percent && p < s->nparameters && p < 2; p++) {
            const char *head = pool_text(pool, "%s +-", s->parameters[p].name);
            number_column(table, head, "%", SHOW_DIGITS(3), t->expected_percent[p]);
        }
        number_column(table, "cost", NULL, SHOW_TRIMMED(4), t->cost);
        number_column(table, "set-ups", NULL, SHOW_COUNT, t->setups);
        number_column(table, "points", NULL, SHOW_COUNT, t->points);
        number_column(table, "modes", NULL, SHOW_COUNT, t->modes);
        number_column(table, "margin", NULL, SHOW_FIXED(1), m ? m->expected : (double)NAN);
        number_column(table, "over", NULL, SHOW_COUNT, m ? m->rival + 1 : (double)NAN);
        text_column(table, "test", SHOW_TEXT, t->text);
    }
    return table;
}

static struct table *table_of_margins(struct pool *pool, const rotid_suggestion *s)
{
    struct table *table = table_open(pool, "Leads of the true rival over another one by a test (number in the table above)");
    for (int i = 0; i < s->ntests; i++)
        for (int k = 0; k < s->tests[i].nmargins; k++) {
            const rotid_expected_margin *m = &s->tests[i].margins[k];
            number_column(table, "test", NULL, SHOW_COUNT, i + 1);
            number_column(table, "true", NULL, SHOW_COUNT, m->truth + 1);
            number_column(table, "over", NULL, SHOW_COUNT, m->rival + 1);
            number_column(table, "measured", NULL, SHOW_DIGITS(3), m->before);
            number_column(table, "without noise", NULL, SHOW_DIGITS(3), m->before + m->distance);
            number_column(table, "expected", NULL, SHOW_DIGITS(3), m->expected);
            number_column(table, "refitted", NULL, SHOW_DIGITS(3), m->refitted);
            number_column(table, "chance", NULL, SHOW_FIXED(2), m->chance);
        }
    return table;
}

static struct table *table_of_speed_tests(struct pool *pool, const rotid_suggestion *s)
{
    struct table *table =
        table_open(pool, "Tests at rest: standard deviation of the critical speed that is expected behind each");
    table_note(table, "As measured %s rpm, %.0f %% of that variance by the unknowns. In linear prediction.",
               isfinite(s->speed_std) ? pool_text(pool, "%.3g", s->speed_std) : "not known,", 100 * s->speed_identified);
    for (int i = 0; i < s->nspeed_tests; i++) {
        text_column(table, "test", SHOW_TEXT, s->speed_tests[i].test);
        number_column(table, "modes", NULL, SHOW_COUNT | DETAIL, s->speed_tests[i].modes);
        number_column(table, "std", "rpm", SHOW_DIGITS(4), s->speed_tests[i].std_rpm);
        number_column(table, "narrower by", "%", SHOW_FIXED(1), s->speed_tests[i].narrowed_percent);
    }
    return table;
}

struct shown shown_of_suggestion(struct pool *pool, const rotid_suggestion *s, int all)
{
    int speed = isfinite(s->speed_rpm); /* tests for a critical speed, in place of plans and rivals */
    struct shown shown = {.said.pool = pool,
                          .table = {speed ? table_of_speed_tests(pool, s) : table_of_rivals(pool, s), table_of_tests(pool, s),
                                    table_of_expected(pool, s), table_of_plans(pool, s, all),
                                    table_of_detectable(pool, s->ndetectable, s->detectable),
                                    all ? table_of_margins(pool, s) : NULL}};
    if (s->verdict)
        reasons_say(&shown.said, "diagnosis: %s", s->verdict);
    if (s->state)
        reasons_say(&shown.said, "state: plans and tests are made like %s", s->state);
    reasons_say(&shown.said, "noise: %s", noise_in_words(pool, &s->noise));
    return shown;
}

void screen_suggest(const struct screen *to, const struct result *result)
{
    const struct shown shown = shown_of_suggestion(to->pool, result->suggest, to->verbose);
    screen_say(to, "\nSUGGESTION");
    screen_paragraph(to, "  ", result->suggest->sentence);
    screen_shown(to, &shown);
}
