/* Independent tasks on several threads. */
#ifndef ROTID_BASE_PARALLEL_H
#define ROTID_BASE_PARALLEL_H

#define PARALLEL_MOST 256 /* threads */

/* Runs task(context, index, worker) for index = 0 ... count - 1, handed out in this order to whoever is free: at most `threads`
 * POSIX threads, the caller's among them, and no more than PARALLEL_MOST or tasks. `worker` in [0, threads) is never used by two
 * at a time, so that each can have its own workspace. All compute in the floating-point environment and the locale of the caller.
 * With threads <= 1 or count <= 1 everything runs in the caller's thread; also the rest where no further thread can be
 * had. A task returns 0, or else a status after which no task is started; those under way end. Returns 0, or the status, negative
 * or positive, of the lowest index that did not return 0: all below it have run, so it is the same for any number of threads. */
int parallel_for(int threads, int count, int (*task)(void *context, int index, int worker), void *context);

#endif
