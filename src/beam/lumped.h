/* Lumped masses and springs to the ground at any place of the axis: those that effects put there, and the springs of the deck
 * that an effect may move. The element around the place carries them with its own static shapes, those that its consistent mass
 * matrix integrates, so that nothing jumps as the place crosses a node; a mass at a node is a disk, and a spring at a node the
 * deck's. Inside an element the jump of the shear force and of the moment is beyond these shapes. A spring therefore acts in
 * series with the flexibility G of its place between the clamped ends of the element, which is what the shapes leave out: exact
 * for a static load, however stiff the spring is. A mass does without: the error is of first order in l, 1e-5 of the frequency
 * for 5 kg on a thin end of the paper's rotor. */
#ifndef ROTID_BEAM_LUMPED_H
#define ROTID_BEAM_LUMPED_H

#include "beam/beam.h"
#include "beam/element.h"

/* v and theta at xi in [0, 1] of the element for unit displacements of its ends. [4] each. */
struct lumped_shape {
    double v[4], theta[4];
};

/* The shapes at xi, and their derivatives with respect to xi and to phi = 12 EI/(kGS l^2); those may be NULL. */
void lumped_shapes(const struct element *element, double xi, struct lumped_shape *n, struct lumped_shape *by_xi,
                   struct lumped_shape *by_phi);

struct lumped { /* one of them; start with i = -1 and the rest 0 */
    int effect, i;
    int spring;  /* behind the effects, which are rotor.neffect then: that of the deck, from 1 */
    int element; /* that carries it: what is at the very node of a hinge is on the node, like a disk */
    int clamped; /* its place lies outside the axis, and the end of the axis is taken instead */
    struct effect_point point;
};

/* The next one; 0 when there are no more. */
int lumped_next(const struct beam *beam, struct lumped *lumped);

/* Adds to k [16] of its element B' (S^-1 + G)^-1 B, B = [v; theta], S = diag(lateral, rotational), unless the beam is to be
 * elastic_only, and to m [16] mass v v' + inertia theta theta'. */
void lumped_add(const struct beam *beam, const struct lumped *lumped, const struct element *element, double *k, double *m);

/* Adds the derivatives to dk and dm, d being the direction of the element's quantities. Returns 0 where it adds nothing. */
int lumped_differentiate(const struct beam *beam, struct parameter parameter, const struct lumped *lumped,
                         const struct element *element, const struct element *d, double *dk, double *dm);

#endif
