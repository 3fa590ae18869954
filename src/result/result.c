#include "result/result.h"

#include <string.h>

#include "result/records.h"
#include "result/record.h"

/* Rows of the parts that results are made of. */
#define PROVENANCE INLINE(struct result, head, 0, provenance_record)
#define HEAD       PROVENANCE, INLINE(struct result, head, 0, deck_record)
#define WARNINGS   TEXTS(struct result, warnings, SINCE_LATER)
#define OWN(M, R)  INLINE(struct result, M, BEHIND_POINTER, R)

static const struct field check_fields[] = {HEAD, OWN(check, check_record), WARNINGS, {0}};
static const struct field modes_fields[] = {HEAD, OWN(modes, spectrum_record), WARNINGS, {0}};
static const struct field identify_fields[] = {
    HEAD, OWN(identify, identification_record), OWN(identify, identification_alone_record), WARNINGS, {0}};
static const struct field diagnose_fields[] = {HEAD, OWN(diagnose, diagnosis_record), WARNINGS, {0}};
static const struct field sensitivity_fields[] = {HEAD, OWN(sensitivity, sensitivity_record), {0}};
static const struct field frf_fields[] = {HEAD, OWN(frf, transfer_record), WARNINGS, {0}};
static const struct field ema_fields[] = {PROVENANCE, OWN(ema, ema_record), WARNINGS, {0}};
static const struct field export_fields[] = {HEAD, OWN(export, export_record), WARNINGS, {0}};
static const struct field study_fields[] = {PROVENANCE, OWN(study, study_record), {0}};

static const struct {
    const char *command;
    struct record record;
} commands[] = {
    {"check", RECORD(struct result, check_fields)},
    {"modes", RECORD(struct result, modes_fields)},
    {"identify", RECORD(struct result, identify_fields)},
    {"diagnose", RECORD(struct result, diagnose_fields)},
    {"sensitivity", RECORD(struct result, sensitivity_fields)},
    {"frf", RECORD(struct result, frf_fields)},
    {"ema", RECORD(struct result, ema_fields)},
    {"export", RECORD(struct result, export_fields)},
    {"study", RECORD(struct result, study_fields)},
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
