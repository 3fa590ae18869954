#include "deck/deck.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "rotid.h"

static void add(struct deck_reader *reader, enum severity severity, struct place place, const char *format, va_list values)
{
    char text[1024], cell[TABLE_CELL_LENGTH];
    int table = 0;
    (void)vsnprintf(text, sizeof text, format, values);
    for (int i = 0; i < reader->text.ntable; i++)
        table |= place.file == reader->text.table[i]->path;
    if (table)
        message_add(reader->messages, severity, place.file, place.line, place.column, "%s (cell %s)", text,
                    table_cell_name(place.line, place.column, cell));
    else
        message_add(reader->messages, severity, place.file, place.line, place.column, "%s", text);
}

void deck_error(struct deck_reader *reader, struct place place, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    add(reader, SEVERITY_ERROR, place, format, values);
    va_end(values);
}

void deck_note(struct deck_reader *reader, struct place place, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    add(reader, SEVERITY_WARNING, place, format, values);
    va_end(values);
}

int deck_add(struct deck_reader *reader, void **list, int *count, size_t size, const void *item)
{
    int failed = pool_add(reader->pool, list, count, size, item);
    reader->out_of_memory |= failed;
    return failed;
}

void deck_add_place(struct deck_reader *reader, enum deck_places which, struct place place)
{
    (void)DECK_ADD(reader, reader->place[which], reader->nplace[which], &place);
}

static const char *range_text(enum range range)
{
    return range == POSITIVE ? "a number above zero" : range == NOT_NEGATIVE ? "a number not below zero" : "a number";
}

int deck_is_usual(double value)
{
    return value == 0 || (fabs(value) >= DECK_LEAST && fabs(value) <= DECK_MOST);
}

static int parse_number(struct deck_reader *reader, const struct field *field, const char *what, enum range range, double *value)
{
    const char *text = field->text;
    struct place place = field->place;
    char *end;
    double number = strtod(text, &end);
    if (end == text || *end) {
        deck_error(reader, place, "'%s' is not a number, expected one for %s", text, what);
        return 1;
    }
    if (!isfinite(number) || (range == POSITIVE && number <= 0) || (range == NOT_NEGATIVE && number < 0)) {
        deck_error(reader, place, "%s is %s, expected %s", what, text, isfinite(number) ? range_text(range) : "a finite number");
        return 1;
    }
    if (!deck_is_usual(number) && (range != ANY || fabs(number) > DECK_MOST)) { /* a component of a shape may be rounding */
        deck_error(reader, place, "%s is %s, expected a size from %g to %g%s", what, text, DECK_LEAST, DECK_MOST,
                   range == POSITIVE ? "" : ", or zero");
        return 1;
    }
    *value = number * (field->in_si > 0
                           ? field->in_si
                           : deck_in_si(reader, what)); /* only now: what follows from a bad length would be reported as well */
    deck_doubt(reader, place, what, text, *value);
    return 0;
}

int deck_has(const struct data_line *line, int i)
{
    return i < line->count && *line->field[i].text;
}

int deck_number(struct deck_reader *reader, const struct data_line *line, int i, const char *what, enum range range,
                double *value)
{
    if (!deck_has(line, i)) {
        deck_error(reader, i < line->count ? line->field[i].place : line->end, "a value is missing, expected %s", what);
        return 1;
    }
    return parse_number(reader, &line->field[i], what, range, value);
}

int deck_integer(struct deck_reader *reader, const struct data_line *line, int i, const char *what, int least, int most,
                 int *value)
{
    double number;
    if (deck_number(reader, line, i, what, ANY, &number))
        return 1;
    if (number != floor(number) || number < least || number > most) {
        deck_error(reader, line->field[i].place, "%s is %s, expected a whole number from %d to %d", what, line->field[i].text,
                   least, most);
        return 1;
    }
    *value = (int)number;
    return 0;
}

int deck_count(struct deck_reader *reader, const struct data_line *line, int most, const char *layout)
{
    if (line->count <= most)
        return 0;
    deck_error(reader, line->field[most].place, "'%s' is one value too many, expected %s", line->field[most].text, layout);
    return 1;
}

int deck_find_group(const struct deck_reader *reader, int count, const char *name, size_t length)
{
    for (int g = 0; g < count; g++) {
        const char *known = reader->job->rotor.group[g].name;
        if (strlen(known) == length && !strncasecmp(known, name, length))
            return g;
    }
    return -1;
}

static const char group_name[] = "name of a *SHAFT, *BEAM or *LAYER";

int deck_named_group(struct deck_reader *reader, const char *name, struct place place)
{
    int group = deck_find_group(reader, reader->job->rotor.ngroup, name, strlen(name));
    if (group < 0)
        deck_error(reader, place, "group %s is not defined, expected the %s", name, group_name);
    return group;
}

int deck_option_group(struct deck_reader *reader, const struct card *card, const char *option)
{
    const char *name = deck_option(reader, card, option, group_name);
    return name ? deck_named_group(reader, name, card_option(card, option)->value_place) : -1;
}

int deck_position(struct deck_reader *reader, const struct field *field, const char *what, double *z)
{
    const char *text = field->text;
    struct place place = field->place;
    const char *dot = strrchr(text, '.');
    double from = 0, to = reader->length;
    char *end;
    double in_si = field->in_si > 0 ? field->in_si : deck_in_si(reader, "m");
    *z = strtod(text, &end) * in_si;
    if (end == text || *end) {
        const char *which = text;
        int group = dot ? deck_find_group(reader, reader->job->rotor.ngroup, text, (size_t)(dot - text)) : -1;
        if (group >= 0) {
            rotor_group_span(&reader->job->rotor, group, &from, &to);
            which = dot + 1;
        }
        int is_start = same_text(which, "start"), is_end = same_text(which, "end");
        if (!is_start && !is_end) {
            deck_error(reader, place,
                       "'%s' is no position, expected %s: metres from the left end, start, end, or GROUP.start, GROUP.end", text,
                       what);
            return 1;
        }
        *z = is_start ? from : to;
    }
    /* a coordinate with six digits may end a little beyond the end of the rotor */
    if (!isfinite(*z) || *z < -1e-5 * reader->length || *z > reader->length * (1 + 1e-5)) {
        deck_error(reader, place, "%s %s %s lies outside the rotor, expected 0 to %.6g %s", what, text,
                   field->in_si > 0 ? "in the unit of its column" : deck_unit_name(reader, "m"), reader->length / in_si,
                   field->in_si > 0 ? "in that unit" : deck_unit_name(reader, "m"));
        return 1;
    }
    *z = fmin(fmax(*z, 0), reader->length);
    return 0;
}

int deck_option_position(struct deck_reader *reader, const struct card_option *option, const char *what, double *z)
{
    const struct field field = {option->value, option->value_place, 0};
    return deck_position(reader, &field, what, z);
}

const char *deck_option(struct deck_reader *reader, const struct card *card, const char *name, const char *expected)
{
    const struct card_option *option = card_option(card, name);
    if (option && *option->value)
        return option->value;
    deck_error(reader, option ? option->place : card->place, "*%s has no %s, expected %s=%s", card->name, name, name, expected);
    return NULL;
}

const char *deck_path(struct deck_reader *reader, const struct card *card, const struct card_option *option)
{
    int errors = reader->messages->errors;
    const char *path = deck_text_path(reader->pool, &reader->text, card, option, reader->messages);
    reader->out_of_memory |= path ? deck_text_add_file(reader->pool, &reader->text, path) : reader->messages->errors == errors;
    return path;
}

int deck_option_number(struct deck_reader *reader, const struct card_option *option, const char *unit, enum range range,
                       double *value)
{
    const struct field field = {option->value, option->value_place, 0};
    int bad = parse_number(reader, &field, option->name, range, value);
    if (!bad)
        *value *= deck_in_si(reader, unit);
    return bad;
}

int deck_option_integer(struct deck_reader *reader, const struct card_option *option, int least, int most, int *value)
{
    double number;
    if (deck_option_number(reader, option, "", ANY, &number))
        return 1;
    if (number != floor(number) || number < least || number > most) {
        deck_error(reader, option->value_place, "%s is %s, expected a whole number from %d to %d", option->name, option->value,
                   least, most);
        return 1;
    }
    *value = (int)number;
    return 0;
}

const char *const deck_answers[] = {"NO", "YES", NULL};

int deck_word(struct deck_reader *reader, const char *what, const char *text, struct place place, const char *const *words)
{
    char list[256] = "";
    for (int i = 0; words[i]; i++) {
        if (same_text(text, words[i]))
            return i;
        (void)snprintf(list + strlen(list), sizeof list - strlen(list), "%s%s", i ? ", " : "", words[i]);
    }
    deck_error(reader, place, "%s%s is not known, expected one of %s", what, text, list);
    return -1;
}

int deck_option_word(struct deck_reader *reader, const struct card_option *option, const char *const *words)
{
    char what[64];
    (void)snprintf(what, sizeof what, "%.60s=", option->name);
    return deck_word(reader, what, option->value, option->value_place, words);
}

int deck_lines(struct deck_reader *reader, const struct card *card, int least, int most, const char *layout)
{
    if (card->nline < least)
        deck_error(reader, card->place, "*%s has no data line, expected %s", card->name, layout);
    else if (card->nline > most)
        deck_error(reader, card->line[most].place, "*%s has a data line too many, expected %s", card->name, layout);
    return card->nline < most ? card->nline : most;
}
