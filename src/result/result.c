#include "result/result.h"

#include <string.h>

#include "result/records.h"

#define HEAD     INLINE(struct result, head, 0, head_record)
#define WARNINGS TEXTS(struct result, warnings, SINCE_LATER)

static const struct field check_fields[] = {
    HEAD,
    INLINE(struct result, check, BEHIND_POINTER, check_record),
    WARNINGS,
    {0},
};
static const struct field modes_fields[] = {
    HEAD,
    INLINE(struct result, modes, BEHIND_POINTER, spectrum_record),
    WARNINGS,
    {0},
};
static const struct field identify_fields[] = {
    HEAD,
    INLINE(struct result, identify, BEHIND_POINTER, identification_record),
    INLINE(struct result, identify, BEHIND_POINTER, identification_alone_record),
    WARNINGS,
    {0},
};
static const struct field diagnose_fields[] = {
    HEAD,
    INLINE(struct result, diagnose, BEHIND_POINTER, diagnosis_record),
    WARNINGS,
    {0},
};

static const struct field head_alone_fields[] = {HEAD, WARNINGS, {0}};
const struct record head_alone_record = RECORD(struct result, head_alone_fields);

static const struct {
    const char *command;
    struct record record;
} commands[] = {
    {"check", RECORD(struct result, check_fields)},
    {"modes", RECORD(struct result, modes_fields)},
    {"identify", RECORD(struct result, identify_fields)},
    {"diagnose", RECORD(struct result, diagnose_fields)},
};
#define COMMANDS (sizeof commands / sizeof *commands)

const char *result_command(int i)
{
    return (size_t)i < COMMANDS ? commands[i].command : NULL;
}

const struct record *result_record(const char *command)
{
    for (size_t i = 0; i < COMMANDS; i++)
        if (!strcmp(commands[i].command, command))
            return &commands[i].record;
    return NULL;
}

char *result_json(const struct result *result)
{
    struct json_tree tree;
    json_open(&tree);
    record_write(&tree, tree.root, result_record(result->head.command), result);
    return json_close(&tree);
}

const rotid_geometry *geometry_of_result(const struct result *result)
{
    return result->identify   ? result->identify->geometry
           : result->diagnose ? result->diagnose->geometry
           : result->modes    ? result->modes->geometry
           : result->check    ? result->check->geometry
                              : NULL;
}

const rotid_identification *fit_of_result(const struct result *result)
{
    return result->diagnose ? result->diagnose->base : result->identify;
}

const rotid_noise *noise_of_result(const struct result *result)
{
    return result->diagnose ? &result->diagnose->noise : result->identify ? result->identify->noise : NULL;
}
