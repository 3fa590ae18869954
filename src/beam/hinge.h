/* Joints: a massless rotational spring in series with an element, at the end of it that lies at the interface, statically
 * condensed.
 *
 * This comment states which part is attached to which side. The node at the interface, with all parts attached to the node (tie
 * rods, springs, disks, masses at that very place), is on one side of the joint, the element with the hinge on the other. Where a
 * bundle of tie rods begins or ends at the interface, the bundle presses the joint together and holds on to the parts outside:
 * the hinge is in the element between the ends of the bundle. Elsewhere, and between two bundles, the hinge is in the element
 * left of the interface. */
#ifndef ROTID_BEAM_HINGE_H
#define ROTID_BEAM_HINGE_H

#include "beam/beam.h"
#include "beam/element.h"

/* Places the hinges of all joints on the mesh. ROTID_OK or ROTID_ERROR_MEMORY. */
int hinge_place(struct pool *pool, struct beam *beam);

/* Whether element e has a hinge. */
int hinge_in(const struct beam *beam, int e);

/* Whether one sits at this end (0 left, 1 right) of element e. */
int hinge_at(const struct beam *beam, int e, int end);

/* Condenses the hinges of element e: K and M [16] of the element, with what is lumped in it, become those between the nodes.
 */
void hinge_condense(const struct beam *beam, int e, double *k, double *m);

/* dK and dM at the same time, k and m being those of the element with what is lumped in it; all four are overwritten. */
void hinge_differentiate(const struct beam *beam, struct parameter parameter, int e, double *k, double *m, double *dk,
                         double *dm);

/* One hinge of flexibility c at `end`, with b the unit vector of its rotation, g = K b and k = b'g: the rotation of the element's
 * end is T u, T = I - b g' c/(1 + c k), and K := T'K T + g g' c/(1 + c k)^2 = K - g g' c/(1 + c k), M := T'M T. dk and dm, both
 * or neither NULL, follow, dc being the derivative of c. */
void hinge_apply(double c, double dc, int end, double *k, double *m, double *dk, double *dm);

#endif
