/* Units of a deck: SI, or those of *UNITS. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "deck/deck_row.h"

#define UNITS_MOST 6

/* What *UNITS can state: the unit that a value has inside, in the brackets of its description, and the words for others. */
static const struct {
    const char *option, *si, *word[UNITS_MOST + 1];
    double factor[UNITS_MOST];
} quantity[DECK_QUANTITIES] = {{"LENGTH", "m", {"M", "CM", "MM", "IN"}, {1, 1e-2, 1e-3, 0.0254}},
                               {"MODULUS", "Pa", {"PA", "MPA", "GPA", "N/MM2", "PSI"}, {1, 1e6, 1e9, 1e6, 6894.757293168}},
                               {"DENSITY", "kg/m3", {"KG/M3", "KG/DM3", "G/CM3", "KG/MM3", "T/MM3"}, {1, 1e3, 1e3, 1e9, 1e12}},
                               {"MASS", "kg", {"KG", "G", "T", "LB"}, {1, 1e-3, 1e3, 0.45359237}},
                               {"INERTIA", "kg.m2", {"KG.M2", "KG.CM2", "KG.MM2"}, {1, 1e-4, 1e-6}},
                               {"FORCE", "N", {"N", "KN", "MN", "LBF"}, {1, 1e3, 1e6, 4.4482216152605}},
                               {"STIFFNESS", "N/m", {"N/M", "N/MM", "N/UM", "KN/MM"}, {1, 1e3, 1e6, 1e6}},
                               {"FREQUENCY", "Hz", {"HZ", "KHZ", "RPM", "RAD/S"}, {1, 1e3, 1.0 / 60, 0.15915494309189535}}};

const struct deck_row deck_units_rows[] = {OTHER("LENGTH", .words = quantity[0].word),
                                           OTHER("MODULUS", .words = quantity[1].word),
                                           OTHER("DENSITY", .words = quantity[2].word),
                                           OTHER("MASS", .words = quantity[3].word),
                                           OTHER("INERTIA", .words = quantity[4].word),
                                           OTHER("FORCE", .words = quantity[5].word),
                                           OTHER("STIFFNESS", .words = quantity[6].word),
                                           OTHER("FREQUENCY", .words = quantity[7].word),
                                           LAST};

/* Index of the quantity whose unit is, or stands in brackets in, `what`; -1: none. */
static int find(const char *what)
{
    const char *open = strrchr(what, '['), *unit = open ? open + 1 : what;
    size_t length = strcspn(unit, "]");
    for (int q = 0; q < DECK_QUANTITIES; q++)
        if (strlen(quantity[q].si) == length && !strncmp(unit, quantity[q].si, length))
            return q;
    return -1;
}

double deck_unit_factor(const char *si, const char *word)
{
    if (!strcmp(si, "1"))
        return !strcmp(word, "%") ? 0.01 : !strcmp(word, "-") || !strcmp(word, "1") ? 1 : 0;
    int q = find(si);
    for (int u = 0; q >= 0 && quantity[q].word[u]; u++)
        if (same_text(quantity[q].word[u], word))
            return quantity[q].factor[u];
    return 0;
}

double deck_in_si(const struct deck_reader *reader, const char *what)
{
    int q = find(what);
    return q >= 0 && reader->unit[q] ? quantity[q].factor[reader->unit[q]] : 1;
}

void deck_keep_units(struct deck_reader *reader)
{
    for (int q = 0; q < DECK_QUANTITIES; q++)
        reader->job->units.si[q] = quantity[q].factor[reader->unit[q]];
    reader->job->units.length = reader->unit[0] ? deck_unit_name(reader, "m") : NULL;
    reader->job->units.frequency = reader->unit[DECK_QUANTITIES - 1] ? deck_unit_name(reader, "Hz") : NULL;
}

double deck_unit_of(const struct job_units *units, const char *what)
{
    int q = find(what);
    return q >= 0 && units->si[q] > 0 ? units->si[q] : 1;
}

const char *deck_unit_name(const struct deck_reader *reader, const char *what)
{
    static const char *const lengths[] = {"m", "cm", "mm", "in"}, *const frequencies[] = {"Hz", "kHz", "rpm", "rad/s"};
    int q = find(what);
    return q < 0                      ? what
           : q == 0                   ? lengths[reader->unit[0]]
           : q == DECK_QUANTITIES - 1 ? frequencies[reader->unit[q]]
           : reader->unit[q]          ? quantity[q].word[reader->unit[q]]
                                      : quantity[q].si;
}

int deck_quantity(const char *what, const char **option, const char **si)
{
    int q = find(what);
    *option = q < 0 ? "" : quantity[q].option;
    *si = q < 0 ? "" : quantity[q].si;
    return q;
}

const char *deck_likely_unit(const char *what, double least, double most, double typical, double *value)
{
    int q = find(what), best = -1;
    double nearest = INFINITY;
    for (int u = 1; q >= 0 && quantity[q].word[u]; u++) {
        double there = *value * quantity[q].factor[u], apart = fabs(log(there / typical));
        if (there >= least && there <= most && apart < nearest) {
            nearest = apart;
            best = u;
        }
    }
    *value *= best < 0 ? 1 : quantity[q].factor[best];
    return best < 0 ? NULL : quantity[q].word[best];
}
