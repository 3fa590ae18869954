/* Rows of the tables that describe a result, for the files that have such tables alone. */
#ifndef ROTID_RECORD_ROWS_H
#define ROTID_RECORD_ROWS_H

#include "record/record.h"

#define RECORD_ROW(S, M, KIND, SHAPE, BITS, ...)                                                                                 \
    {                                                                                                                            \
        .key = #M, .kind = (KIND), .shape = (SHAPE), .bits = (BITS), .offset = offsetof(S, M), __VA_ARGS__                       \
    }
#define COUNTED(S, COUNT, BY) .count = offsetof(S, COUNT), .counted_by = (BY)
#define NUMBER(S, M, BITS)    RECORD_ROW(S, M, FIELD_NUMBER, SHAPE_ONE, BITS, .fixed = 0)
#define INTEGER(S, M, BITS)   RECORD_ROW(S, M, FIELD_INTEGER, SHAPE_ONE, BITS, .fixed = 0)
#define FLAG(S, M, BITS)      RECORD_ROW(S, M, FIELD_FLAG, SHAPE_ONE, BITS, .fixed = 0)
/* Members of one description: numbers, integers and texts, as their types are; flags; structs in place. */
#define KEYS(S, BITS, ...)      EACH(KEY_ROW, S, BITS, __VA_ARGS__)
#define FLAGS(S, BITS, ...)     EACH(FLAG, S, BITS, __VA_ARGS__)
#define RECORDS(S, RECORD, ...) EACH(RECORD_IN, S, RECORD, __VA_ARGS__)
#define KEY_ROW(S, M, BITS)                                                                                                      \
    RECORD_ROW(S, M, _Generic(((S *)0)->M, double: FIELD_NUMBER, int: FIELD_INTEGER, const char *: FIELD_TEXT), SHAPE_ONE, BITS, \
               .fixed = 0)
#define RECORD_IN(S, M, RECORD)    STRUCT(S, M, 0, RECORD)
#define EACH_1(ROW, S, A, M)       ROW(S, M, A)
#define EACH_2(ROW, S, A, M, ...)  ROW(S, M, A), EACH_1(ROW, S, A, __VA_ARGS__)
#define EACH_3(ROW, S, A, M, ...)  ROW(S, M, A), EACH_2(ROW, S, A, __VA_ARGS__)
#define EACH_4(ROW, S, A, M, ...)  ROW(S, M, A), EACH_3(ROW, S, A, __VA_ARGS__)
#define EACH_5(ROW, S, A, M, ...)  ROW(S, M, A), EACH_4(ROW, S, A, __VA_ARGS__)
#define EACH_6(ROW, S, A, M, ...)  ROW(S, M, A), EACH_5(ROW, S, A, __VA_ARGS__)
#define EACH_7(ROW, S, A, M, ...)  ROW(S, M, A), EACH_6(ROW, S, A, __VA_ARGS__)
#define EACH_8(ROW, S, A, M, ...)  ROW(S, M, A), EACH_7(ROW, S, A, __VA_ARGS__)
#define EACH_9(ROW, S, A, M, ...)  ROW(S, M, A), EACH_8(ROW, S, A, __VA_ARGS__)
#define EACH_10(ROW, S, A, M, ...) ROW(S, M, A), EACH_9(ROW, S, A, __VA_ARGS__)
#define EACH(ROW, S, A, ...)                                                                                                     \
    EACH_COUNT(__VA_ARGS__, EACH_10, EACH_9, EACH_8, EACH_7, EACH_6, EACH_5, EACH_4, EACH_3, EACH_2, EACH_1, )                   \
    (ROW, S, A, __VA_ARGS__)
#define EACH_COUNT(A, B, C, D, E, F, G, H, I, J, COUNT, ...) COUNT
#define TEXT(S, M, BITS)                                     RECORD_ROW(S, M, FIELD_TEXT, SHAPE_ONE, BITS, .fixed = 0)
#define TEXT_OF(S, M, BITS, WORDS)                           RECORD_ROW(S, M, FIELD_TEXT, SHAPE_ONE, BITS, .words = (WORDS))
#define WORD(S, M, BITS, WORDS)                              RECORD_ROW(S, M, FIELD_WORD, SHAPE_ONE, BITS, .words = (WORDS))
#define STRUCT(S, M, BITS, RECORD)                           RECORD_ROW(S, M, FIELD_RECORD, SHAPE_ONE, BITS, .record = &(RECORD))
#define INLINE(S, M, BITS, RECORD)                           RECORD_ROW(S, M, FIELD_INLINE, SHAPE_ONE, BITS, .record = &(RECORD))
#define INTERVAL(S, M, BITS)                                 RECORD_ROW(S, M, FIELD_NUMBER, SHAPE_FIXED, BITS, .fixed = 2)
#define INDICES(S, M, FIXED)                                 RECORD_ROW(S, M, FIELD_INTEGER, SHAPE_FIXED, FROM_0, .fixed = (FIXED))
#define NUMBERS(S, M, BITS)                                  RECORD_ROW(S, M, FIELD_NUMBER, SHAPE_LIST, BITS, COUNTED(S, n##M, NULL))
#define INTEGERS(S, M, BITS)                                 RECORD_ROW(S, M, FIELD_INTEGER, SHAPE_LIST, BITS, COUNTED(S, n##M, NULL))
#define TEXTS(S, M, BITS)                                    RECORD_ROW(S, M, FIELD_TEXT, SHAPE_LIST, BITS, COUNTED(S, n##M, NULL))
#define STRUCTS(S, M, BITS, RECORD)                          RECORD_ROW(S, M, FIELD_RECORD, SHAPE_LIST, BITS, COUNTED(S, n##M, NULL), .record = &(RECORD))
/* As many as the member COUNT says, which an earlier row, of key BY, has set. */
#define NUMBERS_BY(S, M, BITS, COUNT, BY)  RECORD_ROW(S, M, FIELD_NUMBER, SHAPE_LIST, BITS, COUNTED(S, COUNT, BY))
#define INTEGERS_BY(S, M, BITS, COUNT, BY) RECORD_ROW(S, M, FIELD_INTEGER, SHAPE_LIST, BITS, COUNTED(S, COUNT, BY))
/* As many as the list of key BY of the struct ABOVE has. */
#define NUMBERS_AS(S, M, BITS, ABOVE, BY)                                                                                        \
    COUNT_OF(S, n##M, ABOVE, n##BY), RECORD_ROW(S, M, FIELD_NUMBER, SHAPE_LIST, BITS, COUNTED(S, n##M, #BY))
/* Members with the numbers of rows and columns; where they are known already the matrix has to be of that size. */
#define MATRIX(S, M, BITS, ROWS, COLUMNS)                                                                                        \
    RECORD_ROW(S, M, FIELD_NUMBER, SHAPE_MATRIX, BITS, .count = offsetof(S, ROWS), .columns = offsetof(S, COLUMNS))
/* EACH: member with the number of components of each */
#define MAPS(S, M, BITS, EACH)                                                                                                   \
    RECORD_ROW(S, M, FIELD_MAP, SHAPE_LIST, BITS, .count = offsetof(S, n##M), .columns = offsetof(S, EACH))
/* Of a member of another name than its key, or of a part of a member; behind the bits what the kind needs besides. */
#define AT(KIND, S, KEY, M, ...)                                                                                                 \
    {                                                                                                                            \
        .key = #KEY, .kind = FIELD_##KIND, .offset = offsetof(S, M), .bits = __VA_ARGS__                                         \
    }
#define AT_LIST(KIND, S, KEY, M, COUNT, ...) AT(KIND, S, KEY, M, __VA_ARGS__, .shape = SHAPE_LIST, .count = offsetof(S, COUNT))
#define AT_FIXED(KIND, S, KEY, M, N, BITS)                                                                                       \
    AT(KIND, S, KEY, M, BITS, .shape = SHAPE_FIXED, .fixed = (N), .columns = sizeof *((S *)0)->M)
/* Rows of the same struct in a table of their own, whose keys stand together or not at all: IF_KNOWN, told by the first one. */
#define ROWS(BITS, RECORD)                                                                                                       \
    {                                                                                                                            \
        .key = "", .kind = FIELD_INLINE, .bits = (BITS), .record = &(RECORD)                                                     \
    }
/* One such object, with as many components as the member nM says. */
#define MAP(S, M, BITS)          RECORD_ROW(S, M, FIELD_MAP, SHAPE_ONE, BITS, .columns = offsetof(S, n##M))
#define WORDS(S, M, BITS, WORDS) RECORD_ROW(S, M, FIELD_WORDS, SHAPE_ONE, BITS, .words = (WORDS))
/* N: of the words, as many as the member has */
#define COUNTS(S, M, BITS, WORDS, N) RECORD_ROW(S, M, FIELD_COUNTS, SHAPE_ONE, (BITS) | FROM_0, .words = (WORDS), .fixed = (N))
#define COUNT_OF(S, M, ABOVE, COUNT) RECORD_ROW(S, M, FIELD_COUNT, SHAPE_ONE, 0, .count = offsetof(ABOVE, COUNT))
#define RECORD(S, FIELDS)                                                                                                        \
    {                                                                                                                            \
        .name = #S, .size = sizeof(S), .field = (FIELDS)                                                                         \
    }

/* The record of a struct that stands in one place, its rows being written there. */
#define RECORD_OF(S, ...) ((const struct record)RECORD(S, ((const struct record_field[]){__VA_ARGS__, {0}})))

/* The record NAME of struct S, behind which its rows stand, ended by {0}; PART_TABLE: for tables of the same file alone. The
 * names of both are unique in the program. */
#define TABLE(NAME, S)      TABLE_OF(, NAME, S)
#define PART_TABLE(NAME, S) TABLE_OF(static, NAME, S)
#define TABLE_OF(LINKAGE, NAME, S)                                                                                               \
    extern const struct record_field NAME##_rows[];                                                                              \
    LINKAGE const struct record NAME = RECORD(S, NAME##_rows);                                                                   \
    const struct record_field NAME##_rows[]

#endif
