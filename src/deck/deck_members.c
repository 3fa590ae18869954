/* Cards of the parts that are attached to the shaft: rods, bars, holes, forces, disks, springs, the sling. */
#include <math.h>
#include <string.h>

#include "deck/deck_row.h"

static struct group *named_group(struct deck_reader *reader, const struct card *card)
{
    int group = deck_option_group(reader, card, "GROUP");
    return group < 0 ? NULL : &reader->job->rotor.group[group];
}

/* 0, or 1 after an error */
static int check_holes(struct deck_reader *reader, const struct data_line *line, const struct group *group, double outer,
                       double inner)
{
    int bad = 2 * group->hole_pitch + group->hole_diameter > outer || 2 * group->hole_pitch - group->hole_diameter < inner;
    if (bad)
        deck_error(reader, line->field[2].place,
                   "holes of %.9g m on a radius of %.9g m do not lie within the section, expected them between %.6g and %.6g m "
                   "of diameter",
                   group->hole_diameter, group->hole_pitch, inner, outer);
    return bad;
}

void deck_perforation(struct deck_reader *reader, const struct card *card)
{
    const char *layout = reader->layout;
    struct group *group = named_group(reader, card);
    if (!group || deck_lines(reader, card, 1, 1, layout) != 1)
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
    int bad = deck_read_values(reader, line, deck_perforation_rows, layout, group);
    for (int s = 0; s < reader->job->rotor.nsegment && !bad; s++) {
        const struct segment *segment = &reader->job->rotor.segment[s];
        if (&reader->job->rotor.group[segment->group] == group)
            bad = check_holes(reader, line, group, segment->outer, segment->inner);
    }
    for (int i = 0; i < reader->job->rotor.nring && !bad; i++) {
        const struct ring *ring = &reader->job->rotor.ring[i];
        if (&reader->job->rotor.group[ring->group] == group)
            bad = check_holes(reader, line, group, ring->outer, ring->inner);
    }
}

void deck_preload(struct deck_reader *reader, const struct card *card)
{
    struct group *group = named_group(reader, card);
    double force;
    if (group && group->layer_of >= 0) {
        deck_error(reader, card_option(card, "GROUP")->value_place,
                   "group %s is a *LAYER and an axial force is that of the whole section, expected GROUP=%s", group->name,
                   reader->job->rotor.group[group->layer_of].name);
        return;
    }
    if (!group || deck_lines(reader, card, 1, 1, "axial force [N], tension positive") != 1 ||
        deck_count(reader, &card->line[0], 1, "axial force [N], tension positive"))
        return;
    if (!deck_number(reader, &card->line[0], 0, "axial force [N]", ANY, &force))
        group->preload += force;
}

int deck_check_tierod(struct deck_reader *reader, const struct card *card, const struct data_line *line, void *item)
{
    const struct tierod *rod = item;
    if (rod->from >= rod->to) {
        deck_error(reader, card_option(card, "TO")->value_place, "TO=%s is not behind FROM=%s, expected a position further right",
                   card_option(card, "TO")->value, card_option(card, "FROM")->value);
        return 1;
    }
    if (rod->elements > 1)
        deck_note(reader, line->field[4].place,
                  "rods in %d elements have modes of their own, which may lie among those of the rotor and shift the mode "
                  "numbers; one element is the usual choice",
                  rod->elements);
    return 0;
}

int deck_check_bars(struct deck_reader *reader, const struct card *card, const struct data_line *line, void *item)
{
    const struct bars *bars = item;
    double half = bars->length / 2, over = 1e-5 * reader->length, radius = bars->diameter / 4, hz;
    if (bars->elements % 2) {
        deck_error(reader, line->field[3].place,
                   "number of elements is %d, expected an even number: half to either side of the centre", bars->elements);
        return 1;
    }
    if (bars->center - half < -over || bars->center + half > reader->length + over) {
        deck_error(reader, card_option(card, "LENGTH")->value_place,
                   "bars of %.9g m reach beyond the rotor, expected them inside 0 to %.6g m", bars->length, reader->length);
        return 1;
    }
    /* clamped-free fundamental of a half bar, Euler-Bernoulli: 1.8751^2/(2 pi (L/2)^2) sqrt(E I / rho S) */
    hz = 0.5596 * sqrt(bars->material.e / bars->material.rho) * radius / (half * half);
    if (bars->model == BUNDLE_RODS && hz < 5000)
        deck_note(reader, card->place,
                  "bars fixed at their centre alone have a mode of their own near %.0f Hz, which may lie among those of the "
                  "rotor and shift the mode numbers; MODEL=TUBE has none so low",
                  hz);
    return 0;
}

int deck_check_disk(struct deck_reader *reader, const struct card *card, const struct data_line *line, void *item)
{
    const struct rotor *rotor = &reader->job->rotor;
    const struct disk *disk = item;
    double from = disk->position - disk->hub_length / 2, to = disk->position + disk->hub_length / 2, z = 0, outer, inner;
    (void)card;
    if ((disk->hub_length > 0) != (disk->hub_outer > 0)) {
        deck_error(reader, line->field[deck_has(line, 5) ? 5 : 4].place,
                   "a hub has a length and an outer diameter above zero, expected both or neither");
        return 1;
    }
    for (int s = 0; s < rotor->nsegment && disk->hub_length > 0; s++) {
        const struct segment *segment = &rotor->segment[s];
        int under = z < to && z + segment->length > from;
        z += segment->length;
        rotor_diameters(rotor, s, &outer, &inner);
        if (under && (segment->rectangular || disk->hub_outer <= outer)) {
            if (segment->rectangular)
                deck_error(reader, line->field[5].place, "the hub sits on a *BEAM, expected a round *SHAFT under it");
            else
                deck_error(reader, line->field[5].place,
                           "hub outer diameter is %s m on a shaft of %.6g m, expected a larger one, or a shorter hub",
                           line->field[5].text, outer);
            return 1;
        }
    }
    for (int d = 0; d < rotor->ndisk && disk->hub_length > 0; d++) {
        double other = rotor->disk[d].hub_length / 2, apart = fabs(rotor->disk[d].position - disk->position);
        if (other > 0 && apart < (other + disk->hub_length / 2) * (1 - 1e-9)) {
            deck_error(reader, line->field[4].place, "the hub overlaps that of the disk at %.6g m, expected one after the other",
                       rotor->disk[d].position);
            return 1;
        }
    }
    return 0;
}

void deck_sling(struct deck_reader *reader, const struct card *card)
{
    (void)deck_read_options(reader, card, deck_sling_rows, &reader->job->rotor);
}
