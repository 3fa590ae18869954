#include "report/json.h"

#include "report/json_geometry.h"
#include "report/json_identify.h"
#include "report/json_result.h"

char *json_check(const struct provenance *provenance, const struct job *job, const struct mass_properties *mass,
                 const struct spectrum *spectrum, const struct message_list *notes)
{
    const struct rotor *rotor = &job->rotor;
    struct json_tree tree;
    json_begin(&tree, provenance, job);
    cJSON *root = tree.root, *sensors, *parameters;
    json_number(&tree, root, "length_m", rotor_length(rotor));
    json_number(&tree, root, "mass_kg", mass->mass);
    json_number(&tree, root, "center_of_mass_m", mass->center);
    json_number(&tree, root, "inertia_kg_m2", mass->inertia);
    json_number(&tree, root, "nodes", spectrum->nnode);
    json_number(&tree, root, "elements", spectrum->nnode - 1);
    json_number(&tree, root, "rigid_modes", spectrum->nrigid);
    json_list(&tree, root, "rigid_hz", spectrum->nrigid, spectrum->rigid_hz);
    json_number(&tree, root, "measured_modes", job->nmode);
    json_text(&tree, root, "functional", functional_name(job->fit.functional));
    json_text(&tree, root, "reduction", reduction_name(job->fit.reduction));
    sensors = json_array(&tree, root, "sensors");
    for (int s = 0; s < rotor->nsensor; s++) {
        cJSON *item = json_object(&tree, sensors, NULL);
        json_number(&tree, item, "id", rotor->sensor[s].id);
        json_number(&tree, item, "z_m", rotor->sensor[s].position);
    }
    parameters = json_array(&tree, root, "parameters");
    for (int p = 0; p < job->nparameter; p++)
        json_text(&tree, parameters, NULL, job->bounds[p].name);
    json_geometry(&tree, job, spectrum);
    json_notes(&tree, notes);
    return json_close(&tree);
}

char *json_modes(const struct provenance *provenance, const struct job *job, const struct spectrum *s,
                 const struct comparison *compared, const struct message_list *notes)
{
    struct json_tree tree;
    json_begin(&tree, provenance, job);
    json_text(&tree, tree.root, "reduction", job->fit.reduction == ROTID_IRS ? "IRS" : "GUYAN");
    json_list(&tree, tree.root, "rigid_hz", s->nrigid, s->rigid_hz);
    json_list(&tree, tree.root, "sensor_z_m", s->nmaster, s->master_z);
    cJSON *modes = json_array(&tree, tree.root, "modes");
    for (int j = 0; j < s->count; j++) {
        cJSON *item = json_object(&tree, modes, NULL);
        json_number(&tree, item, "mode", j + 1);
        json_number(&tree, item, "full_hz", s->full_hz[j]);
        json_number(&tree, item, "reduced_hz", s->reduced_hz[j]);
        json_number(&tree, item, "reduction_error_percent", s->reduction_error_percent[j]);
        json_number(&tree, item, "mesh_error_percent", s->mesh_error_percent[j]);
        json_list(&tree, item, "shape", s->nmaster, s->shape + (ptrdiff_t)j * s->nmaster);
        for (int k = 0; k < compared->nmode; k++)
            if (compared->number[k] == j + 1)
                json_measured_mode(&tree, item, job, compared, k, s->full_hz[j]);
    }
    json_geometry(&tree, job, s);
    json_notes(&tree, notes);
    return json_close(&tree);
}

char *json_sensitivity(const struct provenance *provenance, const struct job *job, const struct sensitivity *sensitivity)
{
    struct pool pool;
    struct result result = {.sensitivity = sensitivity};
    pool_open(&pool, NULL);
    return json_result(&pool, provenance, job, NULL, &result);
}
