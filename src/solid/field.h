/* What the values of a rotor and its causes make of the material of an element, share by share. */
#ifndef ROTID_SOLID_FIELD_H
#define ROTID_SOLID_FIELD_H

#include "solid/solid.h"

struct share { /* one of an element; as a derivative: its rate */
    struct elasticity elasticity;
    double rho, stress; /* kg/m3; Pa, axial, tension positive */
};

void field_of_share(const struct solid *solid, const struct solid_element *element, int share, struct share *out);

/* Its derivative with respect to a parameter; returns 0 where that is zero. */
int field_derivative(const struct solid *solid, const struct solid_element *element, int share, struct parameter parameter,
                     struct share *rate);

#endif
