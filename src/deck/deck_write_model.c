/* The cards of the rotor. */
#include "deck/deck_writer.h"

/* A material of its own for every group and bundle: what is identified of one leaves the others alone. */
static void write_material(struct deck_writer *w, const char *owner, const struct material *material)
{
    deck_put_card(w, "MATERIAL");
    deck_put_option(w, "NAME", owner);
    deck_put(w, material->isotropic ? "\n*ELASTIC\n" : "\n*ELASTIC, TYPE=SHEAR\n");
    deck_put_number(w, "", material->e);
    if (!material->isotropic)
        deck_put_number(w, ", ", material->g);
    deck_put_number(w, ", ", material->nu);
    deck_put_number(w, "\n*DENSITY\n", material->rho);
    deck_put(w, "\n");
}

static void write_segment(struct deck_writer *w, const struct segment *s)
{
    deck_put_number(w, "", s->length);
    deck_put_number(w, ", ", s->rectangular ? s->height : s->outer);
    deck_put_number(w, ", ", s->rectangular ? s->width : s->inner);
    deck_put(w, ", %d", s->elements);
    if (!s->rectangular && s->stiff_outer != s->outer)
        deck_put_number(w, ", ", s->stiff_outer);
    deck_put(w, "\n");
}

static void write_groups(struct deck_writer *w)
{
    const struct rotor *rotor = &w->rotor;
    for (int g = 0, s = 0; g < rotor->ngroup; g++) {
        const struct group *group = &rotor->group[g];
        write_material(w, group->name, &group->material);
        deck_put_card(w, s < rotor->nsegment && rotor->segment[s].rectangular ? "BEAM" : "SHAFT");
        deck_put_option(w, "NAME", group->name);
        deck_put_option(w, "MATERIAL", group->name);
        deck_put(w, "\n");
        for (; s < rotor->nsegment && rotor->segment[s].group == g; s++)
            write_segment(w, &rotor->segment[s]);
        if (group->holes) {
            deck_put_card(w, "PERFORATION");
            deck_put_option(w, "GROUP", group->name);
            deck_put(w, "\n%d", group->holes);
            deck_put_number(w, ", ", group->hole_diameter);
            deck_put_number(w, ", ", group->hole_pitch);
            deck_put(w, "\n");
        }
        if (group->preload != 0) {
            deck_put_card(w, "PRELOAD");
            deck_put_option(w, "GROUP", group->name);
            deck_put_number(w, "\n", group->preload);
            deck_put(w, "\n");
        }
    }
}

static void write_bundle(struct deck_writer *w, int number, double diameter, double pitch)
{
    deck_put(w, "\n%d", number);
    deck_put_number(w, ", ", diameter);
    deck_put_number(w, ", ", pitch);
}

static void write_tierod(struct deck_writer *w, const struct tierod *rod)
{
    write_material(w, rod->name, &rod->material);
    deck_put_card(w, "TIEROD");
    deck_put_option(w, "NAME", rod->name);
    deck_put_option(w, "MATERIAL", rod->name);
    deck_put_option_number(w, "FROM", rod->from);
    deck_put_option_number(w, "TO", rod->to);
    deck_put_option(w, "MODEL", rod->model == BUNDLE_TUBE ? "TUBE" : "RODS");
    deck_put_option(w, "SELF_EQUILIBRATED", rod->self_equilibrated ? "YES" : "NO");
    write_bundle(w, rod->number, rod->diameter, rod->pitch);
    deck_put_number(w, ", ", rod->tension);
    deck_put(w, ", %d\n", rod->elements);
}

static void write_bars(struct deck_writer *w, const struct bars *bars)
{
    write_material(w, bars->name, &bars->material);
    deck_put_card(w, "BARS");
    deck_put_option(w, "NAME", bars->name);
    deck_put_option(w, "MATERIAL", bars->name);
    deck_put_option_number(w, "CENTER", bars->center);
    deck_put_option_number(w, "LENGTH", bars->length);
    deck_put_option(w, "MODEL", bars->model == BUNDLE_TUBE ? "TUBE" : "RODS");
    write_bundle(w, bars->number, bars->diameter, bars->pitch);
    deck_put(w, ", %d\n", bars->elements);
}

/* Those without a name share a card with the ones before. */
static void begin_point(struct deck_writer *w, const char *card, const char *name, int goes_on)
{
    if (goes_on)
        return;
    deck_put_card(w, card);
    if (name)
        deck_put_option(w, "NAME", name);
    deck_put(w, "\n");
}

static void write_points(struct deck_writer *w)
{
    const struct rotor *rotor = &w->rotor;
    for (int i = 0; i < rotor->ndisk; i++) {
        const struct disk *disk = &rotor->disk[i];
        begin_point(w, "DISK", disk->name, i && !disk->name && !disk[-1].name);
        deck_put_number(w, "", disk->position);
        deck_put_number(w, ", ", disk->mass);
        deck_put_number(w, ", ", disk->diametral);
        deck_put_number(w, ", ", disk->polar);
        deck_put(w, "\n");
    }
    for (int i = 0; i < rotor->nspring; i++) {
        const struct spring *spring = &rotor->spring[i];
        begin_point(w, "SPRING", spring->name, i && !spring->name && !spring[-1].name);
        deck_put_number(w, "", spring->position);
        deck_put_number(w, ", ", spring->lateral);
        deck_put_number(w, ", ", spring->rotational);
        deck_put(w, "\n");
    }
    if (rotor->sling > 0) {
        deck_put_card(w, "SLING");
        deck_put_option_number(w, "LENGTH", rotor->sling);
        deck_put(w, "\n");
    }
}

void deck_write_model(struct deck_writer *w)
{
    write_groups(w);
    for (int i = 0; i < w->rotor.ntierod; i++)
        write_tierod(w, &w->rotor.tierod[i]);
    for (int i = 0; i < w->rotor.nbars; i++)
        write_bars(w, &w->rotor.bars[i]);
    write_points(w);
}
