#include "mgh_residuals.h"

#include <math.h>

int mgh_unusable(int count, const double *values)
{
    for (int i = 0; i < count; i++)
        if (!isfinite(values[i]))
            return 1;
    return 0;
}

RESIDUAL(mgh_rosenbrock)
{
    (void)user;
    if (r) {
        r[0] = 10 * (x[1] - x[0] * x[0]);
        r[1] = 1 - x[0];
        return mgh_unusable(m, r);
    }
    J(0, 0) = -20 * x[0];
    J(0, 1) = 10;
    J(1, 0) = -1;
    J(1, 1) = 0;
    return mgh_unusable(m * n, jacobian);
}

RESIDUAL(mgh_freudenstein_roth)
{
    (void)user;
    double y = x[1];
    if (r) {
        r[0] = -13 + x[0] + ((5 - y) * y - 2) * y;
        r[1] = -29 + x[0] + ((y + 1) * y - 14) * y;
        return mgh_unusable(m, r);
    }
    J(0, 0) = J(1, 0) = 1;
    J(0, 1) = (10 - 3 * y) * y - 2;
    J(1, 1) = (3 * y + 2) * y - 14;
    return mgh_unusable(m * n, jacobian);
}

RESIDUAL(mgh_helical_valley)
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
        return mgh_unusable(m, r);
    }
    J(0, 0) = 100 * x[1] / (2 * pi * square);
    J(0, 1) = -100 * x[0] / (2 * pi * square);
    J(0, 2) = 10;
    J(1, 0) = 10 * x[0] / root;
    J(1, 1) = 10 * x[1] / root;
    J(1, 2) = J(2, 0) = J(2, 1) = 0;
    J(2, 2) = 1;
    return mgh_unusable(m * n, jacobian);
}

RESIDUAL(mgh_powell_singular)
{
    (void)user;
    double p = x[1] - 2 * x[2], q = x[0] - x[3], root5 = sqrt(5), root10 = sqrt(10);
    if (r) {
        r[0] = x[0] + 10 * x[1];
        r[1] = root5 * (x[2] - x[3]);
        r[2] = p * p;
        r[3] = root10 * q * q;
        return mgh_unusable(m, r);
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
    return mgh_unusable(m * n, jacobian);
}

RESIDUAL(mgh_powell_badly_scaled)
{
    (void)user;
    if (r) {
        r[0] = 1e4 * x[0] * x[1] - 1;
        r[1] = exp(-x[0]) + exp(-x[1]) - 1.0001;
        return mgh_unusable(m, r);
    }
    J(0, 0) = 1e4 * x[1];
    J(0, 1) = 1e4 * x[0];
    J(1, 0) = -exp(-x[0]);
    J(1, 1) = -exp(-x[1]);
    return mgh_unusable(m * n, jacobian);
}

RESIDUAL(mgh_brown_badly_scaled)
{
    (void)user;
    if (r) {
        r[0] = x[0] - 1e6;
        r[1] = x[1] - 2e-6;
        r[2] = x[0] * x[1] - 2;
        return mgh_unusable(m, r);
    }
    J(0, 0) = J(1, 1) = 1;
    J(1, 0) = J(0, 1) = 0;
    J(2, 0) = x[1];
    J(2, 1) = x[0];
    return mgh_unusable(m * n, jacobian);
}

RESIDUAL(mgh_beale)
{
    (void)user;
    static const double y[3] = {1.5, 2.25, 2.625};
    for (int i = 0; i < m; i++) {
        double power = pow(x[1], i + 1);
        if (r) {
            r[i] = y[i] - x[0] * (1 - power);
        } else {
            J(i, 0) = power - 1;
            J(i, 1) = x[0] * (i + 1) * pow(x[1], i);
        }
    }
    return r ? mgh_unusable(m, r) : mgh_unusable(m * n, jacobian);
}

RESIDUAL(mgh_wood)
{
    (void)user;
    double root90 = sqrt(90), root10 = sqrt(10);
    if (r) {
        r[0] = 10 * (x[1] - x[0] * x[0]);
        r[1] = 1 - x[0];
        r[2] = root90 * (x[3] - x[2] * x[2]);
        r[3] = 1 - x[2];
        r[4] = root10 * (x[1] + x[3] - 2);
        r[5] = (x[1] - x[3]) / root10;
        return mgh_unusable(m, r);
    }
    for (int k = 0; k < m * n; k++)
        jacobian[k] = 0;
    J(0, 0) = -20 * x[0];
    J(0, 1) = 10;
    J(1, 0) = J(3, 2) = -1;
    J(2, 2) = -2 * root90 * x[2];
    J(2, 3) = root90;
    J(4, 1) = J(4, 3) = root10;
    J(5, 1) = 1 / root10;
    J(5, 3) = -1 / root10;
    return mgh_unusable(m * n, jacobian);
}

/* t_i = i/29: p' - p^2 - 1 of the polynomial p = sum x_j t^(j-1), and two conditions */
RESIDUAL(mgh_watson)
{
    (void)user;
    for (int i = 0; i < 29; i++) {
        double t = (i + 1) / 29.0, p = 0, slope = 0, power = 1;
        for (int j = n - 1; j >= 0; j--) {
            slope = slope * t + p;
            p = p * t + x[j];
        }
        if (r)
            r[i] = slope - p * p - 1;
        for (int j = 0; !r && j < n; j++, power *= t)
            J(i, j) = j * power / t - 2 * p * power;
    }
    if (r) {
        r[29] = x[0];
        r[30] = x[1] - x[0] * x[0] - 1;
        return mgh_unusable(m, r);
    }
    for (int j = 0; j < n; j++)
        J(29, j) = J(30, j) = 0;
    J(29, 0) = J(30, 1) = 1;
    J(30, 0) = -2 * x[0];
    return mgh_unusable(m * n, jacobian);
}

RESIDUAL(mgh_brown_almost_linear)
{
    (void)user;
    double sum = 0, product = 1;
    for (int j = 0; j < n; j++) {
        sum += x[j];
        product *= x[j];
    }
    for (int i = 0; r && i < n; i++)
        r[i] = i < n - 1 ? x[i] + sum - (n + 1) : product - 1;
    for (int j = 0; !r && j < n; j++) {
        double others = 1;
        for (int i = 0; i < n; i++) {
            J(i, j) = i == j ? 2 : 1;
            others *= i == j ? 1 : x[i];
        }
        J(n - 1, j) = others;
    }
    return r ? mgh_unusable(m, r) : mgh_unusable(m * n, jacobian);
}

RESIDUAL(mgh_linear_full_rank)
{
    (void)user;
    double sum = 0;
    for (int j = 0; j < n; j++)
        sum += x[j];
    for (int i = 0; i < m; i++) {
        if (r)
            r[i] = (i < n ? x[i] : 0) - 2 * sum / m - 1;
        for (int j = 0; !r && j < n; j++)
            J(i, j) = (i == j) - 2.0 / m;
    }
    return r ? mgh_unusable(m, r) : mgh_unusable(m * n, jacobian);
}

RESIDUAL(mgh_linear_rank_one)
{
    (void)user;
    double sum = 0;
    for (int j = 0; j < n; j++)
        sum += (j + 1) * x[j];
    for (int i = 0; i < m; i++) {
        if (r)
            r[i] = (i + 1) * sum - 1;
        for (int j = 0; !r && j < n; j++)
            J(i, j) = (i + 1.0) * (j + 1);
    }
    return r ? mgh_unusable(m, r) : mgh_unusable(m * n, jacobian);
}

/* Mean of the shifted Chebyshev polynomial T_i over the x_j less its mean over (0, 1), i = 1 ... m */
RESIDUAL(mgh_chebyquad)
{
    (void)user;
    for (int i = 0; r && i < m; i++)
        r[i] = i % 2 ? 1 / ((i + 1.0) * (i + 1.0) - 1) : 0;
    for (int j = 0; j < n; j++) {
        double z = 2 * x[j] - 1, before = 1, t = z, slope_before = 0, slope = 2;
        for (int i = 0; i < m; i++) {
            if (r)
                r[i] += t / n;
            else
                J(i, j) = slope / n;
            double next = 2 * z * t - before, next_slope = 4 * t + 2 * z * slope - slope_before;
            before = t;
            slope_before = slope;
            t = next;
            slope = next_slope;
        }
    }
    return r ? mgh_unusable(m, r) : mgh_unusable(m * n, jacobian);
}
