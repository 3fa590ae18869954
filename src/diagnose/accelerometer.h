/* An accelerometer that went from sensor to sensor: its mass and a drift, by the frequencies at single sensors. */
#ifndef ROTID_DIAGNOSE_ACCELEROMETER_H
#define ROTID_DIAGNOSE_ACCELEROMETER_H

#include "diagnose/engine.h"

/* After the base fit, where there are frequencies at single sensors: the mass of an accelerometer that went from one to the next,
 * and a drift of the frequencies. What is found becomes a finding; the mass becomes part of the judged model (MOUNT=MOVING), the
 * frequencies are those of the regression with it, and what it does to the shapes is taken out of them where the place of the
 * hammer is known, else added to their noise. Where no mass is found the shapes get room for the largest one that is not
 * excluded. *changed when anything was. Nothing where the model has such an accelerometer already. */
int data_weigh_accelerometer(struct engine *engine, int *changed);
/* What was odd about the readings, once. */
void data_note_readings(struct engine *engine);
int is_moving_accelerometer(const struct effect *effect);

/* Such an effect beside fitted shapes that nothing has freed of it: there are no frequencies at single sensors. */
int is_unweighed_accelerometer(const struct job *job, const struct effect *effect);

/* The accelerometer of the effect while it is at one sensor. */
struct effect moving_accelerometer_at(const struct effect *effect, int sensor);

#endif
