/* The text of a deck in parts. A part is a card with its lines and the comments between them; an edit replaces the text of a
 * part, and what no edit touches is written as it was read, character by character. */

#include <ctype.h>

#include "deck/deck_row.h"

static size_t line_length(const char *line, const char *stop)
{
    const char *feed = memchr(line, '\n', (size_t)(stop - line));
    return (size_t)((feed ? feed + 1 : stop) - line);
}

static const char *skip_blanks(const char *c, const char *end)
{
    while (c < end && isspace((unsigned char)*c))
        c++;
    return c;
}

static int begins_card(const char *line, const char *stop)
{
    const char *c = skip_blanks(line, line + line_length(line, stop));
    return c + 1 < stop && c[0] == '*' && c[1] != '*';
}

/* ------------------------------------------------------------------------------------------------ parts */

/* Where a place of the card lies in its text. */
static const char *text_at(const struct deck_part *part, struct place place)
{
    const char *line = part->text;
    for (int i = 1; i < place.line; i++)
        line += line_length(line, part->text + part->length);
    return line + place.column - 1;
}

/* Reads the text of a part, which is new: its card as any deck is read, and where its last one ends. */
static void read_part(struct deck_edit *e, struct deck_part *part)
{
    static const struct card none = {.name = "", .place = {"", 1, 1}, .end = {"", 1, 1}};
    struct deck_text text;
    deck_text_read_piece(e->pool, part->length, part->text, &text);
    const struct card *last = text.ncard ? &text.card[text.ncard - 1] : &none;
    int line = last->nline ? last->line[last->nline - 1].place.line : last->end.line;
    part->read = text.ncard ? text.card[0] : none;
    part->end = text.ncard ? (size_t)(text_at(part, (struct place){.line = line + 1, .column = 1}) - part->text) : 0;
}

const char *deck_edit_option(const struct deck_part *part, const char *name)
{
    const struct card_option *option = card_option(&part->read, name);
    return option ? option->value : NULL;
}

int deck_edit_is(const struct deck_part *part, const char *card)
{
    return !strcmp(part->read.name, card);
}

/* A path as an option of a part names it, as the reader saw it. */
static const char *path_from(const struct deck_edit *e, const char *file, const char *path)
{
    const char *directory = e->origin->directory ? e->origin->directory : ".";
    return deck_path_from(e->pool, path, file, e->origin->memory && file == e->origin->path ? directory : NULL);
}

static const char *text_of(const struct deck_edit *e, const char *path)
{
    for (int f = 0; f < e->origin->nfile && path; f++)
        if (!strcmp(e->origin->file[f].path, path)) {
            const char *text = e->origin->file[f].text;
            return !strncmp(text, "\xef\xbb\xbf", 3) ? text + 3 : text; /* byte-order mark of an editor */
        }
    return NULL;
}

/* The parts of a text, and behind each *INCLUDE those of its file, where the origin has it. */
static void gather(struct deck_edit *e, const char *text, const char *file)
{
    const char *stop = text + strlen(text);
    for (const char *end = text; *text; text = end) {
        do
            end += line_length(end, stop);
        while (*end && !begins_card(end, stop));
        struct deck_part part = {.text = text, .file = file, .length = (size_t)(end - text)};
        if (end[-1] != '\n') { /* the last line of a file may lack its line feed */
            part.text = pool_format(e->pool, "%s\n", text);
            part.length++;
        }
        if (!part.text)
            return;
        read_part(e, &part);
        part.include = deck_edit_is(&part, "INCLUDE");
        e->nstate += deck_edit_is(&part, "STATE");
        e->running |= deck_edit_is(&part, "RUNNING");
        part.state = e->running ? DECK_BEHIND_STATES : e->nstate - 1;
        const char *value = part.include ? deck_edit_option(&part, "FILE") : NULL,
                   *path = value ? path_from(e, file, value) : NULL, *inside = text_of(e, path);
        int at = e->npart;
        if (POOL_ADD(e->pool, e->part, e->npart, &part))
            return;
        if (inside)
            gather(e, inside, path);
        e->part[at].inside = e->npart - 1 - at;
    }
}

static void replace(struct deck_edit *e, int part, struct deck_writer *w)
{
    if (e->pool->out_of_memory)
        return;
    e->part[part].text = w->text ? w->text : "";
    e->part[part].length = w->length;
    e->part[part].changed = 1;
    read_part(e, &e->part[part]);
}

static void put_span(struct deck_writer *w, const char *from, const char *to)
{
    deck_put(w, "%.*s", (int)(to - from), from);
}

/* The text [*from, *to) that goes with an option, and what stays of it. Of the last one the comma in front goes, behind which the
 * card would go on, of the others the one behind; comments stay. */
static const char *around(struct deck_edit *e, const struct deck_part *p, const struct card_option *option, const char **from,
                          const char **to)
{
    const struct card *card = &p->read;
    int is_last = option + 1 == card->option + card->noption, is_first = option == card->option;
    const char *name = text_at(p, option->place), *end = text_at(p, option->end),
               *before = is_last ? text_at(p, is_first ? card->place : option[-1].end) : end,
               *comma = memchr(before, ',', (size_t)(p->text + p->length - before)), *left = is_last ? comma + 1 : end,
               *stop = is_last ? name : comma;
    *from = is_last ? comma : name;
    *to = is_last ? end : comma + 1;
    return memchr(left, '\n', (size_t)(stop - left)) ? pool_format(e->pool, "%.*s", (int)(stop - left), left) : "";
}

void deck_edit_set(struct deck_edit *e, int part, const char *name, const char *value)
{
    struct deck_writer w = {.pool = e->pool};
    if (e->pool->out_of_memory)
        return;
    const struct deck_part *p = &e->part[part];
    const struct card_option *option = card_option(&p->read, name);
    const char *from = text_at(p, option ? option->value_place : p->read.end), *to = option ? text_at(p, option->end) : from;
    if (!option && value)
        value = pool_format(e->pool, ", %s=%s", name, value);
    else if (option && !value)
        value = around(e, p, option, &from, &to);
    put_span(&w, p->text, from);
    deck_put(&w, "%s", value ? value : "");
    put_span(&w, to, p->text + p->length);
    replace(e, part, &w);
}

void deck_edit_lines(struct deck_edit *e, int part, void (*edit)(struct deck_line_edit *, void *), void *context)
{
    const struct deck_part *p = &e->part[part];
    const char *done = p->text, *begin = p->text, *stop = p->text + p->length;
    struct deck_writer w = {.pool = e->pool};
    for (int i = 0, number = 1; i < p->read.nline; i++) {
        struct deck_line_edit line = {.line = &p->read.line[i], .number = i};
        edit(&line, context);
        for (; number < line.line->place.line; number++)
            begin += line_length(begin, stop);
        if (line.before) {
            put_span(&w, done, begin);
            deck_put(&w, "%s", line.before);
            done = begin;
        }
        for (int f = 0; f < DECK_EDIT_FIELDS; f++) {
            if (!line.value[f])
                continue;
            int is_new = f >= line.line->count;
            const struct field *field = &line.line->field[is_new ? line.line->count - 1 : f];
            const char *at = begin + field->place.column - 1, *behind = at + strlen(field->text);
            put_span(&w, done, is_new ? behind : at);
            deck_put(&w, "%s%s", is_new ? ", " : "", line.value[f]);
            done = behind;
        }
    }
    if (done == p->text)
        return;
    put_span(&w, done, stop);
    replace(e, part, &w);
}

static int is_comment(const char *line, const char *stop)
{
    line = skip_blanks(line, stop);
    return line + 1 < stop && line[0] == '*' && line[1] == '*';
}

/* The lines of a part that are comments (2), or are none (1). */
static void put_lines(struct deck_writer *w, const char *text, size_t length, int with)
{
    const char *stop = text + length;
    for (size_t count; text < stop; text += count) {
        count = line_length(text, stop);
        if (with & (is_comment(text, text + count) ? 2 : 1))
            deck_put(w, "%.*s", (int)count, text);
    }
}

void deck_edit_clear(struct deck_edit *e, int part)
{
    struct deck_writer w = {.pool = e->pool};
    put_lines(&w, e->part[part].text, e->part[part].length, 2);
    replace(e, part, &w);
}

void deck_edit_append(struct deck_edit *e, int part, const char *text)
{
    const struct deck_part *p = &e->part[part];
    struct deck_writer w = {.pool = e->pool};
    deck_put(&w, "%.*s%s%.*s", (int)p->end, p->text, text ? text : "", (int)(p->length - p->end), p->text + p->end);
    replace(e, part, &w);
}

void deck_edit_insert(struct deck_edit *e, int at, const char *text)
{
    int last = e->npart;
    struct deck_part *before, part = {.text = text, .length = text ? strlen(text) : 0, .file = e->origin->path, .changed = 1};
    if (!part.length || POOL_ADD(e->pool, e->part, e->npart, &part))
        return;
    before = at ? &e->part[at - 1] : NULL;
    part.state = before ? before->state : -1;
    read_part(e, &part);
    memmove(e->part + at + 1, e->part + at, (size_t)(last - at) * sizeof *e->part);
    e->part[at] = part;
    for (int i = 0; i < at; i++)
        if (e->part[i].include && i + e->part[i].inside >= at) {
            e->part[i].inside++;
            e->part[i].changed = 1;
        }
    if (!before || at == last || before->file != e->part[at + 1].file || !*before->read.name)
        return;
    struct deck_writer w = {.pool = e->pool};
    deck_put(&w, "%s%.*s", text, (int)(before->length - before->end), before->text + before->end);
    before->length = before->end;
    before->changed = 1;
    replace(e, at, &w);
}

int deck_edit_new(struct deck_edit *e, int at, const char *card)
{
    deck_edit_insert(e, at, pool_format(e->pool, "*%s\n", card));
    return at;
}

/* ------------------------------------------------------------------------------------------------ overrides */

/* Options that --set replaced for the run are replaced in the text: files they name are relative to where the program runs. */
static void apply(struct deck_edit *e, const struct override *o)
{
    const char *value = o->value;
    int found = 0;
    if (same_text(o->option, "FILE"))
        value = deck_absolute(e->pool, path_from(e, e->origin->memory ? e->origin->path : NULL, value));
    for (int i = 0; i < e->npart && value; i++)
        if (same_text(e->part[i].read.name, o->card)) {
            deck_edit_set(e, i, o->option, value);
            found = 1;
        }
    const struct deck_card *card = deck_card_table;
    int at = 0;
    while (at < e->npart && e->part[at].state < 0)
        at++;
    while (card->name && !same_text(card->name, o->card))
        card++;
    if (card->name && !found && value)
        deck_edit_set(e, deck_edit_new(e, at, card->name), o->option, value);
}

int deck_edit_open(struct deck_edit *e, struct pool *pool, const struct deck_origin *origin)
{
    *e = (struct deck_edit){.pool = pool, .origin = origin};
    const char *text = origin ? text_of(e, origin->path) : NULL;
    if (!text)
        return ROTID_ERROR_IO;
    gather(e, text, origin->path);
    for (int i = 0; i < origin->noverride; i++)
        apply(e, &origin->override[i]);
    return pool->out_of_memory ? ROTID_ERROR_MEMORY : ROTID_OK;
}

/* ------------------------------------------------------------------------------------------------ the whole */

void deck_edit_put(struct deck_edit *e, struct deck_writer *w, const struct deck_part *part, int with)
{
    const struct card_option *file = card_option(&part->read, "FILE");
    const char *text = part->text, *stop = text + part->length;
    size_t count = part->length;
    if (file && *file->value != '/') {
        const char *whole = deck_absolute(e->pool, path_from(e, part->file, file->value)),
                   *from = text_at(part, file->value_place), *to = text_at(part, file->end);
        text = whole ? pool_format(e->pool, "%.*s%s%.*s", (int)(from - text), text, whole, (int)(stop - to), to) : NULL;
        count = text ? strlen(text) : 0;
    }
    if (text)
        put_lines(w, text, count, with);
}

/* Whether the parts of an included file are as they were, and all of them are wanted. */
static int is_whole(const struct deck_edit *e, int at)
{
    int whole = !e->part[at].changed;
    for (int i = at + 1; i <= at + e->part[at].inside; i++)
        whole &= !e->part[i].changed && (e->part[i].include || !e->part[i].left_out);
    return whole;
}

/* Parts [from, to). */
static void put_parts(struct deck_edit *e, struct deck_writer *w, int from, int to)
{
    for (int i = from; i < to; i += 1 + e->part[i].inside) {
        const struct deck_part *part = &e->part[i];
        int behind = i + 1 + part->inside, any = !part->left_out && !part->inside;
        for (int k = i + 1; k < behind; k++)
            any |= !e->part[k].include && !e->part[k].left_out;
        if (!any)
            continue;
        if (!part->include || is_whole(e, i)) {
            deck_edit_put(e, w, part, 3);
            continue;
        }
        deck_put(w, "** the cards of %s, which is not included as some of them change or stand elsewhere\n",
                 deck_edit_option(part, "FILE"));
        put_parts(e, w, i + 1, behind);
        if (!part->left_out)
            deck_edit_put(e, w, part, 2);
    }
}

void deck_edit_text(struct deck_edit *e, struct deck_writer *w)
{
    put_parts(e, w, 0, e->npart);
}
