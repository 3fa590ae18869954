/* How the hybrid functionals grow away from the optimum: Figure 3 of the paper. */
#ifndef ROTID_RUN_GROWTH_H
#define ROTID_RUN_GROWTH_H

struct job;
struct parameter;
struct pool;

enum { GROWTH_E, GROWTH_F, GROWTH_KINDS }; /* HYBRID with (15), HYBRID_F with (16) */

/* one of the functionals */
struct growth_line {
    int nepsilon_squared; /* as in struct growth */
    double *objective;    /* at each epsilon_squared, all parameters raised by epsilon [1]; NaN where the model has no modes */
    double slope;         /* of ln objective over ln epsilon_squared by least squares, which theory says is 1 [1]; NaN where an
                             objective is none, or rounding */
    double intercept;     /* of the same line [1]; NaN as well */
};

struct growth {
    int nepsilon_squared;
    double *epsilon_squared;     /* abscissa, evenly in the logarithm [1] */
    struct growth_line hybrid;   /* FUNCTIONAL=HYBRID, f with E of (15) */
    struct growth_line hybrid_f; /* FUNCTIONAL=HYBRID_F, f with F of (16) */
    double *shapes_alone; /* objective of HYBRID with the shapes perturbed and the parameters left [1]: nothing but rounding
                             (docs/errata.md) */
};

/* Data: frequencies and shapes of modes 1 ... modes of the model itself at x0 [n] of the parameters, so that f(x0) = 0, by the
 * reduction of the job's FIT; as in (17) and (18) every parameter is raised by eps, and to each measured shape eps times an
 * arbitrary vector of its own length is added, drawn from `seed`. Statuses of the prediction. */
int growth_run(struct pool *pool, const struct job *job, int n, const struct parameter *parameter, const double *x0, int modes,
               unsigned long seed, struct growth *growth);

#endif
