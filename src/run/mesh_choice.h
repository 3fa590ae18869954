/* Elements for sections of which the deck states none. */
#ifndef ROTID_RUN_MESH_CHOICE_H
#define ROTID_RUN_MESH_CHOICE_H

#include "run/job.h"

#define MESH_CHOICE_SHARE   0.1 /* of the noise: the mesh then moves an estimate by less than a tenth of its standard deviation */
#define MESH_CHOICE_ERROR   1e-4 /* relative error of a frequency where no noise is known */
#define MESH_CHOICE_MODES   6    /* where none is measured */
#define MESH_CHOICE_LARGEST 1000 /* elements of all these sections */

struct mesh_choice {
    int elements;    /* of these sections */
    double length_m; /* of the longest of them */
    int mode;        /* the highest that counts */
    double wanted;   /* relative error of a frequency that the mesh may have */
    double error;    /* that it has, the largest of modes 1 to `mode`; NaN where it is not known */
    int is_noise_known;
};

/* Writes elements into the sections section[count] of job->rotor. All elements are about equally long, h: the error of a
 * frequency falls as h^2, so that of a first mesh, by its Richardson limit, gives h. The error is that of modes 1 to the highest
 * measured one, at the values of the rotor, and is at most MESH_CHOICE_SHARE of the smallest relative standard deviation of a
 * measured frequency. With MESH_CHOICE_LARGEST elements it ends. Where the model has no such modes (a section that cannot be) the
 * first mesh is left. ROTID_OK or ROTID_ERROR_MEMORY. */
int mesh_choose(struct pool *pool, struct job *job, int count, const int *section, struct mesh_choice *choice);

#endif
