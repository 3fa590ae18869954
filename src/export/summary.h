/* What was exported, as a table and as JSON. */
#ifndef ROTID_EXPORT_SUMMARY_H
#define ROTID_EXPORT_SUMMARY_H

#include <stdio.h>

#include "export/files.h"
#include "report/json.h"

/* Frequencies of the model in the files: full, condensed, or that of the ROSS script. [model->spectrum.count,
 * ross->spectrum->count] */
const double *export_exported_hz(const struct export_files *files, const struct export_model *model,
                                 const struct ross_model *ross, int *count);

/* ross: NULL but for EXPORT_ROSS, in both. */
void table_export(FILE *out, const struct export_files *files, const struct export_model *model, const struct ross_model *ross);
char *json_export(const struct provenance *provenance, const struct export_files *files, const struct export_model *model,
                  const struct ross_model *ross, const struct message_list *notes);

#endif
