#include "import/records.h"

#include <math.h>
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

int contents_have_records(const struct contents *contents)
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

static int same_pair(const struct record *a, const struct record *b)
{
    return a->response_node == b->response_node && a->response_direction == b->response_direction &&
           a->reference_node == b->reference_node && a->reference_direction == b->reference_direction;
}

/* The records of a transfer function that has no impact to use go; one bad point is no reason to lose a test. Returns how many
 * stay. */
static int leave_out(const struct loading *l, int count, struct record *record, int bad)
{
    const struct record gone = record[bad];
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
static void warn_of_leakage(const struct loading *l, const struct record *record, const struct transfer *transfer)
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

int records_load(struct pool *pool, struct uff_reader *reader, const char *path, const struct contents *contents,
                 const struct measurement_options *options, struct message_list *messages, struct measurement *out)
{
    struct pool scratch;
    pool_open(&scratch, pool->allocator);
    struct loading l = {.pool = &scratch, .reader = reader, .path = path, .contents = contents, .messages = messages};
    struct record *record = POOL_ARRAY(&scratch, struct record, contents->count);
    l.values = POOL_ARRAY(&scratch, double *, contents->count);
    int status = record && l.values ? ROTID_OK : ROTID_ERROR_MEMORY, by_case = load_cases_tell(contents), count = 0, bad = -1;
    int quantity = -1;
    for (int i = 0; i < contents->count && !status; i++) {
        const struct uff_function *f = &contents->item[i].function;
        int force = is_response(&contents->item[i]) ? force_of(contents, i, by_case) : -1;
        if (force < 0)
            continue;
        const struct uff_function *g = &contents->item[force].function;
        struct record *r = &record[count];
        *r = (struct record){.line = f->line,
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
