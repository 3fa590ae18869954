#include "diagnose/diagnose.h"

int job_as_solid(struct pool *pool, const struct job *from, struct job *to)
{
    const struct job copy = *from, *job = &copy; /* `to` may be the same */
    *to = *job;
    to->options.solid = 1;
    to->models = models_solids(job->models);
    to->unknowns.nsuspect = 0;
    to->unknowns.suspect = POOL_ARRAY(pool, struct suspect, job->unknowns.nsuspect);
    if (!to->models || !to->unknowns.suspect)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < job->unknowns.nsuspect; i++)
        if (!cause_of_beam(catalogue_of(&job->unknowns.suspect[i].effect)))
            to->unknowns.suspect[to->unknowns.nsuspect++] = job->unknowns.suspect[i];
    return ROTID_OK;
}

#define MOST_UNKNOWNS 40000 /* a gigabyte of matrices: no rotor with steps that a test can see has so many */

/* *unknowns: how many the rotor of the job has, which stays built. Statuses of discrete_build. */
static int solid_unknowns(struct pool *pool, const struct job *solid, int *unknowns)
{
    struct discrete discrete;
    rotid_matrix structure = {.n = 0};
    int failed, nrigid, status = models_discretise(pool, solid->models, &solid->rotor, 0, NULL, 1, &discrete, &nrigid, &failed);
    if (!status)
        discrete_structure(&discrete, &structure);
    *unknowns = structure.n;
    return status;
}

/* Holds the coarse mesh of a solid at x to the one that counts. */
static int hold_mesh(struct pool *pool, struct job *solid, const double *x, double *moved)
{
    struct spectrum spectrum;
    int status = spectrum_compute_parts(pool, solid->models, &solid->rotor, solid->unknowns.nparameter, solid->unknowns.parameter,
                                        x, ROTID_GUYAN, comparison_candidates(solid), SPECTRUM_MESH, &spectrum);
    return status ? status : mesh_hold(pool, solid, &spectrum, moved);
}

#define HELD_ROUNDS 4
#define HELD_LEAST  0.1 /* of the noise of a frequency */

int refit_held(struct pool *pool, const int *number, const int *holdout, const rotid_environment *environment,
               struct refit *refit)
{
    int status = ROTID_OK, moves = refit->fit != NULL;
    for (int round = 0; round < HELD_ROUNDS && moves && !status; round++) {
        rotid_fit_result *fit = NULL;
        moves = 0;
        for (int s = 0; s < refit->states.nstate && !status; s++) {
            struct job *job = &refit->states.state[s].job;
            double *own = state_values(pool, &refit->states.state[s], refit->fit->x), moved = 0, least = INFINITY;
            for (int k = 0; k < job->measurement.nmode; k++)
                least = fmin(least, job->measurement.frequency_std[k]);
            status = own ? hold_mesh(pool, job, own, &moved) : ROTID_ERROR_MEMORY;
            moves |= moved > HELD_LEAST * least;
        }
        if (!status && moves)
            status = refit_states(pool, &refit->states, number, holdout, environment, &fit);
        if (!status && moves)
            status = refit_keep(pool, &refit->states, fit, refit);
    }
    return status == ROTID_ERROR_MEMORY || status == ROTID_STOP_CANCELLED ? status : ROTID_OK; /* the fit before stands */
}

#define HOPELESS                                                                                                                 \
    4 /* times the chi2 of the beam, by the coarse mesh: whose error is a twentieth of what a beam lacks at a step               \
       */

/* chi2 that the residual of the solids at x leaves where the beams' columns take what is fitted anyway. */
static int chi2_left(struct pool *pool, const struct states *solids, const int *number, const int *holdout, const double *x,
                     const struct scan *scan, double *left)
{
    double *r = POOL_ARRAY(pool, double, scan->nrow);
    int row = 0;
    if (!r)
        return ROTID_ERROR_MEMORY;
    for (int s = 0, mode = 0; s < solids->nstate; mode += solids->state[s].job.measurement.nmode, s++) {
        struct columns columns;
        double *own = state_values(pool, &solids->state[s], x);
        if (!job_fitted(&solids->state[s].job, holdout + mode))
            continue;
        int status = own ? columns_open(pool, &solids->state[s].job, number + mode, holdout + mode, NULL, own, &columns)
                         : ROTID_ERROR_MEMORY;
        if (status)
            return status;
        memcpy(r + row, columns.r, (size_t)columns.nrow * sizeof *r);
        row += columns.nrow;
    }
    *left = product_dot(scan->nrow, r, r);
    *left -= basis_remove(scan->nrow, scan->nbasis, scan->basis, r);
    return ROTID_OK;
}

/* The states as solids; *unknowns: of the largest. */
static int open_solids(struct pool *pool, const struct states *states, struct states *solids, int *unknowns)
{
    int status = states_copy(pool, states, solids), size;
    *unknowns = 0;
    for (int s = 0; s < states->nstate && !status; s++) {
        status = job_as_solid(pool, &states->state[s].job, &solids->state[s].job);
        if (!status)
            status = solid_unknowns(pool, &solids->state[s].job, &size);
        *unknowns = !status && size > *unknowns ? size : *unknowns;
    }
    return status;
}

int scan_solid(struct pool *pool, struct states *states, const int *number, const int *holdout, const double *x,
               struct scan *scan, struct message_list *notes)
{
    double left, moved, before = product_dot(scan->nrow, scan->r, scan->r);
    for (int i = 0; i < scan->ncandidate; i++) {
        struct scan_candidate *c = &scan->candidate[i];
        struct states solids;
        int unknowns, status;
        if (!c->cause->solid)
            continue;
        status = open_solids(pool, states, &solids, &unknowns);
        if (!status && unknowns > MOST_UNKNOWNS) {
            if (notes)
                message_add(notes, SEVERITY_NOTE, NULL, 0, 0,
                            "the rotor as a solid has %d unknowns, too many to be tested here (at most %d): see rotid modes "
                            "--compare, and diagnose the deck with MODEL=SOLID on *FIT",
                            unknowns, MOST_UNKNOWNS);
            return ROTID_OK;
        }
        for (int s = 0; s < solids.nstate && !status; s++)
            status = mesh_hold_as_it_is(pool, &solids.state[s].job, comparison_candidates(&solids.state[s].job));
        if (!status)
            status = chi2_left(pool, &solids, number, holdout, x, scan, &left);
        if (!status && left < HOPELESS * before) {
            for (int s = 0; s < solids.nstate && !status; s++) {
                double *own = state_values(pool, &solids.state[s], x);
                status = own ? hold_mesh(pool, &solids.state[s].job, own, &moved) : ROTID_ERROR_MEMORY;
            }
            if (!status)
                status = chi2_left(pool, &solids, number, holdout, x, scan, &left);
        }
        if (status) /* the rotor can be no solid: nothing to propose */
            return status == ROTID_ERROR_MEMORY ? status : ROTID_OK;
        c->promise = fmax(0, before - left);
        for (int s = 0; s < solids.nstate; s++)
            states->state[s].job.held = solids.state[s].job.held;
    }
    return ROTID_OK;
}
