#include "export/summary.h"

#include <math.h>
#include <string.h>

#include "report/layout.h"
#include "report/table.h"
#include "result/export.h"

/* Frequencies of the model in the files: full, condensed, or that of the ROSS script. [model->spectrum.count,
 * ross->spectrum->count] */
static const double *exported_hz(const struct export_files *files, const struct export_model *model,
                                 const struct ross_model *ross, int *count)
{
    const struct spectrum *s = ross ? ross->spectrum : &model->spectrum;
    *count = s->count;
    return files->condensed ? s->reduced_hz : s->full_hz;
}

static const char *state_of(const struct export_model *model)
{
    const rotid_fit_result *fit = model->identified ? model->identified->fit : NULL;
    return !fit ? NULL : !fit->converged ? "not_converged" : fit->any_at_bound ? "at_bound" : "converged";
}

void table_export(FILE *out, const struct result_head *head, const struct export_files *files, const struct export_model *model,
                  const struct ross_model *ross)
{
    const struct job *job = model->job;
    const struct spectrum *s = &model->spectrum;
    int count;
    const double *hz = exported_hz(files, model, ross, &count);
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
    (void)fprintf(out, "\nmode   full model %s\n           [Hz]   %s\n",
                  files->format == EXPORT_ROSS ? "  in the script" : "      condensed", "         [Hz]");
    for (int j = 0; j < s->count || j < count; j++) {
        (void)fprintf(out, "%3d ", j + 1);
        number_cell(out, 13, 4, j < s->count ? s->full_hz[j] : NAN);
        number_cell(out, 16, 4,
                    files->format != EXPORT_ROSS ? model->condensed.k ? s->reduced_hz[j] : NAN
                    : j < count                  ? hz[j]
                                                 : NAN);
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
                                             const struct export_model *model, const struct ross_model *ross)
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
    out->exported_hz = exported_hz(files, model, ross, &out->nexported_hz);
    for (int i = 0; i < files->count && out->files; i++)
        out->files[i] = files->path[i];
    return out->parameters && out->files ? out : NULL;
}
