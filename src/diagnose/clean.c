/* Faults of the measurement chain and the level of the noise: found by the checks, said, taken out of the judged data. */
#include <math.h>
#include <string.h>

#include "diagnose/accelerometer.h"
#include "diagnose/causes/catalogue.h"
#include "diagnose/causes/sensor.h"
#include "diagnose/clean.h"
#include "diagnose/correct.h"
#include "diagnose/data.h"
#include "diagnose/noise_check.h"
#include "diagnose/scan.h"
#include "diagnose/sensor_check.h"
#include "model/deflection.h"

#define MOST_FAULTS 8
#define FALSE_ALARM 0.005
#define LEAST_SHIFT 5e-4 /* m: nobody glues a sensor more closely than that */
#define MUCH_LESS   0.7  /* of the stated noise */
#define MUCH_MORE   1.3
#define NOISIER     3.0  /* beyond any misjudgement: then it is the model that is wrong, in ways no cause has */
#define SHARED      0.45 /* correlation of neighbours; 0.08 is the error of its estimate, 0.2 what a smooth misfit adds */
#define LITTLE      2.0  /* chi2 a residual: with more, it is not noise that is left */
#define SLIGHT      0.05 /* excess of the smooth part of the noise that changes no verdict */

static const char *fault_id[] = {[FAULT_GAIN] = "sensor_gain",
                                 [FAULT_SIGN] = "sensor_sign",
                                 [FAULT_SWAP] = "sensor_swap",
                                 [FAULT_POSITION] = "sensor_position",
                                 [FAULT_DUPLICATE] = "duplicate_channel",
                                 [FAULT_DEAD] = "duplicate_channel"};

static const char *describe(struct pool *pool, enum sensor_fault_kind kind, double value, const int *id)
{
    switch (kind) {
    case FAULT_GAIN:
        return pool_format(pool, "sensor %d reads %.3g times what it should; its components are divided by that", id[0], value);
    case FAULT_SIGN:
        return pool_format(pool, "sensor %d has the wrong sign; it is turned", id[0]);
    case FAULT_SWAP:
        return pool_format(pool, "sensors %d and %d are exchanged; they are put back", id[0], id[1]);
    case FAULT_POSITION:
        return pool_format(pool, "sensor %d sits %.3g mm further %s than stated; it is moved", id[0], 1e3 * fabs(value),
                           value > 0 ? "right" : "left");
    case FAULT_DUPLICATE:
        return pool_format(pool, "sensor %d records what sensor %d records; it is left out", id[0], id[1]);
    default:
        return pool_format(pool, "sensor %d is dead; it is left out", id[0]);
    }
}

/* shapes of the fitted model on the nodes of the axis, each times its best scale to the measured one */
static int shape_data(struct engine *engine, struct columns *columns, struct shape_data *data)
{
    struct pool *pool = engine->pool;
    const struct job *job = &engine->job;
    const struct rotor_model *model = &columns->model;
    const struct prediction *p = &columns->functional.prediction;
    int nsensor = job->rotor.nsensor, nmode = columns->nmode;
    double *z = POOL_ARRAY(pool, double, nsensor), *shape = POOL_ARRAY(pool, double, (size_t)nsensor *(size_t)nmode),
           *std = POOL_ARRAY(pool, double, (size_t)nsensor *(size_t)nmode),
           *axis = POOL_ARRAY(pool, double, (size_t)model->naxis *(size_t)nmode);
    if (!z || !shape || !std || !axis)
        return ROTID_ERROR_MEMORY;
    for (int s = 0; s < nsensor; s++)
        z[s] = job->rotor.sensor[s].position;
    for (int m = 0; m < nmode; m++) {
        const struct columns_mode *mode = &columns->mode[m];
        ptrdiff_t from = (ptrdiff_t)mode->k * nsensor, to = (ptrdiff_t)m * nsensor;
        memcpy(shape + to, columns->functional.shape + from, (size_t)nsensor * sizeof *shape);
        memcpy(std + to, job->measurement.shape_std + from, (size_t)nsensor * sizeof *std);
        for (int i = 0; i < model->naxis; i++)
            axis[i + (ptrdiff_t)m * model->naxis] =
                mode->scale * model_deflection(model, i, p->phi + (ptrdiff_t)mode->pair * p->size);
    }
    *data = (struct shape_data){nsensor, nmode, z, shape, std, model->naxis, model->z, axis};
    return ROTID_OK;
}

static int correct_fault(struct engine *engine, const struct sensor_fault *fault)
{
    struct job *job = &engine->job;
    enum sensor_fault_kind kind = fault->kind == FAULT_GAIN && fault->value < 0 ? FAULT_SIGN : fault->kind;
    int two = fault->other >= 0, nsensor = job->rotor.nsensor;
    rotid_data_finding finding = {.id = fault_id[kind],
                                  .nsensors = 1 + two,
                                  .sensors = POOL_ARRAY(engine->pool, int, 2),
                                  .value = kind == FAULT_GAIN || kind == FAULT_POSITION ? fault->value : NAN,
                                  .std = fault->std,
                                  .chi2_drop = fault->chi2_drop};
    if (!finding.sensors)
        return ROTID_ERROR_MEMORY;
    finding.sensors[0] = job->rotor.sensor[fault->sensor].id;
    finding.sensors[1] = two ? job->rotor.sensor[fault->other].id : 0;
    finding.text = describe(engine->pool, kind, fault->value, finding.sensors);
    if (kind == FAULT_DEAD) { /* nothing to put right: as if it had not been there */
        for (int k = 0; k < job->measurement.nmode; k++)
            job->measurement.shape[fault->sensor + (ptrdiff_t)k * nsensor] = NAN;
        return data_add_finding(engine, &finding);
    }
    struct correction correction = {.nsensor = 1 + two,
                                    .sensor = {finding.sensors[0], finding.sensors[1]},
                                    .value = isfinite(finding.value) ? finding.value : 1};
    return data_correct(engine, &finding, &correction);
}

/* A cause that is an approximation, or an accelerometer that went from sensor to sensor, stands in the model already, and the
 * stated noise holds what it leaves. */
static int allows_for_more(const struct rotor *rotor)
{
    for (int e = 0; e < rotor->neffect; e++) {
        const struct cause_kind *cause = catalogue_of(&rotor->effect[e]);
        if (cause &&
            (cause->discrepancy_frequency > 0 || cause->discrepancy_shape > 0 || is_moving_accelerometer(&rotor->effect[e])))
            return 1;
    }
    return 0;
}

/* The stated noise is kept where it is a little too large: a user may have allowed for what a model leaves. Where it is a little
 * too small, the second-order part of a large effect may be it; that is decided behind the fits (`least` 1). */
static int is_misstated(const struct engine *engine, const struct noise_estimate *noise, double least)
{
    if (!noise->usable || !noise->misstated)
        return 0;
    if (noise->factor < 1)
        return noise->factor < MUCH_LESS && !engine->job.measurement.has_noise_floor && !allows_for_more(&engine->job.rotor);
    return noise->factor > least && noise->factor < NOISIER;
}

/* The level of the noise by what no cause can produce. r [nrow of the scan] is the residual of any model. */
static int check_noise(struct engine *engine, const struct scan *scan, const double *r, struct noise_estimate *noise)
{
    int first = scan->nfrequency, rows = scan->nrow - first, columns = scan->nbasis + scan->nitem;
    *noise = (struct noise_estimate){.factor = 1};
    double *part = POOL_ARRAY(engine->pool, double, (size_t)(rows > 0 ? rows : 0) * (size_t)columns);
    if (!part)
        return ROTID_ERROR_MEMORY;
    for (int j = 0; j < columns && rows > 0; j++) {
        const double *column = j < scan->nbasis ? scan->basis + (ptrdiff_t)j * scan->nrow
                                                : scan->column + (ptrdiff_t)(j - scan->nbasis) * scan->nrow;
        memcpy(part + (ptrdiff_t)j * rows, column + first, (size_t)rows * sizeof *part);
    }
    return rows > 0 ? noise_check(engine->pool, rows, columns, r + first, part, noise) : ROTID_OK;
}

/* Correlation between neighbours and level of the noise from differences, which a smooth misfit hardly touches: first differences
 * have the variance 2 sigma^2 (1 - rho), second ones (3 - rho) times that. rho NaN where there are too few. */
static void neighbours(const struct engine *engine, const double *r, double *rho, double *sigma)
{
    const struct job *job = &engine->job;
    double first = 0, second = 0;
    int nsensor = job->rotor.nsensor, row = 0, nfirst = 0, nsecond = 0;
    for (int k = 0; k < job->measurement.nmode; k++)
        row += !engine->holdout[k];
    for (int k = 0; k < job->measurement.nmode; k++) {
        int run = 0; /* neighbours in a row that were measured */
        for (int s = 0; s < nsensor && !engine->holdout[k]; s++) {
            if (!isfinite(job->measurement.shape[s + (ptrdiff_t)k * nsensor])) {
                run = 0;
                continue;
            }
            double d1 = run > 0 ? r[row] - r[row - 1] : 0, d2 = run > 1 ? r[row] - 2 * r[row - 1] + r[row - 2] : 0;
            first += d1 * d1;
            second += d2 * d2;
            nfirst += run > 0;
            nsecond += run > 1;
            run++;
            row++;
        }
    }
    *rho = *sigma = NAN;
    if (nsecond < 50 || !(first > 0))
        return;
    first /= nfirst;
    *rho = fmin(3 - second / nsecond / first, 0.9);
    *sigma = sqrt(first / (2 * (1 - *rho)));
}

/* Factor on the noise of smooth shapes where neighbours share it, 1 where they do not: the spectrum of such noise rises to
 * (1 + rho)/(1 - rho) towards long waves. Only where the fit has left little else. */
static double shared_noise(const struct engine *engine, const struct scan *scan, const double *r)
{
    double rho, sigma, chi2 = 0;
    for (int i = scan->nfrequency; i < scan->nrow; i++)
        chi2 += r[i] * r[i];
    neighbours(engine, r, &rho, &sigma);
    if (!(rho > SHARED) || chi2 > LITTLE * (scan->nrow - scan->nfrequency))
        return 1;
    return fmin(fmax(1, sigma * sqrt((1 + rho) / (1 - rho))), NOISIER);
}

int data_colour(struct engine *engine, const struct scan *scan, const double *r, int *changed)
{
    struct noise_estimate noise;
    const struct job *job = &engine->job;
    *changed = 0;
    if (engine->coloured || !job_fits_shapes(job))
        return ROTID_OK;
    int status = check_noise(engine, scan, r, &noise);
    if (status)
        return status;
    double shared = shared_noise(engine, scan, r);
    int coloured = shared > 1 + SLIGHT;
    if (!coloured && !(is_misstated(engine, &noise, 1) && noise.factor > 1))
        return ROTID_OK;
    double factor = coloured ? shared : noise.factor;
    const char *text = pool_format(
        engine->pool,
        coloured ? "neighbouring sensors share their noise: its smooth part is %.2f times the stated level, which is used"
                 : "the noise of the shapes is %.2f times the stated one, which is used",
        factor);
    engine->coloured |= coloured;
    *changed = 1;
    double *base =
        engine->out->job.measurement.shape_std; /* another array where a cause has added its discrepancy to the judged one */
    for (ptrdiff_t i = 0; i < (ptrdiff_t)job->rotor.nsensor * job->measurement.nmode && base != job->measurement.shape_std; i++)
        base[i] *= factor;
    status = data_correct_noise(engine, "SHAPE", factor, coloured ? NAN : noise.std, text);
    engine->out->job.measurement.correction = job->measurement.correction;
    engine->out->job.measurement.ncorrection = job->measurement.ncorrection;
    return status;
}

int data_clean(struct engine *engine, const struct scan *scan, int *changed)
{
    struct job *job = &engine->job;
    struct noise_estimate noise;
    *changed = 0;
    if (!job_fits_shapes(job))
        return ROTID_OK;
    int status = check_noise(engine, scan, scan->r, &noise), nfault = 0;
    struct columns columns;
    struct shape_data data;
    struct sensor_fault fault[MOST_FAULTS];
    if (!status)
        status = columns_open(engine->pool, job, engine->number, engine->holdout, NULL, engine->fit->x, &columns);
    if (!status)
        status = shape_data(engine, &columns, &data);
    if (status)
        return status;
    if (is_misstated(engine, &noise, MUCH_MORE)) { /* the faults are judged by the noise that is there */
        double *std = POOL_ARRAY(engine->pool, double, (size_t)data.nsensor *(size_t)data.nmode);
        if (!std)
            return ROTID_ERROR_MEMORY;
        for (ptrdiff_t i = 0; i < (ptrdiff_t)data.nsensor * data.nmode; i++)
            std[i] = data.std[i] * noise.factor;
        data.std = std;
    }
    status = sensor_check(engine->pool, &data, FALSE_ALARM, MOST_FAULTS, fault, &nfault);
    for (int i = 0; i < nfault && !status; i++) {
        /* a moved sensor changes the order: later faults are given by their place in the order at the time of the check */
        struct sensor_fault now = fault[i];
        if (now.kind == FAULT_POSITION && fabs(now.value) < LEAST_SHIFT)
            continue;
        double z = data.z[fault[i].sensor], other = fault[i].other >= 0 ? data.z[fault[i].other] : NAN;
        for (int s = 0; s < job->rotor.nsensor; s++) {
            now.sensor = job->rotor.sensor[s].position == z ? s : now.sensor;
            now.other = job->rotor.sensor[s].position == other ? s : now.other;
        }
        status = correct_fault(engine, &now);
        *changed = 1;
    }
    if (!status && is_misstated(engine, &noise, MUCH_MORE)) {
        status = data_correct_noise(
            engine, "SHAPE", noise.factor, noise.std,
            pool_format(engine->pool, "the noise of the shapes is %.2f times the stated one, which is used", noise.factor));
        *changed = 1;
    }
    return status;
}
