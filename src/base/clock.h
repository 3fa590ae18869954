/* Wall-clock time for reports. Timings decide nothing. */
#ifndef ROTID_BASE_CLOCK_H
#define ROTID_BASE_CLOCK_H

double clock_seconds(void); /* since an arbitrary moment */

#endif
