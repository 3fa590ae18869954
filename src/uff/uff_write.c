/* Sets that are written in one go: header, units, geometry. */
#include "uff/uff_write.h"

#include "rotid.h"
#include "uff/uff_record.h"

/* A date and a time of ten columns each, kept as one text. */
static void put_date(struct uff_put *put, const char *text)
{
    uff_put_text(put, 20, text, "");
}

int uff_write_header(FILE *stream, const struct uff_header *header)
{
    struct uff_put put;
    uff_put_open(&put, stream, 151);
    uff_put_text_line(&put, header->model);
    uff_put_text_line(&put, header->description);
    uff_put_text_line(&put, header->program);
    put_date(&put, header->created);
    uff_put_integer(&put, 10, header->version[0]);
    uff_put_integer(&put, 10, header->version[1]);
    uff_put_integer(&put, 10, header->file_type);
    uff_put_line(&put);
    put_date(&put, header->saved);
    uff_put_line(&put);
    uff_put_text_line(&put, header->written_by);
    put_date(&put, header->written);
    uff_put_line(&put);
    return uff_put_close(&put);
}

int uff_write_units(FILE *stream, const struct uff_units *units)
{
    const double factor[] = {units->length, units->force, units->temperature, units->temperature_offset};
    struct uff_put put;
    uff_put_open(&put, stream, 164);
    uff_put_record(&put, &uff_units_164, units);
    uff_put_reals(&put, 25, 16, 3, 4, factor);
    return uff_put_close(&put);
}

int uff_write_nodes(FILE *stream, int set, int count, const struct uff_node *node)
{
    struct uff_put put;
    if ((set != 15 && set != 2411) || count < 0)
        return ROTID_ERROR_ARGUMENT;
    uff_put_open(&put, stream, set);
    for (int i = 0; i < count && put.status == ROTID_OK; ++i) {
        uff_put_record(&put, set == 15 ? &uff_node_15 : &uff_node_2411, &node[i]);
        if (set == 2411)
            uff_put_record(&put, &uff_place_2411, &node[i]);
    }
    return uff_put_close(&put);
}
