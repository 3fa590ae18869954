#include "schema.h"

#include <string.h>

#define RECORDS_MOST 64

struct schema {
    FILE *out;
    const char *command;
    const struct comments *comments;
    int nrecord; /* that are referred to */
    const struct record *record[RECORDS_MOST];
    int missing;
};

/* The name of a struct without what all of them begin with. */
static const char *short_name(const char *name)
{
    name = strncmp(name, "struct ", 7) ? name : name + 7;
    return strncmp(name, "rotid_", 6) ? name : name + 6;
}

static void put_text(FILE *out, const char *text)
{
    (void)fputc('"', out);
    for (; *text; text++)
        (void)fprintf(out, *text == '"' || *text == '\\' ? "\\%c" : "%c", *text);
    (void)fputc('"', out);
}

static void refer(struct schema *schema, const struct record *record)
{
    for (int i = 0; i < schema->nrecord; i++)
        if (schema->record[i] == record)
            return;
    if (schema->nrecord < RECORDS_MOST)
        schema->record[schema->nrecord++] = record;
}

static void put_range(FILE *out, unsigned bits)
{
    static const struct {
        unsigned bit;
        const char *text;
    } ranges[] = {
        {ABOVE_0, ", \"exclusiveMinimum\": 0"},
        {FROM_0, ", \"minimum\": 0"},
        {FROM_1, ", \"minimum\": 1"},
        {PROBABILITY, ", \"minimum\": 0, \"maximum\": 1"},
        {CORRELATION, ", \"minimum\": 0, \"maximum\": 1.0000001"},
    };
    for (size_t i = 0; i < sizeof ranges / sizeof *ranges; i++)
        if (bits & ranges[i].bit)
            (void)fputs(ranges[i].text, out);
}

/* All but the bracket at the end. */
static void put_words(FILE *out, const char *const *words)
{
    (void)fputc('[', out);
    for (int i = 0; words[i]; i++) {
        (void)fputs(i ? ", " : "", out);
        put_text(out, words[i]);
    }
}

static void put_counts(FILE *out, const struct record_field *field, int null)
{
    (void)fprintf(out, "\"type\": %s, \"properties\": {", null ? "[\"object\", \"null\"]" : "\"object\"");
    for (int i = 0; field->words[i]; i++)
        (void)fprintf(out, "%s\"%s\": {\"type\": \"integer\", \"minimum\": 0}", i ? ", " : "", field->words[i]);
    (void)fputs("}, \"required\": ", out);
    put_words(out, field->words);
    (void)fputs("], \"additionalProperties\": false", out);
}

/* What one value is; null: it may be that. */
static void put_value(struct schema *schema, const struct record_field *field, int null)
{
    static const char *const types[] = {
        [FIELD_NUMBER] = "number", [FIELD_INTEGER] = "integer", [FIELD_FLAG] = "boolean", [FIELD_TEXT] = "string",
        [FIELD_CHARS] = "string",  [FIELD_NAME] = "string",     [FIELD_WORD] = "string",  [FIELD_MAP] = "object"};
    const char *type = field->bits & WHOLE ? "integer" : field->kind <= FIELD_MAP ? types[field->kind] : "";
    FILE *out = schema->out;
    if (field->kind == FIELD_RECORD) {
        refer(schema, field->record);
        (void)fprintf(out, null ? "\"anyOf\": [{\"$ref\": \"#/$defs/%s\"}, {\"type\": \"null\"}]" : "\"$ref\": \"#/$defs/%s\"",
                      short_name(field->record->name));
    } else if (field->kind == FIELD_COUNTS) {
        put_counts(out, field, null);
    } else if (field->kind == FIELD_WORDS) {
        (void)fputs("\"type\": \"array\", \"uniqueItems\": true, \"items\": {\"enum\": ", out);
        put_words(out, field->words);
        (void)fputs("]}", out);
    } else if (field->words) {
        (void)fputs("\"enum\": ", out);
        put_words(out, field->words);
        (void)fputs(null ? ", null]" : "]", out);
    } else {
        (void)fprintf(out, null ? "\"type\": [\"%s\", \"null\"]" : "\"type\": \"%s\"", type);
        put_range(out, field->bits);
    }
    if (field->kind == FIELD_MAP)
        (void)fputs(", \"additionalProperties\": {\"type\": \"number\"}", out);
}

static void put_list(struct schema *schema, const struct record_field *field)
{
    FILE *out = schema->out;
    int null = field->bits & ELEMENTS_MAY_BE_NULL || field->shape == SHAPE_FIXED;
    (void)fputs(field->bits & MAY_BE_NULL ? "\"type\": [\"array\", \"null\"]" : "\"type\": \"array\"", out);
    (void)fputs(field->shape == SHAPE_MATRIX ? ", \"items\": {\"type\": \"array\", \"items\": {" : ", \"items\": {", out);
    put_value(schema, field, null);
    (void)fputs(field->shape == SHAPE_MATRIX ? "}}" : "}", out);
    if (field->bits & NOT_EMPTY)
        (void)fputs(", \"minItems\": 1", out);
    if (field->shape == SHAPE_FIXED)
        (void)fprintf(out, ", \"minItems\": %d, \"maxItems\": %d", field->fixed, field->fixed);
}

static void put_field(struct schema *schema, const struct record *record, const struct record_field *field, int *count)
{
    const char *about =
        comments_find(schema->comments, strncmp(record->name, "struct ", 7) ? record->name : record->name + 7, field->key);
    FILE *out = schema->out;
    (void)fprintf(out, "%s\n    ", (*count)++ ? "," : "");
    put_text(out, field->key);
    (void)fputs(": {", out);
    if (!strcmp(field->key, "command"))
        (void)fprintf(out, "\"const\": \"%s\"", schema->command);
    else if (field->shape == SHAPE_ONE)
        put_value(schema, field, field->bits & MAY_BE_NULL);
    else
        put_list(schema, field);
    if (about) {
        (void)fputs(", \"description\": ", out);
        put_text(out, about);
    } else if (field->kind != FIELD_RECORD) {
        (void)fprintf(stderr, "%s.%s has no comment\n", record->name, field->key);
        schema->missing++;
    }
    (void)fputc('}', out);
}

static void put_fields(struct schema *schema, const struct record *record, int *count)
{
    for (const struct record_field *field = record->field; field->key; field++)
        if (field->kind == FIELD_INLINE)
            put_fields(schema, field->record, count);
        else if (field->kind != FIELD_COUNT)
            put_field(schema, record, field, count);
}

static void put_required(FILE *out, const struct record *record, int *count, int optional)
{
    for (const struct record_field *field = record->field; field->key; field++)
        if (field->kind == FIELD_INLINE) {
            put_required(out, field->record, count, optional || field->bits & IF_KNOWN);
        } else if (!optional && !(field->bits & IF_KNOWN) && field->kind != FIELD_COUNT) {
            (void)fputs((*count)++ ? ", " : "", out);
            put_text(out, field->key);
        }
}

/* Keys that stand together: the first one with all others, each of them with the first. */
static void put_groups(FILE *out, const struct record *record, int *count)
{
    for (const struct record_field *field = record->field; field->key; field++) {
        if (field->kind != FIELD_INLINE)
            continue;
        if (!(field->bits & IF_KNOWN)) {
            put_groups(out, field->record, count);
            continue;
        }
        const struct record *group = field->record;
        const char *first = group->field->kind == FIELD_INLINE ? group->field->record->field->key : group->field->key;
        int others = 0;
        (void)fprintf(out, "%s\"%s\": [", (*count)++ ? ", " : ", \"dependentRequired\": {", first);
        put_required(out, group, &others, 0);
        (void)fputc(']', out);
        for (const struct record_field *other = group->field; other->key; other++)
            if (other->kind != FIELD_INLINE && other->kind != FIELD_COUNT && strcmp(other->key, first) != 0)
                (void)fprintf(out, ", \"%s\": [\"%s\"]", other->key, first);
    }
}

static void put_object(struct schema *schema, const struct record *record)
{
    int fields = 0, required = 0, groups = 0;
    (void)fputs("\"properties\": {", schema->out);
    put_fields(schema, record, &fields);
    (void)fputs("\n  }, \"required\": [", schema->out);
    put_required(schema->out, record, &required, 0);
    (void)fputs("]", schema->out);
    put_groups(schema->out, record, &groups);
    (void)fputs(groups ? "}, \"additionalProperties\": false" : ", \"additionalProperties\": false", schema->out);
}

static void put_definitions(struct schema *schema)
{
    (void)fputs(",\n  \"$defs\": {", schema->out);
    for (int i = 0; i < schema->nrecord; i++) { /* grows */
        const char *name = schema->record[i]->name,
                   *about = comments_find(schema->comments, strncmp(name, "struct ", 7) ? name : name + 7, NULL);
        (void)fprintf(schema->out, "%s\n  \"%s\": {\"type\": \"object\", ", i ? "," : "", short_name(name));
        if (about) {
            (void)fputs("\"description\": ", schema->out);
            put_text(schema->out, about);
            (void)fputs(", ", schema->out);
        }
        put_object(schema, schema->record[i]);
        (void)fputc('}', schema->out);
    }
    (void)fputs("}\n}\n", schema->out);
}

int schema_write(FILE *out, const char *command, const struct record *record, const struct comments *comments)
{
    struct schema schema = {.out = out, .command = command, .comments = comments};
    (void)fprintf(out,
                  "{\n  \"$schema\": \"https://json-schema.org/draft/2020-12/schema\",\n  \"title\": \"rotid %s\",\n"
                  "  \"description\": \"Result of rotid %s. Units are SI; a key ends in its unit where it has one.\",\n"
                  "  \"type\": \"object\",\n  ",
                  command, command);
    put_object(&schema, record);
    put_definitions(&schema);
    return schema.missing;
}

int schema_write_lines(FILE *out, const struct record *first, const struct record *other, const struct comments *comments)
{
    struct schema schema = {.out = out, .command = "study", .comments = comments};
    refer(&schema, first);
    refer(&schema, other);
    (void)fprintf(
        out,
        "{\n  \"$schema\": \"https://json-schema.org/draft/2020-12/schema\",\n  \"title\": \"rotid study, lines\",\n"
        "  \"description\": \"A line of a file of results of rotid study: the first is a header, each other one a run. Units "
        "are SI; a key ends in its unit where it has one.\",\n"
        "  \"oneOf\": [{\"$ref\": \"#/$defs/%s\"}, {\"$ref\": \"#/$defs/%s\"}]",
        short_name(first->name), short_name(other->name));
    put_definitions(&schema);
    return schema.missing;
}
