/* Hubs that stiffen the shaft under them. Over the middle part `share` of the length of every hub shaft and hub bend as one, of
 * the shaft's material out to the hub's diameter; towards its ends the stress has not spread into the hub yet, or the fit is
 * loose, and there the hub is a mass only. Frequencies are nearly linear in such a share, while a share of EI would be used up by
 * its first hundredth where a hub is three times as thick as the shaft. */
#include "diagnose/causes/causes.h"

/* Mean over the stretch of what the compliances of bending and shear lose. */
struct loss {
    double bending, shear;
};

/* The share of the stretch that the middle part of a hub covers, or its derivative with respect to the share of the hub. */
static double covered(const struct disk *disk, const struct effect_span *span, double share, int p)
{
    double half = disk->hub_length / 2, left = disk->position - share * half, right = disk->position + share * half;
    double from = fmax(span->from, left), to = fmin(span->to, right), length = span->to - span->from;
    if (p < 0)
        return fmax(to - from, 0) / length;
    return half * ((left > span->from && left <= span->to) + (right >= span->from && right < span->to)) / length;
}

static struct loss loss_of(const struct rotor *rotor, const struct effect_span *span, double share, int p)
{
    struct loss sum = {0, 0};
    double outer, inner;
    rotor_diameters(rotor, span->segment, &outer, &inner);
    double o2 = outer * outer, i2 = inner * inner;
    for (int d = 0; d < rotor->ndisk && !rotor->segment[span->segment].rectangular; d++) {
        const struct disk *disk = &rotor->disk[d];
        double hub = fmax(disk->hub_outer, outer), h2 = hub * hub,
               part = disk->hub_length > 0 ? covered(disk, span, share, p) : 0;
        sum.bending += part * (1 - (o2 * o2 - i2 * i2) / (h2 * h2 - i2 * i2));
        sum.shear += part * (1 - (o2 - i2) / (h2 - i2));
    }
    return sum;
}

static int field(const struct effect *effect, const struct rotor *rotor, const struct effect_span *span, int p,
                 struct effect_field *out)
{
    struct loss loss = loss_of(rotor, span, effect->value[0], -1), rate = {0, 0};
    if (p >= 0)
        rate = loss_of(rotor, span, effect->value[0], p);
    if ((p < 0 ? loss.bending : rate.bending) == 0)
        return 0;
    *out = (struct effect_field){factor_of_compliance(1 - loss.bending, -rate.bending, p),
                                 factor_of_compliance(1 - loss.shear, -rate.shear, p), p < 0};
    return 1;
}

static int applies(const struct rotor *rotor, int target, const int *identified)
{
    (void)target, (void)identified;
    int hubs = 0;
    for (int d = 0; d < rotor->ndisk; d++)
        hubs += rotor->disk[d].hub_length > 0;
    return hubs > 0;
}

static const struct effect_kind kind = {.id = "hub_stiffness", .nparameter = 1, .parameter = {{"share", "1"}}, .field = field};

const struct cause_kind cause_hub_stiffness = {
    .id = "hub_stiffness",
    .class = CAUSE_PHYSICAL,
    .target = TARGET_NONE,
    .effect = &kind,
    .parameter = {{.typical = 0.5, .one_sided = 1, PRIOR_NORMAL(0.5)}},
    NO_PLACE,
    .applies = applies,
    .lower = 0,
    .upper = 1,
    .sentence = "hubs that stiffen the shaft on which they sit",
    .check = "measure the shaft without its disks, or the fit of the hubs",
};
