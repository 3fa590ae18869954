/* The text of a deck in parts. A part is a card with its lines and the comments between them; an edit replaces the text of a
 * part, and what no edit touches is written as it was read, character by character. */

#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include "deck/deck_row.h"

static size_t line_length(const char *line, const char *stop)
{
    const char *feed = memchr(line, '\n', (size_t)(stop - line));
    return (size_t)((feed ? feed + 1 : stop) - line);
}

/* Where what is no comment ends, less blanks. */
static const char *end_of_line(const char *line, size_t length)
{
    const char *end = line + length;
    for (const char *c = line; c + 1 < end; c++)
        if (c[0] == '*' && c[1] == '*')
            end = c;
    while (end > line && isspace((unsigned char)end[-1]))
        end--;
    return end;
}

/* The first asterisk of a line that begins a card, or NULL. */
static const char *begins_card(const char *line)
{
    line += strspn(line, " \t\r\v\f");
    return line[0] == '*' && line[1] != '*' ? line : NULL;
}

static void name_of_card(const char *star, char name[32])
{
    size_t count = 0;
    star += 1 + strspn(star + 1, " \t");
    for (; count + 1 < 32 && (isalnum((unsigned char)*star) || *star == '_'); star++)
        name[count++] = (char)toupper((unsigned char)*star);
    name[count] = 0;
}

/* ------------------------------------------------------------------------------------------------ options */

/* An option of a part, and the comma in front of it. */
struct span {
    const char *comma, *name, *name_end, *value, *end; /* value: NULL without '=' */
};

static const char *skip_blanks(const char *c, const char *end)
{
    while (c < end && isspace((unsigned char)*c))
        c++;
    return c;
}

/* The piece of a line up to the next comma. */
static struct span piece_of(const char *begin, const char *last)
{
    const char *equals = memchr(begin, '=', (size_t)(last - begin)), *name_end = equals ? equals : last;
    struct span s = {.name = skip_blanks(begin, last), .end = last, .value = equals ? skip_blanks(equals + 1, last) : NULL};
    while (s.end > s.name && isspace((unsigned char)s.end[-1]))
        s.end--;
    while (name_end > s.name && isspace((unsigned char)name_end[-1]))
        name_end--;
    s.name_end = name_end;
    return s;
}

static int is_called(const struct span *s, const char *name)
{
    return (size_t)(s->name_end - s->name) == strlen(name) && !strncasecmp(s->name, name, strlen(name));
}

/* The option of that name. *last: the end of the last option, or of the name of the card. Returns whether there is one. */
static int find_option(const struct deck_part *part, const char *name, struct span *found, const char **last)
{
    const char *line = part->text, *stop = line + part->length, *comma = NULL;
    struct span before = {.value = NULL};
    int any = 0, first = 1;
    *last = line;
    for (int continues = 1; continues && line < stop; line += line_length(line, stop)) {
        const char *begin = skip_blanks(line, stop), *end = end_of_line(line, line_length(line, stop));
        if (line == part->text)
            end = end_of_line(begin + 1, line_length(line, stop) - (size_t)(begin + 1 - line));
        if (begin >= end)
            continue;
        continues = end[-1] == ',';
        while (begin < end) {
            const char *next = memchr(begin, ',', (size_t)(end - begin));
            struct span piece = piece_of(begin, next ? next : end);
            if (first) {
                *last = piece.end;
            } else if (piece.end > piece.name) {
                if (before.value && deck_text_is_next_item(before.value, piece.name, piece.end)) {
                    before.end = piece.end;
                } else {
                    before = piece;
                    before.comma = comma;
                }
                if (is_called(&before, name) && before.value) {
                    *found = before;
                    any = 1;
                }
                *last = piece.end;
            }
            first = 0;
            comma = next ? next : comma;
            begin = next ? next + 1 : end;
        }
    }
    return any;
}

const char *deck_edit_option(const struct deck_part *part, const char *name, size_t *length)
{
    struct span found;
    const char *last;
    if (!find_option(part, name, &found, &last))
        return NULL;
    *length = (size_t)(found.end - found.value);
    return found.value;
}

/* ------------------------------------------------------------------------------------------------ parts */

static struct deck_part *add_part(struct deck_edit *e)
{
    static const struct deck_part none;
    int failed = POOL_ADD(e->pool, e->part, e->npart, &none);
    e->status = failed ? ROTID_ERROR_MEMORY : e->status;
    return failed ? NULL : &e->part[e->npart - 1];
}

/* A path as an option of a part names it, as the reader saw it. */
static const char *path_from(const struct deck_edit *e, const char *file, const char *path, size_t length)
{
    const char *slash = strrchr(file, '/');
    if (*path == '/')
        return pool_format(e->pool, "%.*s", (int)length, path);
    if (e->origin->memory && file == e->origin->path)
        return pool_format(e->pool, "%s/%.*s", e->origin->directory ? e->origin->directory : ".", (int)length, path);
    return slash ? pool_format(e->pool, "%.*s/%.*s", (int)(slash - file), file, (int)length, path)
                 : pool_format(e->pool, "%.*s", (int)length, path);
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

/* The parts of a text, and behind each *INCLUDE those of its file. */
static void gather(struct deck_edit *e, const char *text, const char *file, int depth)
{
    const char *stop = text + strlen(text);
    for (const char *end = text; *text && !e->status; text = end) {
        const char *star = begins_card(text);
        struct deck_part *part = add_part(e);
        char name[32] = "";
        if (!part)
            return;
        if (star)
            name_of_card(star, name);
        do
            end += line_length(end, stop);
        while (*end && !begins_card(end));
        *part = (struct deck_part){
            .text = text, .file = file, .length = (size_t)(end - text), .card = deck_card_find(name), .state = e->nstate - 1};
        if (part->card && !strcmp(name, "STATE"))
            part->state = e->nstate++;
        e->running |= !strcmp(name, "RUNNING");
        if (e->running)
            part->state = DECK_BEHIND_STATES;
        if (strcmp(name, "INCLUDE") != 0)
            continue;
        part->include = 1;
        if (depth < 0)
            continue;
        int at = e->npart - 1;
        size_t length;
        const char *value = deck_edit_option(part, "FILE", &length), *path = value ? path_from(e, file, value, length) : NULL,
                   *inside = depth < DECK_MOST_INCLUDES ? text_of(e, path) : NULL;
        if (inside)
            gather(e, inside, path, depth + 1);
        else
            e->status = e->pool->out_of_memory ? ROTID_ERROR_MEMORY : ROTID_ERROR_IO;
        e->part[at].inside = e->npart - 1 - at;
    }
}

static void replace(struct deck_edit *e, int part, struct deck_writer *w)
{
    e->status = e->status ? e->status : w->status;
    if (e->status)
        return;
    e->part[part].text = w->text ? w->text : "";
    e->part[part].length = w->length;
    e->part[part].changed = 1;
}

void deck_edit_set(struct deck_edit *e, int part, const char *name, const char *value)
{
    struct deck_part *p = &e->part[part];
    struct deck_writer w = {.pool = e->pool};
    struct span found;
    const char *last, *stop = p->text + p->length;
    if (find_option(p, name, &found, &last) && value) {
        deck_put(&w, "%.*s%s%.*s", (int)(found.value - p->text), p->text, value, (int)(stop - found.end), found.end);
    } else if (value) {
        deck_put(&w, "%.*s, %s=%s%.*s", (int)(last - p->text), p->text, name, value, (int)(stop - last), last);
    } else if (found.end == last) { /* of the last one the comma in front, behind which the card would go on */
        int between = memchr(found.comma, '\n', (size_t)(found.name - found.comma)) ? (int)(found.name - found.comma - 1) : 0;
        deck_put(&w, "%.*s%.*s%.*s", (int)(found.comma - p->text), p->text, between, found.comma + 1, (int)(stop - found.end),
                 found.end);
    } else {
        const char *comma = memchr(found.end, ',', (size_t)(stop - found.end));
        deck_put(&w, "%.*s%.*s%.*s", (int)(found.name - p->text), p->text, (int)(comma - found.end), found.end,
                 (int)(stop - comma - 1), comma + 1);
    }
    replace(e, part, &w);
}

int deck_edit_field(const char *line, size_t length, int number, int *count)
{
    const char *end = end_of_line(line, length), *begin = line;
    *count = 0;
    for (int field = 0; field < number; field++) {
        const char *comma = memchr(begin, ',', (size_t)(end - begin));
        if (!comma)
            return -1;
        begin = comma + 1;
    }
    const char *comma = memchr(begin, ',', (size_t)(end - begin)), *stop = comma ? comma : end;
    begin = skip_blanks(begin, stop);
    while (stop > begin && isspace((unsigned char)stop[-1]))
        stop--;
    *count = (int)(stop - begin);
    return (int)(begin - line);
}

void deck_edit_put_field(struct deck_writer *w, const char *line, size_t length, int number, const char *value)
{
    int count, at = deck_edit_field(line, length, number, &count);
    const char *between = at < 0 ? ", " : "";
    if (at < 0) {
        at = deck_edit_field(line, length, number - 1, &count) + count;
        count = 0;
    }
    deck_put(w, "%.*s%s%s%.*s", at, line, between, value, (int)length - at - count, line + at + count);
}

void deck_edit_lines(struct deck_edit *e, int part, void (*line)(struct deck_writer *, const char *, size_t, int, void *),
                     void *context)
{
    const struct deck_part *p = &e->part[part];
    const char *at = p->text, *stop = at + p->length;
    struct deck_writer w = {.pool = e->pool};
    int continues = 1, number = 0;
    for (size_t length; at < stop; at += length) {
        length = line_length(at, stop);
        const char *end = end_of_line(at, length);
        if (at == p->text) {
            const char *star = begins_card(at);
            end = star ? end_of_line(star + 1, length - (size_t)(star + 1 - at)) : end;
        }
        int blank = end == at || skip_blanks(at, end) == end;
        if (!continues && !blank)
            line(&w, at, length, number++, context);
        else
            deck_put(&w, "%.*s", (int)length, at);
        if (continues && !blank)
            continues = end[-1] == ',';
    }
    if (w.length != p->length || (w.text && memcmp(w.text, p->text, w.length) != 0))
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
    e->part[part].card = NULL;
}

/* Where the comments and empty lines begin with which a part ends. */
static size_t behind_last_line(const struct deck_part *part)
{
    const char *stop = part->text + part->length;
    size_t behind = 0, at = 0;
    for (size_t count; at < part->length; at += count) {
        const char *line = part->text + at;
        count = line_length(line, stop);
        if (!is_comment(line, line + count) && skip_blanks(line, line + count) < line + count)
            behind = at + count;
    }
    return behind;
}

void deck_edit_append(struct deck_edit *e, int part, const char *text)
{
    const struct deck_part *p = &e->part[part];
    size_t behind = behind_last_line(p);
    struct deck_writer w = {.pool = e->pool};
    deck_put(&w, "%.*s%s%.*s", (int)behind, p->text, text ? text : "", (int)(p->length - behind), p->text + behind);
    replace(e, part, &w);
}

void deck_edit_insert(struct deck_edit *e, int at, const char *text)
{
    if (!text || !*text || !add_part(e))
        return;
    int last = e->npart - 1;
    memmove(e->part + at + 1, e->part + at, (size_t)(last - at) * sizeof *e->part);
    for (int i = 0; i < at; i++)
        if (e->part[i].include && i + e->part[i].inside >= at) {
            e->part[i].inside++;
            e->part[i].changed = 1;
        }
    struct deck_part *before = at ? &e->part[at - 1] : NULL, *part = &e->part[at];
    *part = (struct deck_part){.text = text, .length = strlen(text), .file = e->origin->path, .changed = 1};
    part->state = before ? before->state : -1;
    if (!before || at == last || before->file != part[1].file || !(before->card || before->include))
        return;
    size_t behind = behind_last_line(before);
    struct deck_writer w = {.pool = e->pool};
    deck_put(&w, "%s%.*s", text, (int)(before->length - behind), before->text + behind);
    before->length = behind;
    before->changed = 1;
    replace(e, at, &w);
}

/* ------------------------------------------------------------------------------------------------ overrides */

/* Options that --set replaced for the run are replaced in the text: files they name are relative to where the program runs. */
static void apply(struct deck_edit *e, const struct override *o)
{
    const char *value = o->value;
    int found = 0;
    if (same_text(o->option, "FILE") && *value != '/') {
        char here[4096] = ""; /* PATH_MAX of Linux */
        value = e->origin->memory ? pool_format(e->pool, "%s/%s", e->origin->directory ? e->origin->directory : ".", value)
                : getcwd(here, sizeof here) ? pool_format(e->pool, "%s/%s", here, value)
                                            : NULL;
    }
    if (!value) {
        e->status = ROTID_ERROR_MEMORY;
        return;
    }
    for (int i = 0; i < e->npart; i++)
        if (e->part[i].card && same_text(e->part[i].card->name, o->card)) {
            deck_edit_set(e, i, o->option, value);
            found = 1;
        }
    const struct deck_card *card = deck_card_find(o->card);
    int at = 0;
    while (at < e->npart && e->part[at].state < 0)
        at++;
    for (const struct deck_card *k = deck_card_table; k->name && !card; k++)
        card = same_text(k->name, o->card) ? k : NULL;
    if (found || !card)
        return;
    deck_edit_insert(e, at, pool_format(e->pool, "*%s, %s=%s\n", card->name, o->option, value));
    e->part[at].card = card;
}

static int open_to(struct deck_edit *e, struct pool *pool, const struct deck_origin *origin, int depth)
{
    *e = (struct deck_edit){.pool = pool, .origin = origin};
    const char *text = origin ? text_of(e, origin->path) : NULL;
    if (!text)
        return e->status = ROTID_ERROR_IO;
    gather(e, text, origin->path, depth);
    /* the last line of a file may lack its line feed */
    for (int i = 0; i < e->npart && !e->status; i++) {
        struct deck_part *part = &e->part[i];
        if (part->length && part->text[part->length - 1] != '\n') {
            part->text = pool_format(pool, "%.*s\n", (int)part->length++, part->text);
            e->status = part->text ? ROTID_OK : ROTID_ERROR_MEMORY;
        }
    }
    for (int i = 0; i < origin->noverride && !e->status; i++)
        apply(e, &origin->override[i]);
    return e->status;
}

int deck_edit_open(struct deck_edit *e, struct pool *pool, const struct deck_origin *origin)
{
    return open_to(e, pool, origin, 0);
}

int deck_edit_open_flat(struct deck_edit *e, struct pool *pool, const char *path, const char *text)
{
    struct deck_file *file = POOL_NEW(pool, struct deck_file);
    struct deck_origin *origin = POOL_NEW(pool, struct deck_origin);
    if (!file || !origin)
        return e->status = ROTID_ERROR_MEMORY;
    *file = (struct deck_file){path, text};
    *origin = (struct deck_origin){.path = path, .nfile = 1, .file = file};
    return open_to(e, pool, origin, -1);
}

/* ------------------------------------------------------------------------------------------------ the whole */

void deck_edit_put(struct deck_edit *e, struct deck_writer *w, const struct deck_part *part, int with)
{
    size_t length = 0;
    const char *path = deck_edit_option(part, "FILE", &length), *text = part->text;
    size_t count = part->length;
    char here[4096] = "";
    if (path && *path != '/') {
        const char *whole = path_from(e, part->file, path, length);
        if (whole && *whole != '/')
            whole = getcwd(here, sizeof here) ? pool_format(e->pool, "%s/%s", here, whole) : NULL;
        if (!whole) {
            w->status = w->status ? w->status : ROTID_ERROR_MEMORY;
            return;
        }
        text = pool_format(e->pool, "%.*s%s%.*s", (int)(path - part->text), part->text, whole,
                           (int)(part->text + part->length - (path + length)), path + length);
        count = text ? strlen(text) : 0;
        w->status = text ? w->status : ROTID_ERROR_MEMORY;
    }
    if (text)
        put_lines(w, text, count, with);
}

/* Whether the parts of an included file are as they were, and all of them or none are wanted. */
static int is_whole(const struct deck_edit *e, int at, const unsigned *which, unsigned mask)
{
    int whole = !e->part[at].changed;
    for (int i = at + 1; i <= at + e->part[at].inside; i++)
        whole &= !e->part[i].changed && (!which || e->part[i].include || (which[i] & mask) != 0);
    return whole;
}

/* Parts [from, to). */
static void put_parts(struct deck_edit *e, struct deck_writer *w, int from, int to, const unsigned *which, unsigned mask)
{
    for (int i = from; i < to && !e->status; i += 1 + (e->part[i].include ? e->part[i].inside : 0)) {
        const struct deck_part *part = &e->part[i];
        int behind = i + 1 + part->inside, any = !which;
        size_t length = 0;
        const char *file = part->include ? deck_edit_option(part, "FILE", &length) : NULL;
        for (int k = part->include ? i + 1 : i; k < behind && which; k++)
            any |= !e->part[k].include && (which[k] & mask) != 0;
        if (!any)
            continue;
        if (!part->include || is_whole(e, i, which, mask)) {
            deck_edit_put(e, w, part, 3);
            continue;
        }
        deck_put(w, "** the cards of %.*s, which is not included as some of them change or stand elsewhere\n", (int)length,
                 file ? file : "");
        put_parts(e, w, i + 1, behind, which, mask);
        if (!which || mask & 1)
            deck_edit_put(e, w, part, 2);
    }
}

void deck_edit_text(struct deck_edit *e, struct deck_writer *w, const unsigned *which, unsigned mask)
{
    put_parts(e, w, 0, e->npart, which, mask);
    e->status = e->status ? e->status : w->status;
}
