/* The section of the machine in operation. */
#include <math.h>
#include <string.h>

#include "page/page.h"
#include "running/running.h"

/* The judged critical speed with the least margin, NULL where none is judged. */
static const rotid_critical_speed *nearest(const rotid_speeds *s)
{
    const rotid_critical_speed *least = NULL;
    for (int i = 0; i < s->ncritical_speeds; i++) {
        const rotid_critical_speed *c = &s->critical_speeds[i];
        if (isfinite(c->margin.value) && (!least || c->margin.value < least->margin.value))
            least = c;
    }
    return least;
}

const char *answer_of_speeds(struct pool *pool, const rotid_speeds *s)
{
    const rotid_critical_speed *c = nearest(s);
    if (c)
        return speeds_judgement(pool, c, s);
    if (!s->ncritical_speeds)
        return pool_format(pool, "No critical speed up to %s rpm",
                           human_trimmed(pool, s->campbell[s->ncampbell - 1].speed_rpm, 5));
    return pool_format(pool, "%d critical %s, the first at %s rpm", s->ncritical_speeds,
                       human_plural(s->ncritical_speeds, "speed", "speeds"),
                       human_trimmed(pool, s->critical_speeds[0].speed_rpm, 5));
}

void section_speeds(struct document *document, const struct result *result)
{
    const rotid_speeds *s = result->speeds;
    struct pool *pool = document->pool;
    document_section(document, "operation", "The machine in operation");
    const char *stability = speeds_stability(pool, s);
    document_paragraph(document, "%s.", stability ? stability : "");
    document_figures(document, "speeds");
    document_table(document, table_of_critical_speeds(pool, s));
    document_table(document, table_of_stability(pool, s));
    if (s->nrunup)
        document_table(document, table_of_runup(pool, s->nrunup, s->runup));
    if (s->ntorsion)
        document_table(document, table_of_torsion(pool, s));
    if (s->ncritical_speeds && s->critical_speeds[0].nvariance_shares)
        document_table(document, table_of_shares(pool, s));
    if (s->ncritical_speeds && s->critical_speeds[0].nsensitivities)
        document_table(document, table_of_sensitivities(pool, s));
}
