/* Covariance, intervals and undetermined directions, against dense formulas, constructed Jacobians and simulated data. */
#include "fit/fit.h"
#include "support.h"

#define M 30
#define N 4

struct sample {
    double jacobian[M * N], r[M], noise[M], x[N]; /* the Jacobian with respect to x_p/|x_p| */
    int fixed[N], nscale, n, known;               /* known: noise is stated */
    double std[N], ci_lower[N], ci_upper[N], covariance[N * N], correlation[N * N], singular_value[N], direction[N * N];
    int identifiable[N], undetermined[N];
    rotid_fit_result result;
};

static void draw(struct sample *s, uint64_t seed)
{
    struct random_stream stream = {seed};
    memset(s, 0, sizeof *s);
    for (int i = 0; i < M * N; i++)
        s->jacobian[i] = 3 * random_normal(&stream);
    for (int i = 0; i < M; i++) {
        s->r[i] = 0.3 * random_normal(&stream);
        s->noise[i] = 0.1 + 0.4 * random_uniform(&stream);
    }
    for (int p = 0; p < N; p++)
        s->x[p] = (p % 2 ? -1 : 1) * pow(10, 3 * p); /* signs and units as far apart as moduli and densities */
    s->n = N;
}

static void compute(struct sample *s)
{
    double work[2000];
    struct covariance_input in = {M, s->n, s->jacobian, s->r, s->known ? s->noise : NULL, s->nscale, s->x, s->fixed};
    assert_true(covariance_workspace(M, N) <= sizeof work / sizeof *work);
    memset(&s->result, 0, sizeof s->result);
    s->result.std = s->std;
    s->result.ci_lower = s->ci_lower;
    s->result.ci_upper = s->ci_upper;
    s->result.covariance = s->covariance;
    s->result.correlation = s->correlation;
    s->result.singular_value = s->singular_value;
    s->result.direction = s->direction;
    s->result.identifiable = s->identifiable;
    s->result.direction_undetermined = s->undetermined;
    for (int i = 0; i < M; i++)
        s->result.objective += s->r[i] * s->r[i] / 2;
    assert_status(covariance_compute(&in, &s->result, work), ROTID_OK);
}

/* inverse := A^-1 [n * n] by Gauss-Jordan; A is overwritten */
static void invert(int n, double *a, double *inverse)
{
    for (int i = 0; i < n * n; i++)
        inverse[i] = i % (n + 1) == 0;
    for (int c = 0; c < n; c++) {
        double pivot = a[c + c * n];
        for (int j = 0; j < n; j++) {
            a[c + j * n] /= pivot;
            inverse[c + j * n] /= pivot;
        }
        for (int i = 0; i < n; i++) {
            double factor = a[i + c * n];
            for (int j = 0; j < n && i != c; j++) {
                a[i + j * n] -= factor * a[c + j * n];
                inverse[i + j * n] -= factor * inverse[c + j * n];
            }
        }
    }
}

/* out [n * n] := (J'J)^-1 J' diag(weight) J (J'J)^-1 over the first n columns, in the units of x */
static void sandwich(const struct sample *s, int n, const double *weight, double *out)
{
    double normal[N * N] = {0}, filling[N * N] = {0}, inverse[N * N], half[N * N] = {0};
    for (int a = 0; a < n; a++)
        for (int b = 0; b < n; b++)
            for (int i = 0; i < M; i++) {
                normal[a + b * n] += s->jacobian[i + a * M] * s->jacobian[i + b * M];
                filling[a + b * n] += weight[i] * s->jacobian[i + a * M] * s->jacobian[i + b * M];
            }
    invert(n, normal, inverse);
    memset(out, 0, (size_t)(n * n) * sizeof *out);
    for (int a = 0; a < n; a++)
        for (int b = 0; b < n; b++)
            for (int k = 0; k < n; k++)
                half[a + b * n] += inverse[a + k * n] * filling[k + b * n];
    for (int a = 0; a < n; a++)
        for (int b = 0; b < n; b++)
            for (int k = 0; k < n; k++)
                out[a + b * n] += half[a + k * n] * inverse[k + b * n] * fabs(s->x[a] * s->x[b]);
}

static void check(const struct sample *s, int n, const double *expected, double t)
{
    for (int a = 0; a < n; a++) {
        double std = sqrt(expected[a + a * n]);
        assert_close(s->std[a], std, 1e-10, 0);
        assert_close(s->ci_lower[a], s->x[a] - t * std, 1e-10, 0);
        assert_close(s->ci_upper[a], s->x[a] + t * std, 1e-10, 0);
        for (int b = 0; b < n; b++) {
            double other = sqrt(expected[b + b * n]);
            assert_close(s->covariance[a + b * s->n], expected[a + b * n], 1e-9, 1e-10 * std * other);
            assert_close(s->correlation[a + b * s->n], expected[a + b * n] / (std * other), 0, 1e-10);
        }
    }
}

UNIT_TEST(test_unknown_noise_comes_from_the_residuals_with_student_intervals)
{
    struct sample s;
    double weight[M], expected[N * N];
    draw(&s, 1);
    compute(&s);
    for (int i = 0; i < M; i++)
        weight[i] = 2 * s.result.objective / (M - N);
    sandwich(&s, N, weight, expected);
    check(&s, N, expected, quantile_student_95(M - N));
    assert_int_equal(s.result.dof, M - N);
    assert_true(s.result.variance_from_residuals && isnan(s.result.chi2) && s.result.widened_by == 1);
}

/* residuals in units of their noise: (J'J)^-1, a fit better than expected does not narrow it */
UNIT_TEST(test_likelihood_takes_the_stated_noise_and_is_not_narrowed)
{
    struct sample s;
    double weight[M], expected[N * N];
    draw(&s, 2);
    s.known = 1;
    for (int i = 0; i < M; i++)
        s.noise[i] = weight[i] = 1;
    compute(&s);
    assert_true(s.result.chi2_per_dof < 0.5);
    sandwich(&s, N, weight, expected);
    check(&s, N, expected, 1.9599639845400545);
    assert_true(!s.result.variance_from_residuals && s.result.widened_by == 1);
}

UNIT_TEST(test_misfit_beyond_the_noise_widens_the_intervals_and_says_so)
{
    struct sample s;
    double weight[M], expected[N * N], chi2 = 0;
    draw(&s, 3);
    s.known = 1;
    s.nscale = 5;
    for (int i = 0; i < M; i++) {
        s.noise[i] = 0.1;
        chi2 += s.r[i] * s.r[i] / 0.01;
    }
    compute(&s);
    assert_close(s.result.chi2, chi2, 1e-13, 0);
    assert_int_equal(s.result.dof, M - N - 5);
    assert_close(s.result.chi2_per_dof, chi2 / (M - N - 5), 1e-13, 0);
    assert_true(chi2 > 2 * (M - N - 5));
    assert_close(s.result.widened_by, sqrt(chi2 / (M - N - 5)), 1e-13, 0);
    for (int i = 0; i < M; i++)
        weight[i] = 0.01 * chi2 / (M - N - 5);
    sandwich(&s, N, weight, expected);
    check(&s, N, expected, quantile_student_95(M - N - 5));
}

/* a functional that does not weigh by the noise it knows */
UNIT_TEST(test_unweighted_fit_of_known_noise_has_the_sandwich_covariance)
{
    struct sample s;
    double weight[M], expected[N * N];
    draw(&s, 4);
    s.known = 1;
    for (int i = 0; i < M; i++) {
        s.r[i] = 0.5 * s.noise[i];
        weight[i] = s.noise[i] * s.noise[i];
    }
    compute(&s);
    sandwich(&s, N, weight, expected);
    check(&s, N, expected, 1.9599639845400545);
}

/* x = (J'J)^-1 J' e over draws of the noise e: 20000 draws know a standard deviation to 0.5 %, a correlation to 0.007. */
UNIT_TEST(test_sandwich_is_the_scatter_of_simulated_fits)
{
    enum { DRAWS = 20000 };
    struct sample s;
    struct random_stream stream = {5};
    double normal[N * N] = {0}, inverse[N * N], sum[N * N] = {0};
    draw(&s, 5);
    s.known = 1;
    memset(s.r, 0, sizeof s.r);
    compute(&s);
    for (int k = 0; k < N * N * M; k++)
        normal[k / M] += s.jacobian[k % M + k / M % N * M] * s.jacobian[k % M + k / M / N * M];
    invert(N, normal, inverse);
    for (int d = 0; d < DRAWS; d++) {
        double right[N] = {0}, x[N] = {0};
        for (int i = 0; i < M; i++) {
            double e = s.noise[i] * random_normal(&stream);
            for (int a = 0; a < N; a++)
                right[a] += s.jacobian[i + a * M] * e;
        }
        for (int a = 0; a < N; a++)
            for (int b = 0; b < N; b++)
                x[a] += inverse[a + b * N] * right[b] * fabs(s.x[a]);
        for (int a = 0; a < N; a++)
            for (int b = 0; b < N; b++)
                sum[a + b * N] += x[a] * x[b] / DRAWS;
    }
    for (int a = 0; a < N; a++)
        for (int b = 0; b < N; b++)
            assert_close(s.covariance[a + b * N], sum[a + b * N], 0, 0.03 * sqrt(sum[a + a * N] * sum[b + b * N]));
}

UNIT_TEST(test_parameter_pressed_against_a_bound_counts_as_known)
{
    struct sample s;
    double weight[M], expected[N * N];
    draw(&s, 6);
    s.known = 1;
    s.fixed[N - 1] = 1;
    for (int i = 0; i < M; i++)
        s.noise[i] = weight[i] = 1;
    compute(&s);
    sandwich(&s, N - 1, weight, expected);
    check(&s, N - 1, expected, 1.9599639845400545);
    assert_int_equal(s.result.dof, M - N + 1);
    assert_true(isnan(s.std[N - 1]) && isnan(s.ci_lower[N - 1]) && isnan(s.covariance[N - 1]));
    assert_true(!s.identifiable[N - 1] && !s.result.any_undetermined && s.result.condition_number < 100);
    for (int p = 0; p < N - 1; p++)
        assert_true(s.identifiable[p]);
}

/* J = (I - 2 u u'/u'u) diag(sigma) (I - 2 v v'/v'v): singular values and right singular vectors are known by construction */
static void build(struct sample *s, const double *sigma, const double *v)
{
    double u[M], uu = 0, vv = 0;
    for (int i = 0; i < M; i++) {
        u[i] = 1 + 0.1 * i;
        uu += u[i] * u[i];
    }
    for (int p = 0; p < N; p++)
        vv += v[p] * v[p];
    for (int p = 0; p < N; p++)
        for (int i = 0; i < M; i++) {
            s->jacobian[i + p * M] = 0;
            for (int k = 0; k < N; k++)
                s->jacobian[i + p * M] += ((i == k) - 2 * u[i] * u[k] / uu) * sigma[k] * ((p == k) - 2 * v[p] * v[k] / vv);
        }
}

static double right_vector(const double *v, int p, int k)
{
    double vv = 0;
    for (int q = 0; q < N; q++)
        vv += v[q] * v[q];
    return (p == k) - 2 * v[p] * v[k] / vv;
}

UNIT_TEST(test_singular_values_directions_and_condition_are_those_of_the_jacobian)
{
    static const double sigma[N] = {50, 20, 5, 0.25}, v[N] = {1, 2, -1, 3};
    struct sample s;
    draw(&s, 7);
    build(&s, sigma, v);
    compute(&s);
    assert_close(s.result.condition_number, 200, 1e-12, 0);
    for (int k = 0; k < N; k++) {
        double cosine = 0;
        assert_close(s.singular_value[k], sigma[k], 1e-12, 0);
        for (int p = 0; p < N; p++)
            cosine += s.direction[p + k * N] * right_vector(v, p, k);
        assert_close(fabs(cosine), 1, 1e-12, 0);
    }
}

/* x1 + 2 x2 - x3 cancels out of every residual; x4 is as well known as before */
UNIT_TEST(test_direction_without_information_is_named_and_gets_no_interval)
{
    struct sample s, without;
    draw(&s, 8);
    s.known = 1;
    for (int i = 0; i < M; i++) {
        s.noise[i] = 1;
        s.jacobian[i + 2 * M] = s.jacobian[i] + 2 * s.jacobian[i + M];
    }
    compute(&s);
    double cosine = (s.direction[0 + 3 * N] + 2 * s.direction[1 + 3 * N] - s.direction[2 + 3 * N]) / sqrt(6);
    assert_close(fabs(cosine), 1, 1e-10, 0);
    assert_true(s.result.any_undetermined && s.undetermined[3] && !s.undetermined[0] && !s.undetermined[1] && !s.undetermined[2]);
    for (int p = 0; p < 3; p++)
        assert_true(!s.identifiable[p] && isnan(s.std[p]) && isnan(s.ci_upper[p]) && isnan(s.correlation[p]));
    assert_true(s.result.condition_number > 1e12);
    without = s; /* dropping one of the three leaves the others determined, and x4 as it was */
    without.n = 3;
    memcpy(without.jacobian + 2 * M, s.jacobian + 3 * M, M * sizeof(double));
    without.x[2] = s.x[3];
    compute(&without);
    assert_true(s.identifiable[3]);
    assert_close(s.std[3], without.std[2], 1e-9, 0);
}

/* However small its part in a direction without any information, a parameter has no finite interval. */
UNIT_TEST(test_small_part_in_a_direction_without_information_is_not_given_an_interval)
{
    static const double sigma[N] = {50, 20, 5, 0}, v[N] = {1, 2, -1, 3}; /* parts -0.4, -0.8, 0.4, -0.2 */
    struct sample s;
    draw(&s, 9);
    s.known = 1;
    build(&s, sigma, v);
    compute(&s);
    for (int p = 0; p < N; p++)
        assert_true(isnan(s.std[p]) && !s.identifiable[p]);
}

/* The last direction is known to 1/sigma: just better and just worse than half of the parameters' size. */
UNIT_TEST(test_direction_worse_than_half_the_value_is_undetermined)
{
    static const double v[N] = {1, 2, -1, 3};
    for (int worse = 0; worse < 2; worse++) {
        double sigma[N] = {50, 20, 5, worse ? 1.99 : 2.01};
        struct sample s;
        draw(&s, 10);
        s.known = 1;
        memset(s.r, 0, sizeof s.r);
        for (int i = 0; i < M; i++)
            s.noise[i] = 1;
        build(&s, sigma, v);
        compute(&s);
        assert_int_equal(s.undetermined[3], worse);
        assert_int_equal(s.result.any_undetermined, worse);
        for (int p = 0; p < N; p++) { /* the components of that direction: -0.4, -0.8, 0.4, -0.2 */
            assert_int_equal(s.identifiable[p], !(worse && fabs(right_vector(v, p, 3)) > 0.3));
            assert_true(isfinite(s.std[p]));
        }
    }
}

/* A part of 0.2 in a direction with a spread of 1000 % leaves 200 %, in one of 400 % it leaves 80 %, 1.96 times which is more
 * than all, in one of 200 % it leaves 40 %. */
UNIT_TEST(test_no_parameter_whose_interval_holds_zero_is_called_identifiable)
{
    static const double spread[3] = {10, 4, 2}, v[N] = {1, 2, -1, 3};
    for (int i = 0; i < 3; i++) {
        const double sigma[N] = {50, 50, 50, 1 / spread[i]};
        struct sample s;
        draw(&s, 11);
        s.known = 1;
        memset(s.r, 0, sizeof s.r);
        for (int k = 0; k < M; k++)
            s.noise[k] = 1;
        build(&s, sigma, v);
        compute(&s);
        for (int p = 0; p < N; p++) {
            double part = fabs(right_vector(v, p, 3));
            assert_close(s.std[p] / fabs(s.x[p]), spread[i] * part, 0.05, 0);
            assert_int_equal(s.identifiable[p], part < 0.3 && i == 2);
        }
    }
}

UNIT_TEST(test_no_degree_of_freedom_left_states_nothing)
{
    struct sample s;
    draw(&s, 12);
    s.nscale = M - N;
    compute(&s);
    assert_int_equal(s.result.dof, 0);
    for (int p = 0; p < N; p++)
        assert_true(isnan(s.std[p]) && isnan(s.ci_lower[p]) && isnan(s.ci_upper[p]) && s.identifiable[p]);
    assert_true(!s.result.any_undetermined && isfinite(s.result.condition_number));
}

UNIT_TEST(limits_of_chi_square_are_those_of_its_table)
{
    /* NIST/SEMATECH e-Handbook, table 1.3.6.7.4: upper 5 % */
    static const struct {
        int dof;
        double x;
    } table[] = {{1, 3.841}, {2, 5.991}, {6, 12.592}, {10, 18.307}, {100, 124.342}};
    for (size_t i = 0; i < sizeof table / sizeof *table; i++)
        assert_close(chi_square_limit(0.05, table[i].dof), table[i].x, 0, 6e-4);
}
