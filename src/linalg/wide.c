#include "linalg/linalg.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <string.h>

#include "rotid.h"

#define CANCELLED 1e-15 /* of the diagonal element: below this, a pivot is rounding */

static int least(int a, int b)
{
    return a < b ? a : b;
}

int wide_new(struct pool *pool, int n, int kd, struct wide *w)
{
    int panels = n / WIDE_PANEL + 1;
    *w = (struct wide){.kd = kd};
    w->end = POOL_ARRAY(pool, int, panels);
    w->place = POOL_ARRAY(pool, ptrdiff_t, panels);
    w->value = POOL_ARRAY(pool, double, (size_t)n *(size_t)(kd + WIDE_PANEL));
    w->sign = POOL_ARRAY(pool, double, n);
    w->work = POOL_ARRAY(pool, double, WIDE_PANEL *(size_t)(kd + WIDE_PANEL));
    return w->end && w->place && w->value && w->sign && w->work ? ROTID_OK : ROTID_ERROR_MEMORY;
}

static int width_of(const struct wide *w, int p)
{
    return least(WIDE_PANEL, w->n - p * WIDE_PANEL);
}

void wide_clear(struct wide *w, int n, const int *last)
{
    ptrdiff_t place = 0;
    w->n = n;
    w->panels = (n + WIDE_PANEL - 1) / WIDE_PANEL;
    for (int p = 0, end = 0; p < w->panels; p++) {
        int top = p * WIDE_PANEL, width = width_of(w, p);
        end = end > top + width ? end : top + width; /* the elimination fills what lies under the panels before */
        for (int j = top; j < top + width; j++)
            end = end > last[j] + 1 ? end : last[j] + 1;
        w->end[p] = end;
        w->place[p] = place;
        place += (ptrdiff_t)(end - top) * width;
    }
    memset(w->value, 0, (size_t)place * sizeof *w->value);
}

/* LDL' of the leading `width` rows of a panel, then columns scaled to L S L'. Returns the number of negative pivots. */
static int eliminate(int width, int ld, const double *scale, double *a, double *sign)
{
    int negative = 0;
    for (int j = 0; j < width; j++) {
        double *l = a + j + (ptrdiff_t)j * ld, tiny = CANCELLED * (scale[j] > 0 ? scale[j] : 1);
        if (fabs(l[0]) < tiny)
            l[0] = -tiny;
        sign[j] = l[0] < 0 ? -1 : 1;
        negative += l[0] < 0;
        double root = sqrt(fabs(l[0])), inverse = sign[j] / root;
        l[0] = root;
        for (int i = 1; i < width - j; i++)
            l[i] *= inverse;
        for (int c = 1; c < width - j; c++) {
            double *target = l + c + (ptrdiff_t)c * ld, factor = sign[j] * l[c];
            for (int i = c; i < width - j; i++)
                target[i - c] -= factor * l[i];
        }
    }
    return negative;
}

/* Factors the diagonal block of panel p. Nearly all blocks of K - sigma M are positive definite even where the matrix is not.
 * Returns the number of negative signs, or -1 where there are some and must not be. */
static int factor_diagonal(struct wide *w, int p, int indefinite)
{
    int top = p * WIDE_PANEL, ld = w->end[p] - top, width = width_of(w, p), negative = 0;
    double *a = w->value + w->place[p], *scale = w->sign + top;
    for (int j = 0; j < width && indefinite; j++)
        memcpy(w->work + (ptrdiff_t)j * WIDE_PANEL, a + (ptrdiff_t)j * ld, (size_t)width * sizeof *a);
    if (LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'L', width, a, ld)) {
        if (!indefinite)
            return -1;
        double given[WIDE_PANEL];
        memcpy(given, scale, (size_t)width * sizeof *given);
        for (int j = 0; j < width; j++)
            memcpy(a + (ptrdiff_t)j * ld, w->work + (ptrdiff_t)j * WIDE_PANEL, (size_t)width * sizeof *a);
        return eliminate(width, ld, given, a, w->sign + top);
    }
    for (int j = 0; j < width; j++) {
        double pivot = a[j + (ptrdiff_t)j * ld];
        if (!isfinite(pivot) || !(pivot > 0))
            return -1;
        w->sign[top + j] = 1;
    }
    return negative;
}

static int factor(struct wide *w, int indefinite)
{
    int negative = 0;
    for (int j = 0; j < w->n && indefinite; j++) /* the size that a pivot has before it cancels, until its sign is known */
        w->sign[j] = fabs(wide_column(w, j)[j]);
    for (int p = 0; p < w->panels; p++) {
        int top = p * WIDE_PANEL, ld = w->end[p] - top, width = width_of(w, p), below = ld - width,
            found = factor_diagonal(w, p, indefinite);
        if (found < 0)
            return -1;
        negative += found;
        if (!below)
            continue;
        double *a = w->value + w->place[p], *under = a + width;
        cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, below, width, 1, a, ld, under, ld);
        const double *signed_under = under; /* L S */
        int signed_ld = ld;
        if (found) {
            for (int j = 0; j < width; j++) {
                memcpy(w->work + (ptrdiff_t)j * below, under + (ptrdiff_t)j * ld, (size_t)below * sizeof *under);
                cblas_dscal(below, w->sign[top + j], under + (ptrdiff_t)j * ld, 1);
            }
            signed_under = w->work;
            signed_ld = below;
        }
        for (int q = p + 1, done = 0; done < below; q++, done += WIDE_PANEL) {
            int rows = below - done, columns = least(WIDE_PANEL, rows), to = w->end[q] - q * WIDE_PANEL;
            cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, rows, columns, width, -1, under + done, ld, signed_under + done,
                        signed_ld, 1, w->value + w->place[q], to);
        }
    }
    return negative;
}

int wide_cholesky(struct wide *w)
{
    return factor(w, 0) != 0;
}

int wide_indefinite(struct wide *w)
{
    return factor(w, 1);
}

void wide_solve(const struct wide *w, int columns, int ld, double *b)
{
    for (int p = 0; p < w->panels; p++) {
        int top = p * WIDE_PANEL, rows = w->end[p] - top, width = width_of(w, p);
        const double *a = w->value + w->place[p];
        double *x = b + top;
        cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasNoTrans, CblasNonUnit, width, columns, 1, a, rows, x, ld);
        if (rows > width)
            cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, rows - width, columns, width, -1, a + width, rows, x, ld, 1,
                        x + width, ld);
    }
    for (int p = w->panels - 1; p >= 0; p--) {
        int top = p * WIDE_PANEL, rows = w->end[p] - top, width = width_of(w, p);
        const double *a = w->value + w->place[p];
        double *x = b + top;
        for (int j = 0; j < width; j++)
            for (int c = 0; c < columns && w->sign[top + j] < 0; c++)
                x[j + (ptrdiff_t)c * ld] = -x[j + (ptrdiff_t)c * ld];
        if (rows > width)
            cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, width, columns, rows - width, -1, a + width, rows, x + width, ld,
                        1, x, ld);
        cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasTrans, CblasNonUnit, width, columns, 1, a, rows, x, ld);
    }
}
