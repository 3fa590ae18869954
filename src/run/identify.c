#include "run/identify.h"

#include <math.h>
#include <string.h>

#include "modal/prediction.h"
#include "model/model.h"
#include "run/doubt.h"

#define ROUNDS 3    /* of fitting and pairing, should the pairs change with the model */
#define HELD   1e-5 /* of a frequency: a hundredth of the noise of a good measurement */

/* Which measured shapes the functional gets: with LIKELIHOOD those whose noise is known. */
static int uses_shapes(const struct job *job)
{
    return job->measurement.shape && (job->options.fit.functional != ROTID_LIKELIHOOD || job_knows_shape_noise(job));
}

static int compute_spectrum(struct pool *pool, const struct job *job, const double *x, int count, int parts,
                            struct spectrum *spectrum)
{
    int reduction = job->options.fit.reduction == ROTID_IRS ? ROTID_IRS : ROTID_GUYAN;
    return spectrum_compute_parts(pool, job->models, &job->rotor, job->unknowns.nparameter, job->unknowns.parameter, x, reduction,
                                  count, parts, spectrum);
}

/* ---- A fit of a solid runs on the coarse mesh, whose frequencies are held in ratio to those of the mesh that counts: that ratio
 * hardly depends on E and G. Condensed matrices have no such ratio. */

static int fits_coarse(const struct job *job)
{
    return job->options.solid && job->options.fit.reduction == ROTID_REDUCTION_NONE;
}

/* Where nothing is held: the coarse mesh as it stands, until somebody has compared both. */
static int hold_nothing(struct pool *pool, const struct job *job, int count)
{
    int known;
    double *ratio = POOL_ARRAY(pool, double, count);
    if (!ratio)
        return ROTID_ERROR_MEMORY;
    for (int j = 0; j < count; j++)
        ratio[j] = 1;
    return models_held(job->models, &job->rotor, &known) ? ROTID_OK : models_hold(job->models, &job->rotor, count, ratio);
}

/* Holds the ratio at the parameters of the spectrum; *moved: by how much it differs from what was held. */
static int hold_mesh(struct pool *pool, const struct job *job, const struct spectrum *spectrum, double *moved)
{
    int count;
    const double *before = models_held(job->models, &job->rotor, &count);
    double *ratio = POOL_ARRAY(pool, double, spectrum->count);
    if (!ratio)
        return ROTID_ERROR_MEMORY;
    *moved = count < spectrum->count ? INFINITY : 0;
    for (int j = 0; j < spectrum->count; j++) {
        ratio[j] = spectrum->full_hz[j] / spectrum->other_hz[j];
        if (j < count)
            *moved = fmax(*moved, fabs(ratio[j] / before[j] - 1));
    }
    return models_hold(job->models, &job->rotor, spectrum->count, ratio);
}

int identify_hold(struct pool *pool, const struct job *job, const double *x)
{
    struct spectrum spectrum;
    double moved;
    if (!x)
        return hold_nothing(pool, job, comparison_candidates(job));
    int status = compute_spectrum(pool, job, x, comparison_candidates(job), SPECTRUM_MESH, &spectrum);
    return status ? status : hold_mesh(pool, job, &spectrum, &moved);
}

int identify_mesh(struct pool *pool, const struct job *job, const int *number, int *refine, double **frequency_hz)
{
    int count;
    const double *ratio = fits_coarse(job) ? models_held(job->models, &job->rotor, &count) : NULL;
    *frequency_hz = POOL_ARRAY(pool, double, job->measurement.nmode);
    *refine = 1;
    if (!*frequency_hz)
        return ROTID_ERROR_MEMORY;
    for (int k = 0; k < job->measurement.nmode && ratio; k++)
        if (number[k] > count)
            ratio = NULL;
    for (int k = 0; k < job->measurement.nmode; k++)
        (*frequency_hz)[k] = job->measurement.frequency_hz[k] / (ratio ? ratio[number[k] - 1] : 1);
    if (ratio)
        *refine = COARSE_MESH;
    return ROTID_OK;
}

/* ---- */

int identify_fit(struct pool *pool, const struct job *job, const int *number, const int *holdout,
                 const rotid_fit_options *options, const rotid_environment *environment, struct mass_properties *mass,
                 rotid_fit_result **fit)
{
    struct rotor_model *model = POOL_NEW(pool, struct rotor_model);
    double *frequency_hz;
    int failed, refine, status = model ? identify_mesh(pool, job, number, &refine, &frequency_hz) : ROTID_ERROR_MEMORY;
    if (!status)
        status = model_open(pool, job->models, &job->rotor, job->unknowns.nparameter, job->unknowns.parameter, refine, model,
                            &failed);
    if (status)
        return status;
    int shapes = uses_shapes(job);
    rotid_measured measured = {.size = sizeof measured,
                               .nmode = job->measurement.nmode,
                               .number = number,
                               .frequency_hz = frequency_hz,
                               .frequency_std = job_knows_frequency_noise(job) ? job->measurement.frequency_std : NULL,
                               .shape = shapes ? job->measurement.shape : NULL,
                               .shape_std = shapes && job_knows_shape_noise(job) ? job->measurement.shape_std : NULL,
                               .holdout = holdout};
    status = rotid_fit(&model->equations, job->unknowns.bounds, &measured, options, environment, NULL, fit);
    for (int k = 0; k < job->measurement.nmode && !status; k++)
        (*fit)->predicted_hz[k] *= job->measurement.frequency_hz[k] / frequency_hz[k];
    if (!status && mass) { /* the model stands at the last point that was evaluated; the mass wants the best one */
        model_set(model, (*fit)->x);
        model_mass_properties(model, mass);
    }
    return status;
}

/* Also while NLopt ran: the fit itself is complete then. */
static int is_cancelled(const rotid_fit_result *fit, const rotid_environment *environment)
{
    return fit->status == ROTID_STOP_CANCELLED ||
           (environment && environment->cancelled && environment->cancelled(environment->context));
}

/* What the model that was fitted predicts at the points of the baseline. */
static int predict_baseline(struct pool *pool, const struct job *job, struct identification *out)
{
    const rotid_fit_result *fit = out->fit;
    int failed, highest = 1, nmode = job->measurement.nmode;
    struct rotor_model *model = POOL_NEW(pool, struct rotor_model);
    struct prediction p;
    double *frequency_hz;
    int refine;
    for (int k = 0; k < nmode; k++)
        highest = out->compared.number[k] > highest ? out->compared.number[k] : highest;
    out->baseline_hz = POOL_ARRAY(pool, double, (size_t)nmode *(size_t)fit->nbaseline);
    int status = model && out->baseline_hz ? identify_mesh(pool, job, out->compared.number, &refine, &frequency_hz)
                                           : ROTID_ERROR_MEMORY;
    if (!status)
        status = model_open(pool, job->models, &job->rotor, job->unknowns.nparameter, job->unknowns.parameter, refine, model,
                            &failed);
    if (!status)
        status = prediction_new(pool, &model->equations, job->options.fit.reduction, ROTID_NELSON,
                                model->equations.nrigid + highest, 0, &p);
    for (int i = 0; i < fit->nbaseline && status != ROTID_ERROR_MEMORY; i++) {
        int lost = status ? status : prediction_compute(&p, fit->baseline[i].x);
        for (int k = 0; k < nmode; k++)
            out->baseline_hz[k + (ptrdiff_t)i * nmode] =
                lost ? NAN
                     : prediction_hz(&p, model->equations.nrigid + out->compared.number[k] - 1) *
                           job->measurement.frequency_hz[k] / frequency_hz[k];
    }
    return status == ROTID_ERROR_MEMORY ? status : ROTID_OK; /* the fit stands without these */
}

static int with_models(struct pool *pool, const struct job *job, int baseline, int bare, const rotid_environment *environment,
                       struct message_list *notes, struct identification *out)
{
    int status, candidates = comparison_candidates(job);
    double *start = POOL_ARRAY(pool, double, job->unknowns.nparameter);
    if (!job->measurement.nmode)
        message_add(notes, SEVERITY_ERROR, job->deck, 1, 1, "the deck has no measured modes, expected *MODES or *MEASURED");
    if (!job->measurement.nmode || !start)
        return start ? ROTID_ERROR_ARGUMENT : ROTID_ERROR_MEMORY;
    for (int p = 0; p < job->unknowns.nparameter; p++)
        start[p] = job->unknowns.bounds[p].start;
    struct comparison before;
    struct message_list quiet; /* what the pairing at the start says is not worth repeating unless it ends the run */
    message_open(&quiet, pool);
    int coarse = fits_coarse(job), paired = job->measurement.shape ? SPECTRUM_REDUCED : 0,
        parts = (bare ? paired : SPECTRUM_MESH | SPECTRUM_REDUCED) | (coarse ? SPECTRUM_MESH : 0);
    status = compute_spectrum(pool, job, start, candidates, paired | (coarse ? SPECTRUM_COARSE : 0), &out->spectrum);
    if (!status && coarse)
        status = hold_nothing(pool, job, out->spectrum.count);
    if (!status)
        (void)doubt_units(job, &out->spectrum, SEVERITY_WARNING, notes);
    if (!status)
        status = comparison_make(pool, job, &out->spectrum, &quiet, &before);
    if (status) {
        for (size_t i = 0; i < quiet.count; i++)
            message_add(notes, quiet.item[i].severity, NULL, 0, 0, "%s", quiet.item[i].text);
        out->compared = before;
        return status;
    }
    rotid_fit_options options = job->options.fit;
    for (int round = 1;; round++) {
        double moved = 0;
        options.baseline = baseline && (!coarse || round > 1);
        rotid_fit_free(out->fit);
        out->fit = NULL;
        status = identify_fit(pool, job, before.number, job->measurement.holdout, &options, environment, &out->mass, &out->fit);
        if (!status)
            status = compute_spectrum(pool, job, out->fit->x, candidates, parts, &out->spectrum);
        if (!status && coarse)
            status = hold_mesh(pool, job, &out->spectrum, &moved);
        message_open(&quiet, pool);
        if (!status)
            status = comparison_make(pool, job, &out->spectrum, &quiet, &out->compared);
        if (status || round == ROUNDS || is_cancelled(out->fit, environment))
            break;
        if (moved <= HELD && options.baseline == baseline &&
            !memcmp(before.number, out->compared.number, (size_t)job->measurement.nmode * sizeof *before.number))
            break;
        before = out->compared;
    }
    for (size_t i = 0; i < quiet.count; i++)
        message_add(notes, quiet.item[i].severity, NULL, 0, 0, "%s", quiet.item[i].text);
    if (!status && out->fit->nbaseline)
        status = predict_baseline(pool, job, out);
    if (status) {
        rotid_fit_free(out->fit);
        out->fit = NULL;
        return status;
    }
    if (memcmp(before.number, out->compared.number, (size_t)job->measurement.nmode * sizeof *before.number))
        message_add(notes, SEVERITY_WARNING, NULL, 0, 0,
                    "the pairing of the modes still changes with the fitted model: do not trust this result");
    out->shapes_fitted = uses_shapes(job) &&
                         !(job->options.fit.functional != ROTID_LIKELIHOOD && job->options.fit.reduction == ROTID_REDUCTION_NONE);
    return ROTID_OK;
}

static int identify(struct pool *pool, const struct job *job, int baseline, int bare, const rotid_environment *environment,
                    struct message_list *notes, struct identification *out)
{
    struct job run = *job;
    *out = (struct identification){0};
    run.models = models_for_run(pool, job->models);
    if (!run.models)
        return ROTID_ERROR_MEMORY;
    int status = with_models(pool, &run, baseline, bare, environment, notes, out);
    models_end_run(pool, run.models, job->models);
    return status;
}

int identify_run(struct pool *pool, const struct job *job, int baseline, const rotid_environment *environment,
                 struct message_list *notes, struct identification *out)
{
    return identify(pool, job, baseline, 0, environment, notes, out);
}

int identify_run_bare(struct pool *pool, const struct job *job, int baseline, const rotid_environment *environment,
                      struct message_list *notes, struct identification *out)
{
    return identify(pool, job, baseline, 1, environment, notes, out);
}

void identify_warn_of_reduction(const struct job *job, const struct identification *result, const char *what,
                                struct message_list *notes)
{
    double worst = 0;
    for (int k = 0; k < result->compared.nmode; k++) {
        double error = result->spectrum.reduction_error_percent[result->compared.number[k] - 1];
        if (fabs(error) > fabs(worst))
            worst = error;
    }
    if (job->options.fit.reduction != ROTID_REDUCTION_NONE && fabs(worst) > 0.5)
        message_add(notes, SEVERITY_WARNING, NULL, 0, 0,
                    "identified with REDUCTION=%s, whose frequencies are up to %+.1f %% off those of the full model that is %s "
                    "here (rotid identify, column reduction)",
                    reduction_words[job->options.fit.reduction], worst, what);
}
