/* What a file of results says as a whole: for each cell how its runs ended, what they found and how far that is from the truth.
 */
#ifndef ROTID_STUDY_SUMMARY_H
#define ROTID_STUDY_SUMMARY_H

#include <stdio.h>

#include "base/message.h"
#include "result/study.h"
#include "study/header.h"

/* Reads a file of results, finished or not, with its header. ROTID_OK; ROTID_ERROR_SYNTAX where it is something else,
 * ROTID_ERROR_IO: the list says so; ROTID_ERROR_MEMORY. */
int summary_read(struct pool *pool, const char *path, struct message_list *messages, struct header *header,
                 struct study_result *summary);

/* For a person. */
void summary_table(FILE *out, const struct study_result *summary);

/* Whether two runs are of one cell. */
int summary_same_cell(const struct study_axes *a, const struct study_axes *b);
/* Whether the diagnoses of a cell could be compared with the hidden effects. */
int summary_is_scored(const struct study_cell_result *cell);

#endif
