#include "base/base.h"
#include "linalg/machine.h"

/* A power of two that takes the largest finite component to about 1, without rounding: neither criterion depends on the scale of
 * a shape, and squares of 1e200 and 1e-200 have no double. */
static double unit_of(int n, const double *a)
{
    int exponent;
    (void)frexp(largest_magnitude(n, a), &exponent);
    return ldexp(1, exponent > 1000 ? -1000 : exponent < -1000 ? 1000 : -exponent);
}

HOST_COMPUTES void compute_mac(int n, const double *a, const double *b, double *mac)
{
    double ab = 0, aa = 0, bb = 0, of_a = unit_of(n, a), of_b = unit_of(n, b);
    for (int i = 0; i < n; i++) {
        if (!isfinite(a[i]) || !isfinite(b[i]))
            continue;
        double x = of_a * a[i], y = of_b * b[i];
        ab += x * y;
        aa += x * x;
        bb += y * y;
    }
    *mac = aa > 0 && bb > 0 ? ab * ab / (aa * bb) : 0;
}

double rotid_mac(int n, const double *a, const double *b)
{
    fenv_t floating;
    double mac;
    host_enter_floating(&floating);
    compute_mac(n, a, b, &mac);
    host_leave_floating(&floating);
    return mac;
}

/* y := M x, x times `unit`, with its components that are not finite taken as zero; returns x' y */
static double mass_product(int n, const double *mass, double unit, const double *x, double *restrict y)
{
    double sum = 0;
    memset(y, 0, (size_t)n * sizeof *y);
    for (int j = 0; j < n; j++) {
        const double *restrict column = mass + (ptrdiff_t)j * n, part = unit * x[j];
        int i = isfinite(part) ? 0 : n;
        for (; i + 4 <= n; i += 4)
            *(four *)(y + i) += FOUR(column + i) * part;
        for (; i < n; i++)
            y[i] += column[i] * part;
    }
    for (int i = 0; i < n; i++)
        if (isfinite(x[i]))
            sum += unit * x[i] * y[i];
    return sum;
}

HOST_COMPUTES void compute_nco(int n, const double *mass, const double *a, const double *b, double *work, double *nco)
{
    double of_a = unit_of(n, a), of_b = unit_of(n, b), aa = mass_product(n, mass, of_a, a, work),
           bb = mass_product(n, mass, of_b, b, work), ab = 0;
    for (int i = 0; i < n; i++)
        if (isfinite(a[i]))
            ab += of_a * a[i] * work[i];
    *nco = aa > 0 && bb > 0 ? ab * ab / (aa * bb) : 0;
}

double rotid_nco(int n, const double *mass, const double *a, const double *b, double *work)
{
    fenv_t floating;
    double nco;
    host_enter_floating(&floating);
    compute_nco(n, mass, a, b, work, &nco);
    host_leave_floating(&floating);
    return nco;
}
