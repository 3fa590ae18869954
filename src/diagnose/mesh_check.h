/* What the error of the mesh is worth beside the noise. */
#ifndef ROTID_DIAGNOSE_MESH_CHECK_H
#define ROTID_DIAGNOSE_MESH_CHECK_H

#include "diagnose/engine.h"

/* worth = ||(I - Q Q') (r' - r)||^2: r the residual of the base at its fitted values, r' that of `finer`, the same job with more
 * elements, Q an orthonormal basis of the sensitivities of the fitted parameters, which take up the rest. It is the chi2 that a
 * cause could gain from the mesh alone. Frequencies do not tell it: of two modes close to each other a mesh that moves both by
 * little turns the shapes. 0 where the finer mesh has no such modes. ROTID_OK, ROTID_ERROR_MEMORY. */
int mesh_worth(const struct engine *engine, const struct job *finer, double *worth);

#endif
