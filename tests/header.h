/* What the public header declares, as data: for the snapshot of the interface, and for comparing rotid.f90 with its twin. Reads
 * the C of rotid.h alone: constants, enumerations, plain structs, functions, pointers to functions; what it does not know is an
 * error, not left out. */
#ifndef ROTID_TESTS_HEADER_H
#define ROTID_TESTS_HEADER_H

#include <stddef.h>

#include "base/base.h"

/* A type without a name: base "double", "size_t", "unsigned long", "rotid_message", "void" (never "struct rotid_message"). */
struct header_type {
    const char *base;
    int pointers;      /* 0: the base itself, 1: base *, 2: base ** */
    unsigned constant; /* bit 0: the base is const, bit k: the k-th asterisk after it is followed by const */
};

struct header_function;

/* A member of a struct, or a parameter of a function. */
struct header_variable {
    const char *name;                       /* "" for a parameter without one */
    struct header_type type;                /* of each element of an array; empty for a pointer to a function */
    int length;                             /* of an array, else 0 */
    const struct header_function *callback; /* what a pointer to a function points to, else NULL; its name is "" */
    int line;
};

/* A function, or what a pointer to one points to. */
struct header_function {
    const char *name;
    struct header_type result; /* {"void", 0, 0} for none */
    int nparameter;            /* 0 for (void) */
    const struct header_variable *parameter;
    int line;
};

struct header_struct {
    const char *name; /* of the typedef, which is that of the tag */
    int complete;     /* its members are told */
    int nmember;
    const struct header_variable *member; /* in their order; "double a, b;" are two */
    int line;
};

/* From #define, from an enumeration, or from the list of statuses. */
struct header_constant {
    const char *name;
    const char *text; /* a text constant such as ROTID_VERSION: without its quotes; of a status: what it means; else NULL */
    long value;       /* 0 for a text constant */
    int kind;         /* HEADER_TEXT, HEADER_DEFINE, HEADER_ENUM or HEADER_STATUS */
    int line;
};
enum { HEADER_TEXT, HEADER_DEFINE, HEADER_ENUM, HEADER_STATUS };

/* All in the order of the header. */
struct header {
    int nconstant, nstruct, ncallback, nfunction;
    const struct header_constant *constant;
    const struct header_struct *structure;
    const struct header_function *callback; /* typedef int (*rotid_residual)(...); */
    const struct header_function *function; /* declared with ROTID_API */
    int line;                               /* where reading failed, and why; 0 and NULL without an error */
    const char *error;
};

/* Reads a header into *header, on the pool. 0, or -1: header->error says what was not understood in header->line. */
int header_read(struct pool *pool, const char *path, struct header *header);
/* The same from a text in memory. */
int header_parse(struct pool *pool, const char *text, struct header *header);

/* NULL where there is none of that name. */
const struct header_constant *header_constant(const struct header *header, const char *name);
const struct header_struct *header_struct(const struct header *header, const char *name);
const struct header_function *header_function(const struct header *header, const char *name);
const struct header_function *header_callback(const struct header *header, const char *name);

/* C for a variable, on one line and with one spelling whatever the header's: "const char *const *override", "double rigid_hz[2]",
 * "void *(*allocate)(void *context, size_t bytes)"; for a function with its name: "int rotid_lm(int m, ...)". NULL: no memory. */
const char *header_variable_text(struct pool *pool, const struct header_variable *variable);
const char *header_function_text(struct pool *pool, const struct header_function *function);

#endif
