#include "json_deck.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "deck/deck.h"
#include "report/json.h"
#include "support.h"

static const struct provenance provenance = {"test", "0", "none", "a BLAS", 1, 1};

void json_deck_open(struct json_deck *deck, const char *text)
{
    char path[] = "/tmp/json_deck_XXXXXX";
    int file = mkstemp(path);
    size_t length = strlen(text);
    assert_true(file >= 0 && write(file, text, length) == (ssize_t)length && close(file) == 0);
    *deck = (struct json_deck){0};
    pool_open(&deck->pool, NULL);
    message_open(&deck->messages, &deck->pool);
    int status = deck_read(&deck->pool, path, 0, NULL, &deck->messages, &deck->job);
    for (size_t i = 0; i < deck->messages.count && status; i++)
        print_error("%d:%d: %s\n", deck->messages.item[i].line, deck->messages.item[i].column, deck->messages.item[i].text);
    (void)unlink(path);
    assert_status(status, ROTID_OK);
}

void json_deck_close(struct json_deck *deck)
{
    rotid_fit_free(deck->result.fit);
    pool_close(&deck->pool);
}

static cJSON *parsed(char *text)
{
    assert_non_null(text);
    cJSON *json = cJSON_ParseWithOpts(text, NULL, 1);
    json_free(text);
    assert_true(cJSON_IsObject(json));
    return json;
}

cJSON *json_deck_check(struct json_deck *deck)
{
    struct spectrum spectrum;
    struct mass_properties mass;
    assert_status(spectrum_compute(&deck->pool, NULL, &deck->job.rotor, 0, NULL, NULL, ROTID_GUYAN, 1, &spectrum), ROTID_OK);
    model_mass_properties(spectrum.model, &mass);
    return parsed(json_check(&provenance, &deck->job, &mass, &spectrum, &deck->messages));
}

cJSON *json_deck_identify(struct json_deck *deck, int baseline)
{
    assert_status(identify_run(&deck->pool, &deck->job, baseline, NULL, &deck->messages, &deck->result), ROTID_OK);
    return parsed(json_identify(&provenance, &deck->job, &deck->result, &deck->messages));
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
