/* Where a cause acts on the rotor. */
#ifndef ROTID_PAGE_CAUSE_PLACE_H
#define ROTID_PAGE_CAUSE_PLACE_H

#include "rotid.h"

/* Along the axis, from <= to [m]; ci: the 95 % interval of its place, NaN where it is not searched for or not stated. */
struct cause_place {
    double from, to, ci[2];
};
/* 0: the cause has no place, or the geometry (may be NULL) does not know it. */
int cause_place(const rotid_geometry *geometry, const rotid_cause *cause, struct cause_place *place);

#endif
