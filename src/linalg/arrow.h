/* Symmetric indefinite matrices K - sigma M of a narrow band with a few full rows last, for several shifts at once: L D L'
 * without pivoting, which keeps the form. A pivot in which digits cancel is refused; another shift has others. What belongs to
 * the shifts is interleaved, x[i * ARROW_SHIFTS + shift]: four of them are one vector. What is computed for a shift does not
 * depend on the others. */
#ifndef ROTID_LINALG_ARROW_H
#define ROTID_LINALG_ARROW_H

#include "base/pool.h"
#include "rotid.h"

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

#endif
