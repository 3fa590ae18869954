/* rotid.f90 beside rotid.h: what the two declare, and what compilers make of it. */
#ifndef ROTID_TESTS_FORTRAN_TWIN_H
#define ROTID_TESTS_FORTRAN_TWIN_H

#include "fortran_module.h"
#include "header.h"

/* Compares the declarations:
 *   every integer or text constant has a parameter of its name and value (ROTID_VERSION: ROTID_VERSION_TEXT);
 *   every struct has a bind(C) type of its name with the same members in the same order, each of the kind of its C type, a
 * pointer being type(c_ptr) and a pointer to a function type(c_funptr); every function has an interface of its name and binding
 * with the same arguments: a value has `value`; a pointer is type(c_ptr), value, or is passed by reference with the intent that
 * its const tells; every pointer to a function, member X of rotid_Y, has the abstract interface rotid_Y_X, and a typedef the one
 * of its name; and the module has nothing of the kind that the header has not. Returns the differences, a line each, "" where
 * there is none; on the pool. */
const char *fortran_differences(struct pool *pool, const struct header *header, const struct fortran_module *module);

/* Programs that print the value of every constant, the size of every type, and the offset and size of every member, in the same
 * words, as C and as Fortran. 0, or -1 where a line could not be written. */
int write_c_witness(FILE *stream, const struct header *header);
int write_fortran_witness(FILE *stream, const struct header *header);

/* A Fortran program that takes the address of every function of the header: it links where the library has them all. */
int write_fortran_callers(FILE *stream, const struct header *header);

#endif
