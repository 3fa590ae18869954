/* Members: how the pieces of the beam are cut and joined for one frequency.
 *
 * No member may resonate below the frequency with its ends clamped, so that the count of Wittrick and Williams needs no J0. A
 * member is as long as that allows and may then run over several pieces and lumped masses, its transfer matrix being the product
 * of theirs; the members are made anew for every frequency. The dynamic stiffness of a member that is short for the frequency
 * would be far above its inertia forces, and rounding of the former would swamp the latter. Such a member keeps its forces as
 * unknowns: in the mixed form rigid motion is transmitted by numbers like 1 and l, whose rounding is harmless, and the elastic
 * part is small. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "oracle_model.h"

static const double pi = 3.14159265358979323846;

/* What bounds the lowest resonance of a member with one or both ends held. */
struct extent {
    double length, bending, shear, mass, inertia, compression;     /* the least EI, kGS and the largest rhoS, rhoI, -F in it */
    double lumped_mass, lumped_inertia, spring, rotational_spring; /* sums */
};

/* Adds a length of a segment with the station at its left end, which the first part of a member leaves to the node. */
static void extend(struct extent *extent, const struct oracle_segment *segment, double length,
                   const struct oracle_station *station)
{
    if (extent->length == 0.0) {
        *extent = (struct extent){
            length, segment->bending, segment->shear, segment->mass, segment->inertia, -segment->axial, 0.0, 0.0, 0.0, 0.0};
        return;
    }
    extent->length += length;
    extent->bending = fmin(extent->bending, segment->bending);
    extent->shear = fmin(extent->shear, segment->shear);
    extent->mass = fmax(extent->mass, segment->mass);
    extent->inertia = fmax(extent->inertia, segment->inertia);
    extent->compression = fmax(extent->compression, -segment->axial);
    extent->lumped_mass += station->mass;
    extent->lumped_inertia += station->inertia[0] + station->inertia[1];
    extent->spring += station->spring;
    extent->rotational_spring += station->rotational_spring[0] + station->rotational_spring[1];
}

/* A lower bound of lambda = omega^2 of a member held at one or both ends; 0 if there is none.
 *
 * Let U = int EI theta'^2 + kGS gamma^2 with gamma = v' + theta, the norms be those of L2, and EI, kGS the least, rhoS, rhoI, P =
 * -F the largest values. Suppose that
 *     |theta - mean| <= bend |theta'|,   |theta| <= wave |theta'|,   |v| <= wave |v'|,
 *     v(a)^2 <= point |v'|^2,   theta(a)^2 <= point |theta'|^2,
 * the mean to be taken off only if that of v' vanishes. Since v' = (gamma - mean) - (theta - mean), by Cauchy and Schwarz
 *     |v'|^2 <= (|gamma| + bend |theta'|)^2 <= c U,   c = 1/kGS + bend^2/EI.
 * Twice the potential energy is at least (1 - P c) U if P > 0, at least U otherwise, springs only adding to it; 1/c is the
 * buckling load of Engesser. Lumped masses m, Id included, the kinetic energy is at most
 *     lambda/2 (wave^2 (rhoS c + rhoI/EI) + point (m c + Id/EI)) U.
 * The quotient of the two is the bound. */
static double lower_bound(const struct extent *e, double bend, double wave, double point)
{
    double c = 1.0 / e->shear + bend * bend / e->bending;
    double kinetic =
        wave * wave * (e->mass * c + e->inertia / e->bending) + point * (e->lumped_mass * c + e->lumped_inertia / e->bending);

    if (e->compression * c >= 1.0)
        return 0.0;
    /* Springs much stiffer than the member itself would spoil the transfer matrix, in which they multiply its flexibility. */
    if (point * (e->spring * c + e->rotational_spring / e->bending) > 1.0)
        return 0.0;
    return (1.0 - fmax(e->compression, 0.0) * c) / kinetic;
}

/* v = theta = 0 at both ends of the length l: v' has no mean, theta may be continued periodically, and a value is bounded by the
 * deflection of a string under a load. For a slender uniform member the bound is 4 pi^4 EI/(rhoS l^4), in terms of omega 12 %
 * below the true 22.37^2. */
static double clamped_bound(const struct extent *e)
{
    return lower_bound(e, e->length / (2.0 * pi), e->length / pi, 0.25 * e->length);
}

/* v = theta = 0 at one end. The bound is pi^4/16 EI/(rhoS l^4), in terms of omega 30 % below the true 3.516^2. */
static double cantilever_bound(const struct extent *e)
{
    return lower_bound(e, 2.0 * e->length / pi, 2.0 * e->length / pi, e->length);
}

/* The array with room for at least needed elements, or NULL, which leaves it as it was. */
static void *grow(void *array, int *room, int needed, size_t size)
{
    void *larger;

    if (needed <= *room)
        return array;
    larger = realloc(array, 2 * (size_t)needed * size);
    if (larger)
        *room = 2 * needed;
    return larger;
}

/* Gives every node its degrees of freedom and every member those of its two ends and of its forces. */
static void number_dofs(struct oracle_model *model)
{
    int dofs = 0;

    for (int i = 0; i < model->stations; i++)
        model->station[i].dof[0] = -1;
    for (int i = 0; i <= model->members; i++) {
        struct oracle_member *left = i > 0 ? &model->member[i - 1] : NULL, *right = i < model->members ? &model->member[i] : NULL;
        int station = right ? model->cell[right->cell].station : model->stations - 1;
        int hinged = station >= 0 && model->station[station].hinged;
        int dof[4] = {dofs, dofs + 1, dofs + 1 + hinged, dofs + 2 + hinged};
        dofs += 2 + 2 * hinged;
        if (station >= 0)
            memcpy(model->station[station].dof, dof, sizeof(dof));
        if (left) {
            left->dof[2] = dof[0];
            left->dof[3] = dof[1];
        }
        if (right) {
            right->dof[0] = dof[0];
            right->dof[1] = dof[2];
            right->dof[4] = right->mixed ? dofs : -1;
            right->dof[5] = right->mixed ? dofs + 1 : -1;
            dofs += 2 * right->mixed;
        }
    }
    model->dofs = dofs;
}

static int make_room(struct oracle_model *model)
{
    int room = model->dofs + model->dofs / 4;
    size_t n = (size_t)room;

    if (model->dofs <= model->dof_room)
        return ORACLE_OK;
    free(model->matrix);
    free(model->scale);
    free(model->vector);
    free(model->work);
    free(model->pivot);
    model->dof_room = 0;
    model->matrix = malloc(n * n * sizeof(*model->matrix));
    model->scale = malloc(n * sizeof(*model->scale));
    model->vector = malloc(n * sizeof(*model->vector));
    model->work = malloc(n * sizeof(*model->work));
    model->pivot = malloc(n * sizeof(*model->pivot));
    if (!model->matrix || !model->scale || !model->vector || !model->work || !model->pivot)
        return ORACLE_ERROR_MEMORY;
    model->dof_room = room;
    return ORACLE_OK;
}

static int add_cell(struct oracle_model *model, struct oracle_cell cell)
{
    struct oracle_cell *cells = grow(model->cell, &model->cell_room, model->cells + 1, sizeof(*cells));
    struct oracle_member *members;

    if (!cells)
        return ORACLE_ERROR_MEMORY;
    model->cell = cells;
    cells[model->cells++] = cell;
    if (!cell.node)
        return ORACLE_OK;
    members = grow(model->member, &model->member_room, model->members + 1, sizeof(*members));
    if (!members)
        return ORACLE_ERROR_MEMORY;
    model->member = members;
    members[model->members++].cell = model->cells - 1;
    return model->members > ORACLE_MEMBERS_MAX ? ORACLE_ERROR_RANGE : ORACLE_OK;
}

/* A part of its own keeps clamped_bound above 2 lambda. A member that takes in the next part may come down to 1.5 lambda: this
 * lets it absorb slivers, and keeps D away from its poles at the clamped resonances. */
int oracle_make_members(struct oracle_model *model, double lambda)
{
    struct extent member = {0};
    int status;

    model->cells = model->members = 0;
    for (int i = 0; i + 1 < model->stations; i++) {
        const struct oracle_segment *segment = model->piece[i];
        double z = model->station[i].z, length = model->station[i + 1].z - z;
        int parts = 0;
        struct extent part;
        do {
            parts += 1 + parts / 8;
            part = (struct extent){0};
            extend(&part, segment, length / parts, NULL);
        } while (clamped_bound(&part) <= 2.0 * lambda && parts <= ORACLE_MEMBERS_MAX);
        for (int k = 0; k < parts; k++) {
            struct oracle_cell cell = {segment, z + k * (length / parts), length / parts, k == 0 ? i : -1, 1};
            struct extent joined = member;
            if (k == 0 && !model->station[i].must_be_node) {
                extend(&joined, segment, length / parts, &model->station[i]);
                cell.node = clamped_bound(&joined) <= 1.5 * lambda;
            }
            status = add_cell(model, cell);
            if (status)
                return status;
            member = cell.node ? part : joined;
            model->member[model->members - 1].mixed = cantilever_bound(&member) > 2.0 * lambda;
        }
    }
    number_dofs(model);
    return make_room(model);
}
