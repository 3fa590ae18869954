#include <math.h>
#include <string.h>

#include "diagnose/causes/causes.h"
#include "report/report.h"
#include "result/result.h"

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

static void print_quality(FILE *out, const rotid_gain *gain, int has_after)
{
    const struct {
        const char *label;
        const rotid_pair *first, *second; /* second NULL: one number a state */
        double scale, second_scale;
    } rows[] = {
        {"frequencies fitted, error rms / largest [%]", &gain->frequency_rms_percent, &gain->frequency_max_percent, 1, 1},
        {"shapes, rms of the largest component [%]", &gain->shape_rms, NULL, 100, 0},
        {"chi2 per degree of freedom", &gain->chi2_per_dof, NULL, 1, 0},
        {"smallest NCO", &gain->nco_min, NULL, 1, 0},
        {"modes held out by the deck, frequency / shape rms [%]", &gain->holdout_frequency_rms_percent, &gain->holdout_shape_rms,
         1, 100},
        {"modes left out in turn, frequency / shape rms [%]", &gain->mode_out_frequency_rms_percent, &gain->mode_out_shape_rms, 1,
         100},
        {"sensors left out in turn, shape rms [%]", &gain->sensor_out_shape_rms, NULL, 100, 0},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const rotid_pair *first = rows[i].first, *second = rows[i].second;
        double before[2] = {rows[i].scale * first->before, second ? rows[i].second_scale * second->before : NAN},
               after[2] = {rows[i].scale * first->after, second ? rows[i].second_scale * second->after : NAN};
        row(out, rows[i].label, second ? 2 : 1, before, has_after ? after : NULL);
    }
}

/* Digits that show two of the half width of an interval. */
static int digits_for(const rotid_fitted_parameter *p)
{
    double ratio = fabs(p->value) / (p->ci95[1] - p->ci95[0]);
    int digits = ratio > 0 && isfinite(ratio) ? (int)ceil(log10(ratio)) + 2 : LEAST_DIGITS;
    return digits < LEAST_DIGITS ? LEAST_DIGITS : digits > MOST_DIGITS ? MOST_DIGITS : digits;
}

/* p: NULL where the model has no such parameter. */
const char *parameter_text(const rotid_fitted_parameter *p, char text[PARAMETER_TEXT])
{
    char power[16] = "";
    double size = p ? fabs(p->value) : 0, scale = 1;
    if (isfinite(size) && size > 0 && (size >= 1e5 || size < 1e-3)) {
        int exponent = (int)floor(log10(size));
        scale = pow(10, exponent);
        (void)snprintf(power, sizeof power, " e%+03d", exponent);
    }
    if (p && isfinite(p->ci95[0]) && isfinite(p->ci95[1]))
        (void)snprintf(text, PARAMETER_TEXT, "%.*g (%.*g ... %.*g)%s %s", digits_for(p), p->value / scale, digits_for(p),
                       p->ci95[0] / scale, digits_for(p), p->ci95[1] / scale, power, layout_unit(p->unit));
    else if (p)
        (void)snprintf(text, PARAMETER_TEXT, "%.4g%s %s (%s)", p->value / scale, power, layout_unit(p->unit),
                       p->at_bound        ? "AT ITS BOUND"
                       : !p->identifiable ? "NOT DETERMINED"
                                          : "no interval");
    else
        (void)snprintf(text, PARAMETER_TEXT, "-");
    return text;
}

static void value_cell(FILE *out, int width, const rotid_fitted_parameter *p)
{
    char text[PARAMETER_TEXT];
    (void)parameter_text(p, text);
    if (width)
        text_cell(out, width, text);
    else
        (void)fputs(text, out);
}

static void print_parameters(FILE *out, const rotid_diagnosis *d)
{
    const rotid_identification *base = d->base, *extended = d->extended;
    if (!d->gain.nparameters)
        return;
    if (extended)
        (void)fprintf(out, "  %-*s %-*s%-*s change [%%]\n", NAME, "parameter", VALUE, "before (95 % interval)", VALUE - 5,
                      "after");
    else
        (void)fprintf(out, "  %-*s value (95 %% interval)\n", NAME, "parameter");
    for (int i = 0; i < d->gain.nparameters; i++) {
        const char *name = d->gain.parameters[i].name;
        const rotid_fitted_parameter *before = fit_parameter(base, name), *after = fit_parameter(extended, name);
        (void)fputs("  ", out);
        text_cell(out, NAME, name);
        (void)fputc(' ', out);
        value_cell(out, extended ? VALUE : 0, before);
        if (extended)
            value_cell(out, before && after ? VALUE : 0, after);
        if (before && after)
            signed_cell(out, 6, 1, 100 * (after->value / before->value - 1));
        (void)fputc('\n', out);
    }
    if (base && base->intervals_widened_by > 1)
        (void)fprintf(out, "  intervals%s are widened by %s: the misfit exceeds the noise\n", extended ? " before" : "",
                      IN_DIGITS(3, base->intervals_widened_by));
    if (extended && extended->intervals_widened_by > 1)
        (void)fprintf(out, "  intervals after are widened by %s: the misfit exceeds the noise\n",
                      IN_DIGITS(3, extended->intervals_widened_by));
}

void table_gain(const struct diagnosis_view *view)
{
    const rotid_diagnosis *d = view->diagnosis;
    if (!d->base || !d->verdict.sentence) /* interrupted before it was measured */
        return;
    (void)fprintf(view->out, "\n%s\n",
                  d->extended ? "GAIN  base model -> extended model" : "QUALITY  of the base model; nothing is added to it");
    print_quality(view->out, &d->gain, d->extended != NULL);
    print_parameters(view->out, d);
}

/* The size as a person says it: an angle that comes down from where it has no effect is said as the angle. */
static double size_of(const rotid_detectable *item, int *falls)
{
    const struct cause_kind *cause = catalogue_find(item->id);
    const struct cause_parameter *size = cause && cause->size >= 0 ? &cause->parameter[cause->size] : NULL;
    *falls = size && size->one_sided < 0;
    return *falls ? size->neutral - item->smallest : item->smallest;
}

static int same_kind(const rotid_detectable *a, const rotid_detectable *b)
{
    return !strcmp(a->id, b->id) && !strcmp(a->parameter, b->parameter);
}

/* Smallest sizes of one cause and parameter at all its targets: one paragraph. */
static void print_detectable(const struct diagnosis_view *view, int first)
{
    const rotid_diagnosis *d = view->diagnosis;
    struct wrap wrap;
    int shown = 0, falls;
    for (int i = first; i < d->ndetectable; i++) {
        const rotid_detectable *item = &d->detectable[i];
        if (!same_kind(item, &d->detectable[first]) || item->beyond || !isfinite(item->smallest))
            continue;
        if (!shown++) {
            const char *unit = layout_unit(item->unit);
            wrap_open(&wrap, view->out, 4, view->width, "  ");
            wrap_item(&wrap, "%s, %s%s%s%s:", item->id, item->parameter, *unit ? " [" : "", unit, *unit ? "]" : "");
        }
        double size = size_of(item, &falls);
        wrap_item(&wrap, "%s%s%s%.2g%s", shown > 1 ? "; " : "", item->target, *item->target ? " " : "", size,
                  falls ? " or less" : "");
        if (isfinite(item->z_m))
            wrap_item(&wrap, "at z %.3g m", item->z_m);
        if (isfinite(item->worst))
            wrap_item(&wrap, "(worst place %.2g)", item->worst);
        else if (isfinite(item->z_m))
            wrap_words(&wrap, "(not at every place)");
    }
    if (shown)
        wrap_close(&wrap);
}

void table_detection_limits(const struct diagnosis_view *view)
{
    const rotid_diagnosis *d = view->diagnosis;
    struct wrap wrap;
    int beyond = 0;
    if (d->ndetectable)
        (void)fprintf(view->out,
                      "\nDETECTION LIMITS  smallest change that shows (9 times in 10, false alarm 3 %%); less stays hidden\n");
    for (int i = 0; i < d->ndetectable; i++) {
        int before = 0;
        for (int j = 0; j < i; j++)
            before |= same_kind(&d->detectable[j], &d->detectable[i]);
        if (!before)
            print_detectable(view, i);
    }
    for (int i = 0; i < d->ndetectable; i++) {
        const rotid_detectable *item = &d->detectable[i];
        if (!item->beyond && isfinite(item->smallest))
            continue;
        if (!beyond++) {
            wrap_open(&wrap, view->out, 4, view->width, "  ");
            wrap_words(&wrap, "no size within physical bounds would show:");
        }
        wrap_item(&wrap, "%s%s%s%s", beyond > 1 ? "; " : "", item->id, *item->target ? " " : "", item->target);
    }
    if (beyond)
        wrap_close(&wrap);
}
