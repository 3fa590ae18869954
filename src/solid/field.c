#include "solid/field.h"

#include <math.h>

#include "rotor/effects.h"
#include "rotor/section.h"

static const double pi = 3.14159265358979323846;

static struct effect_span span_of(const struct solid *solid, const struct solid_element *element, int share)
{
    struct effect_span span = {.group = element->group, .segment = element->segment};
    integrals_share_span(solid->mesh.z[element->slice], solid->mesh.z[element->slice + 1], share, &span.from, &span.to);
    return span;
}

static double middle_of(const struct solid *solid, const struct solid_element *element)
{
    return (solid->mesh.z[element->slice] + solid->mesh.z[element->slice + 1]) / 2;
}

/* ---- joints: the slice beside the interface, on the side that is thinner, is the softer along the axis by the flexibility c of
 * a rotational spring, 1/E := 1/E + c I/t,  I of its section, t its length. On the thicker side the parts around it would hold
 * it. */

static double outer_radius(const struct solid_mesh *mesh, int slice)
{
    return mesh->node[mesh->element[solid_mesh_outermost(mesh, slice)].node[1]].r;
}

/* Whether the joint of an effect is in this slice. */
static int joint_in(const struct solid *solid, const struct effect *effect, int slice)
{
    const struct solid_mesh *mesh = &solid->mesh;
    const struct rotor *rotor = &solid->rotor;
    if (!effect->kind->joint)
        return 0;
    for (int left = slice > 0 ? slice - 1 : 0; left <= slice && left + 1 < mesh->nslice; left++)
        if (rotor->segment[mesh->segment[left]].group == effect->target &&
            rotor->segment[mesh->segment[left + 1]].group != effect->target)
            return slice == left + (outer_radius(mesh, left + 1) < outer_radius(mesh, left));
    return 0;
}

/* I/t of a slice */
static double inertia_over_length(const struct solid *solid, int slice)
{
    const struct solid_mesh *mesh = &solid->mesh;
    double inner = mesh->node[mesh->element[mesh->first[slice]].node[0]].r;
    return pi / 4 * (pow(outer_radius(mesh, slice), 4) - pow(inner, 4)) / (mesh->z[slice + 1] - mesh->z[slice]);
}

/* c I/t, or its derivative with respect to a parameter of an effect */
static double joint_compliance(const struct solid *solid, int slice, int effect, int p)
{
    double sum = 0, flexibility;
    for (int i = 0; i < solid->rotor.neffect; i++) {
        const struct effect *e = &solid->rotor.effect[i];
        if ((effect < 0 || effect == i) && joint_in(solid, e, slice) && e->kind->joint(e, &solid->rotor, p, &flexibility))
            sum += flexibility;
    }
    return sum == 0 ? 0 : sum * inertia_over_length(solid, slice);
}

static struct elasticity_factors factors_of(const struct solid *solid, const struct solid_element *element, int share,
                                            double *rho)
{
    struct effect_field field = {1, 1, 1};
    double axial = 1;
    if (solid->rotor.neffect) {
        struct effect_span span = span_of(solid, element, share);
        field = effects_on_axis(&solid->rotor, &span, 0);
        double e = solid->rotor.group[element->group].material.e * field.e;
        axial = 1 / (1 + e * joint_compliance(solid, element->slice, -1, -1));
    }
    *rho = field.rho;
    return (struct elasticity_factors){field.e, field.g, axial};
}

/* ---- axial stress: the force on a section is shared in proportion to E */

static double stiff_area(const struct solid *solid, int segment, int group)
{
    const struct rotor *rotor = &solid->rotor;
    struct section section;
    double area = 0;
    if (rotor->segment[segment].group == group && !section_of_segment(rotor, segment, &section))
        area = section.stiff_area;
    for (int i = 0; i < rotor->nring; i++)
        if (rotor->ring[i].segment == segment && rotor->ring[i].group == group && !section_of_ring(rotor, i, &section))
            area += section.stiff_area;
    return area;
}

/* E over the sum of E A, and its derivative with respect to the E that `by` is, of one group or several */
static double share_of_force(const struct solid *solid, const struct solid_element *element, const struct parameter *by,
                             double *derivative)
{
    const struct rotor *rotor = &solid->rotor;
    double sum = 0, of = 0, e = rotor->group[element->group].material.e;
    for (int g = 0; g < rotor->ngroup; g++) {
        double area = stiff_area(solid, element->segment, g);
        sum += rotor->group[g].material.e * area;
        of += by && parameter_is_of_group(by, g) ? area : 0;
    }
    if (derivative)
        *derivative = (parameter_is_of_group(by, element->group) - e * of / sum) / sum;
    return e / sum;
}

static double axial_force(const struct solid *solid, const struct solid_element *element)
{
    return rotor_axial_force(&solid->rotor, solid->rotor.segment[element->segment].group, middle_of(solid, element));
}

void field_of_share(const struct solid *solid, const struct solid_element *element, int share, struct share *out)
{
    const struct material *material = &solid->rotor.group[element->group].material;
    double rho;
    struct elasticity_factors factors = factors_of(solid, element, share, &rho);
    *out = (struct share){.elasticity = elasticity_of(material, &factors), .rho = material->rho * rho};
    double force = solid->elastic_only ? 0 : axial_force(solid, element);
    if (force != 0)
        out->stress = force * share_of_force(solid, element, NULL, NULL);
}

/* ---- derivatives */

static void add_elasticity(struct elasticity *sum, const struct elasticity *d)
{
    *sum = (struct elasticity){sum->c11 + d->c11, sum->c12 + d->c12, sum->c13 + d->c13,
                               sum->c33 + d->c33, sum->c44 + d->c44, sum->c66 + d->c66};
}

static int by_material(const struct solid *solid, const struct solid_element *element, int share, struct parameter parameter,
                       struct share *rate)
{
    const struct material *material = &solid->rotor.group[element->group].material;
    double rho, force = parameter.kind == PARAMETER_E ? axial_force(solid, element) : 0, derivative;
    if (force != 0) {
        (void)share_of_force(solid, element, &parameter, &derivative);
        rate->stress = force * derivative;
    }
    if (!parameter_is_of_group(&parameter, element->group))
        return rate->stress != 0;
    struct elasticity_factors factors = factors_of(solid, element, share, &rho);
    if (parameter.kind == PARAMETER_RHO) {
        rate->rho = rho;
        return 1;
    }
    rate->elasticity = elasticity_by_material(material, &factors, parameter.kind);
    if (parameter.kind == PARAMETER_E && factors.axial != 1) { /* f = 1/(1 + E c I/t): df/dE = -f (1 - f)/E */
        struct elasticity_factors d = {0, 0, -factors.axial * (1 - factors.axial) / material->e};
        struct elasticity more = elasticity_by_factors(material, &factors, &d);
        add_elasticity(&rate->elasticity, &more);
    }
    return 1;
}

static int by_effect(const struct solid *solid, const struct solid_element *element, int share, struct parameter parameter,
                     struct share *rate)
{
    const struct material *material = &solid->rotor.group[element->group].material;
    struct effect_span span = span_of(solid, element, share);
    struct effect_field relative = {0, 0, 0};
    double rho, force = rotor_axial_force_derivative(&solid->rotor, parameter, middle_of(solid, element));
    if (force != 0)
        rate->stress = force * share_of_force(solid, element, NULL, NULL);
    int moves = effects_axis_rate(&solid->rotor, parameter, &span, 0, &relative);
    double compliance = joint_compliance(solid, element->slice, parameter.index, parameter.component);
    if (!moves && compliance == 0)
        return rate->stress != 0;
    struct elasticity_factors f = factors_of(solid, element, share, &rho);
    struct elasticity_factors d = {f.e * relative.e, f.g * relative.g,
                                   -f.axial * (1 - f.axial) * relative.e - f.axial * f.axial * material->e * f.e * compliance};
    rate->elasticity = elasticity_by_factors(material, &f, &d);
    rate->rho = material->rho * rho * relative.rho;
    return 1;
}

int field_derivative(const struct solid *solid, const struct solid_element *element, int share, struct parameter parameter,
                     struct share *rate)
{
    *rate = (struct share){0};
    if (parameter.kind == PARAMETER_EFFECT)
        return by_effect(solid, element, share, parameter, rate);
    if (parameter.kind == PARAMETER_TENSION) {
        double force = rotor_axial_force_derivative(&solid->rotor, parameter, middle_of(solid, element));
        rate->stress = force == 0 ? 0 : force * share_of_force(solid, element, NULL, NULL);
        return force != 0;
    }
    return parameter.kind <= PARAMETER_RHO ? by_material(solid, element, share, parameter, rate) : 0;
}
