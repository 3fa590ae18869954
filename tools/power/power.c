/* power: how often a diagnosis says what is true. See `power --help`. */
#include <getopt.h>
#include <math.h>
#include <signal.h>
#include <string.h>
#include <time.h>

#include "hide/hide_text.h"
#include "power.h"
#include "support.h"

static const char usage[] =
    "usage: power [options]\n"
    "Hides effects in random rotors, diagnoses their data, and counts what was said. A case is made by the seed and its number.\n"
    "  --cases N        (1000)\n"
    "  --first N        number of the first one (0)\n"
    "  --seed S         of the run (from the clock)\n"
    "  --jobs N         cases at once (2)\n"
    "  --only KIND      of `hide --random`: none, an id, physical, data, outside, pair; in place of the mixture\n"
    "  --changed        pairs of states with an error of the model in both: what changed between them\n"
    "  --prior[=stated] cases from the priors and the model of the diagnosis itself: are its probabilities true? =stated: the\n"
    "                   noise is as stated, which the priors allow to differ\n"
    "  --log FILE       a line of JSON a case; goes on with what the file holds\n"
    "  --keep FOLDER    leaves there the deck of a case and its truth: case_N.inp, case_N.json\n"
    "  --suggest        makes the tests that rotid suggest proposes of ambiguous cases, and counts what becomes of its promises\n"
    "Interrupted, it shows what is finished. Exit code: 0 all requirements hold, 1 one does not, 2 wrong usage, 3 a file or "
    "memory.\n";

enum { CASES = 256, FIRST, SEED, JOBS, ONLY, CHANGED, PRIOR, LOG, KEEP, SUGGEST, HELP };

static const struct option long_options[] = {
    {"cases", 1, NULL, CASES}, {"first", 1, NULL, FIRST},     {"seed", 1, NULL, SEED}, {"jobs", 1, NULL, JOBS},
    {"only", 1, NULL, ONLY},   {"changed", 0, NULL, CHANGED}, {"log", 1, NULL, LOG},   {"prior", 2, NULL, PRIOR},
    {"keep", 1, NULL, KEEP},   {"suggest", 0, NULL, SUGGEST}, {"help", 0, NULL, HELP}, {NULL, 0, NULL, 0}};

static volatile sig_atomic_t interrupted;

static void interrupt(int signal_number)
{
    (void)signal_number;
    interrupted = 1;
}

static int take_number(const char *text, int least, int *value)
{
    double d;
    if (!hide_read_number(text, &d) || d != floor(d) || d < least || d > 999999) {
        fprintf(stderr, "power: expected an integer from %d to 999999, not %s\n", least, text);
        return 1;
    }
    *value = (int)d;
    return 0;
}

static int take(int option, struct power_options *o)
{
    int seed, bad;
    switch (option) {
    case CASES:
        return take_number(optarg, 1, &o->cases);
    case FIRST:
        return take_number(optarg, 0, &o->first);
    case SEED:
        bad = take_number(optarg, 0, &seed);
        o->seed = bad ? 0 : (uint64_t)seed;
        return bad;
    case JOBS:
        return take_number(optarg, 1, &o->jobs);
    case ONLY:
        o->only = optarg;
        return 0;
    case CHANGED:
        o->changed = 1;
        return 0;
    case PRIOR:
        o->prior = 1 + (optarg != NULL);
        return optarg && strcmp(optarg, "stated") != 0;
    case LOG:
        o->log = optarg;
        return 0;
    case KEEP:
        o->keep = optarg;
        return 0;
    case SUGGEST:
        o->suggest = 1;
        return 0;
    default:
        return 1;
    }
}

int main(int argc, char **argv)
{
    struct power_options o = {.cases = 1000, .jobs = 2, .seed = (uint64_t)time(NULL) % 1000000};
    int option;
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
    signal(SIGINT, interrupt);
    signal(SIGTERM, interrupt);
    return o.prior     ? power_calibration(&o, &interrupted, stdout)
           : o.changed ? power_changed(&o, &interrupted, stdout)
           : o.suggest ? power_suggest(&o, &interrupted, stdout)
                       : power_run(&o, &interrupted, stdout);
}
