#include "export/export.h"

#include <errno.h>
#include <math.h>
#include <string.h>

#include "report/layout.h"
#include "report/output.h"
#include "report/table.h"
#include "result/export.h"

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

static int write_one(const struct export_files *files, int i, FILE *stream, const struct export_model *model)
{
    if (files->format == EXPORT_MATRIX_MARKET)
        return market[i].write(stream, model);
    return files->condensed ? dmig_condensed(stream, model) : dmig_full(stream, model);
}

int export_files_write(const struct export_files *files, const struct export_model *model, const char **failed)
{
    struct output output[EXPORT_MOST_FILES];
    int count = 0, status = ROTID_OK, which = 0;
    for (; count < files->count && !status; count++) {
        *failed = files->path[count];
        status = output_open(&output[count], files->path[count]);
        if (status)
            break;
        status = write_one(files, count, output[count].stream, model);
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

/* Frequencies of the model in the files, full or condensed [model->spectrum.count]. */
static const double *exported_hz(const struct export_files *files, const struct export_model *model)
{
    return files->condensed ? model->spectrum.reduced_hz : model->spectrum.full_hz;
}

static const char *state_of(const struct export_model *model)
{
    const rotid_fit_result *fit = model->identified ? model->identified->fit : NULL;
    return !fit ? NULL : !fit->converged ? "not_converged" : fit->any_at_bound ? "at_bound" : "converged";
}

void table_export(FILE *out, const struct result_head *head, const struct export_files *files, const struct export_model *model)
{
    const struct job *job = model->job;
    const struct spectrum *s = &model->spectrum;
    table_heading(out, head);
    (void)fprintf(out,
                  model->identified ? "model           identified from %d measured modes\n"
                                    : "model           as the deck states it\n",
                  job->measurement.nmode);
    for (int p = 0; p < job->unknowns.nparameter; p++) {
        double std = export_parameter_std(model, p);
        name_cell(out, 15, job->unknowns.bounds[p].name);
        (void)fprintf(out, " %.6g %s", export_parameter(model, p), job->unknowns.bounds[p].unit);
        if (isfinite(std))
            (void)fprintf(out, ", standard deviation %.3g", std);
        (void)fputc('\n', out);
    }
    (void)fprintf(out, "mass            %.4f kg, centre at %.6f m\n", model->mass.mass, model->mass.center);
    (void)fprintf(out, "matrices        %d nodes, %d degrees of freedom\n", model->nnode, model->k.n);
    if (model->condensed.k)
        (void)fprintf(out, "condensed       by %s onto %d %s\n", reduction_words[model->condensed.kind], model->condensed.count,
                      job->rotor.nsensor ? "sensors" : "nodes");
    (void)fputs("\nmode   full model       condensed\n           [Hz]            [Hz]\n", out);
    for (int j = 0; j < s->count; j++) {
        (void)fprintf(out, "%3d ", j + 1);
        number_cell(out, 13, 4, s->full_hz[j]);
        number_cell(out, 16, 4, model->condensed.k ? s->reduced_hz[j] : NAN);
        (void)fputc('\n', out);
    }
    (void)fputc('\n', out);
    for (int i = 0; i < files->count; i++)
        (void)fprintf(out, "%s\n", files->path[i]);
}

static struct export_parameter_result *parameters(struct pool *pool, const struct export_model *model)
{
    const struct job *job = model->job;
    struct export_parameter_result *list = POOL_ARRAY(pool, struct export_parameter_result, job->unknowns.nparameter);
    for (int p = 0; p < job->unknowns.nparameter && list; p++)
        list[p] = (struct export_parameter_result){job->unknowns.bounds[p].name, job->unknowns.bounds[p].unit,
                                                   export_parameter(model, p), export_parameter_std(model, p)};
    return list;
}

const struct export_result *export_result_of(struct pool *pool, const struct export_files *files,
                                             const struct export_model *model)
{
    const struct spectrum *s = &model->spectrum;
    struct export_result *out = POOL_NEW(pool, struct export_result);
    if (!out)
        return NULL;
    *out = (struct export_result){
        .format = export_format_words[files->format],
        .nfiles = files->count,
        .model = model->identified ? "identified" : "stated",
        .status = state_of(model),
        .nparameters = model->job->unknowns.nparameter,
        .mass_kg = model->mass.mass,
        .center_of_mass_m = model->mass.center,
        .nodes = model->nnode,
        .degrees_of_freedom = model->k.n,
        .reduction = model->condensed.k ? reduction_words[model->condensed.kind] : NULL,
        .masters = model->condensed.k ? model->condensed.count : ROTID_NONE,
        .nrigid_hz = s->nrigid,
        .rigid_hz = s->rigid_hz,
        .nfull_hz = s->count,
        .full_hz = s->full_hz,
        .parameters = parameters(pool, model),
        .files = POOL_ARRAY(pool, const char *, files->count),
    };
    out->exported_hz = exported_hz(files, model);
    out->nexported_hz = s->count;
    for (int i = 0; i < files->count && out->files; i++)
        out->files[i] = files->path[i];
    return out->parameters && out->files ? out : NULL;
}
