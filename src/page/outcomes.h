/* What `rotid modes` writes with --json. The reader gives NULL where something is wrong: reader->status tells. */
#ifndef ROTID_PAGE_OUTCOMES_H
#define ROTID_PAGE_OUTCOMES_H

#include "result/place.h"

struct modes_entry {
    int mode;
    double full_hz, reduced_hz, reduction_percent, mesh_percent;
    double measured_hz, error_percent, mac, nco; /* NaN where no measured mode is paired with it */
    double *shape;                               /* [nsensor] */
};

struct modes_outcome {
    const char *reduction;
    int nrigid, nsensor, nmode;
    double *rigid_hz, *sensor_z;
    struct modes_entry *mode;
};

struct modes_outcome *modes_read(const struct json_place *root);

#endif
