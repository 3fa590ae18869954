/* `rotid uff` on the screen. */
#include "report/report.h"

#include <math.h>
#include <string.h>

#include "base/base.h"
#include "import/import.h"

#define ROWS_MOST 40
#define WIDTH     130

/* Sets from `first` to `last`, alike and one after the other. */
struct row {
    int first, last;
};

static const struct listing_function *function_of(const struct listing *listing, int set)
{
    const struct listing_set *s = &listing->set[set];
    return s->set.number == 58 && s->item >= 0 ? &listing->function[s->item] : NULL;
}

static int alike(const struct listing *listing, int a, int b)
{
    const struct listing_set *s = &listing->set[a], *t = &listing->set[b];
    const struct listing_function *f = function_of(listing, a), *g = function_of(listing, b);
    return s->set.number == t->set.number && s->is_read == t->is_read && s->is_faulty == t->is_faulty && !f == !g &&
           (!f || f->group == g->group);
}

static struct row take_row(const struct listing *listing, int first, int all)
{
    struct row row = {first, first};
    while (!all && row.last + 1 < listing->set_count && alike(listing, first, row.last + 1))
        ++row.last;
    return row;
}

/* A unit in Latin-1, such as m/s with a superscript of two, can still be read. */
static const char *clean(struct pool *pool, const char *text)
{
    char *copy = pool_copy_text(pool, text);
    for (size_t bytes, at = 0; copy && copy[at]; at += bytes) {
        if (!text_utf8(copy + at) && (unsigned char)copy[at] == 0xb2)
            copy[at] = '2';
        bytes = text_utf8(copy + at) ? text_utf8(copy + at) : 1;
    }
    return copy ? copy : "";
}

/* "1:+X ... 19:+X / 1:+X": response and reference. */
static const char *places_of(struct pool *pool, const struct listing_function *f, const struct listing_function *g)
{
    char response[PLACE_MOST], last[PLACE_MOST], reference[PLACE_MOST];
    (void)place_text(f->function.response_node, f->function.response_direction, response);
    (void)place_text(g->function.response_node, g->function.response_direction, last);
    (void)place_text(f->function.reference_node, f->function.reference_direction, reference);
    return pool_format(pool, "%s%s%s%s%s", response, f == g ? "" : " ... ", f == g ? "" : last,
                       f->function.reference_node ? " / " : "", f->function.reference_node ? reference : "");
}

/* "complex double, m/s/N, times 0.001 in SI" */
static const char *values_of(struct pool *pool, const struct listing_function *f)
{
    const char *above = f->function.numerator.unit, *below = f->function.denominator.unit;
    return pool_format(pool, "%s%s%s%s%s%s%s%s%s", name_of_ordinate(f->function.ordinate),
                       f->function.binary.is_binary ? ", binary" : "", *above || *below ? ", " : "", clean(pool, above),
                       *below ? "/" : "", clean(pool, below), f->si_factor != 1 ? ", times " : "",
                       f->si_factor != 1 ? IN_DIGITS(6, f->si_factor) : "", f->si_factor != 1 ? " in SI" : "");
}

/* What the sets of a row hold that are no functions. */
static const char *contents_of(struct pool *pool, const struct listing *listing, struct row row)
{
    const struct listing_set *set = &listing->set[row.first];
    long long size = 0;
    for (int i = row.first; i <= row.last; ++i)
        size += listing->set[i].size;
    if (set->set.number == 55 && set->item >= 0) {
        const struct uff_shape *first = &listing->shape[set->item].shape;
        const struct uff_shape *last = &listing->shape[listing->set[row.last].item].shape;
        const char *what = pool_format(pool, "%s, %d points, %s, %s", name_of_analysis(first->analysis_type), first->node_count,
                                       first->is_complex ? "complex" : "real", IN_DIGITS(6, first->frequency_hz));
        if (row.first == row.last)
            return pool_format(pool, "%s Hz, damping %s", what ? what : "", IN_DIGITS(4, first->damping));
        return pool_format(pool, "%s to %s Hz", what ? what : "", IN_DIGITS(6, last->frequency_hz));
    }
    if (set->set.number == 164 && listing->units)
        return pool_format(pool, "%s %s", name_of_units(listing->units->code), clean(pool, listing->units->description));
    if (set->set.number == 151 && listing->header)
        return clean(pool, listing->header->model);
    if (set->is_read)
        return pool_format(pool, "%lld in all", size);
    return name_of_set(set->set.number) && !set->is_faulty ? "read over" : "";
}

static struct table *table_of_sets(struct pool *pool, const struct listing *listing, int all)
{
    struct table *table = table_open(pool, "");
    int rows = 0, next = 0;
    for (struct row row; next < listing->set_count && (all || rows < ROWS_MOST); ++rows, next = row.last + 1) {
        row = take_row(listing, next, all);
        const struct listing_set *set = &listing->set[row.first];
        const struct listing_function *f = function_of(listing, row.first), *g = function_of(listing, row.last);
        const char *name = f ? name_of_function(f->function.type, row.last > row.first) : name_of_set(set->set.number);
        double min = INFINITY, max = -INFINITY, rms = 0;
        for (int i = row.first; i <= row.last && f; ++i) {
            const struct values *v = &function_of(listing, i)->values;
            min = fmin(min, v->min);
            max = fmax(max, v->max);
            rms = fmax(rms, v->rms);
        }
        table_row(table);
        number_column(table, "line", NULL, SHOW_COUNT, set->set.line);
        text_column(table, "set", SHOW_TEXT, pool_format(pool, "%d%s", set->set.number, set->set.is_binary ? "b" : ""));
        number_column(table, "count", NULL, SHOW_COUNT, row.last - row.first + 1);
        text_column(table, "what", SHOW_TEXT, set->is_faulty ? "MALFORMED" : name ? name : "not known");
        text_column(table, "response / reference", SHOW_TEXT, f ? places_of(pool, f, g) : "");
        number_column(table, "values", NULL, SHOW_COUNT, f ? (double)f->function.count : NAN);
        number_column(table, "from", NULL, SHOW_DIGITS(6), f ? f->values.x_first * f->x_si_factor : NAN);
        number_column(table, "step", NULL, SHOW_DIGITS(6), f && f->function.is_even ? f->function.step * f->x_si_factor : NAN);
        number_column(table, "min", NULL, SHOW_DIGITS(4), f ? min : NAN);
        number_column(table, "max", NULL, SHOW_DIGITS(4), f ? max : NAN);
        number_column(table, "rms", NULL, SHOW_DIGITS(4), f ? rms : NAN);
        text_column(table, "contents", SHOW_TEXT, f ? values_of(pool, f) : contents_of(pool, listing, row));
    }
    if (table && next < listing->set_count)
        table->note = pool_format(pool, "... and %d more sets; --verbose shows each", listing->set_count - next);
    return table;
}

void screen_uff(const struct screen *to, const char *path, const struct listing *listing, int summary_count,
                const char *const *summary)
{
    FILE *out = to->out;
    (void)fprintf(out, "%s: %d %s\n", path, listing->set_count, human_plural(listing->set_count, "set", "sets"));
    for (int i = 0; i < summary_count; ++i)
        wrap_text(out, 2, WIDTH, "", summary[i]);
    if (listing->units)
        (void)fprintf(out, "units %s: a length in m times %.6g, a force in N times %.6g\n", name_of_units(listing->units->code),
                      listing->units->length, listing->units->force);
    screen_table(to, table_of_sets(to->pool, listing, to->verbose));
    if (listing->function_count)
        screen_say(
            to, "from and step in s or Hz; min and max of the modulus where values are complex; values in the unit of the file");
    if (listing->finding_count)
        (void)fprintf(out, "\ndoubtful places\n");
    for (int i = 0; i < listing->finding_count; ++i) {
        const struct listing_finding *doubt = &listing->doubt[i];
        char head[32] = "  ";
        if (doubt->line)
            (void)snprintf(head, sizeof head, "  line %d: ", doubt->line);
        wrap_text(out, 4, WIDTH, head, doubt->text);
    }
}
