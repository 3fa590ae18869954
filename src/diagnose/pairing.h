/* Which mode of the model each measured mode is, as long as the model is not the right one. */
#ifndef ROTID_DIAGNOSE_PAIRING_H
#define ROTID_DIAGNOSE_PAIRING_H

#include "diagnose/round.h"

/* Leaves out measured mode k, which looks like no mode of the base and whose number the shape of another one claims, with a finding.
 */
int pairing_drop(struct engine *engine, int k);
/* A finding for every mode that engine->number takes for another one than `number` [nmode], the deck's. */
int pairing_note(struct engine *engine, const int *number);
/* The data `measured`, modes that were left out among them, take the place of those that are judged, with the pairing `number`,
 * and what was found about pairing is that. Nothing where it is the pairing there is. ROTID_OK or ROTID_ERROR_MEMORY. */
int pairing_adopt(struct engine *engine, const struct job_measurement *measured, int *number);
/* The findings about pairing again, the data and the base being others. */
int pairing_note_again(struct engine *engine);
/* Behind the refits of a round, while nothing is named: the data as measured, modes that were left out among them, are paired anew
 * beside every refit. Where one of them explains all modes that way, its pairing is settled for all, the findings of another one
 * are taken back, and the round has to be repeated: *changed. Without shapes shifts and gaps of the numbers are tried instead. */
int pairing_settle(struct engine *engine, const struct round_result *result, int *changed);

#endif
