#include <limits.h>

#include "import/import.h"

#define PIECE 4096

enum {
    DISPLACEMENT = 8,
    REACTION_FORCE = 9,
    VELOCITY = 11,
    ACCELERATION = 12,
    EXCITATION_FORCE = 13,
    ABSCISSA_TIME = 17,
    ABSCISSA_FREQUENCY = 18
};

static int is_one_of(const char *text, const char *const *words)
{
    for (; *words; words++)
        if (same_text(text, *words))
            return 1;
    return 0;
}

/* Quantity of an axis as enum frf_quantity: -1 where it is no motion. A type that is not given is told by the text of the unit.
 */
static int motion_of(const struct uff_axis *axis)
{
    static const char *const accelerations[] = {"g", "gn", "m/s2", "m/s^2", "m/s**2", "mm/s2", "mm/s^2", NULL},
                             *const velocities[] = {"m/s", "mm/s", NULL}, *const displacements[] = {"m", "mm", "um", NULL};
    const int type = axis->specific_type, untold = type == 0 || type == 1;
    return type == ACCELERATION || (untold && is_one_of(axis->unit, accelerations))   ? FRF_ACCELERATION
           : type == VELOCITY || (untold && is_one_of(axis->unit, velocities))        ? FRF_VELOCITY
           : type == DISPLACEMENT || (untold && is_one_of(axis->unit, displacements)) ? FRF_DISPLACEMENT
                                                                                      : -1;
}

static int is_force(const struct uff_axis *axis)
{
    static const char *const forces[] = {"N", "kN", "lbf", NULL};
    return axis->specific_type == EXCITATION_FORCE || axis->specific_type == REACTION_FORCE ||
           (axis->specific_type <= 1 && is_one_of(axis->unit, forces));
}

struct placed {
    struct uff_node node;
    int line, order;
};

struct growing {
    struct pool *pool, *scratch;
    const char *path;
    struct message_list *messages;
    struct contents *contents;
    int node_count;
    struct placed *node; /* of all sets */
};

ORDER_BY(by_id, struct placed, it->node.id, it->order)

static int add_nodes(struct growing *g, const struct uff_set *set, int count, const struct uff_node *node)
{
    int failed = 0;
    for (int i = 0; i < count && !failed; i++)
        failed = POOL_ADD(g->scratch, g->node, g->node_count, (&(struct placed){node[i], set->line, g->node_count}));
    return failed ? ROTID_ERROR_MEMORY : ROTID_OK;
}

/* Sorted, the first of each id, in metres. */
static int join_nodes(struct growing *g)
{
    struct contents *c = g->contents;
    double metre = c->units && c->units->length > 0 ? c->units->length : 1;
    c->node = POOL_ARRAY(g->pool, struct uff_node, g->node_count);
    if (!c->node)
        return ROTID_ERROR_MEMORY;
    if (g->node_count)
        qsort(g->node, (size_t)g->node_count, sizeof *g->node, by_id);
    for (int i = 0, first = 0; i < g->node_count; i++) {
        const struct placed *p = &g->node[i];
        if (i && g->node[first].node.id == p->node.id) {
            const double *x = g->node[first].node.x;
            if (x[0] != p->node.x[0] || x[1] != p->node.x[1] || x[2] != p->node.x[2])
                message_add(g->messages, SEVERITY_WARNING, g->path, p->line, 1,
                            "node %d has other coordinates than before, the first ones are used", p->node.id);
            continue;
        }
        first = i;
        c->node[c->node_count] = p->node;
        for (int d = 0; d < 3; d++)
            c->node[c->node_count].x[d] /= metre;
        c->node_count++;
    }
    return ROTID_OK;
}

/* Half a unit of the last digit, relative, of numbers written with so many digits (E11.4 has five, E13.5 six); none where they
 * have more. */
static double rounding_of(long long count, const double *x)
{
    for (int digits = 5; digits <= 6; digits++) {
        int all = 1;
        for (long long i = 0; i < count && all; i++) {
            double unit = x[i] != 0 ? pow(10, floor(log10(fabs(x[i])) + 1e-12) - digits + 1) : 1, number = x[i] / unit;
            all = fabs(number - round(number)) < 1e-6;
        }
        if (all)
            return 5.1 * pow(10, -digits);
    }
    return 1e-12;
}

/* Many writers put down every abscissa although the lines are even, with so few digits that it looks uneven: the straight line
 * through all of them is what was meant, where none is off by more than its own rounding. */
static int take_abscissa(struct growing *g, struct uff_reader *reader, struct content *item)
{
    struct uff_function *f = &item->function;
    struct pool scratch;
    long long got = 1, done = 0, room = 0;
    double *x = NULL;
    int status = ROTID_OK;
    pool_open(&scratch, g->pool->allocator);
    while (done < f->count && got > 0 && !status) { /* the count is only announced: room comes with the values */
        if (done == room) {
            room = room ? 2 * room : PIECE;
            x = POOL_COPY(&scratch, x, done, room - done);
        }
        status =
            x ? uff_read_values(reader, room - done < f->count - done ? room - done : f->count - done, x + done, NULL, NULL, &got)
              : ROTID_ERROR_MEMORY;
        done += status ? 0 : got;
    }
    if (status || !x) {
        pool_close(&scratch);
        return status;
    }
    double middle = 0.5 * (double)(done - 1), mean = 0, slope = 0, spread = 0;
    for (long long i = 0; i < done; i++)
        mean += x[i] / (double)done;
    for (long long i = 0; i < done; i++) {
        slope += ((double)i - middle) * (x[i] - mean);
        spread += ((double)i - middle) * ((double)i - middle);
    }
    int even = done > 2 && slope > 0;
    slope /= spread;
    double rounding = rounding_of(done, x);
    for (long long i = 0; i < done && even; i++)
        even = fabs(x[i] - mean - ((double)i - middle) * slope) <= rounding * fabs(x[i]) + 1e-6 * slope;
    if (even) {
        f->is_even = 1;
        f->step = slope;
        f->start = mean - middle * slope;
        if (fabs(f->start) < 1e-3 * slope)
            f->start = 0;
    } else {
        item->x = POOL_COPY(g->pool, x, done, 0);
        status = item->x ? ROTID_OK : ROTID_ERROR_MEMORY;
    }
    pool_close(&scratch);
    return status;
}

static int read_function(struct growing *g, struct uff_reader *reader, const struct uff_set *set)
{
    struct content item = {.set = *set};
    int status = uff_read_function(reader, &item.function);
    if (!status && !item.function.is_even)
        status = take_abscissa(g, reader, &item);
    if (!status && POOL_ADD(g->pool, g->contents->item, g->contents->count, &item))
        status = ROTID_ERROR_MEMORY;
    return status;
}

/* A second system of units would change what the values before it mean, or after it. */
static int read_units(struct growing *g, struct uff_reader *reader, const struct uff_set *set)
{
    struct contents *c = g->contents;
    struct uff_units *units = POOL_NEW(g->pool, struct uff_units);
    int status = units ? uff_read_units(reader, units) : ROTID_ERROR_MEMORY;
    if (!status && c->units && !uff_same_units(units, c->units))
        return message_refuse(g->messages, ROTID_ERROR_ARGUMENT, g->path, set->line, 1,
                              "a second set 164 has other factors than the first, expected one system of units in a file");
    c->units = status ? c->units : units;
    return status;
}

static int read_set(struct growing *g, struct uff_reader *reader, const struct uff_set *set)
{
    struct uff_node *node;
    int count, status;
    if (set->number == 15 || set->number == 781 || set->number == 2411) {
        status = uff_read_nodes(reader, g->scratch, &count, &node);
        return status ? status : add_nodes(g, set, count, node);
    }
    return set->number == 164 ? read_units(g, reader, set) : set->number == 58 ? read_function(g, reader, set) : ROTID_OK;
}

/* Reads over a file from its beginning. ROTID_OK or the statuses of uff_next and of the readers. */
static int contents_read(struct pool *pool, struct uff_reader *reader, const char *path, struct message_list *messages,
                         struct contents *contents)
{
    struct pool scratch;
    struct growing g = {.pool = pool, .scratch = &scratch, .path = path, .messages = messages, .contents = contents};
    struct uff_set set;
    int status;
    *contents = (struct contents){0};
    pool_open(&scratch, pool->allocator);
    while (!(status = uff_next(reader, &set)))
        if ((status = read_set(&g, reader, &set)))
            break;
    if (status == UFF_END)
        status = join_nodes(&g);
    pool_close(&scratch);
    return status;
}

/* Values first ... first + count - 1 of a function, times a factor: real [count], imag [count] (NULL: of a real one). Statuses of
 * uff_return_to and of the readers; fewer values than the function has are not asked for. */
static int contents_values(struct uff_reader *reader, const struct content *item, long long first, long long count, double factor,
                           double *real, double *imag)
{
    struct uff_function f;
    double skip_real[256], skip_imag[256];
    long long got = 1, done = 0;
    int status = uff_return_to(reader, &item->set);
    if (!status)
        status = uff_read_function(reader, &f);
    for (long long left = first; left > 0 && got > 0 && !status; left -= got)
        status = uff_read_values(reader, left < 256 ? left : 256, NULL, skip_real, skip_imag, &got);
    while (done < count && !status && got > 0) {
        status = uff_read_values(reader, count - done, NULL, real + done, imag ? imag + done : NULL, &got);
        done += got;
    }
    for (long long i = 0; i < done; i++) {
        real[i] *= factor;
        if (imag)
            imag[i] *= factor;
    }
    return status;
}

#define MOST_TAIL 0.1  /* of the rms of a block, in its last tenth */
#define MOST_LOST 0.01 /* of the rms of the force */

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

/* Whether the text of an axis names another unit than the one that counts, with a factor to SI; the abscissa counts as it is. */
static int contradicts(const struct contents *c, const struct uff_axis *axis, int type, double counts, const char **said,
                       struct pool *pool)
{
    double by_text = unit_text_factor(type, axis->unit);
    if (!(by_text > 0) || fabs(by_text - counts) <= 1e-3 * counts)
        return 0;
    if (!*said)
        *said = pool_format(pool, "'%s', which is %.6g %s, where %s %.6g", axis->unit, by_text, si_unit(type),
                            type == ABSCISSA_TIME || type == ABSCISSA_FREQUENCY ? "values count as"
                            : c->units                                          ? "set 164 says"
                                                                                : "no set 164 does and values count as",
                            counts);
    return 1;
}

/* A unit that nobody reads is a wrong factor: of the functions that a measurement consists of. */
static void check_units(struct pool *pool, const struct contents *c, const char *path, struct message_list *messages)
{
    static const int motion[] = {[FRF_DISPLACEMENT] = DISPLACEMENT, [FRF_VELOCITY] = VELOCITY, [FRF_ACCELERATION] = ACCELERATION};
    const struct uff_units *units = c->units;
    const char *said = NULL;
    int count = 0, line = 0;
    for (int i = 0; i < c->count; i++) {
        const struct uff_function *f = &c->item[i].function;
        int quantity = motion_of(&f->numerator), bad = 0;
        if (f->type != UFF_TRANSFER && f->type != UFF_TIME)
            continue;
        bad |= contradicts(c, &f->abscissa, f->type == UFF_TIME ? ABSCISSA_TIME : ABSCISSA_FREQUENCY, 1, &said, pool);
        if (quantity >= 0)
            bad |= contradicts(c, &f->numerator, motion[quantity], uff_si_factor(units, &f->numerator), &said, pool);
        else if (is_force(&f->numerator))
            bad |= contradicts(c, &f->numerator, EXCITATION_FORCE, uff_si_factor(units, &f->numerator), &said, pool);
        if (f->type == UFF_TRANSFER && is_force(&f->denominator))
            bad |= contradicts(c, &f->denominator, EXCITATION_FORCE, uff_si_factor(units, &f->denominator), &said, pool);
        line = bad && !count ? f->line : line;
        count += bad;
    }
    if (count)
        message_add(messages, SEVERITY_WARNING, path, line, 1,
                    "%d functions have unit texts other than the units that count, here %s: a factor may be wrong", count,
                    said ? said : "");
}

/* A measurement while it is read. */
struct loading {
    struct pool *pool, scratch; /* scratch: of this reading */
    struct uff_reader *reader;
    const char *path;
    struct contents contents;
    const struct measurement_options *options;
    struct message_list *messages;
    double **values; /* [contents.count] of records, read so far */
    struct measurement *out;
};

/* The values of a function in SI; read once. */
static int values_of(struct loading *l, int index, const double **values)
{
    const struct content *item = &l->contents.item[index];
    if (!l->values[index]) {
        double factor = uff_si_factor(l->contents.units, &item->function.numerator);
        double *out = POOL_ARRAY(&l->scratch, double, item->function.count);
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
    message_add(l->messages, SEVERITY_WARNING, l->path, gone.line, 1,
                "node %d over node %d left out: no impact of its records can be used (each is missing, double, clipped, dead, "
                "cut off by the end of the record, or not finite)",
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

/* What a window takes off the pulse, or off what rings behind it, is a factor on the force that every impact has alike. */
static void warn_of_lost_force(const struct loading *l, const struct time_record *record, const struct transfer *transfer)
{
    int count = 0, used = 0, worst = 0;
    for (int i = 0; i < transfer->nimpact; i++) {
        used += transfer->impact[i].used;
        count += transfer->impact[i].lost > MOST_LOST;
        worst = transfer->impact[i].lost > transfer->impact[worst].lost ? i : worst;
    }
    if (2 * count > used) /* else noise, where few samples tell it */
        message_add(l->messages, SEVERITY_WARNING, l->path, record[transfer->impact[worst].record].line, 1,
                    "the force window cuts %d of %d pulses or what rings behind them (here %.0f %% of the rms): masses and "
                    "damping are off, expected a longer --force-window, or none",
                    count, used, 100 * transfer->impact[worst].lost);
}

/* A decay below half a step of the converter reads zero: no scatter of the impacts, which would show, but an early end. */
static void warn_of_steps(const struct loading *l)
{
    const struct uff_function *worst = NULL;
    int read = 0, coarse = 0, least = COARSE_LEVELS;
    char place[PLACE_MOST];
    for (int i = 0; i < l->contents.count; i++) {
        const struct uff_function *f = &l->contents.item[i].function;
        int levels = l->values[i] ? values_levels(f->count, l->values[i]) : 0;
        read += l->values[i] != NULL;
        coarse += levels > 0;
        worst = levels && levels < least ? f : worst;
        least = levels && levels < least ? levels : least;
    }
    if (worst)
        message_add(l->messages, SEVERITY_WARNING, l->path, worst->line, 1,
                    "%d of %d channels have fewer than %d levels (here the %s at %s, %d from its least to its greatest value): "
                    "damping and masses are off by more than their standard deviations, expected a smaller input range",
                    coarse, read, COARSE_LEVELS, is_force(&worst->numerator) ? "force" : "response",
                    place_text(worst->response_node, worst->response_direction, place), least);
}

/* A response belongs to the force with its load case number, where numbers differ from measurement to measurement; else to the
 * last force before it. Transfer functions of all pairs by transfer_compute, to out->set. Statuses of measurement_read. */
static int load_records(struct loading *l)
{
    const struct contents *contents = &l->contents;
    const struct measurement_options *options = l->options;
    struct measurement *out = l->out;
    struct time_record *record = POOL_ARRAY(&l->scratch, struct time_record, contents->count);
    l->values = POOL_ARRAY(&l->scratch, double *, contents->count);
    int status = record && l->values ? ROTID_OK : ROTID_ERROR_MEMORY, by_case = load_cases_tell(contents), count = 0, bad = -1;
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
            message_add(l->messages, SEVERITY_WARNING, l->path, f->line, 1, "time record of node %d left out: %s",
                        f->response_node, reason);
            continue;
        }
        status = values_of(l, force, &r->force);
        if (!status)
            status = values_of(l, i, &r->response);
        count += !status;
    }
    if (!status && !count) {
        status = message_refuse(l->messages, ROTID_ERROR_ARGUMENT, l->path, 1, 1,
                                "no time record is left to use, expected a force and its response");
    } else if (!status) {
        struct transfer_options transfer = options->transfer;
        transfer.low_hz = options->low_hz;
        transfer.high_hz = options->high_hz;
        do {
            if (bad >= 0)
                count = leave_out(l, count, record, bad);
            bad = -1;
            status = count ? transfer_compute(l->pool, count, record, out->rate, (enum frf_quantity)quantity, &transfer,
                                              options->threads > 0 ? options->threads : 1, &out->transfer, &bad)
                           : ROTID_ERROR_ARGUMENT;
        } while (status == ROTID_ERROR_ARGUMENT && bad >= 0);
        if (status == ROTID_ERROR_ARGUMENT)
            message_add(l->messages, SEVERITY_ERROR, l->path, 1, 1,
                        count ? "no block of these records suits the windows and the band asked for, expected a block within the "
                                "records and lines within the band"
                              : "no time record is left to use, expected a force with an impact");
        else if (!status) {
            warn_of_leakage(l, record, &out->transfer);
            warn_of_lost_force(l, record, &out->transfer);
            warn_of_steps(l);
        }
    }
    out->from_records = !status;
    out->record_count = count;
    out->set = out->transfer.set;
    return status;
}

/* ---- A file is listed first; then the functions that are wanted are read, the rest never leaves the disk. */

/* A set 58 that is no longer than its neighbours is not worth losing the rest for; a file with nothing usable is. */
static int refuse_file(struct message_list *messages, const char *path, const struct contents *c)
{
    if (!messages->errors)
        message_add(messages, SEVERITY_ERROR, path, 1, 1,
                    "%d functions, none of them a transfer function (58, type 4) or a time record of a force with a response "
                    "(type 1, real, stored with even steps, specific data types 13 and 8, 11 or 12), expected one or the other",
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
    if (!uff_is_complex(f))
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

static int load_coherences(struct loading *l, const struct content *model, long long first)
{
    struct frf_set *set = &l->out->set;
    int averages = l->options->averages;
    for (int i = 0; i < l->contents.count; i++) {
        const struct content *item = &l->contents.item[i];
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

static int load_transfer(struct loading *l, const struct content *item, long long first, double *real, double *imag)
{
    struct frf_set *set = &l->out->set;
    const struct uff_function *f = &item->function;
    struct frf *frf = &set->frf[set->nfrf];
    const struct uff_units *units = l->contents.units;
    double factor = uff_si_factor(units, &f->numerator) / uff_si_factor(units, &f->denominator);
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

static int load_transfers(struct loading *l, int model_index)
{
    const struct contents *c = &l->contents;
    const struct content *model = &c->item[model_index];
    struct frf_set *set = &l->out->set;
    long long first, count;
    choose_lines(model, l->options, &first, &count);
    if (count < 1 || count > INT_MAX)
        return message_refuse(l->messages, ROTID_ERROR_ARGUMENT, l->path, model->function.line, 1,
                              "%lld of %lld lines from %.6g to %.6g Hz lie in the band asked for, expected some", count,
                              model->function.count, line_of(model, 0), line_of(model, model->function.count - 1));
    set->nline = (int)count;
    set->quantity = (enum frf_quantity)motion_of(&model->function.numerator);
    set->frequency_hz = POOL_ARRAY(l->pool, double, count);
    set->frf = POOL_ARRAY(l->pool, struct frf, c->count);
    double *real = POOL_ARRAY(&l->scratch, double, count), *imag = POOL_ARRAY(&l->scratch, double, count);
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
    if (!status && !set->nfrf)
        return message_refuse(l->messages, ROTID_ERROR_ARGUMENT, l->path, 1, 1,
                              "no transfer function is left to use, expected at least one");
    return status ? status : load_coherences(l, model, first);
}

int measurement_read(struct pool *pool, const char *path, const struct measurement_options *options,
                     struct message_list *messages, struct measurement *out)
{
    struct loading l = {.pool = pool, .path = path, .options = options, .messages = messages, .out = out};
    *out = (struct measurement){0};
    if (analyser_is(path))
        return analyser_read(pool, path, options, messages, out);
    pool_open(&l.scratch, pool->allocator);
    int status = uff_open(&l.scratch, path, messages, &l.reader);
    if (!status && !uff_can_return(l.reader))
        status = message_refuse(messages, ROTID_ERROR_IO, path, 1, 1,
                                "this is no regular file, expected one: its functions are read twice");
    if (!status)
        status = contents_read(pool, l.reader, path, messages, &l.contents);
    if (!status) {
        out->node_count = l.contents.node_count;
        out->node = l.contents.node;
        out->units = l.contents.units;
        check_units(&l.scratch, &l.contents, path, messages);
        int model = common_kind(&l.contents, options);
        if (model >= 0)
            status = load_transfers(&l, model);
        else if (contents_have_records(&l.contents))
            status = load_records(&l);
        else
            status = refuse_file(messages, path, &l.contents);
    }
    uff_close(l.reader);
    pool_close(&l.scratch);
    if (messages->pool->out_of_memory)
        status = ROTID_ERROR_MEMORY;
    return status;
}
