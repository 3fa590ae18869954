/* Block Lanczos iteration with (K - s M)^-1 M in the inner product of M, every block orthogonal to all before it, the inner part
 * of eigen_wide. Its eigenvalues are theta = 1/(lambda - s), pairs are counted from 0, the lowest lambda and largest theta. */
#ifndef ROTID_LINALG_LANCZOS_H
#define ROTID_LINALG_LANCZOS_H

#include "base/random.h"
#include "linalg/factor.h"

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

#endif
