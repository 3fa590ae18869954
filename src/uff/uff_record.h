/* Lines of universal files with what stands in them, for both directions: which columns, and which member of the struct. From one
 * layout follow uff_read_record and uff_put_record. Internal to uff_*.c. */
#ifndef ROTID_UFF_UFF_RECORD_H
#define ROTID_UFF_UFF_RECORD_H

#include <stddef.h>

#include "uff/uff_lines.h"
#include "uff/uff_put.h"

struct uff_member {
    struct uff_column column;
    size_t offset; /* int; UFF_LONG: long long; UFF_REAL: double; UFF_WORDS: char [width + 1], written to the left, NONE where
                      empty */
    int decimals;  /* UFF_REAL */
    int one_more;  /* UFF_REAL: a digit more where the number has one and it leaves a blank before it */
};

struct uff_record {
    const char *what; /* in messages */
    int is_exact; /* integers and behind them reals, all of them there (uff_parse_line); else a blank one is 0 (uff_cut_record) */
    int count;
    struct uff_member member[UFF_CELL_LIMIT];
};

/* By set and record. */
extern const struct uff_record uff_units_164, uff_node_15, uff_node_2411, uff_place_2411, uff_kind_55,
    uff_location_58, uff_form_58, uff_abscissa_58, uff_ordinate_58, uff_denominator_58, uff_z_axis_58;

/* The next line, or the one at hand, to the members of the struct `to`. */
int uff_read_record(struct uff_lines *lines, const struct uff_record *record, void *to);
int uff_take_record(struct uff_lines *lines, const struct uff_record *record, void *to);

/* Cuts the line at hand without a word: the member that is wrong, or -1; cells for messages. The members are set where none is.
 */
int uff_cut_members(const struct uff_lines *lines, const struct uff_record *record, struct uff_cell cell[UFF_CELL_LIMIT],
                    void *to);

/* The members as a line. */
void uff_put_record(struct uff_put *put, const struct uff_record *record, const void *from);

#endif
