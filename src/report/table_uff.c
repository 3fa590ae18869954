#include "report/report.h"

#include <math.h>
#include <string.h>

#include "base/base.h"
#include "import/import.h"

#define ROWS_MOST 40

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
static void print_clean(FILE *out, const char *text)
{
    for (size_t bytes; *text; text += bytes) {
        int is_two = !text_utf8(text) && (unsigned char)*text == 0xb2;
        bytes = text_utf8(text) ? text_utf8(text) : 1;
        (void)fwrite(is_two ? "2" : text, 1, bytes, out);
    }
}

static void print_unit(FILE *out, const char *numerator, const char *denominator)
{
    (void)fputs(", ", out);
    print_clean(out, numerator);
    if (*denominator)
        (void)fputc('/', out);
    print_clean(out, denominator);
}

static void print_function(FILE *out, const struct listing *listing, struct row row)
{
    const struct listing_function *f = function_of(listing, row.first), *g = function_of(listing, row.last);
    char response[PLACE_MOST], last[PLACE_MOST], reference[PLACE_MOST], places[4 * PLACE_MOST];
    double min = INFINITY, max = -INFINITY, rms = 0;
    const char *unit = f->function.numerator.unit;
    (void)place_text(f->function.response_node, f->function.response_direction, response);
    (void)place_text(g->function.response_node, g->function.response_direction, last);
    (void)place_text(f->function.reference_node, f->function.reference_direction, reference);
    (void)snprintf(places, sizeof places, "%s%s%s%s%s", response, row.first == row.last ? "" : " ... ",
                   row.first == row.last ? "" : last, f->function.reference_node ? " / " : "",
                   f->function.reference_node ? reference : "");
    for (int i = row.first; i <= row.last; ++i) {
        const struct values *v = &function_of(listing, i)->values;
        min = fmin(min, v->min);
        max = fmax(max, v->max);
        rms = fmax(rms, v->rms);
    }
    text_cell(out, 24, name_of_function(f->function.type, row.last > row.first));
    (void)fputc(' ', out);
    text_cell(out, 26, places);
    (void)fprintf(out, " %9lld", f->function.count);
    digits_cell(out, 11, 6, f->values.x_first * f->x_si_factor);
    digits_cell(out, 12, 6, f->function.is_even ? f->function.step * f->x_si_factor : NAN);
    digits_cell(out, 11, 4, min);
    digits_cell(out, 11, 4, max);
    digits_cell(out, 11, 4, rms);
    (void)fprintf(out, "  %s%s", name_of_ordinate(f->function.ordinate), f->function.binary.is_binary ? ", binary" : "");
    if (*unit || *f->function.denominator.unit)
        print_unit(out, unit, f->function.denominator.unit);
    if (f->si_factor != 1)
        (void)fprintf(out, ", times %s in SI", IN_DIGITS(6, f->si_factor));
}

static void print_rest(FILE *out, const struct listing *listing, struct row row)
{
    const struct listing_set *set = &listing->set[row.first];
    const char *name = name_of_set(set->set.number);
    long long size = 0;
    for (int i = row.first; i <= row.last; ++i)
        size += listing->set[i].size;
    text_cell(out, 24, set->is_faulty ? "MALFORMED" : name ? name : "not known");
    if (set->set.number == 55 && set->item >= 0) {
        const struct uff_shape *first = &listing->shape[set->item].shape;
        const struct uff_shape *last = &listing->shape[listing->set[row.last].item].shape;
        (void)fprintf(out, " %s, %d points, %s", name_of_analysis(first->analysis_type), first->node_count,
                      first->is_complex ? "complex" : "real");
        if (row.first == row.last)
            (void)fprintf(out, ", %s Hz, damping %s", IN_DIGITS(6, first->frequency_hz), IN_DIGITS(4, first->damping));
        else
            (void)fprintf(out, ", %s to %s Hz", IN_DIGITS(6, first->frequency_hz), IN_DIGITS(6, last->frequency_hz));
    } else if (set->set.number == 164 && listing->units) {
        (void)fprintf(out, " %s ", name_of_units(listing->units->code));
        print_clean(out, listing->units->description);
    } else if (set->set.number == 151 && listing->header) {
        (void)fputc(' ', out);
        print_clean(out, listing->header->model);
    } else if (set->is_read) {
        (void)fprintf(out, " %lld in all", size);
    } else if (name && !set->is_faulty) {
        (void)fputs(" read over", out);
    }
}

static void print_row(FILE *out, const struct listing *listing, struct row row)
{
    const struct listing_set *set = &listing->set[row.first];
    int count = row.last - row.first + 1;
    (void)fprintf(out, "%9d  %4d%c %6d  ", set->set.line, set->set.number, set->set.is_binary ? 'b' : ' ', count);
    if (function_of(listing, row.first))
        print_function(out, listing, row);
    else
        print_rest(out, listing, row);
    (void)fputc('\n', out);
}

static void print_sets(FILE *out, const struct listing *listing, int all)
{
    int rows = 0, next = 0;
    (void)fprintf(out, "\n     line   set  count  %-24s %-26s %9s%11s%12s%11s%11s%11s\n", "what", "response / reference",
                  "values", "from", "step", "min", "max", "rms");
    for (; next < listing->set_count && (all || rows < ROWS_MOST); ++rows) {
        struct row row = take_row(listing, next, all);
        print_row(out, listing, row);
        next = row.last + 1;
    }
    if (next < listing->set_count)
        (void)fprintf(out, "... and %d more sets; --verbose shows each\n", listing->set_count - next);
    if (listing->function_count)
        (void)fprintf(
            out,
            "from and step in s or Hz; min and max of the modulus where values are complex; values in the unit of the file\n");
}

void table_uff(FILE *out, const char *path, const struct listing *listing, int summary_count, const char *const *summary, int all)
{
    (void)fprintf(out, "%s: %d set%s\n", path, listing->set_count, listing->set_count == 1 ? "" : "s");
    for (int i = 0; i < summary_count; ++i)
        wrap_text(out, 2, 130, "", summary[i]);
    if (listing->units)
        (void)fprintf(out, "units %s: a length in m times %.6g, a force in N times %.6g\n", name_of_units(listing->units->code),
                      listing->units->length, listing->units->force);
    print_sets(out, listing, all);
    if (listing->doubt_count)
        (void)fprintf(out, "\ndoubtful places\n");
    for (size_t i = 0; i < listing->doubt_count; ++i) {
        const struct listing_doubt *doubt = &listing->doubt[i];
        char head[32] = "  ";
        if (doubt->line)
            (void)snprintf(head, sizeof head, "  line %d: ", doubt->line);
        wrap_text(out, 4, 130, head, doubt->text);
    }
}
