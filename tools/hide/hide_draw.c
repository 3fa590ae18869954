#include "hide_draw.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

struct draw {
    const struct hide_rotor *rotor;
    int modes, no_shapes;
    double mass, bending; /* of the rotor: kg, mean EI */
    struct hide_random *random;
};

static void add_part(struct draw *d, int group, double length, double area, double second)
{
    const struct hide_material *m = &d->rotor->group[group].material;
    d->mass += m->rho * area * length;
    d->bending += m->e * second * length / d->rotor->length;
}

static void add_ring(struct draw *d, int group, double length, double outer, double inner)
{
    double o2 = outer * outer, i2 = inner * inner;
    add_part(d, group, length, pi / 4 * (o2 - i2), pi / 64 * (o2 * o2 - i2 * i2));
}

static void measure(struct draw *d)
{
    d->mass = d->bending = 0;
    for (int i = 0; i < d->rotor->segments; i++) {
        const struct hide_segment *s = &d->rotor->segment[i];
        double length = s->to - s->from;
        if (s->rectangular)
            add_part(d, s->group, length, s->height * s->width, s->width * pow(s->height, 3) / 12);
        else
            add_ring(d, s->group, length, s->outer, s->inner);
        for (int k = 0; k < s->rings; k++)
            add_ring(d, s->ring[k].group, length, s->ring[k].outer, s->ring[k].inner);
    }
}

static double sized(struct draw *d, double low, double high)
{
    return hide_log_between(d->random, low, high);
}

static double either_sign(struct draw *d, double low, double high)
{
    double size = sized(d, low, high);
    return hide_pick(d->random, 2) ? size : -size;
}

/* A factor as far above one as below it. */
static double factor(struct draw *d, double low, double high)
{
    return exp(either_sign(d, low, high));
}

static double anywhere(struct draw *d)
{
    return d->rotor->length * hide_between(d->random, 0.02, 0.98);
}

/* One of a rotor's `count` things for which fits() holds; -1: there is none. */
static int pick_fitting(struct draw *d, int count, int (*fits)(const struct hide_rotor *, int))
{
    int candidates = 0, chosen;
    for (int i = 0; i < count; i++)
        candidates += fits(d->rotor, i);
    if (!candidates)
        return -1;
    chosen = hide_pick(d->random, candidates);
    for (int i = 0; i < count; i++)
        if (fits(d->rotor, i) && chosen-- == 0)
            return i;
    return -1;
}

static int known_modulus(const struct hide_rotor *rotor, int group)
{
    return !rotor->group[group].free_modulus;
}

static int known_density(const struct hide_rotor *rotor, int group)
{
    return !rotor->group[group].free_density;
}

static int is_tube(const struct hide_rotor *rotor, int tie)
{
    return rotor->tie[tie].tube;
}

static int any(const struct hide_rotor *rotor, int i)
{
    (void)rotor, (void)i;
    return 1;
}

/* Keys of a kind with values over a range: what --random draws. %s of the target comes first. */
static int of_group(struct draw *d, const char *id, const char *key, double value, int (*fits)(const struct hide_rotor *, int),
                    char spec[HIDE_SPEC])
{
    int group = pick_fitting(d, d->rotor->groups, fits);
    if (group >= 0)
        snprintf(spec, HIDE_SPEC, "%s:group=%s,%s=%.6g", id, d->rotor->group[group].name, key, value);
    return group >= 0;
}

static int of_tie(struct draw *d, const char *id, double value, char spec[HIDE_SPEC])
{
    int tie = pick_fitting(d, d->rotor->ties, strcmp(id, "tie_shear") ? any : is_tube);
    if (tie >= 0 && strcmp(id, "tie_shear"))
        snprintf(spec, HIDE_SPEC, "%s:at=%s,factor=%.6g", id, d->rotor->tie[tie].name, value);
    else if (tie >= 0)
        snprintf(spec, HIDE_SPEC, "%s:at=%s", id, d->rotor->tie[tie].name);
    return tie >= 0;
}

static int has_step(const struct hide_rotor *rotor)
{
    for (int i = 0; i + 1 < rotor->segments && rotor->groups == rotor->shafts; i++)
        if (!rotor->segment[i].rectangular && !rotor->segment[i + 1].rectangular &&
            fabs(rotor->segment[i].outer - rotor->segment[i + 1].outer) > 1e-9)
            return 1;
    return 0;
}

static int draw_stiffness(struct draw *d, const char *id, char spec[HIDE_SPEC])
{
    double length = d->rotor->length, z, depth;
    if (!strcmp(id, "step_stiffness")) { /* 75 degrees take away little, 20 much */
        double angle = 180 / pi * atan(sized(d, tan(pi / 9), tan(pi * 75 / 180)));
        snprintf(spec, HIDE_SPEC, "%s:angle=%.6g", id, angle);
        return has_step(d->rotor);
    }
    if (!strcmp(id, "stiffness_gradient"))
        return of_group(d, id, "slope", either_sign(d, 0.01, 0.4), any, spec);
    if (!strcmp(id, "stiffness_profile"))
        return of_group(d, id, "profile", either_sign(d, 0.02, 0.8), any, spec);
    if (!strcmp(id, "stiffness"))
        return of_group(d, id, "factor", factor(d, 0.003, 0.25), known_modulus, spec);
    if (!strcmp(id, "diameter"))
        return of_group(d, id, "factor", factor(d, 0.003, 0.08), known_modulus, spec);
    if (!strcmp(id, "shear_coefficient"))
        return of_group(d, id, "factor", factor(d, 0.01, 0.4), known_modulus, spec);
    if (!strcmp(id, "stiffness_local")) {
        int box = hide_pick(d->random, 2);
        depth = sized(d, 0.04, 0.9);
        z = anywhere(d);
        snprintf(spec, HIDE_SPEC, "%s:depth=%.6g,z=%.6g,width=%.6g,shape=%s", id, depth, z,
                 length * (box ? sized(d, 0.02, 0.08) : sized(d, 0.0075, 0.03)), box ? "box" : "gaussian");
        return 1;
    }
    if (d->rotor->shafts < 2) /* a joint */
        return 0;
    snprintf(spec, HIDE_SPEC, "%s:at=%s.end,flexibility=%.6g", id,
             d->rotor->group[hide_pick(d->random, d->rotor->shafts - 1)].name, length / d->bending * sized(d, 6e-4, 0.2));
    return 1;
}

static int holds(const struct hide_rotor *rotor, int spring)
{
    return rotor->spring[spring].lateral > 0 && rotor->spring[spring].rotational > 0;
}

static int draw_support(struct draw *d, const char *id, char spec[HIDE_SPEC])
{
    /* A spring of `first` would take the first elastic mode of a uniform free beam, lambda m = 500 EI/L^3, to about twice its
     * square. */
    double length = d->rotor->length, first = 500 * d->bending / pow(length, 3), z = anywhere(d);
    const struct hide_spring *spring = d->rotor->spring;
    if (!strcmp(id, "support_extra"))
        snprintf(spec, HIDE_SPEC, "%s:z=%.6g,stiffness=%.6g", id, z, first * sized(d, 1e-3, 0.5));
    else if (!strcmp(id, "support_rotation"))
        snprintf(spec, HIDE_SPEC, "%s:z=%.6g,stiffness=%.6g", id, z, first * length * length * sized(d, 1e-4, 0.035));
    else {
        int clamp = !strcmp(id, "clamp"), i = pick_fitting(d, d->rotor->springs, clamp ? holds : any);
        double shift = length * either_sign(d, 0.002, 0.1), size = sized(d, 1e-3, 0.11), lateral = sized(d, 1e-4, 0.1);
        if (i < 0)
            return 0;
        if (spring[i].z + shift < 0 || spring[i].z + shift > length)
            shift = -shift;
        char name[HIDE_NAME];
        snprintf(name, sizeof name, "%d", i + 1);
        const char *at = spring[i].name[0] ? spring[i].name : name;
        if (clamp)
            snprintf(spec, HIDE_SPEC, "%s:at=%s,rotational=%.6g,lateral=%.6g", id, at, length / d->bending * size,
                     hide_pick(d->random, 2) ? pow(length, 3) / 3 / d->bending * lateral : 0);
        else
            snprintf(spec, HIDE_SPEC, "%s:at=%s,shift=%.6g", id, at, shift);
    }
    return 1;
}

static int has_hub(const struct hide_rotor *rotor, int disk)
{
    return rotor->disk[disk].hub > 0;
}

static int draw_disk(struct draw *d, const char *id, char spec[HIDE_SPEC])
{
    int hub = !strcmp(id, "hub_stiffness"), i = pick_fitting(d, d->rotor->disks, hub ? has_hub : any);
    double share = sized(d, 0.02, 1), length = d->rotor->length;
    if (i < 0)
        return 0;
    const struct hide_disk *disk = &d->rotor->disk[i];
    double weighs = disk->mass > 0 ? disk->mass : d->mass;
    if (hub)
        snprintf(spec, HIDE_SPEC, "%s:share=%.6g", id, share);
    else if (disk->name[0])
        snprintf(spec, HIDE_SPEC, "%s:at=%s,inertia=%.6g", id, disk->name, weighs * length * length * share / 10);
    else
        snprintf(spec, HIDE_SPEC, "%s:at=%d,inertia=%.6g", id, i + 1, weighs * length * length * share / 10);
    return 1;
}

static int draw_attached(struct draw *d, const char *id, char spec[HIDE_SPEC])
{
    if (!strcmp(id, "density"))
        return of_group(d, id, "factor", factor(d, 0.004, 0.25), known_density, spec);
    if (!strcmp(id, "tie_stiffness")) {
        double size = factor(d, 0.05, 1.8);
        return of_tie(d, id, size > 1.9 ? 1 / size : size, spec); /* rods may have lost most of their grip, not gained a steel */
    }
    if (!strcmp(id, "tie_tension") || !strcmp(id, "tie_shear"))
        return of_tie(d, id, factor(d, 0.1, 1.5), spec);
    if (!strncmp(id, "support_", 8) || !strcmp(id, "clamp"))
        return draw_support(d, id, spec);
    if (!strcmp(id, "support")) {
        int spring = d->rotor->springs ? hide_pick(d->random, d->rotor->springs) : -1;
        if (spring >= 0 && d->rotor->spring[spring].name[0])
            snprintf(spec, HIDE_SPEC, "%s:at=%s,factor=%.6g", id, d->rotor->spring[spring].name, factor(d, 0.2, 4));
        else
            snprintf(spec, HIDE_SPEC, "%s:at=%d,factor=%.6g", id, spring + 1, factor(d, 0.2, 4));
        return spring >= 0;
    }
    if (!strcmp(id, "added_mass")) { /* an end takes a hundredth of what the middle takes to be seen */
        double mass = d->mass * sized(d, 2e-5, fmax(0.028, fmin(0.2, 8 / d->mass))), /* a small rotor carries more, up to 8 kg */
            z = hide_pick(d->random, 5) ? anywhere(d) : hide_pick(d->random, 2) * d->rotor->length;
        snprintf(spec, HIDE_SPEC, "%s:mass=%.6g,z=%.6g", id, mass, z);
        return 1;
    }
    if (!strcmp(id, "added_inertia") || !strcmp(id, "hub_stiffness"))
        return draw_disk(d, id, spec);
    double mass = fmin(0.19, d->mass * sized(d, 2e-5, 3e-3)); /* accelerometer_mass, with cable and magnet */
    int sensors = d->rotor->sensors;
    if (!sensors)
        return 0;
    if (hide_pick(d->random, 2) && !d->no_shapes)
        snprintf(spec, HIDE_SPEC, "%s:mass=%.6g,mount=moving", id, mass);
    else
        snprintf(spec, HIDE_SPEC, "%s:mass=%.6g,mount=fixed,sensor=%ld", id, mass,
                 d->rotor->sensor[hide_pick(d->random, sensors)].id);
    return 1;
}

static int draw_sensor(struct draw *d, const char *id, char spec[HIDE_SPEC])
{
    const struct hide_sensor *sensor = d->rotor->sensor;
    int count = d->rotor->sensors;
    if (count < 4)
        return 0;
    int a = hide_pick(d->random, count), away = 1 + hide_pick(d->random, 3), b = a + away < count ? a + away : a - away;
    if (!strcmp(id, "sensor_gain"))
        snprintf(spec, HIDE_SPEC, "%s:sensor=%ld,gain=%.6g", id, sensor[a].id, factor(d, 0.03, 0.9));
    else if (!strcmp(id, "sensor_sign"))
        snprintf(spec, HIDE_SPEC, "%s:sensor=%ld", id, sensor[a].id);
    else if (!strcmp(id, "sensor_swap"))
        snprintf(spec, HIDE_SPEC, "%s:sensors=%ld+%ld", id, sensor[a].id, sensor[b].id);
    else if (!strcmp(id, "duplicate_channel"))
        snprintf(spec, HIDE_SPEC, "%s:sensor=%ld,of=%ld", id, sensor[a].id, sensor[b].id);
    else {
        double shift = d->rotor->length * either_sign(d, 0.0025, 0.06);
        if (sensor[a].z + shift < 0 || sensor[a].z + shift > d->rotor->length)
            shift = -shift;
        snprintf(spec, HIDE_SPEC, "%s:sensor=%ld,shift=%.6g", id, sensor[a].id, shift);
    }
    return 1;
}

/* One of flip, shift and scale, or shift and scale at once, by which no sensor leaves the rotor. */
static int draw_line(struct draw *d, const char *id, char spec[HIDE_SPEC])
{
    const struct hide_rotor *rotor = d->rotor;
    double first = rotor->length, last = 0, length = rotor->length;
    for (int s = 0; s < rotor->sensors; s++) {
        first = fmin(first, rotor->sensor[s].z);
        last = fmax(last, rotor->sensor[s].z);
    }
    int fault = hide_pick(d->random, 4);
    double scale = fault == 1 || fault == 2 ? factor(d, 0.01, 0.06) : 1,
           shift = fault >= 2 ? length * either_sign(d, 0.003, 0.03) : 0;
    if (rotor->sensors < 4)
        return 0;
    if (shift + scale * last > length && scale > 1)
        scale = 1 / scale;
    if (shift + scale * first < 0 || shift + scale * last > length)
        shift = -shift;
    if (fault == 0)
        snprintf(spec, HIDE_SPEC, "%s:flip=1", id);
    else
        snprintf(spec, HIDE_SPEC, "%s:shift=%.6g,scale=%.6g", id, shift, scale);
    return shift + scale * first >= 0 && shift + scale * last <= length;
}

static int draw_data(struct draw *d, const char *id, char spec[HIDE_SPEC])
{
    int mode = 1 + hide_pick(d->random, d->modes), fault = hide_pick(d->random, d->no_shapes ? 2 : 3);
    if (!strcmp(id, "noise_level")) {
        const char *block = !d->no_shapes && hide_pick(d->random, 2) ? "SHAPE" : "FREQUENCY";
        snprintf(spec, HIDE_SPEC, "%s:block=%s,factor=%.6g", id, block, factor(d, 0.1, 1.4));
        return 1;
    }
    if (!strcmp(id, "sensor_line"))
        return !d->no_shapes && draw_line(d, id, spec);
    if (strcmp(id, "mode_pairing"))
        return !d->no_shapes && draw_sensor(d, id, spec);
    if (fault == 2 && d->modes > 1)
        snprintf(spec, HIDE_SPEC, "%s:swap=%d+%d", id, mode < d->modes ? mode : mode - 1, mode < d->modes ? mode + 1 : mode);
    else
        snprintf(spec, HIDE_SPEC, "%s:%s=%d", id, fault == 1 && d->modes > 1 ? "missing" : "double", mode);
    return 1;
}

static int draw_outside(struct draw *d, const char *name, char spec[HIDE_SPEC])
{
    double length = d->rotor->length, z = anywhere(d), depth = sized(d, 0.1, 0.9);
    double width = length * sized(d, 0.0075, 0.03);
    if (!strcmp(name, "bend_only"))
        snprintf(spec, HIDE_SPEC, "outside:kind=%s,depth=%.6g,z=%.6g,width=%.6g", name, depth, z, width);
    else if (!strcmp(name, "inertia"))
        snprintf(spec, HIDE_SPEC, "outside:kind=%s,z=%.6g,inertia=%.6g", name, z,
                 d->mass * length * length * sized(d, 1e-5, 1e-2));
    else if (!strcmp(name, "density_zone"))
        snprintf(spec, HIDE_SPEC, "outside:kind=%s,factor=%.6g,z=%.6g,width=%.6g", name, factor(d, 0.05, 1.2), z,
                 length * sized(d, 0.02, 0.15));
    else {
        double amplitude = either_sign(d, 0.03, 0.7), waves = hide_between(d->random, 1, 4);
        snprintf(spec, HIDE_SPEC, "outside:kind=%s,group=%s,amplitude=%.6g,waves=%.6g", name,
                 d->rotor->group[hide_pick(d->random, d->rotor->groups)].name, amplitude, waves);
    }
    return 1;
}

static int draw_kind(struct draw *d, const struct hide_kind *kind, char spec[HIDE_SPEC])
{
    static const char *const attached[] = {
        "density",    "tie_stiffness",      "tie_tension",      "tie_shear",     "support",
        "added_mass", "accelerometer_mass", "support_position", "support_extra", "support_rotation",
        "clamp",      "added_inertia",      "hub_stiffness"};
    if (kind->outside)
        return draw_outside(d, kind->outside, spec);
    if (kind->class == HIDE_DATA)
        return draw_data(d, kind->id, spec);
    for (size_t i = 0; i < sizeof attached / sizeof *attached; i++)
        if (!strcmp(kind->id, attached[i]))
            return draw_attached(d, kind->id, spec);
    return draw_stiffness(d, kind->id, spec);
}

/* One kind of the class that applies to the rotor and is not `without`: kinds are drawn until one does. */
static const struct hide_kind *draw_class(struct draw *d, enum hide_class class, const struct hide_kind *without,
                                          char spec[HIDE_SPEC])
{
    for (int tries = 0; tries < 1000; tries++) {
        const struct hide_kind *kind = hide_kind(hide_pick(d->random, hide_kinds() - (class == HIDE_DATA ? 1 : 2)));
        if (kind->class == class && kind != without && draw_kind(d, kind, spec))
            return kind;
    }
    return NULL;
}

static int has_place(const struct hide_kind *kind)
{
    for (int k = 0; k < HIDE_MOST_KEYS && kind->key[k].name; k++)
        if (kind->key[k].type == HIDE_PLACE)
            return 1;
    return 0;
}

int hide_draw(const struct hide_rotor *rotor, int modes, int no_shapes, const char *random, struct hide_random *stream,
              char spec[2][HIDE_SPEC], int *count, const struct hide_message *message)
{
    static const char *const classes[] = {"physical", "data", "outside"}; /* in the order of hide_class */
    static const char *const all[] = {"none", "physical", "physical", "physical", "data", "outside", "pair"};
    struct draw d = {.rotor = rotor, .modes = modes, .no_shapes = no_shapes, .random = stream};
    const struct hide_kind *kind = NULL;
    measure(&d);
    if (hide_same(random, "any"))
        random = all[hide_pick(stream, (int)(sizeof all / sizeof *all))];
    *count = 0;
    if (hide_same(random, "none"))
        return HIDE_OK;
    for (int i = 0; i < 3; i++)
        if (hide_same(random, classes[i])) {
            *count = 1;
            return draw_class(&d, (enum hide_class)i, NULL, spec[0])
                       ? HIDE_OK
                       : hide_fail(message, HIDE_INPUT, "--random %s: nothing of it applies to this rotor", random);
        }
    if (hide_same(random, "pair")) {
        *count = 2;
        kind = draw_class(&d, HIDE_PHYSICAL, NULL, spec[0]);
        return kind && draw_class(&d, HIDE_PHYSICAL, has_place(kind) ? NULL : kind, spec[1])
                   ? HIDE_OK
                   : hide_fail(message, HIDE_INPUT, "--random pair: expected a rotor to which two effects apply");
    }
    for (int i = 0; i < hide_kinds(); i++)
        if (hide_same(hide_kind(i)->outside ? hide_kind(i)->outside : hide_kind(i)->id, random))
            kind = hide_kind(i);
    if (!kind)
        return hide_fail(message, HIDE_INPUT, "--random %s: expected none, an id of --list, physical, data, outside, pair or any",
                         random);
    *count = 1;
    return draw_kind(&d, kind, spec[0]) ? HIDE_OK
                                        : hide_fail(message, HIDE_INPUT, "--random %s: it does not apply to this rotor", random);
}
