#include "ema/modal_fit.h"

#include <math.h>
#include <string.h>

#include "base/parallel.h"
#include "linalg/cholesky.h"
#include "linalg/product.h"

static size_t workspace(const struct modal_fit *fit)
{
    size_t columns = (size_t)fit->ncolumn + 1, q = (size_t)fit->nlinear, p = 2 * (size_t)fit->nmode;
    size_t rows = fit->weight ? 2 * (size_t)fit->nline * columns : 0;
    return rows + columns * columns + q * q + q * (p + 1) + q * q + p * q + q + 2 * columns;
}

int modal_fit_new(struct pool *pool, const struct ema_band *band, int nline, const int *line, int from, int nchannel, int nmode,
                  int threads, struct modal_fit *fit)
{
    int q = 2 * nmode + 4, p = 2 * nmode, workers = threads < 1 || nchannel < 2 ? 1 : threads;
    size_t channels = (size_t)nchannel, rows = 2 * (size_t)nline;
    *fit = (struct modal_fit){.nline = nline,
                              .nchannel = nchannel,
                              .nmode = nmode,
                              .nlinear = q,
                              .ncolumn = q + p,
                              .threads = workers,
                              .scale = nline ? band->omega[line[nline / 2]] : 1};
    fit->nu = POOL_ARRAY(pool, double, nline);
    fit->y = POOL_ARRAY(pool, double, rows *channels);
    fit->yy = POOL_ARRAY(pool, double, nchannel);
    fit->weight = band->variance ? POOL_ARRAY(pool, double, (size_t)nline *channels) : NULL;
    fit->sigma = POOL_ARRAY(pool, double, nchannel);
    fit->pole = POOL_ARRAY(pool, double complex, nmode);
    fit->held = POOL_ARRAY(pool, int, nmode);
    fit->loose = POOL_ARRAY(pool, int, nmode);
    fit->basis = POOL_ARRAY(pool, double, rows *(size_t)(q + p));
    fit->gram = POOL_ARRAY(pool, double, (size_t)(q + p) * (size_t)(q + p));
    fit->right = POOL_ARRAY(pool, double, (size_t)(q + p) * channels);
    fit->linear = POOL_ARRAY(pool, double, (size_t)q *channels);
    fit->chi2 = POOL_ARRAY(pool, double, nchannel);
    fit->schur = POOL_ARRAY(pool, double, (size_t)p *(size_t)p *channels);
    fit->score = POOL_ARRAY(pool, double, (size_t)p *channels);
    fit->mix = POOL_ARRAY(pool, double, (size_t)q *(size_t)p *channels);
    fit->spread = POOL_ARRAY(pool, double, (size_t)q *(size_t)q *channels);
    fit->singular = POOL_ARRAY(pool, int, nchannel);
    fit->work = POOL_ARRAY(pool, double *, workers);
    if (!fit->nu || !fit->y || !fit->yy || (band->variance && !fit->weight) || !fit->sigma || !fit->pole || !fit->held ||
        !fit->loose || !fit->basis || !fit->gram || !fit->right || !fit->linear || !fit->chi2 || !fit->schur || !fit->score ||
        !fit->mix || !fit->spread || !fit->singular || !fit->work)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < workers; i++)
        if (!(fit->work[i] = POOL_ARRAY(pool, double, workspace(fit))))
            return ROTID_ERROR_MEMORY;
    for (int i = 0; i < nline; i++)
        fit->nu[i] = band->omega[line[i]] / fit->scale;
    for (int c = 0; c < nchannel; c++) {
        const double complex *h = band->h + (ptrdiff_t)(from + c) * band->nline;
        double *y = fit->y + (ptrdiff_t)2 * nline * c;
        for (int i = 0; i < nline; i++) {
            y[i] = creal(h[line[i]]);
            y[i + nline] = cimag(h[line[i]]);
            /* the variance of a complex value is shared by its two parts */
            if (band->variance)
                fit->weight[i + (ptrdiff_t)c * nline] = sqrt(2 / band->variance[line[i] + (ptrdiff_t)(from + c) * band->nline]);
        }
        fit->yy[c] = product_dot(2 * nline, y, y);
        fit->sigma[c] = 1;
    }
    return ROTID_OK;
}

static void put(double *column, int nline, int i, double re, double im)
{
    column[i] = re;
    column[i + nline] = im;
}

/* In real arithmetic: complex division and product of C guard against infinities at ten times the cost. */
static void fill_mode(const struct modal_fit *fit, double complex pole, double *phi, double *psi)
{
    int n = fit->nline;
    ptrdiff_t rows = (ptrdiff_t)2 * n;
    double a = creal(pole), b = cimag(pole);
    for (int i = 0; i < n; i++) {
        double nu = fit->nu[i], square = -nu * nu, below = nu - b, above = nu + b;
        /* g = 1/(-a + i (nu - b)), mirror = 1/(-a + i (nu + b)) */
        double d = 1 / (a * a + below * below), e = 1 / (a * a + above * above);
        double gr = -a * d, gi = -below * d, mr = -a * e, mi = -above * e;
        double g2r = gr * gr - gi * gi, g2i = 2 * gr * gi, m2r = mr * mr - mi * mi, m2i = 2 * mr * mi;
        put(phi, n, i, square * (gr + mr), square * (gi + mi));
        put(phi + rows, n, i, -square * (gi - mi), square * (gr - mr));
        put(psi, n, i, square * (g2r + m2r), square * (g2i + m2i));
        put(psi + rows, n, i, -square * (g2i - m2i), square * (g2r - m2r));
    }
}

static void fill_basis(struct modal_fit *fit)
{
    int n = fit->nline, m = fit->nmode;
    ptrdiff_t rows = (ptrdiff_t)2 * n;
    for (int r = 0; r < m; r++)
        fill_mode(fit, fit->pole[r], fit->basis + rows * 2 * r, fit->basis + rows * (fit->nlinear + 2 * r));
    double *rest = fit->basis + rows * 2 * m;
    for (int i = 0; i < n; i++) {
        double square = -fit->nu[i] * fit->nu[i];
        put(rest, n, i, 1, 0);
        put(rest + rows, n, i, 0, 1);
        put(rest + 2 * rows, n, i, square, 0);
        put(rest + 3 * rows, n, i, 0, square);
    }
}

double modal_fit_local_noise(const struct modal_fit *fit, int c, int r, double widths)
{
    int n = fit->nline, q = fit->nlinear, count = 0;
    double reach = widths * 2 * fabs(creal(fit->pole[r])), sum = 0;
    const double *x = fit->linear + (ptrdiff_t)c * q, *y = fit->y + (ptrdiff_t)2 * n * c;
    for (int i = 0; i < n; i++) {
        if (fabs(fit->nu[i] - cimag(fit->pole[r])) > reach)
            continue;
        double weight = fit->weight ? fit->weight[i + (ptrdiff_t)c * n] : 1 / fit->sigma[c];
        for (int part = i; part < 2 * n; part += n) {
            double left = y[part];
            for (int j = 0; j < q; j++)
                left -= fit->basis[part + (ptrdiff_t)2 * n * j] * x[j];
            sum += weight * weight * left * left;
            count++;
        }
    }
    return count >= 8 ? sum / count : 1;
}

/* Gram matrix [(ncolumn + 1)^2] of basis and y, weighted. */
static void channel_gram(const struct modal_fit *fit, int c, double *rows, double *gram)
{
    int n = fit->nline, all = fit->ncolumn + 1;
    if (!fit->weight) {
        double w = 1 / (fit->sigma[c] * fit->sigma[c]);
        for (int k = 0; k < fit->ncolumn; k++) {
            for (int j = 0; j < fit->ncolumn; j++)
                gram[j + (ptrdiff_t)k * all] = w * fit->gram[j + (ptrdiff_t)k * fit->ncolumn];
            gram[fit->ncolumn + (ptrdiff_t)k * all] = gram[k + (ptrdiff_t)fit->ncolumn * all] =
                w * fit->right[k + (ptrdiff_t)c * fit->ncolumn];
        }
        gram[(ptrdiff_t)all * all - 1] = w * fit->yy[c];
        return;
    }
    const double *weight = fit->weight + (ptrdiff_t)c * n;
    for (int k = 0; k < all; k++) {
        const double *from = k < fit->ncolumn ? fit->basis + (ptrdiff_t)2 * n * k : fit->y + (ptrdiff_t)2 * n * c;
        double *to = rows + (ptrdiff_t)2 * n * k;
        for (int i = 0; i < n; i++) {
            to[i] = weight[i] * from[i];
            to[i + n] = weight[i] * from[i + n];
        }
    }
    product_gram(all, 2 * n, rows, gram);
}

/* From the Gram matrix G: x = G_phi^-1 phi'y, derivatives D = psi B(x), schur = D'D - D'phi G_phi^-1 phi'D, score = D'(y - phi
 * x). */
static void channel_solve(struct modal_fit *fit, int c, const double *gram, double *work)
{
    int q = fit->nlinear, p = 2 * fit->nmode, all = fit->ncolumn + 1;
    double *factor = work, *b = factor + (ptrdiff_t)q * q, *saved = b + (ptrdiff_t)q * (p + 1), *scale = saved + (ptrdiff_t)q * p;
    double *x = fit->linear + (ptrdiff_t)c * q, *mix = fit->mix + (ptrdiff_t)c * q * p;
    double *schur = fit->schur + (ptrdiff_t)c * p * p, *score = fit->score + (ptrdiff_t)c * p;
    const double *y = gram + (ptrdiff_t)fit->ncolumn * all;
    for (int j = 0; j < q; j++)
        scale[j] = gram[j + (ptrdiff_t)j * all] > 0 ? 1 / sqrt(gram[j + (ptrdiff_t)j * all]) : 0;
    for (int k = 0; k < q; k++)
        for (int j = 0; j < q; j++)
            factor[j + (ptrdiff_t)k * q] = j == k ? 1 + 1e-14 : gram[j + (ptrdiff_t)k * all] * scale[j] * scale[k];
    fit->singular[c] = cholesky_factor(q, factor);
    if (fit->singular[c]) {
        memset(x, 0, (size_t)q * sizeof(double));
        memset(mix, 0, (size_t)q * (size_t)p * sizeof(double));
        memset(schur, 0, (size_t)p * (size_t)p * sizeof(double));
        memset(score, 0, (size_t)p * sizeof(double));
        fit->chi2[c] = y[fit->ncolumn];
        return;
    }
    for (int j = 0; j < q; j++)
        x[j] = y[j] * scale[j];
    cholesky_solve(q, factor, 1, x);
    double gained = 0;
    for (int j = 0; j < q; j++) {
        x[j] *= scale[j];
        gained += x[j] * y[j];
    }
    fit->chi2[c] = fmax(y[fit->ncolumn] - gained, 0);
    /* D = Psi B: by Re lambda a psi1 + b psi2, by Im lambda -b psi1 + a psi2, for a residue a + i b */
    for (int r = 0; r < fit->nmode; r++) {
        double re = x[(ptrdiff_t)2 * r], im = x[(ptrdiff_t)2 * r + 1];
        for (int part = 0; part < 2; part++) {
            int k = 2 * r + part;
            double f1 = part ? -im : re, f2 = part ? re : im;
            const double *g1 = gram + (ptrdiff_t)(q + 2 * r) * all, *g2 = g1 + all;
            double value = f1 * y[q + 2 * r] + f2 * y[q + 2 * r + 1];
            for (int j = 0; j < q; j++) {
                double entry = f1 * g1[j] + f2 * g2[j];
                value -= entry * x[j];
                b[j + (ptrdiff_t)k * q] = saved[j + (ptrdiff_t)k * q] = entry * scale[j];
            }
            score[k] = value;
            for (int l = 0; l < p; l++) {
                int other = l / 2;
                double h1 = l % 2 ? -x[(ptrdiff_t)2 * other + 1] : x[(ptrdiff_t)2 * other],
                       h2 = l % 2 ? x[(ptrdiff_t)2 * other] : x[(ptrdiff_t)2 * other + 1];
                schur[l + (ptrdiff_t)k * p] = h1 * (f1 * g1[q + 2 * other] + f2 * g2[q + 2 * other]) +
                                              h2 * (f1 * g1[q + 2 * other + 1] + f2 * g2[q + 2 * other + 1]);
            }
        }
    }
    cholesky_solve(q, factor, p, b);
    for (int k = 0; k < p; k++)
        for (int l = 0; l < p; l++)
            schur[l + (ptrdiff_t)k * p] -= product_dot(q, saved + (ptrdiff_t)l * q, b + (ptrdiff_t)k * q);
    for (int k = 0; k < p; k++)
        for (int j = 0; j < q; j++)
            mix[j + (ptrdiff_t)k * q] = b[j + (ptrdiff_t)k * q] * scale[j];
}

static void channel_spread(struct modal_fit *fit, int c, double *factor, const double *scale)
{
    int q = fit->nlinear;
    double *spread = fit->spread + (ptrdiff_t)c * q * q;
    for (int k = 0; k < q; k++)
        for (int j = 0; j < q; j++)
            spread[j + (ptrdiff_t)k * q] = j == k;
    if (fit->singular[c])
        return;
    cholesky_solve(q, factor, q, spread);
    for (int k = 0; k < q; k++)
        for (int j = 0; j < q; j++)
            spread[j + (ptrdiff_t)k * q] *= scale[j] * scale[k];
}

struct evaluation {
    struct modal_fit *fit;
    int with_spread;
};

static int evaluate_channel(void *context, int c, int worker)
{
    const struct evaluation *evaluation = context;
    struct modal_fit *fit = evaluation->fit;
    ptrdiff_t all = fit->ncolumn + 1, q = fit->nlinear, p = 2 * (ptrdiff_t)fit->nmode;
    double *gram = fit->work[worker], *rest = gram + all * all, *rows = rest + q * q + q * (p + 1) + q * p + q;
    channel_gram(fit, c, rows, gram);
    channel_solve(fit, c, gram, rest);
    if (evaluation->with_spread)
        channel_spread(fit, c, rest, rest + q * q + q * (p + 1) + q * p);
    return 0;
}

double modal_fit_evaluate(struct modal_fit *fit, int with_spread)
{
    fill_basis(fit);
    if (!fit->weight) {
        product_gram(fit->ncolumn, 2 * fit->nline, fit->basis, fit->gram);
        product_transposed(fit->ncolumn, fit->nchannel, 2 * fit->nline, fit->basis, fit->y, fit->right);
    }
    struct evaluation evaluation = {fit, with_spread};
    (void)parallel_for(fit->threads, fit->nchannel, evaluate_channel, &evaluation);
    double sum = 0;
    for (int c = 0; c < fit->nchannel; c++)
        sum += fit->chi2[c];
    return sum;
}

void modal_fit_noise(struct modal_fit *fit)
{
    if (fit->weight || fit->equal)
        return;
    int p = 2 * fit->nmode, q = fit->nlinear;
    /* the poles are shared by the channels, so each pays its part of them */
    double dof = fmax(2.0 * fit->nline - q - (double)p / fit->nchannel, 1);
    for (int c = 0; c < fit->nchannel; c++) {
        /* rounding of y'y - x'phi'y bounds from below what can be told of the noise */
        double old = fit->sigma[c] * fit->sigma[c];
        double variance = fmax(fit->chi2[c] * old, 1e-16 * fit->yy[c]) / dof, ratio = old / fmax(variance, 1e-300);
        fit->sigma[c] = sqrt(fmax(variance, 1e-300));
        fit->chi2[c] *= ratio;
        for (int j = 0; j < p; j++)
            fit->score[j + (ptrdiff_t)c * p] *= ratio;
        for (int j = 0; j < p * p; j++)
            fit->schur[j + (ptrdiff_t)c * p * p] *= ratio;
        for (int j = 0; j < q * q; j++)
            fit->spread[j + (ptrdiff_t)c * q * q] /= ratio;
    }
}

int modal_fit_lines(const struct ema_band *band, int nmode, const double complex *pole, double widths, int most, int *line)
{
    for (int i = 0; i < band->nline; i++)
        line[i] = 0;
    for (int r = 0; r < nmode; r++) {
        double centre = cimag(pole[r]), width = 2 * fabs(creal(pole[r]));
        for (int near = 0; near < 2; near++) {
            double reach = (near ? 3 : widths) * width;
            int first = ema_band_line(band, centre - reach), last = ema_band_line(band, centre + reach);
            int middle = ema_band_line(band, centre);
            first = middle - 10 < first ? middle - 10 : first;
            last = middle + 10 > last ? middle + 10 : last;
            for (int i = first < 0 ? 0 : first; i < last && i < band->nline; i++)
                line[i] |= near ? 2 : 1;
        }
    }
    int near = 0, far = 0;
    for (int i = 0; i < band->nline; i++) {
        near += line[i] >= 2;
        far += line[i] == 1;
    }
    int step = 1, kept = 0;
    while (far / step + near > most && step < far)
        step++;
    for (int i = 0, seen = 0; i < band->nline; i++)
        if (line[i] >= 2 || (line[i] == 1 && seen++ % step == 0))
            line[kept++] = i;
    return kept;
}
