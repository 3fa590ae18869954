/* The rotor to scale. Marks that stand for something without a size (sensors, springs, disks, causes) have one in px. */
#include <math.h>

#include "page/figures.h"
#include "page/geometry.h"
#include "page/human.h"
#include "page/rotor.h"
#include "page/rotor_marks.h"

#define AXIS_PX      46.0
#define NODES_PX     2.0 /* least distance of nodes that are drawn */
#define MOST_ENTRIES (ROTOR_MATERIALS + 8)

static int legend_of(struct pool *pool, const rotid_geometry *geometry, const rotid_identification *fit, struct plot_entry *entry)
{
    struct rotor_materials materials = rotor_materials(geometry);
    int n = 0, kinds[2] = {0, 0}, identified = 0;
    for (int i = 0; i < materials.count; i++)
        entry[n++] =
            (struct plot_entry){.text = materials.name[i], .keys = KEY_FACE, .face = rotor_color(&materials, materials.name[i])};
    for (int g = 0; g < geometry->ngroups; g++)
        identified |= rotor_is_identified(fit, &geometry->groups[g]);
    if (identified)
        entry[n++] = (struct plot_entry){.text = "identified", .keys = KEY_HATCH, .face = ""};
    for (int b = 0; b < geometry_nbundle(geometry); b++)
        kinds[geometry_bundle(geometry, b).is_bars] += geometry_bundle(geometry, b).number;
    for (int k = 0; k < 2; k++)
        if (kinds[k]) {
            const char *text = pool_format(pool, "%d %s", kinds[k], k ? "bars" : "tie rods");
            entry[n++] = (struct plot_entry){.text = text ? text : "", .keys = KEY_FACE, .face = k ? "SAND" : "LEAF"};
        }
    if (geometry->nsensors)
        entry[n++] = (struct plot_entry){.text = "sensor", .style = 11, .keys = KEY_MARK};
    if (geometry->ndisks)
        entry[n++] = (struct plot_entry){.text = "disk", .style = 12, .keys = KEY_MARK};
    if (geometry->ncauses)
        entry[n++] = (struct plot_entry){.text = "cause in the model", .style = 13, .keys = KEY_MARK};
    if (fit)
        entry[n++] = (struct plot_entry){.text = "centre of mass", .style = 14, .keys = KEY_MARK};
    return n;
}

static void script(struct document *document, struct figure *figure, const struct result *result, const rotid_geometry *geometry,
                   const rotid_identification *fit)
{
    struct pool *pool = document->pool;
    struct plot plot;
    struct plot_entry entry[MOST_ENTRIES];
    struct rotor_drawing d[LAYOUTS];
    struct plot_layout layout = {.panels = 1, .columns = {1, 1}, .bottom = AXIS_PX};
    int nentry = legend_of(pool, geometry, fit, entry);
    for (int l = 0; l < LAYOUTS; l++)
        if (rotor_measure(pool, geometry, l, &d[l])) {
            document->failed = 1;
            return;
        }
    layout.height = d[WIDE].above + d[WIDE].below + AXIS_PX;
    layout.narrow_height = d[NARROW].above + d[NARROW].below + AXIS_PX;
    plot_head(entry, nentry, layout.head);
    if (!figure_begin(document, figure, result->file, &plot))
        return;
    plot_line(&plot, "set style line 11 lc rgb VERMILION pt 7 ps 0.4\nset style line 12 lc rgb INK pt 13 ps 0.9\n"
                     "set style line 13 lc rgb PURPLE pt 11 ps 0.9\nset style line 14 lc rgb INK pt 6 ps 1 lw 1.5");
    rotor_marks_data(document, &plot, geometry, fit);
    plot_begin(&plot, &layout);
    plot_panel(&plot, 0);
    plot_line(&plot, "# S: px a metre, the same along both axes\nS = narrow ? %.4f : %.4f; Z0 = narrow ? %.3f : %.3f",
              d[NARROW].scale, d[WIDE].scale, d[NARROW].left, d[WIDE].left);
    plot_line(&plot,
              "set lmargin at screen 0; set rmargin at screen 1\nset xrange [-Z0/S:(W-Z0)/S]\n"
              "ABOVE = narrow ? %g : %g\nset yrange [-(HEIGHT-BOTTOM-ABOVE)/S:ABOVE/S]",
              d[NARROW].above, d[WIDE].above);
    plot_line(&plot,
              "set border 0; unset ytics; unset grid\nset xtics 0,%g,%.6g\n"
              "set arrow from 0,graph 0 to %.6g,graph 0 nohead lc rgb INK lw 0.75",
              plot_tic(geometry->length_m, 6), geometry->length_m, geometry->length_m);
    plot_legend(&plot, entry, nentry);
    plot_axes(&plot, "z [m]", NULL);
    (void)rotor_draw(&plot, geometry, fit, 0);
    for (int l = 0; l < LAYOUTS; l++) {
        plot_line(&plot, l == WIDE ? "if (!narrow) {" : "} else {");
        rotor_marks_labels(&plot, geometry, &d[l], l);
    }
    plot_line(&plot, "}\nset arrow from -12/S,0 to %.6g+12/S,0 nohead lc rgb INK lw 0.75 dt (12,3,2,3)", geometry->length_m);
    plot_line(&plot, "nodes = S * %.6g / %d > %g", geometry->length_m, geometry->nnodes_z_m > 1 ? geometry->nnodes_z_m - 1 : 1,
              NODES_PX);
    plot_line(
        &plot,
        "plot $nodes using (nodes ? $1 : NaN):(-3/S):(0):(6/S) with vectors nohead lc rgb INK lw 0.5, \\\n"
        "    $springs using ($1+$3/S):(-$2-$4/S) with lines lc rgb INK lw 1, \\\n"
        "    $disks using 1:(-$2-6/S):(0):(2*$2+12/S) with vectors nohead lc rgb INK lw 3, $disks using 1:(0) with points ls 12, "
        "\\\n"
        "    $sensors using 1:($2+4/S) with points ls 11, $causes using 1:($2+10/S) with points ls 13, \\\n"
        "    '+' every ::::0 using (center):(0) with points ls 14, '' every ::::0 using (center):(0) with points ls 14 pt 1");
    figure_end(document, &plot);
}

static struct series *groups_of(struct document *document, const rotid_geometry *geometry)
{
    static const struct column columns[] = {{"group", NULL, AS_TEXT, 0},     {"from", "m", AS_FIXED, 4},
                                            {"to", "m", AS_FIXED, 4},        {"largest diameter", "m", AS_FIXED, 4},
                                            {"elements", NULL, AS_FIXED, 0}, {"material", NULL, AS_TEXT, 0},
                                            {"E", "GPa", AS_DIGITS, 4},      {"G", "GPa", AS_DIGITS, 4},
                                            {"\xce\xbd", "1", AS_DIGITS, 3}, {"\xcf\x81", "kg/m\xc2\xb3", AS_DIGITS, 5}};
    struct series *series = series_new(document, "groups", geometry->ngroups, 10, columns);
    for (int g = 0; g < geometry->ngroups; g++) {
        const rotid_group *group = &geometry->groups[g];
        const rotid_material *m = &group->material;
        double diameter = 0;
        int elements = 0;
        for (int s = 0; s < group->nsegments; s++) {
            diameter = fmax(diameter, segment_height(&group->segments[s]));
            elements += group->segments[s].elements;
        }
        series_row(
            series, g,
            (const double[]){group->from_m, group->to_m, diameter, elements, m->e_pa / 1e9, m->g_pa / 1e9, m->nu, m->rho_kg_m3});
        series_text(series, g, 0, group->name);
        series_text(series, g, 5, material_name(m));
    }
    return series;
}

static const char *what_is_identified(struct pool *pool, const rotid_identification *fit)
{
    const char *text = "";
    for (int p = 0; fit && p < fit->nparameters && p < 4 && text; p++)
        text = pool_format(pool, "%s%s%s", text, p ? ", " : "", fit->parameters[p].name);
    if (!fit || !fit->nparameters || !text)
        return "";
    text = pool_format(pool, " Identified: %s%s; the other numbers are those of the deck.", text,
                       fit->nparameters > 4 ? " and more" : "");
    return text ? text : "";
}

/* As the script decides it for the wide layout. */
static int nodes_show(const rotid_geometry *geometry)
{
    return geometry->nnodes_z_m > 1 && (double)WIDE_PX / (geometry->nnodes_z_m - 1) > NODES_PX;
}

void figure_rotor(struct document *document, const struct result *result, const rotid_geometry *geometry,
                  const rotid_identification *fit)
{
    struct pool *pool = document->pool;
    double diameter = 2 * geometry_radius(geometry);
    struct figure *figure = document_figure(document, "rotor", "The model to scale");
    const char *sensors = geometry->nsensors ? pool_format(pool, ", %d %s", geometry->nsensors,
                                                           human_plural(geometry->nsensors, "sensor", "sensors"))
                                             : ", no sensors",
               *springs = geometry->nsprings ? pool_format(pool, ", %s %s", human_count(pool, geometry->nsprings),
                                                           human_plural(geometry->nsprings, "spring", "springs"))
                                             : ", free at both ends";
    figure->caption = pool_format(pool, "%s\xc2\xa0m long, %s\xc2\xa0m at its thickest, %d %s%s%s%s.%s",
                                  human_trimmed(pool, geometry->length_m, 4), human_trimmed(pool, diameter, 3),
                                  geometry_elements(geometry), human_plural(geometry_elements(geometry), "element", "elements"),
                                  nodes_show(geometry) ? " (ticks on the axis are nodes)" : "", sensors ? sensors : "",
                                  springs ? springs : "", what_is_identified(pool, fit));
    figure->alt = pool_format(pool, "Longitudinal section of a rotor with %d groups of sections, %d sensors and %d springs.",
                              geometry->ngroups, geometry->nsensors, geometry->nsprings);
    figure->table = series_table(groups_of(document, geometry));
    script(document, figure, result, geometry, fit);
}
