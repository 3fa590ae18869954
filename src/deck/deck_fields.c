#include "deck/deck_row.h"

#include <ctype.h>
#include <strings.h>

int deck_say(struct deck_reader *reader, enum severity severity, struct place place, const char *format, ...)
{
    char text[1024], cell[TABLE_CELL_LENGTH];
    const char *name = NULL;
    va_list values;
    va_start(values, format);
    (void)vsnprintf(text, sizeof text, format, values);
    va_end(values);
    for (int i = 0; i < reader->text.ntable; i++)
        if (place.file == reader->text.table[i]->path)
            name = table_cell_name(place.line, place.column, cell);
    message_at(reader->messages, severity, place, "%s%s%s%s", text, name ? " (cell " : "", name ? name : "", name ? ")" : "");
    return 1;
}

void deck_add_place(struct deck_reader *reader, enum deck_places which, struct place place)
{
    (void)POOL_ADD(reader->pool, reader->place[which], reader->nplace[which], &place);
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
    if (end == text || *end)
        return deck_error(reader, place, "'%s' is not a number, expected one for %s", text, what);
    if (!isfinite(number) || (range == POSITIVE && number <= 0) || (range == NOT_NEGATIVE && number < 0))
        return deck_error(reader, place, "%s is %s, expected %s", what, text,
                          !isfinite(number)   ? "a finite number"
                          : range == POSITIVE ? "a number above zero"
                                              : "a number not below zero");
    if (!deck_is_usual(number) && (range != ANY || fabs(number) > DECK_MOST)) { /* a component of a shape may be rounding */
        return deck_error(reader, place, "%s is %s, expected a size from %g to %g%s", what, text, DECK_LEAST, DECK_MOST,
                          range == POSITIVE ? "" : ", or zero");
    }
    *value = number * (field->in_si > 0
                           ? field->in_si
                           : deck_in_si(reader, what)); /* only now: what follows from a bad length would be reported as well */
    deck_check_magnitude(reader, place, what, text, *value);
    return 0;
}

int deck_has(const struct data_line *line, int i)
{
    return i < line->count && *line->field[i].text;
}

/* Value i of a data line, NULL after an error where it is missing. */
static const struct field *value_at(struct deck_reader *reader, const struct data_line *line, int i, const char *what)
{
    if (deck_has(line, i))
        return &line->field[i];
    deck_error(reader, i < line->count ? line->field[i].place : line->end, "a value is missing, expected %s", what);
    return NULL;
}

int deck_number(struct deck_reader *reader, const struct data_line *line, int i, const char *what, enum range range,
                double *value)
{
    const struct field *field = value_at(reader, line, i, what);
    return !field || parse_number(reader, field, what, range, value);
}

static int parse_whole(struct deck_reader *reader, const struct field *field, const char *what, int least, int most, int *value)
{
    double number = 0;
    if (parse_number(reader, field, what, ANY, &number))
        return 1;
    if (number != floor(number) || number < least || number > most)
        return deck_error(reader, field->place, "%s is %s, expected a whole number from %d to %d", what, field->text, least,
                          most);
    *value = (int)number;
    return 0;
}

int deck_integer(struct deck_reader *reader, const struct data_line *line, int i, const char *what, int least, int most,
                 int *value)
{
    const struct field *field = value_at(reader, line, i, what);
    return !field || parse_whole(reader, field, what, least, most, value);
}

int deck_count(struct deck_reader *reader, const struct data_line *line, int most)
{
    if (line->count <= most)
        return 0;
    return deck_error(reader, line->field[most].place, "'%s' is one value too many, expected %s", line->field[most].text,
                      reader->layout);
}

int deck_find_group(const struct rotor *rotor, int count, const char *name, size_t length)
{
    for (int g = 0; g < count; g++) {
        const char *known = rotor->group[g].name;
        if (strlen(known) == length && !strncasecmp(known, name, length))
            return g;
    }
    return -1;
}

static const char group_name[] = "name of a *SHAFT, *BEAM or *LAYER";

int deck_named_group(struct deck_reader *reader, const char *name, struct place place)
{
    int group = deck_find_group(&reader->job->rotor, reader->job->rotor.ngroup, name, strlen(name));
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
        int group = dot ? deck_find_group(&reader->job->rotor, reader->job->rotor.ngroup, text, (size_t)(dot - text)) : -1;
        if (group >= 0) {
            rotor_group_span(&reader->job->rotor, group, &from, &to);
            which = dot + 1;
        }
        int is_start = same_text(which, "start"), is_end = same_text(which, "end");
        if (!is_start && !is_end)
            return deck_error(reader, place,
                              "'%s' is no position, expected %s: metres from the left end, start, end, or GROUP.start, GROUP.end",
                              text, what);
        *z = is_start ? from : to;
    }
    /* a coordinate with six digits may end a little beyond the end of the rotor */
    if (!isfinite(*z) || *z < -1e-5 * reader->length || *z > reader->length * (1 + 1e-5))
        return deck_error(reader, place, "%s %s %s lies outside the rotor, expected 0 to %.6g %s", what, text,
                          field->in_si > 0 ? "in the unit of its column" : deck_length_unit(reader), reader->length / in_si,
                          field->in_si > 0 ? "in that unit" : deck_length_unit(reader));
    *z = fmin(fmax(*z, 0), reader->length);
    return 0;
}

/* The value of an option as a field. */
#define FIELD_OF(option) ((struct field){(option)->value, (option)->value_place, 0})

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
    const char *path = deck_text_path(reader->pool, &reader->text, card, option, reader->messages);
    return path && !POOL_ADD(reader->pool, reader->text.file, reader->text.nfile, &path) ? path : NULL;
}

int deck_option_number(struct deck_reader *reader, const struct card_option *option, const char *unit, enum range range,
                       double *value)
{
    int bad = parse_number(reader, &FIELD_OF(option), option->name, range, value);
    if (!bad)
        *value *= deck_in_si(reader, unit);
    return bad;
}

const char *const deck_answers[] = {"NO", "YES", NULL};

/* Index of a text in a list of words that ends with NULL; -1 after an error that says "WHAT=text" or "WHATtext". */
static int parse_word(struct deck_reader *reader, const struct field *field, const char *what, const char *equals,
                      const char *const *words)
{
    char list[256] = "";
    for (int i = 0; words[i]; i++) {
        if (same_text(field->text, words[i]))
            return i;
        (void)snprintf(list + strlen(list), sizeof list - strlen(list), "%s%s", i ? ", " : "", words[i]);
    }
    return -deck_error(reader, field->place, "%s%s%s is not known, expected one of %s", what, equals, field->text, list);
}

int deck_option_word(struct deck_reader *reader, const struct card_option *option, const char *const *words)
{
    return parse_word(reader, &FIELD_OF(option), option->name, "=", words);
}

int deck_lines(struct deck_reader *reader, const struct card *card, int least, int most)
{
    if (card->nline < least)
        deck_error(reader, card->place, "*%s has no data line, expected %s", card->name, reader->layout);
    else if (card->nline > most)
        deck_error(reader, card->line[most].place, "*%s has a data line too many, expected %s", card->name, reader->layout);
    return card->nline < most ? card->nline : most;
}

const struct data_line *deck_only_line(struct deck_reader *reader, const struct card *card)
{
    return deck_lines(reader, card, 1, 1) == 1 ? &card->line[0] : NULL;
}

int deck_row_is_last(const struct deck_row *row)
{
    return !row->option && !row->what;
}

/* ---- reading */

static int read_material(struct deck_reader *reader, const struct field *field, struct material *material)
{
    int index = deck_named_material(reader, field->text, field->place);
    if (index < 0)
        return 1;
    if (reader->material[index].laminated)
        return deck_error(reader, field->place,
                          "material %s is a stack of sheets across the axis, expected one that rods are made of", field->text);
    *material = reader->material[index];
    return 0;
}

/* A value of a data line, or of an option; what: its name in messages. */
static int read_member(struct deck_reader *reader, const struct field *field, const char *what, const struct deck_row *row,
                       void *member)
{
    int index = 0;
    switch (row->kind) {
    case ROW_NAME:
        *(const char **)member = field->text;
        return 0;
    case ROW_GROUP:
        return (*(int *)member = deck_named_group(reader, field->text, field->place)) < 0;
    case ROW_MATERIAL:
        return read_material(reader, field, member);
    case ROW_WORD:
        index = parse_word(reader, field, what, row->option ? "=" : "", row->words);
        *(int *)member = index < 0 ? *(int *)member : index;
        return index < 0;
    case ROW_WHOLE:
        return parse_whole(reader, field, what, row->least, row->most, member);
    case ROW_POSITION:
        return deck_position(reader, field, row->option ? row->option : what, member);
    default:
        if (parse_number(reader, field, what, row->range, member))
            return 1;
        *(double *)member *= row->option ? deck_in_si(reader, row->what) : 1;
        *(double *)member *= row->factor > 0 ? row->factor : 1;
        return 0;
    }
}

static int read_option(struct deck_reader *reader, const struct card *card, const struct deck_row *row, void *member)
{
    const struct card_option *option = card_option(card, row->option);
    int may_lack = row->bits & ROW_MAY_LACK,
        is_text = row->kind == ROW_NAME || row->kind == ROW_GROUP || row->kind == ROW_MATERIAL;
    if (!option && row->kind == ROW_WORD && !may_lack)
        *(int *)member = row->standard;
    if (!option && (may_lack || row->kind == ROW_WORD))
        return 0;
    if (!option || (is_text && !may_lack && !*option->value))
        return !deck_option(reader, card, row->option, row->kind == ROW_GROUP ? group_name : row->what);
    return read_member(reader, &FIELD_OF(option), option->name, row, member);
}

int deck_read_options(struct deck_reader *reader, const struct card *card, void *to)
{
    int bad = 0;
    for (const struct deck_row *row = reader->row; !deck_row_is_last(row); row++)
        if (row->option && row->kind != ROW_OTHER)
            bad |= read_option(reader, card, row, (char *)to + row->offset);
    return bad;
}

/* Value i of a data line. 0, or 1 after an error. */
static int read_value(struct deck_reader *reader, const struct data_line *line, int i, const struct deck_row *row, char *to)
{
    void *member = to + row->offset;
    if (row->bits & ROW_MAY_LACK && !deck_has(line, i)) {
        if (row->kind == ROW_WHOLE)
            *(int *)member = row->standard;
        else if (row->as)
            *(double *)member = *(const double *)(to + row->as);
        return 0;
    }
    if ((i || row->kind == ROW_NUMBER || row->kind == ROW_WHOLE) && !value_at(reader, line, i, row->what))
        return 1;
    return read_member(reader, &line->field[i], row->what, row, member);
}

int deck_read_values(struct deck_reader *reader, const struct data_line *line, void *to)
{
    int count = 0, bad = 0, i = 0;
    for (const struct deck_row *row = reader->row; !deck_row_is_last(row); row++)
        count += !row->option;
    if (deck_count(reader, line, count))
        return 1;
    for (const struct deck_row *row = reader->row; !deck_row_is_last(row); row++)
        if (!row->option)
            bad |= read_value(reader, line, i++, row, to);
    return bad;
}

/* The values of each line over those of the options, which are read once. */
static void read_list(struct deck_reader *reader, const struct card *card, const struct deck_card *kind)
{
    char *owner = kind->states == CARD_OF_MACHINE ? (char *)reader->machine : (char *)&reader->job->rotor,
         *item = pool_get(reader->pool, 2, kind->size), *of_card = item + kind->size;
    if (!item)
        return;
    int bad = deck_read_options(reader, card, of_card),
        most = kind->single || (kind->row->kind == ROW_NAME && card_option(card, "NAME")) ? 1 : DECK_MOST_LINES;
    for (int i = 0, lines = deck_lines(reader, card, 1, most); i < lines; i++) {
        memcpy(item, of_card, kind->size);
        if (deck_read_values(reader, &card->line[i], item) || bad || (kind->check && kind->check(reader, &card->line[i], item)))
            continue;
        if (kind->places)
            deck_add_place(reader, kind->places, kind->single ? card->place : card->line[i].place);
        (void)pool_add(reader->pool, (void **)(owner + kind->list), (int *)(owner + kind->count), kind->size, item);
    }
}

/* "1, 435,5": some commas with a blank behind them, one between digits, and no point anywhere */
static int has_decimal_comma(const char *text)
{
    int wide = 0, narrow = 0;
    for (const char *c = strchr(text, ','); c; c = strchr(c + 1, ',')) {
        wide |= c[1] == ' ' || c[1] == '\t';
        narrow |= c > text && isdigit((unsigned char)c[-1]) && isdigit((unsigned char)c[1]);
    }
    return wide && narrow && !strchr(text, '.') && !strpbrk(text, "eE");
}

static void doubt_commas(struct deck_reader *reader, const struct card *card)
{
    for (int i = 0; i < card->nline; i++)
        if (strchr(card->line[i].text, ';')) {
            deck_note(reader, card->line[i].place, "'%s': commas separate the values of a line, expected no semicolon",
                      card->line[i].text);
            return;
        } else if (has_decimal_comma(card->line[i].text)) {
            deck_note(reader, card->line[i].place,
                      "'%s': a decimal comma? Numbers have a decimal point, and commas separate them", card->line[i].text);
            return;
        }
}

void deck_read_card(struct deck_reader *reader, const struct card *card, const struct deck_card *kind)
{
    for (int i = 0; i < card->nline && kind->instead; i++)
        deck_error(reader, card->line[i].place, "*%s has no data lines, expected %s", card->name, kind->instead);
    if (kind->once && reader->seen[kind - deck_card_table]++) {
        deck_error(reader, card->place, "*%s is given twice, expected once", card->name);
        return;
    }
    reader->card = card;
    reader->layout = kind->lines;
    reader->row = kind->row;
    if (kind->read != deck_heading)
        doubt_commas(reader, card);
    if (kind->read)
        kind->read(reader, card);
    else
        read_list(reader, card, kind);
}

/* ---- rounding */

int deck_is_near(double a, double b)
{
    return a == b || fabs(a - b) <= DECK_ROUNDING * fmax(fabs(a), fabs(b)) || (isnan(a) && isnan(b));
}

int deck_clip(double lower, double upper, double *value)
{
    if (*value < lower && deck_is_near(*value, lower))
        *value = lower;
    if (*value > upper && deck_is_near(*value, upper))
        *value = upper;
    return *value >= lower && *value <= upper;
}
