#include <math.h>

#include "report/report.h"
#include "result/result.h"

#define TWO_PI  6.28318530717958647692
#define DEGREES 57.295779513082321

static struct transfer_agreement agreement(const struct frf_sums *sums, const struct frf_sums *moved)
{
    return (struct transfer_agreement){frf_sums_frac(sums), frf_sums_frac(moved), frf_sums_frac_conjugate(sums),
                                       frf_sums_scale(sums), frf_sums_level(sums)};
}

/* Nonzero: memory is out; of all below. */
static int add_parameters(const struct frf_view *view, struct transfer_result *out)
{
    int n = view->identified ? view->identified->fit->n : 0;
    out->parameters = POOL_ARRAY(view->pool, struct transfer_parameter, n);
    for (int p = 0; p < n && out->parameters; p++)
        out->parameters[out->nparameters++] = (struct transfer_parameter){
            view->job->unknowns.bounds[p].name, view->job->unknowns.bounds[p].unit, view->identified->fit->x[p]};
    return !out->parameters;
}

static int add_modes(struct pool *pool, const struct frf_result *r, struct transfer_result *out)
{
    const struct synthesis *s = &r->synthesis;
    struct transfer_mode_agreement *agrees = POOL_ARRAY(pool, struct transfer_mode_agreement, r->nband);
    out->modes = POOL_ARRAY(pool, struct transfer_mode, s->nmode);
    if (!out->modes || !agrees)
        return 1;
    for (; out->nmodes < s->nmode; out->nmodes++) {
        int m = out->nmodes, number = m - s->nrigid + 1;
        out->modes[m] = (struct transfer_mode){.rigid = m < s->nrigid,
                                               .mode = m < s->nrigid ? ROTID_NONE : number,
                                               .model_hz = sqrt(fmax(s->lambda[m], 0)) / TWO_PI,
                                               .measured_hz = NAN,
                                               .damping = r->zeta[m],
                                               .damping_from = transfer_damping_words[r->damping[m]]};
        for (int b = 0; b < r->nband; b++) {
            const struct frf_band *band = &r->band[b];
            if (band->mode != number)
                continue;
            out->modes[m].measured_hz = band->measured_hz;
            agrees[b] = (struct transfer_mode_agreement){
                .frac = frf_sums_frac(&band->sums),
                .frac_at_measured_frequencies = frf_sums_frac(&band->moved),
                .level_db = frf_sums_level(&band->resonance),
                .phase_deg = carg(band->resonance.cross) * DEGREES,
                .worst_function = band->worst >= 0 ? band->worst : ROTID_NONE,
            };
            out->modes[m].agreement = r->is_measured ? &agrees[b] : NULL;
        }
    }
    return 0;
}

static struct transfer_beside *beside_measured(struct pool *pool, const struct frf_result *r, int i)
{
    const struct frf_row *row = &r->row[i];
    struct transfer_beside *beside = POOL_NEW(pool, struct transfer_beside);
    struct transfer_at_mode *mode = POOL_ARRAY(pool, struct transfer_at_mode, r->nband);
    if (!beside || !mode)
        return NULL;
    *beside = (struct transfer_beside){.agreement = agreement(&row->sums, &row->moved),
                                       .measured_reversed = row->sign < 0,
                                       .measured_reciprocal = row->is_reciprocal,
                                       .nat_modes = r->nband,
                                       .at_modes = mode};
    for (int b = 0; b < r->nband; b++) {
        const struct frf_at_mode *at = &r->at[b + (ptrdiff_t)i * r->nband];
        mode[b] = (struct transfer_at_mode){r->band[b].mode, at->level_db, at->phase_deg, at->deviation};
    }
    return beside;
}

static int add_parts(struct pool *pool, int n, const double complex *h, const double **re, const double **im)
{
    double *real = POOL_ARRAY(pool, double, n), *imag = POOL_ARRAY(pool, double, n);
    for (int l = 0; l < n && real && imag; l++) {
        real[l] = creal(h[l]);
        imag[l] = cimag(h[l]);
    }
    *re = real;
    *im = imag;
    return !real || !imag;
}

static int add_functions(const struct frf_view *view, struct transfer_result *out)
{
    struct pool *pool = view->pool;
    const struct frf_result *r = view->result;
    double complex *h = POOL_ARRAY(pool, double complex, r->nline), *work = POOL_ARRAY(pool, double complex, r->nline);
    double *frequency_hz = POOL_ARRAY(pool, double, r->nline);
    out->functions = POOL_ARRAY(pool, struct transfer_function, r->ndone);
    if (!h || !work || !frequency_hz || !out->functions)
        return 1;
    for (int l = 0; l < r->nline; l++)
        frequency_hz[l] = r->frequency_hz[l];
    for (; out->nfunctions < r->ndone; out->nfunctions++) {
        const struct frf_row *row = &r->row[out->nfunctions];
        struct transfer_function *f = &out->functions[out->nfunctions];
        *f = (struct transfer_function){.response = row->response,
                                        .reference = row->reference,
                                        .response_z_m = row->response_z,
                                        .reference_z_m = row->reference_z};
        if (r->is_measured && !(f->beside = beside_measured(pool, r, out->nfunctions)))
            return 1;
        if (!out->with_curves)
            continue;
        f->nfrequency_hz = r->nline;
        f->frequency_hz = frequency_hz;
        frf_synthesised(r, out->nfunctions, 1, h, work);
        if (add_parts(pool, r->nline, h, &f->synthesised_re, &f->synthesised_im))
            return 1;
        if (!r->is_measured)
            continue;
        frf_measured_curve(r, view->set, out->nfunctions, h);
        if (add_parts(pool, r->nline, h, &f->measured_re, &f->measured_im))
            return 1;
    }
    return 0;
}

const struct transfer_result *frf_result_of(const struct frf_view *view)
{
    const struct frf_result *r = view->result;
    struct transfer_agreement *all = POOL_NEW(view->pool, struct transfer_agreement);
    struct transfer_result *out = POOL_NEW(view->pool, struct transfer_result);
    if (!all || !out)
        return NULL;
    *all = agreement(&r->sums, &r->moved);
    *out = (struct transfer_result){
        .complete = r->ndone == r->nrow,
        .quantity = transfer_quantity_words[r->quantity],
        .unit = transfer_unit_words[r->quantity],
        .lines = r->nline,
        .low_hz = r->frequency_hz[0],
        .high_hz = r->frequency_hz[r->nline - 1],
        .modes_up_to_hz = r->up_to_hz,
        .window_decay = r->decay,
        .measured_file = r->is_measured ? view->job->options.frf.file : NULL,
        .agreement = r->is_measured ? all : NULL,
        .left_out = r->is_measured ? r->nleft_out : ROTID_NONE,
        .with_curves = (double)r->nline * r->ndone <= JSON_FRF_MOST_LINES,
    };
    int failed = add_parameters(view, out) || add_modes(view->pool, r, out) || add_functions(view, out);
    return failed ? NULL : out;
}
