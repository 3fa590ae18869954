#include "hidden_states.h"

#include <cjson/cJSON.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hide/hide_text.h"

#define MOST_TRUTHS 16

/* "core.E=2.1e11" of what was drawn, for the states behind the first. */
static int take_truths(const char *json, char truth[][100])
{
    cJSON *all = cJSON_Parse(json);
    const cJSON *parameter;
    int count = 0;
    cJSON_ArrayForEach(parameter, cJSON_GetObjectItem(all, "parameters"))
    {
        if (count < MOST_TRUTHS)
            (void)snprintf(truth[count++], sizeof truth[0], "%s=%.17g",
                           cJSON_GetStringValue(cJSON_GetObjectItem(parameter, "name")),
                           cJSON_GetObjectItem(parameter, "value")->valuedouble);
    }
    cJSON_Delete(all);
    return count;
}

/* What was measured begins with the sensors, where the request has some, else with the noise. */
static const char *measured_part(const char *deck, const struct hide_request *request)
{
    const char *noise = strstr(deck, "*NOISE"), *sensors = request->sensors > 0 ? strstr(deck, "*SENSORS") : NULL;
    return sensors && (!noise || sensors < noise) ? sensors : noise;
}

static int add_state(const struct hide_request *request, const struct hidden_state *state, struct hide_text *text, char **truth,
                     char *message, size_t room)
{
    struct hide_request own = *request;
    struct hide_text rotor = {0};
    char *deck = NULL;
    hide_add(&rotor, "%s%s", request->deck, state->cards);
    own.deck = rotor.data;
    own.effects = state->effects;
    own.effect = state->effect;
    int status = own.deck ? hide_case(&own, &deck, truth, message, room) : HIDE_FAILURE;
    const char *measured = status ? NULL : measured_part(deck, request);
    if (measured)
        hide_add(text, "*STATE, NAME=%s\n%s%s", state->name, state->cards, measured);
    free(rotor.data);
    free(deck);
    return status || !measured;
}

char *hidden_states_deck(const struct hide_request *request, int nstate, const struct hidden_state *state, char **truth,
                         char *message, size_t room)
{
    struct hide_request own = *request;
    struct hide_text text = {0};
    char values[MOST_TRUTHS][100], *json = NULL;
    const char *list[MOST_TRUTHS];
    int failed = 0;
    hide_add(&text, "%s", request->deck);
    for (int s = 0; s < nstate && !failed; s++) {
        free(json);
        json = NULL;
        own.seed = request->seed + (uint64_t)s;
        failed = add_state(&own, &state[s], &text, &json, message, room);
        if (failed || s)
            continue;
        own.truths = take_truths(json, values);
        own.truth = list;
        for (int i = 0; i < own.truths; i++)
            list[i] = values[i];
    }
    if (truth)
        *truth = json;
    else
        free(json);
    if (!failed)
        return text.data;
    free(text.data);
    return NULL;
}
