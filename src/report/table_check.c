#include "report/report.h"

#include <math.h>
#include <string.h>

#include "base/base.h"
#include "rotor/rotor.h"

/* What an effect acts on, as its hooks tell; "" where that is the whole rotor. */
static void print_target(FILE *out, const struct rotor *rotor, const struct effect *effect)
{
    const struct effect_kind *kind = effect->kind;
    int target = effect->target;
    if (kind->spring && target >= 0 && target < rotor->nspring && rotor->spring[target].name)
        (void)fprintf(out, " at %s", rotor->spring[target].name);
    else if (kind->tierod && target >= 0 && target < rotor->ntierod && rotor->tierod[target].name)
        (void)fprintf(out, " at %s", rotor->tierod[target].name);
    else if (kind->joint && target >= 0 && target + 1 < rotor_axis_groups(rotor))
        (void)fprintf(out, " between %s and %s", rotor->group[target].name, rotor->group[target + 1].name);
    else if ((kind->field || kind->section) && target >= 0 && target < rotor->ngroup)
        (void)fprintf(out, " in %s", rotor->group[target].name);
}

static void print_effect(FILE *out, const struct rotor *rotor, const struct effect *effect, const char *role)
{
    name_cell(out, 12, effect->name);
    (void)fprintf(out, " %s, %s", role, effect->kind->id);
    print_target(out, rotor, effect);
    for (int p = 0; p < effect_parameters(effect); p++) {
        const struct effect_parameter_name *parameter = &effect->kind->parameter[p];
        (void)fprintf(out, ", %s %.6g%s%s", parameter->name, effect->value[p], strcmp(parameter->unit, "1") ? " " : "",
                      strcmp(parameter->unit, "1") ? parameter->unit : "");
    }
    (void)fputc('\n', out);
}

/* The CAUSE cards. */
static void print_causes(FILE *out, const struct job *job)
{
    if (job->rotor.neffect || job->measurement.ncorrection || job->unknowns.nsuspect)
        (void)fprintf(out, "\ncause\n");
    for (int i = 0; i < job->rotor.neffect; i++)
        print_effect(out, &job->rotor, &job->rotor.effect[i], "in the model");
    for (int i = 0; i < job->unknowns.nsuspect; i++)
        print_effect(out, &job->rotor, &job->unknowns.suspect[i].effect, "suspected");
    for (int i = 0; i < job->measurement.ncorrection; i++) {
        const struct correction *correction = &job->measurement.correction[i];
        name_cell(out, 12, correction->name);
        (void)fprintf(out, " taken out of the data, %s", correction->id);
        for (int s = 0; s < correction->nsensor; s++)
            (void)fprintf(out, "%s%d", s ? " and " : " of sensor ", correction->sensor[s]);
        (void)fprintf(out, "%s%s, value %.6g", correction->block ? " of " : "", correction->block ? correction->block : "",
                      correction->value);
        (void)fprintf(out, same_text(correction->id, "sensor_line") ? ", scale %.6g, flip %.6g\n" : "\n", correction->more[0],
                      correction->more[1]);
    }
}

static void print_solid(FILE *out, const rotid_solid_mesh *solid)
{
    (void)fprintf(out, "solid           %12d unknowns, half band %d, %d slices\n", solid->unknowns, solid->half_band,
                  solid->slices);
    if (isfinite(solid->corner_m))
        (void)fprintf(out, "corner element  %12.6f m, where the diameter steps\n", solid->corner_m);
    (void)fprintf(out, "largest element %12.6f m\n", solid->largest_m);
}

static void print_check(FILE *out, const rotid_check *check, const struct job *job)
{
    (void)fprintf(out, "length          %12.6f m\n", check->length_m);
    (void)fprintf(out, "mass            %12.4f kg\n", check->mass_kg);
    (void)fprintf(out, "centre of mass  %12.6f m from the left end\n", check->center_of_mass_m);
    (void)fprintf(out, "inertia         %12.4f kg.m2 about a diameter there\n", check->inertia_kg_m2);
    (void)fprintf(out, "mesh            %12d nodes, %d elements\n", check->nodes, check->elements);
    if (check->solid)
        print_solid(out, check->solid);
    (void)fprintf(out, "sensors         %12d\n", check->nsensors);
    (void)fprintf(out, "measured modes  %12d\n", check->measured_modes);
    (void)fprintf(out, "rigid-body modes%12d", check->rigid_modes);
    for (int i = 0; i < check->nrigid_hz; i++)
        (void)fprintf(out, "%s%.3f", i ? ", " : " (modes on the supports at ", check->rigid_hz[i]);
    (void)fprintf(out, "%s\n", check->nrigid_hz ? " Hz)" : "");
    (void)fprintf(out, "fit             %12s, reduction %s, %d parameter%s\n\n", check->functional, check->reduction,
                  check->nparameters, check->nparameters == 1 ? "" : "s");
    (void)fprintf(out, "group          from [m]     to [m]      E [Pa]      G [Pa]     nu   rho [kg/m3]\n");
    for (int g = 0; g < check->geometry->ngroups; g++) {
        const rotid_group *group = &check->geometry->groups[g];
        const rotid_material *material = &group->material;
        name_cell(out, 12, group->name);
        (void)fprintf(out, " %10.6f %10.6f  %10.4e  %10.4e  %5.3f  %12.2f%s%s\n", group->from_m, group->to_m, material->e_pa,
                      material->g_pa, material->nu, material->rho_kg_m3, group->layer_of ? "  on " : "",
                      group->layer_of ? group->layer_of : "");
    }
    print_causes(out, job);
}

void table_check(FILE *out, const struct result *result, const struct job *const *job)
{
    table_heading(out, &result->head);
    if (!result->nstates)
        print_check(out, result->check, job[0]);
    for (int s = 0; s < result->nstates; s++) {
        table_state(out, s, result->states[s].name);
        print_check(out, result->states[s].check, job[s]);
    }
}
