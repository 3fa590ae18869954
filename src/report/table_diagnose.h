/* The diagnosis on one screen for a test engineer, in plain ASCII. */
#ifndef ROTID_REPORT_TABLE_DIAGNOSE_H
#define ROTID_REPORT_TABLE_DIAGNOSE_H

#include <stdio.h>

#include "result/result.h"

struct diagnosis_view {
    FILE *out;
    const struct result_head *head;
    const rotid_diagnosis *diagnosis;
    int verbose; /* all candidates, times of the steps */
    int width;   /* columns of texts and charts, 100 to 120; tables take no more than 100 */
};

void table_diagnose(const struct diagnosis_view *view);

/* "1.157 (1.150 ... 1.164) e+11 Pa": one power of ten for all three; "-" where p is NULL. Returns text. */
#define PARAMETER_TEXT 128
const char *parameter_text(const rotid_fitted_parameter *p, char text[PARAMETER_TEXT]);

/* Its parts. */
void table_parameters(const struct diagnosis_view *view);       /* what was identified, and what may hide in it */
void table_misfit(const struct diagnosis_view *view);           /* misfit by modes, sensors, places */
void table_evidence(const struct diagnosis_view *view);         /* candidates of every round */
void table_gain(const struct diagnosis_view *view);             /* before and after: quality and parameters */
void table_detection_limits(const struct diagnosis_view *view); /* smallest sizes that would show */

#endif
