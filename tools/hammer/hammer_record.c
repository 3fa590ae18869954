/* One impact as it is recorded. */
#include <math.h>
#include <string.h>

#include "hammer.h"
#include "hide/hide_random.h"

static const double pi = 3.14159265358979323846;

#define MOUNT_DAMPING 0.02
#define DEAD_NOISE    1e-3 /* of the rms that the channel would have had */
#define CLIP_AT       0.6  /* of the peak */
#define UNHEARD       1e-7 /* a mode that the filter weakens by this rings in no record */

double hammer_damping(const struct hammer_test *test, int mode)
{
    const struct hammer_options *o = &test->options;
    int elastic = mode - test->rigid;
    return elastic < 0 ? o->suspension_damping : o->damping[elastic < o->dampings ? elastic : o->dampings - 1];
}

/* With all frequencies times drift: stiffness times drift^2, so what the rest gives falls. */
static double complex accelerance(const struct hammer_test *test, int point, double drift, double complex s)
{
    const double *hz = test->hz + (ptrdiff_t)point * test->modes, *residue = test->residue + (ptrdiff_t)point * test->modes;
    double complex lambda = -s * s / (drift * drift), sum = 0;
    for (int j = HAMMER_REST - 1; j >= 0; j--)
        sum = sum * lambda + test->rest[point * HAMMER_REST + j];
    sum /= drift * drift;
    for (int k = 0; k < test->modes; k++) {
        double omega = 2 * pi * hz[k] * drift;
        sum += residue[k] / (s * s + 2 * hammer_damping(test, k) * omega * s + omega * omega);
    }
    return s * s * sum;
}

double complex hammer_frf(const struct hammer_test *test, int point, double complex s)
{
    return accelerance(test, point, 1, s);
}

static double complex pole(double omega, double damping)
{
    return omega * CMPLX(-damping, sqrt(1 - damping * damping));
}

/* Partial fractions of accelerance, mount and filter; mount_hz 0: a mount without resonance. */
static void response_poles(const struct hammer_test *test, int point, double drift, double mount_hz, struct hammer_poles *out)
{
    const double *hz = test->hz + (ptrdiff_t)point * test->modes, *residue = test->residue + (ptrdiff_t)point * test->modes;
    double complex mount = pole(2 * pi * mount_hz, MOUNT_DAMPING), square = mount * conj(mount);
    out->count = 0;
    for (int k = 0; k < test->modes; k++) {
        double complex p = pole(2 * pi * hz[k] * drift, hammer_damping(test, k)), f = hammer_filter_at(&test->filter, p);
        if (cabs(f) < UNHEARD)
            continue;
        out->pole[out->count] = p;
        out->residue[out->count++] =
            p * p * residue[k] / (p - conj(p)) * f * (mount_hz > 0 ? square / ((p - mount) * (p - conj(mount))) : 1);
    }
    for (int i = 0; i < HAMMER_FILTER_PAIRS; i++) {
        double complex p = test->filter.pole[i];
        out->pole[out->count] = p;
        out->residue[out->count++] = test->filter.residue[i] * accelerance(test, point, drift, p) *
                                     (mount_hz > 0 ? square / ((p - mount) * (p - conj(mount))) : 1);
    }
    if (mount_hz > 0) {
        out->pole[out->count] = mount;
        out->residue[out->count++] =
            square / (mount - conj(mount)) * accelerance(test, point, drift, mount) * hammer_filter_at(&test->filter, mount);
    }
}

/* Streams that do not depend on the order of the calls. */
enum stream { OF_IMPACT = 1, OF_NOISE, OF_DRIFT };

static void open_stream(uint64_t seed, enum stream stream, int point, int impact, struct hide_random *random)
{
    hide_random_open(seed ^ (uint64_t)stream << 40, HIDE_FOR_SHAPES, random);
    hide_random_open(random->state[0] + (uint64_t)point * UINT64_C(0x9E3779B97F4A7C15), HIDE_FOR_SHAPES, random);
    hide_random_open(random->state[1] + (uint64_t)impact * UINT64_C(0xD1B54A32D192ED03), HIDE_FOR_SHAPES, random);
}

static void draw(const struct hammer_test *test, uint64_t seed, int point, int impact, struct hammer_impact *d)
{
    const struct hammer_options *o = &test->options;
    struct hide_random random;
    double spread = o->force_spread, delay, share;
    open_stream(seed, OF_IMPACT, point, impact, &random);
    d->start = (floor(o->pretrigger * o->rate) + hide_uniform(&random)) / o->rate; /* anywhere within a sample */
    d->duration = hide_between(&random, o->pulse_short, o->pulse_long);
    d->peak = o->force * (1 + hide_between(&random, -spread, spread));
    delay = hide_between(&random, 0.004, 0.02);
    share = hide_between(&random, 0.25, 0.7);
    d->second_start = d->start + delay;
    d->second_peak = hide_uniform(&random) < o->double_hits ? share * d->peak : 0;
    d->clipped = hide_uniform(&random) < o->clipped;
    open_stream(seed, OF_DRIFT, point, 0, &random);
    d->drift = 1 + o->drift * hide_normal(&random);
}

static void strike(const struct hammer_test *test, const struct hammer_poles *poles, const struct hammer_impact *d, double *y)
{
    memset(y, 0, (size_t)test->count * sizeof *y);
    hammer_pulse_add(poles, test->options.rate, d->start, d->duration, d->peak, test->count, y);
    if (d->second_peak > 0)
        hammer_pulse_add(poles, test->options.rate, d->second_start, d->duration, d->second_peak, test->count, y);
}

static void measure(int count, const double *y, double *largest, double *rms)
{
    double sum = 0;
    *largest = 0;
    for (int n = 0; n < count; n++) {
        sum += y[n] * y[n];
        *largest = fmax(*largest, fabs(y[n]));
    }
    *rms = sqrt(sum / count);
}

static void add_noise(int count, double deviation, struct hide_random *random, double *y)
{
    for (int n = 0; n < count && deviation > 0; n++)
        y[n] += deviation * hide_normal(random);
}

/* Overload. A short pulse has few samples, so the cut goes down to the second one: two neighbours then are equal. */
static void clip(int count, double *force)
{
    int peak = 0;
    for (int n = 1; n < count; n++)
        peak = force[n] > force[peak] ? n : peak;
    double before = peak > 0 ? force[peak - 1] : 0, after = peak + 1 < count ? force[peak + 1] : 0;
    double limit = fmin(CLIP_AT * force[peak], fmax(before, after));
    for (int n = 0; n < count; n++)
        force[n] = fmin(force[n], limit);
}

/* A duplicate channel repeats what the other point records, faults of that one included, so it is only looked up. */
static int recorded_point(const struct hammer_test *test, int point)
{
    for (int i = 0; i < test->options.faults; i++) {
        const struct hammer_fault *f = &test->options.fault[i];
        for (int s = 0; s < test->points && f->kind == HAMMER_DUPLICATE && f->id == test->id[point]; s++)
            if (test->id[s] == f->other)
                return s;
    }
    return point;
}

void hammer_record(const struct hammer_test *test, uint64_t seed, int point, int impact, double *force, double *response,
                   struct hammer_impact *drawn)
{
    const struct hammer_options *o = &test->options;
    struct hammer_poles poles = {.count = HAMMER_FILTER_PAIRS};
    struct hide_random random;
    double largest, rms, force_peak, force_rms, gain = 1, mount_hz = 0;
    int dead = 0, source = recorded_point(test, point);
    draw(test, seed, source, impact, drawn);
    for (int i = 0; i < o->faults; i++) {
        const struct hammer_fault *f = &o->fault[i];
        if (f->id != test->id[source])
            continue;
        dead |= f->kind == HAMMER_DEAD;
        gain *= f->kind == HAMMER_FLIP ? -1 : f->kind == HAMMER_GAIN ? f->value : 1;
        mount_hz = f->kind == HAMMER_LOOSE ? f->value : mount_hz;
    }
    memcpy(poles.pole, test->filter.pole, sizeof test->filter.pole);
    memcpy(poles.residue, test->filter.residue, sizeof test->filter.residue);
    strike(test, &poles, drawn, force);
    response_poles(test, source, drawn->drift, mount_hz, &poles);
    strike(test, &poles, drawn, response);
    measure(test->count, force, &force_peak, &force_rms);
    measure(test->count, response, &largest, &rms);
    for (int n = 0; n < test->count; n++)
        response[n] *= dead ? 0 : gain;
    open_stream(seed, OF_NOISE, source, impact, &random);
    add_noise(test->count, dead ? DEAD_NOISE * rms : hypot(o->noise * rms, o->floor * largest) * fabs(gain), &random, response);
    add_noise(test->count, force_peak * hypot(o->force_noise, o->floor), &random, force);
    if (drawn->clipped)
        clip(test->count, force);
}
