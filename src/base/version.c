#include "rotid.h"

const char *rotid_version(void)
{
    return ROTID_VERSION;
}
