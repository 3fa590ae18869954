/* A fit of a solid runs on the coarse mesh, whose frequencies are held in ratio to the limit that this mesh and the one that
 * counts lead to, and whose shapes at their distance from the shapes of the latter: both hardly depend on E and G. Condensed
 * matrices have no such ratio. What is held lies with the models of the run (models_hold). */
#ifndef ROTID_RUN_HELD_MESH_H
#define ROTID_RUN_HELD_MESH_H

#include "run/job.h"
#include "run/spectrum.h"

/* Whether fits of the job run on the coarse mesh. */
int mesh_is_held(const struct job *job);

/* Takes the coarse mesh as it stands for the first `count` modes, unless something is held. ROTID_OK or ROTID_ERROR_MEMORY. */
int mesh_hold_as_it_is(struct pool *pool, const struct job *job, int count);

/* Holds ratio and distance at the parameters of a spectrum with SPECTRUM_MESH; *moved: by how much the ratio differs from what
 * was held. ROTID_OK or ROTID_ERROR_MEMORY. */
int mesh_hold(struct pool *pool, const struct job *job, const struct spectrum *spectrum, double *moved);

/* The mesh for fits with this pairing [nmode], model_open's refine, and the measured frequencies and shapes as that mesh has
 * them, frequency_hz [nmode], shape [nsensor * nmode] (NULL where none are measured). ROTID_OK or ROTID_ERROR_MEMORY. */
int mesh_of_fit(struct pool *pool, const struct job *job, const int *number, int *refine, double **frequency_hz,
                const double **shape);

#endif
