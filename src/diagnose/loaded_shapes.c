#include "diagnose/loaded_shapes.h"

#include <math.h>
#include <string.h>

#include "diagnose/causes/sensor.h"
#include "diagnose/roving_accelerometer.h"

#define ROOM   2.0
#define UNSURE 0.02 /* of the change of a shape: by the moduli that the fit has not found yet, and by the mass */
#define NODE   0.1  /* of the largest component: closer to a node the hammer hardly moves the mode */

/* Where the data of sensor s stand in the raw ones, which a correction may have put elsewhere. */
static int raw_sensor(const struct job *job, int s)
{
    int id = job->rotor.sensor[s].id, raw = 0;
    for (int c = job->measurement.ncorrection - 1; c >= 0; c--) {
        const struct correction *correction = &job->measurement.correction[c];
        if (!strcmp(correction->id, "sensor_swap") && (correction->sensor[0] == id || correction->sensor[1] == id))
            id = correction->sensor[correction->sensor[0] == id];
    }
    while (raw + 1 < job->measurement.raw->nsensor && job->measurement.raw->sensor[raw].id != id)
        raw++;
    return raw;
}

/* The deviation, and that of the raw data, which a deck is written from, in proportion. */
static void widen(double *std, double *raw, double more)
{
    double before = *std;
    *std = hypot(before, more);
    if (raw && before > 0)
        *raw *= *std / before;
}

static double *raw_value(struct job *job, double *of, int s, int k)
{
    return of ? &of[raw_sensor(job, s) + (ptrdiff_t)k * job->measurement.raw->nsensor] : NULL;
}

/* The model has the mass spread over all sensors, so a shape that is free of the accelerometer gets what that does to it. */
static void spread_mass(struct job *job, const struct weighing *w, int m, double mass)
{
    int k = w->columns.mode[m].k;
    const double *phi = w->phi + (ptrdiff_t)m * w->npoint, *spread = w->spread + (ptrdiff_t)m * w->npoint;
    double *shape = job->measurement.shape + (ptrdiff_t)k * w->npoint, product = 0, square = 0;
    for (int s = 0; s < w->npoint; s++)
        if (isfinite(shape[s])) {
            product += shape[s] * phi[s];
            square += phi[s] * phi[s];
        }
    for (int s = 0; s < w->npoint; s++) {
        double *raw = raw_value(job, job->measurement.raw ? job->measurement.raw->shape : NULL, s, k),
               more = product / square * mass * spread[s];
        if (!isfinite(shape[s]))
            continue;
        shape[s] += more;
        if (raw)
            *raw += more;
    }
}

int loaded_shapes_correct(struct job *job, const struct weighing *w, double mass)
{
    int corrected = 0;
    for (int m = 0; m < w->nmode && job_fits_shapes(job); m++) {
        int k = w->columns.mode[m].k;
        const double *phi = w->phi + (ptrdiff_t)m * w->npoint;
        double largest = 0;
        for (int s = 0; s < w->npoint; s++)
            if (isfinite(job->measurement.shape[s + (ptrdiff_t)k * w->npoint]))
                largest = fmax(largest, fabs(phi[s]));
        int known = w->hammer >= 0 && fabs(phi[w->hammer]) > NODE * largest;
        corrected += known;
        for (int s = 0; s < w->npoint && largest > 0; s++) {
            ptrdiff_t at = s + (ptrdiff_t)k * w->npoint, model = s + (ptrdiff_t)m * w->npoint;
            double *raw_std = raw_value(job, job->measurement.raw ? job->measurement.raw->shape_std : NULL, s, k),
                   *raw = raw_value(job, job->measurement.raw ? job->measurement.raw->shape : NULL, s, k),
                   size = mass * (w->square[model] + fabs(w->others[model])), share = fabs(phi[s]) / largest;
            if (!isfinite(job->measurement.shape[at]))
                continue;
            if (!known) {
                widen(&job->measurement.shape_std[at], raw_std, ROOM * size * share);
                continue;
            }
            double change = moving_mass_residue(mass, w->square[model], w->others[model], w->bend[model], w->across[model],
                                                w->across_bend[model], phi[s] / phi[w->hammer]);
            job->measurement.shape[at] /= change;
            if (raw)
                *raw /= change;
            widen(&job->measurement.shape_std[at], raw_std, UNSURE * fabs(change - 1) * share);
        }
        if (known)
            spread_mass(job, w, m, mass);
    }
    return corrected;
}

void loaded_shapes_allow(struct job *job, const struct weighing *w, double mass)
{
    for (int m = 0; m < w->nmode && job_fits_shapes(job); m++) {
        int k = w->columns.mode[m].k;
        const double *phi = w->phi + (ptrdiff_t)m * w->npoint;
        double largest = 0;
        for (int s = 0; s < w->npoint; s++)
            largest = fmax(largest, fabs(phi[s]));
        for (int s = 0; s < w->npoint && largest > 0; s++) {
            ptrdiff_t at = s + (ptrdiff_t)k * w->npoint, model = s + (ptrdiff_t)m * w->npoint;
            if (isfinite(job->measurement.shape[at]))
                widen(&job->measurement.shape_std[at],
                      raw_value(job, job->measurement.raw ? job->measurement.raw->shape_std : NULL, s, k),
                      mass * (w->square[model] + fabs(w->others[model])) * fabs(phi[s]) / largest);
        }
    }
}
