/* The lowest eigenpairs of a chain of elements condensed by Guyan onto its masters, K~ x = lambda M~ x, without K~ and M~, which
 * are full. Two steps of elimination, exact for K~ and M~ alike:
 * 1. what lies between the pairs (2 i, 2 i + 1) of degrees of freedom that hold a master or are far is condensed piece by piece;
 * K and M of the pairs that are kept are a band again;
 * 2. of these the slaves follow from (K u)_s = 0. That is a constraint with forces w for
 *      [K - sigma M, K_.s; K_s., 0] [u; w] = [M u_before; 0],
 *    a band as well, whose solution is one inverse iteration with a shift on the condensed problem.
 * From near pairs (of the call before, or given) this converges as Rayleigh quotients do, as in eigen_polish.h. */
#ifndef ROTID_LINALG_EIGEN_GUYAN_H
#define ROTID_LINALG_EIGEN_GUYAN_H

#include "base/pool.h"
#include "linalg/arrow.h"
#include "rotid.h"

struct guyan_piece {       /* between two pairs that are kept */
    int from, length;      /* degrees of freedom */
    int first, nend;       /* ends: rows of K2, first ... first + nend - 1 */
    double *k_end, *m_end; /* [length * nend] coupling to the ends */
    double *x;             /* [length * nend] static shapes: inner = x end */
};

struct eigen_guyan {
    int applies; /* 0: this structure has to be solved in full */
    int n, nc, count, from;
    int near;         /* u holds vectors near the pairs */
    int nkept, *kept; /* [nkept] degrees of freedom, increasing */
    int *master;      /* [nc] places in `kept` */
    int *row, *force; /* [nkept] rows of the bordered matrix: of u, and of w, -1 for masters */
    int rows;
    int npiece;
    struct guyan_piece *piece;
    rotid_matrix k, m; /* of the kept ones */
    struct arrow bordered;
    int *mark;                       /* [n] */
    double *cholesky;                /* [4 * longest piece] */
    double *image;                   /* [longest piece * 4] */
    double *u;                       /* [nkept * count] */
    double *value, *next, *expected; /* [count] */
    double *right;                   /* [rows * max(count, ARROW_SHIFTS)] */
    double *y, *product, *squares, *work;
};

/* For the lowest `count` pairs of matrices structured as `structure`, of which those before `from` are wanted as neighbours
 * alone. master [nc] is increasing. ROTID_OK, also where e->applies comes out as 0, or ROTID_ERROR_MEMORY. */
int eigen_guyan_new(struct pool *pool, const rotid_matrix *structure, int nc, const int *master, int count, int from,
                    struct eigen_guyan *e);

/* The next solution begins with phi [n * count], vectors of the full model near the pairs. */
void eigen_guyan_begin(struct eigen_guyan *e, const double *phi);

/* near [count]: eigenvalues as they are expected, or NULL: Rayleigh quotients. lambda [count], may be near, x [nc * count] with
 * x' M~ x = 1. Returns 0, or 1 where the problem has to be solved in full: no vectors to begin with, or they do not lead to the
 * lowest pairs, which a Sturm count tells. */
int eigen_guyan_solve(struct eigen_guyan *e, const rotid_matrix *k, const rotid_matrix *m, const double *near, double *lambda,
                      double *x);

/* u [n] := T x of pair j of the last solution */
void eigen_guyan_expand(const struct eigen_guyan *e, int j, double *u);

#endif
