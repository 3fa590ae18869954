/* Members: how the pieces of the beam are cut and joined for one frequency.
 *
 * No member may resonate below the frequency with its ends clamped, so that the count of Wittrick and Williams needs no J0. A
 * member is as long as that allows and may then run over several pieces and lumped masses, its transfer matrix being the product
 * of theirs. This is for accuracy: a chain of n short members per half-wave has stiffnesses n^4 times as large as its inertia
 * forces, which would cost as many digits of the frequency. For the same reason the members are made anew for every frequency. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "oracle_model.h"

/* What bounds the first natural frequency of a member that is clamped at both ends. */
struct extent {
    double length, bending, shear, mass, inertia, compression; /* the least EI, kGS and the largest rhoS, rhoI, -F in it */
    double lumped_mass, lumped_inertia, spring, rotational_spring; /* sums */
};

/* Adds a length of a segment with the station at its left end, which the first part of a member leaves to the node. */
static void extend(struct extent *extent, const struct oracle_segment *segment, double length,
                   const struct oracle_station *station)
{
    if (extent->length == 0.0) {
        *extent = (struct extent){length, segment->bending, segment->shear, segment->mass, segment->inertia, -segment->axial,
                                  0.0, 0.0, 0.0, 0.0};
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

/* A lower bound of lambda = omega^2 of all motions with v = theta = 0 at both ends of a length l; 0 if there is none.
 *
 * Let U = int EI theta'^2 + kGS gamma^2 with gamma = v' + theta, the norms be those of L2, and EI, kGS the least, rhoS, rhoI, P =
 * -F the largest values. The mean of v' = gamma - theta vanishes, so v' = (gamma - mean) - (theta - mean). theta is periodic as
 * it vanishes at both ends, so |theta - mean| <= l/(2 pi) |theta'|, and |theta| <= l/pi |theta'|, |v| <= l/pi |v'|. With Cauchy
 * and Schwarz
 *     |v'|^2 <= (|gamma| + l/(2 pi) |theta'|)^2 <= c U,   c = 1/kGS + l^2/(4 pi^2 EI),
 * where 1/c is the buckling load of Engesser. Twice the potential energy is at least (1 - P c) U if P > 0, at least U otherwise,
 * and
 *     int rhoS v^2 + rhoI theta^2 <= (l/pi)^2 (rhoS c + rhoI/EI) U.
 * A value is bounded like the deflection of a string, v(a)^2 <= l/4 |v'|^2 and theta(a)^2 <= l/4 |theta'|^2, so lumped masses add
 * l/4 (m c + Id/EI) U. Springs only raise lambda. The quotient of the two is the bound. For a slender uniform member it is
 * 4 pi^4 EI/(rhoS l^4), 12 % below the true 22.37^2 in terms of omega. */
static double clamped_bound(const struct extent *e)
{
    const double pi = 3.14159265358979323846;
    double c = 1.0 / e->shear + e->length * e->length / (4.0 * pi * pi * e->bending);
    double kinetic = e->length * e->length / (pi * pi) * (e->mass * c + e->inertia / e->bending) +
                     0.25 * e->length * (e->lumped_mass * c + e->lumped_inertia / e->bending);

    if (e->compression * c >= 1.0)
        return 0.0;
    /* Springs much stiffer than the member itself would spoil the transfer matrix, in which they multiply its flexibility. */
    if (0.25 * e->length * (e->spring * c + e->rotational_spring / e->bending) > 1.0)
        return 0.0;
    return (1.0 - fmax(e->compression, 0.0) * c) / kinetic;
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

/* Gives every node its degrees of freedom and every member those of its two ends. */
static int number_dofs(struct oracle_model *model)
{
    int dofs = 0, member = -1;
    int *member_dof = grow(model->member_dof, &model->member_room, model->members, 4 * sizeof(*member_dof));

    if (!member_dof)
        return ORACLE_ERROR_MEMORY;
    model->member_dof = member_dof;
    for (int i = 0; i < model->stations; i++)
        model->station[i].dof[0] = -1;
    for (int i = 0; i <= model->cells; i++) {
        int station = i < model->cells ? model->cell[i].station : model->stations - 1;
        int hinged = station >= 0 && model->station[station].hinged;
        int dof[4] = {dofs, dofs + 1, dofs + 1 + hinged, dofs + 2 + hinged};
        if (i < model->cells && !model->cell[i].node)
            continue;
        dofs += 2 + 2 * hinged;
        if (station >= 0)
            memcpy(model->station[station].dof, dof, sizeof(dof));
        if (member >= 0) {
            member_dof[4 * member + 2] = dof[0];
            member_dof[4 * member + 3] = dof[1];
        }
        if (++member < model->members) {
            member_dof[4 * member] = dof[0];
            member_dof[4 * member + 1] = dof[2];
        }
    }
    model->dofs = dofs;
    return ORACLE_OK;
}

static int make_room(struct oracle_model *model)
{
    size_t n = 2 * (size_t)model->dofs;

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
    model->dof_room = 2 * model->dofs;
    return ORACLE_OK;
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
        struct extent part, joined;
        struct oracle_cell *cells;
        do {
            parts += 1 + parts / 8;
            part = (struct extent){0};
            extend(&part, segment, length / parts, NULL);
        } while (clamped_bound(&part) <= 2.0 * lambda && parts < ORACLE_DOFS_MAX);
        if (parts >= ORACLE_DOFS_MAX)
            return ORACLE_ERROR_RANGE;
        cells = grow(model->cell, &model->cell_room, model->cells + parts, sizeof(*cells));
        if (!cells)
            return ORACLE_ERROR_MEMORY;
        model->cell = cells;
        for (int k = 0; k < parts; k++) {
            struct oracle_cell *cell = &cells[model->cells++];
            *cell = (struct oracle_cell){segment, z + k * (length / parts), length / parts, k == 0 ? i : -1, 1};
            if (k == 0 && !model->station[i].must_be_node) {
                joined = member;
                extend(&joined, segment, length / parts, &model->station[i]);
                cell->node = clamped_bound(&joined) <= 1.5 * lambda;
            }
            member = cell->node ? part : joined;
            model->members += cell->node;
        }
    }
    if (model->members > ORACLE_DOFS_MAX / 2)
        return ORACLE_ERROR_RANGE;
    status = number_dofs(model);
    return status ? status : make_room(model);
}

