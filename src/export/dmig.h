/* The model as a Nastran deck that runs: DMIG matrices on GRID points along z, SOL 103.
 *
 * v is T1 and dv/dz is R2, the rotation about y, so theta = -dv/dz enters with its sign turned.
 *
 * A double precision number of a DMIG has a D exponent and sixteen columns: ten to twelve digits. The stiffness of a short
 * element is 1e6 times that of a bending mode and cancels in it, so each matrix is written as two, of which the second holds what
 * sixteen columns left of the first; case control adds them (K2GG = KFULL, KFULLR). Their sum is the matrix to the last bit. */
#ifndef ROTID_EXPORT_DMIG_H
#define ROTID_EXPORT_DMIG_H

#include <stdio.h>

#include "export/model.h"

/* Full model: KFULL, MFULL on all nodes, GRID i being node i. */
int dmig_full(FILE *stream, const struct export_model *model);
/* Condensed model: KRED, MRED on the sensors, whose ids are those of the GRIDs. */
int dmig_condensed(FILE *stream, const struct export_model *model);

/* Largest id that a GRID can have. */
#define DMIG_MOST_ID 99999999

/* Value as a double precision number of at most 16 columns, text [17], as precise as that allows; returns the value that is read
 * back from it. */
double dmig_number(double value, char *text);

#endif
