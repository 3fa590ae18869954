/* One run of a study, as one line of JSON: docs/schema/study_line.schema.json. Knows nothing of files, processes or machines. */
#ifndef ROTID_STUDY_RUN_H
#define ROTID_STUDY_RUN_H

#include "study/jobs.h"

/* Computes a run. *line: its text with the line feed at its end, to be freed with json_free; also where the run failed, which is
 * a result. ROTID_OK; ROTID_STOP_CANCELLED where the environment ended it, and ROTID_ERROR_MEMORY where there is no room for the
 * text: then there is no line. Uses one thread. */
int study_run(struct jobs *jobs, long run, const rotid_environment *environment, char **line);

/* The line of a run that could not be finished, such as "worker ended by signal 9". NULL where memory is out. */
char *study_run_failed(const struct study *study, long run, const char *error, double seconds);

#endif
