#include <math.h>

#include "report/report.h"

#define WIDTH       100
#define MOST_LISTED 24 /* sensors; more with --verbose */

static void print_plans(FILE *out, const rotid_suggestion *s, int all)
{
    (void)fprintf(out,
                  "\nSENSORS  %d modes; gain: how far the standard deviations of moduli and causes fall below those of the\n"
                  "         frequencies alone; loss: how far they rise without one sensor (geometric means)\n",
                  s->plan_modes);
    (void)fprintf(out, "%-24s gain [%%]", "plan");
    for (int p = 0; p < s->nparameters; p++) {
        (void)fputc(' ', out);
        text_cell(out, 12, s->parameters[p].name);
    }
    (void)fputs(" +-[%]\n", out);
    for (int i = 0; i < s->nplans; i++) {
        const rotid_sensor_plan *plan = &s->plans[i];
        struct wrap wrap;
        text_cell(out, 24, plan->method);
        number_cell(out, 9, 1, plan->gain_percent);
        for (int p = 0; p < plan->nhalf_width_percent; p++)
            number_cell(out, 13, 3, plan->half_width_percent[p]);
        (void)fputc('\n', out);
        if (plan->nz_m > MOST_LISTED && !all)
            continue;
        wrap_open(&wrap, out, 6, WIDTH, "    z: ");
        for (int k = 0; k < plan->nz_m; k++)
            wrap_item(&wrap, "%.4g m (%.2g %%)%s", plan->z_m[k], plan->loss_percent[k], k + 1 < plan->nz_m ? "," : "");
        wrap_close(&wrap);
    }
}

static void print_modes(FILE *out, const rotid_suggestion *s)
{
    if (!s->nmodes || !s->nparameters)
        return;
    (void)fprintf(
        out, "\nEXPECTED INTERVALS  half of 95 %%, in percent of the value: by frequencies / with shapes at the first plan\n");
    (void)fprintf(out, "modes");
    for (int p = 0; p < s->nparameters; p++) {
        (void)fputs("  ", out);
        text_cell(out, 20, s->parameters[p].name);
    }
    (void)fputc('\n', out);
    for (int i = 0; i < s->nmodes; i++) {
        (void)fprintf(out, "%5d", s->modes[i].modes);
        for (int p = 0; p < s->nparameters; p++) {
            number_cell(out, 9, 3, s->modes[i].frequencies_percent[p]);
            (void)fputs(" /", out);
            number_cell(out, 9, 3, s->modes[i].shapes_percent[p]);
            (void)fputs("  ", out);
        }
        (void)fputc('\n', out);
    }
    (void)fprintf(out, "wanted %g %%: ", s->wanted_percent);
    if (s->modes_needed != ROTID_NONE)
        (void)fprintf(out, "frequencies of %d modes", s->modes_needed);
    else if (s->sensors_needed != ROTID_NONE)
        (void)fprintf(out, "shapes of %d modes at the %d best points", s->plan_modes, s->sensors_needed);
    else
        (void)fprintf(out, "not reached by 8 modes, nor by %d modes at %d points", s->plan_modes,
                      s->ncounts ? s->counts[s->ncounts - 1].sensors : 0);
    (void)fputc('\n', out);
}

static void print_limits(FILE *out, const rotid_suggestion *s)
{
    if (!s->ndetectable)
        return;
    (void)fprintf(out, "\nDETECTION LIMITS  of the first plan, 9 times in 10 at 3 %% of false alarms\n");
    for (int i = 0; i < s->ndetectable; i++) {
        const rotid_detectable *d = &s->detectable[i];
        text_cell(out, 20, d->id);
        (void)fputc(' ', out);
        text_cell(out, 20, d->target);
        if (d->beyond) {
            (void)fprintf(out, " %s: no possible size would show\n", d->parameter);
            continue;
        }
        (void)fprintf(out, " %s %s%s%s", d->parameter, IN_DIGITS(3, d->smallest), layout_gap(d->unit), layout_unit(d->unit));
        if (isfinite(d->z_m))
            (void)fprintf(out, " at %.4g m, at worst %s", d->z_m, IN_DIGITS(3, d->worst));
        (void)fputc('\n', out);
    }
}

static void print_rivals(FILE *out, const rotid_suggestion *s)
{
    if (!s->nrivals)
        return;
    (void)fprintf(out, "\nRIVALS   chi2      score   share\n");
    for (int i = 0; i < s->nrivals; i++) {
        (void)fprintf(out, "%3d ", i + 1);
        number_cell(out, 9, 2, s->rivals[i].chi2);
        number_cell(out, 11, 2, s->rivals[i].score);
        number_cell(out, 8, 2, s->rivals[i].share);
        (void)fputs("  ", out);
        name_cell(out, 1, s->rivals[i].label);
        (void)fputc('\n', out);
    }
    (void)fprintf(out, "the true one is among them with a chance of %.2f; the chances of the tests allow for it\n", s->among);
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

static void print_tests(FILE *out, const rotid_suggestion *s, int all)
{
    if (!s->ntests)
        return;
    (void)fprintf(out, "\nTESTS  chance: that the true one of the rivals is named; margin: lead expected of 1, were it true, "
                       "over (the closest other)\n"
                       "chance wrong   cost set-ups points modes    margin\n");
    for (int i = 0; i < s->ntests; i++) {
        const rotid_suggested_test *t = &s->tests[i];
        const rotid_expected_margin *m = closest(s, t);
        (void)fprintf(out, "%6.2f %5.2f", t->chance, t->wrong);
        number_cell(out, 7, 0, t->cost);
        (void)fprintf(out, " %7d %6d %5d", t->setups, t->points, t->modes);
        number_cell(out, 10, 1, m ? m->expected : (double)NAN);
        if (m)
            (void)fprintf(out, " (%d)", m->rival + 1);
        (void)fputs("  ", out);
        name_cell(out, 1, t->text);
        (void)fputc('\n', out);
        for (int k = 0; k < t->nmargins && all; k++) {
            const rotid_expected_margin *one = &t->margins[k];
            (void)fprintf(out, "         %d true, beside %d: %.3g measured, %.3g without noise, %.3g expected", one->truth + 1,
                          one->rival + 1, one->before, one->before + one->distance, one->expected);
            if (isfinite(one->refitted))
                (void)fprintf(out, ", %.3g refitted", one->refitted);
            (void)fprintf(out, ", chance %.2f\n", one->chance);
        }
    }
    (void)fprintf(out, "a set-up costs as much as %g points\n", s->set_up_cost);
}

void table_suggest(FILE *out, const struct result *result, int all)
{
    const rotid_suggestion *s = result->suggest;
    table_heading(out, &result->head);
    (void)fputs("\nSUGGESTION\n", out);
    wrap_text(out, 2, WIDTH, "  ", s->sentence);
    if (s->verdict)
        wrap_text(out, 2, WIDTH, "  diagnosis: ", s->verdict);
    if (s->state)
        (void)fprintf(out, "  state: plans and tests are made like %s\n", s->state);
    (void)fprintf(out, "  noise: %.3g %% of frequencies%s, %.3g %% of shapes%s\n", 100 * s->noise.frequency,
                  s->noise.frequency_assumed ? " (assumed)" : "", 100 * s->noise.shape,
                  s->noise.shape_assumed ? " (assumed)" : "");
    print_rivals(out, s);
    print_tests(out, s, all);
    print_modes(out, s);
    print_plans(out, s, all);
    print_limits(out, s);
}
