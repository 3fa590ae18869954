// A C++ host: the header as it is, a routine with a callback, texts. Prints "ok" and returns 0.
#include "rotid.h"

#include <cmath>
#include <cstdio>
#include <vector>

namespace
{

// Rosenbrock's valley as two residuals, of any scale.
int valley(void *user, int, int, const double *x, double *r, double *jacobian)
{
    const double steep = *static_cast<const double *>(user);
    if (r) {
        r[0] = steep * (x[1] - x[0] * x[0]);
        r[1] = 1 - x[0];
    } else {
        jacobian[0] = -2 * steep * x[0];
        jacobian[1] = -1;
        jacobian[2] = steep;
        jacobian[3] = 0;
    }
    return 0;
}

} // namespace

int main()
{
    double steep = 10, x[] = {-1.2, 1}, r[2], jacobian[4];
    std::vector<double> work(rotid_lm_workspace(2, 2));
    rotid_lm_options options = rotid_lm_options();
    options.size = sizeof options;
    rotid_lm_result result;
    const int status = rotid_lm(2, 2, valley, &steep, &options, NULL, x, r, jacobian, work.data(), &result);
    if (status < ROTID_STOP_GRADIENT || std::fabs(x[0] - 1) > 1e-8 || std::fabs(x[1] - 1) > 1e-8) {
        std::printf("%s at %g, %g\n", rotid_status_text(status), x[0], x[1]);
        return 1;
    }
    std::printf("ok %s\n", rotid_version());
    return 0;
}
