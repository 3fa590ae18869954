/* Hidden-effect cases: data made by tools/hide, which shares no code with the library, diagnosed as a user would have it done,
 * and only then compared with the truth. */
#ifndef ROTID_TESTS_HIDDEN_H
#define ROTID_TESTS_HIDDEN_H

#include "hide/hide.h"
#include "power/score.h"

struct hidden_case {
    struct hide_request request; /* with the deck's text and its path as the name */
    const char *directory;       /* for the deck with its data: case_NUMBER.inp */
    int number;
    int keep; /* leaves the deck there, and the truth: case_NUMBER.json */
};

/* What was found, while it is there. */
typedef void hidden_look(void *context, const struct hidden_case *c, const struct diagnosis *diagnosis, const cJSON *truth,
                         const struct hidden_score *score);

/* Makes the case, diagnoses it in one thread with a seed that follows that of the case, and scores it. look may be NULL. 0, or
 * ROTID_STOP_CANCELLED where the environment (may be NULL) ended the diagnosis; what goes wrong otherwise is HIDDEN_FAILED. Cases
 * may run in several threads at once. */
int hidden_run(const struct hidden_case *c, const rotid_environment *environment, hidden_look *look, void *context,
               struct hidden_score *score);

/* Text of a file, to be freed; NULL where it cannot be read. */
char *hidden_read(const char *path);

#endif
