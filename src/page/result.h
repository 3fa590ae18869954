/* What a page is made of: a result of a command, or a file of results of a study. */
#ifndef ROTID_PAGE_RESULT_H
#define ROTID_PAGE_RESULT_H

#include "page/studied.h"
#include "result/judgement.h"
#include "result/result.h"
#include "result/transfer.h"
#include "run/sensitivity.h"

/* result_read, and the results of studies. The structs hang on the pool; statuses as of result_read. */
int page_result_read(struct pool *pool, const char *file, struct message_list *messages, struct result *result);

/* What a result is of, without its folder where that is absolute: its deck, of a modal analysis the file that was measured, else the
 * file of the result. */
const char *page_source(const struct result *result);

/* How many states a result is of, 0 where its deck is one; the name of one. */
int page_state_count(const struct result *result);
const char *page_state_name(const struct result *result, int s);
/* The result as one of its states has it, with its share of the references and of what NLopt predicts. The pool marks where
 * memory was out. */
struct result page_result_of_state(struct pool *pool, const struct result *result, int s);

#endif
