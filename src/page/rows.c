#include "page/rows.h"

#include <string.h>

#define WIDE_ROW 26.0
#define TALL_ROW 40.0 /* where the names stand over them */
#define NAMES_PX 240.0
#define EDGE_PX  14.0

static double height_of(int layout, int rows)
{
    return 12 + (layout == WIDE ? WIDE_ROW : TALL_ROW) * rows + 50;
}

struct plot_layout rows_layout(int rows)
{
    return (struct plot_layout){.panels = 1,
                                .columns = {1, 1},
                                .height = height_of(WIDE, rows),
                                .narrow_height = height_of(NARROW, rows),
                                .left = NAMES_PX,
                                .right = 24,
                                .top = 12,
                                .bottom = 50};
}

/* The text, or its beginning with a mark that there was more. */
static const char *fitting(struct plot *plot, const char *text, double room)
{
    size_t length = strlen(text);
    char *cut = pool_copy_text(plot->pool, text);
    if (!cut || plot_width(text) <= room)
        return text;
    while (length > 1 && plot_width(cut) > room - 12) {
        do
            length--;
        while (length > 1 && ((unsigned char)cut[length] & 0xc0) == 0x80); /* not within a character */
        cut[length] = 0;
    }
    const char *marked = pool_format(plot->pool, "%s\xe2\x80\xa6", cut);
    return marked ? marked : text;
}

void rows_draw(struct plot *plot, int rows, const char *const name[])
{
    plot_line(
        plot,
        "LIFT = narrow ? 0.2 : 0\nif (narrow) { set lmargin at screen %g/W }\nset yrange [0.4:%g]\nunset ytics\nset border 1",
        EDGE_PX, rows + 0.5);
    for (int l = 0; l < LAYOUTS; l++) {
        plot_line(plot, l == WIDE ? "if (!narrow) {" : "} else {");
        for (int i = 0; i < rows; i++) {
            char where[64];
            (void)snprintf(where, sizeof where, l == WIDE ? "graph 0, first %d" : "graph 0, first %d+0.26", rows - i);
            plot_label(plot, fitting(plot, name[i], l == WIDE ? NAMES_PX - 16 : NARROW_PX - 2 * EDGE_PX), where, "INK",
                       l == WIDE ? "right offset char -0.7, 0" : "left");
        }
    }
    plot_line(plot, "}");
}
