#include "study/line_wrong.h"

#include <math.h>
#include <string.h>

enum kind { NUMBER, NUMBER_OR_NULL, TEXT, TEXT_OR_NULL, OBJECT, LIST };

struct rule {
    const char *key;
    enum kind kind;
    const char *wrong;
};

static int is_kind(const cJSON *item, enum kind kind)
{
    switch (kind) {
    case NUMBER:
        return cJSON_IsNumber(item);
    case NUMBER_OR_NULL:
        return cJSON_IsNumber(item) || cJSON_IsNull(item);
    case TEXT:
        return cJSON_IsString(item);
    case TEXT_OR_NULL:
        return cJSON_IsString(item) || cJSON_IsNull(item);
    case OBJECT:
        return cJSON_IsObject(item);
    default:
        return cJSON_IsArray(item);
    }
}

static const char *broken(const cJSON *object, const struct rule *rule)
{
    for (; rule->key; rule++)
        if (!is_kind(cJSON_GetObjectItemCaseSensitive(object, rule->key), rule->kind))
            return rule->wrong;
    return NULL;
}

/* JSON has no infinity, but a number such as 1e999 is read as one. */
static int is_finite(const cJSON *json)
{
    for (; json; json = json->next)
        if ((cJSON_IsNumber(json) && !isfinite(json->valuedouble)) || !is_finite(json->child))
            return 0;
    return 1;
}

/* Of each object of a list. */
static const char *broken_in(const cJSON *line, const char *key, const struct rule *rule)
{
    const cJSON *item;
    const char *wrong = NULL;
    cJSON_ArrayForEach(item, cJSON_GetObjectItemCaseSensitive(line, key)) wrong = wrong ? wrong : broken(item, rule);
    return wrong;
}

const char *line_wrong(const cJSON *json)
{
    static const struct rule always[] = {{"run", NUMBER, "expected an object with a number as run"},
                                         {"cell", OBJECT, "expected an object as cell"},
                                         {"replicate", NUMBER, "expected a number as replicate"},
                                         {"start", NUMBER, "expected a number as start"},
                                         {"status", TEXT, "expected converged, at_bound, not_converged or failed as status"},
                                         {"error", TEXT_OR_NULL, "expected a text or null as error"},
                                         {"seconds", NUMBER, "expected a number as seconds"},
                                         {NULL, NUMBER, NULL}},
                             computed[] = {{"objective", NUMBER_OR_NULL, "expected a number or null as objective"},
                                           {"chi2_per_dof", NUMBER_OR_NULL, "expected a number or null as chi2_per_dof"},
                                           {"evaluations", NUMBER_OR_NULL, "expected a number or null as evaluations"},
                                           {"parameters", LIST, "expected a list as parameters"},
                                           {"modes", LIST, "expected a list as modes"},
                                           {NULL, NUMBER, NULL}},
                             parameter[] = {{"name", TEXT, "expected a text as name of a parameter"},
                                            {"unit", TEXT_OR_NULL, "expected a text or null as unit of a parameter"},
                                            {"value", NUMBER_OR_NULL, "expected a number or null as value of a parameter"},
                                            {"std", NUMBER_OR_NULL, "expected a number or null as std of a parameter"},
                                            {"ci95", LIST, "expected a list as ci95 of a parameter"},
                                            {"truth", NUMBER_OR_NULL, "expected a number or null as truth of a parameter"},
                                            {NULL, NUMBER, NULL}},
                             mode[] = {{"error_percent", NUMBER_OR_NULL, "expected a number or null as error_percent of a mode"},
                                       {NULL, NUMBER, NULL}};
    static const char *const states[] = {"converged", "at_bound", "not_converged", "failed"};
    if (!json)
        return "it is no JSON, expected an object";
    if (!is_finite(json))
        return "a number of it is beyond what a number can be, expected finite ones";
    const char *wrong = broken(json, always);
    if (wrong)
        return wrong;
    const char *state = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(json, "status"));
    size_t i = 0, last = sizeof states / sizeof *states - 1;
    while (i < last && strcmp(state, states[i]) != 0)
        i++;
    if (strcmp(state, states[i]) != 0)
        return always[4].wrong;
    wrong = i == last ? NULL : broken(json, computed);
    if (!wrong && i < last)
        wrong = broken_in(json, "parameters", parameter);
    return wrong || i == last ? wrong : broken_in(json, "modes", mode);
}
