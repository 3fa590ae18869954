/* A layer that does not carry fully: its axial stress comes from the shaft through the fit, over a transfer length t from each
 * end (shear lag of a bonded or shrunk ring). E and G of the layer times 1 - cosh(x/t)/cosh(a/t), x from its middle, a half of
 * its length. Beside the parts that it lies on its stiffness adds, so that of a stretch the mean of the stiffness counts, which
 * may be nothing at the very end. */
#include "diagnose/causes/causes.h"

static const double at_end = 1 - 1e-9; /* of a */

/* int_0^x of what is lost, t sinh(x/t)/cosh(a/t), or its derivative by t; exponentials of what is not above zero alone */
static double lost_up_to(double x, double a, double t, int p)
{
    double away = fabs(x), sign = x < 0 ? -1 : 1;
    if (t <= 0) /* nothing but, by its derivative, the ends */
        return p < 0 || away < at_end * a ? 0 : sign;
    double all = 1 + exp(-2 * a / t), near = exp((away - a) / t);
    double s = near * (1 - exp(-2 * away / t)) / all, c = near * (1 + exp(-2 * away / t)) / all, tanh_a = (2 - all) / all;
    return sign * (p < 0 ? t * s : s - away / t * c + a / t * tanh_a * s);
}

static int field(const struct effect *effect, const struct rotor *rotor, const struct effect_span *span, int p,
                 struct effect_field *out)
{
    double from, to;
    if (span->group != effect->target)
        return 0;
    rotor_group_span(rotor, span->group, &from, &to);
    double a = (to - from) / 2, middle = (from + to) / 2, t = effect->value[0];
    double lost = (lost_up_to(span->to - middle, a, t, p) - lost_up_to(span->from - middle, a, t, p)) / (span->to - span->from);
    return scale_stiffness(p < 0 ? 1 - lost : -lost, p, out);
}

static void bounds(const struct rotor *rotor, const struct effect *effect, int p, double *lower, double *upper)
{
    (void)p;
    double from, to;
    rotor_group_span(rotor, effect->target, &from, &to);
    *lower = 0;
    *upper = (to - from) / 2; /* then a third of the stiffness is left in the middle */
}

static int applies(const struct rotor *rotor, int target, const int *identified)
{
    (void)identified;
    return rotor->group[target].layer_of >= 0;
}

static const struct effect_kind kind = {.id = "layer_slip", .nparameter = 1, .parameter = {{"transfer", "m"}}, .field = field};

const struct cause_kind cause_layer_slip = {
    .id = "layer_slip",
    .class = CAUSE_PHYSICAL,
    .target = TARGET_GROUP,
    .effect = &kind,
    .parameter = {{.typical = 0.02, .one_sided = 1, PRIOR_OF_BOUND(0.3)}},
    NO_PLACE,
    .applies = applies,
    .bounds = bounds,
    .sentence = "a layer without stress at its ends: the fit transfers the stress over a length",
    .check =
        "check the interference of the fit and the pressing of the stack, or measure more points across the ends of the layer",
};
