/* Shapes of modes, one panel each: measured points and the model's line along the axis, with what is mounted beside it. */
#include <math.h>

#include "page/figures.h"
#include "page/geometry.h"
#include "page/human.h"
#include "page/plot.h"

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

static void data_of(struct plot *plot, const struct shape_panel *panel, int i)
{
    char name[32];
    (void)snprintf(name, sizeof name, "model%d", i + 1);
    plot_data(plot, name, panel->nline, 2, (const double *const[]){panel->line_z, panel->line});
    for (int m = 0; m < panel->ntierods + panel->nbars; m++) {
        const rotid_member_shape *member = m < panel->ntierods ? &panel->tierods[m] : &panel->bars[m - panel->ntierods];
        (void)snprintf(name, sizeof name, "member%d_%d", i + 1, m + 1);
        plot_data(plot, name, member->nz_m, 2, (const double *const[]){member->z_m, member->shape});
    }
    (void)snprintf(name, sizeof name, "measured%d", i + 1);
    if (panel->point)
        plot_data(plot, name, panel->npoint, panel->bar ? 3 : 2,
                  (const double *const[]){panel->point_z, panel->point, panel->bar ? panel->bar : panel->point});
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

static int shapes_script(struct document *document, struct figure *figure, const char *source, const struct shapes_figure *all)
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
    if (plot_open(&plot, document->pool, figure, source))
        return ROTID_ERROR_MEMORY;
    plot_line(&plot, "# columns: z [m], deflection [1], and of measured points half the 95 %% of their noise");
    struct plot_range range = {-1, 1};
    for (int i = 0; i < count; i++) {
        data_of(&plot, &panel[i], i);
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
    return plot_close(&plot);
}

/* Groups with a parameter that was identified. */
static void shade(struct pool *pool, const rotid_geometry *geometry, const rotid_identification *fit, struct shapes_figure *all)
{
    all->band = pool_get(pool, MOST_BANDS, sizeof *all->band);
    for (int g = 0; geometry && g < geometry->ngroups && all->band && all->nband < MOST_BANDS; g++) {
        int is_identified = 0;
        for (int p = 0; p < fit->nparameters; p++)
            is_identified |= geometry_is_of(&geometry->groups[g], fit->parameters[p].name);
        if (!is_identified)
            continue;
        all->band[all->nband][0] = geometry->groups[g].from_m;
        all->band[all->nband++][1] = geometry->groups[g].to_m;
    }
    all->shaded = all->nband && all->nband < geometry->ngroups ? "identified part" : NULL;
    all->nband = all->shaded ? all->nband : 0; /* the whole rotor is no part to set off */
}

static struct number_table *sensors_table(struct pool *pool, const rotid_shapes *shapes, int count)
{
    struct number_table *table = table_new(pool, shapes->nsensor_id, 2 + 2 * count);
    table_head(table, 0, "sensor");
    table_head(table, 1, "z [m]");
    for (int k = 0; k < count; k++) {
        const rotid_mode_shapes *shape = &shapes->modes[k];
        table_head(table, 2 + 2 * k, pool_format(pool, "mode %d measured [1]", shape->mode));
        table_head(table, 3 + 2 * k, pool_format(pool, "mode %d model [1]", shape->mode));
    }
    for (int s = 0; s < shapes->nsensor_id; s++) {
        table_cell(table, s, 0, human_fixed(pool, shapes->sensor_id[s], 0));
        table_cell(table, s, 1, human_fixed(pool, shapes->z_m[s], 4));
        for (int k = 0; k < count; k++) {
            const rotid_mode_shapes *shape = &shapes->modes[k];
            table_cell(table, s, 2 + 2 * k, shape->measured ? human_fixed(pool, shape->measured[s], 3) : "");
            table_cell(table, s, 3 + 2 * k, human_fixed(pool, shape->predicted[s], 3));
        }
    }
    return table;
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
    figure->table = shapes->nsensor_id ? sensors_table(pool, shapes, count) : NULL;
    document->failed |= !figure->caption || !figure->alt || shapes_script(document, figure, result->file, &all) != ROTID_OK;
}

static struct number_table *points_table(struct pool *pool, const rotid_spectrum *modes, int count)
{
    struct number_table *table = table_new(pool, modes->nsensor_z_m, 1 + count);
    table_head(table, 0, "z [m]");
    for (int k = 0; k < count; k++)
        table_head(table, 1 + k, pool_format(pool, "mode %d [1]", modes->modes[k].mode));
    for (int s = 0; s < modes->nsensor_z_m; s++) {
        table_cell(table, s, 0, human_fixed(pool, modes->sensor_z_m[s], 4));
        for (int k = 0; k < count; k++)
            table_cell(table, s, 1 + k, human_fixed(pool, modes->modes[k].shape[s], 3));
    }
    return table;
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
    figure->table = points_table(pool, modes, count);
    document->failed |= !figure->caption || !figure->alt || shapes_script(document, figure, result->file, &all) != ROTID_OK;
}
