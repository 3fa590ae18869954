/* The sets of a universal file that say how far its modes can be trusted. */
#ifndef ROTID_DECK_DECK_UFF_STD_H
#define ROTID_DECK_DECK_UFF_STD_H

#include "deck/deck_cards.h"
#include "uff/uff.h"

/* Reads file->extra of a file that MEASURED names at `path`, after its modes: chosen [count] are the sets behind the modes of the
 * job, component is the value of a node that DIRECTION asks for where there are several. Sets 55 of analysis type 0, behind a
 * mode n of the file, by their first line of text: ROTID STANDARD DEVIATION OF MODE n: of the components, in their unit; the
 * second line of text is FREQUENCY_HZ value DAMPING value, standard deviations as well; ROTID FREQUENCY AT POINT OF MODE n: Hz,
 * with the accelerometer at each node, less what a second line ABOVE_HZ value says; ROTID STANDARD DEVIATION OF FREQUENCY AT
 * POINT OF MODE n: Hz. They fill frequency_std, shape_std and the frequencies at single sensors of the job. Zero stands for what
 * is not known; sets with other texts are left alone. Anything malformed is an error of the deck. */
void deck_uff_std(struct deck_reader *reader, const char *path, const struct uff_file *file, int count,
                  const struct uff_shape *const *chosen, int component);

#endif
