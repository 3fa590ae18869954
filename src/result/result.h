/* A result as a whole: the program writes it with --json, `report` reads it. */
#ifndef ROTID_RESULT_RESULT_H
#define ROTID_RESULT_RESULT_H

#include "base/message.h"
#include "result/head.h"
#include "result/place.h"
#include "rotid.h"

/* A key that an older result does not hold, and the part of the page that is left out for it. */
struct lacking {
    const char *key, *shows; /* "geometry", "the drawing of the rotor" */
};
#define LACKING_MOST 4

/* What a command found of one of several states. */
struct result_state {
    const char *name; /* of the *STATE */
    /* of the command; the others are NULL */
    rotid_check *check;
    rotid_spectrum *modes;
    const struct sensitivity *sensitivity;
    const struct transfer_result *frf;
};

struct result {
    struct result_head head;
    /* of the command that head.command names, of several states the first one's; the others are NULL */
    rotid_check *check;
    rotid_spectrum *modes;
    rotid_identification *identify;
    rotid_diagnosis *diagnose;
    rotid_suggestion *suggest;
    const struct sensitivity *sensitivity;
    const struct transfer_result *frf;
    const struct ema_result *ema;
    const struct uff_result *uff;
    const struct export_result *export;
    const struct study_result *study;
    int nstates;
    struct result_state *states; /* of a deck with several *STATE what each has, in its order; none of a deck that is one state.
                                    What stands beside it is of the first */
    int nwarnings;
    const char **warnings; /* what the reader of the deck, the pairing and the fit have to say; empty where there is nothing */
    /* of a result that was read from a file */
    const char *file; /* as given */
    int nlacking;
    struct lacking lacking[LACKING_MOST];
    cJSON *json; /* as it stands there, of a file of results the list of its lines; deleted by whoever read it */
};

/* Who reads the file of results of a study, which has a value a line. */
typedef void result_lines_reader(const struct json_place *lines, struct result *result);

/* The result as JSON: a text to be freed with json_free of result/json_tree.h; NULL where memory is out, or was when the part of
 * the command was made and that is NULL. */
char *result_json(const struct result *result);

/* Reads a file that a command wrote with --json, or a file of results of a study. The structs hang on the pool, result->json does
 * not. ROTID_OK;
 * ROTID_ERROR_IO: the file cannot be read; ROTID_ERROR_SYNTAX: no JSON, no such result, or one that contradicts itself;
 * ROTID_ERROR_MEMORY. The messages say what and where. */
int result_read(struct pool *pool, const char *file, struct message_list *messages, result_lines_reader *read_lines,
                struct result *result);

/* What the lengths of its lists, the order of its candidates and the sizes of its rotor have to be for a result to be used: told
 * as a mistake of `root` where they are not. */
void result_check(const struct json_place *root, const struct result *result);

/* The rotor of a result, the fit that it is about (its own, or the model that a diagnosis judged), the noise of its data; NULL
 * where it has none. */
const rotid_geometry *geometry_of_result(const struct result *result);
const rotid_identification *fit_of_result(const struct result *result);
const rotid_noise *noise_of_result(const struct result *result);

#endif
