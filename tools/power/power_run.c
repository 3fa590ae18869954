/* The cases, several at once. */
#include <errno.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/base.h"
#include "power.h"

struct run {
    const struct power_options *options;
    const volatile sig_atomic_t *interrupted;
    char directory[500];
    struct power_result *result; /* [cases] */
    pthread_mutex_t lock;        /* of the rest */
    FILE *log;
    int finished, found, wrong; /* found: those of the log */
    double begin;
};

struct writing {
    struct run *run;
    const struct power_case *c;
};

int power_interrupted(void *context)
{
    return *(const volatile sig_atomic_t *)context;
}

static void write_line(void *context, const struct hidden_case *hidden, const struct diagnosis *d, const cJSON *truth,
                       const struct hidden_score *score)
{
    const struct writing *w = context;
    char *line = w->run->log ? power_line(w->c, d, truth, score) : NULL;
    (void)hidden;
    if (!line)
        return;
    pthread_mutex_lock(&w->run->lock);
    fprintf(w->run->log, "%s\n", line);
    fflush(w->run->log);
    pthread_mutex_unlock(&w->run->lock);
    free(line);
}

static void show_progress(struct run *run, const struct hidden_score *score)
{
    pthread_mutex_lock(&run->lock);
    run->finished++;
    run->wrong += score->outcome == HIDDEN_WRONG;
    if (isatty(STDERR_FILENO)) {
        double each = (clock_seconds() - run->begin) / run->finished;
        fprintf(stderr, "\r%d of %d, %.2f s each, %.0f s to go, %d wrong names ", run->found + run->finished, run->options->cases,
                each, each * (run->options->cases - run->found - run->finished), run->wrong);
    }
    pthread_mutex_unlock(&run->lock);
}

static int run_case(void *context, int index, int worker)
{
    struct run *run = context;
    struct power_result *result = &run->result[index];
    const rotid_environment environment = {
        .size = sizeof environment, .cancelled = power_interrupted, .context = (void *)run->interrupted};
    struct power_case c;
    struct writing writing = {run, &c};
    (void)worker;
    if (result->done)
        return ROTID_OK;
    if (*run->interrupted)
        return ROTID_STOP_CANCELLED;
    if (power_draw(run->options, run->options->first + index, &c))
        return ROTID_ERROR_MEMORY;
    c.hidden.directory = run->directory;
    c.hidden.keep = run->options->keep != NULL;
    int status = hidden_run(&c.hidden, &environment, write_line, &writing, &result->score);
    free(c.deck);
    if (status)
        return status;
    if (result->score.outcome == HIDDEN_FAILED)
        write_line(&writing, &c.hidden, NULL, NULL, &result->score);
    result->done = 1;
    memcpy(result->again, c.again, sizeof c.again);
    show_progress(run, &result->score);
    return ROTID_OK;
}

/* A folder for the decks: that of `keep`, or one that goes again. */
static int open_directory(struct run *run)
{
    const char *temporary = getenv("TMPDIR"), *keep = run->options->keep;
    int length = keep ? snprintf(run->directory, sizeof run->directory, "%s", keep)
                      : snprintf(run->directory, sizeof run->directory, "%s/power.XXXXXX", temporary ? temporary : "/tmp");
    if (length < (int)sizeof run->directory && (keep ? !access(keep, W_OK) : mkdtemp(run->directory) != NULL))
        return 0;
    fprintf(stderr, "power: %s: %s\n", run->directory, strerror(errno));
    return 3;
}

int power_run(const struct power_options *options, const volatile sig_atomic_t *interrupted, FILE *out)
{
    struct run run = {.options = options, .interrupted = interrupted, .begin = clock_seconds()};
    run.result = calloc((size_t)options->cases, sizeof *run.result);
    if (!run.result || (options->log && !(run.log = power_log(options, run.result))) || open_directory(&run)) {
        if (run.log)
            fclose(run.log);
        free(run.result);
        return 3;
    }
    for (int i = 0; i < options->cases; i++)
        run.found += run.result[i].done;
    pthread_mutex_init(&run.lock, NULL);
    fprintf(out, "power --seed %llu\n", (unsigned long long)options->seed);
    fflush(out);
    int status = parallel_for(options->jobs, options->cases, run_case, &run);
    if (isatty(STDERR_FILENO))
        fprintf(stderr, "\r%79s\r", "");
    fprintf(out, "%d cases in %.0f s, %d of the log%s\n", run.finished, clock_seconds() - run.begin, run.found,
            !status        ? ""
            : *interrupted ? ", interrupted"
                           : ", ended without memory");
    if (!options->keep)
        rmdir(run.directory);
    if (run.log)
        fclose(run.log);
    int bad = power_report(out, options->cases, run.result);
    pthread_mutex_destroy(&run.lock);
    free(run.result);
    return status && !*interrupted ? 3 : bad;
}
