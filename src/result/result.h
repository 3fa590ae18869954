#ifndef ROTID_RESULT_RESULT_H
#define ROTID_RESULT_RESULT_H

/* result: results as JSON, written, and read with the place of every mistake; what is judged of a result.
 *
 * Comes in: struct result, with head and the struct of one command; or a file. Goes out: JSON text; or the same struct.
 *
 *   result.c          result_json: the struct of the command as JSON by its table (result_record), a row of the table a key
 *   result_read.c     result_read: a file to struct result, then contradictions between its parts
 *   record_write.c, record_read.c  any struct that has a table of src/record, to JSON and from JSON
 *   record_NAME.c     tables of the structs of this header: ema, export, sensitivity, study, transfer, uff. The others (check,
 *                     modes, identify, diagnose, suggest) are structs of rotid.h and have their tables in src/record
 *   json_tree.c       an object under construction; a failed allocation is remembered
 *   json_file.c       a text of JSON, or one value a line, within limits of memory
 *   place.c           a value with its path: "result.json: modes[2].measured_hz: is a text, expected a number"
 *   judgement.c       fit_p_value = P(chi^2 of dof > misfit); worst mode; what hides in a parameter; rivals of a verdict
 *   cause_place.c     where a cause acts along z
 *   head.c            program, seed, command, deck of a result; references of the heading
 *
 * The structs below are the keys of the JSON; docs/schema takes the comments beside their members. Callers: src/cli (writes),
 * src/page (reads), src/report, src/export, src/study, src/mpi. The room computes nothing of a model and knows no layout. */

#include <cJSON.h>

#include "base/base.h"
#include "rotid.h"

/* ----------------------------------------------------------------------------------------------------------- cause place */

/* Where a cause acts along the axis of the rotor. */

struct cause_place {
    double from, to; /* from <= to [m] */
    double ci[2];    /* 95 % interval of the place [m], NaN where it is not searched for or not stated */
};

/* 0: the cause has no place, or the geometry (may be NULL) does not know its target. */
int cause_place(const rotid_geometry *geometry, const rotid_cause *cause, struct cause_place *place);

/* ------------------------------------------------------------------------------------------------------------------- ema */

/* What `rotid ema` finds, in the shape of its JSON. NaN: it cannot be stated. */

/* The doubts of a mode and of a channel as words, in the order of the bits of enum ema_quality_flag and enum
 * ema_channel_quality_flag, and the methods in that of enum ema_method; NULL behind the last. */
extern const char *const ema_mode_doubts[], *const ema_channel_doubts[], *const ema_method_words[];

/* what was measured */
struct ema_source {
    const char *file;          /* path of the file as given */
    int quantity;              /* of the response */
    int transfer_functions;    /* response and reference pairs */
    int lines;                 /* of every transfer function, within --band */
    double low_hz;             /* first line [Hz] */
    double high_hz;            /* last line [Hz] */
    int from_time_records;     /* false: the file holds transfer functions */
    int impacts;               /* found in the time records */
    int impacts_used;          /* those that are not double, cut off or clipped */
    double window_decay_per_s; /* of the exponential window, taken off every pole [1/s]; 0: none */
};

struct ema_point_frequency {
    double frequency_hz;     /* of the mode in the transfer functions of this point alone [Hz]; NaN near a node */
    double frequency_std_hz; /* its standard deviation [Hz] */
};

/* a point; the last two keys with --per-point */
struct ema_shape_point {
    int node;                          /* label of the file */
    int direction;                     /* 0 scalar, 1 to 6 X Y Z RX RY RZ */
    double value;                      /* real shape, largest component 1; NaN where not measured */
    double std;                        /* its standard deviation, the scale of the mode left out */
    double complex_re;                 /* complex shape at the same scale, real part */
    double complex_im;                 /* and imaginary part */
    struct ema_point_frequency *alone; /* NULL: the keys are left out */
};

/* a mode */
struct ema_mode_result {
    int mode;                    /* number in this result and in the file that is written */
    double frequency_hz;         /* undamped, |lambda|/(2 pi) [Hz] */
    double frequency_std_hz;     /* standard deviation [Hz] */
    double damping;              /* fraction of critical damping [1]; NaN where a half-power point lies outside the band
                                    (quadrature) */
    double damping_std;          /* standard deviation [1] */
    double mpc;                  /* modal phase collinearity: 1 for points that move in phase */
    double mpd_degrees;          /* mean phase deviation of the points [degrees] */
    double modal_mass_kg;        /* of the shape whose largest component is 1 [kg]; NaN where no point was struck and measured */
    double peak_signal_to_noise; /* value over its standard deviation at the peak, median of the transfer functions */
    double nearest_hz;           /* nearest other mode [Hz]; NaN where there is one mode */
    int doubts;                  /* what is doubtful about the mode */
    int nshape;
    struct ema_shape_point *shape; /* at every point */
};

/* a pole */
struct ema_pole_result {
    int order;            /* of the denominator */
    double frequency_hz;  /* [Hz] */
    double damping;       /* fraction of critical damping [1] */
    int stable_frequency; /* the order before has it within 0.2 % */
    int stable_damping;   /* and its damping within 5 % */
    int part;             /* 0: of the whole band; parts of a band with very many lines have a table each, counted from 1 */
    int mode;             /* that it was taken for */
};

/* a transfer function */
struct ema_channel_result {
    int response_node;       /* label */
    int response_direction;  /* 0 scalar, 1 to 6 X Y Z RX RY RZ, negative the other way */
    int reference_node;      /* label of the node that was struck */
    int reference_direction; /* as response_direction */
    int averages;            /* impacts in it; 0: not known */
    double frac;             /* FRAC of measured and synthesised values over the band; NaN where it was left out */
    double noise;            /* standard deviation of its lines over their values, both rms */
    int doubts;              /* what is doubtful about it */
};

/* a transfer function with its values */
struct ema_curve {
    int channel; /* number in channels, from 1 */
    int nfrequency_hz;
    double *frequency_hz;   /* lines [Hz] */
    double *measured_re;    /* measured value, real part [of the quantity per newton, SI] */
    double *measured_im;    /* and imaginary part */
    double *synthesised_re; /* value of the modes with what lies beyond the band, real part */
    double *synthesised_im; /* and imaginary part */
};

struct ema_result {
    struct ema_source source; /* what was measured */
    int method;               /* as given by --method */
    int order;                /* highest order of the denominator; 0 for quadrature */
    int refined;              /* false: the poles are those of the method, not refined together */
    int std_from;             /* standard deviations rest on the variance of the lines, from the impacts or from coherences; or on
                                 what the modes leave over */
    const char *output;       /* universal file that the modes were written to */
    int nmodes;
    struct ema_mode_result *modes; /* by rising frequency; empty: none was found */
    const double *mac;             /* modal assurance criterion of the complex shapes with each other, row by row */
    int nstabilisation;
    struct ema_pole_result *stabilisation; /* poles of the tables, order by order, by rising frequency; empty for quadrature */
    int nchannels;
    struct ema_channel_result *channels; /* the transfer functions */
    int nrms_frequency_hz;
    const double *rms_frequency_hz; /* lines of the two below [Hz] */
    const double *rms_measured;    /* root mean square over the transfer functions of the magnitude of the measured values [SI] */
    const double *rms_synthesised; /* the same of the synthesised values [SI] */
    int ncurves;
    struct ema_curve *curves; /* by rising FRAC: all transfer functions, or of many lines some from the worst to the best */
    double seconds;           /* time taken [s] */
};

/* ---------------------------------------------------------------------------------------------------------------- export */

/* What `rotid export` has written, in the shape of its JSON. */

/* Of --format, in the order of enum export_format; NULL behind the last. */
extern const char *const export_format_words[];

/* a parameter of *IDENTIFY; value and std in its unit */
struct export_parameter_result {
    const char *name; /* such as core.E */
    const char *unit; /* 1 for a pure number */
    double value;     /* in the exported model */
    double std;       /* standard deviation; NaN where it cannot be stated or nothing was fitted */
};

struct export_result {
    const char *format; /* as given by --format */
    int nfiles;
    const char **files; /* paths of the files that were written, beginning with the path as given */
    const char *model;  /* stated: as the deck states it, nothing was fitted */
    const char *status; /* of the fit, as rotid identify has it; NULL where nothing was fitted */
    int nparameters;
    struct export_parameter_result *parameters; /* in the order of *IDENTIFY */
    double mass_kg;                             /* of the exported model [kg] */
    double center_of_mass_m;                    /* from the left end [m] */
    int nodes;                                  /* of the model, those of rods and bars included */
    int degrees_of_freedom;                     /* two a node */
    const char *reduction;                      /* of the condensed matrices; NULL where there are none */
    int masters;                                /* rows of the condensed matrices; ROTID_NONE where there are none */
    int nrigid_hz;
    const double *rigid_hz; /* modes of the rotor on its supports, or of free motion, below the first bending mode [Hz] */
    int nfull_hz;
    const double *full_hz; /* bending modes of the deck's model by rising frequency [Hz] */
    int nexported_hz;
    const double *exported_hz; /* bending modes of the model in the file [Hz]: the full one, with dmig --condensed the condensed
                                  one (NaN beyond those it has) */
};

/* ------------------------------------------------------------------------------------------------------------------ head */

/* The head of every result: the program that wrote the result, and the input. */

#define RESULT_SCHEMA 1 /* raised where a key is removed, or means something else */

struct result_head {
    int schema;          /* version of this schema */
    const char *rotid;   /* version of the program */
    const char *commit;  /* commit it was built from, or unknown */
    const char *blas;    /* what the BLAS library says of itself */
    double seed;         /* of random numbers, as given by --seed */
    int threads;         /* of the computation; of study: processes */
    const char *command; /* command that made the result */
    const char *deck;    /* path of the deck as given */
    int nheading;
    const char **heading; /* lines of *HEADING without the references */
    int nreferences;
    rotid_reference *references; /* values that the heading of the deck gives to compare with */
};

/* The reference of this quantity, or NULL. */
const rotid_reference *head_reference(const struct result_head *head, const char *quantity);
/* Value of the k-th mode in a reference; NaN where there is none, or reference is NULL. */
double reference_value(const rotid_reference *reference, int k);

/* ------------------------------------------------------------------------------------------------------------- json file */

/* JSON out of a file: one value, or one a line. */

#define JSON_FILE_MOST   (64L << 20) /* bytes */
#define JSON_MEMORY_MOST 10          /* bytes of memory for a byte of text, and */
#define JSON_MEMORY_FREE (64L << 20) /* as many in any case */

/* A value of JSON takes 80 bytes once it is read, and may be written with two. Where in text [length] the values take more memory
 * than is allowed, NULL where they do not; results of rotid take 4 to 7 times their size. */
const char *json_text_too_dense(const char *text, size_t length);

/* *json (to be freed with cJSON_Delete) is the value, or an array of the values where the file has one a line; is_lines tells. Of
 * such a file a last line that no line feed ends is left out, with a note: a program died while it wrote. ROTID_OK,
 * ROTID_ERROR_IO, ROTID_ERROR_SYNTAX or ROTID_ERROR_MEMORY, with the mistake in the messages, at file:line:column. */
int json_file_read(struct pool *pool, const char *file, struct message_list *messages, cJSON **json, int *is_lines);

/* ------------------------------------------------------------------------------------------------------------- json tree */

/* A JSON object under construction. A failed allocation anywhere is remembered, so that a result is whole or not there. */

struct json_tree {
    cJSON *root;
    int failed;
};

void json_open(struct json_tree *tree);
/* The text, which ends in a line feed, to be freed with json_free, or NULL where memory was out. The tree is gone then. */
char *json_close(struct json_tree *tree);
void json_free(char *text);
/* The same without a blank, in one line. */
char *json_close_line(struct json_tree *tree);

/* Each adds to an object under `key`, to an array where `key` is NULL; nothing and a mark on the tree where `parent` is NULL. */
cJSON *json_object(struct json_tree *tree, cJSON *parent, const char *key);
cJSON *json_array(struct json_tree *tree, cJSON *parent, const char *key);
void json_null(struct json_tree *tree, cJSON *parent, const char *key);
void json_flag(struct json_tree *tree, cJSON *parent, const char *key, int value);
/* null where the value is not finite */
void json_number(struct json_tree *tree, cJSON *parent, const char *key, double value);
/* In whatever encoding: bytes that are not UTF-8 become U+FFFD; null where there is no text. */
void json_text(struct json_tree *tree, cJSON *parent, const char *key, const char *text);
/* The same with nine significant digits, for arrays that are drawn and not computed with: an array of the length of a mesh takes
 * a third of the room, and one node of the tree. */
void json_digits(struct json_tree *tree, cJSON *parent, const char *key, int count, const double *value);
/* A number rounded to that. */
void json_rounded(struct json_tree *tree, cJSON *parent, const char *key, double value);
/* Rows of a column-major matrix, in full or with nine significant digits. */
void json_digit_rows(struct json_tree *tree, cJSON *parent, const char *key, int rows, int columns, const double *value);
void json_matrix(struct json_tree *tree, cJSON *parent, const char *key, int rows, int columns, const double *value);

/* ------------------------------------------------------------------------------------------------------------- judgement */

/* What is judged of a result, made once for tables, pages and sentences. */

#define JUDGEMENT_CHANCE 0.01 /* a misfit that noise exceeds less often is no noise */

/* Of the modes that have an error_percent: its rms over those that were fitted, or held out [%], NaN of none; the fitted one
 * whose frequency is worst, -1 of none. */
double fit_rms_percent(const rotid_identification *fit, int holdout);
int fit_worst_mode(const rotid_identification *fit);
/* How often the stated noise alone leaves a misfit of chi2 or more; NaN without noise or degrees of freedom. */
double fit_p_value(const rotid_identification *fit);
/* Whether that is less than JUDGEMENT_CHANCE: the model is not adequate for the data. 0 where no noise is stated, chi2 NaN. */
int misfit_is_inadequate(double chi2, int dof);
int fit_is_inadequate(const rotid_identification *fit);
/* The fit as one of its states has it: what that has for itself in place of what all have. */
rotid_identification fit_of_state(const rotid_identification *fit, int s);
/* The name of the state that entry k of modes is of; NULL where the deck is one state. */
const char *fit_state_of_mode(const rotid_identification *fit, int k);
/* The parameter of this name, or NULL; fit may be NULL. */
const rotid_fitted_parameter *fit_parameter(const rotid_identification *fit, const char *name);

/* Of what may hide in a parameter the cause that moves it most, where that is by more than half of its 95 % interval; else NULL.
 */
const rotid_hidden *hidden_in(int count, const rotid_hidden *hidden, const rotid_fitted_parameter *parameter);

/* The fit as the deck states it, where it gives other parameters than the base model by a different choice; else NULL. */
const rotid_identification *diagnosis_today(const rotid_diagnosis *d);
/* The candidates of a round, from 0, best first; their count. */
const rotid_candidate *diagnosis_candidates(const rotid_diagnosis *d, int round, int *count);
/* Whether a card of the deck asked for the cause, which has the name of that card then. */
int diagnosis_is_suspected(const rotid_diagnosis *d, const rotid_cause *cause);

/* ----------------------------------------------------------------------------------------------------------------- place */

/* Values of a JSON file together with the place where they stand, so that whatever is wrong with one is said with its path:
 * "result.json: modes[2].measured_hz: is a text, expected a number". What is wrong is collected in the messages; the routines
 * then return a neutral value, so that a reader goes on and all mistakes of a file are told at once. reader.status tells at the
 * end. */

struct reader {
    struct pool *pool;
    struct message_list *messages;
    const char *file; /* as the user names it */
    int status;       /* ROTID_OK so far, ROTID_ERROR_SYNTAX or ROTID_ERROR_MEMORY */
    int nwrong;       /* mistakes, of which no more than PLACE_MOST_WRONG are told */
};
#define PLACE_MOST_WRONG 20

struct json_place {
    struct reader *reader;
    const struct json_place *above; /* NULL: the whole file */
    const char *key;                /* in the object above, NULL: in an array */
    int index;                      /* in the array above */
    const cJSON *json;              /* NULL: not there */
};

enum place_kind { PLACE_NUMBER, PLACE_TEXT, PLACE_FLAG, PLACE_LIST, PLACE_OBJECT };

/* What is wrong at this place: the text goes on behind the path. */
void place_wrong(const struct json_place *at, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Whether the value is of the kind. If it is of another one that is told; null is let pass. */
int place_is(const struct json_place *at, enum place_kind kind);
/* Whether an object has the key at all. */
int place_has(const struct json_place *above, const char *key);

/* The value under a key of the object `above`, which stays alive as long as *at. 1, or 0 where it is not there: `find` takes a
 * missing key or null for that, `need` says that it is missing. A value of another kind is wrong for both. Of an object that is
 * not there nothing is there. */
int place_find(const struct json_place *above, const char *key, enum place_kind kind, struct json_place *at);
int place_need(const struct json_place *above, const char *key, enum place_kind kind, struct json_place *at);

/* A key that has to be there. null is NaN of a number, "" of a text, 0 of a flag. Texts are copies in the pool. */
double place_number(const struct json_place *above, const char *key);
const char *place_string(const struct json_place *above, const char *key);

/* The elements of a list: for (struct json_place item = place_first(&list, kind); item.json; item = place_next(&item, kind)).
 * Elements of another kind are wrong and passed over; null counts as one. */
struct json_place place_first(const struct json_place *list, enum place_kind kind);
struct json_place place_next(const struct json_place *item, enum place_kind kind);
int place_count(const struct json_place *list);
/* Rows of the same length as a column-major matrix (pool): 1, or 0 where it is not there or empty. expected: the rows and columns
 * there have to be, NULL: any number. */
int place_matrix(const struct json_place *above, const char *key, int need, const int expected[2], int *rows, int *columns,
                 double **value);

/* --------------------------------------------------------------------------------------------------------------- records */

/* The tables of the results of src/run and of this room, and what JSON is made of a table and read by it. */

struct record;

/* Writes the keys of `from`, a struct that `record` describes, into `object` of the tree. */
void record_write(struct json_tree *tree, cJSON *object, const struct record *record, const void *from);

/* Reads the object `at` into `to`, a struct of zeros; lists and texts go to the pool of the reader. What is wrong is told with
 * its place, reader->status tells at the end. */
void record_read(const struct json_place *at, const struct record *record, void *to);

extern const struct record provenance_record; /* struct result_head up to command */
extern const struct record deck_record;       /* the rest, where the command reads a deck */

extern const struct record sensitivity_record;  /* struct sensitivity */
extern const struct record transfer_record;     /* struct transfer_result */
extern const struct record ema_record;          /* struct ema_result */
extern const struct record uff_record;          /* struct uff_result */
extern const struct record export_record;       /* struct export_result */
extern const struct record study_record;        /* struct study_result */
extern const struct record study_header_record; /* struct study_header */
extern const struct record study_axes_record;   /* struct study_axes */
extern const struct record study_run_record;    /* struct study_run */

/* The i-th command that writes results; NULL behind the last. */
const char *result_command(int i);
/* The table of the results of a command, NULL where there is no such command. */
const struct record *result_record(const char *command);
/* Whether a page is made of its results. */
int result_has_page(const char *command);

/* ---------------------------------------------------------------------------------------------------------------- result */

/* A result as a whole: the program writes it with --json, `report` reads it. */

/* A key that an older result does not hold, and the part of the page that is left out for it. */
struct lacking {
    const char *key, *shows; /* "geometry", "the drawing of the rotor" */
};
#define LACKING_MOST 4

/* What a command found of one of several states. */
struct result_state {
    const char *name; /* of the *STATE */
    /* of the command; the others are NULL */
    rotid_check *check;
    rotid_spectrum *modes;
    const struct sensitivity *sensitivity;
    const struct transfer_result *frf;
};

struct result {
    struct result_head head;
    /* of the command that head.command names, of several states the first one's; the others are NULL */
    rotid_check *check;
    rotid_spectrum *modes;
    rotid_identification *identify;
    rotid_diagnosis *diagnose;
    rotid_suggestion *suggest;
    const struct sensitivity *sensitivity;
    const rotid_speeds *speeds;
    const struct transfer_result *frf;
    const struct ema_result *ema;
    const struct uff_result *uff;
    const struct export_result *export;
    const struct study_result *study;
    int nstates;
    struct result_state *states; /* of a deck with several *STATE what each has, in its order; none of a deck that is one state.
                                    What stands beside it is of the first */
    int nwarnings;
    const char **warnings; /* what the reader of the deck, the pairing and the fit have to say; empty where there is nothing */
    /* of a result that was read from a file */
    const char *file; /* as given */
    int nlacking;
    struct lacking lacking[LACKING_MOST];
    cJSON *json; /* as it stands there, of a file of results the list of its lines; deleted by whoever read it */
};

/* Who reads the file of results of a study, which has a value a line. */
typedef void result_lines_reader(const struct json_place *lines, struct result *result);

/* The result as JSON: a text to be freed with json_free; NULL where memory is out, or was when the part of
 * the command was made and that is NULL. */
char *result_json(const struct result *result);

/* Reads a file that a command wrote with --json, or a file of results of a study. The structs hang on the pool, result->json does
 * not. ROTID_OK;
 * ROTID_ERROR_IO: the file cannot be read; ROTID_ERROR_SYNTAX: no JSON, no such result, or one that contradicts itself;
 * ROTID_ERROR_MEMORY. The messages say what and where. */
int result_read(struct pool *pool, const char *file, struct message_list *messages, result_lines_reader *read_lines,
                struct result *result);

/* The rotor of a result, the fit that it is about (its own, or the model that a diagnosis judged), the noise of its data; NULL
 * where it has none. */
const rotid_geometry *geometry_of_result(const struct result *result);
const rotid_identification *fit_of_result(const struct result *result);
const rotid_noise *noise_of_result(const struct result *result);

/* ----------------------------------------------------------------------------------------------------------------- study */

/* What `rotid study` writes, in the shape of its JSON: the first line of a file of results, the line of a run, and the summary.
 */

enum { STUDY_CONVERGED, STUDY_AT_BOUND, STUDY_NOT_CONVERGED, STUDY_FAILED };
enum { STUDY_VERDICTS = 4, STUDY_SCORES = 8 };
/* The words of the enum above, and of enum score; NULL behind the last. */
extern const char *const study_status_words[], *const score_words[];

/* of what the parts mean: 16 hexadecimal digits each; comments, blanks and places of files do not count */
struct study_digests {
    const char *plan;    /* cards of the plan */
    const char *decks;   /* cards of the decks */
    const char *data;    /* measured data, with the files they come from */
    const char *options; /* --set */
};

/* the first line: which study the file is of */
struct study_header {
    int schema;                  /* version of this schema */
    const char *rotid;           /* version of the program that computes the runs */
    const char *commit;          /* commit it was built from, or unknown */
    const char *command;         /* command that made the file */
    const char *plan;            /* path of the plan as given; NULL where decks were named */
    const char *studies;         /* what each run is */
    struct study_digests digest; /* of the inputs */
    double seed;                 /* of random numbers */
    int runs;                    /* of the whole study */
    const char *shard;           /* I/N: runs with run modulo N = I - 1; NULL: all */
};

/* where a run stands on the axes of the plan; NULL on those that it does not have */
struct study_axes {
    const char *deck;       /* path of the deck as the plan or the command line has it */
    const char *variant;    /* NAME of the *VARIANT */
    const char *modes;      /* line of *MODES */
    const char *sensors;    /* line of *SENSORS: a number, every k, or all */
    double noise_frequency; /* of *NOISE, relative standard deviation [1] */
    double noise_shape;     /* of *NOISE, relative to the largest component [1]; NaN where the line states none */
    const char *hide;       /* NAME of the *HIDE, or its type and target */
};

/* a parameter of an effect */
struct run_value {
    const char *name; /* such as mass */
    const char *unit; /* 1 for a pure number */
    double value;     /* in its unit */
};

/* an effect with the values drawn for it */
struct run_hidden {
    const char *id; /* of the catalogue */
    int nparameters;
    struct run_value *parameters; /* in the order of docs/deck.md */
};

/* the line of a run: what identify or diagnose say of it, by the keys of their JSON, without shapes, geometry, candidates and the
 * spectrum of the model; these stand where it did not fail, those from verdict on in a diagnosis, of which the fit is that of the
 * extended model */
struct study_run {
    int run;                /* number of the run, from 0 */
    struct study_axes cell; /* what tells its cell from others */
    int replicate;          /* from 0 */
    int start;              /* from 0 */
    int status;             /* of the fit; failed: the run has no result */
    const char *error;      /* why it failed; NULL: the run has a result */
    int sensors;            /* of the fitted model */
    int ntruth;
    rotid_component *truth;     /* values of the parameters in the model that made the data, those that are known, by name */
    struct run_hidden *hidden;  /* what acts in the data and not in the fitted model; NULL: nothing */
    rotid_identification *fit;  /* NULL: it failed; history only where the plan has *STARTS, baseline with BASELINE=YES */
    rotid_diagnosis *diagnosis; /* NULL without */
    rotid_speeds *speeds;       /* of the machine in operation; NULL without */
    int score;                  /* the verdict beside what was hidden, docs/study.md; below 0 where the data are measured */
    int false_findings;         /* faults of the data that were found and not hidden; ROTID_NONE where the data are measured */
    int nwarnings;
    const char **warnings; /* what the pairing and the fit have to say; NULL: it failed */
    const char *input;     /* digest of its deck with the data, docs/study.md; NULL where a plan was given */
    double seconds;        /* of the run [s] */
    const char *study;     /* digest of the study that the run is of, docs/study.md; NULL before the stamp is there */
    const char *digest;    /* of all bytes of the line before it; NULL before the stamp is there */
};

/* over the runs of a cell, in its unit where it has one */
struct cell_parameter {
    const char *name;       /* such as core.E */
    const char *unit;       /* 1 for a pure number */
    int count;              /* runs that have it */
    double mean;            /* of the values */
    double std;             /* of the values; NaN for fewer than two */
    double min;             /* smallest value */
    double max;             /* largest value */
    double mean_stated_std; /* mean of the standard deviations of the fits */
    double bias;            /* mean of value less truth; NaN where no truth is known */
    double std_error;       /* standard deviation of value less truth, about its mean */
    double rms_error;       /* root of the mean square of value less truth */
    int intervals;          /* 95 % intervals with a truth beside */
    double coverage95;      /* share of them that hold it [1] */
};

/* counts */
struct cell_diagnoses {
    int count;                    /* diagnoses */
    int verdicts[STUDY_VERDICTS]; /* runs by verdict */
    int nnamed;
    rotid_component *named;   /* runs in which a cause or a fault of the data was named, by id */
    int scores[STUDY_SCORES]; /* runs by score, docs/study.md; ROTID_NONE where the data are measured */
    int false_findings;       /* faults of the data that were found and not hidden; ROTID_NONE where the data are measured */
};

/* runs that differ in replicate and start alone */
struct study_cell_result {
    struct study_axes cell; /* its place on the axes of the plan */
    int first_run;          /* lowest number */
    int runs;               /* there */
    int converged;          /* not at a bound */
    int at_bound;           /* converged at a bound */
    int not_converged;      /* fits that did not */
    int not_adequate; /* of those that converged, at a bound or not: noise alone leaves such a misfit in less than 1 % of tests */
    int failed;       /* runs without a result */
    int reached_best; /* runs whose objective is the best of their replicate; ROTID_NONE with one start each */
    int nparameters;
    struct cell_parameter *parameters;    /* over the runs that converged, at a bound or not */
    double frequency_rms_percent;         /* of the fitted frequencies [%] */
    double holdout_frequency_rms_percent; /* of those held out [%] */
    double chi2_per_dof;                  /* mean [1] */
    double evaluations;                   /* mean, of the residual */
    struct cell_diagnoses *diagnoses;     /* NULL for identifications */
    double seconds;                       /* of its runs together [s] */
};

/* why runs failed */
struct study_error {
    const char *error; /* as in the line */
    int runs;          /* that failed for it */
    int first_run;     /* lowest number */
};

struct study_result {
    const char *results; /* path of the file of results as given */
    const char *plan;    /* path of the plan as it was given; NULL where decks were named */
    const char *studies; /* what each run is */
    int shard;           /* which one the file is of */
    int shards;          /* 1: the file is of all runs */
    int runs;            /* that the file is to have */
    int done;            /* that it has */
    int missing;         /* that it does not have */
    int failed;          /* of those it has */
    int ncells;
    struct study_cell_result *cells; /* in order of their first runs */
    int nerrors;
    struct study_error *errors; /* why runs failed */
    double seconds;             /* of all runs together [s] */
};

/* -------------------------------------------------------------------------------------------------------------- transfer */

/* What `rotid frf` finds, in the shape of its JSON. */

/* Quantities of the response and units of the functions in the order of enum frf_quantity, sources of a damping in that of enum
 * frf_damping; NULL behind the last. */
extern const char *const transfer_quantity_words[], *const transfer_unit_words[], *const transfer_damping_words[];

/* an identified parameter at whose value the model is taken */
struct transfer_parameter {
    const char *name; /* such as core.E */
    const char *unit; /* of the value; 1 for a pure number */
    double value;     /* [unit] */
};

struct transfer_mode_agreement {
    double frac;                         /* FRAC of all functions over the lines nearest to this mode [1] */
    double frac_at_measured_frequencies; /* the same with measured frequencies in place of the model's [1] */
    double level_db;                     /* measured over synthesised, each at its own resonance, over all functions [dB] */
    double phase_deg;                    /* measured less synthesised there [degrees] */
    int worst_function;                  /* index in functions of the largest deviation */
};

/* a mode; the keys from frac on stand for elastic ones within the lines where there are measured functions */
struct transfer_mode {
    int rigid;                /* a mode on the supports, or of free motion */
    int mode;                 /* number of an elastic mode, from 1 */
    double model_hz;          /* of the full model [Hz] */
    double measured_hz;       /* of the measured mode paired with it, within the lines [Hz] */
    double damping;           /* fraction of critical damping [1] */
    const char *damping_from; /* the measured mode; DAMPING of *FRF; for modes on the supports the smallest, for others the mean
                                 measured ratio */
    struct transfer_mode_agreement *agreement; /* NULL: the keys are left out */
};

struct transfer_agreement {
    double frac;                         /* frequency response assurance criterion [1]; NaN where a function vanishes */
    double frac_at_measured_frequencies; /* the same with the measured frequencies in place of the model's [1] */
    double frac_of_conjugate; /* the same with the conjugate: higher where the measurement has the other sign of time [1] */
    double scale;             /* a of the least sum |measured - a synthesised|^2, below 0: opposite sign [1] */
    double level_db;          /* measured over synthesised [dB] */
};

/* this function at a mode */
struct transfer_at_mode {
    int mode;         /* number, from 1 */
    double level_db;  /* measured over synthesised, each at its own resonance [dB] */
    double phase_deg; /* measured less synthesised there, -180 to 180 [degrees] */
    double deviation; /* largest distance of the curves over the largest measured magnitude, nearest lines [1] */
};

struct transfer_beside {
    struct transfer_agreement agreement;
    int measured_reversed;   /* measured along opposite directions, which is taken into account */
    int measured_reciprocal; /* measured with force and response exchanged */
    int nat_modes;
    struct transfer_at_mode *at_modes; /* elastic modes within the lines */
};

/* a transfer function; frac to at_modes and the measured curve stand where there are measured functions */
struct transfer_function {
    int response;                   /* id of the sensor or node */
    int reference;                  /* id, where the force acts */
    double response_z_m;            /* position in the model [m] */
    double reference_z_m;           /* position in the model [m] */
    struct transfer_beside *beside; /* NULL: the keys are left out */
    int nfrequency_hz;
    double *frequency_hz;   /* lines [Hz]; NULL without curves, whose keys are left out */
    double *synthesised_re; /* real part [unit] */
    double *synthesised_im; /* imaginary part [unit] */
    double *measured_re;    /* real part, in the direction of the model [unit]; NULL: nothing measured */
    double *measured_im;    /* imaginary part [unit] */
};

struct transfer_result {
    int complete;          /* false: interrupted, functions holds those that were finished */
    const char *quantity;  /* of the response */
    const char *unit;      /* of every function */
    int lines;             /* of every function */
    double low_hz;         /* first line [Hz] */
    double high_hz;        /* last line [Hz] */
    double modes_up_to_hz; /* modes are summed up to here [Hz]; the others by value and slope of their sum at the first elastic
                              mode */
    double window_decay;   /* of an exponential window of the measurement, which the synthesis takes over [1/s]; 0: none */
    const char *measured_file; /* universal file of the measured functions */
    int nparameters;
    struct transfer_parameter *parameters; /* at whose values the model is taken; empty: the model as the deck states it */
    int nmodes;
    struct transfer_mode *modes;          /* modes that are summed, by rising frequency */
    struct transfer_agreement *agreement; /* over all functions together */
    int left_out;    /* measured functions that are not lateral along one axis, where all of the file were asked for */
    int with_curves; /* false: too many values, the functions have no curves here; --output has them */
    int nfunctions;
    struct transfer_function *functions; /* transfer functions */
};

/* ------------------------------------------------------------------------------------------------------------------- uff */

/* What `rotid uff` lists of a universal file, in the shape of its JSON. Values are as in the file; factors to SI stand beside
 * them.
 */

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
