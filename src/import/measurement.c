#include "import/import.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MOST_TAIL 0.1 /* of the rms of a block, in its last tenth */

static int is_record(const struct content *item)
{
    const struct uff_function *f = &item->function;
    return f->type == UFF_TIME && f->is_even && (f->ordinate == UFF_REAL_SINGLE || f->ordinate == UFF_REAL_DOUBLE);
}

static int is_response(const struct content *item)
{
    return is_record(item) && motion_of(&item->function.numerator) >= 0;
}

static int is_impact(const struct content *item)
{
    return is_record(item) && is_force(&item->function.numerator);
}

/* Whether there are time records of forces and of responses. */
static int contents_have_records(const struct contents *contents)
{
    int forces = 0, responses = 0;
    for (int i = 0; i < contents->count; i++) {
        forces += is_impact(&contents->item[i]);
        responses += is_response(&contents->item[i]);
    }
    return forces && responses;
}

/* Numbers tie channels together only where each has one force. */
static int load_cases_tell(const struct contents *c)
{
    for (int i = 0; i < c->count; i++)
        for (int j = 0; j < i && is_impact(&c->item[i]); j++)
            if (is_impact(&c->item[j]) && c->item[i].function.load_case == c->item[j].function.load_case)
                return 0;
    return 1;
}

static int force_of(const struct contents *c, int response, int by_case)
{
    int found = -1;
    for (int i = 0; i < c->count; i++) {
        if (!is_impact(&c->item[i]))
            continue;
        if (by_case && c->item[i].function.load_case == c->item[response].function.load_case)
            return i;
        if (!by_case && (i < response || found < 0))
            found = i;
    }
    return found;
}

struct loading {
    struct pool *pool;
    struct uff_reader *reader;
    const char *path;
    const struct contents *contents;
    struct message_list *messages;
    double **values; /* [contents->count] read so far */
};

/* The values of a function in SI; read once. */
static int values_of(struct loading *l, int index, const double **values)
{
    const struct content *item = &l->contents->item[index];
    if (!l->values[index]) {
        double factor = uff_si_factor(l->contents->has_units ? &l->contents->units : NULL, &item->function.numerator);
        double *out = POOL_ARRAY(l->pool, double, item->function.count);
        int status = out ? contents_values(l->reader, item, 0, item->function.count, factor, out, NULL) : ROTID_ERROR_MEMORY;
        if (status)
            return status;
        l->values[index] = out;
    }
    *values = l->values[index];
    return ROTID_OK;
}

/* Force and response have to be sampled together. */
static const char *unfit(const struct uff_function *force, const struct uff_function *response, double rate, int quantity)
{
    if (force->count != response->count || fabs(force->step - response->step) > 1e-6 * force->step)
        return "it is not sampled like its force";
    if (!(force->step > 0) || fabs(force->step * rate - 1) > 1e-6)
        return "its sampling rate is not that of the others";
    return motion_of(&response->numerator) == quantity ? NULL : "its quantity is not that of the others";
}

static int same_pair(const struct time_record *a, const struct time_record *b)
{
    return a->response_node == b->response_node && a->response_direction == b->response_direction &&
           a->reference_node == b->reference_node && a->reference_direction == b->reference_direction;
}

/* The records of a transfer function that has no impact to use go; one bad point is no reason to lose a test. Returns how many
 * stay. */
static int leave_out(const struct loading *l, int count, struct time_record *record, int bad)
{
    const struct time_record gone = record[bad];
    int kept = 0;
    message_add(
        l->messages, SEVERITY_WARNING, l->path, gone.line, 1,
        "node %d over node %d left out: no impact of its records can be used (each is missing, double, clipped, cut off by the "
        "end of the record, or not finite)",
        gone.response_node, gone.reference_node);
    for (int i = 0; i < count; i++)
        if (!same_pair(&record[i], &gone))
            record[kept++] = record[i];
    return kept;
}

/* A block that ends while the rotor still rings bends every peak, and nothing in the transfer functions shows it. */
static void warn_of_leakage(const struct loading *l, const struct time_record *record, const struct transfer *transfer)
{
    int count = 0, used = 0, worst = -1;
    for (int i = 0; i < transfer->nimpact; i++) {
        const struct impact *impact = &transfer->impact[i];
        used += impact->used;
        if (!impact->used || impact->tail <= MOST_TAIL)
            continue;
        count++;
        if (worst < 0 || impact->tail > transfer->impact[worst].tail)
            worst = i;
    }
    if (worst >= 0)
        message_add(
            l->messages, SEVERITY_WARNING, l->path, record[transfer->impact[worst].record].line, 1,
            "%d of %d blocks end before the response has decayed (here its last tenth has %.0f %% of the rms): frequencies, "
            "damping and masses are off, expected longer records or --exponential",
            count, used, 100 * transfer->impact[worst].tail);
}

static void say_bad(const struct loading *l)
{
    message_add(l->messages, SEVERITY_ERROR, l->path, 1, 1,
                "no block of these records suits the windows and the band asked for, expected a block within the records and "
                "lines within the band");
}

/* A response belongs to the force with its load case number, where numbers differ from measurement to measurement; else to the
 * last force before it. Transfer functions of all pairs by transfer_compute, to out->set. Statuses of measurement_read. */
static int records_load(struct pool *pool, struct uff_reader *reader, const char *path, const struct contents *contents,
                        const struct measurement_options *options, struct message_list *messages, struct measurement *out)
{
    struct pool scratch;
    pool_open(&scratch, pool->allocator);
    struct loading l = {.pool = &scratch, .reader = reader, .path = path, .contents = contents, .messages = messages};
    struct time_record *record = POOL_ARRAY(&scratch, struct time_record, contents->count);
    l.values = POOL_ARRAY(&scratch, double *, contents->count);
    int status = record && l.values ? ROTID_OK : ROTID_ERROR_MEMORY, by_case = load_cases_tell(contents), count = 0, bad = -1;
    int quantity = -1;
    for (int i = 0; i < contents->count && !status; i++) {
        const struct uff_function *f = &contents->item[i].function;
        int force = is_response(&contents->item[i]) ? force_of(contents, i, by_case) : -1;
        if (force < 0)
            continue;
        const struct uff_function *g = &contents->item[force].function;
        struct time_record *r = &record[count];
        *r = (struct time_record){.line = f->line,
                                  .response_node = f->response_node,
                                  .response_direction = f->response_direction,
                                  .reference_node = f->reference_node ? f->reference_node : g->response_node,
                                  .reference_direction = f->reference_node ? f->reference_direction : g->response_direction,
                                  .count = f->count};
        if (options->reference && r->reference_node != options->reference)
            continue;
        if (quantity < 0) {
            quantity = motion_of(&f->numerator);
            out->rate = 1 / f->step;
        }
        const char *reason = unfit(g, f, out->rate, quantity);
        if (reason) {
            message_add(messages, SEVERITY_WARNING, path, f->line, 1, "time record of node %d left out: %s", f->response_node,
                        reason);
            continue;
        }
        status = values_of(&l, force, &r->force);
        if (!status)
            status = values_of(&l, i, &r->response);
        count += !status;
    }
    if (!status && !count) {
        message_add(messages, SEVERITY_ERROR, path, 1, 1, "no time record is left to use, expected a force and its response");
        status = ROTID_ERROR_ARGUMENT;
    } else if (!status) {
        struct transfer_options transfer = options->transfer;
        transfer.low_hz = options->low_hz;
        transfer.high_hz = options->high_hz;
        do {
            if (bad >= 0)
                count = leave_out(&l, count, record, bad);
            bad = -1;
            status = count ? transfer_compute(pool, count, record, out->rate, (enum frf_quantity)quantity, &transfer,
                                              options->threads > 0 ? options->threads : 1, &out->transfer, &bad)
                           : ROTID_ERROR_ARGUMENT;
        } while (status == ROTID_ERROR_ARGUMENT && bad >= 0);
        if (status == ROTID_ERROR_ARGUMENT && count)
            say_bad(&l);
        else if (status == ROTID_ERROR_ARGUMENT)
            message_add(messages, SEVERITY_ERROR, path, 1, 1, "no time record is left to use, expected a force with an impact");
        else if (!status)
            warn_of_leakage(&l, record, &out->transfer);
    }
    out->from_records = !status;
    out->record_count = count;
    out->set = out->transfer.set;
    pool_close(&scratch);
    return status;
}

/* ---- A file is listed first; then the functions that are wanted are read, the rest never leaves the disk. */

/* A set 58 that is no longer than its neighbours is not worth losing the rest for; a file with nothing usable is. */
static int refuse_file(struct message_list *messages, const char *path, const struct contents *c)
{
    if (!messages->errors)
        message_add(messages, SEVERITY_ERROR, path, 1, 1,
                    "%d functions, none of them a transfer function (58, type 4) or a time record of a force with a response "
                    "(type 1, specific data types 13 and 8, 11 or 12), expected one or the other",
                    c->count);
    return ROTID_ERROR_ARGUMENT;
}

static int same_lines(const struct content *left, const struct content *right)
{
    const struct uff_function *a = &left->function, *b = &right->function;
    if (a->count != b->count || !left->x != !right->x)
        return 0;
    if (left->x)
        return memcmp(left->x, right->x, (size_t)a->count * sizeof *left->x) == 0;
    return fabs(a->step - b->step) <= 1e-6 * fabs(b->step) && fabs(a->start - b->start) <= 1e-3 * fabs(b->step);
}

static double line_of(const struct content *item, long long i)
{
    return item->x ? item->x[i] : item->function.start + (double)i * item->function.step;
}

static int lines_rise(const struct content *item)
{
    for (long long i = 1; i < item->function.count && item->x; i++)
        if (!(item->x[i] > item->x[i - 1]))
            return 0;
    return item->x || item->function.step > 0;
}

static int wanted(const struct measurement_options *options, const struct uff_function *f)
{
    return !options->reference || f->reference_node == options->reference;
}

static int alike(const struct content *a, const struct content *b)
{
    return same_lines(a, b) && motion_of(&a->function.numerator) == motion_of(&b->function.numerator);
}

static int counts(const struct measurement_options *options, const struct content *item)
{
    const struct uff_function *f = &item->function;
    return f->type == UFF_TRANSFER && f->count > 0 && motion_of(&f->numerator) >= 0 && wanted(options, f);
}

/* The lines and the quantity that most transfer functions have: -1, or the index of one of them. */
static int common_kind(const struct contents *c, const struct measurement_options *options)
{
    int best = -1, most = 0;
    for (int i = 0; i < c->count; i++) {
        if (!counts(options, &c->item[i]) || (best >= 0 && alike(&c->item[i], &c->item[best])))
            continue;
        int count = 0;
        for (int j = i; j < c->count; j++)
            count += counts(options, &c->item[j]) && alike(&c->item[j], &c->item[i]);
        if (count > most) {
            most = count;
            best = i;
        }
    }
    for (int i = 0; i < c->count && best < 0; i++) /* none of use: the first one says why */
        if (c->item[i].function.type == UFF_TRANSFER && c->item[i].function.count > 0)
            best = i;
    return best;
}

/* Why a transfer function cannot be used beside the others, or NULL. */
static const char *unusable(const struct content *item, const struct content *model)
{
    const struct uff_function *f = &item->function;
    if (f->ordinate != UFF_COMPLEX_SINGLE && f->ordinate != UFF_COMPLEX_DOUBLE)
        return "its values are real, expected complex ones";
    if (!lines_rise(item))
        return "its lines do not rise";
    if (!same_lines(item, model))
        return "its lines are not those of most others";
    if (motion_of(&f->numerator) < 0)
        return "its response is no displacement, velocity or acceleration (specific data type 8, 11 or 12)";
    if (!is_force(&f->denominator) && f->denominator.specific_type > 1)
        return "its reference is no force (specific data type 13)";
    return NULL;
}

/* The lines that are kept: first and how many. */
static void choose_lines(const struct content *item, const struct measurement_options *options, long long *first,
                         long long *count)
{
    long long low = 0, high = item->function.count;
    double rounding = 1e-9 * line_of(item, high - 1);
    while (low < high && line_of(item, low) < options->low_hz - rounding)
        low++;
    while (high > low && options->high_hz > 0 && line_of(item, high - 1) > options->high_hz + rounding)
        high--;
    *first = low;
    *count = high - low;
}

struct loader {
    struct pool *pool;
    struct uff_reader *reader;
    const char *path;
    const struct contents *contents;
    const struct measurement_options *options;
    struct message_list *messages;
    struct measurement *out;
};

static int find_frf(const struct frf_set *set, const struct uff_function *f)
{
    for (int c = 0; c < set->nfrf; c++)
        if (set->frf[c].response_node == f->response_node && set->frf[c].response_direction == f->response_direction &&
            set->frf[c].reference_node == f->reference_node && set->frf[c].reference_direction == f->reference_direction)
            return c;
    return -1;
}

/* The complex variance of the mean of K impacts with this coherence (Bendat and Piersol 2010, 9.1, both parts). */
static double variance_from(double coherence, double magnitude, int averages)
{
    double g = fmin(fmax(coherence, 1e-6), 1 - 1e-6); /* a record averaged with itself has none left */
    return (1 - g) / (g * averages) * magnitude * magnitude;
}

static int load_coherences(struct loader *l, const struct content *model, long long first)
{
    struct frf_set *set = &l->out->set;
    int averages = l->options->averages;
    for (int i = 0; i < l->contents->count; i++) {
        const struct content *item = &l->contents->item[i];
        int c = item->function.type == UFF_COHERENCE ? find_frf(set, &item->function) : -1;
        if (c < 0 || !same_lines(item, model) || set->frf[c].coherence)
            continue;
        struct frf *frf = &set->frf[c];
        frf->coherence = POOL_ARRAY(l->pool, double, set->nline);
        frf->variance = averages > 0 ? POOL_ARRAY(l->pool, double, set->nline) : NULL;
        frf->averages = averages;
        if (!frf->coherence || (averages > 0 && !frf->variance))
            return ROTID_ERROR_MEMORY;
        int status = contents_values(l->reader, item, first, set->nline, 1, frf->coherence, NULL);
        if (status)
            return status;
        for (int n = 0; n < set->nline && frf->variance; n++)
            frf->variance[n] = variance_from(frf->coherence[n], cabs(frf->h[n]), averages);
    }
    return ROTID_OK;
}

static int load_transfer(struct loader *l, const struct content *item, long long first, double *real, double *imag)
{
    struct frf_set *set = &l->out->set;
    const struct uff_function *f = &item->function;
    struct frf *frf = &set->frf[set->nfrf];
    double factor = uff_si_factor(l->contents->has_units ? &l->contents->units : NULL, &f->numerator) /
                    uff_si_factor(l->contents->has_units ? &l->contents->units : NULL, &f->denominator);
    *frf = (struct frf){.line = f->line,
                        .response_node = f->response_node,
                        .response_direction = f->response_direction,
                        .reference_node = f->reference_node,
                        .reference_direction = f->reference_direction};
    frf->h = POOL_ARRAY(l->pool, double complex, set->nline);
    int status = frf->h ? contents_values(l->reader, item, first, set->nline, factor, real, imag) : ROTID_ERROR_MEMORY;
    for (int n = 0; n < set->nline && !status; n++)
        frf->h[n] = real[n] + I * imag[n];
    if (!status)
        set->nfrf++;
    return status;
}

static int load_transfers(struct loader *l, int model_index)
{
    const struct contents *c = l->contents;
    const struct content *model = &c->item[model_index];
    struct frf_set *set = &l->out->set;
    long long first, count;
    choose_lines(model, l->options, &first, &count);
    if (count < 1 || count > INT_MAX) {
        message_add(l->messages, SEVERITY_ERROR, l->path, model->function.line, 1,
                    "%lld of %lld lines from %.6g to %.6g Hz lie in the band asked for, expected some", count,
                    model->function.count, line_of(model, 0), line_of(model, model->function.count - 1));
        return ROTID_ERROR_ARGUMENT;
    }
    set->nline = (int)count;
    set->quantity = (enum frf_quantity)motion_of(&model->function.numerator);
    set->frequency_hz = POOL_ARRAY(l->pool, double, count);
    set->frf = POOL_ARRAY(l->pool, struct frf, c->count);
    struct pool scratch;
    pool_open(&scratch, l->pool->allocator);
    double *real = POOL_ARRAY(&scratch, double, count), *imag = POOL_ARRAY(&scratch, double, count);
    int status = set->frequency_hz && set->frf && real && imag ? ROTID_OK : ROTID_ERROR_MEMORY;
    for (long long n = 0; n < count && !status; n++)
        set->frequency_hz[n] = line_of(model, first + n);
    for (int i = 0; i < c->count && !status; i++) {
        const struct uff_function *f = &c->item[i].function;
        if (f->type != UFF_TRANSFER || !wanted(l->options, f))
            continue;
        const char *reason = unusable(&c->item[i], model);
        if (!reason && (enum frf_quantity)motion_of(&f->numerator) != set->quantity)
            reason = "its response is another quantity than that of most others";
        if (!reason && find_frf(set, f) >= 0)
            reason = "another one has the same response and reference";
        if (reason)
            message_add(l->messages, SEVERITY_WARNING, l->path, f->line, 1,
                        "transfer function of node %d over node %d left out: %s", f->response_node, f->reference_node, reason);
        else
            status = load_transfer(l, &c->item[i], first, real, imag);
    }
    pool_close(&scratch);
    if (!status && !set->nfrf) {
        message_add(l->messages, SEVERITY_ERROR, l->path, 1, 1, "no transfer function is left to use, expected at least one");
        return ROTID_ERROR_ARGUMENT;
    }
    return status ? status : load_coherences(l, model, first);
}

int measurement_read(struct pool *pool, const char *path, const struct measurement_options *options,
                     struct message_list *messages, struct measurement *out)
{
    struct contents contents;
    struct loader l = {.pool = pool, .path = path, .contents = &contents, .options = options, .messages = messages, .out = out};
    struct pool scratch;
    *out = (struct measurement){0};
    pool_open(&scratch, pool->allocator);
    int status = uff_open(&scratch, path, messages, &l.reader);
    if (!status && !uff_can_return(l.reader)) {
        message_add(messages, SEVERITY_ERROR, path, 1, 1, "this is no regular file, expected one: its functions are read twice");
        status = ROTID_ERROR_IO;
    }
    if (!status)
        status = contents_read(pool, l.reader, path, messages, &contents);
    if (!status) {
        out->node_count = contents.node_count;
        out->node = contents.node;
        out->units = contents.units;
        out->has_units = contents.has_units;
        int model = common_kind(&contents, options);
        if (model >= 0)
            status = load_transfers(&l, model);
        else if (contents_have_records(&contents))
            status = records_load(pool, l.reader, path, &contents, options, messages, out);
        else
            status = refuse_file(messages, path, &contents);
    }
    uff_close(l.reader);
    pool_close(&scratch);
    if (messages->out_of_memory)
        status = ROTID_ERROR_MEMORY;
    return status;
}
