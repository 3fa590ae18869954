#ifndef ROTID_BASE_BASE_H
#define ROTID_BASE_BASE_H

/* Base: services of one call and one job that every other room uses. No mechanics, no files, no static state.
 * In: the environment of the host (allocator, cancellation), requests for memory, sizes, texts. Out: memory, reasons, messages.
 *
 *   memory           pool.c      pool_open, pool_get, pool_close: blocks hang on a pool, one pool_close frees all of them
 *   public call      entry.c     entry_open, entry_close: traps masked, environment checked, scratch pool, text of the failure
 *   host             host.c      floating-point environment and locale of the calling thread, saved and restored
 *   host's structs   entry.c     sized_take: reads a struct that begins with `size`, fills new members with zeros
 *   reason           entry.c     failure_say, refuse: why a call failed; the text of a status
 *   messages         message.c   message_add: note, warning or error with file, line and column, kept until somebody prints it
 *   threads          parallel.c  parallel_for: tasks 0 ... count - 1; the status returned is independent of the number of threads
 *   random numbers   order.c     splitmix64; uniform in (0, 1), normal by random_normal; the state is the caller's
 *   order            order.c     sorting of doubles and ints, rank, median and largest of doubles
 *   progress         parallel.c  environment_cancelled, environment_progress: what a long call asks and tells its host
 *   text             text.c      comparison without case, edit distance, UTF-8, control characters
 *   other            parallel.c: the clock; version.c
 *
 * Callers: all rooms. A job belongs to one thread at a time; a pool is never shared between threads.
 * Base must not know what a rotor, a deck or a result is, and includes no header of another room but rotid.h. */

/* of the C library what most rooms need */
#include <complex.h>
#include <fenv.h>
#include <locale.h>
#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "rotid.h"

/* Wall-clock time for reports, and for when a run of a study has taken too long. Timings decide nothing else. */

double clock_seconds(void); /* since an arbitrary moment */

/* Complex numbers of C. glibc defines CMPLX for compilers that call themselves GCC 4.7 or later, which clang does not. */

#ifndef CMPLX
#define CMPLX(re, im) __builtin_complex((double)(re), (double)(im))
#endif

/* |z|^2 */
static inline double complex_square(double complex z)
{
    return creal(z) * creal(z) + cimag(z) * cimag(z);
}

/* --------------------------------------------------------------------------------------------------------------- failure */

/* Why a call failed, in words for its host. */

/* Writes the text into failure [ROTID_FAILURE_LENGTH] (NULL is allowed), cut off where it is too long, with a point in its
 * numbers whatever the locale of the host. Returns status. */
int failure_say(char *failure, int status, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* An argument out of its range: the text names it as rotid.h does, its value, and what was expected. */
#define refuse(failure, ...) ((void)failure_say((failure), ROTID_ERROR_ARGUMENT, __VA_ARGS__), ROTID_ERROR_ARGUMENT)

/* Puts the text in front of what is there already; nothing where nothing is. Returns status. */
int failure_say_of(char *failure, int status, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* Puts as much of the text as fits behind the first `length` characters; returns the length then, that of a full buffer once
 * something was cut off. Characters of UTF-8 stay whole. */
size_t failure_append(char *failure, size_t length, const char *text);

/* ------------------------------------------------------------------------------------------------------------------ pool */

/* Memory of one job: everything a job allocates hangs on its pool and goes with it, so a routine that fails
 * half-way has nothing to undo. Not shared between threads. */

struct pool {
    const rotid_allocator *allocator; /* NULL: malloc and free */
    void *last;                       /* newest block, each linked to the one before */
    int out_of_memory;                /* some room was not to be had: many requests need one check */
};

void pool_open(struct pool *pool, const rotid_allocator *allocator);
void pool_close(struct pool *pool);

/* A pool that is the first of its own blocks, for what outlives the call that makes it; NULL where memory is out. */
struct pool *pool_new(const rotid_allocator *allocator);
/* NULL is allowed. */
void pool_free(struct pool *pool);

/* The pool takes over the blocks of another one, which is empty then; both have the same allocator. */
void pool_absorb(struct pool *pool, struct pool *other);

/* count * size zeroed bytes aligned for any type; NULL when memory is out or the product overflows. Zero bytes give a
 * valid pointer. */
void *pool_get(struct pool *pool, size_t count, size_t size);
/* The same with whatever was there before: workspace, which is written before it is read. */
void *pool_room(struct pool *pool, size_t count, size_t size);

#define POOL_NEW(pool, type)          ((type *)pool_get((pool), 1, sizeof(type)))
#define POOL_ARRAY(pool, type, count) ((type *)pool_get((pool), (size_t)(count), sizeof(type)))
#define POOL_ROOM(pool, type, count)  ((type *)pool_room((pool), (size_t)(count), sizeof(type)))
/* The list gets room for count elements. Its length: 0 where memory is out, so that a loop that fills it is safe. */
#define POOL_LIST(pool, list, count) (((list) = pool_get((pool), (size_t)(count), sizeof *(list))) ? (int)(count) : 0)

/* Room for one more element in a growing array of *capacity elements of which count are used: doubles it (copying) when
 * full. Returns the array, or NULL when memory is out (the old one stays valid). */
void *pool_grow(struct pool *pool, void *array, size_t count, size_t *capacity, size_t size);

/* Puts a copy of *item behind the last one of a list [*count] that grows by this alone, from empty, and counts it. 0, or 1 where
 * memory is out. */
int pool_add(struct pool *pool, void **list, int *count, size_t size, const void *item);
#define POOL_ADD(pool, list, count, item) pool_add((pool), (void **)&(list), &(count), sizeof *(list), 1 ? (item) : (list))

/* A list of the `count` elements of `list` and `more` of zeros behind them; of NULL zeros alone. NULL where memory is out. */
void *pool_copy(struct pool *pool, const void *list, size_t count, size_t more, size_t size);
#define POOL_COPY(pool, list, count, more) pool_copy((pool), (list), (size_t)(count), (size_t)(more), sizeof *(list))

/* Values that are not known yet, NaN. NULL where memory is out. */
double *pool_unknown(struct pool *pool, size_t count);

char *pool_copy_text(struct pool *pool, const char *text);
char *pool_format(struct pool *pool, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* The same for what is shown, "" where memory is out, as the pool says. */
const char *pool_text(struct pool *pool, const char *format, ...) __attribute__((format(printf, 2, 3)));
const char *pool_text_of(struct pool *pool, const char *format, va_list values);

/* ----------------------------------------------------------------------------------------------------------------- entry */

/* What every public routine that returns a status does first and last. */

struct entry {
    fenv_t floating;               /* of the host */
    char *failure;                 /* [ROTID_FAILURE_LENGTH] or NULL */
    rotid_environment environment; /* of the host, of this library's size; zeros where there is none */
    struct pool scratch;           /* gone when the call returns */
};

/* Masks floating-point exceptions, takes the environment (NULL is allowed), opens the scratch on its allocator. ROTID_OK, or
 * ROTID_ERROR_ARGUMENT where the environment is none, its allocator incomplete. To be closed in any case. */
int entry_open(struct entry *entry, const rotid_environment *environment, char *failure);

/* Leaves in failure why the status is an error, the text of the status where nobody has said more, and nothing where it is none.
 * Traps, flags and rounding are the host's again. Returns status. */
int entry_close(struct entry *entry, int status);

/* ------------------------------------------------------------------------------------------------------------------ host */

/* What a call owes the thread of its host: no trap on a NaN that is compared, and no comma in the numbers it reads and writes. */

/* Between the two the calling thread computes with floating-point exceptions masked, whatever traps the host has enabled (legacy
 * Fortran runs with -ffpe-trap=invalid,zero,overflow); behind them traps, flags and rounding are the host's again. Pairs may be
 * nested. What is computed in between has to reach the caller through memory, in a function of its own: compilers know nothing of
 * traps, and move an operation on registers across either call. */
void host_enter_floating(fenv_t *floating);
void host_leave_floating(const fenv_t *floating);

/* The same about additions, products and roots alone, with neither BLAS nor libm between: where these are instructions of SSE,
 * the state of the x87, which takes as long as adding an element to a matrix, is left alone. */
struct host_arithmetic {
    fenv_t floating;
    unsigned sse;
};
void host_enter_arithmetic(struct host_arithmetic *arithmetic);
void host_leave_arithmetic(const struct host_arithmetic *arithmetic);

/* Such a function, where the public routine beside it does nothing else than enter, call it and leave. */
#define HOST_COMPUTES static __attribute__((noinline))

struct host_locale {
    locale_t before, own;
};

/* Between the two the thread's locale is "C": one with a decimal comma cuts 2.1e11 off behind the 2, and in a Turkish one "fit"
 * is no other spelling of "FIT". ROTID_OK, or ROTID_ERROR_MEMORY, where there is nothing to leave. */
int host_enter_locale(struct host_locale *locale);
void host_leave_locale(const struct host_locale *locale);

/* What the operating system calls an error number, in text [HOST_ERROR_TEXT]: the buffer of strerror may be that of another
 * thread. Returns text. */
#define HOST_ERROR_TEXT 128
const char *host_error_text(int number, char *text);

/* --------------------------------------------------------------------------------------------------------------- message */

/* What a job has to say about its input, kept until somebody prints it: each message names the place. */

enum severity { SEVERITY_NOTE = ROTID_NOTE, SEVERITY_WARNING = ROTID_WARNING, SEVERITY_ERROR = ROTID_ERROR };

/* Errors past this many are counted and not kept: a binary file makes one a byte. Nor are as many of the others, apart from them:
 * why a deck is refused has to be said behind any number of warnings. */
#define MESSAGE_LIMIT 200

struct message_list {
    struct pool *pool;
    rotid_message *item;
    size_t count, capacity;
    int errors; /* of any number, also those not kept */
};

void message_open(struct message_list *list, struct pool *pool);
void message_add(struct message_list *list, enum severity severity, const char *file, int line, int column, const char *format,
                 ...) __attribute__((format(printf, 6, 7)));
/* A warning without a place; an error, with which a routine ends: its status. */
#define message_warn(list, ...) message_add((list), SEVERITY_WARNING, NULL, 0, 0, __VA_ARGS__)
#define message_refuse(list, status, file, line, column, ...)                                                                    \
    (message_add((list), SEVERITY_ERROR, (file), (line), (column), __VA_ARGS__), (status))
/* The same at a place, a struct that has file, line and column. */
#define message_at(list, severity, place, ...)                                                                                   \
    message_add((list), (severity), (place).file, (place).line, (place).column, __VA_ARGS__)
#define message_refuse_at(list, status, place, ...) (message_at((list), SEVERITY_ERROR, (place), __VA_ARGS__), (status))
/* The texts of the warnings (pool) and how many there are; NULL where memory is out. */
const char **message_warnings(const struct message_list *list, struct pool *pool, int *count);
/* The errors with their places, "; " between them; "" of none. */
const char *message_errors(const struct message_list *list, struct pool *pool);

#define PI     3.14159265358979324
#define TWO_PI 6.28318530717958648
#define LN_2PI 1.8378770664093453

/* ----------------------------------------------------------------------------------------------------------------- order */

/* Numbers, and what has numbers, in order. */

/* Defines NAME, which qsort and bsearch compare elements of TYPE by: by the number FIRST of `it`, of equal ones by SECOND. */
#define ORDER_BY(NAME, TYPE, FIRST, SECOND)                                                                                      \
    static int NAME(const void *left, const void *right)                                                                         \
    {                                                                                                                            \
        const TYPE *it = left;                                                                                                   \
        double a = (double)(FIRST), behind_a = (double)(SECOND);                                                                 \
        it = right;                                                                                                              \
        double b = (double)(FIRST), behind_b = (double)(SECOND);                                                                 \
        return a != b ? (a > b) - (a < b) : (behind_a > behind_b) - (behind_a < behind_b);                                       \
    }

/* value [count], increasing; none is NaN. */
void sort_doubles(size_t count, double *value);

/* value [count], increasing; value may be NULL where count is 0. */
void sort_ints(size_t count, int *value);

/* value[rank] as it would be behind sort_doubles, rank < count; value is left in another order. */
double double_of_rank(size_t count, size_t rank, double *value);

/* Their median, behind which x is sorted; NaN of none. */
double median_of(size_t count, double *x);

/* The largest magnitude of those that are finite, 0 of none. */
double largest_magnitude(ptrdiff_t count, const double *x);

int all_finite(ptrdiff_t count, const double *x);

/* -------------------------------------------------------------------------------------------------------------- parallel */

/* Independent tasks on several threads. */

#define PARALLEL_MOST 256 /* threads */

/* Runs task(context, index, worker) for index = 0 ... count - 1, handed out in this order to whoever is free: at most `threads`
 * POSIX threads, the caller's among them, and no more than PARALLEL_MOST or tasks. `worker` in [0, threads) is never used by two
 * at a time, so that each can have its own workspace. All compute in the floating-point environment and the locale of the caller.
 * With threads <= 1 or count <= 1 everything runs in the caller's thread; also the rest where no further thread can be
 * had. A task returns 0, or else a status after which no task is started; those under way end. Returns 0, or the status, negative
 * or positive, of the lowest index that did not return 0: all below it have run, so it is the same for any number of threads. */
int parallel_for(int threads, int count, int (*task)(void *context, int index, int worker), void *context);

/* Whether the host wants a long call to end, and what it is told of one; environment may be NULL, and so may its members. */
int environment_cancelled(const rotid_environment *environment);
void environment_progress(const rotid_environment *environment, const char *stage, int step);

/* ---------------------------------------------------------------------------------------------------------------- random */

/* Reproducible random numbers without global state: splitmix64 (Steele, Lea, Flood, OOPSLA 2014). */

struct random_stream {
    uint64_t state;
};

double random_uniform(struct random_stream *stream); /* in (0, 1) */
double random_normal(struct random_stream *stream);  /* mean 0, variance 1 */

/* ----------------------------------------------------------------------------------------------------------------- sized */

/* Structs that a host fills and that may grow: their first member is the size that the host was compiled with. */

/* In the order of the table in entry.c. */
enum sized {
    SIZED_ENVIRONMENT,
    SIZED_DIAGNOSE_OPTIONS,
    SIZED_SUGGEST_OPTIONS,
    SIZED_SPEEDS_OPTIONS,
    SIZED_MODEL,
    SIZED_MEASURED,
    SIZED_STATE,
    SIZED_FIT_OPTIONS,
    SIZED_LM_OPTIONS,
    SIZED_CAUSE,
    SIZED_HOST_OPTIONS
};

/* *copy := the struct of this library with what the host has of it, zeros in what it was compiled without. `given` is not NULL.
 * ROTID_ERROR_ARGUMENT, with the reason in failure, where size is below that of the first version (0 above all: it was not set),
 * or where a byte that this library does not know of is not zero: the host asks for something that it would not get. */
int sized_take(enum sized which, const void *given, char *failure, void *copy);

/* The same for a struct [known] of whose first version hosts have `first` bytes; names for the reason. */
struct sized_struct {
    const char *type, *argument;
    size_t first, known;
};
int sized_copy(const struct sized_struct *structure, const void *given, char *failure, void *copy);

/* ------------------------------------------------------------------------------------------------------------------ text */

/* Letters and characters. */

/* Names in decks are compared without regard to case. */
int same_text(const char *a, const char *b);
/* Letter by letter; both may be NULL. */
int equal_texts(const char *a, const char *b);

/* Edits that make one word of the other without regard to case: a letter more, less, changed, or two neighbours exchanged.
 * TEXT_FAR where they are more than a third of its letters or more than 3, and of words beyond 31 letters. */
#define TEXT_FAR 99
int text_distance(const char *word, const char *other);
/* Of the names that begin the structs of a list, `stride` apart and ended by NULL, the one fewest edits away; NULL: all are far.
 */
const char *text_nearest(const char *word, const void *list, size_t stride);

/* Bytes of the UTF-8 character that begins here, 0 where there is none (RFC 3629). The text ends with a zero byte. */
size_t text_utf8(const char *text);

/* Whether a control character begins here, one of those that make a terminal do something or show other text than there is: C0
 * (tab and line feed among them), DEL, C1, controls of direction (Unicode Standard Annex 9), line and paragraph separators.
 * *code: its number, where it is one. */
int text_is_control(const char *text, unsigned *code);

/* Bytes of the character that begins here, 0 where that is a control character or no UTF-8: nothing to be shown as it is. */
size_t text_visible(const char *text);

/* A probability in percent with so many digits: "47.5 %", "below 0.01 %". NULL where memory is out. */
const char *text_of_probability(struct pool *pool, int digits, double probability);

/* In the place of a character that is not shown: U+FFFD, one column. */
#define TEXT_REPLACEMENT "\xef\xbf\xbd"

#endif
