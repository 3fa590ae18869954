#include "cli/cli.h"

#define DECKS       "check modes sensitivity identify diagnose suggest speeds frf export"
#define UNIVERSAL   "unv|uff|uf"
#define AT(MEMBER)  .offset = offsetof(struct command, MEMBER)
#define FROM(A, B)  .least = (A), .most = (B)
#define OUTPUT(...) .name = "output", .letter = 'o', .kind = OPTION_WRITES, AT(output), __VA_ARGS__

static const char *const estimators[] = {"H1", "H2", "HV", NULL}, *const types[] = {"stated", "bending", "torsion", "axial",
                                                                                    NULL};

/* clang-format off */
const struct option_row option_table[] = {
    {.name = "quiet", .kind = OPTION_SWITCH, AT(quiet),
     .help = "no tables, no warnings and no progress; errors are always printed"},
    {.name = "verbose", .commands = DECKS " ema uff test", .kind = OPTION_SWITCH, AT(verbose),
     .help = "more in the tables: shapes (modes), iterations (identify), every pole and channel (ema), every set (uff)",
     .more = "What was skipped in universal files is listed as well."},
    {.name = "threads", .commands = DECKS " ema study test", .kind = OPTION_WHOLE, AT(threads), FROM(1, THREADS_MOST), .value = "N",
     .help = "threads of diagnose, suggest and ema, processes of study (default: the processors); else of the BLAS (default: 1)",
     .more = "The result does not depend on it."},
    {.name = "seed", .commands = "sensitivity suggest speeds study", .kind = OPTION_SEED, AT(seed), FROM(0, 4294967295.0),
     .standard = 1, .value = "N",
     .help = "of the random numbers", .more = "Without it a study takes that of its plan. It stands in every result."},
    {.name = "version", .letter = 'V', .kind = OPTION_VERSION, .help = "version, commit and BLAS, and whether NLopt is missing"},
    {.name = "help", .letter = 'h', .kind = OPTION_HELP, .help = "the commands; behind a command: its options and examples"},

    {.name = "json", .commands = DECKS " ema uff study", .kind = OPTION_WRITES, AT(json), .value = "FILE", .files = "json",
     .help = "the result as JSON; - for standard output, which then carries nothing else"},
    {.name = "set", .commands = DECKS " study test", .kind = OPTION_OVERRIDE, .value = "CARD.OPTION=VALUE",
     .help = "another option on every such card of the deck, e.g. FIT.REDUCTION=NONE; may be repeated"},

    {.name = "csv", .commands = "modes identify uff study", .kind = OPTION_WRITES, AT(csv), .value = "NAME",
     .help = "tables for a spreadsheet, NAME.modes.csv and NAME.shapes.csv (identify: NAME.parameters.csv; study: also .cells.csv, .runs.csv)",
     .more = "FILE of *MODES, *SENSORS and *SHAPE reads them. Of a universal file they hold its modes as real shapes, in the "
             "direction in which they move most."},

    {.name = "compare", .commands = "modes", .kind = OPTION_SWITCH, AT(compare),
     .help = "the rotor as a beam and as a solid, and the moduli that a beam would find",
     .more = "At the values of the deck, whichever of the two MODEL on *FIT asks for."},

    {.name = "type", .commands = "modes", .kind = OPTION_WORD, AT(mode_type), .words = types,
     .help = "of the modes, of which *MODES states one by TYPE= (default: stated)",
     .more = "With MODEL=BEAM torsion and axial motion are those of bars; disks have their polar inertia and mass."},

    {.name = "at", .commands = "sensitivity", .kind = OPTION_TEXT, AT(at), .value = "NAME[=VALUE],...",
     .help = "these parameters instead of those of *IDENTIFY, at these values (in units of the deck) or those of the deck"},
    {.name = "step", .commands = "sensitivity", .kind = OPTION_REAL, AT(step), FROM(1e-9, 0.5), .standard = 0.01, .value = "S",
     .help = "relative step of the differences"},
    {.name = "range", .commands = "sensitivity", .kind = OPTION_REAL, AT(range), FROM(1e-6, 0.95), .standard = 0.5, .value = "R",
     .help = "relative range of the curves"},
    {.name = "points", .commands = "sensitivity", .kind = OPTION_WHOLE, AT(points), FROM(1, 1000), .standard = 11, .value = "N",
     .help = "points of a curve"},

    {.name = "no-baseline", .commands = "identify", .kind = OPTION_SWITCH, AT(no_baseline), .help = "without NLopt",
     .more = "A build without NLopt (make WITH_NLOPT=0) has no such baseline and says so in the table, in JSON and "
             "by --version."},

    {.name = "extended", .commands = "diagnose", .kind = OPTION_WRITES, AT(extended), .value = "FILE", .files = "inp",
     .help = "a deck with what was found, as cards, and with the fitted values as starts"},
    {.name = "changed", .commands = "diagnose", .kind = OPTION_TEXT, AT(changed), .value = "BEFORE,AFTER",
     .help = "what changed between two states; model errors common to both are not named"},
    {.name = "extended", .commands = "suggest", .kind = OPTION_WRITES, AT(extended), .value = "FILE", .files = "inp",
     .help = "the deck with the first of the tests as a *STATE more, ready for its measurements"},
    {.name = "for", .commands = "suggest", .kind = OPTION_TEXT, AT(suggest.aim), .value = "speed:N",
     .help = "which tests at rest narrow critical speed N of the machine most",
     .more = "N counts those with forward or mixed whirl, backward:N those with backward whirl. In place of sensors and rivals."},
    {.name = "interval", .commands = "suggest", .kind = OPTION_REAL, AT(suggest.interval), FROM(1e-3, 100), .standard = 2,
     .value = "PERCENT", .help = "wanted of every parameter: half of its 95 % interval over its value"},
    {.name = "sensors", .commands = "suggest", .kind = OPTION_WHOLE, AT(suggest.sensors), FROM(1, 1000), .value = "N",
     .help = "of a plan (default: those of the deck, else 8)"},
    {.name = "modes", .commands = "suggest", .kind = OPTION_WHOLE, AT(suggest.modes), FROM(2, 100), .value = "N",
     .help = "of a plan (default: those measured, else 5)"},
    {.name = "frequency-noise", .commands = "suggest", .kind = OPTION_REAL, AT(suggest.frequency_noise), FROM(1e-6, 100),
     .value = "PERCENT", .help = "of the frequencies of tests to come (default: that of the deck, else 0.3)"},
    {.name = "shape-noise", .commands = "suggest", .kind = OPTION_REAL, AT(suggest.shape_noise), FROM(1e-4, 100),
     .value = "PERCENT", .help = "of their shapes, of the largest component (default: that of the deck, else 2)"},
    {.name = "set-up-cost", .commands = "suggest", .kind = OPTION_REAL, AT(suggest.set_up_cost), FROM(1e-3, 1e6), .standard = 20,
     .value = "POINTS", .help = "of hanging, mounting or moving something, where measuring a point costs 1"},

    {.name = "speeds", .commands = "speeds", .kind = OPTION_TEXT, AT(speeds.range), .value = "FROM:TO[:N]",
     .help = "of the Campbell diagram [rpm], or a list such as 0,25000,30000 (default: 0 to 1.3 times the running range in 41 steps)",
     .more = "Without a running range it ends beyond the third critical speed."},
    {.name = "harmonic", .commands = "speeds", .kind = OPTION_REAL, AT(speeds.harmonic), FROM(0.01, 100), .standard = 1,
     .value = "H", .help = "critical speeds by an excitation of H per revolution"},
    {.name = "draws", .commands = "speeds", .kind = OPTION_WHOLE, AT(speeds.draws), FROM(1, 1000000), .standard = 2000,
     .value = "N", .help = "of the bands, each with its critical speeds solved again"},
    {.name = "campbell", .commands = "speeds", .kind = OPTION_WRITES, AT(speeds.campbell), .value = "FILE", .files = "csv",
     .help = "the Campbell diagram as a table"},
    {.name = "response", .commands = "speeds", .kind = OPTION_WRITES, AT(speeds.response), .value = "FILE", .files = "csv",
     .help = "the unbalance response at the probes as a table"},

    {OUTPUT(.commands = "frf", .value = "FILE", .files = UNIVERSAL, .help = "the synthesised functions as a universal file")},

    {OUTPUT(.commands = "ema", .value = "FILE", .files = UNIVERSAL, .help = "the modes as a universal file, for *MEASURED")},
    {.name = "band", .commands = "ema test", .kind = OPTION_BAND, AT(ema.options), FROM(0, 1e7), .value = "LOW,HIGH",
     .help = "in hertz (default: all lines)"},
    {.name = "method", .commands = "ema", .kind = OPTION_WORD, AT(ema.options.method), .words = ema_method_words,
     .help = "how poles are found: least-squares complex frequency (default) or quadrature"},
    {.name = "order", .commands = "ema", .kind = OPTION_WHOLE, AT(ema.options.order), FROM(2, 400), .value = "N",
     .help = "highest order of the denominator (default: from the band)"},
    {.name = "pick", .commands = "ema", .kind = OPTION_PICK, AT(ema.options), FROM(0, 1e7), .value = "F1,F2,...",
     .help = "the modes nearest to these frequencies [Hz] instead of the stable ones"},
    {.name = "per-point", .commands = "ema", .kind = OPTION_SWITCH, AT(ema.options.per_point),
     .help = "also a frequency for each point, which shows the mass of a roving accelerometer"},
    {.name = "no-refinement", .commands = "ema", .kind = OPTION_SWITCH, AT(ema.options.no_refinement),
     .help = "poles as the least-squares complex frequency method leaves them"},
    {.name = "reference", .commands = "ema test", .kind = OPTION_WHOLE, AT(ema.measurement.reference), FROM(1, 2147483647),
     .value = "NODE", .help = "only transfer functions over this node"},
    {.name = "averages", .commands = "ema test", .kind = OPTION_WHOLE, AT(ema.measurement.averages), FROM(2, 1000000), .value = "K",
     .help = "impacts behind the coherences of the file", .more = "They give the variance of its lines."},
    {.name = "estimator", .commands = "ema", .kind = OPTION_WORD, AT(ema.measurement.transfer.estimator), .words = estimators,
     .help = "time records: noise is on the response (default), on the force, or on both"},
    {.name = "exponential", .commands = "ema", .kind = OPTION_REAL, AT(ema.measurement.transfer.exponential), FROM(1e-12, 0.999),
     .value = "P", .help = "rotid applies an exponential window of this end value, takes its damping out; not for records that hold one",
     .more = "Such as 0.01 (default: none), of time records. The damping of a window that an analyser applied stays in."},
    {.name = "force-window", .commands = "ema", .kind = OPTION_REAL, AT(ema.measurement.transfer.force_window), FROM(-1, 1e6),
     .value = "S", .help = "time records: length of the force window [s]; below zero: none"},
    {.name = "block", .commands = "ema", .kind = OPTION_REAL, AT(ema.measurement.transfer.block), FROM(1e-6, 1e6), .value = "S",
     .help = "time records: length of a block [s]"},
    {.name = "pretrigger", .commands = "ema", .kind = OPTION_REAL, AT(ema.measurement.transfer.pretrigger), FROM(1e-9, 1e6),
     .value = "S", .help = "time records: part of a block before the impact [s]"},
    {.name = "trigger-level", .alias = "threshold", .commands = "ema", .kind = OPTION_REAL,
     AT(ema.measurement.transfer.threshold), FROM(1e-6, 0.999), .value = "R",
     .help = "time records: share of the largest force from which on a pulse is an impact (default: 0.1)"},
    {.name = "keep-double-hits", .commands = "ema", .kind = OPTION_SWITCH, AT(ema.measurement.transfer.double_hits),
     .help = "time records: uses double hits too"},

    {.name = "state", .commands = "frf export", .kind = OPTION_TEXT, AT(state), .value = "NAME",
     .help = "that state of a deck with several, at values identified over all of them",
     .more = "With --set FIT.STATE=NAME its own modes alone are fitted. A file, but for JSON, holds one state."},

    {OUTPUT(.commands = "export", .value = "FILE", .files = "mtx|dmig|bdf",
            .help = "the model; of matrix-market the beginning of the names")},
    {.name = "format", .commands = "export", .kind = OPTION_WORD, AT(format), .words = export_format_words,
     .help = "for SciPy and others, for Nastran"},
    {.name = "start", .commands = "export", .kind = OPTION_SWITCH, AT(start),
     .help = "the model as the deck states it, not at identified parameters"},
    {.name = "condensed", .commands = "export", .kind = OPTION_SWITCH, AT(condensed),
     .help = "dmig: the model condensed onto the sensors"},

    {OUTPUT(.commands = "report", .value = "FILE", .files = "html",
            .help = "the page; a name that does not end in .html is a folder for index.html",
            .more = "A page of rotid is replaced, another file is left alone. A folder that is missing is made.")},

    {OUTPUT(.commands = "test", .value = "FILE", .files = "html",
            .help = "the page; modes and results of the steps are written next to it; the name of the deck with .html without this option")},
    {OUTPUT(.commands = "study", .value = "FILE", .files = "jsonl",
            .help = "the results, a line of JSON a run; where the file exists, what is missing in it is computed")},
    {.name = "shard", .commands = "study", .kind = OPTION_SHARD, AT(study), .value = "I/N",
     .help = "each N-th run from the I-th on, for an array of jobs"},
    {.name = "timeout", .commands = "study", .kind = OPTION_REAL, AT(study.timeout), FROM(0.001, 1e9), .value = "SECONDS",
     .help = "a run that takes longer has failed"},
    {.name = "retry-failed", .commands = "study", .kind = OPTION_SWITCH, AT(study.retry_failed),
     .help = "runs that have failed once again"},
    {.name = "merge", .commands = "study", .kind = OPTION_SWITCH, AT(study.merge),
     .help = "files of shards into the one of --output"},
    {.name = "summary", .commands = "study", .kind = OPTION_SWITCH, AT(study.summary),
     .help = "the table of a file of results, finished or not"},
    {.name = NULL}};
/* clang-format on */

int option_of(const struct option_row *row, const char *command)
{
    size_t length = strlen(command);
    const char *at = row->commands;
    for (; at && (at = strstr(at, command)); at += length)
        if ((at == row->commands || at[-1] == ' ') && (!at[length] || at[length] == ' '))
            return 1;
    return !row->commands;
}

const struct option_row *option_find(const char *name, const char *command)
{
    for (const struct option_row *row = option_table; row->name; row++)
        if (!strcmp(row->name, name) && option_of(row, command))
            return row;
    return NULL;
}
