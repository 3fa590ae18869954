/* Windows of a hammer test. Both leave the form of a transfer function as it is. */
#ifndef ROTID_SIGNAL_WINDOW_H
#define ROTID_SIGNAL_WINDOW_H

/* Mean of x [n], n >= 1. */
double window_mean(int n, const double *x);

/* Force after its mean before the impact was taken off: kept for the first `keep` samples, then faded by
 * (1 + cos(pi j/(fade + 1)))/2, j = 1 ... fade, then zero: what the channel shows after the pulse is noise. x [n]; keep, fade >=
 * 0. */
void window_force(int n, int keep, int fade, double *x);

/* Decay [1/s] of the exponential window that falls to `end` over n samples at `rate` [Hz]: ln(1/end) rate/n; 0 < end <= 1.
 *
 * On force and response alike it changes nothing but the poles. Where x(t) is the integral of h(t - s) f(s) ds,
 *     exp(-d t) x(t) = integral of [exp(-d (t - s)) h(t - s)] [exp(-d s) f(s)] ds,
 * so the windowed signals obey exp(-d t) h(t), whose poles are lambda - d with the same residues, exactly and for any force. On
 * the response alone it would do so only for a pulse of no length. */
double window_decay(int n, double end, double rate);

/* weight_j = exp(-decay j/rate), [n]. */
void window_exponential(int n, double decay, double rate, double *weight);

#endif
