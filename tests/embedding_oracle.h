/* The truth behind the hosts of docs/examples, by exact dynamic stiffness (tools/oracle), with no help of librotid. */
#ifndef ROTID_TESTS_EMBEDDING_ORACLE_H
#define ROTID_TESTS_EMBEDDING_ORACLE_H

/* Natural frequencies [4] of the free shaft of the deck that runs in these tests, whose core has these moduli: E = 1.1e11 and
 * G = 4e10 Pa is the truth. */
void embedding_rotor_hz(double young, double shear, double hz[4]);
/* What those frequencies say of E and G where each has the relative standard deviation hz_std: linear least squares around the
 * truth. */
void embedding_rotor_std(double hz_std, double std[2]);
/* That deck, with these frequencies. */
#define EMBEDDING_DECK                                                                                                           \
    "*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.30\n*DENSITY\n7850\n*MATERIAL, NAME=lamination\n*ELASTIC, TYPE=SHEAR\n"          \
    "0.8e11, 0.3e11, 0.28\n*DENSITY\n7650\n*SHAFT, NAME=left, MATERIAL=steel\n0.30, 0.08, 0, 60\n*SHAFT, NAME=core, "            \
    "MATERIAL=lamination\n0.50, 0.20, 0, 120\n*SHAFT, NAME=right, MATERIAL=steel\n0.25, 0.07, 0, 50\n*MODES\n1, %.6f\n"          \
    "2, %.6f\n3, %.6f\n4, %.6f\n*NOISE, FREQUENCY=0.001\n*IDENTIFY\ncore.E, 1e9, 1e12, 0.8e11\ncore.G, 1e9, 1e12, 0.3e11\n"

enum { STEPPED_MODES = 4, STEPPED_SENSORS = 6, STEPPED_RESIDUALS = STEPPED_MODES * (1 + STEPPED_SENSORS) };
/* Frequencies, and shapes [sensors * modes] with the largest component +1, of the clamped shaft of stepped_beam.f90 with Young's
 * modulus x[0] in its middle section and a bearing of stiffness x[1] at its end. */
void embedding_stepped(const double x[2], double hz[STEPPED_MODES], double *shape);

/* What its measured values say, by linear least squares around x with differences of the exact solution: the step [2] to their
 * optimum, the standard deviations [2] of the parameters, and chi square at x. Frequencies have the relative standard deviation
 * hz_std, shapes that of `shape_std` of their largest measured component, and each shape its best scale. */
void embedding_stepped_estimate(const double x[2], const double *hz, const double *shape, double hz_std, double shape_std,
                                double step[2], double std[2], double *chi2);

#endif
