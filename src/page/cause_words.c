#include "page/cause_words.h"

#include <ctype.h>
#include <math.h>
#include <string.h>

#include "diagnose/causes/catalogue.h"
#include "page/human.h"
#include "page/plain.h"
#include "result/judgement.h"

static const char *or_nothing(const char *text)
{
    return text ? text : "";
}

/* "a zone softer than its surroundings" */
static const char *cause_meaning(const char *id)
{
    const struct cause_kind *kind = catalogue_find(id);
    return kind ? kind->sentence : "";
}

const char *cause_check(const char *id)
{
    const struct cause_kind *kind = catalogue_find(id);
    return kind ? kind->check : "";
}

const char *cause_name(struct pool *pool, const char *id, const char *target)
{
    int left = (int)strcspn(target, "|");
    const char *name = plain_cause(pool, id);
    if (!*target)
        return name;
    if (target[left])
        return or_nothing(pool_format(pool, "%s between %.*s and %s", name, left, target, target + left + 1));
    return or_nothing(pool_format(pool, strncmp(target, "at ", 3) ? "%s of %s" : "%s %s", name, target));
}

const char *cause_label(struct pool *pool, const rotid_diagnosis *d, const rotid_cause *cause)
{
    return diagnosis_is_suspected(d, cause) ? cause->name : cause_name(pool, cause->id, cause->target);
}

const char *candidate_words(struct pool *pool, const rotid_diagnosis *d, const rotid_candidate *c)
{
    const char *label = cause_label(pool, d, &c->cause);
    return c->with ? or_nothing(pool_format(pool, "%s with %s", label, cause_label(pool, d, c->with))) : label;
}

#define TINY  1e-12 /* zero but for rounding, in SI units */
#define SMALL 1e-3  /* shown with a power of ten */
#define LARGE 1e5

/* "22.2 kg (95 %: 19.0 to 25.5)": two digits of half the interval, and of the value; this is read as a sentence. */
static const char *with_interval(struct pool *pool, const rotid_cause_value *value)
{
    struct human_unit shown = human_unit(value->value, value->unit);
    double f = shown.factor, number = fabs(value->value) < TINY ? 0 : f * value->value,
           half = f * (value->ci95[1] - value->ci95[0]) / 2;
    const char *text[3], *space = *shown.text ? "\xc2\xa0" : "";
    if (value->fixed || !isfinite(half) || (number == 0 && half < TINY))
        return human_value(pool, number == 0 ? 0 : value->value, value->unit);
    int power = number != 0 && (fabs(number) < SMALL || fabs(number) >= LARGE),
        decimals = human_decimals(number, fmin(10 * half, fabs(number) > 0 ? 10 * fabs(number) : INFINITY));
    const double part[3] = {number, f * value->ci95[0], f * value->ci95[1]};
    for (int i = 0; i < 3; i++)
        text[i] = power ? human_digits(pool, part[i], 2) : human_fixed(pool, part[i], decimals);
    return or_nothing(pool_format(pool, "%s%s%s (95\xc2\xa0%%: %s to %s)", text[0], space, shown.text, text[1], text[2]));
}

const char *cause_values(struct pool *pool, const rotid_cause *cause)
{
    const char *text = "";
    for (int p = 0; p < cause->nparameters && text; p++) {
        const rotid_cause_value *value = &cause->parameters[p];
        text = pool_format(pool, "%s%s%s %s%s", text, p ? ", " : "", value->name, with_interval(pool, value),
                           value->fixed ? " (given)" : "");
    }
    return or_nothing(text);
}

const char *cause_in_words(struct pool *pool, const rotid_diagnosis *d, const rotid_cause *cause, int with_values)
{
    const char *meaning = cause_meaning(cause->id), *name = cause_name(pool, cause->id, cause->target),
               *values = with_values ? cause_values(pool, cause) : "";
    if (diagnosis_is_suspected(d, cause))
        name = or_nothing(pool_format(pool, "%s, a %s as you suspected", cause->name, name));
    if (!*meaning)
        return or_nothing(pool_format(pool, *values ? "%s (%s)" : "%s%s", name, values));
    return or_nothing(pool_format(pool, "%s (%s%s%s)", meaning, name, *values ? ": " : "", values));
}

double cause_falls_from(const char *id)
{
    const struct cause_kind *kind = catalogue_find(id);
    if (!kind || kind->size < 0 || kind->size >= EFFECT_MOST_PARAMETERS || kind->parameter[kind->size].one_sided >= 0)
        return NAN;
    return kind->parameter[kind->size].neutral;
}

const char *words_sentence(struct pool *pool, const char *text)
{
    return or_nothing(pool_format(pool, "%c%s", toupper((unsigned char)*text), *text ? text + 1 : ""));
}

const char *words_chance(struct pool *pool, double p)
{
    if (!isfinite(p))
        return "";
    if (p < 0.001)
        return "in fewer than 1 of 1,000";
    if (p < 0.01)
        return or_nothing(pool_format(pool, "in about %.0f of 1,000", 1000 * p));
    return or_nothing(pool_format(pool, "in about %.0f of 100", 100 * p));
}
