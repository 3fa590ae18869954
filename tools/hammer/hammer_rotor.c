/* Rotors that are built in, as decks. Elements are so many that the mesh shifts no measured mode by 2e-5. */
#include <stdlib.h>

#include "hammer.h"
#include "hide/hide_text.h"

struct section {
    const char *group; /* NULL: goes on with the one before */
    double length, diameter;
    int elements; /* of input/paper_rotor.inp */
};

/* Geometry and points as in input/paper_rotor.inp: node round(175 k/67), k = 0 ... 67, of its 175 elements. */
static const struct section paper[] = {
    {"left", 0.132750, 0.098602, 14}, {NULL, 0.123268, 0.197920, 13},   {NULL, 0.123268, 0.228314, 13},
    {NULL, 0.123268, 0.193377, 13},   {NULL, 0.047411, 0.290272, 5},    {NULL, 0.075857, 0.334859, 8},
    {"core", 0.924192, 0.334092, 50}, {"right", 0.065083, 0.334859, 8}, {NULL, 0.032542, 0.170497, 4},
    {NULL, 0.097625, 0.211909, 12},   {NULL, 0.097625, 0.259863, 12},   {NULL, 0.097625, 0.169163, 12},
    {NULL, 0.089489, 0.145809, 11}};

#define SECTIONS     ((int)(sizeof paper / sizeof *paper))
#define PAPER_FINER  5
#define PAPER_NODES  175
#define PAPER_POINTS 68

/* Place of a node of the paper's mesh. */
static double node_place(int node)
{
    double z = 0;
    for (int i = 0; i < SECTIONS; i++) {
        if (node <= paper[i].elements)
            return z + paper[i].length * node / paper[i].elements;
        node -= paper[i].elements;
        z += paper[i].length;
    }
    return z;
}

static void add_paper(struct hide_text *text)
{
    hide_add(text, "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.30\n*DENSITY\n7850\n"
                   "*MATERIAL, NAME=lamination\n*ELASTIC, TYPE=SHEAR\n0.9e11, 0.30e11, 0.28\n*DENSITY\n7380.66\n");
    for (int i = 0; i < SECTIONS; i++) {
        if (paper[i].group)
            hide_add(text, "*SHAFT, NAME=%s, MATERIAL=%s\n", paper[i].group, paper[i].elements == 50 ? "lamination" : "steel");
        hide_add(text, "%.6f, %.6f, 0, %d\n", paper[i].length, paper[i].diameter, PAPER_FINER * paper[i].elements);
    }
    hide_add(text, "*TIEROD, NAME=ties, MATERIAL=steel, FROM=core.start, TO=core.end, MODEL=RODS, SELF_EQUILIBRATED=NO\n"
                   "12, 0.032, 0.13364, 150e3, 1\n"
                   "*SPRING, NAME=sling\nstart, 9790\n*SPRING, NAME=tail\nend, 2000\n"
                   "*IDENTIFY\ncore.E, 1e10, 2.3e11, 0.9e11\ncore.G, 0.5e10, 0.898e11, 0.30e11\n*SENSORS\n");
    for (int k = 0; k < PAPER_POINTS; k++)
        hide_add(text, "%d, %.6f\n", k + 1, node_place((2 * PAPER_NODES * k + PAPER_POINTS - 1) / (2 * (PAPER_POINTS - 1))));
}

/* 6 kg of round bar on two soft cords: light enough for an accelerometer to matter. */
#define BEAM_POINTS 21

static void add_beam(struct hide_text *text)
{
    hide_add(text, "*MATERIAL, NAME=steel\n*ELASTIC, TYPE=SHEAR\n1.9e11, 0.73e11, 0.30\n*DENSITY\n7850\n"
                   "*SHAFT, NAME=bar, MATERIAL=steel\n1.2, 0.02848, 0, 480\n"
                   "*SPRING, NAME=cord_left\nstart, 200\n*SPRING, NAME=cord_right\nend, 200\n"
                   "*IDENTIFY\nbar.E, 1e11, 3e11, 1.9e11\nbar.G, 0.4e11, 1.2e11, 0.73e11\n*SENSORS\n");
    for (int k = 0; k < BEAM_POINTS; k++)
        hide_add(text, "%d, %.6f\n", k + 1, 1.2 * k / (BEAM_POINTS - 1));
}

char *hammer_rotor_deck(const char *name, struct hammer_options *options, int *truths, const char *const **truth)
{
    static const char *const paper_truth[] = {"core.E=1.15e11", "core.G=0.40e11"};
    static const char *const beam_truth[] = {"bar.E=2.06e11", "bar.G=0.795e11"};
    static const double beam_damping[] = {5e-3, 4e-3, 3e-3, 2.5e-3, 2e-3};
    struct hide_text text = {NULL, 0, 0, 0};
    if (hide_same(name, "paper")) {
        add_paper(&text);
        *truth = paper_truth;
    } else if (hide_same(name, "beam")) {
        add_beam(&text);
        *truth = beam_truth;
        options->dampings = (int)(sizeof beam_damping / sizeof *beam_damping);
        for (int k = 0; k < options->dampings; k++)
            options->damping[k] = beam_damping[k];
    }
    *truths = 2;
    if (!text.failed)
        return text.data;
    free(text.data);
    return NULL;
}
