/* Modes of a test: the struct of their JSON, and what `rotid ema` shows. */
#include "report/report.h"

static struct ema_source source(const struct ema_report *r)
{
    const struct measurement *m = r->measurement;
    struct ema_source out = {
        .file = r->file,
        .quantity = (int)m->set.quantity,
        .transfer_functions = m->set.nfrf,
        .lines = m->set.nline,
        .low_hz = m->set.nline ? m->set.frequency_hz[0] : NAN,
        .high_hz = m->set.nline ? m->set.frequency_hz[m->set.nline - 1] : NAN,
        .from_time_records = m->from_records,
        .impacts = m->transfer.nimpact,
        .window_decay_per_s = m->set.window_decay,
    };
    for (int i = 0; i < m->transfer.nimpact; i++)
        out.impacts_used += m->transfer.impact[i].used;
    return out;
}

/* NULL: memory is out; of all below. */
static struct ema_shape_point *shape(struct pool *pool, const struct ema *ema, const struct ema_mode *m)
{
    struct ema_shape_point *list = POOL_ARRAY(pool, struct ema_shape_point, ema->npoint);
    struct ema_point_frequency *alone = POOL_ARRAY(pool, struct ema_point_frequency, ema->npoint);
    for (int p = 0; p < ema->npoint && list && alone; p++) {
        list[p] = (struct ema_shape_point){.node = ema->point_node[p],
                                           .direction = ema->point_direction[p],
                                           .value = m->shape[p],
                                           .std = m->shape_std[p],
                                           .complex_re = creal(m->complex_shape[p]),
                                           .complex_im = cimag(m->complex_shape[p])};
        if (m->point_frequency_hz) {
            alone[p] = (struct ema_point_frequency){m->point_frequency_hz[p], m->point_frequency_std[p]};
            list[p].alone = &alone[p];
        }
    }
    return alone ? list : NULL;
}

static struct ema_mode_result *modes(struct pool *pool, const struct ema *ema)
{
    struct ema_mode_result *list = POOL_ARRAY(pool, struct ema_mode_result, ema->nmode);
    for (int k = 0; k < ema->nmode && list; k++) {
        list[k] = (struct ema_mode_result){k + 1, ema->mode[k], ema->npoint, shape(pool, ema, &ema->mode[k])};
        if (!list[k].shape)
            return NULL;
    }
    return list;
}

#define MOST_LINES   10000 /* of all curves together: more makes a file of megabytes */
#define LEAST_CURVES 3     /* the worst, the middle and the best one */

/* Transfer functions by rising FRAC, without those that have none; their number. By insertion: a test has hundreds. */
static int by_frac(const struct ema_result *ema, int *order)
{
    int count = 0;
    for (int c = 0; c < ema->nchannels; c++) {
        int k = count;
        if (!isfinite(ema->channels[c].fit))
            continue;
        for (; k > 0 && ema->channels[order[k - 1]].fit > ema->channels[c].fit; k--)
            order[k] = order[k - 1];
        order[k] = c;
        count++;
    }
    return count;
}

/* 0 where memory is out. */
static int add_curve(struct pool *pool, const struct ema_report *r, int c, double complex *h, struct ema_curve *curve)
{
    const struct frf_set *set = &r->measurement->set;
    int n = set->nline;
    ema_synthesise(r->ema, set, c, n, set->frequency_hz, h);
    *curve = (struct ema_curve){.channel = c + 1, .nfrequency_hz = n, .frequency_hz = set->frequency_hz};
    return !complex_parts(pool, n, set->frf[c].h, &curve->measured_re, &curve->measured_im) &&
           !complex_parts(pool, n, h, &curve->synthesised_re, &curve->synthesised_im);
}

/* Of `count` functions in this order. 0 where memory is out. */
static int add_rms(struct pool *pool, const struct ema_report *r, int count, const int *order, double complex *h,
                   struct ema_result *out)
{
    const struct frf_set *set = &r->measurement->set;
    int n = set->nline;
    double *measured = POOL_ARRAY(pool, double, n), *synthesised = POOL_ARRAY(pool, double, n);
    if (!measured || !synthesised)
        return 0;
    for (int i = 0; i < count; i++) {
        ema_synthesise(r->ema, set, order[i], n, set->frequency_hz, h);
        for (int l = 0; l < n; l++) {
            measured[l] += creal(set->frf[order[i]].h[l] * conj(set->frf[order[i]].h[l])) / count;
            synthesised[l] += creal(h[l] * conj(h[l])) / count;
        }
    }
    for (int l = 0; l < n; l++) {
        measured[l] = sqrt(measured[l]);
        synthesised[l] = sqrt(synthesised[l]);
    }
    out->nrms_frequency_hz = count ? n : 0;
    out->rms_frequency_hz = set->frequency_hz;
    out->rms_measured = measured;
    out->rms_synthesised = synthesised;
    return 1;
}

/* What was measured beside what the modes make of it. 0 where memory is out. */
static int add_functions(struct pool *pool, const struct ema_report *r, struct ema_result *out)
{
    int lines = r->measurement->set.nline, *order = POOL_ARRAY(pool, int, r->ema->nfrf);
    double complex *h = POOL_ARRAY(pool, double complex, lines);
    if (!order || !h)
        return 0;
    int count = by_frac(out, order), taken = lines ? MOST_LINES / lines : 0;
    taken = taken < LEAST_CURVES ? LEAST_CURVES : taken;
    taken = taken > count ? count : taken;
    out->curves = POOL_ARRAY(pool, struct ema_curve, taken);
    for (int i = 0; i < taken && out->curves; i++, out->ncurves++)
        if (!add_curve(pool, r, order[taken > 1 ? (long long)i * (count - 1) / (taken - 1) : 0], h, &out->curves[i]))
            return 0;
    return out->curves && add_rms(pool, r, count, order, h, out);
}

const struct ema_result *ema_result_of(struct pool *pool, const struct ema_report *r, int functions)
{
    struct ema_result *out = POOL_NEW(pool, struct ema_result);
    if (!out)
        return NULL;
    *out = (struct ema_result){
        .source = source(r),
        .method = r->options->method,
        .order = r->ema->order,
        .refined = r->ema->refined > 0,
        .std_from = !r->ema->std_from_impacts, /* variance, residual */
        .output = r->output,
        .nmodes = r->ema->nmode,
        .modes = modes(pool, r->ema),
        .mac = r->ema->mac,
        .nstabilisation = r->ema->npole,
        .stabilisation = r->ema->pole,
        .nchannels = r->ema->nfrf,
        .channels = r->ema->channel,
        .seconds = r->seconds,
    };
    return out->modes && (!functions || add_functions(pool, r, out)) ? out : NULL;
}

/* ---- the screen and its tables */

#define COLUMNS     96 /* of the stabilisation picture */
#define LISTED_ROWS 16
#define MOST_MAC    20
#define WORST       5

static void print_source(const struct screen *to, const struct ema_report *r, const struct ema_result *ema)
{
    static const char *const quantity[] = {"receptance", "mobility", "accelerance"};
    const struct measurement *m = r->measurement;
    FILE *out = to->out;
    (void)fprintf(out, "\n%s: %d transfer %s (%s), %d points, %d lines from %.6g to %.6g Hz\n", ema->source.file, ema->nchannels,
                  human_plural(ema->nchannels, "function", "functions"), quantity[m->set.quantity], r->ema->npoint, m->set.nline,
                  ema->source.low_hz, ema->source.high_hz);
    if (m->from_records) {
        int twice = 0, cut = 0, clipped = 0;
        for (int i = 0; i < m->transfer.nimpact; i++) {
            twice += m->transfer.impact[i].is_double;
            cut += m->transfer.impact[i].is_cut;
            clipped += m->transfer.impact[i].is_clipped;
        }
        (void)fprintf(out, "from %d time records at %.6g Hz: %d impacts, %d used (%d double, %d cut off, %d clipped)\n",
                      m->record_count, m->rate, ema->source.impacts, ema->source.impacts_used, twice, cut, clipped);
        if (m->set.window_decay > 0)
            (void)fprintf(out, "exponential window: its decay of %.4g 1/s is taken off every pole\n", m->set.window_decay);
    }
    if (r->options->method == EMA_LSCF)
        (void)fprintf(out, "least-squares complex frequency to order %d%s; standard deviations from %s\n", ema->order,
                      ema->refined ? ", poles refined together" : "",
                      r->ema->std_from_impacts ? "the scatter of the impacts" : "what the modes leave over");
    else
        (void)fprintf(out, "quadrature picking, damping from the half-power points\n");
}

struct table *table_of_test_modes(struct pool *pool, const struct ema_result *ema)
{
    struct table *table = table_open(pool, "Modes, with standard deviations");
    for (int k = 0; k < ema->nmodes; k++) {
        const struct ema_mode_result *m = &ema->modes[k];
        number_column(table, "mode", NULL, SHOW_COUNT, m->mode);
        number_column(table, "frequency", "Hz", SHOW_DIGITS(8), m->is.frequency_hz);
        number_column(table, "std", "Hz", SHOW_DIGITS(2), m->is.frequency_std);
        number_column(table, "damping", "%", SHOW_DIGITS(4), 100 * m->is.damping);
        number_column(table, "std", "%", SHOW_DIGITS(2), 100 * m->is.damping_std);
        number_column(table, "MPC", NULL, SHOW_FIXED(3), m->is.mpc);
        number_column(table, "MPD", "deg", SHOW_FIXED(1), m->is.mpd);
        number_column(table, "peak/noise", NULL, SHOW_DIGITS(3), m->is.peak_signal_to_noise);
        number_column(table, "modal mass", "kg", SHOW_DIGITS(4), m->is.modal_mass);
        text_column(table, "remark", SHOW_TEXT, m->is.quality_flags ? "doubtful" : "");
    }
    return table;
}

static const char *doubts_in_words(struct pool *pool, int doubts, const char *const words[])
{
    const char *text = "";
    for (int b = 0; words[b]; b++)
        if (doubts >> b & 1)
            text = pool_text(pool, "%s%s%s", text, *text ? "; " : "", words[b]);
    return text;
}

const char **ema_doubts(struct pool *pool, const struct ema_result *ema, int *count)
{
    static const char *const said[] = {
        "no signal",     "duplicate", "noise", "residual above noise", "values not finite, left out",
        "low coherence", NULL}; /* ema_channel_doubts */
    const char **text = POOL_ARRAY(pool, const char *, ema->nmodes + ema->nchannels + 1);
    *count = 0;
    for (int k = 0; k < ema->nmodes && text; k++) {
        const struct ema_mode_result *m = &ema->modes[k];
        int close = m->is.quality_flags & EMA_CLOSE && isfinite(m->is.nearest_hz);
        if (m->is.quality_flags)
            text[(*count)++] = pool_text(pool, "mode %d, %.6g Hz: %s%s", m->mode, m->is.frequency_hz,
                                         doubts_in_words(pool, m->is.quality_flags, ema_mode_doubts),
                                         close ? pool_text(pool, " (the nearest at %.6g Hz)", m->is.nearest_hz) : "");
    }
    for (int c = 0; c < ema->nchannels && text; c++) {
        const struct ema_channel *of = &ema->channels[c];
        if (of->quality_flags)
            text[(*count)++] =
                pool_text(pool, "%s at node %d over node %d (FRAC %s)", doubts_in_words(pool, of->quality_flags, said),
                          of->response_node, of->reference_node, human_fixed(pool, of->fit, 4));
    }
    if (text && !*count && ema->nmodes)
        text[(*count)++] = "No mode and no channel is doubtful.";
    return text;
}

/* Orders upwards, frequencies to the right: 's' stable, 'f' only its frequency, '.' neither; the modes stand below. */
static void print_stabilisation(FILE *out, const struct ema_result *ema)
{
    double low = ema->source.low_hz, high = ema->source.high_hz;
    char row[COLUMNS + 1];
    int highest = 0, step;
    for (int i = 0; i < ema->nstabilisation; i++)
        highest = ema->stabilisation[i].order > highest ? ema->stabilisation[i].order : highest;
    if (!highest || !(high > low))
        return;
    step = (highest + LISTED_ROWS - 1) / LISTED_ROWS;
    (void)fprintf(out, "\nStabilisation (s stable, f frequency only, . neither; every %dth order)\n", step);
    for (int order = highest; order > 0; order -= step) {
        memset(row, ' ', COLUMNS);
        row[COLUMNS] = 0;
        for (int i = 0; i < ema->nstabilisation; i++) {
            const struct ema_pole *p = &ema->stabilisation[i];
            int column = (int)((p->frequency_hz - low) / (high - low) * COLUMNS);
            if (p->order != order || p->frequency_hz < low || column >= COLUMNS)
                continue;
            char mark = '.';
            if (p->stable_frequency)
                mark = p->stable_damping ? 's' : 'f';
            if (p->part &&
                (mark != 's' || p->mode == ROTID_NONE)) /* tables of parts are dense: what counts of them are the modes */
                continue;
            if (row[column] == ' ' || mark == 's' || (mark == 'f' && row[column] == '.'))
                row[column] = mark;
        }
        (void)fprintf(out, "%5d |%s|\n", order, row);
    }
    memset(row, ' ', COLUMNS);
    for (int k = 0; k < ema->nmodes; k++) {
        int column = (int)((ema->modes[k].is.frequency_hz - low) / (high - low) * COLUMNS);
        if (column >= 0 && column < COLUMNS)
            row[column] = '^';
    }
    (void)fprintf(out, " Hz   |%s|\n", row);
    (void)fprintf(out, "      %-*.6g%*.6g\n", COLUMNS / 2, low, COLUMNS / 2 + 2, high);
}

static struct table *table_of_mac(struct pool *pool, const struct ema_result *ema)
{
    int count = ema->nmodes < MOST_MAC ? ema->nmodes : MOST_MAC;
    struct table *table =
        table_open(pool, ema->nmodes > MOST_MAC ? "MAC of the shapes with each other [%], the first twenty (all in the JSON)"
                                                : "MAC of the shapes with each other [%]");
    for (int i = 0; i < count && count > 1; i++) {
        number_column(table, "mode", NULL, SHOW_COUNT, i + 1);
        for (int j = 0; j < count; j++)
            number_column(table, i ? "" : pool_text(pool, "%d", j + 1), NULL, SHOW_COUNT,
                          100 * ema->mac[i + (ptrdiff_t)j * ema->nmodes]);
    }
    return table;
}

static struct table *table_of_poles(struct pool *pool, const struct ema_result *ema)
{
    struct table *table = table_open(pool, "Poles");
    for (int i = 0; i < ema->nstabilisation; i++) {
        const struct ema_pole *p = &ema->stabilisation[i];
        number_column(table, "order", NULL, SHOW_COUNT, p->order);
        number_column(table, "frequency", "Hz", SHOW_DIGITS(8), p->frequency_hz);
        number_column(table, "damping", "%", SHOW_DIGITS(4), 100 * p->damping);
        text_column(table, "stable", SHOW_TEXT, p->stable_frequency && p->stable_damping ? "fd" : p->stable_frequency ? "f" : "");
        number_column(table, "mode", NULL, SHOW_COUNT, p->mode == ROTID_NONE ? (double)NAN : p->mode);
    }
    return table;
}

/* The channels with the lowest FRAC, or all. */
static struct table *table_of_channels(struct pool *pool, const struct ema_result *ema, int all)
{
    int *order = POOL_ARRAY(pool, int, ema->nchannels), known = order ? by_frac(ema, order) : 0;
    int shown = all || known < WORST ? known : WORST;
    struct table *table =
        table_open(pool, pool_text(pool, "FRAC of measured and synthesised transfer functions: median %.4f; %s",
                                   known ? ema->channels[order[known / 2]].fit : 0, shown < known ? "the worst" : "all"));
    for (int i = 0; i < shown && ema->nmodes; i++) {
        const struct ema_channel *of = &ema->channels[order[i]];
        number_column(table, "node", NULL, SHOW_COUNT, of->response_node);
        number_column(table, "over node", NULL, SHOW_COUNT, of->reference_node);
        number_column(table, "FRAC", NULL, SHOW_FIXED(4), of->fit);
        number_column(table, "noise over rms", NULL, SHOW_DIGITS(2), of->noise);
    }
    return table;
}

void screen_ema(const struct screen *to, const struct ema_report *r)
{
    const struct ema_result *ema = ema_result_of(to->pool, r, 0);
    if (!ema)
        return;
    print_source(to, r, ema);
    screen_table(to, table_of_test_modes(to->pool, ema));
    if (!ema->nmodes)
        (void)fprintf(to->out, "\nno mode was found\n");
    int count;
    const char **text = ema_doubts(to->pool, ema, &count);
    for (int i = 0; i < count && text; i++) {
        (void)fputs(i ? "" : "\n", to->out);
        wrap_text(to->out, 4, to->width, "", text[i]);
    }
    print_stabilisation(to->out, ema);
    if (to->verbose)
        screen_table(to, table_of_poles(to->pool, ema));
    screen_table(to, table_of_mac(to->pool, ema));
    screen_table(to, table_of_channels(to->pool, ema, to->verbose));
    if (r->output)
        (void)fprintf(to->out, "\n%d %s written to %s\n", ema->nmodes, human_plural(ema->nmodes, "mode", "modes"), r->output);
}

/* The card of it, as far as it is known: zero is refused there. */
static void print_noise(const struct screen *to, const struct ema_scatter *scatter)
{
    struct pool *pool = to->pool;
    int hz = scatter->frequency > 0, shape = scatter->shape > 0;
    screen_say(to, "between tests frequencies repeat within %.2g %%%s%s", 100 * scatter->frequency,
               isfinite(scatter->damping) ? pool_text(pool, ", dampings within %.2g %%", 100 * scatter->damping) : "",
               shape ? pool_text(pool, ", shapes within %.2g %% of the largest component", 100 * scatter->shape) : "");
    if (!hz)
        screen_say(to, "the frequencies are the same in all tests, which tells nothing of their scatter");
    if (!shape)
        screen_say(to, "the scatter of shapes is not known: it takes two points that every test has");
    if (hz || shape)
        screen_say(to, "*NOISE%s%s", hz ? pool_text(pool, ", FREQUENCY=%.2g", scatter->frequency) : "",
                   shape ? pool_text(pool, ", SHAPE=%.2g", scatter->shape) : "");
}

void screen_scatter(const struct screen *to, int count, const char *const *file, const struct ema test[], const struct ema *mean,
                    const struct ema_scatter *scatter, const char *output)
{
    struct table *table = table_open(to->pool, "Modes of all tests: the mean, and the scatter of one test about it");
    for (int t = 0; t < count; t++)
        screen_say(to, "%s: %d %s, %d points", file[t], test[t].nmode, human_plural(test[t].nmode, "mode", "modes"),
                   test[t].npoint);
    for (int k = 0; k < mean->nmode; k++) {
        const struct ema_mode *mode = &mean->mode[k];
        number_column(table, "mode", NULL, SHOW_COUNT, k + 1);
        number_column(table, "frequency", "Hz", SHOW_DIGITS(8), mode->frequency_hz);
        number_column(table, "scatter", "Hz", SHOW_DIGITS(2), scatter->std_hz[k]);
        number_column(table, "scatter", "%", SHOW_DIGITS(2), 100 * scatter->std_hz[k] / mode->frequency_hz);
        number_column(table, "damping", "%", SHOW_DIGITS(4), 100 * mode->damping);
        number_column(table, "scatter", "%", SHOW_DIGITS(2), 100 * scatter->std_damping[k]);
    }
    screen_table(to, table);
    if (scatter->missing)
        screen_say(to, "%d %s of the test with the most left out: not in every test", scatter->missing,
                   human_plural(scatter->missing, "mode", "modes"));
    if (scatter->lacking)
        screen_say(to, "%d %s left out of the shapes: not in every test along the same axis", scatter->lacking,
                   human_plural(scatter->lacking, "point", "points"));
    if (mean->nmode)
        print_noise(to, scatter);
    else
        screen_say(to, "no mode is in every test");
    if (output)
        screen_say(to, "\n%d %s written to %s, the means of %d tests with their standard deviations", mean->nmode,
                   human_plural(mean->nmode, "mode", "modes"), output, count);
}
