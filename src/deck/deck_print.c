/* Cards as text, in the units of the deck that they are written into. */

#include "deck/deck_row.h"

#define LINE 100 /* a card longer than this goes on in the next line */

void deck_put(struct deck_writer *w, const char *format, ...)
{
    va_list values, again;
    va_start(values, format);
    va_copy(again, values);
    int count = vsnprintf(NULL, 0, format, values);
    va_end(values);
    while (count >= 0 && w->length + (size_t)count + 1 > w->room) {
        char *grown = pool_grow(w->pool, w->text, w->room, &w->room, 1);
        if (!grown)
            break;
        w->text = grown;
    }
    if (count >= 0 && w->length + (size_t)count + 1 <= w->room)
        w->length += (size_t)vsnprintf(w->text + w->length, (size_t)count + 1, format, again);
    va_end(again);
}

/* 2.1e11 for 2.1e+11 */
static void shorten_exponent(char *text)
{
    char *e = strchr(text, 'e');
    if (!e)
        return;
    int exponent = atoi(e + 1);
    (void)sprintf(e + 1, "%d", exponent); /* never longer than it was */
}

const char *deck_number_text(double value, char text[DECK_NUMBER_LENGTH])
{
    char plain[DECK_NUMBER_LENGTH];
    int digits = -1;
    do
        (void)snprintf(text, DECK_NUMBER_LENGTH, "%.*e", ++digits, value);
    while (digits < 16 && strtod(text, NULL) != value);
    shorten_exponent(text);
    (void)snprintf(plain, sizeof plain, "%.*g", digits + 1 < 15 ? 15 : digits + 1, value);
    shorten_exponent(plain);
    return strlen(plain) > strlen(text) + 3 ? text : strcpy(text, plain);
}

/* The value in the deck's unit of `what`. */
static double in_unit(const struct deck_writer *w, double value, const char *what)
{
    double unit = w->job ? deck_unit_of(&w->job->units, what) : 1;
    char text[DECK_NUMBER_LENGTH];
    if (unit == 1)
        return value;
    (void)snprintf(text, sizeof text, "%.14e", value / unit);
    return strtod(text, NULL);
}

void deck_put_number(struct deck_writer *w, const char *separator, double value, const char *what)
{
    char text[DECK_NUMBER_LENGTH];
    deck_put(w, "%s%s", separator, deck_number_text(in_unit(w, value, what), text));
}

void deck_put_card(struct deck_writer *w, const char *name)
{
    deck_put(w, "*%s", name);
}

void deck_put_option(struct deck_writer *w, const char *name, const char *value)
{
    size_t column = 0;
    value = value ? value : "";
    while (column < w->length && w->text[w->length - column - 1] != '\n')
        column++;
    deck_put(w, ",%s%s=%s", column + strlen(name) + strlen(value) + 3 > LINE ? "\n    " : " ", name, value);
}

void deck_put_option_number(struct deck_writer *w, const char *name, double value, const char *what)
{
    char text[DECK_NUMBER_LENGTH];
    deck_put_option(w, name, deck_number_text(in_unit(w, value, what), text));
}

/* ------------------------------------------------------------------------------------------------ by rows */

/* Values at the end that may lack are left out where they say nothing: zero or NaN, or what they follow. */
static int says_more(const struct deck_row *row, const void *from)
{
    for (; !deck_row_is_last(row); row++) {
        const char *member = (const char *)from + row->offset;
        if (row->option)
            continue;
        double value = row->kind == ROW_WHOLE ? *(const int *)member : *(const double *)member;
        int lacks = row->bits & ROW_NAN ? isnan(value)
                                        : value == 0 || (row->as && value == *(const double *)((const char *)from + row->as));
        if (!(row->bits & ROW_MAY_LACK) || !lacks)
            return 1;
    }
    return 0;
}

void deck_put_values(struct deck_writer *w, const struct deck_row *row, const void *from)
{
    const char *before = "";
    for (; !deck_row_is_last(row) && says_more(row, from); row++) {
        const void *member = (const char *)from + row->offset;
        if (row->option)
            continue;
        if (row->kind == ROW_WHOLE)
            deck_put(w, "%s%d", before, *(const int *)member);
        else if (row->bits & ROW_NAN && isnan(*(const double *)member))
            deck_put(w, "%s", before);
        else
            deck_put_number(w, before, *(const double *)member, row->kind == ROW_POSITION ? "m" : row->what);
        before = ", ";
    }
    deck_put(w, "\n");
}

void deck_put_list_item(struct deck_writer *w, const char *card, const void *from)
{
    const struct deck_card *kind = deck_card_find(card);
    deck_put_card(w, card);
    for (const struct deck_row *row = kind->row; !deck_row_is_last(row); row++)
        if (row->kind == ROW_NAME && *(const char *const *)((const char *)from + row->offset))
            deck_put_option(w, row->option, *(const char *const *)((const char *)from + row->offset));
    deck_put(w, "\n");
    deck_put_values(w, kind->row, from);
}

/* ------------------------------------------------------------------------------------------------ measured data */

struct job_raw deck_data_as_read(const struct job *job)
{
    const struct job_measurement *m = &job->measurement;
    return m->raw ? *m->raw
                  : (struct job_raw){job->rotor.nsensor,    job->rotor.sensor,     m->shape, m->shape_std, m->frequency_std,
                                     m->point_frequency_hz, m->point_frequency_std};
}

/* The one value of all components that are there (of `there`, or all), NaN where they differ or one has none. */
static double uniform(ptrdiff_t count, const double *there, const double *std)
{
    double value = NAN;
    for (ptrdiff_t i = 0, first = 1; i < count; i++) {
        if (there && !isfinite(there[i]))
            continue;
        if (!isfinite(std[i]) || (!first && std[i] != value))
            return NAN;
        value = std[i];
        first = 0;
    }
    return value;
}

void deck_put_sensors(struct deck_writer *w, int count, const struct sensor *sensor)
{
    for (int s = 0; s < count; s++) {
        if (s % DECK_MOST_LINES == 0)
            deck_put(w, "*SENSORS\n");
        deck_put_values(w, deck_rows("SENSORS"), &sensor[s]);
    }
}

void deck_put_noise(struct deck_writer *w, double frequency, double shape)
{
    deck_put_card(w, "NOISE");
    if (isfinite(frequency))
        deck_put_option_number(w, "FREQUENCY", frequency, "");
    if (isfinite(shape))
        deck_put_option_number(w, "SHAPE", shape, "");
    deck_put(w, "\n");
}

/* A deviation in Hz that gives the relative one back by division, or the nearest there is. */
static double std_hz(double std, double hz)
{
    double product = std * hz, beside[] = {nextafter(product, 0), nextafter(product, INFINITY)};
    for (int i = 0; i < 2 && product / hz != std; i++)
        if (beside[i] / hz == std)
            return beside[i];
    return product;
}

static void write_modes(struct deck_writer *w, const struct job_raw *data, int with_std)
{
    const struct job_measurement *m = &w->job->measurement;
    int type = w->job->options.type;
    double last = 0;
    if (m->nmode)
        deck_put(w, "*MODES%s%s\n", type ? ", TYPE=" : "", type ? mode_type_words[type] : "");
    for (int k = 0; k < m->nmode; k++) {
        struct mode_line line = {m->number[k], m->frequency_hz[k], m->damping[k], with_std ? data->frequency_std[k] : NAN};
        if (!(line.damping >= 0 && line.damping < 1))
            line.damping = NAN;
        if (k && line.hz == last) /* two modes of a universal file may have one frequency, those of a deck may not */
            line.hz = nextafter(line.hz, INFINITY);
        last = line.hz;
        line.std = isfinite(line.std) ? std_hz(line.std, line.hz) : NAN;
        deck_put_values(w, deck_rows("MODES"), &line);
    }
}

/* The card of mode k with what was measured at each sensor and, where wanted, its deviation. Of frequencies the mean in *MODES
 * stays: it may have been found by better means. */
static void write_at_sensors(struct deck_writer *w, const struct job_raw *data, int k, const char *card, const double *value,
                             const double *std)
{
    ptrdiff_t first = (ptrdiff_t)k * data->nsensor;
    for (int s = 0, lines = 0; s < data->nsensor; s++) {
        const struct point_line line = {data->sensor[s].id, value[first + s], std ? std[first + s] : NAN};
        if (!isfinite(line.value))
            continue;
        if (lines++ % DECK_MOST_LINES == 0)
            deck_put(w, "*%s, MODE=%d%s\n", card, w->job->measurement.number[k], value != data->shape ? ", MEAN=NO" : "");
        deck_put_values(w, deck_rows(card), &line);
    }
}

void deck_noise_of_all(const struct job *job, double *frequency, double *shape)
{
    const struct job_raw data = deck_data_as_read(job);
    int nmode = job->measurement.nmode;
    *frequency =
        data.point_frequency_hz ? NAN : uniform(nmode, NULL, data.frequency_std); /* *MODES states it: it is not settled anew */
    *shape = data.shape ? uniform((ptrdiff_t)data.nsensor * nmode, data.shape, data.shape_std) : NAN;
}

void deck_put_measured(struct deck_writer *w, int with_sensors)
{
    const struct job_raw data = deck_data_as_read(w->job);
    int nmode = w->job->measurement.nmode;
    double frequency, shape;
    deck_noise_of_all(w->job, &frequency, &shape);
    if (with_sensors)
        deck_put_sensors(w, data.nsensor, data.sensor);
    write_modes(w, &data, !isfinite(frequency));
    if (isfinite(frequency) || isfinite(shape))
        deck_put_noise(w, frequency, shape);
    for (int k = 0; k < nmode && data.shape; k++)
        write_at_sensors(w, &data, k, "SHAPE", data.shape, isfinite(shape) ? NULL : data.shape_std);
    for (int k = 0; k < nmode && data.point_frequency_hz; k++)
        write_at_sensors(w, &data, k, "FREQUENCIES", data.point_frequency_hz, data.point_frequency_std);
}

/* ------------------------------------------------------------------------------------------------ identification */

void deck_put_holdout(struct deck_writer *w)
{
    const char *separator = "";
    for (int k = 0, count = 0; k < w->job->measurement.nmode && w->job->measurement.holdout; k++)
        if (w->job->measurement.holdout[k]) {
            deck_put(w, "%s%d", separator, w->job->measurement.number[k]);
            separator = ++count % 20 ? "," : ",\n    ";
        }
}

void deck_put_unknown(struct deck_writer *w, const rotid_parameter *bounds, const char *name)
{
    const char *unit = bounds->unit ? bounds->unit : "";
    deck_put(w, "%s", name);
    deck_put_number(w, ", ", bounds->lower, unit);
    deck_put_number(w, ", ", bounds->upper, unit);
    deck_put_number(w, ", ", bounds->start, unit);
    deck_put(w, "\n");
}
