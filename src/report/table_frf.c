#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "report/report.h"
#include "result/result.h"

/* Bode plot in plain ASCII. */

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

static void frf_plot_print_row(FILE *out, const struct canvas *canvas, int row, const char *label)
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

/* Log magnitude over frequency, and phase below, on `columns` columns: '*' synthesised, 'o' measured (NULL where there is none),
 * '@' both. Of the lines that share a column the largest magnitude is drawn. */
static void frf_plot(FILE *out, int columns, int nline, const double *hz, const double complex *synthesised,
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
        frf_plot_print_row(out, &magnitude, r, r % 5 ? "" : label);
    }
    frame(out, columns, hz[0], hz[nline - 1]);
    for (int r = 0; r < PHASE_HEIGHT; r++) {
        (void)snprintf(label, sizeof label, "%d deg", 180 - 45 * r);
        frf_plot_print_row(out, &phase, r, r % 2 ? "" : label);
    }
    frame(out, columns, hz[0], hz[nline - 1]);
}

#define MOST_ROWS 40 /* beyond it the worst ones and a count */
#define WORST     10
#define COLUMNS   88   /* of the plot */
#define FLIPPED   0.05 /* gain of FRAC with the conjugate that is no accident */

static const char *source_text(enum frf_damping damping)
{
    switch (damping) {
    case FRF_DAMPING_MEASURED:
        return "measured";
    case FRF_DAMPING_STATED:
        return "DAMPING=";
    case FRF_DAMPING_SMALLEST:
        return "smallest measured";
    default:
        return "mean of measured";
    }
}

static void print_model(FILE *out, const struct frf_view *view)
{
    const struct frf_result *r = view->result;
    const struct synthesis *s = &r->synthesis;
    (void)fprintf(out, "%s over force [%s], %d line%s from %.6g to %.6g Hz\n", transfer_quantity_words[r->quantity],
                  transfer_unit_words[r->quantity], r->nline, r->nline == 1 ? "" : "s", r->frequency_hz[0],
                  r->frequency_hz[r->nline - 1]);
    (void)fprintf(out, "full model %s", view->identified ? "at the identified parameters" : "as the deck states it");
    for (int p = 0; view->identified && p < view->identified->fit->n; p++)
        (void)fprintf(out, "%s %s = %.6g %s", p ? "," : ":", view->job->unknowns.bounds[p].name, view->identified->fit->x[p],
                      view->job->unknowns.bounds[p].unit);
    (void)fprintf(
        out, "\nsum of %d mode%s on the supports or free and %d elastic ones, all up to %.6g Hz; the rest by its flexibility\n",
        s->nrigid, s->nrigid == 1 ? "" : "s", s->nmode - s->nrigid, r->up_to_hz);
    for (int i = 0; i < s->nrigid; i++)
        (void)fprintf(out, "%s%.4f Hz",
                      i ? ", " : "modes on the supports: ", sqrt(fmax(s->lambda[i], 0)) / 6.28318530717958647692);
    if (s->nrigid)
        (void)fprintf(out, ", damping %s %% (%s)\n", IN_DIGITS(4, 100 * r->zeta[0]), source_text(r->damping[0]));
    if (r->decay > 0)
        (void)fprintf(out, "exponential window of the measurement: %.5g 1/s, synthesised with it\n", r->decay);
}

static void print_modes(FILE *out, const struct frf_view *view)
{
    const struct frf_result *r = view->result;
    if (!r->nband)
        return;
    (void)fprintf(out, "\nmode      model   measured   damping%s\n",
                  r->is_measured ? "     FRAC   FRAC at     level    phase   largest deviation" : "");
    (void)fprintf(out, "           [Hz]       [Hz]       [%%]%s\n",
                  r->is_measured ? "           meas. Hz      [dB]    [deg]   of the peak" : "");
    for (int b = 0; b < r->nband; b++) {
        const struct frf_band *band = &r->band[b];
        int m = r->synthesis.nrigid + band->mode - 1;
        (void)fprintf(out, "%4d", band->mode);
        number_cell(out, 11, 2, band->model_hz);
        number_cell(out, 11, 2, band->measured_hz);
        number_cell(out, 10, 4, 100 * r->zeta[m]);
        if (r->is_measured) {
            number_cell(out, 9, 3, frf_sums_frac(&band->sums));
            number_cell(out, 10, 3, frf_sums_frac(&band->moved));
            signed_cell(out, 10, 2, frf_sums_level(&band->resonance));
            signed_cell(out, 9, 1, carg(band->resonance.cross) * 57.295779513082321);
            if (band->worst >= 0) {
                (void)fputs("   ", out);
                number_cell(out, 0, 2, r->at[b + (ptrdiff_t)band->worst * r->nband].deviation);
                (void)fprintf(out, " at %d over %d", r->row[band->worst].response, r->row[band->worst].reference);
            }
        }
        (void)fprintf(out, "%s%s\n", r->damping[m] == FRF_DAMPING_MEASURED ? "" : "   damping: ",
                      r->damping[m] == FRF_DAMPING_MEASURED ? "" : source_text(r->damping[m]));
    }
}

/* ------------------------------------------------------------------------------------------------ rows */

static void print_row(FILE *out, const struct frf_row *row)
{
    double frac = frf_sums_frac(&row->sums), scale = frf_sums_scale(&row->sums);
    (void)fprintf(out, "%8d %9d", row->response, row->reference);
    number_cell(out, 9, 3, frac);
    number_cell(out, 9, 3, frf_sums_frac(&row->moved));
    digits_cell(out, 12, 4, scale);
    signed_cell(out, 9, 2, frf_sums_level(&row->sums));
    if (scale < 0)
        (void)fprintf(out, "   opposite sign: check the direction");
    if (frf_sums_frac_conjugate(&row->sums) > frac + FLIPPED)
        (void)fprintf(out, "   FRAC %.3f with the conjugate: check the sign of time", frf_sums_frac_conjugate(&row->sums));
    (void)fprintf(out, "%s\n", row->is_reciprocal ? "   measured the other way round" : "");
}

struct ranked {
    double frac;
    int row;
};

static int by_frac(const void *left, const void *right)
{
    const struct ranked *a = left, *b = right;
    return a->frac != b->frac ? (a->frac > b->frac) - (a->frac < b->frac) : a->row - b->row;
}

static int print_worst(FILE *out, const struct frf_view *view)
{
    static const double border[] = {0.95, 0.8, 0.5, -1};
    const struct frf_result *r = view->result;
    struct ranked *rank = POOL_ARRAY(view->pool, struct ranked, r->ndone);
    int count[4] = {0}, none = 0;
    if (!rank)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < r->ndone; i++) {
        double frac = frf_sums_frac(&r->row[i].sums);
        int c = 0;
        while (c < 3 && frac < border[c])
            c++;
        *(isfinite(frac) ? &count[c] : &none) += 1;
        rank[i] = (struct ranked){isfinite(frac) ? frac : -1, i};
    }
    qsort(rank, (size_t)r->ndone, sizeof *rank, by_frac);
    for (int i = 0; i < WORST; i++)
        print_row(out, &r->row[rank[i].row]);
    (void)fprintf(out, "the %d worst of %d; FRAC from 0.95: %d, from 0.8: %d, from 0.5: %d, below: %d", WORST, r->ndone, count[0],
                  count[1], count[2], count[3]);
    if (none)
        (void)fprintf(out, ", without values: %d", none);
    (void)fprintf(out, " (--verbose: all)\n");
    return ROTID_OK;
}

static int print_rows(FILE *out, const struct frf_view *view)
{
    const struct frf_result *r = view->result;
    int status = ROTID_OK;
    if (!r->is_measured) {
        (void)fprintf(out, "\n%d transfer function%s:", r->nrow, r->nrow == 1 ? "" : "s");
        for (int i = 0; i < r->nrow && (view->verbose || i < MOST_ROWS); i++)
            (void)fprintf(out, "%s %d over %d", i ? "," : "", r->row[i].response, r->row[i].reference);
        (void)fprintf(out, "%s\n", !view->verbose && r->nrow > MOST_ROWS ? ", ..." : "");
        return ROTID_OK;
    }
    (void)fprintf(out, "\nresponse reference     FRAC  FRAC at       scale    level\n"
                       "   point     point          meas. Hz                 [dB]\n");
    if (r->ndone > MOST_ROWS && !view->verbose)
        status = print_worst(out, view);
    else
        for (int i = 0; i < r->ndone; i++)
            print_row(out, &r->row[i]);
    (void)fprintf(out, "     all          ");
    number_cell(out, 9, 3, frf_sums_frac(&r->sums));
    number_cell(out, 9, 3, frf_sums_frac(&r->moved));
    digits_cell(out, 12, 4, frf_sums_scale(&r->sums));
    signed_cell(out, 9, 2, frf_sums_level(&r->sums));
    (void)fprintf(
        out, "\nFRAC at meas. Hz: with the measured frequencies in place of the model's; what is below 1 there is shape, mass or "
             "damping\n");
    return status;
}

/* ------------------------------------------------------------------------------------------------ the first function */

/* " line [Hz]   modulus   phase [deg]" */
static void print_peak(FILE *out, double hz, double complex at)
{
    number_cell(out, 11, 2, hz);
    power_cell(out, 14, 4, cabs(at));
    number_cell(out, 14, 1, carg(at) * 57.295779513082321);
}

static int print_first(FILE *out, const struct frf_view *view)
{
    const struct frf_result *r = view->result;
    double complex *h = POOL_ARRAY(view->pool, double complex, r->nline),
                   *work = POOL_ARRAY(view->pool, double complex, r->nline),
                   *measured = r->is_measured ? POOL_ARRAY(view->pool, double complex, r->nline) : NULL;
    if (!h || !work || (r->is_measured && !measured))
        return ROTID_ERROR_MEMORY;
    frf_synthesised(r, 0, 1, h, work);
    if (measured)
        frf_measured_curve(r, view->set, 0, measured);
    (void)fprintf(out, "\n%d over %d: %s [%s], * synthesised%s\n", r->row[0].response, r->row[0].reference,
                  transfer_quantity_words[r->quantity], transfer_unit_words[r->quantity], measured ? ", o measured, @ both" : "");
    frf_plot(out, COLUMNS, r->nline, r->frequency_hz, h, measured);
    if (!r->nband)
        return ROTID_OK;
    (void)fprintf(out, "at the resonances\nmode  line [Hz]   synthesised   phase [deg]%s\n",
                  measured ? "  line [Hz]      measured   phase [deg]" : "");
    for (int b = 0; b < r->nband; b++) {
        const struct frf_band *band = &r->band[b];
        double complex at = h[band->at_model];
        (void)fprintf(out, "%4d", band->mode);
        print_peak(out, r->frequency_hz[band->at_model], at);
        if (measured)
            print_peak(out, r->frequency_hz[band->at_measured], measured[band->at_measured]);
        (void)fputc('\n', out);
    }
    return ROTID_OK;
}

int table_frf(FILE *out, const struct frf_view *view)
{
    print_model(out, view);
    print_modes(out, view);
    int status = print_rows(out, view);
    return status || !view->result->ndone ? status : print_first(out, view);
}
