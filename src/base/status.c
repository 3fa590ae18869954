#include "rotid.h"

const char *rotid_status_text(int status)
{
    switch (status) {
#define STATUS_TEXT(name, value, text)                                                                                           \
    case value:                                                                                                                  \
        return text;
        ROTID_STATUS_LIST(STATUS_TEXT)
#undef STATUS_TEXT
    default:
        return "unknown status";
    }
}

int rotid_status_converged(int status)
{
    return status == ROTID_STOP_GRADIENT || status == ROTID_STOP_STEP || status == ROTID_STOP_OBJECTIVE;
}

const char *rotid_status_name(int status)
{
    switch (status) {
#define STATUS_NAME(name, value, text)                                                                                           \
    case value:                                                                                                                  \
        return #name;
        ROTID_STATUS_LIST(STATUS_NAME)
#undef STATUS_NAME
    default:
        return "unknown status";
    }
}
