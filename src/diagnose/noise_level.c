/* The level of the noise of the shapes: judged by what the best model so far leaves, said, used from there on. */
#include "diagnose/noise_level.h"

#include <math.h>
#include <string.h>

#include "diagnose/accelerometer.h"
#include "diagnose/causes/catalogue.h"
#include "diagnose/correct.h"
#include "diagnose/noise_check.h"

#define MUCH_LESS 0.7  /* of the stated noise */
#define WHOLE     1.5  /* chi2 a degree of freedom: with more, noise is not all that is left */
#define NOISIER   3.0  /* beyond any misjudgement: then it is the model that is wrong, in ways no cause has */
#define SHARED    0.45 /* correlation of neighbours; 0.08 is the error of its estimate, 0.2 what a smooth misfit adds */
#define LITTLE    2.0  /* chi2 a residual: with more, it is not noise that is left */
#define SLIGHT    0.05 /* excess of the smooth part of the noise that changes no verdict */

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

/* Not where the best model leaves more than that noise: then it is the model that is wrong. The stated noise is kept where it is
 * a little too large: a user may have allowed for what a model leaves. chi2: of the shapes, a degree of freedom. */
static int is_misstated(const struct engine *engine, const struct noise_estimate *noise, double chi2)
{
    if (!noise->usable || !noise->misstated || chi2 > WHOLE * noise->factor * noise->factor)
        return 0;
    if (noise->factor < 1)
        return noise->factor < MUCH_LESS && !engine->job->measurement.has_noise_floor && !allows_for_more(&engine->job->rotor);
    return noise->factor < NOISIER;
}

/* The level of the noise by what no cause can produce. */
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
    const struct job *job = engine->job;
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
static double shared_noise(const struct engine *engine, const double *r, double chi2)
{
    double rho, sigma;
    neighbours(engine, r, &rho, &sigma);
    if (!(rho > SHARED) || chi2 > LITTLE)
        return 1;
    return fmin(fmax(1, sigma * sqrt((1 + rho) / (1 - rho))), NOISIER);
}

int noise_settle(struct engine *engine, const struct scan *scan, const double *r, int *changed)
{
    struct noise_estimate noise;
    const struct job *job = engine->job;
    *changed = 0;
    if (engine->coloured || !job_fits_shapes(job))
        return ROTID_OK;
    int status = check_noise(engine, scan, r, &noise);
    if (status)
        return status;
    int dof = scan->dof - scan->nfrequency;
    double chi2 = 0;
    for (int i = scan->nfrequency; i < scan->nrow; i++)
        chi2 += r[i] * r[i] / (dof > 0 ? dof : 1);
    double shared = shared_noise(engine, r, chi2);
    int coloured = shared > 1 + SLIGHT;
    if (!coloured && !is_misstated(engine, &noise, chi2))
        return ROTID_OK;
    double factor = coloured ? shared : noise.factor;
    const char *text = pool_format(
        engine->pool,
        coloured ? "neighbouring sensors share their noise: its smooth part is %.2f times the stated level, which is used"
                 : "the noise of the shapes is %.2f times the stated one, which is used",
        factor);
    engine->coloured |= coloured;
    *changed = 1;
    double *base = engine->out->judged.state->job.measurement
                       .shape_std; /* another array where a cause has added its discrepancy to the judged one */
    for (ptrdiff_t i = 0; i < (ptrdiff_t)job->rotor.nsensor * job->measurement.nmode && base != job->measurement.shape_std; i++)
        base[i] *= factor;
    status = data_correct_noise(engine, "SHAPE", factor, coloured ? NAN : noise.std, text);
    engine->out->judged.state->job.measurement.correction = job->measurement.correction;
    engine->out->judged.state->job.measurement.ncorrection = job->measurement.ncorrection;
    return status;
}
