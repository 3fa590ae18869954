#include "page/names.h"

#include <math.h>
#include <string.h>

#include "base/text.h"

#define LINE_PX 13.5 /* from line to line */
#define HELD    2    /* lines that a wide row of one has room for */

size_t name_line(const char *text, double room)
{
    char start[512];
    size_t length = strlen(text), fits = 0, blank = 0;
    if (plot_width(text) <= room)
        return length;
    while (fits < length) {
        size_t bytes = text_utf8(text + fits), next = fits + (bytes ? bytes : 1);
        if (next >= sizeof start)
            break;
        memcpy(start, text, next);
        start[next] = 0;
        if (fits && plot_width(start) > room)
            break;
        if (text[fits] == ' ')
            blank = fits;
        fits = next;
    }
    return text[fits] == ' ' ? fits : blank ? blank : fits;
}

/* Where the next line begins behind one of so many bytes. */
static const char *behind(const char *text, size_t bytes)
{
    text += bytes;
    return text + strspn(text, " ");
}

int name_line_count(const char *text, double room)
{
    int count = 0;
    do
        text = behind(text, name_line(text, room)), count++;
    while (*text);
    return count;
}

struct name_rows names_measure(int rows, const char *const name[], const double room[LAYOUTS], const double single[LAYOUTS])
{
    struct name_rows names = {.rows = rows, .name = name};
    for (int l = 0; l < LAYOUTS; l++) {
        int most = 1;
        for (int i = 0; i < rows; i++) {
            int count = name_line_count(name[i], room[l]);
            most = count > most ? count : most;
        }
        names.room[l] = room[l];
        names.single[l] = single[l];
        names.height[l] = single[l] + LINE_PX * (l == NARROW ? most - 1 : most > HELD ? most - HELD : 0);
        if (l == WIDE && most > 1)
            names.height[l] = fmax(names.height[l], HELD * LINE_PX + 2);
    }
    return names;
}

static void draw_name(struct plot *plot, const struct name_rows *names, int l, int i, const char *color)
{
    const char *text = names->name[i];
    double step = LINE_PX / names->height[l], row = names->rows - i;
    int count = name_line_count(text, names->room[l]);
    /* of the first line, beside the middle of the row or over what is drawn in it */
    double y =
        l == WIDE ? row + 0.5 * (count - 1) * step : row - 0.5 + 0.76 * names->single[l] / names->height[l] + (count - 1) * step;
    for (int k = 0; k < count; k++) {
        size_t bytes = name_line(text, names->room[l]);
        const char *line = pool_format(plot->pool, "%.*s", (int)bytes, text);
        char where[64];
        (void)snprintf(where, sizeof where, "graph 0, first %.4f", y - k * step);
        plot_label(plot, line ? line : "", where, color, l == WIDE ? "right offset char -0.7, 0" : "left");
        text = behind(text, bytes);
    }
}

void names_draw(struct plot *plot, const struct name_rows *names, const char *const color[])
{
    double share[LAYOUTS];
    for (int l = 0; l < LAYOUTS; l++)
        share[l] = names->single[l] / names->height[l];
    plot_line(plot, "SHARE = narrow ? %.4f : %.4f; LIFT = narrow ? %.4f : 0", share[NARROW], share[WIDE],
              0.5 - 0.3 * share[NARROW]);
    for (int l = 0; l < LAYOUTS; l++) {
        plot_line(plot, l == WIDE ? "if (!narrow) {" : "} else {");
        for (int i = 0; i < names->rows; i++)
            draw_name(plot, names, l, i, color ? color[i] : "INK");
    }
    plot_line(plot, "}");
}
