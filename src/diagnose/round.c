/* The search once: scan, chance by the bootstrap, fits of what is promising, explanations; and again where they show that the
 * data are at fault. */
#include "diagnose/diagnose.h"

#include <math.h>
#include <string.h>

#include "base/base.h"
#include "diagnose/causes/causes.h"
#include "linalg/linalg.h"

/* The level of the noise of the shapes: judged by what the best model so far leaves, said, used from there on. */

#define LEAST_ROWS 60
#define MUCH_LESS  0.7  /* of the stated noise, */
#define EXACT      0.1  /* and data that were computed rather than measured */
#define NOISIER    3.0  /* beyond any misjudgement: then it is the model that is wrong, in ways no cause has */
#define MISJUDGED  1.15 /* times the stated noise: less is no finding */
#define CERTAIN    3.29 /* standard deviations, two-sided 0.001 */
#define SMOOTH     0.2  /* what a smooth misfit adds to the correlation of neighbours */
#define SCATTER    1.6  /* of that of white noise, times the root of the number of second differences */
#define LITTLE     2.0  /* chi2 a residual: with more, it is not noise that is left */
#define SLIGHT     0.05 /* excess of the smooth part of the noise that changes no verdict */

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

/* The stated noise is kept where it is a little too large: a user may have allowed for what a model leaves. rows: of the shapes.
 */
static int is_misstated(const struct engine *engine, double factor, int rows)
{
    if (rows < LEAST_ROWS || !(fabs(log(factor)) > CERTAIN / sqrt(2.0 * rows)))
        return 0;
    if (factor < 1)
        return factor < MUCH_LESS && factor > EXACT && !engine->job->measurement.has_noise_floor &&
               !allows_for_more(&engine->job->rotor);
    return factor > MISJUDGED && factor < NOISIER;
}

/* Correlation between neighbours and level of the noise from differences, which a smooth misfit hardly touches: first differences
 * have the variance 2 sigma^2 (1 - rho), second ones (3 - rho) times that. scatter: of rho by chance. NaN: too few. */
static void neighbours(const struct engine *engine, const double *r, double *rho, double *sigma, double *scatter)
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
    *rho = *sigma = *scatter = NAN;
    if (nsecond < 50 || !(first > 0))
        return;
    first /= nfirst;
    *rho = fmin(3 - second / nsecond / first, 0.9);
    *scatter = SCATTER / sqrt(nsecond);
    *sigma = sqrt(first / (2 * (1 - *rho)));
}

/* Factor on the noise of smooth shapes where neighbours share it, 1 where they do not: the spectrum of such noise rises to
 * (1 + rho)/(1 - rho) towards long waves. Only where the fit has left little else. */
static double shared_noise(const struct engine *engine, const double *r, double chi2)
{
    double rho, sigma, scatter;
    neighbours(engine, r, &rho, &sigma, &scatter);
    if (!(rho > SMOOTH + 3 * scatter) || chi2 > LITTLE)
        return 1;
    return fmin(fmax(1, sigma * sqrt((1 + rho) / (1 - rho))), NOISIER);
}

/* Where the noise of the shapes is not as stated beside the likeliest explanation, or neighbouring sensors share it, which looks
 * like physics to the scan, the judged data get the level that is there, with a finding: the search has to be repeated, *changed.
 * The level is nothing to go by where something else explains the data better; noise that is shared looks like that itself. */
static int noise_settle(struct engine *engine, const struct posterior *p, int *changed)
{
    const struct job *job = engine->job;
    const struct explanation *lead = NULL;
    for (int i = 0; i < p->count && !lead; i++)
        if (!p->item[i].something_else && (p->item[i].refit || !p->item[i].nmember))
            lead = &p->item[i];
    *changed = 0;
    if (engine->coloured || !job_fits_shapes(job) || !lead)
        return ROTID_OK;
    const rotid_fit_result *fit = lead->refit ? lead->refit->fit : engine->fit;
    int rows = lead->data->nrow - lead->data->nline - lead->data->nwhole - lead->data->nscale;
    double chi2 = 0, level = lead->evidence.noise[1], std = level / sqrt(2.0 * (rows > 0 ? rows : 1));
    for (int i = 0; i < lead->data->nrow; i++)
        chi2 += lead->data->kind[i] == EVIDENCE_SHAPE ? fit->r[i] * fit->r[i] / (rows > 0 ? rows : 1) : 0;
    double shared = lead->data->nrow == p->data->nrow ? shared_noise(engine, fit->r, chi2) : 1;
    int coloured = shared > 1 + SLIGHT, status;
    if (!coloured && (p->something_else > 0.5 || !is_misstated(engine, level, rows)))
        return ROTID_OK;
    double factor = coloured ? shared : level;
    const char *text = pool_format(
        engine->pool,
        coloured
            ? "the noise of neighbouring sensors is correlated: its smooth part is %.2f times the stated level, which is used"
            : "the noise of the shapes is %.2f times the stated one, which is used",
        factor);
    engine->coloured |= coloured;
    *changed = 1;
    double *base = engine->out->judged.state->job.measurement
                       .shape_std; /* another array where a cause has added its discrepancy to the judged one */
    for (ptrdiff_t i = 0; i < (ptrdiff_t)job->rotor.nsensor * job->measurement.nmode && base != job->measurement.shape_std; i++)
        base[i] *= factor;
    status = data_correct_noise(engine, "SHAPE", factor, coloured ? NAN : std, text);
    engine->out->judged.state->job.measurement.correction = job->measurement.correction;
    engine->out->judged.state->job.measurement.ncorrection = job->measurement.ncorrection;
    return status;
}

#define MOST_REFITS 16
#define MOST_PASSES 6    /* of a round, each with better data */
#define WORTH       3.0  /* a promised drop below this is noise */
#define SHARE       0.25 /* of the best promise: a rival of cosine 0.5 keeps so much */

struct refits {
    const struct engine *engine;
    struct round_result *result;
    const double *deck; /* [nparameter] the starts of the deck, of causes that were named their values */
    struct pool *pool;  /* one a task: pools are not shared between threads */
};

static int refit_task(void *context, int index, int worker)
{
    struct refits *refits = context;
    const struct engine *e = refits->engine;
    (void)worker;
    return refit_cause(&refits->pool[index], &e->states, e->number, e->holdout, e->fit->x, refits->deck, &refits->result->scan,
                       refits->result->candidate[index], e->environment, &refits->result->refit[index]);
}

/* Candidates worth a nonlinear fit, the most promising first, and every suspect. */
static int choose(const struct scan *scan, double threshold, int *chosen)
{
    int count = 0;
    double least = fmax(WORTH, fmin(threshold / 2, SHARE * scan->largest));
    for (int rank = 0; rank < scan->ncandidate; rank++) {
        int best = -1;
        for (int i = 0; i < scan->ncandidate; i++) {
            int taken = 0;
            for (int j = 0; j < count; j++)
                taken |= chosen[j] == i;
            if (!taken && (best < 0 || scan_best_drop(scan, i) > scan_best_drop(scan, best)))
                best = i;
        }
        if (best < 0 || scan_best_drop(scan, best) < least || count == MOST_REFITS)
            break;
        chosen[count++] = best;
    }
    for (int i = 0; i < scan->ncandidate; i++) {
        int taken = 0;
        for (int j = 0; j < count; j++)
            taken |= chosen[j] == i;
        if (!taken && ((scan->candidate[i].suspect && scan->candidate[i].best >= 0) || scan->candidate[i].far))
            chosen[count++] = i;
    }
    return count;
}

/* Fits the first `count` of the chosen candidates. */
static int run_refits(struct engine *engine, struct round_result *result, int count)
{
    struct pool *pool = engine->pool;
    double *deck = POOL_ARRAY(pool, double, engine->states.nparameter);
    struct refits refits = {engine, result, deck, POOL_ARRAY(pool, struct pool, count)};
    if (!deck || !refits.pool)
        return ROTID_ERROR_MEMORY;
    for (int p = 0; p < engine->states.nparameter; p++)
        deck[p] = p < engine->nown ? engine->deck_start[p] : engine->fit->x[p];
    for (int i = 0; i < count; i++)
        pool_open(&refits.pool[i], pool->allocator);
    result->nrefit = result->nsingle = count;
    int status = parallel_for(engine->threads, count, refit_task, &refits);
    for (int i = 0; i < count; i++)
        pool_absorb(pool, &refits.pool[i]);
    return status;
}

/* Pairing, faults of channels, of the only state noise, as the explanations have them, and the mesh as the leading one needs it;
 * the search is to be repeated where something was at fault. */
static int settle_data(struct engine *engine, struct round_result *result, const struct posterior *posterior, int noise,
                       int *changed)
{
    int status = pairing_settle(engine, result, changed);
    if (!status && !*changed)
        status = posterior_take_faults(engine, posterior, changed);
    if (!status && !*changed && noise)
        status = noise_settle(engine, posterior, changed);
    for (int i = 0; i < posterior->count && !status && !*changed; i++)
        if (posterior->item[i].nmember && posterior->item[i].refit && posterior->item[i].refit->fit) {
            const struct refit *leading = posterior->item[i].refit;
            status = base_refine_beside(engine, &leading->states.state->job, leading->fit->x, changed);
            break;
        }
    if (!status && *changed)
        status = base_again(engine);
    return status || !*changed ? status : pairing_note_again(engine);
}

/* Scan, and fits of single causes. */
static int fit_singles(struct engine *engine, struct diagnosis_round *round, struct round_result *result)
{
    struct pool *pool = engine->pool;
    *round = (struct diagnosis_round){0};
    *result = (struct round_result){0};
    int status = engine_stage(engine, "scan", 1);
    if (!status)
        status = scan_run(pool, &engine->states, engine->number, engine->holdout, engine->fit->x, SCAN_ALL, &result->scan);
    engine_step(engine, "scan");
    if (!status)
        far_starts_mark(engine, &result->scan);
    const struct scan *scan = &result->scan;
    if (!status)
        status =
            bootstrap_run(pool, scan, engine->replicates, engine->seed, engine->threads, engine->environment, &result->bootstrap);
    engine_step(engine, "bootstrap");
    if (status)
        return status;
    const struct bootstrap *b = &result->bootstrap;
    round->result = (rotid_round){.round = 1,
                                  .chi2 = scan->chi2,
                                  .chi2_frequency = scan->chi2_frequency,
                                  .frequencies = scan->nfrequency,
                                  .dof = scan->dof,
                                  .largest = scan->largest,
                                  .threshold = b->threshold,
                                  .p_scan = b->p_scan,
                                  .p_frequency = b->p_frequency,
                                  .p_total = b->p_total};
    result->adequate = scan->largest <= b->threshold && b->p_frequency > BLOCK_LEVEL && b->p_total > BLOCK_LEVEL;
    result->room = scan->ncandidate + SEARCH_FITS;
    result->candidate = POOL_ARRAY(pool, int, scan->ncandidate);
    result->refit = POOL_ARRAY(pool, struct refit, result->room);
    if (!result->candidate || !result->refit)
        return ROTID_ERROR_MEMORY;
    /* also where nothing is missed: what holds its mesh there saves the search nine tenths of its fit */
    status = scan_solid(pool, &engine->states, engine->number, engine->holdout, engine->fit->x, &result->scan, engine->notes);
    engine_step(engine, "scan");
    if (status)
        return status;
    int single = result->adequate ? 0 : choose(scan, b->threshold, result->candidate);
    status = engine_stage(engine, "fits of candidates", 1);
    if (!status)
        status = run_refits(engine, result, single);
    engine_step(engine, "refits");
    return status;
}

int round_fit(struct engine *engine, struct diagnosis_round *round, struct round_result *result)
{
    return fit_singles(engine, round, result);
}

int round_run(struct engine *engine, int doubt, struct diagnosis_round *round, struct round_result *result,
              struct posterior *posterior)
{
    int again = 1, status = ROTID_OK;
    for (int pass = 1; again && !status; pass++) {
        round_free(result);
        again = 0;
        status = fit_singles(engine, round, result);
        if (!status && doubt && pass < MOST_PASSES && !result->adequate) {
            status = far_starts_search(engine, result, &again);
            engine_step(engine, "far starts");
            if (!status && again) {
                status = base_again(engine);
                continue;
            }
        }
        if (!status)
            status = posterior_run(engine, result, posterior);
        engine_step(engine, "posterior");
        if (!status && pass < MOST_PASSES)
            status = settle_data(engine, result, posterior, doubt, &again);
        engine_step(engine, "data");
    }
    return status;
}

void round_free(struct round_result *result)
{
    for (int i = 0; i < result->nrefit; i++)
        rotid_fit_free(result->refit[i].fit);
    result->nrefit = 0;
}
