/* What the causes of the measurement chain share.
 *
 * The noise of a shape is stated relative to the largest component as it was measured, with the fault still in it. Taking the
 * fault out may change which component is the largest; the noise in absolute terms stays what it is, so that the likelihood of
 * corrected data is that of a prediction with the fault in it and of data as read. */
#ifndef ROTID_DIAGNOSE_CAUSES_SENSOR_H
#define ROTID_DIAGNOSE_CAUSES_SENSOR_H

#include "base/pool.h"
#include "run/job.h"

/* All positions at once: counted from the other end, from a wrong origin, with a wrong length. */
struct sensor_line {
    int flip;
    double shift, scale; /* [m], [1]: 0 and 1 where they are as stated */
};

/* Where a sensor sits that is stated at z [m]: shift + scale z from the left end, with flip from the right one. */
double sensor_line_place(const struct sensor_line *line, double length, double z);

/* Whether sensors stated at z [n], increasing, all have a place of their own on the rotor then; a line may end a little beyond
 * it, as its error does: its end is that of the rotor. */
int sensor_line_fits(const struct sensor_line *line, double length, int n, const double *z);

/* Index of a sensor, -1 where there is none of that id. */
int sensor_find(const struct job *job, int id);

/* Divides each mode by its largest component. The standard deviations, relative to it, stay. Before a correction. */
void shapes_scale(struct job *job);

/* Divides each mode and its standard deviations by its largest component. After a correction. */
void shapes_rescale(struct job *job);

/* Components and standard deviations of sensor s (an index) by a factor, of the standard deviations its size; between
 * shapes_scale and shapes_rescale, which it calls. */
void shapes_multiply(struct job *job, int s, double factor);

/* Exchanges what sensors a and b (indices) read, with the noise of it. */
void shapes_exchange(struct job *job, int a, int b);

/* Sensors a and b (indices) change their places in the list, with all that refers to them. */
void sensors_exchange(struct job *job, int a, int b);

/* Keeps the data as they were read in job->raw, unless they are kept already. ROTID_OK or ROTID_ERROR_MEMORY. */
int corrections_keep_raw(struct pool *pool, struct job *job);

#endif
