#include <math.h>

#include "report/report.h"
#include "result/result.h"

static struct ema_source source(const struct ema_report *r)
{
    const struct measurement *m = r->measurement;
    struct ema_source out = {
        .file = r->file,
        .quantity = (int)m->set.quantity,
        .transfer_functions = m->set.nfrf,
        .lines = m->set.nline,
        .low_hz = m->set.nline ? m->set.frequency_hz[0] : NAN,
        .high_hz = m->set.nline ? m->set.frequency_hz[m->set.nline - 1] : NAN,
        .from_time_records = m->from_records,
        .impacts = m->transfer.nimpact,
        .window_decay_per_s = m->set.window_decay,
    };
    for (int i = 0; i < m->transfer.nimpact; i++)
        out.impacts_used += m->transfer.impact[i].used;
    return out;
}

/* NULL: memory is out; of all below. */
static struct ema_shape_point *shape(struct pool *pool, const struct ema *ema, const struct ema_mode *m)
{
    struct ema_shape_point *list = POOL_ARRAY(pool, struct ema_shape_point, ema->npoint);
    struct ema_point_frequency *alone = POOL_ARRAY(pool, struct ema_point_frequency, ema->npoint);
    for (int p = 0; p < ema->npoint && list && alone; p++) {
        list[p] = (struct ema_shape_point){.node = ema->point_node[p],
                                           .direction = ema->point_direction[p],
                                           .value = m->shape[p],
                                           .std = m->shape_std[p],
                                           .complex_re = creal(m->complex_shape[p]),
                                           .complex_im = cimag(m->complex_shape[p])};
        if (m->point_frequency_hz) {
            alone[p] = (struct ema_point_frequency){m->point_frequency_hz[p], m->point_frequency_std[p]};
            list[p].alone = &alone[p];
        }
    }
    return alone ? list : NULL;
}

static struct ema_mode_result *modes(struct pool *pool, const struct ema *ema)
{
    struct ema_mode_result *list = POOL_ARRAY(pool, struct ema_mode_result, ema->nmode);
    for (int k = 0; k < ema->nmode && list; k++) {
        const struct ema_mode *m = &ema->mode[k];
        list[k] = (struct ema_mode_result){.mode = k + 1,
                                           .frequency_hz = m->frequency_hz,
                                           .frequency_std_hz = m->frequency_std,
                                           .damping = m->damping,
                                           .damping_std = m->damping_std,
                                           .mpc = m->mpc,
                                           .mpd_degrees = m->mpd,
                                           .modal_mass_kg = m->modal_mass,
                                           .peak_signal_to_noise = m->peak_signal_to_noise,
                                           .nearest_hz = m->nearest_hz,
                                           .doubts = m->quality_flags,
                                           .nshape = ema->npoint,
                                           .shape = shape(pool, ema, m)};
        if (!list[k].shape)
            return NULL;
    }
    return list;
}

static struct ema_pole_result *poles(struct pool *pool, const struct ema *ema)
{
    struct ema_pole_result *list = POOL_ARRAY(pool, struct ema_pole_result, ema->npole);
    for (int i = 0; i < ema->npole && list; i++) {
        const struct ema_pole *p = &ema->pole[i];
        list[i] = (struct ema_pole_result){p->order,
                                           p->frequency_hz,
                                           p->damping,
                                           p->stable_frequency,
                                           p->stable_damping,
                                           p->part,
                                           p->mode >= 0 ? p->mode + 1 : ROTID_NONE};
    }
    return list;
}

static struct ema_channel_result *channels(struct pool *pool, const struct ema_report *r)
{
    struct ema_channel_result *list = POOL_ARRAY(pool, struct ema_channel_result, r->ema->nfrf);
    for (int c = 0; c < r->ema->nfrf && list; c++) {
        const struct frf *f = &r->measurement->set.frf[c];
        const struct ema_channel *channel = &r->ema->channel[c];
        list[c] = (struct ema_channel_result){f->response_node, f->response_direction, f->reference_node, f->reference_direction,
                                              f->averages,      channel->fit,          channel->noise,    channel->quality_flags};
    }
    return list;
}

#define MOST_LINES   10000 /* of all curves together: more makes a file of megabytes */
#define LEAST_CURVES 3     /* the worst, the middle and the best one */

/* Transfer functions by rising FRAC, without those that have none; their number. */
static int by_frac(const struct ema *ema, int *order)
{
    int count = 0;
    for (int c = 0; c < ema->nfrf; c++) {
        int k = count;
        if (!isfinite(ema->channel[c].fit))
            continue;
        for (; k > 0 && ema->channel[order[k - 1]].fit > ema->channel[c].fit; k--)
            order[k] = order[k - 1];
        order[k] = c;
        count++;
    }
    return count;
}

/* 0 where memory is out. */
static int add_curve(struct pool *pool, const struct ema_report *r, int c, double complex *h, struct ema_curve *curve)
{
    const struct frf_set *set = &r->measurement->set;
    int n = set->nline;
    double *part[4];
    for (int i = 0; i < 4; i++)
        if (!(part[i] = POOL_ARRAY(pool, double, n)))
            return 0;
    ema_synthesise(r->ema, set, c, 1, n, set->frequency_hz, h);
    for (int l = 0; l < n; l++) {
        part[0][l] = creal(set->frf[c].h[l]);
        part[1][l] = cimag(set->frf[c].h[l]);
        part[2][l] = creal(h[l]);
        part[3][l] = cimag(h[l]);
    }
    *curve = (struct ema_curve){c + 1, n, set->frequency_hz, part[0], part[1], part[2], part[3]};
    return 1;
}

/* Of `count` functions in this order. 0 where memory is out. */
static int add_rms(struct pool *pool, const struct ema_report *r, int count, const int *order, double complex *h,
                   struct ema_result *out)
{
    const struct frf_set *set = &r->measurement->set;
    int n = set->nline;
    double *measured = POOL_ARRAY(pool, double, n), *synthesised = POOL_ARRAY(pool, double, n);
    if (!measured || !synthesised)
        return 0;
    for (int i = 0; i < count; i++) {
        ema_synthesise(r->ema, set, order[i], 1, n, set->frequency_hz, h);
        for (int l = 0; l < n; l++) {
            measured[l] += creal(set->frf[order[i]].h[l] * conj(set->frf[order[i]].h[l])) / count;
            synthesised[l] += creal(h[l] * conj(h[l])) / count;
        }
    }
    for (int l = 0; l < n; l++) {
        measured[l] = sqrt(measured[l]);
        synthesised[l] = sqrt(synthesised[l]);
    }
    out->nrms_frequency_hz = count ? n : 0;
    out->rms_frequency_hz = set->frequency_hz;
    out->rms_measured = measured;
    out->rms_synthesised = synthesised;
    return 1;
}

/* What was measured beside what the modes make of it. 0 where memory is out. */
static int add_functions(struct pool *pool, const struct ema_report *r, struct ema_result *out)
{
    int lines = r->measurement->set.nline, *order = POOL_ARRAY(pool, int, r->ema->nfrf);
    double complex *h = POOL_ARRAY(pool, double complex, lines);
    if (!order || !h)
        return 0;
    int count = by_frac(r->ema, order), taken = lines ? MOST_LINES / lines : 0;
    taken = taken < LEAST_CURVES ? LEAST_CURVES : taken;
    taken = taken > count ? count : taken;
    out->curves = POOL_ARRAY(pool, struct ema_curve, taken);
    for (int i = 0; i < taken && out->curves; i++, out->ncurves++)
        if (!add_curve(pool, r, order[taken > 1 ? (long long)i * (count - 1) / (taken - 1) : 0], h, &out->curves[i]))
            return 0;
    return out->curves && add_rms(pool, r, count, order, h, out);
}

const struct ema_result *ema_result_of(struct pool *pool, const struct ema_report *r, int functions)
{
    struct ema_result *out = POOL_NEW(pool, struct ema_result);
    if (!out)
        return NULL;
    *out = (struct ema_result){
        .source = source(r),
        .method = r->options->method,
        .order = r->ema->order,
        .refined = r->ema->refined > 0,
        .std_from = !r->ema->std_from_impacts, /* variance, residual */
        .output = r->output,
        .nmodes = r->ema->nmode,
        .modes = modes(pool, r->ema),
        .mac = r->ema->mac,
        .nstabilisation = r->ema->npole,
        .stabilisation = poles(pool, r->ema),
        .nchannels = r->ema->nfrf,
        .channels = channels(pool, r),
        .seconds = r->seconds,
    };
    return out->modes && out->stabilisation && out->channels && (!functions || add_functions(pool, r, out)) ? out : NULL;
}
