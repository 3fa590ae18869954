/* Which rows there are, and where their points lie in the model. */
#ifndef ROTID_RUN_FRF_POINTS_H
#define ROTID_RUN_FRF_POINTS_H

#include "model/model.h"
#include "run/frf_run.h"

/* Rows of the request, of the measured functions, or of every sensor over the first, in out->row and out->nrow; out->nleft_out.
 * ROTID_OK, ROTID_ERROR_MEMORY, ROTID_ERROR_ARGUMENT with an error in the list. */
int frf_choose_rows(struct pool *pool, const struct job *job, const struct frf_measured *measured, struct message_list *notes,
                    struct frf_result *out);

/* The model of the job with a mesh node at every point of the rows; pair [nrow] gets the points, dof [2 nrow] their lateral
 * degrees of freedom, *npoint their number. parameters: whether those of the job vary. Nodes that the file does not place and
 * that are no sensors are an error. Statuses of model_open besides. */
int frf_place_points(struct pool *pool, const struct job *job, int parameters, const struct frf_measured *measured,
                     struct message_list *notes, const struct frf_result *out, struct rotor_model *model,
                     struct synthesis_pair *pair, int *dof, int *npoint);

#endif
