#include "comments.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "rotid.h"

#define NAME_MOST 128

/* A comment from its first character to its end, in one line, with the words of JSON. */
static char *clean(struct pool *pool, const char *from, const char *to)
{
    static const char *const unknown[] = {"NULL", "NaN", "ROTID_NONE"};
    char *text = POOL_ARRAY(pool, char, 2 * (to - from) + 1), *end = text;
    int is_first = 0; /* of a line */
    while (text && from < to) {
        int blank = isspace((unsigned char)*from);
        size_t skip = 1, i = 0;
        while (i < 3 && strncmp(from, unknown[i], strlen(unknown[i])) != 0)
            i++;
        if (i < 3) {
            skip = strlen(unknown[i]);
            memcpy(end, "null", 4);
            end += 4;
        } else if (from[0] == '*' && is_first) {
            skip = 1; /* of a comment that goes on */
        } else if (!blank || (end > text && end[-1] != ' ')) {
            *end++ = blank ? ' ' : *from;
        }
        is_first = *from == '\n' || (is_first && blank);
        from += skip;
    }
    while (end > text && end[-1] == ' ')
        end--;
    if (text)
        *end = 0;
    return text;
}

static int add(struct comments *comments, const char *structure, const char *member, const char *text)
{
    struct comment *list = pool_grow(comments->pool, comments->item, (size_t)comments->count, &comments->capacity, sizeof *list);
    if (!list)
        return ROTID_ERROR_MEMORY;
    comments->item = list;
    list[comments->count++] =
        (struct comment){pool_copy_text(comments->pool, structure), member ? pool_copy_text(comments->pool, member) : NULL, text};
    return text ? ROTID_OK : ROTID_ERROR_MEMORY;
}

/* The comment that begins after blanks at `at`, or NULL; *end is set behind it. */
static char *comment_at(struct pool *pool, const char *at, const char **end)
{
    at += strspn(at, " ");
    const char *close = strncmp(at, "/*", 2) ? NULL : strstr(at, "*/");
    if (!close)
        return NULL;
    *end = close + 2;
    return clean(pool, at + 2, close);
}

/* The declarators of one declaration, each with the comment behind it. */
static int add_members(struct comments *comments, const char *structure, const char *begin, const char *end, const char *text)
{
    int status = ROTID_OK;
    for (const char *at = end; at > begin && !status;) { /* names stand before ; and , */
        const char *last = at;
        if (last > begin && last[-1] == ']') /* of an array */
            while (last > begin && *last != '[')
                last--;
        const char *first = last;
        while (first > begin && (isalnum((unsigned char)first[-1]) || first[-1] == '_'))
            first--;
        char name[NAME_MOST];
        (void)snprintf(name, sizeof name, "%.*s", (int)(last - first), first);
        status = add(comments, structure, name, text);
        while (first > begin && *first != ',')
            first--;
        if (first == begin)
            break;
        at = first;
    }
    return status;
}

static int add_struct(struct comments *comments, const char *structure, const char *body)
{
    int status = ROTID_OK;
    while (!status) {
        body += strspn(body, " \n");
        const char *end = body + strcspn(body, ";}"), *after;
        if (!strncmp(body, "/*", 2)) { /* a comment of its own line speaks of the members below it */
            body = strstr(body, "*/");
            if (!body)
                return status;
            body += 2;
            continue;
        }
        if (*end != ';')
            return status;
        char *text = comment_at(comments->pool, end + 1, &after);
        if (text)
            status = add_members(comments, structure, body, end, text);
        body = text ? after : end + 1;
    }
    return status;
}

/* The comment that ends right above the line, as that of the struct. */
static int add_above(struct comments *comments, const char *header, const char *line, const char *structure)
{
    if (line - header <= 3 || strncmp(line - 3, "*/\n", 3) != 0)
        return ROTID_OK;
    const char *open = line - 3;
    while (open > header && strncmp(open, "/*", 2) != 0)
        open--;
    return add(comments, structure, NULL, clean(comments->pool, open + 2, line - 3));
}

/* Of src/result/results.def: BEGIN(struct) or OF(struct, ...), then a line a member, KEY(kind, struct, member, ...), PART and AT
 * alike or MEMBER(type, member), each with its comment behind. */
static int add_described(struct comments *comments, const char *text)
{
    char structure[NAME_MOST] = "", member[NAME_MOST];
    int status = ROTID_OK;
    for (const char *line = text, *after; *line && !status; line += strcspn(line, "\n"), line += *line == '\n') {
        if (sscanf(line, "BEGIN(%127[a-z_0-9])", structure) == 1 || sscanf(line, "OF(%127[a-z_0-9]", structure) == 1) {
            status = add_above(comments, text, line, structure);
            continue;
        }
        int found = sscanf(line, "KEY(%*[^,], %*[^,], %127[a-z_0-9]", member) == 1 ||
                    sscanf(line, "PART(%*[^,], %*[^,], %127[a-z_0-9]", member) == 1 ||
                    sscanf(line, "ON(%*[^,], %*[^,], %127[a-z_0-9]", member) == 1 ||
                    sscanf(line, "IS(%*[^,], %*[^,], %127[a-z_0-9]", member) == 1 ||
                    sscanf(line, "IS%*[_A-Z](%*[^,], %*[^,], %127[a-z_0-9]", member) == 1 ||
                    sscanf(line, "MEMBER(%*[^,], %127[a-z_0-9]", member) == 1;
        const char *comment = found ? strstr(line, "/*") : NULL, *end = line + strcspn(line, "\n");
        while (*end && end[1] == ' ') /* a line that goes on */
            end += 1 + strcspn(end + 1, "\n");
        if (comment && comment < end)
            status = add(comments, structure, member, comment_at(comments->pool, comment, &after));
    }
    return status;
}

int comments_add(struct comments *comments, const char *header)
{
    int status = ROTID_OK;
    for (const char *at = header; (at = strstr(at, "struct ")) && !status; at++) {
        char name[NAME_MOST];
        const char *word = at + strlen("struct "), *line = at;
        size_t length = strcspn(word, " ;*,)\n");
        if (strncmp(word + length, " {\n", 3) != 0 || length >= sizeof name)
            continue;
        while (line > header && line[-1] != '\n')
            line--;
        (void)snprintf(name, sizeof name, "%.*s", (int)length, word);
        status = add_above(comments, header, line, name);
        if (!status)
            status = add_struct(comments, name, word + length + 3);
    }
    return status ? status : add_described(comments, header);
}

const char *comments_find(const struct comments *comments, const char *structure, const char *member)
{
    for (int i = 0; i < comments->count; i++) {
        const struct comment *c = &comments->item[i];
        if (!strcmp(c->structure, structure) && (member ? c->member && !strcmp(c->member, member) : !c->member))
            return c->text;
    }
    return NULL;
}
