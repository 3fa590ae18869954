/* The verdict of a diagnosis beside the effect that was hidden. */
#ifndef ROTID_STUDY_SCORE_H
#define ROTID_STUDY_SCORE_H

#include "diagnose/diagnose.h"
#include "study/experiment.h"

enum score {                    /* their words: score_words of result/study.h */
             SCORE_QUIET,       /* nothing was hidden and nothing was found */
             SCORE_FALSE_ALARM, /* nothing was hidden and something was found */
             SCORE_RIGHT,       /* named, and nothing else */
             SCORE_IN_SET,      /* among those that cannot be told apart */
             SCORE_OTHER_SET,   /* not among those */
             SCORE_SILENT,      /* judged adequate */
             SCORE_UNEXPLAINED,
             SCORE_WRONG, /* something else was named */
             SCORE_COUNT
};

/* The experiment's data were made by a model. A cause is the hidden one by its id, its target, and where it has a place by that,
 * within its width or 3 % of the length; a mass is a mass, whether it is called added or that of an accelerometer there; one that
 * is said to act in one state alone is another one. A fault of the data is known by its id, sensors and block. */
enum score score_make(const struct experiment *experiment, const struct diagnosis *diagnosis);

/* Whether a candidate is the hidden cause by those rules. */
int score_is_hidden(const struct experiment *experiment, const struct diagnosis *diagnosis, const struct candidate *candidate);

/* Faults of the data that were found and not hidden. */
int score_false_findings(const struct experiment *experiment, const struct diagnosis *diagnosis);

#endif
