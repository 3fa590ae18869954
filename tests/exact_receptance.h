/* Exact receptances of a rotor from the oracle's dynamic stiffness: no mesh, no modes, no damping. */
#ifndef ROTID_TESTS_EXACT_RECEPTANCE_H
#define ROTID_TESTS_EXACT_RECEPTANCE_H

#include "exact.h"

/* v at z[i] [m] for unit lateral force at z[reference] and the circular frequency omega [rad/s], which is no natural frequency:
 * receptance [points] [m/N]. Without hinges. */
void exact_receptance(const struct exact *exact, double omega, int points, const double *z, int reference, double *receptance);

#endif
