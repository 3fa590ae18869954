#include "json_deck.h"

#include "api/api.h"
#include "result/result.h"
#include "support.h"

void json_deck_open(struct json_deck *deck, const char *text)
{
    *deck = (struct json_deck){0};
    pool_open(&deck->pool, NULL);
    int status = rotid_deck_read_text(strlen(text), text, NULL, NULL, 0, NULL, NULL, NULL, &deck->read);
    for (int i = 0; status && i < deck->read->nmessage; i++)
        print_error("%d:%d: %s\n", deck->read->message[i].line, deck->read->message[i].column, deck->read->message[i].text);
    assert_status(status, ROTID_OK);
    deck->job = deck_job_of(deck->read);
}

void json_deck_close(struct json_deck *deck)
{
    rotid_identification_free(deck->result);
    rotid_deck_free(deck->read);
    pool_close(&deck->pool);
}

static struct result result_of(const struct json_deck *deck, const char *command)
{
    const rotid_deck *read = deck->read;
    return (struct result){.head = {.schema = RESULT_SCHEMA,
                                    .rotid = "0",
                                    .commit = "none",
                                    .blas = "a BLAS",
                                    .seed = 1,
                                    .threads = 1,
                                    .command = command,
                                    .deck = read->path,
                                    .nheading = read->nheading,
                                    .heading = read->heading,
                                    .nreferences = read->nreferences,
                                    .references = read->references}};
}

static cJSON *parsed(char *text)
{
    assert_non_null(text);
    cJSON *json = cJSON_ParseWithOpts(text, NULL, 1);
    free(text);
    assert_true(cJSON_IsObject(json));
    return json;
}

cJSON *json_deck_check(struct json_deck *deck)
{
    struct result result = result_of(deck, "check");
    assert_status(rotid_deck_check(deck->read, NULL, NULL, &result.check), ROTID_OK);
    cJSON *json = parsed(result_json(&result));
    rotid_check_free(result.check);
    return json;
}

char *json_deck_text(const struct json_deck *deck)
{
    struct result result = result_of(deck, "identify");
    result.identify = deck->result;
    return result_json(&result);
}

cJSON *json_deck_identify(struct json_deck *deck, int baseline)
{
    assert_status(rotid_identify(deck->read, baseline, NULL, NULL, &deck->result), ROTID_OK);
    return parsed(json_deck_text(deck));
}

const cJSON *json_member(const cJSON *object, const char *list, int at)
{
    const cJSON *item = cJSON_GetArrayItem(get(object, list), at);
    assert_non_null(item);
    return item;
}

void json_numbers(const cJSON *array, int count, double *value)
{
    assert_true(cJSON_IsArray(array));
    assert_int_equal(cJSON_GetArraySize(array), count);
    const cJSON *item = array->child;
    for (int i = 0; i < count; i++, item = item->next) {
        assert_true(cJSON_IsNumber(item) || cJSON_IsNull(item));
        value[i] = cJSON_IsNull(item) ? (double)NAN : item->valuedouble;
    }
}
