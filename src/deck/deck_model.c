/* Cards of materials and of the shaft itself. */
#include "deck/deck_row.h"

static int find_material(const struct deck_reader *reader, const char *name)
{
    for (int i = 0; i < reader->nmaterial; i++)
        if (same_text(reader->material[i].name, name))
            return i;
    return -1;
}

int deck_named_material(struct deck_reader *reader, const char *name, struct place place)
{
    int index = find_material(reader, name);
    return index >= 0 ? index : -deck_error(reader, place, "material %s is not defined, expected the name of a *MATERIAL", name);
}

void deck_material(struct deck_reader *reader, const struct card *card)
{
    const char *name = deck_option(reader, card, "NAME", "name");
    if (name && find_material(reader, name) >= 0)
        deck_error(reader, card_option(card, "NAME")->value_place, "material %s is defined twice, expected a new name", name);
    int count = reader->nmaterial, incomplete = 0;
    deck_add_place(reader, MATERIAL_PLACES, card->place);
    (void)POOL_ADD(reader->pool, reader->material_complete, count, &incomplete);
    (void)POOL_ADD(reader->pool, reader->material, reader->nmaterial, &(struct material){.name = name ? name : ""});
}

static struct material *current_material(struct deck_reader *reader, const struct card *card, int bit)
{
    if (!reader->nmaterial) {
        deck_error(reader, card->place, "*%s stands before any material, expected *MATERIAL, NAME=name first", card->name);
        return NULL;
    }
    int last = reader->nmaterial - 1;
    if (reader->material_complete[last] & bit)
        deck_error(reader, card->place, "*%s is given twice for material %s, expected once", card->name,
                   reader->material[last].name);
    reader->material_complete[last] |= bit;
    return &reader->material[last];
}

/* Strain energy is positive where 1 - nu_plane - 2 nu_axial^2 E_plane/E > 0, with E_plane = stacking E_sheet, nu_plane = nu_sheet
 * and nu_axial = nu_sheet E/E_sheet. The shear coefficient of the thinnest ring has its pole at nu_sheet G/E_sheet = 2. */
static void check_stack(struct deck_reader *reader, const struct data_line *line, const struct material *m)
{
    double steel = m->sheet_e / (2 * (1 + m->nu));
    if (!(m->nu > -1 && m->nu < 0.5))
        deck_error(reader, line->field[3].place, "Poisson ratio of a sheet is %s, expected above -1 and below 0.5",
                   line->field[3].text);
    else if (m->stacking > 1)
        deck_error(reader, line->field[4].place, "stacking factor is %s, expected a share of the length, at most 1",
                   line->field[4].text);
    else if (1 - m->nu - 2 * m->nu * m->nu * m->stacking * m->e / m->sheet_e <= 0)
        deck_error(
            reader, line->field[0].place,
            "Young's modulus E along the axis is %.9g Pa with sheets of %.9g Pa: such a stack would move by itself (negative "
            "strain energy), expected less",
            m->e, m->sheet_e);
    else if (m->g > 1.5 * m->sheet_e)
        deck_error(
            reader, line->field[1].place,
            "shear modulus G along the axis is %.9g Pa with sheets of %.9g Pa, expected less than the %.4g Pa of the sheets",
            m->g, m->sheet_e, steel);
    else if (m->e > m->sheet_e * (1 + 1e-9) || m->g > steel * (1 + 1e-9))
        deck_note(reader, line->field[m->e > m->sheet_e * (1 + 1e-9) ? 0 : 1].place,
                  "the stack is stiffer along the axis than its sheets (E %.4g Pa, G %.4g Pa)", m->sheet_e, steel);
}

void deck_elastic(struct deck_reader *reader, const struct card *card)
{
    static const char *const layouts[] = {"E [Pa], nu", "E [Pa], G [Pa], nu",
                                          "E, G along the axis [Pa], E [Pa], nu of a sheet [, stacking factor]"};
    static const struct deck_row *const rows[] = {deck_elastic_rows, deck_shear_rows, deck_laminated_rows};
    const struct card_option *option = card_option(card, "TYPE");
    int type = option ? deck_option_word(reader, option, reader->row->words) : 0;
    reader->layout = layouts[type = type < 0 ? 0 : type];
    reader->row = rows[type];
    struct material *material = current_material(reader, card, 1);
    const struct data_line *line = material ? deck_only_line(reader, card) : NULL;
    if (!line)
        return;
    material->isotropic = type == 0;
    material->laminated = type == 2;
    material->stacking = 1;
    int last = type ? 2 : 1, bad = deck_read_values(reader, line, material);
    if (!bad && material->laminated)
        check_stack(reader, line, material);
    else if (!bad && !(material->nu > -1 && material->nu <= 0.5))
        deck_error(reader, line->field[last].place, "Poisson ratio nu is %s, expected above -1 and at most 0.5",
                   line->field[last].text);
}

void deck_density(struct deck_reader *reader, const struct card *card)
{
    struct material *material = current_material(reader, card, 2);
    const struct data_line *line = material ? deck_only_line(reader, card) : NULL;
    if (line)
        (void)deck_read_values(reader, line, material);
}

/* A new group of NAME and MATERIAL of the card, on the axis: its index, or -1 after an error. */
static int add_group(struct deck_reader *reader, const struct card *card)
{
    struct rotor *rotor = &reader->job->rotor;
    const char *name = deck_option(reader, card, "NAME", "name"),
               *of = deck_option(reader, card, "MATERIAL", "name of a material");
    struct group group = {.name = name ? name : "", .layer_of = -1};
    int material = of ? deck_named_material(reader, of, card_option(card, "MATERIAL")->value_place) : -1;
    if (name && deck_find_group(rotor, rotor->ngroup, name, strlen(name)) >= 0)
        return -deck_error(reader, card_option(card, "NAME")->value_place, "the name %s is given twice, expected a new one",
                           name);
    if (material >= 0)
        group.material = reader->material[material];
    deck_add_place(reader, GROUP_PLACES, card->place);
    return POOL_ADD(reader->pool, rotor->group, rotor->ngroup, &group) ? -1 : rotor->ngroup - 1;
}

static void check_diameters(struct deck_reader *reader, const struct data_line *line, const struct segment *s)
{
    if (s->inner >= s->outer)
        deck_error(reader, line->field[2].place,
                   "inner diameter %.12g m is not below the outer diameter %.12g m, expected a smaller one", s->inner, s->outer);
    else if (s->stiff_outer > s->outer || s->stiff_outer <= s->inner)
        deck_error(reader, line->field[4].place,
                   "the diameter that carries stiffness is %.12g m, expected above the inner and at most the outer diameter",
                   s->stiff_outer);
}

/* *SHAFT or *BEAM: a section of each data line. One that states no elements has some until those of all are chosen. */
void deck_sections(struct deck_reader *reader, const struct card *card)
{
    struct rotor *rotor = &reader->job->rotor;
    int group = add_group(reader, card), count = deck_lines(reader, card, 1, DECK_MOST_LINES),
        rectangular = !strcmp(card->name, "BEAM");
    for (int i = 0; i < count && group >= 0; i++) {
        struct segment s = {
            .group = group, .rectangular = rectangular, .length = 1e6}; /* of an error: every position is inside */
        int bad = deck_read_values(reader, &card->line[i], &s);
        if (!bad && !rectangular)
            check_diameters(reader, &card->line[i], &s);
        if (!s.elements)
            (void)POOL_ADD(reader->pool, reader->open_section, reader->nopen, &rotor->nsegment);
        s.elements = s.elements ? s.elements : 1;
        if (POOL_ADD(reader->pool, rotor->segment, rotor->nsegment, &s))
            return;
    }
}

/* ------------------------------------------------------------------------------------------------ *LAYER */

/* Index of the group of the axis that a layer lies on, -1 after an error. */
static int host_of(struct deck_reader *reader, const struct card *card)
{
    const struct rotor *rotor = &reader->job->rotor;
    const struct card_option *option = card_option(card, "GROUP");
    const char *name = deck_option(reader, card, "GROUP", "name of a *SHAFT");
    int host = name ? deck_find_group(rotor, rotor_axis_groups(rotor), name, strlen(name)) : -1;
    if (name && host < 0)
        deck_error(reader, option->value_place, "group %s is not defined, expected the name of a *SHAFT", name);
    for (int s = 0; s < rotor->nsegment && host >= 0; s++)
        if (rotor->segment[s].group == host && rotor->segment[s].rectangular)
            return -deck_error(reader, option->value_place, "group %s is a *BEAM, expected a round *SHAFT: layers are rings",
                               name);
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
    if (POOL_ADD(reader->pool, rotor->ring, rotor->nring, ring))
        return;
    for (; at > 0 && (rotor->ring[at - 1].segment > ring->segment ||
                      (rotor->ring[at - 1].segment == ring->segment && rotor->ring[at - 1].inner > ring->inner));
         at--)
        rotor->ring[at] = rotor->ring[at - 1];
    rotor->ring[at] = *ring;
}

void deck_layer(struct deck_reader *reader, const struct card *card)
{
    struct rotor *rotor = &reader->job->rotor;
    int host = host_of(reader, card), group = add_group(reader, card), sections = 0, section = 0;
    for (int s = 0; s < rotor->nsegment; s++)
        sections += rotor->segment[s].group == host;
    int count = deck_lines(reader, card, 1, host < 0 ? DECK_MOST_LINES : sections), bad = host < 0 || group < 0 || !count;
    if (group >= 0)
        rotor->group[group].layer_of = host < 0 ? 0 : host;
    if (host >= 0 && count > 1 && count < sections)
        bad = deck_error(reader, card->place,
                         "*LAYER has %d data lines and group %s has %d sections, expected one line for all or one for each",
                         count, rotor->group[host].name, sections);
    for (int s = 0; s < rotor->nsegment && !bad; s++) {
        struct ring ring = {.group = group, .segment = s};
        if (rotor->segment[s].group != host)
            continue;
        const struct data_line *line = &card->line[count > 1 ? section : 0];
        section++;
        if (deck_read_values(reader, line, &ring)) {
            bad = count == 1; /* it would be said of each section */
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

/* Cards of the parts that are attached to the shaft: rods, bars, holes, forces, disks, springs, the sling. */

static struct group *named_group(struct deck_reader *reader, const struct card *card)
{
    int group = deck_option_group(reader, card, "GROUP");
    return group < 0 ? NULL : &reader->job->rotor.group[group];
}

/* 0, or 1 after an error */
static int check_holes(struct deck_reader *reader, const struct data_line *line, const struct group *group, double outer,
                       double inner)
{
    if (2 * group->hole_pitch + group->hole_diameter <= outer && 2 * group->hole_pitch - group->hole_diameter >= inner)
        return 0;
    return deck_error(
        reader, line->field[2].place,
        "holes of %.9g m on a radius of %.9g m do not lie within the section, expected them between %.6g and %.6g m "
        "of diameter",
        group->hole_diameter, group->hole_pitch, inner, outer);
}

void deck_perforation(struct deck_reader *reader, const struct card *card)
{
    const struct rotor *rotor = &reader->job->rotor;
    struct group *group = named_group(reader, card);
    const struct data_line *line = group ? deck_only_line(reader, card) : NULL;
    if (!line)
        return;
    if (group->holes)
        deck_error(reader, card->place, "group %s is perforated twice, expected one *PERFORATION a group", group->name);
    int bad = deck_read_values(reader, line, group);
    for (int s = 0; s < rotor->nsegment && !bad; s++) {
        const struct segment *segment = &rotor->segment[s];
        if (&rotor->group[segment->group] == group)
            bad = segment->rectangular
                      ? deck_error(reader, card->place, "group %s is a *BEAM, expected a round *SHAFT", group->name)
                      : check_holes(reader, line, group, segment->outer, segment->inner);
    }
    for (int i = 0; i < rotor->nring && !bad; i++)
        if (&rotor->group[rotor->ring[i].group] == group)
            bad = check_holes(reader, line, group, rotor->ring[i].outer, rotor->ring[i].inner);
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
    const struct data_line *line = group ? deck_only_line(reader, card) : NULL;
    if (line && !deck_count(reader, line, 1) && !deck_number(reader, line, 0, "axial force [N]", ANY, &force))
        group->preload += force;
}

int deck_check_tierod(struct deck_reader *reader, const struct data_line *line, void *item)
{
    const struct tierod *rod = item;
    if (rod->from >= rod->to)
        return deck_error(reader, card_option(reader->card, "TO")->value_place,
                          "TO=%s is not behind FROM=%s, expected a position further right",
                          card_option(reader->card, "TO")->value, card_option(reader->card, "FROM")->value);
    if (rod->elements > 1)
        deck_note(reader, line->field[4].place,
                  "rods in %d elements have modes of their own, which may lie among those of the rotor and shift the mode "
                  "numbers; one element is the usual choice",
                  rod->elements);
    return 0;
}

int deck_check_bars(struct deck_reader *reader, const struct data_line *line, void *item)
{
    const struct bars *bars = item;
    double half = bars->length / 2, over = 1e-5 * reader->length, radius = bars->diameter / 4, hz;
    if (bars->elements % 2)
        return deck_error(reader, line->field[3].place,
                          "number of elements is %d, expected an even number: half to either side of the centre", bars->elements);
    if (bars->center - half < -over || bars->center + half > reader->length + over)
        return deck_error(reader, card_option(reader->card, "LENGTH")->value_place,
                          "bars of %.9g %s reach beyond the rotor, expected them inside 0 to %.6g %s",
                          bars->length / deck_in_si(reader, "m"), deck_length_unit(reader),
                          reader->length / deck_in_si(reader, "m"), deck_length_unit(reader));
    /* clamped-free fundamental of a half bar, Euler-Bernoulli: 1.8751^2/(2 pi (L/2)^2) sqrt(E I / rho S) */
    hz = 0.5596 * sqrt(bars->material.e / bars->material.rho) * radius / (half * half);
    if (bars->model == BUNDLE_RODS && hz < 5000)
        deck_note(reader, reader->card->place,
                  "bars fixed at their centre alone have a mode of their own near %.0f Hz, which may lie among those of the "
                  "rotor and shift the mode numbers; MODEL=TUBE has none so low",
                  hz);
    return 0;
}

int deck_check_disk(struct deck_reader *reader, const struct data_line *line, void *item)
{
    const struct rotor *rotor = &reader->job->rotor;
    const struct disk *disk = item;
    double from = disk->position - disk->hub_length / 2, to = disk->position + disk->hub_length / 2, z = 0, outer, inner;
    if ((disk->hub_length > 0) != (disk->hub_outer > 0))
        return deck_error(reader, line->field[deck_has(line, 5) ? 5 : 4].place,
                          "a hub has a length and an outer diameter above zero, expected both or neither");
    for (int s = 0; s < rotor->nsegment && disk->hub_length > 0; s++) {
        const struct segment *segment = &rotor->segment[s];
        int under = z < to && z + segment->length > from;
        z += segment->length;
        rotor_diameters(rotor, s, &outer, &inner);
        if (under && segment->rectangular)
            return deck_error(reader, line->field[5].place, "the hub sits on a *BEAM, expected a round *SHAFT under it");
        if (under && disk->hub_outer <= outer)
            return deck_error(reader, line->field[5].place,
                              "hub outer diameter is %s m on a shaft of %.6g m, expected a larger one, or a shorter hub",
                              line->field[5].text, outer);
    }
    for (int d = 0; d < rotor->ndisk && disk->hub_length > 0; d++) {
        double other = rotor->disk[d].hub_length / 2, apart = fabs(rotor->disk[d].position - disk->position);
        if (other > 0 && apart < (other + disk->hub_length / 2) * (1 - 1e-9))
            return deck_error(reader, line->field[4].place,
                              "the hub overlaps that of the disk at %.6g m, expected one after the other",
                              rotor->disk[d].position);
    }
    if (disk->diametral > 0 && disk->polar > 2 * MORE_THAN_ROUNDING * disk->diametral)
        deck_note(reader, line->field[3].place,
                  "the polar inertia of this disk is %.4g times the diametral one, expected at most 2 times: a disk without "
                  "thickness has 2, and no body has more",
                  disk->polar / disk->diametral);
    return 0;
}

#define CLAMP_STIFFNESS 1e7 /* times EI/L^3 and EI/L: a clamped end moves by less than 1e-6 of the rest */

/* A clamped place is a spring that is stiff beside the rotor, in every direction. */
void deck_clamp(struct deck_reader *reader, const struct card *card)
{
    struct rotor *rotor = &reader->job->rotor;
    struct spring spring = {.name = NULL};
    double ei = 0, length = reader->length;
    if (!card_option(card, "AT")) {
        deck_error(reader, card->place, "*CLAMP has no AT, expected AT=start, AT=end or another position");
        return;
    }
    if (deck_read_options(reader, card, &spring))
        return;
    for (int s = 0; s < rotor->nsegment; s++) {
        struct section section;
        if (!section_of_segment(rotor, s, &section))
            ei = fmax(ei, rotor->group[rotor->segment[s].group].material.e * section.stiff_inertia);
    }
    spring.rotational = spring.torsional = CLAMP_STIFFNESS * ei / length;
    spring.lateral = spring.axial = spring.rotational / (length * length);
    (void)POOL_ADD(reader->pool, rotor->spring, rotor->nspring, &spring);
}

void deck_sling(struct deck_reader *reader, const struct card *card)
{
    (void)deck_read_options(reader, card, &reader->job->rotor);
}
