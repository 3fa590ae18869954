/* A modal test as universal files hold it: transfer functions, or the time records they are made from, and the points. */
#ifndef ROTID_IMPORT_MEASUREMENT_H
#define ROTID_IMPORT_MEASUREMENT_H

#include "base/message.h"
#include "base/pool.h"
#include "signal/frf.h"
#include "signal/transfer.h"
#include "uff/uff_data.h"

struct measurement_options {
    struct transfer_options transfer; /* for time records */
    int reference;                    /* only transfer functions with this reference node; 0: all */
    double low_hz, high_hz;           /* only these lines; 0, 0: all */
    int averages;                     /* behind each coherence of the file; 0: not known, so no variance follows from it */
    int threads;
};

struct measurement {
    int node_count;
    struct uff_node *node; /* distinct ids; coordinates in metres */
    struct uff_units units;
    int has_units;
    struct frf_set set; /* as measured or as computed from the records; SI */
    int from_records;   /* nonzero: `transfer` holds the impacts */
    struct transfer transfer;
    int record_count;
    double rate; /* Hz, of the records */
};

/* Reads sets 58 and 58b of a file: transfer functions (type 4) with their coherences (type 6) where it has any, else pairs of
 * time records (type 1), force and response. Nodes from 15, 781, 2411; values and coordinates brought to SI by set 164 and the
 * texts of the axes. Coherences of the same response and reference go with their transfer function, and give the variance (1 -
 * g2)/(g2 * 2 K) * 2 |h|^2 where the number of averages K is known, else NULL. ROTID_OK, ROTID_ERROR_SYNTAX, _IO, _ARGUMENT
 * (nothing usable; the list says what is there and what was expected), _MEMORY. */
int measurement_read(struct pool *pool, const char *path, const struct measurement_options *options,
                     struct message_list *messages, struct measurement *out);

#endif
