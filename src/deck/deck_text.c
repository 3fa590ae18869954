#include "deck/deck.h"

#include <ctype.h>
#include <errno.h>
#include <stdarg.h>
#include <string.h>
#include <strings.h>

#include "file/file.h"

/* Where the characters of a deck come from: a file, or the memory of a host. What was read is kept: writers edit that text. */

#define DECK_SOURCE_END (-1)

struct deck_source {
    struct stat information; /* of the file; zeros for memory */
    FILE *stream;            /* NULL: memory */
    const char *text;
    size_t left;
    char *kept;
    size_t nkept, room;
};

/* 0, or the error number of the operating system. A deck "-" is standard input. */
static int deck_source_open(struct deck_source *source, const char *path, int is_deck)
{
    *source = (struct deck_source){.text = NULL};
    source->stream = file_open(is_deck && !strcmp(path, "-") ? "/dev/stdin" : path, 0, &source->information);
    return source->stream ? 0 : errno;
}

/* Bytes that it holds, -1 where nobody knows: a pipe. */
static long long deck_source_length(const struct deck_source *source)
{
    if (!source->stream)
        return source->left <= (size_t)1 << 62 ? (long long)source->left : 1LL << 62;
    return S_ISREG(source->information.st_mode) ? (long long)source->information.st_size : -1;
}

struct reader {
    struct pool *pool;
    struct message_list *messages;
    struct deck_text *text;
    long bytes_left;
    int early; /* data lines before the first card; the first is told */
    int over;  /* a limit of the whole deck is passed, which has been said: nothing more is read */
    int depth;
    const char *open_file[DECK_MOST_INCLUDES + 1];
    struct stat open_stat[DECK_MOST_INCLUDES + 1];
    struct place keyword; /* a keyword line that ends in a comma goes on here */
    int continues;
};

/* The next byte, or DECK_SOURCE_END. */
static int deck_source_next(struct reader *reader, struct deck_source *source)
{
    int c = DECK_SOURCE_END;
    if (source->stream)
        c = getc(source->stream);
    else if (source->left) {
        source->left--;
        c = (unsigned char)*source->text++;
    }
    char *grown = pool_grow(reader->pool, source->kept, source->nkept, &source->room, 1);
    if (!grown)
        return DECK_SOURCE_END;
    source->kept = grown;
    source->kept[source->nkept] = (char)(c < 0 ? 0 : c); /* a zero ends the text */
    source->nkept += c >= 0;
    return c;
}

/* 0, or the error number where reading ended before the end. */
static int deck_source_close(struct deck_source *source)
{
    int number = source->stream && ferror(source->stream) ? errno : 0;
    if (source->stream)
        (void)fclose(source->stream);
    return number;
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
    char *copy = pool_get(reader->pool, (size_t)(end - begin) + 1, 1);
    if (copy)
        memcpy(copy, begin, (size_t)(end - begin));
    return copy;
}

__attribute__((format(printf, 3, 4))) static void text_error(struct reader *reader, struct place place, const char *format, ...)
{
    char text[2 * DECK_LINE_LENGTH];
    va_list values;
    va_start(values, format);
    (void)vsnprintf(text, sizeof text, format, values);
    va_end(values);
    message_add(reader->messages, SEVERITY_ERROR, place.file, place.line, place.column, "%s", text);
}

static void trim(const char **begin, const char **end)
{
    while (*begin < *end && isspace((unsigned char)**begin))
        (*begin)++;
    while (*end > *begin && isspace((unsigned char)(*end)[-1]))
        (*end)--;
}

struct card *deck_text_add_card(struct pool *pool, struct deck_text *text, const char *name, struct place place)
{
    const struct card card = {.name = name, .place = place};
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

static struct place at(const struct reader *reader, const char *line_begin, const char *here, int line)
{
    return (struct place){reader->open_file[reader->depth], line, (int)(here - line_begin) + 1};
}

static int begins_number(const char *text, const char *end)
{
    text += text < end && *text == '.';
    return text < end && isdigit((unsigned char)*text);
}

int deck_text_is_next_item(const char *list, const char *begin, const char *end)
{
    int runup = !strncasecmp(list, "RUNUP", 5); /* which comes first in a HOLDOUT */
    int state = end - begin > 6 && !strncasecmp(begin, "STATE:", 6) && (runup || !strncasecmp(list, "STATE:", 6));
    return state || (!memchr(begin, '=', (size_t)(end - begin)) && begins_number(begin, end) &&
                     (runup || begins_number(list, list + strlen(list))));
}

/* One piece of a keyword line: NAME=VALUE, NAME, or, behind a list such as MODES=1,2 or HOLDOUT=STATE:a, the next item of the
 * list. */
static void read_option(struct reader *reader, struct card *card, const char *line_begin, const char *begin, const char *end,
                        int line)
{
    trim(&begin, &end);
    if (begin == end)
        return;
    const char *equals = memchr(begin, '=', (size_t)(end - begin));
    struct card_option *list = card->noption ? &card->option[card->noption - 1] : NULL;
    if (list && deck_text_is_next_item(list->value, begin, end)) {
        char *item = copy_span(reader, begin, end), *longer = item ? pool_format(reader->pool, "%s,%s", list->value, item) : NULL;
        if (longer)
            list->value = longer;
        return;
    }
    const char *name_end = equals ? equals : end, *value = equals ? equals + 1 : end, *value_end = end;
    const char *name = begin;
    trim(&name, &name_end);
    trim(&value, &value_end);
    struct card_option option = {.name = copy_span(reader, name, name_end),
                                 .value = copy_span(reader, value, value_end),
                                 .place = at(reader, line_begin, name, line),
                                 .value_place = at(reader, line_begin, value, line)};
    if (!option.name || !option.value)
        return;
    if (card_option(card, option.name))
        text_error(reader, option.place, "option %s is given twice on *%s, expected once", option.name, card->name);
    (void)deck_text_add_option(reader->pool, card, option);
}

static void read_options(struct reader *reader, struct card *card, const char *line_begin, const char *begin, const char *end,
                         int line)
{
    const char *last = end, *first = begin;
    trim(&first, &last);
    reader->continues = last == first || last[-1] == ',';
    while (begin <= end) {
        const char *comma = memchr(begin, ',', (size_t)(end - begin));
        read_option(reader, card, line_begin, begin, comma ? comma : end, line);
        if (!comma)
            break;
        begin = comma + 1;
    }
}

const char *deck_text_path(struct pool *pool, const struct deck_text *text, const struct card *card,
                           const struct card_option *option, struct message_list *messages)
{
    const char *here = card->place.file, *slash = option->overridden ? NULL : strrchr(here, '/'), *path = option->value;
    if (text->memory && !text->directory) {
        message_add(messages, SEVERITY_ERROR, option->value_place.file, option->value_place.line, option->value_place.column,
                    "%s is a file, and a deck from memory has no directory of its own, expected one beside its text", path);
        return NULL;
    }
    if (*path == '/')
        return path;
    if (text->memory && (option->overridden || here == text->memory))
        return pool_format(pool, "%s/%s", text->directory, path);
    return slash ? pool_format(pool, "%.*s/%s", (int)(slash - here), here, path) : path;
}

int deck_text_add_file(struct pool *pool, struct deck_text *text, const char *path)
{
    return POOL_ADD(pool, text->file, text->nfile, &path) ? ROTID_ERROR_MEMORY : ROTID_OK;
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

static void read_keyword(struct reader *reader, const char *line_begin, const char *begin, const char *end, int line)
{
    const char *comma = memchr(begin, ',', (size_t)(end - begin)), *name = begin + 1, *name_end = comma ? comma : end;
    trim(&name, &name_end);
    char *upper = copy_span(reader, name, name_end);
    for (char *c = upper; c && *c; c++)
        *c = (char)toupper((unsigned char)*c);
    struct card *card = upper ? deck_text_add_card(reader->pool, reader->text, upper, at(reader, line_begin, begin, line)) : NULL;
    if (!card)
        return;
    reader->continues = 0;
    if (comma)
        read_options(reader, card, line_begin, comma + 1, end, line);
}

static void read_data(struct reader *reader, const char *begin, const char *end, int line)
{
    struct deck_text *text = reader->text;
    const char *first = begin, *last = end;
    trim(&first, &last);
    if (first == last)
        return;
    if (!text->ncard) {
        if (!reader->early++)
            text_error(reader, at(reader, begin, first, line),
                       "a data line stands before the first card, expected a line that begins with *, or ** and a comment");
        return;
    }
    struct card *card = &text->card[text->ncard - 1];
    int count = 1;
    for (const char *c = begin; c < end; c++)
        count += *c == ',';
    struct data_line data = {
        .place = at(reader, begin, first, line), .end = at(reader, begin, last, line), .text = copy_span(reader, first, last)};
    data.field = POOL_ARRAY(reader->pool, struct field, count);
    if (!data.field || !data.text)
        return;
    for (const char *piece = begin; data.count < count; data.count++) {
        const char *comma = memchr(piece, ',', (size_t)(end - piece)), *from = piece, *to = comma ? comma : end;
        trim(&from, &to);
        data.field[data.count] = (struct field){copy_span(reader, from, to), at(reader, begin, from, line), 0};
        if (!data.field[data.count].text)
            return;
        piece = comma ? comma + 1 : end;
    }
    if (data.count > 1 && !*data.field[data.count - 1].text) /* a comma at the end of the line */
        data.count--;
    (void)POOL_ADD(reader->pool, card->line, card->nline, &data);
}

/* Overwrites the text behind the line. Returns 1 where the file is not text, which ends the reading. */
static int read_line(struct reader *reader, char *whole, size_t length, int line)
{
    const char *line_text = whole;
    whole[length] = 0;
    const char *end = line_text + length;
    for (const char *c = line_text; c < end; c++)
        if ((unsigned char)*c < ' ' && *c != '\t') {
            text_error(reader, at(reader, line_text, c, line),
                       "byte 0x%02x is not text, expected a deck of cards that begin with *", (unsigned char)*c);
            return 1;
        }
    for (const char *c = line_text; c < end; c++) { /* what makes a line look like another one, in comments as well */
        unsigned code;
        if (*c != '\t' && text_is_control(c, &code)) {
            text_error(reader, at(reader, line_text, c, line),
                       "character U+%04X does not stand for itself, expected text without control characters", code);
            break;
        }
    }
    if (line == 1 && length >= 3 && !memcmp(line_text, "\xef\xbb\xbf", 3))
        line_text += 3; /* byte-order mark of an editor */
    for (const char *c = line_text; c + 1 < end; c++)
        if (c[0] == '*' && c[1] == '*') {
            end = c;
            break;
        }
    const char *first = line_text;
    while (first < end && isspace((unsigned char)*first))
        first++;
    if (first == end)
        return 0;
    if (*first == '*') { /* also behind a comma that nothing follows */
        if (reader->text->ncard == DECK_MOST_CARDS) {
            text_error(reader, at(reader, line_text, first, line), "the deck has more than %d cards, expected those of a rotor",
                       DECK_MOST_CARDS);
            reader->over = 1;
            return 1;
        }
        read_keyword(reader, line_text, first, end, line);
    } else if (reader->continues) {
        read_options(reader, &reader->text->card[reader->text->ncard - 1], line_text, line_text, end, line);
    } else {
        read_data(reader, line_text, end, line);
        return 0;
    }
    struct deck_text *text = reader->text;
    if (text->ncard && !reader->continues && !reader->pool->out_of_memory && !strcmp(text->card[text->ncard - 1].name, "INCLUDE"))
        include(reader, text->card[--text->ncard]);
    return 0;
}

static void too_large(struct reader *reader, const char *path)
{
    reader->over = 1;
    text_error(reader, (struct place){path, 1, 1}, "the deck is larger than %ld MiB, expected cards of a rotor",
               DECK_MOST_BYTES >> 20);
}

/* Without the carriage return at the end of a line that is not too long. */
static size_t bare_length(const char *line, size_t length)
{
    return length && length < DECK_LINE_LENGTH + 2 && line[length - 1] == '\r' ? length - 1 : length;
}

/* `path`: the file of the places in it. */
static int read_source(struct reader *reader, struct deck_source *source, const char *path)
{
    char why[HOST_ERROR_TEXT];
    if (deck_source_length(source) > reader->bytes_left) {
        too_large(reader, path);
        (void)deck_source_close(source);
        return ROTID_ERROR_SYNTAX;
    }
    reader->open_file[reader->depth] = path;
    reader->open_stat[reader->depth] = source->information;
    char line_text[DECK_LINE_LENGTH + 2] = ""; /* a carriage return may stand behind a full line, and no more */
    size_t length = 0;
    int line = 1, c, stop = 0;
    while (!stop && !reader->over && !reader->pool->out_of_memory && (c = deck_source_next(reader, source)) != DECK_SOURCE_END) {
        if (--reader->bytes_left < 0) {
            too_large(reader, path);
            break;
        }
        if (c == '\n') {
            length = bare_length(line_text, length);
            stop = length <= DECK_LINE_LENGTH && read_line(reader, line_text, length, line);
            reader->text->end = (struct place){path, line, (int)length + 1};
            line++;
            length = 0;
        } else if (length < sizeof line_text) {
            line_text[length++] = (char)c;
            if (length == sizeof line_text || (length == DECK_LINE_LENGTH + 1 && c != '\r')) {
                length = sizeof line_text;
                text_error(reader, (struct place){path, line, DECK_LINE_LENGTH + 1},
                           "the line is longer than %d characters, expected a shorter one", DECK_LINE_LENGTH);
                stop = memchr(line_text, 0, DECK_LINE_LENGTH + 1) != NULL;
            }
        }
    }
    length = bare_length(line_text, length);
    if (!stop && !reader->over && length && length <= DECK_LINE_LENGTH)
        (void)read_line(reader, line_text, length, line);
    if (length)
        reader->text->end = (struct place){path, line, (int)length + 1};
    int failed = deck_source_close(source);
    const struct deck_file read = {path, source->kept ? source->kept : ""};
    (void)POOL_ADD(reader->pool, reader->text->source, reader->text->nsource, &read);
    if (failed)
        text_error(reader, (struct place){path, line, 1}, "reading failed: %s", host_error_text(failed, why));
    reader->continues = 0;
    return ROTID_OK;
}

static int read_file(struct reader *reader, const char *path, struct place from)
{
    struct deck_source source;
    char why[HOST_ERROR_TEXT];
    int failed = deck_source_open(&source, path, !from.file);
    if (failed) {
        text_error(reader, (struct place){from.file ? from.file : path, from.line, from.column},
                   "cannot read %s: %s, expected a deck", path, file_error_text(failed, why));
        reader->pool->out_of_memory |= file_status(failed) == ROTID_ERROR_MEMORY;
        return file_status(failed);
    }
    (void)deck_text_add_file(reader->pool, reader->text, path);
    reader->depth += from.file != NULL;
    int status = read_source(reader, &source, path);
    reader->depth -= from.file != NULL;
    return status;
}

static int conclude(const struct reader *reader, int status)
{
    if (reader->pool->out_of_memory || reader->messages->pool->out_of_memory)
        return ROTID_ERROR_MEMORY;
    return status ? status : reader->messages->errors ? ROTID_ERROR_SYNTAX : ROTID_OK;
}

int deck_text_read(struct pool *pool, const char *path, struct message_list *messages, struct deck_text *text)
{
    struct reader reader = {.pool = pool, .messages = messages, .text = text, .bytes_left = DECK_MOST_BYTES};
    *text = (struct deck_text){.end = {path, 1, 1}};
    return conclude(&reader, read_file(&reader, path, (struct place){NULL, 1, 1}));
}

int deck_text_read_memory(struct pool *pool, const struct deck_memory *memory, struct message_list *messages,
                          struct deck_text *text)
{
    struct reader reader = {.pool = pool, .messages = messages, .text = text, .bytes_left = DECK_MOST_BYTES};
    struct deck_source source = {.text = memory->text, .left = memory->length};
    *text = (struct deck_text){.end = {memory->name, 1, 1}, .memory = memory->name, .directory = memory->directory};
    return conclude(&reader, read_source(&reader, &source, memory->name));
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

int deck_text_override(struct pool *pool, const struct override *override, struct message_list *messages, struct deck_text *text)
{
    static const char *const single[] = {"FIT", "NOISE", "SLING", "MEASURED", "FRF"};
    struct place place = {override->text, 1, 1};
    struct card_option option = {override->option, override->value, place, place, 1};
    int found = 0;
    for (int i = 0; i < text->ncard; i++)
        found |= same_text(text->card[i].name, override->card);
    for (size_t s = 0; s < sizeof single / sizeof *single && !found; s++)
        if (same_text(single[s], override->card)) {
            if (!deck_text_add_card(pool, text, single[s], place))
                return ROTID_ERROR_MEMORY;
            found = 1;
        }
    if (!found)
        return message_refuse(messages, ROTID_ERROR_SYNTAX, place.file, 1, 1,
                              "the deck has no card *%s, expected one that it has", override->card);
    for (int i = 0; i < text->ncard; i++) {
        struct card *card = &text->card[i];
        if (!same_text(card->name, override->card))
            continue;
        struct card_option *present = (struct card_option *)card_option(card, override->option);
        if (present)
            *present = option;
        else if (deck_text_add_option(pool, card, option))
            return ROTID_ERROR_MEMORY;
    }
    return ROTID_OK;
}
