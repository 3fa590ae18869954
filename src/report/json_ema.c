#include <math.h>
#include <stdlib.h>

#include "result/json_tree.h"
#include "report/report_ema.h"

static void add_doubts(struct json_tree *tree, cJSON *parent, int doubts, const char *(*text)(int))
{
    cJSON *list = json_array(tree, parent, "doubts");
    for (int i = 0; text(i); i++)
        if (doubts & (1 << i))
            json_text(tree, list, NULL, text(i));
}

static void add_source(struct json_tree *tree, const struct ema_report *r)
{
    static const char *const quantity[] = {"displacement", "velocity", "acceleration"};
    const struct measurement *m = r->measurement;
    cJSON *source = json_object(tree, tree->root, "source");
    int used = 0;
    for (int i = 0; i < m->transfer.nimpact; i++)
        used += m->transfer.impact[i].used;
    json_text(tree, source, "file", r->file);
    json_text(tree, source, "quantity", quantity[m->set.quantity]);
    json_number(tree, source, "transfer_functions", m->set.nfrf);
    json_number(tree, source, "lines", m->set.nline);
    json_number(tree, source, "low_hz", m->set.nline ? m->set.frequency_hz[0] : NAN);
    json_number(tree, source, "high_hz", m->set.nline ? m->set.frequency_hz[m->set.nline - 1] : NAN);
    json_flag(tree, source, "from_time_records", m->from_records);
    json_number(tree, source, "impacts", m->transfer.nimpact);
    json_number(tree, source, "impacts_used", used);
    json_number(tree, source, "window_decay_per_s", m->set.window_decay);
}

static void add_shape(struct json_tree *tree, cJSON *parent, const struct ema *ema, const struct ema_mode *m)
{
    cJSON *list = json_array(tree, parent, "shape");
    for (int p = 0; p < ema->npoint; p++) {
        cJSON *point = json_object(tree, list, NULL);
        json_number(tree, point, "node", ema->point_node[p]);
        json_number(tree, point, "direction", ema->point_direction[p]);
        json_number(tree, point, "value", m->shape[p]);
        json_number(tree, point, "std", m->shape_std[p]);
        json_number(tree, point, "complex_re", creal(m->complex_shape[p]));
        json_number(tree, point, "complex_im", cimag(m->complex_shape[p]));
        if (m->point_frequency_hz) {
            json_number(tree, point, "frequency_hz", m->point_frequency_hz[p]);
            json_number(tree, point, "frequency_std_hz", m->point_frequency_std[p]);
        }
    }
}

static void add_modes(struct json_tree *tree, const struct ema *ema)
{
    cJSON *modes = json_array(tree, tree->root, "modes");
    for (int k = 0; k < ema->nmode; k++) {
        const struct ema_mode *m = &ema->mode[k];
        cJSON *mode = json_object(tree, modes, NULL);
        json_number(tree, mode, "mode", k + 1);
        json_number(tree, mode, "frequency_hz", m->frequency_hz);
        json_number(tree, mode, "frequency_std_hz", m->frequency_std);
        json_number(tree, mode, "damping", m->damping);
        json_number(tree, mode, "damping_std", m->damping_std);
        json_number(tree, mode, "mpc", m->mpc);
        json_number(tree, mode, "mpd_degrees", m->mpd);
        json_number(tree, mode, "modal_mass_kg", m->modal_mass);
        json_number(tree, mode, "peak_signal_to_noise", m->peak_signal_to_noise);
        json_number(tree, mode, "nearest_hz", m->nearest_hz);
        add_doubts(tree, mode, m->doubts, ema_mode_doubt);
        add_shape(tree, mode, ema, m);
    }
}

static void add_poles(struct json_tree *tree, const struct ema *ema)
{
    cJSON *list = json_array(tree, tree->root, "stabilisation");
    for (int i = 0; i < ema->npole; i++) {
        const struct ema_pole *p = &ema->pole[i];
        cJSON *pole = json_object(tree, list, NULL);
        json_number(tree, pole, "order", p->order);
        json_number(tree, pole, "frequency_hz", p->frequency_hz);
        json_number(tree, pole, "damping", p->damping);
        json_flag(tree, pole, "stable_frequency", p->stable_frequency);
        json_flag(tree, pole, "stable_damping", p->stable_damping);
        json_number(tree, pole, "part", p->part);
        if (p->mode >= 0)
            json_number(tree, pole, "mode", p->mode + 1);
        else
            json_null(tree, pole, "mode");
    }
}

static void add_channels(struct json_tree *tree, const struct ema_report *r)
{
    cJSON *list = json_array(tree, tree->root, "channels");
    for (int c = 0; c < r->ema->nfrf; c++) {
        const struct frf *f = &r->measurement->set.frf[c];
        cJSON *channel = json_object(tree, list, NULL);
        json_number(tree, channel, "response_node", f->response_node);
        json_number(tree, channel, "response_direction", f->response_direction);
        json_number(tree, channel, "reference_node", f->reference_node);
        json_number(tree, channel, "reference_direction", f->reference_direction);
        json_number(tree, channel, "averages", f->averages);
        json_number(tree, channel, "frac", r->ema->channel[c].fit);
        json_number(tree, channel, "noise", r->ema->channel[c].noise);
        add_doubts(tree, channel, r->ema->channel[c].doubts, ema_channel_doubt);
    }
}

char *json_ema(const struct provenance *provenance, const struct ema_report *r, const struct message_list *notes)
{
    struct json_tree tree;
    json_open(&tree);
    json_provenance(&tree, provenance);
    add_source(&tree, r);
    json_text(&tree, tree.root, "method", r->options->method == EMA_QUADRATURE ? "quadrature" : "lscf");
    json_number(&tree, tree.root, "order", r->ema->order);
    json_flag(&tree, tree.root, "refined", r->ema->refined > 0);
    json_text(&tree, tree.root, "std_from", r->ema->std_from_impacts ? "variance" : "residual");
    json_text(&tree, tree.root, "output", r->output);
    add_modes(&tree, r->ema);
    json_matrix(&tree, tree.root, "mac", r->ema->nmode, r->ema->nmode, r->ema->mac);
    add_poles(&tree, r->ema);
    add_channels(&tree, r);
    json_number(&tree, tree.root, "seconds", r->seconds);
    json_notes(&tree, notes);
    return json_close(&tree);
}
