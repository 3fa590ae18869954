#include "ema/ema.h"
#include "linalg/linalg.h"

#define STEP_TOLERANCE 1e-10 /* of the half bandwidth */
#define FURTHEST       3     /* half-power bandwidths */
#define NEGLIGIBLE     1e-6  /* of chi2: a step that promises less moves no pole by a thousandth of its standard deviation */
#define NEAR           0.02  /* standard deviations */
#define ENOUGH         0.3   /* the same, of what is left to go at the end: it makes errors 5 % larger */
#define LITTLE_DAMPED  1e-3
#define QUIET          3 /* steps in succession that leave the modes where they are */

static int refinement_new(struct pool *pool, const struct modal_fit *fit, struct refinement *refinement)
{
    size_t p = 2 * (size_t)fit->nmode;
    *refinement = (struct refinement){0};
    refinement->covariance = POOL_ARRAY(pool, double, p *p);
    refinement->widened = POOL_ARRAY(pool, double, p);
    refinement->moved = POOL_ARRAY(pool, int, fit->nmode);
    refinement->work = POOL_ARRAY(pool, double, 2 * p * p + 9 * p);
    return refinement->covariance && refinement->widened && refinement->moved && refinement->work ? ROTID_OK : ROTID_ERROR_MEMORY;
}

int refinement_open(struct pool *pool, const struct ema_band *band, int nline, const int *line, int from, int nchannel, int nmode,
                    const double complex *pole, int threads, struct modal_fit *fit, struct refinement *refinement)
{
    int status = modal_fit_new(pool, band, nline, line, from, nchannel, nmode, threads, fit);
    if (status == ROTID_OK)
        status = refinement_new(pool, fit, refinement);
    for (int r = 0; r < nmode && status == ROTID_OK; r++)
        fit->pole[r] = pole[r] / fit->scale;
    return status;
}

static void sum_channels(const struct modal_fit *fit, double *information, double *score)
{
    int p = 2 * fit->nmode;
    memset(information, 0, (size_t)p * (size_t)p * sizeof(double));
    memset(score, 0, (size_t)p * sizeof(double));
    for (int c = 0; c < fit->nchannel; c++) {
        for (int j = 0; j < p; j++)
            score[j] += fit->score[j + (ptrdiff_t)c * p];
        for (int j = 0; j < p * p; j++)
            information[j] += fit->schur[j + (ptrdiff_t)c * p * p];
    }
    for (int j = 0; j < p; j++) {
        if (!fit->held[j / 2])
            continue;
        for (int k = 0; k < p; k++)
            information[j + (ptrdiff_t)k * p] = information[k + (ptrdiff_t)j * p] = j == k;
        score[j] = 0;
    }
}

static double sum_chi2(const struct modal_fit *fit)
{
    double sum = 0;
    for (int c = 0; c < fit->nchannel; c++)
        sum += fit->chi2[c];
    return sum;
}

/* scale [p] that makes the diagonal of a matrix [p * p] one, 0 where that is not positive. */
static void unit_diagonal(int p, const double *matrix, double *scale)
{
    for (int j = 0; j < p; j++) {
        double d = matrix[j + (ptrdiff_t)j * p];
        scale[j] = d > 0 ? 1 / sqrt(d) : 0;
    }
}

/* (S + mu diag S) delta = g, scaled to a unit diagonal, beside steps delta of the poles with limited [nmode] nonzero as they are.
 * Returns 0, or 1 where that is not definite. */
static int damped_step(int p, const double *information, const double *score, double mu, const int *limited, double *factor,
                       double *scale, double *delta)
{
    unit_diagonal(p, information, scale);
    for (int j = 0; j < p; j++) {
        if (limited[j / 2])
            continue;
        double rest = score[j];
        for (int k = 0; k < p; k++)
            rest -= limited[k / 2] ? information[j + (ptrdiff_t)k * p] * delta[k] : 0;
        delta[j] = rest * scale[j];
    }
    for (int k = 0; k < p; k++)
        for (int j = 0; j < p; j++)
            factor[j + (ptrdiff_t)k * p] = j == k ? 1 + mu
                                           : limited[j / 2] || limited[k / 2]
                                               ? 0
                                               : information[j + (ptrdiff_t)k * p] * scale[j] * scale[k];
    if (cholesky_factor(p, factor))
        return 1;
    for (int j = 0; j < p; j++)
        scale[j] = limited[j / 2] ? 1 + mu : scale[j];
    cholesky_solve(p, factor, 1, delta);
    for (int j = 0; j < p; j++)
        delta[j] *= scale[j];
    return 0;
}

/* Whether a step [2 nmode] moves no pole but guards by more than `most` of its standard deviation beside guards as they are; step
 * NULL: the step to their minimum beside them, by score [2 nmode]. A guard may wander along a valley for ever, which changes
 * nothing for the modes. inverse [p * p] and scale [p] are workspace. */
static int leaves_modes(const struct modal_fit *fit, const double *information, const double *score, const double *step,
                        double most, double *inverse, double *scale)
{
    int p = 2 * fit->nmode;
    double determinant;
    unit_diagonal(p, information, scale);
    for (int k = 0; k < p; k++)
        for (int j = 0; j < p; j++)
            inverse[j + (ptrdiff_t)k * p] = j == k ? 1
                                            : fit->loose[j / 2] || fit->loose[k / 2]
                                                ? 0
                                                : information[j + (ptrdiff_t)k * p] * scale[j] * scale[k];
    if (positive_invert(p, inverse, &determinant))
        return 0;
    for (int j = 0; j < p; j++) {
        double variance = inverse[j + (ptrdiff_t)j * p] * scale[j] * scale[j], moved = step ? step[j] : 0;
        for (int k = 0; k < p && !step; k++)
            moved += inverse[j + (ptrdiff_t)k * p] * scale[j] * scale[k] * score[k];
        if (!fit->loose[j / 2] && !fit->held[j / 2] && !(moved * moved <= most * most * variance))
            return 0;
    }
    return 1;
}

/* Takes the step [2 nmode] back to the half bandwidth of each pole, limited [nmode] nonzero where it was longer. Returns the
 * largest step over the half bandwidth. */
static double limit_step(int nmode, const double complex *pole, double *step, int *limited)
{
    double largest = 0;
    for (int r = 0; r < nmode; r++) {
        double *re = step + (ptrdiff_t)2 * r, *im = re + 1, damping = creal(pole[r]), half = fmax(fabs(damping), 1e-12);
        double size = hypot(*re, *im) / half;
        largest = fmax(largest, size);
        if (size > 1) {
            limited[r] = 1;
            *re /= size;
            *im /= size;
        }
        /* a pole may lose at most nine tenths of its damping in a step: past zero it would model nothing */
        if (damping < 0 && damping + *re > 0.1 * damping) {
            limited[r] = 1;
            *re = -0.9 * damping;
        }
    }
    return largest;
}

/* The step beside poles whose own is limited, as one that a guard beyond the lines asks for may be: the others take the steps
 * that go with the limited ones. Returns the largest over the half bandwidth, negative where the information is not definite. */
static double limited_step(const struct modal_fit *fit, const double *information, const double *score, double mu, int *limited,
                           double *factor, double *scale, double *delta)
{
    int m = fit->nmode, any = 0;
    memset(limited, 0, (size_t)m * sizeof *limited);
    if (damped_step(2 * m, information, score, mu, limited, factor, scale, delta))
        return -1;
    double size = limit_step(m, fit->pole, delta, limited);
    for (int r = 0; r < m; r++)
        any |= limited[r];
    if (any && damped_step(2 * m, information, score, mu, limited, factor, scale, delta))
        return -1;
    if (any)
        (void)limit_step(m, fit->pole, delta, limited);
    return size;
}

/* One descent with weights as they are. Returns ROTID_OK or ROTID_STOP_CANCELLED. */
static int descend(struct modal_fit *fit, int most, const rotid_environment *environment, double complex *old,
                   struct refinement *refinement)
{
    int p = 2 * fit->nmode;
    double *information = refinement->work, *factor = information + (ptrdiff_t)p * p, *score = factor + (ptrdiff_t)p * p;
    double *scale = score + p, *delta = scale + p, mu = 1e-4;
    double chi2 = modal_fit_evaluate(fit, MODAL_FIT_POLES);
    int fresh = 1, refused = 0, guarded = 0, quiet = 0;
    for (int r = 0; r < fit->nmode; r++)
        guarded |= fit->loose[r];
    refinement->converged = 0;
    for (int i = 0; i < most; i++) {
        if (environment_cancelled(environment))
            return ROTID_STOP_CANCELLED;
        environment_progress(environment, "refine poles", refinement->iterations);
        if (fresh)
            sum_channels(fit, information, score);
        double size = limited_step(fit, information, score, mu, refinement->moved, factor, scale, delta);
        if (size < 0) {
            mu = fmax(10 * mu, 1e-3);
            fresh = 0;
            continue;
        }
        double promised = 0;
        for (int j = 0; j < p; j++)
            promised += score[j] * delta[j];
        memcpy(old, fit->pole, (size_t)fit->nmode * sizeof *old);
        for (int r = 0; r < fit->nmode; r++)
            fit->pole[r] += CMPLX(delta[(ptrdiff_t)2 * r], delta[(ptrdiff_t)2 * r + 1]);
        double trial = modal_fit_evaluate(fit, MODAL_FIT_POLES);
        refinement->iterations++;
        /* near the minimum chi2 no longer tells a small step from rounding: such a step is taken as it is */
        int small = size < 1e-5;
        if (trial <= chi2 || small) {
            chi2 = trial;
            fresh = 1;
            refused = 0;
            if (guarded && mu <= LITTLE_DAMPED)
                quiet = leaves_modes(fit, information, score, delta, NEAR, factor, scale) ? quiet + 1 : 0;
            mu = fmax(mu / 10, 1e-12);
            if (size < STEP_TOLERANCE || (small && mu <= 1e-8 && size < 1e-7) ||
                (mu <= LITTLE_DAMPED && size <= 1 && promised < NEGLIGIBLE) || quiet == QUIET) {
                refinement->converged = 1;
                break;
            }
            continue;
        }
        memcpy(fit->pole, old, (size_t)fit->nmode * sizeof *old);
        fresh = 0;
        mu *= 10;
        if (++refused > 12)
            break;
    }
    (void)modal_fit_evaluate(fit, MODAL_FIT_SPREAD);
    sum_channels(fit, information, score);
    refinement->converged |= leaves_modes(fit, information, score, NULL, ENOUGH, factor, scale);
    return ROTID_OK;
}

/* Factors by which the scatter of the scores over the channels exceeds what the noise allows. */
static void widen(const struct modal_fit *fit, const double *inverse, double *step, double *widened)
{
    int p = 2 * fit->nmode;
    for (int j = 0; j < p; j++) {
        double sum = 0, squares = 0, scatter = 0;
        for (int c = 0; c < fit->nchannel; c++) {
            double share = fit->schur[j + (ptrdiff_t)j * p + (ptrdiff_t)c * p * p];
            sum += share;
            squares += share * share;
            *step = 0;
            for (int k = 0; k < p; k++)
                *step += inverse[k + (ptrdiff_t)j * p] * fit->score[k + (ptrdiff_t)c * p];
            scatter += *step * *step;
        }
        double n = squares > 0 ? sum * sum / squares : 0, expected = inverse[j + (ptrdiff_t)j * p];
        widened[j] = 1;
        if (n < 1.5 || !(expected > 0))
            continue;
        double ratio = scatter * n / (n - 1) / expected;
        if (ratio > 1 + 2 * sqrt(2 / (n - 1)))
            widened[j] = sqrt(ratio);
    }
}

/* covariance [p * p] of the poles, those of the others as known. Returns 0, or 1 where their information is not definite. */
static int invert_information(const struct modal_fit *fit, double *score, double *scale, double *covariance)
{
    int p = 2 * fit->nmode;
    double determinant;
    sum_channels(fit, covariance, score);
    unit_diagonal(p, covariance, scale);
    for (int k = 0; k < p; k++)
        for (int j = 0; j < p; j++)
            covariance[j + (ptrdiff_t)k * p] *= scale[j] * scale[k];
    if (positive_invert(p, covariance, &determinant))
        return 1;
    for (int k = 0; k < p; k++)
        for (int j = 0; j < p; j++)
            covariance[j + (ptrdiff_t)k * p] *= fit->held[j / 2] || fit->held[k / 2] ? 0 : scale[j] * scale[k];
    return 0;
}

/* Of a guard beyond the lines the information may be lost in rounding; the modes are then told beside it where it is. */
static void hold_guards_outside(struct modal_fit *fit)
{
    for (int r = 0; r < fit->nmode; r++)
        if (cimag(fit->pole[r]) < fit->nu[0] || cimag(fit->pole[r]) > fit->nu[fit->nline - 1])
            fit->held[r] = 1;
}

static void pole_covariance(struct modal_fit *fit, struct refinement *refinement)
{
    int p = 2 * fit->nmode;
    double *score = refinement->work, *scale = score + p, *step = scale + p, *covariance = refinement->covariance;
    int lost = invert_information(fit, score, scale, covariance);
    if (lost) {
        hold_guards_outside(fit);
        lost = invert_information(fit, score, scale, covariance);
    }
    if (lost) {
        for (int j = 0; j < p * p; j++)
            covariance[j] = NAN;
        for (int j = 0; j < p; j++)
            refinement->widened[j] = 1;
        return;
    }
    widen(fit, covariance, step, refinement->widened);
    for (int k = 0; k < p; k++)
        for (int j = 0; j < p; j++)
            covariance[j + (ptrdiff_t)k * p] *= refinement->widened[j] * refinement->widened[k];
}

/* Flat weights: sigma of each channel from its chi2; score, schur, chi2 and spread are brought to it. */
static void modal_fit_noise(struct modal_fit *fit)
{
    if (fit->weight || fit->equal)
        return;
    int p = 2 * fit->nmode, q = fit->nlinear;
    /* the poles are shared by the channels, so each pays its part of them */
    double dof = fmax(2.0 * fit->nline - q - (double)p / fit->nchannel, 1);
    for (int c = 0; c < fit->nchannel; c++) {
        /* rounding of y'y - x'phi'y bounds from below what can be told of the noise */
        double old = fit->sigma[c] * fit->sigma[c];
        double variance = fmax(fit->chi2[c] * old, 1e-16 * fit->yy[c]) / dof, ratio = old / fmax(variance, 1e-300);
        fit->sigma[c] = sqrt(fmax(variance, 1e-300));
        fit->chi2[c] *= ratio;
        for (int j = 0; j < p; j++)
            fit->score[j + (ptrdiff_t)c * p] *= ratio;
        for (int j = 0; j < p * p; j++)
            fit->schur[j + (ptrdiff_t)c * p * p] *= ratio;
        for (int j = 0; j < q * q; j++)
            fit->spread[j + (ptrdiff_t)c * q * q] /= ratio;
    }
}

int refine_poles(struct modal_fit *fit, int most, const rotid_environment *environment, struct refinement *refinement)
{
    int m = fit->nmode, rounds = fit->weight || most == 0 ? 1 : 3;
    ptrdiff_t p = 2 * (ptrdiff_t)m;
    /* two doubles a complex number, behind what descend uses */
    double complex *old = (double complex *)(void *)(refinement->work + 2 * p * p + 4 * p), *start = old + m;
    memcpy(start, fit->pole, (size_t)m * sizeof *start);
    refinement->iterations = 0;
    if (!fit->weight) {
        (void)modal_fit_evaluate(fit, MODAL_FIT_LINEAR);
        modal_fit_noise(fit);
    }
    for (int round = 0; round < rounds; round++) {
        int status = descend(fit, most, environment, old, refinement);
        if (status != ROTID_OK)
            return status;
        modal_fit_noise(fit);
    }
    refinement->chi2 = sum_chi2(fit);
    for (int r = 0; r < m; r++) {
        double width = 2 * fmax(fabs(creal(start[r])), fabs(creal(fit->pole[r])));
        refinement->moved[r] = creal(fit->pole[r]) >= 0 || cabs(fit->pole[r] - start[r]) > FURTHEST * width;
    }
    pole_covariance(fit, refinement);
    return ROTID_OK;
}

void refinement_add_step(int nmode, struct refinement *refinement)
{
    int p = 2 * nmode;
    const double *score = refinement->work, *widened = refinement->widened; /* the scores of pole_covariance */
    double *step = refinement->work + p, *covariance = refinement->covariance;
    memset(step, 0, (size_t)p * sizeof *step);
    for (int k = 0; k < p; k++)
        for (int j = 0; j < p; j++)
            step[j] += covariance[j + (ptrdiff_t)k * p] / (widened[j] * widened[k]) * score[k];
    for (int k = 0; k < p; k++)
        for (int j = 0; j < p; j++)
            covariance[j + (ptrdiff_t)k * p] += step[j] * step[k];
}
