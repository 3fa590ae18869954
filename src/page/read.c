/* What a page is made of: a result of a command, or the file of results of a study. */

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
