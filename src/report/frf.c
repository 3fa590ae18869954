/* Synthesised transfer functions: the struct of their JSON, their universal file, and what `rotid frf` shows. */
#include "report/report.h"

#define DEGREES 57.295779513082321

static struct transfer_agreement agreement(const struct frf_sums *sums, const struct frf_sums *moved)
{
    return (struct transfer_agreement){frf_sums_frac(sums), frf_sums_frac(moved), frf_sums_frac_conjugate(sums),
                                       frf_sums_scale(sums), frf_sums_level(sums)};
}

/* Nonzero: memory is out; of all below. */
static int add_modes(struct pool *pool, const struct frf_result *r, struct transfer_result *out)
{
    const struct synthesis *s = &r->synthesis;
    struct transfer_mode_agreement *agrees = POOL_ARRAY(pool, struct transfer_mode_agreement, r->nband);
    out->modes = POOL_ARRAY(pool, struct transfer_mode, s->nmode);
    if (!out->modes || !agrees)
        return 1;
    for (int m = 0; m < s->nmode; m++)
        out->modes[m] = (struct transfer_mode){.rigid = m < s->nrigid,
                                               .mode = m < s->nrigid ? ROTID_NONE : m - s->nrigid + 1,
                                               .model_hz = sqrt(fmax(s->lambda[m], 0)) / TWO_PI,
                                               .measured_hz = NAN,
                                               .damping = r->zeta[m],
                                               .damping_from = transfer_damping_words[r->damping[m]]};
    out->nmodes = s->nmode;
    for (int b = 0; b < r->nband; b++) {
        const struct frf_band *band = &r->band[b];
        struct transfer_mode *mode = &out->modes[s->nrigid + band->mode - 1];
        mode->measured_hz = band->measured_hz;
        agrees[b] = (struct transfer_mode_agreement){
            .frac = frf_sums_frac(&band->sums),
            .frac_at_measured_frequencies = frf_sums_frac(&band->moved),
            .level_db = frf_sums_level(&band->resonance),
            .phase_deg = carg(band->resonance.cross) * DEGREES,
            .worst_function = band->worst >= 0 ? band->worst : ROTID_NONE,
        };
        mode->agreement = r->is_measured ? &agrees[b] : NULL;
    }
    return 0;
}

static struct transfer_beside *beside_measured(struct pool *pool, const struct frf_result *r, int i)
{
    const struct frf_row *row = &r->row[i];
    struct transfer_beside *beside = POOL_NEW(pool, struct transfer_beside);
    if (!beside)
        return NULL;
    *beside = (struct transfer_beside){.agreement = agreement(&row->sums, &row->moved),
                                       .measured_reversed = row->sign < 0,
                                       .measured_reciprocal = row->is_reciprocal,
                                       .nat_modes = r->nband,
                                       .at_modes = r->at + (ptrdiff_t)i * r->nband};
    return beside;
}

static void split(int n, const double complex *h, double *re, double *im)
{
    for (int l = 0; l < n; l++) {
        re[l] = creal(h[l]);
        im[l] = cimag(h[l]);
    }
}

int complex_parts(struct pool *pool, int n, const double complex *h, const double **re, const double **im)
{
    double *real = POOL_ARRAY(pool, double, n), *imag = POOL_ARRAY(pool, double, n);
    *re = real;
    *im = imag;
    if (!real || !imag)
        return 1;
    split(n, h, real, imag);
    return 0;
}

static int add_functions(const struct frf_view *view, struct transfer_result *out)
{
    struct pool *pool = view->pool;
    const struct frf_result *r = view->result;
    double complex *h = POOL_ARRAY(pool, double complex, r->nline), *work = POOL_ARRAY(pool, double complex, r->nline);
    out->functions = POOL_ARRAY(pool, struct transfer_function, r->ndone);
    if (!h || !work || !out->functions)
        return 1;
    for (; out->nfunctions < r->ndone; out->nfunctions++) {
        const struct frf_row *row = &r->row[out->nfunctions];
        struct transfer_function *f = &out->functions[out->nfunctions];
        *f = (struct transfer_function){.response = row->response,
                                        .reference = row->reference,
                                        .response_z_m = row->response_z,
                                        .reference_z_m = row->reference_z};
        if (r->is_measured && !(f->beside = beside_measured(pool, r, out->nfunctions)))
            return 1;
        if (!out->with_curves)
            continue;
        f->nfrequency_hz = r->nline;
        f->frequency_hz = r->frequency_hz;
        frf_synthesised(r, out->nfunctions, h, work);
        if (complex_parts(pool, r->nline, h, &f->synthesised_re, &f->synthesised_im))
            return 1;
        if (!r->is_measured)
            continue;
        frf_measured_curve(r, view->set, out->nfunctions, h);
        if (complex_parts(pool, r->nline, h, &f->measured_re, &f->measured_im))
            return 1;
    }
    return 0;
}

const struct transfer_result *frf_result_of(const struct frf_view *view)
{
    const struct frf_result *r = view->result;
    struct transfer_agreement *all = POOL_NEW(view->pool, struct transfer_agreement);
    struct transfer_result *out = POOL_NEW(view->pool, struct transfer_result);
    if (!all || !out)
        return NULL;
    *all = agreement(&r->sums, &r->moved);
    *out = (struct transfer_result){
        .complete = r->ndone == r->nrow,
        .quantity = transfer_quantity_words[r->quantity],
        .unit = transfer_unit_words[r->quantity],
        .lines = r->nline,
        .low_hz = r->frequency_hz[0],
        .high_hz = r->frequency_hz[r->nline - 1],
        .modes_up_to_hz = r->up_to_hz,
        .window_decay = r->decay,
        .measured_file = r->is_measured ? view->job->options.frf.file : NULL,
        .agreement = r->is_measured ? all : NULL,
        .left_out = r->is_measured ? r->nleft_out : ROTID_NONE,
        .with_curves = (double)r->nline * r->ndone <= JSON_FRF_MOST_LINES,
    };
    int n = view->identified ? view->identified->fit->n : 0;
    out->nparameters = POOL_LIST(view->pool, out->parameters, n);
    for (int p = 0; p < out->nparameters; p++)
        out->parameters[p] = (struct transfer_parameter){view->job->unknowns.bounds[p].name, view->job->unknowns.bounds[p].unit,
                                                         view->identified->fit->x[p]};
    int failed = !out->parameters || add_modes(view->pool, r, out) || add_functions(view, out);
    return failed ? NULL : out;
}

/* ---- sets 58 */

ORDER_BY(by_id, struct uff_node, it->id, 0)

static int write_nodes(FILE *stream, const struct frf_view *view)
{
    const struct frf_result *r = view->result;
    struct uff_node *node = POOL_ARRAY(view->pool, struct uff_node, 2 * (size_t)r->ndone);
    int axis = view->job->options.frf.axis, count = 0;
    if (!node)
        return ROTID_ERROR_MEMORY;
    for (int i = 0; i < 2 * r->ndone; i++) {
        const struct frf_row *row = &r->row[i / 2];
        node[i].id = i % 2 ? row->reference : row->response;
        node[i].color = 1;
        node[i].x[axis] = i % 2 ? row->reference_z : row->response_z;
    }
    qsort(node, 2 * (size_t)r->ndone, sizeof *node, by_id);
    for (int i = 0; i < 2 * r->ndone; i++)
        if (!count || node[i].id != node[count - 1].id)
            node[count++] = node[i];
    return uff_write_nodes(stream, 2411, count, node);
}

/* The direction of the measurement without its sign, which the synthesised function does not have; else the first lateral axis.
 */
static int direction_of(const struct frf_view *view, const struct frf_row *row)
{
    int measured = row->measured ? abs(row->measured->response_direction) : 0;
    return measured ? measured : view->job->options.frf.axis == 0 ? 2 : 1;
}

/* re, im, h, work: [lines] workspace */
static int write_function(FILE *stream, const struct frf_view *view, int i, double *re, double *im, double complex *h,
                          double complex *work)
{
    static const int specific[] = {8, 11, 12};
    static const char *const labels[] = {"Displacement", "Velocity", "Acceleration"}, *const units[] = {"m", "m/s", "m/s2"};
    const struct frf_result *r = view->result;
    const struct frf_row *row = &r->row[i];
    struct uff_function_writer writer;
    struct uff_function f = {.type = UFF_TRANSFER,
                             .number = i + 1,
                             .response_node = row->response,
                             .reference_node = row->reference,
                             .ordinate = UFF_COMPLEX_DOUBLE,
                             .count = r->nline,
                             .start = r->frequency_hz[0],
                             .abscissa = {.specific_type = 18, .label = "Frequency", .unit = "Hz"},
                             .numerator = {.specific_type = specific[r->quantity], .length = 1},
                             .denominator = {.specific_type = 13, .force = 1, .label = "Excitation force", .unit = "N"}};
    f.response_direction = f.reference_direction = direction_of(view, row);
    f.step = r->nline > 1 ? (r->frequency_hz[r->nline - 1] - f.start) / (r->nline - 1) : 1;
    f.is_even = 1; /* lines of a measured file and of LOW, HIGH are */
    (void)snprintf(f.id[0], sizeof f.id[0], "synthesised %s %d over %d", transfer_quantity_words[r->quantity], row->response,
                   row->reference);
    (void)snprintf(f.numerator.label, sizeof f.numerator.label, "%s", labels[r->quantity]);
    (void)snprintf(f.numerator.unit, sizeof f.numerator.unit, "%s", units[r->quantity]);
    frf_synthesised(r, i, h, work);
    split(r->nline, h, re, im);
    int status = uff_write_function(stream, &f, &writer);
    if (!status)
        status = uff_write_values(&writer, r->nline, NULL, re, im);
    return status ? status : uff_end_function(&writer);
}

int frf_write_file(FILE *stream, const char *version, const struct frf_view *view)
{
    static const struct uff_units si = {1, "SI", 2, 1, 1, 1, 273.15};
    const struct frf_result *r = view->result;
    struct uff_header header = {0};
    double complex *h = POOL_ARRAY(view->pool, double complex, r->nline),
                   *work = POOL_ARRAY(view->pool, double complex, r->nline);
    double *re = POOL_ARRAY(view->pool, double, r->nline), *im = POOL_ARRAY(view->pool, double, r->nline);
    if (!h || !work || !re || !im)
        return ROTID_ERROR_MEMORY;
    (void)snprintf(header.model, sizeof header.model, "rotid frf");
    (void)snprintf(header.program, sizeof header.program, "rotid %s", version);
    int status = uff_write_header(stream, &header);
    if (!status)
        status = uff_write_units(stream, &si);
    if (!status)
        status = write_nodes(stream, view);
    for (int i = 0; i < r->ndone && !status; i++)
        status = write_function(stream, view, i, re, im, h, work);
    return status;
}

/* ---- the screen and its tables */

/* ---- Bode plot in plain ASCII */

#define COLUMNS      88
#define HEIGHT       16 /* rows of the magnitude */
#define PHASE_HEIGHT 9  /* -180 to 180 in steps of 45 degrees */
#define DECADES      5  /* at most: what lies deeper says nothing */
#define MARGIN       11

/* height: 0 at the bottom, 1 at the top */
static void put(char (*cell)[COLUMNS], int rows, int column, double height, char mark)
{
    if (!isfinite(height) || height < -0.5 / (rows - 1))
        return;
    char *at = &cell[lround((1 - fmin(fmax(height, 0), 1)) * (rows - 1))][column];
    *at = *at == ' ' || *at == mark ? mark : '@';
}

static void print_row(FILE *out, const char *row, const char *label)
{
    int last = COLUMNS;
    while (last > 0 && row[last - 1] == ' ')
        last--;
    (void)fprintf(out, "%*s |%.*s\n", MARGIN - 2, label, last, row);
}

/* The line of each column that is drawn: the one of largest magnitude, or the nearest where a column has none. */
static void choose(int nline, const double *hz, const double complex *h, int *line)
{
    double from = hz[0], span = hz[nline - 1] - from;
    int near = 0;
    for (int c = 0; c < COLUMNS; c++)
        line[c] = -1;
    for (int l = 0; l < nline; l++) {
        int c = span > 0 ? (int)((hz[l] - from) / span * (COLUMNS - 1) + 0.5) : 0;
        if (isfinite(cabs(h[l])) && (line[c] < 0 || cabs(h[l]) > cabs(h[line[c]])))
            line[c] = l;
    }
    for (int c = 0; c < COLUMNS; c++) {
        double at = from + span * c / (COLUMNS - 1);
        while (near + 1 < nline && fabs(hz[near + 1] - at) <= fabs(hz[near] - at))
            near++;
        if (line[c] < 0)
            line[c] = near;
    }
}

static void frame(FILE *out, double from, double to)
{
    (void)fprintf(out, "%*s +", MARGIN - 2, "");
    for (int c = 0; c < COLUMNS; c++)
        (void)fputc(c % 10 ? '-' : '+', out);
    (void)fprintf(out, "\n%*s", MARGIN, "");
    for (int c = 0; c + 10 <= COLUMNS; c += 20)
        (void)fprintf(out, "%-*.5g", c + 30 <= COLUMNS ? 20 : 8, from + (to - from) * c / (COLUMNS - 1));
    (void)fputs("Hz\n", out);
}

/* Log magnitude over frequency, and phase below: '*' synthesised, 'o' measured (NULL where there is none), '@' both. Of the lines
 * that share a column the largest magnitude is drawn. */
static void frf_plot(FILE *out, int nline, const double *hz, const double complex *synthesised, const double complex *measured)
{
    const double complex *curve[2] = {synthesised, measured};
    char magnitude[HEIGHT][COLUMNS], phase[PHASE_HEIGHT][COLUMNS], label[32];
    double top = 0, bottom = INFINITY;
    int line[2][COLUMNS] = {{0}};
    memset(magnitude, ' ', sizeof magnitude);
    memset(phase, ' ', sizeof phase);
    for (int i = 0; i < 2 && curve[i]; i++) {
        choose(nline, hz, curve[i], line[i]);
        for (int c = 0; c < COLUMNS; c++) {
            double size = cabs(curve[i][line[i][c]]);
            top = isfinite(size) ? fmax(top, size) : top;
            bottom = size > 0 ? fmin(bottom, size) : bottom;
        }
    }
    if (!(top > 0))
        return;
    double high = log10(top), low = fmax(fmin(log10(bottom), high - 1), high - DECADES);
    for (int i = 0; i < 2 && curve[i]; i++)
        for (int c = 0; c < COLUMNS; c++) {
            double complex h = curve[i][line[i][c]];
            put(magnitude, HEIGHT, c, (log10(cabs(h)) - low) / (high - low), "*o"[i]);
            put(phase, PHASE_HEIGHT, c, 0.5 + carg(h) / (2 * PI), "*o"[i]);
        }
    for (int r = 0; r < HEIGHT; r++) {
        (void)snprintf(label, sizeof label, "%.1e", pow(10, high - (high - low) * r / (HEIGHT - 1)));
        print_row(out, magnitude[r], r % 5 ? "" : label);
    }
    frame(out, hz[0], hz[nline - 1]);
    for (int r = 0; r < PHASE_HEIGHT; r++) {
        (void)snprintf(label, sizeof label, "%d deg", 180 - 45 * r);
        print_row(out, phase[r], r % 2 ? "" : label);
    }
    frame(out, hz[0], hz[nline - 1]);
}

#define MOST_ROWS 40 /* beyond it the worst ones and a count */
#define WORST     10
#define FLIPPED   0.05 /* gain of FRAC with the conjugate that is no accident */

/* ---- tables */

static const char *words(struct pool *pool, const char *text)
{
    char *copy = pool_copy_text(pool, text);
    for (char *c = copy; c && *c; c++)
        *c = *c == '_' ? ' ' : *c;
    return copy;
}

struct table *table_of_transfer_modes(struct pool *pool, const struct transfer_result *of)
{
    struct table *table = table_open(pool, "Modes within the lines");
    for (int m = 0; m < of->nmodes; m++) {
        const struct transfer_mode *mode = &of->modes[m];
        const struct transfer_mode_agreement *agrees = mode->agreement;
        const struct transfer_function *f =
            agrees && agrees->worst_function != ROTID_NONE ? &of->functions[agrees->worst_function] : NULL;
        double worst = NAN;
        if (!(mode->model_hz <= of->high_hz))
            continue;
        for (int k = 0; f && f->beside && k < f->beside->nat_modes; k++)
            if (f->beside->at_modes[k].mode == mode->mode)
                worst = f->beside->at_modes[k].deviation;
        text_column(table, "mode", SHOW_TEXT, mode->rigid ? "rigid" : pool_text(pool, "%d", mode->mode));
        number_column(table, "model", "Hz", SHOW_FIXED(3), mode->model_hz);
        number_column(table, "measured", "Hz", SHOW_FIXED(3), mode->measured_hz);
        number_column(table, "damping", "%", SHOW_DIGITS(4), 100 * mode->damping);
        text_column(table, "damping from", SHOW_TEXT, words(pool, mode->damping_from));
        number_column(table, "FRAC", NULL, SHOW_FIXED(3), agrees ? agrees->frac : (double)NAN);
        number_column(table, "at meas. Hz", NULL, SHOW_FIXED(3), agrees ? agrees->frac_at_measured_frequencies : (double)NAN);
        number_column(table, "level", "dB", SHOW_SIGNED(2), agrees ? agrees->level_db : (double)NAN);
        number_column(table, "phase", "deg", SHOW_SIGNED(1), agrees ? agrees->phase_deg : (double)NAN);
        number_column(table, "deviation", NULL, SHOW_FIXED(2), worst);
        text_column(table, "at", SHOW_TEXT, f ? pool_text(pool, "%d over %d", f->response, f->reference) : "");
    }
    return table;
}

static void function_row(struct table *table, const struct transfer_function *f, const struct transfer_agreement *agrees)
{
    struct pool *pool = table ? table->pool : NULL;
    double gain = agrees->frac_of_conjugate;
    text_column(table, "response", SHOW_TEXT, f ? pool_text(pool, "%d", f->response) : "all");
    text_column(table, "reference", SHOW_TEXT, f ? pool_text(pool, "%d", f->reference) : "");
    number_column(table, "FRAC", NULL, SHOW_FIXED(3), agrees->frac);
    number_column(table, "at meas. Hz", NULL, SHOW_FIXED(3), agrees->frac_at_measured_frequencies);
    number_column(table, "scale", NULL, SHOW_DIGITS(4), agrees->scale);
    number_column(table, "level", "dB", SHOW_SIGNED(2), agrees->level_db);
    text_column(table, "remark", SHOW_TEXT,
                !f                               ? ""
                : agrees->scale < 0              ? "opposite sign: check the direction"
                : gain > agrees->frac + FLIPPED  ? pool_text(pool, "FRAC %.3f with the conjugate: check the sign of time", gain)
                : f->beside->measured_reciprocal ? "measured the other way round"
                                                 : "");
}

struct ranked {
    double frac;
    int row;
};

ORDER_BY(by_frac, struct ranked, it->frac, it->row)

/* All functions, or the worst of many. */
static struct table *table_of_functions(struct pool *pool, const struct transfer_result *of, int all)
{
    static const double border[] = {0.95, 0.8, 0.5, -1};
    struct table *table =
        table_open(pool, "Transfer functions; at meas. Hz: with the measured frequencies in place of the model's; "
                         "what is below 1 there is shape, mass or damping");
    struct ranked *rank = POOL_ARRAY(pool, struct ranked, of->nfunctions);
    int count[4] = {0}, none = 0, many = of->nfunctions > MOST_ROWS && !all;
    for (int i = 0; i < of->nfunctions && rank; i++) {
        double frac = of->functions[i].beside->agreement.frac;
        int c = 0;
        while (c < 3 && frac < border[c])
            c++;
        *(isfinite(frac) ? &count[c] : &none) += 1;
        rank[i] = (struct ranked){isfinite(frac) ? frac : -1, i};
    }
    if (many && rank)
        qsort(rank, (size_t)of->nfunctions, sizeof *rank, by_frac);
    for (int i = 0; i < (many ? WORST : of->nfunctions) && rank; i++)
        function_row(table, &of->functions[rank[i].row], &of->functions[rank[i].row].beside->agreement);
    function_row(table, NULL, of->agreement);
    if (many)
        table_note(table,
                   "The %d worst of %d; FRAC from 0.95: %d, from 0.8: %d, from 0.5: %d, below: %d, without values: "
                   "%d (--verbose: all).",
                   WORST, of->nfunctions, count[0], count[1], count[2], count[3], none);
    return table;
}

/* h: the first function, measured NULL where there is none */
static struct table *table_of_resonances(struct pool *pool, const struct frf_result *r, const double complex *h,
                                         const double complex *measured)
{
    struct table *table = table_open(pool, "At the resonances");
    for (int b = 0; b < r->nband; b++) {
        const struct frf_band *band = &r->band[b];
        double complex at = h[band->at_model], beside = measured ? measured[band->at_measured] : NAN;
        number_column(table, "mode", NULL, SHOW_COUNT, band->mode);
        number_column(table, "line", "Hz", SHOW_FIXED(2), r->frequency_hz[band->at_model]);
        number_column(table, "synthesised", NULL, SHOW_DIGITS(5), cabs(at));
        number_column(table, "phase", "deg", SHOW_FIXED(1), carg(at) * DEGREES);
        number_column(table, "line", "Hz", SHOW_FIXED(2), measured ? r->frequency_hz[band->at_measured] : (double)NAN);
        number_column(table, "measured", NULL, SHOW_DIGITS(5), cabs(beside));
        number_column(table, "phase", "deg", SHOW_FIXED(1), measured ? carg(beside) * DEGREES : (double)NAN);
    }
    return table;
}

struct reasons sentences_of_transfer(struct pool *pool, const struct transfer_result *of)
{
    struct reasons said = {.pool = pool};
    const char *at = "";
    int rigid = 0;
    for (int m = 0; m < of->nmodes; m++)
        rigid += of->modes[m].rigid;
    for (int p = 0; p < of->nparameters; p++)
        at = pool_text(pool, "%s%s%s = %s", at, p ? ", " : ": ", of->parameters[p].name,
                       human_value(pool, of->parameters[p].value, of->parameters[p].unit));
    reasons_say(&said, "%d synthesised %s, %s over force [%s], %d lines from %s; %s%s.", of->nfunctions,
                human_plural(of->nfunctions, "function", "functions"), of->quantity, of->unit, of->lines,
                human_range(pool, of->low_hz, of->high_hz, "Hz"), of->measured_file ? "measured ones from " : "none was measured",
                or_nothing(of->measured_file));
    reasons_say(&said, "The model is %s%s.", *at ? "the identified one" : "as the deck states it", at);
    reasons_say(
        &said,
        "Summed are %d %s on the supports or free and %d elastic ones, all up to %s, with the damping below; the rest by its "
        "flexibility.",
        rigid, human_plural(rigid, "mode", "modes"), of->nmodes - rigid, human_value(pool, of->modes_up_to_hz, "Hz"));
    if (of->window_decay > 0)
        reasons_say(&said, "The measurement has an exponential window of %s 1/s, and so has the synthesis.",
                    human_trimmed(pool, of->window_decay, 5));
    if (of->agreement && isfinite(of->agreement->frac))
        reasons_say(&said, "FRAC over all functions is %s, and %s with the measured frequencies put in for the model's.",
                    human_fixed(pool, of->agreement->frac, 3), human_fixed(pool, of->agreement->frac_at_measured_frequencies, 3));
    if (!of->complete)
        reasons_say(&said, "It was interrupted: %d %s finished.", of->nfunctions,
                    human_plural(of->nfunctions, "function was", "functions were"));
    return said;
}

/* ---- screen */

static void print_functions(const struct screen *to, const struct frf_view *view, const struct transfer_result *of)
{
    const struct frf_result *r = view->result;
    if (of->agreement) {
        screen_table(to, table_of_functions(to->pool, of, to->verbose));
        return;
    }
    (void)fprintf(to->out, "\n%d transfer %s:", r->nrow, human_plural(r->nrow, "function", "functions"));
    for (int i = 0; i < r->nrow && (to->verbose || i < MOST_ROWS); i++)
        (void)fprintf(to->out, "%s %d over %d", i ? "," : "", r->row[i].response, r->row[i].reference);
    (void)fprintf(to->out, "%s\n", !to->verbose && r->nrow > MOST_ROWS ? ", ..." : "");
}

static void print_first(const struct screen *to, const struct frf_view *view)
{
    const struct frf_result *r = view->result;
    double complex *h = POOL_ARRAY(to->pool, double complex, r->nline), *work = POOL_ARRAY(to->pool, double complex, r->nline),
                   *measured = r->is_measured ? POOL_ARRAY(to->pool, double complex, r->nline) : NULL;
    if (!h || !work || (r->is_measured && !measured))
        return;
    frf_synthesised(r, 0, h, work);
    if (measured)
        frf_measured_curve(r, view->set, 0, measured);
    (void)fprintf(to->out, "\n%d over %d: %s [%s], * synthesised%s\n", r->row[0].response, r->row[0].reference,
                  transfer_quantity_words[r->quantity], transfer_unit_words[r->quantity], measured ? ", o measured, @ both" : "");
    frf_plot(to->out, r->nline, r->frequency_hz, h, measured);
    screen_table(to, table_of_resonances(to->pool, r, h, measured));
}

void screen_frf(const struct screen *to, const struct frf_view *view, const struct transfer_result *of)
{
    const struct reasons said = sentences_of_transfer(to->pool, of);
    screen_reasons(to, &said);
    screen_table(to, table_of_transfer_modes(to->pool, of));
    print_functions(to, view, of);
    if (view->result->ndone)
        print_first(to, view);
}
