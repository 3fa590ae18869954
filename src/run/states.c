#include "run/states.h"

#include <stdio.h>
#include <string.h>

void states_refuse(const struct states *states, const char *deck, struct message_list *notes)
{
    char list[256] = "";
    for (int s = 0; s < states->nstate && strlen(list) + 3 < sizeof list; s++)
        (void)snprintf(list + strlen(list), sizeof list - strlen(list), "%s%s", s ? ", " : "", states->state[s].name);
    message_add(notes, SEVERITY_ERROR, deck, 1, 1,
                "the deck has %d states and this works on one, expected one of %s as FIT.STATE: --set FIT.STATE=%s",
                states->nstate, list, states->state[0].name);
}
