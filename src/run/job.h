/* A job: what a deck says, resolved to numbers and indices. Filled by src/deck, or by anybody who has the data in another form.
 */
#ifndef ROTID_RUN_JOB_H
#define ROTID_RUN_JOB_H

#include "base/message.h"
#include "base/pool.h"
#include "beam/beam.h"
#include "beam/rotor.h"
#include "rotid.h"

/* A list of values that the heading gives to compare with: "paper error_percent = -3.83, 8.38, ..." */
struct reference {
    const char *quantity; /* "error_percent", "predicted_hz", "sensitivity core.E" */
    int count;
    double *value;
};

struct job {
    const char *deck; /* path as given */
    int nheading;
    const char **heading; /* lines of text without the references */
    int nreference;
    struct reference *reference;

    struct rotor rotor;

    int nmode;             /* measured */
    int *number;           /* [nmode] elastic mode of the model, from 1; the shapes may decide otherwise */
    double *frequency_hz;  /* [nmode] */
    double *damping;       /* [nmode] ratio, NaN where there is none */
    double *frequency_std; /* [nmode] relative, NaN where there is none; the NOISE card is already applied */
    double *shape;         /* [nsensor * nmode] NaN where not measured, or NULL */
    double *shape_std;     /* [nsensor * nmode] relative to the largest component, NaN where there is none; or NULL */
    int *holdout;          /* [nmode] */

    int nparameter;
    struct parameter *parameter; /* [nparameter] */
    rotid_parameter *bounds;     /* [nparameter] with name and unit */

    int has_fit; /* a FIT card states functional or reduction */
    rotid_fit_options fit;
};

/* The values of a reference, or NULL. */
const struct reference *job_reference(const struct job *job, const char *quantity);

/* Whether the noise of every measured frequency, and of every shape component, is known. */
int job_knows_frequency_noise(const struct job *job);
int job_knows_shape_noise(const struct job *job);

const char *functional_name(int functional);
const char *reduction_name(int reduction);
const char *derivative_name(int derivative);

#endif
