/* Cards of materials and of the shaft itself. */
#include "deck/deck_row.h"

int deck_find_material(const struct deck_reader *reader, const char *name)
{
    for (int i = 0; i < reader->nmaterial; i++)
        if (same_text(reader->material[i].name, name))
            return i;
    return -1;
}

void deck_material(struct deck_reader *reader, const struct card *card)
{
    const char *name = deck_option(reader, card, "NAME", "name");
    if (name && deck_find_material(reader, name) >= 0)
        deck_error(reader, card_option(card, "NAME")->value_place, "material %s is defined twice, expected a new name", name);
    struct material *material = DECK_APPEND(reader, reader->material, reader->nmaterial, reader->material_room);
    int *complete = DECK_APPEND(reader, reader->material_complete, reader->nmaterial, reader->material_complete_room);
    struct place *place = DECK_APPEND(reader, reader->material_place, reader->nmaterial, reader->material_place_room);
    if (!material || !complete || !place)
        return;
    *material = (struct material){.name = name ? name : ""};
    *complete = 0;
    *place = card->place;
    reader->nmaterial++;
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
    static const char *const types[] = {"ISOTROPIC", "SHEAR", "LAMINATED", NULL};
    static const char *const layouts[] = {"E [Pa], nu", "E [Pa], G [Pa], nu",
                                          "E, G along the axis [Pa], E [Pa], nu of a sheet [, stacking factor]"};
    static const struct deck_row *const rows[] = {deck_elastic_rows, deck_shear_rows, deck_laminated_rows};
    const struct card_option *option = card_option(card, "TYPE");
    int type = option ? deck_option_word(reader, option, types) : 0;
    const char *layout = layouts[type = type < 0 ? 0 : type];
    struct material *material = current_material(reader, card, 1);
    if (!material || deck_lines(reader, card, 1, 1, layout) != 1)
        return;
    const struct data_line *line = &card->line[0];
    material->isotropic = type == 0;
    material->laminated = type == 2;
    material->stacking = 1;
    int last = type ? 2 : 1, bad = deck_read_values(reader, line, rows[type], layout, material);
    if (!bad && material->laminated)
        check_stack(reader, line, material);
    else if (!bad && !(material->nu > -1 && material->nu <= 0.5))
        deck_error(reader, line->field[last].place, "Poisson ratio nu is %s, expected above -1 and at most 0.5",
                   line->field[last].text);
}

void deck_density(struct deck_reader *reader, const struct card *card)
{
    const char *layout = reader->layout;
    struct material *material = current_material(reader, card, 2);
    if (material && deck_lines(reader, card, 1, 1, layout) == 1)
        (void)deck_read_values(reader, &card->line[0], deck_density_rows, layout, material);
}

int deck_add_group(struct deck_reader *reader, const struct card *card)
{
    struct rotor *rotor = &reader->job->rotor;
    const char *name = deck_option(reader, card, "NAME", "name"),
               *of = deck_option(reader, card, "MATERIAL", "name of a material");
    int material = of ? deck_find_material(reader, of) : -1;
    if (of && material < 0)
        deck_error(reader, card_option(card, "MATERIAL")->value_place,
                   "material %s is not defined, expected the name of a *MATERIAL", of);
    for (int g = 0; name && g < rotor->ngroup; g++)
        if (same_text(rotor->group[g].name, name)) {
            deck_error(reader, card_option(card, "NAME")->value_place, "the name %s is given twice, expected a new one", name);
            return -1;
        }
    struct group *group = DECK_APPEND(reader, rotor->group, rotor->ngroup, reader->group_room);
    struct place *place = DECK_APPEND(reader, reader->group_place, rotor->ngroup, reader->group_place_room);
    if (!group || !place)
        return -1;
    *group = (struct group){.name = name ? name : "", .layer_of = -1};
    *place = card->place;
    if (material >= 0)
        group->material = reader->material[material];
    return rotor->ngroup++;
}

static struct segment *add_segment(struct deck_reader *reader, int group)
{
    struct rotor *rotor = &reader->job->rotor;
    struct segment *segment = DECK_APPEND(reader, rotor->segment, rotor->nsegment, reader->segment_room);
    if (segment) {
        *segment =
            (struct segment){.group = group, .length = 1e6, .elements = 1}; /* where an error follows: every position is inside */
        rotor->nsegment++;
    }
    return segment;
}

/* A section that states no elements has some until those of all are chosen. */
static void settle_elements(struct deck_reader *reader, struct segment *s)
{
    if (s->elements)
        return;
    s->elements = 1;
    int *open = DECK_APPEND(reader, reader->open_section, reader->nopen, reader->open_room);
    if (open) {
        *open = (int)(s - reader->job->rotor.segment);
        reader->nopen++;
    }
}

void deck_shaft(struct deck_reader *reader, const struct card *card)
{
    const char *layout = reader->layout;
    int group = deck_add_group(reader, card), count = deck_lines(reader, card, 1, DECK_MOST_LINES, layout);
    for (int i = 0; i < count && group >= 0; i++) {
        const struct data_line *line = &card->line[i];
        struct segment *s = add_segment(reader, group);
        if (!s)
            return;
        s->elements = 0;
        int bad = deck_read_values(reader, line, deck_shaft_rows, layout, s);
        settle_elements(reader, s);
        if (!bad && s->inner >= s->outer)
            deck_error(reader, line->field[2].place,
                       "inner diameter %.12g m is not below the outer diameter %.12g m, expected a smaller one", s->inner,
                       s->outer);
        else if (!bad && (s->stiff_outer > s->outer || s->stiff_outer <= s->inner))
            deck_error(reader, line->field[4].place,
                       "the diameter that carries stiffness is %.12g m, expected above the inner and at most the outer diameter",
                       s->stiff_outer);
    }
}

void deck_beam(struct deck_reader *reader, const struct card *card)
{
    const char *layout = reader->layout;
    int group = deck_add_group(reader, card), count = deck_lines(reader, card, 1, DECK_MOST_LINES, layout);
    for (int i = 0; i < count && group >= 0; i++) {
        struct segment *s = add_segment(reader, group);
        if (!s)
            return;
        s->rectangular = 1;
        s->elements = 0;
        (void)deck_read_values(reader, &card->line[i], deck_beam_rows, layout, s);
        settle_elements(reader, s);
    }
}
