#include "deck/deck_row.h"

#include <stdio.h>
#include <string.h>

int deck_row_is_last(const struct deck_row *row)
{
    return !row->option && !row->what;
}

/* ---- reading */

static int read_option(struct deck_reader *reader, const struct card *card, const struct deck_row *row, void *member)
{
    const struct card_option *option = card_option(card, row->option);
    int is_text = row->kind == ROW_NAME || row->kind == ROW_MATERIAL, index;
    if (!option && row->bits & ROW_MAY_LACK)
        return 0;
    if (row->kind != ROW_WORD && (is_text || !option) && !(row->bits & ROW_MAY_LACK) &&
        !deck_option(reader, card, row->option, row->what))
        return 1;
    switch (row->kind) {
    case ROW_NAME:
        *(const char **)member = option->value;
        return 0;
    case ROW_MATERIAL:
        index = deck_find_material(reader, option->value);
        if (index < 0)
            deck_error(reader, option->value_place, "material %s is not defined, expected the name of a *MATERIAL",
                       option->value);
        else if (reader->material[index].laminated)
            deck_error(reader, option->value_place,
                       "material %s is a stack of sheets across the axis, expected one that rods are made of", option->value);
        else
            *(struct material *)member = reader->material[index];
        return index < 0 || reader->material[index].laminated;
    case ROW_WORD:
        index = option ? deck_option_word(reader, option, row->words) : row->standard;
        if (index >= 0)
            *(int *)member = index;
        return index < 0;
    case ROW_NUMBER:
        return deck_option_number(reader, option, row->what, row->range, member);
    case ROW_WHOLE:
        return deck_option_integer(reader, option, row->least, row->most, member);
    case ROW_POSITION:
        return deck_option_position(reader, option, row->option, member);
    default:
        return 0;
    }
}

int deck_read_options(struct deck_reader *reader, const struct card *card, const struct deck_row *row, void *to)
{
    int bad = 0;
    for (; !deck_row_is_last(row); row++)
        if (row->option && row->kind != ROW_OTHER)
            bad |= read_option(reader, card, row, (char *)to + row->offset);
    return bad;
}

int deck_read_values(struct deck_reader *reader, const struct data_line *line, const struct deck_row *row, const char *layout,
                     void *to)
{
    int count = 0, bad = 0, i = 0;
    for (const struct deck_row *r = row; !deck_row_is_last(r); r++)
        count += !r->option;
    if (deck_count(reader, line, count, layout))
        return 1;
    for (; !deck_row_is_last(row); row++) {
        void *member = (char *)to + row->offset;
        if (row->option)
            continue;
        if (row->bits & ROW_MAY_LACK && !deck_has(line, i)) {
            if (row->as)
                *(double *)member = *(const double *)((const char *)to + row->as);
            i++;
            continue;
        }
        if (row->kind == ROW_POSITION)
            bad |= deck_position(reader, &line->field[i], row->what, member);
        else if (row->kind == ROW_WHOLE)
            bad |= deck_integer(reader, line, i, row->what, row->least, row->most, member);
        else
            bad |= deck_number(reader, line, i, row->what, row->range, member);
        i++;
    }
    return bad;
}

void deck_read_list(struct deck_reader *reader, const struct card *card, const struct deck_card *kind, size_t *room)
{
    char *rotor = (char *)&reader->job->rotor;
    void **list = (void **)(rotor + kind->list);
    int *count = (int *)(rotor + kind->count);
    int lines = deck_lines(reader, card, 1, card_option(card, "NAME") ? 1 : DECK_MOST_LINES, kind->lines);
    for (int i = 0; i < lines; i++) {
        char *added = deck_append(reader, list, *count, room, kind->size);
        if (!added)
            return;
        memset(added, 0, kind->size);
        if (!(deck_read_options(reader, card, kind->row, added) |
              deck_read_values(reader, &card->line[i], kind->row, kind->lines, added)) &&
            (!kind->check || !kind->check(reader, &card->line[i], added)))
            ++*count;
    }
}

/* ---- writing */

static double number_of(const struct deck_row *row, const void *member)
{
    return row->kind == ROW_WHOLE ? *(const int *)member : *(const double *)member;
}

void deck_write_options(struct deck_writer *w, const struct deck_row *row, const void *from)
{
    const char *name = NULL;
    char text[16];
    for (; !deck_row_is_last(row); row++) {
        const void *member = (const char *)from + row->offset;
        if (!row->option || row->kind == ROW_OTHER)
            continue;
        if (row->kind == ROW_NAME)
            name = *(const char *const *)member;
        if (row->kind == ROW_NAME && !name && row->bits & ROW_MAY_LACK)
            continue;
        if (row->bits & ROW_ABOVE_0 && !(number_of(row, member) > 0))
            continue;
        if (row->kind == ROW_NAME || row->kind == ROW_MATERIAL)
            deck_put_option(w, row->option, name);
        else if (row->kind == ROW_WORD)
            deck_put_option(w, row->option, row->words[*(const int *)member]);
        else if (row->kind == ROW_WHOLE) {
            (void)snprintf(text, sizeof text, "%d", *(const int *)member);
            deck_put_option(w, row->option, text);
        } else
            deck_put_option_number(w, row->option, *(const double *)member);
    }
}

void deck_write_values(struct deck_writer *w, const char *before, const struct deck_row *row, const void *from)
{
    for (; !deck_row_is_last(row); row++) {
        const void *member = (const char *)from + row->offset;
        if (row->option || (row->as && *(const double *)member == *(const double *)((const char *)from + row->as)))
            continue;
        if (row->bits & ROW_ABOVE_0 && !(number_of(row, member) > 0))
            continue;
        if (row->kind == ROW_WHOLE)
            deck_put(w, "%s%d", before, *(const int *)member);
        else
            deck_put_number(w, before, *(const double *)member);
        before = ", ";
    }
    deck_put(w, "\n");
}

static const char *name_of(const struct deck_card *kind, const void *from)
{
    for (const struct deck_row *row = kind->row; !deck_row_is_last(row); row++)
        if (row->kind == ROW_NAME)
            return *(const char *const *)((const char *)from + row->offset);
    return NULL;
}

/* Whether the card of the struct before does for this one: it says nothing of either. */
static int shares_card(const struct deck_card *kind, const char *before, const char *one)
{
    for (const struct deck_row *row = kind->row; !deck_row_is_last(row); row++)
        if (row->option && row->kind != ROW_NAME)
            return 0;
    return !name_of(kind, before) && !name_of(kind, one);
}

void deck_write_list(struct deck_writer *w, const struct deck_card *kind)
{
    const char *rotor = (const char *)&w->rotor, *list = *(const char *const *)(rotor + kind->list);
    for (int i = 0; i < *(const int *)(rotor + kind->count); i++) {
        const char *one = list + (size_t)i * kind->size;
        if (!i || !shares_card(kind, one - kind->size, one)) {
            deck_put_card(w, kind->name);
            deck_write_options(w, kind->row, one);
            deck_put(w, "\n");
        }
        deck_write_values(w, "", kind->row, one);
    }
}
