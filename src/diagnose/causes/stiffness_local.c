/* A zone softer than its surroundings, anywhere on the axis: E and G times 1 - depth g(z), g a Gaussian of standard deviation
 * `width` or a box of length `width`. The words with _SHEAR give the shear stiffness a depth of its own. */
#include "diagnose/causes/causes.h"

enum { GAUSSIAN, BOX, GAUSSIAN_SHEAR, BOX_SHEAR };
enum { DEPTH, PLACE, WIDTH, DEPTH_SHEAR, PARAMETERS };

static const double reach = 8.5;    /* widths, where a Gaussian is at rounding */
static const double panel = 0.5;    /* widths: a deep zone makes a sharp peak of compliance; four points in it leave below 1e-3 */
static const int most_panels = 200; /* of an element */

static int is_box(const struct effect *effect)
{
    return effect->variant == BOX || effect->variant == BOX_SHEAR;
}

static int has_shear(const struct effect *effect)
{
    return effect->variant == GAUSSIAN_SHEAR || effect->variant == BOX_SHEAR;
}

/* Mean over the element of 1/(1 - depth g), and its derivatives with respect to depth, place and width. */
struct mean {
    double value, by[3];
};

static void mean_of_box(const struct effect *effect, const struct effect_span *span, double depth, struct mean *mean)
{
    double z = effect->value[PLACE], half = effect->value[WIDTH] / 2, length = span->to - span->from;
    double from = fmax(span->from, z - half), to = fmin(span->to, z + half), share = (to - from) / length;
    double soft = 1 / (1 - depth), extra = (soft - 1) / length;
    int left_inside = z - half > span->from, right_inside = z + half < span->to;
    *mean = (struct mean){1 + share * (soft - 1),
                          {share * soft * soft, extra * (right_inside - left_inside), extra * (right_inside + left_inside) / 2}};
}

static void mean_of_gaussian(const struct effect *effect, const struct effect_span *span, double depth, struct mean *mean)
{
    double z = effect->value[PLACE], width = effect->value[WIDTH], length = span->to - span->from;
    int panels = (int)fmin(most_panels, ceil(length / (panel * width)));
    *mean = (struct mean){0, {0, 0, 0}};
    for (int i = 0; i < panels; i++)
        for (int q = 0; q < GAUSS_POINTS; q++) {
            double at = span->from + length / panels * (i + (1 + gauss_place[q]) / 2), x = (at - z) / width;
            double g = exp(-x * x / 2), soft = 1 / (1 - depth * g), w = gauss_weight[q] / 2 / panels, slope = w * soft * soft * g;
            mean->value += w * soft;
            mean->by[DEPTH] += slope;
            mean->by[PLACE] += slope * depth * x / width;
            mean->by[WIDTH] += slope * depth * x * x / width;
        }
}

static double factor_of(const struct effect *effect, const struct effect_span *span, int depth, int p)
{
    struct mean mean;
    int of_depth = p == DEPTH || p == DEPTH_SHEAR;
    if (p >= 0 && of_depth && p != depth)
        return 0;
    (is_box(effect) ? mean_of_box : mean_of_gaussian)(effect, span, effect->value[depth], &mean);
    return factor_of_compliance(mean.value, p < 0 ? 0 : mean.by[of_depth ? DEPTH : p], p);
}

static int field(const struct effect *effect, const struct rotor *rotor, const struct effect_span *span, int p,
                 struct effect_field *out)
{
    (void)rotor;
    double far = effect->value[WIDTH] * (is_box(effect) ? 0.5 : reach);
    if (effect->value[PLACE] + far <= span->from || effect->value[PLACE] - far >= span->to)
        return 0;
    double bending = factor_of(effect, span, DEPTH, p);
    *out = (struct effect_field){bending, has_shear(effect) ? factor_of(effect, span, DEPTH_SHEAR, p) : bending, p < 0};
    return 1;
}

static int count(const struct effect *effect)
{
    return has_shear(effect) ? PARAMETERS : DEPTH_SHEAR;
}

/* A zone is local: a wider one imitates a gradient, a profile or the stiffness of a whole group, which are causes of their own.
 * The box has the standard deviation of the Gaussian. */
static void bounds(const struct rotor *rotor, const struct effect *effect, int p, double *lower, double *upper)
{
    double length = rotor_length(rotor);
    *lower = 0;
    *upper = 0.95;
    if (p == PLACE) {
        *upper = length;
    } else if (p == WIDTH) {
        *lower = length / (is_box(effect) ? 100 : 200);
        *upper = length / (is_box(effect) ? 4 : 14);
    }
}

static void reshape(struct effect *effect)
{
    double ratio = sqrt(12); /* length of a box over its standard deviation */
    effect->variant = BOX;
    effect->value[WIDTH] *= ratio;
    effect->value[DEPTH] *= sqrt(2 * PI) / ratio;
}

static const struct effect_kind kind = {.id = "stiffness_local",
                                        .nparameter = PARAMETERS,
                                        .parameter = {{"depth", "1"}, {"z", "m"}, {"width", "m"}, {"depth_shear", "1"}},
                                        .field = field,
                                        .count = count};

const struct cause_kind cause_stiffness_local = {
    .id = "stiffness_local",
    .class = CAUSE_PHYSICAL,
    .target = TARGET_NONE,
    .effect = &kind,
    .parameter = {{.typical = 0.3, .one_sided = 1, PRIOR_NORMAL(0.5)},
                  {0},
                  {.typical = 0.05},
                  {.typical = 0.3, .one_sided = 1, PRIOR_NORMAL(0.5)}},
    .size = DEPTH,
    .place = PLACE,
    .width = WIDTH,
    .variant = {"GAUSSIAN", "BOX", "GAUSSIAN_SHEAR", "BOX_SHEAR"},
    .variant_option = "SHAPE",
    .reshape = reshape,
    .bounds = bounds,
    .sentence = "a zone softer than its surroundings",
    .check = "look for a crack, a loose fit or missing pressure there, and measure more points around it",
};
