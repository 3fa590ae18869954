/* Which part of which record belongs to which impact. All blocks have the same length, so that all lines are the same. */
#ifndef ROTID_SIGNAL_BLOCK_H
#define ROTID_SIGNAL_BLOCK_H

#include "signal/transfer.h"

#define BLOCK_LARGEST 1e50 /* of a sample in SI units: beyond it the squares of spectra overflow */

struct block_plan {
    int n;                 /* samples of a block, of fft_length */
    int *first;            /* [nrecord + 1] into impact */
    int *begin;            /* [first[nrecord]] samples of each block before the onset, >= 1 unless the impact is cut */
    struct impact *impact; /* record by record, with everything but `tail` */
};

/* Finds the impacts of nrecord >= 1 records, tells second hits from the next impacts, chooses the length of the blocks and which
 * impacts are used; see struct transfer_options, whose ranges have been checked. Statuses and *bad_record as transfer_compute. */
int block_plan(struct pool *pool, int nrecord, const struct time_record *record, double rate,
               const struct transfer_options *options, struct block_plan *plan, int *bad_record);

/* Samples at the beginning of a block over which its means are taken: before the onset by the width of the pulse, which may rise
 * for that long, but at least the first half of what there is before the onset. >= 1. */
int block_quiet(int begin, const struct impact *impact, double rate);

#endif
