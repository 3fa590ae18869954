/* What a page is made of: a result of a command, or the file of results of a study; and what a state has of it. */
#include <string.h>

#include "page/page.h"
#include "study/study.h"

/* A file of results of a study: its first line says what it is. */
static void read_lines(const struct json_place *lines, struct result *result)
{
    struct reader *reader = lines->reader;
    struct json_place head = place_first(lines, PLACE_OBJECT);
    struct study_result *study = POOL_NEW(reader->pool, struct study_result);
    struct study_header header;
    if (!head.json || !place_has(&head, "rotid") || !place_has(&head, "studies")) {
        place_wrong(lines, "has a value a line and is no file of results, expected one of rotid study, or one result");
        return;
    }
    int status = study ? summary_read(reader->pool, reader->file, reader->messages, &header, NULL, study) : ROTID_ERROR_MEMORY;
    if (status)
        reader->status = status == ROTID_ERROR_MEMORY ? status : ROTID_ERROR_SYNTAX;
    else
        result->head = (struct result_head){.schema = RESULT_SCHEMA,
                                            .command = "study",
                                            .rotid = header.rotid,
                                            .commit = header.commit,
                                            .seed = header.seed,
                                            .blas = ""};
    result->study = study;
}

int page_result_read(struct pool *pool, const char *file, struct message_list *messages, struct result *result)
{
    return result_read(pool, file, messages, read_lines, result);
}

const char *page_source(const struct result *result)
{
    return plain_file(result->ema                               ? result->ema->source.file
                      : result->head.deck && *result->head.deck ? result->head.deck
                                                                : result->file);
}

int page_state_count(const struct result *result)
{
    return result->identify ? result->identify->nstates : result->nstates;
}

const char *page_state_name(const struct result *result, int s)
{
    return result->identify ? result->identify->states[s].name : result->states[s].name;
}

/* References go over the modes of all states. */
static void take_references(struct pool *pool, struct result_head *head, int first)
{
    rotid_reference *reference = POOL_ARRAY(pool, rotid_reference, head->nreferences);
    for (int i = 0; i < head->nreferences && reference; i++) {
        int skip = first < head->references[i].nvalues ? first : head->references[i].nvalues;
        reference[i] = head->references[i];
        reference[i].values += skip;
        reference[i].nvalues -= skip;
    }
    head->nreferences = reference ? head->nreferences : 0;
    head->references = reference;
}

struct result page_result_of_state(struct pool *pool, const struct result *result, int s)
{
    struct result own = *result;
    int first = 0;
    if (!result->identify)
        return result_of_state(result, s);
    for (int t = 0; t < s; t++)
        first += result->identify->states[t].nmodes;
    own.nstates = 0;
    own.states = NULL;
    take_references(pool, &own.head, first);
    if ((own.identify = POOL_NEW(pool, rotid_identification)))
        *own.identify = fit_of_state(pool, result->identify, s);
    return own;
}
