#ifndef ROTID_IMPORT_IMPORT_H
#define ROTID_IMPORT_IMPORT_H

/* import: measured data as a whole, from universal files; modes of a test to a universal file.
 *
 * Comes in: a path, options. Goes out: a listing, or a measurement in SI; src/uff reads the sets.
 *
 *   listing.c      listing_read: what a file holds and what in it is doubtful. Of the values of a function are kept: number,
 *                  first, last, least, greatest, sum, root mean square, a hash (struct values), from which follow dead, clipped
 *                  and repeated channels; values_levels: coarse ones; listing_summarise: sentences
 *   measurement.c  measurement_read: the transfer functions of a test (type 4) with their coherences (type 6), else pairs of
 *                  time records (type 1), of which transfer_compute of src/signal makes H(f). Functions are listed first
 *                  (struct contents), so that only the values that are wanted are read. A response goes with its force by load
 *                  case, else with the last force before it. Factors to SI: set 164, texts of the axes. Coherence g2 of K
 *                  averages gives the variance (1 - g2)/(g2 K) |H|^2
 *   modes.c        modes_write: the modes of src/ema with their standard deviations as a file that *MEASURED, FILE reads
 *   names.c        name_of_*, si_unit: numbers of the format in words; units
 *
 * src/cli calls it for rotid uff, ema and frf, src/report shows the listing. The room knows neither rotor nor deck: the sensors
 * and modes of a deck's *MEASURED are read by src/deck/deck_measured.c. */

#include "ema/ema.h"
#include "signal/signal.h"
#include "uff/uff.h"

/* ---- What the numbers of a universal file mean, in words. */

/* Of a set; NULL for those that are not known. */
const char *name_of_set(int number);

/* Of a function type of set 58, one of them and several: "transfer function", "transfer functions". */
const char *name_of_function(int type, int plural);

/* Of an analysis type of sets 55 and 2414. */
const char *name_of_analysis(int type);

/* Of a unit system of set 164: "SI (m, N)", ... */
const char *name_of_units(int code);

/* A degree of freedom as in "19:+X", "19" for a scalar, "19:-RZ" for a rotation. Returns buffer. */
#define PLACE_MOST 24
const char *place_text(int node, int direction, char buffer[PLACE_MOST]);

/* SI unit of a quantity (specific data type of set 58), "" where that is not known. */
const char *si_unit(int specific_type);

/* What a value in the unit that a text names must be multiplied with to be in that SI unit; 0 where the text is none of the usual
 * ones for the quantity. */
double unit_text_factor(int specific_type, const char *text);

/* ---- The values of a function in a few numbers, gathered piece by piece. */

/* Of complex values `min` and `max` are those of the modulus. Without any, all are zero. */
struct values {
    long long count;
    double first[2], last[2], sum[2]; /* real and imaginary part */
    double min, max, rms;             /* rms = sqrt(sum |y|^2 / count) */
    double x_first, x_last, x_least_step, x_most_step;
    int is_constant;        /* all values are equal */
    long long plateau[2];   /* most values in a row that equal the least and the greatest of real data */
    double plateau_jump[2]; /* from the value before that row to it */
    uint64_t hash;          /* of all values, bit by bit */
    double scale, squares;  /* sum |y|^2 = scale^2 squares, which does not overflow */
    long long run[2];
    double before; /* the value before the last */
};

void values_open(struct values *values);
/* count values, all finite: abscissa x, real and imaginary part (imag: of complex ones). */
void values_add(struct values *values, long long count, const double *x, const double *real, const double *imag, int is_complex);
void values_close(struct values *values);

/* Whether a record of a time signal stopped at the limit of its converter: the greatest or the least value stands there at least
 * three times in a row, and the signal was on its way when it got there. */
int values_are_clipped(const struct values *values);

/* Levels of the converter from the least to the greatest of count finite samples, where fewer than COARSE_LEVELS; else 0, also
 * where the samples do not show that they are multiples of a step: fewer than six distinct ones, as of a pulse that is short and
 * clean, or distances apart that are no multiples of the least one, as of any signal with more digits. */
#define COARSE_LEVELS 256
int values_levels(long long count, const double *sample);

/* Whether two functions have the same values, all of them. */
int values_are_same(const struct values *a, const struct values *b);

/* ---- What a universal file holds, and what in it is doubtful. The values of functions pass by and are not kept. */

struct listing_function {
    struct uff_function function;
    struct values values;          /* min, max, rms NaN without any */
    double si_factor, x_si_factor; /* a value, an abscissa times this is in SI */
    int group;                     /* of functions that differ in their places alone, from 0 */
    int levels;                    /* of a record: values_levels */
    /* as it is told: type and ordinate in words, places as place_text has them; */
    const char *kind, *ordinate, *response, *reference;
    int is_time;
    double count, step, rate_hz; /* NaN of an uneven abscissa; rate_hz also where it is no time */
    int nends;                   /* numbers of the first value and of the last one, 0 without values */
    const double *first, *last;
};

/* As in the file; node, real, imag only where the values are kept. */
struct listing_shape {
    struct uff_shape shape;
    const char *analysis; /* its type in words */
    int nvalues;
    double sum[2], rms; /* of all components */
};

struct listing_set {
    struct uff_set set;
    const char *name;  /* what it holds, NULL where that is not known */
    const char *state; /* "read", "read_over" (known and not used), "not_known", "malformed" */
    int is_read, is_faulty;
    double size; /* nodes or values that it holds */
    int item;    /* number of the function or the shape, from 0; -1 */
};

/* A doubtful place: what it is, as a word for programs, and a sentence. */
struct listing_finding {
    const char *kind, *text;
    int line; /* of the set it concerns, ROTID_NONE for the file */
};

struct listing {
    int set_count, function_count, shape_count, node_count, group_count;
    int faulty_count;
    struct listing_set *set;
    struct listing_function *function;
    struct listing_shape *shape;
    struct uff_node *node;     /* of all sets, in their order */
    int *node_line;            /* line of the set of a node */
    struct uff_header *header; /* NULL where there is none */
    struct uff_units *units;   /* the last one, NULL where there is none */
    int units_line;            /* of a set 164 with other factors than one before, 0: there is none */
    int finding_count;
    struct listing_finding *doubt;
};

struct listing_options {
    int keep_shapes;                 /* the values of shapes as well */
    int (*cancelled)(void *context); /* asked now and then, NULL allowed */
    void *context;
};

/* Reads a file through. A malformed set is an error in `messages` and marked, and reading goes on behind it. ROTID_OK;
 * ROTID_STOP_CANCELLED; ROTID_ERROR_SYNTAX where the file is no universal file, _IO, _MEMORY. */
int listing_read(struct pool *pool, const char *path, const struct listing_options *options, struct message_list *messages,
                 struct listing *listing);

/* One sentence for each group of functions, the shapes, the nodes: `what`[*count] of them. ROTID_OK or ROTID_ERROR_MEMORY. */
int listing_summarise(struct pool *pool, const struct listing *listing, int *count, const char ***what);

/* ---- The functions, points and units of a universal file, without the values of the functions. */

struct content {
    struct uff_set set; /* where it stands */
    struct uff_function
        function; /* is_even, start and step also where an uneven abscissa is even to the digits it was written with */
    double *x;    /* [function.count] of one that is not, NULL else */
};

struct contents {
    int count;
    struct content *item; /* [count] sets 58 and 58b in the order of the file */
    int node_count;
    struct uff_node *node;         /* ids distinct: the first of several wins, with a warning where they differ; metres */
    const struct uff_units *units; /* NULL: the file has none */
};

/* ---- A modal test as universal files hold it: transfer functions, or the time records they are made from, and the points. */

struct measurement_options {
    struct transfer_options transfer; /* for time records */
    int reference;                    /* only transfer functions with this reference node; 0: all */
    double low_hz, high_hz;           /* only these lines; 0, 0: all */
    int averages;                     /* behind each coherence of the file; 0: not known, so no variance follows from it */
    int threads;
};

struct measurement {
    int node_count;
    struct uff_node *node;         /* distinct ids; coordinates in metres */
    const struct uff_units *units; /* NULL: the file has none */
    struct frf_set set;            /* as measured or as computed from the records; SI */
    int from_records;              /* nonzero: `transfer` holds the impacts */
    struct transfer transfer;
    int record_count;
    double rate; /* Hz, of the records */
};

/* Reads sets 58 and 58b of a file: transfer functions (type 4) with their coherences (type 6) where it has any, else pairs of
 * time records (type 1), force and response. Nodes from 15, 781, 2411; values and coordinates brought to SI by set 164 and the
 * texts of the axes. Coherences of the same response and reference go with their transfer function, and give the variance (1 -
 * g2)/(g2 * 2 K) * 2 |h|^2 where the number of averages K is known, else NULL. ROTID_OK, ROTID_ERROR_SYNTAX, _IO, _ARGUMENT
 * (nothing usable; the list says what is there and what was expected), _MEMORY. */
int measurement_read(struct pool *pool, const char *path, const struct measurement_options *options,
                     struct message_list *messages, struct measurement *out);

/* ---- Transfer functions as an analyser writes them into a table (analyser.c): .csv, .txt or .tsv. */

int analyser_is(const char *path);

/* First row: frequency [Hz] or [kHz], then for each function two columns in any order, real and imaginary or magnitude and phase,
 * named as "12/1 real [m/s2/N]": response, reference (of one number: options->reference), part, unit. Cells are apart by
 * semicolons where the first row has one, else tabs, else commas; not in the last case a decimal comma is one. Lines outside of
 * the band are left out. No points and no variances. Statuses of measurement_read. */
int analyser_read(struct pool *pool, const char *path, const struct measurement_options *options, struct message_list *messages,
                  struct measurement *out);

/* ---- The modes of a test as a universal file that `identify` and `diagnose` take: docs/uff.md, "Modes with standard
 * deviations". */

/* Sets 151, 164 (SI), 2411 (the nodes of the shapes; those without coordinates are left out), and per mode a set 55 of a real
 * normal mode, a set 55 of analysis type 0 with its standard deviations, and two more of them with the frequencies at each point
 * where ema holds any. `source`: the file that was measured, for the text lines. ROTID_OK, ROTID_ERROR_IO, _MEMORY. */
int modes_write(FILE *stream, const char *source, const char *program, const struct measurement *measurement,
                const struct ema *ema);

#endif
