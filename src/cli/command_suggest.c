#include "api/api.h"
#include "cli/cli.h"

static int write_extended(struct command *command, const rotid_suggestion *s, int code)
{
    char *text = NULL;
    if (!command->extended)
        return code;
    if (!s->ntests || !s->tests[0].cards)
        return terminal_end(EXIT_DOUBTFUL, "rotid: %s is not written: %s\n", command->extended,
                            s->ntests ? "the first test cannot be written as a deck: give its supports names"
                                      : "there is no test to propose");
    int status = deck_propose(&command->pool, deck_states_of(command->read), s->state, &s->tests[0], &command->messages, &text);
    if (status == ROTID_ERROR_MEMORY)
        return command_fail(command, status);
    if (status) {
        command_print_messages(command);
        return terminal_end(EXIT_INTERNAL,
                            "rotid: %s is not written: the deck with the test in it would not be read as it is meant\n",
                            command->extended);
    }
    return command_write_deck(command, text, code);
}

/* --for speed:N or backward:N */
static int parse_aim(const char *text, int *speed, int *backward)
{
    static const char *const words[] = {"speed:", "backward:"};
    *speed = *backward = 0;
    for (int i = 0; i < 2 && text; i++) {
        char *end;
        if (strncmp(text, words[i], strlen(words[i])) != 0)
            continue;
        long number = strtol(text + strlen(words[i]), &end, 10);
        if (*end || number < 1 || number > 100)
            break;
        *speed = (int)number;
        *backward = i;
        return EXIT_DONE;
    }
    return text ? arguments_wrong("--for=%s is no aim, expected speed:N or backward:N with N from 1 to 100", text) : EXIT_DONE;
}

int command_suggest(struct command *command)
{
    const struct suggest_arguments *given = &command->suggest;
    char failure[ROTID_FAILURE_LENGTH];
    if (!command->seed)
        command->head.seed = (double)(command->seed = 1);
    int speed, backward, wrong = parse_aim(given->aim, &speed, &backward);
    if (wrong)
        return wrong;
    const rotid_suggest_options options = {.size = sizeof options,
                                           .wanted_percent = given->interval,
                                           .frequency_noise = given->frequency_noise / 100,
                                           .shape_noise = given->shape_noise / 100,
                                           .set_up_cost = given->set_up_cost,
                                           .sensors = given->sensors,
                                           .modes = given->modes,
                                           .threads = command->threads,
                                           .seed = (long)command->seed,
                                           .speed = speed,
                                           .speed_backward = backward};
    const rotid_environment environment = command_environment(command);
    rotid_suggestion *suggestion;
    int status = rotid_suggest(command->read, &options, &environment, failure, &suggestion);
    if (status == ROTID_STOP_CANCELLED)
        return terminal_end(EXIT_DOUBTFUL, "rotid: interrupted; there is no result\n");
    if (status)
        return command_fail_with(command, status, failure);
    struct result result = {.head = command->head, .suggest = suggestion};
    command_take_messages(command, NULL, suggestion->nmessage, suggestion->message);
    command_show(command, &result, screen_suggest);
    int written = command_write_result(command, &result, EXIT_DONE), code = write_extended(command, suggestion, written);
    rotid_suggestion_free(suggestion);
    return code > written ? code : written;
}
