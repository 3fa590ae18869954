#include <string.h>

#include "page/names.h"
#include "page/plot.h"

#define ROW_PX    20.0
#define LINE_PX   14.0 /* from line to line of a text */
#define FURTHER   1000 /* between the numbers of the labels of two lines */
#define SAMPLE_PX 24.0 /* of a line or mark */
#define GAP_PX    16.0 /* between entries */
#define EDGE_PX   8.0

struct spot { /* of an entry: its left end and its middle, px from the left and the top */
    double x, y;
};

static double text_room(double width)
{
    return width - 2 * EDGE_PX - SAMPLE_PX - 6;
}

static struct spot next_spot(const struct plot_entry *entry, double width, struct spot *at)
{
    double needs = SAMPLE_PX + 6 + plot_width(entry->text);
    if (at->x > EDGE_PX && at->x + needs > width - EDGE_PX) {
        at->x = EDGE_PX;
        at->y += ROW_PX;
    }
    struct spot here = *at;
    at->x += needs + GAP_PX;
    at->y += LINE_PX * (name_line_count(entry->text, text_room(width)) - 1);
    return here;
}

void plot_head(const struct plot_entry *entry, int count, double head[LAYOUTS])
{
    static const double width[LAYOUTS] = {WIDE_PX, NARROW_PX};
    for (int l = 0; l < LAYOUTS; l++) {
        struct spot at = {EDGE_PX, ROW_PX / 2};
        for (int i = 0; i < count; i++)
            (void)next_spot(&entry[i], width[l], &at);
        head[l] = count ? at.y + ROW_PX / 2 + 4 : 0;
    }
}

static void draw_entry(struct plot *plot, const struct plot_entry *entry, int number, struct spot at, double room)
{
    double y = at.y, x = at.x;
    if (entry->keys & KEY_FACE && *entry->face)
        plot_line(
            plot,
            "set object %d rectangle from screen %g/W, 1-%g/H to screen %g/W, 1-%g/H fs solid border lc rgb MUTED fc rgb %s",
            number, x, y + 5, x + SAMPLE_PX, y - 5, entry->face);
    if (entry->keys & KEY_HATCH)
        plot_line(plot,
                  "set object %d rectangle from screen %g/W, 1-%g/H to screen %g/W, 1-%g/H fs transparent pattern 4 border lc "
                  "rgb MUTED "
                  "fc rgb INK",
                  number + 1, x, y + 5, x + SAMPLE_PX, y - 5);
    if (entry->keys & KEY_LINE)
        plot_line(plot, "set arrow %d from screen %g/W, 1-%g/H to screen %g/W, 1-%g/H nohead ls %d", number, x, y, x + SAMPLE_PX,
                  y, entry->style);
    if (entry->keys & KEY_MARK)
        plot_line(plot, "set label %d '' at screen %g/W, 1-%g/H point ls %d", number, x + SAMPLE_PX / 2, y, entry->style);
    const char *text = entry->text;
    for (int k = 0, count = name_line_count(text, room); k < count; k++) {
        size_t bytes = name_line(text, room);
        const char *line = pool_format(plot->pool, "%.*s", (int)bytes, text);
        plot_line(plot, "set label %d %s at screen %g/W, 1-%g/H left tc rgb INK", number + 1 + FURTHER * k,
                  plot_quote(plot, line ? line : ""), x + SAMPLE_PX + 6, y + LINE_PX * k);
        text += bytes + strspn(text + bytes, " ");
    }
}

void plot_legend(struct plot *plot, const struct plot_entry *entry, int count)
{
    static const double width[LAYOUTS] = {WIDE_PX, NARROW_PX};
    static const char *const when[LAYOUTS] = {"if (!narrow) {", "} else {"};
    plot_line(plot, "# legend");
    for (int l = 0; l < LAYOUTS; l++) {
        struct spot at = {EDGE_PX, ROW_PX / 2};
        plot_line(plot, "%s", when[l]);
        for (int i = 0; i < count; i++)
            draw_entry(plot, &entry[i], 901 + 2 * i, next_spot(&entry[i], width[l], &at), text_room(width[l]));
    }
    plot_line(plot, "}");
}
