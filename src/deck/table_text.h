/* A table as a spreadsheet writes it: rows of cells with their places. */
#ifndef ROTID_DECK_TABLE_TEXT_H
#define ROTID_DECK_TABLE_TEXT_H

#include "deck/deck_text.h"

#define TABLE_MOST_BYTES   (16l << 20) /* of one file */
#define TABLE_MOST_CELLS   500000      /* of one file: 10,000 sensors with fifty modes */
#define TABLE_MOST_TAKEN   1000000     /* rows that all cards of a deck take of tables */
#define TABLE_MOST_TABLES  100         /* of a deck */
#define TABLE_MOST_COLUMNS 20100       /* 10,000 sensors with a standard deviation each, and what else a row says */
#define TABLE_CELL_LENGTH  32          /* of the name of a cell */

struct table_text {
    const char *path;
    int bad; /* an error has been reported: of the caller */
    int nrow;
    size_t row_room;
    struct data_line *row; /* rows that hold something; a place counts rows and columns from 1, text is NULL */
    double *number;        /* [nrow] of the cells of a column, NaN where there is none; of the caller */
};

/* Splits `text` [length + 1, overwritten: the cells lie in it] into rows. Cells are separated by semicolons where the first row
 * has one outside quotes, else by tabs, else by commas, or by the character of a first line "sep=;"; a cell may stand in quotes,
 * "" is a quote in it. Behind semicolons and tabs 1,5 is the number 1.5 unless another number of the table has a point. `path`
 * is kept. Errors, which name row, column and cell, go to the list. ROTID_OK, ROTID_ERROR_SYNTAX or ROTID_ERROR_MEMORY. */
int table_text_split(struct pool *pool, const char *path, size_t length, char *text, struct message_list *messages,
                     struct table_text *table);

/* The same of a file. `from`: what names it, the place of the error where it cannot be read. */
int table_text_read(struct pool *pool, const char *path, struct place from, struct message_list *messages,
                    struct table_text *table);

/* Whether the text is a number and nothing else. */
int table_is_number(const char *text);

/* "C7" of row 7 and column 3, as spreadsheets name it. Returns `name`. */
const char *table_cell_name(int row, int column, char name[TABLE_CELL_LENGTH]);

#endif
