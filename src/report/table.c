#include "report/table.h"

#include <math.h>
#include <string.h>

#include "fit/baseline.h"
#include "fit/quantile.h"
#include "report/layout.h"

void table_heading(FILE *out, const struct job *job)
{
    for (int i = 0; i < job->nheading; i++)
        (void)fprintf(out, "%s\n", job->heading[i]);
    if (!job->nheading)
        (void)fprintf(out, "%s\n", job->deck);
    (void)fputc('\n', out);
}

void table_notes(FILE *out, const struct message_list *notes)
{
    int any = 0;
    for (size_t i = 0; i < notes->count; i++)
        if (notes->item[i].severity == SEVERITY_WARNING &&
            !notes->item[i].file) { /* with a place: said on standard error already */
            (void)fprintf(out, "%snote: %s\n", any ? "" : "\n", notes->item[i].text);
            any = 1;
        }
}

static double reference_value(const struct reference *reference, int i)
{
    return reference && i < reference->count ? reference->value[i] : NAN;
}

/* What an effect acts on, as its hooks tell; "" where that is the whole rotor. */
static void print_target(FILE *out, const struct rotor *rotor, const struct effect *effect)
{
    const struct effect_kind *kind = effect->kind;
    int target = effect->target;
    if (kind->spring && target >= 0 && target < rotor->nspring && rotor->spring[target].name)
        (void)fprintf(out, " at %s", rotor->spring[target].name);
    else if (kind->tierod && target >= 0 && target < rotor->ntierod && rotor->tierod[target].name)
        (void)fprintf(out, " at %s", rotor->tierod[target].name);
    else if (kind->joint && target >= 0 && target + 1 < rotor->ngroup)
        (void)fprintf(out, " between %s and %s", rotor->group[target].name, rotor->group[target + 1].name);
    else if (kind->axis && target >= 0 && target < rotor->ngroup)
        (void)fprintf(out, " in %s", rotor->group[target].name);
}

static void print_effect(FILE *out, const struct rotor *rotor, const struct effect *effect, const char *role)
{
    name_cell(out, 12, effect->name);
    (void)fprintf(out, " %s, %s", role, effect->kind->id);
    print_target(out, rotor, effect);
    for (int p = 0; p < effect_parameters(effect); p++) {
        const struct effect_parameter_name *parameter = &effect->kind->parameter[p];
        (void)fprintf(out, ", %s %.6g%s%s", parameter->name, effect->value[p], strcmp(parameter->unit, "1") ? " " : "",
                      strcmp(parameter->unit, "1") ? parameter->unit : "");
    }
    (void)fputc('\n', out);
}

/* The CAUSE cards. */
static void print_causes(FILE *out, const struct job *job)
{
    if (job->rotor.neffect || job->ncorrection || job->nsuspect)
        (void)fprintf(out, "\ncause\n");
    for (int i = 0; i < job->rotor.neffect; i++)
        print_effect(out, &job->rotor, &job->rotor.effect[i], "in the model");
    for (int i = 0; i < job->nsuspect; i++)
        print_effect(out, &job->rotor, &job->suspect[i].effect, "suspected");
    for (int i = 0; i < job->ncorrection; i++) {
        const struct correction *correction = &job->correction[i];
        name_cell(out, 12, correction->name);
        (void)fprintf(out, " taken out of the data, %s", correction->id);
        for (int s = 0; s < correction->nsensor; s++)
            (void)fprintf(out, "%s%d", s ? " and " : " of sensor ", correction->sensor[s]);
        (void)fprintf(out, "%s%s, value %.6g\n", correction->block ? " of " : "", correction->block ? correction->block : "",
                      correction->value);
    }
}

void table_check(FILE *out, const struct job *job, const struct mass_properties *mass, const struct spectrum *spectrum)
{
    const struct rotor *rotor = &job->rotor;
    table_heading(out, job);
    (void)fprintf(out, "length          %12.6f m\n", rotor_length(rotor));
    (void)fprintf(out, "mass            %12.4f kg\n", mass->mass);
    (void)fprintf(out, "centre of mass  %12.6f m from the left end\n", mass->center);
    (void)fprintf(out, "inertia         %12.4f kg.m2 about a diameter there\n", mass->inertia);
    (void)fprintf(out, "mesh            %12d nodes, %d elements\n", spectrum->nnode, spectrum->nnode - 1);
    (void)fprintf(out, "sensors         %12d\n", rotor->nsensor);
    (void)fprintf(out, "measured modes  %12d\n", job->nmode);
    (void)fprintf(out, "free motions    %12d", spectrum->nrigid);
    for (int i = 0; i < spectrum->nrigid; i++)
        (void)fprintf(out, "%s%.3f", i ? ", " : " (modes on the supports at ", spectrum->rigid_hz[i]);
    (void)fprintf(out, "%s\n", spectrum->nrigid ? " Hz)" : "");
    (void)fprintf(out, "fit             %12s, reduction %s, %d parameter%s\n\n", functional_name(job->fit.functional),
                  reduction_name(job->fit.reduction), job->nparameter, job->nparameter == 1 ? "" : "s");
    (void)fprintf(out, "group          from [m]     to [m]      E [Pa]      G [Pa]     nu   rho [kg/m3]\n");
    for (int g = 0; g < rotor->ngroup; g++) {
        const struct material *material = &rotor->group[g].material;
        double from, to;
        rotor_group_span(rotor, g, &from, &to);
        name_cell(out, 12, rotor->group[g].name);
        (void)fprintf(out, " %10.6f %10.6f  %10.4e  %10.4e  %5.3f  %12.2f\n", from, to, material->e,
                      material_shear_modulus(material), material->nu, material->rho);
    }
    print_causes(out, job);
}

void table_modes(FILE *out, const struct job *job, const struct spectrum *s, const struct comparison *compared, int shapes)
{
    table_heading(out, job);
    for (int i = 0; i < s->nrigid; i++)
        (void)fprintf(out, "rotor on its supports: %.4f Hz\n", s->rigid_hz[i]);
    (void)fprintf(out, "%smode   full model   %-6s [Hz]  reduction   mesh      measured    error     NCO\n",
                  s->nrigid ? "\n" : "", job->fit.reduction == ROTID_IRS ? "IRS" : "Guyan");
    (void)fprintf(out, "           [Hz]                     [%%]       [%%]         [Hz]      [%%]\n");
    for (int j = 0; j < s->count; j++) {
        int measured = -1;
        for (int k = 0; k < compared->nmode; k++)
            if (compared->number[k] == j + 1)
                measured = k;
        double hz = measured >= 0 ? job->frequency_hz[measured] : NAN;
        (void)fprintf(out, "%3d ", j + 1);
        number_cell(out, 13, 4, s->full_hz[j]);
        number_cell(out, 14, 4, s->reduced_hz[j]);
        signed_cell(out, 10, 3, s->reduction_error_percent[j]);
        signed_cell(out, 9, 4, s->mesh_error_percent[j]);
        number_cell(out, 13, 4, hz);
        signed_cell(out, 9, 2, 100 * (s->full_hz[j] / hz - 1));
        number_cell(out, 8, 3, measured >= 0 ? compared->nco[measured] : NAN);
        (void)fputc('\n', out);
    }
    if (!shapes)
        return;
    (void)fprintf(out, "\n    z [m]");
    for (int j = 0; j < s->count; j++)
        (void)fprintf(out, "  mode %-3d", j + 1);
    (void)fputc('\n', out);
    for (int i = 0; i < s->nmaster; i++) {
        (void)fprintf(out, "%9.5f", s->master_z[i]);
        for (int j = 0; j < s->count; j++)
            number_cell(out, 10, 5, s->shape[i + (ptrdiff_t)j * s->nmaster]);
        (void)fputc('\n', out);
    }
}

/* 11 columns */
static void signed_power(FILE *out, double value)
{
    if (isfinite(value))
        (void)fprintf(out, "%+.4e", value);
    else
        (void)fprintf(out, "%11s", "-");
}

void table_sensitivity(FILE *out, const struct job *job, const struct sensitivity *r)
{
    table_heading(out, job);
    (void)fprintf(out,
                  "sensitivity of E_k = 1 - R*_k/w_k^2 to the relative value of each parameter, %g %% steps, reduction %s\n\n",
                  100 * r->step, r->reduction);
    for (int p = 0; p < r->nparameters; p++) {
        const struct sensitivity_parameter *one = &r->parameters[p];
        char quantity[128];
        (void)snprintf(quantity, sizeof quantity, "sensitivity %s", one->name);
        const struct reference *paper = job_reference(job, quantity);
        (void)fprintf(out, "%s at %.6g %s\n", one->name, one->reference,
                      strcmp(one->unit, "1") ? one->unit : "");
        (void)fprintf(out, "mode   frequency [Hz]   step        limit       %s\n", paper ? "paper (magnitude)" : "");
        for (int k = 0; k < r->nfrequency_hz; k++) {
            (void)fprintf(out, "%3d", k + 1);
            number_cell(out, 16, 4, r->frequency_hz[k]);
            (void)fputs("  ", out);
            signed_power(out, one->sensitivity[k]);
            (void)fputc(' ', out);
            signed_power(out, one->derivative[k]);
            if (isfinite(reference_value(paper, k)))
                (void)fprintf(out, "  %.3e", reference_value(paper, k));
            (void)fputc('\n', out);
        }
        (void)fprintf(out, "1/2 E_k^2 over the relative value (Figure 5 of the paper)\n value");
        for (int k = 0; k < r->nfrequency_hz; k++)
            (void)fprintf(out, "   mode %d ", k + 1);
        (void)fputc('\n', out);
        for (int i = 0; i < r->nrelative_value; i++) {
            (void)fprintf(out, "%6.3f", r->relative_value[i]);
            for (int k = 0; k < r->nfrequency_hz; k++)
                power_cell(out, 10, 2, one->curves[k + (ptrdiff_t)r->nfrequency_hz * i]);
            (void)fputc('\n', out);
        }
        (void)fputc('\n', out);
    }
}

static void print_modes(FILE *out, const struct job *job, const struct identification *result)
{
    const rotid_fit_result *fit = result->fit;
    const struct reference *paper_hz = job_reference(job, "predicted_hz"), *paper_error = job_reference(job, "error_percent");
    int paper = paper_hz || paper_error, shapes = 0;
    double sum = 0, held = 0;
    int count = 0, nheld = 0;
    for (int k = 0; k < fit->m; k++)
        shapes |= isfinite(result->compared.nco[k]);
    (void)fprintf(out, "mode   measured  predicted    error%s  reduction    mesh%s\n", paper ? "      paper    paper" : "",
                  shapes ? "     NCO    MAC" : "");
    (void)fprintf(out, "           [Hz]       [Hz]      [%%]%s        [%%]     [%%]\n", paper ? "       [Hz]      [%]" : "");
    for (int k = 0; k < fit->m; k++) {
        int j = result->compared.number[k] - 1, is_held = job->holdout && job->holdout[k];
        double error = 100 * (fit->predicted_hz[k] / job->frequency_hz[k] - 1);
        (void)fprintf(out, "%4d", j + 1);
        number_cell(out, 11, 2, job->frequency_hz[k]);
        number_cell(out, 11, 2, fit->predicted_hz[k]);
        signed_cell(out, 9, 2, error);
        if (paper) {
            number_cell(out, 11, 2, reference_value(paper_hz, k));
            signed_cell(out, 9, 2, reference_value(paper_error, k));
        }
        signed_cell(out, 11, 2, result->spectrum.reduction_error_percent[j]);
        signed_cell(out, 8, 3, result->spectrum.mesh_error_percent[j]);
        if (shapes) {
            number_cell(out, 8, 3, result->compared.nco[k]);
            number_cell(out, 7, 3, result->compared.mac[k]);
        }
        (void)fprintf(out, "%s\n", is_held ? "  held out" : "");
        *(is_held ? &held : &sum) += error * error;
        *(is_held ? &nheld : &count) += 1;
    }
    (void)fputs("rms error of the fitted modes ", out);
    number_cell(out, 0, 2, sqrt(sum / count));
    (void)fputs(" %", out);
    if (nheld) {
        (void)fputs(", of the modes held out ", out);
        number_cell(out, 0, 2, sqrt(held / nheld));
        (void)fputs(" %", out);
    }
    (void)fprintf(out, "\n");
}

static void print_parameters(FILE *out, const struct job *job, const rotid_fit_result *fit)
{
    (void)fprintf(out, "%-14s %14s  %-8s %27s   %s\n", "parameter", "value", "unit", "95 % interval", "start");
    for (int p = 0; p < fit->n; p++) {
        double ratio = fabs(fit->x[p]) / (fit->ci_upper[p] - fit->ci_lower[p]); /* an interval shows two digits of its width */
        int digits = ratio > 1e3 && isfinite(ratio) ? (int)ceil(log10(ratio)) + 2 : 5;
        digits = digits < 5 ? 5 : digits > 8 ? 8 : digits;
        name_cell(out, 14, job->bounds[p].name);
        (void)fprintf(out, " %14.*g  %-8s ", digits > 6 ? digits : 6, fit->x[p], job->bounds[p].unit);
        if (isfinite(fit->ci_lower[p]))
            (void)fprintf(out, "%12.*g ...%12.*g", digits, fit->ci_lower[p], digits, fit->ci_upper[p]);
        else
            (void)fprintf(out, "%27s", "cannot be stated");
        (void)fprintf(out, "   %.4g%s%s\n", job->bounds[p].start, fit->at_bound[p] ? "   AT ITS BOUND" : "",
                      !fit->identifiable[p] && !fit->at_bound[p] ? "   NOT DETERMINED by these data" : "");
    }
    for (int j = 0; j < fit->n; j++) {
        if (!fit->direction_undetermined[j])
            continue;
        (void)fprintf(out, "the data do not determine the combination");
        for (int p = 0; p < fit->n; p++)
            if (fabs(fit->direction[p + (ptrdiff_t)j * fit->n]) > 0.05)
                (void)fprintf(out, " %+.2f %s", fit->direction[p + (ptrdiff_t)j * fit->n], job->bounds[p].name);
        (void)fprintf(out, " (relative changes)\n");
    }
    if (fit->n > 1) {
        (void)fprintf(out, "condition number %s", NUMBER(3, fit->condition_number));
        if (fit->n == 2 && isfinite(fit->correlation[1]))
            (void)fprintf(out, ", correlation %.3f", fit->correlation[1]);
        (void)fprintf(out, "\n");
    }
    if (fit->variance_from_residuals && fit->dof > 0)
        (void)fprintf(out,
                      "intervals rest on the misfit that is left (Student t, %d degrees of freedom); state *NOISE to rest them "
                      "on the measurement\n",
                      fit->dof);
    if (fit->widened_by > 1) {
        double chance = chi_square_tail(fit->chi2, fit->dof); /* half of all adequate models have a misfit above the noise */
        (void)fprintf(out, "the misfit is %s times the stated noise: the intervals are widened by that",
                      NUMBER(3, fit->widened_by));
        if (chance < 0.01)
            (void)fprintf(out, ", and the model is not adequate for these data\n");
        else
            (void)fprintf(out, "; noise alone does as much in %.0f %% of such tests\n", 100 * chance);
    }
}

static void print_history(FILE *out, const rotid_fit_result *fit)
{
    (void)fprintf(out, "\niteration   objective         gradient    mu         gain      step\n");
    for (int i = 0; i < fit->nhistory; i++) {
        (void)fprintf(out, "%6d", fit->history[i].iteration);
        power_cell(out, 22, 10, fit->history[i].objective);
        power_cell(out, 10, 2, fit->history[i].gradient);
        power_cell(out, 12, 2, fit->history[i].mu);
        number_cell(out, 10, 3, fit->history[i].gain_ratio);
        power_cell(out, 10, 2, fit->history[i].step);
        (void)fputc('\n', out);
    }
}

/* The objective of one that failed may be none. */
static void print_minimiser(FILE *out, const char *library, const char *name, double objective, int evaluations, double seconds,
                            int n, const double *x)
{
    (void)fprintf(out, "%s%-*s", library, 20 - (int)strlen(library), name);
    power_cell(out, 15, 8, objective);
    (void)fprintf(out, " %11d %9.2f", evaluations, 1e3 * seconds);
    for (int p = 0; p < n; p++)
        digits_cell(out, 14, 7, x[p]);
}

static void print_baseline(FILE *out, const struct job *job, const rotid_fit_result *fit)
{
    (void)fprintf(out, "\n%-20s %14s %11s %9s", "minimiser", "objective", "evaluations", "ms");
    for (int p = 0; p < fit->n; p++)
        (void)fprintf(out, " %13s", job->bounds[p].name);
    (void)fprintf(out, "   result\n");
    print_minimiser(out, "", "Levenberg-Marquardt", fit->objective, fit->evaluations, fit->seconds, fit->n, fit->x);
    (void)fprintf(out, "   %s\n", rotid_status_text(fit->status));
    for (int i = 0; i < fit->nbaseline; i++) {
        const rotid_baseline *b = &fit->baseline[i];
        print_minimiser(out, "NLopt ", b->algorithm, b->objective, b->evaluations, b->seconds, fit->n, b->x);
        (void)fprintf(out, "   %s\n", b->result);
    }
}

void table_identify(FILE *out, const struct job *job, const struct identification *result, int baseline, int history)
{
    const rotid_fit_result *fit = result->fit;
    int fitted = fit->m;
    for (int k = 0; k < fit->m; k++)
        fitted -= job->holdout && job->holdout[k];
    table_heading(out, job);
    (void)fprintf(out, "%s, fit of %d mode%s, functional %s, reduction %s, objective %s, gradient ",
                  fit->converged ? (fit->any_at_bound ? "converged AT A BOUND" : "converged") : "NOT CONVERGED", fitted,
                  fitted == 1 ? "" : "s", functional_name(job->fit.functional), reduction_name(job->fit.reduction),
                  NUMBER(10, fit->objective));
    power_cell(out, 0, 1, fit->gradient);
    (void)fputs("\n\n", out);
    print_parameters(out, job, fit);
    if (fit->nbaseline)
        print_baseline(out, job, fit);
    else if (baseline && !baseline_exists())
        (void)fprintf(out, "\nno minimiser beside it: this rotid is built without NLopt (WITH_NLOPT=0)\n");
    if (history)
        print_history(out, fit);
    (void)fputc('\n', out);
    print_modes(out, job, result);
    if (job->fit.functional != ROTID_LIKELIHOOD)
        (void)fprintf(
            out,
            "the hybrid quotient equals the frequency of the %s for any measured shape: this functional fits frequencies alone\n",
            job->fit.reduction == ROTID_REDUCTION_NONE ? "model" : "condensed model");
    if (isfinite(fit->chi2_per_dof))
        (void)fprintf(out, "chi2 %.4g with %d degrees of freedom\n", fit->chi2, fit->dof);
}
