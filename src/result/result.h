#ifndef ROTID_RESULT_RESULT_H
#define ROTID_RESULT_RESULT_H

/* result: results as JSON, written, and read with the place of every mistake; what is judged of a result.
 *
 * Comes in: struct result, with head and the struct of one command; or a file. Goes out: JSON text; or the same struct.
 *
 *   result.c          result_json: the struct of the command as JSON by its table (result_kinds), a row of the table a key
 *   result_read.c     result_read: a file to struct result, then contradictions between its parts
 *   json_write.c, json_read.c  any struct that has a table of src/record, to JSON and from JSON; a value with its path:
 *                     "result.json: modes[2].measured_hz: is a text, expected a number"
 *   results.def       the results that only the program has: ema, export, study, frf, uff. Those of the others (check, modes,
 *                     identify, diagnose, suggest, speeds) are structs of rotid.h and have their tables in src/record
 *   tables.c          the tables of results.def, of the sensitivities of src/run, and of the line of a run of a study
 *   json_file.c       a text of JSON, or one value a line, within limits of memory
 *   judgement.c       fit_p_value = P(chi^2 of dof > misfit); worst mode; what hides in a parameter; rivals of a verdict
 *   result.c          where a cause acts along z; program, seed, command, deck of a result; references of the heading
 *
 * The structs are the keys of the JSON; docs/schema takes the comments beside their members. Callers: src/cli (writes),
 * src/page (reads), src/report, src/export, src/study, src/mpi. The room computes nothing of a model and knows no layout. */

#include <cJSON.h>

#include "ema/ema.h"
#include "record/record.h"

/* ----------------------------------------------------------------------------------------------------------- cause place */

/* Where a cause acts along the axis of the rotor. */

struct cause_place {
    double from, to; /* from <= to [m] */
    double ci[2];    /* 95 % interval of the place [m], NaN where it is not searched for or not stated */
};

/* 0: the cause has no place, or the geometry (may be NULL) does not know its target. */
int cause_place(const rotid_geometry *geometry, const rotid_cause *cause, struct cause_place *place);

/* ------------------------------------------------------------------------------------------- results of the program alone */

enum { STUDY_CONVERGED, STUDY_AT_BOUND, STUDY_NOT_CONVERGED, STUDY_FAILED };
enum { STUDY_VERDICTS = 4, STUDY_SCORES = 8 };

/* Words of their JSON; NULL behind the last. Of enum ema_method, of the bits of enum ema_quality_flag and enum
 * ema_channel_quality_flag; of enum export_format; of the enum above, and of enum score; of enum frf_quantity, twice, and enum
 * frf_damping. */
extern const char *const ema_method_words[], *const ema_mode_doubts[], *const ema_channel_doubts[];
extern const char *const export_format_words[], *const study_status_words[], *const score_words[];
extern const char *const transfer_quantity_words[], *const transfer_unit_words[], *const transfer_damping_words[];

/* The structs and, of each, the table NAME_record: results.def. */
#define BEGIN(S) struct S {
#define END(S)                                                                                                                   \
    }                                                                                                                            \
    ;                                                                                                                            \
    extern const struct record S##_record;
#define KEY(KIND, S, ...)      MEMBER_##KIND(__VA_ARGS__)
#define PART(KIND, S, M, B, T) MEMBER_##KIND(M, T)
#define TOGETHER(B, R)
#define ROW(...)
#define OF(S, T) extern const struct record S##_record;
#define DONE
#define ON(...)
#define IS(...)
#define IS_LIST(...)
#define IS_FIXED(...)
#define MEMBER(TYPE, M)           TYPE M;
#define MEMBER_NUMBER(M, B)       double M;
#define MEMBER_INTEGER(M, B)      int M;
#define MEMBER_FLAG(M, B)         int M;
#define MEMBER_TEXT(M, B)         const char *M;
#define MEMBER_TEXT_OF(M, B, W)   const char *M;
#define MEMBER_WORD(M, B, W)      int M;
#define MEMBER_WORDS(M, B, W)     int M;
#define MEMBER_COUNTS(M, B, W, N) int M[N];
#define MEMBER_NUMBER_3(M)        double M[3];
#define MEMBER_LIST(TYPE, M)                                                                                                     \
    int n##M;                                                                                                                    \
    TYPE M;
#define MEMBER_NUMBERS(M, B)          MEMBER_LIST(const double *, M)
#define MEMBER_TEXTS(M, B)            MEMBER_LIST(const char *const *, M)
#define MEMBER_MAP(M, B)              MEMBER_LIST(rotid_component *, M)
#define MEMBER_STRUCTS(M, T)          MEMBER_LIST(struct T *, M)
#define MEMBER_NUMBERS_BY(M, B, N, K) const double *M;
#define MEMBER_MATRIX(M, B, R, C)     const double *M;
#define MEMBER_STRUCT_IN(M, T)        struct T M;
#define MEMBER_INLINE_IN(M, T)        struct T M;
#define MEMBER_STRUCT_AT(M, T)        struct T *M;
#define MEMBER_INLINE_AT(M, T)        struct T *M;
#include "result/results.def"
#undef BEGIN
#undef END
#undef KEY
#undef PART
#undef TOGETHER
#undef ROW
#undef OF
#undef DONE
#undef ON
#undef IS
#undef IS_LIST
#undef IS_FIXED
#undef MEMBER

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
    const char *length_unit;     /* cm, mm or in of *UNITS, in which people are shown lengths; without the key m */
    const char *frequency_unit;  /* kHz, rpm or rad/s of *UNITS, in which they are shown frequencies; without the key Hz */
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

/* *json (to be freed with cJSON_Delete) is the first value of text [length], *rest where it ends or where it is wrong (NULL: not
 * asked for). ROTID_OK, ROTID_ERROR_SYNTAX, or ROTID_ERROR_MEMORY, which is not to be told as a fault of the text. */
int json_parse(const char *text, size_t length, const char **rest, cJSON **json);

/* *json (to be freed with cJSON_Delete) is the value, or an array of the values where the file has one a line; is_lines tells. Of
 * such a file a last line that no line feed ends is left out, with a note: a program died while it wrote. ROTID_OK,
 * ROTID_ERROR_IO, ROTID_ERROR_SYNTAX or ROTID_ERROR_MEMORY, with the mistake in the messages, at file:line:column. */
int json_file_read(struct pool *pool, const char *file, struct message_list *messages, cJSON **json, int *is_lines);

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
/* Where the errors of the mesh are enough for a misfit that is inadequate, sum over the fitted modes of (mesh error/noise)^2 >=
 * chi2/2, the mode whose mesh error is the most times its noise; else -1. */
int fit_mode_of_mesh(const rotid_identification *fit);
/* The fit as one of its states has it: what that has for itself in place of what all have. */
rotid_identification fit_of_state(struct pool *pool, const rotid_identification *fit, int s);
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

/* Whether an object has the key at all. */
int place_has(const struct json_place *above, const char *key);

/* The value under a key of the object `above`, which stays alive as long as *at. 1, or 0 where it is not there or of another
 * kind, which is told. Of an object that is not there nothing is there. */
int place_need(const struct json_place *above, const char *key, enum place_kind kind, struct json_place *at);

/* A text that has to be there, a copy in the pool; null is "". */
const char *place_string(const struct json_place *above, const char *key);

/* The first element of a list that is of the kind. Elements of another kind are wrong and passed over; null counts as one. */
struct json_place place_first(const struct json_place *list, enum place_kind kind);

/* --------------------------------------------------------------------------------------------------------------- records */

/* The tables of the results of src/run and of this room, and what JSON is made of a table and read by it. */

/* The struct `from`, which `record` describes, as an object of JSON with a line feed at its end; lines: a key a line, else all in
 * one line. To be freed; NULL where memory is out. */
char *record_text(const struct record *record, const void *from, int lines);

/* Reads the object `at` into `to`, a struct of zeros; lists and texts go to the pool of the reader. above: the struct that
 * `to` is part of, for FIELD_COUNT; NULL of the root. What is wrong is told with its place, reader->status tells at the end. */
void record_read(const struct json_place *at, const struct record *record, const void *above, void *to);

extern const struct record provenance_record; /* struct result_head up to command */
extern const struct record deck_record;       /* the rest, where the command reads a deck */

extern const struct record sensitivity_record; /* struct sensitivity */
extern const struct record study_run_record;   /* struct study_run */

/* The results of a command. */
struct result_kind {
    const char *command;
    struct record record; /* of struct result */
    int has_page;         /* a page is made of them */
};
extern const struct result_kind result_kinds[]; /* command NULL behind the last */
/* NULL where there is no such command. */
const struct result_kind *result_kind(const char *command);

/* ---------------------------------------------------------------------------------------------------------------- result */

/* A result as a whole: the program writes it with --json, `report` reads it. */

/* A key that an older result does not hold, and the part of the page that is left out for it. */
struct lacking {
    const char *key, *shows; /* "geometry", "the drawing of the rotor" */
};
#define LACKING_MOST 4

/* What a command found of one of several states. */
struct result_state {
    const char *name;      /* of the *STATE */
    const struct job *job; /* of a check that was made here */
    /* of the command; the others are NULL */
    rotid_check *check;
    rotid_spectrum *modes;
    const struct sensitivity *sensitivity;
    const struct transfer_result *frf;
};

struct result {
    struct result_head head;
    const struct job *job; /* of a check that was made here, of a deck that is one state */
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

/* The result as JSON: a text to be freed; NULL where memory is out, or was when the part of
 * the command was made and that is NULL. */
char *result_json(const struct result *result);

/* Reads a file that a command wrote with --json, or a file of results of a study. The structs hang on the pool, result->json does
 * not. ROTID_OK;
 * ROTID_ERROR_IO: the file cannot be read; ROTID_ERROR_SYNTAX: no JSON, no such result, or one that contradicts itself;
 * ROTID_ERROR_MEMORY. The messages say what and where. */
int result_read(struct pool *pool, const char *file, struct message_list *messages, result_lines_reader *read_lines,
                struct result *result);

/* How many states a result is of, 0 where its deck is one; what a command found of one, as if it stood alone. */
int result_states(const struct result *result);
struct result result_of_state(struct pool *pool, const struct result *result, int s);

/* The rotor of a result, the fit that it is about (its own, or the model that a diagnosis judged), the noise of its data; NULL
 * where it has none. */
const rotid_geometry *geometry_of_result(const struct result *result);
const rotid_identification *fit_of_result(const struct result *result);
const rotid_noise *noise_of_result(const struct result *result);

/* ----------------------------------------------------------------------------------------------------------------- study */

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

#endif
