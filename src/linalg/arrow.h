/* Symmetric indefinite matrices K - sigma M of a narrow band with a few full rows last, for many shifts: L D L' without pivoting,
 * which keeps the form. A pivot in which digits cancel is refused; another shift has others. */
#ifndef ROTID_LINALG_ARROW_H
#define ROTID_LINALG_ARROW_H

#include "base/pool.h"
#include "rotid.h"

struct arrow_matrix {
    double *band;   /* [(kd + 1) * n] lower triangle, A(i, j) = band[(i - j) + j (kd + 1)] */
    double *border; /* [stride * n] of each column of the band the full rows below */
    double *corner; /* [stride * stride] symmetric, both triangles */
};

struct arrow {
    int n, kd;        /* of the band */
    int full, stride; /* rows below it; as many as are stored, a multiple of four */
    int first;        /* column of the band from which the border is not zero */
    struct arrow_matrix k, m, factor;
    double *magnitude; /* [n + stride] what has been added up in each pivot */
};

/* Zero matrices. ROTID_OK or ROTID_ERROR_MEMORY. */
int arrow_new(struct pool *pool, int n, int kd, int full, struct arrow *a);

void arrow_zero(struct arrow *a, struct arrow_matrix *matrix);

/* Adds to entries (i, j) and (j, i); rows from n on are the full ones. A diagonal entry gets it once. */
void arrow_add(struct arrow *a, struct arrow_matrix *matrix, int i, int j, double value);

/* matrix := A, whose degree of freedom i is row row[i] here: far ones are full rows, the others keep their order. */
void arrow_take(struct arrow *a, struct arrow_matrix *matrix, const rotid_matrix *from, const int *row);

/* Factors K - sigma M. Returns the number of its negative eigenvalues, or -1 where a pivot is lost. */
int arrow_factor(struct arrow *a, double sigma);

/* b [n + full] := (K - sigma M)^-1 b */
void arrow_solve(const struct arrow *a, double *b);

#endif
