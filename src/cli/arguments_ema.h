/* The options of `ema` alone. */
#ifndef ROTID_CLI_ARGUMENTS_EMA_H
#define ROTID_CLI_ARGUMENTS_EMA_H

#include <getopt.h>

#include "cli/command.h"

enum {
    EMA_OPTION_BAND = 512,
    EMA_OPTION_METHOD,
    EMA_OPTION_ORDER,
    EMA_OPTION_PICK,
    EMA_OPTION_PER_POINT,
    EMA_OPTION_NO_REFINEMENT,
    EMA_OPTION_REFERENCE,
    EMA_OPTION_AVERAGES,
    EMA_OPTION_ESTIMATOR,
    EMA_OPTION_EXPONENTIAL,
    EMA_OPTION_FORCE_WINDOW,
    EMA_OPTION_BLOCK,
    EMA_OPTION_PRETRIGGER,
    EMA_OPTION_THRESHOLD,
    EMA_OPTION_DOUBLE_HITS
};

/* For getopt_long, without the last line of zeros. */
#define EMA_LONG_OPTIONS                                                                                                         \
    {"band", required_argument, NULL, EMA_OPTION_BAND}, {"method", required_argument, NULL, EMA_OPTION_METHOD},                  \
        {"order", required_argument, NULL, EMA_OPTION_ORDER}, {"pick", required_argument, NULL, EMA_OPTION_PICK},                \
        {"per-point", no_argument, NULL, EMA_OPTION_PER_POINT}, {"no-refinement", no_argument, NULL, EMA_OPTION_NO_REFINEMENT},  \
        {"reference", required_argument, NULL, EMA_OPTION_REFERENCE},                                                            \
        {"averages", required_argument, NULL, EMA_OPTION_AVERAGES},                                                              \
        {"estimator", required_argument, NULL, EMA_OPTION_ESTIMATOR},                                                            \
        {"exponential", required_argument, NULL, EMA_OPTION_EXPONENTIAL},                                                        \
        {"force-window", required_argument, NULL, EMA_OPTION_FORCE_WINDOW},                                                      \
        {"block", required_argument, NULL, EMA_OPTION_BLOCK}, {"pretrigger", required_argument, NULL, EMA_OPTION_PRETRIGGER},    \
        {"threshold", required_argument, NULL, EMA_OPTION_THRESHOLD},                                                            \
    {                                                                                                                            \
        "keep-double-hits", no_argument, NULL, EMA_OPTION_DOUBLE_HITS                                                            \
    }

extern const char *const ema_options_help;

/* -1 to go on, or the exit code after saying what was expected. */
int arguments_ema(struct command *command, int option, const char *value);

#endif
