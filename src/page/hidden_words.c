#include "page/hidden_words.h"

#include <math.h>

#include "fit/interval.h"
#include "page/cause_words.h"
#include "result/judgement.h"

static const char *in_words(struct pool *pool, const rotid_identification *fit, int count, const rotid_hidden *hidden, int causes)
{
    const char *text = "";
    char figure[32];
    for (int p = 0; p < fit->nparameters && text; p++) {
        const rotid_fitted_parameter *value = &fit->parameters[p];
        const rotid_hidden *most = hidden_in(count, hidden, value);
        if (!most)
            continue;
        text = pool_format(pool, "%s%s%s by %s", text, *text ? ", " : "", value->name,
                           linear_percent_text(100 * fabs(most->shift / value->value), figure));
        if (causes && text)
            text = pool_format(pool, "%s (%s)", text, cause_name(pool, most->id, most->target));
    }
    return text ? text : "";
}

const char *hidden_shifts_in_words(struct pool *pool, const rotid_identification *fit, int count, const rotid_hidden *hidden)
{
    return in_words(pool, fit, count, hidden, 0);
}

const char *hidden_causes_in_words(struct pool *pool, const rotid_identification *fit, int count, const rotid_hidden *hidden)
{
    return in_words(pool, fit, count, hidden, 1);
}

int hidden_is_wide(const rotid_identification *fit, int count, const rotid_hidden *hidden)
{
    int wide = 0;
    for (int p = 0; p < fit->nparameters; p++) {
        const rotid_hidden *most = hidden_in(count, hidden, &fit->parameters[p]);
        wide |= most && fabs(most->shift) > INTERVAL_WIDE * fabs(fit->parameters[p].value);
    }
    return wide;
}
