/* A page of results: composed, drawn and written. */
#ifndef ROTID_PAGE_PAGE_H
#define ROTID_PAGE_PAGE_H

#include "page/document.h"
#include "page/result.h"

/* The page of results [count]: the first one is the main result, the others add their sections. */
void page_compose(struct document *document, int count, const struct result *result);

struct page_written {
    int nfigure, ndrawn;
    const char *gnuplot; /* its version, NULL: there is none */
};

/* Writes path/index.html and path/figures. What of the figures could not be drawn is said in warnings; the page has their numbers
 * then. ROTID_OK; ROTID_ERROR_ARGUMENT, ROTID_ERROR_IO, ROTID_ERROR_MEMORY or ROTID_STOP_CANCELLED, with what is wrong in the
 * messages and nothing written. */
int page_write(struct document *document, const char *path, const char *made_by, const rotid_environment *environment,
               struct message_list *messages, struct page_written *written);

#endif
