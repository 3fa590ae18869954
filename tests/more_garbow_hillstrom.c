#include "more_garbow_hillstrom.h"

#include <math.h>

#define RESIDUAL(name) static int name(void *user, int m, int n, const double *x, double *r, double *jacobian)
#define J(i, j)        jacobian[(i) + (j)*m]

/* what an overflow looks like to a caller: no residual there */
static int unusable(int count, const double *values)
{
    for (int i = 0; i < count; i++)
        if (!isfinite(values[i]))
            return 1;
    return 0;
}

/* 1 */
RESIDUAL(rosenbrock)
{
    (void)user;
    if (r) {
        r[0] = 10 * (x[1] - x[0] * x[0]);
        r[1] = 1 - x[0];
        return unusable(m, r);
    }
    J(0, 0) = -20 * x[0];
    J(0, 1) = 10;
    J(1, 0) = -1;
    J(1, 1) = 0;
    return unusable(m * n, jacobian);
}

/* 2: two minima, 0 and 48.9842 at (11.4128, -0.896805), the one that is reached from here */
RESIDUAL(freudenstein_roth)
{
    (void)user;
    double y = x[1];
    if (r) {
        r[0] = -13 + x[0] + ((5 - y) * y - 2) * y;
        r[1] = -29 + x[0] + ((y + 1) * y - 14) * y;
        return unusable(m, r);
    }
    J(0, 0) = J(1, 0) = 1;
    J(0, 1) = (10 - 3 * y) * y - 2;
    J(1, 1) = (3 * y + 2) * y - 14;
    return unusable(m * n, jacobian);
}

/* 6 */
RESIDUAL(jennrich_sampson)
{
    (void)user;
    for (int i = 0; i < m; i++) {
        double t = i + 1, a = exp(t * x[0]), b = exp(t * x[1]);
        if (r) {
            r[i] = 2 + 2 * t - (a + b);
        } else {
            J(i, 0) = -t * a;
            J(i, 1) = -t * b;
        }
    }
    return r ? unusable(m, r) : unusable(m * n, jacobian);
}

/* 7: theta runs through a quarter turn at x1 = 0 */
RESIDUAL(helical_valley)
{
    (void)user;
    const double pi = 3.14159265358979323846;
    double square = x[0] * x[0] + x[1] * x[1], root = sqrt(square);
    if (r) {
        double theta = x[0] > 0   ? atan(x[1] / x[0]) / (2 * pi)
                       : x[0] < 0 ? atan(x[1] / x[0]) / (2 * pi) + 0.5
                                  : copysign(0.25, x[1]);
        r[0] = 10 * (x[2] - 10 * theta);
        r[1] = 10 * (root - 1);
        r[2] = x[2];
        return unusable(m, r);
    }
    J(0, 0) = 100 * x[1] / (2 * pi * square);
    J(0, 1) = -100 * x[0] / (2 * pi * square);
    J(0, 2) = 10;
    J(1, 0) = 10 * x[0] / root;
    J(1, 1) = 10 * x[1] / root;
    J(1, 2) = J(2, 0) = J(2, 1) = 0;
    J(2, 2) = 1;
    return unusable(m * n, jacobian);
}

/* 8 */
RESIDUAL(bard)
{
    (void)user;
    static const double y[15] = {0.14, 0.18, 0.22, 0.25, 0.29, 0.32, 0.35, 0.39, 0.37, 0.58, 0.73, 0.96, 1.34, 2.10, 4.39};
    for (int i = 0; i < m; i++) {
        double u = i + 1, v = 15 - i, w = fmin(u, v), below = v * x[1] + w * x[2];
        if (r) {
            r[i] = y[i] - (x[0] + u / below);
        } else {
            J(i, 0) = -1;
            J(i, 1) = u * v / (below * below);
            J(i, 2) = u * w / (below * below);
        }
    }
    return r ? unusable(m, r) : unusable(m * n, jacobian);
}

/* 10 */
RESIDUAL(meyer)
{
    (void)user;
    static const double y[16] = {34780, 28610, 23650, 19630, 16370, 13720, 11540, 9744,
                                 8261,  7030,  6005,  5147,  4427,  3820,  3307,  2872};
    for (int i = 0; i < m; i++) {
        double below = 50 + 5 * i + x[2], e = exp(x[1] / below);
        if (r) {
            r[i] = x[0] * e - y[i];
        } else {
            J(i, 0) = e;
            J(i, 1) = x[0] * e / below;
            J(i, 2) = -x[0] * e * x[1] / (below * below);
        }
    }
    return r ? unusable(m, r) : unusable(m * n, jacobian);
}

/* 12 */
RESIDUAL(box)
{
    (void)user;
    for (int i = 0; i < m; i++) {
        double t = 0.1 * (i + 1), a = exp(-t * x[0]), b = exp(-t * x[1]), c = exp(-t) - exp(-10 * t);
        if (r) {
            r[i] = a - b - x[2] * c;
        } else {
            J(i, 0) = -t * a;
            J(i, 1) = t * b;
            J(i, 2) = -c;
        }
    }
    return r ? unusable(m, r) : unusable(m * n, jacobian);
}

/* 13: the Jacobian is singular at the minimum */
RESIDUAL(powell_singular)
{
    (void)user;
    double p = x[1] - 2 * x[2], q = x[0] - x[3], root5 = sqrt(5), root10 = sqrt(10);
    if (r) {
        r[0] = x[0] + 10 * x[1];
        r[1] = root5 * (x[2] - x[3]);
        r[2] = p * p;
        r[3] = root10 * q * q;
        return unusable(m, r);
    }
    for (int k = 0; k < m * n; k++)
        jacobian[k] = 0;
    J(0, 0) = 1;
    J(0, 1) = 10;
    J(1, 2) = root5;
    J(1, 3) = -root5;
    J(2, 1) = 2 * p;
    J(2, 2) = -4 * p;
    J(3, 0) = 2 * root10 * q;
    J(3, 3) = -2 * root10 * q;
    return unusable(m * n, jacobian);
}

/* 15 */
RESIDUAL(kowalik_osborne)
{
    (void)user;
    static const double y[11] = {0.1957, 0.1947, 0.1735, 0.1600, 0.0844, 0.0627, 0.0456, 0.0342, 0.0323, 0.0235, 0.0246};
    static const double u[11] = {4, 2, 1, 0.5, 0.25, 0.167, 0.125, 0.1, 0.0833, 0.0714, 0.0625};
    for (int i = 0; i < m; i++) {
        double above = u[i] * (u[i] + x[1]), below = u[i] * (u[i] + x[2]) + x[3];
        if (r) {
            r[i] = y[i] - x[0] * above / below;
        } else {
            J(i, 0) = -above / below;
            J(i, 1) = -x[0] * u[i] / below;
            J(i, 2) = x[0] * above * u[i] / (below * below);
            J(i, 3) = x[0] * above / (below * below);
        }
    }
    return r ? unusable(m, r) : unusable(m * n, jacobian);
}

/* 16 */
RESIDUAL(brown_dennis)
{
    (void)user;
    for (int i = 0; i < m; i++) {
        double t = 0.2 * (i + 1), a = x[0] + t * x[1] - exp(t), b = x[2] + sin(t) * x[3] - cos(t);
        if (r) {
            r[i] = a * a + b * b;
        } else {
            J(i, 0) = 2 * a;
            J(i, 1) = 2 * a * t;
            J(i, 2) = 2 * b;
            J(i, 3) = 2 * b * sin(t);
        }
    }
    return r ? unusable(m, r) : unusable(m * n, jacobian);
}

/* 17 */
RESIDUAL(osborne_1)
{
    (void)user;
    static const double y[33] = {0.844, 0.908, 0.932, 0.936, 0.925, 0.908, 0.881, 0.850, 0.818, 0.784, 0.751,
                                 0.718, 0.685, 0.658, 0.628, 0.603, 0.580, 0.558, 0.538, 0.522, 0.506, 0.490,
                                 0.478, 0.467, 0.457, 0.448, 0.438, 0.431, 0.424, 0.420, 0.414, 0.411, 0.406};
    for (int i = 0; i < m; i++) {
        double t = 10 * i, a = exp(-t * x[3]), b = exp(-t * x[4]);
        if (r) {
            r[i] = y[i] - (x[0] + x[1] * a + x[2] * b);
        } else {
            J(i, 0) = -1;
            J(i, 1) = -a;
            J(i, 2) = -b;
            J(i, 3) = t * x[1] * a;
            J(i, 4) = t * x[2] * b;
        }
    }
    return r ? unusable(m, r) : unusable(m * n, jacobian);
}

/* 19 */
RESIDUAL(osborne_2)
{
    (void)user;
    static const double y[65] = {1.366, 1.191, 1.112, 1.013, 0.991, 0.885, 0.831, 0.847, 0.786, 0.725, 0.746, 0.679, 0.608,
                                 0.655, 0.616, 0.606, 0.602, 0.626, 0.651, 0.724, 0.649, 0.649, 0.694, 0.644, 0.624, 0.661,
                                 0.612, 0.558, 0.533, 0.495, 0.500, 0.423, 0.395, 0.375, 0.372, 0.391, 0.396, 0.405, 0.428,
                                 0.429, 0.523, 0.562, 0.607, 0.653, 0.672, 0.708, 0.633, 0.668, 0.645, 0.632, 0.591, 0.559,
                                 0.597, 0.625, 0.739, 0.710, 0.729, 0.720, 0.636, 0.581, 0.428, 0.292, 0.162, 0.098, 0.054};
    for (int i = 0; i < m; i++) {
        double t = 0.1 * i, sum = 0;
        for (int k = 0; k < 4; k++) {
            double d = k ? t - x[7 + k] : 0, e = exp(k ? -d * d * x[4 + k] : -t * x[4]);
            sum += x[k] * e;
            if (r)
                continue;
            J(i, k) = -e;
            J(i, 4 + k) = x[k] * e * (k ? d * d : t);
            if (k)
                J(i, 7 + k) = -2 * x[k] * e * d * x[4 + k];
        }
        if (r)
            r[i] = y[i] - sum;
    }
    return r ? unusable(m, r) : unusable(m * n, jacobian);
}

const struct mgh_problem mgh_problems[] = {
    {"Rosenbrock", 2, 2, rosenbrock, {-1.2, 1}, 0, 7},
    {"Freudenstein-Roth", 2, 2, freudenstein_roth, {0.5, -2}, 48.9842, 7},
    {"Jennrich-Sampson", 10, 2, jennrich_sampson, {0.3, 0.4}, 124.362, 1},
    {"helical valley", 3, 3, helical_valley, {-1, 0, 0}, 0, 7},
    {"Bard", 15, 3, bard, {1, 1, 1}, 8.21487e-3, 1},
    {"Meyer", 16, 3, meyer, {0.02, 4000, 250}, 87.9458, 1},
    {"Box 3D", 10, 3, box, {0, 10, 20}, 0, 1},
    {"Powell singular", 4, 4, powell_singular, {3, -1, 0, 1}, 0, 7},
    {"Kowalik-Osborne", 11, 4, kowalik_osborne, {0.25, 0.39, 0.415, 0.39}, 3.07505e-4, 7},
    {"Brown-Dennis", 20, 4, brown_dennis, {25, 5, -5, -1}, 85822.2, 7},
    {"Osborne 1", 33, 5, osborne_1, {0.5, 1.5, -1, 0.01, 0.02}, 5.46489e-5, 7},
    {"Osborne 2", 65, 11, osborne_2, {1.3, 0.65, 0.65, 0.7, 0.6, 3, 5, 7, 2, 4.5, 5.5}, 4.01377e-2, 1},
};

const int mgh_count = (int)(sizeof mgh_problems / sizeof *mgh_problems);
