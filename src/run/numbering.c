/* From which mode measured ones are counted. A rotor on soft supports vibrates on them first, as a rigid body: whoever counts
 * what was measured calls that mode 1, whoever counts bending modes does not. Both are usual, and the data tell them apart. */
#include "fit/fit.h"
#include "run/run.h"

#define MOST_SHIFT  3    /* of the numbers: two modes of the rigid body, and one */
#define UNIT        5    /* the least factor between frequencies that a unit explains is 2 pi */
#define UNEXPLAINED 1e-3 /* p-value of a misfit that makes other numbers worth a try */
#define ASSUMED     0.01 /* noise of frequencies where the deck states none */

/* ln of the mean factor of measured over computed frequencies: the partner of mode n is mode n + above of the spectrum */
static double mean_factor(const struct job *job, const struct spectrum *spectrum, int above)
{
    const struct job_measurement *measured = &job->measurement;
    double sum = 0;
    for (int k = 0; k < measured->nmode; k++) {
        int j = measured->number[k] + above - 1;
        if (j < spectrum->count && spectrum->full_hz[j] > 0)
            sum += log(measured->frequency_hz[k] / spectrum->full_hz[j]);
    }
    return sum / measured->nmode;
}

/* root mean square over the measured modes, of the frequencies over exp(factor) */
static double misfit(const struct job *job, const struct spectrum *spectrum, int above, double factor)
{
    const struct job_measurement *measured = &job->measurement;
    double sum = 0;
    for (int k = 0; k < measured->nmode; k++) {
        int j = measured->number[k] + above - 1;
        if (j >= spectrum->count || !(spectrum->full_hz[j] > 0))
            return INFINITY;
        double shape = 0, frequency = log(measured->frequency_hz[k] / spectrum->full_hz[j]) - factor;
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
    /* a factor in both numberings that no modulus explains is one of units, of which check_units tells */
    double bending = mean_factor(job, &spectrum, numbering->nsupport), lowest = mean_factor(job, &spectrum, 0);
    int unit = (bending > 0) == (lowest > 0) && fmin(fabs(bending), fabs(lowest)) > log(UNIT);
    numbering->elastic = misfit(job, &spectrum, numbering->nsupport, unit ? bending : 0);
    numbering->all = misfit(job, &spectrum, 0, unit ? lowest : 0);
    job->rotor.count_all = numbering->all < NUMBERING_CLEAR * numbering->elastic;
    return ROTID_OK;
}

int numbering_choose(struct pool *pool, struct job *job)
{
    const struct rotor *rotor = &job->rotor;
    struct pool scratch;
    int status;
    job->measurement.numbering.elastic = job->measurement.numbering.all = NAN;
    if (!job->measurement.nmode || job->options.type != MODE_BENDING ||
        (!rotor->nspring && !(rotor->sling > 0) && !rotor->neffect))
        return ROTID_OK;
    pool_open(&scratch, pool->allocator);
    status = choose(&scratch, job);
    pool_close(&scratch);
    return status == ROTID_ERROR_MEMORY ? status : ROTID_OK; /* what cannot be computed is told where it is asked for */
}

/* Mode k of a numbering: all numbers `shift` higher from mode `from` on. 0 where that is none: numbers count from 1. */
static int renumbered(int from, int shift, int k, const int *was)
{
    int number = was[k] + (k >= from ? shift : 0);
    return number < 1 || (k == from && k > 0 && number <= was[k - 1]) ? 0 : number;
}

static int attempt(struct pool *pool, const struct states *states, const int *number, const int *holdout,
                   const rotid_environment *environment, double *chi2)
{
    rotid_fit_options options = states->state->job.options.fit;
    rotid_fit_result *fit;
    options.max_iterations = 40;
    int status = identify_fit_states(pool, states, number, holdout, &options, environment, &fit);
    *chi2 = fit ? 2 * fit->objective : INFINITY;
    rotid_fit_free(fit);
    return status == ROTID_STOP_CANCELLED || status == ROTID_ERROR_MEMORY ? status : ROTID_OK;
}

/* What the frequencies of all modes that numbers reach do near the start, so that a numbering costs no fit: ln f is nearly linear
 * in ln x, ln f_j(h) = ln f_j + sum_p slope_jp h_p, h in shares of the width of a parameter's bounds. */
struct outlook {
    int n, *first, *count; /* parameters; of each state the row of its mode 1, and its modes */
    double *frequency;     /* [rows] ln f, NaN where the model has none */
    double *slope;         /* [n * rows] */
};

/* dx/dh at the start, x in ln x where it is above 0 */
static double width_of(const rotid_parameter *bound)
{
    return bound->lower > 0 ? bound->start * log(bound->upper / bound->lower) : bound->upper - bound->lower;
}

/* The rows of state s at x, the start: d ln f/dh = dlambda/dx dx/dh / (2 lambda). */
static int look_at_state(struct pool *pool, const struct states *states, int s, const double *x, int rows, struct outlook *o)
{
    const struct state *state = &states->state[s];
    const struct job *job = &state->job;
    int failed, condensed = job->options.fit.reduction != ROTID_REDUCTION_NONE, count = o->count[s];
    double *own = state_values(pool, state, x);
    struct rotor_model model;
    struct prediction p;
    int status =
        !own ? ROTID_ERROR_MEMORY
             : model_open(pool, job->models, &job->rotor, job->unknowns.nparameter, job->unknowns.parameter, 1, &model, &failed);
    int rigid = status ? 0 : model.equations.nrigid, most = status ? 0 : condensed ? model.equations.nmaster : model.equations.n;
    for (int j = 0; j < count; j++)
        o->frequency[o->first[s] + j] = NAN;
    count = rigid + count < most ? count : most - rigid;
    if (status || count < 1)
        return status;
    status = prediction_new(pool, &model.equations, job->options.fit.reduction, ROTID_NELSON, rigid + count, 0, &p);
    int *wanted = POOL_ARRAY(pool, int, rigid + count);
    if (!status)
        status = wanted ? prediction_compute(&p, own) : ROTID_ERROR_MEMORY;
    for (int j = 0; j < count && !status; j++)
        wanted[rigid + j] = p.lambda[rigid + j] > 0;
    if (!status)
        status = prediction_differentiate(&p, own, wanted, 0);
    for (int j = 0; j < count && !status; j++) {
        int row = o->first[s] + j, k = rigid + j;
        if (!wanted[k])
            continue;
        o->frequency[row] = log(prediction_hz(&p, k));
        for (int q = 0; q < job->unknowns.nparameter; q++) {
            int unknown = state_unknown(state, q);
            o->slope[row + (ptrdiff_t)unknown * rows] +=
                p.dlambda[k + (ptrdiff_t)q * p.count] / (2 * p.lambda[k]) * width_of(&states->bounds[unknown]);
        }
    }
    return status;
}

static int look_ahead(struct pool *pool, const struct states *states, const int *number, struct outlook *o)
{
    int rows = 0, n = states->nparameter, status = ROTID_OK;
    const double *x = parameter_starts(pool, n, states->bounds);
    *o = (struct outlook){n, POOL_ARRAY(pool, int, states->nstate), POOL_ARRAY(pool, int, states->nstate), NULL, NULL};
    if (!x || !o->first || !o->count)
        return ROTID_ERROR_MEMORY;
    for (int s = 0; s < states->nstate; rows += o->count[s++]) {
        o->first[s] = rows;
        o->count[s] = 0;
        for (int k = 0; k < states->state[s].job.measurement.nmode; k++, number++)
            o->count[s] = *number + MOST_SHIFT > o->count[s] ? *number + MOST_SHIFT : o->count[s];
    }
    o->frequency = POOL_ARRAY(pool, double, rows);
    o->slope = POOL_ARRAY(pool, double, (size_t)n *(size_t)rows);
    if (!o->frequency || !o->slope)
        return ROTID_ERROR_MEMORY;
    for (int s = 0; s < states->nstate && !status; s++) {
        struct pool scratch;
        pool_open(&scratch, pool->allocator);
        status = look_at_state(&scratch, states, s, x, rows, o);
        pool_close(&scratch);
    }
    return status;
}

/* min over h of sum ((ln f~ - ln f(h))/std)^2 + |h|^2; INFINITY where the model has no such modes. work: [m * n + m + n +
 * least_squares_workspace] */
static double outlook_of(const struct outlook *o, const struct states *states, const int *number, const int *holdout,
                         double *work)
{
    int m = states_modes(states, states->nstate), n = o->n, at = 0;
    ptrdiff_t rows = o->first[states->nstate - 1] + o->count[states->nstate - 1];
    double *jacobian = work, *r = jacobian + (ptrdiff_t)m * n, *h = r + m, *one = h + n, sum = 0, damping = 0, length;
    for (int s = 0; s < states->nstate; s++)
        for (int k = 0; k < states->state[s].job.measurement.nmode; k++, at++) {
            const struct job_measurement *measured = &states->state[s].job.measurement;
            ptrdiff_t row = o->first[s] + number[at] - 1;
            double std = measured->frequency_std[k], weight = holdout[at] ? 0 : 1 / (std > 0 ? std : ASSUMED);
            if (!isfinite(o->frequency[row]))
                return INFINITY;
            r[at] = weight * (o->frequency[row] - log(measured->frequency_hz[k]));
            for (int p = 0; p < n; p++)
                jacobian[at + (ptrdiff_t)p * m] = weight * o->slope[row + p * rows];
        }
    for (int p = 0; p < n; p++)
        one[p] = 1;
    if (n && least_squares_damped_step(m, n, jacobian, r, one, one, INFINITY, &damping, h, &length, one + n))
        return INFINITY;
    for (int i = 0; i < m; i++) {
        for (int p = 0; p < n; p++)
            r[i] += jacobian[i + (ptrdiff_t)p * m] * h[p];
        sum += r[i] * r[i];
    }
    for (int p = 0; p < n; p++)
        sum += h[p] * h[p];
    return sum;
}

/* Whether the modes of a state may have other numbers: no shape says which they are, and nothing has settled them. */
static int is_open(const struct state *state)
{
    return !state->job.measurement.shape && !state->job.measurement.paired;
}

int numbering_search(struct pool *pool, const struct states *states, const int *number, const int *holdout,
                     const rotid_environment *environment, struct renumbering *best)
{
    int all = states_modes(states, states->nstate), n = states->nparameter, *trial = POOL_ARRAY(pool, int, all);
    struct outlook outlook;
    double chi2,
        *work = POOL_ARRAY(pool, double, (size_t)all *(size_t)n + (size_t)all + 2 * (size_t)n + least_squares_workspace(all, n));
    *best = (struct renumbering){.chi2 = INFINITY, .number = POOL_ARRAY(pool, int, all)};
    if (!trial || !best->number || !work)
        return ROTID_ERROR_MEMORY;
    int open = 0;
    for (int s = 0; s < states->nstate; s++)
        open |= is_open(&states->state[s]);
    int status = open ? look_ahead(pool, states, number, &outlook) : ROTID_OK;
    if (status || !open)
        return status == ROTID_ERROR_MEMORY ? status : ROTID_OK;
    double as_it_is = outlook_of(&outlook, states, number, holdout, work);
    for (int s = 0, at = 0; s < states->nstate; at += states->state[s].job.measurement.nmode, s++) {
        const struct job_measurement *measured = &states->state[s].job.measurement;
        if (!is_open(&states->state[s]))
            continue;
        for (int from = 0; from < measured->nmode; from++)
            for (int shift = from ? 1 : -MOST_SHIFT; shift <= MOST_SHIFT && !status; shift++) {
                int whole = shift != 0;
                memcpy(trial, number, (size_t)all * sizeof *trial);
                for (int k = 0; k < measured->nmode; k++)
                    whole &= (trial[at + k] = renumbered(from, shift, k, number + at)) > 0;
                if (!whole || !(outlook_of(&outlook, states, trial, holdout, work) < as_it_is))
                    continue;
                status = attempt(pool, states, trial, holdout, environment, &chi2);
                if (status || chi2 >= best->chi2)
                    continue;
                *best = (struct renumbering){s, from, shift, best->number, chi2};
                memcpy(best->number, trial, (size_t)all * sizeof *trial);
            }
    }
    return status;
}

const char *numbering_text(struct pool *pool, const struct states *states, const struct renumbering *r)
{
    const struct state *state = &states->state[r->state];
    const struct job_measurement *measured = &state->job.measurement;
    const char *of = state->name ? pool_format(pool, " of state %s", state->name) : "";
    return r->from
               ? pool_format(pool, "from measured mode %d (%.6g Hz)%s on the numbers are %d too low: modes were missed below it",
                             measured->number[r->from], measured->frequency_hz[r->from], of, r->shift)
           : r->shift < 0
               ? pool_format(pool, "the numbers of all modes%s are %d too high: rigid-body modes were counted", of, -r->shift)
               : pool_format(pool, "the numbers of all modes%s are %d too low: the lowest modes were missed", of, r->shift);
}

int numbering_warn(struct pool *pool, const struct states *states, const struct identification *found,
                   const rotid_fit_result *fit, const rotid_environment *environment, struct message_list *notes)
{
    int *number, *holdout, status = identify_numbers(pool, states, found, &number, &holdout);
    struct renumbering best;
    if (status)
        return status;
    if (fit->status == ROTID_STOP_CANCELLED || states->state->job.options.solid || states->more || !fit->n || fit->dof < 1 ||
        (isfinite(fit->chi2) && chi_square_tail(fit->chi2, fit->dof) > UNEXPLAINED))
        return ROTID_OK;
    status = numbering_search(pool, states, number, holdout, environment, &best);
    if (status == ROTID_STOP_CANCELLED) /* the fit is a result all the same */
        return ROTID_OK;
    if (status || !(best.chi2 < NUMBERING_CLEAR * NUMBERING_CLEAR * 2 * fit->objective))
        return status;
    const char *text = numbering_text(pool, states, &best);
    if (!text)
        return ROTID_ERROR_MEMORY;
    message_warn(notes, "%s? With such numbers the errors of the fit fall to %.2g of what they are", text,
                 sqrt(best.chi2 / (2 * fit->objective)));
    return ROTID_OK;
}

/* The two ends of a rotor: frequencies of a symmetric one are those of its mirror image, so they determine two bearings, but not
 * which of them is the stiffer one. Found without geometry: a fit that starts from two values exchanged and ends as low there. */

#define MOST    6   /* pairs that are tried */
#define APART   3   /* standard deviations between two values that are worth a word */
#define AS_WELL 1   /* of chi2, as the noise is seen by the residuals */
#define ALIKE   1.1 /* of the objective where the noise is not known */

/* Of one kind, and in the same states: "a.k" and "b.k", "held:a.k" and "held:b.k". */
static int are_alike(const rotid_parameter *a, const rotid_parameter *b)
{
    const char *of_a = strrchr(a->name, '.'), *of_b = strrchr(b->name, '.'), *end_a = strchr(a->name, ':'),
               *end_b = strchr(b->name, ':');
    size_t in_a = end_a ? (size_t)(end_a - a->name) : 0, in_b = end_b ? (size_t)(end_b - b->name) : 0;
    return of_a && of_b && !strcmp(of_a, of_b) && in_a == in_b && !strncmp(a->name, b->name, in_a);
}

static int fits_as_well(const rotid_fit_result *fit, const rotid_fit_result *other, int p, int q)
{
    if (fabs(other->x[p] - fit->x[q]) > fabs(other->x[p] - fit->x[p])) /* it went back */
        return 0;
    return isfinite(fit->chi2) && fit->dof > 0 ? 2 * (other->objective - fit->objective) < AS_WELL * fmax(1, fit->chi2 / fit->dof)
                                               : other->objective < ALIKE * fit->objective;
}

int exchange_warn(struct pool *pool, const struct states *states, const struct identification *found, const rotid_fit_result *fit,
                  const rotid_environment *environment, struct message_list *notes)
{
    int n = fit->n, tried = 0, *number, *holdout, status = identify_numbers(pool, states, found, &number, &holdout);
    rotid_parameter *bounds = POOL_ARRAY(pool, rotid_parameter, n);
    struct states exchanged = *states;
    if (status || !bounds)
        return ROTID_ERROR_MEMORY;
    if (fit->status == ROTID_STOP_CANCELLED || states->state->job.options.solid || states->more || n != states->nparameter)
        return ROTID_OK;
    for (int s = 0; s < states->nstate; s++)
        if (found[s].shapes_fitted)
            return ROTID_OK;
    exchanged.bounds = bounds;
    for (int p = 0; p < n; p++)
        for (int q = p + 1; q < n; q++) {
            const rotid_parameter *a = &states->bounds[p], *b = &states->bounds[q];
            double x = fit->x[p], y = fit->x[q];
            if (!are_alike(a, b) || !(fabs(x - y) > APART * hypot(fit->std[p], fit->std[q])) || x <= b->lower || x >= b->upper ||
                y <= a->lower || y >= a->upper || tried++ >= MOST)
                continue;
            memcpy(bounds, states->bounds, (size_t)n * sizeof *bounds);
            for (int i = 0; i < n; i++)
                if (fit->x[i] > bounds[i].lower && fit->x[i] < bounds[i].upper)
                    bounds[i].start = i == p ? y : i == q ? x : fit->x[i];
            rotid_fit_result *other;
            status = identify_fit_states(pool, &exchanged, number, holdout, &states->state->job.options.fit, environment, &other);
            if (!status && fits_as_well(fit, other, p, q))
                message_warn(notes,
                             "%s and %s fit as well if they are exchanged: frequencies alone do not tell the ends of a symmetric "
                             "rotor apart; shapes do, or a known mass near one end (*STATE)",
                             a->name, b->name);
            rotid_fit_free(other);
            if (status == ROTID_ERROR_MEMORY || status == ROTID_STOP_CANCELLED) /* the fit is a result all the same */
                return status == ROTID_ERROR_MEMORY ? status : ROTID_OK;
        }
    return ROTID_OK;
}
