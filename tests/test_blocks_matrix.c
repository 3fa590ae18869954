/* Building blocks for hosts: entries of matrices, the dense matrices they stand for, products. */
#include "dense.h"
#include "support.h"

static const int far[3] = {1, 7, 10};

/* A matrix of n = 12, kd = 2 with a block on 1, 7, 10; zero. */
static rotid_matrix bordered(struct pool *pool)
{
    return (rotid_matrix){.n = 12, .kd = 2, .nfar = 3, .far = far, .band = numbers(pool, 36), .block = numbers(pool, 9)};
}

POOL_TEST(entries_go_where_the_structure_has_a_place)
{
    rotid_matrix a = bordered(*state);
    double *full = numbers(*state, 144);
    for (int i = 0; i < 12; i++)
        for (int j = 0; j < 12; j++) {
            int among_far = (i == 1 || i == 7 || i == 10) && (j == 1 || j == 7 || j == 10), place = abs(i - j) <= 2 || among_far;
            double value = 1 + i * j;
            rotid_matrix before = bordered(*state);
            memcpy(before.band, a.band, 36 * sizeof(double));
            memcpy(before.block, a.block, 9 * sizeof(double));
            int status = rotid_matrix_add(&a, i, j, value, NULL);
            assert_string_equal(rotid_status_name(status), place ? "ROTID_OK" : "ROTID_ERROR_ARGUMENT");
            full[i + j * 12] += place ? value : 0;
            full[j + i * 12] += place && i != j ? value : 0;
            if (!place) {
                assert_memory_equal(before.band, a.band, 36 * sizeof(double));
                assert_memory_equal(before.block, a.block, 9 * sizeof(double));
            }
        }
    double *got = numbers(*state, 144);
    assert_status(rotid_matrix_get_dense(&a, got, 12, NULL), ROTID_OK);
    assert_memory_equal(got, full, 144 * sizeof *got);
    assert_memory_equal(got, dense_of(*state, &a), 144 * sizeof *got);
}

POOL_TEST(elements_add_what_their_definition_says)
{
    struct random_stream stream = {1};
    static const int places[][4] = {{3, 4, 5, 3}, {0, 1, 2, -1}, {1, 10, 7, -5}, {11, -1, 10, 9}, {4, 4, 4, 4}};
    for (int c = 0; c < 5; c++) {
        rotid_matrix a = bordered(*state);
        double *full = numbers(*state, 144), *got = numbers(*state, 144), e[16];
        const int *dof = places[c];
        for (int j = 0; j < 4; j++)
            for (int i = j; i < 4; i++)
                e[i + 4 * j] = e[j + 4 * i] = random_normal(&stream);
        for (int j = 0; j < 4; j++) /* sum of P e P' with the rows of P that are held left out */
            for (int i = 0; i < 4; i++)
                if (dof[i] >= 0 && dof[j] >= 0)
                    full[dof[i] + 12 * dof[j]] += e[i + 4 * j];
        for (int j = 0; j < 4; j++) /* the lower triangle is all that may be read */
            for (int i = 0; i < j; i++)
                e[i + 4 * j] = NAN;
        assert_status(rotid_matrix_add_element(&a, 4, dof, e, NULL), ROTID_OK);
        assert_status(rotid_matrix_get_dense(&a, got, 12, NULL), ROTID_OK);
        for (int i = 0; i < 144; i++)
            assert_close(got[i], full[i], 1e-15, 1e-15);
    }
}

POOL_TEST(an_element_without_a_place_changes_nothing)
{
    static const int places[][3] = {{0, 1, 3}, {1, 10, 5}, {0, 12, 1}, {11, 10, 100}};
    const double e[9] = {1, 2, 3, 2, 4, 5, 3, 5, 6};
    for (int c = 0; c < 4; c++) {
        rotid_matrix a = bordered(*state), zero = bordered(*state);
        assert_status(rotid_matrix_add_element(&a, 3, places[c], e, NULL), ROTID_ERROR_ARGUMENT);
        assert_memory_equal(a.band, zero.band, 36 * sizeof(double));
        assert_memory_equal(a.block, zero.block, 9 * sizeof(double));
    }
}

POOL_TEST(dense_matrices_go_in_and_out)
{
    struct random_stream stream = {2};
    for (int c = 0; c < 4; c++) { /* diagonal, band, band with block, dense */
        int n = 12, kd = c == 3 ? 11 : c ? 2 : 0, nfar = c == 2 ? 3 : 0, ld = n + c;
        rotid_matrix a, b;
        random_positive(*state, &stream, n, kd, nfar, far, 1, &a);
        random_positive(*state, &stream, n, kd, nfar, far, 1, &b); /* is overwritten */
        double *full = numbers(*state, ld * n), *got = numbers(*state, ld * n);
        for (int i = 0; i < ld * n; i++)
            full[i] = got[i] = NAN;
        const double *definition = dense_of(*state, &a);
        for (int j = 0; j < n; j++)
            for (int i = j; i < n; i++)
                full[i + j * ld] = definition[i + j * n];
        assert_status(rotid_matrix_set_dense(&b, full, ld, NULL), ROTID_OK);
        assert_status(rotid_matrix_get_dense(&b, got, ld, NULL), ROTID_OK);
        for (int j = 0; j < n; j++)
            for (int i = 0; i < ld; i++)
                assert_true(i < n ? got[i + j * ld] == definition[i + j * n] : isnan(got[i + j * ld]));
        if (c == 3)
            continue;
        rotid_matrix kept = b;
        kept.band = numbers(*state, n * (kd + 1));
        memcpy(kept.band, b.band, (size_t)(n * (kd + 1)) * sizeof(double));
        full[n - 1] = 1e-300; /* A(n - 1, 0) has no place */
        assert_status(rotid_matrix_set_dense(&b, full, ld, NULL), ROTID_ERROR_ARGUMENT);
        full[n - 1] = NAN;
        assert_status(rotid_matrix_set_dense(&b, full, ld, NULL), ROTID_ERROR_ARGUMENT);
        assert_memory_equal(kept.band, b.band, (size_t)(n * (kd + 1)) * sizeof(double));
    }
}

POOL_TEST(products_are_those_of_the_dense_matrix)
{
    struct random_stream stream = {3};
    static const int sizes[][3] = {{1, 0, 0},   {2, 1, 0},   {12, 2, 3},  {12, 3, 0},
                                   {40, 19, 3}, {40, 20, 3}, {40, 39, 0}, {90, 60, 0}};
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        int n = sizes[s][0], columns = 5;
        rotid_matrix a;
        random_positive(*state, &stream, n, sizes[s][1], sizes[s][2], far, 1, &a);
        const double *x = random_numbers(*state, &stream, n * columns);
        double *y = numbers(*state, n * columns), *full = dense_of(*state, &a);
        /* the storage of the band beyond the matrix holds anything */
        for (int j = 0; j < n; j++)
            for (int d = n - j; d <= a.kd; d++)
                a.band[d + j * (a.kd + 1)] = NAN;
        assert_status(rotid_matrix_multiply(&a, columns, x, y, NULL), ROTID_OK);
        assert_true(relative_difference((size_t)(n * columns), y, dense_product(*state, n, n, columns, full, x)) < 1e-14);
    }
}

POOL_TEST(what_is_no_matrix_is_refused)
{
    static const int backwards[3] = {7, 1, 10}, twice[3] = {1, 1, 10}, beyond[3] = {1, 7, 12}, below[3] = {-1, 7, 10};
    const int dof[2] = {0, 1};
    const double e[4] = {1, 1, 1, 1};
    double *full = numbers(*state, 144), *other = numbers(*state, 144);
    for (int c = -1; c < 13; c++) {
        rotid_matrix a = bordered(*state), *which = &a;
        switch (c) {
        case 0:
            which = NULL;
            break;
        case 1:
            a.n = 0;
            break;
        case 2:
            a.n = -3;
            break;
        case 3:
            a.kd = -1;
            break;
        case 4:
            a.kd = 12;
            break;
        case 5:
            a.nfar = -1;
            break;
        case 6:
            a.far = NULL;
            break;
        case 7:
            a.band = NULL;
            break;
        case 8:
            a.block = NULL;
            break;
        case 9:
            a.far = backwards;
            break;
        case 10:
            a.far = twice;
            break;
        case 11:
            a.far = beyond;
            break;
        case 12:
            a.far = below;
            break;
        default:
            break;
        }
        const char *expected = c < 0 ? "ROTID_OK" : "ROTID_ERROR_ARGUMENT";
        assert_string_equal(rotid_status_name(rotid_matrix_add(which, 1, 1, 1, NULL)), expected);
        assert_string_equal(rotid_status_name(rotid_matrix_add_element(which, 2, dof, e, NULL)), expected);
        assert_string_equal(rotid_status_name(rotid_matrix_set_dense(which, full, 12, NULL)), expected);
        assert_string_equal(rotid_status_name(rotid_matrix_get_dense(which, full, 12, NULL)), expected);
        assert_string_equal(rotid_status_name(rotid_matrix_multiply(which, 1, full, other, NULL)), expected);
    }
    rotid_matrix a = bordered(*state);
    assert_status(rotid_matrix_add(&a, -1, 0, 1, NULL), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_matrix_add(&a, 0, -1, 1, NULL), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_matrix_add(&a, 12, 12, 1, NULL), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_matrix_add_element(&a, 0, dof, e, NULL), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_matrix_add_element(&a, 2, NULL, e, NULL), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_matrix_add_element(&a, 2, dof, NULL, NULL), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_matrix_set_dense(&a, NULL, 12, NULL), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_matrix_set_dense(&a, full, 11, NULL), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_matrix_get_dense(&a, NULL, 12, NULL), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_matrix_get_dense(&a, full, 11, NULL), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_matrix_multiply(&a, 0, full, other, NULL), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_matrix_multiply(&a, 1, NULL, other, NULL), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_matrix_multiply(&a, 1, full, NULL, NULL), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_matrix_multiply(&a, 1, full, full, NULL), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_matrix_multiply(&a, 2, full, full + 23, NULL), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_matrix_multiply(&a, 2, full, full + 24, NULL), ROTID_OK);
}
