/* A plan of many runs, as its file states it: keyword cards, docs/study.md. */
#ifndef ROTID_STUDY_PLAN_H
#define ROTID_STUDY_PLAN_H

#include "deck/deck_text.h"

enum plan_command { PLAN_IDENTIFY, PLAN_DIAGNOSE };

struct plan_deck {
    const char *name, *path; /* as written; as seen from where the program runs */
    struct place place;
};

struct plan_variant {
    const char *name;
    int noverride;
    struct override *override; /* their text is that of `place` below, so that what the deck says of them can be placed */
    struct place *place;       /* [noverride] */
};

struct plan_modes { /* what FIT, MODES= takes */
    const char *text;
    struct place place;
};

struct plan_sensors { /* keep > 0: so many, drawn anew for each replicate; every > 0: the first and each one so far on; else all
                       */
    const char *text;
    int keep, every;
    struct place place;
};

struct plan_noise { /* relative standard deviations, 0: none is added; shape NaN where the line states none */
    double frequency, shape;
};

struct plan_truth { /* a parameter of the model that makes the data, drawn between the two */
    const char *name;
    double lower, upper;
    struct place place;
};

struct plan_hide {
    const char *name;
    const struct card *lower, *upper; /* CAUSE cards with the values at either end; NULL: nothing is hidden */
    struct place place;
};

struct plan {
    const char *path; /* NULL where decks were named on the command line */
    struct deck_text text;
    enum plan_command command;
    unsigned long seed;
    int replicates, baseline, bootstrap; /* bootstrap: replicates inside a diagnosis, 0: its own choice */
    int ndeck;
    struct plan_deck *deck;
    /* axes; one that is not in the file has one entry, with a name or text of NULL */
    int nvariant, nmodes, nsensors, nnoise, nhide;
    struct plan_variant *variant;
    struct plan_modes *modes;
    struct plan_sensors *sensors;
    struct plan_noise *noise;
    struct plan_hide *hide;
    int has_noise;
    int from_model; /* DATA, SOURCE=MODEL */
    int no_shapes;  /* DATA, SHAPES=NO */
    int ntruth;
    struct plan_truth *truth;
    double spread;   /* of the starts, relative; 0: those of the deck */
    int count, grid; /* starts drawn for each replicate; or points along each parameter */
};

/* Reads a plan; every error goes to the list with its place. ROTID_OK, ROTID_ERROR_SYNTAX, ROTID_ERROR_IO, ROTID_ERROR_MEMORY. */
int plan_read(struct pool *pool, const char *path, struct message_list *messages, struct plan *plan);

/* The plan that runs each deck once as it stands. ROTID_OK or ROTID_ERROR_MEMORY. */
int plan_of_decks(struct pool *pool, int count, char *const *path, struct plan *plan);

/* Whether the cards of a file have *STUDY among them; 0 also where it cannot be read. */
int plan_is(const char *path);

#endif
