/* What a page rests on, and where it comes from. */
#include <math.h>
#include <string.h>

#include "page/page.h"
#include "report/report.h"

#define KEYS_SINCE "0.3.0" /* the version whose results hold what a page asks for beyond those of 0.2 */

static const char *noise_of(struct pool *pool, const struct result *result)
{
    const rotid_noise *noise = noise_of_result(result);
    if (!noise || !fit_of_result(result) || !(noise->intervals_from || result->diagnose))
        return NULL;
    const char *frequency = isfinite(noise->frequency)
                                ? pool_format(pool, "frequencies %s\xc2\xa0%%%s", human_digits(pool, 100 * noise->frequency, 2),
                                              noise->frequency_assumed ? " (assumed)" : "")
                                : "frequencies: not stated",
               *shape = isfinite(noise->shape)
                            ? pool_format(pool, "shapes %s\xc2\xa0%% of the largest component%s",
                                          human_digits(pool, 100 * noise->shape, 2), noise->shape_assumed ? " (assumed)" : "")
                            : "shapes: not stated";
    return pool_format(pool, "%s; %s", frequency ? frequency : "", shape ? shape : "");
}

static const char *records_of(struct pool *pool, const struct ema_source *source)
{
    const char *impacts = source->from_time_records
                              ? pool_format(pool, ", from %d impacts of which %d are used", source->impacts, source->impacts_used)
                              : "";
    return pool_format(pool, "%d transfer %s of %d lines from %s%s", source->transfer_functions,
                       human_plural(source->transfer_functions, "function", "functions"), source->lines,
                       human_range(pool, source->low_hz, source->high_hz, "Hz"), impacts ? impacts : "");
}

static const char *data_of(struct pool *pool, const struct result *result)
{
    const rotid_identification *fit = fit_of_result(result);
    int shapes = 0;
    if (result->ema)
        return records_of(pool, &result->ema->source);
    if (!fit || !fit->nmodes)
        return NULL;
    for (int k = 0; fit->shapes && k < fit->shapes->nmodes; k++)
        shapes += fit->shapes->modes[k].measured != NULL;
    double low = INFINITY, high = 0;
    for (int k = 0; k < fit->nmodes; k++) {
        low = fmin(low, fit->modes[k].measured_hz);
        high = fmax(high, fit->modes[k].measured_hz);
    }
    const char *text = pool_format(pool, "%d measured %s from %s", fit->nmodes, human_plural(fit->nmodes, "mode", "modes"),
                                   human_range(pool, low, high, "Hz"));
    if (!fit->shapes || !text)
        return text;
    return shapes ? pool_format(pool, "%s, %d with a shape at %d sensors", text, shapes, fit->shapes->nsensor_id)
                  : pool_format(pool, "%s, without shapes", text);
}

/* Elements along the axis. */
static int elements_of(const rotid_geometry *geometry)
{
    int elements = 0;
    for (int g = 0; g < geometry->ngroups; g++)
        for (int s = 0; s < geometry->groups[g].nsegments && !geometry->groups[g].layer_of; s++)
            elements += geometry->groups[g].segments[s].elements;
    return elements;
}

static const char *model_of(struct pool *pool, const struct result *result)
{
    const rotid_identification *fit = fit_of_result(result);
    const rotid_geometry *geometry = geometry_of_result(result);
    const char *size = geometry ? pool_format(pool, "%s\xc2\xa0m, %d %s", human_trimmed(pool, geometry->length_m, 4),
                                              elements_of(geometry), human_plural(elements_of(geometry), "element", "elements"))
                                : "",
               *how = fit ? pool_format(pool, "%s%s\xc2\xa0kg, centre of mass at %s\xc2\xa0m; functional %s, reduction %s",
                                        *size ? ", " : "", human_trimmed(pool, fit->mass_kg, 4),
                                        human_trimmed(pool, fit->center_of_mass_m, 4), fit->functional, fit->reduction)
                          : "";
    return geometry || fit ? pool_format(pool, "%s%s", size ? size : "", how ? how : "") : NULL;
}

#define MOST_FACTS 6

/* What one section says of a result: names and values, NULL where it has none. */
struct facts {
    int count;
    const char *const *name;
    void (*of)(struct pool *pool, const struct result *result, const char *value[MOST_FACTS]);
};

/* The values of a result that none before it has: a model said in fewer words is no other one. Their number. */
static int new_facts(struct pool *pool, const struct facts *facts, const struct result *result, int i,
                     const char *value[MOST_FACTS])
{
    const char *before[MOST_FACTS] = {NULL};
    int told = 0;
    facts->of(pool, &result[i], value);
    for (int j = 0; j < i; j++) {
        facts->of(pool, &result[j], before);
        for (int k = 0; k < facts->count; k++)
            if (value[k] && before[k] && !strncmp(value[k], before[k], strlen(value[k])))
                value[k] = NULL;
    }
    for (int k = 0; k < facts->count; k++)
        told += value[k] != NULL;
    return told;
}

static void add_facts(struct document *document, const struct facts *facts, int count, const struct result *result)
{
    const char *value[MOST_FACTS] = {NULL};
    for (int i = 0; i < count; i++) {
        if (!new_facts(document->pool, facts, result, i, value))
            continue;
        if (count > 1)
            document_heading(document, page_source(&result[i]));
        document_facts(document, facts->count, facts->name, value);
    }
}

static void basics_of(struct pool *pool, const struct result *result, const char *value[MOST_FACTS])
{
    value[0] = data_of(pool, result);
    value[1] = noise_of(pool, result);
    value[2] = model_of(pool, result);
}

void section_basis(struct document *document, int count, const struct result *result)
{
    static const char *const name[] = {"Data", "Noise", "Model"};
    static const struct facts basics = {3, name, basics_of};
    const char *value[MOST_FACTS] = {NULL};
    int told = result->head.nheading > 1;
    for (int i = 0; i < count; i++)
        told |= result[i].nwarnings > 0 || new_facts(document->pool, &basics, result, i, value) > 0;
    if (!told)
        return;
    document_section(document, "basis", "What it rests on");
    add_facts(document, &basics, count, result);
    for (int k = 1; k < result->head.nheading; k++)
        document_paragraph(document, "%s", result->head.heading[k]);
    for (int i = 0; i < count; i++)
        if (result[i].nwarnings) {
            document_heading(document, "What rotid notes");
            document_list(document, result[i].nwarnings, result[i].warnings);
        }
}

/* "soft zone: stiffness_local", of every cause that a diagnosis tried or has a limit for and whose name in words is another one.
 */
static const char *ids_of(struct pool *pool, const struct result *result)
{
    const rotid_diagnosis *d = result->diagnose;
    const char *text = "";
    for (int r = 0; d && r < d->nrounds; r++) {
        int count;
        const rotid_candidate *candidate = diagnosis_candidates(d, r, &count);
        for (int i = 0; i < count && text; i++) {
            const char *id = candidate[i].cause.id,
                       *pair = strchr(id, '_') ? pool_format(pool, "%s: %s", plain_cause(pool, id), id) : NULL;
            if (pair && !strstr(text, pair))
                text = pool_format(pool, "%s%s%s", text, *text ? "; " : "", pair);
        }
    }
    return text && *text ? text : NULL;
}

static void origin_of(struct pool *pool, const struct result *result, const char *value[MOST_FACTS])
{
    value[0] = pool_format(pool, "%s (rotid %s)", result->file, result->head.command);
    value[1] = result->ema ? result->ema->source.file : result->head.deck;
    value[2] = pool_format(pool, "rotid %s, commit %s", result->head.rotid, result->head.commit);
    value[3] = result->head.threads ? pool_format(pool, "seed %.0f, %d %s", result->head.seed, result->head.threads,
                                                  human_plural(result->head.threads, "thread", "threads"))
                                    : pool_format(pool, "seed %.0f", result->head.seed);
    value[4] = *result->head.blas ? result->head.blas : NULL;
    value[5] = ids_of(pool, result);
}

void section_provenance(struct document *document, int count, const struct result *result)
{
    static const char *const name[] = {"Result", "Deck or file", "Program", "Seed, threads", "Linear algebra", "Causes on cards"};
    static const struct facts origin = {MOST_FACTS, name, origin_of};
    document->of = NULL;
    document->verbatim = 1;
    document_section(document, "provenance", "Provenance");
    add_facts(document, &origin, count, result);
    for (int i = 0; i < count; i++)
        for (int k = 0; k < result[i].nlacking; k++)
            document_paragraph(
                document,
                "Not shown: %s. %s was made by rotid %s and has no key \"%s\", which results have from rotid %s on. rotid "
                "%s %s --json %s makes a new one.",
                result[i].lacking[k].shows, result[i].file, result[i].head.rotid, result[i].lacking[k].key, KEYS_SINCE,
                result[i].head.command, result[i].head.deck ? result[i].head.deck : "DECK", result[i].file);
    document->verbatim = 0;
}
