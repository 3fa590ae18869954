#include "folder.h"

#include <unistd.h>

#include "support.h"

#define NAMES 64
#define LONG  64
#define PATHS 16

char folder[] = "/tmp/rotid_folder_XXXXXX";
static char known[NAMES][LONG];
static int names;

int folder_make(void **state)
{
    (void)state;
    return mkdtemp(folder) == NULL;
}

int folder_remove(void **state)
{
    (void)state;
    for (int i = 0; i < names; i++)
        (void)remove(folder_path(known[i]));
    if (!rmdir(folder))
        return 0;
    print_error("somebody left something in %s\n", folder);
    return 1;
}

const char *folder_path(const char *name)
{
    static char path[PATHS][512];
    static int next;
    int i = 0;
    while (i < names && strcmp(known[i], name) != 0)
        i++;
    if (i == names) {
        assert_true(names < NAMES && strlen(name) < LONG);
        (void)strcpy(known[names++], name);
    }
    next = (next + 1) % PATHS;
    (void)snprintf(path[next], sizeof path[next], "%s/%s", folder, name);
    return path[next];
}

const char *folder_write(const char *name, const char *text)
{
    const char *path = folder_path(name);
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    assert_true(fputs(text, stream) >= 0 && fclose(stream) == 0);
    return path;
}

char *file_bytes(const char *path, size_t *length)
{
    FILE *stream = fopen(path, "rb");
    if (!stream)
        return NULL;
    assert_int_equal(fseek(stream, 0, SEEK_END), 0);
    size_t bytes = (size_t)ftell(stream);
    rewind(stream);
    char *text = calloc(bytes + 1, 1);
    assert_non_null(text);
    assert_int_equal(fread(text, 1, bytes, stream), bytes);
    (void)fclose(stream);
    if (length)
        *length = bytes;
    return text;
}
