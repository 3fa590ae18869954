#include "diagnose/diagnose.h"

#include <math.h>
#include <string.h>

#include "base/base.h"
#include "fit/fit.h"
#include "linalg/linalg.h"

#define BLOCK 50 /* replicates a task: what is multiplied together must not depend on the number of threads */

struct job_of_blocks {
    const struct scan *scan;
    const rotid_environment *environment;
    unsigned long seed;
    int replicates;
    double *largest, *frequency, *total; /* [replicates] */
    double **work;                       /* [threads] */
};

static int block(void *context, int index, int worker)
{
    struct job_of_blocks *job = context;
    const struct scan *scan = job->scan;
    int n = scan->nrow, first = index * BLOCK, count = job->replicates - first < BLOCK ? job->replicates - first : BLOCK;
    double *noise = job->work[worker], *product = noise + (ptrdiff_t)n * BLOCK;
    if (job->environment && job->environment->cancelled && job->environment->cancelled(job->environment->context))
        return ROTID_STOP_CANCELLED;
    for (int c = 0; c < count; c++) {
        struct random_stream stream = {(uint64_t)job->seed * 0x9e3779b97f4a7c15u + (uint64_t)(first + c) * 0xd1b54a32d192ed03u};
        for (int i = 0; i < n; i++)
            noise[i + (ptrdiff_t)c * n] = random_normal(&stream);
    }
    if (scan->nbasis) {
        product_transposed(scan->nbasis, count, n, scan->basis, noise, product);
        product_subtract(n, count, scan->nbasis, scan->basis, product, noise);
    }
    if (scan->nitem)
        product_transposed(scan->nitem, count, n, scan->column, noise, product);
    for (int c = 0; c < count; c++) {
        const double *r = noise + (ptrdiff_t)c * n, *along = product + (ptrdiff_t)c * scan->nitem;
        double largest = 0, frequency = 0, total = 0;
        for (int i = 0; i < scan->nitem; i++) /* a minus: the amplitude that lowers chi2 has the sign of -c'r */
            if (-along[i] * scan->item[i].side >= 0)
                largest = fmax(largest, along[i] * along[i]);
        for (int i = 0; i < n; i++) {
            total += r[i] * r[i];
            frequency += scan->is_frequency[i] ? r[i] * r[i] : 0;
        }
        job->largest[first + c] = largest;
        job->frequency[first + c] = frequency;
        job->total[first + c] = total;
    }
    return ROTID_OK;
}

/* share of the replicates that are at least as large, never quite zero */
static double tail(int count, const double *sorted, double value)
{
    int low = 0, high = count;
    while (low < high) {
        int middle = (low + high) / 2;
        if (sorted[middle] < value)
            low = middle + 1;
        else
            high = middle;
    }
    return (count - low + 1.0) / (count + 1.0);
}

/* The three tests share what they alarm on, so the threshold of the scan is that above which, of the replicates that the two
 * others let pass, just so many lie that all three together make FAMILY_WISE. */
static double choose_threshold(struct pool *pool, const struct job_of_blocks *job, int dof, const double *frequency, int *status)
{
    int n = job->replicates, left = 0;
    double *passed = POOL_ARRAY(pool, double, n), limit = frequency[(int)ceil((1 - BLOCK_LEVEL) * n) - 1];
    *status = passed ? ROTID_OK : ROTID_ERROR_MEMORY;
    for (int i = 0; i < n && passed; i++)
        if (job->frequency[i] <= limit && chi_square_tail(job->total[i], dof) > BLOCK_LEVEL)
            passed[left++] = job->largest[i];
    if (!passed || !left)
        return INFINITY;
    sort_doubles((size_t)left, passed);
    int alarms = (int)(FAMILY_WISE * n) - (n - left), least = n / 200; /* half a per cent for the scan in any case */
    alarms = alarms > least ? alarms : least;
    return passed[left - 1 - (alarms < left ? alarms : left - 1)];
}

int bootstrap_run(struct pool *pool, const struct scan *scan, int replicates, unsigned long seed, int threads,
                  const rotid_environment *environment, struct bootstrap *b)
{
    int n = scan->nrow, columns = scan->nitem > scan->nbasis ? scan->nitem : scan->nbasis, status;
    struct job_of_blocks job = {.scan = scan, .environment = environment, .seed = seed, .replicates = replicates};
    job.largest = POOL_ARRAY(pool, double, replicates);
    job.frequency = POOL_ARRAY(pool, double, replicates);
    job.total = POOL_ARRAY(pool, double, replicates);
    job.work = POOL_ARRAY(pool, double *, threads);
    *b = (struct bootstrap){.replicates = replicates};
    b->largest = POOL_ARRAY(pool, double, replicates);
    b->frequency = POOL_ARRAY(pool, double, replicates);
    if (!job.largest || !job.frequency || !job.total || !job.work || !b->largest || !b->frequency)
        return ROTID_ERROR_MEMORY;
    for (int t = 0; t < threads; t++)
        if (!(job.work[t] = POOL_ARRAY(pool, double, (size_t)BLOCK *(size_t)(n + columns + 1))))
            return ROTID_ERROR_MEMORY;
    status = parallel_for(threads, (replicates + BLOCK - 1) / BLOCK, block, &job);
    if (status)
        return status;
    memcpy(b->largest, job.largest, (size_t)replicates * sizeof(double));
    memcpy(b->frequency, job.frequency, (size_t)replicates * sizeof(double));
    sort_doubles((size_t)replicates, b->largest);
    sort_doubles((size_t)replicates, b->frequency);
    int dof = scan->dof > 0 ? scan->dof : 1;
    b->threshold = choose_threshold(pool, &job, dof, b->frequency, &status);
    b->p_scan = bootstrap_p(b, scan->largest);
    b->p_frequency = tail(replicates, b->frequency, scan->chi2_frequency);
    b->p_total = scan->dof > 0 ? chi_square_tail(scan->chi2, dof) : 1;
    return status;
}

double bootstrap_p(const struct bootstrap *b, double drop)
{
    return tail(b->replicates, b->largest, drop);
}

#define SEEN 0.9 /* quantile that few replicates show */

double bootstrap_extrapolated(const struct bootstrap *b)
{
    double seen = b->largest[(int)ceil(SEEN * b->replicates) - 1];
    double looks = log(SEEN) / log1p(-chi_square_tail(seen, 1));
    double passed = (1 - FAMILY_WISE) / ((1 - BLOCK_LEVEL) * (1 - BLOCK_LEVEL)); /* of one look: to this power */
    return seen > 0 ? chi_square_limit(-expm1(log(passed) / looks), 1) : 0;
}
