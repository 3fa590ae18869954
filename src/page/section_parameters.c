/* The parameters of a verdict: with their intervals, by each cause that cannot be told apart, and what may hide in them. */
#include <math.h>
#include <string.h>

#include "fit/interval.h"
#include "page/cause_words.h"
#include "page/human.h"
#include "page/sections.h"
#include "result/judgement.h"

/* A value with its interval in the unit that suits it, in the cells from `column` on. */
static void value_cells(struct pool *pool, struct number_table *table, int row, int column, double value, const double ci[2],
                        const char *in)
{
    struct human_unit unit = human_unit(value, in);
    double f = unit.factor;
    int decimals = human_decimals(value * f, (ci[1] - ci[0]) / 2 * f);
    table_cell(table, row, column, *unit.text ? pool_copy_text(pool, unit.text) : "1");
    table_cell(table, row, column + 1, human_fixed(pool, value * f, decimals));
    table_cell(table, row, column + 2, human_fixed(pool, ci[0] * f, decimals));
    table_cell(table, row, column + 3, human_fixed(pool, ci[1] * f, decimals));
}

/* "stiffness of right with added_mass": set of alternative i. */
static const char *set_label(struct pool *pool, const rotid_diagnosis *d, int i)
{
    const rotid_verdict *v = &d->verdict;
    const char *text = cause_label(pool, d, &v->alternative_causes[i]);
    for (int k = i + 1; k < v->nalternative_causes && verdict_is_pair(v, k); k++)
        text = pool_format(pool, "%s with %s", text ? text : "", cause_label(pool, d, &v->alternative_causes[k]));
    return text ? text : "";
}

static struct number_table *table_values(struct pool *pool, const rotid_diagnosis *d)
{
    static const char *const head[] = {"parameter", "if it is", "unit", "value", "95 % from", "to"},
                             *const alone[] = {"parameter", "unit", "value", "95 % from", "to"}; /* fits a telephone */
    const rotid_identification *fit = d->extended ? d->extended : d->base;
    const rotid_verdict *v = &d->verdict;
    int n = d->base->nparameters, row = 0, rows = n;
    for (int i = 0; i < v->nalternative_causes; i++)
        rows += verdict_is_pair(v, i) ? 0 : v->alternative_causes[i].nidentified;
    struct number_table *table = v->nalternative_causes ? table_headed(pool, rows, 6, head) : table_headed(pool, rows, 5, alone);
    for (int p = 0; p < n; p++) {
        const rotid_fitted_parameter *value = fit_parameter(fit, d->base->parameters[p].name);
        table_cell(table, row, 0, d->base->parameters[p].name);
        if (v->nalternative_causes)
            table_cell(table, row, 1, d->extended ? "the extended model" : "the model as it is");
        if (value)
            value_cells(pool, table, row, v->nalternative_causes ? 2 : 1, value->value, value->ci95, value->unit);
        row++;
        for (int i = 0; i < v->nalternative_causes; i++) {
            const rotid_cause *cause = &v->alternative_causes[i];
            if (verdict_is_pair(v, i) || p >= cause->nidentified || row >= rows)
                continue;
            table_cell(table, row, 0, cause->identified[p].name);
            table_cell(table, row, 1, set_label(pool, d, i));
            value_cells(pool, table, row++, 2, cause->identified[p].value, cause->identified[p].ci95, cause->identified[p].unit);
        }
    }
    return table;
}

/* What the dispute is worth, in a paragraph. */
static void say_spread(struct document *document, const rotid_verdict *v)
{
    char figure[32];
    for (int p = 0; p < v->nspread && verdict_sets(v) > 1; p++) {
        const rotid_spread *s = &v->spread[p];
        struct human_unit unit = human_unit(s->highest, s->unit);
        document_paragraph(document, "%s lies between %s and %s%s%s, %s apart, depending on the cause.", s->name,
                           human_digits(document->pool, s->lowest * unit.factor, 4),
                           human_digits(document->pool, s->highest * unit.factor, 4), *unit.text ? "\xc2\xa0" : "", unit.text,
                           percent_text(200 * (s->highest - s->lowest) / fabs(s->highest + s->lowest), figure));
    }
}

static struct number_table *table_hidden(struct pool *pool, const rotid_identification *fit, int count,
                                         const rotid_hidden *hidden)
{
    static const char *const head[] = {"parameter", "moved by", "cause", "its size", "where"};
    struct number_table *table = table_headed(pool, count, 5, head);
    char figure[32];
    for (int i = 0; i < count; i++) {
        const rotid_fitted_parameter *value = fit_parameter(fit, hidden[i].parameter);
        struct human_unit unit = human_unit(hidden[i].size, hidden[i].size_unit);
        int presence = !strcmp(hidden[i].component, "presence");
        table_cell(table, i, 0, hidden[i].parameter);
        table_cell(table, i, 1,
                   value ? pool_copy_text(pool, linear_percent_text(100 * fabs(hidden[i].shift / value->value), figure)) : "");
        table_cell(table, i, 2, cause_name(pool, hidden[i].id, hidden[i].target));
        table_cell(table, i, 3,
                   presence ? "there or not"
                            : pool_format(pool, "%s %s%s%s", hidden[i].component,
                                          human_digits(pool, fabs(hidden[i].size) * unit.factor, 2), *unit.text ? "\xc2\xa0" : "",
                                          unit.text));
        table_cell(table, i, 4,
                   isfinite(hidden[i].z_m) ? pool_format(pool, "z = %s\xc2\xa0m", human_digits(pool, hidden[i].z_m, 3)) : "");
    }
    return table;
}

void section_hidden(struct document *document, const rotid_identification *fit, int count, const rotid_hidden *hidden)
{
    if (!count)
        return;
    document_section(document, "hidden", "What may hide in the parameters");
    document_paragraph(
        document, "The model explains the measurement, and so would a model with one of these causes in it, of a size below its "
                  "detection limit. The fit without the cause moves the parameter as far as this. The size is the smallest "
                  "that shows in 9 of 10 tests at that place, or the largest that is physical, as its distance from no effect; a "
                  "smaller one moves the parameter less in proportion.");
    document_table(document, "Causes below their detection limits that move the parameters most",
                   table_hidden(document->pool, fit, count, hidden));
}

void section_parameters(struct document *document, const rotid_diagnosis *d)
{
    const rotid_identification *fit = d->extended ? d->extended : d->base;
    const rotid_verdict *v = &d->verdict;
    if (!d->base || !fit || v->kind < 0 || !d->base->nparameters)
        return;
    document_section(document, "verdict-parameters", "Parameters of the verdict");
    say_spread(document, v);
    document_table(document, "Parameters and their 95 % intervals", table_values(document->pool, d));
    if (v->kind == ROTID_ADEQUATE || v->adequate_after)
        section_hidden(document, fit, d->nhidden, d->hidden);
}
