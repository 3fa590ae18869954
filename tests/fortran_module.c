#include "fortran_module.h"

#include <ctype.h>

enum scope { OUTSIDE, MODULE, TYPE, INTERFACE, PROCEDURE };

struct reader {
    struct pool *pool;
    struct fortran_module *module;
    size_t parameters, types, procedures, variables; /* room */
    enum scope scope;
    int is_abstract; /* of the interface */
    int done;        /* what follows are no declarations */
    int line;        /* where the statement begins */
};

static int wrong(struct reader *reader, const char *what, const char *statement)
{
    reader->module->line = reader->line;
    reader->module->error = pool_format(reader->pool, "%s: %.80s", what, statement);
    return -1;
}

static char *copy(struct pool *pool, const char *from, const char *to)
{
    char *text = pool_get(pool, (size_t)(to - from) + 1, 1);
    return text ? memcpy(text, from, (size_t)(to - from)) : NULL;
}

/* If *at begins with the text, steps over it. */
static int skip(const char **at, const char *text)
{
    size_t length = strlen(text);
    if (strncmp(*at, text, length) != 0)
        return 0;
    *at += length;
    return 1;
}

/* The end of the part that begins here: a comma, = or :: outside brackets and quotes, the bracket that closes, or the end. */
static const char *part_end(const char *at)
{
    int depth = 0;
    for (; *at; at++) {
        if (*at == '"') {
            at += 1 + strcspn(at + 1, "\"");
            if (!*at)
                return at;
        } else if (*at == '(' || *at == '[') {
            depth++;
        } else if (*at == ')' || *at == ']') {
            if (depth-- == 0)
                return at;
        } else if (depth == 0 && (*at == ',' || *at == '=' || (at[0] == ':' && at[1] == ':'))) {
            return at;
        }
    }
    return at;
}

static const char *name_at(struct reader *reader, const char **at)
{
    const char *from = *at;
    while (isalnum((unsigned char)**at) || **at == '_')
        ++*at;
    return *at > from ? copy(reader->pool, from, *at) : NULL;
}

/* What stands in the brackets that open at *at; "" without brackets, NULL after an error. */
static const char *brackets(struct reader *reader, const char **at)
{
    if (!skip(at, "("))
        return "";
    const char *from = *at;
    while (*(*at = part_end(*at)) && **at != ')')
        ++*at;
    const char *text = copy(reader->pool, from, *at);
    return skip(at, ")") ? text : NULL;
}

/* The place for a declared variable: a new member or parameter, or the argument or result of that name. */
static struct fortran_variable *place(struct reader *reader, const char *name, int is_parameter)
{
    struct fortran_module *module = reader->module;
    if (reader->scope == PROCEDURE) {
        struct fortran_procedure *procedure = &module->procedure[module->nprocedure - 1];
        if (procedure->result.name && strcmp(procedure->result.name, name) == 0)
            return &procedure->result;
        for (int i = 0; i < procedure->nargument; i++)
            if (strcmp(procedure->argument[i].name, name) == 0)
                return &procedure->argument[i];
        return NULL;
    }
    if (reader->scope == TYPE) {
        struct fortran_type *type = &module->type[module->ntype - 1];
        type->member =
            pool_grow(reader->pool, type->member, (size_t)type->nmember, &reader->variables, sizeof(struct fortran_variable));
        return type->member ? &type->member[type->nmember++] : NULL;
    }
    if (!is_parameter)
        return NULL;
    module->parameter = pool_grow(reader->pool, module->parameter, (size_t)module->nparameter, &reader->parameters,
                                  sizeof(struct fortran_variable));
    return module->parameter ? &module->parameter[module->nparameter++] : NULL;
}

/* integer(c_int), value :: a, b(2) = 0 */
static int declare(struct reader *reader, const char *statement)
{
    const char *at = part_end(statement), *attribute;
    struct fortran_variable all = {.type = copy(reader->pool, statement, at), .line = reader->line};
    int is_parameter = 0;
    for (; skip(&at, ","); at = part_end(at)) {
        attribute = copy(reader->pool, at, part_end(at));
        if (attribute && strcmp(attribute, "value") == 0)
            all.by_value = 1;
        else if (attribute && strcmp(attribute, "parameter") == 0)
            is_parameter = 1;
        else if (attribute && strncmp(attribute, "intent(", 7) == 0) {
            all.reads = strstr(attribute, "(in") != NULL;
            all.writes = strstr(attribute, "out)") != NULL;
        } else if (!attribute || strcmp(attribute, "target") != 0) {
            return wrong(reader, "an attribute that C does not know", statement);
        }
    }
    if (!skip(&at, "::"))
        return wrong(reader, "no statement that is known here", statement);
    do {
        const char *name = name_at(reader, &at), *shape = name ? brackets(reader, &at) : NULL, *initial = NULL;
        if (name && skip(&at, "=")) {
            const char *from = at;
            at = part_end(at);
            initial = copy(reader->pool, from, at);
        }
        struct fortran_variable *variable = name && shape ? place(reader, name, is_parameter) : NULL;
        if (!variable || variable->type)
            return wrong(reader, variable ? "declared twice" : "a variable that cannot stand here", statement);
        *variable = all;
        variable->name = name;
        variable->shape = shape;
        variable->initial = initial;
    } while (skip(&at, ","));
    return *at ? wrong(reader, "expected the end of the statement", at) : 0;
}

/* rotid_mac(n,a,b)result(mac)bind(c,name="rotid_mac") */
static int open_procedure(struct reader *reader, const char *at, int is_function)
{
    struct fortran_module *module = reader->module;
    const char *statement = at;
    struct fortran_variable *argument = NULL;
    size_t room = 0;
    int count = 0;
    const char *name = name_at(reader, &at), *result = NULL, *binding = NULL;
    if (!name || !skip(&at, "("))
        return wrong(reader, "no procedure", statement);
    while (*at && *at != ')') {
        argument = pool_grow(reader->pool, argument, (size_t)count, &room, sizeof *argument);
        const char *argument_name = name_at(reader, &at);
        if (!argument || !argument_name)
            return wrong(reader, "no list of arguments", statement);
        argument[count++] = (struct fortran_variable){.name = argument_name, .line = reader->line};
        (void)skip(&at, ",");
    }
    (void)skip(&at, ")");
    if (skip(&at, "result("))
        result = name_at(reader, &at), (void)skip(&at, ")");
    if (is_function && !result)
        result = name;
    if (!skip(&at, "bind(c"))
        return wrong(reader, "a procedure without bind(C)", statement);
    if (skip(&at, ",name=\""))
        binding = name_at(reader, &at), (void)skip(&at, "\"");
    if (!skip(&at, ")") || *at)
        return wrong(reader, "expected the end of the statement", at);
    module->procedure = pool_grow(reader->pool, module->procedure, (size_t)module->nprocedure, &reader->procedures,
                                  sizeof(struct fortran_procedure));
    if (!module->procedure)
        return wrong(reader, "no memory", statement);
    module->procedure[module->nprocedure++] = (struct fortran_procedure){.name = name,
                                                                         .binding = binding,
                                                                         .is_abstract = reader->is_abstract,
                                                                         .result = {.name = result},
                                                                         .nargument = count,
                                                                         .argument = argument,
                                                                         .line = reader->line};
    reader->scope = PROCEDURE;
    return 0;
}

static int open_type(struct reader *reader, const char *name)
{
    struct fortran_module *module = reader->module;
    module->type = pool_grow(reader->pool, module->type, (size_t)module->ntype, &reader->types, sizeof(struct fortran_type));
    if (!module->type)
        return wrong(reader, "no memory", name);
    module->type[module->ntype++] = (struct fortran_type){.name = name_at(reader, &name), .line = reader->line};
    reader->variables = 0;
    reader->scope = TYPE;
    return 0;
}

static int close_procedure(struct reader *reader, const char *statement)
{
    const struct fortran_procedure *procedure = &reader->module->procedure[reader->module->nprocedure - 1];
    int whole = !procedure->result.name || procedure->result.type;
    for (int i = 0; i < procedure->nargument; i++)
        whole = whole && procedure->argument[i].type;
    reader->scope = INTERFACE;
    return whole ? 0 : wrong(reader, "an argument or the result is not declared", statement);
}

/* A statement without comments and with no blanks but between words. */
static int take(struct reader *reader, const char *statement)
{
    const char *at = statement;
    switch (reader->scope) {
    case OUTSIDE:
        reader->scope = MODULE;
        return skip(&at, "module ") ? 0 : wrong(reader, "expected a module", statement);
    case MODULE:
        reader->done = strcmp(at, "contains") == 0 || skip(&at, "end module");
        if (reader->done || skip(&at, "use ") || skip(&at, "use,") || skip(&at, "implicit none") || skip(&at, "private"))
            return 0;
        if (skip(&at, "type,bind(c)::"))
            return open_type(reader, at);
        reader->is_abstract = skip(&at, "abstract ");
        if (skip(&at, "interface")) {
            reader->scope = INTERFACE;
            return 0;
        }
        return declare(reader, statement);
    case TYPE:
        if (!skip(&at, "end type"))
            return declare(reader, statement);
        reader->scope = MODULE;
        return 0;
    case INTERFACE:
        if (skip(&at, "end interface")) {
            reader->scope = MODULE;
            return 0;
        }
        if (skip(&at, "module procedure "))
            return 0;
        (void)skip(&at, "pure ");
        if (skip(&at, "function "))
            return open_procedure(reader, at, 1);
        if (skip(&at, "subroutine "))
            return open_procedure(reader, at, 0);
        return wrong(reader, "no statement that is known here", statement);
    case PROCEDURE:
        if (skip(&at, "import"))
            return 0;
        if (skip(&at, "end function") || skip(&at, "end subroutine"))
            return close_procedure(reader, statement);
        return declare(reader, statement);
    }
    return 0;
}

/* Appends a line to the statement: without its comment, in lower case, blanks only between two words. Nonzero: it goes on. */
static int append(const char *line, const char *end, char *statement, size_t *length)
{
    int quoted = 0, blank = 0;
    size_t from = *length;
    for (const char *at = line; at < end && (quoted || *at != '!'); at++) {
        quoted ^= *at == '"';
        if (!quoted && isspace((unsigned char)*at)) {
            blank = 1;
            continue;
        }
        char before = *length ? statement[*length - 1] : ' ', now = quoted ? *at : (char)tolower((unsigned char)*at);
        if (blank && (isalnum((unsigned char)before) || before == '_') && (isalnum((unsigned char)now) || now == '_'))
            statement[(*length)++] = ' ';
        blank = 0;
        if (now == '&' && !quoted && *length == from && from) /* the mark where a continued line goes on */
            continue;
        statement[(*length)++] = now;
    }
    int goes_on = *length > from && statement[*length - 1] == '&';
    *length -= (size_t)goes_on;
    statement[*length] = '\0';
    return goes_on || (*length == from && from);
}

int fortran_parse(struct pool *pool, const char *text, struct fortran_module *module)
{
    *module = (struct fortran_module){0};
    struct reader reader = {.pool = pool, .module = module};
    char *statement = pool_get(pool, 2 * strlen(text) + 1, 1); /* a blank may be added before each character */
    size_t length = 0;
    int line = 1, status = statement ? 0 : wrong(&reader, "no memory", "");
    for (const char *at = text; !status && !reader.done && *at; line++) {
        const char *end = at + strcspn(at, "\n");
        if (!length)
            reader.line = line;
        int goes_on = append(at, end, statement, &length);
        if (length && !goes_on) {
            status = take(&reader, statement);
            length = 0;
        }
        at = end + (*end == '\n');
    }
    if (!status && !reader.done)
        return wrong(&reader, "expected the end of the module", "");
    return status;
}
