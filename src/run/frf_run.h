/* Synthesised transfer functions of a job, beside measured ones where there are any: which ones, at which lines, with which
 * damping, and how far the two are apart. Curves are computed when they are asked for; what is kept does not grow with the
 * lines. */
#ifndef ROTID_RUN_FRF_RUN_H
#define ROTID_RUN_FRF_RUN_H

#include "run/frf_agreement.h"
#include "run/identify.h"
#include "run/job.h"
#include "run/synthesis.h"
#include "signal/frf.h"

struct frf_node { /* of the measured file */
    int id;
    double x[3]; /* m */
};

struct frf_measured {
    const struct frf_set *set;
    const char *path; /* for messages */
    int nnode;
    const struct frf_node *node;
};

enum frf_damping { /* where the ratio of a mode comes from */
                   FRF_DAMPING_MEASURED,
                   FRF_DAMPING_STATED,   /* DAMPING= */
                   FRF_DAMPING_SMALLEST, /* rigid and suspension modes: the smallest measured ratio, since slings damp little */
                   FRF_DAMPING_MEAN      /* elastic modes that nobody measured: the mean of the measured ratios */
};

struct frf_row {
    int response, reference;        /* ids */
    double response_z, reference_z; /* m, in the model */
    const struct frf *measured;     /* NULL where there is none */
    double sign;                    /* -1 where measured along one opposite direction */
    int is_reciprocal;              /* measured with the force at the response: H_ij = H_ji */
    struct frf_sums sums;           /* over all lines; the sign is taken into account */
    struct frf_sums moved;          /* with the measured frequencies in place of the model's */
};

/* What one function shows at one mode. */
struct frf_at_mode {
    double level_db;  /* measured over synthesised, each at its own resonance */
    double phase_deg; /* measured less synthesised there, -180 to 180 */
    double deviation; /* largest |H^ - H| of the band over the largest |H^| of it */
};

/* An elastic mode within the lines, and the lines that are nearer to it than to its neighbours. */
struct frf_band {
    int mode, measured;           /* number from 1; index of the measured mode or -1 */
    double model_hz, measured_hz; /* measured_hz NaN where it was not measured */
    int first, last;              /* lines, last inclusive; first > last: none */
    int at_model, at_measured;    /* lines nearest to the resonances */
    struct frf_sums sums, moved;  /* of all functions over these lines */
    struct frf_sums resonance;    /* H^ at its own resonance with H at its own, over the functions */
    int worst;                    /* row of the largest deviation, -1 without measured functions */
};

struct frf_result {
    int is_measured; /* there are measured functions beside */
    int any_swapped; /* frequencies of the model were replaced by measured ones in `moved` */
    enum frf_quantity quantity;
    int nline;
    const double *frequency_hz; /* [nline] > 0 */
    double decay;               /* 1/s, window of the measured functions */
    int skip;                   /* lines of the set below the first one used */
    int nrow, ndone;            /* ndone < nrow: interrupted */
    struct frf_row *row;
    int nband;
    struct frf_band *band;
    struct frf_at_mode *at;      /* [nband * nrow], the bands of a row beside each other; NULL without measured functions */
    struct frf_sums sums, moved; /* of all */
    int nleft_out;               /* measured functions that are no lateral ones along one axis, where all were asked for */
    double up_to_hz;             /* the modes reach at least to there */
    struct synthesis synthesis;
    double *zeta;              /* [synthesis.nmode] */
    enum frf_damping *damping; /* [synthesis.nmode] */
    double *moved_lambda;      /* [synthesis.nmode] */
};

/* identified: of the job, whose parameters and pairing are used; NULL where nothing was measured: the model as the deck states
 * it. measured: NULL where there are no functions to compare with. ROTID_OK, also where environment->cancelled ended it (ndone <
 * nrow); ROTID_ERROR_ARGUMENT with an error in the list: an id that does not exist, no lines, no damping, nothing measured that
 * was asked for, too many modes; ROTID_ERROR_MEMORY; statuses of model_open and prediction_compute. */
int frf_run(struct pool *pool, const struct job *job, const struct identification *identified,
            const struct frf_measured *measured, const rotid_environment *environment, struct message_list *notes,
            struct frf_result *out);

/* Curves of `count` rows from `first`: synthesised [nline * count] (may be NULL) and measured [nline * count] (may be NULL; NaN
 * where there is none) in the quantity of the result, with the sign of the model's direction. work [nline]. */
void frf_synthesised(const struct frf_result *result, int first, int count, double complex *h, double complex *work);
void frf_measured_curve(const struct frf_result *result, const struct frf_set *set, int row, double complex *h);

#endif
