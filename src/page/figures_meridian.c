/* The meridian of a solid: its mesh, and how it moves and where it is strained in a mode. Half of the section is drawn, from the
 * axis up, with radii stretched until the mesh can be seen. */
#include <math.h>

#include "page/figures.h"
#include "page/geometry.h"
#include "page/human.h"
#include "page/palette.h"
#include "page/rotor.h"
#include "page/series.h"

#define MOST_PANELS 4
#define MESH_PX     190.0 /* from the axis to the largest radius */
#define MODE_PX     70.0
#define SIDE_PX     46.0
#define DARKEST     4.0  /* times the mean density */
#define SWING       0.45 /* of the largest radius: the largest motion that is drawn */

enum { FROM, TO, INNER, OUTER, OF_ELEMENT }; /* columns of an element */

static const double pi = 3.14159265358979323846;

/* Its extent: a rectangle before the rotor moves. */
static void extent(const rotid_meridian *m, int e, double box[OF_ELEMENT])
{
    const int *corner = m->elements[e].corner;
    box[FROM] = m->z_m[corner[0]];
    box[TO] = m->z_m[corner[2]];
    box[INNER] = m->r_m[corner[0]];
    box[OUTER] = m->r_m[corner[2]];
}

static double volume(const rotid_meridian *m, int e)
{
    double box[OF_ELEMENT];
    extent(m, e, box);
    return pi * (box[OUTER] * box[OUTER] - box[INNER] * box[INNER]) * (box[TO] - box[FROM]);
}

static void begin(struct plot *plot, const struct plot_layout *layout, double length, double from, double to)
{
    plot_line(plot, "LENGTH = %.6g; LOW = %.6g; HIGH = %.6g", length, from, to);
    plot_begin(plot, layout);
}

static void panel(struct plot *plot, int i, double length)
{
    plot_panel(plot, i);
    plot_line(plot,
              "unset grid; set border 0; unset ytics\nset xrange [-0.01*LENGTH:1.01*LENGTH]\nset yrange [LOW:HIGH]\n"
              "set xtics 0,%g,%.6g",
              plot_tic(length, 5), length);
    plot_line(plot, "set arrow 1 from 0,0 to LENGTH,0 nohead lc rgb INK lw 0.75 dt (12,3,2,3) front");
}

/* ------------------------------------------------------------------------------------------------ the mesh */

static struct series *elements_of(struct document *document, const rotid_meridian *m)
{
    static const struct column columns[] = {{"from", "m", AS_PLACE, 0},
                                            {"to", "m", AS_PLACE, 0},
                                            {"inner radius", "m", AS_PLACE, 0},
                                            {"outer radius", "m", AS_PLACE, 0},
                                            {"group", "1", AS_PLACE, 0}};
    struct series *series = series_new(document, "elements", m->nelements, 5, columns);
    for (int e = 0; e < m->nelements; e++) {
        double row[OF_ELEMENT + 1];
        extent(m, e, row);
        row[OF_ELEMENT] = m->elements[e].group;
        series_row(series, e, row);
    }
    return series;
}

static struct series *points(struct document *document, const char *name, int count)
{
    static const struct column columns[] = {{"z", "m", AS_PLACE, 0}, {"radius", "m", AS_PLACE, 0}};
    return series_new(document, name, count, 2, columns);
}

/* $sensors and $disks at the surface, $springs on the axis. */
static void attached(struct document *document, struct plot *plot, const rotid_geometry *g)
{
    struct series *sensors = points(document, "sensors", g->nsensors), *disks = points(document, "disks", g->ndisks),
                  *springs = points(document, "springs", g->nsprings);
    for (int i = 0; i < g->nsensors; i++)
        series_row(sensors, i, (const double[]){g->sensors[i].z_m, geometry_radius_at(g, g->sensors[i].z_m)});
    for (int i = 0; i < g->ndisks; i++)
        series_row(disks, i, (const double[]){g->disks[i].z_m, geometry_radius_at(g, g->disks[i].z_m)});
    for (int i = 0; i < g->nsprings; i++)
        series_row(springs, i, (const double[]){g->springs[i].z_m, 0});
    plot_series(plot, sensors);
    plot_series(plot, disks);
    plot_series(plot, springs);
}

static int legend_of(const rotid_geometry *geometry, const struct rotor_materials *materials, struct plot_entry *entry)
{
    int n = 0;
    for (int i = 0; i < materials->count; i++)
        entry[n++] =
            (struct plot_entry){.text = materials->name[i], .keys = KEY_FACE, .face = rotor_color(materials, materials->name[i])};
    if (geometry->nsensors)
        entry[n++] = (struct plot_entry){.text = "sensor", .style = 11, .keys = KEY_MARK};
    if (geometry->ndisks)
        entry[n++] = (struct plot_entry){.text = "disk", .style = 12, .keys = KEY_MARK};
    if (geometry->nsprings)
        entry[n++] = (struct plot_entry){.text = "spring", .style = 13, .keys = KEY_MARK};
    return n;
}

static void mesh_script(struct document *document, struct figure *figure, const struct result *result, struct series *elements)
{
    const rotid_geometry *geometry = result->modes->geometry;
    struct rotor_materials materials = rotor_materials(geometry);
    struct plot_entry entry[ROTOR_MATERIALS + 3];
    struct plot plot;
    struct plot_layout layout = {
        .panels = 1, .columns = {1, 1}, .height = MESH_PX + 24 + SIDE_PX, .left = 12, .right = 12, .top = 20, .bottom = SIDE_PX};
    int nentry = legend_of(geometry, &materials, entry);
    double radius = geometry_radius(geometry);
    plot_head(entry, nentry, layout.head);
    if (!figure_begin(document, figure, result->file, &plot))
        return;
    plot_series(&plot, elements);
    attached(document, &plot, geometry);
    plot_line(&plot, "set style line 11 lc rgb VERMILION pt 7 ps 0.4\nset style line 12 lc rgb INK pt 13 ps 0.9\n"
                     "set style line 13 lc rgb PURPLE pt 9 ps 0.9");
    (void)fputs("face(g) = ", plot.out);
    for (int g = 0; g < geometry->ngroups; g++)
        (void)fprintf(plot.out, "g == %d ? %s : ", g, rotor_color(&materials, material_name(&geometry->groups[g].material)));
    plot_line(&plot, "SHADE");
    begin(&plot, &layout, geometry->length_m, -0.04 * radius, 1.06 * radius);
    panel(&plot, 0, geometry->length_m);
    plot_legend(&plot, entry, nentry);
    plot_axes(&plot, "z [m]", NULL);
    plot_line(&plot, "set style fill solid border lc rgb MUTED");
    (void)fputs("plot $elements using (($1+$2)/2):(($3+$4)/2):1:2:3:4:(face($5)) with boxxyerror lc rgb variable lw 0.5",
                plot.out);
    (void)fputs(geometry->ndisks ? ", $disks using 1:2 with points ls 12" : "", plot.out);
    (void)fputs(geometry->nsprings ? ", $springs using 1:2 with points ls 13" : "", plot.out);
    plot_line(&plot, "%s", geometry->nsensors ? ", $sensors using 1:2 with points ls 11" : "");
    figure_end(document, &plot);
}

void figure_meridian(struct document *document, const struct result *result)
{
    struct pool *pool = document->pool;
    const rotid_spectrum *modes = result->modes;
    const rotid_meridian *m = modes->meridian;
    if (!m || !modes->geometry)
        return;
    const rotid_geometry *geometry = modes->geometry;
    struct figure *figure = document_figure(document, "meridian", "The meridian of the solid and its mesh");
    struct series *elements = elements_of(document, m);
    double stretch = MESH_PX / (1.1 * geometry_radius(geometry)) / ((WIDE_PX - 24.0) / (1.02 * geometry->length_m));
    figure->caption = pool_format(
        pool,
        "Half of the section through the axis, below, with its %s elements of eight nodes each: they are small where the "
        "diameter "
        "steps, since the stress has a singularity in each of these corners. Radii are drawn %s times as large as lengths.",
        human_count(pool, m->nelements), human_fixed(pool, stretch, 1));
    figure->alt =
        pool_format(pool, "Half a longitudinal section of the rotor, %d rectangles, smaller towards each step.", m->nelements);
    mesh_script(document, figure, result, elements);
}

/* ------------------------------------------------------------------------------------------------ modes on it */

/* Strain energy of the elements of a mode, and its density over the mean of the rotor. */
static struct series *energy_of(struct document *document, const rotid_meridian *m, const rotid_model_mode *mode)
{
    static const struct column columns[] = {{"from", "m", AS_PLACE, 0},
                                            {"to", "m", AS_PLACE, 0},
                                            {"inner radius", "m", AS_PLACE, 0},
                                            {"outer radius", "m", AS_PLACE, 0},
                                            {"share of the strain energy", "1", AS_PLACE, 0},
                                            {"density over its mean", "1", AS_PLACE, 0}};
    struct series *series = series_new(document, pool_format(document->pool, "energy%d", mode->mode), m->nelements, 6, columns);
    double whole = 0;
    for (int e = 0; e < m->nelements; e++)
        whole += volume(m, e);
    for (int e = 0; e < m->nelements; e++) {
        double row[OF_ELEMENT + 2];
        extent(m, e, row);
        row[OF_ELEMENT] = mode->meridian->energy[e];
        row[OF_ELEMENT + 1] = mode->meridian->energy[e] * whole / volume(m, e);
        series_row(series, e, row);
    }
    return series;
}

static struct series *motion_of(struct document *document, const rotid_meridian *m, const rotid_model_mode *mode)
{
    static const struct column columns[] = {{"z", "m", AS_PLACE, 0},
                                            {"radius", "m", AS_PLACE, 0},
                                            {"radial motion", "1", AS_PLACE, 0},
                                            {"axial motion", "1", AS_PLACE, 0}};
    struct series *series = series_new(document, pool_format(document->pool, "motion%d", mode->mode), m->nr_m, 4, columns);
    for (int i = 0; i < m->nr_m; i++)
        series_row(series, i, (const double[]){m->z_m[i], m->r_m[i], mode->meridian->u[i], mode->meridian->w[i]});
    return series;
}

/* The ground of what is not strained. */
static void outline(struct plot *plot, const rotid_geometry *geometry)
{
    int object = 0;
    for (int g = 0; g < geometry->ngroups; g++)
        for (int i = 0; i < geometry->groups[g].nsegments; i++) {
            const rotid_segment *s = &geometry->groups[g].segments[i];
            plot_line(
                plot,
                "set object %d rectangle from %.6g,%.6g to %.6g,%.6g behind fs solid border lc rgb MUTED fc rgb RAMP0 lw 0.5",
                ++object, s->from_m, s->inner_m / 2, s->to_m, s->outer_m / 2);
        }
}

/* The corners of a line across the axis follow each other: each is joined to the one before where both have one z. */
static void draw_mode(struct plot *plot, const rotid_geometry *geometry, const rotid_model_mode *mode, const char *title)
{
    int k = mode->mode;
    plot_label(plot, title, "graph 0, graph 1 offset 0, char 0.7", "INK", "left");
    outline(plot, geometry);
    plot_line(plot, "set style fill solid noborder; z0 = NaN; x = NaN; y = NaN");
    plot_line(
        plot,
        "plot $energy%d using ($6 < PALE ? NaN : ($1+$2)/2):(($3+$4)/2):1:2:3:4:(ramp($6)) with boxxyerror lc rgb variable, "
        "\\\n"
        "    $motion%d using (joined = $1 == z0, z0 = $1, a = x, b = y, x = $1+SWING*$4, y = $2+SWING*$3, joined ? a : "
        "NaN):(b):(x-a):(y-b) with vectors nohead lc rgb VERMILION lw 0.5",
        k, k);
}

static int drawn_modes(const rotid_spectrum *modes)
{
    int count = 0;
    while (count < modes->nmodes && count < MOST_PANELS && modes->modes[count].meridian)
        count++;
    return count;
}

/* Share of the rotor's volume that is strained by less than a tenth of the mean in all of the modes. */
static double idle_share(const rotid_spectrum *modes, int count)
{
    const rotid_meridian *m = modes->meridian;
    double whole = 0, idle = 0;
    for (int e = 0; e < m->nelements; e++)
        whole += volume(m, e);
    for (int e = 0; e < m->nelements; e++) {
        double most = 0;
        for (int k = 0; k < count; k++)
            most = fmax(most, modes->modes[k].meridian->energy[e] * whole / volume(m, e));
        idle += most < 0.1 ? volume(m, e) / whole : 0;
    }
    return idle;
}

static void modes_script(struct document *document, struct figure *figure, const struct result *result, int count)
{
    const rotid_spectrum *modes = result->modes;
    const rotid_geometry *geometry = modes->geometry;
    double radius = geometry_radius(geometry);
    struct plot plot;
    struct plot_layout layout = {.panels = count,
                                 .columns = {count < 2 ? count : 2, 1},
                                 .height = 2 * MODE_PX + 26 + SIDE_PX,
                                 .left = 12,
                                 .right = 12,
                                 .top = 26,
                                 .bottom = SIDE_PX};
    if (!figure_begin(document, figure, result->file, &plot))
        return;
    for (int k = 0; k < count; k++) {
        plot_series(&plot, energy_of(document, modes->meridian, &modes->modes[k]));
        plot_series(&plot, motion_of(document, modes->meridian, &modes->modes[k]));
    }
    plot_line(&plot, "# RAMP0: no strain energy; RAMP10: %g times the mean density, or more\nSWING = %.6g; PALE = %g", DARKEST,
              SWING * radius, DARKEST / 20);
    (void)fputs("ramp(d) = ", plot.out);
    for (int step = 0; step < 10; step++)
        (void)fprintf(plot.out, "d < %g ? %s : ", DARKEST * (step + 0.5) / 10, palette_ramp(step / 10.0));
    plot_line(&plot, "%s", palette_ramp(1));
    begin(&plot, &layout, geometry->length_m, -1.1 * SWING * radius, (1.06 + 1.1 * SWING) * radius);
    for (int k = 0; k < count; k++) {
        const char *title = pool_format(document->pool, "mode %d, %s\xc2\xa0Hz", modes->modes[k].mode,
                                        human_trimmed(document->pool, modes->modes[k].full_hz, 5));
        panel(&plot, k, geometry->length_m);
        plot_axes(&plot, "z [m]", NULL);
        draw_mode(&plot, geometry, &modes->modes[k], title ? title : "");
    }
    figure_end(document, &plot);
}

void figure_meridian_modes(struct document *document, const struct result *result)
{
    struct pool *pool = document->pool;
    const rotid_spectrum *modes = result->modes;
    int count = modes->meridian && modes->geometry ? drawn_modes(modes) : 0;
    if (!count)
        return;
    struct figure *figure = document_figure(document, "strain-energy", "Where the solid is strained, and how it moves");
    figure->caption = pool_format(
        pool,
        "Strain energy per volume in the first %s modes: the more colour the more, in full from %g times the mean of the rotor "
        "on; "
        "lines are sections of the mesh as they move. %s\xc2\xa0%% of the volume stay below a tenth of the mean in all of these "
        "modes: such corners a beam counts in full.",
        human_count(pool, count), DARKEST, human_fixed(pool, 100 * idle_share(modes, count), 1));
    figure->alt =
        pool_format(pool,
                    "%d panels, one a mode: half a longitudinal section of the rotor, shaded by its strain energy, with "
                    "the sections of its mesh displaced.",
                    count);
    modes_script(document, figure, result, count);
}
