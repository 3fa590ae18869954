/* Wall-clock time for reports, and for when a run of a study has taken too long. Timings decide nothing else. */
#ifndef ROTID_BASE_CLOCK_H
#define ROTID_BASE_CLOCK_H

double clock_seconds(void); /* since an arbitrary moment */

#endif
