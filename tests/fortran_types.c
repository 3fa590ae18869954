#include "fortran_types.h"

#define FIRST "rotid_material"
#define LAST  "rotid_speeds"
#define BEGIN                                                                                                                    \
    "  ! ------------------------------------------------------------------------------------------------ types: results\n"
#define END "  ! ---- types: end of results\n"

static const char *remark_of(struct pool *pool, const struct header_type *type)
{
    static const char *const bases[][2] = {{"double", "real"}, {"int", "integer"}};
    if (!strcmp(type->base, "void"))
        return "";
    if (!strcmp(type->base, "char"))
        return type->pointers == 1 ? " ! text" : " ! texts";
    for (size_t i = 0; i < sizeof bases / sizeof *bases; i++)
        if (!strcmp(type->base, bases[i][0]))
            return pool_format(pool, " ! %s", bases[i][1]);
    return pool_format(pool, " ! %s", type->base);
}

static const char *line_of(struct pool *pool, const struct header_variable *member)
{
    const struct header_type *type = &member->type;
    const char *shape = member->length ? pool_format(pool, "(%d)", member->length) : "";
    if (type->pointers)
        return pool_format(pool, "    type(c_ptr) :: %s = c_null_ptr%s\n", member->name, remark_of(pool, type));
    if (!strcmp(type->base, "int") || !strcmp(type->base, "double"))
        return pool_format(pool, "    %s :: %s%s = 0\n", *type->base == 'i' ? "integer(c_int)" : "real(c_double)", member->name,
                           shape);
    return strncmp(type->base, "rotid_", 6)
               ? NULL
               : pool_format(pool, "    type(%s) :: %s%s = %s()\n", type->base, member->name, shape, type->base);
}

const char *fortran_types(struct pool *pool, const struct header *header)
{
    const char *text = "";
    int i = 0;
    while (i < header->nstruct && strcmp(header->structure[i].name, FIRST) != 0)
        i++;
    for (; i < header->nstruct && text; i++) {
        const struct header_struct *s = &header->structure[i];
        text = pool_format(pool, "%s\n  type, bind(C) :: %s\n", text, s->name);
        for (int m = 0; m < s->nmember && text; m++) {
            const char *line = line_of(pool, &s->member[m]);
            text = line ? pool_format(pool, "%s%s", text, line) : NULL;
        }
        text = text ? pool_format(pool, "%s  end type %s\n", text, s->name) : NULL;
        if (!strcmp(s->name, LAST))
            return text;
    }
    return NULL;
}

const char *fortran_with_types(struct pool *pool, const char *module, const char *types)
{
    const char *begin = strstr(module, BEGIN), *end = begin ? strstr(begin, END) : NULL;
    if (!end)
        return NULL;
    begin += strlen(BEGIN);
    return pool_format(pool, "%.*s%s\n%s", (int)(begin - module), module, types, end);
}
