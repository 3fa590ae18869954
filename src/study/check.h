/* What the decks of a plan are before the first run: which can be read, how many parameters they have, what they mean. */
#ifndef ROTID_STUDY_CHECK_H
#define ROTID_STUDY_CHECK_H

#include "study/study.h"

struct check {
    int *nparameter; /* [nvariant * ndeck] */
    struct digest decks, data;
};

/* Fills study->deck[].error and study->file. Errors of the plan go to the list with their places in it, decks that are wrong as
 * they stand as warnings. ROTID_OK, ROTID_ERROR_SYNTAX (also where no deck can be used), ROTID_ERROR_MEMORY. */
int check_decks(struct pool *pool, struct study *study, struct message_list *messages, struct check *check);

#endif
