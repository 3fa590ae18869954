/* A hammer test of a rotor as it would be recorded: time records of force and acceleration, and the truth beside them. Modes come
 * from exact dynamic stiffness (tools/oracle), the rotor from a deck (tools/hide); nothing is shared with librotid.
 *
 * What is recorded. The accelerance between the hammer's and the sensor's point is
 *
 *     A(s) = s^2 ( sum_k phi_hk phi_sk / (s^2 + 2 zeta_k omega_k s + omega_k^2) + S(-s^2) )
 *
 * over all modes up to 1.2 times the sampling rate; S, a cubic of omega^2, is what the higher ones add, from the exact
 * receptance. The hammer's pulse is half a sine. Both channels pass one and the same anti-alias filter (Chebyshev, 12 poles, 0.1
 * dB, edge at 0.4 of the sampling rate), so response over force is A whatever the filter does in the band. Every pole's answer to
 * the pulse is known in closed form, so no time is stepped and only what the filter lets through above half the sampling rate is
 * aliased.
 *
 * All is in memory and, once open, only read: records may be made in several threads at once. SI units, 0-based arrays. */
#ifndef HAMMER_H
#define HAMMER_H

#include <complex.h>
#ifndef CMPLX /* glibc has it for gcc alone */
#define CMPLX(re, im) __builtin_complex((double)(re), (double)(im))
#endif
#include <stddef.h>
#include <stdint.h>

#include "oracle/oracle.h"

enum {
    HAMMER_OK = 0,
    HAMMER_INPUT = 2,  /* the deck or an option does not fit; the message says what was expected */
    HAMMER_FAILURE = 3 /* no memory, or the oracle gave up */
};

#define HAMMER_MOST_MODES   300
#define HAMMER_REST         4   /* coefficients of S */
#define HAMMER_EDGE         0.4 /* of the filter, times the sampling rate: what folds down to f comes from rate - f */
#define HAMMER_MOST_FAULTS  16
#define HAMMER_MOST_DAMPING 32

enum hammer_fault_kind {
    HAMMER_DEAD,      /* nothing but a thousandth of the response's rms as noise */
    HAMMER_DUPLICATE, /* records what point `other` responds */
    HAMMER_FLIP,      /* the other sign */
    HAMMER_GAIN,      /* times value */
    HAMMER_LOOSE      /* the sensor's mount resonates at `value` Hz (damping ratio 0.02): a second peak */
};

struct hammer_fault {
    enum hammer_fault_kind kind;
    long id, other; /* nodes */
    double value;
};

struct hammer_options {
    double rate, band_hz; /* sampling rate [Hz]; end of the band that is measured, at most 0.4 of the rate */
    double seconds;    /* length of a record; 0: a power of two of samples after which the slowest elastic mode is down to 1e-4 */
    double pretrigger; /* s before the impact */
    int impacts;       /* per point */
    int roving_hammer; /* the sensor stays and the hammer goes from point to point; else the other way round */
    long fixed;        /* node of what stays; 0: the first one of the deck */
    double sensor_mass;             /* kg, wherever the sensor is */
    double pulse_short, pulse_long; /* s, duration of the half-sine, drawn between them for every impact */
    double force, force_spread;     /* N, peak before the filter; relative, drawn within +- that */
    double noise, force_noise; /* white, standard deviation: relative to the response's rms over the record; to the peak of the
                                  force */
    double floor;              /* of the converter, both channels: relative to the largest value of the record */
    double double_hits;        /* probability of a second, weaker pulse 4 to 20 ms later */
    double clipped;            /* probability of a force cut at 0.6 of its peak or lower */
    double drift;              /* standard deviation of one factor on all frequencies, drawn for every point (temperature) */
    double suspension_damping; /* ratio of the modes on the supports */
    int dampings;              /* ratios of the elastic modes; the last one holds for all above */
    double damping[HAMMER_MOST_DAMPING];
    int faults;
    struct hammer_fault fault[HAMMER_MOST_FAULTS];
};

/* The defaults: those of the paper's test at 8192 Hz, 3200 Hz, its damping ratios (Table 4), no noise and no faults. */
struct hammer_options hammer_options_default(void);

/* A rotor that is built in: "paper" or "beam". Its deck as text (to be freed), true values of its parameters and damping ratios
 * go into *options. NULL: no such rotor, or no memory. */
char *hammer_rotor_deck(const char *name, struct hammer_options *options, int *truths, const char *const **truth);

/* The anti-alias filter: residues at its poles of positive frequency, the conjugates go without saying; F(0) = 1. */
#define HAMMER_FILTER_PAIRS 6
struct hammer_filter {
    double complex pole[HAMMER_FILTER_PAIRS], residue[HAMMER_FILTER_PAIRS];
};
void hammer_filter_open(double rate, struct hammer_filter *filter);
double complex hammer_filter_at(const struct hammer_filter *filter, double complex s);

/* 2 Re sum_i residue_i (half-sine * exp(pole_i t)), sampled at n/rate, is added to y[0..count-1]. The half-sine begins at `start`
 * [s], lasts `duration` and has the peak `amplitude`. */
struct hammer_poles {
    int count;
    double complex pole[HAMMER_MOST_MODES + HAMMER_FILTER_PAIRS + 1], residue[HAMMER_MOST_MODES + HAMMER_FILTER_PAIRS + 1];
};
void hammer_pulse_add(const struct hammer_poles *poles, double rate, double start, double duration, double amplitude, int count,
                      double *y);

/* Modes 1 ... modes of a system at z[points]: hz[modes], shape[modes][points] with generalised mass 1 (kg). The masses are
 * integrals over the exact shapes. Status of the oracle. */
int hammer_modes(const struct oracle_system *system, int modes, int points, const double *z, double *hz, double *shape);

/* Exact undamped receptance v(z_i)/force at z_fixed [m/N] for lambda = omega^2, which may be negative. */
int hammer_receptance(const struct oracle_system *system, double lambda, double z_fixed, int points, const double *z,
                      double *receptance);

struct hammer_parameter {
    char name[128];
    double value;
};

/* An open test. Arrays by point have those of the deck's *SENSORS, in that order. */
struct hammer_test {
    struct hammer_options options;
    char *deck;                             /* its text */
    int points, modes, rigid, fixed, count; /* modes with the `rigid` ones first; index of what stays; samples of a record */
    long *id;
    double *z;
    int parameters;
    struct hammer_parameter *parameter; /* true values of *IDENTIFY */
    double *bare_hz, *bare_shape;       /* [modes], [modes][points]: without the sensor, generalised mass 1 */
    double *hz, *residue;               /* [points][modes] as recorded there: phi_fixed phi_point */
    double *rest;                       /* [points][HAMMER_REST]: of S, the constant first */
    struct hammer_filter filter;
};

/* Computes all modes. truth: "core.E=1.1e11", values of *IDENTIFY; those not given are drawn by `seed` within 15 % of the deck's.
 * HAMMER_OK, HAMMER_INPUT, HAMMER_FAILURE with a line in message[room]. Whatever it returns, hammer_close. */
int hammer_open(const char *deck, const char *name, int truths, const char *const *truth, uint64_t seed,
                const struct hammer_options *options, struct hammer_test *test, char *message, size_t room);
void hammer_close(struct hammer_test *test);

/* Damping ratio of mode 0 ... modes-1, the rigid ones first. */
double hammer_damping(const struct hammer_test *test, int mode);

/* Accelerance [1/kg] between the fixed point and this one, without faults, noise and drift. */
double complex hammer_frf(const struct hammer_test *test, int point, double complex s);

struct hammer_impact {                /* what was drawn */
    double start, duration, peak;     /* s, s, N */
    double second_start, second_peak; /* of a double hit; peak 0: a single one */
    double drift;                     /* factor on the frequencies */
    int clipped;
};

/* One impact at one point: force[count], response[count] (m/s2). The same arguments give the same record, in any order. */
void hammer_record(const struct hammer_test *test, uint64_t seed, int point, int impact, double *force, double *response,
                   struct hammer_impact *drawn);

/* Files; HAMMER_OK or HAMMER_FAILURE with a message. Each is whole or not there. Measurement number point * impacts + impact + 1
 * is a set 58 of the force and one of the acceleration, tied by the same load case. truth_path, deck_path may be NULL. */
int hammer_write(const struct hammer_test *test, uint64_t seed, int ascii, const char *records_path, char *message, size_t room);
int hammer_write_truth(const struct hammer_test *test, uint64_t seed, const char *path, char *message, size_t room);
int hammer_write_deck(const struct hammer_test *test, const char *modes_file, const char *path, char *message, size_t room);
/* The deck with *STATE, this state of which was tested: its *MEASURED names the modes file, and the other states stay as they
 * are. */
int hammer_write_state(const char *deck, const char *state, const char *modes_file, const char *path, char *message, size_t room);

#endif
