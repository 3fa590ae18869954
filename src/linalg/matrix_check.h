/* What matrices from outside have to be before anything reads them. */
#ifndef ROTID_LINALG_MATRIX_CHECK_H
#define ROTID_LINALG_MATRIX_CHECK_H

#include "rotid.h"

/* 1 where index [count] holds increasing numbers of 0 ... n - 1; it may be NULL where count is 0. */
int indices_increase(int count, const int *index, int n);

/* 1 where n, kd and far are in their ranges and the storage is there. */
int matrix_is_valid(const rotid_matrix *a);

/* ROTID_OK where the matrices a [count] are valid, of one structure, and finite; else ROTID_ERROR_ARGUMENT or _FINITE. */
int matrices_check(int count, const rotid_matrix *const *a);

#endif
