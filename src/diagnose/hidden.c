#include "diagnose/diagnose.h"

#define LISTED 3 /* causes of a parameter */

/* What a list is made of. */
struct source {
    struct pool *pool;
    int nown;                                  /* unknowns of the deck, the first ones */
    const rotid_parameter *bounds;             /* of the states */
    const int *at_bound;                       /* [nown] */
    const struct roving_accelerometer *moving; /* NULL: none */
    const struct scan *scan;
};

/* The largest amplitude of an item that stays hidden, with the sign that physics allows; *beyond: the physical bound is less than
 * what would show. */
static double hidden_amplitude(const struct source *from, const struct scan_candidate *c, const struct scan_item *item,
                               int *beyond)
{
    double shown = item->shown, side = scan_side(item), most = side < 0 ? -item->lower : item->upper;
    if (from->moving && from->moving->usable && is_moving_accelerometer(&c->effect)) /* by the frequencies at single sensors */
        shown = fmin(shown, from->moving->smallest / fabs(item->unit));
    *beyond = !(shown <= most);
    if (!c->cause->effect->nparameter) /* there or not: a part of it would show */
        return *beyond ? 1 : 0;
    return side * fmin(shown, most);
}

/* Candidate c moves parameter p most by this item. *row is blank where nothing moves it. */
static void largest_of(const struct source *from, const struct scan_candidate *c, int p, rotid_hidden *row)
{
    const struct scan *scan = from->scan;
    const struct cause_kind *cause = c->cause;
    int nparameter = cause->effect->nparameter;
    *row = (rotid_hidden){.z_m = NAN, .width_m = NAN};
    for (int i = c->first; i < c->first + c->count; i++) {
        const struct scan_item *item = &scan->item[i];
        int beyond;
        if (!item->usable)
            continue;
        double amplitude = hidden_amplitude(from, c, item, &beyond),
               shift = amplitude * scan->shift[p + (ptrdiff_t)i * scan->nfree];
        if (!(fabs(shift) > fabs(row->shift)) || !isfinite(shift))
            continue;
        *row = (rotid_hidden){.parameter = from->bounds[p].name,
                              .unit = from->bounds[p].unit,
                              .shift = shift,
                              .id = cause->id,
                              .target = c->target,
                              .component = nparameter ? cause->effect->parameter[cause->size].name : "presence",
                              .size_unit = nparameter ? cause->effect->parameter[cause->size].unit : "1",
                              .size = amplitude * item->unit,
                              .z_m = cause->place >= 0 ? item->effect.value[cause->place] : (double)NAN,
                              .width_m = cause->width >= 0 ? item->effect.value[cause->width] : (double)NAN,
                              .beyond = beyond};
    }
}

static int fill(const struct source *from, int *n, rotid_hidden **list)
{
    const struct scan *scan = from->scan;
    *n = 0;
    *list = POOL_ARRAY(from->pool, rotid_hidden, LISTED * (size_t)from->nown);
    if (!*list)
        return ROTID_ERROR_MEMORY;
    for (int p = 0; p < from->nown && p < scan->nfree; p++) {
        rotid_hidden most[LISTED];
        int count = 0;
        for (int i = 0; i < scan->ncandidate && !from->at_bound[p]; i++) {
            const struct scan_candidate *c = &scan->candidate[i];
            rotid_hidden row;
            if (c->suspect || !c->count || c->state >= 0)
                continue;
            largest_of(from, c, p, &row);
            int at = count;
            while (at > 0 && fabs(row.shift) > fabs(most[at - 1].shift))
                at--;
            if (!row.id || at == LISTED)
                continue;
            count += count < LISTED;
            memmove(&most[at + 1], &most[at], (size_t)(count - 1 - at) * sizeof *most);
            most[at] = row;
        }
        memcpy(*list + *n, most, (size_t)count * sizeof *most);
        *n += count;
    }
    return ROTID_OK;
}

int hidden_shifts(struct engine *engine, const struct scan *scan)
{
    rotid_diagnosis *out = &engine->out->result;
    const struct source from = {engine->pool, engine->nown, engine->states.bounds, engine->fit->at_bound, &engine->moving, scan};
    return fill(&from, &out->nhidden, &out->hidden);
}

/* The scan of a solid on its coarse mesh, held as its fit held it. */
static int scan_fit(struct pool *pool, const struct states *given, const struct identification *found, const int *number,
                    const int *holdout, const double *x, struct scan *scan)
{
    struct states states;
    int begun = 0, status = states_copy(pool, given, &states);
    for (; begun < states.nstate && !status; begun++) {
        struct job *job = &states.state[begun].job;
        job->models = models_for_run(pool, job->models);
        job->held = found[begun].held;
        status = job->models ? ROTID_OK : ROTID_ERROR_MEMORY;
    }
    if (!status)
        status = scan_run(pool, &states, number, holdout, x, SCAN_ALL, scan);
    for (int s = 0; s < begun; s++)
        if (states.state[s].job.models)
            models_end_run(pool, states.state[s].job.models, given->state[s].job.models);
    return status;
}

int hidden_of_fit(struct pool *pool, const struct states *states, const struct identification *found, const int *number,
                  const rotid_fit_result *fit, int *n, rotid_hidden **list)
{
    struct scan scan = {0};
    int *holdout = POOL_ARRAY(pool, int, states_modes(states, states->nstate));
    *n = 0;
    if (!holdout)
        return ROTID_ERROR_MEMORY;
    for (int s = 0, at = 0; s < states->nstate; s++)
        for (int k = 0; k < states->state[s].job.measurement.nmode; k++, at++)
            holdout[at] = states->state[s].job.measurement.holdout && states->state[s].job.measurement.holdout[k];
    int status = scan_fit(pool, states, found, number, holdout, fit->x, &scan);
    if (status || scan.dof < 1 || !scan.nitem)
        return status;
    amplitudes_shown(states, &scan);
    const struct source from = {pool, fit->n, states->bounds, fit->at_bound, NULL, &scan};
    return fill(&from, n, list);
}
