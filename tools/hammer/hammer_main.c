/* hammer: writes the time records of a hammer test as a universal file, and the truth beside it. See hammer.h. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hammer.h"
#include "hammer_command.h"
#include "hide/hide_states.h"

/* The deck of the state that is tested, the deck itself without --state; to be freed. NULL after a message. */
static char *tested(const struct hammer_command *c, const char *deck, int *status)
{
    char message[600] = "", *text = NULL;
    const struct hide_message to = {message, sizeof message};
    struct hide_cards cards = {0};
    int first, end;
    if (!c->state) {
        text = malloc(strlen(deck) + 1);
        *status = text ? HAMMER_OK : HAMMER_FAILURE;
        return text ? strcpy(text, deck) : NULL;
    }
    *status = hide_cards_read(deck, c->rotor, &cards, &to);
    if (!*status)
        text = hide_state_text(deck, c->rotor, c->state, &cards, &first, &end, status, &to);
    hide_cards_free(&cards);
    if (*status)
        fprintf(stderr, "hammer: %s\n", message);
    return text;
}

static int run(const struct hammer_command *c, const char *whole, int truths, const char *const *truth)
{
    struct hammer_test test;
    char message[600];
    int status;
    char *deck = tested(c, whole, &status);
    if (status)
        return status;
    status = hammer_open(deck, c->rotor, truths, truth, c->seed, &c->options, &test, message, sizeof message);
    if (!status && c->truth)
        status = hammer_write_truth(&test, c->seed, c->truth, message, sizeof message);
    if (!status && c->deck && c->state)
        status = hammer_write_state(whole, c->state, c->modes_file, c->deck, message, sizeof message);
    else if (!status && c->deck)
        status = hammer_write_deck(&test, c->modes_file, c->deck, message, sizeof message);
    if (!status)
        status = hammer_write(&test, c->seed, c->ascii, c->out, message, sizeof message);
    if (status)
        fprintf(stderr, "hammer: %s\n", message);
    hammer_close(&test);
    free(deck);
    return status;
}

int main(int argc, char **argv)
{
    struct hammer_command command;
    struct hammer_options built_in = hammer_options_default();
    const char *const *preset = NULL, **truth = calloc((size_t)argc + 8, sizeof *truth);
    int presets = 0, status = truth ? hammer_command_read(argc, argv, truth, &command) : HAMMER_FAILURE;
    char *deck = NULL;
    if (!status && command.help) {
        fputs(hammer_usage, stdout);
        free(truth);
        return HAMMER_OK;
    }
    if (!status) {
        deck = hammer_rotor_deck(command.rotor, &built_in, &presets, &preset);
        if (deck && !command.damping_given) {
            command.options.dampings = built_in.dampings;
            memcpy(command.options.damping, built_in.damping, sizeof built_in.damping);
        }
        if (!deck)
            presets = 0;
        if (!deck && !(deck = hide_read_file("hammer", command.rotor, "; expected paper, beam or a deck")))
            status = HAMMER_INPUT;
    }
    if (!status) { /* what is given comes after what is built in, and so has the last word */
        memmove(truth + presets, truth, (size_t)command.truths * sizeof *truth);
        for (int i = 0; i < presets; i++)
            truth[i] = preset[i];
        status = run(&command, deck, command.truths + presets, truth);
    }
    free(deck);
    free(truth);
    return status;
}
