/* Where a cause acts along the axis of the rotor. */
#ifndef ROTID_RESULT_CAUSE_PLACE_H
#define ROTID_RESULT_CAUSE_PLACE_H

#include "rotid.h"

struct cause_place {
    double from, to; /* from <= to [m] */
    double ci[2];    /* 95 % interval of the place [m], NaN where it is not searched for or not stated */
};

/* 0: the cause has no place, or the geometry (may be NULL) does not know its target. */
int cause_place(const rotid_geometry *geometry, const rotid_cause *cause, struct cause_place *place);

#endif
