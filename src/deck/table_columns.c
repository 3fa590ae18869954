#include "deck/table_columns.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define NAME_LENGTH 64

#define NOTHING                                                                                                                  \
    {                                                                                                                            \
        NULL, NULL, 0                                                                                                            \
    }

/* clang-format off */
const struct table_kind table_kinds[] = {
    {"MODES", 0,
     {{"mode|mode number|number|no", NULL, 0},
      {"frequency|f|freq|natural frequency|eigenfrequency", "Hz", 0},
      {"damping|damping ratio|zeta", "1", 1},
      {"std|standard deviation|frequency std|std frequency|sigma", "Hz", 1}, NOTHING}, {NOTHING}},
    {"SENSORS", 0,
     {{"sensor|sensor id|point|node|id", NULL, 0}, {"position|z", "m", 0}, NOTHING}, {NOTHING}},
    {"SHAPE", 1,
     {{"sensor|sensor id|point|node|id", NULL, 0}, {"value|component|shape", NULL, 0},
      {"std|standard deviation|sigma", NULL, 1}, NOTHING},
     {{"mode|mode number|number|no", NULL, 0}, NOTHING}},
    {"FREQUENCIES", 1,
     {{"sensor|sensor id|point|node|id", NULL, 0}, {"frequency|f|freq|value", "Hz", 0},
      {"std|standard deviation|sigma|frequency std", "Hz", 1}, NOTHING},
     {{"mode|mode number|number|no", NULL, 0}, NOTHING}},
    {"SHAFT", 0,
     {{"length|l", "m", 0},
      {"outer diameter|outer|od|diameter|d", "m", 0},
      {"inner diameter|inner|id|bore", "m", 0},
      {"elements|number of elements", NULL, 1},
      {"stiffness diameter|stiff outer diameter|stiffness outer diameter", "m", 1}, NOTHING},
     {{"group|name|section", NULL, 1}, {"material", NULL, 1}, NOTHING}},
    {"BEAM", 0,
     {{"length|l", "m", 0}, {"height|h", "m", 0}, {"width|b|w", "m", 0}, {"elements|number of elements", NULL, 1}, NOTHING},
     {{"group|name|section", NULL, 1}, {"material", NULL, 1}, NOTHING}},
    {NULL, 0, {NOTHING}, {NOTHING}}};
/* clang-format on */

const struct table_kind *table_kind_of(const char *card)
{
    const struct table_kind *kind = table_kinds;
    while (kind->card && strcmp(kind->card, card) != 0)
        kind++;
    return kind->card ? kind : NULL;
}

int table_has_header(const struct table_text *table)
{
    return !table_is_number(table->row[0].field[0].text);
}

/* Lower case, one blank for blanks and underscores, without a dot at the end; what stands in brackets goes into `unit`. */
static void normalise(const char *text, char name[NAME_LENGTH], char unit[TABLE_CELL_LENGTH])
{
    size_t length = 0, units = 0;
    int inside = 0;
    for (; *text; text++) {
        char c = *text == '_' ? ' ' : (char)tolower((unsigned char)*text);
        if (c == '[' || c == '(') {
            inside = 1;
            units = 0;
        } else if (c == ']' || c == ')') {
            inside = 0;
        } else if (inside && units + 1 < TABLE_CELL_LENGTH) {
            unit[units++] = *text;
        } else if (!inside && length + 1 < NAME_LENGTH && (c != ' ' || (length && name[length - 1] != ' '))) {
            name[length++] = c;
        }
    }
    while (length && (name[length - 1] == ' ' || name[length - 1] == '.'))
        length--;
    name[length] = 0;
    unit[units] = 0;
}

static int is_listed(const char *name, const char *list)
{
    size_t length = strlen(name);
    for (const char *at = list; length && (at = strstr(at, name)); at++)
        if ((at == list || at[-1] == '|') && (at[length] == '|' || !at[length]))
            return 1;
    return 0;
}

int table_names(const char *text, const struct csv_column *column, char unit[TABLE_CELL_LENGTH])
{
    char name[NAME_LENGTH], *last;
    normalise(text, name, unit);
    if (is_listed(name, column->names))
        return 1;
    last = strrchr(name, ' '); /* frequency_hz */
    if (*unit || !last || !column->si || !(deck_unit_factor(column->si, last + 1) > 0))
        return 0;
    (void)snprintf(unit, TABLE_CELL_LENGTH, "%s", last + 1);
    *last = 0;
    return is_listed(name, column->names);
}

int table_numbers(const char *text, struct table_numbered *numbered)
{
    static const char words[] = "mode|sensor|point|node|channel|std|standard|deviation|of|no|shape|component|frequency|hz";
    char name[NAME_LENGTH], unit[TABLE_CELL_LENGTH];
    int numbers = 0;
    *numbered = (struct table_numbered){0};
    normalise(text, name, unit);
    for (char *word = name, *next; word; word = next) {
        next = strchr(word, ' ');
        if (next)
            *next++ = 0;
        size_t digits = strspn(word, "0123456789");
        if (digits && !word[digits] && digits < 10) {
            numbered->number = atoi(word);
            numbers++;
        } else if (!is_listed(word, words)) {
            return 0;
        }
        numbered->of_mode |= !strcmp(word, "mode");
        numbered->of_sensor |= is_listed(word, "sensor|point|node|channel");
        numbered->is_std |= is_listed(word, "std|deviation");
    }
    return numbers == 1;
}

/* Whether any card has a column of that name, or a table that rotid has written. */
static int is_known(const char *name)
{
    static const struct csv_column written = {"condensed|reduction|mesh|measured|error|nco|x|y", NULL, 0};
    char unit[TABLE_CELL_LENGTH];
    struct table_numbered numbered;
    for (const struct table_kind *kind = table_kinds; kind->card; kind++) {
        for (const struct csv_column *c = kind->value; c->names; c++)
            if (table_names(name, c, unit))
                return 1;
        for (const struct csv_column *c = kind->key; c->names; c++)
            if (table_names(name, c, unit))
                return 1;
    }
    return table_names(name, &written, unit) || table_numbers(name, &numbered);
}

/* The column of the header that is called so, -1: none, -2 after an error. */
static int find_column(struct deck_reader *reader, const struct data_line *header, const struct csv_column *column,
                       double *in_si)
{
    int found = -1;
    for (int i = 0; i < header->count; i++) {
        char unit[TABLE_CELL_LENGTH];
        const struct field *field = &header->field[i];
        if (!table_names(field->text, column, unit))
            continue;
        if (found >= 0) {
            deck_error(reader, field->place, "'%s' is a second column of the %.*s, expected one", field->text,
                       (int)strcspn(column->names, "|"), column->names);
            return -2;
        }
        found = i;
        if (*unit && column->si && !((*in_si = deck_unit_factor(column->si, unit)) > 0)) {
            deck_error(reader, field->place, "the unit of '%s' is not known, expected %s or another one of *UNITS", field->text,
                       strcmp(column->si, "1") != 0 ? column->si : "%");
            return -2;
        }
    }
    return found;
}

static void list_names(const struct table_kind *kind, int length, char *list)
{
    *list = 0;
    for (const struct csv_column *c = kind->key; c->names; c++)
        (void)snprintf(list + strlen(list), (size_t)length - strlen(list), "%.*s, ", (int)strcspn(c->names, "|"), c->names);
    for (const struct csv_column *c = kind->value; c->names; c++)
        (void)snprintf(list + strlen(list), (size_t)length - strlen(list), "%s%.*s", c == kind->value ? "" : ", ",
                       (int)strcspn(c->names, "|"), c->names);
}

int table_find_columns(struct deck_reader *reader, const struct table_text *table, const struct table_kind *kind, int values,
                       struct table_columns *columns)
{
    const struct data_line *header = &table->row[0];
    char list[256];
    *columns = (struct table_columns){.header = table_has_header(table)};
    list_names(kind, sizeof list, list);
    for (int k = 0; kind->key[k].names; k++) {
        double none; /* no key has a unit */
        columns->key[k] = columns->header ? find_column(reader, header, &kind->key[k], &none) : -1;
        if (columns->key[k] == -2)
            return 1;
    }
    for (int v = 0; kind->value[v].names; v++) {
        columns->value[v] = columns->header ? find_column(reader, header, &kind->value[v], &columns->in_si[v]) : v;
        if (columns->value[v] == -2)
            return 1;
        if (values && columns->value[v] < 0 && !kind->value[v].may_lack) {
            deck_error(reader, header->place, "the first row names no column '%.*s', expected names such as %s",
                       (int)strcspn(kind->value[v].names, "|"), kind->value[v].names, list);
            return 1;
        }
    }
    char unread[256] = "";
    int first = -1;
    for (int i = 0; i < header->count && columns->header; i++)
        if (*header->field[i].text && !is_known(header->field[i].text)) {
            (void)snprintf(unread + strlen(unread), sizeof unread - strlen(unread), "%s'%s'", first < 0 ? "" : ", ",
                           header->field[i].text);
            first = first < 0 ? i : first;
        }
    if (first >= 0)
        deck_note(reader, header->field[first].place, "*%s does not read %s, expected columns such as %s", kind->card, unread,
                  list);
    return 0;
}
