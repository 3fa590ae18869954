#ifndef ROTID_RECORD_RECORD_H
#define ROTID_RECORD_RECORD_H

/* Record: the description of every result of rotid.h as a table, one struct record a struct, one row (struct record_field) a key.
 * In: the structs of rotid.h, in which a result is computed. Out: tables, from which follow
 *   the copy that a host keeps        record_copy.c (record_copy), called by src/api
 *   JSON written and read             src/result walks the same tables
 *   docs/schema                       tools/schema, from the tables and from the comments of rotid.h
 *
 * The tables, a file a result:
 *   record_geometry.c    geometry: materials, groups, segments, tie rods, bars, disks, springs, sensors, causes in the model
 *   record_modes.c       spectrum: modes, mesh of a solid, beam beside solid; check of a deck; messages
 *   record_identify.c    identification: parameters with intervals, compared modes, shapes, minimisers, noise, hidden causes
 *   record_diagnose.c    diagnosis: verdict, findings, rounds, candidates, gain, detection limits
 *   record_suggest.c     suggestion: plans of sensors, rivals, proposed tests
 *   record_speeds.c      the machine in operation: critical speeds, Campbell diagram, response, run-up
 *   rows.h               macros that make a row of a member (NUMBER, TEXT, WORD, ...), for these files and for src/result
 * A word of a result (LIKELIHOOD, named, ...) is an index into a list such as functional_words; cards use the same lists.
 *
 * Callers: api, result, tools/schema; deck, export and run for the words. The room must not know how a result is
 * computed or printed: a new key is a member of rotid.h and a row here. */

#include "base/base.h"

/* Words of results and of cards, in the order of the constants of rotid.h; NULL behind the last. */

extern const char *const functional_words[],
    *const reduction_words[], *const derivative_words[], *const pairing_words[], *const fit_status_words[],
                                                                                     *const mode_type_words[],
                                                                                         *const verdict_words[],
                                                                                             *const whirl_words[];

/* ---------------------------------------------------------------------------------------------------------------- record */

/* One description of a result: a table of fields for each struct, one row a key of the JSON. From the table follow the copy that
 * a host keeps, the JSON that is written, the JSON that is read, with the place of every mistake, and docs/schema.
 *
 * A key is the name of the member, and its description in the schema is the comment of the member. A list X has its length in the
 * member nX beside it, unless its row names another one. What is not known is NaN, NULL, ROTID_NONE or a word below 0 in the
 * struct and null in the JSON. */

enum field_kind {
    FIELD_NUMBER,  /* double */
    FIELD_INTEGER, /* int */
    FIELD_FLAG,    /* int, 0 or 1 */
    FIELD_TEXT,    /* const char *; with words: one of them */
    FIELD_CHARS,   /* char [], a text in place, "": null; written and not read, as the next one is */
    FIELD_NAME,    /* int, of which `name` tells the text */
    FIELD_WORD,    /* int, the index of one of the words; below 0: null */
    FIELD_RECORD,  /* a struct, in place or behind a pointer */
    FIELD_INLINE,  /* the same, its keys beside those of this struct; behind a pointer that is NULL they are left out */
    FIELD_MAP,     /* an object that has the names of rotid_components as its keys, or a list of such objects */
    FIELD_WORDS,   /* int, a bit for each of the words: the list of those whose bits are set */
    FIELD_COUNTS,  /* int, one for each of the words in place: an object that has the words as its keys; null: the first is
                      ROTID_NONE */
    FIELD_COUNT,   /* no key: int, takes a count of the struct above while reading, for the lists that have to be as long */
};

enum field_shape {
    SHAPE_ONE,    /* the value itself */
    SHAPE_FIXED,  /* `fixed` of them, in place */
    SHAPE_LIST,   /* behind a pointer, as many as the int at `count` says */
    SHAPE_MATRIX, /* numbers behind a pointer, rows at `count`, columns at `columns`, column-major */
};

/* Bits of a row. Of the ranges no more than one. */
enum {
    MAY_BE_NULL = 1, /* not known: null. Of a list: NULL; of its elements: ELEMENTS_MAY_BE_NULL */
    ELEMENTS_MAY_BE_NULL = 2,
    IF_KNOWN = 4,    /* not known: the key is left out; of FIELD_INLINE all of them */
    SINCE_LATER = 8, /* older results do not have the key */
    ROUNDED = 16,    /* nine significant digits: for values that are drawn */
    BEHIND_POINTER = 32,
    NOT_EMPTY = 64,
    WHOLE = 128,   /* a whole number in a double: what an int may not hold */
    ABOVE_0 = 256, /* ranges, of the elements of a list too */
    FROM_0 = 512,
    FROM_1 = 1024,
    PROBABILITY = 2048, /* 0 to 1 */
    CORRELATION = 4096, /* 0 to 1 and rounding */
};

struct record;

struct record_field {
    const char *key;
    enum field_kind kind;
    enum field_shape shape;
    unsigned bits;
    size_t offset, count, columns; /* of members of the struct; FIELD_COUNT: count of one of the struct above; columns of a list
                                      of FIELD_CHARS: its bytes */
    int fixed;
    const char *counted_by;      /* SHAPE_LIST: key of the list whose length this one has, NULL: its own */
    const struct record *record; /* of FIELD_RECORD and FIELD_INLINE */
    const char *const *words;    /* ends with NULL */
    const char *(*name)(int);
};

struct record {
    const char *name; /* of the struct */
    size_t size;
    const struct record_field *field; /* ends with key NULL */
};

/* What a state of a rotid_identification has for itself, by the same names in both structs. */
#define STATE_COPY(to, from)                                                                                                     \
    ((to)->shapes_fitted = (from)->shapes_fitted, (to)->objective = (from)->objective, (to)->chi2 = (from)->chi2,                \
     (to)->nmodes = (from)->nmodes, (to)->modes = (from)->modes,                                                                 \
     (to)->reduction_error_percent = (from)->reduction_error_percent, (to)->mesh_error_percent = (from)->mesh_error_percent,     \
     (to)->mass_kg = (from)->mass_kg, (to)->center_of_mass_m = (from)->center_of_mass_m, (to)->shapes = (from)->shapes,          \
     (to)->nmatrix_rows = (from)->nmatrix_rows, (to)->nmatrix_columns = (from)->nmatrix_columns,                                 \
     (to)->nco_matrix = (from)->nco_matrix, (to)->mac_matrix = (from)->mac_matrix, (to)->matrix_rows = (from)->matrix_rows,      \
     (to)->matrix_columns = (from)->matrix_columns, (to)->noise = (from)->noise, (to)->geometry = (from)->geometry)

/* Bytes of one element of a list of this kind. */
size_t record_element_size(const struct record_field *field);

/* A copy of the struct `from`, which `record` describes, with everything that its rows lead to, on the pool. NULL where memory is
 * out. */
void *record_copy(struct pool *pool, const struct record *record, const void *from);

/* The tables of the results of rotid.h, where their members, units and meaning stand. */
extern const struct record geometry_record; /* rotid_geometry */
extern const struct record sensor_record;   /* rotid_sensor */
extern const struct record check_record;    /* rotid_check */
extern const struct record spectrum_record; /* rotid_spectrum */
extern const struct record
    identification_record; /* rotid_identification as part of a diagnosis: without noise, geometry, hidden */
extern const struct record identification_alone_record; /* these three */
extern const struct record hidden_cause_record;         /* rotid_hidden */
extern const struct record noise_record;                /* rotid_noise */
extern const struct record diagnosis_record;            /* rotid_diagnosis */
extern const struct record suggestion_record;           /* rotid_suggestion */
extern const struct record fitted_parameter_record;     /* rotid_fitted_parameter */
extern const struct record compared_mode_record;        /* rotid_compared_mode */
extern const struct record verdict_record;              /* rotid_verdict */
extern const struct record data_finding_record;         /* rotid_data_finding */
extern const struct record cause_record;                /* rotid_cause */
extern const struct record detectable_record;           /* rotid_detectable */
extern const struct record speed_margin_record;         /* rotid_speed_margin */
extern const struct record stability_record;            /* rotid_stability */
extern const struct record weighed_record;              /* rotid_weighed */
extern const struct record runup_record;                /* rotid_runup_speed */
extern const struct record speeds_record;               /* rotid_speeds */

/* The same with the members that no file has, but for the fits and the messages: what a host is given. */
extern const struct record spectrum_whole_record, identification_whole_record, diagnosis_whole_record;

#endif
