/* The modes of a test as a universal file that `identify` and `diagnose` take: docs/uff.md, "Modes with standard deviations". */
#ifndef ROTID_IMPORT_MODES_H
#define ROTID_IMPORT_MODES_H

#include <stdio.h>

#include "ema/ema.h"
#include "import/measurement.h"

/* Sets 151, 164 (SI), 2411 (the nodes of the shapes; those without coordinates are left out), and per mode a set 55 of a real
 * normal mode, a set 55 of analysis type 0 with its standard deviations, and two more of them with the frequencies at each point
 * where ema holds any. `source`: the file that was measured, for the text lines. ROTID_OK, ROTID_ERROR_IO, _MEMORY. */
int modes_write(FILE *stream, const char *source, const char *program, const struct measurement *measurement,
                const struct ema *ema);

#endif
