/* What the declarations of a Fortran module say, as data: for comparing rotid.f90 with rotid.h. Reads the parameters, the
 * bind(C) types and the interfaces in front of `contains`; a statement that it does not know is an error, not left out. */
#ifndef ROTID_TESTS_FORTRAN_MODULE_H
#define ROTID_TESTS_FORTRAN_MODULE_H

#include "base/base.h"

/* All names and types are in lower case. */
struct fortran_variable {
    const char *name;
    const char *type;            /* "integer(c_int)", "type(c_ptr)", "character(kind=c_char)"; NULL: not declared */
    const char *shape;           /* what stands in its brackets, "" for a scalar */
    const char *initial;         /* what stands behind its =, or NULL */
    int by_value, reads, writes; /* attribute value; intent in, out, both */
    int line;
};

struct fortran_procedure {
    const char *name, *binding; /* the name in C, NULL where it has none */
    int is_abstract;
    struct fortran_variable result; /* .name NULL: a subroutine */
    int nargument;
    struct fortran_variable *argument;
    int line;
};

struct fortran_type {
    const char *name;
    int nmember;
    struct fortran_variable *member;
    int line;
};

/* All in the order of the module. */
struct fortran_module {
    int nparameter, ntype, nprocedure;
    struct fortran_variable *parameter; /* named constants */
    struct fortran_type *type;
    struct fortran_procedure *procedure;
    int line; /* where reading failed, and why; 0 and NULL without an error */
    const char *error;
};

/* 0, or -1 with module->line and module->error. */
int fortran_parse(struct pool *pool, const char *text, struct fortran_module *module);

#endif
