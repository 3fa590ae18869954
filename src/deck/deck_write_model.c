/* The cards of the rotor. */
#include "deck/card_table.h"

/* A material of its own for every group and bundle: what is identified of one leaves the others alone. */
static void write_material(struct deck_writer *w, const char *owner, const struct material *material)
{
    deck_put_card(w, "MATERIAL");
    deck_put_option(w, "NAME", owner);
    deck_write_values(w,
                      material->isotropic   ? "\n*ELASTIC\n"
                      : material->laminated ? "\n*ELASTIC, TYPE=LAMINATED\n"
                                            : "\n*ELASTIC, TYPE=SHEAR\n",
                      material->isotropic   ? deck_elastic_rows
                      : material->laminated ? deck_laminated_rows
                                            : deck_shear_rows,
                      material);
    deck_write_values(w, "*DENSITY\n", deck_density_rows, material);
}

static void begin_of_group(struct deck_writer *w, const char *card, const struct group *group)
{
    deck_put_card(w, card);
    deck_put_option(w, "GROUP", group->name);
}

static void write_perforation(struct deck_writer *w, const struct group *group)
{
    if (!group->holes)
        return;
    begin_of_group(w, "PERFORATION", group);
    deck_write_values(w, "\n", deck_perforation_rows, group);
}

static void write_groups(struct deck_writer *w)
{
    const struct rotor *rotor = &w->rotor;
    for (int g = 0, s = 0; g < rotor_axis_groups(rotor); g++) {
        const struct group *group = &rotor->group[g];
        int is_beam = s < rotor->nsegment && rotor->segment[s].rectangular;
        write_material(w, group->name, &group->material);
        deck_put_card(w, is_beam ? "BEAM" : "SHAFT");
        deck_put_option(w, "NAME", group->name);
        deck_put_option(w, "MATERIAL", group->name);
        deck_put(w, "\n");
        for (; s < rotor->nsegment && rotor->segment[s].group == g; s++)
            deck_write_values(w, "", is_beam ? deck_beam_rows : deck_shaft_rows, &rotor->segment[s]);
        write_perforation(w, group);
        if (group->preload != 0) {
            begin_of_group(w, "PRELOAD", group);
            deck_put_number(w, "\n", group->preload);
            deck_put(w, "\n");
        }
    }
}

static void write_layers(struct deck_writer *w)
{
    const struct rotor *rotor = &w->rotor;
    for (int g = rotor_axis_groups(rotor); g < rotor->ngroup; g++) {
        const struct group *group = &rotor->group[g];
        write_material(w, group->name, &group->material);
        deck_put_card(w, "LAYER");
        deck_put_option(w, "NAME", group->name);
        deck_put_option(w, "GROUP", rotor->group[group->layer_of].name);
        deck_put_option(w, "MATERIAL", group->name);
        deck_put(w, "\n");
        for (int i = 0; i < rotor->nring; i++)
            if (rotor->ring[i].group == g)
                deck_write_values(w, "", deck_layer_rows, &rotor->ring[i]);
        write_perforation(w, group);
    }
}

static void write_bundle(struct deck_writer *w, const char *card, const char *name, const struct material *material,
                         const struct deck_row *row, const void *bundle)
{
    write_material(w, name, material);
    deck_put_card(w, card);
    deck_write_options(w, row, bundle);
    deck_write_values(w, "\n", row, bundle);
}

void deck_write_model(struct deck_writer *w)
{
    const struct rotor *rotor = &w->rotor;
    write_groups(w);
    write_layers(w);
    for (int i = 0; i < rotor->ntierod; i++)
        write_bundle(w, "TIEROD", rotor->tierod[i].name, &rotor->tierod[i].material, deck_tierod_rows, &rotor->tierod[i]);
    for (int i = 0; i < rotor->nbars; i++)
        write_bundle(w, "BARS", rotor->bars[i].name, &rotor->bars[i].material, deck_bars_rows, &rotor->bars[i]);
    for (const struct deck_card *kind = deck_card_table; kind->name; kind++)
        if (!kind->read)
            deck_write_list(w, kind);
    if (rotor->sling > 0) {
        deck_put_card(w, "SLING");
        deck_write_options(w, deck_sling_rows, rotor);
        deck_put(w, "\n");
    }
}
