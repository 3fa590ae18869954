/* Pencils that no structure has are refused by the banded eigen-solvers, and always in the same way. */
#include "dense.h"
#include "either_band.h"
#include "support.h"

static int status_of(struct pool *pool, const rotid_matrix *k, const rotid_matrix *m, int count)
{
    struct either_band e;
    double *lambda = numbers(pool, count), *phi = numbers(pool, (ptrdiff_t)k->n * count);
    assert_status(either_band_new(pool, k, count, &e), ROTID_OK);
    return either_band_solve(&e, k, m, lambda, phi);
}

POOL_TEST(a_mass_that_is_not_positive_definite_is_an_error)
{
    struct random_stream stream = {23};
    const int n = 40;
    for (int row = 0; row < n; row += 3) {
        rotid_matrix k, m;
        random_positive(*state, &stream, n, 3, 0, NULL, 1, &k);
        random_positive(*state, &stream, n, 3, 0, NULL, 1, &m);
        assert_status(status_of(*state, &k, &m, 4), ROTID_OK);
        double *unit = numbers(*state, n), *diagonal = &m.band[4 * row];
        unit[row] = 1;
        double margin = 1 / dense_solution(*state, n, 1, dense_of(*state, &m), unit)[row];
        *diagonal -= 1.5 * margin; /* indefinite, with every diagonal element still positive */
        assert_status(status_of(*state, &k, &m, 4), ROTID_ERROR_MASS);
        *diagonal = -1;
        assert_status(status_of(*state, &k, &m, 4), ROTID_ERROR_MASS);
    }
}

POOL_TEST(a_stiffness_that_is_indefinite_is_an_error)
{
    struct random_stream stream = {24};
    const int n = 40;
    for (int row = 0; row < n; row += 3)
        for (int size = 0; size < 3; size++) {
            rotid_matrix k, m;
            random_positive(*state, &stream, n, 3, 0, NULL, 1, &k);
            random_positive(*state, &stream, n, 3, 0, NULL, 1, &m);
            double *unit = numbers(*state, n);
            unit[row] = 1;
            double margin = 1 / dense_solution(*state, n, 1, dense_of(*state, &k), unit)[row];
            k.band[4 * row] -= margin * (size == 0 ? 1.001 : size == 1 ? 1.5 : 100);
            assert_status(status_of(*state, &k, &m, 4), ROTID_ERROR_STIFFNESS);
        }
}

/* Whether K is refused must not depend on what was solved before. */
POOL_TEST(an_indefinite_stiffness_is_an_error_warm_as_well)
{
    struct random_stream stream = {25};
    const int n = 40;
    rotid_matrix k, m;
    struct either_band e;
    double lambda[4], *phi = numbers(*state, 4 * n), *unit = numbers(*state, n);
    random_positive(*state, &stream, n, 3, 0, NULL, 1, &k);
    random_positive(*state, &stream, n, 3, 0, NULL, 1, &m);
    assert_status(either_band_new(*state, &k, 4, &e), ROTID_OK);
    assert_status(either_band_solve(&e, &k, &m, lambda, phi), ROTID_OK);
    double first = lambda[0];
    unit[20] = 1;
    double margin = 1 / dense_solution(*state, n, 1, dense_of(*state, &k), unit)[20];
    k.band[4 * 20] -= 1.001 * margin;
    assert_status(either_band_solve(&e, &k, &m, lambda, phi), ROTID_ERROR_STIFFNESS);
    k.band[4 * 20] += 1.001 * margin;
    assert_status(either_band_solve(&e, &k, &m, lambda, phi), ROTID_OK); /* and a failure leaves the solver usable */
    assert_close(lambda[0], first, 1e-9, 0);
}

int main(int argc, char **argv)
{
    int failed = test_main(argc, argv); /* narrow bands */
    either_band_wide = 1;
    return failed + test_main(argc, argv);
}
