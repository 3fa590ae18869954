#include <math.h>
#include <string.h>

#include "rotid.h"

double rotid_mac(int n, const double *a, const double *b)
{
    double ab = 0, aa = 0, bb = 0;
    for (int i = 0; i < n; i++) {
        if (!isfinite(a[i]) || !isfinite(b[i]))
            continue;
        ab += a[i] * b[i];
        aa += a[i] * a[i];
        bb += b[i] * b[i];
    }
    return aa > 0 && bb > 0 ? ab * ab / (aa * bb) : 0;
}

/* y := M x with the components of x that are not finite taken as zero; returns x' y */
static double mass_product(int n, const double *mass, const double *x, double *y)
{
    double sum = 0;
    memset(y, 0, (size_t)n * sizeof *y);
    for (int j = 0; j < n; j++)
        for (int i = 0; i < n && isfinite(x[j]); i++)
            y[i] += mass[i + (ptrdiff_t)j * n] * x[j];
    for (int i = 0; i < n; i++)
        if (isfinite(x[i]))
            sum += x[i] * y[i];
    return sum;
}

double rotid_nco(int n, const double *mass, const double *a, const double *b, double *work)
{
    double aa = mass_product(n, mass, a, work), bb = mass_product(n, mass, b, work), ab = 0;
    for (int i = 0; i < n; i++)
        if (isfinite(a[i]))
            ab += a[i] * work[i];
    return aa > 0 && bb > 0 ? ab * ab / (aa * bb) : 0;
}
