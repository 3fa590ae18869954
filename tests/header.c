#include "header.h"

#define MOST_BYTES (1 << 20)

int header_read(struct pool *pool, const char *path, struct header *header)
{
    FILE *stream = fopen(path, "rb");
    char *text = pool_get(pool, MOST_BYTES, 1);
    size_t length = stream && text ? fread(text, 1, MOST_BYTES - 1, stream) : 0;
    int whole = stream && feof(stream) && !ferror(stream);
    if (stream)
        (void)fclose(stream);
    if (whole && length && !memchr(text, 0, length))
        return header_parse(pool, text, header);
    *header = (struct header){.error = "the file cannot be read, or is no text of less than a mebibyte"};
    return -1;
}

const struct header_constant *header_constant(const struct header *header, const char *name)
{
    for (int i = 0; i < header->nconstant; i++)
        if (strcmp(header->constant[i].name, name) == 0)
            return &header->constant[i];
    return NULL;
}

const struct header_struct *header_struct(const struct header *header, const char *name)
{
    for (int i = 0; i < header->nstruct; i++)
        if (strcmp(header->structure[i].name, name) == 0)
            return &header->structure[i];
    return NULL;
}

static const struct header_function *find(int count, const struct header_function *function, const char *name)
{
    for (int i = 0; i < count; i++)
        if (strcmp(function[i].name, name) == 0)
            return &function[i];
    return NULL;
}

const struct header_function *header_function(const struct header *header, const char *name)
{
    return find(header->nfunction, header->function, name);
}

const struct header_function *header_callback(const struct header *header, const char *name)
{
    return find(header->ncallback, header->callback, name);
}

/* "const char *const *", ready for a name to follow. */
static const char *type_text(struct pool *pool, struct header_type type)
{
    const char *text = pool_format(pool, "%s%s ", type.constant & 1 ? "const " : "", type.base);
    for (int k = 1; text && k <= type.pointers; k++)
        text = pool_format(pool, "%s*%s", text, type.constant >> k & 1 ? "const " : "");
    return text;
}

static const char *parameters_text(struct pool *pool, const struct header_function *function)
{
    const char *text = function->nparameter ? "" : "void";
    for (int i = 0; text && i < function->nparameter; i++) {
        const char *parameter = header_variable_text(pool, &function->parameter[i]);
        text = parameter ? pool_format(pool, "%s%s%s", text, i ? ", " : "", parameter) : NULL;
    }
    return text;
}

/* The name, or (*name), between result and parameters. */
static const char *function_text(struct pool *pool, const struct header_function *function, const char *before, const char *name,
                                 const char *after)
{
    const char *type = type_text(pool, function->result), *parameters = parameters_text(pool, function);
    return type && parameters ? pool_format(pool, "%s%s%s%s(%s)", type, before, name, after, parameters) : NULL;
}

const char *header_variable_text(struct pool *pool, const struct header_variable *variable)
{
    if (variable->callback)
        return function_text(pool, variable->callback, "(*", variable->name, ")");
    const char *type = type_text(pool, variable->type);
    if (!type)
        return NULL;
    if (variable->length)
        return pool_format(pool, "%s%s[%d]", type, variable->name, variable->length);
    /* a parameter without a name leaves no blank behind its type */
    size_t length = strlen(type);
    return *variable->name ? pool_format(pool, "%s%s", type, variable->name)
                           : pool_format(pool, "%.*s", (int)(length - (type[length - 1] == ' ')), type);
}

const char *header_function_text(struct pool *pool, const struct header_function *function)
{
    return function_text(pool, function, "", function->name, "");
}
