/* Behind a step of the diameter the corners of the larger part carry nothing: stress spreads into it in a cone that opens from
 * the smaller diameter at the step. The stiffness diameter is
 *
 *     D(z) = min(own stiffness diameter, min over all steps of d_small + 2 |z - z_step| tan(angle))
 *
 * over as many sections as the cone reaches; mass, bores, holes and rectangular parts stay. A section with layers steps at its
 * outermost diameter, and the cone cuts off each of its rings as far as they lie outside. The shear coefficient is Cowper's of
 * the annulus inside D(z): beside a bore of a quarter of the own diameter it falls by 12 % where the cone leaves 0.64 of that.
 * That of a section with layers stays. */
#include "diagnose/causes/causes.h"

#define STEPS_AT_ONCE 64 /* that reach into one element: those farther to the right are left out, which no real rotor has */

struct step {
    double z, diameter; /* m; the smaller one of the two */
};

/* Where the cone cuts into the bore, or into a ring of holes, less than nothing would be left: share of the wall that carries at
 * least, and of the area and inertia that the section with its holes has of a full disc. */
static const double least_wall = 0.1, least_share = 0.02;

static int is_step(const struct rotor *rotor, int s, double *left, double *right)
{
    double inner;
    rotor_diameters(rotor, s, left, &inner);
    rotor_diameters(rotor, s + 1, right, &inner);
    return !rotor->segment[s].rectangular && !rotor->segment[s + 1].rectangular && *left != *right;
}

/* The segment with the diameters of the part that belongs to the group. */
static struct segment part_of(const struct rotor *rotor, int segment, int group)
{
    struct segment part = rotor->segment[segment];
    for (int i = 0; i < rotor->nring; i++)
        if (rotor->ring[i].segment == segment && rotor->ring[i].group == group) {
            part.outer = part.stiff_outer = rotor->ring[i].outer;
            part.inner = rotor->ring[i].inner;
        }
    return part;
}

/* Steps whose cone may reach below `diameter` somewhere in [from, to]. */
static int reaching_steps(const struct rotor *rotor, double from, double to, double diameter, double tangent, struct step *step)
{
    int count = 0;
    double z = 0, left, right;
    for (int s = 0; s + 1 < rotor->nsegment && count < STEPS_AT_ONCE; s++) {
        z += rotor->segment[s].length;
        if (!is_step(rotor, s, &left, &right))
            continue;
        double small = fmin(left, right), away = fmax(0, fmax(from - z, z - to));
        if (small + 2 * away * tangent < diameter)
            step[count++] = (struct step){z, small};
    }
    return count;
}

/* D(z), with its derivative with respect to the tangent. */
static double envelope(int count, const struct step *step, const struct segment *segment, double z, double tangent, double *slope)
{
    double diameter = segment->stiff_outer;
    double least = segment->inner > 0 ? segment->inner + least_wall * (diameter - segment->inner) : 0;
    *slope = 0;
    for (int i = 0; i < count; i++) {
        double rise = 2 * fabs(z - step[i].z), cone = step[i].diameter + rise * tangent;
        if (cone < diameter) {
            diameter = cone;
            *slope = rise;
        }
    }
    if (diameter < least) {
        diameter = least;
        *slope = 0;
    }
    return diameter;
}

#define CUTS 28 /* of an element: up to eight for each step that reaches it, of which there are one or two */

struct moments {
    double area, inertia;
};

/* Share of the holes inside a diameter. At the section's own one it is 0 or 1, as section_perforate has it; in between it moves
 * with the diameter, so that nothing jumps as the cone runs over the ring of holes. */
static double share_of_holes(const struct group *group, double own, double diameter, double *slope)
{
    double h = group->hole_diameter, e = group->hole_pitch;
    double whole = fmin(1, (own / 2 - e) / h + 0.5), share = (diameter / 2 - e) / h + 0.5;
    *slope = 0;
    if (!group->holes || e >= own / 2 || share <= 0)
        return 0;
    if (share >= whole)
        return 1;
    *slope = 0.5 / (h * whole);
    return share / whole;
}

/* Of what carries stiffness inside a diameter, without the factors pi/4 and pi/64, and how they grow with it. */
static struct moments moments_of(const struct group *group, const struct segment *segment, double diameter, struct moments *slope)
{
    double d2 = diameter * diameter, b2 = segment->inner * segment->inner, h2 = group->hole_diameter * group->hole_diameter;
    double dshare, share = share_of_holes(group, segment->stiff_outer, diameter, &dshare);
    double area = group->holes * h2, inertia = area * (h2 + 8 * group->hole_pitch * group->hole_pitch);
    *slope = (struct moments){2 * diameter - dshare * area, 4 * d2 * diameter - dshare * inertia};
    return (struct moments){d2 - b2 - share * area, d2 * d2 - b2 * b2 - share * inertia};
}

/* own/value and its derivative for a value that grows by dvalue, as the disc it is cut from does */
static double compliance(double own, double value, double dvalue, double own_disc, double disc, double *derivative)
{
    double least = least_share * own / own_disc * disc;
    if (value < least) {
        value = least;
        dvalue *= least / disc;
    }
    *derivative = -own / (value * value) * dvalue;
    return own / value;
}

/* 1/k of an annulus (Cowper 1966, nu = 0.3, at which the ratio of two of them is within 1 % of that of any nu): linear in
 * u/(1 + u)^2, u = (bore/diameter)^2. *slope: d(1/k)/d diameter. */
static double inverse_coefficient(double bore, double diameter, double *slope)
{
    double x = 0.3 / (2 * 1.3), constant = 7.0 / 6 - x / 3, linear = 10.0 / 3 - 8 * x / 3;
    double u = bore * bore / (diameter * diameter), v = 1 + u;
    *slope = linear * (1 - u) / (v * v * v) * -2 * u / diameter;
    return constant + linear * u / (v * v);
}

static int add_cut(double from, double to, double z, int count, double *cut)
{
    if (!(z > from && z < to) || count > CUTS)
        return count;
    int at = count;
    for (; at > 1 && cut[at - 1] > z; at--)
        cut[at] = cut[at - 1];
    cut[at] = z;
    return count + 1;
}

/* Ends of the pieces of an element on which D(z) is one straight line: where a cone meets the section's own diameter, the least
 * one or a cone from the other side. Integrated piece by piece the means are smooth functions of the angle, and a fit converges.
 * Of a layer, which a cone cuts off from its outer to its inner diameter, the compliance rises like the reciprocal of what is
 * left of the wall: four ends more, so that 0.6 of the wall is left over a piece. Returns the number of ends; cut [CUTS + 2].
 */
static int find_pieces(int count, const struct step *step, const struct group *group, const struct segment *segment,
                       const struct effect_span *span, double tangent, double *cut)
{
    double own = segment->stiff_outer, bore = segment->inner > 0 ? segment->inner + least_wall * (own - segment->inner) : 0;
    double h = group->hole_diameter, e = group->hole_pitch, whole = group->holes ? fmin(1, (own / 2 - e) / h + 0.5) : 0;
    double diameter[8] = {own, bore};
    int pieces = 1, diameters = 2;
    if (group->holes) {
        diameter[diameters++] = 2 * e - h;
        diameter[diameters++] = 2 * e + h * (2 * whole - 1);
    }
    for (int q = 1; q < 5 && group->layer_of >= 0 && segment->inner > 0; q++)
        diameter[diameters++] = segment->inner + (own - segment->inner) * pow(least_wall, 0.2 * q);
    cut[0] = span->from;
    for (int i = 0; i < count; i++) {
        double side = step[i].z <= span->from ? 1 : -1;
        for (int k = 0; k < diameters; k++)
            pieces =
                add_cut(span->from, span->to, step[i].z + side * (diameter[k] - step[i].diameter) / (2 * tangent), pieces, cut);
        for (int j = 0; j < count && side > 0; j++)
            if (step[j].z >= span->to)
                pieces =
                    add_cut(span->from, span->to,
                            (step[i].z + step[j].z) / 2 + (step[j].diameter - step[i].diameter) / (4 * tangent), pieces, cut);
    }
    cut[pieces] = span->to;
    return pieces + 1;
}

struct means { /* of the compliance in bending and shear over an element, and their derivatives with respect to the tangent */
    double bending, shear, dbending, dshear;
};

/* bore of a section of one part; 0 where its coefficient stays */
static void add_point(const struct group *group, const struct segment *segment, double bore, double diameter, double slope,
                      double weight, struct means *sum)
{
    double own = segment->stiff_outer, d2 = diameter * diameter, of_bending, of_shear;
    struct moments unused, by_diameter, whole = moments_of(group, segment, own, &unused);
    struct moments left = moments_of(group, segment, diameter, &by_diameter);
    sum->bending += weight * compliance(whole.inertia, left.inertia, by_diameter.inertia * slope, own * own * own * own, d2 * d2,
                                        &of_bending);
    double of_own, of_k, shear = compliance(whole.area, left.area, by_diameter.area * slope, own * own, d2, &of_shear);
    double base = inverse_coefficient(bore, own, &of_own), k = inverse_coefficient(bore, diameter, &of_k) / base;
    sum->shear += weight * k * shear;
    sum->dbending += weight * of_bending;
    sum->dshear += weight * (k * of_shear + of_k / base * slope * shear);
}

static int section(const struct effect *effect, const struct rotor *rotor, const struct effect_span *span, int p,
                   struct effect_section *out)
{
    const struct segment own = part_of(rotor, span->segment, span->group), *segment = &own;
    double angle = effect->value[0] * PI / 180, tangent = tan(angle), cut[CUTS + 2], length = span->to - span->from;
    struct step step[STEPS_AT_ONCE];
    struct means mean = {0, 0, 0, 0};
    if (segment->rectangular || effect->value[0] >= 90)
        return 0;
    int count = reaching_steps(rotor, span->from, span->to, segment->stiff_outer, tangent, step);
    if (!count)
        return 0;
    int layered = 0;
    for (int i = 0; i < rotor->nring; i++)
        layered |= rotor->ring[i].segment == span->segment;
    int ends = find_pieces(count, step, &rotor->group[span->group], segment, span, tangent, cut);
    for (int i = 0; i + 1 < ends; i++)
        for (int g = 0; g < GAUSS_POINTS; g++) {
            double half = (cut[i + 1] - cut[i]) / 2, slope;
            double diameter = envelope(count, step, segment, cut[i] + half * (1 + gauss_place[g]), tangent, &slope);
            add_point(&rotor->group[span->group], segment, layered ? 0 : segment->inner, diameter, slope,
                      gauss_weight[g] * half / length, &mean);
        }
    double by_angle = (1 + tangent * tangent) * PI / 180;
    *out = (struct effect_section){.ei = factor_of_compliance(mean.bending, mean.dbending * by_angle, p),
                                   .kgs = factor_of_compliance(mean.shear, mean.dshear * by_angle, p)};
    return 1;
}

static int applies(const struct rotor *rotor, int target, const int *identified)
{
    (void)target, (void)identified;
    int steps = 0;
    double left, right;
    for (int s = 0; s + 1 < rotor->nsegment; s++)
        steps += is_step(rotor, s, &left, &right);
    return steps > 0;
}

static const struct effect_kind kind = {
    .id = "step_stiffness", .nparameter = 1, .parameter = {{"angle", "deg"}}, .section = section};

const struct cause_kind cause_step_stiffness = {
    .id = "step_stiffness",
    .class = CAUSE_PHYSICAL,
    .target = TARGET_NONE,
    .effect = &kind,
    .parameter = {{.neutral = 90, .typical = 30, .one_sided = -1, PRIOR_UNIFORM}},
    NO_PLACE,
    .secant = 1,
    .discrepancy_frequency = 0.005,
    .discrepancy_shape = 0.025,
    .applies = applies,
    .lower = 10,
    .upper = 80,
    .sentence = "corners at steps of the diameter carry no load: only a cone from the smaller diameter is stiff",
    .check = "compare with a solid model of the bare rotor, or give the stiff diameter of each section by hand",
};
