#include "fit/fit.h"

#include <float.h>

/* lgamma leaves the sign in a global variable, which the threads of a host would share. In POSIX since 2024, and hidden by the
 * headers of systems older than that. */
double lgamma_r(double x, int *sign);

static double log_gamma(double x)
{
    int sign;
    return lgamma_r(x, &sign);
}

/* Continued fraction of the incomplete beta function by the modified Lentz method (Press et al., Numerical Recipes, 6.4, for the
 * idea; Abramowitz and Stegun 26.5.8 for the coefficients). */
static double beta_fraction(double a, double b, double x)
{
    double c = 1, d = 1 - (a + b) * x / (a + 1), h;
    d = 1 / (fabs(d) < DBL_MIN ? DBL_MIN : d);
    h = d;
    for (int k = 1; k < 500; k++) {
        for (int odd = 0; odd < 2; odd++) {
            double t = odd ? -(a + k) * (a + b + k) * x / ((a + 2 * k) * (a + 2 * k + 1))
                           : k * (b - k) * x / ((a + 2 * k - 1) * (a + 2 * k));
            d = 1 + t * d;
            c = 1 + t / c;
            d = 1 / (fabs(d) < DBL_MIN ? DBL_MIN : d);
            c = fabs(c) < DBL_MIN ? DBL_MIN : c;
            h *= d * c;
            if (odd && fabs(d * c - 1) < 4 * DBL_EPSILON)
                return h;
        }
    }
    return h;
}

static double incomplete_beta(double a, double b, double x)
{
    if (x <= 0 || x >= 1)
        return x >= 1;
    double front = exp(log_gamma(a + b) - log_gamma(a) - log_gamma(b) + a * log(x) + b * log1p(-x));
    return x < (a + 1) / (a + b + 2) ? front * beta_fraction(a, b, x) / a : 1 - front * beta_fraction(b, a, 1 - x) / b;
}

static double student_tail(double t, double dof)
{
    return incomplete_beta(0.5 * dof, 0.5, dof / (dof + t * t));
}

/* The x at which a falling tail has come down to `outside`, by bisection. */
static double limit_of(double (*tail)(double x, double dof), double outside, int dof)
{
    double low = 0, high = 1;
    while (tail(high, dof) > outside && high < 1e100)
        high *= 2;
    for (int i = 0; i < 100 && high - low > 1e-15 * high; i++) {
        double middle = (low + high) / 2;
        *(tail(middle, dof) > outside ? &low : &high) = middle;
    }
    return (low + high) / 2;
}

double quantile_student(double outside, int dof)
{
    return limit_of(student_tail, outside, dof);
}

double quantile_student_95(int dof)
{
    return dof < 1 ? 1.959963984540054 : quantile_student(0.05, dof);
}

/* Series below the mean, continued fraction above it (Abramowitz and Stegun 6.5.29, 6.5.31). */
double chi_square_tail(double x, double dof)
{
    double a = 0.5 * dof, y = 0.5 * x;
    if (isnan(y))
        return NAN;
    if (!(y > 0))
        return 1;
    if (isinf(y))
        return 0;
    double front = exp(a * log(y) - y - log_gamma(a));
    if (y < a + 1) {
        double sum = 1 / a, term = sum;
        for (int k = 1; k < 10000 && term > sum * DBL_EPSILON; k++)
            sum += term *= y / (a + k);
        return 1 - front * sum;
    }
    double b = y + 1 - a, c = 1 / DBL_MIN, d = 1 / b, h = d;
    for (int k = 1; k < 10000; k++) {
        double t = -k * (k - a);
        b += 2;
        d = 1 / (t * d + b);
        c = b + t / c;
        h *= d * c;
        if (fabs(d * c - 1) < 4 * DBL_EPSILON)
            break;
    }
    return front * h;
}

double chi_square_limit(double outside, int dof)
{
    return limit_of(chi_square_tail, outside, dof);
}
