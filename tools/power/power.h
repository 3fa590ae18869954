/* What the diagnosis can do: random rotors with hidden effects, and how often it says what is true. */
#ifndef POWER_H
#define POWER_H

#include <signal.h>
#include <stdint.h>
#include <stdio.h>

#include "hidden.h"
#include "hide/hide_random.h"
#include "hide/hide_text.h"

struct power_options {
    int cases, first, jobs, changed;
    uint64_t seed;
    const char *only; /* kind of effect of `hide --random`, or NULL: the mixture */
    const char *log;  /* a line of JSON a case; what it holds is not done again. NULL: none */
    int prior;        /* cases from the priors of the diagnosis; 2: but for the noise, which is as stated */
    int suggest;      /* what becomes of the tests that are proposed, in place of the diagnosis alone */
    const char *keep; /* directory for decks and truths, NULL: they are removed */
};

/* ---- a case */

struct power_case {
    struct hidden_case hidden; /* points into what follows */
    char *deck, effect[64], again[200];
    const char *list;
};

/* The case of a number: rotor, kind of effect, noise, how much is measured. `again` are the options of power that make it again.
 * Nonzero without memory; deck is to be freed. */
int power_draw(const struct power_options *options, int number, struct power_case *c);

/* A rotor as a deck without data; to be freed, NULL without memory. */
char *power_rotor(uint64_t seed);

struct power_result {
    int done; /* there is a score */
    char again[200];
    struct hidden_score score;
};

/* ---- a line of JSON a case: all that was said, and all that is true */

/* d and truth are NULL where there was no diagnosis. To be freed. */
char *power_line(const struct power_case *c, const struct diagnosis *d, const cJSON *truth, const struct hidden_score *score);

/* Opens a log to go on with it: each whole line goes to `take`, which says by a nonzero that it is not of this run (NULL: no
 * JSON). A line that is not whole, which a power cut may leave, is cut off. NULL where the file cannot be opened, or is of
 * another run: then standard error says so. */
FILE *power_lines(const char *path, int (*take)(void *context, const cJSON *line), void *context);

/* Opens the log to go on with it, and takes what it holds of these cases into result[options->cases]. NULL likewise. */
FILE *power_log(const struct power_options *options, struct power_result *result);

/* Leaves a deck as NAME_NUMBER.inp in the folder `keep`. */
void power_keep(const struct power_options *options, const char *name, int number, const char *text);

/* ---- the run */

/* Runs the cases, shows the progress on a terminal, writes the report. Ends after the cases under way as soon as *interrupted is
 * set. 0 where all requirements hold, 1 where one does not, 3 a file or memory. */
int power_run(const struct power_options *options, const volatile sig_atomic_t *interrupted, FILE *out);

/* context: the sig_atomic_t */
int power_interrupted(void *context);

/* The same rotors measured before and after an effect came, with another one in both: what the diagnosis says of the change, a
 * pair a paragraph, and how often it is right, of what is finished where it is interrupted. 0 where it is in nine of ten, 1
 * where not, 3 memory. */
int power_changed(const struct power_options *options, const volatile sig_atomic_t *interrupted, FILE *out);

/* Of cases with one physical effect, or of the kind `only`, those that stay ambiguous: makes the test that `rotid suggest` ranks
 * first, the same test again, and that with twice the sensors, diagnoses each with what was measured as two states, and counts
 * names beside what was promised. 0, or 3: a file or memory. */
int power_suggest(const struct power_options *options, const volatile sig_atomic_t *interrupted, FILE *out);

/* ---- self-consistency */

/* Draws an explanation from the priors of the diagnosis, its causes and their sizes, of the candidates that scan_list lists;
 * shapes are measured: faults of channels as well. */
void power_prior_draw(const struct rotor *rotor, const struct scan *list, int shapes, struct hide_random *random,
                      struct explanation *e);
int power_prior_kinds(const struct scan *list, int shapes); /* of causes, all as likely */

struct prior_case {
    struct hide_text deck; /* with the data; its data are to be freed */
    struct explanation truth;
    const struct segment *segment; /* with the elements that the data were computed on */
    const double *x;               /* [nown] true values of the deck's parameters */
    int nown, kinds, draws;        /* draws: with those whose data cannot be measured */
};

/* Rotor, sensors and noise of the request, an explanation, and data that the model of the diagnosis makes of it. stated: the
 * noise is as stated, else its level is drawn too. ROTID_OK, memory, ROTID_ERROR_ARGUMENT without data. */
int power_prior_case(struct pool *pool, const struct hide_request *request, int stated, struct prior_case *out);

/* Cases from the priors: the leading explanation of each, its probability, and whether it is the truth. 0 where the bands hold, 1
 * where not, 3 a file or memory. */
int power_calibration(const struct power_options *options, const volatile sig_atomic_t *interrupted, FILE *out);

/* The table in ten bins of the probability, with bands that hold together 19 times of 20 where the probabilities are true; log
 * score. 0 where all bins are inside. */
int power_bands(FILE *out, int count, const double *probability, const int *right);

/* Tables and requirements of what is done; 0 where all of these hold. */
int power_report(FILE *out, int count, const struct power_result *result);

/* The requirements alone. */
int power_requirements(FILE *out, int count, const struct power_result *result);

/* ---- shares */

struct power_share {
    int right, count;
};

/* Wilson's 95 % interval of a share. */
void power_interval(struct power_share share, double *lower, double *upper);

#endif
