/* Eigenpairs of matrices whose eigenvalues are stated: K = S Q D Q' S, M = S^2 with block rotations Q, over numbers of rows, half
 * bands, counts, clusters and scales of 1e12. Meant for the address sanitizer too: each solver owns a workspace. */
#include "dense.h"
#include "support.h"

#include <float.h>

enum spectrum { SPREAD, TWO_VALUES, FEW_COPIES, HALF_ZERO, ALL_EQUAL, TRIPLES, STIFF_PAIRS, SPECTRA, DENSE };

static double eigenvalue(enum spectrum spectrum, double high, int n, int i)
{
    switch (spectrum) {
    case TWO_VALUES:
        return i % 3 ? 1 : high;
    case FEW_COPIES:
        return i % 7 ? high * (1 + (double)i / n) : 1;
    case HALF_ZERO:
        return i % 2 ? 0 : high * (1 + i);
    case ALL_EQUAL:
        return high;
    case TRIPLES:
        return pow(high, (double)(i / 3 * 3) / n);
    case STIFF_PAIRS:
        return i % 2 ? 1 + 0.05 * i : high;
    default:
        return pow(high, (double)i / n);
    }
}

static int ascending(const void *a, const void *b)
{
    return (*(const double *)a > *(const double *)b) - (*(const double *)a < *(const double *)b);
}

/* Rows top ... top + size - 1: D, reflected by 1 - 2 v v' where size > 1. */
static void put_block(struct random_stream *stream, int top, int size, const double *d, const double *scale, rotid_matrix *k)
{
    double v[64], square = 0;
    for (int i = 0; i < size; i++) {
        v[i] = size > 1 ? random_normal(stream) : 0;
        square += v[i] * v[i];
    }
    for (int j = 0; j < size; j++)
        for (int i = j; i < size; i++) {
            double sum = 0;
            for (int c = 0; c < size; c++)
                sum += ((i == c) - (square > 0 ? 2 * v[i] * v[c] / square : 0)) * d[top + c] *
                       ((j == c) - (square > 0 ? 2 * v[j] * v[c] / square : 0));
            k->band[(i - j) + (ptrdiff_t)(top + j) * (k->kd + 1)] = scale[top + i] * sum * scale[top + j];
        }
}

static void solve_stated(struct pool *pool, int n, int kd, int count, enum spectrum spectrum, double high, int rotated)
{
    struct random_stream stream = {(uint64_t)(n + 1000 * kd + 100000 * count)};
    rotid_matrix k = {.n = n, .kd = kd, .band = numbers(pool, (ptrdiff_t)n * (kd + 1))}, m = k;
    m.band = numbers(pool, (ptrdiff_t)n * (kd + 1));
    double *d = numbers(pool, n), *scale = numbers(pool, n), *lambda = numbers(pool, count),
           *phi = numbers(pool, (ptrdiff_t)n * count), largest = 0;
    for (int i = 0; i < n; i++) {
        d[i] = eigenvalue(spectrum, high, n, i);
        scale[i] = rotated ? pow(10, 3 * random_normal(&stream)) : 1;
        m.band[(ptrdiff_t)i * (kd + 1)] = scale[i] * scale[i];
        largest = fmax(largest, d[i]);
    }
    int size = rotated ? (kd + 1 < 64 ? kd + 1 : 64) : 1;
    for (int top = 0; top < n; top += size)
        put_block(&stream, top, n - top < size ? n - top : size, d, scale, &k);
    char failure[ROTID_FAILURE_LENGTH];
    int status = rotid_eigenpairs(&k, &m, count, NULL, failure, lambda, phi);
    if (status)
        fail_msg("%s: n %d, kd %d, count %d, spectrum %d, high %g, rotated %d: %s", rotid_status_name(status), n, kd, count,
                 (int)spectrum, high, rotated, failure);
    qsort(d, (size_t)n, sizeof *d, ascending);
    /* Rounding makes that of an eigenvalue beside the highest one. Of pairs that lie 1e12 above the shift the inverse keeps four
     * digits of the vector, and their quotient twice as many of the eigenvalue. */
    for (int j = 0; j < count; j++)
        assert_close(lambda[j], d[j], 1e-6, 64 * n * DBL_EPSILON * largest);
}

POOL_TEST(eigenvalues_are_those_stated)
{
    static const int sizes[][2] = {{1, 0}, {13, 12}, {40, 3}, {60, 12}, {100, 99}, {120, 11}, {200, 48}},
                     counts[] = {1, 4, 12, 30};
    static const double highs[] = {10, 1e6, 1e12};
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++)
        for (size_t c = 0; c < sizeof counts / sizeof *counts && counts[c] <= sizes[s][0]; c++)
            for (int spectrum = 0; spectrum < SPECTRA; spectrum++)
                for (int h = 0; h < 3; h++)
                    for (int rotated = 0; rotated < 2; rotated++)
                        solve_stated(*state, sizes[s][0], sizes[s][1], counts[c], (enum spectrum)spectrum, highs[h], rotated);
}

/* Blocks that nothing connects, in wide panels: what is left of an image after projection is 1e-12 of it, and M times it is not
 * what the same subtractions leave of M times the image. */
POOL_TEST(little_that_is_left_has_its_own_image)
{
    for (int count = 2; count < 8; count++) {
        solve_stated(*state, 60, 12, count, STIFF_PAIRS, 1e6, 1);
        solve_stated(*state, 62, 12, count, STIFF_PAIRS, 1e8, 1);
        solve_stated(*state, 60, 12, count, FEW_COPIES, 1e11, 1);
        solve_stated(*state, 62, 12, count, FEW_COPIES, 1e12, 1);
    }
    solve_stated(*state, 71, 12, 6, FEW_COPIES, 1e8, 1);
    solve_stated(*state, 59, 12, 6, FEW_COPIES, 1e12, 1);
}

/* Too many rows for the dense solver, which would answer in place of the bands: the count below a shift sees the rounding of the
 * stiff pairs in the soft ones. */
POOL_TEST(soft_pairs_among_stiff_ones_are_all_found)
{
    solve_stated(*state, 2400, 1, 1, STIFF_PAIRS, 1e12, 1);
    solve_stated(*state, 2400, 1, 4, STIFF_PAIRS, 1e12, 1);
    solve_stated(*state, 2101, 1, 1, FEW_COPIES, 1e12, 1);
    solve_stated(*state, 2101, 1, 9, FEW_COPIES, 1e12, 1);
    solve_stated(*state, 2200, 3, 5, FEW_COPIES, 1e10, 1);
    solve_stated(*state, 2400, 8, 9, FEW_COPIES, 1e12, 1);
}

/* The same of eigenvalues of which more are equal, or zero, than a solver keeps vectors: what is below them is counted. */
POOL_TEST(more_pairs_are_equal_than_there_are_vectors)
{
    static const enum spectrum spectra[] = {TWO_VALUES, HALF_ZERO, ALL_EQUAL};
    for (size_t s = 0; s < sizeof spectra / sizeof *spectra; s++)
        for (int rotated = spectra[s] == HALF_ZERO; rotated < 2; rotated++)
            for (int wide = 0; wide < 2; wide++)
                solve_stated(*state, 2400, wide ? 14 : 3, rotated ? 3 : 12, spectra[s], rotated ? 10 : 1e6, rotated);
}

/* Beside a support by a penalty the others are as small as rounding, and not zero: what has no digits for them says so. */
POOL_TEST(soft_pairs_beside_a_penalty_are_not_taken_for_zero)
{
    for (int wide = 0; wide < 2; wide++) {
        int n = 2400, kd = wide ? 14 : 1;
        rotid_matrix k = {.n = n, .kd = kd, .band = numbers(*state, (ptrdiff_t)n * (kd + 1))}, m = k;
        m.band = numbers(*state, (ptrdiff_t)n * (kd + 1));
        double lambda[3], *phi = numbers(*state, (ptrdiff_t)n * 3);
        for (int i = 0; i < n; i++) {
            int dof[2] = {i, i + 1};
            assert_status(rotid_matrix_add(&m, i, i, 1, NULL), ROTID_OK);
            if (i + 1 < n)
                assert_status(rotid_matrix_add_element(&k, 2, dof, (double[]){1, -1, -1, 1}, NULL), ROTID_OK);
        }
        assert_status(rotid_matrix_add(&k, 0, 0, 1e24, NULL), ROTID_OK);
        int status = rotid_eigenpairs(&k, &m, 3, NULL, NULL, lambda, phi);
        assert_true(status == ROTID_OK || status == ROTID_ERROR_EIGEN || status == ROTID_ERROR_STIFFNESS);
        for (int j = 0; j < 3 && !status; j++)
            assert_close(lambda[j], 4 * pow(sin((2 * j + 1) * 3.14159265358979324 / (2 * (2 * n - 1))), 2), 1e-6, 0);
    }
}

/* Eigenvalues without a gap, as of blades that are almost alike */
POOL_TEST(a_dense_spectrum_converges)
{
    solve_stated(*state, 2400, 1, 12, DENSE, 1e3, 1);
}

/* Half as many elements of rank one as rows, and springs between far rows: half of the eigenvalues are zero, which a shift just
 * below zero tells from 1e-8 of the highest one by its last digits alone. K x - lambda M x of all pairs, over the root of the
 * mass. */
POOL_TEST(pairs_at_zero_leave_nothing)
{
    struct random_stream stream = {11};
    for (int i = 0; i < 60; i++) {
        int n = 60 + i, far[6], dof[13], count = 9 * n / 20;
        rotid_matrix k = {.n = n, .kd = 12, .nfar = 6, .far = far, .band = numbers(*state, (ptrdiff_t)n * 13)}, m = k;
        k.block = numbers(*state, 36);
        m.block = numbers(*state, 36);
        m.band = numbers(*state, (ptrdiff_t)n * 13);
        double *scale = numbers(*state, n), *lambda = numbers(*state, count), *phi = numbers(*state, (ptrdiff_t)n * count),
               *kx = numbers(*state, n), *mx = numbers(*state, n), largest = 0;
        for (int f = 0; f < 6; f++)
            far[f] = (2 * f + 1) * n / 12;
        for (int r = 0; r < n; r++) {
            scale[r] = pow(10, 1.5 * random_normal(&stream));
            assert_status(rotid_matrix_add(&m, r, r, scale[r] * scale[r], NULL), ROTID_OK);
        }
        for (int e = 0; e < n / 2 + 6; e++) {
            double x[13], element[169];
            int nd = e < n / 2 ? 1 + (int)(fabs(random_normal(&stream)) * 5) % 13 : 2,
                top = (int)(fabs(random_normal(&stream)) * 1e6) % (n - nd + 1);
            for (int r = 0; r < nd; r++) {
                dof[r] = e < n / 2 ? top + r : far[(e - n / 2 + r) % 6];
                x[r] = (e < n / 2 ? random_normal(&stream) * (e % 10 ? 1 : 30) : 1 - 2 * r) * scale[dof[r]];
            }
            for (int r = 0; r < nd * nd; r++)
                element[r] = x[r % nd] * x[r / nd];
            assert_status(rotid_matrix_add_element(&k, nd, dof, element, NULL), ROTID_OK);
        }
        for (int r = 0; r < n; r++) {
            memset(kx, 0, (size_t)n * sizeof *kx);
            kx[r] = 1;
            assert_status(rotid_matrix_multiply(&k, 1, kx, mx, NULL), ROTID_OK);
            largest = fmax(largest, mx[r] / (scale[r] * scale[r]));
        }
        assert_status(rotid_eigenpairs(&k, &m, count, NULL, NULL, lambda, phi), ROTID_OK);
        for (int j = 0; j < count; j++) {
            double square = 0;
            assert_status(rotid_matrix_multiply(&k, 1, phi + (ptrdiff_t)j * n, kx, NULL), ROTID_OK);
            assert_status(rotid_matrix_multiply(&m, 1, phi + (ptrdiff_t)j * n, mx, NULL), ROTID_OK);
            for (int r = 0; r < n; r++)
                square += pow((kx[r] - lambda[j] * mx[r]) / scale[r], 2);
            assert_true(sqrt(square) < 1e-9 * largest);
        }
    }
}

POOL_TEST(no_stiffness_has_pairs_at_zero)
{
    solve_stated(*state, 1, 0, 1, ALL_EQUAL, 0, 1);
}
