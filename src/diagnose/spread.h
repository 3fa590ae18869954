/* What a verdict leaves open of the parameters that are identified. */
#ifndef ROTID_DIAGNOSE_SPREAD_H
#define ROTID_DIAGNOSE_SPREAD_H

#include "diagnose/engine.h"

/* verdict.spread of *engine->out: of each unknown of the deck the least and the largest value over the causes that cannot be told
 * apart, and what holds all their intervals. Without such causes, or where none of them was fitted, empty. ROTID_OK or
 * ROTID_ERROR_MEMORY. */
int spread_of_alternatives(struct engine *engine);

/* Sentences, each with a blank before it; "" where there is nothing to say, NULL where memory is out.
 * Of the spread: how far the parameters lie apart between the causes. Of what is hidden: how far a cause below its detection
 * limit may have moved each parameter, of those that it moves by more than half of their 95 % interval in `fit`. */
const char *spread_sentence(struct engine *engine);
const char *hidden_sentence(struct engine *engine, const rotid_fit_result *fit);

#endif
