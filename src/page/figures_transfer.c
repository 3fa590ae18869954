/* Transfer functions: magnitude over phase, synthesised and measured. */
#include <math.h>
#include <string.h>

#include "page/figures.h"
#include "page/human.h"
#include "page/palette.h"
#include "page/series.h"

#define MOST_FIGURES 4   /* of many functions: at the force, best, middle, worst */
#define BUCKETS      900 /* of lines: what is drawn is no finer than the page */
#define MOST_DECADES 7
#define DEGREES      57.295779513082321

enum { HZ, SIZE, PHASE }; /* columns */

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

/* The lines that are drawn of a function: in each bucket that of the least and that of the largest magnitude, so that no peak is
 * lost. Their number. line [nline] */
static int thin(int nline, const double *size, int *line)
{
    int count = 0, buckets = nline < 2 * BUCKETS ? nline : BUCKETS;
    for (int b = 0; b < buckets; b++) {
        int from = (int)((long long)b * nline / buckets), to = (int)((long long)(b + 1) * nline / buckets);
        int low = extreme(size, from, to, -1), high = extreme(size, from, to, 1);
        if (low >= 0)
            line[count++] = low < high ? low : high;
        if (low != high)
            line[count++] = low < high ? high : low;
    }
    return count;
}

/* re, im NULL: no rows. */
static struct series *collect(struct document *document, const char *name, const char *unit, int nline, const double *hz,
                              const double *re, const double *im)
{
    const struct column columns[] = {
        {"frequency", "Hz", AS_PLACE, 0}, {"magnitude", unit, AS_PLACE, 0}, {"phase", "\xc2\xb0", AS_PLACE, 0}};
    nline = re && im ? nline : 0;
    double *size = POOL_ARRAY(document->pool, double, nline);
    int *line = POOL_ARRAY(document->pool, int, nline);
    if (!size || !line) {
        document->failed = 1;
        return NULL;
    }
    for (int l = 0; l < nline; l++)
        size[l] = hypot(re[l], im[l]);
    int count = nline ? thin(nline, size, line) : 0;
    struct series *series = series_new(document, name, count, 3, columns);
    for (int i = 0; i < count; i++) {
        int l = line[i];
        series_row(series, i, (const double[]){hz[l], size[l] > 0 ? size[l] : (double)NAN, DEGREES * atan2(im[l], re[l])});
    }
    double *phase = series_values(series, PHASE);
    for (int i = count - 1; i > 0 && phase; i--) /* no line across the picture where the phase turns over */
        if (fabs(phase[i] - phase[i - 1]) > 180)
            phase[i] = NAN;
    return series;
}

/* Whether a frequency of an elastic mode lies within the lines. */
static int is_within(const struct transfer_result *out, const struct transfer_mode *mode, double hz)
{
    return !mode->rigid && hz >= out->low_hz && hz <= out->high_hz;
}

static void axes_of_modes(struct plot *plot, const struct transfer_result *out)
{
    for (int m = 0; m < out->nmodes; m++)
        if (is_within(out, &out->modes[m], out->modes[m].measured_hz))
            plot_line(plot, "set label %d '' at %.6g, graph 1.03 point ls 21 front", ++plot->labels, out->modes[m].measured_hz);
}

static int has_measured_modes(const struct transfer_result *out)
{
    for (int m = 0; m < out->nmodes; m++)
        if (is_within(out, &out->modes[m], out->modes[m].measured_hz))
            return 1;
    return 0;
}

static struct plot_range decades(struct series *series)
{
    return plot_decades(series_rows(series), series_values(series, SIZE), MOST_DECADES);
}

/* measured: without rows where there is none. */
static void draw(struct plot *plot, const struct transfer_result *out, struct series *synthesised, struct series *measured)
{
    struct plot_entry entry[3] = {{.text = "synthesised", .style = 1, .keys = KEY_LINE}};
    struct plot_layout layout = {.panels = 2, .columns = {1, 1}, .height = 220, .left = 66, .right = 14, .top = 16, .bottom = 48};
    struct plot_range range = decades(synthesised);
    int n = 1, both = series_rows(measured) > 0;
    if (both) {
        struct plot_range other = decades(measured);
        range = (struct plot_range){fmin(range.from, other.from), fmax(range.to, other.to)};
        entry[n++] = (struct plot_entry){.text = "measured", .style = 2, .keys = KEY_LINE};
    }
    if (has_measured_modes(out))
        entry[n++] = (struct plot_entry){.text = "measured frequency", .style = 21, .keys = KEY_MARK};
    plot_head(entry, n, layout.head);
    plot_line(plot, "set style line 21 lc rgb VERMILION pt 11 ps 0.8");
    plot_series(plot, synthesised);
    if (both)
        plot_series(plot, measured);
    plot_begin(plot, &layout);
    for (int i = 0; i < 2; i++) {
        char unit[64];
        plot_panel(plot, i);
        plot_line(plot, "set xrange [%.6g:%.6g]", out->low_hz, out->high_hz);
        if (i == 0) {
            (void)snprintf(unit, sizeof unit, "magnitude [%s]", strcmp(out->unit, "m/(s2 N)") ? out->unit : "m/(s\xc2\xb2 N)");
            plot_decades_axis(plot, 'y', &range, MOST_DECADES + 1);
            plot_legend(plot, entry, n);
            axes_of_modes(plot, out);
        } else {
            plot_line(plot, "set yrange [-190:190]\nset ytics 90");
        }
        plot_axes(plot, "frequency [Hz]", i ? "phase [\xc2\xb0]" : unit);
        plot_line(plot, "plot $synthesised using 1:%d with lines ls 1%s", i + 2,
                  !both ? ""
                  : i   ? ", $measured using 1:3 with lines ls 2"
                        : ", $measured using 1:2 with lines ls 2");
    }
}

static const char *caption(struct pool *pool, const struct transfer_result *out, const struct transfer_function *f)
{
    const char *where = !isfinite(f->response_z_m)
                            ? pool_format(pool, "Point %d over a force at point %d, %s per newton.", f->response, f->reference,
                                          out->quantity)
                            : pool_format(pool, "Point %d (%s\xc2\xa0m) over a force at point %d (%s\xc2\xa0m), %s per newton.",
                                          f->response, human_trimmed(pool, f->response_z_m, 4), f->reference,
                                          human_trimmed(pool, f->reference_z_m, 4), out->quantity),
               *agree = "";
    if (!where)
        return NULL;
    if (isfinite(frac(f)) && !isfinite(f->beside->agreement.frac_at_measured_frequencies))
        agree = pool_format(pool, " FRAC with the measured function is %s.", human_fixed(pool, frac(f), 4));
    else if (isfinite(frac(f)))
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

/* Both curves at the frequencies of the model; NULL without lines. */
static struct series *collect_peaks(struct document *document, const struct transfer_result *out,
                                    const struct transfer_function *f)
{
    const struct column columns[] = {
        {"mode", NULL, AS_FIXED, 0},         {"line", "Hz", AS_FIXED, 2},           {"synthesised", out->unit, AS_DIGITS, 3},
        {"phase", "\xc2\xb0", AS_SIGNED, 1}, {"measured", out->unit, AS_DIGITS, 3}, {"phase", "\xc2\xb0", AS_SIGNED, 1}};
    int rows = 0, row = 0;
    for (int m = 0; m < out->nmodes; m++)
        rows += is_within(out, &out->modes[m], out->modes[m].model_hz);
    struct series *series = f->nfrequency_hz ? series_new(document, "peaks", rows, f->measured_re ? 6 : 4, columns) : NULL;
    for (int m = 0; m < out->nmodes && f->nfrequency_hz; m++) {
        double hz = out->modes[m].model_hz;
        if (!is_within(out, &out->modes[m], hz))
            continue;
        int l = nearest(f, hz);
        double value[6] = {out->modes[m].mode, f->frequency_hz[l], hypot(f->synthesised_re[l], f->synthesised_im[l]),
                           DEGREES * atan2(f->synthesised_im[l], f->synthesised_re[l])};
        if (f->measured_re) {
            value[4] = hypot(f->measured_re[l], f->measured_im[l]);
            value[5] = DEGREES * atan2(f->measured_im[l], f->measured_re[l]);
        }
        series_row(series, row++, value);
    }
    return series;
}

void figure_transfer_function(struct document *document, const char *source, const struct transfer_result *out,
                              const struct transfer_function *f, const char *why)
{
    struct pool *pool = document->pool;
    const char *id = pool_format(pool, "transfer-%d-%d", f->response < 0 ? -f->response : f->response,
                                 f->reference < 0 ? -f->reference : f->reference),
               *title = pool_format(pool, "Transfer function between points %d and %d%s", f->response, f->reference, why);
    struct figure *figure = document_figure(document, id ? id : "", title ? title : "");
    figure->caption = caption(pool, out, f);
    figure->alt = pool_format(pool, "Magnitude with peaks at the resonances, and phase, from %s to %s Hz%s.",
                              human_trimmed(pool, out->low_hz, 4), human_trimmed(pool, out->high_hz, 5),
                              f->measured_re ? ", synthesised and measured" : ", synthesised");
    int n = f->nfrequency_hz;
    struct series *synthesised =
                      collect(document, "synthesised", out->unit, n, f->frequency_hz, f->synthesised_re, f->synthesised_im),
                  *measured = collect(document, "measured", out->unit, n, f->frequency_hz, f->measured_re, f->measured_im);
    struct plot plot;
    document->failed |= !id || !title;
    figure->table = series_table(collect_peaks(document, out, f));
    if (!synthesised || !measured || !figure_begin(document, figure, source, &plot))
        return;
    draw(&plot, out, synthesised, measured);
    figure_end(document, &plot);
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
            figure_transfer_function(document, result->file, out, &out->functions[i], "");
        return;
    }
    document_paragraph(document, "Of %d functions %s are drawn; the result has all.", n,
                       out->agreement && isfinite(out->agreement->frac) ? "the best, the middle and the worst one"
                                                                        : "the first four");
    sort_by_agreement(n, out, order);
    if (!isfinite(frac(&out->functions[order[0]]))) {
        for (int i = 0; i < MOST_FIGURES; i++)
            figure_transfer_function(document, result->file, out, &out->functions[i], "");
        return;
    }
    figure_transfer_function(document, result->file, out, &out->functions[order[n - 1]], ", the best of all");
    figure_transfer_function(document, result->file, out, &out->functions[order[n / 2]], ", the middle one");
    figure_transfer_function(document, result->file, out, &out->functions[order[0]], ", the worst of all");
}
