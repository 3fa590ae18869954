/* Runs a deck: what rotid identifies in it, with 95 % intervals. C and C++. */
#include <rotid.h>
#include <stdio.h>

static void tell(int count, const rotid_message *message)
{
    for (int i = 0; i < count; i++) {
        if (message[i].file)
            fprintf(stderr, "%s:%d:%d: ", message[i].file, message[i].line, message[i].column);
        fprintf(stderr, "%s\n", message[i].text);
    }
}

int main(int argc, char **argv)
{
    rotid_deck *deck;
    rotid_identification *found = NULL;
    char failure[ROTID_FAILURE_LENGTH] = "";
    int status = rotid_deck_read(argc > 1 ? argv[1] : "rotor.inp", 0, NULL, NULL, NULL, &deck);
    if (deck)
        tell(deck->nmessage, deck->message);
    if (status == ROTID_OK && rotid_identify(deck, 0, NULL, failure, &found) != ROTID_OK)
        fprintf(stderr, "%s\n", failure);
    if (found) {
        tell(found->nmessage, found->message);
        for (int i = 0; i < found->nparameters; i++) {
            const rotid_fitted_parameter *p = &found->parameters[i];
            printf("%s %.6g %s, 95 %% interval %.6g ... %.6g\n", p->name, p->value, p->unit, p->ci95[0], p->ci95[1]);
        }
    }
    int good = found && found->fit->converged;
    rotid_identification_free(found);
    rotid_deck_free(deck);
    return good ? 0 : 1;
}
