/* What a cause changes in a rotor: fields over z, members, masses, joints. Every discretisation of a rotor asks these hooks; the
 * causes themselves live in src/diagnose/causes. An effect at its neutral values changes nothing. Every hook gives values (p < 0)
 * or their derivatives with respect to its parameter p (p >= 0), and returns 0 where the effect leaves the thing alone or the
 * derivative vanishes; the output is then not touched. A hook an effect has no use for is NULL. */
#ifndef ROTID_ROTOR_EFFECT_H
#define ROTID_ROTOR_EFFECT_H

#include "rotor/rotor.h"

#define EFFECT_MOST_PARAMETERS 4

struct effect_span { /* a stretch of the axis within one segment, from < to: an element, or the share of an integration point */
    int group, segment;
    double from, to; /* m */
};

/* Factors on the material of a stretch, none of which depends on the material's own values: E, G and rho of a group can be
 * identified beside them. Of the moduli the harmonic mean over the stretch, since the compliances of a row add up; of the density
 * the plain mean. Neutral: 1 each; derivatives: 0 each. */
struct effect_field {
    double e, g, rho;
};

/* Factors on the stiffness of a beam's section, for what beam theory itself gets wrong; nothing to a model that has no sections.
 */
struct effect_section {
    double ei, kgs;
};

struct effect_bundle {     /* of tie rods */
    double young, tension; /* factors on E (and on G with it) and on the tension */
    int as_rods;           /* nonzero: coupled as RODS whatever the deck says; not differentiated */
};

struct effect_point {           /* anywhere on the axis, which moves with the rotor there */
    double z, mass, inertia;    /* m, kg, kg.m2 */
    double lateral, rotational; /* springs to the ground [N/m, N.m/rad] */
};

/* What becomes of a spring of the deck: k := factor k, then in series with a compliance, k := k/(1 + c k), at another place. */
struct effect_spring {
    double factor;              /* on both stiffnesses */
    double lateral, rotational; /* compliance [m/N, rad/(N.m)] */
    double shift;               /* m */
};

struct effect_parameter_name {
    const char *name, *unit;
};

struct effect_kind {
    const char *id; /* of method and deck: "stiffness_local" */
    int nparameter;
    struct effect_parameter_name parameter[EFFECT_MOST_PARAMETERS];
    int at_sensor; /* nonzero: the target is a sensor */
    int (*field)(const struct effect *effect, const struct rotor *rotor, const struct effect_span *span, int p,
                 struct effect_field *field);
    int (*section)(const struct effect *effect, const struct rotor *rotor, const struct effect_span *span, int p,
                   struct effect_section *section);
    int (*tierod)(const struct effect *effect, const struct rotor *rotor, int tierod, int p, struct effect_bundle *bundle);
    int (*spring)(const struct effect *effect, const struct rotor *rotor, int spring, int p, struct effect_spring *change);
    int moves_springs; /* the hook above may give a shift, which is 0 at neutral */
    /* the i-th lumped mass or spring to the ground; with p < 0 a 0 says that there is no i-th one */
    int (*point)(const struct effect *effect, const struct rotor *rotor, int i, int p, struct effect_point *point);
    /* rotational spring in series at the end of group `target` [rad/(N.m)]; massless */
    int (*joint)(const struct effect *effect, const struct rotor *rotor, int p, double *flexibility);
    /* how many of the parameters this effect uses, which may depend on its variant; NULL: all of them */
    int (*count)(const struct effect *effect);
};

struct effect {
    const char *name; /* of the CAUSE card */
    const struct effect_kind *kind;
    int target;  /* index of the group, tie rod, spring, disk or sensor; of the group left of an interface; -1: none */
    int variant; /* of the kind, such as the shape of a soft zone */
    double value[EFFECT_MOST_PARAMETERS];
    int stays;       /* nonzero: it is no cause that was found, and another one of its kind at its target may come */
    double bound[2]; /* of its size, where a deck states them or they were widened; both 0: those of its cause */
};

/* The number of parameters in use, the first ones of the kind. */
int effect_parameters(const struct effect *effect);

#endif
