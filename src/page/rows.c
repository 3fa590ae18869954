#include "page/rows.h"

#define NAMES_PX 240.0
#define EDGE_PX  14.0
#define ENDS_PX  62.0 /* over and under the rows */

static struct name_rows measure(int rows, const char *const name[])
{
    static const double room[LAYOUTS] = {NAMES_PX - 16, NARROW_PX - 2 * EDGE_PX}, single[LAYOUTS] = {26, 40};
    return names_measure(rows, name, room, single);
}

struct plot_layout rows_layout(int rows, const char *const name[])
{
    struct name_rows names = measure(rows, name);
    return (struct plot_layout){.panels = 1,
                                .columns = {1, 1},
                                .height = ENDS_PX + names.height[WIDE] * rows,
                                .narrow_height = ENDS_PX + names.height[NARROW] * rows,
                                .left = NAMES_PX,
                                .right = 24,
                                .top = 12,
                                .bottom = 50};
}

void rows_draw(struct plot *plot, int rows, const char *const name[])
{
    struct name_rows names = measure(rows, name);
    plot_line(plot, "if (narrow) { set lmargin at screen %g/W }\nset yrange [0.4:%g]\nunset ytics\nset border 1", EDGE_PX,
              rows + 0.5);
    names_draw(plot, &names, NULL);
}
