/* What of a rotor can vary, by name: the modulus of a group, the stiffness of a spring, the depth of a cause. */
#ifndef ROTID_ROTOR_PARAMETER_H
#define ROTID_ROTOR_PARAMETER_H

#include "rotor/effect.h"
#include "rotor/rotor.h"

enum parameter_kind {
    PARAMETER_E,
    PARAMETER_G,
    PARAMETER_NU,
    PARAMETER_RHO,
    PARAMETER_TIEROD_E,
    PARAMETER_TENSION,
    PARAMETER_SPRING_K,
    PARAMETER_SPRING_K_ROT,
    PARAMETER_DISK_MASS,
    PARAMETER_DISK_INERTIA,
    PARAMETER_EFFECT
};

struct parameter {
    enum parameter_kind kind;
    int index;       /* of the group, tie rod, spring, disk or effect */
    int component;   /* of the effect, else 0 */
    int nalso;       /* of E, G, nu or rho: groups that have it in common with that one, */
    const int *also; /* [nalso] which the owner of the parameters keeps */
};

#define PARAMETER_SHARED_BY '=' /* "left.E=right.E" is one parameter of two groups */

/* The next name of "left.E=right.E" to `name` [PARAMETER_NAME]. Returns what follows, or NULL behind the last one. */
#define PARAMETER_NAME 1100 /* as long as a line of a deck */
const char *parameter_next_name(const char *names, char name[PARAMETER_NAME]);

/* Whether it is a value of the material of this group. */
int parameter_is_of_group(const struct parameter *parameter, int group);

/* Whether both have a value in common. */
int parameters_overlap(const struct parameter *a, const struct parameter *b);

/* Finds "group.E", "group.G", ".nu", ".rho", "tierod.E", ".tension", "spring.k", ".k_rot", "disk.mass", ".inertia", and the
 * parameters of effects that have a name, "cause.depth". Returns 0 and *parameter, 1 when no object has that name, 2 when the
 * object has no such parameter; *unit is set with 0. */
int parameter_find(const struct rotor *rotor, const char *name, struct parameter *parameter, const char **unit);

/* The names there are, "left.E, left.G, ...", for messages; of the object alone that `of` ("left.x") names where there is one.
 * Behind PARAMETERS_LISTED of them their number. NULL where memory is out. */
#define PARAMETERS_LISTED 24
const char *parameter_list(struct pool *pool, const struct rotor *rotor, const char *of);

/* Its value in the rotor, to read or to set. G of an isotropic material is not stored: give the group a G of its own first. */
double *parameter_value(const struct rotor *rotor, struct parameter parameter);

/* Sets n parameters to x [n], shared ones in all their groups. */
void parameters_set(const struct rotor *rotor, int n, const struct parameter *parameter, const double *x);

#endif
