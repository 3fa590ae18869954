/* The text of one line of the file of results. */
#ifndef ROTID_STUDY_LINE_H
#define ROTID_STUDY_LINE_H

#include "diagnose/diagnose.h"
#include "study/experiment.h"

struct line {
    const struct study *study;
    long run;
    struct study_point point;
    double begin; /* on the clock */
};

/* result [states of the experiment], fit: of all. Each with the line feed at its end, to be freed with json_free; NULL where
 * memory is out. */
char *line_identified(const struct line *line, const struct experiment *experiment, const struct identification *result,
                      const rotid_fit_result *fit, const struct message_list *notes);
char *line_diagnosed(const struct line *line, const struct experiment *experiment, const struct diagnosis *result,
                     const struct message_list *notes);
char *line_failed(const struct line *line, const char *error, double seconds);

#endif
