#include "header_tokens.h"

#include <ctype.h>

#define MOST_CONDITIONS 16

struct reader {
    struct pool *pool;
    int line;
    const char *error;
};

static int wrong(struct reader *reader, const char *error)
{
    reader->error = error;
    return -1;
}

/* Comments become blanks; a line break inside one, or behind a backslash, becomes \v: it counts as a line but ends none. */
static int strip(struct reader *reader, char *text)
{
    for (char *at = text; *at; at++) {
        if (*at == '"') {
            for (at++; *at && *at != '"' && *at != '\n'; at++)
                at += *at == '\\' && at[1];
            if (*at != '"')
                return wrong(reader, "a text without its closing quote");
        } else if (*at == '\\' && at[1] == '\n') {
            *at++ = ' ';
            *at = '\v';
        } else if (*at == '/' && at[1] == '/') {
            for (; at[0] && at[0] != '\n'; at++)
                *at = ' ';
            at--;
        } else if (*at == '/' && at[1] == '*') {
            for (*at++ = ' ', *at++ = ' '; *at && !(at[0] == '*' && at[1] == '/'); at++)
                *at = *at == '\n' ? '\v' : ' ';
            if (!*at)
                return wrong(reader, "a comment without its end");
            at[0] = at[1] = ' ';
            at++;
        } else if (*at == '\n')
            reader->line++;
    }
    reader->line = 1;
    return 0;
}

static char *copy(struct pool *pool, const char *from, const char *to)
{
    char *text = pool_get(pool, (size_t)(to - from) + 1, 1);
    return text ? memcpy(text, from, (size_t)(to - from)) : NULL;
}

/* The tokens from `at` up to `end`, and TOKEN_END; NULL after an error. *line is that of `at`, and of `end` afterwards. */
static struct token *scan(struct reader *reader, const char *at, const char *end)
{
    struct token *token = POOL_ARRAY(reader->pool, struct token, end - at + 1);
    int count = 0;
    while (token && at < end) {
        const char *from = at++;
        enum token_kind kind = TOKEN_MARK;
        if (isspace((unsigned char)*from)) {
            reader->line += *from == '\n' || *from == '\v';
            continue;
        }
        if (isalpha((unsigned char)*from) || *from == '_')
            kind = TOKEN_NAME;
        else if (isdigit((unsigned char)*from))
            kind = TOKEN_NUMBER;
        else if (*from == '"')
            kind = TOKEN_TEXT;
        if (kind == TOKEN_TEXT) {
            for (from++; *at != '"'; at++)
                at += *at == '\\';
        } else if (kind != TOKEN_MARK)
            while (at < end && (isalnum((unsigned char)*at) || *at == '_'))
                at++;
        token[count] = (struct token){kind, copy(reader->pool, from, at), reader->line};
        if (!token[count++].text)
            return NULL;
        at += kind == TOKEN_TEXT;
    }
    if (token)
        token[count] = (struct token){TOKEN_END, "the end", reader->line};
    return token;
}

static int take_define(struct reader *reader, const char *at, const char *end, struct define *define)
{
    const char *from = at + strspn(at, " ");
    for (at = from; isalnum((unsigned char)*at) || *at == '_';)
        at++;
    *define = (struct define){.name = copy(reader->pool, from, at), .line = reader->line};
    int has_parameter = *at == '(';
    if (has_parameter) {
        const char *close = memchr(at, ')', (size_t)(end - at));
        if (!close)
            return wrong(reader, "parameters of a macro without their bracket");
        from = ++at;
        while (isalnum((unsigned char)*at) || *at == '_')
            at++;
        define->parameter = copy(reader->pool, from, at);
        at = close + 1;
    }
    define->value = scan(reader, at, end);
    reader->line = define->line;
    int whole = define->name && define->value && (define->parameter || !has_parameter);
    return whole ? 0 : wrong(reader, "no memory");
}

static int starts(const char *text, const char *word)
{
    return strncmp(text, word, strlen(word)) == 0;
}

/* Conditions, innermost last: is this branch read. */
struct conditions {
    int depth, taken[MOST_CONDITIONS + 1];
};

static int take_condition(struct reader *reader, struct conditions *conditions, const char *at)
{
    if (starts(at, "if")) {
        if (conditions->depth == MOST_CONDITIONS)
            return wrong(reader, "conditions too deep");
        int outer = conditions->taken[conditions->depth++];
        conditions->taken[conditions->depth] = outer && !starts(at, "ifdef __cplusplus");
    } else if (starts(at, "elif"))
        return wrong(reader, "#elif is not understood");
    else if (starts(at, "else"))
        conditions->taken[conditions->depth] =
            conditions->depth && conditions->taken[conditions->depth - 1] && !conditions->taken[conditions->depth];
    else if (starts(at, "endif") && conditions->depth-- == 0)
        return wrong(reader, "#endif without its #if");
    return 0;
}

int tokens_read(struct pool *pool, const char *text, struct tokens *tokens, int *line, const char **error)
{
    struct reader reader = {pool, 1, NULL};
    struct conditions conditions = {0, {1}};
    struct define *define = NULL;
    size_t capacity = 0;
    char *copied = pool_copy_text(pool, text);
    int status = copied ? strip(&reader, copied) : wrong(&reader, "no memory");
    *tokens = (struct tokens){0};
    for (char *at = copied; !status && *at;) {
        char *end = at + strcspn(at, "\n"), *mark = at + strspn(at, " \v");
        int is_directive = *mark == '#', taken = conditions.taken[conditions.depth];
        if (is_directive) {
            mark += 1 + strspn(mark + 1, " ");
            if (starts(mark, "define ") && taken) {
                define = pool_grow(pool, define, (size_t)tokens->ndefine, &capacity, sizeof *define);
                status = define ? take_define(&reader, mark + 7, end, &define[tokens->ndefine++]) : wrong(&reader, "no memory");
            } else
                status = take_condition(&reader, &conditions, mark);
        }
        for (; at < end; at++) {
            reader.line += *at == '\v' && !status;
            if ((is_directive || !taken) && *at != '\v')
                *at = ' ';
        }
        reader.line += *at == '\n' && !status;
        at += *at == '\n';
    }
    if (!status && conditions.depth)
        status = wrong(&reader, "#if without its #endif");
    if (!status) {
        reader.line = 1;
        tokens->token = scan(&reader, copied, copied + strlen(copied));
        tokens->define = define;
        if (!tokens->token)
            status = wrong(&reader, "no memory");
    }
    *line = reader.line;
    *error = reader.error;
    return status;
}
