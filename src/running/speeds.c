#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "running/running.h"

#define STANDSTILL  1e-8 /* of the highest speed: in place of 0, where forward and backward whirl are one */
#define BEYOND      1.3  /* times the running range, or the third critical speed */
#define MODES_FIRST 14
#define MODES_MOST  48
#define REACH       2.5   /* the highest mode of the basis over the highest speed, at least */
#define NO_DAMPING  1e-12 /* of |lambda| */
#define COUPLED     10
#define CURVE       241 /* speeds of a response */
#define pi          3.14159265358979323846

struct run {
    struct pool *pool;
    const struct machine *machine;
    const struct job *job;
    const struct speeds_options *options;
    struct machine_values values;
    struct system system;
    struct basis_size basis;
    struct tracks tracks;
    int ncritical;
    struct critical *critical;
    double *speed;
    struct speeds *out;
};

static int refuse_system(const struct run *r, int status, int failed, struct message_list *notes)
{
    if (status == ROTID_ERROR_STIFFNESS)
        message_add(notes, SEVERITY_ERROR, NULL, 0, 0,
                    "the bearings do not hold the rotor, expected two *BEARING with stiffness, or more");
    if (status == ROTID_ERROR_SECTION) {
        struct job_place place = job_part_place(r->job, failed);
        message_add(notes, SEVERITY_ERROR, place.file, place.line, place.column, "%s",
                    discrete_refusal(r->job->options.solid ? AS_SOLID : AS_BEAM, &r->job->rotor, failed));
    }
    return status;
}

/* Whether the bearings are stronger than the magnetic pull: the symmetric part of the stiffness at standstill is positive
 * definite.
 */
static int is_held(struct run *r)
{
    struct system *s = &r->system;
    struct pool scratch;
    int held = 0, n = s->size;
    if (!r->machine->npull)
        return 1;
    pool_open(&scratch, r->pool->allocator);
    double *k = POOL_ARRAY(&scratch, double, (size_t)n *(size_t)n);
    system_at(s, 0);
    for (int j = 0; j < n && k; j++)
        for (int i = 0; i < n; i++)
            k[i + (ptrdiff_t)n * j] = (s->stiff[i + (ptrdiff_t)n * j] + s->stiff[j + (ptrdiff_t)n * i]) / 2;
    held = k && !cholesky_factor(n, k);
    pool_close(&scratch);
    return held;
}

/* With a basis that reaches far enough beyond the highest speed, as far as the model has so many modes. */
static int build(struct run *r, double highest, struct message_list *notes)
{
    int status, failed;
    r->basis = (struct basis_size){MODES_FIRST, COUPLED, 1};
    for (;; r->basis.modes += r->basis.modes / 2) {
        status = system_build(r->pool, r->machine, r->job, &r->values, NULL, &r->basis, &r->system, &failed);
        if (status)
            return refuse_system(r, status, failed, notes);
        if (!is_held(r)) {
            message_add(notes, SEVERITY_ERROR, NULL, 0, 0,
                        "the magnetic pull is stronger than the bearings, which draws the rotor to the stator: expected a *PULL "
                        "below their stiffness");
            return ROTID_ERROR_STIFFNESS;
        }
        if (r->system.highest >= REACH * highest || r->basis.modes >= r->system.n || r->basis.modes >= MODES_MOST)
            return ROTID_OK;
    }
}

static int grid(struct run *r, double from, double to, int count)
{
    r->speed = POOL_ARRAY(r->pool, double, count);
    for (int i = 0; i < count && r->speed; i++)
        r->speed[i] = fmax(STANDSTILL * to, count > 1 ? from + (to - from) * i / (count - 1) : to);
    return r->speed ? ROTID_OK : ROTID_ERROR_MEMORY;
}

static int find(struct run *r, double to)
{
    const struct speeds_options *o = r->options;
    int status = grid(r, o->from, to, o->count);
    if (!status)
        status = tracks_make(r->pool, &r->system, o->count, r->speed, 2 * to * fmax(1, o->harmonic), &r->tracks);
    return status ? status : criticals_find(r->pool, &r->system, &r->tracks, o->harmonic, &r->ncritical, &r->critical);
}

/* To beyond the third forward critical speed: by the modes at standstill at first. */
static int find_range(struct run *r, struct message_list *notes)
{
    double to = r->options->to > 0 ? r->options->to : r->machine->has_operation ? BEYOND * r->machine->high : 0;
    if (to > 0) {
        int status = build(r, to * fmax(1, r->options->harmonic), notes);
        return status ? status : find(r, to);
    }
    int status = build(r, 0, notes), count;
    struct pair *all = status ? NULL : POOL_ARRAY(r->pool, struct pair, r->system.size);
    for (int i = 0; i < r->system.size && all; i++)
        if (pair_new(r->pool, r->system.size, &all[i]))
            return ROTID_ERROR_MEMORY;
    if (status || !all)
        return status ? status : ROTID_ERROR_MEMORY;
    status = pairs_all(r->pool, &r->system, STANDSTILL * r->system.highest, &count, all);
    if (!status && !count)
        return ROTID_ERROR_EIGEN;
    to = status ? 0 : BEYOND * cimag(all[count > 6 ? 5 : count - 1].lambda) / r->options->harmonic;
    for (int attempt = 0; attempt < 4 && !status; attempt++, to *= 1.6) {
        int forward = 0;
        status = build(r, to, notes);
        if (!status)
            status = find(r, to);
        for (int i = 0; i < r->ncritical && !status; i++)
            forward += pair_whirl(&r->system, r->critical[i].pair.u) != WHIRL_BACKWARD;
        if (forward >= 3)
            break;
    }
    return status;
}

/* ---- to results */

/* Of a mode without damping rounding is left of the real part. */
static double ratio(double complex lambda)
{
    return fabs(creal(lambda)) < NO_DAMPING * cabs(lambda) ? 0 : -creal(lambda) / cabs(lambda);
}

static double decrement(double complex lambda)
{
    return 2 * pi * ratio(lambda) * cabs(lambda) / cimag(lambda);
}

static int by_frequency(const void *a, const void *b)
{
    double x = ((const struct campbell_mode *)a)->frequency_hz, y = ((const struct campbell_mode *)b)->frequency_hz;
    return (x > y) - (x < y);
}

static int fill_campbell(struct run *r)
{
    struct speeds *out = r->out;
    out->ncampbell = r->tracks.nspeed;
    out->campbell = POOL_ARRAY(r->pool, struct campbell_speed, out->ncampbell);
    for (int i = 0; i < out->ncampbell && out->campbell; i++) {
        struct campbell_speed *to = &out->campbell[i];
        to->speed_rpm =
            r->tracks.speed[i] <= 2 * STANDSTILL * r->tracks.speed[r->tracks.nspeed - 1] ? 0 : r->tracks.speed[i] / RPM;
        to->modes = POOL_ARRAY(r->pool, struct campbell_mode, r->tracks.nmode);
        for (int m = 0; m < r->tracks.nmode && to->modes; m++) {
            const struct pair *pair = track_at(&r->tracks, m, i);
            if (isfinite(creal(pair->lambda)))
                to->modes[to->nmodes++] = (struct campbell_mode){m + 1,
                                                                 cimag(pair->lambda) / (2 * pi),
                                                                 {NAN, NAN},
                                                                 ratio(pair->lambda),
                                                                 decrement(pair->lambda),
                                                                 whirl_words[pair_whirl(&r->system, pair->u)]};
        }
        if (!to->modes)
            return ROTID_ERROR_MEMORY;
        qsort(to->modes, (size_t)to->nmodes, sizeof *to->modes, by_frequency);
    }
    return out->campbell ? ROTID_OK : ROTID_ERROR_MEMORY;
}

static int fill_shape(const struct run *r, const double complex *u, struct critical_speed *to)
{
    const struct system *s = &r->system;
    const double *z = discrete_place_z(&s->discrete);
    double complex largest = 0;
    double *all = POOL_ARRAY(r->pool, double, 5 * (size_t)s->naxis);
    if (!all)
        return ROTID_ERROR_MEMORY;
    to->nz = s->naxis;
    to->z = all;
    to->x_re = all + s->naxis;
    to->x_im = all + 2 * (ptrdiff_t)s->naxis;
    to->y_re = all + 3 * (ptrdiff_t)s->naxis;
    to->y_im = all + 4 * (ptrdiff_t)s->naxis;
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < s->naxis; i++) {
            double complex x = 0, y = 0;
            for (int j = 0; j < s->columns; j++) {
                x += s->axis[j + (ptrdiff_t)s->columns * i] * u[j];
                y += s->axis[j + (ptrdiff_t)s->columns * i] * u[s->plane + j];
            }
            if (!pass) {
                largest = cabs(x) > cabs(largest) ? x : largest;
                largest = cabs(y) > cabs(largest) ? y : largest;
                continue;
            }
            to->z[i] = z[i];
            to->x_re[i] = creal(x / largest);
            to->x_im[i] = cimag(x / largest);
            to->y_re[i] = creal(y / largest);
            to->y_im[i] = cimag(y / largest);
        }
    return ROTID_OK;
}

double speeds_margin(const struct machine *machine, double speed)
{
    double low = machine->low, high = machine->high;
    if (speed < low)
        return (low - speed) / low;
    if (speed > high)
        return (speed - high) / high;
    return -fmin((speed - low) / low, (high - speed) / high);
}

static int fill_peaks(struct run *r, int i, struct critical_speed *to)
{
    const struct machine *machine = r->machine;
    struct system *s = &r->system;
    double here = r->critical[i].speed, from = here / 2, end = fmin(here * 2, fmax(here * 1.02, r->speed[r->options->count - 1]));
    to->peaks = POOL_ARRAY(r->pool, struct peak, machine->nprobe);
    if (!to->peaks)
        return ROTID_ERROR_MEMORY;
    for (int j = 0; j < r->ncritical; j++) { /* up to half-way to the next one */
        double other = r->critical[j].speed, middle = (here + other) / 2;
        if (j < i && other < here * (1 - 1e-6))
            from = fmax(from, middle);
        if (j > i && other > here * (1 + 1e-6))
            end = fmin(end, middle);
    }
    for (int p = 0; p < machine->nprobe && machine->nunbalance; p++) {
        struct peak peak;
        if (creal(r->critical[i].pair.lambda) > -1e-9 * here || response_peak(s, p, from, here, end, &peak))
            continue; /* without damping the peak is infinite */
        to->peaks[to->npeaks++] = peak;
        if (isfinite(peak.amplification) && !(peak.amplification <= to->amplification))
            to->amplification = peak.amplification;
    }
    return ROTID_OK;
}

static int fill_criticals(struct run *r)
{
    struct speeds *out = r->out;
    int status = ROTID_OK;
    out->ncritical_speeds = r->ncritical;
    out->critical_speeds = POOL_ARRAY(r->pool, struct critical_speed, r->ncritical);
    for (int i = 0; i < r->ncritical && out->critical_speeds && !status; i++) {
        struct critical_speed *to = &out->critical_speeds[i];
        const struct pair *pair = &r->critical[i].pair;
        enum whirl whirl = pair_whirl(&r->system, pair->u);
        *to = (struct critical_speed){.number = i + 1,
                                      .speed_rpm = r->critical[i].speed / RPM,
                                      .std = NAN,
                                      .ci95 = {NAN, NAN},
                                      .whirl = whirl_words[whirl],
                                      .log_decrement = decrement(pair->lambda),
                                      .damping_ratio = ratio(pair->lambda),
                                      .amplification = NAN,
                                      .margin = {NAN, {NAN, NAN}, NAN, NAN},
                                      .mode = r->critical[i].mode + 1};
        status = fill_shape(r, pair->u, to);
        if (!status && whirl != WHIRL_BACKWARD)
            status = fill_peaks(r, i, to);
        int has_response = r->machine->nprobe && r->machine->nunbalance && to->damping_ratio > 0;
        if (!r->machine->has_operation || whirl == WHIRL_BACKWARD || (has_response && !to->npeaks))
            continue; /* what has no peak is no critical speed to be kept away from */
        double judged = to->npeaks ? to->peaks[0].speed_rpm * RPM : r->critical[i].speed;
        for (int p = 1; p < to->npeaks; p++) /* the peak that is nearest to the range */
            if (speeds_margin(r->machine, to->peaks[p].speed_rpm * RPM) < speeds_margin(r->machine, judged))
                judged = to->peaks[p].speed_rpm * RPM;
        to->margin.value = speeds_margin(r->machine, judged);
        to->margin.required = r->machine->margin > 0 ? r->machine->margin : NAN;
    }
    return out->critical_speeds ? status : ROTID_ERROR_MEMORY;
}

static int fill_response(struct run *r)
{
    const struct machine *machine = r->machine;
    struct system *s = &r->system;
    double to = r->speed[r->options->count - 1], from = fmax(r->speed[0], to / CURVE);
    double complex *q = POOL_ARRAY(r->pool, double complex, s->size);
    int count = CURVE;
    double *speed = POOL_ARRAY(r->pool, double, CURVE + 9 * (size_t)r->ncritical);
    if (!machine->nprobe || !machine->nunbalance)
        return ROTID_OK;
    if (!speed || !q)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < CURVE; i++)
        speed[i] = from + (to - from) * i / (CURVE - 1);
    for (int i = 0; i < r->ncritical; i++) /* within the half-power width of each */
        for (int j = -4; j <= 4; j++) {
            double at = r->critical[i].speed * (1 + j / 2.0 * fmax(1e-4, ratio(r->critical[i].pair.lambda)));
            if (at > from && at < to)
                speed[count++] = at;
        }
    sort_doubles((size_t)count, speed);
    r->out->nunbalance = machine->nprobe;
    r->out->unbalance = POOL_ARRAY(r->pool, struct probe_response, machine->nprobe);
    for (int p = 0; p < machine->nprobe && r->out->unbalance; p++) {
        struct probe_response *own = &r->out->unbalance[p];
        *own = (struct probe_response){machine->probe[p].name, count, speed, POOL_ARRAY(r->pool, double, count),
                                       POOL_ARRAY(r->pool, double, count)};
        if (!own->amplitude_m || !own->phase_deg)
            return ROTID_ERROR_MEMORY;
    }
    for (int i = 0; i < count && r->out->unbalance; i++) {
        int singular = response_at(s, speed[i], q);
        for (int p = 0; p < machine->nprobe; p++) {
            double complex motion = probe_motion(s, p, q);
            double lag = -carg(motion) * 180 / pi;
            r->out->unbalance[p].amplitude_m[i] = singular ? NAN : cabs(motion);
            r->out->unbalance[p].phase_deg[i] = singular ? NAN : lag < 0 ? lag + 360 : lag;
        }
    }
    for (int i = 0; i < count; i++)
        speed[i] /= RPM;
    return r->out->unbalance ? ROTID_OK : ROTID_ERROR_MEMORY;
}

/* The critical speeds once more with a larger basis. */
static int check_basis(struct run *r)
{
    struct pool scratch;
    struct run more = *r;
    int failed, count = 0, status;
    pool_open(&scratch, r->pool->allocator);
    more.pool = &scratch;
    more.basis = (struct basis_size){r->basis.modes + r->basis.modes / 2, r->basis.coupled + r->basis.coupled / 2, 1};
    status = system_build(&scratch, r->machine, r->job, &r->values, &r->system, &more.basis, &more.system, &failed);
    for (int i = 0; i < r->ncritical && !status; i++) {
        struct critical again = {.speed = r->critical[i].speed};
        if (pair_new(&scratch, more.system.size, &again.pair))
            status = ROTID_ERROR_MEMORY;
        if (!status && !system_transfer(&r->system, &r->critical[i].pair, &more.system, &again.pair) &&
            !pair_synchronise(&more.system, r->options->harmonic, &again.speed, &again.pair)) {
            r->out->basis_error = fmax(r->out->basis_error, fabs(again.speed / r->critical[i].speed - 1));
            count++;
        }
    }
    if (count < r->ncritical)
        r->out->basis_error = NAN;
    pool_close(&scratch);
    return status;
}

static int fill(struct run *r)
{
    double reference = r->machine->has_operation ? r->machine->low : r->speed[r->options->count - 1];
    int mode, status = fill_campbell(r);
    if (!status)
        status = fill_criticals(r);
    if (!status)
        status = fill_response(r);
    if (!status)
        status = static_loads(r->pool, &r->system, reference, r->out);
    if (!status)
        status = map_make(r->pool, &r->system, reference, 2 * r->speed[r->options->count - 1], r->out);
    if (!status)
        status = check_basis(r);
    double onset = onset_find(&r->system, &r->tracks, &mode);
    r->out->stability = (struct stability){onset / RPM, mode < 0 ? ROTID_NONE : mode + 1, NAN};
    return status;
}

int speeds_run(struct pool *pool, const struct machine *machine, const struct job *job, const double *x,
               const rotid_fit_result *fit, const struct speeds_options *options, const rotid_environment *environment,
               struct message_list *notes, struct speeds *out)
{
    struct run r = {.pool = pool, .machine = machine, .job = job, .options = options, .out = out};
    *out = (struct speeds){.harmonic = options->harmonic,
                           .low_rpm = machine->has_operation ? machine->low / RPM : NAN,
                           .high_rpm = machine->has_operation ? machine->high / RPM : NAN};
    int status = machine_nominal(pool, machine, x, &r.values);
    if (!status)
        status = find_range(&r, notes);
    if (!status)
        status = fill(&r);
    return status ? status
                  : bands_make(pool, machine, job, &r.values, fit, options, environment, &r.system, &r.basis, &r.tracks,
                               r.ncritical, r.critical, notes, out);
}
