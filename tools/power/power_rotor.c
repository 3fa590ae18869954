/* A rotor drawn from a seed, as the text of a deck. */
#include <math.h>
#include <stdlib.h>

#include "hide/hide_random.h"
#include "hide/hide_text.h"
#include "power.h"

#define MOST_SECTIONS 9
#define MOST_SENSORS  36

static const double pi = 3.14159265358979323846;

struct drawn_stretch {
    double length, outer, inner;
};

/* A rotor in three groups, of which only the middle one is there in a shaft of one material. */
struct drawn {
    struct hide_random random;
    int sections, left, right; /* sections before and behind the middle ones */
    struct drawn_stretch section[MOST_SECTIONS];
    double length, diameter, core_from, core_to; /* m */
    double steel_e, core_e, core_g, core_rho;
    int isotropic;        /* G follows from E */
    int layered;          /* the middle is a steel shaft in a stack of diameter `diameter` */
    double mass, bending; /* roughly: kg, mean EI */
    struct hide_text *text;
};

static int chance(struct drawn *d, double share)
{
    return hide_uniform(&d->random) < share;
}

static double between(struct drawn *d, double low, double high)
{
    return hide_between(&d->random, low, high);
}

static double log_between(struct drawn *d, double low, double high)
{
    return hide_log_between(&d->random, low, high);
}

static void draw_sections(struct drawn *d)
{
    int middle;
    d->sections = 2 + hide_pick(&d->random, MOST_SECTIONS - 1);
    middle = d->sections >= 5 && chance(d, 0.3) ? 2 : 1;
    d->left = hide_pick(&d->random, d->sections - middle + 1);
    if (chance(d, 0.25)) /* one group */
        d->left = 0, middle = d->sections;
    d->right = d->sections - middle - d->left;
    d->length = log_between(d, 0.25, 4);
    d->diameter = d->length / log_between(d, 4, 30);
    double core = middle == d->sections ? 1 : between(d, 0.25, 0.7), weight[MOST_SECTIONS], sum[2] = {0, 0};
    int widest = d->left + hide_pick(&d->random, middle);
    double bore = chance(d, 0.25) ? between(d, 0.2, 0.6) : 0, least = d->diameter;
    int through = chance(d, 0.5);
    for (int i = 0; i < d->sections; i++) {
        int in_core = i >= d->left && i < d->left + middle;
        sum[in_core] += weight[i] = between(d, 0.3, 1);
    }
    for (int i = 0; i < d->sections; i++) {
        struct drawn_stretch *s = &d->section[i];
        int in_core = i >= d->left && i < d->left + middle, stepped = !in_core || d->sections == middle;
        s->length = d->length * weight[i] / sum[in_core] * (in_core ? core : 1 - core);
        s->outer = d->diameter * (i == widest ? 1 : between(d, stepped ? 0.35 : 0.85, 1));
        s->length = ceil(s->length * 1e6) * 1e-6;
        s->outer = ceil(s->outer * 1e6) * 1e-6;
        least = fmin(least, s->outer);
    }
    for (int i = 0; i < d->sections; i++) /* one drill: what lies side by side keeps a common wall */
        if (through || (i >= d->left && i < d->left + middle))
            d->section[i].inner = floor(bore * least * 1e6) * 1e-6;
    d->layered = d->sections > middle && bore == 0 && chance(d, 0.2);
    d->length = 0;
    for (int i = 0; i < d->sections; i++) {
        if (i == d->left)
            d->core_from = d->length;
        d->length += d->section[i].length;
        if (i == d->left + middle - 1)
            d->core_to = d->length;
    }
}

static void draw_materials(struct drawn *d)
{
    int one = d->left + d->right == 0;
    d->steel_e = between(d, 2.0e11, 2.15e11);
    d->isotropic = one && chance(d, 0.5);
    d->core_e = d->isotropic ? between(d, 0.7e11, 2.1e11) : log_between(d, 3e10, 1.9e11);
    d->core_g = d->core_e * between(d, 0.15, 0.4);
    d->core_rho = d->isotropic ? 7850 : between(d, 6800, 7750);
    for (int i = 0; i < d->sections; i++) {
        const struct drawn_stretch *s = &d->section[i];
        int steel = i < d->left || i >= d->sections - d->right;
        double o2 = s->outer * s->outer, i2 = s->inner * s->inner;
        d->mass += (steel ? 7850 : d->core_rho) * pi / 4 * (o2 - i2) * s->length;
        d->bending += (steel ? d->steel_e : d->core_e) * pi / 64 * (o2 * o2 - i2 * i2) * s->length / d->length;
    }
}

static void write_materials(struct drawn *d)
{
    if (d->left + d->right)
        hide_add(d->text, "*MATERIAL, NAME=steel\n*ELASTIC\n%.4g, 0.3\n*DENSITY\n7850\n", d->steel_e);
    if (d->isotropic)
        hide_add(d->text, "*MATERIAL, NAME=own\n*ELASTIC\n%.5g, 0.3\n", d->core_e);
    else
        hide_add(d->text, "*MATERIAL, NAME=own\n*ELASTIC, TYPE=SHEAR\n%.5g, %.5g, 0.3\n", d->core_e, d->core_g);
    hide_add(d->text, "*DENSITY\n%.5g\n", d->core_rho);
}

static void write_group(struct drawn *d, const char *name, const char *material, int from, int to, double share)
{
    if (from == to)
        return;
    hide_add(d->text, "*SHAFT, NAME=%s, MATERIAL=%s\n", name, material);
    for (int i = from; i < to; i++)
        hide_add(d->text, "%.6f, %.6f, %.6f, %d\n", d->section[i].length, floor(share * d->section[i].outer * 1e6) * 1e-6,
                 d->section[i].inner, (int)ceil(40 * d->section[i].length / d->length));
}

static void write_groups(struct drawn *d)
{
    int end = d->sections - d->right;
    double shaft = d->layered ? between(d, 0.3, 0.6) : 1; /* of the diameter */
    write_group(d, "left", "steel", 0, d->left, 1);
    write_group(d, "core", d->layered ? "steel" : "own", d->left, end, shaft);
    write_group(d, "right", "steel", end, d->sections, 1);
    if (d->layered)
        hide_add(d->text, "*LAYER, NAME=stack, GROUP=core, MATERIAL=own\n");
    for (int i = d->left; i < end && d->layered; i++)
        hide_add(d->text, "%.6f, %.6f\n", d->section[i].outer, floor(shaft * d->section[i].outer * 1e6) * 1e-6);
}

/* Tie rods through the core, or bare holes. */
static void write_rods(struct drawn *d)
{
    double diameter = d->diameter * between(d, 0.02, 0.045), pitch = d->diameter * between(d, 0.33, 0.37);
    int number = 6 + hide_pick(&d->random, 11);
    if (d->left + d->right == 0 || d->layered)
        return;
    if (chance(d, 0.2))
        hide_add(d->text, "*TIEROD, NAME=ties, MATERIAL=steel, FROM=core.start, TO=core.end%s\n%d, %.6f, %.6f, %.5g\n",
                 chance(d, 0.5) ? ", MODEL=TUBE" : "", number, diameter, pitch,
                 between(d, 4e7, 2e8) * pi / 4 * diameter * diameter);
    else if (chance(d, 0.1))
        hide_add(d->text, "*PERFORATION, GROUP=core\n%d, %.6f, %.6f\n", number, diameter, pitch);
}

static void write_disks(struct drawn *d)
{
    int count = chance(d, 0.3) ? 1 + hide_pick(&d->random, 2) : 0;
    for (int i = 0; i < count; i++) {
        double mass = d->mass * log_between(d, 0.005, 0.12), radius = d->diameter * between(d, 0.15, 0.5);
        double z = i ? d->length - between(d, 0, d->length - d->core_to + 0.02 * d->length)
                     : between(d, 0, d->core_from + 0.02 * d->length);
        hide_add(d->text, "*DISK, NAME=disk%d\n%.6f, %.5g, %.5g, %.5g\n", i + 1, z, mass, mass * radius * radius / 4,
                 mass * radius * radius / 2);
    }
}

/* A lateral spring of 500 EI/L3 would be as stiff as the first elastic mode of a uniform free beam is. Between soft and stiff lie
 * rotors of which nobody can say which modes are elastic. */
static void write_supports(struct drawn *d)
{
    double kind = hide_uniform(&d->random), first = 500 * d->bending / pow(d->length, 3);
    int inboard = chance(d, 0.5), soft = kind < 0.6;
    if (kind < 0.3)
        hide_add(d->text, "*SLING, LENGTH=%.3f\n", log_between(d, 0.5, 3));
    else if (kind < 0.9)
        for (int i = 0; i < 2; i++) {
            double z = inboard ? d->length * between(d, 0.06, 0.25) : 0, k = first;
            k *= soft ? log_between(d, 1e-4, 3e-3) : log_between(d, 2, 50);
            hide_add(d->text, "*SPRING, NAME=%s\n%.6f, %.5g\n", i ? "rear" : "front", i ? d->length - z : z, k);
        }
}

static void write_sensors(struct drawn *d)
{
    int count = 8 + hide_pick(&d->random, MOST_SENSORS - 7), even = chance(d, 0.6);
    double margin = chance(d, 0.5) ? 0 : between(d, 0, 0.05), gap = (1 - 2 * margin) / (count - 1);
    hide_add(d->text, "*SENSORS\n");
    for (int i = 0; i < count; i++) {
        double at = margin + gap * (i + (even ? 0 : between(d, -0.3, 0.3)));
        hide_add(d->text, "%d, %.6f\n", i + 1, d->length * fmin(fmax(at, 0), 1 - 1e-6));
    }
}

static void write_identify(struct drawn *d)
{
    const char *group = d->layered ? "stack" : "core";
    hide_add(d->text, "*IDENTIFY\n%s.E, %.4g, %.4g, %.4g\n", group, 0.2 * d->core_e, 4 * d->core_e,
             d->core_e * between(d, 0.7, 1.3));
    if (!d->isotropic)
        hide_add(d->text, "%s.G, %.4g, %.4g, %.4g\n", group, 0.1 * d->core_g, 8 * d->core_g, d->core_g * between(d, 0.7, 1.3));
}

char *power_rotor(uint64_t seed)
{
    struct hide_text text = {NULL, 0, 0, 0};
    struct drawn d = {.text = &text};
    hide_random_open(seed, HIDE_FOR_ROTOR, &d.random);
    draw_sections(&d);
    draw_materials(&d);
    write_materials(&d);
    write_groups(&d);
    write_rods(&d);
    write_disks(&d);
    write_supports(&d);
    write_sensors(&d);
    write_identify(&d);
    if (!text.failed)
        return text.data;
    free(text.data);
    return NULL;
}
