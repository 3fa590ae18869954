#include <math.h>
#include <string.h>

#include "base/host.h"
#include "rotid.h"

HOST_COMPUTES void compute_mac(int n, const double *a, const double *b, double *mac)
{
    double ab = 0, aa = 0, bb = 0;
    for (int i = 0; i < n; i++) {
        if (!isfinite(a[i]) || !isfinite(b[i]))
            continue;
        ab += a[i] * b[i];
        aa += a[i] * a[i];
        bb += b[i] * b[i];
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

HOST_COMPUTES void compute_nco(int n, const double *mass, const double *a, const double *b, double *work, double *nco)
{
    double aa = mass_product(n, mass, a, work), bb = mass_product(n, mass, b, work), ab = 0;
    for (int i = 0; i < n; i++)
        if (isfinite(a[i]))
            ab += a[i] * work[i];
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
