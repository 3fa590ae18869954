#include "page/plot.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "page/human.h"
#include "page/names.h"
#include "page/palette.h"

#define TYPEFACE "Arial" /* Liberation Sans and Helvetica have the same widths: what fits here fits elsewhere */
#define LABEL_PX 15.0    /* between two lines of text */
#define LINE_CHAR    1.1 /* LABEL_PX in heights of a character */
#define AXIS_EDGE_PX 8.0
#define END_PX       12.0 /* between a line and its label, and behind it */

/* Dashes and marks by series: no line is told by its colour alone. */
static void styles(FILE *out)
{
    static const char *const dash[SERIES] = {"1", "(8,4)", "(2,3)", "(8,3,2,3)", "(14,4)"};
    static const int mark[SERIES] = {7, 5, 9, 13, 11};
    for (int i = 0; i < 2 * SERIES; i++)
        (void)fprintf(out, "set style line %d lc rgb %s lw 1.5 dt %s pt %d ps 0.6\n", i + 1, series_color[i % SERIES],
                      dash[(i + i / SERIES) % SERIES], mark[i % SERIES] - i / SERIES);
}

void plot_comment(struct plot *plot, const char *text)
{
    for (const char *c = text; *c; c += text_utf8(c) ? text_utf8(c) : 1) {
        int is_kept = text_visible(c) && *c != '\\'; /* at its end a backslash would continue the comment */
        (void)fwrite(is_kept ? c : "?", 1, is_kept ? text_visible(c) : 1, plot->out);
    }
}

int plot_open(struct plot *plot, struct pool *pool, struct figure *figure, const char *source)
{
    *plot = (struct plot){.pool = pool, .figure = figure};
    plot->out = open_memstream(&plot->text, &plot->length);
    if (!plot->out)
        return ROTID_ERROR_MEMORY;
    FILE *out = plot->out;
    (void)fprintf(out, "# rotid %s, figure %s of ", ROTID_VERSION, figure->id);
    plot_comment(plot, source);
    (void)fprintf(out,
                  "\n# Change what you like, then run:  gnuplot %s.gp\n"
                  "# It writes %s.svg and %s.pdf. Colours and styles come first, then the data, then what is drawn.\n"
                  "reset\nset encoding utf8\nname = '%s'\nif (!exists('layouts')) layouts = 'svg pdf'\n"
                  "typeface = '" TYPEFACE "'\n",
                  figure->id, figure->id, figure->id, figure->id);
    palette_script(out);
    styles(out);
    (void)fputs("set style line 20 lc rgb GRID lw 0.75 dt 1\n"
                "set border 3 lc rgb INK lw 0.75\nset tics nomirror out scale 0.5 textcolor rgb INK\nset xtics offset 0, 0.25\n"
                "set ytics offset 0.5, 0\nset format x '%g'\nset format y '%g'\nset grid ls 20\n"
                "unset mxtics; unset mytics\nset key noautotitle\nset samples 200\nset minussign\nset pointintervalbox 0\n",
                out);
    return ROTID_OK;
}

void plot_line(struct plot *plot, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    (void)vfprintf(plot->out, format, arguments);
    va_end(arguments);
    (void)fputc('\n', plot->out);
}

const char *plot_number(struct plot *plot, double value)
{
    const char *text = isfinite(value) ? pool_format(plot->pool, "%.9g", value) : "NaN";
    return text ? text : "NaN";
}

/* What may stand in a picture: XML has no U+FFFE and U+FFFF. */
static size_t drawable(const char *text)
{
    return strncmp(text, "\xef\xbf\xbe", 3) != 0 && strncmp(text, "\xef\xbf\xbf", 3) != 0 ? text_visible(text) : 0;
}

#define APOSTROPHE "\xe2\x80\x99" /* U+2019 */

/* What stands for the character at `text` in a text of quotes. A quote within one is written twice, but gnuplot 5.4 takes one at
 * the beginning for the end: an apostrophe is another character, so none has to be written. */
static const char *shown(const char *text, int is_tick)
{
    if (*text == '\'')
        return APOSTROPHE;
    if (strchr("\n\r\t", *text)) /* a line feed would end the text, and the command */
        return " ";
    if (*text == '%' && is_tick)
        return "%%";
    return drawable(text) ? NULL : TEXT_REPLACEMENT;
}

static const char *quote(struct plot *plot, const char *text, int is_tick)
{
    char *quoted = POOL_ARRAY(plot->pool, char, 3 * strlen(text) + 3), *end = quoted;
    if (!quoted)
        return "''";
    *end++ = '\'';
    while (*text) {
        size_t bytes = text_utf8(text) ? text_utf8(text) : 1;
        const char *other = shown(text, is_tick);
        size_t kept = other ? strlen(other) : bytes;
        memcpy(end, other ? other : text, kept);
        end += kept;
        text += bytes;
    }
    *end = '\'';
    return quoted;
}

const char *plot_quote(struct plot *plot, const char *text)
{
    return quote(plot, text, 0);
}

const char *plot_quote_tick(struct plot *plot, const char *text)
{
    return quote(plot, text, 1);
}

void plot_decades_axis(struct plot *plot, char axis, const struct plot_range *range, int most)
{
    int from = (int)range->from, to = (int)range->to, every = (to - from + most - 1) / most;
    plot_line(plot, "set logscale %c\nset %crange [1e%d:1e%d]", axis, axis, from, to);
    (void)fprintf(plot->out, "set %ctics (", axis);
    for (int e = from; e <= to; e += every > 1 ? every : 1)
        (void)fprintf(plot->out, "%s'%s' 1e%d", e > from ? ", " : "", human_power(plot->pool, e), e);
    (void)fputs(")\n", plot->out);
}

void plot_begin(struct plot *plot, const struct plot_layout *layout)
{
    FILE *out = plot->out;
    plot->layout = *layout;
    for (int l = 0; l < LAYOUTS; l++) {
        int rows = (layout->panels + layout->columns[l] - 1) / layout->columns[l];
        double height = l == NARROW && layout->narrow_height > 0 ? layout->narrow_height : layout->height;
        plot->figure->height[l] = (int)ceil(layout->head[l] + rows * height);
    }
    (void)fprintf(out,
                  "\n# Panels in rows: margins [px] of each around its axes. Sizes [px] are those on a page; 96 px are an inch.\n"
                  "LEFT = %g; RIGHT = %g; TOP = %g; BOTTOM = %g\n"
                  "x_of(i) = (i %% COLUMNS) * (W / COLUMNS)\ny_of(i) = HEAD + floor(i / COLUMNS) * HEIGHT\n"
                  "panel(i) = sprintf('set lmargin at screen %%.6f; set rmargin at screen %%.6f; set tmargin at screen %%.6f; "
                  "set bmargin at screen %%.6f', (x_of(i) + LEFT) / W, (x_of(i) + W / COLUMNS - RIGHT) / W, \\\n"
                  "    1 - (y_of(i) + TOP) / H, 1 - (y_of(i) + HEIGHT - BOTTOM) / H)\n\n",
                  layout->left, layout->right, layout->top, layout->bottom);
    (void)fprintf(
        out,
        "do for [layout in layouts] {\n"
        "narrow = layout eq 'narrow'\n"
        "W = narrow ? %d.0 : %d.0; H = narrow ? %d.0 : %d.0; COLUMNS = narrow ? %d : %d; HEAD = narrow ? %g : %g; HEIGHT = "
        "narrow ? %g : %g\n"
        "if (layout eq 'pdf' && strstrt(GPVAL_TERMINALS, 'pdfcairo') == 0) { continue }\n"
        "if (layout eq 'pdf') { set terminal pdfcairo noenhanced color font typeface.',9' size W/96, H/96 linewidth 0.75 } \\\n"
        "else { set terminal svg size W, H dynamic noenhanced font typeface.',12' background rgb 'white' }\n"
        "set output name.(narrow ? '-narrow.svg' : '.'.layout)\n"
        "set multiplot\n",
        NARROW_PX, WIDE_PX, plot->figure->height[NARROW], plot->figure->height[WIDE], layout->columns[NARROW],
        layout->columns[WIDE], layout->head[NARROW], layout->head[WIDE],
        layout->narrow_height > 0 ? layout->narrow_height : layout->height, layout->height);
}

void plot_panel(struct plot *plot, int i)
{
    plot->panel = i;
    plot->labels = 0;
    plot_line(plot,
              "# panel %d\nunset label; unset object; unset arrow; unset logscale; set autoscale; set border 3\n"
              "set format x '%%g'; set format y '%%g'; set xtics auto; set ytics auto; eval panel(%d)",
              i + 1, i);
}

double plot_lines_px(int count, const char *const *text, double room)
{
    int most = 1;
    for (int i = 0; i < count; i++) {
        int lines = text[i] ? name_line_count(text[i], room) : 1;
        most = lines > most ? lines : most;
    }
    return LABEL_PX * (most - 1);
}

double plot_panel_px(const struct plot_layout *layout)
{
    static const double width[LAYOUTS] = {WIDE_PX, NARROW_PX};
    double least = INFINITY;
    for (int l = 0; l < LAYOUTS; l++)
        least = fmin(least, width[l] / layout->columns[l]);
    return least - layout->left - layout->right;
}

double plot_axis_px(const struct plot_layout *layout)
{
    /* it stands under the middle of the panel, which the margins move aside */
    return plot_panel_px(layout) + 2 * fmin(layout->left, layout->right) - AXIS_EDGE_PX;
}

void plot_label_over(struct plot *plot, const char *text, double room, const char *where, double up, const char *color)
{
    for (int k = name_line_count(text, room) - 1; k >= 0; k--) {
        size_t bytes = name_line(text, room);
        const char *line = pool_format(plot->pool, "%.*s", (int)bytes, text);
        char more[64];
        (void)snprintf(more, sizeof more, "left offset 0, char %.4g", up + LINE_CHAR * k);
        plot_label(plot, line ? line : "", where, color, more);
        text += bytes + strspn(text + bytes, " ");
    }
}

/* Labels where the margins have room for them, which those of gnuplot itself do not tell. */
void plot_axes(struct plot *plot, const char *x, const char *y)
{
    double room = plot_axis_px(&plot->layout);
    for (int k = x ? name_line_count(x, room) - 1 : -1; k >= 0; k--) {
        size_t bytes = name_line(x, room);
        const char *line = pool_format(plot->pool, "%.*s", (int)bytes, x);
        plot_line(plot, "set label %d %s at graph 0.5, screen 1-(y_of(%d)+HEIGHT-%g)/H center tc rgb INK", ++plot->labels,
                  plot_quote(plot, line ? line : ""), plot->panel, 10 + LABEL_PX * k);
        x += bytes + strspn(x + bytes, " ");
    }
    if (y)
        plot_line(plot, "set label %d %s at screen (x_of(%d)+12)/W, graph 0.5 center rotate tc rgb INK", ++plot->labels,
                  plot_quote(plot, y), plot->panel);
}

void plot_label(struct plot *plot, const char *text, const char *where, const char *color, const char *more)
{
    plot_line(plot, "set label %d %s at %s front tc rgb %s %s", ++plot->labels, plot_quote(plot, text), where, color, more);
}

/* Apart by a line of text, as near to where they belong as that allows: neighbours in conflict share the way. */
static void spread(int count, const int *order, double *y, double gap)
{
    for (int round = 0; round < 200; round++)
        for (int i = 0; i + 1 < count; i++) {
            double *low = &y[order[i]], *high = &y[order[i + 1]], lack = gap - (*high - *low);
            if (lack <= 0)
                continue;
            *low -= lack / 2;
            *high += lack / 2;
            if (*low < 0) {
                *high -= *low;
                *low = 0;
            }
            if (*high > 1) {
                *low -= *high - 1;
                *high = 1;
            }
        }
}

void plot_end_labels(struct plot *plot, int count, const char *const *text, const double *height, const char *const *color)
{
    const struct plot_layout *l = &plot->layout;
    double *y = POOL_ARRAY(plot->pool, double, count);
    int *order = POOL_ARRAY(plot->pool, int, count);
    if (!y || !order)
        return; /* the caller's next allocation fails as well */
    for (int i = 0; i < count; i++) {
        int k = i;
        y[i] = isfinite(height[i]) ? fmin(fmax(height[i], 0), 1) : 0;
        for (; k > 0 && y[order[k - 1]] > y[i]; k--)
            order[k] = order[k - 1];
        order[k] = i;
    }
    double inner = l->height - l->top - l->bottom, room = l->right - END_PX, step = LABEL_PX / inner;
    spread(count, order, y, step + plot_lines_px(count, text, room) / inner);
    for (int i = 0; i < count; i++) {
        const char *rest = text[i];
        int lines = name_line_count(rest, room);
        for (int k = 0; k < lines; k++) {
            size_t bytes = name_line(rest, room);
            const char *line = pool_format(plot->pool, "%.*s", (int)bytes, rest);
            char where[64];
            (void)snprintf(where, sizeof where, "graph 1, graph %.4f", y[i] + (0.5 * (lines - 1) - k) * step);
            plot_label(plot, line ? line : "", where, color[i], "left offset char 0.7, 0");
            rest += bytes + strspn(rest + bytes, " ");
        }
    }
}

int plot_close(struct plot *plot)
{
    (void)fputs("unset multiplot\nunset output\n}\n", plot->out);
    int failed = ferror(plot->out);
    failed |= fclose(plot->out) != 0;
    plot->figure->script = failed ? NULL : pool_copy_text(plot->pool, plot->text);
    free(plot->text);
    plot->text = NULL;
    return plot->figure->script ? ROTID_OK : ROTID_ERROR_MEMORY;
}
