#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/base.h"
#include "report/report.h"
#include "result/result.h"

#define WIDTH       110
#define COLUMNS     96 /* of the stabilisation picture */
#define LISTED_ROWS 16
#define MOST_MAC    20
#define WORST       5

static void print_source(FILE *out, const struct ema_report *r)
{
    const struct measurement *m = r->measurement;
    const struct frf_set *set = &m->set;
    static const char *const quantity[] = {"receptance", "mobility", "accelerance"};
    (void)fprintf(out, "\n%s: %d transfer function%s (%s), %d points, %d lines from %.6g to %.6g Hz\n", r->file, set->nfrf,
                  set->nfrf == 1 ? "" : "s", quantity[set->quantity], r->ema->npoint, set->nline,
                  set->nline ? set->frequency_hz[0] : 0, set->nline ? set->frequency_hz[set->nline - 1] : 0);
    if (m->from_records) {
        int used = 0, twice = 0, cut = 0, clipped = 0;
        for (int i = 0; i < m->transfer.nimpact; i++) {
            used += m->transfer.impact[i].used;
            twice += m->transfer.impact[i].is_double;
            cut += m->transfer.impact[i].is_cut;
            clipped += m->transfer.impact[i].is_clipped;
        }
        (void)fprintf(out, "from %d time records at %.6g Hz: %d impacts, %d used (%d double, %d cut off, %d clipped)\n",
                      m->record_count, m->rate, m->transfer.nimpact, used, twice, cut, clipped);
        if (set->window_decay > 0)
            (void)fprintf(out, "exponential window: its decay of %.4g 1/s is taken off every pole\n", set->window_decay);
    }
    if (r->options->method == EMA_LSCF)
        (void)fprintf(out, "least-squares complex frequency to order %d%s; standard deviations from %s\n", r->ema->order,
                      r->ema->refined ? ", poles refined together" : "",
                      r->ema->std_from_impacts ? "the scatter of the impacts" : "what the modes leave over");
    else
        (void)fprintf(out, "quadrature picking, damping from the half-power points\n");
}

static void print_modes(FILE *out, const struct ema *ema)
{
    (void)fprintf(out,
                  "\n mode  frequency [Hz]     std    damping [%%]     std    MPC   MPD [deg]  peak/noise  modal mass [kg]\n");
    for (int k = 0; k < ema->nmode; k++) {
        const struct ema_mode *m = &ema->mode[k];
        (void)fprintf(out, "%5d  ", k + 1);
        digits_cell(out, 14, 8, m->frequency_hz);
        digits_cell(out, 9, 2, m->frequency_std);
        digits_cell(out, 14, 4, 100 * m->damping);
        digits_cell(out, 9, 2, 100 * m->damping_std);
        number_cell(out, 7, 3, m->mpc);
        number_cell(out, 11, 1, m->mpd);
        digits_cell(out, 12, 3, m->peak_signal_to_noise);
        digits_cell(out, 16, 4, m->modal_mass);
        (void)fprintf(out, "%s\n", m->quality_flags ? "  ?" : "");
    }
    if (!ema->nmode)
        (void)fprintf(out, "  none found\n");
}

static void print_doubts(FILE *out, const struct ema_report *r)
{
    const struct ema *ema = r->ema;
    int any = 0;
    for (int k = 0; k < ema->nmode; k++) {
        struct wrap wrap;
        char head[80];
        if (!ema->mode[k].quality_flags)
            continue;
        if (!any++)
            (void)fprintf(out, "\nDoubtful\n");
        (void)snprintf(head, sizeof head, "  mode %d, %.6g Hz: ", k + 1, ema->mode[k].frequency_hz);
        wrap_open(&wrap, out, 6, WIDTH, head);
        for (int i = 0, first = 1; ema_mode_doubts[i]; i++)
            if (ema->mode[k].quality_flags & (1 << i)) {
                wrap_words(&wrap, first ? "" : "; ");
                wrap_words(&wrap, ema_mode_doubts[i]);
                if ((1 << i) == EMA_CLOSE && isfinite(ema->mode[k].nearest_hz))
                    wrap_item(&wrap, "(%.6g Hz)", ema->mode[k].nearest_hz);
                first = 0;
            }
        wrap_close(&wrap);
    }
    for (int c = 0; c < ema->nfrf; c++) {
        const struct frf *f = &r->measurement->set.frf[c];
        if (!ema->channel[c].quality_flags)
            continue;
        if (!any++)
            (void)fprintf(out, "\nDoubtful\n");
        (void)fprintf(out, "  node %d over node %d:", f->response_node, f->reference_node);
        for (int i = 0; ema_channel_doubts[i]; i++)
            if (ema->channel[c].quality_flags & (1 << i)) {
                (void)fprintf(out, " %s", ema_channel_doubts[i]);
                if ((1 << i) == EMA_DUPLICATE && ema->channel[c].twin >= 0)
                    (void)fprintf(out, " of node %d", r->measurement->set.frf[ema->channel[c].twin].response_node);
                (void)fprintf(out, ";");
            }
        if (isfinite(ema->channel[c].fit))
            (void)fprintf(out, " fit %.3f", ema->channel[c].fit);
        (void)fprintf(out, "\n");
    }
    if (!any && ema->nmode)
        (void)fprintf(out, "\nNothing about the modes and the channels looks doubtful.\n");
}

/* Orders upwards, frequencies to the right: 's' stable, 'f' only its frequency, '.' neither; the modes stand below. */
static void print_stabilisation(FILE *out, const struct ema_report *r)
{
    const struct ema *ema = r->ema;
    const struct frf_set *set = &r->measurement->set;
    double low = set->frequency_hz[0], high = set->frequency_hz[set->nline - 1];
    char row[COLUMNS + 1];
    if (r->options->low_hz > 0)
        low = r->options->low_hz;
    if (r->options->high_hz > 0)
        high = r->options->high_hz;
    int highest = 0, step;
    for (int i = 0; i < ema->npole; i++)
        highest = ema->pole[i].order > highest ? ema->pole[i].order : highest;
    if (!highest || !(high > low))
        return;
    step = (highest + LISTED_ROWS - 1) / LISTED_ROWS;
    (void)fprintf(out, "\nStabilisation (s stable, f frequency only, . neither; every %dth order)\n", step);
    for (int order = highest; order > 0; order -= step) {
        memset(row, ' ', COLUMNS);
        row[COLUMNS] = 0;
        for (int i = 0; i < ema->npole; i++) {
            const struct ema_pole *p = &ema->pole[i];
            int column = (int)((p->frequency_hz - low) / (high - low) * COLUMNS);
            if (p->order != order || p->frequency_hz < low || column >= COLUMNS)
                continue;
            char mark = '.';
            if (p->stable_frequency)
                mark = p->stable_damping ? 's' : 'f';
            if (p->part && (mark != 's' || p->mode < 0)) /* tables of parts are dense: what counts of them are the modes */
                continue;
            if (row[column] == ' ' || mark == 's' || (mark == 'f' && row[column] == '.'))
                row[column] = mark;
        }
        (void)fprintf(out, "%5d |%s|\n", order, row);
    }
    memset(row, ' ', COLUMNS);
    for (int k = 0; k < ema->nmode; k++) {
        int column = (int)((ema->mode[k].frequency_hz - low) / (high - low) * COLUMNS);
        if (column >= 0 && column < COLUMNS)
            row[column] = '^';
    }
    (void)fprintf(out, " Hz   |%s|\n", row);
    (void)fprintf(out, "      %-*.6g%*.6g\n", COLUMNS / 2, low, COLUMNS / 2 + 2, high);
}

static void print_mac(FILE *out, const struct ema *ema)
{
    int count = ema->nmode < MOST_MAC ? ema->nmode : MOST_MAC;
    if (count < 2)
        return;
    (void)fprintf(out, "\nMAC of the shapes with each other [%%]%s\n     ",
                  ema->nmode > MOST_MAC ? ", the first twenty (all in the JSON)" : "");
    for (int j = 0; j < count; j++)
        (void)fprintf(out, "%5d", j + 1);
    for (int i = 0; i < count; i++) {
        (void)fprintf(out, "\n%5d", i + 1);
        for (int j = 0; j <= i; j++)
            number_cell(out, 5, 0, 100 * ema->mac[i + (ptrdiff_t)j * ema->nmode]);
    }
    (void)fprintf(out, "\n");
}

static void print_channels(FILE *out, const struct ema_report *r, int all)
{
    const struct ema *ema = r->ema;
    int *worst = calloc((size_t)ema->nfrf + 1, sizeof *worst), known = 0;
    for (int c = 0; c < ema->nfrf; c++)
        known += !isnan(ema->channel[c].fit);
    int shown = all || known < WORST ? known : WORST;
    if (!worst || !ema->nmode) {
        free(worst);
        return;
    }
    for (int c = 0; c < ema->nfrf; c++) /* insertion by rising fit; the channels of a test are hundreds */
        for (int i = c;; i--) {
            if (i && !(ema->channel[worst[i - 1]].fit <= ema->channel[c].fit) && !isnan(ema->channel[c].fit)) {
                worst[i] = worst[i - 1];
                continue;
            }
            worst[i] = c;
            break;
        }
    (void)fprintf(out, "\nFRAC of measured and synthesised transfer functions: median %.4f; %s\n",
                  known ? ema->channel[worst[known / 2]].fit : 0, shown < known ? "the worst" : "all");
    for (int i = 0; i < shown; i++) {
        const struct frf *f = &r->measurement->set.frf[worst[i]];
        (void)fprintf(out, "  node %d over node %d: %.4f", f->response_node, f->reference_node, ema->channel[worst[i]].fit);
        if (isfinite(ema->channel[worst[i]].noise))
            (void)fprintf(out, ", noise %.2g of the rms", ema->channel[worst[i]].noise);
        (void)fprintf(out, "\n");
    }
    free(worst);
}

static void print_poles(FILE *out, const struct ema *ema)
{
    (void)fprintf(out, "\norder  frequency [Hz]  damping [%%]  stable\n");
    for (int i = 0; i < ema->npole; i++) {
        const struct ema_pole *p = &ema->pole[i];
        (void)fprintf(out, "%5d", p->order);
        digits_cell(out, 16, 8, p->frequency_hz);
        digits_cell(out, 13, 4, 100 * p->damping);
        (void)fprintf(out, "  %s%s", p->stable_frequency ? "f" : "", p->stable_damping ? "d" : "");
        if (p->mode >= 0)
            (void)fprintf(out, "  mode %d", p->mode + 1);
        (void)fprintf(out, "\n");
    }
}

void table_ema(FILE *out, const struct ema_report *r, int all)
{
    print_source(out, r);
    print_modes(out, r->ema);
    print_doubts(out, r);
    print_stabilisation(out, r);
    if (all)
        print_poles(out, r->ema);
    print_mac(out, r->ema);
    print_channels(out, r, all);
    if (r->output)
        (void)fprintf(out, "\n%d mode%s written to %s\n", r->ema->nmode, r->ema->nmode == 1 ? "" : "s", r->output);
}
