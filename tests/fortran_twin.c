#include "fortran_twin.h"

struct comparison {
    struct pool *pool;
    const struct header *header;
    const struct fortran_module *module;
    const char *text;
};

static void differ(struct comparison *comparison, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void differ(struct comparison *comparison, const char *format, ...)
{
    char line[400];
    va_list list;
    va_start(list, format);
    (void)vsnprintf(line, sizeof line, format, list);
    va_end(list);
    comparison->text = pool_format(comparison->pool, "%s%s\n", comparison->text, line);
}

/* The Fortran of a C type without pointers; NULL where it has none. */
static const char *fortran_base(struct comparison *comparison, const char *base)
{
    static const char *const known[][2] = {{"int", "integer(c_int)"},
                                           {"long", "integer(c_long)"},
                                           {"size_t", "integer(c_size_t)"},
                                           {"double", "real(c_double)"},
                                           {"char", "character(kind=c_char)"}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (strcmp(base, known[i][0]) == 0)
            return known[i][1];
    if (header_callback(comparison->header, base))
        return "type(c_funptr)";
    return header_struct(comparison->header, base) ? pool_format(comparison->pool, "type(%s)", base) : NULL;
}

static const char *fortran_kind(struct comparison *comparison, const struct header_variable *variable)
{
    if (variable->callback)
        return "type(c_funptr)";
    return variable->type.pointers ? "type(c_ptr)" : fortran_base(comparison, variable->type.base);
}

static int same_type(const char *a, const char *b)
{
    return a && b && same_text(a, b);
}

/* ---- constants and types */

static void compare_constants(struct comparison *comparison)
{
    const struct fortran_module *module = comparison->module;
    for (int i = 0; i < comparison->header->nconstant; i++) {
        const struct header_constant *constant = &comparison->header->constant[i];
        const struct fortran_variable *found = NULL;
        int is_text = constant->kind == HEADER_TEXT;
        const char *name = is_text ? pool_format(comparison->pool, "%s_TEXT", constant->name) : constant->name;
        const char *value = is_text ? pool_format(comparison->pool, "\"%s\"", constant->text)
                                    : pool_format(comparison->pool, "%ld", constant->value);
        for (int k = 0; k < module->nparameter; k++)
            if (same_text(module->parameter[k].name, name))
                found = &module->parameter[k];
        if (!found)
            differ(comparison, "%s is missing", name);
        else if (!found->initial || strcmp(found->initial, value) != 0)
            differ(comparison, "%s is %s, not %s", name, found->initial ? found->initial : "nothing", value);
        else if (!same_type(found->type, is_text ? "character(len=*)" : "integer(c_int)"))
            differ(comparison, "%s is %s", name, found->type);
    }
    for (int k = 0; k < module->nparameter; k++) {
        int known = strncmp(module->parameter[k].name, "rotid_", 6) != 0;
        for (int i = 0; i < comparison->header->nconstant; i++)
            known = known || same_text(comparison->header->constant[i].name, module->parameter[k].name) ||
                    (comparison->header->constant[i].kind == HEADER_TEXT &&
                     strlen(module->parameter[k].name) == strlen(comparison->header->constant[i].name) + 5);
        if (!known)
            differ(comparison, "%s is not in the header", module->parameter[k].name);
    }
}

static void compare_members(struct comparison *comparison, const struct header_struct *structure, const struct fortran_type *type)
{
    for (int i = 0; i < structure->nmember || i < type->nmember; i++) {
        const struct header_variable *c = i < structure->nmember ? &structure->member[i] : NULL;
        const struct fortran_variable *fortran = i < type->nmember ? &type->member[i] : NULL;
        if (!c || !fortran || !same_text(c->name, fortran->name)) {
            differ(comparison, "%s: member %d is %s, not %s", structure->name, i + 1, fortran ? fortran->name : "the end",
                   c ? c->name : "the end");
            return; /* those behind it are shifted */
        }
        const char *kind = fortran_kind(comparison, c);
        const char *shape = c->length ? pool_format(comparison->pool, "%d", c->length) : "";
        if (!same_type(fortran->type, kind) || strcmp(fortran->shape, shape) != 0)
            differ(comparison, "%s.%s is %s(%s), not %s(%s)", structure->name, c->name, fortran->type, fortran->shape,
                   kind ? kind : "known", shape);
        if (!fortran->initial)
            differ(comparison, "%s.%s has no value to begin with", structure->name, c->name);
    }
}

static void compare_types(struct comparison *comparison)
{
    const struct fortran_module *module = comparison->module;
    for (int i = 0; i < comparison->header->nstruct; i++) {
        const struct header_struct *structure = &comparison->header->structure[i];
        const struct fortran_type *found = NULL;
        for (int k = 0; k < module->ntype; k++)
            if (same_text(module->type[k].name, structure->name))
                found = &module->type[k];
        if (!found)
            differ(comparison, "%s is missing", structure->name);
        else
            compare_members(comparison, structure, found);
    }
    for (int k = 0; k < module->ntype; k++)
        if (!header_struct(comparison->header, module->type[k].name))
            differ(comparison, "%s is not in the header", module->type[k].name);
}

/* ---- functions */

static void compare_argument(struct comparison *comparison, const char *function, const struct header_variable *c,
                             const struct fortran_variable *fortran)
{
    const char *kind = fortran_kind(comparison, c);
    int pointers = c->callback ? 0 : c->type.pointers, is_constant = c->type.constant >> (pointers - (pointers > 0)) & 1;
    int good = same_type(fortran->type, kind) && fortran->by_value && !*fortran->shape;
    if (!good && pointers && !fortran->by_value) { /* what the pointer points to */
        kind = pointers == 1 ? fortran_base(comparison, c->type.base) : "type(c_ptr)";
        good = same_type(fortran->type, kind) && (is_constant ? fortran->reads && !fortran->writes : fortran->writes);
    }
    if (!good)
        differ(comparison, "%s: %s is %s%s%s%s%s, not %s", function, fortran->name, fortran->type,
               fortran->by_value ? ", value" : "", fortran->reads ? ", in" : "", fortran->writes ? ", out" : "",
               *fortran->shape ? ", array" : "", header_variable_text(comparison->pool, c));
}

static void compare_procedure(struct comparison *comparison, const struct header_function *c,
                              const struct fortran_procedure *fortran)
{
    const char *name = fortran->name;
    int is_subroutine = !c->result.pointers && strcmp(c->result.base, "void") == 0;
    const char *result = c->result.pointers ? "type(c_ptr)" : is_subroutine ? NULL : fortran_base(comparison, c->result.base);
    if (is_subroutine != !fortran->result.name || (!is_subroutine && !same_type(fortran->result.type, result)))
        differ(comparison, "%s: the result is %s, not %s", name, fortran->result.name ? fortran->result.type : "none",
               result ? result : "none");
    if (c->nparameter != fortran->nargument) {
        differ(comparison, "%s: %d arguments, not %d", name, fortran->nargument, c->nparameter);
        return;
    }
    for (int i = 0; i < c->nparameter; i++) {
        if (!same_text(c->parameter[i].name, fortran->argument[i].name))
            differ(comparison, "%s: argument %d is %s, not %s", name, i + 1, fortran->argument[i].name, c->parameter[i].name);
        compare_argument(comparison, name, &c->parameter[i], &fortran->argument[i]);
    }
}

static void compare_with(struct comparison *comparison, const struct header_function *c, const char *name, int is_abstract,
                         char *seen)
{
    const struct fortran_module *module = comparison->module;
    for (int k = 0; k < module->nprocedure; k++) {
        const struct fortran_procedure *procedure = &module->procedure[k];
        if (procedure->is_abstract != is_abstract || !same_text(procedure->name, name))
            continue;
        seen[k] = 1;
        if (!is_abstract && (!procedure->binding || strcmp(procedure->binding, name) != 0))
            differ(comparison, "%s is bound to %s", name, procedure->binding ? procedure->binding : "a name in lower case");
        compare_procedure(comparison, c, procedure);
        return;
    }
    differ(comparison, "%s is missing", name);
}

static void compare_functions(struct comparison *comparison)
{
    const struct header *header = comparison->header;
    const struct fortran_module *module = comparison->module;
    char *seen = pool_get(comparison->pool, (size_t)module->nprocedure, 1);
    for (int i = 0; i < header->nfunction; i++)
        compare_with(comparison, &header->function[i], header->function[i].name, 0, seen);
    for (int i = 0; i < header->ncallback; i++)
        compare_with(comparison, &header->callback[i], header->callback[i].name, 1, seen);
    for (int i = 0; i < header->nstruct; i++)
        for (int j = 0; j < header->structure[i].nmember; j++) {
            const struct header_variable *member = &header->structure[i].member[j];
            if (member->callback)
                compare_with(comparison, member->callback,
                             pool_format(comparison->pool, "%s_%s", header->structure[i].name, member->name), 1, seen);
        }
    for (int k = 0; k < module->nprocedure; k++)
        if (!seen[k] && strncmp(module->procedure[k].name, "rotid_", 6) == 0)
            differ(comparison, "%s is not in the header", module->procedure[k].name);
}

const char *fortran_differences(struct pool *pool, const struct header *header, const struct fortran_module *module)
{
    struct comparison comparison = {pool, header, module, ""};
    compare_constants(&comparison);
    compare_types(&comparison);
    compare_functions(&comparison);
    return comparison.text;
}

/* ---- what compilers make of it */

static int says_its_size(const struct header_struct *structure)
{
    return structure->nmember && strcmp(structure->member[0].name, "size") == 0;
}

int write_c_witness(FILE *stream, const struct header *header)
{
    (void)fputs("#include <stddef.h>\n#include <stdio.h>\n#include \"rotid.h\"\nint main(void)\n{\n", stream);
    for (int i = 0; i < header->nconstant; i++)
        if (header->constant[i].kind == HEADER_TEXT)
            (void)fprintf(stream, "    puts(\"%s \" %s);\n", header->constant[i].name, header->constant[i].name);
        else
            (void)fprintf(stream, "    printf(\"%s %%ld\\n\", (long)%s);\n", header->constant[i].name, header->constant[i].name);
    for (int i = 0; i < header->nstruct; i++) {
        const char *name = header->structure[i].name;
        (void)fprintf(stream, "    {\n        static %s a;\n        printf(\"%s %%zu\\n\", sizeof a);\n", name, name);
        if (says_its_size(&header->structure[i]))
            (void)fprintf(stream, "        printf(\"%s says %%zu\\n\", sizeof a);\n", name);
        for (int j = 0; j < header->structure[i].nmember; j++) {
            const char *member = header->structure[i].member[j].name;
            (void)fprintf(stream, "        printf(\"%s.%s %%zu %%zu\\n\", offsetof(%s, %s), sizeof a.%s);\n", name, member, name,
                          member, member);
        }
        (void)fputs("    }\n", stream);
    }
    (void)fputs("    return 0;\n}\n", stream);
    return ferror(stream) ? -1 : 0;
}

int write_fortran_witness(FILE *stream, const struct header *header)
{
    (void)fputs("program witness\n  use, intrinsic :: iso_c_binding\n  use rotid\n  implicit none\n", stream);
    for (int i = 0; i < header->nstruct; i++)
        (void)fprintf(stream, "  type(%s), target :: a%d\n", header->structure[i].name, i + 1);
    for (int i = 0; i < header->nconstant; i++) {
        int is_text = header->constant[i].kind == HEADER_TEXT;
        const char *name = header->constant[i].name;
        (void)fprintf(stream, "  print '(a,1x,%s)', '%s', %s%s\n", is_text ? "a" : "i0", name, name, is_text ? "_TEXT" : "");
    }
    for (int i = 0; i < header->nstruct; i++) {
        const char *name = header->structure[i].name;
        (void)fprintf(stream, "  print '(a,1x,i0)', '%s', c_sizeof(a%d)\n", name, i + 1);
        if (says_its_size(&header->structure[i])) /* from the start */
            (void)fprintf(stream, "  print '(a,1x,i0)', '%s says', a%d%%size\n", name, i + 1);
        for (int j = 0; j < header->structure[i].nmember; j++) {
            const char *member = header->structure[i].member[j].name;
            (void)fprintf(stream,
                          "  print '(a,1x,i0,1x,i0)', '%s.%s', &\n    address(c_loc(a%d%%%s)) - address(c_loc(a%d)), &\n"
                          "    storage_size(a%d%%%s) / 8 * %d\n",
                          name, member, i + 1, member, i + 1, i + 1, member,
                          header->structure[i].member[j].length ? header->structure[i].member[j].length : 1);
        }
    }
    (void)fputs("contains\n"
                "  integer(c_intptr_t) function address(p)\n"
                "    type(c_ptr), intent(in) :: p\n"
                "    address = transfer(p, address)\n"
                "  end function address\n"
                "end program witness\n",
                stream);
    return ferror(stream) ? -1 : 0;
}

int write_fortran_callers(FILE *stream, const struct header *header)
{
    (void)fprintf(stream, "program callers\n  use rotid\n  implicit none\n  type(c_funptr) :: f(%d)\n  integer :: i\n",
                  header->nfunction);
    for (int i = 0; i < header->nfunction; i++)
        (void)fprintf(stream, "  f(%d) = c_funloc(%s)\n", i + 1, header->function[i].name);
    (void)fputs("  print '(i0)', count([(c_associated(f(i)), i=1, size(f))])\nend program callers\n", stream);
    return ferror(stream) ? -1 : 0;
}
