/* Which column of a table holds what: by the names in its first row, or, where that begins with a number, by their order. */
#ifndef ROTID_DECK_TABLE_COLUMNS_H
#define ROTID_DECK_TABLE_COLUMNS_H

#include "deck/deck_cards.h"
#include "deck/table_text.h"

#define TABLE_MOST_VALUES 8

struct csv_column {
    const char *names; /* in lower case, separated by bars; the first is that of messages */
    const char *si;    /* unit that its numbers have inside, as for deck_unit_factor; NULL: none */
    int may_lack;
};

/* What the columns of a card are called. */
struct table_kind {
    const char *card;
    int by_mode; /* it has a card for each mode: the table may hold a value for each mode and sensor */
    struct csv_column value[TABLE_MOST_VALUES]; /* of a data line, in its order; ended by one without names */
    struct csv_column key[3];                   /* what else a row says; ended by one without names */
};

/* A column called "mode 3", "3", "sensor 7", "mode 3 std". */
struct table_numbered {
    int number;
    int of_mode, of_sensor, is_std; /* as the name says */
};

struct table_columns {
    int header;                   /* the first row names the columns */
    int value[TABLE_MOST_VALUES]; /* index of a column, -1: there is none */
    int key[3];
    double in_si[TABLE_MOST_VALUES]; /* of a unit in the header, 0: none there */
};

extern const struct table_kind table_kinds[]; /* ended by one without card */

const struct table_kind *table_kind_of(const char *card);

/* Whether the first row names columns: its first cell is no number. */
int table_has_header(const struct table_text *table);

/* Finds the columns of a kind. 0, or 1 after an error; a column that no card knows is told of. `values`: those of data lines that
 * may not lack are asked for. */
int table_find_columns(struct deck_reader *reader, const struct table_text *table, const struct table_kind *kind, int values,
                       struct table_columns *columns);

/* Whether a name of the header is that of a column; *unit: what stands in brackets or behind it, "" where nothing does. */
int table_names(const char *name, const struct csv_column *column, char unit[TABLE_CELL_LENGTH]);

/* Whether it is a numbered one. */
int table_numbers(const char *name, struct table_numbered *numbered);

#endif
