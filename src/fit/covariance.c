#include "fit/covariance.h"

#include <math.h>
#include <string.h>

#include "fit/quantile.h"
#include "linalg/least_squares.h"

#define RANK         1e-10 /* singular values below this part of the largest are rounding */
#define UNDETERMINED 0.5   /* relative standard deviation along a direction: about as much change is allowed as there is value */
#define TAKES_PART   0.3   /* component of a unit direction */
#define FREE         1e-6 /* a component of a direction without any information that still leaves a parameter without an interval */

size_t covariance_workspace(int m, int n)
{
    size_t square = (size_t)n * (size_t)n;
    return (size_t)m * (size_t)n + 2 * square + (size_t)n + singular_values_workspace(m, n);
}

/* inner [n * n] := sum over rows of s_i^2 J_i' J_i in the basis of the right singular vectors, divided by the singular values:
 * S^-1 U' diag(s^2) U S^-1, without U. Directions below the rank are left zero. */
static void inner_covariance(const struct covariance_input *in, const double *jacobian, const rotid_fit_result *result,
                             double *inner, double *row)
{
    int m = in->m, n = in->n;
    memset(inner, 0, (size_t)n * (size_t)n * sizeof *inner);
    for (int i = 0; i < m; i++) {
        double std = in->noise_std ? in->noise_std[i] : 1;
        for (int j = 0; j < n; j++) {
            double s = result->singular_value[j], sum = 0;
            for (int k = 0; k < n; k++)
                sum += jacobian[i + (ptrdiff_t)k * m] * result->direction[k + (ptrdiff_t)j * n];
            row[j] = s > RANK * result->singular_value[0] ? sum / (s * s) : 0;
        }
        for (int j = 0; j < n; j++)
            for (int k = 0; k < n; k++)
                inner[k + (ptrdiff_t)j * n] += std * std * row[j] * row[k];
    }
}

static void scale_of_noise(const struct covariance_input *in, int nfixed, rotid_fit_result *result)
{
    double chi2 = 0;
    for (int i = 0; i < in->m; i++) {
        double r = in->noise_std ? in->r[i] / in->noise_std[i] : in->r[i];
        chi2 += r * r;
    }
    result->dof = in->m - (in->n - nfixed) - in->nscale;
    result->variance_from_residuals = !in->noise_std;
    result->chi2 = in->noise_std ? chi2 : NAN;
    result->chi2_per_dof = in->noise_std && result->dof > 0 ? chi2 / result->dof : NAN;
    result->widened_by = in->noise_std && result->chi2_per_dof > 1 ? sqrt(result->chi2_per_dof) : 1;
}

/* cov [n * n] of the relative parameters := V inner V' variance */
static void outer_covariance(int n, const double *direction, const double *inner, double variance, double *cov)
{
    for (int a = 0; a < n; a++)
        for (int b = 0; b < n; b++) {
            double sum = 0;
            for (int j = 0; j < n; j++)
                for (int k = 0; k < n; k++)
                    sum += direction[a + (ptrdiff_t)j * n] * inner[j + (ptrdiff_t)k * n] * direction[b + (ptrdiff_t)k * n];
            cov[a + (ptrdiff_t)b * n] = variance * sum;
        }
}

/* Which directions, and with them which parameters, the data leave open. */
static void judge_directions(const struct covariance_input *in, const double *inner, double variance, double t,
                             rotid_fit_result *result)
{
    int n = in->n;
    for (int p = 0; p < n; p++)
        result->identifiable[p] = !in->fixed[p];
    for (int j = 0; j < n; j++) {
        double s = result->singular_value[j], spread = sqrt(variance * inner[j + (ptrdiff_t)j * n]);
        int rank_lost = !(s > RANK * result->singular_value[0]), of_fixed = 0;
        for (int p = 0; p < n; p++)
            of_fixed |= in->fixed[p] && fabs(result->direction[p + (ptrdiff_t)j * n]) > 0.999;
        result->direction_undetermined[j] = !of_fixed && (rank_lost || (isfinite(spread) && spread > UNDETERMINED));
        for (int p = 0; p < n && result->direction_undetermined[j]; p++) {
            double part = fabs(result->direction[p + (ptrdiff_t)j * n]);
            if (part >= (rank_lost ? FREE : TAKES_PART))
                result->identifiable[p] = 0;
            if (rank_lost && part >= FREE)
                result->std[p] = NAN;
        }
        result->any_undetermined |= result->direction_undetermined[j];
    }
    for (int p = 0; p < n; p++)
        if (t * result->std[p] > fabs(in->x[p])) { /* the 95 % interval holds zero */
            result->identifiable[p] = 0;
            result->any_undetermined = 1;
        }
}

int covariance_compute(const struct covariance_input *in, rotid_fit_result *result, double *work)
{
    int m = in->m, n = in->n, nfixed = 0;
    double *jacobian = work, *inner = jacobian + (ptrdiff_t)m * n, *cov = inner + (ptrdiff_t)n * n, *row = cov + (ptrdiff_t)n * n;
    memcpy(jacobian, in->jacobian, (size_t)m * (size_t)n * sizeof *jacobian);
    for (int p = 0; p < n; p++)
        if (in->fixed[p]) {
            memset(jacobian + (ptrdiff_t)p * m, 0, (size_t)m * sizeof *jacobian);
            nfixed++;
        }
    if (n && singular_values(m, n, jacobian, result->singular_value, result->direction, row + n))
        return ROTID_ERROR_LIBRARY;
    double least = n > nfixed ? result->singular_value[n - nfixed - 1] : 0;
    result->condition_number = least > 0 ? result->singular_value[0] / least : n ? INFINITY : NAN;
    inner_covariance(in, jacobian, result, inner, row);
    scale_of_noise(in, nfixed, result);

    double variance = result->widened_by * result->widened_by;
    int stated = in->noise_std || result->dof > 0;
    if (!in->noise_std && result->dof > 0)
        variance = 2 * result->objective / result->dof;
    if (!stated)
        variance = NAN;
    outer_covariance(n, result->direction, inner, variance, cov);
    for (int p = 0; p < n; p++)
        result->std[p] = in->fixed[p] ? NAN : fabs(in->x[p]) * sqrt(cov[p + (ptrdiff_t)p * n]);
    double t = quantile_student_95(in->noise_std && result->widened_by <= 1 ? 0 : result->dof);
    judge_directions(in, inner, variance, t, result);
    for (int p = 0; p < n; p++) {
        result->ci_lower[p] = in->x[p] - t * result->std[p];
        result->ci_upper[p] = in->x[p] + t * result->std[p];
        for (int q = 0; q < n; q++) {
            ptrdiff_t pq = p + (ptrdiff_t)q * n;
            int known = isfinite(result->std[p]) && isfinite(result->std[q]);
            result->covariance[pq] = known ? cov[pq] * fabs(in->x[p] * in->x[q]) : NAN;
            result->correlation[pq] = known ? cov[pq] / sqrt(cov[p + (ptrdiff_t)p * n] * cov[q + (ptrdiff_t)q * n]) : NAN;
        }
    }
    return ROTID_OK;
}
