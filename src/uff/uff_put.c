#include "uff/uff_put.h"

#include <math.h>
#include <string.h>

#include "rotid.h"
#include "uff/uff_data.h"

static void fail(struct uff_put *put)
{
    if (put->status == ROTID_OK)
        put->status = ROTID_ERROR_ARGUMENT;
}

static void add(struct uff_put *put, int width, const char *cell, int length)
{
    if (put->status != ROTID_OK || length < 0 || length > width || put->length + (size_t)width > UFF_PUT_LIMIT) {
        fail(put);
        return;
    }
    memset(put->line + put->length, ' ', (size_t)(width - length));
    memcpy(put->line + put->length + (width - length), cell, (size_t)length);
    put->length += (size_t)width;
}

void uff_put_integer(struct uff_put *put, int width, long long value)
{
    char cell[32];
    add(put, width, cell, snprintf(cell, sizeof cell, "%lld", value));
}

void uff_put_real(struct uff_put *put, int width, int decimals, double value)
{
    char cell[64];
    if (isfinite(value))
        add(put, width, cell, snprintf(cell, sizeof cell, "%.*E", decimals, value));
    else
        fail(put);
}

void uff_put_text(struct uff_put *put, int width, const char *text, const char *fallback)
{
    const char *shown = *text ? text : fallback;
    size_t length = strlen(shown);
    if (put->status != ROTID_OK || length > (size_t)width || put->length + (size_t)width > UFF_PUT_LIMIT) {
        fail(put);
        return;
    }
    for (size_t i = 0; i < length; ++i)
        if ((unsigned char)shown[i] < ' ') {
            fail(put);
            return;
        }
    memcpy(put->line + put->length, shown, length);
    memset(put->line + put->length + length, ' ', (size_t)width - length);
    put->length += (size_t)width;
}

static void write_line(struct uff_put *put, const char *text, size_t length)
{
    if (put->status == ROTID_OK && (fwrite(text, 1, length, put->stream) != length || putc('\n', put->stream) == EOF))
        put->status = ROTID_ERROR_IO;
}

void uff_put_line(struct uff_put *put)
{
    size_t first = 0, length = put->length;
    while (length && put->line[length - 1] == ' ')
        --length;
    while (first < length && put->line[first] == ' ')
        ++first;
    if (length - first == 2 && !memcmp(put->line + first, "-1", 2))
        fail(put);
    write_line(put, put->line, length);
    put->length = 0;
}

void uff_put_open(struct uff_put *put, FILE *stream, int set)
{
    char number[16];
    *put = (struct uff_put){.stream = stream};
    write_line(put, "    -1", 6);
    write_line(put, number, (size_t)snprintf(number, sizeof number, "%6d", set));
}

int uff_put_close(struct uff_put *put)
{
    write_line(put, "    -1", 6);
    return put->status;
}

void uff_put_integers(struct uff_put *put, int width, int per_line, int count, const int *value)
{
    for (int i = 0; i < count; ++i) {
        uff_put_integer(put, width, value[i]);
        if ((i + 1) % per_line == 0 || i + 1 == count)
            uff_put_line(put);
    }
}

void uff_put_reals(struct uff_put *put, int width, int decimals, int per_line, int count, const double *value)
{
    for (int i = 0; i < count; ++i) {
        uff_put_real(put, width, decimals, value[i]);
        if ((i + 1) % per_line == 0 || i + 1 == count)
            uff_put_line(put);
    }
}

void uff_put_text_line(struct uff_put *put, const char *text)
{
    uff_put_text(put, UFF_TEXT, text, "NONE");
    uff_put_line(put);
}
