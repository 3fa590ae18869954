#include "page/rotor_marks.h"
#include "page/geometry.h"

#include <math.h>

#include "page/human.h"

#define SIDE_PX    26.0  /* beside the rotor */
#define MOST_BODY  250.0 /* height of the rotor, px: short thick ones do not fill the page */
#define LANES      3     /* of labels over the rotor */
#define LANE_PX    16.0
#define ABOVE_PX   14.0 /* between rotor and labels: sensors */
#define SPRING_PX  30.0 /* from the surface to the ground, with what is under it */
#define UNDER_PX   56.0 /* room for a spring with its stiffness under it */
#define COIL_TURNS 6

static const double page_width[LAYOUTS] = {WIDE_PX, NARROW_PX};

/* The longest text of a group that fits the place beside those that are there already. */
static int place(const double *taken, double middle, double width, double room, double *from)
{
    for (int lane = 0; lane < LANES; lane++) {
        *from = fmin(fmax(middle - width / 2, 4), room - width - 4);
        if (*from >= taken[lane])
            return lane;
    }
    return -1;
}

/* Lanes in use. */
static int place_labels(struct pool *pool, const rotid_geometry *geometry, int layout, const struct rotor_drawing *d)
{
    struct rotor_label *label = d->label;
    double taken[LANES] = {0, 0, 0};
    int deepest = 0;
    for (int g = 0; g < geometry->ngroups; g++) {
        const rotid_group *group = &geometry->groups[g];
        const rotid_material *m = &group->material;
        const char *text[3] = {pool_format(pool, "%s: %s, E %s, G %s", group->name, material_name(m),
                                           human_value(pool, m->e_pa, "Pa"), human_value(pool, m->g_pa, "Pa")),
                               pool_format(pool, "%s: %s", group->name, material_name(m)), group->name};
        double z = (group->from_m + group->to_m) / 2, span = d->scale * (group->to_m - group->from_m);
        label[g] = (struct rotor_label){.z = z, .lane = -1};
        for (int t = 0; t < 3 && label[g].lane < 0; t++) {
            double width = text[t] ? plot_width(text[t]) : 0, from;
            int lane = place(taken, d->left + d->scale * z, width, page_width[layout], &from);
            if (!text[t] || lane < 0 || (t < 2 && width > fmax(span, layout == WIDE ? 190 : 100)))
                continue;
            label[g] = (struct rotor_label){text[t], z, from, lane};
            taken[lane] = from + width + 10;
            deepest = lane > deepest ? lane : deepest;
        }
    }
    return deepest + 1;
}

static void group_labels(struct plot *plot, const rotid_geometry *geometry, const struct rotor_drawing *d)
{
    const struct rotor_label *label = d->label;
    for (int g = 0; g < geometry->ngroups; g++) {
        char where[96];
        double up = ABOVE_PX + LANE_PX * (label[g].lane + 0.5), r = geometry_radius_at(geometry, label[g].z);
        if (label[g].lane < 0)
            continue;
        (void)snprintf(where, sizeof where, "screen %g/W, first %.6g", label[g].from, (d->radius + up) / d->scale);
        plot_label(plot, label[g].text, where, "INK", "left");
        if (geometry->groups[g].layer_of) /* stands at that of its host, through whose text the line would go */
            continue;
        plot_line(plot, "set arrow from %.6g,%.6g to %.6g,%.6g nohead lc rgb MUTED lw 0.5", label[g].z,
                  (d->radius + up - 7) / d->scale, label[g].z, r + 6 / d->scale);
    }
}

/* A spring as a line: z and radius in m, the way from there in px; the coil, then the ground with its hatching. */
static void spring_data(struct plot *plot, const rotid_geometry *geometry)
{
    FILE *out = plot->out;
    (void)fputs("# springs: z, radius [m], then what is added to both [px]\n$springs << end\n", out);
    for (int s = 0; s < geometry->nsprings; s++) {
        double z = geometry->springs[s].z_m, r = geometry_radius_at(geometry, z);
        (void)fprintf(out, "%.6g %.6g 0 0\n", z, r);
        for (int t = 0; t <= COIL_TURNS; t++)
            (void)fprintf(out, "%.6g %.6g %d %g\n", z, r,
                          t == 0 || t == COIL_TURNS ? 0
                          : t % 2                   ? 5
                                                    : -5,
                          4 + (SPRING_PX - 8) * t / COIL_TURNS);
        (void)fprintf(out, "%.6g %.6g 0 %g\nNaN NaN NaN NaN\n%.6g %.6g -11 %g\n%.6g %.6g 11 %g\nNaN NaN NaN NaN\n", z, r,
                      SPRING_PX, z, r, SPRING_PX, z, r, SPRING_PX);
        for (int h = -10; h <= 6; h += 4)
            (void)fprintf(out, "%.6g %.6g %d %g\n%.6g %.6g %d %g\nNaN NaN NaN NaN\n", z, r, h + 4, SPRING_PX, z, r, h,
                          SPRING_PX + 5);
    }
    (void)fputs("end\n", out);
}

/* Stiffnesses under the springs, as far as there is room for them beside each other. */
static void spring_labels(struct plot *plot, const rotid_geometry *geometry, const struct rotor_drawing *d, int layout)
{
    double taken = 0;
    for (int s = 0; s < geometry->nsprings; s++) {
        const rotid_spring *spring = &geometry->springs[s];
        double r = geometry_radius_at(geometry, spring->z_m), from;
        const char *text = human_value(plot->pool, spring->lateral_n_m, "N/m");
        char where[96];
        from = fmin(fmax(d->left + d->scale * spring->z_m - plot_width(text) / 2, 4), page_width[layout] - plot_width(text) - 4);
        if (from < taken)
            continue;
        taken = from + plot_width(text) + 8;
        (void)snprintf(where, sizeof where, "screen %g/W, first %.6g", from, -r - (SPRING_PX + 15) / d->scale);
        plot_label(plot, text, where, "INK", "left");
    }
}

/* px under the axis of the rotor. */
static double below(const rotid_geometry *geometry, const struct rotor_drawing *d)
{
    double px = d->radius + 12;
    for (int s = 0; s < geometry->nsprings; s++)
        px = fmax(px, d->scale * geometry_radius_at(geometry, geometry->springs[s].z_m) + UNDER_PX);
    return px;
}

/* What stands at the surface of the rotor, each at its z. */
static void points(struct document *document, struct plot *plot, const rotid_geometry *geometry, const char *name, int n,
                   double (*z_of)(const rotid_geometry *geometry, int i))
{
    static const struct column columns[] = {{"z", "m", AS_PLACE, 0}, {"radius", "m", AS_PLACE, 0}};
    struct series *series = series_new(document, name, n, 2, columns);
    for (int i = 0; i < n; i++) {
        double z = z_of(geometry, i);
        series_row(series, i, (const double[]){z, isfinite(z) ? geometry_radius_at(geometry, z) : (double)NAN});
    }
    plot_series(plot, series);
}

static double sensor_z(const rotid_geometry *geometry, int i)
{
    return geometry->sensors[i].z_m;
}

static double disk_z(const rotid_geometry *geometry, int i)
{
    return geometry->disks[i].z_m;
}

static double cause_z(const rotid_geometry *geometry, int i)
{
    return model_cause_z(&geometry->causes[i]);
}

static double node_z(const rotid_geometry *geometry, int i)
{
    return geometry->nodes_z_m[i];
}

int rotor_measure(struct pool *pool, const rotid_geometry *geometry, int layout, struct rotor_drawing *d)
{
    double radius = geometry_radius(geometry), width = page_width[layout] - 2 * SIDE_PX;
    *d = (struct rotor_drawing){.scale = fmin(width / geometry->length_m, MOST_BODY / (2 * radius)),
                                .label = POOL_ARRAY(pool, struct rotor_label, geometry->ngroups)};
    if (!d->label)
        return ROTID_ERROR_MEMORY;
    d->left = (page_width[layout] - d->scale * geometry->length_m) / 2;
    d->radius = d->scale * radius;
    d->above = d->radius + ABOVE_PX + LANE_PX * place_labels(pool, geometry, layout, d);
    d->below = below(geometry, d);
    return ROTID_OK;
}

void rotor_marks_data(struct document *document, struct plot *plot, const rotid_geometry *geometry,
                      const rotid_identification *fit)
{
    points(document, plot, geometry, "sensors", geometry->nsensors, sensor_z);
    points(document, plot, geometry, "disks", geometry->ndisks, disk_z);
    points(document, plot, geometry, "causes", geometry->ncauses, cause_z);
    points(document, plot, geometry, "nodes", geometry->nnodes_z_m, node_z);
    plot_line(plot, "center = %s", plot_number(plot, fit ? fit->center_of_mass_m : (double)NAN));
    spring_data(plot, geometry);
}

void rotor_marks_labels(struct plot *plot, const rotid_geometry *geometry, const struct rotor_drawing *drawing, int layout)
{
    group_labels(plot, geometry, drawing);
    spring_labels(plot, geometry, drawing, layout);
}
