#include "hide_model.h"

#include <math.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;
static const double gravity = 9.81; /* m/s2, as in the deck's *SLING */

/* Three points of Gauss over a stretch: its mean compliance, which is what bends it as a whole, and its mean mass. */
static void average(const struct hide_physics *physics, int segment, double from, double to, struct oracle_segment *stretch)
{
    static const double abscissa[3] = {-0.774596669241483377, 0, 0.774596669241483377},
                        weight[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
    *stretch = (struct oracle_segment){.length = to - from};
    for (int i = 0; i < 3; i++) {
        struct hide_section s;
        hide_section_at(physics, segment, (from + to) / 2 + abscissa[i] * (to - from) / 2, &s);
        stretch->bending += weight[i] / s.bending;
        stretch->shear += weight[i] / s.shear;
        stretch->mass += weight[i] * s.mass;
        stretch->inertia += weight[i] * s.inertia;
    }
    stretch->bending = 1 / stretch->bending;
    stretch->shear = 1 / stretch->shear;
}

static double tension_factor(const struct hide_physics *physics, int tie)
{
    double factor = physics->ground;
    for (int i = 0; i < physics->effects; i++)
        if (hide_is(&physics->effect[i], "tie_tension") && hide_get(&physics->effect[i], "at")->index == tie)
            factor *= hide_get(&physics->effect[i], "factor")->number;
    return factor;
}

static int lay_segments(const struct hide_physics *physics, struct hide_model *model)
{
    const struct hide_rotor *rotor = physics->rotor;
    int count = 0, segment = 0;
    double *z = hide_cuts(physics, &count);
    model->segment = z ? calloc((size_t)count, sizeof *model->segment) : NULL;
    for (int i = 0; model->segment && i + 1 < count; i++) {
        double middle = (z[i] + z[i + 1]) / 2;
        while (segment + 1 < rotor->segments && middle > rotor->segment[segment].to)
            segment++;
        average(physics, segment, z[i], z[i + 1], &model->segment[i]);
        model->segment[i].axial = physics->ground * rotor->group[rotor->segment[segment].group].preload;
        for (int t = 0; t < rotor->ties; t++)
            if (rotor->tie[t].equilibrated && middle > rotor->tie[t].from && middle < rotor->tie[t].to)
                model->segment[i].axial -= rotor->tie[t].number * rotor->tie[t].tension * tension_factor(physics, t);
    }
    free(z);
    model->system.segment = model->segment;
    model->system.segments = count - 1;
    return model->segment != NULL;
}

static int lay_ties(const struct hide_physics *physics, struct hide_model *model)
{
    const struct hide_rotor *rotor = physics->rotor;
    for (int t = 0; t < rotor->ties; t++) {
        const struct hide_tie *tie = &rotor->tie[t];
        struct oracle_parallel *parallel = &model->parallel[t];
        struct oracle_tie rods = {
            tie->number,     tie->diameter,    tie->pitch,        tie->to - tie->from,
            tie->material.e, tie->material.nu, tie->material.rho, tie->tension * tension_factor(physics, t)};
        int tube = tie->tube;
        for (int i = 0; i < physics->effects; i++) {
            const struct hide_effect *e = &physics->effect[i];
            if (hide_get(e, "at")->index != t)
                continue;
            if (hide_is(e, "tie_stiffness"))
                rods.young *= hide_get(e, "factor")->number;
            if (hide_is(e, "tie_shear"))
                tube = 0;
        }
        *parallel = (struct oracle_parallel){.z_a = tie->from, .z_b = tie->to};
        if ((tube ? oracle_tie_tube : oracle_tie_rods)(&rods, parallel->stiffness, parallel->mass))
            return 0;
    }
    model->system.parallel = model->parallel;
    model->system.parallels = rotor->ties;
    return 1;
}

static void add_point(struct hide_model *model, struct oracle_point point)
{
    model->point[model->system.points++] = point;
}

/* (44) of the paper, with the mass and centre of mass of the rotor as it hangs */
static void add_sling(const struct hide_physics *physics, struct hide_model *model)
{
    const struct hide_rotor *rotor = physics->rotor;
    double mass = 0, moment = 0, z = 0, length = rotor->length;
    for (int i = 0; i < model->system.segments; i++) {
        const struct oracle_segment *s = &model->segment[i];
        mass += s->mass * s->length;
        moment += s->mass * s->length * (z + s->length / 2);
        z += s->length;
    }
    for (int i = 0; i < rotor->ties; i++) {
        const struct hide_tie *tie = &rotor->tie[i];
        double rods = tie->material.rho * tie->number * pi / 4 * tie->diameter * tie->diameter * (tie->to - tie->from);
        mass += rods;
        moment += rods * (tie->from + tie->to) / 2;
    }
    for (int i = 0; i < rotor->disks; i++) {
        mass += rotor->disk[i].mass;
        moment += rotor->disk[i].mass * rotor->disk[i].z;
    }
    double weight = physics->ground * mass * gravity, center = moment / mass;
    add_point(model, (struct oracle_point){.z = 0, .spring = weight / rotor->sling});
    add_point(model, (struct oracle_point){.z = length, .spring = weight * center / (length * length + center * rotor->sling)});
}

/* A massless hinge. What is attached at its place, tie rods included, goes on turning with the outer side: the hinge is on the
 * inner side of rods that end there. */
static void add_joint(const struct hide_physics *physics, const struct hide_effect *e, struct hide_model *model)
{
    const struct hide_rotor *rotor = physics->rotor;
    double z = hide_get(e, "at")->number, margin = 1e-6 * rotor->length;
    int side = ORACLE_RIGHT;
    for (int t = rotor->ties - 1; t >= 0; t--) /* the first of the deck has the last word */
        side = fabs(rotor->tie[t].from - z) <= margin ? ORACLE_LEFT : fabs(rotor->tie[t].to - z) <= margin ? ORACLE_RIGHT : side;
    for (int t = 0; t < rotor->ties; t++) {
        if (fabs(rotor->tie[t].from - z) <= margin)
            model->parallel[t].side_a = side;
        if (fabs(rotor->tie[t].to - z) <= margin)
            model->parallel[t].side_b = side;
    }
    for (int i = 0; i < model->system.points; i++)
        if (fabs(model->point[i].z - z) <= margin)
            model->point[i].side = side;
    add_point(model, (struct oracle_point){.z = z, .flexibility = hide_get(e, "flexibility")->number});
}

static void add_effect(const struct hide_physics *physics, const struct hide_effect *e, struct hide_model *model)
{
    double z = hide_get(e, "z")->number, k = physics->ground * hide_get(e, "stiffness")->number;
    if (hide_is(e, "added_mass") && hide_get(e, "width")->number == 0) /* else it is spread: hide_section.c */
        add_point(model,
                  (struct oracle_point){.z = z, .mass = hide_get(e, "mass")->number, .inertia = hide_get(e, "inertia")->number});
    else if (hide_is(e, "accelerometer_mass") && hide_get(e, "mount")->index == 0)
        add_point(model, (struct oracle_point){.z = physics->rotor->sensor[hide_get(e, "sensor")->index].z,
                                               .mass = hide_get(e, "mass")->number});
    else if (hide_is(e, "support_extra"))
        add_point(model, (struct oracle_point){.z = z, .spring = k});
    else if (hide_is(e, "support_rotation"))
        add_point(model, (struct oracle_point){.z = z, .rotational_spring = k});
    else if (hide_is(e, "inertia"))
        add_point(model, (struct oracle_point){.z = z, .inertia = hide_get(e, "inertia")->number});
}

/* A spring as it is: stiffer, on a clamp that gives way, elsewhere. */
static struct oracle_point spring_at(const struct hide_physics *physics, int i)
{
    const struct hide_spring *spring = &physics->rotor->spring[i];
    struct oracle_point point = {.z = spring->z, .spring = spring->lateral, .rotational_spring = spring->rotational};
    double lateral = 0, rotational = 0;
    for (int j = 0; j < physics->effects; j++) {
        const struct hide_effect *e = &physics->effect[j];
        if (hide_get(e, "at")->index != i)
            continue;
        if (hide_is(e, "support")) {
            point.spring *= hide_get(e, "factor")->number;
            point.rotational_spring *= hide_get(e, "factor")->number;
        } else if (hide_is(e, "support_position"))
            point.z += hide_get(e, "shift")->number;
        else if (hide_is(e, "clamp")) {
            lateral += hide_get(e, "lateral")->number;
            rotational += hide_get(e, "rotational")->number;
        }
    }
    if (point.spring > 0)
        point.spring = physics->ground / (1 / point.spring + lateral);
    if (point.rotational_spring > 0)
        point.rotational_spring = physics->ground / (1 / point.rotational_spring + rotational);
    return point;
}

static void lay_points(const struct hide_physics *physics, struct hide_model *model)
{
    const struct hide_rotor *rotor = physics->rotor;
    for (int i = 0; i < rotor->disks; i++) {
        struct oracle_point point = {.z = rotor->disk[i].z, .mass = rotor->disk[i].mass, .inertia = rotor->disk[i].inertia};
        for (int j = 0; j < physics->effects; j++)
            if (hide_is(&physics->effect[j], "added_inertia") && hide_get(&physics->effect[j], "at")->index == i)
                point.inertia += hide_get(&physics->effect[j], "inertia")->number;
        add_point(model, point);
    }
    if (physics->moving)
        add_point(model, (struct oracle_point){.z = physics->moving->z, .mass = physics->moving->mass});
    for (int i = 0; i < rotor->springs; i++)
        add_point(model, spring_at(physics, i));
    if (rotor->sling > 0)
        add_sling(physics, model);
    for (int i = 0; i < physics->effects; i++)
        add_effect(physics, &physics->effect[i], model);
    for (int i = 0; i < physics->effects; i++) /* last: they turn over what stands at their place */
        if (hide_is(&physics->effect[i], "joint"))
            add_joint(physics, &physics->effect[i], model);
    model->system.point = model->point;
}

int hide_model_open(const struct hide_physics *physics, struct hide_model *model, const struct hide_message *message)
{
    const struct hide_rotor *rotor = physics->rotor;
    *model = (struct hide_model){.segment = NULL};
    model->point = calloc((size_t)(rotor->disks + rotor->springs + physics->effects) + 3, sizeof *model->point);
    if (!model->point || !lay_segments(physics, model))
        return hide_fail(message, HIDE_FAILURE, "no memory for the model");
    if (!lay_ties(physics, model))
        return hide_fail(message, HIDE_INPUT, "tie rods make no tube, expected a pitch radius that keeps it hollow");
    lay_points(physics, model);
    return HIDE_OK;
}

void hide_model_close(struct hide_model *model)
{
    free(model->segment);
    free(model->point);
}
