#include "diagnose/diagnose.h"
#include "fit/fit.h"
#include "result/result.h"

#define SAME 1e-3 /* relative difference of parameters that is not worth a word */

double fit_rms_percent(const rotid_identification *fit, int holdout)
{
    double sum = 0;
    int count = 0;
    for (int k = 0; k < fit->nmodes; k++) {
        double error = fit->modes[k].error_percent;
        if (!fit->modes[k].holdout == !holdout && isfinite(error)) {
            sum += error * error;
            count++;
        }
    }
    return sqrt(sum / count); /* 0/0 of none */
}

int fit_worst_mode(const rotid_identification *fit)
{
    int worst = -1;
    for (int k = 0; k < fit->nmodes; k++) {
        double error = fit->modes[k].error_percent;
        if (!fit->modes[k].holdout && isfinite(error) && (worst < 0 || fabs(error) > fabs(fit->modes[worst].error_percent)))
            worst = k;
    }
    return worst;
}

static double p_value(double chi2, int dof)
{
    return isfinite(chi2) && dof > 0 ? chi_square_tail(chi2, dof) : (double)NAN;
}

double fit_p_value(const rotid_identification *fit)
{
    return p_value(fit->chi2, fit->dof);
}

int misfit_is_inadequate(double chi2, int dof)
{
    return p_value(chi2, dof) < JUDGEMENT_CHANCE;
}

int fit_is_inadequate(const rotid_identification *fit)
{
    return misfit_is_inadequate(fit->chi2, fit->dof);
}

int fit_mode_of_mesh(const rotid_identification *fit)
{
    double sum = 0, most = 0;
    int worst = -1;
    for (int k = 0; k < fit->nmodes && fit->mesh_error_percent && fit_is_inadequate(fit); k++) {
        double times = fabs(fit->mesh_error_percent[k]) / 100 / fit->modes[k].frequency_std;
        if (fit->modes[k].holdout || !isfinite(times))
            continue;
        sum += times * times;
        worst = times > most ? k : worst;
        most = fmax(most, times);
    }
    return sum >= fit->chi2 / 2 ? worst : -1;
}

const char *fit_state_of_mode(const rotid_identification *fit, int k)
{
    int s = 0;
    while (s < fit->nstates && k >= fit->states[s].nmodes)
        k -= fit->states[s++].nmodes;
    return s < fit->nstates ? fit->states[s].name : NULL;
}

rotid_identification fit_of_state(struct pool *pool, const rotid_identification *fit, int s)
{
    int first = 0;
    for (int before = 0; before < s; before++)
        first += fit->states[before].nmodes;
    const rotid_identified_state *state = &fit->states[s];
    rotid_identification out = *fit;
    STATE_COPY(&out, state);
    out.nbaseline = POOL_LIST(pool, out.baseline, fit->nbaseline);
    for (int b = 0; b < out.nbaseline; b++) {
        rotid_minimiser *own = &out.baseline[b];
        *own = fit->baseline[b]; /* which predicts the modes of all */
        own->predicted_hz = own->predicted_hz ? own->predicted_hz + first : NULL;
        own->npredicted_hz = own->predicted_hz ? out.nmodes : 0;
    }
    out.nstates = 0;
    out.states = NULL;
    return out;
}

const rotid_fitted_parameter *fit_parameter(const rotid_identification *fit, const char *name)
{
    for (int p = 0; fit && p < fit->nparameters; p++)
        if (!strcmp(fit->parameters[p].name, name))
            return &fit->parameters[p];
    return NULL;
}

const rotid_hidden *hidden_in(int count, const rotid_hidden *hidden, const rotid_fitted_parameter *parameter)
{
    int i = 0;
    while (i < count && strcmp(hidden[i].parameter, parameter->name) != 0)
        i++;
    return i < count && fabs(hidden[i].shift) > (parameter->ci95[1] - parameter->ci95[0]) / 2 ? &hidden[i] : NULL;
}

const rotid_identification *diagnosis_today(const rotid_diagnosis *d)
{
    const rotid_identification *today = d->today, *base = d->base;
    if (!today || !base)
        return today;
    int same = !strcmp(today->functional, base->functional) && !strcmp(today->reduction, base->reduction), near = 1;
    for (int p = 0; p < today->nparameters && p < base->nparameters; p++)
        near &= fabs(today->parameters[p].value - base->parameters[p].value) <= SAME * fabs(base->parameters[p].value);
    return same || near ? NULL : today;
}

const rotid_candidate *diagnosis_candidates(const rotid_diagnosis *d, int round, int *count)
{
    int first = 0;
    *count = 0;
    while (first < d->ncandidates && d->candidates[first].round <= round)
        first++;
    while (first + *count < d->ncandidates && d->candidates[first + *count].round == round + 1)
        ++*count;
    return d->candidates + first;
}

int diagnosis_is_suspected(const rotid_diagnosis *d, const rotid_cause *cause)
{
    for (int i = 0; i < d->ncandidates && cause->name; i++) {
        const rotid_candidate *tried = &d->candidates[i];
        if (tried->suspect && tried->cause.name && !strcmp(tried->cause.name, cause->name))
            return 1;
    }
    return 0;
}
