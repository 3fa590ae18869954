#include "hammer_file.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "hammer.h"

int hammer_file_open(const char *path, struct hammer_file *file, const struct hide_message *message)
{
    *file = (struct hammer_file){.path = path};
    hide_add(&file->temporary, "%s.new", path);
    if (!file->temporary.failed)
        file->stream = fopen(file->temporary.data, "wb");
    if (file->stream)
        return HAMMER_OK;
    hide_fail(message, HAMMER_FAILURE, "%s: %s", path, strerror(errno));
    free(file->temporary.data);
    return HAMMER_FAILURE;
}

int hammer_file_close(struct hammer_file *file, int failed, const struct hide_message *message)
{
    failed |= ferror(file->stream) != 0;
    failed |= fclose(file->stream) != 0;
    if (!failed)
        failed = rename(file->temporary.data, file->path) != 0;
    if (failed) {
        hide_fail(message, HAMMER_FAILURE, "%s: %s", file->path, strerror(errno));
        remove(file->temporary.data);
    }
    free(file->temporary.data);
    return failed ? HAMMER_FAILURE : HAMMER_OK;
}

int hammer_file_write(const char *path, struct hide_text *text, const struct hide_message *message)
{
    struct hammer_file file;
    int status = text->failed ? hide_fail(message, HAMMER_FAILURE, "no memory for %s", path) : HAMMER_OK;
    if (!status && !(status = hammer_file_open(path, &file, message)))
        status = hammer_file_close(&file, fwrite(text->data, 1, text->length, file.stream) != text->length, message);
    free(text->data);
    return status;
}
