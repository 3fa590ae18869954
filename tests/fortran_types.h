/* The types of results in rotid.f90, written from rotid.h: a member a line, as the header has them. */
#ifndef ROTID_TESTS_FORTRAN_TYPES_H
#define ROTID_TESTS_FORTRAN_TYPES_H

#include "header.h"

/* The structs from rotid_material to rotid_speeds, which the header keeps together; NULL where a member has no Fortran. */
const char *fortran_types(struct pool *pool, const struct header *header);

/* The module with these types between its lines "types: results" and "types: end of results"; NULL where it has no such lines. */
const char *fortran_with_types(struct pool *pool, const char *module, const char *types);

#endif
