#include "rotor_shapes.h"

#include "paper_rotor.h"

void rotor_shapes_open(struct exact *exact)
{
    exact_open(paper_rotor(BUNDLE_RODS, 1), exact);
}

void exact_soften(struct exact *exact, double from, double to, double factor)
{
    struct oracle_segment cut[32];
    int count = 0;
    double z = 0;
    for (int i = 0; i < exact->system.segments; i++) {
        double end = z + exact->segment[i].length;
        double at[4] = {z, fmin(fmax(from, z), end), fmin(fmax(to, z), end), end};
        for (int part = 0; part < 3; part++) {
            if (at[part + 1] - at[part] < 1e-6)
                continue;
            assert_true(count < 32);
            cut[count] = exact->segment[i];
            cut[count].length = at[part + 1] - at[part];
            cut[count].bending *= part == 1 ? factor : 1;
            cut[count++].shear *= part == 1 ? factor : 1;
        }
        z = end;
    }
    memcpy(exact->segment, cut, (size_t)count * sizeof *cut);
    exact->system.segments = count;
}

void exact_add(struct exact *exact, struct oracle_point point)
{
    assert_true(exact->system.points < 32);
    exact->point[exact->system.points++] = point;
}

void rotor_shapes(const struct exact *exact, struct rotor_shapes *shapes)
{
    double hz[EXACT_MODES];
    shapes->length = 0;
    for (int i = 0; i < exact->system.segments; i++)
        shapes->length += exact->segment[i].length;
    for (int i = 0; i < SHAPE_POINTS; i++)
        shapes->z[i] = shapes->length * i / (SHAPE_POINTS - 1);
    exact_hz(exact, 3, EXACT_MODES, hz); /* past the two modes on the slings */
    for (int k = 0; k < EXACT_MODES; k++)
        assert_int_equal(oracle_shape(&exact->system, hz[k], SHAPE_POINTS, shapes->z, shapes->value[k], NULL), ORACLE_OK);
}

double rotor_shape_at(const struct rotor_shapes *shapes, int k, double z)
{
    const double *y = shapes->value[k];
    double x = z / shapes->length * (SHAPE_POINTS - 1);
    int i = (int)x;
    i = i < 1 ? 1 : i > SHAPE_POINTS - 3 ? SHAPE_POINTS - 3 : i;
    x -= i;
    return -y[i - 1] * x * (x - 1) * (x - 2) / 6 + y[i] * (x + 1) * (x - 1) * (x - 2) / 2 - y[i + 1] * (x + 1) * x * (x - 2) / 2 +
           y[i + 2] * (x + 1) * x * (x - 1) / 6;
}
