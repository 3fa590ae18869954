/* Factors of wide bands with a profile, A = L S L', S = diag(+-1): panels of WIDE_PANEL columns, each a dense matrix from its
 * first column down to its last row, on which BLAS does the work. The last row of a panel is found from the entries: where the
 * profile is narrower than the band, neither time nor memory goes into zeros. */
#ifndef ROTID_LINALG_WIDE_H
#define ROTID_LINALG_WIDE_H

#include <stddef.h>

#include "base/pool.h"

#define WIDE_PANEL 48 /* columns: of 32, 48, 64 and 96 the fastest one for half bands of 150 to 300 */

struct wide {
    int n, kd, panels;
    int *end;         /* [panels] one past the last row */
    ptrdiff_t *place; /* [panels] where the panel begins in `value` */
    double *value;    /* panel p: rows p WIDE_PANEL ... end - 1 */
    double *sign;     /* [n] of S */
    double *work;     /* [(kd + WIDE_PANEL) WIDE_PANEL] */
};

/* For at most n rows and a half band of at most kd. ROTID_OK or ROTID_ERROR_MEMORY. */
int wide_new(struct pool *pool, int n, int kd, struct wide *w);

/* Makes A [n, n] zero. last [n]: the last row below or on the diagonal where a column may get an entry. */
void wide_clear(struct wide *w, int n, const int *last);

/* A(i, j) = wide_column(w, j)[i], i >= j, i <= last[j] */
static inline double *wide_column(const struct wide *w, int j)
{
    int p = j / WIDE_PANEL, top = p * WIDE_PANEL;
    return w->value + w->place[p] - top + (ptrdiff_t)(j - top) * (w->end[p] - top);
}

/* A = L L'. Returns 0, or 1 where A is not positive definite. */
int wide_cholesky(struct wide *w);

/* A = L S L' without pivoting. Returns the number of negative signs, which is that of the negative eigenvalues of A. A pivot that
 * cancels is replaced by a tiny negative one of its scale, which moves A by rounding. */
int wide_indefinite(struct wide *w);

/* B [n * columns], leading dimension ld, is overwritten by A^-1 B. */
void wide_solve(const struct wide *w, int columns, int ld, double *b);

#endif
