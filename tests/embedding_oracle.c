#include "embedding_oracle.h"

#include "oracle/oracle.h"
#include "support.h"

static const double pi = 3.14159265358979323846;

void embedding_rotor_hz(double young, double shear, double hz[4])
{
    struct oracle_segment segment[3];
    assert_int_equal(oracle_round_segment(0.30, 0.08, 0, 2.1e11, 2.1e11 / 2.6, 0.30, 7850, 0, &segment[0]), 0);
    assert_int_equal(oracle_round_segment(0.50, 0.20, 0, young, shear, 0.28, 7650, 0, &segment[1]), 0);
    assert_int_equal(oracle_round_segment(0.25, 0.07, 0, 2.1e11, 2.1e11 / 2.6, 0.30, 7850, 0, &segment[2]), 0);
    struct oracle_system system = {.segments = 3, .segment = segment};
    assert_int_equal(oracle_frequencies(&system, 3, 4, hz), 0);
}

/* Standard deviations [2] from the normal matrix a, and the step a^-1 b. */
static void solve_normal(double a[2][2], const double b[2], double step[2], double std[2])
{
    double det = a[0][0] * a[1][1] - a[0][1] * a[1][0];
    step[0] = (a[1][1] * b[0] - a[0][1] * b[1]) / det;
    step[1] = (a[0][0] * b[1] - a[1][0] * b[0]) / det;
    std[0] = sqrt(a[1][1] / det);
    std[1] = sqrt(a[0][0] / det);
}

void embedding_rotor_std(double hz_std, double std[2])
{
    double up[4], down[4], j[2][4], a[2][2] = {{0}}, b[2] = {0}, step[2];
    for (int p = 0; p < 2; p++) {
        double h = p ? 4e6 : 1.1e7;
        embedding_rotor_hz(1.1e11 + (p ? 0 : h), 4e10 + (p ? h : 0), up);
        embedding_rotor_hz(1.1e11 - (p ? 0 : h), 4e10 - (p ? h : 0), down);
        for (int k = 0; k < 4; k++)
            j[p][k] = (up[k] - down[k]) / (2 * h) / (hz_std * (up[k] + down[k]) / 2);
    }
    for (int k = 0; k < 4; k++)
        for (int p = 0; p < 4; p++)
            a[p / 2][p % 2] += j[p / 2][k] * j[p % 2][k];
    solve_normal(a, b, step, std);
}

/* Euler and Bernoulli: no shear, no rotatory inertia. */
static struct oracle_segment slender(double length, double diameter, double density, double young)
{
    return (struct oracle_segment){.length = length,
                                   .bending = young * pi * pow(diameter, 4) / 64,
                                   .shear = INFINITY,
                                   .mass = density * pi * diameter * diameter / 4};
}

void embedding_stepped(const double x[2], double hz[STEPPED_MODES], double *shape)
{
    static const double sensor[STEPPED_SENSORS] = {0.15, 0.30, 0.45, 0.65, 0.85, 1.05};
    struct oracle_segment segment[3] = {slender(0.30, 0.040, 7850, 2.1e11), slender(0.50, 0.060, 7700, x[0]),
                                        slender(0.25, 0.035, 7850, 2.1e11)};
    struct oracle_point point[2] = {{.z = 0, .spring = INFINITY, .rotational_spring = INFINITY}, {.z = 1.05, .spring = x[1]}};
    struct oracle_system system = {.segments = 3, .segment = segment, .points = 2, .point = point};
    assert_int_equal(oracle_frequencies(&system, 1, STEPPED_MODES, hz), 0);
    for (int k = 0; k < STEPPED_MODES; k++)
        assert_int_equal(oracle_shape(&system, hz[k], STEPPED_SENSORS, sensor, shape + k * STEPPED_SENSORS, NULL), 0);
}

static void residuals(const double x[2], const double *hz, const double *shape, double hz_std, double shape_std, double *r)
{
    double exact_hz[STEPPED_MODES], exact[STEPPED_MODES * STEPPED_SENSORS];
    embedding_stepped(x, exact_hz, exact);
    for (int k = 0; k < STEPPED_MODES; k++) {
        const double *phi = exact + k * STEPPED_SENSORS, *measured = shape + k * STEPPED_SENSORS;
        double product = 0, square = 0, largest = 0;
        for (int s = 0; s < STEPPED_SENSORS; s++) {
            product += phi[s] * measured[s];
            square += phi[s] * phi[s];
            largest = fmax(largest, fabs(measured[s]));
        }
        *r++ = (exact_hz[k] / hz[k] - 1) / hz_std;
        for (int s = 0; s < STEPPED_SENSORS; s++)
            *r++ = (product / square * phi[s] - measured[s]) / (shape_std * largest);
    }
}

void embedding_stepped_estimate(const double x[2], const double *hz, const double *shape, double hz_std, double shape_std,
                                double step[2], double std[2], double *chi2)
{
    double r[STEPPED_RESIDUALS], more[STEPPED_RESIDUALS], less[STEPPED_RESIDUALS], j[2][STEPPED_RESIDUALS];
    double a[2][2] = {{0}}, b[2] = {0};
    residuals(x, hz, shape, hz_std, shape_std, r);
    for (int p = 0; p < 2; p++) {
        double h = 1e-4 * x[p], up[2] = {x[0], x[1]}, down[2] = {x[0], x[1]};
        up[p] += h;
        down[p] -= h;
        residuals(up, hz, shape, hz_std, shape_std, more);
        residuals(down, hz, shape, hz_std, shape_std, less);
        for (int i = 0; i < STEPPED_RESIDUALS; i++)
            j[p][i] = (more[i] - less[i]) / (2 * h);
    }
    *chi2 = 0;
    for (int i = 0; i < STEPPED_RESIDUALS; i++) {
        *chi2 += r[i] * r[i];
        for (int p = 0; p < 2; p++) {
            b[p] -= j[p][i] * r[i];
            a[p][0] += j[p][i] * j[0][i];
            a[p][1] += j[p][i] * j[1][i];
        }
    }
    solve_normal(a, b, step, std);
}
