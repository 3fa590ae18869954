#ifndef ROTID_EXPORT_EXPORT_H
#define ROTID_EXPORT_EXPORT_H

/* export: the model of a rotor for other programs.
 *
 * Comes in: a job, with the fit of its parameters or without. Goes out: files of K and M, a table of what was written, the struct
 * of its JSON. Called by rotid export alone (src/cli). Steps:
 *
 *   export_model_open   assembles K(x), M(x) of src/model at x = the identified or the stated parameters, computes the    model.c
 *                       frequencies that the files state, and condenses onto the sensors where that is asked for:
 *                       K_c = T'K T, M_c = T'M T, T by Guyan or IRS
 *   triplet_next        the entries of a lower triangle one by one                                                   model.c
 *   matrix_market_*     Matrix Market, 17 digits: K and M full and condensed; a table of the nodes                   files.c
 *   dmig_full, dmig_condensed   Nastran: DMIG matrices, GRID points, supports, SOL 103; dmig_number: 16 columns      files.c
 *   remark_put          the comments that both formats begin with                                                    files.c
 *   export_files_name, export_files_write   which files there will be; all of them or none, by src/report/output.c   files.c
 *   table_export, export_result_of          what was written, for a person and as JSON                               files.c
 *
 * Signs: a node has v and theta = -dv/dz; DMIG has R2 = dv/dz, so entries between a deflection and a rotation change their sign.
 * The room reads no deck and fits nothing: the caller hands over the identification. */

#include "model/model.h"
#include "report/report.h"
#include "result/result.h"
#include "run/run.h"

/* The model that is exported: its matrices at the values that were identified or that the deck states, the same condensed
 * onto the sensors, and the texts of the files beside the numbers. */

#define EXPORT_MODES         6    /* stated at least, as far as the model has them */
#define EXPORT_MOST_CONDENSE 1000 /* masters: more cost gigabytes, the square of their number */

struct export_condensed {
    const char *impossible; /* why there is none, else NULL */
    int kind, count;        /* ROTID_GUYAN or ROTID_IRS; masters, those of the discrete */
    double *k, *m;          /* [count * count] */
};

struct export_node {
    double r, z;        /* m; r NaN of a beam */
    const char *member; /* "axis" or, of a solid, "section"; or the name of rods or bars */
    int sensor;         /* id, 0 where there is none */
    int row[4]; /* from 1, 0 where there is none: of v and theta; of a solid U, V, W, and theta of a member, whose v is U */
};

struct export_model {
    const struct job *job;
    const char *version;
    const struct identification *identified; /* NULL: as the deck states it */
    struct rotor_model *discrete;            /* stands at the exported values */
    rotid_matrix k, m;
    int nnode, is_solid;
    struct export_node *node; /* [nnode]: of the axis or of the section, then the inner ones of rods and bars */
    struct export_condensed condensed;
    struct spectrum spectrum;
    struct mass_properties mass;
};

/* identified: a fit of the job, or NULL for the model as the deck states it. condense: nonzero, with the condensed matrices.
 * Statuses of model_open and spectrum_compute. */
int export_model_open(struct pool *pool, const struct job *job, const struct identification *identified, const char *version,
                      int condense, struct export_model *model);

/* Id of the sensor at master i, without sensors the node from 1. */
int export_master_id(const struct export_model *model, int i);

/* The entries of a matrix one by one. */

struct triplet {
    int row, column; /* from 0, row >= column; start with row -1, column 0 */
    double value;
};

/* The next entry of the lower triangle that is not zero, column by column, rows increasing; 0 where there is none. As the beam
 * assembles its matrices, the block of far degrees of freedom holds only the entries outside the band. */
int triplet_next(const rotid_matrix *a, struct triplet *t);

/* Comment lines of the files that are written: a description of the model in plain ASCII, each line begun by the mark of the
 * format. */

struct remark {
    FILE *stream;
    const char *mark; /* "% " */
    int width;        /* of a line, mark included */
};

/* One remark, broken between words; other bytes than printable ASCII become '?', since readers of such files stop at other bytes.
 */
void remark_put(const struct remark *remark, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* K and M as Matrix Market files (Boisvert, Pozo, Remington 1996), which SciPy, MATLAB and Julia read: coordinate format with the
 * lower triangle for the full model, array format for the condensed one, 17 digits; and a table of the nodes. */

/* Each writes to a stream whose errors the caller asks for at its end. */
int matrix_market_stiffness(FILE *stream, const struct export_model *model);
int matrix_market_mass(FILE *stream, const struct export_model *model);
int matrix_market_condensed_stiffness(FILE *stream, const struct export_model *model);
int matrix_market_condensed_mass(FILE *stream, const struct export_model *model);

/* The model as a Nastran deck that runs: DMIG matrices on GRID points along z, SOL 103.
 *
 * v is T1 and dv/dz is R2, the rotation about y, so theta = -dv/dz enters with its sign turned.
 *
 * A double precision number of a DMIG has a D exponent and sixteen columns: ten to twelve digits. The stiffness of a short
 * element is 1e6 times that of a bending mode and cancels in it, so each matrix is written as two, of which the second holds what
 * sixteen columns left of the first; case control adds them (K2GG = KFULL, KFULLR). Their sum is the matrix to the last bit. */

/* Full model: KFULL, MFULL on all nodes, GRID i being node i. */
int dmig_full(FILE *stream, const struct export_model *model);
/* Condensed model: KRED, MRED on the sensors, whose ids are those of the GRIDs. */
int dmig_condensed(FILE *stream, const struct export_model *model);

/* Largest id that a GRID can have. */
#define DMIG_MOST_ID 99999999

/* Value as a double precision number of at most 16 columns, text [17], as precise as that allows; returns the value that is read
 * back from it. */
double dmig_number(double value, char *text);

/* The files of an export, all of them or none. */

enum export_format { EXPORT_MATRIX_MARKET, EXPORT_DMIG };

#define EXPORT_MOST_FILES 5

struct export_files {
    enum export_format format;
    int condensed; /* DMIG: of the condensed model */
    int count;
    const char *path[EXPORT_MOST_FILES];
};

/* The files that are to be written: path itself, or with Matrix Market path.stiffness.mtx and so on; without those of the
 * condensed model where it is not possible. ROTID_OK or ROTID_ERROR_MEMORY. */
int export_files_name(struct pool *pool, enum export_format format, int condensed, const char *path,
                      const struct export_model *model, struct export_files *files);

/* ROTID_OK, ROTID_ERROR_MEMORY, or ROTID_ERROR_IO with errno and the file in *failed. */
int export_files_write(const struct export_files *files, const struct export_model *model, const char **failed);

/* What was exported, as a table and as the struct of its JSON. */

void screen_export(const struct screen *to, const struct result_head *head, const struct export_files *files,
                   const struct export_model *model);
/* The same as the struct of its JSON, on the pool; NULL where memory is out. */
const struct export_result *export_result_of(struct pool *pool, const struct export_files *files,
                                             const struct export_model *model);

#endif
