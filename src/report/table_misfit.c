#include <math.h>
#include <stdio.h>

#include "report/chart.h"
#include "report/layout.h"
#include "report/table_diagnose.h"

#define LABEL    14 /* columns before a strip */
#define BAR_HALF 14

static void print_modes(const struct diagnosis_view *view)
{
    const struct diagnosis *d = view->diagnosis;
    const rotid_fit_result *fit = d->base.fit;
    double scale = 3; /* noise alone fills no more than the bar */
    for (int k = 0; k < fit->m; k++)
        if (d->mode_z && isfinite(d->mode_z[k]))
            scale = fmax(scale, ceil(fabs(d->mode_z[k])));
    (void)fprintf(view->out, "  mode  measured [Hz]  predicted  error [%%]  over noise  %-+*.0f0%+*.0f    NCO\n", BAR_HALF,
                  -scale, BAR_HALF, scale);
    for (int k = 0; k < fit->m; k++) {
        double measured = d->job.frequency_hz[k], z = d->mode_z ? d->mode_z[k] : NAN;
        (void)fprintf(view->out, "  %4d", d->base.compared.number[k]);
        digits_cell(view->out, 15, 6, measured);
        digits_cell(view->out, 11, 6, fit->predicted_hz[k]);
        signed_cell(view->out, 11, 3, 100 * (fit->predicted_hz[k] / measured - 1));
        signed_cell(view->out, 12, 1, z);
        (void)fputs("  ", view->out);
        chart_bar(view->out, BAR_HALF, scale, z);
        number_cell(view->out, 7, 3, d->base.compared.nco[k]);
        (void)fprintf(view->out, "%s\n", d->job.holdout && d->job.holdout[k] ? "  held out" : "");
    }
}

/* Where a candidate acts. Returns 0 where it has no place. */
static int place_of(const struct rotor *rotor, const struct candidate *candidate, double *from, double *to)
{
    const struct cause_kind *cause = candidate->cause;
    int target = candidate->effect.target;
    if (cause->place >= 0) {
        double z = candidate->effect.value[cause->place], width = cause->width >= 0 ? candidate->effect.value[cause->width] : 0;
        *from = z - width;
        *to = z + width;
        return isfinite(*from) && isfinite(*to);
    }
    if (cause->target == TARGET_GROUP && target >= 0 && target < rotor->ngroup) {
        rotor_group_span(rotor, target, from, to);
    } else if (cause->target == TARGET_INTERFACE && target >= 0 && target < rotor->ngroup) {
        rotor_group_span(rotor, target, from, to);
        *from = *to;
    } else if (cause->target == TARGET_SPRING && target >= 0 && target < rotor->nspring) {
        *from = *to = rotor->spring[target].position;
    } else if (cause->target == TARGET_TIEROD && target >= 0 && target < rotor->ntierod) {
        *from = rotor->tierod[target].from;
        *to = rotor->tierod[target].to;
    } else {
        return 0;
    }
    return 1;
}

static void print_axis(const struct diagnosis_view *view)
{
    const struct diagnosis *d = view->diagnosis;
    const struct rotor *rotor = d->job.rotor.nsegment ? &d->job.rotor : &view->deck->rotor;
    const struct candidate *mark = d->ncause ? d->cause : d->alternative;
    int columns = view->width - LABEL, local = d->nlocal && (view->verbose || !d->sentence || d->kind != VERDICT_ADEQUATE),
        nmark = d->ncause ? d->ncause : d->nalternative, sensors = 0;
    double length = rotor_length(rotor), from, to;
    struct strip strip;
    (void)fputs("\n", view->out);
    strip_open(&strip, length, columns);
    for (int s = 0; d->sensor_rms && s < d->job.rotor.nsensor; s++) {
        strip_digits(&strip, 1, &d->job.rotor.sensor[s].position, &d->sensor_rms[s]);
        sensors |= isfinite(d->sensor_rms[s]);
    }
    if (sensors)
        strip_print(&strip, view->out, LABEL, "  sensors");
    if (local) { /* the most of mere noise is no place to look at */
        strip_open(&strip, length, columns);
        strip_density(&strip, d->nlocal, d->local_z, d->local);
        strip_print(&strip, view->out, LABEL, "  misfit acts");
    }
    strip_open(&strip, length, columns);
    for (int g = 0; g < rotor->ngroup; g++) {
        rotor_group_span(rotor, g, &from, &to);
        strip_name(&strip, from, to, rotor->group[g].name);
    }
    strip_print(&strip, view->out, LABEL, "  group");
    for (int i = 0; i < nmark && i < DIAGNOSE_MOST_CAUSES; i++) {
        if (!place_of(rotor, &mark[i], &from, &to))
            continue;
        strip_open(&strip, length, columns);
        strip_mark(&strip, from, to, mark[i].cause->id);
        strip_print(&strip, view->out, LABEL, d->ncause ? "  cause" : "  possible");
    }
    strip_open(&strip, length, columns);
    strip_ticks(&strip);
    strip_print(&strip, view->out, LABEL, "  z [m]");
    if (!sensors && !local)
        return;
    struct wrap wrap;
    wrap_open(&wrap, view->out, 4, view->width, "  ");
    if (sensors)
        wrap_words(&wrap, "sensors: rms over noise, 1 is noise alone;");
    if (local)
        wrap_words(&wrap, "misfit acts: force that the model lacks, most at @");
    wrap_close(&wrap);
}

void table_misfit(const struct diagnosis_view *view)
{
    const struct diagnosis *d = view->diagnosis;
    const rotid_fit_result *fit = d->base.fit;
    if (!fit)
        return;
    (void)fprintf(view->out, "\nWHAT IS WRONG  full model, likelihood");
    if (isfinite(fit->chi2))
        (void)fprintf(view->out, ", chi2 %.4g with %d degrees of freedom", fit->chi2, fit->dof);
    (void)fprintf(view->out, "%s\n", !fit->n ? "; nothing to identify" : fit->converged ? "" : "; NOT CONVERGED");
    print_modes(view);
    print_axis(view);
}
