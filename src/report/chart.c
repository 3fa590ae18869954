/* Charts of one line: a signed bar, strips along the axis of the rotor. */
#include "report/report.h"

void chart_bar(char *bar, int half, double scale, double value)
{
    double size = isfinite(value) && scale > 0 ? fabs(value) / scale * half : 0;
    int beyond = size > half + 0.5, length = beyond ? half : (int)(size + 0.5);
    for (int c = -half; c <= half; c++) {
        int inside = value < 0 ? c < 0 && c >= -length : c > 0 && c <= length;
        int end = beyond && c == (value < 0 ? -half : half);
        bar[c + half] = (char)(c == 0 ? '|' : end ? (value < 0 ? '<' : '>') : inside ? '=' : ' ');
    }
    bar[2 * half + 1] = 0;
}

struct strip strip_open(double length, int columns)
{
    struct strip strip = {.length = length > 0 ? length : 1,
                          .columns = columns < 10           ? 10
                                     : columns > STRIP_MOST ? STRIP_MOST
                                                            : columns};
    memset(strip.line, ' ', (size_t)strip.columns);
    return strip;
}

static int column_of(const struct strip *strip, double z)
{
    double column = z / strip->length * (strip->columns - 1) + 0.5;
    return column >= strip->columns - 1 ? strip->columns - 1 : column >= 0 ? (int)column : 0; /* NaN: 0 */
}

void strip_digits(struct strip *strip, int count, const double *z, const double *value)
{
    for (int i = 0; i < count; i++) {
        if (!isfinite(value[i]) || !isfinite(z[i]))
            continue;
        char *cell = &strip->line[column_of(strip, z[i])];
        char now = value[i] >= 9.5 ? '+' : (char)('0' + (int)(fmax(value[i], 0) + 0.5));
        if (*cell == ' ' || (*cell != '+' && (now == '+' || now > *cell)))
            *cell = now;
    }
}

/* Straight lines between the points, 0 outside them. */
static double interpolate(int count, const rotid_localisation *point, double at)
{
    for (const rotid_localisation *b = point + 1; b < point + count; b++) {
        const rotid_localisation *a = b - 1;
        if (a->z_m <= at && at <= b->z_m)
            return b->z_m > a->z_m ? a->indicator + (b->indicator - a->indicator) * (at - a->z_m) / (b->z_m - a->z_m)
                                   : fmax(a->indicator, b->indicator);
    }
    return 0;
}

void strip_density(struct strip *strip, int count, const rotid_localisation *point)
{
    static const char scale[] = " .:-=+*#%@";
    for (int c = 0; c < strip->columns; c++) {
        double largest = interpolate(count, point, strip->length * c / (strip->columns - 1));
        for (int i = 0; i < count; i++)
            if (column_of(strip, point[i].z_m) == c) /* no peak falls between two columns */
                largest = fmax(largest, point[i].indicator);
        double level = 10 * largest;
        strip->line[c] = level >= 9 ? scale[9] : level > 0 ? scale[(int)level] : ' ';
    }
}

#define LETTER '\1' /* in a column whose character has several bytes, or none that is shown */

/* Writes over blanks only, as far as the strip reaches; a character a column. */
static void write_at(struct strip *strip, int column, const char *text, int most)
{
    for (size_t bytes; most > 0 && *text && column < strip->columns; most--, column++, text += bytes) {
        bytes = text_utf8(text) ? text_utf8(text) : 1;
        if (column < 0 || strip->line[column] != ' ')
            continue;
        strip->line[column] = (char)(bytes == 1 && text_visible(text) ? *text : LETTER);
        strip->letter[column] = text;
    }
}

void strip_mark(struct strip *strip, double from, double to, const char *label)
{
    int first = column_of(strip, from), last = column_of(strip, to), columns = text_columns(label);
    for (int c = first; c <= last; c++)
        strip->line[c] = c == first || c == last ? '^' : '-';
    if (last + 2 + columns <= strip->columns || first < columns + 1)
        write_at(strip, last + 2, label, columns);
    else
        write_at(strip, first - 1 - columns, label, columns);
}

void strip_name(struct strip *strip, double from, double to, const char *name)
{
    int first = column_of(strip, from), room = column_of(strip, to) - first - 1;
    strip->line[first] = '|';
    write_at(strip, first + 1, name, room);
}

/* Round numbers of z. */
void strip_ticks(struct strip *strip)
{
    double step = pow(10, floor(log10(strip->length))), most = strip->columns / 9.0;
    while (strip->length / step < most / 2)
        step /= 2; /* 1, 0.5, 0.25, 0.125: round enough for a position */
    char text[32];
    for (int i = 0; i * step <= strip->length * (1 + 1e-9); i++) {
        int bytes = snprintf(text, sizeof text, "%.4g", i * step), column = column_of(strip, i * step);
        if (column + bytes > strip->columns)
            column = strip->columns - bytes;
        write_at(strip, column, text, bytes);
    }
}

void strip_print(const struct strip *strip, FILE *out, int width, const char *label)
{
    int last = strip->columns;
    while (last > 0 && strip->line[last - 1] == ' ')
        last--;
    text_cell(out, width, label);
    for (int c = 0; c < last; c++)
        if (strip->line[c] == LETTER)
            text_character(out, strip->letter[c]);
        else
            (void)fputc(strip->line[c], out);
    (void)fputc('\n', out);
}
