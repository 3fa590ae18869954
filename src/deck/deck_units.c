/* Units of a deck: SI, or those of *UNITS. */
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

double deck_unit_of(const struct job_units *units, const char *what)
{
    int q = find(what);
    return q >= 0 && units->si[q] > 0 ? units->si[q] : 1;
}

double deck_in_si(const struct deck_reader *reader, const char *what)
{
    return reader->job ? deck_unit_of(&reader->job->units, what) : 1;
}

const char *deck_length_unit(const struct deck_reader *reader)
{
    return reader->job->units.length ? reader->job->units.length : "m";
}

void deck_units(struct deck_reader *reader, const struct card *card)
{
    static const char *const lengths[] = {NULL, "cm", "mm", "in"}, *const frequencies[] = {NULL, "kHz", "rpm", "rad/s"};
    struct job_units *units = &reader->job->units;
    for (int q = 0; q < DECK_QUANTITIES; q++) {
        const struct card_option *option = card_option(card, quantity[q].option);
        int unit = option ? deck_option_word(reader, option, quantity[q].word) : -1;
        if (unit < 0)
            continue;
        if (units->si[q] > 0 && units->si[q] != 1)
            deck_error(reader, option->place, "the unit of %s is given twice, expected once", quantity[q].option);
        units->si[q] = quantity[q].factor[unit];
        if (q == 0)
            units->length = lengths[unit];
        if (q == DECK_QUANTITIES - 1)
            units->frequency = frequencies[unit];
    }
}

/* The unit in which *value would be from `least` to `most`, nearest to what is typical, and the value in SI then; NULL: none. */
static const char *likely_unit(int q, double least, double most, double typical, double *value)
{
    int best = -1;
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

/* What rotors, and small structures that are measured in their place, are made of. A share is a number that decks state in
 * percent by mistake. The first row whose words stand in the description of a value counts. */
static const struct {
    const char *what;
    double least, most, typical;
    const char *share; /* what a hundredth of it is, NULL: its unit may be another one */
} usual[] = {
    {"Young's modulus", 1e6, 1.5e12, 2e11, NULL}, /* from rubber on */
    {"shear modulus", 1e6, 7e11, 8e10, NULL},
    {"density", 100, 25e3, 7800, NULL},
    {"length [m]", 1e-4, 30, 0.3, NULL},
    {"diameter", 1e-4, 8, 0.2, NULL},
    {"radius", 1e-4, 4, 0.1, NULL},
    {"height", 1e-5, 8, 0.05, NULL},
    {"width [m]", 1e-5, 8, 0.05, NULL},
    {"mass [kg]", 1e-6, 1e5, 10, NULL},
    {"frequency [Hz]", 0.05, 1e5, 300, NULL},
    {"FREQUENCY", 0, 0.05, 0.001, "of the frequency"},
    {"SHAPE", 0, 0.3, 0.01, "of the largest component"},
    {"damping ratio", 0, 0.25, 0.005, "of critical damping"},
};

void deck_check_magnitude(struct deck_reader *reader, struct place place, const char *what, const char *text, double value)
{
    size_t i = 0, count = sizeof usual / sizeof *usual;
    while (i < count && !strstr(what, usual[i].what))
        i++;
    if (i == count || strstr(what, "deviation") || /* which says nothing of the unit: any size is usual */
        value <= 0 || (value >= usual[i].least && value <= usual[i].most) || reader->warned & 1U << i)
        return;
    reader->warned |= 1U << i; /* once of a kind */
    if (usual[i].share) {
        deck_note(reader, place, "%s is %s, which is %.4g %% %s: expected a share, not percent", what, text, 100 * value,
                  usual[i].share);
        return;
    }
    double there = value;
    int q = find(what);
    const char *option = q < 0 ? "" : quantity[q].option, *si = q < 0 ? "" : quantity[q].si;
    const char *unit = q >= 0 ? reader->likely[q] : NULL; /* one deck has one unit of lengths: 1000 and 50 are both mm */
    double in_unit = unit ? value * deck_unit_factor(si, unit) : 0;
    if (in_unit >= usual[i].least && in_unit <= usual[i].most)
        there = in_unit;
    else
        unit = likely_unit(q, usual[i].least, usual[i].most, usual[i].typical, &there);
    if (q >= 0)
        reader->likely[q] = unit;
    if (q < 0)
        deck_note(reader, place, "%s is %s, outside of what rotors have (%.3g to %.3g)", what, text, usual[i].least,
                  usual[i].most);
    else if (!unit || deck_in_si(reader, si) != 1)
        deck_note(reader, place, "%s is %s, %.4g %s, outside of what rotors have (%.3g to %.3g)", what, text, value, si,
                  usual[i].least, usual[i].most);
    else
        deck_note(
            reader, place,
            "%s is %s, outside of what rotors have (%.3g to %.3g): should it be in %s, write %.6g, or *UNITS, %s=%s for the "
            "whole deck",
            what, text, usual[i].least, usual[i].most, unit, there, option, unit);
}
