#include "paper_rotor.h"

const double paper_measured_hz[PAPER_MODES] = {435.55, 735.16, 1159.4, 1802.0, 2425.8, 2918.4};
const double paper_start[2] = {0.6e11, 0.3e11};
const struct parameter paper_parameters[2] = {{PARAMETER_E, 1, 0, 0, NULL}, {PARAMETER_G, 1, 0, 0, NULL}};

static const struct {
    int group, elements;
    double length, diameter;
} steps[] = {{0, 14, 0.132750, 0.098602}, {0, 13, 0.123268, 0.197920}, {0, 13, 0.123268, 0.228314}, {0, 13, 0.123268, 0.193377},
             {0, 5, 0.047411, 0.290272},  {0, 8, 0.075857, 0.334859},  {1, 50, 0.924192, 0.334092}, {2, 8, 0.065083, 0.334859},
             {2, 4, 0.032542, 0.170497},  {2, 12, 0.097625, 0.211909}, {2, 12, 0.097625, 0.259863}, {2, 12, 0.097625, 0.169163},
             {2, 11, 0.089489, 0.145809}};

#define STEPS ((int)(sizeof steps / sizeof *steps))

static struct group groups[3];
static struct segment segments[STEPS];
static struct tierod rod;
static struct spring springs[2];
static struct sensor sensors[PAPER_SENSORS];
static struct rotor rotor;

struct rotor *paper_rotor(enum bundle_model model, int self_equilibrated)
{
    const struct material steel = {.name = "steel", .e = 2.1e11, .nu = 0.3, .rho = 7850, .isotropic = 1},
                          core = {.name = "core", .e = 0.6e11, .g = 0.3e11, .nu = 0.28, .rho = 7380.66};
    groups[0] = (struct group){.layer_of = -1, .name = "left", .material = steel};
    groups[1] = (struct group){.layer_of = -1, .name = "core", .material = core};
    groups[2] = (struct group){.layer_of = -1, .name = "right", .material = steel};
    rotor = (struct rotor){.ngroup = 3,
                           .group = groups,
                           .nsegment = STEPS,
                           .segment = segments,
                           .ntierod = 1,
                           .tierod = &rod,
                           .nspring = 2,
                           .spring = springs,
                           .nsensor = PAPER_SENSORS,
                           .sensor = sensors};
    double node[200], z = 0, from, to;
    int count = 0;
    for (int s = 0; s < STEPS; s++) {
        segments[s] = (struct segment){.group = steps[s].group,
                                       .elements = steps[s].elements,
                                       .length = steps[s].length,
                                       .outer = steps[s].diameter,
                                       .stiff_outer = steps[s].diameter};
        for (int e = 0; e < steps[s].elements; e++)
            node[count++] = z + steps[s].length * e / steps[s].elements;
        z += steps[s].length;
    }
    node[count] = z;
    for (int k = 0; k < PAPER_SENSORS; k++)
        sensors[k] = (struct sensor){k + 1, node[(int)lround(175.0 * k / 67)]};
    rotor_group_span(&rotor, 1, &from, &to);
    rod = (struct tierod){.name = "ties",
                          .material = steel,
                          .from = from,
                          .to = to,
                          .model = model,
                          .self_equilibrated = self_equilibrated,
                          .number = 12,
                          .elements = 1,
                          .diameter = 0.032,
                          .pitch = 0.13364,
                          .tension = 150e3};
    springs[0] = (struct spring){"left", 0, 9790, 0, 0, 0};
    springs[1] = (struct spring){"right", z, 2000, 0, 0, 0};
    return &rotor;
}
