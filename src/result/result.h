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
    const struct sensitivity *sensitivity;
    const struct transfer_result *frf;
    const struct ema_result *ema;
    const struct uff_result *uff;
    const struct export_result *export;
    const struct study_result *study;
    int nwarnings;
    const char **warnings; /* what the reader of the deck, the pairing and the fit have to say; empty where there is nothing */
};

/* The i-th command whose results have a table; NULL behind the last. */
const char *result_command(int i);
/* The table of the results of a command, NULL where no result of the command has one. */
const struct record *result_record(const char *command);

/* The result as JSON: a text to be freed with json_free, or NULL where memory is out. */
char *result_json(const struct result *result);

#endif
