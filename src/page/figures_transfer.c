/* Transfer functions: magnitude over phase, synthesised and measured. */
#include <math.h>
#include <string.h>

#include "page/figures.h"
#include "page/human.h"
#include "page/palette.h"
#include "page/plot.h"

#define MOST_FIGURES 4   /* of many functions: at the force, best, middle, worst */
#define BUCKETS      900 /* of lines: what is drawn is no finer than the page */
#define MOST_DECADES 7
#define DEGREES      57.295779513082321

struct curve { /* thinned: in each bucket the least and the largest magnitude, so that no peak is lost */
    int count;
    double *hz, *size, *phase;
};

static double frac(const struct transfer_function *f)
{
    return f->beside ? f->beside->agreement.frac : (double)NAN;
}

static int extreme(const double *size, int from, int to, int sign)
{
    int best = -1;
    for (int l = from; l < to; l++)
        if (isfinite(size[l]) && (best < 0 || sign * size[l] > sign * size[best]))
            best = l;
    return best;
}

/* NULL re: no curve. Nonzero: memory is out. */
static int thin(struct pool *pool, int nline, const double *hz, const double *re, const double *im, struct curve *curve)
{
    size_t room = (size_t)(nline < 2 * BUCKETS ? nline : 2 * BUCKETS);
    *curve = (struct curve){.count = 0};
    if (!re || !im)
        return 0;
    double *size = POOL_ARRAY(pool, double, nline), *kept = POOL_ARRAY(pool, double, 3 * room);
    if (!size || !kept)
        return 1;
    *curve = (struct curve){0, kept, kept + room, kept + 2 * room};
    for (int l = 0; l < nline; l++)
        size[l] = hypot(re[l], im[l]);
    int buckets = nline < 2 * BUCKETS ? nline : BUCKETS;
    for (int b = 0; b < buckets; b++) {
        int from = (int)((long long)b * nline / buckets), to = (int)((long long)(b + 1) * nline / buckets);
        int low = extreme(size, from, to, -1), high = extreme(size, from, to, 1);
        for (int i = 0; i < 2 && low >= 0; i++) {
            int l = (i == 0) == (low < high) ? low : high;
            if (i && low == high)
                break;
            curve->hz[curve->count] = hz[l];
            curve->size[curve->count] = size[l] > 0 ? size[l] : (double)NAN;
            curve->phase[curve->count++] = DEGREES * atan2(im[l], re[l]);
        }
    }
    for (int i = curve->count - 1; i > 0; i--) /* no line across the picture where the phase turns over */
        if (fabs(curve->phase[i] - curve->phase[i - 1]) > 180)
            curve->phase[i] = NAN;
    return 0;
}

static void axes_of_modes(struct plot *plot, const struct transfer_result *out)
{
    for (int m = 0; m < out->nmodes; m++)
        if (!out->modes[m].rigid && out->modes[m].measured_hz >= out->low_hz && out->modes[m].measured_hz <= out->high_hz)
            plot_line(plot, "set label %d '' at %.6g, graph 1.03 point ls 21 front", ++plot->labels, out->modes[m].measured_hz);
}

static int has_measured_modes(const struct transfer_result *out)
{
    for (int m = 0; m < out->nmodes; m++)
        if (!out->modes[m].rigid && out->modes[m].measured_hz >= out->low_hz && out->modes[m].measured_hz <= out->high_hz)
            return 1;
    return 0;
}

static int script(struct document *document, struct figure *figure, const struct result *result,
                  const struct transfer_function *f)
{
    struct pool *pool = document->pool;
    const struct transfer_result *out = result->frf;
    struct curve curve[2];
    struct plot plot;
    struct plot_entry entry[3] = {{.text = "synthesised", .style = 1, .keys = KEY_LINE}};
    struct plot_layout layout = {.panels = 2, .columns = {1, 1}, .height = 220, .left = 66, .right = 14, .top = 16, .bottom = 48};
    int n = 1;
    char unit[64];
    if (thin(pool, f->nfrequency_hz, f->frequency_hz, f->synthesised_re, f->synthesised_im, &curve[0]) ||
        thin(pool, f->nfrequency_hz, f->frequency_hz, f->measured_re, f->measured_im, &curve[1]))
        return ROTID_ERROR_MEMORY;
    if (curve[1].count)
        entry[n++] = (struct plot_entry){.text = "measured", .style = 2, .keys = KEY_LINE};
    if (has_measured_modes(out))
        entry[n++] = (struct plot_entry){.text = "measured frequency", .style = 21, .keys = KEY_MARK};
    plot_head(entry, n, layout.head);
    if (plot_open(&plot, pool, figure, result->file))
        return ROTID_ERROR_MEMORY;
    plot_line(&plot, "set style line 21 lc rgb VERMILION pt 11 ps 0.8\n# columns: frequency [Hz], magnitude, phase [degrees]");
    plot_data(&plot, "synthesised", curve[0].count, 3, (const double *const[]){curve[0].hz, curve[0].size, curve[0].phase});
    if (curve[1].count)
        plot_data(&plot, "measured", curve[1].count, 3, (const double *const[]){curve[1].hz, curve[1].size, curve[1].phase});
    struct plot_range range = plot_decades(curve[0].count, curve[0].size, MOST_DECADES);
    if (curve[1].count) {
        struct plot_range other = plot_decades(curve[1].count, curve[1].size, MOST_DECADES);
        range.from = fmin(range.from, other.from);
        range.to = fmax(range.to, other.to);
    }
    plot_begin(&plot, &layout);
    for (int i = 0; i < 2; i++) {
        plot_panel(&plot, i);
        plot_line(&plot, "set xrange [%.6g:%.6g]", out->low_hz, out->high_hz);
        if (i == 0) {
            (void)snprintf(unit, sizeof unit, "magnitude [%s]", strcmp(out->unit, "m/(s2 N)") ? out->unit : "m/(s\xc2\xb2 N)");
            plot_decades_axis(&plot, 'y', &range, MOST_DECADES + 1);
            plot_legend(&plot, entry, n);
            axes_of_modes(&plot, out);
        } else {
            plot_line(&plot, "set yrange [-190:190]\nset ytics 90");
        }
        plot_axes(&plot, "frequency [Hz]", i ? "phase [\xc2\xb0]" : unit);
        if (curve[1].count)
            plot_line(&plot, "plot $synthesised using 1:%d with lines ls 1, $measured using 1:%d with lines ls 2", i + 2, i + 2);
        else
            plot_line(&plot, "plot $synthesised using 1:%d with lines ls 1", i + 2);
    }
    return plot_close(&plot);
}

static const char *caption(struct pool *pool, const struct transfer_result *out, const struct transfer_function *f)
{
    const char *where = pool_format(pool, "Point %d (%s\xc2\xa0m) over a force at point %d (%s\xc2\xa0m), %s per newton.",
                                    f->response, human_trimmed(pool, f->response_z_m, 4), f->reference,
                                    human_trimmed(pool, f->reference_z_m, 4), out->quantity),
               *agree = "";
    if (!where)
        return NULL;
    if (isfinite(frac(f)))
        agree = pool_format(
            pool, " FRAC with the measured function is %s, and %s with the measured frequencies put in for the model's.",
            human_fixed(pool, frac(f), 3), human_fixed(pool, f->beside->agreement.frac_at_measured_frequencies, 3));
    else if (has_measured_modes(out)) {
        double worst = 0;
        int mode = 0;
        for (int m = 0; m < out->nmodes; m++) {
            double off = 100 * (out->modes[m].model_hz / out->modes[m].measured_hz - 1);
            if (!out->modes[m].rigid && fabs(off) > fabs(worst)) {
                worst = off;
                mode = out->modes[m].mode;
            }
        }
        agree = pool_format(
            pool, " No function was measured; of the measured frequencies the peak of mode %d is furthest away (%s\xc2\xa0%%).",
            mode, human_signed(pool, worst, 1));
    }
    return pool_format(pool, "%s%s", where, agree ? agree : "");
}

/* The line nearest to a frequency. */
static int nearest(const struct transfer_function *f, double hz)
{
    int best = 0;
    for (int l = 1; l < f->nfrequency_hz; l++)
        if (fabs(f->frequency_hz[l] - hz) < fabs(f->frequency_hz[best] - hz))
            best = l;
    return best;
}

static void add_value(struct number_table *table, struct pool *pool, int row, int column, double re, double im)
{
    table_cell(table, row, column, human_digits(pool, hypot(re, im), 3));
    table_cell(table, row, column + 1, human_signed(pool, DEGREES * atan2(im, re), 1));
}

/* Both curves at the frequencies of the model. */
static struct number_table *peaks_table(struct pool *pool, const struct transfer_result *out, const struct transfer_function *f)
{
    int rows = 0, row = 0, columns = f->measured_re ? 6 : 4;
    for (int m = 0; m < out->nmodes; m++)
        rows += !out->modes[m].rigid && out->modes[m].model_hz >= out->low_hz && out->modes[m].model_hz <= out->high_hz;
    struct number_table *table = f->nfrequency_hz ? table_new(pool, rows, columns) : NULL;
    table_head(table, 0, "mode");
    table_head(table, 1, "line [Hz]");
    for (int c = 2; c < columns; c += 2) {
        table_head(table, c, pool_format(pool, "%s [%s]", c == 2 ? "synthesised" : "measured", out->unit));
        table_head(table, c + 1, "phase [\xc2\xb0]");
    }
    for (int m = 0; m < out->nmodes && row < rows && table; m++) {
        if (out->modes[m].rigid || out->modes[m].model_hz < out->low_hz || out->modes[m].model_hz > out->high_hz)
            continue;
        int l = nearest(f, out->modes[m].model_hz);
        table_cell(table, row, 0, human_fixed(pool, out->modes[m].mode, 0));
        table_cell(table, row, 1, human_fixed(pool, f->frequency_hz[l], 2));
        add_value(table, pool, row, 2, f->synthesised_re[l], f->synthesised_im[l]);
        if (f->measured_re)
            add_value(table, pool, row, 4, f->measured_re[l], f->measured_im[l]);
        row++;
    }
    return table;
}

static void add(struct document *document, const struct result *result, const struct transfer_function *f, const char *why)
{
    struct pool *pool = document->pool;
    const struct transfer_result *out = result->frf;
    const char *id = pool_format(pool, "transfer-%d-%d", f->response < 0 ? -f->response : f->response,
                                 f->reference < 0 ? -f->reference : f->reference),
               *title = pool_format(pool, "Transfer function between points %d and %d%s", f->response, f->reference, why);
    struct figure *figure = document_figure(document, id ? id : "", title ? title : "");
    figure->caption = caption(pool, out, f);
    figure->alt = pool_format(pool, "Magnitude with peaks at the resonances, and phase, from %s to %s Hz%s.",
                              human_trimmed(pool, out->low_hz, 4), human_trimmed(pool, out->high_hz, 5),
                              f->measured_re ? ", synthesised and measured" : ", synthesised");
    figure->table = peaks_table(pool, out, f);
    document->failed |= !id || !title || !figure->caption || !figure->alt || script(document, figure, result, f) != ROTID_OK;
}

/* Functions by rising agreement with the measured ones; those without are left as they are. */
static void sort_by_agreement(int count, const struct transfer_result *out, int *order)
{
    for (int i = 1; i < count; i++)
        for (int k = i; k > 0 && frac(&out->functions[order[k]]) < frac(&out->functions[order[k - 1]]); k--) {
            int other = order[k];
            order[k] = order[k - 1];
            order[k - 1] = other;
        }
}

void figure_transfer(struct document *document, const struct result *result)
{
    const struct transfer_result *out = result->frf;
    int n = out->nfunctions, *order = POOL_ARRAY(document->pool, int, n);
    if (!order) {
        document->failed = 1;
        return;
    }
    for (int i = 0; i < n; i++)
        order[i] = i;
    if (!n || !out->with_curves)
        return;
    if (n <= MOST_FIGURES) {
        for (int i = 0; i < n; i++)
            add(document, result, &out->functions[i], "");
        return;
    }
    document_paragraph(document, "Of %d functions %s are drawn; the result has all.", n,
                       out->agreement && isfinite(out->agreement->frac) ? "the best, the middle and the worst one"
                                                                        : "the first four");
    sort_by_agreement(n, out, order);
    if (!isfinite(frac(&out->functions[order[0]]))) {
        for (int i = 0; i < MOST_FIGURES; i++)
            add(document, result, &out->functions[i], "");
        return;
    }
    add(document, result, &out->functions[order[n - 1]], ", the best of all");
    add(document, result, &out->functions[order[n / 2]], ", the middle one");
    add(document, result, &out->functions[order[0]], ", the worst of all");
}
