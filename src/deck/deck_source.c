#include "deck/deck_source.h"

#include <errno.h>

#include "file/open.h"

int deck_source_open(struct deck_source *source, const char *path)
{
    *source = (struct deck_source){.text = NULL};
    source->stream = file_open(path, 0, &source->information);
    return source->stream ? 0 : errno;
}

void deck_source_open_memory(struct deck_source *source, const struct deck_memory *memory)
{
    *source = (struct deck_source){.text = memory->text, .left = memory->length};
}

long long deck_source_length(const struct deck_source *source)
{
    if (!source->stream)
        return source->left <= (size_t)1 << 62 ? (long long)source->left : 1LL << 62;
    return S_ISREG(source->information.st_mode) ? (long long)source->information.st_size : -1;
}

int deck_source_next(struct deck_source *source)
{
    if (source->stream) {
        int c = getc(source->stream);
        return c == EOF ? DECK_SOURCE_END : c;
    }
    return source->left ? (source->left--, (unsigned char)*source->text++) : DECK_SOURCE_END;
}

int deck_source_close(struct deck_source *source)
{
    int number = source->stream && ferror(source->stream) ? errno : 0;
    if (source->stream)
        (void)fclose(source->stream);
    return number;
}
