/* What `rotid uff` lists of a universal file, in the shape of its JSON. Values are as in the file; factors to SI stand beside
 * them.
 */
#ifndef ROTID_RESULT_UFF_H
#define ROTID_RESULT_UFF_H

#define LISTED_ID_LINES 5

/* texts of set 151 */
struct listed_header {
    const char *model;       /* model file */
    const char *description; /* its description */
    const char *program;     /* what made the data base */
    const char *created;     /* date and time */
    const char *saved;       /* date and time */
    const char *written_by;  /* what wrote the file */
    const char *written;     /* date and time */
};

/* a value in SI times the factor is the value in the file */
struct listed_units {
    int code;                  /* 1 SI, 2 foot and pound, ..., 9 user */
    const char *name;          /* the same in words */
    const char *description;   /* text of the file */
    double length;             /* factor of a length */
    double force;              /* factor of a force */
    double temperature;        /* factor of a temperature */
    double temperature_offset; /* offset of a temperature */
};

/* a set */
struct listed_set {
    int line;          /* line of the '-1' that opens the set; lines are not counted inside binary data */
    int set;           /* its number */
    int binary;        /* 58b */
    const char *name;  /* what it holds, NULL where that is not known */
    const char *state; /* read; read_over: known, but rotid uses nothing of such a set; not_known; malformed */
    double count;      /* nodes or values in it; 0 where it was not read */
};

struct listed_nodes {
    int count;     /* nodes */
    double min[3]; /* least x, y, z; NaN without nodes */
    double max[3]; /* greatest x, y, z; NaN without nodes */
    int nids, nx;
    int *ids;  /* labels; with --verbose, else NULL */
    double *x; /* coordinates of each; with --verbose, else NULL */
};

struct listed_axis {
    int data_type;     /* specific data type of set 58: 8 displacement, 11 velocity, 12 acceleration, 13 force, 17 time, 18
                          frequency, ... */
    const char *label; /* text of the axis */
    const char *unit;  /* text of its unit */
};

/* a function */
struct listed_function {
    int line;                        /* line of the '-1' that opens the set; lines are not counted inside binary data */
    int type;                        /* function type of set 58 */
    const char *kind;                /* the same in words */
    const char *id[LISTED_ID_LINES]; /* the five lines of text, NULL where they say NONE */
    const char *response;            /* node and direction, as in 19:+X */
    const char *reference;           /* the same of the excitation */
    int response_node;               /* label, 0 where there is none */
    int response_direction;          /* 0 scalar, 1 to 6 X Y Z RX RY RZ, negative the other way */
    int reference_node;              /* label, 0 where there is none */
    int reference_direction;         /* as response_direction */
    int ordinate;                    /* ordinate data type: 2, 4, 5 or 6 */
    const char *ordinate_name;       /* the same in words */
    int binary;                      /* 58b */
    double count;                    /* values */
    int even;                        /* whether the abscissa is even */
    double start;                    /* first abscissa, as in the file */
    double step;                     /* step of an even abscissa */
    double end;                      /* last abscissa */
    int time;                        /* whether the abscissa is time */
    double sampling_rate_hz;         /* of an even time axis [Hz] */
    struct listed_axis abscissa;     /* record 8 */
    struct listed_axis numerator;    /* record 9 */
    struct listed_axis denominator;  /* record 10 */
    double si_factor;                /* a value times this is in SI */
    double abscissa_si_factor;       /* an abscissa times this is in SI */
    double min;                      /* least value, of complex ones least modulus; as in the file */
    double max;                      /* the greatest */
    double rms;                      /* root mean square of the modulus */
    int nfirst, nlast;               /* 2, 0 without values */
    const double *first;             /* first value, real and imaginary part */
    const double *last;              /* last value */
    double sum[2];                   /* sum of the values */
};

/* a shape */
struct listed_shape {
    int line;                        /* line of the '-1' that opens the set; lines are not counted inside binary data */
    const char *id[LISTED_ID_LINES]; /* the five lines of text, NULL where they say NONE */
    int analysis_type;               /* 2 normal mode, 3 and 7 complex eigenvalue, 5 frequency response, ... */
    const char *analysis;            /* the same in words */
    int mode;                        /* its number in the file */
    double frequency_hz;             /* frequency [Hz] */
    double damping;                  /* viscous ratio */
    int is_complex;                  /* whether it is complex */
    int components;                  /* values a node */
    int node_count;                  /* nodes */
    double sum[2];                   /* sum of all components */
    double rms;                      /* root mean square of all components */
    int nnodes, nreal, nimag;
    const int *nodes;   /* labels; with --verbose, else NULL */
    const double *real; /* components of each node in turn; with --verbose */
    const double *imag; /* imaginary parts, empty where real; with --verbose */
};

/* a doubtful place */
struct listed_doubt {
    const char *kind; /* what it is */
    int line;         /* of the set, ROTID_NONE where it is the file */
    const char *text; /* in words */
};

/* an error */
struct listed_error {
    int line;         /* line of the file */
    int column;       /* column, from 1 */
    const char *text; /* what is wrong, what was expected */
};

struct uff_result {
    const char *file; /* path of the file as given */
    int nsummary;
    const char *const *summary;   /* a sentence for each group of functions that differ in their places alone, for the shapes, for
                                     the nodes */
    struct listed_header *header; /* set 151, NULL where there is none */
    struct listed_units *units;   /* set 164, the last one of the file; NULL where there is none */
    int nsets;
    struct listed_set *sets;   /* every set in the order of the file */
    struct listed_nodes nodes; /* of all sets 15, 781 and 2411, in the unit of the file */
    int nfunctions;
    struct listed_function *functions; /* sets 58 and 58b */
    int nshapes;
    struct listed_shape *shapes; /* sets 55 */
    int ndoubtful;
    struct listed_doubt *doubtful; /* doubtful places */
    int nerrors;
    struct listed_error *errors; /* what stopped the reader in malformed sets */
};

#endif
