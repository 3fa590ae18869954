/* The stabilisation diagram of a modal analysis, over the magnitude of all transfer functions. */
#include <math.h>

#include "page/figures.h"
#include "page/human.h"
#include "page/series.h"
#include "result/ema.h"
#include "result/transfer.h"

#define MOST_DECADES 6
#define BUCKETS      700 /* of the magnitude: two lines drawn in each */

enum { FREQUENCY, ORDER, DAMPING, STABLE };      /* columns of the poles */
enum { UNSTABLE, STABLE_FREQUENCY, STABLE_ALL }; /* values of the last one */
enum { MEASURED = 1, SYNTHESISED };              /* columns of the magnitude */

static struct series *collect_poles(struct document *document, const struct ema_result *ema)
{
    static const struct column columns[] = {{"frequency", "Hz", AS_PLACE, 0},
                                            {"order", NULL, AS_PLACE, 0},
                                            {"damping", "%", AS_PLACE, 0},
                                            {"2: stable, 1: its frequency alone", NULL, AS_PLACE, 0}};
    struct series *series = series_new(document, "poles", ema->nstabilisation, 4, columns);
    for (int i = 0; i < ema->nstabilisation; i++) {
        const struct ema_pole_result *pole = &ema->stabilisation[i];
        series_row(series, i,
                   (const double[]){pole->frequency_hz, pole->order, 100 * pole->damping,
                                    !pole->stable_frequency ? UNSTABLE
                                    : pole->stable_damping  ? STABLE_ALL
                                                            : STABLE_FREQUENCY});
    }
    return series;
}

/* The lines of least and largest measured magnitude in each bucket, so that no peak is lost. */
static struct series *collect_magnitude(struct document *document, const struct ema_result *ema)
{
    const char *unit = transfer_unit_words[ema->source.quantity];
    const struct column columns[] = {
        {"frequency", "Hz", AS_PLACE, 0}, {"measured", unit, AS_PLACE, 0}, {"synthesised", unit, AS_PLACE, 0}};
    int n = ema->nrms_frequency_hz, buckets = n < 2 * BUCKETS ? n : BUCKETS, count = 0,
        *line = POOL_ARRAY(document->pool, int, 2 * (size_t)buckets);
    const double *size = ema->rms_measured;
    if (!line) {
        document->failed = 1;
        return NULL;
    }
    for (int b = 0; b < buckets; b++) {
        int from = (int)((long long)b * n / buckets), to = (int)((long long)(b + 1) * n / buckets), low = from, high = from;
        for (int l = from; l < to; l++) {
            low = size[l] < size[low] ? l : low;
            high = size[l] > size[high] ? l : high;
        }
        line[count++] = low < high ? low : high;
        if (low != high)
            line[count++] = low < high ? high : low;
    }
    struct series *series = series_new(document, "magnitude", count, 3, columns);
    for (int i = 0; i < count; i++) {
        int l = line[i];
        series_row(series, i, (const double[]){ema->rms_frequency_hz[l], size[l], ema->rms_synthesised[l]});
    }
    return series;
}

static void draw_modes(struct plot *plot, const struct ema_result *ema)
{
    for (int k = 0; k < ema->nmodes; k++)
        plot_line(plot, "set arrow %d from first %.7g, graph 0 to first %.7g, graph 1 nohead back ls %d", k + 1,
                  ema->modes[k].frequency_hz, ema->modes[k].frequency_hz, ema->modes[k].doubts ? 25 : 24);
}

static int any_doubt(const struct ema_result *ema)
{
    for (int k = 0; k < ema->nmodes; k++)
        if (ema->modes[k].doubts)
            return 1;
    return 0;
}

static void draw(struct plot *plot, const struct ema_result *ema, struct series *poles, struct series *magnitude)
{
    struct plot_entry entry[7] = {{.text = "stable", .style = 21, .keys = KEY_MARK},
                                  {.text = "frequency alone stable", .style = 22, .keys = KEY_MARK},
                                  {.text = "not stable", .style = 23, .keys = KEY_MARK}};
    struct plot_layout layout = {.panels = 2, .columns = {1, 1}, .height = 230, .left = 66, .right = 14, .top = 16, .bottom = 48};
    int n = series_rows(poles) ? 3 : 0, rows = series_rows(magnitude), first = series_rows(poles) ? 0 : 1;
    if (ema->nmodes)
        entry[n++] = (struct plot_entry){.text = "mode", .style = 24, .keys = KEY_LINE};
    if (any_doubt(ema))
        entry[n++] = (struct plot_entry){.text = "doubtful mode", .style = 25, .keys = KEY_LINE};
    entry[n++] = (struct plot_entry){.text = "measured", .style = 2, .keys = KEY_LINE};
    entry[n++] = (struct plot_entry){.text = "synthesised", .style = 1, .keys = KEY_LINE};
    layout.panels = (first == 0) + (rows > 0);
    plot_head(entry, n, layout.head);
    plot_line(plot, "set style line 21 lc rgb GREEN pt 7 ps 0.45\nset style line 22 lc rgb BLUE pt 6 ps 0.45\n"
                    "set style line 23 lc rgb MUTED pt 7 ps 0.12\nset style line 24 lc rgb INK lw 1 dt (8,4)\n"
                    "set style line 25 lc rgb VERMILION lw 1.5 dt (2,3)");
    plot_series(plot, poles);
    plot_series(plot, magnitude);
    plot_begin(plot, &layout);
    for (int i = 0; i < layout.panels; i++) {
        plot_panel(plot, i);
        if (i == 0)
            plot_legend(plot, entry, n);
        plot_line(plot, "set xrange [%.7g:%.7g]", ema->source.low_hz, ema->source.high_hz);
        draw_modes(plot, ema);
        if (first + i == 0) {
            plot_line(plot, "set yrange [0:%d]", ema->order + 2);
            plot_axes(plot, "frequency [Hz]", "order [1]");
            plot_line(plot,
                      "plot $poles using ($4 == 0 ? $1 : NaN):2 with points ls 23, \\\n     $poles using ($4 == 1 ? $1 : NaN):2 "
                      "with points ls 22, \\\n     $poles using ($4 == 2 ? $1 : NaN):2 with points ls 21");
            continue;
        }
        char axis[64];
        struct plot_range range = plot_decades(rows, series_values(magnitude, MEASURED), MOST_DECADES);
        const char *unit = transfer_unit_words[ema->source.quantity];
        (void)snprintf(axis, sizeof axis, "rms magnitude [%s]", unit);
        plot_decades_axis(plot, 'y', &range, MOST_DECADES + 1);
        plot_axes(plot, "frequency [Hz]", axis);
        plot_line(plot, "plot $magnitude using 1:2 with lines ls 2, $magnitude using 1:3 with lines ls 1");
    }
}

void figure_stabilisation(struct document *document, const struct result *result)
{
    const struct ema_result *ema = result->ema;
    struct pool *pool = document->pool;
    int stable = 0;
    if (!ema->nstabilisation && !ema->nrms_frequency_hz)
        return;
    for (int i = 0; i < ema->nstabilisation; i++)
        stable += ema->stabilisation[i].stable_frequency && ema->stabilisation[i].stable_damping;
    struct figure *figure = document_figure(document, "stabilisation",
                                            ema->nstabilisation ? "Stabilisation of the poles" : "Magnitude of all functions");
    figure->caption =
        ema->nstabilisation
            ? pool_format(pool,
                          "Poles of least-squares fits of rising order; %d of %d are stable: the order before has them within "
                          "0.2\xc2\xa0%% in frequency and 5\xc2\xa0%% in damping. A mode stands where they line up. Below, the "
                          "root mean square of all transfer functions.",
                          stable, ema->nstabilisation)
            : "Root mean square of all transfer functions; modes were picked at its peaks.";
    figure->alt =
        pool_format(pool,
                    "Poles over frequency and order from %s to %s Hz, with lines at %d modes, and the magnitude of "
                    "all functions, measured and synthesised.",
                    human_trimmed(pool, ema->source.low_hz, 4), human_trimmed(pool, ema->source.high_hz, 5), ema->nmodes);
    struct series *poles = collect_poles(document, ema), *magnitude = collect_magnitude(document, ema);
    struct plot plot;
    if (!poles || !magnitude || !figure_begin(document, figure, result->file, &plot))
        return;
    draw(&plot, ema, poles, magnitude);
    figure_end(document, &plot);
}
