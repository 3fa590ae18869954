#include "plotted.h"

#include "json_value.h"
#include "support.h"

/* The column of a series in the comment over the data, from 0; -1: none. */
static int column_of(const char *from, const char *to, const char *series)
{
    char line[256];
    for (int column = 1; column < 100; column++) {
        (void)snprintf(line, sizeof line, "\n#   %d %s\n", column, series);
        const char *at = strstr(from, line);
        if (at && at < to)
            return column - 1;
    }
    return -1;
}

int plotted(const char *script, const char *block, const char *series, double value[PLOTTED_MOST])
{
    char name[128];
    (void)snprintf(name, sizeof name, "# columns of $%s\n", block);
    const char *from = strstr(script, name);
    (void)snprintf(name, sizeof name, "\n$%s << end\n", block);
    const char *data = strstr(script, name);
    int column = from && data ? column_of(from, data + 1, series) : -1, rows = 0;
    if (column < 0)
        return -1;
    data += strlen(name);
    for (; strncmp(data, "end\n", 4) != 0; data = strchr(data, '\n') + 1) {
        char *at = (char *)(size_t)data;
        double number = NAN;
        for (int c = 0; c <= column; c++)
            number = strtod(at, &at);
        assert_true(rows < PLOTTED_MOST);
        value[rows++] = number;
    }
    return rows;
}

static void collect(const cJSON *at, const char *path, double value[PLOTTED_MOST], int *count)
{
    char key[64] = "";
    if (*path == '[') {
        const char *behind = strchr(path, ']') + 1;
        const cJSON *item;
        assert_true(cJSON_IsArray(at));
        if (path[1] != ']') {
            collect(cJSON_GetArrayItem(at, (int)strtol(path + 1, NULL, 10)), behind, value, count);
            return;
        }
        cJSON_ArrayForEach(item, at) collect(item, behind, value, count);
        return;
    }
    if (*path == '.')
        path++;
    if (!*path) {
        assert_true(at && (cJSON_IsNumber(at) || cJSON_IsNull(at)) && *count < PLOTTED_MOST);
        value[(*count)++] = cJSON_IsNumber(at) ? at->valuedouble : (double)NAN;
        return;
    }
    size_t length = strcspn(path, ".[");
    assert_true(length < sizeof key);
    memcpy(key, path, length);
    collect(get(at, key), path + length, value, count);
}

int numbers_at(const cJSON *json, const char *path, double value[PLOTTED_MOST])
{
    int count = 0;
    collect(json, path, value, &count);
    return count;
}
