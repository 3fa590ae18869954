#include "page/page.h"

#include <string.h>

#include "page/human.h"
#include "page/sections.h"

static const char *subtitle(struct pool *pool, const struct result *result)
{
    const char *text = pool_format(pool, "rotid %s %s, version %s (%s)", result->command,
                                   result->deck ? result->deck : result->file, result->version, result->commit);
    return text ? text : "";
}

/* The first line of the heading that says something; of a deck without one its name. */
static const char *title(const struct result *result)
{
    for (int i = 0; i < result->nheading; i++)
        if (result->heading[i][strspn(result->heading[i], " \t")])
            return result->heading[i];
    return result->deck && *result->deck ? result->deck : result->file;
}

/* The deck of a further result where it is another one than that of the page, NULL where it is not. */
static const char *other_deck(const struct result *result, const struct result *main_result)
{
    const char *name;
    if (!result->deck || !main_result->deck || !strcmp(result->deck, main_result->deck))
        return NULL;
    name = strrchr(result->deck, '/');
    return name ? name + 1 : result->deck;
}

void page_compose(struct document *document, int count, const struct result *result)
{
    document->title = title(result);
    document->subtitle = subtitle(document->pool, result);
    if (result->identify)
        answer_identify(document, result, result->identify);
    else if (result->diagnosis)
        answer_diagnose(document, result);
    else if (result->study)
        answer_study(document, result);
    else
        answer_plain(document, result);
    section_rests_on(document, count, result);
    for (int i = 0; i < count; i++) { /* one picture of the rotor does */
        if (!result[i].geometry)
            continue;
        section_rotor(document, &result[i], result_fit(&result[i]));
        break;
    }
    for (int i = 0; i < count; i++) {
        document->of = other_deck(&result[i], result);
        if (result[i].identify)
            section_identify(document, &result[i]);
        if (result[i].diagnosis)
            section_diagnose(document, &result[i]);
        if (result[i].study)
            section_study(document, &result[i]);
        if (result[i].modes)
            section_modes(document, &result[i]);
        if (result[i].sensitivity)
            section_sensitivity(document, &result[i]);
        if (result[i].frf)
            section_transfer(document, &result[i]);
    }
}
