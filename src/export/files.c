#include "export/files.h"

#include <errno.h>

#include "export/dmig.h"
#include "export/matrix_market.h"
#include "export/ross.h"
#include "report/output.h"

/* of Matrix Market, those of the condensed model last */
static const struct {
    const char *suffix;
    int (*write)(FILE *stream, const struct export_model *model);
} market[EXPORT_MOST_FILES] = {{"stiffness.mtx", matrix_market_stiffness},
                               {"mass.mtx", matrix_market_mass},
                               {"nodes.csv", matrix_market_nodes},
                               {"condensed_stiffness.mtx", matrix_market_condensed_stiffness},
                               {"condensed_mass.mtx", matrix_market_condensed_mass}};

int export_files_name(struct pool *pool, enum export_format format, int condensed, const char *path,
                      const struct export_model *model, struct export_files *files)
{
    *files = (struct export_files){format, condensed, 1, {path}};
    if (format != EXPORT_MATRIX_MARKET)
        return ROTID_OK;
    files->count = model->condensed.impossible ? EXPORT_MOST_FILES - 2 : EXPORT_MOST_FILES;
    for (int i = 0; i < files->count; i++)
        if (!(files->path[i] = pool_format(pool, "%s.%s", path, market[i].suffix)))
            return ROTID_ERROR_MEMORY;
    return ROTID_OK;
}

static int write_one(struct pool *pool, const struct export_files *files, int i, FILE *stream, const struct export_model *model,
                     const struct ross_model *ross)
{
    switch (files->format) {
    case EXPORT_MATRIX_MARKET:
        return market[i].write(stream, model);
    case EXPORT_DMIG:
        return files->condensed ? dmig_condensed(stream, model) : dmig_full(stream, model);
    default:
        return ross_write(pool, stream, ross);
    }
}

int export_files_write(struct pool *pool, const struct export_files *files, const struct export_model *model,
                       const struct ross_model *ross, const char **failed)
{
    struct output output[EXPORT_MOST_FILES];
    int count = 0, status = ROTID_OK, which = 0;
    for (; count < files->count && !status; count++) {
        *failed = files->path[count];
        status = output_open(&output[count], files->path[count]);
        if (status)
            break;
        status = write_one(pool, files, count, output[count].stream, model, ross);
    }
    if (status) {
        for (int i = 0; i < count; i++)
            output_abandon(&output[i]);
        return status;
    }
    status = output_close_all(files->count, output, &which);
    *failed = status ? files->path[which] : NULL;
    return status;
}
