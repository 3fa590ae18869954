#include "deck/deck_row.h"

#include <ctype.h>
#include <errno.h>
#include <strings.h>
#include <unistd.h>

#include "file/file.h"

struct reader {
    struct pool *pool;
    struct message_list *messages;
    struct deck_text *text;
    size_t bytes_left;
    int early;    /* data lines before the first card; the first is told */
    int over;     /* a limit of the whole deck is passed, which has been said: nothing more is read */
    int is_piece; /* what it includes is left alone */
    int depth;
    const char *open_file[DECK_MOST_INCLUDES + 1];
    struct stat open_stat[DECK_MOST_INCLUDES + 1];
    int continues;                     /* a keyword line ended in a comma */
    char buffer[DECK_LINE_LENGTH + 1]; /* the line at hand */
    const char *line_text;             /* its first character */
    int line;
};

char *deck_read_file(struct pool *pool, const char *path, size_t most, struct stat *about, size_t *length, int *failed)
{
    FILE *stream = file_open(path, 0, about);
    size_t room = 1 << 14, got = 1, known = stream && S_ISREG(about->st_mode) ? (size_t)about->st_size : 0;
    char *text = stream ? pool_get(pool, room, 1) : NULL;
    *failed = stream ? 0 : errno;
    if (!stream)
        return NULL;
    for (*length = known > most ? known : 0; text && got && *length <= most; *length += got) {
        text = pool_grow(pool, text, *length + 1, &room, 1); /* as it comes: a pipe does not know its length */
        got = text ? fread(text + *length, 1, room - *length - 1, stream) : 0;
    }
    *failed = ferror(stream) ? errno : 0;
    (void)fclose(stream);
    return text;
}

const struct card_option *card_option(const struct card *card, const char *name)
{
    for (int i = 0; i < card->noption; i++)
        if (same_text(card->option[i].name, name))
            return &card->option[i];
    return NULL;
}

static char *copy_span(struct reader *reader, const char *begin, const char *end)
{
    return pool_copy(reader->pool, begin, (size_t)(end - begin), 1, 1);
}

#define text_error(reader, place, ...)                                                                                           \
    message_add((reader)->messages, SEVERITY_ERROR, (place).file, (place).line, (place).column, __VA_ARGS__)

static void trim(const char **begin, const char **end)
{
    while (*begin < *end && isspace((unsigned char)**begin))
        (*begin)++;
    while (*end > *begin && isspace((unsigned char)(*end)[-1]))
        (*end)--;
}

struct card *deck_text_add_card(struct pool *pool, struct deck_text *text, const char *name, struct place place)
{
    const struct card card = {.name = name, .kind = deck_card_find(name), .place = place, .end = place};
    return POOL_ADD(pool, text->card, text->ncard, &card) ? NULL : &text->card[text->ncard - 1];
}

/* In a copy: the options that it has may be those of another card. */
int deck_text_add_option(struct pool *pool, struct card *card, struct card_option option)
{
    struct card_option *longer = POOL_COPY(pool, card->option, card->noption, 1);
    if (!longer)
        return 1;
    longer[card->noption++] = option;
    card->option = longer;
    return 0;
}

static struct place at(const struct reader *reader, const char *here)
{
    return (struct place){reader->open_file[reader->depth], reader->line, (int)(here - reader->line_text) + 1};
}

static int begins_number(const char *text, const char *end)
{
    text += text < end && *text == '.';
    return text < end && isdigit((unsigned char)*text);
}

/* Whether the piece [begin, end) between two commas goes on with a list, which is the value of the option before it or begins
 * with that: of numbers, of states, or the second group of BETWEEN=left,core, which may have the name of an option. */
static int is_next_item(const struct card_option *option, const char *begin, const char *end)
{
    const char *list = option->value;
    int is_name = !memchr(begin, '=', (size_t)(end - begin)), between = same_text(option->name, "BETWEEN") && !strchr(list, ',');
    int runup = !strncasecmp(list, "RUNUP", 5); /* which comes first in a HOLDOUT */
    int state = end - begin > 6 && !strncasecmp(begin, "STATE:", 6) && (runup || !strncasecmp(list, "STATE:", 6));
    return state || (is_name && (between || (begins_number(begin, end) && (runup || begins_number(list, list + strlen(list))))));
}

/* One piece of a keyword line: NAME=VALUE, NAME, or, behind a list such as MODES=1,2 or HOLDOUT=STATE:a, the next item of the
 * list. */
static void read_option(struct reader *reader, struct card *card, const char *begin, const char *end)
{
    trim(&begin, &end);
    if (begin == end)
        return;
    const char *equals = memchr(begin, '=', (size_t)(end - begin)), *name_end = equals ? equals : end,
               *value = equals ? equals + 1 : end;
    struct card_option *list = card->noption ? &card->option[card->noption - 1] : NULL;
    card->end = at(reader, end);
    if (list && is_next_item(list, begin, end)) {
        const char *longer = pool_format(reader->pool, "%s,%.*s", list->value, (int)(end - begin), begin);
        list->value = longer ? longer : list->value;
        list->end = card->end;
        return;
    }
    trim(&begin, &name_end);
    trim(&value, &end);
    struct card_option option = {.name = copy_span(reader, begin, name_end),
                                 .value = copy_span(reader, value, end),
                                 .place = at(reader, begin),
                                 .value_place = at(reader, value),
                                 .end = card->end};
    if (!option.name || !option.value)
        return;
    if (card_option(card, option.name))
        text_error(reader, option.place, "option %s is given twice on *%s, expected once", option.name, card->name);
    (void)deck_text_add_option(reader->pool, card, option);
}

static void read_options(struct reader *reader, struct card *card, const char *begin, const char *end)
{
    const char *last = end, *first = begin;
    trim(&first, &last);
    reader->continues = last == first || last[-1] == ',';
    while (begin <= end) {
        const char *comma = memchr(begin, ',', (size_t)(end - begin));
        read_option(reader, card, begin, comma ? comma : end);
        if (!comma)
            break;
        begin = comma + 1;
    }
}

const char *deck_path_from(struct pool *pool, const char *path, const char *file, const char *directory)
{
    const char *slash = file ? strrchr(file, '/') : NULL;
    if (*path == '/' || (!directory && !slash))
        return path;
    return directory ? pool_format(pool, "%s/%s", directory, path)
                     : pool_format(pool, "%.*s/%s", (int)(slash - file), file, path);
}

const char *deck_absolute(struct pool *pool, const char *path)
{
    char here[4096]; /* PATH_MAX of Linux */
    return !path || *path == '/' ? path : getcwd(here, sizeof here) ? deck_path_from(pool, path, NULL, here) : NULL;
}

const char *deck_text_path(struct pool *pool, const struct deck_text *text, const struct card *card,
                           const struct card_option *option, struct message_list *messages)
{
    const char *here = option->overridden ? NULL : card->place.file;
    if (text->origin.memory && !text->origin.directory) {
        message_at(messages, SEVERITY_ERROR, option->value_place,
                   "%s is a file, and a deck from memory has no directory of its own, expected one beside its text",
                   option->value);
        return NULL;
    }
    return deck_path_from(pool, option->value, here,
                          text->origin.memory && (!here || here == text->origin.path) ? text->origin.directory : NULL);
}

static int read_file(struct reader *reader, const char *path, struct place from);

static void include(struct reader *reader, struct card card)
{
    const struct card_option *file = card_option(&card, "FILE");
    if (!file || !*file->value) {
        text_error(reader, card.place, "*INCLUDE names no file, expected FILE=path");
        return;
    }
    for (int i = 0; i < card.noption; i++)
        if (!same_text(card.option[i].name, "FILE"))
            text_error(reader, card.option[i].place, "option %s of *INCLUDE is not known, expected FILE", card.option[i].name);
    const char *path = deck_text_path(reader->pool, reader->text, &card, file, reader->messages);
    if (!path)
        return;
    struct stat information; /* the same file may have several paths */
    for (int i = 0; i <= reader->depth && !stat(path, &information); i++)
        if (information.st_dev == reader->open_stat[i].st_dev && information.st_ino == reader->open_stat[i].st_ino) {
            text_error(reader, file->value_place, "%s includes itself, expected a file that is not already open", path);
            return;
        }
    if (reader->depth >= DECK_MOST_INCLUDES) {
        text_error(reader, file->value_place, "files are included more than %d deep, expected fewer", DECK_MOST_INCLUDES);
        return;
    }
    if (reader->text->nfile > DECK_MOST_FILES) {
        text_error(reader, file->value_place, "the deck includes more than %d files, expected fewer", DECK_MOST_FILES);
        reader->over = 1;
        return;
    }
    (void)read_file(reader, path, file->value_place);
}

static void read_keyword(struct reader *reader, const char *begin, const char *end)
{
    const char *comma = memchr(begin, ',', (size_t)(end - begin)), *name = begin + 1, *name_end = comma ? comma : end;
    trim(&name, &name_end);
    char *upper = copy_span(reader, name, name_end);
    for (char *c = upper; c && *c; c++)
        *c = (char)toupper((unsigned char)*c);
    struct card *card = upper ? deck_text_add_card(reader->pool, reader->text, upper, at(reader, begin)) : NULL;
    if (!card)
        return;
    card->end = at(reader, name_end);
    reader->continues = 0;
    if (comma)
        read_options(reader, card, comma + 1, end);
}

static void read_data(struct reader *reader, const char *begin, const char *end)
{
    struct deck_text *text = reader->text;
    const char *first = begin, *last = end;
    trim(&first, &last);
    if (first == last)
        return;
    if (!text->ncard) {
        if (!reader->early++)
            text_error(reader, at(reader, first),
                       "a data line stands before the first card, expected a line that begins with *, or ** and a comment");
        return;
    }
    struct card *card = &text->card[text->ncard - 1];
    int count = 1;
    for (const char *c = begin; c < end; c++)
        count += *c == ',';
    struct data_line data = {.place = at(reader, first), .end = at(reader, last), .text = copy_span(reader, first, last)};
    data.field = POOL_ARRAY(reader->pool, struct field, count);
    if (!data.field || !data.text)
        return;
    for (const char *piece = begin; data.count < count; data.count++) {
        const char *comma = memchr(piece, ',', (size_t)(end - piece)), *from = piece, *to = comma ? comma : end;
        trim(&from, &to);
        data.field[data.count] = (struct field){copy_span(reader, from, to), at(reader, from), 0};
        if (!data.field[data.count].text)
            return;
        piece = comma ? comma + 1 : end;
    }
    if (data.count > 1 && !*data.field[data.count - 1].text) /* a comma at the end of the line */
        data.count--;
    (void)POOL_ADD(reader->pool, card->line, card->nline, &data);
}

/* The line in the buffer, of `length` characters; an *INCLUDE in it overwrites the buffer. Returns 1 where the file is not text,
 * which ends the reading. */
static int read_line(struct reader *reader, size_t length)
{
    struct deck_text *text = reader->text;
    const char *begin = reader->buffer, *end = begin + length;
    int is_first = reader->line == 1;
    reader->line_text = begin;
    reader->buffer[length] = 0;
    for (const char *c = begin; c < end; c++)
        if ((unsigned char)*c < ' ' && *c != '\t') {
            text_error(reader, at(reader, c), "byte 0x%02x is not text, expected a deck of cards that begin with *",
                       (unsigned char)*c);
            return 1;
        }
    for (const char *c = begin; c < end; c++) { /* what makes a line look like another one, in comments as well */
        unsigned code;
        if (*c != '\t' && text_is_control(c, &code)) {
            text_error(reader, at(reader, c),
                       "character U+%04X does not stand for itself, expected text without control characters", code);
            break;
        }
    }
    if (is_first && length >= 3 && !memcmp(begin, "\xef\xbb\xbf", 3))
        reader->line_text = begin += 3; /* byte-order mark of an editor */
    const char *comment = strstr(begin, "**"), *first = begin + strspn(begin, " \t\v\f");
    end = comment ? comment : end;
    if (first >= end)
        return 0;
    if (*first == '*') { /* also behind a comma that nothing follows */
        if (text->ncard == DECK_MOST_CARDS) {
            text_error(reader, at(reader, first), "the deck has more than %d cards, expected those of a rotor", DECK_MOST_CARDS);
            reader->over = 1;
            return 1;
        }
        read_keyword(reader, first, end);
    } else if (reader->continues) {
        read_options(reader, &text->card[text->ncard - 1], begin, end);
    } else {
        read_data(reader, begin, end);
        return 0;
    }
    if (text->ncard && !reader->continues && !reader->pool->out_of_memory && !reader->is_piece &&
        !strcmp(text->card[text->ncard - 1].name, "INCLUDE"))
        include(reader, text->card[--text->ncard]);
    return 0;
}

/* `path`: the file of the places in it. more: the text goes on, beyond what a deck may have. */
static void read_lines(struct reader *reader, const char *path, const char *text, size_t length, int more)
{
    const char *stop = text + length;
    int line = 1, is_text = 1;
    reader->open_file[reader->depth] = path;
    reader->bytes_left -= length;
    for (; text < stop && is_text && !reader->over && !reader->pool->out_of_memory; line++) {
        const char *feed = memchr(text, '\n', (size_t)(stop - text)), *end = feed ? feed : stop;
        size_t count = (size_t)(end - text);
        count -= count && end[-1] == '\r';
        reader->line = line; /* included files have lines of their own */
        if (count > DECK_LINE_LENGTH) {
            text_error(reader, ((struct place){path, line, DECK_LINE_LENGTH + 1}),
                       "the line is longer than %d characters, expected a shorter one", DECK_LINE_LENGTH);
            is_text = !memchr(text, 0, DECK_LINE_LENGTH + 1);
        } else {
            memcpy(reader->buffer, text, count);
            is_text = !read_line(reader, count);
        }
        reader->text->end = (struct place){path, line, (int)count + 1};
        text = feed ? feed + 1 : stop;
    }
    if (more && is_text && !reader->over) {
        reader->over = 1;
        text_error(reader, ((struct place){path, 1, 1}), "the deck is larger than %ld MiB, expected cards of a rotor",
                   DECK_MOST_BYTES >> 20);
    }
    reader->continues = 0;
}

static int read_file(struct reader *reader, const char *path, struct place from)
{
    char why[HOST_ERROR_TEXT];
    struct stat about;
    size_t length, left = reader->bytes_left;
    int failed;
    const char *text =
        deck_read_file(reader->pool, !from.file && !strcmp(path, "-") ? "/dev/stdin" : path, left, &about, &length, &failed);
    if (!text && failed) {
        text_error(reader, ((struct place){from.file ? from.file : path, from.line, from.column}),
                   "cannot read %s: %s, expected a deck", path, file_error_text(failed, why));
        reader->pool->out_of_memory |= file_status(failed) == ROTID_ERROR_MEMORY;
        return file_status(failed);
    }
    if (!text)
        return ROTID_ERROR_MEMORY;
    (void)POOL_ADD(reader->pool, reader->text->file, reader->text->nfile, &path);
    reader->depth += from.file != NULL;
    reader->open_stat[reader->depth] = about;
    read_lines(reader, path, text, length <= left ? length : S_ISREG(about.st_mode) ? 0 : left, length > left);
    reader->depth -= from.file != NULL;
    const struct deck_file read = {path, text};
    (void)POOL_ADD(reader->pool, reader->text->origin.file, reader->text->origin.nfile, &read);
    if (failed)
        text_error(reader, ((struct place){path, reader->text->end.line, 1}), "reading failed: %s", host_error_text(failed, why));
    return ROTID_OK;
}

int deck_text_read(struct pool *pool, const char *path, const struct deck_memory *memory, struct message_list *messages,
                   struct deck_text *text)
{
    struct reader reader = {.pool = pool, .messages = messages, .text = text, .bytes_left = DECK_MOST_BYTES};
    int status = ROTID_OK, more = memory && memory->length > DECK_MOST_BYTES;
    size_t length = memory && !more ? memory->length : 0;
    *text = (struct deck_text){.origin = {.path = memory ? memory->name : path, .memory = memory != NULL}};
    text->end = (struct place){text->origin.path, 1, 1};
    if (memory) {
        const struct deck_file read = {memory->name, pool_copy(pool, memory->text, length, 1, 1)};
        text->origin.directory = memory->directory;
        if (read.text)
            read_lines(&reader, memory->name, read.text, length, more);
        (void)POOL_ADD(pool, text->origin.file, text->origin.nfile, &read);
    } else {
        status = read_file(&reader, path, (struct place){NULL, 1, 1});
    }
    if (pool->out_of_memory || messages->pool->out_of_memory)
        return ROTID_ERROR_MEMORY;
    return status ? status : messages->errors ? ROTID_ERROR_SYNTAX : ROTID_OK;
}

void deck_text_read_piece(struct pool *pool, size_t length, const char *piece, struct deck_text *text)
{
    struct message_list unheard;
    struct reader reader = {.pool = pool, .messages = &unheard, .text = text, .bytes_left = length, .is_piece = 1};
    message_open(&unheard, pool);
    *text = (struct deck_text){.ncard = 0};
    read_lines(&reader, "", piece, length, 0);
}

/* ------------------------------------------------------------------------------------------------ overrides */

int override_parse(struct pool *pool, const char *text, struct override *override)
{
    const char *dot = strchr(text, '.'), *equals = strchr(text, '=');
    if (!dot || !equals || dot > equals || dot == text || equals == dot + 1 || !equals[1])
        return ROTID_ERROR_SYNTAX;
    *override = (struct override){pool_format(pool, "%.*s", (int)(dot - text), text),
                                  pool_format(pool, "%.*s", (int)(equals - dot - 1), dot + 1), equals + 1,
                                  pool_format(pool, "--set %s", text), text};
    return override->card && override->option && override->text ? ROTID_OK : ROTID_ERROR_MEMORY;
}
