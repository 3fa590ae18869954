/* Torsion and axial motion on the mesh of a beam. */
#include "beam/beam.h"
#include "linalg/linalg.h"

static void add_between(rotid_matrix *a, int first, int second, const double *e)
{
    const int dof[2] = {first, second};
    matrix_add_element(a, 2, dof, e);
}

static void add_bar(const struct bar *bar, double length, int first, int second, rotid_matrix *k, rotid_matrix *m)
{
    double c = bar->stiffness / length, j = bar->mass * length / 6;
    add_between(k, first, second, (const double[]){c, -c, -c, c});
    add_between(m, first, second, (const double[]){2 * j, j, j, 2 * j});
}

/* What a material with these moduli and density adds; f: NULL, or the factors of effects */
static void add_part(const struct beam *beam, const struct material *of, const struct section *section,
                     const struct effect_field *f, struct bar *sum)
{
    int twist = beam->type == MODE_TORSION;
    sum->stiffness += twist ? of->g * section->torsion * (f ? f->g : 1) : of->e * section->stiff_area * (f ? f->e : 1);
    sum->mass += of->rho * (twist ? section->polar : section->mass_area) * (f ? f->rho : 1);
}

/* sum I_p/sum S of the stiff parts of an element, by which an axial force stiffens torsion (Wagner): the fibres at a distance r
 * pull with r^2 dS, also in a rectangle, whose Saint-Venant constant is far below I_p where it is thin */
static double fibres(const struct beam *beam, int e)
{
    const struct section_part *part;
    struct effect_field *factor;
    double polar = 0, area = 0;
    if (beam->type != MODE_TORSION || beam->elastic_only)
        return 0;
    for (int i = 0, count = factors_parts(beam, e, &part, &factor); i < count; i++) {
        const struct section *section = &part[i].section;
        polar += section->rectangular ? section->polar : section->torsion;
        area += section->stiff_area;
    }
    return polar / area;
}

/* What bonded parts add to the sum of their ES; its derivatives stand in beam->layer then. 0 in torsion */
static double contraction(const struct beam *beam, int e)
{
    return beam->type == MODE_AXIAL ? contraction_stiffness(MODE_AXIAL, factors_layers(beam, e), beam->layer) : 0;
}

static struct bar axis_bar(const struct beam *beam, int e)
{
    const struct rotor *rotor = &beam->rotor;
    const struct section_part *part;
    struct effect_field *factor;
    int count = factors_parts(beam, e, &part, &factor), group = rotor->segment[beam->mesh.segment[e]].group;
    double pull = fibres(beam, e);
    struct bar bar = {.stiffness = pull != 0 ? pull * rotor_axial_force(rotor, group, mesh_middle(&beam->mesh, e), 0)
                                             : contraction(beam, e)};
    for (int i = 0; i < count; i++) {
        struct material material = rotor->group[part[i].group].material;
        material.g = material_shear_modulus(&material);
        add_part(beam, &material, &part[i].section, factor ? &factor[i] : NULL, &bar);
    }
    return bar;
}

/* The stiffness of the parts is of degree 1 in its modulus, the mass in rho: the derivative of a sum is the sum with the
 * derivatives of these in their place. */
static struct bar axis_direction_of(const struct beam *beam, struct parameter parameter, int e)
{
    const struct section_part *part;
    struct effect_field *factor;
    struct bar d = {0, 0, 0};
    int count = factors_parts(beam, e, &part, &factor);
    (void)contraction(beam, e);
    for (int i = 0; i < count; i++) {
        const struct material *own = &beam->rotor.group[part[i].group].material;
        struct material material = *own;
        struct effect_field f = factor ? factor[i] : (struct effect_field){1, 1, 1}, rate;
        struct shear_material v;
        if (parameter.kind == PARAMETER_EFFECT) {
            struct effect_span span = factors_span(beam, e, &part[i]);
            if (!effects_axis_rate(&beam->rotor, parameter, &span, 0, &rate))
                continue;
            f = (struct effect_field){f.e * rate.e, f.g * rate.g, f.rho * rate.rho};
            material.g = material_shear_modulus(&material);
            v = shear_material_rate(own, f.e, f.g);
        } else if (parameter.kind <= PARAMETER_RHO && parameter_is_of_group(&parameter, part[i].group)) {
            v = shear_material_derivative(own, parameter.kind);
            material.g = v.g;
            shear_material_scale(own, f.e, f.g, &v);
            material.e = parameter.kind == PARAMETER_E;
            material.rho = parameter.kind == PARAMETER_RHO;
        } else {
            continue;
        }
        add_part(beam, &material, &part[i].section, &f, &d);
        d.stiffness += beam->type == MODE_AXIAL ? shear_material_product(&beam->layer[i].contraction, &v) : 0;
    }
    double pull = fibres(beam, e);
    if (pull != 0)
        d.stiffness += pull * rotor_axial_force_derivative(&beam->rotor, parameter, mesh_middle(&beam->mesh, e), 0);
    return d;
}

static struct bar tierod_bar(const struct beam *beam, int i, const struct parameter *by)
{
    const struct chain *chain = &beam->mesh.tierod[i];
    double length = beam->mesh.z[chain->last_end] - beam->mesh.z[chain->first_end];
    return by ? bundle_of_tierod_by(&beam->rotor, beam->type, beam->elastic_only, i, length, *by)
              : bundle_of_tierod(&beam->rotor, beam->type, beam->elastic_only, i, length);
}

/* What a mass of an effect adds to its element: as a ring of the surface, like that of a solid */
static double point_inertia(const struct beam *beam, int e, const struct effect_point *point)
{
    double outer, inner;
    if (beam->type == MODE_AXIAL)
        return point->mass;
    if (beam->rotor.segment[beam->mesh.segment[e]].rectangular)
        return 0;
    rotor_diameters(&beam->rotor, beam->mesh.segment[e], &outer, &inner);
    return point->mass * outer * outer / 4;
}

/* m += M of the masses of effects, or its derivative where there is a parameter */
static void add_points(const struct beam *beam, const struct parameter *parameter, rotid_matrix *m)
{
    const struct rotor *rotor = &beam->rotor;
    for (struct lumped lumped = {.i = -1}; rotor->neffect && lumped_next(beam, &lumped) && lumped.effect < rotor->neffect;) {
        int e = lumped.element;
        double left = beam->mesh.z[e], length = beam->mesh.z[e + 1] - left, x = (lumped.point.z - left) / length, dx = 0,
               value = point_inertia(beam, e, &lumped.point), dvalue = value;
        if (parameter) {
            const struct effect *effect = &rotor->effect[lumped.effect];
            struct effect_point rate = {.z = 0};
            if (parameter->kind != PARAMETER_EFFECT || parameter->index != lumped.effect ||
                !effect->kind->point(effect, rotor, lumped.i, parameter->component, &rate))
                continue;
            dx = lumped.clamped ? 0 : rate.z / length;
            dvalue = point_inertia(beam, e, &rate);
        }
        const double b[2] = {1 - x, x}, db[2] = {-dx, dx};
        double em[4];
        for (int i = 0; i < 4; i++)
            em[i] = dvalue * b[i % 2] * b[i / 2] + value * (db[i % 2] * b[i / 2] + b[i % 2] * db[i / 2]);
        add_between(m, e, e + 1, em);
    }
}

int bar_open(struct pool *pool, enum mode_type type, struct beam *beam)
{
    struct mesh *mesh = &beam->mesh;
    int *far = POOL_ARRAY(pool, int, mesh->naxis), count = 0;
    if (!far)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < beam->rotor.ntierod; i++)
        far[mesh->tierod[i].first_end] = far[mesh->tierod[i].last_end] = 1;
    for (int node = 0; node < mesh->naxis; node++)
        if (far[node])
            far[count++] = node;
    beam->type = type;
    mesh->nfar = count;
    mesh->far = far;
    mesh->ndof = mesh->naxis;
    mesh->kd = 1;
    factors_refresh(beam);
    return ROTID_OK;
}

void bar_assemble(struct beam *beam, const double *x, rotid_matrix *k, rotid_matrix *m)
{
    const struct mesh *mesh = &beam->mesh;
    const struct rotor *rotor = &beam->rotor;
    int twist = beam->type == MODE_TORSION;
    beam_set(beam, x);
    for (int e = 0; e < mesh->nelement; e++) {
        struct bar bar = axis_bar(beam, e);
        add_bar(&bar, mesh->z[e + 1] - mesh->z[e], e, e + 1, k, m);
    }
    for (int i = 0; i < rotor->ntierod; i++) {
        struct bar bar = tierod_bar(beam, i, NULL);
        add_bar(&bar, bar.length, mesh->tierod[i].first_end, mesh->tierod[i].last_end, k, m);
    }
    for (int i = 0; i < rotor->nbars; i++) {
        int node = mesh->bars[2 * (ptrdiff_t)i].first_end;
        matrix_add(m, node, node, bundle_of_bars(rotor, beam->type, i));
    }
    for (int i = 0; i < rotor->ndisk; i++)
        matrix_add(m, mesh->disk_node[i], mesh->disk_node[i], twist ? rotor->disk[i].polar : rotor->disk[i].mass);
    for (int i = 0; i < rotor->nspring && !beam->elastic_only; i++)
        matrix_add(k, mesh->spring_node[i], mesh->spring_node[i], twist ? rotor->spring[i].torsional : rotor->spring[i].axial);
    add_points(beam, NULL, m);
}

void bar_differentiate(const struct beam *beam, int p, rotid_matrix *dk, rotid_matrix *dm)
{
    const struct mesh *mesh = &beam->mesh;
    struct parameter parameter = beam->parameter[p];
    for (int e = 0; e < mesh->nelement; e++) {
        struct bar d = axis_direction_of(beam, parameter, e);
        if (d.stiffness != 0 || d.mass != 0)
            add_bar(&d, mesh->z[e + 1] - mesh->z[e], e, e + 1, dk, dm);
    }
    for (int i = 0; i < beam->rotor.ntierod; i++) {
        struct bar d = tierod_bar(beam, i, &parameter);
        add_bar(&d, d.length, mesh->tierod[i].first_end, mesh->tierod[i].last_end, dk, dm);
    }
    if (parameter.kind == PARAMETER_DISK_MASS && beam->type == MODE_AXIAL)
        matrix_add(dm, mesh->disk_node[parameter.index], mesh->disk_node[parameter.index], 1);
    add_points(beam, &parameter, dm);
}

void bar_member_motion(const struct beam *beam, int member, const double *u, int npoint, double *z, double *v)
{
    const struct rotor *rotor = &beam->rotor;
    const struct mesh *mesh = &beam->mesh;
    int bars = member - rotor->ntierod;
    const struct chain *chain = bars < 0 ? &mesh->tierod[member] : &mesh->bars[2 * (ptrdiff_t)bars];
    double half = bars < 0 ? 0 : rotor->bars[bars].length / 2, from = mesh->z[chain->first_end] - half,
           to = bars < 0 ? mesh->z[chain->last_end] : from + 2 * half, first = u[chain->first_end],
           last = bars < 0 ? u[chain->last_end] : first;
    for (int i = 0; i < npoint; i++) {
        double x = (double)i / (npoint - 1);
        z[i] = from + (to - from) * x;
        v[i] = first + (last - first) * x;
    }
}
