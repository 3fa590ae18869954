/* A solid in a basis V: V'K V and V'M V without K and M. The field of a share, eight numbers in which K and M are linear, is the
 * same over most of a group: shares whose field and its rates are equal where the basis is made are a class. Its fields span few
 * directions, two where E and G of an isotropic material move, and V'K V of each is made when the field first leaves those
 * before. What differs from its class elsewhere, as where a zone has moved on, is added element by element: V'K V is that of the
 * mesh at all values. */
#include "linalg/linalg.h"
#include "solid/solid.h"

enum {
    NUMBERS = SOLID_FIELD, /* c11 c12 c13 c33 c44 c66, rho, stress */
    RHO = 6,
    CLASS_MOST = 48 /* shares of further ones are added element by element at all values */
};

#define SPANNED 1e-13 /* of a field: what is left beside its directions is rounding */

/* sum [count * count] += V'Y of K or M, and Y := 0 */
static void take_image(const struct solid_basis *basis, struct solid_image *image, double *sum)
{
    int n = basis->solid->mesh.ndof, rows = image->end - image->from, count = basis->count;
    if (rows > 0)
        product_add_transposed(count, count, rows, n, basis->v + image->from, image->y + image->from, sum);
    for (int j = 0; j < count && rows > 0; j++)
        memset(image->y + image->from + (ptrdiff_t)j * n, 0, (size_t)rows * sizeof *image->y);
    image->from = n;
    image->end = 0;
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

/* part [count * count] := what the shares of a class make of K or M (which 0, 1) with this field. */
static void part_of_class(struct solid_basis *basis, int class, int which, const double *number, double *part)
{
    struct share of_class;
    memcpy(&of_class, number, sizeof of_class);
    for (int e = 0; e < basis->solid->mesh.nelement; e++) {
        struct share field[SHARES] = {{.rho = 0}};
        int any = 0;
        for (int s = 0; s < SHARES; s++)
            if (basis->class_of[e * SHARES + s] == class) {
                field[s] = of_class;
                any = 1;
            }
        if (any)
            solid_add_images(basis->solid, e, field, basis->count, basis->v, basis->image);
    }
    take_image(basis, &basis->image[which], part);
}

int solid_basis_new(struct pool *pool, struct solid *solid, int count, const double *v, struct solid_basis *basis)
{
    size_t square = (size_t)count * (size_t)count, n = (size_t)solid->mesh.ndof;
    *basis = (struct solid_basis){.solid = solid, .count = count, .v = v};
    basis->class = POOL_ARRAY(pool, struct solid_class, CLASS_MOST);
    basis->class_of = POOL_ARRAY(pool, int, (size_t)solid->mesh.nelement *SHARES);
    basis->sum = POOL_ARRAY(pool, double, 2 * square);
    for (int i = 0; i < 2; i++)
        basis->image[i] = (struct solid_image){POOL_ARRAY(pool, double, n *(size_t)count), solid->mesh.ndof, 0};
    if (!basis->class || !basis->class_of || !basis->sum || !basis->image[0].y || !basis->image[1].y)
        return ROTID_ERROR_MEMORY;
    int status = classify(pool, basis);
    for (int c = 0; c < basis->nclass && !status; c++) {
        basis->class[c].part = POOL_ARRAY(pool, double, (basis->class[c].moves ? NUMBERS : 2) * square);
        status = basis->class[c].part ? ROTID_OK : ROTID_ERROR_MEMORY;
    }
    return status;
}

static void add_scaled(int n, double by, const double *x, double *sum)
{
    for (int i = 0; i < n; i++)
        sum[i] += by * x[i];
}

/* sum [2 * count * count] += what class c makes of K and M with the field `number` */
static void add_class(struct solid_basis *basis, int c, double number[NUMBERS])
{
    struct solid_class *class = &basis->class[c];
    int square = basis->count * basis->count, most = class->moves ? NUMBERS - 1 : 1;
    double rho = number[RHO], of_mass[NUMBERS] = {0};
    of_mass[RHO] = 1;
    if (rho != 0 && !class->has_mass)
        part_of_class(basis, c, 1, of_mass, class->part);
    class->has_mass |= rho != 0;
    if (rho != 0)
        add_scaled(square, rho, class->part, basis->sum + square);
    number[RHO] = 0;
    double rounding = SPANNED * sqrt(product_dot(NUMBERS, number, number));
    for (int d = 0; d < most; d++) {
        double *direction = class->direction[d], *part = class->part + (ptrdiff_t)(1 + d) * square;
        if (d == class->ndirection) {
            double left = sqrt(product_dot(NUMBERS, number, number));
            if (!(left > rounding))
                return;
            for (int i = 0; i < NUMBERS; i++)
                direction[i] = number[i] / left;
            part_of_class(basis, c, 0, direction, part);
            class->ndirection++;
        }
        double along = product_dot(NUMBERS, direction, number);
        add_scaled(NUMBERS, -along, direction, number);
        add_scaled(square, along, part, basis->sum);
    }
}

/* sum := what the classes make of K and M, or of their derivatives, with `now` of each */
static void sum_of_classes(struct solid_basis *basis, int p)
{
    const struct solid *solid = basis->solid;
    memset(basis->sum, 0, 2 * (size_t)basis->count * (size_t)basis->count * sizeof *basis->sum);
    for (int c = 0; c < basis->nclass; c++) {
        struct solid_class *class = &basis->class[c];
        const struct solid_element *element = &solid->mesh.element[class->element];
        double number[NUMBERS];
        if (p >= 0 && !class->moves)
            continue;
        if (p >= 0)
            (void)solid_field_rate(solid, element, class->share, solid->parameter[p], &class->now);
        else if (class->moves)
            solid_field_of_share(solid, element, class->share, &class->now);
        memcpy(number, &class->now, sizeof number);
        add_class(basis, c, number);
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
            solid_add_images(solid, e, rest, count, basis->v, basis->image);
    }
    for (int i = 0; i < 2; i++) {
        double *sum = basis->sum + (ptrdiff_t)i * count * count;
        take_image(basis, &basis->image[i], sum);
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
