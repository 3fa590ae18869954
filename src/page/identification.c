/* The verdict on an identification in plain words, the tiles, and how far to trust it. */
#include "fit/fit.h"
#include "page/page.h"

#define NAMED 3 /* parameters that the answer names; the table has the others */

/* "core.E = 116 GPa (95 %: 55 to 176); core.G = ..." */
static const char *values(struct pool *pool, const rotid_identification *fit)
{
    const char *text = "";
    for (int p = 0; p < fit->nparameters && p < NAMED; p++) {
        const rotid_fitted_parameter *parameter = &fit->parameters[p];
        text = pool_text(pool, "%s%s%s = %s", text, p ? "; " : "", parameter->name,
                         human_interval(pool, parameter->value, parameter->ci95, parameter->unit));
    }
    if (fit->nparameters > NAMED)
        text = pool_text(pool, "%s; and %s more", text, human_count(pool, fit->nparameters - NAMED));
    return text;
}

static void tile_number(struct document *document, const char *name, double value, const char *note)
{
    if (isfinite(value))
        document_tile(document, name, human_digits(document->pool, value, 2), note);
}

void tile_parameter(struct document *document, const rotid_fitted_parameter *parameter, const char *note)
{
    struct pool *pool = document->pool;
    struct human_unit unit = human_unit(parameter->value, parameter->unit);
    double f = unit.factor, half = (parameter->ci95[1] - parameter->ci95[0]) / 2 * f;
    int decimals = human_decimals(parameter->value * f, half);
    const char *interval = isfinite(half)
                               ? pool_text(pool, "95\xc2\xa0%%: %s to %s", human_fixed(pool, parameter->ci95[0] * f, decimals),
                                           human_fixed(pool, parameter->ci95[1] * f, decimals))
                               : "no interval can be stated";
    document_tile(document, *unit.text ? pool_text(pool, "%s [%s]", parameter->name, unit.text) : parameter->name,
                  human_fixed(pool, parameter->value * f, decimals),
                  pool_text(pool, "%s%s%s", interval, note ? "; " : "", or_nothing(note)));
}

void answer_identify(struct document *document, const struct result *result)
{
    const rotid_identification *fit = result->identify;
    struct pool *pool = document->pool;
    const char *shifts = hidden_in_words(pool, fit, fit->nhidden, fit->hidden, 0);
    document->now.text = values(pool, fit);
    document->now.tone = reasons_of_fit(pool, &result->head, fit).tone;
    if (document->now.tone == TONE_GOOD)
        document->now.headline = *shifts ? pool_text(pool, "Reliable; effects below the detection limits may shift %s", shifts)
                                         : "Reliable if the model is right";
    for (int p = 0; p < fit->nparameters && p < TILES_MOST - 3; p++)
        tile_parameter(document, &fit->parameters[p],
                       fit->parameters[p].identifiable ? NULL : parameter_remark(pool, &fit->parameters[p]));
    tile_number(document, "error of the frequencies, rms [%]", fit_rms_percent(fit, 0), "of the fitted modes");
    tile_number(document, "error of held-out frequencies, rms [%]", fit_rms_percent(fit, 1), "not fitted");
    tile_number(document, "\xcf\x87\xc2\xb2 per degree of freedom", fit->chi2_per_dof,
                pool_text(pool, "%d degrees of freedom; 1 is what the stated noise leaves", fit->dof));
}

void section_trust(struct document *document, const struct result *result)
{
    const struct reasons reasons = reasons_of_fit(document->pool, &result->head, result->identify);
    document_section(document, "trust", "How far to trust it", NULL);
    document_list(document, reasons.count, reasons.text);
    if (!fit_is_inadequate(result->identify)) /* else something shows already */
        section_hidden(document, result->identify, result->identify->nhidden, result->identify->hidden);
}

/* The first sentence of those that the section has. */
static const char *first(const struct reasons said)
{
    return said.count ? said.text[0] : "";
}

void answer_plain(struct document *document, const struct result *result)
{
    struct pool *pool = document->pool;
    const char *text = "";
    if (result->modes && result->modes->nmodes) {
        const rotid_model_mode *mode = result->modes->modes;
        text = pool_text(pool, "%d bending modes from %s", result->modes->nmodes,
                         human_range(pool, mode[0].full_hz, mode[result->modes->nmodes - 1].full_hz, "Hz"));
    } else if (result->check) {
        text = pool_text(pool, "A rotor of %s and %s in %d %s", human_value(pool, result->check->length_m, "m"),
                         human_value(pool, result->check->mass_kg, "kg"), result->check->elements,
                         human_plural(result->check->elements, "element", "elements"));
    }
    document->now.text = result->suggest       ? result->suggest->sentence
                         : result->speeds      ? first(shown_of_speeds(pool, result->speeds, 0).said)
                         : result->sensitivity ? sensitivity_in_words(pool, result->sensitivity)
                         : result->frf         ? first(sentences_of_transfer(pool, result->frf))
                                               : text;
}
