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
    for (int i = 0; i < count; i++) { /* one picture of the rotor does */
        if (!geometry_of_result(&result[i]))
            continue;
        section_rotor(document, &result[i], fit_of_result(&result[i]));
        break;
    }
    for (int i = 0; i < count; i++) {
        document->of = other_deck(&result[i], result);
        if (result[i].identify)
            section_identify(document, &result[i]);
        if (result[i].diagnose)
            section_diagnose(document, &result[i]);
        if (result[i].suggest)
            section_suggest(document, &result[i]);
        if (result[i].studied)
            section_study(document, &result[i]);
        if (result[i].modes)
            section_modes(document, &result[i]);
        if (result[i].sensitivity)
            section_sensitivity(document, &result[i]);
        if (result[i].frf)
            section_transfer(document, &result[i]);
    }
}
