#include <math.h>
#include <string.h>

#include "diagnose/items.h"
#include "report/layout.h"
#include "report/table_diagnose.h"

#define LEAST_DIGITS 4
#define MOST_DIGITS  10

#define LABEL 54
#define NAME  20
#define VALUE 35 /* columns of a value with its interval */

/* One row of one or two numbers a state; left away where neither state has the first. */
static void row(FILE *out, const char *label, int count, const double *before, const double *after)
{
    if (!isfinite(before[0]) && !(after && isfinite(after[0])))
        return;
    (void)fputs("  ", out);
    text_cell(out, LABEL, label);
    for (int i = 0; i < count && (i == 0 || isfinite(before[i]) || (after && isfinite(after[i]))); i++) {
        (void)fputs(i ? " /" : "", out);
        digits_cell(out, i ? 7 : 8, 3, before[i]);
    }
    for (int i = 0; after && i < count && (i == 0 || isfinite(before[i]) || isfinite(after[i])); i++) {
        (void)fputs(i ? " /" : "  ->", out);
        digits_cell(out, i ? 7 : 8, 3, after[i]);
    }
    (void)fputc('\n', out);
}

static void print_quality(const struct diagnosis_view *view, int has_after)
{
    const struct fit_quality *quality[2] = {&view->diagnosis->before, &view->diagnosis->after};
    double fitted[2][2], shape[2], chi2[2], nco[2], held[2][2], mode[2][2], sensor[2];
    for (int i = 0; i < 2; i++) {
        const struct fit_quality *q = quality[i];
        fitted[i][0] = q->frequency_rms_percent;
        fitted[i][1] = q->frequency_max_percent;
        shape[i] = 100 * q->shape_rms;
        chi2[i] = q->chi2_per_dof;
        nco[i] = q->nco_min;
        held[i][0] = q->holdout_frequency_rms_percent;
        held[i][1] = 100 * q->holdout_shape_rms;
        mode[i][0] = q->mode_out_frequency_rms_percent;
        mode[i][1] = 100 * q->mode_out_shape_rms;
        sensor[i] = 100 * q->sensor_out_shape_rms;
    }
    row(view->out, "frequencies fitted, error rms / largest [%]", 2, fitted[0], has_after ? fitted[1] : NULL);
    row(view->out, "shapes, rms of the largest component [%]", 1, &shape[0], has_after ? &shape[1] : NULL);
    row(view->out, "chi2 per degree of freedom", 1, &chi2[0], has_after ? &chi2[1] : NULL);
    row(view->out, "smallest NCO", 1, &nco[0], has_after ? &nco[1] : NULL);
    row(view->out, "modes held out by the deck, frequency / shape rms [%]", 2, held[0], has_after ? held[1] : NULL);
    row(view->out, "modes left out in turn, frequency / shape rms [%]", 2, mode[0], has_after ? mode[1] : NULL);
    row(view->out, "sensors left out in turn, shape rms [%]", 1, &sensor[0], has_after ? &sensor[1] : NULL);
}

/* Digits that show two of the half width of an interval. */
static int digits_for(const rotid_fit_result *fit, int p)
{
    double ratio = fabs(fit->x[p]) / (fit->ci_upper[p] - fit->ci_lower[p]);
    int digits = ratio > 0 && isfinite(ratio) ? (int)ceil(log10(ratio)) + 2 : LEAST_DIGITS;
    return digits < LEAST_DIGITS ? LEAST_DIGITS : digits > MOST_DIGITS ? MOST_DIGITS : digits;
}

/* "1.157 (1.150 ... 1.164) e+11 Pa": one power of ten for all three. */
static void value_cell(FILE *out, int width, const rotid_fit_result *fit, int p, const char *unit)
{
    char text[128] = "-", power[16] = "";
    double size = p >= 0 ? fabs(fit->x[p]) : 0, scale = 1;
    if (isfinite(size) && size > 0 && (size >= 1e5 || size < 1e-3)) {
        int exponent = (int)floor(log10(size));
        scale = pow(10, exponent);
        (void)snprintf(power, sizeof power, " e%+03d", exponent);
    }
    if (!unit || !strcmp(unit, "1"))
        unit = "";
    if (p >= 0 && isfinite(fit->ci_lower[p]) && isfinite(fit->ci_upper[p]))
        (void)snprintf(text, sizeof text, "%.*g (%.*g ... %.*g)%s %s", digits_for(fit, p), fit->x[p] / scale, digits_for(fit, p),
                       fit->ci_lower[p] / scale, digits_for(fit, p), fit->ci_upper[p] / scale, power, unit);
    else if (p >= 0)
        (void)snprintf(text, sizeof text, "%.4g%s %s (%s)", fit->x[p] / scale, power, unit,
                       fit->at_bound[p]        ? "AT ITS BOUND"
                       : !fit->identifiable[p] ? "NOT DETERMINED"
                                               : "no interval");
    if (width)
        text_cell(out, width, text);
    else
        (void)fputs(text, out);
}

static void print_parameter(const struct diagnosis_view *view, const rotid_parameter *name, int before, int after)
{
    const rotid_fit_result *base = view->diagnosis->base.fit, *extended = view->diagnosis->extended.fit;
    FILE *out = view->out;
    int both = base && extended && before >= 0 && after >= 0;
    (void)fputs("  ", out);
    text_cell(out, NAME, name->name);
    (void)fputc(' ', out);
    value_cell(out, extended ? VALUE : 0, base, before, name->unit);
    if (extended)
        value_cell(out, both ? VALUE : 0, extended, after, name->unit);
    if (both)
        signed_cell(out, 6, 1, 100 * (extended->x[after] / base->x[before] - 1));
    (void)fputc('\n', out);
}

static void print_parameters(const struct diagnosis_view *view)
{
    const struct diagnosis *d = view->diagnosis;
    const rotid_fit_result *base = d->base.fit, *extended = d->extended.fit;
    if (!(base && base->n) && !(extended && extended->n))
        return;
    if (extended)
        (void)fprintf(view->out, "  %-*s %-*s%-*s change [%%]\n", NAME, "parameter", VALUE, "before (95 % interval)", VALUE - 5,
                      "after");
    else
        (void)fprintf(view->out, "  %-*s value (95 %% interval)\n", NAME, "parameter");
    for (int p = 0; base && p < base->n; p++)
        print_parameter(view, &d->job.bounds[p], p, fitted_parameter(&d->extended_job, extended, d->job.bounds[p].name));
    for (int p = 0; extended && p < extended->n; p++)
        if (fitted_parameter(&d->job, base, d->extended_job.bounds[p].name) < 0)
            print_parameter(view, &d->extended_job.bounds[p], -1, p);
    if (base && base->widened_by > 1)
        (void)fprintf(view->out, "  intervals%s are widened by %s: the misfit exceeds the noise\n", extended ? " before" : "",
                      NUMBER(3, base->widened_by));
    if (extended && extended->widened_by > 1)
        (void)fprintf(view->out, "  intervals after are widened by %s: the misfit exceeds the noise\n",
                      NUMBER(3, extended->widened_by));
}

void table_gain(const struct diagnosis_view *view)
{
    const struct diagnosis *d = view->diagnosis;
    int has_after = d->extended.fit != NULL;
    if (!d->base.fit || !d->sentence) /* interrupted before it was measured */
        return;
    (void)fprintf(view->out, "\n%s\n",
                  has_after ? "GAIN  base model -> extended model" : "QUALITY  of the base model; nothing is added to it");
    print_quality(view, has_after);
    print_parameters(view);
}

/* Smallest sizes of one cause and parameter at all its targets: one paragraph. */
static void print_detectable(const struct diagnosis_view *view, int first)
{
    const struct diagnosis *d = view->diagnosis;
    const struct detectable *head = &d->detectable[first];
    struct wrap wrap;
    int shown = 0;
    for (int i = first; i < d->ndetectable; i++) {
        const struct detectable *item = &d->detectable[i];
        if (item->cause != head->cause || strcmp(item->parameter, head->parameter) || item->beyond || !isfinite(item->smallest))
            continue;
        if (!shown++) {
            int pure = !item->unit || !strcmp(item->unit, "1");
            wrap_open(&wrap, view->out, 4, view->width, "  ");
            wrap_item(&wrap, "%s, %s%s%s%s:", item->cause->id, item->parameter, pure ? "" : " [", pure ? "" : item->unit,
                      pure ? "" : "]");
        }
        const struct cause_parameter *size = &item->cause->parameter[item->cause->size];
        int falls = size->one_sided < 0; /* an angle that comes down from where it has no effect: say the angle */
        wrap_item(&wrap, "%s%s%s%.2g%s", shown > 1 ? "; " : "", item->target ? item->target : "",
                  item->target && *item->target ? " " : "", falls ? size->neutral - item->smallest : item->smallest,
                  falls ? " or less" : "");
        if (isfinite(item->z))
            wrap_item(&wrap, "at z %.3g m", item->z);
        if (isfinite(item->worst))
            wrap_item(&wrap, "(worst place %.2g)", item->worst);
        else if (isfinite(item->z))
            wrap_words(&wrap, "(not at every place)");
    }
    if (shown)
        wrap_close(&wrap);
}

void table_blind_spots(const struct diagnosis_view *view)
{
    const struct diagnosis *d = view->diagnosis;
    struct wrap wrap;
    int beyond = 0;
    if (d->ndetectable)
        (void)fprintf(view->out,
                      "\nBLIND SPOTS  smallest change that shows (9 times in 10, false alarm 3 %%); less stays hidden\n");
    for (int i = 0; i < d->ndetectable; i++) {
        int before = 0;
        for (int j = 0; j < i; j++)
            before |= d->detectable[j].cause == d->detectable[i].cause &&
                      !strcmp(d->detectable[j].parameter, d->detectable[i].parameter);
        if (!before)
            print_detectable(view, i);
    }
    for (int i = 0; i < d->ndetectable; i++) {
        const struct detectable *item = &d->detectable[i];
        if (!item->beyond && isfinite(item->smallest))
            continue;
        if (!beyond++) {
            wrap_open(&wrap, view->out, 4, view->width, "  ");
            wrap_words(&wrap, "no size within physical bounds would show:");
        }
        wrap_item(&wrap, "%s%s%s%s", beyond > 1 ? "; " : "", item->cause->id, item->target && *item->target ? " " : "",
                  item->target ? item->target : "");
    }
    if (beyond)
        wrap_close(&wrap);
}
