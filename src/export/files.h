/* The files of an export, all of them or none. */
#ifndef ROTID_EXPORT_FILES_H
#define ROTID_EXPORT_FILES_H

#include "export/model.h"
#include "export/ross_model.h"

enum export_format { EXPORT_MATRIX_MARKET, EXPORT_DMIG, EXPORT_ROSS };

#define EXPORT_MOST_FILES 5

struct export_files {
    enum export_format format;
    int condensed; /* DMIG: of the condensed model */
    int count;
    const char *path[EXPORT_MOST_FILES];
};

/* The files that are to be written: path itself, or with Matrix Market path.stiffness.mtx and so on; without those of the
 * condensed model where it is not possible. ROTID_OK or ROTID_ERROR_MEMORY. */
int export_files_name(struct pool *pool, enum export_format format, int condensed, const char *path,
                      const struct export_model *model, struct export_files *files);

/* ross: NULL but for EXPORT_ROSS. ROTID_OK, ROTID_ERROR_MEMORY, or ROTID_ERROR_IO with errno and the file in *failed. */
int export_files_write(struct pool *pool, const struct export_files *files, const struct export_model *model,
                       const struct ross_model *ross, const char **failed);

#endif
