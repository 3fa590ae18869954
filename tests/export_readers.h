/* Readers of what rotid export writes, by the definitions of the formats and without a line of src. */
#ifndef ROTID_TESTS_EXPORT_READERS_H
#define ROTID_TESTS_EXPORT_READERS_H

#include <stdio.h>

/* A dense matrix [n * n], column-major, both triangles; to be freed. */
struct dense_file {
    int n;
    double *a;
};

/* A Matrix Market file, real and symmetric, coordinate or array. Fails the test where it is none. */
struct dense_file read_market(FILE *stream);

#define DMIG_MOST_GRIDS 8192

struct dmig_file {
    int ngrid, grid[DMIG_MOST_GRIDS];
    double z[DMIG_MOST_GRIDS];
    char k2gg[2][16], m2gg[2][16]; /* the names after K2GG and M2GG, "" where there is no second one */
    int nmodes, longest;           /* of EIGRL; columns of the longest line */
    char *text;                    /* all of it, to be freed */
};

/* Cards, fixed fields of 8 and 16 columns. Fails the test where something is not as Nastran has it. */
void read_bulk(FILE *stream, struct dmig_file *file);
/* The sum of the named matrices in the order grid 0 T1, grid 0 R2, grid 1 T1 ...; with `lateral` T1 alone. */
struct dense_file dmig_sum(const struct dmig_file *file, char (*name)[16], int lateral);
/* Whether grid `id` is held in the components, "2346". */
int is_held(const struct dmig_file *file, int id, const char *components);

#endif
