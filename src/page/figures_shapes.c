/* Shapes of modes, one panel each: measured points and the model's line along the axis, with the mounted parts beside the line.
 */
#include <math.h>

#include "page/figures.h"
#include "page/geometry.h"
#include "page/human.h"
#include "page/series.h"

#define MOST_PANELS 24  /* modes that are drawn */
#define MOST_POINTS 120 /* of a measured shape that get bars for their noise and whole marks */
#define NORMAL_95   1.96
#define SPARSE      40 /* points that do not make a curve */
#define TITLE_ROOM  26.0

struct shape_panel {
    const char *title, *right; /* over it, from the left and from the right */
    int npoint, nline;
    const double *point_z, *point, *bar; /* measured, and half its 95 % of noise; NULL: none */
    const double *line_z, *line;         /* of the model */
    int ntierods, nbars;
    const rotid_member_shape *tierods, *bars;
};

struct shapes_figure {
    int count;
    const struct shape_panel *panel;
    int nband; /* of the axis that are shaded */
    double (*band)[2];
    const char *shaded; /* what they are, NULL: nothing */
    int sparse;         /* the model's line is known at few points, which are marked */
};
#define MOST_BANDS 8

/* The legend of all panels: its entries. */
static int legend_of(int count, const struct shape_panel *panel, const char *shaded, struct plot_entry *entry)
{
    int marked = 0, rods = 0, bars = 0, n = 0;
    for (int i = 0; i < count; i++) {
        marked |= panel[i].point != NULL;
        rods |= panel[i].ntierods;
        bars |= panel[i].nbars;
    }
    entry[n++] = (struct plot_entry){.text = "model", .style = 1, .keys = KEY_LINE};
    if (rods || bars)
        entry[n++] = (struct plot_entry){.text = rods && bars ? "its tie rods and bars"
                                                 : rods       ? "its tie rods"
                                                              : "its bars",
                                         .style = 3,
                                         .keys = KEY_LINE};
    if (marked)
        entry[n++] = (struct plot_entry){.text = "measured", .style = 2, .keys = KEY_MARK};
    if (shaded)
        entry[n++] = (struct plot_entry){.text = shaded, .keys = KEY_FACE, .face = "SHADE"};
    return n;
}

static void curve(struct document *document, struct plot *plot, const char *kind, int i, int n, const double *z,
                  const double *value, const double *bar)
{
    static const struct column columns[] = {
        {"z", "m", AS_PLACE, 0}, {"deflection", "1", AS_PLACE, 0}, {"half of the 95 % of its noise", "1", AS_PLACE, 0}};
    struct series *series = series_new(document, pool_format(document->pool, "%s%d", kind, i + 1), n, bar ? 3 : 2, columns);
    for (int k = 0; k < n; k++)
        series_row(series, k, (const double[]){z[k], value[k], bar ? bar[k] : 0});
    plot_series(plot, series);
}

static void data_of(struct document *document, struct plot *plot, const struct shape_panel *panel, int i)
{
    curve(document, plot, "model", i, panel->nline, panel->line_z, panel->line, NULL);
    for (int m = 0; m < panel->ntierods + panel->nbars; m++) {
        const rotid_member_shape *member = m < panel->ntierods ? &panel->tierods[m] : &panel->bars[m - panel->ntierods];
        const char *kind = pool_format(document->pool, "member%d_", i + 1);
        curve(document, plot, kind ? kind : "", m, member->nz_m, member->z_m, member->shape, NULL);
    }
    if (panel->point)
        curve(document, plot, "measured", i, panel->npoint, panel->point_z, panel->point, panel->bar);
}

static void draw_panel(struct plot *plot, const struct shapes_figure *all, int i)
{
    const struct shape_panel *panel = &all->panel[i];
    int few = panel->npoint <= MOST_POINTS;
    FILE *out = plot->out;
    plot_line(plot, "set xrange [%.6g:%.6g]\nset yrange [LOW:HIGH]\nset ytics 1\nset xtics XTIC", panel->line_z[0],
              panel->line_z[panel->nline - 1]);
    for (int b = 0; b < all->nband; b++)
        plot_line(plot, "set object %d rectangle from %.6g, graph 0 to %.6g, graph 1 behind fs solid noborder fc rgb SHADE",
                  b + 1, all->band[b][0], all->band[b][1]);
    plot_label(plot, panel->title, "graph 0, graph 1 offset 0, char 0.7", "INK", "left");
    if (panel->right)
        plot_label(plot, panel->right, "graph 1, graph 1 offset 0, char 0.7", "MUTED", "right");
    plot_line(plot, "last = %d + COLUMNS > %d; first = %d %% COLUMNS == 0", i, all->count - 1, i);
    plot_line(plot, "if (last) { set label 990 'z [m]' at graph 0.5, screen 1-(y_of(%d)+HEIGHT-9)/H center tc rgb INK }", i);
    plot_line(plot, "if (first) { set label 991 'deflection [1]' at screen (x_of(%d)+10)/W, graph 0.5 center rotate tc rgb INK }",
              i);
    (void)fprintf(out, "plot 0 with lines lc rgb MUTED lw 0.75");
    if (panel->point && panel->bar && few)
        (void)fprintf(out, ", $measured%d using 1:2:3 with yerrorbars ls 2 lw 0.75 dt 1 ps 0", i + 1);
    if (panel->point)
        (void)fprintf(out, ", $measured%d using 1:2 with points ls 2 ps %s", i + 1,
                      few ? panel->npoint <= SPARSE ? "0.6" : "0.4" : "0.25");
    (void)fprintf(out, ", \\\n    $model%d with %s", i + 1, all->sparse ? "linespoints ls 1 ps 0.5 lw 1" : "lines ls 1");
    for (int m = 0; m < panel->ntierods + panel->nbars; m++)
        (void)fprintf(out, ", $member%d_%d with lines ls 3 lw 2", i + 1, m + 1);
    (void)fputc('\n', out);
}

static void shapes_script(struct document *document, struct figure *figure, const char *source, const struct shapes_figure *all)
{
    struct plot plot;
    struct plot_entry entry[4];
    const struct shape_panel *panel = all->panel;
    int count = all->count, nentry = legend_of(count, panel, all->shaded, entry);
    struct plot_layout layout = {.panels = count,
                                 .columns = {count < 3 ? count : 3, 1},
                                 .height = 170,
                                 .left = 46,
                                 .right = 12,
                                 .top = TITLE_ROOM,
                                 .bottom = 47};
    plot_head(entry, nentry, layout.head);
    if (!figure_begin(document, figure, source, &plot))
        return;
    struct plot_range range = {-1, 1};
    for (int i = 0; i < count; i++) {
        data_of(document, &plot, &panel[i], i);
        for (int j = 0; j < panel[i].nline; j++)
            plot_range_join(&range, panel[i].line[j]);
        for (int j = 0; j < panel[i].npoint && panel[i].point; j++)
            plot_range_join(&range, panel[i].point[j]);
    }
    double length = panel->line_z[panel->nline - 1] - panel->line_z[0];
    plot_line(&plot, "LOW = %.4g; HIGH = %.4g; XTIC = %g", 1.12 * range.from, 1.12 * range.to, plot_tic(length, 4));
    plot_begin(&plot, &layout);
    for (int i = 0; i < count; i++) {
        plot_panel(&plot, i);
        if (i == 0)
            plot_legend(&plot, entry, nentry);
        draw_panel(&plot, all, i);
    }
    figure_end(document, &plot);
}

/* Groups with a parameter that was identified. */
static void shade(struct pool *pool, const rotid_geometry *geometry, const rotid_identification *fit, struct shapes_figure *all)
{
    all->band = pool_get(pool, MOST_BANDS, sizeof *all->band);
    int parts = 0;
    for (int g = 0; geometry && g < geometry->ngroups; g++)
        parts += !geometry->groups[g].layer_of;
    for (int g = 0; geometry && g < geometry->ngroups && all->band && all->nband < MOST_BANDS; g++) {
        int is_identified = 0, is_shaded = 0;
        for (int p = 0; p < fit->nparameters; p++)
            is_identified |= geometry_is_of(&geometry->groups[g], fit->parameters[p].name);
        for (int b = 0; b < all->nband; b++) /* a layer where its host is */
            is_shaded |= all->band[b][0] == geometry->groups[g].from_m;
        if (!is_identified || is_shaded)
            continue;
        all->band[all->nband][0] = geometry->groups[g].from_m;
        all->band[all->nband++][1] = geometry->groups[g].to_m;
    }
    all->shaded = all->nband && all->nband < parts ? "identified part" : NULL;
    all->nband = all->shaded ? all->nband : 0; /* the whole rotor is no part to set off */
}

/* Columns of the model after those of the measurement, mode by mode. */
static struct number_table *sensors_table(struct document *document, const rotid_shapes *shapes, int count)
{
    struct column column[2 + 2 * MOST_PANELS] = {{"sensor", NULL, AS_FIXED, 0}, {"z", "m", AS_FIXED, 4}};
    for (int k = 0; k < count; k++)
        for (int m = 0; m < 2; m++) {
            const char *name = pool_format(document->pool, "mode %d %s", shapes->modes[k].mode, m ? "model" : "measured");
            column[2 + 2 * k + m] = (struct column){name, "1", AS_FIXED, 3};
        }
    struct series *series = series_new(document, "sensors", shapes->nsensor_id, 2 + 2 * count, column);
    for (int s = 0; s < shapes->nsensor_id; s++) {
        double row[2 + 2 * MOST_PANELS] = {shapes->sensor_id[s], shapes->z_m[s]};
        for (int k = 0; k < count; k++) {
            const rotid_mode_shapes *shape = &shapes->modes[k];
            row[2 + 2 * k] = shape->measured ? shape->measured[s] : (double)NAN;
            row[3 + 2 * k] = shape->predicted[s];
            if (!shape->measured)
                series_text(series, s, 2 + 2 * k, "");
        }
        series_row(series, s, row);
    }
    return series_table(series);
}

/* Half the 95 % of the noise of each component, NULL where it is not known. */
static const double *bars_of(struct pool *pool, const rotid_mode_shapes *shape, int nsensor)
{
    double *bar = shape->measured && shape->measured_std ? POOL_ARRAY(pool, double, nsensor) : NULL;
    for (int s = 0; s < nsensor && bar; s++)
        bar[s] = NORMAL_95 * shape->measured_std[s];
    return bar;
}

static const rotid_compared_mode *mode_of(const rotid_identification *fit, const rotid_mode_shapes *shape)
{
    for (int k = 0; k < fit->nmodes; k++)
        if (fit->modes[k].mode == shape->mode)
            return &fit->modes[k];
    return NULL;
}

static const char *shapes_caption(struct pool *pool, const rotid_identification *fit, int count, int with_shape)
{
    const rotid_shapes *shapes = fit->shapes;
    const rotid_compared_mode *worst = NULL;
    for (int k = 0; k < fit->nmodes; k++)
        if (isfinite(fit->modes[k].nco) && (!worst || fit->modes[k].nco < worst->nco))
            worst = &fit->modes[k];
    const char *drawn =
        count < shapes->nmodes ? pool_format(pool, " The first %d of %d modes are drawn.", count, shapes->nmodes) : "";
    if (!with_shape)
        return pool_format(
            pool,
            "Shapes of the fitted model, largest deflection 1, at the %d measured frequencies; no shapes were measured to "
            "compare them with.%s",
            shapes->nmodes, drawn ? drawn : "");
    return pool_format(
        pool, "Measured shapes at %d sensors, largest component 1, and those of the fitted model at their best scale.%s%s%s",
        shapes->nsensor_id,
        worst ? pool_format(pool, " The least alike is mode %d with a normalised cross orthogonality of %s.", worst->mode,
                            human_fixed(pool, worst->nco, 3))
              : "",
        fit->shapes_fitted == 0 ? " The fit did not use the shapes." : "", drawn ? drawn : "");
}

void figure_shapes(struct document *document, const struct result *result, const rotid_identification *fit)
{
    struct pool *pool = document->pool;
    const rotid_shapes *shapes = fit->shapes;
    int count = shapes ? shapes->nmodes : 0, with_shape = 0;
    if (!count || shapes->naxis_z_m < 2)
        return;
    count = count < MOST_PANELS ? count : MOST_PANELS;
    struct shape_panel *panel = POOL_ARRAY(pool, struct shape_panel, count);
    for (int k = 0; k < count && panel; k++) {
        const rotid_mode_shapes *shape = &shapes->modes[k];
        const rotid_compared_mode *mode = mode_of(fit, shape);
        with_shape += shape->measured != NULL;
        panel[k] = (struct shape_panel){
            .title =
                pool_format(pool, "mode %d, %s\xc2\xa0Hz", shape->mode, mode ? human_trimmed(pool, mode->measured_hz, 5) : ""),
            .right = mode && isfinite(mode->nco) ? pool_format(pool, "NCO %s", human_fixed(pool, mode->nco, 3)) : NULL,
            .npoint = shape->measured ? shapes->nsensor_id : 0,
            .nline = shapes->naxis_z_m,
            .ntierods = shape->ntierods,
            .nbars = shape->nbars,
            .point_z = shapes->z_m,
            .point = shape->measured,
            .bar = bars_of(pool, shape, shapes->nsensor_id),
            .line_z = shapes->axis_z_m,
            .line = shape->predicted_axis,
            .tierods = shape->tierods,
            .bars = shape->bars};
        document->failed |= !panel[k].title;
    }
    struct figure *figure =
        document_figure(document, "shapes", with_shape ? "Measured and predicted shapes" : "Predicted shapes");
    if (!panel || document->failed) {
        document->failed = 1;
        return;
    }
    struct shapes_figure all = {.count = count, .panel = panel};
    shade(pool, geometry_of_result(result), fit, &all);
    figure->caption = shapes_caption(pool, fit, count, with_shape);
    figure->alt =
        pool_format(pool, "%d panels, one a mode: deflection over the position along the rotor, as a line for the model%s.",
                    count, with_shape ? " and points for what was measured" : "");
    figure->table = shapes->nsensor_id ? sensors_table(document, shapes, count) : NULL;
    shapes_script(document, figure, result->file, &all);
}

static struct number_table *points_table(struct document *document, const rotid_spectrum *modes, int count)
{
    struct column column[1 + MOST_PANELS] = {{"z", "m", AS_FIXED, 4}};
    for (int k = 0; k < count; k++) {
        const char *name = pool_format(document->pool, "mode %d", modes->modes[k].mode);
        column[1 + k] = (struct column){name, "1", AS_FIXED, 3};
    }
    struct series *series = series_new(document, "points", modes->nsensor_z_m, 1 + count, column);
    for (int s = 0; s < modes->nsensor_z_m; s++) {
        double row[1 + MOST_PANELS] = {modes->sensor_z_m[s]};
        for (int k = 0; k < count; k++)
            row[1 + k] = modes->modes[k].shape[s];
        series_row(series, s, row);
    }
    return series_table(series);
}

void figure_modes(struct document *document, const struct result *result)
{
    struct pool *pool = document->pool;
    const rotid_spectrum *modes = result->modes;
    int count = modes->nmodes < MOST_PANELS ? modes->nmodes : MOST_PANELS;
    if (!count || modes->nsensor_z_m < 2)
        return;
    struct shape_panel *panel = POOL_ARRAY(pool, struct shape_panel, count);
    for (int k = 0; k < count && panel; k++) {
        panel[k] = (struct shape_panel){.title = pool_format(pool, "mode %d, %s\xc2\xa0Hz", modes->modes[k].mode,
                                                             human_trimmed(pool, modes->modes[k].full_hz, 5)),
                                        .nline = modes->nsensor_z_m,
                                        .line_z = modes->sensor_z_m,
                                        .line = modes->modes[k].shape};
        document->failed |= !panel[k].title;
    }
    struct figure *figure = document_figure(document, "modes", "Bending modes of the model");
    if (!panel || document->failed) {
        document->failed = 1;
        return;
    }
    const struct shapes_figure all = {.count = count, .panel = panel, .sparse = modes->nsensor_z_m <= SPARSE};
    figure->caption = pool_format(pool, "The first %s bending modes, %s to %s\xc2\xa0Hz, largest deflection 1, at %d points%s.",
                                  human_count(pool, count), human_trimmed(pool, modes->modes[0].full_hz, 5),
                                  human_trimmed(pool, modes->modes[count - 1].full_hz, 5), modes->nsensor_z_m,
                                  all.sparse ? " (joined by straight lines)" : "");
    figure->alt = pool_format(pool, "%d panels, one a mode: deflection over the position along the rotor.", count);
    figure->table = points_table(document, modes, count);
    shapes_script(document, figure, result->file, &all);
}
