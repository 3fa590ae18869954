/* What to measure next: the tests, the rivals, the plans. */
#include <math.h>
#include <string.h>

#include "page/figures.h"
#include "page/human.h"
#include "page/sections.h"

static struct number_table *tests_table(struct pool *pool, const rotid_suggestion *s)
{
    static const char *const head[] = {"test", "chance [1]", "wrong name [1]", "cost [points]", "set-ups", "points", "modes"};
    struct number_table *table = table_headed(pool, s->ntests, 7, head);
    for (int i = 0; i < s->ntests; i++) {
        const rotid_suggested_test *t = &s->tests[i];
        table_cell(table, i, 0, t->text);
        table_cell(table, i, 1, human_fixed(pool, t->chance, 2));
        table_cell(table, i, 2, human_fixed(pool, t->wrong, 2));
        table_cell(table, i, 3, human_trimmed(pool, t->cost, 4));
        table_cell(table, i, 4, human_fixed(pool, t->setups, 0));
        table_cell(table, i, 5, human_fixed(pool, t->points, 0));
        table_cell(table, i, 6, human_fixed(pool, t->modes, 0));
    }
    return table;
}

static struct number_table *rivals_table(struct pool *pool, const rotid_suggestion *s)
{
    static const char *const head[] = {"rival", "chi2 [1]", "score [1]", "share [1]"};
    struct number_table *table = table_headed(pool, s->nrivals, 4, head);
    for (int i = 0; i < s->nrivals; i++) {
        table_cell(table, i, 0, s->rivals[i].label);
        table_cell(table, i, 1, human_fixed(pool, s->rivals[i].chi2, 2));
        table_cell(table, i, 2, human_fixed(pool, s->rivals[i].score, 2));
        table_cell(table, i, 3, human_fixed(pool, s->rivals[i].share, 2));
    }
    return table;
}

static struct number_table *plans_table(struct pool *pool, const rotid_suggestion *s)
{
    struct number_table *table = table_new(pool, s->nplans, 3 + s->nparameters);
    table_head(table, 0, "plan");
    table_head(table, 1, "sensors");
    table_head(table, 2, "gain [%]");
    for (int p = 0; p < s->nparameters; p++)
        table_head(table, 3 + p, pool_format(pool, "%s, half-width [%%]", s->parameters[p].name));
    for (int i = 0; i < s->nplans; i++) {
        const rotid_sensor_plan *plan = &s->plans[i];
        table_cell(table, i, 0, strcmp(plan->method, "effective_independence") ? plan->method : "effective independence");
        table_cell(table, i, 1, human_fixed(pool, plan->nz_m, 0));
        table_cell(table, i, 2, human_fixed(pool, plan->gain_percent, 1));
        for (int p = 0; p < s->nparameters && p < plan->nhalf_width_percent; p++)
            table_cell(table, i, 3 + p, human_digits(pool, plan->half_width_percent[p], 3));
    }
    return table;
}

static struct number_table *modes_table(struct pool *pool, const rotid_suggestion *s)
{
    struct number_table *table = table_new(pool, s->nmodes, 1 + 2 * s->nparameters);
    table_head(table, 0, "modes");
    for (int p = 0; p < s->nparameters; p++) {
        table_head(table, 1 + 2 * p, pool_format(pool, "%s by frequencies [%%]", s->parameters[p].name));
        table_head(table, 2 + 2 * p, pool_format(pool, "%s with shapes [%%]", s->parameters[p].name));
    }
    for (int i = 0; i < s->nmodes; i++) {
        const rotid_expected_modes *m = &s->modes[i];
        table_cell(table, i, 0, human_fixed(pool, m->modes, 0));
        for (int p = 0; p < s->nparameters; p++) {
            table_cell(table, i, 1 + 2 * p, human_digits(pool, p < m->nfrequencies_percent ? m->frequencies_percent[p] : NAN, 3));
            table_cell(table, i, 2 + 2 * p, human_digits(pool, p < m->nshapes_percent ? m->shapes_percent[p] : NAN, 3));
        }
    }
    return table;
}

void section_suggest(struct document *document, const struct result *result)
{
    const rotid_suggestion *s = result->suggest;
    struct pool *pool = document->pool;
    if (s->ntests) {
        document_section(document, "tests", "Tests that could be made next");
        if (s->verdict)
            document_paragraph(document, "The diagnosis: %s", s->verdict);
        document_table(document, "Tests: the chance that the true one of the rivals is named, what it takes",
                       tests_table(pool, s));
        document_table(document, "Rivals: what the diagnosis cannot tell apart", rivals_table(pool, s));
    }
    document_section(document, "sensors", "Sensors and modes");
    figure_sensor_worth(document, result);
    document_table(document, "Plans of sensors", plans_table(pool, s));
    if (s->nparameters)
        document_table(document, "Half-widths of the 95\xc2\xa0% intervals that are expected, by the number of modes",
                       modes_table(pool, s));
}
