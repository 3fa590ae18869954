#include "page/tables_diagnosis.h"

#include <math.h>

#include "page/cause_words.h"
#include "page/human.h"

/* Two digits: more is not known of a size that would have shown. */
static const char *size_of(struct pool *pool, double size, const char *unit)
{
    struct human_unit shown = human_unit(size, unit);
    const char *text =
        pool_format(pool, "%s%s%s", human_digits(pool, size * shown.factor, 2), *shown.text ? "\xc2\xa0" : "", shown.text);
    return text ? text : "";
}

static const char *chance_of(struct pool *pool, double p)
{
    return p < 0.001 ? "<0.001" : human_digits(pool, p, 2);
}

static const char *fate(struct pool *pool, const rotid_round *round, const rotid_candidate *c, int i)
{
    if (i < round->set)
        return round->kind == ROTID_NAMED ? "named" : "possible";
    if (c->rejected_because) {
        const char *text = pool_format(pool, "refused: %s", c->rejected_because);
        return text ? text : "";
    }
    return c->refitted ? "not needed" : "not fitted";
}

static const char *label_of(struct pool *pool, const rotid_diagnosis *d, const rotid_candidate *c)
{
    const char *label = candidate_words(pool, d, c), *text = c->suspect ? pool_format(pool, "%s (your suspicion)", label) : label;
    return text ? text : label;
}

struct number_table *tables_candidates(struct pool *pool, const rotid_diagnosis *d, int round)
{
    int count;
    const rotid_candidate *candidate = diagnosis_candidates(d, round, &count);
    static const char *const head[] = {"cause", "drop expected", "drop reached", "p-value", "what became of it"};
    enum { COLUMNS = sizeof head / sizeof *head };
    struct number_table *table = table_headed(pool, count, COLUMNS, head);
    for (int i = 0; i < count; i++) {
        const rotid_candidate *c = &candidate[i];
        table_cell(table, i, 0, label_of(pool, d, c));
        table_cell(table, i, 1, human_digits(pool, c->predicted_drop, 4));
        table_cell(table, i, 2, human_digits(pool, c->chi2_drop, 4));
        table_cell(table, i, 3, chance_of(pool, c->p_value));
        table_cell(table, i, 4, fate(pool, &d->rounds[round], c, i));
    }
    return table;
}

struct number_table *tables_candidate_quality(struct pool *pool, const rotid_diagnosis *d, int round)
{
    int count;
    const rotid_candidate *candidate = diagnosis_candidates(d, round, &count);
    static const char *const head[] = {
        "cause", "BIC", "modes left out [%]", "sensors left out [1]", "held out [%]", "most similar (cosine)"};
    enum { COLUMNS = sizeof head / sizeof *head, LEFT_OUT = 2, LIKE = COLUMNS - 1 };
    int shown[COLUMNS], columns = 0, rows = 0, known[COLUMNS] = {1, 1, 0, 0, 0, 1};
    for (int i = 0; i < count; i++) { /* what was not left out has no column */
        const rotid_candidate *c = &candidate[i];
        known[LEFT_OUT] |= isfinite(c->mode_out_rms) != 0;
        known[LEFT_OUT + 1] |= isfinite(c->sensor_out_rms) != 0;
        known[LEFT_OUT + 2] |= isfinite(c->holdout_rms) != 0;
        rows += c->refitted != 0;
    }
    for (int j = 0; j < COLUMNS; j++)
        if (known[j])
            shown[columns++] = j;
    struct number_table *table = table_new(pool, rows, columns);
    for (int j = 0; j < columns; j++)
        table_head(table, j, head[shown[j]]);
    for (int i = 0, row = 0; i < count; i++) {
        const rotid_candidate *c = &candidate[i];
        if (!c->refitted)
            continue;
        const char *const cell[COLUMNS] = {
            label_of(pool, d, c),
            human_digits(pool, c->bic, 5),
            human_digits(pool, c->mode_out_rms, 3),
            human_digits(pool, c->sensor_out_rms, 3),
            human_digits(pool, c->holdout_rms, 3),
            c->collinear_with ? pool_format(pool, "%s (%s)",
                                            cause_name(pool, c->collinear_with, c->collinear_target ? c->collinear_target : ""),
                                            human_fixed(pool, c->cosine, 2))
                              : ""};
        for (int j = 0; j < columns; j++)
            table_cell(table, row, j, cell[shown[j]]);
        row++;
    }
    return table;
}

struct number_table *tables_candidate_sizes(struct pool *pool, const rotid_diagnosis *d, int round)
{
    int count;
    const rotid_candidate *candidate = diagnosis_candidates(d, round, &count);
    int rows = 0;
    for (int i = 0; i < count; i++)
        rows += candidate[i].refitted != 0;
    struct number_table *table = table_new(pool, rows, 2);
    table_head(table, 0, "cause");
    table_head(table, 1, "size and place, 95 % interval");
    for (int i = 0, row = 0; i < count; i++) {
        const rotid_candidate *c = &candidate[i];
        const char *values = cause_values(pool, &c->cause), *both = c->with ? cause_values(pool, c->with) : "";
        if (*both)
            both = pool_format(pool, "%s%s%s", values, *values ? "; with " : "", both);
        values = both && *both ? both : values;
        if (!c->refitted)
            continue;
        table_cell(table, row, 0, label_of(pool, d, c));
        table_cell(table, row++, 1, c->at_bound ? pool_format(pool, "%s, at a bound", values) : values);
    }
    return table;
}

struct number_table *tables_quality(struct pool *pool, const rotid_diagnosis *d)
{
    const rotid_gain *gain = &d->gain;
    const struct {
        const rotid_pair *pair;
        const char *text;
        double factor;
    } rows[] = {{&gain->frequency_rms_percent, "fitted frequencies, error, rms [%]", 1},
                {&gain->frequency_max_percent, "fitted frequencies, largest error [%]", 1},
                {&gain->shape_rms, "fitted shapes, rms [% of the largest component]", 100},
                {&gain->chi2_per_dof, "misfit \xcf\x87\xc2\xb2 per degree of freedom [1]", 1},
                {&gain->nco_min, "smallest NCO [1]", 1},
                {&gain->holdout_frequency_rms_percent, "modes held out by the deck, frequency, rms [%]", 1},
                {&gain->holdout_shape_rms, "modes held out by the deck, shape, rms [%]", 100},
                {&gain->mode_out_frequency_rms_percent, "modes left out in turn, frequency, rms [%]", 1},
                {&gain->mode_out_shape_rms, "modes left out in turn, shape, rms [%]", 100},
                {&gain->sensor_out_shape_rms, "sensors left out in turn, shape, rms [%]", 100}};
    int count = 0, after = d->extended != NULL, n = (int)(sizeof rows / sizeof *rows);
    for (int i = 0; i < n; i++)
        count += isfinite(rows[i].pair->before) || isfinite(rows[i].pair->after);
    struct number_table *table = table_new(pool, count, 2 + after);
    table_head(table, 0, "quality");
    table_head(table, 1, after ? "without the cause" : "of the model");
    if (after)
        table_head(table, 2, "with it");
    for (int i = 0, row = 0; i < n; i++) {
        const rotid_pair *pair = rows[i].pair;
        if (!isfinite(pair->before) && !isfinite(pair->after))
            continue;
        table_cell(table, row, 0, rows[i].text);
        table_cell(table, row, 1, human_digits(pool, rows[i].factor * pair->before, 3));
        if (after)
            table_cell(table, row, 2, human_digits(pool, rows[i].factor * pair->after, 3));
        row++;
    }
    return table;
}

struct number_table *tables_detection_limits(struct pool *pool, const rotid_diagnosis *d)
{
    static const char *const head[] = {"cause", "parameter", "smallest that would have shown", "where it shows best",
                                       "at the worst place"};
    struct number_table *table = table_headed(pool, d->ndetectable, 5, head);
    for (int i = 0; i < d->ndetectable; i++) {
        const rotid_detectable *size = &d->detectable[i];
        int none = size->beyond || !isfinite(size->smallest);
        double neutral = cause_falls_from(size->id), shown = isfinite(neutral) ? neutral - size->smallest : size->smallest;
        table_cell(table, i, 0, cause_name(pool, size->id, size->target));
        table_cell(table, i, 1, size->parameter);
        table_cell(table, i, 2,
                   none ? "no size within physical bounds"
                        : pool_format(pool, "%s%s", size_of(pool, shown, size->unit), isfinite(neutral) ? " or less" : ""));
        table_cell(table, i, 3,
                   isfinite(size->z_m) && !none ? pool_format(pool, "z = %s\xc2\xa0m", human_digits(pool, size->z_m, 3)) : "");
        table_cell(table, i, 4,
                   isfinite(size->worst)          ? size_of(pool, size->worst, size->unit)
                   : isfinite(size->z_m) && !none ? "no size"
                                                  : "");
    }
    return table;
}

struct number_table *tables_numerical(struct pool *pool, const rotid_numerical_finding *finding)
{
    struct number_table *table = table_new(pool, finding->nmodes, 2);
    table_head(table, 0, "mode");
    table_head(table, 1, "error of the frequency [%]");
    for (int k = 0; k < finding->nmodes; k++) {
        table_cell(table, k, 0, human_fixed(pool, finding->modes[k], 0));
        table_cell(table, k, 1, human_signed(pool, finding->error_percent[k], 3));
    }
    return table;
}
