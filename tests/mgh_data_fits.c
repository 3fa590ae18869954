#include "mgh_residuals.h"

#include <math.h>

RESIDUAL(mgh_jennrich_sampson)
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
    return r ? mgh_unusable(m, r) : mgh_unusable(m * n, jacobian);
}

RESIDUAL(mgh_bard)
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
    return r ? mgh_unusable(m, r) : mgh_unusable(m * n, jacobian);
}

RESIDUAL(mgh_meyer)
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
    return r ? mgh_unusable(m, r) : mgh_unusable(m * n, jacobian);
}

RESIDUAL(mgh_box)
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
    return r ? mgh_unusable(m, r) : mgh_unusable(m * n, jacobian);
}

RESIDUAL(mgh_kowalik_osborne)
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
    return r ? mgh_unusable(m, r) : mgh_unusable(m * n, jacobian);
}

RESIDUAL(mgh_brown_dennis)
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
    return r ? mgh_unusable(m, r) : mgh_unusable(m * n, jacobian);
}

RESIDUAL(mgh_osborne_1)
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
    return r ? mgh_unusable(m, r) : mgh_unusable(m * n, jacobian);
}

RESIDUAL(mgh_osborne_2)
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
    return r ? mgh_unusable(m, r) : mgh_unusable(m * n, jacobian);
}

RESIDUAL(mgh_gaussian)
{
    (void)user;
    static const double y[8] = {0.0009, 0.0044, 0.0175, 0.0540, 0.1295, 0.2420, 0.3521, 0.3989};
    for (int i = 0; i < m; i++) {
        double t = (7 - i) / 2.0, d = t - x[2], e = exp(-x[1] * d * d / 2);
        if (r) {
            r[i] = x[0] * e - y[i < 8 ? i : 14 - i];
        } else {
            J(i, 0) = e;
            J(i, 1) = -x[0] * e * d * d / 2;
            J(i, 2) = x[0] * e * x[1] * d;
        }
    }
    return r ? mgh_unusable(m, r) : mgh_unusable(m * n, jacobian);
}

/* The paper prints |y_i m i x2|, for which (50, 25, 1.5) is no zero; y_i - x2 is meant. */
RESIDUAL(mgh_gulf)
{
    (void)user;
    for (int i = 0; i < m; i++) {
        double t = (i + 1) / 100.0, d = 25 + pow(-50 * log(t), 2.0 / 3) - x[1], size = fabs(d), power = pow(size, x[2]),
               e = exp(-power / x[0]);
        if (r) {
            r[i] = e - t;
        } else {
            J(i, 0) = e * power / (x[0] * x[0]);
            J(i, 1) = e * x[2] * pow(size, x[2] - 1) * copysign(1, d) / x[0];
            J(i, 2) = size > 0 ? -e * power * log(size) / x[0] : 0;
        }
    }
    return r ? mgh_unusable(m, r) : mgh_unusable(m * n, jacobian);
}

RESIDUAL(mgh_biggs)
{
    (void)user;
    for (int i = 0; i < m; i++) {
        double t = 0.1 * (i + 1), y = exp(-t) - 5 * exp(-10 * t) + 3 * exp(-4 * t);
        double a = exp(-t * x[0]), b = exp(-t * x[1]), c = exp(-t * x[4]);
        if (r) {
            r[i] = x[2] * a - x[3] * b + x[5] * c - y;
        } else {
            J(i, 0) = -t * x[2] * a;
            J(i, 1) = t * x[3] * b;
            J(i, 2) = a;
            J(i, 3) = -b;
            J(i, 4) = -t * x[5] * c;
            J(i, 5) = c;
        }
    }
    return r ? mgh_unusable(m, r) : mgh_unusable(m * n, jacobian);
}
