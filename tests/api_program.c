#include "api_program.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>

#include "support.h"

#ifndef ROTID_PROGRAM
#define ROTID_PROGRAM "rotid"
#endif

cJSON *program_json(const char *arguments)
{
    char command[1024];
    size_t room = 4u << 20;
    char *text = calloc(room, 1);
    assert_non_null(text);
    (void)snprintf(command, sizeof command, "'%s' %s --quiet --json -", ROTID_PROGRAM, arguments);
    FILE *stream = popen(command, "r");
    assert_non_null(stream);
    size_t length = fread(text, 1, room - 1, stream);
    assert_true(length > 0 && length < room - 1);
    int status = pclose(stream), code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    assert_true(code == 0 || code == 1);
    cJSON *json = cJSON_Parse(text);
    assert_non_null(json);
    free(text);
    return json;
}

void assert_json_number(const cJSON *json, const char *key, double value)
{
    const cJSON *item = get(json, key);
    if (cJSON_IsNull(item))
        assert_true(!isfinite(value));
    else
        assert_close(value, item->valuedouble, 1e-14, 0);
}

void assert_json_text(const cJSON *json, const char *key, const char *text)
{
    const cJSON *item = get(json, key);
    if (cJSON_IsNull(item))
        assert_null(text);
    else
        assert_string_equal(text, item->valuestring);
}
