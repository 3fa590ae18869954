#include "diagnose/diagnose.h"
#include "fit/fit.h"

#define UNEXPLAINED 1e-3 /* p-value of the whole chi2 */
#define EXPLAINED   0.01
#define LEAST_KEPT  3 /* modes */

int pairing_drop(struct engine *engine, int k)
{
    struct job *job = engine->job;
    int status = ROTID_OK;
    if (!engine->dropped) {
        struct job whole = *job;
        status = data_copy(engine->pool, &whole);
        engine->measured = whole.measurement;
    }
    engine->dropped++;
    if (!status)
        status = data_add_pairing(engine, job->measurement.number[k], 0,
                                  pool_format(engine->pool,
                                              "measured mode %d (%.6g Hz) has the shape of no mode of the model, and another one "
                                              "has the shape of its number; it is left out",
                                              job->measurement.number[k], job->measurement.frequency_hz[k]));
    if (!status)
        data_remove_mode(job, k);
    return status;
}

int pairing_note(struct engine *engine, const int *number)
{
    const struct job *job = engine->job;
    for (int k = 0; k < job->measurement.nmode; k++) {
        if (engine->number[k] == number[k])
            continue;
        int status = data_add_pairing(
            engine, number[k], engine->number[k],
            pool_format(engine->pool, "measured mode %d (%.6g Hz) has the shape of mode %d of the model and is paired with it",
                        number[k], job->measurement.frequency_hz[k], engine->number[k]));
        if (status)
            return status;
    }
    return ROTID_OK;
}

/* The findings about pairing since the data were prepared are taken back. */
static void take_back(struct engine *engine)
{
    rotid_diagnosis *out = &engine->out->result;
    int kept = 0;
    for (int i = 0; i < out->ndata_findings; i++)
        if (i < engine->nprepared || !same_text(out->data_findings[i].id, "mode_pairing"))
            out->data_findings[kept++] = out->data_findings[i];
    out->ndata_findings = kept;
}

int pairing_note_again(struct engine *engine)
{
    if (engine->dropped || engine->job->measurement.paired)
        return ROTID_OK;
    take_back(engine);
    return pairing_note(engine, engine->job->measurement.number);
}

int pairing_adopt(struct engine *engine, const struct job_measurement *measured, int *number)
{
    const struct job_measurement now = engine->job->measurement;
    struct job job = *engine->job;
    if (now.nmode == measured->nmode && !memcmp(number, engine->number, (size_t)now.nmode * sizeof *number))
        return ROTID_OK;
    job.measurement = *measured;
    int status = data_copy(engine->pool, &job);
    if (status)
        return status;
    engine->job->measurement = job.measurement;
    engine->job->measurement.number = engine->number = number;
    engine->job->measurement.paired = 1;
    engine->dropped = 0;
    take_back(engine);
    return pairing_note(engine, measured->number);
}

int pairing_as_numbered(struct engine *engine, const struct posterior *posterior, int *changed)
{
    const struct job_measurement measured = engine->job->measurement;
    size_t size = (size_t)measured.nmode * sizeof *measured.number;
    const struct explanation *lead = posterior->item;
    int *other = engine->by_shape;
    double explained = 0;
    *changed = 0;
    if (other && engine->numbered) { /* once */
        engine->numbered = 0;
        *changed = lead->log_posterior < engine->best_by_shape;
        return *changed ? pairing_adopt(engine, &measured, other) : ROTID_OK;
    }
    if (other || engine->dropped || engine->states.nstate > 1 || !measured.shape ||
        !memcmp(measured.number, engine->number, size))
        return ROTID_OK;
    for (int i = 0; i < posterior->count; i++)
        if (!posterior->item[i].something_else && explanation_explains(engine, posterior, &posterior->item[i]))
            explained += posterior->item[i].probability;
    if (explained > 0.5)
        return ROTID_OK;
    engine->by_shape = POOL_COPY(engine->pool, engine->number, measured.nmode, 0);
    engine->best_by_shape = lead->log_posterior;
    engine->numbered = *changed = 1;
    return engine->by_shape ? pairing_adopt(engine, &measured, measured.number) : ROTID_ERROR_MEMORY;
}

/* Chi2 that a mode left out has to cost: 0.03 of the tests have one (so probable before), and its frequency, of relative
 * deviation s, could be any of the band: -2 ln(0.03 sqrt(2 pi) s/ln(f_n/f_1)). */
static double cost_of_false_mode(const struct job_measurement *measured, int k)
{
    double band = log(measured->frequency_hz[measured->nmode - 1] / measured->frequency_hz[0]);
    return -2 * log(0.03 * sqrt(2 * PI) * measured->frequency_std[k] / fmax(band, measured->frequency_std[k]));
}

/* Without shapes a mode may have been counted twice, as where a rotor that is not quite round has it in two planes: one is left
 * out, and those above are numbered one lower, where the model needs no cause then, and none explains the data as well otherwise.
 * rival: chi2 of the best one. */
static int count_once(struct engine *engine, double rival, int *changed)
{
    struct job best = {.deck = NULL};
    const struct job_measurement *measured = &engine->job->measurement;
    int at = -1, dof = 0, status = ROTID_OK;
    double least = INFINITY;
    for (int k = 0; k < measured->nmode && measured->nmode > LEAST_KEPT && !status; k++) {
        struct job job;
        rotid_fit_result *fit = NULL;
        status = job_started_at(engine->pool, engine->job, engine->deck_start, &job);
        if (!status)
            status = data_copy(engine->pool, &job);
        if (status || measured->holdout[k])
            continue;
        data_remove_double(&job, k);
        int fitted = refit_job(engine->pool, &job, job.measurement.number, job.measurement.holdout, engine->environment, &fit);
        status = fitted == ROTID_ERROR_MEMORY || fitted == ROTID_STOP_CANCELLED ? fitted : ROTID_OK;
        if (fit && fit->chi2 < least) {
            least = fit->chi2;
            dof = fit->dof;
            best = job;
            at = k;
        }
        rotid_fit_free(fit);
    }
    if (status || at < 0 || dof < 1 || chi_square_tail(least, dof) < EXPLAINED ||
        least + cost_of_false_mode(measured, at) + LEAST_MARGIN > rival)
        return status;
    const char *text =
        pool_format(engine->pool,
                    "measured mode %d (%.6g Hz) is no mode of its own: a mode measured twice, or the pair of a rotor "
                    "that is not quite round; it is left out, and those above are numbered one lower",
                    measured->number[at], measured->frequency_hz[at]);
    status = text ? data_add_pairing(engine, measured->number[at], 0, text) : ROTID_ERROR_MEMORY;
    engine->job->measurement = best.measurement;
    engine->job->measurement.paired = *changed = 1;
    engine->number = best.measurement.number;
    engine->holdout = best.measurement.holdout;
    return status;
}

/* Without shapes the numbers are the user's: rigid-body modes may have been counted, or modes missed. Another numbering counts
 * where with it the model needs no cause, and none explains the data as well without. */
static int renumber(struct engine *engine, const struct round_result *result, int *changed)
{
    struct renumbering best;
    struct states states;
    double rival = engine->fit->chi2;
    *changed = 0;
    if (engine->fit->dof < 1 || chi_square_tail(engine->fit->chi2, engine->fit->dof) > UNEXPLAINED)
        return ROTID_OK;
    for (int i = 0; i < result->nrefit; i++)
        if (result->refit[i].fit)
            rival =
                fmin(rival, result->refit[i].chi2 + PARAMETER_PENALTY * (result->refit[i].fit->n - engine->states.nparameter));
    int status = states_started_at(engine->pool, &engine->states, engine->deck_start, &states);
    if (!status)
        status = numbering_search(engine->pool, &states, engine->number, engine->holdout, engine->environment, &best);
    if (status)
        return status;
    if (!best.shift || chi_square_tail(best.chi2, engine->fit->dof) < EXPLAINED ||
        best.chi2 + PARAMETER_PENALTY + LEAST_MARGIN > rival)
        return engine->states.nstate == 1 ? count_once(engine, rival, changed) : ROTID_OK;
    struct job_measurement *measured = &engine->states.state[best.state].job.measurement;
    int at = states_modes(&engine->states, best.state), was = measured->number[best.from];
    const char *text = numbering_text(engine->pool, &engine->states, &best);
    measured->number = best.number + at;
    measured->paired = *changed = 1;
    engine->number = best.number;
    return text ? data_add_pairing(engine, was, best.number[at + best.from],
                                   pool_format(engine->pool, "%s; they are %s", text, best.shift < 0 ? "lowered" : "raised"))
                : ROTID_ERROR_MEMORY;
}

/* Modes k and k + 1 of [nsensor * nmode] change places. */
static void exchange_columns(double *values, int nsensor, int k)
{
    double *one = values + (ptrdiff_t)k * nsensor, *two = one + nsensor;
    for (int s = 0; s < nsensor && values; s++) {
        double keep = one[s];
        one[s] = two[s];
        two[s] = keep;
    }
}

/* *exchanged := a copy of the measurement with the shapes of modes k and k + 1 in each other's place, the numbers rising as the
 * frequencies do; *chi2 of the model without a cause beside it: INFINITY where there is none. */
static int fit_exchanged(struct engine *engine, const struct job_measurement *measured, int k, struct job_measurement *exchanged,
                         double *chi2)
{
    struct job job;
    rotid_fit_result *fit = NULL;
    *chi2 = INFINITY;
    int status = job_started_at(engine->pool, engine->job, engine->deck_start, &job);
    job.measurement = *measured;
    if (!status)
        status = data_copy(engine->pool, &job);
    if (status)
        return status;
    exchange_columns(job.measurement.shape, job.rotor.nsensor, k);
    exchange_columns(job.measurement.shape_std, job.rotor.nsensor, k);
    if (job.measurement.raw) {
        exchange_columns(job.measurement.raw->shape, job.measurement.raw->nsensor, k);
        exchange_columns(job.measurement.raw->shape_std, job.measurement.raw->nsensor, k);
    }
    for (int i = 1; i < measured->nmode; i++) /* the shapes may have given them */
        for (int j = i; j > 0 && job.measurement.number[j] < job.measurement.number[j - 1]; j--) {
            int keep = job.measurement.number[j];
            job.measurement.number[j] = job.measurement.number[j - 1];
            job.measurement.number[j - 1] = keep;
        }
    *exchanged = job.measurement;
    status = refit_job(engine->pool, &job, job.measurement.number, job.measurement.holdout, engine->environment, &fit);
    if (status == ROTID_ERROR_MEMORY || status == ROTID_STOP_CANCELLED)
        return status;
    if (fit)
        *chi2 = fit->chi2;
    rotid_fit_free(fit);
    return ROTID_OK;
}

/* The shapes of two neighbours may stand under each other's number, while the frequencies, which rise, cannot. Paired by such
 * shapes both frequencies are wrong, and nothing that a cause does mends that: where no cause explains the data, and the model
 * without one comes nearer to them than every cause does once the shapes are exchanged, they are. */
static int exchange(struct engine *engine, const struct round_result *result, const struct job_measurement *measured,
                    int *changed)
{
    struct job_measurement exchanged, best = {0};
    double rival = engine->fit->chi2, least = INFINITY, chi2;
    int at = -1, dof = engine->fit->dof, status = ROTID_OK;
    for (int i = 0; i < result->nrefit; i++)
        if (result->refit[i].fit && result->refit[i].chi2 < rival) {
            rival = result->refit[i].chi2;
            dof = result->refit[i].fit->dof;
        }
    if (dof < 1 || chi_square_tail(rival, dof) > UNEXPLAINED)
        return ROTID_OK;
    for (int k = 0; k + 1 < measured->nmode && !status; k++) {
        status = fit_exchanged(engine, measured, k, &exchanged, &chi2);
        if (status || !(chi2 < least))
            continue;
        least = chi2;
        best = exchanged;
        at = k;
    }
    if (status || at < 0 || least + LEAST_MARGIN * fmax(1, least / dof) > rival)
        return status;
    engine->job->measurement = best;
    engine->job->measurement.paired = *changed = 1;
    engine->number = best.number;
    engine->dropped = 0;
    take_back(engine);
    return data_add_pairing(
        engine, best.number[at], best.number[at + 1],
        pool_format(engine->pool,
                    "the shapes of measured modes %d and %d (%.6g and %.6g Hz) have their numbers exchanged; they "
                    "are put right",
                    best.number[at], best.number[at + 1], best.frequency_hz[at], best.frequency_hz[at + 1]));
}

int pairing_settle(struct engine *engine, const struct round_result *result, int *changed)
{
    const struct job_measurement now = engine->job->measurement, *measured = engine->dropped ? &engine->measured : &now;
    *changed = 0;
    if (!now.shape || engine->states.nstate > 1)
        return now.paired && engine->states.nstate == 1 ? ROTID_OK : renumber(engine, result, changed);
    return now.ncorrection != measured->ncorrection ? ROTID_OK : exchange(engine, result, measured, changed);
}
