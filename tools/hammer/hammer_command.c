#include "hammer_command.h"

#include <errno.h>
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hide/hide_text.h"

const char hammer_usage[] =
    "usage: hammer ROTOR -o RECORDS.unv [--truth TRUTH.json] [--deck DECK.inp] [options]\n"
    "ROTOR is paper (998 kg, 68 points), beam (6 kg, 21 points) or a deck with *SENSORS.\n"
    "  --modes-file FILE       what the deck measures (modes.unv): the file that rotid ema will make\n"
    "  --state NAME            of a deck with *STATE: that state is tested, and --deck names its modes file for it\n"
    "  --true NAME=VALUE       true value of a parameter of *IDENTIFY; may be repeated. Of a deck, others are drawn\n"
    "  --seed N                of everything that is drawn (1)\n"
    "  --rate HZ               sampling rate (8192); modes reach up to 1.2 times of it\n"
    "  --band HZ               end of the band, in the truth (3200, at most 0.4 of the rate)\n"
    "  --seconds T             length of a record (a power of two of samples, until the response has decayed to 1e-4)\n"
    "  --pretrigger T          s before the impact (0.01)\n"
    "  --impacts N             a point (3)\n"
    "  --roving sensor|hammer  what goes from point to point (sensor)\n"
    "  --fixed ID              where the other one stays (the first point)\n"
    "  --sensor-mass KG        of the accelerometer, wherever it is (0)\n"
    "  --pulse SHORT:LONG      s, duration of the half-sine (2e-4:4e-4)\n"
    "  --force N[:SPREAD]      its peak and how far it varies (1000:0.2)\n"
    "  --damping Z,Z,...       ratios of the elastic modes, the last one for all above\n"
    "  --suspension-damping Z  (0.05)\n"
    "  --noise X               of the response, relative to its rms over the record (0)\n"
    "  --force-noise X         of the force, relative to its peak (0)\n"
    "  --floor X               of the converter, both channels, relative to the largest value of the record (0)\n"
    "  --double-hits P         probability of a second pulse (0)\n"
    "  --clipped P             probability that the force is cut at 0.6 of its peak or lower (0)\n"
    "  --drift X               standard deviation of the frequencies from point to point, relative (0)\n"
    "  --fault FAULT           dead:ID, duplicate:ID=OTHER, flip:ID, gain:ID=FACTOR, loose:ID=HZ; may be repeated\n"
    "  --ascii                 sets 58 as text in place of binary ones\n"
    "  --help\n"
    "Exit code: 0 done, 2 wrong usage or input, 3 a file or memory.\n";

enum {
    TRUTH = 256,
    DECK,
    MODES_FILE,
    STATE,
    TRUE,
    SEED,
    RATE,
    BAND,
    SECONDS,
    PRETRIGGER,
    IMPACTS,
    ROVING,
    FIXED,
    SENSOR_MASS,
    PULSE,
    FORCE,
    DAMPING,
    SUSPENSION,
    NOISE,
    FORCE_NOISE,
    FLOOR,
    DOUBLE_HITS,
    CLIPPED,
    DRIFT,
    FAULT,
    ASCII,
    HELP
};

static const struct option long_options[] = {{"truth", 1, NULL, TRUTH},
                                             {"deck", 1, NULL, DECK},
                                             {"modes-file", 1, NULL, MODES_FILE},
                                             {"state", 1, NULL, STATE},
                                             {"true", 1, NULL, TRUE},
                                             {"seed", 1, NULL, SEED},
                                             {"rate", 1, NULL, RATE},
                                             {"band", 1, NULL, BAND},
                                             {"seconds", 1, NULL, SECONDS},
                                             {"pretrigger", 1, NULL, PRETRIGGER},
                                             {"impacts", 1, NULL, IMPACTS},
                                             {"roving", 1, NULL, ROVING},
                                             {"fixed", 1, NULL, FIXED},
                                             {"sensor-mass", 1, NULL, SENSOR_MASS},
                                             {"pulse", 1, NULL, PULSE},
                                             {"force", 1, NULL, FORCE},
                                             {"damping", 1, NULL, DAMPING},
                                             {"suspension-damping", 1, NULL, SUSPENSION},
                                             {"noise", 1, NULL, NOISE},
                                             {"force-noise", 1, NULL, FORCE_NOISE},
                                             {"floor", 1, NULL, FLOOR},
                                             {"double-hits", 1, NULL, DOUBLE_HITS},
                                             {"clipped", 1, NULL, CLIPPED},
                                             {"drift", 1, NULL, DRIFT},
                                             {"fault", 1, NULL, FAULT},
                                             {"ascii", 0, NULL, ASCII},
                                             {"help", 0, NULL, HELP},
                                             {NULL, 0, NULL, 0}};

static int wrong(const char *what, const char *value)
{
    fprintf(stderr, "hammer: expected %s, not '%s'\n", what, value);
    return HAMMER_INPUT;
}

static int number(const char *text, double *value)
{
    return hide_read_number(text, value) ? HAMMER_OK : wrong("a number", text);
}

static int integer(const char *text, long *value)
{
    double d;
    if (!hide_read_number(text, &d) || d != floor(d) || fabs(d) > 1e9)
        return wrong("an integer", text);
    *value = (long)d;
    return HAMMER_OK;
}

/* Numbers separated by one character; at most `most` of them. */
static int numbers(const char *text, char separator, int most, int *count, double *value)
{
    char piece[64];
    *count = 0;
    for (const char *from = text, *end; from; from = *end ? end + 1 : NULL) {
        end = strchr(from, separator) ? strchr(from, separator) : from + strlen(from);
        if (*count == most || (size_t)(end - from) >= sizeof piece)
            return wrong(separator == ':' ? "at most two numbers" : "fewer numbers", text);
        snprintf(piece, sizeof piece, "%.*s", (int)(end - from), from);
        if (number(piece, &value[(*count)++]))
            return HAMMER_INPUT;
    }
    return HAMMER_OK;
}

static int read_pair(const char *text, int least, double *first, double *second)
{
    double value[2];
    int count;
    if (numbers(text, ':', 2, &count, value))
        return HAMMER_INPUT;
    if (count < least)
        return wrong("two numbers separated by ':'", text);
    *first = value[0];
    *second = count > 1 ? value[1] : *second;
    return HAMMER_OK;
}

static int read_fault(const char *text, struct hammer_options *o)
{
    static const struct {
        const char *name;
        int has_value;
    } kinds[] = {{"dead", 0}, {"duplicate", 1}, {"flip", 0}, {"gain", 1}, {"loose", 1}};
    static const char form[] = "dead:ID, duplicate:ID=OTHER, flip:ID, gain:ID=FACTOR or loose:ID=HZ";
    struct hammer_fault *f = &o->fault[o->faults];
    char copy[80], *colon, *equals;
    if (o->faults == HAMMER_MOST_FAULTS)
        return wrong("fewer faults", text);
    snprintf(copy, sizeof copy, "%s", text);
    colon = strchr(copy, ':');
    if (!colon)
        return wrong(form, text);
    *colon = 0;
    equals = strchr(colon + 1, '=');
    if (equals)
        *equals = 0;
    for (int k = 0; k < (int)(sizeof kinds / sizeof *kinds); k++) {
        if (!hide_same(copy, kinds[k].name) || (equals != NULL) != kinds[k].has_value)
            continue;
        *f = (struct hammer_fault){.kind = (enum hammer_fault_kind)k};
        o->faults++;
        if (integer(colon + 1, &f->id))
            return HAMMER_INPUT;
        if (f->kind == HAMMER_DUPLICATE)
            return integer(equals + 1, &f->other);
        return equals ? number(equals + 1, &f->value) : HAMMER_OK;
    }
    return wrong(form, text);
}

static int take_seed(const char *text, uint64_t *value)
{
    char *end;
    errno = 0;
    *value = strtoull(text, &end, 10);
    return end == text || *end || errno || *text == '-' ? wrong("an integer not below zero", text) : HAMMER_OK;
}

static int take_number(int option, struct hammer_options *o)
{
    switch (option) {
    case RATE:
        return number(optarg, &o->rate);
    case BAND:
        return number(optarg, &o->band_hz);
    case SECONDS:
        return number(optarg, &o->seconds);
    case PRETRIGGER:
        return number(optarg, &o->pretrigger);
    case SENSOR_MASS:
        return number(optarg, &o->sensor_mass);
    case SUSPENSION:
        return number(optarg, &o->suspension_damping);
    case NOISE:
        return number(optarg, &o->noise);
    case FORCE_NOISE:
        return number(optarg, &o->force_noise);
    case FLOOR:
        return number(optarg, &o->floor);
    case DOUBLE_HITS:
        return number(optarg, &o->double_hits);
    case CLIPPED:
        return number(optarg, &o->clipped);
    case DRIFT:
        return number(optarg, &o->drift);
    case PULSE:
        return read_pair(optarg, 2, &o->pulse_short, &o->pulse_long);
    case FORCE:
        return read_pair(optarg, 1, &o->force, &o->force_spread);
    case FIXED:
        return integer(optarg, &o->fixed);
    default:
        return HAMMER_INPUT; /* getopt has said why */
    }
}

static int take(int option, const char **true_value, struct hammer_command *c)
{
    long value;
    switch (option) {
    case 'o':
        c->out = optarg;
        return HAMMER_OK;
    case TRUTH:
        c->truth = optarg;
        return HAMMER_OK;
    case DECK:
        c->deck = optarg;
        return HAMMER_OK;
    case MODES_FILE:
        c->modes_file = optarg;
        return HAMMER_OK;
    case STATE:
        c->state = optarg;
        return HAMMER_OK;
    case TRUE:
        true_value[c->truths++] = optarg;
        return HAMMER_OK;
    case SEED:
        return take_seed(optarg, &c->seed);
    case IMPACTS:
        if (integer(optarg, &value))
            return HAMMER_INPUT;
        c->options.impacts = (int)value;
        return HAMMER_OK;
    case ROVING:
        c->options.roving_hammer = hide_same(optarg, "hammer");
        return c->options.roving_hammer || hide_same(optarg, "sensor") ? HAMMER_OK : wrong("sensor or hammer", optarg);
    case DAMPING:
        c->damping_given = 1;
        return numbers(optarg, ',', HAMMER_MOST_DAMPING, &c->options.dampings, c->options.damping);
    case FAULT:
        return read_fault(optarg, &c->options);
    case ASCII:
        c->ascii = 1;
        return HAMMER_OK;
    case HELP:
        c->help = 1;
        return HAMMER_OK;
    default:
        return take_number(option, &c->options);
    }
}

int hammer_command_read(int argc, char **argv, const char **true_value, struct hammer_command *command)
{
    int option, status = HAMMER_OK;
    *command = (struct hammer_command){.options = hammer_options_default(), .seed = 1, .modes_file = "modes.unv"};
    while (!status && (option = getopt_long(argc, argv, "o:", long_options, NULL)) != -1)
        status = take(option, true_value, command);
    if (!status && !command->help && (optind + 1 != argc || !command->out)) {
        fputs(hammer_usage, stderr);
        status = HAMMER_INPUT;
    }
    command->rotor = optind < argc ? argv[optind] : NULL;
    return status;
}
