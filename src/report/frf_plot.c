/* Bode plot in plain ASCII. */
#include <math.h>
#include <string.h>

#include "report/layout.h"
#include "report/report_frf.h"

#define MOST_COLUMNS 120
#define HEIGHT       16 /* rows of the magnitude */
#define PHASE_HEIGHT 9  /* -180 to 180 in steps of 45 degrees */
#define DECADES      5  /* at most: what lies deeper says nothing */
#define MARGIN       11
#define PI           3.14159265358979323846

struct canvas {
    int columns, rows;
    char cell[HEIGHT][MOST_COLUMNS + 1];
};

static void open_canvas(struct canvas *canvas, int columns, int rows)
{
    canvas->columns = columns;
    canvas->rows = rows;
    for (int r = 0; r < rows; r++) {
        memset(canvas->cell[r], ' ', (size_t)columns);
        canvas->cell[r][columns] = 0;
    }
}

/* height: 0 at the bottom, 1 at the top */
static void put(struct canvas *canvas, int column, double height, char mark)
{
    if (!isfinite(height) || height < -0.5 / (canvas->rows - 1))
        return;
    int row = (int)lround((1 - fmin(fmax(height, 0), 1)) * (canvas->rows - 1));
    char *cell = &canvas->cell[row][column];
    *cell = *cell == ' ' || *cell == mark ? mark : '@';
}

static void print_row(FILE *out, const struct canvas *canvas, int row, const char *label)
{
    int last = canvas->columns;
    while (last > 0 && canvas->cell[row][last - 1] == ' ')
        last--;
    (void)fprintf(out, "%*s |%.*s\n", MARGIN - 2, label, last, canvas->cell[row]);
}

/* The line of each column that is drawn: the one of largest magnitude, or the nearest where a column has none. */
static void choose(int columns, int nline, const double *hz, const double complex *h, int *line)
{
    double from = hz[0], span = hz[nline - 1] - from;
    int near = 0;
    for (int c = 0; c < columns; c++)
        line[c] = -1;
    for (int l = 0; l < nline; l++) {
        int c = span > 0 ? (int)((hz[l] - from) / span * (columns - 1) + 0.5) : 0;
        if (isfinite(cabs(h[l])) && (line[c] < 0 || cabs(h[l]) > cabs(h[line[c]])))
            line[c] = l;
    }
    for (int c = 0; c < columns; c++) {
        double at = from + span * c / (columns - 1);
        while (near + 1 < nline && fabs(hz[near + 1] - at) <= fabs(hz[near] - at))
            near++;
        if (line[c] < 0)
            line[c] = near;
    }
}

static void frame(FILE *out, int columns, double from, double to)
{
    (void)fprintf(out, "%*s +", MARGIN - 2, "");
    for (int c = 0; c < columns; c++)
        (void)fputc(c % 10 ? '-' : '+', out);
    (void)fprintf(out, "\n%*s", MARGIN, "");
    for (int c = 0; c + 10 <= columns; c += 20)
        (void)fprintf(out, "%-*.5g", c + 30 <= columns ? 20 : 8, from + (to - from) * c / (columns - 1));
    (void)fputs("Hz\n", out);
}

void frf_plot(FILE *out, int columns, int nline, const double *hz, const double complex *synthesised,
              const double complex *measured)
{
    const double complex *curve[2] = {synthesised, measured};
    struct canvas magnitude, phase;
    double top = 0, bottom = INFINITY;
    int line[2][MOST_COLUMNS] = {{0}};
    char label[32];
    columns = columns > MOST_COLUMNS ? MOST_COLUMNS : columns;
    open_canvas(&magnitude, columns, HEIGHT);
    open_canvas(&phase, columns, PHASE_HEIGHT);
    for (int i = 0; i < 2 && curve[i]; i++) {
        choose(columns, nline, hz, curve[i], line[i]);
        for (int c = 0; c < columns; c++) {
            double size = cabs(curve[i][line[i][c]]);
            top = isfinite(size) ? fmax(top, size) : top;
            bottom = size > 0 ? fmin(bottom, size) : bottom;
        }
    }
    if (!(top > 0))
        return;
    double high = log10(top), low = fmax(fmin(log10(bottom), high - 1), high - DECADES);
    for (int i = 0; i < 2 && curve[i]; i++)
        for (int c = 0; c < columns; c++) {
            double complex h = curve[i][line[i][c]];
            put(&magnitude, c, (log10(cabs(h)) - low) / (high - low), "*o"[i]);
            put(&phase, c, 0.5 + carg(h) / (2 * PI), "*o"[i]);
        }
    for (int r = 0; r < HEIGHT; r++) {
        (void)snprintf(label, sizeof label, "%.1e", pow(10, high - (high - low) * r / (HEIGHT - 1)));
        print_row(out, &magnitude, r, r % 5 ? "" : label);
    }
    frame(out, columns, hz[0], hz[nline - 1]);
    for (int r = 0; r < PHASE_HEIGHT; r++) {
        (void)snprintf(label, sizeof label, "%d deg", 180 - 45 * r);
        print_row(out, &phase, r, r % 2 ? "" : label);
    }
    frame(out, columns, hz[0], hz[nline - 1]);
}
