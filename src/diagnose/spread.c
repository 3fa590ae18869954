#include "diagnose/spread.h"

#include <math.h>
#include <string.h>

#include "fit/interval.h"

static void add_value(const rotid_cause_value *value, rotid_spread *spread)
{
    int first = !spread->name;
    if (first)
        *spread = (rotid_spread){value->name, value->unit, value->value, value->value, {value->ci95[0], value->ci95[1]}};
    spread->lowest = fmin(spread->lowest, value->value);
    spread->highest = fmax(spread->highest, value->value);
    /* fmin and fmax prefer the number: one interval that is missing leaves none */
    spread->ci95[0] = isfinite(value->ci95[0]) && isfinite(spread->ci95[0]) ? fmin(spread->ci95[0], value->ci95[0]) : (double)NAN;
    spread->ci95[1] = isfinite(value->ci95[1]) && isfinite(spread->ci95[1]) ? fmax(spread->ci95[1], value->ci95[1]) : (double)NAN;
}

int spread_of_alternatives(struct engine *engine)
{
    const struct diagnosis *out = engine->out;
    rotid_verdict *verdict = &engine->out->result.verdict;
    verdict->nspread = 0;
    verdict->spread = POOL_ARRAY(engine->pool, rotid_spread, engine->nown);
    if (!verdict->spread)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < out->nalternative; i++)
        for (int p = 0; p < out->alternative[i].nidentified; p++) {
            add_value(&out->alternative[i].identified[p], &verdict->spread[p]);
            verdict->nspread = engine->nown;
        }
    return ROTID_OK;
}

const char *spread_sentence(struct engine *engine)
{
    const struct diagnosis *out = engine->out;
    const rotid_verdict *verdict = &out->result.verdict;
    const char *text = "";
    char figure[32];
    int sets = 0;
    for (int i = 0, set = 0; i < out->nalternative; i++)
        if (out->alternative[i].nidentified && out->alternative[i].set != set) {
            set = out->alternative[i].set;
            sets++;
        }
    if (sets < 2) /* one alone differs from none, as do those that were weighed without a refit of the parameters */
        return "";
    for (int p = 0; p < verdict->nspread; p++) {
        const rotid_spread *s = &verdict->spread[p];
        double percent = 200 * (s->highest - s->lowest) / fabs(s->highest + s->lowest);
        if (isfinite(percent) && text)
            text = pool_format(engine->pool, "%s%s%s by %s", text, *text ? ", " : "", s->name, percent_text(percent, figure));
    }
    return !text || !*text ? text : pool_format(engine->pool, " Between these causes differ: %s.", text);
}

const char *hidden_sentence(struct engine *engine, const rotid_fit_result *fit)
{
    const rotid_diagnosis *out = &engine->out->result;
    const char *text = "", *last = "";
    char figure[32];
    for (int i = 0; i < out->nhidden; i++) {
        const rotid_hidden *hidden = &out->hidden[i];
        int p = 0, first = strcmp(last, hidden->parameter) != 0; /* the one that moves it most */
        while (p < engine->nown && strcmp(engine->states.bounds[p].name, hidden->parameter) != 0)
            p++;
        last = hidden->parameter;
        if (!first || !text || p == engine->nown || p >= fit->n ||
            !(fabs(hidden->shift) > (fit->ci_upper[p] - fit->ci_lower[p]) / 2))
            continue;
        text = pool_format(engine->pool, "%s%s%s by %s", text, *text ? ", " : "", hidden->parameter,
                           linear_percent_text(100 * fabs(hidden->shift / fit->x[p]), figure));
    }
    return !text || !*text
               ? text
               : pool_format(engine->pool,
                             " A cause below its detection limit may be present: beyond the intervals it may move %s.", text);
}
