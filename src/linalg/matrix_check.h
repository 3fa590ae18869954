/* What matrices from outside have to be before anything reads them. `failure` as in rotid.h, names those of the arguments there.
 */
#ifndef ROTID_LINALG_MATRIX_CHECK_H
#define ROTID_LINALG_MATRIX_CHECK_H

#include "rotid.h"

/* ROTID_OK where index [count] holds increasing numbers of 0 ... n - 1; it may be NULL where count is 0. Else
 * ROTID_ERROR_ARGUMENT. */
int indices_check(const char *name, int count, const int *index, int n, char *failure);

/* ROTID_OK where n, kd and far are in their ranges and the storage is there, else ROTID_ERROR_ARGUMENT. */
int matrix_check_structure(const char *name, const rotid_matrix *a, char *failure);

/* Of a matrix of sound structure: ROTID_OK where its block is symmetric but for rounding, else ROTID_ERROR_ARGUMENT. */
int matrix_check_block(const char *name, const rotid_matrix *a, char *failure);

/* Of such a matrix: the same, and ROTID_ERROR_FINITE where an entry is no number. */
int matrix_check_entries(const char *name, const rotid_matrix *a, char *failure);

/* Both for a [count], called k, m, dk, dm; ROTID_ERROR_ARGUMENT also where they are not of one structure. */
int matrices_check(int count, const rotid_matrix *const *a, char *failure);

#endif
