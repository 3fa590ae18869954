/* Units of a deck: SI, or those of *UNITS; and numbers that no rotor has, which are mostly numbers in another unit. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "deck/deck_row.h"

#define UNITS_MOST 6

/* Beside the whole rotor; ten times and more from where solutions fail. */
#define SHORTEST 1e-7
#define THINNEST 1e-4 /* of the largest diameter: EI falls by its fourth power */
#define STIFFEST 1e13 /* times EI/L^3 */
#define HEAVIEST 1e7
#define SOFTEST  1e6 /* between the moduli of two materials */

static const double pi = 3.14159265358979323846;

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

/* What rotors, and small structures that are measured in their place, are made of. A share is a number that decks state in
 * percent by mistake. The first row whose words stand in the description of a value counts. */
static const struct {
    const char *what;
    double least, most, typical;
    const char *share; /* what a hundredth of it is, NULL: its unit may be another one */
} usual[] = {
    {"Young's modulus", 1e8, 1.5e12, 2e11, NULL},
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
}

double deck_unit_of(const struct job_units *units, const char *what)
{
    int q = find(what);
    return q >= 0 && units->si[q] > 0 ? units->si[q] : 1;
}

const char *deck_unit_name(const struct deck_reader *reader, const char *what)
{
    static const char *const lengths[] = {"m", "cm", "mm", "in"};
    int q = find(what);
    return q < 0             ? what
           : q == 0          ? lengths[reader->unit[0]]
           : reader->unit[q] ? quantity[q].word[reader->unit[q]]
                             : quantity[q].si;
}

/* The unit that makes a usual number of it: of several the one that comes nearest to what is typical. */
static int likely_unit(int q, double value, double least, double most, double typical)
{
    int best = -1;
    double nearest = INFINITY;
    for (int u = 1; q >= 0 && quantity[q].word[u]; u++) {
        double there = value * quantity[q].factor[u], apart = fabs(log(there / typical));
        if (there >= least && there <= most && apart < nearest) {
            nearest = apart;
            best = u;
        }
    }
    return best;
}

void deck_doubt(struct deck_reader *reader, struct place place, const char *what, const char *text, double value)
{
    size_t i = 0, count = sizeof usual / sizeof *usual;
    while (i < count && !strstr(what, usual[i].what))
        i++;
    if (i == count || strstr(what, "deviation") || /* which says nothing of the unit: any size is usual */
        value <= 0 || (value >= usual[i].least && value <= usual[i].most) || reader->doubted & 1U << i)
        return;
    reader->doubted |= 1U << i; /* once of a kind */
    if (usual[i].share) {
        deck_note(reader, place, "%s is %s, which is %.4g %% %s: expected a share, not percent", what, text, 100 * value,
                  usual[i].share);
        return;
    }
    int q = find(what), unit = likely_unit(q, value, usual[i].least, usual[i].most, usual[i].typical);
    if (q < 0)
        deck_note(reader, place, "%s is %s, outside of what rotors have (%.3g to %.3g)", what, text, usual[i].least,
                  usual[i].most);
    else if (unit < 0 || reader->unit[q])
        deck_note(reader, place, "%s is %s, %.4g %s, outside of what rotors have (%.3g to %.3g)", what, text, value,
                  quantity[q].si, usual[i].least, usual[i].most);
    else
        deck_note(
            reader, place,
            "%s is %s, outside of what rotors have (%.3g to %.3g): should it be in %s, write %.6g, or *UNITS, %s=%s for the "
            "whole deck",
            what, text, usual[i].least, usual[i].most, quantity[q].word[unit], value * quantity[q].factor[unit],
            quantity[q].option, quantity[q].word[unit]);
}

/* Numbers of a rotor so far apart that the sixteen digits of K and M lose the smaller ones: refused here, where each has a place,
 * in place of an eigenvalue problem that has no solution. A support is rigid, a mass at rest, long before. */
static void refuse_contrast(struct deck_reader *reader, struct place place, double mass, double length)
{
    const struct rotor *rotor = &reader->job->rotor;
    double bending = 0, thickest = 0;
    int soft = -1, hard = -1;
    for (int s = 0; s < rotor->nsegment; s++)
        thickest = fmax(thickest, rotor->segment[s].rectangular ? rotor->segment[s].height : rotor->segment[s].outer);
    for (int s = 0; s < rotor->nsegment; s++) {
        const struct segment *g = &rotor->segment[s];
        double e = rotor->group[g->group].material.e, d = g->outer, b = g->inner;
        bending = fmax(bending, g->rectangular ? e * g->width * pow(g->height, 3) / 12 : e * pi / 64 * (pow(d, 4) - pow(b, 4)));
        if (g->length < SHORTEST * length)
            deck_error(reader, reader->place[GROUP_PLACES][g->group],
                       "a section of %s is %.3g m long in a rotor of %.4g m, expected at least %.1g of the length",
                       rotor->group[g->group].name, g->length, length, SHORTEST);
        if ((g->rectangular ? g->height : g->outer) < THINNEST * thickest)
            deck_error(
                reader, reader->place[GROUP_PLACES][g->group],
                "a section of %s is %.3g m thick in a rotor of up to %.4g m, expected at least %.1g of that: a diameter in "
                "another unit?",
                rotor->group[g->group].name, g->rectangular ? g->height : g->outer, thickest, THINNEST);
    }
    bending /= length * length * length;
    for (int i = 0; i < rotor->nspring; i++) {
        const struct spring *spring = &rotor->spring[i];
        double share = fmax(spring->lateral, spring->rotational / (length * length)) / bending;
        if (share > STIFFEST)
            deck_error(
                reader, place,
                "the spring at %.4g m is %.1g times as stiff as the shaft, whose EI/L^3 is %.3g N/m, expected at most %.1g "
                "times, which is rigid: stiffness, E or diameters in another unit?",
                spring->position, share, bending, STIFFEST);
    }
    for (int i = 0; i < rotor->ndisk; i++) {
        const struct disk *disk = &rotor->disk[i];
        double share = fmax(disk->mass, disk->diametral / (length * length)) / mass;
        if (share > HEAVIEST)
            deck_error(
                reader, place,
                "the disk at %.4g m is %.1g times as heavy as the shaft of %.4g kg, expected at most %.1g times, which is at "
                "rest: mass or density in another unit?",
                disk->position, share, mass, HEAVIEST);
    }
    for (int m = 0; m < reader->nmaterial; m++) {
        double e = reader->material[m].e;
        soft = e > 0 && (soft < 0 || e < reader->material[soft].e) ? m : soft;
        hard = e > 0 && (hard < 0 || e > reader->material[hard].e) ? m : hard;
    }
    if (soft >= 0 && reader->material[hard].e > SOFTEST * reader->material[soft].e)
        deck_error(
            reader, reader->place[MATERIAL_PLACES][soft],
            "Young's modulus of %s is %.4g Pa beside %.4g Pa of %s, expected at most a factor of %.1g between two materials: "
            "one of them in another unit?",
            reader->material[soft].name, reader->material[soft].e, reader->material[hard].e, reader->material[hard].name,
            SOFTEST);
}

void deck_doubt_rotor(struct deck_reader *reader)
{
    const struct rotor *rotor = &reader->job->rotor;
    double mass = 0, length = rotor_length(rotor);
    for (int s = 0; s < rotor->nsegment; s++) {
        const struct segment *g = &rotor->segment[s];
        double area = g->rectangular ? g->height * g->width : pi / 4 * (g->outer * g->outer - g->inner * g->inner);
        mass += area * g->length * rotor->group[g->group].material.rho;
    }
    struct place place = rotor->ngroup ? reader->place[GROUP_PLACES][0] : reader->text.end;
    if (mass > 0 && length > 0)
        refuse_contrast(reader, place, mass, length);
    if (!reader->doubted && (length > 30 || length < 0.01))
        deck_note(reader, place, "the rotor is %.4g m long, expected 0.01 to 30 m: lengths in another unit?", length);
    if (!reader->doubted && (mass > 3e5 || mass < 1e-3))
        deck_note(reader, place, "the shaft weighs %.4g kg, expected 0.001 to 300,000 kg: density or lengths in another unit?",
                  mass);
}

void deck_units(struct deck_reader *reader, const struct card *card)
{
    for (int q = 0; q < DECK_QUANTITIES; q++) {
        const struct card_option *option = card_option(card, quantity[q].option);
        int unit = option ? deck_option_word(reader, option, quantity[q].word) : -1;
        if (unit >= 0 && reader->unit[q])
            deck_error(reader, option->place, "the unit of %s is given twice, expected once", quantity[q].option);
        if (unit >= 0)
            reader->unit[q] = unit;
    }
}
