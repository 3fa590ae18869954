/* rotid_check_jacobian: right Jacobians pass, wrong ones are found at their column, and what cannot be told is said. */
#include "more_garbow_hillstrom.h"
#include "support.h"

#define M 12

static double work[60000], error[MGH_MOST_PARAMETERS], doubt[MGH_MOST_PARAMETERS];

/* A decay and a wave, in variables of any size: x_j = unit_j (1 + small). Spoilt on demand. */
enum spoil { RIGHT, WRONG_SIGN, WRONG_ENTRY, TRANSPOSED };

struct model {
    double unit[3];
    enum spoil spoil;
    int column;
    double noise;  /* of every residual */
    double edge;   /* no residual where x1/unit > edge */
    int nan_tells; /* that by a NaN, else by the status */
    int calls, jacobians;
    double last[3]; /* where the residual was asked for last */
    int misplaced;  /* Jacobians asked for elsewhere */
};

static double noise_of(int i, const double *x)
{
    uint64_t z = (uint64_t)i, bits;
    for (int j = 0; j < 3; j++) {
        memcpy(&bits, &x[j], sizeof bits);
        z = (z ^ bits) * 0x9E3779B97F4A7C15u;
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
        z ^= z >> 31;
    }
    return (double)(z >> 11) * 0x1p-52 - 1;
}

static int three(void *user, int m, int n, const double *x, double *r, double *jacobian)
{
    struct model *model = user;
    double u[3] = {x[0] / model->unit[0], x[1] / model->unit[1], x[2] / model->unit[2]};
    model->calls += r != NULL;
    model->jacobians += jacobian != NULL;
    if (r)
        memcpy(model->last, x, sizeof model->last);
    else
        model->misplaced += memcmp(model->last, x, sizeof model->last) != 0;
    if (model->edge > 0 && u[0] > model->edge) {
        if (!model->nan_tells)
            return 3;
        for (int i = 0; r && i < m; i++)
            r[i] = NAN;
        return 0;
    }
    for (int i = 0; i < m; i++) {
        double t = 0.25 * i, e = exp(-u[1] * t);
        if (r)
            r[i] = u[0] * e + sin(u[2] * t) - 1 + model->noise * noise_of(i, x);
        else {
            jacobian[i] = e / model->unit[0];
            jacobian[i + m] = -t * u[0] * e / model->unit[1];
            jacobian[i + 2 * m] = t * cos(u[2] * t) / model->unit[2];
        }
    }
    if (r)
        return 0;
    double *column = jacobian + model->column * m, swapped[3 * M];
    for (int i = 0; model->spoil == WRONG_SIGN && i < m; i++)
        column[i] = -column[i];
    if (model->spoil == WRONG_ENTRY)
        column[m / 2] *= 1.001;
    memcpy(swapped, jacobian, sizeof swapped);
    for (int i = 0; model->spoil == TRANSPOSED && i < m; i++)
        for (int j = 0; j < n; j++)
            jacobian[j + i * n] = swapped[i + j * m];
    return 0;
}

static const double at[3] = {1.3, 0.7, 2.1};

static int check(struct model *model, const double *scale)
{
    double x[3], kept[3];
    for (int j = 0; j < 3; j++)
        kept[j] = x[j] = model->unit[j] * at[j];
    assert_true(rotid_check_jacobian_workspace(M, 3) <= sizeof work / sizeof *work);
    int status = rotid_check_jacobian(M, 3, three, model, x, scale, NULL, error, doubt, work);
    assert_memory_equal(x, kept, sizeof x);
    assert_int_equal(model->misplaced, 0);
    return status;
}

UNIT_TEST(right_jacobians_pass)
{
    struct model model = {.unit = {1, 1, 1}};
    assert_status(check(&model, NULL), ROTID_OK);
    for (int j = 0; j < 3; j++) {
        assert_true(error[j] < 1e-10 && doubt[j] < 1e-9);
        assert_true(error[j] <= fmax(doubt[j], 1e-12)); /* the doubt covers what the differences are wrong by */
    }
    assert_int_equal(model.jacobians, 1);
    assert_true(model.calls <= 1 + 2 * 16 * 3);
}

UNIT_TEST(right_jacobians_of_all_kinds_pass)
{
    for (int k = 0; k < mgh_count; k++) {
        const struct mgh_problem *problem = &mgh_problems[k];
        double x[MGH_MOST_PARAMETERS];
        mgh_start(problem, 1, x);
        for (int j = 0; j < problem->n; j++)
            x[j] = 1.1 * x[j] + 0.01;
        assert_true(rotid_check_jacobian_workspace(problem->m, problem->n) <= sizeof work / sizeof *work);
        assert_status(rotid_check_jacobian(problem->m, problem->n, problem->residual, NULL, x, NULL, NULL, error, doubt, work),
                      ROTID_OK);
        for (int j = 0; j < problem->n; j++) {
            if (!(error[j] < 1e-9))
                print_error("%s, column %d: error %.1e, doubt %.1e\n", problem->name, j, error[j], doubt[j]);
            assert_true(error[j] < 1e-9 && doubt[j] < 1e-8);
        }
    }
}

UNIT_TEST(a_wrong_sign_or_entry_is_found_at_its_column)
{
    for (int column = 0; column < 3; column++)
        for (enum spoil spoil = WRONG_SIGN; spoil <= WRONG_ENTRY; spoil++) {
            struct model model = {.unit = {1, 1, 1}, .spoil = spoil, .column = column};
            assert_status(check(&model, NULL), ROTID_OK);
            for (int j = 0; j < 3; j++)
                assert_true((error[j] > 1e-7 && error[j] > 100 * doubt[j]) == (j == column));
            if (spoil == WRONG_SIGN)
                assert_close(error[column], 2, 1e-9, 0);
        }
}

UNIT_TEST(a_transposed_jacobian_is_found)
{
    struct model model = {.unit = {1, 1, 1}, .spoil = TRANSPOSED};
    assert_status(check(&model, NULL), ROTID_OK);
    for (int j = 0; j < 3; j++)
        assert_true(error[j] > 0.1 && doubt[j] < 1e-8);
}

/* Young's modulus beside a clearance: 1e11 and 1e-6. */
UNIT_TEST(the_size_of_the_variables_does_not_matter)
{
    struct model model = {.unit = {1e11, 1e-6, 1}};
    double scale[3] = {1e10, 3e-7, 1};
    for (int given = 0; given < 2; given++) {
        if (!given)
            model.unit[1] = 1e-2; /* without a scale, 1e-3 is the least step that is natural */
        assert_status(check(&model, given ? scale : NULL), ROTID_OK);
        for (int j = 0; j < 3; j++)
            assert_true(error[j] < 1e-9 && doubt[j] < 1e-8);
        model.unit[1] = 1e-6;
    }
    model.spoil = WRONG_ENTRY;
    model.column = 1;
    assert_status(check(&model, scale), ROTID_OK);
    assert_true(error[0] < 1e-9 && error[1] > 1e-5 && error[2] < 1e-9);
}

/* Without noise the doubt is small; with it, it covers what the noise does to the differences, whatever its size. */
UNIT_TEST(noise_shows_up_as_doubt)
{
    double before = 0;
    for (double noise = 1e-12; noise < 1e-3; noise *= 10) {
        struct model model = {.unit = {1, 1, 1}, .noise = noise};
        assert_status(check(&model, NULL), ROTID_OK);
        double most = 0;
        for (int j = 0; j < 3; j++) {
            assert_true(error[j] < 30 * doubt[j]);
            assert_true(error[j] < 1e3 * noise); /* the best of the steps, not the shortest */
            most = fmax(most, doubt[j]);
        }
        assert_true(most > 0.03 * noise && most > before / 10);
        before = most;
    }
}

UNIT_TEST(steps_across_an_edge_are_left_out)
{
    for (int nan_tells = 0; nan_tells < 2; nan_tells++) {
        /* an edge just beyond x: only the shorter steps have a residual on both sides */
        struct model model = {.unit = {1, 1, 1}, .edge = at[0] * 1.001, .nan_tells = nan_tells};
        assert_status(check(&model, NULL), ROTID_OK);
        assert_true(error[0] < 1e-8 && doubt[0] < 1e-7);
        /* on the edge: none has */
        model = (struct model){.unit = {1, 1, 1}, .edge = at[0], .nan_tells = nan_tells};
        assert_status(check(&model, NULL), ROTID_OK);
        assert_true(isnan(error[0]) && isnan(doubt[0]));
        for (int j = 1; j < 3; j++)
            assert_true(error[j] < 1e-9 && doubt[j] < 1e-8);
        /* beyond: there is nothing to check */
        model = (struct model){.unit = {1, 1, 1}, .edge = at[0] * 0.999, .nan_tells = nan_tells};
        assert_string_equal(rotid_status_name(check(&model, NULL)), nan_tells ? "ROTID_ERROR_FINITE" : "ROTID_ERROR_CALLBACK");
    }
}

/* r = (x1^2, 5): the second variable does nothing, and says so */
static int idle(void *user, int m, int n, const double *x, double *r, double *jacobian)
{
    (void)m, (void)n;
    if (r) {
        r[0] = x[0] * x[0];
        r[1] = 5;
        return 0;
    }
    jacobian[0] = 2 * x[0];
    jacobian[1] = jacobian[2] = 0;
    jacobian[3] = user ? 1e-30 : 0; /* or claims to */
    return 0;
}

UNIT_TEST(columns_of_zeros_are_right_where_nothing_happens)
{
    double x[2] = {3, 1};
    int claims = 1;
    assert_status(rotid_check_jacobian(2, 2, idle, NULL, x, NULL, NULL, error, doubt, work), ROTID_OK);
    assert_true(error[0] < 1e-12 && error[1] == 0 && doubt[1] == 0);
    assert_status(rotid_check_jacobian(2, 2, idle, &claims, x, NULL, NULL, error, doubt, work), ROTID_OK);
    assert_true(error[1] == 1 && doubt[1] == 0);
    x[0] = 0; /* its derivative vanishes there, and at 0 the scale is 1e-3 */
    assert_status(rotid_check_jacobian(2, 2, idle, NULL, x, NULL, NULL, error, doubt, work), ROTID_OK);
    assert_true(error[0] == 0 && error[1] == 0);
}

static int refused(void *user, int m, int n, const double *x, double *r, double *jacobian)
{
    (void)m, (void)n, (void)x;
    *(r ? r : jacobian) = r ? 1 : *(double *)user;
    return jacobian && *(double *)user == 0;
}

UNIT_TEST(arguments_out_of_range_are_refused_before_anything_is_called)
{
    struct model model = {.unit = {1, 1, 1}};
    double x[3] = {1, 1, 1}, bad[3] = {1, NAN, 1}, scale[3] = {1, 0, 1}, one = 1, value;
    assert_status(rotid_check_jacobian(0, 3, three, &model, x, NULL, NULL, error, doubt, work), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_check_jacobian(M, 0, three, &model, x, NULL, NULL, error, doubt, work), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_check_jacobian(M, 3, NULL, &model, x, NULL, NULL, error, doubt, work), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_check_jacobian(M, 3, three, &model, NULL, NULL, NULL, error, doubt, work), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_check_jacobian(M, 3, three, &model, x, NULL, NULL, NULL, doubt, work), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_check_jacobian(M, 3, three, &model, x, NULL, NULL, error, NULL, work), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_check_jacobian(M, 3, three, &model, x, NULL, NULL, error, doubt, NULL), ROTID_ERROR_ARGUMENT);
    assert_status(rotid_check_jacobian(M, 3, three, &model, bad, NULL, NULL, error, doubt, work), ROTID_ERROR_ARGUMENT);
    for (int k = 0; k < 4; k++) {
        scale[1] = (double[]){0, -1, NAN, INFINITY}[k];
        assert_status(rotid_check_jacobian(M, 3, three, &model, x, scale, NULL, error, doubt, work), ROTID_ERROR_ARGUMENT);
    }
    assert_int_equal(model.calls + model.jacobians, 0);
    value = 0;
    assert_status(rotid_check_jacobian(1, 1, refused, &value, &one, NULL, NULL, error, doubt, work), ROTID_ERROR_CALLBACK);
    value = NAN;
    assert_status(rotid_check_jacobian(1, 1, refused, &value, &one, NULL, NULL, error, doubt, work), ROTID_ERROR_FINITE);
}
