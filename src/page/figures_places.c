/* Force residual along the axis, under the rotor, with the places of possible causes between the two. */
#include <math.h>

#include "page/cause_words.h"
#include "page/figures_diagnosis.h"
#include "page/geometry.h"
#include "page/human.h"
#include "page/rotor.h"
#include "page/series.h"
#include "result/cause_place.h"

#define LEFT_PX    54.0
#define RIGHT_PX   14.0
#define MOST_ROTOR 130.0 /* px; the diameters of a thicker one are not to scale */
#define LANE_PX    32.0
#define MOST_LANES 6
#define MOST_TOLD  3 /* of them in the caption */
#define CURVE_PX   140.0
#define AXIS_PX    48.0

struct lane {
    const rotid_cause *cause;
    struct cause_place place;
};

struct places {
    int count, others;     /* with a place; without one, or no room */
    const char *placeless; /* the first of those without one, NULL: none */
    struct lane lane[MOST_LANES];
    int named; /* these were named; else they cannot be told apart */
};

static struct places find_places(struct pool *pool, const struct result *result)
{
    const rotid_diagnosis *d = result->diagnose;
    struct places places = {.named = d->verdict.ncauses > 0};
    int count = d->verdict.ncauses ? d->verdict.ncauses : d->verdict.nalternative_causes;
    const rotid_cause *cause = d->verdict.ncauses ? d->verdict.causes : d->verdict.alternative_causes;
    for (int i = 0; i < count; i++) {
        struct lane lane = {.cause = &cause[i]};
        int has_place = cause_place(geometry_of_result(result), lane.cause, &lane.place);
        if (has_place && places.count < MOST_LANES)
            places.lane[places.count++] = lane;
        else
            places.others++;
        if (!has_place && !places.placeless)
            places.placeless = cause_label(pool, d, lane.cause);
    }
    return places;
}

/* The longest text of a lane that fits, and where it begins [px from the left]. */
static const char *lane_text(struct pool *pool, const rotid_diagnosis *d, const struct lane *lane, double width, double middle,
                             double *from)
{
    const char *label = cause_label(pool, d, lane->cause), *values = cause_values(pool, lane->cause);
    const char *text = *values ? pool_format(pool, "%s: %s", label, values) : label;
    if (!text || plot_width(text) > width - 12)
        text = label;
    *from = fmin(fmax(middle - plot_width(text) / 2, 6), fmax(width - plot_width(text) - 6, 6));
    return text;
}

static void draw_lanes(struct plot *plot, const rotid_diagnosis *d, const rotid_geometry *geometry, const struct places *places)
{
    static const double width[LAYOUTS] = {WIDE_PX, NARROW_PX};
    const char *color = places->named ? "VERMILION" : "PURPLE";
    for (int l = 0; l < LAYOUTS; l++) {
        plot_line(plot, l == WIDE ? "if (!narrow) {" : "} else {");
        for (int i = 0; i < places->count; i++) {
            const struct cause_place *place = &places->lane[i].place;
            double scale = (width[l] - LEFT_PX - RIGHT_PX) / geometry->length_m, from;
            const char *text =
                lane_text(plot->pool, d, &places->lane[i], width[l], LEFT_PX + scale * (place->from + place->to) / 2, &from);
            char where[80];
            (void)snprintf(where, sizeof where, "screen %g/W, first %g", from, places->count - i - 0.3);
            plot_label(plot, text, where, color, "left");
        }
    }
    plot_line(plot, "}");
    for (int i = 0; i < places->count; i++) {
        const struct cause_place *place = &places->lane[i].place;
        double y = places->count - i - 0.76, middle = (place->from + place->to) / 2;
        if (place->to > place->from)
            plot_line(plot, "set object %d rectangle from %.6g,%g to %.6g,%g fs solid noborder fc rgb %s", 100 + i, place->from,
                      y - 0.11, place->to, y + 0.11, color);
        else
            plot_line(plot, "set label %d '' at %.6g,%g point pt 7 ps 0.8 lc rgb %s", 200 + i, middle, y, color);
        if (isfinite(place->ci[0]) && isfinite(place->ci[1]))
            plot_line(plot, "set arrow %d from %.6g,%g to %.6g,%g heads size screen 0.006,90 front lc rgb %s lw 1.5", 100 + i,
                      fmax(place->ci[0], 0), y, fmin(place->ci[1], geometry->length_m), y,
                      place->to > place->from ? "INK" : color);
    }
    plot_line(plot, "plot NaN");
}

/* The ground behind the curve where a named cause acts. */
static void draw_named(struct plot *plot, const rotid_geometry *geometry, const struct places *places)
{
    for (int i = 0; i < places->count && places->named; i++) {
        const struct cause_place *place = &places->lane[i].place;
        double from = fmin(place->from, isfinite(place->ci[0]) ? fmax(place->ci[0], 0) : INFINITY),
               to = fmax(place->to, isfinite(place->ci[1]) ? fmin(place->ci[1], geometry->length_m) : -INFINITY);
        plot_line(plot, "set object %d rectangle from %.6g, graph 0 to %.6g, graph 1 behind fs solid noborder fc rgb SHADE",
                  i + 1, from, to);
        plot_line(plot, "set arrow %d from %.6g, graph 0 to %.6g, graph 1 nohead lc rgb VERMILION lw 1 dt (4,3)", i + 1,
                  (place->from + place->to) / 2, (place->from + place->to) / 2);
    }
}

static void margins(struct plot *plot, const char *top, const char *bottom)
{
    plot_line(plot, "set tmargin at screen 1-(HEAD+%s)/H; set bmargin at screen 1-(HEAD+%s)/H", top, bottom);
}

static void script(struct plot *plot, const struct result *result, const struct series *series, const struct places *places)
{
    const rotid_diagnosis *d = result->diagnose;
    const rotid_geometry *geometry = geometry_of_result(result);
    double rotor[LAYOUTS] = {0, 0}, lanes = LANE_PX * places->count, radius = geometry ? geometry_radius(geometry) : 1,
           length = geometry ? geometry->length_m : d->localisation[d->nlocalisation - 1].z_m;
    struct plot_layout layout = {.panels = 1, .columns = {1, 1}, .left = LEFT_PX, .right = RIGHT_PX, .top = 0, .bottom = AXIS_PX};
    for (int l = 0; l < LAYOUTS && geometry; l++)
        rotor[l] = 12 + fmin(2 * radius * ((l == WIDE ? WIDE_PX : NARROW_PX) - LEFT_PX - RIGHT_PX) / length, MOST_ROTOR);
    layout.height = 6 + rotor[WIDE] + lanes + CURVE_PX + AXIS_PX;
    layout.narrow_height = 6 + rotor[NARROW] + lanes + CURVE_PX + AXIS_PX;
    plot_series(plot, series);
    plot_begin(plot, &layout);
    plot_line(plot,
              "# heights [px] of the rotor, of the places under it and of the curve\nROTOR = narrow ? %g : %g; LANES = "
              "%g; CURVE = %g",
              rotor[NARROW], rotor[WIDE], lanes, CURVE_PX);
    if (geometry) {
        plot_panel(plot, 0);
        margins(plot, "4", "ROTOR");
        plot_line(plot, "set xrange [0:%.6g]\nset yrange [%.6g:%.6g]\nset border 0; unset tics; unset grid", length,
                  -1.02 * radius, 1.02 * radius);
        (void)rotor_draw(plot, geometry, NULL, 0);
        plot_line(plot, "plot NaN");
    }
    if (geometry && places->count) {
        plot_panel(plot, 0);
        margins(plot, "ROTOR", "ROTOR+LANES");
        plot_line(plot, "set xrange [0:%.6g]\nset yrange [0:%d]\nset border 0; unset tics; unset grid", length, places->count);
        draw_lanes(plot, d, geometry, places);
    }
    plot_panel(plot, 0);
    margins(plot, "ROTOR+LANES+6", "ROTOR+LANES+6+CURVE");
    plot_line(plot,
              "set xrange [0:%.6g]\nset yrange [0:1.05]\nset border 3; set grid ls 20\nset xtics 0,%g nomirror out scale 0.5 "
              "offset 0,0.25 textcolor rgb INK; set ytics 0.5 nomirror out scale 0.5 offset 0.5,0 textcolor rgb INK",
              length, plot_tic(length, 6));
    if (geometry)
        draw_named(plot, geometry, places);
    plot_axes(plot, "z [m]", "indicator [1]");
    plot_line(plot, "plot $indicator using 1:2 with filledcurves y1=0 fc rgb BLUE fs transparent solid 0.25 noborder, \\\n"
                    "    $indicator using 1:2 with lines ls 1");
}

/* What the places are, in a sentence that begins with a blank. */
static const char *which(struct pool *pool, const rotid_diagnosis *d, const struct places *places, int result_has_geometry)
{
    const char *text = "";
    int left = places->others + (places->count > MOST_TOLD ? places->count - MOST_TOLD : 0);
    for (int i = 0; i < places->count && i < MOST_TOLD && text; i++) {
        const struct cause_place *place = &places->lane[i].place;
        const char *where = place->to > place->from
                                ? pool_format(pool, "from %s to %s\xc2\xa0m", human_digits(pool, place->from, 3),
                                              human_digits(pool, place->to, 3))
                                : pool_format(pool, "at %s\xc2\xa0m", human_digits(pool, place->from, 3));
        const char *sure = isfinite(place->ci[0]) && isfinite(place->ci[1])
                               ? pool_format(pool, " (95\xc2\xa0%% of its place: %s to %s\xc2\xa0m)",
                                             human_digits(pool, place->ci[0], 3), human_digits(pool, place->ci[1], 3))
                               : "";
        text = pool_format(pool, "%s%s%s %s%s", text, i ? "; " : "", cause_label(pool, d, places->lane[i].cause),
                           where ? where : "", sure ? sure : "");
    }
    const char *nowhere = places->placeless && places->others == 1 && result_has_geometry
                              ? pool_format(pool, " %s acts at no single place.", places->placeless)
                              : "";
    left -= nowhere && *nowhere ? 1 : 0;
    if (!places->count || !text)
        return nowhere ? nowhere : "";
    const char *more = left > 0 ? pool_format(pool, "; and %s more", human_count(pool, left)) : "";
    text = pool_format(pool, " %s: %s%s.%s",
                       places->named       ? "Named"
                       : places->count > 1 ? "Possible, and not to be told apart"
                                           : "Possible",
                       text, more ? more : "", nowhere ? nowhere : "");
    return text ? text : "";
}

static struct series *collect(struct document *document, const rotid_diagnosis *d)
{
    static const struct column columns[] = {{"z", "m", AS_FIXED, 4}, {"indicator", "1", AS_FIXED, 3}};
    struct series *series = series_new(document, "indicator", d->nlocalisation, 2, columns);
    for (int i = 0; i < d->nlocalisation; i++)
        series_row(series, i, (const double[]){d->localisation[i].z_m, d->localisation[i].indicator});
    return series;
}

void figure_places(struct document *document, const struct result *result)
{
    const rotid_diagnosis *d = result->diagnose;
    struct pool *pool = document->pool;
    int most = -1;
    for (int i = 0; i < d->nlocalisation; i++)
        if (isfinite(d->localisation[i].indicator) &&
            (most < 0 || d->localisation[i].indicator > d->localisation[most].indicator))
            most = i;
    if (most < 0 || d->nlocalisation < 2 || d->verdict.kind == ROTID_ADEQUATE)
        return;
    struct places places = find_places(pool, result);
    struct figure *figure = document_figure(document, "places", "Force residual along the axis");
    figure->caption = pool_format(
        pool,
        "The misfit is mended best by a force at %s\xc2\xa0m, where the indicator is 1.%s The curve is a hint "
        "where to look, no cause: an error anywhere smears over its neighbourhood.",
        human_digits(pool, d->localisation[most].z_m, 3), which(pool, d, &places, geometry_of_result(result) != NULL));
    figure->alt = pool_format(pool, "The rotor, %s places of causes under it, and a curve along its axis with its peak at %s m.",
                              human_count(pool, places.count), human_digits(pool, d->localisation[most].z_m, 3));
    struct series *series = collect(document, d);
    struct plot plot;
    figure->table = series_table(series);
    if (!figure_begin(document, figure, result->file, &plot))
        return;
    script(&plot, result, series, &places);
    figure_end(document, &plot);
}
