/* FILE on *MODES, *SENSORS, *SHAPE, *FREQUENCIES, *SHAFT and *BEAM: a table in the place of data lines. What is read of it
 * becomes data lines whose places are rows and columns of the table, so the readers of the cards judge them like any others. */
#include <ctype.h>

#include "deck/deck.h"

#define NAME_LENGTH 64

/* Which column of a table holds what: by the names in its first row, or, where that begins with a number, by their order. */

#define TABLE_MOST_VALUES 8 /* with keys */

struct csv_column {
    const char *names; /* in lower case, separated by bars; the first is that of messages */
    const char *si;    /* unit that its numbers have inside, as for deck_unit_factor; NULL: none */
    int may_lack;
};

/* What the columns of a card are called. */
struct table_kind {
    const char *card;
    int by_mode; /* it has a card for each mode: the table may hold a value for each mode and sensor */
    int nkey;    /* the first columns say what a row is of; the others are the values of a data line, in its order */
    struct csv_column column[TABLE_MOST_VALUES + 1]; /* ended by one without names */
};

/* A column called "mode 3", "3", "sensor 7", "mode 3 std". */
struct table_numbered {
    int number;
    int of_mode, of_sensor, is_std; /* as the name says */
};

struct table_columns {
    int header;                          /* the first row names the columns */
    int at[TABLE_MOST_VALUES + 1];       /* index of a column, -1: there is none */
    double in_si[TABLE_MOST_VALUES + 1]; /* of a unit in the header, 0: none there */
};

/* clang-format off */
static const struct table_kind table_kinds[] = { /* ended by one without card */
    {"MODES", 0, 0,
     {{"mode|mode number|number|no", NULL, 0},
      {"frequency|f|freq|natural frequency|eigenfrequency", "Hz", 0},
      {"damping|damping ratio|zeta", "1", 1},
      {"std|standard deviation|frequency std|std frequency|sigma", "Hz", 1}}},
    {"SENSORS", 0, 0, {{"sensor|sensor id|point|node|id", NULL, 0}, {"position|z", "m", 0}}},
    {"SHAPE", 1, 1,
     {{"mode|mode number|number|no", NULL, 0},
      {"sensor|sensor id|point|node|id", NULL, 0}, {"value|component|shape", NULL, 0}, {"std|standard deviation|sigma", NULL, 1}}},
    {"FREQUENCIES", 1, 1,
     {{"mode|mode number|number|no", NULL, 0},
      {"sensor|sensor id|point|node|id", NULL, 0}, {"frequency|f|freq|value", "Hz", 0},
      {"std|standard deviation|sigma|frequency std", "Hz", 1}}},
    {"SHAFT", 0, 2,
     {{"group|name|section", NULL, 1}, {"material", NULL, 1},
      {"length|l", "m", 0},
      {"outer diameter|outer|od|diameter|d", "m", 0},
      {"inner diameter|inner|id|bore|bore diameter", "m", 1},
      {"elements|number of elements", NULL, 1},
      {"stiffness diameter|stiff outer diameter|stiffness outer diameter", "m", 1}}},
    {"BEAM", 0, 2,
     {{"group|name|section", NULL, 1}, {"material", NULL, 1},
      {"length|l", "m", 0}, {"height|h", "m", 0}, {"width|b|w", "m", 0}, {"elements|number of elements", NULL, 1}}},
    {.card = NULL}};
/* clang-format on */

static const struct table_kind *table_kind_of(const char *card)
{
    const struct table_kind *kind = table_kinds;
    while (kind->card && strcmp(kind->card, card) != 0)
        kind++;
    return kind->card ? kind : NULL;
}

/* Whether the first row names columns: its first cell is no number. */
static int table_has_header(const struct table_text *table)
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

/* Whether a name of the header is that of a column; *unit: what stands in brackets or behind it, "" where nothing does. */
static int table_names(const char *text, const struct csv_column *column, char unit[TABLE_CELL_LENGTH])
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

/* Whether it is a numbered one. */
static int table_numbers(const char *text, struct table_numbered *numbered)
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
    for (const struct table_kind *kind = table_kinds; kind->card; kind++)
        for (const struct csv_column *c = kind->column; c->names; c++)
            if (table_names(name, c, unit))
                return 1;
    return table_names(name, &written, unit) || table_numbers(name, &numbered);
}

/* The column of the header that is called so, -1: none, -2 after an error. */
static int find_column(struct deck_reader *reader, const struct data_line *header, const struct csv_column *column, double *in_si)
{
    int found = -1;
    for (int i = 0; i < header->count; i++) {
        char unit[TABLE_CELL_LENGTH];
        const struct field *field = &header->field[i];
        if (!table_names(field->text, column, unit))
            continue;
        if (found >= 0)
            return -1 - deck_error(reader, field->place, "'%s' is a second column of the %.*s, expected one", field->text,
                                   (int)strcspn(column->names, "|"), column->names);
        found = i;
        if (*unit && column->si && !((*in_si = deck_unit_factor(column->si, unit)) > 0))
            return -1 - deck_error(reader, field->place, "the unit of '%s' is not known, expected %s or another one of *UNITS",
                                   field->text, strcmp(column->si, "1") != 0 ? column->si : "%");
    }
    return found;
}

/* Finds the columns of a kind. 0, or 1 after an error; a column that no card knows is told of. `values`: those of data lines that
 * may not lack are asked for. */
static int table_find_columns(struct deck_reader *reader, const struct table_text *table, const struct table_kind *kind,
                              int values, struct table_columns *columns)
{
    const struct data_line *header = &table->row[0];
    char list[256] = "", unread[256] = "";
    int first = -1;
    *columns = (struct table_columns){.header = table_has_header(table)};
    for (const struct csv_column *c = kind->column; c->names; c++)
        (void)snprintf(list + strlen(list), sizeof list - strlen(list), "%s%.*s", *list ? ", " : "", (int)strcspn(c->names, "|"),
                       c->names);
    for (int k = 0; kind->column[k].names; k++) {
        const struct csv_column *c = &kind->column[k];
        int value = k - kind->nkey, *at = &columns->at[k];
        *at = columns->header ? find_column(reader, header, c, &columns->in_si[k]) : value < 0 ? -1 : value;
        if (*at == -2)
            return 1;
        if (values && *at < 0 && value >= 0 && !c->may_lack)
            return deck_error(reader, header->place, "the first row names no column '%.*s', expected names such as %s",
                              (int)strcspn(c->names, "|"), c->names, list);
    }
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

struct taking {
    struct deck_reader *reader;
    const struct card *card; /* that names the table */
    struct table_text *table;
    const struct table_kind *kind;
    struct table_columns columns;
    struct deck_text *to;         /* cards go there */
    int first;                    /* the cards of this table begin there */
    double mode[DECK_MOST_MODES]; /* of each of them, where it has one */
    double asked;                 /* MODE of the card, NaN where all modes of the table are taken */
};

/* A number without a name above it: 0,25 between commas is two cells, and what stands behind it moves by a column. */
static int has_nameless_number(struct deck_reader *reader, const struct table_text *table)
{
    int names = table->row[0].count;
    while (names && !*table->row[0].field[names - 1].text)
        names--;
    for (int r = 1; r < table->nrow && table_has_header(table); r++)
        for (int i = names; i < table->row[r].count; i++)
            if (table_is_number(table->row[r].field[i].text))
                return deck_error(
                    reader, table->row[r].field[i].place,
                    "'%s' stands behind the %d columns that have a name, expected none there: a decimal comma between "
                    "cells separated by commas?",
                    table->row[r].field[i].text, names);
    return 0;
}

struct table_text *deck_open_table(struct deck_reader *reader, const struct card *card)
{
    struct deck_text *text = &reader->text;
    const struct card_option *file = card_option(card, "FILE");
    if (!deck_option(reader, card, "FILE", "path of a table"))
        return NULL;
    const char *path = deck_text_path(reader->pool, text, card, file, reader->messages);
    for (int i = 0; i < text->ntable && path; i++)
        if (!strcmp(text->table[i]->path, path))
            return text->table[i];
    if (path && text->ntable == TABLE_MOST_TABLES) {
        deck_error(reader, file->value_place, "the deck reads more than %d tables, expected fewer", TABLE_MOST_TABLES);
        return NULL;
    }
    struct table_text *table = path ? POOL_NEW(reader->pool, struct table_text) : NULL;
    if (!table || POOL_ADD(reader->pool, text->file, text->nfile, &path))
        return NULL;
    int status = table_text_read(reader->pool, path, file->value_place, reader->messages, table);
    reader->pool->out_of_memory |= status == ROTID_ERROR_MEMORY;
    table->bad = status != ROTID_OK || has_nameless_number(reader, table);
    return POOL_ADD(reader->pool, text->table, text->ntable, &table) ? NULL : table;
}

static struct card *new_card(struct taking *t, struct place place)
{
    struct card *card = NULL;
    t->table->bad |= t->to->ncard >= DECK_MOST_CARDS; /* said once a table */
    if (t->to->ncard >= DECK_MOST_CARDS)
        deck_error(t->reader, place, "the deck has more than %d cards with those of the table, expected fewer", DECK_MOST_CARDS);
    else
        card = deck_text_add_card(t->reader->pool, t->to, t->card->name, place);
    return card;
}

static void add_option(struct taking *t, struct card *card, const char *name, const struct field *value)
{
    struct card_option option = {.name = name, .value = value->text, .place = value->place, .value_place = value->place};
    (void)deck_text_add_option(t->reader->pool, card, option);
}

/* 0, or 1 where memory is out. */
static int add_line(struct taking *t, struct card *card, struct place row, int count, const struct field *field)
{
    struct field *copy = POOL_COPY(t->reader->pool, field, count, 0);
    if (!copy)
        return 1;
    const struct data_line line = {
        .place = row, .end = {row.file, row.line, field[count - 1].place.column + 1}, .text = "", .count = count, .field = copy};
    return POOL_ADD(t->reader->pool, card->line, card->nline, &line);
}

/* The cell of a column, -1: none, in a row, blank where there is none. */
static struct field cell_of(const struct data_line *row, int column)
{
    if (column >= 0 && column < row->count)
        return row->field[column];
    return (struct field){"", {row->place.file, row->place.line, column < 0 ? 1 : column + 1}, 0};
}

/* Counts a row that a card takes: 0 where all cards together take too many, which is said once a table. */
static int may_take(struct taking *t)
{
    if (t->reader->taken < TABLE_MOST_TAKEN) {
        t->reader->taken++;
        return 1;
    }
    if (!t->table->bad)
        deck_error(t->reader, t->card->place, "the cards of the deck take more than %d rows of tables, expected fewer",
                   TABLE_MOST_TAKEN);
    t->table->bad = 1;
    return 0;
}

/* The values of a row in the order of a data line. */
static int values_of(const struct taking *t, const struct data_line *row, struct field *field)
{
    int count = 0, filled = 0, first = t->kind->nkey;
    for (; t->kind->column[first + count].names; count++) {
        field[count] = cell_of(row, t->columns.at[first + count]);
        field[count].in_si = t->columns.in_si[first + count];
        filled = *field[count].text ? count + 1 : filled;
    }
    for (int i = count; i < row->count && !t->columns.header; i++) /* without names all of them are values */
        if (*row->field[i].text)
            deck_error(t->reader, row->field[i].place,
                       "'%s' is one value too many, expected %d of *%s, or names in the first row", row->field[i].text, count,
                       t->card->name);
    return filled ? filled : 1;
}

/* ---- one card */

static void take_rows(struct taking *t)
{
    struct card *card = new_card(t, t->card->place);
    if (!card)
        return;
    card->option = t->card->option;
    card->noption = t->card->noption;
    for (int r = t->columns.header; r < t->table->nrow && may_take(t); r++) {
        struct field field[TABLE_MOST_VALUES] = {{.text = ""}};
        int count = values_of(t, &t->table->row[r], field);
        if (add_line(t, card, t->table->row[r].place, count, field))
            return;
    }
}

/* ---- sections: a card for each group */

static void take_sections(struct taking *t)
{
    struct deck_reader *reader = t->reader;
    const struct card_option *named = card_option(t->card, "NAME"), *given = card_option(t->card, "MATERIAL");
    const char *group = NULL, *material = NULL;
    struct card *card = NULL;
    if (t->columns.at[0] < 0 && t->columns.at[1] < 0) {
        take_rows(t);
        return;
    }
    if (named && t->columns.at[0] >= 0) {
        deck_error(reader, named->place, "*%s has a NAME and its table a column of groups, expected one of them", t->card->name);
        return;
    }
    for (int r = 1, bad = 0; r < t->table->nrow && !bad && !reader->pool->out_of_memory && may_take(t); r++) {
        const struct data_line *row = &t->table->row[r];
        struct field name = cell_of(row, t->columns.at[0]), of = cell_of(row, t->columns.at[1]),
                     field[TABLE_MOST_VALUES] = {{.text = ""}};
        int count = values_of(t, row, field), is_new = !group || (*name.text && !same_text(name.text, group));
        if (is_new && named)
            name = (struct field){named->value, named->value_place, 0};
        if (is_new && strpbrk(name.text, ",*"))
            bad = deck_error(reader, name.place, "'%s' is no name of a group, expected one without commas and asterisks",
                             name.text);
        else if (is_new && !*name.text)
            bad = deck_error(reader, name.place, "the first section has no group, expected its name, or NAME on *%s",
                             t->card->name);
        else if (!is_new && *of.text && !same_text(of.text, material))
            bad =
                deck_error(reader, of.place, "material %s stands within group %s, which is of %s, expected one material a group",
                           of.text, group, *material ? material : "another one");
        else if (is_new && (card = new_card(t, name.place))) {
            add_option(t, card, "NAME", &name);
            if (*of.text)
                add_option(t, card, "MATERIAL", &of);
            else if (given)
                (void)deck_text_add_option(reader->pool, card, *given);
            group = name.text;
            material = of.text;
        }
        bad = bad || !card || add_line(t, card, row->place, count, field);
    }
}

/* ---- a value for each mode and sensor: a card for each mode */

/* The card of the mode that a cell names; NULL where the card asks for another one, or after an error. */
static struct card *card_of_mode(struct taking *t, const struct field *mode)
{
    double number = strtod(mode->text, NULL);
    if (!isnan(t->asked) && t->asked != number)
        return NULL;
    int count = t->to->ncard - t->first;
    for (int c = 0; c < count; c++)
        if (t->mode[c] == number)
            return &t->to->card[t->first + c];
    if (count == DECK_MOST_MODES) {
        deck_error(t->reader, mode->place, "the table has more than %d modes, expected fewer", DECK_MOST_MODES);
        t->table->bad = 1;
    }
    struct card *card = count < DECK_MOST_MODES ? new_card(t, mode->place) : NULL;
    if (!card)
        return NULL;
    t->mode[count] = number;
    for (int o = 0; o < t->card->noption; o++)
        if (!same_text(t->card->option[o].name, "MODE"))
            (void)deck_text_add_option(t->reader->pool, card, t->card->option[o]);
    add_option(t, card, "MODE", mode);
    return card;
}

static void take_value(struct taking *t, const struct data_line *row, const struct field *mode, const struct field *sensor,
                       const struct field *value, const struct field *std)
{
    if (!*value->text) /* not measured */
        return;
    if (!table_is_number(mode->text)) {
        deck_error(t->reader, mode->place, "'%s' is not a number, expected that of a mode", mode->text);
        return;
    }
    struct card *card = card_of_mode(t, mode);
    const struct field field[] = {*sensor, *value, *std};
    if (card)
        (void)add_line(t, card, row->place, *std->text ? 3 : 2, field);
}

/* The numbers of the column that names the mode of each row, read once however many cards ask for a mode of it. */
static const double *modes_of_rows(struct taking *t, int column)
{
    struct table_text *table = t->table;
    if (table->number)
        return table->number;
    table->number = POOL_ARRAY(t->reader->pool, double, table->nrow);
    for (int r = 1; r < table->nrow && table->number; r++) {
        const char *text = cell_of(&table->row[r], column).text;
        table->number[r] = table_is_number(text) ? strtod(text, NULL) : (double)NAN;
    }
    return table->number;
}

/* Values in a column, their deviations in column `std`, of mode and sensor as their columns say; where these are -1: `fixed`. */
static void take_column(struct taking *t, int of_mode, int of_sensor, struct field fixed, int column, int std,
                        const double in_si[2])
{
    const double *number = of_mode >= 0 && !isnan(t->asked) ? modes_of_rows(t, of_mode) : NULL;
    for (int r = 1; r < t->table->nrow && !t->reader->pool->out_of_memory && !t->table->bad; r++) {
        if (number && !isnan(number[r]) && number[r] != t->asked)
            continue;
        if (!may_take(t))
            return;
        const struct data_line *row = &t->table->row[r];
        struct field mode = of_mode < 0 ? fixed : cell_of(row, of_mode), sensor = of_sensor < 0 ? fixed : cell_of(row, of_sensor),
                     value = cell_of(row, column), deviation = cell_of(row, std);
        value.in_si = in_si[0];
        deviation.in_si = in_si[1];
        take_value(t, row, &mode, &sensor, &value, &deviation);
    }
}

/* Sensors in rows and modes in columns (of_modes), or the other way; of_rows: the column that says of which each row is. */
static void take_matrix(struct taking *t, int of_rows, int of_modes)
{
    const struct data_line *header = &t->table->row[0];
    const struct csv_column plain = {"", t->kind->column[2].si, 0};
    struct table_numbered *column = POOL_ARRAY(t->reader->pool, struct table_numbered, header->count);
    int any_std = 0;
    for (int i = 0; i < header->count && column; i++) {
        if (!table_numbers(header->field[i].text, &column[i]) || (of_modes ? column[i].of_sensor : column[i].of_mode))
            column[i].number = -1;
        any_std |= column[i].is_std;
    }
    for (int i = 0; i < header->count && column; i++) {
        const struct field *name = &header->field[i];
        char unit[TABLE_CELL_LENGTH];
        double in_si[2] = {0};
        int std = -1;
        if (column[i].number < 0 || column[i].is_std || i == of_rows ||
            (of_modes && !isnan(t->asked) && column[i].number != t->asked))
            continue;
        for (int j = 0; j < header->count && any_std; j++)
            std = column[j].is_std && column[j].number == column[i].number ? j : std;
        (void)table_names(name->text, &plain, unit);
        if (plain.si && *unit && !((in_si[0] = in_si[1] = deck_unit_factor(plain.si, unit)) > 0)) {
            deck_error(t->reader, name->place, "the unit of '%s' is not known, expected %s or another one of *UNITS", name->text,
                       plain.si);
            continue;
        }
        const struct field numbered = {pool_format(t->reader->pool, "%d", column[i].number), name->place, 0};
        take_column(t, of_modes ? -1 : of_rows, of_modes ? of_rows : -1, numbered, i, std, in_si);
    }
}

static void take_shapes(struct taking *t)
{
    const struct table_columns *c = &t->columns;
    const int *mode = &c->at[0], *sensor = &c->at[1], *value = &c->at[2];
    const struct card_option *asked = card_option(t->card, "MODE");
    const struct field only = {asked ? asked->value : "", asked ? asked->value_place : t->card->place, 0};
    struct deck_reader *reader = t->reader;
    if (!c->header && asked)
        take_rows(t);
    else if (c->header && *sensor >= 0 && *value >= 0 && (*mode >= 0 || asked))
        take_column(t, *mode, *sensor, only, *value, c->at[3], &c->in_si[2]);
    else if (c->header && (*sensor >= 0) != (*mode >= 0))
        take_matrix(t, *sensor >= 0 ? *sensor : *mode, *sensor >= 0);
    else
        deck_error(reader, t->table->row[0].place,
                   "the first row does not say what the table of *%s holds, expected names: sensor, mode 1, mode 2, ... or mode, "
                   "sensor 1, sensor 2, ... or mode, sensor, value",
                   t->card->name);
    if (t->to->ncard == t->first && !reader->messages->errors)
        deck_error(reader, t->table->row[0].place, "the table holds no value for *%s, expected one in a column such as 'mode 1'",
                   t->card->name);
}

static void take_table(struct deck_reader *reader, const struct card *card, const struct table_kind *kind, struct deck_text *to)
{
    const struct card_option *mode = card_option(card, "MODE");
    struct taking t = {.reader = reader, .card = card, .kind = kind, .to = to, .first = to->ncard};
    t.asked = mode ? strtod(mode->value, NULL) : (double)NAN;
    if (card->nline) {
        deck_error(reader, card->line[0].place, "*%s has a FILE and data lines, expected one of them", card->name);
        return;
    }
    t.table = deck_open_table(reader, card);
    if (!t.table || t.table->bad || table_find_columns(reader, t.table, kind, !kind->by_mode, &t.columns))
        return;
    if (kind->by_mode)
        take_shapes(&t);
    else if (kind->nkey)
        take_sections(&t);
    else
        take_rows(&t);
}

int deck_read_tables(struct deck_reader *reader, int *nread)
{
    struct deck_text *text = &reader->text, to = {0};
    int before = reader->messages->errors, front = *nread;
    for (int c = 0; c < text->ncard && !reader->pool->out_of_memory; c++) {
        const struct card *card = &text->card[c];
        const struct table_kind *kind = card_option(card, "FILE") ? table_kind_of(card->name) : NULL;
        if (kind)
            take_table(reader, card, kind, &to);
        else
            (void)POOL_ADD(reader->pool, to.card, to.ncard, card);
        if (c == front - 1)
            *nread = to.ncard;
    }
    text->card = to.card;
    text->ncard = to.ncard;
    return reader->messages->errors > before;
}
