#ifndef ROTID_LINALG_LINALG_H
#define ROTID_LINALG_LINALG_H

/* Linear algebra: symmetric banded matrices with a small dense block, their factors, eigenpairs and condensation; dense kernels.
 * In: K, M (rotid_matrix), right-hand sides, masters. Out: solutions, pairs K phi = lambda M phi with phi'M phi = 1, K~ and M~.
 *
 *   storage           matrix.c; matrix_check.c checks matrices of a host; pencil.c: nonzero entries of wide K and M side by side
 *   K - s M = L L', L U or L S L'   factor.c (factor_new, factor_compute, factor_solve): the far block by a Schur complement
 *                     S = A_ff - A_fr A_rr^-1 A_rf; narrow inner part band.c, half band >= FACTOR_WIDE by panels
 *   full eigenpairs   eigen_full.c (eigen_full_solve) chooses: eigen_band.c, block Krylov on (K - s M)^-1 M with Rayleigh-Ritz
 *                     (ritz_pairs), near pairs by arrow.c; wide bands (eigen_wide_solve), block Lanczos (lanczos.c); nearly full
 *                     ones eigen_dense.c. A Sturm count (factor_negative_count, arrow_count) shows that no pair is missed
 *   condensation      reduction.c (reduction_compute): u = T x, K~ = T'KT, M~ = T'MT by Guyan (11-13) or IRS, their derivatives
 *   condensed pairs   eigen_dense.c, dsygvx on M phi = mu (K - s M) phi; eigen_guyan.c: Guyan's without K~ and M~, on arrow.c,
 *                     bordered band factors of four shifts at once; eigen_band.c: the shift s < 0
 *   dense kernels     least_squares.c: damped step min |J h + r|^2 + mu |D h|^2, singular values; symmetric.c
 *                     (definite, indefinite), product.c, quadratic.c (lambda^2 M + lambda C + K without symmetry, complex
 *                     systems, a polynomial by its companion matrix)
 *   public doors      matrix_entry.c: rotid_eigenpairs, rotid_condense, rotid_matrix_*
 *
 * Callers: every room that computes. The only room that calls LAPACKE. It must not know what a degree of freedom or parameter is;
 * derivatives of eigenvectors (Nelson) are in src/modal. */

#include "base/base.h"

/* ----------------------------------------------------------------------------------------------------------------- arrow */

/* Symmetric indefinite matrices K - sigma M of a narrow band with a few full rows last, for several shifts at once: L D L'
 * without pivoting, which keeps the form. A pivot in which digits cancel is refused; another shift has others. What belongs to
 * the shifts is interleaved, x[i * ARROW_SHIFTS + shift]: four of them are one vector. What is computed for a shift does not
 * depend on the others. */

#define ARROW_SHIFTS 4

struct arrow_matrix {
    double *band;   /* [(kd + 1) * n] lower triangle, A(i, j) = band[(i - j) + j (kd + 1)] */
    double *border; /* [full * n] of each column of the band the full rows below */
    double *corner; /* [full * full] lower triangle */
};

struct arrow {
    int n, kd; /* of the band */
    int full;  /* rows below it */
    int first; /* column of the band from which the border is not zero */
    struct arrow_matrix k, m;
    struct arrow_matrix factor; /* of all shifts */
    double *magnitude;          /* [(n + full) * ARROW_SHIFTS] what has been added up in each pivot */
};

/* Zero matrices. ROTID_OK or ROTID_ERROR_MEMORY. */
int arrow_new(struct pool *pool, int n, int kd, int full, struct arrow *a);

void arrow_zero(struct arrow *a, struct arrow_matrix *matrix);

/* Adds to entries (i, j) and (j, i); rows from n on are the full ones. A diagonal entry gets it once. */
void arrow_add(struct arrow *a, struct arrow_matrix *matrix, int i, int j, double value);

/* matrix := A, whose degree of freedom i is row row[i] here: far ones are full rows, the others keep their order. */
void arrow_take(struct arrow *a, struct arrow_matrix *matrix, const rotid_matrix *from, const int *row);

/* Factors K - sigma M for ARROW_SHIFTS shifts. negative [ARROW_SHIFTS]: the number of negative eigenvalues, or -1 where a pivot
 * is lost: there is no factor then. */
void arrow_factor(struct arrow *a, const double *sigma, int *negative);

/* The number of negative eigenvalues for one shift, or -1. */
int arrow_count(struct arrow *a, double sigma);

/* b [(n + full) * ARROW_SHIFTS] := (K - sigma M)^-1 b, a right-hand side for each shift. */
void arrow_solve(const struct arrow *a, double *b);

/* ------------------------------------------------------------------------------------------------------------------ band */

/* Factors of a narrow band and their solutions, in LAPACK's storage. A beam's band is so narrow that LAPACK, which calls a BLAS
 * routine for every column, would spend its time on calls. Wide bands: struct wide.
 * Right-hand sides are interleaved, b[i * lanes + lane], lanes = 1, 2 or 4: the recurrences of one wait for each other; those
 * of four are one vector. What is computed in a lane does not depend on their number. */

#define BAND_LANES 4 /* most */

/* A = L L', lower triangle A(i, j) = band[(i - j) + j * (kd + 1)], overwritten by L. Returns 0, or 1 when A is not positive
 * definite. */
int band_cholesky(int n, int kd, double *band);
void band_cholesky_solve(int n, int kd, const double *band, int lanes, double *b);

/* P A = L U, A(i, j) = band[2 kd + (i - j) + j * (3 kd + 1)], the first kd rows zero; pivot [n] counts from 1. Returns 0, or 1
 * when A is singular. */
int band_lu(int n, int kd, double *band, int *pivot);
void band_lu_solve(int n, int kd, const double *band, const int *pivot, int lanes, double *b);

/* B := B - X R for B [n], R [count] interleaved, X [n * count] by columns */
void band_subtract(int n, int count, const double *x, int lanes, const double *r, double *b);

/* B [n] interleaved := rows row [n] of `columns` columns X, each of this length; lanes: columns, or 4 for 3. And back. */
void band_gather(int n, const int *row, int columns, int length, const double *x, int lanes, double *b);
void band_scatter(int n, const int *row, int columns, int length, int lanes, const double *b, double *x);

/* -------------------------------------------------------------------------------------------------------------- cholesky */

/* Real symmetric positive definite systems kept as their Cholesky factor A = L L' (LAPACK dpotrf, dpotrs, dtrtrs). */

/* a [n * n], of which the lower triangle is read, is overwritten there by L. n >= 0. Returns 0, or 1 where A is not positive
 * definite. */
int cholesky_factor(int n, double *a);

/* b [n * columns] := A^-1 b */
void cholesky_solve(int n, const double *factor, int columns, double *b);

/* b [n * columns] := L^-1 b */
void cholesky_forward(int n, const double *factor, int columns, double *b);

/* b [m] := L_m^-T b with the leading m * m block of L [n * n], which is the factor of the leading block of A: one factor and one
 * forward substitution serve the systems of all sizes m = 1 ... n. */
void cholesky_backward_leading(int m, int n, const double *factor, double *b);

/* ---------------------------------------------------------------------------------------------------------------- pencil */

/* The entries of two matrices of one wide structure that are not zero, K and M: made in one pass over the bands, which cost more
 * to read than the products and factors that follow. */

struct pencil {
    int n;
    const rotid_matrix *stiffness, *mass; /* as they were taken: their blocks are read from them */
    int *start;                           /* [n + 1] where a column of the lower triangle begins */
    int *row;                             /* [(kd + 1) n], increasing within a column, the diagonal element first */
    double *k, *m;                        /* the entries of K and M there */
    double *block;                        /* [nfar^2] that of M */
    double *x, *y;                        /* [8 n] columns interleaved */
};

/* ROTID_OK or ROTID_ERROR_MEMORY. What is never written costs address space alone where the memory comes from calloc. */
int pencil_new(struct pool *pool, const rotid_matrix *structure, struct pencil *p);

/* Takes the entries of k and m, which must outlive it unchanged. Returns whether M is that of the call before, 0 also where other
 * entries are not zero than then. */
int pencil_take(struct pencil *p, const rotid_matrix *k, const rotid_matrix *m);

/* Y [n * columns] := K X or M X */
void pencil_multiply_stiffness(struct pencil *p, int columns, const double *x, double *y);
void pencil_multiply_mass(struct pencil *p, int columns, const double *x, double *y);

/* ---------------------------------------------------------------------------------------------------------------- factor */

/* Factors of a banded matrix with a small block, bordered: the far degrees of freedom come last,
 *   [A_rr A_rf; A_fr A_ff],  X = A_rr^-1 A_rf,  S = A_ff - A_fr X,
 * so the cost stays O(n kd^2 + n nfar kd). Restricted to the rows and columns in `kept`. */

#define FACTOR_WIDE 12 /* half band from which panels and a block iteration on them take less time for eigenpairs */

/* Factors of wide bands with a profile, A = L S L', S = diag(+-1): panels of 48 columns (WIDE_PANEL), each a dense matrix from
 * its first column down to its last row, on which BLAS does the work. The last row of a panel is found from the entries: where
 * the profile is narrower than the band, neither time nor memory goes into zeros. */
struct wide {
    int n, kd, panels;
    int *end;         /* [panels] one past the last row */
    ptrdiff_t *place; /* [panels] where the panel begins in `value` */
    double *value;    /* panel p: from the row of its first column to end - 1 */
    double *sign;     /* [n] of S */
    double *work;     /* of a panel */
};

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

/* --------------------------------------------------------------------------------------------------------------- lanczos */

/* Block Lanczos iteration with (K - s M)^-1 M in the inner product of M, every block orthogonal to all before it, the inner part
 * of eigen_wide. Its eigenvalues are theta = 1/(lambda - s), pairs are counted from 0, the lowest lambda and largest theta. */

struct lanczos {
    int n, columns, block;
    int most, behind;  /* columns that there is room for: of the basis, of the block behind them */
    int size, next;    /* columns of the basis that were multiplied; of the block behind them that were not */
    int last, outside; /* columns that were multiplied last, and columns of Q below */
    struct pencil *pencil;
    struct factor *factor; /* of K - s M */
    struct random_stream stream;
    double *basis, *mass_basis; /* [n * (most + behind)] V with V' M V = 1, and M V */
    double *image;              /* [n * block] workspace */
    double *projected;          /* [most^2] V' M (K - s M)^-1 M V, upper triangle */
    double *vector, *theta;     /* [most^2], [most] its lowest pairs, theta ascending */
    double *component;          /* [most^2] workspace */
    double *remainder;          /* [behind^2] R: what (K - s M)^-1 M makes of the last columns beyond the basis is Q R */
    double *work;               /* [34 most] */
    int *iwork;                 /* [12 most] */
};

/* Blocks begin with `columns` vectors; `block` >= columns pairs are kept. ROTID_OK or ROTID_ERROR_MEMORY. */
int lanczos_new(struct pool *pool, struct pencil *pencil, struct factor *factor, int columns, int block, struct lanczos *l);

/* The basis begins with x [n * columns], of any length and not necessarily independent. The pencil is that of now. */
void lanczos_begin(struct lanczos *l, const double *x);

/* Until the residuals |(K - s M)^-1 M phi - theta phi|_M / theta of the lowest `watched` <= block pairs are below tolerance
 * [watched]. ROTID_OK or ROTID_ERROR_EIGEN. */
int lanczos_iterate(struct lanczos *l, int watched, const double *tolerance);

/* `columns` random vectors join the search, beside the pairs that are known. ROTID_OK, or ROTID_ERROR_EIGEN where the block
 * behind the basis has no room for so many; nothing has changed then. */
int lanczos_extend(struct lanczos *l, int columns);

/* How many pairs are known: block, or fewer where the basis is smaller; theta of one; the vectors of the lowest ones [n * pairs].
 */
int lanczos_known(const struct lanczos *l);
double lanczos_theta(const struct lanczos *l, int pair);
void lanczos_vectors(struct lanczos *l, int pairs, double *target);

/* ------------------------------------------------------------------------------------------------------------ eigen wide */

/* Eigenpairs of wide bands, the inner part of eigen_full: block Lanczos iteration. */

struct eigen_wide {
    int n, count, block;
    int started;           /* ritz holds the pairs of the call before */
    int from, to;          /* pairs from ... to - 1 are wanted to the last digit; the others have to be near alone */
    int vouched, definite; /* M is positive definite, somebody says; that of the call before was */
    double shift, largest; /* largest K_ii/M_ii: the size of the highest eigenvalue */
    int *all;              /* [n] 0 ... n - 1: no row is left out */
    struct pencil pencil;
    struct factor factor; /* of K - shift M; in between of M and for the Sturm count */
    struct lanczos lanczos;
    double *ritz;      /* [n * block] the current vectors, kept for the next call */
    double within;     /* of the residual of a pair that is wanted */
    double *tolerance; /* [block] of that of each pair */
    double *value;     /* [block] ascending, INFINITY where not known */
};

/* For the lowest `count` pairs of matrices structured as `structure`, a wide one. ROTID_OK or ROTID_ERROR_MEMORY. */
int eigen_wide_new(struct pool *pool, const rotid_matrix *structure, int count, struct eigen_wide *e);

/* Block Lanczos iteration with (K - s M)^-1 M, s < 0, in the inner product of M, every block orthogonal to all before it; from
 * the vectors of the call before, or from random ones with a first shift that finds a better one. A Sturm count at the end proves
 * that none was missed. K positive semidefinite, M positive definite. lambda [count], phi [n * count]. ROTID_OK,
 * ROTID_ERROR_STIFFNESS, ROTID_ERROR_MASS or ROTID_ERROR_EIGEN. */
int eigen_wide_solve(struct eigen_wide *e, const rotid_matrix *k, const rotid_matrix *m, double *lambda, double *phi);

/* ----------------------------------------------------------------------------------------------------------------- eigen */

/* Eigenpairs of K phi = lambda M phi, phi' M phi = 1, lambda ascending. */

/* ---- dense: the condensed problem (LAPACK dsygvx, dsygvd), solved as M phi = mu (K - s M) phi with a shift s < 0: rounding is
 * then relative to the lowest eigenvalues, which are the ones that are wanted, instead of to the highest */

struct eigen_dense {
    int n, count;
    double shift; /* of the size of the eigenvalues found last, 0 before */
    double *a, *b, *values, *vectors, *work;
    int *iwork, *ifail, lwork, liwork;
};

/* For the lowest `count` of n pairs. ROTID_OK or ROTID_ERROR_MEMORY. */
int eigen_dense_new(struct pool *pool, int n, int count, struct eigen_dense *e);

/* k, m [n * n] are kept. lambda [count], phi [n * count]. ROTID_OK, ROTID_ERROR_MASS, ROTID_ERROR_STIFFNESS or ROTID_ERROR_EIGEN.
 */
int eigen_dense_solve(struct eigen_dense *e, const double *k, const double *m, double *lambda, double *phi);

/* ---- banded: the full chain, in O(n) */

struct eigen_band {
    int n, count, block, depth;
    int from, to;          /* pairs from ... to - 1 are polished; the others have to be near alone */
    int started;           /* ritz holds the pairs of the call before */
    double within;         /* of the residual of a pair that is polished */
    int plain;             /* without polishing, in this attempt */
    int failures;          /* of polishing from a cold start */
    int known;             /* Ritz values in `value`: count, or with the guards of the block iteration block */
    double shift, largest; /* largest K_ii/M_ii: the size of the highest eigenvalue */
    struct factor factor, inertia, indefinite;
    int by_arrow; /* K - lambda M is factored as an arrow, which is quicker where few are far */
    int *row;     /* [n] of it */
    double *rows; /* [n * ARROW_SHIFTS] */
    struct arrow arrow;
    int *all; /* [n] 0 ... n - 1: no row is left out */
    rotid_matrix shifted;
    double *basis;      /* [n * block * depth], M-orthonormal */
    double *mass_basis; /* M basis */
    double *ritz;       /* [n * block] the current pairs, kept for the next call */
    double *image;      /* [n * block] (K - shift M)^-1 M ritz */
    double *value;      /* [block * depth] */
    double *residual;   /* [block] */
    double *shifts;     /* [3 count] workspace of eigen_polish */
    double *projected;  /* [(block * depth)^2] */
    double *work;       /* [max(2 n, 3 block depth)] */
};

/* For the lowest `count` pairs of matrices structured as `structure`. ROTID_OK or ROTID_ERROR_MEMORY. */
int eigen_band_new(struct pool *pool, const rotid_matrix *structure, int count, struct eigen_band *e);

/* Near pairs, of the call before or by block Krylov iteration on (K - s M)^-1 M with a shift s < 0 and Rayleigh-Ritz on K; then
 * inverse iteration with a shift for each (eigen_band.c), or where that fails the block iteration to the end. A Sturm count at
 * the end proves that none was missed. K positive semidefinite, M positive definite. lambda [count], phi [n * count]. ROTID_OK,
 * ROTID_ERROR_STIFFNESS, ROTID_ERROR_MASS or ROTID_ERROR_EIGEN. */
int eigen_band_solve(struct eigen_band *e, const rotid_matrix *k, const rotid_matrix *m, double *lambda, double *phi);

/* The next solution begins with phi [n * count], vectors near the lowest pairs, in any scale. */
void eigen_band_begin(struct eigen_band *e, const double *phi);

/* ---- whichever is the fastest one: dense, of narrow bands, of wide ones (eigen_wide), on the matrices of the full model */

struct eigen_full {
    int dense;
    int wide;
    struct eigen_band band;
    struct eigen_wide panels;
    struct eigen_dense solver;
    double *k, *m; /* [n * n] dense copies */
    double *image, *product, *squares, *work;
};

/* For the lowest `count` pairs of matrices structured as `structure`. ROTID_OK or ROTID_ERROR_MEMORY. */
int eigen_full_new(struct pool *pool, const rotid_matrix *structure, int count, struct eigen_full *e);
/* The dense one in any case. */
int eigen_full_new_dense(struct pool *pool, const rotid_matrix *structure, int count, struct eigen_full *e);

/* Only pairs from ... to - 1 of the count are wanted to the last digit; the others may be off by a part in a hundred of their
 * length (of a wide band 1e-4), and by the square of that in lambda. None is missed all the same. The dense solver gives all. */
void eigen_full_want(struct eigen_full *e, int from, int to);

/* Vectors off by `residual` at most, and eigenvalues by its square, in place of as good as their arithmetic; M is positive
 * definite for a reason that the caller knows: it is not factored to see that. Where that makes a difference. */
void eigen_full_within(struct eigen_full *e, double residual);

/* The next solution begins with phi [n * count], vectors near the lowest pairs, in any scale; the dense solver needs none. */
void eigen_full_begin(struct eigen_full *e, const double *phi);

/* As eigen_band_solve. The dense solver is followed by one step of inverse iteration and Rayleigh-Ritz with K and M as they are:
 * the reduction to standard form costs the lowest pairs of a fine mesh some digits. */
int eigen_full_solve(struct eigen_full *e, const rotid_matrix *k, const rotid_matrix *m, double *lambda, double *phi);

/* X [n * columns] := (K - lambda M)^-1 X with the matrices of the last solution, lambda < 0. ROTID_OK, or ROTID_ERROR_STIFFNESS
 * of few unknowns, where the solver is a dense one. */
int eigen_full_correct(struct eigen_full *e, const rotid_matrix *k, const rotid_matrix *m, double lambda, int columns, double *x);

/* ----------------------------------------------------------------------------------------------------------- eigen guyan */

/* The lowest eigenpairs of a chain of elements condensed by Guyan onto its masters, K~ x = lambda M~ x, without K~ and M~, which
 * are full. Two steps of elimination, exact for K~ and M~ alike:
 * 1. what lies between the pairs (2 i, 2 i + 1) of degrees of freedom that hold a master or are far is condensed piece by piece;
 * K and M of the pairs that are kept are a band again;
 * 2. of these the slaves follow from (K u)_s = 0. That is a constraint with forces w for
 *      [K - sigma M, K_.s; K_s., 0] [u; w] = [M u_before; 0],
 *    a band as well, whose solution is one inverse iteration with a shift on the condensed problem.
 * From near pairs (of the call before, or given) this converges as Rayleigh quotients do, as in eigen_band.c. */

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

/* Near pairs made exact: inverse iteration with a shift of its own for each, the inner part of eigen_band. Rayleigh-Ritz in the
 * span of the first `count` columns of image: value and ritz get that many pairs. Returns 0, or 1 where the columns are not
 * independent. */
int eigen_ritz_pairs(struct eigen_band *e, const rotid_matrix *k, const rotid_matrix *m);

/* --------------------------------------------------------------------------------------------------------- least squares */

/* The two dense kernels of a least-squares fit. */

/* |D h|, D = diag(scale [n]), NULL: 1; of any size that has a double, as its square may not. NaN where a component is. */
double least_squares_length(int n, const double *scale, const double *h);

size_t least_squares_workspace(int m, int n);

/* h [n]: min |J h + r|^2 + mu |D h|^2 + |F h|^2, D = diag(scale), F = diag(floor), by QR of the three on top of each other, which
 * must leave no h free. mu > 0 is raised where h would be longer than |D h| = radius > 0, to where it is not by more than a tenth
 * (Newton's iteration on 1/|D h|: Hebden 1973, More 1978); *length of the step that is returned. J [m * n], r [m] are kept. work
 * [least_squares_workspace(m, n)]. Returns 0, or 1 where the QR meets a zero on its diagonal or something not finite. */
int least_squares_damped_step(int m, int n, const double *jacobian, const double *r, const double *scale, const double *floor,
                              double radius, double *mu, double *h, double *length, double *work);

size_t singular_values_workspace(int m, int n);

/* J [m * n] = U S V': value [n] decreasing (zeros past min(m, n)), direction [n * n] = V. J is kept.
 * work [singular_values_workspace(m, n)]. Returns 0, or 1 without convergence. */
int singular_values(int m, int n, const double *jacobian, double *value, double *direction, double *work);

/* ---------------------------------------------------------------------------------------------------------------- matrix */

/* Symmetric matrices that are banded but for a small block (rotid_matrix of rotid.h). */

/* Storage for a zero matrix of the given structure; `far` is kept, not copied. ROTID_OK or ROTID_ERROR_MEMORY. */
int matrix_new(struct pool *pool, int n, int kd, int nfar, const int *far, rotid_matrix *a);
int matrix_like(struct pool *pool, const rotid_matrix *structure, rotid_matrix *a);

/* Where a degree of freedom stands among the far ones, -1: it is none of them. */
int matrix_far_position(const rotid_matrix *a, int dof);

void matrix_zero(rotid_matrix *a);

/* Adds value to A(i, j) and A(j, i): into the band where it reaches, else into the block, where i and j must both be far. */
void matrix_add(rotid_matrix *a, int i, int j, double value);

/* Adds the element matrix e [nd * nd] on the degrees of freedom dof [nd]. */
void matrix_add_element(rotid_matrix *a, int nd, const int *dof, const double *e);

/* c := alpha a + beta b, same structure; c may be a or b. */
void matrix_combine(double alpha, const rotid_matrix *a, double beta, const rotid_matrix *b, rotid_matrix *c);

/* Y [n * columns] := A X [n * columns]. */
void matrix_multiply(const rotid_matrix *a, int columns, const double *x, double *y);

/* x' A y; work [n]. */
double matrix_product(const rotid_matrix *a, const double *x, const double *y, double *work);

/* Rows and columns *from ... *end - 1 hold all that is not zero: within those given, outside of which the band is known to be
 * zero; all of them where the block holds anything, *from = *end where there is nothing. */
void matrix_occupied(const rotid_matrix *a, int *from, int *end);

/* *part := rows and columns from ... from + length - 1 of a, in the same storage, with the block where those are all. */
void matrix_rows(const rotid_matrix *a, int from, int length, rotid_matrix *part);

int matrix_is_finite(const rotid_matrix *a);
/* Nothing but zeros in all of the storage? Soon known where there is anything. */
int matrix_is_zero(const rotid_matrix *a);

/* How far column j of the band reaches below its diagonal. */
static inline int matrix_reach(const rotid_matrix *a, int j)
{
    return a->kd < a->n - 1 - j ? a->kd : a->n - 1 - j;
}

#define MATRIX_STRETCH 8 /* entries of a wide band that are looked at together */

/* Are MATRIX_STRETCH entries all zero? Bits tell faster than comparisons; a negative zero counts as an entry. */
static inline int matrix_stretch_is_zero(const double *a)
{
    uint64_t bits[MATRIX_STRETCH], any = 0;
    memcpy(bits, a, sizeof bits);
    for (int i = 0; i < MATRIX_STRETCH; i++)
        any |= bits[i];
    return !any;
}

/* full [n, n], leading dimension ld, := A, both triangles. */
void matrix_to_dense(const rotid_matrix *a, int ld, double *full);

/* ---------------------------------------------------------------------------------------------------------- matrix check */

/* What matrices from outside have to be before anything reads them. `failure` as in rotid.h, names those of the arguments there.
 */

/* ROTID_OK where index [count] holds increasing numbers of 0 ... n - 1; it may be NULL where count is 0. Else
 * ROTID_ERROR_ARGUMENT. */
int indices_check(const char *name, int count, const int *index, int n, char *failure);

/* ROTID_OK where n, kd and far are in their ranges and the storage is there, else ROTID_ERROR_ARGUMENT. */
int matrix_check_structure(const char *name, const rotid_matrix *a, char *failure);

/* Of a matrix of sound structure: ROTID_OK where its block is symmetric but for rounding, else ROTID_ERROR_ARGUMENT. */
int matrix_check_block(const char *name, const rotid_matrix *a, char *failure);

/* Of such a matrix: the same, and ROTID_ERROR_FINITE where an entry is no number. */
int matrix_check_entries(const char *name, const rotid_matrix *a, char *failure);

/* Both for a [count], called k, m, dk, dm; ROTID_ERROR_ARGUMENT also where they are not of one structure. */
int matrices_check(int count, const rotid_matrix *const *a, char *failure);

/* Dense symmetric positive definite matrices (LAPACK dpotrf, dpotri). A [n * n], of which the lower triangle is read, is
 * overwritten by A^-1, both triangles; *log_determinant of A. n >= 0. Returns 0, or 1 where A is not positive definite. */
int positive_invert(int n, double *a, double *log_determinant);

/* A = V diag(value) V' (dsyev): V in the place of A [n * n], of which the lower triangle is read; value [n] ascending. n >= 0.
 * Returns 0, or 1 where the iteration fails. work [3 n]. */
int positive_spectrum(int n, double *a, double *value, double *work);

/* --------------------------------------------------------------------------------------------------------------- product */

/* Dense products, column-major. */

/* a' b */
double product_dot(int n, const double *a, const double *b);

/* Column `count` of the basis [n * (count + 1)] is taken orthogonal to those before it, which are orthonormal, twice because once
 * leaves errors of the size of the cancellation, and scaled to length 1. Returns count + 1, or count where no more than the part
 * `least` of it is left. */
int basis_extend(int n, int count, double least, double *basis);

/* The same of columns [n * ncolumn], one after the other. Returns how many there are then; room for count + ncolumn. */
int basis_add(int n, int ncolumn, const double *column, double least, int count, double *basis);

/* v := v - Q Q'v, Q [n * count] orthonormal. Returns |Q'v|^2 of what is taken. */
double basis_remove(int n, int count, const double *basis, double *v);

/* C [m * n] := A' B, A [k * m], B [k * n]; all sizes >= 1. */
void product_transposed(int m, int n, int k, const double *a, const double *b, double *c);
/* C [n * n] := A' A, both triangles, A [k * n]; sizes >= 1. Half the work of product_transposed. */
void product_gram(int n, int k, const double *a, double *c);
/* C [m * n] := C + A' B, A [k * m], B [k * n] with the leading dimension ld >= k; all sizes >= 1. */
void product_add_transposed(int m, int n, int k, int ld, const double *a, const double *b, double *c);
/* C [m * n] := C - A B, A [m * k], B [k * n]. */
void product_subtract(int m, int n, int k, const double *a, const double *b, double *c);
/* y [m] := part A x, A [m * k], x [k]; nothing where m is 0. */
void product_combine(int m, int k, double part, const double *a, const double *x, double *y);

/* ------------------------------------------------------------------------------------------------------------- reduction */

/* Condensation onto master degrees of freedom: u = T x with T(K, M),
 *   K~ = T' K T,  M~ = T' M T.
 * Guyan (11-13): T = Psi = [Phi; I], Phi = -K_ii^-1 K_ic. IRS (O'Callahan 1989): T = Psi + S M Psi W, S = K_ii^-1 on the slaves
 * and zero elsewhere, W = M_g^-1 K_g with the matrices that Guyan gives.
 * Derivatives act on vectors; with columns of the identity they give dK~ and dM~ themselves. */

struct reduction {
    int kind; /* ROTID_GUYAN or ROTID_IRS */
    int n, nc, ni;
    const int *master;
    int *slave, *nonzero;          /* [ni], [n] */
    const rotid_matrix *k, *m;     /* of the last reduction_compute: kept by the caller */
    struct factor factor;          /* K_ii */
    double *t;                     /* [n * nc] */
    double *kc, *mc;               /* [nc * nc] K~, M~ */
    double *psi, *kg, *mg;         /* IRS: [n * nc] and [nc * nc]; Guyan: the same as t, kc, mc */
    double *mg_factor, *w;         /* IRS: [nc * nc] */
    double *image;                 /* [n * max(nc, 3)] */
    double *u1, *u2, *u3, *slaves; /* [n] */
    double *c1, *c2, *c3;          /* [nc] */
};

/* `master` [nc], increasing, is kept, not copied. ROTID_OK or ROTID_ERROR_MEMORY. */
int reduction_new(struct pool *pool, int kind, const rotid_matrix *structure, int nc, const int *master, struct reduction *r);

/* T, K~ and M~ of K and M, which must stay unchanged while the derivatives below are used. ROTID_OK, ROTID_ERROR_SLAVE or
 * ROTID_ERROR_MASS. */
int reduction_compute(struct reduction *r, const rotid_matrix *k, const rotid_matrix *m);

/* u [n] := T x [nc] */
void reduction_expand(const struct reduction *r, const double *x, double *u);
/* x [nc] := T' u [n] */
void reduction_project(const struct reduction *r, const double *u, double *x);

/* u [n] := dT x for the derivatives dK, dM */
void reduction_derivative_expand(struct reduction *r, const rotid_matrix *dk, const rotid_matrix *dm, const double *x, double *u);
/* x [nc] := dT' u [n] */
void reduction_derivative_project(struct reduction *r, const rotid_matrix *dk, const rotid_matrix *dm, const double *u,
                                  double *x);

/* kx [nc] := dK~ x, mx [nc] := dM~ x, (40, 41) corrected; work [3 n + nc]. */
void reduction_derivative_multiply(struct reduction *r, const rotid_matrix *dk, const rotid_matrix *dm, const double *x,
                                   double *kx, double *mx, double *work);

/* What an eigenpair (lambda, x) of the condensed problem needs for the derivative of lambda by any number of parameters: u = T x,
 * the residual (K - lambda M) u of the full model, and S times it. Vectors [n], supplied by the caller. */
struct reduction_mode {
    double *u, *residual, *adjoint, *scratch;
};

void reduction_mode_prepare(struct reduction *r, double lambda, const double *x, struct reduction_mode *mode);

/* For Guyan's reduction without T, K~ and M~: reduction_begin in place of reduction_compute, ROTID_OK or ROTID_ERROR_SLAVE, then
 * adjoint [n * count] := S (K - lambda M) u for u [n * count] = T x. Workspace [n * count]. */
int reduction_begin(struct reduction *r, const rotid_matrix *k, const rotid_matrix *m);
void reduction_adjoint(struct reduction *r, int count, const double *lambda, const double *u, double *adjoint, double *work);

/* dlambda = x' (dK~ - lambda dM~) x = u' (dK - lambda dM) u + 2 (K - lambda M) u . dT x, for x' M~ x = 1: (36). */
double reduction_eigenvalue_derivative(struct reduction *r, const rotid_matrix *dk, const rotid_matrix *dm, double lambda,
                                       const double *x, const struct reduction_mode *mode);

/* ------------------------------------------------------------------------------------------------------------------ ritz */

/* Rayleigh-Ritz: the best pairs of K phi = lambda M phi in the span of given vectors. */

#define RITZ_WORK 34 /* times count: workspace of ritz_pairs */

/* value [count] ascending and vector [n * count] with vector' M vector = 1 in the span of y [n * count], which is scaled; M
 * positive definite. Workspace: product [n * count], squares [2 count^2], work [RITZ_WORK count]. Returns 0, or 1 where the
 * columns of y are not independent or not finite. */
int ritz_pairs(int n, int count, const rotid_matrix *k, const rotid_matrix *m, double *y, double *value, double *vector,
               double *product, double *squares, double *work);

/* ------------------------------------------------------------------------------------------------------------- quadratic */

/* The quadratic eigenvalue problem (lambda^2 M + lambda C + K) u = 0 of real matrices without symmetry, small and dense, and the
 * complex systems of its iterations (LAPACK dgeev, zgetrf, zgetrs). */

size_t quadratic_workspace(int n); /* doubles */

/* lambda [2 n] and u [n * 2 n] of m, c, k [n * n], in no order, vectors in any scale; m regular, overwritten by its factors; rate
 * > 0: the size of the lambda that are wanted. work [quadratic_workspace(n)], pivot [n]. Returns 0, or 1 where a number is not
 * finite, M is singular or the iteration did not converge. */
int quadratic_pairs(int n, double rate, double *m, const double *c, const double *k, double complex *lambda, double complex *u,
                    double *work, int *pivot);

/* a [n * n] := P L U; pivot [n]. Returns 0, or 1 where A is singular or not finite. */
int complex_factor(int n, double complex *a, int *pivot);

/* b [n] := A^-1 b, or A^-H b where adjoint is not 0. */
void complex_solve(int n, int adjoint, const double complex *factor, const int *pivot, double complex *b);

/* ----------------------------------------------------------------------------------------------------------------- roots */

/* Roots of a real polynomial, as eigenvalues of its companion matrix (LAPACK dgebal, dhseqr). */

size_t polynomial_roots_workspace(int n); /* doubles */

/* root [n] of x^n + c[0] x^(n-1) + ... + c[n-1], n >= 1; work [polynomial_roots_workspace(n)]. Returns 0, or 1 where a
 * coefficient is not finite or the iteration did not converge. */
int polynomial_roots(int n, const double *c, double complex *root, double *work);

/* ----------------------------------------------------------------------------------------------------------------- shift */

/* The shift s of an iteration with (K - s M)^-1 M. */

#define EIGEN_DENSE_MOST 2000 /* degrees of freedom up to which the dense solver stands in: 150 MB, and seconds */

#define FIRST_SHIFT 1e-10 /* of the highest eigenvalue: the first shift, far below the first mode and far above its rounding */
#define ZERO        1e-14 /* of the highest eigenvalue: below this, rounding of a rigid motion */

/* A shift < 0 of the size of the third of the eigenvalues value [known], ascending (the first two may be rigid-body modes at
 * zero), or of the first above it that is not zero: the iteration then converges about as fast as with none. largest: the size of
 * the highest eigenvalue. Returns 0 where none of these is known (not finite, or zero). */
double shift_of(int known, const double *value, double largest);

/* The shift just above the eigenvalue `last` where a Sturm count tells whether a pair was missed: farther above than rounding may
 * move that eigenvalue. below < 0: the shift of the iteration. */
double shift_above(double last, double below, double largest);

/* The shift just below the eigenvalue `last` and those that equal it. More of these may follow than vectors are kept; where a
 * Sturm count finds there as many eigenvalues as are known, none was missed all the same. Below those that are zero, what K may
 * have by rounding. */
double shift_below(double last, double below, double largest);

/* A_ii, for i that rises from call to call: *f, 0 at first, is the first far degree of freedom that is not below i. */
double diagonal_of(const rotid_matrix *a, int i, int *f);

/* The size of the highest eigenvalue of K x = lambda M x: the largest K_ii/M_ii; 0 where K has no diagonal, or where one of these
 * is not finite. */
double highest_of(const rotid_matrix *k, const rotid_matrix *m);

/* Are the eigenvalues of x [n * count], K x beside it, zero, and not merely small beside the highest one? */
int all_at_rest(const rotid_matrix *k, int count, const double *x, const double *kx);

/* ------------------------------------------------------------------------------------------------------------- symmetric */

/* Dense symmetric indefinite systems (LAPACK dsytrf, dsytrs). */

struct symmetric {
    int n, lwork;
    double *a, *work; /* a [n * n]: the caller writes the lower triangle into it before each factorisation */
    int *pivot;
};

int symmetric_new(struct pool *pool, int n, struct symmetric *s);

/* Factors the leading size * size matrix in s->a (leading dimension size). Returns 0, or 1 when it is singular. */
int symmetric_factor(struct symmetric *s, int size);

/* Number of negative eigenvalues of the matrix that was factored last. */
int symmetric_negative(const struct symmetric *s, int size);

/* b [size] := A^-1 b */
void symmetric_solve(struct symmetric *s, int size, double *b);

#endif
