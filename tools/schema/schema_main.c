/* Writes docs/schema: schema FOLDER HEADER ... */
#include <stdio.h>
#include <stdlib.h>

#include "record/record.h"
#include "result/result.h"
#include "schema.h"

static char *read_text(struct pool *pool, const char *path)
{
    FILE *stream = fopen(path, "rb");
    char *text = NULL;
    if (stream && fseek(stream, 0, SEEK_END) == 0) {
        long length = ftell(stream);
        rewind(stream);
        text = POOL_ARRAY(pool, char, length + 1);
        if (text && fread(text, 1, (size_t)length, stream) != (size_t)length)
            text = NULL;
    }
    if (stream)
        (void)fclose(stream);
    return text;
}

static FILE *create(struct pool *pool, const char *folder, const char *name)
{
    char *path = pool_format(pool, "%s/%s.schema.json", folder, name);
    FILE *out = path ? fopen(path, "wb") : NULL;
    if (!out) {
        (void)fprintf(stderr, "schema: cannot write %s\n", path ? path : folder);
        exit(3);
    }
    return out;
}

int main(int argc, char **argv)
{
    struct pool pool;
    int missing = 0;
    FILE *out;
    if (argc < 3) {
        (void)fputs("usage: schema FOLDER HEADER ...\n", stderr);
        return 2;
    }
    pool_open(&pool, NULL);
    struct comments comments = {.pool = &pool};
    for (int i = 2; i < argc; i++) {
        char *text = read_text(&pool, argv[i]);
        if (!text || comments_add(&comments, text)) {
            (void)fprintf(stderr, "schema: cannot read %s\n", argv[i]);
            return 3;
        }
    }
    int failed = 0;
    for (const struct result_kind *kind = result_kinds; kind->command; kind++) {
        out = create(&pool, argv[1], kind->command);
        missing += schema_write(out, kind->command, &kind->record, &comments);
        failed |= fclose(out);
    }
    out = create(&pool, argv[1], "study_line");
    missing += schema_write_lines(out, &study_header_record, &study_run_record, &comments);
    failed |= fclose(out);
    pool_close(&pool);
    return failed ? 3 : missing != 0;
}
