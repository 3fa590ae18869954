#include "running/running.h"

#define GOLDEN  0.6180339887498949
#define GRAVITY 9.80665
#define HALF    0.70710678118654752

/* q += factor times m e W^2 (cos(W t + p), sin(W t + p)) = Re (1, -i) m e W^2 e^{ip} e^{iWt}; a grade permits m e in proportion
 * to the mass of the machine, which identified masses change */
static void add_force(const struct system *s, double speed, double factor, double complex *q)
{
    for (int i = 0; i < s->machine->nunbalance; i++) {
        const struct unbalance *own = &s->machine->unbalance[i];
        double size = own->grade > 0 ? own->value * (s->total_mass / own->mass) : own->value;
        double complex force = factor * size * speed * speed * cexp(I * own->phase);
        for (int j = 0; j < s->columns; j++) {
            q[j] += force * s->unbalance[j + (ptrdiff_t)s->columns * i];
            q[s->plane + j] -= I * force * s->unbalance[j + (ptrdiff_t)s->columns * i];
        }
    }
}

int response_at(struct system *s, double speed, double complex *q)
{
    memset(q, 0, (size_t)s->size * sizeof *q);
    system_at(s, speed);
    add_force(s, speed, 1, q);
    system_dynamic(s, I * speed, 0, s->d);
    if (complex_factor(s->size, s->d, s->pivot))
        return 1;
    complex_solve(s->size, 0, s->d, s->pivot, q);
    return 0;
}

double complex probe_motion(const struct system *s, int probe, const double complex *q)
{
    const double *row = s->probe + (ptrdiff_t)s->columns * probe;
    double angle = s->machine->probe[probe].angle;
    double complex sum = 0;
    for (int j = 0; j < s->columns; j++)
        sum += row[j] * (cos(angle) * q[j] + sin(angle) * q[s->plane + j]);
    return sum;
}

double response_rate(struct system *nominal, struct system side[2], double apart, int probe, double speed, double complex *work)
{
    size_t n = (size_t)nominal->size;
    double complex *below = work, *above = work + n * n, *q = work + 2 * n * n, *change = q + n;
    if (response_at(nominal, speed, q))
        return NAN;
    double complex motion = probe_motion(nominal, probe, q);
    for (int i = 0; i < 2; i++) {
        system_at(&side[i], speed);
        system_dynamic(&side[i], I * speed, 0, i ? above : below);
    }
    memset(change, 0, n * sizeof *change);
    for (int i = 0; i < 2; i++)
        add_force(&side[i], speed, (i ? 1 : -1) / apart, change);
    for (size_t col = 0; col < n; col++)
        for (size_t row = 0; row < n; row++)
            change[row] -= (above[row + n * col] - below[row + n * col]) / apart * q[col];
    complex_solve((int)n, 0, nominal->d, nominal->pivot, change); /* D is still factored */
    return creal(probe_motion(nominal, probe, change) / motion);
}

static double amplitude(struct system *s, int probe, double speed)
{
    return response_at(s, speed, s->right) ? INFINITY : cabs(probe_motion(s, probe, s->right));
}

/* The speed between a peak and `to` where the amplitude is `level`; NaN where it stays above, or rises again before. */
static double falls_to(struct system *s, int probe, double peak, double to, double level)
{
    double inside = peak, step = (to - peak) / 400, outside = NAN, before = INFINITY;
    for (int i = 1; i <= 400 && isnan(outside); i++) {
        double speed = peak + step * i, now = amplitude(s, probe, speed);
        if (now > before * (1 + 1e-9))
            return NAN;
        before = now;
        if (now <= level)
            outside = speed;
        else
            inside = speed;
    }
    for (int i = 0; i < 50 && isfinite(outside); i++) {
        double middle = (inside + outside) / 2;
        if (amplitude(s, probe, middle) <= level)
            outside = middle;
        else
            inside = middle;
    }
    return outside;
}

int response_peak(struct system *s, int probe, double from, double near, double to, rotid_response_peak *peak)
{
    double width = fmax(near - from, to - near) / 2, best = near, most = amplitude(s, probe, near);
    for (int pass = 0; pass < 24; pass++, width *= 0.6) { /* the nearest maximum: around the critical speed, then closer */
        double left = fmax(from, best - width), right = fmin(to, best + width);
        double l = amplitude(s, probe, left), r = amplitude(s, probe, right);
        if (l > most && l >= r) {
            best = left;
            most = l;
        } else if (r > most) {
            best = right;
            most = r;
        }
    }
    double a = fmax(from, best - 4 * width), b = fmin(to, best + 4 * width), c = b - GOLDEN * (b - a), d = a + GOLDEN * (b - a);
    double at_c = amplitude(s, probe, c), at_d = amplitude(s, probe, d);
    for (int i = 0; i < 60 && b - a > 1e-9 * b; i++)
        if (at_c > at_d) {
            b = d;
            d = c;
            at_d = at_c;
            at_c = amplitude(s, probe, c = b - GOLDEN * (b - a));
        } else {
            a = c;
            c = d;
            at_c = at_d;
            at_d = amplitude(s, probe, d = a + GOLDEN * (b - a));
        }
    best = (a + b) / 2;
    if (best < from + 1e-6 * best || best > to - 1e-6 * best)
        return 1;
    most = amplitude(s, probe, best);
    double low = falls_to(s, probe, best, best / 4, HALF * most), high = falls_to(s, probe, best, best * 4, HALF * most);
    *peak = (rotid_response_peak){s->machine->probe[probe].name, best / RPM, most, best / (high - low)};
    return 0;
}

/* ---- at rest under weight */

int static_loads(struct pool *pool, struct system *s, double speed, rotid_speeds *out)
{
    const struct machine *machine = s->machine;
    double complex *q = POOL_ARRAY(pool, double complex, s->size), orbit[2];
    out->nbearing_loads = machine->nbearing;
    out->bearing_loads = POOL_ARRAY(pool, rotid_bearing_load, machine->nbearing);
    if (!q || !out->bearing_loads)
        return ROTID_ERROR_MEMORY;
    out->weight_n = s->total_mass * GRAVITY;
    for (int j = 0; j < s->columns; j++)
        q[s->plane + j] = -GRAVITY * s->weight[j];
    system_at(s, speed);
    system_dynamic(s, 0, speed > 0 ? -1 : 0, s->d);
    if (complex_factor(s->size, s->d, s->pivot))
        return ROTID_ERROR_STIFFNESS;
    complex_solve(s->size, 0, s->d, s->pivot, q);
    for (int i = 0; i < machine->nbearing; i++) {
        const struct bearing *b = &machine->bearing[i];
        double k[4], c[4], f = machine_bearing_factor(s->machine, s->values, i, 0);
        coefficients_at(&b->film, speed, k, c, NULL, NULL);
        system_film(s, i, q, orbit);
        double x = creal(orbit[0]), y = creal(orbit[1]);
        out->bearing_loads[i] = (rotid_bearing_load){b->name, b->z, f * (k[XX] * x + k[XY] * y), f * (k[YX] * x + k[YY] * y)};
    }
    for (int i = 0; i < s->naxis; i++) {
        system_orbit(s, s->axis + (ptrdiff_t)s->columns * i, q, orbit);
        out->sag_m = fmax(out->sag_m, hypot(creal(orbit[0]), creal(orbit[1])));
    }
    return ROTID_OK;
}

/* ---- critical speed map: K q = W^2 (M - P) q with the stiffness of all bearings times a factor */

#define MAP_ROWS    17
#define MAP_DECADES 4

int map_make(struct pool *pool, struct system *s, double speed, double most, rotid_speeds *out, double complex ***vector)
{
    const struct machine *machine = s->machine;
    int n = s->columns, status = ROTID_OK;
    size_t square = (size_t)n * (size_t)n;
    struct pool scratch;
    pool_open(&scratch, pool->allocator);
    double *m = POOL_ARRAY(&scratch, double, square), *c = POOL_ARRAY(&scratch, double, square),
           *k = POOL_ARRAY(&scratch, double, square), *work = POOL_ARRAY(&scratch, double, quadratic_workspace(n));
    double complex *lambda = POOL_ARRAY(&scratch, double complex, 2 * (size_t)n),
                   *u = POOL_ARRAY(&scratch, double complex, 2 * square);
    out->map = POOL_ARRAY(pool, rotid_map_row, MAP_ROWS);
    *vector = POOL_ARRAY(pool, double complex *, MAP_ROWS);
    if (!m || !c || !k || !work || !lambda || !u || !out->map || !*vector)
        status = ROTID_ERROR_MEMORY;
    out->nmap = status ? 0 : MAP_ROWS;
    for (int row = 0; row < MAP_ROWS && !status; row++) {
        rotid_map_row *to = &out->map[row];
        to->stiffness_factor = pow(10, MAP_DECADES * (row / (MAP_ROWS - 1.0) - 0.5));
        memcpy(k, s->k, square * sizeof *k);
        for (int i = 0; i < machine->nbearing; i++) {
            const struct bearing *b = &machine->bearing[i];
            double kb[4], cb[4];
            coefficients_at(&b->film, speed, kb, cb, NULL, NULL);
            double stiff = (kb[XX] + kb[YY]) / 2 * machine_bearing_factor(s->machine, s->values, i, 0) * to->stiffness_factor;
            stiff = bearing_on_pedestal(b, speed, stiff);
            const double *v = s->bearing + (ptrdiff_t)n * i;
            for (int col = 0; col < n; col++)
                for (int r = 0; r < n; r++)
                    k[r + (ptrdiff_t)n * col] += stiff * v[r] * v[col];
        }
        memcpy(c, k, square * sizeof *k);
        int falls = cholesky_factor(n, c); /* the pull is stronger than such bearings */
        memset(c, 0, square * sizeof *c);
        for (size_t i = 0; i < square; i++)
            m[i] = -s->p[i];
        for (int i = 0; i < n; i++)
            m[i + (ptrdiff_t)n * i] += 1;
        to->speed_rpm = POOL_ARRAY(pool, double, 3 * (size_t)n);
        to->from_rpm = to->speed_rpm + n;
        to->to_rpm = to->from_rpm + n;
        (*vector)[row] = POOL_ARRAY(pool, double complex, square);
        if (!to->speed_rpm || !(*vector)[row])
            status = ROTID_ERROR_MEMORY;
        if (status || falls || quadratic_pairs(n, s->highest / 4, m, c, k, lambda, u, work, s->pivot))
            continue;
        for (;;) { /* by rising speed, of which there are few */
            int next = -1;
            double before = to->nspeed_rpm ? to->speed_rpm[to->nspeed_rpm - 1] * RPM : 0;
            for (int i = 0; i < 2 * n; i++) {
                double w = cimag(lambda[i]);
                if (w > fabs(creal(lambda[i])) && w < most && w > before * (1 + 1e-12) && (next < 0 || w < cimag(lambda[next])))
                    next = i;
            }
            if (next < 0 || to->nspeed_rpm == n)
                break;
            memcpy((*vector)[row] + (ptrdiff_t)n * to->nspeed_rpm, u + (ptrdiff_t)n * next, (size_t)n * sizeof *u);
            to->from_rpm[to->nspeed_rpm] = to->to_rpm[to->nspeed_rpm] = NAN;
            to->speed_rpm[to->nspeed_rpm++] = cimag(lambda[next]) / RPM;
        }
    }
    pool_close(&scratch);
    return status;
}

double map_rate(const struct system *nominal, struct system side[2], double apart, double speed, const double complex *q)
{
    int n = nominal->columns;
    double above = 0, below = 0, square = speed * speed;
    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++) {
            ptrdiff_t at = i + (ptrdiff_t)n * j;
            double both = creal(conj(q[i]) * q[j]), k = side[1].k[at] - side[0].k[at],
                   m = side[1].own_mass[at] - side[1].p[at] - side[0].own_mass[at] + side[0].p[at];
            above += both * (k - square * m) / apart;
            below += both * ((i == j) - nominal->p[at]);
        }
    return above / (2 * square * below);
}
