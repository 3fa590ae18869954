#include "exact.h"

#include "modal/modal.h"
#include "model/model.h"

static const double pi = 3.14159265358979323846;

struct moments { /* of a section: its area, and the second moment about a diameter */
    double area, second;
};

static struct moments ring(double outer, double inner)
{
    double ro = outer / 2, ri = inner / 2, area = pi * (ro - ri) * (ro + ri);
    return (struct moments){area, area * (ro * ro + ri * ri) / 4};
}

/* `number` discs around the axis, one by one (parallel-axis theorem) */
static struct moments discs(int number, double diameter, double pitch)
{
    struct moments one = ring(diameter, 0), sum = {0, 0};
    for (int i = 0; i < number; i++) {
        double arm = pitch * sin(0.4 + 2 * pi * i / number);
        sum.area += one.area;
        sum.second += one.second + one.area * arm * arm;
    }
    return sum;
}

static void take_out(struct moments *from, struct moments what)
{
    from->area -= what.area;
    from->second -= what.second;
}

static double shear_modulus(const struct material *m)
{
    return m->isotropic ? m->e / 2 / (1 + m->nu) : m->g;
}

static struct oracle_segment beam_of(const struct material *m, struct moments stiff, struct moments heavy, double coefficient,
                                     double length)
{
    return (struct oracle_segment){.length = length,
                                   .bending = m->e * stiff.second,
                                   .shear = coefficient * shear_modulus(m) * stiff.area,
                                   .mass = m->rho * heavy.area,
                                   .inertia = m->rho * heavy.second};
}

static struct oracle_segment stretch(const struct group *group, const struct segment *s)
{
    const struct material *m = &group->material;
    if (s->rectangular) {
        struct moments r = {s->height * s->width, s->width * pow(s->height, 3) / 12};
        return beam_of(m, r, r, 10 * (1 + m->nu) / (12 + 11 * m->nu), s->length);
    }
    struct moments stiff = ring(s->stiff_outer, s->inner), heavy = ring(s->outer, s->inner);
    if (group->holes) {
        struct moments holes = discs(group->holes, group->hole_diameter, group->hole_pitch);
        take_out(&heavy, holes);
        if (group->hole_pitch < s->stiff_outer / 2)
            take_out(&stiff, holes);
    }
    return beam_of(m, stiff, heavy, oracle_cowper(m->nu, s->inner / s->stiff_outer), s->length);
}

struct oracle_segment exact_bundle(enum bundle_model model, const struct material *m, int number, double diameter, double pitch,
                                   double length, double *pitch_inertia)
{
    struct moments all = discs(number, diameter, pitch), own = discs(number, diameter, 0);
    *pitch_inertia = all.second - own.second;
    if (model == BUNDLE_RODS)
        return beam_of(m, own, own, oracle_cowper(m->nu, 0), length);
    /* radii of the ring from S = pi (ro^2 - ri^2), 4 I/S = ro^2 + ri^2 */
    double sum = 4 * all.second / all.area, difference = all.area / pi;
    return beam_of(m, all, all, oracle_cowper(m->nu, sqrt((sum - difference) / (sum + difference))), length);
}

/* Segments, cut where the compression by self-equilibrated rods begins and ends. */
static int lay_segments(const struct rotor *rotor, struct oracle_segment *segment)
{
    int count = 0;
    double z = 0;
    for (int s = 0; s < rotor->nsegment; s++) {
        const struct group *group = &rotor->group[rotor->segment[s].group];
        double end = z + rotor->segment[s].length, scrap = 1e-9 * rotor->segment[s].length;
        while (end - z > scrap) {
            double stop = end, axial = group->preload;
            for (int t = 0; t < rotor->ntierod; t++) {
                const struct tierod *rod = &rotor->tierod[t];
                if (!rod->self_equilibrated)
                    continue;
                if (rod->from - z > scrap)
                    stop = fmin(stop, rod->from);
                if (rod->to - z > scrap)
                    stop = fmin(stop, rod->to);
                if (rod->from - z <= scrap && rod->to - z > scrap)
                    axial -= rod->number * rod->tension;
            }
            if (end - stop <= scrap)
                stop = end;
            segment[count] = stretch(group, &rotor->segment[s]);
            segment[count].length = stop - z;
            segment[count++].axial = axial;
            z = stop;
        }
        z = end;
    }
    return count;
}

static void tie(const struct tierod *rod, struct oracle_parallel *parallel)
{
    struct oracle_tie bundle = {.count = rod->number,
                                .diameter = rod->diameter,
                                .pitch_radius = rod->pitch,
                                .length = rod->to - rod->from,
                                .young = rod->material.e,
                                .poisson = rod->material.nu,
                                .density = rod->material.rho,
                                .tension = rod->tension};
    assert_true(rod->elements == 1 && rod->material.isotropic);
    *parallel = (struct oracle_parallel){.z_a = rod->from, .z_b = rod->to};
    int status = rod->model == BUNDLE_RODS ? oracle_tie_rods(&bundle, parallel->stiffness, parallel->mass)
                                           : oracle_tie_tube(&bundle, parallel->stiffness, parallel->mass);
    assert_int_equal(status, ORACLE_OK);
}

/* (44) of the paper: the rotor hangs by its left end, g = 9.81 m/s2 */
static void add_sling(const struct rotor *rotor, struct exact *exact)
{
    double mass = 0, first_moment = 0, z = 0;
    for (int i = 0; i < exact->system.segments; i++) {
        const struct oracle_segment *s = &exact->segment[i];
        mass += s->mass * s->length;
        first_moment += s->mass * s->length * (z + s->length / 2);
        z += s->length;
    }
    for (int i = 0; i < rotor->ntierod; i++) {
        const struct tierod *rod = &rotor->tierod[i];
        double of_rods = rod->material.rho * rod->number * ring(rod->diameter, 0).area * (rod->to - rod->from);
        mass += of_rods;
        first_moment += of_rods * (rod->from + rod->to) / 2;
    }
    for (int i = 0; i < rotor->ndisk; i++) {
        mass += rotor->disk[i].mass;
        first_moment += rotor->disk[i].mass * rotor->disk[i].position;
    }
    double center = first_moment / mass;
    exact->point[exact->system.points++] = (struct oracle_point){.z = 0, .spring = mass * 9.81 / rotor->sling};
    exact->point[exact->system.points++] =
        (struct oracle_point){.z = z, .spring = mass * 9.81 * center / (z * z + center * rotor->sling)};
}

void exact_open(const struct rotor *rotor, struct exact *exact)
{
    assert_true(2 * rotor->ntierod + rotor->nsegment < 32 && rotor->ndisk + rotor->nspring < 30 && rotor->ntierod <= 4);
    exact->system = (struct oracle_system){.segments = lay_segments(rotor, exact->segment),
                                           .segment = exact->segment,
                                           .point = exact->point,
                                           .parallels = rotor->ntierod,
                                           .parallel = exact->parallel};
    for (int i = 0; i < rotor->ntierod; i++)
        tie(&rotor->tierod[i], &exact->parallel[i]);
    for (int i = 0; i < rotor->ndisk; i++) {
        const struct disk *disk = &rotor->disk[i];
        exact->point[exact->system.points++] =
            (struct oracle_point){.z = disk->position, .mass = disk->mass, .inertia = disk->diametral};
    }
    for (int i = 0; i < rotor->nspring; i++) {
        const struct spring *spring = &rotor->spring[i];
        exact->point[exact->system.points++] =
            (struct oracle_point){.z = spring->position, .spring = spring->lateral, .rotational_spring = spring->rotational};
    }
    if (rotor->sling > 0)
        add_sling(rotor, exact);
}

void exact_hz(const struct exact *exact, int first, int count, double *hz)
{
    assert_int_equal(oracle_frequencies(&exact->system, first, count, hz), ORACLE_OK);
}

/* No matrix on the two ends of a bundle with modes of its own holds at all frequencies, but its exact dynamic stiffness does at
 * one: Wittrick and Williams count the rotor with that, and add those of the bundle with its ends held. */
int exact_count(const struct rotor *rotor, double hz)
{
    const struct tierod *rod = &rotor->tierod[0];
    struct rotor bare = *rotor;
    struct exact exact;
    double length = rod->to - rod->from, omega = 2 * pi * hz, pitch, transfer[16];
    int count, held;
    assert_int_equal(rotor->ntierod, 1);
    bare.ntierod = 0;
    exact_open(&bare, &exact);
    exact.system.segments = lay_segments(rotor, exact.segment); /* with the compression by the rods */
    struct oracle_segment bundle =
        exact_bundle(rod->model, &rod->material, rod->number, rod->diameter, rod->pitch, length, &pitch);
    bundle.axial = rod->number * rod->tension;
    struct oracle_point end[2] = {{.z = 0, .spring = INFINITY, .rotational_spring = INFINITY},
                                  {.z = length, .spring = INFINITY, .rotational_spring = INFINITY}};
    struct oracle_system alone = {.segments = 1, .segment = &bundle, .points = 2, .point = end};
    struct oracle_parallel *parallel = &exact.parallel[0];
    *parallel = (struct oracle_parallel){.z_a = rod->from, .z_b = rod->to};
    oracle_transfer(&bundle, length, omega * omega, transfer);
    assert_int_equal(oracle_dynamic_stiffness(transfer, parallel->stiffness), ORACLE_OK);
    if (rod->model == BUNDLE_RODS) { /* stretch by the rotation of the ends, linear in between as the model has it */
        double k = rod->material.e * pitch / length, m = omega * omega * rod->material.rho * pitch * length;
        for (int i = 1; i < 4; i += 2)
            for (int j = 1; j < 4; j += 2)
                parallel->stiffness[4 * i + j] += i == j ? k - m / 3 : -k - m / 6;
    }
    exact.system.parallels = 1;
    assert_int_equal(oracle_count(&exact.system, omega, &count), ORACLE_OK);
    assert_int_equal(oracle_count(&alone, omega, &held), ORACLE_OK);
    return count + held;
}

void mesh_hz(const struct rotor *rotor, int refine, int skip, int count, double *hz)
{
    struct pool pool;
    struct rotor_model client;
    struct prediction p;
    int failed;
    pool_open(&pool, NULL);
    assert_status(model_open(&pool, NULL, rotor, 0, NULL, refine, &client, &failed), ROTID_OK);
    assert_status(prediction_new(&pool, &client.equations, ROTID_REDUCTION_NONE, ROTID_NELSON, skip + count, 0, &p), ROTID_OK);
    assert_status(prediction_compute(&p, NULL), ROTID_OK);
    for (int k = 0; k < count; k++)
        hz[k] = sqrt(p.lambda[skip + k]) / (2 * pi);
    pool_close(&pool);
}

void limit_hz(const struct rotor *rotor, int refine, int skip, int count, double *hz)
{
    double coarse[16];
    assert_true(count <= 16);
    mesh_hz(rotor, refine, skip, count, coarse);
    mesh_hz(rotor, 2 * refine, skip, count, hz);
    for (int k = 0; k < count; k++)
        hz[k] += (hz[k] - coarse[k]) / 3;
}

void assert_hz_at(int count, const double *value, const double *expected, double rtol, const char *text, const char *file,
                  int line)
{
    char name[120];
    for (int k = 0; k < count; k++) {
        snprintf(name, sizeof name, "%s, mode %d [Hz]", text, k + 1);
        assert_close_at(value[k], expected[k], rtol, 0, name, file, line);
    }
}

double worst_ratio(int count, const double *a, const double *b)
{
    double worst = 0;
    for (int k = 0; k < count; k++)
        worst = fmax(worst, fabs(a[k] / b[k] - 1));
    return worst;
}

double best_scale(int count, const double *a, const double *b, double *mac)
{
    double aa = 0, ab = 0, bb = 0;
    for (int i = 0; i < count; i++) {
        aa += a[i] * a[i];
        ab += a[i] * b[i];
        bb += b[i] * b[i];
    }
    *mac = ab * ab / (aa * bb);
    return ab / aa;
}
