#include "page/page.h"

#include <string.h>

#include "page/human.h"
#include "page/sections.h"

static const char *subtitle(struct pool *pool, const struct result *result)
{
    const char *text = pool_format(pool, "rotid %s %s, version %s (%s)", result->head.command,
                                   result->head.deck ? result->head.deck : result->file, result->head.rotid, result->head.commit);
    return text ? text : "";
}

/* The first line of the heading that says something; of a deck without one its name. */
static const char *title(const struct result *result)
{
    for (int i = 0; i < result->head.nheading; i++)
        if (result->head.heading[i][strspn(result->head.heading[i], " \t")])
            return result->head.heading[i];
    return result->head.deck && *result->head.deck ? result->head.deck : result->file;
}

/* The deck of a further result where it is another one than that of the page, NULL where it is not. */
static const char *other_deck(const struct result *result, const struct result *main_result)
{
    const char *name;
    if (!result->head.deck || !main_result->head.deck || !strcmp(result->head.deck, main_result->head.deck))
        return NULL;
    name = strrchr(result->head.deck, '/');
    return name ? name + 1 : result->head.deck;
}

/* The sections of a result that each state has. */
static void compose_state(struct document *document, const struct result *result)
{
    if (result->identify)
        section_agreement(document, result);
    if (result->modes)
        section_modes(document, result);
    if (result->sensitivity)
        section_sensitivity(document, result);
    if (result->frf)
        section_transfer(document, result);
}

/* of: the deck where it is not that of the page, or NULL; drawn: the rotors are on the page already */
static void compose_states(struct document *document, const struct result *result, const char *of, int drawn)
{
    for (int s = 0; s < page_state_count(result); s++) {
        const struct result own = page_result_of_state(document->pool, result, s);
        document->of = pool_format(document->pool, "%s%sstate %s", of ? of : "", of ? ", " : "", page_state_name(result, s));
        if (document->pool->out_of_memory)
            return;
        if (!drawn && geometry_of_result(&own))
            section_rotor(document, &own, fit_of_result(&own));
        compose_state(document, &own);
    }
    document->of = of;
}

void page_compose(struct document *document, int count, const struct result *result)
{
    document->title = title(result);
    document->subtitle = subtitle(document->pool, result);
    if (result->identify)
        answer_identify(document, result, result->identify);
    else if (result->diagnose)
        answer_diagnose(document, result);
    else if (result->studied)
        answer_study(document, result);
    else
        answer_plain(document, result);
    section_rests_on(document, count, result);
    int first = 0; /* one picture of the rotor, of each state, does */
    while (first < count && !geometry_of_result(&result[first]))
        first++;
    if (first < count && !page_state_count(&result[first]))
        section_rotor(document, &result[first], fit_of_result(&result[first]));
    for (int i = 0; i < count; i++) {
        document->of = other_deck(&result[i], result);
        if (page_state_count(&result[i])) {
            if (result[i].identify)
                section_states(document, &result[i]);
            compose_states(document, &result[i], document->of, i != first);
        } else {
            compose_state(document, &result[i]);
        }
        if (result[i].identify)
            section_fit(document, &result[i]);
        if (result[i].diagnose)
            section_diagnose(document, &result[i]);
        if (result[i].suggest)
            section_suggest(document, &result[i]);
        if (result[i].studied)
            section_study(document, &result[i]);
    }
}
