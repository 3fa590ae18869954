/* Time records of a hammer test: which response belongs to which force. */
#ifndef ROTID_IMPORT_RECORDS_H
#define ROTID_IMPORT_RECORDS_H

#include "import/contents.h"
#include "import/measurement.h"

/* Whether there are time records of forces and of responses. */
int contents_have_records(const struct contents *contents);

/* A response belongs to the force with its load case number, where numbers differ from measurement to measurement; else to the
 * last force before it. Transfer functions of all pairs by transfer_compute, to out->set. Statuses of measurement_read. */
int records_load(struct pool *pool, struct uff_reader *reader, const char *path, const struct contents *contents,
                 const struct measurement_options *options, struct message_list *messages, struct measurement *out);

#endif
