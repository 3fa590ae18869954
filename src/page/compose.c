/* A page of one or more results: its name, the answers, the sections in the order in which they are read. */
#include <string.h>

#include "page/page.h"

/* What a result is, in words, and how much the answer of a page rests on it: of several results that with the least rank gives
 * the page its title, wherever it was given. */
typedef void page_part(struct document *document, const struct result *result);
static const struct kind {
    const char *command, *words;
    int judged;                     /* it says how far it can be relied on */
    page_part *answer, *body, *end; /* NULL: none; end: behind the parts of the states */
    page_part *state;               /* what each state has, or a deck that is one */
} kinds[] = {{"diagnose", "Diagnosis", 1, answer_diagnose, section_diagnose, NULL, NULL},
             {"identify", "Identification", 1, answer_identify, NULL, section_identify, section_agreement},
             {"study", "Study", 1, answer_study, section_study, NULL, NULL},
             {"ema", "Modal analysis", 1, answer_ema, section_ema, NULL, NULL},
             {"suggest", "Next measurement", 0, answer_plain, section_suggest, NULL, NULL},
             {"modes", "Modes", 0, answer_plain, NULL, NULL, section_modes},
             {"speeds", "Critical speeds", 0, answer_plain, section_speeds, NULL, NULL},
             {"frf", "Transfer functions", 0, answer_plain, NULL, NULL, section_transfer},
             {"sensitivity", "Sensitivity", 0, answer_plain, NULL, NULL, section_sensitivity},
             {"check", "Check", 0, answer_plain, NULL, NULL, NULL}};
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

static void add(struct document *document, page_part *part, const struct result *result)
{
    if (part)
        part(document, result);
}

/* The answers of the results that judge; of a page without one those of all. */
static void answer_all(struct document *document, int count, const struct result *const by_rank[], int decks)
{
    int judged = kinds[rank_of(by_rank[0])].judged;
    for (int i = 0; i < count; i++) {
        if (judged && !kinds[rank_of(by_rank[i])].judged)
            continue;
        document->of = decks ? page_source(by_rank[i]) : NULL;
        add(document, kinds[rank_of(by_rank[i])].answer, by_rank[i]);
        document_answer(document, count > 1 ? words_of(document->pool, by_rank[i]) : NULL);
    }
    document->of = NULL;
}

static void compose_rotor(struct document *document)
{
    document_section(document, "model", "The rotor");
    document_figures(document, "rotor");
}

/* of: the deck where it is not that of the page, or NULL; drawn: the rotors are on the page already */
static void compose_states(struct document *document, const struct result *result, const char *of, int drawn)
{
    for (int s = 0; s < page_state_count(result) && !document->failed; s++) {
        const struct result own = page_result_of_state(document->pool, result, s);
        document->of = pool_format(document->pool, "%s%sstate %s", of ? of : "", of ? ", " : "", page_state_name(result, s));
        document->failed |= !document->of || document->pool->out_of_memory; /* then the state has no result */
        document->state = s;
        if (document->failed)
            break;
        if (!drawn && !result->identify && !result->modes && geometry_of_result(&own))
            compose_rotor(document);
        add(document, kinds[rank_of(result)].state, &own);
    }
    document->of = of;
    document->state = -1;
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

static void compose_result(struct document *document, const struct result *result, int drawn)
{
    const struct kind *kind = &kinds[rank_of(result)];
    add(document, kind->body, result);
    if (page_state_count(result))
        compose_states(document, result, document->of, drawn);
    else
        add(document, kind->state, result);
    add(document, kind->end, result);
}

void page_compose(struct document *document, int count, const struct result *given)
{
    struct result *result = POOL_ARRAY(document->pool, struct result, count);
    int decks = several_decks(count, given);
    for (int i = 0; i < count && result; i++) {
        result[i] = without_folders(&given[i]);
        human_units_of(&result[i].head);
    }
    const struct result **by_rank = result ? sorted(document->pool, count, result) : NULL;
    if (!by_rank) {
        document->failed = 1;
        return;
    }
    name_page(document, count, by_rank);
    answer_all(document, count, by_rank, decks);
    int drawn = 0; /* one picture of the rotor, of each state, does: shapes in motion show it as well */
    for (int i = 0; i < count; i++)
        drawn |= result[i].identify || result[i].diagnose || result[i].modes;
    for (int i = 0; i < count; i++) {
        document->of = decks ? page_source(&result[i]) : NULL;
        document->result = i;
        if (!drawn && geometry_of_result(&result[i]) && !page_state_count(&result[i])) {
            compose_rotor(document);
            drawn = 1;
        }
        compose_result(document, &result[i], drawn);
    }
    section_basis(document, count, result);
    section_provenance(document, count, given);
}
