/* power: how often a diagnosis says what is true. See `power --help`. */
#include <getopt.h>
#include <math.h>
#include <pthread.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/parallel.h"
#include "hide/hide_text.h"
#include "power.h"
#include "support.h"

static const char usage[] =
    "usage: power [options]\n"
    "  --cases N        (1000)\n"
    "  --first N        number of the first one (0): with --cases 1 a case again\n"
    "  --seed S         of the run (from the clock)\n"
    "  --decks          several rotors in turn, not input/paper_rotor.inp alone\n"
    "  --jobs N         cases at once (2)\n"
    "  --modes N        elastic modes (6)\n"
    "  --half-sensors   every second sensor\n"
    "  --no-shapes      frequencies alone\n"
    "  --only KIND      of `hide --random`: none, an id, physical, data, outside, pair\n"
    "  --log FILE       a line of JSON a case\n"
    "  --quick          60 cases with every second sensor\n"
    "Interrupted, it shows what is finished. Exit code: 0 all requirements hold, 1 one does not, 2 wrong usage, 3 a file.\n";

enum { CASES = 256, FIRST, SEED, DECKS, JOBS, MODES, HALF, NO_SHAPES, ONLY, LOG, QUICK, HELP };

static const struct option long_options[] = {
    {"cases", 1, NULL, CASES}, {"first", 1, NULL, FIRST}, {"seed", 1, NULL, SEED},         {"decks", 0, NULL, DECKS},
    {"jobs", 1, NULL, JOBS},   {"modes", 1, NULL, MODES}, {"half-sensors", 0, NULL, HALF}, {"no-shapes", 0, NULL, NO_SHAPES},
    {"only", 1, NULL, ONLY},   {"log", 1, NULL, LOG},     {"quick", 0, NULL, QUICK},       {"help", 0, NULL, HELP},
    {NULL, 0, NULL, 0}};

struct run {
    const struct power_options *options;
    int ndeck;
    const struct power_deck *deck;
    char directory[64];
    struct power_result *result; /* [cases] */
    pthread_mutex_t lock;        /* of the rest */
    FILE *log;
    int finished, wrong;
    double begin;
};

static volatile sig_atomic_t interrupted;

static void interrupt(int signal_number)
{
    (void)signal_number;
    interrupted = 1;
}

static int is_interrupted(void *context)
{
    (void)context;
    return interrupted;
}

static void write_line(void *context, const struct hidden_case *c, const struct diagnosis *d, const cJSON *truth,
                       const struct hidden_score *score)
{
    struct run *run = context;
    char *line = run->log ? power_line(c, d, truth, score) : NULL;
    if (!line)
        return;
    pthread_mutex_lock(&run->lock);
    fprintf(run->log, "%s\n", line);
    fflush(run->log);
    pthread_mutex_unlock(&run->lock);
    free(line);
}

static void show_progress(struct run *run, const struct hidden_score *score)
{
    pthread_mutex_lock(&run->lock);
    run->finished++;
    run->wrong += score->outcome == HIDDEN_WRONG;
    if (isatty(STDERR_FILENO)) {
        double each = (clock_seconds() - run->begin) / run->finished;
        fprintf(stderr, "\r%d of %d, %.2f s each, %.0f s to go, %d wrong names ", run->finished, run->options->cases, each,
                each * (run->options->cases - run->finished), run->wrong);
    }
    pthread_mutex_unlock(&run->lock);
}

static int run_case(void *context, int index, int worker)
{
    struct run *run = context;
    struct power_result *result = &run->result[index];
    const rotid_environment environment = {.size = sizeof environment, .cancelled = is_interrupted};
    struct hidden_case c = {.directory = run->directory};
    char effect[64];
    const char *list;
    (void)worker;
    if (interrupted)
        return ROTID_STOP_CANCELLED;
    power_draw(run->options, run->ndeck, run->deck, run->options->first + index, &c, effect, &list);
    int status = hidden_run(&c, &environment, write_line, run, &result->score);
    if (status)
        return status;
    if (result->score.outcome == HIDDEN_FAILED)
        write_line(run, &c, NULL, NULL, &result->score);
    result->done = 1;
    result->number = c.number;
    result->seed = c.request.seed;
    result->deck = c.request.name;
    show_progress(run, &result->score);
    return 0;
}

static int take_number(const char *text, int least, int *value)
{
    double d;
    if (!hide_read_number(text, &d) || d != floor(d) || d < least || d > 1e6) {
        fprintf(stderr, "power: expected an integer not below %d, not %s\n", least, text);
        return 1;
    }
    *value = (int)d;
    return 0;
}

static int take(int option, struct power_options *o)
{
    switch (option) {
    case CASES:
        return take_number(optarg, 1, &o->cases);
    case FIRST:
        return take_number(optarg, 0, &o->first);
    case SEED: {
        int seed;
        int bad = take_number(optarg, 0, &seed);
        o->seed = bad ? 0 : (uint64_t)seed;
        return bad;
    }
    case DECKS:
        return (o->decks = 1) - 1;
    case JOBS:
        return take_number(optarg, 1, &o->jobs);
    case MODES:
        return take_number(optarg, 1, &o->modes);
    case HALF:
        return (o->half_sensors = 1) - 1;
    case NO_SHAPES:
        return (o->no_shapes = 1) - 1;
    case ONLY:
        o->only = optarg;
        return 0;
    case LOG:
        o->log = optarg;
        return 0;
    case QUICK:
        o->cases = 60;
        return (o->half_sensors = 1) - 1;
    default:
        return 1;
    }
}

static int run_all(const struct power_options *options, int ndeck, const struct power_deck *deck)
{
    struct run run = {.options = options, .ndeck = ndeck, .deck = deck, .begin = clock_seconds()};
    const char *temporary = getenv("TMPDIR");
    snprintf(run.directory, sizeof run.directory, "%s/power.XXXXXX", temporary && strlen(temporary) < 40 ? temporary : "/tmp");
    run.result = calloc((size_t)options->cases, sizeof *run.result);
    run.log = options->log ? fopen(options->log, "wb") : NULL;
    if (!run.result || (options->log && !run.log) || !mkdtemp(run.directory)) {
        fprintf(stderr, "power: no memory, or %s cannot be written\n", options->log ? options->log : "a temporary directory");
        free(run.result);
        return 3;
    }
    pthread_mutex_init(&run.lock, NULL);
    signal(SIGINT, interrupt);
    signal(SIGTERM, interrupt);
    printf("power --seed %llu\n", (unsigned long long)options->seed);
    fflush(stdout);
    int status = parallel_for(options->jobs, options->cases, run_case, &run);
    if (isatty(STDERR_FILENO))
        fprintf(stderr, "\r%79s\r", "");
    printf("%d cases in %.0f s%s\n", run.finished, clock_seconds() - run.begin, status ? ", interrupted" : "");
    rmdir(run.directory);
    if (run.log)
        fclose(run.log);
    int bad = power_report(stdout, options->cases, run.result);
    free(run.result);
    return bad;
}

int main(int argc, char **argv)
{
    struct power_options o = {.cases = 1000, .jobs = 2, .modes = 6, .seed = (uint64_t)time(NULL) % 1000000};
    struct power_deck deck[] = {
        {"input/paper_rotor.inp", NULL, 0}, {"input/solid_rotor.inp", NULL, 40}, {"input/paper_rotor.inp", NULL, 30}};
    int ndeck = 1, option, status = 0;
    while ((option = getopt_long(argc, argv, "", long_options, NULL)) != -1) {
        if (option == HELP) {
            fputs(usage, stdout);
            return 0;
        }
        if (take(option, &o)) {
            fputs(usage, stderr);
            return 2;
        }
    }
    if (optind != argc) {
        fputs(usage, stderr);
        return 2;
    }
    set_blas_threads(1);
    if (o.decks)
        ndeck = (int)(sizeof deck / sizeof *deck);
    for (int i = 0; i < ndeck && !status; i++)
        if (!(deck[i].text = hidden_read(deck[i].path))) {
            fprintf(stderr, "power: %s cannot be read; start it where input/ is\n", deck[i].path);
            status = 3;
        }
    if (!status)
        status = run_all(&o, ndeck, deck);
    for (int i = 0; i < ndeck; i++)
        free(deck[i].text);
    return status;
}
