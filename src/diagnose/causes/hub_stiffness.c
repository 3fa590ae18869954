/* Hubs that stiffen the shaft under them. `share` is that part of the length of every hub on which shaft and hub bend as one, of
 * the shaft's material out to the hub's diameter; on the rest the hub is a mass only. Spread over the hub as a mean compliance,
 *   1/EI := (1 - share)/EI + share/(EI + E I_hub),  the same with G A,
 * which makes the frequencies nearly linear in the share, while a share of EI would be used up by its first hundredth where a hub
 * is three times as thick as the shaft. */
#include <math.h>

#include "diagnose/causes/cause.h"
#include "diagnose/causes/shared.h"

/* mean over the stretch of what the compliances of bending and shear lose for a share of 1 */
struct loss {
    double bending, shear;
};

static struct loss loss_of(const struct rotor *rotor, const struct effect_span *span)
{
    struct loss sum = {0, 0};
    double outer, inner;
    rotor_diameters(rotor, span->segment, &outer, &inner);
    double o2 = outer * outer, i2 = inner * inner;
    for (int d = 0; d < rotor->ndisk && !rotor->segment[span->segment].rectangular; d++) {
        const struct disk *disk = &rotor->disk[d];
        double hub = fmax(disk->hub_outer, outer), h2 = hub * hub, half = disk->hub_length / 2;
        double length = fmin(span->to, disk->position + half) - fmax(span->from, disk->position - half);
        if (!(length > 0))
            continue;
        double covered = length / (span->to - span->from);
        sum.bending += covered * (1 - (o2 * o2 - i2 * i2) / (h2 * h2 - i2 * i2));
        sum.shear += covered * (1 - (o2 - i2) / (h2 - i2));
    }
    return sum;
}

static int field(const struct effect *effect, const struct rotor *rotor, const struct effect_span *span, int p,
                 struct effect_field *out)
{
    struct loss loss = loss_of(rotor, span);
    double share = effect->value[0];
    if (loss.bending == 0)
        return 0;
    *out = (struct effect_field){factor_of_compliance(1 - share * loss.bending, -loss.bending, p),
                                 factor_of_compliance(1 - share * loss.shear, -loss.shear, p), p < 0};
    return 1;
}

static void bounds(const struct rotor *rotor, const struct effect *effect, int p, double *lower, double *upper)
{
    (void)rotor, (void)effect, (void)p;
    *lower = 0;
    *upper = 1;
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
    .parameter = {{.typical = 0.5, .one_sided = 1}},
    .place = -1,
    .width = -1,
    .applies = applies,
    .bounds = bounds,
    .sentence = "hubs that stiffen the shaft on which they sit",
    .check = "measure the shaft without its disks, or the fit of the hubs",
};
