/* From which mode measured ones are counted. A rotor on soft supports vibrates on them first, as a rigid body: whoever counts what
 * was measured calls that mode 1, whoever counts bending modes does not. Both are usual, and the data tell them apart. */
#include "run/run.h"

#include <math.h>

/* root mean square over the measured modes: the partner of mode n is mode n + above of the spectrum */
static double misfit(const struct job *job, const struct spectrum *spectrum, int above)
{
    const struct job_measurement *measured = &job->measurement;
    double sum = 0;
    for (int k = 0; k < measured->nmode; k++) {
        int j = measured->number[k] + above - 1;
        if (j >= spectrum->count || !(spectrum->full_hz[j] > 0))
            return INFINITY;
        double shape = 0, frequency = log(measured->frequency_hz[k] / spectrum->full_hz[j]);
        if (measured->shape) {
            double mac = rotid_mac(spectrum->nmaster, measured->shape + (ptrdiff_t)k * spectrum->nmaster,
                                   spectrum->shape + (ptrdiff_t)j * spectrum->nmaster);
            shape = isfinite(mac) ? 1 - mac : 0;
        }
        sum += frequency * frequency + shape * shape;
    }
    return sqrt(sum / measured->nmode);
}

static int choose(struct pool *scratch, struct job *job)
{
    struct numbering *numbering = &job->measurement.numbering;
    struct rotor rotor = job->rotor;
    struct models *models = job->options.solid ? NULL : job->models;
    struct rotor_model elastic;
    struct spectrum spectrum;
    int failed, status = model_open(scratch, models, &rotor, 0, NULL, 1, &elastic, &failed);
    if (status || !elastic.equations.nrigid)
        return status;
    rotor.count_all = 1;
    status = spectrum_compute_parts(scratch, models, &rotor, 0, NULL, NULL, ROTID_GUYAN,
                                    comparison_highest(job) + elastic.equations.nrigid, 0, &spectrum);
    if (status)
        return status;
    numbering->nsupport = elastic.equations.nrigid - spectrum.nrigid;
    if (numbering->stated || numbering->nsupport < 1)
        return ROTID_OK;
    numbering->elastic = misfit(job, &spectrum, numbering->nsupport);
    numbering->all = misfit(job, &spectrum, 0);
    job->rotor.count_all = numbering->all < NUMBERING_CLEAR * numbering->elastic;
    return ROTID_OK;
}

int numbering_choose(struct pool *pool, struct job *job)
{
    const struct rotor *rotor = &job->rotor;
    struct pool scratch;
    int status;
    job->measurement.numbering.elastic = job->measurement.numbering.all = NAN;
    if (!job->measurement.nmode || job->options.type != MODE_BENDING || (!rotor->nspring && !(rotor->sling > 0) && !rotor->neffect))
        return ROTID_OK;
    pool_open(&scratch, pool->allocator);
    status = choose(&scratch, job);
    pool_close(&scratch);
    return status == ROTID_ERROR_MEMORY ? status : ROTID_OK; /* what cannot be computed is told where it is asked for */
}
