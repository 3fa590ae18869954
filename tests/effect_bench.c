#include "effect_bench.h"

#include "linalg/linalg.h"
#include "paper_rotor.h"

static const double pi = 3.14159265358979323846;

static struct effect effects[BENCH_EFFECTS];
static struct disk fan;

struct rotor *bench_rotor(enum bundle_model model, int rods, int elements)
{
    struct rotor *rotor = paper_rotor(model, 1);
    rotor->ntierod = rods;
    rotor->group[0].preload = 2e6;
    rotor->group[1].holes = 12;
    rotor->group[1].hole_diameter = 0.033;
    rotor->group[1].hole_pitch = 0.13364;
    rotor->spring[0].name = "start";
    rotor->spring[1].name = "finish";
    rotor->spring[0].lateral = rotor->spring[1].lateral = 3e8;
    rotor->spring[0].rotational = 3e5;
    for (int s = 0; s < rotor->nsegment; s++) {
        if (rotor->segment[s].group == 0)
            rotor->segment[s].inner = 0.03;
        if (elements)
            rotor->segment[s].elements = elements;
    }
    if (elements)
        rotor->nsensor = 0; /* each would put a node of its own */
    fan = (struct disk){"fan", 0.256018, 12, 0.4, 0.8, 0.09, 0.4};
    rotor->disk = &fan;
    rotor->ndisk = 1;
    rotor->effect = effects;
    rotor->neffect = 0;
    return rotor;
}

struct effect *bench_add(struct rotor *rotor, const struct effect_kind *kind, int target, int variant, const double *value)
{
    static const char *const name[BENCH_EFFECTS] = {"a", "b", "c"};
    assert_true(rotor->neffect < BENCH_EFFECTS);
    struct effect *effect = &effects[rotor->neffect];
    *effect = (struct effect){.name = name[rotor->neffect++], .kind = kind, .target = target, .variant = variant};
    for (int p = 0; p < kind->nparameter; p++)
        effect->value[p] = value[p];
    return effect;
}

void bench_build(const struct rotor *rotor, int nparameter, const struct parameter *parameter, struct beam *beam)
{
    int failed;
    assert_status(beam_build(&test_pool, rotor, nparameter, parameter, 1, beam, &failed), ROTID_OK);
}

rotid_matrix bench_zero(const struct beam *beam)
{
    const struct mesh *mesh = &beam->mesh;
    rotid_matrix a;
    assert_status(matrix_new(&test_pool, mesh->ndof, mesh->kd, mesh->nfar, mesh->far, &a), ROTID_OK);
    return a;
}

void bench_matrices(struct beam *beam, const double *x, rotid_matrix *k, rotid_matrix *m)
{
    *k = bench_zero(beam);
    *m = bench_zero(beam);
    (beam->type == MODE_BENDING ? beam_assemble : bar_assemble)(beam, x, k, m);
}

double bench_largest(const rotid_matrix *a, const rotid_matrix *b)
{
    const double h = 0.03;
    double most = 0;
    for (int j = 0; j < a->n; j++)
        for (int d = 0; d <= a->kd && j + d < a->n; d++) {
            double scale = (j % 2 ? 1 / h : 1) * ((j + d) % 2 ? 1 / h : 1);
            int place = d + j * (a->kd + 1);
            most = fmax(most, scale * fabs(a->band[place] - (b ? b->band[place] : 0)));
        }
    for (int g = 0; g < a->nfar; g++)
        for (int f = 0; f < a->nfar; f++) {
            double scale = (a->far[f] % 2 ? 1 / h : 1) * (a->far[g] % 2 ? 1 / h : 1);
            int place = f + g * a->nfar;
            most = fmax(most, scale * fabs(a->block[place] - (b ? b->block[place] : 0)));
        }
    return most;
}

double bench_derivative_error(struct beam *beam, int p, double step, int side)
{
    static const double at[3][5] = {{-2, -1, 0, 1, 2}, {0, 1, 2, 3, 4}, {0, -1, -2, -3, -4}};
    static const double weight[3][5] = {{1, -8, 0, 8, -1}, {-25, 48, -36, 16, -3}, {25, -48, 36, -16, 3}};
    int scheme = side < 0 ? 2 : side;
    rotid_matrix exact[2], difference[2] = {bench_zero(beam), bench_zero(beam)}, value[2];
    double x[32], start, h, error = 0;
    for (int q = 0; q < beam->nparameter; q++)
        x[q] = *parameter_value(&beam->rotor, beam->parameter[q]);
    start = x[p];
    h = start != 0 ? fabs(start) * step : step;
    for (int s = 0; s < 5; s++) {
        x[p] = start + h * at[scheme][s];
        bench_matrices(beam, x, &value[0], &value[1]);
        for (int a = 0; a < 2; a++)
            matrix_combine(1, &difference[a], weight[scheme][s] / (12 * h), &value[a], &difference[a]);
    }
    x[p] = start;
    bench_matrices(beam, x, &value[0], &value[1]);
    exact[0] = bench_zero(beam);
    exact[1] = bench_zero(beam);
    (beam->type == MODE_BENDING ? beam_differentiate : bar_differentiate)(beam, p, &exact[0], &exact[1]);
    for (int a = 0; a < 2; a++) {
        double size = bench_largest(&exact[a], NULL), whole = bench_largest(&value[a], NULL) / (start != 0 ? fabs(start) : 1);
        if (size > 1e-11 * whole)
            error = fmax(error, bench_largest(&exact[a], &difference[a]) / size);
        else
            assert_close(bench_largest(&difference[a], NULL), 0, 0, 1e-10 * whole);
    }
    return error;
}

/* straight from the definition: all steps, no shortcuts */
double bench_cone_diameter(const struct rotor *rotor, int segment, double z, double angle)
{
    double diameter = rotor->segment[segment].stiff_outer, at = 0;
    for (int s = 0; s + 1 < rotor->nsegment; s++) {
        double a = rotor->segment[s].outer, b = rotor->segment[s + 1].outer;
        at += rotor->segment[s].length;
        if (a != b && !rotor->segment[s].rectangular && !rotor->segment[s + 1].rectangular)
            diameter = fmin(diameter, fmin(a, b) + 2 * fabs(z - at) * tan(angle * pi / 180));
    }
    return rotor->segment[segment].rectangular ? 0 : diameter;
}

/* the part of each hole inside the diameter, of the holes of these tests, which lie inside the section */
static double holes_area(const struct group *group, double diameter)
{
    double h = group->hole_diameter, share = group->holes ? (diameter - 2 * group->hole_pitch + h) / (2 * h) : 0;
    return fmax(0, fmin(1, share)) * group->holes * pi * h * h / 4;
}

void bench_section(const struct rotor *rotor, int segment, double d, double *area, double *inertia)
{
    const struct segment *s = &rotor->segment[segment];
    const struct group *group = &rotor->group[s->group];
    double holes = holes_area(group, d), e = group->hole_pitch, h = group->hole_diameter;
    *area = pi * (d * d - s->inner * s->inner) / 4 - holes;
    *inertia = pi * (pow(d, 4) - pow(s->inner, 4)) / 64 - holes * (h * h / 16 + e * e / 2);
}
