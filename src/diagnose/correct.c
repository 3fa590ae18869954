#include "diagnose/diagnose.h"

int correction_add(struct pool *pool, struct job *job, const struct correction *correction)
{
    struct correction *more = POOL_COPY(pool, job->measurement.correction, job->measurement.ncorrection, 1);
    int status = more ? corrections_keep_raw(pool, job) : ROTID_ERROR_MEMORY;
    if (!status)
        status = correction_apply(pool, job, correction);
    if (status)
        return status;
    more[job->measurement.ncorrection++] = *correction;
    job->measurement.correction = more;
    return ROTID_OK;
}

int data_correct(struct engine *engine, const rotid_data_finding *finding, const struct correction *found)
{
    struct job *job = engine->job;
    struct correction correction = *found;
    correction.name = pool_format(engine->pool, "fault_%d", job->measurement.ncorrection + 1);
    correction.id = finding->id;
    int status = correction.name ? data_add_finding(engine, finding) : ROTID_ERROR_MEMORY;
    return status ? status : correction_add(engine->pool, job, &correction);
}

int data_correct_noise(struct engine *engine, const char *block, double factor, double std, const char *text)
{
    const rotid_data_finding finding = {
        .id = "noise_level", .block = block, .value = factor, .std = std, .chi2_drop = NAN, .text = text};
    const struct correction correction = {.block = block, .value = factor};
    return data_correct(engine, &finding, &correction);
}
