#include "page/page.h"

#include <string.h>

#include "page/plain.h"
#include "page/sections.h"

/* What a result is, in words, and how much the answer of a page rests on it: of several results that with the least rank gives
 * the page its title, wherever it was given. */
static const struct {
    const char *command, *words;
    int judged; /* it says how far it can be relied on */
} kinds[] = {{"diagnose", "Diagnosis", 1},     {"identify", "Identification", 1},  {"study", "Study", 1},
             {"ema", "Modal analysis", 1},     {"suggest", "Next measurement", 0}, {"modes", "Modes", 0},
             {"frf", "Transfer functions", 0}, {"sensitivity", "Sensitivity", 0},  {"check", "Check", 0}};
#define KINDS (int)(sizeof kinds / sizeof *kinds)

static int rank_of(const struct result *result)
{
    int k = 0;
    while (k < KINDS - 1 && strcmp(kinds[k].command, result->head.command) != 0)
        k++;
    return k;
}

/* "Diagnosis of rotor.inp" */
static const char *words_of(struct pool *pool, const struct result *result)
{
    const char *text = pool_format(pool, "%s of %s", kinds[rank_of(result)].words, page_source(result));
    return text ? text : "";
}

/* The first line of the heading that says something; of a deck without one its name. */
static const char *title_of(const struct result *result)
{
    for (int i = 0; i < result->head.nheading; i++)
        if (result->head.heading[i][strspn(result->head.heading[i], " \t")])
            return result->head.heading[i];
    return page_source(result);
}

/* The names of all results, each once; of more than two decks the first two titles stand over the page. */
static void name_page(struct document *document, int count, const struct result *const by_rank[])
{
    struct pool *pool = document->pool;
    const char *title = "", *subtitle = "";
    int titles = 0;
    for (int i = 0; i < count && title && subtitle; i++) {
        const char *own = title_of(by_rank[i]), *words = words_of(pool, by_rank[i]);
        if (!strstr(subtitle, words))
            subtitle = pool_format(pool, "%s%s%s", subtitle, *subtitle ? "; " : "", words);
        if (strstr(title, own) || (*title && own == page_source(by_rank[i]))) /* a file is no title beside one */
            continue;
        if (titles++ < 2)
            title = pool_format(pool, "%s%s%s", title, *title ? "; " : "", own);
    }
    if (titles > 2 && title)
        title = pool_format(pool, "%s; and %d more", title, titles - 2);
    document->title = title ? plain_text(pool, title) : "";
    document->subtitle = subtitle ? subtitle : "";
}

/* Whether the results are of more than one deck. */
static int several_decks(int count, const struct result *result)
{
    const char *deck = NULL;
    for (int i = 0; i < count; i++) {
        if (deck && result[i].head.deck && strcmp(result[i].head.deck, deck) != 0)
            return 1;
        deck = deck ? deck : result[i].head.deck;
    }
    return 0;
}

static void answer(struct document *document, const struct result *result)
{
    if (result->identify)
        answer_identify(document, result, result->identify);
    else if (result->diagnose)
        answer_diagnose(document, result);
    else if (result->studied)
        answer_study(document, result);
    else if (result->ema)
        answer_ema(document, result);
    else
        answer_plain(document, result);
}

/* The answers of the results that judge; of a page without one those of all. */
static void answer_all(struct document *document, int count, const struct result *const by_rank[], int decks)
{
    int judged = kinds[rank_of(by_rank[0])].judged;
    for (int i = 0; i < count; i++) {
        if (judged && !kinds[rank_of(by_rank[i])].judged)
            continue;
        document->of = decks ? page_source(by_rank[i]) : NULL;
        answer(document, by_rank[i]);
        document_answer(document, count > 1 ? words_of(document->pool, by_rank[i]) : NULL);
    }
    document->of = NULL;
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

/* A result as a page shows it outside its section on provenance: of absolute paths the last part. */
static struct result without_folders(const struct result *result)
{
    struct result own = *result;
    own.head.deck = plain_file(result->head.deck);
    own.file = plain_file(result->file);
    return own;
}

static const struct result **sorted(struct pool *pool, int count, const struct result *result)
{
    const struct result **list = POOL_ARRAY(pool, const struct result *, count);
    for (int i = 0; i < count && list; i++) {
        int k = i;
        for (; k > 0 && rank_of(list[k - 1]) > rank_of(&result[i]); k--)
            list[k] = list[k - 1];
        list[k] = &result[i];
    }
    return list;
}

void page_compose(struct document *document, int count, const struct result *given)
{
    struct result *result = POOL_ARRAY(document->pool, struct result, count);
    int decks = several_decks(count, given);
    for (int i = 0; i < count && result; i++)
        result[i] = without_folders(&given[i]);
    const struct result **by_rank = result ? sorted(document->pool, count, result) : NULL;
    if (!by_rank) {
        document->failed = 1;
        return;
    }
    name_page(document, count, by_rank);
    answer_all(document, count, by_rank, decks);
    section_rests_on(document, count, result);
    int first = 0; /* one picture of the rotor, of each state, does */
    while (first < count && !geometry_of_result(&result[first]))
        first++;
    if (first < count && !page_state_count(&result[first]))
        section_rotor(document, &result[first], fit_of_result(&result[first]));
    for (int i = 0; i < count; i++) {
        document->of = decks ? page_source(&result[i]) : NULL;
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
        if (result[i].ema)
            section_ema(document, &result[i]);
    }
    section_provenance(document, count, given);
}
