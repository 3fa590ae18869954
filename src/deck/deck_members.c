/* Cards of what is attached to the shaft: rods, bars, holes, forces, disks, springs, the sling. */
#include <math.h>
#include <string.h>

#include "deck/deck_cards.h"

static struct group *named_group(struct deck_reader *reader, const struct card *card)
{
    struct rotor *rotor = &reader->job->rotor;
    const char *name = deck_option(reader, card, "GROUP", "name of a *SHAFT or *BEAM");
    for (int g = 0; name && g < rotor->ngroup; g++)
        if (same_text(rotor->group[g].name, name))
            return &rotor->group[g];
    if (name)
        deck_error(reader, card_option(card, "GROUP")->value_place,
                   "group %s is not defined, expected the name of a *SHAFT or *BEAM", name);
    return NULL;
}

void deck_perforation(struct deck_reader *reader, const struct card *card)
{
    static const char layout[] = "number, hole diameter [m], pitch radius [m]";
    struct group *group = named_group(reader, card);
    if (!group || deck_lines(reader, card, 1, 1, layout) != 1 || deck_count(reader, &card->line[0], 3, layout))
        return;
    if (group->holes)
        deck_error(reader, card->place, "group %s is perforated twice, expected one *PERFORATION a group", group->name);
    for (int s = 0; s < reader->job->rotor.nsegment; s++)
        if (&reader->job->rotor.group[reader->job->rotor.segment[s].group] == group &&
            reader->job->rotor.segment[s].rectangular) {
            deck_error(reader, card->place, "group %s is a *BEAM, expected a round *SHAFT", group->name);
            return;
        }
    const struct data_line *line = &card->line[0];
    int bad = deck_integer(reader, line, 0, "number of holes", 3, 10000, &group->holes);
    bad |= deck_number(reader, line, 1, "hole diameter [m]", POSITIVE, &group->hole_diameter);
    bad |= deck_number(reader, line, 2, "pitch radius [m]", POSITIVE, &group->hole_pitch);
    for (int s = 0; s < reader->job->rotor.nsegment && !bad; s++) {
        const struct segment *segment = &reader->job->rotor.segment[s];
        if (&reader->job->rotor.group[segment->group] != group)
            continue;
        if (2 * group->hole_pitch + group->hole_diameter > segment->outer ||
            2 * group->hole_pitch - group->hole_diameter < segment->inner) {
            deck_error(reader, line->field[2].place,
                       "holes of %s m on a radius of %s m do not lie within the section, expected them between %.6g and %.6g m "
                       "of diameter",
                       line->field[1].text, line->field[2].text, segment->inner, segment->outer);
            return;
        }
    }
}

void deck_preload(struct deck_reader *reader, const struct card *card)
{
    struct group *group = named_group(reader, card);
    double force;
    if (!group || deck_lines(reader, card, 1, 1, "axial force [N], tension positive") != 1 ||
        deck_count(reader, &card->line[0], 1, "axial force [N], tension positive"))
        return;
    if (!deck_number(reader, &card->line[0], 0, "axial force [N]", ANY, &force))
        group->preload += force;
}

/* 0 and *material, or 1 after an error. */
static int bundle_material(struct deck_reader *reader, const struct card *card, struct material *material)
{
    const char *of = deck_option(reader, card, "MATERIAL", "name of a material");
    int index = of ? deck_find_material(reader, of) : -1;
    if (of && index < 0)
        deck_error(reader, card_option(card, "MATERIAL")->value_place,
                   "material %s is not defined, expected the name of a *MATERIAL", of);
    if (index < 0)
        return 1;
    *material = reader->material[index];
    return 0;
}

static int bundle_model(struct deck_reader *reader, const struct card *card, enum bundle_model *model)
{
    static const char *const models[] = {"RODS", "TUBE", NULL};
    const struct card_option *option = card_option(card, "MODEL");
    int word = option ? deck_option_word(reader, option, models) : 0;
    *model = word == 1 ? BUNDLE_TUBE : BUNDLE_RODS;
    return word < 0;
}

static int option_position(struct deck_reader *reader, const struct card *card, const char *name, double *z)
{
    const char *text = deck_option(reader, card, name, "position");
    return !text || deck_position(reader, text, card_option(card, name)->value_place, name, z);
}

void deck_tierod(struct deck_reader *reader, const struct card *card)
{
    static const char layout[] = "number, diameter [m], pitch radius [m], tension per rod [N] [, elements]";
    static const char *const answers[] = {"YES", "NO", NULL};
    struct rotor *rotor = &reader->job->rotor;
    struct tierod rod = {.elements = 1, .self_equilibrated = 1};
    const struct card_option *balanced = card_option(card, "SELF_EQUILIBRATED");
    rod.name = deck_option(reader, card, "NAME", "name");
    int bad = !rod.name || bundle_material(reader, card, &rod.material);
    bad |= bundle_model(reader, card, &rod.model);
    bad |= option_position(reader, card, "FROM", &rod.from) | option_position(reader, card, "TO", &rod.to);
    if (balanced)
        rod.self_equilibrated = deck_option_word(reader, balanced, answers) != 1;
    if (deck_lines(reader, card, 1, 1, layout) != 1 || deck_count(reader, &card->line[0], 5, layout))
        return;
    const struct data_line *line = &card->line[0];
    bad |= deck_integer(reader, line, 0, "number of rods", 3, 10000, &rod.number);
    bad |= deck_number(reader, line, 1, "diameter [m]", POSITIVE, &rod.diameter);
    bad |= deck_number(reader, line, 2, "pitch radius [m]", POSITIVE, &rod.pitch);
    bad |= deck_number(reader, line, 3, "tension per rod [N]", ANY, &rod.tension);
    if (deck_has(line, 4))
        bad |= deck_integer(reader, line, 4, "number of elements", 1, DECK_MOST_ELEMENTS, &rod.elements);
    if (!bad && rod.from >= rod.to) {
        deck_error(reader, card_option(card, "TO")->value_place, "TO=%s is not behind FROM=%s, expected a position further right",
                   card_option(card, "TO")->value, card_option(card, "FROM")->value);
        bad = 1;
    }
    if (!bad && rod.elements > 1)
        deck_note(reader, line->field[4].place,
                  "rods in %d elements have modes of their own, which may lie among those of the rotor and shift the mode "
                  "numbers; one element is the "
                  "usual choice",
                  rod.elements);
    struct tierod *added = bad ? NULL : DECK_APPEND(reader, rotor->tierod, rotor->ntierod, reader->tierod_room);
    struct place *place = bad ? NULL : DECK_APPEND(reader, reader->tierod_place, rotor->ntierod, reader->tierod_place_room);
    if (!added || !place)
        return;
    *added = rod;
    *place = card->place;
    rotor->ntierod++;
}

void deck_bars(struct deck_reader *reader, const struct card *card)
{
    static const char layout[] = "number, diameter [m], pitch radius [m], elements";
    struct rotor *rotor = &reader->job->rotor;
    struct bars bars = {0};
    bars.name = deck_option(reader, card, "NAME", "name");
    const char *length = deck_option(reader, card, "LENGTH", "length [m]");
    int bad = !bars.name || bundle_material(reader, card, &bars.material) || !length;
    bad |= bundle_model(reader, card, &bars.model) | option_position(reader, card, "CENTER", &bars.center);
    bad |= length && deck_option_number(reader, card_option(card, "LENGTH"), POSITIVE, &bars.length);
    if (deck_lines(reader, card, 1, 1, layout) != 1 || deck_count(reader, &card->line[0], 4, layout))
        return;
    const struct data_line *line = &card->line[0];
    bad |= deck_integer(reader, line, 0, "number of bars", 3, 10000, &bars.number);
    bad |= deck_number(reader, line, 1, "diameter [m]", POSITIVE, &bars.diameter);
    bad |= deck_number(reader, line, 2, "pitch radius [m]", POSITIVE, &bars.pitch);
    bad |= deck_integer(reader, line, 3, "number of elements", 2, DECK_MOST_ELEMENTS, &bars.elements);
    if (!bad && bars.elements % 2) {
        deck_error(reader, line->field[3].place,
                   "number of elements is %d, expected an even number: half to either side of the centre", bars.elements);
        bad = 1;
    }
    if (!bad &&
        (bars.center - bars.length / 2 < -1e-5 * reader->length || bars.center + bars.length / 2 > reader->length * (1 + 1e-5))) {
        deck_error(reader, card_option(card, "LENGTH")->value_place,
                   "bars of %s m reach beyond the rotor, expected them inside 0 to %.6g m", card_option(card, "LENGTH")->value,
                   reader->length);
        bad = 1;
    }
    struct bars *added = bad ? NULL : DECK_APPEND(reader, rotor->bars, rotor->nbars, reader->bars_room);
    struct place *place = bad ? NULL : DECK_APPEND(reader, reader->bars_place, rotor->nbars, reader->bars_place_room);
    if (!added || !place)
        return;
    /* clamped-free fundamental of a half bar, Euler-Bernoulli: 1.8751^2/(2 pi (L/2)^2) sqrt(E I / rho S) */
    double radius = bars.diameter / 4,
           hz = 0.5596 * sqrt(bars.material.e / bars.material.rho) * radius / (bars.length * bars.length / 4);
    if (bars.model == BUNDLE_RODS && hz < 5000)
        deck_note(reader, card->place,
                  "bars fixed at their centre alone have a mode of their own near %.0f Hz, which may lie among those of the "
                  "rotor and shift the mode "
                  "numbers; MODEL=TUBE has none so low",
                  hz);
    *added = bars;
    *place = card->place;
    rotor->nbars++;
}

void deck_disk(struct deck_reader *reader, const struct card *card)
{
    static const char layout[] = "position, mass [kg], diametral inertia, polar inertia [kg.m2]";
    struct rotor *rotor = &reader->job->rotor;
    const struct card_option *name = card_option(card, "NAME");
    int count = deck_lines(reader, card, 1, name ? 1 : DECK_MOST_LINES, layout);
    for (int i = 0; i < count; i++) {
        const struct data_line *line = &card->line[i];
        struct disk disk = {.name = name ? name->value : NULL};
        int bad = deck_count(reader, line, 4, layout) ||
                  deck_position(reader, line->field[0].text, line->field[0].place, "position", &disk.position);
        bad |= deck_number(reader, line, 1, "mass [kg]", NOT_NEGATIVE, &disk.mass);
        if (deck_has(line, 2))
            bad |= deck_number(reader, line, 2, "diametral inertia [kg.m2]", NOT_NEGATIVE, &disk.diametral);
        if (deck_has(line, 3))
            bad |= deck_number(reader, line, 3, "polar inertia [kg.m2]", NOT_NEGATIVE, &disk.polar);
        struct disk *added = bad ? NULL : DECK_APPEND(reader, rotor->disk, rotor->ndisk, reader->disk_room);
        if (added) {
            *added = disk;
            rotor->ndisk++;
        }
    }
}

void deck_spring(struct deck_reader *reader, const struct card *card)
{
    static const char layout[] = "position, lateral stiffness [N/m] [, rotational stiffness [N.m/rad]]";
    struct rotor *rotor = &reader->job->rotor;
    const struct card_option *name = card_option(card, "NAME");
    int count = deck_lines(reader, card, 1, name ? 1 : DECK_MOST_LINES, layout);
    for (int i = 0; i < count; i++) {
        const struct data_line *line = &card->line[i];
        struct spring spring = {.name = name ? name->value : NULL};
        int bad = deck_count(reader, line, 3, layout) ||
                  deck_position(reader, line->field[0].text, line->field[0].place, "position", &spring.position);
        bad |= deck_number(reader, line, 1, "lateral stiffness [N/m]", NOT_NEGATIVE, &spring.lateral);
        if (deck_has(line, 2))
            bad |= deck_number(reader, line, 2, "rotational stiffness [N.m/rad]", NOT_NEGATIVE, &spring.rotational);
        struct spring *added = bad ? NULL : DECK_APPEND(reader, rotor->spring, rotor->nspring, reader->spring_room);
        if (added) {
            *added = spring;
            rotor->nspring++;
        }
    }
}

void deck_sling(struct deck_reader *reader, const struct card *card)
{
    if (reader->job->rotor.sling > 0)
        deck_error(reader, card->place, "*SLING is given twice, expected once");
    for (int i = 0; i < card->nline; i++)
        deck_error(reader, card->line[i].place, "*SLING has no data lines, expected LENGTH=length [m] on the card");
    if (deck_option(reader, card, "LENGTH", "length [m]"))
        (void)deck_option_number(reader, card_option(card, "LENGTH"), POSITIVE, &reader->job->rotor.sling);
}
