/* Rings that lie on sections of the shaft. */
#include "deck/deck_row.h"

/* Index of the group of the axis that a layer lies on, -1 after an error. */
static int host_of(struct deck_reader *reader, const struct card *card)
{
    const struct rotor *rotor = &reader->job->rotor;
    const struct card_option *option = card_option(card, "GROUP");
    const char *name = deck_option(reader, card, "GROUP", "name of a *SHAFT");
    int host = name ? rotor_axis_groups(rotor) - 1 : -1;
    while (host >= 0 && !same_text(rotor->group[host].name, name))
        host--;
    if (name && host < 0)
        deck_error(reader, option->value_place, "group %s is not defined, expected the name of a *SHAFT", name);
    for (int s = 0; s < rotor->nsegment && host >= 0; s++)
        if (rotor->segment[s].group == host && rotor->segment[s].rectangular) {
            deck_error(reader, option->value_place, "group %s is a *BEAM, expected a round *SHAFT: layers are rings", name);
            return -1;
        }
    return host;
}

#define TOUCH 1e-9 /* relative: two diameters that a deck means to be one */

/* Puts a ring onto what the segment has so far. The diameter at which both touch becomes the same number. */
static void lay_ring(struct deck_reader *reader, const struct data_line *line, const char *name, int section, struct ring *ring)
{
    const struct rotor *rotor = &reader->job->rotor;
    const struct segment *segment = &rotor->segment[ring->segment];
    double outer, inner;
    rotor_diameters(rotor, ring->segment, &outer, &inner);
    int within = ring->outer <= inner * (1 + TOUCH), outside = ring->inner >= outer * (1 - TOUCH);
    if (outside && segment->stiff_outer != segment->outer)
        deck_error(reader, line->place,
                   "layer %s lies on section %d, of which only %.9g of %.9g m carry stiffness, expected a section that carries "
                   "as far as the layer",
                   name, section, segment->stiff_outer, segment->outer);
    if (within && ring->outer >= inner * (1 - TOUCH))
        ring->outer = inner;
    else if (within)
        deck_error(
            reader, line->field[0].place,
            "a gap: layer %s has an outer diameter of %.12g m and section %d a bore of %.12g m, expected the same diameter", name,
            ring->outer, section, inner);
    else if (outside && ring->inner <= outer * (1 + TOUCH))
        ring->inner = outer;
    else
        deck_error(reader, line->field[1].place,
                   "%s: layer %s has an inner diameter of %.12g m and section %d an outer diameter of %.12g m, expected the same "
                   "diameter",
                   outside ? "a gap" : "an overlap", name, ring->inner, section, outer);
}

/* Of the rings of a segment the innermost first, whatever the order of the cards. */
static void add_ring(struct deck_reader *reader, const struct ring *ring)
{
    struct rotor *rotor = &reader->job->rotor;
    int at = rotor->nring;
    if (!DECK_APPEND(reader, rotor->ring, rotor->nring, reader->ring_room))
        return;
    for (; at > 0 && (rotor->ring[at - 1].segment > ring->segment ||
                      (rotor->ring[at - 1].segment == ring->segment && rotor->ring[at - 1].inner > ring->inner));
         at--)
        rotor->ring[at] = rotor->ring[at - 1];
    rotor->ring[at] = *ring;
    rotor->nring++;
}

void deck_layer(struct deck_reader *reader, const struct card *card)
{
    const char *layout = reader->layout;
    struct rotor *rotor = &reader->job->rotor;
    int host = host_of(reader, card), group = deck_add_group(reader, card), sections = 0, section = 0;
    for (int s = 0; s < rotor->nsegment; s++)
        sections += rotor->segment[s].group == host;
    int count = deck_lines(reader, card, 1, host < 0 ? DECK_MOST_LINES : sections, layout);
    if (group >= 0)
        rotor->group[group].layer_of = host < 0 ? 0 : host;
    if (host >= 0 && count > 1 && count < sections)
        deck_error(reader, card->place,
                   "*LAYER has %d data lines and group %s has %d sections, expected one line for all or one for each", count,
                   rotor->group[host].name, sections);
    else
        for (int s = 0; s < rotor->nsegment && count && group >= 0 && host >= 0; s++) {
            struct ring ring = {.group = group, .segment = s};
            if (rotor->segment[s].group != host)
                continue;
            const struct data_line *line = &card->line[count > 1 ? section : 0];
            section++;
            if (deck_read_values(reader, line, deck_layer_rows, layout, &ring)) {
                if (count == 1)
                    return;
                continue;
            }
            if (ring.inner >= ring.outer)
                deck_error(reader, line->field[1].place,
                           "inner diameter %.12g m is not below the outer diameter %.12g m, expected a smaller one", ring.inner,
                           ring.outer);
            else
                lay_ring(reader, line, rotor->group[group].name, section, &ring);
            add_ring(reader, &ring);
        }
}
