#include "running/running.h"

#define BEYOND     1.3   /* times the running range */
#define NO_DAMPING 1e-12 /* of |lambda| */
#define CURVE      121   /* speeds of a response, beside those around critical speeds */

struct run {
    struct pool *pool;
    const struct speeds_options *options;
    struct search search;
    rotid_speeds *out;
};

/* ---- to results */

/* Of a mode without damping rounding is left of the real part. */
static double ratio(double complex lambda)
{
    return fabs(creal(lambda)) < NO_DAMPING * cabs(lambda) ? 0 : -creal(lambda) / cabs(lambda);
}

static double decrement(double complex lambda)
{
    return 2 * PI * ratio(lambda) * cabs(lambda) / cimag(lambda);
}

ORDER_BY(by_frequency, rotid_campbell_mode, it->frequency_hz, 0)

static int fill_campbell(struct run *r)
{
    rotid_speeds *out = r->out;
    const struct tracks *t = &r->search.tracks;
    out->ncampbell = t->nspeed;
    out->campbell = POOL_ARRAY(r->pool, rotid_campbell_speed, out->ncampbell);
    for (int i = 0; i < out->ncampbell && out->campbell; i++) {
        rotid_campbell_speed *to = &out->campbell[i];
        to->speed_rpm = t->speed[i] <= 2 * STANDSTILL * t->speed[t->nspeed - 1] ? 0 : t->speed[i] / RPM;
        to->modes = POOL_ARRAY(r->pool, rotid_campbell_mode, t->nmode);
        for (int m = 0; m < t->nmode && to->modes; m++) {
            const struct pair *pair = track_at(t, m, i);
            if (isfinite(creal(pair->lambda)))
                to->modes[to->nmodes++] = (rotid_campbell_mode){m + 1,
                                                                cimag(pair->lambda) / (2 * PI),
                                                                {NAN, NAN},
                                                                ratio(pair->lambda),
                                                                decrement(pair->lambda),
                                                                {NAN, NAN},
                                                                whirl_words[pair_whirl(&r->search.system, pair->u)]};
        }
        if (!to->modes)
            return ROTID_ERROR_MEMORY;
        qsort(to->modes, (size_t)to->nmodes, sizeof *to->modes, by_frequency);
    }
    return out->campbell ? ROTID_OK : ROTID_ERROR_MEMORY;
}

static int fill_shape(const struct run *r, const double complex *u, rotid_critical_speed *to)
{
    const struct system *s = &r->search.system;
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
            double complex at[2];
            system_orbit(s, s->axis + (ptrdiff_t)s->columns * i, u, at);
            if (!pass) {
                largest = cabs(at[0]) > cabs(largest) ? at[0] : largest;
                largest = cabs(at[1]) > cabs(largest) ? at[1] : largest;
                continue;
            }
            to->z[i] = z[i];
            to->x_re[i] = creal(at[0] / largest);
            to->x_im[i] = cimag(at[0] / largest);
            to->y_re[i] = creal(at[1] / largest);
            to->y_im[i] = cimag(at[1] / largest);
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

const rotid_response_peak *speeds_peak(const struct machine *machine, const rotid_critical_speed *critical)
{
    const rotid_response_peak *nearest = critical->npeaks ? &critical->peaks[0] : NULL;
    for (int p = 1; p < critical->npeaks; p++)
        if (speeds_margin(machine, critical->peaks[p].speed_rpm * RPM) < speeds_margin(machine, nearest->speed_rpm * RPM))
            nearest = &critical->peaks[p];
    return nearest;
}

double speeds_required(const struct machine *machine, double amplification, double speed)
{
    if (!machine->api617)
        return machine->margin > 0 ? machine->margin : NAN;
    if (!(amplification >= 2.5))
        return NAN;
    double raw = 17 * (1 - 1 / (amplification - 1.5));
    return speed < machine->low ? fmin(16, raw) / 100 : speed > machine->high ? fmin(26, 10 + raw) / 100 : 0;
}

static int fill_peaks(struct run *r, int i, rotid_critical_speed *to)
{
    const struct machine *machine = r->search.machine;
    struct system *s = &r->search.system;
    double here = r->search.critical[i].speed, from = here / 2,
           end = fmin(here * 2, fmax(here * 1.02, r->search.speed[r->options->count - 1]));
    to->peaks = POOL_ARRAY(r->pool, rotid_response_peak, machine->nprobe);
    if (!to->peaks)
        return ROTID_ERROR_MEMORY;
    for (int j = 0; j < r->search.ncritical; j++) { /* up to half-way to the next one */
        double other = r->search.critical[j].speed, middle = (here + other) / 2;
        if (j < i && other < here * (1 - 1e-6))
            from = fmax(from, middle);
        if (j > i && other > here * (1 + 1e-6))
            end = fmin(end, middle);
    }
    for (int p = 0; p < machine->nprobe && machine->nunbalance; p++) {
        rotid_response_peak peak;
        if (creal(r->search.critical[i].pair.lambda) > -1e-9 * here || response_peak(s, p, from, here, end, &peak))
            continue; /* without damping the peak is infinite */
        to->peaks[to->npeaks++] = peak;
        if (isfinite(peak.amplification) && !(peak.amplification <= to->amplification))
            to->amplification = peak.amplification;
    }
    return ROTID_OK;
}

static int fill_criticals(struct run *r)
{
    rotid_speeds *out = r->out;
    int status = ROTID_OK;
    out->ncritical_speeds = r->search.ncritical;
    out->critical_speeds = POOL_ARRAY(r->pool, rotid_critical_speed, r->search.ncritical);
    for (int i = 0; i < r->search.ncritical && out->critical_speeds && !status; i++) {
        rotid_critical_speed *to = &out->critical_speeds[i];
        const struct pair *pair = &r->search.critical[i].pair;
        enum whirl whirl = pair_whirl(&r->search.system, pair->u);
        *to = (rotid_critical_speed){.number = i + 1,
                                     .speed_rpm = r->search.critical[i].speed / RPM,
                                     .std = NAN,
                                     .ci95 = {NAN, NAN},
                                     .whirl = whirl_words[whirl],
                                     .log_decrement = decrement(pair->lambda),
                                     .log_decrement_ci95 = {NAN, NAN},
                                     .damping_ratio = ratio(pair->lambda),
                                     .amplification = NAN,
                                     .margin = {NAN, {NAN, NAN}, NAN, NAN},
                                     .mode = r->search.critical[i].mode + 1};
        status = fill_shape(r, pair->u, to);
        int by_unbalance = r->options->harmonic == 1, /* which turns once a revolution */
            has_response = by_unbalance && r->search.machine->nprobe && r->search.machine->nunbalance && to->damping_ratio > 0;
        if (!status && whirl != WHIRL_BACKWARD && by_unbalance)
            status = fill_peaks(r, i, to);
        if (!r->search.machine->has_operation || whirl == WHIRL_BACKWARD || (has_response && !to->npeaks))
            continue; /* what has no peak is no critical speed to be kept away from */
        const rotid_response_peak *peak = speeds_peak(r->search.machine, to);
        double judged = peak ? peak->speed_rpm * RPM : r->search.critical[i].speed;
        to->margin.value = speeds_margin(r->search.machine, judged);
        to->margin.required = speeds_required(r->search.machine, to->amplification, judged);
    }
    return out->critical_speeds ? status : ROTID_ERROR_MEMORY;
}

static int fill_response(struct run *r)
{
    const struct machine *machine = r->search.machine;
    struct system *s = &r->search.system;
    double to = r->search.speed[r->options->count - 1], from = fmax(r->search.speed[0], to / CURVE);
    double complex *q = POOL_ARRAY(r->pool, double complex, s->size);
    int count = CURVE;
    double *speed = POOL_ARRAY(r->pool, double, CURVE + 9 * (size_t)r->search.ncritical);
    if (!machine->nprobe || !machine->nunbalance)
        return ROTID_OK;
    if (!speed || !q)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < CURVE; i++)
        speed[i] = from + (to - from) * i / (CURVE - 1);
    for (int i = 0; i < r->search.ncritical; i++) /* within the half-power width of each */
        for (int j = -4; j <= 4; j++) {
            double at = r->search.critical[i].speed * (1 + j / 2.0 * fmax(1e-4, ratio(r->search.critical[i].pair.lambda)));
            if (at > from && at < to)
                speed[count++] = at;
        }
    sort_doubles((size_t)count, speed);
    r->out->nunbalance = machine->nprobe;
    r->out->unbalance = POOL_ARRAY(r->pool, rotid_probe_response, machine->nprobe);
    for (int p = 0; p < machine->nprobe && r->out->unbalance; p++) {
        rotid_probe_response *own = &r->out->unbalance[p];
        double *all = POOL_ARRAY(r->pool, double, 4 * (size_t)count);
        if (!all)
            return ROTID_ERROR_MEMORY;
        *own = (rotid_probe_response){machine->probe[p].name,    count, speed, all, all + count, all + 2 * (ptrdiff_t)count,
                                      all + 3 * (ptrdiff_t)count};
        for (int i = 0; i < count; i++)
            own->from_m[i] = own->to_m[i] = NAN;
    }
    for (int i = 0; i < count && r->out->unbalance; i++) {
        int singular = response_at(s, speed[i], q);
        for (int p = 0; p < machine->nprobe; p++) {
            double complex motion = probe_motion(s, p, q);
            double lag = -carg(motion) * 180 / PI;
            r->out->unbalance[p].amplitude_m[i] = singular ? NAN : cabs(motion);
            r->out->unbalance[p].phase_deg[i] = singular ? NAN : lag < 0 ? lag + 360 : lag;
        }
    }
    for (int i = 0; i < count; i++)
        speed[i] /= RPM;
    return r->out->unbalance ? ROTID_OK : ROTID_ERROR_MEMORY;
}

/* Once and twice a revolution, once and twice the line frequency: that of the grid, or of a converter. */
static int fill_excitation(struct run *r)
{
    const struct machine *machine = r->search.machine;
    double line = machine->line_hz > 0 ? 0 : machine->poles / 2;
    const rotid_excitation all[] = {
        {"1x", 1, 0}, {"2x", 2, 0}, {"line", line, machine->line_hz}, {"2x line", 2 * line, 2 * machine->line_hz}};
    if (!(machine->line_hz > 0 || machine->poles > 0))
        return ROTID_OK;
    r->out->nexcitation = POOL_LIST(r->pool, r->out->excitation, 4);
    if (!r->out->nexcitation)
        return ROTID_ERROR_MEMORY;
    memcpy(r->out->excitation, all, sizeof all);
    return ROTID_OK;
}

/* The critical speeds once more with a larger basis. */
static int check_basis(struct run *r)
{
    struct pool scratch;
    struct run more = *r;
    int failed, count = 0, status;
    pool_open(&scratch, r->pool->allocator);
    more.pool = &scratch;
    more.search.basis = (struct basis_size){r->search.basis.modes + r->search.basis.modes / 2,
                                            r->search.basis.coupled + r->search.basis.coupled / 2, 1};
    status = system_build(&scratch, r->search.machine, r->search.job, &r->search.values, &r->search.system, &more.search.basis,
                          &more.search.system, &failed);
    for (int i = 0; i < r->search.ncritical && !status; i++) {
        struct critical again = {.speed = r->search.critical[i].speed};
        if (pair_new(&scratch, more.search.system.size, &again.pair))
            status = ROTID_ERROR_MEMORY;
        if (!status && !system_transfer(&r->search.system, &r->search.critical[i].pair, &more.search.system, &again.pair) &&
            !pair_synchronise(&more.search.system, r->options->harmonic, &again.speed, &again.pair)) {
            r->out->basis_error = fmax(r->out->basis_error, fabs(again.speed / r->search.critical[i].speed - 1));
            count++;
        }
    }
    if (count < r->search.ncritical)
        r->out->basis_error = NAN;
    pool_close(&scratch);
    return status;
}

static int fill(struct run *r)
{
    double reference = r->search.machine->has_operation ? r->search.machine->low : r->search.speed[r->options->count - 1];
    int mode, status = fill_campbell(r);
    if (!status)
        status = fill_excitation(r);
    if (!status)
        status = fill_criticals(r);
    if (!status)
        status = fill_response(r);
    if (!status)
        status = static_loads(r->pool, &r->search.system, reference, r->out);
    if (!status)
        status =
            map_make(r->pool, &r->search.system, reference, 2 * r->search.speed[r->options->count - 1], r->out, &r->search.map);
    if (!status)
        status = check_basis(r);
    double onset = onset_find(&r->search.system, &r->search.followed, &mode);
    r->out->stability = (rotid_stability){onset / RPM, mode < 0 ? ROTID_NONE : mode + 1, NAN};
    return status;
}

int speeds_run(struct pool *pool, const struct machine *machine, const struct job *job, const double *x,
               const rotid_fit_result *fit, const struct speeds_options *options, const rotid_environment *environment,
               struct message_list *notes, rotid_speeds *out)
{
    struct run r = {.pool = pool,
                    .options = options,
                    .search = {.machine = machine,
                               .job = job,
                               .from = options->from,
                               .harmonic = options->harmonic,
                               .count = options->count,
                               .given = options->speed},
                    .out = out};
    double to = options->to > 0 ? options->to : machine->has_operation ? BEYOND * machine->high : 0;
    *out = (rotid_speeds){.harmonic = options->harmonic,
                          .low_rpm = machine->has_operation ? machine->low / RPM : NAN,
                          .high_rpm = machine->has_operation ? machine->high / RPM : NAN};
    int status = machine_nominal(pool, machine, x, &r.search.values);
    if (!status)
        status = to > 0 ? search_within(pool, to, notes, &r.search) : search_until(pool, 0, 3, 0, notes, &r.search);
    if (!status && isfinite(r.search.missed))
        message_warn(notes, "a mode crosses the speed near %.6g rpm at a place that was not found: a critical speed is missing",
                     r.search.missed / RPM);
    if (!status)
        status = fill(&r);
    if (!status && isnan(out->stability.onset_rpm) && r.search.followed.beyond > 0)
        message_add(notes, SEVERITY_WARNING, NULL, 0, 0,
                    "a mode at %.6g Hz grows, too high for the basis to tell its stability: expected what damps it, or no cross "
                    "coupling that drives it there",
                    r.search.followed.beyond / (2 * PI));
    if (!status)
        status = runup_compare(pool, machine, job, x, fit, notes, &out->nrunup, &out->runup);
    if (!status)
        status = torsion_run(pool, machine, job, x, fit, notes, out);
    return status ? status : bands_make(pool, &r.search, fit, options, environment, notes, out);
}
