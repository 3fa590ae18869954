/* Header, set 151, and units, set 164. */

#include "uff/uff_reader.h"
#include "uff/uff_record.h"

/* Record 4: date and time, then numbers, which no one needs: writers put other things there, or nothing. */
static void cut_versions(const struct uff_lines *lines, struct uff_header *header)
{
    static const struct uff_column column[] = {{UFF_INTEGER, 20, 10}, {UFF_INTEGER, 30, 10}, {UFF_INTEGER, 40, 10}};
    struct uff_cell cell[3];
    int bad = uff_cut_line(lines, 3, column, cell);
    uff_copy_text(lines->text, lines->length < 20 || bad >= 0 ? lines->length : 20, sizeof header->created, header->created);
    for (int i = 0; i < 3 && bad < 0; ++i)
        if (cell[i].integer < -2147483647 || cell[i].integer > 2147483647)
            bad = i;
    if (bad >= 0)
        return;
    header->version[0] = (int)cell[0].integer;
    header->version[1] = (int)cell[1].integer;
    header->file_type = (int)cell[2].integer;
}

int uff_read_header(struct uff_reader *reader, struct uff_header *header)
{
    struct uff_lines *lines = &reader->lines;
    *header = (struct uff_header){0};
    char *text[] = {header->model, header->description, header->program, NULL,
                    header->saved, header->written_by,  header->written};
    int status = uff_begin(reader, 151);
    if (status != ROTID_OK)
        return status;
    /* some write fewer records or more: as the lines come, to the end of the set */
    for (size_t i = 0;; ++i) {
        status = uff_take_line(lines);
        if (status == UFF_END)
            status = uff_fail(lines, 0, "the file ends after this line; expected the '-1' that ends the set");
        if (status != ROTID_OK || uff_is_delimiter(lines, lines->strict))
            return uff_end(reader, status, UFF_BETWEEN);
        if (i == 3)
            cut_versions(lines, header);
        else if (i < sizeof text / sizeof *text)
            uff_copy_text(lines->text, lines->length, UFF_TEXT + 1, text[i]);
    }
}

static int read_units(struct uff_reader *reader, struct uff_units *units)
{
    struct uff_lines *lines = &reader->lines;
    double factor[4];
    int is_end, status = uff_read_record(lines, &uff_units_164, units);
    if (status != ROTID_OK)
        return status;
    if (units->code < 1 || units->code > 9)
        return uff_fail(lines, 1, "%s: code %d; expected 1 to 9", uff_units_164.what, units->code);
    status = uff_read_reals(lines, 4, 3, 25, "record 2 (factors of length, force, temperature; offset)", factor);
    if (status == ROTID_OK)
        status = uff_next_record(reader, "the '-1' that ends the set", &is_end);
    if (status != ROTID_OK)
        return status;
    if (!is_end)
        return uff_fail(lines, 0, "expected the '-1' that ends the set behind four factors");
    units->length = factor[0];
    units->force = factor[1];
    units->temperature = factor[2];
    units->temperature_offset = factor[3];
    return ROTID_OK;
}

int uff_read_units(struct uff_reader *reader, struct uff_units *units)
{
    *units = (struct uff_units){0};
    int status = uff_begin(reader, 164);
    return status == ROTID_OK ? uff_end(reader, read_units(reader, units), UFF_BETWEEN) : status;
}
