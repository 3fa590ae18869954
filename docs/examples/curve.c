/* Fits the curve y = b1/b2 exp(-((x - b3)/b2)^2 / 2) to a measured peak by rotid_lm, after rotid_check_jacobian has agreed with
 * the derivatives. C and C++. */
#include <math.h>
#include <rotid.h>
#include <stdio.h>
#include <stdlib.h>

/* Transmittance over wavelength [nm]: K. Eckerle, Circular Interference Transmittance Study, NIST (197?), data set Eckerle4 of
 * https://www.itl.nist.gov/div898/strd/nls/nls_main.shtml. NIST certifies b1 = 1.5543827178, b2 = 4.0888321754,
 * b3 = 451.54121844 with a sum of squares of 1.4635887487e-3. */
static const double peak[][2] = {
    {400.0, 0.0001575}, {405.0, 0.0001699}, {410.0, 0.0002350}, {415.0, 0.0003102}, {420.0, 0.0004917}, {425.0, 0.0008710},
    {430.0, 0.0017418}, {435.0, 0.0046400}, {436.5, 0.0065895}, {438.0, 0.0097302}, {439.5, 0.0149002}, {441.0, 0.0237310},
    {442.5, 0.0401683}, {444.0, 0.0712559}, {445.5, 0.1264458}, {447.0, 0.2073413}, {448.5, 0.2902366}, {450.0, 0.3445623},
    {451.5, 0.3698049}, {453.0, 0.3668534}, {454.5, 0.3106727}, {456.0, 0.2078154}, {457.5, 0.1164354}, {459.0, 0.0616764},
    {460.5, 0.0337200}, {462.0, 0.0194023}, {463.5, 0.0117831}, {465.0, 0.0074357}, {470.0, 0.0022732}, {475.0, 0.0008800},
    {480.0, 0.0004579}, {485.0, 0.0002345}, {490.0, 0.0001586}, {495.0, 0.0001143}, {500.0, 0.0000710},
};
enum { M = sizeof peak / sizeof peak[0], N = 3 };

/* The residual, or its derivatives: rotid asks for one of the two. */
static int residual(void *user, int m, int n, const double *b, double *r, double *jacobian)
{
    (void)user, (void)n;
    if (b[1] <= 0)
        return 1; /* no residual there: a shorter step is tried */
    for (int i = 0; i < m; i++) {
        double t = (peak[i][0] - b[2]) / b[1], e = exp(-t * t / 2) / b[1];
        if (r) {
            r[i] = b[0] * e - peak[i][1];
        } else {
            jacobian[i] = e;
            jacobian[i + m] = b[0] * e * (t * t - 1) / b[1];
            jacobian[i + 2 * m] = b[0] * e * t / b[1];
        }
    }
    return 0;
}

int main(void)
{
    double b[N] = {1, 10, 500}, r[M], jacobian[M * N], error[N], doubt[N];
    size_t room = rotid_lm_workspace(M, N), room_to_check = rotid_check_jacobian_workspace(M, N);
    double *work = (double *)malloc((room > room_to_check ? room : room_to_check) * sizeof(double));
    char failure[ROTID_FAILURE_LENGTH] = "";
    rotid_lm_result result;
    int status = work ? rotid_check_jacobian(M, N, residual, NULL, b, NULL, failure, error, doubt, work) : ROTID_ERROR_MEMORY;
    for (int j = 0; j < N && status == ROTID_OK; j++)
        if (!(error[j] <= 1e-6 || error[j] <= doubt[j])) {
            fprintf(stderr, "column %d of the Jacobian is wrong by %.2g of its length\n", j + 1, error[j]);
            status = ROTID_ERROR_CALLBACK;
        }
    if (status == ROTID_OK)
        status = rotid_lm(M, N, residual, NULL, NULL, failure, b, r, jacobian, work, &result);
    free(work);
    if (!rotid_status_converged(status)) {
        fprintf(stderr, "%s\n", *failure ? failure : rotid_status_text(status));
        return 1;
    }
    printf("b1 = %.8g, b2 = %.8g, b3 = %.8g\n", b[0], b[1], b[2]);
    printf("sum of squares %.8g\n", 2 * result.objective);
    return 0;
}
