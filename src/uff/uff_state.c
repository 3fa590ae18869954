/* Where in the file a reader is. */
#include "uff/uff_reader.h"

int uff_begin(struct uff_reader *reader, int number)
{
    return reader->place == UFF_AT_BODY && reader->set.number == number ? ROTID_OK : ROTID_ERROR_ARGUMENT;
}

int uff_end(struct uff_reader *reader, int status, enum uff_place place)
{
    reader->place = status == ROTID_OK ? place : status == ROTID_ERROR_IO ? UFF_BROKEN : UFF_LOST;
    return status;
}

int uff_next_record(struct uff_reader *reader, const char *expected, int *is_end)
{
    int status = uff_expect_line(&reader->lines, expected);
    *is_end = status == ROTID_OK && uff_is_delimiter(&reader->lines, 0);
    return status;
}
