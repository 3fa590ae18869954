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

#endif
