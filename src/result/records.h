/* The tables of the results of src/run and of this room, and what JSON is made of a table and read by it. */
#ifndef ROTID_RESULT_RECORDS_H
#define ROTID_RESULT_RECORDS_H

#include "result/head.h"
#include "result/json_tree.h"
#include "result/place.h"

struct record;

/* Writes the keys of `from`, a struct that `record` describes, into `object` of the tree. */
void record_write(struct json_tree *tree, cJSON *object, const struct record *record, const void *from);

/* Reads the object `at` into `to`, a struct of zeros; lists and texts go to the pool of the reader. What is wrong is told with
 * its place, reader->status tells at the end. */
void record_read(const struct json_place *at, const struct record *record, void *to);

extern const struct record provenance_record; /* struct result_head up to command */
extern const struct record deck_record;       /* the rest, where the command reads a deck */

extern const struct record sensitivity_record;  /* struct sensitivity */
extern const struct record transfer_record;     /* struct transfer_result */
extern const struct record ema_record;          /* struct ema_result */
extern const struct record uff_record;          /* struct uff_result */
extern const struct record export_record;       /* struct export_result */
extern const struct record study_record;        /* struct study_result */
extern const struct record study_header_record; /* struct study_header */
extern const struct record study_axes_record;   /* struct study_axes */
extern const struct record study_run_record;    /* struct study_run */

/* The i-th command that writes results; NULL behind the last. */
const char *result_command(int i);
/* The table of the results of a command, NULL where there is no such command. */
const struct record *result_record(const char *command);
/* Whether a page is made of its results. */
int result_has_page(const char *command);

#endif
