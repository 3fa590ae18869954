#include <math.h>

#include "result/json_tree.h"
#include "report/report_frf.h"

static const char *source_word(enum frf_damping damping)
{
    static const char *const words[] = {"measured", "stated", "smallest_measured", "mean_measured"};
    return words[damping];
}

static void add_parts(struct json_tree *tree, cJSON *item, const char *re, const char *im, int n, const double complex *h)
{
    cJSON *real = json_array(tree, item, re), *imag = json_array(tree, item, im);
    for (int l = 0; l < n && real && imag; l++) {
        json_number(tree, real, NULL, creal(h[l]));
        json_number(tree, imag, NULL, cimag(h[l]));
    }
}

static void add_modes(struct json_tree *tree, const struct frf_result *r)
{
    const struct synthesis *s = &r->synthesis;
    cJSON *list = json_array(tree, tree->root, "modes");
    for (int m = 0; m < s->nmode; m++) {
        const struct frf_band *band = NULL;
        for (int b = 0; b < r->nband; b++)
            band = r->band[b].mode == m - s->nrigid + 1 ? &r->band[b] : band;
        cJSON *item = json_object(tree, list, NULL);
        json_flag(tree, item, "rigid", m < s->nrigid);
        json_number(tree, item, "mode", m < s->nrigid ? (double)NAN : (double)(m - s->nrigid + 1));
        json_number(tree, item, "model_hz", sqrt(fmax(s->lambda[m], 0)) / 6.28318530717958647692);
        json_number(tree, item, "measured_hz", band ? band->measured_hz : NAN);
        json_number(tree, item, "damping", r->zeta[m]);
        json_text(tree, item, "damping_from", source_word(r->damping[m]));
        if (!band || !r->is_measured)
            continue;
        json_number(tree, item, "frac", frf_sums_frac(&band->sums));
        json_number(tree, item, "frac_at_measured_frequencies", frf_sums_frac(&band->moved));
        json_number(tree, item, "level_db", frf_sums_level(&band->resonance));
        json_number(tree, item, "phase_deg", carg(band->resonance.cross) * 57.295779513082321);
        json_number(tree, item, "worst_function", band->worst >= 0 ? (double)band->worst : (double)NAN);
    }
}

static void add_agreement(struct json_tree *tree, cJSON *item, const struct frf_sums *sums, const struct frf_sums *moved)
{
    json_number(tree, item, "frac", frf_sums_frac(sums));
    json_number(tree, item, "frac_at_measured_frequencies", frf_sums_frac(moved));
    json_number(tree, item, "frac_of_conjugate", frf_sums_frac_conjugate(sums));
    json_number(tree, item, "scale", frf_sums_scale(sums));
    json_number(tree, item, "level_db", frf_sums_level(sums));
}

static void add_at_modes(struct json_tree *tree, cJSON *item, const struct frf_result *r, int row)
{
    cJSON *list = json_array(tree, item, "at_modes");
    for (int b = 0; b < r->nband; b++) {
        const struct frf_at_mode *at = &r->at[b + (ptrdiff_t)row * r->nband];
        cJSON *mode = json_object(tree, list, NULL);
        json_number(tree, mode, "mode", r->band[b].mode);
        json_number(tree, mode, "level_db", at->level_db);
        json_number(tree, mode, "phase_deg", at->phase_deg);
        json_number(tree, mode, "deviation", at->deviation);
    }
}

static void add_functions(struct json_tree *tree, const struct frf_view *view)
{
    const struct frf_result *r = view->result;
    int curves = (double)r->nline * r->ndone <= JSON_FRF_MOST_LINES;
    double complex *h = POOL_ARRAY(view->pool, double complex, r->nline),
                   *work = POOL_ARRAY(view->pool, double complex, r->nline);
    cJSON *list = json_array(tree, tree->root, "functions");
    tree->failed |= !h || !work;
    json_flag(tree, tree->root, "with_curves", curves);
    for (int i = 0; i < r->ndone && !tree->failed; i++) {
        const struct frf_row *row = &r->row[i];
        cJSON *item = json_object(tree, list, NULL);
        json_number(tree, item, "response", row->response);
        json_number(tree, item, "reference", row->reference);
        json_number(tree, item, "response_z_m", row->response_z);
        json_number(tree, item, "reference_z_m", row->reference_z);
        if (r->is_measured) {
            add_agreement(tree, item, &row->sums, &row->moved);
            json_flag(tree, item, "measured_reversed", row->sign < 0);
            json_flag(tree, item, "measured_reciprocal", row->is_reciprocal);
            add_at_modes(tree, item, r, i);
        }
        if (!curves)
            continue;
        json_list(tree, item, "frequency_hz", r->nline, r->frequency_hz);
        frf_synthesised(r, i, 1, h, work);
        add_parts(tree, item, "synthesised_re", "synthesised_im", r->nline, h);
        if (r->is_measured) {
            frf_measured_curve(r, view->set, i, h);
            add_parts(tree, item, "measured_re", "measured_im", r->nline, h);
        }
    }
}

char *json_frf(const struct provenance *provenance, const struct frf_view *view, const struct message_list *notes)
{
    const struct frf_result *r = view->result;
    struct json_tree tree;
    json_begin(&tree, provenance, view->job);
    cJSON *root = tree.root;
    json_flag(&tree, root, "complete", r->ndone == r->nrow);
    json_text(&tree, root, "quantity", frf_quantity_word(r->quantity));
    json_text(&tree, root, "unit", frf_quantity_unit(r->quantity));
    json_number(&tree, root, "lines", r->nline);
    json_number(&tree, root, "low_hz", r->frequency_hz[0]);
    json_number(&tree, root, "high_hz", r->frequency_hz[r->nline - 1]);
    json_number(&tree, root, "modes_up_to_hz", r->up_to_hz);
    json_number(&tree, root, "window_decay", r->decay);
    json_text(&tree, root, "measured_file", r->is_measured ? view->job->frf.file : NULL);
    cJSON *parameters = json_array(&tree, root, "parameters");
    for (int p = 0; view->identified && p < view->identified->fit->n; p++) {
        cJSON *item = json_object(&tree, parameters, NULL);
        json_text(&tree, item, "name", view->job->bounds[p].name);
        json_text(&tree, item, "unit", view->job->bounds[p].unit);
        json_number(&tree, item, "value", view->identified->fit->x[p]);
    }
    add_modes(&tree, r);
    if (r->is_measured) {
        cJSON *all = json_object(&tree, root, "agreement");
        add_agreement(&tree, all, &r->sums, &r->moved);
        json_number(&tree, root, "left_out", r->nleft_out);
    }
    add_functions(&tree, view);
    json_notes(&tree, notes);
    return json_close(&tree);
}
