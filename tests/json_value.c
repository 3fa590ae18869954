#include "json_value.h"

#include "support.h"

const cJSON *get(const cJSON *json, const char *key)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(json, key);
    if (!item)
        print_error("no key %s\n", key);
    assert_non_null(item);
    return item;
}

double number_of(const cJSON *json, const char *key)
{
    assert_true(cJSON_IsNumber(get(json, key)));
    return get(json, key)->valuedouble;
}
