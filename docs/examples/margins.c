/* The machine behind *RUNNING: its critical speeds with 95 % intervals, and how likely their margins are kept. C and C++. */
#include <rotid.h>
#include <stdio.h>
#include <string.h>

int main(int argc, char **argv)
{
    rotid_deck *deck;
    rotid_speeds *found = NULL;
    char failure[ROTID_FAILURE_LENGTH] = "";
    rotid_speeds_options options;
    memset(&options, 0, sizeof options);
    options.size = sizeof options;
    options.draws = 400;
    int status = rotid_deck_read(argc > 1 ? argv[1] : "machine.inp", 0, NULL, NULL, NULL, &deck);
    if (status == ROTID_OK)
        status = rotid_speeds_compute(deck, &options, NULL, failure, &found);
    if (!found)
        fprintf(stderr, "%s: %s\n", rotid_status_text(status), failure);
    for (int i = 0; found && i < found->ncritical_speeds; i++) {
        const rotid_critical_speed *c = &found->critical_speeds[i];
        printf("%d %-8s %5.0f rpm (%.0f to %.0f)", c->number, c->whirl, c->speed_rpm, c->ci95[0], c->ci95[1]);
        if (c->margin.value == c->margin.value) /* a number: of critical speeds that are judged */
            printf(", margin %.1f %%, kept with probability %.2f", 100 * c->margin.value, c->margin.probability);
        printf("\n");
    }
    rotid_speeds_free(found);
    rotid_deck_free(deck);
    return status == ROTID_OK ? 0 : 1;
}
