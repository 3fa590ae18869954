/* Building blocks for hosts: derivatives of eigenpairs, by closed forms, by their own equations, and beside differences. */
#include "dense.h"
#include "support.h"

static const int far[3] = {1, 9, 21};
static const int structures[][3] = {{24, 3, 0}, {24, 2, 3}, {24, 12, 0}, {24, 23, 0}, {3, 1, 0}};

struct pencil {
    rotid_matrix k, m, dk, dm;
};

static void open_pencil(struct pool *pool, struct random_stream *stream, size_t s, struct pencil *p)
{
    rotid_matrix *all[] = {&p->k, &p->m, &p->dk, &p->dm};
    for (int i = 0; i < 4; i++)
        random_positive(pool, stream, structures[s][0], structures[s][1], structures[s][2], far, i ? 1 : 0.1, all[i]);
}

static int derive(const struct pencil *p, int count, const double *lambda, const double *phi, int j, double *dlambda,
                  double *dphi)
{
    return rotid_eigenpair_derivative(&p->k, &p->m, &p->dk, &p->dm, count, lambda, phi, j, NULL, NULL, dlambda, dphi);
}

/* y := a + h b */
static void move(const rotid_matrix *a, double h, const rotid_matrix *b, rotid_matrix *y)
{
    for (int i = 0; i < a->n * (a->kd + 1); i++)
        y->band[i] = a->band[i] + h * b->band[i];
    for (int i = 0; i < a->nfar * a->nfar; i++)
        y->block[i] = a->block[i] + h * b->block[i];
}

/* (dK - dlambda M - lambda dM) phi + (K - lambda M) dphi = 0 and 2 phi'M dphi + phi'dM phi = 0 determine both. */
POOL_TEST(derivatives_satisfy_the_differentiated_equations)
{
    struct random_stream stream = {1};
    for (size_t s = 0; s < 5; s++) {
        struct pencil p;
        open_pencil(*state, &stream, s, &p);
        int n = p.k.n, count = n < 6 ? n : 6;
        double *lambda = numbers(*state, count), *phi = numbers(*state, n * count), *dphi = numbers(*state, n);
        const double *k = dense_of(*state, &p.k), *m = dense_of(*state, &p.m);
        const double *dk = dense_of(*state, &p.dk), *dm = dense_of(*state, &p.dm);
        assert_status(rotid_eigenpairs(&p.k, &p.m, count, NULL, NULL, lambda, phi), ROTID_OK);
        for (int j = 0; j < count; j++) {
            double dlambda, alone, constraint = 0, terms = 0, *vector = phi + (ptrdiff_t)j * n;
            assert_status(derive(&p, count, lambda, phi, j, &dlambda, dphi), ROTID_OK);
            assert_status(derive(&p, count, lambda, phi, j, &alone, NULL), ROTID_OK);
            assert_true(alone == dlambda);
            for (int i = 0; i < n; i++) {
                double sum = 0, size = 0;
                for (int q = 0; q < n; q++) {
                    double of_phi = dk[i + q * n] - dlambda * m[i + q * n] - lambda[j] * dm[i + q * n],
                           of_dphi = k[i + q * n] - lambda[j] * m[i + q * n];
                    sum += of_phi * vector[q] + of_dphi * dphi[q];
                    size += fabs(of_phi * vector[q]) + fabs(of_dphi * dphi[q]);
                    constraint += vector[i] * (2 * m[i + q * n] * dphi[q] + dm[i + q * n] * vector[q]);
                    terms += fabs(vector[i] * m[i + q * n] * dphi[q]) + fabs(vector[i] * dm[i + q * n] * vector[q]);
                }
                assert_close(sum, 0, 0, 1e-11 * size);
            }
            assert_close(constraint, 0, 0, 1e-12 * terms);
        }
    }
}

/* Pairs at K + h dK, M + h dM; differences of sixth order. */
POOL_TEST(derivatives_match_differences)
{
    static const double at[6] = {-3, -2, -1, 1, 2, 3}, weight[6] = {-1.0 / 60, 3.0 / 20, -0.75, 0.75, -3.0 / 20, 1.0 / 60};
    struct random_stream stream = {2};
    for (size_t s = 0; s < 5; s++) {
        struct pencil p, moved;
        open_pencil(*state, &stream, s, &p);
        open_pencil(*state, &stream, s, &moved);
        int n = p.k.n, count = n < 5 ? n : 5;
        double *lambda = numbers(*state, count), *phi = numbers(*state, n * count), *dphi = numbers(*state, n), h = 5e-6;
        double *other = numbers(*state, count), *vectors = numbers(*state, n * count);
        double *dlambdas = numbers(*state, count), *differences = numbers(*state, n * count);
        assert_status(rotid_eigenpairs(&p.k, &p.m, count, NULL, NULL, lambda, phi), ROTID_OK);
        for (int i = 0; i < 6; i++) {
            move(&p.k, at[i] * h, &p.dk, &moved.k);
            move(&p.m, at[i] * h, &p.dm, &moved.m);
            assert_status(rotid_eigenpairs(&moved.k, &moved.m, count, NULL, NULL, other, vectors), ROTID_OK);
            for (int j = 0; j < count; j++) {
                double dot = 0;
                for (int q = 0; q < n; q++)
                    dot += vectors[q + j * n] * phi[q + j * n];
                dlambdas[j] += weight[i] / h * other[j];
                for (int q = 0; q < n; q++)
                    differences[q + j * n] += weight[i] / h * (dot < 0 ? -1 : 1) * vectors[q + j * n];
            }
        }
        for (int j = 0; j < count; j++) {
            double dlambda;
            assert_status(derive(&p, count, lambda, phi, j, &dlambda, dphi), ROTID_OK);
            assert_close(dlambda, dlambdas[j], 1e-8, 1e-8 * lambda[count - 1]);
            assert_true(relative_difference((size_t)n, dphi, differences + (ptrdiff_t)j * n) < 1e-7);
        }
    }
}

/* K = x K0: dlambda = lambda/x, dphi = 0. M = x M0: dlambda = -lambda/x, dphi = -phi/(2 x). */
POOL_TEST(scaled_matrices_have_scaled_pairs)
{
    struct random_stream stream = {3};
    for (size_t s = 0; s < 5; s++) {
        struct pencil p;
        open_pencil(*state, &stream, s, &p);
        int n = p.k.n;
        double *lambda = numbers(*state, 3), *phi = numbers(*state, 3 * n), *dphi = numbers(*state, n), dlambda;
        assert_status(rotid_eigenpairs(&p.k, &p.m, 3, NULL, NULL, lambda, phi), ROTID_OK);
        for (int j = 0; j < 3; j++)
            for (int of_mass = 0; of_mass < 2; of_mass++) {
                double x = 2.5, zero[600] = {0}, largest = 0;
                rotid_matrix none = p.k, scaled = p.k;
                none.band = zero;
                none.block = zero;
                scaled.band = numbers(*state, n * (p.k.kd + 1));
                scaled.block = numbers(*state, 9);
                move(&none, 1 / x, of_mass ? &p.m : &p.k, &scaled);
                const struct pencil q = {p.k, p.m, of_mass ? none : scaled, of_mass ? scaled : none};
                assert_status(derive(&q, 3, lambda, phi, j, &dlambda, dphi), ROTID_OK);
                assert_close(dlambda, (of_mass ? -1 : 1) * lambda[j] / x, 1e-11, 0);
                for (int i = 0; i < n; i++)
                    largest = fmax(largest, fabs(phi[i + j * n]));
                for (int i = 0; i < n; i++)
                    assert_close(dphi[i], of_mass ? -phi[i + j * n] / (2 * x) : 0, 0, 1e-9 * largest);
            }
    }
}

/* Two chains of three masses, springs 2 - x and x: equal at x = 1. */
static void twins(double x, struct pencil *p)
{
    for (int i = 0; i < 6; i++) {
        double spring = i < 3 ? 2 - x : x, slope = i < 3 ? -1 : 1;
        int inner = i % 3 ? 1 : 0;
        assert_status(rotid_matrix_add(&p->m, i, i, 1, NULL), ROTID_OK);
        assert_status(rotid_matrix_add(&p->k, i, i, (1 + inner) * spring + (inner ? 0 : 1), NULL), ROTID_OK);
        assert_status(rotid_matrix_add(&p->dk, i, i, (1 + inner) * slope, NULL), ROTID_OK);
        if (i % 3 < 2) {
            assert_status(rotid_matrix_add(&p->k, i, i + 1, -spring, NULL), ROTID_OK);
            assert_status(rotid_matrix_add(&p->dk, i, i + 1, -slope, NULL), ROTID_OK);
        }
    }
}

POOL_TEST(vectors_of_neighbours_are_not_differentiated)
{
    static const double at[] = {1, 1 + 1e-9, 1.3};
    for (int a = 0; a < 3; a++)
        for (int dense = 0; dense < 2; dense++) {
            struct pencil p;
            rotid_matrix *all[] = {&p.k, &p.m, &p.dk, &p.dm};
            for (int i = 0; i < 4; i++)
                *all[i] = (rotid_matrix){.n = 6, .kd = dense ? 5 : 1, .band = numbers(*state, 36)};
            twins(at[a], &p);
            for (int count = 1; count <= 6; count++) /* the partner may lie just beyond what the caller has */
                for (int j = 0; j < count; j++) {
                    double lambda[6], phi[36], dphi[6], dlambda = NAN;
                    assert_status(rotid_eigenpairs(&p.k, &p.m, count, NULL, NULL, lambda, phi), ROTID_OK);
                    int status = derive(&p, count, lambda, phi, j, &dlambda, dphi);
                    assert_string_equal(rotid_status_name(status), a < 2 ? "ROTID_ERROR_CLOSE" : "ROTID_OK");
                    assert_true(isnan(dlambda) == (a < 2));
                    assert_status(derive(&p, count, lambda, phi, j, &dlambda, NULL), ROTID_OK); /* the value has a slope */
                    assert_true(isfinite(dlambda));
                }
        }
}

/* Translation and rotation of a free beam are equal but for rounding, however far apart that puts them. */
POOL_TEST(rigid_modes_are_neighbours)
{
    enum { elements = 20, n = 2 * (elements + 1) };
    struct pencil p;
    rotid_matrix *all[] = {&p.k, &p.m, &p.dk, &p.dm};
    double ke[16], me[16], l = 1.0 / elements, lambda[5], *phi = numbers(*state, 5 * n), *dphi = numbers(*state, n), dlambda;
    for (int i = 0; i < 4; i++)
        *all[i] = (rotid_matrix){.n = n, .kd = 3, .band = numbers(*state, 4 * n)};
    rotid_element_stiffness(100, 1e6, l, ke);
    rotid_element_mass(7, 1e-3, 12 * 100 / (1e6 * l * l), l, me);
    for (int e = 0; e < elements; e++) {
        const int dof[4] = {2 * e, 2 * e + 1, 2 * e + 2, 2 * e + 3};
        assert_status(rotid_matrix_add_element(&p.k, 4, dof, ke, NULL), ROTID_OK);
        assert_status(rotid_matrix_add_element(&p.m, 4, dof, me, NULL), ROTID_OK);
        if (e < elements / 2)
            assert_status(rotid_matrix_add_element(&p.dm, 4, dof, me, NULL), ROTID_OK);
    }
    for (int count = 1; count <= 5; count++) {
        assert_status(rotid_eigenpairs(&p.k, &p.m, count, NULL, NULL, lambda, phi), ROTID_OK);
        for (int j = 0; j < count; j++) {
            int status = derive(&p, count, lambda, phi, j, &dlambda, dphi);
            assert_string_equal(rotid_status_name(status), j < 2 ? "ROTID_ERROR_CLOSE" : "ROTID_OK");
        }
    }
}

POOL_TEST(arguments_out_of_range_are_refused)
{
    struct random_stream stream = {4};
    struct pencil p, other;
    double lambda[3], phi[72], dphi[24], dlambda;
    open_pencil(*state, &stream, 0, &p);
    open_pencil(*state, &stream, 2, &other);
    assert_status(rotid_eigenpairs(&p.k, &p.m, 3, NULL, NULL, lambda, phi), ROTID_OK);
    for (int w = 0; w < 8; w++) {
        const rotid_matrix *a[4] = {&p.k, &p.m, &p.dk, &p.dm};
        a[w % 4] = w < 4 ? NULL : &other.k;
        assert_status(rotid_eigenpair_derivative(a[0], a[1], a[2], a[3], 3, lambda, phi, 0, NULL, NULL, &dlambda, dphi),
                      ROTID_ERROR_ARGUMENT);
    }
    assert_status(derive(&p, 0, lambda, phi, 0, &dlambda, dphi), ROTID_ERROR_ARGUMENT);
    assert_status(derive(&p, 25, lambda, phi, 0, &dlambda, dphi), ROTID_ERROR_ARGUMENT);
    assert_status(derive(&p, 3, lambda, phi, -1, &dlambda, dphi), ROTID_ERROR_ARGUMENT);
    assert_status(derive(&p, 3, lambda, phi, 3, &dlambda, dphi), ROTID_ERROR_ARGUMENT);
    assert_status(derive(&p, 3, NULL, phi, 0, &dlambda, dphi), ROTID_ERROR_ARGUMENT);
    assert_status(derive(&p, 3, lambda, NULL, 0, &dlambda, dphi), ROTID_ERROR_ARGUMENT);
    assert_status(derive(&p, 3, lambda, phi, 0, NULL, dphi), ROTID_ERROR_ARGUMENT);
    double backwards[3] = {lambda[1], lambda[0], lambda[2]}, unknown[3] = {lambda[0], NAN, lambda[2]}, kept = phi[30];
    assert_status(derive(&p, 3, backwards, phi, 0, &dlambda, dphi), ROTID_ERROR_ARGUMENT);
    assert_status(derive(&p, 3, unknown, phi, 0, &dlambda, dphi), ROTID_ERROR_FINITE);
    phi[30] = INFINITY; /* of vector 1 */
    assert_status(derive(&p, 3, lambda, phi, 1, &dlambda, dphi), ROTID_ERROR_FINITE);
    assert_status(derive(&p, 3, lambda, phi, 0, &dlambda, dphi), ROTID_OK);
    phi[30] = kept;
    for (int i = 24; i < 48; i++)
        phi[i] *= 2; /* phi' M phi = 4 */
    assert_status(derive(&p, 3, lambda, phi, 1, &dlambda, dphi), ROTID_ERROR_ARGUMENT);
    p.dk.band[5] = NAN;
    assert_status(derive(&p, 3, lambda, phi, 0, &dlambda, dphi), ROTID_ERROR_FINITE);
}

POOL_TEST(memory_that_runs_out_is_an_error_and_none_is_kept)
{
    struct random_stream stream = {5};
    struct pencil p;
    double lambda[3], phi[72], dphi[24], dlambda;
    open_pencil(*state, &stream, 1, &p);
    assert_status(rotid_eigenpairs(&p.k, &p.m, 3, NULL, NULL, lambda, phi), ROTID_OK);
    for (int j = 0; j < 3; j += 2) /* the last one looks for a neighbour above it as well */
        for (long fail = 1;; fail++) {
            struct failing_allocator failing;
            failing_allocator_open(&failing, fail);
            rotid_environment environment = {.size = sizeof environment, .allocator = &failing.allocator};
            int status =
                rotid_eigenpair_derivative(&p.k, &p.m, &p.dk, &p.dm, 3, lambda, phi, j, &environment, NULL, &dlambda, dphi);
            assert_int_equal(failing.in_use, 0);
            if (status == ROTID_OK) {
                assert_true(fail > 10);
                break;
            }
            assert_status(status, ROTID_ERROR_MEMORY);
        }
}
