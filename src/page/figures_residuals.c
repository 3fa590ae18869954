/* What the model misses, in units of the noise: modes in one panel, sensors in another. */
#include <math.h>

#include "fit/quantile.h"
#include "page/figures_diagnosis.h"
#include "page/human.h"
#include "page/series.h"

#define OUTSIDE    0.05 /* what noise alone leaves beyond the thresholds */
#define NORMAL_95  1.96
#define MOST_TICKS 12 /* numbers of modes side by side in a panel of half the page */

struct misfit {
    int worst, beyond, fitted; /* mode with the largest residual, -1: none; fitted ones beyond the threshold, and in all */
    int shapes, sensors, loud, loudest; /* fitted shapes; sensors with a number, beyond the limit; the worst, -1: none */
    double limit;                       /* of a sensor */
};

static struct misfit sum_up(const rotid_diagnosis *d)
{
    struct misfit m = {.worst = -1, .loudest = -1, .limit = NAN};
    const rotid_identification *base = d->base;
    for (int k = 0; k < d->nmodes_standardised; k++) {
        if (!isfinite(d->modes_standardised[k]))
            continue;
        if (!base->modes[k].holdout) {
            m.fitted++;
            m.beyond += fabs(d->modes_standardised[k]) > NORMAL_95;
        }
        if (m.worst < 0 || fabs(d->modes_standardised[k]) > fabs(d->modes_standardised[m.worst]))
            m.worst = k;
    }
    for (int k = 0; base->shapes && k < base->shapes->nmodes && k < base->nmodes; k++)
        m.shapes += base->shapes->modes[k].measured && !base->modes[k].holdout;
    if (m.shapes)
        m.limit = sqrt(chi_square_limit(OUTSIDE, m.shapes) / m.shapes);
    for (int s = 0; s < d->nsensors; s++) {
        if (!isfinite(d->sensors[s].rms))
            continue;
        m.sensors++;
        m.loud += d->sensors[s].rms > m.limit;
        if (m.loudest < 0 || d->sensors[s].rms > d->sensors[m.loudest].rms)
            m.loudest = s;
    }
    return m;
}

struct residuals {
    struct series *modes, *sensors;
};

static struct residuals collect(struct document *document, const rotid_diagnosis *d, const struct misfit *m)
{
    static const struct column of_modes[] = {{"place", NULL, AS_PLACE, 0},
                                             {"mode", NULL, AS_TEXT, 0},
                                             {"measured", "Hz", AS_FIXED, 3},
                                             {"residual/sigma", "1", AS_SIGNED, 2}};
    static const struct column of_sensors[] = {
        {"sensor", NULL, AS_TEXT, 0}, {"z", "m", AS_FIXED, 4}, {"residual/sigma", "1", AS_FIXED, 2}};
    struct residuals r = {series_new(document, "modes", d->nmodes_standardised, 4, of_modes),
                          series_new(document, "sensors", m->sensors ? d->nsensors : 0, 3, of_sensors)};
    for (int k = 0; k < d->nmodes_standardised; k++) {
        const rotid_compared_mode *mode = &d->base->modes[k];
        series_row(r.modes, k, (const double[]){k + 1, mode->measured_hz, d->modes_standardised[k]});
        series_text(r.modes, k, 1, pool_format(document->pool, "mode %d%s", mode->mode, mode->holdout ? ", held out" : ""));
    }
    for (int s = 0; s < d->nsensors && m->sensors; s++) {
        series_row(r.sensors, s, (const double[]){d->sensors[s].z_m, d->sensors[s].rms});
        series_text(r.sensors, s, 0, pool_format(document->pool, "sensor %d", d->sensors[s].id));
    }
    return r;
}

static void draw_modes(struct plot *plot, const rotid_diagnosis *d)
{
    int n = d->nmodes_standardised;
    struct plot_range range = plot_range_of(n, d->modes_standardised, 0);
    plot_range_join(&range, NORMAL_95);
    plot_range_join(&range, -NORMAL_95);
    double pad = 0.1 * (range.to - range.from);
    plot_line(plot, "set xrange [0.4:%g]\nset yrange [%.6g:%.6g]", n + 0.6, range.from - pad, range.to + pad);
    plot_mode_tics(plot, n, d->base->modes, MOST_TICKS);
    plot_axes(plot, "mode of the model [1]", "residual/sigma [1]");
    plot_line(plot, "set style fill solid noborder\nset boxwidth 0.6");
    plot_line(plot,
              "plot $modes using 1:3 with boxes fc rgb BLUE, 0 with lines lc rgb INK lw 1 dt 1, \\\n"
              "    %g with lines ls 2 lw 1, -%g with lines ls 2 lw 1",
              NORMAL_95, NORMAL_95);
}

static void draw_sensors(struct plot *plot, const struct result *result, struct series *sensors, const struct misfit *m)
{
    const rotid_diagnosis *d = result->diagnose;
    const rotid_geometry *geometry = geometry_of_result(result);
    struct plot_range range = plot_range_of(d->nsensors, series_values(sensors, 2), 0);
    double length = geometry ? geometry->length_m : d->sensors[d->nsensors - 1].z_m;
    length = length > 0 ? length : 1;
    range.to = fmax(range.to, fmax(1, m->limit));
    plot_line(plot, "set xrange [%.6g:%.6g]\nset yrange [0:%.6g]\nset xtics %g", -0.02 * length, 1.02 * length, 1.1 * range.to,
              plot_tic(length, 4));
    plot_axes(plot, "position of the sensor z [m]", "rms of its residuals/sigma [1]");
    plot_line(plot,
              "plot $sensors using 1:2 with impulses lc rgb BLUE lw 2 dt 1, 1 with lines lc rgb INK lw 1 dt 1, \\\n"
              "    %s with lines ls 2 lw 1",
              plot_number(plot, m->limit));
}

static void script(struct plot *plot, const struct result *result, const struct residuals *r, const struct misfit *m)
{
    int two = m->sensors > 0;
    const struct plot_entry entry[] = {
        {.text = "residual", .keys = KEY_FACE, .face = "BLUE"},
        {.text = "1 in 20 lies beyond by noise alone", .style = 2, .keys = KEY_LINE},
    };
    struct plot_layout layout = {
        .panels = 1 + two, .columns = {1 + two, 1}, .height = 250, .left = 54, .right = 10, .top = 8, .bottom = 48};
    plot_head(entry, 2, layout.head);
    plot_series(plot, r->modes);
    if (two)
        plot_series(plot, r->sensors);
    plot_begin(plot, &layout);
    plot_panel(plot, 0);
    plot_legend(plot, entry, 2);
    draw_modes(plot, result->diagnose);
    if (two && r->sensors) {
        plot_panel(plot, 1);
        draw_sensors(plot, result, r->sensors, m);
    }
}

static const char *about(struct pool *pool, double count)
{
    const char *text = pool_format(pool, "about %s", human_count(pool, (int)floor(count + 0.5)));
    return text ? text : "";
}

static const char *none_or(struct pool *pool, int count)
{
    return count ? human_count(pool, count) : "none";
}

void figure_residuals(struct document *document, const struct result *result)
{
    const rotid_diagnosis *d = result->diagnose;
    struct pool *pool = document->pool;
    if (!d->base || !d->nmodes_standardised)
        return;
    struct misfit m = sum_up(d);
    int held = 0;
    for (int k = 0; k < d->nmodes_standardised; k++)
        held |= d->base->modes[k].holdout;
    if (m.worst < 0)
        return;
    const char *sensors =
        m.loudest < 0
            ? " No shape was fitted, so nothing can be said of single sensors."
            : pool_format(pool,
                          " Sensors: 1 is noise alone; %s of %d exceed %s, where noise alone lets %s. The worst is sensor "
                          "%d at %s\xc2\xa0m with %s.",
                          none_or(pool, m.loud), m.sensors, human_fixed(pool, m.limit, 2),
                          m.sensors * OUTSIDE < 0.5 ? "hardly one" : about(pool, OUTSIDE * m.sensors), d->sensors[m.loudest].id,
                          human_trimmed(pool, d->sensors[m.loudest].z_m, 4), human_fixed(pool, d->sensors[m.loudest].rms, 2));
    struct figure *figure =
        document_figure(document, "residuals",
                        m.loudest < 0 ? "What the model misses, mode by mode" : "What the model misses, by modes and by sensors");
    figure->caption =
        pool_format(pool,
                    "Modes: the error of each frequency over its noise; %s of %s fitted ones lie beyond \xc2\xb1%g, the "
                    "largest is %s in mode %d%s.%s",
                    m.beyond == m.fitted ? "all" : none_or(pool, m.beyond), human_count(pool, m.fitted), NORMAL_95,
                    human_signed(pool, d->modes_standardised[m.worst], 1), d->base->modes[m.worst].mode,
                    held ? "; modes with a star were held out of the fit" : "", sensors ? sensors : "");
    figure->alt = pool_format(pool, "Bars for %d modes, from %s to %s times their noise%s.", d->nmodes_standardised,
                              human_signed(pool, plot_range_of(d->nmodes_standardised, d->modes_standardised, 0).from, 1),
                              human_signed(pool, plot_range_of(d->nmodes_standardised, d->modes_standardised, 0).to, 1),
                              m.sensors ? "; beside them one line for each sensor along the rotor" : "");
    struct residuals r = collect(document, d, &m);
    struct plot plot;
    figure->table = series_table_of(2, (const struct series *const[]){r.modes, r.sensors});
    document->failed |= !sensors;
    if (!figure_begin(document, figure, result->file, &plot))
        return;
    script(&plot, result, &r, &m);
    figure_end(document, &plot);
}
