/* Decks of rotors with everything that can be exported, and their models. */
#ifndef ROTID_TESTS_EXPORTED_H
#define ROTID_TESTS_EXPORTED_H

#include "export/export.h"
#include "export_readers.h"
#include "support.h"

#define STEEL "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*DENSITY\n7850\n"
#define CORE  "*MATERIAL, NAME=sheets\n*ELASTIC, TYPE=SHEAR\n1.1e11, 0.35e11, 0.28\n*DENSITY\n7600\n"
#define SHAFT                                                                                                                    \
    "*SHAFT, NAME=left, MATERIAL=steel\n0.25, 0.08, 0.02, 4\n*SHAFT, NAME=core, MATERIAL=sheets\n0.5, 0.2, 0.05, 8\n"            \
    "*SHAFT, NAME=right, MATERIAL=steel\n0.25, 0.09, 0, 4, 0.08\n"
#define SENSORS "*SENSORS\n11, 0\n12, 0.2\n13, 0.41\n14, 0.6\n15, 0.8\n16, 1\n"
#define TIES    "*TIEROD, NAME=ties, MATERIAL=steel, FROM=core.start, TO=core.end\n8, 0.016, 0.07, 40e3"
#define CAUSES                                                                                                                   \
    "*CAUSE, NAME=gap, TYPE=joint, BETWEEN=core,right\nflexibility, 2e-7\n*CAUSE, NAME=ring, TYPE=added_mass\nmass, 0.7\nz, "    \
    "0.333\n"                                                                                                                    \
    "*CAUSE, NAME=slope, TYPE=stiffness_gradient, GROUP=core\nslope, 0.2\n*CAUSE, NAME=heavy, TYPE=density, "                    \
    "GROUP=left\nfactor, 1.1\n"
#define FREE STEEL CORE SHAFT SENSORS
#define MIXED                                                                                                                    \
    FREE TIES "\n*PERFORATION, GROUP=core\n12, 0.02, 0.06\n*SPRING\n0.1, 1e5, 2e3\n*DISK, NAME=fan\n0.9, 6, 0.02, 0.04\n" CAUSES
#define BARS FREE TIES ", 4\n*BARS, NAME=cage, MATERIAL=steel, CENTER=0.5, LENGTH=0.4\n12, 0.012, 0.08, 4\n"

/* A deck as a job and as a model, in the pool of the test. */
void open_job(const char *text, struct job *job);
struct export_model model_of(const char *text);

/* u' A w */
double quadratic(const struct dense_file *a, const double *u, const double *w);

#endif
