#include <math.h>
#include <stdio.h>
#include <string.h>

#include "report/chart.h"
#include "report/layout.h"
#include "report/table_diagnose.h"
#include "result/cause_place.h"

#define LABEL    14 /* columns before a strip */
#define BAR_HALF 14
#define MARKS    4 /* causes that are drawn */

static double standardised(const rotid_diagnosis *d, int k)
{
    return k < d->nmodes_standardised ? d->modes_standardised[k] : NAN;
}

/* The state whose modes begin with mode k of all, NULL where none does. */
static const char *state_at(const rotid_identification *fit, int k)
{
    for (int s = 0; s < fit->nstates; k -= fit->states[s++].nmodes)
        if (!k)
            return fit->states[s].name;
    return NULL;
}

static void print_modes(const struct diagnosis_view *view)
{
    const rotid_diagnosis *d = view->diagnosis;
    double scale = 3; /* noise alone fills no more than the bar */
    for (int k = 0; k < d->base->nmodes; k++)
        if (isfinite(standardised(d, k)))
            scale = fmax(scale, ceil(fabs(standardised(d, k))));
    (void)fprintf(view->out, "  mode  measured [Hz]  predicted  error [%%]  res./sigma  %-+*.0f0%+*.0f    NCO\n", BAR_HALF,
                  -scale, BAR_HALF, scale);
    for (int k = 0; k < d->base->nmodes; k++) {
        const rotid_compared_mode *mode = &d->base->modes[k];
        if (state_at(d->base, k))
            (void)fprintf(view->out, "  state %s\n", state_at(d->base, k));
        (void)fprintf(view->out, "  %4d", mode->mode);
        digits_cell(view->out, 15, 6, mode->measured_hz);
        digits_cell(view->out, 11, 6, mode->predicted_hz);
        signed_cell(view->out, 11, 3, mode->error_percent);
        signed_cell(view->out, 12, 1, standardised(d, k));
        (void)fputs("  ", view->out);
        chart_bar(view->out, BAR_HALF, scale, standardised(d, k));
        number_cell(view->out, 7, 3, mode->nco);
        (void)fprintf(view->out, "%s\n", mode->holdout ? "  held out" : "");
    }
}

static int same_state(const rotid_sensor_residual *a, const rotid_sensor_residual *b)
{
    return a->state == b->state || (a->state && b->state && !strcmp(a->state, b->state));
}

/* A line for each state. */
static int print_sensors(const struct diagnosis_view *view, int columns)
{
    const rotid_diagnosis *d = view->diagnosis;
    int any = 0;
    for (int s = 0, end; s < d->nsensors; s = end) {
        struct strip strip;
        char label[LABEL + 1];
        int measured = 0;
        strip_open(&strip, d->geometry->length_m, columns);
        for (end = s; end < d->nsensors && same_state(&d->sensors[s], &d->sensors[end]); end++) {
            strip_digits(&strip, 1, &d->sensors[end].z_m, &d->sensors[end].rms);
            measured |= isfinite(d->sensors[end].rms);
        }
        (void)snprintf(label, sizeof label, "  %.11s", d->sensors[s].state ? d->sensors[s].state : "sensors");
        if (measured)
            strip_print(&strip, view->out, LABEL, label);
        any |= measured;
    }
    return any;
}

/* The most of mere noise is no place to look at. */
static int print_localisation(const struct diagnosis_view *view, int columns)
{
    const rotid_diagnosis *d = view->diagnosis;
    struct strip strip;
    if (!d->nlocalisation || !(view->verbose || !d->verdict.sentence || d->verdict.kind != ROTID_ADEQUATE))
        return 0;
    strip_open(&strip, d->geometry->length_m, columns);
    strip_density(&strip, d->nlocalisation, d->localisation);
    strip_print(&strip, view->out, LABEL, "  force resid.");
    return 1;
}

static void print_axis(const struct diagnosis_view *view)
{
    const rotid_diagnosis *d = view->diagnosis;
    const rotid_verdict *v = &d->verdict;
    const rotid_geometry *geometry = d->geometry;
    const rotid_cause *mark = v->ncauses ? v->causes : v->alternative_causes;
    int columns = view->width - LABEL, nmark = v->ncauses ? v->ncauses : v->nalternative_causes;
    struct strip strip;
    struct cause_place place;
    (void)fputs("\n", view->out);
    int sensors = print_sensors(view, columns), local = print_localisation(view, columns);
    strip_open(&strip, geometry->length_m, columns);
    for (int g = 0; g < geometry->ngroups; g++)
        if (!geometry->groups[g].layer_of)
            strip_name(&strip, geometry->groups[g].from_m, geometry->groups[g].to_m, geometry->groups[g].name);
    strip_print(&strip, view->out, LABEL, "  group");
    for (int i = 0; i < nmark && i < MARKS; i++) {
        if (!cause_place(geometry, &mark[i], &place))
            continue;
        strip_open(&strip, geometry->length_m, columns);
        strip_mark(&strip, place.from, place.to, mark[i].id);
        strip_print(&strip, view->out, LABEL, v->ncauses ? "  cause" : "  possible");
    }
    strip_open(&strip, geometry->length_m, columns);
    strip_ticks(&strip);
    strip_print(&strip, view->out, LABEL, "  z [m]");
    if (!sensors && !local)
        return;
    struct wrap wrap;
    wrap_open(&wrap, view->out, 4, view->width, "  ");
    if (sensors)
        wrap_words(&wrap, "sensors: rms of residual/sigma, 1 is noise alone;");
    if (local)
        wrap_words(&wrap, "force residual: force that the model lacks, most at @");
    wrap_close(&wrap);
}

void table_misfit(const struct diagnosis_view *view)
{
    const rotid_identification *base = view->diagnosis->base;
    if (!base)
        return;
    if (view->diagnosis->before)
        (void)fprintf(view->out, "\nWHAT CHANGED  %s beside the model that fits %s, less what that misses there",
                      view->diagnosis->after, view->diagnosis->before);
    else
        (void)fprintf(view->out, "\nWHAT IS WRONG  full model, likelihood");
    if (isfinite(base->chi2))
        (void)fprintf(view->out, ", chi2 %.4g with %d degrees of freedom", base->chi2, base->dof);
    (void)fprintf(view->out, "%s\n",
                  !base->nparameters                       ? "; nothing to identify"
                  : !strcmp(base->status, "not_converged") ? "; NOT CONVERGED"
                                                           : "");
    print_modes(view);
    print_axis(view);
}
