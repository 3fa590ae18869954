/* Two jobs field by field: what a deck was meant to say, and what it is read as. Fields are those of the rows of the cards
 * (card_table.c), so a field that is read is compared. */
#include "deck/deck_row.h"

struct comparing {
    unsigned bits;
    const char *card;
};

/* The first difference that nothing can be done about keeps its card. bits: 0: there is none. */
static void differ(struct comparing *c, unsigned bits, const char *card)
{
    if (bits && !(c->bits & DECK_OTHER_MODEL))
        c->card = card;
    c->bits |= bits;
}

static void require(struct comparing *c, int same, const char *card)
{
    differ(c, same ? 0 : DECK_OTHER_MODEL, card);
}

/* ------------------------------------------------------------------------------------------------ by rows */

static int is_same_text(const char *a, const char *b)
{
    return a && b ? same_text(a, b) : !a == !b;
}

static int is_same_material(const struct material *a, const struct material *b)
{
    return a->isotropic == b->isotropic && a->laminated == b->laminated && deck_is_near(a->e, b->e) &&
           deck_is_near(a->nu, b->nu) && deck_is_near(a->rho, b->rho) && (a->isotropic || deck_is_near(a->g, b->g)) &&
           (!a->laminated || (deck_is_near(a->sheet_e, b->sheet_e) && deck_is_near(a->stacking, b->stacking)));
}

/* Bits of how two structs differ in what the rows say. */
static unsigned differences(const struct deck_row *row, const void *a, const void *b)
{
    unsigned bits = 0;
    for (; !deck_row_is_last(row); row++) {
        int same = 1;
        const void *p = (const char *)a + row->offset, *q = (const char *)b + row->offset;
        if (row->kind == ROW_NAME)
            same = is_same_text(*(const char *const *)p, *(const char *const *)q);
        else if (row->kind == ROW_MATERIAL)
            same = is_same_material(p, q);
        else if (row->kind == ROW_GROUP || row->kind == ROW_WORD || row->kind == ROW_WHOLE)
            same = *(const int *)p == *(const int *)q;
        else if (row->kind == ROW_NUMBER || row->kind == ROW_POSITION)
            same = deck_is_near(*(const double *)p, *(const double *)q);
        bits |= same ? 0 : row->bits & ROW_MESH ? DECK_OTHER_ELEMENTS : DECK_OTHER_MODEL;
    }
    return bits;
}

static unsigned list_differences(const struct deck_card *kind, const void *a, const void *b)
{
    const char *p = *(const char *const *)((const char *)a + kind->list),
               *q = *(const char *const *)((const char *)b + kind->list);
    int count = *(const int *)((const char *)a + kind->count);
    unsigned bits = count == *(const int *)((const char *)b + kind->count) ? 0 : DECK_OTHER_MODEL;
    for (int i = 0; i < count && !(bits & DECK_OTHER_MODEL); i++)
        bits |= differences(kind->row, p + (size_t)i * kind->size, q + (size_t)i * kind->size);
    return bits;
}

/* ------------------------------------------------------------------------------------------------ rotors */

static void compare_segments(struct comparing *c, const struct rotor *a, const struct rotor *b)
{
    for (int s = 0; s < a->nsegment; s++) {
        const struct segment *p = &a->segment[s], *q = &b->segment[s];
        const char *card = p->rectangular ? "BEAM" : "SHAFT";
        unsigned bits = differences(deck_rows(card), p, q);
        differ(c, bits & DECK_OTHER_ELEMENTS, "SHAFT");
        require(c, p->group == q->group && p->rectangular == q->rectangular && !(bits & DECK_OTHER_MODEL), card);
    }
}

/* By name: common causes come before those of a state. */
static int has_effect(const struct rotor *rotor, const struct effect *effect)
{
    for (int i = 0; i < rotor->neffect; i++) {
        const struct effect *e = &rotor->effect[i];
        int same = same_text(e->name, effect->name) && e->kind == effect->kind && e->target == effect->target &&
                   e->variant == effect->variant;
        for (int p = 0; p < effect_parameters(effect) && same; p++)
            same = deck_is_near(e->value[p], effect->value[p]);
        if (same)
            return 1;
    }
    return 0;
}

unsigned deck_compare_rotors(const struct rotor *a, const struct rotor *b, const char **card)
{
    struct comparing c = {0};
    if (a->ngroup != b->ngroup || a->nsegment != b->nsegment || a->nring != b->nring)
        differ(&c, DECK_OTHER_MODEL, "SHAFT");
    for (int g = 0; g < a->ngroup && !c.bits; g++) {
        const struct group *p = &a->group[g], *q = &b->group[g];
        require(&c, same_text(p->name, q->name) && p->layer_of == q->layer_of, p->layer_of > 0 ? "LAYER" : "SHAFT");
        require(&c, is_same_material(&p->material, &q->material), "ELASTIC");
        require(&c, p->holes == q->holes && (!p->holes || !differences(deck_rows("PERFORATION"), p, q)), "PERFORATION");
        require(&c, deck_is_near(p->preload, q->preload), "PRELOAD");
    }
    if (!(c.bits & DECK_OTHER_MODEL))
        compare_segments(&c, a, b);
    for (int i = 0; i < a->nring && a->nring == b->nring; i++)
        require(&c, a->ring[i].group == b->ring[i].group && !differences(deck_rows("LAYER"), &a->ring[i], &b->ring[i]), "LAYER");
    for (const struct deck_card *kind = deck_card_table; kind->name; kind++)
        if (kind->size && kind->states != CARD_OF_MACHINE && kind->places != SENSOR_PLACES)
            differ(&c, list_differences(kind, a, b), kind->name);
    require(&c, deck_is_near(a->sling, b->sling), "SLING");
    require(&c, a->neffect == b->neffect, "CAUSE");
    for (int i = 0; i < a->neffect; i++)
        require(&c, has_effect(b, &a->effect[i]), "CAUSE");
    *card = c.card;
    return c.bits;
}

/* ------------------------------------------------------------------------------------------------ measured data */

static int are_near(ptrdiff_t count, const double *a, const double *b)
{
    int same = !a == !b;
    for (ptrdiff_t i = 0; i < count && a && same; i++)
        same = deck_is_near(a[i], b[i]);
    return same;
}

/* Where something was measured. */
static int are_near_where(ptrdiff_t count, const double *there, const double *a, const double *b)
{
    int same = !there || !a == !b;
    for (ptrdiff_t i = 0; i < count && there && a && same; i++)
        same = !isfinite(there[i]) || deck_is_near(a[i], b[i]);
    return same;
}

static void compare_faults(struct comparing *c, const struct job_measurement *a, const struct job_measurement *b)
{
    require(c, a->ncorrection == b->ncorrection, "CAUSE");
    for (int i = 0; i < a->ncorrection && a->ncorrection == b->ncorrection; i++) {
        const struct correction *p = &a->correction[i], *q = &b->correction[i];
        int same = !strcmp(p->id, q->id) && same_text(p->name, q->name) && deck_is_near(p->value, q->value) &&
                   are_near(2, p->more, q->more) && (!p->block || !strcmp(p->block, q->block));
        const struct cause_kind *kind = catalogue_find(p->id);
        int sensors = !kind || kind->target == TARGET_BLOCK ? 0
                      : kind->target == TARGET_SENSORS      ? 2
                                                            : kind->target == TARGET_SENSOR;
        for (int s = 0; s < sensors; s++)
            same &= p->sensor[s] == q->sensor[s];
        require(c, same, "CAUSE");
    }
}

static void compare_data(struct comparing *c, const struct job *meant, const struct job *read)
{
    const struct job_measurement *a = &meant->measurement, *b = &read->measurement;
    const struct job_raw p = deck_data_as_read(meant), q = deck_data_as_read(read);
    ptrdiff_t count = (ptrdiff_t)p.nsensor * a->nmode;
    int sensors = p.nsensor == q.nsensor;
    for (int s = 0; s < p.nsensor && sensors; s++)
        sensors = p.sensor[s].id == q.sensor[s].id && deck_is_near(p.sensor[s].position, q.sensor[s].position);
    if (!sensors)
        differ(c, DECK_OTHER_SENSORS | DECK_OTHER_DATA, "SENSORS");
    if (a->nmode != b->nmode) {
        differ(c, DECK_OTHER_DATA, "MODES");
        return;
    }
    int modes = 1, held = 1;
    for (int k = 0; k < a->nmode; k++) {
        modes &= a->number[k] == b->number[k] && deck_is_near(a->damping[k], b->damping[k]);
        held &= a->holdout[k] == b->holdout[k];
    }
    modes &= meant->options.type == read->options.type;
    if (!modes || !are_near(a->nmode, a->frequency_hz, b->frequency_hz))
        differ(c, DECK_OTHER_DATA, "MODES");
    if (!held)
        differ(c, DECK_OTHER_HOLDOUT, "FIT");
    if (!sensors)
        return;
    if (!are_near(count, p.shape, q.shape))
        differ(c, DECK_OTHER_DATA, "SHAPE");
    if (!are_near(count, p.point_frequency_hz, q.point_frequency_hz))
        differ(c, DECK_OTHER_DATA, "FREQUENCIES");
    if (!are_near(a->nmode, p.frequency_std, q.frequency_std) || !are_near_where(count, p.shape, p.shape_std, q.shape_std) ||
        !are_near_where(count, p.point_frequency_hz, p.point_frequency_std, q.point_frequency_std))
        differ(c, DECK_OTHER_NOISE, "NOISE");
}

/* ------------------------------------------------------------------------------------------------ what is searched */

static void compare_unknowns(struct comparing *c, const struct job_unknowns *a, const struct job_unknowns *b)
{
    require(c, a->nparameter == b->nparameter, "IDENTIFY");
    for (int i = 0; i < a->nparameter; i++) {
        int found = 0;
        for (int k = 0; k < b->nparameter; k++) {
            const rotid_parameter *p = &a->bounds[i], *q = &b->bounds[k];
            found |= same_text(p->name, q->name) && deck_is_near(p->lower, q->lower) && deck_is_near(p->upper, q->upper) &&
                     deck_is_near(p->start, q->start);
        }
        require(c, found, "IDENTIFY");
    }
    require(c, a->nsuspect == b->nsuspect, "CAUSE");
    for (int i = 0; i < a->nsuspect && a->nsuspect == b->nsuspect; i++)
        require(c,
                same_text(a->suspect[i].effect.name, b->suspect[i].effect.name) &&
                    a->suspect[i].effect.kind == b->suspect[i].effect.kind,
                "CAUSE");
}

static void compare_options(struct comparing *c, const struct job_options *a, const struct job_options *b)
{
    if (a->fit.functional != b->fit.functional || a->fit.reduction != b->fit.reduction ||
        a->fit.derivative != b->fit.derivative || a->solid != b->solid)
        differ(c, DECK_OTHER_FIT, "FIT");
    int same = a->frf.given == b->frf.given && a->frf.npair == b->frf.npair && !differences(deck_rows("FRF"), &a->frf, &b->frf);
    require(c, same && !a->frf.file == !b->frf.file, "FRF");
}

int deck_copy_rotor(struct pool *pool, const struct rotor *rotor, struct rotor *copy)
{
    struct rotor without = *rotor;
    without.sling = 0;
    int status = rotor_copy(pool, &without, copy);
    copy->sling = rotor->sling;
    return status;
}

/* The rotor with its parameters at the starts. */
static int at_start(struct pool *pool, const struct job *job, struct rotor *rotor)
{
    int n = job->unknowns.nparameter;
    const double *x = parameter_starts(pool, n, job->unknowns.bounds);
    if (!x || deck_copy_rotor(pool, &job->rotor, rotor))
        return ROTID_ERROR_MEMORY;
    parameters_set(rotor, n, job->unknowns.parameter, x);
    return ROTID_OK;
}

unsigned deck_compare(struct pool *pool, const struct job *meant, const struct job *read, const char **card)
{
    struct comparing c = {0};
    struct rotor a, b;
    if (at_start(pool, meant, &a) || at_start(pool, read, &b))
        return DECK_OTHER_MODEL;
    c.bits = deck_compare_rotors(&a, &b, &c.card);
    compare_faults(&c, &meant->measurement, &read->measurement);
    compare_unknowns(&c, &meant->unknowns, &read->unknowns);
    compare_options(&c, &meant->options, &read->options);
    compare_data(&c, meant, read);
    *card = c.card ? c.card : "";
    return c.bits;
}
