/* What was exported, as a table and as the struct of its JSON. */
#ifndef ROTID_EXPORT_SUMMARY_H
#define ROTID_EXPORT_SUMMARY_H

#include <stdio.h>

#include "export/files.h"
#include "result/head.h"

/* ross: NULL but for EXPORT_ROSS, in both. */
void table_export(FILE *out, const struct result_head *head, const struct export_files *files, const struct export_model *model,
                  const struct ross_model *ross);
/* The same as the struct of its JSON, on the pool; NULL where memory is out. */
const struct export_result *export_result_of(struct pool *pool, const struct export_files *files,
                                             const struct export_model *model, const struct ross_model *ross);

#endif
