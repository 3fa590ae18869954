/* The parameters that a diagnosis leaves, at the top: with their intervals, of an ambiguous one by each cause that cannot be told
 * apart, and by how much a cause that these data do not show may have moved them. */
#include <math.h>
#include <string.h>

#include "fit/interval.h"
#include "report/layout.h"
#include "report/table_diagnose.h"
#include "result/judgement.h"

#define NAME   18
#define LISTED 6 /* causes of a set; --verbose has all */

static rotid_fitted_parameter of_cause(const rotid_cause_value *value)
{
    return (rotid_fitted_parameter){.value = value->value,
                                    .unit = value->unit,
                                    .ci95 = {value->ci95[0], value->ci95[1]},
                                    .at_bound = !isfinite(value->ci95[0]),
                                    .identifiable = 1};
}

/* "stiffness_gradient of right", a pair with its second cause. */
static void cause_items(struct wrap *wrap, const rotid_verdict *v, int first)
{
    for (int i = first; i < v->nalternative_causes && (i == first || verdict_is_pair(v, i)); i++) {
        const rotid_cause *cause = &v->alternative_causes[i];
        wrap_item(wrap, "%s%s%s%s%s%s", i > first ? "with " : "", cause->name && cause->variant ? cause->name : cause->id,
                  *cause->target ? " of " : "", cause->target, cause->state ? " in state " : "",
                  cause->state ? cause->state : "");
    }
}

/* Parameter p by each of the causes, then its spread. */
static void print_by_cause(const struct diagnosis_view *view, int p)
{
    const rotid_verdict *v = &view->diagnosis->verdict;
    const rotid_spread *spread = &v->spread[p];
    char text[PARAMETER_TEXT], figure[32];
    int shown = 0, left = 0;
    for (int i = 0; i < v->nalternative_causes; i++) {
        const rotid_cause *cause = &v->alternative_causes[i];
        if (verdict_is_pair(v, i) || p >= cause->nidentified)
            continue;
        if (shown == LISTED && !view->verbose) {
            left++;
            continue;
        }
        rotid_fitted_parameter value = of_cause(&cause->identified[p]);
        struct wrap wrap;
        shown++;
        wrap_open(&wrap, view->out, 6, view->width, "    ");
        wrap_item(&wrap, "%s if it is", parameter_text(&value, text));
        cause_items(&wrap, v, i);
        wrap_close(&wrap);
    }
    if (left)
        (void)fprintf(view->out, "    %d more with --verbose\n", left);
    if (shown + left > 1)
        (void)fprintf(view->out, "    these causes leave %.4g to %.4g%s%s, %s apart; their intervals %s to %s\n", spread->lowest,
                      spread->highest, layout_gap(spread->unit), layout_unit(spread->unit),
                      percent_text(200 * (spread->highest - spread->lowest) / fabs(spread->highest + spread->lowest), figure),
                      IN_DIGITS(4, spread->ci95[0]), IN_DIGITS(4, spread->ci95[1]));
}

/* What may hide in it: the causes that move it most. */
static void print_hidden(const struct diagnosis_view *view, const rotid_fitted_parameter *p)
{
    const rotid_diagnosis *d = view->diagnosis;
    struct wrap wrap;
    char figure[32];
    int shown = 0;
    for (int i = 0; i < d->nhidden; i++) {
        const rotid_hidden *hidden = &d->hidden[i];
        if (strcmp(hidden->parameter, p->name) != 0)
            continue;
        if (!shown)
            wrap_open(&wrap, view->out, 6, view->width, "    unseen: ");
        wrap_item(&wrap, "%s%s by", shown++ ? "; " : "", linear_percent_text(100 * fabs(hidden->shift / p->value), figure));
        wrap_item(&wrap, "%s%s%s", hidden->id, *hidden->target ? " of " : "", hidden->target);
        if (isfinite(hidden->z_m))
            wrap_item(&wrap, "at z %.3g m", hidden->z_m);
        if (strcmp(hidden->component, "presence") != 0)
            wrap_item(&wrap, "(%s %.2g%s%s)", hidden->component, fabs(hidden->size), layout_gap(hidden->size_unit),
                      layout_unit(hidden->size_unit));
    }
    if (shown)
        wrap_close(&wrap);
}

void table_parameters(const struct diagnosis_view *view)
{
    const rotid_diagnosis *d = view->diagnosis;
    const rotid_verdict *v = &d->verdict;
    const rotid_identification *fit = d->extended ? d->extended : d->base;
    int unseen = d->nhidden && (v->kind == ROTID_ADEQUATE || v->adequate_after); /* else what is left is seen */
    char text[PARAMETER_TEXT];
    if (!v->sentence || !fit || !d->base || !d->base->nparameters)
        return;
    (void)fprintf(view->out, "\nPARAMETERS  %s, 95 %% intervals%s\n", d->extended ? "extended model" : "model of the deck",
                  unseen ? "; unseen: shift by a cause below its detection limit" : "");
    for (int p = 0; p < d->base->nparameters; p++) {
        const rotid_fitted_parameter *value = fit_parameter(fit, d->base->parameters[p].name);
        (void)fputs("  ", view->out);
        text_cell(view->out, NAME, d->base->parameters[p].name);
        (void)fprintf(view->out, " %s\n", parameter_text(value, text));
        if (p < v->nspread)
            print_by_cause(view, p);
        if (value && unseen)
            print_hidden(view, value);
    }
}
