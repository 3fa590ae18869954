#include "exact_receptance.h"

#define MOST_NODES 128

struct grid {
    int count;
    double z[MOST_NODES];
    double stiffness[4 * MOST_NODES * MOST_NODES]; /* row-major, 2 count square */
};

static int node_at(const struct grid *grid, double z)
{
    for (int i = 0; i < grid->count; i++)
        if (fabs(grid->z[i] - z) < 1e-9)
            return i;
    return -1;
}

static void add_node(struct grid *grid, double z)
{
    int at = grid->count;
    if (node_at(grid, z) >= 0)
        return;
    assert_true(grid->count < MOST_NODES);
    for (; at > 0 && grid->z[at - 1] > z; at--)
        grid->z[at] = grid->z[at - 1];
    grid->z[at] = z;
    grid->count++;
}

static void add_member(struct grid *grid, int left, int right, const double member[16])
{
    int dof[4] = {2 * left, 2 * left + 1, 2 * right, 2 * right + 1};
    for (int a = 0; a < 4; a++)
        for (int b = 0; b < 4; b++)
            grid->stiffness[dof[a] * 2 * grid->count + dof[b]] += member[4 * a + b];
}

static void add_segments(struct grid *grid, const struct oracle_system *system, double lambda)
{
    double from = 0, transfer[16], member[16];
    for (int s = 0; s < system->segments; s++) {
        double to = from + system->segment[s].length;
        for (int i = node_at(grid, from); i < node_at(grid, to); i++) {
            oracle_transfer(&system->segment[s], grid->z[i + 1] - grid->z[i], lambda, transfer);
            assert_int_equal(oracle_dynamic_stiffness(transfer, member), ORACLE_OK);
            add_member(grid, i, i + 1, member);
        }
        from = to;
    }
}

void exact_receptance(const struct exact *exact, double omega, int points, const double *z, int reference, double *receptance)
{
    static struct grid grid;
    const struct oracle_system *system = &exact->system;
    double lambda = omega * omega, end = 0, largest = 0, x[2 * MOST_NODES] = {0}, work[2 * MOST_NODES], log_determinant;
    int pivot[2 * MOST_NODES], negative;
    memset(&grid, 0, sizeof grid);
    add_node(&grid, 0);
    for (int s = 0; s < system->segments; s++)
        add_node(&grid, end += system->segment[s].length);
    for (int p = 0; p < system->points; p++)
        add_node(&grid, system->point[p].z);
    for (int p = 0; p < system->parallels; p++) {
        add_node(&grid, system->parallel[p].z_a);
        add_node(&grid, system->parallel[p].z_b);
    }
    for (int i = 0; i < points; i++)
        add_node(&grid, z[i]);
    int n = 2 * grid.count;
    add_segments(&grid, system, lambda);
    for (int p = 0; p < system->points; p++) {
        const struct oracle_point *point = &system->point[p];
        int v = 2 * node_at(&grid, point->z);
        assert_true(point->flexibility == 0);
        grid.stiffness[v * n + v] += point->spring - lambda * point->mass;
        grid.stiffness[(v + 1) * n + v + 1] += point->rotational_spring - lambda * point->inertia;
    }
    for (int p = 0; p < system->parallels; p++) {
        const struct oracle_parallel *parallel = &system->parallel[p];
        double member[16];
        for (int i = 0; i < 16; i++)
            member[i] = parallel->stiffness[i] - lambda * parallel->mass[i];
        add_member(&grid, node_at(&grid, parallel->z_a), node_at(&grid, parallel->z_b), member);
    }
    for (int i = 0; i < n * n; i++)
        largest = fmax(largest, fabs(grid.stiffness[i]));
    for (int i = 0; i < n * n; i++)
        grid.stiffness[i] /= largest; /* the oracle wants entries of order one */
    oracle_factor(n, grid.stiffness, pivot, &negative, &log_determinant);
    x[2 * node_at(&grid, z[reference])] = 1 / largest;
    oracle_solve(n, grid.stiffness, pivot, x, work);
    for (int i = 0; i < points; i++)
        receptance[i] = x[2 * node_at(&grid, z[i])];
}
