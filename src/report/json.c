#include "report/json.h"

#include "report/json_result.h"

char *json_sensitivity(const struct provenance *provenance, const struct job *job, const struct sensitivity *sensitivity)
{
    struct pool pool;
    struct result result = {.sensitivity = sensitivity};
    pool_open(&pool, NULL);
    return json_result(&pool, provenance, job, NULL, &result);
}
