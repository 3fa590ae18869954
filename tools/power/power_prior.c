/* Cases drawn from the priors of the diagnosis and its own model: what src/diagnose/posterior.c and laplace.c integrate over,
 * written once more. Data that no deck can hold (frequencies that do not rise, a shape smaller than what is added to it) are
 * drawn anew with their explanation, so that P(H | y) of the others stays what it is. */
#include <math.h>
#include <string.h>

#include "deck/deck.h"
#include "hide/hide_random.h"
#include "power.h"

#define FAULTS    7    /* kinds, beside fitted shapes */
#define DRAWS     200  /* until data can be measured */
#define DEVIATION 0.15 /* of ln of the noise, */
#define MISSTATED 0.1  /* share of noise of shapes with a larger one, */
#define MISTAKE   0.7  /* this one */
#define LEAST     2.0  /* something else, times the noise */
#define MOST      1000.0
#define AGAIN     (-1) /* no such data: draw anew */

static double draw_normal(struct hide_random *random, double mean, double deviation, double lower, double upper)
{
    double x;
    do
        x = mean + deviation * hide_normal(random);
    while (!(x >= lower && x <= upper));
    return x;
}

/* Parameter p of a cause. */
static double draw_value(const struct cause_kind *cause, int p, double lower, double upper, struct hide_random *random)
{
    const struct cause_parameter *prior = &cause->parameter[p];
    double neutral = prior->neutral, scale = prior->scale, below = neutral - lower, above = upper - neutral;
    if (p == cause->width && lower > 0)
        return hide_log_between(random, lower, upper);
    if (p == cause->place || p == cause->width || prior->prior == PRIOR_FLAT)
        return hide_between(random, lower, upper);
    if (prior->prior == PRIOR_LOG_FLAT) {
        double least = upper * pow(10, -scale), t = hide_between(random, 0, 1 + scale * log(10));
        return least * (t < 1 ? t : exp(t - 1));
    }
    if (prior->prior == PRIOR_LOG_NORMAL)
        return exp(draw_normal(random, log(neutral), scale, log(lower), log(upper)));
    if (prior->gross > 0 && hide_between(random, 0, 1) < prior->gross)
        return hide_between(random, lower, upper);
    if (prior->prior == PRIOR_SHARE)
        scale = scale < 0 ? -scale * below : scale * fmax(below, above);
    return draw_normal(random, neutral, scale, lower, upper);
}

static void draw_values(const struct rotor *rotor, struct hide_random *random, struct candidate *c)
{
    for (int p = 0; p < c->nparameter; p++) {
        double lower, upper;
        cause_bounds(c->cause, rotor, &c->effect, p, &lower, &upper);
        if (!c->fixed[p])
            c->effect.value[p] = draw_value(c->cause, p, lower, upper, random);
    }
}

/* A fault of the measurement: kind, then channels or which part of a line, then its size. */
static struct candidate draw_fault(const struct rotor *rotor, int kind, struct hide_random *random)
{
    static const char *const id[FAULTS] = {"sensor_gain", "sensor_sign",       "sensor_position",  "sensor_line",
                                           "sensor_swap", "duplicate_channel", "duplicate_channel"};
    struct candidate c = candidate_blank(catalogue_find(id[kind]), "");
    int two = kind == 4 || kind == 5, one = hide_pick(random, rotor->nsensor), other = hide_pick(random, rotor->nsensor - 1);
    other += other >= one;
    if (kind == 3) { /* shift, scale, both, or from the other end */
        int part = hide_pick(random, 4);
        const double value[] = {0, 1, part == 0};
        memcpy(c.effect.value, value, sizeof value);
        c.fixed[0] = !(part & 1);
        c.fixed[1] = !(part & 2);
        c.fixed[2] = 1;
    } else if (kind == 4) { /* has no order */
        c.sensor[0] = rotor->sensor[one < other ? one : other].id;
        c.sensor[1] = rotor->sensor[one < other ? other : one].id;
    } else {
        c.sensor[0] = rotor->sensor[one].id;
        c.sensor[1] = two ? rotor->sensor[other].id : 0;
    }
    while (correction_parameter(c.cause, c.nparameter))
        c.nparameter++;
    draw_values(rotor, random, &c);
    return c;
}

int power_prior_kinds(const struct scan *list, int shapes)
{
    int kinds = shapes ? FAULTS : 0;
    for (int i = 0; i < list->ncandidate; i++)
        kinds += !i || list->candidate[i].cause != list->candidate[i - 1].cause;
    return kinds;
}

static struct candidate draw_cause(const struct rotor *rotor, const struct scan *list, int shapes, struct hide_random *random)
{
    int kind = hide_pick(random, power_prior_kinds(list, shapes)) - (shapes ? FAULTS : 0), first = -1, count = 1;
    if (kind < 0)
        return draw_fault(rotor, kind + FAULTS, random);
    do
        first++;
    while ((kind -= !first || list->candidate[first].cause != list->candidate[first - 1].cause) >= 0);
    while (first + count < list->ncandidate && list->candidate[first + count].cause == list->candidate[first].cause)
        count++;
    struct candidate c = candidate_listed(list, first + hide_pick(random, count));
    draw_values(rotor, random, &c);
    return c;
}

/* Whether both can be in one explanation. */
static int go_together(const struct candidate *a, const struct candidate *b)
{
    int shared = 0;
    for (int i = 0; i < 4; i++)
        shared |= a->sensor[i / 2] && a->sensor[i / 2] == b->sensor[i % 2];
    if (a->cause->class == CAUSE_DATA)
        return !shared && (a->sensor[0] || a->cause != b->cause);
    int same = a->cause == b->cause && !strcmp(a->target, b->target);
    return !(same && a->cause->place < 0) &&
           !((a->cause->solid || b->cause->solid) && cause_of_beam(a->cause) && cause_of_beam(b->cause));
}

void power_prior_draw(const struct rotor *rotor, const struct scan *list, int shapes, struct hide_random *random,
                      struct explanation *e)
{
    double share[2 * (MOST_MEMBERS + 1)], sum = 0, all = 1;
    for (int i = 0; i < 2 * (MOST_MEMBERS + 1); i++) {
        all *= i > 3 && i % 2 == 0 ? i / 2 : 1; /* orders of a set, in which its causes are drawn */
        sum += share[i] = exp(posterior_log_prior(i / 2, i % 2)) / all;
    }
    int kind = 0, possible;
    for (double u = sum * hide_uniform(random); kind < 2 * MOST_MEMBERS + 1 && u >= share[kind]; kind++)
        u -= share[kind];
    *e = (struct explanation){.nmember = kind / 2, .something_else = kind % 2};
    do {
        possible = 1;
        for (int m = 0; m < e->nmember; m++) {
            e->member[m] = draw_cause(rotor, list, shapes, random);
            for (int k = 0; k < m; k++)
                possible &= go_together(&e->member[k], &e->member[m]);
        }
    } while (!possible);
}

/* ---- data */

struct drawing { /* of one explanation */
    struct pool *pool;
    struct hide_random *random;
    const struct hide_request *request;
    const struct explanation *e;
    struct job job; /* with what is in it, at x */
    double *x;
    struct job_measurement *m;
};

static int status_of(int status)
{
    return status == ROTID_OK || status == ROTID_ERROR_MEMORY ? status : AGAIN;
}

/* The rotor with the causes at drawn values of its own parameters, sensors where they are. */
static int add_causes(struct drawing *d)
{
    int nown = d->job.unknowns.nparameter, nsensor = d->job.rotor.nsensor, n = nown, status = ROTID_OK;
    d->x = POOL_ARRAY(d->pool, double, nown + MOST_MEMBERS * EFFECT_MOST_PARAMETERS);
    d->job.rotor.sensor = POOL_COPY(d->pool, d->job.rotor.sensor, nsensor, 0);
    if (!d->x || !d->job.rotor.sensor)
        return ROTID_ERROR_MEMORY;
    for (int p = 0; p < nown; p++)
        d->x[p] = hide_log_between(d->random, d->job.unknowns.bounds[p].lower, d->job.unknowns.bounds[p].upper);
    struct spectrum bare; /* modes are counted as those of the rotor without a cause */
    status = job_spectrum(d->pool, &d->job, d->x, d->request->modes, 0, &bare);
    d->job.rotor.settled_rigid = status ? 0 : 1 + bare.nrigid;
    for (int i = 0; i < d->e->nmember && !status; i++) {
        struct candidate c = d->e->member[i];
        const double *value = c.effect.value;
        if (c.cause->class == CAUSE_DATA) {
            const struct correction fault = {
                .id = c.cause->id, .nsensor = 1, .sensor = {c.sensor[0]}, .value = value[0], .more = {value[1], value[2]}};
            status =
                !strcmp(c.cause->id, "sensor_position") || !c.sensor[0] ? correction_apply(d->pool, &d->job, &fault) : ROTID_OK;
            continue;
        }
        c.effect.name = pool_format(d->pool, "hidden_%d", i + 1);
        status = c.effect.name ? job_with_effect(d->pool, &d->job, NULL, &c.effect, c.cause, NULL, &d->job) : ROTID_ERROR_MEMORY;
        for (int p = 0; p < effect_parameters(&c.effect) && !c.cause->solid; p++)
            d->x[n++] = value[p];
    }
    return status_of(status);
}

/* Data free of noise, on a mesh whose error is negligible. */
static int predict(struct drawing *d)
{
    int nmode = d->request->modes, nsensor = d->job.rotor.nsensor, rising = 1;
    struct job_measurement *m = d->m = &d->job.measurement;
    struct spectrum s;
    m->nmode = nmode;
    m->number = POOL_ARRAY(d->pool, int, nmode);
    m->holdout = POOL_ARRAY(d->pool, int, nmode);
    m->frequency_hz = POOL_ARRAY(d->pool, double, nmode);
    m->frequency_std = POOL_ARRAY(d->pool, double, nmode);
    m->shape = POOL_ARRAY(d->pool, double, (size_t)nmode *(size_t)nsensor);
    m->shape_std = POOL_ARRAY(d->pool, double, (size_t)nmode *(size_t)nsensor);
    if (d->pool->out_of_memory)
        return ROTID_ERROR_MEMORY;
    for (int k = 0; k < nmode; k++) {
        m->number[k] = k + 1;
        m->frequency_std[k] = d->request->frequency_noise;
    }
    int status = job_spectrum(d->pool, &d->job, d->x, nmode, SPECTRUM_MESH, &s);
    if (!status)
        status = base_refine(d->pool, &d->job, base_halvings(&d->job, m->number, &s));
    if (!status && !d->job.options.solid)
        status = job_spectrum(d->pool, &d->job, d->x, nmode, 0, &s);
    if (status || s.count < nmode)
        return status ? status_of(status) : AGAIN;
    for (int k = 0; k < nmode; k++) {
        m->frequency_hz[k] = s.full_hz[k];
        for (int i = 0; i < nsensor; i++) {
            m->shape[i + (ptrdiff_t)k * nsensor] = s.shape[i + (ptrdiff_t)k * s.nmaster];
            m->shape_std[i + (ptrdiff_t)k * nsensor] = d->request->shape_noise;
        }
        rising &= s.full_hz[k] > (k ? s.full_hz[k - 1] : 0);
    }
    if (d->request->no_shapes)
        m->shape = m->shape_std = NULL;
    return rising ? ROTID_OK : AGAIN;
}

/* Amplitude number i of n, from LEAST to MOST. */
static double amplitude(int i, int n)
{
    return i < 0 ? 0 : LEAST * pow(MOST / LEAST, i / (n - 1.0));
}

/* Residuals r [nrow] of random fields of stiffness and mass along the rotor: *found, some. */
static int add_profiles(struct drawing *d, const struct states *states, int kinds, double *r, int *found)
{
    struct scan scan;
    double size = 0.02 * pow(30, hide_pick(d->random, 5) / 4.0);
    int status = scan_run(d->pool, states, d->m->number, d->m->holdout, d->x, SCAN_FIELDS, &scan);
    double *column = status ? NULL : POOL_ARRAY(d->pool, double, (size_t)scan.nrow *EVIDENCE_PROFILE_TERMS);
    if (!column)
        return status ? status_of(status) : ROTID_ERROR_MEMORY;
    for (int k = 0; k < 2; k++) {
        int terms =
            kinds & 1 << k ? evidence_profile(&scan, states, catalogue_find(k ? "added_mass" : "stiffness_local"), column) : 0;
        *found |= terms > 0;
        for (int t = 0; t < terms; t++) {
            double one = size * hide_normal(d->random);
            for (int i = 0; i < scan.nrow; i++)
                r[i] += one * column[i + (ptrdiff_t)t * scan.nrow];
        }
    }
    return ROTID_OK;
}

/* The shape of mode k, a times as large, with r added so that its largest component stays 1. */
static int add_to_shape(struct drawing *d, int k, const double *r)
{
    int n = d->job.rotor.nsensor;
    double *shape = d->m->shape + (ptrdiff_t)k * n, low = 0, high = 4, noise = d->request->shape_noise;
    for (int pass = 0; pass < 60; pass++) {
        double a = (low + high) / 2, largest = 0;
        for (int i = 0; i < n; i++)
            largest = fmax(largest, fabs(a * shape[i] - noise * r[i]));
        *(largest > 1 ? &high : &low) = a;
    }
    for (int i = 0; i < n; i++)
        shape[i] = low * shape[i] - noise * r[i];
    return low > 0 ? ROTID_OK : AGAIN;
}

/* Something else, or what an approximation leaves of frequencies and shapes (known). */
static int add_fields(struct drawing *d, const double known[2])
{
    struct state state;
    const struct states states = states_of(&d->job, &state);
    struct evidence_data *data;
    int status = evidence_open(d->pool, &states, d->m->number, d->m->holdout, &data), kinds = hide_pick(d->random, 4), found = 0;
    double *r = status ? NULL : POOL_ARRAY(d->pool, double, data->nrow), line, field;
    if (!r)
        return status ? status_of(status) : ROTID_ERROR_MEMORY;
    memset(r, 0, (size_t)data->nrow * sizeof *r);
    if (!d->e->something_else) {
        line = known[0] / d->request->frequency_noise;
        field = known[1] / d->request->shape_noise;
    } else if (!kinds) {
        line = amplitude(hide_pick(d->random, 8), 8);
        field = amplitude(hide_pick(d->random, 16), 16);
    } else { /* one half without, else every second one, or none of one of them */
        int grid = data->nblock ? 9 : 1, some = hide_pick(d->random, 2) ? 1 + hide_pick(d->random, 5 * grid - 1) : 0;
        line = amplitude(2 * (some / grid) - 1, 8);
        field = amplitude(2 * (some % grid) - 1, 16);
        status = add_profiles(d, &states, kinds, r, &found);
        if (status || !found)
            return status ? status : AGAIN;
    }
    for (int i = 0; i < data->nrow; i++)
        r[i] += data->kind[i] == EVIDENCE_FREQUENCY ? line * hide_normal(d->random) : 0;
    for (int b = 0; b < data->nblock && !status; b++) {
        const struct evidence_block *block = &data->block[b];
        for (int j = 0; j < block->count; j++) {
            double one = field * sqrt(fmax(0, block->value[j])) * hide_normal(d->random);
            for (int i = 0; i < block->count; i++)
                r[block->row + i] += one * block->vector[i + (ptrdiff_t)j * block->count];
        }
        status = add_to_shape(d, block->mode, r + block->row);
    }
    for (int k = 0; k < d->m->nmode; k++) /* the first rows */
        d->m->frequency_hz[k] /= 1 + d->request->frequency_noise * r[k];
    return status;
}

/* The faults that act before the noise, and those behind it. */
static void add_faults(struct drawing *d, int behind)
{
    int n = d->job.rotor.nsensor;
    for (int f = 0; f < d->e->nmember; f++) {
        const struct candidate *c = &d->e->member[f];
        double deviation = 0, noise = d->request->shape_noise;
        if (c->cause->class != CAUSE_DATA || !c->sensor[0])
            continue;
        if (behind && !strcmp(c->cause->id, "duplicate_channel"))
            deviation = noise * hide_log_between(d->random, c->sensor[1] ? 1e-6 : 1, c->sensor[1] ? 1 : fmax(2, 1 / noise));
        int s = sensor_find(&d->job, c->sensor[0]), t = c->sensor[1] ? sensor_find(&d->job, c->sensor[1]) : -1;
        for (int k = 0; k < d->m->nmode; k++) {
            double *shape = d->m->shape + (ptrdiff_t)k * n, kept = shape[s];
            if (behind && deviation > 0)
                shape[s] = (t < 0 ? 0 : shape[t]) + deviation * hide_normal(d->random);
            else if (!behind && !strcmp(c->cause->id, "sensor_gain"))
                shape[s] *= c->effect.value[0];
            else if (!behind && !strcmp(c->cause->id, "sensor_sign"))
                shape[s] = -kept;
            else if (!behind && !strcmp(c->cause->id, "sensor_swap")) {
                shape[s] = shape[t];
                shape[t] = kept;
            }
        }
    }
}

/* Noise beside shapes whose largest component is 1, by factors a and b of that of frequencies and shapes. */
static int add_noise(struct drawing *d, double a, double b)
{
    int n = d->job.rotor.nsensor, rising = 1;
    for (int k = 0; k < d->m->nmode; k++) {
        double *shape = d->m->shape ? d->m->shape + (ptrdiff_t)k * n : NULL, largest = 0;
        d->m->frequency_hz[k] /= 1 + a * d->request->frequency_noise * hide_normal(d->random);
        rising &= d->m->frequency_hz[k] > (k ? d->m->frequency_hz[k - 1] : 0);
        for (int i = 0; i < n && shape; i++)
            largest = fmax(largest, fabs(shape[i]));
        for (int i = 0; i < n && shape; i++)
            shape[i] = shape[i] / largest + b * d->request->shape_noise * hide_normal(d->random);
    }
    return rising ? ROTID_OK : AGAIN;
}

static int make_data(struct drawing *d, int stated)
{
    double known[2] = {0, 0}, a = 1, b = 1;
    for (int i = 0; i < d->e->nmember; i++) {
        known[0] = hypot(known[0], d->e->member[i].cause->discrepancy_frequency);
        known[1] = hypot(known[1], d->e->member[i].cause->discrepancy_shape);
    }
    int fields = d->e->something_else || (known[0] > 0 && hide_pick(d->random, 2)), status = add_causes(d);
    if (!status)
        status = predict(d);
    if (!status && fields)
        status = add_fields(d, known);
    if (status)
        return status;
    if (!fields && !stated) { /* beside a field the noise is as stated */
        a = exp(DEVIATION * hide_normal(d->random));
        b = exp((hide_uniform(d->random) < MISSTATED ? MISTAKE : DEVIATION) * hide_normal(d->random));
    }
    if (d->m->shape)
        add_faults(d, 0);
    status = add_noise(d, a, b);
    if (d->m->shape)
        add_faults(d, 1);
    return status;
}

static void write_data(const struct drawing *d, struct hide_text *text)
{
    hide_add(text, "%s*NOISE, FREQUENCY=%.15g", d->request->deck, d->request->frequency_noise);
    if (d->m->shape)
        hide_add(text, ", SHAPE=%.15g", d->request->shape_noise);
    hide_add(text, "\n*MODES\n");
    for (int k = 0; k < d->m->nmode; k++)
        hide_add(text, "%d, %.15g\n", k + 1, d->m->frequency_hz[k]);
    for (int k = 0; k < d->m->nmode && d->m->shape; k++) {
        hide_add(text, "*SHAPE, MODE=%d\n", k + 1);
        for (int s = 0; s < d->job.rotor.nsensor; s++)
            hide_add(text, "%d, %.15g\n", d->job.rotor.sensor[s].id, d->m->shape[s + (ptrdiff_t)k * d->job.rotor.nsensor]);
    }
}

int power_prior_case(struct pool *pool, const struct hide_request *request, int stated, struct prior_case *out)
{
    struct hide_random random;
    struct message_list messages;
    struct states states;
    struct scan list;
    const struct deck_memory memory = {"prior", strlen(request->deck), request->deck, NULL};
    *out = (struct prior_case){0};
    message_open(&messages, pool);
    hide_random_open(request->seed, HIDE_FOR_EFFECTS, &random);
    int status = deck_read_states(pool, "prior", &memory, 0, NULL, &messages, &states);
    if (status)
        return status;
    struct job *job = &states.state->job;
    struct models *given = job->models;
    job->models = models_for_run(pool, given);
    status = job->models ? scan_list(pool, &states, &list) : ROTID_ERROR_MEMORY;
    for (int again = !status; again && out->draws < DRAWS; out->draws++) {
        struct drawing d = {.pool = pool, .random = &random, .request = request, .e = &out->truth, .job = *job};
        power_prior_draw(&job->rotor, &list, !request->no_shapes, &random, &out->truth);
        status = make_data(&d, stated);
        again = status == AGAIN;
        if (!status) {
            write_data(&d, &out->deck);
            out->segment = d.job.rotor.segment;
            out->x = d.x;
            out->nown = job->unknowns.nparameter;
        }
    }
    out->kinds = status ? 0 : power_prior_kinds(&list, !request->no_shapes);
    if (job->models)
        models_end_run(pool, job->models, given);
    return status == AGAIN ? ROTID_ERROR_ARGUMENT : out->deck.failed ? ROTID_ERROR_MEMORY : status;
}
