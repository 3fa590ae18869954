#include "solid/integrals.h"

#include <string.h>

#include "solid/shape.h"

static const double pi = 3.14159265358979323846;
static const double place[SHARES] = {-0.77459666924148337704, 0, 0.77459666924148337704};
static const double weight[SHARES] = {5.0 / 9, 8.0 / 9, 5.0 / 9};

static void add_product(double w, const double *x, const double *y, double *sum)
{
    for (int b = 0; b < SOLID_NODES; b++)
        for (int a = 0; a < SOLID_NODES; a++)
            sum[a + SOLID_NODES * b] += w * x[a] * y[b];
}

static void add_point(const struct solid_mesh *mesh, const struct solid_element *element, int ix, int iy, struct integrals *out)
{
    double n[SOLID_NODES], by_x[SOLID_NODES], by_y[SOLID_NODES], by_r[SOLID_NODES], by_z[SOLID_NODES], r = 0, rx = 0, ry = 0,
                                                                                                       zx = 0, zy = 0;
    double(*sum)[SOLID_NODES * SOLID_NODES] = out->value[iy];
    shape_of_element(place[ix], place[iy], n, by_x, by_y);
    for (int a = 0; a < SOLID_NODES; a++) {
        const struct solid_node *node = &mesh->node[element->node[a]];
        r += n[a] * node->r;
        rx += by_x[a] * node->r;
        ry += by_y[a] * node->r;
        zx += by_x[a] * node->z;
        zy += by_y[a] * node->z;
    }
    double jacobian = rx * zy - ry * zx, w = pi * weight[ix] * weight[iy] * jacobian * r * element->share;
    add_product(w, n, n, sum[BY_MASS]);
    for (int a = 0; a < SOLID_NODES; a++) {
        by_r[a] = (zy * by_x[a] - zx * by_y[a]) / jacobian;
        by_z[a] = (rx * by_y[a] - ry * by_x[a]) / jacobian;
        n[a] /= r;
    }
    add_product(w, by_r, by_r, sum[BY_R_R]);
    add_product(w, n, n, sum[BY_N_N]);
    add_product(w, by_z, by_z, sum[BY_Z_Z]);
    add_product(w, by_r, n, sum[BY_R_N]);
    add_product(w, by_r, by_z, sum[BY_R_Z]);
    add_product(w, n, by_z, sum[BY_N_Z]);
}

/* The mass outside the stiffness diameter moves with the outer edge: half of it each in U, V and W, as of a ring. */
static void add_extra(const struct solid_mesh *mesh, const struct solid_element *element, int iy, double *sum)
{
    double n[SOLID_NODES], by_x[SOLID_NODES], by_y[SOLID_NODES], slope = 0;
    shape_of_element(1, place[iy], n, by_x, by_y);
    for (int a = 0; a < SOLID_NODES; a++)
        slope += by_y[a] * mesh->node[element->node[a]].z;
    add_product(weight[iy] * slope * element->extra / 2, n, n, sum);
}

void integrals_of(const struct solid_mesh *mesh, const struct solid_element *element, struct integrals *integrals)
{
    memset(integrals, 0, sizeof *integrals);
    for (int iy = 0; iy < SHARES; iy++) {
        for (int ix = 0; ix < SHARES; ix++)
            add_point(mesh, element, ix, iy, integrals);
        if (element->extra > 0)
            add_extra(mesh, element, iy, integrals->value[iy][BY_MASS]);
    }
}

void integrals_add_stiffness(const struct integrals *integrals, int share, const struct elasticity *c, double stress, double *k)
{
    const double(*sum)[SOLID_NODES * SOLID_NODES] = integrals->value[share];
    for (int b = 0; b < SOLID_NODES; b++)
        for (int a = 0; a < SOLID_NODES; a++) {
            int ab = a + SOLID_NODES * b, ba = b + SOLID_NODES * a;
            double rr = sum[BY_R_R][ab], nn = sum[BY_N_N][ab], zz = sum[BY_Z_Z][ab], rn = sum[BY_R_N][ab], nr = sum[BY_R_N][ba],
                   rz = sum[BY_R_Z][ab], zr = sum[BY_R_Z][ba], nz = sum[BY_N_Z][ab], zn = sum[BY_N_Z][ba];
            double prestress = stress * zz, twist = c->c66 * (nn - rn), back = c->c66 * (nn - nr);
            double *block = k + 3 * a + (ptrdiff_t)SOLID_DOFS * 3 * b;
            block[0] += c->c11 * (rr + nn) + c->c12 * (rn + nr) + c->c44 * zz + c->c66 * nn + prestress;
            block[SOLID_DOFS] += c->c12 * rn + c->c11 * nn + back;
            block[2 * SOLID_DOFS] += c->c13 * (rz + nz) + c->c44 * zr;
            block[1] += c->c12 * nr + c->c11 * nn + twist;
            block[1 + SOLID_DOFS] += c->c11 * nn + c->c66 * (rr - rn - nr + nn) + c->c44 * zz + prestress;
            block[1 + 2 * SOLID_DOFS] += c->c13 * nz - c->c44 * zn;
            block[2] += c->c13 * (zr + zn) + c->c44 * rz;
            block[2 + SOLID_DOFS] += c->c13 * zn - c->c44 * nz;
            block[2 + 2 * SOLID_DOFS] += c->c33 * zz + c->c44 * (rr + nn) + prestress;
        }
}

void integrals_add_mass(const struct integrals *integrals, int share, double rho, double *m)
{
    const double *sum = integrals->value[share][BY_MASS];
    for (int i = 0; i < SOLID_NODES * SOLID_NODES; i++)
        m[i] += rho * sum[i];
}

void integrals_share_span(double left, double right, int share, double *from, double *to)
{
    double before = 0;
    for (int i = 0; i < share; i++)
        before += weight[i] / 2;
    *from = left + before * (right - left);
    *to = left + (before + weight[share] / 2) * (right - left);
}
