#include "hide_rotor.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define MOST_FIELDS 8

/* SET of the stiffness of a spring, until the springs are there. */
struct later {
    const char *name, *quantity;
    double value;
    int number; /* of the line */
};

struct reader {
    const struct hide_cards *cards;
    const struct hide_card *card;
    const char *deck; /* its name */
    struct hide_rotor *rotor;
    const struct hide_message *message;
    int number; /* of the line being read */
    int sets;
    struct later set[2 * HIDE_MOST_ATTACHED];
};

static int expected(const struct reader *r, const char *what)
{
    return hide_fail(r->message, HIDE_INPUT, "%s:%d: *%s: expected %s", r->deck, r->number, r->card->name, what);
}

/* Data line i as numbers; the first `words` fields are left as texts in word. Fields beyond those given stay as they were. */
static int read_line(struct reader *r, int i, int words, char **word, int least, int most, double *value, const char *what)
{
    char *field[MOST_FIELDS];
    const struct hide_line *line = &r->cards->line[r->card->first + i];
    r->number = line->number;
    int count = hide_fields(line->text, MOST_FIELDS, field);
    if (count < words + least || count > words + most)
        return expected(r, what);
    for (int k = 0; k < words; k++)
        word[k] = field[k];
    for (int k = words; k < count; k++)
        if (!hide_read_number(field[k], &value[k - words]))
            return expected(r, what);
    return HIDE_OK;
}

static int take_name(const struct reader *r, const char *option, char name[HIDE_NAME])
{
    const char *value = hide_card_option(r->card, option);
    name[0] = 0;
    if (value && strlen(value) >= HIDE_NAME)
        return expected(r, "a shorter name");
    if (value)
        memcpy(name, value, strlen(value) + 1);
    return HIDE_OK;
}

static int find_material(const struct reader *r, struct hide_material *material)
{
    const char *name = hide_card_option(r->card, "MATERIAL");
    for (int i = 0; name && i < r->rotor->materials; i++)
        if (hide_same(r->rotor->material[i].name, name)) {
            *material = r->rotor->material[i];
            return material->e > 0 && material->rho > 0 ? HIDE_OK : expected(r, "a material with *ELASTIC and *DENSITY");
        }
    return expected(r, "MATERIAL= one that the deck has");
}

static int read_material(struct reader *r)
{
    if (r->rotor->materials == HIDE_MOST_GROUPS)
        return expected(r, "fewer materials");
    return take_name(r, "NAME", r->rotor->material[r->rotor->materials++].name);
}

static int read_elastic(struct reader *r)
{
    const char *type = hide_card_option(r->card, "TYPE");
    int laminated = type && hide_same(type, "LAMINATED"), shear = laminated || (type && hide_same(type, "SHEAR"));
    double value[5] = {0};
    if (type && !shear && !hide_same(type, "ISOTROPIC"))
        return expected(r, "TYPE=ISOTROPIC, SHEAR or LAMINATED: this program has no others");
    if (!r->rotor->materials || r->card->lines != 1)
        return expected(r, "*MATERIAL before it and one data line");
    int status = laminated ? read_line(r, 0, 0, NULL, 4, 5, value, "E, G, E and nu of a sheet [, stacking factor]")
                           : read_line(r, 0, 0, NULL, shear ? 3 : 2, shear ? 3 : 2, value, shear ? "E, G, nu" : "E, nu");
    struct hide_material *m = &r->rotor->material[r->rotor->materials - 1];
    m->e = value[0];
    m->g = shear ? value[1] : 0;
    m->sheet_e = laminated ? value[2] : 0;
    m->stacking = laminated && value[4] > 0 ? value[4] : 1;
    m->nu = laminated ? value[3] : shear ? value[2] : value[1];
    m->isotropic = !shear;
    if (!status && !(m->e > 0 && (!shear || m->g > 0) && (!laminated || m->sheet_e > 0) && m->nu > -1 && m->nu <= 0.5))
        return expected(r, "moduli above zero and nu above -1, at most 0.5");
    return status;
}

static int read_density(struct reader *r)
{
    double rho = 0;
    if (!r->rotor->materials || r->card->lines != 1)
        return expected(r, "*MATERIAL before it and one data line");
    int status = read_line(r, 0, 0, NULL, 1, 1, &rho, "a density");
    r->rotor->material[r->rotor->materials - 1].rho = rho;
    return status ? status : rho > 0 ? HIDE_OK : expected(r, "a density above zero");
}

/* SHAFT and BEAM: the groups end to end */
static int read_group(struct reader *r)
{
    struct hide_rotor *rotor = r->rotor;
    int rectangular = hide_same(r->card->name, "BEAM"), status;
    if (rotor->groups == HIDE_MOST_GROUPS)
        return expected(r, "fewer groups");
    struct hide_group *group = &rotor->group[rotor->groups];
    if ((status = take_name(r, "NAME", group->name)) || (status = find_material(r, &group->material)))
        return status;
    if (!group->name[0] || hide_find_group(rotor, group->name) >= 0 || !r->card->lines)
        return expected(r, "a name of its own and a data line");
    group->from = rotor->length;
    for (int i = 0; i < r->card->lines; i++) {
        double v[5] = {0, 0, 0, 0, 0};
        const char *what = rectangular ? "length, height, width, elements" : "length, outer, inner diameter, elements [, stiff]";
        if (rotor->segments == HIDE_MOST_SEGMENTS)
            return expected(r, "fewer sections");
        if ((status = read_line(r, i, 0, NULL, 4, rectangular ? 4 : 5, v, what)))
            return status;
        struct hide_segment *s = &rotor->segment[rotor->segments++];
        *s = (struct hide_segment){.group = rotor->groups, .rectangular = rectangular, .from = rotor->length};
        s->to = rotor->length += v[0];
        if (rectangular) {
            s->height = v[1];
            s->width = v[2];
        } else {
            s->outer = v[1];
            s->inner = v[2];
            s->stiff = v[4] > 0 ? v[4] : v[1];
        }
        if (!(v[0] > 0 && v[1] > 0) || (rectangular ? !(v[2] > 0) : !(v[2] >= 0 && s->stiff > v[2] && s->stiff <= v[1])))
            return expected(r, what);
    }
    group->to = rotor->length;
    rotor->shafts = ++rotor->groups;
    return HIDE_OK;
}

/* LAYER: a ring of each section of a group, or of all the same */
static int read_layer(struct reader *r)
{
    struct hide_rotor *rotor = r->rotor;
    const char *name = hide_card_option(r->card, "GROUP");
    int around = name ? hide_find_group(rotor, name) : -1, line = 0, status;
    double v[2] = {0, 0};
    if (rotor->groups == HIDE_MOST_GROUPS || around < 0 || around >= rotor->shafts || !r->card->lines)
        return expected(r, "GROUP= a shaft that the deck has, a data line, and fewer layers");
    struct hide_group *group = &rotor->group[rotor->groups];
    *group = (struct hide_group){.from = rotor->group[around].from, .to = rotor->group[around].to};
    if ((status = take_name(r, "NAME", group->name)) || (status = find_material(r, &group->material)))
        return status;
    for (int i = 0; i < rotor->segments; i++) {
        struct hide_segment *s = &rotor->segment[i];
        if (s->group != around)
            continue;
        if (s->rings == HIDE_MOST_RINGS || s->rectangular || (line == r->card->lines && line > 1))
            return expected(r, "a line for all sections or one for each, round ones, and fewer layers");
        if (line < r->card->lines && (status = read_line(r, line++, 0, NULL, 2, 2, v, "outer, inner diameter")))
            return status;
        if (!(v[1] >= 0 && v[0] > v[1]))
            return expected(r, "an outer diameter above the inner one");
        s->ring[s->rings++] = (struct hide_ring){rotor->groups, v[0], v[1]};
    }
    rotor->groups++;
    return HIDE_OK;
}

/* PERFORATION and PRELOAD: of a group */
static int read_of_group(struct reader *r)
{
    const char *name = hide_card_option(r->card, "GROUP");
    int index = name ? hide_find_group(r->rotor, name) : -1, status;
    double v[3] = {0};
    if (index < 0 || r->card->lines != 1)
        return expected(r, "GROUP= one that the deck has, and one data line");
    struct hide_group *group = &r->rotor->group[index];
    if (hide_same(r->card->name, "PRELOAD")) {
        status = read_line(r, 0, 0, NULL, 1, 1, v, "a force");
        group->preload += v[0];
        return status;
    }
    if ((status = read_line(r, 0, 0, NULL, 3, 3, v, "number, diameter and pitch radius of the holes")))
        return status;
    group->holes = (int)v[0];
    group->hole_diameter = v[1];
    group->hole_pitch = v[2];
    return group->holes >= 3 && v[1] > 0 && v[2] > 0 ? HIDE_OK : expected(r, "3 holes or more, with diameter and pitch radius");
}

static int read_tie(struct reader *r)
{
    const char *from = hide_card_option(r->card, "FROM"), *to = hide_card_option(r->card, "TO");
    const char *model = hide_card_option(r->card, "MODEL"), *own = hide_card_option(r->card, "SELF_EQUILIBRATED");
    double v[5] = {0, 0, 0, 0, 1};
    int status;
    if (r->rotor->ties == HIDE_MOST_TIES)
        return expected(r, "fewer tie rods");
    struct hide_tie *tie = &r->rotor->tie[r->rotor->ties];
    if ((status = take_name(r, "NAME", tie->name)) || (status = find_material(r, &tie->material)))
        return status;
    if (!from || !to || !hide_position(r->rotor, from, &tie->from) || !hide_position(r->rotor, to, &tie->to) ||
        !(tie->to > tie->from) || r->card->lines != 1)
        return expected(r, "FROM and TO inside the rotor, and one data line");
    if ((status = read_line(r, 0, 0, NULL, 4, 5, v, "number, diameter, pitch radius, tension [, elements]")))
        return status;
    tie->tube = model && hide_same(model, "TUBE");
    tie->equilibrated = !own || !hide_same(own, "NO");
    tie->number = (int)v[0];
    tie->diameter = v[1];
    tie->pitch = v[2];
    tie->tension = v[3];
    r->rotor->ties++;
    if (!(v[0] >= 3 && v[1] > 0 && v[2] > 0))
        return expected(r, "3 rods or more, with diameter and pitch radius");
    if (v[4] > 1 || !tie->material.isotropic) /* the oracle's rods */
        return expected(r, "one element, and an isotropic material: this program has no others");
    return HIDE_OK;
}

/* DISK and SPRING: position and up to five numbers */
static int read_attached(struct reader *r)
{
    struct hide_rotor *rotor = r->rotor;
    int disk = hide_same(r->card->name, "DISK"), status;
    for (int i = 0; i < r->card->lines; i++) {
        char *position, name[HIDE_NAME];
        double v[5] = {0}, z;
        if ((disk ? rotor->disks : rotor->springs) == HIDE_MOST_ATTACHED)
            return expected(r, "fewer of them");
        if ((status = take_name(r, "NAME", name)) ||
            (status = read_line(r, i, 1, &position, 1, disk ? 5 : 2, v, "a position and numbers")))
            return status;
        if (!hide_position(rotor, position, &z) || v[0] < 0 || v[1] < 0)
            return expected(r, "a position inside the rotor and numbers not below zero");
        if (disk && ((v[3] > 0) != (v[4] > 0) || v[3] < 0 || v[4] < 0))
            return expected(r, "a hub with length and outer diameter above zero, or none");
        if (disk) {
            rotor->disk[rotor->disks] =
                (struct hide_disk){.z = z, .mass = v[0], .inertia = v[1], .hub_length = v[3], .hub = v[4]};
            memcpy(rotor->disk[rotor->disks++].name, name, sizeof name);
        } else {
            rotor->spring[rotor->springs] = (struct hide_spring){.z = z, .lateral = v[0], .rotational = v[1]};
            memcpy(rotor->spring[rotor->springs++].name, name, sizeof name);
        }
    }
    return HIDE_OK;
}

static int read_sling(struct reader *r)
{
    const char *length = hide_card_option(r->card, "LENGTH");
    return length && hide_read_number(length, &r->rotor->sling) && r->rotor->sling > 0 ? HIDE_OK
                                                                                       : expected(r, "LENGTH above zero");
}

static int read_sensors(struct reader *r)
{
    int status;
    for (int i = 0; i < r->card->lines; i++) {
        char *word[2];
        double id, z;
        if (r->rotor->sensors == HIDE_MOST_SENSORS)
            return expected(r, "fewer sensors");
        if ((status = read_line(r, i, 2, word, 0, 0, NULL, "id, position")))
            return status;
        if (!hide_read_number(word[0], &id) || id < 1 || id > 1e9 || id != floor(id) || !hide_position(r->rotor, word[1], &z) ||
            hide_find_sensor(r->rotor, (long)id) >= 0)
            return expected(r, "an id of its own and a position inside the rotor");
        r->rotor->sensor[r->rotor->sensors++] = (struct hide_sensor){(long)id, z};
    }
    return HIDE_OK;
}

static int read_identify(struct reader *r)
{
    int status;
    for (int i = 0; i < r->card->lines; i++) {
        char *name;
        double v[3];
        if (r->rotor->parameters == HIDE_MOST_PARAMETERS)
            return expected(r, "fewer parameters");
        if ((status = read_line(r, i, 1, &name, 3, 3, v, "parameter, lower bound, upper bound, start")))
            return status;
        struct hide_parameter *p = &r->rotor->parameter[r->rotor->parameters++];
        *p = (struct hide_parameter){.lower = v[0], .upper = v[1], .start = v[2]};
        if ((size_t)snprintf(p->name, sizeof p->name, "%s", name) >= sizeof p->name || !(v[0] < v[1]))
            return expected(r, "a parameter with a lower bound below its upper one");
    }
    return HIDE_OK;
}

static int is_stiffness(const char *quantity)
{
    return hide_same(quantity, "k") || hide_same(quantity, "k_rot");
}

/* SET of the length of a group: its sections in proportion, and what lies to its right moves. That of a spring waits. */
static int read_set(struct reader *r)
{
    struct hide_rotor *rotor = r->rotor;
    for (int i = 0; i < r->card->lines; i++) {
        char *name, *dot;
        double length = 0;
        int group, status;
        if ((status = read_line(r, i, 1, &name, 1, 1, &length, "GROUP.length, value")))
            return status;
        dot = strrchr(name, '.');
        if (!dot || !(hide_same(dot + 1, "length") || is_stiffness(dot + 1)) || !(length > 0) ||
            r->sets == 2 * HIDE_MOST_ATTACHED)
            return expected(r, "GROUP.length, SPRING.k or SPRING.k_rot and a value above zero: this program cannot follow "
                               "another one");
        *dot = 0;
        if (is_stiffness(dot + 1)) {
            r->set[r->sets++] = (struct later){name, dot + 1, length, r->number};
            continue;
        }
        if ((group = hide_find_group(rotor, name)) < 0)
            return expected(r, "a group that the deck has");
        double from = rotor->group[group].from, to = rotor->group[group].to, factor = length / (to - from);
        for (int k = 0; k < rotor->segments; k++) {
            double *end[] = {&rotor->segment[k].from, &rotor->segment[k].to};
            for (int e = 0; e < 2; e++)
                *end[e] = *end[e] >= to    ? *end[e] + from + length - to
                          : *end[e] > from ? from + (*end[e] - from) * factor
                                           : *end[e];
        }
        for (int k = 0; k < rotor->groups; k++) {
            double *end[] = {&rotor->group[k].from, &rotor->group[k].to};
            for (int e = 0; e < 2; e++)
                *end[e] = *end[e] >= to ? *end[e] + from + length - to : *end[e];
        }
        rotor->length += length - (to - from);
    }
    return HIDE_OK;
}

/* The values that SET gives springs. */
static int set_springs(struct reader *r)
{
    struct hide_rotor *rotor = r->rotor;
    for (int i = 0; i < r->sets; i++) {
        const struct later *set = &r->set[i];
        int s = 0;
        while (s < rotor->springs && !hide_same(rotor->spring[s].name, set->name))
            s++;
        if (s == rotor->springs)
            return hide_fail(r->message, HIDE_INPUT, "%s:%d: *SET: expected a spring that the deck has", r->deck, set->number);
        *(hide_same(set->quantity, "k") ? &rotor->spring[s].lateral : &rotor->spring[s].rotational) = set->value;
    }
    return HIDE_OK;
}

static int refuse(struct reader *r)
{
    return expected(r, "a deck without this card: this program cannot follow it");
}

/* What a card is read by, and when: groups need materials, what is attached needs groups. */
static const struct {
    const char *name;
    int pass;
    int (*read)(struct reader *);
} table[] = {{"HEADING", 0, NULL},
             {"MODES", 0, NULL}, /* data come from this program */
             {"SHAPE", 0, NULL},
             {"MEASURED", 0, NULL},
             {"NOISE", 0, NULL},
             {"FIT", 0, NULL},
             {"FRF", 0, NULL},
             {"FREQUENCIES", 0, NULL},
             {"INCLUDE", 0, refuse},
             {"BARS", 0, refuse}, /* the oracle has no branches */
             {"CAUSE", 0, refuse},
             {"MATERIAL", 0, read_material},
             {"ELASTIC", 0, read_elastic},
             {"DENSITY", 0, read_density},
             {"SHAFT", 1, read_group},
             {"SET", 2, read_set}, /* before anything refers to positions */
             {"LAYER", 3, read_layer},
             {"BEAM", 1, read_group},
             {"PERFORATION", 3, read_of_group},
             {"PRELOAD", 3, read_of_group},
             {"TIEROD", 3, read_tie},
             {"DISK", 3, read_attached},
             {"SPRING", 3, read_attached},
             {"SLING", 3, read_sling},
             {"SENSORS", 3, read_sensors},
             {"IDENTIFY", 3, read_identify}};

#define KINDS ((int)(sizeof table / sizeof *table))

int hide_rotor_read(const struct hide_cards *cards, const char *name, struct hide_rotor *rotor,
                    const struct hide_message *message)
{
    struct reader r = {.cards = cards, .deck = name, .rotor = rotor, .message = message};
    for (int pass = 0; pass < 4; pass++)
        for (int i = 0; i < cards->cards; i++) {
            int kind = 0, status;
            r.card = &cards->card[i];
            r.number = r.card->number;
            while (kind < KINDS && !hide_same(table[kind].name, r.card->name))
                kind++;
            if (kind == KINDS)
                return expected(&r, "a card of docs/deck.md");
            if (table[kind].read && table[kind].pass == pass && (status = table[kind].read(&r)))
                return status;
        }
    if (!rotor->groups)
        return hide_fail(message, HIDE_INPUT, "%s: no *SHAFT and no *BEAM, expected one", name);
    return set_springs(&r);
}
