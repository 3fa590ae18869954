#include "page/result.h"

static void read_study(const struct json_place *root, struct result *result)
{
    result->studied = study_read(root);
}

/* A file of results of a study: its first line says what it is. */
static void read_lines(const struct json_place *lines, struct result *result)
{
    struct json_place head = place_first(lines, PLACE_OBJECT);
    if (!head.json || !place_has(&head, "rotid") || !place_has(&head, "studies")) {
        place_wrong(lines, "has a value a line and is no file of results, expected one of rotid study, or one result");
        return;
    }
    result->head = (struct result_head){.command = "study",
                                        .rotid = place_string(&head, "rotid"),
                                        .commit = place_string(&head, "commit"),
                                        .seed = place_number(&head, "seed")};
    if (!lines->reader->status)
        result->studied = study_read_lines(lines);
}

int page_result_read(struct pool *pool, const char *file, struct message_list *messages, struct result *result)
{
    static const struct result_reader study = {read_study, read_lines};
    return result_read(pool, file, messages, &study, result);
}
