/* Factors of a banded matrix with a small block, bordered: the far degrees of freedom come last,
 *   [A_rr A_rf; A_fr A_ff],  X = A_rr^-1 A_rf,  S = A_ff - A_fr X,
 * so the cost stays O(n kd^2 + n nfar kd). Restricted to the rows and columns in `kept`. */
#ifndef ROTID_LINALG_FACTOR_H
#define ROTID_LINALG_FACTOR_H

#include "base/pool.h"
#include "linalg/pencil.h"
#include "linalg/wide.h"
#include "rotid.h"

#define FACTOR_WIDE 12 /* half band from which panels and a block iteration on them take less time for eigenpairs */

enum factor_kind {
    FACTOR_CHOLESKY, /* positive definite */
    /* indefinite: by LU with pivoting in narrow bands, by L S L' without in wide ones. S is solved as it comes, so an ill-placed
     * A_rr costs digits as a small pivot does: refine where that matters */
    FACTOR_LU
};

struct factor {
    enum factor_kind kind;
    int n;           /* number kept */
    const int *kept; /* [n] degrees of freedom of the full matrix, increasing */
    int nr, nf, kd, lda;
    int is_wide;
    int *position;      /* [full n] place among the inner ones >= 0, -1 - place among the outer ones, or INT_MIN: not kept */
    int *same;          /* [nr] 0 ... nr - 1 */
    int *inner;         /* [nr] place in `kept` of each inner degree of freedom */
    int *outer;         /* [nf] of each far one */
    double *band;       /* [lda * nr]; of narrow bands */
    struct wide wide;   /* of wide ones */
    int *reach, *row;   /* [nr] last row of each column of A_rr, [kd + 1] rows of a column that are not zero */
    double *value;      /* [kd + 1] entries there */
    double *coupling;   /* [nr * nf] A_rf */
    double *x;          /* [nr * nf] */
    double *schur;      /* [nf * nf] factored */
    double *work;       /* [8 n], right-hand sides interleaved */
    double *outer_work; /* [8 nf] */
    int *first, *last;  /* [nf] range of the rows of A_rf that are not zero */
    double *schur_work; /* [4 nf] */
    int *band_pivot, *schur_pivot;
};

/* Workspace for matrices structured as `structure`; kept [n] must outlive it. ROTID_OK or ROTID_ERROR_MEMORY. */
int factor_new(struct pool *pool, enum factor_kind kind, const rotid_matrix *structure, int n, const int *kept, struct factor *f);

/* Keeps other rows from now on, as many or fewer than at factor_new. */
void factor_keep(struct factor *f, const rotid_matrix *structure, int n, const int *kept);

/* Returns 0, or 1 when A is not positive definite (Cholesky) or singular (LU). Allocates nothing. */
int factor_compute(struct factor *f, const rotid_matrix *a);

/* The same of K - shift M; of wide bands alone. */
int factor_compute_pencil(struct factor *f, const struct pencil *p, double shift);

/* After a Cholesky factorisation of `a`: 1 where a pivot is within rounding of zero, so that A is singular but for rounding. */
int factor_is_singular(const struct factor *f, const rotid_matrix *a);

/* B [n * columns], in the order of `kept`, is overwritten by A^-1 B. */
void factor_solve(struct factor *f, int columns, double *b);

/* Number of negative eigenvalues of A (all rows), by LDL' without pivoting (Sturm sequence) on the inner part and the signs of
 * the Schur complement: reliable unless an eigenvalue lies within rounding of zero. f must keep all rows; it is overwritten.
 * Returns the number, or -1 on failure. */
int factor_negative_count(struct factor *f, const rotid_matrix *a);
/* The same of K - shift M; of wide bands alone. */
int factor_negative_count_pencil(struct factor *f, const struct pencil *p, double shift);

/* Is a matrix of this structure factored in panels? */
int factor_is_wide(const rotid_matrix *structure);

#endif
