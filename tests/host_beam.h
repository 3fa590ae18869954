/* A host of rotid_fit that builds its matrices with the building blocks. */
#ifndef ROTID_TESTS_HOST_BEAM_H
#define ROTID_TESTS_HOST_BEAM_H

#include "support.h"

/* A free beam of two halves, EI = x1 and x2 (times 1e5) and the shear stiffness with them, on soft springs; a tie of stiffness x3
 * between its ends where there is one. `failed`: a building block refused. */
struct beam_host {
    int elements, tied, failed;
    rotid_model model;
    int far[2], master[2000];
};

enum { BEAM_MODES = 5 };
extern const double beam_truth[3];
extern const rotid_parameter beam_parameters[3];

struct beam_data {
    double hz[BEAM_MODES], hz_std[BEAM_MODES], *shape, *shape_std;
    rotid_measured measured;
};

/* Callbacks of rotid_model; `user` is the struct. */
int beam_matrices(void *user, const double *x, rotid_matrix *k, rotid_matrix *m);
int beam_derivatives(void *user, const double *x, int p, rotid_matrix *dk, rotid_matrix *dm);

/* Sensors measure the deflection of every `every`-th node. kd 0: as narrow as the elements and the tie let it be. */
void beam_host_open(struct beam_host *host, int elements, int kd, int tied, int every);

/* Frequencies and shapes at the truth, with a pinch of error so that the residual is not zero. */
void beam_host_measure(struct pool *pool, struct beam_host *host, int reduction, struct beam_data *data);

#endif
