#include "page/result.h"

#include "page/plain.h"
#include "result/ema.h"

static void read_study(const struct json_place *root, struct result *result)
{
    result->studied = study_read(root);
}

/* A file of results of a study: its first line says what it is. */
static void read_lines(const struct json_place *lines, struct result *result)
{
    struct json_place head = place_first(lines, PLACE_OBJECT);
    if (!head.json || !place_has(&head, "rotid") || !place_has(&head, "studies")) {
        place_wrong(lines, "has a value a line and is no file of results, expected one of rotid study, or one result");
        return;
    }
    result->head = (struct result_head){.command = "study",
                                        .rotid = place_string(&head, "rotid"),
                                        .commit = place_string(&head, "commit"),
                                        .seed = place_number(&head, "seed")};
    if (!lines->reader->status)
        result->studied = study_read_lines(lines);
}

int page_result_read(struct pool *pool, const char *file, struct message_list *messages, struct result *result)
{
    static const struct result_reader study = {read_study, read_lines};
    return result_read(pool, file, messages, &study, result);
}

const char *page_source(const struct result *result)
{
    return plain_file(result->ema                                   ? result->ema->source.file
                      : result->head.deck && *result->head.deck ? result->head.deck
                                                                : result->file);
}

int page_state_count(const struct result *result)
{
    return result->identify ? result->identify->nstates : result->nstates;
}

const char *page_state_name(const struct result *result, int s)
{
    return result->identify ? result->identify->states[s].name : result->states[s].name;
}

/* References go over the modes of all states. */
static void take_references(struct pool *pool, struct result_head *head, int first)
{
    rotid_reference *reference = POOL_ARRAY(pool, rotid_reference, head->nreferences);
    for (int i = 0; i < head->nreferences && reference; i++) {
        int skip = first < head->references[i].nvalues ? first : head->references[i].nvalues;
        reference[i] = head->references[i];
        reference[i].values += skip;
        reference[i].nvalues -= skip;
    }
    head->nreferences = reference ? head->nreferences : 0;
    head->references = reference;
}

static rotid_identification *identification_of_state(struct pool *pool, const rotid_identification *fit, int s, int first)
{
    rotid_identification *own = POOL_NEW(pool, rotid_identification);
    rotid_minimiser *baseline = POOL_ARRAY(pool, rotid_minimiser, fit->nbaseline);
    if (!own || !baseline)
        return NULL;
    *own = fit_of_state(fit, s);
    for (int b = 0; b < fit->nbaseline; b++) {
        baseline[b] = fit->baseline[b];
        baseline[b].npredicted_hz = baseline[b].predicted_hz ? own->nmodes : 0;
        baseline[b].predicted_hz = baseline[b].predicted_hz ? baseline[b].predicted_hz + first : NULL;
    }
    own->nbaseline = fit->nbaseline;
    own->baseline = baseline;
    return own;
}

struct result page_result_of_state(struct pool *pool, const struct result *result, int s)
{
    struct result own = *result;
    int first = 0;
    own.nstates = 0;
    own.states = NULL;
    if (result->identify) {
        for (int t = 0; t < s; t++)
            first += result->identify->states[t].nmodes;
        take_references(pool, &own.head, first);
        own.identify = identification_of_state(pool, result->identify, s, first);
        return own;
    }
    own.check = result->states[s].check;
    own.modes = result->states[s].modes;
    own.sensitivity = result->states[s].sensitivity;
    own.frf = result->states[s].frf;
    return own;
}
