/* A solid in a basis V: V'K V and V'M V without K and M. The field of a share, eight numbers in which K and M are linear, is the
 * same over most of a group: shares whose field and its rates are equal where the basis is made are a class, whose part of V'K V
 * is kept for a unit of each number. What differs from its class elsewhere, as where a zone has moved on, is added element by
 * element: V'K V is that of the mesh at all values. */
#include "linalg/linalg.h"
#include "solid/solid.h"

enum {
    NUMBERS = sizeof(struct share) / sizeof(double), /* c11 c12 c13 c33 c44 c66, rho, stress */
    RHO = 6,
    CLASS_MOST = 48 /* shares of further ones are added element by element at all values */
};

/* k += V'E_k V and m += V'E_m V [count * count] of an element with this field */
static void add_element(const struct solid_basis *basis, int e, const struct share *field, double *k, double *m)
{
    const struct solid *solid = basis->solid;
    double part[2][SOLID_DOFS * SOLID_DOFS], *local = basis->work, *sum[2] = {k, m};
    int has[2], dof[SOLID_DOFS], count = basis->count;
    solid_element_matrices(solid, e, field, part[0], part[1], &has[0], &has[1]);
    for (int i = 0; i < 2; i++) {
        if (!has[i])
            continue;
        solid_tie_element(solid, &solid->mesh.element[e], part[i], dof);
        for (int j = 0; j < count; j++)
            for (int d = 0; d < SOLID_DOFS; d++)
                local[d + SOLID_DOFS * j] = dof[d] < 0 ? 0 : basis->v[dof[d] + (ptrdiff_t)j * solid->mesh.ndof];
        product_congruence(SOLID_DOFS, count, part[i], local, local + (ptrdiff_t)SOLID_DOFS * count, sum[i]);
    }
}

/* The class of every share by its field and rates, probe [1 + nparameter]: -1 beyond CLASS_MOST. */
static int classify(struct pool *pool, struct solid_basis *basis)
{
    const struct solid *solid = basis->solid;
    size_t probes = 1 + (size_t)solid->nparameter;
    struct share *now = POOL_ARRAY(pool, struct share, probes * SHARES),
                 *known = POOL_ARRAY(pool, struct share, probes * CLASS_MOST);
    struct share *probe = POOL_ARRAY(pool, struct share, probes);
    if (!now || !known || !probe)
        return ROTID_ERROR_MEMORY;
    for (int e = 0; e < solid->mesh.nelement; e++) {
        for (size_t p = 0; p < probes; p++)
            solid_fields_of(solid, e, (int)p - 1, now + p * SHARES);
        for (int s = 0; s < SHARES; s++) {
            int c = 0, moves = 0;
            for (size_t p = 0; p < probes; p++) {
                probe[p] = now[p * SHARES + (size_t)s];
                for (int i = 0; i < NUMBERS && p; i++)
                    moves |= ((const double *)&probe[p])[i] != 0;
            }
            while (c < basis->nclass && memcmp(known + (size_t)c * probes, probe, probes * sizeof *probe) != 0)
                c++;
            if (c == basis->nclass && c < CLASS_MOST) {
                memcpy(known + (size_t)c * probes, probe, probes * sizeof *probe);
                basis->class[basis->nclass++] = (struct solid_class){.element = e, .share = s, .moves = moves, .now = *probe};
            }
            basis->class_of[e * SHARES + s] = c < basis->nclass ? c : -1;
        }
    }
    return ROTID_OK;
}

/* The parts of the classes of an element: of the numbers of one that moves, else of K and M as they are. */
static void add_to_classes(struct solid_basis *basis, int e)
{
    const int *of = &basis->class_of[(ptrdiff_t)e * SHARES];
    ptrdiff_t square = (ptrdiff_t)basis->count * basis->count;
    for (int c = 0; c < basis->nclass; c++) {
        const struct solid_class *class = &basis->class[c];
        struct share field[SHARES] = {{.rho = 0}};
        for (int i = 0; i < (class->moves ? NUMBERS : 1); i++) {
            double unit[NUMBERS] = {0};
            int any = 0;
            unit[i] = 1;
            for (int s = 0; s < SHARES; s++)
                if (of[s] == c) {
                    field[s] = class->now;
                    if (class->moves)
                        memcpy(&field[s], unit, sizeof unit);
                    any = 1;
                }
            if (any && class->moves)
                add_element(basis, e, field, class->part + (ptrdiff_t)i * square, class->part + (ptrdiff_t)i * square);
            else if (any)
                add_element(basis, e, field, class->part, class->part + square);
        }
    }
}

int solid_basis_new(struct pool *pool, struct solid *solid, int count, const double *v, struct solid_basis *basis)
{
    size_t square = (size_t)count * (size_t)count;
    *basis = (struct solid_basis){.solid = solid, .count = count, .v = v};
    basis->class = POOL_ARRAY(pool, struct solid_class, CLASS_MOST);
    basis->class_of = POOL_ARRAY(pool, int, (size_t)solid->mesh.nelement *SHARES);
    basis->work = POOL_ARRAY(pool, double, (size_t)(2 * SOLID_DOFS) * (size_t)count);
    basis->sum = POOL_ARRAY(pool, double, 2 * square);
    if (!basis->class || !basis->class_of || !basis->work || !basis->sum)
        return ROTID_ERROR_MEMORY;
    int status = classify(pool, basis);
    for (int c = 0; c < basis->nclass && !status; c++) {
        basis->class[c].part = POOL_ARRAY(pool, double, (basis->class[c].moves ? NUMBERS : 2) * square);
        status = basis->class[c].part ? ROTID_OK : ROTID_ERROR_MEMORY;
    }
    for (int e = 0; e < solid->mesh.nelement && !status; e++)
        add_to_classes(basis, e);
    return status;
}

/* sum [2 * count * count] := what the classes make of K and M, or of their derivatives, with `now` of each */
static void sum_of_classes(struct solid_basis *basis, int p)
{
    const struct solid *solid = basis->solid;
    int square = basis->count * basis->count;
    memset(basis->sum, 0, 2 * (size_t)square * sizeof *basis->sum);
    for (int c = 0; c < basis->nclass; c++) {
        struct solid_class *class = &basis->class[c];
        const struct solid_element *element = &solid->mesh.element[class->element];
        double number[NUMBERS];
        if (!class->moves) {
            for (int i = 0; i < 2 * square && p < 0; i++)
                basis->sum[i] += class->part[i];
            continue;
        }
        if (p < 0)
            solid_field_of_share(solid, element, class->share, &class->now);
        else
            (void)solid_field_rate(solid, element, class->share, solid->parameter[p], &class->now);
        memcpy(number, &class->now, sizeof number);
        for (int i = 0; i < NUMBERS; i++) {
            const double *part = class->part + (ptrdiff_t)i * square;
            double *sum = basis->sum + (i == RHO ? square : 0);
            for (int j = 0; j < square && number[i] != 0; j++)
                sum[j] += number[i] * part[j];
        }
    }
}

/* Adds what shares have beside their class: returns nonzero where there is anything in `rest`. */
static int beside_class(const struct solid_basis *basis, int e, int p, const struct share *field, struct share *rest)
{
    int any = 0;
    for (int s = 0; s < SHARES; s++) {
        int c = basis->class_of[e * SHARES + s];
        double number[NUMBERS], of_class[NUMBERS] = {0};
        memcpy(number, &field[s], sizeof number);
        if (c >= 0 && (p < 0 || basis->class[c].moves))
            memcpy(of_class, &basis->class[c].now, sizeof of_class);
        for (int i = 0; i < NUMBERS; i++) {
            number[i] -= of_class[i];
            any |= number[i] != 0;
        }
        memcpy(&rest[s], number, sizeof number);
    }
    return any;
}

static void assemble(struct solid_basis *basis, int p, rotid_matrix *k, rotid_matrix *m)
{
    const struct solid *solid = basis->solid;
    int count = basis->count;
    rotid_matrix *a[2] = {k, m};
    struct share field[SHARES], rest[SHARES];
    struct target target[2];
    sum_of_classes(basis, p);
    for (int e = 0; e < solid->mesh.nelement; e++) {
        solid_fields_of(solid, e, p, field);
        if (beside_class(basis, e, p, field, rest))
            add_element(basis, e, rest, basis->sum, basis->sum + (ptrdiff_t)count * count);
    }
    for (int i = 0; i < 2; i++) {
        const double *sum = basis->sum + (ptrdiff_t)i * count * count;
        for (int c = 0; c < count; c++)
            for (int r = c; r < count; r++)
                a[i]->band[r - c + (ptrdiff_t)c * count] += (sum[r + c * count] + sum[c + r * count]) / 2;
        target[i] = (struct target){a[i], count, solid->mesh.ndof, basis->v};
    }
    solid_add_attached(solid, p, &target[0], &target[1]);
}

void solid_basis_assemble(struct solid_basis *basis, const double *x, rotid_matrix *k, rotid_matrix *m)
{
    solid_set(basis->solid, x);
    assemble(basis, -1, k, m);
}

void solid_basis_differentiate(struct solid_basis *basis, const double *x, int p, rotid_matrix *dk, rotid_matrix *dm)
{
    solid_set(basis->solid, x);
    assemble(basis, p, dk, dm);
}
