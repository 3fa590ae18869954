/* Writes docs/schema: schema DIR HEADER ... */
#include <stdio.h>
#include <stdlib.h>

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

int main(int argc, char **argv)
{
    struct pool pool;
    int missing = 0;
    pool_open(&pool, NULL);
    struct comments comments = {.pool = &pool};
    for (int i = 2; i < argc; i++) {
        char *text = read_text(&pool, argv[i]);
        if (!text || comments_add(&comments, text)) {
            (void)fprintf(stderr, "schema: cannot read %s\n", argv[i]);
            return 3;
        }
    }
    for (int i = 0; argc > 1 && result_command(i); i++) {
        char *path = pool_format(&pool, "%s/%s.schema.json", argv[1], result_command(i));
        FILE *out = path ? fopen(path, "wb") : NULL;
        if (out)
            missing += schema_write(out, result_command(i), result_record(result_command(i)), &comments);
        if (!out || fclose(out) != 0) {
            (void)fprintf(stderr, "schema: cannot write %s\n", path ? path : argv[1]);
            return 3;
        }
    }
    pool_close(&pool);
    return missing != 0;
}
