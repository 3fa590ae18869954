/* What rotid_fit and rotid_fit_states refuse. */
#ifndef ROTID_FIT_FIT_CHECK_H
#define ROTID_FIT_FIT_CHECK_H

#include "modal/joint.h"
#include "rotid.h"

/* The problem of a fit. All structs are of this library's size. */
struct fit_problem {
    int nstate, nparam;
    int named;                        /* the host knows its states: reasons say which */
    const struct joint_state *state;  /* [nstate] */
    const rotid_parameter *parameter; /* [nparam] */
};

/* ROTID_OK, or ROTID_ERROR_ARGUMENT or _UNPAIRED with the reason in failure. */
int fit_check(const struct fit_problem *problem, const rotid_fit_options *options, char *failure);

/* Its parts: a model, and the parameters with their bounds and starts, of which `count` says how rotid.h calls their number. */
int fit_check_model(const rotid_model *model, char *failure);
int fit_check_parameters(const char *count, int nparam, const rotid_parameter *parameter, char *failure);

#endif
