#include "rotor/rotor.h"

static const double gravity = 9.81; /* m/s2: the value the paper's table of the rotor rests on */

int rotor_copy(struct pool *pool, const struct rotor *rotor, struct rotor *copy)
{
    int sling = rotor->sling > 0 ? 2 : 0;
    *copy = *rotor;
    copy->group = POOL_COPY(pool, rotor->group, rotor->ngroup, 0);
    copy->segment = POOL_COPY(pool, rotor->segment, rotor->nsegment, 0);
    copy->ring = POOL_COPY(pool, rotor->ring, rotor->nring, 0);
    copy->tierod = POOL_COPY(pool, rotor->tierod, rotor->ntierod, 0);
    copy->bars = POOL_COPY(pool, rotor->bars, rotor->nbars, 0);
    copy->disk = POOL_COPY(pool, rotor->disk, rotor->ndisk, 0);
    copy->spring = POOL_COPY(pool, rotor->spring, rotor->nspring, sling);
    copy->sensor = POOL_COPY(pool, rotor->sensor, rotor->nsensor, 0);
    copy->effect = POOL_COPY(pool, rotor->effect, rotor->neffect, 0);
    if (!copy->group || !copy->segment || !copy->ring || !copy->tierod || !copy->bars || !copy->disk || !copy->spring ||
        !copy->sensor || !copy->effect)
        return ROTID_ERROR_MEMORY;
    if (sling) {
        copy->spring[copy->nspring++] = (struct spring){.name = "sling", .position = 0};
        copy->spring[copy->nspring++] = (struct spring){.name = "sling end", .position = rotor_length(rotor)};
    }
    return ROTID_OK;
}

void rotor_set_sling(struct rotor *rotor, double mass, double center)
{
    struct spring *spring = rotor->spring + rotor->nspring - 2;
    double weight = mass * gravity, length = rotor_length(rotor);
    spring[0].lateral = weight / rotor->sling;
    spring[1].lateral = weight * center / (length * length + center * rotor->sling);
}

/* ------------------------------------------------------------------------------------------------ shape */

static int same_segments(const struct rotor *a, const struct rotor *b)
{
    for (int i = 0; i < a->nsegment; i++) {
        const struct segment *x = &a->segment[i], *y = &b->segment[i];
        if (x->group != y->group || x->elements != y->elements || x->rectangular != y->rectangular || x->length != y->length ||
            x->outer != y->outer || x->inner != y->inner || x->stiff_outer != y->stiff_outer || x->height != y->height ||
            x->width != y->width)
            return 0;
    }
    return 1;
}

static int same_rings(const struct rotor *a, const struct rotor *b)
{
    for (int i = 0; i < a->nring; i++) {
        const struct ring *x = &a->ring[i], *y = &b->ring[i];
        if (x->group != y->group || x->segment != y->segment || x->outer != y->outer || x->inner != y->inner)
            return 0;
    }
    return 1;
}

/* of a material all that no parameter can change */
static int same_kind(const struct material *a, const struct material *b)
{
    return a->isotropic == b->isotropic && a->laminated == b->laminated && a->sheet_e == b->sheet_e && a->stacking == b->stacking;
}

static int same_groups(const struct rotor *a, const struct rotor *b)
{
    for (int i = 0; i < a->ngroup; i++) {
        const struct group *x = &a->group[i], *y = &b->group[i];
        if (!same_kind(&x->material, &y->material) || x->layer_of != y->layer_of || x->holes != y->holes ||
            x->hole_diameter != y->hole_diameter || x->hole_pitch != y->hole_pitch || x->preload != y->preload)
            return 0;
    }
    return 1;
}

static int same_tierods(const struct rotor *a, const struct rotor *b)
{
    for (int i = 0; i < a->ntierod; i++) {
        const struct tierod *x = &a->tierod[i], *y = &b->tierod[i];
        if (!same_kind(&x->material, &y->material) || x->from != y->from || x->to != y->to || x->model != y->model ||
            x->self_equilibrated != y->self_equilibrated || x->number != y->number || x->elements != y->elements ||
            x->diameter != y->diameter || x->pitch != y->pitch)
            return 0;
    }
    return 1;
}

static int same_material(const struct material *a, const struct material *b)
{
    return a->e == b->e && a->g == b->g && a->nu == b->nu && a->rho == b->rho;
}

static int same_bars(const struct rotor *a, const struct rotor *b)
{
    for (int i = 0; i < a->nbars; i++) {
        const struct bars *x = &a->bars[i], *y = &b->bars[i];
        if (!same_kind(&x->material, &y->material) || !same_material(&x->material, &y->material) || x->center != y->center ||
            x->length != y->length || x->model != y->model || x->number != y->number || x->elements != y->elements ||
            x->diameter != y->diameter || x->pitch != y->pitch)
            return 0;
    }
    return 1;
}

static int same_places(const struct rotor *a, const struct rotor *b)
{
    int same = 1;
    for (int i = 0; i < a->ndisk; i++)
        same &= a->disk[i].position == b->disk[i].position && a->disk[i].hub_length == b->disk[i].hub_length &&
                a->disk[i].hub_outer == b->disk[i].hub_outer;
    for (int i = 0; i < a->nspring; i++)
        same &= a->spring[i].position == b->spring[i].position;
    for (int i = 0; i < a->nsensor; i++)
        same &= a->sensor[i].position == b->sensor[i].position;
    return same;
}

static int same_effects(const struct rotor *a, const struct rotor *b)
{
    int same = 1;
    for (int i = 0; i < a->neffect; i++)
        same &= a->effect[i].kind == b->effect[i].kind && a->effect[i].target == b->effect[i].target &&
                a->effect[i].variant == b->effect[i].variant;
    return same;
}

int rotor_same_shape(const struct rotor *a, const struct rotor *b)
{
    return a->ngroup == b->ngroup && a->nsegment == b->nsegment && a->nring == b->nring && a->ntierod == b->ntierod &&
           a->nbars == b->nbars && a->ndisk == b->ndisk && a->nspring == b->nspring && a->nsensor == b->nsensor &&
           a->neffect == b->neffect && a->sling == b->sling && same_segments(a, b) && same_rings(a, b) && same_groups(a, b) &&
           same_tierods(a, b) && same_bars(a, b) && same_places(a, b) && same_effects(a, b);
}

int rotor_same_values(const struct rotor *a, const struct rotor *b)
{
    int same = a->count_all == b->count_all;
    for (int i = 0; i < a->ngroup; i++)
        same &= same_material(&a->group[i].material, &b->group[i].material);
    for (int i = 0; i < a->ntierod; i++)
        same &= same_material(&a->tierod[i].material, &b->tierod[i].material) && a->tierod[i].tension == b->tierod[i].tension;
    for (int i = 0; i < a->ndisk; i++)
        same &= a->disk[i].mass == b->disk[i].mass && a->disk[i].diametral == b->disk[i].diametral;
    for (int i = 0; i < a->nspring; i++)
        same &= a->spring[i].lateral == b->spring[i].lateral && a->spring[i].rotational == b->spring[i].rotational;
    for (int i = 0; i < a->neffect; i++)
        for (int p = 0; p < EFFECT_MOST_PARAMETERS; p++)
            same &= a->effect[i].value[p] == b->effect[i].value[p];
    return same;
}
