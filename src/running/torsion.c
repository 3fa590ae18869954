/* Torsional natural frequencies of the machine: the rotor of the test with the disks of the machine by their polar inertia, on
 * bearings that hold no torque. With C the covariance of the unknowns u as fitted, s of the factors c of *CHANGE,
 *   std f/f = sqrt(g'C g + sum (d ln f/d ln c s)^2),   g = d ln f/du by differences, u of machine_by_logarithm. */
#include "running/running.h"

#define MODES 5
#define STEP  1e-4 /* of a logarithm, on both sides: differences of frequencies to 1e-8 */

struct torsion {
    const struct machine *machine;
    struct job job; /* of torsion */
    struct machine_values values;
    double *x; /* of the values */
};

/* hz [MODES], NaN beyond those of the model */
static int frequencies(struct pool *pool, const struct torsion *t, double *hz)
{
    struct pool scratch;
    struct rotor rotor;
    struct spectrum spectrum = {0};
    pool_open(&scratch, pool->allocator);
    int status = machine_rotor(&scratch, t->machine, &t->job, &t->values, &rotor);
    if (!status)
        status = spectrum_compute_parts(&scratch, t->job.models, &rotor, 0, NULL, NULL, ROTID_GUYAN, MODES, 0, &spectrum);
    for (int k = 0; k < MODES; k++)
        hz[k] = !status && k < spectrum.count ? spectrum.full_hz[k] : NAN;
    pool_close(&scratch);
    return status;
}

/* rate [MODES] := d ln f by a value at that step on both sides, `by` of what is differentiated by */
static int differentiate(struct pool *pool, const struct torsion *t, double *value, double step, double by, double *rate)
{
    double side[2][MODES], nominal = *value;
    int status = ROTID_OK;
    for (int i = 0; i < 2 && !status; i++) {
        *value = nominal + (i ? step : -step);
        status = frequencies(pool, t, side[i]);
    }
    *value = nominal;
    for (int k = 0; k < MODES && !status; k++)
        rate[k] = log(side[1][k] / side[0][k]) / (2 * by);
    return status;
}

/* variance [MODES] of ln f */
static int spread(struct pool *pool, struct torsion *t, const rotid_fit_result *fit, double *variance)
{
    int n = t->job.unknowns.nparameter, status = ROTID_OK;
    double *rate = POOL_ARRAY(pool, double, (size_t)MODES *(size_t)(n + 1)), *changed = rate + (ptrdiff_t)MODES * n;
    if (!rate)
        return ROTID_ERROR_MEMORY;
    for (int p = 0; p < n && fit && !status; p++) {
        int logarithm = machine_by_logarithm(t->machine, &t->job, p);
        double step = STEP * (logarithm ? t->x[p] : fit->std[p]);
        if (fit->std[p] > 0 && isfinite(step) && machine_has_unknown(t->machine, &t->job, p))
            status = differentiate(pool, t, &t->x[p], step, logarithm ? STEP : step, rate + (ptrdiff_t)MODES * p);
    }
    for (int p = 0; p < n && fit && !status; p++)
        for (int q = 0; q < n; q++)
            for (int k = 0; k < MODES && isfinite(fit->std[p]) && isfinite(fit->std[q]); k++)
                variance[k] += rate[k + (ptrdiff_t)MODES * p] * rate[k + (ptrdiff_t)MODES * q] *
                               machine_covariance(t->machine, &t->job, fit, p, q);
    for (int i = 0; i < t->machine->nchange && !status; i++) {
        double std = t->machine->change[i].std;
        if (std > 0)
            status = differentiate(pool, t, &t->values.change[i], STEP * t->values.change[i], STEP, changed);
        for (int k = 0; k < MODES && std > 0 && !status; k++)
            variance[k] += changed[k] * changed[k] * std * std;
    }
    return status;
}

int torsion_run(struct pool *pool, const struct machine *machine, const struct job *job, const double *x,
                const rotid_fit_result *fit, struct message_list *notes, rotid_speeds *out)
{
    struct torsion t = {.machine = machine, .x = POOL_ARRAY(pool, double, machine_unknowns(machine, job))};
    double hz[MODES], variance[MODES] = {0};
    if (!t.x)
        return ROTID_ERROR_MEMORY;
    for (int p = 0; p < machine_unknowns(machine, job); p++)
        t.x[p] = x[p];
    int status = job_of_type(pool, job, MODE_TORSION, &t.job);
    if (!status)
        status = machine_nominal(pool, machine, t.x, &t.values);
    if (!status)
        status = frequencies(pool, &t, hz);
    if (!status)
        status = spread(pool, &t, fit, variance);
    if (status == ROTID_ERROR_MEMORY)
        return status;
    for (int i = 0; i < machine->ndisk && !status; i++)
        if (machine->disk[i].mass > 0 && !(machine->disk[i].polar > 0))
            message_warn(notes, "the disk of the machine at %.6g m has no polar inertia, which torsion needs",
                         machine->disk[i].position);
    out->torsion = status ? NULL : POOL_ARRAY(pool, rotid_torsional_frequency, MODES);
    for (int k = 0; k < MODES && out->torsion && isfinite(hz[k]); k++)
        out->torsion[out->ntorsion++] =
            (rotid_torsional_frequency){.number = k + 1, .frequency_hz = hz[k], .std_hz = hz[k] * sqrt(fmax(0, variance[k]))};
    return status || out->torsion ? ROTID_OK : ROTID_ERROR_MEMORY;
}
