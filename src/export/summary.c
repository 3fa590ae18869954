#include "export/summary.h"

#include <math.h>
#include <string.h>

#include "report/layout.h"
#include "report/table.h"
#include "result/json_tree.h"

const double *export_exported_hz(const struct export_files *files, const struct export_model *model,
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

void table_export(FILE *out, const struct export_files *files, const struct export_model *model, const struct ross_model *ross)
{
    const struct job *job = model->job;
    const struct spectrum *s = &model->spectrum;
    int count;
    const double *hz = export_exported_hz(files, model, ross, &count);
    table_job_heading(out, job);
    (void)fprintf(out,
                  model->identified ? "model           identified from %d measured modes\n"
                                    : "model           as the deck states it\n",
                  job->nmode);
    for (int p = 0; p < job->nparameter; p++) {
        double std = export_parameter_std(model, p);
        name_cell(out, 15, job->bounds[p].name);
        (void)fprintf(out, " %.6g %s", export_parameter(model, p), job->bounds[p].unit);
        if (isfinite(std))
            (void)fprintf(out, ", standard deviation %.3g", std);
        (void)fputc('\n', out);
    }
    (void)fprintf(out, "mass            %.4f kg, centre at %.6f m\n", model->mass.mass, model->mass.center);
    (void)fprintf(out, "matrices        %d nodes, %d degrees of freedom\n", model->k.n / 2, model->k.n);
    if (model->condensed.k)
        (void)fprintf(out, "condensed       by %s onto %d %s\n", reduction_name(model->condensed.kind), model->condensed.count,
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

static void add_parameters(struct json_tree *tree, const struct export_model *model)
{
    const struct job *job = model->job;
    cJSON *list = json_array(tree, tree->root, "parameters");
    for (int p = 0; p < job->nparameter; p++) {
        cJSON *item = json_object(tree, list, NULL);
        json_text(tree, item, "name", job->bounds[p].name);
        json_text(tree, item, "unit", job->bounds[p].unit);
        json_number(tree, item, "value", export_parameter(model, p));
        json_number(tree, item, "std", export_parameter_std(model, p));
    }
}

char *json_export(const struct provenance *provenance, const struct export_files *files, const struct export_model *model,
                  const struct ross_model *ross, const struct message_list *notes)
{
    const struct spectrum *s = &model->spectrum;
    struct json_tree tree;
    int count;
    const double *hz = export_exported_hz(files, model, ross, &count);
    json_begin(&tree, provenance, model->job);
    json_text(&tree, tree.root, "format", export_format_name(files->format));
    cJSON *list = json_array(&tree, tree.root, "files");
    for (int i = 0; i < files->count; i++)
        json_text(&tree, list, NULL, files->path[i]);
    json_text(&tree, tree.root, "model", model->identified ? "identified" : "stated");
    json_text(&tree, tree.root, "status", state_of(model));
    add_parameters(&tree, model);
    json_number(&tree, tree.root, "mass_kg", model->mass.mass);
    json_number(&tree, tree.root, "center_of_mass_m", model->mass.center);
    json_number(&tree, tree.root, "nodes", model->discrete->beam.mesh.nnode);
    json_number(&tree, tree.root, "degrees_of_freedom", model->k.n);
    json_text(&tree, tree.root, "reduction", model->condensed.k ? reduction_name(model->condensed.kind) : NULL);
    json_number(&tree, tree.root, "masters", model->condensed.k ? (double)model->condensed.count : NAN);
    json_list(&tree, tree.root, "rigid_hz", s->nrigid, s->rigid_hz);
    json_list(&tree, tree.root, "full_hz", s->count, s->full_hz);
    json_list(&tree, tree.root, "exported_hz", count, hz);
    json_notes(&tree, notes);
    return json_close(&tree);
}
