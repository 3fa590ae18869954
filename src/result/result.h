/* A result as a whole: what the program writes with --json, and what `report` reads. */
#ifndef ROTID_RESULT_RESULT_H
#define ROTID_RESULT_RESULT_H

#include "base/message.h"
#include "result/head.h"
#include "rotid.h"

struct result {
    struct result_head head;
    /* of the command that head.command names; the others are NULL */
    rotid_check *check;
    rotid_spectrum *modes;
    rotid_identification *identify;
    rotid_diagnosis *diagnose;
    int nwarnings;
    const char **warnings; /* what the reader of the deck, the pairing and the fit have to say; empty where there is nothing */
};

/* The result as JSON: a text to be freed with json_free, or NULL where memory is out. */
char *result_json(const struct result *result);

#endif
