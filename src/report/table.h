/* Results as tables for a person. */
#ifndef ROTID_REPORT_TABLE_H
#define ROTID_REPORT_TABLE_H

#include <stdio.h>

#include "result/result.h"
#include "run/job.h"

void table_heading(FILE *out, const struct result_head *head);
/* The warnings that have no place in a file: the others have been said on standard error. */
void table_notes(FILE *out, const struct message_list *notes);
/* Before what is said of state i, where there are several: a line with its name. */
void table_state(FILE *out, int i, const char *name);
/* job: one for each state, whose CAUSE cards are told. */
void table_check(FILE *out, const struct result *result, const struct job *const *job);
/* shapes: with the shape of every mode at every sensor. */
void table_modes(FILE *out, const struct result *result, int shapes);
/* all: every pair of rivals of every test. */
void table_suggest(FILE *out, const struct result *result, int all);
void table_sensitivity(FILE *out, const struct result *result);
/* baseline: NLopt was asked for; history: with the iterations. */
void table_identify(FILE *out, const struct result *result, int baseline, int history);

#endif
