/* The search once: scan, chance, explanations; and again where they show that the data are at fault. */
#include "diagnose/diagnose.h"
#include "fit/fit.h"

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
    int nsensor = job->rotor.nsensor, row = job_fitted(job, engine->holdout), nfirst = 0, nsecond = 0;
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

#define MOST_PASSES 6 /* of a search, each with better data */

/* Far starts and pairing, faults of channels, of the only state noise, as the explanations have them, and the mesh as the leading
 * one needs it; the search is to be repeated where something was at fault. */
static int settle_data(struct engine *engine, struct round_result *result, const struct posterior *posterior, int doubt,
                       int *changed)
{
    *changed = 0;
    int status = doubt ? far_starts_search(engine, result, posterior, changed) : ROTID_OK;
    if (!status && !*changed)
        status = pairing_as_numbered(engine, posterior, changed);
    if (!status && *changed)
        return base_again(engine);
    if (!status)
        status = pairing_settle(engine, result, changed);
    if (!status && !*changed)
        status = posterior_take_faults(engine, posterior, changed);
    if (!status && !*changed && doubt)
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

/* Gives the scan's candidate the start that was found. */
static void far_starts_mark(const struct engine *engine, struct scan *scan)
{
    for (int i = 0; i < scan->ncandidate && engine->far; i++) {
        const struct scan_candidate *c = &scan->candidate[i];
        if (c->cause == engine->far->cause && c->effect.target == engine->far->effect.target &&
            c->effect.variant == engine->far->effect.variant && !c->suspect)
            scan->candidate[i].far = &engine->far->effect;
    }
}

/* The scan, what the rotor as a solid promises, and how probable such data are as noise. */
static int scan_base(struct engine *engine, struct diagnosis_round *round, struct round_result *result)
{
    struct pool *pool = engine->pool;
    struct scan *scan = &result->scan;
    *round = (struct diagnosis_round){0};
    *result = (struct round_result){0};
    int status = engine_stage(engine, "scan", 1);
    if (!status)
        status = scan_run(pool, &engine->states, engine->number, engine->holdout, engine->fit->x, SCAN_ALL, scan);
    if (!status)
        status = scan_solid(pool, &engine->states, engine->number, engine->holdout, engine->fit->x, scan, engine->notes);
    if (status)
        return status;
    far_starts_mark(engine, scan);
    round->result = (rotid_round){.round = 1,
                                  .chi2 = scan->chi2,
                                  .chi2_frequency = scan->chi2_frequency,
                                  .frequencies = scan->nfrequency,
                                  .dof = scan->dof,
                                  .largest = scan->largest,
                                  .p_frequency = scan_chance_of_frequencies(pool, scan),
                                  .p_total = scan->dof > 0 ? chi_square_tail(scan->chi2, scan->dof) : 1};
    result->room = 2 * (scan->ncandidate + SEARCH_FITS);
    result->refit = POOL_ARRAY(pool, struct refit, result->room);
    return result->refit ? ROTID_OK : ROTID_ERROR_MEMORY;
}

int round_run(struct engine *engine, int doubt, struct diagnosis_round *round, struct round_result *result,
              struct posterior *posterior)
{
    int again = 1, status = ROTID_OK;
    for (int pass = 1; again && !status; pass++) {
        round_free(result);
        again = 0;
        status = scan_base(engine, round, result);
        engine_step(engine, "scan");
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
    if (!result)
        return;
    for (int i = 0; i < result->nrefit; i++)
        rotid_fit_free(result->refit[i].fit);
    result->nrefit = 0;
}
