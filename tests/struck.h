/* A hammer test whose result is known in closed form: modes with the impulse response sum R/wd exp(-zeta w0 t) sin(wd t), hit by
 * half-sine pulses, sampled without any integration in time. */
#ifndef ROTID_TESTS_STRUCK_H
#define ROTID_TESTS_STRUCK_H

#include "signal/signal.h"

struct struck_mode {
    double frequency_hz, damping, residue; /* R = phi_response phi_force/m [1/kg] */
};

struct struck {
    int nmode;
    const struct struck_mode *mode;
    enum frf_quantity quantity;
    double width; /* s of the half-sine */
    double rate;
};

double complex struck_pole(const struct struck_mode *mode);

/* H at s: sum R s^q/((s - lambda)(s - conj(lambda))); s = i omega + decay is what an exponential window shows. */
double complex struck_transfer(const struct struck *struck, double complex s);

/* Adds the pulse of the given peak [N] that begins at `start` [s], and what it makes respond, to force and response [count]. */
void struck_hit(const struct struck *struck, double start, double peak, long long count, double *force, double *response);

/* Fresh zeroed samples on the test's pool. */
struct time_record struck_record(long long count);

/* The samples of such a record, to be written to. */
double *struck_force(const struct time_record *record);
double *struck_response(const struct time_record *record);

/* Adds normal noise of the given standard deviation. */
void struck_noise(uint64_t *seed, double deviation, long long count, double *x);

#endif
