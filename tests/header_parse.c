#include <errno.h>

#include "header.h"
#include "header_tokens.h"

struct parser {
    struct pool *pool;
    struct tokens tokens;
    const struct token *at; /* the next one */
    struct header *header;
    struct header_constant *constant;
    struct header_struct *structure;
    struct header_function *callback, *function;
    size_t constants, structs, callbacks, functions; /* room for */
};

static int fail(struct parser *parser, const char *error)
{
    parser->header->error = error;
    parser->header->line = parser->at->line;
    return -1;
}

static int expected(struct parser *parser, const char *what)
{
    return fail(parser, pool_format(parser->pool, "expected %s, not %s", what, parser->at->text));
}

static int no_memory(struct parser *parser)
{
    return fail(parser, "no memory");
}

static int is(const struct token *token, const char *text)
{
    return (token->kind == TOKEN_NAME || token->kind == TOKEN_MARK) && strcmp(token->text, text) == 0;
}

/* Past this token where it stands next. */
static int skip(struct parser *parser, const char *text)
{
    int found = is(parser->at, text);
    parser->at += found;
    return found;
}

static int need(struct parser *parser, const char *text)
{
    return skip(parser, text) ? 0 : expected(parser, text);
}

static int take_name(struct parser *parser, const char **name)
{
    if (parser->at->kind != TOKEN_NAME)
        return expected(parser, "a name");
    *name = (parser->at++)->text;
    return 0;
}

/* A whole number, with its sign, alone or in brackets, or a constant read before. */
static int take_number(struct parser *parser, long *value)
{
    int bracket = skip(parser, "("), negative = skip(parser, "-");
    const struct header_constant *constant =
        parser->at->kind == TOKEN_NAME ? header_constant(parser->header, parser->at->text) : NULL;
    char *end;
    errno = 0;
    *value = constant ? constant->value : strtol(parser->at->text, &end, 0);
    if (!constant && (parser->at->kind != TOKEN_NUMBER || *end || errno))
        return expected(parser, "a whole number");
    parser->at++;
    *value = negative ? -*value : *value;
    return bracket ? need(parser, ")") : 0;
}

static int add_constant(struct parser *parser, struct header_constant constant)
{
    size_t count = (size_t)parser->header->nconstant;
    parser->constant = pool_grow(parser->pool, parser->constant, count, &parser->constants, sizeof constant);
    if (!parser->constant)
        return no_memory(parser);
    parser->constant[count] = constant;
    parser->header->constant = parser->constant;
    parser->header->nconstant++;
    return 0;
}

/* ---- types */

static int is_part_of_number(const char *text)
{
    static const char *const words[] = {"unsigned", "signed", "short", "long", "int", "char", "double", NULL};
    int i = 0;
    while (words[i] && strcmp(words[i], text) != 0)
        i++;
    return words[i] != NULL;
}

/* const, struct, and the words of the base: "unsigned long" are two. */
static int take_base(struct parser *parser, struct header_type *type)
{
    *type = (struct header_type){NULL, 0, (unsigned)skip(parser, "const")};
    int number = !skip(parser, "struct") && is_part_of_number(parser->at->text);
    if (take_name(parser, &type->base))
        return -1;
    while (number && type->base && is_part_of_number(parser->at->text))
        type->base = pool_format(parser->pool, "%s %s", type->base, (parser->at++)->text);
    type->constant |= (unsigned)skip(parser, "const");
    return type->base ? 0 : no_memory(parser);
}

static void take_pointers(struct parser *parser, struct header_type *type)
{
    while (skip(parser, "*")) {
        type->pointers++;
        type->constant |= (unsigned)skip(parser, "const") << type->pointers;
    }
}

static int take_parameters(struct parser *parser, struct header_function *function);

/* What follows the base: * name [length], or (*name)(parameters). A name may be missing where `nameless`. */
static int take_declarator(struct parser *parser, struct header_type base, int nameless, struct header_variable *variable)
{
    *variable = (struct header_variable){.name = "", .type = base, .line = parser->at->line};
    take_pointers(parser, &variable->type);
    if (skip(parser, "(")) {
        struct header_function *callback = POOL_NEW(parser->pool, struct header_function);
        if (!callback)
            return no_memory(parser);
        *callback = (struct header_function){.name = "", .result = variable->type, .line = variable->line};
        variable->type = (struct header_type){NULL, 0, 0};
        variable->callback = callback;
        return need(parser, "*") || take_name(parser, &variable->name) || need(parser, ")") ? -1
                                                                                            : take_parameters(parser, callback);
    }
    if ((!nameless || parser->at->kind == TOKEN_NAME) && take_name(parser, &variable->name))
        return -1;
    if (!skip(parser, "["))
        return 0;
    long length = 0;
    if (take_number(parser, &length) || need(parser, "]"))
        return -1;
    variable->length = (int)length;
    return length > 0 && length < 1 << 20 ? 0 : fail(parser, "an array of an unusual length");
}

static int take_parameters(struct parser *parser, struct header_function *function)
{
    struct header_variable *parameter = NULL;
    size_t capacity = 0;
    if (need(parser, "("))
        return -1;
    if (is(parser->at, "void") && is(parser->at + 1, ")"))
        parser->at++;
    else
        do {
            struct header_type base;
            parameter = pool_grow(parser->pool, parameter, (size_t)function->nparameter, &capacity, sizeof *parameter);
            if (!parameter)
                return no_memory(parser);
            if (take_base(parser, &base) || take_declarator(parser, base, 1, &parameter[function->nparameter++]))
                return -1;
        } while (skip(parser, ","));
    function->parameter = parameter;
    return need(parser, ")");
}

/* ---- declarations */

/* The members from behind { to }. */
static int take_members(struct parser *parser, struct header_struct *structure)
{
    struct header_variable *member = NULL;
    size_t capacity = 0;
    while (!skip(parser, "}")) {
        struct header_type base;
        if (take_base(parser, &base))
            return -1;
        do {
            member = pool_grow(parser->pool, member, (size_t)structure->nmember, &capacity, sizeof *member);
            if (!member)
                return no_memory(parser);
            if (take_declarator(parser, base, 0, &member[structure->nmember++]))
                return -1;
        } while (skip(parser, ","));
        if (need(parser, ";"))
            return -1;
    }
    structure->member = member;
    structure->complete = 1;
    return 0;
}

/* After `struct`: [name] { members } or name; a struct may be announced before. */
static int take_struct(struct parser *parser, int is_typedef)
{
    struct header_struct structure = {.line = parser->at->line}, *place = NULL;
    const char *alias = NULL;
    if (take_name(parser, &structure.name) || (skip(parser, "{") && take_members(parser, &structure)))
        return -1;
    if (is_typedef && (take_name(parser, &alias) || strcmp(alias, structure.name) != 0))
        return fail(parser, pool_format(parser->pool, "the typedef of struct %s has another name", structure.name));
    for (int i = 0; i < parser->header->nstruct; i++)
        if (strcmp(parser->structure[i].name, structure.name) == 0)
            place = &parser->structure[i];
    if (place && place->complete)
        return fail(parser, pool_format(parser->pool, "struct %s is declared twice", structure.name));
    if (!place) {
        size_t count = (size_t)parser->header->nstruct++;
        parser->structure = pool_grow(parser->pool, parser->structure, count, &parser->structs, sizeof structure);
        if (!parser->structure)
            return no_memory(parser);
        place = &parser->structure[count];
    }
    *place = structure;
    return need(parser, ";");
}

/* A macro applied to the entries of a list, LIST(ENTRY): name, value and text of each. */
static int take_list(struct parser *parser, const struct define *list)
{
    const struct token *after = parser->at;
    parser->at = list->value;
    while (parser->at->kind != TOKEN_END) {
        struct header_constant constant = {.kind = HEADER_STATUS, .line = parser->at->line};
        if (need(parser, list->parameter) || need(parser, "(") || take_name(parser, &constant.name) || need(parser, ",") ||
            take_number(parser, &constant.value) || need(parser, ","))
            return -1;
        if (parser->at->kind != TOKEN_TEXT)
            return expected(parser, "a text");
        constant.text = (parser->at++)->text;
        if (need(parser, ")") || add_constant(parser, constant))
            return -1;
    }
    parser->at = after;
    return 0;
}

static int take_enum(struct parser *parser)
{
    long next = 0;
    if (need(parser, "{"))
        return -1;
    while (!skip(parser, "}")) {
        struct header_constant constant = {.kind = HEADER_ENUM, .line = parser->at->line};
        if (take_name(parser, &constant.name))
            return -1;
        if (skip(parser, "(")) {
            const struct define *list = NULL;
            for (int i = 0; i < parser->tokens.ndefine; i++)
                if (strcmp(parser->tokens.define[i].name, constant.name) == 0 && parser->tokens.define[i].parameter)
                    list = &parser->tokens.define[i];
            const char *entry;
            if (!list)
                return fail(parser, pool_format(parser->pool, "%s is no list of this header", constant.name));
            if (take_name(parser, &entry) || need(parser, ")") || take_list(parser, list))
                return -1;
        } else {
            constant.value = next;
            if ((skip(parser, "=") && take_number(parser, &constant.value)) || add_constant(parser, constant))
                return -1;
            next = constant.value + 1;
        }
        if (!skip(parser, ",") && !is(parser->at, "}"))
            return expected(parser, ", or }");
    }
    return need(parser, ";");
}

/* A function, or the typedef of a pointer to one. */
static int take_function(struct parser *parser, int is_typedef)
{
    struct header_function function = {.line = parser->at->line}, *all = is_typedef ? parser->callback : parser->function;
    int *count = is_typedef ? &parser->header->ncallback : &parser->header->nfunction;
    struct header_variable variable;
    struct header_type base;
    if (take_base(parser, &base) || take_declarator(parser, base, 0, &variable))
        return -1;
    if (is_typedef && variable.callback)
        function = *variable.callback;
    else if (is_typedef)
        return fail(parser, "a typedef of neither a struct nor a pointer to a function");
    else if (variable.callback || variable.length)
        return fail(parser, "neither a type nor a function");
    else {
        function.result = variable.type;
        if (take_parameters(parser, &function))
            return -1;
    }
    function.name = variable.name;
    all = pool_grow(parser->pool, all, (size_t)*count, is_typedef ? &parser->callbacks : &parser->functions, sizeof *all);
    if (!all)
        return no_memory(parser);
    all[(*count)++] = function;
    *(is_typedef ? &parser->callback : &parser->function) = all;
    return need(parser, ";");
}

/* #define NAME number and #define NAME "text"; others, such as attributes, are not the interface's. */
static int take_defines(struct parser *parser)
{
    for (int i = 0; i < parser->tokens.ndefine; i++) {
        const struct define *define = &parser->tokens.define[i];
        struct header_constant constant = {.name = define->name, .kind = HEADER_DEFINE, .line = define->line};
        parser->at = define->value;
        int is_text = parser->at->kind == TOKEN_TEXT;
        if (define->parameter || !(is_text || parser->at->kind == TOKEN_NUMBER || is(parser->at, "(") || is(parser->at, "-")))
            continue;
        if (is_text) {
            constant.kind = HEADER_TEXT;
            constant.text = (parser->at++)->text;
        } else if (take_number(parser, &constant.value))
            return -1;
        if (parser->at->kind != TOKEN_END)
            return expected(parser, "the end of the line");
        if (add_constant(parser, constant))
            return -1;
    }
    return 0;
}

int header_parse(struct pool *pool, const char *text, struct header *header)
{
    struct parser parser = {.pool = pool, .header = header};
    *header = (struct header){0};
    int status = tokens_read(pool, text, &parser.tokens, &header->line, &header->error);
    if (status)
        return status;
    header->line = 0;
    status = take_defines(&parser);
    parser.at = status ? parser.at : parser.tokens.token;
    while (!status && parser.at->kind != TOKEN_END) {
        int is_typedef = skip(&parser, "typedef"), is_public = !is_typedef && skip(&parser, "ROTID_API");
        if (!is_public && skip(&parser, "struct"))
            status = take_struct(&parser, is_typedef);
        else if (!is_public && !is_typedef && skip(&parser, "enum"))
            status = take_enum(&parser);
        else
            status =
                is_public || is_typedef ? take_function(&parser, is_typedef) : expected(&parser, "a declaration with ROTID_API");
    }
    header->structure = parser.structure;
    header->callback = parser.callback;
    header->function = parser.function;
    return status;
}
