/* The fit of a deck with MINPACK's lmder at the wheel of rotid's own model, and the least that any fit by its equations has to
 * do: as JSON, {"lmder": {...}, "rotid": {...}, "limit_seconds": ...}. Arguments: deck, repetitions.
 *
 * The limit: for each of the modes asked for one LU factor of a band of the model's size and half bandwidth (dgbtrf) and one
 * solution (dgbtrs), as often as rotid evaluated; and one factor of K (dpbtrf). Nothing is assembled, condensed or differentiated
 * there. */
#include <cminpack.h>
#include <lapacke.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "api/api.h"
#include "base/base.h"
#include "modal/modal.h"
#include "model/model.h"
#include "run/run.h"

#define MOST      8 /* parameters */
#define HALF      3 /* bandwidth of a beam */
#define TOLERANCE 1e-12

struct host {
    struct functional functional;
    int n;
    double start[MOST], x[MOST];
    int evaluations;
};

static int residual(void *user, int m, int n, const double *scaled, double *r, double *jacobian, int rows, int flag)
{
    struct host *host = user;
    (void)rows;
    for (int p = 0; p < n; p++)
        host->x[p] = scaled[p] * host->start[p];
    host->evaluations += flag == 1;
    /* the Jacobian belongs to the residual before, which of a step that was refused was another one */
    double again[256];
    if (functional_residual(&host->functional, host->x, flag == 1 ? r : again))
        return -1;
    if (flag == 1)
        return 0;
    if (functional_jacobian(&host->functional, host->x, jacobian))
        return -1;
    for (int p = 0; p < n; p++)
        for (int i = 0; i < m; i++)
            jacobian[i + p * m] *= host->start[p];
    return 0;
}

static int by_size(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Seconds of the factors and solutions of one evaluation. */
static double limit(int n, int modes)
{
    enum { REPEAT = 50, WIDE = 3 * HALF + 1 };
    double *band = calloc((size_t)WIDE * (size_t)n, sizeof *band), *work = calloc((size_t)WIDE * (size_t)n, sizeof *work);
    double *right = calloc((size_t)n, sizeof *right), begin, sum = 0;
    lapack_int *pivot = calloc((size_t)n, sizeof *pivot);
    if (!band || !work || !right || !pivot)
        exit(3);
    for (int j = 0; j < n; j++)
        for (int d = -HALF; d <= HALF; d++)
            if (j + d >= 0 && j + d < n)
                band[2 * HALF + d + (ptrdiff_t)j * WIDE] = d ? -1.0 / (1 + abs(d)) : 3;
    begin = clock_seconds();
    for (int i = 0; i < REPEAT; i++) {
        for (int j = 0; j < n; j++) /* lower band of a positive definite one */
            memcpy(work + (ptrdiff_t)j * (HALF + 1), band + 2 * HALF + (ptrdiff_t)j * WIDE, (HALF + 1) * sizeof *work);
        sum += LAPACKE_dpbtrf_work(LAPACK_COL_MAJOR, 'L', n, HALF, work, HALF + 1);
        for (int k = 0; k < modes; k++) {
            memcpy(work, band, (size_t)WIDE * (size_t)n * sizeof *work);
            for (int j = 0; j < n; j++)
                right[j] = 1;
            sum += LAPACKE_dgbtrf_work(LAPACK_COL_MAJOR, n, n, HALF, HALF, work, WIDE, pivot);
            sum += LAPACKE_dgbtrs_work(LAPACK_COL_MAJOR, 'N', n, HALF, HALF, 1, work, WIDE, pivot, right, n);
        }
    }
    double seconds = (clock_seconds() - begin) / REPEAT;
    free(band), free(work), free(right), free(pivot);
    return sum == 0 ? seconds : NAN;
}

int main(int count, char **argument)
{
    char failure[ROTID_FAILURE_LENGTH];
    rotid_deck *deck = NULL;
    rotid_identification *own = NULL;
    int repeat = count > 2 ? atoi(argument[2]) : 15;
    if (count < 2 || repeat < 1 || rotid_deck_read(argument[1], 0, NULL, NULL, failure, &deck) ||
        rotid_identify(deck, 0, NULL, failure, &own)) {
        (void)fprintf(stderr, "fit_host: %s\n", count < 2 ? "expected a deck" : failure);
        return 2;
    }
    const struct job *job = deck_job_of(deck);
    struct pool pool;
    struct rotor_model model;
    struct host host = {0};
    int failed, number[256], n = job ? job->unknowns.nparameter : 0, modes = job ? job->measurement.nmode : 0;
    pool_open(&pool, NULL);
    for (int k = 0; k < modes && k < 256; k++)
        number[k] = k + 1;
    rotid_measured measured = {
        .size = sizeof measured, .nmode = modes, .number = number, .frequency_hz = job ? job->measurement.frequency_hz : NULL};
    if (!job || n > MOST || modes > 256 || modes < n || job->options.fit.functional == ROTID_LIKELIHOOD ||
        model_open(&pool, NULL, &job->rotor, n, job->unknowns.parameter, 1, &model, &failed) ||
        functional_new(&pool, job->options.fit.functional, job->options.fit.reduction, ROTID_NELSON, &model.equations, &measured,
                       &host.functional)) {
        (void)fprintf(stderr, "fit_host: not a deck of frequencies and a hybrid functional\n");
        return 2;
    }
    int m = host.functional.nresidual, evaluations = 0, jacobians = 0, pivot[MOST];
    double *r = calloc((size_t)m, sizeof *r), *jacobian = calloc((size_t)m * MOST, sizeof *jacobian),
           *w4 = calloc((size_t)m, sizeof *w4);
    double *seconds = calloc((size_t)repeat, sizeof *seconds), x[MOST], diag[MOST], qtf[MOST], w1[MOST], w2[MOST], w3[MOST],
           sum = 0;
    if (!r || !jacobian || !w4 || !seconds)
        return 3;
    for (int i = 0; i < repeat; i++) {
        double begin = clock_seconds();
        for (int p = 0; p < n; p++) {
            host.start[p] = job->unknowns.bounds[p].start;
            x[p] = 1;
        }
        (void)lmder(residual, &host, m, n, x, r, jacobian, m, TOLERANCE, TOLERANCE, 0, 200, diag, 1, 100, 0, &evaluations,
                    &jacobians, pivot, qtf, w1, w2, w3, w4);
        seconds[i] = clock_seconds() - begin;
    }
    for (int i = 0; i < m; i++)
        sum += r[i] * r[i] / 2;
    qsort(seconds, (size_t)repeat, sizeof *seconds, by_size);
    (void)printf(
        "{\"lmder\": {\"e\": %.12g, \"g\": %.12g, \"objective\": %.12g, \"evaluations\": %d, \"best\": %.6g, \"median\": %.6g},\n"
        " \"unknowns\": %d, \"modes\": %d, \"limit_seconds\": %.6g}\n",
        x[0] * host.start[0], n > 1 ? x[1] * host.start[1] : 0, sum, evaluations, seconds[0], seconds[repeat / 2],
        model.equations.n, modes, limit(model.equations.n, modes));
    free(r), free(jacobian), free(w4), free(seconds);
    pool_close(&pool);
    rotid_identification_free(own);
    rotid_deck_free(deck);
    return 0;
}
