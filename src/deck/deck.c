#include "deck/deck_row.h"

/* Beside the whole rotor; ten times and more from where solutions fail. */
#define SHORTEST 1e-7
#define THINNEST 1e-4 /* of the largest diameter: EI falls by its fourth power */
#define STIFFEST 1e13 /* times EI/L^3 */
#define HEAVIEST 1e7
#define SOFTEST  1e6 /* between the moduli of two materials */

#define LAST_PHASE 8

void deck_check_options(struct deck_reader *reader, const struct card *card, const struct deck_row *rows)
{
    char list[256] = "";
    for (const struct deck_row *row = rows; !deck_row_is_last(row); row++)
        if (row->option)
            (void)snprintf(list + strlen(list), sizeof list - strlen(list), "%s%s", *list ? ", " : "", row->option);
    for (int i = 0; i < card->noption; i++) {
        int known = 0;
        for (const struct deck_row *row = rows; !deck_row_is_last(row); row++)
            known |= row->option && same_text(row->option, card->option[i].name);
        if (!known)
            deck_error(reader, card->option[i].place, "option %s of *%s is not known, expected %s", card->option[i].name,
                       card->name, *list ? list : "none");
    }
}

void deck_check_names(struct deck_reader *reader, const struct card *card)
{
    if (!card->kind) {
        const char *near = text_nearest(card->name, deck_card_table, sizeof *deck_card_table);
        if (strpbrk(card->name, "\t;=")) {
            deck_error(reader, card->place, "card *%s is not known, expected commas between a card and its options", card->name);
            return;
        }
        deck_error(reader, card->place, "card *%s is not known, expected %s*%s", card->name,
                   near ? "" : "one of docs/deck.md such as ", near ? near : "SHAFT");
        return;
    }
    deck_check_options(reader, card, card->kind->row);
}

static void check_materials(struct deck_reader *reader)
{
    for (int m = 0; m < reader->nmaterial; m++)
        for (int bit = 0; bit < 2; bit++)
            if (!(reader->material_complete[m] >> bit & 1))
                deck_error(reader, reader->place[MATERIAL_PLACES][m], "material %s has no *%s, expected one behind *MATERIAL",
                           reader->material[m].name, bit ? "DENSITY" : "ELASTIC");
}

/* Whether the NAMEs of two cards are of one set. Parameters are addressed by name, so groups (phases 2 and 3), rods, springs,
 * disks and causes share one, but for two groups, which are compared where they are made; materials and states have their own,
 * and of the machine bearings and probes. */
static int share_names(const struct deck_card *a, const struct deck_card *b, int machine)
{
    if (!a || !b || machine)
        return a && a == b && a->states == CARD_OF_MACHINE;
    return a->phase > 1 && b->phase > 1 && a->phase < LAST_PHASE && b->phase < LAST_PHASE && (a->phase > 3 || b->phase > 3);
}

void deck_check_unique(struct deck_reader *reader, int ncard, const struct card *card, int machine)
{
    for (int c = 0; c < ncard; c++) {
        const struct card_option *option = card_option(&card[c], "NAME"), *other;
        for (int d = 0; d < c && option; d++)
            if (share_names(card[c].kind, card[d].kind, machine) && (other = card_option(&card[d], "NAME")) &&
                same_text(option->value, other->value))
                deck_error(reader, option->value_place, "the name %s is given twice, expected a new one", option->value);
    }
}

/* TIE=E:G makes the groups of an unknown E isotropic: their G is no unknown. 0, or 1 after an error. */
static int tie_groups(struct deck_reader *reader, const struct parameter *young, const char *name)
{
    struct job *job = reader->job;
    for (int g = 0; g < job->rotor.ngroup; g++) {
        struct group *group = &job->rotor.group[g];
        if (!parameter_is_of_group(young, g))
            continue;
        if (group->material.laminated)
            return deck_error(reader, card_option(reader->fit_card, "TIE")->value_place,
                              "TIE=E:G has no meaning for the sheets of %s, expected a material of another type", group->name);
        group->material.isotropic = 1;
        for (int q = job->unknowns.nparameter - 1; q >= 0; q--)
            if (job->unknowns.parameter[q].kind == PARAMETER_G && parameter_is_of_group(&job->unknowns.parameter[q], g)) {
                deck_note(reader, reader->identify_card->place, "%s follows %s and is not identified (TIE=E:G)",
                          job->unknowns.bounds[q].name, name);
                deck_drop_unknown(reader, q);
            }
    }
    return 0;
}

/* G of its own where it is identified, G = E/2(1+nu) where TIE asks for it. */
static void tie_moduli(struct deck_reader *reader)
{
    struct job *job = reader->job;
    for (int p = 0; p < job->unknowns.nparameter && reader->tie; p++) {
        struct parameter young = job->unknowns.parameter[p];
        const char *name = job->unknowns.bounds[p].name;
        if (young.kind != PARAMETER_E)
            continue;
        if (tie_groups(reader, &young, name))
            return;
        while (p >= job->unknowns.nparameter || job->unknowns.bounds[p].name != name)
            p--; /* those dropped stood in front */
    }
    for (int p = 0; p < job->unknowns.nparameter; p++) {
        const struct parameter *shear = &job->unknowns.parameter[p];
        if (shear->kind != PARAMETER_G)
            continue;
        if (reader->tie)
            deck_error(reader, card_option(reader->fit_card, "TIE")->value_place,
                       "TIE=E:G, but %s is identified without E of that group, expected E in its place",
                       job->unknowns.bounds[p].name);
        for (int g = 0; g < job->rotor.ngroup; g++) {
            struct material *material = &job->rotor.group[g].material;
            if (!parameter_is_of_group(shear, g))
                continue;
            material->g = material_shear_modulus(material);
            material->isotropic = 0;
        }
    }
}

/* Without a word from the user: what can be trusted. */
static void choose_functional(struct deck_reader *reader)
{
    struct job *job = reader->job;
    struct place place = reader->fit_card ? reader->fit_card->place : reader->text.end;
    int known = job_knows_frequency_noise(job);
    if (!job->options.has_fit)
        job->options.fit.functional = known ? ROTID_LIKELIHOOD : ROTID_HYBRID;
    if (job->measurement.nmode && job->options.fit.functional == ROTID_LIKELIHOOD && !known)
        deck_error(reader, place,
                   "FUNCTIONAL=LIKELIHOOD weighs by the noise of the frequencies, expected *NOISE, FREQUENCY=relative standard "
                   "deviation");
    if (reader->weighed_card && job->options.fit.functional != ROTID_LIKELIHOOD)
        deck_note(reader, reader->weighed_card->place,
                  "*%s is compared with the fitted model and not fitted: FUNCTIONAL=LIKELIHOOD does (a diagnosis in any case)",
                  reader->weighed_card->name);
    if (job->options.fit.functional == ROTID_LIKELIHOOD && job->measurement.shape && !job_knows_shape_noise(job)) {
        deck_note(
            reader, place,
            "the shapes pair the modes and are not fitted: their noise is not known (*NOISE, SHAPE=relative standard deviation)");
    }
}

static void check_masters(struct deck_reader *reader)
{
    struct job *job = reader->job;
    struct place place = reader->fit_card ? reader->fit_card->place : reader->text.end;
    int highest = comparison_highest(job);
    if (job->options.fit.reduction != ROTID_REDUCTION_NONE && job->rotor.nsensor && job->rotor.nsensor < 2 * highest)
        deck_error(
            reader, place,
            "%d sensors are too few to condense onto for mode %d, expected at least twice as many as modes, or REDUCTION=NONE",
            job->rotor.nsensor, highest);
}

/* Of the groups, tie rods, bars and sensors, in this order, and of what was measured. */
static int keep_places(struct deck_reader *reader)
{
    const struct rotor *rotor = &reader->job->rotor;
    static const enum deck_places from[] = {GROUP_PLACES, TIEROD_PLACES, BARS_PLACES, SENSOR_PLACES};
    const int count[] = {rotor->ngroup, rotor->ntierod, rotor->nbars, rotor->nsensor};
    const struct card *measured = reader->modes_card ? reader->modes_card : reader->measured_card;
    struct place *to = POOL_ARRAY(reader->pool, struct place, count[0] + count[1] + count[2] + count[3]);
    reader->job->part = to;
    for (int kind = 0; kind < 4 && to; kind++)
        for (int i = 0; i < count[kind]; i++)
            *to++ = reader->place[from[kind]][i];
    if (measured)
        reader->job->measured = measured->place;
    return reader->job->part ? ROTID_OK : ROTID_ERROR_MEMORY;
}

/* Discretises the rotor, for what only the mesh and the sections can tell; the run goes on with that. */
static void check_model(struct deck_reader *reader)
{
    struct job *job = reader->job;
    struct model_size size;
    enum discretisation as = job_discretisation(job);
    int failed = 0, status = keep_places(reader);
    if (!status)
        status = models_begin(reader->pool, as, &job->rotor, &job->models, &size, &failed);
    if (status == ROTID_ERROR_SECTION) {
        reader->no_section = 1;
        deck_error(reader, job_part_place(job, failed), "%s", discrete_refusal(as, &job->rotor, failed));
    } else if (status) {
        reader->pool->out_of_memory = 1;
    }
    int first = 0, same = 0;
    for (int s = 1; s < job->rotor.nsensor && !status; s++)
        if (size.sensor_dof[s] == size.sensor_dof[s - 1] && !same++)
            first = s;
    if (same)
        deck_error(reader, reader->place[SENSOR_PLACES][first],
                   "sensors %d and %d lie at the same node%s, expected one sensor a position, in the unit of the deck's lengths, "
                   "and elements that are shorter than their distance",
                   job->rotor.sensor[first - 1].id, job->rotor.sensor[first].id,
                   same > 1 ? pool_format(reader->pool, ", and %d more pairs do", same - 1) : "");
    int modes = status ? 0 : size.ndof - 2; /* elastic ones, where two motions are free */
    for (int k = 0; k < job->measurement.nmode && !status; k++)
        if (job->measurement.number[k] > modes)
            deck_error(reader, (reader->modes_card ? reader->modes_card : reader->measured_card)->place,
                       "mode %d is measured and the mesh has %d, expected more elements, or mode numbers that count from 1",
                       job->measurement.number[k], modes);
}

/* Elements of the sections that state none. */
static void choose_mesh(struct deck_reader *reader)
{
    struct mesh_choice c;
    struct place place =
        reader->nopen ? reader->place[GROUP_PLACES][reader->job->rotor.segment[reader->open_section[0]].group] : reader->text.end;
    if (!reader->nopen)
        return;
    reader->pool->out_of_memory |= mesh_choose(reader->pool, reader->job, reader->nopen, reader->open_section, &c) != ROTID_OK;
    if (reader->pool->out_of_memory || !isfinite(c.error) || reader->job->options.solid) /* that has a mesh of its own */
        return;
    reader->job->mesh_error = c.error;
    if (c.error > c.wanted)
        deck_note(reader, place,
                  "the mesh of %d elements, where none are stated, leaves an error of %.2g %% in modes 1 to %d; state more for "
                  "%.2g %%%s",
                  c.elements, 100 * c.error, c.mode, 100 * c.wanted, c.is_noise_known ? ", a tenth of the smallest noise" : "");
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
        bending = fmax(bending, g->rectangular ? e * g->width * pow(g->height, 3) / 12 : e * PI / 64 * (pow(d, 4) - pow(b, 4)));
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

static void check_magnitudes(struct deck_reader *reader)
{
    const struct rotor *rotor = &reader->job->rotor;
    double mass = 0, length = rotor_length(rotor);
    for (int s = 0; s < rotor->nsegment; s++) {
        const struct segment *g = &rotor->segment[s];
        double area = g->rectangular ? g->height * g->width : PI / 4 * (g->outer * g->outer - g->inner * g->inner);
        mass += area * g->length * rotor->group[g->group].material.rho;
    }
    struct place place = rotor->ngroup ? reader->place[GROUP_PLACES][0] : reader->text.end;
    if (mass > 0 && length > 0)
        refuse_contrast(reader, place, mass, length);
    if (!reader->warned && (length > 30 || length < 0.01))
        deck_note(reader, place, "the rotor is %.4g m long, expected 0.01 to 30 m: lengths in another unit?", length);
    if (!reader->warned && (mass > 3e5 || mass < 1e-3))
        deck_note(reader, place, "the shaft weighs %.4g kg, expected 0.001 to 300,000 kg: density or lengths in another unit?",
                  mass);
}

/* What a model takes for granted where the deck says nothing of it. */
static void note_assumptions(struct deck_reader *reader)
{
    const struct rotor *rotor = &reader->job->rotor;
    int shear = -1, holes = -1;
    const struct job *job = reader->job;
    for (int d = 0; d < rotor->ndisk && job->options.type == MODE_TORSION; d++)
        if (rotor->disk[d].mass > 0 && !(rotor->disk[d].polar > 0))
            deck_note(reader, reader->modes_card->place,
                      "the disk at %.6g m has no polar inertia, which is all of it that counts in torsion",
                      rotor->disk[d].position);
    if (reader->job->options.solid)
        deck_note_boxes(reader);
    for (int g = rotor->ngroup - 1; g >= 0 && reader->job->options.solid; g--) {
        const struct group *group = &rotor->group[g];
        shear = !group->material.isotropic && !group->material.laminated ? g : shear;
        holes = group->holes > 0 ? g : holes;
    }
    if (shear >= 0)
        deck_note(reader, reader->place[GROUP_PLACES][shear],
                  "E, G and nu of %s say nothing of E across the axis: a solid takes that for E along it, and nu in every "
                  "direction; *ELASTIC, TYPE=LAMINATED states the sheets",
                  rotor->group[shear].name);
    if (holes >= 0)
        deck_note(
            reader, reader->place[GROUP_PLACES][holes],
            "a solid smears the holes of %s over a ring as broad as a hole, whose stiffness and density fall by their share",
            rotor->group[holes].name);
}

/* Whether modes on the supports were counted, from COUNT or from the data. */
static void count_modes(struct deck_reader *reader)
{
    struct job *job = reader->job;
    const struct numbering *n = &job->measurement.numbering;
    const struct card *card = reader->modes_card ? reader->modes_card : reader->measured_card;
    const struct card_option *option = card ? card_option(card, "COUNT") : NULL;
    job->measurement.numbering.stated = option != NULL;
    job->rotor.count_all = option && deck_option_word(reader, option, deck_counts) == 1;
    reader->pool->out_of_memory |= numbering_choose(reader->pool, job) != ROTID_OK;
    if (!card || n->stated || !n->nsupport || reader->pool->out_of_memory)
        return;
    if (job->rotor.count_all)
        deck_note(
            reader, card->place,
            "modes are counted from the lowest vibration on the supports (COUNT=ALL): they differ from the model at the start by "
            "%.3g %% then, and by %.3g %% if counted from the first bending mode (COUNT=ELASTIC)",
            100 * n->all, 100 * n->elastic);
    else if (!(n->elastic < NUMBERING_CLEAR * n->all))
        deck_note(
            reader, card->place,
            "modes are counted from the first bending mode (COUNT=ELASTIC): they differ from the model at the start by %.3g %% "
            "then, and by %.3g %% if counted from the lowest vibration on the supports (COUNT=ALL): state COUNT=ELASTIC or ALL, "
            "or mend the stiffness of the supports",
            100 * n->elastic, 100 * n->all);
}

static void check_elements(struct deck_reader *reader)
{
    const struct rotor *rotor = &reader->job->rotor;
    long elements = rotor_elements(rotor);
    if (elements > DECK_MOST_ELEMENTS)
        deck_error(reader, reader->place[GROUP_PLACES][rotor->ngroup - 1], "the rotor has %ld elements, expected at most %d",
                   elements, DECK_MOST_ELEMENTS);
    for (int b = 0, count = rotor->ntierod + rotor->nbars; b < count && elements <= DECK_MOST_ELEMENTS; b++) {
        int bars = b - rotor->ntierod;
        elements += bars < 0 ? rotor->tierod[b].elements : rotor->bars[bars].elements;
        if (elements > DECK_MOST_ELEMENTS)
            deck_error(reader, bars < 0 ? reader->place[TIEROD_PLACES][b] : reader->place[BARS_PLACES][bars],
                       "shaft, rods and bars up to these have %ld elements, expected at most %d in all", elements,
                       DECK_MOST_ELEMENTS);
    }
}

/* By their positions, in the order of the deck where two have one. */
static void deck_sort_sensors(struct deck_reader *reader)
{
    struct sensor *sensor = reader->job->rotor.sensor;
    struct place *place = reader->place[SENSOR_PLACES];
    for (int i = 1; i < reader->job->rotor.nsensor; i++)
        for (int at = i; at > 0 && sensor[at - 1].position > sensor[at].position; at--) {
            const struct sensor other = sensor[at];
            const struct place there = place[at];
            sensor[at] = sensor[at - 1];
            place[at] = place[at - 1];
            sensor[at - 1] = other;
            place[at - 1] = there;
        }
}

void deck_read_cards(struct deck_reader *reader)
{
    struct job *job = reader->job;
    for (int c = 0; c < reader->text.ncard; c++)
        deck_check_names(reader, &reader->text.card[c]);
    /* 1. The cards by the phases of card_table.c, whatever their order in the text: units (0), materials (1), sections along the
     * axis (2); *SET may change lengths before anything lies at a position; layers (3), what is attached, sensors (4), modes (5),
     * values at sensors (6), causes (7); last what is searched, held out, set. An error leaves the card and goes on with the next
     * one. */
    for (int phase = 0; phase <= LAST_PHASE && !reader->pool->out_of_memory; phase++) {
        if (phase == 3) {
            deck_set_lengths(reader);
            reader->length = rotor_length(&job->rotor);
        }
        if (phase == 3 && !job->rotor.ngroup) {
            check_materials(reader);
            deck_error(reader, reader->text.end, "the deck has no *SHAFT and no *BEAM, expected at least one");
            return; /* every position would be outside */
        }
        if (phase == 5)
            deck_sort_sensors(reader);
        if (phase == LAST_PHASE)
            job->measurement.holdout = POOL_ARRAY(reader->pool, int, job->measurement.nmode);
        for (int c = 0; c < reader->text.ncard && !reader->pool->out_of_memory; c++) {
            const struct deck_card *kind = reader->text.card[c].kind;
            if (kind && kind->phase == phase)
                deck_read_card(reader, &reader->text.card[c], kind);
        }
    }
    if (reader->pool->out_of_memory)
        return;
    /* 2. What only all cards together can tell. */
    check_materials(reader);
    deck_check_unique(reader, reader->text.ncard, reader->text.card, 0);
    check_elements(reader);
    if (reader->messages->errors)
        return;
    /* 3. What they leave open: which moduli follow from others, the noise of each value, the data without the faults that are
     * stated. */
    tie_moduli(reader);
    deck_complete_noise(reader);
    deck_apply_corrections(reader);
    if (reader->messages->errors || reader->pool->out_of_memory)
        return;
    /* 4. How it is fitted, on which mesh; is the rotor one that can be computed? */
    choose_functional(reader);
    check_masters(reader);
    choose_mesh(reader);
    if (!reader->pool->out_of_memory)
        check_model(reader);
    if (!reader->messages->errors && !reader->pool->out_of_memory)
        count_modes(reader);
    check_magnitudes(reader);
    note_assumptions(reader);
}

/* Replaces or adds the option on every card of that name; a card of which there can only be one is added if it is missing. */
static int deck_text_override(struct pool *pool, const struct override *override, struct message_list *messages,
                              struct deck_text *text)
{
    static const char *const single[] = {"FIT", "NOISE", "SLING", "MEASURED", "FRF"};
    struct place place = {override->text, 1, 1};
    struct card_option option = {override->option, override->value, place, place, 1, place};
    int found = 0;
    for (int i = 0; i < text->ncard; i++) {
        struct card *card = &text->card[i];
        if (!same_text(card->name, override->card))
            continue;
        struct card_option *present = (struct card_option *)card_option(card, override->option);
        found = 1;
        if (present)
            *present = option;
        else if (deck_text_add_option(pool, card, option))
            return ROTID_ERROR_MEMORY;
    }
    for (size_t s = 0; s < sizeof single / sizeof *single && !found; s++)
        if (same_text(single[s], override->card)) {
            struct card *card = deck_text_add_card(pool, text, single[s], place);
            return card && !deck_text_add_option(pool, card, option) ? ROTID_OK : ROTID_ERROR_MEMORY;
        }
    if (!found)
        return message_refuse(messages, ROTID_ERROR_SYNTAX, place.file, 1, 1,
                              "the deck has no card *%s, expected one that it has", override->card);
    return ROTID_OK;
}

int deck_read_with(struct pool *pool, const char *path, const struct deck_memory *memory, int noverride,
                   const struct override *override, int ncard, const struct card *card, struct message_list *messages,
                   struct states *states)
{
    struct job job = {.deck = pool_copy_text(pool, path), .options.frf = {.axis = 2, .quantity = FRF_ACCELERATION}};
    struct deck_reader reader = {.pool = pool, .messages = messages, .job = &job};
    *states = (struct states){0};
    rotid_fit_defaults(sizeof job.options.fit, &job.options.fit);
    int status = deck_text_read(pool, path, memory, messages, &reader.text);
    if (status == ROTID_ERROR_IO || status == ROTID_ERROR_MEMORY || !reader.text.ncard) {
        if (!messages->errors && status != ROTID_ERROR_MEMORY)
            deck_error(&reader, reader.text.end, "the deck is empty, expected cards such as *SHAFT");
        return status ? status : ROTID_ERROR_SYNTAX;
    }
    /* The text with what the caller replaces and adds; tables become data lines of their cards. */
    int nread = reader.text.ncard;
    struct deck_origin *origin = POOL_NEW(pool, struct deck_origin);
    if (!origin)
        return ROTID_ERROR_MEMORY;
    *origin = reader.text.origin;
    origin->noverride = noverride;
    origin->override = override;
    job.origin = origin;
    for (int i = 0; i < noverride; i++)
        if (deck_text_override(pool, &override[i], messages, &reader.text) == ROTID_ERROR_MEMORY)
            return ROTID_ERROR_MEMORY;
    for (int i = 0; i < ncard; i++)
        (void)POOL_ADD(pool, reader.text.card, reader.text.ncard, &card[i]);
    if (pool->out_of_memory)
        return ROTID_ERROR_MEMORY;
    int bad_tables = deck_read_tables(&reader, &nread); /* what follows from a table that is not there would be told of as well */
    /* Each state by itself, then the machine, which is made of the first one. */
    if (!bad_tables && !pool->out_of_memory) {
        deck_split_running(&reader, &nread);
        deck_read_all_states(&reader, nread, states);
    }
    if (!messages->errors && !pool->out_of_memory && states->nstate)
        deck_read_machine(&reader, states);
    if (pool->out_of_memory || messages->pool->out_of_memory)
        return ROTID_ERROR_MEMORY;
    if (messages->errors)
        return reader.no_section ? ROTID_ERROR_SECTION : ROTID_ERROR_SYNTAX;
    return ROTID_OK;
}

int deck_read_states(struct pool *pool, const char *path, const struct deck_memory *memory, int noverride,
                     const struct override *override, struct message_list *messages, struct states *states)
{
    return deck_read_with(pool, path, memory, noverride, override, 0, NULL, messages, states);
}
